//! Mixes three rows of shades, red, green and blue, into one row of palette indices, with ordered dither.
//!
//! Each loop writes as many pixels as the shortest of its rows has. `thresholds` and `x` are as in
//! [`dither`](super::dither): 0 to 255 by the pixel's position in the frame.

use super::dither::ThresholdRow;
#[cfg(feature = "alloc")]
use crate::lanes::{Lanes, each};
use crate::palette::{cube, dac6_to_8};
#[cfg(feature = "alloc")]
use crate::simd::Lanes8;

/// The six levels of a channel in the colour cube: 0, 52, 101, 154, 203, 255.
const LEVELS: [u8; 6] = {
    let [a, b, c, d, e, f] = cube::LEVELS;
    [dac6_to_8(a), dac6_to_8(b), dac6_to_8(c), dac6_to_8(d), dac6_to_8(e), dac6_to_8(f)]
};

/// The position of a channel value among the levels.
#[derive(Clone, Copy)]
struct Between {
    /// The index of the highest level that is not above the value.
    level: u8,
    /// The threshold below which the value takes the next level; 0 if it is a level itself.
    next_below: u8,
}

/// The position of every channel value among the levels.
static BETWEEN: [Between; 256] = {
    let mut table = [Between { level: 0, next_below: 0 }; 256];
    let (mut value, mut level) = (0, 0);
    while value < 256 {
        // The last level is the last value, so there is always a next.
        if value == LEVELS[level + 1] as usize {
            level += 1;
        }
        if level < 5 {
            let (a, b) = (LEVELS[level] as usize, LEVELS[level + 1] as usize);
            // 256·(c − a) > t·(b − a) if and only if t is below this quotient: at most ⌈256·52/53⌉ = 252.
            table[value].next_below = (256 * (value - a)).div_ceil(b - a) as u8;
        }
        // At most 5.
        table[value].level = level as u8;
        value += 1;
    }
    table
};

/// Mixes three channels into the colour cube ([`palette::cube`](crate::palette::cube)), entry
/// 36·r + 6·g + b, with the fastest loop of this build.
///
/// A channel value c lies between two neighbouring levels of the cube, a ≤ c < b. At threshold t
///
/// ```text
/// it becomes b   if 256·(c − a) > t·(b − a)
///            a   else
/// ```
///
/// so a value that is a level does not change at any threshold. With a threshold of 128 throughout, each value goes to
/// the nearest level, and to the lower of two equally near ones, which is
/// [`nearest_mixture`](crate::palette::cube::nearest_mixture); with 127 it is the same, but to the higher of two
/// equally near ones (26 and 229 are the only such values).
#[inline(never)]
pub fn mix_cube(row: &mut [u8], red: &[u8], green: &[u8], blue: &[u8], thresholds: &ThresholdRow, x: usize) {
    #[cfg(feature = "simd")]
    blocks::mix_cube(row, red, green, blue, thresholds, x);
    #[cfg(not(feature = "simd"))]
    mix_cube_portable(row, red, green, blue, thresholds, x);
}

/// The specification of [`mix_cube`].
pub fn mix_cube_portable(row: &mut [u8], red: &[u8], green: &[u8], blue: &[u8], thresholds: &ThresholdRow, x: usize) {
    let n = row.len().min(red.len()).min(green.len()).min(blue.len());
    let (row, red, green, blue) = (&mut row[..n], &red[..n], &green[..n], &blue[..n]);
    for (k, pixel) in row.iter_mut().enumerate() {
        let threshold = thresholds.at(x.wrapping_add(k));
        let level = |value: u8| {
            let between = BETWEEN[usize::from(value)];
            between.level + u8::from(threshold < between.next_below)
        };
        // At most 36·5 + 6·5 + 5 = 215.
        *pixel = 36 * level(red[k]) + 6 * level(green[k]) + level(blue[k]);
    }
}

/// Plain arrays that the compiler vectorises.
#[cfg(feature = "simd")]
mod blocks {
    use super::{LEVELS, ThresholdRow, mix_cube_portable};

    /// Pixels per iteration.
    const BLOCK: usize = 16;

    /// The mixture without a table: a value's level is the number of switches that it exceeds.
    ///
    /// ```text
    /// switch i:   a + (t·(b − a) >> 8)        a and b being levels i and i + 1
    /// level(c) =  number of i with c > switch i
    /// ```
    ///
    /// 256·(c − a) > t·(b − a) is equivalent to c > switch, because c is an integer. Switch i lies at or above a and
    /// below b, so a value exceeds the switches of the levels below its own, and none of those above.
    pub(super) fn mix_cube(row: &mut [u8], red: &[u8], green: &[u8], blue: &[u8], thresholds: &ThresholdRow, x: usize) {
        let n = row.len().min(red.len()).min(green.len()).min(blue.len());
        let (blocks, rest) = row[..n].as_chunks_mut::<BLOCK>();
        let (red, rest_red) = red[..n].as_chunks::<BLOCK>();
        let (green, rest_green) = green[..n].as_chunks::<BLOCK>();
        let (blue, rest_blue) = blue[..n].as_chunks::<BLOCK>();
        let mut column = x;
        for (((block, red), green), blue) in blocks.iter_mut().zip(red).zip(green).zip(blue) {
            *block = mixed(&thresholds.next(column), red, green, blue);
            column = column.wrapping_add(BLOCK);
        }
        mix_cube_portable(rest, rest_red, rest_green, rest_blue, thresholds, column);
    }

    #[inline]
    fn mixed(t: &[u8; BLOCK], red: &[u8; BLOCK], green: &[u8; BLOCK], blue: &[u8; BLOCK]) -> [u8; BLOCK] {
        let mut block = [0; BLOCK];
        for levels in LEVELS.windows(2) {
            let (a, b) = (levels[0], levels[1]);
            // The shifted product is below b − a.
            let switch = t.map(|t| a + ((u16::from(t) * u16::from(b - a)) >> 8) as u8);
            for (k, pixel) in block.iter_mut().enumerate() {
                let passed = |channel: &[u8; BLOCK], by: u8| if channel[k] > switch[k] { by } else { 0 };
                *pixel += passed(red, 36) + passed(green, 6) + passed(blue, 1);
            }
        }
        block
    }
}

/// Mixes three channels into any palette, by a table of the nearest entries.
///
/// ```text
/// c'     = clamp(c + (t·spread >> 8) − ⌊spread / 2⌋, 0, 255)        for each channel c at threshold t
/// row[k] = map[(r' >> 3) << 10 | (g' >> 3) << 5 | b' >> 3]
/// ```
///
/// `map` holds an entry for every colour of 5 bits per channel, with red in the highest bits. `spread` is how far the
/// thresholds move a value, from the lowest to the highest: about the distance between neighbouring colours of the
/// palette. 0 means no dither.
#[cfg(any(test, feature = "internals"))]
#[expect(clippy::too_many_arguments, reason = "three rows in, one out, and what the pixels share")]
pub fn mix_nearest(
    row: &mut [u8],
    red: &[u8],
    green: &[u8],
    blue: &[u8],
    thresholds: &ThresholdRow,
    x: usize,
    spread: u8,
    map: &[u8; 32_768],
) {
    let n = row.len().min(red.len()).min(green.len()).min(blue.len());
    let (row, red, green, blue) = (&mut row[..n], &red[..n], &green[..n], &blue[..n]);
    for (k, pixel) in row.iter_mut().enumerate() {
        let threshold = i32::from(thresholds.at(x.wrapping_add(k)));
        let offset = ((threshold * i32::from(spread)) >> 8) - i32::from(spread / 2);
        // 0 to 31.
        let five_bits = |value: u8| ((i32::from(value) + offset).clamp(0, 255) >> 3) as usize;
        *pixel = map[five_bits(red[k]) << 10 | five_bits(green[k]) << 5 | five_bits(blue[k])];
    }
}

/// Mixes three channels into any palette at eight pixels, with the results of `mix_nearest`.
#[cfg(feature = "alloc")]
#[inline(always)]
pub(crate) fn mix_nearest_eight<S: Lanes8>(
    s: S,
    channels: [&Lanes<u8>; 3],
    thresholds: &Lanes<u8>,
    spread: u8,
    map: &[u8; 32_768],
) -> Lanes<u8> {
    let widened = |bytes: &Lanes<u8>| s.load_i32(&each!(k => i32::from(bytes[k])));
    let spread = i32::from(spread);
    let offset = s.shr_i32(s.mul_i32(widened(thresholds), s.splat_i32(spread)), 8);
    let offset = s.sub_i32(offset, s.splat_i32(spread / 2));
    // 0 to 31, times 8.
    let five_bits = |channel: &Lanes<u8>| {
        let value = s.add_i32(widened(channel), offset);
        s.and_i32(s.max_i32(s.min_i32(value, s.splat_i32(255)), s.splat_i32(0)), s.splat_i32(0xF8))
    };
    let [red, green, blue] = [five_bits(channels[0]), five_bits(channels[1]), five_bits(channels[2])];
    let index = s.or_i32(s.or_i32(s.shl_i32(red, 7), s.shl_i32(green, 2)), s.shr_i32(blue, 3));
    s.join_bytes(s.bytes_at(map, index))
}
