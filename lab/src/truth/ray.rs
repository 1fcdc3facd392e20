//! Rays from the eye through a point of the picture, and the faces that they hit: coverage without any rounding to
//! pixels or fractions of them.
//!
//! With a, b, c the corners before their division and p = (x, y, 1) on the screen, the corners' weights on the face are
//! the volumes of the three tetrahedra that p forms with two of them each. No clipping is needed: a corner behind the
//! eye simply has a negative w.

use super::body::Corner;
use super::clip::{clip, fan};
use super::eye::Eye;
use super::vector::{Vector, cross, dot, weighted};
use super::{Face, Hit};

/// Finds the point where the ray through (`x`, `y`), in pixels from the frame's upper left corner, hits a face with
/// these corners; the weights are those on the face in space. `None` if it misses, or hits nearer than the near plane.
///
/// Two faces that share an edge compute the same value for it, with opposite signs. Where it is 0, the ray belongs to
/// the face whose left or top edge it is, so always to exactly one.
pub(super) fn meet(eye: &Eye, face: Face, triangle: &[Corner; 3], [x, y]: [f64; 2]) -> Option<Hit> {
    let [a, b, c] = triangle.each_ref().map(|corner| corner.seen);
    let p = [x - eye.centre[0], y - eye.centre[1], 1.0];
    let whole = volume(triangle);
    let opposite = |from: Vector, to: Vector| {
        let edge = cross(from, to).map(|c| if whole < 0.0 { -c } else { c });
        let side = dot(edge, p);
        // The value grows to the right of a left edge, and downward from a top edge.
        let owns = edge[0] > 0.0 || (edge[0] == 0.0 && edge[1] > 0.0);
        (side > 0.0 || (side == 0.0 && owns)).then_some(side)
    };
    let sides = [opposite(b, c)?, opposite(c, a)?, opposite(a, b)?];
    let sum = sides[0] + sides[1] + sides[2];
    let w = whole.abs() / sum;
    // A triangle without area, or full of NaN, is never hit.
    if !(w >= eye.near && w.is_finite()) {
        return None;
    }
    Some(Hit { face, turned: whole > 0.0, weights: sides.map(|side| side / sum), inverse_w: 1.0 / w })
}

/// Six times the volume of the corners and the eye; positive if the eye sees the triangle's back.
fn volume([a, b, c]: &[Corner; 3]) -> f64 {
    dot(a.seen, cross(b.seen, c.seen))
}

/// Returns whether the eye sees the triangle's back, wherever a ray hits it.
pub(super) fn is_turned(triangle: &[Corner; 3]) -> bool {
    volume(triangle) > 0.0
}

/// Weights of the three corners at a point of the picture for values that are linear on the screen; for a clipped face,
/// interpolated over the triangles that remain. Unrounded.
pub(super) fn on_screen(eye: &Eye, triangle: &[Corner; 3], at: [f64; 2]) -> [f64; 3] {
    let polygon = clip(eye, triangle);
    let points: Vec<[f64; 2]> = polygon.iter().map(|corner| eye.project(corner.seen)).collect();
    let area = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let (parts, _) = fan(points.len(), |[a, b, c]| area(points[a], points[b], points[c]));
    // The part that contains the point, or, if rounding puts it just outside all of them, the nearest.
    let (mut found, mut inmost) = ([1.0 / 3.0; 3], f64::NEG_INFINITY);
    for places in parts {
        let [a, b, c] = places.map(|i| points[i]);
        let weights = [area(b, c, at), area(c, a, at), area(a, b, at)].map(|part| part / area(a, b, c));
        let least = weights.iter().copied().fold(f64::INFINITY, f64::min);
        if least > inmost {
            (found, inmost) = (weighted(places.map(|i| polygon[i].on_screen), weights), least);
        }
    }
    found
}
