//! Options that several commands share, and what may stand behind them.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use mode13h::palette::builtin;
use mode13h::render::{HiddenSurfaces, Mapping, Renderer, Rung, VertexPath};
use mode13h::scene::UpAxis;
use mode13h::span::Kernel;

use crate::failure::Failure;
use crate::input::{self, Colors, Input, Model};
use crate::stage::Stage;

/// The environment variable that stands in for `--kernel`. The library reads none.
const KERNEL_VARIABLE: &str = "MODE13H_KERNEL";

/// How a model or a scene is drawn. What is not said here the scene says, or else the library chooses.
#[derive(Args, Clone)]
pub(crate) struct Drawing {
    #[arg(long, value_name = "RUNG", help = help_on_rungs())]
    rung: Option<Rung>,
    /// Spend the least time that keeps every face within so many shades of error, of 1/255 of full intensity
    #[arg(long, value_name = "SHADES", value_parser = shades, conflicts_with = "rung")]
    max_error: Option<f32>,
    #[arg(long, value_name = "FILE|NAME|auto", help = help_on_palettes())]
    palette: Option<OsString>,
    #[arg(long, value_name = "NAME", value_parser = Kernel::by_name, help = help_on_kernels())]
    kernel: Option<Kernel>,
    #[arg(long, value_name = "WAY", help = help_on_hidden_surfaces())]
    hidden: Option<HiddenSurfaces>,
    #[arg(long, value_name = "WAY", help = help_on_mappings())]
    mapping: Option<Mapping>,
    #[arg(long, value_name = "PATH", help = help_on_vertex_paths())]
    vertex_path: Option<VertexPath>,
    /// The axis of a model that points up [default: y]
    #[arg(long, value_name = "AXIS", value_enum)]
    up: Option<Up>,
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

    /// What INPUT shows, drawn as was asked for.
    pub(crate) fn stage(&self, input: Input) -> Result<Stage, Failure> {
        let asked = self.palette.as_deref().map(input::colors).transpose()?.map(|(_, colors)| colors);
        let (mut stage, usual) = match input {
            Input::Model(Model { mesh, .. }) => {
                let textures = input::textures(&mesh);
                let stage = Stage::of_model(mesh, self.up.unwrap_or(Up::Y).into(), &textures);
                let colors = if stage.has_colors() { Colors::Auto } else { builtin::GREY.clone().into() };
                (stage, Some(colors))
            }
            Input::Scene { .. } if self.up.is_some() => {
                return Err(Failure::words(
                    "--up is for models: a scene says itself which axis of each of its models points up",
                ));
            }
            Input::Scene { scene, .. } => {
                let auto = scene.wishes.auto_palette.then_some(Colors::Auto);
                let colors = auto.or(scene.palette.clone().map(Colors::from));
                (Stage::of_scene(*scene), colors)
            }
        };
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

    /// The rung of a scene that wishes for this one.
    pub(crate) fn rung(&self, wish: Option<Rung>) -> Rung {
        self.rung.or(wish).unwrap_or_default()
    }

    /// Whether a rung or a budget was asked for.
    pub(crate) fn chooses_rung(&self) -> bool {
        self.rung.is_some() || self.max_error.is_some()
    }

    /// The budget of a scene that wishes for this one, if any is asked for.
    pub(crate) fn max_error(&self, wish: Option<f32>) -> Option<f32> {
        self.max_error.or(wish.filter(|_| self.rung.is_none()))
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
        renderer.set_vertex_path(self.vertex_path.unwrap_or_default());
        if let Some(rung) = self.rung {
            renderer.set_rung(rung);
        }
        renderer.set_max_error(self.max_error);
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

/// A number of shades on the command line.
pub(crate) fn shades(words: &str) -> Result<f32, String> {
    match words.parse::<f32>() {
        Ok(number) if number.is_finite() && number > 0.0 => Ok(number),
        _ => Err("not a number of shades above 0".to_string()),
    }
}

fn help_on_rungs() -> String {
    let names = Rung::ALL.map(Rung::name).join(", ");
    format!("How faces are shaded: {names} [default: the scene's, or {}]", Rung::default())
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
