//! Random numbers for the tests: SplitMix64 (Steele, Lea, Flood 2014), the same on every machine,
//! from a seed that is printed and can be set.

pub struct Random(u64);

impl Random {
    /// Seeded from `MODE13H_SEED` where that is set, else from 0x13; prints the seed, which the test
    /// harness shows when the test fails.
    pub fn seeded(what: &str) -> Self {
        let seed = std::env::var("MODE13H_SEED").ok().and_then(|seed| seed.parse().ok()).unwrap_or(0x13);
        println!("{what}: MODE13H_SEED={seed}");
        // Each test its own row of numbers.
        Self(what.bytes().fold(seed, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)))
    }

    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// low ≤ n ≤ high.
    pub fn within(&mut self, low: i64, high: i64) -> i64 {
        let span = (high - low) as u64 + 1;
        low + ((u128::from(self.bits()) * u128::from(span)) >> 64) as i64
    }

    /// 1 ≤ n ≤ high, each power of two as likely as the next.
    pub fn log_uniform(&mut self, high: i64) -> i64 {
        let top = 63 - (high as u64).leading_zeros();
        let bits = self.within(0, i64::from(top));
        self.within(1 << bits, (2 << bits) - 1).min(high)
    }

    /// 0 ≤ x < 1.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn one_of<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.within(0, of.len() as i64 - 1) as usize]
    }
}
