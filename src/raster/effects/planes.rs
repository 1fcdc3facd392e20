//! What is linear over a triangle, on the screen or on the face, beside shades: texture coordinates, and what light
//! needs; and the pixels that are lit where not all are.

use core::ops::Range;

use super::{Apart, Attributes, PIECE, TextureMapping};
use crate::raster::cover::{Ordered, Row};
use crate::raster::hyperbolic::Linear;
use crate::raster::paint::to_bytes;
use crate::raster::weights::Weights;
use crate::span::Kernel;
use crate::span::hyperbolic::floor_quotient;
use crate::span::lit::{LANES, Lanes, Points};

/// The most places in a piece that are lit for [`Source::LitEvery`], its end being one, and as many as are lit at once.
pub(super) const KNOTS: usize = (PIECE / Apart::Four.pixels() + 1).next_multiple_of(LANES);

/// Texture coordinates over a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct TexturePlane {
    pub(super) numerators: [Linear; 2],
    /// Of affine mapping the area: the same everywhere.
    pub(super) denominator: Linear,
    /// Of affine mapping, from one pixel to the next, rounded toward zero.
    pub(super) steps: [u32; 2],
}

impl TexturePlane {
    pub(super) fn new(triangle: &Ordered, corners: [&Attributes; 3], mapping: TextureMapping) -> Self {
        let depths = match mapping {
            TextureMapping::Affine => [1; 3],
            _ => triangle.vertices.each_ref().map(|v| i128::from(v.depth().max(1))),
        };
        let numerators =
            [0, 1].map(|i| Linear::new(triangle, [0, 1, 2].map(|k| i128::from(corners[k].texture[i]) * depths[k])));
        let area = i128::from(triangle.area());
        // The wrap is meant: of two pixels or more in a row the step is that of two coordinates; of one it
        // is never used.
        let steps = numerators.map(|n| (n.per_column() / area) as u32);
        Self { numerators, denominator: Linear::new(triangle, depths), steps }
    }

    /// The coordinates at a pixel, rounded down; 16.16, modulo 2³².
    pub(super) fn at(&self, x: i32, y: i32) -> [u32; 2] {
        let d = self.denominator.at(x, y);
        // A mean of the corners' coordinates, so it fits in 32 bits. The wrap is meant: texels repeat.
        self.numerators.each_ref().map(|n| floor_quotient(n.at(x, y), d) as u32)
    }

    /// The same, rounded back toward where the coordinates come from, as shades are: so no sum leaves
    /// the range of the corners.
    pub(super) fn start(&self, x: i32, y: i32) -> [u32; 2] {
        let d = self.denominator.at(x, y);
        self.numerators.each_ref().map(|n| {
            let bias = if n.per_column() < 0 { d - 1 } else { 0 };
            floor_quotient(n.at(x, y) + bias, d) as u32
        })
    }
}

/// Normals and positions over a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct LitPlane {
    weights: Weights,
    /// Of each corner, its values times its depth, then its depth.
    values: [[f64; 7]; 3],
    /// What their sum changes by from one pixel to the next.
    step: ([f64; 6], f64),
}

impl LitPlane {
    pub(super) fn new(triangle: &Ordered, corners: [&Attributes; 3]) -> Self {
        let values = [0, 1, 2].map(|k| {
            let depth = f64::from(triangle.vertices[k].depth().max(1));
            let [a, b, c, d, e, f] = corners[k].lit.map(|value| f64::from(value) * depth);
            [a, b, c, d, e, f, depth]
        });
        let weights = Weights::new(triangle);
        Self { weights, values, step: Self::sum(&values, weights.per_column()) }
    }

    /// The sum over the corners, in their order from top to bottom, of the values with these weights.
    fn sum([va, vb, vc]: &[[f64; 7]; 3], [wa, wb, wc]: [f64; 3]) -> ([f64; 6], f64) {
        let value = |i: usize| wa * va[i] + wb * vb[i] + wc * vc[i];
        (core::array::from_fn(value), value(6))
    }

    /// Numerators and denominator of the values at pixel (`x`, `y`).
    #[inline]
    pub(super) fn at(&self, x: i32, y: i32) -> ([f64; 6], f64) {
        Self::sum(&self.values, self.weights.at(x, y))
    }

    /// What they change by from one pixel to the next.
    #[inline]
    pub(super) fn step(&self) -> (&[f64; 6], f64) {
        (&self.step.0, self.step.1)
    }

    /// Hands points from pixel (`x`, `y`) on to `light`, with the pixels from there that they are of.
    pub(super) fn points(
        &self,
        (x, y): (i32, i32),
        pixels: usize,
        kernel: Kernel,
        mut light: impl FnMut(Range<usize>, &Points),
    ) {
        let (a, d) = self.at(x, y);
        let (da, dd) = self.step();
        for first in (0..pixels).step_by(LANES) {
            // At most 64.
            let places = core::array::from_fn(|lane| (first + lane) as f64);
            let points = kernel.interpolate_at(&places, &a, da, d, dd);
            light(first..pixels.min(first + LANES), &points);
        }
    }

    /// The points at some pixels from pixel (`x`, `y`) on.
    pub(super) fn points_at(&self, x: i32, y: i32, places: &Lanes<f64>, kernel: Kernel) -> Points {
        let (a, d) = self.at(x, y);
        let (da, dd) = self.step();
        kernel.interpolate_at(places, &a, da, d, dd)
    }
}

/// Pixels of a piece that are lit, and those between.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knots {
    apart: usize,
    /// From the piece's seed, in pixels.
    places: [i32; KNOTS],
    /// How many there are, at least two.
    count: usize,
}

impl Knots {
    /// Of so many pixels from `seed` on. Where the row ends inside of the piece, its last pixel is one, whatever the clip
    /// rectangle.
    pub(super) fn new(row: &Row, seed: i32, pixels: usize, apart: Apart) -> Self {
        let apart = apart.pixels();
        let mut places = [0; KNOTS];
        for (place, number) in places.iter_mut().zip(0..) {
            // At most 24 · 16.
            *place = (number * apart as i32).min((row.last - seed).max(0));
        }
        Self { apart, places, count: pixels.div_ceil(apart) + 1 }
    }

    /// Lights them, eight at a time, and hands the eight on with the number of the first.
    pub(super) fn light(
        &self,
        plane: &LitPlane,
        (x, y): (i32, i32),
        kernel: Kernel,
        mut light: impl FnMut(usize, &Points),
    ) {
        for (first, eight) in self.places[..self.count].chunks(LANES).enumerate() {
            let mut places = [0.0; LANES];
            for (to, place) in places.iter_mut().zip(eight) {
                *to = f64::from(*place);
            }
            light(first * LANES, &plane.points_at(x, y, &places, kernel));
        }
    }

    /// The bytes of shades in 8.8 that are linear between those at the knots.
    pub(super) fn fill(&self, knots: &[u16; KNOTS], thresholds: &[u8; 8], column: usize, piece: &mut [u8]) {
        for (i, piece) in piece.chunks_mut(self.apart).enumerate() {
            let (from, to) = (i32::from(knots[i]), i32::from(knots[i + 1]));
            let pixels = self.places[i + 1] - self.places[i];
            // In 1/256 of a shade's unit. Rounded toward zero: no sum goes beyond `to`.
            let step = if pixels == 0 { 0 } else { ((to - from) << 8) / pixels };
            for (eight, bytes) in piece.chunks_mut(LANES).enumerate() {
                // Below 16.
                let first = (eight * LANES) as i32;
                let mut shades: Lanes<u16> = [0; LANES];
                for (k, shade) in (first..).zip(&mut shades) {
                    // Beyond the knot anything, which is not used.
                    *shade = (from + ((step * k) >> 8)) as u16;
                }
                to_bytes(&shades, thresholds, column + i * self.apart + eight * LANES, bytes);
            }
        }
    }
}
