//! The cube.

use alloc::vec::Vec;

use glam::{Vec2, Vec3};

use super::toward_zero;
use crate::mesh::Mesh;

/// A cube with its corners on the unit sphere: edges of 2/√3, 24 vertices, 12 triangles. Every face has its own normal
/// and its own square of texture coordinates, 0 to 1. Textures stand upright on the four sides; on the top their upper
/// edge is at the back, and on the bottom at the front.
#[must_use]
pub fn cube() -> Mesh {
    let half = toward_zero(1.0 / libm::sqrt(3.0));
    let mut positions = Vec::with_capacity(24);
    let mut normals = Vec::with_capacity(24);
    let mut texcoords = Vec::with_capacity(24);
    let mut triangles = Vec::with_capacity(12);
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        for normal in [axis, -axis] {
            // right × up = normal.
            let right = Vec3::new(axis.z, axis.x, axis.y);
            let up = normal.cross(right);
            // The directions of u and v; again u × v = normal.
            let v = if normal.y == 0.0 { Vec3::Y } else { Vec3::new(0.0, 0.0, -normal.y) };
            let u = v.cross(normal);
            let first = positions.len() as u32;
            for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                let corner = normal + right * x + up * y;
                positions.push(corner * half);
                normals.push(normal);
                texcoords.push((Vec2::new(corner.dot(u), corner.dot(v)) + Vec2::ONE) / 2.0);
            }
            triangles.push([first, first + 1, first + 2]);
            triangles.push([first, first + 2, first + 3]);
        }
    }
    Mesh { texcoords: Some(texcoords), ..Mesh::assemble(positions, normals, triangles) }.with_facts()
}
