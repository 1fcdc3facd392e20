//! Rendering preferences of a scene. The plan chooses those that are `None`.

use super::names::named;
use crate::raster::Interpolation;

named! {
    /// How a face is shaded, from cheap to exact.
    #[derive(Default)]
    pub enum Shading, "shading" {
        /// One shade for each face.
        Flat = "flat",
        /// What the sources print: vertices on whole pixels, a step for every span by a division that cuts.
        /// Without exact cover ([`raster::vintage`](crate::raster::vintage)).
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
        /// Shades in f32, divided by w at the vertices and multiplied by it again at every pixel: what a program
        /// of today does.
        Float = "float",
    }
    /// There is no shading of that name. Its text lists those there are.
    pub struct UnknownShading;
}

named! {
    /// How hidden surfaces are left out.
    pub enum HiddenSurfaces, "way to hidden surfaces" {
        /// Faces turned away are not drawn; that is enough for one convex object.
        BackFaces = "back-faces",
        /// Far to near, each over what is there. Right for convex objects that lie one behind the other,
        /// drawn object by object. Asked for, it is the painter's algorithm face by face, by the mean
        /// depth of a face's vertices: wrong where faces overlap in a circle or pass through each other.
        PainterOrder = "painter",
        /// A depth for every pixel.
        DepthBuffer = "depth-buffer",
        /// All faces of the frame at once, row by row, each pixel written once
        /// ([`raster::scan_line`](crate::raster::scan_line)). The same bytes as with the depth buffer.
        ScanLine = "scan-line",
    }
    /// There is no way to leave out hidden surfaces of that name. Its text lists those there are.
    pub struct UnknownHiddenSurfaces;
}

named! {
    /// How a texture's coordinates run over a face.
    #[derive(Default)]
    pub enum Mapping, "mapping" {
        /// Linear on the screen, as for a face that is seen straight on.
        #[default]
        Affine = "affine",
        /// Right at every sixteenth pixel, linear between.
        Every16 = "every-16",
        /// Right at every pixel: two quotients each.
        Perspective = "perspective",
    }
    /// There is no mapping of that name. Its text lists those there are.
    pub struct UnknownMapping;
}

impl Shading {
    /// Whether light is worked out at every pixel, and not at the vertices or for a face.
    #[must_use]
    pub const fn lights_pixels(self) -> bool {
        matches!(self, Self::PhongTable | Self::Phong)
    }

    /// How the raster shades faces whose vertices are lit, where their shades differ.
    #[must_use]
    pub const fn interpolation(self) -> Interpolation {
        match self {
            Self::GouraudVintage => Interpolation::GouraudVintage,
            Self::Gouraud88 => Interpolation::Gouraud,
            Self::Gouraud1616 => Interpolation::Gouraud1616,
            Self::GouraudHyperbolic => Interpolation::GouraudHyperbolic,
            Self::Float => Interpolation::Float,
            Self::Flat | Self::Gouraud88Reseeded | Self::GouraudTessellated | Self::PhongTable | Self::Phong => {
                Interpolation::GouraudReseeded
            }
        }
    }

    /// Whether its faces cover the pixels whose centres are in them, and no others.
    #[must_use]
    pub const fn has_exact_cover(self) -> bool {
        self.interpolation().has_exact_cover()
    }

    /// What the 16.16 vertex path draws for it: the same, or of what it lacks the default.
    #[must_use]
    pub const fn in_integers(self) -> Self {
        match self {
            Self::GouraudTessellated | Self::PhongTable | Self::Phong | Self::Float => Self::Gouraud88Reseeded,
            shading => shading,
        }
    }
}

/// What a scene asks for. The default asks for nothing: the plan then chooses the cheapest that is
/// right.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Preferences {
    /// The technique of shading.
    pub shading: Option<Shading>,
    /// How hidden surfaces are left out, right or wrong.
    pub hidden_surfaces: Option<HiddenSurfaces>,
    /// How textures are mapped.
    pub mapping: Option<Mapping>,
    /// Whether textures have mipmaps.
    pub mipmaps: Option<bool>,
    /// Faces are split until the shades on their edges are linear to so many shades of 1/255 of
    /// full intensity; above 0. [`Shading::GouraudTessellated`] asks for one shade.
    pub tessellation: Option<f32>,
    /// Shades between two entries of a ramp are shown as a pattern of both.
    pub dither: bool,
    /// How many shades of error are accepted, of 1/255 of full intensity; above 0. Each triangle then gets the
    /// cheapest shading that is known to keep within, whatever `shading` says.
    pub max_error: Option<f32>,
    /// The palette is to be made from the scene's materials.
    pub auto_palette: bool,
}

impl Preferences {
    /// What is wrong with them, if anything.
    pub(crate) fn check(&self) -> Result<(), &'static str> {
        let legal = |number: Option<f32>| number.is_none_or(|n| n > 0.0 && n.is_finite());
        if legal(self.tessellation) && legal(self.max_error) {
            Ok(())
        } else {
            Err("a number of shades must be above 0 and finite")
        }
    }
}
