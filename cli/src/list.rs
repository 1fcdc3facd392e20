//! `mode13h list`: the names that other commands take.

use clap::{Args, ValueEnum};
use mode13h::mesh::shapes;
use mode13h::palette::builtin;
use mode13h::settings::Shading;
use mode13h::span::Kernel;
use mode13h_assets::shipped;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::options::default_kernel;
use crate::{output, palette};

#[derive(Args)]
pub(crate) struct Options {
    /// What to list
    #[arg(value_name = "WHAT", value_enum)]
    what: What,
    /// Print the list as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum What {
    /// For --shading, from cheap to exact
    Shadings,
    /// For --palette
    Palettes,
    /// For --kernel, on this machine
    Kernels,
    /// For INPUT: scenes and shapes
    Scenes,
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let Options { what, json } = *options;
    if json {
        let mut list = as_json(what)?;
        list["schema"] = output::SCHEMA.into();
        return output::print_json(&list);
    }
    output::print(&match what {
        What::Shadings => table(Shading::ALL.map(|shading| (shading.name(), shading_line(shading)))),
        What::Palettes => table(builtin::ALL.iter().map(|builtin| (builtin.name, palette::summary(builtin)))),
        What::Kernels => {
            let default = default_kernel()?;
            table(Kernel::available().map(|kernel| (kernel.name(), kernel_line(kernel, default).to_string())))
        }
        What::Scenes => {
            let scenes = table(shipped::ALL.iter().map(|scene| (scene.name, scene.shows().to_string())));
            format!("{scenes}\nshapes: {}\n", shapes::NAMES.join(", "))
        }
    })
}

fn as_json(what: What) -> Result<Value, Failure> {
    Ok(match what {
        What::Shadings => {
            let one = |shading: Shading| {
                let is_default = shading == Shading::default();
                json!({ "name": shading.name(), "summary": summary(shading), "default": is_default })
            };
            json!({ "shadings": Shading::ALL.map(one) })
        }
        What::Palettes => {
            let one = |builtin: &builtin::Builtin| json!({ "name": builtin.name, "ramps": builtin.palette.ramps(), "provenance": builtin.provenance });
            json!({ "palettes": builtin::ALL.iter().map(one).collect::<Vec<_>>() })
        }
        What::Kernels => {
            let default = default_kernel()?;
            let one = |kernel: Kernel| json!({ "name": kernel.name(), "default": kernel == default });
            json!({ "kernels": Kernel::available().map(one).collect::<Vec<_>>() })
        }
        What::Scenes => {
            let one = |scene: &shipped::Shipped| json!({ "name": scene.name, "shows": scene.shows() });
            json!({ "scenes": shipped::ALL.iter().map(one).collect::<Vec<_>>(), "shapes": shapes::NAMES })
        }
    })
}

/// A line for each name, with its description in a column of its own.
fn table<'a>(rows: impl IntoIterator<Item = (&'a str, String)>) -> String {
    let rows: Vec<(&str, String)> = rows.into_iter().collect();
    let widest = rows.iter().map(|(name, _)| name.len()).max().unwrap_or_default();
    rows.iter().map(|(name, line)| format!("{name:widest$}  {line}").trim_end().to_string() + "\n").collect()
}

fn shading_line(shading: Shading) -> String {
    match shading == Shading::default() {
        true => format!("{}; the default, `{}` for short", summary(shading), mode13h_assets::scene_file::GOURAUD),
        false => summary(shading).to_string(),
    }
}

fn kernel_line(kernel: Kernel, default: Kernel) -> &'static str {
    match (kernel == Kernel::default(), kernel == default) {
        (true, true) => "the fastest here, and so the default",
        (true, false) => "the fastest here",
        (false, true) => "the default, by MODE13H_KERNEL",
        (false, false) => "",
    }
}

/// How a shading computes the shade of a pixel.
fn summary(shading: Shading) -> &'static str {
    match shading {
        Shading::Flat => "one shade for each face",
        Shading::GouraudVintage => "as the old texts print it: vertices on whole pixels, truncated steps",
        Shading::Gouraud88 => "linear in 8.8",
        Shading::Gouraud88Reseeded => "linear in 8.8, restarted every 64 pixels",
        Shading::Gouraud1616 => "linear in 16.16",
        Shading::GouraudHyperbolic => "perspective-correct, by an exact quotient at every pixel",
        Shading::GouraudTessellated => "faces split until linear shading fits the light",
        Shading::PhongTable => "the normal's x and y interpolated; light from a table",
        Shading::Phong => "the normal interpolated, the whole lighting model at every pixel",
        Shading::GouraudFloat => "perspective-correct in f32, by a division at every pixel",
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shading_has_a_summary_that_fits_its_line() {
        for shading in Shading::ALL {
            let line = format!("{:20}  {}", shading.name(), shading_line(shading));
            assert!(!summary(shading).is_empty() && line.chars().count() <= 100, "{line}");
        }
    }

    #[test]
    fn a_column_begins_behind_the_longest_name() {
        assert_eq!(table([("a", "one".to_string()), ("long", String::new())]), "a     one\nlong\n");
    }
}
