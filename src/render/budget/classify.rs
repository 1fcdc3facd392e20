//! The descent: which faces of a chunk are linear, by the bound on the nodes above them, and on eight faces at a time.

use super::bound::{Bounds, Incident, Shapes, interpolation_error};
use super::decided::Decided;
use super::fit::LINEAR_MODEL;
use super::ranges::{EightFaces, EightNodes, Patches, ZERO, dot, greater, lesser};
use super::{Budget, Choice, Depths, EXACT_ROUNDING, LINEAR_ROUNDING};
use crate::lanes::{LANES, Lanes};
use crate::render::cull;
use crate::render::faces::Faces;
use crate::render::lit::Face;
use crate::simd::at_best_level;

/// Share of a face that the coarsest parts have, which points are lit between.
const COARSEST: f32 = 0.25;

/// Times of what is allowed beyond which a bound seldom is so loose that linear shades do.
const MOST_LIKELY: f32 = 6.0;

/// Edges between the eye and a body from which on perspective bends shades by no more than a fiftieth of their range.
const NEAR_EDGES: f32 = 25.0;

/// Decisions on the faces of a chunk, a bit for each.
#[derive(Clone, Copy, Default)]
pub(in crate::render) struct Settled {
    pub(in crate::render) linear: u64,
    /// Faces of which no function is known to be near enough by a few points; and small ones, which are tried by linear
    /// functions alone.
    pub(in crate::render) hopeless: u64,
    pub(in crate::render) hopeless_if_small: u64,
}

impl Depths {
    /// Share of a shade's range that perspective moves it along on each of eight nodes: (ρ − 1) / 4 (Lemma 9).
    #[inline(always)]
    fn bend_of_nodes(&self, nodes: &EightNodes, edge: &Lanes<f32>) -> Lanes<f32> {
        let middle = dot(&nodes.centres, &self.row.map(|c| [c; LANES]));
        let half = dot(&nodes.halves, &self.row.map(|c| [c.abs(); LANES]));
        let mut bends = ZERO;
        for (lane, bend) in bends.iter_mut().enumerate() {
            let slack = 1e-5 * (middle[lane].abs() + half[lane] + self.offset.abs());
            let near = greater(middle[lane] + self.offset - half[lane] - slack, self.near);
            *bend = lesser(edge[lane] * self.scale / (2.0 * near), 1.0);
        }
        bends
    }

    /// The ratio of depths on each of eight faces, less 1.
    #[inline(always)]
    fn ratios(&self, faces: &EightFaces) -> Lanes<f32> {
        let row = self.row.map(|c| [c; LANES]);
        let [a, b, c] = faces.positions.each_ref().map(|at| dot(at, &row));
        let mut ratios = ZERO;
        for (lane, ratio) in ratios.iter_mut().enumerate() {
            let (most, least) =
                (greater(a[lane], greater(b[lane], c[lane])), lesser(a[lane], lesser(b[lane], c[lane])));
            let slack = 1e-6 * (most.abs() + least.abs() + self.offset.abs());
            let near = greater(least + self.offset - slack, self.near);
            *ratio = (most - least + slack) / near;
        }
        ratios
    }
}

impl Faces<'_> {
    /// Bounds of eight patches of a surface.
    #[inline(never)]
    fn bounds<const WHOLE: bool, P: Patches>(
        &self,
        budget: &Budget,
        (patches, shapes): (&P, &Shapes),
        surface: u16,
        below: bool,
    ) -> Bounds {
        let answer = &self.paints[usize::from(surface)].answer;
        let incident = Incident { lights: self.lights, answer, extent: budget.tree.extent, below };
        let kernel = budget.kernel();
        if self.channels {
            at_best_level!(kernel, interpolation_error::<3, WHOLE, P>(patches, shapes, &incident))
        } else {
            at_best_level!(kernel, interpolation_error::<1, WHOLE, P>(patches, shapes, &incident))
        }
    }

    /// Nodes of a level of the tree on which all faces are linear, a bit for each of eight siblings, for faces that show
    /// their front or their back.
    #[inline(never)]
    fn nodes_within(&self, budget: &Budget, (level, group): (usize, usize), back: bool) -> u8 {
        let siblings = &budget.tree.levels[level][group];
        let mut nodes = siblings.nodes;
        if back {
            nodes.axes.iter_mut().flatten().for_each(|axis| *axis = -*axis);
        }
        let bend = budget.depths.bend_of_nodes(&nodes, &siblings.edge);
        let shapes = Shapes { spread: siblings.spread, edge: siblings.edge, part: [1.0; LANES], bend };
        let spare = budget.spare(LINEAR_ROUNDING);
        let (mut within, mut known) = (0_u8, 0_u8);
        for (lane, surface) in siblings.surfaces.iter().enumerate() {
            let Some(surface) = *surface else { continue };
            if known >> lane & 1 == 1 {
                continue;
            }
            let bounds = self.bounds::<true, _>(budget, (&nodes, &shapes), surface, false);
            for (other, of) in siblings.surfaces.iter().enumerate() {
                if *of == Some(surface) {
                    known |= 1 << other;
                    within |= u8::from(bounds.on_screen[other] <= spare) << other;
                }
            }
        }
        within
    }

    /// Faces of a chunk that the nodes above them say are linear.
    #[inline]
    fn linear_by_nodes(&self, budget: &Budget, decided: &mut Decided, chunk: usize, back: bool) -> u64 {
        for level in (0..budget.tree.levels.len()).rev() {
            // The lowest level's groups are the chunks.
            let group = if level == 0 { chunk } else { chunk >> (3 * level) };
            let within = decided
                .nodes((level, group), back)
                .get_or_insert_with(|| self.nodes_within(budget, (level, group), back));
            let within = *within;
            if level == 0 {
                return bytes_of(within);
            }
            if within >> ((chunk >> (3 * (level - 1))) % LANES) & 1 == 1 {
                return !0;
            }
        }
        0
    }

    /// Settles the faces of a chunk among those in `left` as far as bounds do. `first` is the first one's index, `back`
    /// has the bits of those that show their other side.
    #[inline]
    pub(in crate::render) fn settled(
        &self,
        budget: &Budget,
        (first, back): (usize, u64),
        decided: &mut Decided,
        left: u64,
    ) -> Settled {
        let chunk = first / cull::CHUNK;
        let mut unknown = left & !*decided.linear(chunk);
        if let Some(choices) = decided.chosen(chunk) {
            unknown &= !those(unknown, |at| choices[at] != Choice::Unknown);
        }
        let mut settled = Settled { linear: left & !unknown & *decided.linear(chunk), ..Settled::default() };
        if unknown == 0 {
            return settled;
        }
        for (side, of_side) in [(false, unknown & !back), (true, unknown & back)] {
            if of_side != 0 {
                settled.linear |= of_side & self.linear_by_nodes(budget, decided, chunk, side);
            }
        }
        unknown &= !settled.linear;
        if unknown != 0 {
            self.settle_faces(budget, (first, back), decided, unknown, &mut settled);
        }
        *decided.linear(chunk) |= settled.linear;
        settled
    }

    /// Settles faces of a chunk, eight at a time.
    #[inline(never)]
    fn settle_faces(
        &self,
        budget: &Budget,
        (first, back): (usize, u64),
        decided: &mut Decided,
        mut unknown: u64,
        settled: &mut Settled,
    ) {
        let surfaces = &self.geometry.triangle_surfaces[first..];
        let (linear, exact) = (budget.spare(LINEAR_ROUNDING), budget.spare(EXACT_ROUNDING));
        let choices = decided.of_chunk(first / cull::CHUNK);
        while unknown != 0 {
            let surface = surfaces[unknown.trailing_zeros() as usize];
            let (mut places, mut count, mut left) = ([0; LANES], 0, unknown);
            while left != 0 && count < LANES {
                let at = left.trailing_zeros() as usize;
                left &= left - 1;
                if surfaces[at] == surface {
                    places[count] = at;
                    count += 1;
                    unknown &= !(1 << at);
                }
            }
            let places = &places[..count];
            let (faces, mut shapes) = self.eight(budget, first, places.iter().map(|&at| (at, back >> at & 1 == 1)));
            let bounds = self.bounds::<true, _>(budget, (&faces, &shapes), surface, false);
            let mut open = false;
            for (lane, &at) in places.iter().enumerate() {
                if bounds.on_screen[lane] <= linear {
                    settled.linear |= 1 << at;
                } else if bounds.on_face[lane] <= exact {
                    choices[at] = Choice::Float;
                } else {
                    open = true;
                }
            }
            if !open {
                continue;
            }
            shapes.part = [COARSEST; LANES];
            shapes.bend = ZERO;
            let parts = self.bounds::<false, _>(budget, (&faces, &shapes), surface, false);
            for (lane, &at) in places.iter().enumerate() {
                let (part, whole) = (parts.on_face[lane], bounds.on_face[lane]);
                settled.hopeless |= u64::from(part > exact) << at;
                let is_hopeless = part > LINEAR_MODEL * linear || whole > MOST_LIKELY * linear;
                settled.hopeless_if_small |= u64::from(is_hopeless) << at;
            }
        }
    }

    /// Up to eight faces of a chunk, and their shapes as a whole.
    #[inline]
    fn eight(
        &self,
        budget: &Budget,
        first: usize,
        places: impl Iterator<Item = (usize, bool)>,
    ) -> (EightFaces, Shapes) {
        let mut faces = EightFaces { normals: [[ZERO; 3]; 3], positions: [[ZERO; 3]; 3] };
        let mut shapes = Shapes { spread: ZERO, edge: ZERO, part: [1.0; LANES], bend: ZERO };
        // Suns on a matt body far from the eye ask for no positions.
        let asks = self.full || self.channels || budget.depths.nearest < NEAR_EDGES * budget.tree.longest();
        for (lane, (at, back)) in places.enumerate() {
            let side = if back { -1.0 } else { 1.0 };
            let facet = &budget.tree.facets[first + at];
            (shapes.spread[lane], shapes.edge[lane]) = (facet.spread, facet.edge);
            for (corner, i) in self.geometry.triangles[first + at].into_iter().enumerate() {
                let normal = self.geometry.normals[i as usize] * side;
                for axis in 0..3 {
                    faces.normals[corner][axis][lane] = normal[axis];
                }
                if asks {
                    let position = self.geometry.positions[i as usize];
                    for axis in 0..3 {
                        faces.positions[corner][axis][lane] = position[axis];
                    }
                }
            }
        }
        if asks {
            for (bend, ratio) in shapes.bend.iter_mut().zip(budget.depths.ratios(&faces)) {
                *bend = lesser(ratio / 4.0, 1.0);
            }
        } else {
            for (bend, edge) in shapes.bend.iter_mut().zip(shapes.edge) {
                *bend = edge / (2.0 * budget.depths.nearest);
            }
        }
        (faces, shapes)
    }

    /// Bounds of parts of one face: eight of them, of these sizes and bends.
    #[inline(never)]
    pub(super) fn bounds_of_parts(
        &self,
        budget: &Budget,
        face: Face,
        (part, bend): (Lanes<f32>, Lanes<f32>),
        below: bool,
    ) -> Bounds {
        let eight = core::iter::repeat_n((0, face.back_facing), LANES);
        let (faces, shapes) = self.eight(budget, face.index as usize, eight);
        self.bounds::<false, _>(budget, (&faces, &Shapes { part, bend, ..shapes }), face.surface, below)
    }

    /// The shading of a face that is clipped: it has no place on the screen.
    pub(in crate::render) fn decide_clipped(&self, budget: &Budget, face: Face) -> Choice {
        let (faces, shapes) = self.eight(budget, face.index as usize, core::iter::once((0, face.back_facing)));
        let bounds = self.bounds::<true, _>(budget, (&faces, &shapes), face.surface, false);
        if bounds.on_face[0] <= budget.spare(EXACT_ROUNDING) || !self.lights_pixels {
            Choice::Float
        } else {
            Choice::Phong
        }
    }

    /// Bounds the error of linear shades, wherever on the object, in shades, and rounding aside.
    #[inline(never)]
    pub(in crate::render) fn linear_error(&self) -> f64 {
        let geometry = &self.geometry;
        let tree =
            super::Tree::new(geometry.triangles, geometry.triangle_surfaces, geometry.positions, geometry.normals);
        let budget =
            Budget { depths: Depths::new(self.view, &tree), tree, kernel: Some(self.kernel), ..Budget::default() };
        let sides: &[bool] = if self.culls { &[false] } else { &[false, true] };
        let mut most = 0.0_f32;
        for (at, surfaces) in geometry.triangle_surfaces.chunks(LANES).enumerate() {
            for &back in sides {
                let (faces, shapes) = self.eight(&budget, at * LANES, (0..surfaces.len()).map(|face| (face, back)));
                for (i, &surface) in surfaces.iter().enumerate() {
                    if i > 0 && surfaces[i - 1] == surface {
                        continue;
                    }
                    let bounds = self.bounds::<true, _>(&budget, (&faces, &shapes), surface, false);
                    let here = bounds.on_screen.iter().zip(surfaces).filter(|(_, of)| **of == surface);
                    most = here.fold(most, |most, (error, _)| if *error <= most { most } else { *error });
                }
            }
        }
        f64::from(most) * 255.0
    }
}

/// Eight bits for each bit.
fn bytes_of(bits: u8) -> u64 {
    (0..8).map(|bit| u64::from(bits >> bit & 1) * (0xFF << (8 * bit))).sum()
}

/// Returns those of the bits for which this holds.
#[inline(always)]
fn those(mut bits: u64, is_one: impl Fn(usize) -> bool) -> u64 {
    let mut those = 0;
    while bits != 0 {
        let at = bits.trailing_zeros() as usize;
        bits &= bits - 1;
        those |= u64::from(is_one(at)) << at;
    }
    those
}
