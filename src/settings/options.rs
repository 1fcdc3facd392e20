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
/// let scene = Settings { mipmaps: Some(true), max_time: Some(5.0), ..Settings::default() };
/// let renderer = Settings { accuracy: Some(mode13h::settings::Accuracy::WithinError(2.0)), ..Settings::default() };
/// let merged = renderer.or(&scene);
/// assert_eq!((merged.mipmaps, merged.max_time), (Some(true), None));
/// ```
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Settings {
    /// Accuracy of shades: a shading, or an error budget.
    pub accuracy: Option<Accuracy>,
    /// Time for a frame in milliseconds, above 0: each frame is drawn within the least error that fits, as far as the
    /// times tell that [`Renderer::report_frame_time`](crate::render::Renderer::report_frame_time) is told. An error in
    /// `accuracy` is then the greatest that is accepted, otherwise 16 shades. A shading there is a contradiction: an error
    /// when a scene is drawn.
    pub max_time: Option<f32>,
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
}

impl Settings {
    /// The greatest error that is chosen to fit in a time, in shades.
    pub(crate) const MAX_ERROR: f32 = 16.0;

    /// The tessellation error that is asked for by a shading alone, in shades.
    const DEFAULT_TESSELLATION: f32 = 1.0;

    /// These settings, and another's where these leave the choice open. Accuracy and time are one choice.
    #[must_use]
    pub fn or(&self, other: &Self) -> Self {
        let Self { accuracy, max_time, .. } = *if self.has_accuracy() { self } else { other };
        Self {
            accuracy,
            max_time,
            hidden_surfaces: self.hidden_surfaces.or(other.hidden_surfaces),
            mapping: self.mapping.or(other.mapping),
            mipmaps: self.mipmaps.or(other.mipmaps),
            tessellation: self.tessellation.or(other.tessellation),
            dither: self.dither.or(other.dither),
            vertex_path: self.vertex_path.or(other.vertex_path),
        }
    }

    /// Returns whether they say anything about accuracy: a shading, an error or a time.
    #[must_use]
    pub const fn has_accuracy(&self) -> bool {
        self.accuracy.is_some() || self.max_time.is_some()
    }

    /// The accuracy that is asked for, or the default. With a time alone it is the greatest error.
    #[must_use]
    pub fn asked_accuracy(&self) -> Accuracy {
        let of_time = self.max_time.map(|_| Accuracy::WithinError(Self::MAX_ERROR));
        self.accuracy.or(of_time).unwrap_or_default()
    }

    /// The accuracy that the vertex path offers for what is asked.
    #[must_use]
    pub fn drawn_accuracy(&self) -> Accuracy {
        match self.asked_accuracy() {
            Accuracy::Shading(shading) if self.is_integer() => shading.in_integers().into(),
            Accuracy::WithinError(_) if self.is_integer() => Accuracy::default(),
            asked => asked,
        }
    }

    /// The time for a frame in milliseconds, if the error is chosen by that.
    #[must_use]
    pub fn time_for_error(&self) -> Option<f32> {
        self.max_time.filter(|_| self.drawn_accuracy().max_error().is_some())
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
        if self.max_time.is_some() && matches!(self.accuracy, Some(Accuracy::Shading(_))) {
            Err("a shading and a time for a frame contradict each other")
        } else if !legal(self.tessellation) || !legal(self.accuracy.and_then(Accuracy::max_error)) {
            Err("a number of shades must be above 0 and finite")
        } else if !legal(self.max_time) {
            Err("a time for a frame must be above 0 and finite")
        } else {
            Ok(())
        }
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
                    assert_eq!(merged.asked_accuracy(), asked);
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

    /// Every combination of times and errors that a renderer and a scene may ask for: the renderer's replace the scene's
    /// as a whole, and an error is the greatest that a time may choose.
    #[test]
    fn a_time_chooses_among_the_errors_up_to_the_greatest() {
        let within = |error: f32| Accuracy::WithinError(error);
        let all = [(None, None), (None, Some(2.0)), (Some(within(3.0)), Some(2.0)), (Some(within(3.0)), None)];
        for own in all {
            for of_scene in all {
                let settings = Settings { accuracy: own.0, max_time: own.1, ..Settings::default() };
                let scene = Settings { accuracy: of_scene.0, max_time: of_scene.1, ..Settings::default() };
                let (accuracy, max_time) = match (own, of_scene) {
                    ((None, None), (None, None)) => (Accuracy::default(), None),
                    ((None, None), asked) | (asked, _) => (asked.0.unwrap_or(within(16.0)), asked.1),
                };
                let merged = settings.or(&scene);
                let chosen = (merged.drawn_accuracy(), merged.time_for_error());
                assert_eq!(chosen, (accuracy, max_time), "{own:?} {of_scene:?}");
                assert_eq!(merged.check(), Ok(()));
                let integers = Settings { vertex_path: Some(VertexPath::Integer), ..merged };
                assert_eq!(integers.time_for_error(), None, "{own:?} {of_scene:?}");
            }
        }
    }

    #[test]
    fn a_time_beside_a_shading_or_out_of_range_is_refused() {
        let check = |accuracy: Option<Accuracy>, own, of_scene| {
            let settings = Settings { accuracy, max_time: own, ..Settings::default() };
            settings.or(&Settings { max_time: of_scene, ..Settings::default() }).check()
        };
        let phong = Some(Accuracy::Shading(Shading::Phong));
        assert!(check(phong, Some(2.0), None).is_err_and(|what| what.contains("contradict")));
        // The scene's is replaced.
        assert_eq!(check(phong, None, Some(2.0)), Ok(()));
        assert_eq!(check(phong, None, Some(-2.0)), Ok(()));
        for wrong in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert!(check(None, Some(wrong), None).is_err_and(|what| what.contains("time for a frame")), "{wrong}");
            assert!(check(None, None, Some(wrong)).is_err_and(|what| what.contains("time for a frame")), "{wrong}");
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
