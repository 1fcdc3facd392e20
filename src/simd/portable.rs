//! [`Lanes8`] with plain arrays, for every processor.

use super::lanes::{Lanes8, inlined};
use crate::lanes::each;

/// The level that every processor has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Portable;

type F64 = [f64; 8];
type I32 = [i32; 8];
type I64 = [i64; 8];

impl Lanes8 for Portable {
    type F64 = F64;
    type I32 = I32;
    type I64 = I64;
    /// −1 in the set lanes, 0 in the others.
    type Mask = I32;

    inlined! {
        fn load_f64(self, from: &F64) -> F64 { *from }
        fn splat_f64(self, value: f64) -> F64 { [value; 8] }
        fn store_f64(self, from: F64, to: &mut F64) { *to = from; }
        fn add(self, a: F64, b: F64) -> F64 { each!(i => a[i] + b[i]) }
        fn sub(self, a: F64, b: F64) -> F64 { each!(i => a[i] - b[i]) }
        fn mul(self, a: F64, b: F64) -> F64 { each!(i => a[i] * b[i]) }
        fn div(self, a: F64, b: F64) -> F64 { each!(i => a[i] / b[i]) }
        fn mul_add(self, a: F64, b: F64, c: F64) -> F64 { each!(i => a[i] * b[i] + c[i]) }
        fn neg_mul_add(self, a: F64, b: F64, c: F64) -> F64 { each!(i => c[i] - a[i] * b[i]) }
        fn min(self, a: F64, b: F64) -> F64 { each!(i => if a[i] < b[i] { a[i] } else { b[i] }) }
        fn max(self, a: F64, b: F64) -> F64 { each!(i => if a[i] > b[i] { a[i] } else { b[i] }) }
        fn xor_sign(self, a: F64, sign: F64) -> F64 {
            each!(i => f64::from_bits(a[i].to_bits() ^ (sign[i].to_bits() & 1 << 63)))
        }
        fn is_less(self, a: F64, b: F64) -> I32 { each!(i => -i32::from(a[i] < b[i])) }
        fn select(self, mask: I32, a: F64, b: F64) -> F64 {
            let wide = |i: usize| i64::from(mask[i]).cast_unsigned();
            each!(i => f64::from_bits((a[i].to_bits() & wide(i)) | (b[i].to_bits() & !wide(i))))
        }
        fn to_f64(self, from: I32) -> F64 { each!(i => f64::from(from[i])) }
        fn unsigned_to_f64(self, from: I32) -> F64 { each!(i => f64::from(from[i].cast_unsigned())) }
        fn low_bits(self, from: F64) -> I32 { each!(i => from[i].to_bits() as i32) }
        fn bits(self, from: F64) -> I64 { each!(i => from[i].to_bits().cast_signed()) }

        fn load_i32(self, from: &I32) -> I32 { *from }
        fn splat_i32(self, value: i32) -> I32 { [value; 8] }
        fn store_i32(self, from: I32, to: &mut I32) { *to = from; }
        fn add_i32(self, a: I32, b: I32) -> I32 { each!(i => a[i].wrapping_add(b[i])) }
        fn sub_i32(self, a: I32, b: I32) -> I32 { each!(i => a[i].wrapping_sub(b[i])) }
        fn mul_i32(self, a: I32, b: I32) -> I32 { each!(i => a[i].wrapping_mul(b[i])) }
        fn min_i32(self, a: I32, b: I32) -> I32 { each!(i => a[i].min(b[i])) }
        fn max_i32(self, a: I32, b: I32) -> I32 { each!(i => a[i].max(b[i])) }
        fn and_i32(self, a: I32, b: I32) -> I32 { each!(i => a[i] & b[i]) }
        fn or_i32(self, a: I32, b: I32) -> I32 { each!(i => a[i] | b[i]) }
        fn xor_i32(self, a: I32, b: I32) -> I32 { each!(i => a[i] ^ b[i]) }
        fn shl_i32(self, a: I32, by: i32) -> I32 { each!(i => a[i] << by) }
        fn shr_i32(self, a: I32, by: i32) -> I32 { each!(i => a[i] >> by) }
        fn is_greater(self, a: I32, b: I32) -> I32 { each!(i => -i32::from(a[i] > b[i])) }
        fn is_equal(self, a: I32, b: I32) -> I32 { each!(i => -i32::from(a[i] == b[i])) }
        fn select_i32(self, mask: I32, a: I32, b: I32) -> I32 { each!(i => (a[i] & mask[i]) | (b[i] & !mask[i])) }
        fn interleave_i32(self, a: I32, b: I32) -> [I32; 2] {
            let of = |i: usize| [a, b][i % 2][i / 2];
            [each!(i => of(i)), each!(i => of(i + 8))]
        }

        fn load_i64(self, from: &I64) -> I64 { *from }
        fn splat_i64(self, value: i64) -> I64 { [value; 8] }
        fn halves_i64(self, low: i64, high: i64) -> I64 { each!(i => if i < 4 { low } else { high }) }
        fn store_i64(self, from: I64, to: &mut I64) { *to = from; }
        fn add_i64(self, a: I64, b: I64) -> I64 { each!(i => a[i].wrapping_add(b[i])) }
        fn sub_i64(self, a: I64, b: I64) -> I64 { each!(i => a[i].wrapping_sub(b[i])) }
        fn mul_i64(self, a: I64, b: I64) -> I64 { each!(i => a[i].wrapping_mul(b[i])) }
        fn mul_low_i64(self, a: I64, b: I64) -> I64 { each!(i => (a[i] & 0xFFFF_FFFF).wrapping_mul(b[i])) }
        fn shl_i64(self, a: I64, by: i32) -> I64 { each!(i => a[i] << by) }
        fn to_i64(self, from: I32) -> I64 { each!(i => i64::from(from[i])) }
        fn unsigned_to_i64(self, from: I32) -> I64 { each!(i => i64::from(from[i].cast_unsigned())) }
        fn halves_of_i64(self, from: I64) -> [I32; 2] {
            [each!(i => from[i] as i32), each!(i => (from[i] >> 32) as i32)]
        }
        fn interleave_i64(self, a: I64, b: I64) -> [I64; 2] {
            let of = |i: usize| [a, b][i % 2][i / 2];
            [each!(i => of(i)), each!(i => of(i + 8))]
        }

        fn and(self, a: I32, b: I32) -> I32 { each!(i => a[i] & b[i]) }
        fn and_not(self, a: I32, b: I32) -> I32 { each!(i => a[i] & !b[i]) }
        fn to_bitmask(self, mask: I32) -> u32 {
            mask.iter().rev().fold(0, |bits, &set| bits << 1 | (set & 1).cast_unsigned())
        }
        fn mask_from_bits(self, bits: u8) -> I32 { each!(i => -i32::from(bits >> i & 1)) }
    }
}
