//! Warnings about a model, as many as anyone would read.

use std::path::Path;

/// Warnings, of which the first [`MAX`](Self::MAX) are stored and the others counted: a file may cause one in every
/// line.
#[derive(Default)]
pub(crate) struct Warnings {
    kept: Vec<String>,
    more: usize,
}

impl Warnings {
    const MAX: usize = 100;

    pub(crate) fn push(&mut self, warning: impl FnOnce() -> String) {
        if self.kept.len() < Self::MAX {
            self.kept.push(warning());
        } else {
            self.more += 1;
        }
    }

    /// One line for each; the last may say how many more there are.
    pub(crate) fn into_lines(mut self) -> Vec<String> {
        match self.more {
            0 => {}
            1 => self.kept.push("one more warning like these".into()),
            more => self.kept.push(format!("{more} more warnings like these")),
        }
        self.kept
    }
}

/// Ignored statements, each of which causes one warning, however often it occurs in a file.
#[derive(Default)]
pub(crate) struct LeftOut {
    /// The name, its first line, and its number of occurrences.
    of: Vec<(&'static str, u64, u64)>,
}

impl LeftOut {
    pub(crate) fn add(&mut self, what: &'static str, line: u64) {
        match self.of.iter_mut().find(|(known, ..)| *known == what) {
            Some((.., count)) => *count += 1,
            None => self.of.push((what, line, 1)),
        }
    }

    pub(crate) fn warn(self, path: &Path, warnings: &mut Warnings) {
        let path = path.display();
        for (what, line, count) in self.of {
            let times = if count == 1 { String::new() } else { format!(", {count} times") };
            warnings.push(|| format!("{path}:{line}: {what} left out{times}"));
        }
    }
}
