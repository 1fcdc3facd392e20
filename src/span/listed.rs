//! Lists of spans as values, through which tests and other machines draw as batches do.

use super::Kernel;
use super::depth::Cell;
use super::list::{DepthSteps, SpanList, Spans8, Target};
use crate::lanes::LANES;
use crate::simd::Portable;

/// A span and its position.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ListedSpan {
    /// The offset of its first pixel.
    pub at: u32,
    /// Pixels.
    pub length: u32,
    /// Shade in 8.8, as `fill` takes it.
    pub shade: u16,
    /// Step in 8.8.
    pub step: u16,
}

/// The depths of a span, and their position in the depth buffer.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ListedDepths {
    /// Depth of the first pixel, with 24 fraction bits, as `fill_nearer` takes it.
    pub z: i64,
    /// Change per pixel.
    pub dz: i64,
    /// The offset of its first cell.
    pub at: u32,
}

/// Draws spans in order, as batches do with this kernel, if they lie inside the pixels.
pub fn fill(kernel: Kernel, pixels: &mut [u8], spans: &[ListedSpan]) {
    let mut list = SpanList::new((pixels.len(), 0), (0, 0));
    let target = &mut Target { pixels, cells: None, kernel };
    for eight in spans.chunks(LANES) {
        list.append::<Portable, (), false>(Portable, &lanes(eight), DepthSteps::All(0));
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
    let mut list = SpanList::new((pixels.len(), 0), (cells.len(), u32::from(!is_shared)));
    let target = &mut Target { pixels, cells: Some(D::cells(cells)), kernel };
    for (spans, depths) in spans.chunks(LANES).zip(depths.chunks(LANES)) {
        let mut eight = lanes(spans);
        let mut dz = [0; LANES];
        for (i, depths) in depths.iter().enumerate() {
            (eight.cell[i], eight.z[i], dz[i]) = (depths.at.cast_signed(), depths.z << 8, depths.dz << 8);
        }
        list.append::<Portable, (), true>(Portable, &eight, DepthSteps::Each(dz));
        if !list.has_room(LANES) {
            list.draw_by::<true>(target);
        }
    }
    list.draw_by::<true>(target);
    list.counts().2
}

fn lanes(spans: &[ListedSpan]) -> Spans8<Portable, ()> {
    let mut eight: Spans8<Portable, ()> =
        Spans8 { at: [0; LANES], cell: [0; LANES], length: [0; LANES], paint: [0; LANES], z: [0; LANES], columns: () };
    for (i, span) in spans.iter().enumerate() {
        eight.at[i] = span.at.cast_signed();
        eight.length[i] = span.length.cast_signed();
        eight.paint[i] = (u32::from(span.shade) | u32::from(span.step) << 16).cast_signed();
    }
    eight
}
