//! Small triangles by AVX2: their rows as a list in arrays, four rows at a time, and the list to pixels.
//!
//! What `rows::list` does row by row is done here for four rows at once, and what is no row is squeezed out of the
//! vectors, by a table of the sixteen ways to do so: no branch asks how many rows a triangle has. Where the eight of a group
//! have at most four rows each, a row of all eight is worked out at once, and then put into the triangles' order; else eight
//! rows of one. (Of 8 pixels a triangle TODO ns a face, where row by row it is TODO.)

use core::arch::x86_64::*;
use core::mem::MaybeUninit;

use super::super::Batch;
use super::super::depths::Planes;
use super::super::rows::{Edges, Gathered, Group, LANES, MAGIC, Place, set_up};
use super::super::sieve::Chosen;
use super::{Eight, ints, planes};
use crate::raster::triangle::Drawn;
use crate::span::avx2::span;
use crate::span::nearer::{self, Tested};

/// Spans at most, ...
const ROOM: usize = 192;
/// ... and rows that are put in at a time. What is behind those that are spans is written over.
const FOUR: usize = 4;
/// The most rows of a group.
const MOST: usize = LANES * LANES;

/// Draws small triangles, with `DEPTHS` where they are nearer than cells. Only for a processor for which `Kernel::has_avx2` is
/// true.
#[target_feature(enable = "avx2,fma")]
pub(super) fn draw<const DEPTHS: bool>(
    batch: &Batch,
    kept: &[Chosen],
    place: Place,
    pixels: &mut [u8],
    cells: &mut [u32],
) -> Drawn {
    let mut spans = Spans::new();
    let mut group = Group::NONE;
    let mut planes_of_eight = Planes::NONE;
    let mut gathered = Gathered::of(batch, kept, place);
    for (number, eight) in kept.chunks(LANES).enumerate() {
        // Closures are compiled for AVX2 as this is, and names of functions are not.
        (|gathered: &Gathered, group: &mut Group| set_up::<false>(gathered, place, group))(&gathered, &mut group);
        if DEPTHS {
            planes_of_eight = planes(&gathered, &group);
        }
        // As in `rows_by`.
        gathered.gather(batch, &kept[kept.len().min((number + 1) * LANES)..], place);
        group.rows[eight.len().min(LANES)..].fill(0);
        spans.list::<DEPTHS>(&group, &planes_of_eight, place, (pixels, cells));
    }
    spans.draw::<DEPTHS>(pixels, cells);
    spans.drawn(DEPTHS)
}

/// Which of four are left, one after the other: the places of 32 bits in a vector of 64-bit numbers, ...
static WIDE: [[u32; LANES]; 16] = orders().0;
/// ... and those of bytes in one of 32-bit numbers; ...
static NARROW: [[u8; 16]; 16] = orders().1;
/// ... and how many they are.
static COUNT: [u8; 16] = orders().2;

const fn orders() -> ([[u32; LANES]; 16], [[u8; 16]; 16], [u8; 16]) {
    let (mut wide, mut narrow, mut count) = ([[0; LANES]; 16], [[0; 16]; 16], [0; 16]);
    let mut kept = 0;
    while kept < 16 {
        let (mut from, mut to) = (0, 0);
        while from < FOUR {
            if kept >> from & 1 == 1 {
                // All are below 16.
                (wide[kept][2 * to], wide[kept][2 * to + 1]) = (2 * from as u32, 2 * from as u32 + 1);
                let mut byte = 0;
                while byte < 4 {
                    narrow[kept][4 * to + byte] = (4 * from + byte) as u8;
                    byte += 1;
                }
                to += 1;
            }
            from += 1;
        }
        count[kept] = to as u8;
        kept += 1;
    }
    (wide, narrow, count)
}

/// Four rows, as they are in the list. Those of no length are none.
struct Four {
    at: __m128i,
    cell: __m128i,
    length: __m128i,
    paint: __m128i,
    z: __m256i,
    dz: __m256i,
}

/// A row of each of eight triangles, or eight rows of one.
#[derive(Clone, Copy)]
struct Rows {
    at: __m256i,
    cell: __m256i,
    length: __m256i,
    paint: __m256i,
    /// Numbers 0 to 3 and 4 to 7.
    z: [__m256i; 2],
}

/// A span out of the arrays. (A function by itself, since a closure would be compiled for FMA as well, and not become part of
/// `nearer::fill`: 6 % of a frame.)
fn tested((((((&at, &cell), &length), &paint), &z), &dz): (((((&u32, &u32), &u32), &u32), &i64), &i64)) -> Tested {
    Tested { at, cell, length, paint, z, dz }
}

/// Spans in arrays.
struct Spans {
    // Written before they are read: `put` counts what it has written.
    at: Numbers,
    cell: Numbers,
    length: Numbers,
    /// Shade, and above it the step.
    paint: Numbers,
    /// Depths, the whole parts in the upper halves.
    z: Depths,
    dz: Depths,
    count: usize,
    /// Pixels of all that was listed, in four parts.
    covered: __m128i,
    /// Spans that have been drawn, and pixels that were nearer.
    spans: u32,
    nearer: u32,
}

type Numbers = [MaybeUninit<u32>; ROOM + FOUR];
type Depths = [MaybeUninit<i64>; ROOM + FOUR];

impl Spans {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn new() -> Self {
        const NUMBERS: Numbers = [MaybeUninit::uninit(); ROOM + FOUR];
        const DEPTHS: Depths = [MaybeUninit::uninit(); ROOM + FOUR];
        Self {
            at: NUMBERS,
            cell: NUMBERS,
            length: NUMBERS,
            paint: NUMBERS,
            z: DEPTHS,
            dz: DEPTHS,
            count: 0,
            covered: _mm_setzero_si128(),
            spans: 0,
            nearer: 0,
        }
    }

    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn drawn(&self, depths: bool) -> Drawn {
        let two = _mm_add_epi32(self.covered, _mm_srli_si128(self.covered, 8));
        // Small triangles of a batch have below 2¹⁷ pixels.
        let covered = _mm_cvtsi128_si32(_mm_add_epi32(two, _mm_srli_si128(two, 4))).cast_unsigned();
        let (tested, pixels) = if depths { (covered, self.nearer) } else { (0, covered) };
        Drawn { spans: self.spans, covered, pixels, tested, ..Drawn::default() }
    }

    /// Lists all rows of a group's triangles, and draws first if there might be no room for them.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn list<const DEPTHS: bool>(
        &mut self,
        group: &Group,
        planes: &Planes,
        place: Place,
        (pixels, cells): (&mut [u8], &mut [u32]),
    ) {
        if self.count + MOST > ROOM {
            self.draw::<DEPTHS>(pixels, cells);
        }
        // A column and a row are below 4,096.
        let (pitch, width) = (place.pitch as i32, place.depth_width.unwrap_or(0) as i32);
        let most = group.rows.iter().fold(0, |most, &rows| if rows > most { rows } else { most });
        if most <= 4 {
            let columns = Columns::new::<DEPTHS>(group, planes, place);
            return match most {
                ..=0 => {}
                1 => self.of_one_row::<DEPTHS>(columns, group),
                2 => self.of_eight::<DEPTHS, 2>(columns, group, planes),
                _ => self.of_eight::<DEPTHS, 4>(columns, group, planes),
            };
        }
        for i in 0..LANES {
            let rows = group.rows[i];
            let cell = (group.row[i] - place.first_row as i32) * width + group.column[i];
            let mut first = 0;
            while first < rows {
                if self.count + LANES > ROOM {
                    self.draw::<DEPTHS>(pixels, cells);
                }
                let rows = lines::<DEPTHS>(group, i, first, cell, planes, (pitch, width));
                let dz = _mm256_set1_epi64x(planes.per_column[i] << 8);
                self.put_both::<DEPTHS>(&rows, [dz, dz]);
                first += LANES as i32;
            }
        }
    }

    /// Lists up to one row of each of eight triangles.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn of_one_row<const DEPTHS: bool>(&mut self, mut columns: Columns, group: &Group) {
        let row = columns.row::<DEPTHS>(group, 0);
        self.put_both::<DEPTHS>(&row, columns.per_column);
    }

    /// Lists up to two rows or four of each of eight triangles.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn of_eight<const DEPTHS: bool, const ROWS: usize>(
        &mut self,
        mut columns: Columns,
        group: &Group,
        planes: &Planes,
    ) {
        let mut rows = [Rows::none(); ROWS];
        for (number, row) in (0..).zip(&mut rows) {
            *row = columns.row::<DEPTHS>(group, number);
        }
        // Triangle by triangle: 0 and 4, 1 and 5, 2 and 6, 3 and 7, or, of two rows, 0, 1, 4 and 5, and 2, 3, 6 and 7.
        // Without a third and a fourth row anything in their place.
        let (a, b, c, d) = (rows[0], rows[1], rows[ROWS - 2], rows[ROWS - 1]);
        let (at, cell) = (turned::<ROWS>(a.at, b.at, c.at, d.at), turned::<ROWS>(a.cell, b.cell, c.cell, d.cell));
        let length = turned::<ROWS>(a.length, b.length, c.length, d.length);
        let paint = turned::<ROWS>(a.paint, b.paint, c.paint, d.paint);
        for half in 0..2 {
            let of_half = |eight: __m256i| match half {
                0 => _mm256_castsi256_si128(eight),
                _ => _mm256_extracti128_si256(eight, 1),
            };
            let z = |row: usize| rows[row].z[half];
            let (t0, t1) = (_mm256_unpacklo_epi64(z(0), z(1)), _mm256_unpackhi_epi64(z(0), z(1)));
            let (t2, t3) = if ROWS == 2 {
                (t0, t1)
            } else {
                let (c, d) = (z(ROWS - 2), z(ROWS - 1));
                (_mm256_unpacklo_epi64(c, d), _mm256_unpackhi_epi64(c, d))
            };
            let first = half * FOUR;
            if ROWS == 2 {
                let z = [_mm256_permute2x128_si256(t0, t1, 0x20), _mm256_permute2x128_si256(t0, t1, 0x31)];
                for k in 0..2 {
                    let step = |i: usize| planes.per_column[first + 2 * k + i] << 8;
                    let dz = _mm256_setr_epi64x(step(0), step(0), step(1), step(1));
                    let (at, cell) = (of_half(at[k]), of_half(cell[k]));
                    let (length, paint) = (of_half(length[k]), of_half(paint[k]));
                    self.put::<DEPTHS>(&Four { at, cell, length, paint, z: z[k], dz });
                }
            } else {
                let z = [
                    _mm256_permute2x128_si256(t0, t2, 0x20),
                    _mm256_permute2x128_si256(t1, t3, 0x20),
                    _mm256_permute2x128_si256(t0, t2, 0x31),
                    _mm256_permute2x128_si256(t1, t3, 0x31),
                ];
                for k in 0..FOUR {
                    let dz = _mm256_set1_epi64x(planes.per_column[first + k] << 8);
                    let (at, cell) = (of_half(at[k]), of_half(cell[k]));
                    let (length, paint) = (of_half(length[k]), of_half(paint[k]));
                    self.put::<DEPTHS>(&Four { at, cell, length, paint, z: z[k], dz });
                }
            }
        }
    }

    /// Puts those of eight rows that have a length behind the others, as they come. There has to be room for eight.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn put_both<const DEPTHS: bool>(&mut self, rows: &Rows, dz: [__m256i; 2]) {
        let low = |eight: __m256i| _mm256_castsi256_si128(eight);
        let high = |eight: __m256i| _mm256_extracti128_si256(eight, 1);
        let (at, cell, length, paint) = (low(rows.at), low(rows.cell), low(rows.length), low(rows.paint));
        self.put::<DEPTHS>(&Four { at, cell, length, paint, z: rows.z[0], dz: dz[0] });
        let (at, cell, length, paint) = (high(rows.at), high(rows.cell), high(rows.length), high(rows.paint));
        self.put::<DEPTHS>(&Four { at, cell, length, paint, z: rows.z[1], dz: dz[1] });
    }

    /// Puts those of four rows that have a length behind the others. There has to be room for four.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn put<const DEPTHS: bool>(&mut self, four: &Four) {
        let are_rows = _mm_cmpgt_epi32(four.length, _mm_setzero_si128());
        // Four bits.
        let kept = _mm_movemask_ps(_mm_castsi128_ps(are_rows)) as usize % 16;
        // SAFETY: sixteen bytes; the load asks for no alignment.
        let narrow = unsafe { _mm_loadu_si128(NARROW[kept].as_ptr().cast()) };
        let count = self.count.min(ROOM);
        store_four(&mut self.at, count, _mm_shuffle_epi8(four.at, narrow));
        store_four(&mut self.length, count, _mm_shuffle_epi8(four.length, narrow));
        store_four(&mut self.paint, count, _mm_shuffle_epi8(four.paint, narrow));
        if DEPTHS {
            store_four(&mut self.cell, count, _mm_shuffle_epi8(four.cell, narrow));
            // SAFETY: eight numbers of 32 bits; the load asks for no alignment.
            let wide = unsafe { _mm256_loadu_si256(WIDE[kept].as_ptr().cast()) };
            store_wide(&mut self.z, count, _mm256_permutevar8x32_epi32(four.z, wide));
            store_wide(&mut self.dz, count, _mm256_permutevar8x32_epi32(four.dz, wide));
        }
        self.covered = _mm_add_epi32(self.covered, four.length);
        self.count = count + usize::from(COUNT[kept]);
    }

    /// Draws what is listed, and empties the list.
    #[target_feature(enable = "avx2,fma")]
    fn draw<const DEPTHS: bool>(&mut self, pixels: &mut [u8], cells: &mut [u32]) {
        let count = self.count.min(ROOM);
        // SAFETY: of each array `put` has written the first `count` numbers.
        let (at, length, paint) = unsafe { (written(&self.at, count), written(&self.length, count), written(&self.paint, count)) };
        self.spans += count as u32;
        if DEPTHS {
            // SAFETY: as above; with depths of these as well.
            let (cell, z, dz) = unsafe { (written(&self.cell, count), written(&self.z, count), written(&self.dz, count)) };
            let spans = at.iter().zip(cell).zip(length).zip(paint).zip(z).zip(dz);
            self.nearer += nearer::fill(pixels, cells, spans.map(tested));
        } else {
            for ((&at, &length), &paint) in at.iter().zip(length).zip(paint) {
                span(pixels, at, length, paint);
            }
        }
        self.count = 0;
    }
}

/// Where the next row of eight triangles begins.
struct Columns {
    at: __m256i,
    cell: __m256i,
    pitch: __m256i,
    width: __m256i,
    /// Depths at the boxes' first columns, from one column to the next and from one row, as in `Spans`.
    z: [__m256i; 2],
    per_column: [__m256i; 2],
    per_row: [__m256i; 2],
}

impl Columns {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn new<const DEPTHS: bool>(group: &Group, planes: &Planes, place: Place) -> Self {
        // A column and a row are below 4,096.
        let all = |number: u32| _mm256_set1_epi32(number as i32);
        let (pitch, width) = (all(place.pitch), all(place.depth_width.unwrap_or(0)));
        let rows = _mm256_sub_epi32(ints(&group.row), all(place.first_row));
        let cell = _mm256_add_epi32(_mm256_mullo_epi32(rows, width), ints(&group.column));
        let none = [_mm256_setzero_si256(); 2];
        let (z, per_column, per_row) = if DEPTHS {
            (wide(&planes.at), wide(&planes.per_column), wide(&planes.per_row))
        } else {
            (none, none, none)
        };
        Self { at: ints(&group.at), cell, pitch, width, z, per_column, per_row }
    }

    /// Row `number`, and goes on to the next.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn row<const DEPTHS: bool>(&mut self, group: &Group, number: i32) -> Rows {
        let all = |x: f64| Eight(_mm256_set1_pd(x), _mm256_set1_pd(x));
        let (j, magic) = (all(f64::from(number)), all(MAGIC));
        let at = |edges: &Edges| {
            let n = Eight::load(&edges.per_row).times_plus(j, Eight::load(&edges.n));
            n.times_plus(Eight::load(&edges.inverse), magic)
        };
        let (long, upper, lower) = (at(&group.long), at(&group.upper), at(&group.lower));
        let number = _mm256_set1_epi32(number);
        let short = upper.or_where_not(_mm256_cmpgt_epi32(ints(&group.split), number), lower);
        let left = long.with(short, |a, b| _mm256_min_pd(a, b));
        let right = long.with(short, |a, b| _mm256_max_pd(a, b));
        let column = left.with(magic, |a, b| _mm256_sub_pd(a, b));
        let n = Eight::load(&group.per_row).times_plus(j, Eight::load(&group.n));
        let n = Eight::load(&group.per_column).times_plus(column, n);
        let shade = n.times_plus(Eight::load(&group.inverse), magic).whole();
        let (first, end) = (left.whole(), right.whole());
        let are_rows = _mm256_cmpgt_epi32(ints(&group.rows), number);
        let row = Rows {
            at: _mm256_add_epi32(self.at, first),
            cell: _mm256_add_epi32(self.cell, first),
            length: _mm256_and_si256(_mm256_sub_epi32(end, first), are_rows),
            paint: _mm256_blend_epi16(shade, ints(&group.step), 0b1010_1010),
            z: [
                if DEPTHS { _mm256_add_epi64(self.z[0], times(left.0, self.per_column[0])) } else { self.z[0] },
                if DEPTHS { _mm256_add_epi64(self.z[1], times(left.1, self.per_column[1])) } else { self.z[1] },
            ],
        };
        self.at = _mm256_add_epi32(self.at, self.pitch);
        self.cell = _mm256_add_epi32(self.cell, self.width);
        for (z, per_row) in self.z.iter_mut().zip(self.per_row) {
            *z = _mm256_add_epi64(*z, per_row);
        }
        row
    }
}

impl Rows {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn none() -> Self {
        let none = _mm256_setzero_si256();
        Self { at: none, cell: none, length: none, paint: none, z: [none; 2] }
    }
}

/// Eight rows of triangle `i` of a group, from number `first` on; its first cell is `cell`.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn lines<const DEPTHS: bool>(
    group: &Group,
    i: usize,
    first: i32,
    cell: i32,
    planes: &Planes,
    (pitch, width): (i32, i32),
) -> Rows {
    let all = |x: f64| Eight(_mm256_set1_pd(x), _mm256_set1_pd(x));
    let magic = all(MAGIC);
    let numbers = _mm256_add_epi32(_mm256_set1_epi32(first), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
    let j = Eight(
        _mm256_cvtepi32_pd(_mm256_castsi256_si128(numbers)),
        _mm256_cvtepi32_pd(_mm256_extracti128_si256(numbers, 1)),
    );
    let at = |edges: &Edges| {
        let n = all(edges.per_row[i]).times_plus(j, all(edges.n[i]));
        n.times_plus(all(edges.inverse[i]), magic)
    };
    let (long, upper, lower) = (at(&group.long), at(&group.upper), at(&group.lower));
    let above = _mm256_cmpgt_epi32(_mm256_set1_epi32(group.split[i]), numbers);
    let short = upper.or_where_not(above, lower);
    let left = long.with(short, |a, b| _mm256_min_pd(a, b));
    let right = long.with(short, |a, b| _mm256_max_pd(a, b));
    let column = left.with(magic, |a, b| _mm256_sub_pd(a, b));
    let n = all(group.per_column[i]).times_plus(column, all(group.per_row[i]).times_plus(j, all(group.n[i])));
    let shade = n.times_plus(all(group.inverse[i]), magic).whole();
    let (begin, end) = (left.whole(), right.whole());
    let are_rows = _mm256_cmpgt_epi32(_mm256_set1_epi32(group.rows[i]), numbers);
    let down = |first: i32, by: i32| {
        let first = _mm256_add_epi32(_mm256_set1_epi32(first), begin);
        _mm256_add_epi32(first, _mm256_mullo_epi32(numbers, _mm256_set1_epi32(by)))
    };
    let mut z = [_mm256_setzero_si256(); 2];
    if DEPTHS {
        let of_first = planes.at[i].wrapping_add(planes.per_row[i].wrapping_mul(first.into()));
        let (per_row, per_column) = (planes.per_row[i] << 8, _mm256_set1_epi64x(planes.per_column[i] << 8));
        let rows = |k: i64| per_row.wrapping_mul(k);
        let down = _mm256_setr_epi64x(0, rows(1), rows(2), rows(3));
        let upper = _mm256_add_epi64(_mm256_set1_epi64x(of_first << 8), down);
        z[0] = _mm256_add_epi64(upper, times(left.0, per_column));
        z[1] = _mm256_add_epi64(_mm256_add_epi64(upper, _mm256_set1_epi64x(rows(4))), times(left.1, per_column));
    }
    Rows {
        at: down(group.at[i], pitch),
        cell: down(cell, width),
        length: _mm256_and_si256(_mm256_sub_epi32(end, begin), are_rows),
        paint: _mm256_blend_epi16(shade, _mm256_set1_epi32(group.step[i]), 0b1010_1010),
        z,
    }
}

/// Four numbers of each of eight triangles, or two, triangle by triangle.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn turned<const ROWS: usize>(a: __m256i, b: __m256i, c: __m256i, d: __m256i) -> [__m256i; FOUR] {
    let (t0, t1) = (_mm256_unpacklo_epi32(a, b), _mm256_unpackhi_epi32(a, b));
    if ROWS == 2 {
        return [t0, t1, t0, t1];
    }
    let (t2, t3) = (_mm256_unpacklo_epi32(c, d), _mm256_unpackhi_epi32(c, d));
    [
        _mm256_unpacklo_epi64(t0, t2),
        _mm256_unpackhi_epi64(t0, t2),
        _mm256_unpacklo_epi64(t1, t3),
        _mm256_unpackhi_epi64(t1, t3),
    ]
}

/// Whole numbers below 2³², in the low bits of sums with `MAGIC`, times others, modulo 2⁶⁴.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn times(sums: __m256d, others: __m256i) -> __m256i {
    let numbers = _mm256_castpd_si256(sums);
    let upper = _mm256_mul_epu32(numbers, _mm256_srli_epi64(others, 32));
    _mm256_add_epi64(_mm256_mul_epu32(numbers, others), _mm256_slli_epi64(upper, 32))
}

/// Depths, shifted as in `Spans`.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn wide(from: &[i64; LANES]) -> [__m256i; 2] {
    // SAFETY: eight i64, four and four; the loads ask for no alignment.
    let (low, high) = unsafe { (_mm256_loadu_si256(from.as_ptr().cast()), _mm256_loadu_si256(from.as_ptr().add(4).cast())) };
    [_mm256_slli_epi64(low, 8), _mm256_slli_epi64(high, 8)]
}

/// The first of these.
///
/// # Safety
/// So many have been written.
unsafe fn written<T>(numbers: &[MaybeUninit<T>; ROOM + FOUR], count: usize) -> &[T] {
    let first = &numbers[..count];
    // SAFETY: by the caller's promise; `MaybeUninit<T>` has the layout of `T`.
    unsafe { &*(&raw const *first as *const [T]) }
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn store_four(to: &mut Numbers, at: usize, four: __m128i) {
    debug_assert!(at <= ROOM);
    // SAFETY: `put`, which alone calls this, has `at` no greater than `ROOM`, so that there are four; the store asks for no
    // alignment.
    unsafe { _mm_storeu_si128(to.as_mut_ptr().add(at).cast(), four) }
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn store_wide(to: &mut Depths, at: usize, four: __m256i) {
    debug_assert!(at <= ROOM);
    // SAFETY: as above.
    unsafe { _mm256_storeu_si256(to.as_mut_ptr().add(at).cast(), four) }
}
