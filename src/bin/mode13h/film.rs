//! A film: frames drawn and compressed side by side, several at a time, and written in their order.

use std::ops::Range;
use std::path::{Path, PathBuf};

use indicatif::ProgressBar;
use mode13h::export::{self, FrameRate, GifFile, GifFrame, Picture, PictureError, Scale};
use mode13h::palette::Palette;
use mode13h::vga::Vga;
use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, IntoParallelRefIterator, ParallelIterator};

use crate::artists::Artists;
use crate::failure::{Failure, on_one_line};
use crate::output;

/// What a frame shows.
pub(crate) struct Frame {
    pixels: Vec<u8>,
    palette: Palette,
}

impl Frame {
    pub(crate) fn of(vga: &Vga) -> Frame {
        Frame { pixels: vga.pixels().to_vec(), palette: vga.palette() }
    }

    fn picture(&self) -> Picture<'_> {
        Picture::mode_13h(&self.pixels, &self.palette)
    }
}

/// Where a film goes, and how it is shown.
pub(crate) struct Film {
    out: PathBuf,
    frames: u32,
    /// Whether somebody said how many frames.
    is_told: bool,
    rate: FrameRate,
    scale: Scale,
}

impl Film {
    /// 4:3 in square pixels, as browsers show them.
    const SCALE: Scale = Scale::To { width: 640, height: 480 };

    /// A film of so many frames, or of one.
    pub(crate) fn new(out: &Path, frames: Option<u32>, rate: FrameRate, scale: Option<Scale>) -> Film {
        Film {
            out: out.to_path_buf(),
            frames: frames.unwrap_or(1),
            is_told: frames.is_some(),
            rate,
            scale: scale.unwrap_or(Self::SCALE),
        }
    }

    /// Where nobody said how many frames, as many as so many seconds hold.
    pub(crate) fn lasts(&mut self, seconds: f64) {
        if !self.is_told {
            // Saturates.
            self.frames = (seconds * self.rate.frames_per_second()).round().max(1.0) as u32;
        }
    }

    pub(crate) fn frames(&self) -> u32 {
        self.frames
    }

    /// Draws the frames by `draw`, by as many artists at a time as there are threads in the pool it is called in, writes
    /// them, and prints a line about the file. A frame is drawn from its number alone, so that the film is the same with
    /// any number of threads.
    pub(crate) fn write<Artist: Send>(
        &self,
        progress: &ProgressBar,
        artists: &Artists<Artist, impl Fn() -> Artist + Sync>,
        draw: impl Fn(&mut Artist, u32) -> Result<Frame, Failure> + Sync + Send,
    ) -> Result<(), Failure> {
        let film = output::long_file(|| {
            let film = self.write_file(progress, artists, &draw);
            progress.finish_and_clear();
            film
        })?;
        output::print(&self.figures(&film))
    }

    /// While some frames are compressed and written, the next are drawn: these are all that is in memory.
    fn write_file<Artist: Send>(
        &self,
        progress: &ProgressBar,
        artists: &Artists<Artist, impl Fn() -> Artist + Sync>,
        draw: &(impl Fn(&mut Artist, u32) -> Result<Frame, Failure> + Sync + Send),
    ) -> Result<export::Film, Failure> {
        let mut file = GifFile::create(&self.out, self.scale, self.rate).map_err(Failure::work)?;
        let draw = |number| go_on().and_then(|()| artists.work(|artist| draw(artist, number)));
        let draw_all =
            |numbers: Range<u32>| -> Result<Vec<Frame>, Failure> { numbers.into_par_iter().map(draw).collect() };
        // Some for each thread (of which there are at most 1,024): frames are not equally fast.
        let threads = rayon::current_num_threads() as u32;
        let batch = (16 * threads).min(256).max(threads);
        let batch_from = |first: u32| first.min(self.frames)..(first + batch).min(self.frames);
        let mut drawn = draw_all(batch_from(0))?;
        let colors = drawn.first().map(|first| first.palette.clone()).unwrap_or_default();
        let mut last: Option<Frame> = None;
        for first in (0..self.frames).step_by(batch as usize) {
            let compress = |(i, frame): (usize, &Frame)| {
                go_on()?;
                let before = i.checked_sub(1).map_or(last.as_ref(), |before| drawn.get(before));
                self.compressed(before, frame, &colors)
                    .map_err(|error| Failure::work(on_one_line(&format!("{}: {error}", self.out.to_string_lossy()))))
            };
            let write_all = || -> Result<(), Failure> {
                let compressed: Vec<GifFrame> = drawn.par_iter().enumerate().map(compress).collect::<Result<_, _>>()?;
                for frame in compressed {
                    go_on()?;
                    file.add_frame(frame).map_err(Failure::work)?;
                    progress.inc(1);
                }
                Ok(())
            };
            let (written, following) = rayon::join(write_all, || draw_all(batch_from(first + batch)));
            written?;
            last = drawn.pop();
            drawn = following?;
        }
        file.finish().map_err(Failure::work)
    }

    fn compressed(&self, before: Option<&Frame>, frame: &Frame, film: &Palette) -> Result<GifFrame, PictureError> {
        match before {
            None => GifFrame::first(&frame.picture(), self.scale),
            Some(before) => GifFrame::after(&before.picture(), &frame.picture(), self.scale, film.colors()),
        }
    }

    /// A line about what was written.
    fn figures(&self, film: &export::Film) -> String {
        let export::Film { width, height, frames, images, delays, bytes, .. } = film;
        let plural = |count: u64| if count == 1 { "" } else { "s" };
        let in_images = match images == frames {
            true => String::new(),
            false => format!(" in {images} image{}", plural(*images)),
        };
        let delays: Vec<String> =
            delays.iter().rev().map(|(delay, images)| format!("{images} x {} ms", 10 * u32::from(*delay))).collect();
        format!(
            "{}: {width} x {height} pixels, {frames} frame{}{in_images}, {:.2} s, delays {}, {bytes} bytes\n",
            on_one_line(&self.out.to_string_lossy()),
            plural(*frames),
            film.seconds(),
            delays.join(" + "),
        )
    }
}

/// An error if the program has been told to end. It is never seen: [`output::long_file`] does not return then.
fn go_on() -> Result<(), Failure> {
    if output::is_interrupted() { Err(Failure::work("interrupted")) } else { Ok(()) }
}
