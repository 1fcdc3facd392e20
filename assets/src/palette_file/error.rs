//! Errors of palette files, with their position.

use core::fmt;

/// The error of a palette file, with its position. The whole file is rejected.
///
/// Displays as `line 7: expected three numbers 0 to 255, found "red"`, to be appended to the file's name and a colon.
#[derive(Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct PaletteError {
    /// The kind of the error.
    pub kind: PaletteErrorKind,
    /// The position of the error.
    pub place: Place,
}

/// A position in a file.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Place {
    /// A line of text, counted from 1. If a line is missing, one more than the number of lines.
    Line(usize),
    /// A byte, counted from 0. If a byte is missing, the number of bytes.
    Offset(usize),
}

/// The kinds of errors of a palette file.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum PaletteErrorKind {
    /// The file has no bytes at all.
    Empty,
    /// The file matches none of the formats.
    UnknownFormat,
    /// A line differs from the fixed text that it must have.
    Expected {
        /// The expected text.
        expected: &'static str,
        /// The text found.
        found: Excerpt,
    },
    /// The number of colours is not from 1 to 256.
    Count {
        /// The text found.
        found: Excerpt,
    },
    /// A line is not three numbers from 0 to 255.
    NotThreeNumbers {
        /// The text found.
        found: Excerpt,
    },
    /// A line is not six hexadecimal digits.
    NotSixHexDigits {
        /// The text found.
        found: Excerpt,
    },
    /// The file has a 257th colour.
    TooManyColors,
    /// There is a colour, or something else, after the last one that the file declares.
    MoreThanAnnounced {
        /// The number declared.
        announced: usize,
    },
    /// The file ends too soon.
    TooFewColors {
        /// The number of colours in the file.
        found: usize,
        /// The number declared, or at least 1.
        expected: usize,
    },
    /// The file's length is not one of the format's.
    Length {
        /// The lengths of the format.
        expected: &'static str,
        /// The length of the file.
        found: usize,
    },
}

impl PaletteError {
    pub(super) const fn at_line(line: usize, kind: PaletteErrorKind) -> Self {
        Self { kind, place: Place::Line(line) }
    }

    pub(super) const fn at_offset(offset: usize, kind: PaletteErrorKind) -> Self {
        Self { kind, place: Place::Offset(offset) }
    }
}

crate::errors::debug_as_display!(PaletteError);

impl core::error::Error for PaletteError {}

impl fmt::Display for PaletteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.kind)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Offset(offset) => write!(f, "offset {offset}"),
        }
    }
}

impl fmt::Display for PaletteErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "the file is empty"),
            Self::UnknownFormat => write!(f, "not a JASC, GIMP, Lospec, Adobe or raw VGA palette"),
            Self::Expected { expected, found } => write!(f, "expected \"{expected}\", found {found}"),
            Self::Count { found } => write!(f, "expected the number of colours, 1 to 256, found {found}"),
            Self::NotThreeNumbers { found } => write!(f, "expected three numbers 0 to 255, found {found}"),
            Self::NotSixHexDigits { found } => write!(f, "expected six hexadecimal digits, found {found}"),
            Self::TooManyColors => write!(f, "more than 256 colours"),
            Self::MoreThanAnnounced { announced } => {
                write!(f, "more than the {announced} colours that the file announces")
            }
            Self::TooFewColors { found, expected } => {
                write!(f, "the file ends after {found} of {expected} colours")
            }
            Self::Length { expected, found } => write!(f, "expected {expected} bytes, found {found}"),
        }
    }
}

/// The beginning of a text that was found where another was expected, stored without an allocator.
///
/// Displays in quotes, with three dots if it was cut; characters other than printable ASCII appear as `?`.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Excerpt {
    bytes: [u8; Self::LONGEST],
    // At most LONGEST.
    length: u8,
    cut: bool,
}

impl Excerpt {
    const LONGEST: usize = 32;

    pub(super) fn of(found: &[u8]) -> Self {
        let mut bytes = [b'?'; Self::LONGEST];
        for (to, &from) in bytes.iter_mut().zip(found) {
            if from == b' ' || from.is_ascii_graphic() {
                *to = from;
            }
        }
        let length = found.len().min(Self::LONGEST) as u8;
        Self { bytes, length, cut: found.len() > Self::LONGEST }
    }

    /// The beginning of the text, up to 32 characters of ASCII.
    #[must_use]
    pub(crate) fn as_str(&self) -> &str {
        // Only ASCII was stored, so the default is never used.
        core::str::from_utf8(&self.bytes[..usize::from(self.length)]).unwrap_or_default()
    }
}

impl fmt::Display for Excerpt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\"{}{}\"", self.as_str(), if self.cut { "..." } else { "" })
    }
}

impl fmt::Debug for Excerpt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}
