//! Triangles that were picked become spans, eight at a time.
//!
//! Half of the triangles of a fine model cover no pixel centre, and most of the others a few. So a triangle's own
//! work has to be small: no sorting by branches, no division for itself, no loop for a row of one pixel. It is culled once,
//! set up once, and becomes spans once:
//!
//! | stage | lanes | what |
//! |---|---|---|
//! | `cull` | triangles | which have a pixel centre in their box, and if that is tiny in themselves; their size class |
//! | `setup` | triangles | edges, shade plane and depth plane |
//! | `rows` | triangles, or rows of one | ends and first shades of rows, into a list of spans |
//! | `span::list`, or `shaded` | pixels | the bytes |
//!
//! Each stage is one function over `simd::Lanes8`, compiled for each level of the processor; only the last
//! one, the span kernel, is a level's own.
//!
//! A triangle larger than 2¹⁸ pixels is drawn by [`Raster::triangle`] when its turn comes. The bytes are those of a call of
//! it for each triangle in turn.

use super::columns::{Picks, Triangles};
use super::depth::{Cell, DepthBuffer};
use super::draw_stats::DrawStats;
use super::frame::Rect;
use super::interpolation::Interpolation;
use super::pick::{LANES, MAX_WIDTH, Pick, SizeClass};
use super::reference::depth::DepthPlane;
use super::reference::shade::RESEED;
use super::rows::{self, Linear, Shades8};
use super::setup::{Corners8, FrameLayout, TriangleSetup8};
use super::shaded::{Kind, Shaded8};
use super::triangle::Raster;
use crate::fixed::HAS_F64;
use crate::lanes::three;
use crate::simd::{BASELINE, Lanes8, compiled_for_each_level};
use crate::span::Kernel;
use crate::span::list::SpanList;

/// Triangles, and whether their rows are cut into pieces of 64 pixels, with which linear shades start anew.
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
    /// Draws triangles that were picked inside the clip rectangle, one after the other: the bytes, depths and counts are
    /// those of [`triangle`](Self::triangle) called for each.
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
        // Cells of 16 bits are for small machines: other shadings are drawn one by one there.
        let has_cells = self.depth.as_mut().is_none_or(|depth| D::as_u32(depth.values_mut()).is_some());
        let kind = Kind::of(interpolation).filter(|_| has_cells && picks.flat.is_empty());
        let in_pieces = match interpolation {
            Interpolation::GouraudReseeded if HAS_F64 && fits => picks.flat.is_empty(),
            Interpolation::Gouraud | Interpolation::Flat(_) if HAS_F64 && fits => false,
            _ if HAS_F64 && fits && kind.is_some() => true,
            _ => {
                for k in 0..picks.picks.len() {
                    drawn += self.triangle(&triangles.vertices(&picks, k), interpolation);
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
                drawn += self.triangle(&triangles.vertices(&picks, first), interpolation);
                first += 1;
                continue;
            }
            let (pixels, _) = self.frame.pixels_mut();
            // In a build that leaves it out (`plan::Effect::is_left_out`) there is none.
            let depth = self.depth.as_mut().filter(|_| !cfg!(mode13h_leave_out = "hidden-surfaces"));
            let target = (layout, self.clip, self.kernel);
            let of = Drawn { triangles, picks: picks.range(first, first + together), in_pieces };
            drawn += match depth.map(DepthBuffer::values_mut) {
                cells if kind.is_some() => match kind {
                    Some(kind) => {
                        draw_shaded(level, of, kind, target, pixels, cells.and_then(D::as_u32).unwrap_or_default())
                    }
                    None => DrawStats::default(),
                },
                None => draw_all(level, of, target, pixels),
                Some(cells) => draw_where_nearer(of, target, pixels, cells),
            };
            first += together;
        }
        drawn
    }
}

impl<D: Cell> Raster<'_, D> {
    /// Returns whether lists hold the places of spans: offsets of pixels are kept in 32 bits, and a depth buffer has to hold the
    /// frame's rows and no others.
    pub(super) fn fits_lists(&mut self) -> bool {
        let (_, pitch) = self.frame.pixels_mut();
        let (width, rows) = (self.frame.width(), self.frame.rows());
        pitch <= 1 << 16 && self.depth.as_ref().is_none_or(|depth| depth.holds(width, &rows))
    }
}

/// Where and with what triangles are drawn: the pixels' layout, the clip rectangle, and the kernel.
pub(super) type Target = (FrameLayout, Rect, Kernel);

// Without type parameters, so that they are compiled in this crate, and not in each that draws.
compiled_for_each_level! {
    /// Draws triangles, none of which is unbatched.
    fn draw_all[][](of: Drawn<'_>, target: Target, pixels: &mut [u8]) -> DrawStats = draw_all_by;
}

#[inline(always)]
fn draw_all_by<S: Lanes8>(s: S, of: Drawn<'_>, target: Target, pixels: &mut [u8]) -> DrawStats {
    let list = &mut { SpanList::NONE };
    draw_triangles::<S, u32, Linear, false, false>(s, of, target, (pixels, &mut []), &mut Linear, list)
}

/// Likewise, where they are nearer than cells.
fn draw_where_nearer<D: Cell>(of: Drawn<'_>, target: Target, pixels: &mut [u8], cells: &mut [D]) -> DrawStats {
    if let Some(cells) = D::as_u32(cells) {
        return draw_nearer(target.2.simd_level(), of, target, pixels, cells);
    }
    match D::as_u16(cells) {
        Some(cells) => draw_nearer_in_16_bits(of, target, pixels, cells),
        None => DrawStats::default(),
    }
}

compiled_for_each_level! {
    fn draw_nearer[][](of: Drawn<'_>, target: Target, pixels: &mut [u8], cells: &mut [u32]) -> DrawStats
        = draw_nearer_by;
}

#[inline(always)]
fn draw_nearer_by<S: Lanes8>(s: S, of: Drawn<'_>, target: Target, pixels: &mut [u8], cells: &mut [u32]) -> DrawStats {
    let list = &mut { SpanList::NONE };
    draw_triangles::<S, u32, Linear, true, true>(s, of, target, (pixels, cells), &mut Linear, list)
}

/// Cells of 16 bits are for small machines: by what every processor of the target has.
#[inline(never)]
fn draw_nearer_in_16_bits(of: Drawn<'_>, target: Target, pixels: &mut [u8], cells: &mut [u16]) -> DrawStats {
    let list = &mut { SpanList::NONE };
    draw_triangles::<_, u16, Linear, true, true>(BASELINE, of, target, (pixels, cells), &mut Linear, list)
}

compiled_for_each_level! {
    /// Draws triangles by another shading than a linear one in 8.8, where there are cells those that are nearer.
    #[inline(never)]
    fn draw_shaded[][](of: Drawn<'_>, kind: Kind, target: Target, pixels: &mut [u8], cells: &mut [u32]) -> DrawStats
        = draw_shaded_by;
}

#[inline(always)]
fn draw_shaded_by<S: Lanes8>(
    s: S,
    of: Drawn<'_>,
    kind: Kind,
    target: Target,
    pixels: &mut [u8],
    cells: &mut [u32],
) -> DrawStats {
    // A chip's program must not hold what follows.
    if !HAS_F64 {
        return DrawStats::default();
    }
    let has_cells = !cells.is_empty();
    let mut shades = Shaded8::new(kind, of.triangles, of.picks, target.0);
    let list = &mut { SpanList::NONE };
    let drawn = draw_triangles::<S, u32, _, true, true>(s, of, target, (pixels, cells), &mut shades, list);
    if has_cells { drawn } else { DrawStats { pixels: drawn.covered, tested: 0, ..drawn } }
}

/// Draws triangles, with `DEPTHS` where they are nearer than cells; the list has depths if they are `LISTED`.
#[inline(always)]
pub(super) fn draw_triangles<S: Lanes8, D: Cell, P: Shades8, const DEPTHS: bool, const LISTED: bool>(
    s: S,
    of: Drawn<'_>,
    (layout, clip, kernel): Target,
    (pixels, cells): (&mut [u8], &mut [D]),
    shades: &mut P,
    list: &mut SpanList,
) -> DrawStats {
    // Nobody comes here then, and a chip's program must not hold what follows.
    if !HAS_F64 {
        return DrawStats::default();
    }
    // Depths without cells are not looked at.
    let of_cells = if cells.is_empty() { (pixels.len(), layout.pitch) } else { (cells.len(), layout.width) };
    list.begin((pixels.len(), layout.pitch), of_cells);
    let mut setup = TriangleSetup8::NONE;
    let mut corners = Corners8::NONE;
    let (triangles, picks) = (of.triangles, of.picks);
    let count = picks.picks.len();
    corners.gather::<DEPTHS>(triangles, &picks);
    for (number, eight) in picks.picks.chunks(LANES).enumerate() {
        if shades.is_full() {
            shades.draw::<S, D, LISTED>(s, list, kernel, pixels, cells);
        }
        shades.begin(number * LANES);
        let basis = setup.set_up::<S, DEPTHS>(s, &corners, layout);
        shades.set_up(s, &basis, &corners, &setup);
        // The next before this one's rows enter the list: vectors that are read just after their numbers were stored
        // one by one wait for these. (3 to 6 % of the time of triangles of 0.6 pixels.)
        corners.gather::<DEPTHS>(triangles, &picks.range(count.min((number + 1) * LANES), count));
        setup.rows[eight.len().min(LANES)..].fill(0);
        if !list.has_room(LANES * LANES) {
            shades.draw::<S, D, LISTED>(s, list, kernel, pixels, cells);
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
                        shades.draw::<S, D, LISTED>(s, list, kernel, pixels, cells);
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
                && let Some(avx512) = kernel.avx512()
            {
                shades.draw::<S, D, LISTED>(s, list, kernel, pixels, cells);
                list.count_drawn(crate::span::fill_large(
                    avx512,
                    pixels,
                    &setup.large_triangle(i, layout, of.in_pieces),
                ));
                continue;
            }
            while first < end {
                if !list.has_room(LANES * pieces) {
                    shades.draw::<S, D, LISTED>(s, list, kernel, pixels, cells);
                }
                let (part, cut) = ((i, first), (pieces, longest));
                rows::list_pieces::<S, P, LISTED>(s, &setup, shades, part, cut, (clip, layout.width), list);
                first += LANES as i32;
            }
        }
    }
    shades.draw::<S, D, LISTED>(s, list, kernel, pixels, cells);
    let (spans, covered, nearer) = list.counts();
    let (pixels, tested) = if DEPTHS { (nearer, covered) } else { (covered, 0) };
    DrawStats { spans, covered, pixels, tested, ..DrawStats::default() }
}
