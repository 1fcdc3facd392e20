//! Explains a pixel's byte: all the way from three corners to a palette entry, in numbers.
//!
//! | file | what |
//! |---|---|
//! | `face` | a triangle at the pixel: its corners, its edges, who owns a tie, its fate |
//! | `pixel` | [`pixel()`]: everything about one pixel |
//! | `trace`, `one_pixel` | the triangles at the pixel, and which is seen; its byte, stage by stage |
//! | `text`, `span_text`, `paragraph` | the explanation in words |
//! | `registers` | [`Registers`]: what the loop of 1994 holds at a pixel |
//! | `row` | [`row()`]: a row's intensity and its slope, as drawn and true |
//!
//! The bytes are the rasterizer's own: every face is drawn again, clipped to the one pixel, and the byte of a stage is
//! what is drawn without the later stages. Starts, steps and sums come from the planes that the loops start from
//! ([`internals::ShadeTrace`](mode13h::internals::ShadeTrace)). So the explanation agrees with the frame for every
//! shading, kernel, hidden-surface method and effect.
//!
//! ```
//! use mode13h_lab::explain;
//! use mode13h::mesh::shapes;
//! use mode13h::render::{Renderer, Screen};
//! use mode13h::scene::Scene;
//!
//! let scene = Scene::showing(shapes::torus(48, 24));
//! let pixel = explain::pixel(&mut Renderer::new(), &scene, Screen::MODE_13H, 120, 60)?;
//! println!("{pixel}");
//! let seen = pixel.seen.first().expect("the torus is there");
//! assert_eq!(seen.stages.last().and_then(|stage| stage.byte()), Some(pixel.byte));
//! # Ok::<(), explain::ExplainError>(())
//! ```

mod edge;
mod face;
mod one_pixel;
mod paragraph;
mod pixel;
mod registers;
mod row;
mod span_text;
mod text;
mod trace;

use crate::cost::ProbeError;
use crate::truth::TruthError;
pub use edge::{Edge, EdgeKind};
pub use face::FaceHere;
pub use mode13h::internals::{Accumulator, Progression, Ratio, ShadeTrace};
use mode13h::raster::Frame;
use mode13h::render::{RenderError, Screen};
pub use one_pixel::ShadedBy;
pub use pixel::{Against, Pixel, PixelStage, Seen, pixel};
pub use registers::Registers;
pub use row::{Column, Row, row};
pub use trace::Fate;

/// Error of explaining a pixel or a row.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExplainError {
    /// The pixel lies outside the frame.
    #[error("there is no pixel ({x}, {y}) in a frame of {width} x {height}, counted from 0")]
    OutsidePixel {
        /// Its column.
        x: u32,
        /// Its row.
        y: u32,
        /// Number of columns in the frame.
        width: u32,
        /// Number of rows in the frame.
        height: u32,
    },
    /// The row lies outside the frame.
    #[error("there is no row {y} in a frame of {height} rows, counted from 0")]
    OutsideRow {
        /// The row.
        y: u32,
        /// Number of rows in the frame.
        height: u32,
    },
    /// There is no frame of this size.
    #[error("a frame's sides must be 1 to {} pixels", Frame::MAX_SIDE)]
    Screen,
    /// The scene cannot be drawn.
    #[error(transparent)]
    Scene(RenderError),
    /// The truth cannot be drawn.
    #[error(transparent)]
    Truth(TruthError),
    /// The pixels shown cannot be identified.
    #[error(transparent)]
    Probe(ProbeError),
}

/// Checks that there is a frame of this size.
fn check(screen: Screen) -> Result<(), ExplainError> {
    let side = 1..=Frame::MAX_SIDE;
    if side.contains(&screen.width) && side.contains(&screen.height) { Ok(()) } else { Err(ExplainError::Screen) }
}
