//! Labelled lines of text.

use crate::lines::lines;

/// Columns per line.
const WIDTH: usize = 100;

/// Columns taken by the label.
const LABEL: usize = 10;

/// Paragraphs with a label in front, indented below it.
#[derive(Default)]
pub(super) struct Text(pub(super) String);

impl Text {
    /// Adds a wrapped paragraph.
    pub(super) fn say(&mut self, label: &str, words: &str) {
        let mut label = label;
        for line in lines(words, WIDTH - LABEL - 2) {
            self.row(label, &line);
            label = "";
        }
    }

    /// Adds one line as it is.
    pub(super) fn line(&mut self, line: &str) {
        self.0 += line.trim_end();
        self.0.push('\n');
    }

    /// Adds a labelled line as it is.
    pub(super) fn row(&mut self, label: &str, row: &str) {
        self.line(&format!("  {label:LABEL$}{row}"));
    }
}
