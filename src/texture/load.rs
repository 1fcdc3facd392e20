//! Textures from picture files.

use core::fmt;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Seek};
use std::path::{Path, PathBuf};
use std::string::{String, ToString};
use std::vec;
use std::vec::Vec;

use png::{BitDepth, ColorType, Decoder, DecodingError, Limits, Transformations};

use super::{Texture, TextureError};
use crate::palette::Rgb;

/// The max memory of a picture while it is read: 4,096 × 4,096 pixels of four samples of 16 bits.
const MAX_BYTES: usize = 4_096 * 4_096 * 8;

/// An error of a file that gave no texture.
#[derive(Debug)]
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
    /// The path is that of a directory, a device or the like.
    NotAFile,
    /// The file is no picture of a kind that is read, or a broken one.
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
            Self::Picture(reason) => write!(f, "no picture that can be read: {reason}"),
            Self::Texture(error) => write!(f, "{error}"),
        }
    }
}

impl core::error::Error for LoadError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match &self.kind {
            LoadErrorKind::Read(error) => Some(error),
            LoadErrorKind::Texture(error) => Some(error),
            LoadErrorKind::NotAFile | LoadErrorKind::Picture(_) => None,
        }
    }
}

/// Reads a PNG, with the feature `images` also a JPEG, TGA, BMP, GIF or WebP, and makes a texture of it as
/// [`Texture::from_rgb`] does. The kind is told by the contents, not by the name. Grey and indexed pictures become RGB, 16
/// bits become 8, and transparency is left out.
///
/// # Errors
/// A file that cannot be read, that is no such picture or a broken one, or with a side above 4,096.
pub fn load(path: impl AsRef<Path>) -> Result<Texture, LoadError> {
    let path = path.as_ref();
    read(path).map_err(|kind| LoadError { path: path.to_owned(), kind })
}

fn read(path: &Path) -> Result<Texture, LoadErrorKind> {
    let file = File::open(path).map_err(LoadErrorKind::Read)?;
    // A model may name a device that never ends.
    if !file.metadata().map_err(LoadErrorKind::Read)?.is_file() {
        return Err(LoadErrorKind::NotAFile);
    }
    decode(BufReader::new(file))
}

/// Reads a picture that is in memory or comes from elsewhere, and makes a texture of it like [`load`].
///
/// # Errors
/// Those of [`load`].
pub fn decode(mut file: impl BufRead + Seek) -> Result<Texture, LoadErrorKind> {
    const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
    let head = file.fill_buf().map_err(LoadErrorKind::Read)?;
    if head.starts_with(PNG) {
        return decode_png(file);
    }
    #[cfg(feature = "images")]
    return others::decode(file);
    #[cfg(not(feature = "images"))]
    Err(LoadErrorKind::Picture("not a PNG; other kinds need the feature `images`".into()))
}

/// Kinds that the crate `image` reads.
#[cfg(feature = "images")]
mod others {
    use std::io::{BufRead, Seek};
    use std::string::ToString;
    use std::vec::Vec;

    use image::{ImageError, ImageFormat, ImageReader, Limits};

    use super::{LoadErrorKind, MAX_BYTES, Rgb, Texture, TextureError};

    pub(super) fn decode(mut file: impl BufRead + Seek) -> Result<Texture, LoadErrorKind> {
        let is_tga = file.fill_buf().is_ok_and(is_tga);
        let mut reader = ImageReader::new(file).with_guessed_format().map_err(LoadErrorKind::Read)?;
        if reader.format().is_none() && is_tga {
            reader.set_format(ImageFormat::Tga);
        }
        let most = Texture::MAX_PICTURE_SIDE;
        let mut limits = Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(1 << 16), Some(1 << 16));
        limits.max_alloc = Some(2 * MAX_BYTES as u64);
        reader.limits(limits);
        let picture = reader.decode().map_err(|error| match error {
            ImageError::IoError(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => {
                LoadErrorKind::Read(error)
            }
            error => LoadErrorKind::Picture(error.to_string()),
        })?;
        let (width, height) = (picture.width(), picture.height());
        if width.max(height) > most {
            return Err(LoadErrorKind::Texture(TextureError::Size { width, height }));
        }
        let pixels: Vec<Rgb> =
            picture.into_rgb8().pixels().map(|pixel| Rgb::new(pixel[0], pixel[1], pixel[2])).collect();
        Texture::from_rgb(width, height, &pixels).map_err(LoadErrorKind::Texture)
    }

    /// Returns whether these may be the first bytes of a TGA, which has no signature: kind of colour map, kind of picture
    /// and bits of a pixel are among those that there are.
    fn is_tga(head: &[u8]) -> bool {
        matches!(head, [_, 0 | 1, 1..=3 | 9..=11, ..] if matches!(head.get(16), Some(8 | 15 | 16 | 24 | 32)))
    }
}

fn decode_png(file: impl BufRead + Seek) -> Result<Texture, LoadErrorKind> {
    // A row of the widest picture is 32 KiB; a chunk beside the pixels may hold no more than they do.
    let mut decoder = Decoder::new_with_limits(file, Limits { bytes: MAX_BYTES });
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(reason)?;
    let (width, height) = (reader.info().width, reader.info().height);
    if width.max(height) > Texture::MAX_PICTURE_SIDE {
        return Err(LoadErrorKind::Texture(TextureError::Size { width, height }));
    }
    let (color, depth) = reader.output_color_type();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap_or_default()];
    reader.next_frame(&mut bytes).map_err(reason)?;
    // Eight bits of each sample, the nearest to sixteen.
    let sample = |sample: &[u8]| match *sample {
        [high, low] => ((u32::from(high) * 256 + u32::from(low) + 128) / 257) as u8,
        _ => sample[0],
    };
    let each = if depth == BitDepth::Sixteen { 2 } else { 1 };
    let pixels: Vec<Rgb> = bytes
        .chunks_exact(color.samples() * each)
        .map(|pixel| {
            let of = |i: usize| sample(&pixel[i * each..][..each]);
            match color {
                ColorType::Grayscale | ColorType::GrayscaleAlpha => Rgb::new(of(0), of(0), of(0)),
                _ => Rgb::new(of(0), of(1), of(2)),
            }
        })
        .collect();
    Texture::from_rgb(width, height, &pixels).map_err(LoadErrorKind::Texture)
}

fn reason(error: DecodingError) -> LoadErrorKind {
    match error {
        DecodingError::IoError(error) if error.kind() != io::ErrorKind::UnexpectedEof => LoadErrorKind::Read(error),
        error => LoadErrorKind::Picture(error.to_string()),
    }
}
