//! How often a closed surface winds round the points of space, along rays.
//!
//! The **winding number** of a point counts how often the surface encloses it: 0 outside, 1 inside a body, 2 where two
//! bodies overlap, −1 inside a body whose faces look inward. Along a ray it grows by one at a face that looks back along
//! the ray, and falls by one at a face that looks forward. Where no number is below 0, an eye outside (at 0) sees no face
//! from behind: the first face of each ray must raise the number.
//!
//! Rays run along the three axes, 64 × 64 along each. What is narrower is not found. A ray passes each edge on one side
//! that both faces of the edge agree on: the place where an edge crosses a row of rays is computed from its two ends in
//! one order, so the numbers along a ray always come back to 0.

use alloc::vec::Vec;

use glam::Vec3;

use super::Bounds;
use super::wide::{Wide, widen};

/// Rays along each side of the box.
const RAYS: u32 = 64;

/// How far a negative region reaches along a ray at least, in parts of the longest side of the box, that makes a mesh
/// turned in part. Scans have folds, a few faces thin, and of these an eye outside does not miss the side that is turned
/// away: another face lies a fold's width behind it.
const THINNEST: f64 = 1.0 / 32.0;

/// A ray's meeting with a face.
#[derive(Clone, Copy, Debug)]
struct Meeting {
    ray: u32,
    at: f64,
    /// What the winding number grows by.
    step: i32,
}

/// Whether no point has a negative winding number, folds aside: then no back face of a closed mesh is seen from
/// outside.
pub(super) fn is_outward(positions: &[Vec3], triangles: &[[u32; 3]], bounds: &Bounds) -> bool {
    let (min, max) = (widen(bounds.min), widen(bounds.max));
    let sides = [0, 1, 2].map(|axis| max[axis] - min[axis]);
    let longest = sides.into_iter().fold(0.0, f64::max);
    // In units of the rays' distance. Rays lie at the whole numbers 1 to 64; the part by which the box begins beside them
    // is no simple fraction, so that no ray lies on the planes of a symmetrical model.
    let scale = sides.map(|side| if side > 0.0 { f64::from(RAYS) / side } else { 0.0 });
    let part = [0.618_034, 0.414_214, 0.732_051];
    let scaled = |p: Vec3| {
        let p = widen(p);
        [0, 1, 2].map(|axis| (p[axis] - min[axis]) * scale[axis] + part[axis])
    };
    let mut meetings: [Vec<Meeting>; 3] = Default::default();
    for triangle in triangles {
        let corners = triangle.map(|vertex| scaled(positions[vertex as usize]));
        // Above 0 and below 65: the casts round down.
        let cells = corners.map(|corner| corner.map(|c| c as u32));
        let spans = [0, 1, 2].map(|axis| cells[0][axis] != cells[1][axis] || cells[0][axis] != cells[2][axis]);
        for (axis, meetings) in meetings.iter_mut().enumerate() {
            let (right, up) = ((axis + 1) % 3, (axis + 2) % 3);
            if spans[right] && spans[up] {
                meet_all(corners.map(|corner| [corner[right], corner[up], corner[axis]]), meetings);
            }
        }
    }
    meetings.iter_mut().zip(scale).all(|(meetings, scale)| never_below(meetings, longest * scale * THINNEST))
}

/// Whether no ray's winding number is below 0 for longer than `thinnest`.
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

/// Where the rays of a grid meet a triangle: rays run along the third coordinate, and lie where the other two are whole
/// numbers.
fn meet_all(corners: [Wide; 3], meetings: &mut Vec<Meeting>) {
    let rows = corners.map(|corner| corner[1]);
    let low = rows[0].min(rows[1]).min(rows[2]) as u32 + 1;
    let high = rows[0].max(rows[1]).max(rows[2]) as u32;
    for row in low..=high {
        let Some((from, to, step)) = cross_row(&corners, f64::from(row)) else { continue };
        for column in from[0] as u32 + 1..=to[0] as u32 {
            let at = between(from, to, f64::from(column));
            meetings.push(Meeting { ray: row * (RAYS + 2) + column, at, step });
        }
    }
}

/// Where a triangle crosses the plane of a row of rays: place in the row and along the rays where that begins and where
/// it ends, and what the winding number grows by from one side to the other. `None` if it does not cross it. Corners on
/// the plane count as above it.
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
    // A triangle that is counter-clockwise here looks along the rays: its right side rises.
    if falling[0] < rising[0] { Some((falling, rising, -1)) } else { Some((rising, falling, 1)) }
}

/// Where an edge, from its lower end, crosses a row. No rounding takes it beyond the ends.
fn on_edge(low: Wide, high: Wide, row: f64) -> [f64; 2] {
    let part = (row - low[1]) / (high[1] - low[1]);
    let column = low[0] + part * (high[0] - low[0]);
    [column.clamp(low[0].min(high[0]), low[0].max(high[0])), low[2] + part * (high[2] - low[2])]
}

/// How far along a ray lies what is met between two places of its row.
pub(super) fn between(from: [f64; 2], to: [f64; 2], column: f64) -> f64 {
    let wide = to[0] - from[0];
    if wide > 0.0 { from[1] + (column - from[0]) / wide * (to[1] - from[1]) } else { from[1] }
}
