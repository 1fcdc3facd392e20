//! `mode13h demo`: a scene, or a model that turns, in a window.

use std::ffi::OsString;
use std::time::Instant;

use clap::Args;
use mode13h::palette::{Palette, builtin};
use mode13h::plan::Effect;
use mode13h::render::{Mapping, Renderer, Rung, Screen, Stats};
use mode13h::span::Kernel;
use mode13h::vga::Vga;
use mode13h::window::{Flow, Input, Key, Window};

use crate::failure::Failure;
use crate::input::Colors;
use crate::options::Drawing;
use crate::overlay::{self, Place};
use crate::stage::{Pose, Stage};
use crate::switches::Switch;
use crate::{input, output};

/// What the help says below the options.
pub(crate) const KEYS: &str = "\
Keys in the window: Esc quits, Space stops and goes on, arrows and mouse turn, wheel and + - zoom, [ and ] step through
the rungs, K next kernel, P next palette, M next mapping of textures; L lights, O fog, T texture and D dither off and on;
S saves a PNG in the current directory, H shows help, the plan and figures.
With no display one frame is saved as a PNG.";

#[derive(Args)]
pub(crate) struct Options {
    #[arg(default_value = "torus", help = input::help())]
    input: OsString,
    #[command(flatten)]
    drawing: Drawing,
}

/// How fast the arrow keys turn, in radians a second.
const ARROW_SPEED: f64 = 2.0;
/// How far one press of an arrow key turns at once, in radians: a tap shorter than a frame shows too.
const ARROW_TAP: f64 = 0.05;
/// How far a drag over one pixel of the frame turns, in radians: half a turn over its width.
const DRAG: f64 = std::f64::consts::PI / Vga::WIDTH as f64;
/// A pixel's height in pixel widths.
const PIXEL_HEIGHT: f64 = Vga::PIXEL_ASPECT.1 as f64 / Vga::PIXEL_ASPECT.0 as f64;
/// How much one notch of the wheel, or one + or -, enlarges.
const NOTCH: f64 = 1.1;
/// The least and the greatest enlargement.
const ZOOM: (f64, f64) = (0.25, 8.0);
/// The longest time that a key counts as held for in one frame, in seconds: nothing is caught up with after a pause.
const LONGEST_FRAME: f64 = 0.1;
/// How long the title shows where a picture was saved, in seconds.
const NOTICE: f64 = 3.0;

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let mut demo = Demo::new(options)?;
    let mut vga = Vga::new();
    let mut window = match Window::open(&demo.name) {
        Ok(window) => window,
        Err(no_display) => {
            demo.draw(&mut vga)?;
            let path = output::numbered_picture(&vga).map_err(Failure::work)?;
            eprintln!("mode13h: {no_display}; one frame is in {}", path.display());
            return Ok(());
        }
    };
    let mut title = String::new();
    loop {
        let wish = demo.follow(window.input(), window.seconds())?;
        demo.draw(&mut vga)?;
        match wish {
            Wish::Nothing => {}
            Wish::Picture => demo.save(&vga),
            Wish::End => return Ok(()),
        }
        let new = demo.title();
        if new != title {
            window.set_title(&new);
            title = new;
        }
        if window.show(&vga).map_err(Failure::work)? == Flow::Close {
            return Ok(());
        }
    }
}

/// What the keys ask for beyond a change of the picture.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Wish {
    Nothing,
    Picture,
    End,
}

struct Demo {
    name: String,
    triangles: usize,
    stage: Stage,
    renderer: Renderer,
    rungs: Choice<Rung>,
    kernels: Choice<Kernel>,
    palettes: Choice<(String, Colors)>,
    /// `None` leaves it to the plan.
    mappings: Choice<Option<Mapping>>,
    motion: Motion,
    help: bool,
    timing: Timing,
    /// Of making the plan, while it is shown.
    planning: Timing,
    stats: Option<Stats>,
    /// What the title says besides, and until when.
    notice: Option<(String, f64)>,
    seconds: f64,
}

impl Demo {
    fn new(options: &Options) -> Result<Demo, Failure> {
        let Options { input, drawing } = options;
        let kernel = drawing.kernel()?;
        let shown = input::input(input)?;
        let name = shown.name().to_string();
        let of_model = matches!(shown, input::Input::Model(_));
        let stage = drawing.stage(shown)?;
        let rung = drawing.rung(stage.scene.wishes.rung);
        // A palette without ramps has no order of shades: what has no colours of its own is shown in such a one only if
        // that was asked for.
        let has_colors = stage.has_colors();
        let builtin = builtin::ALL.iter().filter(|builtin| has_colors || builtin.palette.ramps() > 0);
        let named = builtin.map(|builtin| (builtin.name.to_string(), Colors::from(builtin.palette.clone())));
        let palettes = named.chain([(input::AUTO.to_string(), Colors::Auto)]);
        // A scene that has none leaves the DAC alone.
        let colors = stage.colors.clone().unwrap_or(Palette::default().into());
        let usual = match colors {
            Colors::Auto => input::AUTO,
            _ if of_model => "grey",
            _ => "the scene's",
        };
        let palette = (drawing.palette_name().unwrap_or(usual.to_string()), colors);
        Ok(Demo {
            triangles: stage.scene.objects().iter().map(|object| object.mesh().triangles().len()).sum(),
            stage,
            name,
            renderer: drawing.renderer(kernel),
            rungs: Choice::new(Rung::ALL.iter().copied(), rung, |a, b| a == b),
            kernels: Choice::new(Kernel::available(), kernel, |a, b| a.name() == b.name()),
            palettes: Choice::new(palettes, palette, |(a, _), (b, _)| a == b),
            mappings: Choice::new([None].into_iter().chain(Mapping::ALL.map(Some)), drawing.mapping(), |a, b| a == b),
            motion: Motion::new(),
            help: false,
            timing: Timing::default(),
            planning: Timing::default(),
            stats: None,
            notice: None,
            seconds: 0.0,
        })
    }

    /// Does what the user asks for in the frame that shows the time `seconds`.
    fn follow(&mut self, input: &Input, seconds: f64) -> Result<Wish, Failure> {
        self.seconds = seconds;
        self.notice.take_if(|(_, until)| *until < seconds);
        self.motion.follow(input, seconds);
        let typed = |characters: &[char]| input.typed().contains(characters);
        if input.pressed(Key::LeftBracket) || typed(&['[']) {
            self.rungs.step_back();
        }
        if input.pressed(Key::RightBracket) || typed(&[']']) {
            self.rungs.step_on();
        }
        if input.pressed(Key::K) {
            self.kernels.go_round();
        }
        if input.pressed(Key::P) {
            self.palettes.go_round();
            self.stage.set_colors(&self.palettes.chosen().1).map_err(Failure::work)?;
        }
        if input.pressed(Key::M) {
            self.mappings.go_round();
        }
        for (key, switch) in Switch::KEYS {
            if input.pressed(key) {
                switch.turn(&mut self.stage.scene, &mut self.renderer);
            }
        }
        if input.pressed(Key::H) {
            self.help = !self.help;
        }
        Ok(if input.pressed(Key::Escape) {
            Wish::End
        } else if input.pressed(Key::S) {
            Wish::Picture
        } else {
            Wish::Nothing
        })
    }

    fn draw(&mut self, vga: &mut Vga) -> Result<(), Failure> {
        self.stage.show(self.motion.seconds(), self.motion.pose);
        self.renderer.set_rung(*self.rungs.chosen());
        self.renderer.set_kernel(*self.kernels.chosen());
        self.renderer.set_mapping(*self.mappings.chosen());
        if self.help {
            let start = Instant::now();
            self.renderer.make_plan(&self.stage.scene, Screen::MODE_13H).map_err(Failure::work)?;
            self.planning.add(start.elapsed().as_secs_f64(), self.seconds);
        }
        let start = Instant::now();
        let stats = self.renderer.draw(&self.stage.scene, vga).map_err(Failure::work)?;
        self.timing.add(start.elapsed().as_secs_f64(), self.seconds);
        self.stats = Some(stats);
        if self.help {
            overlay::write(vga, Place::Top, &self.figures());
            overlay::write(vga, Place::Bottom, &HELP);
        }
        Ok(())
    }

    /// Saves the picture as it is on the screen. A failure is shown and ends nothing.
    fn save(&mut self, vga: &Vga) {
        let notice = match output::numbered_picture(vga) {
            Ok(path) => format!("saved {}", path.display()),
            Err(error) => error.to_string(),
        };
        eprintln!("mode13h: {notice}");
        self.notice = Some((notice, self.seconds + NOTICE));
    }

    fn title(&self) -> String {
        let notice = self.notice.as_ref().map_or(String::new(), |(notice, _)| format!(" - {notice}"));
        format!("{} - {} - mode13h{notice}", self.name, self.timing)
    }

    fn figures(&self) -> Vec<String> {
        let mapping = self.mappings.chosen().map_or("by plan", Mapping::name);
        let mut lines = vec![
            format!("{}: {} triangles, zoom {:.2}", self.name, self.triangles, self.motion.pose.zoom),
            format!("{}, {:.0} a second, plan {:.1} us", self.timing, self.timing.rate, self.planning.frame * 1e6),
            format!("rung {}, mapping {mapping}", self.rungs.chosen().name()),
            format!("kernel {}, palette {}", self.kernels.chosen(), self.palettes.chosen().0),
        ];
        if let Some(Stats { hidden_surfaces, vertices, drawn, raster, .. }) = &self.stats {
            lines.push(format!("{hidden_surfaces}: {vertices} vertices, {drawn} drawn"));
            lines.push(format!("{} spans, {} pixels", raster.spans, raster.pixels));
        }
        let on = in_columns(&self.effects_on());
        lines.push(format!("on, of {} effects and {} objects:", Effect::COUNT, self.stage.scene.objects().len()));
        lines.extend(on);
        lines
    }

    /// The effects that are on: each with its choice, unless the lines above say that, and, if not for all objects, for
    /// how many.
    fn effects_on(&self) -> Vec<String> {
        let objects = self.renderer.plan().objects();
        let entry = |effect: Effect| {
            let on: Vec<_> = objects.iter().map(|plan| plan.decision(effect)).filter(|decision| decision.on).collect();
            let mut entry = effect.name().to_string();
            let is_said = matches!(effect, Effect::HiddenSurfaces | Effect::Gouraud | Effect::Phong);
            if !is_said && !on.first()?.choice.is_empty() {
                entry += &format!(" {}", on[0].choice);
            }
            if on.len() < objects.len() {
                entry += &format!(" {}/{}", on.len(), objects.len());
            }
            Some(entry)
        };
        Effect::ALL.into_iter().filter_map(entry).collect()
    }
}

/// The characters of a line that fits on the frame.
const LINE: usize = 52;

/// Entries in two columns, down the first and then the second.
fn in_columns(entries: &[String]) -> Vec<String> {
    let half = LINE / 2;
    let (left, right) = entries.split_at(entries.len().div_ceil(2));
    let right = right.iter().map(String::as_str).chain([""]);
    left.iter().zip(right).map(|(left, right)| format!("{left:half$.half$}{right}")).collect()
}

const HELP: [&str; 4] = [
    "Esc quit   Space stop   S save     H hide this",
    "[ ] rung   K kernel     P palette  M mapping",
    "L lights   O fog        T texture  D dither",
    "arrows, mouse turn      wheel, + - zoom",
];

/// What moves: the scene's time, by the clock unless it is stopped, and what the user has turned.
struct Motion {
    /// The scene's time at the time `since`, in seconds.
    time: f64,
    /// When the clock began to move it, in seconds; nothing while it is stopped.
    since: Option<f64>,
    pose: Pose,
    now: f64,
}

impl Motion {
    fn new() -> Motion {
        Motion { time: 0.0, since: Some(0.0), pose: Pose::FIRST, now: 0.0 }
    }

    fn follow(&mut self, input: &Input, seconds: f64) {
        let passed = (seconds - self.now).clamp(0.0, LONGEST_FRAME);
        self.now = seconds;
        if input.pressed(Key::Space) {
            self.time = self.seconds();
            self.since = if self.since.is_none() { Some(seconds) } else { None };
        }
        let arrow = |key| {
            let held = if input.held(key) { ARROW_SPEED * passed } else { 0.0 };
            held + if input.pressed(key) { ARROW_TAP } else { 0.0 }
        };
        let (right, down) = input.drag();
        self.pose.turn += arrow(Key::Right) - arrow(Key::Left) + DRAG * f64::from(right);
        self.pose.tilt += arrow(Key::Down) - arrow(Key::Up) + DRAG * PIXEL_HEIGHT * f64::from(down);

        let typed = |characters: &[char]| input.typed().contains(characters);
        let mut notches = f64::from(input.wheel());
        if input.pressed(Key::NumPadPlus) || typed(&['+', '=']) {
            notches += 1.0;
        }
        if input.pressed(Key::NumPadMinus) || typed(&['-', '_']) {
            notches -= 1.0;
        }
        self.pose.zoom = (self.pose.zoom * NOTCH.powf(notches)).clamp(ZOOM.0, ZOOM.1);
    }

    /// The scene's time at the time of the last [`follow`](Self::follow). It comes from the clock and not from the frames
    /// that were drawn since.
    fn seconds(&self) -> f64 {
        self.time + self.since.map_or(0.0, |since| self.now - since)
    }
}

/// A list, one of which is chosen.
struct Choice<T> {
    list: Vec<T>,
    at: usize,
}

impl<T> Choice<T> {
    /// `first` is chosen. It is put in front if the list does not hold it.
    fn new(list: impl IntoIterator<Item = T>, first: T, same: fn(&T, &T) -> bool) -> Choice<T> {
        let mut list: Vec<T> = list.into_iter().collect();
        let at = list.iter().position(|entry| same(entry, &first)).unwrap_or_else(|| {
            list.insert(0, first);
            0
        });
        Choice { list, at }
    }

    fn chosen(&self) -> &T {
        &self.list[self.at]
    }

    fn go_round(&mut self) {
        self.at = (self.at + 1) % self.list.len();
    }

    fn step_on(&mut self) {
        self.at = (self.at + 1).min(self.list.len() - 1);
    }

    fn step_back(&mut self) {
        self.at = self.at.saturating_sub(1);
    }
}

/// The time that drawing a frame takes, and how many are shown, steady enough to be read.
#[derive(Default)]
struct Timing {
    sum: f64,
    frames: u32,
    since: f64,
    /// Seconds for a frame, and frames a second, over the last period.
    frame: f64,
    rate: f64,
}

impl Timing {
    /// The least time from one figure to the next, in seconds.
    const PERIOD: f64 = 0.5;

    /// A frame was drawn in `taken` seconds, at the time `now`.
    fn add(&mut self, taken: f64, now: f64) {
        self.sum += taken;
        self.frames += 1;
        let passed = now - self.since;
        if passed >= Self::PERIOD || self.frame == 0.0 {
            self.frame = self.sum / f64::from(self.frames);
            self.rate = if passed > 0.0 { f64::from(self.frames) / passed } else { 0.0 };
            (self.sum, self.frames, self.since) = (0.0, 0, now);
        }
    }
}

impl std::fmt::Display for Timing {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.2} ms", self.frame * 1000.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_comes_from_the_clock_and_not_from_the_frames() {
        let time_after = |times: &[f64]| {
            let mut motion = Motion::new();
            times.iter().for_each(|&seconds| motion.follow(&Input::default(), seconds));
            (motion.seconds(), motion.pose)
        };
        let many: Vec<f64> = (0..=1_000_000).map(|i| f64::from(i) / 1000.0).collect();
        assert_eq!(time_after(&many), time_after(&[1000.0]));
    }

    #[test]
    fn an_hour_in_one_frame_is_an_hour_of_the_scene() {
        let mut motion = Motion::new();
        for seconds in [0.0, 0.0, 3600.0, 3599.0] {
            motion.follow(&Input::default(), seconds);
            assert_eq!(motion.seconds(), seconds);
        }
    }

    #[test]
    fn a_choice_goes_round_or_stops_at_its_ends() {
        let mut choice = Choice::new([1, 2, 3], 2, |a, b| a == b);
        choice.step_on();
        choice.step_on();
        assert_eq!(*choice.chosen(), 3);
        choice.go_round();
        assert_eq!(*choice.chosen(), 1);
        choice.step_back();
        assert_eq!(*choice.chosen(), 1);
        assert_eq!(Choice::new([1, 2], 7, |a, b| a == b).list, [7, 1, 2]);
    }
}
