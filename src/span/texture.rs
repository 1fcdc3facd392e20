//! Rows of texels: a texture's bytes along a row of the screen.
//!
//! ```text
//! row[k] = texels[(v_k >> 16 & vmask) << ubits | (u_k >> 16 & umask)]
//! ```
//!
//! u and v are 16.16 texel coordinates, u along the texture's rows. A texture is a power of two wide and
//! high, so a mask wraps it, and its last texel meets its first.
//!
//! | loop | u and v |
//! |---|---|
//! | [`fill_affine`] | change by the same amount from each pixel to the next |
//! | [`fill_perspective`] | the floor of a quotient at every pixel: exact |

use core::fmt;

#[cfg(feature = "alloc")]
use crate::fixed::IS_COMPACT;
use crate::fixed::{HAS_F64, ROUND_MAGIC, floor_of_wide};
use crate::lanes::{LANES, NUMBERS, each};
#[cfg(feature = "alloc")]
use crate::simd::F32Lanes8;
use crate::simd::{BASELINE, Lanes8};

/// A texture's bytes, row by row, with their shape.
#[derive(Clone, Copy, Debug)]
pub struct Texels<'a> {
    /// 2^(ubits + vbits), so at least one and at most 65,536.
    bytes: &'a [u8],
    ubits: u32,
    vbits: u32,
}

impl<'a> Texels<'a> {
    /// The most bits that u or v may have: 256 texels.
    pub const MAX_BITS: u32 = 8;

    /// A single texel.
    #[cfg(feature = "alloc")]
    pub(crate) const ONE: Self = Self { bytes: &[0], ubits: 0, vbits: 0 };

    /// A texture 2^`ubits` wide and 2^`vbits` high, row-major.
    ///
    /// # Errors
    /// [`TexelsError`] if it is wider or higher than 256, or if `bytes` has another length.
    ///
    /// ```
    /// use mode13h::internals::span::texture::{Texels, TexelsError};
    ///
    /// assert!(Texels::new(&[0; 64], 4, 2).is_ok()); // 16 × 4
    /// assert_eq!(Texels::new(&[0; 60], 4, 2).unwrap_err(), TexelsError::Length { is: 60, should: 64 });
    /// ```
    pub const fn new(bytes: &'a [u8], ubits: u32, vbits: u32) -> Result<Self, TexelsError> {
        if ubits > Self::MAX_BITS || vbits > Self::MAX_BITS {
            return Err(TexelsError::Bits { ubits, vbits });
        }
        let should = 1 << (ubits + vbits);
        if bytes.len() != should {
            return Err(TexelsError::Length { is: bytes.len(), should });
        }
        Ok(Self { bytes, ubits, vbits })
    }

    /// Texels in a row, 1 to 256.
    #[must_use]
    pub const fn width(self) -> usize {
        1 << self.ubits
    }

    /// Rows, 1 to 256.
    #[must_use]
    pub const fn height(self) -> usize {
        1 << self.vbits
    }

    /// The texel at (`u`, `v`), both 16.16; wraps.
    #[must_use]
    #[inline]
    pub fn at(self, u: u32, v: u32) -> u8 {
        self.bytes[self.place(u, v)]
    }

    /// Index of the texel, below the length. The compiler sees that from the last mask, if it knows that the bytes are
    /// not empty, and omits the bounds check (with everything in usize; with a u32 it does not).
    #[inline]
    fn place(self, u: u32, v: u32) -> usize {
        let last = self.bytes.len() - 1;
        let columns = (1 << self.ubits) - 1;
        // What a narrow usize cuts off, the masks clear anyway.
        let column = (u >> 16) as usize & columns;
        // Shifted once instead of down and up.
        let row = (v >> (16 - self.ubits)) as usize & (last & !columns);
        (row | column) & last
    }
}

/// The smaller copies of a texture: the levels of a mipmap from 1 on. Each has half the columns and half the rows of
/// the level before it, but at least one of each; the last is a single texel. Level 0 is the texture itself.
#[derive(Clone, Copy, Debug)]
pub struct Levels<'a> {
    /// Level after level.
    bytes: &'a [u8],
    ubits: u32,
    vbits: u32,
}

impl<'a> Levels<'a> {
    /// The smaller copies of a texture 2^`ubits` wide and 2^`vbits` high: level 1 row by row, then level 2, and so on.
    ///
    /// # Errors
    /// [`TexelsError`] if the texture is wider or higher than 256, or if `bytes` does not have [`length`](Self::length)
    /// bytes.
    pub const fn new(bytes: &'a [u8], ubits: u32, vbits: u32) -> Result<Self, TexelsError> {
        if ubits > Texels::MAX_BITS || vbits > Texels::MAX_BITS {
            return Err(TexelsError::Bits { ubits, vbits });
        }
        let should = Self::length(ubits, vbits);
        if bytes.len() != should {
            return Err(TexelsError::Length { is: bytes.len(), should });
        }
        Ok(Self { bytes, ubits, vbits })
    }

    /// The index of the last level: 0 for a texture of one texel, at most 8.
    #[must_use]
    pub const fn deepest(ubits: u32, vbits: u32) -> u32 {
        if ubits > vbits { ubits } else { vbits }
    }

    /// The number of texels of all levels from 1 on: for a square texture a third of its own, rounded down.
    #[must_use]
    pub const fn length(ubits: u32, vbits: u32) -> usize {
        let (mut length, mut level) = (0, 1);
        while level <= Self::deepest(ubits, vbits) {
            length += 1 << (ubits.saturating_sub(level) + vbits.saturating_sub(level));
            level += 1;
        }
        length
    }

    /// The index of the last level.
    #[must_use]
    pub const fn last(self) -> u32 {
        Self::deepest(self.ubits, self.vbits)
    }

    /// The texels of a level from 1 to the last. A higher level gives the last one, level 0 `None`.
    #[must_use]
    pub fn get(self, level: u32) -> Option<Texels<'a>> {
        let level = level.min(self.last());
        let bits = |level: u32| (self.ubits.saturating_sub(level), self.vbits.saturating_sub(level));
        let length = |(ubits, vbits): (u32, u32)| 1 << (ubits + vbits);
        let first: usize = (1..level).map(|before| length(bits(before))).sum();
        let (ubits, vbits) = bits(level);
        let bytes = self.bytes.get(first..first + length((ubits, vbits)))?;
        if level == 0 { None } else { Some(Texels { bytes, ubits, vbits }) }
    }
}

/// Bytes that are not a texture.
#[derive(Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum TexelsError {
    /// Wider or higher than 256 texels.
    Bits {
        /// The logarithm of the width, as given.
        ubits: u32,
        /// The logarithm of the height, as given.
        vbits: u32,
    },
    /// The bytes are too few or too many.
    Length {
        /// Bytes given.
        is: usize,
        /// Texels of the texture.
        should: usize,
    },
}

impl fmt::Display for TexelsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bits { ubits, vbits } => {
                write!(f, "a texture of 2^{ubits} × 2^{vbits} texels; at most 256 × 256 are possible")
            }
            Self::Length { is, should } => write!(f, "a texture of {should} texels with {is} bytes"),
        }
    }
}

crate::errors::debug_as_display!(TexelsError);

impl core::error::Error for TexelsError {}

/// Fills `row` with the texels along a straight line through the texture.
///
/// `u` and `v` are the first pixel's coordinates, `du` and `dv` what each pixel adds; the sums wrap, so a negative
/// number is given in two's complement (`as u32`).
///
/// At 64 pixels this takes 45 ns. Two faster versions are not used: `pext` (BMI2), 37 ns, is said to be slow on the
/// first two generations of Zen; eight gathered loads per iteration (AVX2), 26 ns, are said to be much slower on
/// processors patched against gather data sampling.
pub fn fill_affine(row: &mut [u8], texels: Texels<'_>, mut u: u32, mut v: u32, du: u32, dv: u32) {
    for pixel in row {
        *pixel = texels.at(u, v);
        u = u.wrapping_add(du);
        v = v.wrapping_add(dv);
    }
}

/// What is shown for a texel.
pub(crate) trait Shown: Copy {
    /// The tint that does this for a whole span.
    #[cfg(feature = "alloc")]
    type Tint: Tint;
    #[cfg(feature = "alloc")]
    fn tint(self) -> Self::Tint;
    fn show(self, pixel: &mut u8, texel: u8);
}

/// The texel itself is shown.
impl Shown for () {
    #[cfg(feature = "alloc")]
    type Tint = ();
    #[cfg(feature = "alloc")]
    #[inline(always)]
    fn tint(self) {}
    #[inline(always)]
    fn show(self, pixel: &mut u8, texel: u8) {
        *pixel = texel;
    }
}

/// The byte for one shade and the texel is shown.
impl Shown for &[u8; 256] {
    #[cfg(feature = "alloc")]
    type Tint = Self;
    #[cfg(feature = "alloc")]
    #[inline(always)]
    fn tint(self) -> Self {
        self
    }
    #[inline(always)]
    fn show(self, pixel: &mut u8, texel: u8) {
        *pixel = self[usize::from(texel)];
    }
}

/// The byte for the shade in the pixel and the texel is shown, as by [`lookup`](super::lookup). One loop for both takes
/// 0.7 to 0.8 of the time of two.
impl<'a> Shown for &'a [u8; 65_536] {
    #[cfg(feature = "alloc")]
    type Tint = Held<'a>;
    #[cfg(feature = "alloc")]
    #[inline(always)]
    fn tint(self) -> Held<'a> {
        Held(self)
    }
    #[inline(always)]
    fn show(self, pixel: &mut u8, texel: u8) {
        *pixel = self[usize::from(*pixel) << 8 | usize::from(texel)];
    }
}

/// Shows the texels at these indices, see [`Texels::place`].
pub(crate) fn show(shown: impl Shown, row: &mut [u8], texels: Texels<'_>, places: &[i32]) {
    // Never true: it tells the compiler that there is a last texel, so that the masked index needs no check.
    if texels.bytes.is_empty() {
        return;
    }
    let last = texels.bytes.len() - 1;
    let n = row.len().min(places.len());
    let places = &places[..n];
    for (k, pixel) in row[..n].iter_mut().enumerate() {
        // Not negative.
        shown.show(pixel, texels.bytes[places[k] as usize & last]);
    }
}

/// Values of a span that are linear along it: the first, with the step in the upper half.
#[cfg(feature = "alloc")]
#[derive(Clone, Copy)]
pub(crate) struct SpanValues {
    /// The shade.
    pub(crate) paint: u32,
    /// The density of fog, if there is any.
    pub(crate) fog: u32,
    /// Pixels at the beginning that are skipped.
    pub(crate) skipped: u32,
}

/// Turns the texels of a span into the bytes that are shown: as they are, lit, fogged or blended.
#[cfg(feature = "alloc")]
pub(crate) trait Tint: Copy {
    /// True if the density of fog is read.
    const HAS_FOG: bool = false;
    /// State that changes along a span.
    type Along<S: Lanes8>: Copy;
    /// Table rows of eight pixels.
    type Rows: Copy;
    fn begin<S: Lanes8>(self, s: S, values: SpanValues) -> Self::Along<S>;
    /// The table rows of the next eight pixels, whose present bytes are `pixels`; advances the state.
    fn rows<S: Lanes8>(self, s: S, along: &mut Self::Along<S>, pixels: &[u8; LANES]) -> Self::Rows;
    /// The byte for a texel of pixel `k` of eight.
    fn show(self, rows: Self::Rows, k: usize, texel: u8) -> u8;
}

/// A linear value of eight pixels in 8.8, and the step to the next eight.
#[cfg(feature = "alloc")]
type Ramp8<S> = [<S as Lanes8>::I32; 2];

#[cfg(feature = "alloc")]
#[inline(always)]
fn ramp_from<S: Lanes8>(s: S, value: u32, skipped: u32) -> Ramp8<S> {
    // The sums are modulo 2¹⁶; the bits above are not read.
    let step = (value >> 16).cast_signed();
    let first = value.cast_signed().wrapping_add(step.wrapping_mul(skipped.cast_signed()));
    let values = s.add_i32(s.splat_i32(first), s.mul_i32(s.splat_i32(step), s.load_i32(&NUMBERS)));
    [values, s.splat_i32(step.wrapping_mul(LANES as i32))]
}

/// The integer parts of eight values, in the upper bytes: rows of a table. Advances to the next eight.
#[cfg(feature = "alloc")]
#[inline(always)]
fn rows_of<S: Lanes8>(s: S, [values, next]: &mut Ramp8<S>) -> [u16; LANES] {
    let rows = s.low_words(s.and_i32(*values, s.splat_i32(0xFF00)));
    *values = s.add_i32(*values, *next);
    rows
}

/// Texels as they are.
#[cfg(feature = "alloc")]
impl Tint for () {
    type Along<S: Lanes8> = ();
    type Rows = ();
    #[inline(always)]
    fn begin<S: Lanes8>(self, _: S, _: SpanValues) {}
    #[inline(always)]
    fn rows<S: Lanes8>(self, _: S, (): &mut (), _: &[u8; LANES]) {}
    #[inline(always)]
    fn show(self, (): (), _: usize, texel: u8) -> u8 {
        texel
    }
}

/// Texels looked up in one row of a table: one shade for all.
#[cfg(feature = "alloc")]
impl Tint for &[u8; 256] {
    type Along<S: Lanes8> = ();
    type Rows = ();
    #[inline(always)]
    fn begin<S: Lanes8>(self, _: S, _: SpanValues) {}
    #[inline(always)]
    fn rows<S: Lanes8>(self, _: S, (): &mut (), _: &[u8; LANES]) {}
    #[inline(always)]
    fn show(self, (): (), _: usize, texel: u8) -> u8 {
        self[usize::from(texel)]
    }
}

/// Texels lit by a table, with the shades of the span.
#[cfg(feature = "alloc")]
#[derive(Clone, Copy)]
pub(crate) struct Painted<'a>(pub(crate) &'a [u8; 65_536]);

#[cfg(feature = "alloc")]
impl Tint for Painted<'_> {
    type Along<S: Lanes8> = Ramp8<S>;
    type Rows = [u16; LANES];
    #[inline(always)]
    fn begin<S: Lanes8>(self, s: S, values: SpanValues) -> Ramp8<S> {
        ramp_from(s, values.paint, values.skipped)
    }
    #[inline(always)]
    fn rows<S: Lanes8>(self, s: S, along: &mut Ramp8<S>, _: &[u8; LANES]) -> [u16; LANES] {
        rows_of(s, along)
    }
    #[inline(always)]
    fn show(self, rows: [u16; LANES], k: usize, texel: u8) -> u8 {
        self.0[usize::from(rows[k] | u16::from(texel))]
    }
}

/// The shades of the span alone, whatever the texels.
#[cfg(feature = "alloc")]
#[derive(Clone, Copy)]
pub(crate) struct Untextured;

#[cfg(feature = "alloc")]
impl Tint for Untextured {
    type Along<S: Lanes8> = Ramp8<S>;
    type Rows = [u8; LANES];
    #[inline(always)]
    fn begin<S: Lanes8>(self, s: S, values: SpanValues) -> Ramp8<S> {
        ramp_from(s, values.paint, values.skipped)
    }
    #[inline(always)]
    fn rows<S: Lanes8>(self, s: S, [values, next]: &mut Ramp8<S>, _: &[u8; LANES]) -> [u8; LANES] {
        let shades = s.low_bytes(s.shr_i32(*values, 8));
        *values = s.add_i32(*values, *next);
        shades
    }
    #[inline(always)]
    fn show(self, shades: [u8; LANES], k: usize, _: u8) -> u8 {
        shades[k]
    }
}

/// Texels lit by a table, with the shades that the pixels hold.
#[cfg(feature = "alloc")]
#[derive(Clone, Copy)]
pub(crate) struct Held<'a>(&'a [u8; 65_536]);

#[cfg(feature = "alloc")]
impl Tint for Held<'_> {
    type Along<S: Lanes8> = ();
    type Rows = [u8; LANES];
    #[inline(always)]
    fn begin<S: Lanes8>(self, _: S, _: SpanValues) {}
    #[inline(always)]
    fn rows<S: Lanes8>(self, _: S, (): &mut (), pixels: &[u8; LANES]) -> [u8; LANES] {
        *pixels
    }
    #[inline(always)]
    fn show(self, shades: [u8; LANES], k: usize, texel: u8) -> u8 {
        self.0[usize::from(shades[k]) << 8 | usize::from(texel)]
    }
}

/// Blends the bytes of another tint with those of the pixels, by a table with a row for each byte of the tint.
#[cfg(feature = "alloc")]
#[derive(Clone, Copy)]
pub(crate) struct Blended<'a, T>(pub(crate) T, pub(crate) &'a [u8; 65_536]);

#[cfg(feature = "alloc")]
impl<T: Tint> Tint for Blended<'_, T> {
    const HAS_FOG: bool = T::HAS_FOG;
    type Along<S: Lanes8> = T::Along<S>;
    type Rows = (T::Rows, [u8; LANES]);
    #[inline(always)]
    fn begin<S: Lanes8>(self, s: S, values: SpanValues) -> T::Along<S> {
        self.0.begin(s, values)
    }
    #[inline(always)]
    fn rows<S: Lanes8>(self, s: S, along: &mut T::Along<S>, pixels: &[u8; LANES]) -> Self::Rows {
        (self.0.rows(s, along, pixels), *pixels)
    }
    #[inline(always)]
    fn show(self, (rows, pixels): Self::Rows, k: usize, texel: u8) -> u8 {
        self.1[usize::from(self.0.show(rows, k, texel)) << 8 | usize::from(pixels[k])]
    }
}

/// Fogs the bytes of another tint, by a table with a row for each level of fog.
#[cfg(feature = "alloc")]
#[derive(Clone, Copy)]
pub(crate) struct Fogged<'a, T>(pub(crate) T, pub(crate) &'a [u8; 65_536]);

#[cfg(feature = "alloc")]
impl<T: Tint> Tint for Fogged<'_, T> {
    const HAS_FOG: bool = true;
    type Along<S: Lanes8> = (T::Along<S>, Ramp8<S>);
    type Rows = (T::Rows, [u16; LANES]);
    #[inline(always)]
    fn begin<S: Lanes8>(self, s: S, values: SpanValues) -> Self::Along<S> {
        (self.0.begin(s, values), ramp_from(s, values.fog, values.skipped))
    }
    #[inline(always)]
    fn rows<S: Lanes8>(self, s: S, (along, fog): &mut Self::Along<S>, pixels: &[u8; LANES]) -> Self::Rows {
        (self.0.rows(s, along, pixels), rows_of(s, fog))
    }
    #[inline(always)]
    fn show(self, (rows, levels): Self::Rows, k: usize, texel: u8) -> u8 {
        self.1[usize::from(levels[k] | u16::from(self.0.show(rows, k, texel)))]
    }
}

/// Shows texels in the first `length` pixels of a row: `places` gives the indices of the next eight, in lanes. What
/// follows those pixels does not change.
#[cfg(feature = "alloc")]
#[inline(always)]
pub(crate) fn show_along<S: Lanes8, T: Tint>(
    s: S,
    (row, length): (&mut [u8], usize),
    texels: Texels<'_>,
    (tint, along): (T, &mut T::Along<S>),
    mut places: impl PlacesAlong<S>,
) {
    // Never true: see `show`.
    if texels.bytes.is_empty() {
        return;
    }
    let last = texels.bytes.len() - 1;
    let (mut rest, mut left) = (row, length);
    while left > 0 {
        let places = s.low_words(places.next());
        let Some(pixels) = rest.first_chunk::<LANES>() else {
            // At the frame's end.
            let mut pixels = [0; LANES];
            for (to, pixel) in pixels.iter_mut().zip(&*rest) {
                *to = *pixel;
            }
            let rows = tint.rows(s, along, &pixels);
            for (k, pixel) in rest.iter_mut().take(left).enumerate() {
                *pixel = texel(tint, rows, places, (texels, last), k % LANES);
            }
            return;
        };
        let rows = tint.rows(s, along, pixels);
        // How many pixels are left is unpredictable: trailing bytes are rewritten unchanged.
        if left <= FOUR
            && let Some(row) = rest.first_chunk_mut()
        {
            let mask = u32::MAX >> (8 * (FOUR - left));
            let bytes = u32::from_le_bytes([
                texel(tint, rows, places, (texels, last), 0),
                texel(tint, rows, places, (texels, last), 1),
                texel(tint, rows, places, (texels, last), 2),
                texel(tint, rows, places, (texels, last), 3),
            ]);
            *row = (bytes & mask | u32::from_le_bytes(*row) & !mask).to_le_bytes();
            return;
        }
        let Some((block, behind)) = rest.split_first_chunk_mut::<LANES>() else { return };
        if left < LANES {
            let mask = u64::MAX >> (8 * (LANES - left));
            let bytes: [u8; LANES] = each!(k => texel(tint, rows, places, (texels, last), k));
            *block = (u64::from_le_bytes(bytes) & mask | u64::from_le_bytes(*block) & !mask).to_le_bytes();
            return;
        }
        let mut k = 0;
        while k < LANES {
            block[k] = texel(tint, rows, places, (texels, last), k);
            k += 1;
        }
        (rest, left) = (behind, left - LANES);
    }
}

/// [`show_along`] by the masks of [`depth_test`](super::depth_test), one for each block.
#[cfg(feature = "alloc")]
#[inline(always)]
pub(crate) fn show_masked<S: Lanes8, T: Tint>(
    s: S,
    (row, masks): (&mut [u8], &[u64]),
    texels: Texels<'_>,
    (tint, along): (T, &mut T::Along<S>),
    mut places: impl PlacesAlong<S>,
) {
    // Never true: see `show`.
    if texels.bytes.is_empty() {
        return;
    }
    let image = (texels, texels.bytes.len() - 1);
    let mut rest = row;
    for &stays in masks {
        if rest.len() < LANES {
            // At the frame's end.
            let rows = tint.rows(s, along, &[0; LANES]);
            let places = s.low_words(places.next());
            for (k, (pixel, stay)) in rest.iter_mut().zip(stays.to_le_bytes()).enumerate() {
                if stay == 0 {
                    *pixel = texel(tint, rows, places, image, k % LANES);
                }
            }
            break;
        }
        let Some((block, behind)) = rest.split_first_chunk_mut::<LANES>() else { break };
        rest = behind;
        // How many pixels are nearer is unpredictable: the others are rewritten unchanged. (Each case extracts its own
        // lanes: those of all, extracted before, would not fit into the registers.)
        if stays == 0 && !IS_COMPACT {
            let (rows, places) = (tint.rows(s, along, block), s.low_words(places.next()));
            let mut k = 0;
            while k < LANES {
                block[k] = texel(tint, rows, places, image, k);
                k += 1;
            }
        } else if stays == u64::MAX {
            tint.rows(s, along, block);
            places.skip();
        } else if stays >> 32 == u64::from(u32::MAX) {
            let (rows, places) = (tint.rows(s, along, block), s.low_words(places.next()));
            let Some(four) = block.first_chunk_mut() else { break };
            // The lower half.
            let stay = stays as u32;
            let bytes = u32::from_le_bytes([
                texel(tint, rows, places, image, 0),
                texel(tint, rows, places, image, 1),
                texel(tint, rows, places, image, 2),
                texel(tint, rows, places, image, 3),
            ]);
            *four = (bytes & !stay | u32::from_le_bytes(*four) & stay).to_le_bytes();
        } else {
            let (rows, places) = (tint.rows(s, along, block), s.low_words(places.next()));
            let bytes: [u8; LANES] = each!(k => texel(tint, rows, places, image, k));
            *block = (u64::from_le_bytes(bytes) & !stays | u64::from_le_bytes(*block) & stays).to_le_bytes();
        }
    }
}

/// Texel `k` of eight as it is shown. `last` is the index of the last texel.
#[cfg(feature = "alloc")]
#[inline(always)]
fn texel<T: Tint>(tint: T, rows: T::Rows, places: [u16; LANES], (texels, last): (Texels<'_>, usize), k: usize) -> u8 {
    tint.show(rows, k, texels.bytes[usize::from(places[k]) & last])
}

/// Pixels that are shown at once if no more are left.
#[cfg(feature = "alloc")]
const FOUR: usize = LANES / 2;

/// Indices of texels, eight at a time.
#[cfg(feature = "alloc")]
pub(crate) trait PlacesAlong<S: Lanes8> {
    fn next(&mut self) -> S::I32;
    /// Leaves out the next eight.
    #[inline(always)]
    fn skip(&mut self) {
        self.next();
    }
}

/// The texels of a level, and its number.
pub(crate) type LevelTexels<'a> = (Texels<'a>, u32);

/// Computes indices of texels in vectors.
#[derive(Clone, Copy)]
struct PlaceLanes<S: Lanes8> {
    s: S,
    columns: S::I32,
    rows: S::I32,
    width: S::I32,
    /// Fraction bits of coordinates: 16, and one for each level.
    bits: i32,
}

impl<S: Lanes8> PlaceLanes<S> {
    #[inline(always)]
    fn new(s: S, texels: Texels<'_>) -> Self {
        let columns = (1 << texels.ubits) - 1;
        let rows = ((1 << texels.vbits) - 1) << texels.ubits;
        Self { s, columns: s.splat_i32(columns), rows: s.splat_i32(rows), width: s.splat_i32(columns + 1), bits: 16 }
    }

    /// Indices in a level of an image, of coordinates in level 0.
    #[inline(always)]
    fn of_level(s: S, (texels, level): LevelTexels<'_>) -> Self {
        Self { bits: 16 + level.cast_signed(), ..Self::new(s, texels) }
    }

    /// [`Texels::place`].
    #[inline(always)]
    fn at_coordinates(self, u: S::I32, v: S::I32) -> S::I32 {
        self.at(u, self.s.mul_i32(v, self.width))
    }

    /// The bits of a coordinate inside its texel.
    #[inline(always)]
    fn fraction(self) -> S::I32 {
        self.s.splat_i32((1 << self.bits) - 1)
    }

    /// [`Texels::place`] of u, and of v times the width: the masks clear all bits that this loses.
    #[inline(always)]
    fn at(self, u: S::I32, v: S::I32) -> S::I32 {
        let s = self.s;
        s.or_i32(s.and_i32(s.shr_i32(v, self.bits), self.rows), s.and_i32(s.shr_i32(u, self.bits), self.columns))
    }
}

/// Lines through a texture with the same step, as in [`fill_affine`].
#[cfg(feature = "alloc")]
#[derive(Clone, Copy)]
pub(crate) struct AffineLines<S: Lanes8> {
    places: PlaceLanes<S>,
    /// The logarithm of the width.
    ubits: u32,
    /// From the first pixel to each of eight, ...
    first: [S::I32; 2],
    /// ... and from eight to the next eight.
    next: [S::I32; 2],
}

#[cfg(feature = "alloc")]
impl<S: Lanes8> AffineLines<S> {
    #[inline(always)]
    pub(crate) fn new(s: S, texels: Texels<'_>, [du, dv]: [u32; 2]) -> Self {
        let places = PlaceLanes::new(s, texels);
        let (du, dv) = (du.cast_signed(), (dv << texels.ubits).cast_signed());
        let numbers = s.load_i32(&NUMBERS);
        Self {
            places,
            ubits: texels.ubits,
            first: [s.mul_i32(s.splat_i32(du), numbers), s.mul_i32(s.splat_i32(dv), numbers)],
            next: [s.splat_i32(du.wrapping_mul(LANES as i32)), s.splat_i32(dv.wrapping_mul(LANES as i32))],
        }
    }

    /// Stores the indices of the first `n` texels from (`u`, `v`) on, and of up to seven more, for which there is room.
    #[inline(always)]
    pub(crate) fn places(&self, places: &mut [i32], n: usize, [u, v]: [u32; 2]) {
        let s = self.places.s;
        let mut u = s.add_i32(s.splat_i32(u.cast_signed()), self.first[0]);
        let mut v = s.add_i32(s.splat_i32((v << self.ubits).cast_signed()), self.first[1]);
        for block in places.as_chunks_mut::<LANES>().0.iter_mut().take(n.div_ceil(LANES)) {
            s.store_i32(self.places.at(u, v), block);
            (u, v) = (s.add_i32(u, self.next[0]), s.add_i32(v, self.next[1]));
        }
    }

    /// The indices of the texels from (`u`, `v`) on.
    #[inline(always)]
    pub(crate) fn along(&self, [u, v]: [u32; 2]) -> impl PlacesAlong<S> {
        let s = self.places.s;
        let u = s.add_i32(s.splat_i32(u.cast_signed()), self.first[0]);
        let v = s.add_i32(s.splat_i32((v << self.ubits).cast_signed()), self.first[1]);
        AffineAlong { lines: self, at: [u, v] }
    }
}

/// Position along one of the lines.
#[cfg(feature = "alloc")]
struct AffineAlong<'a, S: Lanes8> {
    lines: &'a AffineLines<S>,
    at: [S::I32; 2],
}

#[cfg(feature = "alloc")]
impl<S: Lanes8> PlacesAlong<S> for AffineAlong<'_, S> {
    #[inline(always)]
    fn next(&mut self) -> S::I32 {
        let (s, [u, v], [du, dv]) = (self.lines.places.s, self.at, self.lines.next);
        self.at = [s.add_i32(u, du), s.add_i32(v, dv)];
        self.lines.places.at(u, v)
    }
}

/// Indices of texels that are stored.
#[cfg(feature = "alloc")]
pub(crate) struct StoredPlaces<'a, S>(pub(crate) S, pub(crate) &'a [i32]);

#[cfg(feature = "alloc")]
impl<S: Lanes8> PlacesAlong<S> for StoredPlaces<'_, S> {
    #[inline(always)]
    fn next(&mut self) -> S::I32 {
        match self.1.split_first_chunk::<LANES>() {
            Some((eight, rest)) => {
                self.1 = rest;
                self.0.load_i32(eight)
            }
            None => self.0.splat_i32(0),
        }
    }
}

/// Fills `row` with texels in exact perspective, with the fastest loop of this build.
///
/// ```text
/// u_k = floor((numerators[0] + k·steps[0]) / (d + k·dd))        v_k the same with numerators[1], steps[1]
/// ```
///
/// in exact arithmetic, modulo 2³²; negative coordinates wrap like others. Along the row every divisor is positive
/// (anything less counts as 1), every quotient within ±2³² and every value within ±2¹²⁶, as the raster ensures.
#[inline(never)]
pub fn fill_perspective(
    row: &mut [u8],
    texels: Texels<'_>,
    numerators: [i128; 2],
    steps: [i128; 2],
    d: i128,
    dd: i128,
) {
    // Starting the estimate costs as much as two pixels.
    if HAS_F64 && row.len() > 2 {
        fill_perspective_estimated(row, texels, numerators, steps, d, dd);
    } else {
        fill_perspective_portable(row, texels, numerators, steps, d, dd);
    }
}

/// The specification of [`fill_perspective`].
pub fn fill_perspective_portable(
    row: &mut [u8],
    texels: Texels<'_>,
    numerators: [i128; 2],
    steps: [i128; 2],
    d: i128,
    dd: i128,
) {
    let [u, v] = [0, 1].map(|i| [numerators[i], steps[i]]);
    each_exact_place(row, texels, [u, v], [d, dd], |pixel, place| *pixel = texels.bytes[place]);
}

/// The indices of texels, as in [`fill_perspective_portable`]. Each number is given by its first value and its change
/// per pixel.
#[cfg(feature = "alloc")]
pub(crate) fn exact_places(places: &mut [i32], texels: Texels<'_>, numerators: [[i128; 2]; 2], divisors: [i128; 2]) {
    // Below 65,536.
    each_exact_place(places, texels, numerators, divisors, |to, place| *to = place as i32);
}

/// Calls `put` for each with the index of its texel.
#[inline(never)]
fn each_exact_place<T>(
    row: &mut [T],
    texels: Texels<'_>,
    [[mut u, du], [mut v, dv]]: [[i128; 2]; 2],
    [mut d, dd]: [i128; 2],
    put: impl Fn(&mut T, usize),
) {
    for to in row {
        let divisor = d.max(1);
        // Modulo 2³²: the mask keeps fewer bits.
        put(to, texels.place(floor_of_wide(u, divisor) as u32, floor_of_wide(v, divisor) as u32));
        // The sum after the last pixel may be anything.
        u = u.wrapping_add(du);
        v = v.wrapping_add(dv);
        d = d.wrapping_add(dd);
    }
}

/// Fills `row` like [`fill_perspective`], with quotients in f64, and exact ones where these cannot decide.
///
/// The bound of [`perspective_places`] holds, with ε = 2⁻⁵³, the error of one rounding:
///
/// 1. Over a piece of the row let N be the largest |n| of a numerator and D the largest divisor. All are linear, so N
///    and D are at the piece's ends, and |k·dn| ≤ 2N.
/// 2. In the numerator n + k·dn in f64, n is rounded (εN), dn is (2εN for k of them), their product is (2εN), and the
///    sum is (εN). So it is off by 6εN, and the divisor by 6εD in the same way.
fn fill_perspective_estimated(
    row: &mut [u8],
    texels: Texels<'_>,
    numerators: [i128; 2],
    steps: [i128; 2],
    d: i128,
    dd: i128,
) {
    let steps_in_f64 = steps.map(|step| step as f64);
    let ([mut u, mut v], mut d) = (numerators, d);
    for piece in row.chunks_mut(PIECE) {
        let [first_u, first_v] = [u, v].map(|first| first as f64);
        let along = [[first_u, steps_in_f64[0]], [first_v, steps_in_f64[1]]];
        let mut places = [0; PIECE];
        if perspective_places(BASELINE, &mut places, piece.len(), texels, along, [d as f64, dd as f64]) {
            show((), piece, texels, &places);
        } else {
            fill_perspective_portable(piece, texels, [u, v], steps, d, dd);
        }
        // At most PIECE.
        let pixels = piece.len() as i128;
        let advanced = |from: i128, step: i128| from.wrapping_add(step.wrapping_mul(pixels));
        (u, v, d) = (advanced(u, steps[0]), advanced(v, steps[1]), advanced(d, dd));
    }
}

/// The most pixels of a piece of a row.
const PIECE: usize = 64;

/// The greatest ratio of a row's largest divisor to the smallest for which an estimate decides.
const MAX_RATIO: f64 = 32_768.0;

/// Stores the indices of the first `n` texels by quotients in f64, at most 64, and of up to seven more, for which there
/// is room. Returns `false` if one of the quotients cannot decide.
///
/// Each numerator and the divisor are given by their first value and their change per pixel.
///
/// Only the integer texel counts. Let q be a quotient, |q| ≤ 2³², and t the integer nearest to its estimate. If |t − q|
/// < 1 and no texel begins at t (t mod 2¹⁶ ≠ 0), then q lies in the same texel as t: all bounds of texels are integers
/// other than t, so at least 1 away. So the estimate may be off by less than ½. It is, if numerators are off by at most
/// 12 parts in 2⁵³ of 2³²·D and divisors by 12 parts of D, D being the row's largest divisor:
///
/// 1. Let R be D over the smallest divisor, ε = 2⁻⁵³.
/// 2. The quotient is off by 2³²·12εR for the numerator, the same for the divisor, and 2ε of itself for the reciprocal
///    and the product: less than 2³²·ε·(24R + 3) altogether.
/// 3. For R ≤ 2¹⁵ that is 0.38. If R is larger, nothing is filled.
#[inline(always)]
pub(crate) fn perspective_places<S: Lanes8>(
    s: S,
    places: &mut [i32],
    n: usize,
    texels: Texels<'_>,
    [[u, du], [v, dv]]: [[f64; 2]; 2],
    [d, dd]: [f64; 2],
) -> bool {
    let sums = PerspectiveSums { numerators: [[u, du], [v, dv]], divisors: [d, dd], base: [0; 2] };
    let quotients = Quotients::new(s, (texels, 0), &sums, n);
    let (mut numbers, mut unsure) = (s.load_i32(&NUMBERS), false);
    for block in places.as_chunks_mut::<LANES>().0.iter_mut().take(n.div_ceil(LANES)) {
        let ([u, v], is_unsure) = quotients.coordinates(numbers);
        s.store_i32(quotients.places.at_coordinates(u, v), block);
        unsure |= is_unsure;
        numbers = s.add_i32(numbers, s.splat_i32(LANES as i32));
    }
    !unsure
}

/// Two numerators and their divisor along a span of a texture that is linear on the face, each given by its first value
/// and its change per pixel.
#[derive(Clone, Copy)]
pub(crate) struct PerspectiveSums<F> {
    pub(crate) numerators: [[F; 2]; 2],
    pub(crate) divisors: [F; 2],
    /// Whole numbers of texels that are added to the quotients.
    pub(crate) base: [i32; 2],
}

impl PerspectiveSums<f64> {
    const NONE: Self = Self { numerators: [[0.0; 2]; 2], divisors: [0.0; 2], base: [0; 2] };
}

/// The indices of the texels from number `range.0` to `range.1` of a span, at most 64, by the quotients of
/// [`perspective_places`], if there are sums to begin with. Where a quotient cannot decide, `exact` stores the indices of
/// eight texels, from the one with this number on.
#[cfg(feature = "alloc")]
#[inline(always)]
pub(crate) fn perspective_along<S: Lanes8>(
    s: S,
    texels: LevelTexels<'_>,
    sums: Option<PerspectiveSums<f64>>,
    range: (usize, usize),
    exact: impl FnMut(usize, &mut [i32; LANES]),
) -> impl PlacesAlong<S> {
    let has_sums = sums.is_some();
    let sums = sums.unwrap_or(PerspectiveSums::NONE);
    let mut quotients = Quotients::new(s, texels, &sums, range.1);
    quotients.are_sure &= has_sums;
    // At most 64.
    let numbers = s.add_i32(s.splat_i32(range.0 as i32), s.load_i32(&NUMBERS));
    PerspectiveAlong { places: quotients.places, quotients, numbers, first: range.0, exact }
}

/// [`perspective_along`] by quotients in f32, where [`fits_singles`] allows them.
#[cfg(feature = "alloc")]
#[inline(always)]
pub(crate) fn singles_along<S: F32Lanes8>(
    s: S,
    texels: LevelTexels<'_>,
    sums: PerspectiveSums<f32>,
    first: usize,
    exact: impl FnMut(usize, &mut [i32; LANES]),
) -> impl PlacesAlong<S> {
    const NUMBERS: [f32; LANES] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
    let quotients = Singles::new(PlaceLanes::of_level(s, texels), &sums);
    // At most 64.
    let numbers = s.add_f32(s.splat_f32(first as f32), s.load_f32(&NUMBERS));
    PerspectiveAlong { places: quotients.places, quotients, numbers, first, exact }
}

/// Position along a span of [`perspective_along`].
#[cfg(feature = "alloc")]
struct PerspectiveAlong<S: Lanes8, Q: QuotientsAlong<S>, E> {
    places: PlaceLanes<S>,
    quotients: Q,
    /// The numbers of the next eight texels, ...
    numbers: Q::Numbers,
    /// ... and of the first of them.
    first: usize,
    exact: E,
}

#[cfg(feature = "alloc")]
impl<S: Lanes8, Q: QuotientsAlong<S>, E: FnMut(usize, &mut [i32; LANES])> PlacesAlong<S> for PerspectiveAlong<S, Q, E> {
    #[inline(always)]
    fn next(&mut self) -> S::I32 {
        let (s, numbers, first) = (self.places.s, self.numbers, self.first);
        self.skip();
        // Without f64 no quotient decides, and each would take a chip thousands of instructions.
        if HAS_F64 {
            let ([u, v], is_unsure) = self.quotients.at(s, numbers);
            if !is_unsure {
                return self.places.at_coordinates(u, v);
            }
        }
        let mut eight = [0; LANES];
        (self.exact)(first, &mut eight);
        s.load_i32(&eight)
    }

    #[inline(always)]
    fn skip(&mut self) {
        self.first += LANES;
        self.numbers = self.quotients.next(self.places.s, self.numbers);
    }
}

/// Quotients along a span, eight at a time.
#[cfg(feature = "alloc")]
trait QuotientsAlong<S: Lanes8> {
    /// Numbers of eight texels.
    type Numbers: Copy;
    /// The coordinates of texels with these numbers, and whether one of them cannot decide which texel it lies in.
    fn at(&self, s: S, numbers: Self::Numbers) -> ([S::I32; 2], bool);
    /// The numbers of the next eight.
    fn next(&self, s: S, numbers: Self::Numbers) -> Self::Numbers;
}

/// The quotients of [`perspective_places`], of any level: its texels begin at fewer of the integers.
struct Quotients<S: Lanes8> {
    places: PlaceLanes<S>,
    sums: PerspectiveSums<f64>,
    /// The number of the pixel behind the last.
    end: S::I32,
    /// False if no quotient can decide, since divisors differ too much.
    are_sure: bool,
}

impl<S: Lanes8> Quotients<S> {
    /// The quotients of the first `end` pixels of a row, at most [`PIECE`].
    #[inline(always)]
    fn new(s: S, texels: LevelTexels<'_>, sums: &PerspectiveSums<f64>, end: usize) -> Self {
        let mut are_sure = HAS_F64;
        if HAS_F64 {
            let [d, dd] = sums.divisors;
            // At most PIECE.
            let last = d + (end as i32 - 1) as f64 * dd;
            let (least, greatest) = if d < last { (d, last) } else { (last, d) };
            // False for NaN too.
            are_sure = least * MAX_RATIO >= greatest;
        }
        Self { places: PlaceLanes::of_level(s, texels), sums: *sums, end: s.splat_i32(end as i32), are_sure }
    }

    /// The coordinates at pixels with these numbers, and whether one of them cannot decide.
    #[inline(always)]
    fn coordinates(&self, numbers: S::I32) -> ([S::I32; 2], bool) {
        let PerspectiveSums { numerators: [[u, du], [v, dv]], divisors: [d, dd], base, .. } = self.sums;
        let s = self.places.s;
        let (magic, fraction, zero) = (s.splat_f64(ROUND_MAGIC), self.places.fraction(), s.splat_i32(0));
        let k = s.to_f64(numbers);
        let reciprocal = s.div(s.splat_f64(1.0), s.mul_add(k, s.splat_f64(dd), s.splat_f64(d)));
        // Modulo 2³². Lanes beyond the last may hold anything.
        let u = s.low_bits(s.mul_add(s.mul_add(k, s.splat_f64(du), s.splat_f64(u)), reciprocal, magic));
        let v = s.low_bits(s.mul_add(s.mul_add(k, s.splat_f64(dv), s.splat_f64(v)), reciprocal, magic));
        let at = [s.add_i32(u, s.splat_i32(base[0])), s.add_i32(v, s.splat_i32(base[1]))];
        let least = s.min_i32(s.and_i32(at[0], fraction), s.and_i32(at[1], fraction));
        let is_there = s.is_greater(self.end, numbers);
        let unsure = s.to_bitmask(s.and(is_there, s.is_equal(least, zero)));
        (at, unsure != 0 || !self.are_sure)
    }
}

#[cfg(feature = "alloc")]
impl<S: Lanes8> QuotientsAlong<S> for Quotients<S> {
    type Numbers = S::I32;

    #[inline(always)]
    fn at(&self, _: S, numbers: S::I32) -> ([S::I32; 2], bool) {
        self.coordinates(numbers)
    }

    #[inline(always)]
    fn next(&self, s: S, numbers: S::I32) -> S::I32 {
        s.add_i32(numbers, s.splat_i32(LANES as i32))
    }
}

/// How far a quotient in f32 may be off, in 1/65,536 of a texel.
const SINGLES_MARGIN: i32 = 16;

/// Returns which triangles allow quotients in f32: given, in 1/65,536 of a texel, the greatest difference between their
/// coordinates, the first of which lies in the texel at the base; and the least and the greatest depth.
///
/// With f32 k·dn + n and k·dd + d are summed, divided, and rounded to an integer t. Let ε = 2⁻²⁴, the error of one
/// rounding, Q the greatest quotient from the base on, D the row's largest divisor, R the ratio of D to the smallest:
///
/// 1. No weight of a corner is negative at a covered centre, so R is at most the ratio of the depths, and a numerator at
///    most Q·D.
/// 2. In the divisor d is rounded (εD), dd is (|k·dd| ≤ D: εD), their product is (εD), and the sum is (εD): 4εD. In the
///    numerator |k·dn| ≤ 2Q·D, so the same steps make 6εQD.
/// 3. So the ratio is off by εQ·(6 + 4)R, another 2εQ for the reciprocal and the product, and t by ½. The sums in f64
///    are off by less than 2⁻²⁰ of this, and what is neglected here is less than εQ·(R + 1), since R < 400.
///
/// Where Q·(11R + 3) ≤ 15·2²⁴ that is less than 16, the margin. Then a coordinate lies in the same texel, of any level, as
/// t + 16 if the fraction of t + 16 is at least 32.
#[inline(always)]
pub(crate) fn fits_singles<S: Lanes8>(s: S, range: S::F64, [least, greatest]: [S::F64; 2]) -> S::Mask {
    let texel = s.splat_f64(65_536.0);
    let weighted = s.mul_add(greatest, s.splat_f64(11.0), s.mul(least, s.splat_f64(3.0)));
    s.is_less(s.mul(s.add(range, texel), weighted), s.mul(least, s.splat_f64(15.0 * 16_777_216.0)))
}

/// Quotients in f32, where [`fits_singles`] allows them.
#[cfg(feature = "alloc")]
struct Singles<S: F32Lanes8> {
    places: PlaceLanes<S>,
    numerators: [[S::F32; 2]; 2],
    divisors: [S::F32; 2],
    /// The base and the margin.
    more: [S::I32; 2],
}

#[cfg(feature = "alloc")]
impl<S: F32Lanes8> Singles<S> {
    #[inline(always)]
    fn new(places: PlaceLanes<S>, sums: &PerspectiveSums<f32>) -> Self {
        let s = places.s;
        let ([[u, du], [v, dv]], [d, dd]) = (sums.numerators, sums.divisors);
        let margin = s.splat_i32(SINGLES_MARGIN);
        Self {
            places,
            numerators: [[s.splat_f32(u), s.splat_f32(du)], [s.splat_f32(v), s.splat_f32(dv)]],
            divisors: [s.splat_f32(d), s.splat_f32(dd)],
            more: [s.add_i32(s.splat_i32(sums.base[0]), margin), s.add_i32(s.splat_i32(sums.base[1]), margin)],
        }
    }
}

#[cfg(feature = "alloc")]
impl<S: F32Lanes8> QuotientsAlong<S> for Singles<S> {
    type Numbers = S::F32;

    /// Pixels beyond the last may be what cannot decide.
    #[inline(always)]
    fn at(&self, s: S, k: S::F32) -> ([S::I32; 2], bool) {
        let ([[u, du], [v, dv]], [d, dd]) = (self.numerators, self.divisors);
        let reciprocal = s.div_f32(s.splat_f32(1.0), s.mul_add_f32(k, dd, d));
        let u = s.nearest_f32(s.mul_f32(s.mul_add_f32(k, du, u), reciprocal));
        let v = s.nearest_f32(s.mul_f32(s.mul_add_f32(k, dv, v), reciprocal));
        let (u, v) = (s.add_i32(u, self.more[0]), s.add_i32(v, self.more[1]));
        let fraction = self.places.fraction();
        let least = s.min_i32(s.and_i32(u, fraction), s.and_i32(v, fraction));
        ([u, v], s.to_bitmask(s.is_greater(s.splat_i32(2 * SINGLES_MARGIN), least)) != 0)
    }

    #[inline(always)]
    fn next(&self, s: S, k: S::F32) -> S::F32 {
        s.add_f32(k, s.splat_f32(LANES as f32))
    }
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::simd::Portable;

    /// How far the quotients in f32 are off at pixel `k` of a row, in 1/65,536 of a texel.
    fn off<S: F32Lanes8>(s: S, sums: &PerspectiveSums<f32>, k: usize, exact: [f64; 2]) -> f64 {
        let texels = Texels::new(&[0], 0, 0).expect("a texel");
        let quotients = Singles::new(PlaceLanes::new(s, texels), sums);
        let ([u, v], is_unsure) = quotients.at(s, s.splat_f32(k as f32));
        let (mut lanes, mut most) = ([0; LANES], 0.0_f64);
        let mut is_near = false;
        for (found, exact) in [u, v].into_iter().zip(exact) {
            s.store_i32(found, &mut lanes);
            let found = lanes[3] - SINGLES_MARGIN;
            most = most.max((f64::from(found) - exact).abs());
            is_near |= (lanes[3] & 0xFFFF) < 2 * SINGLES_MARGIN;
            // What decides, decides for the right texel.
            assert!(is_near || (exact / 65_536.0).floor() as i32 == lanes[3] >> 16, "{exact} {found}");
        }
        assert_eq!(is_unsure, is_near);
        most
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200_000))]
        /// Quotients in f32 are off by less than their margin, on every level, up to the greatest differences of
        /// coordinates and depths for which they are taken.
        #[test]
        fn singles_keep_their_margin(
            (bits, ratio, scale) in (0_u32..10, 0.0..1.0_f64, 0.0..75.0_f64),
            ends in prop::array::uniform2(prop::array::uniform2(prop_oneof![Just(0.0), Just(1.0), 0.0..=1.0_f64])),
            (size, sign, swapped) in (0.9..1.1_f64, any::<[bool; 2]>(), any::<bool>()),
            (last, at) in (1_usize..64, 0.0..=1.0_f64),
        ) {
            // The ratio of the depths, and coordinates about as great as it allows.
            let ratio = 1.0 + f64::from(1_u32 << bits) * ratio;
            let range = size * 15.0 * 16_777_216.0 / (11.0 * ratio + 3.0) - 65_536.0;
            let allowed = fits_singles(Portable, [range; LANES], [[1.0; LANES], [ratio; LANES]]);
            if range < 0.0 || Portable.to_bitmask(allowed) == 0 {
                return Ok(());
            }
            let divisors = if swapped { [ratio, 1.0] } else { [1.0, ratio] }.map(|d| d * scale.exp2());
            let signed = |i: usize, q: f64| if sign[i] { -q } else { q };
            let q = [0, 1].map(|i| ends[i].map(|end| signed(i, (range + 65_535.0) * end)));
            // From the first pixel to the last.
            let line = |[first, end]: [f64; 2]| [first, (end - first) / last as f64];
            let numerators = q.map(|[a, b]| line([a * divisors[0], b * divisors[1]]));
            let divisors = line(divisors);
            let k = (at * last as f64).round() as usize;
            let value = |[first, step]: [f64; 2]| first + k as f64 * step;
            let exact = numerators.map(|line| value(line) / value(divisors));
            let sums = PerspectiveSums {
                numerators: numerators.map(|line| line.map(|x| x as f32)),
                divisors: divisors.map(|x| x as f32),
                base: [0; 2],
            };
            let mut most = off(Portable, &sums, k, exact).max(off(BASELINE, &sums, k, exact));
            #[cfg(simd_x86_64)]
            for off in [
                crate::simd::Avx2::find().map(|s| off(s, &sums, k, exact)),
                crate::simd::Avx512::find().map(|s| off(s, &sums, k, exact)),
            ] {
                most = most.max(off.unwrap_or(0.0));
            }
            prop_assert!(most < f64::from(SINGLES_MARGIN), "{most}");
        }
    }
}
