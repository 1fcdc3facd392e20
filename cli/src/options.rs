//! Options that several commands share, and what may stand behind them.

mod shading;

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::palette::{Rgb, builtin};
use mode13h::render::Renderer;
use mode13h::scene::{Scene, UpAxis};
use mode13h::settings::DitherPattern;
use mode13h::settings::{HiddenSurfaces, Mapping, VertexPath};
use mode13h::span::Kernel;
use mode13h_assets::model_file::Options;

use crate::failure::Failure;
use crate::input::{self, Input};
use crate::turntable::{Background, Colors, Turntable};
pub(crate) use shading::{ShadingOptions, pace};

/// The environment variable that stands in for `--kernel`. The library reads none.
const KERNEL_VARIABLE: &str = "MODE13H_KERNEL";

/// What is drawn, and how, except for the shading. The scene decides what the options leave open, and the library what
/// the scene does.
#[derive(Args, Clone)]
#[command(next_help_heading = "What is drawn")]
pub(crate) struct Drawing {
    /// Enlarge what is seen
    #[arg(long, value_name = "FACTOR", value_parser = factor)]
    zoom: Option<f64>,
    /// Look from the point EYE at the point TARGET
    ///
    /// Each point is X,Y,Z in units of the scene; for a model, from its middle.
    ///
    /// [default: the scene's camera, or one that shows all of the model; TARGET is 0,0,0]
    #[arg(long, value_name = "EYE[:TARGET]", value_parser = camera, allow_hyphen_values = true)]
    camera: Option<(Vec3, Vec3)>,
    /// The axis of a model that points up [default: y; z for a sheet that looks along it]
    #[arg(long, value_name = "AXIS", value_enum)]
    up: Option<Up>,
    /// The angle beyond which faces of a model meet at an edge
    ///
    /// It is for models without normals: 180 makes them smooth everywhere, 0 flat.
    ///
    /// [default: the model's smoothing groups, otherwise 40; scans are smooth]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = crease)]
    crease: Option<Angle>,
    #[arg(
        long,
        value_name = "FILE|NAME",
        help = "The palette: a file, a built-in one, or auto",
        long_help = long_help_on_palettes(),
    )]
    palette: Option<OsString>,
    /// What the frame is cleared to: a colour or an entry
    ///
    /// A colour is written '#rrggbb' or rrggbb; the palette's nearest entry is taken. An entry is 0 to 255.
    ///
    /// [default: the scene's, otherwise entry 0]
    #[arg(long, value_name = "COLOUR", value_parser = background)]
    background: Option<Background>,
    #[command(flatten)]
    pipeline: Pipeline,
}

/// How triangles become bytes.
#[derive(Args, Clone)]
#[command(next_help_heading = "How it is drawn")]
struct Pipeline {
    #[arg(
        long,
        value_name = "NAME",
        value_parser = one_of(HiddenSurfaces::ALL, HiddenSurfaces::name),
        hide_possible_values = true,
        help = "How hidden surfaces are left out",
        long_help = long_help_on_names("How hidden surfaces are left out", &HiddenSurfaces::ALL.map(HiddenSurfaces::name)),
    )]
    hidden_surfaces: Option<HiddenSurfaces>,
    #[arg(
        long,
        value_name = "NAME",
        value_parser = one_of(Mapping::ALL, Mapping::name),
        hide_possible_values = true,
        help = "How textures are mapped",
        long_help = long_help_on_names("How textures are mapped", &Mapping::ALL.map(Mapping::name)),
    )]
    mapping: Option<Mapping>,
    /// Draw distant textures from smaller copies
    ///
    /// [default: as the scene calls for]
    #[arg(long, value_name = "on|off", value_parser = switch, num_args = 0..=1, default_missing_value = "on")]
    mipmaps: Option<bool>,
    /// Split faces until linear shades are off by at most N shades
    ///
    /// A shade is 1/255 of full intensity.
    ///
    /// [default: the scene's, otherwise no face is split]
    #[arg(long, value_name = "N", value_parser = shades)]
    tessellation: Option<f32>,
    #[arg(
        long,
        value_name = "on|off|PATTERN",
        value_parser = dither,
        num_args = 0..=1,
        default_missing_value = "on",
        help = "Show shades between two entries as a pattern of both",
        long_help = long_help_on_dither(),
    )]
    dither: Option<Dither>,
    #[arg(
        long,
        value_name = "NAME",
        value_parser = one_of(VertexPath::ALL, VertexPath::name),
        hide_possible_values = true,
        help = "The numbers that vertices are made in",
        long_help = long_help_on_arithmetic(),
    )]
    arithmetic: Option<VertexPath>,
    #[arg(
        long,
        value_name = "NAME",
        value_parser = str::parse::<Kernel>,
        help = "The span kernel",
        long_help = long_help_on_kernels(),
    )]
    kernel: Option<Kernel>,
}

/// Which moment of a scene is drawn.
#[derive(Args)]
pub(crate) struct Moment {
    /// The time of the frame, or of the first one
    ///
    /// A model turns by 90 degrees in a second.
    ///
    /// [default: for a single frame that is not turned, the scene's `picture`; otherwise 0]
    #[arg(long, value_name = "SECONDS", value_parser = finite, allow_negative_numbers = true, visible_alias = "at")]
    time: Option<f64>,
}

impl Moment {
    /// Time in seconds of one frame of a scene.
    pub(crate) fn of_picture(&self, scene: &Scene) -> f64 {
        self.time.unwrap_or(scene.picture)
    }

    /// Time in seconds of the first of several frames.
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
        if let Some(kernel) = self.pipeline.kernel {
            return Ok(kernel);
        }
        match std::env::var_os(KERNEL_VARIABLE) {
            Some(name) if !name.is_empty() => {
                let name = name.to_string_lossy();
                name.parse::<Kernel>().map_err(|error| Failure::words(format!("{KERNEL_VARIABLE}={name}: {error}")))
            }
            _ => Ok(Kernel::default()),
        }
    }

    /// Reads INPUT as was asked for.
    pub(crate) fn input(&self, words: &OsStr) -> Result<Input, Failure> {
        let input = input::input(words, &Options { crease: self.crease })?;
        if self.crease.is_some() && matches!(input, Input::Scene { .. }) {
            return Err(Failure::words("--crease is for models: a scene says itself what each of its models has"));
        }
        Ok(input)
    }

    /// Makes the stage of INPUT for a single picture: a model file is framed as it stands there, unless `--camera` says
    /// from where.
    pub(crate) fn still(&self, input: Input) -> Result<Turntable, Failure> {
        let is_reframed = matches!(&input, Input::Model(model) if !model.is_shape) && self.camera.is_none();
        let mut stage = self.stage(input)?;
        if is_reframed {
            stage.frame_still();
        }
        Ok(stage)
    }

    /// Makes the stage of INPUT, drawn as was asked for.
    pub(crate) fn stage(&self, input: Input) -> Result<Turntable, Failure> {
        let asked = self.palette.as_deref().map(input::colors).transpose()?.map(|(_, colors)| colors);
        let (mut stage, usual) = match input {
            Input::Model(model) => {
                let name = model.name.clone();
                let mut stage = model.stage(self.up.map(UpAxis::from))?;
                stage.scene.objects_mut().iter_mut().for_each(|object| object.name.clone_from(&name));
                let colors = if stage.has_colors() { Colors::Auto } else { builtin::GREY.clone().into() };
                (stage, Some(colors))
            }
            Input::Scene { .. } if self.up.is_some() => {
                return Err(Failure::words(
                    "--up is for models: a scene says itself which axis of each of its models points up",
                ));
            }
            Input::Scene { scene, .. } => {
                let auto = scene.auto_palette.then_some(Colors::Auto);
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
        if let Some(Dither(dither)) = self.pipeline.dither {
            stage.set_dither(dither);
        }
        if let Some(shades) = self.pipeline.tessellation {
            stage.scene.settings.tessellation = Some(shades);
        }
        let colors = asked.or(usual);
        if colors == Some(Colors::Auto) && self.pipeline.arithmetic == Some(VertexPath::Integer) {
            stage.only_what_integers_draw();
        }
        if let Some(colors) = &colors {
            stage.set_colors(colors).map_err(Failure::from)?;
        }
        Ok(stage)
    }

    /// Name of the palette that was asked for.
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

    /// The mapping that was asked for.
    pub(crate) fn mapping(&self) -> Option<Mapping> {
        self.pipeline.mapping
    }

    /// A renderer with the settings of the command line, except for the shading.
    pub(crate) fn renderer(&self, kernel: Kernel) -> Renderer {
        let Pipeline { hidden_surfaces, mapping, mipmaps, arithmetic, .. } = self.pipeline;
        let mut renderer = Renderer::new();
        renderer.kernel = kernel;
        renderer.settings.hidden_surfaces = hidden_surfaces;
        renderer.settings.mapping = mapping;
        renderer.settings.mipmaps = mipmaps;
        renderer.settings.vertex_path = arithmetic;
        renderer
    }
}

/// Takes one of these names, and offers them to the shell's completions.
pub(crate) fn one_of<Choice: Copy + Send + Sync + 'static, const N: usize>(
    all: [Choice; N],
    name: fn(Choice) -> &'static str,
) -> impl TypedValueParser<Value = Choice> {
    PossibleValuesParser::new(all.map(name))
        .try_map(move |word| all.into_iter().find(|choice| name(*choice) == word).ok_or("unknown name"))
}

/// A number on the command line.
pub(crate) fn finite(words: &str) -> Result<f64, String> {
    match words.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err("not a number".to_string()),
    }
}

/// Factor of enlargement, on the command line.
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
        let why = || format!("{words:?} is no point: three numbers with commas between them, such as 0,1.5,4");
        point.filter(|point| point.is_finite()).ok_or_else(why)
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

/// Background that a frame is cleared to, on the command line.
fn background(words: &str) -> Result<Background, String> {
    let digits = words.strip_prefix('#').unwrap_or(words);
    let is_color = digits.len() == 6 && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    if is_color && let Ok(color) = u32::from_str_radix(digits, 16) {
        let [_, r, g, b] = color.to_be_bytes();
        return Ok(Background::Color(Rgb::new(r, g, b)));
    }
    if let Some(short) = words.strip_prefix('#')
        && short.len() == 3
        && short.bytes().all(|digit| digit.is_ascii_hexdigit())
    {
        let long: String = short.chars().flat_map(|digit| [digit, digit]).collect();
        return Err(format!("{words}: a colour has six digits: '#{long}'"));
    }
    let entry = words.parse().map(Background::Entry);
    entry.map_err(|_| "neither a colour such as '#203040' nor an entry of the palette, 0 to 255".to_string())
}

fn switch(words: &str) -> Result<bool, String> {
    match words {
        "on" => Ok(true),
        "off" => Ok(false),
        _ => Err("neither on nor off; an INPUT stands before this option, or behind its =on".to_string()),
    }
}

/// A pattern of dither, or none.
#[derive(Clone, Copy)]
struct Dither(Option<DitherPattern>);

fn dither(words: &str) -> Result<Dither, String> {
    match words {
        "on" => Ok(Dither(Some(DitherPattern::default()))),
        "off" => Ok(Dither(None)),
        _ => words.parse().map(|pattern| Dither(Some(pattern))).map_err(|_| {
            let names = DitherPattern::ALL.map(DitherPattern::name).join(", ");
            format!("none of on, off, {names}; an INPUT stands before this option, or behind its =on")
        }),
    }
}

/// An angle between faces on the command line, in degrees.
pub(crate) fn crease(words: &str) -> Result<Angle, String> {
    match words.parse::<f32>() {
        Ok(degrees) if (0.0..=180.0).contains(&degrees) => Ok(Angle::from_degrees(degrees.into())),
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

fn long_help_on_names(what: &str, names: &[&str]) -> String {
    format!("{what}: {}\n\n[default: as the scene calls for]", names.join(", "))
}

fn long_help_on_dither() -> String {
    format!(
        "Show shades between two entries as a pattern of both: off, {}. `on` is {}.\n\n[default: as the scene says]",
        DitherPattern::ALL.map(DitherPattern::name).join(", "),
        DitherPattern::default()
    )
}

fn long_help_on_arithmetic() -> String {
    let names = VertexPath::ALL.map(VertexPath::name).join(", ");
    format!(
        "The numbers that vertices are made in: {names}. Fixed numbers have 16 bits before the point and 16 behind it.\n\n\
         [default: {}]",
        VertexPath::default()
    )
}

fn long_help_on_palettes() -> String {
    format!(
        "The palette. `auto` makes one for what is seen. `mode13h palette` lists the built-in ones. The name of a file \
         ends in {}.\n\n[default: the scene's; for a model, auto if it has colours of its own, otherwise grey]",
        input::palette_extensions()
    )
}

fn long_help_on_kernels() -> String {
    let names: Vec<&str> = Kernel::available().map(Kernel::name).collect();
    format!(
        "The span kernel: {}. All draw the same bytes.\n\n[default: the environment variable {KERNEL_VARIABLE}, otherwise \
         the fastest, {}]",
        names.join(", "),
        Kernel::default().name()
    )
}
