//! Hidden surfaces by the scan-line method (the Russian textbook's own): all faces of a frame at once, row by row, with
//! every pixel written once.
//!
//! ```text
//! sort the faces by their first row
//! for every row:
//!     the faces that begin here enter the active list, which is sorted by the left edges' x
//!     from left to right, in segments from one edge to the next:
//!         of the faces open in the segment the nearest is drawn, its shades continuing from before
//!     every face's two edges step down a row, faces that end are removed, the list is sorted again
//! ```
//!
//! The image is the depth buffer's, byte for byte: coverage by the same edges, depth by the same
//! [`DepthPlane`](super::reference::depth::DepthPlane), the first face submitted at equal depths, and shades from the
//! start that the triangle alone would have. The method needs no depth per pixel and paints no pixel that another face
//! hides; a face that no other overlaps needs no depth at all.
//!
//! [`GouraudVintage`](Interpolation::GouraudVintage), whose triangles have edges of their own, gets exact coverage here
//! like all others, with its own [shades](super::vintage). So it alone gives frames that differ from the depth
//! buffer's.
//!
//! | file | what |
//! |---|---|
//! | `active` | faces whose rows are being walked: their two edges |
//! | `nearest` | which of the open faces a segment belongs to, and how far |
//!
//! # Cost
//!
//! Every face that is open in a segment covers each of its pixels, and a segment has at least one pixel. So the work
//! done in segments is bounded by the pixels that a depth buffer would test; on a model it is far less. The list is
//! sorted by insertion, since it hardly changes from row to row: two faces swap only where their left edges cross.

mod active;
mod nearest;

use alloc::vec::Vec;

use self::active::EdgePair;
use super::depth::Cell;
use super::draw_stats::DrawStats;
use super::interpolation::Interpolation;
use super::reference::cover::{Row, SortedTriangle};
use super::row_shader::InRow;
use super::triangle::Raster;
use super::vertex::Vertex;
use crate::span::Kernel;

/// The memory of the scan-line method, which grows as needed. Its contents between two frames do not matter.
#[derive(Clone, Debug, Default)]
pub struct Lists {
    /// The faces yet to come, those that are active, and those that are open.
    keys: [Vec<u64>; 3],
    pairs: Vec<EdgePair>,
}

impl Lists {
    /// Reserves memory for this number of faces. Unused memory is not touched.
    pub(crate) fn reserve(&mut self, faces: usize) {
        let Self { keys, pairs } = self;
        keys.iter_mut().for_each(|keys| keys.reserve(faces.saturating_sub(keys.len())));
        pairs.reserve(faces.saturating_sub(pairs.len()));
    }

    /// Makes room for this number of faces.
    fn make_room(&mut self, faces: usize) {
        let Self { keys, pairs } = self;
        keys.iter_mut().for_each(|keys| keys.resize(keys.len().max(faces), 0));
        pairs.resize(pairs.len().max(faces), EdgePair::default());
    }
}

/// A sort key: a row or a column in the upper bits, an index in the lower.
///
/// Keys sort by the row or column, then by the index.
#[derive(Clone, Copy)]
struct Key(u64);

impl Key {
    const NUMBER_BITS: u32 = 48;

    /// `position` is a row or column of a frame or the one after its last. No slice has 2⁴⁸ faces.
    #[inline]
    fn new(position: i32, number: usize) -> Self {
        Self((position as u64) << Self::NUMBER_BITS | number as u64)
    }

    #[inline]
    fn position(self) -> i32 {
        (self.0 >> Self::NUMBER_BITS) as i32
    }

    #[inline]
    fn number(self) -> usize {
        (self.0 & ((1 << Self::NUMBER_BITS) - 1)) as usize
    }
}

impl<D: Cell> Raster<'_, D> {
    internal! {
    /// Draws all `faces` of a frame, the nearest one at each pixel, and writes no pixel twice: the bytes are as if they
    /// were drawn in order with a cleared depth buffer.
    ///
    /// The frame's former contents count as background. The raster's depth buffer, if it has one, is neither read nor
    /// changed.
    ///
    /// ```
    /// use mode13h::fixed::{I24F8, U8F8};
    /// use mode13h::internals::raster::scan_line;
    /// use mode13h::raster::{Frame, Raster, Interpolation, Vertex};
    ///
    /// let at = |x, y, depth| Vertex::new(I24F8::from(x), I24F8::from(y), U8F8::default(), depth);
    /// let faces = [
    ///     ([at(0, 0, 500)?, at(4, 0, 500)?, at(0, 4, 500)?], Interpolation::Flat(1)),
    ///     ([at(4, 0, 900)?, at(4, 4, 900)?, at(0, 0, 100)?], Interpolation::Flat(2)), // through the first
    /// ];
    /// let mut bytes = [0; 4 * 4];
    /// let mut raster = Raster::new(Frame::new(&mut bytes, 4, 4, 4)?);
    /// let drawn = raster.scan_line(&faces, &mut scan_line::Lists::default());
    /// assert_eq!(bytes, [1, 1, 2, 2, 1, 1, 2, 2, 1, 0, 2, 2, 0, 0, 0, 2]);
    /// assert_eq!((drawn.covered, drawn.pixels), (16, 12));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    fn scan_line(&mut self, faces: &[([Vertex; 3], Interpolation)], lists: &mut Lists) -> DrawStats {
        self.scan_line_with(faces, lists, |_, _, _, _, _| false)
    }
    }

    /// Draws faces like [`scan_line`](Self::scan_line), but lets `paint` paint them differently.
    ///
    /// `paint` is given a face's index in `faces`, a row of it, the frame's whole row, the kernel and the counts. It
    /// returns whether it painted; if not, the face is painted with its own shading.
    pub(crate) fn scan_line_with(
        &mut self,
        faces: &[([Vertex; 3], Interpolation)],
        lists: &mut Lists,
        mut paint: impl FnMut(usize, &Row, &mut [u8], Kernel, &mut DrawStats) -> bool,
    ) -> DrawStats {
        lists.make_room(faces.len());
        let Lists { keys: [coming, active, open], pairs } = lists;
        let mut begun = 0;
        for (number, (vertices, _)) in faces.iter().enumerate() {
            if let Some(rows) = SortedTriangle::new(vertices).extent(self.clip) {
                coming[begun] = Key::new(rows.start, number).0;
                begun += 1;
            }
        }
        let coming = &mut coming[..begun];
        coming.sort_unstable();
        let mut drawn = DrawStats::default();
        let mut list = active::List::new(active, pairs, self.clip, self.frame.width());
        let mut next = 0;
        while let Some(y) = list.row().or_else(|| coming.get(next).map(|key| Key(*key).position())) {
            let enter = coming[next..].iter().take_while(|key| Key(**key).position() == y).count();
            list.enter(y, &mut coming[next..next + enter], faces);
            next += enter;
            self.sweep(&mut list, open, y, &mut paint, &mut drawn);
            list.down();
        }
        drawn
    }
}

/// Paints a face's row in place of its shading, or returns `false`.
trait Painter: FnMut(usize, &Row, &mut [u8], Kernel, &mut DrawStats) -> bool {}

impl<F: FnMut(usize, &Row, &mut [u8], Kernel, &mut DrawStats) -> bool> Painter for F {}

/// The pixels from `x0` to `x1` of a row, which belong to one face.
#[derive(Clone, Copy)]
struct Run {
    slot: usize,
    x0: i32,
    x1: i32,
}

impl<D: Cell> Raster<'_, D> {
    /// Sweeps along a row, from left to right.
    fn sweep(
        &mut self,
        list: &mut active::List<'_>,
        open: &mut [u64],
        y: i32,
        paint: &mut impl Painter,
        drawn: &mut DrawStats,
    ) {
        let (mut next, mut opened, mut x) = (0, 0, 0);
        // The run not yet painted, because the next segment may belong to the same face.
        let mut run: Option<Run> = None;
        loop {
            if opened == 0 {
                // Skip to where a face begins.
                let Some(key) = list.key(next) else { break };
                x = key.position();
            }
            while let Some(key) = list.key(next).filter(|key| key.position() <= x) {
                let pair = &list.pairs[key.number()];
                if pair.row.x0 < pair.row.x1 {
                    drawn.covered += (pair.row.x1 - pair.row.x0) as u32;
                    open[opened] = key.number() as u64;
                    opened += 1;
                }
                next += 1;
            }
            let (begin, faces) = (list.key(next).map_or(i32::MAX, Key::position), &open[..opened]);
            let end = faces.iter().fold(begin, |end, slot| end.min(list.pairs[*slot as usize].row.x1));
            while !faces.is_empty() && x < end {
                let (slot, until) = nearest::lead(faces, list, x, end, y);
                match (slot, &mut run) {
                    (Some(slot), Some(last)) if last.slot == slot && last.x1 == x => last.x1 = until,
                    (Some(slot), last) => {
                        if let Some(last) = last.replace(Run { slot, x0: x, x1: until }) {
                            self.paint_run(last, list, y, paint, drawn);
                        }
                    }
                    (None, _) => {}
                }
                x = until;
            }
            let mut kept = 0;
            for i in 0..opened {
                if list.pairs[open[i] as usize].row.x1 > x {
                    open[kept] = open[i];
                    kept += 1;
                }
            }
            opened = kept;
        }
        if let Some(run) = run {
            self.paint_run(run, list, y, paint, drawn);
        }
    }

    fn paint_run(
        &mut self,
        Run { slot, x0, x1 }: Run,
        list: &mut active::List<'_>,
        y: i32,
        paint: &mut impl Painter,
        drawn: &mut DrawStats,
    ) {
        let Some(pixels) = self.frame.row_mut(y as u32) else { return };
        let pair = &mut list.pairs[slot];
        let row = Row { y, x0, x1, ..pair.row };
        if !paint(pair.order, &row, pixels, self.kernel, drawn) {
            pair.paint().row(&row, &mut InRow { pixels, kernel: self.kernel, drawn });
        }
    }
}
