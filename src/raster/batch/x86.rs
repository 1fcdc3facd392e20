//! The stages of a batch, compiled for AVX2: four f64 at a time where SSE2 has two, and minima of integers.

use core::arch::x86_64::*;

mod eight_rows;
mod listed;

use super::Batch;
use super::avx512::{self, listed as listed_512, tall::Large};
use super::depths::Planes;
use super::rows::{
    Draw, Edges, Floats, Gathered, Group, Ints, LANES, MAGIC, Place, Row, Spans, rows_by, set_up, tall_by,
};
use super::sieve::{Chosen, Kept, Kind, pack, sieve_by};
use crate::raster::draw_stats::DrawStats;
use crate::raster::frame::Rect;
use crate::raster::shade::RESEED;

/// Only with a kernel that has `Avx2`.
pub(super) fn sieve(batch: &Batch, clip: Rect, kept: &mut Kept) {
    #[expect(
        clippy::redundant_closure,
        reason = "a closure is compiled for AVX2 as this is, and a function's name is not"
    )]
    #[target_feature(enable = "avx2")]
    fn avx2(batch: &Batch, clip: Rect, kept: &mut Kept) {
        sieve_by(batch, clip, kept, |eight, to| pack(eight, to));
    }
    // SAFETY: such a kernel is given out only where AVX2 was found.
    unsafe { avx2(batch, clip, kept) }
}

/// Only with a kernel that has `Avx512`.
pub(super) fn sieve_512(batch: &Batch, clip: Rect, kept: &mut Kept) {
    #[target_feature(enable = "avx2")]
    fn avx2(batch: &Batch, clip: Rect, kept: &mut Kept) {
        if batch.is_sifted {
            // SAFETY: such a kernel is given out only where AVX-512 was found.
            return unsafe { avx512::sieve::sieve(batch, clip, kept) };
        }
        if batch.is_full() {
            avx512::fetch(batch);
        }
        // SAFETY: such a kernel is given out only where AVX-512 was found.
        sieve_by(batch, clip, kept, |eight, to| unsafe { avx512::pack(eight, to) });
    }
    // SAFETY: such a kernel is given out only where AVX-512 was found, and with it AVX2.
    unsafe { avx2(batch, clip, kept) }
}

/// Only with a kernel that has `Avx2`.
pub(super) fn rows(batch: &Batch, kept: &[Chosen], place: Place, spans: &mut Spans<'_>) -> usize {
    #[target_feature(enable = "avx2")]
    fn avx2(batch: &Batch, kept: &[Chosen], place: Place, spans: &mut Spans<'_>) -> usize {
        // A closure is compiled for AVX2 as this is. (A function's name is not: a quarter slower.)
        let set_up = |gathered: &Gathered, place, group: &mut Group| set_up::<false>(gathered, place, group);
        let row = |group: &Group, number, pitch, to: &mut Row| row(group, number, pitch, to);
        rows_by(batch, kept, place, spans, set_up, row, |gathered, group| planes(gathered, group))
    }
    // SAFETY: such a kernel is given out only where AVX2 was found.
    unsafe { avx2(batch, kept, place, spans) }
}

/// Draws small triangles. Only with a kernel that has `Avx2`.
pub(super) fn small(
    batch: &Batch,
    kept: &[Chosen],
    place: Place,
    pixels: &mut [u8],
    cells: Option<&mut [u32]>,
) -> DrawStats {
    // SAFETY: such a kernel is given out only where AVX2 and FMA were found.
    unsafe {
        match cells {
            Some(cells) => listed::draw::<true>(batch, kept, place, pixels, cells),
            None => listed::draw::<false>(batch, kept, place, pixels, &mut []),
        }
    }
}

/// Only with a kernel that has `Avx2`.
pub(super) fn tall(batch: &Batch, kept: &[Chosen], place: Place, spans: &mut Spans<'_>, draw: Draw<'_>) {
    #[target_feature(enable = "avx2")]
    fn avx2(batch: &Batch, kept: &[Chosen], place: Place, spans: &mut Spans<'_>, draw: Draw<'_>) {
        tall_by(batch, kept, place, spans, draw, |group, i, first, pitch, at, length, paints| {
            lines(group, i, first, pitch, at, length, paints)
        });
    }
    // SAFETY: such a kernel is given out only where AVX2 was found.
    unsafe { avx2(batch, kept, place, spans, draw) }
}

/// Draws small, large and clipped triangles in turn, without a list of more than a few spans. Only with a kernel for
/// which `Kernel::avx512` is one.
pub(super) fn at_once(
    batch: &Batch,
    kept: &[Chosen],
    place: (Place, Rect),
    pixels: &mut [u8],
    cells: Option<&mut [u32]>,
) -> DrawStats {
    #[target_feature(enable = "avx2")]
    fn with_depths(
        batch: &Batch,
        kept: &[Chosen],
        (place, clip): (Place, Rect),
        pixels: &mut [u8],
        cells: &mut [u32],
    ) -> DrawStats {
        let mut listed = listed_512::Spans::new(place);
        let (mut group, mut planes) = (Group::NONE, Planes::NONE);
        let mut gathered = Gathered::of(batch, kept, place);
        for (number, eight) in kept.chunks(LANES).enumerate() {
            // SAFETY: such a kernel is given out only where AVX-512 was found.
            unsafe {
                avx512::set_up(&gathered, place, &mut group);
                planes.renew(&gathered, &group);
            }
            // As in `rows_by`.
            gathered.gather(batch, &kept[kept.len().min((number + 1) * LANES)..], place);
            match small_rows(&group, eight) {
                // SAFETY: as above.
                Some(most @ ..=listed_512::FEW_ROWS) => unsafe {
                    listed.add_all(&group, eight.len(), most, Some(&planes), (pixels, cells));
                    continue;
                },
                // SAFETY: as above.
                Some(most) => unsafe {
                    listed.add_each(&group, eight.len(), most, &planes, (pixels, cells));
                    continue;
                },
                None => {}
            }
            for (i, triangle) in eight.iter().enumerate() {
                let (kind, mut pieces) = (triangle.kind(), 1);
                // One without area has no rows, and no plane.
                if kind != Kind::Small && group.rows[i] > 0 {
                    planes.put(i, &group, &batch.depth_plane(triangle.number()));
                    pieces = batch.pieces(triangle.number());
                }
                let clip = (kind == Kind::Clipped).then_some(clip);
                // SAFETY: as above.
                unsafe { listed.add(&group, i, (pieces, clip), Some(&planes), (pixels, cells)) };
            }
        }
        // SAFETY: as above; the same pixels and cells.
        unsafe { listed.draw(true, pixels, cells) };
        let (spans, covered, nearer) = listed.counts();
        DrawStats { spans, covered, pixels: nearer, tested: covered, ..DrawStats::default() }
    }
    #[target_feature(enable = "avx2")]
    fn without(batch: &Batch, kept: &[Chosen], (place, clip): (Place, Rect), pixels: &mut [u8]) -> DrawStats {
        let (mut tall, mut listed) = (Large::new(), listed_512::Spans::new(place));
        let mut group = Group::NONE;
        let mut gathered = Gathered::of(batch, kept, place);
        for (number, eight) in kept.chunks(LANES).enumerate() {
            // SAFETY: such a kernel is given out only where AVX-512 was found.
            unsafe { avx512::set_up(&gathered, place, &mut group) };
            gathered.gather(batch, &kept[kept.len().min((number + 1) * LANES)..], place);
            if let Some(most @ ..=listed_512::FEW_ROWS) = small_rows(&group, eight) {
                // SAFETY: as above.
                unsafe { listed.add_all(&group, eight.len(), most, None, (pixels, &mut [])) };
                continue;
            }
            for (i, triangle) in eight.iter().enumerate() {
                match triangle.kind() {
                    Kind::Large => {
                        let interpolation = batch.interpolation[triangle.number()];
                        // SAFETY: as above; always the same pixels.
                        unsafe {
                            listed.draw(false, pixels, &mut []);
                            tall.draw(&group, i, interpolation, place, pixels);
                        }
                    }
                    Kind::Clipped => {
                        let pieces = batch.pieces(triangle.number());
                        // SAFETY: as above.
                        unsafe { listed.add(&group, i, (pieces, Some(clip)), None, (pixels, &mut [])) };
                    }
                    // SAFETY: as above.
                    _ => unsafe { listed.add(&group, i, (1, None), None, (pixels, &mut [])) },
                }
            }
        }
        // SAFETY: as above; the same pixels.
        unsafe { listed.draw(false, pixels, &mut []) };
        let ((spans, covered, _), (more_spans, more)) = (listed.counts(), tall.drawn());
        let covered = covered + more;
        DrawStats { spans: spans + more_spans, covered, pixels: covered, ..DrawStats::default() }
    }
    // SAFETY: such a kernel is given out only where AVX-512 was found, and with it AVX2.
    unsafe {
        match cells {
            Some(cells) => with_depths(batch, kept, place, pixels, cells),
            None => without(batch, kept, place, pixels),
        }
    }
}

/// The most rows that a group's triangles have, if they are all small.
#[inline(always)]
fn small_rows(group: &Group, triangles: &[Chosen]) -> Option<i32> {
    let rows = &group.rows[..triangles.len().min(LANES)];
    let most = rows.iter().fold(0, |most, &rows| if rows > most { rows } else { most });
    Chosen::are_small(triangles).then_some(most)
}

/// Apart, as the compiler would else keep eight triangles in registers that it has not.
#[inline(never)]
#[target_feature(enable = "avx2")]
fn planes(gathered: &Gathered, group: &Group) -> Planes {
    Planes::of(gathered, group)
}

/// Eight f64.
#[derive(Clone, Copy)]
struct Eight(__m256d, __m256d);

impl Eight {
    #[inline]
    #[target_feature(enable = "avx2")]
    fn load(from: &Floats) -> Self {
        // SAFETY: eight f64, four and four; the loads ask for no alignment.
        unsafe { Self(_mm256_loadu_pd(from.as_ptr()), _mm256_loadu_pd(from.as_ptr().add(4))) }
    }

    /// Four and four by `of`.
    #[inline]
    #[target_feature(enable = "avx2")]
    fn with(self, other: Self, of: impl Fn(__m256d, __m256d) -> __m256d) -> Self {
        Self(of(self.0, other.0), of(self.1, other.1))
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    fn plus(self, other: Self) -> Self {
        self.with(other, |a, b| _mm256_add_pd(a, b))
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    fn times(self, other: Self) -> Self {
        self.with(other, |a, b| _mm256_mul_pd(a, b))
    }

    /// Multiplies and adds, rounded once: nearer than in two steps, which the margin in `rows` is for.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn times_plus(self, by: Self, plus: Self) -> Self {
        Self(_mm256_fmadd_pd(self.0, by.0, plus.0), _mm256_fmadd_pd(self.1, by.1, plus.1))
    }

    /// Selects these where a mask of eight i32 is set, otherwise the others.
    #[inline]
    #[target_feature(enable = "avx2")]
    fn or_where_not(self, mask: __m256i, others: Self) -> Self {
        let wide = |four| _mm256_castsi256_pd(_mm256_cvtepi32_epi64(four));
        Self(
            _mm256_blendv_pd(others.0, self.0, wide(_mm256_castsi256_si128(mask))),
            _mm256_blendv_pd(others.1, self.1, wide(_mm256_extracti128_si256(mask, 1))),
        )
    }

    /// The whole numbers of sums with `MAGIC`: the lower halves.
    #[inline]
    #[target_feature(enable = "avx2")]
    fn whole(self) -> __m256i {
        let halves = _mm256_shuffle_ps(_mm256_castpd_ps(self.0), _mm256_castpd_ps(self.1), 0b10_00_10_00);
        _mm256_permute4x64_epi64(_mm256_castps_si256(halves), 0b11_01_10_00)
    }
}

/// `rows::row`. (The compiler makes of its loop one without vectors, or of the loop over rows one with; from 26 to 22 ns a
/// triangle of 2.7 pixels.)
#[inline]
#[target_feature(enable = "avx2")]
fn row(group: &Group, row: i32, pitch: i32, to: &mut Row) {
    let all = |x: f64| Eight(_mm256_set1_pd(x), _mm256_set1_pd(x));
    let (j, magic) = (all(f64::from(row)), all(MAGIC));
    let at = |edges: &Edges| {
        let n = Eight::load(&edges.per_row).times(j).plus(Eight::load(&edges.n));
        n.times(Eight::load(&edges.inverse)).plus(magic)
    };
    let (long, upper, lower) = (at(&group.long), at(&group.upper), at(&group.lower));
    let number = _mm256_set1_epi32(row);
    let above = _mm256_cmpgt_epi32(ints(&group.split), number);
    let short = upper.or_where_not(above, lower);
    let left = long.with(short, |a, b| _mm256_min_pd(a, b));
    let right = long.with(short, |a, b| _mm256_max_pd(a, b));
    let column = left.with(magic, |a, b| _mm256_sub_pd(a, b));
    let n = Eight::load(&group.n)
        .plus(Eight::load(&group.per_row).times(j))
        .plus(Eight::load(&group.per_column).times(column));
    let shade = n.times(Eight::load(&group.inverse)).plus(magic).whole();
    let (first, end) = (left.whole(), right.whole());
    let is_row = _mm256_cmpgt_epi32(ints(&group.rows), number);
    let down = _mm256_set1_epi32(row * pitch);
    store(&mut to.at, _mm256_add_epi32(_mm256_add_epi32(ints(&group.at), down), first));
    store(&mut to.length, _mm256_and_si256(_mm256_sub_epi32(end, first), is_row));
    store(&mut to.paint, _mm256_blend_epi16(shade, ints(&group.step), 0b1010_1010));
}

/// `rows::lines`.
#[inline]
#[target_feature(enable = "avx2")]
fn lines(group: &Group, i: usize, first: i32, pitch: i32, to_at: &mut Ints, length: &mut Ints, paints: &mut [Ints]) {
    let all = |x: f64| Eight(_mm256_set1_pd(x), _mm256_set1_pd(x));
    let magic = all(MAGIC);
    let numbers = _mm256_add_epi32(_mm256_set1_epi32(first), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
    let j = Eight(
        _mm256_cvtepi32_pd(_mm256_castsi256_si128(numbers)),
        _mm256_cvtepi32_pd(_mm256_extracti128_si256(numbers, 1)),
    );
    let at = |edges: &Edges| {
        let n = all(edges.per_row[i]).times(j).plus(all(edges.n[i]));
        n.times(all(edges.inverse[i])).plus(magic)
    };
    let (long, upper, lower) = (at(&group.long), at(&group.upper), at(&group.lower));
    let above = _mm256_cmpgt_epi32(_mm256_set1_epi32(group.split[i]), numbers);
    let short = upper.or_where_not(above, lower);
    let left = long.with(short, |a, b| _mm256_min_pd(a, b));
    let right = long.with(short, |a, b| _mm256_max_pd(a, b));
    let (begin, end) = (left.whole(), right.whole());
    let down = _mm256_mullo_epi32(numbers, _mm256_set1_epi32(pitch));
    store(to_at, _mm256_add_epi32(_mm256_add_epi32(_mm256_set1_epi32(group.at[i]), down), begin));
    store(length, _mm256_sub_epi32(end, begin));
    let (per_column, inverse) = (all(group.per_column[i]), all(group.inverse[i]));
    let column = left.with(magic, |a, b| _mm256_sub_pd(a, b));
    let mut n = all(group.n[i]).plus(all(group.per_row[i]).times(j)).plus(per_column.times(column));
    let (step, next) = (_mm256_set1_epi32(group.step[i]), per_column.times(all(f64::from(RESEED))));
    for paint in paints {
        store(paint, _mm256_blend_epi16(n.times(inverse).plus(magic).whole(), step, 0b1010_1010));
        n = n.plus(next);
    }
}

#[inline]
#[target_feature(enable = "avx2")]
fn ints(from: &[i32; 8]) -> __m256i {
    // SAFETY: eight i32; the load asks for no alignment.
    unsafe { _mm256_loadu_si256(from.as_ptr().cast()) }
}

#[inline]
#[target_feature(enable = "avx2")]
fn store(to: &mut [i32; 8], ints: __m256i) {
    // SAFETY: eight i32; the store asks for no alignment.
    unsafe { _mm256_storeu_si256(to.as_mut_ptr().cast(), ints) }
}
