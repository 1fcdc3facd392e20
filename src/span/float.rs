//! The span of perspective-correct shades in f32: a division for every pixel.
//!
//! ```text
//! for every pixel i:  k      = first + i
//!                     row[i] = nearest(clamp((n + k·dn) / (d + k·dd)))
//! ```
//!
//! k is exact in f32; the rest is two products, two sums and a quotient, each rounded once and in this order, so the
//! result is the same on every processor. NaN counts as the least of the range.
//!
//! The loop is floating-point by nature, so a processor without it pays for calling this (and only then: it is compiled
//! where it is called).

use crate::lanes::{LANES, blocks};

/// The shade at k, clamped to `range`: what [`fill_float`] rounds.
#[inline]
pub(crate) fn quotient(k: i32, [n, dn]: [f32; 2], [d, dd]: [f32; 2], [low, high]: [f32; 2]) -> f32 {
    // Below 2²⁴: exact.
    let k = k as f32;
    let shade = (n + k * dn) / (d + k * dd);
    // Written so that NaN fails it.
    let shade = if shade > low { shade } else { low };
    if shade < high { shade } else { high }
}

/// Fills `row` with the shades nearest to the quotients of two numbers that change linearly along it, clamped to
/// `range`.
///
/// `n` and `d` are the values at k = 0, each with its change per pixel; the row's first pixel is k = `first`, and all
/// are within ±2²⁴. `range` is the least and the greatest shade, 0 to 255, multiples of 1/256.
///
/// A sum of 256.5 to 511.5 has 15 fraction bits, so its integer part lies in bits 15 to 22 of the float: three times as
/// fast at 64 pixels as a cast, which checks for numbers out of range (28 ns against 90).
///
/// ```
/// use mode13h::internals::span::float::fill_float;
///
/// let mut row = [0; 3];
/// fill_float(&mut row, 0, [60.0, 0.0], [3.0, -1.0], [0.0, 255.0]); // 60/3, 60/2, 60/1
/// assert_eq!(row, [20, 30, 60]);
/// ```
#[inline]
pub fn fill_float(row: &mut [u8], first: i32, n: [f32; 2], d: [f32; 2], range: [f32; 2]) {
    for (i, pixel) in row.iter_mut().enumerate() {
        // No row is 2²⁴ pixels long, by the contract.
        let shade = quotient(first.wrapping_add(i as i32), n, d, range);
        // Bits 15 to 22.
        *pixel = ((shade + 256.5).to_bits() >> 15) as u8;
    }
}

/// Fills as [`fill_float`] does, but in whole blocks of eight, for which `row` has room: bytes after the first `length`
/// are arbitrary.
#[inline(always)]
pub(crate) fn fill_float_blocks(
    (row, length): (&mut [u8], usize),
    first: i32,
    n: [f32; 2],
    d: [f32; 2],
    range: [f32; 2],
) {
    let mut first = first;
    for block in blocks(row, length) {
        fill_float(block, first, n, d, range);
        first += LANES as i32;
    }
}

/// Fills `shades` with the shades in 8.8, truncated, that [`fill_float`] rounds.
pub(crate) fn float_shades(shades: &mut [u16], first: i32, n: [f32; 2], d: [f32; 2], range: [f32; 2]) {
    for (shade, k) in shades.iter_mut().zip(first..) {
        *shade = (quotient(k, n, d, range) * 256.0) as u16;
    }
}
