//! Convex polygons: what clipping leaves of a triangle, and the triangles it is drawn in.
//!
//! Both vertex paths clip by [`clip`]. The planes come in one fixed order, and each new point is
//! computed from the end of its edge that is inside towards the end that is outside. So two
//! triangles that share an edge, which run through it in opposite directions, cut it in the same
//! point, to the bit: no crack.

use super::vertex::Vertex;

/// The planes that clipping cuts at: near, then left, right, top and bottom of the guard band.
pub const PLANES: usize = 5;

/// The most corners: a triangle's, and at most one more for every plane.
pub const MAX_CORNERS: usize = 3 + PLANES;

/// The corners of a convex polygon before their division, of whatever kind the vertex path has.
#[derive(Clone, Copy, Debug)]
pub struct Corners<C> {
    corners: [C; MAX_CORNERS],
    count: usize,
}

impl<C: Copy> Corners<C> {
    /// The corners, in order.
    #[must_use]
    pub fn as_slice(&self) -> &[C] {
        // Never more than there are places.
        &self.corners[..self.count]
    }

    fn push(&mut self, corner: C) {
        if let Some(place) = self.corners.get_mut(self.count) {
            *place = corner;
            self.count += 1;
        }
    }

    /// Every corner as a vertex; `None` if one has none.
    #[must_use]
    pub fn project(&self, mut vertex: impl FnMut(&C) -> Option<Vertex>) -> Option<Clipped> {
        let mut polygon = Clipped { vertices: [Vertex::default(); MAX_CORNERS], count: self.count };
        for (place, corner) in polygon.vertices.iter_mut().zip(self.as_slice()) {
            *place = vertex(corner)?;
        }
        Some(polygon)
    }
}

/// Clips a triangle by planes (Sutherland, Hodgman 1974); `None` if nothing is left.
///
/// `distance` is a corner's distance from a plane, 0 ([`Default`]) or more inside. `cut` is the point where
/// an edge meets a plane; it is given the plane, the inside and the outside end, and their distances.
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

/// A convex polygon, except for the rounding of its corners.
#[derive(Clone, Copy, Debug)]
pub struct Clipped {
    vertices: [Vertex; MAX_CORNERS],
    count: usize,
}

impl Clipped {
    /// The triangles of the fan from this corner: which corners each has.
    fn fan(&self, apex: usize) -> impl Iterator<Item = [usize; 3]> {
        let corner = move |i: usize| (apex + i) % self.count;
        (2..self.count).map(move |i| [corner(0), corner(i - 1), corner(i)])
    }

    /// The corners.
    #[cfg(feature = "alloc")]
    pub(crate) fn vertices(&self) -> &[Vertex] {
        // Never more than there are places.
        &self.vertices[..self.count]
    }

    /// The triangle of these corners.
    #[must_use]
    pub fn triangle(&self, corners: [usize; 3]) -> [Vertex; 3] {
        // Below the number of corners, which is no greater than that of places.
        corners.map(|i| self.vertices[i % MAX_CORNERS])
    }

    /// Twice the area, as [`doubled_area`] has it of a triangle.
    #[must_use]
    pub fn doubled_area(&self) -> i64 {
        self.fan(0).map(|part| doubled_area(&self.triangle(part))).sum()
    }

    /// The polygon in triangles that turn the same way as the whole.
    ///
    /// Where a cut lies near a corner, three corners in a row may be all but on a line, and rounding
    /// may dent the polygon there. A fan from any other corner would then cover the dent twice; a
    /// fan from the dent does not. Triangles that still turn the other way, of polygons that are
    /// hardly more than a line, are left out.
    pub fn parts(&self) -> impl Iterator<Item = [Vertex; 3]> {
        self.part_corners().map(|corners| self.triangle(corners))
    }

    /// The triangles of [`parts`](Self::parts), by the indices of their corners.
    pub fn part_corners(&self) -> impl Iterator<Item = [usize; 3]> {
        let sign = self.doubled_area().signum();
        let turns = move |part: &[usize; 3]| doubled_area(&self.triangle(*part)).signum() * sign;
        let whole = |apex: &usize| self.fan(*apex).all(|part| turns(&part) >= 0);
        let apex = (0..self.count).find(whole).unwrap_or(0);
        self.fan(apex).filter(move |part| turns(part) > 0)
    }
}

/// Twice the area on the screen in (1/256 pixel)²: exact, and negative where the face is turned
/// towards the eye, for it is counter-clockwise seen from outside and the screen's y runs down.
#[must_use]
#[inline]
pub fn doubled_area(vertices: &[Vertex; 3]) -> i64 {
    let [(x0, y0), (x1, y1), (x2, y2)] =
        vertices.each_ref().map(|v| (i64::from(v.x().to_bits()), i64::from(v.y().to_bits())));
    (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
}
