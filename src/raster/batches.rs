//! Turns picked triangles into spans, eight at a time.
//!
//! Half of the triangles of a detailed model cover no pixel centre, and most of the others only a few. So the work per
//! triangle has to be small: no sorting by branches, no division for each triangle, no loop for a row of one pixel. A
//! triangle is culled once, set up once, and becomes spans once:
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
//! A triangle larger than 2¹⁸ pixels is drawn by [`Raster::triangle`] when its turn comes. The bytes are the same as if
//! it drew each triangle in turn.

use super::columns::{PickedTriangles, Triangles};
use super::depth::{Cell, DepthBuffer};
use super::draw_stats::DrawStats;
use super::fill_rule::first_centre;
use super::frame::Rect;
use super::interpolation::Interpolation;
use super::pick::{MAX_PIECES, MAX_WIDTH, Pick, SizeClass};
use super::reference::cover::SortedTriangle;
use super::reference::depth::DepthPlane;
use super::reference::shade::{RESEED, ShadePlane};
use super::row_shader::starts;
use super::rows::{self, Linear, Shades8};
use super::setup::{Corners8, FrameLayout, TriangleSetup8};
use super::shaded::{Kind, Shaded8, ShadedData};
use super::triangle::Raster;
use super::vertex::Vertex;
use crate::fixed::{HAS_F64, I24F8};
use crate::lanes::{LANES, three};
use crate::simd::{Lanes8, Level, compiled_for_each_level};
use crate::span::list::SpanList;
use crate::span::target::Target;

/// Memory for the spans of picked triangles, reused because clearing it takes 6 % of the time of a small object.
#[derive(Debug)]
pub(crate) struct SpanScratch(SpanList);

impl Default for SpanScratch {
    fn default() -> Self {
        Self(SpanList::NONE)
    }
}

impl<D: Cell> Raster<'_, D> {
    /// Draws triangles that were picked inside the clip rectangle, in order: bytes, depths and counts are as if
    /// [`triangle`](Self::triangle) had drawn each. Shadings other than linear ones in 8.8 use the memory given, or
    /// clear their own.
    pub(crate) fn picks(
        &mut self,
        all: PickedTriangles<'_>,
        interpolation: Interpolation,
        SpanScratch(list): &mut SpanScratch,
        mut shaded: Option<&mut ShadedData>,
    ) -> DrawStats {
        let mut drawn = DrawStats::default();
        let (layout, fits) = (self.layout(), self.fits_lists());
        let picks = all.picks;
        let are_flat = !picks.flat.is_empty();
        let kind = Kind::of(interpolation).filter(|_| !are_flat);
        let in_pieces = match interpolation {
            Interpolation::Gouraud88Reseeded if HAS_F64 && fits => !are_flat,
            Interpolation::Gouraud88 | Interpolation::Flat(_) if HAS_F64 && fits => false,
            _ if HAS_F64 && fits && kind.is_some() => true,
            _ => {
                for k in 0..picks.picks.len() {
                    drawn += self.triangle_by_rows(&all.vertices(k), interpolation);
                }
                return drawn;
            }
        };
        let level = self.kernel.simd_level();
        let (mut first, count) = (0, picks.picks.len());
        while first < count {
            let together = Pick::count_batched(&picks.picks[first..]);
            if together == 0 {
                let vertices = all.vertices(first);
                drawn += match kind {
                    Some(_) => self.triangle_by_rows(&vertices, interpolation),
                    None => self.list_rows(&vertices, in_pieces, layout, list),
                };
                first += 1;
                continue;
            }
            let area = (layout, self.clip);
            let target = &mut self.target();
            let of = all.range(first, first + together);
            drawn += match kind {
                Some(kind) => match &mut shaded {
                    Some(data) => draw_shaded(level, of, (kind, data), area, target, list),
                    None => draw_shaded(level, of, (kind, &mut ShadedData::default()), area, target, list),
                },
                None => draw_linear(level, (of, in_pieces), area, target, list),
            };
            first += together;
        }
        drawn
    }

    /// Draws a triangle with linear shades that is too large for set-up in f64: walks down its edges, and lists its
    /// rows.
    #[inline(never)]
    fn list_rows(
        &mut self,
        vertices: &[Vertex; 3],
        in_pieces: bool,
        layout: FrameLayout,
        list: &mut SpanList,
    ) -> DrawStats {
        let (width, clip) = (self.frame.width(), self.clip);
        let triangle = SortedTriangle::new(vertices);
        if triangle.extent(clip).is_none() {
            return DrawStats::default();
        }
        let shade = ShadePlane::of_values(&triangle, triangle.shades());
        let target = &mut self.target();
        let plane = target.cells.is_some().then(|| DepthPlane::new(&triangle).raised_by(layout.depth_base));
        list.begin(target, [layout.pitch, layout.width]);
        triangle.rows(width, clip, |row| {
            // A row of the frame.
            let down = (row.y as u32 - layout.first_row) as usize;
            starts(&row, &shade, in_pieces, |columns, start| {
                if !list.has_room(1) {
                    list.draw(target);
                }
                let at = [layout.pitch, layout.width].map(|row| down * row as usize + columns.start);
                let fill = u32::from(start) | u32::from(shade.step()) << 16;
                let z = plane.map_or([0; 2], |plane| [plane.fixed_at(columns.start as i32, row.y), plane.step()]);
                list.push(at, columns.len(), fill, z.map(|z| z << 8));
            });
        });
        list.draw(target);
        DrawStats::of_spans(list.counts(), plane.is_some())
    }

    /// The layout of the frame's pixels.
    pub(super) fn layout(&mut self) -> FrameLayout {
        let (_, pitch) = self.frame.pixels_mut();
        let (width, first_row) = (self.frame.width(), self.frame.rows().start);
        let depth_base = self.depth.as_ref().map_or(0, |depth| depth.base);
        FrameLayout { first_row, pitch: pitch as u32, width, depth_base }
    }

    /// The pixels, the cells of the depth buffer, and the kernel that draws.
    pub(super) fn target(&mut self) -> Target<'_> {
        // A build that leaves out hidden surfaces (`plan::Effect::is_left_out`) has no depth.
        let depth = self.depth.as_mut().filter(|_| !cfg!(mode13h_leave_out = "hidden-surfaces"));
        let (pixels, _) = self.frame.pixels_mut();
        Target { pixels, cells: depth.map(DepthBuffer::cells), kernel: self.kernel }
    }

    /// Returns whether lists can hold the positions of spans: offsets of pixels have 32 bits, and a depth buffer must
    /// hold exactly the frame's rows.
    pub(super) fn fits_lists(&mut self) -> bool {
        let (_, pitch) = self.frame.pixels_mut();
        let (width, rows) = (self.frame.width(), self.frame.rows());
        pitch <= 1 << 16 && self.depth.as_ref().is_none_or(|depth| depth.holds(width, &rows))
    }
}

/// The drawing area of triangles: the pixels' layout, and the clip rectangle.
pub(super) type DrawArea = (FrameLayout, Rect);

/// Draws triangles with linear shades, none of which is unbatched; if there are cells, only where they are nearer.
///
/// Like `draw_shaded`, it has no type parameters, so that it is compiled in this crate rather than
/// in every crate that draws.
#[inline(never)]
fn draw_linear(
    level: Level,
    of: (PickedTriangles<'_>, bool),
    area: DrawArea,
    target: &mut Target<'_>,
    list: &mut SpanList,
) -> DrawStats {
    match target.cells.is_some() {
        false => draw_at_level::<false>(level, of, area, target, list),
        true => draw_at_level::<true>(level, of, area, target, list),
    }
}

compiled_for_each_level! {
    /// Draws triangles; with `DEPTHS`, only where they are nearer than the cells.
    #[inline(never)]
    fn draw_at_level[const DEPTHS: bool][DEPTHS](
        of: (PickedTriangles<'_>, bool),
        area: DrawArea,
        target: &mut Target<'_>,
        list: &mut SpanList,
    ) -> DrawStats = draw_by;
}

#[inline(always)]
fn draw_by<S: Lanes8, const DEPTHS: bool>(
    s: S,
    (of, in_pieces): (PickedTriangles<'_>, bool),
    area: DrawArea,
    target: &mut Target<'_>,
    list: &mut SpanList,
) -> DrawStats {
    draw_triangles::<S, _, DEPTHS>(s, of, area, target, &mut Linear::new(!of.picks.flat.is_empty(), in_pieces), list)
}

compiled_for_each_level! {
    /// Draws triangles with a shading other than a linear one in 8.8; if there are cells, only where they are nearer.
    #[inline(never)]
    fn draw_shaded[][](
        of: PickedTriangles<'_>,
        kind: (Kind, &mut ShadedData),
        area: DrawArea,
        target: &mut Target<'_>,
        list: &mut SpanList,
    ) -> DrawStats = draw_shaded_by;
}

#[inline(always)]
fn draw_shaded_by<S: Lanes8>(
    s: S,
    of: PickedTriangles<'_>,
    (kind, data): (Kind, &mut ShadedData),
    area: DrawArea,
    target: &mut Target<'_>,
    list: &mut SpanList,
) -> DrawStats {
    let mut shades = Shaded8::new(kind, of, area.0, data);
    draw_triangles::<S, _, true>(s, of, area, target, &mut shades, list)
}

/// [`Corners8::gather`], not compiled for each level: it is called once for many triangles.
#[inline(never)]
fn gather_first<const DEPTHS: bool>(corners: &mut Corners8, of: &PickedTriangles<'_>) {
    corners.gather::<DEPTHS>(of);
}

/// Draws triangles; if there are cells, only where they are nearer. `DEPTHS` may be false if there are none.
#[inline(always)]
pub(super) fn draw_triangles<S: Lanes8, P: Shades8, const DEPTHS: bool>(
    s: S,
    of: PickedTriangles<'_>,
    (layout, clip): DrawArea,
    target: &mut Target<'_>,
    shades: &mut P,
    list: &mut SpanList,
) -> DrawStats {
    // Unreachable without f64; this keeps soft-float routines out of a microcontroller's program.
    if !HAS_F64 {
        return DrawStats::default();
    }
    list.begin(target, [layout.pitch, layout.width]);
    let has_depths = rows::has_depths::<P, DEPTHS>(list);
    let mut setup = TriangleSetup8::NONE;
    let mut corners = Corners8::NONE;
    let count = of.picks.picks.len();
    gather_first::<DEPTHS>(&mut corners, &of);
    for (number, eight) in of.picks.picks.chunks(LANES).enumerate() {
        if shades.is_full() {
            shades.draw::<DEPTHS>(list, target);
        }
        shades.begin(number * LANES);
        shades.set_up(s, &corners, &mut setup, (layout, has_depths));
        // Gather the next eight before this eight's rows enter the list: vector loads stall when their elements have
        // just been stored one by one. (3 to 6 % of the time of triangles of 0.6 pixels.)
        corners.gather::<DEPTHS>(&of.range(count.min((number + 1) * LANES), count));
        // Only for the last triangles: filling calls the C library.
        if eight.len() < LANES {
            setup.rows[eight.len()..].fill(0);
        }
        if !list.has_room(LANES * LANES) || !shades.has_room(rows::MAX_SHORT_ROWS as usize) {
            shades.draw::<DEPTHS>(list, target);
        }
        let are_small = Pick::are_small(eight);
        if are_small {
            let most = setup.rows.iter().fold(0, |most, &rows| if rows > most { rows } else { most });
            if most <= rows::MAX_SHORT_ROWS {
                rows::list_short::<S, P, DEPTHS>(s, &setup, shades, most, list);
                continue;
            }
        }
        for (i, &pick) in eight.iter().enumerate() {
            let (pick, rows) = (Pick(pick), setup.rows[i % LANES]);
            if pick.class() == SizeClass::Small {
                for first in (0..rows).step_by(LANES) {
                    if !list.has_room(LANES) || !shades.has_room(1) {
                        shades.draw::<DEPTHS>(list, target);
                    }
                    rows::list_eight_rows::<S, P, DEPTHS>(s, &setup, shades, (i, first), list);
                }
                continue;
            }
            // A triangle without area has no rows, and no plane.
            if rows > 0 {
                let (setup, area) = (&mut setup, (layout, clip));
                let (target, spans) = (&mut *target, (&mut *shades, &mut *list));
                // Out of line, which leaves the registers to small triangles.
                s.apart(
                    #[inline(always)]
                    move || list_large::<S, P, DEPTHS>(s, of, (number, i), setup, area, target, spans),
                );
            }
        }
    }
    shades.draw::<DEPTHS>(list, target);
    DrawStats::of_spans(list.counts(), has_depths)
}

/// The maximum number of pieces of a row of a large triangle.
#[inline(always)]
fn most_pieces(triangles: &Triangles<'_>, pick: Pick) -> usize {
    let [a, b, c] = three(triangles.corners(pick), |i| triangles.columns.at[i].x());
    let [left, right] = [a.min(b).min(c), a.max(b).max(c)].map(|x| first_centre(I24F8::from_bits(x)));
    ((right - left - 1) as usize / RESEED as usize + 1).clamp(1, MAX_PIECES)
}

/// Lists the rows of triangle `i` of batch `number`, which is not a small one.
#[inline(always)]
fn list_large<S: Lanes8, P: Shades8, const DEPTHS: bool>(
    s: S,
    of: PickedTriangles<'_>,
    (number, i): (usize, usize),
    setup: &mut TriangleSetup8,
    (layout, clip): DrawArea,
    target: &mut Target<'_>,
    (shades, list): (&mut P, &mut SpanList),
) {
    let k = number * LANES + i;
    let pick = Pick(of.picks.picks[k]);
    if rows::has_depths::<P, DEPTHS>(list) {
        let plane = DepthPlane::new(&SortedTriangle::new(&of.vertices(k)));
        setup.put_depth_plane(i, &plane.raised_by(layout.depth_base));
    }
    shades.set_up_large(i);
    let clip = (pick.class() == SizeClass::CrossesClip).then_some(clip);
    let pieces = if shades.is_in_pieces() { most_pieces(of.triangles, pick) } else { 1 };
    // Otherwise a row is one piece, however long.
    let longest = if pieces > 1 { RESEED } else { MAX_WIDTH / 256 };
    let (mut first, mut end) = (0, setup.rows[i % LANES]);
    if let Some(clip) = clip {
        // All inside a frame, at most 4,096.
        let row = setup.row[i % LANES];
        (first, end) = ((clip.y0 as i32 - row).max(0), end.min(clip.y1 as i32 - row));
    }
    while first < end {
        if !list.has_room(LANES * pieces) || !shades.has_room(pieces) {
            shades.draw::<DEPTHS>(list, target);
        }
        let (part, cut) = ((i, first), (pieces, longest));
        rows::list_pieces::<S, P, DEPTHS>(s, setup, shades, part, cut, (clip, layout.width), list);
        first += LANES as i32;
    }
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use alloc::vec;
    use alloc::vec::Vec;

    use proptest::prelude::*;

    use super::super::columns::{Columns, Picks, ScreenPos};
    use super::super::cull::{PickList, cull, pick};
    use super::*;
    use crate::fixed::U8F8;
    use crate::raster::frame::Frame;
    use crate::raster::pick::CHUNK;
    use crate::span::Kernel;

    const SIDE: u32 = 150;

    /// A corner in 1/256 pixel, usually close to the others, and its depth.
    fn corner() -> impl Strategy<Value = (i32, i32, u32)> {
        let at = || prop_oneof![6 => 2_000..6_000, 2 => -3_000..42_000, 1 => (0..150).prop_map(|i| i * 256 + 128)];
        (at(), at(), prop_oneof![0..=1_u32 << 30, any::<u32>()])
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1_000))]
        /// Triangles with a single shade each give the bytes, depths and counts of drawing them one
        /// after another, at every level.
        #[test]
        fn flat_triangles_are_each_its_own(
            corners in prop::collection::vec(corner(), 3..30),
            triangles in prop::collection::vec((any::<[u32; 3]>(), 0..=0xFF00_u16), 0..=CHUNK),
            has_depth: bool,
        ) {
            let at: Vec<ScreenPos> = corners.iter().map(|&(x, y, _)| ScreenPos::new(x, y)).collect();
            let depth: Vec<u32> = corners.iter().map(|&(_, _, depth)| depth).collect();
            let shade = vec![[U8F8::from(3); 2]; corners.len()];
            let indices: Vec<[u32; 3]> =
                triangles.iter().map(|(indices, _)| indices.map(|i| i % corners.len() as u32)).collect();
            let columns = Columns::plain(&at, &depth, &shade);
            let all = Triangles { columns, indices: &indices, by_corner: None };
            for kernel in Kernel::available() {
                let draw = |are_together: bool| {
                    let (mut bytes, mut cells) = (vec![9; (SIDE * SIDE) as usize], vec![0_u32; (SIDE * SIDE) as usize]);
                    let frame = Frame::new(&mut bytes, SIDE, SIDE, SIDE as usize).expect("a legal frame");
                    let buffer = DepthBuffer::new(&mut cells, &frame).expect("as long as the frame");
                    let mut raster =
                        Raster { clip: frame.bounds(), frame, depth: has_depth.then_some(buffer), kernel };
                    let masks = cull(kernel.simd_level(), &at, &indices, raster.clip, false);
                    let mut list = PickList::<{ CHUNK + LANES }>::new();
                    pick(kernel.simd_level(), &mut list, 0, &masks, masks.covers);
                    let of_pick = |&pick: &u32| [U8F8::from_bits(triangles[Pick(pick).index()].1); 3];
                    let flat: Vec<[U8F8; 3]> = list.as_slice().iter().map(of_pick).collect();
                    let picks = Picks { picks: list.as_slice(), flat: &flat };
                    let of = PickedTriangles { triangles: &all, picks };
                    let mut drawn = DrawStats::default();
                    if are_together {
                        drawn = raster.picks(of, Interpolation::Gouraud88, &mut SpanScratch::default(), None);
                    } else {
                        for k in 0..flat.len() {
                            drawn += raster.triangle_by_rows(&of.vertices(k), Interpolation::Gouraud88);
                        }
                    }
                    (drawn, bytes, cells)
                };
                prop_assert!(draw(true) == draw(false), "{}", kernel);
            }
        }
    }
}
