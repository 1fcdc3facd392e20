//! Animations on disk: GIF, animated PNG, and Y4M. Files are never half-written: see
//! [`AtomicFile`](mode13h::export::AtomicFile).

mod apng;
mod chunk;
mod color_table;
mod difference;
mod error;
mod frame_rate;
mod gif;
mod gif_file;
mod gif_frame;
mod y4m;

pub use self::gif::{Film, GifWriter};
pub use apng::{ApngFile, ApngFrame, FilmColors};
pub use error::{AnimationError, AnimationErrorKind};
pub use frame_rate::FrameRate;
pub use gif_file::GifFile;
pub use gif_frame::GifFrame;
pub use y4m::{y4m_frame, y4m_header};
