//! Coverage: the pixels of a triangle, as rows from top to bottom.

use super::edge::Edge;
use crate::raster::fill_rule::first_centre;
use crate::raster::frame::Rect;
use crate::raster::vertex::Vertex;

/// A triangle with sorted vertices: top, middle, bottom, at equal heights the left one first. The pixels depend only on
/// the three points, not on the order they were given in.
#[derive(Clone, Copy, Debug, Default)]
pub struct SortedTriangle {
    /// The vertices, sorted by (y, x).
    pub vertices: [Vertex; 3],
    /// Twice the area in (1/256 pixel)²; positive if the middle vertex lies right of the edge from
    /// top to bottom. Within ±2⁴².
    pub doubled_area: i64,
}

impl SortedTriangle {
    /// Sorts three vertices.
    #[must_use]
    #[inline]
    pub fn new(vertices: &[Vertex; 3]) -> Self {
        Self::with_order(vertices).0
    }

    /// Sorts three vertices, and returns the original index of each. Without branches, which would be unpredictable.
    #[inline]
    pub(in crate::raster) fn with_order(vertices: &[Vertex; 3]) -> (Self, [usize; 3]) {
        let key = |v: &Vertex| (i64::from(v.y().to_bits()) << 32) + i64::from(v.x().to_bits());
        let [a, b, c] = [key(&vertices[0]), key(&vertices[1]), key(&vertices[2])];
        let (b_before_a, c_before_b) = (b < a, c < b);
        let first = usize::from(b_before_a | (c < a)) * (1 + usize::from(c_before_b));
        let last = if (c < a) | c_before_b { usize::from(!b_before_a) } else { 2 };
        let order = [first, 3 - first - last, last];
        let vertices = [vertices[order[0]], vertices[order[1]], vertices[order[2]]];
        let [(x0, y0), (x1, y1), (x2, y2)] = [point(&vertices[0]), point(&vertices[1]), point(&vertices[2])];
        let doubled_area = i64::from(x1 - x0) * i64::from(y2 - y0) - i64::from(x2 - x0) * i64::from(y1 - y0);
        (Self { vertices, doubled_area }, order)
    }

    /// The shades of the vertices, in 1/256.
    #[must_use]
    #[inline]
    pub fn shades(&self) -> [i64; 3] {
        let shade = |corner: usize| i64::from(self.vertices[corner].shade().to_bits());
        [shade(0), shade(1), shade(2)]
    }

    /// The doubled area, positive.
    #[must_use]
    #[inline]
    pub fn area(&self) -> i64 {
        self.doubled_area.abs()
    }

    /// Gradient of a value that is linear over the triangle, with `values` at its vertices: its change per 1/256 pixel,
    /// as numerators (in x, in y) over [`area`](Self::area).
    ///
    /// ```text
    /// gx = (v1 − v0)·(y2 − y0) − (v2 − v0)·(y1 − y0)
    /// gy = (v2 − v0)·(x1 − x0) − (v1 − v0)·(x2 − x0)       both negated if the area is negative
    /// ```
    ///
    /// Each is within 2ⁿ⁺²² if the values lie within 2ⁿ of each other; n is at most 32.
    #[must_use]
    #[inline]
    pub fn gradient(&self, values: [i64; 3]) -> (i64, i64) {
        let [a, b, c] = &self.vertices;
        let wide = |v: &Vertex| (i64::from(v.x().to_bits()), i64::from(v.y().to_bits()));
        let ((x0, y0), (x1, y1), (x2, y2)) = (wide(a), wide(b), wide(c));
        let (v1, v2) = (values[1] - values[0], values[2] - values[0]);
        let gx = v1 * (y2 - y0) - v2 * (y1 - y0);
        let gy = v2 * (x1 - x0) - v1 * (x2 - x0);
        if self.doubled_area < 0 { (-gx, -gy) } else { (gx, gy) }
    }

    /// The rows inside `clip` whose centres lie between the top and the bottom; `None` if there are none, if no
    /// column's centre inside `clip` lies between left and right, or if there is no area.
    #[must_use]
    #[inline]
    pub fn extent(&self, clip: Rect) -> Option<core::ops::Range<i32>> {
        let [top, _, bottom] = &self.vertices;
        // The clip rectangle lies inside a frame of at most 4,096 pixels a side.
        let first = first_centre(top.y()).max(clip.y0 as i32);
        let end = first_centre(bottom.y()).min(clip.y1 as i32);
        if self.doubled_area == 0 || first >= end {
            return None;
        }
        let (left, right) = self
            .vertices
            .iter()
            .fold((i32::MAX, i32::MIN), |(low, high), v| (low.min(first_centre(v.x())), high.max(first_centre(v.x()))));
        (left.max(clip.x0 as i32) < right.min(clip.x1 as i32)).then_some(first..end)
    }

    /// Calls `row` for every row with a covered pixel inside `clip`, from the top down. `frame_width` is the whole
    /// frame's; `clip` lies inside the frame.
    #[inline]
    pub fn rows(&self, frame_width: u32, clip: Rect, mut row: impl FnMut(Row)) {
        let Some(rows) = self.extent(clip) else { return };
        let mut walk = RowWalk::new(self, rows);
        loop {
            let covered = walk.row(frame_width, clip);
            if covered.x0 < covered.x1 {
                row(covered);
            }
            if !walk.down(self) {
                return;
            }
        }
    }
}

/// Walks a triangle's rows: the two edges that cross the current row.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::raster) struct RowWalk {
    /// The edge from the top to the bottom.
    long: Edge,
    /// The edge from the top to the middle, then from there to the bottom.
    short: Edge,
    is_long_left: bool,
    y: i32,
    /// The first row of the lower short edge.
    split: i32,
    /// The row after the last.
    end: i32,
}

impl RowWalk {
    /// Begins at the first of `rows`, which lie in the triangle's [extent](SortedTriangle::extent).
    #[inline]
    pub(in crate::raster) fn new(triangle: &SortedTriangle, rows: core::ops::Range<i32>) -> Self {
        let [top, middle, bottom] = triangle.vertices.each_ref().map(point);
        let (y, split) = (rows.start, first_centre(triangle.vertices[1].y()));
        let (from, to) = if y < split { (top, middle) } else { (middle, bottom) };
        let (long, short) = (Edge::at_row(top, bottom, y), Edge::at_row(from, to, y));
        Self { long, short, is_long_left: triangle.doubled_area > 0, y, split, end: rows.end }
    }

    /// The current row. It may be empty: `x0` is then not below `x1`.
    #[inline]
    pub(in crate::raster) fn row(&self, frame_width: u32, clip: Rect) -> Row {
        let (left, right) = if self.is_long_left { (self.long.x, self.short.x) } else { (self.short.x, self.long.x) };
        // A frame has at most 4,096 columns.
        let (origin, width) = (left.max(0), frame_width as i32);
        let (x0, x1) = (origin.max(clip.x0 as i32), right.min(width).min(clip.x1 as i32));
        Row { y: self.y, origin, x0, x1, last: right.min(width) - 1 }
    }

    /// Steps to the next row. Returns whether there is one.
    #[inline]
    pub(in crate::raster) fn down(&mut self, triangle: &SortedTriangle) -> bool {
        self.y += 1;
        if self.y >= self.end {
            return false;
        }
        self.long.down();
        if self.y == self.split {
            let [_, middle, bottom] = triangle.vertices.each_ref().map(point);
            self.short = Edge::at_row(middle, bottom, self.y);
        } else {
            self.short.down();
        }
        true
    }
}

/// The covered pixels of one row.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Row {
    /// The row.
    pub y: i32,
    /// The row's first covered pixel inside the *frame*, whatever the clip rectangle: where shades
    /// start, so that a pixel's byte does not depend on the clip rectangle.
    pub origin: i32,
    /// The first covered pixel inside the clip rectangle.
    pub x0: i32,
    /// The pixel after the last.
    pub x1: i32,
    /// The row's last covered pixel inside the *frame*, whatever the clip rectangle.
    pub last: i32,
}

impl Row {
    /// The covered pixels, as columns.
    #[must_use]
    #[inline]
    pub fn range(&self) -> core::ops::Range<usize> {
        // Columns of a frame: 0 to 4,096.
        self.x0 as usize..self.x1 as usize
    }
}

#[inline]
pub(in crate::raster) fn point(v: &Vertex) -> (i32, i32) {
    (v.x().to_bits(), v.y().to_bits())
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::*;
    use crate::fixed::{I24F8, U8F8};

    /// Corners are sorted by (y, x), and the reported order is right, for all triples of nine points that reach both
    /// ends of the guard band, equal ones included.
    #[test]
    fn corners_are_in_order_and_known() {
        const ENDS: [i32; 3] = [-Vertex::GUARD_BAND, 0, Vertex::GUARD_BAND];
        // The shade distinguishes equal points.
        let vertex = |index: usize, shade: u16| {
            let [x, y] = [ENDS[index % 3], ENDS[index / 3]].map(I24F8::from_bits);
            Vertex::new(x, y, U8F8::from_bits(shade), 0).expect("in the guard band")
        };
        for triple in 0..9 * 9 * 9 {
            let given = [vertex(triple % 9, 1), vertex(triple / 9 % 9, 2), vertex(triple / 81, 3)];
            let mut sorted = given;
            sorted.sort_by_key(|v| (v.y(), v.x()));
            let (triangle, order) = SortedTriangle::with_order(&given);
            assert_eq!(triangle.vertices, sorted, "{given:?}");
            assert_eq!(order.map(|corner| given[corner]), sorted, "{given:?}");
        }
    }
}
