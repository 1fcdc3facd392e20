//! [`Lanes8`] with AVX2 and FMA: 64-bit lanes in two halves.

use core::arch::asm;
use core::arch::x86_64::*;

#[cfg(feature = "alloc")]
use glam::Vec3;

use super::Avx2;
use super::lanes::{FIRST_LANES, Lanes8, copy_block, intrinsics};
#[cfg(feature = "alloc")]
use super::singles::{F32Lanes8, singles_of_256_bits};

type F64 = [__m256d; 2];
type I64 = [__m256i; 2];

/// A pair of values, one for each half.
macro_rules! halves {
    ($half:ident => $value:expr) => {{
        let of = {
            let $half = 0;
            $value
        };
        let $half = 1;
        [of, $value]
    }};
}

/// The lower halves of eight lanes.
#[inline(always)]
unsafe fn words(from: __m256i) -> __m128i {
    // SAFETY: the caller has AVX2.
    unsafe {
        let from = _mm256_and_si256(from, _mm256_set1_epi32(0xFFFF));
        _mm_packus_epi32(_mm256_castsi256_si128(from), _mm256_extracti128_si256::<1>(from))
    }
}

/// Moves eight lanes to registers in pairs. Without the assembly, the compiler would extract one after the other, which
/// takes twice as many operations on the vector.
#[inline(always)]
pub(super) unsafe fn lanes_by_pairs(from: __m256i) -> [usize; 8] {
    let (a, b, c, d): (u64, u64, u64, u64);
    // SAFETY: the caller has AVX2.
    unsafe {
        let (low, high) = (_mm256_castsi256_si128(from), _mm256_extracti128_si256::<1>(from));
        asm!("vmovq {}, {}", lateout(reg) a, in(xmm_reg) low, options(pure, nomem, nostack, preserves_flags));
        asm!("vpextrq {}, {}, 1", lateout(reg) b, in(xmm_reg) low, options(pure, nomem, nostack, preserves_flags));
        asm!("vmovq {}, {}", lateout(reg) c, in(xmm_reg) high, options(pure, nomem, nostack, preserves_flags));
        asm!("vpextrq {}, {}, 1", lateout(reg) d, in(xmm_reg) high, options(pure, nomem, nostack, preserves_flags));
    }
    let (lower, upper) = (|pair: u64| pair as u32 as usize, |pair: u64| (pair >> 32) as usize);
    [lower(a), upper(a), lower(b), upper(b), lower(c), upper(c), lower(d), upper(d)]
}

/// Joins eight bytes that are loaded straight into a vector.
#[inline(always)]
pub(super) unsafe fn join_bytes(bytes: [u8; 8]) -> [u8; 8] {
    // Not by `map`, which the compiler would turn into other vectors.
    let (a, b, c, d) = (i32::from(bytes[0]), i32::from(bytes[1]), i32::from(bytes[2]), i32::from(bytes[3]));
    let (e, f, g, h) = (i32::from(bytes[4]), i32::from(bytes[5]), i32::from(bytes[6]), i32::from(bytes[7]));
    // SAFETY: the caller has AVX2.
    unsafe {
        let joined = _mm_insert_epi8::<2>(_mm_insert_epi8::<1>(_mm_cvtsi32_si128(a), b), c);
        let joined = _mm_insert_epi8::<5>(_mm_insert_epi8::<4>(_mm_insert_epi8::<3>(joined, d), e), f);
        _mm_cvtsi128_si64(_mm_insert_epi8::<7>(_mm_insert_epi8::<6>(joined, g), h)).to_le_bytes()
    }
}

/// Widens the masks of 32-bit lanes to masks of the 64-bit lanes of both halves.
#[inline(always)]
unsafe fn wide(mask: __m256i) -> F64 {
    // SAFETY: the caller has AVX2.
    unsafe {
        let (low, high) = (_mm256_castsi256_si128(mask), _mm256_extracti128_si256::<1>(mask));
        [_mm256_castsi256_pd(_mm256_cvtepi32_epi64(low)), _mm256_castsi256_pd(_mm256_cvtepi32_epi64(high))]
    }
}

/// The lower halves of eight 64-bit lanes.
#[inline(always)]
unsafe fn low(from: F64) -> __m256i {
    // SAFETY: the caller has AVX2.
    unsafe {
        let halves = _mm256_shuffle_ps::<0b10_00_10_00>(_mm256_castpd_ps(from[0]), _mm256_castpd_ps(from[1]));
        _mm256_permute4x64_epi64::<0b11_01_10_00>(_mm256_castps_si256(halves))
    }
}

/// Indices of the set lanes for each mask of eight, then zeros: a byte each, the first lowest.
static SET_LANES: [u64; 256] = {
    let mut all = [0; 256];
    let mut mask = 0;
    while mask < 256 {
        let (mut lane, mut count) = (0, 0);
        while lane < 8 {
            if mask >> lane & 1 == 1 {
                all[mask] |= lane << (8 * count);
                count += 1;
            }
            lane += 1;
        }
        mask += 1;
    }
    all
};
/// Indices of the 32-bit halves of the set 64-bit lanes for each mask of four, then zeros: a byte each.
static SET_PAIRS: [u64; 16] = {
    let mut all = [0; 16];
    let mut mask = 0;
    while mask < 16 {
        // Each of its bits twice.
        all[mask] = SET_LANES[3 * (mask & 1 | (mask & 2) << 1 | (mask & 4) << 2 | (mask & 8) << 3)];
        mask += 1;
    }
    all
};

impl Lanes8 for Avx2 {
    type F64 = F64;
    type I32 = __m256i;
    type I64 = I64;
    /// −1 in the set lanes, 0 in the others.
    type Mask = __m256i;

    #[inline(always)]
    fn apart<R>(self, part: impl FnOnce() -> R) -> R {
        #[target_feature(enable = "avx2,fma,popcnt")]
        #[inline(never)]
        fn call<R>(part: impl FnOnce() -> R) -> R {
            part()
        }
        // SAFETY: the token proves that the processor has the level.
        unsafe { call(part) }
    }

    intrinsics! {
        fn load_f64(from: &[f64; 8]) -> F64 { [_mm256_loadu_pd(from.as_ptr()), _mm256_loadu_pd(from.as_ptr().add(4))] }
        fn splat_f64(value: f64) -> F64 { [_mm256_set1_pd(value); 2] }
        fn store_f64(from: F64, to: &mut [f64; 8]) {
            _mm256_storeu_pd(to.as_mut_ptr(), from[0]);
            _mm256_storeu_pd(to.as_mut_ptr().add(4), from[1]);
        }
        fn add(a: F64, b: F64) -> F64 { halves!(h => _mm256_add_pd(a[h], b[h])) }
        fn sub(a: F64, b: F64) -> F64 { halves!(h => _mm256_sub_pd(a[h], b[h])) }
        fn mul(a: F64, b: F64) -> F64 { halves!(h => _mm256_mul_pd(a[h], b[h])) }
        fn div(a: F64, b: F64) -> F64 { halves!(h => _mm256_div_pd(a[h], b[h])) }
        fn mul_add(a: F64, b: F64, c: F64) -> F64 { halves!(h => _mm256_fmadd_pd(a[h], b[h], c[h])) }
        fn neg_mul_add(a: F64, b: F64, c: F64) -> F64 { halves!(h => _mm256_fnmadd_pd(a[h], b[h], c[h])) }
        fn min(a: F64, b: F64) -> F64 { halves!(h => _mm256_min_pd(a[h], b[h])) }
        fn max(a: F64, b: F64) -> F64 { halves!(h => _mm256_max_pd(a[h], b[h])) }
        fn xor_sign(a: F64, sign: F64) -> F64 {
            halves!(h => _mm256_xor_pd(a[h], _mm256_and_pd(sign[h], _mm256_set1_pd(-0.0))))
        }
        fn is_less(a: F64, b: F64) -> __m256i { low(halves!(h => _mm256_cmp_pd::<_CMP_LT_OQ>(a[h], b[h]))) }
        fn select(mask: __m256i, a: F64, b: F64) -> F64 {
            let mask = wide(mask);
            halves!(h => _mm256_blendv_pd(b[h], a[h], mask[h]))
        }
        fn to_f64(from: __m256i) -> F64 {
            [_mm256_cvtepi32_pd(_mm256_castsi256_si128(from)), _mm256_cvtepi32_pd(_mm256_extracti128_si256::<1>(from))]
        }
        fn unsigned_to_f64(from: __m256i) -> F64 {
            // Subtracts 2³¹ and adds it again, both of which are exact.
            let signed = _mm256_xor_si256(from, _mm256_set1_epi32(i32::MIN));
            let (low, high) = (_mm256_castsi256_si128(signed), _mm256_extracti128_si256::<1>(signed));
            let more = _mm256_set1_pd(2_147_483_648.0);
            [_mm256_add_pd(_mm256_cvtepi32_pd(low), more), _mm256_add_pd(_mm256_cvtepi32_pd(high), more)]
        }
        fn low_bits(from: F64) -> __m256i { low(from) }
        fn bits(from: F64) -> I64 { halves!(h => _mm256_castpd_si256(from[h])) }

        fn load_i32(from: &[i32; 8]) -> __m256i { _mm256_loadu_si256(from.as_ptr().cast()) }
        fn splat_i32(value: i32) -> __m256i { _mm256_set1_epi32(value) }
        fn store_i32(from: __m256i, to: &mut [i32; 8]) { _mm256_storeu_si256(to.as_mut_ptr().cast(), from) }
        fn low_words(from: __m256i) -> [u16; 8] {
            let words = words(from);
            super::words_of([_mm_cvtsi128_si64(words), _mm_extract_epi64::<1>(words)])
        }
        fn low_bytes(from: __m256i) -> [u8; 8] {
            let fours = _mm256_shuffle_epi8(from, _mm256_set1_epi32(0x0C08_0400));
            let eight = _mm_unpacklo_epi32(_mm256_castsi256_si128(fours), _mm256_extracti128_si256::<1>(fours));
            _mm_cvtsi128_si64(eight).to_le_bytes()
        }
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
        fn is_greater(a: __m256i, b: __m256i) -> __m256i { _mm256_cmpgt_epi32(a, b) }
        fn is_equal(a: __m256i, b: __m256i) -> __m256i { _mm256_cmpeq_epi32(a, b) }
        fn select_i32(mask: __m256i, a: __m256i, b: __m256i) -> __m256i { _mm256_blendv_epi8(b, a, mask) }
        fn interleave_i32(a: __m256i, b: __m256i) -> [__m256i; 2] {
            let (even, odd) = (_mm256_unpacklo_epi32(a, b), _mm256_unpackhi_epi32(a, b));
            [_mm256_permute2x128_si256::<0x20>(even, odd), _mm256_permute2x128_si256::<0x31>(even, odd)]
        }

        fn load_i64(from: &[i64; 8]) -> I64 {
            [_mm256_loadu_si256(from.as_ptr().cast()), _mm256_loadu_si256(from.as_ptr().add(4).cast())]
        }
        fn splat_i64(value: i64) -> I64 { [_mm256_set1_epi64x(value); 2] }
        fn halves_i64(low: i64, high: i64) -> I64 { [_mm256_set1_epi64x(low), _mm256_set1_epi64x(high)] }
        fn store_i64(from: I64, to: &mut [i64; 8]) {
            _mm256_storeu_si256(to.as_mut_ptr().cast(), from[0]);
            _mm256_storeu_si256(to.as_mut_ptr().add(4).cast(), from[1]);
        }
        fn add_i64(a: I64, b: I64) -> I64 { halves!(h => _mm256_add_epi64(a[h], b[h])) }
        fn sub_i64(a: I64, b: I64) -> I64 { halves!(h => _mm256_sub_epi64(a[h], b[h])) }
        fn mul_i64(a: I64, b: I64) -> I64 {
            // The products of the lower halves, and of lower and upper ones.
            halves!(h => {
                let (a, b) = (a[h], b[h]);
                let upper = _mm256_add_epi64(
                    _mm256_mul_epu32(a, _mm256_srli_epi64::<32>(b)),
                    _mm256_mul_epu32(_mm256_srli_epi64::<32>(a), b),
                );
                _mm256_add_epi64(_mm256_mul_epu32(a, b), _mm256_slli_epi64::<32>(upper))
            })
        }
        fn mul_low_i64(a: I64, b: I64) -> I64 {
            halves!(h => {
                let upper = _mm256_mul_epu32(a[h], _mm256_srli_epi64::<32>(b[h]));
                _mm256_add_epi64(_mm256_mul_epu32(a[h], b[h]), _mm256_slli_epi64::<32>(upper))
            })
        }
        fn shl_i64(a: I64, by: i32) -> I64 { halves!(h => _mm256_sll_epi64(a[h], _mm_cvtsi32_si128(by))) }
        fn to_i64(from: __m256i) -> I64 {
            let (low, high) = (_mm256_castsi256_si128(from), _mm256_extracti128_si256::<1>(from));
            [_mm256_cvtepi32_epi64(low), _mm256_cvtepi32_epi64(high)]
        }
        fn unsigned_to_i64(from: __m256i) -> I64 {
            let (low, high) = (_mm256_castsi256_si128(from), _mm256_extracti128_si256::<1>(from));
            [_mm256_cvtepu32_epi64(low), _mm256_cvtepu32_epi64(high)]
        }
        fn halves_of_i64(from: I64) -> [__m256i; 2] {
            let (a, b) = (_mm256_castsi256_ps(from[0]), _mm256_castsi256_ps(from[1]));
            let low = _mm256_castps_si256(_mm256_shuffle_ps::<0b10_00_10_00>(a, b));
            let high = _mm256_castps_si256(_mm256_shuffle_ps::<0b11_01_11_01>(a, b));
            [_mm256_permute4x64_epi64::<0b11_01_10_00>(low), _mm256_permute4x64_epi64::<0b11_01_10_00>(high)]
        }
        fn interleave_i64(a: I64, b: I64) -> [I64; 2] {
            halves!(h => {
                let (even, odd) = (_mm256_unpacklo_epi64(a[h], b[h]), _mm256_unpackhi_epi64(a[h], b[h]));
                [_mm256_permute2x128_si256::<0x20>(even, odd), _mm256_permute2x128_si256::<0x31>(even, odd)]
            })
        }

        fn and(a: __m256i, b: __m256i) -> __m256i { _mm256_and_si256(a, b) }
        fn and_not(a: __m256i, b: __m256i) -> __m256i { _mm256_andnot_si256(b, a) }
        fn mask_from_bits(bits: u8) -> __m256i {
            let lanes = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
            _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(bits.into()), lanes), lanes)
        }
        fn to_bitmask(mask: __m256i) -> u32 { _mm256_movemask_ps(_mm256_castsi256_ps(mask)).cast_unsigned() }
    }

    #[inline(always)]
    fn test_four(self, cells: &mut [u32; 4], depths: [i64; 2], count: usize, keeps: bool) -> u32 {
        let stay = self.four_stay(cells, depths, count, keeps);
        // SAFETY: `self` proves that the processor has the instructions.
        unsafe { _mm_cvtsi128_si32(_mm_shuffle_epi8(stay, _mm_set1_epi32(0x0C08_0400))).cast_unsigned() }
    }
    #[inline(always)]
    fn test_eight(self, cells: &mut [u32; 8], depths: [i64; 2], count: usize, keeps: bool) -> u64 {
        u64::from_le_bytes(self.low_bytes(self.eight_stay(cells, depths, count, keeps)))
    }
    #[inline(always)]
    fn copy_nearer(
        self,
        (pixels, cells): (&mut [u8; 8], &mut [u32; 8]),
        (bytes, count): ([u8; 8], usize),
        depths: [i64; 2],
        keeps: bool,
    ) -> u32 {
        if count <= 4
            && let (Some(pixels), Some(bytes)) = (pixels.first_chunk_mut(), bytes.first_chunk())
            && let Some(cells) = cells.first_chunk_mut()
        {
            let stay = self.four_stay(cells, depths, count, keeps);
            // SAFETY: `self` proves that the processor has the instructions.
            unsafe {
                let stays = _mm_shuffle_epi8(stay, _mm_set1_epi32(0x0C08_0400));
                let [new, old] = [*bytes, *pixels].map(|four| _mm_cvtsi32_si128(i32::from_le_bytes(four)));
                *pixels = _mm_cvtsi128_si32(_mm_blendv_epi8(new, old, stays)).to_le_bytes();
                4 - _mm_movemask_ps(_mm_castsi128_ps(stay)).count_ones()
            }
        } else {
            let stay = self.eight_stay(cells, depths, count, keeps);
            copy_block(pixels, bytes, u64::from_le_bytes(self.low_bytes(stay)));
            8 - self.to_bitmask(stay).count_ones()
        }
    }

    #[inline(always)]
    fn compress_i32<const N: usize>(self, mask: __m256i, from: [__m256i; N], to: [&mut [u32; 8]; N]) {
        // Eight bits.
        let set = SET_LANES[self.to_bitmask(mask) as usize % 256].cast_signed();
        for (i, to) in to.into_iter().enumerate() {
            // SAFETY: `self` proves that the processor has the instructions; the store goes to a whole array.
            unsafe {
                let front = _mm256_permutevar8x32_epi32(from[i], _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(set)));
                _mm256_storeu_si256(to.as_mut_ptr().cast(), front);
            }
        }
    }
    #[inline(always)]
    fn compress_i64<const N: usize>(self, mask: __m256i, from: [I64; N], to: [&mut [i64; 8]; N]) {
        let bits = self.to_bitmask(mask) as usize;
        let set = [SET_PAIRS[bits % 16].cast_signed(), SET_PAIRS[bits / 16 % 16].cast_signed()];
        let low = (bits % 16).count_ones() as usize;
        for (i, to) in to.into_iter().enumerate() {
            // SAFETY: `self` proves that the processor has the instructions. The first store goes
            // to the first four of eight, the second to four that begin after at most four of them.
            unsafe {
                let to = to.as_mut_ptr();
                for (half, to) in [to, to.add(low)].into_iter().enumerate() {
                    let lanes = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(set[half]));
                    _mm256_storeu_si256(to.cast(), _mm256_permutevar8x32_epi32(from[i][half], lanes));
                }
            }
        }
    }
}

impl Avx2 {
    /// −1 where one of four pixels stays: its depth is not greater than its cell, or it is not among the first `count`.
    /// Depths are those of [`Lanes8::test_four`]; with `keeps` the cells store greater ones.
    #[inline(always)]
    pub(crate) fn four_stay(self, cells: &mut [u32; 4], [z, dz]: [i64; 2], count: usize, keeps: bool) -> __m128i {
        // SAFETY: `self` proves that the processor has the instructions. The mask is the first four of sixteen lanes;
        // cells are loaded and stored as a whole. Neither requires alignment.
        unsafe {
            let dz = _mm_set1_epi64x(dz);
            let first = _mm_add_epi64(_mm_set1_epi64x(z), _mm_unpacklo_epi64(_mm_setzero_si128(), dz));
            let last = _mm_castsi128_ps(_mm_add_epi64(first, _mm_slli_epi64::<1>(dz)));
            let upper = _mm_castps_si128(_mm_shuffle_ps::<0b11_01_11_01>(_mm_castsi128_ps(first), last));
            let there = _mm_loadu_si128(FIRST_LANES[count.min(16)].as_ptr().cast());
            let before = _mm_loadu_si128(cells.as_ptr().cast());
            let after = _mm_max_epu32(before, _mm_and_si128(upper, there));
            if keeps {
                _mm_storeu_si128(cells.as_mut_ptr().cast(), after);
            }
            _mm_cmpeq_epi32(before, after)
        }
    }

    /// [`four_stay`](Self::four_stay) for eight pixels.
    #[inline(always)]
    fn eight_stay(self, cells: &mut [u32; 8], [z, dz]: [i64; 2], count: usize, keeps: bool) -> __m256i {
        // SAFETY: as in `four_stay`, with eight lanes.
        unsafe {
            // Arranged so that the upper halves of both are pixels 0 to 7: 0, 1, 4, 5 and 2, 3, 6, 7.
            let dz = _mm256_set1_epi64x(dz);
            let odd = _mm256_and_si256(dz, _mm256_setr_epi64x(0, -1, 0, -1));
            let later = _mm256_and_si256(_mm256_slli_epi64::<2>(dz), _mm256_setr_epi64x(0, 0, -1, -1));
            let first = _mm256_add_epi64(_mm256_add_epi64(_mm256_set1_epi64x(z), odd), later);
            let last = _mm256_castsi256_ps(_mm256_add_epi64(first, _mm256_slli_epi64::<1>(dz)));
            let upper = _mm256_shuffle_ps::<0b11_01_11_01>(_mm256_castsi256_ps(first), last);
            let there = _mm256_loadu_si256(FIRST_LANES[count.min(16)].as_ptr().cast());
            let before = _mm256_loadu_si256(cells.as_ptr().cast());
            let after = _mm256_max_epu32(before, _mm256_and_si256(_mm256_castps_si256(upper), there));
            if keeps {
                _mm256_storeu_si256(cells.as_mut_ptr().cast(), after);
            }
            _mm256_cmpeq_epi32(before, after)
        }
    }
}

#[cfg(feature = "alloc")]
impl F32Lanes8 for Avx2 {
    singles_of_256_bits! {
        fn is_at_least(a: __m256, b: __m256) -> __m256i { _mm256_castps_si256(_mm256_cmp_ps::<_CMP_GE_OQ>(a, b)) }
        fn widen(from: __m256) -> F64 {
            [_mm256_cvtps_pd(_mm256_castps256_ps128(from)), _mm256_cvtps_pd(_mm256_extractf128_ps::<1>(from))]
        }
        fn narrow(from: F64) -> __m256 { _mm256_set_m128(_mm256_cvtpd_ps(from[1]), _mm256_cvtpd_ps(from[0])) }
        fn whole(from: F64) -> __m256i { _mm256_set_m128i(_mm256_cvttpd_epi32(from[1]), _mm256_cvttpd_epi32(from[0])) }
        fn sqrt(of: F64) -> F64 { halves!(h => _mm256_sqrt_pd(of[h])) }
        fn if_less(a: F64, b: F64, value: F64) -> F64 {
            halves!(h => _mm256_and_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(a[h], b[h]), value[h]))
        }
        fn is_zero(values: F64) -> bool {
            let bits = _mm256_castpd_si256(_mm256_or_pd(values[0], values[1]));
            _mm256_testz_si256(bits, bits) == 1
        }
    }
}
