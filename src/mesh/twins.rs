//! Triangles that lie back to back: of the same three points, and wound in opposite ways.
//!
//! Both have the same depth at every pixel. Only the one that looks toward the eye is seen, so the renderer leaves out
//! the other. Leaves are made so, each side with a normal and a surface of its own. Scans have such triangles by
//! mistake.

use alloc::vec;
use alloc::vec::Vec;

use super::Mesh;
use super::topology::Edges;

/// Marks the triangles that lie back to back with another, by a bit each, 64 in a word. Empty if none does.
pub(super) fn mark(edges: &Edges, triangles: &[[u32; 3]], points: &[u32]) -> Vec<u64> {
    let mut twins = Vec::new();
    edges.opposites(triangles, points, |ups, downs| {
        twins.resize(triangles.len().div_ceil(64), 0);
        ups.iter().chain(downs).for_each(|&triangle| twins[triangle as usize / 64] |= 1 << (triangle % 64));
    });
    twins
}

impl Mesh {
    /// Returns whether a triangle lies back to back with another one: with the same three points, wound the other way.
    /// The one of them that looks toward the eye is drawn.
    #[must_use]
    pub fn has_twin(&self, triangle: usize) -> bool {
        self.twins.get(triangle / 64).is_some_and(|bits| bits >> (triangle % 64) & 1 == 1)
    }

    /// A bit for each triangle, 64 in a word, as [`has_twin`](Self::has_twin) says; empty if no triangle has one.
    pub(crate) fn twins(&self) -> &[u64] {
        &self.twins
    }
}

/// The pairs of triangles back to back that a closed mesh has by mistake, in a list of both: membranes between faces
/// that are there without them, and faces that are there once more and once the other way round.
///
/// A **sheet** is no mistake. Its pairs are joined at edges where no other face is, and have a free rim, an edge of one
/// pair alone, as a leaf or a fin has; or they touch nothing else, as a body whose faces are all there both ways. Two
/// sides of different surfaces are no mistake either. Leaving out pairs changes no winding number.
pub(super) fn mistaken(
    edges: &Edges,
    triangles: &[[u32; 3]],
    points: &[u32],
    triangle_surfaces: &[u16],
) -> Vec<[u32; 2]> {
    use super::sets::Sets;

    const NONE: u32 = u32::MAX;
    let mut pairs: Vec<[u32; 2]> = Vec::new();
    edges.opposites(triangles, points, |ups, downs| {
        // The last of each: what is left over keeps its place.
        pairs.extend(ups.iter().rev().zip(downs.iter().rev()).map(|(&up, &down)| [up, down]));
    });
    if pairs.is_empty() {
        return pairs;
    }
    let mut pair_of = vec![NONE; triangles.len()];
    for (number, pair) in pairs.iter().enumerate() {
        // Fewer than triangles.
        pair.iter().for_each(|&triangle| pair_of[triangle as usize] = number as u32);
    }
    let mut sheets = Sets::new(pairs.len() as u32);
    let (mut has_rim, mut touches) = (vec![false; pairs.len()], vec![false; pairs.len()]);
    let mut here: Vec<u32> = Vec::new();
    for faces in edges.faces_by_edge() {
        here.clear();
        here.extend(faces.map(|(_, corner)| pair_of[corner / 3]));
        here.sort_unstable();
        // Each pair has both its triangles here.
        here.dedup();
        match *here.as_slice() {
            [NONE] => {}
            [pair] => has_rim[pair as usize] = true,
            [ref pairs @ .., NONE] => pairs.iter().for_each(|&pair| touches[pair as usize] = true),
            [first, ref others @ ..] => others.iter().for_each(|&other| sheets.join(first, other)),
            [] => {}
        }
    }
    let (mut keep, mut is_held) = (vec![false; pairs.len()], vec![false; pairs.len()]);
    for (number, &[up, down]) in pairs.iter().enumerate() {
        let sheet = sheets.of(number as u32) as usize;
        let differ = triangle_surfaces[up as usize] != triangle_surfaces[down as usize];
        keep[sheet] |= has_rim[number] || differ;
        is_held[sheet] |= touches[number];
    }
    let numbers = 0..pairs.len() as u32;
    let mistaken = |number: &u32| {
        let sheet = sheets.of(*number) as usize;
        is_held[sheet] && !keep[sheet]
    };
    numbers.filter(mistaken).map(|number| pairs[number as usize]).collect()
}
