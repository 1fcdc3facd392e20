//! One triangle in integers: the definition of every byte and depth.
//!
//! `batches` draws eight triangles at a time, in floats that are proved and tested to
//! round to these integers. This draws one, and is used where that is slower or impossible: by
//! [`Raster::triangle`](super::Raster::triangle), for triangles beyond 2¹⁸ pixels, on processors
//! without floating point, where an estimate cannot decide, and by tests.
//!
//! | file | what it defines |
//! |---|---|
//! | [`edge`], [`cover`] | the fill rule: which pixels a triangle covers |
//! | [`quotient`] | exact floors by one reciprocal per divisor |
//! | [`shade`], [`fixed16`], [`hyperbolic`], `float` | the shade at a pixel, for each [`Interpolation`](super::Interpolation) |
//! | `weights` | how much a corner counts at a pixel |
//! | [`depth`] | the depth at a pixel |
//! | `texture`, `level` | the texture coordinates at a pixel, and the level of a mipmap |

pub(crate) mod cover;
pub(crate) mod depth;
pub(crate) mod edge;
pub(crate) mod fixed16;
#[cfg(feature = "alloc")]
pub(crate) mod float;
pub(crate) mod hyperbolic;
#[cfg(feature = "alloc")]
pub(super) mod level;
pub(crate) mod quotient;
pub(crate) mod shade;
#[cfg(feature = "alloc")]
pub(super) mod texture;
pub(super) mod weights;
