//! Angles and their sines, from a table.
//!
//! A binary angle counts 65,536ths of a turn in 16 bits, so that a full turn wraps to 0 by itself
//! and no angle ever has to be reduced. A quarter wave of 16,385 sines would be 64 KiB; two short
//! tables give the same by the addition theorem,
//!
//! ```text
//! sin(a + b) = sin a · cos b + cos a · sin b       a: a 512th of a turn, b: less than that
//! ```
//!
//! in 1.5 KiB. Their entries are sums of Taylor's series in integers, made when the crate is
//! compiled: [`BinaryAngle::sin`] is the multiple of 1/65,536 nearest to the true sine, for every angle.

use core::ops::Add;

#[cfg(feature = "alloc")]
use crate::angle::Angle;
use crate::fixed::I16F16;

/// Bits behind the point of the table's sines.
pub(super) const SINE_BITS: u32 = 30;

/// ⌊π · 2⁶⁰⌋.
const PI_Q60: i128 = 3_622_009_729_038_561_421;

/// The number of coarse steps in a quarter turn.
const COARSE: usize = 128;
/// The number of fine steps, of one binary angle each, in a coarse one.
const FINE: usize = 128;

/// sin x with 30 bits behind the point, to the nearest, by Taylor's series; x with 60 bits, 0 to π/2.
const fn sine_q30(x: i128) -> i32 {
    let (mut sum, mut term, mut k) = (x, x, 1);
    // Each term loses less than 2 in its last bit: some forty units of 2⁻⁶⁰ in all.
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

/// The sine and the cosine of the fine steps.
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

/// An angle in 65,536ths of a turn.
impl From<u16> for BinaryAngle {
    #[inline]
    fn from(steps: u16) -> Self {
        Self(steps)
    }
}

/// The angle in 65,536ths of a turn.
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

    /// The angle nearest to so many whole degrees, any number of turns in either direction.
    #[must_use]
    pub const fn from_degrees(degrees: i32) -> Self {
        // At most 359 · 65,536 + 180. The result is 0 to 65,536, and a full turn wraps to 0.
        Self(((degrees.rem_euclid(360) * 65_536 + 180) / 360) as u16)
    }

    /// The sine: the nearest multiple of 1/65,536.
    #[must_use]
    pub fn sin(self) -> I16F16 {
        let sine = self.wide_sine();
        let magnitude = (sine.abs() + (1 << 43)) >> 44;
        // At most 65,536 either way.
        I16F16::from_bits((magnitude * sine.signum()) as i32)
    }

    /// The cosine: the nearest multiple of 1/65,536.
    #[must_use]
    pub fn cos(self) -> I16F16 {
        (self + Self::QUARTER).sin()
    }

    /// Sine and cosine with 30 bits behind the point: within 2 units of 2⁻³⁰, and within ±2³⁰.
    pub(super) fn sin_cos(self) -> (i64, i64) {
        let narrow = |sine: i64| {
            let magnitude = (sine.abs() + (1 << 29)) >> 30;
            // The two tables' rounding may add up to a hair more than 1.
            magnitude.min(1 << SINE_BITS) * sine.signum()
        };
        (narrow(self.wide_sine()), narrow((self + Self::QUARTER).wide_sine()))
    }

    /// The sine with 60 bits behind the point, about 30 of them right.
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

/// The sum, which wraps at a full turn.
impl Add for BinaryAngle {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }
}

/// The nearest binary angle. An angle so large that its f64 no longer counts turns gives some angle.
#[cfg(feature = "alloc")]
impl From<Angle> for BinaryAngle {
    fn from(angle: Angle) -> Self {
        let turns = angle.to_radians() / core::f64::consts::TAU;
        let part = turns - libm::floor(turns);
        // 0 to 65,536, of which the last is a full turn; the casts truncate, and wrap that to 0.
        Self((part * 65_536.0 + 0.5) as u32 as u16)
    }
}
