//! Pictures on disk: the frame as an indexed PNG or in true colour; files that are never half-written.
//!
//! Every file goes through an [`AtomicFile`]: it is written under a temporary name and then
//! renamed, so a previous file of that name stays intact until the new one is complete.

mod atomic;
#[cfg(any(feature = "png", feature = "window"))]
pub(crate) mod picture;
#[cfg(feature = "png")]
mod png_file;
#[cfg(feature = "png")]
mod scale;

pub use atomic::{AtomicFile, ExportError, ExportErrorKind, check_writable, write_atomically};
#[cfg(any(feature = "png", feature = "window"))]
pub use picture::{MAX_SIDE, Picture, PictureError, PixelShape};
#[cfg(feature = "png")]
pub use png_file::{Png, png};
#[cfg(feature = "png")]
pub use scale::{Scale, Scaled};
