//! The bounds of eight faces, compiled for AVX2: eight f32 at a time.

use super::{Eight, Falling};
use crate::lanes::Lanes;

/// Only with a kernel for which `Kernel::has_avx2` is true.
pub(super) fn model(falling: &Falling<'_>, eight: &Eight) -> [Lanes<f32>; 2] {
    #[target_feature(enable = "avx2")]
    fn avx2(falling: &Falling<'_>, eight: &Eight) -> [Lanes<f32>; 2] {
        falling.model(eight)
    }
    // SAFETY: such a kernel is given out only where AVX2 was found.
    unsafe { avx2(falling, eight) }
}
