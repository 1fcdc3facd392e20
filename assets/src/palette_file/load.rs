//! Palettes by file name.

use std::error::Error;
use std::fmt;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use mode13h::palette::Palette;

use super::error::PaletteError;
use super::parse_named;

/// The max number of bytes read from a file. No palette file is longer, not even one with a paragraph for each colour;
/// a longer one fails on the part up to here.
const LONGEST: u64 = 1 << 20;

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
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            LoadErrorKind::Read(error) => write!(f, "{}: {error}", self.path.display()),
            LoadErrorKind::Palette(error) => write!(f, "{}: {error}", self.path.display()),
        }
    }
}

crate::errors::debug_as_display!(LoadError);

impl Error for LoadError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match &self.kind {
            LoadErrorKind::Read(error) => Some(error),
            LoadErrorKind::Palette(error) => Some(error),
        }
    }
}

/// Reads a palette file in the format determined by its name and its first bytes, like [`parse_named`].
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
/// A file that cannot be read, or that is broken.
pub fn load(path: impl AsRef<Path>) -> Result<Palette, LoadError> {
    let path = path.as_ref();
    let failed = |kind| LoadError { path: path.to_owned(), kind };
    let mut bytes = Vec::new();
    let file = File::open(path).and_then(|file| file.take(LONGEST).read_to_end(&mut bytes));
    file.map_err(|error| failed(LoadErrorKind::Read(error)))?;
    parse_named(&path.to_string_lossy(), &bytes).map_err(|error| failed(LoadErrorKind::Palette(error)))
}
