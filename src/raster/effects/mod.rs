//! Triangles with effects: textures, fog, glass, dither, three channels of light, light at every pixel.
//!
//! A [`PixelPipeline`] says what happens to the pixels of a triangle, by tables of 256 × 256 palette indices
//! ([`Lut64K`](crate::palette::Lut64K)); [`Attributes`] are the values of its corners beyond a
//! [`Vertex`](super::Vertex).
//!
//! ```
//! use mode13h::fixed::{I24F8, U8F8};
//! use mode13h::palette::{Lut64K, Palette};
//! use mode13h::raster::effects::{Attributes, EffectBatch, PixelPipeline, TextureStage};
//! use mode13h::raster::{Frame, Raster, Vertex};
//! use mode13h::settings::{DitherPattern, Mapping};
//! use mode13h::texture::Texture;
//!
//! let bricks: Texture = "bricks".parse()?;
//! let shades = Lut64K::shades(&Palette::default(), bricks.colors());
//! let texture = TextureStage::new(&bricks, &shades, Mapping::Affine);
//! let dither = DitherPattern::Ordered.thresholds();
//! let pipeline = PixelPipeline { texture: Some(texture), dither: Some(dither), ..PixelPipeline::PLAIN };
//!
//! // In full light; half of the image across, all of it up: row 0 is the lowest.
//! let corner = |x, y, u, v| -> Result<_, mode13h::raster::RasterError> {
//!     let vertex = Vertex::new(I24F8::from(x), I24F8::from(y), U8F8::MAX_VERTEX, 0)?;
//!     let [columns, rows] = [bricks.width(), bricks.height()].map(|texels| texels as i32);
//!     Ok((vertex, Attributes { texture: [u * columns << 15, v * rows << 16], ..Attributes::default() }))
//! };
//! let corners = [corner(8, 8, 0, 1)?, corner(56, 8, 1, 1)?, corner(8, 56, 0, 0)?];
//! let mut batch = EffectBatch::new();
//! batch.push(&corners.map(|(vertex, _)| vertex), &corners.map(|(_, attributes)| attributes));
//!
//! let mut bytes = [0; 64 * 64];
//! let drawn = Raster::new(Frame::new(&mut bytes, 64, 64, 64)?).batch_with_effects(&mut batch, &pipeline);
//! assert_eq!((drawn.textured, drawn.dithered), (1_128, 1_128));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The stages, any of which may be left out:
//!
//! ```text
//! shades     from the shading, from a table of normals, or lit at every pixel
//! texture    shade and texel, from a level of the image, looked up in a table; or red, green and blue mixed to an index
//! fog        level and index looked up
//! blend      index and the frame's index looked up
//! write      all pixels, or the nearer ones
//! ```
//!
//! Coverage is exact, as without effects. Faces are drawn in order, so each blends with what the ones before it left in
//! the frame. Without any effect [`Raster::triangle`] gives the same bytes faster.
//!
//! Shades and channels are interpolated as the [`Interpolation`](super::Interpolation) says; fog and the coordinates in
//! the table of normals are linear, reseeded every 64 pixels whatever the shading. No sum leaves the range of the three
//! corners. With dither, whose threshold of 0 to 255 replaces the half, a byte lies in [min >> 8, ⌈max⌉]. A pixel's
//! byte does not depend on the clip rectangle.

// Faces of one `PixelPipeline` are picked, set up and listed like plain ones, eight at a time. A face too large for
// that, and every face on a processor without f64, is walked row by row. `EffectBatch` takes faces given as vertices.
//
// A stage is one loop over up to 4,096 pixels of many faces, so a stage that the pipeline lacks costs one branch for
// all of them. Spans of up to 64 pixels begin at the row's first covered pixel inside the frame and every 64 pixels
// from there, where every value is exact.

mod batch;
mod curve;
mod destination;
mod direct;
mod fused;
mod listing;
mod lit;
mod pipeline;
#[cfg(all(test, feature = "std"))]
mod recorded;
mod shades;
mod spans;
mod texture;

use alloc::boxed::Box;
use alloc::vec::Vec;

pub use self::batch::{EffectBatch, EffectFace};
use self::listing::{EffectSpans, ListedFaces, SpanData};
pub use self::pipeline::{Limits, Mix, PixelLighting, PixelPipeline, SampleSpacing, ShadeSource, TextureStage};
use self::spans::{ROOM, Shaded, Spans};
use super::batches::{DrawArea, draw_triangles};
pub use super::columns::Attributes;
use super::columns::{PickedTriangles, Value};
use super::depth::Cell;
use super::draw_stats::DrawStats;
use super::pick::Pick;
use super::reference::cover::Row;
use super::triangle::Raster;
use crate::fixed::HAS_F64;
pub use crate::lanes::{Lanes, Points};
use crate::simd::{Lanes8, compiled_for_each_level};
use crate::span::list::{Span, SpanList};
use crate::span::target::{Target, Written};
pub use crate::span::texture::{Levels, Texels, TexelsError};
use crate::span::{Kernel, lookup, lookup_row};

/// Memory of the stages: planes of faces, and the data passed from stage to stage. Reusing it
/// allocates nothing.
#[derive(Clone, Debug, Default)]
pub(crate) struct EffectScratch {
    /// A list of spans with the stages' data about them; allocated when it is needed.
    lists: Option<Box<(SpanList, SpanData)>>,
    buffers: Buffers,
}

/// Output of the stages, a number for each pixel of all spans.
#[derive(Clone, Debug, Default)]
struct Buffers {
    /// The bytes that are finally drawn.
    bytes: Vec<u8>,
    /// The stage's second operand: texels, levels of fog, or rows of a table.
    other: Vec<u8>,
    /// Red, green and blue.
    channels: [Vec<u8>; 3],
    /// One shade in 8.8, or three channels.
    shades: [Vec<u16>; 3],
}

impl Buffers {
    /// Makes room for the maximum number of pixels.
    fn make_room(&mut self) {
        let Self { bytes, other, channels, shades } = self;
        for bytes in [bytes, other].into_iter().chain(channels) {
            bytes.resize(ROOM, 0);
        }
        for shades in shades {
            shades.resize(ROOM, 0);
        }
    }
}

impl EffectScratch {
    /// The memory, 120 kB, allocated the first time.
    #[inline]
    fn parts(&mut self) -> (&mut (SpanList, SpanData), &mut Buffers) {
        let Self { lists, buffers } = self;
        let is_first = lists.is_none();
        let lists = lists.get_or_insert_with(|| {
            buffers.make_room();
            Box::new((SpanList::NONE, SpanData::new()))
        });
        // Without f64, every face is walked.
        if HAS_F64 && is_first {
            lists.1.add_shaded();
        }
        (lists, buffers)
    }

    /// Paints one row of pick `k`, found by another method, into `pixels`, the frame's whole row.
    pub(crate) fn paint_row(
        &mut self,
        (triangles, k): (PickedTriangles<'_>, usize),
        pipeline: &PixelPipeline<'_>,
        row: &Row,
        pixels: &mut [u8],
        kernel: Kernel,
        drawn: &mut DrawStats,
    ) {
        let ((list, data), buffers) = self.parts();
        let mut target = Target { pixels, cells: None, kernel };
        list.begin(&target, [0; 2]);
        let mut spans = EffectSpans::new(triangles, pipeline, data, buffers);
        spans.walk(k, 0);
        spans.add_row(row, list, &mut target);
        spans.draw_spans(list, &mut target);
        let (spans, covered, _) = list.counts();
        // The caller has already counted the covered pixels.
        *drawn += DrawStats { spans, pixels: covered, ..DrawStats::default() };
        count(pipeline, covered, drawn);
    }
}

/// Counts the work done on this many pixels, whatever the depth test decided.
fn count(pipeline: &PixelPipeline<'_>, pixels: u32, drawn: &mut DrawStats) {
    let add = |on: bool, count: &mut u32| *count += if on { pixels } else { 0 };
    add(pipeline.texture().is_some(), &mut drawn.textured);
    add(pipeline.levels().is_some(), &mut drawn.mipmapped);
    add(pipeline.dither().is_some(), &mut drawn.dithered);
    add(pipeline.fog().is_some(), &mut drawn.fogged);
    add(pipeline.blend().is_some(), &mut drawn.blended);
    add(pipeline.channels().is_some(), &mut drawn.mixed);
    let by_table = matches!(pipeline.source, ShadeSource::NormalTable(_)) && pipeline.channels().is_none();
    add(by_table || matches!(pipeline.source, ShadeSource::Lit(_)), &mut drawn.lit);
}

/// Draws the spans of a list. Returns the number of nearer pixels.
#[inline(never)]
fn draw_listed(
    listed: &ListedFaces<'_>,
    list: &SpanList,
    pipeline: &PixelPipeline<'_>,
    buffers: &mut Buffers,
    target: &mut Target<'_>,
) -> u32 {
    if let Some(direct) = listed.direct
        && let Some(nearer) = direct.show(&Spans::all(listed, list), pipeline, target)
    {
        return nearer;
    }
    let (mut first, mut nearer) = (0, 0);
    let mut offsets = [0; SpanList::CAPACITY + 1];
    while first < list.count() {
        let spans = Spans::of(listed, list, first, &mut offsets);
        run_stages(&spans, pipeline, buffers, target.kernel);
        let (level, bytes) = (target.kernel.simd_level(), (&mut buffers.bytes[..], pipeline.blend()));
        nearer += write(level, &spans, bytes, target, pipeline.keeps_depth);
        first += spans.count();
    }
    nearer
}

/// Passes spans through the stages before blending, and leaves their bytes in the buffers.
#[inline(never)]
fn run_stages(spans: &Spans<'_>, pipeline: &PixelPipeline<'_>, buffers: &mut Buffers, kernel: Kernel) {
    spans.shade(buffers, pipeline, kernel);
    if let Some(table) = pipeline.fog() {
        let Buffers { bytes, other: levels, .. } = buffers;
        spans.fill(Shaded::linear(Value::Fog), levels, kernel);
        lookup(&mut bytes[..spans.pixels()], levels, table);
    }
}

compiled_for_each_level! {
    /// Writes spans, blended if there is a table; if there are cells, only where they are nearer. Returns the number of
    /// nearer pixels.
    #[inline(never)]
    fn write[][](
        spans: &Spans<'_>,
        bytes: (&mut [u8], Option<&[u8; 65_536]>),
        target: &mut Target<'_>,
        keeps: bool,
    ) -> u32 = write_by, up to AVX2;
}

#[inline(always)]
fn write_by<S: Lanes8>(
    s: S,
    spans: &Spans<'_>,
    (bytes, blend): (&mut [u8], Option<&[u8; 65_536]>),
    target: &mut Target<'_>,
    keeps: bool,
) -> u32 {
    let Some(table) = blend else {
        let of = (
            #[inline(always)]
            |i| {
                let (first, Span { at, length, .. }) = spans.drawn(i);
                Written { at, bytes: &bytes[first..], length: length as usize }
            },
            #[inline(always)]
            |i| spans.depth(i),
        );
        return target.write_each(s, 0..spans.count(), of, keeps);
    };
    let mut nearer = 0;
    for i in 0..spans.count() {
        let (first, Span { at, length, .. }) = spans.drawn(i);
        let (bytes, length) = (&mut bytes[first..], length as usize);
        if let Some(row) = target.pixels.get(at as usize..) {
            let n = bytes.len().min(length);
            lookup_row(&mut bytes[..n], row, table);
        }
        nearer += target.write(s, Written { at, bytes, length }, spans.depth(i), keeps);
    }
    nearer
}

compiled_for_each_level! {
    /// Draws triangles with effects; if there are cells, only their nearer pixels.
    #[inline(never)]
    fn draw_effects[][](
        of: PickedTriangles<'_>,
        effects: (&mut EffectSpans<'_>, &mut SpanList),
        area: DrawArea,
        target: &mut Target<'_>,
    ) -> DrawStats = draw_effects_by;
}

#[inline(always)]
fn draw_effects_by<S: Lanes8>(
    s: S,
    of: PickedTriangles<'_>,
    (spans, list): (&mut EffectSpans<'_>, &mut SpanList),
    area: DrawArea,
    target: &mut Target<'_>,
) -> DrawStats {
    draw_triangles::<S, _, true>(s, of, area, target, spans, list)
}

impl<D: Cell> Raster<'_, D> {
    /// Draws triangles that were picked inside the clip rectangle, in order, through one pixel pipeline.
    #[inline(never)]
    pub(crate) fn picks_with_effects(
        &mut self,
        triangles: PickedTriangles<'_>,
        pipeline: &PixelPipeline<'_>,
        scratch: &mut EffectScratch,
    ) -> DrawStats {
        let ((list, data), buffers) = scratch.parts();
        let (layout, clip, level) = (self.layout(), self.clip, self.kernel.simd_level());
        let fits = self.fits_lists();
        let mut drawn = DrawStats::default();
        let mut first = 0;
        let picks = triangles.picks.picks;
        while first < picks.len() {
            let together = if HAS_F64 && fits { Pick::count_batched(&picks[first..]) } else { 0 };
            if together > 0 {
                let of = triangles.range(first, first + together);
                let spans = &mut EffectSpans::new(of, pipeline, data, buffers);
                drawn += draw_effects(level, of, (spans, list), (layout, clip), &mut self.target());
                first += together;
                continue;
            }
            let mut spans = EffectSpans::new(triangles, pipeline, data, buffers);
            drawn += self.walk((&mut spans, list), first);
            first += 1;
        }
        count(pipeline, drawn.covered, &mut drawn);
        drawn
    }

    /// Draws face `k` row by row, walking down its edges.
    #[inline(never)]
    fn walk(&mut self, (spans, list): (&mut EffectSpans<'_>, &mut SpanList), k: usize) -> DrawStats {
        let (width, clip, kernel) = (self.frame.width(), self.clip, self.kernel);
        let mut depth = self.depth.as_mut().filter(|_| !cfg!(mode13h_leave_out = "hidden-surfaces"));
        let (has_depth, depth_base) = (depth.is_some(), depth.as_ref().map_or(0, |depth| depth.base));
        let (mut count, mut covered, mut nearer) = (0, 0, 0);
        spans.walk(k, depth_base).rows(width, clip, |row: Row| {
            // A row of the frame, so not negative.
            let y = row.y as u32;
            covered += (row.x1 - row.x0) as u32;
            let Some(pixels) = self.frame.starting_at(0, y) else { return };
            let cells = match &mut depth {
                None => None,
                Some(depth) => match depth.starting_at(0, y) {
                    None => return,
                    cells => cells,
                },
            };
            let mut target = Target { pixels, cells: cells.map(D::cells), kernel };
            list.begin(&target, [0; 2]);
            spans.add_row(&row, list, &mut target);
            spans.draw_spans(list, &mut target);
            let of_row = list.counts();
            (count, nearer) = (count + of_row.0, nearer + of_row.2);
        });
        DrawStats::of_spans((count, covered, nearer), has_depth)
    }
}
