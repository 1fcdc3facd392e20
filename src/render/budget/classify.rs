//! Classification: which faces of a chunk are linear, by the bound on clusters, and on eight faces at a time.

use super::bound::{Bounds, Incident, Shapes, error_at_best};
use super::clusters::Clusters;
use super::ranges::{EightClusters, EightFaces, Patches, ZERO, dot, each, greater, lesser};
use super::{Budget, Depths, EXACT_ROUNDING, FLOAT, LINEAR_ROUNDING, PHONG};
use crate::lanes::{LANES, Lanes};
use crate::plan::FaceShading;
use crate::render::cull;
use crate::render::faces::Faces;
use crate::render::lit::Face;

/// Classes of the faces of a chunk, a bit for each.
#[derive(Clone, Copy)]
pub(in crate::render) struct Classes {
    /// Faces that are linear on the screen.
    pub(in crate::render) linear: u64,
    /// Others that are linear on the face.
    pub(in crate::render) float: u64,
    /// Bounds of the others, of shades that are linear on the face, in shares of full intensity.
    pub(in crate::render) errors: [f32; cull::CHUNK],
}

impl Depths {
    /// Share of a shade's range that perspective moves it along on each of eight clusters: (ρ − 1) / 4 (Lemma 9).
    #[inline(always)]
    fn bend_of_clusters(&self, clusters: &EightClusters, edge: &Lanes<f32>) -> Lanes<f32> {
        let middle = dot(&clusters.centres, &self.row.map(|c| [c; LANES]));
        let half = dot(&clusters.halves, &self.row.map(|c| [c.abs(); LANES]));
        each(|lane| {
            let slack = 1e-5 * (middle[lane].abs() + half[lane] + self.offset.abs());
            let near = greater(middle[lane] + self.offset - half[lane] - slack, self.near);
            lesser(edge[lane] * self.scale / (2.0 * near), 1.0)
        })
    }

    /// That share on each of eight faces.
    #[inline(always)]
    fn bend_of_faces(&self, faces: &EightFaces) -> Lanes<f32> {
        let row = self.row.map(|c| [c; LANES]);
        let [a, b, c] = faces.positions.each_ref().map(|at| dot(at, &row));
        each(|lane| {
            let (most, least) =
                (greater(a[lane], greater(b[lane], c[lane])), lesser(a[lane], lesser(b[lane], c[lane])));
            let slack = 1e-6 * (most.abs() + least.abs() + self.offset.abs());
            let near = greater(least + self.offset - slack, self.near);
            lesser((most - least + slack) / near / 4.0, 1.0)
        })
    }
}

impl Faces<'_> {
    /// Bounds of eight patches of a surface.
    fn bounds<const WHOLE: bool, P: Patches>(
        &self,
        budget: &Budget,
        (patches, shapes): (&P, &Shapes),
        surface: u16,
        below: bool,
    ) -> Bounds {
        let answer = &self.paints[usize::from(surface)].answer;
        let incident = Incident { lights: self.lights, answer, extent: budget.clusters.extent, below };
        if self.channels {
            error_at_best::<3, WHOLE, P>(self.kernel, patches, shapes, &incident)
        } else {
            error_at_best::<1, WHOLE, P>(self.kernel, patches, shapes, &incident)
        }
    }

    /// Faces of a chunk whose clusters are linear, where they show their fronts or their backs.
    #[inline(never)]
    fn linear_by_clusters(&self, budget: &Budget, chunk: usize, back: bool) -> u64 {
        let chunk = &budget.clusters.chunks[chunk];
        let mut clusters = chunk.clusters;
        if back {
            clusters.axes.iter_mut().flatten().for_each(|axis| *axis = -*axis);
        }
        let bend = budget.depths.bend_of_clusters(&clusters, &chunk.edge);
        let shapes = Shapes { spread: chunk.spread, edge: chunk.edge, part: [1.0; LANES], bend };
        let spare = budget.spare(LINEAR_ROUNDING);
        let (mut linear, mut known) = (0, 0_u8);
        for (lane, surface) in chunk.surfaces.iter().enumerate() {
            let Some(surface) = *surface else { continue };
            if known >> lane & 1 == 1 {
                continue;
            }
            let bounds = self.bounds::<true, _>(budget, (&clusters, &shapes), surface, false);
            for (other, of) in chunk.surfaces.iter().enumerate() {
                if *of == Some(surface) {
                    known |= 1 << other;
                    linear |= if bounds.on_screen[other] <= spare { 0xFF << (LANES * other) } else { 0 };
                }
            }
        }
        linear
    }

    /// Classifies the faces of a chunk among those in `left`. `first` is the first one's index, `back` has the bits of
    /// those that show their other side.
    #[inline]
    pub(in crate::render) fn classify(&self, budget: &Budget, (first, back): (usize, u64), left: u64) -> Classes {
        let mut classes = Classes { linear: 0, float: 0, errors: [0.0; cull::CHUNK] };
        if budget.spare(EXACT_ROUNDING) <= 0.0 {
            return classes;
        }
        for (side, of_side) in [(false, left & !back), (true, left & back)] {
            if of_side != 0 {
                classes.linear |= of_side & self.linear_by_clusters(budget, first / cull::CHUNK, side);
            }
        }
        if left & !classes.linear != 0 {
            self.classify_faces(budget, (first, back), left & !classes.linear, &mut classes);
        }
        classes
    }

    /// Classifies faces of a chunk, eight of a surface at a time.
    #[inline(never)]
    fn classify_faces(&self, budget: &Budget, (first, back): (usize, u64), mut unknown: u64, classes: &mut Classes) {
        let surfaces = &self.geometry.triangle_surfaces[first..];
        let (linear, exact) = (budget.spare(LINEAR_ROUNDING), budget.spare(EXACT_ROUNDING));
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
            let (faces, shapes) = self.eight(budget, first, places.iter().map(|&at| (at, back >> at & 1 == 1)));
            let bounds = self.bounds::<true, _>(budget, (&faces, &shapes), surface, false);
            for (lane, &at) in places.iter().enumerate() {
                let (on_screen, on_face) = (bounds.on_screen[lane], bounds.on_face[lane]);
                let is_linear = on_screen <= linear;
                classes.linear |= u64::from(is_linear) << at;
                classes.float |= u64::from(!is_linear && on_face <= exact) << at;
                classes.errors[at] = on_face;
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
        for (lane, (at, back)) in places.enumerate() {
            let side = if back { -1.0 } else { 1.0 };
            let facet = &budget.clusters.facets[first + at];
            (shapes.spread[lane], shapes.edge[lane]) = (facet.spread, facet.edge);
            for (corner, i) in self.geometry.triangles[first + at].into_iter().enumerate() {
                let (normal, position) =
                    (self.geometry.normals[i as usize] * side, self.geometry.positions[i as usize]);
                for axis in 0..3 {
                    faces.normals[corner][axis][lane] = normal[axis];
                    faces.positions[corner][axis][lane] = position[axis];
                }
            }
        }
        shapes.bend = budget.depths.bend_of_faces(&faces);
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
    pub(in crate::render) fn decide_clipped(&self, budget: &Budget, face: Face) -> FaceShading {
        let (faces, shapes) = self.eight(budget, face.index as usize, core::iter::once((0, face.back_facing)));
        let bounds = self.bounds::<true, _>(budget, (&faces, &shapes), face.surface, false);
        if bounds.on_face[0] <= budget.spare(EXACT_ROUNDING) || !self.lights_pixels { FLOAT } else { PHONG }
    }

    /// Bounds the error of linear shades, wherever on the object, in shades, and rounding aside.
    #[inline(never)]
    pub(in crate::render) fn linear_error(&self) -> f64 {
        let geometry = &self.geometry;
        let clusters =
            Clusters::new(geometry.triangles, geometry.triangle_surfaces, geometry.positions, geometry.normals);
        let (depths, kernel) = (Depths::new(self.view), Some(self.kernel));
        let budget = Budget { clusters, depths, kernel, ..Budget::default() };
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
