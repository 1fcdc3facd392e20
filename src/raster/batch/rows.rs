//! The rows of small triangles, eight triangles at a time, and of larger ones, eight rows at a time.
//!
//! Coordinates are taken from the centre of the box's first pixel, so all numbers are small, and f64 holds every
//! numerator exactly. A quotient is a product with the divisor's reciprocal, and its floor is exact by a margin:
//! for a whole n and a whole d
//!
//! ```text
//! floor(n / d) = nearest((n + ½ − d/2) / d)
//! ```
//!
//! where what is rounded lies at least 1/(2d) from the middle between two whole numbers. The reciprocal and the
//! product are each off by at most one part in 2⁵³: for a shade, below 2¹⁶, by 2⁻³⁶ together. A box of at most
//! 2¹⁸ pixels has 2³⁴ square units, and twice the area is no more, so the margin is at least 2⁻³⁵. A column is below 2¹⁰,
//! its divisor at most 2²⁸: margin 2⁻²⁹, off by 2⁻⁴². (n + ½ − d/2 is exact: a multiple of ½ below 2⁵². A gradient's
//! numerator is below 2¹⁶ times the box's height or width, so each of the terms of n, and n at any pixel of the
//! triangle, is below 2⁵⁰; and no more than three are ever in a sum.) A step has any size, but below 2⁴⁴ / d, so it is
//! off by less than 2⁻⁸ / d. The whole number is found by adding 1.5 · 2⁵², which
//! leaves it in the low bits. So there is no correction, no branch, and the same result on every processor.
//!
//! Left and right are the lesser and the greater of two edges: where the long edge and a short one meet a row, one
//! lies left of the other in exact arithmetic, and rounding up keeps their order.

use super::Batch;
use super::depths::{Planes, Walk};
use super::sieve::Chosen;
use crate::fixed::HAS_F64;
use crate::raster::depth::DepthPlane;
use crate::raster::interpolation::Interpolation;
use crate::raster::shade::RESEED;
use crate::span::list::{Depths, Listed};

/// The widest that a small triangle is, in pixels: a span of that many has no start but its first.
pub(super) const MAX_COLUMNS: i32 = 64;
/// The highest.
pub(super) const MAX_ROWS: i32 = 16;
/// The widest that a large triangle's box is, in 1/256 pixel, and the highest.
pub(super) const MAX_ACROSS: i32 = 1_024 * 256;
pub(super) const MAX_DOWN: i32 = 4_096 * 256;
/// The most squares of four pixels a side that the box has, sides rounded up: 2³⁴ units.
pub(super) const MAX_AREA_4X4: i32 = 1 << 14;
/// Pieces of a row, each of which starts anew.
pub(super) const MAX_PIECES: usize = MAX_ACROSS as usize / 256 / RESEED as usize;
/// Triangles at a time, or rows of one.
pub(super) const LANES: usize = 8;
/// 1.5 · 2⁵².
pub(super) const MAGIC: f64 = 6_755_399_441_055_744.0;

/// Room for the spans of a group, and for eight rows of a large triangle. All is cleared for every batch: more room
/// costs more than it saves.
const CAPACITY: usize = LANES * MAX_ROWS as usize + 32;
const _: () = assert!(LANES * MAX_PIECES <= CAPACITY);

/// Room for the depths of as many spans.
pub(super) const DEPTHS: [Depths; CAPACITY + 1] = [Depths { at: 0, z: 0, dz: 0 }; CAPACITY + 1];

/// A list of spans, and the numbers on the way there. Filled in place: a
/// copy of a group would cost as much as its rows.
pub(super) struct Spans<'a> {
    spans: [Listed; CAPACITY + 1],
    count: usize,
    covered: u32,
    /// The depths of the spans, if there is a depth buffer; otherwise it has no room for any.
    depths: &'a mut [Depths],
    pub(super) group: Group,
    table: [Row; MAX_ROWS as usize],
}

impl<'a> Spans<'a> {
    pub(super) fn new(depths: &'a mut [Depths]) -> Self {
        Self {
            spans: [Listed { at: 0, length: 0, shade: 0, step: 0 }; CAPACITY + 1],
            count: 0,
            covered: 0,
            depths,
            group: Group::NONE,
            table: [const { Row { at: [0; LANES], length: [0; LANES], paint: [0; LANES] } }; MAX_ROWS as usize],
        }
    }

    pub(super) fn as_slice(&self) -> &[Listed] {
        &self.spans[..self.count]
    }

    /// The depths of the spans, one for each if there is a depth buffer, otherwise none.
    pub(super) fn depths(&self) -> &[Depths] {
        self.depths.get(..self.count).unwrap_or_default()
    }

    /// Pixels of all spans.
    pub(super) fn covered(&self) -> u32 {
        self.covered
    }

    pub(super) fn clear(&mut self) {
        (self.count, self.covered) = (0, 0);
    }
}

/// Place of the frame's pixels.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// The row whose pixels come first.
    pub(super) first_row: u32,
    /// At most 2¹⁶.
    pub(super) pitch: u32,
    /// Columns, if there is a depth buffer.
    pub(super) depth_width: Option<u32>,
}

pub(super) type Floats = [f64; LANES];
pub(super) type Ints = [i32; LANES];

/// An edge: the first pixel on it or right of it in row j is `nearest((n + j·per_row) · inverse)`.
#[derive(Clone, Copy)]
pub(super) struct Edges {
    pub(super) n: Floats,
    pub(super) per_row: Floats,
    pub(super) inverse: Floats,
}

const NO_EDGES: Edges = Edges { n: [0.0; LANES], per_row: [0.0; LANES], inverse: [0.0; LANES] };

/// Eight triangles.
pub(super) struct Group {
    /// The box's first pixel, and its offset.
    pub(super) column: Ints,
    pub(super) row: Ints,
    pub(super) at: Ints,
    pub(super) rows: Ints,
    pub(super) long: Edges,
    pub(super) upper: Edges,
    pub(super) lower: Edges,
    /// The first row of the lower edge.
    pub(super) split: Ints,
    /// Shades: `nearest((n + j·per_row + i·per_column) · inverse)`.
    pub(super) n: Floats,
    pub(super) per_row: Floats,
    pub(super) per_column: Floats,
    pub(super) inverse: Floats,
    /// In the upper half.
    pub(super) step: Ints,
}

impl Group {
    pub(super) const NONE: Self = Self {
        column: [0; LANES],
        row: [0; LANES],
        at: [0; LANES],
        rows: [0; LANES],
        long: NO_EDGES,
        upper: NO_EDGES,
        lower: NO_EDGES,
        split: [0; LANES],
        n: [0.0; LANES],
        per_row: [0.0; LANES],
        per_column: [0.0; LANES],
        inverse: [0.0; LANES],
        step: [0; LANES],
    };

    /// The depths of spans of a triangle, which hold the numbers of their rows.
    #[inline(always)]
    fn depths(
        &self,
        triangle: usize,
        plane: &DepthPlane,
        place: Place,
        width: u32,
        spans: &[Listed],
        depths: &mut [Depths],
    ) {
        let (column, row, corner) = (self.column[triangle], self.row[triangle], self.at[triangle]);
        for (span, depths) in spans.iter().zip(depths) {
            // Offsets of a frame's pixels are below 2²⁸; columns and rows are below 4,096.
            let j = depths.at as i32;
            let (x, y) = (column + span.at as i32 - corner - j * place.pitch as i32, row + j);
            let at = ((y - place.first_row as i32) * width as i32 + x) as u32;
            *depths = Depths { at, z: plane.fixed_at(x, y), dz: plane.step() };
        }
    }
}

/// A row of each of eight triangles, counted from each one's first.
pub(super) struct Row {
    /// The offset of the first pixel.
    pub(super) at: Ints,
    pub(super) length: Ints,
    /// The shade, and above it the step.
    pub(super) paint: Ints,
}

/// Lists the rows of as many of the small triangles `kept` as there is room for, and says how many that were.
pub(super) fn rows(batch: &Batch, kept: &[Chosen], place: Place, spans: &mut Spans<'_>) -> usize {
    // Nobody comes here then, and a chip's program must not hold what follows.
    if !HAS_F64 {
        return kept.len();
    }
    rows_by(batch, kept, place, spans, set_up::<false>, row, Planes::of)
}

#[inline(always)]
pub(super) fn rows_by(
    batch: &Batch,
    kept: &[Chosen],
    place: Place,
    spans: &mut Spans<'_>,
    set_up: impl Fn(&Gathered, Place, &mut Group),
    row: impl Fn(&Group, i32, i32, &mut Row),
    planes: impl Fn(&Gathered, &Group) -> Planes,
) -> usize {
    let mut listed = 0;
    let mut gathered = Gathered::of(batch, kept, place);
    for group in kept.chunks(LANES) {
        if spans.count + LANES * MAX_ROWS as usize > CAPACITY {
            break;
        }
        listed += group.len();
        set_up(&gathered, place, &mut spans.group);
        let planes = place.depth_width.map(|width| (width, planes(&gathered, &spans.group)));
        // The next before this one's rows enter the list: vectors that are read just after their numbers were stored
        // one by one wait for these. (3 to 6 % of the time of triangles of 0.6 pixels; with up to four rows less
        // elsewhere.)
        gathered.gather(batch, &kept[listed.min(kept.len())..], place);
        list(group.len(), place, spans, planes.as_ref(), &row);
    }
    listed
}

/// Corners of eight triangles.
pub(super) struct Gathered {
    pub(super) x: [Ints; 3],
    pub(super) y: [Ints; 3],
    pub(super) shade: [Ints; 3],
    /// Depths, if there is a depth buffer.
    pub(super) depth: [[u32; LANES]; 3],
}

impl Gathered {
    #[inline(always)]
    pub(super) fn of(batch: &Batch, triangles: &[Chosen], place: Place) -> Self {
        let mut gathered =
            Self { x: [[0; LANES]; 3], y: [[0; LANES]; 3], shade: [[0; LANES]; 3], depth: [[0; LANES]; 3] };
        gathered.gather(batch, triangles, place);
        gathered
    }

    /// The first eight. Where there are less the last place's are others.
    #[inline(always)]
    pub(super) fn gather(&mut self, batch: &Batch, triangles: &[Chosen], place: Place) {
        // Faces that were culled before are mostly all kept.
        if let Some([first, .., last]) = triangles.first_chunk::<LANES>()
            && last.number() == first.number() + LANES - 1
        {
            let first = first.number().min(Batch::CAPACITY - LANES);
            let eight = first..first + LANES;
            for corner in 0..3 {
                self.x[corner].copy_from_slice(&batch.x[corner][eight.clone()]);
                self.y[corner].copy_from_slice(&batch.y[corner][eight.clone()]);
                for (to, &shade) in self.shade[corner].iter_mut().zip(&batch.shade[corner][eight.clone()]) {
                    *to = i32::from(shade);
                }
                if place.depth_width.is_some() {
                    self.depth[corner].copy_from_slice(&batch.depth[corner][eight.clone()]);
                }
            }
            return;
        }
        for (lane, triangle) in triangles.iter().take(LANES).enumerate() {
            let at = triangle.number();
            for corner in 0..3 {
                self.x[corner][lane] = batch.x[corner][at];
                self.y[corner][lane] = batch.y[corner][at];
                self.shade[corner][lane] = i32::from(batch.shade[corner][at]);
            }
        }
        if place.depth_width.is_some() {
            for (lane, triangle) in triangles.iter().take(LANES).enumerate() {
                for corner in 0..3 {
                    self.depth[corner][lane] = batch.depth[corner][triangle.number()];
                }
            }
        }
    }
}

/// The edge from `a` down to `b`.
#[inline(always)]
fn edge((ax, ay): (i32, i32), (bx, by): (i32, i32)) -> (f64, f64, f64) {
    let (x, y) = (f64::from(ax), f64::from(ay));
    let (dx, dy) = (f64::from(bx - ax), f64::from(by - ay));
    // x = (ax·dy + dx·(256·j − ay)) / (256·dy), rounded up: the floor of one unit less, plus one.
    // Along a row, where dy is 0, what comes out is not used.
    (x * dy - dx * y + (128.0 * dy - 0.5), 256.0 * dx, 1.0 / (256.0 * dy))
}

/// Edges and shades.
#[inline(always)]
pub(super) fn set_up<const TALL: bool>(gathered: &Gathered, place: Place, group: &mut Group) {
    let Gathered { x, y, shade, .. } = gathered;
    let Group {
        column: left_columns,
        row: top_rows,
        at,
        rows,
        long,
        upper,
        lower,
        split,
        n,
        per_row,
        per_column,
        inverse,
        step,
    } = group;
    // A column and a row are below 4,096, the pitch is at most 2¹⁶.
    let (pitch, first_row) = (place.pitch as i32, place.first_row as i32);
    for i in 0..LANES {
        let (low_x, low_y) = (x[0][i].min(x[1][i]).min(x[2][i]), y[0][i].min(y[1][i]).min(y[2][i]));
        let high_y = y[0][i].max(y[1][i]).max(y[2][i]);
        let (column, row) = ((low_x + 127) >> 8, (low_y + 127) >> 8);
        (left_columns[i], top_rows[i]) = (column, row);
        at[i] = (row - first_row) * pitch + column;
        // From the first pixel's centre, within ±2²⁰.
        let (left, top) = (column * 256 + 128, row * 256 + 128);
        let (ax, ay) = (x[0][i] - left, y[0][i] - top);
        let (bx, by) = (x[1][i] - left, y[1][i] - top);
        let (cx, cy) = (x[2][i] - left, y[2][i] - top);

        // Top, middle and bottom. Which of two at the same height comes first is of no matter here.
        let (p0, p1, p2) = if TALL {
            let order = |p: (i32, i32), q: (i32, i32)| if q.1 < p.1 { (q, p) } else { (p, q) };
            let (p0, p1) = order((ax, ay), (bx, by));
            let (p1, p2) = order(p1, (cx, cy));
            let (p0, p1) = order(p0, p1);
            (p0, p1, p2)
        } else {
            // Both coordinates, within ±2¹⁵, in one number: half as many operations.
            let (a, b, c) = ((ay << 16) + ax, (by << 16) + bx, (cy << 16) + cx);
            let (low, high) = (a.min(b), a.max(b));
            let (first, rest) = (low.min(c), low.max(c));
            let point = |both: i32| {
                let x = (both << 16) >> 16;
                (x, (both - x) >> 16)
            };
            (point(first), point(rest.min(high)), point(rest.max(high)))
        };
        (long.n[i], long.per_row[i], long.inverse[i]) = edge(p0, p2);
        (upper.n[i], upper.per_row[i], upper.inverse[i]) = edge(p0, p1);
        (lower.n[i], lower.per_row[i], lower.inverse[i]) = edge(p1, p2);
        split[i] = (p1.1 + 255) >> 8;

        // `SortedTriangle::gradient` with the corners in any order: the quotients are the same.
        let (dx1, dy1, dx2, dy2) = (f64::from(bx - ax), f64::from(by - ay), f64::from(cx - ax), f64::from(cy - ay));
        let s = f64::from(shade[0][i]);
        let (ds1, ds2) = (f64::from(shade[1][i] - shade[0][i]), f64::from(shade[2][i] - shade[0][i]));
        let signed = dx1 * dy2 - dx2 * dy1;
        let sign = if signed < 0.0 { -1.0 } else { 1.0 };
        let area = signed * sign;
        let (gx, gy) = ((ds1 * dy2 - ds2 * dy1) * sign, (ds2 * dx1 - ds1 * dx2) * sign);
        let falls = gx < 0.0;
        inverse[i] = 1.0 / area;
        // `ShadePlane::start`: the floor, or the ceiling of falling shades, and half a shade.
        let half = area * 0.5 - 0.5;
        n[i] = s * area - gx * f64::from(ax) - gy * f64::from(ay) + area * 128.0 + if falls { half } else { -half };
        per_row[i] = gy * 256.0;
        per_column[i] = gx * 256.0;
        // Toward zero. The wrap is meant, as in `ShadePlane`.
        let magnitude = whole((gx.abs() * 256.0 - half) * inverse[i] + MAGIC);
        step[i] = (if falls { magnitude.wrapping_neg() } else { magnitude }) << 16;
        rows[i] = if area == 0.0 { 0 } else { ((high_y + 127) >> 8) - row };
    }
}

/// The whole number in the low bits of a sum with `MAGIC`.
#[inline(always)]
fn whole(sum: f64) -> i32 {
    // Its lower half; the number is within ±2³¹, or it is meant modulo 2¹⁶.
    sum.to_bits() as i32
}

/// Row number `row` of every triangle of a group.
#[inline(always)]
fn row(group: &Group, row: i32, pitch: i32, to: &mut Row) {
    let j = f64::from(row);
    for i in 0..LANES {
        let at = |edges: &Edges| (edges.n[i] + edges.per_row[i] * j) * edges.inverse[i] + MAGIC;
        let (long, upper, lower) = (at(&group.long), at(&group.upper), at(&group.lower));
        let short = if row < group.split[i] { upper } else { lower };
        let (left, right) = if long < short { (long, short) } else { (short, long) };
        let (first, end) = (whole(left), whole(right));
        let n = group.n[i] + group.per_row[i] * j + group.per_column[i] * (left - MAGIC);
        let shade = whole(n * group.inverse[i] + MAGIC);
        // Beyond the last row anything may come out.
        to.at[i] = (group.at[i] + row * pitch).wrapping_add(first);
        to.length[i] = if row < group.rows[i] { end - first } else { 0 };
        to.paint[i] = (shade & 0xFFFF) | group.step[i];
    }
}

/// Puts the rows of a group, which is of so many triangles, into the list, triangle by triangle.
#[inline(always)]
fn list(
    triangles: usize,
    place: Place,
    spans: &mut Spans<'_>,
    planes: Option<&(u32, Planes)>,
    row: impl Fn(&Group, i32, i32, &mut Row),
) {
    let Spans { spans, count, covered, depths, group, table } = spans;
    let most = group.rows[..triangles.min(LANES)].iter().fold(0, |most, &rows| if rows > most { rows } else { most });
    for (number, to) in (0..most).zip(table.iter_mut()) {
        row(group, number, place.pitch as i32, to);
    }
    let group = &*group;
    let walk = |i: usize| planes.map(|(width, planes)| planes.walk(i, group, place, *width));
    if most <= FEW_ROWS {
        let lanes = triangles.min(LANES);
        let (to, covered) = (&mut *spans, &mut *covered);
        match most {
            0 => {}
            1 => list_rows::<1>(table, lanes, to, count, covered, depths, walk),
            _ => list_rows::<2>(table, lanes, to, count, covered, depths, walk),
        }
        return;
    }
    let mut pixels = 0;
    for i in 0..triangles.min(LANES) {
        let rows = group.rows[i];
        let mut walk = walk(i);
        // Two at a time, one that there is not with no length: the end of a loop over rows is not foreseen. (Of 2.7
        // pixels 22 ns a triangle where row by row is 24, and four at a time 22; of 0.6 16, 16 and 17.)
        let mut j = 0;
        for two in table.as_chunks::<2>().0 {
            if j >= rows {
                break;
            }
            for row in two {
                let length = if j < rows { row.length[i] } else { 0 };
                let paint = row.paint[i] as u32;
                // Both are non-negative; shade and step are halves.
                spans[*count] = Listed {
                    at: row.at[i] as u32,
                    length: length as u32,
                    shade: paint as u16,
                    step: (paint >> 16) as u16,
                };
                if let Some(walk) = &mut walk {
                    // A row without length may have any depths, which are written over.
                    depths[*count] = walk.at(row.at[i]);
                    walk.down();
                }
                *count += usize::from(length > 0);
                pixels += length as u32;
                j += 1;
            }
        }
    }
    *covered += pixels;
}

/// Most rows of a group for which all its triangles' rows are put into the span list, as many of each.
const FEW_ROWS: i32 = 2;

/// Lists as many rows of each triangle of a group. Those that it lacks have no length: how many it has is not foreseen.
/// (3 to 6 % of the time of triangles of 0.6 pixels; with up to four rows less elsewhere.)
#[inline(always)]
fn list_rows<const ROWS: usize>(
    table: &[Row; MAX_ROWS as usize],
    lanes: usize,
    spans: &mut [Listed; CAPACITY + 1],
    count: &mut usize,
    covered: &mut u32,
    depths: &mut [Depths],
    walk: impl Fn(usize) -> Option<Walk>,
) {
    let (mut at, mut pixels) = (*count, *covered);
    for i in 0..lanes {
        let mut walk = walk(i);
        for row in &table[..ROWS] {
            let (length, paint) = (row.length[i] as u32, row.paint[i] as u32);
            // As below.
            spans[at] = Listed { at: row.at[i] as u32, length, shade: paint as u16, step: (paint >> 16) as u16 };
            if let Some(walk) = &mut walk {
                depths[at] = walk.at(row.at[i]);
                walk.down();
            }
            at += usize::from(length > 0);
            pixels += length;
        }
    }
    (*count, *covered) = (at, pixels);
}

/// Eight rows of one triangle.
pub(super) struct Lines {
    /// The offset of the first pixel, see `Row`.
    pub(super) at: Ints,
    pub(super) length: Ints,
    /// The shade of each piece of the rows, and above it the step.
    pub(super) paint: [Ints; MAX_PIECES],
}

impl Lines {
    pub(super) const NONE: Self = Self { at: [0; LANES], length: [0; LANES], paint: [[0; LANES]; MAX_PIECES] };
}

/// Draws the spans of the list.
pub(super) type Draw<'a> = &'a mut dyn FnMut(&Spans<'_>);

/// Draws large triangles: one after the other, eight rows at a time, through `draw`, which takes the span list.
pub(super) fn tall(batch: &Batch, kept: &[Chosen], place: Place, spans: &mut Spans<'_>, draw: Draw<'_>) {
    // As for `rows`.
    if !HAS_F64 {
        return;
    }
    tall_by(batch, kept, place, spans, draw, lines);
}

#[inline(always)]
pub(super) fn tall_by(
    batch: &Batch,
    kept: &[Chosen],
    place: Place,
    spans: &mut Spans<'_>,
    draw: Draw<'_>,
    lines: impl Fn(&Group, usize, i32, i32, &mut Ints, &mut Ints, &mut [Ints]),
) {
    let mut found = Lines::NONE;
    for eight in kept.chunks(LANES) {
        set_up::<true>(&Gathered::of(batch, eight, place), place, &mut spans.group);
        for (i, triangle) in eight.iter().enumerate() {
            let number = triangle.number();
            // A triangle without area has no spans and no plane.
            let mut plane = None;
            // A row that does not start anew is one piece, however long.
            let longest = match batch.interpolation[number] {
                Interpolation::GouraudReseeded => RESEED as u32,
                _ => MAX_ACROSS as u32,
            };
            let pieces = batch.pieces(number);
            for first in (0..spans.group.rows[i]).step_by(LANES) {
                if spans.count + LANES * pieces > CAPACITY {
                    draw(spans);
                    spans.clear();
                }
                let Spans { spans: list, depths, count, covered, group, .. } = &mut *spans;
                lines(
                    group,
                    i,
                    first,
                    place.pitch as i32,
                    &mut found.at,
                    &mut found.length,
                    &mut found.paint[..pieces],
                );
                let (before, mut end) = (*count, *count);
                for j in 0..LANES.min((group.rows[i] - first) as usize) {
                    // All are non-negative, and a length is at most 1,024.
                    let (mut at, mut left) = (found.at[j] as u32, found.length[j] as u32);
                    *covered += left;
                    for paint in &found.paint[..pieces] {
                        if left == 0 {
                            break;
                        }
                        let (length, paint) = (left.min(longest), paint[j] as u32);
                        list[end] = Listed { at, length, shade: paint as u16, step: (paint >> 16) as u16 };
                        if let Some(depths) = depths.get_mut(end) {
                            depths.at = first as u32 + j as u32;
                        }
                        end += 1;
                        (at, left) = (at + length, left - length);
                    }
                }
                *count = end;
                if let Some(width) = place.depth_width.filter(|_| end > before) {
                    let plane = plane.get_or_insert_with(|| batch.depth_plane(number));
                    group.depths(i, plane, place, width, &list[before..end], &mut depths[before..end]);
                }
            }
        }
    }
    draw(spans);
    spans.clear();
}

/// Eight rows of triangle `i` of a group, from number `first` on.
#[inline(always)]
fn lines(group: &Group, i: usize, first: i32, pitch: i32, to_at: &mut Ints, length: &mut Ints, paints: &mut [Ints]) {
    let mut starts = [0.0; LANES];
    for lane in 0..LANES {
        // Below 8.
        let row = first + lane as i32;
        let j = f64::from(row);
        let at = |edges: &Edges| (edges.n[i] + edges.per_row[i] * j) * edges.inverse[i] + MAGIC;
        let (long, upper, lower) = (at(&group.long), at(&group.upper), at(&group.lower));
        let short = if row < group.split[i] { upper } else { lower };
        let (left, right) = if long < short { (long, short) } else { (short, long) };
        let (first, end) = (whole(left), whole(right));
        // Beyond the last row anything may come out.
        to_at[lane] = (group.at[i] + row * pitch).wrapping_add(first);
        length[lane] = end.wrapping_sub(first);
        starts[lane] = group.n[i] + group.per_row[i] * j + group.per_column[i] * (left - MAGIC);
    }
    for (piece, paint) in (0_i32..).zip(paints) {
        let along = group.per_column[i] * f64::from(piece * RESEED);
        for (paint, start) in paint.iter_mut().zip(&starts) {
            *paint = (whole((start + along) * group.inverse[i] + MAGIC) & 0xFFFF) | group.step[i];
        }
    }
}
