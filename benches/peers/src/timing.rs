//! Times of rounds in which everybody has a turn.

/// Rounds that count.
pub const ROUNDS: usize = 15;

/// The times of one contender, seconds.
#[derive(Clone, Debug)]
pub struct Times(Vec<f64>);

impl Times {
    pub const fn new() -> Self {
        Self(Vec::new())
    }

    pub fn push(&mut self, seconds: f64) {
        self.0.push(seconds);
    }

    pub fn best(&self) -> f64 {
        self.0.iter().copied().fold(f64::INFINITY, f64::min)
    }

    pub fn median(&self) -> f64 {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
    }
}
