//! Small triangles by AVX2: their rows as a list in arrays, four rows at a time, and the list to pixels.
//!
//! Four rows at once are worked out here, where `rows::list` goes row by row. Empty rows are removed from the vectors
//! by a table of the sixteen ways to do so: no branch asks how many rows a triangle has. Where the eight of a group
//! have at most four rows each, a row of all eight is worked out at once, and then put into the triangles' order;
//! otherwise eight rows of one. (Whole frames of triangles of 8 pixels 29 ns a face, where row by row they are 36.7; of
//! 2.7 22 and 26.4.)

use core::arch::x86_64::*;
use core::mem::MaybeUninit;

use super::super::Batch;
use super::super::depths::Planes;
use super::super::rows::{Gathered, Group, LANES, Place, set_up};
use super::super::sieve::Chosen;
use super::eight_rows::{Columns, Rows, lines};
use super::planes;
use crate::raster::draw_stats::DrawStats;
use crate::span::avx2::span;
use crate::span::nearer::{self, Tested};

/// Spans at most, ...
const CAPACITY: usize = 192;
/// ... and rows that are put in at a time. Those behind the last span are written over.
const FOUR: usize = 4;
/// The most rows of a group.
const MOST: usize = LANES * LANES;

/// Draws small triangles, with `DEPTHS` where they are nearer than cells. Only for a processor that has
/// `Avx2`.
#[target_feature(enable = "avx2,fma")]
pub(super) fn draw<const DEPTHS: bool>(
    batch: &Batch,
    kept: &[Chosen],
    place: Place,
    pixels: &mut [u8],
    cells: &mut [u32],
) -> DrawStats {
    let mut spans = Spans::new();
    let mut group = Group::NONE;
    let mut planes_of_eight = Planes::NONE;
    let mut gathered = Gathered::of(batch, kept, place);
    for (number, eight) in kept.chunks(LANES).enumerate() {
        set_up::<false>(&gathered, place, &mut group);
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

/// Places of those of four that are left, one after the other: of 32 bits in a vector of 64-bit numbers, ...
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

/// A span's numbers, of each array one.
type Zipped<'a> = (((((&'a u32, &'a u32), &'a u32), &'a u32), &'a i64), &'a i64);

/// A span out of the arrays. (A function by itself, since a closure would be compiled for FMA as well, and not become part of
/// `nearer::fill`: 6 % of a frame.)
fn tested((((((&at, &cell), &length), &paint), &z), &dz): Zipped<'_>) -> Tested {
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
    /// Depths, the integer parts in the upper halves.
    z: Depths,
    dz: Depths,
    count: usize,
    /// Pixels of all that was put into the list, in four parts.
    covered: __m128i,
    /// Spans that have been drawn, and pixels that were nearer.
    spans: u32,
    nearer: u32,
}

type Numbers = [MaybeUninit<u32>; CAPACITY + FOUR];
type Depths = [MaybeUninit<i64>; CAPACITY + FOUR];

impl Spans {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn new() -> Self {
        const NUMBERS: Numbers = [MaybeUninit::uninit(); CAPACITY + FOUR];
        const DEPTHS: Depths = [MaybeUninit::uninit(); CAPACITY + FOUR];
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
    fn drawn(&self, depths: bool) -> DrawStats {
        let two = _mm_add_epi32(self.covered, _mm_srli_si128(self.covered, 8));
        // Small triangles of a batch have below 2¹⁷ pixels.
        let covered = _mm_cvtsi128_si32(_mm_add_epi32(two, _mm_srli_si128(two, 4))).cast_unsigned();
        let (tested, pixels) = if depths { (covered, self.nearer) } else { (0, covered) };
        DrawStats { spans: self.spans, covered, pixels, tested, ..DrawStats::default() }
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
        if self.count + MOST > CAPACITY {
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
                if self.count + LANES > CAPACITY {
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
        let count = self.count.min(CAPACITY);
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

    /// Draws the span list, and empties it.
    #[target_feature(enable = "avx2,fma")]
    fn draw<const DEPTHS: bool>(&mut self, pixels: &mut [u8], cells: &mut [u32]) {
        let count = self.count.min(CAPACITY);
        // SAFETY: `put` has written the first `count` numbers of each array.
        let (at, length, paint) =
            unsafe { (written(&self.at, count), written(&self.length, count), written(&self.paint, count)) };
        self.spans += count as u32;
        if DEPTHS {
            // SAFETY: as above; with depths of these as well.
            let (cell, z, dz) =
                unsafe { (written(&self.cell, count), written(&self.z, count), written(&self.dz, count)) };
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

/// The first of these.
///
/// # Safety
/// So many have been written.
unsafe fn written<T>(numbers: &[MaybeUninit<T>; CAPACITY + FOUR], count: usize) -> &[T] {
    let first = &numbers[..count];
    // SAFETY: by the caller's promise; `MaybeUninit<T>` has the layout of `T`.
    unsafe { &*(&raw const *first as *const [T]) }
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn store_four(to: &mut Numbers, at: usize, four: __m128i) {
    debug_assert!(at <= CAPACITY);
    // SAFETY: `put`, which alone calls this, has `at` no greater than `CAPACITY`, so that there are four; the store asks for no
    // alignment.
    unsafe { _mm_storeu_si128(to.as_mut_ptr().add(at).cast(), four) }
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn store_wide(to: &mut Depths, at: usize, four: __m256i) {
    debug_assert!(at <= CAPACITY);
    // SAFETY: as above.
    unsafe { _mm256_storeu_si256(to.as_mut_ptr().add(at).cast(), four) }
}
