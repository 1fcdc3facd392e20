//! Faces as pieces of rows: what the stages work on.

use alloc::vec::Vec;

use super::pipeline::Attributes;
use crate::raster::cover::{Row, SortedTriangle};
use crate::raster::shade::{RESEED, ShadePlane};
use crate::raster::vertex::Vertex;
use crate::simd::at_best_level;
use crate::span::Kernel;
use crate::span::dither::{ThresholdRow, Thresholds};
use crate::span::texture::LANES;

/// Pixels in a piece, at most.
pub(super) const PIECE: usize = RESEED as usize;

/// Pieces that pass through the stages together: their bytes take at most 4 kB.
pub(super) const CAPACITY: usize = 64;

/// Room for a number for each pixel of all pieces, which lie one behind the other, and for what is written eight at a time.
pub(super) const PIXELS: usize = CAPACITY * PIECE + LANES;

/// A face: its corners, and what they carry.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Face {
    pub(super) vertices: [Vertex; 3],
    pub(super) attributes: [Attributes; 3],
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
pub(super) struct Covered {
    /// The index of the face.
    pub(super) face: usize,
    /// The index of the piece behind its last one.
    pub(super) end: usize,
    /// Steps of its values; `None` where stages have to set them up.
    pub(super) setup: Option<FaceSetup>,
}

impl Covered {
    /// Its triangle, and which corner of the face stands in each place.
    #[inline]
    pub(super) fn triangle(&self, faces: &[Face]) -> (SortedTriangle, [usize; 3]) {
        SortedTriangle::with_order(&faces[self.face].vertices)
    }

    /// Its triangle, and what the corners carry, in their order.
    #[inline]
    pub(super) fn corners<'a>(&self, faces: &'a [Face]) -> (SortedTriangle, [&'a Attributes; 3]) {
        let (triangle, order) = self.triangle(faces);
        let attributes = &faces[self.face].attributes;
        (triangle, [&attributes[order[0]], &attributes[order[1]], &attributes[order[2]]])
    }
}

/// A small face that was set up together with others: its pieces have their [paint](Piece::paint), and change by as much from
/// a pixel to the next one. What the pipeline does not ask for may be anything.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceSetup {
    /// The step of [`PieceStart::affine`]; `None` if stages have to set it up.
    pub(super) affine: Option<[u32; 2]>,
    /// The step of [`PieceStart::perspective`].
    pub(super) perspective: [f64; 3],
    /// The step of depths.
    pub(super) depth: i64,
}

/// Values at the first pixel of a piece whose face is set up.
#[derive(Clone, Copy, Debug)]
pub(super) struct PieceStart {
    /// Texture coordinates that are linear on the screen, 16.16.
    pub(super) affine: [u32; 2],
    /// The numerators and the divisor of those that are linear on the face.
    pub(super) perspective: [f64; 3],
    /// The depth, with 24 fraction bits.
    pub(super) depth: i64,
}

impl PieceStart {
    pub(super) const NONE: Self = Self { affine: [0; 2], perspective: [0.0; 3], depth: 0 };
}

/// Pieces of faces, in the order in which they are drawn.
#[derive(Clone, Debug, Default)]
pub(super) struct Pieces {
    triangles: Vec<Covered>,
    /// Room for all; those that wait come first.
    pieces: Vec<Piece>,
    count: usize,
    /// One for each piece, in its place; of use where the face is set up.
    starts: Vec<PieceStart>,
    /// Number of pixels of all pieces.
    pixels: u32,
}

impl Pieces {
    pub(super) const EMPTY: Self =
        Self { triangles: Vec::new(), pieces: Vec::new(), count: 0, starts: Vec::new(), pixels: 0 };

    /// Bytes that it holds.
    pub(super) fn bytes(&self) -> usize {
        self.triangles.capacity() * size_of::<Covered>()
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
    pub(super) fn close(&mut self, face: usize, setup: Option<&FaceSetup>) {
        let end = self.count;
        if self.triangles.last().map_or(0, |last| last.end) != end {
            self.triangles.push(Covered { face, end, setup: setup.copied() });
        }
    }

    /// The stage of linear shades that start anew with every piece.
    pub(super) fn fill_linear(&self, faces: &[Face], out: &mut [u8], kernel: Kernel) {
        fill_linear_at_best(kernel, kernel, self, faces, out);
    }

    /// One stage: for every triangle `plane` makes what its values are over it, from its corners top to bottom; for every
    /// piece `fill` makes its part of `out` from that.
    #[inline(always)]
    pub(super) fn each<'a, P, T>(
        &self,
        faces: &'a [Face],
        out: &mut [T],
        plane: impl Fn(&SortedTriangle, [&'a Attributes; 3]) -> P,
        mut fill: impl FnMut(&P, &Piece, &mut [T]),
    ) {
        let mut first = 0;
        for covered in &self.triangles {
            let (triangle, corners) = covered.corners(faces);
            let plane = plane(&triangle, corners);
            for piece in &self.pieces[first..covered.end] {
                fill(&plane, piece, &mut out[piece.pixels()]);
            }
            first = covered.end;
        }
    }

    /// The triangles that have pieces.
    #[inline]
    pub(super) fn triangles(&self) -> &[Covered] {
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

at_best_level! {
    #[inline]
    fn fill_linear_at_best[][](level: Kernel, kernel: Kernel, pieces: &Pieces, faces: &[Face], out: &mut [u8]) {
        fill_each_linear(kernel, pieces, faces, out)
    }
}

#[inline(always)]
fn fill_each_linear(kernel: Kernel, pieces: &Pieces, faces: &[Face], out: &mut [u8]) {
    let mut first = 0;
    for covered in &pieces.triangles {
        let pieces = &pieces.pieces[first..covered.end];
        first = covered.end;
        if covered.setup.is_some() {
            for piece in pieces {
                // The halves.
                fill_blocks(&mut out[piece.first()..], piece.len(), piece.paint as u16, (piece.paint >> 16) as u16);
            }
        } else {
            let plane = ShadePlane::new(&covered.triangle(faces).0);
            for piece in pieces {
                kernel.fill(&mut out[piece.pixels()], plane.start(piece.seed, piece.row.y), plane.step());
            }
        }
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
