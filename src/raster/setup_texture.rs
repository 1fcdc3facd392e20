//! Texture coordinates of eight small triangles: planes from their corners, and the starts of their rows.
//!
//! Coordinates that are linear on the screen are set up like shades, with the quotients of [`setup`](super::setup).
//! Where a triangle's coordinates differ by less than 2²², 64 texels, gradients are below 2³⁹, no sum of terms reaches
//! 2⁵², and f64 holds all multiples of ½ below that. A quotient is below 2²² and off by 2⁻³⁰, its margin at least
//! 2⁻²⁷·¹².
//!
//! Coordinates that are linear on the face use the sums of an exact start: the weights of the corners, which are whole
//! numbers below 2⁴⁴, times values that are each rounded once. So a sum is off by at most 4 parts in 2⁵³ of the sum of
//! its terms' magnitudes.

use super::columns::{Picks, Triangles};
use super::pick::Pick;
use super::rows::Lane;
use super::setup::{Basis, Corners8, Floats, Ints};
use crate::fixed::ROUND_MAGIC;
use crate::lanes::LANES;
use crate::simd::Lanes8;

/// Texture coordinates u and v of each corner of up to eight triangles, in texels with 16 fraction bits; 0 in lanes
/// without a triangle.
#[inline(always)]
pub(super) fn texture_of_corners(triangles: &Triangles<'_>, picks: &Picks<'_>) -> [[Ints; 3]; 2] {
    let mut gathered = [[[0; LANES]; 3]; 2];
    let column = triangles.columns.effects.texture;
    for (lane, &pick) in picks.picks.iter().take(LANES).enumerate() {
        let indices = triangles.indices[Pick(pick).index()];
        for (corner, vertex) in indices.into_iter().enumerate() {
            let [u, v] = column[vertex as usize];
            (gathered[0][corner][lane], gathered[1][corner][lane]) = (u, v);
        }
    }
    gathered
}

/// Planes of coordinates that are linear on the screen, of eight triangles.
#[derive(Clone, Debug)]
pub(super) struct AffinePlanes8 {
    n: [Floats; 2],
    per_row: [Floats; 2],
    per_column: [Floats; 2],
    inverse: Floats,
    /// The coordinate of the first corner by height.
    first: [Ints; 2],
    /// Change per pixel, where a row has more than one.
    step: [Ints; 2],
    /// A bit for each triangle whose corners' coordinates are close enough together.
    pub(super) fits: u32,
}

impl AffinePlanes8 {
    pub(super) const NONE: Self = Self {
        n: [[0.0; LANES]; 2],
        per_row: [[0.0; LANES]; 2],
        per_column: [[0.0; LANES]; 2],
        inverse: [0.0; LANES],
        first: [[0; LANES]; 2],
        step: [[0; LANES]; 2],
        fits: 0,
    };

    /// The difference from which on corners are too far apart.
    const TOO_FAR: i32 = 1 << 22;

    #[inline(always)]
    pub(super) fn set_up<S: Lanes8>(&mut self, s: S, basis: &Basis<S>, coordinates: &[[Ints; 3]; 2]) {
        s.store_f64(basis.inverse, &mut self.inverse);
        self.fits = u32::MAX;
        let [x, y] = basis.first;
        let (pixel, magic) = (s.splat_f64(256.0), s.splat_f64(ROUND_MAGIC));
        for (i, [a, b, c]) in coordinates.iter().enumerate() {
            let corners = [s.load_i32(a), s.load_i32(b), s.load_i32(c)];
            let [a, b, c] = corners;
            // Modulo 2³²: a difference of 2³¹ or more is negative.
            let range = s.sub_i32(s.max_i32(s.max_i32(a, b), c), s.min_i32(s.min_i32(a, b), c));
            let is_near =
                s.and_not(s.is_greater(s.splat_i32(Self::TOO_FAR), range), s.is_greater(s.splat_i32(0), range));
            self.fits &= s.to_bitmask(is_near);
            let [first, second, third] = basis.order.sort(s, corners);
            s.store_i32(first, &mut self.first[i]);
            let differences = [s.to_f64(s.sub_i32(second, first)), s.to_f64(s.sub_i32(third, first))];
            let [gx, gy] = basis.gradient(s, differences);
            // +0, not −0: its sign chooses the rounding.
            let gx = s.add(gx, s.splat_f64(0.0));
            // `AffinePlane::start`: the floor, or the ceiling where coordinates fall.
            let half = s.xor_sign(s.mul_add(basis.area, s.splat_f64(0.5), s.splat_f64(-0.5)), gx);
            let n = s.neg_mul_add(gx, x, s.neg_mul_add(gy, y, s.splat_f64(0.0)));
            s.store_f64(s.sub(n, half), &mut self.n[i]);
            s.store_f64(s.mul(gy, pixel), &mut self.per_row[i]);
            let per_column = s.mul(gx, pixel);
            s.store_f64(per_column, &mut self.per_column[i]);
            // Toward zero.
            let step = s.mul_add(s.sub(per_column, half), basis.inverse, magic);
            s.store_i32(s.low_bits(step), &mut self.step[i]);
        }
    }

    /// The coordinates, u and v, of each lane at these columns of rows `j`.
    #[inline(always)]
    pub(super) fn starts<S: Lanes8>(&self, s: S, lane: impl Lane<S>, j: S::F64, columns: S::F64) -> [S::I32; 2] {
        let i = s.sub(columns, s.splat_f64(ROUND_MAGIC));
        let inverse = lane.load_f64(s, &self.inverse);
        let mut starts = [s.splat_i32(0); 2];
        for (of, start) in starts.iter_mut().enumerate() {
            let n = s.mul_add(lane.load_f64(s, &self.per_row[of]), j, lane.load_f64(s, &self.n[of]));
            let n = s.mul_add(lane.load_f64(s, &self.per_column[of]), i, n);
            // The low bits; the sum is modulo 2³².
            let change = s.low_bits(s.mul_add(n, inverse, s.splat_f64(ROUND_MAGIC)));
            *start = s.add_i32(change, lane.load_i32(s, &self.first[of]));
        }
        starts
    }

    /// Changes per pixel, in each lane.
    #[inline(always)]
    pub(super) fn steps<S: Lanes8>(&self, s: S, lane: impl Lane<S>) -> [S::I32; 2] {
        [lane.load_i32(s, &self.step[0]), lane.load_i32(s, &self.step[1])]
    }
}

/// Coordinates that are linear on the face, of eight triangles: numerators and divisor are sums over the corners of weights
/// times values.
#[derive(Clone, Debug)]
pub(super) struct PerspectivePlanes8 {
    /// The weights of the corners, by height: at the box's first pixel, their change per row, and per column.
    weights: [[Floats; 3]; 3],
    /// u, v and 1 of each corner, times its depth.
    values: [[Floats; 3]; 3],
    /// Change of the sums per pixel.
    step: [Floats; 3],
}

impl PerspectivePlanes8 {
    pub(super) const NONE: Self =
        Self { weights: [[[0.0; LANES]; 3]; 3], values: [[[0.0; LANES]; 3]; 3], step: [[0.0; LANES]; 3] };

    #[inline(always)]
    pub(super) fn set_up<S: Lanes8>(
        &mut self,
        s: S,
        basis: &Basis<S>,
        corners: &Corners8,
        coordinates: &[[Ints; 3]; 2],
    ) {
        let [u, v] = coordinates;
        let [depth_a, depth_b, depth_c] = &corners.depth;
        let u = basis.order.sort(s, [s.load_i32(&u[0]), s.load_i32(&u[1]), s.load_i32(&u[2])]);
        let v = basis.order.sort(s, [s.load_i32(&v[0]), s.load_i32(&v[1]), s.load_i32(&v[2])]);
        let depth = basis.order.sort(s, [s.load_i32(depth_a), s.load_i32(depth_b), s.load_i32(depth_c)]);
        let one = s.splat_f64(1.0);
        let mut sums = [s.splat_f64(0.0); 3];
        for corner in 0..3 {
            let (_, weight) = basis.weight(s, corner);
            for (i, to) in self.weights[corner].iter_mut().enumerate() {
                s.store_f64(weight[i], to);
            }
            let [_, _, per_column] = weight;
            // A depth counts as at least 1.
            let depth = s.max(s.unsigned_to_f64(depth[corner]), one);
            let values = [s.mul(s.to_f64(u[corner]), depth), s.mul(s.to_f64(v[corner]), depth), depth];
            for i in 0..3 {
                s.store_f64(values[i], &mut self.values[corner][i]);
                sums[i] = s.mul_add(per_column, values[i], sums[i]);
            }
        }
        for (i, step) in self.step.iter_mut().enumerate() {
            s.store_f64(sums[i], step);
        }
    }

    /// The sums of each lane at these columns of rows `j`. A product may be fused with a sum, which rounds less often.
    #[inline(always)]
    pub(super) fn starts<S: Lanes8>(&self, s: S, lane: impl Lane<S>, j: S::F64, columns: S::F64) -> [S::F64; 3] {
        let i = s.sub(columns, s.splat_f64(ROUND_MAGIC));
        let mut sums = [s.splat_f64(0.0); 3];
        for (weights, values) in self.weights.iter().zip(&self.values) {
            let weight = s.mul_add(lane.load_f64(s, &weights[1]), j, lane.load_f64(s, &weights[0]));
            let weight = s.mul_add(lane.load_f64(s, &weights[2]), i, weight);
            for (sum, values) in sums.iter_mut().zip(values) {
                *sum = s.mul_add(weight, lane.load_f64(s, values), *sum);
            }
        }
        sums
    }

    /// Change of the sums of triangle `lane` per pixel.
    #[inline(always)]
    pub(super) fn step(&self, lane: usize) -> [f64; 3] {
        let lane = lane % LANES;
        [self.step[0][lane], self.step[1][lane], self.step[2][lane]]
    }
}
