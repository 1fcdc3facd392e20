//! Triangles with effects: a row is made in pieces of up to 64 bytes, which pass through stages.
//!
//! ```text
//! shades     as a shading has them, from a table of normals, or lit at every pixel
//! texture    shade and texel, of a level of the image, looked up in a table; or red, green and blue mixed to an index
//! fog        level and index looked up
//! blend      index and what the frame holds looked up
//! write      all of it, or where nearer
//! ```
//!
//! A stage that a [`PixelPipeline`] does not have is not entered. Pieces begin at the row's first covered pixel
//! inside the frame and every 64 pixels from there, where every value is exact; so a pixel's byte
//! depends on no clip rectangle. Without any effect [`Raster::triangle`] gives the same bytes sooner.
//!
//! Shades and channels are what the [`Interpolation`] makes of them; fog and the table's normals are linear, started anew
//! with every piece, whatever the shading, and keep the guarantees of [`shade`](super::shade): no sum leaves the
//! range of the three corners. With dither, whose threshold of 0 to 255 takes the place of the half, a byte
//! lies in [min >> 8, ⌈max⌉].

mod curve;
mod level;
mod pipeline;
mod planes;
mod small;

use core::ops::Range;

use self::curve::CurvePlane;
pub use self::pipeline::{
    Attributes, Lighting, Limits, Mix, PixelPipeline, SampleSpacing, ShadeSource, TextureMapping, TextureStage,
};
use self::planes::{KNOTS, Knots, LitPlane, PIECE, TexturePlane};
use super::cover::{Row, SortedTriangle};
use super::depth::{Cell, DepthPlane};
use super::draw_stats::DrawStats;
use super::interpolation::Interpolation;
use super::paint::{RowShader, to_bytes};
use super::shade::{RESEED, ShadePlane};
use super::triangle::Raster;
use super::vertex::Vertex;
use crate::fixed::U8F8;
use crate::lanes::LANES;
use crate::span::channels::{mix_cube, mix_nearest};
use crate::span::depth::{copy_before, copy_nearer};
use crate::span::{Kernel, lookup};

/// A half for every pixel: no dither.
const HALVES: [[u8; 8]; 8] = [[128; 8]; 8];

/// The values of one triangle that its look uses.
#[derive(Clone, Copy, Debug)]
enum Planes {
    Shade(RowShader),
    Channels([RowShader; 3]),
    Slope([ShadePlane; 2]),
    Lit(LitPlane),
    Curved(CurvePlane),
}

/// A triangle and its look, ready to be painted row by row.
#[derive(Clone, Copy, Debug)]
pub(super) struct EffectPaint<'a> {
    look: &'a PixelPipeline<'a>,
    planes: Planes,
    texture: Option<TexturePlane>,
    fog: Option<ShadePlane>,
}

/// Calls `body` with constants that say which stages a look has: chosen once, not for every piece of a row.
/// The first: shades are linear and nothing else.
macro_rules! by_stages {
    ($look:expr, |$plain:ident, $fog:ident, $blends:ident| $body:expr) => {
        match ($look.is_plain(), $look.fog().is_some(), $look.blend().is_some()) {
            (false, false, false) => by_stages!(@ $plain $fog $blends, false, false, false, $body),
            (false, false, true) => by_stages!(@ $plain $fog $blends, false, false, true, $body),
            (false, true, false) => by_stages!(@ $plain $fog $blends, false, true, false, $body),
            (false, true, true) => by_stages!(@ $plain $fog $blends, false, true, true, $body),
            (true, false, false) => by_stages!(@ $plain $fog $blends, true, false, false, $body),
            (true, false, true) => by_stages!(@ $plain $fog $blends, true, false, true, $body),
            (true, true, false) => by_stages!(@ $plain $fog $blends, true, true, false, $body),
            (true, true, true) => by_stages!(@ $plain $fog $blends, true, true, true, $body),
        }
    };
    (@ $plain:ident $fog:ident $blends:ident, $a:literal, $b:literal, $c:literal, $body:expr) => {{
        const $plain: bool = $a;
        const $fog: bool = $b;
        const $blends: bool = $c;
        $body
    }};
}

/// Rows of 64 bytes.
type Piece = [u8; PIECE];

/// The attributes of a triangle's corners from top to bottom, of one that is not degenerate.
fn corners<'a>(
    triangle: &SortedTriangle,
    vertices: &[Vertex; 3],
    attributes: &'a [Attributes; 3],
) -> [&'a Attributes; 3] {
    // No two corners of a triangle that has area are in one place.
    triangle.vertices.each_ref().map(|corner| {
        let same = |v: &Vertex| v.x() == corner.x() && v.y() == corner.y();
        &attributes[vertices.iter().position(same).unwrap_or(0)]
    })
}

impl<'a> EffectPaint<'a> {
    /// The paint of a triangle that is not degenerate.
    /// `attributes` are in the order of `vertices`, from which `triangle` was made.
    pub(super) fn new(
        triangle: &SortedTriangle,
        vertices: &[Vertex; 3],
        attributes: &[Attributes; 3],
        look: &'a PixelPipeline<'a>,
    ) -> Self {
        let corners = corners(triangle, vertices, attributes);
        let values = |value: &dyn Fn(&Attributes) -> U8F8| corners.map(|corner| i64::from(value(corner).to_bits()));
        let plane = |value: fn(&Attributes) -> U8F8| ShadePlane::of_values(triangle, values(&value));
        let channels = |interpolation| {
            Planes::Channels(
                [0, 1, 2].map(|i| RowShader::of_values(triangle, values(&|c| c.channels[i]), interpolation)),
            )
        };
        let planes = match (look.source, look.channels()) {
            (ShadeSource::Lit(_) | ShadeSource::LitEvery(..), _) => Planes::Lit(LitPlane::new(triangle, corners)),
            (ShadeSource::Curved(limits), channels) => {
                Planes::Curved(CurvePlane::new(triangle, corners, limits, if channels.is_some() { 3 } else { 1 }))
            }
            (ShadeSource::Shaded(interpolation), None) => Planes::Shade(RowShader::new(triangle, interpolation)),
            (ShadeSource::Shaded(interpolation), Some(_)) => channels(interpolation),
            (ShadeSource::NormalTable(_), Some(_)) => channels(Interpolation::default()),
            (ShadeSource::NormalTable(_), None) => Planes::Slope([plane(|c| c.slope[0]), plane(|c| c.slope[1])]),
        };
        let texture =
            look.texture().map(|texture| TexturePlane::new(triangle, corners, texture.mapping, look.levels()));
        Self { look, planes, texture, fog: look.fog().map(|_| plane(|c| c.fog)) }
    }

    /// Paints `row` into `pixels`, the frame's whole row; if there are `depths`, the buffer's whole row,
    /// where it is nearer.
    pub(super) fn row<D: Cell>(
        &self,
        row: &Row,
        pixels: &mut [u8],
        depths: Option<(&mut [D], &DepthPlane)>,
        kernel: Kernel,
        drawn: &mut DrawStats,
    ) {
        by_stages!(self.look, |PLAIN, FOG, BLENDS| {
            self.pieces::<D, PLAIN, FOG, BLENDS>(row, pixels, depths, kernel, drawn)
        })
    }

    /// The pieces of a row. `PLAIN`: shades are linear and nothing else.
    #[inline]
    fn pieces<D: Cell, const PLAIN: bool, const FOG: bool, const BLENDS: bool>(
        &self,
        row: &Row,
        pixels: &mut [u8],
        mut depths: Option<(&mut [D], &DepthPlane)>,
        kernel: Kernel,
        drawn: &mut DrawStats,
    ) {
        let mut seed = row.origin + (row.x0 - row.origin) / RESEED * RESEED;
        let mut x = row.x0;
        while x < row.x1 {
            let end = row.x1.min(seed + RESEED);
            // From the seed on, of which the first may be outside of the clip rectangle.
            let mut bytes: Piece = [0; PIECE];
            let length = (end - seed) as usize;
            let skipped = (x - seed) as usize;
            let piece = &mut bytes[..length];
            match &self.planes {
                Planes::Shade(paint) if PLAIN => paint.piece(row, seed, piece, None, kernel),
                _ => self.shades(row, seed, piece, kernel),
            }
            if FOG && let (Some(fog), Some(table)) = (&self.fog, self.look.fog()) {
                let mut levels: Piece = [0; PIECE];
                kernel.fill(&mut levels[..length], fog.start(seed, row.y), fog.step());
                lookup(piece, &levels[..length], table);
            }
            // Columns of a frame.
            let range = x as usize..end as usize;
            let Some(pixels) = pixels.get_mut(range.clone()) else { return };
            let piece = &mut piece[skipped..];
            if BLENDS && let Some(table) = self.look.blend() {
                // The table's row is the triangle's own index.
                let mut behind: Piece = [0; PIECE];
                let behind = &mut behind[..pixels.len()];
                behind.copy_from_slice(pixels);
                lookup(behind, piece, table);
                piece.copy_from_slice(behind);
            }
            drawn.spans += 1;
            write(range, pixels, piece, row.y, &mut depths, self.look.keeps_depth, drawn);
            seed += RESEED;
            x = end;
        }
    }

    /// Counts what was done to so many pixels, whatever the depth test said of them.
    fn count(&self, pixels: u32, drawn: &mut DrawStats) {
        let add = |on: bool, count: &mut u32| *count += if on { pixels } else { 0 };
        add(self.look.texture().is_some(), &mut drawn.textured);
        add(self.look.levels().is_some(), &mut drawn.mipmapped);
        add(self.look.dither().is_some(), &mut drawn.dithered);
        add(self.look.fog().is_some(), &mut drawn.fogged);
        add(self.look.blend().is_some(), &mut drawn.blended);
        add(self.look.channels().is_some(), &mut drawn.mixed);
        let by_table = matches!(self.planes, Planes::Slope(_));
        add(by_table || matches!(self.look.source, ShadeSource::Lit(_)), &mut drawn.lit);
    }

    /// The bytes from pixel `seed` on: shades, with their texture, or mixed.
    fn shades(&self, row: &Row, seed: i32, piece: &mut [u8], kernel: Kernel) {
        let thresholds = &self.look.dither().unwrap_or(&HALVES)[(row.y & 7) as usize];
        // A column.
        let column = seed as usize;
        let length = piece.len();
        match &self.planes {
            Planes::Shade(paint) => {
                paint.piece(row, seed, piece, self.look.dither().is_some().then_some(thresholds), kernel);
            }
            Planes::Slope([across, down]) => {
                let mut rows: Piece = [0; PIECE];
                kernel.fill(piece, across.start(seed, row.y), across.step());
                kernel.fill(&mut rows[..length], down.start(seed, row.y), down.step());
                if let ShadeSource::NormalTable(table) = self.look.source {
                    lookup(piece, &rows[..length], table);
                }
            }
            Planes::Channels(paints) => {
                let mut channels = [[0; PIECE]; 3];
                for (paint, channel) in paints.iter().zip(&mut channels) {
                    paint.piece(row, seed, &mut channel[..length], None, kernel);
                }
                return self.mix(row, seed, channels, thresholds, piece);
            }
            Planes::Lit(plane) => {
                if self.look.channels().is_some() {
                    let channels = self.lit_channels(plane, (row, seed), length, kernel);
                    return self.mix(row, seed, channels, thresholds, piece);
                }
                match self.look.source {
                    ShadeSource::Lit(lighting) => plane.points((seed, row.y), length, kernel, |pixels, points| {
                        let column = column + pixels.start;
                        to_bytes(&lighting.shades(points), thresholds, column, &mut piece[pixels]);
                    }),
                    ShadeSource::LitEvery(apart, lighting) => {
                        let (knots, mut lit) = (Knots::new(row, seed, length, apart), [0; KNOTS]);
                        knots.light(plane, (seed, row.y), kernel, |first, points| {
                            lit[first..first + LANES].copy_from_slice(&lighting.shades(points));
                        });
                        knots.fill(&lit, thresholds, column, piece);
                    }
                    _ => {}
                }
            }
            Planes::Curved(plane) => {
                let mut shades = [0; PIECE];
                if self.look.channels().is_some() {
                    let mut channels = [[0; PIECE]; 3];
                    for (i, channel) in channels.iter_mut().enumerate() {
                        plane.fill((seed, row.y), i, &mut shades[..length], kernel);
                        to_bytes(&shades[..length], &HALVES[0], 0, &mut channel[..length]);
                    }
                    return self.mix(row, seed, channels, thresholds, piece);
                }
                plane.fill((seed, row.y), 0, &mut shades[..length], kernel);
                to_bytes(&shades[..length], thresholds, column, piece);
            }
        }
        if let Some(texture) = self.look.texture() {
            let mut texels: Piece = [0; PIECE];
            let texels = &mut texels[..length];
            self.texels(row, seed, texels);
            lookup(texels, piece, texture.tables[0]);
            piece.copy_from_slice(texels);
        }
    }

    /// Red, green and blue of a piece that is lit.
    fn lit_channels(&self, plane: &LitPlane, (row, seed): (&Row, i32), length: usize, kernel: Kernel) -> [Piece; 3] {
        let mut channels = [[0; PIECE]; 3];
        match self.look.source {
            ShadeSource::Lit(lighting) => plane.points((seed, row.y), length, kernel, |pixels, points| {
                for (shades, channel) in lighting.channels(points).iter().zip(&mut channels) {
                    to_bytes(shades, &HALVES[0], 0, &mut channel[pixels.clone()]);
                }
            }),
            ShadeSource::LitEvery(apart, lighting) => {
                let (knots, mut lit) = (Knots::new(row, seed, length, apart), [[0; KNOTS]; 3]);
                knots.light(plane, (seed, row.y), kernel, |first, points| {
                    for (lit, shades) in lit.iter_mut().zip(lighting.channels(points)) {
                        lit[first..first + LANES].copy_from_slice(&shades);
                    }
                });
                for (lit, channel) in lit.iter().zip(&mut channels) {
                    knots.fill(lit, &HALVES[0], 0, &mut channel[..length]);
                }
            }
            _ => {}
        }
        channels
    }

    /// Channels to indices, through the texture if there is one.
    fn mix(&self, row: &Row, seed: i32, mut channels: [Piece; 3], thresholds: &[u8; 8], piece: &mut [u8]) {
        let length = piece.len();
        if let Some(texture) = self.look.texture() {
            let mut texels: Piece = [0; PIECE];
            self.texels(row, seed, &mut texels[..length]);
            for (channel, table) in channels.iter_mut().zip(texture.tables) {
                let mut shown = texels;
                lookup(&mut shown[..length], &channel[..length], table);
                *channel = shown;
            }
        }
        let [red, green, blue] = channels.each_ref().map(|channel| &channel[..length]);
        // A column.
        let column = seed as usize;
        match self.look.channels() {
            Some(Mix::Nearest { map, spread }) => {
                mix_nearest(piece, red, green, blue, thresholds, column, spread, map);
            }
            Some(Mix::Only(channel)) => piece.copy_from_slice([red, green, blue][channel.min(2)]),
            _ => mix_cube(piece, red, green, blue, thresholds, column),
        }
    }

    /// The texels from pixel `seed` on.
    fn texels(&self, row: &Row, seed: i32, texels: &mut [u8]) {
        if let (Some(look), Some(plane)) = (self.look.texture(), &self.texture) {
            plane.fill(look, self.look.levels(), row, seed, texels);
        }
    }
}

/// Writes a piece, all of it or where it is nearer.
fn write<D: Cell>(
    range: Range<usize>,
    pixels: &mut [u8],
    piece: &[u8],
    y: i32,
    depths: &mut Option<(&mut [D], &DepthPlane)>,
    keeps_depth: bool,
    drawn: &mut DrawStats,
) {
    let Some((depths, plane)) = depths else {
        pixels.copy_from_slice(piece);
        // At most 64.
        drawn.pixels += pixels.len() as u32;
        return;
    };
    // A column.
    let z = plane.fixed_at(range.start as i32, y);
    let Some(depths) = depths.get_mut(range) else { return };
    drawn.tested += pixels.len() as u32;
    drawn.pixels += if keeps_depth {
        copy_nearer(pixels, depths, piece, z, plane.step())
    } else {
        copy_before(pixels, depths, piece, z, plane.step())
    };
}

/// Paints one row of a triangle that another method found. Exact, as every row is.
#[inline(never)]
pub(crate) fn paint_row(
    vertices: &[Vertex; 3],
    attributes: &[Attributes; 3],
    look: &PixelPipeline<'_>,
    row: &Row,
    pixels: &mut [u8],
    kernel: Kernel,
    drawn: &mut DrawStats,
) {
    let triangle = SortedTriangle::new(vertices);
    let paint = EffectPaint::new(&triangle, vertices, attributes, look);
    paint.row::<u32>(row, pixels, None, kernel, drawn);
    paint.count((row.x1 - row.x0) as u32, drawn);
}

impl<D: Cell> Raster<'_, D> {
    /// Draws a triangle with effects. The order of the corners and their winding make no difference; a
    /// triangle without area draws nothing.
    #[doc(hidden)]
    pub fn triangle_with_effects(
        &mut self,
        vertices: &[Vertex; 3],
        attributes: &[Attributes; 3],
        look: &PixelPipeline<'_>,
    ) -> DrawStats {
        self.draw_effects::<true>(vertices, attributes, look)
    }

    /// Draws a triangle that lies wholly inside the frame, with effects.
    ///
    /// What lies outside is treated as by [`triangle_inside`](Self::triangle_inside).
    #[doc(hidden)]
    pub fn triangle_with_effects_inside(
        &mut self,
        vertices: &[Vertex; 3],
        attributes: &[Attributes; 3],
        look: &PixelPipeline<'_>,
    ) -> DrawStats {
        self.draw_effects::<false>(vertices, attributes, look)
    }

    fn draw_effects<const CLIPS: bool>(
        &mut self,
        vertices: &[Vertex; 3],
        attributes: &[Attributes; 3],
        look: &PixelPipeline<'_>,
    ) -> DrawStats {
        by_stages!(look, |PLAIN, FOG, BLENDS| {
            self.draw_stages::<CLIPS, PLAIN, FOG, BLENDS>(vertices, attributes, look)
        })
    }

    #[inline(never)]
    fn draw_stages<const CLIPS: bool, const PLAIN: bool, const FOG: bool, const BLENDS: bool>(
        &mut self,
        vertices: &[Vertex; 3],
        attributes: &[Attributes; 3],
        look: &PixelPipeline<'_>,
    ) -> DrawStats {
        let triangle = SortedTriangle::new(vertices);
        if !PLAIN
            && !FOG
            && !BLENDS
            && let Some(lighting) = look.lit_alone()
            && small::is_narrow(vertices)
        {
            return self.draw_small_lit::<CLIPS>(&triangle, (vertices, attributes), (look, lighting));
        }
        let mut drawn = DrawStats::default();
        let (mut paint, mut plane) = (None, None);
        let (width, clip) = (self.frame.width(), self.clip);
        let draw = |row: Row| {
            drawn.covered += (row.x1 - row.x0) as u32;
            let y = row.y as u32;
            let Some(pixels) = self.frame.row_mut(y) else { return };
            let paint = paint.get_or_insert_with(|| EffectPaint::new(&triangle, vertices, attributes, look));
            let depth = self.depth.as_mut().filter(|_| !cfg!(mode13h_leave_out = "hidden-surfaces"));
            let Some(depth) = depth else {
                return paint.pieces::<D, PLAIN, FOG, BLENDS>(&row, pixels, None, self.kernel, &mut drawn);
            };
            let Some(depths) = depth.row_mut(y) else { return };
            let plane = &*plane.get_or_insert_with(|| DepthPlane::new(&triangle));
            paint.pieces::<D, PLAIN, FOG, BLENDS>(&row, pixels, Some((depths, plane)), self.kernel, &mut drawn);
        };
        if CLIPS {
            triangle.rows(width, clip, draw)
        } else {
            triangle.rows_inside(draw)
        }
        if let Some(paint) = &paint {
            paint.count(drawn.covered, &mut drawn);
        }
        drawn
    }
}
