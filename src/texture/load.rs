//! Textures from picture files.

use core::fmt;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Seek};
use std::path::{Path, PathBuf};
use std::string::{String, ToString};
use std::vec::Vec;

use image::{ImageError, ImageReader, Limits};

use super::{Texture, TextureError};
use crate::palette::Rgb;

/// Why a file gave no texture.
#[derive(Debug)]
#[non_exhaustive]
pub struct LoadError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub kind: LoadErrorKind,
}

/// What is wrong with a texture's file.
#[derive(Debug)]
#[non_exhaustive]
pub enum LoadErrorKind {
    /// It cannot be read.
    Read(io::Error),
    /// It is a directory, a device or the like.
    NotAFile,
    /// It is no picture of a kind that is read, or a broken one.
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
            Self::Picture(reason) => write!(f, "no PNG that can be read: {reason}"),
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

/// Reads a PNG, which is told by what the file holds, not by its name, and makes a texture of it as
/// [`Texture::from_rgb`] does. Grey and indexed pictures become RGB, 16 bits become 8, and transparency
/// is left out.
///
/// # Errors
/// A file that cannot be read, that is no PNG or a broken one, or with a side above 4,096.
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

/// As [`load`], of a file that is in memory or comes from elsewhere.
///
/// # Errors
/// As [`load`].
pub fn decode(file: impl BufRead + Seek) -> Result<Texture, LoadErrorKind> {
    let mut reader = ImageReader::new(file).with_guessed_format().map_err(LoadErrorKind::Read)?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(Texture::MAX_PICTURE_SIDE);
    limits.max_image_height = Some(Texture::MAX_PICTURE_SIDE);
    reader.limits(limits);
    let picture = reader.decode().map_err(|error| match error {
        ImageError::IoError(error) if error.kind() != io::ErrorKind::UnexpectedEof => LoadErrorKind::Read(error),
        error => LoadErrorKind::Picture(error.to_string()),
    })?;
    let picture = picture.into_rgb8();
    let pixels: Vec<Rgb> = picture.pixels().map(|pixel| Rgb::new(pixel.0[0], pixel.0[1], pixel.0[2])).collect();
    Texture::from_rgb(picture.width(), picture.height(), &pixels).map_err(LoadErrorKind::Texture)
}
