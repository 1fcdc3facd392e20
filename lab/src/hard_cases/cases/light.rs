//! Normals and light: N1, N2, N4 to N6.

use mode13h::Angle;
use mode13h::glam::Vec3;

use super::{EXACT, of_scene};
use crate::hard_cases::Comparison;
use crate::hard_cases::engine;
use crate::hard_cases::face::{gouraud, without_diagonals};
use crate::hard_cases::fault::light::{View, unit};
use crate::hard_cases::fault::{paint, side, wrapped};
use crate::hard_cases::panel::Measure;
use crate::truth::vector::{Vector, add, cross, dot, sub, wide};
use mode13h::light::{Light, Material};
use mode13h::mesh::{Mesh, shapes};
use mode13h::scene::{Camera, Object, Scene};

const SIZE: (usize, usize) = (28, 26);

/// Matt surfaces: the fault's own view and light agree with the engine's within this many shades.
const LIT: Measure = Measure { shades: 12, ..EXACT };

/// A white mesh without ambient light, seen by `view`.
pub(super) fn scene(mesh: Option<Mesh>, view: View) -> Scene {
    let mut scene = Scene::new();
    let eye = Vec3::from_array(view.eye.map(|c| c as f32));
    scene.camera = Camera {
        eye,
        target: eye - Vec3::Z,
        up: Vec3::Y,
        field_of_view: Angle::from_radians((view.field_of_view as f32).into()),
        near: 0.1,
    };
    if let Some(mesh) = mesh {
        let mut object = Object::new(mesh);
        object.materials = vec![Material { ambient: 0.0, diffuse: 1.0, ..Material::default() }];
        scene.add(object);
    }
    scene
}

/// Distance of the eye from the middle.
const DISTANCE: f64 = 4.0;

/// The input of a light case: a mesh, its lights, and the shades that the fault gives its vertices.
struct Lit {
    mesh: Option<Mesh>,
    /// The vertices' positions before the engine splits any vertices.
    positions: Vec<Vector>,
    triangles: Vec<[usize; 3]>,
    suns: Vec<Light>,
    shades: Vec<f64>,
    two_sided: bool,
}

impl Lit {
    /// Triangles under one sun.
    fn by_a_sun(positions: Vec<Vector>, triangles: Vec<[usize; 3]>, towards: Vector, shades: Vec<f64>) -> Self {
        let mesh = mesh(&positions, &triangles);
        Self { mesh, positions, triangles, suns: vec![sun(towards)], shades, two_sided: false }
    }
}

fn compare(lit: Lit) -> Comparison {
    let view = View { size: SIZE, eye: [0.0, 0.0, DISTANCE], field_of_view: 2.0 * libm::atan(1.08 / DISTANCE) };
    let mut scene = scene(lit.mesh, view);
    for sun in lit.suns {
        scene.add_light(sun);
    }
    let drawn = engine::draw_scene(SIZE, &scene);
    let measure = Measure { counts_writes: false, ..LIT };
    // The fault draws the faces turned toward the eye, or all.
    of_scene(drawn, measure, |panel| {
        for triangle in &lit.triangles {
            let [a, b, c] = triangle.map(|i| view.project(lit.positions[i], lit.shades[i]));
            // Counter-clockwise seen from outside, on a screen whose y runs down.
            if lit.two_sided || side(a, b, (c.x, c.y)) < 0.0 {
                paint(panel, &[gouraud([a, b, c])]);
            }
        }
    })
}

fn mesh(positions: &[Vector], triangles: &[[usize; 3]]) -> Option<Mesh> {
    let positions = positions.iter().map(|p| Vec3::from_array(p.map(|c| c as f32))).collect();
    Mesh::new(positions, triangles.iter().map(|t| t.map(|i| i as u32)).collect()).ok()
}

fn sun(towards: Vector) -> Light {
    Light::sun(towards.map(|c| c as f32))
}

/// The sum of the unit normals of each vertex's faces, not normalized.
fn sums(positions: &[Vector], triangles: &[[usize; 3]]) -> Vec<Vector> {
    let mut sums = vec![[0.0; 3]; positions.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| positions[i]);
        let normal = unit(cross(sub(a, b), sub(a, c)));
        for i in triangle {
            sums[*i] = add(sums[*i], normal);
        }
    }
    sums
}

pub(super) fn n1() -> Comparison {
    const RIM: usize = 8;
    let mut positions = vec![[0.0, 0.0, 0.7]];
    positions.extend((0..RIM).map(|i| {
        let (sin, cos) = libm::sincos(i as f64 * std::f64::consts::TAU / RIM as f64 + 0.2);
        [cos, sin, 0.0]
    }));
    let mut triangles: Vec<[usize; 3]> = (0..RIM).map(|i| [0, 1 + i, 1 + (i + 1) % RIM]).collect();
    // Repeats one corner, so it has no area.
    triangles.push([1, 1, 2]);
    let towards = unit([0.4, 0.5, 1.0]);
    // Comparisons with NaN are false, so it stays.
    let shades = sums(&positions, &triangles).into_iter().map(|sum| {
        let intensity = dot(unit(sum), towards);
        if intensity < 0.0 { 0.0 } else { intensity * 255.0 }
    });
    let shades = shades.collect();
    compare(Lit { two_sided: true, ..Lit::by_a_sun(positions, triangles, towards, shades) })
}

pub(super) fn n2() -> Comparison {
    // An open book: two leaves, each with a face on both sides.
    let positions = vec![
        [0.0, -0.8, -0.2],
        [0.0, 0.95, -0.2],
        [-1.0, -0.95, 0.35],
        [-1.0, 0.8, 0.35],
        [0.9, -0.95, 0.35],
        [0.9, 0.8, 0.35],
    ];
    let leaves = [[2, 0, 1], [2, 1, 3], [0, 4, 5], [0, 5, 1]];
    let triangles: Vec<[usize; 3]> = leaves.into_iter().chain(leaves.map(|[a, b, c]| [a, c, b])).collect();
    let towards = unit([-0.7, 0.3, 1.0]);
    let shades = sums(&positions, &triangles).into_iter().map(|sum| dot(sum, towards).max(0.0) * 255.0).collect();
    compare(Lit::by_a_sun(positions, triangles, towards, shades))
}

/// Compares a ball with the bytes that a fault gives its vertices from each vertex's normal.
fn ball(suns: Vec<Light>, shade: impl Fn(Vector) -> f64) -> Comparison {
    let mesh = shapes::sphere(24, 16);
    let shades = mesh.normals().iter().map(|normal| shade(wide(*normal))).collect();
    let positions = mesh.positions().iter().copied().map(wide).collect();
    let triangles = mesh.triangles().iter().map(|t| t.map(|i| i as usize)).collect();
    let mut comparison = compare(Lit { mesh: Some(mesh), positions, triangles, suns, shades, two_sided: false });
    comparison.outline = engine::silhouette(&comparison.outline);
    comparison
}

pub(super) fn n4() -> Comparison {
    let towards = unit([-0.8, 0.7, 0.25]);
    ball(vec![sun(towards)], |normal| f64::from(wrapped(dot(normal, towards) * 255.0)))
}

pub(super) fn n5() -> Comparison {
    const INTENSITY: f64 = 0.9;
    let lamps = [[-1.0, 0.3, 0.8], [1.0, 0.3, 0.8]].map(unit);
    let suns = lamps.map(|lamp| sun(lamp).with_intensity(INTENSITY as f32)).to_vec();
    ball(suns, |normal| {
        let bytes = lamps.map(|lamp| wrapped(dot(normal, lamp).max(0.0) * INTENSITY * 255.0));
        f64::from(bytes.into_iter().fold(0_u8, u8::wrapping_add))
    })
}

pub(super) fn n6() -> Comparison {
    // The corner (1, 1, 1) points toward the eye.
    let (right, up, front) = (unit([1.0, 0.0, -1.0]), unit([-1.0, 2.0, -1.0]), unit([1.0, 1.0, 1.0]));
    let turn = |p: Vector| [dot(right, p), dot(up, p), dot(front, p)];
    let mut grid: Vec<Vector> = Vec::new();
    let mut triangles = Vec::new();
    let mut vertex = |point: Vector| {
        grid.iter().position(|there| *there == point).unwrap_or_else(|| {
            grid.push(point);
            grid.len() - 1
        })
    };
    // Each face of the cube is split into 2 × 2 squares, which share corners with the adjacent faces.
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            for (u, v) in [(-1.0, -1.0), (0.0, -1.0), (-1.0, 0.0), (0.0, 0.0)] {
                let corner = |du: f64, dv: f64| {
                    let mut point = [0.0; 3];
                    point[axis] = side;
                    point[(axis + 1) % 3] = (u + du) * side;
                    point[(axis + 2) % 3] = v + dv;
                    point
                };
                let [a, b, c, d] =
                    [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)].map(&mut vertex);
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    let towards = unit([0.15, 0.25, 1.0]);
    // A grid point belongs to the faces of the axes on which it lies at ±1, so its own coordinates are the sum.
    let shades = grid.iter().map(|p| {
        let faces = p.iter().filter(|c| c.abs() == 1.0).count() as f64;
        (dot(turn(*p).map(|c| c / faces), towards)).max(0.0) * 255.0
    });
    let shades: Vec<f64> = shades.collect();
    // Points in the middle of an edge or a face have a 0 there, which adds nothing to the sum.
    let positions: Vec<Vector> = grid.iter().map(|p| turn(p.map(|c| c * 0.6))).collect();
    let mut comparison = compare(Lit::by_a_sun(positions, triangles, towards, shades));
    comparison.outline = without_diagonals(&comparison.outline);
    comparison
}
