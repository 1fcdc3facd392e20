//! Times that change slowly enough to be read.

/// The time that drawing a frame takes and the frame rate, steady enough to read.
#[derive(Default)]
pub(super) struct Timing {
    sum: f64,
    drawn: u32,
    frames: u32,
    change: f64,
    /// Seconds per frame drawn, over the last period in which any was.
    pub(super) frame: f64,
    /// Frames a second, drawn or not, over the last period.
    pub(super) rate: f64,
    /// True if the last frame was drawn, and not the same as the one before.
    pub(super) is_redrawn: bool,
}

impl Timing {
    /// The minimum time from one figure to the next, in seconds.
    const PERIOD: f64 = 0.5;

    /// Records that a frame was shown at the time `now`. It was drawn in `taken` seconds or, with `None`, was already
    /// there.
    pub(super) fn add(&mut self, taken: Option<f64>, now: f64) {
        self.is_redrawn = taken.is_some();
        self.sum += taken.unwrap_or(0.0);
        self.drawn += u32::from(taken.is_some());
        self.frames += 1;
        let passed = now - self.change;
        if passed >= Self::PERIOD || self.frame == 0.0 {
            if self.drawn > 0 {
                self.frame = self.sum / f64::from(self.drawn);
            }
            self.rate = if passed > 0.0 { f64::from(self.frames) / passed } else { 0.0 };
            (self.sum, self.drawn, self.frames, self.change) = (0.0, 0, 0, now);
        }
    }

    /// The time as text, if there is one, and whether the last frame was drawn.
    pub(super) fn in_words(&self) -> String {
        match (self.is_redrawn, self.frame == 0.0) {
            (true, _) => self.to_string(),
            (false, true) => "not redrawn".to_string(),
            (false, false) => format!("{self}, not redrawn"),
        }
    }
}

impl std::fmt::Display for Timing {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.2} ms", self.frame * 1000.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_that_was_there_already_counts_for_the_rate_alone() {
        let mut timing = Timing::default();
        timing.add(None, 0.0);
        assert_eq!(timing.in_words(), "not redrawn");
        timing.add(Some(0.010), 0.0);
        for (taken, now) in [(Some(0.002), 0.1), (None, 0.2), (None, 0.3), (Some(0.004), 0.5)] {
            timing.add(taken, now);
        }
        assert_eq!((timing.frame, timing.rate), (0.003, 8.0));
        for now in [0.6, 1.0] {
            timing.add(None, now);
        }
        assert_eq!((timing.frame, timing.rate), (0.003, 4.0));
    }
}
