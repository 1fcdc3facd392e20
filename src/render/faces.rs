//! Input for the faces of an object.

use super::lit::ShadedVertices;
use super::paint::SurfaceMaterial;
use super::vertex::{Geometry, VertexAttributes};
use crate::light::Lights;
use crate::scene::Shading;
use crate::span::Kernel;
use crate::view::ObjectView;

/// One object in one frame: what its faces are made from.
pub(super) struct Faces<'a> {
    pub(super) shading: Shading,
    pub(super) geometry: Geometry<'a>,
    pub(super) view: &'a ObjectView,
    pub(super) lights: Lights<'a>,
    /// One for each surface of the mesh.
    pub(super) paints: &'a [SurfaceMaterial],
    pub(super) lit: &'a ShadedVertices,
    /// The attributes of each vertex, if there are effects.
    pub(super) extras: &'a [VertexAttributes],
    /// True if back faces are left out.
    pub(super) culls: bool,
    /// A bit for each triangle that lies back to back with another, 64 in a word; empty if none does. As a back face it
    /// is left out even where others show their backs: the other one has the same depth, and looks toward the eye.
    pub(super) twins: &'a [u64],
    /// True if its shades run; otherwise each surface has one.
    pub(super) runs: bool,
    /// True if there are lamps or highlights.
    pub(super) full: bool,
    /// True if faces are lit, each on one channel or on three, and not vertices.
    pub(super) lit_by_face: bool,
    pub(super) channels: bool,
    /// True if texture coordinates are linear on the screen.
    pub(super) affine: bool,
    /// True if pixels may be lit each for itself.
    pub(super) lights_pixels: bool,
    /// Kernel for the light where a face is decided on.
    pub(super) kernel: Kernel,
}
