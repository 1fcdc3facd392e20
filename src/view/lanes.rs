//! Eight vertices at a time on the screen, in plain arrays that the compiler vectorises.
//!
//! Each vertex gets the numbers that [`ObjectView::project`] and [`ObjectView::project_inside`] give: the operations
//! and their order are the same, and each of them (sum, product, quotient) rounds alike in a vector and alone. The
//! rounding to 1/256 pixel stays in f32, where a coordinate within the limit is exact, and so is 256 times that:
//!
//! ```text
//! s = 256·x        |s| < 2²⁰
//! n = (s + 1.5·2²³) − 1.5·2²³        the nearest whole number, halves to even: below 2²² f32 holds no halves there
//! floor(s + ½) = n + 1 if s − n = ½, else n
//! ```
//!
//! s − n is exact: below 1 in magnitude and a multiple of the lesser of both units in the last place. It lies within
//! ±½, and −½ is a half that was rounded up already.

use glam::{Mat3, Vec3};

use super::ObjectView;
use crate::fixed::whole_part;
pub(crate) use crate::lanes::LANES;
use crate::raster::Vertex;

/// An object's way to the screen in f32.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Narrow {
    pub(crate) matrix: Mat3,
    pub(crate) offset: Vec3,
    pub(crate) centre: (f32, f32),
    pub(crate) near: f32,
}

/// Eight vertices on the screen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Eight {
    /// −1 for a vertex in front of the near plane and within the limit, else 0. For others the numbers below mean
    /// nothing.
    pub(crate) within: [i32; LANES],
    /// The coordinates in 1/256 pixel.
    pub(crate) x: [i32; LANES],
    pub(crate) y: [i32; LANES],
    pub(crate) depth: [i32; LANES],
}

impl ObjectView {
    /// The way in f32, unless f32 could overflow.
    pub(crate) fn narrow(&self) -> Option<Narrow> {
        let (matrix, offset) = self.fast?;
        Some(Narrow { matrix, offset, centre: self.centre, near: self.near })
    }
}

impl Narrow {
    /// The max coordinate, in pixels.
    pub(crate) const LIMIT: f32 = ObjectView::LIMIT as f32 + 0.5;

    /// Projects eight vertices: those for which [`ObjectView::project`] gives a vertex are within, the others are not.
    #[inline(always)]
    pub(crate) fn project(&self, points: &[Vec3; LANES]) -> Eight {
        const { assert!(Vertex::GUARD_BAND as f32 >= Self::LIMIT * 256.0) };
        let Self { matrix, offset, centre, near } = self;
        let (mut x, mut y, mut w) = ([0.0_f32; LANES], [0.0_f32; LANES], [0.0_f32; LANES]);
        for i in 0..LANES {
            let p = points[i];
            // As glam has it: column by column.
            let row = |k: usize| {
                let [a, b, c] = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|axis| axis.to_array()[k]);
                ((a * p.x + b * p.y) + c * p.z) + offset.to_array()[k]
            };
            w[i] = row(2);
            let inverse = 1.0 / w[i];
            x[i] = centre.0 + row(0) * inverse;
            y[i] = centre.1 + row(1) * inverse;
        }
        let mut eight = Eight { within: [0; LANES], x: [0; LANES], y: [0; LANES], depth: [0; LANES] };
        for i in 0..LANES {
            // NaN fails it.
            let is_within = (w[i] >= *near) & (x[i].abs() <= Self::LIMIT) & (y[i].abs() <= Self::LIMIT);
            eight.within[i] = -i32::from(is_within);
        }
        for (units_of, x) in eight.x.iter_mut().zip(&x) {
            *units_of = units(*x);
        }
        for (units_of, y) in eight.y.iter_mut().zip(&y) {
            *units_of = units(*y);
        }
        for (to, w) in eight.depth.iter_mut().zip(&w) {
            // As `ObjectView::depth`; 1 to 2³⁰ of what is within.
            let depth = whole_part(f64::from(*near) / f64::from(*w) * 1_073_741_824.0 + 0.5);
            *to = if depth > 1 { depth } else { 1 };
        }
        eight
    }
}

/// `floor(256·pixels + ½)` for a coordinate within the limit; some number for others.
#[inline(always)]
fn units(pixels: f32) -> i32 {
    const MAGIC: f32 = 12_582_912.0;
    let scaled = pixels * 256.0;
    let sum = scaled + MAGIC;
    // The number is in the low bits of the sum.
    let nearest = sum.to_bits().wrapping_sub(MAGIC.to_bits()).cast_signed();
    nearest.wrapping_add(i32::from(scaled - (sum - MAGIC) >= 0.5))
}
