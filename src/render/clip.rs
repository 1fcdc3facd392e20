//! Clipping in homogeneous space: the near plane first, then the guard band, in f64.
//!
//! Only what the raster cannot take is cut off: what lies nearer than the near plane, and what is
//! projected more than 4,095 pixels away. The screen's edges need no clipping, the raster leaves
//! out what lies beyond them exactly.
//!
//! The planes come in one fixed order, and each new point is computed from the end of its edge
//! that is inside towards the end that is outside. So two triangles that share an edge, which run
//! through it in opposite directions, cut it in the same point, to the bit: no crack.

use super::view::{Homogeneous, ObjectView};
use crate::fixed::U8F8;
use crate::raster::Vertex;

/// A corner of the polygon that is being clipped.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) at: Homogeneous,
    /// In 1/256 shade, 0 to 0xFF00.
    pub(super) shade: f64,
    /// The projected vertex, of a corner of the mesh that needs no clipping. It is kept as it is,
    /// because a neighbour that needs none either draws with it.
    pub(super) vertex: Option<Vertex>,
}

/// The planes: near, then left, right, top and bottom of the guard band.
const PLANES: usize = 5;

/// A convex polygon: a triangle and at most one corner more for every plane.
struct Polygon {
    corners: [Corner; 3 + PLANES],
    count: usize,
}

impl Polygon {
    fn push(&mut self, corner: Corner) {
        if let Some(place) = self.corners.get_mut(self.count) {
            *place = corner;
            self.count += 1;
        }
    }
}

/// The distance of a corner from a plane, 0 or more inside.
fn distance(view: &ObjectView, plane: usize, corner: &Corner) -> f64 {
    let Homogeneous { x, y, w } = corner.at;
    let (cx, cy) = view.centre();
    let limit = ObjectView::LIMIT;
    let distance = match plane {
        0 => w - f64::from(view.near()),
        1 => x + (limit + cx) * w,
        2 => (limit - cx) * w - x,
        3 => y + (limit + cy) * w,
        _ => (limit - cy) * w - y,
    };
    // A vertex that was projected counts as inside whatever the rounding here says.
    if corner.vertex.is_some() { distance.max(0.0) } else { distance }
}

/// The point where an edge meets a plane.
fn cut(view: &ObjectView, plane: usize, inside: &Corner, outside: &Corner, d_inside: f64, d_outside: f64) -> Corner {
    let t = d_inside / (d_inside - d_outside);
    let between = |a: f64, b: f64| a + (b - a) * t;
    let (a, b) = (inside.at, outside.at);
    let w = if plane == 0 { f64::from(view.near()) } else { between(a.w, b.w) };
    // Shades are linear on the screen. On the edge's projection the point lies at t·wb / w. Where
    // the other end has no projection, beyond the near plane, they are linear along the edge.
    let on_screen = if plane == 0 { t } else { t * b.w / w };
    let shade = inside.shade + (outside.shade - inside.shade) * on_screen;
    // Rounding in `shade` must not leave the range of the two ends.
    let (low, high) = (inside.shade.min(outside.shade), inside.shade.max(outside.shade));
    Corner {
        at: Homogeneous { x: between(a.x, b.x), y: between(a.y, b.y), w },
        shade: shade.max(low).min(high),
        vertex: None,
    }
}

/// What is left of a triangle: a convex polygon, but for the rounding of its corners.
pub(super) struct Clipped {
    vertices: [Vertex; 3 + PLANES],
    count: usize,
}

impl Clipped {
    /// The triangles of the fan from this corner.
    fn fan(&self, apex: usize) -> impl Iterator<Item = [Vertex; 3]> {
        let corner = move |i: usize| self.vertices[(apex + i) % self.count];
        (2..self.count).map(move |i| [corner(0), corner(i - 1), corner(i)])
    }

    /// Twice the area, as [`doubled_area`] has it of a triangle.
    pub(super) fn doubled_area(&self) -> i64 {
        self.fan(0).map(|part| doubled_area(&part)).sum()
    }

    /// The polygon in triangles that turn the same way as the whole.
    ///
    /// Where a cut lies near a corner, three corners in a row may be all but on a line, and rounding
    /// may dent the polygon there. A fan from any other corner would then cover the dent twice; a
    /// fan from the dent does not. Triangles that still turn the other way, of polygons that are
    /// hardly more than a line, are left out.
    pub(super) fn parts(&self) -> impl Iterator<Item = [Vertex; 3]> {
        let sign = self.doubled_area().signum();
        let turns = move |part: &[Vertex; 3]| doubled_area(part).signum() * sign;
        let whole = |apex: &usize| self.fan(*apex).all(|part| turns(&part) >= 0);
        let apex = (0..self.count).find(whole).unwrap_or(0);
        self.fan(apex).filter(move |part| turns(part) > 0)
    }
}

/// Twice the area on the screen in (1/256 pixel)²: exact, and negative where the face is turned
/// towards the eye, for it is counter-clockwise seen from outside and the screen's y runs down.
#[inline]
pub(super) fn doubled_area(vertices: &[Vertex; 3]) -> i64 {
    let [(x0, y0), (x1, y1), (x2, y2)] =
        vertices.each_ref().map(|v| (i64::from(v.x().to_bits()), i64::from(v.y().to_bits())));
    (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
}

/// Clips a triangle. Returns `None` if nothing is left.
pub(super) fn clip(view: &ObjectView, corners: [Corner; 3]) -> Option<Clipped> {
    let [a, b, c] = corners;
    let mut polygon = Polygon { corners: [a, b, c, a, a, a, a, a], count: 3 };
    for plane in 0..PLANES {
        let mut kept = Polygon { corners: polygon.corners, count: 0 };
        let mut previous = polygon.corners[..polygon.count].last()?;
        let mut d_previous = distance(view, plane, previous);
        for corner in &polygon.corners[..polygon.count] {
            let d = distance(view, plane, corner);
            if d_previous >= 0.0 && d < 0.0 {
                kept.push(cut(view, plane, previous, corner, d_previous, d));
            } else if d_previous < 0.0 && d >= 0.0 {
                kept.push(cut(view, plane, corner, previous, d, d_previous));
            }
            if d >= 0.0 {
                kept.push(*corner);
            }
            (previous, d_previous) = (corner, d);
        }
        polygon = kept;
        if polygon.count < 3 {
            return None;
        }
    }
    let mut clipped = Clipped { vertices: [Vertex::default(); 3 + PLANES], count: polygon.count };
    for (vertex, corner) in clipped.vertices.iter_mut().zip(&polygon.corners[..polygon.count]) {
        // At most 0xFF00: between two shades that are. The cast truncates after the half.
        let shade = U8F8::from_bits((corner.shade + 0.5) as u16);
        *vertex = corner.vertex.or_else(|| view.divide(corner.at, shade))?;
    }
    Some(clipped)
}
