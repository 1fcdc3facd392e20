//! The stages compiled for AVX2.

use glam::Vec3;

use super::{Geometry, lanes};
use crate::light::Lights;
use crate::render::lit::LitVertices;
use crate::render::paint::Paint;
use crate::view::ObjectView;
use crate::view::lanes::Narrow;

/// Only with a kernel for which `Kernel::has_avx2` is true.
pub(super) fn project<const TESTED: bool>(
    view: &ObjectView,
    narrow: &Narrow,
    positions: &[Vec3],
    lit: &mut LitVertices,
) {
    #[target_feature(enable = "avx2")]
    fn avx2<const TESTED: bool>(view: &ObjectView, narrow: &Narrow, positions: &[Vec3], lit: &mut LitVertices) {
        lanes::project::<TESTED>(view, narrow, positions, lit);
    }
    // SAFETY: such a kernel is given out only where AVX2 was found.
    unsafe { avx2::<TESTED>(view, narrow, positions, lit) }
}

/// Only with a kernel for which `Kernel::has_avx2` is true.
pub(super) fn light_suns<const BOTH: bool>(
    geometry: &Geometry<'_>,
    paints: &[Paint],
    lights: &Lights<'_>,
    lit: &mut LitVertices,
) {
    #[target_feature(enable = "avx2")]
    fn avx2<const BOTH: bool>(geometry: &Geometry<'_>, paints: &[Paint], lights: &Lights<'_>, lit: &mut LitVertices) {
        lanes::light_suns::<BOTH>(geometry, paints, lights, lit);
    }
    // SAFETY: such a kernel is given out only where AVX2 was found.
    unsafe { avx2::<BOTH>(geometry, paints, lights, lit) }
}
