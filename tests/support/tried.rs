//! The table of how many cases each test tried, and the worst values it saw: no cases, or fewer than stated, is a
//! failure.
//!
//! A test's row is printed, and stored in the target directory as `tmp/tried/<test>`, so that `cat target/tmp/tried/*`
//! is the table of all of them; `.ci/tried_table` turns it into Markdown.

use std::fs;
use std::path::Path;

/// Counts one test's cases, and reports them when the test ends.
#[must_use]
pub struct Tried {
    test: String,
    stated: u64,
    cases: u64,
    /// Measures, each with its greatest value.
    worst: Vec<(&'static str, f64)>,
}

impl Tried {
    /// A row for `test`, which states that it tries at least `stated` cases.
    pub fn new(test: impl Into<String>, stated: u64) -> Self {
        Self { test: test.into(), stated, cases: 0, worst: Vec::new() }
    }

    /// How many cases the test states that it tries.
    pub fn stated(&self) -> u64 {
        self.stated
    }

    /// How many were tried so far.
    pub fn cases(&self) -> u64 {
        self.cases
    }

    /// Counts `cases` more.
    pub fn add(&mut self, cases: u64) {
        self.cases += cases;
    }

    /// Returns whether there are stated cases left to try; counts the next one if so.
    pub fn more(&mut self) -> bool {
        let more = self.cases < self.stated;
        self.cases += u64::from(more);
        more
    }

    /// Records a value of `measure`: the report gives the greatest.
    pub fn worst(&mut self, measure: &'static str, value: f64) {
        assert!(!value.is_nan(), "{}: {measure} is not a number", self.test);
        match self.worst.iter_mut().find(|(name, _)| *name == measure) {
            Some((_, greatest)) => *greatest = greatest.max(value),
            None => self.worst.push((measure, value)),
        }
    }

    /// Reports now.
    pub fn done(self) {}
}

impl Drop for Tried {
    /// Prints and stores the row; for a test that fails, it says so.
    ///
    /// # Panics
    /// If no case was tried, or fewer than stated.
    fn drop(&mut self) {
        let failed = std::thread::panicking() || self.cases < self.stated.max(1);
        let mut row = format!("{:<56} {:>15} cases", self.test, grouped(self.cases));
        for (i, (measure, value)) in self.worst.iter().enumerate() {
            row += if i == 0 { "; " } else { ", " };
            row += &format!("{measure}: {}", figure(*value));
        }
        if failed {
            row += "; FAILED";
        }
        println!("{row}");
        let table = Path::new(env!("CARGO_TARGET_TMPDIR")).join("tried");
        let file = table.join(self.test.replace([':', '/', '*', ' '], "_"));
        if let Err(error) = fs::create_dir_all(&table).and_then(|()| fs::write(&file, row + "\n")) {
            println!("{}: {error}", file.display());
        }
        if std::thread::panicking() {
            return;
        }
        assert!(self.cases > 0, "{}: no case was tried", self.test);
        assert!(self.cases >= self.stated, "{}: {} cases tried, {} stated", self.test, self.cases, self.stated);
    }
}

/// Returns whether a level or a tool is available, as determined by the caller. Missing ones are named in the line of
/// `.ci/not_tried`, so that a test that skips something is not silent.
pub fn is_here(what: &str, here: bool) -> bool {
    let missing = Path::new(env!("CARGO_TARGET_TMPDIR")).join("not_tried");
    let file = missing.join(what);
    if here {
        // It may have been missing before.
        let _ = fs::remove_file(&file);
    } else {
        println!("not tried here: {what}");
        fs::create_dir_all(&missing).and_then(|()| fs::write(&file, "")).expect("a file in the target directory");
    }
    here
}

/// A count in full; anything else to four places, or to two digits if it is small.
fn figure(value: f64) -> String {
    if value.fract() == 0.0 && value < 1e15 {
        // A whole number below 2⁵³.
        grouped(value as u64)
    } else if value >= 0.001 {
        format!("{value:.4}")
    } else {
        format!("{value:.1e}")
    }
}

/// 1234567 as 1,234,567.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
