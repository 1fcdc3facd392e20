//! Clusters of a mesh: eight consecutive faces each, with a box and a cone of normals. Eight clusters are a chunk.

use alloc::vec::Vec;

use glam::Vec3;

use super::ranges::{EightClusters, ZERO};
use crate::lanes::{LANES, Lanes};
use crate::mesh::wide::{dot, widen};
use crate::raster::pick::CHUNK;
use crate::render::geometry::Geometry;

/// Radii of a face (Lemma 1), which do not depend on the light.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Facet {
    /// Radius of its normals.
    pub(super) spread: f32,
    /// Radius of its positions.
    pub(super) edge: f32,
}

/// Radius of the smallest ball that contains three points.
pub(super) fn radius(points: [Vec3; 3]) -> f32 {
    // In f32 the squares of short edges would underflow.
    let square = |(i, j): (usize, usize)| {
        let edge = widen(points[i] - points[j]);
        dot(edge, edge)
    };
    let [a, b, c] = [(0, 1), (1, 2), (2, 0)].map(square);
    let longest = a.max(b).max(c);
    let others = a + b + c - longest;
    // Half of the longest edge or, for an acute triangle, the circumradius: R² = a²b²c² / 16K²,
    // from the squared sides. R² is at most a third of the longest edge's square.
    let around = a * b * c / (2.0 * (a * b + b * c + c * a) - (a * a + b * b + c * c));
    let square = if others > longest && around <= longest / 3.0 { around.max(longest / 4.0) } else { longest / 3.0 };
    let square = if others <= longest { longest / 4.0 } else { square };
    libm::sqrt(square) as f32 * (1.0 + 1e-5)
}

/// The eight clusters of a chunk. Missing ones are all zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chunk {
    pub(super) clusters: EightClusters,
    pub(super) spread: Lanes<f32>,
    pub(super) edge: Lanes<f32>,
    /// The surface of each cluster's faces, if they share one.
    pub(super) surfaces: [Option<u16>; LANES],
}

impl Chunk {
    fn new(facets: &[Facet], triangles: &[[u32; 3]], surfaces: &[u16], geometry: &Geometry<'_>) -> Self {
        let Geometry { positions, normals, .. } = *geometry;
        let clusters = EightClusters { centres: [ZERO; 3], halves: [ZERO; 3], axes: [ZERO; 3], angles: ZERO };
        let mut chunk = Self { clusters, spread: ZERO, edge: ZERO, surfaces: [None; LANES] };
        let parts = facets.chunks(LANES).zip(triangles.chunks(LANES)).zip(surfaces.chunks(LANES));
        for (lane, ((facets, triangles), surfaces)) in parts.enumerate() {
            let (mut min, mut max, mut sum) = (Vec3::INFINITY, Vec3::NEG_INFINITY, Vec3::ZERO);
            let corners = || triangles.iter().flatten().map(|&i| i as usize);
            for i in corners() {
                (min, max, sum) = (min.min(positions[i]), max.max(positions[i]), sum + normals[i]);
            }
            let cone = sum.normalize_or_zero();
            let cosine = corners().map(|i| normals[i].dot(cone)).fold(1.0, f32::min);
            for axis in 0..3 {
                // Halved separately, since their sum might overflow.
                let (min, max) = (min[axis] * 0.5, max[axis] * 0.5);
                chunk.clusters.centres[axis][lane] = min + max;
                chunk.clusters.halves[axis][lane] = (max - min) * (1.0 + 1e-5) + 1e-6 * (min.abs() + max.abs());
                chunk.clusters.axes[axis][lane] = cone[axis];
            }
            // The thousandth allows for the rounding of cosines near 1.
            chunk.clusters.angles[lane] = if cosine > 0.0 { libm::acosf(cosine) + 1e-3 } else { core::f32::consts::PI };
            chunk.spread[lane] = facets.iter().map(|facet| facet.spread).fold(0.0, f32::max);
            chunk.edge[lane] = facets.iter().map(|facet| facet.edge).fold(0.0, f32::max);
            chunk.surfaces[lane] = surfaces.first().copied().filter(|first| surfaces.iter().all(|of| of == first));
        }
        chunk
    }
}

/// Radii of a mesh's faces, and the clusters of each chunk.
#[derive(Clone, Debug, Default)]
pub(super) struct Clusters {
    pub(super) facets: Vec<Facet>,
    pub(super) chunks: Vec<Chunk>,
    /// The greatest coordinate.
    pub(super) extent: f32,
}

impl Clusters {
    pub(super) fn new(geometry: &Geometry<'_>) -> Self {
        let Geometry { triangles, triangle_surfaces, positions, normals, .. } = *geometry;
        let corners = |of: &[Vec3], indices: [u32; 3]| indices.map(|i| of[i as usize]);
        let facet =
            |&i: &[u32; 3]| Facet { spread: radius(corners(normals, i)).min(1.0), edge: radius(corners(positions, i)) };
        let facets: Vec<Facet> = triangles.iter().map(facet).collect();
        let chunks = facets.chunks(CHUNK).zip(triangles.chunks(CHUNK));
        let chunks = chunks.zip(triangle_surfaces.chunks(CHUNK));
        let chunk = |((facets, triangles), surfaces)| Chunk::new(facets, triangles, surfaces, geometry);
        let chunks = chunks.map(chunk).collect();
        let extent = positions.iter().fold(0.0, |most: f32, at| most.max(at.abs().max_element()));
        Self { facets, chunks, extent }
    }
}
