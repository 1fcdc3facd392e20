//! Shadings of faces, as named by scenes, renderers and the 16.16 path.

use crate::names::named;
use crate::raster::Interpolation;

named! {
    /// The shading of a face, roughly from cheap to exact.
    #[derive(Default)]
    pub enum Shading, "shading" {
        /// One shade for each face.
        Flat = "flat",
        /// The method printed in the sources: vertices on whole pixels, and for every span a step
        /// from a truncating division. Its coverage is not exact.
        GouraudVintage = "gouraud-vintage",
        /// Linear between the vertices in 8.8, with each row of a triangle as one span.
        Gouraud88 = "gouraud-8.8",
        /// Linear between the vertices in 8.8, reseeded every 64 pixels, with each row of a triangle as one span: the
        /// default.
        #[default]
        Gouraud88Reseeded = "gouraud-8.8-reseeded",
        /// Linear between the vertices in 16.16, with each row of a triangle as one span.
        Gouraud1616 = "gouraud-16.16",
        /// Linear on the face in space, so perspective-correct: a division for every pixel.
        GouraudHyperbolic = "gouraud-hyperbolic",
        /// Faces split along their edges until linear shading fits.
        GouraudTessellated = "gouraud-tessellated",
        /// The Phong shading of 1994: the normal's x and y are linear, and light comes from a table of 256 × 256
        /// shades.
        PhongTable = "phong-table",
        /// The interpolated normal at every pixel, perspective-correct and renormalised, with the full lighting model.
        Phong = "phong",
        /// Shades in f32, divided by w at the vertices and multiplied by it again at every pixel: what a program would
        /// do today.
        GouraudFloat = "gouraud-float",
    }
}

impl Shading {
    /// Returns whether light is computed at every pixel rather than per vertex or per face.
    #[must_use]
    pub const fn lights_pixels(self) -> bool {
        matches!(self, Self::PhongTable | Self::Phong)
    }

    /// The raster's interpolation for faces lit at their vertices, if the shades differ.
    #[must_use]
    pub const fn interpolation(self) -> Interpolation {
        match self {
            Self::GouraudVintage => Interpolation::GouraudVintage,
            Self::Gouraud88 => Interpolation::Gouraud88,
            Self::Gouraud1616 => Interpolation::Gouraud1616,
            Self::GouraudHyperbolic => Interpolation::GouraudHyperbolic,
            #[cfg(feature = "alloc")]
            Self::GouraudFloat => Interpolation::GouraudFloat,
            #[cfg(not(feature = "alloc"))]
            Self::GouraudFloat => Interpolation::Gouraud88Reseeded,
            Self::Flat | Self::Gouraud88Reseeded | Self::GouraudTessellated | Self::PhongTable | Self::Phong => {
                Interpolation::Gouraud88Reseeded
            }
        }
    }

    /// Returns whether faces drawn with it cover exactly the pixels whose centres are inside them.
    #[must_use]
    pub const fn has_exact_cover(self) -> bool {
        self.interpolation().has_exact_cover()
    }

    /// The shading that the 16.16 vertex path uses instead of this one: itself, or the default if that path lacks it.
    #[must_use]
    pub const fn in_integers(self) -> Self {
        match self {
            Self::GouraudTessellated | Self::PhongTable | Self::Phong | Self::GouraudFloat => Self::Gouraud88Reseeded,
            shading => shading,
        }
    }
}
