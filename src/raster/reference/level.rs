//! Mipmap levels: which one a pixel's texel comes from.
//!
//! A step of one pixel moves (∂u/∂x, ∂v/∂x) texels along a row of the screen, (∂u/∂y, ∂v/∂y) down a column. The longer
//! of the two steps, ρ, is the number of texels per pixel (L. Williams, *Pyramidal Parametrics*, SIGGRAPH 1983), and
//! the level is the one whose texels are nearest to ρ by ratio: the least n with ρ ≤ √2 · 2ⁿ, or the last level if
//! there is none. √2 is taken as 181/128, and a step's length as the longer side plus half the shorter one, which is up
//! to 12 % too long and never too short.
//!
//! Coordinates that are linear on the screen have one ρ, so a face has one level. For perspective-correct ones, with λ
//! the areas opposite the corners, A their sum, d the corners' depths and D = Σ λᵢdᵢ,
//!
//! ```text
//! ∂u/∂x = A · Σ dᵢdⱼ(uᵢ − uⱼ)(y − yₖ) / D²        over (i, j, k) = (0, 1, 2), (1, 2, 0), (2, 0, 1)
//! ∂u/∂y = A · Σ dᵢdⱼ(uⱼ − uᵢ)(x − xₖ) / D²
//! ```
//!
//! so one numerator is constant along a row, and the other is linear. The depth D / A is taken in whole sixteenths,
//! rounded down. Everything else is exact.

use super::cover::SortedTriangle;
use super::texture::{AffineLevel, AffinePlane};
use crate::span::hyperbolic::floor_quotient;

/// Twice the length of a step.
fn doubled([u, v]: [i128; 2]) -> u128 {
    let (u, v) = (u.unsigned_abs(), v.unsigned_abs());
    2 * u.max(v) + u.min(v)
}

/// The least level, up to `last`, at which neither of two steps is longer than √2 texels. `across` and `down` are twice
/// their lengths, and `unit` is a texel of level 0 in the same unit.
fn choose(across: u128, down: u128, unit: u128, last: u32) -> u32 {
    // Twice a length is below 2¹²¹, a unit below 2¹¹⁵.
    let (mut length, longest) = (64 * across.max(down), 181 * unit);
    let mut level = 0;
    while level < last && length > longest {
        // Rounded up: it is then above `longest` exactly where the exact half is.
        length = length.div_ceil(2);
        level += 1;
    }
    level
}

/// The level of a face whose coordinates, u and v, are linear on the screen. Its doubled area is at most 2⁴².
pub(in crate::raster) fn of_face(planes: &[AffinePlane; 2], area: i64, last: u32) -> AffineLevel {
    let [[ux, uy], [vx, vy]] = planes.each_ref().map(|plane| plane.gradient);
    // From one pixel to the next, times the area.
    let step = |u: i64, v: i64| doubled([256 * i128::from(u), 256 * i128::from(v)]);
    // Coordinates have 16 fraction bits.
    let level = choose(step(ux, vx), step(uy, vy), u128::from(area.unsigned_abs()) << 16, last);
    AffineLevel { level, falls: [ux < 0, vx < 0] }
}

/// Levels of a face with perspective-correct coordinates.
#[derive(Clone, Copy, Debug)]
pub(in crate::raster) struct LevelPlane {
    area: i64,
    /// The sums Σ dᵢdⱼ(uᵢ − uⱼ) for u and for v. Below: the same with each term times yₖ, and times xₖ.
    sums: [i128; 2],
    times_y: [i128; 2],
    times_x: [i128; 2],
}

impl LevelPlane {
    /// The plane of a triangle that is not degenerate, with these coordinates, u and v, and depths at its corners.
    pub(in crate::raster) fn new(triangle: &SortedTriangle, coordinates: [[i32; 3]; 2], depths: [i128; 3]) -> Self {
        let (mut sums, mut times_y, mut times_x) = ([0; 2], [0; 2], [0; 2]);
        for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            let corner = &triangle.vertices[k];
            for of in 0..2 {
                // Depths are below 2³².
                let term = depths[i] * depths[j] * (i128::from(coordinates[of][i]) - i128::from(coordinates[of][j]));
                sums[of] += term;
                times_y[of] += term * i128::from(corner.y().to_bits());
                times_x[of] += term * i128::from(corner.x().to_bits());
            }
        }
        Self { area: triangle.area(), sums, times_y, times_x }
    }

    /// Twice the length of the sums at a row or a column; `times` are the sums with the corners' coordinate as a
    /// factor.
    fn doubled_at(&self, pixel: i32, times: &[i128; 2]) -> u128 {
        let centre = i128::from(pixel) * 256 + 128;
        doubled([self.sums[0] * centre - times[0], self.sums[1] * centre - times[1]])
    }

    /// The part of [`at`](Self::at) that a row shares: twice the length of a step along it.
    pub(in crate::raster) fn across(&self, y: i32) -> u128 {
        self.doubled_at(y, &self.times_y)
    }

    /// The level at a pixel of column `x` whose centre lies in the triangle; D is `denominator`.
    pub(in crate::raster) fn at(&self, across: u128, x: i32, denominator: i128, last: u32) -> u32 {
        // A mean of depths from 1 to 2³², in sixteenths.
        let depth = floor_quotient(16 * denominator, i128::from(self.area)).unsigned_abs();
        // In texels a step is 256 · A · S / D² / 2¹⁶ = S / (A · (16 D / A)²), S being the sum.
        let unit = u128::from(self.area.unsigned_abs()) * u128::from(depth) * u128::from(depth);
        choose(across, self.doubled_at(x, &self.times_x), unit, last)
    }
}
