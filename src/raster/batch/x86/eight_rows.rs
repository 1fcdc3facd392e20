//! Rows by AVX2, eight at a time: one of each of eight small triangles, or eight of one.

use core::arch::x86_64::*;

use super::super::depths::Planes;
use super::super::rows::{Edges, Group, LANES, MAGIC, Place};
use super::{Eight, ints};

/// A row of each of eight triangles, or eight rows of one.
#[derive(Clone, Copy)]
pub(super) struct Rows {
    pub(super) at: __m256i,
    pub(super) cell: __m256i,
    pub(super) length: __m256i,
    pub(super) paint: __m256i,
    /// Depths of numbers 0 to 3 and 4 to 7, the integer parts in the upper halves.
    pub(super) z: [__m256i; 2],
}

/// Beginnings of the next row of eight triangles.
pub(super) struct Columns {
    at: __m256i,
    cell: __m256i,
    pitch: __m256i,
    width: __m256i,
    /// Depths at the boxes' first columns, from one column to the next and from one row, shifted like those of `Rows`.
    z: [__m256i; 2],
    pub(super) per_column: [__m256i; 2],
    per_row: [__m256i; 2],
}

impl Columns {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    pub(super) fn new<const DEPTHS: bool>(group: &Group, planes: &Planes, place: Place) -> Self {
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
    pub(super) fn row<const DEPTHS: bool>(&mut self, group: &Group, number: i32) -> Rows {
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
    pub(super) fn none() -> Self {
        let none = _mm256_setzero_si256();
        Self { at: none, cell: none, length: none, paint: none, z: [none; 2] }
    }
}

/// Eight rows of triangle `i` of a group, from number `first` on; its first cell is `cell`.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(super) fn lines<const DEPTHS: bool>(
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

/// Whole numbers below 2³², in the low bits of sums with `MAGIC`, times others, modulo 2⁶⁴.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn times(sums: __m256d, others: __m256i) -> __m256i {
    let numbers = _mm256_castpd_si256(sums);
    let upper = _mm256_mul_epu32(numbers, _mm256_srli_epi64(others, 32));
    _mm256_add_epi64(_mm256_mul_epu32(numbers, others), _mm256_slli_epi64(upper, 32))
}

/// Depths, shifted shifted like those of `Rows`.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn wide(from: &[i64; LANES]) -> [__m256i; 2] {
    // SAFETY: eight i64, four and four; the loads ask for no alignment.
    let (low, high) =
        unsafe { (_mm256_loadu_si256(from.as_ptr().cast()), _mm256_loadu_si256(from.as_ptr().add(4).cast())) };
    [_mm256_slli_epi64(low, 8), _mm256_slli_epi64(high, 8)]
}
