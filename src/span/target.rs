//! The pixels and cells that spans are written to.

use core::ops::Range;

use super::Kernel;
use super::depth::{Cells, copy_nearer, copy_nearer_keep_depth};
use super::depth_test::copy_span;
use crate::fixed::IS_COMPACT;
use crate::lanes::LANES;
use crate::simd::Lanes8;

/// The destination of spans.
pub(crate) struct Target<'a> {
    pub(crate) pixels: &'a mut [u8],
    /// The cells of the depth buffer, if there is one.
    pub(crate) cells: Option<Cells<'a>>,
    pub(crate) kernel: Kernel,
}

/// The bytes of a span, and its offset. Bytes after the first `length` are not its own.
pub(crate) struct Written<'a> {
    pub(crate) at: u32,
    pub(crate) bytes: &'a [u8],
    /// At most 64.
    pub(crate) length: usize,
}

/// The depth of a span, with the integer part in the upper half, modulo 2⁶⁴.
#[derive(Clone, Copy)]
pub(crate) struct SpanDepth {
    /// The offset of its first cell.
    pub(crate) cell: u32,
    pub(crate) z: i64,
    pub(crate) dz: i64,
}

impl Target<'_> {
    /// Writes the bytes of these spans in order: if there are cells, only where they are nearer, and with `keeps`
    /// storing their depths in the cells. Returns the number of nearer pixels.
    #[inline(always)]
    pub(crate) fn write_each<'b, S: Lanes8>(
        &mut self,
        s: S,
        spans: Range<usize>,
        (of, depth_of): (impl Fn(usize) -> Written<'b>, impl Fn(usize) -> SpanDepth),
        keeps: bool,
    ) -> u32 {
        let (pixels, mut nearer) = (&mut *self.pixels, 0);
        match &mut self.cells {
            None => {
                for k in spans {
                    let Written { at, bytes, length } = of(k);
                    self.kernel.copy(length, pixels.get_mut(at as usize..).unwrap_or_default(), bytes);
                }
            }
            Some(Cells::U32(cells)) => {
                for k in spans {
                    let Written { at, bytes, length } = of(k);
                    let (at, cell) = (at as usize, depth_of(k).cell as usize);
                    // Most spans.
                    if !IS_COMPACT
                        && length <= LANES
                        && let Some(new) = bytes.first_chunk()
                        && let Some(block) = chunk_at(pixels, at)
                        && let Some(eight) = chunk_at(cells, cell)
                    {
                        // Read after the checks, so that each is broadcast from memory.
                        let SpanDepth { z, dz, .. } = depth_of(k);
                        nearer += s.copy_nearer((block, eight), (*new, length), [z, dz], keeps);
                    } else if let Some(row) = pixels.get_mut(at..)
                        && let Some(cells) = cells.get_mut(cell..)
                    {
                        let SpanDepth { z, dz, .. } = depth_of(k);
                        nearer += copy_span(s, (row, cells), (bytes, length), keeps, [z, dz]);
                    }
                }
            }
            Some(Cells::U16(cells)) => {
                for k in spans {
                    let (Written { at, bytes, length }, SpanDepth { cell, z, dz }) = (of(k), depth_of(k));
                    let bytes = &bytes[..length.min(bytes.len())];
                    if let (Some(row), Some(cells)) = (pixels.get_mut(at as usize..), cells.get_mut(cell as usize..)) {
                        nearer += match keeps {
                            true => copy_nearer(row, cells, bytes, z >> 8, dz >> 8),
                            false => copy_nearer_keep_depth(row, cells, bytes, z >> 8, dz >> 8),
                        };
                    }
                }
            }
        }
        nearer
    }

    /// [`write_each`](Self::write_each) for one span.
    #[inline(always)]
    pub(crate) fn write<S: Lanes8>(
        &mut self,
        s: S,
        Written { at, bytes, length }: Written<'_>,
        depth: SpanDepth,
        keeps: bool,
    ) -> u32 {
        let of = (
            #[inline(always)]
            |_| Written { at, bytes, length },
            #[inline(always)]
            |_| depth,
        );
        self.write_each(s, 0..1, of, keeps)
    }
}

/// Eight elements from an index on, if there are that many.
#[inline(always)]
pub(crate) fn chunk_at<T>(of: &mut [T], at: usize) -> Option<&mut [T; LANES]> {
    // No overflow: offsets are below 2³¹.
    of.get_mut(at..at + LANES)?.first_chunk_mut()
}
