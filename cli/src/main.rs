//! `mode13h`: a scene or a model in a window, or a picture of it.

mod chart;
mod cost;
mod demo;
mod effect_cost;
mod explain;
mod failure;
mod film;
mod input;
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
mod show;
mod toggles;
mod turntable;
mod verify;

use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, Parser, Subcommand};

use failure::Failure;

/// Draws scenes and models as a 386 with a VGA card did: 320 x 200 bytes, 256 colours, fixed point.
#[derive(Parser)]
#[command(version, args_conflicts_with_subcommands = true, after_help = demo::KEYS)]
struct Words {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    demo: demo::Options,
}

#[derive(Subcommand)]
enum Command {
    /// Show a scene, or turn a model, in a window; so do `mode13h` and `mode13h INPUT`
    #[command(after_help = demo::KEYS)]
    Demo(demo::Options),
    /// Write a picture of a scene or a model, a numbered row of them, or a film
    Render(render::Options),
    /// List the scenes that are compiled in, or copy one to edit it
    Scenes(scenes::Options),
    /// Say what a scene calls for, object by object, and why
    Plan(plan::Options),
    /// Let one pixel account for its byte, or show a row's intensity and its slope
    Explain(explain::Options),
    /// Measure what accuracy costs in time: every shading's error beside its time
    Cost(cost::Options),
    /// Look at a palette, convert it, or make one for a model
    Palette(palette::Options),
    /// Draw a hard case 16 times enlarged: the right way beside the fault it guards against
    Show(show::Options),
    /// Check this machine: every span kernel against the specification, and the hard cases
    Verify(verify::Options),
}

fn main() -> ExitCode {
    output::finish_files_when_interrupted();
    match Words::try_parse() {
        Ok(words) => exit(run(words)),
        Err(error) => match error.kind() {
            ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => exit(output::print(&error.render().to_string())),
            _ => exit(Err(Failure::words(sentence(&error)))),
        },
    }
}

fn run(words: Words) -> Result<(), Failure> {
    match words.command {
        None => match words.demo.more_inputs().iter().find(|word| Words::command().find_subcommand(word).is_some()) {
            Some(word) => Err(Failure::words(format!("{} is a command, and stands before its INPUT", word.display()))),
            None => demo::run(&words.demo),
        },
        Some(Command::Demo(options)) => demo::run(&options),
        Some(Command::Render(options)) => render::run(&options),
        Some(Command::Scenes(options)) => scenes::run(&options),
        Some(Command::Plan(options)) => plan::run(&options),
        Some(Command::Explain(options)) => explain::run(&options),
        Some(Command::Cost(options)) => cost::run(&options),
        Some(Command::Palette(options)) => palette::run(&options),
        Some(Command::Show(options)) => show::run(&options),
        Some(Command::Verify(options)) => verify::run(&options),
    }
}

fn exit(result: Result<(), Failure>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("mode13h: {failure}");
            failure.status()
        }
    }
}

/// What clap says over several lines, as one: its first paragraph, without the word "error".
fn sentence(error: &clap::Error) -> String {
    let message = match error.get(ContextKind::InvalidSubcommand) {
        // clap calls a second INPUT a subcommand that cannot stand there.
        Some(ContextValue::String(word)) if Words::command().find_subcommand(word).is_none() => {
            format!("unexpected argument '{word}' found")
        }
        _ => error.render().to_string(),
    };
    let message = message.strip_prefix("error: ").unwrap_or(&message);
    let paragraph: Vec<&str> = message.lines().map(str::trim).take_while(|line| !line.is_empty()).collect();
    let help = match command() {
        Some(command) => format!("mode13h {command} --help"),
        None => "mode13h --help".to_string(),
    };
    format!("{} ({help} shows the words there are)", paragraph.join(" "))
}

/// The command that the first word names, if it names one.
fn command() -> Option<String> {
    let first = std::env::args_os().nth(1)?;
    Words::command().find_subcommand(first).map(|command| command.get_name().to_string())
}
