//! Lists of spans, drawn by one call: the spans of a batch of triangles.
//!
//! ```text
//! for every span of the list:  fill(pixels[at .. at + length], shade, step)
//! ```
//!
//! or, with a depth test, `fill_nearer`. Rows of triangles are appended eight at a time; lanes without pixels, and
//! spans that do not lie inside the pixels, are dropped by compression, so no branch depends on how many there are.

use super::depth::{Cell, fill_nearer};
use super::target::{SpanDepth, Target};
use crate::lanes::LANES;
use crate::simd::Lanes8;

/// Number of spans that a list can hold.
const CAPACITY: usize = 128;

type Numbers = [u32; CAPACITY + LANES];
type Depths = [i64; CAPACITY + LANES];

/// Eight sums in one cache line: each vector of rows is added to what the one before has just stored, and across two
/// lines that takes several times as long.
#[derive(Clone, Debug)]
#[repr(align(32))]
struct Sums([i32; LANES]);

/// Spans, in arrays. Each lies inside the pixels and, with depths, the cells.
///
/// # Safety invariant
/// The stores of AVX-512 rely on that. Only `append` and `push` add spans, and they add none that lies outside;
/// `append` relies on `Lanes8` to compute what its methods say.
#[derive(Clone, Debug)]
pub(crate) struct SpanList {
    /// Offsets of the first pixels.
    at: Numbers,
    /// Offsets of the first cells, if there are depths and these offsets differ from those of the pixels.
    cell: Numbers,
    length: Numbers,
    /// The shade, with the step in the upper half; or the index of a [record](super::records::Records) in the lowest eight bits.
    fill: Numbers,
    /// Depths, with the integer part in the upper half, modulo 2⁶⁴.
    z: Depths,
    dz: Depths,
    count: usize,
    /// Numbers of pixels and cells. If a pixel and its cell have the same offset, there are no more pixels than cells:
    /// what lies inside the pixels lies inside both.
    pixels: i32,
    cells: i32,
    /// Pixels from one row to the next.
    pub(crate) pitch: i32,
    /// Cells from one row to the next.
    pub(crate) width: i32,
    /// True if `pitch` equals `width`, so that pixels and their cells have the same offset.
    cells_are_pixels: bool,
    /// True if there are cells.
    pub(crate) has_cells: bool,
    /// Pixels of all spans so far, as eight partial sums.
    covered: Sums,
    /// Spans that have been drawn.
    drawn: u32,
    /// Pixels that were nearer.
    nearer: u32,
}

/// Eight spans. A span of no length is absent.
pub(crate) struct Spans8<S: Lanes8> {
    pub(crate) at: S::I32,
    pub(crate) cell: S::I32,
    pub(crate) length: S::I32,
    /// Their fills, as in the list.
    pub(crate) fill: S::I32,
    /// Depths, as in the list.
    pub(crate) z: S::I64,
}

/// The change of depth of eight spans per pixel, as in the list.
#[derive(Clone, Copy)]
pub(crate) enum DepthSteps<S: Lanes8> {
    Each(S::I64),
    /// One for all: that of one triangle.
    All(i64),
}

impl<S: Lanes8> Spans8<S> {
    /// Interleaves the steps of both: spans 0, spans 1, and so on.
    #[inline(always)]
    pub(crate) fn zip(&self, s: S, other: &Self, list: &SpanList, has_depths: bool) -> [Self; 2] {
        let [at, more_at] = s.interleave_i32(self.at, other.at);
        let [cell, more_cell] =
            if has_depths && !list.cells_are_pixels { s.interleave_i32(self.cell, other.cell) } else { [at, more_at] };
        let [length, more_length] = s.interleave_i32(self.length, other.length);
        let [fill, more_fill] = s.interleave_i32(self.fill, other.fill);
        let [z, more_z] = if has_depths { s.interleave_i64(self.z, other.z) } else { [self.z, other.z] };
        [
            Self { at, cell, length, fill, z },
            Self { at: more_at, cell: more_cell, length: more_length, fill: more_fill, z: more_z },
        ]
    }
}

impl SpanList {
    /// Number of spans that a list can hold.
    #[cfg(feature = "alloc")]
    pub(crate) const CAPACITY: usize = CAPACITY;

    /// An empty list over an empty target.
    pub(crate) const NONE: Self = {
        const NUMBERS: Numbers = [0; CAPACITY + LANES];
        const DEPTHS: Depths = [0; CAPACITY + LANES];
        Self {
            at: NUMBERS,
            cell: NUMBERS,
            length: NUMBERS,
            fill: NUMBERS,
            z: DEPTHS,
            dz: DEPTHS,
            count: 0,
            pixels: 0,
            cells: 0,
            pitch: 0,
            width: 0,
            cells_are_pixels: false,
            has_cells: false,
            covered: Sums([0; LANES]),
            drawn: 0,
            nearer: 0,
        }
    };

    /// Empties the list, for the pixels and cells of a target, each with its pitch, and resets its counts.
    #[inline(always)]
    pub(crate) fn begin(&mut self, target: &Target<'_>, [pitch, width]: [u32; 2]) {
        // No frame has offsets beyond that.
        let most = |length: usize| length.min(i32::MAX as usize) as i32;
        (self.pixels, self.pitch) = (most(target.pixels.len()), pitch as i32);
        self.has_cells = target.cells.is_some();
        (self.cells, self.width) = match &target.cells {
            Some(cells) => (most(cells.len()), width as i32),
            None => (self.pixels, self.pitch),
        };
        self.cells_are_pixels = self.pitch == self.width;
        if self.cells_are_pixels {
            self.pixels = self.pixels.min(self.cells);
        }
        (self.count, self.covered, self.drawn, self.nearer) = (0, Sums([0; LANES]), 0, 0);
    }

    /// Counts of everything drawn: spans, the pixels that they cover, and those that were nearer.
    pub(crate) fn counts(&self) -> (u32, u32, u32) {
        (self.drawn, self.covered.0.iter().sum::<i32>().cast_unsigned(), self.nearer)
    }

    /// Returns whether there is room for this many more.
    #[inline(always)]
    pub(crate) fn has_room(&self, spans: usize) -> bool {
        self.count + spans <= CAPACITY
    }

    /// The mask of the spans, out of eight, that are not empty and lie inside.
    #[inline(always)]
    fn inside<S: Lanes8>(&self, s: S, spans: &Spans8<S>, has_depths: bool) -> S::Mask {
        // Each is negative if a span has no length, begins before the pixels, ends beyond 2³¹, or ends beyond the
        // pixels.
        let end = s.add_i32(spans.at, spans.length);
        let mut sign = s.or_i32(s.sub_i32(spans.length, s.splat_i32(1)), s.or_i32(spans.at, end));
        sign = s.or_i32(sign, s.sub_i32(s.splat_i32(self.pixels), end));
        if has_depths && !self.cells_are_pixels {
            let end = s.add_i32(spans.cell, spans.length);
            sign = s.or_i32(sign, s.or_i32(spans.cell, end));
            sign = s.or_i32(sign, s.sub_i32(s.splat_i32(self.cells), end));
        }
        s.is_greater(sign, s.splat_i32(-1))
    }

    /// Appends whichever of eight spans have a length and lie inside, with depths if given their change per pixel. If
    /// there is no room for eight, some are dropped.
    #[inline(always)]
    pub(crate) fn append<S: Lanes8>(&mut self, s: S, spans: &Spans8<S>, dz: Option<DepthSteps<S>>) {
        let &Spans8 { at, cell, length, fill, z, .. } = spans;
        let mask = self.inside(s, spans, dz.is_some());
        let covered = s.select_i32(mask, length, s.splat_i32(0));
        s.store_i32(s.add_i32(s.load_i32(&self.covered.0), covered), &mut self.covered.0);
        let count = self.count.min(CAPACITY);
        s.compress_i32(
            mask,
            [at, length, fill],
            [eight(&mut self.at, count), eight(&mut self.length, count), eight(&mut self.fill, count)],
        );
        if let Some(dz) = dz {
            if !self.cells_are_pixels {
                s.compress_i32(mask, [cell], [eight(&mut self.cell, count)]);
            }
            match dz {
                DepthSteps::Each(dz) => {
                    s.compress_i64(mask, [z, dz], [eight(&mut self.z, count), eight(&mut self.dz, count)]);
                }
                DepthSteps::All(dz) => {
                    s.compress_i64(mask, [z], [eight(&mut self.z, count)]);
                    *eight(&mut self.dz, count) = [dz; LANES];
                }
            }
        }
        self.count = (count + s.to_bitmask(mask).count_ones() as usize).min(CAPACITY);
    }

    /// Draws the spans, where they are nearer if there are cells, and empties the list.
    pub(crate) fn draw(&mut self, target: &mut Target<'_>) {
        if target.cells.is_some() { self.draw_by::<true>(target) } else { self.draw_by::<false>(target) }
    }

    /// Draws the spans, with `DEPTHS` only where they are nearer than the cells, and empties the
    /// list. If there are fewer pixels or cells than the list was made for, nothing is drawn.
    #[inline(never)]
    pub(crate) fn draw_by<const DEPTHS: bool>(&mut self, Target { pixels, cells, kernel }: &mut Target<'_>) {
        if self.count == 0 {
            return;
        }
        let mut nearer = 0;
        match cells {
            Some(cells) if DEPTHS => nearer = kernel.fill_spans_nearer(pixels, cells, self),
            _ => kernel.fill_spans(pixels, self),
        }
        self.clear(nearer);
    }

    /// Number of spans.
    #[inline(always)]
    pub(crate) fn count(&self) -> usize {
        self.count.min(CAPACITY)
    }

    /// Appends a span, given the offsets of its first pixel and cell, with its depth and the change per pixel, if it
    /// lies inside and there is room. Returns whether it was appended.
    pub(crate) fn push(&mut self, [at, cell]: [usize; 2], length: usize, fill: u32, [z, dz]: [i64; 2]) -> bool {
        let is_inside = |from: usize, most: i32| from.checked_add(length).is_some_and(|end| end <= most as usize);
        if self.count >= CAPACITY || length == 0 || !is_inside(at, self.pixels) || !is_inside(cell, self.cells) {
            return false;
        }
        let k = self.count;
        // Below 2³¹.
        (self.at[k], self.cell[k], self.length[k], self.fill[k]) = (at as u32, cell as u32, length as u32, fill);
        (self.z[k], self.dz[k]) = (z, dz);
        self.covered.0[0] = self.covered.0[0].wrapping_add(length as i32);
        self.count += 1;
        true
    }

    /// Empties the list after its spans have been drawn and `nearer` pixels have been written.
    #[inline(always)]
    pub(crate) fn clear(&mut self, nearer: u32) {
        // At most 2⁷ at a time; the sum is modulo 2³², like those of `DrawStats`.
        self.drawn = self.drawn.wrapping_add(self.count as u32);
        self.nearer = self.nearer.wrapping_add(nearer);
        self.count = 0;
    }

    /// Returns whether all spans lie inside these pixels.
    #[cfg(simd_x86_64)]
    pub(super) fn are_inside(&self, pixels: &[u8]) -> bool {
        pixels.len() >= self.pixels as usize
    }

    /// Returns whether all spans lie inside these cells.
    #[cfg(simd_x86_64)]
    pub(super) fn are_inside_cells<D>(&self, cells: &[D]) -> bool {
        cells.len() >= self.cells as usize
    }

    /// Span `k`, which is below [`count`](Self::count).
    #[inline(always)]
    pub(crate) fn span(&self, k: usize) -> Span {
        let k = k % CAPACITY;
        Span { at: self.at[k], length: self.length[k], fill: self.fill[k] }
    }

    /// The shade of span `k`, with the step in the upper half, to be broadcast from memory.
    #[cfg(simd_x86_64)]
    #[inline(always)]
    pub(crate) fn fill(&self, k: usize) -> &u32 {
        &self.fill[k % CAPACITY]
    }

    /// The depth of span `k`, which is below [`count`](Self::count).
    #[inline(always)]
    pub(crate) fn depth(&self, k: usize) -> SpanDepth {
        self.depths().of(k)
    }

    /// The depths of all spans, for loops.
    #[inline(always)]
    pub(crate) fn depths(&self) -> SpanDepths<'_> {
        let cell = if self.cells_are_pixels { &self.at } else { &self.cell };
        SpanDepths { cell, z: &self.z, dz: &self.dz }
    }

    /// The spans, in order.
    #[inline(always)]
    pub(super) fn spans(&self) -> impl Iterator<Item = Span> {
        (0..self.count()).map(|k| self.span(k))
    }

    /// Fills each span by calling `fill`.
    #[inline(always)]
    pub(super) fn each(&self, pixels: &mut [u8], fill: impl Fn(&mut [u8], u16, u16)) {
        for Span { at, length, fill: own } in self.spans() {
            // No overflow: both are below 2³¹.
            if let Some(row) = pixels.get_mut(at as usize..at as usize + length as usize) {
                // The shade in the lower half, the step in the upper.
                fill(row, own as u16, (own >> 16) as u16);
            }
        }
    }

    /// Fills each span where it is nearer. Returns the number of pixels written.
    #[inline(never)]
    pub(super) fn each_nearer<D: Cell>(&self, pixels: &mut [u8], cells: &mut [D]) -> u32 {
        self.each_tested(pixels, cells, |fill, row, cells, [z, dz]| {
            // The shade in the lower half, the step in the upper.
            fill_nearer(row, cells, fill as u16, (fill >> 16) as u16, z, dz)
        })
    }

    /// Calls a loop that tests depths for each span, with its fill, its pixels and cells, its first depth and its depth
    /// step. Returns the sum of the loop's results.
    #[inline(always)]
    pub(super) fn each_tested<D: Cell>(
        &self,
        pixels: &mut [u8],
        cells: &mut [D],
        mut draw: impl FnMut(u32, &mut [u8], &mut [D], [i64; 2]) -> u32,
    ) -> u32 {
        let mut written = 0;
        for k in 0..self.count() {
            let (Span { at, length, fill }, SpanDepth { cell, z, dz }) = (self.span(k), self.depth(k));
            // No overflow: all are below 2³¹.
            let (at, cell, length) = (at as usize, cell as usize, length as usize);
            if let (Some(row), Some(cells)) = (pixels.get_mut(at..at + length), cells.get_mut(cell..cell + length)) {
                written += draw(fill, row, cells, [z >> 8, dz >> 8]);
            }
        }
        written
    }
}

/// A span of a list.
#[derive(Clone, Copy)]
pub(crate) struct Span {
    /// The offset of its first pixel.
    pub(crate) at: u32,
    pub(crate) length: u32,
    /// Its fill, as in the list.
    pub(crate) fill: u32,
}

/// The depths of the spans of a list.
#[derive(Clone, Copy)]
pub(crate) struct SpanDepths<'a> {
    cell: &'a Numbers,
    z: &'a Depths,
    dz: &'a Depths,
}

impl SpanDepths<'_> {
    /// The depth of span `k`.
    #[inline(always)]
    pub(crate) fn of(self, k: usize) -> SpanDepth {
        let k = k % CAPACITY;
        SpanDepth { cell: self.cell[k], z: self.z[k], dz: self.dz[k] }
    }
}

/// Eight elements from this index on.
#[inline(always)]
fn eight<T>(numbers: &mut [T; CAPACITY + LANES], from: usize) -> &mut [T; LANES] {
    let rest = &mut numbers[from.min(CAPACITY)..];
    match rest.first_chunk_mut() {
        Some(eight) => eight,
        None => unreachable!("eight places are behind the last"),
    }
}
