//! Group C: what reaches behind the eye or beyond the guard band; and R7, R9, R10 and R13 on the way to
//! the raster.

use super::drawing::{self, Configuration};
use super::random::Random;
use super::{Group, replay};
use crate::record::Record;
use mode13h::Angle;
use mode13h::fixed::{I16F16, I24F8};
use mode13h::glam::Vec3;
use mode13h::mesh::{Mesh, shapes};
use mode13h::raster::cover::SortedTriangle;
use mode13h::raster::{Interpolation, Rect, Vertex};
use mode13h::render::{HiddenSurfaces, Renderer, Screen, VertexPath};
use mode13h::scene::{Camera, Object, Scene};
use mode13h::span::Kernel;
use mode13h::vga::Vga;

const WIDTH: u32 = Vga::WIDTH as u32;
const HEIGHT: u32 = Vga::HEIGHT as u32;
const NEAR: f32 = 0.25;

/// A floor of any size is closed to the horizon, by both vertex paths; of faces that reach behind the eye that part is drawn
/// which a ray hits (C1); odd views are quiet and right (C4, R7); coordinates are rounded once and
/// exactly (R13); −0 and denormals draw as 0 does (R10); what is not finite is refused (R9).
///
/// ```
/// let group = mode13h_lab::verify::clipping(13);
/// assert!(group.passed(), "{:?}", group.failures);
/// ```
#[must_use]
pub fn clipping(seed: u64) -> Group {
    check(seed, &triangles_of)
}

/// Projection of a scene: the record of what it hands to the raster.
type Project<'a> = &'a dyn Fn(&Scene) -> Option<Record>;

fn triangles_of(scene: &Scene) -> Option<Record> {
    Record::of_scene(&mut Renderer::new(), scene, Screen::MODE_13H).ok()
}

fn check(seed: u64, project: Project<'_>) -> Group {
    let mut group = Group::new("clipping");
    let mut random = Random::new(seed, "clipping");
    floors(&mut group, &[1e4, 1e6, 1e12, 1e20, 1e30, 1e38, f32::MAX / 2.0], project);
    // The 16.16 path has 30 bits from the nearest to the farthest.
    floors(&mut group, &[400.0, 1e3, 8e3], &|scene| {
        let mut renderer = Renderer::new();
        renderer.settings.vertex_path = VertexPath::Integer;
        Record::of_scene(&mut renderer, scene, Screen::MODE_13H).ok()
    });
    rays(&mut group, &mut random, project);
    odd_views(&mut group, &mut random, project);
    rounding(&mut group, &mut random);
    nothing(&mut group, project);
    refused(&mut group);
    group
}

/// An eye at the origin that looks along −z.
fn seen_from_origin(mesh: Mesh) -> Scene {
    let mut scene = Scene::new();
    scene.camera = Camera {
        eye: Vec3::ZERO,
        target: Vec3::NEG_Z,
        up: Vec3::Y,
        field_of_view: Angle::from_radians(1.0),
        near: NEAR,
    };
    scene.add(Object::new(mesh));
    scene
}

/// Counts how often each pixel is covered.
fn counts(triangles: &[([Vertex; 3], Interpolation)]) -> Vec<u32> {
    let mut counts = vec![0; (WIDTH * HEIGHT) as usize];
    for (vertices, _) in triangles {
        SortedTriangle::new(vertices).rows(WIDTH, Rect { x0: 0, y0: 0, x1: WIDTH, y1: HEIGHT }, |row| {
            let start = row.y as usize * Vga::WIDTH;
            counts[start + row.x0 as usize..start + row.x1 as usize].iter_mut().for_each(|count| *count += 1);
        });
    }
    counts
}

/// The far edge is projected fy / reach below the horizon, less than half a pixel: the rows from the
/// horizon down are all floor, each pixel once, and no other is.
fn floors(group: &mut Group, reaches: &[f32], project: Project<'_>) {
    for &reach in reaches {
        for squares in [1, 2, 3, 4, 5, 6, 7] {
            let Some(record) = floor(reach, squares).map(seen_from_origin).and_then(|scene| project(&scene)) else {
                group.check(false, || format!("r7 a floor of {reach:e}: not drawn"));
                continue;
            };
            let counts = counts(&record.triangles);
            let wrong =
                (0..WIDTH * HEIGHT).find(|place| counts[*place as usize] != u32::from(place / WIDTH >= HEIGHT / 2));
            group.check(wrong.is_none(), || {
                let place = wrong.unwrap_or_default();
                format!(
                    "r7 a floor of {reach:e}, {squares} squares a side: pixel ({}, {}) is covered {} times",
                    place % WIDTH,
                    place / WIDTH,
                    counts[place as usize]
                )
            });
        }
    }
}

/// A floor one below the eye, `reach` to all sides, of `n × n` squares of two triangles.
fn floor(reach: f32, n: u32) -> Option<Mesh> {
    let at = |i: u32| reach * (i as f32 / n as f32 * 2.0 - 1.0);
    let positions = (0..=n).flat_map(|z| (0..=n).map(move |x| Vec3::new(at(x), -1.0, at(z)))).collect();
    let corner = |x, z| z * (n + 1) + x;
    let squares = (0..n * n).map(|i| (i % n, i / n));
    let triangles = squares.flat_map(|(x, z)| {
        let (a, b, c, d) = (corner(x, z), corner(x + 1, z), corner(x, z + 1), corner(x + 1, z + 1));
        if (x + z) % 2 == 0 { [[a, c, b], [b, c, d]] } else { [[a, c, d], [a, d, b]] }
    });
    Mesh::new(positions, triangles.collect()).ok()
}

/// C1: random faces before the eye, behind it and through it, against rays in f64.
fn rays(group: &mut Group, random: &mut Random, project: Project<'_>) {
    let fy = 100.0 / libm::tan(0.5);
    let fx = fy * 6.0 / 5.0;
    for _ in 0..300 {
        let size = random.log_uniform(10) as f64;
        let mut corner = || Vec3::from_array([0; 3].map(|_| random.around_zero(size) as f32));
        let corners = [corner(), corner(), corner()];
        let Ok(mesh) = Mesh::new(corners.to_vec(), vec![[0, 1, 2]]) else { continue };
        let record = project(&seen_from_origin(mesh));
        let counts = record.map(|record| counts(&record.triangles)).unwrap_or_default();
        let corners = corners.map(|p| [f64::from(p.x), f64::from(p.y), f64::from(p.z)]);
        let mut wrong = None;
        for _ in 0..400 {
            let (x, y) = (random.below(WIDTH), random.below(HEIGHT));
            let at = |dx: f64, dy: f64| {
                let (right, down) = (f64::from(x) + 0.5 + dx - 160.0, f64::from(y) + 0.5 + dy - 100.0);
                is_hit(&corners, [right / fx, -down / fy, -1.0])
            };
            // Within 1/64 pixel of an edge rounding may decide: vertices are rounded to half of 1/256
            // pixel both ways, an f32 vertex is off by less than that, and a cut by 1/128.
            const E: f64 = 1.0 / 64.0;
            let hit = at(0.0, 0.0);
            if [(E, E), (E, -E), (-E, E), (-E, -E)].iter().any(|(dx, dy)| at(*dx, *dy) != hit) {
                continue;
            }
            let count = counts.get((y * WIDTH + x) as usize).copied();
            if count != Some(hit.into()) {
                wrong = Some((x, y, count));
            }
        }
        group.check(wrong.is_none(), || format!("c1 face {corners:?}: (x, y, times covered) {wrong:?}"));
    }
}

/// Returns whether a ray from the origin meets a triangle beyond the near plane. The ray's z is −1, so its
/// parameter is the distance along the view.
fn is_hit([a, b, c]: &[[f64; 3]; 3], ray: [f64; 3]) -> bool {
    let sub = |p: &[f64; 3], q: &[f64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let cross =
        |p: &[f64; 3], q: &[f64; 3]| [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
    let dot = |p: &[f64; 3], q: &[f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let sides = [cross(a, b), cross(b, c), cross(c, a)].map(|n| dot(&ray, &n));
    let normal = cross(&sub(b, a), &sub(c, a));
    let along = dot(&normal, a) / dot(&normal, &ray);
    (sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0)) && along > f64::from(NEAR)
}

/// C4: fields of view of 1° and 179°, the eye inside the mesh, on a vertex of it, far away.
fn odd_views(group: &mut Group, random: &mut Random, project: Project<'_>) {
    let mesh = shapes::torus(12, 6);
    for case in 0..60 {
        let mut scene = super::framed(mesh.clone());
        let mut place = || Vec3::from_array([0; 3].map(|_| random.around_zero(1.0) as f32));
        (scene.camera.eye, scene.camera.target) = (place(), place());
        scene.camera.near = 1e-3;
        if random.below(4) == 0 {
            scene.camera.eye = random.one_of(mesh.positions());
        }
        scene.objects_mut()[0].scale = random.one_of(&[1.0, 1e-30, 1e-6, 1e6, 1e30]);
        scene.camera.field_of_view = Angle::from_degrees(random.one_of(&[1.0, 40.0, 90.0, 179.0]));
        let Some(mut record) = project(&scene) else {
            group.check(false, || format!("c4 {:?} is not drawn", scene.camera));
            continue;
        };
        if case >= 6 {
            // The depth buffer alone, against the scan-line method: the oracle takes its time.
            let ways = [HiddenSurfaces::DepthBuffer, HiddenSurfaces::ScanLine];
            let [depth, line] = ways.map(|way| drawing::draw(&record, Configuration::new(way, Kernel::default())));
            group
                .check(depth.is_ok() && depth == line, || format!("c4 {:?}: depth buffer and scan-line", scene.camera));
            continue;
        }
        record.palette = None;
        let way = Configuration::new(HiddenSurfaces::DepthBuffer, Kernel::default());
        group.check_record("c4", &record, &|record| replay::against_oracle(record, way, &drawing::draw));
    }
}

/// R13: floor(256·x + ½), exactly: in integers, from the bits of the f64.
fn rounding(group: &mut Group, random: &mut Random) {
    for _ in 0..4_000 {
        let size = random.log_uniform(23) as f64;
        let x = match random.below(4) {
            0 => random.around_zero(size),
            // Halves of a unit and their neighbours.
            1 => (random.within(-1 << 20, 1 << 20) as f64 + 0.5) / 256.0,
            2 => f64::from_bits(((random.within(-1 << 20, 1 << 20) as f64 + 0.5) / 256.0).to_bits() ^ 1),
            _ => f64::from_bits(random.next()),
        };
        let is = I24F8::round_from_f64(x).map(I24F8::to_bits);
        let should = exactly_rounded(x);
        group.check(is == should, || format!("r13 {x:e} ({:#018x}) becomes {is:?}, not {should:?}", x.to_bits()));

        // Of 16.16 pixels: in 1/65,536 a half of 1/256 is 128.
        let x = random.next() as u32 as i32;
        let (is, should) = (I24F8::round_from_i16f16(I16F16::from_bits(x)), (i128::from(x) + 128).div_euclid(256));
        group.check(i128::from(is.to_bits()) == should, || format!("r13 {x}/65,536 becomes {is:?}, not {should}/256"));
    }
}

fn exactly_rounded(x: f64) -> Option<i32> {
    if !x.is_finite() || x.abs() >= 9e6 {
        return None;
    }
    let (bits, exponent) = (x.to_bits(), (x.to_bits() >> 52 & 0x7FF) as i32);
    let mantissa = i128::from(bits & ((1 << 52) - 1) | if exponent == 0 { 0 } else { 1 << 52 });
    let signed = if x < 0.0 { -mantissa } else { mantissa };
    // 256·x = signed · 2^-down; below 2³², so down is more than 20.
    let down = 1075 - 8 - exponent.max(1);
    // Less than a half, whatever its sign, once it is shifted out whole.
    let rounded = if down > 64 { 0 } else { (signed + (1 << (down - 1))) >> down };
    // As the function has it, strictly within i32.
    let scaled = x * 256.0;
    if scaled <= -2_147_483_648.0 || scaled >= 2_147_483_647.0 { None } else { i32::try_from(rounded).ok() }
}

/// R10: −0 and what is smaller than any pixel draw as 0 does.
fn nothing(group: &mut Group, project: Project<'_>) {
    let scene = |zero: f32| {
        let corners = vec![Vec3::new(zero, zero, -2.0), Vec3::new(1.0, zero, -2.0), Vec3::new(zero, 1.0, -2.0)];
        Mesh::new(corners, vec![[0, 1, 2]]).ok().map(seen_from_origin)
    };
    let expected = scene(0.0).and_then(|scene| project(&scene));
    for zero in [-0.0, f32::MIN_POSITIVE, -f32::MIN_POSITIVE, 1e-45, -1e-45] {
        let drawn = scene(zero).and_then(|scene| project(&scene));
        group.check(drawn == expected && drawn.is_some(), || format!("r10 a corner at {zero:e} is not where 0 is"));
    }
}

/// R9: NaN and infinity are refused where they enter.
fn refused(group: &mut Group) {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for corner in 0..3 {
            let mut corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
            corners[corner].y = bad;
            let mesh = Mesh::new(corners.to_vec(), vec![[0, 1, 2]]);
            group.check(mesh.is_err(), || format!("r9 a mesh with a coordinate {bad} is taken"));
        }
        let spoil: [fn(&mut Scene, f32); 8] = [
            |scene, bad| scene.camera.eye.x = bad,
            |scene, bad| scene.camera.near = bad,
            |scene, bad| scene.camera.field_of_view = Angle::from_radians(bad.into()),
            |scene, bad| scene.ambient = bad,
            |scene, bad| scene.objects_mut()[0].position.z = bad,
            |scene, bad| scene.objects_mut()[0].scale = bad,
            |scene, bad| scene.objects_mut()[0].angles = [0.0, bad.into(), 0.0].map(Angle::from_radians),
            |scene, bad| scene.objects_mut()[0].materials[0].diffuse = bad,
        ];
        for (number, spoil) in spoil.into_iter().enumerate() {
            let mut scene = super::framed(shapes::cube());
            spoil(&mut scene, bad);
            let mut vga = Vga::new();
            vga.pixels_mut().fill(7);
            let refused = Renderer::new().draw(&scene, &mut vga).is_err();
            let untouched = vga.pixels().iter().all(|pixel| *pixel == 7);
            group.check(refused && untouched, || format!("r9 a scene with a number {bad} (place {number}) is drawn"));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clipping_is_right() {
        let group = clipping(1);
        assert_eq!(group.failures, [""; 0]);
        assert!(group.cases > 4_000);
    }

    /// A clipper that loses the last part of what it cut.
    #[test]
    fn a_hole_in_the_floor_is_told() {
        let group = check(1, &|scene| {
            let mut record = triangles_of(scene)?;
            record.triangles.pop();
            Some(record)
        });
        assert!(group.failures[0].starts_with("r7 a floor of 1e"), "{:?}", group.failures);
        assert!(group.failures[0].ends_with(") is covered 0 times"), "{:?}", group.failures);
    }

    #[test]
    fn a_scene_that_is_not_drawn_is_told() {
        let group = check(1, &|_| None);
        assert!(group.failures[0].ends_with(": not drawn"), "{:?}", group.failures);
    }
}
