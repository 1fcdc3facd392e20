//! Lists of numbers that are put in eight at a time, under a mask.
#![expect(unsafe_code, reason = "an array that is written before it is read")]

use core::mem::MaybeUninit;

use super::Lanes8;

/// Up to `N` − 8 numbers, one after the other.
pub(crate) struct Packed<const N: usize> {
    /// The first `count` have been written.
    numbers: [MaybeUninit<u32>; N],
    count: usize,
}

impl<const N: usize> Packed<N> {
    /// Those behind the last are written over.
    const CAPACITY: usize = N - 8;

    #[inline(always)]
    pub(crate) const fn new() -> Self {
        Self { numbers: [const { MaybeUninit::uninit() }; N], count: 0 }
    }

    /// Puts those of eight numbers whose mask is set behind the others. Those for which there is no room are left out.
    #[inline(always)]
    pub(crate) fn append<S: Lanes8>(&mut self, s: S, mask: S::Mask, numbers: S::I32) {
        let count = self.count.min(Self::CAPACITY);
        if let Some(eight) = self.numbers[count..].first_chunk_mut() {
            s.compact_i32(mask, [numbers], [eight]);
            self.count = (count + s.mask_bits(mask).count_ones() as usize).min(Self::CAPACITY);
        }
    }

    /// Takes the first so many out.
    #[cfg(feature = "alloc")]
    pub(crate) fn remove_first(&mut self, count: usize) {
        let count = count.min(self.count);
        self.numbers.copy_within(count..self.count, 0);
        self.count -= count;
    }

    #[inline(always)]
    pub(crate) fn as_slice(&self) -> &[u32] {
        let numbers = &self.numbers[..self.count];
        // SAFETY: the first `count` have been written; `MaybeUninit<u32>` has the layout of `u32`.
        unsafe { &*(&raw const *numbers as *const [u32]) }
    }
}
