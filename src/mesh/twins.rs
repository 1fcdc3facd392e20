//! Triangles that lie back to back: same three points, opposite winding.
//!
//! Both have the same depth at every pixel. Only the one that faces the eye is visible, so the renderer skips the
//! other. Leaves are modelled like this, each side with its own normal and surface; in scans such triangles are
//! defects.

use alloc::vec;
use alloc::vec::Vec;

use super::Mesh;
use super::topology::Edges;

/// Marks each triangle that has a back-to-back twin with a bit, 64 per word. Empty if none has.
pub(super) fn mark(edges: &Edges, triangles: &[[u32; 3]], points: &[u32]) -> Vec<u64> {
    let mut twins = Vec::new();
    edges.opposites(triangles, points, |ups, downs| {
        twins.resize(triangles.len().div_ceil(64), 0);
        ups.iter().chain(downs).for_each(|&triangle| twins[triangle as usize / 64] |= 1 << (triangle % 64));
    });
    twins
}

impl Mesh {
    /// Returns whether a triangle lies back to back with another: same three points, opposite winding. Of the two, the
    /// one that faces the eye is drawn.
    #[must_use]
    pub fn has_twin(&self, triangle: usize) -> bool {
        self.twins.get(triangle / 64).is_some_and(|bits| bits >> (triangle % 64) & 1 == 1)
    }

    /// The values of [`has_twin`](Self::has_twin), a bit for each triangle, 64 per word; empty if no triangle has a
    /// twin.
    pub(crate) fn twins(&self) -> &[u64] {
        &self.twins
    }
}

/// The pairs of back-to-back triangles that a closed mesh has by mistake, as the indices of both:
/// membranes inside a surface that is complete without them, and duplicated faces with a reversed
/// copy.
///
/// A **sheet** is intended: its pairs are joined at edges that no other face shares, and either have a free rim (an
/// edge of a single pair), like a leaf or a fin, or touch nothing else, like a solid with every face in both
/// orientations. Pairs whose sides have different surfaces are intended, too. Removing a pair changes no winding
/// number.
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
        // Pairs are taken from the end, so that unpaired triangles keep their index.
        pairs.extend(ups.iter().rev().zip(downs.iter().rev()).map(|(&up, &down)| [up, down]));
    });
    if pairs.is_empty() {
        return pairs;
    }
    let mut pair_of = vec![NONE; triangles.len()];
    for (number, pair) in pairs.iter().enumerate() {
        // There are fewer pairs than triangles.
        pair.iter().for_each(|&triangle| pair_of[triangle as usize] = number as u32);
    }
    let mut sheets = Sets::new(pairs.len() as u32);
    let (mut has_rim, mut touches) = (vec![false; pairs.len()], vec![false; pairs.len()]);
    let mut here: Vec<u32> = Vec::new();
    for (_, faces) in edges.each() {
        here.clear();
        here.extend(faces.iter().map(|&(_, corner)| pair_of[corner as usize / 3]));
        here.sort_unstable();
        // Both triangles of a pair share the edge.
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
