//! Animated PNGs, written frame by frame: each frame is cropped to what it changes, with transparent pixels where that
//! is shorter, and its delay is the exact fraction of a second.
//!
//! The file states at its start how many frames there are, and which colours. So a frame that changes nothing is
//! written as one unchanged pixel, and an animation whose palette changes is written in true colour.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use mode13h::export::{AtomicFile, Picture, PictureError, Scale, Scaled};
use mode13h::palette::Rgb;
use png::{BitDepth, ColorType, Compression, Encoder, Filter};

use super::chunk::{chunks, write_chunk};
use super::color_table::ColorTable;
use super::difference::{Area, changed, kept};
use super::{AnimationError, AnimationErrorKind, FrameRate};

/// The colours of an animation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FilmColors {
    /// The colours of a palette that does not change: one byte per pixel.
    Palette(Box<[Rgb; 256]>),
    /// Any colours: red, green and blue of each pixel.
    True,
}

/// A frame of an [`ApngFile`], ready to be written. It depends only on the frame and the one before it, so several can
/// be made at a time, on any threads, and then added in order.
pub struct ApngFrame {
    /// The animation's size in pixels: width and height.
    size: (u32, u32),
    density: (u32, u32),
    colors: FilmColors,
    area: Area,
    /// True if transparent pixels show the frame before.
    blends: bool,
    /// The compressed rows.
    data: Vec<u8>,
}

impl ApngFrame {
    /// Makes a frame that follows `before`, or the first of its animation. Only the differences are written.
    ///
    /// # Errors
    ///
    /// Sizes that do not fit the bytes, differ from those of `before`, or are too large when enlarged; a colour that is
    /// not in the animation's palette; not enough memory.
    pub fn new(
        before: Option<&Picture<'_>>,
        picture: &Picture<'_>,
        scale: Scale,
        colors: &FilmColors,
    ) -> Result<ApngFrame, AnimationError> {
        let scaled = Scaled::new(picture, scale)?;
        let before = before.map(|before| Scaled::new(before, scale)).transpose()?;
        let area = match &before {
            None => Area::whole(&scaled),
            Some(before) => changed(before.sources().0, &scaled)?.unwrap_or(Area::FIRST_PIXEL),
        };
        let (columns, rows) = (area.left..area.right, area.top..area.bottom);
        let mut pixels = scaled.part(columns.clone(), rows.clone())?;
        let (size, density) = ((scaled.width, scaled.height), scaled.density());
        let sides = (columns.len() as u32, rows.len() as u32);
        let FilmColors::Palette(palette) = colors else {
            let bytes = pixels.len() * 3;
            let mut channels = Vec::new();
            channels.try_reserve_exact(bytes).map_err(|_| PictureError::Memory { bytes })?;
            channels.extend(pixels.iter().flat_map(|&index| {
                let Rgb { r, g, b } = picture.palette[usize::from(index)];
                [r, g, b]
            }));
            let data = compressed(sides, ColorType::Rgb, &channels, Filter::Adaptive)?;
            return Ok(ApngFrame { size, density, colors: FilmColors::True, area, blends: false, data });
        };
        let kept: Vec<bool> = match &before {
            None => Vec::new(),
            Some(before) => {
                let was = before.part(columns, rows)?;
                kept(before.sources().0, &was, picture, &pixels).collect()
            }
        };
        let table = ColorTable::of_all(palette);
        let places = table.places(picture.palette, &pixels).ok_or(AnimationErrorKind::OtherColors)?;
        pixels.iter_mut().for_each(|index| *index = places[usize::from(*index)]);
        // Neighbours in a ramp are neighbours in the palette, so a filter's prediction is close.
        let mut best = (compressed(sides, ColorType::Indexed, &pixels, Filter::Adaptive)?, false);
        let mut keep_better = |data: Vec<u8>, blends: bool| {
            if data.len() < best.0.len() {
                best = (data, blends);
            }
        };
        keep_better(compressed(sides, ColorType::Indexed, &pixels, Filter::NoFilter)?, false);
        if let (Some(spare), true) = (table.spare(), kept.contains(&true)) {
            pixels.iter_mut().zip(&kept).filter(|(_, kept)| **kept).for_each(|(pixel, _)| *pixel = spare);
            keep_better(compressed(sides, ColorType::Indexed, &pixels, Filter::NoFilter)?, true);
        }
        let (data, blends) = best;
        Ok(ApngFrame { size, density, colors: colors.clone(), area, blends, data })
    }
}

/// The rows of a picture, filtered and compressed as in PNG: the contents of its data chunks.
fn compressed(
    (width, height): (u32, u32),
    color: ColorType,
    pixels: &[u8],
    filter: Filter,
) -> Result<Vec<u8>, PictureError> {
    let encode = || -> Result<Vec<u8>, png::EncodingError> {
        let mut file = Vec::new();
        let mut encoder = Encoder::new(&mut file, width, height);
        encoder.set_color(color);
        encoder.set_depth(BitDepth::Eight);
        if color == ColorType::Indexed {
            // A dummy: the animation has its own.
            encoder.set_palette(vec![0; 768]);
        }
        encoder.set_compression(Compression::Balanced);
        encoder.set_filter(filter);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(pixels)?;
        writer.finish()?;
        Ok(file)
    };
    // The sizes agree, and writing to a vector only fails for lack of memory.
    let file = encode().map_err(|_| PictureError::Memory { bytes: pixels.len() })?;
    Ok(chunks(&file).filter(|(name, _)| name == b"IDAT").flat_map(|(_, data)| data).copied().collect())
}

/// An animated PNG that loops for ever, as a file that is either complete or absent.
///
/// ```
/// use mode13h::export::{Picture, Scale};
/// use mode13h_assets::animation::{ApngFile, ApngFrame, FilmColors, FrameRate};
/// use mode13h::palette::builtin::GREY;
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("film.apng");
/// let (dark, light) = ([0; 64_000], [255; 64_000]);
/// let (dark, light) = (Picture::mode_13h(&dark, &GREY), Picture::mode_13h(&light, &GREY));
/// let (scale, colors) = (Scale::One, FilmColors::Palette(Box::new(*GREY.colors())));
/// let mut film = ApngFile::create(&path, FrameRate::default(), 2)?;
/// film.add(&ApngFrame::new(None, &dark, scale, &colors)?)?;
/// film.add(&ApngFrame::new(Some(&dark), &light, scale, &colors)?)?;
/// assert_eq!(film.finish()?, std::fs::metadata(&path)?.len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct ApngFile {
    path: PathBuf,
    film: Writer<AtomicFile>,
}

impl ApngFile {
    /// Begins an animation with a given number of frames, in the file `path`.
    ///
    /// # Errors
    ///
    /// [`AnimationError`] if no file can be written there, for the reasons given at
    /// [`write_atomically`](mode13h::export::write_atomically).
    pub fn create(path: impl AsRef<Path>, rate: FrameRate, frames: u32) -> Result<ApngFile, AnimationError> {
        let path = path.as_ref();
        let out = AtomicFile::create(path)?;
        let film = Writer { out, rate, frames, given: 0, sequence: 0, first: None, bytes: 0, failed: None };
        Ok(ApngFile { path: path.to_path_buf(), film })
    }

    /// Adds a frame that was made from the frame added before it.
    ///
    /// # Errors
    ///
    /// [`AnimationErrorKind::OtherSize`] or [`AnimationErrorKind::OtherColors`] if this frame's size or [`FilmColors`]
    /// differ from the first frame's; the animation can go on without it. [`AnimationErrorKind::FrameCount`] if it is
    /// one too many; any other if writing failed and the animation cannot go on.
    pub fn add(&mut self, frame: &ApngFrame) -> Result<(), AnimationError> {
        self.film.add(frame).map_err(|error| error.in_file(&self.path))
    }

    /// Ends the animation and renames the file. Returns the number of bytes.
    ///
    /// # Errors
    ///
    /// [`AnimationErrorKind::NoFrames`] if none were promised; [`AnimationErrorKind::FrameCount`] if frames are
    /// missing; any other if writing fails or failed before. The file is then removed.
    pub fn finish(self) -> Result<u64, AnimationError> {
        let ApngFile { path, film } = self;
        let (file, bytes) = film.finish().map_err(|error| error.in_file(&path))?;
        file.commit()?;
        Ok(bytes)
    }
}

/// The writer of the animation's chunks.
struct Writer<W> {
    out: W,
    rate: FrameRate,
    /// The number of frames that the file's header promises.
    frames: u32,
    given: u32,
    /// The sequence number of a frame's next chunk.
    sequence: u32,
    /// The first frame's size and colours.
    first: Option<((u32, u32), FilmColors)>,
    bytes: u64,
    /// Set once writing has failed, perhaps in the middle of a chunk: nothing more may be written.
    failed: Option<io::ErrorKind>,
}

impl<W: Write> Writer<W> {
    fn add(&mut self, frame: &ApngFrame) -> Result<(), AnimationError> {
        if let Some(kind) = self.failed {
            return Err(io::Error::from(kind).into());
        }
        if self.given == self.frames {
            let given = self.given.saturating_add(1);
            return Err(AnimationErrorKind::FrameCount { promised: self.frames, given }.into());
        }
        if let Some((size, colors)) = &self.first {
            let wide = |(width, height): (u32, u32)| (width as usize, height as usize);
            if *size != frame.size {
                return Err(AnimationErrorKind::OtherSize { first: wide(*size), now: wide(frame.size) }.into());
            }
            if *colors != frame.colors {
                return Err(AnimationErrorKind::OtherColors.into());
            }
        }
        let result = self.write(frame);
        result.map_err(|error| {
            self.failed = Some(error.kind());
            error.into()
        })
    }

    fn write(&mut self, frame: &ApngFrame) -> io::Result<()> {
        let ApngFrame { area, blends, data, .. } = frame;
        let is_first = self.first.is_none();
        if is_first {
            self.write_head(frame)?;
        }
        let (above, below) = self.rate.fraction();
        let [width, height, left, top] = [area.right - area.left, area.bottom - area.top, area.left, area.top]
            .map(|side| (side as u32).to_be_bytes());
        let sequence = self.next();
        // The next frame is drawn over this one.
        let ends = [0, u8::from(*blends)];
        let control: [&[u8]; 8] =
            [&sequence, &width, &height, &left, &top, &below.to_be_bytes(), &above.to_be_bytes(), &ends];
        self.chunk(*b"fcTL", &control)?;
        if is_first {
            self.chunk(*b"IDAT", &[data])?;
        } else {
            let sequence = self.next();
            self.chunk(*b"fdAT", &[&sequence, data])?;
        }
        self.given += 1;
        Ok(())
    }

    /// Writes the chunks before the first frame.
    fn write_head(&mut self, first: &ApngFrame) -> io::Result<()> {
        const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
        self.out.write_all(SIGNATURE)?;
        self.bytes += SIGNATURE.len() as u64;
        let (width, height) = first.size;
        self.first = Some((first.size, first.colors.clone()));
        let table = match &first.colors {
            FilmColors::Palette(palette) => Some(ColorTable::of_all(palette)),
            FilmColors::True => None,
        };
        // 8 bits; palette or three channels; the only defined compression, filters and order.
        let kind = [8, if table.is_some() { 3 } else { 2 }, 0, 0, 0];
        self.chunk(*b"IHDR", &[&width.to_be_bytes(), &height.to_be_bytes(), &kind])?;
        let (across, down) = first.density;
        self.chunk(*b"pHYs", &[&across.to_be_bytes(), &down.to_be_bytes(), &[0]])?;
        // Loops for ever.
        let frames = self.frames.to_be_bytes();
        self.chunk(*b"acTL", &[&frames, &[0; 4]])?;
        if let Some(table) = table {
            self.chunk(*b"PLTE", &[&table.bytes()])?;
            if let Some(spare) = table.spare() {
                let mut opacity = vec![u8::MAX; usize::from(spare)];
                opacity.push(0);
                self.chunk(*b"tRNS", &[&opacity])?;
            }
        }
        Ok(())
    }

    fn finish(mut self) -> Result<(W, u64), AnimationError> {
        if let Some(kind) = self.failed {
            return Err(io::Error::from(kind).into());
        }
        if self.frames == 0 {
            return Err(AnimationErrorKind::NoFrames.into());
        }
        if self.given != self.frames {
            return Err(AnimationErrorKind::FrameCount { promised: self.frames, given: self.given }.into());
        }
        self.chunk(*b"IEND", &[])?;
        Ok((self.out, self.bytes))
    }

    fn next(&mut self) -> [u8; 4] {
        let sequence = self.sequence;
        // Two for each frame except the first: at most 2³², more frames than anyone adds.
        self.sequence = sequence.wrapping_add(1);
        sequence.to_be_bytes()
    }

    fn chunk(&mut self, name: [u8; 4], parts: &[&[u8]]) -> io::Result<()> {
        self.bytes += write_chunk(&mut self.out, name, parts)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests;
