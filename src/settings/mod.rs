//! Drawing options: shadings, error budgets, hidden-surface methods, texture mappings, and one struct of all of them,
//! used by scenes and renderers.

#[cfg(feature = "alloc")]
mod options;
mod shading;

#[cfg(feature = "alloc")]
pub use self::options::{Accuracy, HiddenSurfaces, Settings, VertexPath};
pub use self::shading::Shading;
#[cfg(feature = "alloc")]
pub use crate::mapping::Mapping;
#[cfg(feature = "alloc")]
pub use crate::span::dither::{DitherPattern, ThresholdRow, Thresholds};
