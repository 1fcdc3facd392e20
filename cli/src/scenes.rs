//! `mode13h scenes`: the shipped scenes, as files.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use mode13h_assets::shipped::{self, Shipped};

use crate::failure::Failure;
use crate::{output, typo};

#[derive(Args)]
pub(crate) struct Options {
    #[command(subcommand)]
    what: Option<What>,
}

#[derive(Subcommand)]
enum What {
    /// Write a shipped scene to a file that you can edit
    Copy(CopyOptions),
}

#[derive(Args)]
struct CopyOptions {
    /// The scene: `mode13h list scenes` shows the names
    #[arg(value_name = "NAME")]
    name: String,
    /// Write to FILE, which ends in .toml; an existing file is overwritten
    ///
    /// [default: NAME.toml in the current directory, never overwritten without --force]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Overwrite NAME.toml
    #[arg(long)]
    force: bool,
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let Some(What::Copy(CopyOptions { name, out, force })) = &options.what else {
        return Err(Failure::words(
            "`mode13h list scenes` lists the scenes, and `mode13h scenes copy NAME` copies one",
        ));
    };
    let Ok(scene) = name.parse::<Shipped>() else {
        let near = typo::nearest(name, shipped::ALL.iter().map(|scene| scene.name));
        let near = near.map_or(String::new(), |near| format!("; did you mean {near}?"));
        return Err(Failure::words(format!("{name}: no such scene{near} (mode13h list scenes shows the names)")));
    };
    let path = output::path_or(out.as_ref(), format!("{name}.toml"), *force)?;
    output::check_extension(&path, "toml", "a scene file")?;
    output::bytes(&path, scene.text.as_bytes())
}
