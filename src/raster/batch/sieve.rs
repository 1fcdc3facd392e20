//! The sieve: which triangles of a batch may cover a pixel.

use super::Batch;
use super::rows::{LANES, MOST_COLUMNS, MOST_ROWS, MOST_UNITS};
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

/// The longer side of the box of a triangle whose pixels are looked at one by one.
const MOST_LOOKED_AT: i32 = 2;

#[inline(always)]
pub(super) fn sieve_inlined(batch: &Batch, clip: Rect, kept: &mut Kept) {
    // Inside a frame, at most 4,096.
    let [left, top, right, bottom] = [clip.x0, clip.y0, clip.x1, clip.y1].map(|side| side as i32);
    // 0: not kept, 1: small, 2: tall, 3: another.
    let mut kinds = [0_i32; Batch::CAPACITY];
    // Whole vectors of eight; what stands in the last after the batch's own triangles is not looked at.
    let [x0, x1, x2] = batch.x.each_ref().map(|x| x.as_chunks::<LANES>().0);
    let [y0, y1, y2] = batch.y.each_ref().map(|y| y.as_chunks::<LANES>().0);
    for (at, kinds) in kinds.as_chunks_mut::<LANES>().0.iter_mut().take(batch.count.div_ceil(LANES)).enumerate() {
        let (x, y) = ([x0[at], x1[at], x2[at]], [y0[at], y1[at], y2[at]]);
        let (mut columns, mut rows, mut are_tiny) = ([0; LANES], [0; LANES], [0; LANES]);
        for i in 0..LANES {
            let (low_x, high_x) = (x[0][i].min(x[1][i]).min(x[2][i]), x[0][i].max(x[1][i]).max(x[2][i]));
            let (low_y, high_y) = (y[0][i].min(y[1][i]).min(y[2][i]), y[0][i].max(y[1][i]).max(y[2][i]));
            // `I24F8::first_centre`, of coordinates of at most 2²⁰.
            let (column, end_column) = ((low_x + 127) >> 8, (high_x + 127) >> 8);
            let (row, end_row) = ((low_y + 127) >> 8, (high_y + 127) >> 8);
            let covers = (column.max(left) < end_column.min(right)) & (row.max(top) < end_row.min(bottom));
            let inside = (column >= left) & (end_column <= right) & (row >= top) & (end_row <= bottom);
            let few = (end_column - column <= MOST_COLUMNS) & (end_row - row <= MOST_ROWS);
            let more = (high_x - low_x <= MOST_UNITS) & (high_y - low_y <= MOST_UNITS);
            let tiny = (end_column - column <= MOST_LOOKED_AT) & (end_row - row <= MOST_LOOKED_AT);
            kinds[i] = if covers { 3 - i32::from(inside & more) - i32::from(inside & few) } else { 0 };
            are_tiny[i] = i32::from(covers & inside & tiny);
            (columns[i], rows[i]) = (column, row);
        }
        if are_tiny != [0; LANES] {
            for i in 0..LANES {
                let (left, top) = (columns[i] * 256 + 128, rows[i] * 256 + 128);
                let corner = |k: usize| (x[k][i] - left, y[k][i] - top);
                let none = covers_none(corner(0), corner(1), corner(2));
                kinds[i] -= are_tiny[i] & i32::from(none);
            }
        }
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

/// Whether a triangle has none of four pixels: that at the origin, the next, and the two below. Right only of corners
/// that are less than 1,024 units away; of others anything may come out.
///
/// ```text
/// E(p) = (b − a) × (p − a)        of each edge; positive inside, or if turned over, negative
/// ```
///
/// On an edge lies inside if it is a left one or a top one, so that one step of E more makes it negative if it is not.
#[inline(always)]
fn covers_none(a: (i32, i32), b: (i32, i32), c: (i32, i32)) -> bool {
    let at_origin = |(ax, ay): (i32, i32), (bx, by): (i32, i32)| ax.wrapping_mul(by).wrapping_sub(ay.wrapping_mul(bx));
    let (ab, bc, ca) = (at_origin(a, b), at_origin(b, c), at_origin(c, a));
    // Twice the area; −1 if it is negative.
    let turned = ab.wrapping_add(bc).wrapping_add(ca) >> 31;
    let turn = |n: i32| (n ^ turned).wrapping_sub(turned);
    let edge = |e: i32, from: (i32, i32), to: (i32, i32)| {
        let (dx, dy) = (turn(to.0 - from.0), turn(to.1 - from.1));
        // Up, or level and to the right: −1.
        let is_in = dy.wrapping_mul(1_024).wrapping_sub(dx) >> 31;
        let e = turn(e).wrapping_sub(1).wrapping_sub(is_in);
        let (right, down) = (e.wrapping_sub(dy.wrapping_mul(256)), e.wrapping_add(dx.wrapping_mul(256)));
        [e, right, down, right.wrapping_add(dx.wrapping_mul(256))]
    };
    let (ab, bc, ca) = (edge(ab, a, b), edge(bc, b, c), edge(ca, c, a));
    let outside = |k: usize| ab[k] | bc[k] | ca[k];
    outside(0) & outside(1) & outside(2) & outside(3) < 0
}
