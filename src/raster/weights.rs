//! The weights of a triangle's corners at a pixel, in f64 and exact.
//!
//! The weight of a corner is twice the area of the part of the triangle that lies opposite to it: a whole
//! number of at most 2⁴² in the triangle. Over the screen it is linear; all terms are whole and below 2⁴⁴, so
//! f64 loses nothing of them. None is negative at a centre that is covered: a sum of such weights times
//! values above 0 cancels nothing, and is right to a few parts in 2⁵³ however thin the triangle.

use super::cover::Ordered;

/// The weights of the three corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights {
    /// At column 0's centre of row 0.
    origin: [f64; 3],
    per_column: [f64; 3],
    per_row: [f64; 3],
}

impl Weights {
    /// Of a triangle that is not degenerate; the corners in the order of its vertices.
    pub(super) fn new(triangle: &Ordered) -> Self {
        let first = &triangle.vertices[0];
        let (x0, y0) = (i64::from(first.x().to_bits()), i64::from(first.y().to_bits()));
        let mut weights = Self { origin: [0.0; 3], per_column: [0.0; 3], per_row: [0.0; 3] };
        for (corner, one) in [[1, 0, 0], [0, 1, 0], [0, 0, 1]].into_iter().enumerate() {
            // Within 2²².
            let (gx, gy) = triangle.gradient(one);
            // At most 2⁴² + 2 · 2²² · (2²⁰ + 128).
            let origin = one[0] * triangle.area() + gx * (128 - x0) + gy * (128 - y0);
            weights.origin[corner] = origin as f64;
            weights.per_column[corner] = (gx * 256) as f64;
            weights.per_row[corner] = (gy * 256) as f64;
        }
        weights
    }

    /// At the centre of pixel (`x`, `y`).
    #[inline]
    pub(super) fn at(&self, x: i32, y: i32) -> [f64; 3] {
        let (x, y) = (f64::from(x), f64::from(y));
        core::array::from_fn(|i| self.origin[i] + self.per_column[i] * x + self.per_row[i] * y)
    }

    /// What they change by from one pixel to the next; they add up to 0.
    #[inline]
    pub(super) fn per_column(&self) -> [f64; 3] {
        self.per_column
    }
}
