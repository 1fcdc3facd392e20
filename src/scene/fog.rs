//! Fog: distant surfaces fade into one colour (the Russian textbook).

use crate::palette::Rgb;

/// Fog that thickens linearly with the distance along the view.
///
/// It covers surfaces, not the background: set that to the same colour with
/// [`Scene::set_background`](super::Scene::set_background).
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Fog {
    /// The colour that surfaces fade into.
    pub color: Rgb,
    /// The distance at which fog begins, in the scene's units.
    pub start: f32,
    /// The distance beyond which fog hides everything; above `start`.
    pub end: f32,
}

impl Fog {
    /// Checks the fog; the error says what is wrong.
    pub(crate) fn check(&self) -> Result<(), &'static str> {
        if !(self.start.is_finite() && self.end.is_finite()) {
            return Err("its start and end must be finite");
        }
        if self.end <= self.start {
            return Err("its end must lie beyond its start");
        }
        Ok(())
    }

    /// The share of fog at a distance, from 0 (none) to 1 (nothing but fog). It may be NaN if `end` is not above `start`.
    #[must_use]
    pub fn level(&self, distance: f64) -> f64 {
        let (start, end) = (f64::from(self.start), f64::from(self.end));
        ((distance - start) / (end - start)).clamp(0.0, 1.0)
    }
}
