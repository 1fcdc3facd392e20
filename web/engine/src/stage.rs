//! An opened scene: its moment, its settings, the frame that was drawn last.

use std::collections::BTreeMap;
use std::hint::black_box;
use std::io::{self, BufRead, Cursor};
use std::path::Path;
use std::sync::Arc;

use mode13h::export::{Picture, Png, Scale};
use mode13h::palette::{Palette, Rgb};
use mode13h::render::{Renderer, Screen, Stats};
use mode13h::scene::Scene;
use mode13h::vga::Vga;
use mode13h_assets::SceneExt;
use mode13h_assets::animation::{FrameRate, GifWriter};
use mode13h_assets::scene_file::SceneError;
use mode13h_lab::cost::{Probe, error_levels};
use mode13h_lab::truth::{ErrorMap, Standard, TruePixel, Truth, TruthFrame};
use serde_json::{Value, json};

use crate::turntable::{Colors, Pose, Turntable};
use crate::{report, settings};

/// The path of the scene file, for errors.
const PATH: &str = "scene.toml";

/// Level of a pixel that shows no face and should show none.
const BACKGROUND: u8 = 255;
/// Level of a pixel where no error was measured, because truth and frame show different faces. It follows the levels of
/// errors.
const NOT_COMPARED: u8 = error_levels::ALL.len() as u8;
/// Level of a pixel that exceeds the budget by no more than the rounding of corners explains.
const EDGE_ON: u8 = NOT_COMPARED + 1;

/// How far a byte may be off where light is computed at the pixel: half a shade plus the rounding of shades. No budget
/// can be kept more closely than that.
const LIT: f64 = 0.52;

pub(crate) struct Stage {
    turntable: Turntable,
    renderer: Renderer,
    /// The settings as given, for the probe.
    lines: String,
    vga: Box<Vga>,
    stats: Option<Stats>,
    warnings: Vec<String>,
    moment: (f64, Pose),
    /// The truth at this moment, with light at every pixel; computed on demand.
    truth: Option<TruthFrame>,
    probe: Probe,
    error_map: Vec<u8>,
    /// An animation, and the pose in which it begins.
    film: Option<(GifWriter<Vec<u8>>, Pose)>,
}

impl Stage {
    /// Opens the scene in a text. An error is JSON: its message, line and column.
    pub(crate) fn open(text: &[u8], files: &BTreeMap<String, Arc<[u8]>>) -> Result<Stage, Value> {
        let loaded = Scene::from_toml_bytes(text, PATH, |path| find(files, path)).map_err(|error| located(&error))?;
        let colors = match loaded.scene.auto_palette {
            true => Some(Colors::Auto),
            false => loaded.scene.palette.clone().map(Colors::from),
        };
        let mut turntable = Turntable::of_scene(loaded.scene);
        // The look's colours apply, too.
        if let Some(look) = loaded.look {
            turntable.set_look(look);
        }
        if let Some(colors) = colors {
            turntable.set_colors(&colors).map_err(|error| json!({ "message": error.to_string() }))?;
        }
        Ok(Stage {
            turntable,
            renderer: Renderer::new(),
            lines: String::new(),
            vga: Box::new(Vga::new()),
            stats: None,
            warnings: loaded.warnings,
            moment: (0.0, Pose::FIRST),
            truth: None,
            probe: Probe::new(Renderer::new()),
            error_map: vec![BACKGROUND; Vga::SHOWN],
            film: None,
        })
    }

    /// A short description of the scene.
    pub(crate) fn about(&self) -> Value {
        let scene = &self.turntable.scene;
        let faces: usize = scene.objects().iter().map(|object| object.mesh().triangles().len()).sum();
        json!({
            "name": scene.name, "duration": scene.duration, "picture": scene.picture, "objects": scene.objects().len(),
            "faces": faces, "warnings": self.warnings,
        })
    }

    pub(crate) fn set(&mut self, lines: &str) -> Result<(), String> {
        settings::apply(&mut self.renderer, lines)?;
        self.lines = lines.into();
        Ok(())
    }

    pub(crate) fn show(&mut self, seconds: f64, pose: Pose) -> Result<(), String> {
        if ![seconds, pose.turn, pose.tilt, pose.zoom].iter().all(|number| number.is_finite()) || pose.zoom <= 0.0 {
            return Err("the moment is not a number".into());
        }
        if self.moment != (seconds, pose) {
            self.moment = (seconds, pose);
            self.truth = None;
        }
        self.turntable.show(seconds, pose);
        Ok(())
    }

    pub(crate) fn draw(&mut self, again: bool) -> Result<(), String> {
        if again {
            // Touching the video memory makes the renderer draw again.
            black_box(self.vga.pixels_mut());
        }
        let stats = self.renderer.draw(&self.turntable.scene, &mut self.vga).map_err(|error| error.to_string())?;
        self.stats = Some(stats);
        Ok(())
    }

    pub(crate) fn frame(&self) -> Vec<u8> {
        with_palette(self.vga.pixels().to_vec(), &self.vga.palette())
    }

    pub(crate) fn counts(&self) -> Value {
        self.stats.as_ref().map_or(Value::Null, report::counts)
    }

    pub(crate) fn plan(&self) -> Value {
        report::plan(&self.renderer.rows(&self.turntable.scene))
    }

    pub(crate) fn explain(&mut self, x: u32, y: u32) -> Result<Value, String> {
        report::pixel(&mut self.renderer, &self.turntable.scene, x, y)
    }

    /// The truth at this moment.
    fn truth(&mut self) -> Result<&TruthFrame, String> {
        if self.truth.is_none() {
            self.truth = Some(self.truth_by(Standard::Lit)?);
        }
        self.truth.as_ref().ok_or_else(|| "no truth".into())
    }

    fn truth_by(&self, standard: Standard) -> Result<TruthFrame, String> {
        let truth = Truth::new(&self.turntable.scene, Screen::MODE_13H).map_err(|error| error.to_string())?;
        if standard != Standard::Lit {
            return Ok(truth.draw(standard));
        }
        let mut tiles = truth.tiles();
        let mut frame = tiles.empty_frame();
        (0..tiles.count()).for_each(|tile| tiles.draw(tile, 1, &mut frame));
        Ok(frame)
    }

    /// The true picture: each intensity rounded to the nearest entry of its material's ramp or, where there are three
    /// channels, of the palette.
    pub(crate) fn exact(&mut self, standard: usize) -> Result<Vec<u8>, String> {
        let standard = Standard::ALL.get(standard).copied().unwrap_or(Standard::Lit);
        let truth = if standard == Standard::Lit { self.truth()?.clone() } else { self.truth_by(standard)? };
        let scene = &self.turntable.scene;
        self.vga.set_palette(scene.palette.as_ref().unwrap_or(&mode13h::palette::BIOS));
        scene.load_palette(&mut self.vga);
        let shown = self.vga.palette();
        let entry =
            |pixel: &Option<TruePixel>| pixel.as_ref().map_or(scene.background, |pixel| entry(scene, &shown, pixel));
        Ok(with_palette(truth.pixels.iter().map(entry).collect(), &shown))
    }

    /// Compares the frame of the moment with the truth. With a budget, pixels that exceed it by no more than the
    /// rounding of corners explains are counted separately: their faces are seen edge-on.
    pub(crate) fn judge(&mut self) -> Result<Value, String> {
        settings::apply(self.probe.renderer(), &self.lines)?;
        let screen = Screen::MODE_13H;
        let shown = self.probe.look(&self.turntable.scene, screen).map_err(|error| error.to_string())?;
        let max_error = self.stats.as_ref().and_then(|stats| stats.max_error);
        let allowed = max_error.map_or(f64::INFINITY, |shades| f64::from(shades).max(LIT));
        self.truth()?;
        let frame = self.truth.as_ref().ok_or("no truth")?;
        let errors = ErrorMap::new(frame, &shown).ok_or("truth and frame differ in size")?;
        let figures = errors.figures();
        // How far a corner may have moved takes long to compute, and matters only if a pixel exceeds the budget.
        let truth = (figures.max > allowed).then(|| Truth::new(&self.turntable.scene, screen)).transpose();
        let truth = truth.map_err(|error| error.to_string())?;
        let (mut max, mut edge_on, mut beyond) = (0.0_f64, (0_u32, 0.0_f64), 0_u32);
        let mut map = Vec::with_capacity(frame.pixels.len());
        for (place, ((error, right), face)) in errors.errors().zip(&frame.pixels).zip(&shown.faces).enumerate() {
            map.push(match (error, right, face) {
                (Some(error), Some(right), _) => {
                    // Below 320 and 200.
                    let (x, y) = (place as u32 % screen.width, place as u32 / screen.width);
                    let shift = || truth.as_ref().and_then(|truth| truth.rounding_shift(right.face, x, y));
                    if error > allowed && error - shift().unwrap_or_default() <= allowed {
                        edge_on = (edge_on.0 + 1, edge_on.1.max(error));
                        EDGE_ON
                    } else {
                        max = max.max(error);
                        beyond += u32::from(error > allowed);
                        error_levels::index_of(error as f32)
                    }
                }
                (None, None, None) => BACKGROUND,
                _ => NOT_COMPARED,
            });
        }
        self.error_map = map;
        Ok(json!({
            "max": max, "mean": figures.mean(), "rms": figures.rms(), "compared": figures.count,
            "coverErrors": errors.cover_errors(), "maxError": max_error, "beyond": beyond,
            "edgeOn": { "pixels": edge_on.0, "max": edge_on.1 },
        }))
    }

    pub(crate) fn error_map(&self) -> &[u8] {
        &self.error_map
    }

    pub(crate) fn png(&self) -> Result<Vec<u8>, String> {
        let palette = self.vga.palette();
        Png::default().encode(&Picture::mode_13h(self.vga.pixels(), &palette)).map_err(|error| error.to_string())
    }

    /// Adds a frame of one loop, from the pose shown last, to the animation.
    pub(crate) fn film(&mut self, number: u32, frames: u32) -> Result<Vec<u8>, String> {
        let new = || GifWriter::new(Vec::new(), Scale::To { width: 640, height: 480 }, FrameRate::default());
        if number == 0 {
            self.film = Some((new(), self.moment.1));
        }
        let (mut film, first) = self.film.take().ok_or("the film has no first frame")?;
        let degrees = 360.0 * f64::from(number) / f64::from(frames.max(1));
        let (seconds, pose) = self.turntable.turned(0.0, degrees);
        self.show(seconds, Pose { turn: first.turn + pose.turn, ..first })?;
        self.draw(false)?;
        film.add(&Picture::mode_13h(self.vga.pixels(), &self.vga.palette())).map_err(|error| error.to_string())?;
        if number + 1 < frames {
            self.film = Some((film, first));
            return Ok(Vec::new());
        }
        film.finish().map(|(bytes, _)| bytes).map_err(|error| error.to_string())
    }
}

/// Entry of the palette for a true pixel.
fn entry(scene: &Scene, palette: &Palette, pixel: &TruePixel) -> u8 {
    let object = &scene.objects()[pixel.face.object];
    let surface = usize::from(object.mesh().triangle_surfaces()[pixel.face.triangle]);
    let [red, green, blue] = pixel.intensity;
    match object.materials.get(surface) {
        Some(material) if !material.takes_channels() && red == green && green == blue => {
            let ramp = material.ramp.in_palette(scene.palette.as_ref());
            // At most 255.
            ramp.index((red * f64::from(ramp.entries() - 1) + 0.5) as u16)
        }
        _ => palette.nearest(Rgb::from_intensities(pixel.intensity.map(|channel| channel as f32))),
    }
}

/// A picture's bytes followed by those of its palette.
fn with_palette(mut bytes: Vec<u8>, palette: &Palette) -> Vec<u8> {
    bytes.extend(palette.colors().iter().flat_map(|color| [color.r, color.g, color.b]));
    bytes
}

/// The file with this path or, as a page has no folders, with this name.
fn find(files: &BTreeMap<String, Arc<[u8]>>, path: &Path) -> io::Result<Box<dyn BufRead>> {
    let path = path.to_string_lossy();
    let name = path.rsplit(['/', '\\']).next().unwrap_or_default();
    let same = |(known, _): &(&String, _)| known.eq_ignore_ascii_case(name);
    let found = files.get(&*path).or_else(|| files.iter().find(same).map(|(_, contents)| contents));
    let Some(contents) = found else {
        return Err(io::Error::new(
            io::ErrorKind::NotFound,
            "this file is not on the page: drop it together with the model",
        ));
    };
    Ok(Box::new(Cursor::new(Arc::clone(contents))))
}

/// An error of a scene, without a file name, since the page has no file.
fn located(error: &SceneError) -> Value {
    let words = error.to_string();
    let place = error.place.as_ref().map(|place| (place.line, place.column));
    let prefix = place.map_or(format!("{PATH}: "), |(line, column)| format!("{PATH}:{line}:{column}: "));
    json!({
        "message": words.strip_prefix(&prefix).unwrap_or(&words),
        "line": place.map(|place| place.0),
        "column": place.map(|place| place.1),
    })
}
