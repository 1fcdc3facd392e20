//! [`Lanes8`] with 128-bit vectors: four for 64-bit lanes, two for 32-bit ones. One implementation for SSE2, NEON and
//! wasm.

#[cfg(feature = "alloc")]
use glam::Vec3;

use super::lanes::{Lanes8, inlined};
#[cfg(feature = "alloc")]
use super::singles::F32Lanes8;

/// 128-bit vectors: a pair of f64, four i32, or two i64.
///
/// A value of such a type proves that the processor has them.
pub(crate) trait Vector128: Copy {
    type F: Copy;
    /// Four i32 or two i64. Sums, differences and products wrap.
    type I: Copy;

    fn load_f64(self, from: &[f64; 2]) -> Self::F;
    fn splat_f64(self, value: f64) -> Self::F;
    fn store_f64(self, from: Self::F, to: &mut [f64; 2]);
    fn add_f64(self, a: Self::F, b: Self::F) -> Self::F;
    fn sub_f64(self, a: Self::F, b: Self::F) -> Self::F;
    fn mul_f64(self, a: Self::F, b: Self::F) -> Self::F;
    fn div_f64(self, a: Self::F, b: Self::F) -> Self::F;
    /// `a·b + c`, fused if there is such an instruction.
    fn mul_add(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F;
    /// `c − a·b`, fused if there is such an instruction.
    fn neg_mul_add(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F;
    fn min_f64(self, a: Self::F, b: Self::F) -> Self::F;
    fn max_f64(self, a: Self::F, b: Self::F) -> Self::F;
    /// −1 or 0 in two lanes of 64 bits.
    fn is_less(self, a: Self::F, b: Self::F) -> Self::I;
    fn bits(self, from: Self::F) -> Self::I;
    fn of_bits(self, from: Self::I) -> Self::F;
    /// Converts the first two of four i32.
    fn low_to_f64(self, from: Self::I) -> Self::F;

    fn load(self, from: &[i32; 4]) -> Self::I;
    fn splat(self, value: i32) -> Self::I;
    fn store(self, from: Self::I, to: &mut [i32; 4]);
    fn add(self, a: Self::I, b: Self::I) -> Self::I;
    fn sub(self, a: Self::I, b: Self::I) -> Self::I;
    fn mul(self, a: Self::I, b: Self::I) -> Self::I;
    fn and(self, a: Self::I, b: Self::I) -> Self::I;
    fn or(self, a: Self::I, b: Self::I) -> Self::I;
    fn xor(self, a: Self::I, b: Self::I) -> Self::I;
    /// `a` and not `b`.
    fn and_not(self, a: Self::I, b: Self::I) -> Self::I;
    fn shl(self, a: Self::I, by: i32) -> Self::I;
    fn shr(self, a: Self::I, by: i32) -> Self::I;
    /// −1 or 0 in four lanes.
    fn is_greater(self, a: Self::I, b: Self::I) -> Self::I;
    fn is_equal(self, a: Self::I, b: Self::I) -> Self::I;
    fn min(self, a: Self::I, b: Self::I) -> Self::I;
    fn max(self, a: Self::I, b: Self::I) -> Self::I;
    /// `[a0, b0, a1, b1]`
    fn interleave_low(self, a: Self::I, b: Self::I) -> Self::I;
    /// `[a2, b2, a3, b3]`
    fn interleave_high(self, a: Self::I, b: Self::I) -> Self::I;
    /// `[a0, a2, b0, b2]`
    fn even(self, a: Self::I, b: Self::I) -> Self::I;
    /// The sign bits of four lanes.
    fn sign_bits(self, from: Self::I) -> u32;

    fn load_i64(self, from: &[i64; 2]) -> Self::I;
    fn splat_i64(self, value: i64) -> Self::I;
    fn store_i64(self, from: Self::I, to: &mut [i64; 2]);
    fn add_i64(self, a: Self::I, b: Self::I) -> Self::I;
    fn sub_i64(self, a: Self::I, b: Self::I) -> Self::I;
    fn shl_i64(self, a: Self::I, by: i32) -> Self::I;
    /// The upper halves of two i64, zero-extended.
    fn upper(self, a: Self::I) -> Self::I;
    /// Products of the lower halves of two i64, as u32.
    fn mul_low(self, a: Self::I, b: Self::I) -> Self::I;
    /// `[a0, b0]` of i64
    fn interleave_low_i64(self, a: Self::I, b: Self::I) -> Self::I;
    /// `[a1, b1]` of i64
    fn interleave_high_i64(self, a: Self::I, b: Self::I) -> Self::I;
}

/// Vectors of four f32 as well. The rules of [`F32Lanes8`] hold here too.
#[cfg(feature = "alloc")]
pub(crate) trait Singles128: Vector128 {
    type S: Copy;

    fn splat_f32(self, value: f32) -> Self::S;
    fn vectors(self, from: &[Vec3; 4]) -> [Self::S; 3];
    fn add_f32(self, a: Self::S, b: Self::S) -> Self::S;
    fn sub_f32(self, a: Self::S, b: Self::S) -> Self::S;
    fn mul_f32(self, a: Self::S, b: Self::S) -> Self::S;
    fn div_f32(self, a: Self::S, b: Self::S) -> Self::S;
    fn nearest_f32(self, from: Self::S) -> Self::I;
    fn max_f32(self, a: Self::S, b: Self::S) -> Self::S;
    fn min_f32(self, a: Self::S, b: Self::S) -> Self::S;
    fn is_at_least(self, a: Self::S, b: Self::S) -> Self::I;
    fn bits_of_f32(self, from: Self::S) -> Self::I;
    /// Widens the first two of four.
    fn widen_low(self, from: Self::S) -> Self::F;
    /// Widens the last two.
    fn widen_high(self, from: Self::S) -> Self::F;
    fn narrow(self, low: Self::F, high: Self::F) -> Self::S;
    fn whole(self, low: Self::F, high: Self::F) -> Self::I;
    fn load_f32(self, from: &[f32; 4]) -> Self::S;
    fn sqrt(self, of: Self::F) -> Self::F;
}

/// Four vectors for eight 64-bit lanes, two for eight 32-bit ones.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wide128<V>(pub(crate) V);

/// An array of four values, one for each of four vectors.
macro_rules! each4 {
    ($i:ident => $value:expr) => {{
        let $i = 0;
        let a = $value;
        let $i = 1;
        let b = $value;
        let $i = 2;
        let c = $value;
        let $i = 3;
        [a, b, c, $value]
    }};
}

/// An array of two values, one for each of two vectors.
macro_rules! each2 {
    ($i:ident => $value:expr) => {{
        let $i = 0;
        let a = $value;
        let $i = 1;
        [a, $value]
    }};
}

/// Elements 2·`i` and 2·`i` + 1 of eight.
#[inline(always)]
fn pair<T>(eight: &[T; 8], i: usize) -> &[T; 2] {
    &eight.as_chunks::<2>().0[i]
}

#[inline(always)]
fn pair_mut<T>(eight: &mut [T; 8], i: usize) -> &mut [T; 2] {
    &mut eight.as_chunks_mut::<2>().0[i]
}

impl<V: Vector128> Wide128<V> {
    /// `a` where the mask is set, otherwise `b`.
    #[inline(always)]
    fn choose(self, mask: V::I, a: V::I, b: V::I) -> V::I {
        self.0.or(self.0.and(a, mask), self.0.and_not(b, mask))
    }

    /// Pairs eight 32-bit lanes with eight others: they become the lower and the upper halves of 64-bit lanes.
    #[inline(always)]
    fn with_upper(self, lower: [V::I; 2], upper: [V::I; 2]) -> [V::I; 4] {
        let v = self.0;
        [
            v.interleave_low(lower[0], upper[0]),
            v.interleave_high(lower[0], upper[0]),
            v.interleave_low(lower[1], upper[1]),
            v.interleave_high(lower[1], upper[1]),
        ]
    }
}

impl<V: Vector128> Lanes8 for Wide128<V> {
    type F64 = [V::F; 4];
    type I32 = [V::I; 2];
    type I64 = [V::I; 4];
    /// −1 in the set lanes, 0 in the others.
    type Mask = [V::I; 2];

    inlined! {
        fn load_f64(self, from: &[f64; 8]) -> Self::F64 { each4!(i => self.0.load_f64(pair(from, i))) }
        fn splat_f64(self, value: f64) -> Self::F64 { [self.0.splat_f64(value); 4] }
        fn store_f64(self, from: Self::F64, to: &mut [f64; 8]) {
            each4!(i => self.0.store_f64(from[i], pair_mut(to, i)));
        }
        fn add(self, a: Self::F64, b: Self::F64) -> Self::F64 { each4!(i => self.0.add_f64(a[i], b[i])) }
        fn sub(self, a: Self::F64, b: Self::F64) -> Self::F64 { each4!(i => self.0.sub_f64(a[i], b[i])) }
        fn mul(self, a: Self::F64, b: Self::F64) -> Self::F64 { each4!(i => self.0.mul_f64(a[i], b[i])) }
        fn div(self, a: Self::F64, b: Self::F64) -> Self::F64 { each4!(i => self.0.div_f64(a[i], b[i])) }
        fn mul_add(self, a: Self::F64, b: Self::F64, c: Self::F64) -> Self::F64 {
            each4!(i => self.0.mul_add(a[i], b[i], c[i]))
        }
        fn neg_mul_add(self, a: Self::F64, b: Self::F64, c: Self::F64) -> Self::F64 {
            each4!(i => self.0.neg_mul_add(a[i], b[i], c[i]))
        }
        fn min(self, a: Self::F64, b: Self::F64) -> Self::F64 { each4!(i => self.0.min_f64(a[i], b[i])) }
        fn max(self, a: Self::F64, b: Self::F64) -> Self::F64 { each4!(i => self.0.max_f64(a[i], b[i])) }
        fn xor_sign(self, a: Self::F64, sign: Self::F64) -> Self::F64 {
            let v = self.0;
            let highest = v.splat_i64(i64::MIN);
            each4!(i => v.of_bits(v.xor(v.bits(a[i]), v.and(v.bits(sign[i]), highest))))
        }
        fn is_less(self, a: Self::F64, b: Self::F64) -> Self::Mask {
            let less = each4!(i => self.0.is_less(a[i], b[i]));
            [self.0.even(less[0], less[1]), self.0.even(less[2], less[3])]
        }
        fn select(self, mask: Self::Mask, a: Self::F64, b: Self::F64) -> Self::F64 {
            let (v, mask) = (self.0, self.with_upper(mask, mask));
            each4!(i => v.of_bits(self.choose(mask[i], v.bits(a[i]), v.bits(b[i]))))
        }
        fn to_f64(self, from: Self::I32) -> Self::F64 {
            let v = self.0;
            let [a, b] = from;
            [
                v.low_to_f64(a),
                v.low_to_f64(v.interleave_high_i64(a, a)),
                v.low_to_f64(b),
                v.low_to_f64(v.interleave_high_i64(b, b)),
            ]
        }
        fn unsigned_to_f64(self, from: Self::I32) -> Self::F64 {
            // Subtracts 2³¹, and adds it again: both are exact.
            let highest = self.0.splat(i32::MIN);
            let signed = self.to_f64(each2!(i => self.0.xor(from[i], highest)));
            self.add(signed, self.splat_f64(2_147_483_648.0))
        }
        fn low_bits(self, from: Self::F64) -> Self::I32 {
            let v = self.0;
            [v.even(v.bits(from[0]), v.bits(from[1])), v.even(v.bits(from[2]), v.bits(from[3]))]
        }
        fn bits(self, from: Self::F64) -> Self::I64 { each4!(i => self.0.bits(from[i])) }

        fn load_i32(self, from: &[i32; 8]) -> Self::I32 { each2!(i => self.0.load(&from.as_chunks::<4>().0[i])) }
        fn splat_i32(self, value: i32) -> Self::I32 { [self.0.splat(value); 2] }
        fn store_i32(self, from: Self::I32, to: &mut [i32; 8]) {
            each2!(i => self.0.store(from[i], &mut to.as_chunks_mut::<4>().0[i]));
        }
        fn add_i32(self, a: Self::I32, b: Self::I32) -> Self::I32 { each2!(i => self.0.add(a[i], b[i])) }
        fn sub_i32(self, a: Self::I32, b: Self::I32) -> Self::I32 { each2!(i => self.0.sub(a[i], b[i])) }
        fn mul_i32(self, a: Self::I32, b: Self::I32) -> Self::I32 { each2!(i => self.0.mul(a[i], b[i])) }
        fn min_i32(self, a: Self::I32, b: Self::I32) -> Self::I32 { each2!(i => self.0.min(a[i], b[i])) }
        fn max_i32(self, a: Self::I32, b: Self::I32) -> Self::I32 { each2!(i => self.0.max(a[i], b[i])) }
        fn and_i32(self, a: Self::I32, b: Self::I32) -> Self::I32 { each2!(i => self.0.and(a[i], b[i])) }
        fn or_i32(self, a: Self::I32, b: Self::I32) -> Self::I32 { each2!(i => self.0.or(a[i], b[i])) }
        fn xor_i32(self, a: Self::I32, b: Self::I32) -> Self::I32 { each2!(i => self.0.xor(a[i], b[i])) }
        fn shl_i32(self, a: Self::I32, by: i32) -> Self::I32 { each2!(i => self.0.shl(a[i], by)) }
        fn shr_i32(self, a: Self::I32, by: i32) -> Self::I32 { each2!(i => self.0.shr(a[i], by)) }
        fn is_greater(self, a: Self::I32, b: Self::I32) -> Self::Mask { each2!(i => self.0.is_greater(a[i], b[i])) }
        fn is_equal(self, a: Self::I32, b: Self::I32) -> Self::Mask { each2!(i => self.0.is_equal(a[i], b[i])) }
        fn select_i32(self, mask: Self::Mask, a: Self::I32, b: Self::I32) -> Self::I32 {
            each2!(i => self.choose(mask[i], a[i], b[i]))
        }
        fn interleave_i32(self, a: Self::I32, b: Self::I32) -> [Self::I32; 2] {
            each2!(i => [self.0.interleave_low(a[i], b[i]), self.0.interleave_high(a[i], b[i])])
        }

        fn load_i64(self, from: &[i64; 8]) -> Self::I64 { each4!(i => self.0.load_i64(pair(from, i))) }
        fn splat_i64(self, value: i64) -> Self::I64 { [self.0.splat_i64(value); 4] }
        fn halves_i64(self, low: i64, high: i64) -> Self::I64 {
            let (low, high) = (self.0.splat_i64(low), self.0.splat_i64(high));
            [low, low, high, high]
        }
        fn store_i64(self, from: Self::I64, to: &mut [i64; 8]) {
            each4!(i => self.0.store_i64(from[i], pair_mut(to, i)));
        }
        fn add_i64(self, a: Self::I64, b: Self::I64) -> Self::I64 { each4!(i => self.0.add_i64(a[i], b[i])) }
        fn sub_i64(self, a: Self::I64, b: Self::I64) -> Self::I64 { each4!(i => self.0.sub_i64(a[i], b[i])) }
        fn mul_i64(self, a: Self::I64, b: Self::I64) -> Self::I64 {
            let v = self.0;
            each4!(i => {
                let upper = v.add_i64(v.mul_low(a[i], v.upper(b[i])), v.mul_low(v.upper(a[i]), b[i]));
                v.add_i64(v.mul_low(a[i], b[i]), v.shl_i64(upper, 32))
            })
        }
        fn mul_low_i64(self, a: Self::I64, b: Self::I64) -> Self::I64 {
            let v = self.0;
            each4!(i => v.add_i64(v.mul_low(a[i], b[i]), v.shl_i64(v.mul_low(a[i], v.upper(b[i])), 32)))
        }
        fn shl_i64(self, a: Self::I64, by: i32) -> Self::I64 { each4!(i => self.0.shl_i64(a[i], by)) }
        fn to_i64(self, from: Self::I32) -> Self::I64 { self.with_upper(from, each2!(i => self.0.shr(from[i], 31))) }
        fn unsigned_to_i64(self, from: Self::I32) -> Self::I64 { self.with_upper(from, [self.0.splat(0); 2]) }
        fn halves_of_i64(self, from: Self::I64) -> [Self::I32; 2] {
            let v = self.0;
            let upper = each4!(i => v.upper(from[i]));
            [[v.even(from[0], from[1]), v.even(from[2], from[3])], [v.even(upper[0], upper[1]), v.even(upper[2], upper[3])]]
        }
        fn interleave_i64(self, a: Self::I64, b: Self::I64) -> [Self::I64; 2] {
            let v = self.0;
            let zip = |i: usize| [v.interleave_low_i64(a[i], b[i]), v.interleave_high_i64(a[i], b[i])];
            let [[a, b], [c, d], [e, f], [g, h]] = [zip(0), zip(1), zip(2), zip(3)];
            [[a, b, c, d], [e, f, g, h]]
        }

        fn and(self, a: Self::Mask, b: Self::Mask) -> Self::Mask { each2!(i => self.0.and(a[i], b[i])) }
        fn and_not(self, a: Self::Mask, b: Self::Mask) -> Self::Mask { each2!(i => self.0.and_not(a[i], b[i])) }
        fn to_bitmask(self, mask: Self::Mask) -> u32 { self.0.sign_bits(mask[0]) | self.0.sign_bits(mask[1]) << 4 }
        fn mask_from_bits(self, bits: u8) -> Self::Mask {
            let lanes = self.load_i32(&[1, 2, 4, 8, 16, 32, 64, 128]);
            self.is_equal(self.and_i32(self.splat_i32(bits.into()), lanes), lanes)
        }
    }
}

#[cfg(feature = "alloc")]
impl<V: Singles128> F32Lanes8 for Wide128<V> {
    type F32 = [V::S; 2];

    inlined! {
        fn splat_f32(self, value: f32) -> Self::F32 { [self.0.splat_f32(value); 2] }
        fn vectors(self, from: &[Vec3; 8]) -> [Self::F32; 3] {
            let [low, high] = each2!(i => self.0.vectors(&from.as_chunks::<4>().0[i]));
            [[low[0], high[0]], [low[1], high[1]], [low[2], high[2]]]
        }
        fn add_f32(self, a: Self::F32, b: Self::F32) -> Self::F32 { each2!(i => self.0.add_f32(a[i], b[i])) }
        fn sub_f32(self, a: Self::F32, b: Self::F32) -> Self::F32 { each2!(i => self.0.sub_f32(a[i], b[i])) }
        fn mul_f32(self, a: Self::F32, b: Self::F32) -> Self::F32 { each2!(i => self.0.mul_f32(a[i], b[i])) }
        fn div_f32(self, a: Self::F32, b: Self::F32) -> Self::F32 { each2!(i => self.0.div_f32(a[i], b[i])) }
        fn nearest_f32(self, from: Self::F32) -> Self::I32 { each2!(i => self.0.nearest_f32(from[i])) }
        fn max_f32(self, a: Self::F32, b: Self::F32) -> Self::F32 { each2!(i => self.0.max_f32(a[i], b[i])) }
        fn min_f32(self, a: Self::F32, b: Self::F32) -> Self::F32 { each2!(i => self.0.min_f32(a[i], b[i])) }
        fn is_at_least(self, a: Self::F32, b: Self::F32) -> Self::Mask { each2!(i => self.0.is_at_least(a[i], b[i])) }
        fn bits_of_f32(self, from: Self::F32) -> Self::I32 { each2!(i => self.0.bits_of_f32(from[i])) }
        fn widen(self, [a, b]: Self::F32) -> Self::F64 {
            [self.0.widen_low(a), self.0.widen_high(a), self.0.widen_low(b), self.0.widen_high(b)]
        }
        fn narrow(self, [a, b, c, d]: Self::F64) -> Self::F32 { [self.0.narrow(a, b), self.0.narrow(c, d)] }
        fn whole(self, [a, b, c, d]: Self::F64) -> Self::I32 { [self.0.whole(a, b), self.0.whole(c, d)] }
        fn load_f32(self, from: &[f32; 8]) -> Self::F32 { each2!(i => self.0.load_f32(&from.as_chunks::<4>().0[i])) }
        fn sqrt(self, of: Self::F64) -> Self::F64 { each4!(i => self.0.sqrt(of[i])) }
        fn if_less(self, a: Self::F64, b: Self::F64, value: Self::F64) -> Self::F64 {
            let v = self.0;
            each4!(i => v.of_bits(v.and(v.is_less(a[i], b[i]), v.bits(value[i]))))
        }
        fn is_zero(self, values: Self::F64) -> bool {
            let (v, [a, b, c, d]) = (self.0, self.bits(values));
            v.sign_bits(v.is_equal(v.or(v.or(a, b), v.or(c, d)), v.splat(0))) == 0b1111
        }
    }
}
