//! The span of perspective-correct shades: a quotient for every pixel (S3's hyperbolic interpolation).
//!
//! ```text
//! for every k:  row[k] = floor((n + k·dn) / (d + k·dd))
//! ```
//!
//! in exact arithmetic. Every divisor is positive and every quotient 0 to 255: the raster sees to it.

use crate::fixed::HAS_F64;

/// Fills `row` with the quotients of two numbers that change linearly along it.
///
/// `n` and `d` are those of the first pixel, `dn` and `dd` the changes from one to the next; each
/// |value| along the row is below 2¹²⁶, `d` positive.
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

/// The floor of n / d for a quotient below 2³² and a positive d.
#[inline]
pub(crate) fn floor_quotient(n: i128, d: i128) -> i64 {
    if !HAS_F64 {
        return n.div_euclid(d) as i64;
    }
    // Three roundings of one part in 2⁵³ each: off by less than one, so the exact remainder says
    // whether the floor is the next one up or down. A 128-bit division takes four times as long.
    let near = (n as f64 / d as f64) as i64;
    let rest = n - i128::from(near) * d;
    near + i64::from(rest >= d) - i64::from(rest < 0)
}
