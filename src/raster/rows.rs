//! Rows of triangles after set-up: where each begins and ends, and its first shade and depth.
//!
//! One row of each of eight triangles, or eight rows of one: both are lanes of the same formula, and [`Lane`] says
//! which.
//!
//! The fill of a span is a parameter: [`Shades8`].
//!
//! Left and right are the smaller and the greater of two edges: where the long edge and a short one meet a row, one
//! lies left of the other in exact arithmetic, and rounding up preserves their order.

use super::frame::Rect;
use super::setup::{Corners8, Edges, Floats, FrameLayout, Ints, TriangleSetup8, ValuePlanes8};
use crate::fixed::ROUND_MAGIC;
use crate::lanes::{LANES, NUMBERS};
use crate::simd::Lanes8;
use crate::span::list::{DepthSteps, SpanList, Spans8};
use crate::span::records::Records;
use crate::span::target::Target;

/// The greatest height, in rows, of small triangles that are walked eight at a time; their rows are
/// sorted by triangle afterwards.
pub(super) const MAX_SHORT_ROWS: i32 = 4;

/// The meaning of a vector's eight lanes.
pub(super) trait Lane<S: Lanes8>: Copy {
    fn load_f64(self, s: S, from: &Floats) -> S::F64;
    fn load_i32(self, s: S, from: &Ints) -> S::I32;
    fn load_i64(self, s: S, from: &[i64; LANES]) -> S::I64;
    /// The indices of the triangles.
    fn numbers(self, s: S) -> S::I32;
}

/// Lanes are the same row of each of eight triangles.
#[derive(Clone, Copy)]
struct EachTriangle;

impl<S: Lanes8> Lane<S> for EachTriangle {
    #[inline(always)]
    fn load_f64(self, s: S, from: &Floats) -> S::F64 {
        s.load_f64(from)
    }
    #[inline(always)]
    fn load_i32(self, s: S, from: &Ints) -> S::I32 {
        s.load_i32(from)
    }
    #[inline(always)]
    fn load_i64(self, s: S, from: &[i64; LANES]) -> S::I64 {
        s.load_i64(from)
    }
    #[inline(always)]
    fn numbers(self, s: S) -> S::I32 {
        s.load_i32(&NUMBERS)
    }
}

/// Lanes are eight rows of this triangle, whose index is below 8.
#[derive(Clone, Copy)]
struct OneTriangle(usize);

impl<S: Lanes8> Lane<S> for OneTriangle {
    #[inline(always)]
    fn load_f64(self, s: S, from: &Floats) -> S::F64 {
        s.splat_f64(from[self.0 % LANES])
    }
    #[inline(always)]
    fn load_i32(self, s: S, from: &Ints) -> S::I32 {
        s.splat_i32(from[self.0 % LANES])
    }
    #[inline(always)]
    fn load_i64(self, s: S, from: &[i64; LANES]) -> S::I64 {
        s.splat_i64(from[self.0 % LANES])
    }
    #[inline(always)]
    fn numbers(self, s: S) -> S::I32 {
        // Below 8.
        s.splat_i32((self.0 % LANES) as i32)
    }
}

/// Drawn parts of eight rows, in columns relative to the box's first, as sums with `ROUND_MAGIC`.
pub(super) struct Parts<S: Lanes8> {
    /// The row's first covered pixel inside the frame.
    pub(super) row: S::F64,
    /// The pixel after the row's last covered one.
    pub(super) end: S::F64,
    /// The column of the exact start.
    pub(super) seed: S::F64,
    /// The first pixel that is drawn.
    pub(super) start: S::F64,
}

/// A shade, with its step in the upper half, advanced by this many pixels.
#[inline(always)]
pub(super) fn advance<S: Lanes8>(s: S, value: S::I32, pixels: S::I32) -> S::I32 {
    let step = s.and_i32(value, s.splat_i32(!0xFFFF));
    // Both in upper halves, like the step.
    let shade = s.add_i32(s.shl_i32(value, 16), s.mul_i32(step, pixels));
    s.or_i32(s.and_i32(s.shr_i32(shade, 16), s.splat_i32(0xFFFF)), step)
}

/// Batches of eight triangles whose planes are stored until their spans are drawn. Faces are counted from the first of
/// batch 0.
#[derive(Clone, Copy)]
pub(super) struct Batches {
    /// The batch being set up.
    current: usize,
    /// The index of the first pick of batch 0.
    pub(super) first: usize,
    /// The records of their spans.
    pub(super) records: Records,
}

impl Batches {
    pub(super) const COUNT: usize = 8;
    pub(super) const NONE: Self = Self::from_pick(0);

    /// Batch 0, from this pick on.
    pub(super) const fn from_pick(first: usize) -> Self {
        Self { current: 0, first, records: Records::NONE }
    }

    /// Returns whether there is no room for another.
    #[inline(always)]
    pub(super) fn are_full(&self) -> bool {
        self.current + 1 >= Self::COUNT
    }

    /// Begins the batch from pick `first` on, as batch 0 again once all spans have been drawn.
    #[inline(always)]
    pub(super) fn begin(&mut self, first: usize) {
        match first == 0 || self.are_full() {
            true => (self.current, self.first) = (0, first),
            false => self.current += 1,
        }
    }

    /// The batch being set up.
    #[inline(always)]
    pub(super) fn current(&self) -> usize {
        self.current % Self::COUNT
    }

    /// The index of its first pick.
    #[cfg(feature = "alloc")]
    #[inline(always)]
    pub(super) fn first_pick(&self) -> usize {
        self.first + self.current * LANES
    }

    /// The batch and the lane of a face.
    #[inline(always)]
    pub(super) fn of_face(face: usize) -> (usize, usize) {
        (face / LANES % Self::COUNT, face % LANES)
    }

    /// The faces in the lanes of the batch being set up: below 64.
    #[inline(always)]
    pub(super) fn faces<S: Lanes8>(&self, s: S, lane: impl Lane<S>) -> S::I32 {
        s.add_i32(s.splat_i32((self.current() * LANES) as i32), lane.numbers(s))
    }
}

/// Shades of eight triangles, and of spans in their rows.
pub(super) trait Shades8 {
    /// True if a shade and its step are enough to fill a span.
    const IS_LINEAR: bool;

    /// Returns whether rows are split into pieces of 64 pixels, at which shades are reseeded.
    #[inline(always)]
    fn is_in_pieces(&self) -> bool {
        true
    }

    /// The batches whose planes and records are stored, if spans need them to be filled.
    fn batches(&mut self) -> Option<&mut Batches>;

    /// Returns whether spans have to be drawn before eight more triangles are set up.
    #[inline(always)]
    fn is_full(&mut self) -> bool {
        if let Some(batches) = self.batches() { batches.are_full() } else { false }
    }

    /// Returns whether there is room for the fills of `rows` times eight rows.
    #[inline(always)]
    fn has_room(&mut self, rows: usize) -> bool {
        if let Some(batches) = self.batches() { batches.records.have_room(rows) } else { true }
    }

    /// Begins the eight triangles from pick `first` on.
    #[inline(always)]
    fn begin(&mut self, first: usize) {
        if let Some(batches) = self.batches() {
            batches.begin(first);
        }
    }

    /// Sets up eight triangles, and the fills of their spans.
    fn set_up<S: Lanes8>(&mut self, s: S, corners: &Corners8, setup: &mut TriangleSetup8, of: (FrameLayout, bool));

    /// The fills of the spans of rows: shades with their steps, or the indices of their records.
    fn fill_of<S: Lanes8>(
        &mut self,
        s: S,
        lane: impl Lane<S>,
        setup: &TriangleSetup8,
        ends: &RowEnds<S>,
        parts: &Parts<S>,
    ) -> S::I32;

    /// Completes the set-up of triangle `i` of the eight, which is not a small one.
    #[inline(always)]
    fn set_up_large(&mut self, _i: usize) {}

    /// Draws the spans of a list and empties it; with `DEPTHS`, only where they are nearer than the
    /// target's cells.
    fn draw<const DEPTHS: bool>(&mut self, list: &mut SpanList, target: &mut Target<'_>);
}

/// Linear shades in 8.8, or a single shade per triangle, which needs no plane: all of its rows start with it.
pub(super) struct Linear {
    is_flat: bool,
    in_pieces: bool,
    /// Single shades, with the half that rounds them; the steps, in the upper halves, are 0.
    shades: Ints,
}

impl Linear {
    pub(super) const fn new(is_flat: bool, in_pieces: bool) -> Self {
        Self { is_flat, in_pieces, shades: [0; LANES] }
    }
}

impl Shades8 for Linear {
    const IS_LINEAR: bool = true;

    #[inline(always)]
    fn is_in_pieces(&self) -> bool {
        self.in_pieces
    }

    #[inline(always)]
    fn batches(&mut self) -> Option<&mut Batches> {
        None
    }

    #[inline(always)]
    fn set_up<S: Lanes8>(&mut self, s: S, corners: &Corners8, setup: &mut TriangleSetup8, of: (FrameLayout, bool)) {
        part::<S, Self, _>(
            s,
            #[inline(always)]
            || {
                setup.set_up(s, corners, of, !self.is_flat);
                if self.is_flat {
                    // At most 0xFF80.
                    s.store_i32(s.add_i32(s.load_i32(&corners.shade[0]), s.splat_i32(128)), &mut self.shades);
                }
            },
        );
    }

    #[inline(always)]
    fn fill_of<S: Lanes8>(
        &mut self,
        s: S,
        lane: impl Lane<S>,
        setup: &TriangleSetup8,
        ends: &RowEnds<S>,
        parts: &Parts<S>,
    ) -> S::I32 {
        if self.is_flat {
            lane.load_i32(s, &self.shades)
        } else {
            value_of(s, lane, (&setup.shade, &setup.inverse), ends.j, parts.seed)
        }
    }

    #[inline(always)]
    fn draw<const DEPTHS: bool>(&mut self, list: &mut SpanList, target: &mut Target<'_>) {
        list.draw_by::<DEPTHS>(target);
    }
}

/// The ends of eight rows.
pub(super) struct RowEnds<S: Lanes8> {
    /// Columns relative to the box's first, as sums with `ROUND_MAGIC`: the first pixel, and the one after the last.
    pub(super) left: S::F64,
    right: S::F64,
    /// The indices of the rows.
    pub(super) j: S::F64,
}

impl<S: Lanes8> RowEnds<S> {
    /// The rows with these indices, as f64 and as i32. Beyond a triangle's last row the ends are arbitrary.
    #[inline(always)]
    fn of(s: S, lane: impl Lane<S>, setup: &TriangleSetup8, j: S::F64, number: S::I32) -> Self {
        let long = edge(s, lane, &setup.long, j);
        let (upper, lower) = (edge(s, lane, &setup.upper, j), edge(s, lane, &setup.lower, j));
        let short = s.select(s.is_greater(lane.load_i32(s, &setup.split), number), upper, lower);
        Self { left: s.min(long, short), right: s.max(long, short), j }
    }
}

/// A numerator at these columns of rows `j`.
#[inline(always)]
pub(super) fn numerator_at<S: Lanes8>(
    s: S,
    lane: impl Lane<S>,
    planes: &ValuePlanes8,
    j: S::F64,
    columns: S::F64,
) -> S::F64 {
    let n = s.mul_add(lane.load_f64(s, &planes.per_row), j, lane.load_f64(s, &planes.n));
    s.mul_add(lane.load_f64(s, &planes.per_column), s.sub(columns, s.splat_f64(ROUND_MAGIC)), n)
}

/// A value at these columns of rows `j`, with the step in the upper half.
#[inline(always)]
pub(super) fn value_of<S: Lanes8>(
    s: S,
    lane: impl Lane<S>,
    (planes, inverse): (&ValuePlanes8, &Floats),
    j: S::F64,
    columns: S::F64,
) -> S::I32 {
    let n = numerator_at(s, lane, planes, j, columns);
    let value = s.low_bits(s.mul_add(n, lane.load_f64(s, inverse), s.splat_f64(ROUND_MAGIC)));
    s.or_i32(s.and_i32(value, s.splat_i32(0xFFFF)), lane.load_i32(s, &planes.step))
}

/// The first pixels on edges or right of them, as sums with `ROUND_MAGIC`.
#[inline(always)]
fn edge<S: Lanes8>(s: S, lane: impl Lane<S>, edges: &Edges, j: S::F64) -> S::F64 {
    let n = s.mul_add(lane.load_f64(s, &edges.per_row), j, lane.load_f64(s, &edges.n));
    s.mul_add(n, lane.load_f64(s, &edges.inverse), s.splat_f64(ROUND_MAGIC))
}

/// The next row of each of eight triangles.
struct RowCursor8<S: Lanes8> {
    at: S::I32,
    cell: S::I32,
    z: S::I64,
}

impl<S: Lanes8> RowCursor8<S> {
    #[inline(always)]
    fn new(s: S, setup: &TriangleSetup8, has_depths: bool) -> Self {
        let at = s.load_i32(&setup.at);
        Self {
            at,
            cell: if has_depths { s.load_i32(&setup.cell) } else { at },
            z: if has_depths { s.load_i64(&setup.z) } else { s.splat_i64(0) },
        }
    }

    /// Returns row `number`, and advances to the next.
    #[inline(always)]
    fn next<P: Shades8>(
        &mut self,
        s: S,
        setup: &TriangleSetup8,
        shades: &mut P,
        list: &SpanList,
        (number, has_depths): (i32, bool),
    ) -> Spans8<S> {
        part::<S, P, _>(
            s,
            #[inline(always)]
            || self.row(s, setup, shades, list, (number, has_depths)),
        )
    }

    #[inline(always)]
    fn row<P: Shades8>(
        &mut self,
        s: S,
        setup: &TriangleSetup8,
        shades: &mut P,
        list: &SpanList,
        (number, has_depths): (i32, bool),
    ) -> Spans8<S> {
        let lane = EachTriangle;
        let j = s.splat_f64(f64::from(number));
        let number = s.splat_i32(number);
        let ends = RowEnds::of(s, lane, setup, j, number);
        let (left, right) = (s.low_bits(ends.left), s.low_bits(ends.right));
        let is_row = s.is_greater(s.load_i32(&setup.rows), number);
        let mut z = self.z;
        if has_depths {
            z = s.add_i64(z, s.mul_low_i64(s.bits(ends.left), s.load_i64(&setup.z_per_column)));
            self.z = s.add_i64(self.z, s.load_i64(&setup.z_per_row));
        }
        let parts = Parts { row: ends.left, end: ends.right, seed: ends.left, start: ends.left };
        let fill = shades.fill_of(s, lane, setup, &ends, &parts);
        let length = s.select_i32(is_row, s.sub_i32(right, left), s.splat_i32(0));
        let spans = Spans8 { at: s.add_i32(self.at, left), cell: s.add_i32(self.cell, left), length, fill, z };
        self.at = s.add_i32(self.at, s.splat_i32(list.pitch));
        if has_depths {
            self.cell = s.add_i32(self.cell, s.splat_i32(list.width));
        }
        spans
    }
}

/// Returns whether parts of the loop over triangles are called, not inlined: for records in narrow vectors, which would
/// otherwise be spilled, and in plain arrays. Arrays are in memory anyway, so calls cost about 1 % of a frame, while
/// inlining lengthens a build by half or more. Vectors are aligned to their size.
#[inline(always)]
const fn is_apart<S: Lanes8, P: Shades8>() -> bool {
    align_of::<S::F64>() < if P::IS_LINEAR { 16 } else { 32 }
}

/// Returns whether spans have depths: if their list may have them, and there are cells. Linear shades are compiled for
/// either, others decide here.
#[inline(always)]
pub(super) fn has_depths<P: Shades8, const DEPTHS: bool>(list: &SpanList) -> bool {
    DEPTHS && (P::IS_LINEAR || list.has_cells)
}

/// The change of depth of triangle `i`, if spans have depths.
#[inline(always)]
fn depth_steps<S: Lanes8>(setup: &TriangleSetup8, i: usize, has_depths: bool) -> Option<DepthSteps<S>> {
    if has_depths { Some(DepthSteps::All(setup.z_per_column[i % LANES])) } else { None }
}

/// Calls a part of the loop over triangles, out of line or inlined, as the level requires. The condition is constant, so
/// that the call is not compiled for the other levels.
#[inline(always)]
fn part<S: Lanes8, P: Shades8, R>(s: S, part: impl FnOnce() -> R) -> R {
    if const { is_apart::<S, P>() } { s.apart(part) } else { part() }
}

/// Appends spans, out of line or inlined, as the level requires.
#[inline(always)]
fn append<S: Lanes8, P: Shades8>(s: S, list: &mut SpanList, spans: &Spans8<S>, dz: Option<DepthSteps<S>>) {
    part::<S, P, _>(
        s,
        #[inline(always)]
        || list.append(s, spans, dz),
    );
}

/// Lists all rows of eight small triangles of at most [`MAX_SHORT_ROWS`] rows each, triangle by triangle. The list must
/// have room.
#[inline(always)]
pub(super) fn list_short<S: Lanes8, P: Shades8, const DEPTHS: bool>(
    s: S,
    setup: &TriangleSetup8,
    shades: &mut P,
    most_rows: i32,
    list: &mut SpanList,
) {
    let has_depths = has_depths::<P, DEPTHS>(list);
    let mut cursor = RowCursor8::new(s, setup, has_depths);
    let dz = |i: usize| setup.z_per_column[i];
    if most_rows <= 0 {
        return;
    }
    let first = cursor.next(s, setup, shades, list, (0, has_depths));
    if most_rows == 1 {
        let dz = if has_depths { Some(DepthSteps::Each(s.load_i64(&setup.z_per_column))) } else { None };
        append::<S, P>(s, list, &first, dz);
        return;
    }
    let second = cursor.next(s, setup, shades, list, (1, has_depths));
    if most_rows == 2 {
        let [low, high] = first.zip(s, &second, list, has_depths);
        let (mut of_low, mut of_high) = (None, None);
        if has_depths {
            let dz = s.load_i64(&setup.z_per_column);
            let [low, high] = s.interleave_i64(dz, dz);
            (of_low, of_high) = (Some(DepthSteps::Each(low)), Some(DepthSteps::Each(high)));
        }
        append::<S, P>(s, list, &low, of_low);
        append::<S, P>(s, list, &high, of_high);
        return;
    }
    let third = cursor.next(s, setup, shades, list, (2, has_depths));
    let fourth = cursor.next(s, setup, shades, list, (3, has_depths));
    let even = first.zip(s, &third, list, has_depths);
    let odd = second.zip(s, &fourth, list, has_depths);
    for (half, even) in even.iter().enumerate() {
        for (quarter, spans) in even.zip(s, &odd[half], list, has_depths).iter().enumerate() {
            let i = 4 * half + 2 * quarter;
            let dz = if has_depths { Some(DepthSteps::Each(s.halves_i64(dz(i), dz(i + 1)))) } else { None };
            append::<S, P>(s, list, spans, dz);
        }
    }
}

/// Eight rows of a triangle.
struct EightRows<S: Lanes8> {
    ends: RowEnds<S>,
    /// Offsets of their first pixels and cells.
    at: S::I32,
    cell: S::I32,
    length: S::I32,
    /// Depths of their first pixels.
    z: S::I64,
}

impl<S: Lanes8> EightRows<S> {
    /// Rows of triangle `i` from row `first` on. Those beyond its last have no length.
    #[inline(always)]
    fn new(s: S, setup: &TriangleSetup8, (i, first): (usize, i32), list: &SpanList, has_depths: bool) -> Self {
        let lane = OneTriangle(i);
        let number = s.add_i32(s.splat_i32(first), s.load_i32(&NUMBERS));
        let j = s.to_f64(number);
        let ends = RowEnds::of(s, lane, setup, j, number);
        let is_row = s.is_greater(lane.load_i32(s, &setup.rows), number);
        let (left, right) = (s.low_bits(ends.left), s.low_bits(ends.right));
        let at = s.add_i32(lane.load_i32(s, &setup.at), s.mul_i32(number, s.splat_i32(list.pitch)));
        let (mut cell, mut z) = (at, s.splat_i64(0));
        if has_depths {
            cell = s.add_i32(lane.load_i32(s, &setup.cell), s.mul_i32(number, s.splat_i32(list.width)));
            // Not negative: below 2¹².
            z = s.mul_low_i64(s.to_i64(number), lane.load_i64(s, &setup.z_per_row));
            z = s.add_i64(z, lane.load_i64(s, &setup.z));
            z = s.add_i64(z, s.mul_low_i64(s.bits(ends.left), lane.load_i64(s, &setup.z_per_column)));
        }
        let length = s.select_i32(is_row, s.sub_i32(right, left), s.splat_i32(0));
        Self { ends, at: s.add_i32(at, left), cell: s.add_i32(cell, left), length, z }
    }

    /// The whole rows as spans.
    #[inline(always)]
    fn spans<P: Shades8>(&self, s: S, setup: &TriangleSetup8, shades: &mut P, i: usize) -> Spans8<S> {
        let Self { ends, at, cell, length, z } = self;
        let parts = Parts { row: ends.left, end: ends.right, seed: ends.left, start: ends.left };
        let fill = shades.fill_of(s, OneTriangle(i), setup, ends, &parts);
        Spans8 { at: *at, cell: *cell, length: *length, fill, z: *z }
    }
}

/// Lists eight rows of small triangle `i` from row `first` on. The list must have room for eight.
#[inline(always)]
pub(super) fn list_eight_rows<S: Lanes8, P: Shades8, const DEPTHS: bool>(
    s: S,
    setup: &TriangleSetup8,
    shades: &mut P,
    (i, first): (usize, i32),
    list: &mut SpanList,
) {
    let has_depths = has_depths::<P, DEPTHS>(list);
    let spans = EightRows::new(s, setup, (i, first), list, has_depths).spans(s, setup, shades, i);
    list.append(s, &spans, depth_steps(setup, i, has_depths));
}

/// Lists eight rows of triangle `i` from row `first` on, each split into reseeded pieces of up to `longest` pixels.
/// Parts outside `clip`, if there is one, are left out. The list must have room for eight spans per piece.
#[inline(always)]
pub(super) fn list_pieces<S: Lanes8, P: Shades8, const DEPTHS: bool>(
    s: S,
    setup: &TriangleSetup8,
    shades: &mut P,
    (i, first): (usize, i32),
    (pieces, longest): (usize, i32),
    (clip, width): (Option<Rect>, u32),
    list: &mut SpanList,
) {
    let lane = OneTriangle(i);
    let has_depths = has_depths::<P, DEPTHS>(list);
    let rows = EightRows::new(s, setup, (i, first), list, has_depths);
    let ends = &rows.ends;
    let mut is_row = s.is_greater(rows.length, s.splat_i32(0));
    // Columns of the frame relative to the box's first. All are below 4,096.
    let side = |column: u32| s.splat_f64(ROUND_MAGIC + f64::from(column as i32 - setup.column[i % LANES]));
    let (mut left, mut last, mut right) = (ends.left, ends.right, ends.right);
    if let Some(clip) = clip {
        // A row that begins left of the frame is seeded at the frame's side.
        left = s.max(left, side(0));
        last = s.min(last, side(width));
        right = s.min(right, side(clip.x1));
        let number = s.add_i32(s.splat_i32(setup.row[i % LANES] + first), s.load_i32(&NUMBERS));
        is_row = s.and(is_row, s.is_greater(number, s.splat_i32(clip.y0 as i32 - 1)));
        is_row = s.and(is_row, s.is_greater(s.splat_i32(clip.y1 as i32), number));
    }
    let row_origin = left;
    let dz = lane.load_i64(s, &setup.z_per_column);
    // Often all rows are short enough.
    let are_whole = clip.is_none() && s.to_bitmask(s.is_greater(rows.length, s.splat_i32(longest))) == 0;
    for _ in 0..pieces {
        let end = s.add(left, s.splat_f64(longest.into()));
        let spans = if are_whole {
            rows.spans(s, setup, shades, i)
        } else {
            let start = if let Some(clip) = clip { s.max(left, side(clip.x0)) } else { left };
            let parts = Parts { row: row_origin, end: last, seed: left, start };
            let mut fill = shades.fill_of(s, lane, setup, ends, &parts);
            if P::IS_LINEAR && clip.is_some() {
                // A piece that begins left of the rectangle continues from its start.
                fill = advance(s, fill, s.sub_i32(s.low_bits(start), s.low_bits(left)));
            }
            let moved = s.sub_i32(s.low_bits(start), s.low_bits(ends.left));
            let length = s.sub_i32(s.low_bits(s.min(right, end)), s.low_bits(start));
            let length = s.select_i32(is_row, length, s.splat_i32(0));
            let z = if has_depths { s.add_i64(rows.z, s.mul_i64(s.to_i64(moved), dz)) } else { rows.z };
            Spans8 { at: s.add_i32(rows.at, moved), cell: s.add_i32(rows.cell, moved), length, fill, z }
        };
        list.append(s, &spans, depth_steps(setup, i, has_depths));
        left = end;
        if are_whole || s.to_bitmask(s.is_less(left, right)) == 0 {
            break;
        }
    }
}
