//! Golden frames of the shapes, and of every shipped scene at three times: the same with every kernel.

use crate::support::golden::{Indexed, check};
use crate::support::tried::Tried;
use mode13h::Angle;
use mode13h::mesh::shapes;
use mode13h::palette::builtin;
use mode13h::render::Renderer;
use mode13h::scene::Scene;
use mode13h::settings::DitherPattern;
use mode13h::settings::Shading;
use mode13h::span::Kernel;
use mode13h::vga::Vga;

fn draw(scene: &Scene, kernel: Kernel) -> Indexed {
    let mut renderer = Renderer::new();
    renderer.kernel = kernel;
    let mut vga = Vga::new();
    renderer.draw(scene, &mut vga).expect("a legal scene");
    Indexed::of(&vga)
}

#[test]
fn golden_frames() {
    let mut tried = Tried::new("golden_frames", 9);
    let mut all: Vec<(&str, Shading)> = shapes::NAMES.iter().map(|&name| (name, Shading::default())).collect();
    all.extend([("torus", Shading::Flat), ("torus", Shading::Gouraud88)]);
    let mut wrong = Vec::new();
    for (name, shading) in all {
        let mut scene = crate::support::scenes::framed(shapes::by_name(name).expect("listed"));
        scene.palette = Some(builtin::COPPER.clone());
        scene.objects_mut()[0].angles = [0.5, 0.7, 0.1].map(Angle::from_radians);
        scene.settings.accuracy = Some(shading.into());
        wrong.extend(check(&format!("{name}-{shading}"), &mut tried, |kernel| draw(&scene, kernel)));
    }
    assert!(wrong.is_empty(), "frames that differ from their golden ones, or were rewritten: {wrong:#?}");
}

#[test]
fn golden_frames_of_every_scene() {
    use mode13h_assets::shipped;

    let mut tried = Tried::new("golden_frames_of_every_scene", 3 * shipped::ALL.len() as u64);
    let mut wrong = Vec::new();
    for shipped in &shipped::ALL {
        let mut scene = shipped.load().expect("a scene that loads").scene;
        if scene.auto_palette {
            mode13h_assets::auto_palette::of_scene(&scene).expect("a legal scene").apply(&mut scene);
        }
        for third in 0..3_u8 {
            scene.set_time(scene.duration * f64::from(third) / 3.0);
            wrong.extend(check(&format!("scenes/{}-{third}", shipped.name), &mut tried, |kernel| draw(&scene, kernel)));
        }
    }
    assert!(wrong.is_empty(), "frames that differ from their golden ones, or were rewritten: {wrong:#?}");
}

/// Grass, bricks and glazed tiles, each in its own colours, from three sides; and once in the nearest entries of the
/// cube, and in ramps that were not made for them.
#[test]
fn golden_frames_of_a_house() {
    use mode13h::light::Light;
    use mode13h::scene::{Camera, Motion, Object, Shared};
    use mode13h_assets::auto_palette;
    use mode13h_assets::model_file;

    let mut tried = Tried::new("golden_frames_of_a_house", 5);
    let loaded = model_file::load(crate::support::workspace::root().join("tests/data/house.obj")).expect("a model");
    let mut object = Object::new(loaded.mesh).centred();
    let surfaces = object.mesh().surfaces().to_vec();
    for (material, surface) in object.materials.iter_mut().zip(surfaces) {
        if let Some(path) = &surface.texture {
            let map = Shared::new(mode13h_assets::texture::load(path).expect("a picture"));
            *material = material.clone().with_map(&surface, &map);
        }
    }
    let mut house = Scene::new();
    house.camera = Camera::framing(object.pivot * 0.0, object.mesh().bounds().radius * 0.8);
    house.add_light(Light::sun([0.4, 0.6, 1.0]));
    let id = house.add(object);
    house.motions.push(Motion::Spin {
        object: id,
        start: [0.35, 0.0, 0.0].map(Angle::from_radians),
        turns: [0.0, 0.25, 0.0],
    });

    let mut auto = house.clone();
    auto_palette::of_scene(&house).expect("a scene").apply(&mut auto);
    let in_palette = |name: &str| {
        let mut scene = house.clone();
        scene.palette = builtin::by_name(name).map(|found| found.palette.clone());
        scene
    };
    let mut in_cube = in_palette("cube");
    in_cube.settings.dither = Some(DitherPattern::Ordered);
    let surfaces = house[id].mesh().surfaces();
    let own = in_cube[id].materials.iter().zip(surfaces).map(|(material, surface)| material.in_own_colors(surface));
    let own: Vec<_> = own.collect();
    in_cube[id].materials = own;
    let in_ramps = in_palette("materials-8x32");
    // A round takes four seconds.
    let at = |mut scene: Scene, degrees: f64| {
        scene.set_time(degrees / 90.0);
        scene
    };
    let scenes = [
        ("house-auto-20".to_string(), at(auto.clone(), 20.0)),
        ("house-auto-70".to_string(), at(auto.clone(), 70.0)),
        ("house-auto-200".to_string(), at(auto, 200.0)),
        ("house-cube-20".to_string(), at(in_cube, 20.0)),
        ("house-materials-8x32-20".to_string(), at(in_ramps, 20.0)),
    ];
    let mut wrong = Vec::new();
    for (name, scene) in &scenes {
        wrong.extend(check(name, &mut tried, |kernel| draw(scene, kernel)));
    }
    assert!(wrong.is_empty(), "frames that differ from their golden ones, or were rewritten: {wrong:#?}");
}
