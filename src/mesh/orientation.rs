//! An exact test of which side of a face a point lies on.
//!
//! It is a determinant of differences, computed first in f64 with an error bound, and where that cannot decide, in
//! exact expansions after J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
//! Predicates", 1997. Products of three differences of f32 values neither overflow nor underflow f64: every term is a
//! multiple of 2⁻⁴⁴⁷ and less than 2³⁹⁰.

use alloc::vec::Vec;
use core::cmp::Ordering;

use glam::Vec3;

/// Returns which side of the face `a`, `b`, `c` the point `d` lies on: `Greater` in front (where
/// the face is counter-clockwise), `Equal` in its plane, `Less` behind.
pub(super) fn side(a: Vec3, b: Vec3, c: Vec3, d: Vec3) -> Ordering {
    let a = a.to_array();
    // Rows: b − a, c − a, d − a; each difference is exactly high + low.
    let rows = [b, c, d].map(|p| {
        let p = p.to_array();
        [0, 1, 2].map(|i| two_sum(f64::from(p[i]), -f64::from(a[i])))
    });

    let mut determinant = 0.0;
    let mut magnitude = 0.0;
    for &(x, y, z, sign) in &PERMUTATIONS {
        let term = sign * rows[0][x][0] * rows[1][y][0] * rows[2][z][0];
        determinant += term;
        magnitude += libm::fabs(term);
    }
    // Three differences, two products and five sums, each with a relative error of at most 2⁻⁵³: under 11 · 2⁻⁵³ of
    // `magnitude` in all, and 2⁻⁴⁸ is 32 · 2⁻⁵³.
    let bound = magnitude * (1.0 / 281_474_976_710_656.0);
    if libm::fabs(determinant) > bound {
        return determinant.total_cmp(&0.0);
    }

    // An exact sum: non-overlapping components in order of increasing magnitude. There are six terms of 16 products of
    // two components each, and an addition adds at most one component.
    let mut sum = Vec::with_capacity(6 * 16 * 2);
    for &(x, y, z, sign) in &PERMUTATIONS {
        for first in rows[0][x] {
            for second in rows[1][y] {
                let products = two_product(first, second);
                for third in rows[2][z] {
                    for product in products {
                        let [high, low] = two_product(product, sign * third);
                        grow(&mut sum, low);
                        grow(&mut sum, high);
                    }
                }
            }
        }
    }
    // The greatest component outweighs all others.
    sum.last().map_or(Ordering::Equal, |greatest| greatest.total_cmp(&0.0))
}

/// The column taken from each of the three rows, and the sign of the term.
const PERMUTATIONS: [(usize, usize, usize, f64); 6] =
    [(0, 1, 2, 1.0), (0, 2, 1, -1.0), (1, 2, 0, 1.0), (1, 0, 2, -1.0), (2, 0, 1, 1.0), (2, 1, 0, -1.0)];

/// `a + b` as a rounded value and its error (Knuth).
fn two_sum(a: f64, b: f64) -> [f64; 2] {
    let sum = a + b;
    let from_b = sum - a;
    let from_a = sum - from_b;
    [sum, (a - from_a) + (b - from_b)]
}

/// `a · b` as a rounded value and its error (Dekker's method, since not every machine has a fused multiply).
fn two_product(a: f64, b: f64) -> [f64; 2] {
    let product = a * b;
    let (a_high, a_low) = split(a);
    let (b_high, b_low) = split(b);
    let error = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    [product, error]
}

/// Splits into 26 and 26 bits; 2²⁷ + 1 is Dekker's constant for 53 bits.
fn split(a: f64) -> (f64, f64) {
    let shifted = 134_217_729.0 * a;
    let high = shifted - (shifted - a);
    (high, a - high)
}

/// Adds a value to an exact sum: Shewchuk's GROW-EXPANSION, with zeros dropped.
fn grow(sum: &mut Vec<f64>, mut value: f64) {
    // Most are 0, and need no pass over the sum.
    if value == 0.0 {
        return;
    }
    sum.retain_mut(|component| {
        [value, *component] = two_sum(value, *component);
        *component != 0.0
    });
    if value != 0.0 {
        sum.push(value);
    }
}

#[cfg(test)]
mod tests {
    use core::cmp::Ordering;

    use glam::Vec3;
    use num_rational::BigRational;
    use num_traits::Zero;
    use proptest::prelude::*;

    use super::side;

    fn oracle(corners: [Vec3; 4]) -> Ordering {
        let [a, b, c, d] = corners.map(|p| p.to_array().map(|x| BigRational::from_float(x).unwrap()));
        let sub = |p: &[BigRational; 3]| [0, 1, 2].map(|i| &p[i] - &a[i]);
        let [u, v, w] = [sub(&b), sub(&c), sub(&d)];
        let normal = [&u[1] * &v[2] - &u[2] * &v[1], &u[2] * &v[0] - &u[0] * &v[2], &u[0] * &v[1] - &u[1] * &v[0]];
        (&normal[0] * &w[0] + &normal[1] * &w[1] + &normal[2] * &w[2]).cmp(&BigRational::zero())
    }

    fn finite() -> impl Strategy<Value = f32> {
        any::<f32>().prop_filter("finite", |x| x.is_finite())
    }

    proptest! {
        /// The fourth point is on the plane or a few units in the last place off it: a + s·(b − a) + t·(c − a),
        /// rounded, and then moved.
        #[test]
        fn near_the_plane(
            corners in prop::array::uniform3(prop::array::uniform3(-1.0f32..1.0)),
            factors in prop::array::uniform2(-2.0f32..2.0),
            moves in prop::array::uniform3(-2i32..=2),
            exponent in -120i32..120,
        ) {
            let [a, b, c] = corners.map(Vec3::from_array);
            let d = a + (b - a) * factors[0] + (c - a) * factors[1];
            let moved = |(x, m): (f32, i32)| f32::from_bits(x.to_bits().wrapping_add_signed(m));
            let d = [(d.x, moves[0]), (d.y, moves[1]), (d.z, moves[2])].map(moved);
            let points = [a, b, c, Vec3::from_array(d)].map(|p| p * 2f32.powi(exponent));
            if points.iter().all(|p| p.is_finite()) {
                prop_assert_eq!(side(points[0], points[1], points[2], points[3]), oracle(points));
            }
        }

        /// Points exactly in one plane, with coordinates whose products do not fit into f64.
        #[test]
        fn in_the_plane(p in prop::array::uniform3(prop::array::uniform2(finite())), z in finite()) {
            // The plane x = y, and its two images under cyclic permutation of the axes.
            let points = [p[0], p[1], p[2], [z, p[0][1]]].map(|[x, z]| Vec3::new(x, x, z));
            for turn in 0..3 {
                let turned = points.map(|p| Vec3::from_array([p[turn], p[(turn + 1) % 3], p[(turn + 2) % 3]]));
                prop_assert_eq!(side(turned[0], turned[1], turned[2], turned[3]), Ordering::Equal);
            }
        }

        /// Points of any magnitude, including denormals and `f32::MAX`.
        #[test]
        fn anywhere(p in prop::array::uniform4(prop::array::uniform3(finite()))) {
            let points = p.map(Vec3::from_array);
            prop_assert_eq!(side(points[0], points[1], points[2], points[3]), oracle(points));
        }
    }
}
