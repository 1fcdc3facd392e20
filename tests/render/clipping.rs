//! What the camera sees when geometry extends behind it or beyond the guard band.

mod far;

use crate::floor::{HEIGHT, WIDTH, counts_by, scene};
use crate::integer_frames::distance as from_segment;
use crate::near_plane::{corners_about_the_near_plane, floors_are_closed, the_visible_part_is_hit};
use crate::support::odd_views::odd_views;
use crate::support::scenes::triangles_by;
use crate::support::tried::Tried;
use crate::support::vector::{cross, dot};
use mode13h::glam::Vec3;
use mode13h::light::Light;
use mode13h::mesh::{Mesh, shapes};
use mode13h::raster::{Frame, Vertex};
use mode13h::render::Renderer;
use mode13h::settings::{HiddenSurfaces, VertexPath};
use mode13h::vga::Vga;
use mode13h_conformance::Random;
use num_rational::BigRational;
use num_traits::ToPrimitive;

#[test]
fn r7_a_floor_of_any_size_is_closed_to_the_horizon() {
    let tried = Tried::new("r7_a_floor_of_any_size_is_closed_to_the_horizon", 36);
    let reaches = [1e4, 1e6, 1e12, 1e20, 1e30, f32::MAX / 2.0];
    floors_are_closed(tried, VertexPath::Float, &reaches, &[1, 2, 3, 5, 8, 13]);
}

#[test]
fn r7_faces_up_to_the_greatest_number() {
    far::faces_up_to_the_greatest_number(Tried::new("r7_faces_up_to_the_greatest_number", 80_000));
}

#[test]
fn r7_floors_up_to_the_greatest_number() {
    far::floors_up_to_the_greatest_number(Tried::new("r7_floors_up_to_the_greatest_number", 20_000));
}

/// Two faces that fill the picture share an edge through all of it. The edge begins in the last half pixel before the
/// guard band's limit, which is reserved for rounding: one face is drawn unclipped, the other, whose third corner lies
/// beyond the limit, is clipped. If it were clipped at the edge too, its edge would differ.
#[test]
fn r7_a_corner_within_rounding_of_the_limit() {
    let mut tried = Tried::new("r7_a_corner_within_rounding_of_the_limit", 1000);
    let mut random = Random::named("r7 limit");
    let fy = 100.0 / f64::tan(0.5);
    let fx = fy * 6.0 / 5.0;
    let mut clipped = [0_u64; 2];
    while tried.more() {
        // Along x or along y, with the corner at either end.
        let (across, turned) = (random.within(0, 1) == 0, random.within(0, 1) == 0);
        let point = |random: &mut Random, along: f64, other: f64| {
            let (along, other) = if turned { (-along, -other) } else { (along, other) };
            let (x, y) = if across { (along, other) } else { (other, along) };
            let depth = 0.5 + random.unit() * 4.0;
            Vec3::new(((x - 160.0) / fx * depth) as f32, (-(y - 100.0) / fy * depth) as f32, -depth as f32)
        };
        let (from, to) = (4095.75 + random.unit() * 0.25, -1000.0 - random.unit() * 3000.0);
        let mut across_at = || random.unit() * 400.0 - 200.0;
        let (p_at, q_at) = (across_at(), across_at());
        let (p, q) = (point(&mut random, from, p_at), point(&mut random, to, q_at));
        let (r, s) = (point(&mut random, 160.0, -4000.0), point(&mut random, 160.0, 6000.0));
        let mesh = Mesh::new(vec![p, q, r, s], vec![[0, 1, 2], [1, 0, 3]]).expect("a mesh");
        for (path, clipped) in VertexPath::ALL.into_iter().zip(&mut clipped) {
            let mut renderer = Renderer::new();
            renderer.settings.vertex_path = Some(path);
            let (counts, stats) = counts_by(&mut renderer, &scene(mesh.clone()));
            *clipped += u64::from(stats.clipped == 1);
            let holes = counts.iter().filter(|&&times| times == 0).count();
            let doubles = counts.iter().filter(|&&times| times > 1).count();
            tried.worst("holes", holes as f64);
            tried.worst("double pixels", doubles as f64);
            assert_eq!((holes, doubles), (0, 0), "{path}: {p} {q} {r} {s}");
        }
    }
    assert!(clipped.iter().all(|&clipped| clipped > 700), "one face is clipped, the other is not: {clipped:?}");
}

/// A wall that extends beyond the frame on all sides covers every pixel, including the last column and row of the
/// largest frame.
#[test]
fn r7_a_wall_fills_frames_of_every_size() {
    let sizes =
        (0..=12).flat_map(|bit| [(1 << bit) - 1, 1 << bit, (1 << bit) + 1]).filter(|size| (1..=4096).contains(size));
    let shapes = sizes.flat_map(|size: u32| [(size, 3), (3, size)]).collect::<Vec<_>>();
    let mut tried = Tried::new("r7_a_wall_fills_frames_of_every_size", 72 * 2 * 4);
    let mut scene = scene(shapes::wall(1, 1));
    scene.objects_mut()[0].position = Vec3::new(0.0, 0.0, -1.0);
    scene.objects_mut()[0].scale = 8192.0;
    scene.background = 255;
    for (width, height) in shapes {
        for path in VertexPath::ALL {
            for method in HiddenSurfaces::ALL {
                let mut renderer = Renderer::new();
                (renderer.settings.vertex_path, renderer.settings.hidden_surfaces) = (Some(path), Some(method));
                let mut pixels = vec![0; (width * height) as usize];
                let frame = Frame::new(&mut pixels, width, height, width as usize).expect("a frame");
                renderer.draw_frame(&scene, frame, (1, 1)).expect("a legal scene");
                let bare = pixels.iter().filter(|pixel| **pixel == 255).count();
                assert_eq!(bare, 0, "{width} × {height}, {path}, {method}");
                tried.add(1);
            }
        }
    }
    tried.done();
}

/// There is no far plane: every method shows a wall at a hundred thousand million times the near distance.
#[test]
fn c3_what_is_very_far_is_drawn() {
    let mut tried = Tried::new("c3_what_is_very_far_is_drawn", 4);
    for way in HiddenSurfaces::ALL {
        let mut scene = scene(shapes::wall(2, 2));
        scene.objects_mut()[0].position.z = -2.5e10;
        scene.objects_mut()[0].scale = 1e10;
        scene.add_light(Light::sun([0.0, 0.0, 1.0]));
        let mut renderer = Renderer::new();
        renderer.settings.hidden_surfaces = Some(way);
        let lit = crate::support::scenes::frame_by(&mut renderer, &scene).0.iter().filter(|&&byte| byte != 0).count();
        assert!(lit > 5000, "{way}: {lit} pixels");
        tried.add(1);
    }
}

#[test]
fn c1_corners_behind_the_eye_on_the_near_plane_at_w_0() {
    let tried = Tried::new("c1_corners_behind_the_eye_on_the_near_plane_at_w_0", 4000);
    corners_about_the_near_plane(tried, VertexPath::Float);
}

#[test]
#[ignore = "the long run: a million faces through the near plane"]
fn c1_long_a_million_faces_through_the_near_plane() {
    let tried = Tried::new("c1_long_a_million_faces_through_the_near_plane", 1_000_000);
    corners_about_the_near_plane(tried, VertexPath::Float);
}

#[test]
fn c1_the_visible_part_is_what_a_ray_hits() {
    the_visible_part_is_hit(Tried::new("c1_the_visible_part_is_what_a_ray_hits", 300), VertexPath::Float);
}

#[test]
fn c4_odd_views_are_quiet() {
    odd_views(Tried::new("c4_odd_views_are_quiet", 500), VertexPath::Float);
}

type Line = [(BigRational, BigRational); 2];

/// The edges of the polygon that these triangles form: those that belong to only one of them, as (from, to) in 1/256
/// pixel.
fn outline(parts: &[[Vertex; 3]]) -> Vec<[(i32, i32); 2]> {
    let at = |v: &Vertex| (v.x().to_bits(), v.y().to_bits());
    let edges: Vec<[(i32, i32); 2]> =
        parts.iter().flat_map(|p| [0, 1, 2].map(|i| [at(&p[i]), at(&p[(i + 1) % 3])])).collect();
    edges.iter().copied().filter(|&[a, b]| !edges.contains(&[b, a])).collect()
}

/// The part of a segment on the screen, in pixels; `None` if there is none.
fn on_screen([a, b]: [(i32, i32); 2]) -> Option<[(f64, f64); 2]> {
    let pixels = |(x, y): (i32, i32)| (f64::from(x) / 256.0, f64::from(y) / 256.0);
    let (a, b) = (pixels(a), pixels(b));
    let (mut t0, mut t1) = (0.0_f64, 1.0_f64);
    for (p, q) in
        [(a.0 - b.0, a.0), (b.0 - a.0, WIDTH as f64 - a.0), (a.1 - b.1, a.1), (b.1 - a.1, HEIGHT as f64 - a.1)]
    {
        // Inside where p·t ≤ q.
        if p == 0.0 && q < 0.0 {
            return None;
        } else if p < 0.0 {
            t0 = t0.max(q / p);
        } else if p > 0.0 {
            t1 = t1.min(q / p);
        }
    }
    let point = |t: f64| (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t);
    (t0 < t1).then(|| [point(t0), point(t1)])
}

/// Distance of a point from a line, in pixels. The product is exact; only its root and the quotient are rounded.
fn distance((x, y): (f64, f64), [a, b]: &Line) -> f64 {
    let exact = |x: f64| BigRational::from_float(x).expect("finite");
    let (dx, dy) = (&b.0 - &a.0, &b.1 - &a.1);
    let product = &dx * (exact(y) - &a.1) - &dy * (exact(x) - &a.0);
    let squared = &product * &product / (&dx * &dx + &dy * &dy);
    squared.to_f64().expect("a distance").sqrt()
}

#[test]
fn r7_edges_of_far_triangles_are_where_they_belong() {
    edges_of_far_triangles(Tried::new("r7_edges_of_far_triangles_are_where_they_belong", 1000));
}

#[test]
#[ignore = "the long run: 50,000 far triangles"]
fn r7_long_edges_of_far_triangles() {
    edges_of_far_triangles(Tried::new("r7_long_edges_of_far_triangles", 50_000));
}

/// For corners up to 2⁴⁰ pixels away the edges on the screen lie within 1/128 pixel of the exact ones.
/// Each end of a drawn edge is off by at most half of 1/256 in x and in y, 0.0028 pixel; a corner's
/// f32 coordinates turn the edge by 2⁻²³, 0.0005 over 4,096 pixels.
fn edges_of_far_triangles(mut tried: Tried) {
    let mut random = Random::named("r7 edges");
    // What the engine computes from the field of view: tan in f64 is within an ulp of this.
    let fy = 100.0 / f64::tan(f64::from(1.0_f32) / 2.0);
    let fx = fy * 6.0 / 5.0;
    let mut edges = 0_u32;
    while tried.more() {
        let mut corner = || {
            let depth = (0.3 + random.unit() * 4.0) as f32;
            let mut away = |focal: f64| {
                let pixels = f64::powf(2.0, random.unit() * 40.0) * if random.within(0, 1) == 0 { 1.0 } else { -1.0 };
                (pixels * f64::from(depth) / focal) as f32
            };
            Vec3::new(away(fx), away(fy), -depth)
        };
        let corners = [corner(), corner(), corner()];
        let exact = |x: f64| BigRational::from_float(x).expect("finite");
        let projected: [(BigRational, BigRational); 3] = corners.map(|p| {
            let w = exact(f64::from(-p.z));
            let x = exact(fx) * exact(f64::from(p.x)) / &w + exact(160.0);
            let y = exact(-fy) * exact(f64::from(p.y)) / &w + exact(100.0);
            (x, y)
        });
        let lines: [Line; 3] = [0, 1, 2].map(|i| [projected[i].clone(), projected[(i + 1) % 3].clone()]);
        let mesh = Mesh::new(corners.to_vec(), vec![[0, 1, 2]]).expect("a mesh");
        let parts = triangles_by(&mut Renderer::new(), &scene(mesh));
        for ends in outline(&parts).into_iter().filter_map(on_screen) {
            // One of the three lines is near both ends.
            let off = lines.iter().map(|line| distance(ends[0], line).max(distance(ends[1], line)));
            let nearest = off.fold(f64::INFINITY, f64::min);
            tried.worst("pixels off", nearest);
            assert!(nearest <= 1.0 / 128.0, "{nearest} pixels off: {corners:?}");
            edges += 1;
        }
    }
    assert!(edges > 300, "edges were on the screen: {edges}");
}

/// Distance of a point from the nearest of these segments, in pixels.
fn nearest(edges: &[[(i32, i32); 2]], at: (f64, f64)) -> f64 {
    let pixels = |(x, y): (i32, i32)| (f64::from(x) / 256.0, f64::from(y) / 256.0);
    edges.iter().fold(f64::INFINITY, |least, &[a, b]| least.min(from_segment(at, pixels(a), pixels(b))))
}

/// A corner passes slowly through the near plane, and nothing pops. The truth here is the shade linear along the face
/// in space, at the point where the pixel's ray hits it.
#[test]
fn c2_a_corner_passing_through_the_near_plane() {
    let mut tried = Tried::new("c2_a_corner_passing_through_the_near_plane", 1000);
    let fy = 100.0 / f64::tan(0.5);
    let fx = fy * 6.0 / 5.0;
    let still = [[-0.9, -0.6, -2.0], [0.8, -0.9, -2.5]];
    let normals = [Vec3::new(0.0, 0.6, 0.8), Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.0, -0.6, 0.8)];
    let mut before: Option<Step> = None;
    let mut compared = 0_u64;
    for step in 0..=1000 {
        let moving = [0.1, 0.15, -0.75 + 0.001 * f64::from(step)];
        let corners = [still[0], still[1], moving];
        let narrow = |p: [f64; 3]| Vec3::new(p[0] as f32, p[1] as f32, p[2] as f32);
        let mesh = Mesh::with_normals(corners.map(narrow).to_vec(), normals.to_vec(), vec![[0, 1, 2]]);
        let mut scene = scene(mesh.expect("a mesh"));
        scene.add_light(Light::sun([0.0, 0.3, 1.0]));
        let mut vga = Vga::new();
        let mut renderer = Renderer::new();
        renderer.draw(&scene, &mut vga).expect("a legal scene");
        let parts = triangles_by(&mut renderer, &scene);
        // The light at the corners: ka·Ia + kd·n·l.
        let material = &scene.objects()[0].materials[0];
        let shades = normals.map(|normal| {
            // Toward the sun: (0, 0.3, 1).
            let [x, y, z] = normal.to_array().map(f64::from);
            let length = (x * x + y * y + z * z).sqrt() * (0.3_f64.powi(2) + 1.0).sqrt();
            let cosine = (0.3 * y + z) / length;
            let ambient = f64::from(material.ambient) * f64::from(scene.ambient);
            255.0 * (ambient + f64::from(material.diffuse) * cosine.max(0.0)).clamp(0.0, 1.0)
        });
        for part in &parts {
            // At the unclipped corners the engine has these, to the rounding of a shade.
            let drawn = part.each_ref().map(|v: &Vertex| f64::from(v.shade().to_bits()) / 256.0);
            let (low, high) = shades.iter().fold((255.0, 0.0), |(low, high), &s| (s.min(low), s.max(high)));
            assert!(drawn.iter().all(|shade| (low - 0.01..=high + 0.01).contains(shade)), "{drawn:?} of {shades:?}");
        }
        let truth = |x: f64, y: f64| {
            let ray = [(x - 160.0) / fx, -(y - 100.0) / fy, -1.0];
            let [a, b, c] = corners;
            let weights = [dot(ray, cross(b, c)), dot(ray, cross(c, a)), dot(ray, cross(a, b))];
            dot(weights, shades) / (weights[0] + weights[1] + weights[2])
        };
        let truth = (0..WIDTH * HEIGHT).map(|i| truth((i % WIDTH) as f64 + 0.5, (i / WIDTH) as f64 + 0.5)).collect();
        let now = Step { bytes: vga.pixels().to_vec(), edges: outline(&parts), truth };
        if let Some(before) = &before {
            compared += now.compare(before, step);
            tried.add(1);
        }
        before = Some(now);
    }
    assert!(compared > 1_000_000, "{compared} pixels compared");
}

struct Step {
    bytes: Vec<u8>,
    edges: Vec<[(i32, i32); 2]>,
    truth: Vec<f64>,
}

impl Step {
    /// How far apart the outlines are: the largest distance from points along each to the other.
    fn movement(&self, other: &Self) -> f64 {
        let reach = |from: &Self, to: &Self| {
            let mut farthest = 0.0_f64;
            for [a, b] in from.edges.iter().filter_map(|&edge| on_screen(edge)) {
                for i in 0..=64 {
                    let t = f64::from(i) / 64.0;
                    farthest = farthest.max(nearest(&to.edges, (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t)));
                }
            }
            farthest
        };
        reach(self, other).max(reach(other, self))
    }

    /// Pixels away from all edges change by at most one shade more than the truth does there.
    fn compare(&self, before: &Self, step: i32) -> u64 {
        let margin = self.movement(before) + 1.0;
        let mut compared = 0;
        for i in 0..WIDTH * HEIGHT {
            let change = f64::from(self.bytes[i].abs_diff(before.bytes[i]));
            if self.bytes[i] == 0 && before.bytes[i] == 0 {
                continue;
            }
            compared += 1;
            // The cheap bound first: a change of one shade is always allowed.
            if change <= 1.0 || change <= (self.truth[i] - before.truth[i]).abs() + 1.0 {
                continue;
            }
            let centre = ((i % WIDTH) as f64 + 0.5, (i / WIDTH) as f64 + 0.5);
            let edge = nearest(&self.edges, centre).min(nearest(&before.edges, centre));
            assert!(
                edge <= margin,
                "step {step}: {centre:?} changed by {change}, {edge} pixels from an edge, margin {margin}"
            );
        }
        compared
    }
}
