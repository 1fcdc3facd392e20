//! The lighting model at one point.
//!
//! ```text
//! I = ka·Ia + Σ over lights of (kd·max(0, n·l) + ks·max(0, r·v)^s) · Id · fall-off
//! ```
//!
//! With three channels the first two terms are multiplied by the material's colour, the last one by the highlight's. r
//! = 2·(n·l)·n − l. A light that n faces away from adds nothing. A lamp at distance d falls off as (1 − d²/R²)² within
//! its range R, and a spot light also from its inner to its outer angle (see [`Cone`]).

use super::vector::{Vector, dot, sub, times, unit, wide};
use mode13h::light::{Cone, Light, Material};
use mode13h::scene::Scene;

/// Red, green and blue of a point, clamped once, after summing, to 0 to 1. `normal` is unit length, or zero where there
/// is none, and then only ambient light counts. Unless `in_color`, all three are the single channel.
pub(super) fn intensity(
    scene: &Scene,
    material: &Material,
    in_color: bool,
    (at, normal): (Vector, Vector),
    eye: Vector,
) -> [f64; 3] {
    let to_eye = unit(sub(eye, at));
    let mut body = [f64::from(material.ambient) * f64::from(scene.ambient); 3];
    let mut mirrored = [0.0; 3];
    for light in scene.lights() {
        let Some((l, fall_off)) = reaching(light, at) else { continue };
        let cosine = dot(normal, l);
        if cosine <= 0.0 {
            continue;
        }
        let mut highlight = 0.0;
        if let Some(v) = to_eye.filter(|_| material.is_specular()) {
            let r = sub(times(normal, 2.0 * cosine), l);
            let along = dot(r, v);
            if along > 0.0 {
                highlight = f64::from(material.specular) * libm::pow(along, f64::from(material.shininess));
            }
        }
        for (channel, id) in strength(light, in_color).into_iter().enumerate() {
            body[channel] += f64::from(material.diffuse) * cosine * id * fall_off;
            mirrored[channel] += highlight * id * fall_off;
        }
    }
    // The two have separate colours.
    let (own, of_highlight) = if in_color { (material.color, material.highlight) } else { ([1.0; 3], [1.0; 3]) };
    [0, 1, 2].map(|i| {
        let intensity = (body[i] * f64::from(own[i]) + mirrored[i] * f64::from(of_highlight[i])).clamp(0.0, 1.0);
        material.response.as_ref().map_or(intensity, |response| f64::from(response.apply(intensity as f32)))
    })
}

/// The direction to a light, and how much of it reaches a point; `None` if nothing does. A lamp exactly at the point
/// lights no side of it.
fn reaching(light: &Light, at: Vector) -> Option<(Vector, f64)> {
    match *light {
        Light::Sun { direction, .. } => Some((unit(wide(direction))?, 1.0)),
        Light::Lamp { position, range, cone, .. } => {
            let to_lamp = sub(wide(position), at);
            let part = dot(to_lamp, to_lamp) / (f64::from(range) * f64::from(range));
            let left = 1.0 - part;
            let towards = unit(to_lamp).filter(|_| left > 0.0)?;
            Some((towards, left * left * cone.map_or(Some(1.0), |cone| in_cone(&cone, towards))?))
        }
        // This kind of light is newer than the laboratory.
        _ => None,
    }
}

/// The share of a spot light that remains when the light lies in the unit direction `towards`; `None` if the cone has
/// no direction.
fn in_cone(cone: &Cone, towards: Vector) -> Option<f64> {
    let cosine = -dot(unit(wide(cone.direction))?, towards);
    let inner = libm::cos(cone.inner.to_radians());
    // A cone's edge is never sharper than this.
    let outer = libm::cos(cone.outer.to_radians()).min(inner - 1.0 / 65_536.0);
    let x = ((cosine - outer) / (inner - outer)).clamp(0.0, 1.0);
    Some(3.0 * x * x - 2.0 * x * x * x)
}

/// Id of each channel; on one channel, a coloured light's luminance after ITU-R BT.601.
fn strength(light: &Light, in_color: bool) -> [f64; 3] {
    let color = light.color().map(f64::from);
    let [red, green, blue] = color;
    let color = match (in_color, light.is_colored()) {
        (true, _) => color,
        (false, true) => [0.299 * red + 0.587 * green + 0.114 * blue; 3],
        (false, false) => [red; 3],
    };
    times(color, f64::from(light.intensity()))
}
