//! Normal and position at every pixel, perspective-correct, for light. The pass writes no pixel.

use super::Kernel;
use crate::lanes::{LANES, Lanes, Points};
use crate::simd::at_best_level;

/// Six numbers at each of eight pixels of a row, from pixel `first` on, each the quotient of two that change
/// linearly along it:
///
/// ```text
/// points[i][k − first] = (a[i] + k·da[i]) · (1 / (d + k·dd))
/// ```
///
/// in f64, products, sums and one reciprocal, each rounded once and in this order, then to f32. Every point
/// is made from its own k: it does not depend on how many were made before it, but for k itself.
///
/// For Phong's shading `a` is normal and position at pixel 0, each over w, and `d` is 1/w; `da` and
/// `dd` are what they change by from one pixel to the next. Beyond the end of a row points may be anything.
///
/// Floats are what it is about, so a processor without them pays for calling it (and only then: it is
/// compiled where it is called).
#[inline]
#[must_use]
pub fn interpolate(first: u16, a: &[f64; 6], da: &[f64; 6], d: f64, dd: f64) -> Points {
    let mut places = [0.0; LANES];
    for (lane, place) in (0_u16..).zip(&mut places) {
        *place = f64::from(first) + f64::from(lane);
    }
    interpolate_at(&places, a, da, d, dd)
}

/// Six numbers at each of any eight pixels of a row, given by their numbers; see [`interpolate`].
#[inline]
#[must_use]
#[doc(hidden)]
pub fn interpolate_at(places: &Lanes<f64>, a: &[f64; 6], da: &[f64; 6], d: f64, dd: f64) -> Points {
    interpolate_inlined(places, a, da, d, dd)
}

#[inline(always)]
fn interpolate_inlined(places: &Lanes<f64>, a: &[f64; 6], da: &[f64; 6], d: f64, dd: f64) -> Points {
    let mut reciprocals = [0.0; LANES];
    for (place, reciprocal) in places.iter().zip(&mut reciprocals) {
        *reciprocal = 1.0 / (d + *place * dd);
    }
    let mut points = [[0.0; LANES]; 6];
    for (values, (a, da)) in points.iter_mut().zip(a.iter().zip(da)) {
        for (value, (place, reciprocal)) in values.iter_mut().zip(places.iter().zip(&reciprocals)) {
            *value = ((a + place * da) * reciprocal) as f32;
        }
    }
    points
}

/// The numerators of six numbers at each of eight pixels, and their denominators.
#[doc(hidden)]
pub type Numerators = [Lanes<f64>; 7];

/// Dividends of [`interpolate_at`]: with [`divide`] they give its numbers, for pixels of different rows too.
#[inline]
#[must_use]
#[doc(hidden)]
pub fn numerators(places: &Lanes<f64>, a: &[f64; 6], da: &[f64; 6], d: f64, dd: f64) -> Numerators {
    numerators_inlined(places, a, da, d, dd)
}

#[inline(always)]
fn numerators_inlined(places: &Lanes<f64>, a: &[f64; 6], da: &[f64; 6], d: f64, dd: f64) -> Numerators {
    let mut numerators = [[0.0; LANES]; 7];
    for (values, (a, da)) in numerators.iter_mut().zip(a.iter().zip(da).chain([(&d, &dd)])) {
        for (value, place) in values.iter_mut().zip(places) {
            *value = a + place * da;
        }
    }
    numerators
}

/// The quotients of [`numerators`].
#[inline]
#[must_use]
#[doc(hidden)]
pub fn divide(numerators: &Numerators) -> Points {
    divide_inlined(numerators)
}

#[inline(always)]
fn divide_inlined([a, b, c, d, e, f, denominators]: &Numerators) -> Points {
    let mut reciprocals = [0.0; LANES];
    for (reciprocal, denominator) in reciprocals.iter_mut().zip(denominators) {
        *reciprocal = 1.0 / denominator;
    }
    [a, b, c, d, e, f].map(|numerators| {
        let mut values = [0.0; LANES];
        for (value, (numerator, reciprocal)) in values.iter_mut().zip(numerators.iter().zip(&reciprocals)) {
            *value = (numerator * reciprocal) as f32;
        }
        values
    })
}

impl Kernel {
    /// [`numerators`] as the kernel's processor does it best: the same numbers.
    #[inline]
    #[must_use]
    #[doc(hidden)]
    pub fn numerators(self, places: &Lanes<f64>, a: &[f64; 6], da: &[f64; 6], d: f64, dd: f64) -> Numerators {
        numerators_at_best(self, places, a, da, d, dd)
    }

    /// [`divide`] as the kernel's processor does it best: the same numbers.
    #[inline]
    #[must_use]
    #[doc(hidden)]
    pub fn divide(self, numerators: &Numerators) -> Points {
        divide_at_best(self, numerators)
    }

    /// [`interpolate_at`] as the kernel's processor does it best: the same numbers.
    #[inline]
    #[must_use]
    #[doc(hidden)]
    pub fn interpolate_at(self, places: &Lanes<f64>, a: &[f64; 6], da: &[f64; 6], d: f64, dd: f64) -> Points {
        interpolate_at_best(self, places, a, da, d, dd)
    }
}

at_best_level! {
    #[inline]
    fn numerators_at_best[][](
        kernel: Kernel, places: &Lanes<f64>, a: &[f64; 6], da: &[f64; 6], d: f64, dd: f64,
    ) -> Numerators {
        numerators_inlined(places, a, da, d, dd)
    }
}

at_best_level! {
    #[inline]
    fn divide_at_best[][](kernel: Kernel, numerators: &Numerators) -> Points {
        divide_inlined(numerators)
    }
}

at_best_level! {
    #[inline]
    fn interpolate_at_best[][](
        kernel: Kernel, places: &Lanes<f64>, a: &[f64; 6], da: &[f64; 6], d: f64, dd: f64,
    ) -> Points {
        interpolate_inlined(places, a, da, d, dd)
    }
}
