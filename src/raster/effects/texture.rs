//! Texels: texture coordinates over a triangle, the level of a mipmap, and the bytes of the image along a row.

use super::level::{self, LevelPlane};
use super::pieces::{Bytes, Face, PIECE, Piece, Pieces};
use super::pipeline::{Attributes, TextureMapping, TextureStage};
use crate::raster::cover::SortedTriangle;
use crate::raster::hyperbolic::Linear;
use crate::span::hyperbolic::floor_quotient;
use crate::span::texture::{Levels, Texels, fill_affine, fill_perspective};

/// Pixels between two exact texture coordinates of [`TextureMapping::Every16`], and between two choices of a level.
const EVERY: usize = 16;

/// The mappings as constants of the loops, so that no piece asks which it is.
const AFFINE: u8 = TextureMapping::Affine as u8;
const EVERY_16: u8 = TextureMapping::Every16 as u8;
const PERSPECTIVE: u8 = TextureMapping::Perspective as u8;

impl Pieces {
    /// The texels of every piece, from the levels of the image where there are any.
    pub(super) fn texels(
        &self,
        faces: &[Face],
        (stage, levels): (&TextureStage<'_>, Option<Levels<'_>>),
        out: &mut [Bytes],
    ) {
        match stage.mapping {
            TextureMapping::Affine => self.texels_by::<AFFINE>(faces, (stage, levels), out),
            TextureMapping::Every16 => self.texels_by::<EVERY_16>(faces, (stage, levels), out),
            TextureMapping::Perspective => self.texels_by::<PERSPECTIVE>(faces, (stage, levels), out),
        }
    }

    /// A function for each, so that none is compiled otherwise where another is left out.
    #[inline(never)]
    fn texels_by<const MAPPING: u8>(
        &self,
        faces: &[Face],
        (stage, levels): (&TextureStage<'_>, Option<Levels<'_>>),
        out: &mut [Bytes],
    ) {
        let image = stage.texels;
        let plane = |triangle: &SortedTriangle, corners| TexturePlane::new(triangle, corners, stage.mapping, levels);
        let Some(levels) = levels else {
            return self.each(faces, out, plane, |plane, piece, texels| {
                plane.fill_level::<MAPPING>((image, 0), piece, piece.seed, &mut texels[..piece.len()]);
            });
        };
        self.each(faces, out, plane, |plane, piece, texels| {
            let texels = &mut texels[..piece.len()];
            match &plane.level {
                Level::OfFace(level) => {
                    let of_level = levels.get(*level).unwrap_or(image);
                    plane.fill_level::<MAPPING>((of_level, 0), piece, piece.seed, texels);
                }
                Level::OfPixels(of_pixels) => {
                    plane.fill_by_levels::<MAPPING>((of_pixels, levels), image, piece, texels);
                }
            }
        });
    }
}

/// Texture coordinates over a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct TexturePlane {
    numerators: [Linear; 2],
    /// The divisor. For affine mapping it is the area times 2ⁿ for level n, constant, so coordinates are the level's.
    denominator: Linear,
    /// Change of affine coordinates from one pixel to the next, rounded toward zero.
    steps: [u32; 2],
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

    /// Fills `texels` from levels, one of which is chosen for every 16 pixels.
    /// The middle one of these decides, or the row's last inside the frame if that comes before, whatever the clip
    /// rectangle.
    #[inline(never)]
    fn fill_by_levels<const MAPPING: u8>(
        &self,
        (plane, levels): (&LevelPlane, Levels<'_>),
        image: Texels<'_>,
        piece: &Piece,
        texels: &mut [u8],
    ) {
        let (row, seed) = (&piece.row, piece.seed);
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
            let of_level = levels.get(level).unwrap_or(image);
            self.fill_level::<MAPPING>((of_level, level), piece, x, part);
            // At most 64.
            x += part.len() as i32;
        }
    }

    /// The texels of one level, from pixel `x` on. Coordinates are divided by 2^`shift`.
    #[inline]
    fn fill_level<const MAPPING: u8>(
        &self,
        (texels, shift): (Texels<'_>, u32),
        piece: &Piece,
        mut x: i32,
        pixels: &mut [u8],
    ) {
        let y = piece.row.y;
        match MAPPING {
            AFFINE => {
                let ([u, v], [du, dv]) = (self.start(x, y), self.steps);
                fill_affine(pixels, texels, u, v, du, dv);
            }
            PERSPECTIVE => {
                let numerators = self.numerators.each_ref().map(|n| n.at(x, y));
                let steps = self.numerators.each_ref().map(Linear::per_column);
                let (d, dd) = (self.denominator.at(x, y), self.denominator.per_column());
                fill_perspective(pixels, texels, numerators, steps, d << shift, dd << shift);
            }
            _ => {
                let at = |x: i32| self.at(x, y).map(|coordinate| coordinate >> shift);
                let mut from = at(x);
                for pixels in pixels.chunks_mut(EVERY) {
                    // The row's last pixel inside the frame, whatever the clip rectangle: beyond the
                    // triangle there may be no coordinates at all.
                    let next = (x + EVERY as i32).min(piece.row.last).max(x);
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
