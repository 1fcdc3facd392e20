//! Errors of scene files, with their position.

use core::ops::Range;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{error, fmt, io};

use super::place::{Place, key_at};
use crate::model_file::ModelFileError;
use crate::palette_file::PaletteError;
use crate::texture::LoadError;

/// The error of a scene file. The whole file is rejected.
///
/// Displayed on one line, as ``scene.toml:9:1: key `objects[0].shap`: unknown key; known are name, shape, …``.
#[non_exhaustive]
pub struct SceneError {
    /// The file, as named by the caller.
    pub path: PathBuf,
    /// The position in the file. `None` if no single position is at fault.
    pub place: Option<Place>,
    /// The key at fault with its parents, such as `objects[0].material.ramp`: lists count from 0. `None` if no key is
    /// at fault.
    pub key: Option<String>,
    /// The kind of the error. Boxed, to keep the size of a `Result` small.
    pub kind: Box<SceneErrorKind>,
}

/// The kinds of errors of a scene file.
#[derive(Debug)]
#[non_exhaustive]
pub enum SceneErrorKind {
    /// The file does not exist or cannot be read.
    Read(io::Error),
    /// The path is that of a directory.
    Directory,
    /// The file has more than [`LONGEST`](super::LONGEST) bytes.
    TooLong,
    /// The file is not UTF-8 text.
    NotText,
    /// The file is text, but not TOML: the parser's message.
    NotToml(String),
    /// There is no such key here.
    UnknownKey {
        /// The known keys.
        known: String,
    },
    /// A required key is missing.
    MissingKey,
    /// The value has the wrong type, is out of range, is an unknown name, or conflicts with another key. The text says
    /// what it is, and what it must be.
    Value(String),
    /// A file that the scene names cannot be read.
    File {
        /// Its path, joined to the folder of the scene file.
        path: PathBuf,
        /// The system's error.
        error: io::Error,
    },
    /// A model that the scene names is broken.
    Model(ModelFileError),
    /// A palette file that the scene names is broken.
    Palette {
        /// Its path.
        path: PathBuf,
        /// The error of the palette file.
        error: PaletteError,
    },
    /// A texture that the scene names is broken.
    Texture(LoadError),
    /// The scene has no object.
    NoObject,
}

/// An error and the bytes of the text at fault, before its position is computed.
pub(super) struct Fault {
    pub(super) span: Option<Range<usize>>,
    pub(super) kind: SceneErrorKind,
}

impl Fault {
    /// Makes the fault of an invalid value.
    pub(super) fn value(span: Range<usize>, what: impl fmt::Display) -> Self {
        Self { span: Some(span), kind: SceneErrorKind::Value(what.to_string()) }
    }

    pub(super) fn of(span: Range<usize>, kind: SceneErrorKind) -> Self {
        Self { span: Some(span), kind }
    }

    /// Adds the position and the key of the fault's span in `text`.
    pub(super) fn locate(self, path: &Path, text: &str) -> SceneError {
        let Self { span, mut kind } = self;
        let place = span.as_ref().map(|span| Place::of(text, span.start));
        let mut key = span.as_ref().and_then(|span| key_at(text, span));
        match &mut kind {
            SceneErrorKind::Value(message) => {
                if let Some(field) = between(message, "missing field `", "`") {
                    key = Some(key.map_or(String::new(), |table| table + ".") + field);
                    kind = SceneErrorKind::MissingKey;
                } else if message.starts_with("unknown field `") {
                    kind = SceneErrorKind::UnknownKey { known: known_keys(message) };
                } else if let Some(turned) = expected_first(message) {
                    *message = turned;
                }
            }
            // Of two equal keys the second is at fault, and no table contains it.
            SceneErrorKind::NotToml(message) if message == "duplicate key" => {
                key = span.and_then(|span| text.get(span)).map(String::from);
            }
            _ => {}
        }
        SceneError { path: path.to_owned(), place, key, kind: Box::new(kind) }
    }
}

/// Makes the fault of a syntax error, which has no key.
pub(super) fn not_toml(error: &toml::de::Error) -> Fault {
    Fault { span: error.span(), kind: SceneErrorKind::NotToml(error.message().to_string()) }
}

/// Makes the fault of a serde error; [`Fault::locate`] looks for the wording of serde's own messages.
pub(super) fn not_a_scene(error: &toml::de::Error) -> Fault {
    Fault { span: error.span(), kind: SceneErrorKind::Value(shortened(error.message())) }
}

/// Shortens a long message in its middle. It begins with a value from the file, which may be of any length, and ends
/// with the expected value.
fn shortened(message: &str) -> String {
    const HEAD: usize = 100;
    const TAIL: usize = 400;
    let length = message.chars().count();
    if length <= HEAD + TAIL {
        return message.to_string();
    }
    let head = message.chars().take(HEAD);
    let tail = message.chars().skip(length - TAIL);
    head.chain(['…']).chain(tail).collect()
}

/// The text between the prefix `before` and the suffix `behind`.
fn between<'t>(text: &'t str, before: &str, behind: &str) -> Option<&'t str> {
    text.strip_prefix(before)?.strip_suffix(behind)
}

/// Turns serde's "invalid type: integer `7`, expected a name" into "expected a name, found integer `7`". The value
/// found may contain any words, so "expected" is searched from the end.
fn expected_first(message: &str) -> Option<String> {
    let kinds = ["invalid type: ", "invalid value: ", "invalid length "];
    let rest = kinds.iter().find_map(|kind| message.strip_prefix(kind))?;
    let at = rest.rfind(", expected ")?;
    let found = &rest[..at];
    // Serde's name for an integer beyond 64 bits.
    let integer = ["` as i128", "` as u128"].iter().find_map(|behind| between(found, "integer `", behind));
    let found = integer.unwrap_or(found);
    Some(format!("{}, found {found}", &rest[at + 2..]))
}

/// Extracts the keys from serde's "unknown field `x`, expected one of `a`, `b`", or "expected `a` or `b`". The unknown
/// key may contain any of these words itself, so they are searched from the end.
fn known_keys(message: &str) -> String {
    let Some(at) = message.rfind("`, expected ") else { return String::from("none") };
    let list = &message[at + "`, expected ".len()..];
    let names: Vec<&str> = list.split('`').skip(1).step_by(2).collect();
    names.join(", ")
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.path.display())?;
        if let Some(Place { line, column }) = self.place {
            write!(f, ":{line}:{column}")?;
        }
        f.write_str(": ")?;
        let mut line = Line { f, left: LONGEST_MESSAGE };
        if let Some(key) = &self.key {
            write!(line, "key `{key}`: ")?;
        }
        write!(line, "{}", self.kind)
    }
}

impl fmt::Display for SceneErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read(error) => write!(f, "{error}"),
            Self::Directory => write!(f, "is a directory"),
            Self::TooLong => write!(f, "too long: a scene file may be at most 1 MiB"),
            Self::NotText => write!(f, "not UTF-8 text"),
            Self::NotToml(what) => write!(f, "not TOML: {what}"),
            Self::UnknownKey { known } => write!(f, "unknown key; known are {known}"),
            Self::MissingKey => write!(f, "missing"),
            Self::Value(what) => f.write_str(what),
            Self::File { path, error } => write!(f, "{}: {error}", path.display()),
            Self::Model(error) => write!(f, "{error}"),
            Self::Palette { path, error } => write!(f, "{}: {error}", path.display()),
            Self::Texture(error) => write!(f, "{error}"),
            Self::NoObject => write!(f, "no object: a scene needs at least one [[objects]]"),
        }
    }
}

crate::errors::debug_as_display!(SceneError);

impl error::Error for SceneError {
    fn source(&self) -> Option<&(dyn error::Error + 'static)> {
        match &*self.kind {
            SceneErrorKind::Read(error) | SceneErrorKind::File { error, .. } => Some(error),
            SceneErrorKind::Model(error) => Some(error),
            SceneErrorKind::Palette { error, .. } => Some(error),
            SceneErrorKind::Texture(error) => Some(error),
            _ => None,
        }
    }
}

/// The maximum number of characters shown of a message, which may quote the file.
const LONGEST_MESSAGE: usize = 2500;

/// A writer that puts its text on one line, printable, and not too long to read.
struct Line<'a, 'f> {
    f: &'a mut fmt::Formatter<'f>,
    left: usize,
}

impl fmt::Write for Line<'_, '_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for c in text.chars() {
            match self.left {
                0 => return Ok(()),
                1 => self.f.write_char('…')?,
                _ => self.f.write_char(if c.is_control() { ' ' } else { c })?,
            }
            self.left -= 1;
        }
        Ok(())
    }
}
