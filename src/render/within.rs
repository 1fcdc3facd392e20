//! The stage of an object's faces within an error budget: each is drawn by the shading that is decided for it.

use super::Stats;
use super::budget::{Budget, FLOAT, Fit, LINEAR};
use super::clip::WithEffects;
use super::cull;
use super::face::{Sink, is_turned_away};
use super::faces::Faces;
use super::lit::Face;
use super::vertex::Geometry;
use crate::lanes::three;
use crate::plan::FaceShading;
use crate::raster::effects::Attributes;
use crate::render::stats::Shares;

impl Faces<'_> {
    /// Hands on every face, with effects or without, by the shading that is decided for it. Every shading that there is
    /// a choice of has exact cover. Nothing is decided on a face that covers no pixel centre.
    #[inline(never)]
    pub(super) fn each_within<const CULLS: bool, const EFFECTS: bool>(
        &self,
        budget: &Budget,
        counts: &mut Shares,
        stats: &mut Stats,
        sink: &mut impl Sink,
    ) {
        let Geometry { triangles, triangle_surfaces, .. } = self.geometry;
        let culler = sink.culler();
        stats.decided += 1;
        let mut linear = 0;
        let mut queue = self.queue::<EFFECTS>(sink, LINEAR.interpolation());
        for (chunk, triangles) in triangles.chunks(cull::CHUNK).enumerate() {
            let first = chunk * cull::CHUNK;
            let surfaces = &triangle_surfaces[first..];
            let (masks, mut left) = self.cull::<CULLS>(culler.as_ref(), true, (chunk, triangles), stats);
            let here = left & !masks.clipped;
            let sides = (first, if CULLS { 0 } else { masks.back });
            let classes = self.classify(budget, sides, here);
            linear += u64::from(classes.linear.count_ones());
            if let (Some((queue, indexed)), Some(culler)) = (&mut queue, &culler) {
                if classes.linear == left {
                    queue.add(sides, left, culler.kernel);
                    if let Some(whole) = queue.whole() {
                        sink.indexed(indexed, whole, LINEAR.interpolation());
                        queue.take_whole();
                    }
                    continue;
                }
                // In the order of their numbers.
                sink.indexed(indexed, queue.all(), LINEAR.interpolation());
                queue.clear();
            }
            while left != 0 {
                let at = left.trailing_zeros() as usize;
                left &= left - 1;
                let (indices, surface) = (triangles[at], surfaces[at]);
                let is = |bits: u64| bits >> at & 1 == 1;
                let turned = !CULLS && is(masks.back);
                if is(classes.linear) {
                    let vertices = three(indices, |i| self.lit.vertex(i as usize, turned));
                    if EFFECTS && self.paints[usize::from(surface)].has_effects {
                        let attributes = three(indices, |i| self.extras[i as usize].side(turned));
                        sink.with_effects((first + at) as u32, &vertices, &attributes, surface, LINEAR);
                    } else {
                        // With a budget a face may be lit at its pixels in any object.
                        sink.after_effects();
                        // Fewer than 2³² faces.
                        sink.plain((first + at) as u32, &vertices, LINEAR.interpolation());
                    }
                    continue;
                }
                // Fewer than 2³² faces.
                let face = Face { index: (first + at) as u32, indices, surface, back_facing: turned };
                let shading = if is(masks.clipped) {
                    let culls = CULLS || is(self.twins_of(chunk));
                    self.clipped_within((culls, EFFECTS), face, budget, stats, sink)
                } else {
                    let error = (!is(classes.float)).then_some(classes.errors[at]);
                    self.one_within::<EFFECTS>(face, (budget, error), stats, sink)
                };
                counts.add(shading, 1);
            }
        }
        if let Some((queue, indexed)) = &queue {
            sink.indexed(indexed, queue.all(), LINEAR.interpolation());
        }
        stats.shares.add(LINEAR, linear);
        counts.add(LINEAR, linear);
    }

    /// A face that bounds alone do not make linear on the screen. `error` is its bound, if it is not linear on the face
    /// either.
    #[inline(never)]
    fn one_within<const EFFECTS: bool>(
        &self,
        face: Face,
        (budget, error): (&Budget, Option<f32>),
        stats: &mut Stats,
        sink: &mut impl Sink,
    ) -> FaceShading {
        let Face { index, indices, surface, back_facing: turned } = face;
        let vertices = three(indices, |i| self.lit.vertex(i as usize, turned));
        let fit = error.map_or(Fit::of(FLOAT), |error| self.fit(budget, (face, error), &vertices));
        let shading = fit.shading;
        stats.shares.add(shading, 1);
        if (EFFECTS && self.paints[usize::from(surface)].has_effects) || shading.lights_pixels() {
            let mut attributes = self.attributes(EFFECTS, indices, turned, shading);
            if shading == FaceShading::Quadratic {
                self.put_curve(&mut attributes, surface, &fit.nodes);
            }
            sink.with_effects(index, &vertices, &attributes, surface, shading);
        } else {
            sink.after_effects();
            sink.plain(index, &vertices, shading.interpolation());
        }
        shading
    }

    /// A face that reaches beyond the near plane or the guard band. Otherwise like [`clipped`](Self::clipped).
    #[cold]
    #[inline(never)]
    fn clipped_within(
        &self,
        (culls, effects): (bool, bool),
        face: Face,
        budget: &Budget,
        stats: &mut Stats,
        sink: &mut dyn Sink,
    ) -> FaceShading {
        let Face { indices, surface, .. } = face;
        let corners = &three(indices, |i| self.lit.get(i as usize));
        let at = three(indices, |i| self.view.homogeneous(self.geometry.positions[i as usize]));
        let turned = !culls && is_turned_away(&at);
        let face = Face { back_facing: turned, ..face };
        let (shading, before) = (self.decide_clipped(budget, face), stats.drawn);
        let interpolation = shading.interpolation();
        if (effects && self.paints[usize::from(surface)].has_effects) || shading.lights_pixels() {
            let attributes = self.attributes(effects, indices, turned, shading);
            let carried = three(attributes, |attributes| WithEffects { attributes, affine: self.affine });
            self.parts(culls, at, corners, carried, (interpolation, turned), stats, |vertices, carried, _| {
                let attributes = three(carried, |carried| carried.attributes);
                sink.with_effects(face.index, &vertices, &attributes, surface, shading);
            });
        } else {
            sink.after_effects();
            self.parts(culls, at, corners, [(); 3], (interpolation, turned), stats, |vertices, _, _| {
                sink.plain(face.index, &vertices, interpolation);
            });
        }
        stats.shares.add(shading, stats.drawn - before);
        shading
    }

    /// Attributes of the corners of a face that is shaded by choice.
    #[inline]
    fn attributes(&self, effects: bool, indices: [u32; 3], turned: bool, shading: FaceShading) -> [Attributes; 3] {
        three(indices, |i| {
            let mut attributes = if effects { self.extras[i as usize].side(turned) } else { Attributes::default() };
            if shading.lights_pixels() {
                let (normal, position) = (self.geometry.normals[i as usize], self.geometry.positions[i as usize]);
                let normal = if turned { -normal } else { normal };
                attributes.lit = [normal.x, normal.y, normal.z, position.x, position.y, position.z];
            }
            attributes
        })
    }
}
