//! A number that shows whether the frame's memory was accessed.

#[cfg(target_has_atomic = "ptr")]
use core::sync::atomic::{AtomicUsize, Ordering};

/// The number of stamps that a machine reserves at once: one atomic addition per this many accesses.
const BLOCK: u64 = 1 << 20;

/// The number of blocks given out so far. Block 0 is for memory that was never touched, which is the same everywhere.
#[cfg(target_has_atomic = "ptr")]
static BLOCKS: AtomicUsize = AtomicUsize::new(1);

/// A stamp. Equal stamps mean equal memory, even between two machines; otherwise a renderer that drew into one could
/// mistake the other's frame for its own, untouched. (On a processor without atomic additions the stamps of two
/// machines can coincide; there a stamp is only valid for one machine.)
#[derive(Debug)]
pub(super) struct Stamp {
    pub(super) value: u64,
    /// The last stamp of the block reserved for this machine.
    last: u64,
}

impl Stamp {
    pub(super) const fn new() -> Self {
        Self { value: 0, last: 0 }
    }

    #[inline]
    pub(super) fn renew(&mut self) {
        if self.value == self.last {
            self.value = next_block(self.last);
            self.last = self.value + (BLOCK - 1);
        } else {
            self.value += 1;
        }
    }
}

impl Clone for Stamp {
    /// The stamp of a copy is equal, because its memory is; its next one comes from a block of its
    /// own.
    fn clone(&self) -> Self {
        Self { value: self.value, last: self.value }
    }
}

#[cfg(target_has_atomic = "ptr")]
#[cold]
fn next_block(_last: u64) -> u64 {
    // Wraps after 2⁴⁴ blocks, or 2³² where pointers have 32 bits. A card takes one for every 2²⁰ accesses, and each clone
    // its own.
    (BLOCKS.fetch_add(1, Ordering::Relaxed) as u64).wrapping_mul(BLOCK)
}

#[cfg(not(target_has_atomic = "ptr"))]
#[cold]
fn next_block(last: u64) -> u64 {
    (last / BLOCK).wrapping_add(1).wrapping_mul(BLOCK)
}
