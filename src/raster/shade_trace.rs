//! Traces a pixel of a triangle to its byte: the start and the step of its span, and the sum up to it.
//!
//! The loops of [`span`](crate::span) store none of this. It is recomputed here for a single pixel, from the planes
//! that the loops start from.

use super::frame::Rect;
use super::interpolation::Interpolation;
use super::reference::cover::{Row, SortedTriangle};
use super::reference::fixed16::ShadePlane16;
use super::reference::float::FloatPlane;
use super::reference::hyperbolic::HyperbolicPlane;
use super::reference::shade::{RESEED, ShadePlane};
use super::vintage::VintageTriangle;
use crate::span::float::{fill_float, quotient};

/// An exact number: a fraction.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Ratio {
    /// The numerator.
    pub numerator: i128,
    /// The denominator, above 0.
    pub denominator: i128,
}

impl Ratio {
    /// The nearest f64, or its neighbour.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        self.numerator as f64 / self.denominator as f64
    }
}

/// How a value progresses along the row to a pixel.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Progression {
    /// One byte for the whole triangle.
    Flat(u8),
    /// A start, and additions of one step from there on.
    Accumulator(Accumulator),
    /// An exact quotient for every pixel: the shade is [`ShadeTrace::exact`] itself.
    Quotient,
    /// A quotient in f32: (n + k·dn) / (d + k·dd).
    Float {
        /// The column at which k is 0: the row's first pixel or its last, whichever is farther away.
        start: i32,
        /// n and dn.
        n: [f32; 2],
        /// d and dd.
        d: [f32; 2],
        /// The quotient, within the range of the corners.
        shade: f32,
    },
}

/// A start, and additions of one step.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Accumulator {
    /// The row's first covered pixel in the frame; for [`GouraudVintage`](Interpolation::GouraudVintage) Ax, which may
    /// lie left of it.
    pub first: i32,
    /// The pixel where the sum is a start: `first`, or a multiple of 64 pixels after it.
    pub start_at: i32,
    /// The sum there, including what is added for rounding; it has `fraction_bits + 8` bits.
    pub start: u32,
    /// The step; the loop adds it modulo 2¹⁶ (2³² in 16.16).
    pub step: i64,
    /// The number of additions from there to the pixel.
    pub steps: i32,
    /// 8, or 16.
    pub fraction_bits: u32,
    /// The part of the start added for rounding: half a shade, or nothing.
    pub half: u32,
}

impl Accumulator {
    /// The sum after this many steps: the contents of AX, or of EAX.
    #[must_use]
    pub fn after(&self, steps: i32) -> u32 {
        // Wrapping is intended: the loop's register has this many bits.
        let sum = i64::from(self.start).wrapping_add(self.step.wrapping_mul(i64::from(steps)));
        (sum & ((1 << (self.fraction_bits + 8)) - 1)) as u32
    }

    /// The sum at the pixel.
    #[must_use]
    pub fn sum(&self) -> u32 {
        self.after(self.steps)
    }
}

/// The trace of a value from a triangle's corners to one of its pixels.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub struct ShadeTrace {
    /// The progression along the row.
    pub way: Progression,
    /// The exact value at the pixel's centre, in 1/256 shade: linear on the screen or, if the shading is, on the face.
    /// `None` for a flat triangle.
    pub exact: Option<Ratio>,
    /// The byte: the nearest shade, or the truncated one.
    pub byte: u8,
}

impl ShadeTrace {
    /// Traces a pixel of `row` for three values of 0 to 0xFF00 at the corners of a triangle that is not degenerate.
    ///
    /// The values are in the order of its vertices.
    pub fn new(triangle: &SortedTriangle, values: [i64; 3], interpolation: Interpolation, row: &Row, x: i32) -> Self {
        let y = row.y;
        let plane = ShadePlane::of_values(triangle, values);
        let linear = Ratio { numerator: plane.numerator(x, y).into(), denominator: i128::from(plane.area.get()) };
        match interpolation {
            Interpolation::Flat(byte) => Self { way: Progression::Flat(byte), exact: None, byte },
            Interpolation::Gouraud88 | Interpolation::Gouraud88Reseeded => {
                let reseed = if interpolation == Interpolation::Gouraud88 { i32::MAX } else { RESEED };
                let start_at = row.origin + (x - row.origin) / reseed * reseed;
                let sums = Accumulator {
                    first: row.origin,
                    start_at,
                    start: plane.start(start_at, y).into(),
                    step: plane.per_column / plane.area.get(),
                    steps: x - start_at,
                    fraction_bits: 8,
                    half: 128,
                };
                Self::of_sums(sums, linear)
            }
            Interpolation::Gouraud1616 => {
                let wide = ShadePlane16::of_values(triangle, values);
                let sums = Accumulator {
                    first: row.origin,
                    start_at: row.origin,
                    start: wide.start(row.origin, y),
                    // Below 2⁵⁴.
                    step: plane.per_column * 256 / plane.area.get(),
                    steps: x - row.origin,
                    fraction_bits: 16,
                    half: 0x8000,
                };
                Self::of_sums(sums, linear)
            }
            Interpolation::GouraudVintage => {
                let ramp = VintageTriangle::new(triangle, values).ramp(y);
                // Beyond the row's own pixels the nearest one counts.
                let steps = x.min(ramp.x1 - 1).max(ramp.x0) - ramp.x0;
                let step = i64::from(ramp.step as i16);
                let (first, start) = (ramp.x0, ramp.shade.into());
                let sums = Accumulator { first, start_at: first, start, step, steps, fraction_bits: 8, half: 0 };
                Self::of_sums(sums, linear)
            }
            Interpolation::GouraudHyperbolic => {
                let plane = HyperbolicPlane::of_values(triangle, values);
                let (numerator, denominator) = plane.quotient(x, y);
                // The nearest shade, of 0 to 0xFF00.
                let byte = numerator.div_euclid(denominator) as u8;
                Self { way: Progression::Quotient, exact: Some(on_face(&plane, x, y)), byte }
            }
            Interpolation::GouraudFloat => {
                let exact = on_face(&HyperbolicPlane::of_values(triangle, values), x, y);
                let float = FloatPlane::of_values(triangle, values).row(row);
                let mut byte = [0];
                fill_float(&mut byte, x - float.start, float.n, float.d, float.range);
                let shade = quotient(x - float.start, float.n, float.d, float.range);
                let way = Progression::Float { start: float.start, n: float.n, d: float.d, shade };
                Self { way, exact: Some(exact), byte: byte[0] }
            }
        }
    }

    fn of_sums(sums: Accumulator, exact: Ratio) -> Self {
        // The upper 8 of `fraction_bits` + 8 bits.
        let byte = (sums.sum() >> sums.fraction_bits) as u8;
        Self { way: Progression::Accumulator(sums), exact: Some(exact), byte }
    }
}

fn on_face(plane: &HyperbolicPlane, x: i32, y: i32) -> Ratio {
    let (numerator, denominator) = plane.shade(x, y);
    Ratio { numerator, denominator }
}

/// The row of a pixel that a triangle draws in a frame of this width, by exact coverage or by that of `interpolation`.
pub fn row_of(
    triangle: &SortedTriangle,
    interpolation: Option<Interpolation>,
    width: u32,
    x: u32,
    y: u32,
) -> Option<Row> {
    let clip = Rect { x0: x, y0: y, x1: x + 1, y1: y + 1 };
    let mut found = None;
    if interpolation == Some(Interpolation::GouraudVintage) {
        VintageTriangle::new(triangle, triangle.shades()).rows(width, clip, &mut |row| found = Some(row));
    } else {
        triangle.rows(width, clip, |row| found = Some(row));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixed::{I24F8, U8F8};
    use crate::raster::Vertex;

    /// A triangle 8 pixels wide and 4 high with its right angle at the upper left; shades 40 at the left and 200 at the
    /// right, 20 from pixel to pixel. In row 0 the exact shade of pixel x is 50 + 20·x.
    fn shade_trace(interpolation: Interpolation, shades: [u8; 3], x: i32) -> ShadeTrace {
        let at = |x, y, shade, depth| {
            let (x, y) = (I24F8::from(x), I24F8::from(y));
            Vertex::new(x, y, U8F8::from(shade), depth).expect("a legal vertex")
        };
        let [a, b, c] = shades;
        let triangle = SortedTriangle::new(&[at(0, 0, a, 100), at(8, 0, b, 100), at(0, 4, c, 100)]);
        let row = row_of(&triangle, Some(interpolation), 320, u32::try_from(x).expect("a column"), 0).expect("a row");
        ShadeTrace::new(&triangle, triangle.shades(), interpolation, &row, x)
    }

    #[test]
    fn a_rising_row_by_hand() {
        // 50.0 and a half: 0x3280; 20.0 = 0x1400 a pixel; after three 110.5 = 0x6e80.
        let ShadeTrace { way: Progression::Accumulator(sums), exact, byte } =
            shade_trace(Interpolation::Gouraud88Reseeded, [40, 200, 40], 3)
        else {
            panic!("sums")
        };
        assert_eq!((sums.first, sums.start_at, sums.start, sums.step, sums.steps), (0, 0, 0x3280, 0x1400, 3));
        assert_eq!([0, 1, 2, 3].map(|k| sums.after(k)), [0x3280, 0x4680, 0x5A80, 0x6E80]);
        assert_eq!((byte, sums.sum(), sums.half), (110, 0x6E80, 128));
        let exact = exact.expect("a plane");
        assert_eq!(exact.numerator, 110 * 256 * exact.denominator);

        let ShadeTrace { way: Progression::Accumulator(wide), byte, .. } =
            shade_trace(Interpolation::Gouraud1616, [40, 200, 40], 3)
        else {
            panic!("sums")
        };
        assert_eq!((wide.start, wide.step, wide.sum(), byte), (0x32_8000, 0x14_0000, 0x6E_8000, 110));
        // The sources: from the corner's own 40, and no half.
        let ShadeTrace { way: Progression::Accumulator(vintage), byte, .. } =
            shade_trace(Interpolation::GouraudVintage, [40, 200, 40], 3)
        else {
            panic!("sums")
        };
        assert_eq!((vintage.start, vintage.step, vintage.sum(), byte), (0x2800, 0x1400, 0x6400, 100));
        // Depths are equal, so the perspective changes nothing.
        for interpolation in [Interpolation::GouraudHyperbolic, Interpolation::GouraudFloat] {
            assert_eq!(shade_trace(interpolation, [40, 200, 40], 3).byte, 110);
        }
        assert_eq!(
            shade_trace(Interpolation::Flat(7), [40, 200, 40], 3),
            ShadeTrace { way: Progression::Flat(7), exact: None, byte: 7 }
        );
    }

    #[test]
    fn a_falling_row_by_hand() {
        // From 1 to 0 over 8 pixels: −32/256 a pixel, exact in 8.8; at the first centre 1 − 1/16 = 240/256. With half a
        // shade 0x0170; after five 0x00d0.
        let ShadeTrace { way: Progression::Accumulator(sums), byte, .. } =
            shade_trace(Interpolation::Gouraud88, [1, 0, 1], 5)
        else {
            panic!("sums")
        };
        assert_eq!((sums.start, sums.step, sums.sum(), byte), (0x0170, -0x20, 0x00D0, 0));
        // 10 to 9 from top to bottom makes the first row's shade 10 − 1/8 everywhere: no step.
        let ShadeTrace { way: Progression::Accumulator(sums), byte, .. } =
            shade_trace(Interpolation::Gouraud88, [10, 10, 9], 5)
        else {
            panic!("sums")
        };
        assert_eq!((sums.start, sums.step, sums.sum(), byte), (0x0A60, 0, 0x0A60, 10));
    }
}
