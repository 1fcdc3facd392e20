//! Shades in f32, as today's programs compute them: every attribute divided by w, interpolated linearly on the screen,
//! and multiplied by w again at every pixel.
//!
//! ```text
//! shade(k) = (n + k·dn) / (d + k·dd)        n: shade/w, d: 1/w, at the row's start; k pixels from there
//! ```
//!
//! A vertex's depth is `2³⁰·near / w`, so it stands for 1/w. With λ the weights of the corners and s their shades, n =
//! Σ λᵢ·dᵢ·sᵢ and d = Σ λᵢ·dᵢ, summed in f64 over the vertices from top to bottom, then rounded to f32; dn and dd are
//! exact before they are rounded. n and d are larger than shade/w and 1/w by the same factor, which cancels.
//!
//! # Where a row starts
//!
//! A row starts at its far end: at its first covered pixel inside the frame if 1/w grows to the right or is constant,
//! otherwise at its last, and k then counts down from 0. From the near end the divisor would shrink while the rounding
//! error of its start stays: for w from 1 to 10⁴ in a row that is up to 0.9 of a shade. Both ends are the frame's,
//! whatever the clip rectangle, and every pixel is computed from its own k, so a part of a row has the bytes of the
//! whole.
//!
//! # How far a byte is from exact
//!
//! With u = 2⁻²⁴, N and D the exact values and S the greatest shade of a vertex, N ≤ S·D everywhere, and D at the row's
//! start b is no greater than at any pixel k. The start, the step, the step's product with k, and the sum are each
//! rounded once; so
//!
//! ```text
//! |n(k) − N(k)| ≤ u·(N(b) + 2·|N(k) − N(b)| + N(k)) ≤ 3u·max(N(b), N(k)) ≤ 3u·S·D(k)
//! |d(k) − D(k)| ≤ 3u·D(k)                                        in the same way
//! ```
//!
//! to first order in u, and the quotient is off by at most 6u·S, 7u·S once it is rounded. S is at most 255, so that is
//! less than 7/65,536 of a shade. Clamping to the range of the vertices moves no value farther from one inside it.
//! Rounding to a byte adds 1/65,536: in all, a byte is within ½ + 1/8,192 of a shade of exact, for any triangle,
//! however thin and however deep.
//!
//! Here only the clamp keeps bytes in range, not rounding in one direction as in [`shade`](super::shade).

use super::cover::{Row, SortedTriangle};
use super::weights::{Weights, exact, in_f64};
use crate::lanes::three;

/// The shades of a triangle in f32.
#[derive(Clone, Copy, Debug)]
pub(in crate::raster) struct FloatPlane {
    weights: Weights,
    /// The depth of each vertex times its shade, then its depth.
    values: [[f64; 2]; 3],
    /// Change of both sums from one pixel to the next.
    pub(in crate::raster) steps: [f32; 2],
    /// The least and the greatest shade of a vertex.
    range: [f32; 2],
}

/// A row's n and d at its start, each with its step: the input of [`fill_float`](crate::span::float::fill_float).
#[derive(Clone, Copy, Debug)]
pub(in crate::raster) struct FloatRow {
    /// The column at which k is 0.
    pub(in crate::raster) start: i32,
    pub(in crate::raster) n: [f32; 2],
    pub(in crate::raster) d: [f32; 2],
    pub(in crate::raster) range: [f32; 2],
}

impl FloatPlane {
    /// The plane of any three shades of 0 to 0xFF00 at the corners of a triangle that is not degenerate.
    /// The shades are in the order of its vertices. A depth of 0 counts as 1.
    pub(in crate::raster) fn of_values(triangle: &SortedTriangle, shades: [i64; 3]) -> Self {
        let depths = three(triangle.vertices.each_ref(), |v| i64::from(v.depth().max(1)));
        let weights = Weights::new(triangle);
        // 48 bits.
        let products = three([0, 1, 2], |i| depths[i] * shades[i]);
        // In 1/256 shade; at most 2⁸⁰, which f32 can represent.
        let dn = exact(weights.per_column, products) as f32 / 256.0;
        let dd = exact(weights.per_column, depths) as f32;
        let values = three([0, 1, 2], |i| [products[i] as f64 / 256.0, depths[i] as f64]);
        let [a, b, c] = three(shades, |shade| shade as f32 / 256.0);
        Self { weights, values, steps: [dn, dd], range: [a.min(b).min(c), a.max(b).max(c)] }
    }

    /// A row of the triangle.
    pub(in crate::raster) fn row(&self, row: &Row) -> FloatRow {
        let start = if self.steps[1] < 0.0 { row.last } else { row.origin };
        let [wa, wb, wc] = in_f64(self.weights.at(start, row.y));
        let [a, b, c] = &self.values;
        let at_start = |i: usize| (wa * a[i] + wb * b[i] + wc * c[i]) as f32;
        let [dn, dd] = self.steps;
        FloatRow { start, n: [at_start(0), dn], d: [at_start(1), dd], range: self.range }
    }
}
