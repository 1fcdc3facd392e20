//! One pixel drawn by itself, stage by stage.
//!
//! Nothing that drawing computes is recomputed here: the rasterizer draws a face clipped to the pixel, and the byte of
//! a stage is what it draws with the later stages removed.

use core::cell::{Cell, RefCell};
use core::fmt;

use mode13h::internals::DrawnTriangle;
use mode13h::internals::lanes::{LANES, Lanes, Points};
use mode13h::internals::raster::effects::{
    Attributes, Mix, PixelLighting, PixelPipeline, SampleSpacing, ShadeSource, TextureStage,
};
use mode13h::internals::span::dither::Thresholds;
use mode13h::internals::span::texture::{Levels, Texels};
use mode13h::palette::Lut64K;
use mode13h::raster::{DrawStats, Frame, Raster, Rect, Vertex};
use mode13h::render::Screen;
use mode13h::span::Kernel;

/// The source of a face's shades.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub enum ShadedBy {
    /// The vertices' shades.
    #[default]
    Corners,
    /// A table of 256 × 256 normals.
    NormalTable,
    /// The light at the pixel.
    Light {
        /// The interpolated normal, not normalized, in object space.
        normal: [f32; 3],
        /// The point, in object space.
        position: [f32; 3],
        /// The shades in 8.8: one per channel, or the same three times.
        shades: [u16; 3],
    },
    /// Interpolated between two lit pixels of its row.
    BetweenLit {
        /// Greatest distance between the two.
        spacing: SampleSpacing,
        /// The shades in 8.8 at the one before it, or at the pixel itself: one per channel, or the same three times.
        before: [u16; 3],
        /// The shades at the next one.
        after: [u16; 3],
    },
    /// Quadratic on the screen through six lit points. Holds, for each corner, the shades in 8.8 there and then those
    /// at the midpoint of the opposite edge, for three channels or the first; they may be out of range.
    BetweenSix([[f32; 6]; 3]),
}

/// Output of a face's stages at a pixel.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(super) struct Bytes {
    pub(super) shaded_by: ShadedBy,
    pub(super) exact_cover: bool,
    /// One shade three times, or three channels.
    pub(super) shades: [u8; 3],
    pub(super) channels: bool,
    pub(super) texel: Option<u8>,
    /// Level of the image that the texel comes from; `None` for an image without levels.
    pub(super) level: Option<u8>,
    /// Threshold, then byte.
    pub(super) dithered: Option<(u8, u8)>,
    /// The three channels, each combined with that of the texel.
    pub(super) textured: Option<[u8; 3]>,
    pub(super) mixed: Option<u8>,
    /// Fog level, then byte.
    pub(super) fogged: Option<(u8, u8)>,
    /// Byte behind, then byte.
    pub(super) blended: Option<(u8, u8)>,
    pub(super) byte: u8,
}

/// A frame of which a single pixel is drawn.
pub(super) struct OnePixel {
    pub(super) screen: Screen,
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) kernel: Kernel,
    /// The frame's row that the pixel is in.
    pub(super) row: Vec<u8>,
}

impl OnePixel {
    /// The byte that `draw` leaves where `behind` was; `None` if it does not draw the pixel.
    pub(super) fn draw(&mut self, behind: u8, draw: impl FnOnce(&mut Raster<'_>) -> DrawStats) -> Option<u8> {
        let Screen { width, height, .. } = self.screen;
        let (x, y) = (self.x, self.y);
        *self.row.get_mut(x as usize)? = behind;
        let frame = Frame::band(&mut self.row, width, height, width as usize, y..y + 1).ok()?;
        let clip = Rect { x0: x, y0: y, x1: x + 1, y1: y + 1 };
        let mut raster = Raster::new(frame).with_clip(clip).with_kernel(self.kernel);
        let drawn = draw(&mut raster);
        if drawn.pixels == 0 { None } else { self.row.get(x as usize).copied() }
    }

    /// The byte of a face drawn with some stages of its pixel pipeline removed.
    fn look(&mut self, met: (&[Vertex; 3], &[Attributes; 3]), behind: u8, look: &PixelPipeline<'_>) -> u8 {
        self.draw(behind, |raster| raster.triangle_with_effects(met.0, met.1, look)).unwrap_or(behind)
    }
}

/// A light query: eight points, and the shades of each on three channels.
type Query = (Points, [Lanes<u16>; 3]);

/// Light by a function of eight points and of whether three channels are asked for.
struct LightBy<F>(F);

impl<F> fmt::Debug for LightBy<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("LightBy")
    }
}

impl<F: Fn(&Points, bool) -> [Lanes<u16>; 3]> PixelLighting for LightBy<F> {
    fn shades(&self, points: &Points) -> Lanes<u16> {
        (self.0)(points, false)[0]
    }

    fn channels(&self, points: &Points) -> [Lanes<u16>; 3] {
        (self.0)(points, true)
    }
}

/// Records every light query.
fn noted<'a>(light: &'a dyn PixelLighting, all: &'a RefCell<Vec<Query>>) -> impl PixelLighting + 'a {
    LightBy(move |points: &Points, in_color| {
        let shades = if in_color { light.channels(points) } else { [light.shades(points); 3] };
        all.borrow_mut().push((*points, shades));
        shades
    })
}

/// Eight points numbered from `first`: each gets its number as its shade, in whole shades.
fn numbers(first: u16) -> [Lanes<u16>; 3] {
    [core::array::from_fn(|lane| (first + lane as u16) << 8); 3]
}

impl OnePixel {
    /// Applies a face's stages to the pixel, over the byte `behind`.
    pub(super) fn bytes(&mut self, triangle: &DrawnTriangle<'_>, behind: u8, scan_line: bool) -> Bytes {
        let plain =
            |shade: u8, exact_cover: bool| Bytes { exact_cover, shades: [shade; 3], byte: shade, ..Bytes::default() };
        let DrawnTriangle { vertices, interpolation, effects, .. } = *triangle;
        if let Some(effects) = effects {
            return stages(effects.pipeline, (vertices, effects.attributes), self, behind, plain(behind, true));
        }
        // The scan-line method finds the pixels itself, and uses only a shading's shades.
        let byte = if scan_line {
            let pipeline = PixelPipeline { source: ShadeSource::Shaded(interpolation), ..PixelPipeline::PLAIN };
            self.look((vertices, &Default::default()), behind, &pipeline)
        } else {
            self.draw(behind, |raster| raster.triangle(vertices, interpolation)).unwrap_or(behind)
        };
        plain(byte, scan_line || interpolation.has_exact_cover())
    }
}

/// Applies each stage of a pixel pipeline to the pixel.
fn stages(
    look: &PixelPipeline<'_>,
    met: (&[Vertex; 3], &[Attributes; 3]),
    pixel: &mut OnePixel,
    behind: u8,
    mut made: Bytes,
) -> Bytes {
    let bare = PixelPipeline { dither: None, texture: None, fog: None, blend: None, ..*look };
    let single = PixelPipeline { channels: None, ..bare };
    made.channels = look.channels.is_some();
    let mut channels = |look: PixelPipeline<'_>| {
        [0, 1, 2].map(|i| pixel.look(met, behind, &PixelPipeline { channels: Some(Mix::Only(i)), ..look }))
    };
    made.shades = if made.channels { channels(bare) } else { [0; 3] };
    made.textured =
        look.texture.filter(|_| made.channels).map(|_| channels(PixelPipeline { texture: look.texture, ..bare }));
    if !made.channels {
        made.shades = [pixel.look(met, behind, &bare); 3];
    }
    match look.source {
        ShadeSource::Curved(_) => made.shaded_by = ShadedBy::BetweenSix(met.1.map(|corner| corner.lit)),
        ShadeSource::NormalTable(_) => made.shaded_by = ShadedBy::NormalTable,
        ShadeSource::Lit(light) => {
            let all = RefCell::default();
            pixel.look(met, behind, &PixelPipeline { source: ShadeSource::Lit(&noted(light, &all)), ..bare });
            // Shows which of eight points is the pixel's.
            let numbered = LightBy(|_: &Points, _| numbers(0));
            let lane =
                usize::from(pixel.look(met, behind, &PixelPipeline { source: ShadeSource::Lit(&numbered), ..single }));
            if let Some((points, shades)) = all.borrow().last() {
                // Below 8.
                let [nx, ny, nz, x, y, z] = points.map(|of| of[lane]);
                let shades = shades.map(|of| of[lane]);
                made.shaded_by = ShadedBy::Light { normal: [nx, ny, nz], position: [x, y, z], shades };
            }
        }
        ShadeSource::LitEvery(apart, light) => {
            let all = RefCell::default();
            let source = ShadeSource::LitEvery(apart, &noted(light, &all));
            pixel.look(met, behind, &PixelPipeline { source, ..bare });
            // With numbers for shades, its shade rounded down is the number of the lit pixel before it.
            let count = Cell::new(0);
            // At most 24.
            let counted = LightBy(|_: &Points, _| numbers(count.replace(count.get() + LANES as u16)));
            let source = ShadeSource::LitEvery(apart, &counted);
            let numbered = PixelPipeline { source, dither: Some(Thresholds::ZEROS), ..single };
            let place = usize::from(pixel.look(met, behind, &numbered));
            let lanes = |(_, channels): Query| (0..LANES).map(move |lane| channels.map(|of| of[lane]));
            let all: Vec<[u16; 3]> = all.take().into_iter().flat_map(lanes).collect();
            let of = |place: usize| all.get(place).or(all.last()).copied().unwrap_or_default();
            made.shaded_by = ShadedBy::BetweenLit { spacing: apart, before: of(place), after: of(place + 1) };
        }
        // Shades from the corners.
        _ => {}
    }
    // A table's row is a shade, a level or the new byte; its column is a texel or the byte behind.
    let columns = Lut64K::from_fn(|_, column| column);
    let rows = Lut64K::from_fn(|row, _| row);
    made.texel = look.texture.map(|texture| {
        let texture = TextureStage { tables: [columns.as_array(); 3], ..texture };
        pixel.look(met, behind, &PixelPipeline { texture: Some(texture), ..single })
    });
    made.level = look.texture.and_then(|texture| {
        // An image whose texels are the numbers of their levels.
        let (ubits, vbits) = (texture.texels.width().ilog2(), texture.texels.height().ilog2());
        texture.levels?;
        let zeros = vec![0; texture.texels.width() * texture.texels.height()];
        let all = Levels::length(ubits, vbits);
        let mut numbers = Vec::with_capacity(all);
        for (level, number) in (1..=Levels::deepest(ubits, vbits)).zip(1..) {
            let deeper = Levels::length(ubits.saturating_sub(level), vbits.saturating_sub(level));
            numbers.resize(all - deeper, number);
        }
        let texture = TextureStage {
            texels: Texels::new(&zeros, ubits, vbits).ok()?,
            levels: Some(Levels::new(&numbers, ubits, vbits).ok()?),
            tables: [columns.as_array(); 3],
            ..texture
        };
        Some(pixel.look(met, behind, &PixelPipeline { texture: Some(texture), ..single }))
    });
    let mut so_far = bare;
    if let Some(thresholds) = look.dither {
        so_far.dither = look.dither;
        // The pixel is in the frame.
        let threshold = thresholds.row(pixel.y as usize).at(pixel.x as usize);
        let byte = if made.channels { 0 } else { pixel.look(met, behind, &so_far) };
        made.dithered = Some((threshold, byte));
    }
    so_far.texture = look.texture;
    if look.texture.is_some() && !made.channels {
        made.textured = Some([pixel.look(met, behind, &so_far); 3]);
    }
    if made.channels {
        made.mixed = Some(pixel.look(met, behind, &so_far));
    }
    if look.fog.is_some() {
        let level = pixel.look(met, behind, &PixelPipeline { fog: Some(rows.as_array()), ..single });
        so_far.fog = look.fog;
        made.fogged = Some((level, pixel.look(met, behind, &so_far)));
    }
    made.byte = pixel.look(met, behind, look);
    if look.blend.is_some() {
        made.blended = Some((behind, made.byte));
    }
    made
}
