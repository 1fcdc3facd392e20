//! Pictures for the exporters: bytes, size, palette, and the shape of a pixel.

use std::fmt;

use crate::palette::{Palette, Rgb};

/// The longest side of an exported picture, in pixels.
pub const MAX_SIDE: u16 = 16_384;

/// The aspect ratio of a pixel.
#[derive(Clone, Copy, Hash, Debug, PartialEq, Eq)]
pub struct PixelShape {
    /// Width, in the same unit as the height; at least 1.
    pub width: u16,
    /// Height; at least 1.
    pub height: u16,
}

/// A square pixel.
impl Default for PixelShape {
    fn default() -> PixelShape {
        PixelShape { width: 1, height: 1 }
    }
}

impl PixelShape {
    /// 5:6, which makes 320 × 200 pixels a 4:3 screen.
    pub const MODE_13H: PixelShape = PixelShape { width: 5, height: 6 };
}

/// A picture of palette indices for export.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    /// Palette indices, row by row, `pitch` bytes from one row to the next.
    pub pixels: &'a [u8],
    /// The number of pixels in a row, 1 to 16,384.
    pub width: usize,
    /// The number of rows, 1 to 16,384.
    pub height: usize,
    /// The number of bytes from the start of one row to the start of the next, at least `width`.
    pub pitch: usize,
    /// The colours of the indices.
    pub palette: &'a [Rgb; 256],
    /// The shape of one pixel.
    pub shape: PixelShape,
}

impl<'a> Picture<'a> {
    /// The 320 × 200 visible bytes of mode 13h in the colours of `palette`, with all eight bits; the card shows only
    /// six (see [`Palette::on_dac`]).
    pub fn mode_13h(pixels: &'a [u8], palette: &'a Palette) -> Picture<'a> {
        Picture { pixels, width: 320, height: 200, pitch: 320, palette: palette.colors(), shape: PixelShape::MODE_13H }
    }

    /// Square pixels in consecutive rows of `width`, in the colours of `palette`. Bytes after the last complete row are
    /// ignored.
    pub fn of(pixels: &'a [u8], width: usize, palette: &'a Palette) -> Picture<'a> {
        let height = pixels.len().checked_div(width).unwrap_or(0);
        Picture { pixels, width, height, pitch: width, palette: palette.colors(), shape: PixelShape::default() }
    }

    /// Checks that the sizes are consistent with each other and with the number of bytes.
    pub fn check(&self) -> Result<(), PictureError> {
        let limit = 1..=MAX_SIDE as usize;
        if !limit.contains(&self.width) || !limit.contains(&self.height) {
            return Err(PictureError::Size { width: self.width, height: self.height });
        }
        if self.shape.width == 0 || self.shape.height == 0 {
            return Err(PictureError::Shape(self.shape));
        }
        // The last row needs no padding after it.
        let needed = self.pitch.checked_mul(self.height - 1).and_then(|bytes| bytes.checked_add(self.width));
        match needed {
            Some(needed) if self.pitch >= self.width && needed <= self.pixels.len() => Ok(()),
            _ => Err(PictureError::Bytes { bytes: self.pixels.len(), pitch: self.pitch }),
        }
    }

    /// Row `y`, `width` bytes; empty beyond the picture.
    #[must_use]
    pub fn row(&self, y: usize) -> &'a [u8] {
        let first = y.checked_mul(self.pitch).filter(|_| y < self.height);
        let row = first.and_then(|first| self.pixels.get(first..));
        row.and_then(|row| row.get(..self.width)).unwrap_or_default()
    }
}

/// The pixel of `from` that contains the centre of pixel `at` of `to`: floor((at + ½) · from / to).
pub(crate) fn source(at: usize, to: usize, from: usize) -> usize {
    ((2 * at as u64 + 1) * from as u64 / (2 * to as u64)) as usize
}

/// The reason why a picture cannot be exported.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub enum PictureError {
    /// A side is 0 or above 16,384 pixels.
    Size {
        /// The number of pixels in a row.
        width: usize,
        /// The number of rows.
        height: usize,
    },
    /// A side of the pixels' shape is 0.
    Shape(PixelShape),
    /// The part asked for is not within the picture.
    Part {
        /// The number of pixels in a row of the picture.
        width: usize,
        /// The number of rows of the picture.
        height: usize,
    },
    /// There are fewer bytes than the rows need, or the rows overlap.
    Bytes {
        /// The number of bytes.
        bytes: usize,
        /// The pitch given.
        pitch: usize,
    },
    /// The text is not a [`Scale`](super::Scale).
    Scale,
    /// The picture does not fit in memory.
    Memory {
        /// The number of bytes requested.
        bytes: usize,
    },
}

impl fmt::Display for PictureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PictureError::Size { width, height } => {
                write!(f, "a picture of {width} x {height} pixels: each side must be 1 to {}", MAX_SIDE)
            }
            PictureError::Shape(shape) => {
                write!(f, "pixels of shape {} x {}: neither side may be 0", shape.width, shape.height)
            }
            PictureError::Part { width, height } => {
                write!(f, "the part is not within the picture of {width} x {height} pixels")
            }
            PictureError::Bytes { bytes, pitch } => {
                write!(f, "{bytes} bytes do not hold the picture's rows at a pitch of {pitch}")
            }
            PictureError::Scale => {
                write!(f, "a scale is 1, 2, 5x6, or a width and height of 1 to {MAX_SIDE} such as 640x480")
            }
            PictureError::Memory { bytes } => write!(f, "no memory for a picture of {bytes} bytes"),
        }
    }
}

crate::errors::error_type!(PictureError);
