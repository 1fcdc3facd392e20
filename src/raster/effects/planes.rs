//! What is linear over a triangle, on the screen or on the face, beside shades: texture coordinates, and what light
//! needs; and the pixels that are lit where not all are.

use core::ops::Range;

use super::level::{self, LevelPlane};
use super::{Attributes, SampleSpacing, TextureMapping, TextureStage};
use crate::lanes::{LANES, Lanes, Points};
use crate::raster::cover::{Row, SortedTriangle};
use crate::raster::hyperbolic::Linear;
use crate::raster::paint::to_bytes;
use crate::raster::shade::RESEED;
use crate::raster::weights::Weights;
use crate::span::Kernel;
use crate::span::hyperbolic::floor_quotient;
use crate::span::texture::{Levels, Texels, fill_affine, fill_perspective};

/// Pixels in a piece.
pub(super) const PIECE: usize = RESEED as usize;

/// Pixels between two exact texture coordinates of [`TextureMapping::Every16`], and between two choices of a level.
const EVERY: usize = 16;

/// The most places in a piece that are lit for [`ShadeSource::LitEvery`], its end being one, and as many as are lit at once.
pub(super) const KNOTS: usize = (PIECE / SampleSpacing::Four.pixels() + 1).next_multiple_of(LANES);

/// Texture coordinates over a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct TexturePlane {
    numerators: [Linear; 2],
    /// The divisor. For affine mapping it is the area times 2ⁿ for level n, constant, so coordinates are the level's.
    denominator: Linear,
    /// What affine coordinates change by from one pixel to the next, rounded toward zero.
    steps: [u32; 2],
    /// Which level's texels are shown, if the image has several.
    level: Level,
}

/// The level of a mipmap that is shown.
#[derive(Clone, Copy, Debug)]
enum Level {
    /// One all over the face; 0 for an image without levels.
    OfFace(u32),
    /// One for every 16 pixels.
    OfPixels(LevelPlane),
}

impl TexturePlane {
    pub(super) fn new(
        triangle: &SortedTriangle,
        corners: [&Attributes; 3],
        mapping: TextureMapping,
        levels: Option<Levels<'_>>,
    ) -> Self {
        let affine = mapping == TextureMapping::Affine;
        let depths = if affine { [1; 3] } else { triangle.vertices.each_ref().map(|v| i128::from(v.depth().max(1))) };
        let numerators =
            [0, 1].map(|i| Linear::new(triangle, [0, 1, 2].map(|k| i128::from(corners[k].texture[i]) * depths[k])));
        let area = triangle.area();
        let level = match levels {
            None => Level::OfFace(0),
            Some(levels) if affine => Level::OfFace(level::of_face(&numerators, area, levels.last())),
            Some(_) => Level::OfPixels(LevelPlane::new(triangle, corners.map(|corner| corner.texture), depths)),
        };
        let size = if let Level::OfFace(level) = level { 1 << level } else { 1 };
        // The wrap is meant: in a row of two pixels or more the step is that of two coordinates; in a row of one
        // it is never used.
        let steps = numerators.map(|n| (n.per_column() / (i128::from(area) * size)) as u32);
        Self { numerators, denominator: Linear::new(triangle, depths.map(|depth| depth * size)), steps, level }
    }

    /// The texels from pixel `seed` on.
    pub(super) fn fill(
        &self,
        look: &TextureStage<'_>,
        levels: Option<Levels<'_>>,
        row: &Row,
        seed: i32,
        texels: &mut [u8],
    ) {
        match (&self.level, levels) {
            (_, None) => self.fill_level((look.texels, 0), look.mapping, row, seed, texels),
            (Level::OfFace(level), Some(levels)) => {
                let of_level = levels.get(*level).unwrap_or(look.texels);
                self.fill_level((of_level, 0), look.mapping, row, seed, texels);
            }
            (Level::OfPixels(plane), Some(levels)) => {
                self.fill_by_levels((plane, levels), look, row, seed, texels);
            }
        }
    }

    /// Fills `texels` from levels, one of which is chosen for every 16 pixels.
    /// The middle one of these decides, or the row's last inside the frame if that comes before, whatever the clip
    /// rectangle.
    #[inline(never)]
    fn fill_by_levels(
        &self,
        (plane, levels): (&LevelPlane, Levels<'_>),
        look: &TextureStage<'_>,
        row: &Row,
        seed: i32,
        texels: &mut [u8],
    ) {
        let mut chosen = [0; PIECE / EVERY];
        let chosen = &mut chosen[..texels.len().div_ceil(EVERY)];
        let across = plane.across(row.y);
        for (level, x) in chosen.iter_mut().zip((seed..).step_by(EVERY)) {
            let x = (x + EVERY as i32 / 2).min(row.last).max(x);
            *level = plane.at(across, x, self.denominator.at(x, row.y), levels.last());
        }
        let (mut x, mut rest) = (seed, texels);
        for alike in chosen.chunk_by(|a, b| a == b) {
            let part;
            (part, rest) = rest.split_at_mut((alike.len() * EVERY).min(rest.len()));
            let level = alike[0];
            let of_level = levels.get(level).unwrap_or(look.texels);
            self.fill_level((of_level, level), look.mapping, row, x, part);
            // At most 64.
            x += part.len() as i32;
        }
    }

    /// The texels of one level, from pixel `x` on. Coordinates are divided by 2^`shift`.
    fn fill_level(
        &self,
        (texels, shift): (Texels<'_>, u32),
        mapping: TextureMapping,
        row: &Row,
        mut x: i32,
        pixels: &mut [u8],
    ) {
        let y = row.y;
        match mapping {
            TextureMapping::Affine => {
                let ([u, v], [du, dv]) = (self.start(x, y), self.steps);
                fill_affine(pixels, texels, u, v, du, dv);
            }
            TextureMapping::Perspective => {
                let numerators = self.numerators.each_ref().map(|n| n.at(x, y));
                let steps = self.numerators.each_ref().map(Linear::per_column);
                let (d, dd) = (self.denominator.at(x, y), self.denominator.per_column());
                fill_perspective(pixels, texels, numerators, steps, d << shift, dd << shift);
            }
            TextureMapping::Every16 => {
                let at = |x: i32| self.at(x, y).map(|coordinate| coordinate >> shift);
                let mut from = at(x);
                for pixels in pixels.chunks_mut(EVERY) {
                    // The row's last pixel inside the frame, whatever the clip rectangle: beyond the
                    // triangle there may be no coordinates at all.
                    let next = (x + EVERY as i32).min(row.last).max(x);
                    let to = at(next);
                    let step = |i: usize| match next - x {
                        0 => 0,
                        // Both lie between the corners' coordinates. The wrap is meant: texels repeat.
                        pixels => (i64::from(to[i].wrapping_sub(from[i])) / i64::from(pixels)) as u32,
                    };
                    // The wrap is meant here, too.
                    fill_affine(pixels, texels, from[0] as u32, from[1] as u32, step(0), step(1));
                    (x, from) = (next, to);
                }
            }
        }
    }

    /// The coordinates at a pixel, rounded down; 16.16.
    fn at(&self, x: i32, y: i32) -> [i32; 2] {
        let d = self.denominator.at(x, y);
        // A mean of the corners' coordinates, so it fits in 32 bits.
        self.numerators.each_ref().map(|n| floor_quotient(n.at(x, y), d) as i32)
    }

    /// The coordinates at a pixel, rounded back toward where they come from, as shades are; 16.16.
    /// So no sum leaves the range of the corners.
    fn start(&self, x: i32, y: i32) -> [u32; 2] {
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
    /// The values of each corner times its depth, then its depth.
    values: [[f64; 7]; 3],
    /// What their sum changes by from one pixel to the next.
    step: ([f64; 6], f64),
}

impl LitPlane {
    pub(super) fn new(triangle: &SortedTriangle, corners: [&Attributes; 3]) -> Self {
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
    /// The lit pixels of a piece of `pixels` pixels from `seed` on.
    /// Where the row ends inside of the piece, its last pixel is lit, whatever the clip rectangle.
    pub(super) fn new(row: &Row, seed: i32, pixels: usize, apart: SampleSpacing) -> Self {
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
