//! Cost of an effect, measured on the spot against the frame as planned.

use std::hint::black_box;
use std::time::{Duration, Instant};

use mode13h::plan::Effect;
use mode13h::render::{Renderer, Screen};
use mode13h::scene::Scene;
use mode13h::settings::HiddenSurfaces;
use mode13h::vga::Vga;

use crate::failure::Failure;

/// The minimum and maximum number of differences that a price is computed from.
const ROUNDS: (usize, usize) = (15, 1_001);

/// Times two frames of a moving scene, drawn alternately.
pub(crate) struct EffectCost<'a, Make: Fn() -> Renderer> {
    /// Makes renderers that draw as the user asked.
    pub(crate) renderer: Make,
    /// The two frames, 1/35 s apart.
    pub(crate) frames: &'a [Scene; 2],
    /// Time for which an effect is measured.
    pub(crate) time: Duration,
}

/// A renderer with its VGA.
struct Artist {
    renderer: Renderer,
    vga: Vga,
}

impl Artist {
    fn new(renderer: Renderer) -> Artist {
        Artist { renderer, vga: Vga::new() }
    }

    /// Draws a frame and returns its time in nanoseconds. It is drawn even if nothing changed, so that there is
    /// something to measure.
    fn draw(&mut self, scene: &Scene) -> Result<f64, Failure> {
        black_box(self.vga.pixels_mut());
        let start = Instant::now();
        self.renderer.draw(scene, &mut self.vga)?;
        Ok(nanoseconds(start.elapsed()))
    }
}

impl<Make: Fn() -> Renderer> EffectCost<'_, Make> {
    /// Measures the time of a frame, in nanoseconds: the median of many.
    pub(crate) fn frame(&self) -> Result<f64, Failure> {
        let mut artist = Artist::new((self.renderer)());
        let times = self.rounds(|scene, _| artist.draw(scene))?;
        Ok(median(times))
    }

    /// Measures the time of making the plan, in nanoseconds: the median of many, each of ten plans.
    pub(crate) fn plan(&self) -> Result<f64, Failure> {
        const PLANS: usize = 10;
        let mut renderer = (self.renderer)();
        // The vertices of the first frame are cached; those of the second never are.
        renderer.draw(&self.frames[0], &mut Vga::new())?;
        let times = self.rounds(|_, _| {
            let start = Instant::now();
            for i in 0..PLANS {
                black_box(renderer.make_plan(&self.frames[i % 2], Screen::MODE_13H))?;
            }
            Ok(nanoseconds(start.elapsed()) / PLANS as f64)
        })?;
        Ok(median(times))
    }

    /// Measures how many nanoseconds longer a frame takes with an effect on one object than without it. `on` says
    /// whether the plan has it on; otherwise it is switched on. Hidden surfaces and palette animation apply to all
    /// objects. `None` if it cannot be switched.
    ///
    /// The frame as it is and the frame with the effect switched are drawn in turn; [`above_noise`] turns the
    /// differences into the price.
    pub(crate) fn price(&self, object: usize, effect: Effect, on: bool) -> Result<Option<u64>, Failure> {
        let mut usual = Artist::new((self.renderer)());
        let mut switched = Artist::new((self.renderer)());
        match effect {
            Effect::HiddenSurfaces => {
                let way = if on { HiddenSurfaces::BackFaces } else { HiddenSurfaces::DepthBuffer };
                switched.renderer.settings.hidden_surfaces = Some(way);
            }
            Effect::PaletteAnimation => switched.renderer.force(effect, Some(!on)),
            _ => switched.renderer.force_for(self.frames[0].object_ids()[object], effect, Some(!on)),
        }
        let differences = self.rounds(|scene, round| {
            // In turn, so that neither always finds the caches as the other left them.
            let (usual, switched) = if round / 2 % 2 == 0 {
                let usual = usual.draw(scene)?;
                (usual, switched.draw(scene)?)
            } else {
                let switched = switched.draw(scene)?;
                (usual.draw(scene)?, switched)
            };
            Ok(if on { usual - switched } else { switched - usual })
        })?;
        if switched.renderer.plan().objects()[object].is_on(effect) == on {
            return Ok(None);
        }
        Ok(Some(above_noise(differences)))
    }

    /// Calls `measure` for the two frames in turn, over and over, as long as there is time. The first four times do not
    /// count, because tables and vertices are computed then.
    fn rounds(&self, mut measure: impl FnMut(&Scene, usize) -> Result<f64, Failure>) -> Result<Vec<f64>, Failure> {
        for round in 0..4 {
            measure(&self.frames[round % 2], round)?;
        }
        let start = Instant::now();
        let mut measured = Vec::new();
        while measured.len() < ROUNDS.0 || (measured.len() < ROUNDS.1 && start.elapsed() < self.time) {
            let round = measured.len();
            measured.push(measure(&self.frames[round % 2], round)?);
        }
        Ok(measured)
    }
}

/// The median of differences, in whole nanoseconds, if they are more than noise; else 0.
///
/// If both took the same time, each of n differences would be above or below 0 by chance, and half of them would be
/// above, with a standard deviation of √n/2. If no more than half plus three times that are above 0, the median is
/// noise; so is one below 0.
fn above_noise(differences: Vec<f64>) -> u64 {
    let count = differences.len() as f64;
    let above = differences.iter().filter(|difference| **difference > 0.0).count() as f64;
    let is_noise = above <= count / 2.0 + 3.0 * count.sqrt() / 2.0;
    // More than half of them are above 0, so the median is; it is far below 2⁵³.
    if is_noise { 0 } else { median(differences).round() as u64 }
}

fn nanoseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e9
}

/// The median; 0 if there are no numbers.
fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_longer_by_chance_has_no_price() {
        // 100 differences: half of them and three standard deviations of 5 are 65.
        let differences = |above: usize| (0..100).map(|i| if i < above { 1_000.4 } else { -3.0 }).collect::<Vec<f64>>();
        assert_eq!([0, 50, 65].map(|above| above_noise(differences(above))), [0, 0, 0]);
        assert_eq!([66, 100].map(|above| above_noise(differences(above))), [1_000, 1_000]);
        // A few that were disturbed change nothing.
        let mut disturbed = differences(97);
        disturbed[0] = 1e9;
        disturbed[99] = -1e9;
        assert_eq!(above_noise(disturbed), 1_000);
        // At least 15 are measured; of these 14 must be above.
        let few = |above: usize| (0..15).map(|i| if i < above { 7.0 } else { -7.0 }).collect::<Vec<f64>>();
        assert_eq!([13, 14].map(|above| above_noise(few(above))), [0, 7]);
        assert_eq!(above_noise(Vec::new()), 0);
    }
}
