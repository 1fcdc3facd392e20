//! Warnings of a model, as many as anyone would read.

use std::string::String;
use std::vec::Vec;

/// Warnings, of which the first [`MAX`](Self::MAX) are kept and the others counted: a file may give cause for one in
/// every line, and each holds a path as long as the file likes.
#[derive(Default)]
pub(super) struct Warnings {
    kept: Vec<String>,
    more: usize,
}

impl Warnings {
    const MAX: usize = 100;

    pub(super) fn push(&mut self, warning: impl FnOnce() -> String) {
        if self.kept.len() < Self::MAX {
            self.kept.push(warning());
        } else {
            self.more += 1;
        }
    }

    /// One line each; the last may say how many more there are.
    pub(super) fn into_lines(mut self) -> Vec<String> {
        match self.more {
            0 => {}
            1 => self.kept.push("one more warning like these".into()),
            more => self.kept.push(format!("{more} more warnings like these")),
        }
        self.kept
    }
}
