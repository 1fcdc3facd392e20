//! The stage of an object's faces within an error budget: each is drawn by the shading that is decided for it.

use super::Stats;
use super::budget::{Budget, Choice, Decided, Settled, WORTH_CURVE, WORTH_SAMPLES};
use super::clip::WithEffects;
use super::cull;
use super::face::{Sink, is_turned_away};
use super::faces::Faces;
use super::lit::Face;
use super::vertex::Geometry;
use crate::raster::Vertex;
use crate::raster::clip::doubled_area;
use crate::raster::effects::Attributes;
use crate::scene::Shading;

/// Shading of linear faces within a budget.
const LINEAR_SHADING: Shading = Shading::Gouraud88Reseeded;

/// Faces of a chunk that are tried in a row in vain until only large ones are.
const TRIES: u32 = 3;

/// Pixels from which on such a face is tried.
const SMALL: u64 = 64;

/// Pixels from which on a face is tried by more points than the fewest.
const LARGE: u64 = 192;

impl Faces<'_> {
    /// Hands on every face, with effects or without, by the shading that is decided for it. Every shading that there is
    /// a choice of has exact cover. Nothing is decided on a face that covers no pixel centre.
    #[inline(never)]
    pub(super) fn each_within<const CULLS: bool, const EFFECTS: bool>(
        &self,
        (budget, decided): (&Budget, &mut Decided),
        stats: &mut Stats,
        sink: &mut impl Sink,
    ) {
        let Geometry { triangles, triangle_surfaces, .. } = self.geometry;
        let culler = sink.culler();
        let mut linear = 0;
        let mut queue = self.queue::<EFFECTS>(sink, LINEAR_SHADING.interpolation());
        for (chunk, triangles) in triangles.chunks(cull::CHUNK).enumerate() {
            let first = chunk * cull::CHUNK;
            let surfaces = &triangle_surfaces[first..];
            let (masks, mut left) = self.cull::<CULLS>(culler.as_ref(), true, (chunk, triangles), stats);
            let here = left & !masks.clipped;
            let sides = (first, if CULLS { 0 } else { masks.back });
            let Settled { linear: settled, hopeless, hopeless_if_small } = self.settled(budget, sides, decided, here);
            linear += u64::from(settled.count_ones());
            if let (Some((queue, indexed)), Some(culler)) = (&mut queue, &culler) {
                if settled == left {
                    queue.add(sides, left, culler.kernel);
                    if let Some(whole) = queue.whole() {
                        sink.indexed(indexed, whole, LINEAR_SHADING.interpolation());
                        queue.take_whole();
                    }
                    continue;
                }
                // In the order of their numbers.
                sink.indexed(indexed, queue.all(), LINEAR_SHADING.interpolation());
                queue.clear();
            }
            if left == 0 {
                continue;
            }
            let choices = decided.of_chunk(chunk);
            let mut in_vain = 0;
            while left != 0 {
                let at = left.trailing_zeros() as usize;
                left &= left - 1;
                let (indices, surface) = (triangles[at], surfaces[at]);
                let is = |bits: u64| bits >> at & 1 == 1;
                let turned = !CULLS && is(masks.back);
                if is(settled) {
                    let vertices = indices.map(|i| self.lit.vertex(i as usize, turned));
                    if EFFECTS && self.paints[usize::from(surface)].has_effects {
                        let attributes = indices.map(|i| self.extras[i as usize].side(turned));
                        sink.with_effects((first + at) as u32, &vertices, &attributes, surface, LINEAR_SHADING.into());
                    } else {
                        // With a budget a face may be lit at its pixels in any object.
                        sink.after_effects();
                        // Fewer than 2³² faces.
                        sink.plain((first + at) as u32, &vertices, LINEAR_SHADING.interpolation());
                    }
                    continue;
                }
                // Fewer than 2³² faces.
                let face = Face { index: (first + at) as u32, indices, surface, back_facing: turned };
                let choice = &mut choices[at];
                if is(masks.clipped) && (CULLS || !is(self.twins_of(chunk))) {
                    self.clipped_within::<CULLS, EFFECTS>(face, (budget, choice), stats, sink);
                } else if is(masks.clipped) {
                    self.clipped_within::<true, EFFECTS>(face, (budget, choice), stats, sink);
                } else {
                    let hopeless = (is(hopeless), is(hopeless_if_small), &mut in_vain);
                    self.one_within::<EFFECTS>(face, (budget, choice), hopeless, stats, sink);
                }
            }
        }
        if let Some((queue, indexed)) = &queue {
            sink.indexed(indexed, queue.all(), LINEAR_SHADING.interpolation());
        }
        stats.shares.add(LINEAR_SHADING.into(), linear);
    }

    /// A face that bounds alone do not make linear.
    #[inline(never)]
    fn one_within<const EFFECTS: bool>(
        &self,
        face: Face,
        (budget, choice): (&Budget, &mut Choice),
        (hopeless, hopeless_if_small, in_vain): (bool, bool, &mut u32),
        stats: &mut Stats,
        sink: &mut impl Sink,
    ) {
        let Face { index, indices, surface, back_facing: turned } = face;
        let vertices = indices.map(|i| self.lit.vertex(i as usize, turned));
        if *choice == Choice::Unknown {
            // Points of a tiny one would be more than its pixels.
            let worth = match (hopeless, hopeless_if_small) {
                (true, _) => LARGE,
                _ if *in_vain >= TRIES => SMALL,
                (_, true) => WORTH_CURVE,
                _ => WORTH_SAMPLES,
            };
            if self.lights_pixels && is_smaller(&vertices, worth) {
                *choice = Choice::Phong;
            } else {
                *choice = self.fit(budget, face, &vertices);
                *in_vain = if *choice == Choice::Phong { *in_vain + 1 } else { 0 };
            }
        }
        let choice = *choice;
        stats.shares.add(choice.shading(), 1);
        if (EFFECTS && self.paints[usize::from(surface)].has_effects) || choice.needs_light() {
            let mut attributes = self.attributes::<EFFECTS>(indices, turned, choice);
            if choice == Choice::Curved {
                self.put_curve(&mut attributes, face, &vertices);
            }
            sink.with_effects(face.index, &vertices, &attributes, surface, choice.shading());
        } else {
            sink.after_effects();
            sink.plain(index, &vertices, choice.shading().interpolation());
        }
    }

    /// A face that reaches beyond the near plane or the guard band, shaded by choice. Otherwise like
    /// [`clipped`](Self::clipped).
    #[cold]
    #[inline(never)]
    fn clipped_within<const CULLS: bool, const EFFECTS: bool>(
        &self,
        face: Face,
        (budget, choice): (&Budget, &mut Choice),
        stats: &mut Stats,
        sink: &mut impl Sink,
    ) {
        let Face { indices, surface, .. } = face;
        let corners = &indices.map(|i| self.lit.get(i as usize));
        let at = indices.map(|i| self.view.homogeneous(self.geometry.positions[i as usize]));
        let turned = !CULLS && is_turned_away(&at);
        let face = Face { back_facing: turned, ..face };
        if *choice == Choice::Unknown {
            *choice = self.decide_clipped(budget, face);
        }
        let (choice, before) = (*choice, stats.drawn);
        let interpolation = choice.shading().interpolation();
        if (EFFECTS && self.paints[usize::from(surface)].has_effects) || choice.needs_light() {
            let attributes = self.attributes::<EFFECTS>(indices, turned, choice);
            let carried = attributes.map(|attributes| WithEffects { attributes, affine: self.affine });
            self.parts::<CULLS, _>(at, corners, carried, (interpolation, turned), stats, |vertices, carried, _| {
                let attributes = carried.map(|carried| carried.attributes);
                sink.with_effects(face.index, &vertices, &attributes, surface, choice.shading());
            });
        } else {
            sink.after_effects();
            self.parts::<CULLS, _>(at, corners, [(); 3], (interpolation, turned), stats, |vertices, _, _| {
                sink.plain(face.index, &vertices, interpolation);
            });
        }
        stats.shares.add(choice.shading(), stats.drawn - before);
    }

    /// Attributes of the corners of a face that is shaded by choice.
    #[inline]
    fn attributes<const EFFECTS: bool>(&self, indices: [u32; 3], turned: bool, choice: Choice) -> [Attributes; 3] {
        indices.map(|i| {
            let mut attributes = if EFFECTS { self.extras[i as usize].side(turned) } else { Attributes::default() };
            if choice.needs_light() {
                let (normal, position) = (self.geometry.normals[i as usize], self.geometry.positions[i as usize]);
                let normal = if turned { -normal } else { normal };
                attributes.lit = [normal.x, normal.y, normal.z, position.x, position.y, position.z];
            }
            attributes
        })
    }
}

/// Returns whether a triangle has fewer pixels.
fn is_smaller(vertices: &[Vertex; 3], pixels: u64) -> bool {
    // Twice, in 1/256 pixel.
    doubled_area(vertices).unsigned_abs() < pixels * 131_072
}
