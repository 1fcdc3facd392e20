//! Clips triangles to convex polygons, and splits these into triangles to draw.
//!
//! Both vertex paths clip with [`clip`]. The planes come in a fixed order, and each new point is computed from the
//! inside end of its edge toward the outside end. Two triangles that share an edge traverse it in opposite directions,
//! yet cut it at the same point, to the bit, so no crack opens.

use super::vertex::Vertex;

/// The number of clip planes: near, then left, right, top and bottom of the guard band.
pub const PLANES: usize = 5;

/// The maximum number of corners: three, and at most one more for every plane.
pub const MAX_CORNERS: usize = 3 + PLANES;

/// The corners of a convex polygon: before the perspective division, in either vertex path's coordinate type, or
/// projected.
#[derive(Clone, Copy, Debug)]
pub struct Corners<C> {
    corners: [C; MAX_CORNERS],
    count: usize,
}

impl<C: Copy> Corners<C> {
    /// The corners, in order.
    #[must_use]
    pub fn as_slice(&self) -> &[C] {
        // At most `MAX_CORNERS`.
        &self.corners[..self.count]
    }

    fn push(&mut self, corner: C) {
        if let Some(place) = self.corners.get_mut(self.count) {
            *place = corner;
            self.count += 1;
        }
    }

    /// Projects every corner to a vertex; `None` if any corner has no projection.
    #[must_use]
    pub fn project(&self, mut vertex: impl FnMut(&C) -> Option<Vertex>) -> Option<Clipped> {
        let mut polygon = Corners { corners: [Vertex::default(); MAX_CORNERS], count: self.count };
        for (place, corner) in polygon.corners.iter_mut().zip(self.as_slice()) {
            *place = vertex(corner)?;
        }
        Some(polygon)
    }
}

/// Clips a triangle against the planes (Sutherland, Hodgman 1974); `None` if nothing is left.
///
/// `distance` is a corner's distance from a plane, 0 ([`Default`]) or more inside. `cut` returns the point where an
/// edge meets a plane; it receives the plane, the inside and the outside end, and their distances.
#[must_use]
pub fn clip<C: Copy, D: Copy + PartialOrd + Default>(
    [a, b, c]: [C; 3],
    mut distance: impl FnMut(usize, &C) -> D,
    mut cut: impl FnMut(usize, &C, &C, D, D) -> C,
) -> Option<Corners<C>> {
    let zero = D::default();
    let mut polygon = Corners { corners: [a, b, c, a, a, a, a, a], count: 3 };
    for plane in 0..PLANES {
        let mut kept = Corners { corners: polygon.corners, count: 0 };
        let mut previous = polygon.as_slice().last()?;
        let mut d_previous = distance(plane, previous);
        for corner in polygon.as_slice() {
            let d = distance(plane, corner);
            if d_previous >= zero && d < zero {
                kept.push(cut(plane, previous, corner, d_previous, d));
            } else if d_previous < zero && d >= zero {
                kept.push(cut(plane, corner, previous, d, d_previous));
            }
            if d >= zero {
                kept.push(*corner);
            }
            (previous, d_previous) = (corner, d);
        }
        polygon = kept;
        if polygon.count < 3 {
            return None;
        }
    }
    Some(polygon)
}

/// A clipped polygon, convex except for the rounding of its corners.
pub type Clipped = Corners<Vertex>;

impl Clipped {
    /// The triangles of the fan around this corner, as indices of their corners.
    fn fan(&self, apex: usize) -> impl Iterator<Item = [usize; 3]> {
        let corner = move |i: usize| (apex + i) % self.count;
        (2..self.count).map(move |i| [corner(0), corner(i - 1), corner(i)])
    }

    /// The triangle with these corners.
    #[must_use]
    pub fn triangle(&self, corners: [usize; 3]) -> [Vertex; 3] {
        // Below `count`, which is at most `MAX_CORNERS`.
        corners.map(|i| self.corners[i % MAX_CORNERS])
    }

    /// Twice the area, in the units and with the sign of [`doubled_area`].
    #[must_use]
    pub fn doubled_area(&self) -> i64 {
        self.fan(0).map(|part| doubled_area(&self.triangle(part))).sum()
    }

    /// The polygon as triangles that turn the same way as the whole.
    ///
    /// Where a cut lies near a corner, three successive corners may be nearly collinear, and rounding may dent the
    /// polygon there. A fan from any other corner would then cover the dent twice; a fan from the
    /// dent does not. In polygons that are little more than a line, triangles that still turn the
    /// other way are left out.
    pub fn parts(&self) -> impl Iterator<Item = [Vertex; 3]> {
        self.part_corners().map(|corners| self.triangle(corners))
    }

    /// The triangles of [`parts`](Self::parts), as corner indices.
    pub fn part_corners(&self) -> impl Iterator<Item = [usize; 3]> {
        let sign = self.doubled_area().signum();
        let turns = move |part: &[usize; 3]| doubled_area(&self.triangle(*part)).signum() * sign;
        let whole = |apex: &usize| self.fan(*apex).all(|part| turns(&part) >= 0);
        let apex = (0..self.count).find(whole).unwrap_or(0);
        self.fan(apex).filter(move |part| turns(part) > 0)
    }
}

/// Twice the area on the screen in (1/256 pixel)²: exact, and negative for a face turned toward the eye, since it is
/// counter-clockwise seen from outside and the screen's y points down.
#[must_use]
#[inline]
pub fn doubled_area(vertices: &[Vertex; 3]) -> i64 {
    let [(x0, y0), (x1, y1), (x2, y2)] =
        vertices.each_ref().map(|v| (i64::from(v.x().to_bits()), i64::from(v.y().to_bits())));
    (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
}
