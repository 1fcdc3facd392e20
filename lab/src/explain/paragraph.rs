//! Text in lines that begin with a label.

use alloc::format;
use alloc::string::String;

use crate::lines::lines;

/// Columns of text.
const WIDTH: usize = 100;

/// Columns of what stands before it.
const LABEL: usize = 10;

/// Lines that begin with a label and go on below it.
#[derive(Default)]
pub(super) struct Text(pub(super) String);

impl Text {
    /// A paragraph, wrapped.
    pub(super) fn say(&mut self, label: &str, words: &str) {
        let mut label = label;
        for line in lines(words, WIDTH - LABEL - 2) {
            self.row(label, &line);
            label = "";
        }
    }

    /// One line as it is.
    pub(super) fn line(&mut self, line: &str) {
        self.0 += line.trim_end();
        self.0.push('\n');
    }

    /// A line behind a label, as it is.
    pub(super) fn row(&mut self, label: &str, row: &str) {
        self.line(&format!("  {label:LABEL$}{row}"));
    }
}
