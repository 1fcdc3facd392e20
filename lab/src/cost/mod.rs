//! The cost of accuracy: every shading's error against the [`truth`](crate::truth), and its time.
//!
//! | file | what |
//! |---|---|
//! | `probe` | the pixels that a renderer shows |
//! | `study` | the results of a study, in numbers |
//! | `measure` | a study from beginning to end |
//! | `configuration` | what is measured against each other: shadings, budgets and the other choices |
//! | `accuracy`, `quantization` | errors against each standard of truth; errors added by ramp or palette |
//! | `error_levels` | the colours of an error map |
//! | `clock`, `interleaved`, `split` | times of all configurations, interleaved; the parts of a frame's time |
//! | `timed` | frames against the clock: the least error that fits in a time |
//! | `claims` | the sources' claims, measured |
//! | `promises` | what the engine guarantees, and the verdicts |
//! | `statistics` | quartiles, ratios and confidence intervals |
//! | `report` | a study as an HTML file and charts |

mod accuracy;
mod claims;
mod clock;
mod configuration;
mod error;
pub mod error_levels;
mod interleaved;
mod measure;
mod probe;
mod promises;
mod quantization;
#[cfg(feature = "report")]
pub mod report;
mod split;
mod statistics;
mod study;
mod timed;

pub use clock::Clock;
pub use configuration::BUDGETS;
pub use error::CostError;
pub use interleaved::Samples;
pub use measure::{Settings, Step, Subject, measure};
pub use probe::{Probe, ProbeError};
pub use promises::{promises_are_kept, ties, warnings};
pub use study::{
    Aspect, BudgetRow, Claim, Errors, Host, Nanoseconds, OptionRow, ShadingRow, Split, Study, TimeRow, Verdict,
};
pub use timed::{calibrate, time_frame};
