//! Shades over a triangle: exact at the start of a span, in range all along it.
//!
//! Gouraud's interpolation is linear in x and y (all five texts print it edge by edge; the garbled fractions of the
//! Russian textbook are the quotients of the Polish lecture). It is a plane through the first vertex, with the doubled
//! area A as the common denominator:
//!
//! ```text
//! I(x, y) = N(x, y) / A,   N(x, y) = I0·A + gx·(x − x0) + gy·(y − y0)
//! gx = (I1 − I0)·(y2 − y0) − (I2 − I0)·(y1 − y0)
//! gy = (I2 − I0)·(x1 − x0) − (I1 − I0)·(x2 − x0)
//! ```
//!
//! with A made positive. The Russian textbook prints the start of a span as `Cs = (1 − frac(Ax))·Gradient`, without the
//! As to which it is added, and off by a whole pixel when Ax is whole. Here there is no offset from an edge at all: the
//! plane is evaluated at the first pixel's centre. The textbook's gradient `(Bs − As) / (Bx − Ax)` of a single row is
//! unbounded for short rows, and divides by zero at width 0; here one step serves the whole triangle.
//!
//! # Why no byte leaves the range of the vertices
//!
//! The step is dI/dx rounded **toward zero** to 8.8. The start is the exact value at its pixel's centre, rounded
//! **down** where shades rise to the right and **up** where they fall: back toward where they come from. Say they rise.
//! After k pixels the sum is at least the start, which is at least min (a floor of something not below the integer
//! min), and at most the exact value there, which is at most max: the step is no more than dI/dx, the start no more
//! than the exact start. Where shades fall the same holds with the signs exchanged. So every sum lies in [min, max] as
//! long as the pixel's centre lies in the triangle, which exact coverage guarantees. Half a shade added to the start
//! makes the byte the nearest shade; max ≤ 0xFF00 keeps it from wrapping.
//!
//! A span of two pixels or more has |dI/dx| ≤ 255, so its step fits in 16 bits modulo 2¹⁶; a span
//! of one pixel never uses the step, which may then be any size: a sliver's step wraps unused.
//!
//! # How far a byte is from exact
//!
//! The start is less than 1/256 of a shade off, and each step adds less than 1/256: after k steps the sum is off by
//! less than (k + 1)/256, 1.25 shades over a row of 320. Reseeding every [`RESEED`] pixels keeps that under a quarter,
//! and the byte, which is the nearest, within three quarters of a shade of exact.

use super::cover::SortedTriangle;
use super::quotient::Divisor;
use crate::span::PIECE;

/// Pixels between two exact starts of a reseeded span.
pub const RESEED: i32 = PIECE as i32;

/// The shade plane of a triangle.
#[derive(Clone, Copy, Debug)]
pub struct ShadePlane {
    /// The doubled area A.
    pub(in crate::raster) area: Divisor,
    /// N at the centre of pixel (0, 0).
    origin: i64,
    /// Change of N from one pixel to the next: within 2⁴⁶.
    pub(in crate::raster) per_column: i64,
    /// Change of N from one row to the next.
    per_row: i64,
    step: u16,
}

impl ShadePlane {
    /// The plane of a triangle that is not degenerate.
    #[must_use]
    #[inline]
    pub fn new(triangle: &SortedTriangle) -> Self {
        Self::of_values(triangle, triangle.shades())
    }

    /// The plane of any three values of 0 to 0xFF00 at the corners of a triangle that is not degenerate,
    /// in the order of its vertices.
    #[must_use]
    #[inline]
    pub fn of_values(triangle: &SortedTriangle, shades: [i64; 3]) -> Self {
        // At most 2³⁸ both.
        let (gx, gy) = triangle.gradient(shades);
        let first = &triangle.vertices[0];
        let (x0, y0) = (i64::from(first.x().to_bits()), i64::from(first.y().to_bits()));
        let area = triangle.area();
        // At most 2¹⁶ · 2⁴² + 2 · 2³⁸ · (2²⁰ + 128) < 2⁶⁰.
        let origin = shades[0] * area + gx * (128 - x0) + gy * (128 - y0);
        let area = Divisor::new(area);
        Self {
            area,
            origin,
            per_column: gx * 256,
            per_row: gy * 256,
            // Wrapping is intended: see the module's documentation.
            step: area.truncate(gx * 256) as u16,
        }
    }

    /// BX: the step that the span loop adds per pixel, in 1/256 shade modulo 2¹⁶.
    #[must_use]
    #[inline]
    pub fn step(&self) -> u16 {
        self.step
    }

    /// AX at the pixel (`x`, `y`), whose centre lies in the triangle: the exact shade there in 1/256, rounded down
    /// where shades rise and up where they fall, plus half a shade.
    #[must_use]
    #[inline]
    pub fn start(&self, x: i32, y: i32) -> u16 {
        // Falling shades: the ceiling is the floor of N + A − 1.
        let bias = if self.per_column < 0 { self.area.get() - 1 } else { 0 };
        // 0 to 0xFF00, because the pixel is covered.
        (self.area.floor(self.numerator(x, y) + bias) + 128) as u16
    }

    /// N at the pixel (`x`, `y`). Inside the triangle it is 0 to 2⁵⁸; intermediate sums stay below 2⁶¹.
    #[inline]
    pub(in crate::raster) fn numerator(&self, x: i32, y: i32) -> i64 {
        self.origin + self.per_column * i64::from(x) + self.per_row * i64::from(y)
    }
}
