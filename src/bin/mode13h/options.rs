//! Options that several commands share, and what may stand behind them.

use std::ffi::OsString;

use clap::{Args, ValueEnum};
use mode13h::palette::Palette;
use mode13h::render::Rung;
use mode13h::scene::UpAxis;
use mode13h::span::Kernel;

use crate::failure::Failure;
use crate::input;

/// The environment variable that stands in for `--kernel`. The library reads none.
const KERNEL_VARIABLE: &str = "MODE13H_KERNEL";

/// How a model is drawn.
#[derive(Args)]
pub(crate) struct Drawing {
    #[arg(long, value_name = "RUNG", help = help_on_rungs())]
    rung: Option<Rung>,
    #[arg(long, value_name = "FILE|NAME", default_value = "grey", help = help_on_palettes())]
    palette: OsString,
    #[arg(long, value_name = "NAME", value_parser = Kernel::by_name, help = help_on_kernels())]
    kernel: Option<Kernel>,
    /// The axis of the model that points up
    #[arg(long, value_name = "AXIS", value_enum, default_value = "y")]
    up: Up,
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
    /// The rung that was asked for, or the library's own choice.
    pub(crate) fn rung(&self) -> Rung {
        self.rung.unwrap_or_default()
    }

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

    pub(crate) fn up_axis(&self) -> UpAxis {
        self.up.into()
    }

    /// The palette, and what to call it.
    pub(crate) fn palette(&self) -> Result<(String, Palette), Failure> {
        input::palette(&self.palette)
    }
}

fn help_on_rungs() -> String {
    let names: Vec<&str> = Rung::ALL.iter().map(|rung| rung.name()).collect();
    format!("How faces are shaded: {} [default: {}]", names.join(", "), Rung::default().name())
}

fn help_on_palettes() -> String {
    format!("The palette: {}, or a file ({})", input::palette_names(), input::palette_extensions())
}

fn help_on_kernels() -> String {
    let names: Vec<&str> = Kernel::available().map(Kernel::name).collect();
    format!(
        "The span kernel: {} [default: {KERNEL_VARIABLE} if it is set, else the fastest, {}]",
        names.join(", "),
        Kernel::fastest().name()
    )
}
