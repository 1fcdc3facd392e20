//! Clipping in homogeneous space: the near plane first, then the guard band, in f64.
//!
//! Only what the raster cannot take is cut off: what lies nearer than the near plane, and what is
//! projected more than 4,095 pixels away. The screen's edges need no clipping, the raster leaves
//! out what lies beyond them exactly. [`raster::clip`](crate::raster::clip) goes through the
//! planes in an order that leaves no crack.

use crate::view::{Homogeneous, ObjectView};
use crate::fixed::U8F8;
use crate::raster::Vertex;
use crate::raster::clip::{Clipped, clip as clip_triangle};

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
///
/// It is the mean of the two ends, each weighted with the other's distance: of numbers of one sign,
/// as w is, no digit is lost however far apart they are. The coordinate that the plane fixes is not
/// interpolated at all. With ends at opposite sides, 10³⁸ away, that would leave nothing of it, and
/// the next plane would throw the point away, and the face with it.
fn cut(view: &ObjectView, plane: usize, inside: &Corner, outside: &Corner, d_inside: f64, d_outside: f64) -> Corner {
    let whole = d_inside - d_outside;
    let between = |a: f64, b: f64| (b * d_inside - a * d_outside) / whole;
    let (a, b) = (inside.at, outside.at);
    let (low, high) = (a.w.min(b.w), a.w.max(b.w));
    let w = if plane == 0 { f64::from(view.near()) } else { between(a.w, b.w).max(low).min(high) };
    let (cx, cy) = view.centre();
    let limit = ObjectView::LIMIT;
    let x = match plane {
        1 => -(limit + cx) * w,
        2 => (limit - cx) * w,
        _ => between(a.x, b.x),
    };
    let y = match plane {
        3 => -(limit + cy) * w,
        4 => (limit - cy) * w,
        _ => between(a.y, b.y),
    };
    // Shades are linear on the screen. On the edge's projection the point lies at t·wb / w. Where
    // the other end has no projection, beyond the near plane, they are linear along the edge.
    let t = d_inside / whole;
    let on_screen = if plane == 0 { t } else { t * b.w / w };
    let shade = inside.shade + (outside.shade - inside.shade) * on_screen;
    // Rounding in `shade` must not leave the range of the two ends.
    let (low, high) = (inside.shade.min(outside.shade), inside.shade.max(outside.shade));
    Corner { at: Homogeneous { x, y, w }, shade: shade.max(low).min(high), vertex: None }
}

/// Clips a triangle. Returns `None` if nothing is left.
pub(super) fn clip(view: &ObjectView, corners: [Corner; 3]) -> Option<Clipped> {
    let left = clip_triangle(
        corners,
        |plane, corner| distance(view, plane, corner),
        |plane, inside, outside, d_inside, d_outside| cut(view, plane, inside, outside, d_inside, d_outside),
    )?;
    left.project(|corner| {
        // At most 0xFF00: between two shades that are. The cast truncates after the half.
        let shade = U8F8::from_bits((corner.shade + 0.5) as u16);
        corner.vertex.or_else(|| view.divide(corner.at, shade))
    })
}
