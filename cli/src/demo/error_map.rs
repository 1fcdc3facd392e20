//! Error map of a frame, pixel by pixel, computed in the background and laid over the picture.
//!
//! The picture under it is shown in greys: the map's palette has 128 of them, and a colour for each level of error. So
//! the picture stays recognizable, and E costs one table look-up per pixel.
//!
//! A map is only ever laid over the frame that it was computed for. While the picture moves on, the map is shown small
//! in a corner, over its own frame. First every fourth pixel of every fourth row is judged; that always finishes, so
//! the map keeps up with motion. Then the map is refined tile by tile, from the mouse outwards, until the picture
//! changes.

use std::ops::Range;
use std::sync::Arc;
use std::time::{Duration, Instant};

use mode13h::palette::{Palette, Rgb};
use mode13h::render::{Renderer, Screen};
use mode13h::scene::Scene;
use mode13h::vga::Vga;
use mode13h::window::Area;
use mode13h_lab::cost::{Probe, error_levels};
use mode13h_lab::truth::{ErrorMap, Face, Figures, Shown, Tiles, Truth, TruthFrame};

use super::background::{Background, Desk};
use crate::failure::Failure;
use crate::overlay::{Row, Sheet, Side as Edge};

/// The level of pixels that show the wrong face. It comes after those of the report and the page.
const OTHER_FACE: u8 = error_levels::ALL.len() as u8;
const LEVELS: u8 = OTHER_FACE + 1;
/// Number of greys that show the picture itself where it is right, which is the first level.
const GREYS: u8 = 128;

/// The colour of a level in the legend, and its label.
fn level(index: u8) -> (Rgb, &'static str) {
    let (color, label) = match error_levels::ALL.get(usize::from(index)) {
        Some(level) => (level.color, level.label),
        None => (error_levels::NOT_TAKEN, "another face"),
    };
    let [_, r, g, b] = color.to_be_bytes();
    (if index == 0 { Rgb::WHITE } else { Rgb::new(r, g, b) }, label)
}

/// Distance between the pixels that the first map judges, in columns and in rows.
const COARSE: u32 = 4;
/// The minimum time from one refined map to the next.
const REPORT: Duration = Duration::from_millis(60);
/// Sides of the small picture, as a share of the large one's.
const SMALL: f32 = 0.3;

/// A pixel of the frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Pixel {
    /// 0 to 319.
    pub(super) x: u16,
    /// 0 to 199.
    pub(super) y: u16,
}

impl Pixel {
    /// The pixel that contains a point, if that is on the picture; x and y are in pixels of the frame.
    pub(super) fn at((x, y): (f32, f32)) -> Option<Pixel> {
        let on_picture = (0.0..Vga::WIDTH as f32).contains(&x) && (0.0..Vga::HEIGHT as f32).contains(&y);
        // Whole numbers within the ranges above.
        on_picture.then_some(Pixel { x: x as u16, y: y as u16 })
    }
}

/// Picture to be measured: that of one renderer, or of two side by side.
pub(super) struct Frame {
    pub(super) snapshot: Snapshot,
    pub(super) scene: Scene,
    /// Renderers with the settings of those that drew it, from the left.
    pub(super) renderers: Vec<Renderer>,
    /// The pixel from which refinement starts.
    pub(super) mouse: Pixel,
}

/// The picture that a map belongs to.
#[derive(Clone)]
pub(super) struct Snapshot {
    /// Its number, which changes when the picture does.
    pub(super) number: u64,
    /// Time at which it is shown, in seconds.
    pub(super) seconds: f64,
    pub(super) picture: Vga,
    /// The column at which the second renderer's picture begins.
    pub(super) divider: usize,
    /// Shading of each side.
    pub(super) shadings: Vec<String>,
}

/// Result of measuring.
struct Measured {
    snapshot: Arc<Snapshot>,
    found: Result<Found, String>,
}

struct Found {
    /// One for each renderer.
    sides: Vec<Side>,
    /// Share of it that has been refined, 0 to 1.
    refined: f64,
}

/// Errors of a renderer's picture against the truth.
struct Side {
    /// The level of each pixel; `None` where there is no face and should be none.
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
    /// Asks for the frame with this number to be measured, unless that has been asked already, and takes any new
    /// results.
    pub(super) fn follow(&mut self, number: u64, frame: impl FnOnce() -> Frame) -> Result<(), Failure> {
        let thread = match &mut self.thread {
            Some(thread) => thread,
            none => {
                let mut probe = Probe::new(Renderer::new());
                let work = move |frame, desk: &Desk<Frame, Measured>| measure(&mut probe, frame, desk);
                none.insert(Background::start("error map", work)?)
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

    /// Results for the frame with this number.
    fn of(&self, number: u64) -> Option<&Found> {
        let measured = self.last.as_ref().filter(|measured| measured.snapshot.number == number)?;
        measured.found.as_ref().ok()
    }

    /// Figures of a side's errors in the frame with this number; `None` until all of its pixels have been judged.
    pub(super) fn errors_of(&self, number: u64, side: usize) -> Option<Figures> {
        let found = self.of(number).filter(|found| found.refined == 1.0)?;
        Some(found.sides.get(side)?.figures)
    }

    /// Describes the map's progress.
    fn state(&self, number: u64, seconds: f64) -> String {
        let Some(Measured { snapshot, found }) = &self.last else { return "computing".into() };
        let refined = found.as_ref().map_or(1.0, |found| found.refined);
        let progress = match refined {
            0.0 => ", coarse".into(),
            refined if refined < 1.0 => format!(", {:.0} %", 100.0 * refined),
            _ => String::new(),
        };
        if snapshot.number == number {
            format!("now{progress}")
        } else {
            format!("{:.1} s ago{progress}", (seconds - snapshot.seconds).max(0.0))
        }
    }

    /// Figures of the picture's errors, in a line.
    pub(super) fn figures(&self, number: u64, seconds: f64, budget: f32) -> String {
        let state = self.state(number, seconds);
        match self.last.as_ref().map(|measured| &measured.found) {
            None => format!("error against lit: {state}"),
            Some(Err(reason)) => format!("error: {reason}"),
            Some(Ok(Found { sides, .. })) => sides.first().map_or(String::new(), |side| {
                let share = 100.0 * side.errors.share_within(f64::from(budget));
                format!("error against lit {:.1}, {share:.2} % within {budget} ({state})", side.figures.max)
            }),
        }
    }

    /// Draws the map over what `vga` shows, if it belongs to that frame: the one with this number, whose second side
    /// begins at column `divider`. [`legend`](Self::legend) says what the colours mean.
    pub(super) fn lay_over(&self, vga: &mut Vga, number: u64, divider: usize) {
        if let Some(found) = self.of(number) {
            let entries = found.entries(vga, divider);
            vga.set_palette(&palette());
            vga.pixels_mut().copy_from_slice(&entries);
        }
    }

    /// Draws the map in a corner, over its own frame, if another frame is shown.
    pub(super) fn corner(&self, sheet: &mut Sheet, number: u64) {
        let Some(Measured { snapshot, found: Ok(found) }) = &self.last else { return };
        if snapshot.number == number {
            return;
        }
        let colors = *palette().colors();
        let entries = found.entries(&snapshot.picture, snapshot.divider);
        let picture = sheet.picture_area();
        // At most 0.3 of the window's sides, in pixels.
        let [width, height] = [picture.width, picture.height].map(|side| (side as f32 * SMALL) as usize);
        let (left, top) = (picture.left + picture.width - width, picture.top + picture.height - height);
        let rim =
            Area { left: left.saturating_sub(2), top: top.saturating_sub(2), width: width + 2, height: height + 2 };
        sheet.block(rim, Rgb::WHITE, 255);
        let colors = entries.into_iter().map(|entry| colors[usize::from(entry)]).collect();
        sheet.picture(Area { left, top, width, height }, colors, Vga::WIDTH);
    }

    /// Legend of the colours, and of the picture that they are laid over: with its shading, unless that `is_named`
    /// elsewhere.
    pub(super) fn legend(&self, sheet: &mut Sheet, number: u64, seconds: f64, is_named: bool) {
        let mut rows = vec![Row::text("error in shades")];
        let mut state = self.state(number, seconds);
        if let Some(Measured { snapshot, found }) = &self.last {
            if !is_named {
                rows.push(Row::text(format!("of {}", snapshot.shadings.join(" | "))));
            }
            rows.extend(found.as_ref().err().map(|reason| Row::text(reason.clone())));
            if snapshot.number != number {
                state = format!("small picture: {state}");
            }
        }
        rows.push(Row::text(state));
        rows.extend((0..LEVELS).map(level).map(|(color, label)| Row::color(color, label)));
        sheet.panel(Edge::Right, &rows, false, 0, "");
    }
}

impl Found {
    /// The bytes of a picture with the map over it, in the map's palette.
    fn entries(&self, vga: &Vga, divider: usize) -> Vec<u8> {
        let greys = vga.palette().colors().map(grey);
        let entry = |(place, &byte): (usize, &u8)| {
            let side = usize::from(place % Vga::WIDTH >= divider).min(self.sides.len().saturating_sub(1));
            match self.sides.get(side).and_then(|side| side.levels[place]) {
                None | Some(0) => greys[usize::from(byte)],
                Some(level) => GREYS + level,
            }
        };
        vga.pixels().iter().enumerate().map(entry).collect()
    }
}

/// The map's entry with the brightness of a colour.
fn grey(color: Rgb) -> u8 {
    // The brightness is at most 255,000, so the quotient at most 127.
    (color.brightness() * u32::from(GREYS) / 255_001) as u8
}

/// Greys, followed by the colours of the levels.
fn palette() -> Palette {
    let mut colors = [Rgb::BLACK; 256];
    for grey in 0..GREYS {
        let light = 2 * grey + u8::from(grey > 0);
        colors[usize::from(grey)] = Rgb::new(light, light, light);
    }
    for index in 0..LEVELS {
        colors[usize::from(GREYS + index)] = level(index).0;
    }
    Palette::from_colors(colors)
}

fn measure(probe: &mut Probe, frame: Frame, desk: &Desk<Frame, Measured>) {
    let snapshot = Arc::new(frame.snapshot);
    let say = |found| desk.give(Measured { snapshot: Arc::clone(&snapshot), found });
    let is_overtaken = || desk.is_overtaken();
    let found = find(probe, &frame.scene, frame.renderers, frame.mouse, &|found| say(Ok(found)), &is_overtaken);
    found.unwrap_or_else(|reason| say(Err(reason)));
}

/// Judges a frame and reports the results: first all of it coarsely, then, as long as no other frame is waiting, tile
/// by tile, with a report now and then and at the end.
fn find(
    probe: &mut Probe,
    scene: &Scene,
    renderers: Vec<Renderer>,
    mouse: Pixel,
    say: &dyn Fn(Found),
    is_overtaken: &dyn Fn() -> bool,
) -> Result<(), String> {
    let screen = Screen::MODE_13H;
    let mut shown = Vec::new();
    for renderer in renderers {
        *probe.renderer() = renderer;
        shown.push(probe.look(scene, screen).map_err(|error| error.to_string())?);
    }
    let truth = Truth::new(scene, screen).map_err(|error| error.to_string())?;
    let mut tiles = truth.tiles();
    let order = order(&tiles, &shown, mouse);
    let mut judged = Judged::new(tiles.empty_frame(), shown);
    for &tile in &order {
        tiles.draw(tile, COARSE, &mut judged.right);
        judged.know(tiles.area(tile), COARSE);
    }
    say(judged.found(0.0)?);
    let mut said = Instant::now();
    for (done, &tile) in order.iter().enumerate() {
        if is_overtaken() {
            return Ok(());
        }
        if said.elapsed() >= REPORT {
            // The share of some hundreds of tiles.
            say(judged.found(done as f64 / order.len() as f64)?);
            said = Instant::now();
        }
        tiles.draw(tile, 1, &mut judged.right);
        judged.know(tiles.area(tile), 1);
    }
    say(judged.found(1.0)?);
    Ok(())
}

/// The tiles that show anything, from the mouse outwards.
fn order(tiles: &Tiles<'_, '_>, shown: &[Shown], mouse: Pixel) -> Vec<usize> {
    let is_drawn = |tile: usize| {
        let [columns, rows] = tiles.area(tile);
        let mut pixels = rows.flat_map(|y| columns.clone().map(move |x| place(x, y)));
        !tiles.is_empty(tile) || pixels.any(|place| shown.iter().any(|shown| shown.faces[place].is_some()))
    };
    let mut order: Vec<usize> = (0..tiles.count()).filter(|&tile| is_drawn(tile)).collect();
    order.sort_by_key(|&tile| {
        let [x, y] = tiles.area(tile).map(|range| (range.start + range.end).div_ceil(2));
        x.abs_diff(mouse.x.into()).pow(2) + y.abs_diff(mouse.y.into()).pow(2)
    });
    order
}

fn place(x: u32, y: u32) -> usize {
    y as usize * Vga::WIDTH + x as usize
}

/// A frame that is being judged: the truth computed so far, and the pictures to compare with it.
struct Judged {
    /// The true frame.
    right: TruthFrame,
    /// Pixels of each picture: its faces where the truth is known, none elsewhere.
    known: Vec<Shown>,
    /// All faces of each picture.
    faces: Vec<Vec<Option<Face>>>,
    is_known: Vec<bool>,
}

impl Judged {
    fn new(right: TruthFrame, mut shown: Vec<Shown>) -> Judged {
        let nothing = |shown: &mut Shown| std::mem::replace(&mut shown.faces, vec![None; right.pixels.len()]);
        let faces = shown.iter_mut().map(nothing).collect();
        Judged { is_known: vec![false; right.pixels.len()], right, known: shown, faces }
    }

    /// Marks the truth as known for the pixels that a tile draws in steps of `step`.
    fn know(&mut self, [columns, rows]: [Range<u32>; 2], step: u32) {
        let is_drawn = |at: &u32| at % step == step / 2;
        for y in rows.filter(is_drawn) {
            for place in columns.clone().filter(is_drawn).map(|x| place(x, y)) {
                self.is_known[place] = true;
                for (known, faces) in self.known.iter_mut().zip(&self.faces) {
                    known.faces[place] = faces[place];
                }
            }
        }
    }

    /// Measures the pictures' errors against the truth, as far as it is known.
    fn found(&self, refined: f64) -> Result<Found, String> {
        let side = |(known, faces): (&Shown, &Vec<Option<Face>>)| {
            let errors = ErrorMap::new(&self.right, known).ok_or("the frames differ in size")?;
            let pixels = self.right.pixels.iter().zip(&known.faces);
            let levels = errors.errors().zip(pixels).map(|(error, (right, shown))| match error {
                Some(error) => Some(level_of(error)),
                None => (right.is_some() || shown.is_some()).then_some(OTHER_FACE),
            });
            let mut levels: Vec<Option<u8>> = levels.collect();
            self.spread(&mut levels, faces);
            Ok(Side { levels, figures: errors.figures(), errors })
        };
        Ok(Found { sides: self.known.iter().zip(&self.faces).map(side).collect::<Result<_, String>>()?, refined })
    }

    /// Gives pixels that are not known yet the level of the one that was judged for their block. Coverage errors
    /// concern single pixels, and are not spread.
    fn spread(&self, levels: &mut [Option<u8>], faces: &[Option<Face>]) {
        for i in (0..levels.len()).filter(|&i| !self.is_known[i] && faces[i].is_some()) {
            let coarse = COARSE as usize;
            let [x, y] = [i % Vga::WIDTH, i / Vga::WIDTH].map(|at| at / coarse * coarse + coarse / 2);
            levels[i] = levels[y * Vga::WIDTH + x].filter(|level| *level != OTHER_FACE);
        }
    }
}

/// The level of an error.
fn level_of(error: f64) -> u8 {
    // At most 255.
    error_levels::index_of(error as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mode13h::mesh::shapes;
    use mode13h::settings::Shading;
    use mode13h_lab::truth::Standard;

    #[test]
    fn every_level_has_a_colour_of_its_own() {
        let colors: std::collections::BTreeSet<[u8; 3]> =
            (0..LEVELS).map(|i| level(i).0).map(|Rgb { r, g, b }| [r, g, b]).collect();
        assert_eq!(colors.len(), usize::from(LEVELS));
        assert_eq!((grey(Rgb::BLACK), grey(Rgb::WHITE)), (0, GREYS - 1));
        assert_eq!((palette().colors()[0], palette().colors()[127]), (Rgb::BLACK, Rgb::WHITE));
    }

    fn frame(number: u64, scene: &Scene, shadings: &[Shading]) -> Frame {
        let mut picture = Vga::new();
        let renderer = |&shading: &Shading| {
            let mut renderer = Renderer::new();
            renderer.settings.accuracy = Some(shading.into());
            renderer.draw(scene, &mut picture).expect("a legal scene");
            renderer.with_same_settings()
        };
        let renderers = shadings.iter().map(renderer).collect();
        let shadings = shadings.iter().map(|shading| shading.name().to_string()).collect();
        let snapshot = Snapshot { number, seconds: 0.5, picture, divider: 100, shadings };
        Frame { snapshot, scene: scene.clone(), renderers, mouse: Pixel { x: 160, y: 100 } }
    }

    /// The whole truth against what is drawn.
    fn errors(scene: &Scene, shading: Shading) -> ErrorMap {
        let mut renderer = Renderer::new();
        renderer.settings.accuracy = Some(shading.into());
        let shown = Probe::new(renderer).look(scene, Screen::MODE_13H).expect("a legal scene");
        let truth = Truth::new(scene, Screen::MODE_13H).expect("a legal scene").draw(Standard::Lit);
        ErrorMap::new(&truth, &shown).expect("of one size")
    }

    /// Finds all results for a frame, in their order.
    fn all_found(scene: &Scene, shadings: &[Shading], is_overtaken: bool) -> Vec<Found> {
        let found = std::cell::RefCell::new(Vec::new());
        let Frame { renderers, mouse, .. } = frame(0, scene, shadings);
        let mut probe = Probe::new(Renderer::new());
        let say = |some| found.borrow_mut().push(some);
        find(&mut probe, scene, renderers, mouse, &say, &|| is_overtaken).expect("a legal scene");
        found.into_inner()
    }

    #[test]
    fn the_map_of_a_frame_that_stands_still_is_that_frames_own() {
        let scene = Scene::showing(shapes::torus(24, 12));
        let mut map = Map::default();
        assert_eq!(map.figures(3, 0.0, 1.0), "error against lit: computing");
        let mut asked = 0;
        while map.errors_of(3, 1).is_none() {
            let frame = || {
                asked += 1;
                frame(3, &scene, &[Shading::Flat, Shading::Phong])
            };
            map.follow(3, frame).expect("a thread");
        }
        assert_eq!(asked, 1);
        assert_eq!((map.state(3, 9.0), map.state(4, 0.75)), ("now".into(), "0.2 s ago".into()));
        for (side, shading) in [Shading::Flat, Shading::Phong].into_iter().enumerate() {
            assert_eq!(map.errors_of(3, side), Some(errors(&scene, shading).figures()));
        }
        assert!(map.errors_of(4, 0).is_none() && map.errors_of(3, 2).is_none());
        let found = map.of(3).expect("it came");
        // Each colour has as many pixels as there are errors in its range.
        let errors = errors(&scene, Shading::Flat);
        for index in 0..OTHER_FACE {
            let expected = errors.errors().flatten().filter(|error| level_of(*error) == index).count();
            assert_eq!(found.sides[0].levels.iter().filter(|there| **there == Some(index)).count(), expected);
        }
        let other = found.sides[0].levels.iter().filter(|level| **level == Some(OTHER_FACE)).count();
        assert_eq!(other, errors.cover_errors());
        // Laid over its picture, each side of the divider shows its own map: the bright pixels in their colours.
        let mut vga = Vga::new();
        let white = vga.palette().nearest(Rgb::WHITE);
        vga.pixels_mut().fill(white);
        let plain = vga.clone();
        map.lay_over(&mut vga, 3, 150);
        for x in 0..Vga::WIDTH {
            let place = 100 * Vga::WIDTH + x;
            let level = found.sides[usize::from(x >= 150)].levels[place].unwrap_or(0);
            assert_eq!(vga.pixels()[place], if level == 0 { GREYS - 1 } else { GREYS + level });
        }
        // It is not laid over another picture.
        let mut other = plain.clone();
        map.lay_over(&mut other, 4, 150);
        assert!(other.pixels() == plain.pixels() && other.palette() == plain.palette());
    }

    #[test]
    fn a_map_is_coarse_at_first_and_right_where_it_was_judged() {
        let scene = Scene::showing(shapes::torus(24, 12));
        let errors: Vec<Option<f64>> = errors(&scene, Shading::Flat).errors().collect();
        // Overtaken at once: a moving picture is judged coarsely all the same.
        let found = all_found(&scene, &[Shading::Flat], true);
        assert_eq!(found.len(), 1);
        let levels = &found[0].sides[0].levels;
        for y in (2..200).step_by(4) {
            for x in (2..320).step_by(4) {
                let right = errors[y * 320 + x].map(level_of);
                assert_eq!(levels[y * 320 + x].filter(|level| *level != OTHER_FACE), right, "({x}, {y})");
            }
        }
        let judged = (0..64_000).filter(|i| i % 4 == 2 && i / 320 % 4 == 2);
        assert_eq!(found[0].sides[0].figures.count as usize, judged.filter(|&i| errors[i].is_some()).count());
        // With time it is refined.
        let found = all_found(&scene, &[Shading::Flat], false);
        assert_eq!(found[0].sides[0].levels, *levels);
        let last = found.last().expect("the last");
        assert_eq!(last.refined, 1.0);
        assert_eq!(last.sides[0].errors.errors().collect::<Vec<_>>(), errors);
    }

    #[test]
    fn tiles_with_a_face_come_from_the_mouse_outwards() {
        let scene = Scene::showing(shapes::torus(24, 12));
        let shown = Probe::new(Renderer::new()).look(&scene, Screen::MODE_13H).expect("a legal scene");
        let truth = Truth::new(&scene, Screen::MODE_13H).expect("a legal scene");
        let tiles = truth.tiles();
        let order = order(&tiles, std::slice::from_ref(&shown), Pixel { x: 72, y: 110 });
        let [columns, rows] = tiles.area(order[0]);
        assert!(columns.contains(&72) && rows.contains(&110));
        let mut in_order = vec![false; Vga::SHOWN];
        for &tile in &order {
            let [columns, rows] = tiles.area(tile);
            rows.for_each(|y| columns.clone().for_each(|x| in_order[place(x, y)] = true));
        }
        assert!(shown.faces.iter().zip(&in_order).all(|(face, is_in)| face.is_none() || *is_in));
        assert!(order.len() < tiles.count());
    }
}
