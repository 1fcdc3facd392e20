//! Errors of a study.

use core::fmt;

use super::ProbeError;
use crate::truth::TruthError;
use mode13h::render::RenderError;

/// Error of a study.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum CostError {
    /// The scene cannot be drawn.
    Scene(RenderError),
    /// The pixels that the renderer shows cannot be identified.
    Probe(ProbeError),
    /// The truth of the scene cannot be computed.
    Truth(TruthError),
    /// There is no frame to study.
    NoFrames,
}

impl fmt::Display for CostError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene(error) => error.fmt(f),
            Self::Probe(error) => error.fmt(f),
            Self::Truth(error) => error.fmt(f),
            Self::NoFrames => f.write_str("there is no frame to draw"),
        }
    }
}

impl core::error::Error for CostError {}

impl From<RenderError> for CostError {
    fn from(error: RenderError) -> Self {
        Self::Scene(error)
    }
}

impl From<ProbeError> for CostError {
    fn from(error: ProbeError) -> Self {
        Self::Probe(error)
    }
}

impl From<TruthError> for CostError {
    fn from(error: TruthError) -> Self {
        Self::Truth(error)
    }
}
