//! Rendering preferences of a scene. The plan chooses those that are `None`.

use crate::mapping::Mapping;
use crate::names::named;
use crate::shading::Shading;
use crate::span::dither::DitherPattern;

named! {
    /// The way to leave out hidden surfaces.
    pub enum HiddenSurfaces, "way to hidden surfaces" {
        /// Faces turned away are not drawn; that is enough for one convex object.
        BackFaces = "back-faces",
        /// Far to near, each over those before it. Right for convex objects that lie one behind the other, drawn object
        /// by object. On request it is the painter's algorithm face by face, by the mean depth of a face's vertices:
        /// wrong where faces overlap in a circle or pass through each other.
        PainterOrder = "painter",
        /// A depth for every pixel.
        DepthBuffer = "depth-buffer",
        /// All faces of the frame at once, row by row, each pixel written once
        /// ([`raster::scan_line`](crate::raster::scan_line)). The bytes equal those with the depth buffer.
        ScanLine = "scan-line",
    }
}

/// Rendering preferences of a scene. The default has none: the plan then chooses the cheapest that is right.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Preferences {
    /// The technique of shading.
    pub shading: Option<Shading>,
    /// The way to leave out hidden surfaces, right or wrong.
    pub hidden_surfaces: Option<HiddenSurfaces>,
    /// The mapping of textures.
    pub mapping: Option<Mapping>,
    /// Textures have mipmaps.
    pub mipmaps: Option<bool>,
    /// The tessellation error, in shades of 1/255 of full intensity, above 0: faces are split until the shades on their
    /// edges are linear to this. [`Shading::GouraudTessellated`] uses one shade.
    pub tessellation: Option<f32>,
    /// Shades between two entries of a ramp are shown in this pattern of both.
    pub dither: Option<DitherPattern>,
    /// The max error of shades, in 1/255 of full intensity; above 0. Each triangle then gets the cheapest shading that
    /// is known to keep within, whatever `shading` says.
    pub max_error: Option<f32>,
    /// The time for a frame in milliseconds; above 0. Each frame is drawn within the least error that fits, at most
    /// `max_error`, and otherwise 16 shades, whatever `shading` says.
    pub max_time: Option<f32>,
    /// The palette is to be made from the scene's materials.
    pub auto_palette: bool,
}

impl Preferences {
    /// Checks the preferences; the error says what is wrong.
    pub(crate) fn check(&self) -> Result<(), &'static str> {
        let legal = |number: Option<f32>| number.is_none_or(|n| n > 0.0 && n.is_finite());
        if !legal(self.tessellation) || !legal(self.max_error) {
            Err("a number of shades must be above 0 and finite")
        } else if !legal(self.max_time) {
            Err("a time for a frame must be above 0 and finite")
        } else {
            Ok(())
        }
    }
}
