//! The ways to visible surfaces: the faces of a frame drawn as they come, far to near, or row by row.

use core::mem;

use super::cull::Culler;
use super::face::Sink;
use super::object::ObjectState;
use super::pipelines::Pipelines;
use super::sinks::{Batched, BatchedEffects, DeferredFace, DeferredSink, ForEachSink, ImmediateSink, depth_of};
use super::stats::Shares;
use super::{HiddenSurfaces, Renderer, Stats, VertexPath};
use crate::plan::{Effect, ObjectPlan, far_to_near};
use crate::raster::{Batch, DrawStats, Frame, Interpolation, Raster, Vertex};
use crate::scene::Scene;

impl Renderer {
    pub(super) fn fill(&mut self, scene: &Scene, stats: &mut Stats, mut frame: Frame<'_>) {
        frame.clear(scene.background);
        let mut raster = Raster::new(frame).with_kernel(self.settings.kernel);
        let mut depths = mem::take(&mut self.depths);
        let culler = Culler { clip: raster.clip(), kernel: self.settings.kernel };
        match self.plan.hidden_surfaces() {
            HiddenSurfaces::BackFaces => self.one_by_one(scene, stats, raster),
            // Chosen, the objects lie far to near, and in a convex one no face hides another.
            HiddenSurfaces::PainterOrder if self.plan.is_chosen() => self.one_by_one(scene, stats, raster),
            HiddenSurfaces::DepthBuffer => {
                let raster = raster.with_depth_cleared_within(&mut depths, self.plan.seen);
                self.one_by_one(scene, stats, raster);
            }
            HiddenSurfaces::PainterOrder => {
                self.gather(scene, stats, culler);
                self.painter(scene, stats, &mut raster);
                self.draw_transparent(scene, stats, &mut raster);
            }
            HiddenSurfaces::ScanLine => {
                self.gather(scene, stats, culler);
                self.scan_line(scene, stats, &mut raster);
                self.draw_transparent(scene, stats, &mut raster);
            }
        }
        self.depths = depths;
        // Those of the 16.16 path are not counted one by one.
        stats.shares.complete(stats.shading.into(), stats.drawn);
    }

    /// Draws each face as it comes, then those that shine through.
    fn one_by_one(&mut self, scene: &Scene, stats: &mut Stats, mut raster: Raster<'_>) {
        self.transparent.clear();
        self.transparent.reserve(self.most_faces(scene, |plan, _| plan.is_on(Effect::Transparency)));
        let mut batch = Batch::of_culled();
        for &object in &self.plan.order {
            let plan = &self.plan.objects[object];
            let mut drawn = DrawStats::default();
            let mut counts = Shares::default();
            let pipelines = Pipelines {
                scene,
                plan: &self.plan,
                states: &self.states,
                tables: &self.tables,
                kernel: self.settings.kernel,
            };
            if self.settings.vertex_path == VertexPath::Integer {
                let mut batched = Batched { clips: true, raster: &mut raster, batch: &mut batch, drawn: &mut drawn };
                let mut plain = |vertices: &[Vertex; 3], interpolation| batched.triangle(vertices, interpolation);
                self.integer.triangles(stats.shading, (object, &scene.objects()[object]), stats, &mut plain);
                batched.draw();
            } else if let Some(faces) = self.states[object].faces(&scene.objects()[object], plan) {
                let (raster, batch, drawn) = (&mut raster, &mut batch, &mut drawn);
                let effects = BatchedEffects::new(&mut self.effects, &pipelines, object);
                let transparent = &mut self.transparent;
                let batched = Batched { clips: plan.is_on(Effect::ScreenClipping), raster, batch, drawn };
                let mut sink = ImmediateSink::new(batched, effects, transparent);
                counts = faces.draw(self.states[object].budget(), stats, &mut sink);
                sink.finish();
            }
            self.states[object].counts = counts;
            stats.raster += drawn;
        }
        if self.plan.is_on_anywhere(Effect::Transparency) {
            self.draw_transparent(scene, stats, &mut raster);
        }
    }

    /// Faces that shine through, far to near, over all others.
    fn draw_transparent(&mut self, scene: &Scene, stats: &mut Stats, raster: &mut Raster<'_>) {
        if self.transparent.is_empty() {
            return;
        }
        self.far_to_near.clear();
        self.far_to_near.reserve(self.transparent.capacity());
        far_to_near(self.transparent.iter().map(DeferredFace::depth), &mut self.far_to_near);
        let pipelines = Pipelines {
            scene,
            plan: &self.plan,
            states: &self.states,
            tables: &self.tables,
            kernel: self.settings.kernel,
        };
        let mut batched = BatchedEffects::new(&mut self.effects, &pipelines, 0);
        for &(_, place) in &self.far_to_near {
            let DeferredFace { vertices, attributes, of } = &self.transparent[place];
            batched.push((vertices, attributes, *of), raster, &mut stats.raster);
        }
        batched.draw(true, raster, &mut stats.raster);
        self.transparent.clear();
    }

    /// Hands every face to `triangle`.
    pub(super) fn faces(
        &mut self,
        scene: &Scene,
        stats: &mut Stats,
        triangle: &mut dyn FnMut(&[Vertex; 3], Interpolation),
    ) {
        for &object in &self.plan.order {
            let mut counts = Shares::default();
            if self.settings.vertex_path == VertexPath::Integer {
                self.integer.triangles(stats.shading, (object, &scene.objects()[object]), stats, triangle);
            } else if let Some(faces) = self.states[object].faces(&scene.objects()[object], &self.plan.objects[object])
            {
                let mut sink = ForEachSink(&mut *triangle);
                counts = faces.draw(self.states[object].budget(), stats, &mut (&mut sink as &mut dyn Sink));
            }
            self.states[object].counts = counts;
        }
    }

    /// Keeps every face for when all are known.
    fn gather(&mut self, scene: &Scene, stats: &mut Stats, culler: Culler) {
        self.triangles.clear();
        self.kept_places.clear();
        self.kept.clear();
        self.transparent.clear();
        self.triangles.reserve(self.most_faces(scene, |_, _| true));
        self.kept_places.reserve(self.triangles.capacity());
        self.kept.reserve(self.most_faces(scene, |_, state| state.may_have_effects()));
        self.transparent.reserve(self.most_faces(scene, |plan, _| plan.is_on(Effect::Transparency)));
        for &object in &self.plan.order {
            let mut counts = Shares::default();
            if self.settings.vertex_path == VertexPath::Integer {
                let mut plain = |vertices: &[Vertex; 3], interpolation| {
                    self.triangles.push((*vertices, interpolation));
                    self.kept_places.push(None);
                };
                self.integer.triangles(stats.shading, (object, &scene.objects()[object]), stats, &mut plain);
            } else if let Some(faces) = self.states[object].faces(&scene.objects()[object], &self.plan.objects[object])
            {
                let pipelines = Pipelines {
                    scene,
                    plan: &self.plan,
                    states: &self.states,
                    tables: &self.tables,
                    kernel: self.settings.kernel,
                };
                let mut sink = DeferredSink {
                    triangles: &mut self.triangles,
                    places: &mut self.kept_places,
                    kept: &mut self.kept,
                    transparent: &mut self.transparent,
                    looks: &pipelines,
                    object,
                    culler,
                };
                counts = faces.draw(self.states[object].budget(), stats, &mut (&mut sink as &mut dyn Sink));
            }
            self.states[object].counts = counts;
        }
    }

    /// Faces of the objects of which `counts` holds, whether they are seen in this frame or in one to come: room for
    /// so many is enough until a plane cuts some in parts.
    fn most_faces(&self, scene: &Scene, counts: impl Fn(&ObjectPlan, &ObjectState) -> bool) -> usize {
        let objects = scene.objects().iter().zip(&self.states).zip(self.plan.objects());
        let counted = objects.filter(|((_, state), plan)| counts(plan, state));
        counted.map(|((object, state), _)| state.most_faces(object)).sum()
    }

    /// Far to near, each over what is there.
    fn painter(&mut self, scene: &Scene, stats: &mut Stats, raster: &mut Raster<'_>) {
        let pipelines = Pipelines {
            scene,
            plan: &self.plan,
            states: &self.states,
            tables: &self.tables,
            kernel: self.settings.kernel,
        };
        self.far_to_near.clear();
        self.far_to_near.reserve(self.triangles.capacity());
        far_to_near(self.triangles.iter().map(|(vertices, _)| depth_of(vertices)), &mut self.far_to_near);
        let mut batch = Batch::of_culled();
        let mut batched = Batched { clips: true, raster, batch: &mut batch, drawn: &mut stats.raster };
        let mut effects = BatchedEffects::new(&mut self.effects, &pipelines, 0);
        for &(_, i) in &self.far_to_near {
            let (vertices, interpolation) = &self.triangles[i];
            // One of both is always empty: faces are drawn in this order.
            let Some(place) = self.kept_places[i] else {
                effects.draw(true, batched.raster, batched.drawn);
                batched.triangle(vertices, *interpolation);
                continue;
            };
            batched.draw();
            let face = &self.kept[place as usize];
            effects.push((vertices, &face.attributes, face.of), batched.raster, batched.drawn);
        }
        batched.draw();
        effects.draw(true, batched.raster, batched.drawn);
    }

    /// All at once, each pixel once.
    fn scan_line(&mut self, scene: &Scene, stats: &mut Stats, raster: &mut Raster<'_>) {
        let pipelines = Pipelines {
            scene,
            plan: &self.plan,
            states: &self.states,
            tables: &self.tables,
            kernel: self.settings.kernel,
        };
        self.lists.reserve(self.triangles.capacity());
        let scratch = self.lists.scratch(self.triangles.len());
        let (places, kept, effects) = (&self.kept_places, &self.kept, &mut self.effects);
        // There is room for all.
        stats.raster += raster
            .scan_line_with(&self.triangles, scratch, |i, row, pixels, kernel, drawn| {
                let Some(face) = places[i].and_then(|place| kept.get(place as usize)) else { return false };
                pipelines.with(face.of, |pipeline| {
                    effects.paint_row((&face.vertices, &face.attributes), pipeline, row, pixels, kernel, drawn);
                    DrawStats::default()
                });
                true
            })
            .unwrap_or_default();
    }
}
