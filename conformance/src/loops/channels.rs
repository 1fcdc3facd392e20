//! Mixing red, green and blue into a palette index.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use mode13h::internals::span::dither::ThresholdRow;

use super::canvas::{Canvas, Shape, any_column, any_thresholds, bytes, on_every_shape, other_row, threshold};
use super::{Cases, Checked};
use crate::Random;

/// The levels of a channel in the colour cube.
const LEVELS: [i64; 6] = [0, 52, 101, 154, 203, 255];

/// The cube's rule for one channel: the level that a value gets at a threshold.
#[must_use]
pub fn naive_level(value: u8, threshold: u8) -> u8 {
    let (c, t) = (i64::from(value), i64::from(threshold));
    // Number of levels at or below it, minus one: at most 5.
    let below = LEVELS.iter().filter(|level| **level <= c).count() - 1;
    let next = LEVELS.get(below + 1).is_some_and(|b| 256 * (c - LEVELS[below]) > t * (b - LEVELS[below]));
    below as u8 + u8::from(next)
}

/// Draws three rows, and compares them with what `naive` makes of each colour and threshold.
fn check_rows(
    random: &mut Random,
    canvas: &mut Canvas,
    shape: Shape,
    naive: impl Fn([u8; 3], u8) -> u8,
    draw: impl FnOnce(&mut [u8], [&[u8]; 3], &ThresholdRow, usize),
) -> Result<(), String> {
    let channels: [_; 3] = core::array::from_fn(|_| other_row(random, shape.length));
    let (thresholds, x) = (any_thresholds(random), any_column(random));
    let before = bytes(random, shape.length);
    let pixel = |(k, before): (usize, &u8)| {
        let [Some(r), Some(g), Some(b)] = channels.each_ref().map(|channel| channel.get(k)) else { return *before };
        naive([*r, *g, *b], threshold(&thresholds, x, k))
    };
    let after: Vec<u8> = before.iter().enumerate().map(pixel).collect();
    let rows = channels.each_ref().map(Vec::as_slice);
    canvas
        .check(shape.alignment, &before, &after, |row| draw(row, rows, &thresholds, x))
        .map_err(|wrong| format!("{:?} values, {thresholds:?} x {x}: {wrong}", rows.map(<[u8]>::len)))
}

/// Checks mixing with the colour cube.
///
/// # Errors
/// The first wrong row.
pub fn check_cube(cases: Cases, mut mix: impl FnMut(&mut [u8], &[u8], &[u8], &[u8], &ThresholdRow, usize)) -> Checked {
    on_every_shape(cases, "cube", |random, canvas, shape| {
        let naive = |color: [u8; 3], threshold| {
            let [r, g, b] = color.map(|value| naive_level(value, threshold));
            36 * r + 6 * g + b
        };
        check_rows(random, canvas, shape, naive, |row, [r, g, b], thresholds, x| mix(row, r, g, b, thresholds, x))
    })
}

/// Checks mixing with a map of nearest entries.
///
/// # Errors
/// The first wrong row.
pub fn check_nearest(
    cases: Cases,
    mut mix: impl FnMut(&mut [u8], &[u8], &[u8], &[u8], &ThresholdRow, usize, u8, &[u8; 32_768]),
) -> Checked {
    let map = bytes(&mut cases.random("map"), 32_768);
    let Some(map) = map.first_chunk() else { return Err("no map".into()) };
    on_every_shape(cases, "nearest", |random, canvas, shape| {
        let spread = random.one_of(&[0, 1, 2, 3, 8, 31, 32, 51, 64, 127, 128, 200, 254, 255]);
        let naive = |color: [u8; 3], threshold: u8| {
            let [r, g, b] = color.map(|value| {
                let moved = i64::from(value) + i64::from(threshold) * i64::from(spread) / 256 - i64::from(spread) / 2;
                moved.clamp(0, 255) / 8
            });
            map[(1_024 * r + 32 * g + b) as usize]
        };
        let draw = |row: &mut [u8], [r, g, b]: [&[u8]; 3], thresholds: &ThresholdRow, x| {
            mix(row, r, g, b, thresholds, x, spread, map);
        };
        check_rows(random, canvas, shape, naive, draw).map_err(|wrong| format!("spread {spread}: {wrong}"))
    })
}
