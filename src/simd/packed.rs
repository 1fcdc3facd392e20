//! Lists of numbers that are appended eight at a time, under a mask.

use super::Lanes8;

/// Up to `N` − 8 contiguous numbers.
#[derive(Debug)]
pub(crate) struct Packed<const N: usize> {
    numbers: [u32; N],
    count: usize,
}

impl<const N: usize> Default for Packed<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> Packed<N> {
    /// The last eight elements only make room for whole stores.
    const CAPACITY: usize = N - 8;

    #[inline(always)]
    pub(crate) const fn new() -> Self {
        Self { numbers: [0; N], count: 0 }
    }

    /// Appends the lanes that the mask selects. Numbers that do not fit are dropped.
    #[inline(always)]
    pub(crate) fn append<S: Lanes8>(&mut self, s: S, mask: S::Mask, numbers: S::I32) {
        let count = self.count.min(Self::CAPACITY);
        if let Some(eight) = self.numbers[count..].first_chunk_mut() {
            s.compress_i32(mask, [numbers], [eight]);
            self.count = (count + s.to_bitmask(mask).count_ones() as usize).min(Self::CAPACITY);
        }
    }

    /// Appends a number, if there is room.
    #[cfg(feature = "alloc")]
    #[inline(always)]
    pub(crate) fn push(&mut self, number: u32) {
        debug_assert!(self.count < Self::CAPACITY, "there is room");
        if self.count < Self::CAPACITY {
            self.numbers[self.count] = number;
            self.count += 1;
        }
    }

    /// Removes all numbers.
    #[cfg(feature = "alloc")]
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.count = 0;
    }

    #[inline(always)]
    pub(crate) fn as_slice(&self) -> &[u32] {
        &self.numbers[..self.count]
    }

    #[inline(always)]
    pub(crate) fn as_mut_slice(&mut self) -> &mut [u32] {
        &mut self.numbers[..self.count]
    }
}
