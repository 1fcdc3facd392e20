//! Rows with a depth test, and lists of spans.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::Debug;

use mode13h::internals::span::depth::Cell;
use mode13h::internals::span::listed::{ListedDepths, ListedSpan};

use super::canvas::{any_u16, bytes, on_every_shape, other_row};
use super::spans::naive_span;
use super::{Cases, Checked};
use crate::Random;

/// A cell of a depth buffer, by definition.
pub trait NaiveCell: Cell + Debug {
    /// The cell for a depth.
    fn naive(depth: u32) -> Self;
    /// A random value.
    fn any(random: &mut Random) -> Self;
}

impl NaiveCell for u32 {
    fn naive(depth: u32) -> Self {
        depth
    }
    fn any(random: &mut Random) -> Self {
        random.next_u64() as u32 >> random.below(9)
    }
}

impl NaiveCell for u16 {
    fn naive(depth: u32) -> Self {
        u16::try_from(u64::from(depth).div_ceil(1 << 14)).unwrap_or(u16::MAX)
    }
    fn any(random: &mut Random) -> Self {
        random.next_u64() as u16
    }
}

/// The depth of a pixel by definition, modulo 2³².
fn depth_at(z: i64, dz: i64, k: usize) -> u32 {
    ((i128::from(z) + k as i128 * i128::from(dz)) >> 24) as u32
}

/// Depths along a row, and the cells' contents before drawing: one cell in eight already holds the depth to be drawn.
fn any_depths<D: NaiveCell>(random: &mut Random, cells: usize) -> (i64, i64, Vec<D>) {
    let z = random.within(0, 1 << 56);
    let dz = random.within(-(1 << 50), 1 << 50) >> random.below(51);
    let held = |k| if random.below(8) == 0 { D::naive(depth_at(z, dz, k)) } else { D::any(random) };
    (z, dz, (0..cells).map(held).collect())
}

/// Draws `shown` into `pixels` where it is nearer. With `keeps` those depths are also stored in the cells. Returns the
/// number of pixels written.
fn naive_nearer<D: NaiveCell>(
    pixels: &mut [u8],
    cells: &mut [D],
    shown: &[u8],
    (z, dz): (i64, i64),
    keeps: bool,
) -> u32 {
    let mut written = 0;
    for (k, ((pixel, cell), byte)) in pixels.iter_mut().zip(cells).zip(shown).enumerate() {
        let depth = D::naive(depth_at(z, dz, k));
        if depth > *cell {
            *pixel = *byte;
            written += 1;
            if keeps {
                *cell = depth;
            }
        }
    }
    written
}

/// Says which of the counts or cells differ.
fn compare<D: NaiveCell>((is, cells): (u32, &[D]), (should, nearest): (u32, &[D])) -> Result<(), String> {
    if is != should {
        return Err(format!("{is} written, not {should}"));
    }
    match cells.iter().zip(nearest).position(|(is, should)| is != should) {
        Some(k) => Err(format!("cell {k} holds {:?}, not {:?}", cells[k], nearest[k])),
        None => Ok(()),
    }
}

/// Checks spans with a depth test.
///
/// # Errors
/// The first wrong span.
pub fn check_fill<D: NaiveCell>(
    cases: Cases,
    mut fill: impl FnMut(&mut [u8], &mut [D], u16, u16, i64, i64) -> u32,
) -> Checked {
    on_every_shape(cases, "nearer", |random, canvas, shape| {
        let before = bytes(random, shape.length);
        let cells = other_row(random, shape.length).len();
        let (shade, step) = (any_u16(random), any_u16(random));
        let (z, dz, mut cells) = any_depths::<D>(random, cells);
        let (mut after, mut nearest) = (before.clone(), cells.clone());
        let shown = naive_span(shape.length, shade, step);
        let written = naive_nearer(&mut after, &mut nearest, &shown, (z, dz), true);
        let mut is_written = 0;
        canvas
            .check(shape.alignment, &before, &after, |row| {
                is_written = fill(row, &mut cells, shade, step, z, dz);
            })
            .and_then(|()| compare((is_written, &cells), (written, &nearest)))
            .map_err(|wrong| {
                format!("shade {shade:#06x} step {step:#06x} z {z:#x} dz {dz:#x}, {} cells: {wrong}", cells.len())
            })
    })
}

/// Checks copies of a given length with a depth test. `keeps` says whether nearer depths are stored in the cells. Row,
/// cells and bytes may be longer, as a vector loop's last iteration requires, and what follows must not change.
///
/// # Errors
/// The first wrong copy.
pub fn check_copy<D: NaiveCell>(
    cases: Cases,
    keeps: bool,
    mut copy: impl FnMut(usize, &mut [u8], &mut [D], &[u8], i64, i64) -> u32,
) -> Checked {
    on_every_shape(cases, "copy", |random, canvas, shape| {
        let behind = random.below(9);
        let length = shape.length.saturating_sub(random.one_of(&[0, behind]));
        let before = bytes(random, shape.length);
        let drawn = other_row(random, shape.length);
        let cells = other_row(random, shape.length).len();
        let (z, dz, mut cells) = any_depths::<D>(random, cells);
        let (mut after, mut nearest) = (before.clone(), cells.clone());
        let shown = &drawn[..length.min(drawn.len())];
        let written = naive_nearer(&mut after, &mut nearest, shown, (z, dz), keeps);
        let mut is_written = 0;
        canvas
            .check(shape.alignment, &before, &after, |row| {
                is_written = copy(length, row, &mut cells, &drawn, z, dz);
            })
            .and_then(|()| compare((is_written, &cells), (written, &nearest)))
            .map_err(|wrong| {
                format!("{length}, z {z:#x} dz {dz:#x}, {} cells, {} bytes: {wrong}", cells.len(), drawn.len())
            })
    })
}

/// Rows of pixels and cells, each with a pitch of its own.
struct Frame {
    width: i64,
    height: i64,
    /// Distance in pixels, or cells, from one row to the next.
    pitch: i64,
    cells_pitch: i64,
}

impl Frame {
    fn any(random: &mut Random) -> Self {
        let (width, height) = (random.one_of(&[4, 9, 17, 90]), random.within(1, 8));
        let [pitch, cells_pitch] = [0; 2].map(|_| {
            let wider = random.within(0, 70);
            width + random.one_of(&[0, 1, wider])
        });
        // In half of the frames a pixel and its cell have the same offset.
        let cells_pitch = random.one_of(&[pitch, cells_pitch]);
        Self { width, height, pitch, cells_pitch }
    }

    /// Length up to and including the last pixel of the last row.
    fn length(&self, pitch: i64) -> usize {
        ((self.height - 1) * pitch + self.width) as usize
    }

    /// A span in one row, or one that extends to the very end of the frame or a few pixels beyond. Returned with the
    /// offset of its first cell: that of the first pixel if both pitches are equal, otherwise occasionally beyond the
    /// end.
    fn span(&self, random: &mut Random) -> (ListedSpan, u32) {
        let length = random.within(0, self.width);
        let (x, y) = match random.below(8) {
            0 => (self.width - length, self.height - 1),
            1 => (self.width - length + random.within(0, 3), self.height - 1),
            _ => (random.within(0, self.width - length), random.within(0, self.height - 1)),
        };
        let at = |pitch: i64| (y * pitch + x) as u32;
        let (shade, step) = (any_u16(random), any_u16(random));
        let beyond = if self.cells_pitch != self.pitch && random.below(16) == 0 {
            self.length(self.cells_pitch) as u32
        } else {
            0
        };
        (ListedSpan { at: at(self.pitch), length: length as u32, shade, step }, at(self.cells_pitch) + beyond)
    }
}

/// Calls `one` with a frame, its pixels and up to twelve spans (rarely more), each with the offset of its first cell.
fn on_every_list(
    cases: Cases,
    mut one: impl FnMut(&mut Random, &Frame, Vec<u8>, &[ListedSpan], &[u32]) -> Result<(), String>,
) -> Checked {
    let mut random = cases.random("lists of spans");
    let count = cases.of(2_000, 20_000);
    for list in 0..count {
        let frame = Frame::any(&mut random);
        // Rarely more than a list has room for.
        let spans = random.one_of(&[12, 12, 12, 12, 12, 12, 12, 150]);
        let (spans, cells): (Vec<ListedSpan>, Vec<u32>) =
            (0..random.within(0, spans)).map(|_| frame.span(&mut random)).unzip();
        let pixels = bytes(&mut random, frame.length(frame.pitch));
        one(&mut random, &frame, pixels, &spans, &cells).map_err(|wrong| format!("list {list}: {spans:?}: {wrong}"))?;
    }
    Ok(count as u64)
}

/// Reports the first byte at which two rows differ.
fn same_pixels(is: &[u8], should: &[u8]) -> Result<(), String> {
    match is.iter().zip(should).position(|(is, should)| is != should) {
        Some(k) => Err(format!("pixel {k} is {:#04x}, not {:#04x}", is[k], should[k])),
        None => Ok(()),
    }
}

/// A span's range within `all` pixels; `None` if it extends beyond them.
fn place(at: u32, length: u32, all: usize) -> Option<core::ops::Range<usize>> {
    let (at, length) = (at as usize, length as usize);
    (at + length <= all).then(|| at..at + length)
}

/// Checks lists of spans in frames of any pitch: spans that extend beyond the pixels draw nothing, and what lies
/// before, between and after the others must not change.
///
/// # Errors
/// The first wrong list.
pub fn check_list(cases: Cases, mut fill: impl FnMut(&mut [u8], &[ListedSpan])) -> Checked {
    on_every_list(cases, |_, _, mut pixels, spans, _| {
        let mut after = pixels.clone();
        for span in spans {
            if let Some(place) = place(span.at, span.length, after.len()) {
                after[place].copy_from_slice(&naive_span(span.length as usize, span.shade, span.step));
            }
        }
        fill(&mut pixels, spans);
        same_pixels(&pixels, &after)
    })
}

/// Checks lists of spans with a depth test, where cells have a pitch of their own.
///
/// # Errors
/// The first wrong list.
pub fn check_list_nearer<D: NaiveCell>(
    cases: Cases,
    mut fill: impl FnMut(&mut [u8], &mut [D], &[ListedSpan], &[ListedDepths]) -> u32,
) -> Checked {
    on_every_list(cases, |random, frame, mut pixels, spans, offsets| {
        // Includes equal depths, where the one drawn first stays.
        let level = random.one_of(&[1_i64 << 30, 5, 1 << 32]);
        let any_depths = |&at: &u32| {
            let slope = random.next_u64() as i64 >> random.below(64);
            let z = random.within(0, level - 1) << 24;
            match random.below(4) {
                0 => ListedDepths { at, z: random.next_u64() as i64, dz: slope },
                1 => ListedDepths { at, z, dz: 0 },
                _ => ListedDepths { at, z, dz: slope >> 30 },
            }
        };
        let depths: Vec<ListedDepths> = offsets.iter().map(any_depths).collect();
        // Occasionally a few are missing.
        let missing = random.within(0, 2 * frame.width) as usize;
        let cells = frame.length(frame.cells_pitch).saturating_sub(random.one_of(&[0, 0, 0, missing]));
        let some = [0, 3, 1 << 29, u32::MAX].map(D::naive);
        let mut cells: Vec<D> = (0..cells).map(|_| random.one_of(&some)).collect();
        let (mut after, mut nearest, mut written) = (pixels.clone(), cells.clone(), 0);
        for (span, depth) in spans.iter().zip(&depths) {
            let places = (place(span.at, span.length, after.len()), place(depth.at, span.length, nearest.len()));
            if let (Some(at), Some(cell)) = places {
                let shown = naive_span(span.length as usize, span.shade, span.step);
                let along = (depth.z, depth.dz);
                written += naive_nearer(&mut after[at], &mut nearest[cell], &shown, along, true);
            }
        }
        let is_written = fill(&mut pixels, &mut cells, spans, &depths);
        same_pixels(&pixels, &after)
            .and_then(|()| compare((is_written, &cells), (written, &nearest)))
            .map_err(|wrong| format!("{depths:?}: {wrong}"))
    })
}
