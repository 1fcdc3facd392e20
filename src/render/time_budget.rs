//! The least error that fits in a time: the error budget of the next frame, from the times of the frames before it.
//!
//! The engine has no clock. The caller says how long each frame took, and the errors follow from these times alone.
//! First each error is tried for some frames, from the greatest on, until one takes too long. Their times are kept as
//! predictions; the time of every later frame scales all of them. A frame is drawn within the least error whose
//! predicted time fits.
//!
//! The machine's noise has its room: the ratio of a frame's time to the usual one that one frame in a hundred exceeds is
//! tracked, and what counts as fitting fits with that ratio. Three rules keep the error steady. One slow frame changes
//! nothing: a greater error needs two slow frames of three, or a median that does not fit with the ratio. A smaller error
//! must be predicted to leave a tenth of the time. It is chosen only after 32 frames without a change, so that no two
//! errors alternate.

use super::settings::MAX_ERROR;

/// Errors that are chosen from, in shades.
const ERRORS: [f32; 6] = [MAX_ERROR, 8.0, 4.0, 2.0, 1.0, 0.5];

/// Frames that each error is tried for at first.
const TRIAL: u32 = 4;

/// Frames without a change before a smaller error is chosen.
const HOLD: u32 = 32;

/// Drawn frames without a change before a smaller error is tried, whatever its prediction: times of other poses may be
/// others. Each trial that fails doubles it, up to 16 times this.
const PATIENCE: u32 = 512;

/// Times that are kept.
const TIMES: usize = 8;

/// Share of the time that a smaller error may be predicted to take.
const COMFORT: f32 = 0.9;

/// Step by which the ratio of a late frame follows what is seen: upwards once in a hundred frames, downwards otherwise.
const STEP: f32 = 0.05;

/// Ratio of a time to the usual one from which on another program is to blame.
const OUTLIER: f32 = 2.0;

/// Controller of the error that the next frame is drawn within.
#[derive(Clone, Debug)]
pub(super) struct TimeBudget {
    /// In milliseconds.
    max_time: f32,
    /// The greatest error. The smaller ones are those of [`ERRORS`].
    max_error: f32,
    /// Predicted times; infinite where none is known.
    costs: [f32; ERRORS.len() + 1],
    /// Ratio of a time to the median that one frame in a hundred exceeds: what the machine's noise takes.
    late: f32,
    at: usize,
    is_calibrating: bool,
    /// Times of frames since the last change, the newest at the end.
    times: [f32; TIMES],
    /// Drawn frames since the last change.
    drawn: u32,
    /// Frames since the last change, those among them that stayed as they were.
    frames: u32,
    patience: u32,
    /// True if the error was tried against its prediction.
    is_trial: bool,
}

impl TimeBudget {
    pub(super) fn new(max_time: f32, max_error: f32) -> Self {
        Self {
            max_time,
            max_error,
            costs: [f32::INFINITY; ERRORS.len() + 1],
            late: 1.0,
            at: 0,
            is_calibrating: true,
            times: [0.0; TIMES],
            drawn: 0,
            frames: 0,
            patience: PATIENCE,
            is_trial: false,
        }
    }

    /// Returns whether it was made for this time and this error.
    pub(super) fn is_of(&self, max_time: f32, max_error: f32) -> bool {
        (self.max_time, self.max_error) == (max_time, max_error)
    }

    /// Errors that are smaller than the greatest.
    fn smaller(&self) -> impl Iterator<Item = f32> {
        let max_error = self.max_error;
        ERRORS.into_iter().filter(move |error| *error < max_error)
    }

    /// The error that the next frame is to be drawn within.
    pub(super) fn error(&self) -> f32 {
        self.at.checked_sub(1).and_then(|at| self.smaller().nth(at)).unwrap_or(self.max_error)
    }

    /// Returns whether frames within this error fit, as far as is known.
    pub(super) fn fits(&self) -> bool {
        self.at > 0 || self.drawn == 0 || self.typical() <= self.max_time
    }

    /// Takes the time of the last frame in milliseconds; `None` for a frame that stayed as it was.
    pub(super) fn took(&mut self, time: Option<f32>) {
        self.frames = self.frames.saturating_add(1);
        if let Some(time) = time {
            // A clock may stand still.
            let time = time.max(1e-6);
            let late = time / self.typical();
            if late < OUTLIER {
                self.late *= if late > self.late { 1.0 + STEP } else { 1.0 - STEP / 99.0 };
                self.late = self.late.max(1.0);
            }
            self.drawn = self.drawn.saturating_add(1);
            self.times.rotate_left(1);
            self.times[TIMES - 1] = time;
        }
        let is_known = self.drawn > 0 && self.frames >= TRIAL;
        if self.is_calibrating {
            if is_known {
                self.calibrate();
            }
            return;
        }
        // A frame that stays as it was changes no time.
        let is_tight =
            is_known && (time.is_some() || self.frames == TRIAL) && self.typical() * self.late > self.max_time;
        if self.is_slow() || is_tight {
            self.learn();
            self.relax();
        } else if is_known {
            self.learn();
            if self.frames >= HOLD {
                self.tighten();
            }
        }
    }

    /// The times that are kept, in their order of size.
    fn sorted(&self) -> ([f32; TIMES], usize) {
        let count = TIMES.min(self.drawn as usize);
        let mut times = [f32::INFINITY; TIMES];
        times[..count].copy_from_slice(&self.times[TIMES - count..]);
        times.sort_unstable_by(f32::total_cmp);
        (times, count)
    }

    /// The median time; of an even number the lesser one in the middle.
    fn typical(&self) -> f32 {
        let (times, count) = self.sorted();
        times[count.saturating_sub(1) / 2]
    }

    /// The second longest time of the last three frames; 0 of a single one.
    fn last(&self) -> f32 {
        let mut last = [0.0; 3];
        let count = 3.min(self.drawn as usize);
        last[..count].copy_from_slice(&self.times[TIMES - count..]);
        last.sort_unstable_by(f32::total_cmp);
        last[1]
    }

    /// Returns whether two of the last three frames took too long.
    fn is_slow(&self) -> bool {
        self.last() > self.max_time
    }

    /// Tries the next error, or ends with the least that fits.
    fn calibrate(&mut self) {
        self.costs[self.at] = self.typical();
        if self.costs[self.at] * self.late > self.max_time || self.at == self.smaller().count() {
            self.is_calibrating = false;
            self.change(self.least_that_fits());
        } else {
            self.change(self.at + 1);
        }
    }

    /// Predicts times from those of the last frames.
    fn learn(&mut self) {
        let now = if self.is_slow() { self.last() } else { self.typical() };
        let known = self.costs[self.at];
        // What was predicted of this error is compared with its own first times, and the others follow from then on.
        if self.frames > TRIAL && known.is_finite() {
            self.costs.iter_mut().for_each(|cost| *cost *= now / known);
        }
        self.costs[self.at] = now;
        if self.is_trial && self.frames > HOLD {
            (self.is_trial, self.patience) = (false, PATIENCE);
        }
    }

    /// The place of the least error that is predicted to fit, late frames too; the greatest where none is.
    fn least_that_fits(&self) -> usize {
        (0..=self.smaller().count()).rev().find(|at| self.leaves_room(*at)).unwrap_or(0)
    }

    fn leaves_room(&self, at: usize) -> bool {
        self.costs[at] * self.late <= COMFORT * self.max_time
    }

    /// Chooses a greater error.
    fn relax(&mut self) {
        if self.is_trial {
            self.patience = (2 * self.patience).min(16 * PATIENCE);
        }
        let at = self.least_that_fits();
        if at < self.at {
            self.change(at);
        } else if self.at > 0 {
            // The prediction of a smaller error is older than what was seen.
            self.change(self.at - 1);
        }
    }

    /// Chooses a smaller error, if it is predicted to fit, or tries one now and then.
    fn tighten(&mut self) {
        let at = self.least_that_fits();
        if at > self.at {
            self.change(at);
        } else if self.at < self.smaller().count() && self.leaves_room(self.at) {
            let is_unknown = self.costs[self.at + 1].is_infinite();
            if is_unknown || self.drawn >= self.patience {
                self.change(self.at + 1);
                self.is_trial = true;
            }
        }
    }

    fn change(&mut self, at: usize) {
        (self.at, self.drawn, self.frames, self.is_trial) = (at, 0, 0, false);
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use super::*;
    use proptest::prelude::*;

    const T: f32 = 4.0;

    /// Errors and times of so many frames, by a clock that says what `cost` says of a frame's number and error.
    fn run(budget: &mut TimeBudget, frames: usize, mut cost: impl FnMut(usize, f32) -> Option<f32>) -> Vec<(f32, f32)> {
        let frame = |number| {
            let error = budget.error();
            let time = cost(number, error);
            budget.took(time);
            (error, time.unwrap_or(0.0))
        };
        (0..frames).map(frame).collect()
    }

    /// Normal noise of this deviation, by twelve uniform numbers.
    fn noise(chance: &mut u64, deviation: f32) -> f32 {
        let mut sum = -6.0;
        for _ in 0..12 {
            *chance = chance.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            sum += (*chance >> 40) as f32 / (1 << 24) as f32;
        }
        1.0 + deviation * sum
    }

    /// The share of frames within 1.05 T.
    fn share(frames: &[(f32, f32)]) -> f64 {
        frames.iter().filter(|(_, time)| *time <= 1.05 * T).count() as f64 / frames.len() as f64
    }

    /// Tests that changes to a smaller error lie at least [`HOLD`] frames after the change before, so that no two errors
    /// alternate, once all were tried.
    fn assert_steady(frames: &[(f32, f32)]) {
        let tried = TRIAL as usize * (ERRORS.len() + 1);
        let mut changed = None;
        for (i, pair) in frames.windows(2).enumerate() {
            if pair[0].0 != pair[1].0 {
                if pair[1].0 < pair[0].0 && i >= tried {
                    let held = changed.map_or(usize::MAX, |at| i - at);
                    assert!(held >= HOLD as usize, "{} after {held} frames, frame {i}", pair[1].0);
                }
                changed = Some(i);
            }
        }
    }

    /// Times that a frame takes within each of six errors, of which some may be equal.
    fn times() -> impl Strategy<Value = [f32; 6]> {
        (0.3_f32..6.0, prop::array::uniform6(prop_oneof![Just(1.0_f32), 1.0_f32..1.6])).prop_map(|(first, ratios)| {
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

    proptest! {
        /// A scene that takes the same time again and again gets the least error that fits, or the greatest, which says
        /// so.
        #[test]
        fn a_steady_scene_gets_the_least_error_that_fits(times in times()) {
            let mut budget = TimeBudget::new(T, MAX_ERROR);
            let frames = run(&mut budget, 400, |_, error| Some(times[place(error)]));
            let fits = |time: &&f32| **time <= COMFORT * T;
            let expected = times.iter().rev().find(fits).map_or(0, |least| times.iter().rposition(|time| time == least).unwrap_or(0));
            prop_assert!(frames[30..].iter().all(|(error, _)| place(*error) == expected), "{times:?}: {frames:?}");
            prop_assert_eq!(budget.fits(), times[0] <= T);
        }

        /// Whatever times there are, no two errors alternate, and the error is one of those that are accepted.
        #[test]
        fn no_two_errors_alternate(
            times in times(),
            seed: u64,
            deviation in 0.0_f32..0.5,
            loads in prop::collection::vec((1_usize..200, 0.2_f32..4.0), 1..12),
            max_error in prop_oneof![Just(MAX_ERROR), Just(3.0), Just(0.25), Just(100.0)],
        ) {
            let loads: Vec<f32> = loads.iter().flat_map(|(frames, load)| core::iter::repeat_n(*load, *frames)).collect();
            let mut chance = seed;
            let mut budget = TimeBudget::new(T, max_error);
            let frames = run(&mut budget, loads.len(), |frame, error| {
                let place = ERRORS.iter().position(|of| *of <= error).unwrap_or(5);
                Some((times[place] * loads[frame] * noise(&mut chance, deviation)).max(0.0))
            });
            assert_steady(&frames);
            prop_assert!(frames.iter().all(|(error, _)| *error == max_error || (*error < max_error && ERRORS.contains(error))));
        }

        /// A load that comes at once makes at most two frames too long for each change that it takes.
        #[test]
        fn a_load_is_met_in_two_frames(times in times(), load in 1.0_f32..3.0) {
            let mut budget = TimeBudget::new(T, MAX_ERROR);
            let frames = run(&mut budget, 400, |frame, error| {
                Some(times[place(error)] * if frame < 200 { 1.0 } else { load })
            });
            let fits = times[0] * load <= COMFORT * T;
            let slow = frames[200..].iter().filter(|(_, time)| *time > T).count();
            prop_assert!(!fits || slow <= 2, "{slow} frames: {times:?}, {:?}", &frames[200..240]);
        }
    }

    /// A machine that others use: of the frames within any error one in a hundred takes up to 1.3 times as long as usual, and
    /// the scene turns. 99 % of all frames fit, no two errors alternate, and what the noise leaves is used.
    #[test]
    fn late_frames_are_left_room_for() {
        let times = [1.0, 1.3, 1.7, 2.2, 2.8, 3.6];
        for (seed, deviation) in (0..30).flat_map(|seed| [0.02, 0.05, 0.11].map(|deviation| (seed, deviation))) {
            let mut chance = seed;
            let mut budget = TimeBudget::new(T, MAX_ERROR);
            let frames = run(&mut budget, 2000, |frame, error| {
                let load = 1.0 + 0.3 * libm::sinf(frame as f32 * 0.01);
                Some(times[place(error)] * load * libm::expf(noise(&mut chance, deviation) - 1.0))
            });
            assert_steady(&frames);
            assert!(share(&frames[70..]) >= 0.99, "seed {seed}, {deviation}: {}", share(&frames[70..]));
            let mean = frames[70..].iter().map(|(_, time)| f64::from(*time)).sum::<f64>() / 1930.0;
            let least = f64::from(T) * 0.5;
            assert!(mean > least, "seed {seed}, {deviation}: {mean} ms of {T}");
        }
    }

    /// Noise of 4 %, and one frame in 50 that takes three times as long as another program runs: 99 % of the others fit.
    #[test]
    fn noise_changes_little() {
        let times = [1.0, 1.5, 2.2, 2.9, 3.8, 5.0];
        for seed in 0..40 {
            let mut chance = seed;
            let mut budget = TimeBudget::new(T, MAX_ERROR);
            let is_late = |frame: usize| frame % 50 == 17;
            let frames = run(&mut budget, 4000, |frame, error| {
                Some(times[place(error)] * noise(&mut chance, 0.04) * if is_late(frame) { 3.0 } else { 1.0 })
            });
            assert_steady(&frames);
            let others: Vec<(f32, f32)> =
                frames.iter().enumerate().skip(70).filter(|(i, _)| !is_late(*i)).map(|(_, frame)| *frame).collect();
            assert!(share(&others) >= 0.99, "seed {seed}: {}", share(&others));
            // 2 shades take 2.9 ms. 1 shade, which takes 3.8, is tried once in 512 frames. A tenth of its frames is late then,
            // so two of three are with a chance of 0.028, which takes 36 frames in the mean: 7 % of all.
            let at_best = others.iter().filter(|(error, _)| *error == 2.0).count();
            assert!(at_best * 10 >= others.len() * 9, "seed {seed}: {at_best} of {}", others.len());
        }
    }

    /// A scene that turns: its times rise and fall by a half, slowly. 99 % of its frames fit, and most are drawn within
    /// the least error that would.
    #[test]
    fn a_turn_is_followed() {
        let times = [1.6, 2.0, 2.5, 3.1, 3.8, 4.5];
        let mut chance = 5;
        let load = |frame: usize| 1.0 + 0.5 * libm::sinf(frame as f32 * 0.01);
        let mut budget = TimeBudget::new(T, MAX_ERROR);
        let frames =
            run(&mut budget, 6000, |frame, error| Some(times[place(error)] * load(frame) * noise(&mut chance, 0.01)));
        assert_steady(&frames);
        assert!(share(&frames[70..]) >= 0.99, "{}", share(&frames[70..]));
        let is_near = |(frame, (error, _)): (usize, &(f32, f32))| {
            let best = (0..6).rev().find(|at| times[*at] * load(frame) <= 0.85 * T).unwrap_or(0);
            place(*error) >= best
        };
        let near = frames.iter().enumerate().filter(|frame| is_near(*frame)).count();
        assert!(near * 10 >= frames.len() * 9, "{near} of {}", frames.len());
    }

    /// Where the error changes no time there is nothing to gain by a great one.
    #[test]
    fn a_scene_whose_time_the_error_does_not_change_gets_the_least_error() {
        let mut budget = TimeBudget::new(T, MAX_ERROR);
        let frames = run(&mut budget, 1000, |_, _| Some(3.0));
        assert!(frames[40..].iter().all(|(error, _)| *error == 0.5));
        let mut budget = TimeBudget::new(T, MAX_ERROR);
        let frames = run(&mut budget, 1000, |_, _| Some(5.0));
        assert!(frames.iter().all(|(error, _)| *error == MAX_ERROR) && !budget.fits());
    }

    /// A prediction that is wrong now, as the scene is another: it is tried again, seldom, until it fits.
    #[test]
    fn old_predictions_are_tried_again() {
        let mut budget = TimeBudget::new(T, MAX_ERROR);
        let early = |error: f32| if error < 4.0 { 9.0 } else { 2.0 };
        run(&mut budget, 600, |_, error| Some(early(error)));
        assert_eq!(budget.error(), 4.0);
        let frames = run(&mut budget, 4000, |_, error| Some(early(error)));
        let tried = frames.iter().filter(|(error, _)| *error < 4.0).count();
        assert!((1..=24).contains(&tried), "{tried} frames");
        run(&mut budget, 40_000, |_, _| Some(2.0));
        assert_eq!(budget.error(), 0.5);
    }

    /// A picture that stands still is refined to the least error, and drawn again only for that.
    #[test]
    fn a_still_picture_is_refined() {
        let mut budget = TimeBudget::new(T, MAX_ERROR);
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

    /// The fewest frames: one time, no time, and none at all.
    #[test]
    fn a_clock_that_stands_still_chooses_the_least_error() {
        let mut budget = TimeBudget::new(T, 3.0);
        assert_eq!((budget.error(), budget.fits()), (3.0, true));
        budget.took(None);
        assert_eq!((budget.error(), budget.fits()), (3.0, true));
        let frames = run(&mut budget, 200, |_, _| Some(0.0));
        assert_eq!(frames.last(), Some(&(0.5, 0.0)));
    }
}
