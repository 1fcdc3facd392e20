//! Faces with effects, by vertices: a door to the columns.

use alloc::vec::Vec;

use super::{Attributes, EffectScratch, PixelPipeline};
use crate::fixed::U8F8;
use crate::lanes::LANES;
use crate::raster::columns::{Columns, EffectColumns, LitColumn, Picks, ScreenPos, Triangles};
use crate::raster::cull::{PickList, cull, pick};
use crate::raster::depth::Cell;
use crate::raster::draw_stats::DrawStats;
use crate::raster::pick::CHUNK;
use crate::raster::triangle::Raster;
use crate::raster::vertex::Vertex;

/// Faces that are drawn by one pixel pipeline. Filled and drawn again and again it allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct EffectBatch {
    indices: Vec<[u32; 3]>,
    at: Vec<ScreenPos>,
    depth: Vec<u32>,
    shade: Vec<[U8F8; 2]>,
    texture: Vec<[i32; 2]>,
    fog: Vec<U8F8>,
    channels: Vec<[[U8F8; 3]; 2]>,
    slope: Vec<[U8F8; 2]>,
    lit: Vec<[f32; 6]>,
    scratch: EffectScratch,
}

impl EffectBatch {
    /// Faces that it holds at most.
    pub const CAPACITY: usize = CHUNK;

    /// A batch without faces. When it is drawn for the first time it takes 100 kB.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns whether the batch holds no face.
    #[must_use]
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.indices.is_empty()
    }

    /// Returns whether the batch has no room for another face.
    #[must_use]
    #[inline]
    pub fn is_full(&self) -> bool {
        self.indices.len() >= Self::CAPACITY
    }

    /// Adds a face. The order of the corners and their winding make no difference; a face without area draws nothing.
    /// Returns `false`, and adds nothing, if there is no room.
    #[inline]
    pub fn push(&mut self, vertices: &[Vertex; 3], attributes: &[Attributes; 3]) -> bool {
        if self.is_full() {
            return false;
        }
        // At most 192 corners.
        let first = self.at.len() as u32;
        for (vertex, of) in vertices.iter().zip(attributes) {
            self.at.push(ScreenPos::of(vertex));
            self.depth.push(vertex.depth());
            self.shade.push([vertex.shade(); 2]);
            self.texture.push(of.texture);
            self.fog.push(of.fog);
            self.channels.push([of.channels; 2]);
            self.slope.push(of.slope);
            self.lit.push(of.lit);
        }
        self.indices.push([first, first + 1, first + 2]);
        true
    }

    /// Takes all faces out.
    fn clear(&mut self) {
        let Self { indices, at, depth, shade, texture, fog, channels, slope, lit, scratch: _ } = self;
        indices.clear();
        at.clear();
        depth.clear();
        shade.clear();
        texture.clear();
        fog.clear();
        channels.clear();
        slope.clear();
        lit.clear();
    }
}

impl<D: Cell> Raster<'_, D> {
    internal! {
    /// Draws a triangle with effects. The order of the corners and their winding make no difference; a
    /// triangle without area draws nothing. Many triangles are drawn sooner by
    /// [`batch_with_effects`](Self::batch_with_effects), by which this is drawn, too.
    fn triangle_with_effects(
        &mut self,
        vertices: &[Vertex; 3],
        attributes: &[Attributes; 3],
        pipeline: &PixelPipeline<'_>,
    ) -> DrawStats {
        let mut batch = EffectBatch::new();
        batch.push(vertices, attributes);
        self.batch_with_effects(&mut batch, pipeline)
    }
    }

    internal! {
    /// Draws the faces of a batch in their order, by one pixel pipeline, and takes them out of it.
    fn batch_with_effects(&mut self, batch: &mut EffectBatch, pipeline: &PixelPipeline<'_>) -> DrawStats {
        let EffectBatch { indices, at, depth, shade, texture, fog, channels, slope, lit, scratch } = &mut *batch;
        let effects = EffectColumns { texture, fog, channels, slope, lit: LitColumn::Values(lit) };
        let triangles = Triangles { columns: Columns { at, depth, shade, effects }, indices };
        let level = self.kernel().simd_level();
        let masks = cull(level, at, indices, self.clip(), false);
        // The back has another slope.
        let seen = masks.front_only();
        let mut list = PickList::<{ CHUNK + LANES }>::new();
        pick(level, &mut list, 0, &seen, masks.covers);
        let drawn = self.picks_with_effects(&triangles, Picks { picks: list.as_slice(), flat: &[] }, pipeline, scratch);
        batch.clear();
        drawn
    }
    }
}
