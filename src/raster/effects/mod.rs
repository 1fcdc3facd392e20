//! Triangles with effects: rows are cut into pieces of up to 64 bytes, and many pieces pass through each stage together.
//!
//! ```text
//! shades     as a shading has them, from a table of normals, or lit at every pixel
//! texture    shade and texel, of a level of the image, looked up in a table; or red, green and blue mixed to an index
//! fog        level and index looked up
//! blend      index and what the frame holds looked up
//! write      all of it, or where nearer
//! ```
//!
//! An [`EffectBatch`] holds faces of one [`PixelPipeline`]. They are culled as the triangles of a plain batch are, and the
//! rows of small ones inside the clip rectangle are found by the same set-up, eight faces at a time. The rows of others are
//! walked down: they are long, so finding them is little of their time.
//!
//! A stage is one loop over up to 64 pieces of the batch's faces, so a stage that the pipeline does not have costs one
//! question for all of them. Pieces are written in the order of their faces; so what one face leaves in the frame is what
//! the next one blends with. Pieces begin at the row's first covered pixel inside the frame and every 64 pixels from there,
//! where every value is exact; so a pixel's byte depends on no clip rectangle. Without any effect [`Raster::triangle`] gives
//! the same bytes sooner.
//!
//! Shades and channels are what the [`Interpolation`](super::Interpolation) makes of them; fog and the table's normals
//! are linear, started anew with every piece, whatever the shading, and keep the guarantees of [`shade`](super::shade): no
//! sum leaves the range of the three corners. With dither, whose threshold of 0 to 255 takes the place of the half, a
//! byte lies in [min >> 8, ⌈max⌉].

mod curve;
mod level;
mod lit;
mod pieces;
mod pipeline;
mod shades;
mod texture;

use alloc::vec::Vec;

use self::pieces::{Bytes, CAPACITY, Covered, Face, PIECE, Piece, Pieces, Shades, Sorted};
pub use self::pipeline::{
    Attributes, Lighting, Limits, Mix, PixelPipeline, SampleSpacing, ShadeSource, TextureMapping, TextureStage,
};
use super::batch::Batch;
use super::batch::found::{Finder, Found, index};
use super::cover::{Row, SortedTriangle};
use super::depth::{Cell, DepthBuffer, DepthPlane};
use super::draw_stats::DrawStats;
use super::frame::Frame;
use super::interpolation::Interpolation;
use super::shade::{RESEED, ShadePlane};
use super::triangle::Raster;
use super::vertex::Vertex;
use crate::simd::at_best_level;
use crate::span::{Kernel, lookup};

/// A half for every pixel: no dither.
const HALVES: [[u8; 8]; 8] = [[128; 8]; 8];

/// Faces that are drawn by one pixel pipeline, and room for their pieces. Filled and drawn again and again it allocates
/// nothing.
#[derive(Clone, Debug, Default)]
pub struct EffectBatch {
    faces: Vec<Face>,
    /// Their corners once more, as culling and set-up take them.
    corners: Batch,
    pieces: Pieces,
    buffers: Buffers,
}

/// Output of the stages for pieces: a row for each.
#[derive(Clone, Debug, Default)]
struct Buffers {
    /// The bytes that are drawn in the end.
    bytes: Vec<Bytes>,
    /// Texels, or levels of fog.
    other: Vec<Bytes>,
    /// Red, green and blue.
    channels: [Vec<Bytes>; 3],
    /// One shade in 8.8, or three channels.
    shades: [Vec<Shades>; 3],
}

impl Buffers {
    const EMPTY: Self = Self {
        bytes: Vec::new(),
        other: Vec::new(),
        channels: [const { Vec::new() }; 3],
        shades: [const { Vec::new() }; 3],
    };

    /// Makes room for as many pieces as there may be.
    fn make_room(&mut self) {
        self.bytes.resize(CAPACITY, [0; PIECE]);
        self.other.resize(CAPACITY, [0; PIECE]);
        self.channels.iter_mut().for_each(|channel| channel.resize(CAPACITY, [0; PIECE]));
        self.shades.iter_mut().for_each(|shades| shades.resize(CAPACITY, [0; PIECE]));
    }
}

impl EffectBatch {
    /// Faces that it holds at most.
    pub const CAPACITY: usize = 64;

    /// A batch without faces. When it is drawn for the first time it takes 60 kB.
    #[must_use]
    pub const fn new() -> Self {
        Self { faces: Vec::new(), corners: Batch::new(), pieces: Pieces::EMPTY, buffers: Buffers::EMPTY }
    }

    /// Bytes that it holds.
    pub(crate) fn bytes(&self) -> usize {
        let Buffers { bytes, other, channels, shades } = &self.buffers;
        let rows = bytes.capacity() + other.capacity() + channels.iter().map(Vec::capacity).sum::<usize>();
        let shades = shades.iter().map(Vec::capacity).sum::<usize>();
        self.faces.capacity() * size_of::<Face>()
            + self.pieces.bytes()
            + rows * size_of::<Bytes>()
            + shades * size_of::<Shades>()
    }

    /// Returns whether the batch holds no face.
    #[must_use]
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// Returns whether the batch has no room for another face.
    #[must_use]
    #[inline]
    pub fn is_full(&self) -> bool {
        self.faces.len() >= Self::CAPACITY
    }

    /// Adds a face. The order of the corners and their winding make no difference; a face without area draws nothing.
    /// Returns `false`, and adds nothing, if there is no room.
    #[inline]
    pub fn push(&mut self, vertices: &[Vertex; 3], attributes: &[Attributes; 3]) -> bool {
        let fits = !self.is_full();
        if fits {
            if self.faces.capacity() == 0 {
                self.faces.reserve_exact(Self::CAPACITY);
            }
            self.faces.push(Face { vertices: *vertices, attributes: *attributes });
            self.corners.push(vertices, Interpolation::GouraudReseeded);
        }
        fits
    }

    /// The pieces of one row of a triangle that another method found, painted into `pixels`, the frame's whole row.
    pub(crate) fn paint_row(
        &mut self,
        (vertices, attributes): (&[Vertex; 3], &[Attributes; 3]),
        pipeline: &PixelPipeline<'_>,
        row: &Row,
        pixels: &mut [u8],
        kernel: Kernel,
        drawn: &mut DrawStats,
    ) {
        self.clear();
        self.push(vertices, attributes);
        let Self { faces, pieces, buffers, .. } = self;
        make_room(pieces, buffers);
        let (rows, depth) = (OneRow(pixels), None::<&mut DepthBuffer<'_, u32>>);
        let mut drawing =
            Drawing { rows, depth, kernel, pipeline, faces, pieces, buffers, drawn: DrawStats::default() };
        let triangle = Sorted::new(faces, 0, false);
        drawing.add_row(row, &triangle);
        drawing.pieces.close(&triangle);
        // The caller has counted what is covered.
        *drawn += DrawStats { covered: 0, ..drawing.finish((row.x1 - row.x0) as u32) };
        self.clear();
    }

    /// Takes all faces out.
    fn clear(&mut self) {
        self.faces.clear();
        self.corners.clear();
    }
}

/// Makes room, the first time, for as many pieces as there may be.
#[inline]
fn make_room(pieces: &mut Pieces, buffers: &mut Buffers) {
    if buffers.bytes.is_empty() {
        pieces.make_room();
        buffers.make_room();
    }
}

/// Counts what was done to so many pixels, whatever the depth test said of them.
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

/// Rows of a frame.
trait Rows {
    /// The pixels from column `x` of row `y` on.
    fn starting_at(&mut self, x: usize, y: u32) -> Option<&mut [u8]>;
}

impl Rows for &mut Frame<'_> {
    #[inline]
    fn starting_at(&mut self, x: usize, y: u32) -> Option<&mut [u8]> {
        Frame::starting_at(self, x, y)
    }
}

/// The only row that is drawn.
struct OneRow<'a>(&'a mut [u8]);

impl Rows for OneRow<'_> {
    #[inline]
    fn starting_at(&mut self, x: usize, _: u32) -> Option<&mut [u8]> {
        self.0.get_mut(x..)
    }
}

/// Drawing of faces: the target, the stages, the pieces that wait for them, and what was done.
struct Drawing<'a, 'b, R, D: Cell> {
    rows: R,
    depth: Option<&'a mut DepthBuffer<'b, D>>,
    kernel: Kernel,
    pipeline: &'a PixelPipeline<'a>,
    faces: &'a [Face],
    pieces: &'a mut Pieces,
    buffers: &'a mut Buffers,
    drawn: DrawStats,
}

impl<R: Rows, D: Cell> Drawing<'_, '_, R, D> {
    /// Adds the drawn part of a row of a face, cut into pieces.
    #[inline]
    fn add_row(&mut self, row: &Row, of: &Sorted) {
        let mut seed = row.origin + (row.x0 - row.origin) / RESEED * RESEED;
        let mut x = row.x0;
        while x < row.x1 {
            let end = row.x1.min(seed + RESEED);
            self.add_piece(Piece { row: *row, seed, x, end, paint: 0 }, of);
            seed += RESEED;
            x = end;
        }
    }

    /// Adds a piece of a face. Those that wait are drawn when there is no more room.
    #[inline(always)]
    fn add_piece(&mut self, piece: Piece, of: &Sorted) {
        if self.pieces.len() == CAPACITY {
            self.pieces.close(of);
            self.draw();
        }
        self.pieces.push(piece);
    }

    /// Passes pieces through the stages, writes them, and clears their list.
    #[inline(never)]
    fn draw(&mut self) {
        let Self { pieces, buffers, pipeline, faces, kernel, .. } = self;
        let n = pieces.len();
        if n == 0 {
            return;
        }
        pieces.shade(faces, buffers, pipeline, *kernel);
        if let Some(table) = pipeline.fog() {
            let plane = |triangle: &SortedTriangle, [a, b, c]: [&Attributes; 3]| {
                ShadePlane::of_values(triangle, [a, b, c].map(|corner| i64::from(corner.fog.to_bits())))
            };
            pieces.each(faces, &mut buffers.bytes[..n], plane, |plane, piece, bytes| {
                let mut levels: Bytes = [0; PIECE];
                let levels = &mut levels[..piece.len()];
                kernel.fill(levels, plane.start(piece.seed, piece.row.y), plane.step());
                lookup(&mut bytes[..piece.len()], levels, table);
            });
        }
        match pipeline.blend() {
            None => self.write::<false>(),
            Some(_) => self.write::<true>(),
        }
        self.pieces.clear();
    }

    /// Writes pieces, all of each or where it is nearer.
    #[inline(never)]
    fn write<const BLENDS: bool>(&mut self) {
        let Self { rows, pieces, drawn, pipeline, kernel, .. } = self;
        let bytes = &mut self.buffers.bytes[..pieces.len()];
        let blend = pipeline.blend().filter(|_| BLENDS);
        *drawn += match &mut self.depth {
            None => {
                let mut drawn = DrawStats::default();
                for (piece, bytes) in pieces.pieces().iter().zip(bytes) {
                    let Some((pixels, bytes)) = visible(rows, piece, bytes, blend) else { continue };
                    copy(&mut pixels[..piece.visible()], &bytes[..piece.visible()]);
                    drawn.spans += 1;
                    // At most 64.
                    drawn.pixels += piece.visible() as u32;
                }
                drawn
            }
            Some(depth) if pipeline.keeps_depth => {
                write_nearer::<R, D, BLENDS, true>(*kernel, *kernel, rows, depth, pieces, bytes, blend)
            }
            Some(depth) => write_nearer::<R, D, BLENDS, false>(*kernel, *kernel, rows, depth, pieces, bytes, blend),
        };
    }

    /// Draws the pieces that wait, and returns what was done, so many pixels being covered.
    fn finish(mut self, covered: u32) -> DrawStats {
        self.draw();
        let mut drawn = DrawStats { covered, ..self.drawn };
        count(self.pipeline, covered, &mut drawn);
        drawn
    }
}

at_best_level! {
    /// Writes pieces where they are nearer; with `KEEPS` their depths are kept.
    fn write_nearer[R: Rows, D: Cell, const BLENDS: bool, const KEEPS: bool][R, D, BLENDS, KEEPS](
        level: Kernel,
        kernel: Kernel,
        rows: &mut R,
        depth: &mut DepthBuffer<'_, D>,
        pieces: &Pieces,
        bytes: &mut [Bytes],
        blend: Option<&[u8; 65_536]>,
    ) -> DrawStats {
        write_each::<R, D, BLENDS, KEEPS>(kernel, rows, depth, pieces, bytes, blend)
    }
}

#[inline(always)]
fn write_each<R: Rows, D: Cell, const BLENDS: bool, const KEEPS: bool>(
    kernel: Kernel,
    rows: &mut R,
    depth: &mut DepthBuffer<'_, D>,
    pieces: &Pieces,
    bytes: &mut [Bytes],
    blend: Option<&[u8; 65_536]>,
) -> DrawStats {
    let mut drawn = DrawStats::default();
    let mut first = 0;
    // Not by a closure, which would not be compiled for the level.
    for Covered { of, end } in pieces.triangles() {
        let plane = DepthPlane::new(&of.triangle);
        for (piece, bytes) in pieces.pieces()[first..*end].iter().zip(&mut bytes[first..*end]) {
            let Some((pixels, bytes)) = visible(rows, piece, bytes, blend.filter(|_| BLENDS)) else { continue };
            let Some(depths) = depth.starting_at(piece.range().start, piece.row.y as u32) else { continue };
            let (n, z) = (piece.visible(), plane.fixed_at(piece.x, piece.row.y));
            drawn.spans += 1;
            // At most 64.
            drawn.tested += n as u32;
            drawn.pixels += kernel.copy_where_nearer::<D, KEEPS>(n, pixels, depths, bytes, z, plane.step());
        }
        first = *end;
    }
    drawn
}

/// The pixels from the first of a piece that is drawn on, and the bytes from there on: with a table, what it makes of them
/// and of what is there.
#[inline(always)]
fn visible<'a>(
    rows: &'a mut impl Rows,
    piece: &Piece,
    bytes: &'a mut Bytes,
    blend: Option<&[u8; 65_536]>,
) -> Option<(&'a mut [u8], &'a [u8])> {
    let row = rows.starting_at(piece.range().start, piece.row.y as u32)?;
    let pixels = row.get(..piece.visible())?;
    let first = (piece.x - piece.seed) as usize;
    if let Some(table) = blend {
        // The table's row is the face's own index.
        let mut behind: Bytes = [0; PIECE];
        let behind = &mut behind[..pixels.len()];
        behind.copy_from_slice(pixels);
        let bytes = &mut bytes[first..piece.len()];
        lookup(behind, bytes, table);
        bytes.copy_from_slice(behind);
    }
    Some((row, &bytes[first..]))
}

/// Copies bytes to as many pixels: mostly few, for which a call costs more than they do.
#[inline(always)]
fn copy(pixels: &mut [u8], bytes: &[u8]) {
    if bytes.len() > 8 {
        pixels.copy_from_slice(bytes);
    } else if let (Some(first), Some(last)) = (bytes.first_chunk::<4>(), bytes.last_chunk::<4>()) {
        // They overlap.
        pixels.first_chunk_mut().into_iter().for_each(|pixels| *pixels = *first);
        pixels.last_chunk_mut().into_iter().for_each(|pixels| *pixels = *last);
    } else {
        for (pixel, byte) in pixels.iter_mut().zip(bytes.iter().take(3)) {
            *pixel = *byte;
        }
    }
}

impl<D: Cell> Raster<'_, D> {
    /// Draws a triangle with effects. The order of the corners and their winding make no difference; a
    /// triangle without area draws nothing. Many triangles are drawn sooner by
    /// [`batch_with_effects`](Self::batch_with_effects), by which this is drawn, too.
    #[doc(hidden)]
    pub fn triangle_with_effects(
        &mut self,
        vertices: &[Vertex; 3],
        attributes: &[Attributes; 3],
        pipeline: &PixelPipeline<'_>,
    ) -> DrawStats {
        let mut batch = EffectBatch::new();
        batch.push(vertices, attributes);
        self.batch_with_effects(&mut batch, pipeline)
    }

    /// Draws the faces of a batch in their order, by one pixel pipeline, and takes them out of it.
    #[doc(hidden)]
    pub fn batch_with_effects(&mut self, batch: &mut EffectBatch, pipeline: &PixelPipeline<'_>) -> DrawStats {
        self.draw_effects::<true>(batch, pipeline)
    }

    /// Draws a batch whose faces lie wholly inside the frame.
    ///
    /// Parts that lie outside are treated as by [`triangle_inside`](Self::triangle_inside).
    #[doc(hidden)]
    pub fn batch_with_effects_inside(&mut self, batch: &mut EffectBatch, pipeline: &PixelPipeline<'_>) -> DrawStats {
        self.draw_effects::<false>(batch, pipeline)
    }

    #[inline(never)]
    fn draw_effects<const CLIPS: bool>(&mut self, batch: &mut EffectBatch, pipeline: &PixelPipeline<'_>) -> DrawStats {
        let (width, clip, bounds) = (self.frame.width(), self.clip, self.frame.bounds());
        let depth = self.depth.as_mut().filter(|_| !cfg!(mode13h_leave_out = "hidden-surfaces"));
        let EffectBatch { faces, corners, pieces, buffers } = &mut *batch;
        make_room(pieces, buffers);
        let (rows, kernel, drawn) = (&mut self.frame, self.kernel, DrawStats::default());
        let mut drawing = Drawing { rows, depth, kernel, pipeline, faces, pieces, buffers, drawn };
        let mut finder = Finder::new(kernel.simd_level(), corners, if CLIPS { clip } else { bounds });
        let mut covered = 0;
        while let Some(found) = finder.next() {
            match found {
                Found::Small(triangles, rows) => {
                    for (lane, &number) in triangles.iter().enumerate() {
                        let triangle = Sorted::new(faces, index(number), true);
                        for (row, paint) in rows.of(lane) {
                            let (x, end) = (row.x0, row.x1);
                            if x < end {
                                covered += (end - x) as u32;
                                drawing.add_piece(Piece { row, seed: x, x, end, paint }, &triangle);
                            }
                        }
                        drawing.pieces.close(&triangle);
                    }
                }
                Found::Another(face) => {
                    let sorted = Sorted::new(faces, face, false);
                    let each_row = |row: Row| {
                        covered += (row.x1 - row.x0) as u32;
                        // Columns of a frame, of which there are at most 4,096.
                        if CLIPS || (row.x0 >= 0 && row.x1 <= width as i32) {
                            drawing.add_row(&row, &sorted);
                        }
                    };
                    if CLIPS {
                        sorted.triangle.rows(width, clip, each_row);
                    } else {
                        sorted.triangle.rows_inside(each_row);
                    }
                    drawing.pieces.close(&sorted);
                }
            }
        }
        let drawn = drawing.finish(covered);
        batch.clear();
        drawn
    }
}
