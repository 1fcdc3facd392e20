//! Clipping in homogeneous space, in wide integers: the near plane first, then the guard band.
//!
//! Corners have 12 more fractional bits than vertices: an intersection is rounded, and where it lies at the edge of the
//! guard band, 4,096 pixels away, its rounding affects an edge across the whole picture.
//!
//! **Why nothing overflows i128.** Coordinates are at most 2³² · 2¹² = 2⁴⁴. A distance from a plane of the guard band
//! is `a·W ± b·X` with a at most 2³¹ and b at most 2³²: below 2⁷⁷. An intersection multiplies it by a difference of
//! coordinates: 2⁷⁷ · 2⁴⁵ = 2¹²².

use super::view::{Homogeneous, ObjectView, vertex};
use crate::fixed::U8F8;
use crate::raster::Vertex;
use crate::raster::clip::{Clipped, clip as clip_triangle};

/// The number of extra bits of a corner compared with a vertex.
const EXTRA: u32 = 12;
/// The number of fractional bits of a parameter along an edge, and of a shade beyond its 8.8.
const PARAMETER: u32 = 32;

/// A corner of the polygon being clipped.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    x: i128,
    y: i128,
    w: i128,
    /// In 2⁻⁴⁰ shade.
    shade: i64,
    /// The projected vertex, for a corner of the mesh that needs no clipping. It is passed through unchanged, because
    /// neighbouring faces that need no clipping use it, too.
    vertex: Option<Vertex>,
}

impl Corner {
    pub(super) fn new(at: Homogeneous, shade: U8F8, vertex: Option<Vertex>) -> Self {
        let [x, y, w] = at.map(|c| i128::from(c) << EXTRA);
        Self { x, y, w, shade: i64::from(shade.to_bits()) << PARAMETER, vertex }
    }

    /// The vertex on the screen; `None` for one beyond the limit. Where rounding has moved a cut corner there, it is moved
    /// back: at near distances of a few 1/65,536 that may be some pixels.
    fn project(&self, view: &ObjectView) -> Option<Vertex> {
        if self.vertex.is_some() {
            return self.vertex;
        }
        let [fx, fy] = view.lens.focal.map(i128::from);
        let w = self.w;
        let near = i128::from(view.near) << EXTRA;
        // At most 2³⁰ · 2⁴⁴, as for a vertex: see `view`.
        let x = i128::from(view.lens.width) * 128 + (fx * self.x + 128 * w).div_euclid(256 * w);
        let y = i128::from(view.lens.height) * 128 + (fy * self.y + 128 * w).div_euclid(256 * w);
        // w is at least near, so at most 2³⁰.
        let depth = (((near << 31) + w) / (2 * w)) as u32;
        // Between two shades of at most 0xFF00, and rounded to the nearest.
        let shade = U8F8::from_bits(((self.shade + (1 << (PARAMETER - 1))) >> PARAMETER) as u16);
        let [x, y] = [x, y].map(|c| c.clamp(-ObjectView::FARTHEST, ObjectView::FARTHEST));
        vertex(x, y, shade, depth)
    }
}

/// The distance of a corner from a plane, 0 or more inside. For the guard band, it is four times the distance in
/// 1/65,536 pixel, times W.
fn distance(view: &ObjectView, plane: usize, corner: &Corner) -> i128 {
    let Corner { x, y, w, .. } = *corner;
    let limit = i128::from(ObjectView::LIMIT);
    let (width, height) = (2 * i128::from(view.lens.width), 2 * i128::from(view.lens.height));
    let [fx, fy] = view.lens.focal.map(|f| 2 * i128::from(f));
    let distance = match plane {
        0 => w - (i128::from(view.near) << EXTRA),
        1 => ((limit + width) << 16) * w + 2 * fx * x,
        2 => ((limit - width) << 16) * w - 2 * fx * x,
        3 => ((limit + height) << 16) * w + 2 * fy * y,
        _ => ((limit - height) << 16) * w - 2 * fy * y,
    };
    // A projected vertex counts as inside, even within the rounding margin beyond the limit.
    if corner.vertex.is_some() { distance.max(0) } else { distance }
}

/// `n / d` rounded to the nearest; d is above 0.
fn nearest(n: i128, d: i128) -> i128 {
    (2 * n + d).div_euclid(2 * d)
}

/// The intersection of an edge with a plane. If `on_face`, shades are linear on the face in space, otherwise on the
/// screen.
fn cut(
    view: &ObjectView,
    on_face: bool,
    plane: usize,
    [inside, outside]: [&Corner; 2],
    [d_inside, d_outside]: [i128; 2],
) -> Corner {
    // Above 0: one distance is at least 0, the other below 0.
    let whole = d_inside - d_outside;
    let between = |a: i128, b: i128| a + nearest((b - a) * d_inside, whole);
    let w = if plane == 0 { i128::from(view.near) << EXTRA } else { between(inside.w, outside.w) };
    // 0 to 1 with 32 fractional bits; intermediate values reach 2⁷⁶ · 2³³.
    let t = nearest(d_inside << PARAMETER, whole);
    // On the edge's projection the point is at t·wb / w. If the other end is beyond the near plane and has no
    // projection, shades that are linear on the screen are taken as linear along the edge as well.
    let part = if plane == 0 || on_face { t } else { nearest(t * outside.w, w).clamp(0, 1 << PARAMETER) };
    // Intermediate values reach 2⁴⁸ · 2³³; the shade is between the two.
    let change = (i128::from(outside.shade - inside.shade) * part) >> PARAMETER;
    Corner {
        x: between(inside.x, outside.x),
        y: between(inside.y, outside.y),
        w,
        shade: inside.shade + change as i64,
        vertex: None,
    }
}

/// Clips a triangle, whose shades are linear on the face in space if `on_face`, otherwise on the screen. Returns `None`
/// if nothing is left.
pub(super) fn clip(view: &ObjectView, on_face: bool, corners: [Corner; 3]) -> Option<Clipped> {
    let left = clip_triangle(
        corners,
        |plane, corner| distance(view, plane, corner),
        |plane, inside, outside, d_inside, d_outside| {
            cut(view, on_face, plane, [inside, outside], [d_inside, d_outside])
        },
    )?;
    left.project(|corner| corner.project(view))
}
