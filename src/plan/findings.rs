//! Facts about an object that are only known after drawing, and their text.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;

use super::{Effect, FaceShading};
use crate::raster::effects::SampleSpacing;
use crate::settings::Shading;

/// Facts found out about an object while drawing it.
#[derive(Clone, PartialEq, Debug, Default)]
pub(crate) struct Findings {
    /// The number of its faces by shading, if an error budget chose the shading.
    pub face_counts: Option<FaceCounts>,
    /// The max difference between linear shades and per-pixel lighting, in shades of 1/255 of full
    /// intensity, if it is known.
    pub linear_error: Option<f64>,
}

impl Findings {
    /// The text added to the reason for an effect; may be empty.
    pub(super) fn text(&self, effect: Effect, on: bool) -> String {
        match (effect, &self.face_counts, self.linear_error) {
            (Effect::Gouraud, Some(counts), _) => format!(": {counts}"),
            (Effect::Phong | Effect::Tessellation, _, Some(shades)) if !on => {
                // Rounded up, because it is a bound.
                format!("; linear shades are off by at most {:.2}", libm::ceil(shades * 100.0) / 100.0)
            }
            _ => String::new(),
        }
    }
}

/// The number of an object's faces by the shading that an error budget gave them.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(crate) struct FaceCounts {
    /// Each shading in use, from cheap to exact, with the number of its faces.
    pub drawn: Vec<(FaceShading, u64)>,
    /// The number of faces that needed no decision, because they are not visible.
    pub not_drawn: u64,
}

/// Writes each count with its reason, then the number of faces not drawn.
impl fmt::Display for FaceCounts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (shading, count) in &self.drawn {
            write!(f, "{count} {shading} ({}), ", why(*shading))?;
        }
        write!(f, "{} not drawn", self.not_drawn)
    }
}

/// The budget's reason for choosing a shading.
fn why(shading: FaceShading) -> &'static str {
    match shading {
        FaceShading::By(Shading::Flat) => "one shade at their corners, or near enough",
        FaceShading::By(Shading::GouraudFloat) => "light is linear enough in space, but not on the screen",
        FaceShading::By(Shading::Phong) => "light is not known to be linear enough",
        FaceShading::By(_) => "light is linear enough on them",
        FaceShading::Quadratic => "light is quadratic on the screen",
        FaceShading::PhongEvery(SampleSpacing::Sixteen) => "lit at every 16th pixel, linear enough between",
        FaceShading::PhongEvery(SampleSpacing::Eight) => "lit at every 8th",
        FaceShading::PhongEvery(SampleSpacing::Four) => "lit at every 4th",
    }
}
