//! Where the span loops write their pixels: to the stages' buffer, to the frame, or to the frame
//! where they are nearer.

use super::spans::Spans;
use crate::fixed::IS_COMPACT;
use crate::lanes::LANES;
use crate::simd::Lanes8;
use crate::span::depth_test::{Masks, test_block, test_span};
use crate::span::texture::{PlacesAlong, Texels, Tint, show_along, show_block, show_masked};

/// Destination of the pixels of spans.
pub(super) trait Destination {
    /// Where the pixels of span `i` begin, how many there are, and how many leading ones are left
    /// out.
    fn span(&self, spans: &Spans<'_>, i: usize) -> (usize, usize, u32);

    /// All pixels.
    fn all(&mut self) -> &mut [u8];

    /// Writes texels to the pixels of span `i` from `at` on, after this many of its drawn ones.
    #[inline(always)]
    fn show<S: Lanes8, T: Tint>(
        &mut self,
        s: S,
        _: (&Spans<'_>, usize, u32),
        (at, length): (usize, usize),
        (texels, tint, along): (Texels<'_>, T, &mut T::Along<S>),
        places: impl PlacesAlong<S>,
    ) {
        if let Some(row) = self.all().get_mut(at..) {
            show_along(s, (row, length), texels, (tint, along), places);
        }
    }
}

/// The buffer of all pixels, hidden ones included.
pub(super) struct InBuffer<'a>(pub(super) &'a mut [u8]);

impl Destination for InBuffer<'_> {
    #[inline(always)]
    fn span(&self, spans: &Spans<'_>, i: usize) -> (usize, usize, u32) {
        let (first, length) = spans.range(i);
        (first, length, 0)
    }

    #[inline(always)]
    fn all(&mut self) -> &mut [u8] {
        self.0
    }
}

/// The frame.
pub(super) struct InFrame<'a>(pub(super) &'a mut [u8]);

impl Destination for InFrame<'_> {
    #[inline(always)]
    fn span(&self, spans: &Spans<'_>, i: usize) -> (usize, usize, u32) {
        spans.in_frame(i)
    }

    #[inline(always)]
    fn all(&mut self) -> &mut [u8] {
        self.0
    }
}

/// The frame, written under masks: if there are cells, only where pixels are nearer.
pub(super) struct Masked<'a> {
    pub(super) pixels: &'a mut [u8],
    pub(super) cells: Option<&'a mut [u32]>,
    /// True if nearer depths are stored in the cells.
    pub(super) keeps: bool,
    /// Pixels that were nearer so far.
    pub(super) nearer: u32,
}

impl Destination for Masked<'_> {
    #[inline(always)]
    fn span(&self, spans: &Spans<'_>, i: usize) -> (usize, usize, u32) {
        spans.in_frame(i)
    }

    #[inline(always)]
    fn all(&mut self) -> &mut [u8] {
        self.pixels
    }

    #[inline(always)]
    fn show<S: Lanes8, T: Tint>(
        &mut self,
        s: S,
        (spans, i, before): (&Spans<'_>, usize, u32),
        (at, length): (usize, usize),
        (texels, tint, along): (Texels<'_>, T, &mut T::Along<S>),
        mut places: impl PlacesAlong<S>,
    ) {
        let Some(row) = self.pixels.get_mut(at..) else { return };
        let (mut cells, mut depths) = (None, [0; 2]);
        if let Some(all) = &mut self.cells {
            let (cell, [z, dz]) = spans.depth(i);
            let Some(of_span) = all.get_mut(cell + before as usize..) else { return };
            (cells, depths) = (Some(of_span), [z.wrapping_add(dz.wrapping_mul(before.into())), dz]);
        }
        // Most spans are a single block, whose mask needs no memory.
        if !IS_COMPACT
            && length <= LANES
            && let Some(block) = row.first_chunk_mut()
        {
            let mut tested = None;
            match &mut cells {
                Some(cells) => {
                    if let Some(eight) = cells.first_chunk_mut() {
                        tested = Some(test_block(s, eight, depths, length, self.keeps));
                    }
                }
                None => tested = Some(behind(length)),
            }
            if let Some(stays) = tested {
                if stays != u64::MAX {
                    self.nearer += stays.count_zeros() / 8;
                    show_block(s, (block, stays), texels, (tint, along), &mut places);
                }
                return;
            }
        }
        let mut masks = Masks::default();
        let Some(masks) = masks.get_mut(..length.div_ceil(LANES)) else { return };
        if let Some(cells) = cells {
            let nearer = test_span(s, (cells, length), depths, self.keeps, masks);
            self.nearer += nearer;
            if nearer == 0 {
                return;
            }
        } else if let Some(last) = masks.last_mut() {
            *last = behind((length - 1) % LANES + 1);
        }
        show_masked(s, (row, masks), texels, (tint, along), places);
    }
}

/// The mask of a block in which only the first pixels of this number are drawn, at most eight.
#[inline(always)]
fn behind(length: usize) -> u64 {
    if length < LANES { u64::MAX << (8 * length) } else { 0 }
}
