//! The user's input between two frames.

use std::cell::RefCell;
use std::mem;
use std::rc::Rc;

use minifb::{InputCallback, MouseButton, MouseMode, Window};

use super::area::Area;
use super::key::Key;

/// The value that minifb reports for one notch of the wheel. On X11, where the wheel is a button, minifb counts both
/// press and release.
const NOTCH: f32 = if cfg!(all(unix, not(target_os = "macos"))) { 0.5 } else { 1.0 };

/// A flag for each mouse button.
#[derive(Clone, Copy, Hash, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Buttons {
    /// The left button.
    pub left: bool,
    /// The middle button.
    pub middle: bool,
    /// The right button.
    pub right: bool,
}

impl Buttons {
    /// The buttons that are set here but not in `other`.
    fn but_not(self, other: Self) -> Self {
        let Self { left, middle, right } = self;
        Self { left: left && !other.left, middle: middle && !other.middle, right: right && !other.right }
    }
}

/// The user's input since the last frame, and the keys and buttons that are down.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Input {
    pressed: Vec<Key>,
    /// The keys in `pressed` that went down while Shift was down.
    shifted: Vec<Key>,
    held: Vec<Key>,
    released: Vec<Key>,
    /// The seconds since the last frame, for moving things in a game; cast it `as f32` for positions.
    pub elapsed: f64,
    /// The characters typed since the last frame, in the user's keyboard layout. Held keys repeat as configured on the
    /// desktop.
    pub typed: String,
    /// The position of the mouse, in pixels of the picture, from the top left corner: 0 to 320 across and 0 to 200 down
    /// on a mode 13h picture, and beyond these on bars beside it; `None` outside the window.
    pub mouse: Option<(f32, f32)>,
    /// The mouse buttons that are down.
    pub buttons: Buttons,
    /// The mouse buttons that went down since the last frame, and are still down.
    pub buttons_pressed: Buttons,
    /// The mouse buttons that went up since the last frame.
    pub buttons_released: Buttons,
    /// How far the mouse was dragged with the left button since the last frame, in pixels of the picture: to the right
    /// and down.
    pub drag: (f32, f32),
    /// The number of notches that the wheel was turned since the last frame; away from the user is positive.
    pub wheel: f32,
}

impl Input {
    /// Returns whether the key went down since the last frame, however briefly.
    pub fn pressed(&self, key: Key) -> bool {
        self.pressed.contains(&key)
    }

    /// Returns whether the key went down since the last frame while Shift was down, however briefly.
    pub fn pressed_with_shift(&self, key: Key) -> bool {
        self.shifted.contains(&key)
    }

    /// Returns whether the key is down.
    pub fn held(&self, key: Key) -> bool {
        self.held.contains(&key)
    }

    /// Returns whether the key was released since the last frame. A key that is down when the window loses focus counts
    /// as released.
    pub fn released(&self, key: Key) -> bool {
        self.released.contains(&key)
    }

    /// Returns whether the user did anything since `before`, or holds a key or button.
    pub(super) fn differs(&self, before: &Input) -> bool {
        !(self.pressed.is_empty() && self.held.is_empty() && self.released.is_empty() && self.typed.is_empty())
            || (self.mouse, self.buttons) != (before.mouse, before.buttons)
            || (self.drag, self.wheel) != ((0.0, 0.0), 0.0)
    }
}

/// Keys and characters in the order in which the desktop reported them. minifb's own list of pressed keys omits those
/// that went down and up again between two frames.
#[derive(Default)]
struct Queue {
    keys: Vec<(Key, bool)>,
    typed: String,
}

/// Collects what happens in a window.
#[derive(Clone, Default)]
pub(super) struct Events {
    queue: Rc<RefCell<Queue>>,
    held: Vec<Key>,
    /// The mouse buttons that were down at the last call.
    buttons: Buttons,
    active: bool,
    /// The last position of the mouse with its left button down, in columns and rows of the picture.
    dragged_from: Option<(f32, f32)>,
}

impl InputCallback for Events {
    fn add_char(&mut self, character: u32) {
        self.queue.borrow_mut().typed.extend(char::from_u32(character).filter(|c| !c.is_control()));
    }

    fn set_key_state(&mut self, key: minifb::Key, down: bool) {
        self.queue.borrow_mut().keys.extend(Key::of(key).map(|key| (key, down)));
    }
}

impl Events {
    /// Collects the input since the last call. `place` is the rectangle of the window that the picture fills, and
    /// `size` the picture's columns and rows.
    pub(super) fn collect(&mut self, window: &Window, place: Area, size: (usize, usize)) -> Input {
        let Queue { keys, typed } = mem::take(&mut *self.queue.borrow_mut());
        let mut input = Input { typed, ..self.follow(&keys) };
        // A window without focus does not see key releases.
        let was_active = mem::replace(&mut self.active, window.is_active());
        if was_active && !self.active {
            input.released.append(&mut self.held);
        }

        let to_frame = |(x, y)| place.to_picture(x, y, size);
        input.mouse = window.get_unscaled_mouse_pos(MouseMode::Discard).map(to_frame);
        input.buttons = Buttons {
            left: window.get_mouse_down(MouseButton::Left),
            middle: window.get_mouse_down(MouseButton::Middle),
            right: window.get_mouse_down(MouseButton::Right),
        };
        let before = mem::replace(&mut self.buttons, input.buttons);
        input.buttons_pressed = input.buttons.but_not(before);
        input.buttons_released = before.but_not(input.buttons);
        // Tracked outside the window, too, while the button is still down.
        let anywhere = window.get_unscaled_mouse_pos(MouseMode::Pass).map(to_frame);
        input.drag = self.drag(anywhere.filter(|_| input.buttons.left));
        input.wheel = window.get_scroll_wheel().map_or(0.0, |(_, notches)| notches * NOTCH);
        // The window fills in how long the frame took.
        input.held.clone_from(&self.held);
        input
    }

    /// Applies key events in order and returns the keys that went down or were released. Repeats of a held key do not
    /// count.
    fn follow(&mut self, events: &[(Key, bool)]) -> Input {
        let mut keys = Input::default();
        for &(key, down) in events {
            let held = self.held.contains(&key);
            if down && !held {
                if [Key::LeftShift, Key::RightShift].iter().any(|shift| self.held.contains(shift)) {
                    keys.shifted.push(key);
                }
                self.held.push(key);
                keys.pressed.push(key);
            } else if !down && held {
                self.held.retain(|&other| other != key);
                keys.released.push(key);
            }
        }
        keys
    }

    /// How far the mouse moved since the last call, if its button was down then and is now.
    fn drag(&mut self, at: Option<(f32, f32)>) -> (f32, f32) {
        let from = mem::replace(&mut self.dragged_from, at);
        match (from, at) {
            (Some(from), Some(at)) => (at.0 - from.0, at.1 - from.1),
            _ => (0.0, 0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_that_is_down_and_up_between_two_frames_was_pressed() {
        let mut events = Events::default();
        let keys = events.follow(&[(Key::S, true), (Key::S, false)]);
        assert_eq!((&keys.pressed[..], &keys.released[..]), (&[Key::S][..], &[Key::S][..]));
        assert!(events.held.is_empty());
        // A key that was not down cannot be released.
        assert_eq!(events.follow(&[(Key::S, false)]).released, []);
    }

    #[test]
    fn a_key_that_repeats_is_pressed_once() {
        let mut events = Events::default();
        assert_eq!(events.follow(&[(Key::K, true), (Key::K, true)]).pressed, [Key::K]);
        assert_eq!(events.follow(&[(Key::K, true)]).pressed, []);
        assert_eq!(events.held, [Key::K]);
        assert_eq!(events.follow(&[(Key::K, false), (Key::K, true)]).pressed, [Key::K]);
    }

    #[test]
    fn shift_counts_if_it_is_down_when_the_key_goes_down() {
        let (down, up) = (true, false);
        let mut events = Events::default();
        // Both Shift and the key go down and up between two frames.
        let keys = [(Key::LeftShift, down), (Key::B, down), (Key::B, up), (Key::LeftShift, up)];
        assert_eq!(events.follow(&keys).shifted, [Key::B]);
        assert_eq!(events.follow(&[(Key::B, down), (Key::B, up), (Key::RightShift, down)]).shifted, []);
        // Shift has been down since the frame before.
        assert_eq!(events.follow(&[(Key::B, down), (Key::RightShift, up)]).shifted, [Key::B]);
        assert_eq!(events.follow(&[(Key::B, up), (Key::B, down)]).shifted, []);
    }

    #[test]
    fn what_the_user_does_is_told_from_nothing() {
        let nothing = Input { mouse: Some((1.0, 2.0)), ..Input::default() };
        assert!(!nothing.differs(&nothing));
        for something in [
            Input { pressed: vec![Key::H], ..nothing.clone() },
            Input { held: vec![Key::Left], ..nothing.clone() },
            Input { released: vec![Key::Left], ..nothing.clone() },
            Input { typed: "+".to_string(), ..nothing.clone() },
            Input { mouse: None, ..nothing.clone() },
            Input { buttons: Buttons { left: true, ..Buttons::default() }, ..nothing.clone() },
            Input { drag: (0.0, 1.0), ..nothing.clone() },
            Input { wheel: -1.0, ..nothing.clone() },
        ] {
            assert!(something.differs(&nothing), "{something:?}");
        }
    }

    #[test]
    fn buttons_change_one_by_one() {
        let left = Buttons { left: true, ..Buttons::default() };
        let both = Buttons { right: true, ..left };
        assert_eq!(both.but_not(left), Buttons { right: true, ..Buttons::default() });
        assert_eq!(left.but_not(both), Buttons::default());
    }

    #[test]
    fn a_drag_begins_where_the_button_went_down() {
        let mut events = Events::default();
        assert_eq!(events.drag(Some((100.0, 50.0))), (0.0, 0.0));
        assert_eq!(events.drag(Some((103.0, 48.0))), (3.0, -2.0));
        assert_eq!(events.drag(None), (0.0, 0.0));
        assert_eq!(events.drag(Some((0.0, 0.0))), (0.0, 0.0));
    }
}
