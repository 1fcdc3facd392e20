//! Many pixels at once: lane `k` starts at `shade + k·step`, which is exact because wrapping is.
//!
//! The vector kernels keep the *even* pixels of a block in one vector of 16-bit shades and the *odd*
//! ones in another:
//!
//! ```text
//! even[j] = shade + 2·j·step        odd[j] = even[j] + step
//! bytes   = even >> 8 | odd & 0xFF00               (little-endian: byte 2j, byte 2j + 1)
//! ```
//!
//! so that no lane has to be packed or carried across the register. Both advance by a block's worth of steps.
//!
//! The levels that a processor may have, and lanes for all other code, are in `crate::simd`.

#[cfg(simd_x86_64)]
pub(super) mod sse2 {
    use super::super::list::SpanList;
    use super::super::thresholds::ThresholdRow;
    use core::arch::x86_64::*;

    /// Even and odd shades of a block of 16 pixels.
    #[derive(Clone, Copy)]
    pub(super) struct Block {
        even: __m128i,
        odd: __m128i,
    }

    impl Block {
        /// The block whose first pixel has `shade`.
        #[inline]
        #[target_feature(enable = "sse2")]
        pub(super) fn new(shade: u16, step: u16) -> Self {
            let steps = _mm_set1_epi16(step as i16); // the same bits
            let ramp = _mm_mullo_epi16(steps, _mm_setr_epi16(0, 2, 4, 6, 8, 10, 12, 14));
            let even = _mm_add_epi16(ramp, _mm_set1_epi16(shade as i16));
            Self { even, odd: _mm_add_epi16(even, steps) }
        }

        /// The block with all shades raised by `by`.
        #[inline]
        #[target_feature(enable = "sse2")]
        pub(super) fn raised(self, by: __m128i) -> Self {
            Self { even: _mm_add_epi16(self.even, by), odd: _mm_add_epi16(self.odd, by) }
        }

        #[inline]
        #[target_feature(enable = "sse2")]
        pub(super) fn bytes(self) -> __m128i {
            let odd_bytes = _mm_set1_epi16(0xFF00_u16 as i16);
            _mm_or_si128(_mm_srli_epi16(self.even, 8), _mm_and_si128(self.odd, odd_bytes))
        }

        #[inline]
        #[target_feature(enable = "sse2")]
        pub(super) fn store(self, to: &mut [u8; 16]) {
            // SAFETY: `to` is 16 writable bytes; the store requires no alignment.
            unsafe { _mm_storeu_si128(to.as_mut_ptr().cast(), self.bytes()) }
        }

        #[inline]
        #[target_feature(enable = "sse2")]
        pub(super) fn words(self) -> [u64; 2] {
            let bytes = self.bytes();
            let high = _mm_unpackhi_epi64(bytes, bytes);
            [_mm_cvtsi128_si64(bytes) as u64, _mm_cvtsi128_si64(high) as u64]
        }

        /// The block with a threshold added to each shade.
        #[inline]
        #[target_feature(enable = "sse2")]
        fn dithered(self, thresholds: [u8; 16]) -> Self {
            // SAFETY: `thresholds` is 16 readable bytes; the load requires no alignment.
            let pairs = unsafe { _mm_loadu_si128(thresholds.as_ptr().cast()) };
            // In lanes of 16 bits the lower byte is an even pixel's, the upper an odd one's.
            let even = _mm_and_si128(pairs, _mm_set1_epi16(0xFF));
            Self { even: _mm_add_epi16(self.even, even), odd: _mm_add_epi16(self.odd, _mm_srli_epi16(pairs, 8)) }
        }
    }

    /// Runs on any processor, since every x86-64 has SSE2.
    pub(crate) fn fill(row: &mut [u8], shade: u16, step: u16) {
        // SAFETY: x86-64 includes SSE2.
        unsafe { vectors(row, shade, step) }
    }

    /// Fills the first `length` pixels of sixteen, and rewrites the others unchanged.
    #[inline(always)]
    pub(crate) fn fill_first(length: usize, row: &mut [u8; 16], shade: u16, step: u16) {
        static STAYS: [[u8; 16]; 2] = [[0; 16], [u8::MAX; 16]];
        // SAFETY: x86-64 includes SSE2. The mask is sixteen of 32 bytes, from byte 16 or an earlier one on; the others
        // are sixteen bytes. No load or store requires alignment.
        unsafe {
            let stays = _mm_loadu_si128(STAYS.as_ptr().cast::<u8>().add(16 - length.min(16)).cast());
            let before = _mm_and_si128(stays, _mm_loadu_si128(row.as_ptr().cast()));
            let bytes = _mm_andnot_si128(stays, Block::new(shade, step).bytes());
            _mm_storeu_si128(row.as_mut_ptr().cast(), _mm_or_si128(before, bytes));
        }
    }

    /// Fills every span of a list.
    pub(crate) fn fill_spans(pixels: &mut [u8], spans: &SpanList) {
        // SAFETY: x86-64 includes SSE2.
        spans.each(pixels, |row, shade, step| unsafe { vectors(row, shade, step) });
    }

    /// Stores the first `N` bytes of a row at least that long.
    #[inline(always)]
    fn put_first<const N: usize>(row: &mut [u8], bytes: [u8; N]) {
        if let Some(to) = row.first_chunk_mut() {
            *to = bytes;
        }
    }

    /// Stores the last `N` bytes of a row at least that long.
    #[inline(always)]
    fn put_last<const N: usize>(row: &mut [u8], bytes: [u8; N]) {
        if let Some(to) = row.last_chunk_mut() {
            *to = bytes;
        }
    }

    /// Rows of less than 16 pixels, each with overlapping stores instead of a loop for the rest.
    #[inline]
    #[target_feature(enable = "sse2")]
    pub(super) fn short(row: &mut [u8], shade: u16, step: u16) {
        let n = row.len();
        if n >= 8 {
            let [low, high] = Block::new(shade, step).words();
            // The last 8 begin at byte n − 8. (`high` goes up 64 − down bits, in two steps as down may be 0.)
            let down = 8 * (n as u32 - 8);
            let last = (low >> down) | ((high << 1) << (63 - down));
            put_last(row, last.to_le_bytes());
            put_first(row, low.to_le_bytes());
        } else if n >= 4 {
            let [low, _] = Block::new(shade, step).words();
            let last = (low >> (8 * (n as u32 - 4))) as u32; // its low half
            put_last(row, last.to_le_bytes());
            put_first(row, (low as u32).to_le_bytes());
        } else if n > 0 {
            // One to three pixels: the first, the middle and the last are all of them.
            let pixel = |k: usize| (shade.wrapping_add(step.wrapping_mul(k as u16)) >> 8) as u8; // k < 4
            row[n / 2] = pixel(n / 2);
            row[n - 1] = pixel(n - 1);
            row[0] = pixel(0);
        }
    }

    #[target_feature(enable = "sse2")]
    fn vectors(row: &mut [u8], shade: u16, step: u16) {
        let n = row.len();
        if n < 16 {
            return short(row, shade, step);
        }
        let first = Block::new(shade, step);
        // The last 16 pixels, whatever the length: the first of them is pixel n − 16. (mod 65,536, like the shade)
        let to_last = step.wrapping_mul((n - 16) as u16);
        let last = first.raised(_mm_set1_epi16(to_last as i16));
        let by = _mm_set1_epi16(step.wrapping_mul(16) as i16);
        let mut block = first;
        let (blocks, _) = row.as_chunks_mut::<16>();
        for to in blocks {
            block.store(to);
            block = block.raised(by);
        }
        if let Some(to) = row.last_chunk_mut::<16>() {
            last.store(to);
        }
    }

    /// The span with dither, for any processor: see [`dither`](super::super::dither).
    ///
    /// Rows must have at least 16 pixels.
    pub(crate) fn fill_dithered(row: &mut [u8], shade: u16, step: u16, thresholds: &ThresholdRow, x: usize) {
        // SAFETY: x86-64 includes SSE2.
        unsafe { dithered(row, shade, step, thresholds, x) }
    }

    #[target_feature(enable = "sse2")]
    fn dithered(row: &mut [u8], shade: u16, step: u16, thresholds: &ThresholdRow, x: usize) {
        let n = row.len();
        // The last 16, as in `vectors`.
        let to_last = step.wrapping_mul((n - 16) as u16);
        let last = Block::new(shade.wrapping_add(to_last), step).dithered(thresholds.next(x.wrapping_add(n - 16)));
        let by = _mm_set1_epi16(step.wrapping_mul(16) as i16);
        let mut block = Block::new(shade, step);
        let mut column = x;
        let (blocks, _) = row.as_chunks_mut::<16>();
        for to in blocks {
            block.dithered(thresholds.next(column)).store(to);
            block = block.raised(by);
            column = column.wrapping_add(16);
        }
        if let Some(to) = row.last_chunk_mut::<16>() {
            last.store(to);
        }
    }
}

mod wide128;
pub(super) use wide128::arrays;
#[cfg(simd_neon)]
pub(super) use wide128::neon;
#[cfg(simd_wasm)]
pub(super) use wide128::wasm;

#[cfg(simd_x86_64)]
pub(crate) mod nearer;

#[cfg(simd_x86_64)]
pub(crate) mod avx2 {
    use super::super::list::{Span, SpanList};
    use super::sse2;
    use crate::simd::Avx2;
    use core::arch::x86_64::*;

    /// Fills a row as [`Kernel::fill`](super::super::Kernel::fill) says.
    #[inline]
    pub(crate) fn fill(_: Avx2, row: &mut [u8], shade: u16, step: u16) {
        // SAFETY: the token proves that the processor has AVX2.
        unsafe { vectors(row, shade, step) }
    }

    /// Fills every span of a list.
    pub(crate) fn fill_spans(_: Avx2, pixels: &mut [u8], spans: &SpanList) {
        #[target_feature(enable = "avx2")]
        fn each(pixels: &mut [u8], spans: &SpanList) {
            for k in 0..spans.count() {
                span(pixels, spans, k);
            }
        }
        // SAFETY: the token proves that the processor has AVX2.
        unsafe { each(pixels, spans) }
    }

    /// Fills span `k` of a list. Bytes after a span of up to 32 pixels, of whichever row, are rewritten unchanged. A span
    /// that reaches beyond `pixels` is not drawn.
    #[inline]
    #[target_feature(enable = "avx2")]
    fn span(pixels: &mut [u8], spans: &SpanList, k: usize) {
        static MASK: [[u8; 32]; 2] = [[0; 32], [u8::MAX; 32]];
        let Span { at, length, .. } = spans.span(k);
        // No overflow: both are below 2³², and usize has 64 bits.
        let (at, n) = (at as usize, length as usize);
        // The mask of the bytes that stay, 32 or the first of these: it starts at byte 32 or an earlier one.
        let stays = MASK.as_ptr().cast::<u8>().wrapping_add(32_usize.wrapping_sub(n));
        if n <= 8
            && let Some(row) = pixels.get_mut(at..at + 8)
        {
            // shade + k·step, of which bits 8 to 15 count. Read after the check, so that it is broadcast from memory.
            let fill = _mm256_set1_epi32(spans.span(k).fill.cast_signed());
            let numbered = _mm256_setr_epi32(1, 0x1_0001, 0x2_0001, 0x3_0001, 0x4_0001, 0x5_0001, 0x6_0001, 0x7_0001);
            let shades = _mm256_srli_epi32(_mm256_madd_epi16(fill, numbered), 8);
            let fours = _mm256_shuffle_epi8(shades, _mm256_set1_epi32(0x0C08_0400));
            let bytes = _mm_unpacklo_epi32(_mm256_castsi256_si128(fours), _mm256_extracti128_si256(fours, 1));
            // SAFETY: eight of 64 bytes, and the eight of the row. No load or store requires alignment.
            unsafe {
                let (stays, before) = (_mm_loadl_epi64(stays.cast()), _mm_loadl_epi64(row.as_ptr().cast()));
                _mm_storel_epi64(row.as_mut_ptr().cast(), _mm_blendv_epi8(bytes, before, stays));
            }
            return;
        }
        if n <= 16
            && let Some(row) = pixels.get_mut(at..at + 16)
        {
            let [shade, step] = halves(spans.fill(k));
            let bytes = sse2::Block::new(shade, step).bytes();
            // SAFETY: sixteen of 64 bytes, and the sixteen of the row. No load or store requires alignment.
            unsafe {
                let (stays, before) = (_mm_loadu_si128(stays.cast()), _mm_loadu_si128(row.as_ptr().cast()));
                _mm_storeu_si128(row.as_mut_ptr().cast(), _mm_blendv_epi8(bytes, before, stays));
            }
            return;
        }
        if n <= 32
            && let Some(row) = pixels.get_mut(at..at + 32)
        {
            let [shade, step] = halves(spans.fill(k));
            let bytes = Block::new(shade, step).bytes();
            // SAFETY: 32 of 64 bytes, and the 32 of the row. No load or store requires alignment.
            unsafe {
                let (stays, before) = (_mm256_loadu_si256(stays.cast()), _mm256_loadu_si256(row.as_ptr().cast()));
                _mm256_storeu_si256(row.as_mut_ptr().cast(), _mm256_blendv_epi8(bytes, before, stays));
            }
            return;
        }
        if n > 32
            && let Some(row) = pixels.get_mut(at..at + n)
        {
            let [shade, step] = halves(spans.fill(k));
            return blocks(row, shade, step);
        }
        if let Some(row) = pixels.get_mut(at..at + n) {
            let [shade, step] = halves(spans.fill(k));
            vectors(row, shade, step);
        }
    }

    /// The lower half of a number and the upper, read one by one, so that a vector of either is broadcast from memory.
    #[inline(always)]
    fn halves(number: &u32) -> [u16; 2] {
        // SAFETY: four readable bytes, of which x86 stores the lower half first; two numbers of 16 bits require no more
        // alignment than one of 32.
        unsafe {
            let lower = core::ptr::from_ref(number).cast::<u16>();
            [*lower, *lower.add(1)]
        }
    }

    /// Even and odd shades of a block of 32 pixels.
    #[derive(Clone, Copy)]
    struct Block {
        even: __m256i,
        odd: __m256i,
    }

    impl Block {
        /// The block whose first pixel has `shade`.
        #[inline]
        #[target_feature(enable = "avx2")]
        fn new(shade: u16, step: u16) -> Self {
            Self::at(0, shade, step)
        }

        /// The block whose first pixel is pixel `n` of a row, modulo 65,536, whose first has `shade`.
        #[inline]
        #[target_feature(enable = "avx2")]
        fn at(n: u16, shade: u16, step: u16) -> Self {
            let steps = _mm256_set1_epi16(step as i16);
            let lanes = _mm256_setr_epi16(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
            let lanes = _mm256_add_epi16(lanes, _mm256_set1_epi16(n as i16));
            let even = _mm256_add_epi16(_mm256_mullo_epi16(steps, lanes), _mm256_set1_epi16(shade as i16));
            Self { even, odd: _mm256_add_epi16(even, steps) }
        }

        #[inline]
        #[target_feature(enable = "avx2")]
        fn raised(self, by: __m256i) -> Self {
            Self { even: _mm256_add_epi16(self.even, by), odd: _mm256_add_epi16(self.odd, by) }
        }

        #[inline]
        #[target_feature(enable = "avx2")]
        fn bytes(self) -> __m256i {
            let odd_bytes = _mm256_set1_epi16(0xFF00_u16 as i16);
            _mm256_or_si256(_mm256_srli_epi16(self.even, 8), _mm256_and_si256(self.odd, odd_bytes))
        }

        #[inline]
        #[target_feature(enable = "avx2")]
        fn store(self, to: &mut [u8; 32]) {
            // SAFETY: `to` is 32 writable bytes; the store requires no alignment.
            unsafe { _mm256_storeu_si256(to.as_mut_ptr().cast(), self.bytes()) }
        }
    }

    #[target_feature(enable = "avx2")]
    fn vectors(row: &mut [u8], shade: u16, step: u16) {
        let n = row.len();
        if n < 16 {
            return sse2::short(row, shade, step);
        }
        if n > 32 {
            return blocks(row, shade, step);
        }
        let first = sse2::Block::new(shade, step);
        let to_last = step.wrapping_mul((n - 16) as u16);
        let last = first.raised(_mm_set1_epi16(to_last as i16));
        if let Some(to) = row.first_chunk_mut::<16>() {
            first.store(to);
        }
        if let Some(to) = row.last_chunk_mut::<16>() {
            last.store(to);
        }
    }

    /// Rows of more than 32 pixels.
    #[inline]
    #[target_feature(enable = "avx2")]
    fn blocks(row: &mut [u8], shade: u16, step: u16) {
        let n = row.len();
        let first = Block::new(shade, step);
        let last = Block::at(n.wrapping_sub(32) as u16, shade, step); // modulo 65,536, like the shades
        if let Some((to, rest)) = row.split_first_chunk_mut::<32>() {
            first.store(to);
            if n > 64 {
                let by = _mm256_set1_epi16(step.wrapping_mul(32) as i16);
                let (blocks, _) = rest.as_chunks_mut::<32>();
                let mut block = first;
                for to in blocks {
                    block = block.raised(by);
                    block.store(to);
                }
            }
            // SAFETY: the row has at least 32 bytes, and these are its last; the store requires no alignment.
            unsafe { _mm256_storeu_si256(row.as_mut_ptr().add(n - 32).cast(), last.bytes()) }
        }
    }
}

#[cfg(simd_x86_64)]
pub(crate) mod avx512;
