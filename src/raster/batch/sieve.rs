//! The sieve: which triangles of a batch may cover a pixel.

use super::Batch;
use super::rows::{MOST_COLUMNS, MOST_ROWS, MOST_UNITS};
use crate::raster::frame::Rect;

/// What becomes of a triangle that has a pixel centre in its box.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    /// It lies inside the clip rectangle and is small enough for `rows`.
    Small,
    /// It lies inside the clip rectangle and is small enough for `tall`.
    Tall,
    Other,
}

/// A triangle's number, and what becomes of it.
pub(super) type Chosen = (u8, Kind);

/// Numbers of triangles, in order.
pub(super) struct Kept {
    // One place more than triangles: every triangle is written, and those that are not kept are written over.
    triangles: [Chosen; Batch::CAPACITY + 1],
    count: usize,
}

impl Kept {
    pub(super) fn new() -> Self {
        Self { triangles: [(0, Kind::Other); Batch::CAPACITY + 1], count: 0 }
    }

    pub(super) fn triangles(&self) -> &[Chosen] {
        &self.triangles[..self.count]
    }
}

/// Keeps the triangles that have a pixel centre in their box and inside `clip`.
pub(super) fn sieve(batch: &Batch, clip: Rect, kept: &mut Kept) {
    sieve_inlined(batch, clip, kept);
}

#[inline(always)]
pub(super) fn sieve_inlined(batch: &Batch, clip: Rect, kept: &mut Kept) {
    // Inside a frame, at most 4,096.
    let [left, top, right, bottom] = [clip.x0, clip.y0, clip.x1, clip.y1].map(|side| side as i32);
    // 0: not kept, 1: small, 2: tall, 3: another.
    let mut kinds = [0_i32; Batch::CAPACITY];
    // Whole vectors of eight; what stands in the last after the batch's own triangles is not looked at.
    let most = batch.count.next_multiple_of(8).min(Batch::CAPACITY);
    let [x0, x1, x2] = batch.x.each_ref().map(|x| &x[..most]);
    let [y0, y1, y2] = batch.y.each_ref().map(|y| &y[..most]);
    for (i, kind) in kinds[..most].iter_mut().enumerate() {
        let (low_x, high_x) = (x0[i].min(x1[i]).min(x2[i]), x0[i].max(x1[i]).max(x2[i]));
        let (low_y, high_y) = (y0[i].min(y1[i]).min(y2[i]), y0[i].max(y1[i]).max(y2[i]));
        // `I24F8::first_centre`, of coordinates of at most 2²⁰.
        let (column, end_column) = ((low_x + 127) >> 8, (high_x + 127) >> 8);
        let (row, end_row) = ((low_y + 127) >> 8, (high_y + 127) >> 8);
        let covers = (column.max(left) < end_column.min(right)) & (row.max(top) < end_row.min(bottom));
        let inside = (column >= left) & (end_column <= right) & (row >= top) & (end_row <= bottom);
        let few = (end_column - column <= MOST_COLUMNS) & (end_row - row <= MOST_ROWS);
        let more = (high_x - low_x <= MOST_UNITS) & (high_y - low_y <= MOST_UNITS);
        *kind = if covers { 3 - i32::from(inside & more) - i32::from(inside & few) } else { 0 };
    }
    let mut count = 0;
    for (at, &kind) in kinds[..batch.count].iter().enumerate() {
        // Below 128.
        let is = match kind {
            1 => Kind::Small,
            2 => Kind::Tall,
            _ => Kind::Other,
        };
        kept.triangles[count] = (at as u8, is);
        count += usize::from(kind != 0);
    }
    kept.count = count;
}
