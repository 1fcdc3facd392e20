//! Medians of the times of rounds, and of their ratios.

/// The times of one candidate in seconds, one per round.
#[derive(Debug)]
pub struct Times(pub Vec<f64>);

/// A median, with the interval that contains it in 95 of 100 runs.
#[derive(Clone, Copy, Debug)]
pub struct Median {
    pub low: f64,
    pub median: f64,
    pub high: f64,
}

impl Times {
    pub fn median(&self) -> Median {
        Median::of(&self.0)
    }

    /// The ratio to `other`'s times, round by round, so that what slows down a whole round does not show.
    pub fn ratio(&self, other: &Self) -> Median {
        Median::of(&self.0.iter().zip(&other.0).map(|(a, b)| a / b).collect::<Vec<_>>())
    }
}

impl Median {
    /// The interval ends at order statistics: a median lies beyond the k-th of n values with the probability that fewer
    /// than k of n coins show heads, which the normal distribution approximates. With few values the interval is all of
    /// them.
    pub fn of(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let n = sorted.len() as f64;
        let beside = ((n - 1.96 * n.sqrt()) / 2.0).floor().max(0.0) as usize;
        let at = |i: usize| sorted.get(i).copied().unwrap_or(f64::NAN);
        let last = sorted.len().saturating_sub(1);
        Self { low: at(beside), median: (at(last / 2) + at(last.div_ceil(2))) / 2.0, high: at(last - beside.min(last)) }
    }

    pub fn times(self, factor: f64) -> Self {
        Self { low: self.low * factor, median: self.median * factor, high: self.high * factor }
    }

    pub fn json(self) -> serde_json::Value {
        serde_json::json!({ "low": self.low, "median": self.median, "high": self.high })
    }
}
