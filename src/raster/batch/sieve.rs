//! Culling: the triangles of a batch that may cover a pixel.

use super::Batch;
use super::rows::{Ints, LANES, MAX_ACROSS, MAX_AREA_4X4, MAX_COLUMNS, MAX_DOWN, MAX_ROWS};
use crate::raster::frame::Rect;

/// Class of a triangle that has a pixel centre in its box.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    /// Lies inside the clip rectangle and is small enough for `rows`.
    Small,
    /// Lies inside the clip rectangle and is small enough for `tall`.
    Large,
    /// Reaches over the clip rectangle's edge, and is no larger than `Large` allows.
    Clipped,
    Other,
}

/// Number of a triangle, and above it its class: 1 small, 2 large, 3 another, 4 clipped.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct Chosen(u16);

impl Chosen {
    /// Below `Batch::CAPACITY`.
    #[inline(always)]
    pub(super) fn number(self) -> usize {
        usize::from(self.0) % Batch::CAPACITY
    }

    #[inline(always)]
    pub(super) fn kind(self) -> Kind {
        match self.0 >> 8 {
            1 => Kind::Small,
            2 => Kind::Large,
            4 => Kind::Clipped,
            _ => Kind::Other,
        }
    }

    /// Counts those kept, from the first on, that are small, large or clipped.
    #[inline(always)]
    pub(super) fn in_batch(kept: &[Self]) -> usize {
        // Eight at a time, as in `alike`. Only of another both of the lowest bits above the number are set.
        let is_other = |chosen: &Self| chosen.0 & chosen.0 >> 1 & 1 << 8;
        let none = |eight: &&[Self; LANES]| eight.iter().fold(0, |any, chosen| any | is_other(chosen)) == 0;
        let whole = kept.as_chunks::<LANES>().0.iter().take_while(none).count() * LANES;
        whole + kept[whole..].iter().take_while(|chosen| is_other(chosen) == 0).count()
    }

    /// Returns whether all of these, of which none is another, are small.
    #[cfg(all(feature = "simd", target_arch = "x86_64"))]
    #[inline(always)]
    pub(super) fn are_small(kept: &[Self]) -> bool {
        kept.iter().fold(0, |any, chosen| any | chosen.0) & 6 << 8 == 0
    }

    /// Counts those kept, from the first on, that are of the first one's kind.
    #[inline(always)]
    pub(super) fn alike(kept: &[Self]) -> usize {
        let Some(first) = kept.first() else { return 0 };
        let differs = |other: &Self| (other.0 ^ first.0) >> 8;
        // Mostly all. (One by one 2 ns a triangle.)
        let alike = |eight: &&[Self; LANES]| eight.iter().fold(0, |any, other| any | differs(other)) == 0;
        let whole = kept.as_chunks::<LANES>().0.iter().take_while(alike).count() * LANES;
        whole + kept[whole..].iter().take_while(|other| differs(other) == 0).count()
    }
}

/// The kept ones among numbers in order, packed.
pub(super) struct Kept {
    // Sixteen places more than triangles: up to so many are written at a time, and those that are not kept are written over.
    pub(super) triangles: [Chosen; Batch::CAPACITY + 2 * LANES],
    pub(super) count: usize,
}

impl Kept {
    pub(super) fn new() -> Self {
        Self { triangles: [Chosen(0); Batch::CAPACITY + 2 * LANES], count: 0 }
    }

    pub(super) fn triangles(&self) -> &[Chosen] {
        &self.triangles[..self.count]
    }
}

/// Writes those of eight that are not 0 one after the other, anything behind them, and says how many they are.
#[inline(always)]
pub(super) fn pack(eight: &Ints, to: &mut [Chosen; LANES]) -> usize {
    let mut count = 0;
    for &chosen in eight {
        // Below 2,048; fewer than eight come before it.
        to[count % LANES] = Chosen(chosen as u16);
        count += usize::from(chosen != 0);
    }
    count
}

/// Keeps the triangles that have a pixel centre in their box and inside `clip`.
pub(super) fn sieve(batch: &Batch, clip: Rect, kept: &mut Kept) {
    sieve_by(batch, clip, kept, pack);
}

/// The longer side of the box of a triangle whose pixels are looked at one by one.
const TINY_SIDE: i32 = 2;

#[inline(always)]
pub(super) fn sieve_by(
    batch: &Batch,
    clip: Rect,
    kept: &mut Kept,
    pack: impl Fn(&Ints, &mut [Chosen; LANES]) -> usize,
) {
    // Inside a frame, at most 4,096.
    let [left, top, right, bottom] = [clip.x0, clip.y0, clip.x1, clip.y1].map(|side| side as i32);
    // Whole vectors of eight; what stands in the last after the batch's own triangles is not kept.
    let [x0, x1, x2] = batch.x.each_ref().map(|x| x.as_chunks::<LANES>().0);
    let [y0, y1, y2] = batch.y.each_ref().map(|y| y.as_chunks::<LANES>().0);
    let mut count = 0;
    for at in 0..batch.count.div_ceil(LANES).min(Batch::CAPACITY / LANES) {
        // At most 128.
        let (first, most) = ((at * LANES) as i32, batch.count as i32);
        let mut chosen = [0_i32; LANES];
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
            let few = (end_column - column <= MAX_COLUMNS) & (end_row - row <= MAX_ROWS);
            // Differences are at most 2²¹.
            let (across, down) = (high_x - low_x, high_y - low_y);
            let squares = ((across + 1_023) >> 10).wrapping_mul((down + 1_023) >> 10);
            let more = (across <= MAX_ACROSS) & (down <= MAX_DOWN) & (squares <= MAX_AREA_4X4);
            let tiny = (end_column - column <= TINY_SIDE) & (end_row - row <= TINY_SIDE);
            let number = first + i as i32; // below 128
            let kind = 3 - i32::from(inside & more) - i32::from(inside & few) + i32::from(!inside & more);
            chosen[i] = if covers & (number < most) { kind << 8 | number } else { 0 };
            are_tiny[i] = i32::from(covers & inside & tiny);
            (columns[i], rows[i]) = (column, row);
        }
        if !batch.is_sifted && are_tiny != [0; LANES] {
            for i in 0..LANES {
                let (left, top) = (columns[i] * 256 + 128, rows[i] * 256 + 128);
                let corner = |k: usize| (x[k][i] - left, y[k][i] - top);
                let none = covers_none(corner(0), corner(1), corner(2));
                chosen[i] = if none & (are_tiny[i] != 0) { 0 } else { chosen[i] };
            }
        }
        if let Some(to) = kept.triangles[count..].first_chunk_mut::<LANES>() {
            count += pack(&chosen, to);
        }
    }
    kept.count = count;
}

/// Returns whether a triangle has none of four pixels: that at the origin, the next, and the two below. The answer is
/// right only if the corners are less than 1,024 units away; for others it may be anything.
///
/// ```text
/// E(p) = (b − a) × (p − a)        of each edge; positive inside, or if counter-clockwise, negative
/// ```
///
/// A point on an edge lies inside if the edge is a left or a top one; otherwise one step of E more makes it negative.
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
