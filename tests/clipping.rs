//! What the camera sees when geometry reaches behind it or beyond the guard band.
#![cfg(feature = "alloc")]

mod support;

use mode13h::glam::Vec3;
use mode13h::mesh::{Mesh, shapes};
use mode13h::raster::Rect;
use mode13h::raster::cover::Ordered;
use mode13h::render::{Renderer, Screen, Stats};
use mode13h::scene::{Camera, Object, Scene};
use support::random::Random;
use support::tried::Tried;

const WIDTH: usize = 320;
const HEIGHT: usize = 200;

/// How often each pixel is covered.
fn counts(scene: &Scene) -> (Vec<u32>, Stats) {
    let mut counts = vec![0; WIDTH * HEIGHT];
    let clip = Rect { x0: 0, y0: 0, x1: WIDTH as u32, y1: HEIGHT as u32 };
    let stats = Renderer::new()
        .for_each_triangle(scene, Screen::MODE_13H, |vertices, _| {
            Ordered::new(vertices).rows(WIDTH as u32, clip, |row| {
                for x in row.x0..row.x1 {
                    counts[row.y as usize * WIDTH + x as usize] += 1;
                }
            });
        })
        .expect("a legal scene");
    (counts, stats)
}

/// An eye at the origin that looks along −z.
fn scene(mesh: Mesh) -> Scene {
    let mut scene = Scene::new();
    scene.camera = Camera { eye: Vec3::ZERO, target: Vec3::NEG_Z, up: Vec3::Y, field_of_view: 1.0, near: 0.25 };
    scene.add(Object::new(mesh));
    scene
}

/// A floor one below the eye, `reach` to all sides, of `n × n` squares of two triangles.
fn floor(reach: f32, n: u32) -> Mesh {
    let at = |i: u32| reach * (i as f32 / n as f32 * 2.0 - 1.0);
    let positions = (0..=n).flat_map(|z| (0..=n).map(move |x| Vec3::new(at(x), -1.0, at(z)))).collect();
    let corner = |x, z| z * (n + 1) + x;
    let triangles = (0..n * n)
        .flat_map(|i| {
            let (x, z) = (i % n, i / n);
            let (a, b, c, d) = (corner(x, z), corner(x + 1, z), corner(x, z + 1), corner(x + 1, z + 1));
            if (x + z) % 2 == 0 { [[a, c, b], [b, c, d]] } else { [[a, c, d], [a, d, b]] }
        })
        .collect();
    Mesh::new(positions, triangles).expect("a mesh")
}

#[test]
fn r7_a_floor_of_any_size_is_closed_to_the_horizon() {
    let mut tried = Tried::new("r7_a_floor_of_any_size_is_closed_to_the_horizon", 24);
    for reach in [1e4_f32, 1e6, 1e12, 1e20, 1e30, f32::MAX / 2.0] {
        for n in [1, 2, 3, 8] {
            // The far edge is projected fy / reach below the horizon: less than half a pixel. So the
            // rows from the horizon down, from 100 to 199, are all floor, and no other is. (The floor
            // begins under the eye: the picture's lower edge is nearer than the far edge by far.)
            let (counts, stats) = counts(&scene(floor(reach, n)));
            for (place, &times) in counts.iter().enumerate() {
                let inside = place / WIDTH >= HEIGHT / 2;
                assert_eq!(
                    times,
                    u32::from(inside),
                    "({}, {}) of a floor of {reach:e}, {n} squares a side",
                    place % WIDTH,
                    place / WIDTH
                );
            }
            assert!(stats.clipped > 0, "{stats}");
            tried.add(1);
        }
    }
}

#[test]
fn c1_corners_behind_the_eye_on_the_near_plane_at_w_0() {
    let mut tried = Tried::new("c1_corners_behind_the_eye_on_the_near_plane_at_w_0", 4000);
    let mut random = Random::named("c1");
    let mut drawn = 0_u64;
    while tried.more() {
        let mut corner = || {
            let z = random.one_of(&[-0.25, -0.0, 0.0, 0.25, 1.0, -1.0, -0.250_000_03, -0.249_999_99, -5.0]);
            Vec3::new(random.unit() as f32 * 4.0 - 2.0, random.unit() as f32 * 4.0 - 2.0, z)
        };
        let corners = [corner(), corner(), corner()];
        let visible = corners.iter().any(|p| -p.z >= 0.25);
        let Ok(mesh) = Mesh::new(corners.to_vec(), vec![[0, 1, 2]]) else { panic!("{corners:?}") };
        let (counts, _) = counts(&scene(mesh));
        assert!(visible || counts.iter().all(|&times| times == 0), "nothing of {corners:?} is in sight");
        assert!(counts.iter().all(|&times| times <= 1), "{corners:?} is cut into parts that overlap");
        drawn += u64::from(counts.contains(&1));
    }
    assert!(drawn > 500, "faces were in sight: {drawn}");
}

#[test]
fn c1_the_visible_part_is_what_a_ray_hits() {
    let mut tried = Tried::new("c1_the_visible_part_is_what_a_ray_hits", 300);
    let mut random = Random::named("c1 rays");
    let fy = 100.0 / f64::tan(0.5);
    let fx = fy * 6.0 / 5.0;
    let mut hits = 0;
    while tried.more() {
        // In front of the eye, behind it, to the sides; beyond the guard band too.
        let size = f64::from(random.log_uniform(10) as u32);
        let mut corner = || [0; 3].map(|_| (random.unit() * 2.0 - 1.0) * size).map(|c| f64::from(c as f32));
        let [a, b, c] = [corner(), corner(), corner()];
        let narrow = |p: [f64; 3]| Vec3::new(p[0] as f32, p[1] as f32, p[2] as f32);
        let Ok(mesh) = Mesh::new(vec![narrow(a), narrow(b), narrow(c)], vec![[0, 1, 2]]) else { continue };
        let (counts, _) = counts(&scene(mesh));
        for y in 0..HEIGHT {
            for x in 0..WIDTH {
                let centre = (x as f64 + 0.5, y as f64 + 0.5);
                let ray = |dx: f64, dy: f64| [(centre.0 + dx - 160.0) / fx, -(centre.1 + dy - 100.0) / fy, -1.0];
                // Within 1/64 pixel of an edge rounding may decide: the vertices are rounded to half of
                // 1/256 both ways, an f32 vertex is off by less than that, and cuts by 1/128.
                let near_edge = |dx: f64, dy: f64| hit(a, b, c, ray(dx, dy));
                let middle = near_edge(0.0, 0.0);
                let e = 1.0 / 64.0;
                if [(e, e), (e, -e), (-e, e), (-e, -e)].iter().any(|&(dx, dy)| near_edge(dx, dy) != middle) {
                    continue;
                }
                assert_eq!(counts[y * WIDTH + x], u32::from(middle), "({x}, {y}) of {a:?} {b:?} {c:?}");
                hits += u32::from(middle);
            }
        }
    }
    assert!(hits > 100_000, "faces were hit: {hits}");
}

/// Whether the ray from the origin meets the triangle beyond the near plane. `ray`'s z is −1, so its
/// parameter is the distance along the view.
fn hit(a: [f64; 3], b: [f64; 3], c: [f64; 3], ray: [f64; 3]) -> bool {
    let sub = |p: [f64; 3], q: [f64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let cross =
        |p: [f64; 3], q: [f64; 3]| [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let (u, v, w) = (dot(ray, cross(a, b)), dot(ray, cross(b, c)), dot(ray, cross(c, a)));
    let normal = cross(sub(b, a), sub(c, a));
    let along = dot(normal, a) / dot(normal, ray);
    ((u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0)) && along > 0.25
}

#[test]
fn c4_odd_views_are_quiet() {
    let mut tried = Tried::new("c4_odd_views_are_quiet", 500);
    let mut random = Random::named("c4");
    let mesh = shapes::torus(16, 8);
    while tried.more() {
        let mut scene = Scene::showing(mesh.clone());
        let mut place =
            || Vec3::new(random.unit() as f32 - 0.5, random.unit() as f32 - 0.5, random.unit() as f32 - 0.5);
        // Inside the mesh, on a vertex of it, far away.
        scene.camera.eye = place() * 2.0;
        scene.camera.target = place();
        scene.camera.near = 1e-3;
        if random.within(0, 3) == 0 {
            scene.camera.eye = random.one_of(mesh.positions());
        }
        scene.camera.field_of_view = random.one_of(&[1.0_f32, 40.0, 90.0, 179.0]).to_radians();
        let mut vga = mode13h::vga::Vga::new();
        let stats = Renderer::new().draw(&scene, &mut vga).expect("a legal scene");
        assert_eq!(stats.faces, 256);
    }
}
