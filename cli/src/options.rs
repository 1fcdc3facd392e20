//! Options that several commands share, and the values that they take.

mod shading;

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::palette::{Rgb, builtin};
use mode13h::render::Renderer;
use mode13h::scene::{Scene, UpAxis};
use mode13h::settings::DitherPattern;
use mode13h::settings::{HiddenSurfaces, Mapping, Shading, VertexPath};
use mode13h::span::Kernel;
use mode13h_assets::look::{Look, LookColors};
use mode13h_assets::model_file::Options;
use mode13h_assets::scene_file::{GOURAUD, in_full};

use crate::failure::Failure;
use crate::input::{self, Input};
use crate::turntable::{Background, Colors, Turntable};
pub(crate) use shading::{ShadingOptions, pace};

/// The environment variable that stands in for `--kernel`. The library reads none.
const KERNEL_VARIABLE: &str = "MODE13H_KERNEL";

/// The kernel that draws unless `--kernel` names another.
pub(crate) fn default_kernel() -> Result<Kernel, Failure> {
    match std::env::var_os(KERNEL_VARIABLE) {
        Some(name) if !name.is_empty() => {
            let name = name.to_string_lossy();
            name.parse::<Kernel>().map_err(|error| Failure::words(format!("{KERNEL_VARIABLE}={name}: {error}")))
        }
        _ => Ok(Kernel::default()),
    }
}

/// What is drawn, and how, except for the shading. The scene decides what the options leave open, and the library what
/// the scene does.
#[derive(Args, Clone)]
#[command(next_help_heading = "Scene")]
pub(crate) struct Drawing {
    /// Enlarge by FACTOR
    #[arg(long, value_name = "FACTOR", value_parser = factor)]
    zoom: Option<f64>,
    /// Look from EYE at TARGET
    ///
    /// Both are X,Y,Z in scene units; a model's centre is 0,0,0, unless its file has lights.
    ///
    /// [default: the scene's or the model's camera, or one that shows the whole model; TARGET is 0,0,0]
    #[arg(long, value_name = "EYE[:TARGET]", value_parser = camera, allow_hyphen_values = true)]
    camera: Option<(Vec3, Vec3)>,
    /// Choose which model axis points up [default: y; z for a flat sheet facing z]
    #[arg(long, value_name = "AXIS", value_parser = axis(), hide_short_help = true)]
    up: Option<UpAxis>,
    /// Keep a model's edges sharp above DEGREES
    ///
    /// For models without normals: 180 makes everything smooth, 0 everything flat.
    ///
    /// [default: the model's smoothing groups, or else 40; scans are smooth]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = crease, hide_short_help = true)]
    crease: Option<Angle>,
    /// Play this animation of a model
    ///
    /// A name, or a number from 0; an unknown one lists the model's animations.
    ///
    /// [default: the first]
    #[arg(long, value_name = "NAME|N", hide_short_help = true)]
    clip: Option<String>,
    #[arg(
        long,
        value_name = "FILE|NAME",
        help = "A palette file, a built-in palette, or auto",
        long_help = long_help_on_palettes(),
    )]
    palette: Option<OsString>,
    #[arg(
        long,
        value_name = "NAME",
        value_parser = one_of(Look::ALL, Look::name),
        hide_possible_values = true,
        help = "Look like ps1, vga, gameboy, cga or pico8",
        long_help = long_help_on_looks(),
    )]
    look: Option<Look>,
    /// Clear the frame to COLOUR
    ///
    /// '#rrggbb' or rrggbb, for the nearest colour in the palette; or the number of an entry, 0 to 255.
    ///
    /// [default: the scene's, or else entry 0]
    #[arg(long, value_name = "COLOUR", value_parser = background)]
    background: Option<Background>,
    #[command(flatten)]
    pipeline: Pipeline,
}

/// How triangles become bytes.
#[derive(Args, Clone)]
#[command(next_help_heading = "Rendering")]
struct Pipeline {
    #[arg(
        long,
        value_name = "NAME",
        value_parser = one_of(HiddenSurfaces::ALL, HiddenSurfaces::name),
        hide_possible_values = true,
        help = "How to remove hidden surfaces",
        long_help = long_help_on_names("How to remove hidden surfaces", &HiddenSurfaces::ALL.map(HiddenSurfaces::name)),
    )]
    hidden_surfaces: Option<HiddenSurfaces>,
    #[arg(
        long,
        value_name = "NAME",
        value_parser = one_of(Mapping::ALL, Mapping::name),
        hide_possible_values = true,
        help = "How to map textures",
        long_help = long_help_on_names("How to map textures", &Mapping::ALL.map(Mapping::name)),
    )]
    mapping: Option<Mapping>,
    /// Draw distant textures from smaller copies [default: if the scene needs it]
    #[arg(long, conflicts_with = "no_mipmaps", hide_short_help = true)]
    mipmaps: bool,
    /// Draw all textures at full resolution
    #[arg(long, hide_short_help = true)]
    no_mipmaps: bool,
    /// Split faces until linear shading is off by at most N shades
    ///
    /// A shade is 1/255 of full intensity.
    ///
    /// [default: the scene's, or else no face is split]
    #[arg(long, value_name = "N", value_parser = shades, hide_short_help = true)]
    tessellation: Option<f32>,
    #[arg(
        long,
        value_name = "PATTERN",
        value_parser = one_of(DitherPattern::ALL, DitherPattern::name),
        hide_possible_values = true,
        conflicts_with = "no_dither",
        help = "Dither shades between two colours",
        long_help = long_help_on_dither(),
    )]
    dither: Option<DitherPattern>,
    /// Draw without dither
    #[arg(long, hide_short_help = true)]
    no_dither: bool,
    /// Round vertices to N fractional bits, 0 to 8
    ///
    /// 0 puts them on whole pixels. With --arithmetic fixed there are always 8.
    ///
    /// [default: the scene's, or else 8]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(..=8), hide_short_help = true)]
    vertex_bits: Option<u8>,
    #[arg(
        long,
        value_name = "NAME",
        value_parser = one_of(VertexPath::ALL, VertexPath::name),
        hide_possible_values = true,
        help = "Compute vertices in this arithmetic",
        long_help = long_help_on_arithmetic(),
    )]
    arithmetic: Option<VertexPath>,
    #[arg(
        long,
        value_name = "NAME",
        value_parser = str::parse::<Kernel>,
        help = "The kernel that fills spans",
        long_help = long_help_on_kernels(),
    )]
    kernel: Option<Kernel>,
}

/// The options that mean nothing to a DOS program, which draws by an integer path of its own.
pub(crate) const IGNORED_BY_DOS: [&str; 7] =
    ["hidden-surfaces", "mapping", "mipmaps", "no-mipmaps", "arithmetic", "kernel", "vertex-bits"];

/// Which moment of a scene is drawn.
#[derive(Args, Clone, Default)]
pub(crate) struct Moment {
    /// Show the scene at time SECONDS
    ///
    /// The first of several frames is at that time. A model turns by 90 degrees a second, or plays its animation.
    ///
    /// [default: the scene's `picture` for a single frame without --turn, otherwise 0]
    #[arg(long, value_name = "SECONDS", value_parser = finite, allow_negative_numbers = true)]
    time: Option<f64>,
}

impl Moment {
    /// Adapts the option's help to a command that shows a single frame.
    pub(crate) fn of_one_frame(command: clap::Command) -> clap::Command {
        command.mut_arg("time", |time| {
            time.long_help(
                "Show the scene at time SECONDS\n\nA model turns by 90 degrees a second, or plays its animation.\n\n\
                 [default: the scene's `picture`]",
            )
        })
    }

    /// Time in seconds of one frame of a scene.
    pub(crate) fn of_picture(&self, scene: &Scene) -> f64 {
        self.time.unwrap_or(scene.picture)
    }

    /// Time in seconds of the first of several frames.
    pub(crate) fn of_first(&self) -> f64 {
        self.time.unwrap_or_default()
    }
}

impl Drawing {
    /// The kernel named by the option, or else by the environment, or else the fastest.
    pub(crate) fn kernel(&self) -> Result<Kernel, Failure> {
        self.pipeline.kernel.map_or_else(default_kernel, Ok)
    }

    /// The options in [`IGNORED_BY_DOS`] that were given.
    pub(crate) fn ignored_by_dos(&self) -> Vec<String> {
        let Pipeline { hidden_surfaces, mapping, mipmaps, no_mipmaps, arithmetic, kernel, vertex_bits, .. } =
            &self.pipeline;
        let given = [
            hidden_surfaces.is_some(),
            mapping.is_some(),
            *mipmaps,
            *no_mipmaps,
            *arithmetic == Some(VertexPath::Float),
            kernel.is_some(),
            vertex_bits.is_some(),
        ];
        let given = IGNORED_BY_DOS.into_iter().zip(given).filter(|(_, is_given)| *is_given);
        given.map(|(name, _)| format!("--{name}")).collect()
    }

    /// Reads INPUT with these options.
    pub(crate) fn input(&self, words: &OsStr) -> Result<Input, Failure> {
        let mut input = input::input(words, &Options { crease: self.crease })?;
        let given = [("crease", self.crease.is_some()), ("clip", self.clip.is_some()), ("up", self.up.is_some())];
        match (&mut input, &self.clip, given.into_iter().find(|(_, is_given)| *is_given)) {
            (Input::Scene { .. }, _, Some((option, _))) => {
                return Err(Failure::words(format!(
                    "--{option} is for models; in a scene, each model has a key for it"
                )));
            }
            (Input::Model(model), Some(clip), _) => model.choose(clip)?,
            _ => {}
        }
        Ok(input)
    }

    /// Makes the stage of INPUT for a single picture: a model file is framed by its pose there, unless `--camera`
    /// places the camera. An automatic palette leaves out what is seen only if it is turned, unless it `turns`.
    pub(crate) fn still(&self, input: Input, turns: bool) -> Result<Turntable, Failure> {
        let is_reframed = matches!(&input, Input::Model(model) if !model.is_shape) && self.camera.is_none();
        let mut stage = self.make_stage(input, turns)?;
        stage.frames_still = is_reframed;
        Ok(stage)
    }

    /// Makes the stage of INPUT, drawn with these options.
    pub(crate) fn stage(&self, input: Input) -> Result<Turntable, Failure> {
        self.make_stage(input, true)
    }

    fn make_stage(&self, input: Input, turns: bool) -> Result<Turntable, Failure> {
        let asked = self.palette.as_deref().map(input::colors).transpose()?.map(|(_, colors)| colors);
        let mut look_of_scene = None;
        let (mut stage, usual) = match input {
            Input::Model(model) => {
                let name = model.name.clone();
                let mut stage = model.stage(self.up, self.camera.is_some())?;
                stage.scene.objects_mut().iter_mut().for_each(|object| object.name.clone_from(&name));
                let colors = if stage.has_colors() { Colors::Auto } else { builtin::GREY.clone().into() };
                (stage, Some(colors))
            }
            Input::Scene { mut scene, look, playbacks, .. } => {
                if let Some((look, without)) = look {
                    look_of_scene = Some(look);
                    // The option's look replaces it.
                    scene = if self.look.is_some() { without } else { scene };
                }
                let auto = scene.auto_palette.then_some(Colors::Auto);
                let colors = auto.or(scene.palette.clone().map(Colors::from));
                (Turntable::of_moving_scene(*scene, playbacks), colors)
            }
        };
        (stage.turns, stage.in_integers) = (turns, self.pipeline.arithmetic == Some(VertexPath::Integer));
        if let Some(zoom) = self.zoom {
            stage.zoom = zoom;
        }
        if let Some((eye, target)) = self.camera {
            stage.set_camera(eye, target);
        }
        if let Some(background) = self.background {
            stage.set_background(background);
        }
        if self.pipeline.dither.is_some() || self.pipeline.no_dither {
            stage.dither = Some(self.pipeline.dither);
        }
        if let Some(shades) = self.pipeline.tessellation {
            stage.scene.settings.tessellation = Some(shades);
        }
        if let Some(look) = self.look.or(look_of_scene) {
            stage.set_look(look);
        }
        let of_look = self.look.and_then(|look| {
            stage.take_settings(look);
            match look.colors() {
                LookColors::Made => Some(Colors::Auto),
                LookColors::Palette(palette) => Some(Colors::Palette(palette)),
                _ => None,
            }
        });
        let colors = asked.or(of_look).or(usual);
        if let Some(colors) = &colors {
            stage.set_colors(colors)?;
        }
        Ok(stage)
    }

    /// Name of the palette from the command line.
    pub(crate) fn palette_name(&self) -> Option<String> {
        let words = self.palette.as_deref()?;
        let stem = Path::new(words).file_stem().unwrap_or(words).to_string_lossy().into_owned();
        // A file with the name of another palette keeps its own.
        let is_taken = stem == input::AUTO || builtin::by_name(&stem).is_some();
        let is_file = self.palette_file().is_some();
        Some(if is_taken && is_file { words.to_string_lossy().into_owned() } else { stem })
    }

    /// The palette from the command line, if that is a file.
    pub(crate) fn palette_file(&self) -> Option<PathBuf> {
        let words = self.palette.as_deref()?;
        let is_name = words == input::AUTO || words.to_str().and_then(builtin::by_name).is_some();
        (!is_name).then(|| PathBuf::from(words))
    }

    /// The mapping from the command line.
    pub(crate) fn mapping(&self) -> Option<Mapping> {
        self.pipeline.mapping
    }

    /// A renderer with the settings of the command line, except for the shading.
    pub(crate) fn renderer(&self, kernel: Kernel) -> Renderer {
        let Pipeline { hidden_surfaces, mapping, mipmaps, no_mipmaps, vertex_bits, arithmetic, .. } = self.pipeline;
        let mut renderer = Renderer::new();
        renderer.kernel = kernel;
        renderer.settings.hidden_surfaces = hidden_surfaces;
        renderer.settings.mapping = mapping;
        renderer.settings.mipmaps = (mipmaps || no_mipmaps).then_some(mipmaps);
        renderer.settings.vertex_bits = vertex_bits;
        renderer.settings.vertex_path = arithmetic;
        renderer
    }
}

/// Takes the name of one of these shadings, or `gouraud` for the default one.
pub(crate) fn shading_of<const N: usize>(all: [Shading; N]) -> impl TypedValueParser<Value = Shading> {
    let short = all.contains(&Shading::default()).then_some(GOURAUD);
    PossibleValuesParser::new(all.map(Shading::name).into_iter().chain(short))
        .try_map(|word| in_full(&word).parse::<Shading>().map_err(|error| error.to_string()))
}

/// Takes one of these names, and offers them to the shell's completions.
pub(crate) fn one_of<Choice: Copy + Send + Sync + 'static, const N: usize>(
    all: [Choice; N],
    name: fn(Choice) -> &'static str,
) -> impl TypedValueParser<Value = Choice> {
    PossibleValuesParser::new(all.map(name))
        .try_map(move |word| all.into_iter().find(|choice| name(*choice) == word).ok_or("unknown name"))
}

/// Takes the axis of a model that points up: y in most, z in those from CAD and geography.
pub(crate) fn axis() -> impl TypedValueParser<Value = UpAxis> {
    one_of([UpAxis::Y, UpAxis::Z], |axis| if axis == UpAxis::Y { "y" } else { "z" })
}

/// A number on the command line that passes a test; `what` says in the error, after "not a number", which ones do.
pub(crate) fn number<N: FromStr>(words: &str, what: &str, passes: impl Fn(&N) -> bool) -> Result<N, String> {
    words.parse().ok().filter(passes).ok_or_else(|| format!("not a number{what}"))
}

/// A finite number on the command line.
pub(crate) fn finite(words: &str) -> Result<f64, String> {
    number(words, "", |number: &f64| number.is_finite())
}

/// Factor of enlargement, on the command line.
fn factor(words: &str) -> Result<f64, String> {
    // Beyond these limits a camera in f32 shows nothing.
    number(words, " from 0.001 to 1000", |factor| (1e-3..=1e3).contains(factor))
}

/// A camera's position and its target, on the command line.
fn camera(words: &str) -> Result<(Vec3, Vec3), String> {
    let point = |words: &str| {
        let numbers: Option<Vec<f32>> = words.split(',').map(|word| word.trim().parse().ok()).collect();
        let point = numbers.and_then(|numbers| <[f32; 3]>::try_from(numbers).ok()).map(Vec3::from_array);
        let why = || format!("{words:?} is not a point: three numbers separated by commas, such as 0,1.5,4");
        point.filter(|point| point.is_finite()).ok_or_else(why)
    };
    let (eye, target) = match words.split_once(':') {
        Some((eye, target)) => (point(eye)?, point(target)?),
        None => (point(words)?, Vec3::ZERO),
    };
    if eye == target {
        return Err("EYE and TARGET are the same point".to_string());
    }
    Ok((eye, target))
}

/// Background that a frame is cleared to, on the command line.
fn background(words: &str) -> Result<Background, String> {
    let digits = words.strip_prefix('#').unwrap_or(words);
    let is_hex = digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    let is_color = digits.len() == 6 && is_hex;
    if is_color && let Ok(color) = u32::from_str_radix(digits, 16) {
        return Ok(Background::Color(Rgb::from(color)));
    }
    if words.starts_with('#') && digits.len() == 3 && is_hex {
        let long: String = digits.chars().flat_map(|digit| [digit, digit]).collect();
        return Err(format!("{words}: a colour has six digits: '#{long}'"));
    }
    let entry = words.parse().map(Background::Entry);
    entry.map_err(|_| "neither a colour such as '#203040' nor an entry of the palette, 0 to 255".to_string())
}

/// An angle between faces on the command line, in degrees.
pub(crate) fn crease(words: &str) -> Result<Angle, String> {
    let degrees = number(words, " of degrees from 0 to 180", |degrees: &f32| (0.0..=180.0).contains(degrees))?;
    Ok(Angle::from_degrees(degrees.into()))
}

/// A number of shades on the command line.
pub(crate) fn shades(words: &str) -> Result<f32, String> {
    number(words, " of shades above 0", |shades: &f32| shades.is_finite() && *shades > 0.0)
}

fn long_help_on_names(what: &str, names: &[&str]) -> String {
    format!("{what}: {}\n\n[default: as the scene needs]", names.join(", "))
}

fn long_help_on_dither() -> String {
    format!(
        "Dither shades between two colours in a pattern: {}\n\n[default: the scene's, or else none]",
        DitherPattern::ALL.map(DitherPattern::name).join(", ")
    )
}

fn long_help_on_looks() -> String {
    format!(
        "Look like an old machine: {}. Sets --palette, --dither, --mapping, --no-mipmaps and --vertex-bits; those options \
         override it.\n\n[default: the scene's, or else none]",
        Look::ALL.map(Look::name).join(", ")
    )
}

fn long_help_on_arithmetic() -> String {
    let names = VertexPath::ALL.map(VertexPath::name).join(", ");
    format!(
        "Compute vertices in this arithmetic: {names}. `fixed` is 16.16, for a 386 without a coprocessor; it lacks \
         error budgets and some shadings and effects.\n\n\
         [default: {}]",
        VertexPath::default()
    )
}

fn long_help_on_palettes() -> String {
    format!(
        "A palette file ({}), an indexed picture (.png, .gif, .pcx, .aseprite), a built-in palette (`mode13h list \
         palettes`), or `auto`, which makes one for what is visible\n\n\
         [default: the scene's; for a model, auto if it has colours of its own, or else grey]",
        input::palette_extensions()
    )
}

fn long_help_on_kernels() -> String {
    let names: Vec<&str> = Kernel::available().map(Kernel::name).collect();
    format!(
        "The kernel that fills spans: {}. All draw the same bytes.\n\n[default: the environment variable \
         {KERNEL_VARIABLE}, or else the fastest, {}]",
        names.join(", "),
        Kernel::default().name()
    )
}
