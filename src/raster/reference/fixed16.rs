//! Shades in 16.16: one exact start per row, with steps so fine that a row needs no other.
//!
//! [`shade`](super::shade) uses 8.8; this is the same with 16 fraction bits.
//!
//! # Why no byte leaves the range of the vertices
//!
//! The reasons are the same: the step is dI/dx rounded toward zero to 1/65,536 shade, and the start is the exact value
//! at its pixel's centre, rounded down where shades rise and up where they fall. So every sum lies between the start
//! and the exact value, and both lie between min and max, which are whole multiples of the unit. Half a shade is added
//! to the start; with max at most 255.0 the sum is below 256 and fits in 24 bits.
//!
//! A span of two pixels or more has |dI/dx| ≤ 255 shades, so its step fits in 32 bits modulo 2³² with room
//! to spare; a span of one pixel never uses the step, which wraps unused.
//!
//! # How far a byte is from exact
//!
//! After k steps the sum is off by less than (k + 1)/65,536 of a shade: 320/65,536 over a row of 320, one
//! sixteenth over the widest frame. The byte is the nearest to that: within ½ + 320/65,536.

use super::cover::SortedTriangle;
use super::shade::ShadePlane;

/// The shade plane of a triangle, for sums in 16.16.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShadePlane16 {
    plane: ShadePlane,
    /// Step from pixel to pixel, in 1/65,536 shade modulo 2³².
    pub(in crate::raster) step: u32,
}

impl ShadePlane16 {
    /// The plane of any three values of 0 to 0xFF00 at the corners of a triangle that is not degenerate,
    /// in the order of its vertices.
    #[must_use]
    pub(crate) fn of_values(triangle: &SortedTriangle, shades: [i64; 3]) -> Self {
        let plane = ShadePlane::of_values(triangle, shades);
        // 2⁸ · |per_column| / A, by quotient and remainder: at most 2⁴⁶, and less than A.
        let area = &plane.area;
        let (whole, rest) = area.div_rem_floor(plane.per_column.abs());
        let magnitude = (whole << 8) + area.floor(rest << 8);
        // Wrapping is intended: see the module's documentation.
        let step = if plane.per_column < 0 { -magnitude } else { magnitude } as u32;
        Self { plane, step }
    }

    /// The sum at the pixel (`x`, `y`), whose centre lies in the triangle: the exact shade there in 1/65,536, rounded
    /// down where shades rise and up where they fall, plus half a shade.
    #[must_use]
    #[inline]
    pub(crate) fn start(&self, x: i32, y: i32) -> u32 {
        let area = &self.plane.area;
        // N·2⁸ / A, N at most 2⁵⁸, by quotient and remainder, which is less than A.
        let (whole, rest) = area.div_rem_floor(self.plane.numerator(x, y));
        let bias = if self.plane.per_column < 0 { area.get() - 1 } else { 0 };
        let exact = (whole << 8) + area.floor((rest << 8) + bias);
        // 0 to 0xFF_0000, because the pixel is covered.
        (exact + 0x8000) as u32
    }
}
