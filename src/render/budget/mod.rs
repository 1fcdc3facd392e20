//! The error budget: the cheapest shading for each triangle that is known to stay within it.
//!
//! One bound says how far linear shades are from the model's light on a patch of a surface (`bound`). It is computed
//! for clusters of eight faces, for eight faces one by one, and for parts of one face. Faces that it leaves undecided
//! are lit at some points (`fit`). `docs/budget.md` has the proofs.
//!
//! | file | what |
//! |---|---|
//! | `bound` | the bound |
//! | `ranges` | ranges of cosines and distances, from corners or from boxes and cones |
//! | `clusters` | eight faces each, with a box and a cone of normals |
//! | `classify` | which faces of a chunk are linear |
//! | `fit` | linear and quadratic functions, tested on points of a face |
//! | `bound_tests` | the bound against sampled light |

mod bound;
#[cfg(all(test, feature = "std"))]
mod bound_tests;
mod classify;
mod clusters;
mod fit;
mod ranges;

use self::clusters::Clusters;
pub(super) use self::fit::limits;
use super::geometry::Geometry;
use super::surface_material::SurfaceMaterial;
use crate::light::Lights;
use crate::plan::FaceShading;
use crate::settings::Shading;

/// Shadings of faces that are linear on the screen, linear on the face, or lit at every pixel.
pub(super) const LINEAR: FaceShading = FaceShading::By(Shading::Gouraud88Reseeded);
pub(super) const FLOAT: FaceShading = FaceShading::By(Shading::GouraudFloat);
pub(super) const PHONG: FaceShading = FaceShading::By(Shading::Phong);

/// Rounding of a linear shade reseeded every 64 pixels: a half, 1/512 for the vertices' shades, a quarter of drift, and
/// 1/2,000 for the bound itself.
const LINEAR_ROUNDING: f32 = 0.7525;

/// Rounding of an otherwise exact shade: a half, 1/512 for the vertices' shades, 1/100 for f32, and
/// the bound's.
const EXACT_ROUNDING: f32 = 0.5125;

/// Error budget of an object: the data that its decisions are based on.
#[derive(Debug, Default)]
pub(super) struct Budget {
    clusters: Clusters,
    /// In shades.
    allowed: f32,
    /// True if no light and no material takes light away.
    adds: bool,
}

impl Budget {
    /// Updates the budget to the object's current state, with its geometry if that has changed.
    #[inline(never)]
    pub(super) fn renew(
        &mut self,
        allowed: f32,
        changed: Option<&Geometry<'_>>,
        lights: &Lights<'_>,
        materials: &[SurfaceMaterial],
    ) {
        (self.allowed, self.adds) = (allowed, adds(lights, materials));
        if let Some(geometry) = changed {
            self.clusters = Clusters::new(geometry);
        }
    }

    /// The error that remains for the light if a shade is also off by `rounding`, as a fraction of full intensity.
    fn spare(&self, rounding: f32) -> f32 {
        (self.allowed - rounding) / 255.0
    }
}

/// Returns whether no light and no material takes light away.
fn adds(lights: &Lights<'_>, materials: &[SurfaceMaterial]) -> bool {
    let is_light = |intensity: f32, channels: [f32; 3]| intensity >= 0.0 && channels.iter().all(|c| *c >= 0.0);
    lights.suns.iter().all(|sun| is_light(sun.intensity, sun.channels))
        && lights.lamps.iter().all(|lamp| is_light(lamp.intensity, lamp.channels))
        && materials.iter().all(|SurfaceMaterial { reflectance: of, .. }| {
            let shares = [of.diffuse, of.specular].into_iter().chain(of.color).chain(of.highlight);
            shares.into_iter().all(|share| share >= 0.0)
        })
}
