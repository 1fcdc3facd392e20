//! What is known of vertices, compiled for AVX2: eight f32 at a time.

use super::{Corners, Nearest};
use crate::light::Lights;

/// Only with a kernel for which `Kernel::has_avx2` is true.
pub(super) fn chords(corners: Corners<'_>, lights: &Lights<'_>, chords: &mut [f32]) -> Nearest {
    #[target_feature(enable = "avx2")]
    fn avx2(corners: Corners<'_>, lights: &Lights<'_>, chords: &mut [f32]) -> Nearest {
        corners.chords(lights, chords)
    }
    // SAFETY: such a kernel is given out only where AVX2 was found.
    unsafe { avx2(corners, lights, chords) }
}

/// Only with a kernel for which `Kernel::has_avx2` is true.
pub(super) fn mark(corners: Corners<'_>, lights: &Lights<'_>, flags: &mut [u8]) {
    #[target_feature(enable = "avx2")]
    fn avx2(corners: Corners<'_>, lights: &Lights<'_>, flags: &mut [u8]) {
        corners.mark(lights, flags);
    }
    // SAFETY: such a kernel is given out only where AVX2 was found.
    unsafe { avx2(corners, lights, flags) }
}
