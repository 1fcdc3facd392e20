//! A rectangle of the window, and the frame that fills it.

/// Columns of the frame.
pub(super) const WIDTH: usize = 320;
/// Rows of the frame.
pub(super) const HEIGHT: usize = 200;

/// A rectangle of the window's pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Area {
    /// Columns of the window to the left of it.
    pub left: usize,
    /// Rows of the window above it.
    pub top: usize,
    /// The number of columns.
    pub width: usize,
    /// The number of rows.
    pub height: usize,
}

impl Area {
    /// The picture's rectangle in a window: the largest of 4:3 in the middle. Both its sides may be a part of a pixel
    /// too short.
    pub fn within(width: usize, height: usize) -> Area {
        let (w, h) = if width * 3 <= height * 4 { (width, width * 3 / 4) } else { (height * 4 / 3, height) };
        Area { left: (width - w) / 2, top: (height - h) / 2, width: w, height: h }
    }

    /// A point of the window as a point of the frame that fills this rectangle: 0 to 320 across and 0 to 200 down if it
    /// is on the picture, beyond these beside it.
    pub(crate) fn to_frame(self, x: f32, y: f32) -> (f32, f32) {
        let along = |at: f32, from: usize, length: usize, frame: usize| {
            (at - from as f32) * frame as f32 / length.max(1) as f32
        };
        (along(x, self.left, self.width, WIDTH), along(y, self.top, self.height, HEIGHT))
    }

    /// A point of the frame that fills this rectangle, 0 to 320 across and 0 to 200 down, as a point of the window.
    pub fn from_frame(self, x: f32, y: f32) -> (f32, f32) {
        let along = |at: f32, from: usize, length: usize, frame: usize| from as f32 + at * length as f32 / frame as f32;
        (along(x, self.left, self.width, WIDTH), along(y, self.top, self.height, HEIGHT))
    }
}
