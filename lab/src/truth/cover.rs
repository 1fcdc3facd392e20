//! Coverage of a face whose corners are rounded to 1/256 pixel, computed exactly in integers.

use super::body::Corner;
use super::clip::{Kept, clip, fan};
use super::eye::Eye;

/// A corner's x and y in 1/256 pixel. Clipping keeps both within ±2²⁰, so twice an area is below 2⁴³.
type Point = [i64; 2];

/// floor(256·x + ½), exactly; adding the half first would round the sum itself.
fn round(pixels: f64) -> i64 {
    let scaled = pixels * 256.0;
    let below = libm::floor(scaled);
    // A whole number; the cast drops nothing.
    below as i64 + i64::from(scaled - below >= 0.5)
}

/// Twice the area of a → b → c; positive if it is clockwise on the screen, whose y points down.
fn area(a: Point, b: Point, c: Point) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// One of the triangles that a face is drawn in.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// Its corners in 1/256 pixel.
    pub(super) points: [Point; 3],
    pub(super) corners: [Kept; 3],
}

/// A face as it is drawn.
#[derive(Clone, Debug)]
pub(super) struct Rounded {
    pub(super) parts: Vec<Part>,
    /// True if its back is toward the eye.
    pub(super) turned: bool,
}

impl Rounded {
    /// A triangle of the mesh, clipped and rounded.
    pub(super) fn new(eye: &Eye, triangle: &[Corner; 3]) -> Self {
        let polygon = clip(eye, triangle);
        let points: Vec<Point> = polygon.iter().map(|corner| eye.project(corner.seen).map(round)).collect();
        // Exact: below 2⁵³.
        let (parts, whole) = fan(points.len(), |[a, b, c]| area(points[a], points[b], points[c]) as f64);
        let part = |places: [usize; 3]| Part { points: places.map(|i| points[i]), corners: places.map(|i| polygon[i]) };
        Self { parts: parts.into_iter().map(part).collect(), turned: whole > 0.0 }
    }
}

impl Part {
    /// The weights of its corners at the centre of a pixel, which add up to 1; `None` if the pixel is not covered, that
    /// is, if the centre is neither inside nor on a top or left edge.
    pub(super) fn weights(&self, x: i64, y: i64) -> Option<[f64; 3]> {
        let [a, b, c] = self.points;
        let centre = [256 * x + 128, 256 * y + 128];
        let whole = area(a, b, c);
        let opposite = |from: Point, to: Point| {
            let side = area(from, to, centre) * whole.signum();
            let [along_x, along_y] = [(to[0] - from[0]) * whole.signum(), (to[1] - from[1]) * whole.signum()];
            // Clockwise, so a left edge runs up and a top edge to the right.
            let owns = along_y < 0 || (along_y == 0 && along_x > 0);
            // Below 2⁵³, so exact.
            (side > 0 || (side == 0 && owns)).then(|| side as f64 / whole.abs() as f64)
        };
        Some([opposite(b, c)?, opposite(c, a)?, opposite(a, b)?])
    }
}
