//! Settings of a renderer and of the scene drawn: the only place that knows whose choice counts.

use core::fmt;

use super::VertexPath;
use crate::plan::{Effect, Overrides};
use crate::scene::{DitherPattern, HiddenSurfaces, Mapping, Preferences, Shading};
use crate::span::Kernel;

/// Accuracy of shades: one choice, so that a shading and a budget cannot both be set.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Accuracy {
    /// Every face gets this shading, and shades are as exact as it makes them.
    Shading(Shading),
    /// Within so many shades of error, 1/255 of full intensity each: every face gets the cheapest shading that is known to
    /// keep within. A number that is not above 0 and finite is an error when a scene is drawn.
    WithinError(f32),
}

impl Accuracy {
    /// The shading; within an error the default, which is what faces get on which nothing has to be decided.
    #[must_use]
    #[doc(hidden)]
    pub fn shading(self) -> Shading {
        match self {
            Self::Shading(shading) => shading,
            Self::WithinError(_) => Shading::default(),
        }
    }

    /// Accepted error in shades, if shadings are chosen by that.
    #[must_use]
    #[doc(hidden)]
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

/// Origin of a choice that a scene is drawn by.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[doc(hidden)]
pub enum ChosenBy {
    /// The renderer's settings.
    Renderer,
    /// The scene's preferences.
    Scene,
    /// Nobody: it is the default.
    Default,
}

/// Settings of a renderer. The scene decides those that are `None`, and the plan those that the scene leaves open.
#[derive(Clone, PartialEq, Debug, Default)]
#[non_exhaustive]
pub struct Settings {
    /// Accuracy of shades.
    pub accuracy: Option<Accuracy>,
    /// Time for a frame in milliseconds, above 0: each frame is drawn within the least error that fits, as far as the
    /// times tell that [`Renderer::report_frame_time`](super::Renderer::report_frame_time) is told. An error in `accuracy` is then the
    /// greatest that is accepted. A shading there is a contradiction: an error when a scene is drawn.
    pub max_time: Option<f32>,
    /// Method for hidden surfaces, right or wrong.
    pub hidden_surfaces: Option<HiddenSurfaces>,
    /// Mapping of textures.
    pub mapping: Option<Mapping>,
    /// Mipmaps of textures, on or off.
    pub mipmaps: Option<bool>,
    /// The numbers that vertices are made in.
    pub vertex_path: VertexPath,
    /// Kernel that fills spans; the fastest by default. All give equal bytes.
    pub kernel: Kernel,
    /// Effects that are switched by hand.
    #[doc(hidden)]
    pub overrides: Overrides,
}

/// Settings that a scene is drawn by. [`Settings::resolve`] makes it.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
#[doc(hidden)]
pub struct Resolved {
    /// Accuracy that was asked for, or the default.
    pub asked: Accuracy,
    /// Origin of `asked`.
    pub asked_by: ChosenBy,
    /// Accuracy that the vertex path offers for `asked`.
    pub accuracy: Accuracy,
    /// Time for a frame in milliseconds, if the error is chosen by that: `accuracy` has the greatest error.
    pub max_time: Option<f32>,
    /// Method for hidden surfaces; `None` leaves it to the plan.
    pub hidden_surfaces: Option<HiddenSurfaces>,
    /// Mapping of textures; `None` leaves it to the plan.
    pub mapping: Option<Mapping>,
    /// Mipmaps of textures, on or off; `None` leaves it to the plan.
    pub mipmaps: Option<bool>,
    /// True if faces are to be split. A budget makes shades follow the light otherwise.
    pub tessellates: bool,
    /// Faces that are split are split until the shades on their edges are linear to so many shades.
    pub tolerance: f32,
    /// The pattern in which shades between two entries of a ramp are shown.
    pub dither: Option<DitherPattern>,
    /// The numbers that vertices are made in.
    pub vertex_path: VertexPath,
    /// True if vertices may be kept for the next frame.
    pub keeps_vertices: bool,
}

/// The greatest error that is chosen to fit in a time, in shades.
pub(super) const MAX_ERROR: f32 = 16.0;

/// The shades to which faces are split that a scene says nothing about.
const DEFAULT_TOLERANCE: f32 = 1.0;

impl Settings {
    /// Resolves the settings for a scene with these preferences. The settings count before the preferences: any accuracy
    /// or time of theirs replaces the scene's shading, error and time. Among a scene's preferences an error or a time
    /// counts before a shading. With a time an error is the greatest that is accepted, 16 shades where none is named.
    /// Vertices in 16.16 know no budget and not every shading: there the shading is the nearest that they have.
    ///
    /// ```
    /// use mode13h::render::{Accuracy, ChosenBy, Settings, Shading};
    /// use mode13h::scene::Preferences;
    ///
    /// let preferences = Preferences { max_error: Some(2.0), ..Preferences::default() };
    /// let mut settings = Settings::default();
    /// assert_eq!(settings.resolve(&preferences).accuracy, Accuracy::WithinError(2.0));
    /// settings.accuracy = Some(Accuracy::Shading(Shading::Phong));
    /// let resolved = settings.resolve(&preferences);
    /// assert_eq!((resolved.accuracy, resolved.asked_by), (Accuracy::Shading(Shading::Phong), ChosenBy::Renderer));
    /// ```
    #[must_use]
    #[doc(hidden)]
    pub fn resolve(&self, preferences: &Preferences) -> Resolved {
        let error_of_scene = preferences.max_error.or(preferences.max_time.map(|_| MAX_ERROR));
        let of_scene = error_of_scene.map(Accuracy::WithinError).or(preferences.shading.map(Accuracy::Shading));
        let own = self.accuracy.or(self.max_time.map(|_| Accuracy::WithinError(MAX_ERROR)));
        let (asked, asked_by, max_time) = match (own, of_scene) {
            (Some(accuracy), _) => (accuracy, ChosenBy::Renderer, self.max_time),
            (None, Some(accuracy)) => (accuracy, ChosenBy::Scene, preferences.max_time),
            (None, None) => (Accuracy::default(), ChosenBy::Default, None),
        };
        let accuracy = match (self.vertex_path, asked) {
            (VertexPath::Float, asked) => asked,
            (VertexPath::Integer, Accuracy::Shading(shading)) => shading.in_integers().into(),
            (VertexPath::Integer, Accuracy::WithinError(_)) => match asked_by {
                ChosenBy::Scene => preferences.shading.unwrap_or_default().in_integers().into(),
                ChosenBy::Renderer | ChosenBy::Default => Accuracy::default(),
            },
        };
        let asks_for_splitting =
            accuracy.shading() == Shading::GouraudTessellated || preferences.tessellation.is_some();
        Resolved {
            asked,
            asked_by,
            accuracy,
            max_time: max_time.filter(|_| accuracy.max_error().is_some()),
            hidden_surfaces: self.hidden_surfaces.or(preferences.hidden_surfaces),
            mapping: self.mapping.or(preferences.mapping),
            mipmaps: self.mipmaps.or(preferences.mipmaps),
            tessellates: asks_for_splitting && accuracy.max_error().is_none(),
            tolerance: preferences.tessellation.unwrap_or(DEFAULT_TOLERANCE),
            dither: preferences.dither,
            vertex_path: self.vertex_path,
            keeps_vertices: self.keeps_frames() && self.vertex_path == VertexPath::Float,
        }
    }

    /// Checks the settings and a scene's preferences; the error says what is wrong.
    pub(super) fn check(&self, preferences: &Preferences) -> Result<(), &'static str> {
        if self.max_time.is_some() && matches!(self.accuracy, Some(Accuracy::Shading(_))) {
            return Err("a shading and a time for a frame contradict each other");
        }
        let replaces = self.accuracy.is_some() || self.max_time.is_some();
        let max_time = if replaces { self.max_time } else { preferences.max_time };
        let max_error = self.resolve(preferences).asked.max_error();
        Preferences { max_error, max_time, ..*preferences }.check()
    }

    /// Returns whether a frame that is there may stay where nothing has changed.
    pub(super) fn keeps_frames(&self) -> bool {
        self.overrides.get(Effect::Transform) != Some(true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every combination of what a renderer and a scene may say about accuracy, against the table that it stands for.
    #[test]
    fn the_renderer_counts_before_the_scene_and_a_budget_before_a_shading() {
        let phong = Accuracy::Shading(Shading::Phong);
        for set in [None, Some(phong), Some(Accuracy::WithinError(2.0))] {
            for shading in [None, Some(Shading::Flat)] {
                for max_error in [None, Some(4.0)] {
                    for vertex_path in VertexPath::ALL {
                        let settings = Settings { accuracy: set, vertex_path, ..Settings::default() };
                        let preferences = Preferences { shading, max_error, ..Preferences::default() };
                        let resolved = settings.resolve(&preferences);
                        let (asked, by) = match (set, max_error, shading) {
                            (Some(set), ..) => (set, ChosenBy::Renderer),
                            (None, Some(error), _) => (Accuracy::WithinError(error), ChosenBy::Scene),
                            (None, None, Some(shading)) => (Accuracy::Shading(shading), ChosenBy::Scene),
                            (None, None, None) => (Accuracy::default(), ChosenBy::Default),
                        };
                        assert_eq!((resolved.asked, resolved.asked_by), (asked, by));
                        let drawn = match vertex_path {
                            VertexPath::Float => asked,
                            _ if set.is_some() => Accuracy::default(),
                            _ => Accuracy::Shading(shading.unwrap_or_default()),
                        };
                        assert_eq!(resolved.accuracy, drawn, "{settings:?} {preferences:?}");
                    }
                }
            }
        }
    }

    /// Every combination of times and errors that a renderer and a scene may ask for: the renderer's replace the scene's
    /// as a whole, and an error is the greatest that a time may choose.
    #[test]
    fn a_time_chooses_among_the_errors_up_to_the_greatest() {
        let within = |error: f32| Accuracy::WithinError(error);
        for own in [(None, None), (None, Some(2.0)), (Some(within(3.0)), Some(2.0)), (Some(within(3.0)), None)] {
            for of_scene in [(None, None), (None, Some(5.0)), (Some(4.0), Some(5.0)), (Some(4.0), None)] {
                let settings = Settings { accuracy: own.0, max_time: own.1, ..Settings::default() };
                let preferences = Preferences {
                    shading: Some(Shading::Flat),
                    max_error: of_scene.0,
                    max_time: of_scene.1,
                    ..Preferences::default()
                };
                let (accuracy, max_time) = match (own, of_scene) {
                    ((None, None), (None, None)) => (Shading::Flat.into(), None),
                    ((None, None), (error, time)) => (within(error.unwrap_or(16.0)), time),
                    ((accuracy, time), _) => (accuracy.unwrap_or(within(16.0)), time),
                };
                let resolved = settings.resolve(&preferences);
                assert_eq!((resolved.accuracy, resolved.max_time), (accuracy, max_time), "{own:?} {of_scene:?}");
                assert_eq!(settings.check(&preferences), Ok(()));
                let integers = Settings { vertex_path: VertexPath::Integer, ..settings };
                assert_eq!(integers.resolve(&preferences).max_time, None, "{own:?} {of_scene:?}");
            }
        }
    }

    #[test]
    fn a_time_beside_a_shading_or_out_of_range_is_refused() {
        let check = |accuracy: Option<Accuracy>, own, of_scene| {
            let settings = Settings { accuracy, max_time: own, ..Settings::default() };
            settings.check(&Preferences { max_time: of_scene, ..Preferences::default() })
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
        let of = |accuracy: Accuracy, tessellation, vertex_path| {
            let settings = Settings { accuracy: Some(accuracy), vertex_path, ..Settings::default() };
            let resolved = settings.resolve(&Preferences { tessellation, ..Preferences::default() });
            (resolved.tessellates, resolved.tolerance)
        };
        let float = VertexPath::Float;
        assert_eq!(of(Shading::GouraudTessellated.into(), None, float), (true, 1.0));
        assert_eq!(of(Shading::GouraudTessellated.into(), Some(3.0), float), (true, 3.0));
        assert_eq!(of(Shading::Phong.into(), Some(3.0), float), (true, 3.0));
        assert_eq!(of(Shading::Phong.into(), None, float), (false, 1.0));
        // Switched on by hand faces are split as the scene says.
        assert_eq!(of(Accuracy::WithinError(2.0), Some(3.0), float), (false, 3.0));
    }
}
