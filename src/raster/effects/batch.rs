//! Faces with effects given as vertices: an adapter to the columns.

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
use crate::raster::vertex::{Vertex, misses_centres};

/// Faces drawn by one pixel pipeline. Refilling and redrawing it allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct EffectBatch {
    count: usize,
    /// Empty before the first face.
    corners: Vec<Corners>,
    scratch: EffectScratch,
}

/// The corners of faces in columns: arrays, so that the compiler knows their lengths.
#[derive(Clone, Debug)]
struct Corners {
    at: [ScreenPos; CORNERS],
    depth: [u32; CORNERS],
    shade: [[U8F8; 2]; CORNERS],
    texture: [[i32; 2]; CORNERS],
    fog: [U8F8; CORNERS],
    channels: [[[U8F8; 3]; 2]; CORNERS],
    slope: [[U8F8; 2]; CORNERS],
    lit: [[f32; 6]; CORNERS],
}

/// The corners of a full batch.
const CORNERS: usize = 3 * EffectBatch::CAPACITY;

/// The corners of each face; no two faces share one.
const INDICES: [[u32; 3]; EffectBatch::CAPACITY] = {
    let mut indices = [[0; 3]; EffectBatch::CAPACITY];
    let mut face = 0;
    while face < EffectBatch::CAPACITY {
        let first = 3 * face as u32;
        indices[face] = [first, first + 1, first + 2];
        face += 1;
    }
    indices
};

impl Corners {
    const NONE: Self = {
        let zero = U8F8::from_bits(0);
        Self {
            at: [ScreenPos::new(0, 0); CORNERS],
            depth: [0; CORNERS],
            shade: [[zero; 2]; CORNERS],
            texture: [[0; 2]; CORNERS],
            fog: [zero; CORNERS],
            channels: [[[zero; 3]; 2]; CORNERS],
            slope: [[zero; 2]; CORNERS],
            lit: [[0.0; 6]; CORNERS],
        }
    };
}

impl EffectBatch {
    /// The most faces that a batch can hold.
    pub const CAPACITY: usize = CHUNK;

    /// An empty batch. Its first drawing allocates 100 kB.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns whether the batch is empty.
    #[must_use]
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Returns whether the batch has no room for another face.
    #[must_use]
    #[inline]
    pub fn is_full(&self) -> bool {
        self.count >= Self::CAPACITY
    }

    /// Adds a face. The order and winding of the corners do not matter; a face without area draws nothing, and one
    /// whose box contains no pixel centre is left out. Returns `false`, and adds nothing, if the
    /// batch is full.
    #[inline]
    pub fn push(&mut self, vertices: &[Vertex; 3], attributes: &[Attributes; 3]) -> bool {
        if self.is_full() {
            return false;
        }
        // Most faces of a detailed model are like that, and not worth storing.
        if misses_centres(vertices) {
            return true;
        }
        if self.corners.is_empty() {
            self.corners.push(Corners::NONE);
        }
        let Some(to) = self.corners.first_mut() else { return false };
        for (k, (vertex, of)) in vertices.iter().zip(attributes).enumerate() {
            // Below the capacity, as the remainder tells the compiler.
            let i = 3 * (self.count % Self::CAPACITY) + k;
            to.at[i] = ScreenPos::of(vertex);
            to.depth[i] = vertex.depth();
            to.shade[i] = [vertex.shade(); 2];
            to.texture[i] = of.texture;
            to.fog[i] = of.fog;
            to.channels[i] = [of.channels; 2];
            to.slope[i] = of.slope;
            to.lit[i] = of.lit;
        }
        self.count += 1;
        true
    }
}

impl<D: Cell> Raster<'_, D> {
    internal! {
    /// Draws a triangle with effects. The order and winding of the corners do not matter; a triangle without area draws
    /// nothing. To draw many triangles, [`batch_with_effects`](Self::batch_with_effects), which this calls, is faster.
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
    /// Draws the faces of a batch in order through one pixel pipeline, and empties the batch.
    fn batch_with_effects(&mut self, batch: &mut EffectBatch, pipeline: &PixelPipeline<'_>) -> DrawStats {
        let EffectBatch { count, corners, scratch } = &mut *batch;
        let Some(Corners { at, depth, shade, texture, fog, channels, slope, lit }) = corners.first() else {
            return DrawStats::default();
        };
        let effects = EffectColumns { texture, fog, channels, slope, lit: LitColumn::Values(lit) };
        let indices = &INDICES[..*count];
        let triangles = Triangles { columns: Columns { at, depth, shade, effects }, indices };
        let level = self.kernel().simd_level();
        let masks = cull(level, at, indices, self.clip(), false);
        // The back has another slope.
        let seen = masks.front_only();
        let mut list = PickList::<{ CHUNK + LANES }>::new();
        pick(level, &mut list, 0, &seen, masks.covers);
        let drawn = self.picks_with_effects(&triangles, Picks { picks: list.as_slice(), flat: &[] }, pipeline, scratch);
        *count = 0;
        drawn
    }
    }
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::fixed::I24F8;
    use crate::raster::frame::Frame;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4_000))]
        /// A face that is left out covers no pixel, and one that stays in is drawn.
        #[test]
        fn what_is_left_out_covers_nothing(corners in prop::array::uniform3((0_i32..40, 0_i32..40))) {
            let at = |(x, y): (i32, i32)| {
                let place = |c: i32| I24F8::from_bits(c * 32);
                Vertex::new(place(x), place(y), U8F8::from(9), 1).expect("inside the guard band")
            };
            let vertices = corners.map(at);
            let mut batch = EffectBatch::new();
            prop_assert!(batch.push(&vertices, &[Attributes::default(); 3]));
            let is_left_out = batch.is_empty();
            let draw = |draw: &mut dyn FnMut(&mut Raster<'_>)| {
                let mut bytes = [0; 64];
                draw(&mut Raster::new(Frame::new(&mut bytes, 8, 8, 8).expect("a frame")));
                bytes
            };
            let alone = draw(&mut |raster| {
                raster.triangle(&vertices, crate::raster::Interpolation::Gouraud);
            });
            let together = draw(&mut |raster| {
                raster.batch_with_effects(&mut batch, &PixelPipeline::PLAIN);
            });
            prop_assert_eq!(alone, together);
            prop_assert!(!is_left_out || alone == [0; 64]);
        }
    }
}
