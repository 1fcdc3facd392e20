//! Faces as pieces of rows: what the stages work on.

use alloc::vec::Vec;

use crate::fixed::U8F8;
use crate::lanes::three;
use crate::raster::columns::{EffectColumns, Picks, Triangles, Value};
use crate::raster::cover::{Row, SortedTriangle};
use crate::raster::interpolation::Interpolation;
use crate::raster::paint::RowShader;
use crate::raster::shade::{RESEED, ShadePlane};
use crate::simd::at_best_level;
use crate::span::Kernel;
use crate::span::dither::{ThresholdRow, Thresholds, fill_dithered};
use crate::span::texture::LANES;

/// Pixels in a piece, at most.
pub(super) const PIECE: usize = RESEED as usize;

/// Pieces that pass through the stages together: their bytes take at most 4 kB.
pub(super) const CAPACITY: usize = 64;

/// Room for a number for each pixel of all pieces, which lie one behind the other, and for what is written eight at a time.
pub(super) const PIXELS: usize = CAPACITY * PIECE + LANES;

/// Triangles as the stages read them: those that were picked, by their index among these.
#[derive(Clone, Copy)]
pub(super) struct Faces<'a> {
    pub(super) triangles: &'a Triangles<'a>,
    pub(super) picks: Picks<'a>,
}

impl<'a> Faces<'a> {
    /// Face `k` in the order of its heights, and where its corners' values are.
    #[inline]
    pub(super) fn sorted(&self, k: usize) -> SortedFace {
        let pick = self.picks.get(k);
        let (triangle, order) = SortedTriangle::with_order(&self.triangles.vertices(&self.picks, k));
        let of = self.triangles.corners(pick);
        let flat = self.picks.flat.get(k).copied();
        SortedFace { triangle, corners: three(order, |corner| of[corner]), side: pick.side(), flat }
    }
}

/// A face in the order of its heights.
#[derive(Clone, Copy, Debug)]
pub(super) struct SortedFace {
    pub(super) triangle: SortedTriangle,
    /// Indices of its vertices.
    corners: [usize; 3],
    side: usize,
    /// The channels that all corners have.
    flat: Option<[U8F8; 3]>,
}

/// A face, and the values of its corners from top to bottom.
pub(super) struct FaceCorners<'a> {
    pub(super) triangle: &'a SortedTriangle,
    face: &'a SortedFace,
    columns: &'a EffectColumns<'a>,
}

impl FaceCorners<'_> {
    /// Texture coordinates: `i` is 0 for u, 1 for v.
    #[inline]
    pub(super) fn texture(&self, i: usize) -> [i32; 3] {
        three(self.face.corners, |vertex| self.columns.texture[vertex][i])
    }

    /// A linear value.
    #[inline]
    pub(super) fn value(&self, value: Value) -> [i64; 3] {
        if let (Value::Channel(i), Some(flat)) = (value, self.face.flat) {
            return [i64::from(flat[i].to_bits()); 3];
        }
        three(self.face.corners, |vertex| i64::from(self.columns.value(value, vertex, self.face.side)))
    }

    /// Input of light, or the shades of a curve.
    #[inline]
    pub(super) fn lit(&self) -> [[f32; 6]; 3] {
        three(self.face.corners, |vertex| self.columns.lit.get(vertex, self.face.side))
    }
}

/// Up to 64 pixels of a row. Every value is exact at the first of them, which lies a multiple of 64 pixels from the row's
/// first covered pixel inside the frame; so a pixel's byte depends on no clip rectangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) row: Row,
    /// The column of the first pixel. It may lie outside of the clip rectangle.
    pub(super) seed: i32,
    /// Where its pixels begin among those of all pieces.
    pub(super) at: u32,
    /// The columns that are drawn: from this one, up to the second.
    pub(super) x: i32,
    pub(super) end: i32,
    /// Linear shades of a face that is set up: the first one, and above it the step.
    pub(super) paint: u32,
}

impl Piece {
    const NONE: Self =
        Self { row: Row { y: 0, origin: 0, x0: 0, x1: 0, last: 0 }, seed: 0, at: 0, x: 0, end: 0, paint: 0 };

    /// Pixels from the first on, those that are not drawn among them: 1 to 64.
    #[inline]
    pub(super) fn len(&self) -> usize {
        // Columns of a frame.
        (self.end - self.seed) as usize
    }

    /// Its pixels among those of all pieces.
    #[inline]
    pub(super) fn pixels(&self) -> core::ops::Range<usize> {
        self.first()..self.first() + self.len()
    }

    /// The columns that are drawn.
    #[inline]
    pub(super) fn range(&self) -> core::ops::Range<usize> {
        // Columns of a frame: 0 to 4,096.
        self.x as usize..self.end as usize
    }

    /// Pixels that are drawn: 1 to 64.
    #[inline]
    pub(super) fn visible(&self) -> usize {
        (self.end - self.x) as usize
    }

    /// Where its pixels begin among those of all pieces.
    #[inline]
    pub(super) fn first(&self) -> usize {
        self.at as usize
    }

    /// Where its drawn pixels begin among those of all pieces.
    #[inline]
    pub(super) fn first_visible(&self) -> usize {
        self.first() + (self.x - self.seed) as usize
    }

    /// Place of the first pixel.
    #[inline]
    pub(super) fn place(&self) -> (i32, i32) {
        (self.seed, self.row.y)
    }

    /// The column of the first pixel.
    #[inline]
    pub(super) fn column(&self) -> usize {
        // Not negative: it lies inside the frame.
        self.seed as usize
    }

    /// The thresholds of its row.
    #[inline]
    pub(super) fn thresholds(&self, of: Thresholds) -> &'static ThresholdRow {
        // Not negative: it lies inside the frame.
        of.row(self.row.y as usize)
    }
}

/// A face that has pieces, and what is known of its values.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceSpans {
    /// The face's index among those that are drawn.
    pub(super) face: usize,
    /// The index of the piece behind its last one.
    pub(super) end: usize,
    pub(super) set_up: SetUp,
}

impl FaceSpans {
    /// The face, and its corners' values. `room` is for a face that nobody has put in order yet.
    #[inline(always)]
    pub(super) fn corners<'a>(&'a self, faces: Faces<'a>, room: &'a mut Option<SortedFace>) -> FaceCorners<'a> {
        let face = match &self.set_up {
            SetUp::Walked(face) => face,
            SetUp::Lanes(_) => room.insert(faces.sorted(self.face)),
        };
        FaceCorners { triangle: &face.triangle, face, columns: &faces.triangles.columns.effects }
    }
}

/// Set-up of a face that has pieces.
#[derive(Clone, Copy, Debug)]
pub(super) enum SetUp {
    /// It was set up together with others.
    Lanes(FaceSetup),
    /// Its rows were walked down.
    Walked(SortedFace),
}

/// A small face that was set up together with others: its pieces have their [paint](Piece::paint), and change by as much from
/// a pixel to the next one. What the pipeline does not ask for may be anything.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceSetup {
    /// The step of [`PieceStart::affine`]; `None` if stages have to set it up.
    pub(super) affine: Option<[u32; 2]>,
    /// The step of [`PieceStart::perspective`]; `None` likewise.
    pub(super) perspective: Option<[f64; 3]>,
    /// The step of depths.
    pub(super) depth: i64,
}

/// Values at the first pixel of a piece whose face is set up.
#[derive(Clone, Copy, Debug)]
pub(super) struct PieceStart {
    /// Other linear values, as they were wanted, each with its step above it.
    pub(super) values: [u32; Value::MAX_COUNT],
    /// Texture coordinates that are linear on the screen, 16.16.
    pub(super) affine: [u32; 2],
    /// The numerators and the divisor of those that are linear on the face.
    pub(super) perspective: [f64; 3],
    /// The depth, with 24 fraction bits.
    pub(super) depth: i64,
}

impl PieceStart {
    pub(super) const NONE: Self =
        Self { values: [0; Value::MAX_COUNT], affine: [0; 2], perspective: [0.0; 3], depth: 0 };
}

/// Pieces of faces, in the order in which they are drawn.
#[derive(Clone, Debug, Default)]
pub(super) struct Pieces {
    triangles: Vec<FaceSpans>,
    /// Room for all; those that wait come first.
    pieces: Vec<Piece>,
    count: usize,
    /// One for each piece, in its place; of use where the face is set up.
    starts: Vec<PieceStart>,
    /// Number of pixels of all pieces.
    pixels: u32,
}

impl Pieces {
    /// Bytes that it holds.
    pub(super) fn bytes(&self) -> usize {
        self.triangles.capacity() * size_of::<FaceSpans>()
            + self.pieces.capacity() * size_of::<Piece>()
            + self.starts.capacity() * size_of::<PieceStart>()
    }

    /// Makes room for as many as there may be.
    pub(super) fn make_room(&mut self) {
        self.triangles.reserve_exact(CAPACITY);
        self.pieces.resize(CAPACITY, Piece::NONE);
        self.starts.resize(CAPACITY, PieceStart::NONE);
    }

    #[inline]
    pub(super) fn len(&self) -> usize {
        self.count
    }

    pub(super) fn clear(&mut self) {
        self.triangles.clear();
        self.count = 0;
        self.pixels = 0;
    }

    /// Number of pixels of all pieces.
    #[inline]
    pub(super) fn pixels(&self) -> usize {
        self.pixels as usize
    }

    /// Adds a piece, its pixels behind those of the others, and returns what is known of it if its face is set up.
    #[inline(always)]
    pub(super) fn push(
        &mut self,
        row: &Row,
        seed: i32,
        drawn: core::ops::Range<i32>,
        paint: u32,
    ) -> Option<&mut PieceStart> {
        let number = self.count;
        let (x, end) = (drawn.start, drawn.end);
        *self.pieces.get_mut(number)? = Piece { row: *row, seed, at: self.pixels, x, end, paint };
        self.count += 1;
        // Columns of a frame.
        self.pixels += (end - seed) as u32;
        self.starts.get_mut(number)
    }

    /// Makes the pieces behind those of the last face this face's, if there are any.
    #[inline]
    pub(super) fn close(&mut self, face: usize, set_up: &SetUp) {
        let end = self.count;
        if self.triangles.last().map_or(0, |last| last.end) != end {
            self.triangles.push(FaceSpans { face, end, set_up: *set_up });
        }
    }

    /// A stage of shades, or of another value.
    pub(super) fn fill(&self, shaded: Shaded, faces: Faces<'_>, out: &mut [u8], kernel: Kernel) {
        fill_at_best(kernel, kernel, self, shaded, faces, out);
    }

    /// One stage: for every triangle `plane` makes what its values are over it, from its corners top to bottom; for every
    /// piece `fill` makes its part of `out` from that.
    #[inline(always)]
    pub(super) fn each<P, T>(
        &self,
        faces: Faces<'_>,
        out: &mut [T],
        plane: impl Fn(&FaceCorners<'_>) -> P,
        mut fill: impl FnMut(&P, &Piece, &mut [T]),
    ) {
        let mut first = 0;
        for covered in &self.triangles {
            let plane = plane(&covered.corners(faces, &mut None));
            for piece in &self.pieces[first..covered.end] {
                fill(&plane, piece, &mut out[piece.pixels()]);
            }
            first = covered.end;
        }
    }

    /// The triangles that have pieces.
    #[inline]
    pub(super) fn triangles(&self) -> &[FaceSpans] {
        &self.triangles
    }

    /// Pieces of faces that are set up, each with its start.
    #[inline(always)]
    pub(super) fn with_starts(&self, range: core::ops::Range<usize>) -> (&[Piece], &[PieceStart]) {
        (&self.pieces[range.clone()], &self.starts[range])
    }

    /// The pieces.
    #[inline]
    pub(super) fn pieces(&self) -> &[Piece] {
        &self.pieces[..self.count]
    }
}

/// A shade or another value of the corners, as bytes.
#[derive(Clone, Copy)]
pub(super) struct Shaded {
    /// `None` for the shade.
    pub(super) value: Option<Value>,
    pub(super) interpolation: Interpolation,
    pub(super) dither: Option<Thresholds>,
}

impl Shaded {
    /// A value that starts anew with every piece.
    pub(super) fn linear(value: Value) -> Self {
        Self { value: Some(value), interpolation: Interpolation::GouraudReseeded, dither: None }
    }
}

at_best_level! {
    #[inline]
    fn fill_at_best[][](
        level: Kernel,
        kernel: Kernel,
        pieces: &Pieces,
        shaded: Shaded,
        faces: Faces<'_>,
        out: &mut [u8],
    ) {
        fill_each(kernel, pieces, shaded, faces, out)
    }
}

#[inline(always)]
fn fill_each(kernel: Kernel, all: &Pieces, shaded: Shaded, faces: Faces<'_>, out: &mut [u8]) {
    let reseeds = shaded.interpolation == Interpolation::GouraudReseeded;
    let is_linear = matches!(shaded.interpolation, Interpolation::Gouraud | Interpolation::GouraudReseeded);
    let mut first = 0;
    for covered in &all.triangles {
        let range = first..covered.end;
        first = covered.end;
        let (pieces, starts) = all.with_starts(range);
        if !is_linear || matches!(covered.set_up, SetUp::Walked(_)) {
            let mut room = None;
            let face = &covered.corners(faces, &mut room);
            let values = match shaded.value {
                None => face.triangle.shades(),
                Some(value) => face.value(value),
            };
            if !reseeds || shaded.dither.is_some() {
                fill_walked(kernel, pieces, shaded, (face, values), out);
                continue;
            }
            let plane = ShadePlane::of_values(face.triangle, values);
            for piece in pieces {
                kernel.fill(&mut out[piece.pixels()], plane.start(piece.seed, piece.row.y), plane.step());
            }
            continue;
        }
        for (i, piece) in pieces.iter().enumerate() {
            let paint = match shaded.value {
                None => piece.paint,
                Some(value) => starts[i].values[value.slot()],
            };
            // The halves.
            let (start, step) = (paint as u16, (paint >> 16) as u16);
            match shaded.dither {
                None => fill_blocks(&mut out[piece.first()..], piece.len(), start, step),
                Some(thresholds) => {
                    let row = piece.thresholds(thresholds);
                    fill_dithered(&mut out[piece.pixels()], start.wrapping_sub(128), step, row, piece.column());
                }
            }
        }
    }
}

/// Fills the pieces of a face by a shader of their own.
#[inline(never)]
fn fill_walked(
    kernel: Kernel,
    pieces: &[Piece],
    shaded: Shaded,
    (face, values): (&FaceCorners<'_>, [i64; 3]),
    out: &mut [u8],
) {
    let shader = RowShader::of_values(face.triangle, values, shaded.interpolation);
    for piece in pieces {
        let thresholds = shaded.dither.map(|dither| piece.thresholds(dither));
        shader.piece(&piece.row, piece.seed, &mut out[piece.pixels()], thresholds, kernel);
    }
}

/// Fills the first `n` bytes, and up to seven more, for which there is room, with linear shades.
#[inline(always)]
fn fill_blocks(bytes: &mut [u8], n: usize, start: u16, step: u16) {
    let mut shade = start;
    for block in bytes.as_chunks_mut::<LANES>().0.iter_mut().take(n.div_ceil(LANES)) {
        for (byte, k) in block.iter_mut().zip(0_u16..) {
            *byte = (shade.wrapping_add(step.wrapping_mul(k)) >> 8) as u8;
        }
        shade = shade.wrapping_add(step.wrapping_mul(LANES as u16));
    }
}
