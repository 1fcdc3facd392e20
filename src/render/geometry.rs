//! Geometry of an object: its mesh, or the result of tessellation, as slices.

use glam::{Vec2, Vec3};

/// Geometry that is drawn for an object: its mesh, or the result of tessellation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Geometry<'a> {
    pub(super) positions: &'a [Vec3],
    pub(super) normals: &'a [Vec3],
    pub(super) texcoords: Option<&'a [Vec2]>,
    pub(super) vertex_surfaces: &'a [u16],
    pub(super) triangles: &'a [[u32; 3]],
    pub(super) triangle_surfaces: &'a [u16],
}
