//! [`Vector128`] with SSE2, which every x86-64 processor has.

use core::arch::x86_64::*;

#[cfg(feature = "alloc")]
use glam::Vec3;

use super::lanes::intrinsics;
#[cfg(feature = "alloc")]
use super::wide128::Singles128;
use super::wide128::Vector128;

/// The level of every x86-64 processor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sse2;

impl Vector128 for Sse2 {
    type F = __m128d;
    type I = __m128i;

    intrinsics! {
        fn load_f64(from: &[f64; 2]) -> __m128d { _mm_loadu_pd(from.as_ptr()) }
        fn splat_f64(value: f64) -> __m128d { _mm_set1_pd(value) }
        fn store_f64(from: __m128d, to: &mut [f64; 2]) { _mm_storeu_pd(to.as_mut_ptr(), from) }
        fn add_f64(a: __m128d, b: __m128d) -> __m128d { _mm_add_pd(a, b) }
        fn sub_f64(a: __m128d, b: __m128d) -> __m128d { _mm_sub_pd(a, b) }
        fn mul_f64(a: __m128d, b: __m128d) -> __m128d { _mm_mul_pd(a, b) }
        fn div_f64(a: __m128d, b: __m128d) -> __m128d { _mm_div_pd(a, b) }
        fn mul_add(a: __m128d, b: __m128d, c: __m128d) -> __m128d { _mm_add_pd(_mm_mul_pd(a, b), c) }
        fn neg_mul_add(a: __m128d, b: __m128d, c: __m128d) -> __m128d { _mm_sub_pd(c, _mm_mul_pd(a, b)) }
        fn min_f64(a: __m128d, b: __m128d) -> __m128d { _mm_min_pd(a, b) }
        fn max_f64(a: __m128d, b: __m128d) -> __m128d { _mm_max_pd(a, b) }
        fn is_less(a: __m128d, b: __m128d) -> __m128i { _mm_castpd_si128(_mm_cmplt_pd(a, b)) }
        fn bits(from: __m128d) -> __m128i { _mm_castpd_si128(from) }
        fn of_bits(from: __m128i) -> __m128d { _mm_castsi128_pd(from) }
        fn low_to_f64(from: __m128i) -> __m128d { _mm_cvtepi32_pd(from) }

        fn load(from: &[i32; 4]) -> __m128i { _mm_loadu_si128(from.as_ptr().cast()) }
        fn splat(value: i32) -> __m128i { _mm_set1_epi32(value) }
        fn store(from: __m128i, to: &mut [i32; 4]) { _mm_storeu_si128(to.as_mut_ptr().cast(), from) }
        fn add(a: __m128i, b: __m128i) -> __m128i { _mm_add_epi32(a, b) }
        fn sub(a: __m128i, b: __m128i) -> __m128i { _mm_sub_epi32(a, b) }
        fn mul(a: __m128i, b: __m128i) -> __m128i {
            // The lower halves of the products of even lanes and of odd ones.
            let even = _mm_shuffle_epi32::<0b00_00_10_00>(_mm_mul_epu32(a, b));
            let odd = _mm_mul_epu32(_mm_srli_epi64::<32>(a), _mm_srli_epi64::<32>(b));
            _mm_unpacklo_epi32(even, _mm_shuffle_epi32::<0b00_00_10_00>(odd))
        }
        fn and(a: __m128i, b: __m128i) -> __m128i { _mm_and_si128(a, b) }
        fn or(a: __m128i, b: __m128i) -> __m128i { _mm_or_si128(a, b) }
        fn xor(a: __m128i, b: __m128i) -> __m128i { _mm_xor_si128(a, b) }
        fn and_not(a: __m128i, b: __m128i) -> __m128i { _mm_andnot_si128(b, a) }
        fn shl(a: __m128i, by: i32) -> __m128i { _mm_sll_epi32(a, _mm_cvtsi32_si128(by)) }
        fn shr(a: __m128i, by: i32) -> __m128i { _mm_sra_epi32(a, _mm_cvtsi32_si128(by)) }
        fn is_greater(a: __m128i, b: __m128i) -> __m128i { _mm_cmpgt_epi32(a, b) }
        fn is_equal(a: __m128i, b: __m128i) -> __m128i { _mm_cmpeq_epi32(a, b) }
        fn min(a: __m128i, b: __m128i) -> __m128i {
            let is_less = _mm_cmpgt_epi32(b, a);
            _mm_or_si128(_mm_and_si128(is_less, a), _mm_andnot_si128(is_less, b))
        }
        fn max(a: __m128i, b: __m128i) -> __m128i {
            let is_greater = _mm_cmpgt_epi32(a, b);
            _mm_or_si128(_mm_and_si128(is_greater, a), _mm_andnot_si128(is_greater, b))
        }
        fn interleave_low(a: __m128i, b: __m128i) -> __m128i { _mm_unpacklo_epi32(a, b) }
        fn interleave_high(a: __m128i, b: __m128i) -> __m128i { _mm_unpackhi_epi32(a, b) }
        fn even(a: __m128i, b: __m128i) -> __m128i {
            let (a, b) = (_mm_castsi128_ps(a), _mm_castsi128_ps(b));
            _mm_castps_si128(_mm_shuffle_ps::<0b10_00_10_00>(a, b))
        }
        fn sign_bits(from: __m128i) -> u32 { _mm_movemask_ps(_mm_castsi128_ps(from)).cast_unsigned() }

        fn load_i64(from: &[i64; 2]) -> __m128i { _mm_loadu_si128(from.as_ptr().cast()) }
        fn splat_i64(value: i64) -> __m128i { _mm_set1_epi64x(value) }
        fn store_i64(from: __m128i, to: &mut [i64; 2]) { _mm_storeu_si128(to.as_mut_ptr().cast(), from) }
        fn add_i64(a: __m128i, b: __m128i) -> __m128i { _mm_add_epi64(a, b) }
        fn sub_i64(a: __m128i, b: __m128i) -> __m128i { _mm_sub_epi64(a, b) }
        fn shl_i64(a: __m128i, by: i32) -> __m128i { _mm_sll_epi64(a, _mm_cvtsi32_si128(by)) }
        fn upper(a: __m128i) -> __m128i { _mm_srli_epi64::<32>(a) }
        fn mul_low(a: __m128i, b: __m128i) -> __m128i { _mm_mul_epu32(a, b) }
        fn interleave_low_i64(a: __m128i, b: __m128i) -> __m128i { _mm_unpacklo_epi64(a, b) }
        fn interleave_high_i64(a: __m128i, b: __m128i) -> __m128i { _mm_unpackhi_epi64(a, b) }
    }
}

#[cfg(feature = "alloc")]
impl Singles128 for Sse2 {
    type S = __m128;

    intrinsics! {
        fn splat_f32(value: f32) -> __m128 { _mm_set1_ps(value) }
        fn vectors(from: &[Vec3; 4]) -> [__m128; 3] {
            const { assert!(size_of::<Vec3>() == 12) };
            // 12 f32: a `Vec3` is three of them in this order, without padding.
            let from: *const f32 = from.as_ptr().cast();
            let (a, b, c) = (_mm_loadu_ps(from), _mm_loadu_ps(from.add(4)), _mm_loadu_ps(from.add(8)));
            super::singles::apart!(_mm_shuffle_ps, a, b, c)
        }
        fn add_f32(a: __m128, b: __m128) -> __m128 { _mm_add_ps(a, b) }
        fn sub_f32(a: __m128, b: __m128) -> __m128 { _mm_sub_ps(a, b) }
        fn mul_f32(a: __m128, b: __m128) -> __m128 { _mm_mul_ps(a, b) }
        fn div_f32(a: __m128, b: __m128) -> __m128 { _mm_div_ps(a, b) }
        fn nearest_f32(from: __m128) -> __m128i { _mm_cvtps_epi32(from) }
        fn max_f32(a: __m128, b: __m128) -> __m128 { _mm_max_ps(a, b) }
        fn min_f32(a: __m128, b: __m128) -> __m128 { _mm_min_ps(a, b) }
        fn is_at_least(a: __m128, b: __m128) -> __m128i { _mm_castps_si128(_mm_cmpge_ps(a, b)) }
        fn bits_of_f32(from: __m128) -> __m128i { _mm_castps_si128(from) }
        fn widen_low(from: __m128) -> __m128d { _mm_cvtps_pd(from) }
        fn widen_high(from: __m128) -> __m128d { _mm_cvtps_pd(_mm_movehl_ps(from, from)) }
        fn narrow(low: __m128d, high: __m128d) -> __m128 { _mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high)) }
        fn whole(low: __m128d, high: __m128d) -> __m128i {
            _mm_unpacklo_epi64(_mm_cvttpd_epi32(low), _mm_cvttpd_epi32(high))
        }
        fn load_f32(from: &[f32; 4]) -> __m128 { _mm_loadu_ps(from.as_ptr()) }
        fn sqrt(of: __m128d) -> __m128d { _mm_sqrt_pd(of) }
    }
}
