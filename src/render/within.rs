//! The stage of an object's faces within an error budget: each is drawn by the shading that is decided for it.

use super::Stats;
use super::budget::{Bodies, Budget, Choice, Decided, Question, Vain, WORTH_SAMPLES};
use super::clip::WithEffects;
use super::face::{Face, Sink, is_turned_away};
use super::faces::Faces;
use super::sift;
use super::vertex::Geometry;
use crate::fixed::U8F8;
use crate::raster::clip::doubled_area;
use crate::raster::effects::Attributes;
use crate::raster::{Interpolation, Vertex};
use crate::scene::Shading;

/// Shading of linear faces within a budget.
const LINEAR_SHADING: Shading = Shading::Gouraud88Reseeded;

/// In pixels.
const SMALL: u64 = 64;

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
        let sieve = sink.sieve();
        let (mut linear, mut vain) = (0, Vain::default());
        let mut listed = self.listed::<EFFECTS>(sink, LINEAR_SHADING.interpolation());
        for (chunk, triangles) in triangles.chunks(sift::MOST).enumerate() {
            let first = chunk * sift::MOST;
            let surfaces = &triangle_surfaces[first..];
            let (sifted, mut left) = self.sift::<CULLS>(sieve.as_ref(), true, (chunk, triangles), stats);
            let here = left & !sifted.clipped;
            let sides = (first, if CULLS { 0 } else { sifted.back });
            let (settled, hopeless) = self.settled((budget, &mut vain), sides, decided, here);
            linear += u64::from(settled.count_ones());
            if let (Some((listed, numbered)), Some(sieve)) = (&mut listed, &sieve) {
                if settled == left {
                    listed.add(sides, left, sieve.kernel);
                    if let Some(whole) = listed.whole() {
                        sink.numbered(numbered, whole, LINEAR_SHADING.interpolation());
                        listed.take_whole();
                    }
                    continue;
                }
                // In the order of their numbers.
                sink.numbered(numbered, listed.all(), LINEAR_SHADING.interpolation());
                listed.clear();
            }
            if left == 0 {
                continue;
            }
            let (choices, bodies) = decided.of_chunk(chunk);
            while left != 0 {
                let at = left.trailing_zeros() as usize;
                left &= left - 1;
                let (indices, surface) = (triangles[at], surfaces[at]);
                let is = |bits: u64| bits >> at & 1 == 1;
                let turned = !CULLS && is(sifted.back);
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
                let (choice, known) = (&mut choices[at], &mut bodies[at]);
                if is(sifted.clipped) && (CULLS || !is(self.twins_of(chunk))) {
                    self.clipped_within::<CULLS, EFFECTS>(face, (budget, choice, known), stats, sink);
                } else if is(sifted.clipped) {
                    self.clipped_within::<true, EFFECTS>(face, (budget, choice, known), stats, sink);
                } else {
                    self.one_within::<EFFECTS>(face, (budget, choice, known), (&mut vain, is(hopeless)), stats, sink);
                }
            }
        }
        if let Some((listed, numbered)) = &listed {
            sink.numbered(numbered, listed.all(), LINEAR_SHADING.interpolation());
        }
        stats.shares.add(LINEAR_SHADING.into(), linear);
    }

    /// A face that its cluster says nothing of.
    #[inline(never)]
    fn one_within<const EFFECTS: bool>(
        &self,
        face: Face,
        (budget, choice, known): (&Budget, &mut Choice, &mut Bodies),
        (vain, hopeless): (&mut Vain, bool),
        stats: &mut Stats,
        sink: &mut impl Sink,
    ) {
        let Face { index, indices, surface, back_facing: turned } = face;
        if *choice == Choice::Unknown && budget.is_simple() {
            *choice =
                budget.decide_at_once((index as usize, indices, surface, turned), self.lit, self.geometry.normals);
        }
        let vertices = indices.map(|i| self.lit.vertex(i as usize, turned));
        if *choice == Choice::Unknown {
            // Points of a tiny one would be more than its pixels.
            let in_vain = hopeless && self.lights_pixels && is_smaller(&vertices, WORTH_SAMPLES);
            *choice = if in_vain {
                vain.decided(Choice::Phong)
            } else if is_smaller(&vertices, SMALL) && vain.is_it() {
                Choice::Phong
            } else {
                let shades = vertices.map(|vertex| vertex.shade());
                vain.decided(self.decide::<EFFECTS>((budget, known), face, (shades, Some(&vertices))))
            };
        }
        let choice = *choice;
        stats.shares.add(choice.shading(), 1);
        if (EFFECTS && self.paints[usize::from(surface)].has_effects) || choice.needs_light() {
            let mut attributes = self.attributes::<EFFECTS>(indices, turned, choice);
            if choice == Choice::Curved {
                self.put_curve(&mut attributes, (indices, surface, turned), &vertices);
            }
            hand_on_within(face, (vertices, attributes), choice, sink);
        } else {
            sink.after_effects();
            sink.plain(index, &vertices, choice.interpolation(&vertices));
        }
    }

    /// A face that reaches beyond the near plane or the guard band, shaded by choice. Otherwise like
    /// [`clipped`](Self::clipped).
    #[cold]
    #[inline(never)]
    fn clipped_within<const CULLS: bool, const EFFECTS: bool>(
        &self,
        face: Face,
        (budget, choice, known): (&Budget, &mut Choice, &mut Bodies),
        stats: &mut Stats,
        sink: &mut impl Sink,
    ) {
        let Face { indices, surface, .. } = face;
        let corners = &indices.map(|i| self.lit.get(i as usize));
        let at = indices.map(|i| self.view.homogeneous(self.geometry.positions[i as usize]));
        let turned = !CULLS && is_turned_away(&at);
        let face = Face { back_facing: turned, ..face };
        if *choice == Choice::Unknown {
            let shades = corners.map(|corner| if turned { corner.back } else { corner.vertex.shade() });
            *choice = self.decide::<EFFECTS>((budget, known), face, (shades, None));
        }
        let (choice, before) = (*choice, stats.drawn);
        let interpolation = choice.shading().interpolation();
        if (EFFECTS && self.paints[usize::from(surface)].has_effects) || choice.needs_light() {
            let attributes = self.attributes::<EFFECTS>(indices, turned, choice);
            let carried = attributes.map(|attributes| WithEffects { attributes, affine: self.affine });
            self.parts::<CULLS, _>(at, corners, carried, (interpolation, turned), stats, |vertices, carried, _| {
                let attributes = carried.map(|carried| carried.attributes);
                hand_on_within(face, (vertices, attributes), choice, sink);
            });
        } else {
            sink.after_effects();
            self.parts::<CULLS, _>(at, corners, [(); 3], (interpolation, turned), stats, |vertices, _, _| {
                sink.plain(face.index, &vertices, choice.interpolation(&vertices));
            });
        }
        stats.shares.add(choice.shading(), stats.drawn - before);
    }

    /// Decides on a face on which nothing was known at once.
    #[inline(never)]
    fn decide<const EFFECTS: bool>(
        &self,
        (budget, known): (&Budget, &mut Bodies),
        Face { index, indices, surface, back_facing: turned }: Face,
        (shades, vertices): ([U8F8; 3], Option<&[Vertex; 3]>),
    ) -> Choice {
        let shades = if EFFECTS && self.channels {
            indices.map(|i| self.extras[i as usize].side(turned).channels.map(U8F8::to_bits))
        } else {
            shades.map(|shade| [shade.to_bits(); 3])
        };
        let question = Question { triangle: index as usize, indices, surface, turned, shades, vertices };
        self.cheapest_within(budget, &question, known)
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

/// Returns whether a triangle has fewer pixels. Lighting each of [`SMALL`] costs no more than a few questions about it.
fn is_smaller(vertices: &[Vertex; 3], pixels: u64) -> bool {
    // Twice, in 1/256 pixel.
    doubled_area(vertices).unsigned_abs() < pixels * 131_072
}

/// Hands on a face with effects that is shaded by choice. Every corner of a flat one gets the shade in the middle.
fn hand_on_within(
    face: Face,
    (mut vertices, mut attributes): ([Vertex; 3], [Attributes; 3]),
    choice: Choice,
    sink: &mut impl Sink,
) {
    let mut shading = choice.shading();
    if choice == Choice::Flat {
        let shade = middle(vertices.map(|vertex| vertex.shade()));
        vertices = vertices.map(|vertex| vertex.with_shade(shade));
        let [a, b, c] = attributes.map(|corner| corner.channels);
        let channels = [0, 1, 2].map(|channel| middle([a[channel], b[channel], c[channel]]));
        attributes.iter_mut().for_each(|corner| corner.channels = channels);
        shading = LINEAR_SHADING.into();
    }
    sink.with_effects(face.index, &vertices, &attributes, face.surface, shading);
}

/// Half-way between the least and the greatest.
fn middle([a, b, c]: [U8F8; 3]) -> U8F8 {
    let (least, most) = (a.min(b).min(c).to_bits(), a.max(b).max(c).to_bits());
    U8F8::from_bits(least + (most - least) / 2)
}

impl Choice {
    /// Interpolation of a face without effects in the raster.
    #[inline]
    fn interpolation(self, vertices: &[Vertex; 3]) -> Interpolation {
        match self {
            Self::Flat => Interpolation::Flat(middle(vertices.map(|vertex| vertex.shade())).nearest()),
            choice => choice.shading().interpolation(),
        }
    }
}
