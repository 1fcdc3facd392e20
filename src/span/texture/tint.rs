//! How a texel is shown: as it is, lit, fogged or blended.

use crate::lanes::{LANES, NUMBERS};
use crate::simd::Lanes8;

/// Values of a span that are linear along it: the first, with the step in the upper half.
#[derive(Clone, Copy)]
pub(crate) struct SpanValues {
    /// The shade, with the step in the upper half.
    pub(crate) shade: u32,
    /// The density of fog, if there is any.
    pub(crate) fog: u32,
    /// The number of pixels skipped at the beginning.
    pub(crate) skipped: u32,
}

/// Turns the texels of a span into the bytes that are shown: as they are, lit, fogged or blended.
pub(crate) trait Tint: Copy {
    /// True if the density of fog is read.
    const HAS_FOG: bool = false;
    /// True if the current bytes of pixels are read.
    const READS_PIXELS: bool = false;
    /// The state that changes along a span.
    type Along<S: Lanes8>: Copy;
    /// Table rows of eight pixels.
    type Rows: Copy;
    fn begin<S: Lanes8>(self, s: S, of: impl Ramps<S>) -> Self::Along<S>;
    /// The table rows of the next eight pixels, whose current bytes are `pixels`; advances the
    /// state.
    fn rows<S: Lanes8, const IN_BULK: bool>(self, s: S, along: &mut Self::Along<S>, pixels: &[u8; LANES])
    -> Self::Rows;
    /// The byte for a texel of pixel `k` of eight.
    fn show(self, rows: Self::Rows, k: usize, texel: u8) -> u8;
}

/// A linear value of eight pixels in 8.8, and the step to the next eight.
pub(crate) type Ramp8<S> = [<S as Lanes8>::I32; 2];

/// The pixels of one span or two whose values are computed eight at a time.
pub(crate) trait Ramps<S: Lanes8>: Copy {
    /// One of their values: `of` returns its start, with the step in the upper half.
    fn ramp(self, s: S, of: impl Fn(SpanValues) -> u32) -> Ramp8<S>;
}

/// Pixels of a span, after those that are skipped.
impl<S: Lanes8> Ramps<S> for SpanValues {
    #[inline(always)]
    fn ramp(self, s: S, of: impl Fn(SpanValues) -> u32) -> Ramp8<S> {
        // The sums are modulo 2¹⁶; the bits above are not read.
        let values = s.splat_i32(of(self).cast_signed());
        let steps = s.shr_i32(values, 16);
        // At most 63.
        let numbers = s.add_i32(s.load_i32(&NUMBERS), s.splat_i32(self.skipped.cast_signed()));
        [s.add_i32(values, s.mul_i32(steps, numbers)), s.shl_i32(steps, 3)]
    }
}

/// The numbers of the first four pixels of two spans.
pub(super) const NUMBERS_OF_PAIR: [i32; LANES] = [0, 1, 2, 3, 0, 1, 2, 3];

/// The first four pixels of each of two spans. No pixels follow these.
#[derive(Clone, Copy)]
pub(crate) struct PairValues(pub(crate) [SpanValues; 2]);

impl<S: Lanes8> Ramps<S> for PairValues {
    #[inline(always)]
    fn ramp(self, s: S, of: impl Fn(SpanValues) -> u32) -> Ramp8<S> {
        let Self([a, b]) = self;
        let values = s.halves_i32([of(a).cast_signed(), of(b).cast_signed()]);
        [s.add_i32(values, s.mul_i32(s.shr_i32(values, 16), s.load_i32(&NUMBERS_OF_PAIR))), s.splat_i32(0)]
    }
}

/// The lower half of each lane, in the way that suits a full block of a long row if `IN_BULK`, otherwise a short one.
#[inline(always)]
pub(super) fn words<S: Lanes8, const IN_BULK: bool>(s: S, from: S::I32) -> [u16; LANES] {
    if const { IN_BULK } { s.low_words_in_bulk(from) } else { s.low_words(from) }
}

/// The integer parts of eight values, in the upper bytes: rows of a table. Advances to the next eight.
#[inline(always)]
fn rows_of<S: Lanes8, const IN_BULK: bool>(s: S, [values, next]: &mut Ramp8<S>) -> [u16; LANES] {
    let rows = words::<S, IN_BULK>(s, s.and_i32(*values, s.splat_i32(0xFF00)));
    *values = s.add_i32(*values, *next);
    rows
}

/// Texels as they are.
impl Tint for () {
    type Along<S: Lanes8> = ();
    type Rows = ();
    #[inline(always)]
    fn begin<S: Lanes8>(self, _: S, _: impl Ramps<S>) {}
    #[inline(always)]
    fn rows<S: Lanes8, const IN_BULK: bool>(self, _: S, (): &mut (), _: &[u8; LANES]) {}
    #[inline(always)]
    fn show(self, (): (), _: usize, texel: u8) -> u8 {
        texel
    }
}

/// Texels lit by a table, with the shades of the span or with one shade.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Painted<'a> {
    pub(crate) table: &'a [u8; 65_536],
    /// The shade of all spans, if they share one.
    pub(crate) flat: Option<u8>,
}

impl Tint for Painted<'_> {
    type Along<S: Lanes8> = Ramp8<S>;
    type Rows = [u16; LANES];
    #[inline(always)]
    fn begin<S: Lanes8>(self, s: S, of: impl Ramps<S>) -> Ramp8<S> {
        let flat = self.flat;
        of.ramp(
            s,
            #[inline(always)]
            |values| if let Some(shade) = flat { u32::from(shade) << 8 } else { values.shade },
        )
    }
    #[inline(always)]
    fn rows<S: Lanes8, const IN_BULK: bool>(self, s: S, along: &mut Ramp8<S>, _: &[u8; LANES]) -> [u16; LANES] {
        rows_of::<S, IN_BULK>(s, along)
    }
    #[inline(always)]
    fn show(self, rows: [u16; LANES], k: usize, texel: u8) -> u8 {
        self.table[usize::from(rows[k] | u16::from(texel))]
    }
}

/// The shades of the span, fogged by a table with a row for each level of fog; texels are ignored.
#[derive(Clone, Copy)]
pub(crate) struct FoggedShades<'a>(pub(crate) &'a [u8; 65_536]);

impl Tint for FoggedShades<'_> {
    const HAS_FOG: bool = true;
    type Along<S: Lanes8> = [Ramp8<S>; 2];
    /// Indices of the table.
    type Rows = [u16; LANES];
    #[inline(always)]
    fn begin<S: Lanes8>(self, s: S, of: impl Ramps<S>) -> [Ramp8<S>; 2] {
        [
            of.ramp(
                s,
                #[inline(always)]
                |values| values.fog,
            ),
            of.ramp(
                s,
                #[inline(always)]
                |values| values.shade,
            ),
        ]
    }
    #[inline(always)]
    fn rows<S: Lanes8, const IN_BULK: bool>(
        self,
        s: S,
        [[fog, next_fog], [shades, next_shades]]: &mut [Ramp8<S>; 2],
        _: &[u8; LANES],
    ) -> [u16; LANES] {
        let low = s.and_i32(s.shr_i32(*shades, 8), s.splat_i32(0xFF));
        let indices = s.or_i32(s.and_i32(*fog, s.splat_i32(0xFF00)), low);
        (*fog, *shades) = (s.add_i32(*fog, *next_fog), s.add_i32(*shades, *next_shades));
        words::<S, IN_BULK>(s, indices)
    }
    #[inline(always)]
    fn show(self, indices: [u16; LANES], k: usize, _: u8) -> u8 {
        self.0[usize::from(indices[k])]
    }
}

/// Blends the bytes of another tint with those of the pixels, by a table with a row for each byte of the tint.
#[derive(Clone, Copy)]
pub(crate) struct Blended<'a, T>(pub(crate) T, pub(crate) &'a [u8; 65_536]);

impl<T: Tint> Tint for Blended<'_, T> {
    const HAS_FOG: bool = T::HAS_FOG;
    const READS_PIXELS: bool = true;
    type Along<S: Lanes8> = T::Along<S>;
    type Rows = (T::Rows, [u8; LANES]);
    #[inline(always)]
    fn begin<S: Lanes8>(self, s: S, of: impl Ramps<S>) -> T::Along<S> {
        self.0.begin(s, of)
    }
    #[inline(always)]
    fn rows<S: Lanes8, const IN_BULK: bool>(self, s: S, along: &mut T::Along<S>, pixels: &[u8; LANES]) -> Self::Rows {
        (self.0.rows::<S, IN_BULK>(s, along, pixels), *pixels)
    }
    #[inline(always)]
    fn show(self, (rows, pixels): Self::Rows, k: usize, texel: u8) -> u8 {
        self.1[usize::from(self.0.show(rows, k, texel)) << 8 | usize::from(pixels[k])]
    }
}

/// Fogs the bytes of another tint, by a table with a row for each level of fog.
#[derive(Clone, Copy)]
pub(crate) struct Fogged<'a, T>(pub(crate) T, pub(crate) &'a [u8; 65_536]);

impl<T: Tint> Tint for Fogged<'_, T> {
    const HAS_FOG: bool = true;
    type Along<S: Lanes8> = (T::Along<S>, Ramp8<S>);
    type Rows = (T::Rows, [u16; LANES]);
    #[inline(always)]
    fn begin<S: Lanes8>(self, s: S, of: impl Ramps<S>) -> Self::Along<S> {
        let fog = of.ramp(
            s,
            #[inline(always)]
            |values| values.fog,
        );
        (self.0.begin(s, of), fog)
    }
    #[inline(always)]
    fn rows<S: Lanes8, const IN_BULK: bool>(
        self,
        s: S,
        (along, fog): &mut Self::Along<S>,
        pixels: &[u8; LANES],
    ) -> Self::Rows {
        (self.0.rows::<S, IN_BULK>(s, along, pixels), rows_of::<S, IN_BULK>(s, fog))
    }
    #[inline(always)]
    fn show(self, (rows, levels): Self::Rows, k: usize, texel: u8) -> u8 {
        self.1[usize::from(levels[k] | u16::from(self.0.show(rows, k, texel)))]
    }
}
