//! Eight faces at a time with AVX2.

use core::arch::x86_64::*;

use super::{MOST, Sifted, TINY_SIDE};
use crate::render::lit::Place;
use crate::simd::Avx2;

pub(super) fn sift(_: Avx2, places: &[Place], triangles: &[[u32; 3]], sides: [i32; 4], culls: bool) -> Sifted {
    // SAFETY: the processor has AVX2, says the token.
    unsafe { avx2(places, triangles, sides, culls) }
}

#[target_feature(enable = "avx2")]
fn avx2(places: &[Place], triangles: &[[u32; 3]], sides: [i32; 4], culls: bool) -> Sifted {
    let mut sifted = Sifted::default();
    let triangles = &triangles[..triangles.len().min(MOST)];
    let (eights, rest) = triangles.as_chunks::<8>();
    // Once for all.
    let most = eights.as_flattened().as_flattened().iter().fold(0, |most, &i| if i > most { i } else { most });
    let (eights, rest) = if (most as usize) < places.len() { (eights, rest) } else { (&[][..], triangles) };
    for (number, eight) in eights.iter().enumerate() {
        // SAFETY: no number is above `most`, which is below that of places.
        let found = unsafe { sift_eight(places, eight, sides, culls) };
        let all = [&mut sifted.clipped, &mut sifted.front, &mut sifted.back, &mut sifted.covers];
        for (all, bits) in all.into_iter().zip(found) {
            *all |= bits << (8 * number);
        }
    }
    for (i, triangle) in rest.iter().enumerate() {
        sifted.add(8 * eights.len() + i, triangle.map(|i| places[i as usize]), sides, culls);
    }
    sifted
}

type Point = (__m256i, __m256i);

/// x and y of one corner of eight faces.
///
/// # Safety
/// The faces' numbers are below that of places.
#[inline]
#[target_feature(enable = "avx2")]
unsafe fn corner(places: &[Place], triangles: &[[u32; 3]; 8], corner: usize) -> Point {
    // SAFETY: by the caller's promise.
    let at = |face: usize| unsafe { places.get_unchecked(triangles[face][corner] as usize) }.to_bits().cast_signed();
    // So that the shuffles, which keep to the halves of a vector, leave the faces in order.
    let low = _mm256_castsi256_ps(_mm256_set_epi64x(at(5), at(4), at(1), at(0)));
    let high = _mm256_castsi256_ps(_mm256_set_epi64x(at(7), at(6), at(3), at(2)));
    let x = _mm256_castps_si256(_mm256_shuffle_ps(low, high, 0b10_00_10_00));
    (x, _mm256_castps_si256(_mm256_shuffle_ps(low, high, 0b11_01_11_01)))
}

/// `Sifted::add` of eight faces.
///
/// # Safety
/// The faces' numbers are below that of places.
#[inline]
#[target_feature(enable = "avx2")]
unsafe fn sift_eight(places: &[Place], triangles: &[[u32; 3]; 8], sides: [i32; 4], culls: bool) -> [u64; 4] {
    // SAFETY: by the caller's promise.
    let corners = unsafe { [corner(places, triangles, 0), corner(places, triangles, 1), corner(places, triangles, 2)] };
    let [(ax, ay), (bx, by), (cx, cy)] = corners;
    let (low_x, high_x) = ends(ax, bx, cx);
    // The mark is the least number there is. Of such a face the other numbers mean nothing.
    let clipped = mask(_mm256_cmpeq_epi32(low_x, _mm256_set1_epi32(Place::BEYOND)));

    // Exact in f64: differences are at most 2²¹, products 2⁴².
    let (dx1, dy1) = (_mm256_sub_epi32(bx, ax), _mm256_sub_epi32(by, ay));
    let (dx2, dy2) = (_mm256_sub_epi32(cx, ax), _mm256_sub_epi32(cy, ay));
    let low = |ints| _mm256_cvtepi32_pd(_mm256_castsi256_si128(ints));
    let high = |ints| _mm256_cvtepi32_pd(_mm256_extracti128_si256(ints, 1));
    let low = area(low(dx1), low(dy1), low(dx2), low(dy2));
    let high = area(high(dx1), high(dy1), high(dx2), high(dy2));
    let nought = _mm256_setzero_pd();
    let both = |low, high| bits(_mm256_movemask_pd(low) | _mm256_movemask_pd(high) << 4);
    let front = both(_mm256_cmp_pd(low, nought, _CMP_LT_OQ), _mm256_cmp_pd(high, nought, _CMP_LT_OQ)) & !clipped;
    let back = both(_mm256_cmp_pd(low, nought, _CMP_GT_OQ), _mm256_cmp_pd(high, nought, _CMP_GT_OQ)) & !clipped;
    // Neighbours mostly turn the same way.
    let seen = if culls { front } else { front | back };
    if seen == 0 {
        return [clipped, front, back, 0];
    }

    let (low_y, high_y) = ends(ay, by, cy);
    let [left, top, right, bottom] = sides.map(|side| _mm256_set1_epi32(side));
    let (column, end_column) = (first_centre(low_x), first_centre(high_x));
    let (row, end_row) = (first_centre(low_y), first_centre(high_y));
    let in_columns = overlap(column, end_column, left, right);
    let in_rows = overlap(row, end_row, top, bottom);
    let mut covers = mask(_mm256_and_si256(in_columns, in_rows)) & seen;
    let three = _mm256_set1_epi32(TINY_SIDE + 1);
    let few_columns = _mm256_cmpgt_epi32(three, _mm256_sub_epi32(end_column, column));
    let few_rows = _mm256_cmpgt_epi32(three, _mm256_sub_epi32(end_row, row));
    let tiny = mask(_mm256_and_si256(few_columns, few_rows)) & covers;
    if tiny != 0 {
        let centre = |number| _mm256_add_epi32(_mm256_slli_epi32(number, 8), _mm256_set1_epi32(128));
        let (x, y) = (centre(column), centre(row));
        let from_first = |(px, py)| (_mm256_sub_epi32(px, x), _mm256_sub_epi32(py, y));
        let [a, b, c] = corners;
        let none = covers_none_of_four(from_first(a), from_first(b), from_first(c));
        covers &= !(tiny & none);
    }
    [clipped, front, back, covers]
}

/// Negation of `covers_one_of_four`.
#[inline]
#[target_feature(enable = "avx2")]
fn covers_none_of_four(a: Point, b: Point, c: Point) -> u64 {
    let cross =
        |(ax, ay): Point, (bx, by): Point| _mm256_sub_epi32(_mm256_mullo_epi32(ax, by), _mm256_mullo_epi32(ay, bx));
    // The edges at the origin, whose sum is twice the area.
    let (ab, bc, ca) = (cross(a, b), cross(b, c), cross(c, a));
    // −1 if it is negative: then all signs are exchanged.
    let turned = _mm256_srai_epi32(_mm256_add_epi32(_mm256_add_epi32(ab, bc), ca), 31);
    let ab = at_four(ab, a, b, turned);
    let bc = at_four(bc, b, c, turned);
    let ca = at_four(ca, c, a, turned);
    let mut none = _mm256_set1_epi32(-1);
    for pixel in 0..4 {
        none = _mm256_and_si256(none, _mm256_or_si256(_mm256_or_si256(ab[pixel], bc[pixel]), ca[pixel]));
    }
    mask(none)
}

/// An edge at the four pixels, negative where these are outside; from its cross product at the first.
#[inline]
#[target_feature(enable = "avx2")]
fn at_four(cross: __m256i, from: Point, to: Point, turned: __m256i) -> [__m256i; 4] {
    let turn = |n| _mm256_sub_epi32(_mm256_xor_si256(n, turned), turned);
    let dx = turn(_mm256_sub_epi32(to.0, from.0));
    let dy = turn(_mm256_sub_epi32(to.1, from.1));
    // Up, or level and to the right: −1. |dx| is below 1,024.
    let is_in = _mm256_srai_epi32(_mm256_sub_epi32(_mm256_slli_epi32(dy, 10), dx), 31);
    let first = _mm256_sub_epi32(_mm256_sub_epi32(turn(cross), _mm256_set1_epi32(1)), is_in);
    let (right, down) = (_mm256_slli_epi32(dy, 8), _mm256_slli_epi32(dx, 8));
    let below = _mm256_add_epi32(first, down);
    [first, _mm256_sub_epi32(first, right), below, _mm256_sub_epi32(below, right)]
}

/// Twice the area.
#[inline]
#[target_feature(enable = "avx2")]
fn area(dx1: __m256d, dy1: __m256d, dx2: __m256d, dy2: __m256d) -> __m256d {
    _mm256_sub_pd(_mm256_mul_pd(dx1, dy2), _mm256_mul_pd(dx2, dy1))
}

/// The least and the greatest of three.
#[inline]
#[target_feature(enable = "avx2")]
fn ends(a: __m256i, b: __m256i, c: __m256i) -> (__m256i, __m256i) {
    (_mm256_min_epi32(_mm256_min_epi32(a, b), c), _mm256_max_epi32(_mm256_max_epi32(a, b), c))
}

/// `I24F8::first_centre`.
#[inline]
#[target_feature(enable = "avx2")]
fn first_centre(units: __m256i) -> __m256i {
    _mm256_srai_epi32(_mm256_add_epi32(units, _mm256_set1_epi32(127)), 8)
}

/// Overlap of two ranges.
#[inline]
#[target_feature(enable = "avx2")]
fn overlap(from: __m256i, to: __m256i, first: __m256i, end: __m256i) -> __m256i {
    _mm256_cmpgt_epi32(_mm256_min_epi32(to, end), _mm256_max_epi32(from, first))
}

/// A bit for each lane of a mask.
#[inline]
#[target_feature(enable = "avx2")]
fn mask(lanes: __m256i) -> u64 {
    bits(_mm256_movemask_ps(_mm256_castsi256_ps(lanes)))
}

/// A mask of eight bits, which is never negative.
#[inline]
fn bits(mask: i32) -> u64 {
    u64::from(mask.cast_unsigned())
}
