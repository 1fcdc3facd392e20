//! How a texel is shown: as it is, lit, fogged or blended.

use crate::lanes::{LANES, NUMBERS, each};
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
    type Rows<S: Lanes8>: Copy;
    fn begin<S: Lanes8>(self, s: S, of: impl Ramps<S>) -> Self::Along<S>;
    /// The table rows of the next eight pixels; advances the state.
    fn rows<S: Lanes8>(self, s: S, along: &mut Self::Along<S>) -> Self::Rows<S>;
    /// The bytes for eight texels, in pixels whose current bytes are these.
    fn show<S: Lanes8>(self, s: S, rows: Self::Rows<S>, texels: [u8; LANES], pixels: &[u8; LANES]) -> [u8; LANES];
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

/// Eight values; advances to the next eight.
#[inline(always)]
fn next<S: Lanes8>(s: S, [values, next]: &mut Ramp8<S>) -> S::I32 {
    let eight = *values;
    *values = s.add_i32(eight, *next);
    eight
}

/// Texels as they are.
impl Tint for () {
    type Along<S: Lanes8> = ();
    type Rows<S: Lanes8> = ();
    #[inline(always)]
    fn begin<S: Lanes8>(self, _: S, _: impl Ramps<S>) {}
    #[inline(always)]
    fn rows<S: Lanes8>(self, _: S, (): &mut ()) {}
    #[inline(always)]
    fn show<S: Lanes8>(self, _: S, (): (), texels: [u8; LANES], _: &[u8; LANES]) -> [u8; LANES] {
        texels
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
    type Rows<S: Lanes8> = S::I32;
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
    fn rows<S: Lanes8>(self, s: S, along: &mut Ramp8<S>) -> S::I32 {
        next(s, along)
    }
    #[inline(always)]
    fn show<S: Lanes8>(self, s: S, rows: S::I32, texels: [u8; LANES], _: &[u8; LANES]) -> [u8; LANES] {
        s.look_up(self.table, rows, texels)
    }
}

/// The shades of the span, fogged by a table with a row for each level of fog; texels are ignored.
#[derive(Clone, Copy)]
pub(crate) struct FoggedShades<'a>(pub(crate) &'a [u8; 65_536]);

impl Tint for FoggedShades<'_> {
    const HAS_FOG: bool = true;
    type Along<S: Lanes8> = [Ramp8<S>; 2];
    /// Indices of the table.
    type Rows<S: Lanes8> = S::I32;
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
    fn rows<S: Lanes8>(self, s: S, [fog, shades]: &mut [Ramp8<S>; 2]) -> S::I32 {
        let low = s.and_i32(s.shr_i32(next(s, shades), 8), s.splat_i32(0xFF));
        s.or_i32(s.and_i32(next(s, fog), s.splat_i32(0xFF00)), low)
    }
    #[inline(always)]
    fn show<S: Lanes8>(self, s: S, indices: S::I32, _: [u8; LANES], _: &[u8; LANES]) -> [u8; LANES] {
        s.bytes_at(self.0, indices)
    }
}

/// Blends the bytes of another tint with those of the pixels, by a table with a row for each byte of the tint.
#[derive(Clone, Copy)]
pub(crate) struct Blended<'a, T>(pub(crate) T, pub(crate) &'a [u8; 65_536]);

impl<T: Tint> Tint for Blended<'_, T> {
    const HAS_FOG: bool = T::HAS_FOG;
    const READS_PIXELS: bool = true;
    type Along<S: Lanes8> = T::Along<S>;
    type Rows<S: Lanes8> = T::Rows<S>;
    #[inline(always)]
    fn begin<S: Lanes8>(self, s: S, of: impl Ramps<S>) -> T::Along<S> {
        self.0.begin(s, of)
    }
    #[inline(always)]
    fn rows<S: Lanes8>(self, s: S, along: &mut T::Along<S>) -> T::Rows<S> {
        self.0.rows(s, along)
    }
    #[inline(always)]
    fn show<S: Lanes8>(self, s: S, rows: T::Rows<S>, texels: [u8; LANES], pixels: &[u8; LANES]) -> [u8; LANES] {
        let own = self.0.show(s, rows, texels, pixels);
        each!(k => self.1[usize::from(own[k]) << 8 | usize::from(pixels[k])])
    }
}

/// Fogs the bytes of another tint, by a table with a row for each level of fog.
#[derive(Clone, Copy)]
pub(crate) struct Fogged<'a, T>(pub(crate) T, pub(crate) &'a [u8; 65_536]);

impl<T: Tint> Tint for Fogged<'_, T> {
    const HAS_FOG: bool = true;
    type Along<S: Lanes8> = (T::Along<S>, Ramp8<S>);
    type Rows<S: Lanes8> = (T::Rows<S>, S::I32);
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
    fn rows<S: Lanes8>(self, s: S, (along, fog): &mut Self::Along<S>) -> Self::Rows<S> {
        (self.0.rows(s, along), next(s, fog))
    }
    #[inline(always)]
    fn show<S: Lanes8>(
        self,
        s: S,
        (rows, levels): Self::Rows<S>,
        texels: [u8; LANES],
        pixels: &[u8; LANES],
    ) -> [u8; LANES] {
        s.look_up(self.1, levels, self.0.show(s, rows, texels, pixels))
    }
}
