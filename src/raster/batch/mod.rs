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
//! Each stage is one function over `simd::Lanes8`, compiled for each level of the processor; only the last
//! one, the span kernel, is a level's own.
//!
//! A triangle larger than 2¹⁸ pixels is drawn by [`Raster::triangle`] when its turn comes. The bytes are those of a call of
//! it for each triangle in turn.

#[cfg(all(feature = "simd", target_arch = "x86_64"))]
use super::Interpolation;
use super::depth::{Cell, DepthBuffer};
use super::draw_stats::DrawStats;
use super::frame::Rect;
use super::triangle::Raster;
use crate::fixed::HAS_F64;
use crate::raster::shade::RESEED;
use crate::simd::{BASELINE, Lanes8, compiled_for_each_level};
use crate::span::Kernel;
use crate::span::list::SpanList;

mod class;
pub(crate) mod cull;
#[cfg(feature = "alloc")]
pub(super) mod found;
#[cfg(feature = "alloc")]
pub(crate) mod indexed;
mod rows;
mod setup;
#[cfg(feature = "alloc")]
pub(super) mod texture;
mod triangles;

pub use triangles::Batch;

use class::{ClassedIndex, SizeClass};
use cull::Survivors;
use setup::{Corners8, TriangleSetup8};
use triangles::{FrameLayout, LANES, MAX_WIDTH};

impl<D: Cell> Raster<'_, D> {
    /// Draws the triangles of a batch, one after the other: the bytes, depths and counts are those of
    /// [`triangle`](Self::triangle) called for each.
    #[doc(hidden)]
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
            let way = (layout, self.clip, self.kernel);
            drawn += match depth.map(DepthBuffer::values_mut) {
                None => draw_all(level, batch, triangles, way, pixels),
                Some(cells) => draw_where_nearer(batch, triangles, way, pixels, cells),
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

/// Where and with what triangles are drawn: the pixels' layout, the clip rectangle, and the kernel.
type Way = (FrameLayout, Rect, Kernel);

// Without type parameters, so that they are compiled in this crate, and not in each that draws.
compiled_for_each_level! {
    /// Draws these triangles, a [`ClassedIndex`] each and none unbatched.
    fn draw_all[][](batch: &Batch, kept: &[u32], way: Way, pixels: &mut [u8]) -> DrawStats = draw_all_by;
}

#[inline(always)]
fn draw_all_by<S: Lanes8>(s: S, batch: &Batch, kept: &[u32], way: Way, pixels: &mut [u8]) -> DrawStats {
    draw_triangles::<S, u32, false>(s, batch, kept, way, pixels, &mut [])
}

/// Likewise, where they are nearer than cells.
fn draw_where_nearer<D: Cell>(batch: &Batch, kept: &[u32], way: Way, pixels: &mut [u8], cells: &mut [D]) -> DrawStats {
    if let Some(cells) = D::as_u32(cells) {
        return draw_nearer(way.2.simd_level(), batch, kept, way, pixels, cells);
    }
    match D::as_u16(cells) {
        Some(cells) => draw_nearer_in_16_bits(batch, kept, way, pixels, cells),
        None => DrawStats::default(),
    }
}

compiled_for_each_level! {
    fn draw_nearer[][](batch: &Batch, kept: &[u32], way: Way, pixels: &mut [u8], cells: &mut [u32]) -> DrawStats
        = draw_nearer_by;
}

#[inline(always)]
fn draw_nearer_by<S: Lanes8>(
    s: S,
    batch: &Batch,
    kept: &[u32],
    way: Way,
    pixels: &mut [u8],
    cells: &mut [u32],
) -> DrawStats {
    draw_triangles::<S, u32, true>(s, batch, kept, way, pixels, cells)
}

/// Cells of 16 bits are for small machines: by what every processor of the target has.
#[inline(never)]
fn draw_nearer_in_16_bits(batch: &Batch, kept: &[u32], way: Way, pixels: &mut [u8], cells: &mut [u16]) -> DrawStats {
    draw_triangles::<_, u16, true>(BASELINE, batch, kept, way, pixels, cells)
}

#[inline(always)]
fn draw_triangles<S: Lanes8, D: Cell, const DEPTHS: bool>(
    s: S,
    batch: &Batch,
    kept: &[u32],
    (layout, clip, kernel): Way,
    pixels: &mut [u8],
    cells: &mut [D],
) -> DrawStats {
    // Nobody comes here then, and a chip's program must not hold what follows.
    if !HAS_F64 {
        return DrawStats::default();
    }
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
