//! Sinks: where faces go, drawn at once, many at a time, or kept until all are known.

use alloc::vec::Vec;

use super::cull::Culler;
use super::face::Sink;
use super::pipelines::{Pipeline, Pipelines};
use crate::plan::FaceShading;
use crate::raster::batch::indexed::IndexedTriangles;
use crate::raster::effects::{Attributes, EffectBatch};
use crate::raster::{Batch, DrawStats, Interpolation, Raster, Vertex};

/// A face with effects that is drawn when all are known.
#[derive(Clone, Copy, Debug)]
pub(super) struct DeferredFace {
    pub(super) vertices: [Vertex; 3],
    pub(super) attributes: [Attributes; 3],
    pub(super) of: Pipeline,
}

impl DeferredFace {
    pub(super) fn depth(&self) -> u64 {
        depth_of(&self.vertices)
    }
}

/// The sum of a face's depths.
pub(super) fn depth_of(vertices: &[Vertex; 3]) -> u64 {
    vertices.iter().map(|v| u64::from(v.depth())).sum()
}

/// Faces without what effects need.
pub(super) struct ForEachSink<'a>(pub(super) &'a mut dyn FnMut(&[Vertex; 3], Interpolation));

impl Sink for ForEachSink<'_> {
    fn plain(&mut self, _: u32, vertices: &[Vertex; 3], interpolation: Interpolation) {
        (self.0)(vertices, interpolation);
    }

    fn with_effects(&mut self, _: u32, vertices: &[Vertex; 3], _: &[Attributes; 3], _: u16, _: FaceShading) {
        (self.0)(vertices, Interpolation::default());
    }
}

/// Draws faces as they come, many at a time; keeps those that shine through.
pub(super) struct ImmediateSink<'a, 'b> {
    batched: Batched<'a, 'b>,
    effects: BatchedEffects<'a>,
    transparent: &'a mut Vec<DeferredFace>,
    /// True if the surface of the last face with effects shines through.
    is_transparent: bool,
}

impl<'a, 'b> ImmediateSink<'a, 'b> {
    /// Makes one for the faces of one object.
    pub(super) fn new(
        batched: Batched<'a, 'b>,
        effects: BatchedEffects<'a>,
        transparent: &'a mut Vec<DeferredFace>,
    ) -> Self {
        Self { batched, effects, transparent, is_transparent: false }
    }

    /// Draws all that waits.
    pub(super) fn finish(mut self) {
        self.draw();
    }

    fn draw(&mut self) {
        self.batched.draw();
        let Batched { clips, raster, drawn, .. } = &mut self.batched;
        self.effects.draw(*clips, raster, drawn);
    }

    /// Begins with faces of another surface or shading, after what waits is drawn: faces are drawn in the order in which
    /// they came, and of equal depths the first stays.
    #[inline(never)]
    fn begin(&mut self, of: Pipeline) {
        self.draw();
        self.effects.of = Some(of);
        self.is_transparent = self.effects.pipelines.is_transparent(of.object, of.surface);
    }
}

impl Sink for ImmediateSink<'_, '_> {
    fn culler(&self) -> Option<Culler> {
        let raster = &self.batched.raster;
        Some(Culler { clip: raster.clip(), kernel: raster.kernel() })
    }

    #[inline]
    fn plain(&mut self, _: u32, vertices: &[Vertex; 3], interpolation: Interpolation) {
        self.batched.triangle(vertices, interpolation);
    }

    #[inline]
    fn after_effects(&mut self) {
        if self.effects.of.is_some() {
            self.draw();
        }
    }

    fn takes_numbers(&self, interpolation: Interpolation) -> bool {
        Batch::takes(interpolation)
    }

    fn indexed(&mut self, from: &IndexedTriangles<'_>, numbers: &[u32], interpolation: Interpolation) {
        // Those that came before, if any.
        self.draw();
        let kernel = self.batched.raster.kernel();
        for numbers in numbers.chunks(Batch::CAPACITY) {
            self.batched.batch.refill(from, numbers, interpolation, kernel);
            self.batched.draw();
        }
    }

    fn with_effects(
        &mut self,
        _: u32,
        vertices: &[Vertex; 3],
        attributes: &[Attributes; 3],
        surface: u16,
        shading: FaceShading,
    ) {
        let of = Pipeline { object: self.effects.object, surface, shading };
        if self.effects.of != Some(of) || self.effects.batch.is_full() {
            self.begin(of);
        }
        if self.is_transparent {
            let (vertices, attributes) = (*vertices, *attributes);
            self.transparent.push(DeferredFace { vertices, attributes, of });
            return;
        }
        self.effects.batch.push(vertices, attributes);
    }
}

/// Draws faces with effects, many of one pipeline at a time.
pub(super) struct BatchedEffects<'a> {
    batch: &'a mut EffectBatch,
    pipelines: &'a Pipelines<'a>,
    object: usize,
    /// Pipeline of the faces that wait; `None` where nothing waits.
    of: Option<Pipeline>,
}

impl<'a> BatchedEffects<'a> {
    /// Makes one for the faces of an object, or of any with [`push`](Self::push).
    pub(super) fn new(batch: &'a mut EffectBatch, pipelines: &'a Pipelines<'a>, object: usize) -> Self {
        Self { batch, pipelines, object, of: None }
    }

    /// Queues a face. The queue is drawn first if it has another pipeline or there is no room.
    pub(super) fn push(
        &mut self,
        (vertices, attributes, of): (&[Vertex; 3], &[Attributes; 3], Pipeline),
        raster: &mut Raster<'_>,
        drawn: &mut DrawStats,
    ) {
        if self.of != Some(of) || self.batch.is_full() {
            self.draw(true, raster, drawn);
            self.of = Some(of);
        }
        self.batch.push(vertices, attributes);
    }

    /// Draws the queued faces. `clips` is false where all lie inside the frame.
    pub(super) fn draw(&mut self, clips: bool, raster: &mut Raster<'_>, drawn: &mut DrawStats) {
        let Some(of) = self.of.take() else { return };
        if self.batch.is_empty() {
            return;
        }
        *drawn += self.pipelines.with(of, |pipeline| {
            if clips {
                raster.batch_with_effects(self.batch, pipeline)
            } else {
                raster.batch_with_effects_inside(self.batch, pipeline)
            }
        });
    }
}

/// Draws faces without effects, many at a time.
pub(super) struct Batched<'a, 'b> {
    /// False where all lie inside the frame.
    pub(super) clips: bool,
    pub(super) raster: &'a mut Raster<'b>,
    pub(super) batch: &'a mut Batch,
    pub(super) drawn: &'a mut DrawStats,
}

impl Batched<'_, '_> {
    #[inline]
    pub(super) fn triangle(&mut self, vertices: &[Vertex; 3], interpolation: Interpolation) {
        if !self.batch.push(vertices, interpolation) {
            // By value, so that only here they have to be in memory.
            self.past_the_batch(*vertices, interpolation);
        }
    }

    /// A triangle that a full batch has no room for, or that is for no batch.
    #[inline(never)]
    fn past_the_batch(&mut self, vertices: [Vertex; 3], interpolation: Interpolation) {
        self.draw();
        if !self.batch.push(&vertices, interpolation) {
            *self.drawn += if self.clips {
                self.raster.triangle(&vertices, interpolation)
            } else {
                self.raster.triangle_inside(&vertices, interpolation)
            };
        }
    }

    /// Draws those that are waiting.
    pub(super) fn draw(&mut self) {
        if !self.batch.is_empty() {
            *self.drawn +=
                if self.clips { self.raster.batch(self.batch) } else { self.raster.batch_inside(self.batch) };
            self.batch.clear();
        }
    }
}

/// Keeps faces for when all are known.
pub(super) struct DeferredSink<'a> {
    pub(super) triangles: &'a mut Vec<([Vertex; 3], Interpolation)>,
    pub(super) places: &'a mut Vec<Option<u32>>,
    pub(super) kept: &'a mut Vec<DeferredFace>,
    pub(super) transparent: &'a mut Vec<DeferredFace>,
    pub(super) looks: &'a Pipelines<'a>,
    pub(super) object: usize,
    pub(super) culler: Culler,
}

impl Sink for DeferredSink<'_> {
    fn culler(&self) -> Option<Culler> {
        Some(self.culler)
    }

    fn plain(&mut self, _: u32, vertices: &[Vertex; 3], interpolation: Interpolation) {
        self.triangles.push((*vertices, interpolation));
        self.places.push(None);
    }

    fn with_effects(
        &mut self,
        _: u32,
        vertices: &[Vertex; 3],
        attributes: &[Attributes; 3],
        surface: u16,
        shading: FaceShading,
    ) {
        let of = Pipeline { object: self.object, surface, shading };
        let face = DeferredFace { vertices: *vertices, attributes: *attributes, of };
        if self.looks.is_transparent(self.object, surface) {
            self.transparent.push(face);
            return;
        }
        self.triangles.push((*vertices, Interpolation::default()));
        // Fewer than 2³² faces.
        self.places.push(Some(self.kept.len() as u32));
        self.kept.push(face);
    }
}
