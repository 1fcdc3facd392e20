//! [`Vector128`] with NEON, which every 64-bit ARM processor has.

use core::arch::aarch64::*;

#[cfg(feature = "alloc")]
use glam::Vec3;

use super::lanes::intrinsics;
#[cfg(feature = "alloc")]
use super::wide128::Singles128;
use super::wide128::Vector128;

/// The level of the target.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Neon;

impl Vector128 for Neon {
    type F = float64x2_t;
    type I = int32x4_t;

    intrinsics! {
        fn load_f64(from: &[f64; 2]) -> float64x2_t { vld1q_f64(from.as_ptr()) }
        fn splat_f64(value: f64) -> float64x2_t { vdupq_n_f64(value) }
        fn store_f64(from: float64x2_t, to: &mut [f64; 2]) { vst1q_f64(to.as_mut_ptr(), from) }
        fn add_f64(a: float64x2_t, b: float64x2_t) -> float64x2_t { vaddq_f64(a, b) }
        fn sub_f64(a: float64x2_t, b: float64x2_t) -> float64x2_t { vsubq_f64(a, b) }
        fn mul_f64(a: float64x2_t, b: float64x2_t) -> float64x2_t { vmulq_f64(a, b) }
        fn div_f64(a: float64x2_t, b: float64x2_t) -> float64x2_t { vdivq_f64(a, b) }
        fn mul_add(a: float64x2_t, b: float64x2_t, c: float64x2_t) -> float64x2_t { vfmaq_f64(c, a, b) }
        fn neg_mul_add(a: float64x2_t, b: float64x2_t, c: float64x2_t) -> float64x2_t { vfmsq_f64(c, a, b) }
        fn min_f64(a: float64x2_t, b: float64x2_t) -> float64x2_t { vminq_f64(a, b) }
        fn max_f64(a: float64x2_t, b: float64x2_t) -> float64x2_t { vmaxq_f64(a, b) }
        fn is_less(a: float64x2_t, b: float64x2_t) -> int32x4_t { vreinterpretq_s32_u64(vcltq_f64(a, b)) }
        fn bits(from: float64x2_t) -> int32x4_t { vreinterpretq_s32_f64(from) }
        fn of_bits(from: int32x4_t) -> float64x2_t { vreinterpretq_f64_s32(from) }
        fn low_to_f64(from: int32x4_t) -> float64x2_t { vcvtq_f64_s64(vmovl_s32(vget_low_s32(from))) }

        fn load(from: &[i32; 4]) -> int32x4_t { vld1q_s32(from.as_ptr()) }
        fn splat(value: i32) -> int32x4_t { vdupq_n_s32(value) }
        fn store(from: int32x4_t, to: &mut [i32; 4]) { vst1q_s32(to.as_mut_ptr(), from) }
        fn add(a: int32x4_t, b: int32x4_t) -> int32x4_t { vaddq_s32(a, b) }
        fn sub(a: int32x4_t, b: int32x4_t) -> int32x4_t { vsubq_s32(a, b) }
        fn mul(a: int32x4_t, b: int32x4_t) -> int32x4_t { vmulq_s32(a, b) }
        fn and(a: int32x4_t, b: int32x4_t) -> int32x4_t { vandq_s32(a, b) }
        fn or(a: int32x4_t, b: int32x4_t) -> int32x4_t { vorrq_s32(a, b) }
        fn xor(a: int32x4_t, b: int32x4_t) -> int32x4_t { veorq_s32(a, b) }
        fn and_not(a: int32x4_t, b: int32x4_t) -> int32x4_t { vbicq_s32(a, b) }
        fn shl(a: int32x4_t, by: i32) -> int32x4_t { vshlq_s32(a, vdupq_n_s32(by)) }
        fn shr(a: int32x4_t, by: i32) -> int32x4_t { vshlq_s32(a, vdupq_n_s32(-by)) }
        fn is_greater(a: int32x4_t, b: int32x4_t) -> int32x4_t { vreinterpretq_s32_u32(vcgtq_s32(a, b)) }
        fn is_equal(a: int32x4_t, b: int32x4_t) -> int32x4_t { vreinterpretq_s32_u32(vceqq_s32(a, b)) }
        fn min(a: int32x4_t, b: int32x4_t) -> int32x4_t { vminq_s32(a, b) }
        fn max(a: int32x4_t, b: int32x4_t) -> int32x4_t { vmaxq_s32(a, b) }
        fn interleave_low(a: int32x4_t, b: int32x4_t) -> int32x4_t { vzip1q_s32(a, b) }
        fn interleave_high(a: int32x4_t, b: int32x4_t) -> int32x4_t { vzip2q_s32(a, b) }
        fn even(a: int32x4_t, b: int32x4_t) -> int32x4_t { vuzp1q_s32(a, b) }
        fn sign_bits(from: int32x4_t) -> u32 {
            let numbers = [0, 1, 2, 3];
            let signs = vshrq_n_u32::<31>(vreinterpretq_u32_s32(from));
            vaddvq_u32(vshlq_u32(signs, vld1q_s32(numbers.as_ptr())))
        }

        fn load_i64(from: &[i64; 2]) -> int32x4_t { vreinterpretq_s32_s64(vld1q_s64(from.as_ptr())) }
        fn splat_i64(value: i64) -> int32x4_t { vreinterpretq_s32_s64(vdupq_n_s64(value)) }
        fn store_i64(from: int32x4_t, to: &mut [i64; 2]) { vst1q_s64(to.as_mut_ptr(), vreinterpretq_s64_s32(from)) }
        fn add_i64(a: int32x4_t, b: int32x4_t) -> int32x4_t {
            vreinterpretq_s32_s64(vaddq_s64(vreinterpretq_s64_s32(a), vreinterpretq_s64_s32(b)))
        }
        fn sub_i64(a: int32x4_t, b: int32x4_t) -> int32x4_t {
            vreinterpretq_s32_s64(vsubq_s64(vreinterpretq_s64_s32(a), vreinterpretq_s64_s32(b)))
        }
        fn shl_i64(a: int32x4_t, by: i32) -> int32x4_t {
            vreinterpretq_s32_s64(vshlq_s64(vreinterpretq_s64_s32(a), vdupq_n_s64(by.into())))
        }
        fn upper(a: int32x4_t) -> int32x4_t { vreinterpretq_s32_u64(vshrq_n_u64::<32>(vreinterpretq_u64_s32(a))) }
        fn mul_low(a: int32x4_t, b: int32x4_t) -> int32x4_t {
            let (a, b) = (vmovn_u64(vreinterpretq_u64_s32(a)), vmovn_u64(vreinterpretq_u64_s32(b)));
            vreinterpretq_s32_u64(vmull_u32(a, b))
        }
        fn interleave_low_i64(a: int32x4_t, b: int32x4_t) -> int32x4_t {
            vreinterpretq_s32_s64(vzip1q_s64(vreinterpretq_s64_s32(a), vreinterpretq_s64_s32(b)))
        }
        fn interleave_high_i64(a: int32x4_t, b: int32x4_t) -> int32x4_t {
            vreinterpretq_s32_s64(vzip2q_s64(vreinterpretq_s64_s32(a), vreinterpretq_s64_s32(b)))
        }
    }
}

#[cfg(feature = "alloc")]
impl Singles128 for Neon {
    type S = float32x4_t;

    intrinsics! {
        fn splat_f32(value: f32) -> float32x4_t { vdupq_n_f32(value) }
        fn vectors(from: &[Vec3; 4]) -> [float32x4_t; 3] {
            const { assert!(size_of::<Vec3>() == 12) };
            // 12 f32: a `Vec3` is three of them in this order, without padding.
            let float32x4x3_t(x, y, z) = vld3q_f32(from.as_ptr().cast());
            [x, y, z]
        }
        fn add_f32(a: float32x4_t, b: float32x4_t) -> float32x4_t { vaddq_f32(a, b) }
        fn sub_f32(a: float32x4_t, b: float32x4_t) -> float32x4_t { vsubq_f32(a, b) }
        fn mul_f32(a: float32x4_t, b: float32x4_t) -> float32x4_t { vmulq_f32(a, b) }
        fn div_f32(a: float32x4_t, b: float32x4_t) -> float32x4_t { vdivq_f32(a, b) }
        fn nearest_f32(from: float32x4_t) -> int32x4_t { vcvtnq_s32_f32(from) }
        fn max_f32(a: float32x4_t, b: float32x4_t) -> float32x4_t { vbslq_f32(vcgtq_f32(a, b), a, b) }
        fn min_f32(a: float32x4_t, b: float32x4_t) -> float32x4_t { vbslq_f32(vcltq_f32(a, b), a, b) }
        fn is_at_least(a: float32x4_t, b: float32x4_t) -> int32x4_t { vreinterpretq_s32_u32(vcgeq_f32(a, b)) }
        fn bits_of_f32(from: float32x4_t) -> int32x4_t { vreinterpretq_s32_f32(from) }
        fn widen_low(from: float32x4_t) -> float64x2_t { vcvt_f64_f32(vget_low_f32(from)) }
        fn widen_high(from: float32x4_t) -> float64x2_t { vcvt_high_f64_f32(from) }
        fn narrow(low: float64x2_t, high: float64x2_t) -> float32x4_t { vcvt_high_f32_f64(vcvt_f32_f64(low), high) }
        fn whole(low: float64x2_t, high: float64x2_t) -> int32x4_t {
            vmovn_high_s64(vmovn_s64(vcvtq_s64_f64(low)), vcvtq_s64_f64(high))
        }
        fn load_f32(from: &[f32; 4]) -> float32x4_t { vld1q_f32(from.as_ptr()) }
        fn sqrt(of: float64x2_t) -> float64x2_t { vsqrtq_f64(of) }
    }
}
