//! Normals: the normalized sum, weights, creases, and the hard cases N1, N2 and N6; what a mesh refuses; closed and
//! convex meshes against slow, exact oracles.

use std::f32::consts::PI;

use crate::support::tried::Tried;
use crate::support::vector::{self, wide};
use mode13h::Angle;
use mode13h::glam::{Vec2, Vec3};
use mode13h::light::Light;
use mode13h::mesh::normals::face_normal;
use mode13h::mesh::{Mesh, MeshError, Surface, Weight, shapes};
use mode13h::raster::Vertex;
use mode13h::render::{Renderer, Screen};
use mode13h::scene::{Camera, Object, Scene};
use mode13h::settings::VertexPath;
use num_rational::BigRational;
use num_traits::Zero;
use proptest::prelude::*;

const WEIGHTS: [Weight; 3] = [Weight::Count, Weight::Area, Weight::Angle];

/// A cube with eight vertices at ±1, each face split along the diagonal from its first corner.
fn box8() -> Mesh {
    let positions = (0..8).map(|i| Vec3::from_array([1, 2, 4].map(|bit| if i & bit == 0 { -1.0 } else { 1.0 })));
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh::new(positions.collect(), triangles).unwrap()
}

/// Rounding to f32 moves each component by at most 2⁻²⁵, so the length by 2⁻²⁴; N6 requires 2⁻¹⁴.
fn assert_unit(mesh: &Mesh) {
    assert_eq!(mesh.normals().len(), mesh.positions().len());
    for &normal in mesh.normals() {
        assert!((vector::length(wide(normal)) - 1.0).abs() < 1.0 / f64::from(1 << 23), "{normal}");
    }
}

#[test]
fn face_normal_points_at_who_sees_it_counter_clockwise() {
    let [a, b, c] = [Vec3::ZERO, Vec3::X, Vec3::Y];
    for [p, q, r] in [[a, b, c], [b, c, a], [c, a, b]] {
        assert_eq!(face_normal(p, q, r), Some(Vec3::Z));
        assert_eq!(face_normal(r, q, p), Some(Vec3::NEG_Z));
    }
}

/// The brightest shade, of 65,280, of a mesh's vertices under a sun from `towards`, which is also the view direction.
fn brightest(mesh: Mesh, towards: Vec3, path: VertexPath) -> u16 {
    let mut scene = Scene::new();
    let mut object = Object::new(mesh);
    (object.materials[0].ambient, object.materials[0].diffuse) = (0.0, 1.0);
    scene.add(object);
    scene.add_light(Light::sun(towards));
    // Not along any of the normals.
    scene.camera = Camera { eye: 6.0 * towards, up: Vec3::new(0.1, 1.0, 0.3), ..Camera::default() };
    let mut renderer = Renderer::new();
    renderer.settings.vertex_path = Some(path);
    let mut brightest = 0;
    let brighter = |vertices: &[Vertex; 3], _| {
        brightest = vertices.iter().map(|vertex| vertex.shade().to_bits()).fold(brightest, u16::max);
    };
    renderer.for_each_triangle(&scene, Screen::MODE_13H, brighter).expect("a legal scene");
    brightest
}

/// Slip 7: the Hungarian tutorial divides the sum by the count. At a cube's corner that leaves 0.58 of the light.
#[test]
fn n6_a_rounded_corner_is_as_bright_as_a_flat_one() {
    let mut tried = Tried::new("n6_a_rounded_corner_is_as_bright_as_a_flat_one", 2 * 3 * 8);
    let mean = (Vec3::X + Vec3::Y + Vec3::Z) / 3.0;
    assert!(mean.length() < 0.58);
    for path in [VertexPath::Float, VertexPath::Integer] {
        // A face that faces the sun.
        let flat = brightest(shapes::wall(1, 1), Vec3::Z, path);
        for weight in WEIGHTS {
            let mut mesh = box8();
            mesh.smooth(weight, None);
            assert_eq!(mesh.positions().len(), 8);
            assert_unit(&mesh);
            for &normal in mesh.normals() {
                let corner = brightest(mesh.clone(), normal, path);
                tried.worst("256ths of a shade darker", f64::from(flat.abs_diff(corner)));
                // On the float path 1 within 2⁻²² rounds to the same shade. On the other, normal and sun have 16
                // fraction bits: each length is off by less than 2⁻¹⁶, and half of 2⁻¹⁶ along each axis turns them
                // apart too little to matter; the product and the shade add one rounding each.
                let off = if path == VertexPath::Float { 0 } else { 3 };
                assert!(flat.abs_diff(corner) <= off, "{path}, {weight:?}, {normal}: {corner}, not {flat}");
                tried.add(1);
            }
        }
    }
}

/// At (1, 1, 1) each of the three faces has 90°, and at (−1, −1, −1) too, whatever the diagonals; weighted by count or
/// by area, a face that is split there counts twice.
#[test]
fn weights() {
    let mut mesh = box8();
    let corner = |mesh: &Mesh, i: usize| mesh.normals()[i] * 3f32.sqrt();
    mesh.smooth(Weight::Angle, None);
    for i in 0..8 {
        // Three roundings of 2⁻²⁴ and the product's.
        assert!(corner(&mesh, i).abs_diff_eq(mesh.positions()[i], 1e-6));
    }
    for weight in [Weight::Count, Weight::Area] {
        mesh.smooth(weight, None);
        // Vertex 1 is a first corner only in the face x = 1: (2, −1, −1) / √6.
        assert!(mesh.normals()[1].abs_diff_eq(Vec3::new(2.0, -1.0, -1.0) / 6f32.sqrt(), 1e-6));
    }
    // Two faces that share the edge x = 0, one with three times the area.
    let positions = vec![Vec3::ZERO, Vec3::Y, Vec3::X * 3.0, Vec3::Z];
    let mut mesh = Mesh::new(positions, vec![[0, 2, 1], [0, 1, 3]]).unwrap();
    mesh.smooth(Weight::Area, None);
    assert!(mesh.normals()[0].abs_diff_eq(Vec3::new(1.0, 0.0, 3.0) / 10f32.sqrt(), 1e-6));
    mesh.smooth(Weight::Count, None);
    assert!(mesh.normals()[0].abs_diff_eq(Vec3::new(1.0, 0.0, 1.0) / 2f32.sqrt(), 1e-6));
}

#[test]
fn crease_angle_splits_vertices() {
    let mut mesh = box8();
    // A cube's faces meet at 90°; the halves of one at 0°.
    mesh.smooth(Weight::Angle, Some(Angle::from_degrees(45.0)));
    assert_eq!(mesh.positions().len(), 24);
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|i| mesh.positions()[i as usize]);
        for &i in triangle {
            assert_eq!(mesh.normals()[i as usize], face_normal(a, b, c).unwrap());
        }
    }
    assert!(mesh.is_closed() && mesh.is_convex());
    // Split vertices count as one position: smooth again.
    mesh.smooth(Weight::Angle, Some(Angle::from_degrees(90.0)));
    assert_eq!(mesh.positions().len(), 24);
    assert!(mesh.normals().iter().zip(mesh.positions()).all(|(n, p)| (*n * 3f32.sqrt()).abs_diff_eq(*p, 1e-6)));

    let mut flat = box8();
    flat.flat();
    assert_eq!(flat.positions().len(), 24);
    assert_unit(&flat);
}

#[test]
fn a_crease_is_smooth_on_either_side() {
    // An eight-sided cylinder: 45° between sides, 90° to the caps.
    let mut mesh = shapes::cylinder(8, 1);
    mesh.smooth(Weight::Angle, Some(Angle::from_degrees(60.0)));
    let sides = mesh.normals().iter().filter(|n| n.y.abs() < 1e-6).count();
    let caps = mesh.normals().iter().filter(|n| n.y.abs() == 1.0).count();
    assert!(sides >= 16 && caps >= 18 && sides + caps == mesh.normals().len());
}

#[test]
fn texture_coordinates_follow_split_vertices() {
    let corners = box8();
    let texcoords: Vec<Vec2> = (0..8).map(|i| Vec2::splat(i as f32)).collect();
    let mut mesh = corners.clone().with_texcoords(texcoords).unwrap();
    mesh.flat();
    for (p, t) in mesh.positions().iter().zip(mesh.texcoords().unwrap()) {
        assert_eq!(*p, corners.positions()[t.x as usize]);
    }
}

#[test]
fn n1_faces_without_area_have_no_weight() {
    let mut tried = Tried::new("n1_faces_without_area_have_no_weight", 3 * 3 + 2);
    let positions = vec![
        Vec3::ZERO,
        Vec3::X,
        Vec3::Y,
        Vec3::ONE * 7.0,
        // On the line from vertex 0 to vertex 1, whose thirds f32 cannot represent.
        Vec3::X / 3.0,
    ];
    let triangles = vec![[0, 1, 2], [0, 0, 0], [0, 3, 3], [1, 2, 1], [0, 4, 1], [1, 4, 0]];
    let mesh = Mesh::new(positions, triangles).unwrap();
    for weight in WEIGHTS {
        for crease in [None, Some(0.0), Some(1.0)] {
            let mut mesh = mesh.clone();
            mesh.smooth(weight, crease.map(Angle::from_radians));
            assert_unit(&mesh);
            assert_eq!(mesh.positions().len(), 5);
            assert!(mesh.normals()[..3].iter().all(|&n| n == Vec3::Z), "{weight:?} {crease:?}");
            tried.add(1);
        }
    }
    let mut only = Mesh::new(vec![Vec3::ONE; 3], vec![[0, 1, 2]]).unwrap();
    assert_unit(&only);
    tried.add(1);
    only.flat();
    assert_unit(&only);
    tried.add(1);
}

#[test]
fn n2_normals_that_cancel_leave_each_face_its_own() {
    let mut tried = Tried::new("n2_normals_that_cancel_leave_each_face_its_own", 3 * 2 + 6);
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let mut sheet = Mesh::new(positions, vec![[0, 1, 2], [0, 2, 1]]).unwrap();
    for weight in WEIGHTS {
        sheet.smooth(weight, None);
        assert_eq!(sheet.positions().len(), 6);
        for (triangle, normal) in sheet.triangles().iter().zip([Vec3::Z, Vec3::NEG_Z]) {
            assert!(triangle.iter().all(|&i| sheet.normals()[i as usize] == normal));
            tried.add(1);
        }
    }
    assert!(sheet.is_closed() && !sheet.is_convex());
    // Six faces around a point, in three opposite pairs.
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let one_way = [[0, 1, 2], [0, 2, 3], [0, 3, 1]];
    let triangles = one_way.iter().flat_map(|&[a, b, c]| [[a, b, c], [a, c, b]]).collect();
    let mesh = Mesh::new(positions, triangles).unwrap();
    assert_unit(&mesh);
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|i| mesh.positions()[i as usize]);
        assert!(triangle.iter().all(|&i| mesh.normals()[i as usize] == face_normal(a, b, c).unwrap()));
        tried.add(1);
    }
}

/// Powers of two change no digit, so the normals are identical to the last bit.
#[test]
fn normals_do_not_depend_on_size() {
    let cube = box8();
    for exponent in -149..=127 {
        // 2^exponent, in two steps as 2⁻¹⁴⁹ alone is a denormal.
        let factor = |x: f32| if x < 0.0 { -(2f64.powi(exponent) as f32) } else { 2f64.powi(exponent) as f32 };
        let positions = cube.positions().iter().map(|p| Vec3::from_array(p.to_array().map(factor))).collect();
        let mut mesh = Mesh::new(positions, cube.triangles().to_vec()).unwrap();
        for weight in WEIGHTS {
            let mut unit = cube.clone();
            unit.smooth(weight, None);
            mesh.smooth(weight, None);
            assert_eq!(mesh.normals(), unit.normals(), "2^{exponent} {weight:?}");
        }
        assert!(mesh.is_convex(), "2^{exponent}");
    }
    let far = cube.positions().iter().map(|p| *p * f32::MAX).collect();
    let mesh = Mesh::new(far, cube.triangles().to_vec()).unwrap();
    assert_unit(&mesh);
    assert!(mesh.is_convex());
    let bounds = mesh.bounds();
    assert_eq!((bounds.min, bounds.max, bounds.centre), (Vec3::MIN, Vec3::MAX, Vec3::ZERO));
    assert_eq!(bounds.radius, f32::MAX);
}

#[test]
fn bounds_hold_what_is_used_and_nothing_else() {
    let positions = vec![Vec3::ZERO, Vec3::X * 2.0, Vec3::Y, Vec3::ONE * 100.0];
    let bounds = Mesh::new(positions, vec![[0, 1, 2]]).unwrap().bounds();
    assert_eq!((bounds.min, bounds.max), (Vec3::ZERO, Vec3::new(2.0, 1.0, 0.0)));
    assert_eq!(bounds.centre, Vec3::new(1.0, 0.5, 0.0));
    let radius = 1.25f64.sqrt();
    // Rounded up, to the next f32.
    assert!(f64::from(bounds.radius) >= radius && f64::from(bounds.radius.next_down()) < radius);
}

#[test]
fn r9_what_is_not_finite_is_refused() {
    let mut tried = Tried::new("r9_what_is_not_finite_is_refused", 3 * (3 * 2 + 1));
    let good = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let face = vec![[0, 1, 2]];
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for axis in 0..3 {
            let mut list = good.to_vec();
            list[1][axis] = bad;
            assert_eq!(Mesh::new(list, face.clone()), Err(MeshError::PositionNotFinite { vertex: 1 }));
            tried.add(1);
            let mut list = [Vec3::Z; 3];
            list[1][axis] = bad;
            let refused = Mesh::with_normals(good.to_vec(), list.to_vec(), face.clone());
            assert_eq!(refused, Err(MeshError::NormalNotFinite { vertex: 1 }));
            tried.add(1);
        }
        let mesh = Mesh::new(good.to_vec(), face.clone()).unwrap();
        let refused = mesh.with_texcoords(vec![Vec2::ZERO, Vec2::ZERO, Vec2::new(0.0, bad)]);
        assert_eq!(refused, Err(MeshError::TexcoordNotFinite { vertex: 2 }));
        tried.add(1);
    }
}

#[test]
fn broken_meshes_are_refused() {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let mesh = Mesh::new(positions.clone(), vec![[0, 1, 2]]).unwrap();
    assert_eq!(Mesh::new(positions.clone(), vec![]), Err(MeshError::NoTriangles));
    assert_eq!(Mesh::new(vec![], vec![]), Err(MeshError::NoTriangles));
    let refused = Mesh::new(positions.clone(), vec![[0, 1, 2], [0, 3, 1]]);
    assert_eq!(refused, Err(MeshError::IndexOutOfRange { triangle: 1 }));
    assert_eq!(refused.unwrap_err().to_string(), "triangle 1 refers to a vertex that does not exist");
    let zero = Mesh::with_normals(positions.clone(), vec![Vec3::Z, Vec3::ZERO, Vec3::Z], vec![[0, 1, 2]]);
    assert_eq!(zero, Err(MeshError::NormalZero { vertex: 1 }));
    let few = Mesh::with_normals(positions, vec![Vec3::Z], vec![[0, 1, 2]]);
    assert_eq!(few, Err(MeshError::Count { what: "normals", given: 1, needed: 3 }));
    let few = mesh.clone().with_texcoords(vec![]);
    assert_eq!(few, Err(MeshError::Count { what: "texture coordinates", given: 0, needed: 3 }));
    let surfaces = vec![Surface::default(); 2];
    assert!(mesh.clone().with_surfaces(surfaces.clone(), vec![1]).is_ok());
    assert_eq!(
        mesh.clone().with_surfaces(surfaces.clone(), vec![2]),
        Err(MeshError::SurfaceOutOfRange { triangle: 0 })
    );
    assert!(mesh.with_surfaces(surfaces, vec![]).is_err());
}

#[test]
fn given_normals_are_made_unit() {
    let normals = vec![Vec3::Z * f32::MAX, Vec3::Z * f32::from_bits(1), Vec3::new(3e38, 3e38, 3e38)];
    let mesh = Mesh::with_normals(vec![Vec3::ZERO, Vec3::X, Vec3::Y], normals, vec![[0, 1, 2]]).unwrap();
    assert_unit(&mesh);
    assert_eq!(mesh.normals()[..2], [Vec3::Z; 2]);
}

#[test]
fn closed_needs_each_edge_as_often_each_way() {
    let cube = box8();
    let with = |change: fn(&mut Vec<[u32; 3]>)| {
        let mut triangles = cube.triangles().to_vec();
        change(&mut triangles);
        Mesh::new(cube.positions().to_vec(), triangles).unwrap()
    };
    assert!(cube.is_closed() && cube.is_convex() && cube.volume() == 8.0);
    assert!(!with(|t| t.truncate(11)).is_closed());
    assert!(!with(|t| t[3].swap(0, 1)).is_closed());
    // All faces twice, so each edge twice each way. And two of them the other way as well.
    let twice = with(|t| t.extend_from_within(..));
    assert!(twice.is_closed() && twice.is_outward() && !twice.is_convex());
    let thrice = with(|t| t.extend([[t[0][0], t[0][2], t[0][1]], t[0]]));
    assert!(thrice.is_closed() && thrice.is_outward() && !thrice.is_convex());
    assert_eq!((0..14).filter(|&t| thrice.has_twin(t)).collect::<Vec<_>>(), [0, 12, 13]);
    assert!(!with(|t| t.push([t[0][0], t[0][2], t[0][1]])).is_closed());
    // A degenerate face changes nothing.
    assert!(with(|t| t.push([0, 0, 1])).is_convex());
    // Inside out: closed, but its faces point inward.
    let inside_out = with(|t| t.iter_mut().for_each(|t| t.swap(0, 1)));
    assert!(inside_out.is_closed() && !inside_out.is_outward() && !inside_out.is_convex());
    assert!(inside_out.volume() == -8.0);
}

/// All edges of a double pyramid over a pentagram are convex, but it winds around its axis twice.
#[test]
fn a_star_wound_twice_is_not_convex() {
    let mut positions = vec![Vec3::Y, Vec3::NEG_Y];
    positions.extend((0..5).map(|i| {
        let angle = 4.0 * PI * i as f32 / 5.0;
        Vec3::new(angle.cos(), 0.0, -angle.sin())
    }));
    let ring = |i: u32| 2 + i % 5;
    let triangles = (0..5).flat_map(|i| [[ring(i), ring(i + 1), 0], [ring(i + 1), ring(i), 1]]).collect();
    let star = Mesh::new(positions, triangles).unwrap();
    assert!(star.is_closed() && !star.is_convex());
}

#[test]
fn two_bodies_are_not_convex() {
    let cube = box8();
    let mut positions = cube.positions().to_vec();
    positions.extend(cube.positions().iter().map(|p| *p * 2.0));
    let mut triangles = cube.triangles().to_vec();
    triangles.extend(cube.triangles().iter().map(|t| t.map(|i| i + 8)));
    let both = Mesh::new(positions, triangles).unwrap();
    assert!(both.is_closed() && !both.is_convex());
}

fn exact(p: Vec3) -> [BigRational; 3] {
    p.to_array().map(|c| BigRational::from_float(c).unwrap())
}

/// Returns whether no vertex is in front of any face, in rationals.
fn all_behind(mesh: &Mesh) -> bool {
    let points: Vec<_> = mesh.positions().iter().map(|&p| exact(p)).collect();
    mesh.triangles().iter().all(|t| {
        let [a, b, c] = t.map(|i| &points[i as usize]);
        let sub = |p: &[BigRational; 3], q: &[BigRational; 3]| [0, 1, 2].map(|i| &p[i] - &q[i]);
        let (u, v) = (sub(b, a), sub(c, a));
        let normal = [&u[1] * &v[2] - &u[2] * &v[1], &u[2] * &v[0] - &u[0] * &v[2], &u[0] * &v[1] - &u[1] * &v[0]];
        points.iter().all(|p| {
            let w = sub(p, a);
            &normal[0] * &w[0] + &normal[1] * &w[1] + &normal[2] * &w[2] <= BigRational::zero()
        })
    })
}

/// By the definition, vertex by vertex: all faces at the same position, in f64. `None` if they cancel, which N2 tests
/// separately.
fn naive_normal(mesh: &Mesh, vertex: usize, weight: Weight) -> Option<[f64; 3]> {
    let here = mesh.positions()[vertex];
    let mut sum = [0.0; 3];
    let mut total = 0.0;
    for triangle in mesh.triangles() {
        let p = triangle.map(|i| mesh.positions()[i as usize]);
        for i in 0..3 {
            if p[i] != here {
                continue;
            }
            let [u, v] = [1, 2].map(|next| vector::sub(wide(p[(i + next) % 3]), wide(here)));
            let n = vector::cross(u, v);
            let area = vector::length(n);
            let sine: f64 = area / (vector::length(u) * vector::length(v));
            let cosine = vector::dot(u, v) / (vector::length(u) * vector::length(v));
            let factor = match weight {
                Weight::Count => 1.0,
                Weight::Area => area,
                Weight::Angle => sine.atan2(cosine),
            };
            (0..3).for_each(|k| sum[k] += n[k] / area * factor);
            total += factor;
        }
    }
    let norm = vector::length(sum);
    (norm > total / f64::from(1 << 19)).then(|| sum.map(|c| c / norm))
}

proptest! {
    /// A coarse sphere with each vertex displaced slightly, so that about half of them stay convex; the step is coarse
    /// enough that faces are often exactly coplanar.
    #[test]
    fn convex_is_what_the_exact_oracle_says(
        moves in prop::collection::vec(prop::array::uniform3(-3i8..=3), 26),
        step in prop::sample::select(vec![0.0f32, 0.5, 0.02, 0.03]),
    ) {
        let sphere = shapes::sphere(6, 5);
        let moved = |(p, m): (&Vec3, &[i8; 3])| {
            let p = if step == 0.5 { (*p * 4.0).round() / 4.0 } else { *p };
            p + Vec3::from_array(m.map(f32::from)) * step * 0.25
        };
        let positions: Vec<Vec3> = sphere.positions().iter().zip(&moves).map(moved).collect();
        let mesh = Mesh::new(positions, sphere.triangles().to_vec()).unwrap();
        // True must be right; false may be cautious only if a face has no area.
        let solid = mesh.triangles().iter().all(|t| {
            let [a, b, c] = t.map(|i| mesh.positions()[i as usize]);
            face_normal(a, b, c).is_some()
        });
        if mesh.is_convex() || solid {
            prop_assert_eq!(mesh.is_convex(), all_behind(&mesh) && mesh.volume() > 0.0);
        }
    }

    /// 2⁻²³: rounding each component to f32 by 2⁻²⁵, and the sums' rounding, which is far smaller.
    #[test]
    fn smooth_is_what_the_naive_oracle_says(
        positions in prop::collection::vec(prop::array::uniform3(-1000.0f32..1000.0), 4..20),
        picks in prop::collection::vec(prop::array::uniform3(any::<prop::sample::Index>()), 1..40),
    ) {
        let positions: Vec<Vec3> = positions.into_iter().map(Vec3::from_array).collect();
        let triangles = picks
            .iter()
            .map(|t| t.map(|i| i.index(positions.len()) as u32))
            .filter(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
            .collect();
        let Ok(mut mesh) = Mesh::new(positions, triangles) else { return Ok(()) };
        for weight in WEIGHTS {
            mesh.smooth(weight, None);
            let used: std::collections::HashSet<u32> = mesh.triangles().iter().flatten().copied().collect();
            for vertex in used {
                let Some(expected) = naive_normal(&mesh, vertex as usize, weight) else { continue };
                for (found, expected) in mesh.normals()[vertex as usize].to_array().into_iter().zip(expected) {
                    prop_assert!((f64::from(found) - expected).abs() < 1.0 / f64::from(1 << 23), "{weight:?}");
                }
            }
        }
    }
}
