//! Depth buffers. `reference::depth::DepthPlane` defines the depth of a triangle at a pixel.

use super::error::RasterError;
use super::frame::Frame;
#[cfg(feature = "alloc")]
use super::frame::Rect;
pub use crate::span::depth::Cell;
use crate::span::depth::Cells;

/// A depth buffer over the rows of a frame: one u32 per pixel, or on small machines one u16, which cannot distinguish
/// depths less than 2¹⁴ of 2³⁰ apart. Greater is nearer, 0 is farthest. The caller owns the slice.
#[derive(Debug)]
pub struct DepthBuffer<'a, D: Cell = u32> {
    values: &'a mut [D],
    width: u32,
    first_row: u32,
    /// Added to depths before they are compared and stored, so that everything in `values` is farther: 0, or chosen by
    /// [`DepthMemory`].
    pub(super) base: u32,
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
            Some(values) => Ok(Self { values, width: frame.width(), first_row: rows.start, base: 0 }),
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

/// Memory for the depth buffers of successive frames, which is cleared in only one frame out of three.
///
/// Depths are at most 2³⁰, a quarter of what a cell can hold. So the second frame after a clear adds 2³⁰ to its depths,
/// and the third adds 2³¹: everything that the frames before it have stored is farther than anything that it draws.
///
/// ```
/// use mode13h::raster::{DepthMemory, Frame, Interpolation, Raster, Vertex};
///
/// let mut bytes = [0; 32 * 32];
/// let mut depths = DepthMemory::new();
/// for shade in [10.0, 20.0, 30.0, 40.0] {
///     let frame = Frame::new(&mut bytes, 32, 32, 32)?;
///     let mut raster = Raster::new(frame).with_depth_memory(&mut depths);
///     // Each is farther away than the one in the frame before.
///     let corner = |x, y| Vertex::at(x, y, shade).with_depth(1_000 - shade as u32);
///     raster.triangle(&[corner(0.0, 0.0), corner(31.0, 0.0), corner(0.0, 31.0)], Interpolation::default());
/// }
/// assert_eq!(bytes[0], 40);
/// # Ok::<(), mode13h::raster::RasterError>(())
/// ```
#[cfg(feature = "alloc")]
#[derive(Clone, Debug, Default)]
pub struct DepthMemory {
    cells: alloc::vec::Vec<u32>,
    /// The columns and the rows of the frame whose depths the cells hold.
    shape: (u32, core::ops::Range<u32>),
    /// The base of the current frame.
    base: u32,
    /// A rectangle that holds every pixel drawn since the last clear.
    drawn: Rect,
}

#[cfg(feature = "alloc")]
impl DepthMemory {
    /// The number of depths that a frame can have: 1 to 2³⁰.
    const DEPTHS: u32 = 1 << 30;
    /// The base of the last frame before a clear. With a greater one, a depth of 2³⁰ would overflow.
    const LAST_BASE: u32 = 2 * Self::DEPTHS;

    /// No cells: the first frame allocates them.
    #[must_use]
    pub const fn new() -> Self {
        Self { cells: alloc::vec::Vec::new(), shape: (0, 0..0), base: 0, drawn: Rect::NOWHERE }
    }

    /// The depth buffer of the next frame, as if cleared. Nothing may be drawn outside `within`, and no depth may be 0
    /// or above 2³⁰, unless `within` is [`Rect::EVERYWHERE`]. Called once a frame, and not inlined, so that
    /// `.ci/off_is_free` sees it.
    #[inline(never)]
    pub(super) fn next(&mut self, frame: &Frame<'_>, within: Rect) -> Option<DepthBuffer<'_>> {
        let shape = (frame.width(), frame.rows());
        let is_bounded = within != Rect::EVERYWHERE;
        let within = within.intersection(frame.bounds());
        if shape != self.shape {
            self.cells.clear();
            self.cells.resize(shape.0 as usize * (shape.1.end - shape.1.start) as usize, 0);
            (self.shape, self.base, self.drawn) = (shape, 0, Rect::NOWHERE);
        } else if is_bounded && self.base < Self::LAST_BASE {
            self.base += Self::DEPTHS;
        } else {
            let mut buffer = DepthBuffer::new(&mut self.cells, frame).ok()?;
            if !self.drawn.is_empty() {
                buffer.clear_within(self.drawn);
            }
            (self.base, self.drawn) = (0, Rect::NOWHERE);
        }
        if !within.is_empty() {
            self.drawn = self.drawn.hull(within);
        }
        let mut buffer = DepthBuffer::new(&mut self.cells, frame).ok()?;
        buffer.base = self.base;
        if !is_bounded {
            // The depths of this frame may be anything, so the next frame clears.
            self.base = Self::LAST_BASE;
        }
        Some(buffer)
    }
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::*;

    /// Cells outside the rectangle do not change, even where whole rows are cleared, and even in a band.
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

    /// After a frame whose depths may be anything, the nearest included, the next one is cleared.
    #[test]
    fn a_frame_of_any_depths_hides_nothing_of_the_next() {
        let mut memory = DepthMemory::new();
        let mut pixels = [0_u8; 4];
        for within in [Rect::EVERYWHERE, Rect { x0: 0, y0: 0, x1: 2, y1: 2 }].repeat(4) {
            let frame = Frame::new(&mut pixels, 2, 2, 2).unwrap();
            let buffer = memory.next(&frame, within).unwrap();
            let nearest = if within == Rect::EVERYWHERE { u32::MAX } else { buffer.base + DepthMemory::DEPTHS };
            assert!(buffer.values.iter().all(|value| *value <= buffer.base), "{:?} is not cleared", buffer);
            buffer.values.fill(nearest);
        }
    }
}
