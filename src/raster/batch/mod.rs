//! Batches: many triangles at once, eight lanes at a time.
//!
//! Half of the triangles of a fine model cover no pixel centre, and most of the others a few. So a triangle's own
//! work has to be small: no sorting by branches, no division for itself, no loop for a row of one pixel. A
//! [`Batch`] holds triangles as a structure of arrays. A triangle is culled once, set up once, and becomes spans once:
//!
//! | stage | lanes | what |
//! |---|---|---|
//! | `cull` | triangles | which have a pixel centre in their box, and if that is tiny in themselves; their size class |
//! | `setup` | triangles | edges, shade plane and depth plane |
//! | `rows` | triangles, or rows of one | ends and first shades of rows, into a list of spans |
//! | `span::list` | pixels | the bytes |
//!
//! Each stage is one function over [`Lanes8`](crate::simd::Lanes8), compiled for each level of the processor; only the last
//! one, the span kernel, is a level's own.
//!
//! A triangle larger than 2¹⁸ pixels is drawn by [`Raster::triangle`] when its turn comes. The bytes are those of a call of
//! it for each triangle in turn.

use super::Interpolation;
use super::depth::{Cell, DepthPlane};
use super::draw_stats::DrawStats;
use super::frame::Rect;
use super::triangle::Raster;
use super::vertex::Vertex;
use crate::fixed::{HAS_F64, I24F8, U8F8};
use crate::raster::shade::RESEED;
use crate::simd::{Lanes8, compiled_for_each_level};
use crate::span::Kernel;
use crate::span::list::SpanList;

pub(crate) mod cull;
#[cfg(feature = "alloc")]
pub(crate) mod indexed;
mod rows;
mod setup;

use cull::{ClassedIndex, SizeClass, Survivors};
use setup::{Corners8, LANES, TriangleSetup8};

/// The widest that a small triangle is, in pixels: a span of that many has no start but its first.
const MAX_COLUMNS: i32 = 64;
/// The highest.
const MAX_ROWS: i32 = 16;
/// The widest that the box of a large triangle is, in 1/256 pixel, and the highest.
const MAX_WIDTH: i32 = 1_024 * 256;
const MAX_HEIGHT: i32 = 4_096 * 256;
/// The most squares of four pixels a side that the box has, sides rounded up: 2³⁴ units.
const MAX_AREA_4X4: i32 = 1 << 14;
/// Pieces of a row, each of which starts anew.
const MAX_PIECES: usize = MAX_WIDTH as usize / 256 / RESEED as usize;

/// Where the pixels of a frame lie.
#[derive(Clone, Copy)]
struct FrameLayout {
    /// The row whose pixels come first.
    first_row: u32,
    /// Pixels from one row to the next, at most 2¹⁶, ...
    pitch: u32,
    /// ... and cells of the depth buffer.
    width: u32,
}

/// Triangles to be drawn one after the other, in arrays.
#[derive(Clone, Debug)]
pub struct Batch {
    count: usize,
    /// True if triangles of no pixel have mostly been left out already: to look for more does not pay.
    is_sifted: bool,
    /// The corners of all triangles: x and y in 1/256 pixel, shade in 1/256.
    x: [[i32; Self::CAPACITY]; 3],
    y: [[i32; Self::CAPACITY]; 3],
    shade: [[u16; Self::CAPACITY]; 3],
    depth: [[u32; Self::CAPACITY]; 3],
    interpolation: [Interpolation; Self::CAPACITY],
}

impl Batch {
    /// The most triangles. With 64 the group of eight that ends a batch is oftener part empty.
    pub const CAPACITY: usize = 128;

    /// Without a triangle.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            count: 0,
            is_sifted: false,
            x: [[0; Self::CAPACITY]; 3],
            y: [[0; Self::CAPACITY]; 3],
            shade: [[0; Self::CAPACITY]; 3],
            depth: [[0; Self::CAPACITY]; 3],
            interpolation: [Interpolation::Flat(0); Self::CAPACITY],
        }
    }

    /// One for triangles of which those that cover no pixel have mostly been left out.
    #[cfg(feature = "alloc")]
    pub(crate) const fn of_sifted() -> Self {
        Self { is_sifted: true, ..Self::new() }
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

    fn depth_plane(&self, at: usize) -> DepthPlane {
        let at = at % Self::CAPACITY;
        DepthPlane::of_corners([0, 1, 2].map(|corner| (self.x[corner][at], self.y[corner][at], self.depth[corner][at])))
    }

    /// The most pieces that start anew in a row of a large triangle.
    fn pieces(&self, at: usize) -> usize {
        if self.interpolation[at] != Interpolation::GouraudReseeded {
            return 1;
        }
        let [a, b, c] = self.x.each_ref().map(|x| x[at]);
        // As in `sieve`; at most 1,024 pixels.
        let columns = ((a.max(b).max(c) + 127) >> 8) - ((a.min(b).min(c) + 127) >> 8);
        ((columns - 1) as usize / RESEED as usize + 1).clamp(1, MAX_PIECES)
    }

    /// A triangle as it was put in, but that the vertices of a flat one have its shade.
    fn triangle(&self, at: usize) -> ([Vertex; 3], Interpolation) {
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

impl<D: Cell> Raster<'_, D> {
    /// Draws the triangles of a batch, one after the other: the bytes, depths and counts are those of
    /// [`triangle`](Self::triangle) called for each.
    pub fn batch(&mut self, batch: &Batch) -> DrawStats {
        self.draw_batch::<true>(batch)
    }

    /// Draws the triangles of a batch that all lie wholly inside the frame, one after the other.
    ///
    /// The bytes, depths and counts are those of [`triangle_inside`](Self::triangle_inside) called for each.
    #[doc(hidden)]
    pub fn batch_inside(&mut self, batch: &Batch) -> DrawStats {
        self.draw_batch::<false>(batch)
    }

    fn draw_batch<const CLIPS: bool>(&mut self, batch: &Batch) -> DrawStats {
        let mut drawn = DrawStats::default();
        let (_, pitch) = self.frame.pixels_mut();
        let (width, rows) = (self.frame.width(), self.frame.rows());
        // Offsets of pixels are kept in 32 bits, and a depth buffer has to hold the frame's rows and no others.
        let fits = pitch <= 1 << 16 && self.depth.as_ref().is_none_or(|depth| depth.holds(width, &rows));
        if !HAS_F64 || !fits {
            for at in 0..batch.count {
                drawn += self.draw_single::<CLIPS>(batch, at);
            }
            return drawn;
        }
        let level = self.kernel.simd_level();
        let mut kept = Survivors::new();
        cull::cull(level, batch, self.clip, &mut kept);
        let layout = FrameLayout { first_row: rows.start, pitch: pitch as u32, width };
        let mut left = kept.as_slice();
        while let Some(&first) = left.first() {
            let together = ClassedIndex::count_batched(left);
            if together == 0 {
                drawn += self.draw_single::<CLIPS>(batch, ClassedIndex(first).index());
                left = &left[1..];
                continue;
            }
            let (triangles, rest) = left.split_at(together);
            let (pixels, _) = self.frame.pixels_mut();
            // In a build that leaves it out (`plan::Effect::is_left_out`) there is none.
            let depth = self.depth.as_mut().filter(|_| !cfg!(mode13h_leave_out = "hidden-surfaces"));
            drawn += match depth {
                None => draw_triangles::<u32, false>(
                    level,
                    batch,
                    triangles,
                    (layout, self.clip),
                    self.kernel,
                    pixels,
                    &mut [],
                ),
                Some(depth) => {
                    let cells = depth.values_mut();
                    draw_triangles::<D, true>(level, batch, triangles, (layout, self.clip), self.kernel, pixels, cells)
                }
            };
            left = rest;
        }
        drawn
    }

    fn draw_single<const CLIPS: bool>(&mut self, batch: &Batch, at: usize) -> DrawStats {
        let (vertices, interpolation) = batch.triangle(at);
        if CLIPS { self.triangle(&vertices, interpolation) } else { self.triangle_inside(&vertices, interpolation) }
    }
}

compiled_for_each_level! {
    /// Draws these triangles, a [`ClassedIndex`] each and none unbatched; with `DEPTHS` where they are nearer than cells.
    fn draw_triangles[D: Cell, const DEPTHS: bool][D, DEPTHS](
        batch: &Batch,
        kept: &[u32],
        layout: (FrameLayout, Rect),
        kernel: Kernel,
        pixels: &mut [u8],
        cells: &mut [D],
    ) -> DrawStats = draw_triangles_by;
}

#[inline(always)]
fn draw_triangles_by<S: Lanes8, D: Cell, const DEPTHS: bool>(
    s: S,
    batch: &Batch,
    kept: &[u32],
    (layout, clip): (FrameLayout, Rect),
    kernel: Kernel,
    pixels: &mut [u8],
    cells: &mut [D],
) -> DrawStats {
    let mut list = SpanList::new((pixels.len(), layout.pitch), (cells.len(), layout.width));
    let mut setup = TriangleSetup8::NONE;
    let mut corners = Corners8::NONE;
    corners.gather::<DEPTHS>(batch, kept);
    for (number, eight) in kept.chunks(LANES).enumerate() {
        setup.set_up::<S, DEPTHS>(s, &corners, layout);
        // The next before this one's rows enter the list: vectors that are read just after their numbers were stored
        // one by one wait for these. (3 to 6 % of the time of triangles of 0.6 pixels.)
        corners.gather::<DEPTHS>(batch, &kept[kept.len().min((number + 1) * LANES)..]);
        setup.rows[eight.len().min(LANES)..].fill(0);
        if !list.has_room(LANES * LANES) {
            list.draw_by::<D, DEPTHS>(kernel, pixels, cells);
        }
        let are_small = ClassedIndex::are_small(eight);
        if are_small {
            let most = setup.rows.iter().fold(0, |most, &rows| if rows > most { rows } else { most });
            if most <= rows::MAX_SHORT_ROWS {
                rows::list_short::<S, DEPTHS>(s, &setup, most, &mut list);
                continue;
            }
        }
        for (i, &triangle) in eight.iter().enumerate() {
            let (triangle, rows) = (ClassedIndex(triangle), setup.rows[i % LANES]);
            if triangle.class() == SizeClass::Small {
                for first in (0..rows).step_by(LANES) {
                    if !list.has_room(LANES) {
                        list.draw_by::<D, DEPTHS>(kernel, pixels, cells);
                    }
                    rows::list_eight_rows::<S, DEPTHS>(s, &setup, (i, first), &mut list);
                }
                continue;
            }
            // A triangle without area has no rows, and no plane.
            if rows <= 0 {
                continue;
            }
            if DEPTHS {
                setup.put_depth_plane(i, &batch.depth_plane(triangle.index()));
            }
            let clip = (triangle.class() == SizeClass::CrossesClip).then_some(clip);
            let pieces = batch.pieces(triangle.index());
            // A row that does not start anew is one piece, however long.
            let longest = if pieces > 1 { RESEED } else { MAX_WIDTH / 256 };
            let (mut first, mut end) = (0, rows);
            if let Some(clip) = clip {
                // All inside a frame, at most 4,096.
                let row = setup.row[i % LANES];
                (first, end) = ((clip.y0 as i32 - row).max(0), end.min(clip.y1 as i32 - row));
            }
            #[cfg(all(feature = "simd", target_arch = "x86_64"))]
            if !DEPTHS
                && triangle.class() == SizeClass::Large
                && let Some(avx512) = kernel.avx512()
            {
                list.draw_by::<D, DEPTHS>(kernel, pixels, cells);
                let reseeds = batch.interpolation[triangle.index()] == Interpolation::GouraudReseeded;
                list.count(crate::span::fill_large(avx512, pixels, &setup.large_triangle(i, layout, reseeds)));
                continue;
            }
            while first < end {
                if !list.has_room(LANES * pieces) {
                    list.draw_by::<D, DEPTHS>(kernel, pixels, cells);
                }
                let (part, cut) = ((i, first), (pieces, longest));
                rows::list_pieces::<S, DEPTHS>(s, &setup, part, cut, clip, &mut list);
                first += LANES as i32;
            }
        }
    }
    list.draw_by::<D, DEPTHS>(kernel, pixels, cells);
    let (spans, covered, nearer) = list.counts();
    let (pixels, tested) = if DEPTHS { (nearer, covered) } else { (covered, 0) };
    DrawStats { spans, covered, pixels, tested, ..DrawStats::default() }
}
