//! A frame as a target of `embedded-graphics`: text, lines, shapes and images on the same bytes.

use core::convert::Infallible;
use core::ops::Range;

use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{Dimensions, Point, Size};
use embedded_graphics::pixelcolor::PixelColor;
use embedded_graphics::pixelcolor::raw::RawU8;
use embedded_graphics::primitives::Rectangle;

use super::frame::Frame;

/// A palette index as a colour of `embedded-graphics`.
///
/// [`Frame::clear`] takes the byte itself, `frame.clear(3)`, and hides the method of [`DrawTarget`]; to pass a colour,
/// write `DrawTarget::clear(&mut frame, color)`.
///
/// ```
/// use mode13h::embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_6X10};
/// use mode13h::embedded_graphics::{prelude::*, text::Text};
/// use mode13h::raster::{Frame, Index};
///
/// let mut bytes = [0_u8; 32 * 12];
/// let mut frame = Frame::new(&mut bytes, 32, 12, 32)?;
/// Text::new("386", Point::new(1, 8), MonoTextStyle::new(&FONT_6X10, Index(15))).draw(&mut frame)?;
/// assert!(bytes.contains(&15));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct Index(pub u8);

impl PixelColor for Index {
    type Raw = RawU8;
}

impl From<RawU8> for Index {
    fn from(raw: RawU8) -> Self {
        use embedded_graphics::pixelcolor::raw::RawData;
        Self(raw.into_inner())
    }
}

impl From<Index> for RawU8 {
    fn from(index: Index) -> Self {
        Self::new(index.0)
    }
}

impl Dimensions for Frame<'_> {
    fn bounding_box(&self) -> Rectangle {
        Rectangle::new(Point::zero(), Size::new(self.width(), self.height()))
    }
}

impl DrawTarget for Frame<'_> {
    type Color = Index;
    type Error = Infallible;

    /// Pixels outside the frame, or in rows that this band does not hold, are skipped.
    fn draw_iter<I: IntoIterator<Item = Pixel<Index>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(at, Index(index)) in pixels {
            let (Ok(x), Ok(y)) = (usize::try_from(at.x), u32::try_from(at.y)) else { continue };
            if let Some(pixel) = self.row_mut(y).and_then(|row| row.get_mut(x)) {
                *pixel = index;
            }
        }
        Ok(())
    }

    fn fill_solid(&mut self, area: &Rectangle, Index(index): Index) -> Result<(), Infallible> {
        let [columns, rows] = clipped(area, self.width() as usize, self.height() as usize);
        for y in rows {
            // Within the frame.
            if let Some(pixels) = self.row_mut(y as u32).and_then(|row| row.get_mut(columns.clone())) {
                pixels.fill(index);
            }
        }
        Ok(())
    }
}

/// The columns and rows of a rectangle on a target of this size. The intersection of two `Rectangle`s overflows if one
/// reaches beyond the numbers of i32.
pub(crate) fn clipped(area: &Rectangle, width: usize, height: usize) -> [Range<usize>; 2] {
    let along = |from: i32, length: u32, end: usize| {
        let end = i64::try_from(end).unwrap_or(i64::MAX);
        // 0 to the target's end.
        let within = |at: i64| at.clamp(0, end) as usize;
        within(from.into())..within(i64::from(from) + i64::from(length))
    };
    [along(area.top_left.x, area.size.width, width), along(area.top_left.y, area.size.height, height)]
}

#[cfg(test)]
mod tests {
    use std::vec;

    use embedded_graphics::geometry::Point;
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn rectangles_may_reach_beyond_all_numbers() {
        let most = i32::MAX;
        for (from, length, expected) in [
            (10, most as u32, 10..20),
            (10, u32::MAX, 10..20),
            (-5, most as u32, 0..20),
            (-most, u32::MAX, 0..20),
            (most, u32::MAX, 20..20),
            (i32::MIN, most as u32, 0..0),
            (-5, 5, 0..0),
        ] {
            let area = Rectangle::new(Point::new_equal(from), Size::new_equal(length));
            let ends: [Range<usize>; 2] = clipped(&area, 20, 20);
            assert_eq!(ends, [expected.clone(), expected.clone()], "{from} {length}");
            let (mut filled, mut pixels) = ([0; 400], [0; 400]);
            let mut frame = Frame::new(&mut filled, 20, 20, 20).expect("a frame");
            let Ok(()) = frame.fill_solid(&area, Index(7));
            expected.clone().for_each(|y| pixels[20 * y..][expected.clone()].fill(7));
            assert_eq!(filled, pixels, "{from} {length}");
        }
    }

    proptest! {
        /// A filled rectangle gives the same bytes as setting each of its pixels that the band holds.
        #[test]
        fn a_filled_rectangle_is_its_pixels(
            (x, y) in (-12_i32..20, -12_i32..20),
            (width, height) in (0_u32..30, 0_u32..30),
            (first, end) in (0_u32..10, 1_u32..10),
        ) {
            const PITCH: usize = 16;
            let area = Rectangle::new(Point::new(x, y), Size::new(width, height));
            let rows = first..(first + end).min(12);
            let bytes = PITCH * rows.len();
            let (mut filled, mut expected) = (vec![0; bytes], vec![0; bytes]);
            let mut band = Frame::band(&mut filled, 13, 12, PITCH, rows.clone()).expect("a band");
            let Ok(()) = band.fill_solid(&area, Index(7));
            for py in y..y + height as i32 {
                for px in (x..x + width as i32).filter(|px| (0..13).contains(px)) {
                    if let Some(row) = u32::try_from(py).ok().filter(|y| rows.contains(y)) {
                        expected[(row - rows.start) as usize * PITCH + px as usize] = 7;
                    }
                }
            }
            prop_assert_eq!(filled, expected);
        }

        /// Pixels in the band are drawn, later ones over earlier ones; others are skipped.
        #[test]
        fn pixels_are_drawn_where_the_band_holds_them(
            places in prop::collection::vec(((-3_i32..16, -3_i32..15), 1_u8..), 0..60),
            (first, end) in (0_u32..10, 1_u32..10),
        ) {
            const PITCH: usize = 16;
            let rows = first..(first + end).min(12);
            let (mut drawn, mut expected) = (vec![0; PITCH * rows.len()], vec![0; PITCH * rows.len()]);
            let mut band = Frame::band(&mut drawn, 13, 12, PITCH, rows.clone()).expect("a band");
            let Ok(()) = band.draw_iter(places.iter().map(|&((x, y), index)| Pixel(Point::new(x, y), Index(index))));
            for ((x, y), index) in places {
                if let (0..13, Some(row)) = (x, u32::try_from(y).ok().filter(|y| rows.contains(y))) {
                    expected[(row - rows.start) as usize * PITCH + x as usize] = index;
                }
            }
            prop_assert_eq!(drawn, expected);
        }
    }
}
