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
//! Faces of one [`PixelPipeline`] are picked and set up as plain ones are, eight at a time. The rows of large ones are walked
//! down: they are long, so finding them is little of their time. [`EffectBatch`] is the door for faces by vertices.
//!
//! A stage is one loop over up to 64 pieces of many faces, so a stage that the pipeline does not have costs one
//! question for all of them. Pieces are written in the order of their faces; so what one face leaves in the frame is what
//! the next one blends with. Pieces begin at the row's first covered pixel inside the frame and every 64 pixels from there,
//! where every value is exact; so a pixel's byte depends on no clip rectangle. Without any effect [`Raster::triangle`] gives
//! the same bytes sooner.
//!
//! Shades and channels are what the [`Interpolation`](super::Interpolation) makes of them; fog and the table's normals
//! are linear, started anew with every piece, whatever the shading, and keep the guarantees of [`shade`](super::shade): no
//! sum leaves the range of the three corners. With dither, whose threshold of 0 to 255 takes the place of the half, a
//! byte lies in [min >> 8, ⌈max⌉].

mod batch;
mod curve;
mod level;
mod lit;
mod pieces;
mod pipeline;
mod shades;
mod texture;

use alloc::vec::Vec;

pub use self::batch::EffectBatch;
use self::pieces::{CAPACITY, FaceSetup, Faces, PIXELS, Piece, Pieces, SetUp, Shaded};
pub use self::pipeline::{Lighting, Limits, Mix, PixelPipeline, SampleSpacing, ShadeSource, TextureStage};
pub use super::columns::Attributes;
use super::columns::{Picks, Triangles, Value};
use super::cover::Row;
use super::depth::{Cell, DepthBuffer, DepthPlane};
use super::draw_stats::DrawStats;
use super::found::{FoundRows, Wanted, find_rows};
use super::frame::{Frame, Rect};
use super::pick::{LANES, Pick, SizeClass};
use super::shade::RESEED;
use super::triangle::Raster;
use crate::fixed::HAS_F64;
pub use crate::mapping::Mapping;
use crate::simd::at_best_level;
use crate::span::texture::Shown;
use crate::span::{Kernel, lookup};

/// Memory of the stages: pieces of rows, and what passes through. Used again and again it allocates nothing.
#[derive(Clone, Debug, Default)]
pub(crate) struct EffectScratch {
    /// Room for rows of eight faces.
    rows: Vec<FoundRows>,
    pieces: Pieces,
    buffers: Buffers,
}

/// Output of the stages: a number for each pixel of all pieces.
#[derive(Clone, Debug, Default)]
struct Buffers {
    /// The bytes that are drawn in the end.
    bytes: Vec<u8>,
    /// Texels, levels of fog, or rows of a table.
    other: Vec<u8>,
    /// Red, green and blue.
    channels: [Vec<u8>; 3],
    /// One shade in 8.8, or three channels.
    shades: [Vec<u16>; 3],
    /// Places of texels in their image.
    places: Vec<i32>,
}

impl Buffers {
    /// Makes room for as many pixels as there may be.
    fn make_room(&mut self) {
        let Self { bytes, other, channels, shades, places } = self;
        for bytes in [bytes, other].into_iter().chain(channels) {
            bytes.resize(PIXELS, 0);
        }
        for shades in shades {
            shades.resize(PIXELS, 0);
        }
        places.resize(PIXELS, 0);
    }

    /// Bytes that it holds.
    fn bytes(&self) -> usize {
        let Self { bytes, other, channels, shades, places } = self;
        let bytes = bytes.capacity() + other.capacity() + channels.iter().map(Vec::capacity).sum::<usize>();
        let shades = shades.iter().map(Vec::capacity).sum::<usize>();
        bytes + shades * size_of::<u16>() + places.capacity() * size_of::<i32>()
    }
}

impl EffectScratch {
    /// Bytes that it holds.
    pub(crate) fn bytes(&self) -> usize {
        self.rows.capacity() * size_of::<FoundRows>() + self.pieces.bytes() + self.buffers.bytes()
    }

    /// Takes the memory, 90 kB, the first time.
    #[inline]
    fn make_room(&mut self) {
        if self.buffers.bytes.is_empty() {
            self.rows.push(FoundRows::NONE);
            self.pieces.make_room();
            self.buffers.make_room();
        }
    }

    /// The pieces of one row of pick `k` that another method found, painted into `pixels`, the frame's whole row.
    pub(crate) fn paint_row(
        &mut self,
        (triangles, picks, k): (&Triangles<'_>, Picks<'_>, usize),
        pipeline: &PixelPipeline<'_>,
        row: &Row,
        pixels: &mut [u8],
        kernel: Kernel,
        drawn: &mut DrawStats,
    ) {
        self.make_room();
        let Self { pieces, buffers, .. } = self;
        let (rows, depth) = (OneRow(pixels), None::<&mut DepthBuffer<'_, u32>>);
        let faces = Faces { triangles, picks };
        let mut drawing =
            Drawing { rows, depth, kernel, pipeline, faces, pieces, buffers, drawn: DrawStats::default() };
        let set_up = SetUp::Walked(faces.sorted(k));
        drawing.add_row(row, (k, &set_up));
        drawing.pieces.close(k, &set_up);
        // The caller has counted what is covered.
        *drawn += DrawStats { covered: 0, ..drawing.finish((row.x1 - row.x0) as u32) };
    }
}

/// Linear values that the stages of a pipeline ask for, each in its slot.
fn values(pipeline: &PixelPipeline<'_>) -> [Option<Value>; Value::MAX_COUNT] {
    let mut values = [None; Value::MAX_COUNT];
    let mut want =
        |value: Value, is_wanted: bool| values[value.slot()] = is_wanted.then_some(value).or(values[value.slot()]);
    want(Value::Fog, pipeline.fog().is_some());
    let channels = pipeline.channels().is_some();
    let by_table = matches!(pipeline.source, ShadeSource::NormalTable(_));
    for i in 0..3 {
        want(Value::Channel(i), channels && (by_table || matches!(pipeline.source, ShadeSource::Shaded(_))));
        want(Value::Slope(i), by_table && !channels && i < 2);
    }
    values
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
    faces: Faces<'a>,
    pieces: &'a mut Pieces,
    buffers: &'a mut Buffers,
    drawn: DrawStats,
}

impl<R: Rows, D: Cell> Drawing<'_, '_, R, D> {
    /// Adds the drawn part of a row of a face, cut into pieces.
    #[inline(always)]
    fn add_row(&mut self, row: &Row, face: (usize, &SetUp)) {
        if row.x1 - row.origin > RESEED {
            return self.add_pieces(row, face);
        }
        self.make_space(face);
        self.pieces.push(row, row.origin, row.x0..row.x1, 0);
    }

    /// Adds more than one.
    #[inline(never)]
    fn add_pieces(&mut self, row: &Row, face: (usize, &SetUp)) {
        let mut seed = row.origin + (row.x0 - row.origin) / RESEED * RESEED;
        let mut x = row.x0;
        while x < row.x1 {
            let end = row.x1.min(seed + RESEED);
            self.make_space(face);
            self.pieces.push(row, seed, x..end, 0);
            seed += RESEED;
            x = end;
        }
    }

    /// Adds the rows of a small face that lies inside the clip rectangle. Returns how many pixels are covered.
    #[inline(always)]
    fn add_small(&mut self, face: usize, rows: &FoundRows, lane: usize, wanted: Wanted) -> u32 {
        let mut setup = FaceSetup { affine: None, perspective: None, depth: 0 };
        match wanted.texture {
            None => {}
            Some(Mapping::Affine) => setup.affine = rows.affine_step(lane),
            Some(Mapping::Perspective | Mapping::Every16) => setup.perspective = Some(rows.perspective_step(lane)),
        }
        if wanted.depths {
            setup.depth = rows.depth_step(lane);
        }
        let set_up = SetUp::Lanes(setup);
        let mut covered = 0;
        for j in 0..rows.count(lane) {
            let (row, paint) = rows.row(lane, j);
            let (x, end) = (row.x0, row.x1);
            if x >= end {
                continue;
            }
            covered += (end - x) as u32;
            self.make_space((face, &set_up));
            let Some(start) = self.pieces.push(&row, x, x..end, paint) else { continue };
            match wanted.texture {
                None => {}
                Some(Mapping::Affine) => start.affine = rows.affine_start(lane, j),
                Some(Mapping::Perspective | Mapping::Every16) => start.perspective = rows.perspective_start(lane, j),
            }
            if wanted.slots > 0 {
                start.values = rows.values(lane, j);
            }
            if wanted.depths {
                start.depth = rows.depth(lane, j, x);
            }
        }
        self.pieces.close(face, &set_up);
        covered
    }

    /// Adds the rows of a face, walking down its edges. Returns how many pixels are covered.
    #[inline(never)]
    fn add_large(&mut self, face: usize, width: u32, clip: Rect) -> u32 {
        let mut covered = 0;
        let sorted = self.faces.sorted(face);
        let set_up = SetUp::Walked(sorted);
        sorted.triangle.rows(width, clip, |row: Row| {
            covered += (row.x1 - row.x0) as u32;
            self.add_row(&row, (face, &set_up));
        });
        self.pieces.close(face, &set_up);
        covered
    }

    /// Draws the pieces that wait if there is no room for one more of a face.
    #[inline(always)]
    fn make_space(&mut self, face: (usize, &SetUp)) {
        if self.pieces.len() == CAPACITY {
            self.draw_full(face);
        }
    }

    /// Draws the pieces that wait, of which the last are this face's.
    #[cold]
    #[inline(never)]
    fn draw_full(&mut self, (face, set_up): (usize, &SetUp)) {
        self.pieces.close(face, set_up);
        self.draw();
    }

    /// Passes pieces through the stages, writes them, and clears their list.
    #[inline(never)]
    fn draw(&mut self) {
        let Self { pieces, buffers, pipeline, faces, kernel, .. } = self;
        if pieces.len() == 0 {
            return;
        }
        pieces.shade(*faces, buffers, pipeline, *kernel);
        if let Some(table) = pipeline.fog() {
            let Buffers { bytes, other: levels, .. } = &mut **buffers;
            pieces.fill(Shaded::linear(Value::Fog), *faces, levels, *kernel);
            lookup(&mut bytes[..pieces.pixels()], levels, table);
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
        let bytes = &mut self.buffers.bytes[..];
        let blend = pipeline.blend().filter(|_| BLENDS);
        *drawn += match &mut self.depth {
            None => {
                let mut drawn = DrawStats::default();
                for piece in pieces.pieces() {
                    let Some((row, bytes)) = visible(rows, piece, bytes, blend) else { continue };
                    let n = piece.visible();
                    kernel.copy(n, row, bytes);
                    drawn.spans += 1;
                    // At most 64.
                    drawn.pixels += n as u32;
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
    #[inline(never)]
    fn write_nearer[R: Rows, D: Cell, const BLENDS: bool, const KEEPS: bool][R, D, BLENDS, KEEPS](
        level: Kernel,
        kernel: Kernel,
        rows: &mut R,
        depth: &mut DepthBuffer<'_, D>,
        pieces: &Pieces,
        bytes: &mut [u8],
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
    bytes: &mut [u8],
    blend: Option<&[u8; 65_536]>,
) -> DrawStats {
    let mut drawn = DrawStats::default();
    let mut first = 0;
    // Not by a closure, which would not be compiled for the level.
    for covered in pieces.triangles() {
        let range = first..covered.end;
        first = covered.end;
        let (plane, dz) = match &covered.set_up {
            SetUp::Lanes(setup) => (None, setup.depth),
            SetUp::Walked(face) => {
                let plane = DepthPlane::new(&face.triangle);
                (Some(plane), plane.step())
            }
        };
        let (of_face, starts) = pieces.with_starts(range);
        for (i, piece) in of_face.iter().enumerate() {
            let Some((pixels, bytes)) = visible(rows, piece, bytes, blend.filter(|_| BLENDS)) else { continue };
            let Some(depths) = depth.starting_at(piece.range().start, piece.row.y as u32) else { continue };
            let n = piece.visible();
            let z = match &plane {
                Some(plane) => plane.fixed_at(piece.x, piece.row.y),
                None => starts[i].depth,
            };
            drawn.spans += 1;
            // At most 64.
            drawn.tested += n as u32;
            drawn.pixels += kernel.copy_where_nearer::<D, KEEPS>(n, pixels, depths, bytes, z, dz);
        }
    }
    drawn
}

/// The pixels from the first of a piece that is drawn on, and the bytes from there on: with a table, what it makes of them
/// and of what is there.
#[inline(always)]
fn visible<'a>(
    rows: &'a mut impl Rows,
    piece: &Piece,
    bytes: &'a mut [u8],
    blend: Option<&[u8; 65_536]>,
) -> Option<(&'a mut [u8], &'a [u8])> {
    let row = rows.starting_at(piece.range().start, piece.row.y as u32)?;
    let pixels = row.get(..piece.visible())?;
    let bytes = &mut bytes[piece.first_visible()..];
    if let Some(table) = blend {
        // The table's row is the face's own index.
        let n = bytes.len().min(pixels.len());
        let there = &pixels[..n];
        for (i, byte) in bytes[..n].iter_mut().enumerate() {
            table.show(byte, there[i]);
        }
    }
    Some((row, bytes))
}

impl<D: Cell> Raster<'_, D> {
    /// Draws triangles that were picked inside the clip rectangle, one after the other, by one pixel pipeline.
    #[inline(never)]
    pub(crate) fn picks_with_effects(
        &mut self,
        triangles: &Triangles<'_>,
        picks: Picks<'_>,
        pipeline: &PixelPipeline<'_>,
        scratch: &mut EffectScratch,
    ) -> DrawStats {
        let (width, clip) = (self.frame.width(), self.clip);
        let depth = self.depth.as_mut().filter(|_| !cfg!(mode13h_leave_out = "hidden-surfaces"));
        scratch.make_room();
        let EffectScratch { rows, pieces, buffers } = scratch;
        let Some(found) = rows.first_mut() else { return DrawStats::default() };
        let texture = match pipeline.texture() {
            Some(stage) if pipeline.levels().is_none() && stage.mapping != Mapping::Every16 => Some(stage.mapping),
            _ => None,
        };
        let values = values(pipeline);
        let slots = values.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
        let wanted = Wanted { depths: depth.is_some(), texture, values, slots };
        let (rows, kernel, drawn) = (&mut self.frame, self.kernel, DrawStats::default());
        let faces = Faces { triangles, picks };
        let mut drawing = Drawing { rows, depth, kernel, pipeline, faces, pieces, buffers, drawn };
        let (mut first, mut covered) = (0, 0);
        while first < picks.picks.len() {
            let is_small = |pick: &&u32| HAS_F64 && Pick(**pick).class() == SizeClass::Small;
            let small = picks.picks[first..].iter().take(LANES).take_while(is_small).count();
            if small == 0 {
                covered += drawing.add_large(first, width, clip);
                first += 1;
                continue;
            }
            find_rows(kernel.simd_level(), triangles, &picks.range(first, first + small), wanted, found);
            for lane in 0..small {
                covered += drawing.add_small(first + lane, found, lane, wanted);
            }
            first += small;
        }
        drawing.finish(covered)
    }
}
