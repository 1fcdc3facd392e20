//! Clocks that times are read from.

use core::fmt;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use super::statistics::median;

/// A clock.
///
/// A clock that runs only while this thread does is best: it does not charge a frame for the time that another program
/// had the processor. The standard library has none.
#[derive(Clone, Copy)]
pub struct Clock {
    /// Description in a few words.
    pub name: &'static str,
    /// Reads the clock; only differences between readings on one thread mean anything.
    pub now: fn() -> Duration,
}

impl Clock {
    /// The wall clock.
    pub const WALL: Self = Self { name: "wall clock", now: on_the_wall };

    /// Measures the nanoseconds that `work` takes.
    pub(super) fn time<T>(self, work: impl FnOnce() -> T) -> (f64, T) {
        let start = (self.now)();
        let result = work();
        let time = (self.now)().saturating_sub(start);
        // Below 2⁵³, which is a hundred days.
        (time.as_nanos() as f64, result)
    }

    /// Measures the clock's resolution in nanoseconds: the median of a hundred steps.
    pub(super) fn step(self) -> f64 {
        let mut steps = [0.0; 100];
        for step in &mut steps {
            let start = (self.now)();
            *step = loop {
                let passed = (self.now)().saturating_sub(start);
                if !passed.is_zero() {
                    break passed.as_nanos() as f64;
                }
            };
        }
        median(&steps)
    }
}

impl fmt::Debug for Clock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Clock({})", self.name)
    }
}

fn on_the_wall() -> Duration {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wall_clock_runs() {
        let (time, ()) = Clock::WALL.time(|| std::thread::sleep(Duration::from_millis(2)));
        assert!(time >= 2e6 && Clock::WALL.step() > 0.0);
    }
}
