//! Geometry beyond the screen and behind the eye: R7, C1, C2.

use mode13h::glam::Vec3;

use super::of_scene;
use super::{EXACT, light};
use crate::hard_cases::Comparison;
use crate::hard_cases::engine;
use crate::hard_cases::face::gouraud;
use crate::hard_cases::fault::light::View;
use crate::hard_cases::fault::{cover, paint};
use crate::hard_cases::panel::Measure;
use crate::truth::vector::Vector;
use mode13h::mesh::Mesh;
use mode13h::scene::Scene;

/// The near plane of these cases.
const NEAR: f64 = 0.5;

/// Clipped corners are rounded separately, so shades may differ by a few either way.
const CUT: Measure = Measure { shades: 4, ..EXACT };

/// A mesh whose vertices have these intensities when lit from above by [`light::scene`].
fn lit(positions: &[Vector], intensities: &[f64], triangles: &[[usize; 3]]) -> Option<Mesh> {
    // The light comes along y, so the normal leans away from it by the arc cosine.
    let normal = |i: &f64| Vec3::new(0.0, *i as f32, (1.0 - i * i).sqrt() as f32);
    let positions = positions.iter().map(|p| Vec3::from_array(p.map(|c| c as f32))).collect();
    let triangles = triangles.iter().map(|t| t.map(|i| i as u32)).collect();
    Mesh::with_normals(positions, intensities.iter().map(normal).collect(), triangles).ok()
}

fn scene(mesh: Option<Mesh>, view: View) -> Scene {
    let mut scene = light::scene(mesh, view);
    scene.camera.near = NEAR as f32;
    scene.add_light(mode13h::light::Light::sun([0.0, 1.0, 0.0]));
    scene
}

pub(super) fn r7() -> Comparison {
    let size = (30, 26);
    // One unit is one pixel at that distance.
    let view = View { size, eye: [0.0, 0.0, 26.0], field_of_view: 2.0 * libm::atan(0.5) };
    let positions = [[-11.3, 8.4, 0.0], [-60_000.0, -100_000.0, 0.0], [120_000.0, -30_000.0, 0.0]];
    let triangles = [[0, 1, 2]];
    let drawn = engine::draw_scene(size, &scene(lit(&positions, &[0.75; 3], &triangles), view));
    let corners = positions.map(|point| view.project(point, 0.75 * 255.0));
    let mut comparison = of_scene(drawn, CUT, |panel| paint(panel, &[gouraud(cover::words_of_16_bits(&corners))]));
    comparison.outline = gouraud(corners).edges().to_vec();
    comparison
}

/// A floor one unit below the eye, starting at `z[0]` (toward the eye), with a strip between each two values.
fn floor(z: &[f64]) -> (Vec<Vector>, Vec<[usize; 3]>, Vec<f64>) {
    let mut positions = Vec::new();
    let mut intensities = Vec::new();
    let mut triangles = Vec::new();
    for (i, z) in z.iter().enumerate() {
        positions.extend([[-2.2, -1.0, *z], [2.2, -1.0, *z]]);
        intensities.extend([if i % 2 == 0 { 0.9 } else { 0.35 }; 2]);
        if i > 0 {
            let (near, far) = (2 * i - 2, 2 * i);
            triangles.extend([[near, near + 1, far + 1], [near, far + 1, far]]);
        }
    }
    (positions, triangles, intensities)
}

/// A floor, of which the fault draws the triangles with three corners at distances that it keeps.
fn on_the_floor(z: &[f64], keeps: impl Fn(f64) -> bool) -> Comparison {
    let size = (30, 26);
    let view = View { size, eye: [0.0, 0.3, 0.0], field_of_view: 80_f64.to_radians() };
    let (positions, triangles, intensities) = floor(z);
    let drawn = engine::draw_scene(size, &scene(lit(&positions, &intensities, &triangles), view));
    let is_kept = |triangle: &&[usize; 3]| triangle.iter().all(|i| keeps(view.w(positions[*i])));
    of_scene(drawn, CUT, |panel| {
        for triangle in triangles.iter().filter(is_kept) {
            paint(panel, &[gouraud(triangle.map(|i| view.project(positions[i], intensities[i] * 255.0)))]);
        }
    })
}

pub(super) fn c1() -> Comparison {
    on_the_floor(&[2.5, -9.0], |_| true)
}

pub(super) fn c2() -> Comparison {
    on_the_floor(&[-NEAR + 0.1, -2.6, -4.2, -7.0, -12.0], |w| w >= NEAR)
}
