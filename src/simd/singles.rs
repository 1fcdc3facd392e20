//! Eight lanes of f32, in addition to those of [`Lanes8`], for the vertex stages and light at points.

use glam::Vec3;

use super::lanes::inlined;
use super::{Lanes8, Portable};
use crate::fixed::{ROUND_MAGIC, whole_part};
use crate::lanes::each;

/// Operations on eight lanes of f32. Each rounds once, like the operation on a single number.
pub(crate) trait F32Lanes8: Lanes8 {
    /// Eight f32.
    type F32: Copy;

    fn splat_f32(self, value: f32) -> Self::F32;
    /// `low` in lanes 0 to 3, `high` in lanes 4 to 7.
    #[inline(always)]
    fn halves_f32(self, [low, high]: [f32; 2]) -> Self::F32 {
        self.load_f32(&[low, low, low, low, high, high, high, high])
    }
    /// x, y and z of eight vectors.
    fn vectors(self, from: &[Vec3; 8]) -> [Self::F32; 3];
    fn add_f32(self, a: Self::F32, b: Self::F32) -> Self::F32;
    fn sub_f32(self, a: Self::F32, b: Self::F32) -> Self::F32;
    fn mul_f32(self, a: Self::F32, b: Self::F32) -> Self::F32;
    fn div_f32(self, a: Self::F32, b: Self::F32) -> Self::F32;
    /// `a·b + c`, rounded like [`Lanes8::mul_add`].
    #[inline(always)]
    fn mul_add_f32(self, a: Self::F32, b: Self::F32, c: Self::F32) -> Self::F32 {
        self.add_f32(self.mul_f32(a, b), c)
    }
    /// The nearest integers of values within ±2³⁰; arbitrary for others.
    fn nearest_f32(self, from: Self::F32) -> Self::I32;
    /// `a` where it is greater than `b`, otherwise `b`, also if one is NaN.
    fn max_f32(self, a: Self::F32, b: Self::F32) -> Self::F32;
    /// `a` where it is less than `b`, otherwise `b`, also if one is NaN.
    fn min_f32(self, a: Self::F32, b: Self::F32) -> Self::F32;
    /// False where one is NaN.
    fn is_at_least(self, a: Self::F32, b: Self::F32) -> Self::Mask;
    fn bits_of_f32(self, from: Self::F32) -> Self::I32;
    fn widen(self, from: Self::F32) -> Self::F64;
    /// Rounds to the nearest f32, halves to even.
    fn narrow(self, from: Self::F64) -> Self::F32;
    /// The integer parts of values of at least 0 and below 2³¹; arbitrary for others.
    fn whole(self, from: Self::F64) -> Self::I32;
    fn load_f32(self, from: &[f32; 8]) -> Self::F32;
    /// The correctly rounded square root.
    fn sqrt(self, of: Self::F64) -> Self::F64;
    /// `value` where `a` is less than `b`, otherwise 0, also if one is NaN.
    fn if_less(self, a: Self::F64, b: Self::F64, value: Self::F64) -> Self::F64;
    /// Returns whether all values are 0; none of them may be −0.
    fn is_zero(self, values: Self::F64) -> bool;
}

impl F32Lanes8 for Portable {
    type F32 = [f32; 8];

    inlined! {
        fn splat_f32(self, value: f32) -> [f32; 8] { [value; 8] }
        fn vectors(self, from: &[Vec3; 8]) -> [[f32; 8]; 3] {
            [each!(i => from[i].x), each!(i => from[i].y), each!(i => from[i].z)]
        }
        fn add_f32(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] { each!(i => a[i] + b[i]) }
        fn sub_f32(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] { each!(i => a[i] - b[i]) }
        fn mul_f32(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] { each!(i => a[i] * b[i]) }
        fn div_f32(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] { each!(i => a[i] / b[i]) }
        fn nearest_f32(self, from: [f32; 8]) -> [i32; 8] {
            // The low bits.
            each!(i => (f64::from(from[i]) + ROUND_MAGIC).to_bits() as i32)
        }
        fn max_f32(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] { each!(i => if a[i] > b[i] { a[i] } else { b[i] }) }
        fn min_f32(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] { each!(i => if a[i] < b[i] { a[i] } else { b[i] }) }
        fn is_at_least(self, a: [f32; 8], b: [f32; 8]) -> [i32; 8] { each!(i => -i32::from(a[i] >= b[i])) }
        fn bits_of_f32(self, from: [f32; 8]) -> [i32; 8] { each!(i => from[i].to_bits().cast_signed()) }
        fn widen(self, from: [f32; 8]) -> [f64; 8] { each!(i => f64::from(from[i])) }
        fn narrow(self, from: [f64; 8]) -> [f32; 8] { each!(i => from[i] as f32) }
        fn whole(self, from: [f64; 8]) -> [i32; 8] { each!(i => whole_part(from[i])) }
        fn load_f32(self, from: &[f32; 8]) -> [f32; 8] { *from }
        fn sqrt(self, of: [f64; 8]) -> [f64; 8] {
            // Both give the same number. The compiler vectorises the first.
            #[cfg(feature = "std")]
            return each!(i => of[i].sqrt());
            #[cfg(not(feature = "std"))]
            return each!(i => libm::sqrt(of[i]));
        }
        fn if_less(self, a: [f64; 8], b: [f64; 8], value: [f64; 8]) -> [f64; 8] {
            each!(i => if a[i] < b[i] { value[i] } else { 0.0 })
        }
        fn is_zero(self, values: [f64; 8]) -> bool {
            let (mut bits, mut i) = (0, 0);
            while i < 8 {
                bits |= values[i].to_bits();
                i += 1;
            }
            bits == 0
        }
    }
}

/// x, y and z of four vectors, from three vectors of four numbers that hold them in order. `$shuffle::<N>(a, b)` takes
/// two numbers from each of its operands, selected by two bits of `N` for each number, the lowest first; wider vectors
/// are shuffled in each 128 bits.
#[cfg(simd_x86_64)]
macro_rules! apart {
    ($shuffle:ident, $a:expr, $b:expr, $c:expr) => {{
        // x y z x | y z x y | z x y z
        let (a, b, c) = ($a, $b, $c);
        let xy = $shuffle::<0b10_01_11_10>(b, c);
        let yz = $shuffle::<0b01_00_10_01>(a, b);
        [$shuffle::<0b10_00_11_00>(a, xy), $shuffle::<0b11_01_10_00>(yz, xy), $shuffle::<0b11_00_11_01>(yz, c)]
    }};
}
#[cfg(simd_x86_64)]
pub(super) use apart;

/// The 256-bit operations that AVX2 and AVX-512 share.
#[cfg(simd_x86_64)]
macro_rules! singles_of_256_bits {
    ($($rest:tt)*) => {
        type F32 = __m256;

        intrinsics! {
            fn splat_f32(value: f32) -> __m256 { _mm256_set1_ps(value) }
            fn vectors(from: &[Vec3; 8]) -> [__m256; 3] {
                const { assert!(size_of::<Vec3>() == 12) };
                // 24 f32: a `Vec3` is three of them in this order, without padding. Each load takes four, from index 0,
                // 4, 8, 12, 16 or 20 on.
                let from: *const f32 = from.as_ptr().cast();
                let a = _mm256_set_m128(_mm_loadu_ps(from.add(12)), _mm_loadu_ps(from));
                let b = _mm256_set_m128(_mm_loadu_ps(from.add(16)), _mm_loadu_ps(from.add(4)));
                let c = _mm256_set_m128(_mm_loadu_ps(from.add(20)), _mm_loadu_ps(from.add(8)));
                crate::simd::singles::apart!(_mm256_shuffle_ps, a, b, c)
            }
            fn add_f32(a: __m256, b: __m256) -> __m256 { _mm256_add_ps(a, b) }
            fn sub_f32(a: __m256, b: __m256) -> __m256 { _mm256_sub_ps(a, b) }
            fn mul_f32(a: __m256, b: __m256) -> __m256 { _mm256_mul_ps(a, b) }
            fn div_f32(a: __m256, b: __m256) -> __m256 { _mm256_div_ps(a, b) }
            fn mul_add_f32(a: __m256, b: __m256, c: __m256) -> __m256 { _mm256_fmadd_ps(a, b, c) }
            fn nearest_f32(from: __m256) -> __m256i { _mm256_cvtps_epi32(from) }
            fn max_f32(a: __m256, b: __m256) -> __m256 { _mm256_max_ps(a, b) }
            fn min_f32(a: __m256, b: __m256) -> __m256 { _mm256_min_ps(a, b) }
            fn bits_of_f32(from: __m256) -> __m256i { _mm256_castps_si256(from) }
            fn load_f32(from: &[f32; 8]) -> __m256 { _mm256_loadu_ps(from.as_ptr()) }
            $($rest)*
        }
    };
}
#[cfg(simd_x86_64)]
pub(super) use singles_of_256_bits;
