//! Sizes at random, small ones as likely as large ones.

use crate::random::Random;

/// 1 to 2^`bits` − 1: each power of two as likely as any other, and from there to the next all alike.
pub(crate) fn log_uniform(random: &mut Random, bits: u32) -> usize {
    let bit = random.next_u64() % u64::from(bits);
    (1 << bit) + (random.next_u64() & ((1 << bit) - 1)) as usize
}
