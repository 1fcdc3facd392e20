//! The stage of an object's faces: each picks its vertices, is clipped where it must be and left out
//! where it is turned away.
//!
//! What the plan decides for the object is a constant of the loop: a loop that needs no clipping has no
//! test for it.

use super::Stats;
use super::budget::{Budget, Choice, Decided, Linear, Looked, Question};
use super::clip::{Carried, Corner, WithEffects, clip};
use super::lit::{LitVertex, LitVertices};
use super::paint::Paint;
use super::sift::listed::Listed;
use super::sift::{self, Sieve, Sifted};
use super::vertex::{Extra, Geometry};
use crate::fixed::U8F8;
use crate::light::{Lights, both_sides};
use crate::mesh::normals::face_normal;
use crate::raster::batch::numbered::{Numbered, TURNED};
use crate::raster::clip::doubled_area;
use crate::raster::effects::{Apart, Attributes};
use crate::raster::{Shading, Vertex};
use crate::scene::Rung;
use crate::view::{Homogeneous, ObjectView};

/// How a face with effects is shaded.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Manner {
    pub(super) rung: Rung,
    /// Of a rung that lights pixels.
    pub(super) lit_at: LitAt,
}

/// Where a face takes light whose pixels need some.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) enum LitAt {
    #[default]
    Pixels,
    /// At pixels of a row that lie apart, linear between.
    Every(Apart),
    /// At its corners and the middles of its edges, quadratic between.
    SixPoints,
}

/// Takes faces as they are to be drawn.
pub(super) trait Sink {
    /// A face without effects.
    fn plain(&mut self, vertices: &[Vertex; 3], shading: Shading);
    /// A face whose pixels pass through stages, the number of its surface, and what shades it.
    fn with_effects(&mut self, vertices: &[Vertex; 3], attributes: &[Attributes; 3], surface: u16, manner: Manner);
    /// What faces may be left out by, if any: those that cover no pixel centre.
    fn sieve(&self) -> Option<Sieve> {
        None
    }
    /// Whether it takes faces without effects by their numbers, too.
    fn takes_numbers(&self, _: Shading) -> bool {
        false
    }
    /// Faces without effects, none of which needs clipping, by their numbers and sides.
    fn numbered(&mut self, _: &Numbered<'_>, _: &[u32], _: Shading) {}
}

/// Whether it is in vain to decide on faces one by one: as long as the last [`ENOUGH`] that were decided on have to be lit at
/// each pixel, small ones are, and only every eighth is decided on. Light bends alike on neighbours, and each answer costs
/// some 100 ns. (`still` within 1 shade 1.19 to 1.03 of the time of `phong`.)
#[derive(Clone, Copy, Debug, Default)]
struct Vain {
    in_a_row: u32,
    left_out: u32,
    chunks_left_out: u32,
    /// Faces that bounds were found for by eights, and those that they settled.
    bounded: u32,
    settled: u32,
}

impl Vain {
    /// Whether the next small one is left out.
    fn is_it(&mut self) -> bool {
        if self.in_a_row < ENOUGH || self.left_out == 7 {
            self.left_out = 0;
            return false;
        }
        self.left_out += 1;
        true
    }

    /// Whether the next chunk is left out, where bounds are found for eight at once: after longer, as that takes a tenth as
    /// much for a face, or as long as they settle less than a quarter. (`two-lights` within 2 shades takes 7 % less so, `torus`
    /// within 1 shade 6 %.)
    fn is_chunk(&mut self) -> bool {
        let mostly = self.bounded >= 4 * ENOUGH && self.settled < self.bounded / 4;
        if (self.in_a_row < 4 * ENOUGH && !mostly) || self.chunks_left_out == 3 {
            self.chunks_left_out = 0;
            return false;
        }
        self.chunks_left_out += 1;
        true
    }

    /// Of the last faces that were bounded by eights; those of long ago count less and less.
    fn by_eights(&mut self, bounded: u32, settled: u32) {
        (self.bounded, self.settled) = (self.bounded / 2 + bounded, self.settled / 2 + settled);
        if settled != 0 {
            self.in_a_row = 0;
        }
    }

    fn decided(&mut self, choice: Choice) -> Choice {
        self.in_a_row = if choice == Choice::Phong { self.in_a_row + 1 } else { 0 };
        choice
    }
}

const ENOUGH: u32 = 8;

/// What linear faces are drawn by within a budget.
const LINEAR_RUNG: Rung = Rung::Gouraud88Reseeded;

/// In pixels.
const SMALL: u64 = 64;

/// Pixels from which on it pays to light a face at some points before it is lit at all of them. (With 12 `still` takes 2 % less,
/// and `two-lights` within 2 shades 25 % more.)
pub(super) const WORTH_SAMPLES: u64 = 5;

/// One object in one frame.
pub(super) struct Faces<'a> {
    pub(super) rung: Rung,
    pub(super) geometry: Geometry<'a>,
    pub(super) view: &'a ObjectView,
    pub(super) lights: Lights<'a>,
    /// One for each surface of the mesh.
    pub(super) paints: &'a [Paint],
    pub(super) lit: &'a LitVertices,
    /// As many, if there are effects.
    pub(super) extras: &'a [Extra],
    /// Whether faces that are turned away are left out.
    pub(super) culls: bool,
    /// Whether any light falls on it.
    pub(super) is_lit: bool,
    /// Whether its shades run: else each surface has one.
    pub(super) runs: bool,
    /// Whether there are lamps or highlights.
    pub(super) full: bool,
    /// Whether faces are lit, each on one channel or on three, and not vertices.
    pub(super) flat: bool,
    pub(super) channels: bool,
    /// Whether texture coordinates are linear on the screen.
    pub(super) affine: bool,
    /// Whether pixels may be lit each for itself.
    pub(super) lights_pixels: bool,
    /// What faces are decided on by, if that is done for each.
    pub(super) budget: Option<&'a Budget>,
}

impl Faces<'_> {
    /// Hands the faces that are to be drawn to `sink`. `decided` is what a budget led to, for each face.
    pub(super) fn draw(&self, decided: &mut Decided, stats: &mut Stats, sink: &mut impl Sink) {
        stats.faces += self.geometry.triangles.len() as u64;
        let effects = !self.extras.is_empty();
        if let Some(budget) = self.budget {
            let decided = (budget, decided);
            return match (self.culls, effects) {
                (false, false) => self.each_within::<false, false>(decided, stats, sink),
                (true, false) => self.each_within::<true, false>(decided, stats, sink),
                (false, true) => self.each_within::<false, true>(decided, stats, sink),
                (true, true) => self.each_within::<true, true>(decided, stats, sink),
            };
        }
        let before = stats.drawn;
        match (self.culls, effects) {
            (false, false) => self.each::<false, false>(stats, sink),
            (true, false) => self.each::<true, false>(stats, sink),
            (false, true) => self.each::<false, true>(stats, sink),
            (true, true) => self.each::<true, true>(stats, sink),
        }
        stats.shares.add(self.rung, stats.drawn - before);
    }

    /// Which of up to 64 faces are to be drawn, those that need clipping among them. A face that covers no pixel centre is
    /// left out where it would draw nothing (a shading with a cover of its own draws beside them), though it counts as
    /// drawn.
    #[inline]
    fn sift<const CULLS: bool>(
        &self,
        sieve: Option<&Sieve>,
        exact_cover: bool,
        triangles: &[[u32; 3]],
        stats: &mut Stats,
    ) -> (Sifted, u64) {
        let sifted = sieve.unwrap_or(&Sieve::EVERYTHING).sift(&self.lit.places, triangles, CULLS);
        let drawn = if CULLS { sifted.front } else { sifted.front | sifted.back };
        let (drawn_here, clipped) = (u64::from(drawn.count_ones()), u64::from(sifted.clipped.count_ones()));
        stats.drawn += drawn_here;
        stats.clipped += clipped;
        stats.culled += triangles.len() as u64 - drawn_here - clipped;
        let covers = if sieve.is_some() && exact_cover { sifted.covers } else { !0 };
        (sifted, (drawn & covers) | sifted.clipped)
    }

    #[inline(never)]
    fn each<const CULLS: bool, const EFFECTS: bool>(&self, stats: &mut Stats, sink: &mut impl Sink) {
        let Geometry { triangles, triangle_surfaces, .. } = self.geometry;
        let (sieve, exact_cover) = (sink.sieve(), self.rung.shading().has_exact_cover());
        let one_shading = exact_cover && self.runs && !(self.flat && self.is_lit);
        let mut listed = if one_shading { self.listed::<EFFECTS>(sink, self.rung.shading()) } else { None };
        let chunks = triangles.chunks(sift::MOST).zip(triangle_surfaces.chunks(sift::MOST));
        for (chunk, (triangles, surfaces)) in chunks.enumerate() {
            let (sifted, mut left) = self.sift::<CULLS>(sieve.as_ref(), exact_cover, triangles, stats);
            if let (Some((listed, numbered)), Some(sieve)) = (&mut listed, &sieve) {
                if sifted.clipped == 0 {
                    let sides = (chunk * sift::MOST, if CULLS { 0 } else { sifted.back });
                    listed.add(sides, left, sieve.kernel);
                    if let Some(whole) = listed.whole() {
                        sink.numbered(numbered, whole, self.rung.shading());
                        listed.take_whole();
                    }
                    continue;
                }
                // In the order of their numbers.
                sink.numbered(numbered, listed.all(), self.rung.shading());
                listed.clear();
            }
            while left != 0 {
                let at = left.trailing_zeros() as usize;
                left &= left - 1;
                let (indices, surface) = (triangles[at], surfaces[at]);
                let is = |bits: u64| bits >> at & 1 == 1;
                if is(sifted.clipped) {
                    let corners = indices.map(|i| self.lit.get(i as usize));
                    self.clipped::<CULLS, EFFECTS>(indices, surface, &corners, stats, sink);
                    continue;
                }
                let turned = !CULLS && is(sifted.back);
                let vertices = indices.map(|i| self.lit.vertex(i as usize, turned));
                if EFFECTS && self.paints[usize::from(surface)].has_effects {
                    let attributes = indices.map(|i| self.extras[i as usize].side(turned));
                    self.hand_on(indices, surface, turned, (vertices, attributes), stats, sink);
                } else {
                    let shading = self.shading(indices, surface, turned, stats);
                    sink.plain(&vertices, shading);
                }
            }
        }
        if let Some((listed, numbered)) = &listed {
            sink.numbered(numbered, listed.all(), self.rung.shading());
        }
    }

    /// A list for the numbers of faces, if that is how they are handed on: those without effects, of one shading.
    fn listed<const EFFECTS: bool>(&self, sink: &impl Sink, shading: Shading) -> Option<(Listed, Numbered<'_>)> {
        let LitVertices { places, depths, shades, .. } = self.lit;
        let triangles = self.geometry.triangles;
        let plain = !EFFECTS || self.paints.iter().all(|paint| !paint.has_effects);
        let takes = plain && sink.takes_numbers(shading);
        let fits = triangles.len() < TURNED as usize;
        (takes && fits).then_some((Listed::new(), Numbered { places, depths, shades, triangles }))
    }

    /// The same, with effects or without, each by the rung that is decided for it. (Every rung that there is a choice of
    /// has exact cover.) On what covers no pixel centre nothing is decided.
    #[inline(never)]
    fn each_within<const CULLS: bool, const EFFECTS: bool>(
        &self,
        (budget, decided): (&Budget, &mut Decided),
        stats: &mut Stats,
        sink: &mut impl Sink,
    ) {
        let Geometry { triangles, triangle_surfaces, .. } = self.geometry;
        let sieve = sink.sieve();
        let (mut linear, mut vain) = (0, Vain::default());
        let mut listed = self.listed::<EFFECTS>(sink, LINEAR_RUNG.shading());
        for (chunk, triangles) in triangles.chunks(sift::MOST).enumerate() {
            let first = chunk * sift::MOST;
            let surfaces = &triangle_surfaces[first..];
            let (sifted, mut left) = self.sift::<CULLS>(sieve.as_ref(), true, triangles, stats);
            let here = left & !sifted.clipped;
            let sides = (first, if CULLS { 0 } else { sifted.back });
            let (settled, hopeless) = self.settled(budget.of_cluster(chunk), (budget, &mut vain), sides, decided, here);
            let (choices, bodies) = (&mut decided.choices[first..], &mut decided.bodies[first..]);
            linear += u64::from(settled.count_ones());
            if let (Some((listed, numbered)), Some(sieve)) = (&mut listed, &sieve) {
                if settled == left {
                    listed.add(sides, left, sieve.kernel);
                    if let Some(whole) = listed.whole() {
                        sink.numbered(numbered, whole, LINEAR_RUNG.shading());
                        listed.take_whole();
                    }
                    continue;
                }
                // In the order of their numbers.
                sink.numbered(numbered, listed.all(), LINEAR_RUNG.shading());
                listed.clear();
            }
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
                        let manner = Manner { rung: LINEAR_RUNG, lit_at: LitAt::Pixels };
                        sink.with_effects(&vertices, &attributes, surface, manner);
                    } else {
                        sink.plain(&vertices, LINEAR_RUNG.shading());
                    }
                    continue;
                }
                let face = (first + at, indices, surface, turned);
                let (choice, known) = (&mut choices[at], &mut bodies[at]);
                if is(sifted.clipped) {
                    self.clipped_within::<CULLS, EFFECTS>(face, (budget, choice, known), stats, sink);
                } else {
                    self.one_within::<EFFECTS>(face, (budget, choice, known), (&mut vain, is(hopeless)), stats, sink);
                }
            }
        }
        if let Some((listed, numbered)) = &listed {
            sink.numbered(numbered, listed.all(), LINEAR_RUNG.shading());
        }
        stats.shares.add(LINEAR_RUNG, linear);
    }

    /// Those of a cluster's faces that are known to be linear, a bit for each, among those in `left`: from before, or from
    /// what is known of the cluster, or by bounds that are found for eight at once; and those that such bounds are too
    /// much for. `first` is the first one's number.
    #[inline]
    fn settled(
        &self,
        linear: Linear,
        (budget, vain): (&Budget, &mut Vain),
        (first, back): (usize, u64),
        decided: &mut Decided,
        left: u64,
    ) -> (u64, u64) {
        let triangles = &self.geometry.triangles[first..];
        let Decided { choices, bodies } = decided;
        let (choices, bodies) = (&mut choices[first..], &mut bodies[first..]);
        let (mut settled, mut unknown, mut bits) = (0, 0_u64, left);
        while bits != 0 {
            let at = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            let choice = &mut choices[at];
            let is_linear = match &linear {
                _ if *choice != Choice::Unknown => *choice == Choice::Linear,
                Linear::All => true,
                Linear::Where(these) => budget.is_one_of(these, triangles[at], self.lit),
                Linear::Unknown => false,
            };
            if is_linear {
                *choice = Choice::Linear;
                settled |= 1 << at;
            } else if *choice == Choice::Unknown {
                unknown |= 1 << at;
            }
        }
        if unknown == 0 || vain.is_chunk() {
            return (settled, 0);
        }
        let asked = unknown.count_ones();
        let mut more = if budget.is_simple() { self.linear_at_once(budget, (first, back), unknown) } else { 0 };
        unknown &= !more;
        let mut hopeless = 0;
        if unknown != 0 {
            let known = self.linear_as_known(budget, first, (unknown, back), bodies);
            let by_eights = self.linear_by_eights(budget, first, (unknown & !known, back), bodies);
            (more, hopeless) = (more | known | by_eights.linear, by_eights.hopeless);
        }
        vain.by_eights(asked, more.count_ones());
        let mut bits = more;
        while bits != 0 {
            choices[bits.trailing_zeros() as usize] = Choice::Linear;
            bits &= bits - 1;
        }
        (settled | more, hopeless)
    }

    /// Those that are known to be linear at once.
    #[inline(never)]
    fn linear_at_once(&self, budget: &Budget, (first, back): (usize, u64), mut unknown: u64) -> u64 {
        let Geometry { triangles, triangle_surfaces, .. } = self.geometry;
        let mut linear = 0;
        while unknown != 0 {
            let at = unknown.trailing_zeros() as usize;
            unknown &= unknown - 1;
            let (triangle, turned) = (first + at, back >> at & 1 == 1);
            let (surface, indices) = (triangle_surfaces[triangle], triangles[triangle]);
            if budget.decide_at_once(triangle, surface, self.lit, indices, turned) == Choice::Linear {
                linear |= 1 << at;
            }
        }
        linear
    }

    /// What bounds for eight at once say.
    #[inline(never)]
    fn linear_by_eights(
        &self,
        budget: &Budget,
        first: usize,
        (mut left, back): (u64, u64),
        bodies: &mut [[Option<f32>; 2]],
    ) -> Looked {
        let mut all = Looked::default();
        while left != 0 {
            let looked = self.linear_of_eight(budget, first, (left, back), bodies);
            all.linear |= looked.linear;
            all.hopeless |= looked.hopeless;
            left &= !looked.at;
        }
        all
    }

    /// The shades of a face's corners, of each channel, or the one; the others are nought.
    #[inline]
    pub(in crate::render) fn corner_shades(&self, indices: [u32; 3], turned: bool) -> [[u16; 3]; 3] {
        if self.channels {
            let channels = indices.map(|i| self.extras[i as usize].side(turned).channels);
            [0, 1, 2].map(|channel| channels.map(|corner| corner[channel].to_bits()))
        } else {
            let shades = indices.map(|i| self.lit.shades[i as usize][usize::from(turned)].to_bits());
            [shades, [0; 3], [0; 3]]
        }
    }

    /// A face that its cluster says nothing of.
    #[inline(never)]
    fn one_within<const EFFECTS: bool>(
        &self,
        (triangle, indices, surface, turned): (usize, [u32; 3], u16, bool),
        (budget, choice, known): (&Budget, &mut Choice, &mut [Option<f32>; 2]),
        (vain, hopeless): (&mut Vain, bool),
        stats: &mut Stats,
        sink: &mut impl Sink,
    ) {
        if *choice == Choice::Unknown && budget.is_simple() {
            *choice = budget.decide_at_once(triangle, surface, self.lit, indices, turned);
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
                let face = (triangle, indices, surface, turned);
                vain.decided(self.decide::<EFFECTS>((budget, known), face, (shades, Some(&vertices))))
            };
        }
        let choice = *choice;
        stats.shares.add(choice.rung(), 1);
        if (EFFECTS && self.paints[usize::from(surface)].has_effects) || choice.needs_light() {
            let mut attributes = self.attributes::<EFFECTS>(indices, turned, choice);
            if choice == Choice::Curved {
                self.put_curve(&mut attributes, (indices, surface, turned), &vertices);
            }
            hand_on_within(vertices, attributes, surface, choice, sink);
        } else {
            sink.plain(&vertices, choice.shading(&vertices));
        }
    }

    /// Decides on a face on which nothing was known at once.
    #[inline(never)]
    fn decide<const EFFECTS: bool>(
        &self,
        (budget, known): (&Budget, &mut [Option<f32>; 2]),
        (triangle, indices, surface, turned): (usize, [u32; 3], u16, bool),
        (shades, vertices): ([U8F8; 3], Option<&[Vertex; 3]>),
    ) -> Choice {
        let shades = if EFFECTS && self.channels {
            indices.map(|i| self.extras[i as usize].side(turned).channels.map(U8F8::to_bits))
        } else {
            shades.map(|shade| [shade.to_bits(); 3])
        };
        let question = Question { triangle, indices, surface, turned, shades, vertices };
        self.cheapest_within(budget, &question, known)
    }

    /// What the corners of a face carry that is shaded by choice.
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

    /// As [`clipped`](Self::clipped), for a face that is shaded by choice.
    #[cold]
    #[inline(never)]
    fn clipped_within<const CULLS: bool, const EFFECTS: bool>(
        &self,
        (triangle, indices, surface, _): (usize, [u32; 3], u16, bool),
        (budget, choice, known): (&Budget, &mut Choice, &mut [Option<f32>; 2]),
        stats: &mut Stats,
        sink: &mut impl Sink,
    ) {
        let corners = &indices.map(|i| self.lit.get(i as usize));
        let at = indices.map(|i| self.view.homogeneous(self.geometry.positions[i as usize]));
        let turned = !CULLS && is_turned_away(&at);
        if *choice == Choice::Unknown {
            let shades = corners.map(|corner| if turned { corner.back } else { corner.vertex.shade() });
            *choice = self.decide::<EFFECTS>((budget, known), (triangle, indices, surface, turned), (shades, None));
        }
        let (choice, before) = (*choice, stats.drawn);
        let shading = choice.rung().shading();
        if (EFFECTS && self.paints[usize::from(surface)].has_effects) || choice.needs_light() {
            let attributes = self.attributes::<EFFECTS>(indices, turned, choice);
            let carried = attributes.map(|attributes| WithEffects { attributes, affine: self.affine });
            self.parts::<CULLS, _>(at, corners, carried, (shading, turned), stats, |vertices, carried, _| {
                hand_on_within(vertices, carried.map(|carried| carried.attributes), surface, choice, sink);
            });
        } else {
            self.parts::<CULLS, _>(at, corners, [(); 3], (shading, turned), stats, |vertices, _, _| {
                sink.plain(&vertices, choice.shading(&vertices));
            });
        }
        stats.shares.add(choice.rung(), stats.drawn - before);
    }

    /// A face that reaches beyond the near plane or the guard band. Kept apart: it is rare.
    #[cold]
    #[inline(never)]
    fn clipped<const CULLS: bool, const EFFECTS: bool>(
        &self,
        indices: [u32; 3],
        surface: u16,
        corners: &[LitVertex; 3],
        stats: &mut Stats,
        sink: &mut impl Sink,
    ) {
        let at = indices.map(|i| self.view.homogeneous(self.geometry.positions[i as usize]));
        let turned = !CULLS && is_turned_away(&at);
        if EFFECTS && self.paints[usize::from(surface)].has_effects {
            let carried =
                indices.map(|i| WithEffects { attributes: self.extras[i as usize].side(turned), affine: self.affine });
            let shading = self.rung.shading();
            self.parts::<CULLS, _>(at, corners, carried, (shading, turned), stats, |vertices, carried, stats| {
                let attributes = carried.map(|carried| carried.attributes);
                self.hand_on(indices, surface, turned, (vertices, attributes), stats, sink);
            });
        } else {
            let shading = self.shading(indices, surface, turned, stats);
            self.parts::<CULLS, _>(at, corners, [(); 3], (shading, turned), stats, |vertices, _, _| {
                sink.plain(&vertices, shading)
            });
        }
    }

    /// The triangles that clipping leaves.
    fn parts<const CULLS: bool, C: Carried>(
        &self,
        at: [Homogeneous; 3],
        corners: &[LitVertex; 3],
        carried: [C; 3],
        (shading, turned): (Shading, bool),
        stats: &mut Stats,
        mut part: impl FnMut([Vertex; 3], [C; 3], &mut Stats),
    ) {
        let corner = |i: usize| {
            let LitVertex { vertex, back, needs_clipping, .. } = corners[i];
            let shade = if turned { back } else { vertex.shade() };
            let projected = (!needs_clipping).then(|| vertex.with_shade(shade));
            Corner { at: at[i], shade: f64::from(shade.to_bits()), vertex: projected, carried: carried[i] }
        };
        let Some((polygon, carried)) = clip(self.view, shading, [corner(0), corner(1), corner(2)]) else { return };
        let area = polygon.doubled_area();
        if area == 0 || (CULLS && area > 0) {
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
        indices: [u32; 3],
        surface: u16,
        turned: bool,
        (mut vertices, mut attributes): ([Vertex; 3], [Attributes; 3]),
        stats: &mut Stats,
        sink: &mut impl Sink,
    ) {
        if self.flat && self.is_lit {
            stats.lit += 1;
            let (centre, normal) = self.face(indices);
            let paint = &self.paints[usize::from(surface)];
            if self.channels {
                let (front, back) = self.lights.three_channels(&paint.answer, centre, normal);
                let channels = Paint::channels(if turned { back } else { front });
                attributes.iter_mut().for_each(|corner| corner.channels = channels);
            } else {
                let shade = self.face_shade(indices, surface, turned);
                vertices = vertices.map(|vertex| vertex.with_shade(shade));
            }
        }
        sink.with_effects(&vertices, &attributes, surface, Manner { rung: self.rung, lit_at: LitAt::Pixels });
    }

    /// How a face is shaded; its one shade, where it has but one, is worked out here.
    #[inline]
    fn shading(&self, indices: [u32; 3], surface: u16, turned: bool, stats: &mut Stats) -> Shading {
        if self.flat && self.is_lit {
            stats.lit += 1;
            return Shading::Flat(self.face_shade(indices, surface, turned).nearest());
        }
        if !self.runs {
            // All corners have the same, wherever the plan says so.
            return Shading::Flat(self.lit.shades[indices[0] as usize][usize::from(turned)].nearest());
        }
        self.rung.shading()
    }

    /// The one shade of a face: at its middle, by its own normal.
    fn face_shade(&self, indices: [u32; 3], surface: u16, turned: bool) -> U8F8 {
        let (centre, normal) = self.face(indices);
        let paint = &self.paints[usize::from(surface)];
        let (front, back) = if self.full {
            self.lights.one_channel(&paint.answer, centre, normal)
        } else {
            both_sides(paint.answer.ambient, paint.answer.diffuse, self.lights.suns, normal)
        };
        paint.shade(if turned { back } else { front })
    }

    /// The middle of a face, and its normal.
    fn face(&self, indices: [u32; 3]) -> (glam::Vec3, glam::Vec3) {
        let [a, b, c] = indices.map(|i| self.geometry.positions[i as usize]);
        // A face without area has no normal; rounded, it may still cover a pixel.
        let normal = face_normal(a, b, c).unwrap_or(self.geometry.normals[indices[0] as usize]);
        // Each third by itself: the sum of three might overflow.
        (a / 3.0 + b / 3.0 + c / 3.0, normal)
    }
}

/// Whether a triangle is of fewer pixels: of [`SMALL`], lighting each costs no more than a few questions about it.
fn is_smaller(vertices: &[Vertex; 3], pixels: u64) -> bool {
    // Twice, in 1/256 pixel.
    doubled_area(vertices).unsigned_abs() < pixels * 131_072
}

/// Hands on a face with effects that is shaded by choice. Of a flat one every corner gets the shade in the middle.
fn hand_on_within(
    mut vertices: [Vertex; 3],
    mut attributes: [Attributes; 3],
    surface: u16,
    choice: Choice,
    sink: &mut impl Sink,
) {
    let mut rung = choice.rung();
    if choice == Choice::Flat {
        let shade = middle(vertices.map(|vertex| vertex.shade()));
        vertices = vertices.map(|vertex| vertex.with_shade(shade));
        let [a, b, c] = attributes.map(|corner| corner.channels);
        let channels = [0, 1, 2].map(|channel| middle([a[channel], b[channel], c[channel]]));
        attributes.iter_mut().for_each(|corner| corner.channels = channels);
        rung = Rung::Gouraud88Reseeded;
    }
    sink.with_effects(&vertices, &attributes, surface, Manner { rung, lit_at: choice.lit_at() });
}

/// Half-way between the least and the greatest.
fn middle([a, b, c]: [U8F8; 3]) -> U8F8 {
    let (least, most) = (a.min(b).min(c).to_bits(), a.max(b).max(c).to_bits());
    U8F8::from_bits(least + (most - least) / 2)
}

impl Choice {
    /// How the raster shades a face without effects.
    #[inline]
    fn shading(self, vertices: &[Vertex; 3]) -> Shading {
        match self {
            Self::Flat => Shading::Flat(middle(vertices.map(|vertex| vertex.shade())).nearest()),
            choice => choice.rung().shading(),
        }
    }
}

/// Whether the eye is behind the face, wherever its corners are: the sign of the volume between
/// the eye and the three corners.
fn is_turned_away(at: &[Homogeneous; 3]) -> bool {
    let [a, b, c] = at;
    let volume = a.w * (b.x * c.y - c.x * b.y) + b.w * (c.x * a.y - a.x * c.y) + c.w * (a.x * b.y - b.x * a.y);
    volume > 0.0
}
