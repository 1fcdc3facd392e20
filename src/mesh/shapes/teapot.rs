//! The Utah teapot: Martin Newell's 32 Bézier patches of 1975, in Jim Blinn's proportions.
//!
//! The control points are the well-known ones (GLUT and many other programs have them), with z up and the spout towards
//! +x. Six of the patches are quarters of surfaces of revolution, given here as profiles; the halves of handle and
//! spout are given in full. 6 · 4 + 4 · 2 = 32.

use alloc::vec::Vec;

use glam::Vec3;

use super::{MAX_PARTS, grid, toward_zero};
use crate::mesh::wide::{Wide, add, cross, length, narrow, scale, sub};
use crate::mesh::{Mesh, topology};

/// Four control points of a profile, each (radius, tangent, height): the control points of the quarter turn are
/// (radius, 0), (radius, −tangent), (tangent, −radius), (0, −radius). Profiles run from the axis at the top outward,
/// down and back to the axis, so that all patches have the same orientation.
const REVOLVED: [[[f64; 3]; 4]; 6] = [
    // Rim.
    [[1.4, 0.784, 2.4], [1.3375, 0.749, 2.53125], [1.4375, 0.805, 2.53125], [1.5, 0.84, 2.4]],
    // Body.
    [[1.5, 0.84, 2.4], [1.75, 0.98, 1.875], [2.0, 1.12, 1.35], [2.0, 1.12, 0.9]],
    [[2.0, 1.12, 0.9], [2.0, 1.12, 0.45], [1.5, 0.84, 0.225], [1.5, 0.84, 0.15]],
    // Lid.
    [[0.0, 0.0, 3.15], [0.8, 0.45, 3.15], [0.0, 0.0, 2.85], [0.2, 0.112, 2.7]],
    [[0.2, 0.112, 2.7], [0.4, 0.224, 2.55], [1.3, 0.728, 2.55], [1.3, 0.728, 2.4]],
    // Bottom, not in Newell's data; Frank Crow added it.
    [[1.5, 0.84, 0.15], [1.5, 0.84, 0.075], [1.425, 0.798, 0.0], [0.0, 0.0, 0.0]],
];

/// The half y ≤ 0 of handle and spout: 4 × 4 control points, from the pot outward.
const HALVES: [[[Wide; 4]; 4]; 4] = [
    // Handle.
    [
        [[-1.6, 0.0, 2.025], [-1.6, -0.3, 2.025], [-1.5, -0.3, 2.25], [-1.5, 0.0, 2.25]],
        [[-2.3, 0.0, 2.025], [-2.3, -0.3, 2.025], [-2.5, -0.3, 2.25], [-2.5, 0.0, 2.25]],
        [[-2.7, 0.0, 2.025], [-2.7, -0.3, 2.025], [-3.0, -0.3, 2.25], [-3.0, 0.0, 2.25]],
        [[-2.7, 0.0, 1.8], [-2.7, -0.3, 1.8], [-3.0, -0.3, 1.8], [-3.0, 0.0, 1.8]],
    ],
    [
        [[-2.7, 0.0, 1.8], [-2.7, -0.3, 1.8], [-3.0, -0.3, 1.8], [-3.0, 0.0, 1.8]],
        [[-2.7, 0.0, 1.575], [-2.7, -0.3, 1.575], [-3.0, -0.3, 1.35], [-3.0, 0.0, 1.35]],
        [[-2.5, 0.0, 1.125], [-2.5, -0.3, 1.125], [-2.65, -0.3, 0.9375], [-2.65, 0.0, 0.9375]],
        [[-2.0, 0.0, 0.9], [-2.0, -0.3, 0.9], [-1.9, -0.3, 0.6], [-1.9, 0.0, 0.6]],
    ],
    // Spout.
    [
        [[1.7, 0.0, 1.425], [1.7, -0.66, 1.425], [1.7, -0.66, 0.6], [1.7, 0.0, 0.6]],
        [[2.6, 0.0, 1.425], [2.6, -0.66, 1.425], [3.1, -0.66, 0.825], [3.1, 0.0, 0.825]],
        [[2.3, 0.0, 2.1], [2.3, -0.25, 2.1], [2.4, -0.25, 2.025], [2.4, 0.0, 2.025]],
        [[2.7, 0.0, 2.4], [2.7, -0.25, 2.4], [3.3, -0.25, 2.4], [3.3, 0.0, 2.4]],
    ],
    [
        [[2.7, 0.0, 2.4], [2.7, -0.25, 2.4], [3.3, -0.25, 2.4], [3.3, 0.0, 2.4]],
        [[2.8, 0.0, 2.475], [2.8, -0.25, 2.475], [3.525, -0.25, 2.49375], [3.525, 0.0, 2.49375]],
        [[2.9, 0.0, 2.475], [2.9, -0.15, 2.475], [3.45, -0.15, 2.5125], [3.45, 0.0, 2.5125]],
        [[2.8, 0.0, 2.4], [2.8, -0.15, 2.4], [3.2, -0.15, 2.4], [3.2, 0.0, 2.4]],
    ],
];

/// The centre of the surface's box: x from −3 to the spout's tip at 3.434, z from 0 to 3.15.
const CENTRE: Wide = [0.217, 0.0, 1.575];
/// The distance from that centre to the farthest point of the surface, rounded up.
const RADIUS: f64 = 3.3405;

/// Control points: rows along v, columns along u; ∂u × ∂v points outward.
type Patch = [[Wide; 4]; 4];

/// The Utah teapot, bottom included, with each of its 32 patches cut into `segments` × `segments` quads (at least 2, at
/// most 512). It has 64 · segments² − 8 · segments triangles: those with two corners at a pole are left out.
///
/// It is not closed: the spout is open, and there is a gap around the lid.
#[must_use]
pub fn teapot(segments: u32) -> Mesh {
    let n = segments.clamp(2, MAX_PARTS / 8);
    let mut builder = Builder { n, positions: Vec::new(), normals: Vec::new(), triangles: Vec::new() };
    for profile in REVOLVED {
        let mut patch = profile.map(|[r, t, z]| [[r, 0.0, z], [r, -t, z], [t, -r, z], [0.0, -r, z]]);
        for _ in 0..4 {
            builder.add(&patch);
            // A quarter turn about the z axis, exactly, so that neighbours share their edges.
            patch = patch.map(|row| row.map(|[x, y, z]| [y, -x, z]));
        }
    }
    for half in HALVES {
        builder.add(&half);
        // Mirrored, and u reversed to keep the orientation.
        builder.add(&half.map(|[a, b, c, d]| [d, c, b, a].map(|[x, y, z]| [x, -y, z])));
    }
    builder.finish()
}

/// Bernstein's cubic polynomials and their derivatives at t.
fn bernstein(t: f64) -> ([f64; 4], [f64; 4]) {
    let s = 1.0 - t;
    (
        [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t],
        [-3.0 * s * s, 3.0 * s * s - 6.0 * s * t, 6.0 * s * t - 3.0 * t * t, 3.0 * t * t],
    )
}

/// Σ weights · points, in this order.
fn blend(weights: [f64; 4], points: [Wide; 4]) -> Wide {
    let [a, b, c, d] = [0, 1, 2, 3].map(|i| scale(points[i], weights[i]));
    add(add(a, b), add(c, d))
}

/// The point at (u, v) and the unit normal there.
fn evaluate(patch: &Patch, u: f64, v: f64) -> (Wide, Wide) {
    let (bu, du) = bernstein(u);
    let (bv, dv) = bernstein(v);
    let rows = patch.map(|row| blend(bu, row));
    let point = blend(bv, rows);
    let along_v = blend(dv, rows);
    let slopes = patch.map(|row| blend(du, row));
    // At a pole the row of control points is a single point, so ∂u vanishes. Near it, ∂u is ∂²/∂u∂v times the distance
    // from the pole, so ∂²/∂u∂v gives the direction of ∂u.
    let is_pole = |row: usize| patch[row].iter().all(|p| *p == patch[row][0]);
    let direction = if v == 0.0 && is_pole(0) {
        blend(dv, slopes)
    } else if v == 1.0 && is_pole(3) {
        scale(blend(dv, slopes), -1.0)
    } else {
        blend(bv, slopes)
    };
    let normal = cross(direction, along_v);
    (point, scale(normal, 1.0 / length(normal)))
}

struct Builder {
    n: u32,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Builder {
    fn add(&mut self, patch: &Patch) {
        let n = self.n;
        let first = self.positions.len() as u32;
        for j in 0..=n {
            for i in 0..=n {
                let (point, normal) = evaluate(patch, f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
                let [x, y, z] = scale(sub(point, CENTRE), 1.0 / RADIUS);
                // From z up to y up.
                self.positions.push(Vec3::from_array([x, z, -y].map(toward_zero)));
                self.normals.push(narrow([normal[0], normal[2], -normal[1]]));
            }
        }
        self.triangles.extend(grid(n, n, first));
    }

    /// Merges the vertices of neighbouring patches where the surface is smooth, and drops triangles with two corners at
    /// one point.
    fn finish(self) -> Mesh {
        let points = topology::weld(&self.positions);
        // The normals of neighbouring patches differ by rounding; at the edges of rim and lid they
        // differ by much more.
        let same = |a: Vec3, b: Vec3| a.dot(b) > 0.9999;
        let mut at_point: Vec<Vec<u32>> = alloc::vec![Vec::new(); points.len()];
        let mut positions: Vec<Vec3> = Vec::new();
        let mut normals: Vec<Vec3> = Vec::new();
        let mut renamed = Vec::with_capacity(points.len());
        for (vertex, &point) in points.iter().enumerate() {
            let known = &mut at_point[point as usize];
            let found = known.iter().copied().find(|&v| same(normals[v as usize], self.normals[vertex]));
            renamed.push(found.unwrap_or_else(|| {
                let new = positions.len() as u32;
                positions.push(self.positions[vertex]);
                normals.push(self.normals[vertex]);
                known.push(new);
                new
            }));
        }
        let triangles =
            self.triangles.into_iter().filter(|t| !topology::is_line(t.map(|vertex| points[vertex as usize])));
        Mesh::assemble(positions, normals, triangles.map(|t| t.map(|v| renamed[v as usize])).collect())
    }
}
