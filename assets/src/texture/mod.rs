//! Textures from picture files.
//!
//! Indexed pictures keep their indices and palette if their size is valid for a texture.

mod aseprite;
mod gif;
mod indexed;
mod pcx;

use core::fmt;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek};
use std::path::{Path, PathBuf};

use mode13h::palette::Rgb;
use mode13h::texture::{Texture, TextureError};
use png::{BitDepth, ColorType, Decoder, DecodingError, Info, Limits, Transformations};

use crate::errors::clause;
use indexed::Indexed;

/// The first bytes of a PNG.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

/// The maximum memory for reading a picture: 4,096 × 4,096 pixels of four 16-bit samples.
const MAX_BYTES: usize = 4_096 * 4_096 * 8;

/// The reason why a file gives no texture.
#[non_exhaustive]
pub struct LoadError {
    /// The file.
    pub path: PathBuf,
    /// The kind of the error.
    pub kind: LoadErrorKind,
}

/// The kinds of errors of a texture's file.
#[derive(Debug)]
#[non_exhaustive]
pub enum LoadErrorKind {
    /// The file cannot be read.
    Read(io::Error),
    /// The path is that of a directory, a device or similar.
    NotAFile,
    /// The file is not a picture in a supported format, or a broken one.
    Picture(String),
    /// The picture is too large.
    Texture(TextureError),
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path.display(), self.kind)
    }
}

impl fmt::Display for LoadErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read(error) => write!(f, "{error}"),
            Self::NotAFile => f.write_str("not a file"),
            Self::Picture(reason) => write!(f, "not a picture that can be read: {reason}"),
            Self::Texture(error) => write!(f, "{error}"),
        }
    }
}

crate::errors::debug_as_display!(LoadError);

impl core::error::Error for LoadError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match &self.kind {
            LoadErrorKind::Read(error) => Some(error),
            LoadErrorKind::Texture(error) => Some(error),
            LoadErrorKind::NotAFile | LoadErrorKind::Picture(_) => None,
        }
    }
}

/// A loaded texture.
pub struct Decoded {
    /// The texture.
    pub texture: Texture,
    /// True if some pixel of the picture was not opaque; the texture is opaque.
    pub was_transparent: bool,
    /// The palette of an indexed picture, whatever its size.
    pub palette: Option<[Rgb; 256]>,
}

impl Decoded {
    /// A line that says what was ignored in this file, if anything was.
    #[must_use]
    pub fn warning(&self, path: &Path) -> Option<String> {
        self.was_transparent.then(|| std::format!("{}: transparency ignored", path.display()))
    }
}

/// Reads a PNG, GIF, PCX with 256 colours or an indexed Aseprite sprite, with the feature `images` also a JPEG, TGA,
/// BMP or WebP, and makes a texture from it like [`Texture::from_rgb`]. The format is recognised by the contents, not
/// the name. Grey becomes RGB, 16 bits become 8, and transparency is ignored. The first frame of animations and sprites
/// is read. An indexed picture whose sides are powers of two up to 256 keeps its indices and colours.
///
/// # Errors
/// A file that cannot be read, is not such a picture, is broken, or has a side above 4,096.
pub fn load(path: impl AsRef<Path>) -> Result<Texture, LoadError> {
    load_decoded(path.as_ref()).map(|decoded| decoded.texture)
}

/// Reads a picture like [`load`], and reports what was ignored.
///
/// # Errors
/// Those of [`load`].
pub fn load_decoded(path: &Path) -> Result<Decoded, LoadError> {
    read(path).map_err(|kind| LoadError { path: path.to_owned(), kind })
}

fn read(path: &Path) -> Result<Decoded, LoadErrorKind> {
    let file = File::open(path).map_err(LoadErrorKind::Read)?;
    // A model might name a device that never ends.
    if !file.metadata().map_err(LoadErrorKind::Read)?.is_file() {
        return Err(LoadErrorKind::NotAFile);
    }
    decode_all(BufReader::new(file))
}

/// Reads a picture from memory or any other source, and makes a texture from it like [`load`].
///
/// # Errors
/// Those of [`load`].
pub fn decode(file: impl BufRead + Seek) -> Result<Texture, LoadErrorKind> {
    decode_all(file).map(|decoded| decoded.texture)
}

/// Reads a picture like [`decode`], and reports what was ignored.
///
/// # Errors
/// Those of [`load`].
pub fn decode_all(mut file: impl BufRead + Seek) -> Result<Decoded, LoadErrorKind> {
    decode_any(&mut file)
}

/// Any source. One type, so that the decoders are compiled once.
trait Source: BufRead + Seek {}

impl<T: BufRead + Seek> Source for T {}

fn decode_any(file: &mut dyn Source) -> Result<Decoded, LoadErrorKind> {
    let head = file.fill_buf().map_err(LoadErrorKind::Read)?;
    if head.starts_with(PNG) {
        return decode_png(file);
    }
    if gif::recognizes(head) {
        return gif::decode(file)?.into_decoded();
    }
    type Whole = fn(&[u8]) -> Result<Indexed, LoadErrorKind>;
    let whole: Option<Whole> = match head {
        head if aseprite::recognizes(head) => Some(aseprite::decode),
        head if pcx::recognizes(head) => Some(pcx::decode),
        _ => None,
    };
    if let Some(decode) = whole {
        let mut bytes = Vec::new();
        file.take(MAX_BYTES as u64).read_to_end(&mut bytes).map_err(LoadErrorKind::Read)?;
        return decode(&bytes)?.into_decoded();
    }
    #[cfg(feature = "images")]
    return others::decode(file);
    #[cfg(not(feature = "images"))]
    Err(LoadErrorKind::Picture("not a PNG; other kinds need the feature `images`".into()))
}

/// Returns whether a file begins like a picture in a format that may have a palette.
pub(crate) fn may_have_palette(head: &[u8]) -> bool {
    head.starts_with(PNG) || gif::recognizes(head) || aseprite::recognizes(head) || pcx::recognizes(head)
}

/// Formats read by the crate `image`.
#[cfg(feature = "images")]
mod others {
    use std::io::{Read, SeekFrom};

    use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};

    use super::{Decoded, LoadErrorKind, MAX_BYTES, Rgb, Source, Texture, check_size, clause};

    pub(super) fn decode(file: &mut dyn Source) -> Result<Decoded, LoadErrorKind> {
        let is_tga = file.fill_buf().is_ok_and(is_tga);
        let start = file.stream_position().map_err(LoadErrorKind::Read)?;
        let mut reader = ImageReader::new(&mut *file).with_guessed_format().map_err(LoadErrorKind::Read)?;
        if reader.format().is_none() && is_tga {
            reader.set_format(ImageFormat::Tga);
        }
        let mut limits = Limits::default();
        limits.max_alloc = Some(MAX_BYTES as u64);
        reader.limits(limits);
        let is_jpeg = reader.format() == Some(ImageFormat::Jpeg);
        let decoder = reader.into_decoder().map_err(reason)?;
        let (width, height) = decoder.dimensions();
        // Before memory for its pixels is allocated.
        check_size(width, height)?;
        let mut was_transparent = false;
        let pixels: Vec<Rgb> = match DynamicImage::from_decoder(decoder).map_err(reason)? {
            DynamicImage::ImageRgb8(picture) => {
                picture.as_raw().as_chunks().0.iter().map(|&[r, g, b]| Rgb::new(r, g, b)).collect()
            }
            other => {
                let of = |&[r, g, b, alpha]: &[u8; 4]| {
                    was_transparent |= alpha < 255;
                    Rgb::new(r, g, b)
                };
                other.into_rgba8().as_raw().as_chunks().0.iter().map(of).collect()
            }
        };
        if is_jpeg {
            let mut bytes = Vec::new();
            file.seek(SeekFrom::Start(start)).map_err(LoadErrorKind::Read)?;
            file.take(MAX_BYTES as u64).read_to_end(&mut bytes).map_err(LoadErrorKind::Read)?;
            if is_cut_off(&bytes) {
                return Err(LoadErrorKind::Picture("unexpected end of file".into()));
            }
        }
        let texture = Texture::from_rgb(width, height, &pixels).map_err(LoadErrorKind::Texture)?;
        Ok(Decoded { texture, was_transparent, palette: None })
    }

    /// Returns whether a JPEG is cut off; the decoder makes the missing pixels grey. Segments are skipped by their
    /// length, so a preview inside one does not count, and neither does what follows the end.
    fn is_cut_off(jpeg: &[u8]) -> bool {
        let mut rest = jpeg;
        loop {
            // In the data of a scan a byte FF is followed by 0, by another FF or by a restart's number.
            let is_marker = |pair: &[u8]| pair[0] == 0xFF && !matches!(pair[1], 0 | 1 | 0xD0..=0xD8 | 0xFF);
            let Some(at) = rest.windows(2).position(is_marker) else { return true };
            if rest[at + 1] == 0xD9 {
                return false;
            }
            let Some(&[high, low]) = rest[at + 2..].first_chunk() else { return true };
            let Some(after) = rest.get(at + 2 + usize::from(u16::from_be_bytes([high, low]))..) else { return true };
            rest = after;
        }
    }

    fn reason(error: ImageError) -> LoadErrorKind {
        match error {
            ImageError::IoError(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => {
                LoadErrorKind::Read(error)
            }
            error => {
                // Its message only says that there is an error; the source says which.
                let reason = core::error::Error::source(&error).map(ToString::to_string);
                LoadErrorKind::Picture(clause(&reason.unwrap_or_else(|| error.to_string())))
            }
        }
    }

    /// Returns whether these may be the first bytes of a TGA, which has no signature: the types of colour map and
    /// picture and the bits per pixel must be valid.
    fn is_tga(head: &[u8]) -> bool {
        matches!(head, [_, 0 | 1, 1..=3 | 9..=11, ..] if matches!(head.get(16), Some(8 | 15 | 16 | 24 | 32)))
    }
}

fn check_size(width: u32, height: u32) -> Result<(), LoadErrorKind> {
    match width.max(height) > Texture::MAX_PICTURE_SIDE {
        true => Err(LoadErrorKind::Texture(TextureError::Size { width, height })),
        false => Ok(()),
    }
}

fn decode_png(file: &mut dyn Source) -> Result<Decoded, LoadErrorKind> {
    // A row of the widest picture is 32 KiB; other chunks may be no larger than the pixels.
    let mut decoder = Decoder::new_with_limits(file, Limits { bytes: MAX_BYTES });
    let head = decoder.read_header_info().map_err(reason)?;
    let (width, height) = (head.width, head.height);
    check_size(width, height)?;
    let keeps_indices = head.color_type == ColorType::Indexed;
    decoder.set_transformations(match keeps_indices {
        true => Transformations::IDENTITY,
        false => Transformations::EXPAND,
    });
    let mut reader = decoder.read_info().map_err(reason)?;
    let (color, depth) = reader.output_color_type();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap_or_default()];
    reader.next_frame(&mut bytes).map_err(reason)?;
    if keeps_indices {
        return indexed(reader.info(), &bytes);
    }
    // Rounds 16-bit samples to the nearest of 8 bits.
    let sample = |sample: &[u8]| match *sample {
        [high, low] => ((u32::from(high) * 256 + u32::from(low) + 128) / 257) as u8,
        _ => sample[0],
    };
    let each = if depth == BitDepth::Sixteen { 2 } else { 1 };
    let mut was_transparent = false;
    let pixels: Vec<Rgb> = bytes
        .chunks_exact(color.samples() * each)
        .map(|pixel| {
            let of = |i: usize| sample(&pixel[i * each..][..each]);
            match color {
                ColorType::GrayscaleAlpha => was_transparent |= of(1) < 255,
                ColorType::Rgba => was_transparent |= of(3) < 255,
                _ => {}
            }
            match color {
                ColorType::Grayscale | ColorType::GrayscaleAlpha => Rgb::new(of(0), of(0), of(0)),
                _ => Rgb::new(of(0), of(1), of(2)),
            }
        })
        .collect();
    let texture = Texture::from_rgb(width, height, &pixels).map_err(LoadErrorKind::Texture)?;
    Ok(Decoded { texture, was_transparent, palette: None })
}

/// Makes a texture from a picture's indices, of 1, 2, 4 or 8 bits each, with rows from the top down.
fn indexed(info: &Info<'_>, rows: &[u8]) -> Result<Decoded, LoadErrorKind> {
    let (width, bits) = (info.width as usize, usize::from(info.bit_depth as u8));
    let row_bytes = (width * bits).div_ceil(8);
    let indices: Vec<u8> = rows
        .chunks_exact(row_bytes)
        .flat_map(|row| (0..width).map(move |x| row[x * bits / 8] >> (8 - bits - x * bits % 8) & (0xFF >> (8 - bits))))
        .collect();
    let palette = info.palette.as_deref().ok_or_else(|| LoadErrorKind::Picture("it has no palette".into()))?;
    let colors = indexed::colors(palette);
    let opacities = info.trns.as_deref().unwrap_or_default();
    let was_transparent = indices.iter().any(|&index| opacities.get(usize::from(index)).is_some_and(|&o| o < 255));
    Indexed { width: info.width, height: info.height, indices, colors, was_transparent }.into_decoded()
}

fn reason(error: DecodingError) -> LoadErrorKind {
    match error {
        DecodingError::IoError(error) if error.kind() != io::ErrorKind::UnexpectedEof => LoadErrorKind::Read(error),
        error => LoadErrorKind::Picture(clause(&error.to_string())),
    }
}

#[cfg(test)]
mod tests;
