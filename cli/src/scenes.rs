//! `mode13h scenes`: the scenes that are compiled in.

use std::path::PathBuf;

use clap::Args;
use mode13h::export;
use mode13h::mesh::shapes;
use mode13h_assets::shipped::{self, Shipped};
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
    /// The name of the copy, which ends in .toml; what it holds is overwritten
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
    let out = out.clone().unwrap_or_else(|| format!("{name}.toml").into());
    if !out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
        return Err(Failure::words(format!("{}: the file of a scene ends in .toml", out.display())));
    }
    if options.out.is_none() {
        output::refuse_overwriting(&out, *force)?;
    }
    output::file(&out, || export::write_atomically(&out, |file| file.write_all(scene.text.as_bytes())))
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
