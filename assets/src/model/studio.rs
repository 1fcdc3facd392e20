//! A studio: orientation, light and background for a model that has none.
//!
//! **Light.** A key light from the upper right and a fill a quarter as strong from the left, at right angles to it.
//! Together with the ambient light they add up to 1 at most, so that nothing is overexposed: the brightest face shows
//! its own colour, and a face that neither light reaches shows two fifths of it.
//!
//! **Colour.** The colour of a surface with an image is the image. Exporters write some grey Kd with it, often 0.8 or
//! 0.64, which dims nothing in the program that the model was made in. So these surfaces are exposed together, until
//! the one with the greatest Kd shows its image unchanged.
//!
//! **Background.** Black where the model stands out from it, otherwise the darkest grey from which it does, or a blue.
//!
//! **Orientation.** A closed mesh faces in all directions, so its faces' area vectors add up to zero; those of a sheet
//! add up to its area as seen from the front. A sheet that faces along z is terrain or a floor with z up: with y up it
//! would stand on edge. One that faces along x would be seen edge-on, so it is turned to show its front at first.

use core::ops::Range;

use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::Light;
use mode13h::mesh::Mesh;
use mode13h::palette::Rgb;
use mode13h::render::RenderError;
use mode13h::scene::{Camera, Object, Scene, UpAxis, framing};

use crate::auto_palette;
use crate::wide::{cross, dot, sub, widen};

/// The share of its colour that a surface shows where neither light falls.
const AMBIENT: f32 = 0.4;
/// The direction towards the key light.
const KEY: [f32; 3] = [0.4, 0.6, 1.0];
/// The direction towards the fill, at right angles to the key.
const FILL: [f32; 3] = [-1.0, 0.0, 0.4];
/// The ratio of the fill's intensity to the key's.
const FILL_SHARE: f32 = 0.25;
/// The least distance, in 1/255 in the RGB cube, at which a colour stands out from the background.
const CONTRAST: f32 = 80.0;
/// A blue that stands out from every grey.
const BLUE: Rgb = Rgb::from_dac([6, 12, 34]);
/// The first of the card's 64 greys that is bright enough to glare.
const GLARING: u8 = 43;

/// Makes a scene that [shows](Scene::showing) a model in the studio.
///
/// With `None` the model decides which of its axes points up: y, unless it is a sheet that faces along z.
///
/// # Errors
/// Those of [`Renderer::draw`](mode13h::render::Renderer::draw).
pub fn studio(mut object: Object, up: Option<UpAxis>) -> Result<Scene, RenderError> {
    let facing = facing(object.mesh());
    object.up_axis = up.unwrap_or(if facing[2] == 0.0 { UpAxis::Y } else { UpAxis::Z });
    let turn = Angle::from_degrees(-90.0 * facing[0]);
    expose(&mut object);
    let has_colors = object.has_colors();
    let mut scene = Scene::new();
    scene.show_turned(object, |object| [framing::tilt(object, Scene::TILT), turn]);
    scene.clear_lights();
    light(&mut scene, Vec3::from_array);
    finish(scene, has_colors)
}

/// Makes a scene of a model that has lights or a camera, as its author arranged it: the model keeps its position in
/// the file, and does not turn. Without lights it has the studio's, seen from the camera; without a camera, one that
/// frames a whole turn.
///
/// # Errors
/// Those of [`Renderer::draw`](mode13h::render::Renderer::draw).
pub fn composed(mut object: Object, lights: &[Light], camera: Option<Camera>) -> Result<Scene, RenderError> {
    expose(&mut object);
    let has_colors = object.has_colors();
    let mut scene = Scene::new();
    scene.camera = camera.unwrap_or_else(|| Camera::framing_turn(&object));
    scene.add(object);
    if lights.is_empty() {
        let Camera { eye, target, up, .. } = scene.camera;
        let back = (eye - target).normalize_or(Vec3::Z);
        let right = up.cross(back).normalize_or(back.any_orthonormal_vector());
        light(&mut scene, |[x, y, z]| right * x + back.cross(right) * y + back * z);
    }
    lights.iter().for_each(|light| _ = scene.add_light(*light));
    finish(scene, has_colors)
}

/// Adds the studio's lights, whose directions `place` puts into the scene.
fn light(scene: &mut Scene, place: impl Fn([f32; 3]) -> Vec3) {
    // Two lights at right angles add up to the length of (key, fill) on the face that is lit most.
    let key = 1.0 / libm::sqrtf(1.0 + FILL_SHARE * FILL_SHARE);
    scene.add_light(Light::sun(place(KEY)).with_intensity(key));
    scene.add_light(Light::sun(place(FILL)).with_intensity(key * FILL_SHARE));
}

/// The scene with a background from which it stands out.
fn finish(mut scene: Scene, has_colors: bool) -> Result<Scene, RenderError> {
    let color = background(&auto_palette::colors_seen(&scene)?, has_colors);
    scene.set_background(color);
    Ok(scene)
}

/// Splits what each material reflects into ambient and diffuse light, and exposes those with images.
fn expose(object: &mut Object) {
    let images = object.materials.iter().filter(|material| material.texture.is_some());
    let brightest = images.map(|material| material.ambient + material.diffuse).fold(0.0, f32::max);
    for material in &mut object.materials {
        let mut full = material.ambient + material.diffuse;
        if material.texture.is_some() {
            full = if brightest > 0.0 { full / brightest } else { 1.0 };
        }
        (material.ambient, material.diffuse) = (AMBIENT * full, (1.0 - AMBIENT) * full);
    }
}

/// The background that stands out best from the visible colours; the first if several are equal. Greys come from dark
/// to light, [`BLUE`] before those that glare.
fn background(seen: &[(Rgb, f32)], has_colors: bool) -> Rgb {
    let closeness = |background: Rgb| -> f32 {
        let missing = |color: Rgb| (CONTRAST - libm::sqrtf(color.distance_squared(background) as f32)).max(0.0);
        seen.iter().map(|&(color, area)| area * missing(color) * missing(color)).sum()
    };
    let greys = |levels: Range<u8>| levels.map(|level| Rgb::from_dac([level; 3]));
    let tried = greys(0..GLARING).chain(has_colors.then_some(BLUE)).chain(greys(GLARING..64));
    let best = (Rgb::BLACK, f32::INFINITY);
    tried.map(|color| (color, closeness(color))).fold(best, |best, next| if next.1 < best.1 { next } else { best }).0
}

/// The direction of the axis along which a sheet faces: 1 or −1 on it, and 0 on the others. 0 on all axes for a mesh
/// that faces everywhere.
fn facing(mesh: &Mesh) -> [f64; 3] {
    let (mut sum, mut all) = ([0.0; 3], 0.0);
    for corners in mesh.triangles() {
        let [a, b, c] = corners.map(|i| widen(mesh.positions()[i as usize]));
        let area = cross(sub(b, a), sub(c, a));
        all += libm::sqrt(dot(area, area));
        sum.iter_mut().zip(area).for_each(|(sum, area)| *sum += area);
    }
    sum.map(|sum: f64| if sum.abs() > all / 2.0 { sum.signum() } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_blue_stands_out_from_every_grey() {
        let distance = |level| BLUE.distance_squared(Rgb::new(level, level, level)) as f32;
        assert!((0..=255).all(|level| distance(level) >= CONTRAST * CONTRAST));
    }

    #[test]
    fn both_lights_together_are_full_light_at_most() {
        let [key, fill] = [KEY, FILL].map(Vec3::from_array);
        assert!(key.dot(fill).abs() < 1e-6);
    }
}
