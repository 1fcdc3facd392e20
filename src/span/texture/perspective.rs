//! Texels in exact perspective: coordinates are quotients, in f32, f64 or integers, whichever decides first.

use super::Texels;
use super::along::{OffsetLanes, OffsetsAlong, show_along};
use super::tint::NUMBERS_OF_PAIR;
use crate::fixed::{HAS_F64, ROUND_MAGIC, floor_of_wide};
use crate::lanes::{LANES, NUMBERS};
use crate::simd::{BASELINE, F32Lanes8, Lanes8};
use crate::span::PIECE;

/// Fills `row` with texels in exact perspective, as the raster's loops do at the lowest level.
///
/// ```text
/// u_k = floor((numerators[0] + k·steps[0]) / (d + k·dd))        v_k the same with numerators[1], steps[1]
/// ```
///
/// in exact arithmetic, modulo 2³²; negative coordinates wrap like others. Along the row every divisor is positive
/// (anything less counts as 1), every quotient within ±2³² and every value within ±2¹²⁶, as the raster ensures.
///
/// The bound of `Quotients` holds, with ε = 2⁻⁵³, the error of one rounding:
///
/// 1. Over a piece of the row let N be the largest |n| of a numerator and D the largest divisor. All are linear, so N
///    and D are at the piece's ends, and |k·dn| ≤ 2N.
/// 2. In the numerator n + k·dn in f64, the errors are those of rounding n (εN), dn (2εN for k of them), their product
///    (2εN), and the sum (εN). So it is off by 6εN, and the divisor by 6εD in the same way.
#[cfg(feature = "internals")]
pub fn fill_perspective(
    row: &mut [u8],
    texels: Texels<'_>,
    numerators: [i128; 2],
    steps: [i128; 2],
    d: i128,
    dd: i128,
) {
    // Modulo 2³²: the mask keeps fewer bits than that.
    let exact_offset = |[u, v]: [i128; 2], divisor: i128| {
        texels.offset(floor_of_wide(u, divisor.max(1)) as u32, floor_of_wide(v, divisor.max(1)) as u32)
    };
    let ([u, v], [du, dv]) = (numerators, steps);
    // No more pixels than a row of a frame has.
    let advanced = |from: i128, step: i128, pixels: usize| from.wrapping_add(step.wrapping_mul(pixels as i128));
    for (number, piece) in row.chunks_mut(PIECE).enumerate() {
        let first = number * PIECE;
        let [u, v, d] = [advanced(u, du, first), advanced(v, dv, first), advanced(d, dd, first)];
        let line = |first: i128, step: i128| [first as f64, step as f64];
        let sums =
            PerspectiveSums { numerators: [line(u, du), line(v, dv)], divisors: line(d, dd), base: [0; 2], margin: 0 };
        let n = piece.len();
        let exact = |first: usize, eight: &mut [i32; LANES]| {
            for (offset, k) in eight.iter_mut().zip(first..n) {
                let [u, v, d] = [advanced(u, du, k), advanced(v, dv, k), advanced(d, dd, k)];
                // Below 65,536.
                *offset = exact_offset([u, v], d) as i32;
            }
        };
        let offsets = perspective_along(OffsetLanes::of_level(BASELINE, (texels, 0)), sums, (0, n), exact);
        show_along(BASELINE, (piece, n), texels, ((), &mut ()), offsets);
    }
}

/// The greatest ratio of a row's largest divisor to the smallest for which an estimate decides.
const MAX_RATIO: f64 = 32_768.0;

/// Two numerators and their divisor along a span of a texture that is linear on the face, each given by its first value
/// and its change per pixel.
#[derive(Clone, Copy)]
pub(crate) struct PerspectiveSums<F> {
    pub(crate) numerators: [[F; 2]; 2],
    pub(crate) divisors: [F; 2],
    /// Whole numbers of texels that are added to the quotients.
    pub(crate) base: [i32; 2],
    /// How far quotients in f32 may be off: see [`singles_margin`].
    pub(crate) margin: i32,
}

/// The offsets of the texels from number `range.0` to `range.1` of a span, at most 64, by [`Quotients`]. Where a
/// quotient cannot decide, `exact` stores the offsets of eight texels, from the one with the given number on.
#[inline(always)]
pub(crate) fn perspective_along<S: Lanes8>(
    offsets: OffsetLanes<S>,
    sums: PerspectiveSums<f64>,
    range: (usize, usize),
    exact: impl FnMut(usize, &mut [i32; LANES]),
) -> impl OffsetsAlong<S> {
    let (s, quotients) = (offsets.s, Quotients::new(offsets, &sums, range.1));
    // At most 64.
    let numbers = s.add_i32(s.splat_i32(range.0 as i32), s.load_i32(&NUMBERS));
    PerspectiveAlong { offsets: quotients.offsets, quotients, numbers, first: range.0, exact }
}

/// Computes offsets as [`perspective_along`] does, by quotients in f32, where [`singles_margin`] allows them.
#[inline(always)]
pub(crate) fn singles_along<S: F32Lanes8>(
    offsets: OffsetLanes<S>,
    sums: PerspectiveSums<f32>,
    first: usize,
    exact: impl FnMut(usize, &mut [i32; LANES]),
) -> impl OffsetsAlong<S> {
    const NUMBERS: [f32; LANES] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
    let (s, quotients) = (offsets.s, Singles::new(offsets, &sums));
    // At most 64.
    let numbers = s.add_f32(s.splat_f32(first as f32), s.load_f32(&NUMBERS));
    PerspectiveAlong { offsets: quotients.offsets, quotients, numbers, first, exact }
}

/// The offsets of the first four texels along two spans, by quotients in f32 as in [`singles_along`]; and
/// whether any of them is undecided.
#[inline(always)]
pub(crate) fn singles_pair<S: F32Lanes8>(
    s: S,
    texels: Texels<'_>,
    [a, b]: [PerspectiveSums<f32>; 2],
) -> (S::I32, bool) {
    let numbers = s.load_f32(&NUMBERS_OF_PAIR.map(|number| number as f32)); // at most 3
    let (([au, av], ad), ([bu, bv], bd)) = ((a.numerators, a.divisors), (b.numerators, b.divisors));
    let line = |a: [f32; 2], b: [f32; 2]| [s.halves_f32([a[0], b[0]]), s.halves_f32([a[1], b[1]])];
    let margin = s.halves_i32([a.margin, b.margin]);
    let quotients = Singles {
        offsets: OffsetLanes::of_level(s, (texels, 0)),
        numerators: [line(au, bu), line(av, bv)],
        divisors: line(ad, bd),
        more: [
            s.add_i32(s.halves_i32([a.base[0], b.base[0]]), margin),
            s.add_i32(s.halves_i32([a.base[1], b.base[1]]), margin),
        ],
        unsure: s.add_i32(margin, margin),
    };
    let ([u, v], is_unsure) = quotients.at(s, numbers);
    (quotients.offsets.at_coordinates(u, v), is_unsure)
}

/// A position along a span of [`perspective_along`].
struct PerspectiveAlong<S: Lanes8, Q: QuotientsAlong<S>, E> {
    offsets: OffsetLanes<S>,
    quotients: Q,
    /// The numbers of the next eight texels.
    numbers: Q::Numbers,
    /// The number of the first of them.
    first: usize,
    exact: E,
}

impl<S: Lanes8, Q: QuotientsAlong<S>, E: FnMut(usize, &mut [i32; LANES])> OffsetsAlong<S>
    for PerspectiveAlong<S, Q, E>
{
    #[inline(always)]
    fn next(&mut self) -> S::I32 {
        let (s, numbers, first) = (self.offsets.s, self.numbers, self.first);
        self.skip();
        // Without f64 no quotient decides, and each would cost a microcontroller thousands of
        // instructions.
        if HAS_F64 {
            let ([u, v], is_unsure) = self.quotients.at(s, numbers);
            if !is_unsure {
                return self.offsets.at_coordinates(u, v);
            }
        }
        let mut eight = [0; LANES];
        (self.exact)(first, &mut eight);
        s.load_i32(&eight)
    }

    #[inline(always)]
    fn skip(&mut self) {
        self.first += LANES;
        self.numbers = self.quotients.next(self.offsets.s, self.numbers);
    }
}

/// Quotients along a span, eight at a time.
trait QuotientsAlong<S: Lanes8> {
    /// Numbers of eight texels.
    type Numbers: Copy;
    /// The coordinates of texels with these numbers, and whether the texel of any of them is
    /// undecided.
    fn at(&self, s: S, numbers: Self::Numbers) -> ([S::I32; 2], bool);
    /// The numbers of the next eight.
    fn next(&self, s: S, numbers: Self::Numbers) -> Self::Numbers;
}

/// Quotients in f64, for any level: in higher levels, fewer integers begin a texel.
///
/// Only the integer texel counts. Let q be a quotient, |q| ≤ 2³², and t the integer nearest to its estimate. If |t − q|
/// < 1 and no texel begins at t (t mod 2¹⁶ ≠ 0), then q lies in the same texel as t: all bounds of texels are integers
/// other than t, so at least 1 away. So the estimate may be off by less than ½. This holds for the planes of the
/// raster, which are off by less than 0.2. It also holds if numerators are off by at most 12 parts in 2⁵³ of 2³²·D and
/// divisors by 12 parts of D, D being the row's largest divisor:
///
/// 1. Let R be D over the smallest divisor, ε = 2⁻⁵³.
/// 2. The quotient is off by 2³²·12εR for the numerator, the same for the divisor, and 2ε of itself for the reciprocal
///    and the product: less than 2³²·ε·(24R + 3) altogether.
/// 3. For R ≤ 2¹⁵ that is 0.38. If R is larger, no quotient decides.
struct Quotients<S: Lanes8> {
    offsets: OffsetLanes<S>,
    sums: PerspectiveSums<f64>,
    /// The number of the pixel after the last.
    end: S::I32,
    /// False if no quotient can decide, since divisors differ too much.
    are_sure: bool,
}

impl<S: Lanes8> Quotients<S> {
    /// The quotients of the first `end` pixels of a row, at most [`PIECE`].
    #[inline(always)]
    fn new(offsets: OffsetLanes<S>, sums: &PerspectiveSums<f64>, end: usize) -> Self {
        let mut are_sure = HAS_F64;
        if HAS_F64 {
            let [d, dd] = sums.divisors;
            // At most PIECE.
            let last = d + (end as i32 - 1) as f64 * dd;
            let (least, greatest) = if d < last { (d, last) } else { (last, d) };
            // False for NaN too.
            are_sure = least * MAX_RATIO >= greatest;
        }
        Self { offsets, sums: *sums, end: offsets.s.splat_i32(end as i32), are_sure }
    }
}

impl<S: Lanes8> QuotientsAlong<S> for Quotients<S> {
    type Numbers = S::I32;

    #[inline(always)]
    fn at(&self, s: S, numbers: S::I32) -> ([S::I32; 2], bool) {
        let PerspectiveSums { numerators: [[u, du], [v, dv]], divisors: [d, dd], base, .. } = self.sums;
        let (magic, fraction, zero) = (s.splat_f64(ROUND_MAGIC), self.offsets.fraction(), s.splat_i32(0));
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

    #[inline(always)]
    fn next(&self, s: S, numbers: S::I32) -> S::I32 {
        s.add_i32(numbers, s.splat_i32(LANES as i32))
    }
}

/// The greatest margin allowed for quotients in f32: a larger one would leave more undecided.
const MAX_MARGIN: f64 = 128.0;

/// How far quotients in f32 may be off in triangles, in 1/65,536 of a texel, or 0 where that is too far. It takes, in
/// the same unit, the greatest difference between a triangle's coordinates, the first of which lies in the texel at the
/// base; and the least and the greatest depth.
///
/// With f32, k·dn + n and k·dd + d are summed, divided, and rounded to an integer t. Let ε = 2⁻²⁴, the error of one
/// rounding, Q the greatest quotient from the base on, D the row's largest divisor, R the ratio of D to the smallest:
///
/// 1. No weight of a corner is negative at a covered centre, so R is at most the ratio of the depths, and a numerator
///    at most Q·D.
/// 2. In the divisor, the errors are those of rounding d (εD), dd (|k·dd| ≤ D: εD), their product (εD), and the sum
///    (εD): 4εD. In the numerator |k·dn| ≤ 2Q·D, so the same steps make 6εQD.
/// 3. So the ratio is off by εQ·(6 + 4)R, another 2εQ for the reciprocal and the product, and t by ½. The sums in f64
///    add less than 0.2, and what is neglected here is less than εQ·(R + 1), since R < 3,000.
///
/// So t is off by less than q + 0.7, with q = εQ·(11R + 3), and the margin, q rounded plus 2, exceeds that by more than
/// ½. Let m be the margin. Then a coordinate lies in the same texel, of any level, as t + m if the fraction of t + m is
/// at least 2m.
#[inline(always)]
pub(crate) fn singles_margin<S: Lanes8>(s: S, range: S::F64, [least, greatest]: [S::F64; 2]) -> S::I32 {
    let texel = s.splat_f64(65_536.0);
    let weighted = s.mul_add(greatest, s.splat_f64(11.0), s.mul(least, s.splat_f64(3.0)));
    let off = s.div(s.mul(s.add(range, texel), weighted), s.mul(least, s.splat_f64(16_777_216.0)));
    // False for NaN too.
    let fits = s.is_less(off, s.splat_f64(MAX_MARGIN - 2.0));
    let margin = s.low_bits(s.add(off, s.splat_f64(ROUND_MAGIC + 2.0)));
    s.select_i32(fits, margin, s.splat_i32(0))
}

/// Quotients in f32, where [`singles_margin`] allows them.
struct Singles<S: F32Lanes8> {
    offsets: OffsetLanes<S>,
    numerators: [[S::F32; 2]; 2],
    divisors: [S::F32; 2],
    /// The base and the margin.
    more: [S::I32; 2],
    /// Twice the margin: less than this into a texel, a quotient is undecided.
    unsure: S::I32,
}

impl<S: F32Lanes8> Singles<S> {
    #[inline(always)]
    fn new(offsets: OffsetLanes<S>, sums: &PerspectiveSums<f32>) -> Self {
        let s = offsets.s;
        let ([[u, du], [v, dv]], [d, dd]) = (sums.numerators, sums.divisors);
        let margin = s.splat_i32(sums.margin);
        Self {
            offsets,
            numerators: [[s.splat_f32(u), s.splat_f32(du)], [s.splat_f32(v), s.splat_f32(dv)]],
            divisors: [s.splat_f32(d), s.splat_f32(dd)],
            more: [s.add_i32(s.splat_i32(sums.base[0]), margin), s.add_i32(s.splat_i32(sums.base[1]), margin)],
            unsure: s.add_i32(margin, margin),
        }
    }
}

impl<S: F32Lanes8> QuotientsAlong<S> for Singles<S> {
    type Numbers = S::F32;

    /// Pixels beyond the last may also be undecided.
    #[inline(always)]
    fn at(&self, s: S, k: S::F32) -> ([S::I32; 2], bool) {
        let ([[u, du], [v, dv]], [d, dd]) = (self.numerators, self.divisors);
        let reciprocal = s.div_f32(s.splat_f32(1.0), s.mul_add_f32(k, dd, d));
        let u = s.nearest_f32(s.mul_f32(s.mul_add_f32(k, du, u), reciprocal));
        let v = s.nearest_f32(s.mul_f32(s.mul_add_f32(k, dv, v), reciprocal));
        let (u, v) = (s.add_i32(u, self.more[0]), s.add_i32(v, self.more[1]));
        let fraction = self.offsets.fraction();
        let least = s.min_i32(s.and_i32(u, fraction), s.and_i32(v, fraction));
        ([u, v], s.to_bitmask(s.is_greater(self.unsure, least)) != 0)
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
        let quotients = Singles::new(OffsetLanes::of_level(s, (texels, 0)), sums);
        let ([u, v], is_unsure) = quotients.at(s, s.splat_f32(k as f32));
        let (mut lanes, mut most) = ([0; LANES], 0.0_f64);
        let mut is_near = false;
        for (found, exact) in [u, v].into_iter().zip(exact) {
            s.store_i32(found, &mut lanes);
            let found = lanes[3] - sums.margin;
            most = most.max((f64::from(found) - exact).abs());
            is_near |= (lanes[3] & 0xFFFF) < 2 * sums.margin;
            // Decided quotients select the right texel.
            assert!(is_near || (exact / 65_536.0).floor() as i32 == lanes[3] >> 16, "{exact} {found}");
        }
        assert_eq!(is_unsure, is_near);
        most
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200_000))]
        /// Quotients in f32 are off by less than their margin, by more than ½, on every level, up to the greatest
        /// differences of coordinates and depths for which they are taken.
        #[test]
        fn singles_keep_their_margin(
            (bits, ratio, scale) in (0_u32..12, 0.0..1.0_f64, 0.0..75.0_f64),
            ends in prop::array::uniform2(prop::array::uniform2(prop_oneof![Just(0.0), Just(1.0), 0.0..=1.0_f64])),
            (size, sign, swapped) in (prop_oneof![0.9..1.1, 0.0..1.0_f64], any::<[bool; 2]>(), any::<bool>()),
            (last, at) in (1_usize..64, 0.0..=1.0_f64),
        ) {
            // The ratio of the depths, and coordinates about as great as it allows.
            let ratio = 1.0 + f64::from(1_u32 << bits) * ratio;
            let range = size * MAX_MARGIN * 16_777_216.0 / (11.0 * ratio + 3.0) - 65_536.0;
            let margin = singles_margin(Portable, [range; LANES], [[1.0; LANES], [ratio; LANES]])[0];
            if range < 0.0 || margin == 0 {
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
                margin,
            };
            let mut most = off(Portable, &sums, k, exact).max(off(BASELINE, &sums, k, exact));
            #[cfg(simd_x86_64)]
            for off in [
                crate::simd::Avx2::find().map(|s| off(s, &sums, k, exact)),
                crate::simd::Avx512::find().map(|s| off(s, &sums, k, exact)),
            ] {
                most = most.max(off.unwrap_or(0.0));
            }
            prop_assert!(most + 0.5 < f64::from(margin), "{most} {margin}");
        }
    }
}
