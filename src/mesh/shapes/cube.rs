//! The cube.

use alloc::vec::Vec;

use glam::Vec3;

use super::toward_zero;
use crate::mesh::Mesh;

/// A cube with its corners on the unit sphere: edges of 2/√3, 24 vertices, 12 triangles, every face
/// with its own normal.
#[must_use]
pub fn cube() -> Mesh {
    let half = toward_zero(1.0 / libm::sqrt(3.0));
    let mut positions = Vec::with_capacity(24);
    let mut normals = Vec::with_capacity(24);
    let mut triangles = Vec::with_capacity(12);
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        for normal in [axis, -axis] {
            // right × up = normal.
            let right = Vec3::new(axis.z, axis.x, axis.y);
            let up = normal.cross(right);
            let first = positions.len() as u32;
            for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                positions.push((normal + right * x + up * y) * half);
                normals.push(normal);
            }
            triangles.push([first, first + 1, first + 2]);
            triangles.push([first, first + 2, first + 3]);
        }
    }
    Mesh::assemble(positions, normals, triangles)
}
