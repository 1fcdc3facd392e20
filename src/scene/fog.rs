//! Fog: what is far away fades into one colour (the Russian textbook).

use crate::palette::Rgb;

/// Fog, by distance along the view.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Fog {
    /// What everything fades into.
    pub color: Rgb,
    /// Nearer than this there is none, in the scene's units.
    pub start: f32,
    /// Farther than this there is nothing else; above `start`.
    pub end: f32,
}

impl Fog {
    /// What is wrong with it, if anything.
    pub(crate) fn check(&self) -> Result<(), &'static str> {
        if !(self.start.is_finite() && self.end.is_finite()) {
            return Err("its start and end must be finite");
        }
        if self.end <= self.start {
            return Err("its end must lie beyond its start");
        }
        Ok(())
    }

    /// How thick it is at a distance: 0, none, to 1, nothing else.
    #[must_use]
    #[doc(hidden)]
    pub fn level(&self, distance: f64) -> f64 {
        let (start, end) = (f64::from(self.start), f64::from(self.end));
        ((distance - start) / (end - start)).clamp(0.0, 1.0)
    }
}
