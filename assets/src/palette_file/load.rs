//! Palettes by file name: palette files, and pictures that have a palette.

use std::error::Error;
use std::fmt;
use std::fs::File;
use std::io::{self, Cursor, Read};
use std::path::{Path, PathBuf};

use mode13h::palette::Palette;

use super::error::PaletteError;
use super::{Format, parse_named};
use crate::texture;

/// The maximum number of bytes read from a palette file. None is longer, not even one with a paragraph for each colour;
/// a longer one fails on the part that is read.
const LONGEST: usize = 1 << 20;

/// The maximum number of bytes read from a picture: an incompressible one of 4,096 × 4,096 in true colour.
pub(crate) const LONGEST_PICTURE: u64 = 64 << 20;

/// The reason why a file gives no palette.
#[non_exhaustive]
pub struct LoadError {
    /// The file.
    pub path: PathBuf,
    /// The kind of the error.
    pub kind: LoadErrorKind,
}

/// The kinds of errors of a palette's file.
#[derive(Debug)]
#[non_exhaustive]
pub enum LoadErrorKind {
    /// The file cannot be read.
    Read(io::Error),
    /// The file is not a palette, or a broken one.
    Palette(PaletteError),
    /// The file is a picture that is broken or has no palette.
    Picture(texture::LoadErrorKind),
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            LoadErrorKind::Read(error) => write!(f, "{}: {error}", self.path.display()),
            LoadErrorKind::Palette(error) => write!(f, "{}: {error}", self.path.display()),
            LoadErrorKind::Picture(error) => write!(f, "{}: {error}", self.path.display()),
        }
    }
}

crate::errors::debug_as_display!(LoadError);

impl Error for LoadError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match &self.kind {
            LoadErrorKind::Read(error) => Some(error),
            LoadErrorKind::Palette(error) => Some(error),
            LoadErrorKind::Picture(_) => None,
        }
    }
}

/// Reads a palette file in the format determined by its name and its first bytes, like [`parse_named`], or the palette of
/// an indexed picture: PNG, GIF, PCX or an Aseprite sprite.
///
/// ```no_run
/// use mode13h_assets::palette_file;
///
/// let mut scene = mode13h::scene::Scene::new();
/// scene.palette = Some(palette_file::load("copper.gpl")?);
/// # Ok::<(), palette_file::LoadError>(())
/// ```
///
/// # Errors
/// A file that cannot be read, or that is broken, or a picture without a palette.
pub fn load(path: impl AsRef<Path>) -> Result<Palette, LoadError> {
    let path = path.as_ref();
    let failed = |kind| LoadError { path: path.to_owned(), kind };
    let name = path.to_string_lossy();
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|mut file| {
        file.by_ref().take(LONGEST as u64).read_to_end(&mut bytes)?;
        match is_picture(&name, &bytes) {
            true => file.take(LONGEST_PICTURE - bytes.len() as u64).read_to_end(&mut bytes),
            false => Ok(0),
        }
    });
    read.map_err(|error| failed(LoadErrorKind::Read(error)))?;
    of_bytes(&name, &bytes).map_err(failed)
}

/// The palette in the bytes of a palette file or an indexed picture with this name.
pub(crate) fn of_bytes(name: &str, bytes: &[u8]) -> Result<Palette, LoadErrorKind> {
    if !is_picture(name, bytes) {
        return parse_named(name, &bytes[..bytes.len().min(LONGEST)]).map_err(LoadErrorKind::Palette);
    }
    let picture = texture::decode_all(Cursor::new(bytes)).map_err(LoadErrorKind::Picture)?;
    let none = || LoadErrorKind::Picture(texture::LoadErrorKind::Picture("it has no palette".into()));
    picture.palette.map(Palette::from_colors).ok_or_else(none)
}

/// Returns whether bytes are a picture that may have a palette. With the extension of a palette file they are not,
/// since the bytes of a raw palette may begin in any way.
fn is_picture(name: &str, bytes: &[u8]) -> bool {
    Format::of_file_name(name).is_none() && texture::may_have_palette(bytes)
}
