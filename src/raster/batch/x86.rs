//! The stages of a batch, compiled for AVX2: four f64 at a time where SSE2 has two, and minima of integers.

use super::Batch;
use super::rows::{Place, Spans, rows_inlined};
use super::sieve::{Kept, Kind, sieve_inlined};
use crate::raster::frame::Rect;

/// Only with a kernel for which `Kernel::has_avx2` is true.
pub(super) fn sieve(batch: &Batch, clip: Rect, kept: &mut Kept) {
    #[target_feature(enable = "avx2")]
    fn avx2(batch: &Batch, clip: Rect, kept: &mut Kept) {
        sieve_inlined(batch, clip, kept);
    }
    // SAFETY: such a kernel is given out only where AVX2 was found.
    unsafe { avx2(batch, clip, kept) }
}

/// Only with a kernel for which `Kernel::has_avx2` is true.
pub(super) fn rows(batch: &Batch, kept: &[(u8, Kind)], place: Place, spans: &mut Spans) -> usize {
    #[target_feature(enable = "avx2")]
    fn avx2(batch: &Batch, kept: &[(u8, Kind)], place: Place, spans: &mut Spans) -> usize {
        rows_inlined(batch, kept, place, spans)
    }
    // SAFETY: such a kernel is given out only where AVX2 was found.
    unsafe { avx2(batch, kept, place, spans) }
}
