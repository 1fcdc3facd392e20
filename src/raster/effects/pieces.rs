//! Faces as pieces of rows: what the stages work on.

use alloc::vec::Vec;

use super::pipeline::Attributes;
use crate::raster::cover::{Row, SortedTriangle};
use crate::raster::shade::{RESEED, ShadePlane};
use crate::raster::vertex::Vertex;
use crate::span::Kernel;

/// Pixels in a piece, at most.
pub(super) const PIECE: usize = RESEED as usize;

/// Pieces that pass through the stages together: their bytes take 4 kB.
pub(super) const CAPACITY: usize = 64;

/// A byte for each pixel of a piece.
pub(super) type Bytes = [u8; PIECE];

/// A shade in 8.8 for each pixel of a piece.
pub(super) type Shades = [u16; PIECE];

/// A face: its corners, and what they carry.
#[derive(Clone, Copy, Debug)]
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
    /// The columns that are drawn: from this one, up to the second.
    pub(super) x: i32,
    pub(super) end: i32,
    /// Linear shades of a face that is [set up](Sorted::has_paint): the first one, and above it the step.
    pub(super) paint: u32,
}

impl Piece {
    /// Pixels from the first on, those that are not drawn among them: 1 to 64.
    #[inline]
    pub(super) fn len(&self) -> usize {
        // Columns of a frame.
        (self.end - self.seed) as usize
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

    /// Place of the first pixel.
    #[inline]
    pub(super) fn start(&self) -> (i32, i32) {
        (self.seed, self.row.y)
    }

    /// The column of the first pixel.
    #[inline]
    pub(super) fn column(&self) -> usize {
        // Not negative: it lies inside the frame.
        self.seed as usize
    }

    /// The thresholds of its row in a pattern of 8 × 8.
    #[inline]
    pub(super) fn thresholds<'a>(&self, pattern: &'a [[u8; 8]; 8]) -> &'a [u8; 8] {
        &pattern[(self.row.y & 7) as usize]
    }
}

/// The triangle of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sorted {
    pub(super) triangle: SortedTriangle,
    /// Which corner of the face stands in each place.
    order: [usize; 3],
    /// The index of the face.
    pub(super) face: usize,
    /// Its pieces have their [paint](Piece::paint).
    has_paint: bool,
}

impl Sorted {
    #[inline(always)]
    pub(super) fn new(faces: &[Face], face: usize, has_paint: bool) -> Self {
        let (triangle, order) = SortedTriangle::with_order(&faces[face].vertices);
        Self { triangle, order, face, has_paint }
    }
}

/// A triangle that has pieces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Covered {
    pub(super) of: Sorted,
    /// The index of the piece behind its last one.
    pub(super) end: usize,
}

/// Pieces of faces, in the order in which they are drawn.
#[derive(Clone, Debug, Default)]
pub(super) struct Pieces {
    triangles: Vec<Covered>,
    pieces: Vec<Piece>,
}

impl Pieces {
    pub(super) const EMPTY: Self = Self { triangles: Vec::new(), pieces: Vec::new() };

    /// Bytes that it holds.
    pub(super) fn bytes(&self) -> usize {
        self.triangles.capacity() * size_of::<Covered>() + self.pieces.capacity() * size_of::<Piece>()
    }

    /// Makes room for as many as there may be.
    pub(super) fn make_room(&mut self) {
        self.triangles.reserve_exact(CAPACITY);
        self.pieces.reserve_exact(CAPACITY);
    }

    #[inline]
    pub(super) fn len(&self) -> usize {
        self.pieces.len()
    }

    pub(super) fn clear(&mut self) {
        self.triangles.clear();
        self.pieces.clear();
    }

    #[inline]
    pub(super) fn push(&mut self, piece: Piece) {
        self.pieces.push(piece);
    }

    /// Makes the pieces behind those of the last triangle a triangle's, if there are any.
    #[inline]
    pub(super) fn close(&mut self, triangle: &Sorted) {
        let end = self.pieces.len();
        if self.triangles.last().map_or(0, |last| last.end) != end {
            self.triangles.push(Covered { of: *triangle, end });
        }
    }

    /// The stage of linear shades that start anew with every piece.
    pub(super) fn fill_linear(&self, out: &mut [Bytes], kernel: Kernel) {
        let mut first = 0;
        for Covered { of, end } in &self.triangles {
            let plane = if of.has_paint { None } else { Some(ShadePlane::new(&of.triangle)) };
            for (piece, bytes) in self.pieces[first..*end].iter().zip(&mut out[first..*end]) {
                // The halves.
                let paint = (piece.paint as u16, (piece.paint >> 16) as u16);
                let at = |plane: &ShadePlane| (plane.start(piece.seed, piece.row.y), plane.step());
                let (start, step) = plane.as_ref().map_or(paint, at);
                kernel.fill(&mut bytes[..piece.len()], start, step);
            }
            first = *end;
        }
    }

    /// One stage: for every triangle `plane` makes what its values are over it, from its corners top to bottom; for every
    /// piece `fill` makes one of `out` from that.
    #[inline(always)]
    pub(super) fn each<'a, P, T>(
        &self,
        faces: &'a [Face],
        out: &mut [T],
        plane: impl Fn(&SortedTriangle, [&'a Attributes; 3]) -> P,
        mut fill: impl FnMut(&P, &Piece, &mut T),
    ) {
        let mut first = 0;
        for Covered { of: Sorted { triangle, order, face, .. }, end } in &self.triangles {
            let attributes = &faces[*face].attributes;
            let plane = plane(triangle, [&attributes[order[0]], &attributes[order[1]], &attributes[order[2]]]);
            for (piece, out) in self.pieces[first..*end].iter().zip(&mut out[first..*end]) {
                fill(&plane, piece, out);
            }
            first = *end;
        }
    }

    /// The triangles that have pieces.
    #[inline]
    pub(super) fn triangles(&self) -> &[Covered] {
        &self.triangles
    }

    /// The pieces.
    #[inline]
    pub(super) fn pieces(&self) -> &[Piece] {
        &self.pieces
    }
}
