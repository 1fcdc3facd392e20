//! Depth: which of two triangles is in front.
//!
//! A vertex's depth is `d = round(2³⁰ · near / w)`, a u32: greater is nearer, and there is no far
//! plane. 1/w is linear on the screen, so over a triangle d is a plane. [`DepthPlane::at`] is the
//! *definition* of a triangle's depth at a pixel; every hidden-surface method decides by it.
//!
//! ```text
//! at(x, y) = (d0·2²⁴ + gx·(X − x0) + gy·(Y − y0) + 2²³) >> 24     X, Y: the pixel's centre, 1/256 pixel
//! gx = nearest(2²⁴ · ((d1 − d0)·(y2 − y0) − (d2 − d0)·(y1 − y0)) / A)
//! ```
//!
//! where vertex 0 is the first in (y, x) order. The gradients, per pixel with 16 fraction bits, are within half a unit,
//! and no vertex is more than 2²¹ units away in x or in y, so the sum is within 2²¹ of exact: an eighth of a depth
//! step. The shift by 24 bits rounds to the nearest, so a depth stays in the range of its vertices', without a clamp.
//!
//! A sliver's gradients do not fit in 64 bits. The *sum* does, so everything is computed modulo 2⁶⁴, and wrapping is
//! intended; only the division needs 128 bits, and only for slivers.

use super::cover::SortedTriangle;
use super::quotient::Divisor;
use crate::fixed::floor_of_wide;
use crate::lanes::three;

/// The depth plane of a triangle.
#[derive(Clone, Copy, Debug)]
pub struct DepthPlane {
    /// At the centre of pixel (0, 0), with 24 fraction bits, the half included, modulo 2⁶⁴.
    origin: i64,
    per_column: i64,
    per_row: i64,
}

impl DepthPlane {
    /// The plane of a triangle that is not degenerate.
    #[must_use]
    #[inline]
    pub fn new(triangle: &SortedTriangle) -> Self {
        let area = Divisor::new(triangle.area());
        let depths = three(triangle.vertices.each_ref(), |v| i64::from(v.depth()));
        // Both at most 2⁵⁴.
        let (gx, gy) = triangle.gradient(depths);
        let (gx, gy) = (gradient(gx, &area), gradient(gy, &area));
        let first = &triangle.vertices[0];
        let (x0, y0) = (i64::from(first.x().to_bits()), i64::from(first.y().to_bits()));
        let origin = ((depths[0] << 24) + (1 << 23))
            .wrapping_add(gx.wrapping_mul(128 - x0))
            .wrapping_add(gy.wrapping_mul(128 - y0));
        Self { origin, per_column: gx.wrapping_mul(256), per_row: gy.wrapping_mul(256) }
    }

    /// The plane with `base` added to its depths, modulo 2³².
    #[must_use]
    #[inline]
    pub(in crate::raster) fn raised_by(self, base: u32) -> Self {
        Self { origin: self.origin.wrapping_add(i64::from(base) << 24), ..self }
    }

    /// The depth at pixel (`x`, `y`), whose centre lies in the triangle.
    #[must_use]
    #[inline]
    pub fn at(&self, x: i32, y: i32) -> u32 {
        // Within the vertices' depths, so non-negative and below 2³².
        (self.fixed_at(x, y) >> 24) as u32
    }

    /// The depth with 24 fraction bits, the half included, modulo 2⁶⁴: where a depth span starts.
    #[must_use]
    #[inline]
    pub fn fixed_at(&self, x: i32, y: i32) -> i64 {
        self.origin
            .wrapping_add(self.per_column.wrapping_mul(i64::from(x)))
            .wrapping_add(self.per_row.wrapping_mul(i64::from(y)))
    }

    /// Change from one pixel to the next, with 24 fraction bits, modulo 2⁶⁴.
    #[must_use]
    #[inline]
    pub fn step(&self) -> i64 {
        self.per_column
    }
}

/// `nearest(2²⁴ · numerator / area)` modulo 2⁶⁴, halves upward; |numerator| at most 2⁵⁴.
#[inline]
fn gradient(numerator: i64, area: &Divisor) -> i64 {
    // Below 2³⁷ the product is below 2⁶¹; the quotient is then within the proved range if the area
    // is at least 2¹⁵, half a pixel.
    if numerator.unsigned_abs() < 1 << 37 && area.get() >= 1 << 15 {
        area.floor((numerator << 24) + (area.get() >> 1))
    } else {
        let wide = (i128::from(numerator) << 24) + i128::from(area.get() >> 1);
        // Wrapping is intended: see the module's documentation.
        floor_of_wide(wide, area.get().into())
    }
}
