//! Normal and position at every pixel, perspective-correct, for lighting. This pass writes no pixel.

use super::Kernel;
use crate::lanes::{LANES, Lanes, Points, each};
use crate::simd::compiled_for_each_level;

/// Six numbers at each of eight pixels of a row, from pixel `first` on, each the quotient of two that change
/// linearly along it:
///
/// ```text
/// points[i][k − first] = (a[i] + k·da[i]) · (1 / (d + k·dd))
/// ```
///
/// in f64, with products, sums and one reciprocal, each rounded once and in this order, then rounded to f32. Every
/// point is computed from its own k, and does not depend on the point before it.
///
/// For Phong shading `a` is normal and position at pixel 0, each over w, and `d` is 1/w; `da` and `dd` are their
/// changes per pixel. Points beyond the end of a row may be anything.
///
/// The computation is floating-point by nature, so a processor without it pays for calling this (and only then: it is
/// compiled where it is called).
#[inline]
#[must_use]
pub fn interpolate(first: u16, a: &[f64; 6], da: &[f64; 6], d: f64, dd: f64) -> Points {
    let indices = each!(lane => f64::from(first) + lane as f64);
    divide(&numerators(&indices, a, da, d, dd))
}

compiled_for_each_level! {
    /// Six numbers at each of any eight pixels of a row, given by their indices; see [`interpolate`].
    #[inline]
    #[must_use]
    pub fn interpolate_at[][](
        kernel: Kernel, indices: &Lanes<f64>, a: &[f64; 6], da: &[f64; 6], d: f64, dd: f64,
    ) -> Points {
        divide(&numerators(indices, a, da, d, dd))
    }
}

/// The numerators of six numbers at each of eight pixels, and their denominators.
pub(crate) type Numerators = [Lanes<f64>; 7];

/// The dividends and divisors of [`interpolate_at`], also for pixels of different rows: [`divide`] computes its results
/// from them.
#[inline(always)]
pub(crate) fn numerators(indices: &Lanes<f64>, a: &[f64; 6], da: &[f64; 6], d: f64, dd: f64) -> Numerators {
    let mut numerators = [[0.0; LANES]; 7];
    // Index loops, as in `light::lanes`.
    let mut i = 0;
    while i < 6 {
        numerators[i] = each!(lane => a[i] + indices[lane] * da[i]);
        i += 1;
    }
    numerators[6] = each!(lane => d + indices[lane] * dd);
    numerators
}

/// The quotients of [`numerators`].
#[inline(always)]
pub(crate) fn divide(numerators: &Numerators) -> Points {
    let reciprocals: Lanes<f64> = each!(lane => 1.0 / numerators[6][lane]);
    let mut points = [[0.0; LANES]; 6];
    let mut i = 0;
    while i < 6 {
        points[i] = each!(lane => (numerators[i][lane] * reciprocals[lane]) as f32);
        i += 1;
    }
    points
}
