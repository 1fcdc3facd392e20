//! [`Vector128`] with WebAssembly's vectors.

use core::arch::wasm32::*;

#[cfg(feature = "alloc")]
use glam::Vec3;

use super::lanes::intrinsics;
#[cfg(feature = "alloc")]
use super::wide128::Singles128;
use super::wide128::Vector128;

/// The level of the target.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Simd128;

#[allow(unused_unsafe, reason = "loads and stores alone are unsafe")]
impl Vector128 for Simd128 {
    type F = v128;
    type I = v128;

    intrinsics! {
        fn load_f64(from: &[f64; 2]) -> v128 { v128_load(from.as_ptr().cast()) }
        fn splat_f64(value: f64) -> v128 { f64x2_splat(value) }
        fn store_f64(from: v128, to: &mut [f64; 2]) { v128_store(to.as_mut_ptr().cast(), from) }
        fn add_f64(a: v128, b: v128) -> v128 { f64x2_add(a, b) }
        fn sub_f64(a: v128, b: v128) -> v128 { f64x2_sub(a, b) }
        fn mul_f64(a: v128, b: v128) -> v128 { f64x2_mul(a, b) }
        fn div_f64(a: v128, b: v128) -> v128 { f64x2_div(a, b) }
        fn mul_add(a: v128, b: v128, c: v128) -> v128 { f64x2_add(f64x2_mul(a, b), c) }
        fn neg_mul_add(a: v128, b: v128, c: v128) -> v128 { f64x2_sub(c, f64x2_mul(a, b)) }
        fn min_f64(a: v128, b: v128) -> v128 { f64x2_pmin(a, b) }
        fn max_f64(a: v128, b: v128) -> v128 { f64x2_pmax(a, b) }
        fn is_less(a: v128, b: v128) -> v128 { f64x2_lt(a, b) }
        fn bits(from: v128) -> v128 { from }
        fn of_bits(from: v128) -> v128 { from }
        fn low_to_f64(from: v128) -> v128 { f64x2_convert_low_i32x4(from) }

        fn load(from: &[i32; 4]) -> v128 { v128_load(from.as_ptr().cast()) }
        fn splat(value: i32) -> v128 { i32x4_splat(value) }
        fn store(from: v128, to: &mut [i32; 4]) { v128_store(to.as_mut_ptr().cast(), from) }
        fn add(a: v128, b: v128) -> v128 { i32x4_add(a, b) }
        fn sub(a: v128, b: v128) -> v128 { i32x4_sub(a, b) }
        fn mul(a: v128, b: v128) -> v128 { i32x4_mul(a, b) }
        fn and(a: v128, b: v128) -> v128 { v128_and(a, b) }
        fn or(a: v128, b: v128) -> v128 { v128_or(a, b) }
        fn xor(a: v128, b: v128) -> v128 { v128_xor(a, b) }
        fn and_not(a: v128, b: v128) -> v128 { v128_andnot(a, b) }
        fn shl(a: v128, by: i32) -> v128 { i32x4_shl(a, by.cast_unsigned()) }
        fn shr(a: v128, by: i32) -> v128 { i32x4_shr(a, by.cast_unsigned()) }
        fn is_greater(a: v128, b: v128) -> v128 { i32x4_gt(a, b) }
        fn is_equal(a: v128, b: v128) -> v128 { i32x4_eq(a, b) }
        fn min(a: v128, b: v128) -> v128 { i32x4_min(a, b) }
        fn max(a: v128, b: v128) -> v128 { i32x4_max(a, b) }
        fn interleave_low(a: v128, b: v128) -> v128 { i32x4_shuffle::<0, 4, 1, 5>(a, b) }
        fn interleave_high(a: v128, b: v128) -> v128 { i32x4_shuffle::<2, 6, 3, 7>(a, b) }
        fn even(a: v128, b: v128) -> v128 { i32x4_shuffle::<0, 2, 4, 6>(a, b) }
        fn sign_bits(from: v128) -> u32 { i32x4_bitmask(from).into() }

        fn load_i64(from: &[i64; 2]) -> v128 { v128_load(from.as_ptr().cast()) }
        fn splat_i64(value: i64) -> v128 { i64x2_splat(value) }
        fn store_i64(from: v128, to: &mut [i64; 2]) { v128_store(to.as_mut_ptr().cast(), from) }
        fn add_i64(a: v128, b: v128) -> v128 { i64x2_add(a, b) }
        fn sub_i64(a: v128, b: v128) -> v128 { i64x2_sub(a, b) }
        fn shl_i64(a: v128, by: i32) -> v128 { i64x2_shl(a, by.cast_unsigned()) }
        fn upper(a: v128) -> v128 { u64x2_shr(a, 32) }
        fn mul_low(a: v128, b: v128) -> v128 {
            u64x2_extmul_low_u32x4(i32x4_shuffle::<0, 2, 0, 2>(a, a), i32x4_shuffle::<0, 2, 0, 2>(b, b))
        }
        fn interleave_low_i64(a: v128, b: v128) -> v128 { i64x2_shuffle::<0, 2>(a, b) }
        fn interleave_high_i64(a: v128, b: v128) -> v128 { i64x2_shuffle::<1, 3>(a, b) }
    }
}

#[cfg(feature = "alloc")]
#[allow(unused_unsafe, reason = "loads and stores alone are unsafe")]
impl Singles128 for Simd128 {
    type S = v128;

    intrinsics! {
        fn splat_f32(value: f32) -> v128 { f32x4_splat(value) }
        fn vectors(from: &[Vec3; 4]) -> [v128; 3] {
            const { assert!(size_of::<Vec3>() == 12) };
            // 12 f32: a `Vec3` is three of them in this order, without padding. x y z x | y z x y | z x y z
            let from: *const v128 = from.as_ptr().cast();
            let (a, b, c) = (v128_load(from), v128_load(from.add(1)), v128_load(from.add(2)));
            [
                i32x4_shuffle::<0, 1, 2, 5>(i32x4_shuffle::<0, 3, 6, 0>(a, b), c),
                i32x4_shuffle::<0, 1, 2, 6>(i32x4_shuffle::<1, 4, 7, 0>(a, b), c),
                i32x4_shuffle::<0, 1, 4, 7>(i32x4_shuffle::<2, 5, 0, 0>(a, b), c),
            ]
        }
        fn add_f32(a: v128, b: v128) -> v128 { f32x4_add(a, b) }
        fn sub_f32(a: v128, b: v128) -> v128 { f32x4_sub(a, b) }
        fn mul_f32(a: v128, b: v128) -> v128 { f32x4_mul(a, b) }
        fn div_f32(a: v128, b: v128) -> v128 { f32x4_div(a, b) }
        fn nearest_f32(from: v128) -> v128 { i32x4_trunc_sat_f32x4(f32x4_nearest(from)) }
        // `pmax(x, y)` is y if that is greater, otherwise x.
        fn max_f32(a: v128, b: v128) -> v128 { f32x4_pmax(b, a) }
        fn min_f32(a: v128, b: v128) -> v128 { f32x4_pmin(b, a) }
        fn is_at_least(a: v128, b: v128) -> v128 { f32x4_ge(a, b) }
        fn bits_of_f32(from: v128) -> v128 { from }
        fn widen_low(from: v128) -> v128 { f64x2_promote_low_f32x4(from) }
        fn widen_high(from: v128) -> v128 { f64x2_promote_low_f32x4(i64x2_shuffle::<1, 0>(from, from)) }
        fn narrow(low: v128, high: v128) -> v128 {
            i64x2_shuffle::<0, 2>(f32x4_demote_f64x2_zero(low), f32x4_demote_f64x2_zero(high))
        }
        fn whole(low: v128, high: v128) -> v128 {
            i64x2_shuffle::<0, 2>(i32x4_trunc_sat_f64x2_zero(low), i32x4_trunc_sat_f64x2_zero(high))
        }
        fn load_f32(from: &[f32; 4]) -> v128 { v128_load(from.as_ptr().cast()) }
        fn sqrt(of: v128) -> v128 { f64x2_sqrt(of) }
    }
}
