//! The frames and the span kernels, without `std` and without files: `machines/` includes this folder, so that chips and
//! emulated processors draw by one definition.

pub(super) mod fingerprint;
mod frames;
mod kernels;
pub(super) mod random;
mod twins;

pub(super) use frames::framed;
pub use frames::{Frames, frames, frames_in_steps};
pub(super) use kernels::kernels;

use alloc::string::String;
use alloc::vec::Vec;

/// No more failures of a group are kept (of spans: of a kernel, of a loop): one fault shows in many cases.
pub(super) const FAILURES: usize = 4;

/// Cases tried, and those that failed.
#[derive(Debug, Default)]
pub(super) struct Tally {
    pub(super) cases: u64,
    /// One line for each, the first [`FAILURES`] of them.
    pub(super) failures: Vec<String>,
}

impl Tally {
    /// One case more; `line` says what is wrong if it is not right.
    pub(super) fn check(&mut self, right: bool, line: impl FnOnce() -> String) {
        self.cases += 1;
        if !right && self.failures.len() < FAILURES {
            self.failures.push(line());
        }
    }

    /// Adds another's cases and all its failures.
    fn append(&mut self, mut other: Self) {
        self.cases += other.cases;
        self.failures.append(&mut other.failures);
    }
}
