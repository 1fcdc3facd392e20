//! Culling: the triangles of a batch that may cover a pixel, and what they are to the stages behind.

use super::class::ClassedIndex;
use super::setup::first_centre;
use super::triangles::{Batch, LANES, MAX_AREA_4X4, MAX_COLUMNS, MAX_HEIGHT, MAX_ROWS, MAX_WIDTH};
use crate::raster::frame::Rect;
use crate::simd::{Lanes8, Packed, compiled_for_each_level};

/// The triangles that are kept, in order.
pub(super) struct Survivors(Packed<{ Batch::CAPACITY + LANES }>);

impl Survivors {
    pub(super) fn new() -> Self {
        Self(Packed::new())
    }

    /// A [`ClassedIndex`] each.
    pub(super) fn as_slice(&self) -> &[u32] {
        self.0.as_slice()
    }
}

compiled_for_each_level! {
    /// Keeps the triangles that have a pixel centre in their box and inside `clip`.
    pub(super) fn cull[][](batch: &Batch, clip: Rect, kept: &mut Survivors) = cull_by;
}

/// The longer side of the box of a triangle whose pixels are looked at one by one.
pub(crate) const TINY_SIDE: i32 = 2;

#[inline(always)]
fn cull_by<S: Lanes8>(s: S, batch: &Batch, clip: Rect, kept: &mut Survivors) {
    // Whole vectors of eight; what stands in the last after the batch's own triangles is not kept.
    let ([x0, x1, x2], [y0, y1, y2]) = (&batch.x, &batch.y);
    let [x0, x1, x2] = [x0.as_chunks::<LANES>().0, x1.as_chunks::<LANES>().0, x2.as_chunks::<LANES>().0];
    let [y0, y1, y2] = [y0.as_chunks::<LANES>().0, y1.as_chunks::<LANES>().0, y2.as_chunks::<LANES>().0];
    for at in 0..batch.count.div_ceil(LANES).min(Batch::CAPACITY / LANES) {
        let (x, y) =
            ([s.i32s(&x0[at]), s.i32s(&x1[at]), s.i32s(&x2[at])], [s.i32s(&y0[at]), s.i32s(&y1[at]), s.i32s(&y2[at])]);
        // At most 128.
        let number = s.add_i32(s.all_i32((at * LANES) as i32), s.i32s(&[0, 1, 2, 3, 4, 5, 6, 7]));
        let is_there = s.is_greater(s.all_i32(batch.count as i32), number);
        let bounds = Bounds::of(s, x, y);
        let mut covers = s.both(is_there, bounds.overlap(s, clip));
        if s.mask_bits(covers) == 0 {
            continue;
        }
        if !batch.is_culled {
            covers = bounds.but_empty(s, covers, x, y);
        }
        let class = |class: i32| s.all_i32(class << 8);
        let (small, large) = (bounds.are_small(s), bounds.are_batched(s));
        let (unbatched, crossing) = (class(ClassedIndex::UNBATCHED), class(ClassedIndex::CROSSES_CLIP));
        let across = s.select_i32(large, crossing, unbatched);
        let inside = s.select_i32(large, class(ClassedIndex::LARGE), unbatched);
        let inside = s.select_i32(small, class(ClassedIndex::SMALL), inside);
        let class = s.select_i32(bounds.cross(s, clip), across, inside);
        kept.0.append(s, covers, s.or_i32(class, number));
    }
}

/// The bounds of eight triangles: of their corners in 1/256 pixel, and the box of pixel centres between these, its ends
/// excluded.
pub(crate) struct Bounds<S: Lanes8> {
    x: [S::I32; 2],
    y: [S::I32; 2],
    columns: [S::I32; 2],
    rows: [S::I32; 2],
}

impl<S: Lanes8> Bounds<S> {
    #[inline(always)]
    pub(crate) fn of(s: S, x: [S::I32; 3], y: [S::I32; 3]) -> Self {
        let (x, y) = (ends(s, x), ends(s, y));
        let columns = [first_centre(s, x[0]), first_centre(s, x[1])];
        let rows = [first_centre(s, y[0]), first_centre(s, y[1])];
        Self { x, y, columns, rows }
    }

    /// A pixel centre of the rectangle, which lies inside a frame, is in the box.
    #[inline(always)]
    pub(crate) fn overlap(&self, s: S, clip: Rect) -> S::Mask {
        // Sides are at most 4,096.
        let side = |side: u32| s.all_i32(side as i32);
        let first = s.max_i32(self.columns[0], side(clip.x0));
        let in_columns = s.is_greater(s.min_i32(self.columns[1], side(clip.x1)), first);
        let first = s.max_i32(self.rows[0], side(clip.y0));
        s.both(in_columns, s.is_greater(s.min_i32(self.rows[1], side(clip.y1)), first))
    }

    /// The box does not lie inside the rectangle.
    #[inline(always)]
    fn cross(&self, s: S, clip: Rect) -> S::Mask {
        let side = |side: u32| s.all_i32(side as i32);
        // Negative where a side is crossed.
        let left = s.sub_i32(self.columns[0], side(clip.x0));
        let right = s.sub_i32(side(clip.x1), self.columns[1]);
        let top = s.sub_i32(self.rows[0], side(clip.y0));
        let bottom = s.sub_i32(side(clip.y1), self.rows[1]);
        s.is_greater(s.all_i32(0), s.or_i32(s.or_i32(left, right), s.or_i32(top, bottom)))
    }

    #[inline(always)]
    fn are_small(&self, s: S) -> S::Mask {
        let few_columns = s.is_greater(s.all_i32(MAX_COLUMNS + 1), s.sub_i32(self.columns[1], self.columns[0]));
        s.both(few_columns, s.is_greater(s.all_i32(MAX_ROWS + 1), s.sub_i32(self.rows[1], self.rows[0])))
    }

    /// They are small enough for set-up in f64.
    #[inline(always)]
    fn are_batched(&self, s: S) -> S::Mask {
        // Differences are at most 2²¹.
        let (width, height) = (s.sub_i32(self.x[1], self.x[0]), s.sub_i32(self.y[1], self.y[0]));
        let fours = |units: S::I32| s.sar_i32(s.add_i32(units, s.all_i32(1_023)), 10);
        let squares = s.mul_i32(fours(width), fours(height));
        let sides =
            s.both(s.is_greater(s.all_i32(MAX_WIDTH + 1), width), s.is_greater(s.all_i32(MAX_HEIGHT + 1), height));
        s.both(sides, s.is_greater(s.all_i32(MAX_AREA_4X4 + 1), squares))
    }

    /// Those of `triangles` that cover a pixel, as far as it is found out: if a box has at most 2 × 2 pixels, one of them
    /// lies in the triangle.
    #[inline(always)]
    pub(crate) fn but_empty(&self, s: S, triangles: S::Mask, x: [S::I32; 3], y: [S::I32; 3]) -> S::Mask {
        let end = s.all_i32(TINY_SIDE + 1);
        let few_columns = s.is_greater(end, s.sub_i32(self.columns[1], self.columns[0]));
        let few_rows = s.is_greater(end, s.sub_i32(self.rows[1], self.rows[0]));
        let tiny = s.both(triangles, s.both(few_columns, few_rows));
        if s.mask_bits(tiny) == 0 {
            return triangles;
        }
        let half = s.all_i32(128);
        let left = s.add_i32(s.shl_i32(self.columns[0], 8), half);
        let top = s.add_i32(s.shl_i32(self.rows[0], 8), half);
        let [a, b, c] = [
            (s.sub_i32(x[0], left), s.sub_i32(y[0], top)),
            (s.sub_i32(x[1], left), s.sub_i32(y[1], top)),
            (s.sub_i32(x[2], left), s.sub_i32(y[2], top)),
        ];
        s.but_not(triangles, s.both(tiny, cover_none_of_four(s, a, b, c)))
    }
}

/// The least and the greatest.
#[inline(always)]
fn ends<S: Lanes8>(s: S, [a, b, c]: [S::I32; 3]) -> [S::I32; 2] {
    [s.min_i32(s.min_i32(a, b), c), s.max_i32(s.max_i32(a, b), c)]
}

/// Triangles that have none of four pixels: that at the origin, the next, and the two below. The answer is right only where
/// corners are less than 1,024 units away.
///
/// ```text
/// E(p) = (b − a) × (p − a)        of each edge; positive inside, or if counter-clockwise, negative
/// ```
///
/// A point on an edge lies inside if the edge is a left or a top one; otherwise one step of E more makes it negative.
#[inline(always)]
fn cover_none_of_four<S: Lanes8>(s: S, a: (S::I32, S::I32), b: (S::I32, S::I32), c: (S::I32, S::I32)) -> S::Mask {
    let (ab, bc, ca) = (cross(s, a, b), cross(s, b, c), cross(s, c, a));
    // Twice the area; −1 if it is negative.
    let turned = s.sar_i32(s.add_i32(s.add_i32(ab, bc), ca), 31);
    let ab = at_four(s, ab, a, b, turned);
    let bc = at_four(s, bc, b, c, turned);
    let ca = at_four(s, ca, c, a, turned);
    let mut none = s.all_i32(-1);
    for pixel in 0..4 {
        none = s.and_i32(none, s.or_i32(s.or_i32(ab[pixel], bc[pixel]), ca[pixel]));
    }
    s.is_greater(s.all_i32(0), none)
}

/// An edge at the origin.
#[inline(always)]
fn cross<S: Lanes8>(s: S, (ax, ay): (S::I32, S::I32), (bx, by): (S::I32, S::I32)) -> S::I32 {
    s.sub_i32(s.mul_i32(ax, by), s.mul_i32(ay, bx))
}

/// An edge at the four pixels, negative where they lie outside.
#[inline(always)]
fn at_four<S: Lanes8>(s: S, e: S::I32, from: (S::I32, S::I32), to: (S::I32, S::I32), turned: S::I32) -> [S::I32; 4] {
    let dx = turn(s, s.sub_i32(to.0, from.0), turned);
    let dy = turn(s, s.sub_i32(to.1, from.1), turned);
    // Up, or level and to the right: −1.
    let is_in = s.sar_i32(s.sub_i32(s.shl_i32(dy, 10), dx), 31);
    let first = s.sub_i32(s.sub_i32(turn(s, e, turned), s.all_i32(1)), is_in);
    let (right, down) = (s.shl_i32(dy, 8), s.shl_i32(dx, 8));
    let below = s.add_i32(first, down);
    [first, s.sub_i32(first, right), below, s.sub_i32(below, right)]
}

/// `n`, negated where `turned` is −1.
#[inline(always)]
fn turn<S: Lanes8>(s: S, n: S::I32, turned: S::I32) -> S::I32 {
    s.sub_i32(s.xor_i32(n, turned), turned)
}
