//! Rectangles of the window, and how a picture fits into them.

use crate::vga::Vga;

/// A rectangle of the window's pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Area {
    /// The number of columns of the window to the left of it.
    pub left: usize,
    /// The number of rows of the window above it.
    pub top: usize,
    /// The number of columns.
    pub width: usize,
    /// The number of rows.
    pub height: usize,
}

impl Area {
    /// The rectangle of a mode 13h picture in a window: the largest 4:3 rectangle, centred. Both sides may be a
    /// fraction of a pixel too short.
    pub fn within(width: usize, height: usize) -> Area {
        Area::of_shape((4, 3), width, height)
    }

    /// The largest centred rectangle of this aspect ratio in a window.
    pub(super) fn of_shape((across, down): (usize, usize), width: usize, height: usize) -> Area {
        // A picture has at most 2¹⁴ pixels of 2¹⁶ per side: the products are below 2⁹⁴.
        let (w, h, across, down) = (width as u128, height as u128, across as u128, down as u128);
        let (w, h) = if w * down <= h * across { (w, w * down / across) } else { (h * across / down, h) };
        let (w, h) = (w as usize, h as usize);
        Area { left: (width - w) / 2, top: (height - h) / 2, width: w, height: h }
    }

    /// Converts a point of the window to pixels of the picture that fills this rectangle: 0 to `columns` and 0 to
    /// `rows`. Points beside the picture are outside these ranges.
    pub(super) fn to_picture(self, x: f32, y: f32, (columns, rows): (usize, usize)) -> (f32, f32) {
        let along = |at: f32, from: usize, length: usize, picture: usize| {
            (at - from as f32) * picture as f32 / length.max(1) as f32
        };
        (along(x, self.left, self.width, columns), along(y, self.top, self.height, rows))
    }

    /// Converts a point of the frame that fills this rectangle, 0 to 320 across and 0 to 200 down, to a point of the
    /// window.
    pub fn from_frame(self, x: f32, y: f32) -> (f32, f32) {
        let along = |at: f32, from: usize, length: usize, frame: usize| from as f32 + at * length as f32 / frame as f32;
        (along(x, self.left, self.width, Vga::WIDTH), along(y, self.top, self.height, Vga::HEIGHT))
    }
}
