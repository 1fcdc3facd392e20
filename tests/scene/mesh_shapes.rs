//! The shapes: sizes, windings, normals, closed or not, convex or not, volumes.

use std::collections::HashMap;
use std::f64::consts::PI;

use crate::support::tried::Tried;
use crate::support::vector::{self, wide};
use mode13h::glam::Vec3;
use mode13h::mesh::normals::face_normal;
use mode13h::mesh::{Mesh, shapes};

fn all() -> impl Iterator<Item = (&'static str, Mesh)> {
    shapes::NAMES.into_iter().map(|name| (name, shapes::by_name(name).unwrap()))
}

#[test]
fn names_and_sizes() {
    let sizes: Vec<_> = all().map(|(name, mesh)| (name, mesh.positions().len(), mesh.triangles().len())).collect();
    assert_eq!(
        sizes,
        [
            ("cube", 24, 12),
            ("sphere", 2 + 48 * 23, 2 * 48 * 23),
            ("torus", 48 * 24, 2 * 48 * 24),
            // Rings, apexes, cap.
            ("cone", 48 * 8 + 48 + 49, 48 * 16),
            ("cylinder", 48 * 9 + 2 * 49, 48 * 18),
            ("wall", 17 * 17, 2 * 16 * 16),
            ("teapot", 2082, 64 * 64 - 64),
        ]
    );
    assert!(shapes::by_name("Cube").is_none());
}

#[test]
fn small_numbers_are_raised() {
    assert_eq!(shapes::sphere(0, 0), shapes::sphere(3, 2));
    assert_eq!(shapes::torus(0, 2), shapes::torus(3, 3));
    assert_eq!(shapes::cone(1, 0), shapes::cone(3, 1));
    assert_eq!(shapes::cylinder(2, 0), shapes::cylinder(3, 1));
    assert_eq!(shapes::wall(0, 0), shapes::wall(1, 1));
    assert_eq!(shapes::teapot(0), shapes::teapot(2));
}

/// Every coordinate is rounded toward zero, so the tolerance is only the test's own f64 rounding.
#[test]
fn all_fit_the_unit_sphere_and_touch_it() {
    for (name, mesh) in all() {
        let farthest = mesh.positions().iter().map(|&p| vector::length(wide(p))).fold(0.0, f64::max);
        assert!(farthest <= 1.0 + 1e-15, "{name}: {farthest}");
        assert!(farthest > 0.999, "{name}: {farthest}");
    }
}

/// Rounding to f32 moves each component by at most 2⁻²⁵.
#[test]
fn n6_normals_are_unit() {
    let mut tried = Tried::new("n6_normals_are_unit", 5_664);
    for (name, mesh) in all() {
        for &normal in mesh.normals() {
            let off = (vector::length(wide(normal)) - 1.0).abs();
            tried.worst("off from length 1", off);
            assert!(off < 1.0 / f64::from(1 << 23), "{name}: {normal}");
            tried.add(1);
        }
    }
}

#[test]
fn normals_look_out_of_their_faces() {
    for (name, mesh) in all() {
        for triangle in mesh.triangles() {
            let [a, b, c] = triangle.map(|i| mesh.positions()[i as usize]);
            let face = face_normal(a, b, c).unwrap_or_else(|| panic!("{name}: {triangle:?} has no area"));
            for i in *triangle {
                let normal = mesh.normals()[i as usize];
                assert!(face.dot(normal) > 0.0, "{name}: face {face}, normal {normal} at {a}");
            }
        }
    }
}

#[test]
fn normals_are_those_of_the_surface() {
    let close = |a: Vec3, b: Vec3| assert!(a.distance(b) < 1e-6, "{a} {b}");
    let sphere = shapes::sphere(20, 10);
    for (&p, &n) in sphere.positions().iter().zip(sphere.normals()) {
        close(p, n);
    }
    let torus = shapes::torus(20, 10);
    for (&p, &n) in torus.positions().iter().zip(torus.normals()) {
        let ring = p.with_z(0.0).normalize() * 0.7;
        close((p - ring) / 0.3, n);
    }
    // The cone's normal is perpendicular to the line to the apex.
    let cone = shapes::cone(20, 4);
    for (&p, &n) in cone.positions().iter().zip(cone.normals()).filter(|(_, n)| n.y > 0.0) {
        assert!((Vec3::Y - p).dot(n).abs() < 1e-4, "{p} {n}");
    }
}

#[test]
fn closed_and_convex() {
    let found: Vec<_> = all().map(|(name, mesh)| (name, mesh.is_closed(), mesh.is_convex())).collect();
    assert_eq!(
        found,
        [
            ("cube", true, true),
            ("sphere", true, true),
            ("torus", true, false),
            ("cone", true, true),
            ("cylinder", true, true),
            ("wall", false, false),
            ("teapot", false, false),
        ]
    );
    for slices in 3..80 {
        for stacks in [1, 2, 3, 7, 24, 50] {
            assert!(shapes::sphere(slices, stacks).is_convex(), "sphere({slices}, {stacks})");
            assert!(shapes::cone(slices, stacks).is_convex(), "cone({slices}, {stacks})");
            assert!(shapes::cylinder(slices, stacks).is_convex(), "cylinder({slices}, {stacks})");
            let torus = shapes::torus(slices, stacks);
            assert!(torus.is_closed() && !torus.is_convex(), "torus({slices}, {stacks})");
        }
    }
}

/// The exact volumes of the polyhedra, not of the smooth shapes. Each coordinate is rounded by less than 2⁻²³ (the
/// cone's base by 2⁻¹⁵), which moves the surface, whose area is below 4π, by no more than √3 times that.
#[test]
fn volumes() {
    /// Area of a regular polygon with its corners on the unit circle.
    fn polygon(corners: u32) -> f64 {
        f64::from(corners) / 2.0 * (2.0 * PI / f64::from(corners)).sin()
    }
    let fine = 4.0 * PI * 3f64.sqrt() / f64::from(1 << 23);
    let coarse = 4.0 * PI * 3f64.sqrt() / f64::from(1 << 15);
    let near = |mesh: Mesh, volume: f64, allowed: f64| {
        assert!((mesh.volume() - volume).abs() < allowed, "{} {volume}", mesh.volume());
    };
    near(shapes::cube(), (2.0 / 3f64.sqrt()).powi(3), fine);
    for (slices, stacks) in [(3, 2), (7, 5), (48, 24)] {
        // A frustum of a pyramid between two rings.
        let ring = |stack: u32| (PI * f64::from(stack) / f64::from(stacks)).sin_cos();
        let frusta = (0..stacks).map(|stack| {
            let ((r, z), (s, y)) = (ring(stack), ring(stack + 1));
            (z - y) * (r * r + r * s + s * s) / 3.0
        });
        near(shapes::sphere(slices, stacks), polygon(slices) * frusta.sum::<f64>(), fine);
        near(shapes::cylinder(slices, stacks), polygon(slices) * 0.5 * 2f64.sqrt(), fine);
        near(shapes::cone(slices, stacks), polygon(slices) * 0.75 * 1.5 / 3.0, coarse);
    }
    for (u, v) in [(3, 3), (7, 5), (48, 24)] {
        // Between two meridians: ∫∫ 2r·sin(α/2)·cos(α/2) dr dz = sin α · area · 0.7, α = 2π/u.
        let volume = 2.0 * polygon(u) * polygon(v) * 0.09 * 0.7;
        near(shapes::torus(u, v), volume, fine);
    }
}

#[test]
fn wall_faces_the_viewer() {
    let wall = shapes::wall(3, 2);
    assert!(wall.normals().iter().all(|&n| n == Vec3::Z));
    let area: f32 = wall
        .triangles()
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|i| wall.positions()[i as usize]);
            (b - a).cross(c - a).z / 2.0
        })
        .sum();
    assert!((area - 2.0).abs() < 1e-5);
}

/// 32 patches of 2n² triangles, minus n at each of the 8 patches that end in a pole.
#[test]
fn teapot_patches() {
    for n in 2..12 {
        let teapot = shapes::teapot(n);
        assert_eq!(teapot.triangles().len(), (32 * 2 * n * n - 8 * n) as usize);
        assert!(teapot.normals().iter().all(|n| n.is_normalized()));
    }
}

#[test]
fn teapot_proportions() {
    let bounds = shapes::teapot(16).bounds();
    let size = bounds.max - bounds.min;
    // From the handle at −3 to the spout's tip at 3.434; 2 to each side; 3.15 high.
    assert!((size.x / size.y - 6.434 / 3.15).abs() < 1e-3, "{size}");
    assert!((size.z / size.y - 4.0 / 3.15).abs() < 1e-6, "{size}");
}

/// The poles, where one derivative vanishes: straight up on the knob, straight down below.
#[test]
fn teapot_poles() {
    let teapot = shapes::teapot(8);
    let at = |y: f32| {
        let poles = teapot.positions().iter().zip(teapot.normals());
        poles.filter(|(p, _)| p.y == y && p.z == 0.0).map(|(_, &n)| n).collect::<Vec<_>>()
    };
    assert_eq!(at(teapot.bounds().max.y), [Vec3::Y]);
    assert_eq!(at(teapot.bounds().min.y), [Vec3::NEG_Y]);
}

/// Patches meet without gaps: edges with only one face occur only at the real openings, which are the rim, the lid's
/// edge, and both ends of handle and spout.
#[test]
fn teapot_has_no_cracks() {
    for n in [2, 5, 8] {
        let teapot = shapes::teapot(n);
        let point = |i: u32| (teapot.positions()[i as usize] + 0.0).to_array().map(f32::to_bits);
        let mut edges: HashMap<_, i32> = HashMap::new();
        for &[a, b, c] in teapot.triangles() {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((point(from), point(to))).or_default() += 1;
            }
        }
        let open = edges.keys().filter(|&&(from, to)| !edges.contains_key(&(to, from))).count();
        assert_eq!(open as u32, 4 * n + 4 * n + 2 * (2 * n) + 2 * (2 * n));
        assert!(edges.values().all(|&count| count == 1));
    }
}

#[test]
fn textures_lie_upright_and_the_right_way_round() {
    for (name, mesh) in all() {
        let Some(texcoords) = mesh.texcoords() else {
            assert!(!matches!(name, "cube" | "wall"), "{name}");
            continue;
        };
        for triangle in mesh.triangles() {
            let [a, b, c] = triangle.map(|i| mesh.positions()[i as usize]);
            let [ta, tb, tc] = triangle.map(|i| texcoords[i as usize]);
            // Counter-clockwise on the picture as on the face, so nothing is mirrored.
            assert!((tb - ta).perp_dot(tc - ta) > 0.0, "{name}: {triangle:?}");
            let normal = face_normal(a, b, c).expect("it has an area");
            for (i, p) in [(0, a), (1, b), (2, c)] {
                let t = [ta, tb, tc][i];
                assert!(t.min_element() >= 0.0 && t.max_element() <= 1.0, "{name}: {t}");
                // On upright faces v runs up.
                if normal.y == 0.0 {
                    let (low, high) = (mesh.bounds().min.y, mesh.bounds().max.y);
                    assert!(((p.y - low) / (high - low) - t.y).abs() < 1e-6, "{name}: {p} {t}");
                }
            }
        }
    }
}

#[test]
fn stretched_meshes_keep_their_normals_upright_on_their_faces() {
    for (name, mesh) in all() {
        for factors in [Vec3::ONE, Vec3::new(2.0, 0.25, 8.0), Vec3::new(1.0, 3.3, 0.1)] {
            let stretched = mesh.stretched(factors).expect("legal factors");
            assert_eq!(stretched.triangles(), mesh.triangles());
            assert_eq!(stretched.texcoords(), mesh.texcoords());
            assert_eq!(stretched.is_closed(), mesh.is_closed());
            // Scaling by powers of two rounds nothing.
            if factors.y != 3.3 {
                assert_eq!(stretched.is_convex(), mesh.is_convex(), "{name}");
            }
            for (i, (&p, &normal)) in stretched.positions().iter().zip(stretched.normals()).enumerate() {
                assert_eq!(p, mesh.positions()[i] * factors);
                // A plane n·p = c becomes n/f · f·p = c, so the direction is n/f. Here it is computed in f64, there
                // with components rounded by at most 2⁻²⁵, before and after normalizing.
                let wide = |v: Vec3| v.to_array().map(f64::from);
                let (given, factors) = (wide(mesh.normals()[i]), wide(factors));
                let expected = [0, 1, 2].map(|i| given[i] / factors[i]);
                let size = expected.iter().map(|c| c * c).sum::<f64>().sqrt();
                let off =
                    [0, 1, 2].map(|i| (wide(normal)[i] - expected[i] / size).abs()).into_iter().fold(0.0, f64::max);
                assert!(off < 1.0 / f64::from(1 << 22), "{name}: {normal}, off by {off}");
            }
        }
    }
    let cube = shapes::cube();
    assert_eq!(cube.stretched(Vec3::ONE), Ok(cube.clone()));
    for factors in [Vec3::ZERO, Vec3::NEG_ONE, Vec3::NAN, Vec3::INFINITY, Vec3::new(1.0, 0.0, 1.0)] {
        assert!(cube.stretched(factors).is_err(), "{factors}");
    }
    let great = cube.stretched(Vec3::splat(1e38)).expect("it fits");
    assert!(great.stretched(Vec3::splat(1e38)).is_err(), "beyond f32");
}
