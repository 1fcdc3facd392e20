//! N4, N5: light from anywhere, in any number and strength, stays an intensity.
#![cfg(feature = "alloc")]

mod support;

use mode13h::fixed::{I24F8, U8F8};
use mode13h::glam::Vec3;
use mode13h::light::{Light, Material};
use mode13h::mesh::{Mesh, shapes};
use mode13h::raster::Vertex;
use mode13h::render::{RenderError, Renderer, Screen};
use mode13h::scene::{Camera, Object, Scene};
use mode13h::vga::Vga;
use support::random::Random;
use support::tried::Tried;

/// A triangle that faces the eye, with this normal at all three corners, lit by `lights`; its shade.
fn shade(normal: Vec3, material: Material, ambient: f32, lights: &[Light]) -> U8F8 {
    let corners = vec![Vec3::new(-0.5, -0.5, 0.0), Vec3::new(0.5, -0.5, 0.0), Vec3::new(0.0, 0.5, 0.0)];
    let mesh = Mesh::with_normals(corners, vec![normal; 3], vec![[0, 1, 2]]).expect("a mesh");
    let mut scene = Scene::new();
    scene.ambient = ambient;
    let object = scene.add(Object::new(mesh));
    scene[object].materials = vec![material];
    for &light in lights {
        scene.add_light(light);
    }
    let mut shades = Vec::new();
    Renderer::new()
        .for_each_triangle(&scene, Screen::MODE_13H, |vertices, _| shades.extend(vertices.map(|v: Vertex| v.shade())))
        .expect("a legal scene");
    assert_eq!(shades.len(), 3);
    assert!(shades.iter().all(|&shade| shade == shades[0]), "{shades:?}");
    shades[0]
}

fn material(ambient: f32, diffuse: f32) -> Material {
    Material { ambient, diffuse, ..Material::white() }
}

#[test]
fn n4_a_light_in_the_plane_or_behind_adds_nothing() {
    let mut tried = Tried::new("n4_a_light_in_the_plane_or_behind_adds_nothing", 500);
    let mut random = Random::named("n4");
    while tried.more() {
        let mut coordinate = || random.unit() as f32 * 2.0 - 1.0;
        let (x, y, z) = (coordinate(), coordinate(), coordinate());
        let alone = shade(Vec3::Z, material(0.25, 0.75), 1.0, &[]);
        assert_eq!(alone, U8F8::from_bits(16_320), "a quarter of 65,280");
        let lit = shade(Vec3::Z, material(0.25, 0.75), 1.0, &[Light::sun([x, y, z])]);
        // The same sum in f64; the unit vectors of f32 are within 2⁻²² of it, of 48,960 units less than 1.
        let cosine =
            (f64::from(z) / f64::sqrt(f64::from(x).powi(2) + f64::from(y).powi(2) + f64::from(z).powi(2))).max(0.0);
        let expected = (0.25 + 0.75 * cosine) * 65_280.0;
        assert!((f64::from(lit.to_bits()) - expected).abs() <= 1.0, "sun {x} {y} {z}: {lit:?}, expected {expected}");
        if z <= 0.0 {
            assert_eq!(lit, alone, "sun {x} {y} {z}");
        }
    }
    for in_the_plane in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [1.0, 1.0, -0.0], [1.0, 1.0, f32::MIN_POSITIVE]] {
        let lit = shade(Vec3::Z, material(0.25, 0.75), 1.0, &[Light::sun(in_the_plane)]);
        assert_eq!(lit, U8F8::from_bits(16_320), "{in_the_plane:?}");
    }
}

#[test]
fn n5_a_thousand_lights_of_any_strength_are_clamped_once() {
    let mut tried = Tried::new("n5_a_thousand_lights_of_any_strength_are_clamped_once", 40);
    let mut random = Random::named("n5");
    while tried.more() {
        let strengths = [f32::MAX, f32::MIN, 1.0, -1.0, 1e30, -1e30, 0.0, f32::MIN_POSITIVE];
        let lights: Vec<Light> =
            (0..1000).map(|_| Light::sun([0.0, 0.0, 1.0]).with_intensity(random.one_of(&strengths))).collect();
        let sum: f64 = lights
            .iter()
            .map(|light| match light {
                Light::Sun { intensity, .. } => f64::from(*intensity),
                _ => 0.0,
            })
            .sum();
        let lit = shade(Vec3::Z, material(0.0, f32::MAX), 0.0, &lights);
        // f64 sums in the same order, and the factor is positive: the sign is the sum's, and any sum
        // but 0 is far beyond 1 or below 0.
        let expected = if sum > 0.0 { 0xFF00 } else { 0 };
        assert_eq!(lit.to_bits(), expected, "{sum:e}");
    }
    // Clamped after the sum, not before: 3 − 2.5 is a half.
    let three = [3.0, -2.5].map(|strength| Light::sun([0.0, 0.0, 1.0]).with_intensity(strength));
    assert_eq!(shade(Vec3::Z, material(0.0, 1.0), 0.0, &three), U8F8::from_bits(32_640));
    assert_eq!(shade(Vec3::Z, material(f32::MAX, 1.0), f32::MAX, &[]), U8F8::MAX_VERTEX);
    assert_eq!(shade(Vec3::Z, material(f32::MAX, 1.0), f32::MIN, &[]), U8F8::from_bits(0));
}

/// Puts a number that is not finite into a scene.
type Change = fn(&mut Scene, Vec3);

#[test]
fn r9_what_is_not_finite_is_refused_where_it_enters() {
    let mut tried = Tried::new("r9_what_is_not_finite_is_refused_where_it_enters", 30);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let at = Vec3::new(0.0, bad, 0.0);
        let changes: [(&str, Change); 12] = [
            ("camera", |scene, bad| scene.camera.eye = bad),
            ("camera", |scene, bad| scene.camera.target = bad),
            ("camera", |scene, bad| scene.camera.up = bad),
            ("camera", |scene, bad| scene.camera.near = bad.y),
            ("camera", |scene, bad| scene.camera.field_of_view = bad.y),
            ("object 0", |scene, bad| scene.objects_mut()[0].position = bad),
            ("object 0", |scene, bad| scene.objects_mut()[0].pivot = bad),
            ("object 0", |scene, bad| scene.objects_mut()[0].scale = bad.y),
            ("object 0", |scene, bad| scene.objects_mut()[0].rotate_z(bad.y.into())),
            ("object 0", |scene, bad| scene.objects_mut()[0].materials[0].diffuse = bad.y),
            ("light 0", |scene, bad| scene.lights_mut()[0] = Light::sun(bad.to_array())),
            ("the ambient light", |scene, bad| scene.ambient = bad.y),
        ];
        for (what, change) in changes {
            let mut scene = support::scenes::framed(shapes::cube());
            change(&mut scene, at);
            let mut vga = Vga::new();
            vga.pixels_mut().fill(7);
            let palette = vga.palette();
            let refused = Renderer::new().draw(&scene, &mut vga);
            let text = refused.expect_err(what).to_string();
            assert!(text.starts_with(what), "{text}");
            assert!(vga.pixels().iter().all(|&byte| byte == 7) && vga.palette() == palette, "{what}: left as it was");
            tried.add(1);
        }
        assert!(Mesh::new(vec![Vec3::ZERO, Vec3::X, at], vec![[0, 1, 2]]).is_err());
        assert!(Mesh::with_normals(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![at; 3], vec![[0, 1, 2]]).is_err());
        assert_eq!(I24F8::round_from_f32(bad), None);
    }
    let mut scene = support::scenes::framed(shapes::cube());
    scene.lights_mut()[0] = Light::sun([0.0; 3]);
    assert!(matches!(Renderer::new().draw(&scene, &mut Vga::new()), Err(RenderError::Light { index: 0, .. })));
    scene = support::scenes::framed(shapes::cube());
    scene.camera.target = scene.camera.eye;
    assert!(matches!(Renderer::new().draw(&scene, &mut Vga::new()), Err(RenderError::Camera(_))));
}

#[test]
fn r10_denormals_and_minus_zero_draw_as_zero() {
    let mut tried = Tried::new("r10_denormals_and_minus_zero_draw_as_zero", 5);
    let corners = [[0.0, 0.0, 0.0], [0.7, 0.0, 0.0], [0.0, 0.7, 0.0], [0.0, 0.0, 0.7]];
    let mesh = |tiny: f32| {
        let positions = corners.map(|c| Vec3::from_array(c.map(|x| if x == 0.0 { tiny } else { x })));
        Mesh::new(positions.to_vec(), vec![[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]]).expect("a mesh")
    };
    let frame = |tiny: f32| {
        let mut scene = Scene::new();
        scene.camera = Camera { eye: Vec3::new(1.0, 2.0, 4.0), target: Vec3::splat(tiny), ..Camera::default() };
        let object = scene.add(Object::new(mesh(tiny)));
        scene[object].position = Vec3::splat(tiny);
        scene[object].set_angles([f64::from(tiny); 3]);
        scene.add_light(Light::sun([0.4, 0.6, 1.0]));
        let mut vga = Vga::new();
        Renderer::new().draw(&scene, &mut vga).expect("a legal scene");
        vga.pixels().to_vec()
    };
    let with_zero = frame(0.0);
    assert!(with_zero.iter().filter(|&&byte| byte != 0).count() > 1000);
    for tiny in [-0.0, f32::MIN_POSITIVE, -f32::MIN_POSITIVE, f32::from_bits(1), -f32::from_bits(1)] {
        assert_eq!(frame(tiny), with_zero, "{tiny:e}");
        tried.add(1);
    }
}
