//! Depth buffers. [`DepthPlane`](super::reference::depth::DepthPlane) defines the depth of a triangle at a pixel.

use super::error::RasterError;
use super::frame::Frame;
#[cfg(feature = "alloc")]
use super::frame::Rect;
pub(crate) use crate::span::depth::Cell;
use crate::span::depth::Cells;

/// A depth buffer over the rows of a frame: one u32 per pixel, or one u16 on small machines (`Cell` says what that
/// loses); greater is nearer, 0 is farthest. The caller owns the slice.
#[derive(Debug)]
pub struct DepthBuffer<'a, D: Cell = u32> {
    values: &'a mut [D],
    width: u32,
    first_row: u32,
}

impl<'a, D: Cell> DepthBuffer<'a, D> {
    /// Creates a depth buffer in `values` for the rows that `frame` holds. The values are left
    /// unchanged: [`clear`](Self::clear) sets them.
    ///
    /// # Errors
    /// `values` is shorter than columns × rows.
    pub fn new(values: &'a mut [D], frame: &Frame<'_>) -> Result<Self, RasterError> {
        let rows = frame.rows();
        let needed = frame.width() as usize * (rows.end - rows.start) as usize;
        let given = values.len();
        match values.get_mut(..needed) {
            Some(values) => Ok(Self { values, width: frame.width(), first_row: rows.start }),
            None => Err(RasterError::Depths { given, needed }),
        }
    }

    /// Sets every depth to the farthest.
    pub fn clear(&mut self) {
        self.values.fill(D::default());
    }

    /// Sets every depth in a rectangle that the buffer holds to the farthest.
    #[cfg(feature = "alloc")]
    pub(super) fn clear_within(&mut self, Rect { x0, y0, x1, y1 }: Rect) {
        // Whole rows are contiguous.
        if x1 - x0 == self.width {
            let (first, end) = ((y0 - self.first_row) * self.width, (y1 - self.first_row) * self.width);
            return self.values[first as usize..end as usize].fill(D::default());
        }
        for y in y0..y1 {
            if let Some(row) = self.row_mut(y) {
                row[x0 as usize..x1 as usize].fill(D::default());
            }
        }
    }

    /// Returns whether it was created for a frame of this width and these rows.
    pub(super) fn holds(&self, width: u32, rows: &core::ops::Range<u32>) -> bool {
        let values = u64::from(width) * u64::from(rows.end - rows.start);
        self.width == width && self.first_row == rows.start && self.values.len() as u64 == values
    }

    /// All values, row by row.
    #[inline]
    pub(super) fn cells(&mut self) -> Cells<'_> {
        D::cells(self.values)
    }

    /// The depths from column `x` of row `y` to the end of the buffer, or `None` if the buffer does not hold the row.
    #[cfg(feature = "alloc")]
    #[inline]
    pub(super) fn starting_at(&mut self, x: usize, y: u32) -> Option<&mut [D]> {
        let start = (y.checked_sub(self.first_row)? as usize).checked_mul(self.width as usize)?.checked_add(x)?;
        self.values.get_mut(start..)
    }

    /// The depths of row `y`, or `None` if the buffer does not hold it.
    #[must_use]
    #[inline]
    pub fn row_mut(&mut self, y: u32) -> Option<&mut [D]> {
        // The offset of a row far beyond the last may overflow usize on a 32-bit processor.
        let width = self.width as usize;
        let start = (y.checked_sub(self.first_row)? as usize).checked_mul(width)?;
        self.values.get_mut(start..start.checked_add(width)?)
    }
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::*;

    /// Cells outside the rectangle do not change, even where whole rows are cleared and in a band.
    #[test]
    fn a_rectangle_is_cleared_and_no_more() {
        for (x0, x1) in [(0, 5), (1, 4)] {
            let (mut pixels, mut values) = ([0_u8; 20], [7_u32; 20]);
            let band = Frame::band(&mut pixels, 5, 10, 5, 3..7).unwrap();
            let mut depth = DepthBuffer::new(&mut values, &band).unwrap();
            depth.clear_within(Rect { x0, y0: 4, x1, y1: 6 });
            for (at, value) in (0_u32..).zip(values) {
                let (x, y) = (at % 5, 3 + at / 5);
                let is_inside = (x0..x1).contains(&x) && (4..6).contains(&y);
                assert_eq!(value == 0, is_inside, "{x}, {y}");
            }
        }
    }
}
