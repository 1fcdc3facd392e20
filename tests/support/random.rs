//! Random numbers from a seed that is printed and can be set: `MODE13H_SEED=123 cargo test`.

/// SplitMix64 (Steele, Lea, Flood 2014): one addition and a mix, every seed as good as another.
pub(crate) struct Random(u64);

impl Random {
    /// From the seed of this run, which is printed; `stream` keeps tests and threads apart.
    pub(crate) fn new(stream: u64) -> Self {
        let seed = seed();
        println!("MODE13H_SEED={seed}, stream {stream}");
        let mut random = Self(seed);
        random.0 = random.next_u64() ^ stream.wrapping_mul(0xD134_2543_DE82_EF95);
        random
    }

    pub(crate) fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }
}

/// `MODE13H_SEED`, or 13.
pub(crate) fn seed() -> u64 {
    match std::env::var("MODE13H_SEED") {
        Ok(text) => text.parse().expect("MODE13H_SEED is a number"),
        Err(_) => 13,
    }
}
