//! `mode13h cases`: hard cases as pictures.

use std::path::PathBuf;

use clap::Args;
use mode13h_lab::hard_cases::{self, CASES, Case};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::output;

#[derive(Args)]
pub(crate) struct Options {
    /// The case to draw, such as R5 [default: list all cases]
    #[arg(value_name = "ID")]
    id: Option<String>,
    /// Write to FILE, which ends in .png; an existing file is overwritten
    ///
    /// [default: ID.png in the current directory, never overwritten without --force]
    #[arg(short, long, value_name = "FILE", requires = "id")]
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
        if *json {
            let cases: Vec<_> = CASES.iter().map(case_json).collect();
            return output::print_json(&json!({ "schema": output::SCHEMA, "cases": cases }));
        }
        let line = |case: &Case| format!("{:<4}{}: {}\n", case.id, case.title, case.sentence);
        return output::print(&CASES.iter().map(line).collect::<String>());
    };
    let Some(case) = hard_cases::by_id(id) else {
        let ids: Vec<&str> = CASES.iter().map(|case| case.id).collect();
        return Err(Failure::words(format!("no case '{id}'; there are {}", ids.join(", "))));
    };
    let path = output::path_or(out.as_ref(), format!("{}.png", case.id), *force)?;
    output::check_extension(&path, "png", "a picture")?;
    output::bytes(&path, &case.png()?)?;
    if *json {
        let mut case = case_json(case);
        case["schema"] = output::SCHEMA.into();
        case["file"] = path.to_string_lossy().into();
        return output::print_json(&case);
    }
    match out {
        Some(_) => Ok(()),
        None => output::say(&format!("{}: {}\n", path.display(), case.sentence)),
    }
}

fn case_json(case: &Case) -> Value {
    json!({ "id": case.id, "title": case.title, "sentence": case.sentence })
}
