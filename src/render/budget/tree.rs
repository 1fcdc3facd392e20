//! The tree of a mesh: nodes of 8, 64, 512 … faces that follow each other. There are no pointers: node n of a level holds
//! nodes 8n to 8n + 7 of the level below, or these faces.

use alloc::vec::Vec;

use glam::Vec3;

use super::ranges::{EightNodes, ZERO, dot};
use crate::lanes::{LANES, Lanes};

const PI: f32 = core::f32::consts::PI;

/// Radii of a face (Lemma 1), whatever the light.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Facet {
    /// Radius of its normals.
    pub(super) spread: f32,
    /// Radius of its positions.
    pub(super) edge: f32,
}

impl Facet {
    pub(super) fn new(positions: [Vec3; 3], normals: [Vec3; 3]) -> Self {
        Self { spread: radius(normals).min(1.0), edge: radius(positions) }
    }
}

/// Radius of the smallest ball that three points lie in.
fn radius(points: [Vec3; 3]) -> f32 {
    let square = |(i, j): (usize, usize)| f64::from((points[i] - points[j]).length_squared());
    let [a, b, c] = [(0, 1), (1, 2), (2, 0)].map(square);
    let longest = a.max(b).max(c);
    let others = a + b + c - longest;
    // That of the longest edge, or, of an acute triangle, the circumcircle: R² = a²b²c² / 16K², by the squares of the
    // sides. That is a third of the longest edge's at most.
    let around = a * b * c / (2.0 * (a * b + b * c + c * a) - (a * a + b * b + c * c));
    let square = if others > longest && around <= longest / 3.0 { around.max(longest / 4.0) } else { longest / 3.0 };
    let square = if others <= longest { longest / 4.0 } else { square };
    libm::sqrt(square) as f32 * (1.0 + 1e-5)
}

/// What lies in a node, while the tree is made.
#[derive(Clone, Copy, Debug)]
struct Node {
    min: Vec3,
    max: Vec3,
    axis: Vec3,
    /// Half of the cone's angle; π where it is a right angle or more.
    angle: f32,
    most: Facet,
    surface: Option<u16>,
}

impl Node {
    /// The node of some faces, at least one.
    fn of_faces(
        facets: &[Facet],
        triangles: &[[u32; 3]],
        surfaces: &[u16],
        positions: &[Vec3],
        normals: &[Vec3],
    ) -> Self {
        let (mut min, mut max, mut sum) = (Vec3::INFINITY, Vec3::NEG_INFINITY, Vec3::ZERO);
        for i in triangles.iter().flatten().map(|&i| i as usize) {
            (min, max, sum) = (min.min(positions[i]), max.max(positions[i]), sum + normals[i]);
        }
        let axis = sum.normalize_or_zero();
        let corners = triangles.iter().flatten().map(|&i| normals[i as usize].dot(axis));
        let cosine = corners.fold(1.0, f32::min);
        Self {
            min,
            max,
            axis,
            // A thousandth for the rounding of cosines near 1.
            angle: if cosine > 0.0 { libm::acosf(cosine) + 1e-3 } else { PI },
            most: greatest(facets.iter().copied()),
            surface: surfaces.first().copied().filter(|first| surfaces.iter().all(|of| of == first)),
        }
    }

    /// The node of some nodes, at least one.
    fn of_nodes(nodes: &[Self]) -> Self {
        let axis = nodes.iter().map(|node| node.axis).sum::<Vec3>().normalize_or_zero();
        let apart = |node: &Self| libm::acosf(node.axis.dot(axis).clamp(-1.0, 1.0)) + 1e-3 + node.angle;
        let angle = nodes.iter().map(apart).fold(0.0, f32::max);
        let first = nodes[0].surface;
        Self {
            min: nodes.iter().fold(Vec3::INFINITY, |min, node| min.min(node.min)),
            max: nodes.iter().fold(Vec3::NEG_INFINITY, |max, node| max.max(node.max)),
            axis,
            angle: if angle < PI / 2.0 { angle } else { PI },
            most: greatest(nodes.iter().map(|node| node.most)),
            surface: if nodes.iter().all(|node| node.surface == first) { first } else { None },
        }
    }
}

fn greatest(facets: impl Iterator<Item = Facet>) -> Facet {
    facets.fold(Facet::default(), |most, facet| Facet {
        spread: most.spread.max(facet.spread),
        edge: most.edge.max(facet.edge),
    })
}

/// Eight nodes that follow each other. Of those that are missing all is zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct Siblings {
    pub(super) nodes: EightNodes,
    pub(super) spread: Lanes<f32>,
    pub(super) edge: Lanes<f32>,
    /// The surface of each node's faces, if it is the same.
    pub(super) surfaces: [Option<u16>; LANES],
}

impl Siblings {
    fn new(nodes: &[Node]) -> Self {
        let mut siblings = Self {
            nodes: EightNodes { centres: [ZERO; 3], halves: [ZERO; 3], axes: [ZERO; 3], angles: ZERO },
            spread: ZERO,
            edge: ZERO,
            surfaces: [None; LANES],
        };
        for (lane, node) in nodes.iter().enumerate() {
            for axis in 0..3 {
                // Half of each, as their sum might overflow.
                let (min, max) = (node.min[axis] * 0.5, node.max[axis] * 0.5);
                siblings.nodes.centres[axis][lane] = min + max;
                siblings.nodes.halves[axis][lane] = (max - min) * (1.0 + 1e-5) + 1e-6 * (min.abs() + max.abs());
                siblings.nodes.axes[axis][lane] = node.axis[axis];
            }
            siblings.nodes.angles[lane] = node.angle;
            (siblings.spread[lane], siblings.edge[lane]) = (node.most.spread, node.most.edge);
            siblings.surfaces[lane] = node.surface;
        }
        siblings
    }
}

/// Bounds of a mesh's faces, and of the nodes above them.
#[derive(Clone, Debug, Default)]
pub(super) struct Tree {
    pub(super) facets: Vec<Facet>,
    /// The lowest has nodes of eight faces. The highest has eight nodes at most.
    pub(super) levels: Vec<Vec<Siblings>>,
    /// The greatest coordinate.
    pub(super) extent: f32,
    longest: f32,
}

impl Tree {
    pub(super) fn new(triangles: &[[u32; 3]], surfaces: &[u16], positions: &[Vec3], normals: &[Vec3]) -> Self {
        let corners = |of: &[Vec3], indices: [u32; 3]| indices.map(|i| of[i as usize]);
        let facet = |&i: &[u32; 3]| Facet::new(corners(positions, i), corners(normals, i));
        let facets: Vec<Facet> = triangles.iter().map(facet).collect();
        let node = |first: usize| {
            let faces = first..triangles.len().min(first + LANES);
            Node::of_faces(&facets[faces.clone()], &triangles[faces.clone()], &surfaces[faces], positions, normals)
        };
        let mut nodes: Vec<Node> = (0..triangles.len()).step_by(LANES).map(node).collect();
        let mut levels = Vec::new();
        loop {
            levels.push(nodes.chunks(LANES).map(Siblings::new).collect());
            if nodes.len() <= LANES {
                break;
            }
            nodes = nodes.chunks(LANES).map(Node::of_nodes).collect();
        }
        let extent = positions.iter().fold(0.0, |most: f32, at| most.max(at.abs().max_element()));
        let longest = facets.iter().fold(0.0, |most: f32, facet| most.max(facet.edge));
        Self { facets, levels, extent, longest }
    }

    /// The greatest radius of a face's positions.
    pub(super) fn longest(&self) -> f32 {
        self.longest
    }

    /// A lower bound of all positions along a direction.
    pub(super) fn least_along(&self, row: [f32; 3]) -> f32 {
        let mut least = f32::INFINITY;
        for Siblings { nodes, surfaces, edge, .. } in self.levels.last().into_iter().flatten() {
            let middle = dot(&nodes.centres, &row.map(|c| [c; LANES]));
            let half = dot(&nodes.halves, &row.map(|c| [c.abs(); LANES]));
            for lane in 0..LANES {
                // Missing nodes have neither.
                if edge[lane] > 0.0 || surfaces[lane].is_some() {
                    least = least.min(middle[lane] - half[lane]);
                }
            }
        }
        least
    }

    /// Bytes that it holds.
    pub(super) fn bytes(&self) -> usize {
        let siblings: usize = self.levels.iter().map(Vec::capacity).sum();
        self.facets.capacity() * size_of::<Facet>() + siblings * size_of::<Siblings>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Lemma 1: no point of a triangle has a greater mean square distance from the corners, weighted, and one has
        /// nearly as much.
        #[test]
        fn radii_are_of_the_smallest_balls(points in prop::array::uniform3(prop::array::uniform3(-1.0_f32..1.0)), thin in 0.0_f32..1.0) {
            let points = points.map(|p| Vec3::from(p) * Vec3::new(1.0, thin * thin, 0.3));
            let square = |weights: [f32; 3]| {
                let [ab, bc, ca] = [(0, 1), (1, 2), (2, 0)].map(|(i, j): (usize, usize)| {
                    f64::from((points[i] - points[j]).length_squared()) * f64::from(weights[i] * weights[j])
                });
                ab + bc + ca
            };
            let mut most = 0.0_f64;
            for a in 0..=60_u8 {
                for b in 0..=60 - a {
                    most = most.max(square([a, b, 60 - a - b].map(|share| f32::from(share) / 60.0)));
                }
            }
            let radius = f64::from(radius(points));
            prop_assert!(most <= radius * radius, "{most} of {radius}");
            prop_assert!(radius * radius <= most * 1.01 + 1e-12, "{radius}² of {most}");
        }
    }
}
