//! The wall.

use alloc::vec::Vec;

use glam::{Vec2, Vec3};

use super::{MAX_PARTS, grid, toward_zero};
use crate::mesh::Mesh;

/// A square in the plane z = 0 with its corners on the unit sphere, facing +z, cut into `columns` × `rows` rectangles
/// of two triangles each, at least 1 × 1. Texture coordinates run from (0, 0) in the lower left corner to (1, 1).
#[must_use]
pub fn wall(columns: u32, rows: u32) -> Mesh {
    let (columns, rows) = (columns.clamp(1, MAX_PARTS), rows.clamp(1, MAX_PARTS));
    let half = libm::sqrt(0.5);
    let coordinate = |i: u32, of: u32| toward_zero(half * (2.0 * f64::from(i) / f64::from(of) - 1.0));
    // Both at most 4,096: exact.
    let part = |i: u32, of: u32| i as f32 / of as f32;
    let mut positions = Vec::new();
    let mut texcoords = Vec::new();
    for row in 0..=rows {
        texcoords.extend((0..=columns).map(|column| Vec2::new(part(column, columns), part(row, rows))));
        positions
            .extend((0..=columns).map(|column| Vec3::new(coordinate(column, columns), coordinate(row, rows), 0.0)));
    }
    let normals = positions.iter().map(|_| Vec3::Z).collect();
    Mesh { texcoords: Some(texcoords), ..Mesh::assemble(positions, normals, grid(columns, rows, 0).collect()) }
        .with_facts()
}
