//! Times of all configurations, interleaved round by round.
//!
//! A round draws all frames with every configuration, in an order reshuffled every round, so that no configuration
//! always runs on a warm processor, or always after the same other one. A configuration that takes at least twenty
//! times as long as the fastest one before it sits out up to three rounds of four, or the others would get too few
//! rounds. Nothing is subtracted. Every frame is drawn: no renderer here skips a frame because nothing has changed
//! since the last one ([`Effect::Transform`] is forced on). The time of a budget therefore includes its decisions, even
//! for an object that stands still.

use core::fmt::Write as _;
use core::hint::black_box;
use core::mem::size_of;
use std::borrow::Cow;
use std::time::Instant;

use super::clock::Clock;
use super::configuration::{Configuration, Kind};
use super::statistics::Ratio;
use mode13h::plan::Effect;
use mode13h::plan::FaceShading;
use mode13h::render::{RenderError, Renderer};
use mode13h::scene::Scene;
use mode13h::vga::Vga;
use mode13h_conformance::Random;

/// The minimum number of rounds if time allows, the minimum in any case, and the maximum.
const ROUNDS: (usize, usize, usize) = (25, 7, 2001);

/// Ratios whose intervals are wider than this share of the ratio get twice the time.
const NARROW: f64 = 0.02;

/// One measured time.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Sample {
    round: usize,
    /// Its position in the round, from 0.
    order: usize,
    way: usize,
    /// Time for all frames of the round.
    nanoseconds: f64,
}

/// All times of a study, in the order they were taken.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Samples {
    /// Kind and name of each configuration.
    ways: Vec<(&'static str, String)>,
    frames: usize,
    list: Vec<Sample>,
}

const _: () = assert!(size_of::<Sample>() <= 32, "a long study keeps some 100,000");

impl Samples {
    /// Writes the samples as comma-separated values under a line of headings.
    ///
    /// The columns are the round, the position in the round, the configuration (kind and name), the number of frames,
    /// and the time for all of them in nanoseconds.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut text = String::from("round,order,kind,name,frames,ns\n");
        for Sample { round, order, way, nanoseconds } in &self.list {
            let (kind, name) = &self.ways[*way];
            let (kind, name) = (cell(kind), cell(name));
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{round},{order},{kind},{name},{},{nanoseconds:.0}", self.frames);
        }
        text
    }

    /// One configuration's time per frame, round by round; NaN where it sat out.
    pub(super) fn of(&self, way: usize) -> Vec<f64> {
        let mut times = vec![f64::NAN; self.rounds()];
        for sample in self.list.iter().filter(|sample| sample.way == way) {
            times[sample.round] = sample.nanoseconds / self.frames.max(1) as f64;
        }
        times
    }

    /// Number of rounds.
    pub(super) fn rounds(&self) -> usize {
        self.list.last().map_or(0, |sample| sample.round + 1)
    }
}

/// A cell of comma-separated values: text that contains a comma is quoted (RFC 4180). No name contains a quotation
/// mark.
fn cell(text: &str) -> Cow<'_, str> {
    if text.contains(',') { Cow::Owned(format!("\"{text}\"")) } else { Cow::Borrowed(text) }
}

/// The work of drawing all frames, independent of time.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(super) struct Work {
    pub(super) triangles: u64,
    pub(super) pixels: u64,
    pub(super) shares: [u64; FaceShading::ALL.len()],
}

/// One configuration, ready to draw.
struct Candidate<'a> {
    renderer: Renderer,
    scenes: &'a [Scene],
    work: Work,
    /// It draws in every round whose number is divisible by this.
    every: usize,
}

impl Candidate<'_> {
    /// Draws all frames; returns the time in nanoseconds.
    fn draw(&mut self, vga: &mut Vga, clock: Clock) -> Result<f64, RenderError> {
        let (time, result) = clock.time(|| {
            self.scenes.iter().try_for_each(|scene| {
                black_box(self.renderer.draw(scene, vga)?);
                Ok(())
            })
        });
        result.map(|()| time)
    }

    /// Draws all frames and counts the work.
    fn count(&mut self, vga: &mut Vga) -> Result<(), RenderError> {
        self.work = Work::default();
        for scene in self.scenes {
            let stats = self.renderer.draw(scene, vga)?;
            debug_assert!(stats.redrawn, "every frame is drawn");
            self.work.triangles += stats.drawn;
            self.work.pixels += u64::from(stats.raster.pixels);
            for (count, shading) in self.work.shares.iter_mut().zip(FaceShading::ALL) {
                *count += stats.shares[shading];
            }
        }
        Ok(())
    }
}

/// A renderer that draws every frame, changed or not.
pub(super) fn always_drawing(mut renderer: Renderer) -> Renderer {
    renderer.force(Effect::Transform, Some(true));
    renderer
}

/// Settings of an interleaved benchmark.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spent {
    pub(super) clock: Clock,
    /// Roughly how long to measure.
    pub(super) seconds: f64,
    /// True if `seconds` is a limit, not to be exceeded for the sake of ratios that are still too uncertain.
    pub(super) at_most: bool,
    /// Seed of the shuffled order.
    pub(super) seed: u64,
}

/// Outcome of an interleaved benchmark.
pub(super) struct Outcome {
    pub(super) samples: Samples,
    /// One per configuration.
    pub(super) work: Vec<Work>,
}

/// Times all configurations on their frames (the same number for each) for about as long as `spent` says. That may grow
/// to four times as long to reach 25 rounds, and to twice as long while a shading's or a budget's ratio to the first
/// configuration is not known to 2 %. If `spent` sets a limit, it takes that long, or seven rounds if those take
/// longer. `progress` is told the share of the time that has passed.
pub(super) fn run_interleaved(
    ways: &[(&Configuration<'_>, &[Scene])],
    base: &dyn Fn() -> Renderer,
    spent: &Spent,
    progress: &dyn Fn(f64),
) -> Result<Outcome, RenderError> {
    let mut chance = Random::again(spent.seed);
    let seconds = spent.seconds;
    // All draw on the same VGA, so that none has its memory in a better place.
    let mut vga = Vga::new();
    let mut contenders: Vec<Candidate<'_>> = ways
        .iter()
        .map(|(way, scenes)| Candidate {
            renderer: always_drawing(way.apply(base())),
            scenes,
            work: Work::default(),
            every: 1,
        })
        .collect();
    // Warm up: builds tables, allocates memory, fills the caches.
    let mut least = f64::INFINITY;
    for contender in &mut contenders {
        contender.count(&mut vga)?;
        // The minimum of three, as a one-off interruption will not hit all three.
        let mut time = f64::INFINITY;
        for _ in 0..3 {
            time = time.min(contender.draw(&mut vga, spent.clock)?);
        }
        least = least.min(time);
        // At most 4.
        contender.every = (time / least / 10.0).clamp(1.0, 4.0) as usize;
    }
    let mut samples = Samples {
        ways: ways.iter().map(|(way, _)| (way.kind.name(), way.name.clone())).collect(),
        frames: ways.first().map_or(0, |(_, scenes)| scenes.len()),
        list: Vec::new(),
    };
    let mut order: Vec<usize> = (0..contenders.len()).collect();
    let start = Instant::now();
    for round in 0..ROUNDS.2 {
        let elapsed = start.elapsed().as_secs_f64();
        progress((elapsed / seconds).min(1.0));
        let enough = match round {
            round if round < ROUNDS.1 => false,
            _ if spent.at_most => elapsed >= seconds,
            round if round < ROUNDS.0 => elapsed >= 4.0 * seconds,
            _ => {
                elapsed >= 2.0 * seconds
                    || (elapsed >= seconds && round.is_multiple_of(8) && is_narrow(ways, &samples, spent.seed))
            }
        };
        if enough {
            break;
        }
        chance.shuffle(&mut order);
        let draws = order.iter().filter(|way| round.is_multiple_of(contenders[**way].every));
        for (place, way) in draws.copied().collect::<Vec<usize>>().into_iter().enumerate() {
            let nanoseconds = contenders[way].draw(&mut vga, spent.clock)?;
            samples.list.push(Sample { round, order: place, way, nanoseconds });
        }
    }
    Ok(Outcome { samples, work: contenders.iter().map(|contender| contender.work).collect() })
}

/// Returns whether all the ratios of interest are known well enough.
fn is_narrow(ways: &[(&Configuration<'_>, &[Scene])], samples: &Samples, seed: u64) -> bool {
    let mut chance = Random::again(seed);
    let first = samples.of(0);
    ways.iter().enumerate().all(|(i, (way, _))| {
        matches!(way.kind, Kind::Choice(_)) || Ratio::new(&samples.of(i), &first, &mut chance).spread() <= NARROW
    })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::cost::Aspect;
    use mode13h::mesh::shapes;
    use mode13h::settings::Shading;

    #[test]
    fn a_name_with_a_comma_is_one_cell() {
        let sample = Sample { round: 3, order: 1, way: 0, nanoseconds: 70.4 };
        let ways = vec![(Aspect::PortableShading.name(), String::from("flat"))];
        let samples = Samples { ways, frames: 2, list: vec![sample] };
        assert_eq!(samples.to_csv().lines().nth(1), Some("3,1,\"shading, portable kernel\",flat,2,70"));
    }

    /// Even in a scene where nothing moves, every frame pays for its vertices and, with a budget, for the decisions.
    #[test]
    fn decisions_of_a_budget_are_made_in_every_frame() {
        let mut scene = Scene::showing(shapes::torus(12, 6));
        scene.add(mode13h::scene::Object::new(shapes::sphere(8, 5)));
        let mut vga = Vga::new();
        let mut decided = |mut renderer: Renderer| {
            [(); 3].map(|()| renderer.draw(&scene, &mut vga).map(|stats| (stats.redrawn, stats.decided)))
        };
        let timed = decided(always_drawing(Configuration::budget(4.0).apply(Renderer::new())));
        assert_eq!(timed, [(); 3].map(|()| Ok((true, 2))));
        let kept = decided(Configuration::budget(4.0).apply(Renderer::new()));
        assert_eq!(kept, [Ok((true, 2)), Ok((false, 0)), Ok((false, 0))]);
        let without = decided(always_drawing(Configuration::shading(Shading::Phong).apply(Renderer::new())));
        assert_eq!(without, [(); 3].map(|()| Ok((true, 0))));
    }

    #[test]
    fn every_way_draws_every_frame_in_every_round() {
        let frames = [Scene::showing(shapes::torus(12, 6)), Scene::showing(shapes::torus(12, 6))];
        let ways = [
            Configuration::shading(Shading::Gouraud88),
            Configuration::shading(Shading::Phong),
            Configuration::budget(4.0),
        ];
        let ways: Vec<(&Configuration<'_>, &[Scene])> = ways.iter().map(|way| (way, &frames[..])).collect();
        let spent = Spent { clock: Clock::WALL, seconds: 0.001, at_most: false, seed: 1 };
        let outcome = run_interleaved(&ways, &Renderer::new, &spent, &|_| {});
        let Outcome { samples, work } = outcome.expect("a scene that can be drawn");
        let rounds = samples.rounds();
        assert!(rounds >= 7, "{rounds}");
        for round in samples.list.chunk_by(|a, b| a.round == b.round) {
            let drawn: BTreeSet<usize> = round.iter().map(|sample| sample.way).collect();
            // A slow configuration may sit out.
            assert!(drawn.len() == round.len() && drawn.contains(&0), "{round:?}");
            assert!(round.iter().map(|sample| sample.order).eq(0..round.len()));
        }
        assert!((0..3).all(|way| samples.of(way).iter().all(|time| *time > 0.0 || time.is_nan())));
        let rounds = samples.list.chunk_by(|a, b| a.round == b.round);
        let orders: BTreeSet<Vec<usize>> =
            rounds.map(|round| round.iter().map(|sample| sample.way).collect()).collect();
        assert!(orders.len() > 1, "shuffled");
        assert!(work.iter().all(|work| work.triangles > 0 && work.shares.iter().sum::<u64>() == work.triangles));
        let csv = samples.to_csv();
        assert_eq!(csv.lines().count(), 1 + samples.list.len());
        assert!(csv.lines().any(|line| line.contains(",shading,gouraud-8.8,2,")), "{csv}");
    }
}
