//! R13: a projected coordinate is rounded to floor(256·x + ½), exactly.

use crate::support::tried::Tried;
use mode13h::fixed::{I16F16, I24F8};
use mode13h_conformance::Random;
use num_bigint::BigInt;
use num_rational::BigRational;

fn expected(exact: &BigRational) -> BigInt {
    let half = BigRational::new(1.into(), 2.into());
    (exact * BigRational::from_integer(256.into()) + half).floor().to_integer()
}

fn check(x: f64) {
    let exact = BigRational::from_float(x).expect("finite");
    let rounded = I24F8::round_from_f64(x).expect("in range");
    assert_eq!(BigInt::from(rounded.to_bits()), expected(&exact), "{x:e}");
}

#[test]
fn r13_f64_against_big_rationals() {
    let mut tried = Tried::new("r13_f64_against_big_rationals", 20_000);
    let mut random = Random::named("r13 f64");
    while tried.more() {
        let whole = random.within(-(1 << 21), 1 << 21) as f64;
        // Halves, quarters, and their neighbours in the last bit.
        let at = (whole + random.one_of(&[0.0, 0.25, 0.5, 0.75])) / 256.0;
        for x in [at, at.next_up(), at.next_down(), at + random.unit(), at * random.unit().powi(20)] {
            check(x);
        }
    }
}

#[test]
fn r13_f32_against_big_rationals() {
    let mut tried = Tried::new("r13_f32_against_big_rationals", 40_000);
    let mut random = Random::named("r13 f32");
    while tried.more() {
        let x = f32::from_bits(random.next_u64() as u32);
        if !x.is_finite() {
            assert_eq!(I24F8::round_from_f32(x), None);
        } else if x.abs() < 8_388_607.0 {
            check(f64::from(x));
            assert_eq!(I24F8::round_from_f32(x), I24F8::round_from_f64(f64::from(x)));
        } else {
            assert_eq!(I24F8::round_from_f32(x), None, "{x:e}");
        }
    }
}

#[test]
fn r13_16_16_against_big_rationals() {
    let mut tried = Tried::new("r13_16_16_against_big_rationals", 20_000);
    let mut random = Random::named("r13 16.16");
    for edge in [0, 1, -1, 127, 128, -127, -128, -129, i32::MAX, i32::MIN] {
        tried.add(1);
        check_16_16(edge);
    }
    while tried.more() {
        check_16_16(random.next_u64() as i32);
    }
}

fn check_16_16(bits: i32) {
    let exact = BigRational::new(bits.into(), 65_536.into());
    let rounded = I24F8::round_from_i16f16(I16F16::from_bits(bits));
    assert_eq!(BigInt::from(rounded.to_bits()), expected(&exact), "{bits}");
}
