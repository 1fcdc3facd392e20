//! Options that several commands share, and what may stand behind them.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use mode13h::glam::Vec3;
use mode13h::mesh::obj;
use mode13h::palette::{Rgb, builtin};
use mode13h::render::{Accuracy, HiddenSurfaces, Mapping, Renderer, Settings, Shading, VertexPath};
use mode13h::scene::{Preferences, Scene, UpAxis};
use mode13h::span::Kernel;

use crate::failure::Failure;
use crate::input::{self, Colors, Input, Model};
use crate::turntable::{Background, Turntable};

/// The environment variable that stands in for `--kernel`. The library reads none.
const KERNEL_VARIABLE: &str = "MODE13H_KERNEL";

/// How a model or a scene is drawn. What is not said here the scene says, or else the library chooses.
#[derive(Args, Clone)]
pub(crate) struct Drawing {
    #[arg(long, value_name = "SHADING", help = help_on_shadings())]
    shading: Option<Shading>,
    /// Spend the least time that keeps every face within so many shades of error, of 1/255 of full intensity
    #[arg(long, value_name = "SHADES", value_parser = shades, conflicts_with = "shading")]
    max_error: Option<f32>,
    #[arg(long, value_name = "FILE|NAME|auto", help = help_on_palettes())]
    palette: Option<OsString>,
    #[arg(long, value_name = "NAME", value_parser = Kernel::by_name, help = help_on_kernels())]
    kernel: Option<Kernel>,
    #[arg(long, value_name = "WAY", help = help_on_hidden_surfaces())]
    hidden: Option<HiddenSurfaces>,
    #[arg(long, value_name = "WAY", help = help_on_mappings())]
    mapping: Option<Mapping>,
    /// Smaller copies of textures where these are far away [default: as the scene calls for]
    #[arg(long, value_name = "WHETHER", value_enum)]
    mipmaps: Option<Switch>,
    #[arg(long, value_name = "PATH", help = help_on_vertex_paths())]
    vertex_path: Option<VertexPath>,
    /// The axis of a model that points up [default: y]
    #[arg(long, value_name = "AXIS", value_enum)]
    up: Option<Up>,
    /// Show an edge where faces of a model without normals meet at more than this angle: 180 is smooth everywhere, 0 flat
    /// [default: the model's smoothing groups, or else 40; scans are smooth]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = crease)]
    crease: Option<f32>,
    /// Show it so many times as large
    #[arg(long, value_name = "FACTOR", value_parser = factor)]
    zoom: Option<f64>,
    /// Look from the point EYE at the point TARGET, each X,Y,Z in the scene's units; of a model, from its middle
    /// [default: as it is framed; the TARGET, 0,0,0]
    #[arg(long, value_name = "EYE[:TARGET]", value_parser = camera, allow_hyphen_values = true)]
    camera: Option<(Vec3, Vec3)>,
    /// What the frame is cleared to: a colour, '#rrggbb' or rrggbb, of which the nearest entry is taken, or an entry of the
    /// palette, 0 to 255 [default: the scene's, or 0]
    #[arg(long, value_name = "COLOUR", value_parser = background)]
    background: Option<Background>,
    /// Show shades between two entries of the palette as a pattern of both [default: as the scene says]
    #[arg(long, value_name = "on|off", value_parser = switch, num_args = 0..=1, require_equals = true,
        default_missing_value = "on")]
    dither: Option<bool>,
}

/// Which moment of a scene is drawn.
#[derive(Args)]
pub(crate) struct Moment {
    /// The time of the frame, or of the first of several: of a scene, or of a model, which turns 90 degrees a second
    /// [default: 0; of one frame that --turn does not turn, the scene's `picture`]
    #[arg(long, value_name = "SECONDS", value_parser = finite, allow_negative_numbers = true, visible_alias = "at")]
    time: Option<f64>,
}

impl Moment {
    /// In seconds, of one frame of a scene.
    pub(crate) fn of_picture(&self, scene: &Scene) -> f64 {
        self.time.unwrap_or(scene.picture)
    }

    /// In seconds, of the first of several frames.
    pub(crate) fn of_first(&self) -> f64 {
        self.time.unwrap_or_default()
    }
}

/// The axis of a model that points up: y in most, z in those from CAD and geography.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Up {
    Y,
    Z,
}

/// Whether something is done.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Switch {
    On,
    Off,
}

impl From<Up> for UpAxis {
    fn from(up: Up) -> UpAxis {
        match up {
            Up::Y => UpAxis::Y,
            Up::Z => UpAxis::Z,
        }
    }
}

impl Drawing {
    /// The kernel that was asked for by option or else by environment, or the fastest.
    pub(crate) fn kernel(&self) -> Result<Kernel, Failure> {
        if let Some(kernel) = self.kernel {
            return Ok(kernel);
        }
        match std::env::var_os(KERNEL_VARIABLE) {
            Some(name) if !name.is_empty() => {
                let name = name.to_string_lossy();
                Kernel::by_name(&name).map_err(|error| Failure::words(format!("{KERNEL_VARIABLE}={name}: {error}")))
            }
            _ => Ok(Kernel::fastest()),
        }
    }

    /// What INPUT says, read as was asked for.
    pub(crate) fn input(&self, words: &OsStr) -> Result<Input, Failure> {
        let input = input::input(words, &obj::Options { crease: self.crease })?;
        if self.crease.is_some() && matches!(input, Input::Scene { .. }) {
            return Err(Failure::words("--crease is for models: a scene says itself what each of its models has"));
        }
        Ok(input)
    }

    /// What INPUT shows, drawn as was asked for.
    pub(crate) fn stage(&self, input: Input) -> Result<Turntable, Failure> {
        let asked = self.palette.as_deref().map(input::colors).transpose()?.map(|(_, colors)| colors);
        let (mut stage, usual) = match input {
            Input::Model(model) => {
                let Model { mesh, .. } = *model;
                let textures = input::textures(&mesh);
                let stage = Turntable::of_model(mesh, self.up.unwrap_or(Up::Y).into(), &textures);
                let colors = if stage.has_colors() { Colors::Auto } else { builtin::GREY.clone().into() };
                (stage, Some(colors))
            }
            Input::Scene { .. } if self.up.is_some() => {
                return Err(Failure::words(
                    "--up is for models: a scene says itself which axis of each of its models points up",
                ));
            }
            Input::Scene { scene, .. } => {
                let auto = scene.preferences.auto_palette.then_some(Colors::Auto);
                let colors = auto.or(scene.palette.clone().map(Colors::from));
                (Turntable::of_scene(*scene), colors)
            }
        };
        if let Some(zoom) = self.zoom {
            stage.set_zoom(zoom);
        }
        if let Some((eye, target)) = self.camera {
            stage.set_camera(eye, target);
        }
        if let Some(background) = self.background {
            stage.set_background(background);
        }
        if let Some(dither) = self.dither {
            stage.set_dither(dither);
        }
        let colors = asked.or(usual);
        if colors == Some(Colors::Auto) && self.vertex_path == Some(VertexPath::Integer) {
            stage.only_what_integers_draw();
        }
        if let Some(colors) = &colors {
            stage.set_colors(colors).map_err(Failure::work)?;
        }
        Ok(stage)
    }

    /// What the palette is called that was asked for.
    pub(crate) fn palette_name(&self) -> Option<String> {
        let words = self.palette.as_deref()?;
        Some(Path::new(words).file_stem().unwrap_or(words).to_string_lossy().into_owned())
    }

    /// The palette that was asked for, if that is a file.
    pub(crate) fn palette_file(&self) -> Option<PathBuf> {
        let words = self.palette.as_deref()?;
        let is_name = words == input::AUTO || words.to_str().and_then(builtin::by_name).is_some();
        (!is_name).then(|| PathBuf::from(words))
    }

    /// Whether a shading or a budget was asked for.
    pub(crate) fn chooses_shading(&self) -> bool {
        self.accuracy().is_some()
    }

    /// How exact shades are, if that was asked for.
    fn accuracy(&self) -> Option<Accuracy> {
        self.max_error.map(Accuracy::WithinError).or(self.shading.map(Accuracy::Shading))
    }

    /// How exact shades of a scene with these preferences are to be.
    pub(crate) fn accuracy_for(&self, preferences: &Preferences) -> Accuracy {
        Settings { accuracy: self.accuracy(), ..Settings::default() }.resolve(preferences).asked
    }

    /// The mapping that was asked for.
    pub(crate) fn mapping(&self) -> Option<Mapping> {
        self.mapping
    }

    /// What draws as was asked for.
    pub(crate) fn renderer(&self, kernel: Kernel) -> Renderer {
        let mut renderer = Renderer::new();
        renderer.set_kernel(kernel);
        renderer.set_hidden_surfaces(self.hidden);
        renderer.set_mapping(self.mapping);
        renderer.set_mipmaps(self.mipmaps.map(|mipmaps| mipmaps == Switch::On));
        renderer.set_vertex_path(self.vertex_path.unwrap_or_default());
        renderer.set_accuracy(self.accuracy());
        renderer
    }
}

/// A number on the command line.
pub(crate) fn finite(words: &str) -> Result<f64, String> {
    match words.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err("not a number".to_string()),
    }
}

/// How many times as large, on the command line.
fn factor(words: &str) -> Result<f64, String> {
    match words.parse::<f64>() {
        // Beyond these a camera's f32 shows nothing.
        Ok(number) if (1e-3..=1e3).contains(&number) => Ok(number),
        _ => Err("not a number from 0.001 to 1000".to_string()),
    }
}

/// A camera's place, and what it looks at, on the command line.
fn camera(words: &str) -> Result<(Vec3, Vec3), String> {
    let point = |words: &str| {
        let numbers: Option<Vec<f32>> = words.split(',').map(|word| word.trim().parse().ok()).collect();
        let point = numbers.and_then(|numbers| <[f32; 3]>::try_from(numbers).ok()).map(Vec3::from_array);
        let reason = || format!("{words:?} is no point: three numbers with commas between them, such as 0,1.5,4");
        point.filter(|point| point.is_finite()).ok_or_else(reason)
    };
    let (eye, target) = match words.split_once(':') {
        Some((eye, target)) => (point(eye)?, point(target)?),
        None => (point(words)?, Vec3::ZERO),
    };
    if eye == target {
        return Err("it looks at the point where it is".to_string());
    }
    Ok((eye, target))
}

/// What a frame is cleared to, on the command line.
fn background(words: &str) -> Result<Background, String> {
    let digits = words.strip_prefix('#').unwrap_or(words);
    let is_color = digits.len() == 6 && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    if is_color && let Ok(color) = u32::from_str_radix(digits, 16) {
        let [_, r, g, b] = color.to_be_bytes();
        return Ok(Background::Color(Rgb::new(r, g, b)));
    }
    let entry = words.parse().map(Background::Entry);
    entry.map_err(|_| "neither a colour such as '#203040' nor an entry of the palette, 0 to 255".to_string())
}

fn switch(words: &str) -> Result<bool, String> {
    match words {
        "on" => Ok(true),
        "off" => Ok(false),
        _ => Err("neither on nor off".to_string()),
    }
}

/// An angle between faces on the command line, in degrees.
pub(crate) fn crease(words: &str) -> Result<f32, String> {
    match words.parse::<f32>() {
        Ok(degrees) if (0.0..=180.0).contains(&degrees) => Ok(degrees),
        _ => Err("not a number of degrees from 0 to 180".to_string()),
    }
}

/// A number of shades on the command line.
pub(crate) fn shades(words: &str) -> Result<f32, String> {
    match words.parse::<f32>() {
        Ok(number) if number.is_finite() && number > 0.0 => Ok(number),
        _ => Err("not a number of shades above 0".to_string()),
    }
}

fn help_on_shadings() -> String {
    let names = Shading::ALL.map(Shading::name).join(", ");
    format!("How faces are shaded: {names} [default: the scene's, or {}]", Shading::default())
}

fn help_on_hidden_surfaces() -> String {
    let names = HiddenSurfaces::ALL.map(HiddenSurfaces::name).join(", ");
    format!("How hidden surfaces are left out: {names} [default: as the scene calls for]")
}

fn help_on_mappings() -> String {
    let names = Mapping::ALL.map(Mapping::name).join(", ");
    format!("How textures are mapped: {names} [default: as the scene calls for]")
}

fn help_on_vertex_paths() -> String {
    let names = VertexPath::ALL.map(VertexPath::name).join(", ");
    format!("The numbers that vertices are made in: {names} (16.16) [default: {}]", VertexPath::default())
}

fn help_on_palettes() -> String {
    let (names, extensions) = (input::palette_names(), input::palette_extensions());
    let usual = "the scene's; of a model, auto if it has colours of its own, else grey";
    format!("The palette: auto, made for what is seen; {names}; or a file ({extensions}) [default: {usual}]")
}

fn help_on_kernels() -> String {
    let names: Vec<&str> = Kernel::available().map(Kernel::name).collect();
    format!(
        "The span kernel: {} [default: {KERNEL_VARIABLE} if it is set, else the fastest, {}]",
        names.join(", "),
        Kernel::fastest().name()
    )
}
