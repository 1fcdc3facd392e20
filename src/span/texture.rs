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
//! | [`fill_affine`] | change by the same from each pixel to the next |
//! | [`fill_perspective`] | the floor of a quotient at every pixel: exact |

use core::fmt;

use super::Kernel;
use crate::fixed::{HAS_F64, nearest_whole};
use crate::simd::at_best_level;

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

    /// A texture 2^`ubits` wide and 2^`vbits` high, row-major.
    ///
    /// # Errors
    /// [`TexelsError`] if it is wider or higher than 256, or if `bytes` has another length.
    ///
    /// ```
    /// use mode13h::span::texture::{Texels, TexelsError};
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

    /// Place of the texel, below the length. The compiler sees that from the last mask, for bytes that it knows not
    /// to be empty, and leaves out the check (if all is in usize; for a u32 it did not).
    #[inline]
    fn place(self, u: u32, v: u32) -> usize {
        let last = self.bytes.len() - 1;
        let columns = (1 << self.ubits) - 1;
        // What a narrow usize cuts off the masks cut off anyway.
        let column = (u >> 16) as usize & columns;
        // Shifted once instead of down and up.
        let row = (v >> (16 - self.ubits)) as usize & (last & !columns);
        (row | column) & last
    }
}

/// The smaller copies of a texture: the levels of a mipmap from 1 on. Each has half the columns and half the rows of the
/// level before it, or one where that has one; the last is a single texel. Level 0 is the texture itself.
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
    /// [`TexelsError`] if the texture is wider or higher than 256, or if `bytes` has another length than
    /// [`length`](Self::length).
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

    /// The number of the last level: 0 of a texture of one texel, at most 8.
    #[must_use]
    pub const fn deepest(ubits: u32, vbits: u32) -> u32 {
        if ubits > vbits { ubits } else { vbits }
    }

    /// The texels of all levels from 1 on: a third of a square texture's, rounded down.
    #[must_use]
    pub const fn length(ubits: u32, vbits: u32) -> usize {
        let (mut length, mut level) = (0, 1);
        while level <= Self::deepest(ubits, vbits) {
            length += 1 << (ubits.saturating_sub(level) + vbits.saturating_sub(level));
            level += 1;
        }
        length
    }

    /// The number of the last level.
    #[must_use]
    pub const fn last(self) -> u32 {
        Self::deepest(self.ubits, self.vbits)
    }

    /// The texels of a level from 1 to the last. A higher number gives those of the last, level 0 `None`.
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

/// Bytes are not a texture.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
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

impl core::error::Error for TexelsError {}

/// Fills `row` with the texels along a straight line through the texture.
///
/// `u` and `v` are those of the first pixel, `du` and `dv` what each pixel adds; the sums wrap, so a
/// negative number is given in two's complement (`as u32`).
///
/// Tried and given up, at 64 pixels, where this takes 45 ns: all places of 64 pixels first, in vectors, and
/// then the look-ups, 40, but 8 instead of 4 at one pixel; `pext` (BMI2), 37, and said to be slow on the first
/// two generations of Zen; eight gathered loads a turn (AVX2), 26, and processors patched against gather data
/// sampling are said to be much slower at it.
pub fn fill_affine(row: &mut [u8], texels: Texels<'_>, u: u32, v: u32, du: u32, dv: u32) {
    show_affine((), row, texels, [u, v], [du, dv]);
}

/// What becomes of a texel.
pub(crate) trait Shown: Copy {
    fn show(self, pixel: &mut u8, texel: u8);
}

/// It is shown.
impl Shown for () {
    #[inline(always)]
    fn show(self, pixel: &mut u8, texel: u8) {
        *pixel = texel;
    }
}

/// The byte for one shade and the texel is shown.
impl Shown for &[u8; 256] {
    #[inline(always)]
    fn show(self, pixel: &mut u8, texel: u8) {
        *pixel = self[usize::from(texel)];
    }
}

/// The byte for a shade, which the pixel holds, and the texel is shown, as by [`lookup`](super::lookup). In one loop that
/// takes 0.7 to 0.8 of the time of two.
impl Shown for &[u8; 65_536] {
    #[inline(always)]
    fn show(self, pixel: &mut u8, texel: u8) {
        *pixel = self[usize::from(*pixel) << 8 | usize::from(texel)];
    }
}

/// [`fill_affine`], with what becomes of a texel.
#[inline(always)]
pub(crate) fn show_affine(
    shown: impl Shown,
    row: &mut [u8],
    texels: Texels<'_>,
    [mut u, mut v]: [u32; 2],
    [du, mut dv]: [u32; 2],
) {
    // Never so: it tells the compiler that there is a last texel, and `at` needs no check.
    if texels.bytes.is_empty() {
        return;
    }
    // v times the width, so that both are shifted by the same: what is lost of it no mask has.
    (v, dv) = (v << texels.ubits, dv << texels.ubits);
    let last = texels.bytes.len() - 1;
    let columns = texels.width() - 1;
    let rows = last & !columns;
    for pixel in row {
        let place = ((v >> 16) as usize & rows) | ((u >> 16) as usize & columns);
        // The compiler sees from `last` that there is such a byte, and leaves out the check.
        shown.show(pixel, texels.bytes[place & last]);
        u = u.wrapping_add(du);
        v = v.wrapping_add(dv);
    }
}

/// Fills `row` with texels in exact perspective, with the fastest loop of this build.
///
/// ```text
/// u_k = floor((numerators[0] + k·steps[0]) / (d + k·dd))        v_k the same of numerators[1], steps[1]
/// ```
///
/// in exact arithmetic, modulo 2³²; negative coordinates wrap as others do. Along the row every divisor is
/// positive (what is less counts as 1), every quotient within ±2³² and every value within ±2¹²⁶: the raster
/// sees to it.
#[inline(never)]
pub fn fill_perspective(
    row: &mut [u8],
    texels: Texels<'_>,
    numerators: [i128; 2],
    steps: [i128; 2],
    d: i128,
    dd: i128,
) {
    // To begin with the estimate costs as much as two pixels.
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
    show_perspective_portable((), row, texels, [[numerators[0], steps[0]], [numerators[1], steps[1]]], [d, dd]);
}

/// [`fill_perspective_portable`], with what becomes of a texel. Of each number the first value is given, and what each
/// pixel adds.
#[inline(never)]
pub(crate) fn show_perspective_portable(
    shown: impl Shown,
    row: &mut [u8],
    texels: Texels<'_>,
    [[mut u, du], [mut v, dv]]: [[i128; 2]; 2],
    [mut d, dd]: [i128; 2],
) {
    for pixel in row {
        let divisor = d.max(1);
        // Modulo 2³²: the mask leaves less of it.
        shown.show(pixel, texels.at(u.div_euclid(divisor) as u32, v.div_euclid(divisor) as u32));
        // What is added after the last pixel may be anything.
        u = u.wrapping_add(du);
        v = v.wrapping_add(dv);
        d = d.wrapping_add(dd);
    }
}

/// Fills `row` like [`fill_perspective`], by quotients in f64, exact where they cannot decide.
///
/// The bound of [`show_estimated`] holds: with ε = 2⁻⁵³, the error of one rounding,
///
/// 1. over a piece of the row let N be the largest |n| of a numerator and D the largest divisor. All are linear, so N and
///    D are found at the piece's ends, and |k·dn| ≤ 2N.
/// 2. The numerator n + k·dn in f64: n is rounded (εN), dn is (2εN for k of them), their product is (2εN), the
///    sum is (εN). So it is off by 6εN, and the divisor likewise by 6εD.
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
        if !show_estimated((), Kernel::PORTABLE, piece, texels, along, [d as f64, dd as f64]) {
            fill_perspective_portable(piece, texels, [u, v], steps, d, dd);
        }
        // At most PIECE.
        let pixels = piece.len() as i128;
        let advanced = |from: i128, step: i128| from.wrapping_add(step.wrapping_mul(pixels));
        (u, v, d) = (advanced(u, steps[0]), advanced(v, steps[1]), advanced(d, dd));
    }
}

/// Pixels that [`show_estimated`] fills at most.
const PIECE: usize = 64;

/// Pixels that are estimated together, and those of a row that is no longer.
const LANES: usize = 8;
const FEW: usize = 4;

/// Fills `row`, at most 64 pixels, by quotients in f64. Returns `false` if one of them cannot decide; the row is then
/// as it was.
///
/// Of each numerator and of the divisor the first value is given, and what each pixel adds.
///
/// Only the whole texel counts. Let q be a quotient, |q| ≤ 2³², and t the whole number nearest to its
/// estimate. If |t − q| < 1 and t begins no texel (t mod 2¹⁶ ≠ 0), then q lies in the same texel as t:
/// all bounds of texels are whole numbers other than t, so at least 1 away. So the estimate may be off
/// by less than ½. It is, where numerators are off by at most 12 parts in 2⁵³ of 2³²·D and divisors by 12 parts of D, D
/// being the row's largest divisor:
///
/// 1. Let R be D over the smallest divisor, ε = 2⁻⁵³.
/// 2. The quotient is off by 2³²·12εR for the numerator, the same for the divisor, and 2ε of itself for the reciprocal and
///    the product: less than 2³²·ε·(24R + 3) altogether.
/// 3. For R ≤ 2¹⁵ that is 0.38. Where R is larger nothing is filled.
pub(crate) fn show_estimated(
    shown: impl Shown,
    kernel: Kernel,
    row: &mut [u8],
    texels: Texels<'_>,
    numerators: [[f64; 2]; 2],
    [d, dd]: [f64; 2],
) -> bool {
    const MAX_RATIO: f64 = 32_768.0;

    // At most PIECE.
    let last = d + (row.len() as f64 - 1.0) * dd;
    // False for what is not a number, too.
    let is_sure = d.min(last) * MAX_RATIO >= d.max(last);
    let mut places = [0; PIECE];
    let n = row.len().min(PIECE);
    let estimated = |places: &mut [u16]| {
        if n <= FEW {
            places_at_best::<FEW>(kernel, &mut places[..FEW], texels, numerators, [d, dd])
        } else {
            places_at_best::<LANES>(kernel, &mut places[..n.next_multiple_of(LANES)], texels, numerators, [d, dd])
        }
    };
    if !is_sure || !estimated(&mut places) {
        return false;
    }
    for (pixel, place) in row.iter_mut().zip(&places) {
        shown.show(pixel, texels.bytes[usize::from(*place)]);
    }
    true
}

at_best_level! {
    #[inline]
    fn places_at_best[const N: usize][N](
        kernel: Kernel, places: &mut [u16], texels: Texels<'_>, numerators: [[f64; 2]; 2], divisors: [f64; 2],
    ) -> bool {
        find_places::<N>(places, texels, numerators, divisors)
    }
}

/// The places of the texels, [`Texels::place`], `N` at a time. Returns whether all are sure. What lies beyond the end of a row
/// may be unsure, too.
#[inline(always)]
fn find_places<const N: usize>(
    places: &mut [u16],
    texels: Texels<'_>,
    [[u, du], [v, dv]]: [[f64; 2]; 2],
    [d, dd]: [f64; 2],
) -> bool {
    // `Texels::place` in u32, for twice the lanes.
    let columns = (1_u32 << texels.ubits) - 1;
    let rows = ((1_u32 << texels.vbits) - 1) << texels.ubits;
    let to_row = 16 - texels.ubits;
    let (blocks, _) = places.as_chunks_mut::<N>();
    let mut k: [f64; N] = core::array::from_fn(|k| k as f64);
    let mut unsure = 0;
    for block in blocks {
        for (place, k) in block.iter_mut().zip(&mut k) {
            let reciprocal = 1.0 / (d + *k * dd);
            // Modulo 2³². Lanes beyond the piece may hold anything.
            let u = nearest_whole((u + *k * du) * reciprocal) as u32;
            let v = nearest_whole((v + *k * dv) * reciprocal) as u32;
            // At most columns + rows, which is below 65,536.
            *place = (((v >> to_row) & rows) | ((u >> 16) & columns)) as u16;
            unsure |= u32::from(u & 0xFFFF == 0) | u32::from(v & 0xFFFF == 0);
            *k += N as f64;
        }
    }
    unsure == 0
}
