//! Errors of every configuration against each standard of truth.
//!
//! The truth of a frame is drawn once and shared by all configurations. Frames are compared on all processors; the
//! results do not depend on which thread compared which frame.

use core::sync::atomic::{AtomicUsize, Ordering};
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::thread;

use super::configuration::{BUDGETS, Configuration, Kind};
use super::quantization::Entries;
use super::{CostError, Errors, Probe};
use crate::truth::{ErrorMap, Figures, Shown, Standard, Swim, Truth, TruthFrame};
use mode13h::plan::Effect;
use mode13h::render::{Renderer, Screen};
use mode13h::scene::Scene;
use mode13h::settings::{Shading, VertexPath};

/// Errors over many frames, pixel by pixel and over blocks.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Against {
    pixels: Figures,
    blocks: Figures,
    /// Pixels that show the wrong face.
    pub(super) cover_errors: u64,
}

impl Against {
    fn count(&mut self, map: &ErrorMap) {
        self.pixels.add(&map.figures());
        self.blocks.add(&map.block_figures());
        self.cover_errors += map.cover_errors() as u64;
    }

    fn add(&mut self, other: &Self) {
        self.pixels.add(&other.pixels);
        self.blocks.add(&other.blocks);
        self.cover_errors += other.cover_errors;
    }

    /// Pixels that were compared.
    pub(super) fn pixels(&self) -> u64 {
        self.pixels.count
    }

    /// Share of the covered pixels that were not compared, 0 to 1.
    pub(super) fn share_not_compared(&self) -> f64 {
        // Below 2⁵³: pixels.
        self.cover_errors as f64 / (self.cover_errors + self.pixels()).max(1) as f64
    }

    pub(super) fn errors(&self) -> Errors {
        Errors {
            max: self.pixels.max,
            mean: self.pixels.mean(),
            rms: self.pixels.rms(),
            off_by_one: self.pixels.share_by_one(),
            rms_of_blocks: self.blocks.rms(),
        }
    }
}

/// Rounding error of light evaluated at the pixel: half a shade, 1/512 from the vertices' shades, 1/100 from f32.
const LIT: f64 = 0.52;

/// Rounding error of shades that are linear on the screen, over a frame of 320 columns: half a shade, 1/512 from the
/// vertices' shades, and the drift of the sums. `None` for other shadings, which are not linear on the screen.
const fn linear_rounding(shading: Shading) -> Option<f64> {
    match shading {
        Shading::Gouraud88 => Some(1.752),
        Shading::Gouraud88Reseeded => Some(0.752),
        Shading::Gouraud1616 => Some(0.507),
        _ => None,
    }
}

/// Pixels of one configuration within an error bound.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Kept {
    /// Pixels within the bound.
    pub(super) within: u64,
    /// Number of pixels in the largest patch beyond it.
    pub(super) patch: usize,
}

/// Results of one configuration over many frames.
#[derive(Clone, Debug, Default)]
pub(super) struct Results {
    pub(super) gouraud: Against,
    /// Against the truth with unrounded vertices.
    pub(super) unrounded: Against,
    pub(super) lit: Against,
    /// Pixels within each of [`BUDGETS`].
    pub(super) kept: [Kept; BUDGETS.len()],
    pub(super) entries: Entries,
    pub(super) swim: Swim,
    /// How far the worst pixel exceeds its shading's bound, in shades, negative if none does; `None` without a bound.
    pub(super) excess: Option<f64>,
    /// Each frame's largest error against `lit`, not counting what vertex rounding explains.
    pub(super) worst: Vec<f64>,
    /// The shades of the first frame; `error_map` holds its errors against `lit`.
    pub(super) picture: Vec<u8>,
    pub(super) error_map: Vec<f32>,
}

impl Results {
    /// Share of pixels within a bound of [`BUDGETS`] of `lit`, or within the rounding error of a byte if that is
    /// larger, not counting what vertex rounding explains; 1 if none were compared.
    pub(super) fn within(&self, bound: usize) -> f64 {
        let all = self.lit.pixels.count;
        // Below 2⁵³: pixels.
        if all == 0 { 1.0 } else { self.kept[bound].within as f64 / all as f64 }
    }

    fn add(&mut self, other: Self) {
        self.gouraud.add(&other.gouraud);
        self.unrounded.add(&other.unrounded);
        self.lit.add(&other.lit);
        for (kept, other) in self.kept.iter_mut().zip(other.kept) {
            kept.within += other.within;
            kept.patch = kept.patch.max(other.patch);
        }
        self.entries.add(other.entries);
        self.swim.join(&other.swim);
        self.worst.extend(other.worst);
        self.excess = [self.excess, other.excess].into_iter().flatten().reduce(f64::max);
        if self.picture.is_empty() {
            (self.picture, self.error_map) = (other.picture, other.error_map);
        }
    }
}

/// Results of all configurations on one frame.
type Judged = Result<Vec<Results>, CostError>;

/// The frames and the configurations to compare.
pub(super) struct Referee<'a> {
    pub(super) ways: &'a [Configuration<'a>],
    pub(super) base: &'a (dyn Fn() -> Renderer + Sync),
    /// Frames spread over the whole turn.
    pub(super) frames: &'a [Scene],
    /// Frames 0.25° apart, for measuring swim.
    pub(super) steps: &'a [Scene],
}

impl Referee<'_> {
    /// Compares all configurations with the truth; `progress` is told the share done.
    pub(super) fn judge(&self, progress: &(dyn Fn(f64) + Sync)) -> Result<Vec<Results>, CostError> {
        // One item per frame, and one per pair of steps.
        let items = self.frames.len() + self.steps.len().saturating_sub(1);
        let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let found: Mutex<Vec<(usize, Judged)>> = Mutex::new(Vec::new());
        let work = || {
            let mut probe = Probe::new((self.base)());
            loop {
                let item = next.fetch_add(1, Ordering::Relaxed);
                if item >= items {
                    return;
                }
                let findings = match item.checked_sub(self.frames.len()) {
                    None => self.frame(item, &mut probe),
                    Some(step) => self.step(step, &mut probe),
                };
                if findings.is_err() {
                    // No thread starts another item.
                    next.store(items, Ordering::Relaxed);
                }
                found.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push((item, findings));
                progress((done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / items as f64);
            }
        };
        let threads = thread::available_parallelism().map_or(1, usize::from).min(items);
        thread::scope(|scope| {
            for _ in 1..threads {
                scope.spawn(work);
            }
            work();
        });
        let mut found = found.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
        // Float sums depend on their order.
        found.sort_by_key(|(item, _)| *item);
        let mut all: Vec<Results> = self.ways.iter().map(|_| Results::default()).collect();
        for (_, findings) in found {
            for (all, findings) in all.iter_mut().zip(findings?) {
                all.add(findings);
            }
        }
        Ok(all)
    }

    fn look(&self, way: &Configuration<'_>, scene: &Scene, probe: &mut Probe) -> Result<Shown, CostError> {
        *probe.renderer() = way.apply((self.base)());
        probe.dither = way.dither;
        Ok(probe.look(scene, Screen::MODE_13H)?)
    }

    fn frame(&self, index: usize, probe: &mut Probe) -> Result<Vec<Results>, CostError> {
        let scene = &self.frames[index];
        let truth = Truth::new(scene, Screen::MODE_13H)?;
        let (gouraud, lit) = (truth.draw(Standard::Gouraud), truth.draw(Standard::Lit));
        let choices = self.ways.iter().any(|way| matches!(way.kind, Kind::Choice(_)));
        let unrounded = choices.then(|| truth.draw(Standard::GouraudUnrounded));
        // Errors explained by vertex rounding are not held against anyone. The explanation is computed only where an
        // error is large.
        let mut shifts = Shifts { truth: &truth, lit: &lit, known: BTreeMap::new() };
        let linear_error = self.linear_error(scene)?;
        let mut judged = |way: &Configuration<'_>| {
            let shown = self.look(way, scene, probe)?;
            let mut findings = Results::default();
            if let Kind::Choice(_) = way.kind {
                if let Some(map) = unrounded.as_ref().and_then(|truth| ErrorMap::new(truth, &shown)) {
                    findings.unrounded.count(&map);
                }
                return Ok(findings);
            }
            // All have the same size.
            let (Some(numeric), Some(model)) = (ErrorMap::new(&gouraud, &shown), ErrorMap::new(&lit, &shown)) else {
                return Ok(findings);
            };
            findings.gouraud.count(&numeric);
            findings.lit.count(&model);
            let worst = shifts.worst(&model);
            findings.worst.push(worst);
            if let (Kind::Shading(shading), Some(linear_error)) = (way.kind, linear_error) {
                findings.excess = linear_rounding(shading).map(|rounding| worst - linear_error - rounding);
            }
            for (kept, bound) in findings.kept.iter_mut().zip(BUDGETS) {
                let allowed = bound.max(LIT);
                let mut keeps = |(place, error): (usize, f64)| error <= allowed || error <= allowed + shifts.of(place);
                let errors = model.errors().enumerate().filter_map(|(place, error)| Some((place, error?)));
                kept.within = errors.filter(|pair| keeps(*pair)).count() as u64;
                kept.patch = model.largest_patch(bound);
            }
            findings.entries.count(scene, &shown, probe.renderer());
            if index == 0 {
                findings.picture = picture(&shown);
                findings.error_map = model.errors().map(|error| error.map_or(f32::NAN, |error| error as f32)).collect();
            }
            Ok(findings)
        };
        self.ways.iter().map(&mut judged).collect()
    }

    /// The bound that [`Renderer::linear_error`] states for linear shades in a frame, against light at every pixel.
    /// `None` if an object has no bound or is split, and for 16.16 vertices.
    fn linear_error(&self, scene: &Scene) -> Result<Option<f64>, CostError> {
        let mut renderer = (self.base)();
        if renderer.settings.vertex_path == Some(VertexPath::Integer) {
            return Ok(None);
        }
        renderer.settings.accuracy = Some(Shading::Gouraud88Reseeded.into());
        renderer.for_each_triangle(scene, Screen::MODE_13H, |_, _| {})?;
        if renderer.plan().is_on_anywhere(Effect::Tessellation) {
            return Ok(None);
        }
        let seen = (0..scene.objects().len()).filter(|object| scene.is_visible(*object));
        Ok(seen
            .map(|object| renderer.linear_error(scene, object))
            .try_fold(0.0_f64, |most, error| Some(most.max(error?))))
    }

    /// Measures the change from one step to the next.
    fn step(&self, index: usize, probe: &mut Probe) -> Result<Vec<Results>, CostError> {
        let scenes = &self.steps[index..index + 2];
        let mut truths = Vec::new();
        for scene in scenes {
            truths.push(Truth::new(scene, Screen::MODE_13H)?.draw(Standard::Lit));
        }
        let mut all = Vec::new();
        for way in self.ways {
            let mut findings = Results::default();
            if !matches!(way.kind, Kind::Choice(_)) {
                let mut maps = Vec::new();
                for (scene, truth) in scenes.iter().zip(&truths) {
                    maps.extend(ErrorMap::new(truth, &self.look(way, scene, probe)?));
                }
                if let [before, now] = &maps[..] {
                    findings.swim.add(before, now);
                }
            }
            all.push(findings);
        }
        Ok(all)
    }
}

/// How much of the error at each pixel of a frame is explained by vertex rounding.
struct Shifts<'a> {
    truth: &'a Truth<'a>,
    lit: &'a TruthFrame,
    known: BTreeMap<usize, f64>,
}

impl Shifts<'_> {
    /// How far vertex rounding may shift the light at a pixel, in shades.
    fn of(&mut self, place: usize) -> f64 {
        let (truth, lit) = (self.truth, self.lit);
        *self.known.entry(place).or_insert_with(|| {
            // A frame's sides are at most 4,096.
            let (x, y) = (place as u32 % lit.width, place as u32 / lit.width);
            lit.pixels[place].and_then(|pixel| truth.rounding_shift(pixel.face, x, y)).unwrap_or_default()
        })
    }

    /// The largest error beyond that shift.
    fn worst(&mut self, model: &ErrorMap) -> f64 {
        let mut errors: Vec<_> =
            model.errors().enumerate().filter_map(|(place, error)| Some((error?, place))).collect();
        errors.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut worst = 0.0;
        for (error, place) in errors {
            if error <= worst {
                break;
            }
            worst = worst.max(error - self.of(place));
        }
        worst
    }
}

/// Errors of frames drawn by some configurations against one standard, configuration by configuration.
pub(super) fn against(
    standard: Standard,
    frames: &[Scene],
    ways: &[Configuration<'_>],
    base: &dyn Fn() -> Renderer,
) -> Result<Vec<Against>, CostError> {
    let mut all = vec![Against::default(); ways.len()];
    let mut probe = Probe::new(base());
    for scene in frames {
        let truth = Truth::new(scene, Screen::MODE_13H)?.draw(standard);
        for (against, way) in all.iter_mut().zip(ways) {
            *probe.renderer() = way.apply(base());
            let shown = probe.look(scene, Screen::MODE_13H)?;
            if let Some(map) = ErrorMap::new(&truth, &shown) {
                against.count(&map);
            }
        }
    }
    Ok(all)
}

/// Difference between two standards over all frames.
pub(super) fn between(standards: [Standard; 2], frames: &[Scene]) -> Result<Errors, CostError> {
    let mut all = Against::default();
    for scene in frames {
        let truth = Truth::new(scene, Screen::MODE_13H)?;
        let [one, other] = standards.map(|standard| truth.draw(standard));
        let faces = other.pixels.iter().map(|pixel| pixel.map(|pixel| pixel.face)).collect();
        let shades = other.pixels.iter().map(|p| p.map_or([0.0; 3], |p| p.intensity.map(|i| i * 255.0))).collect();
        let shown = Shown { width: other.width, height: other.height, faces, shades };
        if let Some(map) = ErrorMap::new(&one, &shown) {
            all.count(&map);
        }
    }
    Ok(all.errors())
}

/// Shades as entries of a ramp of 256, black where there is no face; of three channels, the brightest.
fn picture(shown: &Shown) -> Vec<u8> {
    let brightest = |shades: &[f64; 3]| shades.iter().copied().fold(0.0, f64::max);
    // Bytes.
    let entry = |(shades, face): (&[f64; 3], &Option<_>)| if face.is_some() { brightest(shades) as u8 } else { 0 };
    shown.shades.iter().zip(&shown.faces).map(entry).collect()
}
