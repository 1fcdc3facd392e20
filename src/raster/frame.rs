//! The bytes that are drawn into: a frame of any size, whole or in bands of rows.

use core::ops::Range;

use super::error::{self, RasterError};
use crate::vga::Vga;

/// A rectangle of pixels: `x0 ≤ x < x1`, `y0 ≤ y < y1`. Empty if an end is not after its start.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct Rect {
    /// First column.
    pub x0: u32,
    /// First row.
    pub y0: u32,
    /// The column after the last.
    pub x1: u32,
    /// The row after the last.
    pub y1: u32,
}

impl Rect {
    /// An empty rectangle whose hull with another is the other.
    #[cfg(feature = "alloc")]
    pub(crate) const NOWHERE: Self = Self { x0: u32::MAX, y0: u32::MAX, x1: 0, y1: 0 };
    /// A rectangle that contains every frame.
    #[cfg(feature = "alloc")]
    pub(crate) const EVERYWHERE: Self = Self { x0: 0, y0: 0, x1: u32::MAX, y1: u32::MAX };

    /// The intersection of both rectangles.
    #[must_use]
    pub fn intersection(self, other: Self) -> Self {
        Self {
            x0: self.x0.max(other.x0),
            y0: self.y0.max(other.y0),
            x1: self.x1.min(other.x1),
            y1: self.y1.min(other.y1),
        }
    }

    /// The smallest rectangle that contains both. The corners of an empty one count too.
    #[cfg(feature = "alloc")]
    pub(crate) fn hull(self, other: Self) -> Self {
        Self {
            x0: self.x0.min(other.x0),
            y0: self.y0.min(other.y0),
            x1: self.x1.max(other.x1),
            y1: self.y1.max(other.y1),
        }
    }

    /// Returns whether it contains no pixel.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.x0 >= self.x1 || self.y0 >= self.y1
    }
}

/// A frame of bytes, row-major, borrowed from their owner. It may hold all rows or a band of them; coordinates are
/// always those of the whole frame, and drawing in bands gives the same bytes as drawing the whole.
#[derive(Debug)]
pub struct Frame<'a> {
    pixels: &'a mut [u8],
    width: u32,
    height: u32,
    pitch: usize,
    rows: Range<u32>,
}

impl<'a> Frame<'a> {
    /// The maximum number of columns or rows.
    pub const MAX_SIDE: u32 = error::MAX_SIDE;

    /// A whole frame of `width × height` pixels whose rows lie `pitch` bytes apart.
    ///
    /// # Errors
    /// A side of 0 or above 4,096, a pitch below the width, too few bytes.
    pub fn new(pixels: &'a mut [u8], width: u32, height: u32, pitch: usize) -> Result<Self, RasterError> {
        Self::band(pixels, width, height, pitch, 0..height)
    }

    /// The band `rows` of a frame of `width × height`: `pixels` holds only those rows. A microcontroller with 5 KiB to
    /// spare draws 320 × 200 as thirteen bands.
    ///
    /// # Errors
    /// The errors of [`new`](Self::new); a band that is empty or reaches beyond the frame.
    pub fn band(
        pixels: &'a mut [u8],
        width: u32,
        height: u32,
        pitch: usize,
        rows: Range<u32>,
    ) -> Result<Self, RasterError> {
        let side = 1..=Self::MAX_SIDE;
        if !side.contains(&width) || !side.contains(&height) {
            return Err(RasterError::Size { width, height });
        }
        if pitch < width as usize {
            return Err(RasterError::Pitch { pitch, width });
        }
        if rows.start >= rows.end || rows.end > height {
            return Err(RasterError::Band { first: rows.start, end: rows.end, height });
        }
        // The last row needs only its pixels. Saturating: a pitch may be any usize.
        let needed = pitch.saturating_mul((rows.end - rows.start - 1) as usize).saturating_add(width as usize);
        if pixels.len() < needed {
            return Err(RasterError::Short { given: pixels.len(), needed });
        }
        Ok(Self { pixels, width, height, pitch, rows })
    }

    /// The width in pixels.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// The number of rows of the whole frame.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The rows that it holds.
    #[must_use]
    pub fn rows(&self) -> Range<u32> {
        self.rows.clone()
    }

    /// The rectangle of the pixels that it holds.
    #[must_use]
    pub fn bounds(&self) -> Rect {
        Rect { x0: 0, y0: self.rows.start, x1: self.width, y1: self.rows.end }
    }

    /// The pixels of row `y`, or `None` if the frame does not hold it.
    #[must_use]
    #[inline]
    pub fn row(&self, y: u32) -> Option<&[u8]> {
        let start = self.offset_of(y)?;
        self.pixels.get(start..start + self.width as usize)
    }

    /// The pixels of row `y` to draw into, or `None` if the frame does not hold it.
    #[must_use]
    #[inline]
    pub fn row_mut(&mut self, y: u32) -> Option<&mut [u8]> {
        let start = self.offset_of(y)?;
        self.pixels.get_mut(start..start + self.width as usize)
    }

    /// The pixels from column `x` of row `y` to the end, or `None` if the frame does not hold the row.
    #[inline]
    pub(super) fn starting_at(&mut self, x: usize, y: u32) -> Option<&mut [u8]> {
        let start = self.offset_of(y)?.checked_add(x)?;
        self.pixels.get_mut(start..)
    }

    /// All pixels that it holds, and the bytes from one row to the next.
    #[inline]
    pub(super) fn pixels_mut(&mut self) -> (&mut [u8], usize) {
        (self.pixels, self.pitch)
    }

    /// Sets every pixel that it holds to `index`; bytes between the rows are left alone.
    ///
    /// This hides the method of the same name that `embedded-graphics` has for its colours.
    pub fn clear(&mut self, index: u8) {
        let (width, rows) = (self.width as usize, self.rows.len());
        if self.pitch == width {
            // All rows at once. In range, as for `offset_of`.
            if let Some(pixels) = self.pixels.get_mut(..width * rows) {
                pixels.fill(index);
            }
            return;
        }
        for y in self.rows() {
            if let Some(row) = self.row_mut(y) {
                row.fill(index);
            }
        }
    }

    /// Borrows the frame for a shorter time.
    pub fn reborrow(&mut self) -> Frame<'_> {
        Frame { pixels: self.pixels, rows: self.rows.clone(), ..*self }
    }

    /// Splits the frame into bands of `rows_each` rows (at least 1); the last may be shorter.
    pub fn bands(&mut self, rows_each: u32) -> impl Iterator<Item = Frame<'_>> {
        let (width, height, pitch, rows) = (self.width, self.height, self.pitch, self.rows.clone());
        let rows_each = rows_each.clamp(1, Self::MAX_SIDE);
        // The last chunk may lack the bytes after the last pixel; it still holds `width` bytes.
        let chunks = self.pixels.chunks_mut(pitch.saturating_mul(rows_each as usize));
        chunks.take(rows.len().div_ceil(rows_each as usize)).zip(0..).filter_map(move |(pixels, band)| {
            let first = rows.start + band * rows_each;
            Frame::band(pixels, width, height, pitch, first..(first + rows_each).min(rows.end)).ok()
        })
    }

    #[inline]
    fn offset_of(&self, y: u32) -> Option<usize> {
        // In range: `band` has checked the last row.
        self.rows.contains(&y).then(|| (y - self.rows.start) as usize * self.pitch)
    }
}

impl<'a> From<&'a mut Vga> for Frame<'a> {
    /// The 320 × 200 pixels that the machine shows. Taking them counts as a change of its memory.
    fn from(vga: &'a mut Vga) -> Self {
        Frame {
            pixels: vga.pixels_mut(),
            width: Vga::WIDTH as u32,
            height: Vga::HEIGHT as u32,
            pitch: Vga::PITCH,
            rows: 0..Vga::HEIGHT as u32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_that_cannot_be_are_refused() {
        let mut bytes = [0_u8; 64];
        assert!(matches!(Frame::new(&mut bytes, 0, 4, 8), Err(RasterError::Size { .. })));
        assert!(matches!(Frame::new(&mut bytes, 4, 4097, 8), Err(RasterError::Size { .. })));
        assert!(matches!(Frame::new(&mut bytes, 8, 4, 7), Err(RasterError::Pitch { .. })));
        assert!(matches!(Frame::new(&mut bytes, 8, 9, 8), Err(RasterError::Short { given: 64, needed: 72 })));
        assert!(matches!(Frame::new(&mut bytes, 8, 2, usize::MAX), Err(RasterError::Short { .. })));
        assert!(matches!(Frame::band(&mut bytes, 8, 4, 8, 2..2), Err(RasterError::Band { .. })));
        assert!(matches!(Frame::band(&mut bytes, 8, 4, 8, 2..5), Err(RasterError::Band { .. })));
        assert!(Frame::new(&mut bytes, 1, 8, 9).is_ok(), "the last row needs only its pixels");
    }

    #[test]
    fn one_band_may_be_as_high_as_any_number_says() {
        let mut bytes = [0; 64];
        let mut frame = Frame::band(&mut bytes, 8, 8, 8, 2..8).expect("legal");
        for rows_each in [6, 4096, u32::MAX - 1, u32::MAX] {
            let mut bands = frame.bands(rows_each).map(|band| band.rows());
            assert_eq!((bands.next(), bands.next()), (Some(2..8), None), "{rows_each}");
        }
    }

    /// Clearing changes neither the bytes between rows nor those after the last, whether or not rows adjoin.
    #[test]
    fn clearing_leaves_all_other_bytes_alone() {
        for pitch in 7..10 {
            for rows in [0..6, 0..1, 2..5] {
                let mut bytes = [1_u8; 9 * 6 + 20];
                let count = rows.len();
                Frame::band(&mut bytes, 7, 6, pitch, rows).expect("legal").clear(5);
                for (at, byte) in bytes.into_iter().enumerate() {
                    let is_pixel = at % pitch < 7 && at / pitch < count;
                    assert_eq!(byte, if is_pixel { 5 } else { 1 }, "byte {at} of {count} rows with pitch {pitch}");
                }
            }
        }
    }

    #[test]
    fn bands_hold_each_row_once() {
        let mut bytes = [0_u8; 10 * 7 - 3];
        let mut frame = Frame::new(&mut bytes, 7, 7, 10).expect("legal");
        for mut band in frame.bands(3) {
            for y in band.rows() {
                for byte in band.row_mut(y).expect("held") {
                    *byte += 1 + y as u8;
                }
            }
        }
        for y in 0..7 {
            assert_eq!(frame.row(y), Some(&[1 + y as u8; 7][..]));
        }
        assert_eq!(frame.row(7), None);
    }
}
