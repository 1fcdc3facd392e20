//! Whole scenes through the integer vertex path: against the f32 path, clipped, and over a full turn.

use std::f64::consts::TAU;

use crate::floor::{HEIGHT, WIDTH};
use crate::near_plane::{corners_about_the_near_plane, floors_are_closed, the_visible_part_is_hit};
use crate::support::odd_views::odd_views;
use crate::support::scenes::{by_path as renderer, frame_by, framed, triangles_by};
use crate::support::tried::Tried;
use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::{Blend, Light};
use mode13h::mesh::{Mesh, shapes};
use mode13h::plan::Effect;
use mode13h::raster::Frame;
use mode13h::render::{RenderError, Renderer, Screen, Stats};
use mode13h::scene::{Camera, Object, Scene, UpAxis};
use mode13h::settings::{HiddenSurfaces, Shading, VertexPath};
use mode13h::vga::Vga;
use mode13h_conformance::Random;
use mode13h_conformance::oracle;

fn frame(renderer: &mut Renderer, scene: &Scene) -> Vec<u8> {
    let (bytes, stats) = frame_by(renderer, scene);
    assert_eq!(Some(stats.vertex_path), renderer.settings.vertex_path);
    bytes
}

/// An angle that both paths represent exactly, in 65,536ths of a turn.
fn steps(steps: i64) -> f64 {
    steps as f64 * TAU / 65_536.0
}

/// The distance of a point from a line segment.
pub(crate) fn distance(p: (f64, f64), a: (f64, f64), b: (f64, f64)) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let square = dx * dx + dy * dy;
    let t = if square > 0.0 { (((p.0 - a.0) * dx + (p.1 - a.1) * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
    (p.0 - a.0 - t * dx).hypot(p.1 - a.1 - t * dy)
}

/// How far apart the two paths' vertices may be on the screen along either axis, in pixels, in a scene made by
/// [`framed`](crate::support::scenes::framed) whose angles both represent exactly.
///
/// An entry of the 16.16 matrix is off by half a unit and a hair of what the scale's mantissa makes of 1, so a
/// vertex at r or nearer to the pivot by 0.51 · √3 · r / 65,536 along each axis, all else by less than
/// 2⁻²⁴ of the scene. In f32 seven roundings of 2⁻²⁴ of what they reach, r and the eye's distance d,
/// come to less than 2⁻²¹ · (r + d). Then each is rounded to 1/256 pixel.
fn vertex_bound(scene: &Scene) -> f64 {
    let radius = f64::from(scene.objects()[0].mesh().bounds().radius);
    let eye = f64::from(scene.camera.eye.z);
    let off = 0.51 * 3.0_f64.sqrt() * radius / 65_536.0 + (radius + eye) * (2.0_f64.powi(-21) + 2.0_f64.powi(-24));
    let focal = 100.0 / f64::tan(scene.camera.field_of_view.to_radians() / 2.0) * 6.0 / 5.0;
    // All of it lies within the picture's height, so |X| / W and |Y| / W are below the tangent of 40°/2.
    let screen = focal * off * (1.0 + f64::tan(scene.camera.field_of_view.to_radians() / 2.0)) / (eye - radius);
    screen + 1.0 / 256.0
}

/// Compares the frames of both paths; returns the number of pixels compared, and of those that differ at all.
fn compare(scene: &Scene, name: &str) -> (u64, u64) {
    let off = vertex_bound(scene);
    assert!(off < 2.0 / 256.0, "{name}: 1/128 pixel is the bound: {off}");
    let triangles = triangles_by(&mut renderer(VertexPath::Float), scene);
    let (float, integer) =
        (frame(&mut renderer(VertexPath::Float), scene), frame(&mut renderer(VertexPath::Integer), scene));

    // For every pixel: whether an edge is so near that rounding may decide, and the nearest two depths, with how far
    // the depth, and the shade, may be off.
    let mut undecided = vec![false; WIDTH * HEIGHT];
    let mut seen = vec![Vec::<(f64, f64, f64)>::new(); WIDTH * HEIGHT];
    for vertices in &triangles {
        let at = vertices.map(|v| (f64::from(v.x().to_bits()) / 256.0, f64::from(v.y().to_bits()) / 256.0));
        let range = |get: fn(&(f64, f64)) -> f64, size: usize| {
            let low = at.iter().map(get).fold(f64::MAX, f64::min) - 1.0;
            let high = at.iter().map(get).fold(f64::MIN, f64::max) + 1.0;
            low.max(0.0) as usize..(high.max(0.0) as usize + 1).min(size)
        };
        let points = vertices.each_ref().map(oracle::point);
        for y in range(|p| p.1, HEIGHT) {
            for x in range(|p| p.0, WIDTH) {
                let place = y * WIDTH + x;
                let centre = (x as f64 + 0.5, y as f64 + 0.5);
                // Vertices that move by `off` along both axes move an edge by at most √2 of that.
                let edges = [(0, 1), (1, 2), (2, 0)];
                if edges.iter().any(|&(a, b)| distance(centre, at[a], at[b]) <= off * 2.0_f64.sqrt()) {
                    undecided[place] = true;
                    continue;
                }
                if !oracle::covers(points, oracle::centre(x as i32, y as i32)) {
                    continue;
                }
                // The value, and its change from here to a pixel further along x and y.
                let plane = |values: [i128; 3]| {
                    let value = |dx: i32, dy: i32| {
                        let ratio = oracle::interpolate(points, values, oracle::centre(x as i32 + dx, y as i32 + dy));
                        ratio.n as f64 / ratio.d as f64
                    };
                    let here = value(0, 0);
                    (here, (value(1, 0) - here).abs() + (value(0, 1) - here).abs())
                };
                let (depth, depth_slope) = plane(vertices.each_ref().map(|v| i128::from(v.depth())));
                let (_, shade_slope) = plane(vertices.each_ref().map(|v| i128::from(v.shade().to_bits())));
                // Depths themselves by the same share as w: less than 2⁻¹⁶ of them, plus rounding.
                seen[place].push((depth, depth_slope * off + depth / 65_536.0 + 2.0, shade_slope * off / 256.0));
            }
        }
    }

    let (mut compared, mut differ) = (0, 0);
    for (place, mut seen) in seen.into_iter().enumerate() {
        let (a, b) = (float[place], integer[place]);
        differ += u64::from(a != b);
        if undecided[place] {
            continue;
        }
        compared += 1;
        let at = (place % WIDTH, place / WIDTH);
        assert_eq!(a != scene.background, b != scene.background, "{name}, {at:?}: cover");
        seen.sort_by(|p, q| q.0.total_cmp(&p.0));
        let Some(&(nearest, off, shade)) = seen.first() else { continue };
        if seen.get(1).is_some_and(|&(next, next_off, _)| nearest - next < off + next_off) {
            continue;
        }
        // Normal and direction of the light are off by half a unit of 2⁻¹⁶ along each axis, and so by
        // √3/2, their product is rounded, and shades are to 1/256 on either path: less than 1/32 shade.
        // The 8.8 steps drift by less than 65/256 on either. Nearest bytes of values so far apart:
        let bound = (shade + 1.0 / 32.0 + 65.0 / 256.0).floor() + 1.0;
        assert!(f64::from(a.abs_diff(b)) <= bound, "{name}, {at:?}: shades {a} and {b}, {bound} allowed");
    }
    (compared, differ)
}

#[test]
fn both_paths_draw_the_same_picture() {
    let mut tried = Tried::new("both_paths_draw_the_same_picture", 7 * 24);
    let mut random = Random::named("both paths");
    let (mut compared, mut differ) = (0, 0);
    for name in shapes::NAMES {
        let mut scene = crate::support::scenes::framed(shapes::by_name(name).expect("listed"));
        scene.add_light(Light::sun([-1.0, 0.3, 0.2]).with_intensity(0.5));
        for _ in 0..24 {
            let angles = [0; 3].map(|_| steps(random.within(-70_000, 70_000)));
            scene.objects_mut()[0].angles = angles.map(Angle::from_radians);
            let (pixels, others) = compare(&scene, name);
            (compared, differ) = (compared + pixels, differ + others);
            tried.add(1);
        }
    }
    let all = 7 * 24 * WIDTH * HEIGHT;
    println!("{compared} of {all} pixels compared, {differ} differ at all");
    assert!(compared > all as u64 * 9 / 10, "few pixels lie so near to an edge");
    assert!(differ < all as u64 / 200, "few bytes differ: {differ}");
}

/// For a shading that a path lacks, the plan names the one drawn instead.
#[test]
fn the_plan_names_the_shading_that_is_drawn() {
    let mut tried = Tried::new("the_plan_names_the_shading_that_is_drawn", 2 * 10);
    let scene = crate::support::scenes::framed(shapes::torus(12, 8));
    for path in VertexPath::ALL {
        for shading in Shading::ALL {
            let drawn = if path == VertexPath::Integer { shading.in_integers() } else { shading };
            let mut renderer = renderer(path);
            renderer.settings.accuracy = Some(shading.into());
            let mut interpolations = Vec::new();
            let stats = renderer
                .for_each_triangle(&scene, Screen::MODE_13H, |_, interpolation| interpolations.push(interpolation))
                .expect("a legal scene");
            assert_eq!(stats.shading, drawn);
            let decision = &renderer.plan().objects()[0][Effect::Gouraud];
            let shades_run = drawn != Shading::Flat && !drawn.lights_pixels();
            assert_eq!(decision.on, shades_run, "{path}, {shading}");
            if shades_run {
                assert_eq!(decision.choice.name(), drawn.name(), "{path}, {shading}");
                assert!(
                    interpolations.iter().all(|interpolation| *interpolation == drawn.interpolation()),
                    "{path}, {shading}"
                );
            }
            tried.add(1);
        }
    }
}

#[test]
fn every_shading_and_odd_scene_is_drawn_and_counted_alike() {
    let mut tried = Tried::new("every_shading_and_odd_scene_is_drawn_and_counted_alike", 5 * 4);
    // Vertices that differ by a unit between the paths may differ by a whole pixel in `gouraud-vintage`.
    let known = |shading: &Shading| shading.in_integers() == *shading && shading.has_exact_cover();
    for shading in Shading::ALL.into_iter().filter(known) {
        // A scale and position of its own, off the pivot, with the mesh laid back; three materials.
        for (scale, place) in [(1.0_f32, 0.0_f32), (1e-5, 1e-6), (3.7e8, -2e9), (0.001, 5.0)] {
            let mut scene = Scene::new();
            let mut object = Object::new(shapes::torus(24, 12));
            (object.scale, object.pivot, object.up_axis) = (scale, Vec3::new(0.3, 2.0, -0.1), UpAxis::Z);
            object.position = Vec3::splat(place);
            object.angles = [steps(1000), steps(20_000), steps(-300)].map(Angle::from_radians);
            scene.add(object);
            scene.add_light(Light::sun([0.4, 0.6, 1.0]));
            scene.camera = Camera::framing(Vec3::splat(place) - Vec3::Y * 2.0 * scale, 2.0 * scale);
            let [float, integer] = VertexPath::ALL.map(|path| {
                let mut renderer = renderer(path);
                renderer.settings.accuracy = Some(shading.into());
                frame_by(&mut renderer, &scene)
            });
            let (f, i) = (float.1, integer.1);
            assert_eq!((f.vertices, f.faces, f.hidden_surfaces), (i.vertices, i.faces, i.hidden_surfaces));
            assert_eq!((i.clipped, i.culled + i.drawn), (0, i.faces));
            assert_eq!(i.lit, if shading == Shading::Flat { i.drawn } else { i.vertices });
            // A face seen edge-on may count as turned away on one path and not on the other.
            assert!(f.culled.abs_diff(i.culled) <= 4, "{f}; {i}");
            let differ = float.0.iter().zip(&integer.0).filter(|(a, b)| a.abs_diff(**b) > 1).count();
            let drawn = float.0.iter().filter(|b| **b != 0).count();
            assert!(drawn > 1000, "{shading}, {scale}: {drawn}");
            assert!(differ < 100, "{shading}, {scale}: {differ} of {drawn}");
            tried.add(1);
        }
    }
}

/// Transparent materials are drawn opaque, so nothing shows through, whatever the hidden-surface method.
#[test]
fn transparent_materials_are_opaque_on_the_integer_path() {
    for mesh in [shapes::torus(24, 12), shapes::teapot(4)] {
        let mut scene = framed(mesh);
        for hidden_surfaces in [None, Some(HiddenSurfaces::ScanLine)] {
            let mut renderer = renderer(VertexPath::Integer);
            renderer.settings.hidden_surfaces = hidden_surfaces;
            let id = scene.object_ids()[0];
            scene[id].materials[0].blend = Blend::Opaque;
            let opaque = frame_by(&mut renderer, &scene);
            scene[id].materials[0].blend = Blend::Mix(128);
            let transparent = frame_by(&mut renderer, &scene);
            assert!(transparent.0 == opaque.0, "{hidden_surfaces:?}");
            assert_eq!(transparent.1.hidden_surfaces, opaque.1.hidden_surfaces);
        }
    }
}

#[test]
fn t3_a_full_turn_returns_to_the_picture() {
    let mut tried = Tried::new("t3_a_full_turn_returns_to_the_picture", 3 * 300);
    let mut random = Random::named("t3");
    let mut renderer = renderer(VertexPath::Integer);
    let mut scene = crate::support::scenes::framed(shapes::torus(24, 12));
    let mut different = std::collections::HashSet::new();
    for axis in 0..3 {
        for _ in 0..300 {
            let n = random.within(0, 65_535);
            let mut turned = |n: i64| {
                let mut angles = [0.1, 0.2, 0.3];
                angles[axis] = steps(n);
                scene.objects_mut()[0].angles = angles.map(Angle::from_radians);
                frame(&mut renderer, &scene)
            };
            let once = turned(n);
            for turns in [1, -1, 1000] {
                assert!(turned(n + turns * 65_536) == once, "step {n} about axis {axis}, {turns} turns later");
            }
            different.insert(once);
            tried.add(1);
        }
    }
    assert!(different.len() > 700, "a turn is seen: {} pictures", different.len());
}

#[test]
fn t2_steps_of_any_size() {
    let mut tried = Tried::new("t2_steps_of_any_size", 9);
    let mut renderer = renderer(VertexPath::Integer);
    let mut scene = crate::support::scenes::framed(shapes::cube());
    let id = 0;
    let first = frame(&mut renderer, &scene);
    for step in [0.0, -0.0, 0.1, -0.1, 3600.0, -3600.0, 86_400.0, 1e9] {
        scene.objects_mut()[id].rotate_y(Angle::from_radians(step));
        let there = frame(&mut renderer, &scene);
        assert_eq!(there == first, step == 0.0, "a step of {step}");
        scene.objects_mut()[id].angles = [Angle::default(); 3];
        assert!(frame(&mut renderer, &scene) == first, "and back");
        tried.add(1);
    }
    // Beyond the range where f64 can count turns, any angle will do.
    scene.objects_mut()[id].angles = [f64::MAX, -1e300, f64::MIN_POSITIVE].map(Angle::from_radians);
    frame(&mut renderer, &scene);
    tried.add(1);
}

#[test]
fn t1_frame_n_after_n_frames_is_frame_n_at_once() {
    let mut tried = Tried::new("t1_frame_n_after_n_frames_is_frame_n_at_once", 500);
    let mut renderer = renderer(VertexPath::Integer);
    let mut scene = crate::support::scenes::framed(shapes::torus(12, 8));
    for n in 0..500 {
        scene.objects_mut()[0].angles = [steps(3 * n), steps(131 * n), steps(-7 * n)].map(Angle::from_radians);
        let after_all_before = frame(&mut renderer, &scene);
        assert!(after_all_before == frame(&mut self::renderer(VertexPath::Integer), &scene), "frame {n}");
        tried.add(1);
    }
}

#[test]
fn e1_a_changed_mesh_is_converted_anew() {
    let mut tried = Tried::new("e1_a_changed_mesh_is_converted_anew", 40);
    let mut kept = renderer(VertexPath::Integer);
    let mut random = Random::named("e1 integer");
    let mut scene = crate::support::scenes::framed(shapes::cube());
    while tried.more() {
        // A dropped mesh leaves its address to the next.
        let mesh = match random.within(0, 3) {
            0 => shapes::cube(),
            1 => shapes::torus(random.within(3, 20) as u32, 6),
            2 => shapes::cone(random.within(3, 20) as u32, 2),
            _ => Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y * random.unit() as f32], vec![[0, 1, 2]]).expect("sound"),
        };
        let object = &mut scene.objects_mut()[0];
        *object = Object::new(mesh).centred();
        let mut compare = |scene: &Scene| {
            assert!(frame(&mut kept, scene) == frame(&mut renderer(VertexPath::Integer), scene));
        };
        compare(&scene);
        scene.objects_mut()[0].pivot.x += 0.25;
        compare(&scene);
        scene.objects_mut()[0].up_axis = UpAxis::Z;
        compare(&scene);
    }
}

#[test]
fn r8_bands_on_the_integer_path_give_the_bytes_of_the_whole() {
    let mut tried = Tried::new("r8_bands_on_the_integer_path_give_the_bytes_of_the_whole", 25);
    let mut scene = crate::support::scenes::framed(shapes::torus(24, 12));
    scene.objects_mut()[0].angles = [steps(5000), steps(900), 0.0].map(Angle::from_radians);
    let mut renderer = renderer(VertexPath::Integer);
    let whole = frame(&mut renderer, &scene);
    let mut band = [0; WIDTH * 8];
    for first in (0..HEIGHT).step_by(8) {
        let rows = first as u32..first as u32 + 8;
        let frame = Frame::band(&mut band, WIDTH as u32, HEIGHT as u32, WIDTH, rows).expect("a band");
        renderer.draw_frame(&scene, frame, (5, 6)).expect("a legal scene");
        assert!(band == whole[first * WIDTH..(first + 8) * WIDTH], "rows {first} on");
        tried.add(1);
    }
}

// ------------------------------------------------------------------ clipping

#[test]
fn r7_a_floor_on_the_integer_path_is_closed_to_the_horizon() {
    let tried = Tried::new("r7_a_floor_on_the_integer_path_is_closed_to_the_horizon", 20);
    floors_are_closed(tried, VertexPath::Integer, &[500.0, 2e3, 1e4, 3e4, 6e4], &[1, 2, 3, 8]);
}

#[test]
fn c1_on_the_integer_path_corners_behind_the_eye_on_the_near_plane_at_w_0() {
    let tried = Tried::new("c1_on_the_integer_path_corners_behind_the_eye_on_the_near_plane_at_w_0", 4000);
    corners_about_the_near_plane(tried, VertexPath::Integer);
}

#[test]
fn c1_on_the_integer_path_the_visible_part_is_what_a_ray_hits() {
    let tried = Tried::new("c1_on_the_integer_path_the_visible_part_is_what_a_ray_hits", 200);
    the_visible_part_is_hit(tried, VertexPath::Integer);
}

// ------------------------------------------------------------------ what is refused

#[test]
fn c4_odd_views_on_the_integer_path_are_quiet() {
    odd_views(Tried::new("c4_odd_views_on_the_integer_path_are_quiet", 500), VertexPath::Integer);
}

#[test]
fn scenes_that_16_16_cannot_hold_are_refused_and_others_drawn() {
    let mut tried = Tried::new("scenes_that_16_16_cannot_hold_are_refused_and_others_drawn", 12);
    let mut check = |change: fn(&mut Scene), expected: fn(&Result<Stats, RenderError>) -> bool| {
        let mut scene = crate::support::scenes::framed(shapes::cube());
        change(&mut scene);
        let mut vga = Vga::new();
        vga.poke(0, 99);
        let result = renderer(VertexPath::Integer).draw(&scene, &mut vga);
        assert!(expected(&result), "{result:?}");
        assert!(result.is_ok() || vga.peek(0) == 99, "the machine is left as it was");
        tried.add(1);
    };
    check(|_| (), |r| r.is_ok());
    check(|scene| scene.camera.near *= 1e-4, |r| matches!(r, Err(RenderError::Camera(_))));
    check(|scene| scene.objects_mut()[0].position.x = 1e9, |r| matches!(r, Err(RenderError::Camera(_))));
    check(|scene| scene.objects_mut()[0].position.x = 1e3, |r| r.is_ok());
    check(
        |scene| scene.camera.field_of_view = Angle::from_radians(0.001),
        |r| matches!(r, Err(RenderError::Camera(_))),
    );
    check(|scene| scene.camera.near = f32::MAX, |r| r.is_ok());
    check(|scene| scene.objects_mut()[0].scale = 0.0, |r| r.is_ok());
    check(|scene| scene.objects_mut()[0].scale = f32::MIN_POSITIVE / 8.0, |r| r.is_ok());
    check(|scene| scene.objects_mut()[0].scale = 1e5, |r| matches!(r, Err(RenderError::Camera(_))));
    check(
        |scene| {
            scene.add_light(Light::sun([0.0, 0.0, 1.0]).with_intensity(4e4));
        },
        |r| matches!(r, Err(RenderError::Light { index: 1, .. })),
    );
    check(
        |scene| scene.objects_mut()[0].materials[0].diffuse = 1e9,
        |r| matches!(r, Err(RenderError::Object { index: 0, .. })),
    );
    check(
        |scene| {
            for _ in 0..4096 {
                scene.add_light(Light::sun([0.0, f32::MIN_POSITIVE / 4.0, 0.0]));
            }
        },
        |r| matches!(r, Err(RenderError::Light { index: 4096, .. })),
    );
}

#[test]
fn r10_denormal_and_huge_scenes_are_scaled_into_range() {
    let mut tried = Tried::new("r10_denormal_and_huge_scenes_are_scaled_into_range", 9);
    // The same scene scaled by any power of two gives the same picture: scaling is exact.
    let picture = |exponent: i32| {
        let size = (f64::from(exponent)).exp2() as f32;
        let cube = shapes::cube();
        let positions = cube.positions().iter().map(|&p| p * size).collect();
        let mesh = Mesh::with_normals(positions, cube.normals().to_vec(), cube.triangles().to_vec()).expect("sound");
        let mut scene = Scene::new();
        let mut object = Object::new(mesh);
        object.angles = [0.4, 0.5, 0.6].map(Angle::from_radians);
        scene.add(object);
        scene.add_light(Light::sun([0.4, 0.6, 1.0]));
        let framed = Camera::framing(Vec3::ZERO, 1.0);
        scene.camera = Camera { eye: framed.eye * size, near: framed.near * size, ..framed };
        frame(&mut renderer(VertexPath::Integer), &scene)
    };
    let expected = picture(0);
    for exponent in [-90, -60, -20, -1, 1, 10, 30, 90, 120] {
        assert!(picture(exponent) == expected, "2^{exponent}");
        tried.add(1);
    }
}
