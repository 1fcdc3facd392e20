//! Cost of accuracy: every shading's error against the [`truth`](crate::truth), and its time.
//!
//! | file | what |
//! |---|---|
//! | `probe` | the pixels that a renderer shows |
//! | `study` | the results of a study, in numbers |
//! | `measure` | a study from beginning to end |
//! | `configuration` | the things that are measured against each other: shadings, budgets, and the other choices |
//! | `accuracy`, `quantization` | errors against each standard of truth; errors that ramp or palette add |
//! | `error_levels` | the colours of an error map |
//! | `clock`, `interleaved`, `split` | times, all configurations side by side; the parts of a frame's time |
//! | `timed` | frames against the clock: the least error that fits in a time |
//! | `claims` | the sources' claims, measured |
//! | `promises` | what the engine is held to, and the verdicts |
//! | `statistics` | quartiles, ratios, and their ranges by chance |
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
