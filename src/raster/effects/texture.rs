//! Texels: texture coordinates over a triangle, the level of a mipmap, and the bytes of the image along a row.

use super::level::{self, LevelPlane};
use super::pieces::{Bytes, Face, PIECE, Piece, Pieces};
use super::pipeline::{Attributes, TextureMapping, TextureStage};
use crate::fixed::{HAS_F64, nearest_whole};
use crate::raster::cover::SortedTriangle;
use crate::raster::weights::WholeWeights;
use crate::span::Kernel;
use crate::span::texture::{Levels, Shown, Texels, show_affine, show_estimated, show_perspective_portable};

/// Pixels between two exact texture coordinates of [`TextureMapping::Every16`], and between two choices of a level.
const EVERY: usize = EVERY_WHOLE as usize;
const EVERY_WHOLE: i32 = 16;

/// The mappings as constants of the loops, so that no piece asks which it is.
const AFFINE: u8 = TextureMapping::Affine as u8;
const EVERY_16: u8 = TextureMapping::Every16 as u8;
const PERSPECTIVE: u8 = TextureMapping::Perspective as u8;

impl Pieces {
    /// The texels of every piece, from the levels of the image where there are any, and what is shown of them.
    pub(super) fn texels(
        &self,
        shown: impl Shown,
        faces: &[Face],
        (stage, levels): (&TextureStage<'_>, Option<Levels<'_>>),
        out: &mut [Bytes],
        kernel: Kernel,
    ) {
        match stage.mapping {
            TextureMapping::Affine => self.texels_by::<AFFINE>(shown, faces, (stage, levels), out, kernel),
            TextureMapping::Every16 => self.texels_by::<EVERY_16>(shown, faces, (stage, levels), out, kernel),
            TextureMapping::Perspective => self.texels_by::<PERSPECTIVE>(shown, faces, (stage, levels), out, kernel),
        }
    }

    /// A function for each, so that none is compiled otherwise where another is left out.
    #[inline(never)]
    fn texels_by<const MAPPING: u8>(
        &self,
        shown: impl Shown,
        faces: &[Face],
        (stage, levels): (&TextureStage<'_>, Option<Levels<'_>>),
        out: &mut [Bytes],
        kernel: Kernel,
    ) {
        let image = stage.texels;
        let plane = |triangle: &SortedTriangle, corners| TexturePlane::new(triangle, corners, stage.mapping, levels);
        let Some(levels) = levels else {
            return self.each(faces, out, plane, |plane, piece, texels| {
                plane.fill_level::<MAPPING>(shown, (image, 0), piece, piece.seed, &mut texels[..piece.len()], kernel);
            });
        };
        self.each(faces, out, plane, |plane, piece, texels| {
            let texels = &mut texels[..piece.len()];
            match &plane.level {
                Level::OfFace(level) => {
                    let of_level = levels.get(*level).unwrap_or(image);
                    plane.fill_level::<MAPPING>(shown, (of_level, 0), piece, piece.seed, texels, kernel);
                }
                Level::OfPixels(of_pixels) => {
                    plane.fill_by_levels::<MAPPING>(shown, (of_pixels, levels), image, piece, texels, kernel);
                }
            }
        });
    }
}

/// Texture coordinates over a triangle.
///
/// ```text
/// u(x, y) = Σ λᵢ·dᵢ·uᵢ / Σ λᵢ·dᵢ
/// ```
///
/// with λ the [weights](WholeWeights) of the corners and d their depths; all dᵢ are 1 where coordinates are linear on the
/// screen. No λ is negative at a covered centre, so a numerator in f64 is off by at most 4 parts in 2⁵³ of 2³¹ · Σ λᵢ·dᵢ,
/// however much of it cancels, and u by less than 2⁻¹⁹.
#[derive(Clone, Copy, Debug)]
pub(super) struct TexturePlane {
    weights: WholeWeights,
    /// Each corner's coordinates and 1, times its depth: below 2⁶³.
    values: [[i64; 3]; 3],
    estimated: [[f64; 3]; 3],
    /// Σ λᵢ times 2ⁿ for level n, and its reciprocal: the divisor of affine coordinates, which are the level's.
    divisor: i64,
    reciprocal: f64,
    /// Change of affine coordinates from one pixel to the next, rounded toward zero.
    steps: [u32; 2],
    /// Where affine coordinates fall.
    falls: [bool; 2],
    /// Level whose texels are shown, if the image has several.
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

/// The sum over the corners of weights times values, exact.
#[inline]
fn exact(weights: [i64; 3], values: [i64; 3]) -> i128 {
    let product = |corner: usize| i128::from(weights[corner]) * i128::from(values[corner]);
    product(0) + product(1) + product(2)
}

/// Weights in f64, which is exact: they are at most 2⁴⁴.
#[inline]
fn in_f64([a, b, c]: [i64; 3]) -> [f64; 3] {
    if HAS_F64 { [a as f64, b as f64, c as f64] } else { [0.0; 3] }
}

/// The sum in f64.
#[inline]
fn estimate([wa, wb, wc]: [f64; 3], [a, b, c]: [f64; 3]) -> f64 {
    wa * a + wb * b + wc * c
}

/// The floor of a coordinate n / d, whose estimate is less than ½ off.
#[inline]
fn floor(estimate: f64, n: i128, d: i128) -> i64 {
    if !HAS_F64 {
        // A mean of coordinates.
        return n.div_euclid(d) as i64;
    }
    // The floor or the next number up.
    let near = nearest_whole(estimate);
    near - i64::from(n < i128::from(near) * d)
}

impl TexturePlane {
    pub(super) fn new(
        triangle: &SortedTriangle,
        corners: [&Attributes; 3],
        mapping: TextureMapping,
        levels: Option<Levels<'_>>,
    ) -> Self {
        let affine = mapping == TextureMapping::Affine;
        let depths = if affine { [1; 3] } else { triangle.vertices.each_ref().map(|v| i64::from(v.depth().max(1))) };
        let [u, v] = [0, 1].map(|i| [0, 1, 2].map(|k| i64::from(corners[k].texture[i]) * depths[k]));
        let weights = WholeWeights::new(triangle);
        let area = triangle.area();
        // Weights change by at most 2³⁰.
        let per_column = [u, v].map(|values| exact(weights.per_column(), values));
        let level = match levels {
            None => Level::OfFace(0),
            Some(levels) if affine => {
                let per_row = [u, v].map(|values| exact(weights.per_row(), values));
                Level::OfFace(level::of_face(per_column, per_row, area, levels.last()))
            }
            Some(_) => {
                let coordinates = corners.map(|corner| corner.texture);
                Level::OfPixels(LevelPlane::new(triangle, coordinates, depths.map(i128::from)))
            }
        };
        let divisor = if let Level::OfFace(level) = level { area << level } else { area };
        // Of affine coordinates below 2⁶³. The wrap is meant: in a row of two pixels or more the step is that of two
        // coordinates; in a row of one it is never used.
        let steps = if affine { per_column.map(|n| (n as i64 / divisor) as u32) } else { [0; 2] };
        let values = [u, v, depths];
        let estimated = values.map(|values| values.map(|value| if HAS_F64 { value as f64 } else { 0.0 }));
        let reciprocal = if HAS_F64 { 1.0 / divisor as f64 } else { 0.0 };
        Self { weights, values, estimated, divisor, reciprocal, steps, falls: per_column.map(|n| n < 0), level }
    }

    /// Fills `texels` from levels, one of which is chosen for every 16 pixels.
    /// The middle one of these decides, or the row's last inside the frame if that comes before, whatever the clip
    /// rectangle.
    #[inline(never)]
    fn fill_by_levels<const MAPPING: u8>(
        &self,
        shown: impl Shown,
        (plane, levels): (&LevelPlane, Levels<'_>),
        image: Texels<'_>,
        piece: &Piece,
        texels: &mut [u8],
        kernel: Kernel,
    ) {
        let (row, seed) = (&piece.row, piece.seed);
        let mut chosen = [0; PIECE / EVERY];
        let chosen = &mut chosen[..texels.len().div_ceil(EVERY)];
        let across = plane.across(row.y);
        for (level, x) in chosen.iter_mut().zip((seed..).step_by(EVERY)) {
            let x = (x + EVERY as i32 / 2).min(row.last).max(x);
            let denominator = exact(self.weights.at(x, row.y), self.values[2]);
            *level = plane.at(across, x, denominator, levels.last());
        }
        let (mut x, mut rest) = (seed, texels);
        for alike in chosen.chunk_by(|a, b| a == b) {
            let part;
            (part, rest) = rest.split_at_mut((alike.len() * EVERY).min(rest.len()));
            let level = alike[0];
            let of_level = levels.get(level).unwrap_or(image);
            self.fill_level::<MAPPING>(shown, (of_level, level), piece, x, part, kernel);
            // At most 64.
            x += part.len() as i32;
        }
    }

    /// The texels of one level, from pixel `x` on. Coordinates are divided by 2^`shift`.
    #[inline]
    fn fill_level<const MAPPING: u8>(
        &self,
        shown: impl Shown,
        (texels, shift): (Texels<'_>, u32),
        piece: &Piece,
        mut x: i32,
        pixels: &mut [u8],
        kernel: Kernel,
    ) {
        let y = piece.row.y;
        match MAPPING {
            AFFINE => {
                show_affine(shown, pixels, texels, [self.start(0, x, y), self.start(1, x, y)], self.steps);
            }
            PERSPECTIVE => self.fill_perspective(shown, (texels, shift), (x, y), pixels, kernel),
            _ => {
                let at = |x: i32| self.at(x, y).map(|coordinate| coordinate >> shift);
                let mut from = at(x);
                for pixels in pixels.chunks_mut(EVERY) {
                    // The row's last pixel inside the frame, whatever the clip rectangle: beyond the
                    // triangle there may be no coordinates at all.
                    let next = (x + EVERY as i32).min(piece.row.last).max(x);
                    let to = at(next);
                    let step = |i: usize| {
                        // The wrap is meant: texels repeat.
                        let change = to[i].wrapping_sub(from[i]);
                        match next - x {
                            0 => 0,
                            // A shift, and what makes it round toward zero.
                            EVERY_WHOLE => (change / EVERY_WHOLE) as u32,
                            // Not −2³¹ by −1.
                            pixels => (change / pixels) as u32,
                        }
                    };
                    // The wrap is meant here, too.
                    show_affine(shown, pixels, texels, [from[0] as u32, from[1] as u32], [step(0), step(1)]);
                    (x, from) = (next, to);
                }
            }
        }
    }

    /// The texels of one level, each at its exact place.
    #[inline(never)]
    fn fill_perspective(
        &self,
        shown: impl Shown,
        (texels, shift): (Texels<'_>, u32),
        (x, y): (i32, i32),
        pixels: &mut [u8],
        kernel: Kernel,
    ) {
        let (weights, step) = (self.weights.at(x, y), self.weights.per_column());
        if HAS_F64 {
            let [at, step] = [in_f64(weights), in_f64(step)];
            let [u, v, [d, dd]] = self.estimated.map(|values| [estimate(at, values), estimate(step, values)]);
            let size = f64::from(1_u32 << shift);
            if show_estimated(shown, kernel, pixels, texels, [u, v], [d * size, dd * size]) {
                return;
            }
        }
        let [u, v, [d, dd]] = self.values.map(|values| [exact(weights, values), exact(step, values)]);
        show_perspective_portable(shown, pixels, texels, [u, v], [d << shift, dd << shift]);
    }

    /// The coordinates at a pixel, rounded down; 16.16.
    #[inline]
    fn at(&self, x: i32, y: i32) -> [i32; 2] {
        let weights = self.weights.at(x, y);
        let of_f64 = in_f64(weights);
        let d = exact(weights, self.values[2]);
        let reciprocal = if HAS_F64 { 1.0 / estimate(of_f64, self.estimated[2]) } else { 0.0 };
        // A mean of the corners' coordinates, so it fits in 32 bits.
        let of = |i: usize| {
            floor(estimate(of_f64, self.estimated[i]) * reciprocal, exact(weights, self.values[i]), d) as i32
        };
        [of(0), of(1)]
    }

    /// An affine coordinate at a pixel, rounded back toward where it comes from, as shades are; 16.16.
    /// So no sum leaves the range of the corners.
    #[inline]
    fn start(&self, of: usize, x: i32, y: i32) -> u32 {
        let weights = self.weights.at(x, y);
        let bias = if self.falls[of] { self.divisor - 1 } else { 0 };
        let estimate = match HAS_F64 {
            true => (estimate(in_f64(weights), self.estimated[of]) + bias as f64) * self.reciprocal,
            false => 0.0,
        };
        floor(estimate, exact(weights, self.values[of]) + i128::from(bias), i128::from(self.divisor)) as u32
    }
}
