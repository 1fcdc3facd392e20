//! Turns picked triangles into spans, eight at a time.
//!
//! Half of the triangles of a fine model cover no pixel centre, and most of the others a few. So the work per triangle
//! has to be small: no sorting by branches, no division of its own, no loop for a row of one pixel. A triangle is
//! culled once, set up once, and becomes spans once:
//!
//! | stage | lanes | what |
//! |---|---|---|
//! | `cull` | triangles | which have a pixel centre in their box, and if that is tiny, in the triangle; their size class |
//! | `setup` | triangles | edges, shade plane and depth plane |
//! | `rows` | triangles, or rows of one | ends and first shades of rows, into a list of spans |
//! | `span::list`, or `shaded` | pixels | the bytes |
//!
//! Each stage is one function over `simd::Lanes8`, compiled for each level of the processor; only the last, the span
//! kernel, is written separately for each level.
//!
//! A triangle larger than 2¹⁸ pixels is drawn by [`Raster::triangle`] when its turn comes. The bytes are those of
//! calling it for each triangle in turn.

use super::columns::{Picks, Triangles};
use super::depth::{Cell, DepthBuffer};
use super::draw_stats::DrawStats;
use super::frame::Rect;
use super::interpolation::Interpolation;
use super::pick::{MAX_WIDTH, Pick, SizeClass};
use super::reference::depth::DepthPlane;
use super::reference::shade::RESEED;
use super::rows::{self, Linear, Shades8};
use super::setup::{Corners8, FrameLayout, TriangleSetup8};
use super::shaded::{Kind, Shaded8};
use super::triangle::Raster;
use crate::fixed::HAS_F64;
use crate::lanes::{LANES, three};
use crate::simd::{Lanes8, compiled_for_each_level};
use crate::span::list::{SpanList, Target};

/// Triangles, and whether their rows are split into pieces of 64 pixels, with which linear shades are reseeded.
#[derive(Clone, Copy)]
pub(super) struct Drawn<'a> {
    pub(super) triangles: &'a Triangles<'a>,
    pub(super) picks: Picks<'a>,
    pub(super) in_pieces: bool,
}

impl Drawn<'_> {
    fn depth_plane(&self, pick: Pick) -> DepthPlane {
        let columns = &self.triangles.columns;
        DepthPlane::of_corners(three(self.triangles.corners(pick), |i| {
            let at = columns.at[i];
            (at.x(), at.y(), columns.depth[i])
        }))
    }

    /// The most pieces of a row of a large triangle.
    #[inline(always)]
    fn pieces(&self, pick: Pick) -> usize {
        if !self.in_pieces {
            return 1;
        }
        self.triangles.pieces(pick)
    }
}

impl<D: Cell> Raster<'_, D> {
    /// Draws triangles that were picked inside the clip rectangle, in order: bytes, depths and counts are those of
    /// calling [`triangle`](Self::triangle) for each.
    pub(crate) fn picks(
        &mut self,
        triangles: &Triangles<'_>,
        picks: Picks<'_>,
        interpolation: Interpolation,
    ) -> DrawStats {
        let mut drawn = DrawStats::default();
        let (_, pitch) = self.frame.pixels_mut();
        let (width, rows) = (self.frame.width(), self.frame.rows());
        let fits = self.fits_lists();
        let kind = Kind::of(interpolation).filter(|_| picks.flat.is_empty());
        let in_pieces = match interpolation {
            Interpolation::GouraudReseeded if HAS_F64 && fits => picks.flat.is_empty(),
            Interpolation::Gouraud | Interpolation::Flat(_) if HAS_F64 && fits => false,
            _ if HAS_F64 && fits && kind.is_some() => true,
            _ => {
                for k in 0..picks.picks.len() {
                    drawn += self.triangle_by_rows(&triangles.vertices(&picks, k), interpolation);
                }
                return drawn;
            }
        };
        let level = self.kernel.simd_level();
        let layout = FrameLayout { first_row: rows.start, pitch: pitch as u32, width };
        let (mut first, count) = (0, picks.picks.len());
        while first < count {
            let together = Pick::count_batched(&picks.picks[first..]);
            if together == 0 {
                drawn += self.triangle_by_rows(&triangles.vertices(&picks, first), interpolation);
                first += 1;
                continue;
            }
            let (pixels, _) = self.frame.pixels_mut();
            // A build that leaves out hidden surfaces (`plan::Effect::is_left_out`) has no depth.
            let depth = self.depth.as_mut().filter(|_| !cfg!(mode13h_leave_out = "hidden-surfaces"));
            let target = &mut Target { pixels, cells: depth.map(DepthBuffer::cells), kernel: self.kernel };
            let place = (layout, self.clip);
            let of = Drawn { triangles, picks: picks.range(first, first + together), in_pieces };
            drawn += match (kind, &target.cells) {
                (Some(kind), _) => draw_shaded(level, of, kind, place, target),
                (None, Some(_)) => draw_nearer(level, of, place, target),
                (None, None) => draw_all(level, of, place, target),
            };
            first += together;
        }
        drawn
    }
}

impl<D: Cell> Raster<'_, D> {
    /// Returns whether lists can hold the positions of spans: offsets of pixels have 32 bits, and a depth buffer must
    /// hold exactly the frame's rows.
    pub(super) fn fits_lists(&mut self) -> bool {
        let (_, pitch) = self.frame.pixels_mut();
        let (width, rows) = (self.frame.width(), self.frame.rows());
        pitch <= 1 << 16 && self.depth.as_ref().is_none_or(|depth| depth.holds(width, &rows))
    }
}

/// Where triangles are drawn: the pixels' layout, and the clip rectangle.
pub(super) type Place = (FrameLayout, Rect);

// Without type parameters, so that they are compiled in this crate, and not in each that draws.
compiled_for_each_level! {
    /// Draws triangles, none of which is unbatched.
    fn draw_all[][](of: Drawn<'_>, place: Place, target: &mut Target<'_>) -> DrawStats = draw_all_by;
}

#[inline(always)]
fn draw_all_by<S: Lanes8>(s: S, of: Drawn<'_>, place: Place, target: &mut Target<'_>) -> DrawStats {
    draw_triangles::<S, Linear, false, false>(s, of, place, target, &mut Linear, &mut { SpanList::NONE })
}

compiled_for_each_level! {
    /// Draws triangles, none of which is unbatched, where they are nearer than the cells.
    fn draw_nearer[][](of: Drawn<'_>, place: Place, target: &mut Target<'_>) -> DrawStats = draw_nearer_by;
}

#[inline(always)]
fn draw_nearer_by<S: Lanes8>(s: S, of: Drawn<'_>, place: Place, target: &mut Target<'_>) -> DrawStats {
    draw_triangles::<S, Linear, true, true>(s, of, place, target, &mut Linear, &mut { SpanList::NONE })
}

compiled_for_each_level! {
    /// Draws triangles with a shading other than a linear one in 8.8; if there are cells, only where they are nearer.
    #[inline(never)]
    fn draw_shaded[][](of: Drawn<'_>, kind: Kind, place: Place, target: &mut Target<'_>) -> DrawStats
        = draw_shaded_by;
}

#[inline(always)]
fn draw_shaded_by<S: Lanes8>(s: S, of: Drawn<'_>, kind: Kind, place: Place, target: &mut Target<'_>) -> DrawStats {
    // As in `draw_triangles`.
    if !HAS_F64 {
        return DrawStats::default();
    }
    let mut shades = Shaded8::new(kind, of.triangles, of.picks, place.0);
    draw_triangles::<S, _, true, true>(s, of, place, target, &mut shades, &mut { SpanList::NONE })
}

/// Draws triangles, with `DEPTHS` where they are nearer than the target's cells; with `LISTED` the list has depths.
#[inline(always)]
pub(super) fn draw_triangles<S: Lanes8, P: Shades8, const DEPTHS: bool, const LISTED: bool>(
    s: S,
    of: Drawn<'_>,
    (layout, clip): Place,
    target: &mut Target<'_>,
    shades: &mut P,
    list: &mut SpanList,
) -> DrawStats {
    // Unreachable without f64; this keeps soft-float routines out of a microcontroller's program.
    if !HAS_F64 {
        return DrawStats::default();
    }
    let of_pixels = (target.pixels.len(), layout.pitch);
    // Depths without cells are not used.
    let has_cells = target.cells.is_some();
    list.begin(of_pixels, target.cells.as_ref().map_or(of_pixels, |cells| (cells.len(), layout.width)));
    let mut setup = TriangleSetup8::NONE;
    let mut corners = Corners8::NONE;
    let (triangles, picks) = (of.triangles, of.picks);
    let count = picks.picks.len();
    corners.gather::<DEPTHS>(triangles, &picks);
    for (number, eight) in picks.picks.chunks(LANES).enumerate() {
        if shades.is_full() {
            shades.draw::<S, LISTED>(s, list, target);
        }
        shades.begin(number * LANES);
        let basis = setup.set_up::<S, DEPTHS>(s, &corners, layout);
        shades.set_up(s, &basis, &corners, &setup);
        // Gather the next eight before this eight's rows enter the list: vector loads stall when their elements have
        // just been stored one by one. (3 to 6 % of the time of triangles of 0.6 pixels.)
        corners.gather::<DEPTHS>(triangles, &picks.range(count.min((number + 1) * LANES), count));
        setup.rows[eight.len().min(LANES)..].fill(0);
        if !list.has_room(LANES * LANES) {
            shades.draw::<S, LISTED>(s, list, target);
        }
        let are_small = Pick::are_small(eight);
        if are_small {
            let most = setup.rows.iter().fold(0, |most, &rows| if rows > most { rows } else { most });
            if most <= rows::MAX_SHORT_ROWS {
                rows::list_short::<S, P, LISTED>(s, &setup, shades, most, list);
                continue;
            }
        }
        for (i, &pick) in eight.iter().enumerate() {
            let (pick, rows) = (Pick(pick), setup.rows[i % LANES]);
            if pick.class() == SizeClass::Small {
                for first in (0..rows).step_by(LANES) {
                    if !list.has_room(LANES) {
                        shades.draw::<S, LISTED>(s, list, target);
                    }
                    rows::list_eight_rows::<S, P, LISTED>(s, &setup, shades, (i, first), list);
                }
                continue;
            }
            // A triangle without area has no rows, and no plane.
            if rows <= 0 {
                continue;
            }
            if DEPTHS {
                setup.put_depth_plane(i, &of.depth_plane(pick));
            }
            shades.set_up_large(i, &setup);
            let clip = (pick.class() == SizeClass::CrossesClip).then_some(clip);
            let pieces = of.pieces(pick);
            // Otherwise a row is one piece, however long.
            let longest = if pieces > 1 { RESEED } else { MAX_WIDTH / 256 };
            let (mut first, mut end) = (0, rows);
            if let Some(clip) = clip {
                // All inside a frame, at most 4,096.
                let row = setup.row[i % LANES];
                (first, end) = ((clip.y0 as i32 - row).max(0), end.min(clip.y1 as i32 - row));
            }
            #[cfg(simd_x86_64)]
            if !DEPTHS
                && P::IS_LINEAR
                && pick.class() == SizeClass::Large
                && let Some(avx512) = target.kernel.avx512()
            {
                shades.draw::<S, LISTED>(s, list, target);
                list.count_drawn(crate::span::fill_large(
                    avx512,
                    target.pixels,
                    &setup.large_triangle(i, layout, of.in_pieces),
                ));
                continue;
            }
            while first < end {
                if !list.has_room(LANES * pieces) {
                    shades.draw::<S, LISTED>(s, list, target);
                }
                let (part, cut) = ((i, first), (pieces, longest));
                rows::list_pieces::<S, P, LISTED>(s, &setup, shades, part, cut, (clip, layout.width), list);
                first += LANES as i32;
            }
        }
    }
    shades.draw::<S, LISTED>(s, list, target);
    let (spans, covered, nearer) = list.counts();
    let (pixels, tested) = if DEPTHS && has_cells { (nearer, covered) } else { (covered, 0) };
    DrawStats { spans, covered, pixels, tested, ..DrawStats::default() }
}
