//! `mode13h render`: one picture, or a numbered row of them.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use mode13h::export::Scale;
use mode13h::record::Record;
use mode13h::render::{HiddenSurfaces, Renderer, Screen, Stats};
use mode13h::vga::Vga;
use rayon::ThreadPoolBuilder;
use rayon::iter::{IntoParallelIterator, ParallelIterator};

use crate::failure::Failure;
use crate::options::Drawing;
use crate::stage::{Pose, SPEED, Stage};
use crate::{input, output};

#[derive(Args)]
pub(crate) struct Options {
    #[arg(help = input::help())]
    input: OsString,
    /// The picture: a name ending in .png; with --frames, one that holds %04d or the like for the number
    #[arg(short, long, value_name = "OUT")]
    out: PathBuf,
    /// How many frames, numbered from 0
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: u32,
    /// One frame: turn the model by so much. N frames: spread so much over them, frame i being turned by i/N of it;
    /// 360 makes a seamless turn
    #[arg(long, value_name = "DEGREES", value_parser = finite, allow_negative_numbers = true, conflicts_with = "fps")]
    turn: Option<f64>,
    /// The time of the first frame: the model turns 90 degrees a second
    #[arg(long, value_name = "SECONDS", value_parser = finite, allow_negative_numbers = true, default_value_t = 0.0)]
    at: f64,
    /// Frames a second, which say how far the model turns from one to the next where --turn does not
    #[arg(long, value_name = "N", value_parser = rate, default_value_t = 35.0)]
    fps: f64,
    #[command(flatten)]
    drawing: Drawing,
    #[arg(long, value_name = "WAY", help = help_on_hidden_surfaces())]
    hidden: Option<HiddenSurfaces>,
    /// Enlarge: 1, 2, 5x6 (exactly 4:3 in square pixels), or a width and height such as 640x480 [default: 1; 5x6 with
    /// --rgb]
    #[arg(long, value_name = "SCALE")]
    scale: Option<Scale>,
    /// True colour instead of a palette
    #[arg(long)]
    rgb: bool,
    /// How many frames are drawn at a time [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Keep the triangles of the picture as the raster gets them, for `verify --replay`; with --frames, a name that
    /// holds %04d or the like
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Say on standard error what was drawn, and by which kernel, a line for each frame
    #[arg(long)]
    stats: bool,
}

fn help_on_hidden_surfaces() -> String {
    let names = HiddenSurfaces::ALL.map(HiddenSurfaces::name);
    format!("How hidden surfaces are left out: {} [default: as the scene calls for]", names.join(", "))
}

fn finite(words: &str) -> Result<f64, String> {
    match words.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err("not a number".to_string()),
    }
}

fn rate(words: &str) -> Result<f64, String> {
    match finite(words) {
        Ok(number) if number > 0.0 && number <= 1e6 => Ok(number),
        _ => Err("not a number above 0 and up to 1000000".to_string()),
    }
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let names = Names::pictures(&options.out, options.frames)?;
    let records = options.record.as_deref().map(|record| Names::new(record, options.frames, "records")).transpose()?;
    if options.record.as_ref() == Some(&options.out) {
        return Err(Failure::words(format!("{}: one name for the picture and its record", options.out.display())));
    }
    let kernel = options.drawing.kernel()?;
    let (_, palette) = options.drawing.palette()?;
    let model = input::model(&options.input)?;
    let stage = Stage::new(model.mesh, options.drawing.up_axis(), palette);

    let film = Film { options, names, records, stage };
    let progress = progress(options.frames);
    let artist = || {
        let mut renderer = Renderer::new();
        renderer.set_kernel(kernel);
        renderer.set_rung(options.drawing.rung());
        renderer.set_hidden_surfaces(options.hidden);
        (renderer, film.stage.clone(), Vga::new())
    };
    let frame = |(renderer, stage, vga): &mut (Renderer, Stage, Vga), number: u32| {
        let stats = film.draw(number, renderer, stage, vga)?;
        if options.stats {
            progress.suspend(|| eprintln!("mode13h: frame {number}: {stats}"));
        }
        progress.inc(1);
        Ok(())
    };
    let result = if options.frames == 1 {
        frame(&mut artist(), 0)
    } else {
        let threads = options.threads.map_or(0, usize::from);
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().map_err(Failure::work)?;
        pool.install(|| (0..options.frames).into_par_iter().try_for_each_init(artist, frame))
    };
    progress.finish_and_clear();
    result
}

/// What all frames of a row have in common. Each is drawn from its own number alone, never from the frame before it:
/// that is why the order, and the number of threads, change nothing.
struct Film<'a> {
    options: &'a Options,
    names: Names,
    records: Option<Names>,
    stage: Stage,
}

impl Film<'_> {
    fn draw(&self, number: u32, renderer: &mut Renderer, stage: &mut Stage, vga: &mut Vga) -> Result<Stats, Failure> {
        stage.pose(Pose { turn: self.turn(number), ..Pose::FIRST });
        let stats = renderer.draw(&stage.scene, vga).map_err(Failure::work)?;
        if let Some(records) = &self.records {
            let record = Record::of_scene(renderer, &stage.scene, Screen::MODE_13H).map_err(Failure::work)?;
            output::file(|| record.save(records.of(number))).map_err(Failure::work)?;
        }
        let path = self.names.of(number);
        output::picture(vga, &path, self.options.rgb, self.options.scale).map_err(Failure::work)?;
        Ok(stats)
    }

    /// How far the model is turned in a frame, in radians. From the frame's number alone: nothing adds up.
    fn turn(&self, number: u32) -> f64 {
        let Options { frames, turn, at, fps, .. } = *self.options;
        let number = f64::from(number);
        match turn {
            Some(degrees) if frames == 1 => at * SPEED + degrees.to_radians(),
            Some(degrees) => at * SPEED + (degrees * number / f64::from(frames)).to_radians(),
            None => (at + number / fps) * SPEED,
        }
    }
}

/// The names of a row of files.
struct Names {
    /// What stands before and behind the number, and the number's least count of digits; nothing if the name holds
    /// no number.
    numbered: Option<(String, usize, String)>,
    out: PathBuf,
}

impl Names {
    fn pictures(out: &Path, frames: u32) -> Result<Names, Failure> {
        if !out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
            let reason = "no kind of picture that can be written: the name must end in .png";
            return Err(Failure::words(format!("{}: {reason}", out.display())));
        }
        Names::new(out, frames, "pictures")
    }

    fn new(out: &Path, frames: u32, of: &str) -> Result<Names, Failure> {
        let numbered = out.file_name().and_then(|name| number_in(name.to_str()?));
        if frames > 1 && numbered.is_none() {
            let reason = format!("a row of {of} needs a place for the number in the name, such as %04d");
            return Err(Failure::words(format!("{}: {reason}", out.display())));
        }
        Ok(Names { numbered, out: out.to_path_buf() })
    }

    fn of(&self, number: u32) -> PathBuf {
        match &self.numbered {
            Some((before, digits, behind)) => self.out.with_file_name(format!("{before}{number:0digits$}{behind}")),
            None => self.out.clone(),
        }
    }
}

/// Splits a name at `%d` or `%04d` (any one digit): what stands before it, the least count of digits, what stands
/// behind.
fn number_in(name: &str) -> Option<(String, usize, String)> {
    name.match_indices('%').find_map(|(at, _)| {
        let behind = &name[at + 1..];
        let (digits, behind) = match behind.strip_prefix('0') {
            Some(padded) => (padded.chars().next()?.to_digit(10)?, padded.get(1..)?),
            None => (1, behind),
        };
        let behind = behind.strip_prefix('d')?;
        // At most 9.
        Some((name[..at].to_string(), digits as usize, behind.to_string()))
    })
}

/// A bar on standard error, if that is a terminal and there is more than one frame.
fn progress(frames: u32) -> ProgressBar {
    if frames == 1 {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(frames.into());
    match ProgressStyle::with_template("{bar:40} {pos}/{len} frames, {eta} left") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_holds_a_number_where_it_says_so() {
        for (out, name) in [
            ("a/b%04d.png", "a/b0007.png"),
            ("%d.png", "7.png"),
            ("%01d.png", "7.png"),
            ("50%-%09d-x.PNG", "50%-000000007-x.PNG"),
            ("100%d%d.png", "1007%d.png"),
        ] {
            let names = Names::pictures(Path::new(out), 8).expect("a number");
            assert_eq!(names.of(7), Path::new(name));
        }
        for out in ["a.png", "%.png", "%4d.png", "%0d.png", "%0xd.png", "%04x.png", "%04d/a.png", "%0"] {
            assert!(Names::pictures(Path::new(out), 8).is_err(), "{out}");
        }
        let one = Names::pictures(Path::new("a.png"), 1).expect("one picture");
        assert_eq!(one.of(0), Path::new("a.png"));
    }
}
