//! What light needs at every pixel: normal and position, perspective-correct. A pass that writes no pixel.

use super::Kernel;
use crate::lanes::{LANES, Lanes, Points};

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

/// Six numbers at each of eight pixels of different rows: `a` and `d` are each one's own. See [`interpolate`].
#[inline]
#[must_use]
#[doc(hidden)]
pub fn interpolate_each(places: &Lanes<f64>, a: &[Lanes<f64>; 6], da: &[f64; 6], d: &Lanes<f64>, dd: f64) -> Points {
    each_inlined(places, a, da, d, dd)
}

#[inline(always)]
fn each_inlined(places: &Lanes<f64>, a: &[Lanes<f64>; 6], da: &[f64; 6], d: &Lanes<f64>, dd: f64) -> Points {
    let mut reciprocals = [0.0; LANES];
    for (reciprocal, (place, d)) in reciprocals.iter_mut().zip(places.iter().zip(d)) {
        *reciprocal = 1.0 / (d + *place * dd);
    }
    let mut points = [[0.0; LANES]; 6];
    for (values, (a, da)) in points.iter_mut().zip(a.iter().zip(da)) {
        for lane in 0..LANES {
            values[lane] = ((a[lane] + places[lane] * da) * reciprocals[lane]) as f32;
        }
    }
    points
}

impl Kernel {
    /// [`interpolate_each`] as the kernel's processor does it best: the same numbers.
    #[inline]
    #[must_use]
    pub(crate) fn interpolate_each(
        self,
        places: &Lanes<f64>,
        a: &[Lanes<f64>; 6],
        da: &[f64; 6],
        d: &Lanes<f64>,
        dd: f64,
    ) -> Points {
        #[cfg(all(feature = "simd", target_arch = "x86_64"))]
        if self.has_avx2() {
            return x86::interpolate_each(places, a, da, d, dd);
        }
        interpolate_each(places, a, da, d, dd)
    }

    /// [`interpolate_at`] as the kernel's processor does it best: the same numbers.
    #[inline]
    #[must_use]
    pub(crate) fn interpolate_at(self, places: &Lanes<f64>, a: &[f64; 6], da: &[f64; 6], d: f64, dd: f64) -> Points {
        #[cfg(all(feature = "simd", target_arch = "x86_64"))]
        if self.has_avx2() {
            return x86::interpolate_at(places, a, da, d, dd);
        }
        interpolate_at(places, a, da, d, dd)
    }
}

#[cfg(all(feature = "simd", target_arch = "x86_64"))]
#[expect(unsafe_code, reason = "code for processors found only when the program runs")]
mod x86 {
    use super::{Lanes, Points, each_inlined, interpolate_inlined};

    /// Only with a kernel for which `Kernel::has_avx2` is true.
    pub(super) fn interpolate_each(
        places: &Lanes<f64>,
        a: &[Lanes<f64>; 6],
        da: &[f64; 6],
        d: &Lanes<f64>,
        dd: f64,
    ) -> Points {
        #[target_feature(enable = "avx2")]
        fn avx2(places: &Lanes<f64>, a: &[Lanes<f64>; 6], da: &[f64; 6], d: &Lanes<f64>, dd: f64) -> Points {
            each_inlined(places, a, da, d, dd)
        }
        // SAFETY: such a kernel is given out only where AVX2 was found.
        unsafe { avx2(places, a, da, d, dd) }
    }

    /// Only with a kernel for which `Kernel::has_avx2` is true.
    pub(super) fn interpolate_at(places: &Lanes<f64>, a: &[f64; 6], da: &[f64; 6], d: f64, dd: f64) -> Points {
        #[target_feature(enable = "avx2")]
        fn avx2(places: &Lanes<f64>, a: &[f64; 6], da: &[f64; 6], d: f64, dd: f64) -> Points {
            interpolate_inlined(places, a, da, d, dd)
        }
        // SAFETY: such a kernel is given out only where AVX2 was found.
        unsafe { avx2(places, a, da, d, dd) }
    }
}
