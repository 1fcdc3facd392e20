//! On which side of a face does a point lie? Exactly.
//!
//! A determinant of differences, first in f64 with an error bound; where that cannot tell, in exact
//! expansions after J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
//! Geometric Predicates", 1997. Three differences of f32 values neither overflow nor underflow f64
//! when multiplied: every term is a multiple of 2⁻⁴⁴⁷ and less than 2³⁹⁰.

use core::cmp::Ordering;

use glam::Vec3;

/// `Greater`: `d` is in front of the face `a`, `b`, `c` (which is counter-clockwise seen from there);
/// `Equal`: in its plane; `Less`: behind it.
pub(super) fn side(a: Vec3, b: Vec3, c: Vec3, d: Vec3) -> Ordering {
    // Rows: b − a, c − a, d − a; each difference is exactly high + low.
    let rows = [b, c, d].map(|p| {
        [two_difference(p.x, a.x), two_difference(p.y, a.y), two_difference(p.z, a.z)] //
    });

    let mut determinant = 0.0;
    let mut magnitude = 0.0;
    for &(x, y, z, sign) in &PERMUTATIONS {
        let term = sign * rows[0][x].0 * rows[1][y].0 * rows[2][z].0;
        determinant += term;
        magnitude += libm::fabs(term);
    }
    // Three differences, two products and five sums, each off by 2⁻⁵³ of itself at most: under
    // 11 · 2⁻⁵³ of `magnitude` all told, and 2⁻⁴⁸ is 32 · 2⁻⁵³.
    let bound = magnitude * (1.0 / 281_474_976_710_656.0);
    if determinant > bound {
        return Ordering::Greater;
    }
    if determinant < -bound {
        return Ordering::Less;
    }

    let mut sum = Expansion::new();
    for &(x, y, z, sign) in &PERMUTATIONS {
        for first in parts(rows[0][x]) {
            for second in parts(rows[1][y]) {
                let (high, low) = two_product(first, second);
                for third in parts(rows[2][z]) {
                    for product in [high, low] {
                        let (high, low) = two_product(product, sign * third);
                        sum.add(low);
                        sum.add(high);
                    }
                }
            }
        }
    }
    sum.sign()
}

/// Column of each of the three rows, and the sign of the term.
const PERMUTATIONS: [(usize, usize, usize, f64); 6] =
    [(0, 1, 2, 1.0), (0, 2, 1, -1.0), (1, 2, 0, 1.0), (1, 0, 2, -1.0), (2, 0, 1, 1.0), (2, 1, 0, -1.0)];

fn parts(pair: (f64, f64)) -> [f64; 2] {
    [pair.0, pair.1]
}

/// `a − b` as a rounded value and its error.
fn two_difference(a: f32, b: f32) -> (f64, f64) {
    two_sum(f64::from(a), -f64::from(b))
}

/// `a + b` as a rounded value and its error (Knuth).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let from_b = sum - a;
    let from_a = sum - from_b;
    (sum, (a - from_a) + (b - from_b))
}

/// `a · b` as a rounded value and its error (Dekker; without a fused multiply, which not every
/// machine has).
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let (a_high, a_low) = split(a);
    let (b_high, b_low) = split(b);
    let error = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    (product, error)
}

/// Into 26 and 26 bits; 2²⁷ + 1 is Dekker's constant for 53 bits.
fn split(a: f64) -> (f64, f64) {
    let shifted = 134_217_729.0 * a;
    let high = shifted - (shifted - a);
    (high, a - high)
}

/// A sum kept exactly: components that do not overlap, in order of rising magnitude.
struct Expansion {
    components: [f64; Self::MOST],
    len: usize,
}

impl Expansion {
    /// Six terms of 2 · 2 · 2 · 2 products of two components each; an addition makes at most one
    /// component more.
    const MOST: usize = 6 * 16 * 2;

    fn new() -> Self {
        Self { components: [0.0; Self::MOST], len: 0 }
    }

    /// Shewchuk's GROW-EXPANSION, zeros left out.
    fn add(&mut self, value: f64) {
        if value == 0.0 {
            return;
        }
        let mut carried = value;
        let mut kept = 0;
        for i in 0..self.len {
            let (sum, error) = two_sum(carried, self.components[i]);
            carried = sum;
            if error != 0.0 {
                self.components[kept] = error;
                kept += 1;
            }
        }
        if carried != 0.0 {
            self.components[kept] = carried;
            kept += 1;
        }
        self.len = kept;
    }

    /// That of the greatest component, which outweighs all others.
    fn sign(&self) -> Ordering {
        match self.components[..self.len].last() {
            Some(greatest) => greatest.total_cmp(&0.0),
            None => Ordering::Equal,
        }
    }
}
