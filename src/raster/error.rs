//! The error for frames, depth buffers and vertices that the raster rejects.

use core::fmt;

use crate::fixed::{I24F8, U8F8};

/// The maximum number of columns or rows of a frame.
pub(super) const MAX_SIDE: u32 = 4096;

/// A frame, depth buffer or vertex that the raster rejects.
#[derive(Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum RasterError {
    /// Width or height is 0 or above 4,096.
    Size {
        /// The number of columns requested.
        width: u32,
        /// The number of rows requested.
        height: u32,
    },
    /// The pitch is less than the width.
    Pitch {
        /// The number of bytes from one row to the next.
        pitch: usize,
        /// The number of columns.
        width: u32,
    },
    /// The band of rows is empty or reaches beyond the frame.
    Band {
        /// The first row of the band.
        first: u32,
        /// The row after the band's last.
        end: u32,
        /// The number of rows of the frame.
        height: u32,
    },
    /// There are fewer bytes than the rows need.
    Short {
        /// The number of bytes given.
        given: usize,
        /// The number of bytes needed.
        needed: usize,
    },
    /// There are fewer depths than the frame's columns times the rows it holds.
    Depths {
        /// The number of depths given.
        given: usize,
        /// The number of depths needed.
        needed: usize,
    },
    /// A coordinate lies outside the guard band of ±4,096 pixels.
    OutsideGuardBand {
        /// The vertex's x.
        x: I24F8,
        /// The vertex's y.
        y: I24F8,
    },
    /// The shade is above 255.0, where the rounding to the nearest byte would wrap.
    ShadeAbove255 {
        /// The shade.
        shade: U8F8,
    },
}

impl fmt::Display for RasterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { width, height } => {
                write!(f, "a frame of {width} × {height} pixels: each side must be 1 to {}", MAX_SIDE)
            }
            Self::Pitch { pitch, width } => write!(f, "a pitch of {pitch} bytes is less than the width, {width}"),
            Self::Band { first, end, height } => {
                write!(f, "rows {first} to {end} are not a band of a frame of {height} rows")
            }
            Self::Short { given, needed } => write!(f, "{given} bytes given for a frame that needs {needed}"),
            Self::Depths { given, needed } => write!(f, "{given} depths given for a frame that needs {needed}"),
            Self::OutsideGuardBand { x, y } => write!(
                f,
                "vertex at ({}, {}) / 256 pixels lies outside the guard band of 4,096 pixels",
                x.to_bits(),
                y.to_bits()
            ),
            Self::ShadeAbove255 { shade } => {
                write!(f, "vertex shade {:#06x} is above 0xff00 (255.0)", shade.to_bits())
            }
        }
    }
}

crate::errors::error_type!(RasterError);
