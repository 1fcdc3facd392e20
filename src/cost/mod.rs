//! What accuracy costs: every rung's error against the [`truth`](crate::truth), and its time.
//!
//! | file | what |
//! |---|---|
//! | `probe` | what a renderer shows, pixel by pixel |
//! | `study` | what a study found out, in numbers |

mod probe;
mod study;

pub use probe::{Probe, ProbeError};
pub use study::{Aspect, BudgetRow, Claim, Errors, Host, Nanoseconds, OptionRow, RungRow, Split, Study, Verdict};
