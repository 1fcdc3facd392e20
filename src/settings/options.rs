//! One struct of choices, for a scene and for a renderer alike, and whose choice counts.

use core::fmt;

use super::{DitherPattern, Mapping, Shading};
use crate::names::named;

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
        /// (`raster::scan_line`). The bytes equal those with the depth buffer.
        ScanLine = "scan-line",
    }
}

named! {
    /// A way from a mesh to projected vertices. From there on both are drawn by the same raster.
    #[derive(Default)]
    pub enum VertexPath, "vertex path" {
        /// Vertices in f32.
        #[default]
        Float = "float",
        /// Vertices in 16.16, by [`integer`](crate::integer). The scene's own numbers are floats, so they are
        /// converted: a mesh when it is first seen, angles to the nearest 65,536th of a turn.
        Integer = "fixed",
    }
}

/// Accuracy of shades: one choice, so that a shading and a budget cannot both be set.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Accuracy {
    /// Every face gets this shading, and shades are as exact as it makes them.
    Shading(Shading),
    /// Within this many shades of error, 1/255 of full intensity each: every face gets the cheapest shading that is known to
    /// keep within. A number that is not above 0 and finite is an error when a scene is drawn.
    WithinError(f32),
}

impl Accuracy {
    /// The shading; within an error the default, which is what faces get on which nothing has to be decided.
    #[must_use]
    pub fn shading(self) -> Shading {
        match self {
            Self::Shading(shading) => shading,
            Self::WithinError(_) => Shading::default(),
        }
    }

    /// Accepted error in shades, if shadings are chosen by that.
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

/// The shading's name, or `within 4 shades`.
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

/// How to draw: what a scene asks for, and what a renderer is told instead. What is `None` in both is left to the plan,
/// which chooses the cheapest that is right.
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
    /// Accuracy of shades: a shading, or an error budget.
    pub accuracy: Option<Accuracy>,
    /// Method for hidden surfaces, right or wrong.
    pub hidden_surfaces: Option<HiddenSurfaces>,
    /// Mapping of textures.
    pub mapping: Option<Mapping>,
    /// Mipmaps of textures, on or off.
    pub mipmaps: Option<bool>,
    /// The tessellation error, in shades of 1/255 of full intensity, above 0: faces are split until the shades on their
    /// edges are linear to this. [`Shading::GouraudTessellated`] alone uses one shade.
    pub tessellation: Option<f32>,
    /// The pattern in which shades between two entries of a ramp are shown.
    pub dither: Option<DitherPattern>,
    /// The numbers that vertices are made in; f32 unless 16.16 is asked for. 16.16 knows no error budget and not every
    /// shading: there the shading is the nearest that it has.
    pub vertex_path: Option<VertexPath>,
    /// Bits after the point of projected vertices: 8, which are there, or fewer, to which they are rounded once more, half up.
    /// 0 puts vertices on whole pixels, so that a model that moves slowly wobbles. Points that clipping makes keep their 8
    /// bits, and so does the 16.16 path; shadings state their errors, and budgets prove theirs, for 8.
    pub vertex_bits: Option<u8>,
    /// True to light every material on three channels and mix their light to the nearest colours, whether it is coloured or not.
    /// For palettes of few colours: there dither reaches textures, too.
    pub channels: Option<bool>,
}

impl Settings {
    /// The tessellation error that is asked for by a shading alone, in shades.
    const DEFAULT_TESSELLATION: f32 = 1.0;

    /// These settings, and another's where these leave the choice open.
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

    /// The accuracy that the vertex path offers for what is asked.
    #[must_use]
    pub fn drawn_accuracy(&self) -> Accuracy {
        match self.accuracy.unwrap_or_default() {
            Accuracy::Shading(shading) if self.is_integer() => shading.in_integers().into(),
            Accuracy::WithinError(_) if self.is_integer() => Accuracy::default(),
            asked => asked,
        }
    }

    /// Returns whether vertices are made in 16.16.
    pub(crate) fn is_integer(&self) -> bool {
        self.vertex_path == Some(VertexPath::Integer)
    }

    /// Returns whether faces are to be split. An error budget makes shades follow the light otherwise.
    pub(crate) fn tessellates(&self) -> bool {
        let accuracy = self.drawn_accuracy();
        let asks_for_splitting = accuracy.shading() == Shading::GouraudTessellated || self.tessellation.is_some();
        asks_for_splitting && accuracy.max_error().is_none()
    }

    /// The shades to which the edges of faces that are split are linear.
    pub(crate) fn tolerance(&self) -> f32 {
        self.tessellation.unwrap_or(Self::DEFAULT_TESSELLATION)
    }

    /// Checks the settings; the error says what is wrong.
    pub(crate) fn check(&self) -> Result<(), &'static str> {
        let legal = |number: Option<f32>| number.is_none_or(|n| n > 0.0 && n.is_finite());
        if !legal(self.tessellation) || !legal(self.accuracy.and_then(Accuracy::max_error)) {
            return Err("a number of shades must be above 0 and finite");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every combination of what a renderer and a scene may say about accuracy, against the table that it stands for.
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
                        // 16.16 has flat shades, and no light at pixels and no budget.
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
        // Switched on by hand faces are split as the scene says.
        assert_eq!(of(Accuracy::WithinError(2.0), Some(3.0)), (false, 3.0));
    }
}
