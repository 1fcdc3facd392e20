//! Triangles as all texts but the Polish lecture print them: the baseline that everything else is measured against.
//!
//! ```text
//! vertices:   X = floor(x + ½), Y = floor(y + ½)          on whole pixels
//! edges:      StepY = (a1 − a0) / (Y1 − Y0)               of x in 16.16, of the shade in 8.8
//! rows:       StepX = (Bs − As) / (Bx − Ax)               of the shade in 8.8; each row its own
//! pixels:     from Ax to the last before Bx: the integer part of As + k·StepX
//! ```
//!
//! Every quotient is truncated toward zero; there is one addition per scan line and edge and one per pixel, and no half
//! is added anywhere. A row is sampled at its upper edge and a pixel at its left one. So vertices are off by up to half
//! a pixel in both directions, edges by as much again, neighbours overlap or leave gaps, shades lag behind from row to
//! row and from pixel to pixel, and each byte is half a shade too dark on average.
//!
//! Mistakes of the sources that would keep it from running are corrected:
//!
//! - The Russian textbook's count, Dx − Cx + 1, is zero or less for a row without pixels, and its loop then overwrites
//!   all of video memory. Here the count is Bx − Ax, and rows without pixels are not drawn.
//! - The Russian textbook divides by Bx − Ax, which may be 0 or close to it. Here both are whole pixels, and the
//!   quotient is computed only if there is a pixel: it is at most 255 shades.
//! - The Hungarian tutorial asks for `sar`, not `shr`: shifting a negative number rounds toward minus infinity, as
//!   truncating x to its pixel does here, left of the frame too; a division (`idiv`) rounds toward zero. So x and the
//!   shade on an edge stay between its ends.
//!
//! Neither coverage nor range is guaranteed. Bytes do stay in the range from min >> 8 to max >> 8 of the vertices,
//! because all quotients are truncated toward zero; the Russian textbook's own fractions of Ax and Bx would lose that.
//! The order of the vertices, clip rectangles and bands make no difference: whether a pixel is drawn, and its byte,
//! depend only on its position and the three vertices.
//!
//! # Where other methods determine the pixels
//!
//! The scan-line method and the stages of `effects` use exact coverage. There a pixel gets the shade that this
//! triangle's nearest row has at its nearest pixel. A triangle without area on whole pixels gives the shade of its top
//! vertex.

use core::ops::Range;

use super::frame::Rect;
use super::reference::cover::{Row, SortedTriangle};

/// A corner on a whole pixel; its shade in 8.8.
#[derive(Clone, Copy)]
struct Corner {
    x: i32,
    y: i32,
    shade: i32,
}

/// An edge at one row.
#[derive(Clone, Copy, Debug)]
struct Edge {
    y: i32,
    /// 16.16, at most 2²⁸.
    x: i32,
    step_x: i32,
    /// 8.8, 0 to 0xFF00.
    shade: i32,
    step_shade: i32,
}

impl Edge {
    /// The edge from `a` down to `b`, at the row of `a`. If it has no rows, its steps are not used.
    #[inline]
    fn new(a: Corner, b: Corner) -> Self {
        let rows = (b.y - a.y).max(1);
        // 4,096 · 2¹⁶ and twice that fit.
        let (x, dx) = (a.x << 16, (b.x - a.x) << 16);
        Self { y: a.y, x, step_x: dx / rows, shade: a.shade, step_shade: (b.shade - a.shade) / rows }
    }

    /// The edge at row `y`: its values after one addition for each row before it.
    #[inline]
    fn at(&self, y: i32) -> Self {
        // A truncated quotient times at most its divisor is at most the dividend.
        let rows = y - self.y;
        Self { y, x: self.x + self.step_x * rows, shade: self.shade + self.step_shade * rows, ..*self }
    }

    /// Steps to the next row.
    #[inline]
    fn down(&mut self) {
        self.y += 1;
        // One step beyond the end at most: below 2³⁰.
        self.x += self.step_x;
        self.shade += self.step_shade;
    }
}

/// A triangle with its vertices on whole pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct VintageTriangle {
    /// The edge from the top to the bottom.
    long: Edge,
    /// The edges from the top to the middle, and from there to the bottom.
    short: [Edge; 2],
    /// The row of the middle, and the one after the last.
    split: i32,
    end: i32,
    /// Twice the area in pixels; positive if the middle vertex lies right of the long edge.
    doubled_area: i32,
}

impl VintageTriangle {
    /// A triangle with these shades, 0 to 0xFF00, at its vertices. The order of the vertices is preserved: a vertex
    /// above another in 1/256 pixel is not below it in pixels.
    #[inline]
    pub(super) fn new(triangle: &SortedTriangle, shades: [i64; 3]) -> Self {
        let corner = |i: usize| {
            // floor(x + ½) of at most 2²⁰ units of 1/256.
            let whole = |units: i32| (units + 128) >> 8;
            let v = &triangle.vertices[i];
            // At most 0xFF00.
            Corner { x: whole(v.x().to_bits()), y: whole(v.y().to_bits()), shade: shades[i] as i32 }
        };
        let (top, middle, bottom) = (corner(0), corner(1), corner(2));
        Self {
            long: Edge::new(top, bottom),
            short: [Edge::new(top, middle), Edge::new(middle, bottom)],
            split: middle.y,
            end: bottom.y,
            // Below 2²⁸.
            doubled_area: (middle.x - top.x) * (bottom.y - top.y) - (bottom.x - top.x) * (middle.y - top.y),
        }
    }

    /// Calls `row` for every row with a pixel inside `clip`, from the top down. `frame_width` is the whole
    /// frame's; `clip` lies inside the frame.
    #[inline(never)]
    pub(super) fn rows(&self, frame_width: u32, clip: Rect, row: &mut dyn FnMut(Row)) {
        // A clip rectangle lies inside a frame of at most 4,096 pixels a side.
        let (clip_x0, clip_x1, width) = (clip.x0 as i32, clip.x1 as i32, frame_width as i32);
        let (first, end) = (self.long.y.max(clip.y0 as i32), self.end.min(clip.y1 as i32));
        if self.doubled_area == 0 || first >= end {
            return;
        }
        let mut long = self.long.at(first);
        for (short, until) in [(&self.short[0], self.split.min(end)), (&self.short[1], end)] {
            if long.y >= until {
                continue;
            }
            let mut short = short.at(long.y);
            while long.y < until {
                let ramp = self.between(&long, &short);
                let (origin, x_end) = (ramp.x0.max(0), ramp.x1.min(width));
                let (x0, x1) = (origin.max(clip_x0), x_end.min(clip_x1));
                if x0 < x1 {
                    row(Row { y: long.y, origin, x0, x1, last: x_end - 1 });
                }
                long.down();
                short.down();
            }
        }
    }

    /// The shades of row `y`, or of the nearest existing row.
    #[inline]
    pub(super) fn ramp(&self, y: i32) -> RowRamp {
        if self.doubled_area == 0 {
            return RowRamp { x0: 0, x1: 0, shade: self.long.shade as u16, step: 0 };
        }
        let y = y.clamp(self.long.y, self.end - 1);
        self.between(&self.long.at(y), &self.short[usize::from(y >= self.split)].at(y))
    }

    #[inline]
    fn between(&self, long: &Edge, short: &Edge) -> RowRamp {
        let (left, right) = if self.doubled_area > 0 { (long, short) } else { (short, long) };
        // `sar`: toward minus infinity.
        let (x0, x1) = (left.x >> 16, right.x >> 16);
        let step = if x0 < x1 { (right.shade - left.shade) / (x1 - x0) } else { 0 };
        // A shade is 0 to 0xFF00; a step is stored modulo 2¹⁶, as in BX.
        RowRamp { x0, x1, shade: left.shade as u16, step: step as u16 }
    }
}

/// The shades of a row.
#[derive(Clone, Copy, Debug)]
pub(super) struct RowRamp {
    /// Ax: the first pixel.
    pub(super) x0: i32,
    /// Bx: the one after the last; if it is not after `x0` there are no pixels, and the step is 0.
    pub(super) x1: i32,
    /// AX at the first pixel.
    pub(super) shade: u16,
    /// BX.
    pub(super) step: u16,
}

impl RowRamp {
    /// Calls `span` with the columns, the first shade and the step of each span within `columns`: the row's pixels, and
    /// those before and after, which get the shade of the nearest.
    #[inline]
    pub(super) fn spans(&self, columns: Range<i32>, mut span: impl FnMut(Range<usize>, u16, u16)) {
        // Few columns: the product is modulo 2¹⁶.
        let at = |x: i32| self.shade.wrapping_add(self.step.wrapping_mul((x - self.x0) as u16));
        let from = self.x0.clamp(columns.start, columns.end);
        let to = self.x1.clamp(from, columns.end);
        // Columns of a frame.
        let mut piece = |x0: i32, x1: i32, shade: u16, step: u16| {
            if x0 < x1 {
                span(x0 as usize..x1 as usize, shade, step);
            }
        };
        piece(columns.start, from, self.shade, 0);
        piece(from, to, at(from), self.step);
        piece(to, columns.end, at(self.x1 - 1), 0);
    }
}
