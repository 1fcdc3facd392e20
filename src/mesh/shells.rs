//! The solids that make up a closed mesh, and which of them are inside out.
//!
//! A **shell** is a part of the surface that is closed by itself. Two faces that share an edge with no third face are
//! in the same shell. Where more faces meet at an edge, only the parts that do not balance there (more of their faces
//! traverse the edge in one direction than in the other) are joined. So two boxes that touch along an edge are two
//! shells.
//!
//! A shell with negative volume is inside out, unless it is a **cavity**: the winding number of the larger shells, once
//! flipped themselves, is at least one around it. This is tested at a point on one of its faces, by counting crossings
//! along a ray from outside.

use alloc::vec;
use alloc::vec::Vec;

use glam::Vec3;

use super::sets::Sets;
use super::topology::Edges;
use super::wide::{Wide, cross, dot, scale, sub, widen};
use super::winding::{between, cross_row};

/// The shells that are inside out.
pub(super) struct InsideOut {
    /// The shell of each triangle.
    shell_of: Vec<u32>,
    /// Whether each shell is to be flipped.
    turned: Vec<bool>,
}

impl InsideOut {
    /// The shell of a triangle, if it is to be flipped.
    pub(super) fn shell(&self, triangle: usize) -> Option<usize> {
        let shell = self.shell_of[triangle] as usize;
        self.turned[shell].then_some(shell)
    }

    /// Counts all shells.
    pub(super) fn shells(&self) -> usize {
        self.turned.len()
    }

    /// Counts the shells to be flipped.
    pub(super) fn count(&self) -> usize {
        self.turned.iter().filter(|&&turned| turned).count()
    }
}

/// The shells of a closed mesh that are inside out; `None` if there is none.
pub(super) fn inside_out(positions: &[Vec3], triangles: &[[u32; 3]], edges: &Edges) -> Option<InsideOut> {
    let (shell_of, count) = shells(triangles.len(), edges);
    let volumes = volumes(positions, triangles, &shell_of, count);
    let suspects: Vec<u32> = (0..).zip(&volumes).filter(|(_, volume)| **volume < 0.0).map(|(shell, _)| shell).collect();
    if suspects.is_empty() {
        return None;
    }
    let enclosing = enclosing(positions, triangles, &shell_of, &suspects, count)?;
    // Larger shells first.
    let compare = |a: u32, b: u32| {
        let [a_size, b_size] = [a, b].map(|shell| volumes[shell as usize].abs());
        b_size.total_cmp(&a_size).then(a.cmp(&b))
    };
    // In the order of `compare`: positive numbers have the order of their bits.
    let size_bits = |&shell: &u32| volumes[shell as usize].abs().to_bits();
    let mut order: Vec<(u64, usize)> = suspects.iter().map(|shell| !size_bits(shell)).zip(0..).collect();
    order.sort_unstable();
    let mut turned = vec![false; count];
    for (_, suspect) in order {
        let shell = suspects[suspect];
        let winds = enclosing[suspect].iter().filter(|(other, _)| compare(*other, shell).is_lt());
        let winding: i32 = winds.map(|&(other, step)| if turned[other as usize] { -step } else { step }).sum();
        turned[shell as usize] = winding <= 0;
    }
    let found = InsideOut { shell_of, turned };
    (found.count() > 0).then_some(found)
}

/// The shell of each triangle, and the number of shells.
fn shells(triangles: usize, edges: &Edges) -> (Vec<u32>, usize) {
    // Triangles fit into 32 bits, see `Mesh::MAX_COUNT`.
    let mut sets = Sets::new(triangles as u32);
    let mut has_others = false;
    for (_, faces) in edges.each() {
        match faces {
            [a, b] => sets.join(a.1 / 3, b.1 / 3),
            _ => has_others = true,
        }
    }
    if has_others {
        // The parts that do not balance where they meet others. Joined together, they do.
        let mut joins = Vec::new();
        // For each face its set, with a last bit that is set if it runs down the edge.
        let mut here: Vec<u32> = Vec::new();
        for (_, faces) in edges.each().filter(|(_, faces)| faces.len() > 2) {
            here.clear();
            here.extend(faces.iter().map(|&(to, corner)| sets.of(corner / 3) << 1 | to & 1));
            here.sort_unstable();
            let sum = |part: &[u32]| part.iter().map(|face| if face & 1 == 0 { 1 } else { -1 }).sum::<i32>();
            let parts = here.chunk_by(|a, b| a >> 1 == b >> 1);
            let mut unbalanced = parts.filter(|part| sum(part) != 0).map(|part| part[0] >> 1);
            if let Some(first) = unbalanced.next() {
                joins.extend(unbalanced.map(|other| (first, other)));
            }
        }
        joins.into_iter().for_each(|(a, b)| sets.join(a, b));
    }
    // Shells are numbered from 0 in the order of their first triangles, which represent them.
    let (mut numbers, mut count) = (vec![0; triangles], 0);
    for triangle in 0..triangles {
        let stands = sets.of(triangle as u32) as usize;
        numbers[triangle] = if stands == triangle {
            count += 1;
            count - 1
        } else {
            numbers[stands]
        };
    }
    (numbers, count as usize)
}

/// The volume of each shell; 0 if it is within rounding error.
fn volumes(positions: &[Vec3], triangles: &[[u32; 3]], shell_of: &[u32], count: usize) -> Vec<f64> {
    // Six times the volumes of the tetrahedra from each shell's first vertex: their sum, and the sum of their
    // magnitudes.
    let mut sums: Vec<(Option<Wide>, f64, f64)> = vec![(None, 0.0, 0.0); count];
    for (triangle, &shell) in triangles.iter().zip(shell_of) {
        let [a, b, c] = triangle.map(|vertex| widen(positions[vertex as usize]));
        let (origin, sum, size) = &mut sums[shell as usize];
        let origin = *origin.get_or_insert(a);
        let six_volumes = dot(sub(a, origin), cross(sub(b, origin), sub(c, origin)));
        *sum += six_volumes;
        *size += six_volumes.abs();
    }
    // With fewer than 2³¹ terms, the error of the sum is below 2⁻²² of the sum of magnitudes, and usually far smaller.
    // A sheet whose two sides cancel encloses nothing, and is not flipped.
    sums.into_iter().map(|(_, sum, size)| if sum.abs() > size * (1.0 / 4_194_304.0) { sum } else { 0.0 }).collect()
}

/// The maximum number of tests of a face against a ray: about half a second, and as much again for each 65,536 faces.
const MAX_TESTS: u64 = 1 << 26;
const MAX_TESTS_PER_FACE: u64 = 1024;

/// For each shell in `wanted`, the other shells that wind around one of its points, with their
/// contributions to the winding number there: −1 or 1 for each of their faces that a ray crosses
/// before it. `None` if there are far too many tests, as for thousands of shells one inside the other; then the mesh is
/// left as it is.
fn enclosing(
    positions: &[Vec3],
    triangles: &[[u32; 3]],
    shell_of: &[u32],
    wanted: &[u32],
    count: usize,
) -> Option<Vec<Vec<(u32, i32)>>> {
    // Rays run along z, so the third coordinate is the distance along a ray, and the second one the ray's row.
    let corners = |triangle: &[u32; 3]| triangle.map(|vertex| widen(positions[vertex as usize]));
    // The ray goes through the middle of the shell's largest face as seen along the rays.
    let mut largest = vec![(0.0, [0.0; 3]); count];
    for (triangle, &shell) in triangles.iter().zip(shell_of) {
        let [a, b, c] = corners(triangle);
        let size = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
        let known = &mut largest[shell as usize];
        if size > known.0 {
            *known = (size, [0, 1, 2].map(|axis| scale(a, 1.0 / 3.0)[axis] + b[axis] / 3.0 + c[axis] / 3.0));
        }
    }
    let mut rays: Vec<(f64, usize)> =
        wanted.iter().enumerate().map(|(ray, &shell)| (largest[shell as usize].1[1], ray)).collect();
    rays.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut enclosing = vec![Vec::new(); wanted.len()];
    let mut tests = MAX_TESTS + MAX_TESTS_PER_FACE * triangles.len() as u64;
    for (triangle, &shell) in triangles.iter().zip(shell_of) {
        let corners = corners(triangle);
        let rows = corners.map(|corner| corner[1]);
        let (low, high) = (rows[0].min(rows[1]).min(rows[2]), rows[0].max(rows[1]).max(rows[2]));
        let first = rays.partition_point(|&(row, _)| row <= low);
        for &(row, ray) in rays[first..].iter().take_while(|&&(row, _)| row <= high) {
            tests = tests.checked_sub(1)?;
            let own = wanted[ray];
            let [column, _, depth] = largest[own as usize].1;
            let Some((from, to, step)) = cross_row(&corners, row).filter(|_| own != shell) else { continue };
            if from[0] < column && column <= to[0] && between(from, to, column) < depth {
                enclosing[ray].push((shell, step));
            }
        }
    }
    Some(enclosing)
}
