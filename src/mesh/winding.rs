//! Winding numbers of a closed surface, counted along rays.
//!
//! The **winding number** of a point counts how often the surface encloses it: 0 outside, 1 inside
//! a solid, 2 where two solids overlap, −1 inside a solid whose faces point inward. Along a ray it
//! rises by one at a face that points back along the ray, and falls by one at a face that points
//! forward. If it is nowhere below 0, an eye outside (at 0) sees no face from behind: the first
//! face on each ray must raise it.
//!
//! Rays run along the three axes, 64 × 64 along each, so narrower parts can be missed. A ray passes each edge on a side
//! that both faces of the edge agree on: the point where an edge crosses a row of rays is computed from the edge's two
//! ends in a fixed order, so the number along a ray always returns to 0.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use glam::Vec3;

use super::Bounds;
use super::wide::{Wide, widen};

/// The number of rays along each side of the box.
const RAYS: u32 = 64;

/// The minimum length along a ray at which a negative region makes a mesh partly inverted, as a fraction of the longest
/// side of the box. Scans have folds, a few faces thin. Culling the far side of a fold leaves no hole: another face
/// lies a fold's width behind it.
const THINNEST: f64 = 1.0 / 32.0;

/// The intersection of a ray with a face.
#[derive(Clone, Copy, Debug)]
struct Meeting {
    ray: u32,
    at: f64,
    /// The change of the winding number.
    step: i32,
}

/// The max number of intersections for each face, on top of [`MAX_MEETINGS`]. A mesh with more counts as partly
/// inverted. A finely divided surface has one or two per face; to have more it must cross the whole box again and
/// again.
const MEETINGS_PER_FACE: u64 = 64;
/// The number of intersections of a surface that crosses the box 64 times along each ray.
const MAX_MEETINGS: u64 = 64 * RAYS as u64 * RAYS as u64;

/// The number of intersections held in memory at a time: this many per face, plus [`HELD`].
const HELD_PER_FACE: u64 = 2;
const HELD: u64 = 256;

/// Returns whether no point has a negative winding number, folds aside: then no back face of a
/// closed mesh is visible from outside. Memory is proportional to the number of faces, and the
/// result is `false` if the answer would take too long.
pub(super) fn is_outward(positions: &[Vec3], triangles: &[[u32; 3]], bounds: &Bounds) -> bool {
    let (min, max) = (widen(bounds.min), widen(bounds.max));
    let sides = [0, 1, 2].map(|axis| max[axis] - min[axis]);
    let longest = sides.into_iter().fold(0.0, f64::max);
    // In units of the ray spacing: rays lie at the integers 1 to 64. The box's offset from them is not a simple
    // fraction, so that no ray lies in a plane of a symmetrical model.
    let scale = sides.map(|side| if side > 0.0 { f64::from(RAYS) / side } else { 0.0 });
    let part = [0.618_034, 0.414_214, 0.732_051];
    let scaled = |p: Vec3| {
        let p = widen(p);
        [0, 1, 2].map(|axis| (p[axis] - min[axis]) * scale[axis] + part[axis])
    };
    // Calls `visit` with each triangle that rays along an axis may hit, the ray direction as the last coordinate.
    let each = |axis: usize, visit: &mut dyn FnMut([Wide; 3])| {
        let (right, up) = ((axis + 1) % 3, (axis + 2) % 3);
        for triangle in triangles {
            let corners = triangle.map(|vertex| scaled(positions[vertex as usize]));
            // Above 0 and below 65: the casts round down.
            let spans = |axis: usize| corners.iter().any(|corner| corner[axis] as u32 != corners[0][axis] as u32);
            if spans(right) && spans(up) {
                visit(corners.map(|corner| [corner[right], corner[up], corner[axis]]));
            }
        }
    };
    let most = MAX_MEETINGS + MEETINGS_PER_FACE * triangles.len() as u64;
    let held = HELD + HELD_PER_FACE * triangles.len() as u64;
    let mut meetings = Vec::new();
    (0..3).all(|axis| {
        let count = |rays: &Range<u32>| {
            let mut count = 0_u64;
            each(axis, &mut |corners| meet_all(corners, rays, |_| count += 1));
            count
        };
        let all = 0..(RAYS + 2) * (RAYS + 2);
        let met = count(&all);
        if met > most {
            return false;
        }
        // Ranges of rays with too many intersections for the memory are halved. A face meets a ray at most once, so a
        // single ray always fits.
        let mut left = vec![(all, met)];
        while let Some((rays, met)) = left.pop() {
            if rays.len() > 1 && met > held {
                let middle = rays.start.midpoint(rays.end);
                let first = rays.start..middle;
                let met_first = count(&first);
                left.extend([(middle..rays.end, met - met_first), (first, met_first)]);
                continue;
            }
            meetings.clear();
            each(axis, &mut |corners| meet_all(corners, &rays, |meeting| meetings.push(meeting)));
            if !never_below(&mut meetings, longest * scale[axis] * THINNEST) {
                return false;
            }
        }
        true
    })
}

/// Returns whether no ray's winding number is below 0 over a length of more than `thinnest`.
fn never_below(meetings: &mut [Meeting], thinnest: f64) -> bool {
    meetings.sort_unstable_by(|a, b| a.ray.cmp(&b.ray).then(a.at.total_cmp(&b.at)));
    meetings.chunk_by(|a, b| a.ray == b.ray).all(|ray| {
        let (mut winding, mut below_from) = (0, None);
        ray.iter().all(|meeting| {
            winding += meeting.step;
            match (winding < 0, below_from) {
                (true, None) => below_from = Some(meeting.at),
                (false, Some(from)) => {
                    below_from = None;
                    return meeting.at - from <= thinnest;
                }
                _ => {}
            }
            true
        })
    })
}

/// Calls `visit` for each of `rays` that hits a triangle. Rays run along the third coordinate, where the other two are
/// integers.
fn meet_all(corners: [Wide; 3], rays: &Range<u32>, mut visit: impl FnMut(Meeting)) {
    let rows = corners.map(|corner| corner[1]);
    let low = (rows[0].min(rows[1]).min(rows[2]) as u32 + 1).max(rays.start / (RAYS + 2));
    let high = (rows[0].max(rows[1]).max(rows[2]) as u32).min(rays.end.saturating_sub(1) / (RAYS + 2));
    for row in low..=high {
        let Some((from, to, step)) = cross_row(&corners, f64::from(row)) else { continue };
        let first = row * (RAYS + 2);
        let columns =
            (from[0] as u32 + 1).max(rays.start.saturating_sub(first))..(to[0] as u32 + 1).min(rays.end - first);
        for column in columns {
            visit(Meeting { ray: first + column, at: between(from, to, f64::from(column)), step });
        }
    }
}

/// Intersects a triangle with the plane of a row of rays. Returns where the intersection begins and ends, each as the
/// position in the row and along the rays, and the change of the winding number from one side of the triangle to the
/// other. `None` if there is no intersection. Corners on the plane count as above it.
pub(super) fn cross_row(corners: &[Wide; 3], row: f64) -> Option<([f64; 2], [f64; 2], i32)> {
    let (mut rising, mut falling) = (None, None);
    for i in 0..3 {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        match (a[1] < row, b[1] < row) {
            (true, false) => rising = Some(on_edge(a, b, row)),
            (false, true) => falling = Some(on_edge(b, a, row)),
            _ => {}
        }
    }
    let (rising, falling) = (rising?, falling?);
    // A triangle that is counter-clockwise here faces along the rays: its right side rises.
    if falling[0] < rising[0] { Some((falling, rising, -1)) } else { Some((rising, falling, 1)) }
}

/// The point where an edge, given from its lower end, crosses a row. Rounding never moves it beyond the ends.
fn on_edge(low: Wide, high: Wide, row: f64) -> [f64; 2] {
    let part = (row - low[1]) / (high[1] - low[1]);
    let column = low[0] + part * (high[0] - low[0]);
    [column.clamp(low[0].min(high[0]), low[0].max(high[0])), low[2] + part * (high[2] - low[2])]
}

/// The distance along a ray at which it intersects the segment between two points of its row.
pub(super) fn between(from: [f64; 2], to: [f64; 2], column: f64) -> f64 {
    let wide = to[0] - from[0];
    if wide > 0.0 { from[1] + (column - from[0]) / wide * (to[1] - from[1]) } else { from[1] }
}
