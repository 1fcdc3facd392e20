//! What accuracy costs: every shading's error against the [`truth`](crate::truth), and its time.
//!
//! | file | what |
//! |---|---|
//! | `probe` | what a renderer shows, pixel by pixel |
//! | `study` | what a study found out, in numbers |
//! | `measure` | a study from beginning to end |
//! | `way` | what is measured against each other: shadings, budgets, and what else may be chosen |
//! | `judge`, `entries` | errors against each standard of truth; what ramp or palette adds |
//! | `clock`, `contest`, `split` | times, all ways side by side; where the time goes |
//! | `claims` | what the sources claim, measured |
//! | `statistics` | quartiles, ratios, and what chance makes of them |
//! | `report` | a study as an HTML file and charts |

mod accuracy;
mod claims;
mod clock;
mod configuration;
mod error;
mod interleaved;
mod measure;
mod probe;
mod quantization;
pub mod report;
mod split;
mod statistics;
mod study;

pub use clock::Clock;
pub use configuration::BUDGETS;
pub use error::CostError;
pub use interleaved::Samples;
pub use measure::{Settings, Step, Subject, budgets_are_kept, measure, warnings};
pub use probe::{Probe, ProbeError};
pub use study::{Aspect, BudgetRow, Claim, Errors, Host, Nanoseconds, OptionRow, ShadingRow, Split, Study, Verdict};
