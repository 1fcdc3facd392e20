//! A film: frames drawn and compressed in parallel, several at a time, and written in order.

use std::io::{ErrorKind, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use indicatif::ProgressBar;
use mode13h::export::{Picture, Scale};
use mode13h::palette::Palette;
use mode13h::vga::Vga;
use mode13h_assets::animation::{self, AnimationError, ApngFile, ApngFrame, FilmColors, FrameRate, GifFile, GifFrame};
use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, IntoParallelRefIterator, ParallelIterator};
use serde_json::{Value, json};

use crate::failure::{Failure, on_one_line};
use crate::output;
use crate::renderer_pool::RendererPool;

/// Pixels and palette of a frame.
pub(crate) struct Frame {
    pixels: Vec<u8>,
    /// The width, if the pixels are square and not those of mode 13h.
    width: Option<u32>,
    palette: Palette,
}

impl Frame {
    pub(crate) fn of(vga: &Vga) -> Frame {
        Frame { pixels: vga.pixels().to_vec(), width: None, palette: vga.palette() }
    }

    /// A frame of square pixels.
    pub(crate) fn square(pixels: Vec<u8>, width: u32, palette: Palette) -> Frame {
        Frame { pixels, width: Some(width), palette }
    }

    pub(crate) fn picture(&self) -> Picture<'_> {
        match self.width {
            None => Picture::mode_13h(&self.pixels, &self.palette),
            Some(width) => Picture::of(&self.pixels, width as usize, &self.palette),
        }
    }
}

/// File formats of a film.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Gif,
    Apng,
    /// YUV4MPEG2 on standard output.
    Stream,
}

/// Figures of a film's file: a line of text, and the same as JSON.
pub(crate) struct Figures {
    pub(crate) line: String,
    pub(crate) json: Value,
}

/// The memory for the frames of one batch, unless they are fewer than threads.
const BATCH_BYTES: u64 = 1 << 28;

/// A film: its file, and how it is shown.
pub(crate) struct Film {
    kind: Kind,
    out: PathBuf,
    pub(crate) frames: u32,
    /// True if the number of frames was given.
    is_told: bool,
    rate: FrameRate,
    /// The size of a frame before it is enlarged.
    size: (u32, u32),
    scale: Scale,
}

impl Film {
    /// 4:3 in square pixels, as browsers show them.
    pub(crate) const SCALE: Scale = Scale::To { width: 640, height: 480 };

    /// A film of `frames` frames, or of one, in mode 13h or in square pixels of a size.
    pub(crate) fn new(
        kind: Kind,
        out: &Path,
        frames: Option<u32>,
        rate: FrameRate,
        (size, scale): (Option<(u32, u32)>, Option<Scale>),
    ) -> Film {
        Film {
            kind,
            out: out.to_path_buf(),
            frames: frames.unwrap_or(1),
            is_told: frames.is_some(),
            rate,
            size: size.unwrap_or((320, 200)),
            scale: scale.unwrap_or(if size.is_some() { Scale::One } else { Self::SCALE }),
        }
    }

    /// The file that it is written to, if it is one.
    pub(crate) fn file(&self) -> Option<&Path> {
        (self.kind != Kind::Stream).then_some(&self.out)
    }

    /// Sets the number of frames from a duration, unless it was given.
    pub(crate) fn lasts(&mut self, seconds: f64) {
        if !self.is_told {
            // Saturates.
            self.frames = (seconds * self.rate.frames_per_second()).round().max(1.0) as u32;
        }
    }

    /// Draws the frames with `draw`, by as many artists at a time as there are threads in the current pool, writes
    /// them, and returns the figures if the film is a file. A frame is drawn from its number alone, so the film is the
    /// same with any number of threads. `fades` says whether its palette changes.
    pub(crate) fn write<Artist: Send>(
        &self,
        fades: bool,
        progress: &ProgressBar,
        renderer_pool: &RendererPool<Artist, impl Fn() -> Artist + Sync>,
        draw: impl Fn(&mut Artist, u32) -> Result<Frame, Failure> + Sync + Send,
    ) -> Result<Option<Figures>, Failure> {
        let draw = |number| go_on().and_then(|()| renderer_pool.work(|artist| draw(artist, number)));
        output::long_file(self.file(), || {
            let figures = match self.kind {
                Kind::Gif => self.write_gif(progress, draw).map(Some),
                Kind::Apng => self.write_apng(fades, progress, draw).map(Some),
                Kind::Stream => self.write_stream(progress, draw).map(|()| None),
            };
            progress.finish_and_clear();
            figures
        })
    }

    fn write_gif(
        &self,
        progress: &ProgressBar,
        draw: impl Fn(u32) -> Result<Frame, Failure> + Sync + Send,
    ) -> Result<Figures, Failure> {
        let mut file = GifFile::create(&self.out, self.scale, self.rate)?;
        let make = |before: Option<&Frame>, frame: &Frame, first: &Palette| match before {
            None => GifFrame::first(&frame.picture(), self.scale),
            Some(before) => GifFrame::after(&before.picture(), &frame.picture(), self.scale, first.colors()),
        };
        self.each(progress, draw, make, |frame| file.add_frame(frame).map_err(Failure::from))?;
        file.finish().map(|film| self.figures(&film)).map_err(Failure::from)
    }

    /// Writes the film as an animated PNG. [`write_gif`](Self::write_gif) writes it as a GIF.
    fn write_apng(
        &self,
        fades: bool,
        progress: &ProgressBar,
        draw: impl Fn(u32) -> Result<Frame, Failure> + Sync + Send,
    ) -> Result<Figures, Failure> {
        let colors = |first: &Palette| match fades {
            true => FilmColors::True,
            false => FilmColors::Palette(Box::new(*first.colors())),
        };
        let mut file = ApngFile::create(&self.out, self.rate, self.frames)?;
        let make = |before: Option<&Frame>, frame: &Frame, first: &Palette| {
            ApngFrame::new(before.map(Frame::picture).as_ref(), &frame.picture(), self.scale, &colors(first))
        };
        self.each(progress, draw, make, |frame| file.add(&frame).map_err(Failure::from))?;
        let bytes = file.finish()?;
        let (width, height) = self.scale.size(self.size.0 as usize, self.size.1 as usize);
        let (above, below) = self.rate.fraction();
        let (frames, seconds) = (self.frames, f64::from(self.frames) * f64::from(below) / f64::from(above));
        let line = format!(
            "{}: {width} x {height} pixels, {}, {seconds:.2} s, {}, {bytes} bytes\n",
            on_one_line(&self.out.to_string_lossy()),
            output::counted(frames.into(), "frame"),
            if fades { "true colour, as the palette changes" } else { "indexed" },
        );
        let json = json!({
            "width": width, "height": height, "frames": frames, "seconds": seconds, "indexed": !fades, "bytes": bytes,
        });
        Ok(Figures { line, json })
    }

    /// Writes a stream. A closed pipe ends it, and does not count as a failure.
    fn write_stream(
        &self,
        progress: &ProgressBar,
        draw: impl Fn(u32) -> Result<Frame, Failure> + Sync + Send,
    ) -> Result<(), Failure> {
        let mut out = std::io::stdout().lock();
        let mut nobody_reads = false;
        let make = |before: Option<&Frame>, frame: &Frame, _: &Palette| {
            let picture = frame.picture();
            let mut bytes = Vec::new();
            if before.is_none() {
                bytes.extend(animation::y4m_header(&picture, self.scale, self.rate.fraction())?.into_bytes());
            }
            bytes.extend(animation::y4m_frame(&picture, self.scale)?);
            Ok(bytes)
        };
        let result = self.each(progress, draw, make, |bytes: Vec<u8>| {
            out.write_all(&bytes).and_then(|()| out.flush()).map_err(|error| {
                nobody_reads = error.kind() == ErrorKind::BrokenPipe;
                output::not_printed(error)
            })
        });
        if nobody_reads { Ok(()) } else { result }
    }

    /// The number of bytes that a frame takes at most, drawn and encoded: a stream has three bytes per enlarged pixel.
    fn most_bytes(&self) -> u64 {
        let (width, height) = self.size;
        let (wide, high) = self.scale.size(width as usize, height as usize);
        u64::from(width) * u64::from(height) + 3 * wide as u64 * high as u64
    }

    /// The number of frames drawn at a time: several for each thread (of which there are at most 1,024), as some frames
    /// are slower than others, but not more than fit in [`BATCH_BYTES`].
    fn batch(&self, threads: u32) -> u32 {
        // Below 2³².
        (16 * threads).min(256).min((BATCH_BYTES / self.most_bytes()) as u32).max(threads)
    }

    /// Draws the frames, has `make` encode each from itself, the frame before it and the first frame's colours, and
    /// passes the results to `add` in order. While one batch is encoded and added, the next is drawn; no other frames
    /// are in memory.
    fn each<Made: Send>(
        &self,
        progress: &ProgressBar,
        draw: impl Fn(u32) -> Result<Frame, Failure> + Sync + Send,
        make: impl Fn(Option<&Frame>, &Frame, &Palette) -> Result<Made, AnimationError> + Sync,
        mut add: impl FnMut(Made) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let draw_all =
            |numbers: Range<u32>| -> Result<Vec<Frame>, Failure> { numbers.into_par_iter().map(&draw).collect() };
        let batch = self.batch(rayon::current_num_threads() as u32);
        let batch_from = |first: u32| first.min(self.frames)..(first + batch).min(self.frames);
        let mut drawn = draw_all(batch_from(0))?;
        let colors = drawn.first().map(|first| first.palette.clone()).unwrap_or_default();
        let mut last: Option<Frame> = None;
        for first in (0..self.frames).step_by(batch as usize) {
            let make = |(i, frame): (usize, &Frame)| {
                go_on()?;
                let before = i.checked_sub(1).map_or(last.as_ref(), |before| drawn.get(before));
                make(before, frame, &colors).map_err(|error| Failure::words(format!("{}: {error}", self.out.display())))
            };
            let make_all =
                || -> Result<Vec<Made>, Failure> { drawn.par_iter().enumerate().map(make).collect::<Result<_, _>>() };
            let (made, following) = rayon::join(make_all, || draw_all(batch_from(first + batch)));
            for made in made? {
                go_on()?;
                add(made)?;
                progress.inc(1);
            }
            last = drawn.pop();
            drawn = following?;
        }
        Ok(())
    }

    /// Figures of a GIF.
    fn figures(&self, film: &animation::Film) -> Figures {
        let animation::Film { width, height, frames, images, delays, bytes, .. } = film;
        let json = json!({
            "width": width, "height": height, "frames": frames, "seconds": film.seconds(), "indexed": true,
            "bytes": bytes, "images": images, "images_by_centiseconds": delays,
        });
        let in_images = match images == frames {
            true => String::new(),
            false => format!(" in {}", output::counted(*images, "image")),
        };
        let delays: Vec<String> =
            delays.iter().rev().map(|(delay, images)| format!("{images} x {} ms", 10 * u32::from(*delay))).collect();
        let line = format!(
            "{}: {width} x {height} pixels, {}{in_images}, {:.2} s, delays {}, {bytes} bytes\n",
            on_one_line(&self.out.to_string_lossy()),
            output::counted(*frames, "frame"),
            film.seconds(),
            delays.join(" + "),
        );
        Figures { line, json }
    }
}

/// An error if the program has been told to end. Nobody sees it, because [`output::long_file`] does not return then.
fn go_on() -> Result<(), Failure> {
    if output::is_interrupted() { Err(Failure::work("interrupted")) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_frames_are_drawn_few_at_a_time() {
        let film = |size, scale| Film::new(Kind::Stream, Path::new("-"), None, FrameRate::default(), (size, scale));
        for (size, scale, batches) in [
            (None, None, [16, 256, 1_024]),
            (Some((4_096, 4_096)), None, [4, 16, 1_024]),
            (None, Some(Scale::To { width: 16_384, height: 16_384 }), [1, 16, 1_024]),
        ] {
            assert_eq!([1, 16, 1_024].map(|threads| film(size, scale).batch(threads)), batches, "{size:?}");
        }
    }
}
