//! A list of short spans, drawn by one call: those of small triangles.
//!
//! ```text
//! for every span of the list:  fill(pixels[at .. at + length], shade, step)
//! ```
//!
//! or, with a list of depths beside it, `fill_nearer`.

use super::depth::{Cell, fill_nearer};

/// A span and where it lies.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct Listed {
    /// The offset of its first pixel.
    pub at: u32,
    /// Pixels.
    pub length: u32,
    /// Shade in 8.8, as `fill` takes it.
    pub shade: u16,
    /// Step in 8.8.
    pub step: u16,
}

/// The depths of a span, and where they lie in the depth buffer.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct Depths {
    /// Depth of the first pixel, with 24 fraction bits, as `fill_nearer` takes it.
    pub z: i64,
    /// Change from one pixel to the next.
    pub dz: i64,
    /// The offset of its first cell.
    pub at: u32,
}

/// Fills every span of a list where it is nearer. Returns the number of pixels written.
#[inline(never)]
pub(super) fn each_nearer<D: Cell>(pixels: &mut [u8], cells: &mut [D], spans: &[Listed], depths: &[Depths]) -> u32 {
    let mut written = 0;
    for (span, depth) in spans.iter().zip(depths) {
        let (at, cell, length) = (span.at as usize, depth.at as usize, span.length as usize);
        let row = pixels.get_mut(at..at.saturating_add(length));
        if let (Some(row), Some(cells)) = (row, cells.get_mut(cell..cell.saturating_add(length))) {
            written += fill_nearer(row, cells, span.shade, span.step, depth.z, depth.dz);
        }
    }
    written
}

/// Fills every span of a list.
#[inline(always)]
pub(super) fn each(pixels: &mut [u8], spans: &[Listed], fill: impl Fn(&mut [u8], u16, u16)) {
    for span in spans {
        // No overflow: both are below 2³² and a length is at most 4,096 where usize has no more bits.
        let at = span.at as usize;
        if let Some(row) = pixels.get_mut(at..at.saturating_add(span.length as usize)) {
            fill(row, span.shade, span.step);
        }
    }
}
