//! The weights of a triangle's corners at a pixel, exact.
//!
//! The weight of a corner is twice the area of the part of the triangle opposite it: a whole number of at most 2⁴² in
//! the triangle. It is linear on the screen; all terms are whole and below 2⁴⁴, so f64 holds them exactly. None is
//! negative at a covered centre, so in a sum of such weights times values above 0 nothing cancels, and the sum is
//! accurate to a few parts in 2⁵³ however thin the triangle.

use super::cover::SortedTriangle;

/// The weights of the three corners, as whole numbers.
#[derive(Clone, Copy, Debug)]
pub(in crate::raster) struct Weights {
    /// At the centre of pixel (0, 0).
    origin: [i64; 3],
    /// Change per pixel. The changes add up to 0 and are within 2³⁰.
    pub(in crate::raster) per_column: [i64; 3],
    /// Change per row, in the same range.
    pub(in crate::raster) per_row: [i64; 3],
}

impl Weights {
    /// The weights in a triangle that is not degenerate; the corners are in the order of its vertices.
    pub(in crate::raster) fn new(triangle: &SortedTriangle) -> Self {
        let first = &triangle.vertices[0];
        let (x0, y0) = (i64::from(first.x().to_bits()), i64::from(first.y().to_bits()));
        let mut weights = Self { origin: [0; 3], per_column: [0; 3], per_row: [0; 3] };
        for (corner, one) in [[1, 0, 0], [0, 1, 0], [0, 0, 1]].into_iter().enumerate() {
            // Within 2²².
            let (gx, gy) = triangle.gradient(one);
            // At most 2⁴² + 2 · 2²² · (2²⁰ + 128).
            weights.origin[corner] = one[0] * triangle.area() + gx * (128 - x0) + gy * (128 - y0);
            weights.per_column[corner] = gx * 256;
            weights.per_row[corner] = gy * 256;
        }
        weights
    }

    /// Returns the weights at the centre of pixel (`x`, `y`).
    #[inline]
    pub(in crate::raster) fn at(&self, x: i32, y: i32) -> [i64; 3] {
        let (x, y) = (i64::from(x), i64::from(y));
        let at = |i: usize| self.origin[i] + self.per_column[i] * x + self.per_row[i] * y;
        [at(0), at(1), at(2)]
    }
}

/// The sum over the corners of weights times values, exact.
#[cfg_attr(mode13h_small, inline(never))]
#[cfg_attr(not(mode13h_small), inline)]
pub(in crate::raster) fn exact([wa, wb, wc]: [i64; 3], [a, b, c]: [i64; 3]) -> i128 {
    let product = |weight: i64, value: i64| i128::from(weight) * i128::from(value);
    product(wa, a) + product(wb, b) + product(wc, c)
}

/// Weights in f64, exactly: they are at most 2⁴⁴.
#[inline]
pub(in crate::raster) fn in_f64([a, b, c]: [i64; 3]) -> [f64; 3] {
    [a as f64, b as f64, c as f64]
}
