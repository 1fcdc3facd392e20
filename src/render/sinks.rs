//! What becomes of faces that are handed on: they are drawn as they come, many at a time, or kept for when all are
//! known.

use alloc::vec::Vec;

use super::face::{ShadeMode, Sink};
use super::pipelines::Pipelines;
use super::sift::Sieve;
use crate::raster::batch::numbered::Numbered;
use crate::raster::effects::Attributes;
use crate::raster::{Batch, DrawStats, Interpolation, Raster, Vertex};

/// A face with effects that is drawn when all are known.
#[derive(Clone, Copy, Debug)]
pub(super) struct DeferredFace {
    pub(super) vertices: [Vertex; 3],
    pub(super) attributes: [Attributes; 3],
    pub(super) object: usize,
    pub(super) surface: u16,
    pub(super) manner: ShadeMode,
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
pub(super) struct ForEachSink<F>(pub(super) F);

impl<F: FnMut(&[Vertex; 3], Interpolation)> Sink for ForEachSink<F> {
    fn plain(&mut self, vertices: &[Vertex; 3], interpolation: Interpolation) {
        (self.0)(vertices, interpolation);
    }

    fn with_effects(&mut self, vertices: &[Vertex; 3], _: &[Attributes; 3], _: u16, _: ShadeMode) {
        (self.0)(vertices, Interpolation::default());
    }
}

/// Draws faces as they come; keeps those that shine through.
pub(super) struct ImmediateSink<'a, 'b, const CLIPS: bool> {
    pub(super) batched: Batched<'a, 'b, CLIPS>,
    pub(super) looks: &'a Pipelines<'a>,
    pub(super) object: usize,
    pub(super) transparent: &'a mut Vec<DeferredFace>,
}

impl<const CLIPS: bool> Sink for ImmediateSink<'_, '_, CLIPS> {
    fn sieve(&self) -> Option<Sieve> {
        let raster = &self.batched.raster;
        Some(Sieve { clip: raster.clip(), kernel: raster.kernel() })
    }

    #[inline]
    fn plain(&mut self, vertices: &[Vertex; 3], interpolation: Interpolation) {
        self.batched.triangle(vertices, interpolation);
    }

    fn takes_numbers(&self, interpolation: Interpolation) -> bool {
        Batch::takes(interpolation)
    }

    fn numbered(&mut self, from: &Numbered<'_>, numbers: &[u32], interpolation: Interpolation) {
        // Those that came before, if any.
        self.batched.draw();
        let kernel = self.batched.raster.kernel();
        for numbers in numbers.chunks(Batch::CAPACITY) {
            self.batched.batch.refill(from, numbers, interpolation, kernel);
            self.batched.draw();
        }
    }

    fn with_effects(&mut self, vertices: &[Vertex; 3], attributes: &[Attributes; 3], surface: u16, manner: ShadeMode) {
        if self.looks.is_transparent(self.object, surface) {
            let (vertices, attributes) = (*vertices, *attributes);
            self.transparent.push(DeferredFace { vertices, attributes, object: self.object, surface, manner });
            return;
        }
        // In the order in which they came: of equal depths the first stays.
        self.batched.draw();
        let Batched { raster, drawn, .. } = &mut self.batched;
        **drawn += self.looks.with((self.object, surface, manner), |look| {
            if CLIPS {
                raster.triangle_with_effects(vertices, attributes, look)
            } else {
                raster.triangle_with_effects_inside(vertices, attributes, look)
            }
        });
    }
}

/// Draws faces without effects, many at a time.
pub(super) struct Batched<'a, 'b, const CLIPS: bool> {
    pub(super) raster: &'a mut Raster<'b>,
    pub(super) batch: &'a mut Batch,
    pub(super) drawn: &'a mut DrawStats,
}

impl<const CLIPS: bool> Batched<'_, '_, CLIPS> {
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
            *self.drawn += if CLIPS {
                self.raster.triangle(&vertices, interpolation)
            } else {
                self.raster.triangle_inside(&vertices, interpolation)
            };
        }
    }

    /// Draws those that are waiting.
    pub(super) fn draw(&mut self) {
        if !self.batch.is_empty() {
            *self.drawn += if CLIPS { self.raster.batch(self.batch) } else { self.raster.batch_inside(self.batch) };
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
    pub(super) sieve: Sieve,
}

impl Sink for DeferredSink<'_> {
    fn sieve(&self) -> Option<Sieve> {
        Some(self.sieve)
    }

    fn plain(&mut self, vertices: &[Vertex; 3], interpolation: Interpolation) {
        self.triangles.push((*vertices, interpolation));
        self.places.push(None);
    }

    fn with_effects(&mut self, vertices: &[Vertex; 3], attributes: &[Attributes; 3], surface: u16, manner: ShadeMode) {
        let face = DeferredFace { vertices: *vertices, attributes: *attributes, object: self.object, surface, manner };
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
