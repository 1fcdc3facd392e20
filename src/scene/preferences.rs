//! Rendering preferences of a scene. The plan chooses those that are `None`.

use crate::names::named;
use crate::shading::Shading;

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
