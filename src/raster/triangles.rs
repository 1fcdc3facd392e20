//! Many triangles at once, by vertices.

use super::columns::{Columns, Picks, ScreenPos, Triangles};
use super::cull::{PickList, cull, pick};
use super::depth::Cell;
use super::draw_stats::DrawStats;
use super::interpolation::Interpolation;
use super::pick::CHUNK;
use super::triangle::Raster;
use super::vertex::Vertex;
use crate::fixed::U8F8;
use crate::lanes::LANES;

/// The corners of all triangles of a batch.
const CORNERS: usize = 3 * Batch::CAPACITY;

/// The indices of triangles whose corners follow each other.
#[expect(clippy::cast_possible_truncation, reason = "no more than 384")]
const INDICES: [[u32; 3]; Batch::CAPACITY] = {
    let mut indices = [[0; 3]; Batch::CAPACITY];
    let mut i = 0;
    while i < Batch::CAPACITY {
        let first = 3 * i as u32;
        indices[i] = [first, first + 1, first + 2];
        i += 1;
    }
    indices
};

/// Triangles to be drawn one after the other.
#[derive(Clone, Debug)]
pub struct Batch {
    count: usize,
    at: [ScreenPos; CORNERS],
    depth: [u32; CORNERS],
    shade: [[U8F8; 2]; CORNERS],
    interpolation: [Interpolation; Self::CAPACITY],
}

impl Batch {
    /// The most triangles.
    pub const CAPACITY: usize = 128;

    /// Without a triangle.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            count: 0,
            at: [ScreenPos::new(0, 0); CORNERS],
            depth: [0; CORNERS],
            shade: [[U8F8::from_bits(0); 2]; CORNERS],
            interpolation: [Interpolation::Flat(0); Self::CAPACITY],
        }
    }

    /// Returns whether triangles of this shading can be put into a batch: those that have exact cover.
    #[must_use]
    #[inline]
    pub const fn takes(interpolation: Interpolation) -> bool {
        interpolation.has_exact_cover()
    }

    /// Puts a triangle behind the others. Returns `false`, and leaves it out, if the batch is full or does not
    /// [take](Self::takes) this shading.
    #[inline]
    pub fn push(&mut self, vertices: &[Vertex; 3], interpolation: Interpolation) -> bool {
        if self.count >= Self::CAPACITY || !Self::takes(interpolation) {
            return false;
        }
        let first = 3 * self.count;
        for (corner, v) in vertices.iter().enumerate() {
            self.at[first + corner] = ScreenPos::of(v);
            self.depth[first + corner] = v.depth();
            // A flat triangle is one whose corners agree: the nearest of a whole shade is that shade.
            let shade = match interpolation {
                Interpolation::Flat(index) => U8F8::from(index),
                _ => v.shade(),
            };
            self.shade[first + corner] = [shade; 2];
        }
        self.interpolation[self.count] = interpolation;
        self.count += 1;
        true
    }

    /// Number of triangles in the batch.
    #[must_use]
    #[inline]
    pub const fn len(&self) -> usize {
        self.count
    }

    /// Returns whether the batch holds no triangle.
    #[must_use]
    #[inline]
    pub const fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Returns whether there is no room left.
    #[must_use]
    #[inline]
    pub const fn is_full(&self) -> bool {
        self.count == Self::CAPACITY
    }

    /// Takes all triangles out.
    #[inline]
    pub const fn clear(&mut self) {
        self.count = 0;
    }

    /// The end of the triangles from `first` on that are drawn together, and the shading of all of them: a flat one is like
    /// one whose rows do not start anew.
    fn run(&self, first: usize) -> (usize, Interpolation) {
        let drawn_by = |at: usize| match self.interpolation[at] {
            Interpolation::Flat(_) => Interpolation::Gouraud,
            interpolation => interpolation,
        };
        let of_first = drawn_by(first);
        let end = (first..self.count).find(|at| drawn_by(*at) != of_first).unwrap_or(self.count);
        (end, of_first)
    }
}

impl Default for Batch {
    fn default() -> Self {
        Self::new()
    }
}

impl<D: Cell> Raster<'_, D> {
    /// Draws triangles in the order in which they come: bytes, depths and counts are those of
    /// [`triangle`](Self::triangle) called for each. All but vintage ones are culled 128 and set up eight at a time, which is
    /// several times as fast where they are small.
    ///
    /// ```
    /// use mode13h::fixed::{I24F8, U8F8};
    /// use mode13h::raster::{Frame, Interpolation, Raster, Vertex};
    ///
    /// let at = |x, y| Vertex::new(I24F8::from(x), I24F8::from(y), U8F8::from(9), 0);
    /// let [a, b, c, d] = [at(0, 0)?, at(8, 0)?, at(8, 4)?, at(0, 4)?];
    /// let mut bytes = [0_u8; 8 * 4];
    /// let drawn = Raster::new(Frame::new(&mut bytes, 8, 4, 8)?)
    ///     .triangles([[a, b, c], [a, c, d]].iter().map(|corners| (corners, Interpolation::Gouraud)));
    /// assert_eq!(drawn.pixels, 32);
    /// assert_eq!(bytes, [9; 32]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn triangles<'t>(
        &mut self,
        triangles: impl IntoIterator<Item = (&'t [Vertex; 3], Interpolation)>,
    ) -> DrawStats {
        let (mut drawn, mut batch) = (DrawStats::default(), Batch::new());
        for (vertices, interpolation) in triangles {
            if batch.push(vertices, interpolation) {
                continue;
            }
            drawn += self.batch(&batch);
            batch.clear();
            if !batch.push(vertices, interpolation) {
                drawn += self.triangle(vertices, interpolation);
            }
        }
        drawn += self.batch(&batch);
        drawn
    }

    internal! {
    /// Draws the triangles of a batch, one after the other: the bytes, depths and counts are those of
    /// [`triangle`](Self::triangle) called for each.
    fn batch(&mut self, batch: &Batch) -> DrawStats {
        let mut drawn = DrawStats::default();
        let columns = Columns {
            at: &batch.at,
            depth: &batch.depth,
            shade: &batch.shade,
            #[cfg(feature = "alloc")]
            effects: Default::default(),
        };
        let triangles = Triangles { columns, indices: &INDICES };
        let level = self.kernel.simd_level();
        let mut first = 0;
        while first < batch.count {
            let (end, interpolation) = batch.run(first);
            let mut list = PickList::<{ Batch::CAPACITY + LANES }>::new();
            for chunk in (first..end).step_by(CHUNK) {
                let masks = cull(level, &batch.at, &INDICES[chunk..end.min(chunk + CHUNK)], self.clip, false);
                // Below 128.
                pick(level, &mut list, chunk as u32, &masks, masks.covers);
            }
            drawn += self.picks(&triangles, Picks { picks: list.as_slice(), flat: &[] }, interpolation);
            first = end;
        }
        drawn
    }
    }
}
