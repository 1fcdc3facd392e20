//! Rows of triangles that are set up: where each begins and ends, and its first shade and depth.
//!
//! One row of each of eight triangles, or eight rows of one: both are lanes of the same formula, and [`Lane`] says which.
//!
//! Left and right are the smaller and the greater of two edges: where the long edge and a short one meet a row, one
//! lies left of the other in exact arithmetic, and rounding up keeps their order.

use super::frame::Rect;
use super::pick::{LANES, NUMBERS};
use super::setup::{Edges, Floats, Ints, TriangleSetup8, ValuePlanes8};
use crate::fixed::ROUND_MAGIC;
use crate::simd::Lanes8;
use crate::span::list::{DepthSteps, SpanList, Spans8};

/// Most rows of eight small triangles that are found row by row, and put into the triangles' order afterwards.
pub(super) const MAX_SHORT_ROWS: i32 = 4;

/// What the eight lanes of a vector are.
trait Lane<S: Lanes8>: Copy {
    fn f64s(self, s: S, from: &Floats) -> S::F64;
    fn i32s(self, s: S, from: &Ints) -> S::I32;
    fn i64s(self, s: S, from: &[i64; LANES]) -> S::I64;
}

/// Lanes are the same row of each of eight triangles.
#[derive(Clone, Copy)]
struct EachTriangle;

impl<S: Lanes8> Lane<S> for EachTriangle {
    #[inline(always)]
    fn f64s(self, s: S, from: &Floats) -> S::F64 {
        s.f64s(from)
    }
    #[inline(always)]
    fn i32s(self, s: S, from: &Ints) -> S::I32 {
        s.i32s(from)
    }
    #[inline(always)]
    fn i64s(self, s: S, from: &[i64; LANES]) -> S::I64 {
        s.i64s(from)
    }
}

/// Lanes are eight rows of this triangle, whose number is below 8.
#[derive(Clone, Copy)]
struct OneTriangle(usize);

impl<S: Lanes8> Lane<S> for OneTriangle {
    #[inline(always)]
    fn f64s(self, s: S, from: &Floats) -> S::F64 {
        s.all_f64(from[self.0 % LANES])
    }
    #[inline(always)]
    fn i32s(self, s: S, from: &Ints) -> S::I32 {
        s.all_i32(from[self.0 % LANES])
    }
    #[inline(always)]
    fn i64s(self, s: S, from: &[i64; LANES]) -> S::I64 {
        s.all_i64(from[self.0 % LANES])
    }
}

/// The ends of eight rows.
pub(super) struct RowEnds<S: Lanes8> {
    /// Columns from the box's first on, as sums with `ROUND_MAGIC`: the first pixel, and the one behind the last.
    pub(super) left: S::F64,
    right: S::F64,
    /// The numerator of the shade at the box's first column.
    shade_n: S::F64,
}

impl<S: Lanes8> RowEnds<S> {
    /// Rows of these numbers, as f64 and as i32. Beyond a triangle's last row they have any ends.
    #[inline(always)]
    fn of(s: S, lane: impl Lane<S>, setup: &TriangleSetup8, j: S::F64, number: S::I32) -> Self {
        let long = edge(s, lane, &setup.long, j);
        let (upper, lower) = (edge(s, lane, &setup.upper, j), edge(s, lane, &setup.lower, j));
        let short = s.select(s.is_greater(lane.i32s(s, &setup.split), number), upper, lower);
        let shade_n = s.mul_add(lane.f64s(s, &setup.shade.per_row), j, lane.f64s(s, &setup.shade.n));
        Self { left: s.min(long, short), right: s.max(long, short), shade_n }
    }

    /// The shade at these columns, and above it the step.
    #[inline(always)]
    fn paint(&self, s: S, lane: impl Lane<S>, setup: &TriangleSetup8, columns: S::F64) -> S::I32 {
        value_at(s, lane, (&setup.shade, &setup.inverse), self.shade_n, columns)
    }

    /// Another value at the first pixels of row `j` of each of eight triangles, and above it the step.
    #[cfg(feature = "alloc")]
    #[inline(always)]
    pub(super) fn value(&self, s: S, planes: (&ValuePlanes8, &Floats), j: S::F64) -> S::I32 {
        let n = s.mul_add(s.f64s(&planes.0.per_row), j, s.f64s(&planes.0.n));
        value_at(s, EachTriangle, planes, n, self.left)
    }
}

/// A value at these columns, and above it the step, from the numerator at the first column.
#[inline(always)]
fn value_at<S: Lanes8>(
    s: S,
    lane: impl Lane<S>,
    (planes, inverse): (&ValuePlanes8, &Floats),
    n: S::F64,
    columns: S::F64,
) -> S::I32 {
    let magic = s.all_f64(ROUND_MAGIC);
    let n = s.mul_add(lane.f64s(s, &planes.per_column), s.sub(columns, magic), n);
    let value = s.low_bits(s.mul_add(n, lane.f64s(s, inverse), magic));
    s.or_i32(s.and_i32(value, s.all_i32(0xFFFF)), lane.i32s(s, &planes.step))
}

/// The first pixels on edges or right of them, as sums with `ROUND_MAGIC`.
#[inline(always)]
fn edge<S: Lanes8>(s: S, lane: impl Lane<S>, edges: &Edges, j: S::F64) -> S::F64 {
    let n = s.mul_add(lane.f64s(s, &edges.per_row), j, lane.f64s(s, &edges.n));
    s.mul_add(n, lane.f64s(s, &edges.inverse), s.all_f64(ROUND_MAGIC))
}

/// The next row of each of eight triangles.
struct RowCursor8<S: Lanes8> {
    at: S::I32,
    cell: S::I32,
    z: S::I64,
}

impl<S: Lanes8> RowCursor8<S> {
    #[inline(always)]
    fn new<const DEPTHS: bool>(s: S, setup: &TriangleSetup8) -> Self {
        let at = s.i32s(&setup.at);
        Self {
            at,
            cell: if DEPTHS { s.i32s(&setup.cell) } else { at },
            z: if DEPTHS { s.i64s(&setup.z) } else { s.all_i64(0) },
        }
    }

    /// Row `number`, and goes on to the next.
    #[inline(always)]
    fn row<const DEPTHS: bool>(&mut self, s: S, setup: &TriangleSetup8, list: &SpanList, number: i32) -> Spans8<S> {
        let lane = EachTriangle;
        let j = s.all_f64(f64::from(number));
        let number = s.all_i32(number);
        let ends = RowEnds::of(s, lane, setup, j, number);
        let (left, right) = (s.low_bits(ends.left), s.low_bits(ends.right));
        let is_row = s.is_greater(s.i32s(&setup.rows), number);
        let mut z = self.z;
        if DEPTHS {
            z = s.add_i64(z, s.mul_low_i64(s.bits(ends.left), s.i64s(&setup.z_per_column)));
            self.z = s.add_i64(self.z, s.i64s(&setup.z_per_row));
        }
        let spans = Spans8 {
            at: s.add_i32(self.at, left),
            cell: s.add_i32(self.cell, left),
            length: s.select_i32(is_row, s.sub_i32(right, left), s.all_i32(0)),
            paint: ends.paint(s, lane, setup, ends.left),
            z,
        };
        self.at = s.add_i32(self.at, s.all_i32(list.pitch));
        if DEPTHS {
            self.cell = s.add_i32(self.cell, s.all_i32(list.width));
        }
        spans
    }
}

/// Lists all rows of eight small triangles of at most [`MAX_SHORT_ROWS`] rows each, triangle by triangle. There is room.
#[inline(always)]
pub(super) fn list_short<S: Lanes8, const DEPTHS: bool>(
    s: S,
    setup: &TriangleSetup8,
    most_rows: i32,
    list: &mut SpanList,
) {
    let mut cursor = RowCursor8::new::<DEPTHS>(s, setup);
    let dz = |i: usize| setup.z_per_column[i];
    if most_rows <= 0 {
        return;
    }
    let first = cursor.row::<DEPTHS>(s, setup, list, 0);
    if most_rows == 1 {
        let dz = if DEPTHS { DepthSteps::Each(s.i64s(&setup.z_per_column)) } else { DepthSteps::All(0) };
        list.append::<S, DEPTHS>(s, &first, dz);
        return;
    }
    let second = cursor.row::<DEPTHS>(s, setup, list, 1);
    if most_rows == 2 {
        let [low, high] = first.zip::<DEPTHS>(s, &second, list);
        let (mut of_low, mut of_high) = (DepthSteps::All(0), DepthSteps::All(0));
        if DEPTHS {
            let dz = s.i64s(&setup.z_per_column);
            let [low, high] = s.zip_i64(dz, dz);
            (of_low, of_high) = (DepthSteps::Each(low), DepthSteps::Each(high));
        }
        list.append::<S, DEPTHS>(s, &low, of_low);
        list.append::<S, DEPTHS>(s, &high, of_high);
        return;
    }
    let third = cursor.row::<DEPTHS>(s, setup, list, 2);
    let fourth = cursor.row::<DEPTHS>(s, setup, list, 3);
    let even = first.zip::<DEPTHS>(s, &third, list);
    let odd = second.zip::<DEPTHS>(s, &fourth, list);
    for (half, even) in even.iter().enumerate() {
        for (quarter, spans) in even.zip::<DEPTHS>(s, &odd[half], list).iter().enumerate() {
            let i = 4 * half + 2 * quarter;
            let dz = if DEPTHS { DepthSteps::Each(s.halves_i64(dz(i), dz(i + 1))) } else { DepthSteps::All(0) };
            list.append::<S, DEPTHS>(s, spans, dz);
        }
    }
}

/// Eight rows of triangle `i` from number `first` on. Beyond its last row they have no length.
#[inline(always)]
fn eight_rows<S: Lanes8, const DEPTHS: bool>(
    s: S,
    setup: &TriangleSetup8,
    (i, first): (usize, i32),
    list: &SpanList,
) -> (RowEnds<S>, Spans8<S>) {
    let lane = OneTriangle(i);
    let number = s.add_i32(s.all_i32(first), s.i32s(&NUMBERS));
    let ends = RowEnds::of(s, lane, setup, s.to_f64(number), number);
    let is_row = s.is_greater(lane.i32s(s, &setup.rows), number);
    let (left, right) = (s.low_bits(ends.left), s.low_bits(ends.right));
    let at = s.add_i32(lane.i32s(s, &setup.at), s.mul_i32(number, s.all_i32(list.pitch)));
    let (mut cell, mut z) = (at, s.all_i64(0));
    if DEPTHS {
        cell = s.add_i32(lane.i32s(s, &setup.cell), s.mul_i32(number, s.all_i32(list.width)));
        z = s.mul_i64(s.to_i64(number), lane.i64s(s, &setup.z_per_row));
        z = s.add_i64(z, lane.i64s(s, &setup.z));
        z = s.add_i64(z, s.mul_low_i64(s.bits(ends.left), lane.i64s(s, &setup.z_per_column)));
    }
    let spans = Spans8 {
        at: s.add_i32(at, left),
        cell: s.add_i32(cell, left),
        length: s.select_i32(is_row, s.sub_i32(right, left), s.all_i32(0)),
        paint: ends.paint(s, lane, setup, ends.left),
        z,
    };
    (ends, spans)
}

/// Row `number` of each of eight small triangles: its ends, and the first column that is covered, the one behind the last,
/// and the first shade with the step above it.
#[cfg(feature = "alloc")]
#[inline(always)]
pub(super) fn find_row<S: Lanes8>(s: S, setup: &TriangleSetup8, number: i32) -> (RowEnds<S>, [S::I32; 3]) {
    let lane = EachTriangle;
    let ends = RowEnds::of(s, lane, setup, s.all_f64(f64::from(number)), s.all_i32(number));
    let column = s.i32s(&setup.column);
    let [left, right] = [s.add_i32(column, s.low_bits(ends.left)), s.add_i32(column, s.low_bits(ends.right))];
    let paint = ends.paint(s, lane, setup, ends.left);
    (ends, [left, right, paint])
}

/// Lists eight rows of small triangle `i` from number `first` on. There is room for eight.
#[inline(always)]
pub(super) fn list_eight_rows<S: Lanes8, const DEPTHS: bool>(
    s: S,
    setup: &TriangleSetup8,
    (i, first): (usize, i32),
    list: &mut SpanList,
) {
    let (_, spans) = eight_rows::<S, DEPTHS>(s, setup, (i, first), list);
    list.append::<S, DEPTHS>(s, &spans, DepthSteps::All(setup.z_per_column[i % LANES]));
}

/// Lists eight rows of triangle `i` from number `first` on, each in so many pieces of up to `longest` pixels, which begin
/// anew. Parts outside `clip`, if there is one, are left out. There is room for eight spans a piece.
#[inline(always)]
pub(super) fn list_pieces<S: Lanes8, const DEPTHS: bool>(
    s: S,
    setup: &TriangleSetup8,
    (i, first): (usize, i32),
    (pieces, longest): (usize, i32),
    clip: Option<Rect>,
    list: &mut SpanList,
) {
    let lane = OneTriangle(i);
    let (ends, rows) = eight_rows::<S, DEPTHS>(s, setup, (i, first), list);
    let mut is_row = s.is_greater(rows.length, s.all_i32(0));
    // Columns of the frame from the box's first on. All are below 4,096.
    let side = |column: u32| s.all_f64(ROUND_MAGIC + f64::from(column as i32 - setup.column[i % LANES]));
    let mut left = ends.left;
    if let Some(clip) = clip {
        // A row that begins left of the frame begins anew at its side.
        left = s.max(left, side(0));
        let number = s.add_i32(s.all_i32(setup.row[i % LANES] + first), s.i32s(&NUMBERS));
        is_row = s.both(is_row, s.is_greater(number, s.all_i32(clip.y0 as i32 - 1)));
        is_row = s.both(is_row, s.is_greater(s.all_i32(clip.y1 as i32), number));
    }
    let (step, dz) = (lane.i32s(s, &setup.shade.step), lane.i64s(s, &setup.z_per_column));
    for _ in 0..pieces {
        let end = s.add(left, s.all_f64(longest.into()));
        let (mut start, mut right) = (left, s.min(ends.right, end));
        let mut paint = ends.paint(s, lane, setup, left);
        if let Some(clip) = clip {
            // A piece that begins left of the rectangle goes on from its start.
            start = s.max(left, side(clip.x0));
            right = s.min(right, side(clip.x1));
            let skipped = s.sub_i32(s.low_bits(start), s.low_bits(left));
            // Both in upper halves, as the step is.
            let shade = s.add_i32(s.shl_i32(paint, 16), s.mul_i32(step, skipped));
            paint = s.or_i32(s.and_i32(s.sar_i32(shade, 16), s.all_i32(0xFFFF)), step);
        }
        let moved = s.sub_i32(s.low_bits(start), s.low_bits(ends.left));
        let length = s.sub_i32(s.low_bits(right), s.low_bits(start));
        let spans = Spans8 {
            at: s.add_i32(rows.at, moved),
            cell: s.add_i32(rows.cell, moved),
            length: s.select_i32(is_row, length, s.all_i32(0)),
            paint,
            z: if DEPTHS { s.add_i64(rows.z, s.mul_i64(s.to_i64(moved), dz)) } else { rows.z },
        };
        list.append::<S, DEPTHS>(s, &spans, DepthSteps::All(setup.z_per_column[i % LANES]));
        left = end;
        if s.mask_bits(s.is_less(left, ends.right)) == 0 {
            break;
        }
    }
}
