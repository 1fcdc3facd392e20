//! The span of perspective-correct shades: a quotient for every pixel (Hill's hyperbolic interpolation).
//!
//! ```text
//! for every k:  row[k] = floor((n + k·dn) / (d + k·dd))
//! ```
//!
//! in exact arithmetic. Every divisor is positive and every quotient 0 to 255, as the raster ensures.

use crate::fixed::{HAS_F64, ROUND_MAGIC, floor_of_wide, nearest_whole};
use crate::lanes::{LANES, NUMBERS, blocks};
use crate::simd::Lanes8;

/// Fills `row` with the quotients of two numbers that change linearly along it.
///
/// `n` and `d` are the values at the first pixel, `dn` and `dd` their changes per pixel; each |value| along the row is
/// below 2¹²⁶, `d` positive.
#[inline]
pub fn fill_quotients(row: &mut [u8], n: i128, dn: i128, d: i128, dd: i128) {
    let (mut n, mut d) = (n, d);
    for pixel in row {
        // At most 255, by the contract.
        *pixel = floor_quotient(n, d) as u8;
        n += dn;
        d += dd;
    }
}

/// Fills `row` with quotients in f64, in whole blocks of eight, for which it has room: bytes after the first `length` are
/// arbitrary. Returns false if an estimate cannot decide a byte, including an arbitrary one; nearly always all decide.
///
/// (n + k·dn) / (d + k·dd) is 65,536 times the byte's quotient, 0 to 2²⁴, computed with an error of less than ½: a
/// product and a sum each in numerator and denominator, and a quotient. Rounded to an integer it is less than 1 off, so
/// its upper 8 bits are the byte unless the lower 16 are 0.
#[inline(always)]
pub(crate) fn fill_estimated_blocks<S: Lanes8>(
    s: S,
    (row, length): (&mut [u8], usize),
    [n, dn]: [f64; 2],
    [d, dd]: [f64; 2],
) -> bool {
    let (n, dn, d, dd) = (s.splat_f64(n), s.splat_f64(dn), s.splat_f64(d), s.splat_f64(dd));
    let mut k = s.to_f64(s.load_i32(&NUMBERS));
    let mut undecided = 0;
    for block in blocks(row, length) {
        let quotient = s.div(s.mul_add(k, dn, n), s.mul_add(k, dd, d));
        let estimate = s.low_bits(s.add(quotient, s.splat_f64(ROUND_MAGIC)));
        *block = s.low_bytes(s.shr_i32(estimate, 16));
        undecided |= s.to_bitmask(s.is_equal(s.and_i32(estimate, s.splat_i32(0xFFFF)), s.splat_i32(0)));
        k = s.add(k, s.splat_f64(LANES as f64));
    }
    undecided == 0
}

/// Fills `shades` with truncated shades in 8.8, as [`fill_estimated_blocks`] does bytes: 256 times a shade is estimated.
/// Returns false where an estimate cannot decide.
#[cfg(feature = "alloc")]
pub(crate) fn estimated_shades(shades: &mut [u16], [n, dn]: [f64; 2], [d, dd]: [f64; 2]) -> bool {
    let mut is_sure = true;
    for (i, shade) in shades.iter_mut().enumerate() {
        let k = i as f64;
        let estimate = nearest_whole((n + k * dn) / (d + k * dd));
        is_sure &= estimate & 0xFF != 0;
        *shade = (estimate >> 8) as u16;
    }
    is_sure
}

/// The floor of n / d for a quotient within ±2⁴⁸ and a positive d; n within ±2¹²⁶.
#[inline]
pub(crate) fn floor_quotient(n: i128, d: i128) -> i64 {
    if !HAS_F64 {
        return floor_of_wide(n, d);
    }
    // Three roundings of one part in 2⁵³ each, and one to an integer: within 0.6 of n / d, so it is the floor or the
    // next integer, and the exact remainder says which. A cast would not do, since it rounds toward zero: −2 − δ may
    // have an estimate a hair above −2, which becomes −1, two above the floor. Whether a 128-bit division takes longer
    // depends on the processor: on one of 2023 it takes 5 to 8 ns where this takes 9.
    let near = nearest_whole(n as f64 / d as f64);
    let rest = n - i128::from(near) * d;
    near - i64::from(rest < 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests whole quotients of either sign, and their neighbours one part of the divisor away.
    #[test]
    fn floors_are_exact() {
        for bits in 0..78 {
            for part in [1, 3, 5, 7, 11, 1_000_003] {
                let d = ((1 << bits) / part + 1) * part + bits;
                for q in (0..=48).flat_map(|bits| [(1_i128 << bits) - 1, 1 << bits, (1 << bits) / 7 * 5]) {
                    for n in [q * d - 1, q * d, q * d + 1, q * d + d / 2, q * d + d - 1] {
                        for n in [n, -n] {
                            assert_eq!(i128::from(floor_quotient(n, d)), n.div_euclid(d), "{n} / {d}");
                        }
                    }
                }
            }
        }
    }
}
