//! Faces with effects given as vertices: an adapter to the columns.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::mem;

use super::{Attributes, EffectScratch, PixelPipeline, ShadeSource};
use crate::fixed::U8F8;
use crate::lanes::LANES;
use crate::raster::columns::{Columns, EffectColumns, LitColumn, PickedTriangles, Picks, ScreenPos, Triangles};
use crate::raster::cull::PickList;
use crate::raster::depth::Cell;
use crate::raster::draw_stats::DrawStats;
use crate::raster::pick::{CHUNK, Pick};
use crate::raster::triangle::Raster;
use crate::raster::triangles::{Corners, Sieve, corner_indices, cull_corners, put_positions};
use crate::raster::vertex::Vertex;

/// The vertices and attributes of a face's corners. Their order and winding do not matter.
pub type EffectFace = ([Vertex; 3], [Attributes; 3]);

/// The maximum number of faces that are culled and drawn together.
const CAPACITY: usize = CHUNK;

/// Faces drawn by one pixel pipeline, and the memory for drawing faces. Refilling and redrawing it allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct EffectBatch {
    faces: Vec<EffectFace>,
    /// Allocated by the first drawing.
    columns: Option<Box<CornerColumns>>,
    sieve: Sieve,
    scratch: EffectScratch,
}

/// Columns of the corners of faces; only the values that a pipeline uses are set. They are arrays, so the compiler
/// knows their lengths.
#[derive(Clone, Debug)]
struct CornerColumns {
    /// The positions of all faces, for culling. The other columns hold only the faces that are drawn.
    all: Corners<ScreenPos, CAPACITY>,
    at: Corners<ScreenPos, CAPACITY>,
    depth: Corners<u32, CAPACITY>,
    shade: Corners<[U8F8; 2], CAPACITY>,
    texture: Corners<[i32; 2], CAPACITY>,
    fog: Corners<U8F8, CAPACITY>,
    channels: Corners<[[U8F8; 3]; 2], CAPACITY>,
    slope: Corners<[U8F8; 2], CAPACITY>,
    lit: Corners<[f32; 6], CAPACITY>,
}

/// The corners of each face; no two faces share one.
const INDICES: [[u32; 3]; CAPACITY] = corner_indices();

impl CornerColumns {
    const NONE: Self = {
        let zero = U8F8::from_bits(0);
        Self {
            all: [[ScreenPos::new(0, 0); CAPACITY]; 3],
            at: [[ScreenPos::new(0, 0); CAPACITY]; 3],
            depth: [[0; CAPACITY]; 3],
            shade: [[[zero; 2]; CAPACITY]; 3],
            texture: [[[0; 2]; CAPACITY]; 3],
            fog: [[zero; CAPACITY]; 3],
            channels: [[[[zero; 3]; 2]; CAPACITY]; 3],
            slope: [[[zero; 2]; CAPACITY]; 3],
            lit: [[[0.0; 6]; CAPACITY]; 3],
        }
    };

    /// Copies the values of a face that the pipeline uses. The face becomes number `to` of those that are drawn.
    #[inline(always)]
    fn copy(&mut self, (vertices, attributes): &EffectFace, to: usize, [uses_texture, uses_others]: [bool; 2]) {
        put_positions(&mut self.at, to, vertices);
        let i = to % CAPACITY;
        for (k, (vertex, of)) in vertices.iter().zip(attributes).enumerate() {
            self.depth[k][i] = vertex.depth();
            // All are seen from the front.
            self.shade[k][i][0] = vertex.shade();
            if uses_texture {
                self.texture[k][i] = of.texture;
            }
            if uses_others {
                self.fog[k][i] = in_range(of.fog);
                self.channels[k][i][0] = of.channels.map(in_range);
                self.slope[k][i] = of.slope.map(in_range);
                self.lit[k][i] = of.lit;
            }
        }
    }
}

/// The value, or the greatest that the loops over pixels allow.
fn in_range(value: U8F8) -> U8F8 {
    value.min(U8F8::MAX_VERTEX)
}

impl EffectBatch {
    /// The maximum number of faces that a batch can hold.
    pub const CAPACITY: usize = CAPACITY;

    /// An empty batch. Its first drawing allocates 150 kB.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns whether the batch has no room for another face.
    #[must_use]
    #[inline]
    pub fn is_full(&self) -> bool {
        self.faces.len() >= CAPACITY
    }

    /// Adds a face, unless it is certain to draw nothing. Returns `false`, and adds nothing, if the batch is full.
    #[inline]
    pub fn push(&mut self, vertices: &[Vertex; 3], attributes: &[Attributes; 3]) -> bool {
        if self.is_full() {
            return false;
        }
        if self.sieve.leaves_out(vertices) {
            return true;
        }
        if self.faces.capacity() == 0 {
            self.faces.reserve_exact(CAPACITY);
        }
        self.faces.push((*vertices, *attributes));
        true
    }
}

impl<D: Cell> Raster<'_, D> {
    /// Draws a triangle with effects. To draw many triangles, [`faces_with_effects`](Self::faces_with_effects) is
    /// faster.
    pub fn triangle_with_effects(
        &mut self,
        vertices: &[Vertex; 3],
        attributes: &[Attributes; 3],
        pipeline: &PixelPipeline<'_>,
    ) -> DrawStats {
        self.faces_with_effects(&[(*vertices, *attributes)], pipeline, &mut EffectBatch::new())
    }

    /// Draws the faces of a batch in order through one pixel pipeline, and empties the batch.
    pub fn batch_with_effects(&mut self, batch: &mut EffectBatch, pipeline: &PixelPipeline<'_>) -> DrawStats {
        let faces = mem::take(&mut batch.faces);
        let drawn = self.faces_with_effects(&faces, pipeline, batch);
        batch.faces = faces;
        batch.faces.clear();
        drawn
    }

    /// Draws faces in order through one pixel pipeline, with the memory of a batch. The batch keeps its own faces.
    pub fn faces_with_effects(
        &mut self,
        faces: &[EffectFace],
        pipeline: &PixelPipeline<'_>,
        batch: &mut EffectBatch,
    ) -> DrawStats {
        let EffectBatch { columns, sieve, scratch, .. } = batch;
        let mut drawn = DrawStats::default();
        let columns = columns.get_or_insert_with(|| Box::new(CornerColumns::NONE));
        let level = self.kernel.simd_level();
        let is_plain = matches!(pipeline.source, ShadeSource::Shaded(_));
        let uses_others = !is_plain || pipeline.fog.is_some() || pipeline.channels.is_some();
        let uses = [pipeline.texture.is_some(), uses_others];
        let mut left = faces;
        while !left.is_empty() {
            let (mut count, mut seen, mut chosen) = (0, 0, [&left[0]; CAPACITY]);
            for face in left {
                if count == CAPACITY {
                    break;
                }
                seen += 1;
                if !sieve.leaves_out(&face.0) {
                    chosen[count] = face;
                    put_positions(&mut columns.all, count, &face.0);
                    count += 1;
                }
            }
            left = &left[seen..];
            let mut list: PickList<{ CAPACITY + LANES }> = cull_corners(level, &columns.all, count, self.clip());
            sieve.adapt(list.as_slice().len(), count);
            for (to, pick) in list.as_mut_slice().iter_mut().enumerate() {
                columns.copy(chosen[Pick(*pick).index() % CAPACITY], to, uses);
                *pick = Pick(*pick).with_index(to).0;
            }
            let CornerColumns { at, depth, shade, texture, fog, channels, slope, lit, .. } = &**columns;
            let effects = EffectColumns {
                texture: texture.as_flattened(),
                fog: fog.as_flattened(),
                channels: channels.as_flattened(),
                slope: slope.as_flattened(),
                lit: LitColumn::Values(lit.as_flattened()),
            };
            let columns =
                Columns { at: at.as_flattened(), depth: depth.as_flattened(), shade: shade.as_flattened(), effects };
            let triangles = Triangles { columns, indices: &INDICES, by_corner: Some(CAPACITY) };
            let picks = Picks { picks: list.as_slice(), flat: &[] };
            drawn += self.picks_with_effects(PickedTriangles { triangles: &triangles, picks }, pipeline, scratch);
        }
        drawn
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
        /// Tiny faces are drawn like triangles, whatever culling finds.
        #[test]
        fn faces_are_drawn_like_triangles(corners in prop::array::uniform3((0_i32..40, 0_i32..40))) {
            let at = |(x, y): (i32, i32)| {
                let coordinate = |c: i32| I24F8::from_bits(c * 32);
                Vertex::new(coordinate(x), coordinate(y), U8F8::from(9), 1).expect("inside the guard band")
            };
            let vertices = corners.map(at);
            let mut batch = EffectBatch::new();
            prop_assert!(batch.push(&vertices, &[Attributes::default(); 3]));
            let draw = |draw: &mut dyn FnMut(&mut Raster<'_>)| {
                let mut bytes = [0; 64];
                draw(&mut Raster::new(Frame::new(&mut bytes, 8, 8, 8).expect("a frame")));
                bytes
            };
            let alone = draw(&mut |raster| {
                raster.triangle(&vertices, crate::raster::Interpolation::Gouraud88);
            });
            let together = draw(&mut |raster| {
                raster.batch_with_effects(&mut batch, &PixelPipeline::PLAIN);
            });
            prop_assert_eq!(alone, together);
        }
    }
}
