//! Random numbers from a seed that is printed and can be set: `MODE13H_SEED=123 cargo test`.

/// SplitMix64 (Steele, Lea, Flood 2014): one addition and a mix, every seed as good as another, the
/// same on every machine.
pub struct Random(u64);

impl Random {
    /// From the seed of this run, which is printed; `stream` keeps tests and threads apart.
    pub fn new(stream: u64) -> Self {
        let seed = seed();
        println!("MODE13H_SEED={seed}, stream {stream}");
        let mut random = Self(seed);
        random.0 = random.next_u64() ^ stream.wrapping_mul(0xD134_2543_DE82_EF95);
        random
    }

    /// The same for a stream that has a name.
    pub fn named(stream: &str) -> Self {
        // FNV-1a.
        Self::new(
            stream
                .bytes()
                .fold(0xCBF2_9CE4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01B3)),
        )
    }

    /// From a number that another one gave: the same ever after, and nothing is printed.
    pub fn again(number: u64) -> Self {
        Self(number)
    }

    pub fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// 1 to 2^`bits` − 1, each power of two as likely as any other, and all its numbers alike.
    pub fn log_uniform(&mut self, bits: u32) -> usize {
        let bit = self.next_u64() % u64::from(bits);
        (1 << bit) + (self.next_u64() & ((1 << bit) - 1)) as usize
    }

    /// low ≤ n ≤ high, all alike.
    pub fn within(&mut self, low: i64, high: i64) -> i64 {
        let span = (high - low) as u64 + 1;
        low + ((u128::from(self.next_u64()) * u128::from(span)) >> 64) as i64
    }

    /// 0 ≤ x < 1, all alike.
    pub fn unit(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn one_of<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.within(0, of.len() as i64 - 1) as usize]
    }
}

/// `MODE13H_SEED`, or 13.
pub fn seed() -> u64 {
    match std::env::var("MODE13H_SEED") {
        Ok(text) => text.parse().expect("MODE13H_SEED is a number"),
        Err(_) => 13,
    }
}
