//! `mode13h verify`: what the library checks on this machine.

use clap::Args;
use mode13h::span::Kernel;
use mode13h::verify::{self, Group};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::output;

#[derive(Args)]
pub(crate) struct Options {
    /// As JSON, for programs
    #[arg(long)]
    json: bool,
    /// What the random cases are made from; the same number makes the same cases
    #[arg(long, value_name = "N", default_value_t = 13)]
    seed: u64,
}

/// The checks there are. Each is given the seed.
const CHECKS: [fn(u64) -> Group; 1] = [verify::spans];

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let groups = CHECKS.map(|check| check(options.seed));
    // A group that tried nothing has shown nothing.
    let failed = groups.iter().filter(|group| group.cases == 0 || !group.failures.is_empty()).count();
    output::print(&if options.json {
        as_json(&groups, options.seed, failed == 0)
    } else {
        as_text(&groups, options.seed)
    })?;
    match failed {
        0 => Ok(()),
        _ => Err(Failure::work(format!("{failed} of {} groups failed", groups.len()))),
    }
}

fn kernels() -> Vec<&'static str> {
    Kernel::available().map(Kernel::name).collect()
}

fn as_text(groups: &[Group], seed: u64) -> String {
    let mut text = format!("kernels {}; seed {seed}\n", kernels().join(", "));
    for group in groups {
        let verdict = match group.failures.len() {
            0 if group.cases == 0 => "FAILED, nothing was tried".to_string(),
            0 => "ok".to_string(),
            failures => format!("FAILED, {failures} of them"),
        };
        text += &format!("{}: {} cases, {verdict}\n", group.name, group.cases);
        for failure in &group.failures {
            text += &format!("    {failure}\n");
        }
    }
    text
}

fn as_json(groups: &[Group], seed: u64, passed: bool) -> String {
    let groups: Vec<Value> = groups
        .iter()
        .map(|group| json!({ "name": group.name, "cases": group.cases, "failures": group.failures }))
        .collect();
    let all = json!({ "schema": 1, "passed": passed, "seed": seed, "kernels": kernels(), "groups": groups });
    format!("{all:#}\n")
}
