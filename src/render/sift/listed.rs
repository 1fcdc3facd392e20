//! The numbers of faces that are to be drawn, until there is a batch of them.

use super::MOST;
use crate::raster::Batch;
use crate::raster::batch::indexed::TURNED;
use crate::span::Kernel;

/// Faces that are written beyond the last, and are none.
pub(super) const BEYOND: usize = 16;
/// Less than a batch, and those of one more time.
const CAPACITY: usize = Batch::CAPACITY + MOST + BEYOND;

/// Numbers of faces, with [`TURNED`] of those whose back is seen.
pub(crate) struct Listed {
    pub(super) numbers: [u32; CAPACITY],
    pub(super) count: usize,
}

impl Listed {
    pub(crate) const fn new() -> Self {
        Self { numbers: [0; CAPACITY], count: 0 }
    }

    /// Puts those of 64 faces behind the others whose bits are set, from number `first` on. Only if there is no whole batch.
    #[inline(always)]
    pub(crate) fn add(&mut self, (first, turned): (usize, u64), chosen: u64, kernel: Kernel) {
        debug_assert!(self.count < Batch::CAPACITY);
        // Below `TURNED`, or there is no list.
        let first = first as u32;
        #[cfg(all(feature = "simd", target_arch = "x86_64"))]
        if let Some(avx512) = kernel.avx512() {
            return super::avx512::list(avx512, self, first, chosen, turned);
        }
        let _ = kernel;
        self.add_one_by_one(first, chosen, turned);
    }

    /// The definition.
    fn add_one_by_one(&mut self, first: u32, chosen: u64, turned: u64) {
        let mut left = chosen;
        while left != 0 {
            let at = left.trailing_zeros();
            left &= left - 1;
            let side = if turned >> at & 1 == 1 { TURNED } else { 0 };
            self.numbers[self.count] = (first + at) | side;
            self.count += 1;
        }
    }

    /// A whole batch, if there is one.
    #[inline(always)]
    pub(crate) fn whole(&self) -> Option<&[u32]> {
        if self.count < Batch::CAPACITY { None } else { self.numbers.get(..Batch::CAPACITY) }
    }

    /// Takes a whole batch out.
    pub(crate) fn take_whole(&mut self) {
        let count = self.count.saturating_sub(Batch::CAPACITY);
        // As many as are added at a time, no more.
        self.numbers.copy_within(Batch::CAPACITY..Batch::CAPACITY + MOST, 0);
        self.count = count;
    }

    /// All there are.
    pub(crate) fn all(&self) -> &[u32] {
        &self.numbers[..self.count]
    }

    pub(crate) fn clear(&mut self) {
        self.count = 0;
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Every kernel lists the faces whose bits are set, in order, and they come out as batches and a rest.
        #[test]
        fn faces_are_listed_in_order(
            parts in prop::collection::vec((any::<u64>(), any::<u64>(), any::<u64>(), any::<bool>()), 0..20),
        ) {
            for kernel in Kernel::available() {
                let (mut listed, mut taken, mut expected) = (Listed::new(), Vec::new(), Vec::new());
                for (chunk, &(bits, fewer, turned, all)) in (0_u32..).zip(&parts) {
                    let chosen = if all { !0 } else { bits & fewer };
                    let first = chunk * 64;
                    listed.add((first as usize, turned), chosen, kernel);
                    let is = |bits: u64, at: u32| bits >> at & 1 == 1;
                    let number = |at: u32| (first + at) | if is(turned, at) { TURNED } else { 0 };
                    expected.extend((0..64).filter(|&at| is(chosen, at)).map(number));
                    if let Some(whole) = listed.whole() {
                        prop_assert_eq!(whole.len(), Batch::CAPACITY);
                        taken.extend_from_slice(whole);
                        listed.take_whole();
                    }
                    prop_assert!(listed.whole().is_none());
                }
                taken.extend_from_slice(listed.all());
                prop_assert_eq!(&taken, &expected);
            }
        }
    }
}
