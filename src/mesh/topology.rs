//! What holds of a mesh as a surface: which vertices are the same point, whether it is closed,
//! whether it is convex. The plan decides by these which work can be left out, so all of them are
//! exact, and "no" where it is not certain.

use alloc::vec;
use alloc::vec::Vec;
use core::cmp::Ordering;

use glam::Vec3;

use super::orientation::side;
use super::wide::{add, cross, dot, length, scale, sub, widen};

/// For each vertex the number of its point; vertices at the same position have the same. 0 and −0
/// are the same position. Points are numbered from 0 in no particular order.
pub(super) fn weld(positions: &[Vec3]) -> Vec<u32> {
    let key = |p: &Vec3| [(p.x + 0.0).to_bits(), (p.y + 0.0).to_bits(), (p.z + 0.0).to_bits()];
    // `Mesh` holds fewer than 2³¹ vertices.
    let mut order: Vec<([u32; 3], u32)> = positions.iter().zip(0..).map(|(p, i)| (key(p), i)).collect();
    order.sort_unstable();
    let mut points = vec![0; positions.len()];
    let mut point = 0;
    for (i, &(key, vertex)) in order.iter().enumerate() {
        if i > 0 && order[i - 1].0 != key {
            point += 1;
        }
        points[vertex as usize] = point;
    }
    points
}

/// A triangle with two corners in one point is a line: it draws nothing, and its two edges undo each
/// other. It is no part of the surface.
fn is_line(triangle: [u32; 3]) -> bool {
    triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]
}

/// Both ways of one edge have the same key but for the lowest bit.
fn edge_key(from: u32, to: u32) -> u64 {
    // Points are numbered below 2³¹, so the key has 31 + 32 + 1 bits.
    let (low, high, backward) = if from < to { (from, to, 0) } else { (to, from, 1) };
    u64::from(low) << 33 | u64::from(high) << 1 | backward
}

/// The edges of a triangle, each with the corner that is not on it.
fn edges(t: [u32; 3]) -> [(u32, u32, u32); 3] {
    [(t[0], t[1], t[2]), (t[1], t[2], t[0]), (t[2], t[0], t[1])]
}

fn welded(triangle: [u32; 3], points: &[u32]) -> [u32; 3] {
    triangle.map(|vertex| points[vertex as usize])
}

/// Is every edge, from point to point, run through exactly once in each direction?
pub(super) fn is_closed(triangles: &[[u32; 3]], points: &[u32]) -> bool {
    let mut keys = Vec::with_capacity(triangles.len() * 3);
    for &triangle in triangles {
        let corners = welded(triangle, points);
        if !is_line(corners) {
            keys.extend(edges(corners).map(|(from, to, _)| edge_key(from, to)));
        }
    }
    keys.sort_unstable();
    // Sorted, a closed mesh reads: edge forward, edge backward, next edge forward … An edge with four
    // faces reads forward, forward, backward, backward.
    !keys.is_empty()
        && keys.len() % 2 == 0
        && keys.chunks_exact(2).all(|pair| pair[0] & 1 == 0 && pair[1] == pair[0] + 1)
}

/// Is a closed mesh convex, wound so that its faces look outward?
///
/// Three things are asked for, which together suffice. (1) The mean of the vertices lies behind every
/// face. (2) Seen from there the faces cover the sphere once: their solid angles add up to 4π. So the
/// surface is one piece, is seen whole from that point, and nowhere passes through itself. (3) Over
/// every edge the next face's far corner lies behind the face or in its plane. With (2) this makes the
/// surface convex about every vertex as well, and a closed, connected surface that is convex about
/// each of its points is convex (Tietze, Nakajima). (3) alone would not do: a double pyramid over a
/// pentagram has only convex edges.
///
/// (1) is tested in f64 with a margin, (3) exactly: a quad whose corners were rounded to f32 so that
/// its diagonal lies 10⁻⁸ too deep makes the mesh not convex. A face of no area makes it not convex
/// either.
pub(super) fn is_convex(positions: &[Vec3], triangles: &[[u32; 3]], points: &[u32]) -> bool {
    let mut sum = [0.0; 3];
    let mut corners = 0.0;
    for &triangle in triangles {
        for vertex in triangle {
            sum = add(sum, widen(positions[vertex as usize]));
            corners += 1.0;
        }
    }
    let inside = scale(sum, 1.0 / corners);

    let mut solid_angle = 0.0;
    for &triangle in triangles {
        if is_line(welded(triangle, points)) {
            continue;
        }
        let [a, b, c] = triangle.map(|vertex| sub(widen(positions[vertex as usize]), inside));
        let volume = dot(a, cross(b, c));
        let (la, lb, lc) = (length(a), length(b), length(c));
        // Rounding makes less than 2⁻⁴⁹ of the three lengths' product.
        if volume <= la * lb * lc * (1.0 / 281_474_976_710_656.0) {
            return false;
        }
        // A. van Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle", 1983.
        let below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        solid_angle += 2.0 * libm::atan2(volume, below);
    }
    // A whole number of spheres, so half a sphere is margin enough.
    if solid_angle > 6.0 * core::f64::consts::PI {
        return false;
    }

    let mut keys: Vec<(u64, u32, u32)> = Vec::with_capacity(triangles.len() * 3);
    for (&triangle, index) in triangles.iter().zip(0..) {
        if !is_line(welded(triangle, points)) {
            keys.extend(
                edges(triangle)
                    .map(|(from, to, far)| (edge_key(points[from as usize], points[to as usize]), index, far)),
            );
        }
    }
    keys.sort_unstable_by_key(|&(key, _, _)| key);
    keys.chunks_exact(2).all(|pair| {
        let [a, b, c] = triangles[pair[0].1 as usize].map(|vertex| positions[vertex as usize]);
        side(a, b, c, positions[pair[1].2 as usize]) != Ordering::Greater
    })
}
