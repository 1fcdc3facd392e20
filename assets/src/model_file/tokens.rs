//! Words of a text format in which line endings count as whitespace, with their line numbers.

use super::word::{parsed, shown};
use super::{ModelFileError, ModelFileErrorKind, Place};
use std::path::Path;

/// A sequence of words. LF, CR LF and CR end a line.
#[derive(Clone)]
pub(crate) struct Tokens<'b> {
    bytes: &'b [u8],
    at: usize,
    /// The line at `at`, counted from 1.
    line: u64,
    /// The line of the last word read; before the first, the line before.
    pub(crate) word_line: u64,
}

impl<'b> Tokens<'b> {
    /// The words of `bytes`, whose first line has this number.
    pub(crate) fn new(bytes: &'b [u8], line: u64) -> Self {
        Self { bytes, at: 0, line, word_line: line.saturating_sub(1).max(1) }
    }

    /// The line of the next word, or of the end.
    pub(crate) fn line_of_next(&mut self) -> u64 {
        while let Some(byte) = self.bytes.get(self.at).filter(|byte| byte.is_ascii_whitespace()) {
            self.line += u64::from(ends_line(self.bytes, self.at, *byte));
            self.at += 1;
        }
        self.line
    }

    /// The next word; `None` at the end.
    pub(crate) fn next(&mut self) -> Option<&'b [u8]> {
        let line = self.line_of_next();
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        if length == 0 {
            return None;
        }
        self.word_line = line;
        self.at += length;
        Some(&rest[..length])
    }

    /// The next word as a number within the range of f32.
    pub(crate) fn number(&mut self, what: &'static str) -> Result<f64, ModelFileErrorKind> {
        let word = self.next().ok_or(ModelFileErrorKind::Ends(what))?;
        parsed(word, |value: f64| (value as f32).is_finite())
    }

    /// Makes an error at the last word read.
    pub(crate) fn error(&self, path: &Path, kind: ModelFileErrorKind) -> ModelFileError {
        ModelFileError::at(path, Place::Line(self.word_line), kind)
    }
}

/// Returns whether a whitespace character ends a line: an LF, or a CR without an LF after it.
fn ends_line(bytes: &[u8], at: usize, byte: u8) -> bool {
    byte == b'\n' || (byte == b'\r' && bytes.get(at + 1) != Some(&b'\n'))
}

/// Makes an error that says what was expected in place of `word`.
pub(crate) fn expected(expected: &'static str, word: &[u8]) -> ModelFileErrorKind {
    ModelFileErrorKind::Expected { expected, found: shown(word) }
}
