//! Where the span loops write their pixels: to the stages' buffer, to the frame, or to the frame only where they are
//! nearer.

use super::spans::Spans;
use crate::fixed::IS_COMPACT;
use crate::lanes::LANES;
use crate::simd::Lanes8;
use crate::span::depth_test::{Masks, test_blocks};
use crate::span::target::{SpanDepth, chunk_at};
use crate::span::texture::{FOUR, OffsetsAlong, Texels, Tint, show_along, show_block, show_masked};

/// Destination of the pixels of spans.
pub(super) trait Destination {
    /// True if two short spans are shown at once. With a depth buffer that is slower than showing them one by one,
    /// since some of them are hidden.
    const SHOWS_PAIRS: bool = true;

    /// Where the pixels of span `i` begin, how many there are, and how many leading pixels are skipped.
    #[inline(always)]
    fn span(&self, spans: &Spans<'_>, i: usize) -> (usize, usize, u32) {
        spans.in_frame(i)
    }

    /// All pixels.
    fn all(&mut self) -> &mut [u8];

    /// The drawn pixels of span `i`, whose depths are tested when they are shown.
    #[inline(always)]
    fn untested(&self, spans: &Spans<'_>, i: usize) -> DrawnPixels {
        let (at, length, skipped) = self.span(spans, i);
        DrawnPixels { at, length, skipped, is_tested: false, stays: u64::MAX }
    }

    /// The drawn pixels of span `i`, or `None` if all of them turn out to be hidden.
    #[inline(always)]
    fn begin<S: Lanes8>(&mut self, _: S, spans: &Spans<'_>, i: usize) -> Option<DrawnPixels> {
        Some(DrawnPixels { is_tested: true, ..self.untested(spans, i) })
    }

    /// Writes texels to these pixels of span `i`, after its first `before` drawn pixels.
    #[inline(always)]
    fn show<S: Lanes8, T: Tint>(
        &mut self,
        s: S,
        (_spans, _i, _before): (&Spans<'_>, usize, u32),
        DrawnPixels { at, length, .. }: DrawnPixels,
        (texels, tint, along): (Texels<'_>, T, &mut T::Along<S>),
        offsets: impl OffsetsAlong<S>,
    ) {
        if let Some(row) = self.all().get_mut(at..) {
            show_along(s, (row, length), texels, (tint, along), offsets);
        }
    }
}

/// Pixels of a span that are drawn.
#[derive(Clone, Copy)]
pub(super) struct DrawnPixels {
    /// Where they begin.
    at: usize,
    pub(super) length: usize,
    /// How many leading pixels of the span are skipped.
    pub(super) skipped: u32,
    /// False if a single block is yet to be tested when it is shown, as several blocks always are.
    is_tested: bool,
    /// The mask of the pixels that stay as they are, if a single block has been tested; otherwise all bits.
    stays: u64,
}

impl DrawnPixels {
    /// The next `length` pixels after the first `before`.
    #[inline(always)]
    pub(super) fn part(self, before: usize, length: usize) -> Self {
        let mut part = Self { at: self.at + before, length, ..self };
        if self.stays != u64::MAX {
            // In a single block both numbers are at most eight.
            part.stays = (self.stays >> (8 * (before % LANES))) | behind(length);
            // All of the part is hidden.
            if part.stays == u64::MAX {
                part.length = 0;
            }
        }
        part
    }
}

/// Two spans of at most four pixels each, shown together.
pub(super) struct Pair {
    /// Where the pixels of each begin.
    pub(super) at: [usize; 2],
    /// How many pixels of each there are.
    lengths: [usize; 2],
}

impl Pair {
    /// Spans `i` and `i + 1`, if they are short, nothing of them is skipped, and `T` can show both at once.
    #[inline(always)]
    pub(super) fn of<T: Tint, D: Destination>(to: &mut D, spans: &Spans<'_>, i: usize) -> Option<Self> {
        let (a, length_a, skipped_a) = to.span(spans, i);
        // Blended spans are no faster in pairs.
        let has_pairs = D::SHOWS_PAIRS && !T::READS_PIXELS && !IS_COMPACT;
        if !has_pairs || length_a > FOUR || i + 1 >= spans.count() {
            return None;
        }
        let (b, length_b, skipped_b) = to.span(spans, i + 1);
        if length_b > FOUR || skipped_a | skipped_b != 0 || a.max(b) + FOUR > to.all().len() {
            return None;
        }
        Some(Self { at: [a, b], lengths: [length_a, length_b] })
    }

    /// The mask of the pixels that stay as they are, four for each span.
    #[inline(always)]
    pub(super) fn stays(&self) -> u64 {
        let [low, high] = self.lengths;
        behind(low) & u64::from(u32::MAX) | behind(high) << 32
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
    fn all(&mut self) -> &mut [u8] {
        self.0
    }
}

/// The frame, written under masks: if there are cells, only where pixels are nearer than their depths.
pub(super) struct Masked<'a> {
    pub(super) pixels: &'a mut [u8],
    pub(super) cells: Option<&'a mut [u32]>,
    /// True if nearer depths are stored in the cells.
    pub(super) keeps: bool,
    /// The number of pixels that were nearer so far.
    pub(super) nearer: u32,
}

impl Masked<'_> {
    /// Tests the depths of `pixels`, all the drawn ones of span `i`, if they are a single block, as most are. Returns
    /// `None` if all are hidden.
    #[inline(always)]
    fn test<S: Lanes8>(&mut self, s: S, spans: &Spans<'_>, i: usize, mut pixels: DrawnPixels) -> Option<DrawnPixels> {
        let DrawnPixels { at, length, .. } = pixels;
        pixels.is_tested = true;
        // A part of a block may begin at its last pixel, and has eight pixels, too.
        if IS_COMPACT || length > LANES || at + 2 * LANES > self.pixels.len() {
            return Some(pixels);
        }
        let Some(cells) = &mut self.cells else {
            pixels.stays = behind(length);
            return Some(pixels);
        };
        if let Some(eight) = chunk_at(cells, spans.depth(i).cell as usize) {
            // Read after the checks, so that each is broadcast from memory.
            let SpanDepth { z, dz, .. } = spans.depth(i);
            let stays = s.test_block(eight, [z, dz], length, self.keeps);
            if stays == u64::MAX {
                return None;
            }
            self.nearer += stays.count_zeros() / 8;
            pixels.stays = stays;
        }
        Some(pixels)
    }
}

impl Destination for Masked<'_> {
    const SHOWS_PAIRS: bool = false;

    #[inline(always)]
    fn all(&mut self) -> &mut [u8] {
        self.pixels
    }

    /// A short span is tested first, so that nothing is computed for a hidden one.
    #[inline(always)]
    fn begin<S: Lanes8>(&mut self, s: S, spans: &Spans<'_>, i: usize) -> Option<DrawnPixels> {
        let pixels = self.untested(spans, i);
        self.test(s, spans, i, pixels)
    }

    #[inline(always)]
    fn show<S: Lanes8, T: Tint>(
        &mut self,
        s: S,
        (spans, i, before): (&Spans<'_>, usize, u32),
        pixels: DrawnPixels,
        (texels, tint, along): (Texels<'_>, T, &mut T::Along<S>),
        mut offsets: impl OffsetsAlong<S>,
    ) {
        // Copies only what the test changes: a copy of the whole would move its padding through memory.
        let DrawnPixels { at, length, mut stays, .. } = pixels;
        if !pixels.is_tested {
            let Some(tested) = self.test(s, spans, i, pixels) else { return };
            stays = tested.stays;
        }
        if stays != u64::MAX {
            if let Some(block) = chunk_at(self.pixels, at) {
                show_block::<S, T, false>(s, (block, stays), texels, (tint, along), &mut offsets);
            }
            return;
        }
        let Some(row) = self.pixels.get_mut(at..) else { return };
        let mut masks = Masks::default();
        let Some(masks) = masks.get_mut(..length.div_ceil(LANES)) else { return };
        if let Some(all) = &mut self.cells {
            let SpanDepth { cell, z, dz } = spans.depth(i);
            let Some(cells) = all.get_mut((cell + before) as usize..) else { return };
            let depths = [z.wrapping_add(dz.wrapping_mul(before.into())), dz];
            let nearer = test_blocks(s, (cells, length), depths, self.keeps, masks);
            self.nearer += nearer;
            if nearer == 0 {
                return;
            }
        } else if let Some(last) = masks.last_mut() {
            *last = behind((length - 1) % LANES + 1);
        }
        show_masked(s, (row, masks), texels, (tint, along), offsets);
    }
}

/// The mask of a block of which only the first `length` pixels, at most eight, are drawn.
#[inline(always)]
fn behind(length: usize) -> u64 {
    if length < LANES { u64::MAX << (8 * length) } else { 0 }
}
