//! Convex polygons with any number of vertices, drawn with the Hungarian tutorial's table of rows.
//!
//! ```text
//! for every edge:  for every row that it crosses:   table[row].left or .right = (x, shade)
//! for every row:   from left to right:              shade by shade, linear between the two
//! ```
//!
//! The caller provides the table: one [`TableRow`] for every row of the frame, 200 in mode 13h.
//!
//! Coverage is exact, by the same rule as a triangle's. A crossing's x is rounded up to 1/256 pixel, which never loses
//! a pixel centre, because centres lie on whole units. The row runs from the first centre at or right of the left
//! crossing to the last one left of the right crossing. Polygons and triangles that share edges therefore draw each
//! pixel once.
//!
//! Shades are the Hungarian tutorial's: linear along the edges, then linear between the two crossings of a row. In a
//! triangle that is the plane through its vertices. With more vertices it is not: when the same quad is rotated on the
//! screen, rows cross other pairs of edges and get other shades. That is why the engine splits faces into triangles;
//! this module scans them as it used to be done.
//!
//! # Why no byte leaves the range of the vertices, and nothing divides by zero
//!
//! The Hungarian tutorial divides by the row's width in whole pixels, the Russian textbook by its exact width; either
//! may be 0. Here x0 and x1 are the crossings in 1/256 pixel, both rounded up, and a row is drawn only if there is a
//! centre c with x0 ≤ c and c < the right crossing ≤ x1, so x1 − x0 is at least 1. A crossing's shade lies between the
//! shades of its edge's ends. Start and step along the row are rounded back toward where the shades come from, as in
//! [`shade`](mode13h::internals::raster::reference::shade), so every sum lies between the two crossings' shades.

use std::fmt;
use std::ops::Range;

use mode13h::fixed::{I24F8, U8F8};
use mode13h::internals::raster::fill_rule::first_centre;
use mode13h::internals::raster::reference::quotient::Divisor;
use mode13h::internals::raster::reference::shade::RESEED;
use mode13h::raster::{DrawStats, Frame, Interpolation, Rect, Vertex};
use mode13h::span::Kernel;

/// The crossings of a convex polygon's two edges with a row's centre.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct TableRow {
    /// Left crossing, rounded up to 1/256 pixel.
    pub left_x: I24F8,
    /// Right crossing, rounded up to 1/256 pixel.
    pub right_x: I24F8,
    /// Shade at the left crossing, to the nearest 1/256.
    pub left_shade: U8F8,
    /// Shade at the right crossing, to the nearest 1/256.
    pub right_shade: U8F8,
}

/// Reason why a polygon was not drawn.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PolygonError {
    /// It turns both ways, or goes around more than once, so a row might cross it four times.
    #[error("the polygon is not convex")]
    NotConvex,
    /// The table has too few rows.
    #[error("a table of {given} rows given where {needed} are needed")]
    Table {
        /// Rows given.
        given: usize,
        /// Rows needed: those of the frame.
        needed: usize,
    },
    /// The table interpolates shades in 8.8, linearly along edges and rows; it supports only flat,
    /// [`Gouraud88`](Interpolation::Gouraud88) and [`Gouraud88Reseeded`](Interpolation::Gouraud88Reseeded).
    #[error("a table of rows cannot shade as {0:?}")]
    Interpolation(Interpolation),
}

impl fmt::Debug for PolygonError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// A vertex in 1/256 pixel.
fn point(vertex: &Vertex) -> (i32, i32) {
    (vertex.x().to_bits(), vertex.y().to_bits())
}

/// Winding of a convex polygon on the screen; `None` if it has no area.
///
/// The answer is exact. All turns must go the same way, and the direction must change exactly once from down to up (in
/// the order of (y, x)) and once from up to down; otherwise the polygon goes around more than once. Repeated vertices,
/// and vertices on the line between their neighbours, make no difference.
fn winding(vertices: &[Vertex]) -> Result<Option<Winding>, PolygonError> {
    let Some(last) = vertices.last() else { return Ok(None) };
    let mut turns = [false; 2];
    let (mut changes, mut before): (u32, Option<(i64, i64)>) = (0, None);
    let mut from = point(last);
    // Once around, then again for the first edges, which have no edge before them the first time.
    for (i, vertex) in vertices.iter().chain(vertices).enumerate() {
        let to = point(vertex);
        let edge = (i64::from(to.0 - from.0), i64::from(to.1 - from.1));
        from = to;
        if edge == (0, 0) {
            continue;
        }
        if let Some(before) = before {
            if i >= vertices.len() {
                changes += u32::from(is_down(before) != is_down(edge));
            }
            let turn = before.0 * edge.1 - before.1 * edge.0;
            turns[0] |= turn > 0;
            turns[1] |= turn < 0;
        }
        before = Some(edge);
    }
    match turns {
        [false, false] => Ok(None),
        [true, false] if changes == 2 => Ok(Some(Winding::Clockwise)),
        [false, true] if changes == 2 => Ok(Some(Winding::CounterClockwise)),
        _ => Err(PolygonError::NotConvex),
    }
}

fn is_down(edge: (i64, i64)) -> bool {
    (edge.1, edge.0) > (0, 0)
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Winding {
    /// Clockwise on a screen whose y points down: left edges run up.
    Clockwise,
    CounterClockwise,
}

/// A value that changes by the same fraction every row, stepped with quotient and remainder.
struct Walk {
    value: i64,
    rest: i64,
    step: i64,
    step_rest: i64,
    height: i64,
}

impl Walk {
    /// Walks a value that is `a` at the upper end of an edge `height` units high and `b` at its lower end, starting
    /// `below` units under the upper end. Each step gives the floor of the value with `bias / height` added. All are
    /// within 2²²; `below` and `bias` are less than `height`.
    fn new(a: i32, b: i32, below: i64, height: &Divisor, bias: i64) -> Self {
        let change = i64::from(b) - i64::from(a);
        let (value, rest) = height.div_rem_floor(i64::from(a) * height.get() + change * below + bias);
        let (step, step_rest) = height.div_rem_floor(change * 256);
        Self { value, rest, step, step_rest, height: height.get() }
    }

    fn down(&mut self) {
        self.rest += self.step_rest;
        let carry = i64::from(self.rest >= self.height);
        self.rest -= self.height * carry;
        self.value += self.step + carry;
    }
}

/// Fills in the rows of `clip` that the polygon crosses, edge by edge, and returns them. `table[0]` is the row
/// `first_row`.
fn fill_table(vertices: &[Vertex], winding: Winding, clip: Rect, table: &mut [TableRow], first_row: u32) -> Range<u32> {
    // Rows of a frame are below 4,096.
    let (clip_first, clip_end) = (clip.y0 as i32, clip.y1 as i32);
    let (mut first, mut end) = (i32::MAX, 0);
    let Some(mut from) = vertices.last() else { return 0..0 };
    for to in vertices {
        let is_down = from.y() < to.y();
        let (upper, lower) = if is_down { (from, to) } else { (to, from) };
        from = to;
        let rows = first_centre(upper.y()).max(clip_first)..first_centre(lower.y()).min(clip_end);
        if rows.is_empty() {
            continue;
        }
        (first, end) = (first.min(rows.start), end.max(rows.end));
        let (a, b) = (point(upper), point(lower));
        let height = Divisor::new(i64::from(b.1) - i64::from(a.1));
        let below = i64::from(rows.start) * 256 + 128 - i64::from(a.1);
        let mut x = Walk::new(a.0, b.0, below, &height, height.get() - 1);
        let shades = [upper, lower].map(|v| i32::from(v.shade().to_bits()));
        let mut shade = Walk::new(shades[0], shades[1], below, &height, height.get() / 2);
        let is_right = is_down == (winding == Winding::Clockwise);
        for y in rows {
            if let Some(row) = table.get_mut((y as u32 - first_row) as usize) {
                // Between the ends of the edge, so within the guard band and 0 to 0xFF00.
                let (x, shade) = (I24F8::from_bits(x.value as i32), U8F8::from_bits(shade.value as u16));
                if is_right {
                    (row.right_x, row.right_shade) = (x, shade);
                } else {
                    (row.left_x, row.left_shade) = (x, shade);
                }
            }
            x.down();
            shade.down();
        }
    }
    // Not negative, as `clip_first` is not. Empty if no edge crosses a row.
    first as u32..end as u32
}

/// Draws a convex polygon with the table of rows, inside a rectangle of the frame. Neither the first vertex nor the
/// winding matters; a polygon without area, or with fewer than three vertices, draws nothing.
///
/// `table` needs one row for each of the frame's (200 in mode 13h). Afterwards it holds the polygon's rows, from the
/// first inside the clip rectangle to the last; what it held before does not matter. It has no depth.
///
/// ```
/// use mode13h::fixed::{I24F8, U8F8};
/// use mode13h::raster::{Frame, Interpolation, Vertex};
/// use mode13h_lab::museum::polygon::{TableRow, draw};
///
/// let at = |x, y, shade| Vertex::new(I24F8::from(x), I24F8::from(y), U8F8::from(shade), 0);
/// let quad = [at(0, 0, 10)?, at(4, 0, 90)?, at(4, 2, 90)?, at(0, 2, 10)?];
/// let mut bytes = [0; 4 * 2];
/// let mut frame = Frame::new(&mut bytes, 4, 2, 4)?;
/// let clip = frame.bounds();
/// draw(&mut frame, clip, &quad, Interpolation::Gouraud88, &mut [TableRow::default(); 2])?;
/// assert_eq!(bytes, [20, 40, 60, 80, 20, 40, 60, 80]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A shading that is neither flat nor linear in 8.8, a polygon that is not convex (rounding to 1/256 pixel may have
/// dented it), or a table with too few rows. Nothing is drawn then.
pub fn draw(
    frame: &mut Frame<'_>,
    clip: Rect,
    vertices: &[Vertex],
    interpolation: Interpolation,
    table: &mut [TableRow],
) -> Result<DrawStats, PolygonError> {
    let reseed = match interpolation {
        Interpolation::Flat(_) | Interpolation::Gouraud88 => i32::MAX,
        Interpolation::Gouraud88Reseeded => RESEED,
        other => return Err(PolygonError::Interpolation(other)),
    };
    let held = frame.rows();
    let (given, needed) = (table.len(), held.len());
    if given < needed {
        return Err(PolygonError::Table { given, needed });
    }
    let (clip, kernel) = (clip.intersection(frame.bounds()), Kernel::default());
    let mut drawn = DrawStats::default();
    let Some(winding) = winding(vertices)? else { return Ok(drawn) };
    for y in fill_table(vertices, winding, clip, table, held.start) {
        let Some(edges) = table.get((y - held.start) as usize) else { break };
        // A frame has at most 4,096 columns.
        let width = frame.width() as i32;
        let origin = first_centre(edges.left_x).max(0);
        let (x0, x1) = (origin.max(clip.x0 as i32), first_centre(edges.right_x).min(width).min(clip.x1 as i32));
        let Some(pixels) = frame.row_mut(y) else { break };
        if x0 >= x1 {
            continue;
        }
        drawn.covered += (x1 - x0) as u32;
        drawn.pixels += (x1 - x0) as u32;
        if let Interpolation::Flat(index) = interpolation {
            drawn.spans += 1;
            if let Some(pixels) = pixels.get_mut(x0 as usize..x1 as usize) {
                pixels.fill(index);
            }
            continue;
        }
        let shade = RowShade::new(edges);
        // Where the loop starts, at or left of the first pixel, as in a triangle.
        let mut seed = origin + (x0 - origin) / reseed * reseed;
        let mut x = x0;
        while x < x1 {
            let end = x1.min(seed.saturating_add(reseed));
            // Fewer than 4,096 pixels; the product wraps just as the sum does.
            let start = shade.start(seed).wrapping_add(shade.step.wrapping_mul((x - seed) as u16));
            if let Some(pixels) = pixels.get_mut(x as usize..end as usize) {
                kernel.fill(pixels, start, shade.step);
            }
            drawn.spans += 1;
            seed = end;
            x = end;
        }
    }
    Ok(drawn)
}

/// The shades between the two crossings of a row that has a pixel.
struct RowShade {
    left_x: i64,
    left_shade: i64,
    change: i64,
    width: Divisor,
    step: u16,
}

impl RowShade {
    fn new(edges: &TableRow) -> Self {
        let left_shade = i64::from(edges.left_shade.to_bits());
        let change = i64::from(edges.right_shade.to_bits()) - left_shade;
        let left_x = i64::from(edges.left_x.to_bits());
        // At least 1, and below 2²²: see the module's head.
        let width = Divisor::new(i64::from(edges.right_x.to_bits()) - left_x);
        // In a row of one pixel the step may have any size, and is not used.
        let step = width.truncate(change * 256) as u16;
        Self { left_x, left_shade, change, width, step }
    }

    /// AX at pixel `x` of the row: the Russian textbook's Cs = As + (xc − Ax)·gradient with its missing As restored,
    /// plus half a shade.
    fn start(&self, x: i32) -> u16 {
        let along = self.change * (i64::from(x) * 256 + 128 - self.left_x);
        let rounded = if self.change < 0 { -self.width.floor(-along) } else { self.width.floor(along) };
        // From 0 to 0xFF00, by cover.
        (self.left_shade + rounded + 128) as u16
    }
}
