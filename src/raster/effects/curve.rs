//! Shades that are quadratic over a triangle, through six points.
//!
//! With L the weights of the corners, f the shades at the corners, m those at the edge midpoints, and D the second
//! differences along the edges:
//!
//! ```text
//! q = Σ fᵢLᵢ − 2 Σ Dᵢⱼ LᵢLⱼ          Dᵢⱼ = fᵢ − 2mᵢⱼ + fⱼ
//! ```
//!
//! This equals Σ fᵢLᵢ(2Lᵢ − 1) + Σ 4mᵢⱼLᵢLⱼ. Along an edge it is the parabola through that edge's three points,
//! whatever lies on either side of it.
//!
//! The weights at a pixel are exact, and none is negative where it is covered, so no term exceeds the six shades, and
//! f64 is accurate to a few parts in 2⁵⁰ however thin the triangle. Along a row of n pixels q = a + kb + k²c. Since |q|
//! ≤ 5/3 of the greatest shade M, n·|b| and n²·|c| are at most 8 · 5/3 · M (Markov): in f32 they are off by less than
//! 2⁻²⁰ · M together, a thousandth of a shade for shades up to 1.

use super::Limits;
use super::listing::FaceCorners;
use crate::fixed::U8F8;
use crate::lanes::three;
use crate::raster::reference::weights::{Weights, in_f64};
use crate::span::{Kernel, curve};

/// Greatest shade at a point, in 8.8: 2⁸ times the brightest that can be shown. It keeps sums finite.
const GREATEST: f32 = 16_777_216.0;

/// One shade or channel.
#[derive(Clone, Copy, Debug, Default)]
struct Curve {
    corners: [f64; 3],
    /// Twice D, for the edge opposite each corner.
    bends: [f64; 3],
    /// Change of the linear part from one pixel to the next, and c.
    step: f64,
    square: f64,
}

impl Curve {
    fn new(corners: [[f32; 6]; 3], channel: usize, [sa, sb, sc]: [f64; 3]) -> Self {
        // NaN becomes the least.
        #[expect(clippy::manual_clamp, reason = "clamp keeps NaN")]
        let shade = |value: f32| f64::from(value.max(-GREATEST).min(GREATEST));
        let [fa, fb, fc] = three(corners, |corner| shade(corner[channel]));
        let [ma, mb, mc] = three(corners, |corner| shade(corner[channel + 3]));
        let bend = |from: f64, middle: f64, to: f64| 2.0 * (from - 2.0 * middle + to);
        let [da, db, dc] = [bend(fb, ma, fc), bend(fc, mb, fa), bend(fa, mc, fb)];
        let square = -(da * (sb * sc) + db * (sc * sa) + dc * (sa * sb));
        Self { corners: [fa, fb, fc], bends: [da, db, dc], step: fa * sa + fb * sb + fc * sc, square }
    }

    /// a, b and c along a row from a pixel with these weights, which change by `[sa, sb, sc]` per
    /// pixel.
    #[inline]
    fn parabola(&self, [a, b, c]: [f64; 3], [sa, sb, sc]: [f64; 3]) -> [f32; 3] {
        let ([fa, fb, fc], [da, db, dc]) = (self.corners, self.bends);
        let at = fa * a + fb * b + fc * c - (da * (b * c) + db * (c * a) + dc * (a * b));
        let along = self.step - (da * (b * sc + sb * c) + db * (c * sa + sc * a) + dc * (a * sb + sa * b));
        [at as f32, along as f32, self.square as f32]
    }
}

/// One shade, or three channels, over a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct CurvePlane {
    weights: Weights,
    /// The reciprocal of the triangle's doubled area.
    share: f64,
    steps: [f64; 3],
    curves: [Curve; 3],
    limits: [Limits; 3],
}

impl CurvePlane {
    pub(super) fn new(face: &FaceCorners<'_>, limits: [Limits; 3], channels: usize) -> Self {
        let (triangle, corners) = (&face.triangle, face.lit());
        let weights = Weights::new(triangle);
        // At most 2⁴².
        let share = 1.0 / triangle.area() as f64;
        let steps = three(in_f64(weights.per_column), |step| step * share);
        let mut curves = [Curve::default(); 3];
        for (channel, curve) in curves.iter_mut().enumerate().take(channels) {
            *curve = Curve::new(corners, channel, steps);
        }
        let shown = |of: Limits| Limits { most: of.most.min(U8F8::MAX_VERTEX), least: of.least.min(U8F8::MAX_VERTEX) };
        Self { weights, share, steps, curves, limits: three(limits, shown) }
    }

    /// The shades of a channel from pixel (`x`, `y`) on, whose centre lies in the triangle.
    #[inline]
    pub(super) fn fill(&self, (x, y): (i32, i32), channel: usize, shades: &mut [u16], kernel: Kernel) {
        let weights = three(in_f64(self.weights.at(x, y)), |weight| weight * self.share);
        let Limits { least, most } = self.limits[channel];
        let parabola = self.curves[channel].parabola(weights, self.steps);
        curve::curve(kernel, shades, parabola, least.to_bits(), most.to_bits());
    }
}
