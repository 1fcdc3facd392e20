//! An object's vertices, lit and projected, in columns; and those that a frame adds by clipping or for curved shades.

use alloc::vec::Vec;

use super::geometry::Geometry;
use crate::fixed::U8F8;
use crate::raster::Vertex;
pub(super) use crate::raster::columns::ScreenPos;
use crate::raster::columns::{Columns, EffectColumns, LitColumn, Triangles};
use crate::raster::effects::Attributes;

/// Values of all vertices of an object. Those for effects exist only if the plan asks for them.
#[derive(Debug, Default)]
pub(super) struct VertexColumns {
    pub(super) at: Vec<ScreenPos>,
    /// 0 for vertices that need clipping.
    pub(super) depth: Vec<u32>,
    /// Front and back.
    pub(super) shade: Vec<[U8F8; 2]>,
    /// Texture coordinates in texels, 16.16.
    pub(super) texture: Vec<[i32; 2]>,
    /// Density of the fog.
    pub(super) fog: Vec<U8F8>,
    /// Red, green and blue, front and back.
    pub(super) channels: Vec<[[U8F8; 3]; 2]>,
    /// Column and row in a table of normals, for the front.
    pub(super) slope: Vec<[U8F8; 2]>,
}

impl VertexColumns {
    /// Makes room for `count` vertices with unspecified values. They must then be projected, and either lit or given
    /// the shade without light. Texture coordinates stay as they are.
    pub(super) fn begin(&mut self, count: usize) {
        self.at.resize(count, ScreenPos::NEEDS_CLIPPING);
        self.depth.resize(count, 0);
        self.shade.resize(count, [U8F8::default(); 2]);
        self.fog.clear();
        self.channels.clear();
        self.slope.clear();
    }

    /// The values, with the input of per-pixel lighting.
    #[inline]
    pub(super) fn columns<'a>(&'a self, lit: LitColumn<'a>) -> Columns<'a> {
        let Self { at, depth, shade, texture, fog, channels, slope } = self;
        Columns { at, depth, shade, effects: EffectColumns { texture, fog, channels, slope, lit } }
    }

    /// The triangles of an object's geometry.
    #[inline]
    pub(super) fn triangles<'a>(&'a self, geometry: &Geometry<'a>) -> Triangles<'a> {
        let lit = LitColumn::Points(geometry.normals, geometry.positions);
        Triangles { columns: self.columns(lit), indices: geometry.triangles, by_corner: None }
    }
}

/// Triangles whose vertices are not a mesh's: parts of clipped faces, faces with curved shades, and
/// those of the 16.16 path. Their values are for the visible side.
#[derive(Debug, Default)]
pub(super) struct AddedTriangles {
    vertices: VertexColumns,
    lit: Vec<[f32; 6]>,
    indices: Vec<[u32; 3]>,
    /// The face that each is part of.
    pub(super) faces: Vec<u32>,
    /// Numbers of vertices and triangles kept until the frame is drawn.
    kept: (usize, usize),
}

impl AddedTriangles {
    /// The number of added triangles at which the pending ones are drawn. The parts of one more face may exceed it.
    pub(super) const MAX_PENDING: usize = 64;
    /// The maximum number of corners, and of triangles, that one face adds: see `raster::clip`.
    pub(super) const MAX_OF_FACE: usize = 8;

    /// Allocates memory for as many triangles as may be pending.
    pub(super) fn make_room(&mut self) {
        let most = 3 * Self::MAX_PENDING + Self::MAX_OF_FACE;
        let (vertices, triangles) = (self.vertices.at.len(), self.indices.len());
        if self.vertices.at.capacity() < most {
            self.resize(vertices + most, triangles + most);
            self.resize(vertices, triangles);
        }
    }

    /// Removes the last vertices and triangles down to these numbers, or adds some up to them.
    fn resize(&mut self, vertices: usize, triangles: usize) {
        let VertexColumns { at, depth, shade, texture, fog, channels, slope } = &mut self.vertices;
        at.resize(vertices, ScreenPos::NEEDS_CLIPPING);
        depth.resize(vertices, 0);
        shade.resize(vertices, Default::default());
        texture.resize(vertices, Default::default());
        fog.resize(vertices, Default::default());
        channels.resize(vertices, Default::default());
        slope.resize(vertices, Default::default());
        self.lit.resize(vertices, Default::default());
        self.indices.resize(triangles, Default::default());
        self.faces.resize(triangles, 0);
    }

    /// Adds a vertex, and returns its index.
    pub(super) fn vertex(&mut self, vertex: &Vertex, attributes: &Attributes) -> u32 {
        let Self { vertices, lit, .. } = self;
        // Fewer than 2³²: there is no memory for that many.
        let index = vertices.at.len() as u32;
        vertices.at.push(ScreenPos::of(vertex));
        vertices.depth.push(vertex.depth());
        vertices.shade.push([vertex.shade(); 2]);
        vertices.texture.push(attributes.texture);
        vertices.fog.push(attributes.fog);
        vertices.channels.push([attributes.channels; 2]);
        vertices.slope.push(attributes.slope);
        lit.push(attributes.lit);
        index
    }

    /// Adds a triangle of added vertices, part of this face.
    pub(super) fn triangle(&mut self, corners: [u32; 3], face: u32) {
        self.indices.push(corners);
        self.faces.push(face);
    }

    /// Number of triangles.
    pub(super) fn len(&self) -> usize {
        self.indices.len()
    }

    /// The number of triangles added since others were kept or removed.
    pub(super) fn pending(&self) -> usize {
        self.indices.len() - self.kept.1
    }

    /// The triangles.
    pub(super) fn triangles(&self) -> Triangles<'_> {
        let columns = self.vertices.columns(LitColumn::Values(&self.lit));
        Triangles { columns, indices: &self.indices, by_corner: None }
    }

    /// Keeps all added triangles until the frame is drawn.
    pub(super) fn keep(&mut self) {
        self.kept = (self.vertices.at.len(), self.indices.len());
    }

    /// Removes the added triangles that are not kept.
    pub(super) fn drop_pending(&mut self) {
        let (vertices, triangles) = self.kept;
        self.resize(vertices, triangles);
    }

    /// Removes all added triangles.
    pub(super) fn clear(&mut self) {
        self.kept = (0, 0);
        self.drop_pending();
    }
}
