//! Per-face shadings: those that a budget chooses from, and the keys of its counts.

use core::fmt;

use crate::raster::Interpolation;
use crate::raster::effects::SampleSpacing;
use crate::settings::Shading;

/// The shading of a face: one of the [`Shading`]s, or an approximation of per-pixel lighting that
/// only an error budget chooses.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum FaceShading {
    /// One of the shadings that can be requested.
    By(Shading),
    /// Quadratic on the screen, interpolating light at six points of the face: its corners and the
    /// midpoints of its edges.
    Quadratic,
    /// Light at every few pixels of a row, linear in between.
    PhongEvery(SampleSpacing),
}

impl FaceShading {
    /// All shadings of a face, from cheap to exact.
    pub const ALL: [Self; Shading::ALL.len() + 4] = [
        Self::By(Shading::Flat),
        Self::By(Shading::GouraudVintage),
        Self::By(Shading::Gouraud88),
        Self::By(Shading::Gouraud88Reseeded),
        Self::By(Shading::Gouraud1616),
        Self::By(Shading::GouraudHyperbolic),
        Self::By(Shading::GouraudTessellated),
        Self::By(Shading::PhongTable),
        Self::By(Shading::GouraudFloat),
        Self::Quadratic,
        Self::PhongEvery(SampleSpacing::Sixteen),
        Self::PhongEvery(SampleSpacing::Eight),
        Self::PhongEvery(SampleSpacing::Four),
        Self::By(Shading::Phong),
    ];

    /// The shading's name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::By(shading) => shading.name(),
            Self::Quadratic => "phong-quadratic",
            Self::PhongEvery(SampleSpacing::Sixteen) => "phong-every-16",
            Self::PhongEvery(SampleSpacing::Eight) => "phong-every-8",
            Self::PhongEvery(SampleSpacing::Four) => "phong-every-4",
        }
    }

    /// Returns whether light is computed at points of the face other than its corners.
    #[must_use]
    pub const fn lights_pixels(self) -> bool {
        match self {
            Self::By(shading) => shading.lights_pixels(),
            Self::Quadratic | Self::PhongEvery(_) => true,
        }
    }

    /// The raster's interpolation of the corners' shades, where those are drawn.
    pub(crate) const fn interpolation(self) -> Interpolation {
        match self {
            Self::By(shading) => shading.interpolation(),
            Self::Quadratic | Self::PhongEvery(_) => Shading::Phong.interpolation(),
        }
    }

    /// Its index in [`ALL`](Self::ALL).
    pub(crate) fn index(self) -> usize {
        Self::ALL.iter().position(|shading| *shading == self).unwrap_or_default()
    }
}

impl Default for FaceShading {
    fn default() -> Self {
        Self::By(Shading::default())
    }
}

impl From<Shading> for FaceShading {
    fn from(shading: Shading) -> Self {
        Self::By(shading)
    }
}

impl fmt::Display for FaceShading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use super::*;

    #[test]
    fn every_way_to_shade_a_face_has_one_name_and_one_index() {
        let mut names: Vec<&str> = FaceShading::ALL.map(FaceShading::name).to_vec();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), FaceShading::ALL.len());
        for (index, shading) in FaceShading::ALL.into_iter().enumerate() {
            assert_eq!(shading.index(), index);
        }
        let listed = |shading| FaceShading::ALL.contains(&shading);
        assert!(Shading::ALL.into_iter().all(|shading| listed(FaceShading::By(shading))));
        assert!(SampleSpacing::ALL.into_iter().all(|spacing| listed(FaceShading::PhongEvery(spacing))));
    }
}
