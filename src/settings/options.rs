//! The options struct that scenes and renderers share, and how the two are merged.

use core::fmt;

use super::{DitherPattern, Mapping, Shading};
use crate::names::named;

named! {
    /// A method for removing hidden surfaces.
    pub enum HiddenSurfaces, "hidden-surface method" {
        /// Back faces are culled, which is enough for a single convex object.
        BackFaces = "back-faces",
        /// Far to near. If the plan chooses it, objects are painted one by one, which is right because they are convex
        /// and lie one behind the other. If you ask for it, all faces are sorted by the mean depth of their vertices,
        /// which is wrong where faces intersect or overlap cyclically.
        PainterOrder = "painter",
        /// A depth for every pixel.
        DepthBuffer = "depth-buffer",
        /// All faces of the frame at once, row by row, each pixel written once. Draws the same bytes as the depth
        /// buffer, except where `gouraud-vintage` covers pixels outside of a face.
        ScanLine = "scan-line",
    }
}

named! {
    /// The arithmetic from a mesh to its projected vertices. The same rasterizer draws the result of either.
    #[derive(Default)]
    pub enum VertexPath, "vertex path" {
        /// Vertices in f32.
        #[default]
        Float = "float",
        /// Vertices in 16.16, by [`integer`](crate::integer), for processors without floating point; elsewhere it is
        /// the slower path. The scene's own numbers are floats, so they are converted: a mesh when it is first seen,
        /// angles to the nearest 1/65,536 of a turn.
        ///
        /// It draws matt surfaces under suns, flat or by Gouraud shading. Lamps, highlights, colours, textures, fog,
        /// transparency and dither are left out, as the [plan](crate::plan) says.
        Integer = "fixed",
    }
}

/// The accuracy of shades: one enum, so that a shading and a budget cannot both be set.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Accuracy {
    /// Every face gets this shading, with whatever error it has.
    Shading(Shading),
    /// An error of at most this many shades, each 1/255 of full intensity: every face gets the
    /// cheapest shading known to stay within it. A number that is not finite and above 0 is an
    /// error when a scene is drawn.
    WithinError(f32),
}

impl Accuracy {
    /// The shading; for an error budget, the default, which faces get if they need no decision.
    #[must_use]
    pub fn shading(self) -> Shading {
        match self {
            Self::Shading(shading) => shading,
            Self::WithinError(_) => Shading::default(),
        }
    }

    /// The accepted error in shades, if there is an error budget.
    #[must_use]
    pub const fn max_error(self) -> Option<f32> {
        match self {
            Self::Shading(_) => None,
            Self::WithinError(shades) => Some(shades),
        }
    }
}

impl Default for Accuracy {
    fn default() -> Self {
        Self::Shading(Shading::default())
    }
}

impl From<Shading> for Accuracy {
    fn from(shading: Shading) -> Self {
        Self::Shading(shading)
    }
}

/// Writes the shading's name, or `within 4 shades`.
impl fmt::Display for Accuracy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shading(shading) => shading.fmt(f),
            Self::WithinError(shades) => {
                write!(f, "within {shades} {}", if *shades == 1.0 { "shade" } else { "shades" })
            }
        }
    }
}

/// Drawing options: a scene states its preferences, and a renderer may override them. Anything that is `None` in both
/// is left to the plan, which chooses the cheapest method that is correct.
///
/// Shading is the exception. Without an accuracy, light is computed at the vertices and is linear in between, which
/// misses highlights and spot lights inside large faces. Where these matter, set [`Accuracy::WithinError`] or
/// [`Shading::Phong`].
///
/// ```
/// use mode13h::settings::Settings;
///
/// let scene = Settings { mipmaps: Some(true), tessellation: Some(5.0), ..Settings::default() };
/// let renderer = Settings { accuracy: Some(mode13h::settings::Accuracy::WithinError(2.0)), ..Settings::default() };
/// let merged = renderer.or(&scene);
/// assert_eq!((merged.mipmaps, merged.tessellation), (Some(true), Some(5.0)));
/// ```
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Settings {
    /// The accuracy of shades: a shading, or an error budget.
    pub accuracy: Option<Accuracy>,
    /// The hidden-surface method, used even if it draws the scene wrongly. Scan-line, which shows one face at each pixel,
    /// is replaced by the depth buffer if an object is transparent.
    pub hidden_surfaces: Option<HiddenSurfaces>,
    /// The mapping of textures.
    pub mapping: Option<Mapping>,
    /// Whether textures are mipmapped.
    pub mipmaps: Option<bool>,
    /// The tessellation error, in shades of 1/255 of full intensity, above 0. Edges are halved until the brightness at
    /// their middles is linear to within this, and no lamp or highlight near them bends it further: into 64 parts at
    /// most, until there are 262,144 triangles. Highlights that pass between distant vertices of a round object and the
    /// cones of spot lights may be missed. [`Shading::GouraudTessellated`] alone uses one shade.
    pub tessellation: Option<f32>,
    /// The dither pattern for shades between two entries of a ramp.
    pub dither: Option<DitherPattern>,
    /// The arithmetic for vertices; f32 unless 16.16 is requested. 16.16 has no error budget and
    /// lacks some shadings; the default shading replaces them.
    pub vertex_path: Option<VertexPath>,
    /// The number of fractional bits of projected vertices: 8, or fewer, to which they are rounded
    /// once more, half up. 0 puts vertices on whole pixels, so that a slowly moving model wobbles.
    /// Points made by clipping keep their 8 bits, and so does the 16.16 path; the stated errors of
    /// shadings, and the errors that budgets prove, are for 8. Rounding may dent a convex object, on
    /// which hidden-surface methods then differ by some pixels.
    pub vertex_bits: Option<u8>,
    /// Whether to light every material on three channels and draw it in the nearest colours,
    /// coloured or not. This suits palettes of few colours: there dithering reaches textures, too.
    pub channels: Option<bool>,
}

impl Settings {
    /// The tessellation error, in shades, if only the shading requests tessellation.
    const DEFAULT_TESSELLATION: f32 = 1.0;

    /// These settings, completed by those of `other`.
    #[must_use]
    pub fn or(&self, other: &Self) -> Self {
        Self {
            accuracy: self.accuracy.or(other.accuracy),
            hidden_surfaces: self.hidden_surfaces.or(other.hidden_surfaces),
            mapping: self.mapping.or(other.mapping),
            mipmaps: self.mipmaps.or(other.mipmaps),
            tessellation: self.tessellation.or(other.tessellation),
            dither: self.dither.or(other.dither),
            vertex_path: self.vertex_path.or(other.vertex_path),
            vertex_bits: self.vertex_bits.or(other.vertex_bits),
            channels: self.channels.or(other.channels),
        }
    }

    /// The accuracy that the vertex path can provide in place of the one requested.
    #[must_use]
    pub fn drawn_accuracy(&self) -> Accuracy {
        match self.accuracy.unwrap_or_default() {
            Accuracy::Shading(shading) if self.is_integer() => shading.in_integers().into(),
            Accuracy::WithinError(_) if self.is_integer() => Accuracy::default(),
            asked => asked,
        }
    }

    /// Returns whether vertices are transformed in 16.16.
    pub(crate) fn is_integer(&self) -> bool {
        self.vertex_path == Some(VertexPath::Integer)
    }

    /// Returns whether faces are to be split. An error budget limits the error by other means.
    pub(crate) fn tessellates(&self) -> bool {
        let accuracy = self.drawn_accuracy();
        let asks_for_splitting = accuracy.shading() == Shading::GouraudTessellated || self.tessellation.is_some();
        asks_for_splitting && accuracy.max_error().is_none()
    }

    /// The tolerance, in shades, for how far the shades along the edges of split faces may be from linear.
    pub(crate) fn tolerance(&self) -> f32 {
        self.tessellation.unwrap_or(Self::DEFAULT_TESSELLATION)
    }

    /// Checks the settings; the error says what is wrong.
    pub(crate) fn check(&self) -> Result<(), &'static str> {
        let legal = |number: Option<f32>| number.is_none_or(|n| n > 0.0 && n.is_finite());
        if !legal(self.tessellation) || !legal(self.accuracy.and_then(Accuracy::max_error)) {
            return Err("a number of shades must be above 0 and finite");
        }
        if self.vertex_bits.is_some_and(|bits| bits > 8) {
            return Err("vertices have at most 8 fraction bits");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every combination of what a renderer and a scene may say about accuracy, against a table.
    #[test]
    fn the_renderer_counts_before_the_scene() {
        let phong = Accuracy::Shading(Shading::Phong);
        for own in [None, Some(phong), Some(Accuracy::WithinError(2.0))] {
            for of_scene in [None, Some(Shading::Flat.into()), Some(Accuracy::WithinError(4.0))] {
                for vertex_path in VertexPath::ALL {
                    let settings = Settings { accuracy: own, vertex_path: Some(vertex_path), ..Settings::default() };
                    let scene = Settings { accuracy: of_scene, ..Settings::default() };
                    let merged = settings.or(&scene);
                    let asked = own.or(of_scene).unwrap_or_default();
                    assert_eq!(merged.accuracy.unwrap_or_default(), asked);
                    let drawn = match (vertex_path, asked) {
                        (VertexPath::Float, asked) => asked,
                        // 16.16 has flat shading, but neither per-pixel light nor a budget.
                        (_, Accuracy::Shading(Shading::Flat)) => asked,
                        _ => Accuracy::default(),
                    };
                    assert_eq!(merged.drawn_accuracy(), drawn, "{settings:?} {scene:?}");
                }
            }
        }
    }

    #[test]
    fn a_shading_asks_for_splitting_and_a_budget_for_none() {
        let of = |accuracy: Accuracy, tessellation| {
            let settings = Settings { accuracy: Some(accuracy), tessellation, ..Settings::default() };
            (settings.tessellates(), settings.tolerance())
        };
        assert_eq!(of(Shading::GouraudTessellated.into(), None), (true, 1.0));
        assert_eq!(of(Shading::GouraudTessellated.into(), Some(3.0)), (true, 3.0));
        assert_eq!(of(Shading::Phong.into(), Some(3.0)), (true, 3.0));
        assert_eq!(of(Shading::Phong.into(), None), (false, 1.0));
        // If forced on, faces are split to the scene's tolerance.
        assert_eq!(of(Accuracy::WithinError(2.0), Some(3.0)), (false, 3.0));
    }
}
