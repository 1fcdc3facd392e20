//! Text on the frame.

use embedded_graphics::Drawable;
use embedded_graphics::geometry::Point;
use embedded_graphics::mono_font::MonoTextStyleBuilder;
use embedded_graphics::mono_font::ascii::FONT_6X10;
use embedded_graphics::text::{Baseline, Text};
use mode13h::palette::Rgb;
use mode13h::raster::{Frame, Index};
use mode13h::vga::Vga;

/// Rows from one line of text to the next.
const LINE: i32 = 10;

/// Writes `lines` from the top left corner down, in the palette's lightest on its darkest colour, over whatever is
/// there. What does not fit is left out.
pub(crate) fn write(vga: &mut Vga, lines: &[String]) {
    let palette = vga.palette();
    let style = MonoTextStyleBuilder::new()
        .font(&FONT_6X10)
        .text_color(Index(palette.nearest(Rgb::WHITE)))
        .background_color(Index(palette.nearest(Rgb::BLACK)))
        .build();
    let mut frame = Frame::from(vga);
    for (line, top) in lines.iter().zip((4..).step_by(LINE as usize)) {
        // A frame takes every pixel: the error is one that cannot be made.
        let Ok(_) = Text::with_baseline(line, Point::new(4, top), style, Baseline::Top).draw(&mut frame);
    }
}
