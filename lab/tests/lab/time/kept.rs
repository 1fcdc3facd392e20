//! E1 as a state machine: whatever a caller does between frames, in any order, a reused renderer draws what a fresh one
//! draws, and shows it in the same colours.
//!
//! A run starts with a scene and makes one change after another, each followed by a frame. A failing run is shrunk to
//! the fewest changes that still fail, and printed.

use std::panic::{AssertUnwindSafe, catch_unwind};

use mode13h::palette::Palette;
use mode13h::render::Renderer;
use mode13h::scene::Scene;
use mode13h::vga::Vga;

use super::changes::{CHANGES, EXEMPT, World, in_the_sources, public, start};
use crate::support::tried::Tried;
use mode13h_conformance::Random;

/// Changes in a run.
const STEPS: usize = 40;

/// One change: its index in the list, and the seed of its values.
#[derive(Clone, Copy, Debug)]
struct Step {
    change: usize,
    values: u64,
}

/// A run: the seed of its first scene, and its changes.
#[derive(Clone, Debug)]
struct Run {
    first: u64,
    steps: Vec<Step>,
}

/// What a machine shows.
type Shown = (Vec<u8>, Palette);

impl World {
    fn new(scene: Scene) -> Self {
        let kept = Renderer::new();
        let machines = [Box::new(Vga::new()), Box::new(Vga::new())];
        Self { scene, settings: kept.settings, kernel: kept.kernel, forced: Vec::new(), kept, machines }
    }

    /// Draws with the reused renderer and with a fresh one, over different bytes. Returns what both show, or how they
    /// differ.
    fn draw(&mut self) -> Result<Shown, String> {
        let mut fresh = self.fresh();
        let vga = &mut self.machines[0];
        let before = vga.pixels().to_vec();
        let mut other = vga.clone();
        other.pixels_mut().fill(0xA5);
        let kept = self.kept.draw(&self.scene, vga).map(drop);
        let fresh = fresh.draw(&self.scene, &mut other).map(drop);
        if kept != fresh {
            return Err(format!("{kept:?}, and by a fresh renderer {fresh:?}"));
        }
        if kept.is_err() {
            let as_it_was = vga.pixels() == before;
            return as_it_was.then(|| (before, vga.palette())).ok_or("an error, and pixels changed".to_string());
        }
        let differ = vga.pixels().iter().zip(other.pixels()).filter(|(a, b)| a != b).count();
        if differ > 0 {
            return Err(format!("{differ} pixels are not those of a fresh renderer"));
        }
        if vga.palette() != other.palette() {
            return Err("the colours are not those of a fresh renderer".to_string());
        }
        Ok((vga.pixels().to_vec(), vga.palette()))
    }
}

/// Plays a run. `seen` is told for each change whether the picture changed.
fn play(run: &Run, mut seen: impl FnMut(usize, bool)) -> Result<(), String> {
    let mut world = World::new(start(&mut Random::again(run.first)));
    let mut last = world.draw().map_err(|what| format!("at first: {what}"))?;
    for (number, step) in run.steps.iter().enumerate() {
        let change = &CHANGES[step.change];
        let told = |what| format!("after step {number}, {}: {what}", change.name);
        let frame = catch_unwind(AssertUnwindSafe(|| {
            (change.apply)(&mut world, &mut Random::again(step.values));
            world.draw()
        }));
        let shown = match frame {
            Ok(drawn) => drawn.map_err(told)?,
            Err(panic) => return Err(told(format!("a panic: {}", said(&*panic)))),
        };
        seen(step.change, shown != last);
        last = shown;
    }
    Ok(())
}

fn said(panic: &dyn std::any::Any) -> String {
    let text = panic.downcast_ref::<&str>().map(ToString::to_string);
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default()
}

/// The fewest changes of a run that still fail, and how: pieces are removed as long as it fails without them.
fn shrunk(mut run: Run, mut reason: String) -> (Run, String) {
    let mut piece = run.steps.len();
    while piece > 0 {
        let mut at = 0;
        while at < run.steps.len() {
            let mut less = run.clone();
            less.steps.drain(at..(at + piece).min(run.steps.len()));
            match play(&less, |_, _| {}) {
                Err(still) => (run, reason) = (less, still),
                Ok(()) => at += piece,
            }
        }
        piece /= 2;
    }
    (run, reason)
}

/// Number of frames by which every visible change must have been seen.
const MOST: u64 = 500 * STEPS as u64;

/// Plays runs until the stated number of frames was compared, and each visible change was seen to change the picture:
/// one that is never seen tests nothing. Changes are dealt like cards, so that each occurs equally often, but one that
/// has not been seen yet is in the pack more often: otherwise the last of them would take longer than all the others.
fn run_all(mut tried: Tried) {
    const COPIES_OF_UNSEEN: usize = 8;
    let mut random = Random::named("e1 kept");
    // How often each change was made, and seen.
    let mut counts = vec![(0_u64, 0_u64); CHANGES.len()];
    let mut cards: Vec<usize> = Vec::new();
    let unseen = |counts: &[(u64, u64)]| -> Vec<usize> {
        (0..CHANGES.len()).filter(|&change| CHANGES[change].is_seen && counts[change].1 == 0).collect()
    };
    while tried.stated() > tried.cases() || !unseen(&counts).is_empty() {
        let never: Vec<&str> = unseen(&counts).into_iter().map(|change| CHANGES[change].name).collect();
        assert!(tried.cases() < MOST, "never seen: {never:?}");
        let mut deal = |random: &mut Random| {
            if cards.is_empty() {
                cards.extend(0..CHANGES.len());
                if tried.cases() > 0 {
                    cards.extend(unseen(&counts).repeat(COPIES_OF_UNSEEN));
                }
                random.shuffle(&mut cards);
            }
            cards.pop().expect("changes")
        };
        let first = random.next_u64();
        let steps = (0..STEPS).map(|_| Step { change: deal(&mut random), values: random.next_u64() }).collect();
        let run = Run { first, steps };
        let outcome = play(&run, |change, differs| {
            counts[change].0 += 1;
            counts[change].1 += u64::from(differs);
        });
        if let Err(reason) = outcome {
            let (run, reason) = shrunk(run, reason);
            let names: Vec<&str> = run.steps.iter().map(|step| CHANGES[step.change].name).collect();
            panic!("{reason}\nthe changes: {names:#?}\n{run:?}");
        }
        tried.add(STEPS as u64);
    }
    assert!(counts.iter().all(|(made, _)| *made > 0), "each is made");
}

#[test]
fn e1_any_change_in_any_order() {
    run_all(Tried::new("e1_any_change_in_any_order", 30 * STEPS as u64));
}

#[test]
#[ignore = "the long run: 500 runs of 40 changes"]
fn e1_long_any_change_in_any_order() {
    run_all(Tried::new("e1_long_any_change_in_any_order", MOST));
}

/// Everything that can be changed is in the list.
#[test]
fn e1_every_public_field_is_changed() {
    let mut tried = Tried::new("e1_every_public_field_is_changed", 90);
    let exempt = |name: &str| EXEMPT.iter().any(|(of, _)| *of == name);
    let sources = in_the_sources();
    for name in &sources {
        let changes = CHANGES.iter().filter(|change| change.name == name).count();
        assert_eq!(
            changes,
            usize::from(!exempt(name)),
            "{name}: a change for it belongs into lab/tests/lab/time/changes.rs"
        );
        tried.add(1);
    }
    // Every name of a type in the list exists in the sources.
    let of_a_type = CHANGES.iter().filter(|change| change.name.contains("::") || change.name.contains('.'));
    for name in of_a_type.map(|change| change.name).chain(EXEMPT.map(|(name, _)| name)) {
        assert!(sources.iter().any(|source| source == name), "{name} is in no source");
    }
}

#[test]
fn fields_variants_and_methods_are_found_in_a_source() {
    let source = "\
pub struct Camera {
    /// Where.
    pub eye: Vec3,
    #[cfg(feature = \"std\")]
    pub near: f32,
    kept: u8,
    pub(crate) seen: u8,
}

pub struct Id(usize);

#[derive(Clone)]
pub enum Light {
    /// Far.
    Sun {
        direction: Vec3,
        color: [f32; 3],
    },
    #[default]
    None,
    Lamp(Vec3),
}

impl Camera {
    pub fn eye(&self) -> Vec3 {
        fn inner(&mut self) {}
    }

    pub fn set_eye(&mut self, eye: Vec3) {}

    pub const fn look(
        &mut self,
        at: Vec3,
    ) {
    }

    pub(crate) fn hide(&mut self) {}
}

impl<T> Other for Camera {
    pub fn set_nothing(&mut self) {}
}
";
    let names = "Camera.eye Camera.near Light::Sun.direction Light::Sun.color Light::None Light::Lamp Camera::set_eye Camera::look";
    assert_eq!(public(crate::sources::items(source)), names.split(' ').collect::<Vec<_>>());
}
