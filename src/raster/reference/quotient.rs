//! Exact quotients from one reciprocal.
//!
//! Drawing a triangle divides several numbers by the same divisor: its doubled area, the height of
//! an edge. Integer division is slow (20 to 90 cycles for 64 bits on the processors of the last
//! decade), so where the processor has f64 the divisor is inverted once and every quotient is a
//! product, made exact by its remainder:
//!
//! ```text
//! q = nearest(n · (1/d))        in f64: three roundings, each at most one part in 2⁵³
//! r = n − q·d                   in i64: exact
//! if r < 0 { q −= 1; r += d }   now 0 ≤ r < d: q is the floor
//! ```
//!
//! One correction is enough while |n/d| < 2⁴⁶: the product's error is then below 2⁴⁶ · 3 · 2⁻⁵³ < 0.03, so |q − n/d| <
//! 0.53 and −0.53·d < r < 0.53·d. The result is the integer floor, so it is the same on every processor; where there is
//! no f64 unit, integer division is used, and this module links no soft-float routine.

use crate::fixed::{HAS_F64, IS_SMALL, nearest_whole};

/// A divisor, 1 to 2⁴⁴, with its reciprocal.
#[derive(Clone, Copy, Debug)]
pub struct Divisor {
    divisor: i64,
    /// 1/divisor, or 0 where the target has no f64 unit.
    reciprocal: f64,
}

impl Divisor {
    /// The largest quotient, either way, that one correction is proved for.
    pub const MAX_QUOTIENT: i64 = 1 << 46;

    /// A divisor of 1 to 2⁴⁴; anything less counts as 1.
    #[must_use]
    #[inline]
    pub fn new(divisor: i64) -> Self {
        debug_assert!((1..=1 << 44).contains(&divisor), "divisor {divisor}");
        let divisor = divisor.max(1);
        Self { divisor, reciprocal: if HAS_F64 { 1.0 / divisor as f64 } else { 0.0 } }
    }

    /// The divisor.
    #[must_use]
    #[inline]
    pub fn get(&self) -> i64 {
        self.divisor
    }

    /// `(q, r)` with `n = q·divisor + r` and `0 ≤ r < divisor`: the floor and its remainder.
    /// |n| is below 2⁶² and the quotient within ±[`MAX_QUOTIENT`](Self::MAX_QUOTIENT).
    #[must_use]
    #[inline]
    pub fn div_rem_floor(&self, n: i64) -> (i64, i64) {
        debug_assert!((n / self.divisor).abs() <= Self::MAX_QUOTIENT, "{n} / {}", self.divisor);
        if !HAS_F64 {
            return if IS_SMALL {
                in_integers(n, self.divisor)
            } else {
                (n.div_euclid(self.divisor), n.rem_euclid(self.divisor))
            };
        }
        let nearest = nearest_whole(n as f64 * self.reciprocal);
        let rest = n.wrapping_sub(nearest.wrapping_mul(self.divisor));
        let below = rest >> 63; // −1 where the nearest was above, else 0
        (nearest + below, rest + (below & self.divisor))
    }

    /// The quotient rounded toward minus infinity.
    #[must_use]
    #[inline]
    pub fn floor(&self, n: i64) -> i64 {
        self.div_rem_floor(n).0
    }

    /// The quotient rounded toward zero.
    #[must_use]
    #[inline]
    pub fn truncate(&self, n: i64) -> i64 {
        let sign = n >> 63;
        // The floor of the magnitude, with the sign put back.
        (self.floor((n ^ sign) - sign) ^ sign) - sign
    }
}

/// Quotient and remainder by one division.
#[inline(never)]
fn in_integers(n: i64, divisor: i64) -> (i64, i64) {
    let toward_zero = n / divisor;
    let rest = n - toward_zero * divisor;
    let below = rest >> 63; // −1 or 0
    (toward_zero + below, rest + (below & divisor))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn check(n: i64, d: i64) {
        let divisor = Divisor::new(d);
        assert_eq!(divisor.div_rem_floor(n), (n.div_euclid(d), n.rem_euclid(d)), "{n} / {d}");
        assert_eq!(divisor.truncate(n), n / d, "{n} / {d}");
        assert_eq!(in_integers(n, d), divisor.div_rem_floor(n), "{n} / {d}");
    }

    #[test]
    fn at_the_multiples_and_beside_them() {
        for bits_d in 0..=42 {
            for d in [(1_i64 << bits_d) - 1, 1 << bits_d, (1 << bits_d) + 1, (1 << bits_d) / 3 * 2 + 1] {
                let d = d.clamp(1, 1 << 42);
                for bits_q in 0..=45 {
                    for q in [(1_i64 << bits_q) - 1, 1 << bits_q, (1 << bits_q) + 1, (1 << bits_q) / 7 * 5] {
                        let Some(n) = q.checked_mul(d).filter(|n| *n < 1 << 61) else { continue };
                        for n in [n - 1, n, n + 1, n + d / 2, n + d - 1] {
                            check(n, d);
                            check(-n, d);
                        }
                    }
                }
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        #[test]
        fn anywhere(d_bits in 0..42_u32, d in any::<i64>(), n_bits in 0..61_u32, n in any::<i64>()) {
            let d = (d & ((2_i64 << d_bits) - 1)).max(1);
            // Not with `prop_assume`: proptest tolerates rejecting no more than a twentieth of the 20,000 cases.
            let n = n % (2_i64 << n_bits).min(d.saturating_mul(Divisor::MAX_QUOTIENT));
            check(n, d);
        }
    }
}
