//! Text on the frame.

use embedded_graphics::Drawable;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{Point, Size};
use embedded_graphics::mono_font::ascii::{FONT_5X8, FONT_6X10};
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle, MonoTextStyleBuilder};
use embedded_graphics::primitives::Rectangle;
use embedded_graphics::text::{Alignment, Baseline, Text, TextStyleBuilder};
use mode13h::palette::Rgb;
use mode13h::raster::{Frame, Index};
use mode13h::vga::Vga;

/// Rows from one line of the small letters, 5 × 8, to the next.
pub(crate) const SMALL_LINE: i32 = 8;
/// Which end of a line stands where it is put.
#[derive(Clone, Copy)]
pub(crate) enum Anchor {
    /// Its first letter.
    Left,
    /// Its last letter.
    Right,
}

/// The palette's lightest on its darkest colour.
fn style<'font>(vga: &Vga, font: &'font MonoFont<'font>) -> MonoTextStyle<'font, Index> {
    let palette = vga.palette();
    MonoTextStyleBuilder::new()
        .font(font)
        .text_color(Index(palette.nearest(Rgb::WHITE)))
        .background_color(Index(palette.nearest(Rgb::BLACK)))
        .build()
}

/// Writes a line whose upper left or right corner is given.
pub(crate) fn write_at(vga: &mut Vga, (x, y): (i32, i32), anchor: Anchor, line: &str) {
    let style = style(vga, &FONT_6X10);
    let alignment = match anchor {
        Anchor::Left => Alignment::Left,
        Anchor::Right => Alignment::Right,
    };
    let place = TextStyleBuilder::new().alignment(alignment).baseline(Baseline::Top).build();
    // A frame takes every pixel: the error is one that cannot be made.
    let Ok(_) = Text::with_text_style(line, Point::new(x, y), style, place).draw(&mut Frame::from(vga));
}

/// Writes lines in small letters, the first from an upper left corner.
pub(crate) fn write_small(vga: &mut Vga, (x, y): (i32, i32), lines: &[String]) {
    let style = style(vga, &FONT_5X8);
    let mut frame = Frame::from(vga);
    for (top, line) in (y..).step_by(SMALL_LINE.unsigned_abs() as usize).zip(lines) {
        let Ok(_) = Text::with_baseline(line, Point::new(x, top), style, Baseline::Top).draw(&mut frame);
    }
}

/// Fills a rectangle with an entry of the palette.
pub(crate) fn block(vga: &mut Vga, (x, y): (i32, i32), (width, height): (u32, u32), entry: u8) {
    let area = Rectangle::new(Point::new(x, y), Size::new(width, height));
    let Ok(()) = Frame::from(vga).fill_solid(&area, Index(entry));
}
