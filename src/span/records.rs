//! Records of listed spans: what a shade and its step cannot say.

use super::PIECE;
use crate::lanes::LANES;

/// The records in use, of spans that are filled with more than a linear shade. The list has the index of a span's
/// record.
///
/// Eight rows are recorded together, whether or not they have pixels, so that only the index has to be compressed and
/// sorted by triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Records {
    /// Number of records in use, a multiple of eight.
    count: usize,
}

const _: () = assert!(Records::CAPACITY == 256, "an index takes eight bits of a span's fill");

impl Records {
    /// Number of records that there can be: those of 64 triangles of up to four rows.
    const CAPACITY: usize = 256;
    pub(crate) const NONE: Self = Self { count: 0 };

    /// Returns whether there is room for `rows` times eight rows.
    #[inline(always)]
    pub(crate) fn have_room(&self, rows: usize) -> bool {
        self.count + rows * LANES <= Self::CAPACITY
    }

    /// Begins eight records. Returns the index of the first.
    #[inline(always)]
    pub(crate) fn begin(&mut self) -> usize {
        let first = self.count;
        self.count += LANES;
        first
    }
}

/// Columns of the records of spans: `N` numbers each.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct RecordColumns<T, const N: usize>([[T; Records::CAPACITY]; N]);

impl<T: Copy + Default, const N: usize> RecordColumns<T, N> {
    pub(crate) fn new() -> Self {
        Self([[T::default(); Records::CAPACITY]; N])
    }

    /// Number `i` of eight records, from a multiple of eight on.
    #[inline(always)]
    pub(crate) fn eight(&mut self, first: usize, i: usize) -> &mut [T; LANES] {
        &mut self.0[i].as_chunks_mut().0[first / LANES % (Records::CAPACITY / LANES)]
    }

    /// Number `i` of a record.
    #[inline(always)]
    pub(crate) fn of(&self, record: usize, i: usize) -> T {
        self.0[i % N][record % Records::CAPACITY]
    }

    #[cfg(feature = "alloc")]
    pub(crate) fn set(&mut self, record: usize, numbers: [T; N]) {
        for (to, number) in self.0.iter_mut().zip(numbers) {
            to[record % Records::CAPACITY] = number;
        }
    }
}

/// Bytes of some spans of a list, 64 each.
#[derive(Debug)]
pub(crate) struct SpanBytes([[u8; PIECE]; SpanBytes::COUNT]);

impl SpanBytes {
    /// The number of spans at a time.
    pub(crate) const COUNT: usize = 16;

    pub(crate) const NONE: Self = Self([[0; PIECE]; Self::COUNT]);

    /// The bytes of span `k` among these.
    #[inline(always)]
    pub(crate) fn of(&self, k: usize) -> &[u8; PIECE] {
        &self.0[k % Self::COUNT]
    }

    #[inline(always)]
    pub(crate) fn of_mut(&mut self, k: usize) -> &mut [u8; PIECE] {
        &mut self.0[k % Self::COUNT]
    }
}
