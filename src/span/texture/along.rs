//! Loops over the texels of a span: where they lie in their image, and how they are shown.

use super::Texels;
use super::tint::{NUMBERS_OF_PAIR, PairValues, Tint};
use crate::fixed::IS_COMPACT;
use crate::lanes::{LANES, NUMBERS};
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
    // Never true. Without it the compiler would ask for every block, which takes up to 60 % longer.
    if texels.bytes.is_empty() {
        return;
    }
    let (mut rest, mut left) = (row, length);
    while left > 0 {
        let offsets = offsets.next();
        let Some(pixels) = rest.first_chunk::<LANES>() else {
            // At the frame's end.
            let mut pixels = [0; LANES];
            for (to, pixel) in pixels.iter_mut().zip(&*rest) {
                *to = *pixel;
            }
            let bytes = shown(s, (tint, tint.rows(s, along)), texels, offsets, &pixels);
            for (pixel, byte) in rest.iter_mut().zip(bytes).take(left) {
                *pixel = byte;
            }
            return;
        };
        // How many pixels are left is unpredictable: trailing bytes are rewritten unchanged. (Each case loads its own
        // texels, and a block is split off after the first: otherwise the compiler would load them for all cases at
        // once and join them later, which takes full blocks up to 40 % longer.)
        if left <= FOUR {
            let mask = u32::MAX >> (8 * (FOUR - left));
            let [bytes, _] = fours(s.join_bytes(shown(s, (tint, tint.rows(s, along)), texels, offsets, pixels)));
            let Some(row) = rest.first_chunk_mut() else { return };
            *row = (bytes & mask | u32::from_le_bytes(*row) & !mask).to_le_bytes();
            return;
        }
        let Some((block, behind)) = rest.split_first_chunk_mut::<LANES>() else { return };
        if left < LANES {
            let rows = tint.rows(s, along);
            let mask = u64::MAX >> (8 * (LANES - left));
            let bytes = s.join_bytes(shown(s, (tint, rows), texels, offsets, block));
            *block = (u64::from_le_bytes(bytes) & mask | u64::from_le_bytes(*block) & !mask).to_le_bytes();
            return;
        }
        let rows = tint.rows(s, along);
        *block = s.join_bytes(shown(s, (tint, rows), texels, offsets, block));
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
            let rows = tint.rows(s, along);
            let bytes = shown(s, (tint, rows), texels, offsets.next(), &[0; LANES]);
            for (pixel, (byte, stay)) in rest.iter_mut().zip(bytes.into_iter().zip(stays.to_le_bytes())) {
                if stay == 0 {
                    *pixel = byte;
                }
            }
            break;
        }
        let Some((block, behind)) = rest.split_first_chunk_mut::<LANES>() else { break };
        rest = behind;
        if stays == u64::MAX {
            tint.rows(s, along);
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
    let (rows, offsets) = (tint.rows(s, along), offsets.next());
    // How many pixels are nearer is unpredictable: the others are rewritten unchanged. (Each case
    // extracts its own lanes: all of them, extracted up front, would not fit into the registers.)
    if IN_BULK && stays == 0 && !IS_COMPACT {
        *block = s.join_bytes(shown(s, (tint, rows), texels, offsets, block));
    } else if stays >> 32 == u64::from(u32::MAX) {
        // The lower half.
        let (stay, [bytes, _]) = (stays as u32, fours(shown(s, (tint, rows), texels, offsets, block)));
        let Some(four) = block.first_chunk_mut() else { return };
        *four = (bytes & !stay | u32::from_le_bytes(*four) & stay).to_le_bytes();
    } else {
        let bytes = s.join_bytes(shown(s, (tint, rows), texels, offsets, block));
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
    let rows = tint.rows(s, &mut tint.begin(s, values));
    // Tints that read pixels are not shown in pairs.
    let [low, high] = fours(s.join_bytes(shown(s, (tint, rows), texels, offsets, &[0; LANES])));
    for (at, bytes, stay) in [(a, low, stays as u32), (b, high, (stays >> 32) as u32)] {
        let Some(four) = all.get_mut(at..at + FOUR).and_then(<[u8]>::first_chunk_mut) else { return };
        *four = (bytes & !stay | u32::from_le_bytes(*four) & stay).to_le_bytes();
    }
}

/// Eight texels as they are shown in these pixels.
#[inline(always)]
fn shown<S: Lanes8, T: Tint>(
    s: S,
    (tint, rows): (T, T::Rows<S>),
    texels: Texels<'_>,
    offsets: S::I32,
    pixels: &[u8; LANES],
) -> [u8; LANES] {
    tint.show(s, rows, s.bytes_at(texels.bytes, offsets), pixels)
}

/// The first four bytes, and the others.
#[inline(always)]
fn fours([a, b, c, d, e, f, g, h]: [u8; LANES]) -> [u32; 2] {
    [u32::from_le_bytes([a, b, c, d]), u32::from_le_bytes([e, f, g, h])]
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
    /// The bits of u that are those of a column.
    columns: S::I32,
    width: S::I32,
    /// Fraction bits of coordinates: 16, and one for each level.
    bits: i32,
}

impl<S: Lanes8> OffsetLanes<S> {
    /// Offsets in a level of an image, of coordinates in level 0.
    #[inline(always)]
    pub(crate) fn of_level(s: S, (texels, level): LevelTexels<'_>) -> Self {
        let (width, bits) = (1 << texels.ubits, 16 + level.cast_signed());
        Self { s, columns: s.splat_i32((width - 1) << bits), width: s.splat_i32(width), bits }
    }

    /// Computes [`Texels::offset`] for these coordinates, with other bits above those of the last offset.
    #[inline(always)]
    pub(super) fn at_coordinates(self, u: S::I32, v: S::I32) -> S::I32 {
        self.at(u, self.s.mul_i32(v, self.width))
    }

    /// The bits of a coordinate inside its texel.
    #[inline(always)]
    pub(super) fn fraction(self) -> S::I32 {
        self.s.splat_i32((1 << self.bits) - 1)
    }

    /// Computes [`at_coordinates`](Self::at_coordinates) for u, and for v times the width.
    #[inline(always)]
    fn at(self, u: S::I32, v: S::I32) -> S::I32 {
        let s = self.s;
        s.shr_i32(s.xor_i32(v, s.and_i32(s.xor_i32(u, v), self.columns)), self.bits)
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
