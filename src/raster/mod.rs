//! The raster: from projected vertices to bytes, exact where it counts.
//!
//! A projected coordinate has been rounded once, to 1/256 pixel. From there on everything is integer, and **coverage is
//! exact**: a pixel is drawn if and only if its centre, at (x + ½, y + ½), lies inside the triangle or on a top or left
//! edge. Two triangles that share an edge leave no hole and draw no pixel twice. Shades stay **in range**: a byte lies
//! within `[(min + 128) >> 8, (max + 128) >> 8]` of its own triangle's vertices. Neither relies on clamping pixels:
//! edges are walked with quotient and remainder, and shades are rounded so that no sum can leave the range. One
//! [`Interpolation`] guarantees neither: [`GouraudVintage`](Interpolation::GouraudVintage), the one printed in the
//! sources.
//!
//! [`Raster`] draws shades, with or without a depth buffer. With an allocator, [`effects`] add textures, fog, glass,
//! dither and light at every pixel.
//!
//! ```
//! use mode13h::raster::{Frame, Raster, Interpolation, Vertex};
//!
//! let mut bytes = [0_u8; 8 * 4];
//! let mut raster = Raster::new(Frame::new(&mut bytes, 8, 4, 8)?);
//! let [a, b, c] = [Vertex::at(0.0, 0.0, 40.0), Vertex::at(8.0, 0.0, 200.0), Vertex::at(0.0, 4.0, 40.0)];
//! let drawn = raster.triangle(&[a, b, c], Interpolation::default());
//! assert_eq!(drawn.pixels, 16);
//! assert_eq!(&bytes[..8], &[50, 70, 90, 110, 130, 150, 170, 0]);
//! # Ok::<(), mode13h::raster::RasterError>(())
//! ```

// The files, in the order in which a triangle passes through them:
//
// | file | what |
// |---|---|
// | `vertex` | the input: a `Vertex` is checked on construction |
// | `clip` | clipping before the projection, and the triangles that remain |
// | `frame` | the bytes, whole or in bands of rows; the clip rectangle |
// | `fill_rule` | which pixels belong to a triangle |
// | `reference` | one triangle in integers, the definition: which pixels, which byte, which depth |
// | `interpolation`, `row_shader` | the list of shadings, and the bytes of a row by each |
// | `vintage` | coverage and shades as the sources print them |
// | `depth` | depth buffers |
// | `shade_trace` | start, step and sum of a single pixel, for inspection |
// | `triangle` | one triangle from vertices to bytes: `Raster::triangle` |
// | `columns`, `pick`, `cull`, `setup`, `rows`, `batches` | many triangles at a time, by indices into columns of vertex values |
// | `shaded`, `setup_texture` | set-up and rows of other shadings than 8.8, and of textures |
// | `effects` | texture, fog, channels, blending, dither, light at every pixel: stages over spans |
// | `triangles` | many triangles given as vertices, `Raster::triangles`, or by index, `Raster::indexed` |
// | `scan_line` | a whole frame of triangles, each pixel written once |

pub(crate) mod batches;
pub(crate) mod clip;
pub(crate) mod columns;
pub(crate) mod cull;
pub(crate) mod depth;
mod draw_stats;
#[cfg(feature = "embedded-graphics")]
mod draw_target;
#[cfg(feature = "alloc")]
pub mod effects;
mod error;
pub(crate) mod fill_rule;
pub(crate) mod frame;
pub(crate) mod interpolation;
pub(crate) mod pick;
pub(crate) mod reference;
mod row_shader;
mod rows;
#[cfg(feature = "alloc")]
pub(crate) mod scan_line;
mod setup;
#[cfg(feature = "alloc")]
mod setup_texture;
#[cfg(feature = "alloc")]
pub(crate) mod shade_trace;
pub(crate) mod shaded;
pub(crate) mod triangle;
pub(crate) mod triangles;
pub(crate) mod vertex;
pub(crate) mod vintage;

#[cfg(feature = "alloc")]
pub use depth::DepthMemory;
pub use depth::{Cell, DepthBuffer};
pub use draw_stats::DrawStats;
#[cfg(feature = "embedded-graphics")]
pub use draw_target::Index;
#[cfg(all(feature = "embedded-graphics", feature = "window"))]
pub(crate) use draw_target::clipped;
pub use error::RasterError;
pub use frame::{Frame, Rect};
pub use interpolation::Interpolation;
pub use triangle::Raster;
pub use triangles::VertexTable;
pub use vertex::Vertex;
