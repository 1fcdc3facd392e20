//! `mode13h render`: a picture, numbered pictures, or an animation.

use std::ffi::OsString;
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use clap::Args;
use indicatif::ProgressBar;
use mode13h::export::Scale;
use mode13h::raster::Frame;
use mode13h::render::{Renderer, Stats};
use mode13h::settings::Accuracy;
use mode13h::span::Kernel;
use mode13h::vga::Vga;
use mode13h_assets::animation::FrameRate;
use mode13h_assets::terminal::Protocol;
use mode13h_lab::cost::{calibrate, time_frame};
use rayon::ThreadPoolBuilder;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde_json::{Value, json};

use crate::failure::{Failure, on_one_line};
use crate::film::{self, Film, Kind};
use crate::host::clock;
use crate::names::{Names, number_in};
use crate::options::{Drawing, Moment, ShadingOptions, number, one_of};
use crate::renderer_pool::RendererPool;
use crate::turntable::{Pose, Turntable};
use crate::{input, output, read_files, stats};

#[derive(Args)]
pub(crate) struct Options {
    #[arg(help = input::HELP, long_help = input::long_help())]
    input: OsString,
    /// Write to FILE: .png, .gif, .apng, or - for ffmpeg
    ///
    /// A .png is a picture; for several frames, put %04d or the like in its name. A .gif or .apng is an animation. An existing
    /// file is overwritten.
    ///
    /// With -, an animation goes to standard output as Y4M: `mode13h render torus -o - | ffmpeg -i - -pix_fmt yuv420p torus.mp4`.
    /// Y4M rounds colours to YCbCr; .apng keeps them exact. If standard output is a terminal, - shows a picture there: see
    /// --to.
    ///
    /// [default: INPUT.png in the current directory, never overwritten without --force]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Show the picture in the terminal: sixel or kitty
    ///
    /// It is written to standard output as DEC sixels or in kitty's graphics protocol. Sixels round colours to whole
    /// percentages; kitty's are exact.
    ///
    /// [default: with -o - on a terminal, kitty if the environment names kitty or Ghostty, or else sixel]
    #[arg(
        long,
        value_name = "PROTOCOL",
        value_parser = one_of(Protocol::ALL, Protocol::name),
        hide_possible_values = true,
        conflicts_with_all = ["rgb", "json"],
    )]
    to: Option<Protocol>,
    /// Overwrite INPUT.png
    #[arg(long)]
    force: bool,
    /// Draw N frames, numbered from 0
    ///
    /// [default: 1; for an animation one loop, which is four seconds or what the scene says]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: Option<u32>,
    /// Rotate by DEGREES, spread over all frames
    ///
    /// A single frame is rotated by the whole angle, frame i of N by i/N of it, so 360 loops seamlessly. A scene or model that
    /// moves by itself goes through one loop in 360 degrees; the camera circles one that does not.
    ///
    /// [default: 0; for an animation 360]
    #[arg(long, value_name = "DEGREES", value_parser = degrees, allow_negative_numbers = true)]
    turn: Option<f64>,
    #[command(flatten)]
    moment: Moment,
    /// Frames per second [default: 35]
    ///
    /// At most 50 in an animation. For pictures without --turn, it sets the time step.
    #[arg(long, value_name = "N", value_parser = rate)]
    fps: Option<f64>,
    /// Draw WxH square pixels instead of mode 13h's 320x200
    ///
    /// Up to 4096x4096. The pixels of mode 13h are not square: 320x200 of them fill a 4:3 screen.
    #[arg(long, value_name = "WxH", value_parser = size, conflicts_with = "max_time")]
    size: Option<(u32, u32)>,
    /// Enlarge the frame: 2, 5x6, or to a size like 640x480
    ///
    /// 5x6 makes mode 13h exactly 4:3.
    ///
    /// [default: 1; for mode 13h 5x6 with --rgb, and 640x480 in an animation or a terminal]
    #[arg(long, value_name = "SCALE")]
    scale: Option<Scale>,
    /// Write true colour instead of a palette; PNG only
    #[arg(long)]
    rgb: bool,
    /// Draw N frames in parallel [default: one per processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), hide_short_help = true)]
    threads: Option<u16>,
    /// Print figures for each frame to standard error
    #[arg(long)]
    stats: bool,
    /// Print file names, and with --stats the figures, as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    drawing: Drawing,
    #[command(flatten)]
    shading: ShadingOptions,
}

impl Options {
    /// The name that was given, or one made from the INPUT's.
    fn out(&self) -> PathBuf {
        self.out.clone().unwrap_or_else(|| {
            if self.to.is_some() {
                return "-".into();
            }
            let name = input::name_of(&self.input);
            let number = if self.frames.is_some_and(|frames| frames > 1) { "-%04d" } else { "" };
            // A % of its own would be taken for the position of a number.
            format!("{}{number}.png", name.replace('%', "_")).into()
        })
    }
}

/// Parses a size in pixels from the command line.
fn size(words: &str) -> Result<(u32, u32), String> {
    let side = |word: &str| word.parse().ok().filter(|side| (1..=Frame::MAX_SIDE).contains(side));
    let size = words.split_once('x').and_then(|(width, height)| Some((side(width)?, side(height)?)));
    size.ok_or_else(|| format!("not a size such as 640x400, with sides from 1 to {}", Frame::MAX_SIDE))
}

fn degrees(words: &str) -> Result<f64, String> {
    number(words, " from -1000000000 to 1000000000", |degrees: &f64| degrees.abs() <= 1e9)
}

fn rate(words: &str) -> Result<f64, String> {
    number(words, " from 0.001 to 1000000", |rate| (1e-3..=1e6).contains(rate))
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let path = options.out();
    let mut out = Out::new(options, &path)?;
    if options.json && film_kind(&path) == Some(Kind::Stream) {
        return Err(Failure::words("-: standard output carries the animation, so there is no place for --json"));
    }
    let input = options.drawing.input(&options.input)?;
    let is_still = matches!(out, Out::Pictures(_, 1) | Out::Terminal(_));
    let stage =
        if is_still { options.drawing.still(input, options.turn.is_some()) } else { options.drawing.stage(input) }?;
    if let Out::Film(film) = &mut out {
        film.lasts(stage.scene.duration);
    }
    let frames = out.frames();
    out.files().iter().try_for_each(|file| read_files::spare(file))?;
    if options.out.is_none() {
        out.files().iter().try_for_each(|file| output::refuse_overwriting(file, options.force))?;
    }
    let kernel = options.drawing.kernel()?;
    let progress = match frames {
        1 => ProgressBar::hidden(),
        _ => output::bar(frames.into(), "{bar:40} {pos}/{len} frames, {eta} left"),
    };
    let motion = Motion::new(options, &out, &stage);
    let timed = timed_frames(options, &motion, &stage, kernel)?;
    let make = || Artist {
        renderer: options.shading.renderer(&options.drawing, kernel),
        stage: stage.clone(),
        vga: Vga::new(),
        square: options.size.map(|(width, height)| (width, height, vec![0; width as usize * height as usize])),
    };
    let renderer_pool = RendererPool::new(make);
    let drawn: Mutex<Vec<Drawn>> = Mutex::default();
    let draw = |artist: &mut Artist, number: u32| -> Result<(), Failure> {
        let timed = timed.get(number as usize).copied();
        let stats = artist.draw(&motion, timed.map(|timed| timed.error), number)?;
        if options.stats && options.json {
            drawn.lock().unwrap_or_else(PoisonError::into_inner).push((number, stats, timed));
        } else if options.stats {
            let timed = timed.map_or(String::new(), |Timed { max_time, fits, .. }| {
                format!(", {} {max_time} ms", if fits { "fits in" } else { "takes more than" })
            });
            progress.suspend(|| output::note(format_args!("frame {number}: {stats}{timed}")));
        }
        Ok(())
    };
    let written: Mutex<Vec<u32>> = Mutex::default();
    let picture = |names: &Names, artist: &mut Artist, number| {
        draw(artist, number)?;
        let scale = options.scale.unwrap_or(match options.size {
            None if options.rgb => Scale::FiveBySix,
            _ => Scale::One,
        });
        output::picture(&artist.frame().picture(), &names.of(number), options.rgb, scale)?;
        written.lock().unwrap_or_else(PoisonError::into_inner).push(number);
        progress.inc(1);
        Ok(())
    };
    let frame = |artist: &mut Artist, number| {
        draw(artist, number)?;
        Ok(artist.frame())
    };
    let pool = || {
        let threads = options.threads.map_or(0, usize::from);
        ThreadPoolBuilder::new().num_threads(threads).build().map_err(Failure::from)
    };
    let result = match &out {
        Out::Pictures(names, 1) => renderer_pool.work(|artist| picture(names, artist, 0)).map(|()| None),
        Out::Pictures(names, frames) => pool()?.install(|| {
            let each = |n| renderer_pool.work(|artist| picture(names, artist, n));
            (0..*frames).into_par_iter().try_for_each(each).map(|()| None)
        }),
        Out::Terminal(protocol) => renderer_pool.work(|artist| {
            draw(artist, 0)?;
            let scale = options.scale.unwrap_or(if options.size.is_some() { Scale::One } else { Film::SCALE });
            let shown = protocol.picture(&artist.frame().picture(), scale)?;
            output::print(&(shown + "\n")).map(|()| None)
        }),
        Out::Film(film) => {
            let fades = stage.scene.palette_animation.is_some();
            pool()?.install(|| film.write(fades, &progress, &renderer_pool, frame))
        }
    };
    progress.finish_and_clear();
    let film = match (result, &out) {
        (Err(failure), Out::Pictures(names, _)) => {
            let written = written.into_inner().unwrap_or_else(PoisonError::into_inner);
            return Err(saying_which(failure, names, written));
        }
        (result, _) => result?,
    };
    if options.json {
        let drawn = drawn.into_inner().unwrap_or_else(PoisonError::into_inner);
        return output::print_json(&as_json(options, &out, film, drawn));
    }
    match film {
        Some(film) => output::say(&film.line),
        None if options.out.is_none() && options.to.is_none() => {
            let names = out.files().into_iter().map(|file| on_one_line(&file.to_string_lossy()) + "\n");
            output::say(&names.collect::<String>())
        }
        None => Ok(()),
    }
}

/// A failure that says which pictures of a series were written before it.
fn saying_which(failure: Failure, names: &Names, mut written: Vec<u32>) -> Failure {
    if written.is_empty() {
        return failure;
    }
    written.sort_unstable();
    let runs = written.chunk_by(|a, b| a + 1 == *b).map(|run| match run {
        [one] => names.of(*one).display().to_string(),
        [first, .., last] => format!("{} to {}", names.of(*first).display(), names.of(*last).display()),
        [] => String::new(),
    });
    let runs: Vec<String> = runs.collect();
    failure.saying(format!("{failure}; written before that: {}", runs.join(", ")))
}

/// Lists the files that were written and, with --stats, the statistics of each frame.
fn as_json(options: &Options, out: &Out, film: Option<film::Figures>, mut drawn: Vec<Drawn>) -> Value {
    drawn.sort_by_key(|(number, ..)| *number);
    let mut json = json!({
        "schema": output::SCHEMA,
        "input": input::name_of(&options.input),
        "files": out.files().iter().map(|file| file.to_string_lossy()).collect::<Vec<_>>(),
    });
    if let Some(film) = film {
        json["animation"] = film.json;
    }
    if options.stats {
        let frame = |(number, stats, timed): &Drawn| {
            let mut frame = stats::json(*number, stats);
            frame["max_time"] = timed.map(|timed| timed.max_time).into();
            frame["fits"] = timed.is_none_or(|timed| timed.fits).into();
            if let Some(timed) = timed {
                frame["milliseconds"] = timed.milliseconds.into();
            }
            frame
        };
        json["frames"] = drawn.iter().map(frame).collect();
    }
    json
}

/// Output of the command.
enum Out {
    /// This many pictures.
    Pictures(Names, u32),
    Film(Film),
    /// A picture on standard output.
    Terminal(Protocol),
}

impl Out {
    fn new(options: &Options, out: &Path) -> Result<Out, Failure> {
        let Options { frames, turn, fps, rgb, size, scale, to, .. } = options;
        let wrong = |reason: &dyn std::fmt::Display| Failure::words(format!("{}: {reason}", out.display()));
        let ends_in = |wanted| output::has_extension(out, wanted);
        let is_stream = film_kind(out) == Some(Kind::Stream);
        if to.is_some() && !is_stream {
            return Err(wrong(&"--to shows the picture in the terminal, so -o can only be -"));
        }
        if is_stream && (to.is_some() || io::stdout().is_terminal()) {
            if *rgb {
                return Err(wrong(&"--rgb is for .png"));
            }
            if frames.is_some_and(|frames| frames > 1) {
                return Err(Failure::words("a terminal shows one picture; `mode13h demo --terminal` shows motion"));
            }
            Ok(Out::Terminal(to.unwrap_or_else(|| Protocol::of_environment(|name| std::env::var_os(name)))))
        } else if ends_in("png") {
            if turn.is_some() && fps.is_some() {
                return Err(wrong(&"both --turn and --fps say how far the model turns between pictures: give one"));
            }
            let frames = frames.unwrap_or(1);
            Ok(Out::Pictures(Names::new(out, frames)?, frames))
        } else if let Some(kind) = film_kind(out) {
            if *rgb {
                return Err(wrong(&"--rgb is for .png; an animation gets the colours it needs"));
            }
            if kind != Kind::Stream && out.file_name().and_then(|name| number_in(name.to_str()?)).is_some() {
                return Err(wrong(&"an animation is one file: its name needs no number"));
            }
            let rate = fps.map_or(Ok(FrameRate::default()), FrameRate::try_from).map_err(|error| wrong(&error))?;
            Ok(Out::Film(Film::new(kind, out, *frames, rate, (*size, *scale))))
        } else {
            // Formats that ffmpeg can make from a stream.
            let films = ["mp4", "webm", "mkv", "mov", "avi", "webp"];
            let shown = out.display();
            Err(match films.into_iter().any(ends_in) {
                true => wrong(&format!(
                    "animations are .gif or .apng; for others pipe the frames: `-o - | ffmpeg -i - -pix_fmt yuv420p {shown}`"
                )),
                false => wrong(&"not a format that can be written: the name must end in .png, .gif or .apng"),
            })
        }
    }

    /// The files that are written.
    fn files(&self) -> Vec<PathBuf> {
        match self {
            Out::Pictures(names, frames) => (0..*frames).map(|number| names.of(number)).collect(),
            Out::Film(film) => film.file().map(Path::to_path_buf).into_iter().collect(),
            Out::Terminal(_) => Vec::new(),
        }
    }

    fn frames(&self) -> u32 {
        match self {
            Out::Pictures(_, frames) => *frames,
            Out::Film(film) => film.frames,
            Out::Terminal(_) => 1,
        }
    }
}

/// Kind of animation that a file name stands for, if any.
fn film_kind(out: &Path) -> Option<Kind> {
    let ends_in = |wanted| output::has_extension(out, wanted);
    match () {
        () if out == Path::new("-") => Some(Kind::Stream),
        () if ends_in("gif") => Some(Kind::Gif),
        () if ends_in("apng") => Some(Kind::Apng),
        () => None,
    }
}

/// Motion from frame to frame.
struct Motion {
    frames: u32,
    /// The turn over all frames, in degrees.
    turn: Option<f64>,
    /// The moment of the first frame, in seconds.
    at: f64,
    /// Frames per second, used if there is no `turn`.
    rate: f64,
}

impl Motion {
    fn new(options: &Options, out: &Out, stage: &Turntable) -> Motion {
        let frames = out.frames();
        let whole_turn = (matches!(out, Out::Film(_)) && frames > 1).then_some(360.0);
        let rate = options.fps.unwrap_or(FrameRate::default().frames_per_second());
        let is_picture = frames == 1 && options.turn.is_none();
        let at = if is_picture { options.moment.of_picture(&stage.scene) } else { options.moment.of_first() };
        Motion { frames, turn: options.turn.or(whole_turn), at, rate }
    }

    /// The time and the pose in a frame, from its number alone, so that no errors add up.
    fn of(&self, number: u32, stage: &Turntable) -> (f64, Pose) {
        let Motion { frames, turn, at, rate } = *self;
        let number = f64::from(number);
        match turn {
            Some(degrees) if frames == 1 => stage.turned(at, degrees),
            Some(degrees) => stage.turned(at, degrees * number / f64::from(frames)),
            None => (at + number / rate, Pose::FIRST),
        }
    }
}

/// Number and counts of a frame, and its times if it was timed.
type Drawn = (u32, Stats, Option<Timed>);

/// A frame that was timed.
#[derive(Clone, Copy)]
struct Timed {
    /// The error within which it is drawn.
    error: f32,
    /// The time allowed, in milliseconds.
    max_time: f32,
    milliseconds: f64,
    fits: bool,
}

/// If frames have to fit in a time, all of them are drawn once, one after the other, to find their errors before the
/// first is written. Empty if no time was asked for.
fn timed_frames(options: &Options, motion: &Motion, stage: &Turntable, kernel: Kernel) -> Result<Vec<Timed>, Failure> {
    let Options { shading, drawing, .. } = options;
    let frames = motion.frames;
    let mut renderer = shading.renderer(drawing, kernel);
    shading.note_ignored(&renderer);
    let (Some(max_time), Some(mut pace)) = (shading.max_time(), shading.pace(&renderer)) else {
        return Ok(Vec::new());
    };
    let (mut stage, mut vga, mut all) = (stage.clone(), Vga::new(), Vec::new());
    for number in 0..frames {
        let (seconds, pose) = motion.of(number, &stage);
        stage.show(seconds, pose);
        if number == 0 {
            calibrate((&mut renderer, &mut pace), &stage.scene, &mut vga, clock())?;
        }
        let (error, fits) = (pace.error(), pace.fits());
        let (_, milliseconds) = time_frame((&mut renderer, &mut pace), &stage.scene, &mut vga, clock())?;
        all.push(Timed { error, max_time, milliseconds, fits });
    }
    let late = all.iter().filter(|frame| !frame.fits).count();
    if late > 0 {
        let which = if frames == 1 { "the frame takes".to_string() } else { format!("{late} of {frames} frames take") };
        output::note(format_args!("{which} longer than {max_time} ms even at the largest error allowed"));
    }
    Ok(all)
}

/// Draws frames, one after the other. Each is drawn from its own number alone, never from the frame before it, so
/// neither the order nor the number of threads changes anything.
struct Artist {
    renderer: Renderer,
    stage: Turntable,
    /// The VGA: its palette, and its frame unless frames have another size.
    vga: Vga,
    /// Width, height and pixels of a frame of square pixels.
    square: Option<(u32, u32, Vec<u8>)>,
}

impl Artist {
    fn draw(&mut self, motion: &Motion, error: Option<f32>, number: u32) -> Result<Stats, Failure> {
        if let Some(error) = error {
            self.renderer.settings.accuracy = Some(Accuracy::WithinError(error));
        }
        let (seconds, pose) = motion.of(number, &self.stage);
        self.stage.show(seconds, pose);
        let scene = &self.stage.scene;
        let Some((width, height, pixels)) = &mut self.square else {
            return self.renderer.draw(scene, &mut self.vga).map_err(Failure::from);
        };
        let frame = Frame::new(pixels, *width, *height, *width as usize).map_err(Failure::words)?;
        let stats = self.renderer.draw_frame(scene, frame, (1, 1))?;
        scene.load_palette(&mut self.vga);
        Ok(stats)
    }

    /// The frame that was drawn last.
    fn frame(&self) -> film::Frame {
        match &self.square {
            None => film::Frame::of(&self.vga),
            Some((width, _, pixels)) => film::Frame::square(pixels.clone(), *width, self.vga.palette()),
        }
    }
}
