//! The stage of an object's faces: each picks its vertices, is clipped where it must be and left out
//! where it is a back face.
//!
//! The plan's decisions for the object are constants of the loop: a loop that needs no clipping has no
//! test for it.

use super::Stats;
use super::budget::Budget;
use super::clip::{Carried, Corner, WithEffects, clip};
use super::cull::face_queue::FaceQueue;
use super::cull::{self, CullMasks, Culler};
use super::faces::Faces;
use super::lit::{Face, LitVertex, ShadedVertices};
use super::paint::SurfaceMaterial;
use super::stats::Shares;
use super::vertex::Geometry;
use crate::fixed::U8F8;
use crate::lanes::three;
use crate::light::both_sides;
use crate::mesh::normals::face_normal;
use crate::plan::FaceShading;
use crate::raster::batch::indexed::{BACK_FACE, IndexedTriangles};
use crate::raster::effects::Attributes;
use crate::raster::{Interpolation, Vertex};
use crate::view::Homogeneous;

/// Takes faces as they are to be drawn, each with its index in the mesh or in what splitting made of it. The parts of a face
/// that is clipped have the face's index.
pub(super) trait Sink {
    /// A face without effects.
    fn plain(&mut self, face: u32, vertices: &[Vertex; 3], interpolation: Interpolation);
    /// A face whose pixels pass through stages, the number of its surface, and what shades it.
    fn with_effects(
        &mut self,
        face: u32,
        vertices: &[Vertex; 3],
        attributes: &[Attributes; 3],
        surface: u16,
        shading: FaceShading,
    );
    /// A face without effects comes next, in an object some of whose faces have them.
    fn after_effects(&mut self) {}
    /// Culling of faces that cover no pixel centre, if there is any.
    fn culler(&self) -> Option<Culler> {
        None
    }
    /// Returns whether it takes faces without effects by their numbers, too.
    fn takes_numbers(&self, _: Interpolation) -> bool {
        false
    }
    /// Faces without effects, none of which needs clipping, by their numbers and sides.
    fn indexed(&mut self, _: &IndexedTriangles<'_>, _: &[u32], _: Interpolation) {}
}

/// Where speed does not count, the stages are compiled once for all sinks.
impl Sink for &mut dyn Sink {
    fn plain(&mut self, face: u32, vertices: &[Vertex; 3], interpolation: Interpolation) {
        (**self).plain(face, vertices, interpolation);
    }

    fn with_effects(
        &mut self,
        face: u32,
        vertices: &[Vertex; 3],
        attributes: &[Attributes; 3],
        surface: u16,
        shading: FaceShading,
    ) {
        (**self).with_effects(face, vertices, attributes, surface, shading);
    }

    fn after_effects(&mut self) {
        (**self).after_effects();
    }

    fn culler(&self) -> Option<Culler> {
        (**self).culler()
    }

    fn takes_numbers(&self, interpolation: Interpolation) -> bool {
        (**self).takes_numbers(interpolation)
    }

    fn indexed(&mut self, from: &IndexedTriangles<'_>, numbers: &[u32], interpolation: Interpolation) {
        (**self).indexed(from, numbers, interpolation);
    }
}

impl Faces<'_> {
    /// Hands the faces that are to be drawn to `sink`. With a budget each is decided on; returns the counts of that.
    pub(super) fn draw(&self, budget: Option<&Budget>, stats: &mut Stats, sink: &mut impl Sink) -> Shares {
        let mut counts = Shares::default();
        stats.faces += self.geometry.triangles.len() as u64;
        let effects = !self.extras.is_empty();
        if let Some(budget) = budget {
            match (self.culls, effects) {
                (false, false) => self.each_within::<false, false>(budget, &mut counts, stats, sink),
                (true, false) => self.each_within::<true, false>(budget, &mut counts, stats, sink),
                (false, true) => self.each_within::<false, true>(budget, &mut counts, stats, sink),
                (true, true) => self.each_within::<true, true>(budget, &mut counts, stats, sink),
            }
            return counts;
        }
        let before = stats.drawn;
        match (self.culls, effects) {
            (false, false) => self.each::<false, false>(stats, sink),
            (true, false) => self.each::<true, false>(stats, sink),
            (false, true) => self.each::<false, true>(stats, sink),
            (true, true) => self.each::<true, true>(stats, sink),
        }
        stats.shares.add(self.shading.into(), stats.drawn - before);
        counts
    }

    /// Finds those of a chunk of up to 64 triangles that lie back to back with others.
    #[inline]
    pub(super) fn twins_of(&self, chunk: usize) -> u64 {
        self.twins.get(chunk).copied().unwrap_or(0)
    }

    /// Finds the faces to be drawn among up to 64, those that need clipping included. A face that covers no pixel
    /// centre is left out where it would draw nothing (a shading with a cover of its own draws beside them), though it
    /// counts as drawn.
    #[inline]
    pub(super) fn cull<const CULLS: bool>(
        &self,
        culler: Option<&Culler>,
        exact_cover: bool,
        (chunk, triangles): (usize, &[[u32; 3]]),
        stats: &mut Stats,
    ) -> (CullMasks, u64) {
        let masks = culler.unwrap_or(&Culler::EVERYTHING).cull(&self.lit.places, triangles, CULLS);
        let drawn = if CULLS { masks.front } else { masks.front | (masks.back & !self.twins_of(chunk)) };
        let (drawn_here, clipped) = (u64::from(drawn.count_ones()), u64::from(masks.clipped.count_ones()));
        stats.drawn += drawn_here;
        stats.clipped += clipped;
        stats.culled += triangles.len() as u64 - drawn_here - clipped;
        let covers = if culler.is_some() && exact_cover { masks.covers } else { !0 };
        (masks, (drawn & covers) | masks.clipped)
    }

    #[inline(never)]
    fn each<const CULLS: bool, const EFFECTS: bool>(&self, stats: &mut Stats, sink: &mut impl Sink) {
        let Geometry { triangles, triangle_surfaces, .. } = self.geometry;
        let (culler, exact_cover) = (sink.culler(), self.shading.interpolation().has_exact_cover());
        let one_shading = exact_cover && self.runs && !self.lit_by_face;
        let mut queue = if one_shading { self.queue::<EFFECTS>(sink, self.shading.interpolation()) } else { None };
        let chunks = triangles.chunks(cull::CHUNK).zip(triangle_surfaces.chunks(cull::CHUNK));
        for (chunk, (triangles, surfaces)) in chunks.enumerate() {
            let (masks, mut left) = self.cull::<CULLS>(culler.as_ref(), exact_cover, (chunk, triangles), stats);
            if let (Some((queue, indexed)), Some(culler)) = (&mut queue, &culler) {
                if masks.clipped == 0 {
                    let sides = (chunk * cull::CHUNK, if CULLS { 0 } else { masks.back });
                    queue.add(sides, left, culler.kernel);
                    if let Some(whole) = queue.whole() {
                        sink.indexed(indexed, whole, self.shading.interpolation());
                        queue.take_whole();
                    }
                    continue;
                }
                // In the order of their numbers.
                sink.indexed(indexed, queue.all(), self.shading.interpolation());
                queue.clear();
            }
            while left != 0 {
                let at = left.trailing_zeros() as usize;
                left &= left - 1;
                let (indices, surface) = (triangles[at], surfaces[at]);
                let is = |bits: u64| bits >> at & 1 == 1;
                let back_facing = !CULLS && is(masks.back);
                // Fewer than 2³² faces.
                let index = (chunk * cull::CHUNK + at) as u32;
                let face = Face { index, indices, surface, back_facing };
                if is(masks.clipped) {
                    let corners = three(indices, |i| self.lit.get(i as usize));
                    let culls = CULLS || is(self.twins_of(chunk));
                    self.clipped((culls, EFFECTS), face, &corners, stats, sink);
                    continue;
                }
                let vertices = three(indices, |i| self.lit.vertex(i as usize, back_facing));
                if EFFECTS && self.paints[usize::from(surface)].has_effects {
                    let attributes = three(indices, |i| self.extras[i as usize].side(back_facing));
                    self.hand_on(face, (vertices, attributes), stats, sink);
                } else {
                    let interpolation = self.interpolation(face, stats);
                    if EFFECTS {
                        sink.after_effects();
                    }
                    sink.plain(index, &vertices, interpolation);
                }
            }
        }
        if let Some((queue, indexed)) = &queue {
            sink.indexed(indexed, queue.all(), self.shading.interpolation());
        }
    }

    /// A list for the numbers of faces, if that is how they are handed on: those without effects, of one shading.
    pub(super) fn queue<const EFFECTS: bool>(
        &self,
        sink: &impl Sink,
        interpolation: Interpolation,
    ) -> Option<(FaceQueue, IndexedTriangles<'_>)> {
        let ShadedVertices { places, depths, shades, .. } = self.lit;
        let triangles = self.geometry.triangles;
        let plain = !EFFECTS || self.paints.iter().all(|paint| !paint.has_effects);
        let takes = plain && sink.takes_numbers(interpolation);
        let fits = triangles.len() < BACK_FACE as usize;
        (takes && fits).then_some((FaceQueue::new(), IndexedTriangles { places, depths, shades, triangles }))
    }

    /// A face that reaches beyond the near plane or the guard band. Kept apart: it is rare, and compiled once for all
    /// loops.
    #[cold]
    #[inline(never)]
    fn clipped(
        &self,
        (culls, effects): (bool, bool),
        face: Face,
        corners: &[LitVertex; 3],
        stats: &mut Stats,
        sink: &mut dyn Sink,
    ) {
        let Face { indices, surface, .. } = face;
        let at = three(indices, |i| self.view.homogeneous(self.geometry.positions[i as usize]));
        let back_facing = !culls && is_turned_away(&at);
        let face = Face { back_facing, ..face };
        let sides = |interpolation| (interpolation, back_facing);
        if effects && self.paints[usize::from(surface)].has_effects {
            let attributes = |i: u32| self.extras[i as usize].side(back_facing);
            let carried = three(indices, |i| WithEffects { attributes: attributes(i), affine: self.affine });
            let interpolation = self.shading.interpolation();
            self.parts(culls, at, corners, carried, sides(interpolation), stats, |vertices, carried, stats| {
                let attributes = three(carried, |carried| carried.attributes);
                self.hand_on(face, (vertices, attributes), stats, sink);
            });
        } else {
            let interpolation = self.interpolation(face, stats);
            if effects {
                sink.after_effects();
            }
            self.parts(culls, at, corners, [(); 3], sides(interpolation), stats, |vertices, _, _| {
                sink.plain(face.index, &vertices, interpolation)
            });
        }
    }

    /// The triangles that clipping leaves.
    #[expect(clippy::too_many_arguments, reason = "what a face is, and what its parts go to")]
    pub(super) fn parts<C: Carried>(
        &self,
        culls: bool,
        at: [Homogeneous; 3],
        corners: &[LitVertex; 3],
        carried: [C; 3],
        (interpolation, turned): (Interpolation, bool),
        stats: &mut Stats,
        mut part: impl FnMut([Vertex; 3], [C; 3], &mut Stats),
    ) {
        let corner = |i: usize| {
            let LitVertex { vertex, back, needs_clipping, .. } = corners[i];
            let shade = if turned { back } else { vertex.shade() };
            let projected = (!needs_clipping).then(|| vertex.with_shade(shade));
            Corner { at: at[i], shade: f64::from(shade.to_bits()), vertex: projected, carried: carried[i] }
        };
        let Some((polygon, carried)) = clip(self.view, interpolation, [corner(0), corner(1), corner(2)]) else {
            return;
        };
        let area = polygon.doubled_area();
        if area == 0 || (culls && area > 0) {
            stats.culled += 1;
            return;
        }
        for places in polygon.part_corners() {
            stats.drawn += 1;
            part(polygon.triangle(places), places.map(&carried), stats);
        }
    }

    /// Hands on a face with effects; its one shade, where it has but one, is put into its corners here.
    fn hand_on(
        &self,
        face: Face,
        (mut vertices, mut attributes): ([Vertex; 3], [Attributes; 3]),
        stats: &mut Stats,
        sink: &mut (impl Sink + ?Sized),
    ) {
        if self.lit_by_face {
            stats.lit += 1;
            if self.channels {
                let (centre, normal) = self.middle(face.indices);
                let paint = &self.paints[usize::from(face.surface)];
                let (front, back) = self.lights.three_channels(&paint.answer, centre, normal);
                let channels = SurfaceMaterial::channels(if face.back_facing { back } else { front });
                let channels = three(channels, |channel| paint.respond_on_channel(channel));
                attributes.iter_mut().for_each(|corner| corner.channels = channels);
            } else {
                let shade = self.face_shade(face);
                vertices = three(vertices, |vertex| vertex.with_shade(shade));
            }
        }
        sink.with_effects(face.index, &vertices, &attributes, face.surface, self.shading.into());
    }

    /// Chooses a face's interpolation; its one shade, where it has but one, is worked out here.
    #[inline]
    fn interpolation(&self, face: Face, stats: &mut Stats) -> Interpolation {
        if self.lit_by_face {
            stats.lit += 1;
            return Interpolation::Flat(self.face_shade(face).nearest());
        }
        if !self.runs {
            // All corners have the same, wherever the plan says so.
            let shades = self.lit.shades[face.indices[0] as usize];
            return Interpolation::Flat(shades[usize::from(face.back_facing)].nearest());
        }
        self.shading.interpolation()
    }

    /// The one shade of a face: at its middle, by its own normal.
    fn face_shade(&self, Face { indices, surface, back_facing, .. }: Face) -> U8F8 {
        let (centre, normal) = self.middle(indices);
        let paint = &self.paints[usize::from(surface)];
        let (front, back) = if self.full {
            self.lights.one_channel(&paint.answer, centre, normal)
        } else {
            both_sides(paint.answer.ambient, paint.answer.diffuse, self.lights.suns, normal)
        };
        paint.respond(paint.shade(if back_facing { back } else { front }))
    }

    /// The middle of a face, and its normal.
    fn middle(&self, indices: [u32; 3]) -> (glam::Vec3, glam::Vec3) {
        let [a, b, c] = three(indices, |i| self.geometry.positions[i as usize]);
        // A face without area has no normal; rounded, it may still cover a pixel.
        let normal = face_normal(a, b, c).unwrap_or(self.geometry.normals[indices[0] as usize]);
        // Each third by itself: the sum of three might overflow.
        (a / 3.0 + b / 3.0 + c / 3.0, normal)
    }
}

/// Returns whether the eye is behind the face, wherever its corners are: the sign of the volume
/// between the eye and the three corners.
pub(super) fn is_turned_away(at: &[Homogeneous; 3]) -> bool {
    let [a, b, c] = at;
    let volume = a.w * (b.x * c.y - c.x * b.y) + b.w * (c.x * a.y - a.x * c.y) + c.w * (a.x * b.y - b.x * a.y);
    volume > 0.0
}
