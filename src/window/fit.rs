//! Stretching of pictures to windows of any shape.

use std::mem;

use super::area::Area;
use super::canvas::Canvas;
use crate::export::Picture;
use crate::export::picture::source;
use crate::vga::Vga;

/// The stretched picture, reused so that nothing is allocated while the window size is unchanged.
#[derive(Default)]
pub(super) struct Stretched {
    /// The sizes of the window and of the picture in pixels, and the picture's aspect ratio.
    sizes: [(usize, usize); 3],
    /// The rectangle of the window that the picture fills.
    pub(super) place: Area,
    /// The picture's column for each column of the window's rectangle.
    columns: Vec<usize>,
    colors: Vec<u32>,
    pixels: Vec<u32>,
    /// Whether something may have been drawn beside the picture.
    is_drawn_over: bool,
}

impl Stretched {
    /// The picture's columns and rows.
    pub(super) fn picture_size(&self) -> (usize, usize) {
        self.sizes[1]
    }

    /// Stretches the picture that `vga` displays to a window of this size: 0x00RRGGBB, row by row,
    /// black beside the picture. Each pixel takes the colour of the picture's pixel that contains
    /// its centre.
    pub(super) fn vga(&mut self, vga: &Vga, window: (usize, usize)) -> &[u32] {
        self.colors.resize(Vga::SHOWN, 0);
        vga.scan_out(&mut self.colors);
        self.stretch([window, (Vga::WIDTH, Vga::HEIGHT), (4, 3)])
    }

    /// Stretches a [checked](Picture::check) picture in the same way as [`vga`](Self::vga).
    pub(super) fn picture(&mut self, picture: &Picture<'_>, window: (usize, usize)) -> &[u32] {
        let &Picture { width, height, palette, shape, .. } = picture;
        self.colors.clear();
        self.colors.reserve(width * height);
        let rows = (0..height).flat_map(|y| picture.row(y));
        self.colors.extend(rows.map(|&index| palette[usize::from(index)].to_u32()));
        let sides = (width * usize::from(shape.width), height * usize::from(shape.height));
        self.stretch([window, (width, height), sides])
    }

    fn stretch(&mut self, sizes: [(usize, usize); 3]) -> &[u32] {
        if mem::take(&mut self.is_drawn_over) {
            self.pixels.fill(0);
        }
        let [(width, height), (columns, rows), shape] = sizes;
        if self.sizes != sizes {
            self.sizes = sizes;
            self.place = Area::of_shape(shape, width, height);
            self.columns = (0..self.place.width).map(|x| source(x, self.place.width, columns)).collect();
            self.pixels.clear();
            self.pixels.resize(width * height, 0);
        }
        let Area { left, top, width: across, height: down } = self.place;
        let mut drawn: Option<usize> = None;
        for y in 0..down {
            let start = (top + y) * width + left;
            let from = source(y, down, rows);
            if drawn == Some(from) {
                // This row shows the same row of the picture as the one above, so copy that.
                self.pixels.copy_within(start - width..start - width + across, start);
            } else {
                let row = &self.colors[from * columns..][..columns];
                for (pixel, &x) in self.pixels[start..start + across].iter_mut().zip(&self.columns) {
                    *pixel = row[x];
                }
                drawn = Some(from);
            }
        }
        &self.pixels
    }

    /// The last stretched picture, to be drawn over.
    pub(super) fn canvas(&mut self) -> Canvas<'_> {
        self.is_drawn_over = true;
        let (width, height) = self.sizes[0];
        Canvas { pixels: &mut self.pixels, width, height, picture: self.place }
    }

    /// The last stretched picture, with anything drawn over it, if it has this size.
    pub(super) fn last(&self, width: usize, height: usize) -> Option<&[u32]> {
        (self.sizes[0] == (width, height) && !self.pixels.is_empty()).then_some(&self.pixels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::PixelShape;
    use crate::palette::builtin;

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
        let mut picture = Stretched::default();
        for (i, byte) in vga.pixels_mut().iter_mut().enumerate() {
            // A pattern in which neighbouring rows and columns differ.
            *byte = (i * 7 + i / 320 * 13) as u8;
        }
        let mut frame = vec![0; Vga::SHOWN];
        vga.scan_out(&mut frame);
        for (width, height) in [(960, 720), (321, 200), (320, 240), (500, 100), (7, 300), (3, 3)] {
            let pixels = picture.vga(&vga, (width, height)).to_vec();
            let place = picture.place;
            assert_eq!(pixels.len(), width * height);
            for y in 0..height {
                for x in 0..width {
                    let (fx, fy) = place.to_picture(x as f32 + 0.5, y as f32 + 0.5, picture.picture_size());
                    let beside = x < place.left
                        || x >= place.left + place.width
                        || y < place.top
                        || y >= place.top + place.height;
                    let expected = if beside { 0 } else { frame[fy as usize * Vga::WIDTH + fx as usize] };
                    assert_eq!(pixels[y * width + x], expected, "{x}, {y} of {width} x {height}");
                }
            }
        }
    }

    /// A picture of any size and pitch, with pixels of any shape.
    #[test]
    fn a_picture_of_any_size_fills_what_fits_of_its_shape() {
        let palette = builtin::COPPER.clone();
        let mut stretched = Stretched::default();
        for (columns, rows, pitch, shape, area) in [
            (64, 48, 64, (1, 1), Area { left: 0, top: 0, width: 640, height: 480 }),
            (50, 10, 61, (1, 1), Area { left: 0, top: 176, width: 640, height: 128 }),
            (10, 20, 10, (1, 2), Area { left: 260, top: 0, width: 120, height: 480 }),
            (1, 1, 1, (3, 1), Area { left: 0, top: 133, width: 640, height: 213 }),
        ] {
            let pixels: Vec<u8> = (0..pitch * rows).map(|i| (i * 7 + i / pitch * 13) as u8).collect();
            let shape = PixelShape { width: shape.0, height: shape.1 };
            let picture =
                Picture { pixels: &pixels, width: columns, height: rows, pitch, palette: palette.colors(), shape };
            let shown = stretched.picture(&picture, (640, 480)).to_vec();
            assert_eq!((stretched.place, stretched.picture_size()), (area, (columns, rows)));
            let centre = |at: usize, to: usize, from: usize| ((at as f64 + 0.5) * from as f64 / to as f64) as usize;
            for (i, pixel) in shown.into_iter().enumerate() {
                let (x, y) = ((i % 640).wrapping_sub(area.left), (i / 640).wrapping_sub(area.top));
                let is_beside = x >= area.width || y >= area.height;
                let index = || pixels[centre(y, area.height, rows) * pitch + centre(x, area.width, columns)];
                assert_eq!(pixel, if is_beside { 0 } else { palette[index()].to_u32() }, "{x}, {y}");
            }
        }
        // A mode 13h picture equals what its machine shows.
        let mut vga = Vga::new();
        vga.pixels_mut().iter_mut().enumerate().for_each(|(i, byte)| *byte = (i * 7) as u8);
        let palette = vga.palette();
        let as_picture = Stretched::default().picture(&Picture::mode_13h(vga.pixels(), &palette), (701, 500)).to_vec();
        assert!(as_picture == stretched.vga(&vga, (701, 500)));
    }

    #[test]
    fn what_was_drawn_over_a_picture_is_gone_from_the_next() {
        let (vga, mut picture) = (Vga::new(), Stretched::default());
        for (width, height) in [(640, 480), (500, 100)] {
            let fresh = Stretched::default().vga(&vga, (width, height)).to_vec();
            picture.vga(&vga, (width, height));
            picture.canvas().pixels_mut().fill(0xFF_FFFF);
            assert!(picture.last(width, height).is_some_and(|pixels| pixels != fresh));
            assert_eq!(picture.vga(&vga, (width, height)), fresh);
            assert_eq!(picture.last(width + 1, height), None);
        }
    }

    #[test]
    fn points_of_the_frame_lead_to_the_window_and_back() {
        let area = Area::within(1000, 700);
        for (x, y) in [(0.0, 0.0), (320.0, 200.0), (17.5, 99.25)] {
            let (wx, wy) = area.from_frame(x, y);
            let (bx, by) = area.to_picture(wx, wy, (320, 200));
            // Four roundings of numbers below 1,024 with 24 bits: half of 2⁻¹⁴ each.
            assert!((bx - x).abs() <= 2.0 / 16384.0 && (by - y).abs() <= 2.0 / 16384.0, "{bx}, {by}");
        }
        assert_eq!(area.from_frame(0.0, 0.0), (area.left as f32, area.top as f32));
    }
}
