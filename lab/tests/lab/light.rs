//! N4, N5: lights of any direction, number and strength still give a valid intensity.

mod floats;

use crate::support::scenes::triangles_by;
use crate::support::shaded;
use crate::support::tried::Tried;
use crate::support::vector::{Vector, dot, sub, unit, wide};
use mode13h::Angle;
use mode13h::fixed::{I24F8, U8F8};
use mode13h::glam::Vec3;
use mode13h::light::{Cone, Light, Material, RampChoice};
use mode13h::mesh::{Mesh, Surface, shapes};
use mode13h::palette::builtin;
use mode13h::render::{RenderError, Renderer, Screen};
use mode13h::scene::{Camera, Object, Scene};
use mode13h::settings::Shading;
use mode13h::vga::Vga;
use mode13h_conformance::Random;
use mode13h_lab::cost::Probe;

/// A triangle that faces the eye, with this normal at all three corners.
fn triangle(normal: Vec3) -> Mesh {
    let corners = vec![Vec3::new(-0.5, -0.5, 0.0), Vec3::new(0.5, -0.5, 0.0), Vec3::new(0.0, 0.5, 0.0)];
    Mesh::with_normals(corners, vec![normal; 3], vec![[0, 1, 2]]).expect("a mesh")
}

/// The shade of such a triangle, lit by `lights`.
fn shade(normal: Vec3, material: Material, ambient: f32, lights: &[Light]) -> U8F8 {
    let mut scene = Scene::new();
    scene.ambient = ambient;
    let object = scene.add(Object::new(triangle(normal)));
    scene[object].materials = vec![material];
    for &light in lights {
        scene.add_light(light);
    }
    let triangles = triangles_by(&mut Renderer::new(), &scene);
    let shades: Vec<U8F8> = triangles.as_flattened().iter().map(|v| v.shade()).collect();
    assert_eq!(shades.len(), 3);
    assert!(shades.iter().all(|&shade| shade == shades[0]), "{shades:?}");
    shades[0]
}

fn material(ambient: f32, diffuse: f32) -> Material {
    Material { ambient, diffuse, ..Material::default() }
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
        // The same sum in f64; the f32 unit vectors are within 2⁻²² of it, which is less than 1 of 48,960 units.
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
        // f64 sums in the same order, and the factor is positive, so the sign is the sum's, and any nonzero sum is far
        // above 1 or below 0.
        let expected = if sum > 0.0 { 0xFF00 } else { 0 };
        assert_eq!(lit.to_bits(), expected, "{sum:e}");
    }
    // Clamped after summing, not before: 3 − 2.5 is a half.
    let three = [3.0, -2.5].map(|strength| Light::sun([0.0, 0.0, 1.0]).with_intensity(strength));
    assert_eq!(shade(Vec3::Z, material(0.0, 1.0), 0.0, &three), U8F8::from_bits(32_640));
    assert_eq!(shade(Vec3::Z, material(f32::MAX, 1.0), f32::MAX, &[]), U8F8::MAX_VERTEX);
    assert_eq!(shade(Vec3::Z, material(f32::MAX, 1.0), f32::MIN, &[]), U8F8::from_bits(0));
}

/// The unclamped intensity of a point, following the model to the letter: ka·Ia + Σ (kd·n·l + ks·max(0, r·v)^s) · Id ·
/// fall-off over the lights that n faces. A lamp exactly at the point lights no side of it.
fn model(scene: &Scene, material: &Material, (at, normal): (Vector, Vector)) -> f64 {
    let mut sum = f64::from(material.ambient) * f64::from(scene.ambient);
    let to_eye = unit(sub(wide(scene.camera.eye), at));
    for light in scene.lights() {
        let (towards, strength) = match light {
            Light::Sun { direction, intensity, .. } => (unit(wide(*direction)), f64::from(*intensity)),
            Light::Lamp { position, intensity, range, cone, .. } => {
                let to_lamp = sub(wide(*position), at);
                let left = (1.0 - dot(to_lamp, to_lamp) / f64::from(*range).powi(2)).max(0.0);
                let share = match (cone, unit(to_lamp)) {
                    (Some(cone), Some(towards)) => {
                        let axis = unit(wide(cone.direction)).expect("a direction");
                        let [inner, outer] = [cone.inner, cone.outer].map(|angle| angle.to_radians().cos());
                        let outer = outer.min(inner - 1.0 / 65_536.0);
                        let x = ((-dot(axis, towards) - outer) / (inner - outer)).clamp(0.0, 1.0);
                        x * x * (3.0 - 2.0 * x)
                    }
                    _ => 1.0,
                };
                (unit(to_lamp), f64::from(*intensity) * left * left * share)
            }
            _ => panic!("a sun or a lamp"),
        };
        let Some(towards) = towards else { continue };
        let cosine = dot(normal, towards);
        if cosine <= 0.0 {
            continue;
        }
        let mirrored = sub(normal.map(|c| 2.0 * cosine * c), towards);
        let along = to_eye.map_or(0.0, |to_eye| dot(mirrored, to_eye).max(0.0));
        // A shininess of 0 means no highlight.
        let highlight =
            if along > 0.0 && material.shininess > 0.0 { along.powf(f64::from(material.shininess)) } else { 0.0 };
        sum += strength * (f64::from(material.diffuse) * cosine + f64::from(material.specular) * highlight);
    }
    sum
}

/// Lamps at a corner, on the face, in its plane, behind it, at the eye, and just in front of the face: every corner has
/// the model's shade, 0 to 1, and every shading that is linear between corners uses it.
#[test]
fn n4_lamps_on_a_surface_at_a_vertex_at_the_eye() {
    let mut tried = Tried::new("n4_lamps_on_a_surface_at_a_vertex_at_the_eye", 3 * 2_000);
    let mut random = Random::named("n4 lamps");
    let mut lit = 0;
    for _ in 0..2_000 {
        // Quarters, so that what should lie in the plane does.
        let quarter = |random: &mut Random, most: i64| random.within(-most, most) as f32 / 4.0;
        let corners = [0; 3].map(|_| Vec3::new(quarter(&mut random, 8), quarter(&mut random, 8), 0.0));
        let normal = Vec3::new(quarter(&mut random, 2), quarter(&mut random, 2), 1.0 + quarter(&mut random, 2).abs());
        let mesh = Mesh::with_normals(corners.to_vec(), vec![normal; 3], vec![[0, 1, 2]]).expect("a mesh");
        let mut scene = Scene::new();
        scene.camera = Camera { eye: Vec3::new(0.0, 0.0, 4.0), target: Vec3::ZERO, ..Camera::default() };
        scene.ambient = 0.5;
        let object = scene.add(Object::new(mesh));
        let shininess = random.one_of(&[0.0, 1e-30, 1.0, 8.0, 60.0]);
        let material = Material { ambient: 0.25, diffuse: 0.5, specular: 0.5, shininess, ..Material::default() };
        scene[object].materials = vec![material.clone()];
        for _ in 0..random.within(1, 3) {
            let middle = (corners[0] + corners[1] * 2.0 + corners[2]) / 4.0;
            let anywhere = Vec3::new(quarter(&mut random, 20), quarter(&mut random, 20), 0.0);
            let hair = random.one_of(&[1e-3, 1e-6, f32::MIN_POSITIVE, -1e-3, -2.0]);
            let on_face = random.one_of(&[middle, corners[1], anywhere]);
            let place = random.one_of(&[corners[0], on_face, on_face + Vec3::Z * hair, scene.camera.eye]);
            let range = random.one_of(&[0.5, 3.0, 10.0]);
            let light = match random.within(0, 1) {
                0 => Light::lamp(place, range),
                _ => {
                    let direction = Vec3::new(quarter(&mut random, 4), quarter(&mut random, 4), -1.0);
                    let [a, b] = [(); 2].map(|()| random.unit() * 89.0 + 1.0);
                    let [inner, outer] = [a.min(b), a.max(b)].map(Angle::from_degrees);
                    Light::spot(place, range, Cone { direction, inner, outer })
                }
            };
            scene.add_light(light.with_intensity(random.one_of(&[0.5, 1.0, 3.0])));
        }
        let drawn = triangles_by(&mut Renderer::new(), &scene);
        let is_front = (corners[1] - corners[0]).cross(corners[2] - corners[0]).z > 0.0;
        for (corner, vertex) in drawn.as_flattened().iter().enumerate().filter(|_| is_front) {
            let normal = unit(wide(normal)).expect("a normal");
            let expected = model(&scene, &material, (wide(corners[corner % 3]), normal)).clamp(0.0, 1.0);
            // A shade is rounded to half a unit. The normal is f32, off by a few 2⁻²⁴, which a highlight multiplies by
            // its exponent, and lights reach three times 3.
            let off = (f64::from(vertex.shade().to_bits()) - expected * 65_280.0).abs();
            let allowed = 0.5 + 65_280.0 * 9.0 * f64::powi(2.0, -22) * (1.0 + f64::from(shininess));
            assert!(
                off <= allowed,
                "{vertex:?} is {off} off {expected}: {corners:?}, {normal:?}, {:?}",
                scene.lights()
            );
            tried.worst("of what is allowed", off / allowed);
            lit += u64::from(expected > 0.2);
        }
        tried.add(3);
    }
    assert!(lit > 500, "{lit} corners are lit");
}

/// Shininess 0 means no highlight, whatever the object's other materials are; negative values are rejected.
#[test]
fn without_shininess_there_is_no_highlight() {
    let frame = |specular: f32, shininess: f32, other: f32| {
        let cube = shapes::cube();
        let half = (0..cube.triangles().len()).map(|triangle| (triangle % 2) as u16).collect();
        let cube = cube.with_surfaces(vec![Surface::default(); 2], half).expect("two surfaces");
        let mut scene = Scene::showing(cube);
        let materials = &mut scene.objects_mut()[0].materials;
        (materials[0].specular, materials[0].shininess) = (specular, shininess);
        (materials[1].specular, materials[1].shininess) = (other, 20.0);
        let mut vga = Vga::new();
        Renderer::new().draw(&scene, &mut vga).map(|_| vga.pixels().to_vec()).map_err(|error| error.to_string())
    };
    for other in [0.0, 0.5] {
        let without = frame(0.0, 20.0, other);
        assert!(without.is_ok());
        assert_eq!(frame(0.5, 0.0, other), without, "beside {other}");
        assert_ne!(frame(0.5, 1e-30, other), without, "beside {other}");
        let error = frame(0.5, -1.0, other).expect_err("below 0");
        assert_eq!(error, "object 0: the shininess of its materials must not be negative");
    }
}

/// A light whose strength on a channel overflows f32 is rejected: as infinity, together with one of the opposite sign,
/// it would give NaN.
#[test]
fn n5_a_light_stronger_than_f32_holds_is_refused() {
    let mut tried = Tried::new("n5_a_light_stronger_than_f32_holds_is_refused", 24);
    for (intensity, share) in [(f32::MAX, 2.0), (1e30, 1e30), (f32::MIN, 1.5), (2.0, f32::MIN)] {
        for channel in 0..3 {
            let mut color = [0.5; 3];
            color[channel] = share;
            for light in [Light::sun([0.0, 0.0, 1.0]), Light::lamp([0.0, 0.0, 3.0], 9.0)] {
                let mut scene = crate::support::scenes::framed(shapes::cube());
                scene.lights_mut()[0] = light.with_intensity(intensity).with_color(color);
                let refused = Renderer::new().draw(&scene, &mut Vga::new());
                assert!(matches!(refused, Err(RenderError::Light { index: 0, .. })), "{intensity:e} of {color:?}");
                tried.add(1);
            }
        }
    }
}

/// Any direction, three channels, any strength: the f64 sum, clamped once.
#[test]
fn n5_lights_from_any_direction_on_three_channels() {
    let mut tried = Tried::new("n5_lights_from_any_direction_on_three_channels", 40 * 2);
    let mut random = Random::named("n5 channels");
    let mut inside = 0;
    for case in 0..40 {
        let any = |random: &mut Random| [0; 3].map(|_| random.unit() as f32 * 2.0 - 1.0);
        let normal = Vec3::from(any(&mut random)).with_z(1.0);
        let mut scene = Scene::new();
        scene.palette = Some(builtin::by_name("cube").expect("built in").palette.clone());
        let object = scene.add(Object::new(triangle(normal)));
        let color = [0.9, 0.5, 0.7];
        scene[object].materials =
            vec![Material { ambient: 0.2, diffuse: 0.8, color, ramp: RampChoice::Nearest, ..Material::default() }];
        scene.ambient = 0.5;
        let wild = [f32::MAX, f32::MIN, 1.0, -1.0, 1e30, -1e30, 0.0, f32::MIN_POSITIVE];
        let shares = [1.0, -1.0, 0.0, -0.0, 1e-30, -0.5, f32::MIN_POSITIVE];
        for _ in 0..1_000 {
            let intensity = if case % 2 == 0 { random.one_of(&wild) } else { random.unit() as f32 * 0.1 - 0.045 };
            let color = if case % 4 == 0 { [0; 3].map(|_| random.one_of(&shares)) } else { any(&mut random) };
            scene.add_light(Light::sun(any(&mut random)).with_intensity(intensity).with_color(color));
        }
        let n = unit(wide(normal)).expect("a normal");
        let between = [0, 1, 2].map(|i| {
            // The sum, and how far it may be off: cosines in f32 by about 2⁻²², strengths by as much.
            let (mut sum, mut reach) = (0.0_f64, 0.0_f64);
            for light in scene.lights() {
                let Light::Sun { direction, intensity, color } = light else { panic!("a sun") };
                let cosine = dot(n, unit(wide(*direction)).expect("a direction"));
                let term = f64::from(*intensity) * f64::from(color[i]) * cosine.max(0.0);
                sum += term;
                reach += (f64::from(*intensity) * f64::from(color[i])).abs() * f64::powi(2.0, -21);
            }
            let of = |sum: f64| (0.8 * sum * f64::from(color[i]) + 0.2 * 0.5 * f64::from(color[i])).clamp(0.0, 1.0);
            (255.0 * of(sum - reach), 255.0 * of(sum + reach))
        });
        for shading in [Shading::Gouraud88Reseeded, Shading::Phong] {
            let screen = Screen { width: 24, height: 16, ..Screen::MODE_13H };
            let shown = Probe::new(shaded(shading)).look(&scene, screen).expect("a legal scene");
            let middle = 24 * 8 + 12;
            assert!(shown.faces[middle].is_some());
            for (&(low, high), shade) in between.iter().zip(shown.shades[middle]) {
                // A byte: half, and a shade's 256th.
                let is_there = (low - 0.51..=high + 0.51).contains(&shade);
                assert!(is_there, "case {case}, {shading}: {shade}, not {low} to {high}");
                inside += u64::from(high - low < 0.1 && low > 1.0 && high < 254.0);
            }
            tried.add(1);
        }
    }
    tried.worst("channels neither dark nor full", inside as f64);
    assert!(inside > 60, "{inside} channels neither dark nor full");
}

#[test]
fn r9_what_is_not_finite_is_refused_where_it_enters() {
    floats::every_float_is_refused(Tried::new("r9_what_is_not_finite_is_refused_where_it_enters", 249));
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(I24F8::round_from_f32(bad), None);
    }
    let mut scene = crate::support::scenes::framed(shapes::cube());
    scene.lights_mut()[0] = Light::sun([0.0; 3]);
    assert!(matches!(Renderer::new().draw(&scene, &mut Vga::new()), Err(RenderError::Light { index: 0, .. })));
    scene = crate::support::scenes::framed(shapes::cube());
    scene.camera.target = scene.camera.eye;
    assert!(matches!(Renderer::new().draw(&scene, &mut Vga::new()), Err(RenderError::Camera(_))));
}

#[test]
fn r10_denormals_and_minus_zero_draw_as_zero() {
    let mut tried = Tried::new("r10_denormals_and_minus_zero_draw_as_zero", 430);
    floats::every_float_near_zero_is_zero(&mut tried);
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
        scene[object].angles = [f64::from(tiny); 3].map(Angle::from_radians);
        scene.add_light(Light::sun([0.4, 0.6, 1.0]));
        crate::support::scenes::frame(&scene)
    };
    let with_zero = frame(0.0);
    assert!(with_zero.iter().filter(|&&byte| byte != 0).count() > 1000);
    for tiny in floats::NEXT_TO_ZERO {
        assert_eq!(frame(tiny), with_zero, "{tiny:e}");
        tried.add(1);
    }
}
