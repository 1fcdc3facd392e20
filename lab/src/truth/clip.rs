//! Clipping: what remains of a face that extends beyond the near plane or the guard band.
//!
//! The planes come in a fixed order: near, then 4,095.75 pixels from the frame's upper left corner to the left, to the
//! right, up and down. The remaining polygon is drawn as the fan of triangles from its first corner or, if rounding has
//! dented it, from the first corner whose fan has no triangle that turns the other way.

use super::body::Corner;
use super::eye::Eye;
use super::vector::{Vector, between};

/// Distance from the frame's upper left corner up to which faces are drawn, in pixels, along x and along y.
pub(super) const LIMIT: f64 = 4095.75;

/// A corner of what remains of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kept {
    /// Position before the perspective division: see [`Eye::see`].
    pub(super) seen: Vector,
    /// Weights of the face's three vertices here, for values that are linear on the face in space.
    pub(super) on_face: [f64; 3],
    /// Weights of the face's three vertices here, for values that are linear on the screen. On the near plane, where
    /// the edge's other end has no position on the screen, they are linear along the edge in space.
    pub(super) on_screen: [f64; 3],
}

/// The remaining corners, in order around the face; empty if nothing remains.
pub(super) fn clip(eye: &Eye, triangle: &[Corner; 3]) -> Vec<Kept> {
    let one = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut polygon: Vec<Kept> = triangle
        .iter()
        .zip(one)
        .map(|(corner, one)| Kept { seen: corner.seen, on_face: one, on_screen: one })
        .collect();
    if polygon.iter().all(|corner| (0..5).all(|plane| inside(eye, plane, corner.seen) >= 0.0)) {
        return polygon;
    }
    for plane in 0..5 {
        let mut left = Vec::new();
        for i in 0..polygon.len() {
            let (from, to) = (polygon[(i + polygon.len() - 1) % polygon.len()], polygon[i]);
            match (inside(eye, plane, from.seen), inside(eye, plane, to.seen)) {
                (a, b) if a >= 0.0 && b < 0.0 => left.push(cut(plane, &from, &to, a / (a - b))),
                (a, b) if a < 0.0 && b >= 0.0 => left.push(cut(plane, &to, &from, b / (b - a))),
                _ => {}
            }
            if inside(eye, plane, to.seen) >= 0.0 {
                left.push(to);
            }
        }
        polygon = left;
    }
    polygon
}

/// The remaining corners on the screen, in pixels.
pub(super) fn outline(eye: &Eye, triangle: &[Corner; 3]) -> Vec<[f64; 2]> {
    clip(eye, triangle).iter().map(|corner| eye.project(corner.seen)).collect()
}

/// The least and the greatest coordinate of some points along an axis; infinite if there are none.
pub(super) fn bounds(points: &[[f64; 2]], axis: usize) -> (f64, f64) {
    let along = || points.iter().map(|point| point[axis]);
    (along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max))
}

/// Distance of a point inside a plane, in arbitrary units; negative outside.
fn inside(eye: &Eye, plane: usize, [x, y, w]: Vector) -> f64 {
    let [cx, cy] = eye.centre;
    match plane {
        0 => w - eye.near,
        1 => x + (LIMIT + cx) * w,
        2 => (LIMIT - cx) * w - x,
        3 => y + (LIMIT + cy) * w,
        _ => (LIMIT - cy) * w - y,
    }
}

/// The point `part` of the way from a corner inside to one outside.
fn cut(plane: usize, inside: &Kept, outside: &Kept, part: f64) -> Kept {
    let seen = between(inside.seen, outside.seen, part);
    let on_screen = if plane == 0 { part } else { part * outside.seen[2] / seen[2] };
    Kept {
        seen,
        on_face: between(inside.on_face, outside.on_face, part),
        on_screen: between(inside.on_screen, outside.on_screen, on_screen),
    }
}

/// Splits a polygon into triangles with its winding. Returns the indices of their corners, and twice the polygon's
/// area. `area` returns twice the signed area of a triangle of three corners.
pub(super) fn fan(corners: usize, area: impl Fn([usize; 3]) -> f64) -> (Vec<[usize; 3]>, f64) {
    let from = |apex: usize| {
        let place = move |i: usize| (apex + i) % corners;
        (2..corners).map(move |i| [place(0), place(i - 1), place(i)])
    };
    let whole: f64 = from(0).map(&area).sum();
    let turns_back = |part| area(part) * whole < 0.0;
    let apex = (0..corners).find(|&apex| !from(apex).any(turns_back)).unwrap_or(0);
    (from(apex).filter(|&part| area(part) * whole > 0.0).collect(), whole)
}
