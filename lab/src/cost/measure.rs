//! A study: errors, times and what follows from them.

use super::accuracy::{Referee, Results};
use super::claims::claims;
use super::clock::Clock;
use super::configuration::{BUDGETS, Configuration, Kind, REFERENCE};
use super::interleaved::{Outcome, Samples, Spent, run_interleaved};
use super::promises::PROMISE;
use super::split::split;
use super::statistics::{Ratio, quartiles};
use super::timed::timed_rows;
use super::{Aspect, BudgetRow, CostError, Host, OptionRow, ShadingRow, Split, Study};
use mode13h::plan::Effect;
use mode13h::plan::FaceShading;
use mode13h::render::{Renderer, Screen};
use mode13h::scene::Scene;
use mode13h::settings::DitherPattern;
use mode13h::settings::{Shading, VertexPath};
use mode13h_conformance::Random;

/// Subject of a study.
pub struct Subject<'a> {
    /// Its name.
    pub name: &'a str,
    /// Frames spread over one whole turn of the subject; at least one.
    pub frames: &'a [Scene],
    /// Frames 0.25° of a turn apart, for measuring swim; may be empty.
    pub steps: &'a [Scene],
    /// Makes renderers with all settings except the shading: kernel, vertex path and so on.
    pub renderer: &'a (dyn Fn() -> Renderer + Sync),
}

/// Settings of a study.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The shadings to study. `gouraud-8.8` is always drawn, since ratios are relative to it.
    pub shadings: Vec<Shading>,
    /// True to compare vertex paths, vertex rounding, kernels, dither and hidden-surface methods too.
    pub choices: bool,
    /// True to measure the sources' claims, on scenes of their own.
    pub claims: bool,
    /// Clock that times are read from.
    pub clock: Clock,
    /// Roughly how long to time; up to twice as long while ratios are too uncertain.
    pub seconds: f64,
    /// True if `seconds` is a hard limit (at least seven rounds).
    pub at_most: bool,
    /// Seed of the drawing order and of resampling.
    pub seed: u64,
    /// The machine and the program, as the report should name them. The clock's name and step are filled in here.
    pub host: Host,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            shadings: Shading::ALL.to_vec(),
            choices: true,
            claims: true,
            clock: Clock::WALL,
            seconds: 10.0,
            at_most: false,
            seed: 13,
            host: Host::default(),
        }
    }
}

/// Steps of a study.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Step {
    /// Comparing frames with the truth.
    Errors,
    /// Timing frames.
    Times,
    /// Splitting the time of a frame into parts.
    Split,
    /// Drawing with the least error that fits in a given time.
    Goals,
    /// Measuring the sources' claims.
    Claims,
}

/// Measures what accuracy costs. `progress` is told the current step and the share of it that is done, 0 to 1, possibly
/// from several threads at once.
///
/// Errors are measured first, on all processors; then times are taken, on one.
///
/// ```no_run
/// use mode13h_lab::cost::{Settings, Subject, measure};
/// use mode13h::mesh::shapes;
/// use mode13h::render::Renderer;
/// use mode13h::scene::Scene;
///
/// let frames = [Scene::showing(shapes::torus(48, 24))];
/// let subject = Subject { name: "torus", frames: &frames, steps: &[], renderer: &Renderer::new };
/// let (study, _) = measure(&subject, &Settings::default(), &|_, _| {})?;
/// for row in &study.shadings {
///     println!("{}: {:.0} ns, off by {:.2} at most", row.shading, row.per_frame.median, row.error_lit.max);
/// }
/// # Ok::<(), mode13h_lab::cost::CostError>(())
/// ```
///
/// # Errors
/// A scene that cannot be drawn or probed; no frames.
pub fn measure(
    subject: &Subject<'_>,
    settings: &Settings,
    progress: &(dyn Fn(Step, f64) + Sync),
) -> Result<(Study, Samples), CostError> {
    let Subject { name, frames, steps, renderer } = *subject;
    let Settings { shadings, choices: with_choices, claims: with_claims, clock, seconds, at_most, seed, host } =
        settings;
    if frames.is_empty() {
        return Err(CostError::NoFrames);
    }
    let spent = |share: f64| Spent { clock: *clock, seconds: share * seconds, at_most: *at_most, seed: *seed };
    let mut shadings = shadings.clone();
    let is_integer = renderer().settings.vertex_path == Some(VertexPath::Integer);
    if is_integer {
        // The integer path would draw others by the default shading.
        shadings.retain(|shading| shading.in_integers() == *shading);
    }
    let mut ways = Configuration::shadings_and_budgets(&shadings);
    // Nor does it support a budget.
    ways.retain(|way| !is_integer || !matches!(way.kind, Kind::Budget(_)));
    if *with_choices {
        ways.extend(choices(frames, renderer, &shadings)?);
    }
    let court = Referee { ways: &ways, base: renderer, frames, steps };
    let findings = court.judge(&|share| progress(Step::Errors, share))?;

    let dithered: Vec<Option<Vec<Scene>>> =
        ways.iter().map(|way| way.dither.map(|dither| with_dither(frames, dither))).collect();
    let entrants: Vec<(&Configuration<'_>, &[Scene])> =
        ways.iter().zip(&dithered).map(|(way, dithered)| (way, dithered.as_deref().unwrap_or(frames))).collect();
    let outcome = run_interleaved(&entrants, renderer, &spent(0.5), &|share| progress(Step::Times, share))?;
    let of_shadings: Vec<&Configuration<'_>> = ways.iter().filter(|way| matches!(way.kind, Kind::Shading(_))).collect();
    let splits = split(&of_shadings, frames, renderer, &spent(0.25), &|share| progress(Step::Split, share))?;

    let claims = if *with_claims {
        // Claims are about shadings at their defaults, whatever was asked for here.
        let kernel = renderer().kernel;
        let plain = move || {
            let mut renderer = Renderer::new();
            renderer.kernel = kernel;
            renderer
        };
        claims(&plain, &spent(0.25), &|share| progress(Step::Claims, share))?
    } else {
        Vec::new()
    };

    let times = (0..ways.len()).map(|way| outcome.samples.of(way)).collect();
    let rows = Rows { ways: &ways, times, findings, outcome: &outcome, seed: *seed };
    let mut of_shadings = rows.shadings(&splits, frames.len());
    let budget = rows.budgets();
    let by_time: Vec<(f64, &Results)> =
        rows.of_budgets().map(|(place, _)| (quartiles(&rows.times[place]).median, &rows.findings[place])).collect();
    let times = timed_rows(frames, renderer, &by_time, &spent(0.25), &|share| progress(Step::Goals, share))?;
    of_shadings.retain(|row| shadings.contains(&row.shading));
    let study = Study {
        input: name.to_string(),
        host: Host { clock: clock.name.to_string(), clock_step: clock.step(), ..host.clone() },
        kernel: renderer().kernel.to_string(),
        frames: frames.len(),
        rounds: outcome.samples.rounds(),
        shadings: of_shadings,
        budget,
        times,
        options: rows.choices(),
        claims,
    };
    Ok((study, outcome.samples))
}

/// The choices that this scene can be drawn with.
fn choices(
    frames: &[Scene],
    base: &dyn Fn() -> Renderer,
    shadings: &[Shading],
) -> Result<Vec<Configuration<'static>>, CostError> {
    let mut ways = Vec::new();
    for way in Configuration::choices(shadings) {
        let mut renderer = way.apply(base());
        let mut drawable = true;
        for scene in frames {
            match renderer.for_each_triangle(scene, Screen::MODE_13H, |_, _| {}) {
                Ok(_) => {}
                // f32 can represent numbers that 16.16 cannot.
                Err(_) if way.kind == Kind::Choice(Aspect::VertexPath) => drawable = false,
                Err(error) => return Err(error.into()),
            }
            // With three channels dither works on the mixed colour, not on a ramp.
            drawable &= way.dither.is_none() || !renderer.plan().is_on_anywhere(Effect::RgbChannels);
        }
        if drawable {
            ways.push(way);
        }
    }
    Ok(ways)
}

/// The frames with this dither or none.
fn with_dither(frames: &[Scene], dither: Option<DitherPattern>) -> Vec<Scene> {
    let mut frames = frames.to_vec();
    frames.iter_mut().for_each(|scene| scene.settings.dither = dither);
    frames
}

/// Results, configuration by configuration.
struct Rows<'a> {
    ways: &'a [Configuration<'a>],
    /// Time per frame, round by round.
    times: Vec<Vec<f64>>,
    findings: Vec<Results>,
    outcome: &'a Outcome,
    seed: u64,
}

impl Rows<'_> {
    fn ratio(&self, way: usize, to: usize) -> Ratio {
        Ratio::new(&self.times[way], &self.times[to], &mut Random::again(self.seed))
    }

    /// Indices of the configurations for which `of` returns something, and what.
    fn each<T>(&self, of: impl Fn(Kind) -> Option<T>) -> impl Iterator<Item = (usize, T)> {
        self.ways.iter().enumerate().filter_map(move |(i, way)| Some((i, of(way.kind)?)))
    }

    /// Indices and names of the shadings.
    fn each_shading(&self) -> impl Iterator<Item = (usize, Shading)> {
        self.each(|kind| if let Kind::Shading(shading) = kind { Some(shading) } else { None })
    }

    /// A row for each shading drawn.
    fn shadings(&self, splits: &[Split], frames: usize) -> Vec<ShadingRow> {
        // The reference is always drawn.
        let reference = self.each_shading().find(|(_, shading)| *shading == REFERENCE).map_or(0, |(place, _)| place);
        let mut rows = Vec::new();
        for ((place, shading), split) in self.each_shading().zip(splits) {
            let findings = &self.findings[place];
            let per_frame = quartiles(&self.times[place]);
            let work = &self.outcome.work[place];
            // Pixel and triangle counts of a few frames: below 2⁵³.
            let of_each = |count: u64| per_frame.median * frames as f64 / count.max(1) as f64;
            let ratio = self.ratio(place, reference);
            let as_fast = |(other, name): (usize, Shading)| {
                (other != place && self.ratio(place, other).cannot_be_told()).then_some(name)
            };
            rows.push(ShadingRow {
                shading,
                per_frame,
                per_pixel: of_each(work.pixels),
                per_triangle: of_each(work.triangles),
                ratio: ratio.median,
                ratio_interval: ratio.interval,
                split: *split,
                instructions: None,
                error_gouraud: findings.gouraud.errors(),
                error_lit: findings.lit.errors(),
                error_palette: findings.entries.most,
                cover_errors: findings.gouraud.cover_errors,
                not_compared: findings.lit.share_not_compared(),
                excess: findings.excess,
                swim: findings.swim.rms(),
                efficient: true,
                as_fast_as: self.each_shading().filter_map(as_fast).collect(),
                picture: findings.picture.clone(),
                error_map: findings.error_map.clone(),
            });
        }
        mark_efficient(&mut rows);
        rows
    }

    /// Indices and errors of the budgets, in the order of [`BUDGETS`].
    fn of_budgets(&self) -> impl Iterator<Item = (usize, f64)> {
        self.each(|kind| if let Kind::Budget(shades) = kind { Some(shades) } else { None })
    }

    fn budgets(&self) -> Vec<BudgetRow> {
        let row = |(bound, (place, max_error)): (usize, (usize, f64))| {
            let findings = &self.findings[place];
            let keeps = |&(other, shading): &(usize, Shading)| {
                shading.has_exact_cover() && self.findings[other].within(bound) >= PROMISE
            };
            let median = |&(other, _): &(usize, Shading)| quartiles(&self.times[other]).median;
            let best = self.each_shading().filter(keeps).min_by(|a, b| median(a).total_cmp(&median(b)));
            let shares = FaceShading::ALL.into_iter().zip(self.outcome.work[place].shares);
            BudgetRow {
                max_error,
                within: findings.within(bound),
                not_compared: findings.lit.share_not_compared(),
                largest: findings.lit.errors().max,
                rms: findings.lit.errors().rms,
                patch: findings.kept[bound].patch,
                swim: findings.swim.rms(),
                per_frame: quartiles(&self.times[place]),
                best_single_shading: best.map(|(_, shading)| shading),
                best_single: best.map(|(other, _)| quartiles(&self.times[other])),
                ratio: best.map(|(other, _)| {
                    let ratio = self.ratio(place, other);
                    (ratio.median, ratio.interval)
                }),
                triangles: shares.filter(|(_, triangles)| *triangles > 0).collect(),
            }
        };
        (0..BUDGETS.len()).zip(self.of_budgets()).map(row).collect()
    }

    fn choices(&self) -> Vec<OptionRow> {
        let chosen: Vec<(usize, Aspect)> =
            self.each(|kind| if let Kind::Choice(aspect) = kind { Some(aspect) } else { None }).collect();
        let row = |&(place, aspect): &(usize, Aspect)| {
            let first = chosen.iter().find(|(_, of)| *of == aspect).map_or(place, |(first, _)| *first);
            let ratio = self.ratio(place, first);
            OptionRow {
                aspect,
                name: self.ways[place].name.clone(),
                per_frame: quartiles(&self.times[place]),
                ratio: (ratio.median, ratio.interval),
                error: self.findings[place].unrounded.errors(),
                cover_errors: self.findings[place].unrounded.cover_errors,
            }
        };
        chosen.iter().map(row).collect()
    }
}

/// Marks the efficient shadings: those for which no other is both faster and at least as near to `lit` in the root mean
/// square. A shading whose time cannot be distinguished does not count as faster, so any that cannot be distinguished
/// from the best counts among the best.
fn mark_efficient(rows: &mut [ShadingRow]) {
    let beats = |a: &ShadingRow, b: &ShadingRow| {
        let tied = b.as_fast_as.contains(&a.shading);
        !tied && a.per_frame.median < b.per_frame.median && a.error_lit.rms <= b.error_lit.rms
    };
    let beaten: Vec<bool> = rows.iter().map(|row| rows.iter().any(|other| beats(other, row))).collect();
    for (row, beaten) in rows.iter_mut().zip(beaten) {
        row.efficient = !beaten;
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    use crate::cost::{Errors, Nanoseconds, ties};

    pub(in crate::cost) fn row(shading: Shading, time: f64, rms: f64, tied: &[Shading]) -> ShadingRow {
        ShadingRow {
            shading,
            per_frame: Nanoseconds { median: time, ..Nanoseconds::default() },
            error_lit: Errors { rms, ..Errors::default() },
            as_fast_as: tied.to_vec(),
            ..ShadingRow::default()
        }
    }

    /// Nanoseconds of six configurations that draw the same frame with the same instructions, one round per row:
    /// `mode13h cost torus --frames 1 --seconds 50` in release, with other work on all processors.
    const RECORDED: &str = include_str!("../../../tests/data/cost_times.csv");

    /// Rounds of a study.
    const ROUNDS: usize = 232;

    /// Compares two shadings, one of which takes `slower` times as long as the other. Returns their ratio, its
    /// interval, and whether the two can be distinguished. Each round is one of the recorded rounds, picked at random,
    /// and in it the shadings take the times of two of the six, also picked at random, so the noise is real and the
    /// only difference is the planted one.
    fn told(recorded: &[Vec<f64>], slower: f64, chance: &mut Random) -> (f64, (f64, f64), bool) {
        let mut times = vec![Vec::new(), Vec::new()];
        for _ in 0..ROUNDS {
            let round = &recorded[chance.below(recorded.len())];
            let one = chance.below(round.len());
            let other = (one + 1 + chance.below(round.len() - 1)) % round.len();
            times[0].push(round[one]);
            times[1].push(round[other] * slower);
        }
        let ways = [Configuration::shading(REFERENCE), Configuration::shading(Shading::Gouraud1616)];
        let outcome = Outcome { samples: Samples::default(), work: vec![Default::default(); 2] };
        // Below 2⁶³.
        let seed = chance.below(usize::MAX) as u64;
        let rows = Rows { ways: &ways, times, findings: vec![Results::default(); 2], outcome: &outcome, seed };
        let shadings = rows.shadings(&[Split::default(); 2], 1);
        let study = Study { shadings, ..Study::default() };
        (study.shadings[1].ratio, study.shadings[1].ratio_interval, ties(&study).is_empty())
    }

    fn recorded() -> Vec<Vec<f64>> {
        let numbers = |line: &str| line.split(',').map(|time| time.parse().expect("a time")).collect();
        RECORDED.lines().skip(1).map(numbers).collect()
    }

    /// Tests that the slowdown and its size are found: 95 of 100 intervals contain it, with a standard deviation of
    /// √(100 · 0.95 · 0.05) = 2.2, so at least 88 do, which is three standard deviations less.
    #[test]
    fn a_slowdown_of_a_twentieth_is_found() {
        let (recorded, mut chance) = (recorded(), Random::again(13));
        let (mut found, mut held) = (0, 0);
        for _ in 0..100 {
            let (ratio, (low, high), told) = told(&recorded, 1.05, &mut chance);
            found += u32::from(told && ratio > 1.0);
            held += u32::from(low <= 1.05 && 1.05 <= high);
        }
        assert!(found >= 95 && held >= 88, "found in {found} of 100 studies, and 1.05 in {held} intervals");
    }

    /// Tests that 95 of 100 studies call neither slower: 950 of 1,000 on average, with a standard deviation of √(1000 ·
    /// 0.95 · 0.05) = 6.9, so 929 to 971, which is three standard deviations either way. A 90 % interval would give
    /// 900.
    #[test]
    fn what_takes_the_same_time_is_said_to_be_slower_as_seldom_as_is_promised() {
        let (recorded, mut chance) = (recorded(), Random::again(14));
        let tied = (0..1000).filter(|_| !told(&recorded, 1.0, &mut chance).2).count();
        assert!((929..=971).contains(&tied), "in {tied} of 1000 studies");
    }

    #[test]
    fn a_shading_is_efficient_that_none_beats() {
        use Shading::{Flat, Gouraud88, Gouraud1616, GouraudFloat, Phong};
        let mut rows = [
            row(Flat, 10.0, 9.0, &[]),
            row(Gouraud88, 20.0, 5.0, &[Gouraud1616]),
            // Nearer, and slower only within the noise: the two cannot be ranked.
            row(Gouraud1616, 21.0, 4.5, &[Gouraud88]),
            row(Phong, 90.0, 0.3, &[]),
            // As close to the truth as another one, and slower.
            row(GouraudFloat, 95.0, 4.5, &[]),
        ];
        mark_efficient(&mut rows);
        assert_eq!(rows.each_ref().map(|row| row.efficient), [true, true, true, true, false]);
    }
}
