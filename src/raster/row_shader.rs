//! Shading of a triangle's rows: the choice of the pixel loop and of its start.
//!
//! Every method of drawing a triangle fills its rows here, whole or in parts, so all give the same bytes.

use core::ops::Range;

use super::depth::Cell;
use super::draw_stats::DrawStats;
use super::interpolation::Interpolation;
use super::reference::cover::{Row, SortedTriangle};
use super::reference::depth::DepthPlane;
use super::reference::fixed16::ShadePlane16;
#[cfg(feature = "alloc")]
use super::reference::float::FloatPlane;
use super::reference::hyperbolic::HyperbolicPlane;
use super::reference::shade::{RESEED, ShadePlane};
use super::vintage::VintageTriangle;
use crate::fixed::IS_SMALL;
#[cfg(feature = "alloc")]
use crate::lanes::{LANES, each};
#[cfg(feature = "alloc")]
use crate::span::dither::{ThresholdRow, fill_dithered};
use crate::span::fixed16::fill_16_16;
#[cfg(feature = "alloc")]
use crate::span::fixed16::shades_16_16;
#[cfg(feature = "alloc")]
use crate::span::float;
#[cfg(feature = "alloc")]
use crate::span::hyperbolic::{estimated_shades, floor_quotient};
use crate::span::{Kernel, depth};

/// The shades of one triangle, or another value of its corners, ready to be filled row by row.
#[derive(Clone, Copy, Debug)]
pub(super) enum RowShader {
    Flat(u8),
    Linear {
        plane: ShadePlane,
        reseeded: bool,
    },
    Vintage(VintageTriangle),
    Fixed16(ShadePlane16),
    Hyperbolic(HyperbolicPlane),
    #[cfg(feature = "alloc")]
    Float(FloatPlane),
}

impl RowShader {
    /// The shader of a triangle that is not degenerate.
    #[inline]
    pub(super) fn new(triangle: &SortedTriangle, interpolation: Interpolation) -> Self {
        Self::of_values(triangle, triangle.shades(), interpolation)
    }

    /// The shader of three values of 0 to 0xFF00 at the corners of a triangle that is not degenerate.
    /// The values are in the order of its vertices.
    #[inline]
    pub(super) fn of_values(triangle: &SortedTriangle, values: [i64; 3], interpolation: Interpolation) -> Self {
        match interpolation {
            Interpolation::Flat(index) => Self::Flat(index),
            Interpolation::Gouraud88 | Interpolation::Gouraud88Reseeded => Self::Linear {
                plane: ShadePlane::of_values(triangle, values),
                reseeded: matches!(interpolation, Interpolation::Gouraud88Reseeded),
            },
            _ => Self::of_another_kind(triangle, values, interpolation),
        }
    }

    /// The shader of any other interpolation; a separate function, so that the loops for linear shades contain nothing
    /// else.
    #[inline(never)]
    fn of_another_kind(triangle: &SortedTriangle, values: [i64; 3], interpolation: Interpolation) -> Self {
        match interpolation {
            Interpolation::GouraudVintage if !IS_SMALL => Self::Vintage(VintageTriangle::new(triangle, values)),
            Interpolation::Gouraud1616 => Self::Fixed16(ShadePlane16::of_values(triangle, values)),
            Interpolation::GouraudHyperbolic => Self::Hyperbolic(HyperbolicPlane::of_values(triangle, values)),
            #[cfg(feature = "alloc")]
            Interpolation::GouraudFloat if !IS_SMALL => Self::Float(FloatPlane::of_values(triangle, values)),
            // Only in a build for size: the others are handled above.
            _ => Self::of_values(triangle, values, Interpolation::Gouraud88),
        }
    }

    /// Paints the drawn pixels of `row`.
    #[inline]
    pub(super) fn row(&self, row: &Row, to: &mut impl RowTarget) {
        match self {
            Self::Flat(index) => to.linear(row.range(), u16::from(*index) << 8, 0),
            Self::Linear { plane, reseeded } => {
                starts(row, plane, *reseeded, |range, start| to.linear(range, start, plane.step()));
            }
            _ => self.row_of_another_kind(row, to),
        }
    }

    #[inline(never)]
    fn row_of_another_kind(&self, row: &Row, to: &mut impl RowTarget) {
        match self {
            Self::Vintage(triangle) if !IS_SMALL => {
                triangle.ramp(row.y).spans(row.x0..row.x1, |range, shade, step| to.linear(range, shade, step));
            }
            _ => pieces(row, |_, x, end| to.piece(x as usize..end as usize, |pixels| self.fill(row, x, pixels))),
        }
    }

    /// The bytes from column `x` of `row` on, for the kinds with one loop for any number of pixels.
    #[inline]
    fn fill(&self, row: &Row, x: i32, pixels: &mut [u8]) {
        match self {
            Self::Fixed16(plane) => fill_16_16(pixels, fixed16_start(plane, row, x), plane.step),
            Self::Hyperbolic(plane) => plane.fill(x, row.y, pixels),
            #[cfg(feature = "alloc")]
            Self::Float(plane) if !IS_SMALL => {
                let at = plane.row(row);
                float::fill_float(pixels, x - at.start, at.n, at.d, at.range);
            }
            Self::Flat(index) => pixels.fill(*index),
            // Their rows are split where they are reseeded.
            _ => {}
        }
    }
}

/// Shading for the stages of `effects`.
#[cfg(feature = "alloc")]
impl RowShader {
    /// The bytes of `piece`, which begins at column `x` of `row` and contains no other start. With
    /// dither, the thresholds of the row replace the half.
    pub(super) fn piece(&self, row: &Row, x: i32, piece: &mut [u8], dither: Option<&ThresholdRow>, kernel: Kernel) {
        // A column.
        let column = x as usize;
        let linear = |piece: &mut [u8], column: usize, shade: u16, step: u16, half: u16| match dither {
            Some(thresholds) => fill_dithered(piece, shade.wrapping_sub(half), step, thresholds, column),
            None => kernel.fill(piece, shade, step),
        };
        match (self, dither) {
            (Self::Linear { plane, reseeded }, _) => {
                linear(piece, column, start_at(plane, row, x, *reseeded), plane.step(), 128);
            }
            // At most 64 pixels.
            (Self::Vintage(triangle), _) if !IS_SMALL => {
                triangle.ramp(row.y).spans(x..x + piece.len() as i32, |range, shade, step| {
                    linear(&mut piece[range.start - column..range.end - column], range.start, shade, step, 0);
                });
            }
            (_, None) | (Self::Flat(_), _) => self.fill(row, x, piece),
            (_, Some(thresholds)) => {
                let mut shades = [0; RESEED as usize];
                let shades = &mut shades[..piece.len()];
                self.shades(row, x, shades);
                to_bytes(shades, thresholds, column, piece);
            }
        }
    }

    /// The truncated 8.8 shades from column `x` of `row` on, for the kinds without a dithering loop.
    fn shades(&self, row: &Row, x: i32, shades: &mut [u16]) {
        // Each is 0 to 0xFF00, because the pixel is covered.
        match self {
            Self::Fixed16(plane) => shades_16_16(shades, fixed16_start(plane, row, x), plane.step),
            Self::Hyperbolic(plane) => {
                let estimates = plane.estimates(x, row.y, 0, shades.len());
                if !estimates.is_some_and(|[n, d]| estimated_shades(shades, n, d)) {
                    for (shade, x) in shades.iter_mut().zip(x..) {
                        let (n, d) = plane.shade(x, row.y);
                        *shade = floor_quotient(n, d) as u16;
                    }
                }
            }
            Self::Float(plane) if !IS_SMALL => {
                let at = plane.row(row);
                float::float_shades(shades, x - at.start, at.n, at.d, at.range);
            }
            Self::Flat(_) | Self::Linear { .. } | Self::Vintage(_) | Self::Float(_) => {}
        }
    }
}

/// Rounds 8.8 shades to the nearest bytes.
#[cfg(feature = "alloc")]
pub(super) fn to_nearest_bytes(shades: &[u16], bytes: &mut [u8]) {
    // Eight at a time, so that the compiler vectorizes it. A shade is at most 0xFF00.
    let n = bytes.len().min(shades.len());
    let (eights, rest) = bytes[..n].as_chunks_mut::<LANES>();
    let (shades, rest_shades) = shades[..n].as_chunks::<LANES>();
    for (i, bytes) in eights.iter_mut().enumerate() {
        *bytes = each!(k => (shades[i][k].wrapping_add(128) >> 8) as u8);
    }
    for (byte, shade) in rest.iter_mut().zip(rest_shades) {
        *byte = (shade.wrapping_add(128) >> 8) as u8;
    }
}

/// Turns 8.8 shades into bytes: adds the threshold, drops the fraction.
#[cfg(feature = "alloc")]
pub(super) fn to_bytes(shades: &[u16], thresholds: &ThresholdRow, column: usize, bytes: &mut [u8]) {
    // A shade is at most 0xFF00.
    let byte = |shade: u16, threshold: u8| (shade.wrapping_add(u16::from(threshold)) >> 8) as u8;
    let n = bytes.len().min(shades.len());
    let (eights, rest) = bytes[..n].as_chunks_mut::<LANES>();
    let (shades, rest_shades) = shades[..n].as_chunks::<LANES>();
    for (i, bytes) in eights.iter_mut().enumerate() {
        let thresholds = thresholds.next::<LANES>(column + i * LANES);
        *bytes = each!(k => byte(shades[i][k], thresholds[k]));
    }
    let first = column + eights.len() * LANES;
    for (k, to) in rest.iter_mut().enumerate() {
        *to = byte(rest_shades[k], thresholds.at(first + k));
    }
}

/// The sum at column `x`: it starts at the row's origin.
#[inline]
fn fixed16_start(plane: &ShadePlane16, row: &Row, x: i32) -> u32 {
    // Columns are below 4,096; the sum is modulo 2³².
    plane.start(row.origin, row.y).wrapping_add(plane.step.wrapping_mul((x - row.origin) as u32))
}

/// Destination of a row's pixels, which counts them.
pub(super) trait RowTarget {
    /// Writes a span of shades in 8.8.
    fn linear(&mut self, range: Range<usize>, shade: u16, step: u16);

    /// Writes a span of at most 64 pixels, which `fill` computes.
    fn piece(&mut self, range: Range<usize>, fill: impl FnOnce(&mut [u8]));
}

/// The whole row of a frame.
pub(super) struct InRow<'a> {
    pub(super) pixels: &'a mut [u8],
    pub(super) kernel: Kernel,
    pub(super) drawn: &'a mut DrawStats,
}

impl RowTarget for InRow<'_> {
    #[inline]
    fn linear(&mut self, range: Range<usize>, shade: u16, step: u16) {
        let kernel = self.kernel;
        self.piece(range, |pixels| kernel.fill(pixels, shade, step));
    }

    #[inline]
    fn piece(&mut self, range: Range<usize>, fill: impl FnOnce(&mut [u8])) {
        if let Some(pixels) = self.pixels.get_mut(range) {
            self.drawn.spans += 1;
            // At most 4,096.
            self.drawn.pixels += pixels.len() as u32;
            fill(pixels);
        }
    }
}

/// The whole row of a frame and of its depth buffer, written where the plane is nearer.
pub(super) struct WhereNearer<'a, D> {
    pub(super) row: i32,
    pub(super) pixels: &'a mut [u8],
    pub(super) depths: &'a mut [D],
    pub(super) plane: &'a DepthPlane,
    pub(super) drawn: &'a mut DrawStats,
}

impl<D: Cell> WhereNearer<'_, D> {
    /// Passes the pixels and depths of a span to its loop, which returns the number of pixels written.
    #[inline]
    fn span(&mut self, range: Range<usize>, fill: impl FnOnce(&mut [u8], &mut [D], i64, i64) -> u32) {
        // A column is below 4,096.
        let z = self.plane.fixed_at(range.start as i32, self.row);
        let depths = self.depths.get_mut(range.clone());
        if let (Some(pixels), Some(depths)) = (self.pixels.get_mut(range), depths) {
            self.drawn.spans += 1;
            // At most 4,096.
            self.drawn.tested += pixels.len() as u32;
            self.drawn.pixels += fill(pixels, depths, z, self.plane.step());
        }
    }
}

impl<D: Cell> RowTarget for WhereNearer<'_, D> {
    #[inline]
    fn linear(&mut self, range: Range<usize>, shade: u16, step: u16) {
        self.span(range, |pixels, depths, z, dz| depth::fill_nearer(pixels, depths, shade, step, z, dz));
    }

    #[inline]
    fn piece(&mut self, range: Range<usize>, fill: impl FnOnce(&mut [u8])) {
        let mut bytes = [0; RESEED as usize];
        let Some(bytes) = bytes.get_mut(..range.len()) else { return };
        fill(bytes);
        self.span(range, |pixels, depths, z, dz| depth::copy_nearer(pixels, depths, bytes, z, dz));
    }
}

/// Splits a row into spans, each with its start. Exact starts lie at the row's origin and, if `reseeded`, every 64
/// pixels from there; a row whose drawn part begins later continues from the last start at or left of it, so that the
/// clip rectangle changes no byte.
#[inline]
pub(super) fn starts(row: &Row, shade: &ShadePlane, reseeded: bool, mut span: impl FnMut(Range<usize>, u16)) {
    if !reseeded {
        return span(row.range(), start_at(shade, row, row.x0, false));
    }
    let advance = |start: u16, pixels: i32| start.wrapping_add(shade.step().wrapping_mul(pixels as u16));
    pieces(row, |seed, x, end| span(x as usize..end as usize, advance(shade.start(seed, row.y), x - seed)));
}

/// The shade at column `x` of a row: exact if it is reseeded there, otherwise continued from the row's origin.
#[inline]
pub(super) fn start_at(shade: &ShadePlane, row: &Row, x: i32, reseeded: bool) -> u16 {
    if reseeded {
        return shade.start(x, row.y);
    }
    // Columns are below 4,096; the sum is modulo 2¹⁶.
    shade.start(row.origin, row.y).wrapping_add(shade.step().wrapping_mul((x - row.origin) as u16))
}

/// Splits the drawn part of a row every 64 pixels from its origin. `piece` gets the column of each split, or of the
/// origin, and the columns between which its pixels are drawn.
#[inline]
pub(super) fn pieces(row: &Row, mut piece: impl FnMut(i32, i32, i32)) {
    let mut seed = row.origin + (row.x0 - row.origin) / RESEED * RESEED;
    let mut x = row.x0;
    while x < row.x1 {
        let end = row.x1.min(seed + RESEED);
        piece(seed, x, end);
        seed += RESEED;
        x = end;
    }
}

#[cfg(test)]
mod tests {
    use super::super::frame::Rect;
    use super::super::vertex::Vertex;
    use super::*;
    use crate::fixed::{I24F8, U8F8};

    /// Where the depth buffer holds nothing nearer, every kind is painted as it is without depths.
    #[test]
    fn rows_where_nearer_are_rows() {
        const WIDTH: u32 = 200;
        let corners = [(-900, 300, 0x1280, 9), (40_000, -70, 0xFF00, 1 << 30), (51_300, 5_000, 0x40, 77)];
        let vertices = corners.map(|(x, y, shade, depth)| {
            Vertex::new(I24F8::from_bits(x), I24F8::from_bits(y), U8F8::from_bits(shade), depth).expect("in range")
        });
        let triangle = SortedTriangle::new(&vertices);
        let depths = DepthPlane::new(&triangle);
        let paints = Interpolation::INTERPOLATED.iter().map(|interpolation| RowShader::new(&triangle, *interpolation));
        for paint in paints.chain([RowShader::Flat(9)]) {
            let mut rows = 0;
            triangle.rows(WIDTH, Rect { x0: 0, y0: 0, x1: WIDTH, y1: 20 }, |row| {
                let (mut bytes, mut nearer, mut cells) = ([3; 200], [3; 200], [0_u32; 200]);
                let (mut drawn, mut tested) = (DrawStats::default(), DrawStats::default());
                let (kernel, plane) = (Kernel::PORTABLE, &depths);
                paint.row(&row, &mut InRow { pixels: &mut bytes, kernel, drawn: &mut drawn });
                let (pixels, depths) = (&mut nearer[..], &mut cells[..]);
                paint.row(&row, &mut WhereNearer { row: row.y, pixels, depths, plane, drawn: &mut tested });
                assert_eq!(nearer, bytes, "{row:?} of {paint:?}");
                assert_eq!((tested.pixels, drawn.pixels), (row.range().len() as u32, row.range().len() as u32));
                rows += 1;
            });
            assert!(rows > 10, "{rows}");
        }
    }
}
