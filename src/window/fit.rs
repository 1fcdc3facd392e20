//! From 320 × 200 pixels of 5:6 to a 4:3 picture in a window of any shape.

use std::mem;

use super::area::{Area, HEIGHT, WIDTH};
use super::canvas::Canvas;
use crate::vga::Vga;

/// The stretched picture, kept from frame to frame so that nothing is allocated while the window keeps its size.
#[derive(Default)]
pub(super) struct Picture {
    size: (usize, usize),
    place: Area,
    /// For each column of the picture, the frame's column.
    columns: Vec<usize>,
    frame: Vec<u32>,
    stretched: Vec<u32>,
    /// Something may be drawn beside the picture.
    is_drawn_over: bool,
}

impl Picture {
    pub(super) fn place(&self) -> Area {
        self.place
    }

    /// Stretches the picture that `vga` displays to `width` × `height` pixels of the window: 0x00RRGGBB, row by row,
    /// black beside the picture. Each pixel shows the one of the frame that its centre falls in.
    pub(super) fn stretch(&mut self, vga: &Vga, width: usize, height: usize) -> &[u32] {
        if mem::take(&mut self.is_drawn_over) {
            self.stretched.fill(0);
        }
        if self.size != (width, height) {
            self.size = (width, height);
            self.place = Area::within(width, height);
            self.columns = (0..self.place.width).map(|x| source(x, self.place.width, WIDTH)).collect();
            self.stretched.clear();
            self.stretched.resize(width * height, 0);
        }
        self.frame.resize(WIDTH * HEIGHT, 0);
        vga.scan_out(&mut self.frame);

        let Area { left, top, width: across, height: down } = self.place;
        let mut drawn: Option<usize> = None;
        for y in 0..down {
            let start = (top + y) * width + left;
            let from = source(y, down, HEIGHT);
            if drawn == Some(from) {
                // The same row of the frame as the row above, which is there already.
                self.stretched.copy_within(start - width..start - width + across, start);
            } else {
                let row = &self.frame[from * WIDTH..][..WIDTH];
                for (pixel, &x) in self.stretched[start..start + across].iter_mut().zip(&self.columns) {
                    *pixel = row[x];
                }
                drawn = Some(from);
            }
        }
        &self.stretched
    }

    /// The last stretched picture, to be drawn over.
    pub(super) fn canvas(&mut self) -> Canvas<'_> {
        self.is_drawn_over = true;
        Canvas::over(&mut self.stretched, self.size, self.place)
    }

    /// The last stretched picture, with anything drawn over it, if it has this size.
    pub(super) fn last(&self, width: usize, height: usize) -> Option<&[u32]> {
        (self.size == (width, height) && !self.stretched.is_empty()).then_some(&self.stretched)
    }
}

/// The pixel of `from` that the centre of pixel `at` of `to` falls in: floor((at + ½) · from / to).
fn source(at: usize, to: usize, from: usize) -> usize {
    (2 * at + 1) * from / (2 * to)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_picture_is_the_largest_of_4_to_3() {
        for (window, expected) in [
            ((960, 720), Area { left: 0, top: 0, width: 960, height: 720 }),
            ((1920, 720), Area { left: 480, top: 0, width: 960, height: 720 }),
            ((400, 900), Area { left: 0, top: 300, width: 400, height: 300 }),
            ((1, 1), Area { left: 0, top: 0, width: 1, height: 0 }),
            ((0, 0), Area { left: 0, top: 0, width: 0, height: 0 }),
        ] {
            assert_eq!(Area::within(window.0, window.1), expected, "{window:?}");
        }
    }

    #[test]
    fn every_pixel_of_the_window_shows_the_pixel_under_its_centre() {
        let mut vga = Vga::new();
        let mut picture = Picture::default();
        for (i, byte) in vga.pixels_mut().iter_mut().enumerate() {
            // A pattern in which neighbouring rows and columns differ.
            *byte = (i * 7 + i / 320 * 13) as u8;
        }
        let mut frame = vec![0; WIDTH * HEIGHT];
        vga.scan_out(&mut frame);
        for (width, height) in [(960, 720), (321, 200), (320, 240), (500, 100), (7, 300), (3, 3)] {
            let pixels = picture.stretch(&vga, width, height).to_vec();
            let place = picture.place();
            assert_eq!(pixels.len(), width * height);
            for y in 0..height {
                for x in 0..width {
                    let (fx, fy) = place.to_frame(x as f32 + 0.5, y as f32 + 0.5);
                    let beside = x < place.left
                        || x >= place.left + place.width
                        || y < place.top
                        || y >= place.top + place.height;
                    let expected = if beside { 0 } else { frame[fy as usize * WIDTH + fx as usize] };
                    assert_eq!(pixels[y * width + x], expected, "{x}, {y} of {width} x {height}");
                }
            }
        }
    }

    #[test]
    fn what_was_drawn_over_a_picture_is_gone_from_the_next() {
        let (vga, mut picture) = (Vga::new(), Picture::default());
        for (width, height) in [(640, 480), (500, 100)] {
            let fresh = Picture::default().stretch(&vga, width, height).to_vec();
            picture.stretch(&vga, width, height);
            picture.canvas().pixels_mut().fill(0xFF_FFFF);
            assert!(picture.last(width, height).is_some_and(|pixels| pixels != fresh));
            assert_eq!(picture.stretch(&vga, width, height), fresh);
            assert_eq!(picture.last(width + 1, height), None);
        }
    }

    #[test]
    fn points_of_the_frame_lead_to_the_window_and_back() {
        let area = Area::within(1000, 700);
        for (x, y) in [(0.0, 0.0), (320.0, 200.0), (17.5, 99.25)] {
            let (wx, wy) = area.from_frame(x, y);
            let (bx, by) = area.to_frame(wx, wy);
            // Four roundings of numbers below 1,024, of 24 bits: half of 2⁻¹⁴ each.
            assert!((bx - x).abs() <= 2.0 / 16384.0 && (by - y).abs() <= 2.0 / 16384.0, "{bx}, {by}");
        }
        assert_eq!(area.from_frame(0.0, 0.0), (area.left as f32, area.top as f32));
    }
}
