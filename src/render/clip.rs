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

/// Clips a triangle and hands the parts of what is left, a fan, to `part`. Returns whether anything
/// was left.
pub(super) fn clip(view: &ObjectView, corners: [Corner; 3], mut part: impl FnMut([Vertex; 3])) -> bool {
    let [a, b, c] = corners;
    let mut polygon = Polygon { corners: [a, b, c, a, a, a, a, a], count: 3 };
    for plane in 0..PLANES {
        let mut kept = Polygon { corners: polygon.corners, count: 0 };
        let Some(mut previous) = polygon.corners[..polygon.count].last() else { return false };
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
            return false;
        }
    }
    let mut vertices = polygon.corners[..polygon.count].iter().map(|corner| {
        // At most 0xFF00: between two shades that are. The cast truncates after the half.
        let shade = U8F8::from_bits((corner.shade + 0.5) as u16);
        corner.vertex.or_else(|| view.divide(corner.at, shade))
    });
    let (Some(Some(first)), Some(Some(mut previous))) = (vertices.next(), vertices.next()) else { return false };
    for vertex in vertices {
        let Some(vertex) = vertex else { return false };
        part([first, previous, vertex]);
        previous = vertex;
    }
    true
}
