//! Panels for the picture itself: its shading and its error map.

use mode13h::render::Stats;

use super::error_map::Pixel;
use super::shading::ShadingChoice;
use super::{Failure, Half, Input, Key, Keys, Panel, Row, Sheet, Show};

pub(super) const SHADES: Keys = &[
    ("[ and ]", "Step through the shadings"),
    ("1 to 9", "The first nine shadings"),
    ("0", "The error budget"),
    ("B, Shift-B", "Smaller budget, larger budget: 16, 8, 4, 2, 1, 1/2 shades"),
    ("F, Shift-F", "Smallest error that fits a time: less time, more time"),
];

pub(super) const MAPS: Keys = &[("E", "The error map")];

/// The keys that choose the picture's shading.
pub(super) struct Shades;

impl Panel for Shades {
    fn follow(&mut self, input: &Input, show: &mut Show) -> Result<(), Failure> {
        let left = &mut show.halves[0];
        if left.shading.follow(input, false) {
            left.is_chosen = true;
            left.forget_times();
            let said = left.shading.to_string();
            show.say(said);
        }
        Ok(())
    }

    fn renew(&mut self, show: &mut Show, _: bool) -> Result<(), Failure> {
        if !show.halves[0].is_chosen {
            show.halves[0].shading = ShadingChoice::of(show.inputs.shading.asked_for(&show.stage.scene.settings));
        }
        Ok(())
    }

    fn figures(&self, show: &Show) -> Vec<Row> {
        let Half { shading, timing, stats, pacing, .. } = &show.halves[0];
        let mut rows = vec![Row::new("shading", shading.to_string()), Row::new("time", timing.in_words())];
        if let (Some(Stats { max_error: Some(error), .. }), Some(fits)) = (stats, pacing.fits()) {
            let late = if fits { "" } else { ", takes longer" };
            rows.push(Row::new("within", format!("{error} {}{late}", if *error == 1.0 { "shade" } else { "shades" })));
        }
        rows
    }
}

/// The map over the picture.
pub(super) struct Maps {
    pub(super) is_on: bool,
    /// The pixel under the mouse, or the last one that was.
    pub(super) mouse: Pixel,
}

impl Panel for Maps {
    fn follow(&mut self, input: &Input, show: &mut Show) -> Result<(), Failure> {
        if input.pressed(Key::E) {
            self.is_on ^= true;
            show.say(if self.is_on { "error map on" } else { "error map off" });
        }
        self.mouse = input.mouse.and_then(Pixel::at).unwrap_or(self.mouse);
        Ok(())
    }

    fn figures(&self, show: &Show) -> Vec<Row> {
        let left = &show.halves[0];
        let budget = left.shading.budget(left.stats.as_ref());
        vec![Row::new("error", show.map.figures(show.number, show.seconds, budget))]
    }

    fn lay_over(&self, show: &Show, sheet: &mut Sheet) {
        if self.is_on && !show.help.is_open {
            show.map.legend(sheet, show.number, show.seconds, show.divider.is_some());
        }
    }
}
