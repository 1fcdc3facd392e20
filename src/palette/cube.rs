//! The colour cube: every mixture of six reds, six greens and six blues, plus forty greys.
//!
//! Entry `36·r + 6·g + b` holds level r of red, g of green, b of blue; entries 216 to 255 are greys, from dark to
//! light, spread evenly over the DAC levels that the cube's own six greys leave free. The DAC shows every colour
//! exactly.

use super::{Palette, Rgb, dac6_to_8};

/// The six levels of a channel, in the DAC's 6 bits: `63·k/5` rounded to the nearest.
pub(crate) const LEVELS: [u8; 6] = [0, 13, 25, 38, 50, 63];

/// The index of the first grey.
const FIRST_GREY: usize = 216;

/// The cube with its greys. It has no ramps.
pub const CUBE: Palette = Palette::from_parts(colors(), 0);

/// The colours by reference, since a `const` palette would be copied wherever it is used.
const COLORS: &[Rgb; 256] = CUBE.colors();

/// The 6-bit levels of the forty greys, entry 216 onwards. 58 of the DAC's 64 levels are not levels of the cube; grey
/// `k`, 0 to 39, is number `57·k/39` of these, rounded down.
const GREYS: [u8; 40] = greys();

const fn greys() -> [u8; 40] {
    let mut free = [0; 58];
    let (mut v, mut count, mut next_level) = (0, 0, 0);
    while v < 64 {
        if next_level < 6 && LEVELS[next_level] == v {
            next_level += 1;
        } else {
            free[count] = v;
            count += 1;
        }
        v += 1;
    }
    let mut greys = [0; 40];
    let mut k = 0;
    while k < 40 {
        greys[k] = free[57 * k / 39];
        k += 1;
    }
    greys
}

const fn colors() -> [Rgb; 256] {
    let mut colors = [Rgb::BLACK; 256];
    let mut i = 0;
    while i < FIRST_GREY {
        colors[i] = Rgb::from_dac([LEVELS[i / 36], LEVELS[i / 6 % 6], LEVELS[i % 6]]);
        i += 1;
    }
    while i < 256 {
        colors[i] = Rgb::from_dac([GREYS[i - FIRST_GREY]; 3]);
        i += 1;
    }
    colors
}

/// The nearest of the six levels to each channel value; the lower if two are equally near.
const LEVEL_OF: [u8; 256] = nearest_table(&LEVELS);

/// The nearest of the forty greys to each value; the lower if two are equally near.
const GREY_OF: [u8; 256] = nearest_table(&GREYS);

const fn nearest_table<const N: usize>(rising: &[u8; N]) -> [u8; 256] {
    let mut table = [0; 256];
    let (mut value, mut k) = (0, 0);
    while value < 256 {
        // The nearest never decreases as the value rises.
        while k + 1 < N && dac6_to_8(rising[k + 1]).abs_diff(value as u8) < dac6_to_8(rising[k]).abs_diff(value as u8) {
            k += 1;
        }
        // N is at most 40.
        table[value] = k as u8;
        value += 1;
    }
    table
}

/// The nearest of the cube's 216 entries to a colour, by table lookup for each channel.
#[must_use]
#[inline]
pub const fn nearest_mixture(color: Rgb) -> u8 {
    // At most 36·5 + 6·5 + 5 = 215.
    36 * LEVEL_OF[color.r as usize] + 6 * LEVEL_OF[color.g as usize] + LEVEL_OF[color.b as usize]
}

/// The entry of [`CUBE`] nearest to a colour: the result of [`Palette::nearest`], without a search.
///
/// The squared distance to a grey v is 3·(v − m)² plus a term common to all greys, where m is the
/// mean of the three channels. So only the grey nearest to m need be considered, or, because m is a
/// multiple of a third, the two around it.
#[must_use]
#[inline]
pub const fn nearest(color: Rgb) -> u8 {
    let mixture = nearest_mixture(color);
    let mut best = mixture;
    let mut best_distance = COLORS[mixture as usize].distance_squared(color);
    let sum = color.r as usize + color.g as usize + color.b as usize;
    let mut value = sum / 3;
    while value <= sum.div_ceil(3) {
        let grey = FIRST_GREY as u8 + GREY_OF[value];
        let distance = COLORS[grey as usize].distance_squared(color);
        if distance < best_distance {
            (best, best_distance) = (grey, distance);
        }
        value += 1;
    }
    best
}
