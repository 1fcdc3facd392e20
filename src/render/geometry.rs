//! Geometry of an object: its mesh, or the result of tessellation, as slices.

use glam::{Vec2, Vec3};

/// Geometry that is drawn for an object: its mesh, or the result of tessellation.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Geometry<'a> {
    pub(super) positions: &'a [Vec3],
    pub(super) normals: &'a [Vec3],
    pub(super) texcoords: Option<&'a [Vec2]>,
    pub(super) vertex_surfaces: &'a [u16],
    pub(super) triangles: &'a [[u32; 3]],
    pub(super) triangle_surfaces: &'a [u16],
    /// A bit for each triangle, set if it lies back to back with another, 64 in a word; empty if there are none. Such a
    /// triangle is culled as a back face even where others show their backs: its twin has the same depth, and faces the
    /// eye.
    pub(super) twins: &'a [u64],
}
