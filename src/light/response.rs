//! Custom responses of materials to light.

use core::fmt;

use crate::shared::Shared;

/// A material's own response to light: a function from the intensity that the lighting model gives, 0 to 1, to the one
/// shown. It is called wherever light is computed: at each vertex, face or pixel, on one channel or on each of three.
///
/// It must depend on nothing but that intensity: shades are kept from frame to frame while their inputs stay the same. To
/// change it, give the material another one.
///
/// ```
/// use mode13h::light::LightResponse;
/// use mode13h::mesh::shapes;
/// use mode13h::scene::Scene;
/// use mode13h::settings::Shading;
///
/// // A toon shader: three tones.
/// let toon = LightResponse::new(|intensity| (intensity * 3.0).floor().min(2.0) / 2.0);
/// let mut scene = Scene::new();
/// let teapot = scene.show(shapes::teapot(8));
/// scene[teapot].materials[0].response = Some(toon);
/// // Light at every pixel; by default it is computed at the vertices, and linear in between.
/// scene.settings.accuracy = Some(Shading::Phong.into());
/// ```
#[derive(Clone)]
pub struct LightResponse(Shared<dyn Fn(f32) -> f32 + Send + Sync>);

impl LightResponse {
    /// Makes a response from any function. Its result is clamped to 0 to 1, and NaN counts as 0.
    #[must_use]
    pub fn new(respond: impl Fn(f32) -> f32 + Send + Sync + 'static) -> Self {
        Self(Shared::new(respond))
    }

    /// The intensity shown, 0 to 1, for the lighting model's intensity, which is clamped to 0 to 1.
    #[must_use]
    pub fn apply(&self, intensity: f32) -> f32 {
        let shown = (self.0)(intensity.clamp(0.0, 1.0));
        if shown > 0.0 { shown.min(1.0) } else { 0.0 }
    }
}

/// Two responses are equal if one is a clone of the other.
impl PartialEq for LightResponse {
    fn eq(&self, other: &Self) -> bool {
        Shared::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for LightResponse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("LightResponse(…)")
    }
}
