//! The random cases: the same seed makes the same cases on every machine.

/// SplitMix64 (Steele, Lea, Flood 2014).
#[derive(Clone, Debug)]
pub(in super::super) struct Random(u64);

impl Random {
    /// `stream` keeps the groups apart: with the same seed each has its own numbers.
    pub(in super::super) fn new(seed: u64, stream: &str) -> Self {
        Self(seed ^ super::fingerprint::fnv_1a(super::fingerprint::START, stream.as_bytes()))
    }

    pub(in super::super) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// low ≤ n ≤ high, all alike; `low` where the two have changed places.
    pub(in super::super) fn within(&mut self, low: i64, high: i64) -> i64 {
        let count = i128::from(high) - i128::from(low) + 1;
        // Below `count`, so the sum is within i64.
        low + ((i128::from(self.next()) * count.max(1)) >> 64) as i64
    }

    /// 0 ≤ n < `end`, all alike, for the numbers of a frame; 0 if `end` is 0.
    pub(in super::super) fn below(&mut self, end: u32) -> u32 {
        self.within(0, i64::from(end) - 1) as u32
    }

    /// 1 to 2^`bits` − 1 (`bits` at most 63), each power of two as likely as any other.
    pub(in super::super) fn log_uniform(&mut self, bits: u32) -> i64 {
        let bit = self.below(bits);
        (1 << bit) + self.within(0, (1 << bit) - 1)
    }

    /// 0 ≤ x < 1, all alike.
    pub(in super::super) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// −`most` to `most`.
    pub(in super::super) fn around_zero(&mut self, most: f64) -> f64 {
        (self.unit() * 2.0 - 1.0) * most
    }

    /// One of them; `of` must not be empty.
    pub(in super::super) fn one_of<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len() as u32) as usize]
    }
}
