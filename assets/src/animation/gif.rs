//! GIF animations, written frame by frame: each frame is cropped to what it changes, with transparent pixels where that
//! is shorter. A frame has a palette of its own only if the first frame's lacks a colour that it uses. Indices of equal
//! colours are merged.
//!
//! A frame that changes nothing is not written: the one before it stays longer. (A frame of one pixel would keep the
//! timing as well, at 25 bytes and one more image for every reader.) A frame's delay is therefore only known at the
//! next change, so the last frame is held back until then.
//!
//! Nearly all the time goes into making each [`GifFrame`] from the one before it: several can be made at a time.

use std::collections::BTreeMap;
use std::io::{self, Write};

use gif::{Encoder, EncodingError, Frame, Repeat};
use mode13h::export::{Picture, Scale};
use mode13h::palette::Rgb;

use super::color_table::ColorTable;
use super::gif_frame::{GifFrame, Image};
use super::{AnimationError, AnimationErrorKind, FrameRate};

/// A looping GIF animation, written to `W` while its frames are added.
///
/// The writer holds one frame and its compressed image, and the next while it is being added, so an animation may have
/// any length. GIF only has square pixels: a mode 13h frame has its aspect ratio at [`Scale::FiveBySix`] or 640 × 480.
///
/// ```
/// use mode13h::export::{Picture, Scale};
/// use mode13h_assets::animation::{FrameRate, GifWriter};
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
/// # Ok::<(), mode13h_assets::animation::AnimationError>(())
/// ```
pub struct GifWriter<W: Write> {
    scale: Scale,
    rate: FrameRate,
    out: Out<W>,
    /// The colours of images without a palette of their own: the first frame's.
    palette: Box<[Rgb; 256]>,
    held: Option<Held>,
    film: Film,
}

/// Counts of a finished animation.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Film {
    /// The width in pixels.
    pub width: u16,
    /// The height in pixels.
    pub height: u16,
    /// The number of frames added.
    pub frames: u64,
    /// The number of images in the file: the frames without those that change nothing.
    pub images: u64,
    /// The number of images for each delay, in hundredths of a second.
    pub delays: BTreeMap<u16, u64>,
    /// The length of the file, in bytes.
    pub bytes: u64,
}

impl Film {
    /// The length of one loop of the animation, in seconds.
    pub fn seconds(&self) -> f64 {
        let hundredths: u64 = self.delays.iter().map(|(&delay, &images)| u64::from(delay) * images).sum();
        hundredths as f64 / 100.0
    }
}

impl<W: Write> GifWriter<W> {
    /// Begins an animation without frames so far. Nothing is written before the second frame or
    /// [`finish`](Self::finish).
    pub fn new(out: W, scale: Scale, rate: FrameRate) -> GifWriter<W> {
        let palette = Box::new([Rgb::BLACK; 256]);
        GifWriter { scale, rate, out: Out::Unopened(out), palette, held: None, film: Film::default() }
    }

    /// Adds a frame from its bytes and colours. The shape of its pixels is ignored.
    ///
    /// # Errors
    ///
    /// [`AnimationErrorKind::Picture`] if its sizes do not fit its bytes or are too large when enlarged, and
    /// [`AnimationErrorKind::OtherSize`] if they are not those of the first frame: the animation can then go on without
    /// it. [`AnimationErrorKind::Io`] if writing failed: the animation cannot go on.
    pub fn add(&mut self, picture: &Picture<'_>) -> Result<(), AnimationError> {
        self.out.check()?;
        let frame = match &self.held {
            None => GifFrame::first(picture, self.scale)?,
            Some(held) => GifFrame::after(&held.frame.picture(), picture, self.scale, &self.palette)?,
        };
        self.add_frame(frame)
    }

    /// Adds a prepared frame: the first from [`GifFrame::first`], each other from [`GifFrame::after`]. Each must be
    /// made from the frame that was added before it, with this animation's scale and the colours of its first frame. A
    /// frame made from a different one shows the remains of that one.
    ///
    /// # Errors
    ///
    /// Those of [`add`](Self::add); also [`AnimationErrorKind::OtherSize`] if it was enlarged to another size than the
    /// first.
    pub fn add_frame(&mut self, frame: GifFrame) -> Result<(), AnimationError> {
        self.out.check()?;
        // There is no frame before it.
        let frame = match &self.held {
            None if !frame.is_whole() => GifFrame::first(&frame.picture(), self.scale)?,
            _ => frame,
        };
        let delay = self.rate.delay(self.film.frames);
        let image = match &mut self.held {
            None => {
                *self.palette = *frame.palette();
                (self.film.width, self.film.height) = frame.size();
                None
            }
            Some(held) => {
                let (first, now) = ((self.film.width, self.film.height), frame.size());
                if first != now {
                    let wide = |(width, height): (u16, u16)| (width.into(), height.into());
                    return Err(AnimationErrorKind::OtherSize { first: wide(first), now: wide(now) }.into());
                }
                match (frame.changes(), held.delay.checked_add(delay)) {
                    (true, _) => None,
                    (false, Some(sum)) => {
                        held.delay = sum;
                        self.film.frames += 1;
                        return Ok(());
                    }
                    // No image stays longer than 655.35 s; then another begins, which redraws one unchanged pixel.
                    (false, None) => Some(frame.first_pixel(self.scale, &self.palette)?),
                }
            }
        };
        self.write_held()?;
        self.held = Some(Held { frame, image, delay });
        self.film.frames += 1;
        Ok(())
    }

    /// Writes the rest, and returns the writer, not flushed, and the animation's counts.
    ///
    /// # Errors
    ///
    /// [`AnimationErrorKind::NoFrames`] if there was no frame; [`AnimationErrorKind::Io`] if writing fails or failed
    /// before.
    pub fn finish(mut self) -> Result<(W, Film), AnimationError> {
        self.out.check()?;
        self.write_held()?;
        match self.out {
            Out::Open(encoder) => {
                let Counted { out, bytes } = encoder.into_inner().map_err(reason)?;
                self.film.bytes = bytes;
                Ok((out, self.film))
            }
            Out::Failed(kind) => Err(io::Error::from(kind).into()),
            Out::Unopened(_) => Err(AnimationErrorKind::NoFrames.into()),
        }
    }

    /// Writes the held frame, if there is one.
    fn write_held(&mut self) -> Result<(), AnimationError> {
        let Some(Held { frame, image, delay }) = self.held.take() else { return Ok(()) };
        let Some(Image { area, palette, transparent, data }) = image.or_else(|| frame.into_image()) else {
            return Ok(());
        };
        self.film.images += 1;
        *self.film.delays.entry(delay).or_default() += 1;
        let frame = Frame {
            delay,
            // Within the animation, whose sides are at most 16,384.
            left: area.left as u16,
            top: area.top as u16,
            width: (area.right - area.left) as u16,
            height: (area.bottom - area.top) as u16,
            palette,
            transparent,
            buffer: data.into(),
            ..Frame::default()
        };
        self.out.write((self.film.width, self.film.height), &self.palette, &frame)
    }
}

/// The last frame that changed something, currently on display.
struct Held {
    frame: GifFrame,
    /// The image to write for it, if that is not its own.
    image: Option<Image>,
    /// Its delay so far, in 1/100 s.
    delay: u16,
}

/// The destination of the animation, by its state.
enum Out<W: Write> {
    /// Nothing is written yet: the first frame determines the size and the colours.
    Unopened(W),
    Open(Encoder<Counted<W>>),
    /// Writing failed with this error.
    Failed(io::ErrorKind),
}

impl<W: Write> Out<W> {
    fn check(&self) -> Result<(), AnimationError> {
        match self {
            Out::Failed(kind) => Err(io::Error::from(*kind).into()),
            _ => Ok(()),
        }
    }

    /// Writes a compressed image; before the first one, also the file's header.
    fn write(&mut self, size: (u16, u16), palette: &[Rgb; 256], image: &Frame<'_>) -> Result<(), AnimationError> {
        // If this fails, the file ends in the middle of an image, and nothing more may be written.
        let out = std::mem::replace(self, Out::Failed(io::ErrorKind::Other));
        let written = out.opened(size, palette).and_then(|mut encoder| {
            encoder.write_lzw_pre_encoded_frame(image)?;
            Ok(encoder)
        });
        match written.map_err(reason) {
            Ok(encoder) => {
                *self = Out::Open(encoder);
                Ok(())
            }
            Err(error) => {
                *self = Out::Failed(error.kind());
                Err(error.into())
            }
        }
    }

    fn opened(self, (width, height): (u16, u16), palette: &[Rgb; 256]) -> Result<Encoder<Counted<W>>, EncodingError> {
        match self {
            Out::Unopened(out) => {
                let mut encoder =
                    Encoder::new(Counted { out, bytes: 0 }, width, height, &ColorTable::of_all(palette).bytes())?;
                encoder.set_repeat(Repeat::Infinite)?;
                Ok(encoder)
            }
            Out::Open(encoder) => Ok(encoder),
            Out::Failed(kind) => Err(io::Error::from(kind).into()),
        }
    }
}

/// A writer that counts bytes.
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

/// The underlying I/O error. The encoder has no other reason to fail: it is never given an empty or oversized palette,
/// or a frame that is too short.
fn reason(error: EncodingError) -> io::Error {
    match error {
        EncodingError::Io(error) => error,
        other => io::Error::other(other),
    }
}
