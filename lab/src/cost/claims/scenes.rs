//! The scenes that claims are measured on.

use core::f64::consts::TAU;

use mode13h::Angle;
use mode13h::glam::Vec3;

use mode13h::light::Light;
use mode13h::mesh::{Mesh, shapes};
use mode13h::scene::{Camera, Object, Scene};

/// Slices of the spheres, from coarse to fine. Each has half as many stacks.
pub(super) const SLICES: [u32; 6] = [8, 16, 32, 64, 128, 256];

/// Frames per scene.
const FRAMES: u32 = 2;

/// A mesh, rotated from frame to frame so that no edge keeps its position relative to the pixels.
fn turned(mesh: Mesh, shiny: bool) -> Vec<Scene> {
    let mut scene = Scene::showing(mesh);
    // Framed by the bounding sphere, since the mesh turns about two axes.
    scene.camera = Camera::framing(Vec3::ZERO, scene.objects()[0].mesh().bounds().radius);
    if shiny {
        for material in &mut scene.objects_mut()[0].materials {
            (material.ambient, material.diffuse) = (0.1, 0.6);
            (material.specular, material.shininess) = (0.3, 20.0);
        }
    }
    let frame = |frame: u32| {
        let angle = TAU * f64::from(frame) / f64::from(FRAMES) + 0.2;
        scene.objects_mut().iter_mut().for_each(|object| object.angles = [0.35, angle, 0.1].map(Angle::from_radians));
        scene.clone()
    };
    (0..FRAMES).map(frame).collect()
}

/// A sphere that fills the picture, matt or with a highlight.
pub(super) fn sphere(slices: u32, shiny: bool) -> Vec<Scene> {
    turned(shapes::sphere(slices, slices / 2), shiny)
}

/// The torus of 2,304 faces.
pub(super) fn torus() -> Vec<Scene> {
    turned(shapes::torus(48, 24), false)
}

/// A floor of two faces that recedes from the eye, with a lamp over its near end: faces as deep as they are large, and
/// the greatest possible differences in shade.
pub(super) fn floor() -> Vec<Scene> {
    let mut scene = Scene::new();
    let mut floor = Object::new(shapes::wall(1, 1));
    floor.scale = 4.0;
    floor.angles = [-TAU / 4.0, 0.0, 0.0].map(Angle::from_radians);
    scene.add(floor);
    scene.add_light(Light::lamp([-1.5, 1.0, 2.5], 8.0));
    let frame = |frame: u32| {
        let eye = Vec3::new(0.3 * frame as f32, 0.6, 3.4);
        scene.camera = Camera { eye, target: Vec3::ZERO, near: 0.1, ..Camera::framing(Vec3::ZERO, 1.0) };
        scene.clone()
    };
    (0..FRAMES).map(frame).collect()
}
