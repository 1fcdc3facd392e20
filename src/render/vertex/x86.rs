//! The stages compiled for AVX2.

use glam::Vec3;

use super::{Geometry, lanes};
use crate::fixed::U8F8;
use crate::light::Lights;
use crate::render::lit::{LitVertices, Place};
use crate::render::paint::Paint;
use crate::view::ObjectView;
use crate::view::lanes::{LANES, Narrow};

/// Only with a kernel for which `Kernel::has_avx2` is true.
pub(super) fn project<const TESTED: bool>(
    view: &ObjectView,
    narrow: &Narrow,
    positions: &[Vec3],
    lit: &mut LitVertices,
) {
    #[target_feature(enable = "avx2")]
    fn avx2<const TESTED: bool>(view: &ObjectView, narrow: &Narrow, positions: &[Vec3], lit: &mut LitVertices) {
        lanes::project::<TESTED>(view, narrow, positions, lit, |narrow, points, places, depths| {
            project_eight(narrow, points, places, depths);
        });
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
        lanes::light_suns::<BOTH>(geometry, paints, lights, lit, |paint, lights, normals, shades| {
            light_eight::<BOTH>(paint, lights, normals, shades);
        });
    }
    // SAFETY: such a kernel is given out only where AVX2 was found.
    unsafe { avx2::<BOTH>(geometry, paints, lights, lit) }
}

/// As `lanes::project_eight_apart`.
#[inline(never)]
#[target_feature(enable = "avx2")]
fn project_eight(narrow: &Narrow, points: &[Vec3; LANES], places: &mut [Place; LANES], depths: &mut [u32; LANES]) {
    lanes::project_eight(narrow, points, places, depths);
}

/// As `lanes::project_eight_apart`.
#[inline(never)]
#[target_feature(enable = "avx2")]
fn light_eight<const BOTH: bool>(
    paint: &Paint,
    lights: &Lights<'_>,
    normals: &[Vec3; LANES],
    shades: &mut [[U8F8; 2]; LANES],
) {
    lanes::light_eight::<BOTH>(paint, lights, normals, shades);
}
