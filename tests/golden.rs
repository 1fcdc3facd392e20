//! Golden frames of the shapes, and of every shipped scene at three times: the same with every kernel.
#![cfg(feature = "png")]

mod support;

use mode13h::mesh::shapes;
use mode13h::palette::builtin;
use mode13h::render::{Renderer, Rung};
use mode13h::scene::Scene;
use mode13h::span::Kernel;
use mode13h::vga::Vga;
use support::golden::{Indexed, check};
use support::tried::Tried;

fn draw(scene: &Scene, kernel: Kernel) -> Indexed {
    let mut renderer = Renderer::new();
    renderer.set_kernel(kernel);
    let mut vga = Vga::new();
    renderer.draw(scene, &mut vga).expect("a legal scene");
    Indexed::of(&vga)
}

#[test]
fn golden_frames() {
    let mut tried = Tried::new("golden_frames", 9);
    let mut all: Vec<(&str, Rung)> = shapes::NAMES.iter().map(|&name| (name, Rung::default())).collect();
    all.extend([("torus", Rung::Flat), ("torus", Rung::Gouraud88)]);
    let mut wrong = Vec::new();
    for (name, rung) in all {
        let mut scene = Scene::showing(shapes::by_name(name).expect("listed"));
        scene.palette = Some(builtin::COPPER.clone());
        scene.objects_mut()[0].set_angles([0.5, 0.7, 0.1]);
        scene.wishes.rung = Some(rung);
        wrong.extend(check(&format!("{name}-{rung}"), &mut tried, |kernel| draw(&scene, kernel)));
    }
    assert!(wrong.is_empty(), "frames that differ from their golden ones, or were written anew: {wrong:#?}");
}

#[cfg(feature = "scene-files")]
#[test]
fn golden_frames_of_every_scene() {
    use mode13h::scene::shipped;

    let mut tried = Tried::new("golden_frames_of_every_scene", 3 * shipped::ALL.len() as u64);
    let mut wrong = Vec::new();
    for shipped in &shipped::ALL {
        let mut scene = shipped.load().expect("a scene that loads").scene;
        for third in 0..3_u8 {
            scene.set_time(scene.duration * f64::from(third) / 3.0);
            wrong.extend(check(&format!("scenes/{}-{third}", shipped.name), &mut tried, |kernel| draw(&scene, kernel)));
        }
    }
    assert!(wrong.is_empty(), "frames that differ from their golden ones, or were written anew: {wrong:#?}");
}
