//! Lists of spans as values, through which tests and other machines draw as batches do.

use super::depth::Cell;
use super::list::{DepthSteps, SpanList, Spans8};
use super::target::{SpanDepth, Target, Written};
use super::{Kernel, PIECE};
use crate::lanes::LANES;
use crate::simd::{Lanes8, Portable, compiled_for_each_level};

/// A span and its position.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ListedSpan {
    /// The offset of its first pixel.
    pub at: u32,
    /// The number of pixels.
    pub length: u32,
    /// The shade in 8.8, as `fill` takes it.
    pub shade: u16,
    /// The step in 8.8.
    pub step: u16,
}

/// The depths of a span, and their position in the depth buffer.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ListedDepths {
    /// The depth of the first pixel, with 24 fraction bits, as `fill_nearer` takes it.
    pub z: i64,
    /// The change per pixel.
    pub dz: i64,
    /// The offset of its first cell.
    pub at: u32,
}

/// Draws spans in order, as batches do with this kernel, if they lie inside the pixels.
pub fn fill(kernel: Kernel, pixels: &mut [u8], spans: &[ListedSpan]) {
    let (mut list, target) = (SpanList::NONE, &mut Target { pixels, cells: None, kernel });
    list.begin(target, [0; 2]);
    for eight in spans.chunks(LANES) {
        list.append(Portable, &lanes(eight), None);
        if !list.has_room(LANES) {
            list.draw_by::<false>(target);
        }
    }
    list.draw_by::<false>(target);
}

/// Draws spans in order where they are nearer, as batches do with this kernel, if they lie inside the pixels and cells.
/// If every span has the same offset for both, the list stores only one.
pub fn fill_where_nearer<D: Cell>(
    kernel: Kernel,
    pixels: &mut [u8],
    cells: &mut [D],
    spans: &[ListedSpan],
    depths: &[ListedDepths],
) -> u32 {
    // With one pitch, or with two, so that cells have offsets of their own.
    let is_shared = spans.iter().zip(depths).all(|(span, depths)| span.at == depths.at);
    let (mut list, target) = (SpanList::NONE, &mut Target { pixels, cells: Some(D::cells(cells)), kernel });
    list.begin(target, [0, u32::from(!is_shared)]);
    for (spans, depths) in spans.chunks(LANES).zip(depths.chunks(LANES)) {
        let mut eight = lanes(spans);
        let mut dz = [0; LANES];
        for (i, depths) in depths.iter().enumerate() {
            (eight.cell[i], eight.z[i], dz[i]) = (depths.at.cast_signed(), depths.z << 8, depths.dz << 8);
        }
        list.append(Portable, &eight, Some(DepthSteps::Each(dz)));
        if !list.has_room(LANES) {
            list.draw_by::<true>(target);
        }
    }
    list.draw_by::<true>(target);
    list.counts().2
}

/// Writes the first `length` bytes where they are nearer, and if `keeps` their depths to the cells, up to 64 pixels at
/// a time, as spans with effects are written. Pixels beyond the shortest of the three are left alone. Returns the
/// number of pixels written.
pub fn write_nearer<D: Cell>(
    kernel: Kernel,
    (row, cells): (&mut [u8], &mut [D]),
    (bytes, length): (&[u8], usize),
    keeps: bool,
    [z, dz]: [i64; 2],
) -> u32 {
    let length = length.min(row.len()).min(cells.len()).min(bytes.len());
    let target = &mut Target { pixels: row, cells: Some(D::cells(cells)), kernel };
    let span = |first: usize| {
        let cell = first as u32;
        let depth = SpanDepth { cell, z: z.wrapping_add(dz.wrapping_mul(first as i64)) << 8, dz: dz << 8 };
        let n = (length - first).min(PIECE);
        write(kernel.simd_level(), target, (Written { at: cell, bytes: &bytes[first..], length: n }, depth), keeps)
    };
    (0..length).step_by(PIECE).map(span).sum()
}

compiled_for_each_level! {
    fn write[][](target: &mut Target<'_>, span: (Written<'_>, SpanDepth), keeps: bool) -> u32 = write_by;
}

#[inline(always)]
fn write_by<S: Lanes8>(s: S, target: &mut Target<'_>, (span, depth): (Written<'_>, SpanDepth), keeps: bool) -> u32 {
    target.write(s, span, depth, keeps)
}

fn lanes(spans: &[ListedSpan]) -> Spans8<Portable> {
    let mut eight: Spans8<Portable> =
        Spans8 { at: [0; LANES], cell: [0; LANES], length: [0; LANES], fill: [0; LANES], z: [0; LANES] };
    for (i, span) in spans.iter().enumerate() {
        eight.at[i] = span.at.cast_signed();
        eight.length[i] = span.length.cast_signed();
        eight.fill[i] = (u32::from(span.shade) | u32::from(span.step) << 16).cast_signed();
    }
    eight
}
