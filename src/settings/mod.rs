//! How to draw: the shadings, error budgets, ways to hidden surfaces and textures, and one struct of them all, for a scene
//! and for a renderer alike.

#[cfg(feature = "alloc")]
mod options;
mod shading;

#[cfg(feature = "alloc")]
pub use self::options::{Accuracy, HiddenSurfaces, Settings, VertexPath};
pub use self::shading::Shading;
#[cfg(feature = "alloc")]
pub use crate::mapping::Mapping;
#[cfg(feature = "alloc")]
pub use crate::span::dither::DitherPattern;
