//! Errors of scenes that cannot be drawn.

use core::fmt;

use crate::scene::Scene;

/// Error of a scene that could not be drawn.
#[derive(Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum RenderError {
    /// The camera.
    Camera(&'static str),
    /// An object, by its place in the scene.
    Object {
        /// Its place, from 0.
        index: usize,
        /// The fault.
        what: &'static str,
    },
    /// A light, by its place in the scene.
    Light {
        /// Its place, from 0.
        index: usize,
        /// The fault.
        what: &'static str,
    },
    /// The scene's ambient light is not finite.
    Ambient,
    /// The fog.
    Fog(&'static str),
    /// The palette's animation.
    PaletteAnimation(&'static str),
    /// The settings, those of the scene or the renderer's.
    Settings(&'static str),
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Camera(what) => write!(f, "camera: {what}"),
            Self::Object { index, what } => write!(f, "object {index}: {what}"),
            Self::Light { index, what } => write!(f, "light {index}: {what}"),
            Self::Ambient => f.write_str("the ambient light must be finite"),
            Self::Fog(what) => write!(f, "fog: {what}"),
            Self::PaletteAnimation(what) => write!(f, "palette animation: {what}"),
            Self::Settings(what) => write!(f, "settings: {what}"),
        }
    }
}

crate::errors::debug_as_display!(RenderError);

impl core::error::Error for RenderError {}

/// Checks a scene for faults.
pub(super) fn check(scene: &Scene) -> Result<(), RenderError> {
    if !scene.ambient.is_finite() {
        return Err(RenderError::Ambient);
    }
    for (index, light) in scene.lights().iter().enumerate() {
        light.check().map_err(|what| RenderError::Light { index, what })?;
    }
    for (index, object) in scene.objects().iter().enumerate() {
        object.check().map_err(|what| RenderError::Object { index, what })?;
        scene.check_parents(index).map_err(|what| RenderError::Object { index, what })?;
    }
    if let Some(fog) = &scene.fog {
        fog.check().map_err(RenderError::Fog)?;
    }
    if let Some(animation) = &scene.palette_animation {
        animation.check().map_err(RenderError::PaletteAnimation)?;
    }
    scene.settings.check().map_err(RenderError::Settings)
}
