//! Picking: which faces of an object are drawn, and how. Faces are culled, clipped where necessary,
//! and given a shading: the object's or, within an error budget, one chosen for each face.

use alloc::vec::Vec;

use super::Stats;
use super::budget::{Budget, FLOAT, LINEAR};
use super::clip::{Corner, Progressions, clip};
use super::faces::{Face, Faces};
use super::stats::Shares;
use super::vertex_columns::AddedTriangles;
use crate::fixed::U8F8;
use crate::lanes::{LANES, three};
use crate::light::Blend;
use crate::mesh::Mesh;
use crate::plan::FaceShading;
use crate::plan::stages::LitAt;
use crate::raster::columns::{PickedTriangles, Picks, ScreenPos, Triangles};
use crate::raster::cull::{CullMasks, PickList, cull, pick};
use crate::raster::effects::Attributes;
use crate::raster::pick::{CHUNK, Pick};
use crate::raster::{Interpolation, Rect, Vertex};
use crate::settings::{Mapping, Shading};
use crate::span::Kernel;
use crate::view::Homogeneous;

const _: () = assert!(Mesh::MAX_COUNT <= Pick::MAX_COUNT, "a face's index has its bits in a pick");

/// Number of pending picks above which they are drawn.
const CAPACITY: usize = 512;

/// Room for picks: at full capacity, the faces of one more chunk may follow, and the last of these may have eight
/// parts.
const ROOM: usize = CAPACITY + CHUNK + AddedTriangles::MAX_OF_FACE;

/// Properties shared by faces that are drawn together.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Look {
    /// The surface, if pixels pass through stages; otherwise it does not matter.
    pub(super) surface: u16,
    pub(super) shading: FaceShading,
    /// True if pixels pass through stages.
    pub(super) effects: bool,
    pub(super) transparent: bool,
    /// True if each face has one shade for all of its pixels.
    pub(super) one_shade: bool,
    /// True if the triangles are added by the frame, rather than those of the object.
    pub(super) added: bool,
}

impl Look {
    /// The interpolation of the corners' shades.
    pub(super) fn interpolation(&self) -> Interpolation {
        // If the corners have the same shade, any interpolation will do.
        if self.one_shade { Interpolation::Gouraud88 } else { self.shading.interpolation() }
    }
}

/// Faces that are drawn together, in order.
#[derive(Clone, Copy)]
pub(super) struct Run<'a> {
    pub(super) look: Look,
    pub(super) triangles: Triangles<'a>,
    pub(super) picks: Picks<'a>,
    /// The face that each triangle is part of, if the frame adds them.
    faces: &'a [u32],
}

impl Run<'_> {
    /// The triangles that are drawn.
    pub(super) fn picked(&self) -> PickedTriangles<'_> {
        PickedTriangles { triangles: &self.triangles, picks: self.picks }
    }

    /// The vertices of a pick, and the interpolation of their shades.
    pub(super) fn vertices(&self, k: usize) -> ([Vertex; 3], Interpolation) {
        let vertices = self.picked().vertices(k);
        let flat = || Interpolation::Flat(vertices[0].shade().nearest());
        let interpolation = if self.look.one_shade { flat() } else { self.look.shading.interpolation() };
        (vertices, interpolation)
    }

    /// The values of a pick's corners besides their shades.
    pub(super) fn attributes(&self, k: usize) -> [Attributes; 3] {
        let pick = self.picks.get(k);
        let attributes = three(self.triangles.corners(pick), |i| {
            self.triangles.columns.attributes(i, pick.side(), self.look.shading.lights_pixels())
        });
        match self.picks.flat.get(k) {
            Some(&channels) => attributes.map(|corner| Attributes { channels, ..corner }),
            None => attributes,
        }
    }

    /// The picks' faces, by their index in the mesh or in the mesh that splitting made of it.
    pub(super) fn face(&self, k: usize) -> usize {
        let index = self.picks.get(k).index();
        if self.look.added { self.faces[index] as usize } else { index }
    }
}

/// Memory for picking. It is allocated when first needed, and is large enough from then on.
#[derive(Debug, Default)]
pub(super) struct PickScratch {
    picks: PickList<{ ROOM + LANES }>,
    /// The single shade of each pick, or its three channels, if faces are lit; the last picks may not be lit yet.
    flat: Vec<[U8F8; 3]>,
    /// The end of each run.
    runs: Vec<(usize, Look)>,
    pub(super) added: AddedTriangles,
}

/// Collects picks, and draws them when there are enough.
pub(super) struct Picker<'a> {
    kernel: Kernel,
    /// The drawn rectangle, to which faces are culled; `None` if all are wanted.
    clip: Option<Rect>,
    /// True if added triangles are kept until the frame is drawn.
    keeps: bool,
    scratch: &'a mut PickScratch,
    draw: &'a mut dyn FnMut(&Run<'_>),
}

impl<'a> Picker<'a> {
    pub(super) fn new(
        (kernel, clip): (Kernel, Option<Rect>),
        keeps: bool,
        scratch: &'a mut PickScratch,
        draw: &'a mut dyn FnMut(&Run<'_>),
    ) -> Self {
        scratch.runs.reserve(ROOM);
        scratch.picks.clear();
        Self { kernel, clip, keeps, scratch, draw }
    }

    /// Culls up to 64 triangles. `exact_cover` is false if those that cover no pixel centre may draw something.
    fn cull(&self, at: &[ScreenPos], triangles: &[[u32; 3]], culls: bool, exact_cover: bool) -> CullMasks {
        let masks = cull(self.kernel.simd_level(), at, triangles, self.clip.unwrap_or_default(), culls);
        if self.clip.is_some() && exact_cover { masks } else { CullMasks { covers: !0, ..masks } }
    }

    /// Extends the last run to the last pick, or begins another if the look changes.
    #[inline]
    fn run_to_end(&mut self, look: Look) {
        let end = self.scratch.picks.as_slice().len();
        match self.scratch.runs.last_mut() {
            Some((last_end, last)) if *last == look => *last_end = end,
            _ => self.scratch.runs.push((end, look)),
        }
    }

    /// Adds one face, or one triangle that the frame adds.
    #[inline]
    fn push(&mut self, look: Look, pick: u32, flat: Option<[U8F8; 3]>) {
        self.scratch.picks.push(pick);
        self.scratch.flat.extend(flat);
        self.run_to_end(look);
    }

    /// Adds the triangles that the frame has added from `first` on.
    pub(super) fn push_added(&mut self, look: Look, first: usize, flat: Option<[U8F8; 3]>) {
        let look = Look { added: true, ..look };
        let end = self.scratch.added.len();
        let exact_cover = look.interpolation().has_exact_cover();
        for from in (first..end).step_by(CHUNK) {
            let Triangles { columns, indices, .. } = self.scratch.added.triangles();
            let masks = self.cull(columns.at, &indices[from..end.min(from + CHUNK)], false, exact_cover);
            for at in 0..end.min(from + CHUNK) - from {
                if masks.covers >> at & 1 == 1 {
                    self.push(look, masks.pick(at, from + at, false), flat);
                }
            }
        }
    }

    /// Adds a triangle whose vertices are not a mesh's. Until `finish_vertices`, all such triangles have the same
    /// shading.
    pub(super) fn push_vertices(&mut self, vertices: &[Vertex; 3], interpolation: Interpolation, shading: Shading) {
        let added = &mut self.scratch.added;
        let corners = three(vertices.each_ref(), |vertex| match interpolation {
            Interpolation::Flat(index) => added.vertex(&vertex.with_shade(U8F8::from(index)), &Attributes::default()),
            _ => added.vertex(vertex, &Attributes::default()),
        });
        added.triangle(corners, 0);
        if added.pending() == CHUNK {
            self.finish_vertices(shading);
        }
    }

    /// Draws the triangles whose vertices are not a mesh's.
    pub(super) fn finish_vertices(&mut self, shading: Shading) {
        let (effects, transparent, one_shade) = (false, false, shading == Shading::Flat);
        let look = Look { surface: 0, shading: shading.into(), effects, transparent, one_shade, added: true };
        self.push_added(look, self.scratch.added.len() - self.scratch.added.pending(), None);
        self.finish(&Triangles::NONE);
    }

    /// Draws the pending picks, all of which are lit. `triangles` are the object's.
    #[inline(never)]
    fn finish(&mut self, triangles: &Triangles<'_>) {
        let (mut first, mut keeps) = (0, self.keeps);
        let PickScratch { picks: list, flat, runs, added } = &mut *self.scratch;
        let picks = Picks { picks: list.as_slice(), flat };
        for &(end, look) in &*runs {
            let triangles = if look.added { added.triangles() } else { *triangles };
            keeps |= look.transparent && look.added;
            if first < end {
                (self.draw)(&Run { look, triangles, picks: picks.range(first, end), faces: &added.faces });
            }
            first = end;
        }
        list.clear();
        flat.clear();
        runs.clear();
        if keeps {
            added.keep();
        } else {
            added.drop_pending();
        }
    }
}

impl Faces<'_> {
    /// Picks the faces to be drawn. Within a budget the shading of each is decided; returns the counts of these
    /// decisions.
    pub(super) fn pick(&self, budget: Option<&Budget>, stats: &mut Stats, picker: &mut Picker<'_>) -> Shares {
        let (triangles, culls) = (self.geometry.triangles, self.stages.culls());
        stats.faces += triangles.len() as u64;
        if self.stages.lit_at == LitAt::Faces {
            picker.scratch.flat.reserve(ROOM);
        }
        // Every shading that a budget chooses has exact coverage, and so does a single shade.
        let has_one_shade = self.has_one_shade();
        let exact_cover = budget.is_some() || has_one_shade || self.shading.interpolation().has_exact_cover();
        let common = if budget.is_some() { LINEAR } else { self.shading.into() };
        let one_look = self.one_look(common, budget.is_some());
        stats.decided += u64::from(budget.is_some());
        let (mut counts, before, mut linear) = (Shares::default(), stats.drawn, 0);
        for (chunk, triangles) in triangles.chunks(CHUNK).enumerate() {
            let first = chunk * CHUNK;
            let masks = picker.cull(&self.columns.at, triangles, culls, exact_cover);
            let mut left = self.drawn(chunk, triangles.len(), &masks, stats);
            let unclipped = left & !masks.clipped;
            let classes =
                budget.map(|budget| self.classify(budget, (first, if culls { 0 } else { masks.back }), unclipped));
            let of_common = classes.as_ref().map_or(unclipped, |classes| classes.linear);
            linear += u64::from(of_common.count_ones());
            if let Some(look) = one_look.filter(|_| of_common == left) {
                // Below `Pick::MAX_COUNT`.
                pick(picker.kernel.simd_level(), &mut picker.scratch.picks, first as u32, &masks, left);
                picker.run_to_end(look);
                self.make_space(picker, stats);
                continue;
            }
            // The faces below are lit one by one, after all pending ones.
            self.light_pending(picker, stats);
            while left != 0 {
                let at = left.trailing_zeros() as usize;
                left &= left - 1;
                let is = |bits: u64| bits >> at & 1 == 1;
                let pick = masks.pick(at, first + at, !culls && is(masks.back));
                let face = self.face(Pick(pick));
                if is(of_common) {
                    let look = self.look(face.surface, common, budget.is_some());
                    let flat = self.lit_face(face, stats);
                    picker.push(look, pick, flat);
                    continue;
                }
                if is(masks.clipped) {
                    let culls = culls || is(self.twins_of(chunk));
                    let shading = self.clipped((culls, exact_cover), face, budget, stats, picker);
                    if let Some(shading) = shading.filter(|_| budget.is_some()) {
                        counts.add(shading, 1);
                    }
                } else if let (Some(budget), Some(classes)) = (budget, &classes) {
                    let error = (!is(classes.float)).then_some(classes.errors[at]);
                    counts.add(self.decided((face, pick), (budget, error), stats, picker), 1);
                }
                self.make_space(picker, stats);
            }
            self.make_space(picker, stats);
        }
        self.finish(picker, stats);
        if budget.is_some() {
            stats.shares.add(LINEAR, linear);
            counts.add(LINEAR, linear);
        } else {
            stats.shares.add(self.shading.into(), stats.drawn - before);
        }
        counts
    }

    /// The bits of triangles, in a chunk of up to 64, that lie back to back with others.
    #[inline]
    fn twins_of(&self, chunk: usize) -> u64 {
        self.geometry.twins.get(chunk).copied().unwrap_or(0)
    }

    /// The bits of faces to be drawn, among up to 64, including those that need clipping. A face that covers no pixel
    /// centre is left out, though it counts as drawn.
    #[inline]
    fn drawn(&self, chunk: usize, count: usize, masks: &CullMasks, stats: &mut Stats) -> u64 {
        let drawn = if self.stages.culls() { masks.front } else { masks.front | (masks.back & !self.twins_of(chunk)) };
        let clipped = u64::from((masks.clipped | masks.too_near).count_ones());
        let drawn_here = u64::from(drawn.count_ones());
        stats.drawn += drawn_here;
        stats.clipped += clipped;
        stats.culled += count as u64 - drawn_here - clipped;
        (drawn & masks.covers) | masks.clipped
    }

    /// Returns whether each face has one shade, unless a budget or a stage for pixels gives it others.
    fn has_one_shade(&self) -> bool {
        self.stages.lit_at == LitAt::Faces || !self.stages.interpolates()
    }

    /// The look of faces of a surface that are drawn with one shading.
    #[inline]
    fn look(&self, surface: u16, shading: FaceShading, is_decided: bool) -> Look {
        let material = &self.materials[usize::from(surface)];
        let effects = material.has_effects || (is_decided && shading.lights_pixels());
        let (surface, transparent) = (if effects { surface } else { 0 }, material.blend != Blend::Opaque);
        let one_shade = !effects && !is_decided && self.has_one_shade();
        Look { surface, shading, effects, transparent, one_shade, added: false }
    }

    /// The look of all faces, if they share one.
    fn one_look(&self, shading: FaceShading, is_decided: bool) -> Option<Look> {
        let plain = self.materials.iter().all(|material| !material.has_effects);
        (self.materials.len() == 1 || (plain && !self.materials.is_empty())).then(|| self.look(0, shading, is_decided))
    }

    /// The single shade of a face, or its channels, if faces are lit.
    #[inline]
    fn lit_face(&self, face: Face, stats: &mut Stats) -> Option<[U8F8; 3]> {
        if self.stages.lit_at != LitAt::Faces {
            return None;
        }
        stats.lit += 1;
        Some(self.flat(face))
    }

    /// Draws the pending picks if there is no room for 64 more, or for the parts of one more face.
    #[inline]
    fn make_space(&self, picker: &mut Picker<'_>, stats: &mut Stats) {
        let PickScratch { picks, added, .. } = &*picker.scratch;
        if picks.as_slice().len() > CAPACITY || added.pending() >= AddedTriangles::MAX_PENDING {
            self.finish(picker, stats);
        }
    }

    /// Draws the pending picks.
    fn finish(&self, picker: &mut Picker<'_>, stats: &mut Stats) {
        self.light_pending(picker, stats);
        picker.finish(&self.triangles());
    }

    /// Lights the picked faces that are not lit yet, each as a whole, if faces are lit.
    #[inline]
    fn light_pending(&self, picker: &mut Picker<'_>, stats: &mut Stats) {
        if self.stages.lit_at == LitAt::Faces {
            self.light_faces(picker, stats);
        }
    }

    /// The work of [`light_pending`](Self::light_pending): lights many faces at a time, so that few lanes are idle.
    #[inline(never)]
    fn light_faces(&self, picker: &mut Picker<'_>, stats: &mut Stats) {
        let PickScratch { picks, flat, .. } = &mut *picker.scratch;
        let first = flat.len();
        let picks = &picks.as_slice()[first..];
        stats.lit += picks.len() as u64;
        // Room has been reserved.
        flat.resize(first + picks.len(), Default::default());
        self.shade_faces(picks, &mut flat[first..]);
    }

    /// Picks a face that bounds alone do not prove linear on the screen. `error` is its bound, if
    /// it is not linear on the face either.
    #[inline(never)]
    fn decided(
        &self,
        (face, pick): (Face, u32),
        (budget, error): (&Budget, Option<f32>),
        stats: &mut Stats,
        picker: &mut Picker<'_>,
    ) -> FaceShading {
        let side = usize::from(face.back_facing);
        let columns = self.triangles().columns;
        let vertices = three(face.indices, |i| columns.vertex(i as usize, side, None));
        let (shading, nodes) = error.map_or((FLOAT, None), |error| self.fit(budget, (face, error), &vertices));
        let look = self.look(face.surface, shading, true);
        stats.shares.add(shading, 1);
        let Some(nodes) = nodes else {
            picker.push(look, pick, None);
            return shading;
        };
        // The face gets a curve of its own.
        let curve = self.curve(face.surface, &nodes);
        let added = &mut picker.scratch.added;
        let first = added.len();
        let corners = three([0, 1, 2], |k| {
            let attributes = columns.attributes(face.indices[k] as usize, side, false);
            added.vertex(&vertices[k], &Attributes { lit: curve[k], ..attributes })
        });
        added.triangle(corners, face.index);
        picker.push(Look { added: true, ..look }, Pick(pick).with_front(first).0, None);
        shading
    }

    /// Picks a face that reaches beyond the near plane or the guard band, unless all of it is off the screen. This is a
    /// separate function because it is rarely called.
    #[cold]
    #[inline(never)]
    fn clipped(
        &self,
        (culls, exact_cover): (bool, bool),
        face: Face,
        budget: Option<&Budget>,
        stats: &mut Stats,
        picker: &mut Picker<'_>,
    ) -> Option<FaceShading> {
        let at = three(face.indices, |i| self.view.homogeneous(self.geometry.positions[i as usize]));
        if picker.clip.is_some() && exact_cover && self.view.is_off_screen(&at) {
            return None;
        }
        let face = Face { back_facing: !culls && is_turned_away(&at), ..face };
        let (shading, before) =
            (budget.map_or(self.shading.into(), |budget| self.decide_clipped(budget, face)), stats.drawn);
        let look = self.look(face.surface, shading, budget.is_some());
        let flat = self.lit_face(face, stats);
        let first = picker.scratch.added.len();
        self.add_parts((face, at), (culls, shading), &mut picker.scratch.added, stats);
        picker.push_added(look, first, flat);
        if budget.is_some() {
            stats.shares.add(shading, stats.drawn - before);
        }
        Some(shading)
    }

    /// Adds the triangles into which clipping turns a face.
    fn add_parts(
        &self,
        (face, at): (Face, [Homogeneous; 3]),
        (culls, shading): (bool, FaceShading),
        added: &mut AddedTriangles,
        stats: &mut Stats,
    ) {
        let columns = self.triangles().columns;
        let corner = |k: usize| {
            let (i, side) = (face.indices[k] as usize, usize::from(face.back_facing));
            let shade = columns.shade[i][side];
            let is_projected = !columns.at[i].needs_clipping();
            Corner {
                at: at[k],
                shade: f64::from(shade.to_bits()),
                vertex: is_projected.then(|| columns.vertex(i, 0, Some(shade))),
                attributes: columns.attributes(i, side, shading.lights_pixels()),
            }
        };
        let progressions =
            Progressions { interpolation: shading.interpolation(), affine: self.stages.mapping == Mapping::Affine };
        let Some((polygon, corners)) = clip(self.view, progressions, [corner(0), corner(1), corner(2)]) else {
            return;
        };
        let area = polygon.doubled_area();
        if area == 0 || (culls && area > 0) {
            stats.culled += 1;
            return;
        }
        // Indices ascend.
        let vertices = polygon.as_slice().iter().zip(corners.as_slice());
        let first = vertices.map(|(vertex, corner)| added.vertex(vertex, &corner.attributes)).min().unwrap_or(0);
        for part in polygon.part_corners() {
            stats.drawn += 1;
            // At most seven more than the first.
            added.triangle(three(part, |corner| first + corner as u32), face.index);
        }
    }
}

/// Returns whether the eye is behind the face, wherever its corners are: the sign of the volume between the eye and the
/// three corners.
fn is_turned_away(at: &[Homogeneous; 3]) -> bool {
    let [a, b, c] = at;
    let volume = a.w * (b.x * c.y - c.x * b.y) + b.w * (c.x * a.y - a.x * c.y) + c.w * (a.x * b.y - b.x * a.y);
    volume > 0.0
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Every level picks the faces whose bits are set, in order, with their sides.
        #[test]
        fn faces_are_picked_in_order(
            chosen in prop::collection::vec((any::<u64>(), any::<u64>(), any::<u64>(), any::<bool>()), 0..8),
        ) {
            for kernel in Kernel::available() {
                let (mut list, mut expected) = (PickList::<{ CAPACITY + LANES }>::new(), Vec::new());
                for (chunk, &(bits, fewer, back, all)) in (0_u32..).zip(&chosen) {
                    let chosen = if all { !0 } else { bits & fewer };
                    let masks = CullMasks { back, ..CullMasks::default() };
                    pick(kernel.simd_level(), &mut list, chunk * 64, &masks, chosen);
                    let is = |bits: u64, at: usize| bits >> at & 1 == 1;
                    let of_chunk = (0..64).filter(|&at| is(chosen, at));
                    expected.extend(of_chunk.map(|at| masks.pick(at, chunk as usize * 64 + at, is(back, at))));
                }
                prop_assert_eq!(list.as_slice(), &expected);
            }
        }
    }
}
