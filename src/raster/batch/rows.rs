//! The rows of small triangles, eight triangles at a time.
//!
//! Coordinates are taken from the centre of the box's first pixel, so all numbers are small, and f64 holds every
//! numerator exactly. A quotient is a product with the divisor's reciprocal, and its floor is exact by a margin: for a whole
//! n and a whole d
//!
//! ```text
//! floor(n / d) = nearest((n + ½ − d/2) / d)
//! ```
//!
//! where what is rounded lies at least 1/(2d) from the middle between two whole numbers. The reciprocal and the
//! product are each off by at most one part in 2⁵³, which for a quotient below 2¹⁶ is 2⁻³⁶ together; with at most 64 × 64 pixels twice the area is
//! below 2²⁹, so the margin is above 2⁻³⁰. (n + ½ − d/2 is exact: below 2⁵⁰, and a multiple of ½.) The whole number is found by adding 1.5 · 2⁵²,
//! which leaves it in the low bits. So there is no correction, no branch, and the same result on every processor.
//!
//! Left and right are the lesser and the greater of two edges: where the long edge and a short one meet a row, one
//! lies left of the other in exact arithmetic, and rounding up keeps their order.

use super::Batch;
use super::sieve::Kind;
use crate::span::list::Listed;

/// The widest that a small triangle is, in pixels: a span of that many has no start but its first.
pub(super) const MOST_COLUMNS: i32 = 64;
/// The highest.
pub(super) const MOST_ROWS: i32 = 16;
/// Triangles at a time.
const LANES: usize = 8;
/// 1.5 · 2⁵².
const MAGIC: f64 = 6_755_399_441_055_744.0;

/// A list of spans, with room for those of several groups.
pub(super) struct Spans {
    spans: [Listed; Self::ROOM + 1],
    /// The triangle of each.
    triangles: [u8; Self::ROOM + 1],
    count: usize,
    covered: u32,
}

impl Spans {
    const ROOM: usize = 4 * LANES * MOST_ROWS as usize;

    pub(super) fn new() -> Self {
        let none = Listed { at: 0, length: 0, shade: 0, step: 0 };
        Self { spans: [none; Self::ROOM + 1], triangles: [0; Self::ROOM + 1], count: 0, covered: 0 }
    }

    pub(super) fn as_slice(&self) -> &[Listed] {
        &self.spans[..self.count]
    }


    /// Pixels of all spans.
    pub(super) fn covered(&self) -> u32 {
        self.covered
    }

    pub(super) fn clear(&mut self) {
        (self.count, self.covered) = (0, 0);
    }
}

/// Where the frame's pixels lie.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// The row whose pixels come first.
    pub(super) first_row: u32,
    /// At most 2¹⁶.
    pub(super) pitch: u32,
}

type Floats = [f64; LANES];
type Ints = [i32; LANES];

/// An edge: the first pixel on it or right of it in row j is `nearest((n + j·per_row) · inverse)`.
#[derive(Clone, Copy)]
struct Edges {
    n: Floats,
    per_row: Floats,
    inverse: Floats,
}

const NO_EDGES: Edges = Edges { n: [0.0; LANES], per_row: [0.0; LANES], inverse: [0.0; LANES] };

/// Eight triangles.
struct Group {
    /// The offset of the box's first pixel.
    at: Ints,
    rows: Ints,
    long: Edges,
    upper: Edges,
    lower: Edges,
    /// The first row of the lower edge.
    split: Ints,
    /// Shades: `nearest((n + j·per_row + i·per_column) · inverse)`.
    n: Floats,
    per_row: Floats,
    per_column: Floats,
    inverse: Floats,
    step: Ints,
}

/// Lists the rows of as many of the small triangles `kept` as there is room for, and says how many that were.
pub(super) fn rows(batch: &Batch, kept: &[(u8, Kind)], place: Place, spans: &mut Spans) -> usize {
    rows_inlined(batch, kept, place, spans)
}

#[inline(always)]
pub(super) fn rows_inlined(batch: &Batch, kept: &[(u8, Kind)], place: Place, spans: &mut Spans) -> usize {
    let mut listed = 0;
    for group in kept.chunks(LANES) {
        if spans.count + LANES * MOST_ROWS as usize > Spans::ROOM {
            break;
        }
        listed += group.len();
        // Those that a last group lacks are points.
        let (mut x, mut y, mut shade) = ([[0; LANES]; 3], [[0; LANES]; 3], [[0; LANES]; 3]);
        for (lane, &(at, _)) in group.iter().enumerate() {
            let at = usize::from(at) % Batch::CAPACITY;
            for corner in 0..3 {
                x[corner][lane] = batch.x[corner][at];
                y[corner][lane] = batch.y[corner][at];
                shade[corner][lane] = i32::from(batch.shade[corner][at]);
            }
        }
        let set = set_up(&x, &y, &shade, place);
        list(&set, group, place, spans);
    }
    listed
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
fn set_up(x: &[Ints; 3], y: &[Ints; 3], shade: &[Ints; 3], place: Place) -> Group {
    let (mut long, mut upper, mut lower) = (NO_EDGES, NO_EDGES, NO_EDGES);
    let (mut at, mut rows, mut split, mut step) = ([0; LANES], [0; LANES], [0; LANES], [0; LANES]);
    let (mut n, mut per_row) = ([0.0; LANES], [0.0; LANES]);
    let (mut per_column, mut inverse) = ([0.0; LANES], [0.0; LANES]);
    // A column and a row are below 4,096, the pitch is at most 2¹⁶.
    let (pitch, first_row) = (place.pitch as i32, place.first_row as i32);
    for i in 0..LANES {
        let (low_x, low_y) = (x[0][i].min(x[1][i]).min(x[2][i]), y[0][i].min(y[1][i]).min(y[2][i]));
        let high_y = y[0][i].max(y[1][i]).max(y[2][i]);
        let (column, row) = ((low_x + 127) >> 8, (low_y + 127) >> 8);
        at[i] = (row - first_row) * pitch + column;
        // From the first pixel's centre, within ±2¹⁵.
        let (left, top) = (column * 256 + 128, row * 256 + 128);
        let (ax, ay) = (x[0][i] - left, y[0][i] - top);
        let (bx, by) = (x[1][i] - left, y[1][i] - top);
        let (cx, cy) = (x[2][i] - left, y[2][i] - top);

        // Top, middle and bottom, by y and x in one number.
        let (ka, kb, kc) = ((ay << 16) + ax, (by << 16) + bx, (cy << 16) + cx);
        let (low, high) = (ka.min(kb), ka.max(kb));
        let (k0, rest) = (low.min(kc), low.max(kc));
        let (k1, k2) = (rest.min(high), rest.max(high));
        let point = |k: i32| {
            let x = (k << 16) >> 16;
            (x, (k - x) >> 16)
        };
        let (p0, p1, p2) = (point(k0), point(k1), point(k2));
        (long.n[i], long.per_row[i], long.inverse[i]) = edge(p0, p2);
        (upper.n[i], upper.per_row[i], upper.inverse[i]) = edge(p0, p1);
        (lower.n[i], lower.per_row[i], lower.inverse[i]) = edge(p1, p2);
        split[i] = (p1.1 + 255) >> 8;

        // As `Ordered::gradient`, of any order of the corners: the quotients are the same.
        let (dx1, dy1, dx2, dy2) =
            (f64::from(bx - ax), f64::from(by - ay), f64::from(cx - ax), f64::from(cy - ay));
        let s = f64::from(shade[0][i]);
        let (ds1, ds2) = (f64::from(shade[1][i] - shade[0][i]), f64::from(shade[2][i] - shade[0][i]));
        let signed = dx1 * dy2 - dx2 * dy1;
        let sign = if signed < 0.0 { -1.0 } else { 1.0 };
        let area = signed * sign;
        let (gx, gy) = ((ds1 * dy2 - ds2 * dy1) * sign, (ds2 * dx1 - ds1 * dx2) * sign);
        let falls = gx < 0.0;
        inverse[i] = 1.0 / area;
        // As `ShadePlane::start`: the floor, or of falling shades the ceiling, and half a shade.
        let half = area * 0.5 - 0.5;
        n[i] = s * area - gx * f64::from(ax) - gy * f64::from(ay) + area * 128.0 + if falls { half } else { -half };
        per_row[i] = gy * 256.0;
        per_column[i] = gx * 256.0;
        // Toward zero. The wrap is meant, as in `ShadePlane`.
        let magnitude = whole((gx.abs() * 256.0 - half) * inverse[i] + MAGIC);
        step[i] = if falls { magnitude.wrapping_neg() } else { magnitude };
        rows[i] = if area == 0.0 { 0 } else { ((high_y + 127) >> 8) - row };
    }
    Group { at, rows, long, upper, lower, split, n, per_row, per_column, inverse, step }
}

/// The whole number in the low bits of a sum with `MAGIC`.
#[inline(always)]
fn whole(sum: f64) -> i32 {
    // Its lower half; the number is within ±2³¹, or it is meant modulo 2¹⁶.
    sum.to_bits() as i32
}

/// Puts the rows of a group into the list, triangle by triangle.
#[inline(always)]
fn list(set: &Group, group: &[(u8, Kind)], place: Place, spans: &mut Spans) {
    let mut first = [[0_i32; LANES]; MOST_ROWS as usize];
    let mut end = [[0_i32; LANES]; MOST_ROWS as usize];
    let mut shade = [[0_i32; LANES]; MOST_ROWS as usize];
    let most = set.rows.iter().fold(0, |most, &rows| if rows > most { rows } else { most });
    let table = first.iter_mut().zip(&mut end).zip(&mut shade);
    for (row, ((first, end), shade)) in (0..most).zip(table) {
        let j = f64::from(row);
        for i in 0..LANES {
            let at = |edges: &Edges| (edges.n[i] + edges.per_row[i] * j) * edges.inverse[i] + MAGIC;
            let (long, upper, lower) = (at(&set.long), at(&set.upper), at(&set.lower));
            let short = if row < set.split[i] { upper } else { lower };
            let (left, right) = if long < short { (long, short) } else { (short, long) };
            first[i] = whole(left);
            end[i] = whole(right);
            let n = set.n[i] + set.per_row[i] * j + set.per_column[i] * (left - MAGIC);
            shade[i] = whole(n * set.inverse[i] + MAGIC);
        }
    }
    let (mut count, mut covered) = (spans.count, 0);
    for (i, &(triangle, _)) in group.iter().enumerate() {
        let mut at = set.at[i];
        // At most `MOST_ROWS`.
        for j in 0..set.rows[i] as usize % (MOST_ROWS as usize + 1) {
            let (x, length) = (first[j][i], end[j][i] - first[j][i]);
            // All are non-negative; shade and step are meant modulo 2¹⁶.
            spans.spans[count] =
                Listed { at: (at + x) as u32, length: length as u32, shade: shade[j][i] as u16, step: set.step[i] as u16 };
            spans.triangles[count] = triangle;
            count += usize::from(length > 0);
            covered += length as u32;
            at += place.pitch as i32;
        }
    }
    spans.count = count;
    spans.covered += covered;
}
