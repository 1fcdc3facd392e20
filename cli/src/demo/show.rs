//! State shared by all panels: the current scene, its picture, and the messages over it.

use std::sync::Arc;
use std::time::Instant;

use mode13h::render::{RenderError, Renderer, Screen, Stats};
use mode13h::scene::Scene;
use mode13h::vga::Vga;

use super::Pages;
use super::error_map::{Frame, Map, Pixel, Snapshot};
use super::loader::Inputs;
use super::shading::{Pacing, ShadingChoice};
use super::timing::Timing;
use crate::failure::Failure;
use crate::turntable::Turntable;

/// The first message, and how long it is shown, in seconds.
const HINT: &str = "H help, I figures";
const HINT_SECONDS: f64 = 3.0;
/// Seconds for which a message says what a key has changed.
const NOTICE: f64 = 1.0;

/// A shading, the renderer that uses it, and its picture.
pub(super) struct Half {
    pub(super) shading: ShadingChoice,
    /// True if a key chose it, and not the command line or the scene.
    pub(super) is_chosen: bool,
    pub(super) renderer: Renderer,
    pub(super) pacing: Pacing,
    pub(super) vga: Vga,
    pub(super) timing: Timing,
    /// The time of making the plan, while the figures are shown.
    pub(super) planning: Timing,
    /// Counts of the frame that is shown.
    pub(super) stats: Option<Stats>,
}

impl Half {
    pub(super) fn new(shading: ShadingChoice, renderer: Renderer) -> Half {
        let (timing, planning) = <(Timing, Timing)>::default();
        let (pacing, vga) = (Pacing::default(), Vga::new());
        Half { shading, is_chosen: false, renderer, pacing, vga, timing, planning, stats: None }
    }

    /// Gives it another renderer.
    pub(super) fn renew(&mut self, renderer: Renderer) {
        (self.renderer, self.pacing, self.stats) = (renderer, Pacing::default(), None);
        self.forget_times();
    }

    /// Forgets earlier times, after a change that affects how long frames take.
    pub(super) fn forget_times(&mut self) {
        (self.timing, self.planning) = <(Timing, Timing)>::default();
    }

    /// Draws a frame, and measures its plan alone if that is shown. Returns whether the picture is a new one.
    pub(super) fn draw(&mut self, scene: &Scene, seconds: f64, plans: bool) -> Result<bool, RenderError> {
        self.shading.set(&mut self.renderer, &mut self.pacing);
        // While the picture stands still, so does the time for its plan.
        if plans && (self.timing.is_redrawn || self.planning.frame == 0.0) {
            let start = Instant::now();
            self.renderer.make_plan(scene, Screen::MODE_13H)?;
            self.planning.add(Some(start.elapsed().as_secs_f64()), seconds);
        }
        let start = Instant::now();
        let stats = self.renderer.draw(scene, &mut self.vga)?;
        let taken = start.elapsed();
        self.pacing.report(&stats, taken);
        self.timing.add(stats.redrawn.then_some(taken.as_secs_f64()), seconds);
        // A frame that was already there keeps its counts.
        let is_new = stats.redrawn || self.stats.is_none();
        if is_new {
            self.stats = Some(stats);
        }
        Ok(is_new)
    }
}

/// State shared by all panels.
pub(super) struct Show {
    pub(super) inputs: Arc<Inputs>,
    /// The current scene; without objects until something has been loaded.
    pub(super) stage: Turntable,
    /// The picture, and the other one while two shadings are compared.
    pub(super) halves: [Half; 2],
    /// While two are compared, the column of the frame at which the other begins.
    pub(super) divider: Option<usize>,
    /// The picture as it is shown, without text.
    pub(super) screen: Vga,
    /// Number of different pictures so far.
    pub(super) number: u64,
    /// Errors of the picture.
    pub(super) map: Map,
    pub(super) figures: Pages,
    pub(super) help: Pages,
    /// Message at the lower edge, and until when it is shown.
    pub(super) notice: Option<(String, f64)>,
    /// Time of this frame.
    pub(super) seconds: f64,
}

impl Show {
    /// The state with nothing to show yet: two halves, and an empty scene.
    pub(super) fn new(inputs: Arc<Inputs>, halves: [Half; 2]) -> Show {
        Show {
            inputs,
            stage: Turntable::of_scene(Scene::new()),
            halves,
            divider: None,
            screen: Vga::new(),
            number: 0,
            map: Map::default(),
            figures: Pages::default(),
            help: Pages::default(),
            notice: Some((HINT.to_string(), HINT_SECONDS)),
            seconds: 0.0,
        }
    }

    /// The number of triangles in the scene.
    pub(super) fn triangles(&self) -> usize {
        self.stage.scene.objects().iter().map(|object| object.mesh().triangles().len()).sum()
    }

    /// The visible halves, from the left.
    pub(super) fn seen(&self) -> &[Half] {
        if self.divider.is_some() { &self.halves } else { &self.halves[..1] }
    }

    /// The column at which the right half begins.
    pub(super) fn column(&self) -> usize {
        self.divider.unwrap_or(Vga::WIDTH)
    }

    /// Gives the right half's renderer the settings of the left one's.
    pub(super) fn renew_right(&mut self) {
        let renderer = self.halves[0].renderer.with_same_settings();
        self.halves[1].renew(renderer);
    }

    /// Changes how both halves are drawn.
    pub(super) fn set_renderers(&mut self, set: impl Fn(&mut Renderer)) {
        for half in &mut self.halves {
            set(&mut half.renderer);
            half.forget_times();
        }
    }

    /// Shows a message for a moment.
    pub(super) fn say(&mut self, what: impl Into<String>) {
        self.notice = Some((what.into(), self.seconds + NOTICE));
    }

    /// Draws the picture, without the error map. The halves stay as they are, since the next frame may be the same.
    pub(super) fn draw(&mut self) -> Result<(), RenderError> {
        let count = self.seen().len();
        for half in &mut self.halves[..count] {
            let is_new = half.draw(&self.stage.scene, self.seconds, self.figures.is_open)?;
            self.number += u64::from(is_new);
        }
        let [left, right] = &self.halves;
        compose(&mut self.screen, &left.vga, &right.vga, self.divider);
        Ok(())
    }

    /// Has the picture's errors measured, starting at a pixel.
    pub(super) fn measure(&mut self, mouse: Pixel) -> Result<(), Failure> {
        let mut map = std::mem::take(&mut self.map);
        let followed = map.follow(self.number, || Frame {
            snapshot: Snapshot {
                number: self.number,
                seconds: self.seconds,
                picture: self.screen.clone(),
                divider: self.column(),
                shadings: self.seen().iter().map(|half| half.shading.to_string()).collect(),
            },
            scene: self.stage.scene.clone(),
            renderers: self.seen().iter().map(|half| half.renderer.with_same_settings()).collect(),
            mouse,
        });
        self.map = map;
        followed
    }
}

/// Puts two pictures on a screen, the right one from the divider on, if there is one.
fn compose(screen: &mut Vga, left: &Vga, right: &Vga, divider: Option<usize>) {
    screen.clone_from(left);
    let column = divider.unwrap_or(Vga::WIDTH);
    let rows = screen.pixels_mut().chunks_exact_mut(Vga::WIDTH).zip(right.pixels().chunks_exact(Vga::WIDTH));
    rows.for_each(|(row, right)| row[column..].copy_from_slice(&right[column..]));
}

#[cfg(test)]
mod tests {
    use super::*;
    use mode13h::mesh::shapes;
    use mode13h::settings::Shading;

    #[test]
    fn a_half_is_drawn_by_its_own_shading() {
        let scene = Scene::showing(shapes::torus(24, 12));
        let (mut renderer, mut phong) = (Renderer::new(), Vga::new());
        renderer.settings.accuracy = Some(Shading::Phong.into());
        renderer.draw(&scene, &mut phong).expect("a legal scene");
        let mut half = Half::new(ShadingChoice::new(Shading::Phong, None), Renderer::new());
        assert!(half.draw(&scene, 0.0, false).expect("a legal scene"));
        assert!(half.vga.pixels() == phong.pixels());
        assert!(!half.draw(&scene, 0.0, false).expect("a legal scene"), "it is not drawn again");
    }

    #[test]
    fn each_half_is_seen_on_its_side_of_the_divider() {
        let [mut left, mut right, mut screen] = [0; 3].map(|_| Vga::new());
        left.pixels_mut().fill(5);
        right.pixels_mut().fill(9);
        for divider in [Some(0), Some(1), Some(160), Some(319), Some(320), None] {
            compose(&mut screen, &left, &right, divider);
            let is_right = |place: usize| divider.is_some_and(|column| place % 320 >= column);
            let expected: Vec<u8> = (0..64_000).map(|place| if is_right(place) { 9 } else { 5 }).collect();
            assert!(screen.pixels() == expected, "{divider:?}");
        }
    }
}
