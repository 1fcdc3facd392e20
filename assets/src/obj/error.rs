//! The errors of a model that is refused, with their place in the file.

use std::path::{Path, PathBuf};
use std::{error, fmt, io};

use mode13h::mesh::MeshError;

/// An error of a model that is refused. Displayed as `path:line: what`, on one line.
#[non_exhaustive]
pub struct ObjError {
    /// The file, as the caller or `mtllib` named it.
    pub path: PathBuf,
    /// The line, counted from 1. `None` if no one line is at fault.
    pub line: Option<u64>,
    /// The kind of the error.
    pub kind: ObjErrorKind,
}

/// The kinds of errors of a model.
#[derive(Debug)]
#[non_exhaustive]
pub enum ObjErrorKind {
    /// The file does not exist or cannot be read.
    Read(io::Error),
    /// The path is that of a directory.
    Directory,
    /// Not a text file.
    NotText,
    /// The statement needs more numbers.
    Missing(&'static str),
    /// This should be a number.
    NotNumber(String),
    /// A NaN, an infinity, or a number beyond the range of f32.
    NotFinite(String),
    /// This should be `v`, `v/vt`, `v//vn` or `v/vt/vn`, whole numbers.
    NotCorner(String),
    /// Index 0: they count from 1.
    IndexZero,
    /// An index that names nothing.
    IndexOutOfRange {
        /// "vertex", "texture coordinate" or "normal".
        what: &'static str,
        /// The index as it stands in the file.
        index: i64,
        /// The number of entries: in the file, or for a negative index up to this line.
        count: usize,
    },
    /// The file holds no face.
    NoFaces,
    /// All corners of each face are on a line, or in one point.
    NoArea,
    /// The mesh is refused.
    Mesh(MeshError),
    /// More than [`Mesh::MAX_COUNT`](mode13h::mesh::Mesh::MAX_COUNT) of a kind, more than 2³² − 1 corners, more than 65,536
    /// materials, or a concave face of more than 20,000 corners.
    TooLarge(&'static str),
}

impl ObjError {
    pub(super) fn of_file(path: &Path, kind: ObjErrorKind) -> Self {
        Self { path: path.to_owned(), line: None, kind }
    }

    pub(super) fn of_line(path: &Path, line: u64, kind: ObjErrorKind) -> Self {
        Self { path: path.to_owned(), line: Some(line), kind }
    }
}

impl fmt::Display for ObjError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "{}:{line}: {}", self.path.display(), self.kind),
            None => write!(f, "{}: {}", self.path.display(), self.kind),
        }
    }
}

impl fmt::Display for ObjErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read(error) => write!(f, "{error}"),
            Self::Directory => write!(f, "is a directory"),
            Self::NotText => write!(f, "not a text file"),
            Self::Missing(what) => write!(f, "too few numbers for {what}"),
            Self::NotNumber(word) => write!(f, "`{word}` is not a number"),
            Self::NotFinite(word) => write!(f, "`{word}` is not a finite number"),
            Self::NotCorner(word) => write!(f, "`{word}` is not the corner of a face"),
            Self::IndexZero => write!(f, "index 0: indices count from 1"),
            Self::IndexOutOfRange { what, index, count } => write!(f, "there is no {what} {index}, only {count}"),
            Self::NoFaces => write!(f, "no faces"),
            Self::Mesh(error) => write!(f, "{error}"),
            Self::NoArea => write!(f, "no face has an area, so nothing can be drawn"),
            Self::TooLarge(what) => write!(f, "{what}"),
        }
    }
}

crate::errors::debug_as_display!(ObjError);

impl error::Error for ObjError {
    fn source(&self) -> Option<&(dyn error::Error + 'static)> {
        match &self.kind {
            ObjErrorKind::Read(error) => Some(error),
            _ => None,
        }
    }
}
