//! Perspective-correct shades: linear on the face, so a hyperbola along a row (S3).
//!
//! What is linear on a face in space is, over the screen, the quotient of two linear functions:
//! the value divided by w, and 1 / w. A vertex's depth is `2³⁰·near / w`, rounded, so with λ the
//! weights of the three vertices, which are areas and whole numbers,
//!
//! ```text
//! I(x, y) = Σ λᵢ·dᵢ·Iᵢ / Σ λᵢ·dᵢ
//! ```
//!
//! Numerator and denominator are exact: at most 2⁴² · 2³² · 2¹⁶. The byte is the nearest shade,
//! `floor((I + 128) / 256)`, in one quotient. It is in the range of the vertices because I is a mean of
//! theirs with weights that are not negative, and the quotient is exact. From the truth it is half a
//! shade off, and what the rounding of depths adds: for w from 1 to 10⁴ within one triangle a
//! depth is off by 5 parts in 10⁶ at most, a shade by 0.003.

use super::cover::Ordered;

/// A function that is linear over the screen, at pixel centres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Linear {
    origin: i128,
    per_column: i128,
    per_row: i128,
}

impl Linear {
    /// Of a triangle that is not degenerate, with these values at its vertices; each below 2⁶⁴.
    pub(super) fn new(triangle: &Ordered, [v0, v1, v2]: [i128; 3]) -> Self {
        let [(x0, y0), (x1, y1), (x2, y2)] =
            triangle.vertices.each_ref().map(|v| (i128::from(v.x().to_bits()), i128::from(v.y().to_bits())));
        let sign = i128::from(triangle.doubled_area.signum());
        let gx = ((v1 - v0) * (y2 - y0) - (v2 - v0) * (y1 - y0)) * sign;
        let gy = ((v2 - v0) * (x1 - x0) - (v1 - v0) * (x2 - x0)) * sign;
        Self {
            origin: v0 * i128::from(triangle.area()) + gx * (128 - x0) + gy * (128 - y0),
            per_column: gx * 256,
            per_row: gy * 256,
        }
    }

    /// The value times the triangle's doubled area at the centre of pixel (`x`, `y`).
    pub(super) fn at(&self, x: i32, y: i32) -> i128 {
        self.origin + self.per_column * i128::from(x) + self.per_row * i128::from(y)
    }

    /// What it changes by from one pixel to the next.
    pub(super) fn per_column(&self) -> i128 {
        self.per_column
    }
}

/// The perspective-correct shades of a triangle.
#[derive(Clone, Copy, Debug)]
pub struct HyperbolicPlane {
    numerator: Linear,
    denominator: Linear,
}

impl HyperbolicPlane {
    /// Of any three values of 0 to 0xFF00 at the corners of a triangle that is not degenerate, in the order of
    /// its vertices. A depth of 0 counts as 1.
    #[must_use]
    pub fn of_values(triangle: &Ordered, shades: [i64; 3]) -> Self {
        let depths = triangle.vertices.each_ref().map(|v| i128::from(v.depth().max(1)));
        let weighted = [0, 1, 2].map(|i| depths[i] * i128::from(shades[i]));
        Self { numerator: Linear::new(triangle, weighted), denominator: Linear::new(triangle, depths) }
    }

    /// Numerator and denominator of the exact shade at pixel (`x`, `y`), in 1/256.
    pub(super) fn shade(&self, x: i32, y: i32) -> (i128, i128) {
        (self.numerator.at(x, y), self.denominator.at(x, y))
    }

    /// Numerator and denominator of the byte at pixel (`x`, `y`), whose centre lies in the triangle.
    #[must_use]
    pub fn quotient(&self, x: i32, y: i32) -> (i128, i128) {
        let (n, d) = self.shade(x, y);
        (n + 128 * d, 256 * d)
    }

    /// What both change by from one pixel to the next.
    #[must_use]
    pub fn step(&self) -> (i128, i128) {
        let (n, d) = (self.numerator.per_column(), self.denominator.per_column());
        (n + 128 * d, 256 * d)
    }
}
