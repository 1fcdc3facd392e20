//! Two shadings side by side: the picture of one left of a divider, that of the other right of it.
//!
//! Both are drawn whole, each by a renderer of its own and one after the other. So each one's time is what it takes
//! alone, and what is seen of it does not matter. The divider is where the mouse is; a click fixes it there, and another
//! lets it go.

use std::mem;
use std::time::Instant;

use mode13h::palette::Rgb;
use mode13h::render::{RenderError, Renderer};
use mode13h::scene::Scene;
use mode13h::settings::Shading;
use mode13h::vga::Vga;
use mode13h::window::{Input, Key};
use mode13h_lab::truth::Figures;

use super::shading::{Pacing, ShadingChoice};
use super::timing::Timing;
use crate::overlay::{Row, Sheet, Side};

/// Greatest way of the mouse while its button is down, in pixels of the frame, for a click. Beyond that it turns the
/// model.
const CLICK: f32 = 2.0;

/// A shading, what draws by it, and what it drew.
pub(super) struct Half {
    pub(super) shading: ShadingChoice,
    pub(super) renderer: Renderer,
    pacing: Pacing,
    pub(super) vga: Vga,
    pub(super) timing: Timing,
}

/// The right half, and how the window is divided.
pub(super) struct Compare {
    pub(super) is_on: bool,
    pub(super) right: Half,
    divider: Divider,
}

impl Compare {
    pub(super) fn new() -> Compare {
        let right = Half {
            shading: ShadingChoice::new(Shading::Phong, None),
            renderer: Renderer::new(),
            pacing: Pacing::default(),
            vga: Vga::new(),
            timing: Timing::default(),
        };
        Compare { is_on: false, right, divider: Divider::default() }
    }

    /// Follows the user's input, and says what that changed. `left` is the shading of the left half, and `renderer`
    /// draws that.
    pub(super) fn follow(&mut self, input: &Input, left: &ShadingChoice, renderer: &Renderer) -> Option<String> {
        if input.pressed(Key::C) {
            self.is_on ^= true;
            if !self.is_on {
                return Some("side by side off".into());
            }
            self.right.shading = opposite(left);
            self.renew(renderer);
            self.divider = Divider::default();
            self.divider.follow(input);
            return Some(format!("{left} | {}", self.right.shading));
        }
        if !self.is_on {
            return None;
        }
        if self.right.shading.follow_shifted(input) {
            self.right.timing = Timing::default();
            return Some(format!("right: {}", self.right.shading));
        }
        self.divider.follow(input).then(|| match self.divider.is_fixed {
            true => "divider fixed; a click lets it go".into(),
            false => "the divider follows the mouse".into(),
        })
    }

    /// Gives the right half a renderer that is set as the left one's.
    pub(super) fn renew(&mut self, left: &Renderer) {
        self.right.renderer = left.with_same_settings();
        self.right.pacing = Pacing::default();
        self.right.timing = Timing::default();
    }

    /// Draws the right half. Whether it is another picture than before.
    pub(super) fn draw(&mut self, scene: &Scene, seconds: f64) -> Result<bool, RenderError> {
        let Half { shading, renderer, pacing, vga, timing } = &mut self.right;
        shading.set(renderer, pacing);
        let start = Instant::now();
        let stats = renderer.draw(scene, vga)?;
        let taken = start.elapsed();
        pacing.report(&stats, taken);
        timing.add(stats.redrawn.then_some(taken.as_secs_f64()), seconds);
        Ok(stats.redrawn)
    }

    /// The column of the frame from which on the right half is seen.
    pub(super) fn divider(&self) -> usize {
        if self.is_on { self.divider.column } else { Vga::WIDTH }
    }

    /// Puts what is seen of the right half into a picture that shows the left one.
    pub(super) fn compose(&self, vga: &mut Vga) {
        let divider = self.divider();
        let rows = vga.pixels_mut().chunks_exact_mut(Vga::WIDTH).zip(self.right.vga.pixels().chunks_exact(Vga::WIDTH));
        rows.for_each(|(left, right)| left[divider..].copy_from_slice(&right[divider..]));
    }

    /// The divider, and over each half its shading, its time and its error.
    pub(super) fn lay_over(&self, sheet: &mut Sheet, left: (&ShadingChoice, &Timing), errors: [Option<Figures>; 2]) {
        let picture = sheet.picture_area();
        // Within the window.
        let x = picture.from_frame(self.divider.column as f32, 0.0).0 as i32;
        let (top, bottom) = (picture.top as i32, (picture.top + picture.height) as i32);
        sheet.line((x, top), (x, bottom), Rgb::WHITE, 1);
        let right = (&self.right.shading, &self.right.timing);
        for ((side, (shading, timing)), errors) in [(Side::Left, left), (Side::Right, right)].into_iter().zip(errors) {
            let [worst, mean] = match errors {
                Some(figures) => [figures.max, figures.mean()].map(|error| format!("{error:.2}")),
                None => ["...", "..."].map(String::from),
            };
            let rows = [
                Row::text(shading.to_string()),
                Row::new("time", timing.to_string()),
                Row::new("worst", format!("{worst} shades")),
                Row::new("mean", format!("{mean} shades")),
            ];
            sheet.panel(side, &rows, false, 0, "");
        }
    }

    /// Swaps the halves.
    pub(super) fn swap(&mut self, left: (&mut ShadingChoice, &mut Renderer, &mut Vga, &mut Timing)) {
        let Half { shading, renderer, vga, timing, .. } = &mut self.right;
        mem::swap(shading, left.0);
        mem::swap(renderer, left.1);
        mem::swap(vga, left.2);
        mem::swap(timing, left.3);
    }
}

/// Opposite of a shading: light at every pixel, or where that is the shading itself the default.
fn opposite(left: &ShadingChoice) -> ShadingChoice {
    let exact = ShadingChoice::new(Shading::Phong, None);
    if left.to_string() == exact.to_string() { ShadingChoice::new(Shading::default(), None) } else { exact }
}

/// Divider of the picture.
#[derive(Debug)]
struct Divider {
    /// 0 to 320.
    column: usize,
    is_fixed: bool,
    /// Way of the mouse since its button went down, while it is down.
    dragged: Option<f32>,
}

impl Default for Divider {
    fn default() -> Divider {
        Divider { column: Vga::WIDTH / 2, is_fixed: false, dragged: None }
    }
}

impl Divider {
    /// Follows the mouse, or not. Whether a click changed that.
    fn follow(&mut self, input: &Input) -> bool {
        let x = input.mouse.map(|(x, _)| x);
        self.moved(x, input.buttons.left, input.drag)
    }

    fn moved(&mut self, mouse: Option<f32>, is_down: bool, drag: (f32, f32)) -> bool {
        let mut is_click = false;
        if is_down {
            *self.dragged.get_or_insert(0.0) += drag.0.abs() + drag.1.abs();
        } else {
            is_click = self.dragged.take().is_some_and(|dragged| dragged < CLICK);
            self.is_fixed ^= is_click;
        }
        if let Some(x) = mouse.filter(|_| !self.is_fixed && !is_down) {
            // Columns of the frame.
            self.column = x.clamp(0.0, Vga::WIDTH as f32) as usize;
        }
        is_click
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mode13h::mesh::shapes;

    #[test]
    fn the_divider_follows_the_mouse_until_a_click_fixes_it() {
        let mut divider = Divider::default();
        assert!(!divider.moved(Some(40.7), false, (0.0, 0.0)));
        assert_eq!(divider.column, 40);
        for (x, column) in [(-9.0, 0), (400.0, 320), (100.0, 100)] {
            divider.moved(Some(x), false, (0.0, 0.0));
            assert_eq!(divider.column, column);
        }
        // A drag turns the model, and the divider stays meanwhile.
        divider.moved(Some(100.0), true, (0.0, 0.0));
        divider.moved(Some(130.0), true, (30.0, 0.0));
        assert_eq!(divider.column, 100);
        assert!(!divider.moved(Some(130.0), false, (0.0, 0.0)));
        assert_eq!((divider.column, divider.is_fixed), (130, false));
        // A click fixes it where it is.
        divider.moved(Some(130.0), true, (0.0, 0.0));
        assert!(divider.moved(Some(131.0), false, (0.0, 0.0)));
        divider.moved(Some(20.0), false, (0.0, 0.0));
        assert_eq!((divider.column, divider.is_fixed), (130, true));
        divider.moved(Some(20.0), true, (1.0, 0.0));
        assert!(divider.moved(Some(20.0), false, (0.0, 0.0)));
        assert_eq!((divider.column, divider.is_fixed), (20, false));
    }

    #[test]
    fn the_right_half_is_drawn_by_its_own_renderer() {
        let scene = Scene::showing(shapes::torus(24, 12));
        let (mut renderer, mut phong) = (Renderer::new(), Vga::new());
        renderer.settings.accuracy = Some(Shading::Phong.into());
        renderer.draw(&scene, &mut phong).expect("a legal scene");
        let mut compare = Compare::new();
        assert!(compare.draw(&scene, 0.0).expect("a legal scene"));
        assert!(compare.right.vga.pixels() == phong.pixels());
        assert!(!compare.draw(&scene, 0.0).expect("a legal scene"), "it is not drawn again");
    }

    #[test]
    fn each_half_is_seen_on_its_side_of_the_divider() {
        let mut compare = Compare::new();
        compare.right.vga.pixels_mut().fill(9);
        let mut left = Vga::new();
        left.pixels_mut().fill(5);
        for (is_on, column) in [(true, 0), (true, 1), (true, 160), (true, 319), (true, 320), (false, 160)] {
            (compare.is_on, compare.divider.column) = (is_on, column);
            let mut shown = left.clone();
            compare.compose(&mut shown);
            let right = |place: usize| is_on && place % 320 >= column;
            let expected: Vec<u8> = (0..64_000).map(|place| if right(place) { 9 } else { 5 }).collect();
            assert!(shown.pixels() == expected, "{is_on}, {column}");
        }
    }

    #[test]
    fn a_shading_is_compared_with_another() {
        let names = |left: ShadingChoice| opposite(&left).to_string();
        assert_eq!(names(ShadingChoice::new(Shading::Flat, None)), "phong");
        assert_eq!(names(ShadingChoice::new(Shading::Phong, Some(2.0))), "phong", "a budget against exact");
        assert_eq!(names(ShadingChoice::new(Shading::Phong, None)), Shading::default().name());
    }
}
