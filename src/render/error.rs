//! Errors of scenes that cannot be drawn.

use alloc::string::String;
use core::fmt;

use crate::scene::Scene;

/// Error of a scene that could not be drawn.
#[derive(Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum RenderError {
    /// The camera.
    Camera(&'static str),
    /// The screen, or the frame's pixel aspect ratio.
    Screen(&'static str),
    /// An object, by its index in the scene.
    Object {
        /// Its index, from 0.
        index: usize,
        /// Its name, which may be empty.
        name: String,
        /// The fault.
        what: &'static str,
    },
    /// A light, by its index in the scene.
    Light {
        /// Its index, from 0.
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
    /// The settings: the scene's or the renderer's.
    Settings(&'static str),
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Camera(what) => write!(f, "camera: {what}"),
            Self::Screen(what) => write!(f, "screen: {what}"),
            Self::Object { index, name, what } if name.is_empty() => write!(f, "object {index}: {what}"),
            Self::Object { index, name, what } => write!(f, "object {index}, {name:?}: {what}"),
            Self::Light { index, what } => write!(f, "light {index}: {what}"),
            Self::Ambient => f.write_str("the ambient light must be finite"),
            Self::Fog(what) => write!(f, "fog: {what}"),
            Self::PaletteAnimation(what) => write!(f, "palette animation: {what}"),
            Self::Settings(what) => write!(f, "settings: {what}"),
        }
    }
}

crate::errors::error_type!(RenderError);

impl RenderError {
    internal! {
    /// An error of an object of the scene.
    #[must_use]
    fn of_object(scene: &Scene, index: usize, what: &'static str) -> Self {
        let name = scene.objects().get(index).map_or_else(String::new, |object| object.name.clone());
        Self::Object { index, name, what }
    }
    }
}

/// Checks a scene for faults.
pub(super) fn check(scene: &Scene) -> Result<(), RenderError> {
    if !scene.ambient.is_finite() {
        return Err(RenderError::Ambient);
    }
    for (index, light) in scene.lights().iter().enumerate() {
        light.check().map_err(|what| RenderError::Light { index, what })?;
    }
    for (index, object) in scene.objects().iter().enumerate() {
        let fault = |what| RenderError::of_object(scene, index, what);
        object.check().map_err(fault)?;
        scene.check_parents(index).map_err(fault)?;
    }
    if let Some(fog) = &scene.fog {
        fog.check().map_err(RenderError::Fog)?;
    }
    if let Some(animation) = &scene.palette_animation {
        animation.check().map_err(RenderError::PaletteAnimation)?;
    }
    scene.settings.check().map_err(RenderError::Settings)
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;

    use super::*;
    use crate::mesh::shapes;
    use crate::scene::Object;

    #[test]
    fn an_object_is_named_if_it_has_a_name() {
        let mut scene = Scene::new();
        scene.add(Object::new(shapes::cube()));
        scene.add(Object::new(shapes::cube()).named("the \"ship\"").scaled(-1.0));
        let error = check(&scene).expect_err("a negative scale").to_string();
        assert_eq!(error, "object 1, \"the \\\"ship\\\"\": its scale must not be negative");
        scene.objects_mut()[1].name.clear();
        let error = check(&scene).expect_err("a negative scale").to_string();
        assert_eq!(error, "object 1: its scale must not be negative");
    }
}
