//! The numbers of faces that are to be drawn, until there is a batch of them.

use super::{CHUNK, LANES};
use crate::raster::Batch;
use crate::raster::batch::indexed::BACK_FACE;
use crate::simd::{Lanes8, Packed, compiled_for_each_level};
use crate::span::Kernel;

/// Less than a batch, those of one more time, and one vector.
type Numbers = Packed<{ Batch::CAPACITY + CHUNK + LANES }>;

/// Numbers of faces, with [`BACK_FACE`] of those whose back is seen.
pub(crate) struct FaceQueue(Numbers);

impl FaceQueue {
    pub(crate) const fn new() -> Self {
        Self(Packed::new())
    }

    /// Puts those of 64 faces behind the others whose bits are set, from number `first` on. Only if there is no whole batch.
    #[inline(always)]
    pub(crate) fn add(&mut self, (first, turned): (usize, u64), chosen: u64, kernel: Kernel) {
        debug_assert!(self.all().len() < Batch::CAPACITY);
        // Below `BACK_FACE`, or there is no list.
        add(kernel.simd_level(), &mut self.0, first as u32, turned, chosen);
    }

    /// A whole batch, if there is one.
    #[inline(always)]
    pub(crate) fn whole(&self) -> Option<&[u32]> {
        self.all().get(..Batch::CAPACITY)
    }

    /// Takes a whole batch out.
    pub(crate) fn take_whole(&mut self) {
        self.0.remove_first(Batch::CAPACITY);
    }

    /// All there are.
    pub(crate) fn all(&self) -> &[u32] {
        self.0.as_slice()
    }

    pub(crate) fn clear(&mut self) {
        self.0 = Packed::new();
    }
}

compiled_for_each_level! {
    fn add[][](numbers: &mut Numbers, first: u32, turned: u64, chosen: u64) = add_by;
}

#[inline(always)]
fn add_by<S: Lanes8>(s: S, numbers: &mut Numbers, first: u32, turned: u64, chosen: u64) {
    for part in 0..8 {
        // The low bytes.
        let (chosen, turned) = ((chosen >> (8 * part)) as u8, (turned >> (8 * part)) as u8);
        if chosen == 0 {
            continue;
        }
        let number = s.all_i32((first + LANES as u32 * part).cast_signed());
        let number = s.add_i32(number, s.i32s(&[0, 1, 2, 3, 4, 5, 6, 7]));
        let side = s.select_i32(s.mask_of_bits(turned), s.all_i32(BACK_FACE.cast_signed()), s.all_i32(0));
        numbers.append(s, s.mask_of_bits(chosen), s.or_i32(number, side));
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
                let (mut queue, mut taken, mut expected) = (FaceQueue::new(), Vec::new(), Vec::new());
                for (chunk, &(bits, fewer, turned, all)) in (0_u32..).zip(&parts) {
                    let chosen = if all { !0 } else { bits & fewer };
                    let first = chunk * 64;
                    queue.add((first as usize, turned), chosen, kernel);
                    let is = |bits: u64, at: u32| bits >> at & 1 == 1;
                    let number = |at: u32| (first + at) | if is(turned, at) { BACK_FACE } else { 0 };
                    expected.extend((0..64).filter(|&at| is(chosen, at)).map(number));
                    if let Some(whole) = queue.whole() {
                        prop_assert_eq!(whole.len(), Batch::CAPACITY);
                        taken.extend_from_slice(whole);
                        queue.take_whole();
                    }
                    prop_assert!(queue.whole().is_none());
                }
                taken.extend_from_slice(queue.all());
                prop_assert_eq!(&taken, &expected);
            }
        }
    }
}
