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

use crate::fixed::{HAS_F64, ROUND_MAGIC};
use crate::lanes::{LANES, NUMBERS};
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
/// `u` and `v` are those of the first pixel, `du` and `dv` what each pixel adds; the sums wrap, so a
/// negative number is given in two's complement (`as u32`).
///
/// Tried and given up, at 64 pixels, where this takes 45 ns: `pext` (BMI2), 37, and said to be slow on the first
/// two generations of Zen; eight gathered loads a turn (AVX2), 26, and processors patched against gather data
/// sampling are said to be much slower at it.
pub fn fill_affine(row: &mut [u8], texels: Texels<'_>, mut u: u32, mut v: u32, du: u32, dv: u32) {
    for pixel in row {
        *pixel = texels.at(u, v);
        u = u.wrapping_add(du);
        v = v.wrapping_add(dv);
    }
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

/// Shows the texels at these places, [`Texels::place`].
pub(crate) fn show(shown: impl Shown, row: &mut [u8], texels: Texels<'_>, places: &[i32]) {
    // Never so: it tells the compiler that there is a last texel, and the masked place needs no check.
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

/// Places of texels in vectors.
#[derive(Clone, Copy)]
struct PlaceLanes<S: Lanes8> {
    s: S,
    columns: S::I32,
    rows: S::I32,
}

impl<S: Lanes8> PlaceLanes<S> {
    #[inline(always)]
    fn new(s: S, texels: Texels<'_>) -> Self {
        let columns = (1 << texels.ubits) - 1;
        let rows = ((1 << texels.vbits) - 1) << texels.ubits;
        Self { s, columns: s.splat_i32(columns), rows: s.splat_i32(rows) }
    }

    /// [`Texels::place`] of u, and of v times the width: what is lost of that no mask has.
    #[inline(always)]
    fn at(self, u: S::I32, v: S::I32) -> S::I32 {
        let s = self.s;
        s.or_i32(s.and_i32(s.shr_i32(v, 16), self.rows), s.and_i32(s.shr_i32(u, 16), self.columns))
    }
}

/// Lines through a texture with the same step, as [`fill_affine`] has them.
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

    /// The places of the first `n` texels from (`u`, `v`) on, and of up to seven more, for which there is room.
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
}

/// Fills `row` with texels in exact perspective, with the fastest loop of this build.
///
/// ```text
/// u_k = floor((numerators[0] + k·steps[0]) / (d + k·dd))        v_k the same of numerators[1], steps[1]
/// ```
///
/// in exact arithmetic, modulo 2³²; negative coordinates wrap as others do. Along the row every divisor is
/// positive (what is less counts as 1), every quotient within ±2³² and every value within ±2¹²⁶, as the
/// raster makes them.
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
    let [u, v] = [0, 1].map(|i| [numerators[i], steps[i]]);
    each_exact_place(row, texels, [u, v], [d, dd], |pixel, place| *pixel = texels.bytes[place]);
}

/// The places of texels, as [`fill_perspective_portable`] has them. Of each number the first value is given, and what each
/// pixel adds.
#[cfg(feature = "alloc")]
pub(crate) fn exact_places(places: &mut [i32], texels: Texels<'_>, numerators: [[i128; 2]; 2], divisors: [i128; 2]) {
    // Below 65,536.
    each_exact_place(places, texels, numerators, divisors, |to, place| *to = place as i32);
}

/// Calls `put` for each with the place of its texel.
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
        // Modulo 2³²: the mask leaves less of it.
        put(to, texels.place(u.div_euclid(divisor) as u32, v.div_euclid(divisor) as u32));
        // What is added after the last pixel may be anything.
        u = u.wrapping_add(du);
        v = v.wrapping_add(dv);
        d = d.wrapping_add(dd);
    }
}

/// Fills `row` like [`fill_perspective`], by quotients in f64, exact where they cannot decide.
///
/// The bound of [`perspective_places`] holds: with ε = 2⁻⁵³, the error of one rounding,
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

/// Pixels of a piece of a row, at most.
const PIECE: usize = 64;

/// The most that the largest divisor of a row may be of the smallest one for an estimate to decide.
const MAX_RATIO: f64 = 32_768.0;

/// The places of the first `n` texels by quotients in f64, at most 64, and of up to seven more, for which there is room.
/// Returns `false` if one of the quotients cannot decide.
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
#[inline(always)]
pub(crate) fn perspective_places<S: Lanes8>(
    s: S,
    places: &mut [i32],
    n: usize,
    texels: Texels<'_>,
    [[u, du], [v, dv]]: [[f64; 2]; 2],
    [d, dd]: [f64; 2],
) -> bool {
    // At most PIECE.
    let last = d + (n as f64 - 1.0) * dd;
    // False for what is not a number, too.
    let is_sure = d.min(last) * MAX_RATIO >= d.max(last);
    if !is_sure {
        return false;
    }
    let at = PlaceLanes::new(s, texels);
    let (magic, fraction) = (s.splat_f64(ROUND_MAGIC), s.splat_i32(0xFFFF));
    let mut numbers = s.load_i32(&NUMBERS);
    let end = s.splat_i32(n as i32);
    let width = s.splat_i32(1 << texels.ubits);
    let mut unsure = 0;
    for block in places.as_chunks_mut::<LANES>().0.iter_mut().take(n.div_ceil(LANES)) {
        let k = s.to_f64(numbers);
        let reciprocal = s.div(s.splat_f64(1.0), s.mul_add(k, s.splat_f64(dd), s.splat_f64(d)));
        // Modulo 2³². Lanes beyond the last may hold anything.
        let u = s.low_bits(s.mul_add(s.mul_add(k, s.splat_f64(du), s.splat_f64(u)), reciprocal, magic));
        let v = s.low_bits(s.mul_add(s.mul_add(k, s.splat_f64(dv), s.splat_f64(v)), reciprocal, magic));
        let is_there = s.is_greater(end, numbers);
        let zero = s.splat_i32(0);
        unsure |= s.to_bitmask(s.and(is_there, s.is_equal(s.and_i32(u, fraction), zero)));
        unsure |= s.to_bitmask(s.and(is_there, s.is_equal(s.and_i32(v, fraction), zero)));
        // By a product: shifts are by constants.
        s.store_i32(at.at(u, s.mul_i32(v, width)), block);
        numbers = s.add_i32(numbers, s.splat_i32(LANES as i32));
    }
    unsure == 0
}
