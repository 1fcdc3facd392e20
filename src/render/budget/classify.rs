//! Classifies a chunk's faces as linear or not, by bounds on whole clusters first, then on eight faces at a time.

use super::bound::{Bounds, Incident, Shapes, error_at_best};
use super::clusters::Clusters;
use super::ranges::{EightClusters, EightFaces, Patches, ZERO, dot, greater, lesser, splat};
use super::{Budget, EXACT_ROUNDING, FLOAT, LINEAR_ROUNDING, PHONG};
use crate::lanes::{LANES, Lanes, each};
use crate::plan::FaceShading;
use crate::raster::pick::CHUNK;
use crate::render::faces::{Face, Faces};
use crate::view::ObjectView;

/// Classes of the faces of a chunk, a bit for each.
#[derive(Clone, Copy)]
pub(in crate::render) struct Classes {
    /// Faces that are linear on the screen.
    pub(in crate::render) linear: u64,
    /// Other faces, linear on the face.
    pub(in crate::render) float: u64,
    /// Bounds of the other faces for shades linear on the face, as fractions of full intensity.
    pub(in crate::render) errors: [f32; CHUNK],
}

/// How far perspective shifts a shade, relative to its range, (ρ − 1) / 4 (Lemma 9), on each of eight clusters. Nothing
/// drawn unclipped is nearer than the near plane.
#[inline(always)]
fn bend_of_clusters(view: &ObjectView, clusters: &EightClusters, edge: &Lanes<f32>) -> Lanes<f32> {
    let ((row, offset), scale) = (view.along_view(), view.scale as f32);
    let middle = dot(&clusters.centres, &splat(row));
    let half = dot(&clusters.halves, &splat([row[0].abs(), row[1].abs(), row[2].abs()]));
    each!(lane => {
        let slack = 1e-5 * (middle[lane].abs() + half[lane] + offset.abs());
        let near = greater(middle[lane] + offset - half[lane] - slack, view.near);
        lesser(edge[lane] * scale / (2.0 * near), 1.0)
    })
}

/// How far perspective shifts a shade, relative to its range, on each of eight faces.
#[inline(always)]
fn bend_of_faces(view: &ObjectView, faces: &EightFaces) -> Lanes<f32> {
    let (row, offset) = view.along_view();
    let ([a, b, c], row) = (&faces.positions, splat(row));
    let [a, b, c] = [dot(a, &row), dot(b, &row), dot(c, &row)];
    each!(lane => {
        let (most, least) = (greater(a[lane], greater(b[lane], c[lane])), lesser(a[lane], lesser(b[lane], c[lane])));
        let slack = 1e-6 * (most.abs() + least.abs() + offset.abs());
        let near = greater(least + offset - slack, view.near);
        lesser((most - least + slack) / near / 4.0, 1.0)
    })
}

impl Faces<'_> {
    /// Bounds the error on eight patches of a surface.
    fn bounds<P: Patches>(
        &self,
        budget: &Budget,
        (patches, shapes): (&P, &Shapes),
        surface: u16,
        below: bool,
    ) -> Bounds {
        let reflectance = &self.materials[usize::from(surface)].reflectance;
        let (extent, in_color) = (budget.clusters.extent, self.stages.has_channels());
        let incident = Incident { lights: self.lights, reflectance, extent, in_color, below };
        error_at_best(self.kernel, patches, shapes, &incident)
    }

    /// Faces of a chunk whose clusters are linear, among those that show their fronts or, with
    /// `back`, their backs.
    #[inline(never)]
    fn linear_by_clusters(&self, budget: &Budget, chunk: usize, back: bool) -> u64 {
        let chunk = &budget.clusters.chunks[chunk];
        let mut clusters = chunk.clusters;
        if back {
            clusters.axes.iter_mut().flatten().for_each(|axis| *axis = -*axis);
        }
        let bend = bend_of_clusters(self.view, &clusters, &chunk.edge);
        let shapes = Shapes { spread: chunk.spread, edge: chunk.edge, part: None, bend };
        let spare = budget.spare(LINEAR_ROUNDING);
        let mut linear = 0;
        for (first, of) in chunk.surfaces.iter().enumerate() {
            let Some(surface) = *of else { continue };
            if chunk.surfaces[..first].contains(of) {
                continue;
            }
            let bounds = self.bounds(budget, (&clusters, &shapes), surface, false);
            for lane in first..LANES {
                if chunk.surfaces[lane] == *of && bounds.on_screen[lane] <= spare {
                    linear |= 0xFF << (LANES * lane);
                }
            }
        }
        linear
    }

    /// Classifies the faces of a chunk among those in `left`. `first` is the index of the first face, and `back` has
    /// the bits of those that show their backs.
    #[inline]
    pub(in crate::render) fn classify(&self, budget: &Budget, (first, back): (usize, u64), left: u64) -> Classes {
        let mut classes = Classes { linear: 0, float: 0, errors: [0.0; CHUNK] };
        if budget.spare(EXACT_ROUNDING) <= 0.0 {
            return classes;
        }
        for (side, of_side) in [(false, left & !back), (true, left & back)] {
            if of_side != 0 {
                classes.linear |= of_side & self.linear_by_clusters(budget, first / CHUNK, side);
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
            let (mut chosen, mut count, mut left) = ([0; LANES], 0, unknown);
            while left != 0 && count < LANES {
                let at = left.trailing_zeros() as usize;
                left &= left - 1;
                if surfaces[at] == surface {
                    chosen[count] = at;
                    count += 1;
                    unknown &= !(1 << at);
                }
            }
            let chosen = &chosen[..count];
            let (faces, shapes) = self.eight(budget, first, chosen.iter().map(|&at| (at, back >> at & 1 == 1)));
            let bounds = self.bounds(budget, (&faces, &shapes), surface, false);
            for (lane, &at) in chosen.iter().enumerate() {
                let (on_screen, on_face) = (bounds.on_screen[lane], bounds.on_face[lane]);
                let is_linear = on_screen <= linear;
                classes.linear |= u64::from(is_linear) << at;
                classes.float |= u64::from(!is_linear && on_face <= exact) << at;
                classes.errors[at] = on_face;
            }
        }
    }

    /// Up to eight faces of a chunk, and their shapes as whole faces.
    #[inline]
    fn eight(
        &self,
        budget: &Budget,
        first: usize,
        chosen: impl Iterator<Item = (usize, bool)>,
    ) -> (EightFaces, Shapes) {
        let mut faces = EightFaces { normals: [[ZERO; 3]; 3], positions: [[ZERO; 3]; 3] };
        let mut shapes = Shapes { spread: ZERO, edge: ZERO, part: None, bend: ZERO };
        for (lane, (at, back)) in chosen.enumerate() {
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
        shapes.bend = bend_of_faces(self.view, &faces);
        (faces, shapes)
    }

    /// Bounds the error on parts of one face: eight of them, with these sizes and bends.
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
        self.bounds(budget, (&faces, &Shapes { part: Some(part), bend, ..shapes }), face.surface, below)
    }

    /// The shading of a clipped face, which has no position on the screen.
    pub(in crate::render) fn decide_clipped(&self, budget: &Budget, face: Face) -> FaceShading {
        let (faces, shapes) = self.eight(budget, face.index as usize, core::iter::once((0, face.back_facing)));
        let bounds = self.bounds(budget, (&faces, &shapes), face.surface, false);
        if bounds.on_face[0] <= budget.spare(EXACT_ROUNDING) || !self.stages.lights_pixels() { FLOAT } else { PHONG }
    }

    /// Bounds the error of linear shades anywhere on the object, in shades, not counting rounding.
    #[inline(never)]
    pub(in crate::render) fn linear_error(&self) -> f64 {
        let budget = Budget { clusters: Clusters::new(&self.geometry), ..Budget::default() };
        let sides: &[bool] = if self.stages.culls() { &[false] } else { &[false, true] };
        let (mut first, mut most) = (0, 0.0_f32);
        let of_one_surface = self.geometry.triangle_surfaces.chunk_by(|a, b| a == b);
        for surfaces in of_one_surface.flat_map(|run| run.chunks(LANES)) {
            for &back in sides {
                let eight = (0..surfaces.len()).map(|face| (face, back));
                let (faces, shapes) = self.eight(&budget, first, eight);
                let bounds = self.bounds(&budget, (&faces, &shapes), surfaces[0], false);
                let errors = bounds.on_screen.iter().take(surfaces.len());
                most = errors.fold(most, |most, error| if *error <= most { most } else { *error });
            }
            first += surfaces.len();
        }
        // No two shades differ by more.
        f64::from(most.min(1.0)) * 255.0
    }
}
