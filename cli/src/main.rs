//! `mode13h`: a scene or a model in a window, or a picture of it.

extern crate alloc;

mod cases;
mod chart;
mod cost;
mod demo;
mod dos;
mod effect_cost;
mod explain;
mod failure;
mod film;
mod generate;
mod host;
mod input;
mod list;
mod names;
mod options;
mod output;
mod overlay;
mod palette;
mod plan;
mod read_files;
mod render;
mod renderer_pool;
mod scenes;
mod stats;
mod toggles;
mod turntable;
mod typo;
mod verify;
mod words;

use std::process::ExitCode;

fn main() -> ExitCode {
    output::finish_files_when_interrupted();
    let result = words::parse().map_or_else(|answer| answer, |words| words::run(&words));
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            output::note(&failure);
            ExitCode::from(failure.status())
        }
    }
}
