//! `mode13h scenes`: the scenes that are compiled in.

use std::path::{Path, PathBuf};

use clap::Args;
use mode13h::export;
use mode13h::scene::shipped::{self, Shipped};

use crate::failure::Failure;
use crate::output;

#[derive(Args)]
pub(crate) struct Options {
    /// Write the file of a scene, NAME.toml, to be edited. What is there already is left alone
    #[arg(long, value_name = "NAME")]
    copy: Option<String>,
    /// The file's name
    #[arg(short, long, value_name = "FILE", requires = "copy")]
    out: Option<PathBuf>,
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let Some(name) = &options.copy else { return output::print(&list()) };
    let Some(scene) = shipped::by_name(name) else {
        let names: Vec<&str> = shipped::ALL.iter().map(|scene| scene.name).collect();
        return Err(Failure::work(format!("{name}: no such scene; there are {}", names.join(", "))));
    };
    match &options.out {
        Some(out) => copy(scene, out),
        None => copy(scene, Path::new(&format!("{name}.toml"))),
    }
}

/// A line for each: its name and what it shows.
fn list() -> String {
    let widest = shipped::ALL.iter().map(|scene| scene.name.len()).max().unwrap_or_default();
    shipped::ALL.iter().map(|scene| format!("{:widest$}  {}\n", scene.name, scene.shows())).collect()
}

fn copy(scene: &Shipped, out: &Path) -> Result<(), Failure> {
    if out.symlink_metadata().is_ok() {
        return Err(Failure::work(format!("{}: is there already; -o FILE gives the copy another name", out.display())));
    }
    output::file(|| export::write_atomically(out, |file| file.write_all(scene.text.as_bytes()))).map_err(Failure::work)
}
