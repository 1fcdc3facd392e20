//! Eight faces at a time with AVX2.

use core::arch::x86_64::{
    __m256d, __m256i, _CMP_GT_OQ, _CMP_LT_OQ, _mm256_add_epi32, _mm256_and_si256, _mm256_castps_si256,
    _mm256_castsi256_ps, _mm256_castsi256_si128, _mm256_cmp_pd, _mm256_cmpeq_epi32, _mm256_cmpgt_epi32,
    _mm256_cvtepi32_pd, _mm256_extracti128_si256, _mm256_max_epi32, _mm256_min_epi32, _mm256_movemask_pd,
    _mm256_movemask_ps, _mm256_mul_pd, _mm256_set_epi64x, _mm256_set1_epi32, _mm256_setzero_pd, _mm256_shuffle_ps,
    _mm256_srai_epi32, _mm256_sub_epi32, _mm256_sub_pd,
};

use super::{MOST, Sifted};
use crate::render::lit::Place;

/// Only with a kernel for which `Kernel::has_avx2` is true.
pub(super) fn sift(places: &[Place], triangles: &[[u32; 3]], sides: [i32; 4]) -> Sifted {
    // SAFETY: such a kernel is given out only where AVX2 was found.
    unsafe { avx2(places, triangles, sides) }
}

#[target_feature(enable = "avx2")]
fn avx2(places: &[Place], triangles: &[[u32; 3]], sides: [i32; 4]) -> Sifted {
    let mut sifted = Sifted::default();
    let (eights, rest) = triangles[..triangles.len().min(MOST)].as_chunks::<8>();
    for (number, eight) in eights.iter().enumerate() {
        let found = sift_eight(places, eight, sides);
        for (all, bits) in
            [&mut sifted.clipped, &mut sifted.front, &mut sifted.back, &mut sifted.covers].into_iter().zip(found)
        {
            *all |= bits << (8 * number);
        }
    }
    for (i, triangle) in rest.iter().enumerate() {
        sifted.add(8 * eights.len() + i, triangle.map(|i| places[i as usize]), sides);
    }
    sifted
}

/// x and y of one corner of eight faces.
#[inline]
#[target_feature(enable = "avx2")]
fn corner(places: &[Place], triangles: &[[u32; 3]; 8], corner: usize) -> (__m256i, __m256i) {
    // One load of eight bytes.
    let at = |face: usize| {
        let Place { x, y } = places[triangles[face][corner] as usize];
        i64::from(y) << 32 | i64::from(x.cast_unsigned())
    };
    // So that the shuffles, which keep to the halves of a vector, leave the faces in order.
    let low = _mm256_castsi256_ps(_mm256_set_epi64x(at(5), at(4), at(1), at(0)));
    let high = _mm256_castsi256_ps(_mm256_set_epi64x(at(7), at(6), at(3), at(2)));
    (
        _mm256_castps_si256(_mm256_shuffle_ps(low, high, 0b10_00_10_00)),
        _mm256_castps_si256(_mm256_shuffle_ps(low, high, 0b11_01_11_01)),
    )
}

/// `Sifted::add` of eight faces.
#[inline]
#[target_feature(enable = "avx2")]
fn sift_eight(places: &[Place], triangles: &[[u32; 3]; 8], sides: [i32; 4]) -> [u64; 4] {
    let (ax, ay) = corner(places, triangles, 0);
    let (bx, by) = corner(places, triangles, 1);
    let (cx, cy) = corner(places, triangles, 2);
    let (low_x, high_x) = ends(ax, bx, cx);
    let (low_y, high_y) = ends(ay, by, cy);
    // The mark is the least number there is.
    // Of such a face the other numbers mean nothing.
    let clipped = mask(_mm256_cmpeq_epi32(low_x, _mm256_set1_epi32(Place::NEEDS_CLIPPING.x)));

    // Exact in f64: differences are at most 2²¹, products 2⁴².
    let (dx1, dy1) = (_mm256_sub_epi32(bx, ax), _mm256_sub_epi32(by, ay));
    let (dx2, dy2) = (_mm256_sub_epi32(cx, ax), _mm256_sub_epi32(cy, ay));
    let low = |ints| _mm256_cvtepi32_pd(_mm256_castsi256_si128(ints));
    let high = |ints| _mm256_cvtepi32_pd(_mm256_extracti128_si256(ints, 1));
    let low = area(low(dx1), low(dy1), low(dx2), low(dy2));
    let high = area(high(dx1), high(dy1), high(dx2), high(dy2));
    let nought = _mm256_setzero_pd();
    let both = |low, high| bits(_mm256_movemask_pd(low) | _mm256_movemask_pd(high) << 4);
    let front = both(_mm256_cmp_pd(low, nought, _CMP_LT_OQ), _mm256_cmp_pd(high, nought, _CMP_LT_OQ));
    let back = both(_mm256_cmp_pd(low, nought, _CMP_GT_OQ), _mm256_cmp_pd(high, nought, _CMP_GT_OQ));

    let [left, top, right, bottom] = sides.map(|side| _mm256_set1_epi32(side));
    let in_columns = overlap(low_x, high_x, left, right);
    let in_rows = overlap(low_y, high_y, top, bottom);
    let covers = mask(_mm256_and_si256(in_columns, in_rows));
    [clipped, front & !clipped, back & !clipped, covers & !clipped]
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

/// Where pixel centres lie between `low` and `high` of those from `first` to before `end`.
#[inline]
#[target_feature(enable = "avx2")]
fn overlap(low: __m256i, high: __m256i, first: __m256i, end: __m256i) -> __m256i {
    let centre = |units| _mm256_srai_epi32(_mm256_add_epi32(units, _mm256_set1_epi32(127)), 8);
    _mm256_cmpgt_epi32(_mm256_min_epi32(centre(high), end), _mm256_max_epi32(centre(low), first))
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
