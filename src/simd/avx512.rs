//! [`Lanes8`] with AVX-512: 512 bits for 64-bit lanes, 256 for 32-bit ones.

use core::arch::x86_64::*;

#[cfg(feature = "alloc")]
use glam::Vec3;

use super::Avx512;
use super::avx2::{join_bytes, lanes_by_pairs};
use super::lanes::{Lanes8, inlined, intrinsics};
#[cfg(feature = "alloc")]
use super::singles::{F32Lanes8, singles_of_256_bits};

impl Lanes8 for Avx512 {
    type F64 = __m512d;
    type I32 = __m256i;
    type I64 = __m512i;
    type Mask = __mmask8;

    #[inline(always)]
    fn apart<R>(self, part: impl FnOnce() -> R) -> R {
        #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,bmi2,popcnt,avx2,fma")]
        #[inline(never)]
        fn call<R>(part: impl FnOnce() -> R) -> R {
            part()
        }
        // SAFETY: the token proves that the processor has the level.
        unsafe { call(part) }
    }

    intrinsics! {
        fn load_f64(from: &[f64; 8]) -> __m512d { _mm512_loadu_pd(from.as_ptr()) }
        fn splat_f64(value: f64) -> __m512d { _mm512_set1_pd(value) }
        fn store_f64(from: __m512d, to: &mut [f64; 8]) { _mm512_storeu_pd(to.as_mut_ptr(), from) }
        fn add(a: __m512d, b: __m512d) -> __m512d { _mm512_add_pd(a, b) }
        fn sub(a: __m512d, b: __m512d) -> __m512d { _mm512_sub_pd(a, b) }
        fn mul(a: __m512d, b: __m512d) -> __m512d { _mm512_mul_pd(a, b) }
        fn div(a: __m512d, b: __m512d) -> __m512d { _mm512_div_pd(a, b) }
        fn mul_add(a: __m512d, b: __m512d, c: __m512d) -> __m512d { _mm512_fmadd_pd(a, b, c) }
        fn neg_mul_add(a: __m512d, b: __m512d, c: __m512d) -> __m512d { _mm512_fnmadd_pd(a, b, c) }
        fn min(a: __m512d, b: __m512d) -> __m512d { _mm512_min_pd(a, b) }
        fn max(a: __m512d, b: __m512d) -> __m512d { _mm512_max_pd(a, b) }
        fn xor_sign(a: __m512d, sign: __m512d) -> __m512d {
            _mm512_xor_pd(a, _mm512_and_pd(sign, _mm512_set1_pd(-0.0)))
        }
        fn is_less(a: __m512d, b: __m512d) -> __mmask8 { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(a, b) }
        fn select(mask: __mmask8, a: __m512d, b: __m512d) -> __m512d { _mm512_mask_blend_pd(mask, b, a) }
        fn to_f64(from: __m256i) -> __m512d { _mm512_cvtepi32_pd(from) }
        fn unsigned_to_f64(from: __m256i) -> __m512d { _mm512_cvtepu32_pd(from) }
        fn low_bits(from: __m512d) -> __m256i { _mm512_cvtepi64_epi32(_mm512_castpd_si512(from)) }
        fn bits(from: __m512d) -> __m512i { _mm512_castpd_si512(from) }

        fn load_i32(from: &[i32; 8]) -> __m256i { _mm256_loadu_si256(from.as_ptr().cast()) }
        fn splat_i32(value: i32) -> __m256i { _mm256_set1_epi32(value) }
        fn store_i32(from: __m256i, to: &mut [i32; 8]) { _mm256_storeu_si256(to.as_mut_ptr().cast(), from) }
        fn low_words(from: __m256i) -> [u16; 8] {
            let words = _mm256_cvtepi32_epi16(from);
            super::words_of([_mm_cvtsi128_si64(words), _mm_extract_epi64::<1>(words)])
        }
        fn low_bytes(from: __m256i) -> [u8; 8] { _mm_cvtsi128_si64(_mm256_cvtepi32_epi8(from)).to_le_bytes() }
        fn to_indices(from: __m256i) -> [usize; 8] { lanes_by_pairs(from) }
        fn join_bytes(bytes: [u8; 8]) -> [u8; 8] { join_bytes(bytes) }
        fn add_i32(a: __m256i, b: __m256i) -> __m256i { _mm256_add_epi32(a, b) }
        fn sub_i32(a: __m256i, b: __m256i) -> __m256i { _mm256_sub_epi32(a, b) }
        fn mul_i32(a: __m256i, b: __m256i) -> __m256i { _mm256_mullo_epi32(a, b) }
        fn min_i32(a: __m256i, b: __m256i) -> __m256i { _mm256_min_epi32(a, b) }
        fn max_i32(a: __m256i, b: __m256i) -> __m256i { _mm256_max_epi32(a, b) }
        fn and_i32(a: __m256i, b: __m256i) -> __m256i { _mm256_and_si256(a, b) }
        fn or_i32(a: __m256i, b: __m256i) -> __m256i { _mm256_or_si256(a, b) }
        fn xor_i32(a: __m256i, b: __m256i) -> __m256i { _mm256_xor_si256(a, b) }
        fn shl_i32(a: __m256i, by: i32) -> __m256i { _mm256_sll_epi32(a, _mm_cvtsi32_si128(by)) }
        fn shr_i32(a: __m256i, by: i32) -> __m256i { _mm256_sra_epi32(a, _mm_cvtsi32_si128(by)) }
        fn is_greater(a: __m256i, b: __m256i) -> __mmask8 { _mm256_cmpgt_epi32_mask(a, b) }
        fn is_equal(a: __m256i, b: __m256i) -> __mmask8 { _mm256_cmpeq_epi32_mask(a, b) }
        fn select_i32(mask: __mmask8, a: __m256i, b: __m256i) -> __m256i { _mm256_mask_blend_epi32(mask, b, a) }
        fn interleave_i32(a: __m256i, b: __m256i) -> [__m256i; 2] {
            let low = _mm256_setr_epi32(0, 8, 1, 9, 2, 10, 3, 11);
            let high = _mm256_setr_epi32(4, 12, 5, 13, 6, 14, 7, 15);
            [_mm256_permutex2var_epi32(a, low, b), _mm256_permutex2var_epi32(a, high, b)]
        }

        fn load_i64(from: &[i64; 8]) -> __m512i { _mm512_loadu_si512(from.as_ptr().cast()) }
        fn splat_i64(value: i64) -> __m512i { _mm512_set1_epi64(value) }
        fn halves_i64(low: i64, high: i64) -> __m512i { _mm512_mask_set1_epi64(_mm512_set1_epi64(low), 0xF0, high) }
        fn store_i64(from: __m512i, to: &mut [i64; 8]) { _mm512_storeu_si512(to.as_mut_ptr().cast(), from) }
        fn add_i64(a: __m512i, b: __m512i) -> __m512i { _mm512_add_epi64(a, b) }
        fn sub_i64(a: __m512i, b: __m512i) -> __m512i { _mm512_sub_epi64(a, b) }
        fn mul_i64(a: __m512i, b: __m512i) -> __m512i { _mm512_mullo_epi64(a, b) }
        fn mul_low_i64(a: __m512i, b: __m512i) -> __m512i {
            _mm512_mullo_epi64(_mm512_and_si512(a, _mm512_set1_epi64(0xFFFF_FFFF)), b)
        }
        fn shl_i64(a: __m512i, by: i32) -> __m512i { _mm512_sll_epi64(a, _mm_cvtsi32_si128(by)) }
        fn to_i64(from: __m256i) -> __m512i { _mm512_cvtepi32_epi64(from) }
        fn unsigned_to_i64(from: __m256i) -> __m512i { _mm512_cvtepu32_epi64(from) }
        fn halves_of_i64(from: __m512i) -> [__m256i; 2] {
            [_mm512_cvtepi64_epi32(from), _mm512_cvtepi64_epi32(_mm512_srli_epi64::<32>(from))]
        }
        fn interleave_i64(a: __m512i, b: __m512i) -> [__m512i; 2] {
            let low = _mm512_setr_epi64(0, 8, 1, 9, 2, 10, 3, 11);
            let high = _mm512_setr_epi64(4, 12, 5, 13, 6, 14, 7, 15);
            [_mm512_permutex2var_epi64(a, low, b), _mm512_permutex2var_epi64(a, high, b)]
        }
    }

    inlined! {
        fn and(self, a: __mmask8, b: __mmask8) -> __mmask8 { a & b }
        fn and_not(self, a: __mmask8, b: __mmask8) -> __mmask8 { a & !b }
        fn mask_from_bits(self, bits: u8) -> __mmask8 { bits }
        fn to_bitmask(self, mask: __mmask8) -> u32 { mask.into() }
        fn test_four(self, cells: &mut [u32; 4], depths: [i64; 2], count: usize, keeps: bool) -> u32 {
            self.0.test_four(cells, depths, count, keeps)
        }
        fn test_eight(self, cells: &mut [u32; 8], depths: [i64; 2], count: usize, keeps: bool) -> u64 {
            self.0.test_eight(cells, depths, count, keeps)
        }
    }

    #[inline(always)]
    fn copy_nearer(
        self,
        (pixels, cells): (&mut [u8; 8], &mut [u32; 8]),
        (bytes, count): ([u8; 8], usize),
        [z, dz]: [i64; 2],
        keeps: bool,
    ) -> u32 {
        // SAFETY: `self` proves that the processor has the instructions. Eight cells are loaded, and at most eight
        // cells and pixels stored. Neither requires alignment.
        unsafe {
            // The lower eight bits.
            let there = _bzhi_u32(0xFF, count.min(8) as u32) as u8;
            let numbers = _mm512_setr_epi64(0, 1, 2, 3, 4, 5, 6, 7);
            let depths = _mm512_add_epi64(_mm512_mullo_epi64(_mm512_set1_epi64(dz), numbers), _mm512_set1_epi64(z));
            let depths = _mm512_cvtepi64_epi32(_mm512_srli_epi64::<32>(depths));
            let before = _mm256_loadu_si256(cells.as_ptr().cast());
            let nearer = _mm256_mask_cmpgt_epu32_mask(there, depths, before);
            if keeps {
                _mm256_mask_storeu_epi32(cells.as_mut_ptr().cast(), nearer, depths);
            }
            let bytes = _mm_cvtsi64_si128(i64::from_le_bytes(bytes));
            _mm_mask_storeu_epi8(pixels.as_mut_ptr().cast(), nearer.into(), bytes);
            nearer.count_ones()
        }
    }

    #[inline(always)]
    fn compress_i32<const N: usize>(self, mask: __mmask8, from: [__m256i; N], to: [&mut [u32; 8]; N]) {
        for (i, to) in to.into_iter().enumerate() {
            // SAFETY: `self` proves that the processor has the instructions; the store goes to a whole array.
            // (`vpcompressd` to memory is slow on Zen 4.)
            unsafe { _mm256_storeu_si256(to.as_mut_ptr().cast(), _mm256_maskz_compress_epi32(mask, from[i])) }
        }
    }
    #[inline(always)]
    fn compress_i64<const N: usize>(self, mask: __mmask8, from: [__m512i; N], to: [&mut [i64; 8]; N]) {
        for (i, to) in to.into_iter().enumerate() {
            // SAFETY: `self` proves that the processor has the instructions; the store goes to a whole array.
            unsafe { _mm512_storeu_si512(to.as_mut_ptr().cast(), _mm512_maskz_compress_epi64(mask, from[i])) }
        }
    }
}

#[cfg(feature = "alloc")]
impl F32Lanes8 for Avx512 {
    singles_of_256_bits! {
        fn is_at_least(a: __m256, b: __m256) -> __mmask8 { _mm256_cmp_ps_mask::<_CMP_GE_OQ>(a, b) }
        fn widen(from: __m256) -> __m512d { _mm512_cvtps_pd(from) }
        fn narrow(from: __m512d) -> __m256 { _mm512_cvtpd_ps(from) }
        fn whole(from: __m512d) -> __m256i { _mm512_cvttpd_epi32(from) }
        fn sqrt(of: __m512d) -> __m512d { _mm512_sqrt_pd(of) }
        fn if_less(a: __m512d, b: __m512d, value: __m512d) -> __m512d {
            _mm512_maskz_mov_pd(_mm512_cmp_pd_mask::<_CMP_LT_OQ>(a, b), value)
        }
        fn is_zero(values: __m512d) -> bool {
            let bits = _mm512_castpd_si512(values);
            _mm512_test_epi64_mask(bits, bits) == 0
        }
    }
}
