//! Texture coordinates of a triangle at a pixel: linear on the screen, or on the face.

use super::cover::SortedTriangle;
use super::quotient::Divisor;
use super::weights::{Weights, exact, in_f64};
use crate::fixed::{HAS_F64, floor_of_wide, nearest_whole};

/// The depth of a corner, at least 1.
#[inline]
pub(in crate::raster) fn depth(triangle: &SortedTriangle, corner: usize) -> i64 {
    i64::from(triangle.vertices[corner].depth().max(1))
}

/// A texture coordinate that is linear on the screen.
///
/// With c the first corner's coordinate, A twice the area, and the numerators g of the gradient,
///
/// ```text
/// u(x, y) = c + (gx·(256·x + 128 − x₀) + gy·(256·y + 128 − y₀)) / A
/// ```
///
/// It is rounded like shades, down where it rises and up where it falls, so no sum leaves the range of the corners.
/// Inside the triangle the fraction is at most D, the largest difference between corners. Where D·A is below 2⁶¹, which
/// it is for triangles of half a million pixels and 4,096 texels, its numerator is right modulo 2⁶⁴ whatever its terms
/// are.
///
/// In level n of a mipmap, the coordinate and the step are divided by 2ⁿ and rounded again, which
/// gives the same as rounding once: see [`AffineLevel`].
#[derive(Clone, Copy, Debug)]
pub(in crate::raster) struct AffinePlane {
    area: Divisor,
    /// c.
    coordinate: i64,
    /// (x₀, y₀), relative to the centre of pixel (0, 0).
    corner: [i64; 2],
    /// (gx, gy): the numerators of the change per 1/256 pixel, each within 2⁵⁵.
    pub(in crate::raster) gradient: [i64; 2],
    /// D·A is below 2⁶¹.
    fits: bool,
    /// Added to the numerator so that it rounds up: A − 1, or 0.
    bias: i64,
    /// Change from one pixel to the next, rounded toward zero.
    pub(in crate::raster) step: i64,
}

impl AffinePlane {
    #[inline]
    pub(in crate::raster) fn new(triangle: &SortedTriangle, area: Divisor, [a, b, c]: [i32; 3]) -> Self {
        let (gx, gy) = triangle.gradient([a.into(), b.into(), c.into()]);
        let first = &triangle.vertices[0];
        let range = a.max(b).max(c).abs_diff(a.min(b).min(c));
        let most = u64::from(range).saturating_mul(area.get().unsigned_abs());
        let fits = most < 1 << 61;
        // In a row of two pixels or more it is within D, and gx·256 within D·A. In a row of one it is not used.
        let step = if !fits {
            (256 * i128::from(gx) / i128::from(area.get())) as i64
        } else if gx.unsigned_abs() <= most >> 8 {
            area.truncate(gx * 256)
        } else {
            0
        };
        let corner = [i64::from(first.x().to_bits()) - 128, i64::from(first.y().to_bits()) - 128];
        let bias = if gx < 0 { area.get() - 1 } else { 0 };
        Self { area, coordinate: a.into(), corner, gradient: [gx, gy], fits, bias, step }
    }

    /// The coordinate at a pixel, and its change per column and per row: each a floor, modulo 2³², and a remainder.
    /// Adding the floor of the remainders' sum gives [`start`](Self::start) at any pixel.
    pub(in crate::raster) fn parts(&self, [x, y]: [i32; 2]) -> [(i32, i64); 3] {
        let ([gx, gy], area) = (self.gradient.map(i128::from), i128::from(self.area.get()));
        let (dx, dy) =
            (i128::from(x) * 256 - i128::from(self.corner[0]), i128::from(y) * 256 - i128::from(self.corner[1]));
        let first = i128::from(self.coordinate) * area + gx * dx + gy * dy + i128::from(self.bias);
        // Modulo 2³²; below the area.
        [first, gx * 256, gy * 256].map(|n| (n.div_euclid(area) as i32, n.rem_euclid(area) as i64))
    }

    /// The coordinate at a pixel whose centre lies in the triangle; 16.16.
    #[cfg_attr(mode13h_small, inline(never))]
    #[cfg_attr(not(mode13h_small), inline)]
    pub(in crate::raster) fn start(&self, x: i32, y: i32) -> u32 {
        let ([gx, gy], bias) = (self.gradient, self.bias);
        let (dx, dy) = (i64::from(x) * 256 - self.corner[0], i64::from(y) * 256 - self.corner[1]);
        let quotient = if self.fits {
            self.area.floor(gx.wrapping_mul(dx).wrapping_add(gy.wrapping_mul(dy)).wrapping_add(bias))
        } else {
            let n = i128::from(gx) * i128::from(dx) + i128::from(gy) * i128::from(dy) + i128::from(bias);
            // Within D.
            floor_of_wide(n, self.area.get().into())
        };
        // Modulo 2³².
        (self.coordinate + quotient) as u32
    }
}

/// The mipmap level from which a face with coordinates linear on the screen is drawn.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(in crate::raster) struct AffineLevel {
    pub(in crate::raster) level: u32,
    /// Which of u and v fall along a row, and so are rounded up.
    pub(in crate::raster) falls: [bool; 2],
}

impl AffineLevel {
    /// Coordinates or steps in the level, from those in level 0, modulo 2²⁴: no texel's index needs more bits.
    #[inline(always)]
    pub(in crate::raster) fn of(self, [u, v]: [u32; 2]) -> [u32; 2] {
        let bias = |falls: bool| if falls { (1 << self.level) - 1 } else { 0 };
        let at = |of: u32, falls: bool| of.wrapping_add(bias(falls)) >> self.level;
        [at(u, self.falls[0]), at(v, self.falls[1])]
    }
}

/// Texture coordinates that are linear on the face.
///
/// ```text
/// u(x, y) = Σ λᵢ·dᵢ·uᵢ / Σ λᵢ·dᵢ
/// ```
///
/// with λ the [weights](Weights) of the corners and d their depths. No λ is negative at a covered centre, so a
/// numerator in f64 is off by at most 4 parts in 2⁵³ of 2³¹ · Σ λᵢ·dᵢ, however much of it cancels, and u by less than
/// 2⁻¹⁹.
#[derive(Clone, Copy, Debug)]
pub(in crate::raster) struct PerspectiveTexture {
    weights: Weights,
    /// Each corner's u, v and 1, times its depth; below 2⁶³.
    values: [[i64; 3]; 3],
    estimated: [[f64; 3]; 3],
    /// Change of the [sums](Self::sums) from one pixel to the next, and from one row to the next.
    pub(in crate::raster) steps: [[f64; 3]; 2],
}

/// The sum in f64.
#[inline]
fn estimate([wa, wb, wc]: [f64; 3], [a, b, c]: [f64; 3]) -> f64 {
    wa * a + wb * b + wc * c
}

/// The floor of a coordinate n / d, given an estimate less than ½ off.
#[inline]
fn floor(estimate: f64, n: i128, d: i128) -> i64 {
    if !HAS_F64 {
        // A mean of coordinates.
        return floor_of_wide(n, d);
    }
    // The floor or the next integer.
    let near = nearest_whole(estimate);
    near - i64::from(n < i128::from(near) * d)
}

impl PerspectiveTexture {
    #[inline]
    pub(in crate::raster) fn new(triangle: &SortedTriangle, [u, v]: [[i32; 3]; 2]) -> Self {
        let depths = [depth(triangle, 0), depth(triangle, 1), depth(triangle, 2)];
        let times =
            |[a, b, c]: [i32; 3]| [i64::from(a) * depths[0], i64::from(b) * depths[1], i64::from(c) * depths[2]];
        let values = [times(u), times(v), depths];
        let weights = Weights::new(triangle);
        let (mut estimated, mut steps) = ([[0.0; 3]; 3], [[0.0; 3]; 2]);
        if HAS_F64 {
            let (per_column, per_row) = (in_f64(weights.per_column), in_f64(weights.per_row));
            for (i, [a, b, c]) in values.into_iter().enumerate() {
                estimated[i] = [a as f64, b as f64, c as f64];
                (steps[0][i], steps[1][i]) = (estimate(per_column, estimated[i]), estimate(per_row, estimated[i]));
            }
        }
        Self { weights, values, estimated, steps }
    }

    /// The sum that all coordinates at a pixel are divided by: Σ λᵢ·dᵢ.
    pub(in crate::raster) fn denominator(&self, x: i32, y: i32) -> i128 {
        exact(self.weights.at(x, y), self.values[2])
    }

    /// The numerators and their divisor at a pixel, in f64; without f64, zeros.
    pub(in crate::raster) fn sums(&self, x: i32, y: i32) -> [f64; 3] {
        if !HAS_F64 {
            return [0.0; 3];
        }
        let at = in_f64(self.weights.at(x, y));
        self.estimated.map(|values| estimate(at, values))
    }

    /// The sum of the magnitudes of the weights' changes per pixel and per row.
    pub(in crate::raster) fn sides(&self) -> f64 {
        let changes = self.weights.per_column.into_iter().chain(self.weights.per_row);
        changes.fold(0.0, |sum, change| sum + change.unsigned_abs() as f64)
    }

    /// The coordinates at a pixel, rounded down; 16.16.
    #[inline]
    pub(in crate::raster) fn at(&self, x: i32, y: i32) -> [i32; 2] {
        let weights = self.weights.at(x, y);
        let of_f64 = in_f64(weights);
        let d = exact(weights, self.values[2]);
        let reciprocal = if HAS_F64 { 1.0 / estimate(of_f64, self.estimated[2]) } else { 0.0 };
        // A mean of the corners' coordinates, so it fits in 32 bits.
        let of = |i: usize| {
            floor(estimate(of_f64, self.estimated[i]) * reciprocal, exact(weights, self.values[i]), d) as i32
        };
        [of(0), of(1)]
    }
}
