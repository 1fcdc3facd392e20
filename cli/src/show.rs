//! `mode13h show`: a hard case as a picture.

use std::path::PathBuf;

use clap::Args;
use mode13h::export;
use mode13h_lab::show::{self, CASES, Case};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::output;

#[derive(Args)]
pub(crate) struct Options {
    /// The case, such as R5 [default: list those that have a picture]
    #[arg(value_name = "ID")]
    id: Option<String>,
    /// The picture's name; what it holds is overwritten
    ///
    /// [default: ID.png in this directory, which is not overwritten without --force]
    #[arg(short, long, value_name = "OUT.png", requires = "id")]
    out: Option<PathBuf>,
    /// Overwrite ID.png
    #[arg(long, requires = "id")]
    force: bool,
    /// Print the list, or what was drawn, as JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let Options { id, out, force, json } = options;
    let Some(id) = id else {
        return if *json { output::print_json(&list_json()) } else { output::print(&list()) };
    };
    let Some(case) = show::by_id(id) else {
        let ids: Vec<&str> = CASES.iter().map(|case| case.id).collect();
        return Err(Failure::words(format!("no picture of '{id}': there are {}", ids.join(", "))));
    };
    let path = match out {
        Some(out) if !out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) => {
            return Err(Failure::words(format!("{}: a picture is written as .png", out.display())));
        }
        Some(out) => out.clone(),
        None => {
            let path = PathBuf::from(format!("{}.png", case.id));
            output::refuse_overwriting(&path, *force)?;
            path
        }
    };
    let bytes = case.png()?;
    output::file(&path, || export::write_atomically(&path, |file| file.write_all(&bytes)))?;
    if *json {
        let mut case = case_json(case);
        case["schema"] = 1.into();
        case["file"] = path.to_string_lossy().into();
        return output::print_json(&case);
    }
    match out {
        Some(_) => Ok(()),
        None => output::print(&format!("{}: {}\n", path.display(), case.sentence)),
    }
}

fn list() -> String {
    CASES.iter().map(|case| format!("{:<4}{}: {}\n", case.id, case.title, case.sentence)).collect()
}

fn list_json() -> Value {
    json!({ "schema": 1, "cases": CASES.iter().map(case_json).collect::<Vec<_>>() })
}

fn case_json(case: &Case) -> Value {
    json!({ "id": case.id, "title": case.title, "sentence": case.sentence })
}
