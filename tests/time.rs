//! T1, T2: rotation from absolute angles, and E1: nothing of a frame stays behind in the next.
#![cfg(feature = "alloc")]

mod support;

use mode13h::glam::{Mat3, Vec3};
use mode13h::light::Light;
use mode13h::mesh::shapes;
use mode13h::palette::builtin;
use mode13h::raster::Frame;
use mode13h::render::{Renderer, Rung};
use mode13h::scene::{Object, Scene};
use mode13h::vga::Vga;
use support::random::Random;
use support::tried::Tried;

fn frame(renderer: &mut Renderer, scene: &Scene) -> Vec<u8> {
    let mut vga = Vga::new();
    renderer.draw(scene, &mut vga).expect("a legal scene");
    vga.pixels().to_vec()
}

/// Many small steps: the matrix stays a rotation, the angle is the product, and the frame is that of
/// the angle at once.
fn rotation(frames: u32) {
    let step = 0.013_7;
    let mut scene = Scene::showing(shapes::torus(12, 8));
    let mut renderer = Renderer::new();
    let mut worst = 0.0_f32;
    for n in 1..=frames {
        scene.objects_mut()[0].rotate_y(step);
        scene.objects_mut()[0].rotate_x(step / 3.0);
        let matrix = scene.objects()[0].rotation();
        let product = matrix * matrix.transpose();
        for (is, should) in product.to_cols_array().into_iter().zip(Mat3::IDENTITY.to_cols_array()) {
            worst = worst.max((is - should).abs());
        }
        if n.is_power_of_two() || n == frames {
            // Each of n additions is rounded to half a unit in the last place of a number below 2¹⁴:
            // 2⁻⁴⁰.
            let [x, y, _] = scene.objects()[0].angles();
            let bound = f64::from(n) * f64::powi(2.0, -40);
            assert!((y - f64::from(n) * step).abs() <= bound && (x - f64::from(n) * (step / 3.0)).abs() <= bound);
            let mut at_once = Scene::showing(shapes::torus(12, 8));
            at_once.objects_mut()[0].set_angles([x, y, 0.0]);
            assert_eq!(frame(&mut renderer, &scene), frame(&mut Renderer::new(), &at_once), "frame {n}");
        }
    }
    println!("farthest from orthonormal: {worst:e}");
    assert!(worst <= 1e-6, "{worst:e}");
}

#[test]
fn t1_many_steps_are_one_angle() {
    let mut tried = Tried::new("t1_many_steps_are_one_angle", 10_000);
    rotation(10_000);
    tried.add(10_000);
}

#[test]
#[ignore = "the long run: a million steps of rotation, 21 of them drawn"]
fn t1_long_a_million_frames() {
    let mut tried = Tried::new("t1_long_a_million_frames", 1_000_000);
    rotation(1_000_000);
    tried.add(1_000_000);
}

#[test]
fn t2_any_step_is_defined() {
    let mut tried = Tried::new("t2_any_step_is_defined", 12);
    let turned = |angle: f64| {
        let mut scene = Scene::showing(shapes::cube());
        scene.objects_mut()[0].rotate_y(angle);
        frame(&mut Renderer::new(), &scene)
    };
    assert_eq!(turned(0.0), turned(-0.0));
    // An hour at 90° a second is 900 whole turns.
    let hour = 3600.0 * std::f64::consts::FRAC_PI_2;
    let mut scene = Scene::showing(shapes::cube());
    scene.objects_mut()[0].rotate_y(hour);
    scene.objects_mut()[0].rotate_y(-hour);
    assert_eq!(frame(&mut Renderer::new(), &scene), turned(0.0), "there and back");
    for angle in [-1.0, 1e-300, 3600.0, -3600.0, 1e9, -1e9, 1e15, 1e300, f64::MAX, f64::MIN_POSITIVE] {
        assert!(turned(angle).iter().any(|&byte| byte != 0), "{angle:e}");
        tried.add(1);
    }
    tried.add(2);
}

#[test]
fn e1_a_used_renderer_draws_as_a_fresh_one() {
    let mut tried = Tried::new("e1_a_used_renderer_draws_as_a_fresh_one", 300);
    let mut random = Random::named("e1");
    let (mut used, mut other) = (Renderer::new(), Renderer::new());
    let mut vga = [Vga::new(), Vga::new()];
    let mut scene = Scene::showing(shapes::torus(16, 8));
    while tried.more() {
        // Whatever may change between two frames, in any order.
        match random.within(0, 9) {
            0 => scene.objects_mut()[0].rotate_y(random.unit()),
            1 => scene.lights_mut()[0] = Light::sun([random.unit() as f32, 0.5, 1.0]),
            2 => {
                let name = random.one_of(&["grey", "copper", "materials-8x32"]);
                scene.palette = builtin::by_name(name).map(|found| found.palette.clone());
            }
            3 => scene.background = random.within(0, 255) as u8,
            4 => used.set_rung(random.one_of(&Rung::ALL)),
            5 => {
                let name = random.one_of(&["cube", "sphere", "wall", "cone"]);
                scene = Scene::showing(shapes::by_name(name).expect("listed"));
            }
            6 => {
                let mut object = Object::new(shapes::cube());
                object.position = Vec3::new(0.5, 0.0, 0.0);
                scene.add(object);
            }
            7 => vga[0].pixels_mut()[3000..9000].fill(random.within(0, 255) as u8),
            8 => Frame::from(&mut vga[1]).clear(9),
            _ => vga.swap(0, 1),
        }
        used.draw(&scene, &mut vga[0]).expect("a legal scene");
        // Another renderer on the same machine, then the first on a second machine.
        other.draw(&scene, &mut vga[1]).expect("a legal scene");
        used.draw(&scene, &mut vga[1]).expect("a legal scene");
        let mut fresh = Renderer::new();
        fresh.set_rung(used.rung());
        let expected = frame(&mut fresh, &scene);
        assert_eq!(vga[0].pixels(), expected);
        assert_eq!(vga[1].pixels(), expected);
        assert_eq!(vga[0].palette(), vga[1].palette());
    }
}
