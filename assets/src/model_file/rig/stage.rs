//! The lights and the camera in a model's file.
//!
//! **Range.** The light of a lamp falls off by the inverse square of the distance, without end; the engine's by
//! (1 − d²/R²)², up to its range R. Both have the same value and the same slope at R/√3, so R is √3 times the lamp's distance
//! from the middle of the model; or, for a lamp close to or inside it, large enough to reach all of it. A range in the
//! file limits it. The intensity at the lamp is then 27/4 · I/R².
//!
//! **Exposure.** Files give lux and candela, or whatever their program takes these to be. So all lights are exposed
//! together, as by a camera's automatic exposure: a white surface in the middle of the model that faced each of them
//! fully would get full light.

use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::{Cone, Light};
use mode13h::mesh::Bounds;
use mode13h::scene::Camera;

use super::place::Placement;
use crate::wide::{Wide, dot, sub, widen};

/// A light as it is in a file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Source {
    /// The node that it is in. It shines along the node's −z.
    pub(crate) node: usize,
    pub(crate) kind: Kind,
    /// Its colour, in sRGB.
    pub(crate) color: [f32; 3],
    /// Its intensity, above 0.
    pub(crate) intensity: f64,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    Sun,
    Lamp {
        /// The distance beyond which it has no effect.
        range: Option<f64>,
        /// The half-angles of a spot light, in radians.
        cone: Option<[f64; 2]>,
    },
}

/// A camera as it is in a file. It looks along its node's −z.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Eye {
    pub(crate) node: usize,
    /// Angle from the picture's upper to its lower edge, in radians, above 0 and below π.
    pub(crate) field_of_view: f64,
    /// The near distance, above 0.
    pub(crate) near: f64,
}

/// The placement of something: its node's transform, and the point of the file that is 0 in the mesh.
#[derive(Clone, Copy)]
pub(super) struct Stand {
    pub(super) place: Placement,
    pub(super) origin: Wide,
}

impl Stand {
    /// Its position; `None` beyond f32.
    fn position(self) -> Option<Vec3> {
        Some(narrow(sub(self.place.origin(), self.origin))).filter(|position| position.is_finite())
    }

    fn axis(self, axis: usize) -> Option<Vec3> {
        self.place.axis(axis).map(narrow)
    }
}

fn narrow(v: Wide) -> Vec3 {
    Vec3::from_array(v.map(|c| c as f32))
}

/// The lights, each with the index of its source. One that has no position, or whose numbers exceed f32, is left out.
pub(super) fn lights(
    sources: &[Source],
    stand: impl Fn(usize) -> Option<Stand>,
    bounds: &Bounds,
) -> Vec<(usize, Light)> {
    let middle = widen(bounds.centre);
    // Each with its light in the middle of the model, and its intensity in the file's units.
    let mut lights: Vec<(usize, Light, f64, f64)> = Vec::new();
    for (index, source) in sources.iter().enumerate() {
        let Some(stand) = stand(source.node) else { continue };
        let (light, intensity, in_the_middle) = match source.kind {
            Kind::Sun => {
                let Some(direction) = stand.axis(2) else { continue };
                (Light::sun(direction), source.intensity, source.intensity)
            }
            Kind::Lamp { range, cone } => {
                let Some(position) = stand.position() else { continue };
                let away = sub(widen(position), middle);
                let distance = libm::sqrt(dot(away, away));
                let reach = (libm::sqrt(3.0) * distance).max(distance + f64::from(bounds.radius));
                let reach = range.map_or(reach, |range| reach.min(range));
                let intensity = 27.0 / 4.0 * source.intensity / (reach * reach);
                let left = (1.0 - distance * distance / (reach * reach)).max(0.0);
                let light = match cone {
                    None => Light::lamp(position, reach as f32),
                    Some([inner, outer]) => {
                        let Some(towards) = stand.axis(2) else { continue };
                        let [inner, outer] = [inner, outer].map(Angle::from_radians);
                        Light::spot(position, reach as f32, Cone { direction: -towards, inner, outer })
                    }
                };
                (light, intensity, intensity * left * left)
            }
        };
        let light = light.with_color(source.color);
        lights.push((index, light, intensity, in_the_middle * f64::from(light.brightness())));
    }
    let full: f64 = lights.iter().map(|(.., in_the_middle)| in_the_middle).sum();
    // If none reaches the middle, the brightest is full light right beside itself.
    let full =
        if full > 0.0 { full } else { lights.iter().fold(0.0, |most, (_, _, intensity, _)| intensity.max(most)) };
    let exposed =
        lights.into_iter().map(|(index, light, intensity, _)| (index, light.with_intensity((intensity / full) as f32)));
    exposed.filter(|(_, light)| is_sound(light)).collect()
}

/// Returns whether the renderer accepts the light.
fn is_sound(light: &Light) -> bool {
    let ranges = match *light {
        Light::Lamp { range, .. } => range > 0.0 && range.is_finite(),
        _ => true,
    };
    ranges && light.color().iter().all(|c| c.is_finite()) && light.intensity() > 0.0 && light.intensity().is_finite()
}

/// Moves a light to where its node is, if f32 can hold it.
pub(super) fn moved(mut light: Light, stand: Stand) -> Light {
    match &mut light {
        Light::Sun { direction, .. } => *direction = stand.axis(2).unwrap_or(*direction),
        Light::Lamp { position, cone, .. } => {
            *position = stand.position().unwrap_or(*position);
            if let (Some(cone), Some(towards)) = (cone, stand.axis(2)) {
                cone.direction = -towards;
            }
        }
        _ => {}
    }
    light
}

/// The camera: it looks at the point in front of it that is as far away as the middle of the model. `None` if f32
/// cannot hold it.
pub(super) fn camera(eye: &Eye, stand: Stand, bounds: &Bounds) -> Option<Camera> {
    let (position, towards, up) = (stand.position()?, stand.place.axis(2)?, stand.axis(1)?);
    let away = sub(widen(position), widen(bounds.centre));
    // In front of it, or else as far away as the model is behind it, and far enough for f32 to keep the points
    // distinct.
    let before = dot(away, towards);
    let distance = if before > 0.0 { before } else { libm::sqrt(dot(away, away)) };
    let least = position.abs().max_element().max(bounds.radius) / 65_536.0;
    let distance = distance.max(least.into());
    let target = narrow([0, 1, 2].map(|axis| f64::from(position[axis]) - distance * towards[axis]));
    // It also sets the unit of depth.
    let near = eye.near.max(distance / 1024.0) as f32;
    let field_of_view = Angle::from_radians(eye.field_of_view);
    let is_sound = target.is_finite() && target != position && near > 0.0 && near.is_finite();
    is_sound.then_some(Camera { eye: position, target, up, field_of_view, near })
}

/// Moves the camera to where its node is, if f32 can hold that. Its target stays at the same distance.
pub(super) fn looking(camera: Camera, stand: Stand) -> Camera {
    let (Some(eye), Some(towards), Some(up)) = (stand.position(), stand.place.axis(2), stand.axis(1)) else {
        return camera;
    };
    let view = sub(widen(camera.target), widen(camera.eye));
    let distance = libm::sqrt(dot(view, view));
    let target = narrow([0, 1, 2].map(|axis| f64::from(eye[axis]) - distance * towards[axis]));
    if target.is_finite() && target != eye { Camera { eye, target, up, ..camera } } else { camera }
}
