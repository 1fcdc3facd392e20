//! The shading of a face, as a scene, a renderer and the 16.16 path name it.

use crate::names::named;
use crate::raster::Interpolation;

named! {
    /// The shading of a face, from cheap to exact.
    #[derive(Default)]
    pub enum Shading, "shading" {
        /// One shade for each face.
        Flat = "flat",
        /// The method printed in the sources: vertices on whole pixels, a step for every span by a division that cuts.
        /// Without exact cover (`raster::vintage`).
        GouraudVintage = "gouraud-vintage",
        /// Linear between the vertices in 8.8, each row of a triangle one span.
        Gouraud88 = "gouraud-8.8",
        /// Linear between the vertices in 8.8, started anew every 64 pixels, each row of a triangle one span: the
        /// default.
        #[default]
        Gouraud88Reseeded = "gouraud-8.8-reseeded",
        /// Linear between the vertices in 16.16, each row of a triangle one span.
        Gouraud1616 = "gouraud-16.16",
        /// Linear on the face in space, so perspective-correct: a quotient for every pixel.
        GouraudHyperbolic = "gouraud-hyperbolic",
        /// Faces split along their edges until linear shading fits.
        GouraudTessellated = "gouraud-tessellated",
        /// The Phong of 1994: the normal's x and y linear, light from a table of 256 × 256 shades.
        PhongTable = "phong-table",
        /// The normal at every pixel, perspective-correct and made unit again, and the whole model.
        Phong = "phong",
        /// Shades in f32, divided by w at the vertices and multiplied by it again at every pixel: the method of a
        /// program of today.
        Float = "gouraud-float",
    }
}

impl Shading {
    /// Returns whether light is computed at every pixel, and not at the vertices or for a face.
    #[must_use]
    pub const fn lights_pixels(self) -> bool {
        matches!(self, Self::PhongTable | Self::Phong)
    }

    /// The raster's interpolation for faces whose vertices are lit, if their shades differ.
    #[must_use]
    pub const fn interpolation(self) -> Interpolation {
        match self {
            Self::GouraudVintage => Interpolation::GouraudVintage,
            Self::Gouraud88 => Interpolation::Gouraud,
            Self::Gouraud1616 => Interpolation::Gouraud1616,
            Self::GouraudHyperbolic => Interpolation::GouraudHyperbolic,
            #[cfg(feature = "alloc")]
            Self::Float => Interpolation::Float,
            #[cfg(not(feature = "alloc"))]
            Self::Float => Interpolation::GouraudReseeded,
            Self::Flat | Self::Gouraud88Reseeded | Self::GouraudTessellated | Self::PhongTable | Self::Phong => {
                Interpolation::GouraudReseeded
            }
        }
    }

    /// Returns whether its faces cover the pixels whose centres are in them, and no others.
    #[must_use]
    pub const fn has_exact_cover(self) -> bool {
        self.interpolation().has_exact_cover()
    }

    /// The shading of the 16.16 vertex path for it: itself, or the default if that path lacks it.
    #[must_use]
    pub const fn in_integers(self) -> Self {
        match self {
            Self::GouraudTessellated | Self::PhongTable | Self::Phong | Self::Float => Self::Gouraud88Reseeded,
            shading => shading,
        }
    }
}
