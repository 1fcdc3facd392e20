//! Choice of the shading by keys: a shading, an error budget, or a time for each frame.

use std::fmt;
use std::time::Duration;

use mode13h::render::{Pace, Renderer, Stats};
use mode13h::settings::{Accuracy, Shading};
use mode13h::window::{Input, Key};

use crate::options::pace;

/// The budgets that B steps through, in shades of 1/255 of full intensity.
pub(super) const BUDGETS: [f32; 6] = [16.0, 8.0, 4.0, 2.0, 1.0, 0.5];
/// The budget of a scene that asks for none.
const USUAL: f32 = 2.0;

/// The times that F steps through, in milliseconds, and that of a scene that asks for none.
const TIMES: [f32; 7] = [16.0, 8.0, 4.0, 2.0, 1.0, 0.5, 0.25];
const USUAL_TIME: f32 = 1.0;

/// The keys 1 to 9, in the top row and on the number pad, and what they type. The tenth shading has no digit.
const DIGITS: [(Key, Key, char); 9] = [
    (Key::Key1, Key::NumPad1, '1'),
    (Key::Key2, Key::NumPad2, '2'),
    (Key::Key3, Key::NumPad3, '3'),
    (Key::Key4, Key::NumPad4, '4'),
    (Key::Key5, Key::NumPad5, '5'),
    (Key::Key6, Key::NumPad6, '6'),
    (Key::Key7, Key::NumPad7, '7'),
    (Key::Key8, Key::NumPad8, '8'),
    (Key::Key9, Key::NumPad9, '9'),
];

/// A key's request.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Wish {
    /// This shading.
    Shading(Shading),
    /// The next cheaper shading.
    Cheaper,
    /// The next more expensive one.
    Dearer,
    /// The budget.
    Budget,
    /// The budget, or a smaller error if that is on already.
    Less,
    /// The budget, or a greater error if that is on already.
    More,
    /// The time, or a shorter one if that is on already.
    Shorter,
    /// The time, or a longer one if that is on already.
    Longer,
}

/// Finds the user's request, if there is any, for the picture or, with the same keys and Shift, for its right half.
fn wish(input: &Input, is_right: bool) -> Option<Wish> {
    let typed = |character: char| input.typed.contains(character);
    let is_down = |&(key, pad, character): &(Key, Key, char)| match is_right {
        // Where digits are typed with Shift, as in France, a key in the top row means what it types, for the left half.
        true => input.pressed_with_shift(key) && !typed(character),
        false => input.pressed(pad) || typed(character) || (input.pressed(key) && input.typed.is_empty()),
    };
    let bracket = |key, character| {
        let is_pressed = input.pressed(key) && input.pressed_with_shift(key) == is_right;
        is_pressed || (!is_right && typed(character))
    };
    let letter = |key, plain, with_shift| {
        let wish = if input.pressed_with_shift(key) { with_shift } else { plain };
        (input.pressed(key) && !is_right).then_some(wish)
    };
    let digit = DIGITS.iter().zip(Shading::ALL).find(|(digit, _)| is_down(digit));
    digit
        .map(|(_, shading)| Wish::Shading(shading))
        .or(is_down(&(Key::Key0, Key::NumPad0, '0')).then_some(Wish::Budget))
        .or(letter(Key::B, Wish::Less, Wish::More))
        .or(letter(Key::F, Wish::Shorter, Wish::Longer))
        .or(bracket(Key::LeftBracket, '[').then_some(Wish::Cheaper))
        .or(bracket(Key::RightBracket, ']').then_some(Wish::Dearer))
}

/// The next smaller entry of a descending list; `than` need not be in the list itself.
fn less(list: &[f32], than: f32) -> f32 {
    list.iter().copied().find(|&entry| entry < than).unwrap_or(than)
}

fn more(list: &[f32], than: f32) -> f32 {
    list.iter().copied().rfind(|&entry| entry > than).unwrap_or(than)
}

/// How shades are chosen.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum By {
    Shading,
    Budget,
    Time,
}

/// A shading, a budget and a time, one of which is in force.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct ShadingChoice {
    shading: Shading,
    /// The error budget, in shades.
    budget: f32,
    /// The time for a frame, in milliseconds.
    time: f32,
    /// The greatest error that a time may choose, if one was named.
    max_error: Option<f32>,
    by: By,
}

impl ShadingChoice {
    /// The budget, if there is one, or else the shading.
    pub(super) fn new(shading: Shading, budget: Option<f32>) -> ShadingChoice {
        let by = if budget.is_some() { By::Budget } else { By::Shading };
        ShadingChoice { shading, budget: budget.unwrap_or(USUAL), time: USUAL_TIME, max_error: None, by }
    }

    /// Makes the choice that draws with this accuracy, or in this time.
    pub(super) fn of((accuracy, time): (Accuracy, Option<f32>)) -> ShadingChoice {
        match time {
            None => ShadingChoice::new(accuracy.shading(), accuracy.max_error()),
            Some(time) => {
                let choice = ShadingChoice::new(accuracy.shading(), None);
                ShadingChoice { time, max_error: accuracy.max_error(), by: By::Time, ..choice }
            }
        }
    }

    /// Handles the user's input for the picture, or for its right half. Returns whether there was a request.
    pub(super) fn follow(&mut self, input: &Input, is_right: bool) -> bool {
        let wish = wish(input, is_right);
        wish.into_iter().for_each(|wish| self.fulfil(wish));
        wish.is_some()
    }

    fn fulfil(&mut self, wish: Wish) {
        let by = match wish {
            Wish::Budget | Wish::Less | Wish::More => By::Budget,
            Wish::Shorter | Wish::Longer => By::Time,
            Wish::Shading(_) | Wish::Cheaper | Wish::Dearer => By::Shading,
        };
        let was = std::mem::replace(&mut self.by, by);
        // The variants are numbered in the order of ALL.
        let place = self.shading as usize;
        match wish {
            Wish::Shading(shading) => self.shading = shading,
            Wish::Cheaper => self.shading = Shading::ALL[place.saturating_sub(1)],
            Wish::Dearer => self.shading = Shading::ALL[(place + 1).min(Shading::ALL.len() - 1)],
            Wish::Budget => {}
            _ if was != by => {}
            Wish::Less => self.budget = less(&BUDGETS, self.budget),
            Wish::More => self.budget = more(&BUDGETS, self.budget),
            Wish::Shorter => self.time = less(&TIMES, self.time),
            Wish::Longer => self.time = more(&TIMES, self.time),
        }
    }

    /// Sets a renderer to draw the next frame this way.
    pub(super) fn set(&self, renderer: &mut Renderer, pacing: &mut Pacing) {
        let accuracy = match self.by {
            By::Shading => Accuracy::Shading(self.shading),
            By::Budget => Accuracy::WithinError(self.budget),
            By::Time => pacing.of(self.time, self.max_error.unwrap_or(Pace::MAX_ERROR)).accuracy(),
        };
        if self.by != By::Time {
            pacing.0 = None;
        }
        renderer.settings.accuracy = Some(accuracy);
    }

    /// The error that is or would be accepted, in shades; with a time, which chooses it, that of the last frame.
    pub(super) fn budget(&self, last: Option<&Stats>) -> f32 {
        let chosen = if self.by == By::Time { last.and_then(|stats| stats.max_error) } else { None };
        chosen.unwrap_or(self.budget)
    }
}

/// The pace of frames that should fit in a time, with that time and the greatest error.
#[derive(Default)]
pub(super) struct Pacing(Option<((f32, f32), Pace)>);

impl Pacing {
    /// The pace for this time and this greatest error.
    fn of(&mut self, time: f32, max_error: f32) -> &Pace {
        let known = self.0.take().filter(|(of, _)| *of == (time, max_error));
        &self.0.insert(known.unwrap_or_else(|| ((time, max_error), pace(time, max_error)))).1
    }

    /// Records how long the last frame took.
    pub(super) fn report(&mut self, stats: &Stats, time: Duration) {
        if let Some((_, pace)) = &mut self.0 {
            pace.report(stats, time);
        }
    }

    /// Returns whether frames fit, if they should fit in a time.
    pub(super) fn fits(&self) -> Option<bool> {
        self.0.as_ref().map(|(_, pace)| pace.fits())
    }
}

impl fmt::Display for ShadingChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.by {
            By::Budget => write!(f, "budget {} {}", self.budget, if self.budget == 1.0 { "shade" } else { "shades" }),
            By::Time => write!(f, "{} ms a frame", self.time),
            By::Shading => f.write_str(self.shading.name()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_the_first_nine_shadings_and_brackets_reach_them_all() {
        assert_eq!(DIGITS.len(), Shading::ALL.len() - 1);
        let mut shading = ShadingChoice::new(Shading::ALL[4], None);
        (0..20).for_each(|_| shading.fulfil(Wish::Cheaper));
        for expected in Shading::ALL {
            assert_eq!((shading.shading, shading.to_string()), (expected, expected.name().to_string()));
            shading.fulfil(Wish::Dearer);
        }
        assert_eq!(shading.shading, Shading::ALL[9]);
        for (i, (key, pad, character)) in DIGITS.into_iter().enumerate() {
            assert_eq!(key as usize, i + 1);
            assert_eq!(pad as usize, Key::NumPad0 as usize + i + 1);
            assert_eq!(character.to_digit(10), Some(i as u32 + 1));
        }
    }

    #[test]
    fn b_goes_through_the_budgets_and_shift_b_back() {
        let mut shading = ShadingChoice::new(Shading::Flat, None);
        // The first press changes from the shading to the budget and nothing else.
        shading.fulfil(Wish::Less);
        assert_eq!(shading, ShadingChoice::new(Shading::Flat, Some(USUAL)));
        (0..9).for_each(|_| shading.fulfil(Wish::More));
        for budget in BUDGETS {
            let shades = if budget == 1.0 { "shade" } else { "shades" };
            assert_eq!(shading.to_string(), format!("budget {budget} {shades}"));
            shading.fulfil(Wish::Less);
        }
        assert_eq!(shading.budget(None), 0.5);
        shading.fulfil(Wish::More);
        assert_eq!(shading.budget(None), 1.0);
        shading.fulfil(Wish::Shading(Shading::Phong));
        assert_eq!(shading.to_string(), "phong");
        shading.fulfil(Wish::Budget);
        assert_eq!(shading.to_string(), "budget 1 shade");
        // One that is not in the list.
        let mut shading = ShadingChoice::new(Shading::Flat, Some(3.0));
        shading.fulfil(Wish::More);
        assert_eq!(shading.budget(None), 4.0);
        let mut shading = ShadingChoice::new(Shading::Flat, Some(0.1));
        shading.fulfil(Wish::Less);
        assert_eq!(shading.budget(None), 0.1);
    }

    #[test]
    fn f_goes_through_the_times_and_shift_f_back() {
        let mut shading = ShadingChoice::new(Shading::Flat, Some(4.0));
        shading.fulfil(Wish::Longer);
        assert_eq!(shading.to_string(), "1 ms a frame");
        (0..9).for_each(|_| shading.fulfil(Wish::Longer));
        for time in TIMES {
            assert_eq!(shading.to_string(), format!("{time} ms a frame"));
            shading.fulfil(Wish::Shorter);
        }
        assert_eq!(shading.to_string(), "0.25 ms a frame");
        shading.fulfil(Wish::Budget);
        assert_eq!(shading.to_string(), "budget 4 shades");
        // The command line's, with the greatest error that it names.
        let shading = ShadingChoice::of((Accuracy::WithinError(8.0), Some(3.0)));
        assert_eq!(shading.to_string(), "3 ms a frame");
        let mut renderer = Renderer::new();
        let mut pacing = Pacing::default();
        shading.set(&mut renderer, &mut pacing);
        assert_eq!((renderer.settings.accuracy, pacing.fits()), (Some(Accuracy::WithinError(8.0)), Some(true)));
        ShadingChoice::new(Shading::Phong, None).set(&mut renderer, &mut pacing);
        assert_eq!(pacing.fits(), None);
    }

    #[test]
    fn a_renderer_draws_by_what_was_chosen() {
        let mut renderer = Renderer::new();
        ShadingChoice::new(Shading::Flat, Some(4.0)).set(&mut renderer, &mut Pacing::default());
        assert_eq!(renderer.settings.accuracy, Some(Accuracy::WithinError(4.0)));
        ShadingChoice::new(Shading::Phong, None).set(&mut renderer, &mut Pacing::default());
        assert_eq!(renderer.settings.accuracy, Some(Accuracy::Shading(Shading::Phong)));
    }
}
