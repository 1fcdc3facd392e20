//! Spans with AVX-512: every row ends with a masked store, so that no length has a branch of its own.
//!
//! 1. Spans of 1 to 64 pixels in random order take 2.8 ns each, the same as in sorted order; with AVX2 they take 10.4.
//! 2. Two blocks per iteration, an overlapping last store, stores aligned from the second on, and 32-byte vectors are
//!    not faster at 320 pixels and at 8. (`vpermi2b`, which packs two vectors, is three operations on Intel.)

use core::arch::x86_64::*;
use core::hint::black_box;

use super::super::list::{Span, SpanDepth, SpanList};
use crate::fixed::ROUND_MAGIC;
use crate::simd::Avx512;

/// Pixels of a vector.
const BLOCK: usize = 64;

static EVEN: [u16; 32] = {
    let mut even = [0; 32];
    let mut j = 0;
    while j < 32 {
        even[j as usize] = 2 * j;
        j += 1;
    }
    even
};

// Vectors that are read through a `black_box`, because the compiler replaces a shuffle that it
// knows, or one under a mask that it knows, with two or three operations on the shuffle port. (A
// large triangle's rows then take 3.0 ns each, otherwise 1.9.)

/// Both bytes of a 16-bit lane from its upper one.
static UPPER_BYTES: [u16; 32] = {
    let mut bytes = [0; 32];
    let mut i = 0;
    while i < 32 {
        bytes[i as usize] = (i % 8 * 2 + 1) * 0x101;
        i += 1;
    }
    bytes
};
/// The sign bit of each even byte.
static EVEN_BYTES: [u16; 32] = [0x80; 32];
/// The lowest 16 bits of a 64-bit lane, four times.
static LOWEST: [u64; 8] = {
    let (even, odd) = (0x0100_0100_0100_0100, 0x0908_0908_0908_0908);
    [even, odd, even, odd, even, odd, even, odd]
};
/// The upper halves of eight 64-bit lanes of two vectors, in 32-bit lanes.
static UPPER_HALVES: [u32; 16] = [1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31];

/// Loads one of these vectors.
#[inline]
#[target_feature(enable = "avx512f")]
fn opaque<T, const N: usize>(numbers: &'static [T; N]) -> __m512i {
    const { assert!(size_of::<[T; N]>() == 64) };
    // SAFETY: 64 bytes; the load requires no alignment.
    unsafe { _mm512_loadu_si512(black_box(numbers).as_ptr().cast()) }
}

/// [`Kernel::fill`](super::super::Kernel::fill).
#[inline]
pub(crate) fn fill(_: Avx512, row: &mut [u8], shade: u16, step: u16) {
    // SAFETY: the token proves that the processor has AVX-512; the row is that long.
    unsafe { row_of(row.as_mut_ptr(), row.len(), shade, step) }
}

/// The lowest `length` bits, at most 64.
#[inline]
#[target_feature(enable = "bmi2")]
fn ones(length: usize) -> u64 {
    _bzhi_u64(u64::MAX, length as u32)
}

/// Fills a row, 64 pixels per iteration.
///
/// ```text
/// even[j] = shade + 2·j·step
/// while more than 64 pixels are left:
///     bytes = even >> 8 | (even + step) & 0xFF00
///     even += 64·step
/// the last 1 to 64: the same bytes, stored under a mask
/// ```
///
/// # Safety
/// At least `length` bytes can be written from `row` on.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512vl,bmi2")]
unsafe fn row_of(mut row: *mut u8, length: usize, shade: u16, step: u16) {
    // SAFETY: 64 bytes; the load requires no alignment.
    let numbers = unsafe { _mm512_loadu_si512(EVEN.as_ptr().cast()) };
    let steps = _mm512_set1_epi16(step.cast_signed());
    let mut even = _mm512_add_epi16(_mm512_mullo_epi16(steps, numbers), _mm512_set1_epi16(shade.cast_signed()));
    let mut left = length;
    if left > BLOCK {
        let block = _mm512_slli_epi16::<6>(steps);
        while left > BLOCK {
            // SAFETY: more than 64 bytes are left, so 64 can be written and `row` can advance by 64; the store requires
            // no alignment.
            unsafe {
                _mm512_storeu_si512(row.cast(), bytes(even, steps));
                row = row.add(BLOCK);
            }
            even = _mm512_add_epi16(even, block);
            left -= BLOCK;
        }
    }
    // SAFETY: the mask has a bit for each byte that is left.
    unsafe { _mm512_mask_storeu_epi8(row.cast(), ones(left), bytes(even, steps)) }
}

/// Interleaves the upper bytes of even shades and of the odd ones.
#[inline]
#[target_feature(enable = "avx512f,avx512bw")]
fn bytes(even: __m512i, steps: __m512i) -> __m512i {
    let odd = _mm512_add_epi16(even, steps);
    // even >> 8 | odd & 0xFF00
    let odd_bytes = _mm512_set1_epi16(0xFF00_u16.cast_signed());
    _mm512_ternarylogic_epi32::<0xF8>(_mm512_srli_epi16::<8>(even), odd, odd_bytes)
}

/// Fills every span of a list.
pub(crate) fn fill_spans(_: Avx512, pixels: &mut [u8], spans: &SpanList) {
    if spans.are_inside(pixels) {
        // SAFETY: the token proves that the processor has AVX-512; all spans lie inside the pixels.
        unsafe { each(pixels.as_mut_ptr(), spans) }
    }
}

/// # Safety
/// All spans lie inside the pixels.
#[target_feature(enable = "avx512f,avx512bw,avx512vl,bmi2")]
unsafe fn each(pixels: *mut u8, spans: &SpanList) {
    // SAFETY: 16 bytes; the load requires no alignment.
    let numbers = unsafe { _mm_loadu_si128(EVEN.as_ptr().cast()) };
    for k in 0..spans.count() {
        let Span { at, length, paint } = spans.span(k);
        // The shade in the lower half, the step in the upper.
        let (shade, step) = (paint as u16, (paint >> 16) as u16);
        // SAFETY: by the caller's promise.
        let row = unsafe { pixels.add(at as usize) };
        if length <= 16 {
            let steps = _mm_set1_epi16(step.cast_signed());
            let even = _mm_add_epi16(_mm_mullo_epi16(steps, numbers), _mm_set1_epi16(shade.cast_signed()));
            let odd = _mm_add_epi16(even, steps);
            let odd_bytes = _mm_set1_epi16(0xFF00_u16.cast_signed());
            let bytes = _mm_ternarylogic_epi32::<0xF8>(_mm_srli_epi16::<8>(even), odd, odd_bytes);
            // SAFETY: the mask has a bit for each of the span's pixels, which are at most 16.
            unsafe { _mm_mask_storeu_epi8(row.cast(), ones(length as usize) as u16, bytes) }
            continue;
        }
        // SAFETY: by the caller's promise.
        unsafe { row_of(row, length as usize, shade, step) }
    }
}

/// A triangle whose rows are written directly to the pixels, without a list. Columns and rows are
/// relative to its box's first.
///
/// (Eight rows take half the instructions of the list, with which a cube's triangles of 3,570 pixels in 100 rows take
/// 1.57 times as long.)
#[derive(Clone, Copy)]
pub(crate) struct LargeTriangle {
    /// The numerator in the first row, its change per row, and the inverse of the divisor: of the long edge, of the
    /// upper and the lower short one, and of the shade.
    pub(crate) long: [f64; 3],
    pub(crate) upper: [f64; 3],
    pub(crate) lower: [f64; 3],
    pub(crate) shade: [f64; 3],
    /// Change of the shade's numerator per column.
    pub(crate) per_column: f64,
    /// The offset of the box's first pixel.
    pub(crate) at: i32,
    pub(crate) pitch: i32,
    pub(crate) rows: i32,
    /// The first row of the lower edge.
    pub(crate) split: i32,
    pub(crate) step: u16,
    /// True if a row is reseeded every 64 pixels.
    pub(crate) reseeds: bool,
}

/// Draws a large triangle. Rows that do not lie inside the pixels are left out. Returns the number of its spans, and of
/// their pixels.
pub(crate) fn fill_large(_: Avx512, pixels: &mut [u8], triangle: &LargeTriangle) -> (u32, u32) {
    // SAFETY: the token proves that the processor has AVX-512.
    unsafe { large(pixels, triangle) }
}

/// Numbers of eight rows, in memory.
#[repr(C, align(64))]
struct Rows([u64; 8]);

impl Rows {
    #[inline]
    #[target_feature(enable = "avx512f")]
    fn of(numbers: __m512i) -> Self {
        let mut rows = Self([0; 8]);
        // SAFETY: 64 bytes; the store requires no alignment.
        unsafe { _mm512_storeu_si512(rows.0.as_mut_ptr().cast(), numbers) }
        rows
    }
}

#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,bmi2")]
fn large(pixels: &mut [u8], triangle: &LargeTriangle) -> (u32, u32) {
    const ROWS: i32 = 8;
    let size = _mm512_set1_epi64(pixels.len() as i64);
    let pixels = pixels.as_mut_ptr();
    let magic = _mm512_set1_pd(ROUND_MAGIC);
    let (ramp, lowest) = (Ramp64::new(triangle.step), opaque(&LOWEST));
    let mut numbers = _mm512_setr_epi64(0, 1, 2, 3, 4, 5, 6, 7);
    let j = _mm512_setr_pd(0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0);
    let LargeTriangle { long, upper, lower, shade, .. } = *triangle;
    let numerators = |[n, per_row, _]: [f64; 3]| {
        (_mm512_fmadd_pd(j, _mm512_set1_pd(per_row), _mm512_set1_pd(n)), _mm512_set1_pd(per_row * f64::from(ROWS)))
    };
    let ((mut long_n, long_8), (mut upper_n, upper_8)) = (numerators(long), numerators(upper));
    let ((mut lower_n, lower_8), (mut shade_n, shade_8)) = (numerators(lower), numerators(shade));
    let inverse = |[_, _, inverse]: [f64; 3]| _mm512_set1_pd(inverse);
    let (long, upper, lower, inverse) = (inverse(long), inverse(upper), inverse(lower), inverse(shade));
    let (rows, split) = (_mm512_set1_epi64(triangle.rows.into()), _mm512_set1_epi64(triangle.split.into()));
    let pitch = i64::from(triangle.pitch);
    let first = _mm512_set1_epi64(i64::from(triangle.at).wrapping_sub(ROUND_MAGIC.to_bits().cast_signed()));
    let mut at = _mm512_add_epi64(first, _mm512_mullo_epi64(numbers, _mm512_set1_epi64(pitch)));
    let (per_column, per_piece) = (_mm512_set1_pd(triangle.per_column), triangle.per_column * BLOCK as f64);
    // Pieces of a row. A row that is not reseeded is one piece, as it has at most 1,024 pixels.
    let (round, shift) = if triangle.reseeds { (BLOCK as i64 - 1, 6) } else { (1_023, 10) };
    let (round, shift) = (_mm512_set1_epi64(round), _mm_cvtsi64_si128(shift));
    let (mut spans, mut covered) = (_mm512_setzero_si512(), _mm512_setzero_si512());
    for _ in (0..triangle.rows).step_by(ROWS as usize) {
        let is_lower = _mm512_cmpge_epi64_mask(numbers, split);
        let short = _mm512_mask_mul_pd(_mm512_mul_pd(upper_n, upper), is_lower, lower_n, lower);
        let (long, short) = (_mm512_fmadd_pd(long_n, long, magic), _mm512_add_pd(short, magic));
        let (left, right) = (_mm512_min_pd(long, short), _mm512_max_pd(long, short));
        let length = _mm512_sub_epi64(_mm512_castpd_si512(right), _mm512_castpd_si512(left));
        let begin = _mm512_add_epi64(_mm512_castpd_si512(left), at);
        // All comparisons are unsigned, so negative values are left out.
        let is_row = _mm512_cmplt_epi64_mask(numbers, rows);
        let is_row = _mm512_mask_cmple_epu64_mask(is_row, length, size);
        let is_row = _mm512_mask_cmple_epu64_mask(is_row, begin, _mm512_sub_epi64(size, length));
        let length = _mm512_maskz_mov_epi64(is_row, length);
        let numerator = _mm512_fmadd_pd(_mm512_sub_pd(left, magic), per_column, shade_n);
        let shades = _mm512_castpd_si512(_mm512_fmadd_pd(numerator, inverse, magic));
        let shades = _mm512_shuffle_epi8(shades, lowest);
        covered = _mm512_add_epi64(covered, length);
        spans = _mm512_add_epi64(spans, _mm512_srl_epi64(_mm512_add_epi64(length, round), shift));
        let (begins, lengths, shades) =
            (Rows::of(_mm512_maskz_mov_epi64(is_row, begin)), Rows::of(length), Rows::of(shades));
        let numerators = Rows::of(_mm512_castpd_si512(numerator));
        for lane in 0..ROWS as usize {
            // The lower half is the shade twice: a broadcast of 32 bits needs no shuffle.
            let (mut left, shade) = (lengths.0[lane] as usize, shades.0[lane] as i32);
            // SAFETY: a row lies inside the pixels, or begins at the first and has no length.
            let mut row = unsafe { pixels.add(begins.0[lane] as usize) };
            let mut shades = _mm512_set1_epi32(shade);
            if left <= BLOCK / 2 {
                // SAFETY: the mask has a bit for each of the row's pixels, which are at most 32.
                unsafe {
                    _mm256_mask_storeu_epi8(row.cast(), ones(left) as u32, ramp.half(_mm512_castsi512_si256(shades)))
                }
                continue;
            }
            let mut numerator = f64::from_bits(numerators.0[lane]);
            while left > BLOCK {
                // SAFETY: more than 64 bytes are left, so 64 can be written and `row` can advance by 64; the store
                // requires no alignment.
                unsafe {
                    _mm512_storeu_si512(row.cast(), ramp.bytes(shades));
                    row = row.add(BLOCK);
                }
                left -= BLOCK;
                if triangle.reseeds {
                    numerator += per_piece;
                    // The low bits.
                    shades = _mm512_set1_epi16((numerator * triangle.shade[2] + ROUND_MAGIC).to_bits() as i16);
                } else {
                    shades = _mm512_add_epi16(shades, _mm512_slli_epi16::<6>(ramp.steps));
                }
            }
            // SAFETY: the mask has a bit for each of the pixels that are left, which are at most 64.
            unsafe { _mm512_mask_storeu_epi8(row.cast(), ones(left), ramp.bytes(shades)) }
        }
        (long_n, upper_n) = (_mm512_add_pd(long_n, long_8), _mm512_add_pd(upper_n, upper_8));
        (lower_n, shade_n) = (_mm512_add_pd(lower_n, lower_8), _mm512_add_pd(shade_n, shade_8));
        numbers = _mm512_add_epi64(numbers, _mm512_set1_epi64(ROWS.into()));
        at = _mm512_add_epi64(at, _mm512_set1_epi64(pitch * i64::from(ROWS)));
    }
    // At most 2¹⁸ pixels.
    (_mm512_reduce_add_epi64(spans) as u32, _mm512_reduce_add_epi64(covered) as u32)
}

/// 64 pixels from shade 0 on.
#[derive(Clone, Copy)]
struct Ramp64 {
    steps: __m512i,
    even: __m512i,
    odd: __m512i,
    /// Both bytes of a 16-bit lane from its upper one.
    upper: __m512i,
    /// A bit for each even byte, of 64 and of 32.
    even_bytes: __mmask64,
    even_bytes_of_half: __mmask32,
}

impl Ramp64 {
    #[inline]
    #[target_feature(enable = "avx512f,avx512bw,avx512vl")]
    fn new(step: u16) -> Self {
        // SAFETY: 64 bytes; the load requires no alignment.
        let numbers = unsafe { _mm512_loadu_si512(EVEN.as_ptr().cast()) };
        let steps = _mm512_set1_epi16(step.cast_signed());
        let even = _mm512_mullo_epi16(steps, numbers);
        let (upper, signs) = (opaque(&UPPER_BYTES), opaque(&EVEN_BYTES));
        Self {
            steps,
            even,
            odd: _mm512_add_epi16(even, steps),
            upper,
            even_bytes: _mm512_movepi8_mask(signs),
            even_bytes_of_half: _mm256_movepi8_mask(_mm512_castsi512_si256(signs)),
        }
    }

    /// The bytes from these shades on: the upper bytes of even ones below those of odd ones.
    #[inline]
    #[target_feature(enable = "avx512f,avx512bw")]
    fn bytes(self, shades: __m512i) -> __m512i {
        let (even, odd) = (_mm512_add_epi16(shades, self.even), _mm512_add_epi16(shades, self.odd));
        _mm512_mask_shuffle_epi8(odd, self.even_bytes, even, self.upper)
    }

    /// The bytes of 32 pixels, half as many.
    #[inline]
    #[target_feature(enable = "avx512f,avx512bw,avx512vl")]
    fn half(self, shades: __m256i) -> __m256i {
        let even = _mm256_add_epi16(shades, _mm512_castsi512_si256(self.even));
        let odd = _mm256_add_epi16(shades, _mm512_castsi512_si256(self.odd));
        _mm256_mask_shuffle_epi8(odd, self.even_bytes_of_half, even, _mm512_castsi512_si256(self.upper))
    }
}

/// Fills every span of a list where it is nearer. Returns the number of pixels written.
pub(crate) fn fill_spans_nearer(_: Avx512, pixels: &mut [u8], cells: &mut [u32], spans: &SpanList) -> u32 {
    if !spans.are_inside(pixels) || !spans.are_inside_cells(cells) {
        return 0;
    }
    // SAFETY: the token proves that the processor has AVX-512; all spans lie inside the pixels and cells.
    unsafe { each_nearer(pixels.as_mut_ptr(), cells.as_mut_ptr(), spans) }
}

/// # Safety
/// All spans lie inside the pixels and cells.
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,bmi2,popcnt")]
unsafe fn each_nearer(pixels: *mut u8, cells: *mut u32, spans: &SpanList) -> u32 {
    let numbers = _mm512_setr_epi64(0, 1, 2, 3, 4, 5, 6, 7);
    let upper = opaque(&UPPER_HALVES);
    // 1, with the pixel's index in the upper half.
    let numbered = _mm256_setr_epi32(1, 0x1_0001, 0x2_0001, 0x3_0001, 0x4_0001, 0x5_0001, 0x6_0001, 0x7_0001);
    // SAFETY: 16 bytes; the load requires no alignment.
    let even_numbers = unsafe { _mm_loadu_si128(EVEN.as_ptr().cast()) };
    let odd_bytes = _mm_set1_epi16(0xFF00_u16.cast_signed());
    let mut nearer = 0;
    for k in 0..spans.count() {
        let (Span { at, length, paint }, SpanDepth { cell, z, dz }) = (spans.span(k), spans.depth(k));
        // SAFETY: by the caller's promise.
        let (mut row, mut cell) = unsafe { (pixels.add(at as usize), cells.add(cell as usize)) };
        let steps = _mm512_set1_epi64(dz);
        let mut z0 = _mm512_add_epi64(_mm512_mullo_epi64(steps, numbers), _mm512_set1_epi64(z));
        if length <= 8 {
            // Eight cells: with sixteen nearly every access would touch two cache lines instead of one.
            let mask = ones(length as usize) as u8;
            let depths = _mm512_castsi512_si256(_mm512_permutexvar_epi32(upper, z0));
            // shade + j·step, of which bits 8 to 15 count.
            let shades = _mm256_madd_epi16(_mm256_set1_epi32(paint.cast_signed()), numbered);
            // SAFETY: the masks have a bit for each of the span's pixels, which are at most eight.
            unsafe {
                let before = _mm256_maskz_loadu_epi32(mask, cell.cast());
                let mask = _mm256_mask_cmpgt_epu32_mask(mask, depths, before);
                _mm256_mask_storeu_epi32(cell.cast(), mask, depths);
                _mm256_mask_cvtepi32_storeu_epi8(row.cast(), mask, _mm256_srli_epi32::<8>(shades));
                nearer += mask.count_ones();
            }
            continue;
        }
        // The shade in the lower half, the step in the upper.
        let (shade, step) = (paint as u16, (paint >> 16) as u16);
        let mut z1 = _mm512_add_epi64(z0, _mm512_slli_epi64::<3>(steps));
        let step = _mm_set1_epi16(step.cast_signed());
        let mut even = _mm_add_epi16(_mm_mullo_epi16(step, even_numbers), _mm_set1_epi16(shade.cast_signed()));
        let (next_z, next) = (_mm512_slli_epi64::<4>(steps), _mm_slli_epi16::<4>(step));
        let mut left = length as usize;
        loop {
            let mask = ones(left.min(16)) as u16;
            let depths = _mm512_permutex2var_epi32(z0, upper, z1);
            let odd = _mm_add_epi16(even, step);
            let bytes = _mm_ternarylogic_epi32::<0xF8>(_mm_srli_epi16::<8>(even), odd, odd_bytes);
            // SAFETY: the masks have a bit for each of the pixels that are left, up to sixteen.
            unsafe {
                let before = _mm512_maskz_loadu_epi32(mask, cell.cast());
                let mask = _mm512_mask_cmpgt_epu32_mask(mask, depths, before);
                _mm512_mask_storeu_epi32(cell.cast(), mask, depths);
                _mm_mask_storeu_epi8(row.cast(), mask, bytes);
                nearer += mask.count_ones();
            }
            if left <= 16 {
                break;
            }
            left -= 16;
            // SAFETY: more than sixteen pixels were left.
            unsafe { (row, cell) = (row.add(16), cell.add(16)) };
            (z0, z1) = (_mm512_add_epi64(z0, next_z), _mm512_add_epi64(z1, next_z));
            even = _mm_add_epi16(even, next);
        }
    }
    nearer
}

#[cfg(test)]
mod tests {
    use std::vec;

    use super::*;

    /// Rows that do not lie entirely inside the pixels are left out, whatever the triangle.
    #[test]
    fn nothing_outside_the_pixels_is_written() {
        let Some(avx512) = Avx512::find() else {
            std::eprintln!("NOT TRIED: this processor has no AVX-512");
            return;
        };
        let mut state = 1_u64;
        let mut random = |most: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % (most + 1)
        };
        let (mut written, mut left_out) = (0, 0);
        for _ in 0..20_000 {
            let mut edge = |most: u64, slope: u64| {
                let slope = random(2 * slope) as f64 - slope as f64;
                [random(most) as f64, slope, 1.0 / (1 + random(60)) as f64]
            };
            let (long, upper, lower, shade) =
                (edge(9_000, 500), edge(9_000, 500), edge(9_000, 500), edge(1 << 20, 900));
            let triangle = LargeTriangle {
                long,
                upper,
                lower,
                shade,
                per_column: random(2_000) as f64 - 1_000.0,
                at: random(25_000) as i32 - 2_500,
                pitch: random(300) as i32,
                rows: random(200) as i32,
                split: random(200) as i32,
                step: random(0xFFFF) as u16,
                reseeds: random(1) == 0,
            };
            let (before, length) = (random(300) as usize, random(20_000) as usize);
            let mut bytes = vec![7_u8; before + length + 300];
            let (_, covered) = fill_large(avx512, &mut bytes[before..before + length], &triangle);
            assert!(bytes[..before].iter().chain(&bytes[before + length..]).all(|&byte| byte == 7));
            let inside = bytes.iter().filter(|&&byte| byte != 7).count();
            assert!(inside <= covered as usize);
            written += inside;
            left_out += usize::from(inside == 0);
        }
        assert!(written > 1_000_000 && left_out > 100, "{written}, {left_out}");
    }
}
