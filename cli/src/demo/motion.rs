//! Motion by the clock and by hand.

use mode13h::vga::Vga;

use super::{Failure, Input, Key, Keys, Panel, Row, Show};
use crate::turntable::Pose;

pub(super) const KEYS: Keys = &[("Space", "Pause or resume"), ("arrows, mouse", "Turn"), ("+ -, wheel", "Zoom")];

/// The note on a stopped picture.
pub(super) const STOPPED: &str = "stopped";
/// Speed of turning by the arrow keys, in radians a second.
const ARROW_SPEED: f64 = 2.0;
/// Angle by which one press of an arrow key turns at once, in radians, so that a tap shorter than a frame shows too.
pub(super) const ARROW_TAP: f64 = 0.05;
/// Angle by which a drag over one pixel of the frame turns, in radians: half a turn over its width.
const DRAG: f64 = std::f64::consts::PI / Vga::WIDTH as f64;
/// A pixel's height in pixel widths.
const PIXEL_HEIGHT: f64 = Vga::PIXEL_ASPECT.1 as f64 / Vga::PIXEL_ASPECT.0 as f64;
/// Factor by which one notch of the wheel, or one + or -, enlarges.
pub(super) const NOTCH: f64 = 1.1;
/// The minimum and maximum zoom.
const ZOOM: (f64, f64) = (0.25, 8.0);
/// The longest time that a key counts as held for in one frame, in seconds, so that nothing jumps after a pause.
const LONGEST_FRAME: f64 = 0.1;

/// Motion: the scene's time, which follows the clock unless it is stopped, and the pose set by the user.
pub(super) struct Motion {
    /// The scene's time at the time `change`, in seconds.
    time: f64,
    /// Time at which the clock began to move it, in seconds; `None` while it is stopped.
    change: Option<f64>,
    pub(super) pose: Pose,
    /// Time of the last frame.
    pub(super) now: f64,
}

impl Motion {
    pub(super) fn new() -> Motion {
        Motion { time: 0.0, change: Some(0.0), pose: Pose::FIRST, now: 0.0 }
    }

    /// Sets the scene's time to `seconds`; it goes on from there.
    pub(super) fn go_to(&mut self, seconds: f64) {
        self.time = seconds;
        self.change = self.change.map(|_| self.now);
    }

    /// Stops time, or starts it again.
    pub(super) fn toggle(&mut self) {
        self.time = self.seconds();
        self.change = if self.change.is_none() { Some(self.now) } else { None };
    }

    pub(super) fn zoom(&mut self, factor: f64) {
        self.pose.zoom = (self.pose.zoom * factor).clamp(ZOOM.0, ZOOM.1);
    }

    /// Applies the user's input up to the time `seconds`. Returns a text that says what has changed.
    fn move_by(&mut self, input: &Input, seconds: f64) -> Option<String> {
        let was = (self.change.is_some(), self.pose);
        let passed = (seconds - self.now).clamp(0.0, LONGEST_FRAME);
        self.now = seconds;
        if input.pressed(Key::Space) {
            self.toggle();
        }
        let arrow = |key| {
            let held = if input.held(key) { ARROW_SPEED * passed } else { 0.0 };
            held + if input.pressed(key) { ARROW_TAP } else { 0.0 }
        };
        let (right, down) = input.drag;
        self.pose.turn += arrow(Key::Right) - arrow(Key::Left) + DRAG * f64::from(right);
        self.pose.tilt += arrow(Key::Down) - arrow(Key::Up) + DRAG * PIXEL_HEIGHT * f64::from(down);

        let typed = |characters: &[char]| input.typed.contains(characters);
        let mut notches = f64::from(input.wheel);
        if input.pressed(Key::NumPadPlus) || typed(&['+', '=']) {
            notches += 1.0;
        }
        if input.pressed(Key::NumPadMinus) || typed(&['-', '_']) {
            notches -= 1.0;
        }
        self.zoom(NOTCH.powf(notches));
        let Pose { turn, tilt, zoom } = self.pose;
        if self.change.is_some() != was.0 {
            Some(if self.is_stopped() { STOPPED } else { "goes on" }.to_string())
        } else if notches != 0.0 {
            Some(format!("zoom {zoom:.2}"))
        } else {
            // However far it has been turned, less than a full turn is shown.
            let [turn, tilt] = [turn, tilt].map(|angle| angle.to_degrees() % 360.0);
            (self.pose != was.1).then(|| format!("turned {turn:.0}°, tilted {tilt:.0}°"))
        }
    }

    /// Returns whether the clock is stopped.
    pub(super) fn is_stopped(&self) -> bool {
        self.change.is_none()
    }

    /// The scene's time at the time of the last [`move_by`](Self::move_by). It comes from the clock and not from the frames
    /// that were drawn since.
    pub(super) fn seconds(&self) -> f64 {
        self.time + self.change.map_or(0.0, |change| self.now - change)
    }
}

impl Panel for Motion {
    fn follow(&mut self, input: &Input, show: &mut Show) -> Result<(), Failure> {
        if let Some(said) = self.move_by(input, show.seconds) {
            show.say(said);
        }
        Ok(())
    }

    fn renew(&mut self, show: &mut Show, keeps: bool) -> Result<(), Failure> {
        if !keeps {
            // Stays stopped if it is.
            self.pose = Pose::FIRST;
            self.go_to(show.inputs.moment.of_first());
        }
        Ok(())
    }

    fn figures(&self, _: &Show) -> Vec<Row> {
        vec![Row::new("zoom", format!("{:.2}", self.pose.zoom))]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_comes_from_the_clock_and_not_from_the_frames() {
        let time_after = |times: &[f64]| {
            let mut motion = Motion::new();
            for &seconds in times {
                motion.move_by(&Input::default(), seconds);
            }
            (motion.seconds(), motion.pose)
        };
        let many: Vec<f64> = (0..=1_000_000).map(|i| f64::from(i) / 1000.0).collect();
        assert_eq!(time_after(&many), time_after(&[1000.0]));
    }

    #[test]
    fn an_hour_in_one_frame_is_an_hour_of_the_scene() {
        let mut motion = Motion::new();
        for seconds in [0.0, 0.0, 3600.0, 3599.0] {
            motion.move_by(&Input::default(), seconds);
            assert_eq!(motion.seconds(), seconds);
        }
    }
}
