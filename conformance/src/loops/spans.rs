//! Rows of shades: in 8.8, 16.16 and f32, as quotients, and with dither.

use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;
use alloc::{format, string::ToString};

use mode13h::internals::span::dither::ThresholdRow;

use super::canvas::{Canvas, EDGES, Shape, any_column, any_thresholds, any_u16, on_every_shape, threshold};
use super::{Cases, Checked};
use crate::Random;

/// The definition of a span: `row[k] = ((shade + k·step) mod 65,536) >> 8`.
#[must_use]
pub fn naive_span(length: usize, shade: u16, step: u16) -> Vec<u8> {
    let pixel = |k: u64| ((u64::from(shade) + k * u64::from(step)) % 65_536 / 256) as u8;
    (0..length as u64).map(pixel).collect()
}

/// Checks one span on a canvas.
///
/// # Errors
/// A line naming the span and its first wrong byte.
pub fn check_span(
    canvas: &mut Canvas,
    shape: Shape,
    (shade, step): (u16, u16),
    fill: impl FnOnce(&mut [u8], u16, u16),
) -> Result<(), String> {
    let Shape { length, alignment } = shape;
    let after = naive_span(length, shade, step);
    canvas
        .check(alignment, &vec![0x77; length], &after, |row| fill(row, shade, step))
        .map_err(|wrong| format!("shade {shade:#06x} step {step:#06x} length {length} alignment {alignment}: {wrong}"))
}

/// Checks spans in 8.8: every shape; extreme and random shades at the length of two of the widest blocks plus every
/// tail; and rows of around 65,536 and 131,072 pixels.
///
/// # Errors
/// The first wrong span.
pub fn check_fill(cases: Cases, mut fill: impl FnMut(&mut [u8], u16, u16)) -> Checked {
    const WIDEST: usize = 191;
    let mut random = cases.random("spans");
    let extremes = EDGES.into_iter().flat_map(|shade| EDGES.into_iter().map(move |step| (shade, step)));
    let (mut canvas, mut count) = (Canvas::new(131_073), 0);
    for (alignment, shades) in (0..).zip(extremes) {
        for length in [0, 1, 2, WIDEST] {
            check_span(&mut canvas, Shape { length, alignment: alignment % 64 }, shades, &mut fill)?;
            count += 1;
        }
    }
    for alignment in 0..cases.of(1_000, 20_000) {
        let bits = random.next_u64();
        // Two of its four 16-bit words.
        let shades = (bits as u16, (bits >> 16) as u16);
        check_span(&mut canvas, Shape { length: WIDEST, alignment: alignment % 64 }, shades, &mut fill)?;
        count += 1;
    }
    for length in [65_535, 65_536, 65_537, 131_073] {
        for alignment in 0..cases.of(4, 64) {
            let shades = (any_u16(&mut random), any_u16(&mut random));
            check_span(&mut canvas, Shape { length, alignment: alignment * 13 % 64 }, shades, &mut fill)?;
            count += 1;
        }
    }
    let shapes = on_every_shape(cases, "fill", |random, canvas, shape| {
        check_span(canvas, shape, (any_u16(random), any_u16(random)), &mut fill)
    })?;
    Ok(count + shapes)
}

/// Checks spans in 16.16.
///
/// # Errors
/// The first wrong span.
pub fn check_16_16(cases: Cases, mut fill: impl FnMut(&mut [u8], u32, u32)) -> Checked {
    let any_u32 = |random: &mut Random| u32::from(any_u16(random)) << 16 | u32::from(any_u16(random));
    on_every_shape(cases, "wide", |random, canvas, shape| {
        let (shade, step) = (any_u32(random), any_u32(random));
        let pixel = |k: usize| ((i128::from(shade) + k as i128 * i128::from(step)) / 65_536 % 256) as u8;
        let after: Vec<u8> = (0..shape.length).map(pixel).collect();
        canvas
            .check(shape.alignment, &vec![0x77; shape.length], &after, |row| fill(row, shade, step))
            .map_err(|wrong| format!("shade {shade:#010x} step {step:#010x}: {wrong}"))
    })
}

/// Quotients: numerator and divisor at the first pixel, and the increment of each per pixel.
#[derive(Debug)]
struct Quotients {
    n: i128,
    dn: i128,
    d: i128,
    dd: i128,
}

impl Quotients {
    /// A number below 2^`bits`, which is at most 116.
    fn wide(random: &mut Random, bits: u32) -> i128 {
        let number = u128::from(random.next_u64()) << 64 | u128::from(random.next_u64());
        (number >> (128 - bits)) as i128
    }

    /// Quotients next to whole numbers, from which f64 cannot distinguish them.
    fn beside_whole(random: &mut Random, bits: u32) -> Self {
        let (d, dd) = (Self::wide(random, bits).max(1), Self::wide(random, bits) >> 14);
        let quotient = i128::from(random.within(0, 255));
        let beside = random.one_of(&[-1, 0, 1, d / 2, d - 1]).clamp(-quotient * d, d - 1);
        Self { n: quotient * d + beside, dn: quotient * dd, d, dd }
    }

    /// A row from any quotient to any other, with a rising or falling divisor.
    fn anywhere(random: &mut Random, bits: u32, length: usize) -> Self {
        let gaps = length.max(2) as i128 - 1;
        // The rounded steps lose less than one per pixel: less than the divisor in total, so less than a quotient.
        let [d, last_d] = [0; 2].map(|_| Self::wide(random, bits) + gaps + 1);
        let dd = (last_d - d) / gaps;
        let last_d = d + gaps * dd;
        let [n, last_n] = [d, last_d].map(|d| i128::from(random.within(1, 254)) * d);
        Self { n, dn: (last_n - n) / gaps, d, dd }
    }
}

/// Checks quotients in exact arithmetic.
///
/// # Errors
/// The first wrong row.
pub fn check_quotients(cases: Cases, mut fill: impl FnMut(&mut [u8], i128, i128, i128, i128)) -> Checked {
    on_every_shape(cases, "quotients", |random, canvas, shape| {
        let bits = random.within(1, 110) as u32;
        let row = match random.below(3) {
            0 => Quotients::anywhere(random, bits, shape.length),
            _ => Quotients::beside_whole(random, bits),
        };
        let Quotients { n, dn, d, dd } = row;
        let pixel = |k: i128| (n + k * dn).div_euclid(d + k * dd);
        let quotients = (0..shape.length as i128).map(pixel).map(u8::try_from);
        let after = quotients.collect::<Result<Vec<u8>, _>>().map_err(|error| error.to_string())?;
        canvas
            .check(shape.alignment, &vec![0x77; shape.length], &after, |pixels| fill(pixels, n, dn, d, dd))
            .map_err(|wrong| format!("{row:?}: {wrong}"))
    })
}

/// A row for `fill_float`: its first pixel; dividend and divisor at pixel 0, each with its step; and the range.
type FloatRow = (i32, [f32; 2], [f32; 2], [f32; 2]);

/// Values that occur in triangles (starting at any pixel, with quotients of about 0 to 255 at both ends), and values
/// that never do.
fn any_float_row(random: &mut Random, length: usize) -> FloatRow {
    let first = random.within(-4_096, 4_096) as i32;
    let gaps = (length.max(2) - 1) as f32;
    let mut divisor = || libm::exp2(random.unit() * 60.0) as f32;
    let (d0, d1) = (divisor(), divisor());
    let mut shade = || (random.within(-20, 65_300) as f32 / 256.0).max(0.0);
    let (s0, s1, a, b) = (shade(), shade(), shade(), shade());
    let step = |from: f32, to: f32| (to - from) / gaps;
    let (dn, dd) = (step(s0 * d0, s1 * d1), step(d0, d1));
    let at_zero = |value: f32, step: f32| value - first as f32 * step;
    let range = match random.below(2) {
        0 => [0.0, 255.0],
        _ => [libm::floorf(a.min(b)), libm::ceilf(a.max(b).min(255.0))],
    };
    match random.below(31) {
        0 => (first, [f32::NAN, 1.0], [1.0, 0.0], range),
        1 => (first, [f32::INFINITY, dn], [1.0, f32::INFINITY], range),
        2 => (first, [0.0, 0.0], [0.0, 0.0], range),
        _ => (first, [at_zero(s0 * d0, dn), dn], [at_zero(d0, dd), dd], range),
    }
}

fn naive_float(length: usize, (first, n, d, [low, high]): FloatRow) -> Vec<u8> {
    let pixel = |i: usize| {
        let k = (i64::from(first) + i as i64) as f32;
        let (above, below) = (n[0] + k * n[1], d[0] + k * d[1]);
        let shade = above / below;
        let shade = if shade.is_nan() { low } else { shade.clamp(low, high) };
        // Rounded to 15 bits after the point, ties to even, then truncated.
        (libm::floor(f64::from(shade + 256.5)) - 256.0) as u8
    };
    (0..length).map(pixel).collect()
}

/// Checks quotients in f32.
///
/// # Errors
/// The first wrong row.
pub fn check_float(cases: Cases, mut fill: impl FnMut(&mut [u8], i32, [f32; 2], [f32; 2], [f32; 2])) -> Checked {
    on_every_shape(cases, "float", |random, canvas, shape| {
        let row = any_float_row(random, shape.length);
        let (first, n, d, range) = row;
        let after = naive_float(shape.length, row);
        canvas
            .check(shape.alignment, &vec![0x77; shape.length], &after, |row| fill(row, first, n, d, range))
            .map_err(|wrong| format!("from {first}: {n:?} / {d:?} in {range:?}: {wrong}"))
    })
}

/// Checks spans with dither.
///
/// # Errors
/// The first wrong span.
pub fn check_dithered(cases: Cases, mut fill: impl FnMut(&mut [u8], u16, u16, &ThresholdRow, usize)) -> Checked {
    on_every_shape(cases, "dithered", |random, canvas, shape| {
        let (shade, step) = (any_u16(random), any_u16(random));
        let (thresholds, x) = (any_thresholds(random), any_column(random));
        let pixel = |k: usize| {
            let sum = i64::from(shade) + k as i64 * i64::from(step) + i64::from(threshold(&thresholds, x, k));
            (sum % 65_536 / 256) as u8
        };
        let after: Vec<u8> = (0..shape.length).map(pixel).collect();
        let draw = |row: &mut [u8]| fill(row, shade, step, &thresholds, x);
        canvas
            .check(shape.alignment, &vec![0x77; shape.length], &after, draw)
            .map_err(|wrong| format!("shade {shade:#06x} step {step:#06x} {thresholds:?} x {x}: {wrong}"))
    })
}
