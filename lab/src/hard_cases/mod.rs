//! Hard cases as pictures: the right way beside the fault that it guards against, enlarged 16 times, with pixel centres
//! and true edges.
//!
//! | file | what |
//! |---|---|
//! | [`CASES`], `cases/` | the table of cases: a row for each, and what it draws |
//! | `engine` | the right side: the engine's own calls |
//! | `fault/` | the wrong side: small implementations of the faults, used only here |
//! | `face`, [`Panel`] | their common input and output: faces; bytes, write counts and marks |
//! | `enlarged` | pixels enlarged, with centres and edges |
//! | `sheet` | the two side by side as a picture, with captions |
//!
//! ```
//! let case = mode13h_lab::hard_cases::by_id("r5").ok_or("no such case")?;
//! let comparison = case.draw();
//! assert!(comparison.right.writes().iter().all(|writes| *writes <= 1));
//! assert_ne!(comparison.fault, comparison.right);
//! let png: Vec<u8> = case.png()?;
//! # assert!(!png.is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod cases;
mod engine;
mod enlarged;
mod face;
mod fault;
mod panel;
mod sheet;

pub use cases::CASES;
pub use engine::Triangle;
pub use face::Segment;
pub use panel::{Mark, Panel};

use mode13h::export::PictureError;
use mode13h::palette::Palette;

/// A hard case with a picture.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Case {
    /// The id in the list of hard cases, such as `R5`.
    pub id: &'static str,
    /// Title: the difficulty in a few words.
    pub title: &'static str,
    /// One sentence on what the picture shows.
    pub sentence: &'static str,
    /// The fault on the left side.
    pub wrong: &'static str,
    /// The engine's way instead.
    pub right: &'static str,
    build: fn() -> Comparison,
}

/// Both sides of a picture.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Comparison {
    /// Drawn with the fault, with wrong pixels marked.
    pub fault: Panel,
    /// Drawn by the engine.
    pub right: Panel,
    /// Triangles passed to the engine's raster, in order.
    pub triangles: Vec<Triangle>,
    /// True if depth decides which face a pixel shows, so that faces may hide each other.
    pub depth_tested: bool,
    /// The true edges.
    pub outline: Vec<Segment>,
    /// Colours of the bytes.
    pub palette: &'static Palette,
}

impl Case {
    /// Draws both sides.
    #[must_use]
    pub fn draw(&self) -> Comparison {
        (self.build)()
    }

    /// The picture as the bytes of an indexed PNG.
    ///
    /// # Errors
    /// There is not enough memory.
    pub fn png(&self) -> Result<Vec<u8>, PictureError> {
        sheet::png(self, &self.draw())
    }
}

/// The case with an id, in upper or lower case.
#[must_use]
pub fn by_id(id: &str) -> Option<&'static Case> {
    CASES.iter().find(|case| case.id.eq_ignore_ascii_case(id))
}
