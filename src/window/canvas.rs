//! The window's own pixels, for drawing over the picture.

use super::area::Area;
use crate::export::picture::source;
use crate::palette::Rgb;

/// The window's pixels with the picture stretched over them, as passed to the closure of
/// [`Window::show_over`](super::Window::show_over).
///
/// With the feature `embedded-graphics` it is a `DrawTarget` of `Rgb888`: text, lines and shapes at the window's own
/// resolution. Anything beyond the window is clipped.
#[derive(Debug)]
pub struct Canvas<'a> {
    pub(super) pixels: &'a mut [u32],
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) picture: Area,
}

impl<'a> Canvas<'a> {
    /// A standalone canvas with a picture as large as fits, as in a window of this size. `None` unless there are
    /// exactly `width` × `height` pixels.
    pub fn new(pixels: &'a mut [u32], width: usize, height: usize) -> Option<Canvas<'a>> {
        let is_whole = width.checked_mul(height) == Some(pixels.len());
        is_whole.then(|| Canvas { pixels, width, height, picture: Area::within(width, height) })
    }

    /// The number of columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// The number of rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The rectangle that the picture covers.
    pub fn picture(&self) -> Area {
        self.picture
    }

    /// All pixels, 0x00RRGGBB, row by row.
    pub fn pixels_mut(&mut self) -> &mut [u32] {
        self.pixels
    }

    /// The rows of the part of a rectangle that is on the canvas: for each, its number, counted from the rectangle's
    /// top, and its pixels.
    fn rows_mut(&mut self, area: Area) -> impl Iterator<Item = (usize, &mut [u32])> {
        let across = area.left.min(self.width)..area.left.saturating_add(area.width).min(self.width);
        let rows = self.pixels.chunks_exact_mut(self.width.max(1)).skip(area.top).take(area.height);
        rows.enumerate().map(move |(y, row)| (y, &mut row[across.clone()]))
    }

    /// Fills a rectangle.
    pub fn fill(&mut self, area: Area, color: Rgb) {
        self.rows_mut(area).for_each(|(_, row)| row.fill(color.to_u32()));
    }

    /// Blends a rectangle over the pixels under it: `share`, out of 255, is the opacity of the new colour.
    pub fn blend(&mut self, area: Area, color: Rgb, share: u8) {
        for pixel in self.rows_mut(area).flat_map(|(_, row)| row) {
            *pixel = Rgb::from_u32(*pixel).mix(color, share).to_u32();
        }
    }

    /// Stretches a picture with `columns` pixels per row over a rectangle. Each pixel takes the
    /// colour of the picture's pixel that contains its centre.
    pub fn stretch(&mut self, area: Area, colors: &[Rgb], columns: usize) {
        let rows = colors.len().checked_div(columns).unwrap_or(0);
        if rows == 0 {
            return;
        }
        // Longer sides also leave only the first pixel of the picture on a canvas that fits in memory.
        let [width, height] = [area.width, area.height].map(|side| side.min(isize::MAX as usize / 2));
        for (y, row) in self.rows_mut(area) {
            let from = &colors[source(y, height, rows) * columns..][..columns];
            for (x, pixel) in row.iter_mut().enumerate() {
                *pixel = from[source(x, width, columns)].to_u32();
            }
        }
    }
}

#[cfg(feature = "embedded-graphics")]
mod draw_target {
    use core::convert::Infallible;

    use embedded_graphics::Pixel;
    use embedded_graphics::draw_target::DrawTarget;
    use embedded_graphics::geometry::{OriginDimensions, Size};
    use embedded_graphics::pixelcolor::{Rgb888, RgbColor};
    use embedded_graphics::primitives::Rectangle;

    use super::{Area, Canvas};
    use crate::palette::Rgb;
    use crate::raster::clipped;

    fn rgb(color: Rgb888) -> Rgb {
        Rgb::new(color.r(), color.g(), color.b())
    }

    impl OriginDimensions for Canvas<'_> {
        fn size(&self) -> Size {
            let [width, height] = [self.width, self.height].map(|side| u32::try_from(side).unwrap_or(u32::MAX));
            Size::new(width, height)
        }
    }

    impl DrawTarget for Canvas<'_> {
        type Color = Rgb888;
        type Error = Infallible;

        /// Pixels outside the canvas are ignored.
        fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(&mut self, pixels: I) -> Result<(), Infallible> {
            for Pixel(at, color) in pixels {
                let (Ok(x), Ok(y)) = (usize::try_from(at.x), usize::try_from(at.y)) else { continue };
                if x < self.width && y < self.height {
                    self.pixels[y * self.width + x] = rgb(color).to_u32();
                }
            }
            Ok(())
        }

        fn fill_solid(&mut self, area: &Rectangle, color: Rgb888) -> Result<(), Infallible> {
            let [columns, rows] = clipped(area, self.width, self.height);
            let (left, top) = (columns.start, rows.start);
            self.fill(Area { left, top, width: columns.len(), height: rows.len() }, rgb(color));
            Ok(())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: (usize, usize) = (7, 5);

    /// Draws on a single-coloured canvas and returns its pixels.
    fn drawn(draw: impl FnOnce(&mut Canvas<'_>)) -> Vec<u32> {
        let mut pixels = vec![0x102030; SIZE.0 * SIZE.1];
        draw(&mut Canvas::new(&mut pixels, SIZE.0, SIZE.1).expect("the right number of pixels"));
        pixels
    }

    fn each(area: Area, inside: impl Fn(usize, usize) -> u32) -> Vec<u32> {
        let at = |i: usize| (i % SIZE.0, i / SIZE.0);
        let is_in = |x: usize, y: usize| {
            (area.left..area.left + area.width).contains(&x) && (area.top..area.top + area.height).contains(&y)
        };
        let pixel = |(x, y): (usize, usize)| if is_in(x, y) { inside(x - area.left, y - area.top) } else { 0x102030 };
        (0..SIZE.0 * SIZE.1).map(at).map(pixel).collect()
    }

    #[test]
    fn rectangles_are_drawn_as_far_as_they_lie_on_the_canvas() {
        let colors: Vec<Rgb> = (0..6).map(|i| Rgb::new(i, 2 * i, 3 * i)).collect();
        let sides = [(2, 1, 3, 2), (0, 0, 7, 5), (5, 3, 9, 9), (7, 5, 1, 1), (9, 0, 2, 2), (1, 1, 0, 3), (3, 0, 4, 5)];
        for (left, top, width, height) in sides {
            let area = Area { left, top, width, height };
            let color = Rgb::new(200, 100, 0);
            assert_eq!(drawn(|canvas| canvas.fill(area, color)), each(area, |_, _| color.to_u32()), "{area:?}");
            let mixed = Rgb::from_u32(0x102030).mix(color, 128).to_u32();
            assert_eq!(drawn(|canvas| canvas.blend(area, color, 128)), each(area, |_, _| mixed), "{area:?}");
            let stretched = each(area, |x, y| {
                let centre = |at: usize, to: usize, from: usize| ((at as f64 + 0.5) / to as f64 * from as f64) as usize;
                colors[centre(y, height, 2) * 3 + centre(x, width, 3)].to_u32()
            });
            assert_eq!(drawn(|canvas| canvas.stretch(area, &colors, 3)), stretched, "{area:?}");
        }
        assert_eq!(drawn(|canvas| canvas.stretch(Area::within(7, 5), &[], 3)), drawn(|_| ()));
        assert!(Canvas::new(&mut [0; 6], 2, 2).is_none());
    }

    #[cfg(feature = "embedded-graphics")]
    #[test]
    fn what_reaches_beyond_the_canvas_is_left_out() {
        use embedded_graphics::pixelcolor::Rgb888;
        use embedded_graphics::prelude::*;
        use embedded_graphics::primitives::{Line, PrimitiveStyle, Rectangle};

        let corner = Rectangle::new(Point::new(-2, -3), Size::new(5, 5));
        let corner = corner.into_styled(PrimitiveStyle::with_fill(Rgb888::RED));
        let pixels = drawn(|canvas| corner.draw(canvas).expect("it cannot fail"));
        assert_eq!(pixels, each(Area { left: 0, top: 0, width: 3, height: 2 }, |_, _| 0xFF_0000));
        let line = Line::new(Point::new(-9, 2), Point::new(90, 2));
        let line = line.into_styled(PrimitiveStyle::with_stroke(Rgb888::RED, 1));
        let pixels = drawn(|canvas| line.draw(canvas).expect("it cannot fail"));
        assert_eq!(pixels, each(Area { left: 0, top: 2, width: 7, height: 1 }, |_, _| 0xFF_0000));
        let most = Rectangle::new(Point::new(3, 2), Size::new_equal(u32::MAX));
        let pixels = drawn(|canvas| canvas.fill_solid(&most, Rgb888::RED).expect("it cannot fail"));
        assert_eq!(pixels, each(Area { left: 3, top: 2, width: 4, height: 3 }, |_, _| 0xFF_0000));
    }

    #[test]
    fn the_largest_numbers_do_no_harm() {
        let most = usize::MAX;
        let white = [Rgb::WHITE; 4];
        for (left, width) in [(0, 1 << (usize::BITS - 1)), (0, most), (most, most), (3, most - 1)] {
            let area = Area { left, top: left, width, height: width };
            let stretched = drawn(|canvas| canvas.stretch(area, &white, 2));
            assert_eq!(stretched, drawn(|canvas| canvas.fill(area, Rgb::WHITE)), "{left} {width}");
        }
        for (width, height) in [(most, 1), (1, most), (most, most), (most, 0)] {
            let Area { left, top, width: w, height: h } = Area::within(width, height);
            assert!(left + w <= width && top + h <= height, "{width} x {height}");
        }
        assert!(Canvas::new(&mut [], most, 0).is_none_or(|canvas| canvas.picture().width == 0));
    }
}
