//! The triangles of a batch, as a structure of arrays, and what bounds them.

use crate::fixed::{I24F8, U8F8};
use crate::lanes::three;
use crate::raster::Interpolation;
use crate::raster::depth::DepthPlane;
use crate::raster::shade::RESEED;
use crate::raster::vertex::Vertex;

/// Triangles at a time, or rows of one.
pub(super) const LANES: usize = 8;
/// The widest that a small triangle is, in pixels: a span of that many has no start but its first.
pub(super) const MAX_COLUMNS: i32 = 64;
/// The highest.
pub(super) const MAX_ROWS: i32 = 16;
/// The widest that the box of a large triangle is, in 1/256 pixel, and the highest.
pub(super) const MAX_WIDTH: i32 = 1_024 * 256;
pub(super) const MAX_HEIGHT: i32 = 4_096 * 256;
/// The most squares of four pixels a side that the box has, sides rounded up: 2³⁴ units.
pub(super) const MAX_AREA_4X4: i32 = 1 << 14;
/// Pieces of a row, each of which starts anew.
pub(super) const MAX_PIECES: usize = MAX_WIDTH as usize / 256 / RESEED as usize;

/// Where the pixels of a frame lie.
#[derive(Clone, Copy)]
pub(super) struct FrameLayout {
    /// The row whose pixels come first.
    pub(super) first_row: u32,
    /// Pixels from one row to the next, at most 2¹⁶, ...
    pub(super) pitch: u32,
    /// ... and cells of the depth buffer.
    pub(super) width: u32,
}

/// Triangles to be drawn one after the other, in arrays.
#[derive(Clone, Debug)]
pub struct Batch {
    pub(super) count: usize,
    /// True if triangles of no pixel have mostly been left out already: to look for more does not pay.
    pub(super) is_culled: bool,
    /// The corners of all triangles: x and y in 1/256 pixel, shade in 1/256.
    pub(super) x: [[i32; Self::CAPACITY]; 3],
    pub(super) y: [[i32; Self::CAPACITY]; 3],
    pub(super) shade: [[u16; Self::CAPACITY]; 3],
    pub(super) depth: [[u32; Self::CAPACITY]; 3],
    pub(super) interpolation: [Interpolation; Self::CAPACITY],
}

impl Batch {
    /// The most triangles. With 64 the group of eight that ends a batch is oftener part empty.
    pub const CAPACITY: usize = 128;

    /// Without a triangle.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            count: 0,
            is_culled: false,
            x: [[0; Self::CAPACITY]; 3],
            y: [[0; Self::CAPACITY]; 3],
            shade: [[0; Self::CAPACITY]; 3],
            depth: [[0; Self::CAPACITY]; 3],
            interpolation: [Interpolation::Flat(0); Self::CAPACITY],
        }
    }

    /// One for triangles of which those that cover no pixel have mostly been left out.
    #[cfg(feature = "alloc")]
    pub(crate) const fn of_culled() -> Self {
        Self { is_culled: true, ..Self::new() }
    }

    /// Returns whether triangles of this shading can be put into a batch: flat ones, and those linear in 8.8.
    #[must_use]
    #[inline]
    #[doc(hidden)]
    pub const fn takes(interpolation: Interpolation) -> bool {
        matches!(interpolation, Interpolation::Flat(_) | Interpolation::Gouraud | Interpolation::GouraudReseeded)
    }

    /// Puts a triangle behind the others. Returns `false`, and leaves it out, if the batch is full or does not
    /// [take](Self::takes) this shading.
    #[inline]
    pub fn push(&mut self, vertices: &[Vertex; 3], interpolation: Interpolation) -> bool {
        let at = self.count;
        if at >= Self::CAPACITY || !Self::takes(interpolation) {
            return false;
        }
        for (corner, v) in vertices.iter().enumerate() {
            self.x[corner][at] = v.x().to_bits();
            self.y[corner][at] = v.y().to_bits();
            // A flat triangle is one whose corners agree: the nearest of a whole shade is that shade.
            self.shade[corner][at] = match interpolation {
                Interpolation::Flat(index) => u16::from(index) << 8,
                _ => v.shade().to_bits(),
            };
            self.depth[corner][at] = v.depth();
        }
        self.interpolation[at] = interpolation;
        self.count = at + 1;
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
    #[doc(hidden)]
    pub const fn is_full(&self) -> bool {
        self.count == Self::CAPACITY
    }

    /// Takes all triangles out.
    #[inline]
    pub const fn clear(&mut self) {
        self.count = 0;
    }

    pub(super) fn depth_plane(&self, at: usize) -> DepthPlane {
        let at = at % Self::CAPACITY;
        DepthPlane::of_corners(three([0, 1, 2], |corner| {
            (self.x[corner][at], self.y[corner][at], self.depth[corner][at])
        }))
    }

    /// The most pieces that start anew in a row of a large triangle.
    #[inline(always)]
    pub(super) fn pieces(&self, at: usize) -> usize {
        if self.interpolation[at] != Interpolation::GouraudReseeded {
            return 1;
        }
        let [a, b, c] = three(self.x.each_ref(), |x| x[at]);
        // As in `culler`; at most 1,024 pixels.
        let columns = ((a.max(b).max(c) + 127) >> 8) - ((a.min(b).min(c) + 127) >> 8);
        ((columns - 1) as usize / RESEED as usize + 1).clamp(1, MAX_PIECES)
    }

    /// A triangle as it was put in, but that the vertices of a flat one have its shade.
    pub(super) fn triangle(&self, at: usize) -> ([Vertex; 3], Interpolation) {
        let vertex = |corner: usize| {
            let (x, y) = (I24F8::from_bits(self.x[corner][at]), I24F8::from_bits(self.y[corner][at]));
            let shade = U8F8::from_bits(self.shade[corner][at]);
            // They came out of a vertex; with another shade none would be drawn.
            Vertex::new(x, y, shade, self.depth[corner][at]).unwrap_or_default()
        };
        ([vertex(0), vertex(1), vertex(2)], self.interpolation[at])
    }
}

impl Default for Batch {
    fn default() -> Self {
        Self::new()
    }
}
