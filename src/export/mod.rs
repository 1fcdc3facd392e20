//! Pictures on disk: the frame as an indexed PNG, true colour, films, and files that are never half-written.
//!
//! Every file goes through [`write_atomically`]: it is written beside its name and then renamed, so a file that stood
//! under the name before is whole until the new one is.

#[cfg(feature = "png")]
mod apng;
mod atomic;
#[cfg(feature = "png")]
mod chunk;
#[cfg(any(feature = "gif", feature = "png"))]
mod color_table;
#[cfg(any(feature = "gif", feature = "png"))]
mod difference;
#[cfg(any(feature = "gif", feature = "png"))]
mod frame_rate;
#[cfg(feature = "gif")]
mod gif;
#[cfg(feature = "gif")]
mod gif_file;
#[cfg(feature = "gif")]
mod gif_frame;
#[cfg(any(feature = "png", feature = "gif"))]
mod picture;
#[cfg(feature = "png")]
mod png_file;
#[cfg(any(feature = "png", feature = "gif"))]
mod scale;
#[cfg(any(feature = "png", feature = "gif"))]
mod y4m;

#[cfg(feature = "png")]
pub use self::apng::{ApngFile, ApngFrame, FilmColors};
#[cfg(feature = "gif")]
pub use self::gif::{Film, GifError, GifWriter};
pub use atomic::{ExportError, ExportErrorKind, check_writable, write_atomically};
#[cfg(any(feature = "gif", feature = "png"))]
pub use frame_rate::FrameRate;
#[cfg(feature = "gif")]
pub use gif_file::GifFile;
#[cfg(feature = "gif")]
pub use gif_frame::GifFrame;
#[cfg(any(feature = "png", feature = "gif"))]
pub use picture::{MAX_SIDE, Picture, PictureError, PixelShape};
#[cfg(feature = "png")]
pub use png_file::{Png, png};
#[cfg(any(feature = "png", feature = "gif"))]
pub use scale::Scale;
#[cfg(any(feature = "png", feature = "gif"))]
pub use y4m::{y4m_frame, y4m_header};
