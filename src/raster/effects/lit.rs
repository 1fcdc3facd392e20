//! Per-pixel lighting: at every pixel, or at some pixels of a row with shades interpolated linearly between them.

use super::listing::FaceCorners;
use super::pipeline::{PixelLighting, SampleSpacing};
use super::spans::{ROOM, Span, Spans};
use crate::lanes::{LANES, Lanes, Points, each};
use crate::raster::reference::weights::{Weights, in_f64};
use crate::raster::row_shader::to_bytes;
use crate::simd::compiled_for_each_level;
use crate::span::dither::{ThresholdRow, Thresholds};
use crate::span::lit::{self, Numerators};
use crate::span::{Kernel, PIECE};

/// The maximum number of lit pixels in a partly lit span, its end included, rounded up to whole vectors.
const KNOTS: usize = (PIECE / SampleSpacing::Four.pixels() + 1).next_multiple_of(LANES);

/// The shade, or three channels, at eight points.
#[inline]
fn lit<const N: usize>(light: &dyn PixelLighting, points: &Points) -> [Lanes<u16>; N] {
    let mut lit = [[0; LANES]; N];
    match lit.as_mut_slice() {
        [shades] => *shades = light.shades(points),
        channels => channels.copy_from_slice(&light.channels(points)),
    }
    lit
}

/// Normals and positions over a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct LitPlane {
    weights: Weights,
    /// The values of each corner times its depth, then its depth, and 0.
    values: [Lanes<f64>; 3],
    /// Change of their sum from one pixel to the next.
    step: ([f64; 6], f64),
}

impl LitPlane {
    pub(super) fn new(face: &FaceCorners<'_>) -> Self {
        let (triangle, corners) = (&face.triangle, face.lit());
        let mut values = [[0.0; LANES]; 3];
        for (k, values) in values.iter_mut().enumerate() {
            let depth = f64::from(triangle.vertices[k].depth().max(1));
            for (i, value) in corners[k].iter().enumerate() {
                values[i] = f64::from(*value) * depth;
            }
            values[6] = depth;
        }
        let weights = Weights::new(triangle);
        Self { weights, values, step: Self::sum(&values, in_f64(weights.per_column)) }
    }

    /// The weighted sum of the corners' values, the corners in order from top to bottom.
    #[inline(always)]
    fn sum([va, vb, vc]: &[Lanes<f64>; 3], [wa, wb, wc]: [f64; 3]) -> ([f64; 6], f64) {
        let [nx, ny, nz, x, y, z, depth, _]: Lanes<f64> = each!(i => wa * va[i] + wb * vb[i] + wc * vc[i]);
        ([nx, ny, nz, x, y, z], depth)
    }

    /// Numerators and denominator of the values at a pixel.
    #[inline(always)]
    fn at(&self, (x, y): (i32, i32)) -> ([f64; 6], f64) {
        Self::sum(&self.values, in_f64(self.weights.at(x, y)))
    }
}

/// The indices of eight successive pixels.
#[inline(always)]
fn indices(first: usize) -> Lanes<f64> {
    // At most 64.
    each!(lane => (first + lane) as f64)
}

/// Pixels of several rows, pending until eight of them are lit together.
struct Pending {
    /// The first eight make up a full block; the rest is room for what one more row adds.
    numerators: [[f64; 2 * LANES]; 7],
    /// The index of each among the pixels of all spans.
    indices: [usize; 2 * LANES],
    count: usize,
}

impl Pending {
    fn new() -> Self {
        let mut numerators = [[0.0; 2 * LANES]; 7];
        numerators[6] = [1.0; 2 * LANES];
        Self { numerators, indices: [0; 2 * LANES], count: 0 }
    }

    /// Appends the first `count` of eight pixels, at most seven; `first` is the index of the first one.
    #[inline(always)]
    fn push(&mut self, numerators: &Numerators, first: usize, count: usize) {
        // At most seven are pending.
        let at = self.count % LANES;
        for (i, pending) in self.numerators.iter_mut().enumerate() {
            if let Some(to) = pending[at..].first_chunk_mut() {
                *to = numerators[i];
            }
        }
        if let Some(to) = self.indices[at..].first_chunk_mut() {
            // The indices after the last pixel are not used.
            *to = each!(lane => first + lane);
        }
        self.count = at + count;
    }

    /// Lights the first eight.
    #[inline(always)]
    fn light<const N: usize>(&mut self, light: &dyn PixelLighting, out: &mut [&mut [u16]; N]) {
        let mut numerators = [[0.0; LANES]; 7];
        for (i, eight) in numerators.iter_mut().enumerate() {
            *eight = each!(lane => self.numerators[i][lane]);
        }
        let lit: [_; N] = lit(light, &lit::divide(&numerators));
        for (lane, &pixel) in self.indices[..self.count.min(LANES)].iter().enumerate() {
            for (i, out) in out.iter_mut().enumerate() {
                out[pixel] = lit[i][lane];
            }
        }
    }

    /// Removes the first eight, which have been lit.
    #[inline(always)]
    fn advance(&mut self) {
        for pending in &mut self.numerators {
            for lane in 0..LANES {
                pending[lane] = pending[LANES + lane];
            }
        }
        for lane in 0..LANES {
            self.indices[lane] = self.indices[LANES + lane];
        }
        self.count -= LANES;
    }
}

impl Spans<'_> {
    /// Lights some pixels of each row, and fills in bytes of shades that are linear between them.
    #[inline(never)]
    pub(super) fn light_some<const N: usize>(
        &self,
        kernel: Kernel,
        (spacing, light): (SampleSpacing, &dyn PixelLighting),
        thresholds: Thresholds,
        mut out: [&mut [u8]; N],
    ) {
        let mut nothing = [(); ROOM];
        self.each(&mut nothing, LitPlane::new, |plane, span, _| {
            let knots = Knots::new(span, spacing);
            let mut at_knots = [[0; KNOTS]; N];
            knots.light(plane, span, kernel, |first, points| {
                let shades: [_; N] = lit(light, points);
                for (i, lit) in at_knots.iter_mut().enumerate() {
                    if let Some(to) = lit[first..].first_chunk_mut() {
                        *to = shades[i];
                    }
                }
            });
            for (lit, out) in at_knots.iter().zip(&mut out) {
                knots.fill(lit, span.thresholds(thresholds), span.column(), &mut out[span.pixels()]);
            }
        });
    }
}

compiled_for_each_level! {
    /// Lights every pixel. Eight are lit together: successive ones of a row, or the remainders of several rows and
    /// triangles. A pixel's point is computed from its own row's first pixel, so its shade does not depend on the other
    /// seven.
    #[inline(never)]
    pub(super) fn light_each[const N: usize][N](
        kernel: Kernel,
        spans: &Spans<'_>,
        light: &dyn PixelLighting,
        out: [&mut [u16]; N],
    ) {
        light_each_inlined(spans, light, out)
    }
}

#[inline(always)]
fn light_each_inlined<const N: usize>(spans: &Spans<'_>, light: &dyn PixelLighting, mut out: [&mut [u16]; N]) {
    let mut pending = Pending::new();
    let mut nothing = [(); ROOM];
    spans.each(
        &mut nothing,
        LitPlane::new,
        #[inline(always)]
        |plane, span, _| {
            let ((a, d), (da, dd)) = (plane.at((span.x, span.y)), &plane.step);
            let length = span.len;
            let mut first = 0;
            while length - first >= LANES {
                let lit: [_; N] = lit(light, &lit::divide(&lit::numerators(&indices(first), &a, da, d, *dd)));
                for (i, out) in out.iter_mut().enumerate() {
                    if let Some(to) = out[span.first + first..].first_chunk_mut() {
                        *to = lit[i];
                    }
                }
                first += LANES;
            }
            if first < length {
                let numerators = lit::numerators(&indices(first), &a, da, d, *dd);
                pending.push(&numerators, span.first + first, length - first);
                if pending.count >= LANES {
                    pending.light(light, &mut out);
                    pending.advance();
                }
            }
        },
    );
    if pending.count > 0 {
        pending.light(light, &mut out);
    }
}

/// The lit pixels of a span, and the ones in between.
#[derive(Clone, Copy, Debug)]
struct Knots {
    spacing: usize,
    /// Positions of the lit pixels, relative to the span's first pixel.
    indices: [i32; KNOTS],
    /// Number of knots, at least two.
    count: usize,
}

impl Knots {
    /// The lit pixels of a span. Where the row ends inside the span, its last pixel is lit, whatever the clip
    /// rectangle.
    fn new(span: &Span, spacing: SampleSpacing) -> Self {
        let spacing = spacing.pixels();
        let mut indices = [0; KNOTS];
        for (index, number) in indices.iter_mut().zip(0..) {
            // At most 24 · 16.
            *index = (number * spacing as i32).min(span.last());
        }
        Self { spacing, indices, count: span.len.div_ceil(spacing) + 1 }
    }

    /// Calls `light` with the points of the knots, eight at a time, and the index of the first of them.
    fn light(&self, plane: &LitPlane, span: &Span, kernel: Kernel, mut light: impl FnMut(usize, &Points)) {
        let ((a, d), (da, dd)) = (plane.at((span.x, span.y)), &plane.step);
        for (first, eight) in self.indices[..self.count].chunks(LANES).enumerate() {
            let mut indices = [0.0; LANES];
            for (lane, index) in eight.iter().enumerate() {
                indices[lane] = f64::from(*index);
            }
            light(first * LANES, &lit::interpolate_at(kernel, &indices, &a, da, d, *dd));
        }
    }

    /// The bytes of shades in 8.8 that are linear between the knots.
    fn fill(&self, knots: &[u16; KNOTS], thresholds: &ThresholdRow, column: usize, piece: &mut [u8]) {
        for (i, piece) in piece.chunks_mut(self.spacing).enumerate() {
            let (from, to) = (i32::from(knots[i]), i32::from(knots[i + 1]));
            let pixels = self.indices[i + 1] - self.indices[i];
            // In 1/256 of a shade's unit. Rounded toward zero: no sum goes beyond `to`.
            let step = if pixels == 0 { 0 } else { ((to - from) << 8) / pixels };
            for (eight, bytes) in piece.chunks_mut(LANES).enumerate() {
                // Below 16.
                let first = (eight * LANES) as i32;
                // Lanes beyond the knot are not used.
                let shades: Lanes<u16> = each!(lane => (from + ((step * (first + lane as i32)) >> 8)) as u16);
                to_bytes(&shades, thresholds, column + i * self.spacing + eight * LANES, bytes);
            }
        }
    }
}
