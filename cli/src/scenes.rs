//! `mode13h scenes`: the scenes that are compiled in.

use std::path::{Path, PathBuf};

use clap::Args;
use mode13h::export;
use mode13h::mesh::shapes;
use mode13h::scene::shipped::{self, Shipped};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::{output, typo};

#[derive(Args)]
pub(crate) struct Options {
    /// Write the file of a scene, to be edited
    ///
    /// It is NAME.toml in this directory. One that exists is not overwritten without --force.
    #[arg(long, value_name = "NAME")]
    copy: Option<String>,
    /// The name of the copy; what it holds is overwritten
    #[arg(short, long, value_name = "FILE", requires = "copy")]
    out: Option<PathBuf>,
    /// Overwrite NAME.toml
    #[arg(long, requires = "copy")]
    force: bool,
    /// Print the list as JSON
    #[arg(long, conflicts_with = "copy")]
    json: bool,
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let Options { copy, out, force, json } = options;
    let Some(name) = copy else {
        return if *json { output::print_json(&list_json()) } else { output::print(&list()) };
    };
    let Ok(scene) = name.parse::<Shipped>() else {
        let near = typo::nearest(name, shipped::ALL.iter().map(|scene| scene.name));
        let near = near.map_or(String::new(), |near| format!("; did you mean {near}?"));
        return Err(Failure::words(format!("{name}: no such scene{near} (mode13h scenes lists them)")));
    };
    match out {
        Some(out) => write(&scene, out),
        None => {
            let out = PathBuf::from(format!("{name}.toml"));
            output::refuse_overwriting(&out, *force)?;
            write(&scene, &out)
        }
    }
}

/// A line for each scene, with what it shows, and one for all shapes.
fn list() -> String {
    let widest = shipped::ALL.iter().map(|scene| scene.name.len()).max().unwrap_or_default();
    let scenes: String =
        shipped::ALL.iter().map(|scene| format!("{:widest$}  {}\n", scene.name, scene.shows())).collect();
    format!("{scenes}\nshapes: {}\n", shapes::NAMES.join(", "))
}

fn list_json() -> Value {
    let scenes: Vec<Value> =
        shipped::ALL.iter().map(|scene| json!({ "name": scene.name, "shows": scene.shows() })).collect();
    json!({ "schema": 1, "scenes": scenes, "shapes": shapes::NAMES })
}

fn write(scene: &Shipped, out: &Path) -> Result<(), Failure> {
    Ok(output::file(|| export::write_atomically(out, |file| file.write_all(scene.text.as_bytes())))?)
}
