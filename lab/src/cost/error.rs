//! Errors of a study.

use super::ProbeError;
use crate::truth::TruthError;
use mode13h::render::RenderError;

/// Error of a study.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CostError {
    /// The scene cannot be drawn.
    #[error(transparent)]
    Scene(#[from] RenderError),
    /// The pixels that the renderer shows cannot be identified.
    #[error(transparent)]
    Probe(#[from] ProbeError),
    /// The truth of the scene cannot be computed.
    #[error(transparent)]
    Truth(#[from] TruthError),
    /// There is no frame to study.
    #[error("there is no frame to draw")]
    NoFrames,
}
