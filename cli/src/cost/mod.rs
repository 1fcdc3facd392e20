//! `mode13h cost`: what accuracy costs in time.

mod files;
mod instructions;

use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Mutex;
use std::time::Instant;

use clap::Args;
use indicatif::ProgressBar;
use mode13h::scene::Scene;
use mode13h::settings::{Shading, VertexPath};
use mode13h::span::Kernel;
use mode13h_lab::cost::{self, Settings, Step, Study, Subject, report};
use serde::Serialize;

use crate::failure::{Failure, on_one_line};
use crate::options::{Drawing, number, shading_of};
use crate::turntable::Turntable;
use crate::{host, input, output};

/// Number of frames 0.25° apart, for measuring swim.
const STEPS: u32 = 5;

#[derive(Args)]
pub(crate) struct Options {
    #[arg(help = input::HELP, long_help = input::long_help())]
    input: OsString,
    /// Write the study to DIR
    ///
    /// report.html, chart.svg, cost.json, and samples.csv with every single time. An earlier study is overwritten.
    ///
    /// [default: cost-INPUT in the current directory, never overwritten without --force; none with --json]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Overwrite a study in cost-INPUT
    #[arg(long)]
    force: bool,
    /// Open the report in the browser
    #[arg(long, conflicts_with = "json")]
    open: bool,
    /// Print the study as JSON
    #[arg(long)]
    json: bool,
    #[arg(
        long,
        help = "Measure only these shadings [default: all]",
        long_help = long_help_on_shadings(),
        value_name = "NAME,...",
        value_delimiter = ',',
        value_parser = shading_of(Shading::ALL),
        hide_possible_values = true,
    )]
    shadings: Vec<Shading>,
    /// Measure N frames of one loop
    ///
    /// They are evenly spaced. A model turns once; a scene sets the length of its loop.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000), default_value_t = 8)]
    frames: u32,
    /// Count instructions as well, with valgrind
    ///
    /// Valgrind lacks some vector instructions; timings then use a kernel that valgrind supports.
    #[arg(long)]
    instructions: bool,
    /// Stop timing after SECONDS
    ///
    /// At least seven rounds are timed; fewer rounds give wider intervals. Before that, finding the errors takes a second or
    /// two per frame.
    ///
    /// [default: 10; up to 20 while a ratio is not yet known to 2 %]
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    seconds: Option<f64>,
    /// Only draw the frames whose instructions are counted
    #[arg(long, hide = true)]
    counted: bool,
    #[command(flatten)]
    drawing: Drawing,
}

fn long_help_on_shadings() -> String {
    format!(
        "Measure only these shadings, separated by commas: {}\n\n[default: all]",
        Shading::ALL.map(Shading::name).join(", ")
    )
}

/// A time on the command line.
fn seconds(words: &str) -> Result<f64, String> {
    number(words, " of seconds, 0 or more", |seconds: &f64| seconds.is_finite() && *seconds >= 0.0)
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let Options { input, out, force, open, json, frames, instructions, seconds, counted, drawing, .. } = options;
    let shadings = if options.shadings.is_empty() { Shading::ALL.to_vec() } else { options.shadings.clone() };
    let mut kernel = drawing.kernel()?;
    let is_integer = drawing.renderer(kernel).settings.vertex_path == Some(VertexPath::Integer);
    if let Some(shading) = options.shadings.iter().find(|shading| is_integer && shading.in_integers() != **shading) {
        return Err(Failure::words(format!("--shadings {shading}: not with --arithmetic fixed, which lacks it")));
    }
    if *instructions && input::is_standard(input) {
        return Err(Failure::words("-: --instructions reads the input a second time, so it must be a file"));
    }
    let input = drawing.input(input)?;
    let name = input.name().to_string();
    let mut stage = drawing.stage(input)?;
    // A look rounds vertices, but shadings make their promises for unrounded ones. Rounding is measured separately.
    stage.scene.settings.vertex_bits = None;
    let frames = turned(&mut stage, *frames, 360.0 / f64::from(*frames));
    let steps = turned(&mut stage, STEPS, 0.25);
    if *counted {
        return instructions::draw(&frames, &shadings, &|| drawing.renderer(kernel));
    }
    let directory = out.clone().or_else(|| (!json).then(|| PathBuf::from(format!("cost-{name}"))));
    // Before much time is spent.
    directory.as_deref().map_or(Ok(()), |directory| files::check(directory, out.is_some(), *force))?;
    let counts = if *instructions { Some(instructions::count(&shadings, frames.len())?) } else { None };
    if let Some((counted, _)) = &counts {
        kernel = counted.parse::<Kernel>().map_err(Failure::words)?;
    }

    let renderer = || drawing.renderer(kernel);
    let subject = Subject { name: &name, frames: &frames, steps: &steps, renderer: &renderer };
    let mut settings = Settings { shadings, host: host::host(), clock: host::clock(), ..Settings::default() };
    if let Some(seconds) = *seconds {
        (settings.seconds, settings.at_most) = (seconds, true);
    }
    let times = match *seconds {
        Some(seconds) => format!("at most {seconds} s"),
        None => format!("{} to {} s", settings.seconds, 2.0 * settings.seconds),
    };
    let compared = output::counted(frames.len() as u64, "frame");
    output::remark(format_args!("comparing {compared} with the reference, then timing for {times}"));
    let bar = output::bar(1000, "{bar:40} {percent}% {msg}");
    let progress = Progress { bar, step: Mutex::new(None), begun: Instant::now() };
    let measured = cost::measure(&subject, &settings, &|step, share| progress.show(step, share));
    progress.bar.finish_and_clear();
    let (mut study, samples) = measured?;
    if let Some((_, counts)) = &counts {
        study.shadings.iter_mut().for_each(|row| row.instructions = counts.get(&row.shading).copied());
    }
    let warnings = cost::warnings(&study);
    for warning in &warnings {
        output::note(on_one_line(warning));
    }
    let as_json = as_json(&study, &warnings)?;
    let (written, result) = match &directory {
        None => (None, Ok(())),
        Some(directory) => {
            let contents = [samples.to_csv(), as_json.clone(), report::chart_svg(&study), report::html(&study)];
            files::write(directory, &name, &contents)
        }
    };
    // The results are printed whatever became of the files.
    let place = written.as_ref().map_or(String::new(), |directory| format!("\nwritten to {}\n", directory.display()));
    match json {
        true => output::print(&as_json),
        false => output::say(&(report::text(&study) + &place)),
    }?;
    result?;
    if let Some(directory) = written.filter(|_| *open) {
        let page = directory.join(files::REPORT);
        open::that_detached(&page)
            .map_err(|error| Failure::work(format!("{}: cannot be opened in a browser: {error}", page.display())))?;
    }
    verdict(&study)
}

/// Fails if a budget or a shading is less accurate than it promises.
fn verdict(study: &Study) -> Result<(), Failure> {
    match cost::promises_are_kept(study) {
        true => Ok(()),
        false => Err(Failure::work("a budget or a shading has not kept its promise")),
    }
}

/// Makes `frames` frames of the scene, each turned by `degrees` more than the one before it.
fn turned(stage: &mut Turntable, frames: u32, degrees: f64) -> Vec<Scene> {
    let mut scenes = Vec::new();
    for frame in 0..frames {
        let (seconds, pose) = stage.turned(0.0, f64::from(frame) * degrees);
        stage.show(seconds, pose);
        scenes.push(stage.scene.clone());
    }
    scenes
}

/// A progress bar on standard error, if that is a terminal.
struct Progress {
    bar: ProgressBar,
    step: Mutex<Option<Step>>,
    begun: Instant,
}

impl Progress {
    fn show(&self, step: Step, share: f64) {
        let mut last = self.step.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if *last != Some(step) {
            *last = Some(step);
            if step == Step::Errors {
                // The first frame is done, and on every other processor nearly another.
                let threads = std::thread::available_parallelism().map_or(1.0, |threads| threads.get() as f64);
                let seconds = (self.begun.elapsed().as_secs_f64() / (share * threads)).ceil().max(1.0);
                self.bar.suspend(|| output::remark(format_args!("the comparison takes about {seconds} s")));
            }
            self.bar.set_message(match step {
                Step::Errors => "comparing frames with the reference",
                Step::Times => "timing frames side by side",
                Step::Split => "timing frames part by part",
                Step::Goals => "drawing frames as well as a time allows",
                Step::Claims => "checking what the sources claim",
                _ => "",
            });
        }
        // 0 to 1.
        self.bar.set_position((share * 1000.0) as u64);
    }
}

/// The study as JSON, for other programs.
fn as_json(study: &Study, warnings: &[String]) -> Result<String, Failure> {
    #[derive(Serialize)]
    struct Json<'a> {
        schema: u32,
        #[serde(flatten)]
        study: &'a Study,
        warnings: &'a [String],
    }
    output::json(&Json { schema: output::SCHEMA, study, warnings })
}

#[cfg(test)]
mod tests {
    use mode13h::mesh::shapes;
    use mode13h::render::Renderer;

    use super::*;

    /// A study in which all promises are kept, then with the promise of a budget or of a shading broken by hand: each
    /// is one warning more, in the JSON too, and the exit status 1. A slow budget is only a warning.
    #[test]
    fn a_broken_promise_of_a_budget_or_a_shading_is_a_warning_and_status_1() {
        let frames = [Scene::showing(shapes::wall(3, 2))];
        let subject = Subject { name: "wall", frames: &frames, steps: &[], renderer: &Renderer::new };
        let mut settings = Settings { shadings: vec![Shading::Gouraud88], ..Settings::default() };
        (settings.choices, settings.claims, settings.seconds, settings.at_most) = (false, false, 0.0, true);
        let (mut kept, _) = cost::measure(&subject, &settings, &|_, _| {}).expect("a legal scene");
        // How long this machine takes does not matter here.
        kept.budget.iter_mut().for_each(|row| row.ratio = Some((1.0, (1.0, 1.0))));
        assert!(cost::warnings(&kept).is_empty() && verdict(&kept) == Ok(()));
        let beyond = kept.shadings[0].excess.expect("a shading that is linear on the screen has a bound");
        assert!(beyond <= 0.0, "{beyond}");
        let (mut budget, mut late, mut shading) = (kept.clone(), kept.clone(), kept);
        (budget.budget[0].within, shading.shadings[0].excess) = (0.99, Some(0.25));
        (late.budget[1].best_single_shading, late.budget[1].ratio) = (Some(Shading::Phong), Some((1.2, (1.1, 1.3))));
        for (study, says) in [
            (budget, "the budget of 16 keeps 99.00 % of the pixels within 16 shades, not 100 %"),
            (late, "a budget of 8 takes 1.20 times as long as phong; the aim is at most 1.05"),
            (shading, "gouraud-8.8 is off by 0.25 shades more than its bound"),
        ] {
            let warnings = cost::warnings(&study);
            assert_eq!(warnings, [says]);
            let json = as_json(&study, &warnings).expect("JSON");
            assert!(json.contains(says));
            let status = verdict(&study).map_err(|failure| failure.status());
            assert_eq!(status, if says.contains("the aim") { Ok(()) } else { Err(1) });
        }
    }
}
