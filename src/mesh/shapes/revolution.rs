//! Sphere, torus, cone and cylinder.

use alloc::vec::Vec;

use glam::Vec3;

use super::{MAX_PARTS, quad, toward_zero};
use crate::mesh::Mesh;
use crate::mesh::wide::narrow;

/// The cosine and the sine of `i` / `of` turns.
fn turn(i: f64, of: u32) -> (f64, f64) {
    let angle = 2.0 * core::f64::consts::PI * i / f64::from(of);
    (libm::cos(angle), libm::sin(angle))
}

/// A point about the y axis: slices follow each other counter-clockwise seen from +y.
fn around_y(radius: f64, y: f64, (cos, sin): (f64, f64)) -> Vec3 {
    Vec3::new(toward_zero(radius * cos), toward_zero(y), toward_zero(-radius * sin))
}

/// Adds the band of quads between two rings of `slices` vertices each, given by their first
/// vertices; it wraps around.
fn band(positions: &[Vec3], slices: u32, lower: u32, upper: u32, triangles: &mut Vec<[u32; 3]>) {
    for i in 0..slices {
        let next = (i + 1) % slices;
        triangles.extend(quad(positions, [lower + i, lower + next, upper + next, upper + i]));
    }
}

/// A sphere of radius 1, cut like a globe: `slices` around (at least 3), `stacks` from pole to pole (at least 2). It
/// has 2 · slices · (stacks − 1) triangles.
#[must_use]
pub fn sphere(slices: u32, stacks: u32) -> Mesh {
    let (slices, stacks) = (slices.clamp(3, MAX_PARTS), stacks.clamp(2, MAX_PARTS));
    // From the south pole up.
    let mut positions = alloc::vec![Vec3::NEG_Y];
    let mut normals = alloc::vec![Vec3::NEG_Y];
    for stack in 1..stacks {
        let (height, radius) = turn(f64::from(stacks - stack), 2 * stacks);
        for slice in 0..slices {
            let (cos, sin) = turn(f64::from(slice), slices);
            positions.push(around_y(radius, height, (cos, sin)));
            normals.push(narrow([radius * cos, height, -radius * sin]));
        }
    }
    positions.push(Vec3::Y);
    normals.push(Vec3::Y);

    let ring = |stack: u32| 1 + (stack - 1) * slices;
    let (last, north) = (ring(stacks - 1), ring(stacks));
    let mut triangles: Vec<_> = (0..slices).map(|i| [0, ring(1) + (i + 1) % slices, ring(1) + i]).collect();
    for stack in 1..stacks - 1 {
        band(&positions, slices, ring(stack), ring(stack + 1), &mut triangles);
    }
    triangles.extend((0..slices).map(|i| [last + i, last + (i + 1) % slices, north]));
    Mesh::assemble(positions, normals, triangles)
}

/// A torus about the z axis: a tube of radius 0.3 around a circle of radius 0.7, with `u` quads around the axis and `v`
/// around the tube (at least 3 each). It has 2 · u · v triangles.
#[must_use]
pub fn torus(u: u32, v: u32) -> Mesh {
    const RING: f64 = 0.7;
    const TUBE: f64 = 0.3;
    let (u, v) = (u.clamp(3, MAX_PARTS), v.clamp(3, MAX_PARTS));
    let mut positions = Vec::new();
    let mut normals = Vec::new();
    for i in 0..u {
        let (cos_u, sin_u) = turn(f64::from(i), u);
        for j in 0..v {
            let (cos_v, sin_v) = turn(f64::from(j), v);
            let radius = RING + TUBE * cos_v;
            let position = [radius * cos_u, radius * sin_u, TUBE * sin_v];
            positions.push(Vec3::from_array(position.map(toward_zero)));
            normals.push(narrow([cos_v * cos_u, cos_v * sin_u, sin_v]));
        }
    }
    let mut triangles = Vec::new();
    for i in 0..u {
        let (this, next) = (i * v, (i + 1) % u * v);
        for j in 0..v {
            let up = (j + 1) % v;
            triangles.extend(quad(&positions, [this + j, next + j, next + up, this + up]));
        }
    }
    Mesh::assemble(positions, normals, triangles)
}

/// A cone with its apex at (0, 1, 0) and a base disc of radius √¾ at y = −½, so that base and apex lie on the unit
/// sphere: `slices` around (at least 3), `stacks` from base to apex (at least 1, at most 256). It has slices · 2 ·
/// stacks triangles.
///
/// At the apex each slice has a vertex of its own, with the normal at the slice's middle.
#[must_use]
pub fn cone(slices: u32, stacks: u32) -> Mesh {
    let (slices, stacks) = (slices.clamp(3, MAX_PARTS), stacks.clamp(1, 256));
    let radius = libm::sqrt(0.75);
    // The unit normal's outward and upward components: the side falls by 3/2 over √¾.
    let (out, up) = (libm::sqrt(0.75), 0.5);
    let side_normal = |(cos, sin): (f64, f64)| narrow([out * cos, up, -out * sin]);

    let mut positions = Vec::new();
    let mut normals = Vec::new();
    for stack in 0..stacks {
        // In 256ths, and the base in 2¹⁵ths, so that their product has 23 bits and fits an f32 exactly: the vertices
        // along a slice's side lie exactly on one line, and those of a quad exactly in one plane.
        let part = f64::from((stacks - stack) * 256 / stacks) / 256.0;
        for slice in 0..slices {
            let direction = turn(f64::from(slice), slices);
            let base = |x: f64| libm::trunc(radius * x * 32_768.0) / 32_768.0;
            let position = [base(direction.0) * part, 1.0 - 1.5 * part, -base(direction.1) * part];
            positions.push(narrow(position));
            normals.push(side_normal(direction));
        }
    }
    let apex = positions.len() as u32;
    for slice in 0..slices {
        positions.push(Vec3::Y);
        normals.push(side_normal(turn(f64::from(slice) + 0.5, slices)));
    }

    let mut triangles = Vec::new();
    for stack in 0..stacks - 1 {
        band(&positions, slices, stack * slices, (stack + 1) * slices, &mut triangles);
    }
    let last = (stacks - 1) * slices;
    triangles.extend((0..slices).map(|i| [last + i, last + (i + 1) % slices, apex + i]));
    cap(&mut positions, &mut normals, &mut triangles, slices, 0, Vec3::NEG_Y);
    Mesh::assemble(positions, normals, triangles)
}

/// A cylinder of radius √½ from y = −√½ to √½, so that its rims lie on the unit sphere: `slices` around (at least 3),
/// `stacks` from bottom to top (at least 1). It has slices · 2 · (stacks + 1) triangles.
#[must_use]
pub fn cylinder(slices: u32, stacks: u32) -> Mesh {
    let (slices, stacks) = (slices.clamp(3, MAX_PARTS), stacks.clamp(1, MAX_PARTS));
    let half = libm::sqrt(0.5);
    let mut positions = Vec::new();
    let mut normals = Vec::new();
    for stack in 0..=stacks {
        let y = half * (2.0 * f64::from(stack) / f64::from(stacks) - 1.0);
        for slice in 0..slices {
            let (cos, sin) = turn(f64::from(slice), slices);
            positions.push(around_y(half, y, (cos, sin)));
            normals.push(narrow([cos, 0.0, -sin]));
        }
    }
    let mut triangles = Vec::new();
    for stack in 0..stacks {
        band(&positions, slices, stack * slices, (stack + 1) * slices, &mut triangles);
    }
    cap(&mut positions, &mut normals, &mut triangles, slices, 0, Vec3::NEG_Y);
    cap(&mut positions, &mut normals, &mut triangles, slices, stacks * slices, Vec3::Y);
    Mesh::assemble(positions, normals, triangles)
}

/// Closes a ring with a disc about the y axis that faces `normal`, up or down.
fn cap(
    positions: &mut Vec<Vec3>,
    normals: &mut Vec<Vec3>,
    triangles: &mut Vec<[u32; 3]>,
    slices: u32,
    ring: u32,
    normal: Vec3,
) {
    let first = positions.len() as u32;
    let centre = first + slices;
    for i in 0..slices {
        positions.push(positions[(ring + i) as usize]);
        normals.push(normal);
    }
    positions.push(Vec3::new(0.0, positions[ring as usize].y, 0.0));
    normals.push(normal);
    triangles.extend((0..slices).map(|i| {
        let (this, next) = (first + i, first + (i + 1) % slices);
        if normal.y > 0.0 { [centre, this, next] } else { [centre, next, this] }
    }));
}
