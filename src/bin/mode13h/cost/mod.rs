//! `mode13h cost`: what accuracy costs in time.

mod host;
mod instructions;
mod json;
mod text;

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use mode13h::cost::{self, Settings, Step, Subject, report};
use mode13h::export;
use mode13h::render::Rung;
use mode13h::scene::Scene;
use mode13h::span::Kernel;

use crate::failure::Failure;
use crate::options::{Drawing, finite};
use crate::stage::Stage;
use crate::{input, output};

/// Frames that follow each other 0.25° apart, for what swims.
const STEPS: u32 = 5;

#[derive(Args)]
#[command(mut_arg("rung", |arg| arg.hide(true)), mut_arg("max_error", |arg| arg.hide(true)))]
pub(crate) struct Options {
    #[arg(help = input::help())]
    input: OsString,
    /// The directory to write into: report.html, chart.svg, cost.json, and samples.csv with every time that was taken
    /// [default: cost-INPUT; none with --json]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// As JSON, for programs
    #[arg(long)]
    json: bool,
    /// The rungs to be studied, with commas between [default: all]
    #[arg(long, value_name = "RUNG,...", value_delimiter = ',')]
    rungs: Vec<Rung>,
    /// How many frames, all over one round: a model turns once, a scene moves for as long as it says
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000), default_value_t = 8)]
    frames: u32,
    /// Count instructions too, by valgrind. It knows not every vector instruction: times are then taken with the
    /// kernel that ran there
    #[arg(long)]
    instructions: bool,
    /// About how long times are taken
    #[arg(long, value_name = "SECONDS", value_parser = finite, default_value_t = 10.0, hide = true)]
    seconds: f64,
    /// Draw what instructions are counted of, and nothing else
    #[arg(long, hide = true)]
    counted: bool,
    #[command(flatten)]
    drawing: Drawing,
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let Options { input, out, json, frames, instructions, seconds, counted, drawing, .. } = options;
    if drawing.chooses_rung() {
        return Err(Failure::words("cost compares rungs and budgets with each other: --rungs says which rungs"));
    }
    let rungs = if options.rungs.is_empty() { Rung::ALL.to_vec() } else { options.rungs.clone() };
    let mut kernel = drawing.kernel()?;
    let input = drawing.input(input)?;
    let name = input.name().to_string();
    let mut stage = drawing.stage(input)?;
    let frames = turned(&mut stage, *frames, 360.0 / f64::from(*frames));
    let steps = turned(&mut stage, STEPS, 0.25);
    if *counted {
        return instructions::draw(&frames, &rungs, &|| drawing.renderer(kernel));
    }
    let directory = match (out, json) {
        (Some(directory), _) => Some(directory.clone()),
        (None, true) => None,
        (None, false) => Some(PathBuf::from(format!("cost-{name}"))),
    };
    // Before much time is spent.
    if let Some(directory) = directory.as_ref().filter(|directory| directory.exists() && !directory.is_dir()) {
        return Err(Failure::work(format!("{}: is no directory", directory.display())));
    }
    let counts = if *instructions { Some(instructions::count(&rungs, frames.len())?) } else { None };
    if let Some(counts) = &counts {
        kernel = Kernel::by_name(&counts.kernel).map_err(Failure::work)?;
    }

    let renderer = || drawing.renderer(kernel);
    let subject = Subject { name: &name, frames: &frames, steps: &steps, renderer: &renderer };
    let mut settings = Settings::default();
    (settings.rungs, settings.seconds) = (rungs, *seconds);
    (settings.host, settings.clock) = (host::host(), host::clock());
    let progress = Progress::new();
    let measured = cost::measure(&subject, &settings, &|step, share| progress.show(step, share));
    progress.bar.finish_and_clear();
    let (mut study, samples) = measured.map_err(Failure::work)?;
    if let Some(counts) = &counts {
        counts.write_into(&mut study);
    }
    let warnings = cost::warnings(&study);
    for warning in &warnings {
        eprintln!("mode13h: {}", Failure::work(warning));
    }
    let as_json = json::json(&study, &warnings)?;
    if let Some(directory) = &directory {
        fs::create_dir_all(directory).map_err(|error| Failure::work(format!("{}: {error}", directory.display())))?;
        write(directory, "samples.csv", &samples.to_csv())?;
        write(directory, "cost.json", &as_json)?;
        write(directory, "chart.svg", &report::chart_svg(&study))?;
        write(directory, "report.html", &report::html(&study))?;
    }
    output::print(&if *json { as_json } else { text::text(&study, directory.as_deref()) })
}

/// So many frames of what is shown, each turned by so many degrees more than the one before it.
fn turned(stage: &mut Stage, frames: u32, degrees: f64) -> Vec<Scene> {
    let mut scenes = Vec::new();
    for frame in 0..frames {
        let (seconds, pose) = stage.turned(0.0, f64::from(frame) * degrees);
        stage.show(seconds, pose);
        scenes.push(stage.scene.clone());
    }
    scenes
}

/// Writes a file of the directory, whole or not at all.
fn write(directory: &Path, name: &str, text: &str) -> Result<(), Failure> {
    let path = directory.join(name);
    output::file(|| export::write_atomically(path, |out| out.write_all(text.as_bytes()))).map_err(Failure::work)
}

/// A bar on standard error, if that is a terminal.
struct Progress {
    bar: ProgressBar,
    step: Mutex<Option<Step>>,
}

impl Progress {
    fn new() -> Progress {
        let bar = ProgressBar::new(1000);
        let bar = match ProgressStyle::with_template("{bar:40} {percent}% {msg}") {
            Ok(style) => bar.with_style(style),
            Err(_) => bar,
        };
        Progress { bar, step: Mutex::new(None) }
    }

    fn show(&self, step: Step, share: f64) {
        let mut last = self.step.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if *last != Some(step) {
            *last = Some(step);
            self.bar.set_message(match step {
                Step::Errors => "frames compared with the truth",
                Step::Times => "of the time, frames being timed side by side",
                Step::Split => "of the time, frames being timed part by part",
                Step::Claims => "of what the sources claim",
                _ => "",
            });
        }
        // 0 to 1.
        self.bar.set_position((share * 1000.0) as u64);
    }
}
