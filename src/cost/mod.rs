//! What accuracy costs: the engine's own frames, to be measured against the [`truth`](crate::truth).

mod probe;

pub use probe::{Probe, ProbeError};
