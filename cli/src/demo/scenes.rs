//! The inputs: which one is shown, and what is wrong with it.

use super::{Failure, Input, Key, Keys, Panel, Row, Sheet, Show};
use crate::input;
use crate::output::counted;
use crate::overlay;

pub(super) const KEYS: Keys = &[("N, Shift-N", "Next INPUT, previous INPUT")];

/// The input that is shown or being loaded.
pub(super) struct Scenes {
    /// Its index in the list.
    pub(super) at: usize,
    pub(super) is_loading: bool,
    /// Name of the current one.
    pub(super) name: String,
    /// Why the scene that is shown differs from the files.
    pub(super) wrong: Option<Failure>,
}

impl Scenes {
    /// Text about the input that is being loaded.
    pub(super) fn loading(&self, show: &Show) -> Option<String> {
        let count = show.inputs.words.len();
        let number = if count > 1 { format!("{} of {count}: ", self.at + 1) } else { String::new() };
        let read = match input::percent_read() {
            Some(100) => ", making the mesh".to_string(),
            Some(percent) => format!(", {percent} % read"),
            None => String::new(),
        };
        self.is_loading.then(|| format!("{number}loading {}{read}", show.inputs.name(self.at)))
    }
}

impl Panel for Scenes {
    fn follow(&mut self, input: &Input, show: &mut Show) -> Result<(), Failure> {
        let count = show.inputs.words.len();
        if input.pressed(Key::N) && count == 1 {
            show.say("there is no other input");
        } else if input.pressed(Key::N) {
            self.at = (self.at + if input.pressed_with_shift(Key::N) { count - 1 } else { 1 }) % count;
            (self.is_loading, show.notice) = (true, None);
        }
        Ok(())
    }

    fn renew(&mut self, show: &mut Show, _: bool) -> Result<(), Failure> {
        self.name = show.inputs.name(self.at);
        Ok(())
    }

    fn figures(&self, show: &Show) -> Vec<Row> {
        let objects = show.stage.scene.objects();
        let counts =
            format!("{}, {}", counted(objects.len() as u64, "object"), counted(show.triangles() as u64, "triangle"));
        vec![Row::new("scene", &self.name), Row::new("", counts)]
    }

    fn lay_over(&self, _: &Show, sheet: &mut Sheet) {
        if let Some(wrong) = &self.wrong {
            sheet.message(overlay::WRONG, &wrong.to_string());
        }
    }
}
