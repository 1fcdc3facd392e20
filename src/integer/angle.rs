//! Angles and their sines, from a table.
//!
//! A binary angle counts 1/65,536 turns in 16 bits, so a full turn wraps to 0 and no angle ever needs range reduction.
//! A quarter wave of 16,385 sines would take 64 KiB. Two short tables give the same by the addition theorem,
//! ```text
//! sin(a + b) = sin a · cos b + cos a · sin b       a: a 512th of a turn, b: less than that
//! ```
//!
//! in 1.5 KiB. Their entries are sums of Taylor series in integers, computed at compile time: [`BinaryAngle::sin`] is
//! the multiple of 1/65,536 nearest to the true sine, for every angle.

use core::ops::Add;

#[cfg(feature = "alloc")]
use crate::angle::Angle;
use crate::fixed::I16F16;

/// The number of fractional bits of the table's sines.
pub(super) const SINE_BITS: u32 = 30;

/// ⌊π · 2⁶⁰⌋.
const PI_Q60: i128 = 3_622_009_729_038_561_421;

/// The number of coarse steps in a quarter turn.
const COARSE: usize = 128;
/// The number of fine steps, of one binary angle each, in a coarse one.
const FINE: usize = 128;

/// sin x with 30 fractional bits, rounded to the nearest, by its Taylor series; x has 60 fractional bits and is 0 to
/// π/2.
const fn sine_q30(x: i128) -> i32 {
    let (mut sum, mut term, mut k) = (x, x, 1);
    // Each term loses less than 2 in its last bit: about forty units of 2⁻⁶⁰ in all.
    while term != 0 {
        term = -((((term * x) >> 60) * x) >> 60) / ((k + 1) * (k + 2));
        sum += term;
        k += 2;
    }
    // At most 2³⁰.
    ((sum + (1 << 29)) >> 30) as i32
}

/// The sines of the coarse steps, 0 to a quarter turn, both ends included.
static COARSE_SINES: [i32; COARSE + 1] = {
    let mut table = [0; COARSE + 1];
    let mut i = 0;
    while i <= COARSE {
        table[i] = sine_q30(PI_Q60 * i as i128 / (2 * COARSE as i128));
        i += 1;
    }
    table
};

/// The sine and the cosine of each fine step.
static FINE_SINES: [[i32; 2]; FINE] = {
    let mut table = [[0; 2]; FINE];
    let mut i = 0;
    while i < FINE {
        let x = PI_Q60 * i as i128 / (2 * COARSE as i128 * FINE as i128);
        table[i] = [sine_q30(x), sine_q30(PI_Q60 / 2 - x)];
        i += 1;
    }
    table
};

/// A binary angle: 16 bits, 65,536 to a full turn, counter-clockwise.
///
/// ```
/// use mode13h::integer::BinaryAngle;
/// assert_eq!(BinaryAngle::QUARTER.sin().to_bits(), 65_536);
/// assert_eq!(BinaryAngle::from_degrees(-330), BinaryAngle::from_degrees(30));
/// assert_eq!(BinaryAngle::from_degrees(30).sin().to_bits(), 32_766); // 30° is 5461.33, rounded to 5461
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct BinaryAngle(u16);

/// Converts from 1/65,536 turns.
impl From<u16> for BinaryAngle {
    #[inline]
    fn from(steps: u16) -> Self {
        Self(steps)
    }
}

/// Converts to 1/65,536 turns.
impl From<BinaryAngle> for u16 {
    #[inline]
    fn from(angle: BinaryAngle) -> Self {
        angle.0
    }
}

impl BinaryAngle {
    /// A quarter of a turn.
    pub const QUARTER: Self = Self(0x4000);
    /// Half a turn.
    pub const HALF: Self = Self(0x8000);

    /// The angle nearest to a whole number of degrees, which may be several turns in either direction.
    #[must_use]
    pub const fn from_degrees(degrees: i32) -> Self {
        // At most 359 · 65,536 + 180. The result is 0 to 65,536, and a full turn wraps to 0.
        Self(((degrees.rem_euclid(360) * 65_536 + 180) / 360) as u16)
    }

    /// The sine, rounded to the nearest multiple of 1/65,536.
    #[must_use]
    pub fn sin(self) -> I16F16 {
        let sine = self.wide_sine();
        let magnitude = (sine.abs() + (1 << 43)) >> 44;
        // Within ±65,536.
        I16F16::from_bits((magnitude * sine.signum()) as i32)
    }

    /// The cosine, rounded to the nearest multiple of 1/65,536.
    #[must_use]
    pub fn cos(self) -> I16F16 {
        (self + Self::QUARTER).sin()
    }

    /// Sine and cosine with 30 fractional bits, each within 2 units of 2⁻³⁰, and within ±2³⁰.
    pub(super) fn sin_cos(self) -> (i64, i64) {
        let narrow = |sine: i64| {
            let magnitude = (sine.abs() + (1 << 29)) >> 30;
            // Rounding in the two tables may add up to slightly more than 1.
            magnitude.min(1 << SINE_BITS) * sine.signum()
        };
        (narrow(self.wide_sine()), narrow((self + Self::QUARTER).wide_sine()))
    }

    /// The sine with 60 fractional bits, about 30 of them correct.
    fn wide_sine(self) -> i64 {
        let in_half = self.0 & 0x7FFF;
        // The second quarter runs backward: 0 to 16,384.
        let in_quarter = usize::from(if in_half > 0x4000 { 0x8000 - in_half } else { in_half });
        let (coarse, fine) = (in_quarter / FINE, in_quarter % FINE);
        let (sin_a, cos_a) = (i64::from(COARSE_SINES[coarse]), i64::from(COARSE_SINES[COARSE - coarse]));
        let [sin_b, cos_b] = FINE_SINES[fine];
        // At most 2⁶⁰ · √2.
        let sine = sin_a * i64::from(cos_b) + cos_a * i64::from(sin_b);
        if self.0 & 0x8000 == 0 { sine } else { -sine }
    }
}

/// Adds, wrapping at a full turn.
impl Add for BinaryAngle {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }
}

/// The nearest binary angle. For an angle too large to count turns in f64, the result is arbitrary.
#[cfg(feature = "alloc")]
impl From<Angle> for BinaryAngle {
    fn from(angle: Angle) -> Self {
        let turns = angle.to_radians() / core::f64::consts::TAU;
        let part = turns - libm::floor(turns);
        // 0 to 65,536, where 65,536 is a full turn; the casts truncate, and wrap that to 0.
        Self((part * 65_536.0 + 0.5) as u32 as u16)
    }
}
