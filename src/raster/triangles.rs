//! Many triangles at once, given as vertices.

use super::batches::SpanScratch;
use super::columns::{Columns, PickedTriangles, Picks, ScreenPos, Triangles};
use super::cull::{CullMasks, PickList, cull, cull_eights, pick};
use super::depth::Cell;
use super::draw_stats::DrawStats;
use super::frame::Rect;
use super::interpolation::Interpolation;
use super::pick::{CHUNK, Pick};
use super::triangle::Raster;
use super::vertex::{Vertex, misses_centres};
use crate::fixed::{I24F8, IS_COMPACT, U8F8};
use crate::lanes::{LANES, three};
use crate::simd::Level;

/// The maximum number of triangles that are culled and drawn together.
const CAPACITY: usize = 2 * CHUNK;

/// The maximum length of a short list. Clearing memory for a long one takes as long as a dozen small triangles.
const SHORT: usize = 2 * LANES;

/// One value of the corners of `N` triangles: first corners, second corners, third corners. Eight triangles are loaded
/// from it without gathering.
pub(super) type Corners<T, const N: usize> = [[T; N]; 3];

/// The indices of the corners of triangles stored as [`Corners`].
#[expect(clippy::cast_possible_truncation, reason = "at most three times the triangles of a batch")]
pub(super) const fn corner_indices<const N: usize>() -> [[u32; 3]; N] {
    let mut indices = [[0; 3]; N];
    let mut i = 0;
    while i < N {
        indices[i] = [i as u32, (N + i) as u32, (2 * N + i) as u32];
        i += 1;
    }
    indices
}

/// Leaves out triangles that miss all pixel centres, one by one, as long as most of a list's triangles do. That costs
/// less than storing and culling them: 5 ns instead of 9 for triangles of 0.04 pixels.
#[derive(Clone, Debug, Default)]
pub(super) struct Sieve {
    is_on: bool,
    left_out: usize,
}

impl Sieve {
    #[inline(always)]
    pub(super) fn leaves_out(&mut self, vertices: &[Vertex; 3]) -> bool {
        let is_left_out = self.is_on && misses_centres(vertices);
        self.left_out += usize::from(is_left_out);
        is_left_out
    }

    /// Adapts to what was drawn of `count` triangles that were not left out.
    pub(super) fn adapt(&mut self, drawn: usize, count: usize) {
        self.is_on = 8 * drawn < count + self.left_out;
        self.left_out = 0;
    }
}

/// Pending triangles, given as vertices, all drawn by one method.
struct Pending<'t, const N: usize> {
    drawn_by: Interpolation,
    triangles: [(&'t [Vertex; 3], Interpolation); N],
    /// The positions of all triangles, for culling.
    all: Corners<ScreenPos, N>,
    /// The corners of the triangles that are drawn.
    at: Corners<ScreenPos, N>,
    depth: Corners<u32, N>,
    shade: Corners<[U8F8; 2], N>,
    sieve: Sieve,
    spans: SpanScratch,
}

impl<'t, const N: usize> Pending<'t, N> {
    fn new() -> Self {
        const NOWHERE: [Vertex; 3] = [Vertex::ORIGIN; 3];
        Self {
            drawn_by: Interpolation::Gouraud88,
            triangles: [(&NOWHERE, Interpolation::Gouraud88); N],
            all: [[ScreenPos::new(0, 0); N]; 3],
            at: [[ScreenPos::new(0, 0); N]; 3],
            depth: [[0; N]; 3],
            shade: [[[U8F8::from_bits(0); 2]; N]; 3],
            sieve: Sieve::default(),
            spans: SpanScratch::default(),
        }
    }

    /// Appends a triangle to `count` others. There must be room.
    #[inline(always)]
    fn push(&mut self, count: usize, vertices: &'t [Vertex; 3], interpolation: Interpolation) {
        self.triangles[count % N] = (vertices, interpolation);
        put_positions(&mut self.all, count, vertices);
    }

    /// Copies the corners of the triangle of a pick, which becomes number `to` of those that are drawn.
    #[inline(always)]
    fn copy(&mut self, pick: Pick, to: usize, with_depth: bool) {
        let (vertices, interpolation) = self.triangles[pick.index() % N];
        put_positions(&mut self.at, to, vertices);
        for (corner, vertex) in vertices.iter().enumerate() {
            // All are seen from the front.
            self.shade[corner][to % N][0] = corner_shade(vertex, interpolation);
        }
        if with_depth {
            for (corner, vertex) in vertices.iter().enumerate() {
                self.depth[corner][to % N] = vertex.depth();
            }
        }
    }
}

/// Stores the positions of triangle `at` in the list of all.
#[inline(always)]
pub(super) fn put_positions<const N: usize>(to: &mut Corners<ScreenPos, N>, at: usize, vertices: &[Vertex; 3]) {
    for (corner, vertex) in vertices.iter().enumerate() {
        to[corner][at % N] = ScreenPos::of(vertex);
    }
}

/// Culls the first `count` triangles, and picks those that cover something.
pub(super) fn cull_corners<const N: usize, const PICKS: usize>(
    level: Level,
    at: &Corners<ScreenPos, N>,
    count: usize,
    clip: Rect,
) -> PickList<PICKS> {
    let mut list = PickList::new();
    for first in (0..count.min(N)).step_by(CHUNK) {
        let in_chunk = (count - first).min(CHUNK);
        let eights = first / LANES..(first + in_chunk).div_ceil(LANES);
        let masks = cull_eights(level, at.each_ref().map(|corner| &corner.as_chunks().0[eights.clone()]), clip);
        // From 1 to 64.
        let are_triangles = u64::MAX >> (CHUNK - in_chunk);
        // Below the capacity. All are seen from the front.
        pick(level, &mut list, first as u32, &CullMasks { back: 0, ..masks }, masks.covers & are_triangles);
    }
    list
}

/// Vertices that triangles share and refer to by index, at most `N`, for [`Raster::indexed`].
#[derive(Clone, Debug)]
pub struct VertexTable<const N: usize> {
    at: [ScreenPos; N],
    depth: [u32; N],
    shade: [[U8F8; 2]; N],
}

impl<const N: usize> VertexTable<N> {
    /// Every vertex lies at (0, 0), with a shade and a depth of 0.
    #[must_use]
    pub const fn new() -> Self {
        Self { at: [ScreenPos::new(0, 0); N], depth: [0; N], shade: [[U8F8::from_bits(0); 2]; N] }
    }

    /// Puts a vertex at `index`. Returns `false`, and changes nothing, if that is `N` or more.
    #[inline]
    pub fn set(&mut self, index: usize, vertex: &Vertex) -> bool {
        if index >= N {
            return false;
        }
        self.at[index] = ScreenPos::of(vertex);
        self.depth[index] = vertex.depth();
        self.shade[index] = [vertex.shade(); 2];
        true
    }

    /// The vertex at `index`; `None` if that is `N` or more.
    #[must_use]
    #[inline]
    pub fn get(&self, index: usize) -> Option<Vertex> {
        let (at, depth, [shade, _]) = (self.at.get(index)?, self.depth.get(index)?, self.shade.get(index)?);
        Some(Vertex::of_projected(I24F8::from_bits(at.x()), I24F8::from_bits(at.y()), *shade, *depth))
    }
}

impl<const N: usize> Default for VertexTable<N> {
    fn default() -> Self {
        Self::new()
    }
}

/// A corner's shade. In a flat triangle all corners have its byte as their shade, which rounds to that byte.
#[inline]
fn corner_shade(vertex: &Vertex, interpolation: Interpolation) -> U8F8 {
    match interpolation {
        Interpolation::Flat(index) => U8F8::from(index),
        _ => vertex.shade(),
    }
}

/// The interpolation by which a triangle is drawn: a flat triangle is drawn like one whose rows are not reseeded.
fn drawn_by(interpolation: Interpolation) -> Interpolation {
    match interpolation {
        Interpolation::Flat(_) => Interpolation::Gouraud88,
        interpolation => interpolation,
    }
}

impl<D: Cell> Raster<'_, D> {
    /// Draws triangles in the order given: bytes, depths and counts are as if [`triangle`](Self::triangle) had drawn
    /// each. All but vintage ones are culled 128 at a time and set up eight at a time, which is several times as fast
    /// for small ones.
    ///
    /// ```
    /// use mode13h::fixed::{I24F8, U8F8};
    /// use mode13h::raster::{Frame, Interpolation, Raster, Vertex};
    ///
    /// let at = |x, y| Vertex::new(I24F8::from(x), I24F8::from(y), U8F8::from(9), 0);
    /// let [a, b, c, d] = [at(0, 0)?, at(8, 0)?, at(8, 4)?, at(0, 4)?];
    /// let mut bytes = [0_u8; 8 * 4];
    /// let drawn = Raster::new(Frame::new(&mut bytes, 8, 4, 8)?)
    ///     .triangles([[a, b, c], [a, c, d]].iter().map(|corners| (corners, Interpolation::default())));
    /// assert_eq!(drawn.pixels, 32);
    /// assert_eq!(bytes, [9; 32]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn triangles<'t>(
        &mut self,
        triangles: impl IntoIterator<Item = (&'t [Vertex; 3], Interpolation)>,
    ) -> DrawStats {
        let triangles = triangles.into_iter();
        match triangles.size_hint() {
            (_, Some(most)) if most <= SHORT && !IS_COMPACT => self.list::<SHORT>(triangles),
            _ => self.list::<CAPACITY>(triangles),
        }
    }

    /// Draws triangles, at most `N` at a time.
    #[inline]
    fn list<'t, const N: usize>(
        &mut self,
        triangles: impl Iterator<Item = (&'t [Vertex; 3], Interpolation)>,
    ) -> DrawStats {
        let (mut drawn, mut pending, mut count) = (DrawStats::default(), Pending::<N>::new(), 0);
        for (vertices, interpolation) in triangles {
            let drawn_by = drawn_by(interpolation);
            if count == N || drawn_by != pending.drawn_by {
                drawn += self.draw_pending(&mut pending, count);
                (pending.drawn_by, count) = (drawn_by, 0);
            }
            if !interpolation.has_exact_cover() {
                drawn += self.triangle(vertices, interpolation);
            } else if !pending.sieve.leaves_out(vertices) {
                pending.push(count, vertices, interpolation);
                count += 1;
            }
        }
        drawn += self.draw_pending(&mut pending, count);
        drawn
    }

    /// Draws the first `count` pending triangles.
    fn draw_pending<const N: usize>(&mut self, pending: &mut Pending<'_, N>, count: usize) -> DrawStats {
        if count == 0 {
            return DrawStats::default();
        }
        let mut list: PickList<{ CAPACITY + LANES }> =
            cull_corners(self.kernel.simd_level(), &pending.all, count, self.clip);
        pending.sieve.adapt(list.as_slice().len(), count);
        let with_depth = self.depth.is_some() || pending.drawn_by.is_linear_on_the_face();
        for (to, pick) in list.as_mut_slice().iter_mut().enumerate() {
            pending.copy(Pick(*pick), to, with_depth);
            *pick = Pick(*pick).with_index(to).0;
        }
        let Pending { at, depth, shade, spans, drawn_by, .. } = &mut *pending;
        let columns = Columns::plain(at.as_flattened(), depth.as_flattened(), shade.as_flattened());
        let picks = Picks { picks: list.as_slice(), flat: &[] };
        let triangles = Triangles { columns, indices: &const { corner_indices::<N>() }, by_corner: Some(N) };
        self.picks(PickedTriangles { triangles: &triangles, picks }, *drawn_by, spans, None)
    }

    /// Draws triangles whose corners are indices into `vertices`, in order: bytes, depths and counts are as if
    /// [`triangle`](Self::triangle) had drawn each. Shared vertices are not copied, so this is faster than
    /// [`triangles`](Self::triangles). A triangle with an index of `N` or more is left out.
    ///
    /// ```
    /// use mode13h::fixed::{I24F8, U8F8};
    /// use mode13h::raster::{Frame, Interpolation, Raster, Vertex, VertexTable};
    ///
    /// let mut table = VertexTable::<4>::new();
    /// for (i, (x, y)) in [(0, 0), (8, 0), (8, 4), (0, 4)].into_iter().enumerate() {
    ///     table.set(i, &Vertex::new(I24F8::from(x), I24F8::from(y), U8F8::from(9), 0)?);
    /// }
    /// let mut bytes = [0_u8; 8 * 4];
    /// let mut raster = Raster::new(Frame::new(&mut bytes, 8, 4, 8)?);
    /// let drawn = raster.indexed(&table, &[[0, 1, 2], [0, 2, 3]], Interpolation::default());
    /// assert_eq!(drawn.pixels, 32);
    /// assert_eq!(bytes, [9; 32]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn indexed<const N: usize>(
        &mut self,
        vertices: &VertexTable<N>,
        triangles: &[[u32; 3]],
        interpolation: Interpolation,
    ) -> DrawStats {
        let columns = Columns::plain(&vertices.at, &vertices.depth, &vertices.shade);
        self.of_columns(columns, triangles, interpolation)
    }

    /// Draws triangles from columns of equal length.
    fn of_columns(&mut self, columns: Columns<'_>, triangles: &[[u32; 3]], interpolation: Interpolation) -> DrawStats {
        let (mut drawn, count) = (DrawStats::default(), columns.at.len());
        let is_there = |corners: &[u32; 3]| corners.iter().all(|i| (*i as usize) < count);
        let most = triangles.as_flattened().iter().fold(0, |most, i| (*i).max(most));
        if !interpolation.has_exact_cover() || most as usize >= count {
            for corners in triangles.iter().filter(|corners| is_there(corners)) {
                let vertices = three(*corners, |i| columns.vertex(i as usize, 0, None));
                drawn += self.triangle(&vertices, interpolation);
            }
            return drawn;
        }
        let one_shade = match interpolation {
            Interpolation::Flat(shade) => Some([[U8F8::from(shade); 3]; CAPACITY]),
            _ => None,
        };
        let (level, mut spans) = (self.kernel.simd_level(), SpanScratch::default());
        for of_list in triangles.chunks(CAPACITY) {
            let mut list = PickList::<{ CAPACITY + LANES }>::new();
            for (number, chunk) in of_list.chunks(CHUNK).enumerate() {
                let masks = cull(level, columns.at, chunk, self.clip, false);
                // Below 128.
                pick(level, &mut list, (CHUNK * number) as u32, &masks, masks.covers);
            }
            let picks = list.as_slice();
            let flat = one_shade.as_ref().map_or(&[][..], |shades| &shades[..picks.len()]);
            let triangles = Triangles { columns, indices: of_list, by_corner: None };
            let all = PickedTriangles { triangles: &triangles, picks: Picks { picks, flat } };
            drawn += self.picks(all, drawn_by(interpolation), &mut spans, None);
        }
        drawn
    }

    /// Draws one triangle of many rows, eight rows at a time. As a list of one triangle, it would take 8 % longer,
    /// because the list's memory would have to be cleared.
    #[inline(never)]
    pub(super) fn tall_triangle(&mut self, vertices: &[Vertex; 3], interpolation: Interpolation) -> DrawStats {
        const INDICES: [[u32; 3]; 1] = [[0, 1, 2]];
        let at = vertices.each_ref().map(ScreenPos::of);
        let depth = vertices.each_ref().map(Vertex::depth);
        let shade = vertices.each_ref().map(|vertex| [corner_shade(vertex, interpolation); 2]);
        let columns = Columns::plain(&at, &depth, &shade);
        let masks = cull(self.kernel.simd_level(), &at, &INDICES, self.clip, false);
        if masks.covers & 1 == 0 {
            return DrawStats::default();
        }
        let mut list = PickList::<{ 1 + LANES }>::new();
        pick(self.kernel.simd_level(), &mut list, 0, &masks, 1);
        let picks = Picks { picks: list.as_slice(), flat: &[] };
        let triangles = Triangles { columns, indices: &INDICES, by_corner: None };
        let all = PickedTriangles { triangles: &triangles, picks };
        self.picks(all, drawn_by(interpolation), &mut SpanScratch::default(), None)
    }
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use alloc::vec;
    use alloc::vec::Vec;
    use core::ops::Range;

    use proptest::prelude::*;

    use super::*;
    use crate::raster::depth::DepthBuffer;
    use crate::raster::frame::{Frame, Rect};
    use crate::span::Kernel;

    /// Rows of several pieces, and a pitch that differs from the width.
    const WIDTH: u32 = 400;
    const PITCH: usize = 411;
    /// The rows of the frame, and those that a band of it holds.
    const HEIGHT: u32 = 90;
    const BAND: Range<u32> = 17..71;

    /// A vertex near the frame, on a pixel's centre or not, or as far out as possible.
    fn vertex() -> impl Strategy<Value = Vertex> {
        let near = || -(60 << 8)..460_i32 << 8;
        let at =
            || prop_oneof![4 => near(), 1 => near().prop_map(|bits| bits | 0xFF), 2 => -(4_095 << 8)..=4_095_i32 << 8];
        let depth = prop_oneof![0..=1_u32 << 30, any::<u32>(), 0..3_u32];
        (at(), at(), 0..=0xFF00_u16, depth).prop_map(|(x, y, shade, depth)| {
            let [x, y] = [x, y].map(I24F8::from_bits);
            Vertex::new(x, y, U8F8::from_bits(shade), depth).expect("within the guard band")
        })
    }

    /// Draws by one method or the other; returns counts, bytes and cells.
    fn drawn<D: Cell>(
        (triangles, interpolation): (&[[Vertex; 3]], Interpolation),
        (clip, kernel): (Rect, Kernel),
        [are_together, is_band, has_depth]: [bool; 3],
    ) -> (Vec<DrawStats>, Vec<u8>, Vec<D>) {
        let rows = if is_band { BAND } else { 0..HEIGHT };
        let count = (rows.end - rows.start) as usize;
        let (mut bytes, mut cells) = (vec![9; count * PITCH], vec![D::default(); count * WIDTH as usize]);
        let frame = Frame::band(&mut bytes, WIDTH, HEIGHT, PITCH, rows).expect("a legal band");
        let depth = DepthBuffer::new(&mut cells, &frame).expect("as long as the band");
        let mut raster =
            Raster { clip: frame.bounds(), frame, depth: has_depth.then_some(depth), kernel }.with_clip(clip);
        let draw = |vertices| match are_together {
            true => raster.tall_triangle(vertices, interpolation),
            false => raster.triangle_by_rows(vertices, interpolation),
        };
        let counts = triangles.iter().map(draw).collect();
        (counts, bytes, cells)
    }

    /// Triangles that [`Raster::triangles`] leaves out draw nothing, at every side of a box and of
    /// a centre; and every triangle whose box alone shows that it draws nothing is left out.
    #[test]
    fn triangles_that_miss_all_centres_draw_nothing() {
        let coordinates = [-129_i32, -128, -127, 0, 127, 128, 129, 255, 384];
        let points: Vec<Vertex> = coordinates
            .into_iter()
            .flat_map(|x| coordinates.map(|y| [x, y].map(|bits| I24F8::from_bits(bits + 1_024))))
            .map(|[x, y]| Vertex::new(x, y, U8F8::from(9), 0).expect("within the guard band"))
            .collect();
        let mut bytes = [0; 64];
        let mut raster = Raster::new(Frame::new(&mut bytes, 8, 8, 8).expect("a legal frame"));
        let mut left_out = 0;
        for a in &points {
            for b in &points {
                for corners in points.iter().map(|c| [*a, *b, *c]).filter(misses_centres) {
                    assert_eq!(raster.triangle_by_rows(&corners, Interpolation::Gouraud88).pixels, 0, "{corners:?}");
                    left_out += 1;
                }
            }
        }
        // The first two, the next four and the last three each lie between the same centres: all corners in one such
        // interval, for x or y.
        let of_one = [2_usize, 4, 3].map(|n| n.pow(3)).iter().sum::<usize>();
        let of_all = coordinates.len().pow(3);
        assert_eq!(left_out, 2 * of_one * of_all - of_one * of_one);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]

        /// [`Raster::indexed`] gives the bytes, depths and counts of [`Raster::triangle`] for each,
        /// and leaves out triangles with an index that is out of range.
        #[test]
        fn indexed_triangles_are_those_of_their_vertices(
            vertices in [vertex(), vertex(), vertex(), vertex(), vertex(), vertex()],
            indices in prop::collection::vec([0..6_u32, 0..6_u32, 0..6_u32], 0..300),
            beyond in prop::option::of(6..=u32::MAX),
            which in 0..Interpolation::INTERPOLATED.len() + 1,
            has_depth: bool,
        ) {
            let interpolation = Interpolation::INTERPOLATED.get(which).copied().unwrap_or(Interpolation::Flat(77));
            let mut table = VertexTable::<6>::new();
            for (i, vertex) in vertices.iter().enumerate() {
                prop_assert!(table.set(i, vertex));
                prop_assert_eq!(table.get(i), Some(*vertex));
            }
            prop_assert!(!table.set(6, &vertices[0]) && table.get(6).is_none());
            let mut named = indices.clone();
            if let Some(index) = beyond {
                named.insert(indices.len() / 2, [0, index, 1]);
            }
            let draw = |is_indexed: bool| {
                let (mut bytes, mut cells) = (vec![9; 90 * PITCH], vec![0_u32; 90 * WIDTH as usize]);
                let frame = Frame::new(&mut bytes, WIDTH, HEIGHT, PITCH).expect("a legal frame");
                let depth = DepthBuffer::new(&mut cells, &frame).expect("as long as the frame");
                let depth = has_depth.then_some(depth);
                let mut raster = Raster { clip: frame.bounds(), frame, depth, kernel: Kernel::default() };
                let mut drawn = DrawStats::default();
                if is_indexed {
                    drawn = raster.indexed(&table, &named, interpolation);
                } else {
                    for corners in &indices {
                        drawn += raster.triangle(&corners.map(|i| vertices[i as usize]), interpolation);
                    }
                }
                (drawn, bytes, cells)
            };
            prop_assert!(draw(true) == draw(false));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2_000))]

        /// Both methods by which [`Raster::triangle`] draws give equal bytes, depths and counts.
        #[test]
        fn rows_together_are_rows_by_themselves(
            triangles in prop::collection::vec([vertex(), vertex(), vertex()], 1..6),
            ([x0, y0], [x1, y1]) in ([0..WIDTH, 0..HEIGHT], [1..WIDTH + 1, 1..HEIGHT + 1]),
            which in 0..Interpolation::INTERPOLATED.len() + 1,
            kernel: u8,
            is_band: bool,
            has_depth: bool,
        ) {
            let interpolation = Interpolation::INTERPOLATED.get(which).copied().unwrap_or(Interpolation::Flat(77));
            prop_assume!(interpolation.has_exact_cover());
            let kernels: Vec<Kernel> = Kernel::available().collect();
            let of = (Rect { x0, y0, x1: x1.max(x0), y1: y1.max(y0) }, kernels[usize::from(kernel) % kernels.len()]);
            let what = (&*triangles, interpolation);
            let ways = [[true, is_band, has_depth], [false, is_band, has_depth]];
            let [together, alone] = ways.map(|way| drawn::<u32>(what, of, way));
            prop_assert!(together == alone);
            let [together, alone] = ways.map(|way| drawn::<u16>(what, of, way));
            prop_assert!(together == alone);
        }
    }
}
