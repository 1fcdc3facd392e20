//! Hidden-surface methods: a frame's faces are drawn in scene order (with or without a depth buffer), far to near, or
//! row by row.

use alloc::vec::Vec;
use core::slice;

use super::picker::{Look, PickScratch, Picker, Run};
use super::pipelines::Pipelines;
use super::stats::Shares;
use super::to_integers::IntegerScratch;
use super::{Cache, HiddenSurfaces, Renderer, Stats};
use crate::fixed::U8F8;
use crate::plan::far_to_near;
use crate::raster::batches::SpanScratch;
use crate::raster::columns::{PickedTriangles, Picks, Triangles};
use crate::raster::effects::EffectScratch;
use crate::raster::pick::{CHUNK, Pick};
use crate::raster::scan_line::Lists;
use crate::raster::shaded::ShadedData;
use crate::raster::{DepthMemory, DrawStats, Frame, Interpolation, Raster, Rect, Vertex};
use crate::scene::Scene;
use crate::span::Kernel;

/// Memory for drawing, whose contents between two frames do not matter.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    depths: DepthMemory,
    spans: SpanScratch,
    shaded: ShadedData,
    effects: EffectScratch,
    pub(super) pick: PickScratch,
    pub(super) integer: IntegerScratch,
    /// Faces of a frame that must all be known before it is drawn.
    faces: Vec<DeferredFace>,
    /// Transparent faces, drawn after everything opaque.
    transparent: Vec<DeferredFace>,
    /// Sort keys for drawing far to near: the sum of a face's depths, and its index.
    far_to_near: Vec<(u64, usize)>,
    /// The faces as input of the scan-line method.
    triangles: Vec<([Vertex; 3], Interpolation)>,
    lists: Lists,
    /// Faces of each object by the shading that a budget chose when it was last drawn.
    pub(super) counts: Vec<Shares>,
}

/// A face that is drawn once all are known.
#[derive(Clone, Copy, Debug)]
pub(super) struct DeferredFace {
    object: u32,
    /// A [`Pick`].
    pick: u32,
    look: Look,
    /// Its single shade, or its three channels, if faces are lit.
    flat: Option<[U8F8; 3]>,
}

impl DeferredFace {
    /// The faces of a run.
    fn of<'a>(object: usize, run: &'a Run<'_>) -> impl Iterator<Item = Self> + 'a {
        run.picks.picks.iter().enumerate().map(move |(k, &pick)| {
            // Fewer than 2³² objects.
            Self { object: object as u32, pick, look: run.look, flat: run.picks.flat.get(k).copied() }
        })
    }

    /// The pick of this face alone.
    fn picks(&self) -> Picks<'_> {
        Picks { picks: slice::from_ref(&self.pick), flat: self.flat.as_slice() }
    }

    /// The triangles this face belongs to.
    fn triangles<'a>(&self, scene: &'a Scene, cache: &'a Cache, added: Triangles<'a>) -> Triangles<'a> {
        let object = self.object as usize;
        if self.look.added { added } else { cache.states[object].triangles(&scene.objects()[object]) }
    }
}

/// Draws faces, with their pipelines, the raster, and the memory of the stages.
struct Painter<'a, 'b> {
    pipelines: Pipelines<'a>,
    raster: &'a mut Raster<'b>,
    spans: &'a mut SpanScratch,
    shaded: &'a mut ShadedData,
    scratch: &'a mut EffectScratch,
}

impl Painter<'_, '_> {
    /// Draws faces of one look, in order.
    fn draw(&mut self, object: usize, look: Look, triangles: PickedTriangles<'_>) -> DrawStats {
        if !look.effects {
            return self.raster.picks(triangles, look.interpolation(), self.spans, Some(self.shaded));
        }
        let (raster, scratch) = (&mut *self.raster, &mut *self.scratch);
        self.pipelines.with(object, look, |pipeline| raster.picks_with_effects(triangles, pipeline, scratch))
    }

    /// Draws faces far to near.
    fn draw_far_to_near(
        &mut self,
        (scene, cache, added): (&Scene, &Cache, Triangles<'_>),
        faces: &[DeferredFace],
        order: &mut Vec<(u64, usize)>,
    ) -> DrawStats {
        let depth = |face: &DeferredFace| {
            let triangles = face.triangles(scene, cache, added);
            triangles.corners(Pick(face.pick)).into_iter().map(|i| u64::from(triangles.columns.depth[i])).sum()
        };
        far_to_near(faces.iter().map(depth), order);
        let mut drawn = DrawStats::default();
        let kind = |&(_, i): &(u64, usize)| (faces[i].object, faces[i].look, faces[i].flat.is_some());
        for run in order.chunk_by(|a, b| kind(a) == kind(b)) {
            let first = faces[run[0].1];
            let triangles = first.triangles(scene, cache, added);
            for part in run.chunks(CHUNK) {
                let (mut picks, mut flat) = ([0; CHUNK], [[U8F8::default(); 3]; CHUNK]);
                for (k, &(_, i)) in part.iter().enumerate() {
                    (picks[k], flat[k]) = (faces[i].pick, faces[i].flat.unwrap_or_default());
                }
                let flat = if first.flat.is_some() { &flat[..part.len()] } else { &[] };
                let picks = Picks { picks: &picks[..part.len()], flat };
                let picked = PickedTriangles { triangles: &triangles, picks };
                drawn += self.draw(first.object as usize, first.look, picked);
            }
        }
        drawn
    }
}

impl Renderer {
    /// Draws the prepared frame over the contents of `frame`.
    pub(super) fn fill(&mut self, scene: &Scene, stats: &mut Stats, frame: Frame<'_>) {
        let Self { kernel, cache, scratch, .. } = self;
        let Scratch { faces, transparent, far_to_near, triangles, lists, .. } = scratch;
        let mut raster = Raster::new(frame).with_kernel(*kernel);
        let method = cache.plan.hidden_surfaces();
        if method == HiddenSurfaces::DepthBuffer {
            raster = raster.with_depth_memory_within(&mut scratch.depths, cache.plan.seen);
        }
        let deferred = match method {
            HiddenSurfaces::BackFaces | HiddenSurfaces::DepthBuffer => false,
            // If the plan chose it, the objects are sorted far to near, and in a convex one no face hides another.
            HiddenSurfaces::PainterOrder => !cache.plan.is_chosen(),
            HiddenSurfaces::ScanLine => true,
        };
        transparent.clear();
        transparent.reserve(cache.most_faces(scene, |plan| plan.stages().is_transparent()));
        far_to_near.clear();
        far_to_near.reserve(transparent.capacity());
        faces.clear();
        if deferred {
            faces.reserve(cache.most_faces(scene, |_| true));
            far_to_near.reserve(faces.capacity());
            if method == HiddenSurfaces::ScanLine {
                triangles.clear();
                triangles.reserve(faces.capacity());
                lists.reserve(faces.capacity());
            }
        }
        let culling = (*kernel, Some(raster.clip()));
        let pipelines = Pipelines { scene, cache, kernel: *kernel };
        let (spans, shaded, effects) = (&mut scratch.spans, &mut scratch.shaded, &mut scratch.effects);
        let mut painter = Painter { pipelines, raster: &mut raster, spans, shaded, scratch: effects };
        let mut drawn = DrawStats::default();
        let memory = (&mut scratch.integer, &mut scratch.pick, &mut scratch.counts);
        each_run(scene, cache, culling, deferred, memory, stats, &mut |object, run| {
            if run.look.transparent {
                transparent.extend(DeferredFace::of(object, run));
            } else if deferred {
                faces.extend(DeferredFace::of(object, run));
            } else {
                drawn += painter.draw(object, run.look, run.picked());
            }
        });
        let of = (scene, &*cache, scratch.pick.added.triangles());
        if method == HiddenSurfaces::ScanLine {
            drawn += scan_line(of, faces, (triangles, lists), &mut painter);
        } else if deferred {
            drawn += painter.draw_far_to_near(of, faces, far_to_near);
        }
        if !transparent.is_empty() {
            drawn += painter.draw_far_to_near(of, transparent, far_to_near);
        }
        stats.raster += drawn;
        // Faces of the 16.16 path are not counted one by one.
        let counted: u64 = stats.shares.into_iter().map(|(_, count)| count).sum();
        stats.shares.add(stats.shading.into(), stats.drawn - counted);
    }
}

/// Passes the faces of a frame to `draw` with their object, in runs that are drawn together: object by object, each in
/// the order of its faces. Triangles that the frame adds are kept if `keeps` says so, or if they are transparent.
pub(super) fn each_run(
    scene: &Scene,
    cache: &Cache,
    culling: (Kernel, Option<Rect>),
    keeps: bool,
    (integer, pick, counts): (&mut IntegerScratch, &mut PickScratch, &mut Vec<Shares>),
    stats: &mut Stats,
    draw: &mut dyn FnMut(usize, &Run<'_>),
) {
    counts.clear();
    counts.resize(scene.objects().len(), Shares::default());
    pick.added.clear();
    // Done even if no face needs it yet, so that no later frame allocates memory.
    pick.added.make_room();
    for &object in &cache.plan.order {
        let (of_scene, plan) = (&scene.objects()[object], &cache.plan.objects[object]);
        let mut of_object = |run: &Run<'_>| draw(object, run);
        if cache.plan.is_integer {
            let mut picker = Picker::new(culling, keeps, pick, &mut of_object);
            let shading = stats.shading;
            cache.integer.triangles(shading, (object, of_scene), stats, integer, &mut |vertices, interpolation| {
                picker.push_vertices(vertices, interpolation, shading);
            });
            picker.finish_vertices(shading);
        } else if let Some(faces) = cache.states[object].faces(of_scene, plan, culling.0) {
            let budget = cache.states[object].budget(plan);
            let mut picker = Picker::new(culling, keeps, pick, &mut of_object);
            counts[object] = faces.pick(budget, stats, &mut picker);
        }
    }
}

/// Draws all faces at once, writing each pixel once.
fn scan_line(
    (scene, cache, added): (&Scene, &Cache, Triangles<'_>),
    faces: &[DeferredFace],
    (triangles, lists): (&mut Vec<([Vertex; 3], Interpolation)>, &mut Lists),
    painter: &mut Painter<'_, '_>,
) -> DrawStats {
    triangles.extend(faces.iter().map(|face| {
        let triangles = face.triangles(scene, cache, added);
        let vertices = PickedTriangles { triangles: &triangles, picks: face.picks() }.vertices(0);
        (vertices, if face.look.effects { Interpolation::default() } else { face.look.interpolation() })
    }));
    let Painter { pipelines, raster, scratch, .. } = painter;
    raster.scan_line_with(triangles, lists, |i, row, pixels, kernel, drawn| {
        let face = &faces[i];
        if !face.look.effects {
            return false;
        }
        let triangles = face.triangles(scene, cache, added);
        pipelines.with(face.object as usize, face.look, |pipeline| {
            let face = PickedTriangles { triangles: &triangles, picks: face.picks() };
            scratch.paint_row((face, 0), pipeline, row, pixels, kernel, drawn);
        });
        true
    })
}
