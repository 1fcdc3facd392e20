//! Chooses the least error budget that fits in a given time, from the times of earlier frames.
//!
//! Frames are grouped in blocks of eight drawn within the same error. A block's mean time is the
//! cost of its error. It also scales the costs of the other errors, since a pose that takes longer
//! at one error takes longer at all of them. Each error first gets a block of its own, starting
//! with the greatest. From then on each block is drawn within the least error whose time fits.
//!
//! A frame that takes twice the block's median or longer counts as the median, since another program must have run. A
//! block whose time is used up ends at once, so a sudden load is handled within a few frames. An error that fits is
//! kept until its frames exceed the time by a twentieth, and a smaller one is chosen only after 32 frames without a
//! change, so that no two errors alternate.

use core::time::Duration;

use super::Stats;
use crate::settings::Accuracy;

/// The available errors, in shades.
const ERRORS: [f32; 6] = [Pace::MAX_ERROR, 8.0, 4.0, 2.0, 1.0, 0.5];

/// Frames of a block.
const BLOCK: usize = 8;

/// Multiple of the time up to which the current error is kept. A newly chosen one must fit.
const TOLERANCE: f32 = 1.05;

/// Ratio of a block's time to the one before it above which the difference is not noise.
const JUMP: f32 = 1.2;

/// Ratio of a time to the median above which another program is to blame.
const OUTLIER: f32 = 2.0;

/// Frames without a change before a smaller error is chosen.
const HOLD: usize = 32;

/// Frames without a change before retrying a smaller error that did not fit, since its time was
/// measured on other poses. Each failed trial doubles the wait, up to 16 times this.
const PATIENCE: usize = 128;

/// Chooses the [error budget](Accuracy::WithinError) of the next frame so that frames stay within a time limit.
///
/// It uses only the times reported to it: the engine reads no clock. Errors go from 16 shades down to half a shade.
///
/// ```
/// use mode13h::Angle;
/// use mode13h::mesh::shapes;
/// use mode13h::render::{Pace, Renderer};
/// use mode13h::scene::Scene;
/// use mode13h::vga::Vga;
/// use std::time::{Duration, Instant};
///
/// let (mut scene, mut renderer, mut vga) = (Scene::new(), Renderer::new(), Vga::new());
/// let torus = scene.show(shapes::torus(48, 24));
/// let mut pace = Pace::new(Duration::from_millis(5));
/// for _ in 0..40 {
///     scene[torus].rotate_y(Angle::from_degrees(1.0));
///     renderer.settings.accuracy = Some(pace.accuracy());
///     let start = Instant::now();
///     let stats = renderer.draw(&scene, &mut vga)?;
///     pace.report(&stats, start.elapsed());
///     assert!(stats.max_error <= Some(16.0));
/// }
/// # Ok::<(), mode13h::render::RenderError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Pace {
    /// In milliseconds.
    max_time: f32,
    /// The greatest error. The smaller ones come from [`ERRORS`].
    max_error: f32,
    /// The time of a frame within each error; infinite if unknown.
    costs: [f32; ERRORS.len() + 1],
    at: usize,
    /// Times of the block's frames that were drawn.
    times: [f32; BLOCK],
    drawn: usize,
    /// Frames of the block, unchanged ones included.
    frames: usize,
    /// Frames of the blocks since the last change.
    held: usize,
    patience: usize,
    /// True if the error is being tried although it is not known to fit.
    is_trial: bool,
}

impl Pace {
    /// The greatest error chosen, in shades, unless [`at_most`](Self::at_most) says otherwise.
    pub const MAX_ERROR: f32 = 16.0;

    /// A pace for frames that take at most this long each.
    #[must_use]
    pub fn new(max_time: Duration) -> Self {
        Self::in_milliseconds(max_time.as_secs_f32() * 1000.0, Self::MAX_ERROR)
    }

    /// Accepts at most this error, in shades: above 0 and finite, or the renderer refuses it. Discards the times
    /// reported so far.
    #[must_use]
    pub fn at_most(self, max_error: f32) -> Self {
        Self::in_milliseconds(self.max_time, max_error)
    }

    fn in_milliseconds(max_time: f32, max_error: f32) -> Self {
        let (costs, times, patience) = ([f32::INFINITY; ERRORS.len() + 1], [0.0; BLOCK], PATIENCE);
        Self { max_time, max_error, costs, at: 0, times, drawn: 0, frames: 0, held: 0, patience, is_trial: false }
    }

    /// Errors smaller than the greatest.
    fn smaller(&self) -> impl Iterator<Item = f32> {
        let max_error = self.max_error;
        ERRORS.into_iter().filter(move |error| *error < max_error)
    }

    /// The error for the next frame, in shades.
    #[must_use]
    pub fn error(&self) -> f32 {
        self.at.checked_sub(1).and_then(|at| self.smaller().nth(at)).unwrap_or(self.max_error)
    }

    /// The accuracy for the next frame: [`error`](Self::error), for a renderer's settings.
    #[must_use]
    pub fn accuracy(&self) -> Accuracy {
        Accuracy::WithinError(self.error())
    }

    /// Returns whether frames within this error fit, as far as is known: false if even the greatest takes too long.
    #[must_use]
    pub fn fits(&self) -> bool {
        self.at > 0 || self.is_kept()
    }

    /// Returns whether the error may be kept.
    fn is_kept(&self) -> bool {
        let cost = self.costs[self.at];
        cost.is_infinite() || cost <= TOLERANCE * self.max_time
    }

    /// Reports the time and the counts of the last frame. The time of a frame that was [not redrawn](Stats::redrawn) is
    /// ignored.
    pub fn report(&mut self, stats: &Stats, time: Duration) {
        self.took(stats.redrawn.then_some(time.as_secs_f32() * 1000.0));
    }

    /// Records the time of the last frame in milliseconds; `None` for a frame that did not change.
    fn took(&mut self, time: Option<f32>) {
        if let Some(time) = time {
            // The clock may not have advanced.
            self.times[self.drawn] = time.max(1e-6);
            self.drawn += 1;
        }
        self.frames += 1;
        let is_spent = self.drawn > 1 && self.sum() > BLOCK as f32 * TOLERANCE * self.max_time;
        if self.frames == BLOCK || is_spent {
            self.end_block();
        }
    }

    /// The sum of the block's times, with frames delayed by another program counted as the median.
    fn sum(&self) -> f32 {
        // Positive numbers have the order of their bits.
        let mut times = self.times.map(f32::to_bits);
        let times = &mut times[..self.drawn];
        times.sort_unstable();
        let median = f32::from_bits(times[(self.drawn - 1) / 2]);
        let times = times.iter().map(|time| f32::from_bits(*time));
        times.map(|time| if time < OUTLIER * median { time } else { median }).sum()
    }

    fn end_block(&mut self) {
        let moves = self.drawn > 0;
        if moves {
            let (cost, known) = (self.sum() / self.drawn as f32, self.costs[self.at]);
            if self.held > 0 && known.is_finite() {
                // Half of the difference, so that noise changes little; all of it if the load has changed.
                let ratio = cost / known;
                let ratio = if (1.0 / JUMP..JUMP).contains(&ratio) { 0.5 + 0.5 * ratio } else { ratio };
                self.costs.iter_mut().for_each(|other| *other *= ratio);
            } else {
                // The cost of an error that was not drawn for a while may be outdated.
                self.costs[self.at] = cost;
            }
        }
        self.held = self.held.saturating_add(self.frames);
        (self.drawn, self.frames) = (0, 0);
        if self.is_trial {
            self.patience = if self.is_kept() { PATIENCE } else { (2 * self.patience).min(16 * PATIENCE) };
        }
        let chosen = self.choose();
        // A frame that does not change is not drawn, so its time says nothing.
        let tried =
            self.to_be_tried().filter(|_| moves && chosen == self.at && self.is_kept() && self.held >= self.patience);
        self.is_trial = tried.is_some();
        let next = tried.unwrap_or(chosen);
        if next != self.at {
            (self.at, self.held) = (next, 0);
        }
    }

    /// The index of the least error that fits: switches to a greater one at once if the current one
    /// does not fit, but to a smaller one only after a while.
    fn choose(&self) -> usize {
        let costs = &self.costs[..=self.smaller().count()];
        if let Some(untried) = costs.iter().position(|cost| cost.is_infinite()) {
            return untried;
        }
        let least_that_fits = |costs: &[f32]| costs.iter().rposition(|cost| *cost <= self.max_time);
        match least_that_fits(costs).filter(|at| *at > self.at && self.held >= HOLD) {
            Some(smaller) => smaller,
            None if self.is_kept() => self.at,
            None => least_that_fits(&costs[..self.at]).unwrap_or(0),
        }
    }

    /// The index of the cheapest of the smaller errors, if there is any.
    fn to_be_tried(&self) -> Option<usize> {
        (self.at + 1..=self.smaller().count()).min_by(|a, b| self.costs[*a].total_cmp(&self.costs[*b]))
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use super::*;
    use proptest::prelude::*;

    const T: f32 = 4.0;

    /// Frames in which each error is tried.
    const TRIED: usize = BLOCK * ERRORS.len();

    /// Errors and times of this many frames, with a clock that gives `cost` of a frame's index and error.
    fn run(budget: &mut Pace, frames: usize, mut cost: impl FnMut(usize, f32) -> Option<f32>) -> Vec<(f32, f32)> {
        let frame = |number| {
            let error = budget.error();
            let time = cost(number, error);
            budget.took(time);
            (error, time.unwrap_or(0.0))
        };
        (0..frames).map(frame).collect()
    }

    /// Normal noise of this deviation, from twelve uniform numbers.
    fn noise(chance: &mut u64, deviation: f32) -> f32 {
        let mut sum = -6.0;
        for _ in 0..12 {
            *chance = chance.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            sum += (*chance >> 40) as f32 / (1 << 24) as f32;
        }
        1.0 + deviation * sum
    }

    fn mean(numbers: impl ExactSizeIterator<Item = f32>) -> f64 {
        let count = numbers.len() as f64;
        numbers.map(f64::from).sum::<f64>() / count
    }

    /// Tests that changes to a smaller error come at least [`HOLD`] frames after the previous change, so that no two
    /// errors alternate, once all have been tried.
    fn assert_steady(frames: &[(f32, f32)]) {
        let mut changed = None;
        for (i, pair) in frames.windows(2).enumerate() {
            if pair[0].0 != pair[1].0 {
                if pair[1].0 < pair[0].0 && i >= TRIED {
                    let held = changed.map_or(usize::MAX, |at| i - at);
                    assert!(held >= HOLD, "{} after {held} frames, frame {i}", pair[1].0);
                }
                changed = Some(i);
            }
        }
    }

    /// Times of a frame within each of six errors: usually rising, some equal, some even falling.
    fn times() -> impl Strategy<Value = [f32; 6]> {
        (0.3_f32..6.0, prop::array::uniform6(prop_oneof![Just(1.0_f32), 0.9_f32..1.6])).prop_map(|(first, ratios)| {
            let mut time = first;
            ratios.map(|ratio| {
                time *= ratio;
                time
            })
        })
    }

    fn place(error: f32) -> usize {
        ERRORS.iter().position(|of| *of == error).expect("of the list")
    }

    /// The time of a frame within each error, in milliseconds: for a duck, a football and a torus,
    /// as measured by `mode13h cost`; then where errors hardly change the time, where only the
    /// least does, and where the time does not always rise.
    const MODELS: [[f32; 6]; 6] = [
        [0.765, 0.838, 0.892, 1.006, 1.228, 1.226],
        [0.443, 0.571, 0.686, 1.222, 1.504, 2.077],
        [0.074, 0.131, 0.151, 0.412, 0.581, 0.577],
        [1.42, 1.43, 1.45, 1.49, 1.56, 1.60],
        [5.10, 5.10, 5.12, 5.15, 5.60, 7.90],
        [2.00, 2.30, 3.10, 2.90, 3.60, 3.30],
    ];

    /// Eight successive poses in a full turn, as the study draws them, each with its relative time.
    const POSES: [f32; 8] = [0.8, 1.0, 1.3, 1.1, 0.7, 0.9, 1.2, 1.0];

    /// On every model, with a first frame that takes three times as long, and a machine whose
    /// frames are late by a few percent, one in fifty by far: the error falls as the time grows, is
    /// no greater than the least whose time fits (except for trials and noise), and no smaller than
    /// what fits within [`TOLERANCE`].
    #[test]
    fn the_error_falls_as_the_time_grows() {
        for (model, deviation) in MODELS.iter().flat_map(|model| [0.0, 0.01, 0.03].map(|deviation| (model, deviation)))
        {
            let mut last = f64::INFINITY;
            for step in 0..20_u8 {
                let max_time = model[0] * (1.2 * model[5] / model[0]).powf(f32::from(step) / 19.0);
                let mut chance = u64::from(step) + 1;
                let mut budget = Pace::in_milliseconds(max_time, Pace::MAX_ERROR);
                let frames = run(&mut budget, 1232, |frame, error| {
                    let late = if frame == 0 || frame % 50 == 49 { 3.0 } else { 1.0 };
                    Some(model[place(error)] * POSES[frame % 8] * late * noise(&mut chance, deviation))
                });
                let frames = &frames[TRIED..];
                let error = mean(frames.iter().map(|frame| frame.0));
                let least =
                    |time: f32| model.iter().rposition(|cost| *cost <= time).map_or(16.0, |at| ERRORS[at].into());
                let (low, high): (f64, f64) = (least(TOLERANCE * 1.02 * max_time), least(max_time / 1.02));
                let said = alloc::format!("{error} in {max_time} ms, {low} to {high} fit: {model:?} {deviation}");
                assert!(error <= 1.3 * high && error * 1.3 >= low, "{said}");
                assert!(error <= 1.1 * last, "{last}, then {said}");
                last = error;
            }
        }
    }

    proptest! {
        /// A scene with a constant time gets the least error that fits, or the greatest, which is then reported not to
        /// fit.
        #[test]
        fn a_steady_scene_gets_the_least_error_that_fits(times in times()) {
            let mut budget = Pace::in_milliseconds(T, Pace::MAX_ERROR);
            let frames = run(&mut budget, 600, |_, error| Some(times[place(error)]));
            let chosen = place(frames[TRIED + HOLD].0);
            // Sums of eight are rounded.
            let fits = |at: usize, share: f32| times[at] <= share * T;
            prop_assert!(fits(chosen, TOLERANCE * 1.000_01) || chosen == 0, "{times:?}: {frames:?}");
            prop_assert!((chosen + 1..6).all(|at| !fits(at, 0.999_99)), "{times:?}: {frames:?}");
            prop_assert_eq!(Pace { at: 0, ..budget }.fits(), fits(0, TOLERANCE));
        }

        /// Whatever the times, no two errors alternate, and the error is one of the accepted ones.
        #[test]
        fn no_two_errors_alternate(
            times in times(),
            seed: u64,
            deviation in 0.0_f32..0.5,
            loads in prop::collection::vec((1_usize..200, 0.2_f32..4.0), 1..12),
            max_error in prop_oneof![Just(Pace::MAX_ERROR), Just(3.0), Just(0.25), Just(100.0)],
        ) {
            let loads: Vec<f32> = loads.iter().flat_map(|(frames, load)| core::iter::repeat_n(*load, *frames)).collect();
            let mut chance = seed;
            let mut budget = Pace::in_milliseconds(T, max_error);
            let frames = run(&mut budget, loads.len(), |frame, error| {
                let place = ERRORS.iter().position(|of| *of <= error).unwrap_or(5);
                Some((times[place] * loads[frame] * noise(&mut chance, deviation)).max(0.0))
            });
            assert_steady(&frames);
            prop_assert!(frames.iter().all(|(error, _)| *error == max_error || (*error < max_error && ERRORS.contains(error))));
        }
    }

    /// A sudden load is handled within the frames that fit in the time of one block, plus one
    /// block: from then on each block's frames fit on average.
    #[test]
    fn a_sudden_load_is_met_within_two_blocks() {
        for (load, model) in [1.1, 1.3, 2.0, 3.0].into_iter().flat_map(|load| MODELS.map(|model| (load, model))) {
            let max_time = model[5];
            let mut budget = Pace::in_milliseconds(max_time, Pace::MAX_ERROR);
            let frames =
                run(&mut budget, 260, |frame, error| Some(model[place(error)] * if frame < 131 { 1.0 } else { load }));
            let fits = model[0] * load <= max_time;
            let late = frames[131..].iter().filter(|frame| frame.1 > TOLERANCE * max_time).count();
            assert!(!fits || late <= 2 * BLOCK, "{late} frames at {load}: {model:?}");
        }
    }

    /// A late frame among eight, delayed tenfold by another program, changes nothing.
    #[test]
    fn a_late_frame_changes_nothing() {
        let times = [1.0, 1.5, 2.2, 2.9, 3.6, 5.0];
        let mut budget = Pace::in_milliseconds(T, Pace::MAX_ERROR);
        let frames = run(&mut budget, 1000, |frame, error| {
            Some(times[place(error)] * if frame % BLOCK == 5 { 10.0 } else { 1.0 })
        });
        let trials = frames[TRIED..].iter().filter(|(error, _)| *error != 1.0).count();
        // Trials of half a shade after 128 frames, after 256 more, and after 512.
        assert!(trials <= 3 * BLOCK, "{trials}: {:?}", &frames[TRIED..200]);
    }

    /// A scene that turns: its times slowly rise and fall by a half. Most frames are drawn within the least error that
    /// fits, and at most one in ten is late: the load grows by up to 4 % from one block to the next.
    #[test]
    fn a_turn_is_followed() {
        let times = [1.6, 2.0, 2.5, 3.1, 3.8, 4.5];
        let mut chance = 5;
        let load = |frame: usize| 1.0 + 0.5 * libm::sinf(frame as f32 * 0.01);
        let mut budget = Pace::in_milliseconds(T, Pace::MAX_ERROR);
        let frames =
            run(&mut budget, 6000, |frame, error| Some(times[place(error)] * load(frame) * noise(&mut chance, 0.01)));
        assert_steady(&frames);
        let late = frames[TRIED..].iter().filter(|(_, time)| *time > 1.05 * T).count();
        assert!(late * 10 <= frames.len(), "{late}");
        let is_near = |(frame, (error, _)): (usize, &(f32, f32))| {
            let best = (0..6).rev().find(|at| times[*at] * load(frame) <= 0.9 * T).unwrap_or(0);
            place(*error) >= best
        };
        let near = frames.iter().enumerate().filter(|frame| is_near(*frame)).count();
        assert!(near * 10 >= frames.len() * 9, "{near} of {}", frames.len());
    }

    /// If the error does not change the time, a great one gains nothing.
    #[test]
    fn a_scene_whose_time_the_error_does_not_change_gets_the_least_error() {
        let mut budget = Pace::in_milliseconds(T, Pace::MAX_ERROR);
        let frames = run(&mut budget, 1000, |_, _| Some(3.0));
        assert!(frames[TRIED..].iter().all(|(error, _)| *error == 0.5));
        let mut budget = Pace::in_milliseconds(T, Pace::MAX_ERROR);
        let frames = run(&mut budget, 1000, |_, _| Some(5.0));
        assert!(frames[TRIED..].iter().all(|(error, _)| *error == Pace::MAX_ERROR) && !budget.fits());
    }

    /// If known times are wrong because the scene has changed, smaller errors are retried, rarely,
    /// until they fit.
    #[test]
    fn old_times_are_tried_again() {
        let mut budget = Pace::in_milliseconds(T, Pace::MAX_ERROR);
        let early = |error: f32| if error < 4.0 { 9.0 } else { 2.0 };
        let frames = run(&mut budget, 4000, |_, error| Some(early(error)));
        assert_eq!(budget.error(), 4.0);
        let tried = frames[TRIED..].iter().filter(|(error, _)| *error < 4.0).count();
        assert!((1..=24).contains(&tried), "{tried} frames");
        run(&mut budget, 4000, |_, _| Some(2.0));
        assert_eq!(budget.error(), 0.5);
    }

    /// A still image is refined to the least error, and redrawn only for that.
    #[test]
    fn a_still_picture_is_refined() {
        let mut budget = Pace::in_milliseconds(T, Pace::MAX_ERROR);
        let (mut shown, mut drawn) = (None, 0);
        let frames = run(&mut budget, 400, |_, error| {
            let is_drawn = shown != Some(error);
            shown = Some(error);
            drawn += u32::from(is_drawn);
            is_drawn.then_some(if error < 1.0 { 5.0 } else { 2.0 })
        });
        assert!(frames[200..].iter().all(|(error, _)| *error == 1.0), "{:?}", &frames[..60]);
        assert!(drawn <= 8, "{drawn} drawn");
    }

    /// Edge cases: one time, no time, and no frame at all.
    #[test]
    fn a_clock_that_stands_still_chooses_the_least_error() {
        let mut budget = Pace::in_milliseconds(T, 3.0);
        assert_eq!((budget.error(), budget.fits()), (3.0, true));
        budget.took(None);
        assert_eq!((budget.error(), budget.fits()), (3.0, true));
        let frames = run(&mut budget, 200, |_, _| Some(0.0));
        assert_eq!(frames.last(), Some(&(0.5, 0.0)));
    }
}
