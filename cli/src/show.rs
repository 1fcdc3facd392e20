//! `mode13h show`: a hard case as a picture.

use std::path::PathBuf;

use clap::Args;
use mode13h::export;
use mode13h_lab::show::{self, CASES, Case};

use crate::failure::Failure;
use crate::output;

#[derive(Args)]
pub(crate) struct Options {
    /// The case, such as R5; without it, all that have a picture are listed
    #[arg(value_name = "ID")]
    id: Option<String>,
    /// Where to write it [default: ID.png in this directory, or the next free name]
    #[arg(short, long, value_name = "OUT.png", requires = "id")]
    out: Option<PathBuf>,
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let Some(id) = &options.id else { return output::print(&list()) };
    let Some(case) = show::by_id(id) else {
        let ids: Vec<&str> = CASES.iter().map(|case| case.id).collect();
        return Err(Failure::words(format!("no picture of '{id}': there are {}", ids.join(", "))));
    };
    let path = match &options.out {
        Some(out) if !out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) => {
            return Err(Failure::words(format!("{}: a picture is written as .png", out.display())));
        }
        Some(out) => out.clone(),
        None => free_name(case),
    };
    let bytes = case.png().map_err(Failure::work)?;
    output::file(|| export::write_atomically(&path, |file| file.write_all(&bytes))).map_err(Failure::work)?;
    match &options.out {
        Some(_) => Ok(()),
        None => output::print(&format!("{}: {}\n", path.display(), case.sentence)),
    }
}

/// The first of `R5.png`, `R5-0002.png`, `R5-0003.png` and so on that is free here. Nothing is overwritten.
fn free_name(case: &Case) -> PathBuf {
    let first = PathBuf::from(format!("{}.png", case.id));
    let mut names = std::iter::once(first).chain((2_u64..).map(|number| format!("{}-{number:04}.png", case.id).into()));
    // Some number below 2⁶⁴ is free, as no directory holds so many files.
    names.find(|path| path.symlink_metadata().is_err()).unwrap_or_default()
}

fn list() -> String {
    CASES.iter().map(|case| format!("{:<4}{}: {}\n", case.id, case.title, case.sentence)).collect()
}
