//! The active list: the faces that cross the current row, each with its two edges.

use super::Key;
use crate::raster::frame::Rect;
use crate::raster::interpolation::Interpolation;
use crate::raster::reference::cover::{Row, RowWalk, SortedTriangle};
use crate::raster::reference::depth::DepthPlane;
use crate::raster::row_shader::RowShader;
use crate::raster::vertex::Vertex;

/// A face whose rows are being walked: the two edges that cross the current row.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EdgePair {
    triangle: SortedTriangle,
    pub(super) interpolation: Interpolation,
    /// The face's index among all faces: at equal depths the first gets the pixel.
    pub(super) order: usize,
    walk: RowWalk,
    /// The face's pixels on the current row.
    pub(super) row: Row,
    /// True if it hides the background wherever it is: the depths of its vertices are above 0.
    pub(super) hides_background: bool,
    paint: Option<RowShader>,
    depth: Option<DepthPlane>,
    /// The next free index, if no face has this one.
    next_free: usize,
}

impl EdgePair {
    fn new(order: usize, vertices: &[Vertex; 3], interpolation: Interpolation, clip: Rect) -> Self {
        let triangle = SortedTriangle::new(vertices);
        Self {
            triangle,
            interpolation,
            order,
            // Only faces that have rows are passed in.
            walk: triangle.extent(clip).map(|rows| RowWalk::new(&triangle, rows)).unwrap_or_default(),
            hides_background: vertices.iter().all(|v| v.depth() > 0),
            ..Self::default()
        }
    }

    /// The face's shades, computed when it first has a pixel.
    #[inline]
    pub(super) fn paint(&mut self) -> &RowShader {
        self.paint.get_or_insert_with(|| RowShader::new(&self.triangle, self.interpolation))
    }

    /// The face's depths, computed when it first meets another face.
    #[inline]
    pub(super) fn depth(&mut self) -> &DepthPlane {
        self.depth.get_or_insert_with(|| DepthPlane::new(&self.triangle))
    }
}

/// The active list, sorted by the first column of each face.
pub(super) struct List<'a> {
    /// Keys of a column and an index into `pairs`.
    keys: &'a mut [u64],
    active: usize,
    pub(super) pairs: &'a mut [EdgePair],
    /// The first index in `pairs` that a face has freed, or `used`.
    free: usize,
    /// Number of entries of `pairs` ever used. Freed entries are reused, so they are few and stay in the cache.
    used: usize,
    y: i32,
    clip: Rect,
    frame_width: u32,
}

impl<'a> List<'a> {
    pub(super) fn new(keys: &'a mut [u64], pairs: &'a mut [EdgePair], clip: Rect, frame_width: u32) -> Self {
        Self { keys, active: 0, pairs, free: 0, used: 0, y: 0, clip, frame_width }
    }

    /// The current row, or `None` if no face is active.
    pub(super) fn row(&self) -> Option<i32> {
        (self.active > 0).then_some(self.y)
    }

    /// The key at this index of the list.
    #[inline]
    pub(super) fn key(&self, index: usize) -> Option<Key> {
        self.keys[..self.active].get(index).map(|key| Key(*key))
    }

    /// Inserts the faces that begin at row `y`. `coming` holds their keys, and is consumed.
    pub(super) fn enter(&mut self, y: i32, coming: &mut [u64], faces: &[([Vertex; 3], Interpolation)]) {
        self.y = y;
        for key in &mut *coming {
            let order = Key(*key).number();
            let (vertices, interpolation) = &faces[order];
            let slot = self.free;
            if slot == self.used {
                self.used += 1;
                self.free = self.used;
            } else {
                self.free = self.pairs[slot].next_free;
            }
            let pair = &mut self.pairs[slot];
            *pair = EdgePair::new(order, vertices, *interpolation, self.clip);
            pair.row = pair.walk.row(self.frame_width, self.clip);
            *key = Key::new(pair.row.x0, slot).0;
        }
        // Two sorted lists, merged from their ends, so that none is overwritten before it is read.
        coming.sort_unstable();
        let (mut old, mut new) = (self.active, coming.len());
        self.active += new;
        while new > 0 {
            let from_old = old > 0 && self.keys[old - 1] > coming[new - 1];
            let key = if from_old { &mut old } else { &mut new };
            *key -= 1;
            let key = *key;
            self.keys[old + new] = if from_old { self.keys[key] } else { coming[key] };
        }
    }

    /// Steps to the next row: faces that end are removed, the others are sorted again.
    pub(super) fn down(&mut self) {
        self.y += 1;
        let mut kept = 0;
        for i in 0..self.active {
            let slot = Key(self.keys[i]).number();
            let pair = &mut self.pairs[slot];
            if !pair.walk.down(&pair.triangle) {
                pair.next_free = self.free;
                self.free = slot;
                continue;
            }
            pair.row = pair.walk.row(self.frame_width, self.clip);
            let key = Key::new(pair.row.x0, slot).0;
            let mut index = kept;
            while index > 0 && self.keys[index - 1] > key {
                self.keys[index] = self.keys[index - 1];
                index -= 1;
            }
            self.keys[index] = key;
            kept += 1;
        }
        self.active = kept;
    }
}
