//! Frames per second, and the resulting delay of each frame in 1/100 s, the unit of GIF.

use super::error::{AnimationError, AnimationErrorKind, FRAME_RATES};

/// An animation's frames per second, 0.1 to 50.
///
/// Browsers show at most 50 frames per second: a delay below 2/100 s becomes 10/100 s there. 35, the default, is every
/// second retrace of the VGA.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameRate(f64);

/// Converts from frames per second, 0.1 to 50.
impl TryFrom<f64> for FrameRate {
    type Error = AnimationError;

    fn try_from(frames_per_second: f64) -> Result<FrameRate, AnimationError> {
        // NaN is in no range.
        match FRAME_RATES.contains(&frames_per_second) {
            true => Ok(FrameRate(frames_per_second)),
            false => Err(AnimationErrorKind::FrameRate { frames_per_second }.into()),
        }
    }
}

impl FrameRate {
    /// The lowest rate: a frame stays for ten seconds.
    pub const LOWEST: FrameRate = FrameRate(*FRAME_RATES.start());
    /// The highest rate.
    pub const HIGHEST: FrameRate = FrameRate(*FRAME_RATES.end());

    /// Returns the rate in frames per second.
    pub fn frames_per_second(self) -> f64 {
        self.0
    }

    /// The rate as a fraction of two 16-bit numbers; no smaller ones come nearer: 35 is 35/1, 29.97 is 2997/100.
    ///
    /// ```
    /// use mode13h_assets::animation::FrameRate;
    /// assert_eq!(FrameRate::default().fraction(), (35, 1));
    /// assert_eq!(FrameRate::try_from(29.97)?.fraction(), (2997, 100));
    /// # Ok::<(), mode13h_assets::animation::AnimationError>(())
    /// ```
    pub fn fraction(self) -> (u16, u16) {
        fraction(self.0)
    }

    /// The delay of frame `number`, counted from 0, in 1/100 s: 2 to 1,000. A frame begins at the first hundredth that
    /// is not before its time, ⌈100·number / rate⌉, regardless of the frames before it, so errors do not add up.
    ///
    /// ```
    /// use mode13h_assets::animation::FrameRate;
    /// let delays: Vec<u16> = (0..8).map(|number| FrameRate::default().delay(number)).collect();
    /// assert_eq!(delays, [3, 3, 3, 3, 3, 3, 2, 3]);
    /// ```
    pub fn delay(self, number: u64) -> u16 {
        // The last bit of a rate of at least 0.1 is at 2⁻⁵⁶ or above: this is an integer below 2⁶².
        let rate = (self.0 * (1_u64 << 56) as f64) as u128;
        // 100 · 2⁶⁴ · 2⁵⁶ is below 2¹²⁷.
        let begins = |number: u128| ((100 * number) << 56).div_ceil(rate);
        let number = u128::from(number);
        // 100 / rate is 2 to 1,000, and so is the difference of two values that far apart, each rounded up.
        (begins(number + 1) - begins(number)) as u16
    }
}

impl Default for FrameRate {
    fn default() -> FrameRate {
        FrameRate(35.0)
    }
}

/// The last convergent of a positive number's continued fraction whose two numbers are below 2¹⁶. No fraction of
/// smaller numbers is nearer.
fn fraction(number: f64) -> (u16, u16) {
    let (mut before, mut last) = ((0_u16, 1_u16), (1_u16, 0_u16));
    let mut rest = number;
    loop {
        let whole = rest.floor();
        let next = |last: u16, before: u16| {
            let next = whole * f64::from(last) + f64::from(before);
            (next <= f64::from(u16::MAX)).then_some(next as u16)
        };
        let (Some(above), Some(below)) = (next(last.0, before.0), next(last.1, before.1)) else { return last };
        (before, last) = (last, (above, below));
        // The fraction equals the number to the precision of f64.
        if f64::from(above) / f64::from(below) == number || rest == whole {
            return last;
        }
        rest = 1.0 / (rest - whole);
    }
}
