//! The topology of a mesh: which vertices are the same point, whether it is closed, and whether it is convex. The plan
//! relies on these answers to skip work, so they are exact, and "no" when in doubt.

use alloc::vec;
use alloc::vec::Vec;
use core::cmp::Ordering;
use core::ops::Range;

use glam::Vec3;

use super::orientation::side;
use super::wide::{add, cross, dot, length, scale, sub, widen};

/// The index of each vertex's point; vertices at the same position share it. 0 and −0 are the same position. Points are
/// numbered from 0 in no particular order.
pub(super) fn weld(positions: &[Vec3]) -> Vec<u32> {
    let keys = || positions.iter().map(|p| [(p.x + 0.0).to_bits(), (p.y + 0.0).to_bits(), (p.z + 0.0).to_bits()]);
    weld_by_hash(positions.len(), keys).unwrap_or_else(|| weld_by_sorting(keys()))
}

/// Welds with an open-addressing hash table, at most half full. Returns `None` if there are far more probes than chance
/// would cause, because the positions were chosen to collide.
fn weld_by_hash<K: Iterator<Item = [u32; 3]>>(count: usize, keys: impl Fn() -> K) -> Option<Vec<u32>> {
    const FREE: u32 = u32::MAX;
    let size = (2 * count).next_power_of_two();
    // A key, and the index of its point, which is below 2³¹.
    let mut table = vec![([0; 3], FREE); size];
    let mut points = Vec::with_capacity(count);
    // When half full, a search takes at most 2.5 probes on average (Knuth, The Art of Computer Programming, 6.4).
    let (mut next, mut left) = (0, count.saturating_mul(16) + 64);
    for key in keys() {
        let mut slot = hash(key) & (size - 1);
        loop {
            left = left.checked_sub(1)?;
            let (known, point) = &mut table[slot];
            if *point == FREE {
                (*known, *point) = (key, next);
                next += 1;
            } else if *known != key {
                slot = (slot + 1) & (size - 1);
                continue;
            }
            points.push(*point);
            break;
        }
    }
    Some(points)
}

/// Fibonacci hashing: multiplying by 2⁶⁴ over the golden ratio spreads each word over all 64 bits, the upper ones best.
fn hash(key: [u32; 3]) -> usize {
    const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;
    let mix = |hash: u64, word: u32| (hash ^ u64::from(word)).wrapping_mul(GOLDEN).rotate_left(29);
    // 32 bits are left.
    (key.into_iter().fold(0, mix).wrapping_mul(GOLDEN) >> 32) as usize
}

fn weld_by_sorting(keys: impl Iterator<Item = [u32; 3]>) -> Vec<u32> {
    // `Mesh` holds fewer than 2³¹ vertices.
    let mut order: Vec<([u32; 3], u32)> = keys.zip(0..).collect();
    order.sort_unstable();
    let mut points = vec![0; order.len()];
    let mut point = 0;
    for (i, &(key, vertex)) in order.iter().enumerate() {
        if i > 0 && order[i - 1].0 != key {
            point += 1;
        }
        points[vertex as usize] = point;
    }
    points
}

/// Returns whether a triangle has two corners at one point. Such a degenerate triangle draws
/// nothing, two of its edges cancel, and it does not count as part of the surface.
pub(super) fn is_line(triangle: [u32; 3]) -> bool {
    triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]
}

/// The edges of a triangle, from point to point.
fn edges([a, b, c]: [u32; 3]) -> [(u32, u32); 3] {
    [(a, b), (b, c), (c, a)]
}

fn welded(triangle: [u32; 3], points: &[u32]) -> [u32; 3] {
    triangle.map(|vertex| points[vertex as usize])
}

/// The edges of a mesh from point to point, grouped by the lower of their two points.
pub(super) struct Edges {
    /// The index where each point's edges begin, and where the last one's end.
    starts: Vec<u32>,
    /// The edges, grouped by point in order: twice the edge's higher point, plus 1 if it runs downward; and the corner
    /// where it starts, counted through all triangles.
    edges: Vec<(u32, u32)>,
}

impl Edges {
    pub(super) fn new(triangles: &[[u32; 3]], points: &[u32]) -> Self {
        let surface = || triangles.iter().map(|&t| welded(t, points)).enumerate().filter(|(_, t)| !is_line(*t));
        // A counting sort; points are numbered below the number of vertices. Counts are stored two slots ahead, so the
        // prefix sum leaves each point's start one slot ahead, and filling advances that slot to the start of the next
        // point's edges.
        let mut starts = vec![0_u32; points.len() + 2];
        for (_, corners) in surface() {
            edges(corners).into_iter().for_each(|(from, to)| starts[from.min(to) as usize + 2] += 1);
        }
        // Corners fit into 32 bits, see `Mesh::MAX_COUNT`.
        let mut sum = 0;
        starts.iter_mut().for_each(|start| {
            sum += *start;
            *start = sum;
        });
        let mut sorted = vec![(0, 0); sum as usize];
        for (triangle, corners) in surface() {
            for (i, (from, to)) in edges(corners).into_iter().enumerate() {
                let start = &mut starts[from.min(to) as usize + 1];
                // Points are below 2³¹.
                sorted[*start as usize] = (from.max(to) << 1 | u32::from(from > to), (3 * triangle + i) as u32);
                *start += 1;
            }
        }
        let mut edges = Self { starts, edges: sorted };
        for point in 0..points.len() {
            let range = edges.of(point);
            edges.edges[range].sort_unstable();
        }
        edges
    }

    /// The indices of the edges whose lower point this is.
    fn of(&self, point: usize) -> Range<usize> {
        self.starts[point] as usize..self.starts[point + 1] as usize
    }

    /// The faces at each edge, edge by edge: the edge's two points, the lower first; then for each face whether it
    /// traverses the edge downward, and the corner where that traversal starts.
    pub(super) fn each(&self) -> impl Iterator<Item = ((u32, u32), &[(u32, u32)])> {
        (0..self.starts.len() - 2).flat_map(|point| {
            // Points are below 2³¹.
            let one_edge = self.edges[self.of(point)].chunk_by(|a, b| a.0 >> 1 == b.0 >> 1);
            one_edge.map(move |faces| ((point as u32, faces[0].0 >> 1), faces))
        })
    }

    /// Returns whether every edge is traversed equally often in both directions: the surface bounds one or more solids.
    pub(super) fn balance(&self) -> bool {
        // Nearly all edges have two faces and need no counting.
        let balances = |faces: &[(u32, u32)]| match faces {
            [up, down] => up.0 & 1 == 0 && down.0 & 1 == 1,
            faces => 2 * faces.iter().filter(|face| face.0 & 1 == 1).count() == faces.len(),
        };
        !self.edges.is_empty() && self.each().all(|(_, faces)| balances(faces))
    }

    /// Returns whether every edge has exactly two faces, which traverse it in opposite directions.
    fn are_pairs(&self) -> bool {
        // In sorted order, the edges of such a mesh alternate: edge upward, edge downward, next edge upward … At an
        // edge with four faces, the order is upward, upward, downward, downward.
        let paired = |edges: &[(u32, u32)]| {
            let (pairs, rest) = edges.as_chunks::<2>();
            rest.is_empty() && pairs.iter().all(|[up, down]| up.0 & 1 == 0 && down.0 == up.0 + 1)
        };
        !self.edges.is_empty() && (0..self.starts.len() - 2).all(|point| paired(&self.edges[self.of(point)]))
    }

    /// For each edge, the corners where its two faces start it, if [all are pairs](Self::are_pairs).
    fn pairs(&self) -> impl Iterator<Item = [usize; 2]> {
        self.edges.as_chunks::<2>().0.iter().map(|pair| pair.map(|(_, corner)| corner as usize))
    }

    /// Calls `found` for triangles that lie back to back, with the same three points and opposite winding: first the
    /// list of those wound one way, then of those wound the other. Neither list is empty; each is in ascending order.
    pub(super) fn opposites(&self, triangles: &[[u32; 3]], points: &[u32], mut found: impl FnMut(&[u32], &[u32])) {
        let (mut sides, mut ups, mut downs) = (Vec::new(), Vec::new(), Vec::new());
        let third = |corner: u32| points[triangles[corner as usize / 3][(corner as usize + 2) % 3] as usize];
        for ((_, higher), faces) in self.each() {
            // Most edges have two faces, with different third corners.
            if let [a, b] = faces
                && third(a.1) != third(b.1)
            {
                continue;
            }
            // Two such triangles share all three edges; they are reported at the edge between their two lower points.
            sides.clear();
            sides.extend(faces.iter().map(|&(to, corner)| (third(corner), to & 1, corner / 3)));
            sides.retain(|&(far, ..)| far > higher);
            sides.sort_unstable();
            for equal in sides.chunk_by(|a, b| a.0 == b.0) {
                ups.clear();
                downs.clear();
                for &(_, side, triangle) in equal {
                    if side == 0 { ups.push(triangle) } else { downs.push(triangle) }
                }
                if !ups.is_empty() && !downs.is_empty() {
                    found(&ups, &downs);
                }
            }
        }
    }
}

/// Returns whether a mesh is closed and convex, and wound so that its faces point outward.
///
/// Each edge must have exactly two faces, which traverse it in opposite directions. Three further conditions together
/// suffice:
///
/// 1. The mean of the vertices lies behind every face.
/// 2. Seen from there, the faces cover the sphere once: their solid angles add up to 4π. So the surface is one piece,
///    is wholly visible from that point, and nowhere intersects itself.
/// 3. Across every edge, the far corner of the next face lies behind the face or in its plane. With (2) this makes the
///    surface convex about every vertex as well, and a closed, connected surface that is convex about each of its
///    points is convex (Tietze, Nakajima). (3) alone would not suffice: a double pyramid over a pentagram has only
///    convex edges.
///
/// (1) is tested in f64 with a margin, (3) exactly: a quad whose corners were rounded to f32 so that its diagonal lies
/// 10⁻⁸ too deep makes the mesh not convex, as does a face without area.
pub(super) fn is_convex(positions: &[Vec3], triangles: &[[u32; 3]], points: &[u32], edges: &Edges) -> bool {
    if !edges.are_pairs() {
        return false;
    }
    let corners = triangles.as_flattened();
    let sum = corners.iter().fold([0.0; 3], |sum, &vertex| add(sum, widen(positions[vertex as usize])));
    let inside = scale(sum, 1.0 / corners.len() as f64);

    let surface = || triangles.iter().filter(|t| !is_line(welded(**t, points)));
    let seen = |triangle: &[u32; 3]| triangle.map(|vertex| sub(widen(positions[vertex as usize]), inside));
    let is_behind = |triangle: &[u32; 3]| {
        let [a, b, c] = seen(triangle);
        // The rounding error is below 2⁻⁴⁹ of the product of the three lengths.
        dot(a, cross(b, c)) > length(a) * length(b) * length(c) * (1.0 / 281_474_976_710_656.0)
    };
    if !surface().all(is_behind) {
        return false;
    }

    // Tested before the solid angles, which take longer: few meshes are convex, and nearly all others have a concave
    // edge among the first ones tested.
    let far = |corner: usize| positions[triangles[corner / 3][(corner + 2) % 3] as usize];
    let dented = edges.pairs().any(|[one, other]| {
        let [a, b, c] = triangles[one / 3].map(|vertex| positions[vertex as usize]);
        side(a, b, c, far(other)) == Ordering::Greater
    });
    if dented {
        return false;
    }

    // A. van Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle", 1983.
    let solid_angle = surface().map(|triangle| {
        let [a, b, c] = seen(triangle);
        let (la, lb, lc) = (length(a), length(b), length(c));
        let below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        2.0 * libm::atan2(dot(a, cross(b, c)), below)
    });
    // The sum is a multiple of 4π, so half a sphere is margin enough.
    solid_angle.sum::<f64>() <= 6.0 * core::f64::consts::PI
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use super::{hash, weld_by_hash, weld_by_sorting};

    /// Renumbers the points in order of first appearance.
    fn in_order(points: &[u32]) -> Vec<usize> {
        let first = |point: &u32| points.iter().position(|other| other == point).expect("it is there");
        points.iter().map(first).collect()
    }

    #[test]
    fn a_hash_welds_as_sorting_does() {
        // A grid with some points two or three times.
        let keys = || (0..3_000_u32).map(|i| [(i * 7 % 1_000) << 20, i % 5, (i % 3) << 31]);
        let points = weld_by_hash(3_000, keys).expect("no collision beyond chance");
        assert_eq!(in_order(&points), in_order(&weld_by_sorting(keys())));
        assert_eq!(weld_by_hash(0, || [].into_iter()), Some(Vec::new()));
    }

    #[test]
    fn positions_made_to_collide_are_sorted() {
        // A hundred keys that hash to the same slot of a table of 256.
        let all = (0..).map(|i| [i, 1, 2]).filter(|key| hash(*key) & 255 == 0).take(100);
        let keys: Vec<[u32; 3]> = all.collect();
        assert_eq!(weld_by_hash(100, || keys.iter().copied()), None);
    }
}
