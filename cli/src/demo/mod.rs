//! `mode13h demo`: a scene, or a model that turns, in a window.
//!
//! | file | what |
//! |---|---|
//! | `show` | the picture, and what else the panels share |
//! | `scenes` | the inputs |
//! | `motion` | what the clock and the user move |
//! | `panels` | the keys for the shading and the error map |
//! | `shading` | a shading, a budget or a time, by keys |
//! | `error_map` | how far each pixel is from the truth |
//! | `looks` | kernel, palette, mapping and effects |
//! | `compare` | two shadings side by side |
//! | `timing` | times that can be read |
//! | `background` | a thread that the picture does not wait for |
//! | `loader` | the inputs, loaded when they are asked for and when their files change |
//! | `choice` | one of a list |
//! | `terminal` | the picture in a terminal instead, without the panels |

mod background;
mod choice;
mod compare;
mod error_map;
mod loader;
mod looks;
mod motion;
mod panels;
mod scenes;
mod shading;
mod show;
mod terminal;
mod timing;

use std::ffi::OsString;
use std::sync::Arc;
use std::time::Duration;

use clap::Args;
use mode13h::export::Scale;
use mode13h::render::{Renderer, Screen};
use mode13h::scene::Scene;
use mode13h::settings::{Settings, Shading};
use mode13h::span::Kernel;
use mode13h::vga::Vga;
use mode13h::window::{Flow, Input, Key, Window, WindowError};
use mode13h_assets::terminal::Protocol;

use crate::failure::Failure;
use crate::options::{Drawing, Moment, ShadingOptions, one_of};
use crate::overlay::{self, Row, Sheet, Side, wrapped};
use crate::turntable::Turntable;
use crate::{input, output};
use compare::Divider;
use error_map::Pixel;
use loader::{Inputs, Loader, Loading};
use looks::Looks;
use motion::{Motion, STOPPED};
use panels::{Maps, Shades};
use scenes::Scenes;
use shading::ShadingChoice;
use show::{Half, Show};

/// Keys, and what each does.
type Keys = &'static [(&'static str, &'static str)];

/// Keys of the window itself.
const KEYS: Keys = &[
    ("Esc", "Quit"),
    ("H", "Show the keys"),
    ("I", "Show the plan, times, errors, and the share of each shading"),
    ("S", "Save the picture as a PNG, without the text over it"),
];

/// A part of the window with keys of its own.
trait Panel {
    /// Handles the user's input.
    fn follow(&mut self, input: &Input, show: &mut Show) -> Result<(), Failure>;

    /// Adapts to another stage. With `keeps`, changes made by keys are applied to it again; otherwise everything is
    /// reset.
    fn renew(&mut self, _show: &mut Show, _keeps: bool) -> Result<(), Failure> {
        Ok(())
    }

    /// Its rows among the figures.
    fn figures(&self, _show: &Show) -> Vec<Row> {
        Vec::new()
    }

    /// Draws its own content over the picture.
    fn lay_over(&self, _show: &Show, _sheet: &mut Sheet) {}
}

struct Panels {
    scenes: Scenes,
    motion: Motion,
    shades: Shades,
    maps: Maps,
    looks: Looks,
    divider: Divider,
}

/// Keys of a panel, and where it is.
type Entry = (Keys, fn(&mut Panels) -> &mut dyn Panel);

/// The panels, in the order of the help and the figures.
const PANELS: [Entry; 6] = [
    (scenes::KEYS, |panels| &mut panels.scenes),
    (motion::KEYS, |panels| &mut panels.motion),
    (panels::SHADES, |panels| &mut panels.shades),
    (compare::KEYS, |panels| &mut panels.divider),
    (panels::MAPS, |panels| &mut panels.maps),
    (looks::KEYS, |panels| &mut panels.looks),
];

fn all_keys() -> impl Iterator<Item = (&'static str, &'static str)> {
    KEYS.iter().chain(PANELS.iter().flat_map(|(keys, _)| *keys)).copied()
}

/// The keys, as the long help lists them in lines of `width` letters.
pub(crate) fn help_on_keys(width: usize) -> String {
    let mut help = "Keys in the window:".to_string();
    for (mut keys, does) in all_keys() {
        for line in wrapped(does, width - 18) {
            help += &format!("\n  {:15} {line}", std::mem::take(&mut keys));
        }
    }
    help
}

#[derive(Args, Clone)]
pub(crate) struct Options {
    #[arg(default_value = "torus", value_name = "INPUT", help = input::HELP, long_help = long_help_on_inputs())]
    pub(crate) inputs: Vec<OsString>,
    /// Show INPUT in the terminal instead of a window
    ///
    /// The terminal must support images, as xterm, foot, kitty and others do, even over ssh. Arrows turn, + and - zoom, Space
    /// pauses or resumes; q, Esc or Ctrl-C quits.
    #[arg(long, conflicts_with = "max_time")]
    terminal: bool,
    /// Send pictures to the terminal as sixel or kitty
    ///
    /// Sixels round colours to whole percentages; kitty's are exact.
    ///
    /// [default: kitty if the environment names kitty or Ghostty, or else sixel]
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
    /// [default: 640x480, or 320x240 if the terminal is too small for that or does not report its size]
    #[arg(long, value_name = "SCALE", hide_short_help = true, requires = "terminal")]
    scale: Option<Scale>,
    /// Quit after N frames in the terminal
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

/// Seconds for which the demo says where a picture was saved.
const SAVED: f64 = 3.0;

/// Time that the first input may take to load before a window opens that says so.
const PATIENCE: Duration = Duration::from_millis(500);

/// Time without a change after which a picture counts as still.
const STILL: Duration = Duration::from_millis(500);
/// Longest time spent just waiting for the user: when everything stands still, and when something moves so slowly that
/// two frames are now and then the same.
const STILL_REST: Duration = Duration::from_millis(100);
const SHORT_REST: Duration = Duration::from_millis(14);

fn long_help_on_inputs() -> String {
    format!("{}\n\nWith several, the first is shown; press N for the next.", input::long_help())
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let Options { inputs, terminal, to, scale, frames, moment, drawing, shading } = options.clone();
    shading.note_ignored(&shading.renderer(&drawing, drawing.kernel()?));
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
    // Most errors in an input are found at once, before a window opens.
    if let Some(first) = loader.wait(PATIENCE) {
        demo.put_on(first)?;
    }
    let mut window = match Window::open(&demo.panels.scenes.name) {
        Ok(window) => window,
        Err(no_display) => {
            while demo.panels.scenes.is_loading {
                let first = loader.wait(Duration::MAX).ok_or_else(|| Failure::work("the loader has ended"))?;
                demo.put_on(first)?;
            }
            return demo.save_each(&no_display);
        }
    };
    let mut title = String::new();
    // The picture on show, and when it last changed.
    let (mut shown, mut changed) = (None, 0.0);
    loop {
        let (input, at) = (window.input(), demo.panels.scenes.at);
        if input.pressed(Key::Escape) {
            return Ok(());
        }
        let saves = input.pressed(Key::S);
        demo.follow(input, window.seconds())?;
        if let Some(loading) = loader.loaded() {
            demo.put_on(loading)?;
        }
        demo.draw()?;
        if saves {
            demo.save();
        }
        if demo.panels.scenes.at != at {
            loader.ask(demo.panels.scenes.at);
        }
        let new = demo.title();
        if new != title {
            window.set_title(&new);
            title = new;
        }
        let sheet = demo.sheet(window.size());
        let screen = &demo.show.screen;
        let look = Some((screen.pixels().to_vec(), screen.palette(), sheet.clone()));
        let flow = if look == shown {
            let is_still = window.seconds() - changed > STILL.as_secs_f64();
            window.rest(if is_still { STILL_REST } else { SHORT_REST })
        } else {
            (shown, changed) = (look, window.seconds());
            window.show_over(screen, |canvas| sheet.draw(canvas))
        };
        if flow? == Flow::Close {
            return Ok(());
        }
    }
}

struct Demo {
    show: Show,
    panels: Panels,
}

impl Demo {
    /// Makes a demo with nothing to show yet.
    fn new(inputs: Arc<Inputs>, kernel: Kernel) -> Demo {
        let Inputs { drawing, shading, .. } = &*inputs;
        let left = ShadingChoice::of(shading.asked_for(&Settings::default()));
        let left = Half::new(left, shading.renderer(drawing, kernel));
        let right = Half::new(ShadingChoice::new(Shading::Phong, None), Renderer::new());
        let panels = Panels {
            scenes: Scenes { at: 0, is_loading: true, name: inputs.name(0), wrong: None },
            motion: Motion::new(),
            shades: Shades,
            maps: Maps { is_on: false, mouse: Pixel { x: Vga::WIDTH as u16 / 2, y: Vga::HEIGHT as u16 / 2 } },
            looks: Looks::new(&inputs, kernel),
            divider: Divider::default(),
        };
        Demo { show: Show::new(inputs, [left, right]), panels }
    }

    /// Shows an input that was loaded, unless another has been asked for since. A reloaded one keeps its pose, its time
    /// and the choices made by keys. If it could not be loaded, the picture stays, or is empty the first time; that is
    /// a failure if there is no other input.
    fn put_on(&mut self, loading: Loading) -> Result<(), Failure> {
        let Loading { at, is_again, result, .. } = loading;
        let Demo { show, panels } = self;
        let (scenes, count) = (&mut panels.scenes, show.inputs.words.len());
        if at != scenes.at {
            return Ok(());
        }
        scenes.is_loading = false;
        // A separate renderer finds out whether the scene can be drawn; this one keeps its plan for the picture on
        // show.
        let checked = result.and_then(|stage| {
            let mut renderer = show.halves[0].renderer.with_same_settings();
            renderer.make_plan(&stage.scene, Screen::MODE_13H)?;
            Ok(*stage)
        });
        let keeps = is_again && !show.stage.scene.objects().is_empty();
        let stage = match checked {
            Ok(stage) => {
                scenes.wrong = None;
                if is_again {
                    show.say("reloaded");
                } else if count > 1 {
                    show.say(format!("{} of {count}: {}", at + 1, show.inputs.name(at)));
                }
                stage
            }
            Err(failure) if count == 1 && !is_again => return Err(failure),
            Err(failure) => {
                if scenes.wrong.as_ref() != Some(&failure) {
                    output::note(&failure);
                }
                show.notice = None;
                scenes.wrong = Some(failure);
                if is_again {
                    return Ok(());
                }
                Turntable::of_scene(Scene::new())
            }
        };
        show.stage = stage;
        let left = &mut show.halves[0];
        if keeps {
            left.stats = None;
            left.forget_times();
        } else {
            let Inputs { drawing, shading, .. } = &*show.inputs;
            left.renew(shading.renderer(drawing, left.renderer.kernel));
        }
        for (_, panel) in PANELS {
            panel(panels).renew(show, keeps)?;
        }
        show.renew_right();
        Ok(())
    }

    /// Without a display: saves a picture of each input that can be loaded. The others are failures.
    fn save_each(mut self, no_display: &WindowError) -> Result<(), Failure> {
        let inputs = Arc::clone(&self.show.inputs);
        let count = inputs.words.len();
        let (mut failed, mut worst): (usize, Option<Failure>) = (0, None);
        for at in 0..count {
            if at > 0 {
                self.panels.scenes.at = at;
                self.put_on(loader::load(&inputs, at, &[]))?;
            }
            if let Some(wrong) = self.panels.scenes.wrong.take() {
                failed += 1;
                worst = worst.filter(|worst| worst.status() >= wrong.status()).or(Some(wrong));
                continue;
            }
            self.panels.motion.go_to(inputs.moment.of_picture(&self.show.stage.scene));
            self.draw()?;
            let path = output::numbered_picture(&self.show.screen)?;
            let of = if count == 1 { String::new() } else { format!(" of {}", inputs.name(at)) };
            output::note(format_args!("{no_display}; saved one frame{of} as {}", path.display()));
        }
        match worst {
            Some(worst) => Err(worst.saying(format!("{failed} of {count} inputs could not be drawn"))),
            None => Ok(()),
        }
    }

    /// Handles the user's input in the frame that shows the time `seconds`.
    fn follow(&mut self, input: &Input, seconds: f64) -> Result<(), Failure> {
        let Demo { show, panels } = self;
        show.seconds = seconds;
        show.notice.take_if(|(_, until)| *until < seconds);
        for (key, pages) in [(Key::H, &mut show.help), (Key::I, &mut show.figures)] {
            if input.pressed(key) {
                pages.press();
            }
        }
        PANELS.iter().try_for_each(|(_, panel)| panel(panels).follow(input, show))
    }

    /// Draws the picture, and the error map over it.
    fn draw(&mut self) -> Result<(), Failure> {
        let Demo { show, panels: Panels { motion, maps, .. } } = self;
        show.stage.show(motion.seconds(), motion.pose);
        show.draw()?;
        if show.figures.is_open || maps.is_on || show.divider.is_some() {
            show.measure(maps.mouse)?;
        }
        if maps.is_on {
            let column = show.column();
            show.map.lay_over(&mut show.screen, show.number, column);
        }
        Ok(())
    }

    /// Lays out the sheet over the picture in a window of this size.
    fn sheet(&mut self, size: (usize, usize)) -> Sheet {
        let (mut sheet, said) = (Sheet::new(size), self.said());
        let Demo { show, panels } = self;
        if panels.maps.is_on {
            show.map.corner(&mut sheet, show.number);
        }
        if let Some(said) = said {
            sheet.message(overlay::TEXT, &said);
        }
        PANELS.iter().for_each(|(_, panel)| panel(panels).lay_over(show, &mut sheet));
        // Nothing else is at the sides.
        let is_alone = !(show.help.is_open && show.figures.is_open || panels.maps.is_on || show.divider.is_some());
        if show.figures.is_open {
            let rows: Vec<Row> = PANELS.iter().flat_map(|(_, panel)| panel(panels).figures(show)).collect();
            show.figures.pages = sheet.panel(Side::Left, &rows, is_alone, show.figures.page, "I");
        }
        if show.help.is_open {
            let rows: Vec<Row> = all_keys().map(|(keys, does)| Row::new(keys, does)).collect();
            show.help.pages = sheet.panel(Side::Right, &rows, is_alone, show.help.page, "H");
        }
        sheet
    }

    /// Saves the picture as it is on the screen, without the text and the panels over it. A failure is shown, and does
    /// not end the demo.
    fn save(&mut self) {
        let notice = match output::numbered_picture(&self.show.screen) {
            Ok(path) => {
                let saved = format!("saved {}", path.display());
                output::remark(&saved);
                saved
            }
            Err(error) => {
                output::note(&error);
                error.to_string()
            }
        };
        self.show.notice = Some((notice, self.show.seconds + SAVED));
    }

    fn title(&self) -> String {
        let (scenes, left) = (&self.panels.scenes, &self.show.halves[0]);
        match scenes.loading(&self.show) {
            Some(loading) => format!("{loading} - mode13h"),
            None => format!("{} - {} - {} - mode13h", scenes.name, left.shading, left.timing.in_words()),
        }
    }

    /// The text at the lower edge: what is being loaded, or a notice, and, while time is stopped, a note that says so.
    fn said(&self) -> Option<String> {
        let notice = self.show.notice.as_ref().map(|(notice, _)| notice.clone());
        self.panels.scenes.loading(&self.show).or(match (notice, self.panels.motion.is_stopped()) {
            (Some(notice), true) if notice != STOPPED => Some(format!("{notice} ({STOPPED})")),
            (_, true) => Some(STOPPED.to_string()),
            (notice, false) => notice,
        })
    }
}

/// Rows that a key opens, pages through and closes.
#[derive(Default)]
struct Pages {
    is_open: bool,
    page: usize,
    /// Number of pages when it was last laid out.
    pages: usize,
}

impl Pages {
    fn press(&mut self) {
        if self.is_open && self.page + 1 < self.pages {
            self.page += 1;
        } else {
            *self = Pages { is_open: !self.is_open, page: 0, pages: 0 };
        }
    }
}

#[cfg(test)]
mod tests {
    use mode13h_assets::shipped;

    use super::loader::tests::inputs;
    use super::*;
    use crate::output::counted;
    use crate::overlay::tests::WINDOWS;

    /// The demo of a scene after its first frame.
    fn demo(name: &str) -> Demo {
        let inputs = inputs(&[name.as_ref()]);
        let first = loader::load(&inputs, 0, &[]);
        let mut demo = Demo::new(inputs, Kernel::default());
        demo.put_on(first).expect("a shipped scene");
        demo.draw().expect("a legal scene");
        demo
    }

    /// A stopped picture says so even while another message is shown.
    #[test]
    fn a_stopped_picture_says_so_as_long_as_it_is_stopped() {
        let mut demo = demo("torus");
        let says = |demo: &mut Demo, seconds| {
            demo.follow(&Input::default(), seconds).expect("a legal scene");
            demo.sheet((960, 720)).words().iter().any(|word| word.contains("stopped"))
        };
        assert!(!says(&mut demo, 0.0));
        demo.panels.motion.toggle();
        for seconds in [0.1, 1.5, 3600.0] {
            assert!(says(&mut demo, seconds), "after {seconds} s");
        }
        demo.show.say("palette copper".to_string());
        assert!(says(&mut demo, 3600.1));
    }

    /// Tests that in every scene, window and page, with one panel open or both, no letter is cut, missing from the
    /// font, or over another, and that every word of a panel is on one of its pages.
    #[test]
    fn text_is_never_cut_in_any_scene() {
        for scene in shipped::ALL {
            let mut demo = demo(scene.name);
            for budget in [None, Some(1.0)] {
                let shading = demo.show.halves[0].renderer.settings.accuracy.unwrap_or_default().shading();
                demo.show.halves[0].shading = ShadingChoice::new(shading, budget);
                demo.draw().expect("a legal scene");
                for size in WINDOWS {
                    for (help, figures) in [(true, false), (false, true), (true, true)] {
                        (demo.show.help.is_open, demo.show.figures.is_open) = (help, figures);
                        for message in
                            ["palette the scene's", "gouraud-8.8-reseeded", "a-long-name.toml:12:3: ".repeat(9).trim()]
                        {
                            demo.show.say(message.to_string());
                            let mut words = Vec::new();
                            let mut pages = 1;
                            for page in (0..).take_while(|page| *page < 9) {
                                if page >= pages {
                                    break;
                                }
                                (demo.show.help.page, demo.show.figures.page) = (page, page);
                                let sheet = demo.sheet(size);
                                let what = format!("{} in {size:?}, page {page}", scene.name);
                                assert_eq!(sheet.faults(), [""; 0], "{what}");
                                let open = [(help, demo.show.help.pages), (figures, demo.show.figures.pages)];
                                assert!(open.iter().all(|(is_open, pages)| !is_open || *pages > 0), "{what}");
                                let of_open = open.iter().filter(|(is_open, _)| *is_open).map(|(_, pages)| *pages);
                                pages = of_open.max().unwrap_or(1);
                                words.extend(sheet.words());
                            }
                            assert!(!help || words.iter().any(|word| word == "Shift-N"), "{} in {size:?}", scene.name);
                            assert!(
                                !figures || words.iter().any(|word| word == "effects"),
                                "{} in {size:?}",
                                scene.name
                            );
                        }
                    }
                }
            }
        }
    }

    /// With the error map and two shadings there is something at the right side, which nothing covers.
    #[test]
    fn figures_cover_nothing_at_the_other_side() {
        let mut demo = demo("torus");
        demo.show.halves[0].shading = ShadingChoice::new("flat".parse().expect("a shading"), None);
        demo.show.halves[1].shading = ShadingChoice::new("gouraud-8.8-reseeded".parse().expect("a shading"), None);
        for (map, divider) in [(true, None), (false, Some(160)), (true, Some(160))] {
            (demo.panels.maps.is_on, demo.show.divider) = (map, divider);
            demo.draw().expect("a legal scene");
            for size in WINDOWS.into_iter().chain([(320, 240), (400, 300)]) {
                for (help, figures) in [(true, false), (false, true), (true, true)] {
                    (demo.show.help, demo.show.figures) = (Pages::default(), Pages::default());
                    (demo.show.help.is_open, demo.show.figures.is_open) = (help, figures);
                    assert_eq!(
                        demo.sheet(size).faults(),
                        [""; 0],
                        "map {map}, {divider:?}, {size:?}, {help} {figures}"
                    );
                }
            }
        }
    }

    #[test]
    fn one_is_not_said_in_the_plural() {
        assert_eq!(counted(1, "object"), "1 object");
        assert_eq!(counted(0, "object"), "0 objects");
        let Demo { show, panels } = demo("torus");
        let rows = panels.scenes.figures(&show);
        assert!(rows.iter().any(|row| format!("{row:?}").contains("1 object, 2304 triangles")), "{rows:?}");
    }

    #[test]
    fn the_title_has_the_time_of_the_shading_that_it_names() {
        let mut demo = demo("torus");
        let times: Vec<f64> = ["flat", "phong"]
            .map(|shading| {
                demo.show.halves[0].shading = ShadingChoice::new(shading.parse().expect("a shading"), None);
                demo.show.halves[0].forget_times();
                demo.draw().expect("a legal scene");
                assert_eq!(demo.title(), format!("torus - {shading} - {} - mode13h", demo.show.halves[0].timing));
                demo.show.halves[0].timing.frame
            })
            .into();
        assert!(times[0] != times[1] && times[0] > 0.0, "{times:?}");
        // Drawn again, the picture is the same.
        demo.draw().expect("a legal scene");
        assert!(demo.title().contains("not redrawn"), "{}", demo.title());
        assert_eq!(demo.show.halves[0].timing.frame, times[1]);
    }
}
