//! The exponent of a highlight.

use crate::lanes::LANES;
use crate::simd::F32Lanes8;

/// The largest integer shininess whose power is computed by multiplication.
const MAX_EXPONENT: f64 = 1_024.0;

/// The shininess of a highlight: an exponent, at least 0.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Shininess {
    /// An integer up to 1,024, as nearly all exponents are. The power is a chain of products, from the lowest bit of
    /// the exponent up:
    ///
    /// ```text
    /// result = 1;  for every bit:  if it is set, result = result·square;  square = square·square
    /// ```
    ///
    /// Each product is rounded once. No factor has more than s − 1 roundings, so the power is accurate to s parts in
    /// 2⁵³. It takes a fifth of the time of `pow`, and less for several at once.
    Whole(u32),
    /// Any other exponent: `pow` of the `libm` crate.
    Other(f64),
}

impl Shininess {
    /// The shininess with this exponent. Negative numbers and NaN count as 0.
    pub(crate) fn new(exponent: f64) -> Self {
        let exponent = exponent.max(0.0);
        // 0 to 1,024.
        let whole = exponent.min(MAX_EXPONENT) as u32;
        if f64::from(whole) == exponent { Self::Whole(whole) } else { Self::Other(exponent) }
    }

    /// base ^ exponent for a base above 0, otherwise 0.
    #[inline(never)]
    pub(crate) fn of(self, base: f64) -> f64 {
        if base <= 0.0 || base.is_nan() {
            return 0.0;
        }
        let mut bits = match self {
            Self::Whole(exponent) => exponent,
            Self::Other(exponent) => return libm::pow(base, exponent),
        };
        let (mut result, mut square) = (1.0, base);
        loop {
            if bits & 1 == 1 {
                result *= square;
            }
            bits >>= 1;
            if bits == 0 {
                return result;
            }
            square *= square;
        }
    }

    /// base ^ exponent for each base above 0, otherwise 0, bit for bit equal to [`of`](Self::of).
    #[inline(always)]
    pub(crate) fn of_lanes<L: F32Lanes8>(self, lanes: L, bases: L::F64) -> L::F64 {
        let zero = lanes.splat_f64(0.0);
        let mut bits = match self {
            Self::Whole(exponent) => exponent,
            Self::Other(exponent) => {
                let (mut powers, mut i) = ([0.0; LANES], 0);
                lanes.store_f64(bases, &mut powers);
                while i < LANES {
                    powers[i] = if powers[i] > 0.0 { libm::pow(powers[i], exponent) } else { 0.0 };
                    i += 1;
                }
                return lanes.load_f64(&powers);
            }
        };
        let (mut result, mut square) = (lanes.splat_f64(1.0), bases);
        loop {
            if bits & 1 == 1 {
                result = lanes.mul(result, square);
            }
            bits >>= 1;
            if bits == 0 {
                return lanes.if_less(zero, bases, result);
            }
            square = lanes.mul(square, square);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::Portable;

    /// Powers by products are within s parts in 2⁵³ of `pow`, which is within one; all lanes are equal.
    #[test]
    fn powers_are_powers() {
        for exponent in (0..=64).chain([99, 100, 255, 256, 511, 1_000, 1_023, 1_024]).map(f64::from) {
            for step in 1..=400 {
                let base = f64::from(step) / 400.0;
                let (power, by_pow) = (Shininess::new(exponent).of(base), libm::pow(base, exponent));
                let allowed = by_pow * (exponent + 2.0) * f64::EPSILON + f64::MIN_POSITIVE;
                assert!((power - by_pow).abs() <= allowed, "{base} ^ {exponent}: {power}, not {by_pow}");
            }
        }
        assert_eq!(Shininess::new(0.5).of(0.25), 0.5);
        assert_eq!(Shininess::new(1_025.0), Shininess::Other(1_025.0));
        assert_eq!(Shininess::new(-3.0), Shininess::Whole(0));
        assert_eq!(Shininess::new(f64::NAN), Shininess::Whole(0));
    }

    #[test]
    fn lanes_are_each_for_itself() {
        let bases = [0.9, 0.0, -1.0, f64::NAN, 1.0, 0.001, 1.5, -0.0];
        for exponent in [0.0, 1.0, 2.0, 7.0, 30.0, 2.5, 5_000.0] {
            let shininess = Shininess::new(exponent);
            assert_eq!(shininess.of_lanes(Portable, bases), bases.map(|base| shininess.of(base)), "{exponent}");
        }
    }
}
