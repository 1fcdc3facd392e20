//! The hard cases on the user's own machine, in a quick form, and recorded frames replayed. Prints
//! nothing, writes no file.
//!
//! | group | what | file |
//! |---|---|---|
//! | spans | S: every kernel against the definition, twins of other loops against theirs | `spans`, `freestanding` |
//! | triangles | R: cover, bytes and range against the definition; shared edges, clip rectangles, bands | `triangles` |
//! | clipping | C: the near plane, the guard band, odd views; what is not finite is refused | `clipping` |
//! | normals | N: normals of length 1, light within its range | `normals` |
//! | time | T: rotations stay rotations; frame n at once | `time` |
//! | hidden-surfaces | D: depth buffer, scan-line and the definition agree; ties | `hidden_surfaces` |
//! | machine | P: 6 and 8 bits, ports, wrapping, ramps | `machine` |
//! | reuse | E: a renderer that has drawn draws what a fresh one does | `reuse` |
//! | files | F: what is written is read again; broken files are refused | `files` |
//!
//! [`frames`] ends it: one hash over a fixed set of frames, the same on every machine.
//! [`replay`] draws a recorded frame every way there is, and by the slow oracle of the definitions
//! (`oracle`: three edge functions in i128), which shares nothing with the raster.
//!
//! Each group is given what it checks as a function, so that its own tests can give it a wrong one
//! and see that it is found out and told in a line that a person can read.

mod clipping;
mod drawing;
mod files;
mod freestanding;
mod hidden_surfaces;
mod machine;
mod normals;
mod oracle;
mod replay;
mod reuse;
mod shrink;
mod spans;
mod time;
mod triangles;

pub use clipping::clipping;
pub use files::files;
pub use freestanding::{Frames, frames, frames_in_steps};
pub use hidden_surfaces::hidden_surfaces;
pub use machine::machine;
pub use normals::normals;
pub use replay::{Comparison, Replay, replay};
pub use reuse::reuse;
pub use spans::spans;
pub use time::time;
pub use triangles::triangles;

use crate::record::Record;
use freestanding::{FAILURES, framed, random};

/// Every group. Each is given the seed of its random cases.
pub const GROUPS: [fn(u64) -> Group; 9] =
    [spans, triangles, clipping, normals, time, hidden_surfaces, machine, reuse, files];

/// Results of one group of checks.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct Group {
    /// Its name, such as `spans`.
    pub name: &'static str,
    /// Number of cases tried. A group that tried none has shown nothing.
    pub cases: u64,
    /// One line for each case that failed, small enough to read; empty if all went well.
    pub failures: Vec<String>,
    /// The first failure that can be replayed ([`replay`]), made as small as it could be.
    pub record: Option<Record>,
}

impl Group {
    fn new(name: &'static str) -> Self {
        Self { name, cases: 0, failures: Vec::new(), record: None }
    }

    /// Returns whether it tried something and nothing failed.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.cases > 0 && self.failures.is_empty()
    }

    /// One case more; `line` says what is wrong if it is not right.
    fn check(&mut self, right: bool, line: impl FnOnce() -> String) {
        self.cases += 1;
        if !right && self.failures.len() < FAILURES {
            self.failures.push(line());
        }
    }

    /// One case more, of a frame; `wrong` says what is wrong with it, if anything. The first that fails
    /// is made small and kept.
    fn check_record(&mut self, id: &str, record: &Record, wrong: &dyn Fn(&Record) -> Option<String>) {
        self.cases += 1;
        if self.failures.len() >= FAILURES || wrong(record).is_none() {
            return;
        }
        let small = shrink::shrink(record, &mut |record| wrong(record).is_some());
        self.failures.push(format!("{id} {}", wrong(&small).unwrap_or_default()));
        self.record.get_or_insert(small);
    }
}
