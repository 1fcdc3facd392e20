//! Loops over the texels of a span: where they lie in their image, and how they are shown.

use super::Texels;
use super::tint::{NUMBERS_OF_PAIR, PairValues, Tint};
use crate::fixed::IS_COMPACT;
use crate::lanes::{LANES, NUMBERS, each};
use crate::simd::Lanes8;

/// Shows texels in the first `length` pixels of a row; the rest of the row does not change. `offsets` gives those of the
/// next eight texels, in lanes.
#[inline(always)]
pub(crate) fn show_along<S: Lanes8, T: Tint>(
    s: S,
    (row, length): (&mut [u8], usize),
    texels: Texels<'_>,
    (tint, along): (T, &mut T::Along<S>),
    mut offsets: impl OffsetsAlong<S>,
) {
    // Never true: it tells the compiler that there is a last texel, so that the masked index needs no check.
    if texels.bytes.is_empty() {
        return;
    }
    let image = (texels, texels.bytes.len() - 1);
    let (mut rest, mut left) = (row, length);
    while left > 0 {
        let offsets = offsets.next();
        let Some(&pixels) = rest.first_chunk::<LANES>() else {
            // At the frame's end.
            let mut pixels = [0; LANES];
            for (to, pixel) in pixels.iter_mut().zip(&*rest) {
                *to = *pixel;
            }
            let (rows, offsets) = (tint.rows::<S, false>(s, along, &pixels), s.low_words(offsets));
            for (k, pixel) in rest.iter_mut().take(left).enumerate() {
                *pixel = texel(tint, rows, offsets, image, k % LANES);
            }
            return;
        };
        // How many pixels are left is unpredictable: trailing bytes are rewritten unchanged.
        if left <= FOUR
            && let Some(row) = rest.first_chunk_mut()
        {
            let (rows, offsets) = (tint.rows::<S, false>(s, along, &pixels), s.low_words(offsets));
            let mask = u32::MAX >> (8 * (FOUR - left));
            let bytes = four_texels(tint, rows, offsets, image, 0);
            *row = (bytes & mask | u32::from_le_bytes(*row) & !mask).to_le_bytes();
            return;
        }
        let Some((block, behind)) = rest.split_first_chunk_mut::<LANES>() else { return };
        if left < LANES {
            let (rows, offsets) = (tint.rows::<S, false>(s, along, block), s.low_words(offsets));
            let mask = u64::MAX >> (8 * (LANES - left));
            let bytes: [u8; LANES] = each!(k => texel(tint, rows, offsets, image, k));
            *block = (u64::from_le_bytes(bytes) & mask | u64::from_le_bytes(*block) & !mask).to_le_bytes();
            return;
        }
        let (rows, offsets) = (tint.rows::<S, true>(s, along, block), s.low_words_in_bulk(offsets));
        *block = s.join_bytes(each!(k => texel(tint, rows, offsets, image, k)));
        (rest, left) = (behind, left - LANES);
    }
}

/// Shows texels as [`show_along`] does, under the masks of [`depth_test`](crate::span::depth_test), one for each block.
#[inline(always)]
pub(crate) fn show_masked<S: Lanes8, T: Tint>(
    s: S,
    (row, masks): (&mut [u8], &[u64]),
    texels: Texels<'_>,
    (tint, along): (T, &mut T::Along<S>),
    mut offsets: impl OffsetsAlong<S>,
) {
    // Never true: see `show_along`.
    if texels.bytes.is_empty() {
        return;
    }
    let mut rest = row;
    for &stays in masks {
        if rest.len() < LANES {
            // At the frame's end.
            let rows = tint.rows::<S, false>(s, along, &[0; LANES]);
            let offsets = s.low_words(offsets.next());
            for (k, (pixel, stay)) in rest.iter_mut().zip(stays.to_le_bytes()).enumerate() {
                if stay == 0 {
                    *pixel = texel(tint, rows, offsets, (texels, texels.bytes.len() - 1), k % LANES);
                }
            }
            break;
        }
        let Some((block, behind)) = rest.split_first_chunk_mut::<LANES>() else { break };
        rest = behind;
        if stays == u64::MAX {
            tint.rows::<S, false>(s, along, block);
            offsets.skip();
        } else {
            show_block::<S, T, true>(s, (block, stays), texels, (tint, along), &mut offsets);
        }
    }
}

/// Shows texels in eight pixels, except for those that the mask leaves unchanged.
#[inline(always)]
pub(crate) fn show_block<S: Lanes8, T: Tint, const IN_BULK: bool>(
    s: S,
    (block, stays): (&mut [u8; LANES], u64),
    texels: Texels<'_>,
    (tint, along): (T, &mut T::Along<S>),
    offsets: &mut impl OffsetsAlong<S>,
) {
    // Never true: see `show_along`.
    if texels.bytes.is_empty() {
        return;
    }
    let image = (texels, texels.bytes.len() - 1);
    // How many pixels are nearer is unpredictable: the others are rewritten unchanged. (Each case
    // extracts its own lanes: all of them, extracted up front, would not fit into the registers.)
    if IN_BULK && stays == 0 && !IS_COMPACT {
        let (rows, offsets) = (tint.rows::<S, true>(s, along, block), s.low_words_in_bulk(offsets.next()));
        *block = s.join_bytes(each!(k => texel(tint, rows, offsets, image, k)));
    } else if stays >> 32 == u64::from(u32::MAX) {
        let (rows, offsets) = (tint.rows::<S, false>(s, along, block), s.low_words(offsets.next()));
        let Some(four) = block.first_chunk_mut() else { return };
        // The lower half.
        let stay = stays as u32;
        let bytes = four_texels(tint, rows, offsets, image, 0);
        *four = (bytes & !stay | u32::from_le_bytes(*four) & stay).to_le_bytes();
    } else {
        let (rows, offsets) = (tint.rows::<S, false>(s, along, block), s.low_words(offsets.next()));
        let bytes: [u8; LANES] = each!(k => texel(tint, rows, offsets, image, k));
        *block = (u64::from_le_bytes(bytes) & !stays | u64::from_le_bytes(*block) & stays).to_le_bytes();
    }
}

/// Shows texels in two spans of up to four pixels, at these indices of the frame or buffer, except for the pixels that
/// the mask leaves unchanged. `offsets` are those of the texels, four for each span.
#[inline(always)]
pub(crate) fn show_pair<S: Lanes8, T: Tint>(
    s: S,
    (all, [a, b], stays): (&mut [u8], [usize; 2], u64),
    texels: Texels<'_>,
    (tint, values): (T, PairValues),
    offsets: S::I32,
) {
    // Never true: see `show_along`.
    if texels.bytes.is_empty() {
        return;
    }
    let (image, offsets) = ((texels, texels.bytes.len() - 1), s.low_words(offsets));
    // Tints that read pixels are not shown in pairs.
    let rows = tint.rows::<S, false>(s, &mut tint.begin(s, values), &[0; LANES]);
    let [low, high] = [four_texels(tint, rows, offsets, image, 0), four_texels(tint, rows, offsets, image, FOUR)];
    for (at, bytes, stay) in [(a, low, stays as u32), (b, high, (stays >> 32) as u32)] {
        let Some(four) = all.get_mut(at..at + FOUR).and_then(<[u8]>::first_chunk_mut) else { return };
        *four = (bytes & !stay | u32::from_le_bytes(*four) & stay).to_le_bytes();
    }
}

/// Texel `k` of eight, as it is shown. `last` is the index of the last texel.
#[inline(always)]
fn texel<T: Tint>(tint: T, rows: T::Rows, offsets: [u16; LANES], (texels, last): (Texels<'_>, usize), k: usize) -> u8 {
    tint.show(rows, k, texels.bytes[usize::from(offsets[k]) & last])
}

/// Four of eight texels, from the first or from the fifth on, as they are shown.
#[inline(always)]
fn four_texels<T: Tint>(
    tint: T,
    rows: T::Rows,
    offsets: [u16; LANES],
    image: (Texels<'_>, usize),
    first: usize,
) -> u32 {
    u32::from_le_bytes([
        texel(tint, rows, offsets, image, first),
        texel(tint, rows, offsets, image, first + 1),
        texel(tint, rows, offsets, image, first + 2),
        texel(tint, rows, offsets, image, first + 3),
    ])
}

/// The number of pixels that are written at once if no more are left.
pub(crate) const FOUR: usize = LANES / 2;

/// Offsets of texels, eight at a time.
pub(crate) trait OffsetsAlong<S: Lanes8> {
    fn next(&mut self) -> S::I32;
    /// Skips the next eight.
    #[inline(always)]
    fn skip(&mut self) {
        self.next();
    }
}

/// The texels of a level, and its index.
pub(crate) type LevelTexels<'a> = (Texels<'a>, u32);

/// Computes offsets of texels in vectors.
#[derive(Clone, Copy)]
pub(crate) struct OffsetLanes<S: Lanes8> {
    pub(crate) s: S,
    columns: S::I32,
    rows: S::I32,
    width: S::I32,
    /// Fraction bits of coordinates: 16, and one for each level.
    bits: i32,
}

impl<S: Lanes8> OffsetLanes<S> {
    /// Offsets in a level of an image, of coordinates in level 0.
    #[inline(always)]
    pub(crate) fn of_level(s: S, (texels, level): LevelTexels<'_>) -> Self {
        let columns = (1 << texels.ubits) - 1;
        let rows = ((1 << texels.vbits) - 1) << texels.ubits;
        let bits = 16 + level.cast_signed();
        Self { s, columns: s.splat_i32(columns), rows: s.splat_i32(rows), width: s.splat_i32(columns + 1), bits }
    }

    /// Computes [`Texels::offset`] for these coordinates.
    #[inline(always)]
    pub(super) fn at_coordinates(self, u: S::I32, v: S::I32) -> S::I32 {
        self.at(u, self.s.mul_i32(v, self.width))
    }

    /// The bits of a coordinate inside its texel.
    #[inline(always)]
    pub(super) fn fraction(self) -> S::I32 {
        self.s.splat_i32((1 << self.bits) - 1)
    }

    /// Computes [`Texels::offset`] for u, and for v times the width, whose lost bits the masks would clear anyway.
    #[inline(always)]
    fn at(self, u: S::I32, v: S::I32) -> S::I32 {
        let s = self.s;
        s.or_i32(s.and_i32(s.shr_i32(v, self.bits), self.rows), s.and_i32(s.shr_i32(u, self.bits), self.columns))
    }
}

/// Offsets of texels along a line, as in [`fill_affine`](super::fill_affine).
pub(crate) struct AffineAlong<S: Lanes8> {
    offsets: OffsetLanes<S>,
    /// u, and v times the width, of the next eight texels; and their change from these to the eight after them.
    at: [S::I32; 2],
    step: [S::I32; 2],
}

impl<S: Lanes8> AffineAlong<S> {
    /// The texels from (`u`, `v`) on, with the change per pixel.
    #[inline(always)]
    pub(crate) fn new(
        offsets: OffsetLanes<S>,
        texels: Texels<'_>,
        [[u, v], [du, dv]]: [[u32; 2]; 2],
        skipped: u32,
    ) -> Self {
        let s = offsets.s;
        // At most 63; the sums are modulo 2³².
        let numbers = s.add_i32(s.load_i32(&NUMBERS), s.splat_i32(skipped.cast_signed()));
        let along = |first: S::I32, step: S::I32| (s.add_i32(first, s.mul_i32(step, numbers)), s.shl_i32(step, 3));
        let splat = |value: u32| s.splat_i32(value.cast_signed());
        let (u, du) = along(splat(u), splat(du));
        let bits = texels.ubits.cast_signed();
        let (v, dv) = along(s.shl_i32(splat(v), bits), s.shl_i32(splat(dv), bits));
        Self { offsets, at: [u, v], step: [du, dv] }
    }
}

/// The offsets of the first four texels along two lines, as in [`AffineAlong`].
#[inline(always)]
pub(crate) fn affine_pair<S: Lanes8>(
    s: S,
    texels: Texels<'_>,
    [[[u, v], [du, dv]], [[u2, v2], [du2, dv2]]]: [[[u32; 2]; 2]; 2],
) -> S::I32 {
    let numbers = s.load_i32(&NUMBERS_OF_PAIR);
    let pair = |a: u32, b: u32| [a.cast_signed(), b.cast_signed()];
    let u = s.add_i32(s.halves_i32(pair(u, u2)), s.mul_i32(s.halves_i32(pair(du, du2)), numbers));
    let v = s.add_i32(s.halves_i32(pair(v, v2)), s.mul_i32(s.halves_i32(pair(dv, dv2)), numbers));
    OffsetLanes::of_level(s, (texels, 0)).at_coordinates(u, v)
}

impl<S: Lanes8> OffsetsAlong<S> for AffineAlong<S> {
    #[inline(always)]
    fn next(&mut self) -> S::I32 {
        let (s, [u, v], [du, dv]) = (self.offsets.s, self.at, self.step);
        self.at = [s.add_i32(u, du), s.add_i32(v, dv)];
        self.offsets.at(u, v)
    }
}

/// Offsets of the texels of up to 64 pixels, eight at a time.
pub(crate) type StoredOffsets = [[i32; LANES]; 8];

/// Offsets that a function computes all at once when the first of them are requested.
pub(crate) struct StoredAlong<S, F> {
    s: S,
    fill: F,
    offsets: StoredOffsets,
    /// The index of the next eight.
    next: usize,
    is_filled: bool,
}

impl<S: Lanes8, F: FnMut(&mut StoredOffsets)> StoredAlong<S, F> {
    #[inline(always)]
    pub(crate) fn new(s: S, fill: F) -> Self {
        Self { s, fill, offsets: [[0; LANES]; 8], next: 0, is_filled: false }
    }
}

impl<S: Lanes8, F: FnMut(&mut StoredOffsets)> OffsetsAlong<S> for StoredAlong<S, F> {
    #[inline(always)]
    fn next(&mut self) -> S::I32 {
        if !self.is_filled {
            self.is_filled = true;
            (self.fill)(&mut self.offsets);
        }
        let eight = self.next % 8;
        self.skip();
        self.s.load_i32(&self.offsets[eight])
    }

    #[inline(always)]
    fn skip(&mut self) {
        self.next += 1;
    }
}

/// The first texel again and again.
pub(crate) struct FirstOffset<S>(pub(crate) S);

impl<S: Lanes8> OffsetsAlong<S> for FirstOffset<S> {
    #[inline(always)]
    fn next(&mut self) -> S::I32 {
        self.0.splat_i32(0)
    }
}
