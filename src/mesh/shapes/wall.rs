//! The wall.

use alloc::vec::Vec;

use glam::Vec3;

use super::{MOST, toward_zero};
use crate::mesh::Mesh;

/// A square in the plane z = 0 with its corners on the unit sphere, facing +z, cut into
/// `columns` × `rows` rectangles of two triangles each. At least 1 × 1.
#[must_use]
pub fn wall(columns: u32, rows: u32) -> Mesh {
    let (columns, rows) = (columns.clamp(1, MOST), rows.clamp(1, MOST));
    let half = libm::sqrt(0.5);
    let place = |i: u32, of: u32| toward_zero(half * (2.0 * f64::from(i) / f64::from(of) - 1.0));
    let mut positions = Vec::new();
    for row in 0..=rows {
        positions.extend((0..=columns).map(|column| Vec3::new(place(column, columns), place(row, rows), 0.0)));
    }
    let mut triangles = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let a = row * (columns + 1) + column;
            let d = a + columns + 1;
            triangles.push([a, a + 1, d + 1]);
            triangles.push([a, d + 1, d]);
        }
    }
    let normals = positions.iter().map(|_| Vec3::Z).collect();
    Mesh::assemble(positions, normals, triangles)
}
