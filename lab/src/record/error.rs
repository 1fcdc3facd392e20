//! Errors of a record's file, with their lines.

use std::error::Error;
use std::fmt;
use std::io;

use super::VERSION;
use mode13h::raster::RasterError;

/// Error of a record that was refused. Nothing of it is used.
///
/// Displays as `line 7: expected a depth, found "-1"`, to stand behind the file's name and a colon.
#[derive(Debug)]
#[non_exhaustive]
pub struct RecordError {
    /// The line, counted from 1; 0 where none was read.
    pub line: u64,
    /// Kind of the error.
    pub kind: RecordErrorKind,
}

/// Kinds of errors in a record.
#[derive(Debug)]
#[non_exhaustive]
pub enum RecordErrorKind {
    /// The file cannot be read.
    Read(io::Error),
    /// The first line is not that of a record.
    NoRecord,
    /// The first line is not that of a run.
    NoRun,
    /// A record of another version than this.
    Version {
        /// Text found there.
        found: String,
    },
    /// A line is not UTF-8, or longer than any line of a record.
    NoText,
    /// Something else should stand there.
    Expected {
        /// Text expected there.
        expected: &'static str,
        /// Text found there, cut short if it is long.
        found: String,
    },
    /// The file ends before its end.
    BrokenOff {
        /// Text that should follow.
        expected: &'static str,
    },
    /// The clip rectangle does not lie inside the frame, or runs backwards.
    Clip,
    /// A palette falls into 0, 1, 2, 4 … 256 ramps.
    Ramps {
        /// The number that stands there.
        found: u16,
    },
    /// A frame's size or a vertex that the raster refuses.
    Raster(RasterError),
}

impl fmt::Display for RecordError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => write!(f, "{}", self.kind),
            line => write!(f, "line {line}: {}", self.kind),
        }
    }
}

impl fmt::Display for RecordErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read(error) => write!(f, "{error}"),
            Self::NoRecord => f.write_str("no record: it would begin with \"mode13h record\""),
            Self::NoRun => f.write_str("no run: it would begin with \"mode13h run\""),
            Self::Version { found } => write!(f, "a record of version {found:?}; this program reads {VERSION}"),
            Self::NoText => f.write_str("no text, or too long a line"),
            Self::Expected { expected, found } => write!(f, "expected {expected}, found {found:?}"),
            Self::BrokenOff { expected } => write!(f, "the file ends where {expected} should follow"),
            Self::Clip => f.write_str("the clip rectangle must lie inside the frame"),
            Self::Ramps { found } => write!(f, "a palette has 0, 1, 2, 4 … 256 ramps, not {found}"),
            Self::Raster(error) => write!(f, "{error}"),
        }
    }
}

impl Error for RecordError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match &self.kind {
            RecordErrorKind::Read(error) => Some(error),
            RecordErrorKind::Raster(error) => Some(error),
            _ => None,
        }
    }
}
