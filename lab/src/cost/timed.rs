//! Frames against the clock: a pace chooses the smallest error that fits in a given time, learning from the times of
//! its frames.

use core::time::Duration;

use super::accuracy::Results;
use super::clock::Clock;
use super::configuration::BUDGETS;
use super::interleaved::Spent;
use super::{CostError, TimeRow};
use mode13h::plan::Effect;
use mode13h::render::{Pace, RenderError, Renderer, Stats};
use mode13h::scene::Scene;
use mode13h::vga::Vga;

/// Frames after which every error has been tried.
const CALIBRATION: usize = 48;

/// The minimum and maximum number of frames that are timed for one time limit.
const FRAMES: (usize, usize) = (200, 20_000);

/// Number of times that a study chooses errors for.
const TIMES: i32 = 5;

/// How far a frame may exceed its time, as a ratio.
const TOLERANCE: f64 = 1.05;

/// Draws a frame within the error that the pace chooses, reports the time to the pace, and returns it in milliseconds.
///
/// # Errors
/// See [`Renderer::draw`].
pub fn time_frame(
    (renderer, pace): (&mut Renderer, &mut Pace),
    scene: &Scene,
    vga: &mut Vga,
    clock: Clock,
) -> Result<(Stats, f64), RenderError> {
    renderer.settings.accuracy = Some(pace.accuracy());
    let start = (clock.now)();
    let stats = renderer.draw(scene, vga)?;
    let time = (clock.now)().saturating_sub(start);
    pace.report(&stats, time);
    Ok((stats, time.as_secs_f64() * 1000.0))
}

/// Draws a frame as often as it takes to try every error, so that the pace is ready for the next frame.
///
/// # Errors
/// See [`Renderer::draw`].
pub fn calibrate(
    (renderer, pace): (&mut Renderer, &mut Pace),
    scene: &Scene,
    vga: &mut Vga,
    clock: Clock,
) -> Result<(), RenderError> {
    // Forces every frame to be drawn, though nothing moves.
    renderer.force(Effect::Transform, Some(true));
    let mut frames = (0..=CALIBRATION).map(|_| time_frame((renderer, pace), scene, vga, clock));
    let tried = frames.try_for_each(|frame| frame.map(|_| ()));
    renderer.force(Effect::Transform, None);
    tried
}

/// Frames drawn for several time limits, from the time of the cheapest budget to that of the most expensive. Empty for
/// a vertex path that supports no budget.
pub(super) fn timed_rows(
    frames: &[Scene],
    base: &dyn Fn() -> Renderer,
    budgets: &[(f64, &Results)],
    spent: &Spent,
    progress: &dyn Fn(f64),
) -> Result<Vec<TimeRow>, CostError> {
    let shortest = budgets.iter().map(|(time, _)| *time).fold(f64::INFINITY, f64::min);
    let longest = 1.15 * budgets.iter().map(|(time, _)| *time).fold(0.0, f64::max);
    let mut rows = Vec::new();
    if budgets.is_empty() {
        return Ok(rows);
    }
    for i in 0..TIMES {
        let share = f64::from(i) / f64::from(TIMES - 1);
        let max_time = shortest * (longest / shortest).powf(share);
        let mut renderer = base();
        // `max_time` is in nanoseconds.
        let mut pace = Pace::new(Duration::from_nanos(max_time as u64));
        if let Some(row) = timed_row(frames, (&mut renderer, &mut pace), max_time, budgets, spent)? {
            rows.push(row);
        }
        progress(f64::from(i + 1) / f64::from(TIMES));
    }
    Ok(rows)
}

fn timed_row(
    frames: &[Scene],
    (renderer, pace): (&mut Renderer, &mut Pace),
    max_time: f64,
    budgets: &[(f64, &Results)],
    spent: &Spent,
) -> Result<Option<TimeRow>, CostError> {
    let mut vga = Vga::new();
    renderer.force(Effect::Transform, Some(true));
    let fits = BUDGETS.into_iter().zip(budgets).filter(|(_, (time, _))| *time <= max_time);
    let least_that_fits = fits.map(|(error, _)| error).reduce(f64::min);
    let mut row = TimeRow { max_time, least_that_fits, ..TimeRow::default() };
    let (mut within, mut sum, mut taken) = (0, 0.0, 0.0);
    for number in 0..CALIBRATION + FRAMES.1 {
        let place = number % frames.len();
        let (stats, milliseconds) = time_frame((renderer, pace), &frames[place], &mut vga, spent.clock)?;
        let Some(error) = stats.max_error.map(f64::from) else { return Ok(None) };
        taken += milliseconds / 1000.0;
        if number < CALIBRATION {
            continue;
        }
        row.frames += 1;
        within += usize::from(milliseconds * 1e6 <= TOLERANCE * max_time);
        sum += error;
        row.mean_time += milliseconds * 1e6;
        row.max_error = row.max_error.max(error);
        let bound = BUDGETS.iter().position(|budget| *budget == error);
        if let Some(worst) = bound.and_then(|bound| budgets.get(bound)?.1.worst.get(place)) {
            row.largest = row.largest.max(*worst);
        }
        if row.frames >= FRAMES.0 && taken >= spent.seconds / f64::from(TIMES) {
            break;
        }
    }
    row.within = within as f64 / row.frames as f64;
    row.mean_error = sum / row.frames as f64;
    row.mean_time /= row.frames as f64;
    Ok(Some(row))
}
