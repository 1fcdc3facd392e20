//! Clipping of a triangle to the near plane and the guard band, and the triangles that it is then drawn as.
//!
//! Planes come in a fixed order, and each new point is computed from the end of its edge that is inside. So two
//! triangles that share an edge cut it in the same point, to the bit, and leave no crack.

use crate::corner::{Door, Kept, Wide};

/// The near plane, then left, right, top and bottom of the guard band.
const PLANES: usize = 5;

/// A triangle's corners, and at most one more for each plane.
const MOST: usize = 3 + PLANES;

/// How values are interpolated over the triangle.
#[derive(Clone, Copy)]
pub(crate) struct Progress {
    /// Shades are linear on the face, and not on the screen.
    pub(crate) shades_on_face: bool,
    /// Texture coordinates are linear on the face.
    pub(crate) texture_on_face: bool,
}

fn distance<D: Door, K: Kept>(plane: usize, corner: &Wide<D::Wide, K>, near: Option<D::Wide>) -> D::Wide {
    let zero = D::Wide::default();
    let distance = match (plane, near) {
        (0, None) => zero,
        (0, Some(near)) => corner.w - near,
        (1 | 2, _) => D::distance(corner.w, corner.x, plane == 1),
        _ => D::distance(corner.w, corner.y, plane == 3),
    };
    // A corner that was projected is inside, whatever rounding says here.
    if corner.ready.is_some() && distance < zero { zero } else { distance }
}

fn cut<D: Door, K: Kept>(
    plane: usize,
    near: Option<D::Wide>,
    progress: Progress,
    [a, b]: [&Wide<D::Wide, K>; 2],
    [inside, outside]: [D::Wide; 2],
) -> Wide<D::Wide, K> {
    let zero = D::Wide::default();
    let between = |a, b| D::between(a, b, inside, outside, None);
    let w = match (plane, near) {
        (0, Some(near)) => near,
        (_, None) => D::one(),
        _ => between(a.w, b.w),
    };
    // The coordinate that the plane fixes is not interpolated.
    let x = if matches!(plane, 1 | 2) { D::at_limit(w, plane == 2) } else { between(a.x, b.x) };
    let y = if matches!(plane, 3 | 4) { D::at_limit(w, plane == 4) } else { between(a.y, b.y) };
    // If the other end is beyond the near plane, it has no projection, and values linear on the screen are linear along
    // the edge.
    let on_screen = (plane != 0 && near.is_some()).then_some([b.w, w]);
    // Vertices on the screen have their depth in place of 1/w.
    let depth = between(a.depth, b.depth);
    let on_face = (near.is_none() && depth > zero).then_some([b.depth, depth]);
    let values = a.values.zip(b.values, |a, b, is_texture| {
        let is_on_face = if is_texture { progress.texture_on_face } else { progress.shades_on_face };
        D::between(a, b, inside, outside, if is_on_face { on_face } else { on_screen })
    });
    Wide { x, y, w, depth, values, ready: None }
}

/// Clips a triangle, and passes on the triangles of the part that remains. A mesh with w has a near plane.
#[inline(never)]
pub(crate) fn clip<D: Door, K: Kept>(
    corners: [Wide<D::Wide, K>; 3],
    near: Option<D::Wide>,
    progress: Progress,
    triangle: &mut dyn FnMut([K; 3]),
) {
    let zero = D::Wide::default();
    let [a, b, c] = corners;
    let (mut polygon, mut count) = ([a, b, c, a, a, a, a, a], 3_usize);
    for plane in 0..PLANES {
        let (mut kept, mut kept_count) = (polygon, 0);
        let mut keep = |corner| {
            if let Some(to) = kept.get_mut(kept_count) {
                *to = corner;
                kept_count += 1;
            }
        };
        let Some(mut previous) = count.checked_sub(1).and_then(|last: usize| polygon.get(last)) else { return };
        let mut d_previous = distance::<D, K>(plane, previous, near);
        for corner in polygon.iter().take(count) {
            let d = distance::<D, K>(plane, corner, near);
            if d_previous >= zero && d < zero {
                keep(cut::<D, K>(plane, near, progress, [previous, corner], [d_previous, d]));
            } else if d_previous < zero && d >= zero {
                keep(cut::<D, K>(plane, near, progress, [corner, previous], [d, d_previous]));
            }
            if d >= zero {
                keep(*corner);
            }
            (previous, d_previous) = (corner, d);
        }
        (polygon, count) = (kept, kept_count);
        if count < 3 {
            return;
        }
    }
    let mut ready = [K::default(); MOST];
    for (to, corner) in ready.iter_mut().zip(&polygon).take(count) {
        match corner.ready.or_else(|| corner.in_band::<D>().project::<D>(near)) {
            Some(corner) => *to = corner,
            None => return,
        }
    }
    fan(&ready, count, triangle);
}

/// Twice the area on the screen, positive if clockwise as seen (y points down).
#[inline]
pub(crate) fn doubled_area<K: Kept>([a, b, c]: &[K; 3]) -> i64 {
    let at = |corner: &K| (i64::from(corner.vertex().x().to_bits()), i64::from(corner.vertex().y().to_bits()));
    let ((ax, ay), (bx, by), (cx, cy)) = (at(a), at(b), at(c));
    (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
}

/// The triangles of a convex polygon, wound like the whole. Rounding may dent it where a cut is near a corner. A fan
/// that starts at the dent covers nothing twice, so this looks for one.
fn fan<K: Kept>(corners: &[K; MOST], count: usize, triangle: &mut dyn FnMut([K; 3])) {
    let part = |apex: usize, i: usize| [apex, apex + i - 1, apex + i].map(|i| corners[i % count % MOST]);
    let sign = (2..count).map(|i| doubled_area(&part(0, i))).sum::<i64>().signum();
    let is_whole = |apex: &usize| (2..count).all(|i| doubled_area(&part(*apex, i)).signum() * sign >= 0);
    // The same one whichever corner comes first.
    let place = |apex: &usize| corners.get(*apex).map(|corner| (corner.vertex().x(), corner.vertex().y()));
    let apex = (0..count).filter(is_whole).min_by_key(place).unwrap_or(0);
    for i in 2..count {
        let part = part(apex, i);
        if doubled_area(&part).signum() * sign > 0 {
            triangle(part);
        }
    }
}
