//! Times of rounds in which every candidate has a turn, in an order reshuffled every round.

use std::ffi::{c_int, c_long};

use mode13h_conformance::Random;

/// `struct timespec` of 64-bit Linux.
#[repr(C)]
struct Timespec {
    seconds: c_long,
    nanoseconds: c_long,
}

unsafe extern "C" {
    fn clock_gettime(clock: c_int, time: *mut Timespec) -> c_int;
}

/// `CLOCK_THREAD_CPUTIME_ID`.
const THREAD: c_int = 3;

/// Seconds of CPU time of this thread. All candidates draw in it, and whatever else the processor does meanwhile does
/// not count.
pub fn seconds() -> f64 {
    let mut time = Timespec { seconds: 0, nanoseconds: 0 };
    // SAFETY: the clock exists since Linux 2.6.12, and both numbers are written.
    unsafe { clock_gettime(THREAD, &raw mut time) };
    time.seconds as f64 + time.nanoseconds as f64 * 1e-9
}

/// The times of one candidate in seconds, one per round.
#[derive(Clone, Debug, Default)]
pub struct Times(Vec<f64>);

/// A median, with the interval that contains it in 95 of 100 runs.
#[derive(Clone, Copy, Debug)]
pub struct Median {
    pub low: f64,
    pub median: f64,
    pub high: f64,
}

impl Times {
    pub fn push(&mut self, seconds: f64) {
        self.0.push(seconds);
    }

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

/// Orders of turns, reshuffled every time.
pub struct Turns {
    random: Random,
    order: Vec<usize>,
}

impl Turns {
    pub fn of(candidates: usize) -> Self {
        Self { random: Random::again(13), order: (0..candidates).collect() }
    }

    pub fn shuffled(&mut self) -> &[usize] {
        self.random.shuffle(&mut self.order);
        &self.order
    }
}
