//! Group E: a renderer that has drawn much draws what a fresh one does.

use super::Group;
use super::random::Random;
use mode13h::Angle;
use mode13h::light::Light;
use mode13h::mesh::{Mesh, shapes};
use mode13h::palette::{Palette, builtin};
use mode13h::render::{HiddenSurfaces, Renderer, Shading, VertexPath};
use mode13h::scene::{Object, Scene, Shared};
use mode13h::vga::Vga;

/// Scenes one after the other by one renderer into two machines that somebody draws over: meshes,
/// palettes, lights, shadings, vertex paths and hidden-surface methods change, and the bytes must be a fresh renderer's
/// (E1).
///
/// ```
/// let group = mode13h_lab::verify::reuse(13);
/// assert!(group.passed(), "{:?}", group.failures);
/// ```
#[must_use]
pub fn reuse(seed: u64) -> Group {
    check(seed, &mut |renderer, scene, vga| renderer.draw(scene, vga).is_ok())
}

/// Draws a scene; whether it could.
type Draw<'a> = &'a mut dyn FnMut(&mut Renderer, &Scene, &mut Vga) -> bool;

fn check(seed: u64, draw: Draw<'_>) -> Group {
    let mut group = Group::new("reuse");
    let mut random = Random::new(seed, "reuse");
    let mut used = Renderer::new();
    let mut machines = [Vga::new(), Vga::new()];
    let meshes: Vec<Shared<Mesh>> =
        shapes::NAMES.iter().filter_map(|name| shapes::by_name(name)).map(Shared::new).collect();
    let palettes: Vec<Palette> = builtin::ALL.iter().map(|builtin| builtin.palette.clone()).collect();
    let mut scene = super::framed(meshes[0].clone());
    for case in 0..150 {
        let what = change(&mut random, &mut scene, &meshes, &palettes);
        let (shading, way) = (random.one_of(&Shading::ALL), random.one_of(&HiddenSurfaces::ALL));
        let forced = (random.below(2) == 0).then_some(way);
        let vga = &mut machines[random.below(2) as usize];
        // Somebody draws over the frame, and behind it.
        for _ in 0..random.below(50) {
            vga.poke(random.below(65_536), random.below(256) as u8);
        }
        let path = random.one_of(&VertexPath::ALL);
        let mut fresh = (Renderer::new(), Vga::new());
        for renderer in [&mut used, &mut fresh.0] {
            renderer.settings.accuracy = Some(shading.into());
            renderer.settings.hidden_surfaces = forced;
            renderer.settings.vertex_path = path;
        }
        let drawn = [draw(&mut used, &scene, vga), fresh.0.draw(&scene, &mut fresh.1).is_ok()];
        let differ = vga.pixels().iter().zip(fresh.1.pixels()).filter(|(a, b)| a != b).count();
        let colors = vga.palette() == fresh.1.palette();
        group.check(drawn == [true; 2] && differ == 0 && colors, || {
            let palette = if colors { "" } else { ", and another palette" };
            format!("e1 scene {case}, changed: {what}: {differ} pixels are not a fresh renderer's{palette}")
        });
    }
    group
}

/// Changes one thing; says which.
fn change(random: &mut Random, scene: &mut Scene, meshes: &[Shared<Mesh>], palettes: &[Palette]) -> &'static str {
    let mut mesh = || meshes[random.below(meshes.len() as u32) as usize].clone();
    match (mesh(), random.below(7)) {
        (mesh, 0) => {
            let palette = scene.palette.take();
            *scene = super::framed(mesh);
            scene.palette = palette;
            "the mesh"
        }
        (mesh, 1) if scene.objects().len() < 4 => {
            let mut object = Object::new(mesh);
            object.position.x = random.around_zero(1.5) as f32;
            object.scale = 0.5;
            scene.add(object);
            "one object more"
        }
        (_, 2) => {
            scene.palette = Some(palettes[random.below(palettes.len() as u32) as usize].clone());
            "the palette"
        }
        (_, 3) => {
            while let Some(&id) = scene.light_ids().get(1) {
                scene.remove_light(id);
            }
            let towards = [random.around_zero(1.0) as f32, 0.5, 1.0];
            scene.add_light(Light::sun(towards).with_intensity(random.unit() as f32));
            "the light"
        }
        (_, 4) => {
            scene.background = random.below(256) as u8;
            "the background"
        }
        (_, 5) => {
            scene.camera.eye.z = 2.0 + random.unit() as f32 * 2.0;
            "the camera"
        }
        _ => {
            scene.objects_mut()[0].angles = [0; 3].map(|_| random.around_zero(3.0)).map(Angle::from_radians);
            "the angles"
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_used_renderer_is_as_good_as_new() {
        let group = reuse(1);
        assert_eq!(group.failures, [""; 0]);
        assert_eq!(group.cases, 150);
    }

    /// A frame that is drawn again only if the scene's angles changed.
    #[test]
    fn a_frame_that_is_kept_by_mistake_is_told() {
        let mut last = None;
        let group = check(1, &mut |renderer, scene, vga| {
            let angles = Some(scene.objects()[0].angles);
            let kept = std::mem::replace(&mut last, angles) == angles;
            kept || renderer.draw(scene, vga).is_ok()
        });
        assert!(group.failures[0].contains(" pixels are not a fresh renderer's"), "{:?}", group.failures);
    }
}
