//! How far each pixel of a frame is from the truth, worked out in the background and laid over the picture.
//!
//! The picture under it is another machine's: its palette has 32 entries of brightness in each of eight colours. So
//! what is shown stays recognizable, and E costs a table look-up a pixel.

use mode13h::cost::Probe;
use mode13h::palette::{Palette, Rgb};
use mode13h::render::{Renderer, Screen};
use mode13h::scene::Scene;
use mode13h::truth::{ErrorMap, Figures, Standard, Truth};
use mode13h::vga::Vga;

use super::background::Background;
use crate::failure::Failure;
use crate::overlay::{self, Anchor};

/// A colour of the map: below which error it stands, in shades, what the legend says, and the colour in full light.
struct Level {
    below: f64,
    label: &'static str,
    color: Rgb,
}

const fn level(below: f64, label: &'static str, color: u32) -> Level {
    Level { below, label, color: Rgb::from_u32(color) }
}

/// From right to wrong. The last is for pixels that show another face than they should.
const LEVELS: [Level; 8] = [
    level(0.5, "0", 0xFFFFFF),
    level(1.0, "0.5", 0x4C7DFF),
    level(2.0, "1", 0x20D8F0),
    level(4.0, "2", 0x30E040),
    level(8.0, "4", 0xF0F020),
    level(16.0, "8", 0xFF9018),
    level(f64::INFINITY, "16", 0xFF2020),
    level(f64::NAN, "face", 0xFF40F0),
];
/// The place of the last in [`LEVELS`].
const OTHER_FACE: u8 = 7;
/// Entries of brightness that each colour has.
const STEPS: u8 = 32;
/// What a colour keeps in the dark, of 256: else nobody could tell one from another there.
const LEAST: u32 = 112;
/// The same of what is right, which need not be told from anything.
const LEAST_GREY: u32 = 0;

/// What is to be measured.
pub(super) struct Frame {
    /// Its number, which changes when the picture does.
    pub(super) number: u64,
    /// When it is shown, in seconds.
    pub(super) seconds: f64,
    pub(super) scene: Scene,
    /// One set as that which drew it.
    pub(super) renderer: Renderer,
}

/// What was found.
pub(super) struct Measured {
    number: u64,
    seconds: f64,
    found: Result<Found, String>,
}

struct Found {
    /// Of each pixel its place in [`LEVELS`]; `None` where there is no face, nor should be.
    levels: Vec<Option<u8>>,
    errors: ErrorMap,
    figures: Figures,
}

/// The map of a recent frame, and the thread that works on the next.
#[derive(Default)]
pub(super) struct Map {
    thread: Option<Background<Frame, Measured>>,
    asked: Option<u64>,
    last: Option<Measured>,
}

impl Map {
    /// Has the frame measured that has this number, unless that was asked already, and takes what has been found
    /// since.
    pub(super) fn follow(&mut self, number: u64, frame: impl FnOnce() -> Frame) -> Result<(), Failure> {
        let thread = match &mut self.thread {
            Some(thread) => thread,
            none => {
                let mut probe = Probe::new(Renderer::new());
                let work = move |frame| measure(&mut probe, frame);
                none.insert(Background::start("error map", work).map_err(Failure::work)?)
            }
        };
        if self.asked != Some(number) {
            self.asked = Some(number);
            thread.ask(frame());
        }
        if let Some(measured) = thread.answer() {
            self.last = Some(measured);
        }
        Ok(())
    }

    /// How old it is when the frame of this number is shown, in words.
    fn age(&self, number: u64, seconds: f64) -> String {
        match &self.last {
            None => "computing".to_string(),
            Some(measured) if measured.number == number => "now".to_string(),
            Some(measured) => format!("-{:.1} s", (seconds - measured.seconds).max(0.0)),
        }
    }

    /// How far the picture is from the truth, in a line.
    pub(super) fn figures(&self, number: u64, seconds: f64, budget: f32) -> String {
        let age = self.age(number, seconds);
        match self.last.as_ref().map(|measured| &measured.found) {
            None => format!("error against lit: {age}"),
            Some(Err(reason)) => format!("error: {reason}"),
            Some(Ok(found)) => {
                let share = 100.0 * found.errors.share_within(f64::from(budget));
                format!("error to lit {:.1}, {share:.2} % within {budget} ({age})", found.figures.max)
            }
        }
    }

    /// Lays it over what `vga` shows. [`legend`](Self::legend) says what the colours mean.
    pub(super) fn lay_over(&self, vga: &mut Vga) {
        let found = self.last.as_ref().and_then(|measured| measured.found.as_ref().ok());
        let shown = vga.palette();
        let steps = shown.colors().map(step);
        vga.set_palette(&palette());
        for (i, pixel) in vga.pixels_mut().iter_mut().enumerate() {
            let level = found.and_then(|found| found.levels.get(i).copied().flatten()).unwrap_or(0);
            *pixel = level * STEPS + steps[usize::from(*pixel)];
        }
    }

    /// Draws the legend, and how old the map is, on a picture that it was laid over.
    pub(super) fn legend(&self, vga: &mut Vga, number: u64, seconds: f64) {
        legend(vga, &self.age(number, seconds));
    }
}

/// How bright a colour is, in the steps that each colour of the map has.
fn step(color: Rgb) -> u8 {
    // The brightness is at most 255,000, so the quotient at most 31.
    (color.brightness() * u32::from(STEPS) / 255_001) as u8
}

fn palette() -> Palette {
    let mut colors = [Rgb::BLACK; 256];
    for (i, level) in LEVELS.iter().enumerate() {
        let least = if i == 0 { LEAST_GREY } else { LEAST };
        for (step, color) in (0..).zip(&mut colors[i * usize::from(STEPS)..][..usize::from(STEPS)]) {
            let light = least + (256 - least) * step / u32::from(STEPS - 1);
            // At most 255 · 256 / 256.
            let lit = |channel: u8| (u32::from(channel) * light / 256) as u8;
            *color = Rgb::new(lit(level.color.r), lit(level.color.g), lit(level.color.b));
        }
    }
    Palette::from_colors(colors)
}

fn legend(vga: &mut Vga, age: &str) {
    let left = Vga::WIDTH as i32 - 34;
    // Nine lines of ten rows above the lower edge.
    let mut top = Vga::HEIGHT as i32 - 94;
    overlay::write_at(vga, (Vga::WIDTH as i32 - 4, top), Anchor::Right, age);
    for (i, level) in (0..).zip(&LEVELS) {
        top += 10;
        let full = i * STEPS + (STEPS - 1);
        overlay::block(vga, (left - 10, top), (10, 10), full);
        overlay::write_at(vga, (left, top), Anchor::Left, &format!(" {:4}", level.label));
    }
}

fn measure(probe: &mut Probe, frame: Frame) -> Measured {
    let Frame { number, seconds, scene, renderer } = frame;
    *probe.renderer() = renderer;
    Measured { number, seconds, found: find(probe, &scene) }
}

fn find(probe: &mut Probe, scene: &Scene) -> Result<Found, String> {
    let screen = Screen::MODE_13H;
    let shown = probe.look(scene, screen).map_err(|error| error.to_string())?;
    let truth = Truth::new(scene, screen).map_err(|error| error.to_string())?.draw(Standard::Lit);
    let errors = ErrorMap::new(&truth, &shown).ok_or("the frames differ in size")?;
    let faces = truth.pixels.iter().zip(&shown.faces);
    let levels = errors.errors().zip(faces).map(|(error, (right, shown))| match error {
        Some(error) => Some(level_of(error)),
        None => (right.is_some() || shown.is_some()).then_some(OTHER_FACE),
    });
    Ok(Found { levels: levels.collect(), figures: errors.figures(), errors })
}

/// The place in [`LEVELS`] of an error.
fn level_of(error: f64) -> u8 {
    // Of eight; an error is no number nowhere, and at most 255.
    LEVELS.iter().position(|level| error < level.below).unwrap_or(usize::from(OTHER_FACE)) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use mode13h::mesh::shapes;
    use mode13h::render::Rung;

    #[test]
    fn the_legend_says_from_which_error_on_a_colour_stands() {
        for (i, level) in LEVELS[..7].iter().enumerate() {
            let from: f64 = level.label.parse().expect("a number");
            assert_eq!(usize::from(level_of(from)), i);
            assert_eq!(level_of(from.next_down().max(0.0)), (i as u8).saturating_sub(1));
        }
        assert_eq!(level_of(255.0), 6);
        assert_eq!(usize::from(STEPS) * LEVELS.len(), 256);
        assert_eq!((step(Rgb::BLACK), step(Rgb::WHITE)), (0, STEPS - 1));
    }

    #[test]
    fn the_map_of_a_frame_that_stands_still_is_that_frames_own() {
        let scene = Scene::showing(shapes::torus(24, 12));
        let mut renderer = Renderer::new();
        renderer.set_rung(Rung::Flat);
        let mut map = Map::default();
        assert_eq!(map.figures(3, 0.0, 1.0), "error against lit: computing");
        let mut asked = 0;
        while map.last.is_none() {
            let frame = || {
                asked += 1;
                Frame { number: 3, seconds: 0.5, scene: scene.clone(), renderer: renderer.set_alike() }
            };
            map.follow(3, frame).expect("a thread");
        }
        assert_eq!(asked, 1);
        assert_eq!(map.age(3, 9.0), "now");
        assert_eq!(map.age(4, 0.75), "-0.2 s");
        let found = map.last.as_ref().expect("it came").found.as_ref().expect("a legal scene");
        // Of each colour as many pixels as there are errors in its range.
        let here = Probe::new(renderer).look(&scene, Screen::MODE_13H).expect("a legal scene");
        let truth = Truth::new(&scene, Screen::MODE_13H).expect("a legal scene").draw(Standard::Lit);
        let errors = ErrorMap::new(&truth, &here).expect("of one size");
        let mut from = 0.0;
        for (i, level) in (0..).zip(&LEVELS[..7]) {
            let expected = errors.errors().flatten().filter(|error| (from..level.below).contains(error)).count();
            assert_eq!(found.levels.iter().filter(|there| **there == Some(i)).count(), expected);
            from = level.below;
        }
        let other = found.levels.iter().filter(|level| **level == Some(OTHER_FACE)).count();
        assert_eq!(other, errors.cover_errors());
        // And laid over a picture: the bright pixels in their colours.
        let mut vga = Vga::new();
        let white = vga.palette().nearest(Rgb::WHITE);
        vga.pixels_mut().fill(white);
        map.lay_over(&mut vga);
        for x in 0..Vga::WIDTH {
            let place = 100 * Vga::WIDTH + x;
            let level = found.levels[place].unwrap_or(0);
            assert_eq!(vga.pixels()[place] / STEPS, level);
        }
    }
}
