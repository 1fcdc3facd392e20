//! The active list: the faces that the row at hand crosses, each with its two edges.

use super::Key;
use crate::raster::cover::{SortedTriangle, point};
use crate::raster::depth::DepthPlane;
use crate::raster::edge::Edge;
use crate::raster::frame::Rect;
use crate::raster::interpolation::Interpolation;
use crate::raster::paint::RowShader;
use crate::raster::vertex::Vertex;

/// A face on its way down the rows: the two edges that the row at hand crosses. Opaque; the caller
/// lends a slice of them ([`Scratch`](super::Scratch)).
#[derive(Clone, Copy, Debug, Default)]
pub struct EdgePair {
    triangle: SortedTriangle,
    pub(super) interpolation: Interpolation,
    /// Its index among the faces: the first of equal depths has the pixel.
    pub(super) order: usize,
    /// From the top to the bottom.
    long: Edge,
    /// From the top to the middle, then from there to the bottom.
    short: Edge,
    /// The first row of the lower short edge.
    split: i32,
    /// The row after the last.
    end: i32,
    /// The row's first pixel inside the frame.
    pub(super) origin: i32,
    /// The row's first pixel inside the clip rectangle.
    pub(super) x0: i32,
    /// The pixel after the row's last; not after `x0` where the row has none.
    pub(super) x1: i32,
    /// The row's last pixel inside the frame.
    pub(super) last: i32,
    /// True if it hides the background wherever it is: the depths of its vertices are above 0.
    pub(super) hides_background: bool,
    paint: Option<RowShader>,
    depth: Option<DepthPlane>,
    /// The next free index, where no face has this one.
    next_free: usize,
}

impl EdgePair {
    fn new(order: usize, vertices: &[Vertex; 3], interpolation: Interpolation, y: i32, clip: Rect) -> Self {
        let triangle = SortedTriangle::new(vertices);
        let [top, middle, bottom] = triangle.vertices.each_ref().map(point);
        let split = triangle.vertices[1].y().first_centre();
        let short = if y < split { (top, middle) } else { (middle, bottom) };
        Self {
            triangle,
            interpolation,
            order,
            long: Edge::at_row(top, bottom, y),
            short: Edge::at_row(short.0, short.1, y),
            split,
            // As in `SortedTriangle::extent`.
            end: triangle.vertices[2].y().first_centre().min(clip.y1 as i32),
            hides_background: vertices.iter().all(|v| v.depth() > 0),
            ..Self::default()
        }
    }

    /// Its pixels on the row.
    #[inline]
    fn cross(&mut self, clip: Rect, frame_width: u32) {
        let (left, right) =
            if self.triangle.doubled_area > 0 { (self.long.x, self.short.x) } else { (self.short.x, self.long.x) };
        // A frame has at most 4,096 columns.
        self.origin = left.max(0);
        self.x0 = self.origin.max(clip.x0 as i32);
        self.x1 = right.min(frame_width.min(clip.x1) as i32);
        self.last = right.min(frame_width as i32) - 1;
    }

    /// Steps to row `y`, the next. Returns whether it has that row.
    #[inline]
    fn down(&mut self, y: i32) -> bool {
        if y >= self.end {
            return false;
        }
        self.long.down();
        if y == self.split {
            let [_, middle, bottom] = self.triangle.vertices.each_ref().map(point);
            self.short = Edge::at_row(middle, bottom, y);
        } else {
            self.short.down();
        }
        true
    }

    /// Its shades, worked out when it first has a pixel.
    #[inline]
    pub(super) fn paint(&mut self) -> &RowShader {
        self.paint.get_or_insert_with(|| RowShader::new(&self.triangle, self.interpolation))
    }

    /// Its depths, worked out when it first meets another face.
    #[inline]
    pub(super) fn depth(&mut self) -> &DepthPlane {
        self.depth.get_or_insert_with(|| DepthPlane::new(&self.triangle))
    }
}

/// The active list, sorted by the first column of each face.
pub(super) struct List<'a> {
    /// Keys of a column and a place in `pairs`.
    keys: &'a mut [u64],
    active: usize,
    pairs: &'a mut [EdgePair],
    /// The first place in `pairs` that a face has left, or `used`.
    free: usize,
    /// Places in `pairs` that a face has ever had. They are used again, so that few are, and these
    /// stay in the cache.
    used: usize,
    y: i32,
    clip: Rect,
    frame_width: u32,
}

impl<'a> List<'a> {
    pub(super) fn new(keys: &'a mut [u64], pairs: &'a mut [EdgePair], clip: Rect, frame_width: u32) -> Self {
        Self { keys, active: 0, pairs, free: 0, used: 0, y: 0, clip, frame_width }
    }

    /// The row at hand, or `None` if no face is active.
    pub(super) fn row(&self) -> Option<i32> {
        (self.active > 0).then_some(self.y)
    }

    /// The key at this place of the list.
    #[inline]
    pub(super) fn key(&self, place: usize) -> Option<Key> {
        self.keys[..self.active].get(place).map(|key| Key(*key))
    }

    #[inline]
    pub(super) fn pair(&self, slot: usize) -> &EdgePair {
        &self.pairs[slot]
    }

    #[inline]
    pub(super) fn pair_mut(&mut self, slot: usize) -> &mut EdgePair {
        &mut self.pairs[slot]
    }

    /// Takes in the faces that begin at row `y`. `coming` holds their keys, and is used up.
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
            *pair = EdgePair::new(order, vertices, *interpolation, y, self.clip);
            pair.cross(self.clip, self.frame_width);
            *key = Key::new(pair.x0, slot).0;
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

    /// Steps to the next row: faces that end leave, the others are put in order again.
    pub(super) fn down(&mut self) {
        self.y += 1;
        let mut kept = 0;
        for i in 0..self.active {
            let slot = Key(self.keys[i]).number();
            let pair = &mut self.pairs[slot];
            if !pair.down(self.y) {
                pair.next_free = self.free;
                self.free = slot;
                continue;
            }
            pair.cross(self.clip, self.frame_width);
            let key = Key::new(pair.x0, slot).0;
            let mut place = kept;
            while place > 0 && self.keys[place - 1] > key {
                self.keys[place] = self.keys[place - 1];
                place -= 1;
            }
            self.keys[place] = key;
            kept += 1;
        }
        self.active = kept;
    }
}
