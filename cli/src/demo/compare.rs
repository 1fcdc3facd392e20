//! Two shadings side by side: the picture of one left of a divider, that of the other right of it.
//!
//! Both are drawn whole, one after the other, each by its own renderer. So each time is that of a whole frame, however
//! much of it is visible. The divider follows the mouse; a click fixes it, and another click releases it.

use mode13h::palette::Rgb;
use mode13h::settings::Shading;
use mode13h::vga::Vga;

use super::shading::ShadingChoice;
use super::{Failure, Input, Key, Keys, Panel, Row, Sheet, Show, Side};

pub(super) const KEYS: Keys = &[
    ("C", "Divide the window at the mouse, with another shading on the right; a click fixes the divider"),
    ("Shift", "With [ ] and digits: the right-hand shading"),
    ("X", "Swap the two shadings"),
];

/// How far the mouse may move in a click, in pixels of the frame. Beyond that it turns the model.
const CLICK: f32 = 2.0;

impl Panel for Divider {
    fn follow(&mut self, input: &Input, show: &mut Show) -> Result<(), Failure> {
        let [left, right] = &mut show.halves;
        let said = if input.pressed(Key::C) && show.divider.is_some() {
            show.divider = None;
            "side by side off".to_string()
        } else if input.pressed(Key::C) {
            right.shading = opposite(&left.shading);
            let said = format!("{} | {}", left.shading, right.shading);
            *self = Divider::default();
            self.follow_mouse(input);
            show.divider = Some(self.column);
            show.renew_right();
            said
        } else if show.divider.is_none() {
            return Ok(());
        } else if input.pressed(Key::X) {
            right.is_chosen = true;
            std::mem::swap(left, right);
            format!("{} | {}", left.shading, right.shading)
        } else if right.shading.follow(input, true) {
            right.forget_times();
            format!("right: {}", right.shading)
        } else {
            let is_click = self.follow_mouse(input);
            show.divider = Some(self.column);
            match (is_click, self.is_fixed) {
                (false, _) => return Ok(()),
                (true, true) => "divider fixed; a click releases it".to_string(),
                (true, false) => "the divider follows the mouse".to_string(),
            }
        };
        // The picture is a new one, even if only its right half has changed.
        show.number += 1;
        show.say(said);
        Ok(())
    }

    /// The divider, and over each half its shading, its time and its error.
    fn lay_over(&self, show: &Show, sheet: &mut Sheet) {
        let Some(column) = show.divider else { return };
        let picture = sheet.picture_area();
        // Within the window.
        let x = picture.from_frame(column as f32, 0.0).0 as i32;
        let (top, bottom) = (picture.top as i32, (picture.top + picture.height) as i32);
        sheet.line((x, top), (x, bottom), Rgb::WHITE, 1);
        for (half, side) in [Side::Left, Side::Right].into_iter().enumerate() {
            let [worst, mean] = match show.map.errors_of(show.number, half) {
                Some(figures) => [figures.max, figures.mean()].map(|error| format!("{error:.2}")),
                None => ["...", "..."].map(String::from),
            };
            let rows = [
                Row::text(show.halves[half].shading.to_string()),
                Row::new("time", show.halves[half].timing.to_string()),
                Row::new("worst", format!("{worst} shades")),
                Row::new("mean", format!("{mean} shades")),
            ];
            sheet.panel(side, &rows, false, 0, "");
        }
    }
}

/// The shading to compare with: light at every pixel, or the default if that is the shading itself.
fn opposite(left: &ShadingChoice) -> ShadingChoice {
    let exact = ShadingChoice::new(Shading::Phong, None);
    if left.to_string() == exact.to_string() { ShadingChoice::new(Shading::default(), None) } else { exact }
}

/// Divider of the picture.
#[derive(Debug)]
pub(super) struct Divider {
    /// 0 to 320.
    column: usize,
    is_fixed: bool,
    /// How far the mouse has moved since its button went down, while it is down.
    dragged: Option<f32>,
}

impl Default for Divider {
    fn default() -> Divider {
        Divider { column: Vga::WIDTH / 2, is_fixed: false, dragged: None }
    }
}

impl Divider {
    /// Follows the mouse unless it is fixed. Returns whether a click changed that.
    fn follow_mouse(&mut self, input: &Input) -> bool {
        let mut is_click = false;
        if input.buttons.left {
            *self.dragged.get_or_insert(0.0) += input.drag.0.abs() + input.drag.1.abs();
        } else {
            is_click = self.dragged.take().is_some_and(|dragged| dragged < CLICK);
            self.is_fixed ^= is_click;
        }
        if let Some((x, _)) = input.mouse.filter(|_| !self.is_fixed && !input.buttons.left) {
            // Columns of the frame.
            self.column = x.clamp(0.0, Vga::WIDTH as f32) as usize;
        }
        is_click
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_divider_follows_the_mouse_until_a_click_fixes_it() {
        let follow = |divider: &mut Divider, x, left, drag| {
            let mut input = Input::default();
            (input.mouse, input.buttons.left, input.drag) = (Some((x, 100.0)), left, drag);
            divider.follow_mouse(&input)
        };
        let mut divider = Divider::default();
        assert!(!follow(&mut divider, 40.7, false, (0.0, 0.0)));
        assert_eq!(divider.column, 40);
        for (x, column) in [(-9.0, 0), (400.0, 320), (100.0, 100)] {
            follow(&mut divider, x, false, (0.0, 0.0));
            assert_eq!(divider.column, column);
        }
        // A drag turns the model; meanwhile the divider stays.
        follow(&mut divider, 100.0, true, (0.0, 0.0));
        follow(&mut divider, 130.0, true, (30.0, 0.0));
        assert_eq!(divider.column, 100);
        assert!(!follow(&mut divider, 130.0, false, (0.0, 0.0)));
        assert_eq!((divider.column, divider.is_fixed), (130, false));
        // A click fixes it where it is.
        follow(&mut divider, 130.0, true, (0.0, 0.0));
        assert!(follow(&mut divider, 131.0, false, (0.0, 0.0)));
        follow(&mut divider, 20.0, false, (0.0, 0.0));
        assert_eq!((divider.column, divider.is_fixed), (130, true));
        follow(&mut divider, 20.0, true, (1.0, 0.0));
        assert!(follow(&mut divider, 20.0, false, (0.0, 0.0)));
        assert_eq!((divider.column, divider.is_fixed), (20, false));
    }

    #[test]
    fn a_shading_is_compared_with_another() {
        let names = |left: ShadingChoice| opposite(&left).to_string();
        assert_eq!(names(ShadingChoice::new(Shading::Flat, None)), "phong");
        assert_eq!(names(ShadingChoice::new(Shading::Phong, Some(2.0))), "phong", "a budget against exact");
        assert_eq!(names(ShadingChoice::new(Shading::Phong, None)), Shading::default().name());
    }
}
