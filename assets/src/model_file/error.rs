//! Errors of model files, with their position in the file.

use std::path::{Path, PathBuf};
use std::{error, fmt, io};

use mode13h::mesh::MeshError;

/// The reason why a model is rejected. Displayed on one line, as `path:line: what`, or as `path: byte 84: what` for a
/// binary file.
#[non_exhaustive]
pub struct ModelFileError {
    /// The file, as named by the caller or by `mtllib`.
    pub path: PathBuf,
    /// The position in the file. `None` if no single position is at fault.
    pub place: Option<Place>,
    /// The kind of the error.
    pub kind: ModelFileErrorKind,
}

/// A position in a model file.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Place {
    /// A line of text, counted from 1.
    Line(u64),
    /// A byte of a binary file, counted from 0.
    Offset(u64),
}

/// The kinds of errors of a model.
#[derive(Debug)]
#[non_exhaustive]
pub enum ModelFileErrorKind {
    /// The file does not exist or cannot be read.
    Read(io::Error),
    /// The path is that of a directory.
    Directory,
    /// The file is not text.
    NotText,
    /// The statement needs more numbers.
    Missing(&'static str),
    /// This should be a number.
    NotNumber(String),
    /// A NaN, an infinity, or a number beyond the range of f32.
    NotFinite(String),
    /// The file ends where this was expected.
    Ends(&'static str),
    /// Another word was expected here.
    Expected {
        /// The expected word.
        expected: &'static str,
        /// The word in the file.
        found: String,
    },
    /// Another fault of the file, described in this text.
    Fault(String),
    /// This should be `v`, `v/vt`, `v//vn` or `v/vt/vn`, all integers.
    NotCorner(String),
    /// An index is 0, but they count from 1.
    IndexZero,
    /// An index refers to nothing.
    IndexOutOfRange {
        /// "vertex", "texture coordinate" or "normal".
        what: &'static str,
        /// The index as written in the file.
        index: i64,
        /// The number of entries: in the file, or for a negative index up to this line.
        count: usize,
    },
    /// The file contains no face.
    NoFaces,
    /// All corners of each face are collinear, or at one point.
    NoArea,
    /// The mesh is rejected.
    Mesh(MeshError),
    /// More than [`Mesh::MAX_COUNT`](mode13h::mesh::Mesh::MAX_COUNT) of a kind, more than 2³² − 1 corners, more than 65,536
    /// materials, or a concave face of more than 20,000 corners.
    TooLarge(&'static str),
}

impl ModelFileError {
    pub(crate) fn of_file(path: &Path, kind: ModelFileErrorKind) -> Self {
        Self { path: path.to_owned(), place: None, kind }
    }

    pub(crate) fn of_line(path: &Path, line: u64, kind: ModelFileErrorKind) -> Self {
        Self::at(path, Place::Line(line), kind)
    }

    pub(crate) fn at(path: &Path, place: Place, kind: ModelFileErrorKind) -> Self {
        Self { path: path.to_owned(), place: Some(place), kind }
    }
}

impl fmt::Display for ModelFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let path = self.path.display();
        match self.place {
            Some(Place::Line(line)) => write!(f, "{path}:{line}: {}", self.kind),
            Some(Place::Offset(offset)) => write!(f, "{path}: byte {offset}: {}", self.kind),
            None => write!(f, "{path}: {}", self.kind),
        }
    }
}

impl fmt::Display for ModelFileErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read(error) => write!(f, "{error}"),
            Self::Directory => write!(f, "is a directory"),
            Self::NotText => write!(f, "not a text file"),
            Self::Missing(what) => write!(f, "too few numbers for {what}"),
            Self::NotNumber(word) => write!(f, "`{word}` is not a number"),
            Self::NotFinite(word) => write!(f, "`{word}` is not a finite number"),
            Self::Ends(what) => write!(f, "the file ends where {what} is expected"),
            Self::Expected { expected, found } => write!(f, "expected {expected}, found `{found}`"),
            Self::Fault(what) => f.write_str(what),
            Self::NotCorner(word) => write!(f, "`{word}` is not a face corner (v, v/vt, v//vn or v/vt/vn)"),
            Self::IndexZero => write!(f, "index 0: indices count from 1"),
            Self::IndexOutOfRange { what, index, count } => write!(f, "there is no {what} {index}, only {count}"),
            Self::NoFaces => write!(f, "no faces"),
            Self::Mesh(error) => write!(f, "{error}"),
            Self::NoArea => write!(f, "no face has an area, so nothing can be drawn"),
            Self::TooLarge(what) => write!(f, "{what}"),
        }
    }
}

crate::errors::debug_as_display!(ModelFileError);

impl error::Error for ModelFileError {
    fn source(&self) -> Option<&(dyn error::Error + 'static)> {
        match &self.kind {
            ModelFileErrorKind::Read(error) => Some(error),
            _ => None,
        }
    }
}
