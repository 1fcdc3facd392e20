//! GIF films, written frame by frame: each frame cropped to what it changes, with a palette of its own only where the
//! colours that it uses are not the first frame's.
//!
//! A frame that changes nothing is not written: the one before it stays longer. (A frame of one pixel would keep the time
//! as well, at 25 bytes and one more image for every reader.) How long a frame stays is therefore known only when the next
//! change comes, so the last one is held back until then.

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt;
use std::io::{self, Write};

use gif::{Encoder, EncodingError, Frame, Repeat};

use super::scale::Scaled;
use super::{FrameRate, Picture, PictureError, PixelShape, Scale};
use crate::palette::Rgb;

/// A film that goes round for ever, as a GIF, written to `W` while its frames are given.
///
/// It keeps one frame, and what of it is to be written, and the same of the next while that is added: a film may be of
/// any length. GIF knows square pixels only: a mode 13h frame has its shape at [`Scale::FiveBySix`] or 640 × 480.
///
/// ```
/// use mode13h::export::{FrameRate, GifWriter, Picture, Scale};
/// use mode13h::vga::Vga;
///
/// let mut vga = Vga::new();
/// let mut film = GifWriter::new(Vec::new(), Scale::To { width: 640, height: 480 }, FrameRate::default());
/// for x in 0..70 {
///     vga.pixels_mut()[100 * 320 + x] = 15;
///     film.add(&Picture::mode_13h(vga.pixels(), &vga.palette()))?;
/// }
/// let (bytes, film) = film.finish()?;
/// assert_eq!((film.width, film.height, film.frames, film.seconds()), (640, 480, 70, 2.0));
/// assert_eq!(bytes.len() as u64, film.bytes);
/// # Ok::<(), mode13h::export::GifError>(())
/// ```
pub struct GifWriter<W: Write> {
    scale: Scale,
    rate: FrameRate,
    out: Out<W>,
    held: Option<Held>,
    film: Film,
}

/// What was written of a film.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Film {
    /// Pixels in a row.
    pub width: u16,
    /// Rows.
    pub height: u16,
    /// The frames that were given.
    pub frames: u64,
    /// The images in the file: the frames but those that change nothing.
    pub images: u64,
    /// How many images stay for so many hundredths of a second.
    pub delays: BTreeMap<u16, u64>,
    /// The length of the file, in bytes.
    pub bytes: u64,
}

impl Film {
    /// How long one round of the film takes, in seconds.
    pub fn seconds(&self) -> f64 {
        let hundredths: u64 = self.delays.iter().map(|(&delay, &images)| u64::from(delay) * images).sum();
        hundredths as f64 / 100.0
    }
}

impl<W: Write> GifWriter<W> {
    /// A film of no frames yet. Nothing is written before the second frame or [`finish`](Self::finish).
    pub fn new(out: W, scale: Scale, rate: FrameRate) -> GifWriter<W> {
        GifWriter { scale, rate, out: Out::Unopened(out), held: None, film: Film::default() }
    }

    /// Adds a frame. Its bytes and colours are what it shows: the shape of its pixels is not heeded.
    ///
    /// # Errors
    ///
    /// [`GifError::Picture`] if its sizes do not fit its bytes, or are not those of the first frame, or are too large
    /// when enlarged: the film can then go on without it. [`GifError::Io`] if writing failed: the film cannot go on.
    pub fn add(&mut self, picture: &Picture<'_>) -> Result<(), GifError> {
        self.out.check()?;
        let scaled = Scaled::new(picture, self.scale)?;
        let delay = self.rate.delay(self.film.frames);
        let area = match &mut self.held {
            None => Area::whole(&scaled),
            Some(held) => match (held.changed_by(&scaled)?, held.delay.checked_add(delay)) {
                (Some(area), _) => area,
                (None, Some(sum)) => {
                    held.delay = sum;
                    self.film.frames += 1;
                    return Ok(());
                }
                // No image stays longer than 655.35 s: another begins, which draws one pixel as it was.
                (None, None) => Area::FIRST_PIXEL,
            },
        };
        let next = Held::new(&scaled, area, delay)?;
        self.write_held()?;
        // All sides are at most MAX_SIDE, 16,384.
        (self.film.width, self.film.height) = (scaled.width as u16, scaled.height as u16);
        self.held = Some(next);
        self.film.frames += 1;
        Ok(())
    }

    /// Writes what is left, and gives back what was written to, not flushed, and how much it was.
    ///
    /// # Errors
    ///
    /// [`GifError::NoFrames`] if there was no frame; [`GifError::Io`] if writing fails or failed before.
    pub fn finish(mut self) -> Result<(W, Film), GifError> {
        self.out.check()?;
        self.write_held()?;
        match self.out {
            Out::Open(Open { encoder, .. }) => {
                let Counted { out, bytes } = encoder.into_inner().map_err(reason)?;
                self.film.bytes = bytes;
                Ok((out, self.film))
            }
            Out::Failed(kind) => Err(GifError::Io(kind.into())),
            Out::Unopened(_) => Err(GifError::NoFrames),
        }
    }

    /// Writes the frame that is held, if there is one.
    fn write_held(&mut self) -> Result<(), GifError> {
        let Some(Held { palette, part, area, delay, .. }) = self.held.take() else { return Ok(()) };
        self.film.images += 1;
        *self.film.delays.entry(delay).or_default() += 1;
        self.out.write((self.film.width, self.film.height), &palette, |global| Frame {
            delay,
            // Within the film, whose sides are at most 16,384.
            left: area.left as u16,
            top: area.top as u16,
            width: (area.right - area.left) as u16,
            height: (area.bottom - area.top) as u16,
            palette: shows_otherwise(&part, &palette, global).then(|| table(&palette)),
            buffer: part.into(),
            ..Frame::default()
        })
    }
}

/// Whether any of these pixels has another colour in one palette than in the other.
fn shows_otherwise(pixels: &[u8], palette: &[Rgb; 256], other: &[Rgb; 256]) -> bool {
    palette != other && pixels.iter().any(|&pixel| palette[usize::from(pixel)] != other[usize::from(pixel)])
}

/// A colour table of GIF: red, green and blue of each entry.
fn table(palette: &[Rgb; 256]) -> Vec<u8> {
    palette.iter().flat_map(|color| [color.r, color.g, color.b]).collect()
}

/// A rectangle of the film, in its pixels: from `left` and `top` to before `right` and `bottom`.
#[derive(Clone, Copy)]
struct Area {
    left: usize,
    top: usize,
    right: usize,
    bottom: usize,
}

impl Area {
    const FIRST_PIXEL: Area = Area { left: 0, top: 0, right: 1, bottom: 1 };

    fn whole(scaled: &Scaled<'_>) -> Area {
        Area { left: 0, top: 0, right: scaled.width as usize, bottom: scaled.height as usize }
    }

    /// The least that holds this one, if there is one, and a row from `left` to before `right`.
    fn with_row(area: Option<Area>, y: usize, left: usize, right: usize) -> Area {
        match area {
            Some(area) => {
                Area { left: area.left.min(left), top: area.top, right: area.right.max(right), bottom: y + 1 }
            }
            None => Area { left, top: y, right, bottom: y + 1 },
        }
    }
}

/// The last frame that changed something. It is what the film shows.
struct Held {
    /// As they were given, without gaps between the rows.
    pixels: Vec<u8>,
    width: usize,
    height: usize,
    palette: [Rgb; 256],
    /// What it changed, and what is to be seen there: palette indices, row by row.
    area: Area,
    part: Vec<u8>,
    /// In 1/100 s, so far.
    delay: u16,
}

impl Held {
    fn new(scaled: &Scaled<'_>, area: Area, delay: u16) -> Result<Held, PictureError> {
        let (picture, ..) = scaled.sources();
        let &Picture { width, height, palette, .. } = picture;
        // The picture has been checked: so many are there.
        let bytes = width * height;
        let mut pixels = Vec::new();
        pixels.try_reserve_exact(bytes).map_err(|_| PictureError::Memory { bytes })?;
        (0..height).for_each(|y| pixels.extend_from_slice(picture.row(y)));
        let part = scaled.part(area.left..area.right, area.top..area.bottom)?;
        Ok(Held { pixels, width, height, palette: *palette, area, part, delay })
    }

    fn picture(&self) -> Picture<'_> {
        let Held { pixels, width, height, palette, .. } = self;
        Picture { pixels, width: *width, height: *height, pitch: *width, palette, shape: PixelShape::SQUARE }
    }

    /// What of the film the frame `now` changes: the least rectangle with all pixels that it shows in another colour,
    /// whether the index or the palette is the reason; nothing if there is none. An index that stands for the same
    /// colour as before changes nothing.
    fn changed_by(&self, now: &Scaled<'_>) -> Result<Option<Area>, PictureError> {
        let (picture, columns, rows) = now.sources();
        let (first, size) = ((self.width, self.height), (picture.width, picture.height));
        if first != size {
            return Err(PictureError::OtherSize { first, now: size });
        }
        let before = self.picture();
        let same_palette = before.palette == picture.palette;
        let changed = |y: usize| {
            let (old, new) = (before.row(y), picture.row(y));
            if same_palette && old == new {
                return None;
            }
            let differs = |&x: &usize| before.palette[usize::from(old[x])] != picture.palette[usize::from(new[x])];
            let left = columns.iter().position(differs)?;
            let right = columns.iter().rposition(differs)? + 1;
            Some((left, right))
        };
        let mut area = None;
        // Rows of the film that are one row of the frame are compared once.
        let mut last = None;
        for (y, &row) in rows.iter().enumerate() {
            let ends = match last {
                Some((of, ends)) if of == row => ends,
                _ => changed(row),
            };
            last = Some((row, ends));
            if let Some((left, right)) = ends {
                area = Some(Area::with_row(area, y, left, right));
            }
        }
        Ok(area)
    }
}

/// What the film is written to.
enum Out<W: Write> {
    /// Nothing is written yet: the first frame says how large the film is, and its colours are the film's.
    Unopened(W),
    Open(Open<W>),
    /// Writing failed so.
    Failed(io::ErrorKind),
}

struct Open<W: Write> {
    encoder: Encoder<Counted<W>>,
    /// The colours of images without a palette of their own.
    palette: Box<[Rgb; 256]>,
}

impl<W: Write> Out<W> {
    fn check(&self) -> Result<(), GifError> {
        match self {
            Out::Failed(kind) => Err(GifError::Io((*kind).into())),
            _ => Ok(()),
        }
    }

    /// Writes the image that is made for the film's palette; what stands before the first, too.
    fn write<'a>(
        &mut self,
        (width, height): (u16, u16),
        palette: &[Rgb; 256],
        image: impl FnOnce(&[Rgb; 256]) -> Frame<'a>,
    ) -> Result<(), GifError> {
        // Should this fail, the file ends amid an image, and nothing may follow.
        let out = std::mem::replace(self, Out::Failed(io::ErrorKind::Other));
        let written = out.opened(width, height, palette).and_then(|mut open| {
            open.encoder.write_frame(&image(&open.palette))?;
            Ok(open)
        });
        match written.map_err(reason) {
            Ok(open) => {
                *self = Out::Open(open);
                Ok(())
            }
            Err(error) => {
                *self = Out::Failed(error.kind());
                Err(error.into())
            }
        }
    }

    fn opened(self, width: u16, height: u16, palette: &[Rgb; 256]) -> Result<Open<W>, EncodingError> {
        match self {
            Out::Unopened(out) => {
                let mut encoder = Encoder::new(Counted { out, bytes: 0 }, width, height, &table(palette))?;
                encoder.set_repeat(Repeat::Infinite)?;
                Ok(Open { encoder, palette: Box::new(*palette) })
            }
            Out::Open(open) => Ok(open),
            Out::Failed(kind) => Err(io::Error::from(kind).into()),
        }
    }
}

/// Counts the bytes.
struct Counted<W: Write> {
    out: W,
    bytes: u64,
}

impl<W: Write> Write for Counted<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        self.bytes += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// What the disk said. All else that the encoder refuses, a palette of no or too many colours or a frame that is too
/// short, is not given to it.
fn reason(error: EncodingError) -> io::Error {
    match error {
        EncodingError::Io(error) => error,
        other => io::Error::other(other),
    }
}

/// Why a film was not written.
#[derive(Debug)]
#[non_exhaustive]
pub enum GifError {
    /// A frame cannot be part of the film.
    Picture(PictureError),
    /// The film has no frame.
    NoFrames,
    /// Writing failed.
    Io(io::Error),
}

impl fmt::Display for GifError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            GifError::Picture(error) => write!(f, "{error}"),
            GifError::NoFrames => f.write_str("a film without a frame"),
            GifError::Io(error) => write!(f, "{error}"),
        }
    }
}

impl Error for GifError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            GifError::Picture(error) => Some(error),
            GifError::NoFrames => None,
            GifError::Io(error) => Some(error),
        }
    }
}

impl From<PictureError> for GifError {
    fn from(error: PictureError) -> GifError {
        GifError::Picture(error)
    }
}

impl From<io::Error> for GifError {
    fn from(error: io::Error) -> GifError {
        GifError::Io(error)
    }
}
