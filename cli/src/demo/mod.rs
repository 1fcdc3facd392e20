//! `mode13h demo`: a scene, or a model that turns, in a window.
//!
//! | file | what |
//! |---|---|
//! | `shading` | the keys for shadings and the budget |
//! | `motion` | what the clock and the user move |
//! | `error_map` | how far each pixel is from the truth, over the picture |
//! | `compare` | two shadings side by side |
//! | `figures`, `timing` | what I and H show |
//! | `background` | a thread that the picture does not wait for |
//! | `loader` | the inputs, loaded when they are asked for and when their files change |
//! | `choice` | one of a list |
//! | `terminal` | all of it in a terminal instead, without the rest |

mod background;
mod choice;
mod compare;
mod error_map;
mod figures;
mod loader;
mod motion;
mod pixel;
mod shading;
mod terminal;
mod timing;

use std::ffi::OsString;
use std::sync::Arc;
use std::time::{Duration, Instant};

use clap::Args;
use mode13h::export::Scale;
use mode13h::palette::{Palette, builtin};
use mode13h::render::{Renderer, Screen, Stats};
use mode13h::scene::Scene;
use mode13h::settings::Mapping;
use mode13h::settings::Settings;
use mode13h::span::Kernel;
use mode13h::vga::Vga;
use mode13h::window::{Flow, Input, Key, Window, WindowError};
use mode13h_assets::terminal::Protocol;

use crate::failure::Failure;
use crate::options::{Drawing, Moment, ShadingOptions, one_of};
use crate::overlay::{self, Sheet, Side};
use crate::toggles::Switch;
use crate::turntable::Colors;
use crate::turntable::Turntable;
use crate::{input, output};
use choice::Choice;
use compare::Compare;
use error_map::Map;
use loader::{Inputs, Loader, Loading};
use motion::{Motion, STOPPED};
use pixel::Pixel;
use shading::{Pacing, ShadingChoice};
use timing::Timing;

/// The keys, as the long help lists them.
pub(crate) const KEYS: &str = "\
Keys in the window:
  Esc             Quit
  H               Show the keys
  I               Show the plan, times, errors, and the share of each shading
  Space           Stop time, start it again
  arrows, mouse   Turn
  + - and wheel   Zoom
  [ and ]         Step through the shadings
  1 to 9          The first nine shadings
  0               The error budget
  B, Shift-B      A smaller budget, a larger one: 16, 8, 4, 2, 1, 1/2 shades
  F, Shift-F      The smallest error that fits a time: less time, more time
  E               The error map
  C               Divide the window at the mouse, with another shading on the
                  right; a click fixes the divider, Shift with [ ] and digits
                  chooses the right shading
  X               Swap the two shadings
  K, P, M         The next kernel, palette, texture mapping
  L, O, T         Lights, fog, textures off and on
  D               Dither: ordered, blue noise, ps1, off
  N, Shift-N      The next INPUT, the one before
  S               Save the picture as a PNG, without the text over it";

#[derive(Args, Clone)]
pub(crate) struct Options {
    #[arg(default_value = "torus", value_name = "INPUT", help = input::HELP, long_help = long_help_on_inputs())]
    inputs: Vec<OsString>,
    /// Show INPUT in the terminal instead of a window
    ///
    /// The terminal must show pictures, as xterm, foot, kitty and others do, also over ssh. Arrows turn, + and - zoom, Space
    /// stops time; q, Esc or Ctrl-C ends.
    #[arg(long, conflicts_with = "max_time")]
    terminal: bool,
    /// How the terminal takes pictures: sixel or kitty
    ///
    /// Sixels give colours in whole percents; those of kitty are exact.
    ///
    /// [default: kitty, if the environment names kitty or Ghostty, or else sixel]
    #[arg(
        long,
        value_name = "PROTOCOL",
        value_parser = one_of(Protocol::ALL, Protocol::name),
        hide_possible_values = true,
        hide_short_help = true,
        requires = "terminal",
    )]
    to: Option<Protocol>,
    /// Enlarge the frame in the terminal: 2, 5x6, or to a size like 640x480
    ///
    /// [default: 640x480, or 320x240 if the terminal has no room for that or does not say]
    #[arg(long, value_name = "SCALE", hide_short_help = true, requires = "terminal")]
    scale: Option<Scale>,
    /// End after N frames in the terminal
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u32).range(1..),
        hide_short_help = true,
        requires = "terminal",
    )]
    frames: Option<u32>,
    #[command(flatten)]
    moment: Moment,
    #[command(flatten)]
    drawing: Drawing,
    #[command(flatten)]
    shading: ShadingOptions,
}

impl Options {
    /// The inputs behind the first one.
    pub(crate) fn more_inputs(&self) -> &[OsString] {
        self.inputs.get(1..).unwrap_or_default()
    }
}

/// Words at first, and their time in seconds.
const HINT: &str = "H help, I figures";
const HINT_SECONDS: f64 = 3.0;
/// Seconds for which the words stand on what a key has changed, and on where a picture was saved.
const NOTICE: f64 = 1.0;
const SAVED: f64 = 3.0;

/// Time that the first input may take to load before a window opens that says so.
const PATIENCE: Duration = Duration::from_millis(500);

/// Time for which nothing changes in what stands still.
const STILL: Duration = Duration::from_millis(500);
/// Longest time in which nothing is done but wait for the user: where all stands still, and where something moves so
/// slowly that now and then two frames are the same.
const STILL_REST: Duration = Duration::from_millis(100);
const SHORT_REST: Duration = Duration::from_millis(14);

fn long_help_on_inputs() -> String {
    format!("{}\n\nOf several, the first is shown; the key N goes to the next.", input::long_help())
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let Options { inputs, terminal, to, scale, frames, moment, drawing, shading } = options.clone();
    if terminal {
        let sending = terminal::Sending { to, scale, frames };
        sending.check(&inputs)?;
        let [.., input] = inputs.as_slice() else { return Ok(()) };
        let (stage, kernel) = (drawing.stage(drawing.input(input)?)?, drawing.kernel()?);
        return sending.run(stage, shading.renderer(&drawing, kernel), moment.of_first());
    }
    let inputs = Arc::new(Inputs { moment, drawing, shading, words: inputs });
    let kernel = inputs.drawing.kernel()?;
    let loader = Loader::start(Arc::clone(&inputs))?;
    let mut demo = Demo::new(inputs, kernel);
    // Most faults of an input are found at once, and then no window need open.
    if let Some(first) = loader.wait(PATIENCE) {
        demo.put_on(first)?;
    }
    let mut window = match Window::open(&demo.name) {
        Ok(window) => window,
        Err(no_display) => {
            while demo.is_loading {
                let first = loader.wait(Duration::MAX).ok_or_else(|| Failure::file("the loader has ended"))?;
                demo.put_on(first)?;
            }
            return demo.save_each(&no_display);
        }
    };
    let (mut title, mut shown) = (String::new(), PixelPipeline::of(&Vga::new(), Sheet::new((0, 0))));
    // When what is shown last changed.
    let mut changed = 0.0;
    loop {
        let wish = demo.follow(window.input(), window.seconds())?;
        if let Some(loading) = loader.loaded() {
            demo.put_on(loading)?;
        }
        demo.draw()?;
        match wish {
            Wish::Nothing => {}
            Wish::Picture => demo.save(),
            Wish::Input(at) => loader.ask(at),
            Wish::End => return Ok(()),
        }
        let new = demo.title();
        if new != title {
            window.set_title(&new);
            title = new;
        }
        let sheet = demo.sheet(window.size());
        let look = PixelPipeline::of(demo.on_screen(), sheet);
        let flow = if look == shown {
            let is_still = window.seconds() - changed > STILL.as_secs_f64();
            window.rest(if is_still { STILL_REST } else { SHORT_REST })
        } else {
            (shown, changed) = (look, window.seconds());
            window.show_over(demo.on_screen(), |canvas| shown.sheet.draw(canvas))
        };
        if flow.map_err(Failure::from)? == Flow::Close {
            return Ok(());
        }
    }
}

/// Contents of the window.
#[derive(PartialEq)]
struct PixelPipeline {
    pixels: Vec<u8>,
    palette: Palette,
    sheet: Sheet,
}

impl PixelPipeline {
    fn of(vga: &Vga, sheet: Sheet) -> PixelPipeline {
        PixelPipeline { pixels: vga.pixels().to_vec(), palette: vga.palette(), sheet }
    }
}

/// Request of the keys beyond a change of the picture.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Wish {
    Nothing,
    Picture,
    /// The input at this place in the list.
    Input(usize),
    End,
}

struct Demo {
    inputs: Arc<Inputs>,
    /// The place of the input that is shown or being loaded.
    at: usize,
    /// True while it is being loaded.
    is_loading: bool,
    /// Its name.
    name: String,
    triangles: usize,
    /// Scene on show; without objects until something could be loaded.
    stage: Turntable,
    /// Reason why the scene on show is not that of the files.
    wrong: Option<Failure>,
    renderer: Renderer,
    shading: ShadingChoice,
    pacing: Pacing,
    /// True if a key chose it.
    chose_shading: bool,
    kernels: Choice<Kernel>,
    palettes: Choice<(String, Colors)>,
    /// True if a key chose one.
    chose_palette: bool,
    /// `None` leaves it to the plan.
    mappings: Choice<Option<Mapping>>,
    motion: Motion,
    /// The keys.
    help: Panel,
    /// Figures of the picture.
    figures: Panel,
    maps: bool,
    /// The pixel under the mouse, or the last that was.
    mouse: Pixel,
    map: Map,
    compare: Compare,
    /// The picture.
    vga: Vga,
    /// The picture with what is laid over it.
    shown: Vga,
    /// Number of different pictures so far.
    number: u64,
    timing: Timing,
    /// The time of making the plan, while the plan is shown.
    planning: Timing,
    stats: Option<Stats>,
    /// True if the last frame was drawn, and not the same as the one before.
    is_redrawn: bool,
    /// Words at the lower edge, and until when.
    notice: Option<(String, f64)>,
    /// An effect that a key has just switched, and whether it was on before.
    switched: Option<(Switch, &'static str)>,
    /// The effects that keys switched, and to what.
    switches: Vec<(Switch, &'static str)>,
    seconds: f64,
}

impl Demo {
    /// Makes a demo with nothing to show yet.
    fn new(inputs: Arc<Inputs>, kernel: Kernel) -> Demo {
        let Inputs { drawing, shading, .. } = &*inputs;
        let stage = Turntable::of_scene(Scene::new());
        Demo {
            at: 0,
            is_loading: true,
            name: inputs.name(0),
            triangles: 0,
            wrong: None,
            renderer: shading.renderer(drawing, kernel),
            shading: ShadingChoice::of(shading.asked_for(&Settings::default())),
            pacing: Pacing::default(),
            chose_shading: false,
            kernels: Choice::new(Kernel::available(), kernel, |a, b| a.name() == b.name()),
            palettes: palettes(&stage, drawing),
            chose_palette: false,
            mappings: Choice::new([None].into_iter().chain(Mapping::ALL.map(Some)), drawing.mapping(), |a, b| a == b),
            stage,
            motion: Motion::new(),
            help: Panel::default(),
            figures: Panel::default(),
            maps: false,
            mouse: Pixel { x: Vga::WIDTH as u16 / 2, y: Vga::HEIGHT as u16 / 2 },
            map: Map::default(),
            compare: Compare::new(),
            vga: Vga::new(),
            shown: Vga::new(),
            number: 0,
            timing: Timing::default(),
            planning: Timing::default(),
            stats: None,
            is_redrawn: false,
            notice: Some((HINT.to_string(), HINT_SECONDS)),
            switched: None,
            switches: Vec::new(),
            seconds: 0.0,
            inputs,
        }
    }

    /// Shows what was loaded, unless something else has been asked for since. Loaded again, it keeps pose, time and what
    /// keys have chosen. What could not be loaded leaves what is shown, or, the first time, an empty picture; that is a
    /// failure if there is no other input.
    fn put_on(&mut self, loading: Loading) -> Result<(), Failure> {
        let Loading { at, is_again, result, .. } = loading;
        if at != self.at {
            return Ok(());
        }
        self.is_loading = false;
        // A renderer of its own finds out whether the scene can be drawn; this one's plan is for what is shown.
        let checked = result.and_then(|stage| {
            let mut renderer = self.renderer.with_same_settings();
            renderer.make_plan(&stage.scene, Screen::MODE_13H).map_err(Failure::from)?;
            Ok(*stage)
        });
        let keeps = is_again && !self.stage.scene.objects().is_empty();
        let stage = match checked {
            Ok(stage) => {
                self.wrong = None;
                if is_again {
                    self.say("loaded again".to_string());
                } else if self.inputs.words.len() > 1 {
                    self.say(format!("{} of {}: {}", at + 1, self.inputs.words.len(), self.inputs.name(at)));
                }
                stage
            }
            Err(failure) if self.inputs.words.len() == 1 && !is_again => return Err(failure),
            Err(failure) => {
                if self.wrong.as_ref() != Some(&failure) {
                    eprintln!("mode13h: {failure}");
                }
                self.notice = None;
                self.wrong = Some(failure);
                if is_again {
                    return Ok(());
                }
                Turntable::of_scene(Scene::new())
            }
        };
        self.set(stage, keeps)
    }

    /// Shows another stage, as what is shown has been changed by keys if it `keeps` that.
    fn set(&mut self, stage: Turntable, keeps: bool) -> Result<(), Failure> {
        let Inputs { moment, drawing, shading, .. } = &*self.inputs;
        self.name = self.inputs.name(self.at);
        self.triangles = stage.scene.objects().iter().map(|object| object.mesh().triangles().len()).sum();
        self.stage = stage;
        if !self.chose_shading {
            self.shading = ShadingChoice::of(shading.asked_for(&self.stage.scene.settings));
        }
        let before = std::mem::replace(&mut self.palettes, palettes(&self.stage, drawing));
        if keeps && self.chose_palette && self.palettes.choose(|(name, _)| *name == before.chosen().0) {
            self.stage.set_colors(&self.palettes.chosen().1).map_err(Failure::from)?;
        }
        if keeps {
            for &(switch, wanted) in &self.switches {
                for _ in 0..Switch::MAX_STATES {
                    self.renderer.make_plan(&self.stage.scene, Screen::MODE_13H).map_err(Failure::from)?;
                    if switch.state(&self.renderer) == wanted {
                        break;
                    }
                    switch.turn(&mut self.stage, &mut self.renderer).map_err(Failure::from)?;
                }
            }
        } else {
            self.renderer = shading.renderer(drawing, *self.kernels.chosen());
            self.pacing = Pacing::default();
            self.switches.clear();
            self.chose_palette = false;
            self.motion.begin_anew(moment.of_first());
        }
        self.compare.renew(&self.renderer);
        self.forget_times();
        self.stats = None;
        Ok(())
    }

    /// Goes to the next input, or back. Its place, if there is another.
    fn leaf(&mut self, back: bool) -> Option<usize> {
        let count = self.inputs.words.len();
        if count == 1 {
            self.say("there is no other input".to_string());
            return None;
        }
        self.at = (self.at + if back { count - 1 } else { 1 }) % count;
        (self.is_loading, self.notice) = (true, None);
        Some(self.at)
    }

    /// Without a display: saves a picture of each input that can be loaded. The others are failures.
    fn save_each(mut self, no_display: &WindowError) -> Result<(), Failure> {
        let count = self.inputs.words.len();
        let (mut failed, mut worst): (usize, Option<Failure>) = (0, None);
        for at in 0..count {
            if at > 0 {
                self.at = at;
                self.put_on(loader::load(&self.inputs, at, &[]))?;
            }
            if let Some(wrong) = self.wrong.take() {
                failed += 1;
                worst = worst.filter(|worst| worst.status() >= wrong.status()).or(Some(wrong));
                continue;
            }
            self.motion.go_to(self.inputs.moment.of_picture(&self.stage.scene));
            self.draw()?;
            let path = output::numbered_picture(self.on_screen())?;
            let of = if count == 1 { String::new() } else { format!(" of {}", self.name) };
            eprintln!("mode13h: {no_display}; one frame{of} is in {}", path.display());
        }
        match worst {
            Some(worst) => Err(worst.saying(format!("{failed} of {count} inputs could not be drawn"))),
            None => Ok(()),
        }
    }

    /// Follows the user's input in the frame that shows the time `seconds`.
    fn follow(&mut self, input: &Input, seconds: f64) -> Result<Wish, Failure> {
        self.seconds = seconds;
        self.notice.take_if(|(_, until)| *until < seconds);
        if self.motion.follow(input, seconds) {
            self.say(self.motion.to_string());
        }
        if self.shading.follow(input) {
            self.chose_shading = true;
            self.forget_times();
            self.say(self.shading.to_string());
        }
        if input.pressed(Key::K) {
            self.kernels.go_round();
            self.forget_times();
            self.say(format!("kernel {}", self.kernels.chosen()));
        }
        if input.pressed(Key::P) {
            self.palettes.go_round();
            self.chose_palette = true;
            self.stage.set_colors(&self.palettes.chosen().1).map_err(Failure::from)?;
            self.say(format!("palette {}", self.palettes.chosen().0));
        }
        if input.pressed(Key::M) {
            self.mappings.go_round();
            self.forget_times();
            self.say(self.mapping());
        }
        for (key, switch) in Switch::KEYS {
            if input.pressed(key) {
                self.switched = Some((switch, switch.state(&self.renderer)));
                self.forget_times();
                switch.turn(&mut self.stage, &mut self.renderer).map_err(Failure::from)?;
                self.compare.renew(&self.renderer);
            }
        }
        self.follow_sides(input);
        for (key, panel) in [(Key::H, &mut self.help), (Key::I, &mut self.figures)] {
            if input.pressed(key) {
                panel.press();
            }
        }
        if input.pressed(Key::E) {
            self.maps ^= true;
            self.say(format!("error map {}", if self.maps { "on" } else { "off" }));
        }
        self.mouse = input.mouse.and_then(Pixel::at).unwrap_or(self.mouse);
        Ok(if input.pressed(Key::Escape) {
            Wish::End
        } else if input.pressed(Key::N)
            && let Some(at) = self.leaf(input.pressed_with_shift(Key::N))
        {
            Wish::Input(at)
        } else if input.pressed(Key::S) {
            Wish::Picture
        } else {
            Wish::Nothing
        })
    }

    /// Something has changed that changes how long frames take.
    fn forget_times(&mut self) {
        (self.timing, self.planning) = (Timing::default(), Timing::default());
    }

    /// Says something for a moment.
    fn say(&mut self, what: String) {
        self.notice = Some((what, self.seconds + NOTICE));
    }

    /// Draws the picture, and what the keys lay over it.
    fn draw(&mut self) -> Result<(), Failure> {
        self.draw_scene()?;
        if let Some((switch, was)) = self.switched.take() {
            let is = switch.state(&self.renderer);
            self.say(switch.outcome(was, is));
            self.switches.retain(|(other, _)| *other != switch);
            self.switches.push((switch, is));
        }
        // The picture itself stays as it is, for the next frame may be the same.
        self.shown.clone_from(&self.vga);
        self.compare.compose(&mut self.shown);
        if self.figures.is_open || self.maps || self.compare.is_on {
            let right = self.compare.is_on.then_some(&self.compare.right);
            let renderers = [&self.renderer].into_iter().chain(right.map(|right| &right.renderer));
            let shadings = [&self.shading].into_iter().chain(right.map(|right| &right.shading));
            let frame = || error_map::Frame {
                snapshot: error_map::Snapshot {
                    number: self.number,
                    seconds: self.seconds,
                    picture: self.shown.clone(),
                    divider: self.compare.divider(),
                    shadings: shadings.map(|shading| shading.to_string()).collect(),
                },
                scene: self.stage.scene.clone(),
                renderers: renderers.map(Renderer::with_same_settings).collect(),
                mouse: self.mouse,
            };
            self.map.follow(self.number, frame)?;
        }
        if self.maps {
            self.map.lay_over(&mut self.shown, self.number, self.compare.divider());
        }
        Ok(())
    }

    /// Compares two shadings as the keys say.
    fn follow_sides(&mut self, input: &Input) {
        if let Some(said) = self.compare.follow(input, &self.shading, &self.renderer) {
            // Another picture, if only of the right half.
            self.number += 1;
            self.say(said);
        }
        if input.pressed(Key::X) && self.compare.is_on {
            self.compare.swap((&mut self.shading, &mut self.renderer, &mut self.vga, &mut self.timing));
            self.number += 1;
            self.chose_shading = true;
            self.say(format!("{} | {}", self.shading, self.compare.right.shading));
        }
    }

    /// Lays the error map's legend and what is said of two halves over the picture.
    fn lay_over(&self, sheet: &mut Sheet) {
        if self.compare.is_on {
            let errors = [0, 1].map(|side| self.map.errors_of(self.number, side));
            self.compare.lay_over(sheet, (&self.shading, &self.timing), errors);
        }
        if self.maps && !self.help.is_open {
            self.map.legend(sheet, self.number, self.seconds, self.compare.is_on);
        }
    }

    /// Lays out the sheet over the picture in a window of this size.
    fn sheet(&mut self, size: (usize, usize)) -> Sheet {
        let mut sheet = Sheet::new(size);
        if self.maps {
            self.map.corner(&mut sheet, self.number);
        }
        let said = if self.is_loading { Some(self.loading()) } else { self.said() };
        if let Some(said) = said {
            sheet.message(overlay::TEXT, &said);
        }
        if let Some(wrong) = &self.wrong {
            sheet.message(overlay::WRONG, &wrong.to_string());
        }
        self.lay_over(&mut sheet);
        let is_alone = !(self.help.is_open && self.figures.is_open);
        if self.figures.is_open {
            let rows = self.figures();
            self.figures.pages = sheet.panel(Side::Left, &rows, is_alone, self.figures.page, "I");
        }
        if self.help.is_open {
            self.help.pages = sheet.panel(Side::Right, &figures::help(), is_alone, self.help.page, "H");
        }
        sheet
    }

    fn draw_scene(&mut self) -> Result<(), Failure> {
        self.stage.show(self.motion.seconds(), self.motion.pose);
        self.shading.set(&mut self.renderer, &mut self.pacing);
        self.renderer.kernel = *self.kernels.chosen();
        self.renderer.settings.mapping = *self.mappings.chosen();
        // Of a picture that stands still the time for its plan stays, too.
        if self.figures.is_open && (self.is_redrawn || self.planning.frame == 0.0) {
            let start = Instant::now();
            self.renderer.make_plan(&self.stage.scene, Screen::MODE_13H).map_err(Failure::from)?;
            self.planning.add(Some(start.elapsed().as_secs_f64()), self.seconds);
        }
        let start = Instant::now();
        let stats = self.renderer.draw(&self.stage.scene, &mut self.vga).map_err(Failure::from)?;
        let taken = start.elapsed();
        self.pacing.report(&stats, taken);
        self.is_redrawn = stats.redrawn;
        self.timing.add(stats.redrawn.then_some(taken.as_secs_f64()), self.seconds);
        // What was counted is of the frame that is shown, if that was there already.
        if stats.redrawn || self.stats.is_none() {
            self.stats = Some(stats);
            self.number += 1;
        }
        if self.compare.is_on {
            self.compare.right.renderer.kernel = *self.kernels.chosen();
            self.compare.right.renderer.settings.mapping = *self.mappings.chosen();
            let is_new = self.compare.draw(&self.stage.scene, self.seconds).map_err(Failure::from)?;
            self.number += u64::from(is_new);
        }
        Ok(())
    }

    /// Picture that was drawn last.
    fn on_screen(&self) -> &Vga {
        if self.maps || self.compare.is_on { &self.shown } else { &self.vga }
    }

    /// Saves the picture as it is on the screen, without the text and the panels over it. A failure is shown and ends nothing.
    fn save(&mut self) {
        let notice = match output::numbered_picture(self.on_screen()) {
            Ok(path) => format!("saved {}", path.display()),
            Err(error) => error.to_string(),
        };
        eprintln!("mode13h: {notice}");
        self.notice = Some((notice, self.seconds + SAVED));
    }

    fn title(&self) -> String {
        if self.is_loading {
            return format!("{} - mode13h", self.loading());
        }
        format!("{} - {} - {} - mode13h", self.name, self.shading, self.drawn())
    }

    /// The words at the lower edge: a notice, and, as long as it lasts, that the time stands still.
    fn said(&self) -> Option<String> {
        let notice = self.notice.as_ref().map(|(notice, _)| notice.clone());
        match (notice, self.motion.is_stopped()) {
            (Some(notice), true) if notice != STOPPED => Some(format!("{notice} ({STOPPED})")),
            (_, true) => Some(STOPPED.to_string()),
            (notice, false) => notice,
        }
    }

    /// Words on the input that is being loaded.
    fn loading(&self) -> String {
        let count = self.inputs.words.len();
        let number = if count > 1 { format!("{} of {count}: ", self.at + 1) } else { String::new() };
        let read = match input::percent_read() {
            Some(100) => ", making the mesh".to_string(),
            Some(percent) => format!(", {percent} % read"),
            None => String::new(),
        };
        format!("{number}loading {}{read}", self.inputs.name(self.at))
    }

    /// Words on the time that the picture took to draw, and on how often it is drawn.
    fn drawn(&self) -> String {
        let again = if self.is_redrawn { "" } else { ", not drawn again" };
        format!("{}{again}", self.timing)
    }

    /// The mapping of textures that was chosen.
    fn mapping(&self) -> String {
        format!("mapping {}", self.mappings.chosen().map_or("by plan", |mapping| mapping.name()))
    }
}

/// The palettes that P goes through, of which the stage's is chosen.
fn palettes(stage: &Turntable, drawing: &Drawing) -> Choice<(String, Colors)> {
    // A palette without ramps has no order of shades: what has no colours of its own is shown in such a one only if that
    // was asked for.
    let has_colors = stage.has_colors();
    let builtin = builtin::ALL.iter().filter(|builtin| has_colors || builtin.palette.ramps() > 0);
    let named = builtin.map(|builtin| (builtin.name.to_string(), Colors::from(builtin.palette.clone())));
    let palettes = named.chain([(input::AUTO.to_string(), Colors::Auto)]);
    // A scene that has none leaves the DAC alone.
    let colors = stage.colors.clone().unwrap_or(Palette::default().into());
    // Under its own name, if it has one, it does not stand twice in the list.
    let usual = match &colors {
        Colors::Auto => input::AUTO,
        Colors::Palette(palette) => {
            let same = builtin::ALL.iter().find(|builtin| builtin.palette.colors() == palette.colors());
            same.map_or("the scene's", |builtin| builtin.name)
        }
    };
    let palette = (drawing.palette_name().unwrap_or(usual.to_string()), colors);
    Choice::new(palettes, palette, |(a, _), (b, _)| a == b)
}

/// A panel that a key opens, leafs through and closes.
#[derive(Default)]
struct Panel {
    is_open: bool,
    page: usize,
    /// Number of pages when it was laid last.
    pages: usize,
}

impl Panel {
    fn press(&mut self) {
        if self.is_open && self.page + 1 < self.pages {
            self.page += 1;
        } else {
            *self = Panel { is_open: !self.is_open, page: 0, pages: 0 };
        }
    }
}
