//! Random numbers that are the same on every machine.
//!
//! With the feature `std` the seed of a run can be set: `MODE13H_SEED=123 cargo test`.

use crate::hash::{START, fnv_1a};

/// SplitMix64 (Steele, Lea, Flood 2014): one addition and a mix; every seed is as good as any other.
#[derive(Clone, Debug)]
pub struct Random(u64);

/// The default seed.
pub const SEED: u64 = 13;

/// The seed of this run: `MODE13H_SEED`, or [`SEED`].
///
/// # Panics
/// If `MODE13H_SEED` is not a number.
#[must_use]
pub fn seed() -> u64 {
    #[cfg(feature = "std")]
    if let Ok(text) = std::env::var("MODE13H_SEED") {
        return text.parse().expect("MODE13H_SEED is a number");
    }
    SEED
}

impl Random {
    /// A generator seeded from this run's seed, which is printed. Different streams give independent numbers.
    #[must_use]
    pub fn new(stream: u64) -> Self {
        let seed = seed();
        #[cfg(feature = "std")]
        std::println!("MODE13H_SEED={seed}, stream {stream}");
        Self::of_stream(seed, stream)
    }

    /// A generator seeded from this run's seed, for a named stream.
    #[must_use]
    pub fn named(stream: &str) -> Self {
        Self::new(fnv_1a(START, stream.as_bytes()))
    }

    /// A generator for a named stream with the given seed: [`named`](Self::named) for programs, which print no seed.
    #[must_use]
    pub fn seeded(seed: u64, stream: &str) -> Self {
        Self::of_stream(seed, fnv_1a(START, stream.as_bytes()))
    }

    fn of_stream(seed: u64, stream: u64) -> Self {
        Self(Self(seed).next_u64() ^ stream.wrapping_mul(0xD134_2543_DE82_EF95))
    }

    /// A generator with the given state, independent of this run's seed.
    #[must_use]
    pub fn again(state: u64) -> Self {
        Self(state)
    }

    /// The next 64 bits.
    pub fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A number from 1 to 2^`bits` − 1: each power of two is equally likely, and so are the numbers between two of
    /// them.
    pub fn log_uniform(&mut self, bits: u32) -> usize {
        let bit = self.next_u64() % u64::from(bits);
        (1 << bit) + (self.next_u64() & ((1 << bit) - 1)) as usize
    }

    /// A uniform number from `low` to `high`, both included.
    pub fn within(&mut self, low: i64, high: i64) -> i64 {
        let span = (i128::from(high) - i128::from(low) + 1).max(1) as u128;
        low + ((u128::from(self.next_u64()) * span) >> 64) as i64
    }

    /// A uniform number from 0 to `end` − 1; 0 if `end` is 0.
    pub fn below(&mut self, end: usize) -> usize {
        self.within(0, end as i64 - 1) as usize
    }

    /// A uniform number from 0 up to, but not including, 1.
    pub fn unit(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A uniform number from −`most` to `most`.
    pub fn around_zero(&mut self, most: f64) -> f64 {
        (self.unit() * 2.0 - 1.0) * most
    }

    /// Shuffles a list (Fisher and Yates).
    pub fn shuffle<T>(&mut self, list: &mut [T]) {
        for last in (1..list.len()).rev() {
            list.swap(last, self.below(last + 1));
        }
    }

    /// A random element of `of`, which must not be empty.
    pub fn one_of<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }
}
