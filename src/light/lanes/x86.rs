//! Light at eight points, compiled for AVX2: four f64 at a time where SSE2 has two. (Frames lit at every
//! pixel: `teapot` and `phong` 8 % sooner, the torus, whose rows are of four pixels, no sooner.)

use super::Wides;
use crate::light::{Lights, Reflectance};
use crate::span::lit::Points;

/// Only with a kernel for which `Kernel::has_avx2` is true.
pub(super) fn one_channel<const UNIT: bool>(lights: &Lights<'_>, answer: &Reflectance, points: &Points) -> Wides {
    #[target_feature(enable = "avx2")]
    fn avx2<const UNIT: bool>(lights: &Lights<'_>, answer: &Reflectance, points: &Points) -> Wides {
        lights.one_channel_of_eight::<UNIT, false>(answer, points)
    }
    // SAFETY: such a kernel is given out only where AVX2 was found.
    unsafe { avx2::<UNIT>(lights, answer, points) }
}

/// Only with a kernel for which `Kernel::has_avx2` is true.
pub(super) fn three_channels<const UNIT: bool>(
    lights: &Lights<'_>,
    answer: &Reflectance,
    points: &Points,
) -> [Wides; 3] {
    #[target_feature(enable = "avx2")]
    fn avx2<const UNIT: bool>(lights: &Lights<'_>, answer: &Reflectance, points: &Points) -> [Wides; 3] {
        lights.three_channels_of_eight::<UNIT, false>(answer, points)
    }
    // SAFETY: such a kernel is given out only where AVX2 was found.
    unsafe { avx2::<UNIT>(lights, answer, points) }
}
