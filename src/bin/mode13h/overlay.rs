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
/// Pixels between the text and the frame's edge.
const MARGIN: i32 = 4;

/// Where text begins.
#[derive(Clone, Copy)]
pub(crate) enum Place {
    /// In the top left corner, downwards.
    Top,
    /// So that it ends in the bottom left corner.
    Bottom,
}

/// Writes `lines` in the palette's lightest on its darkest colour, over whatever is there. What does not fit is left
/// out.
pub(crate) fn write<Line: AsRef<str>>(vga: &mut Vga, place: Place, lines: &[Line]) {
    let palette = vga.palette();
    let style = MonoTextStyleBuilder::new()
        .font(&FONT_6X10)
        .text_color(Index(palette.nearest(Rgb::WHITE)))
        .background_color(Index(palette.nearest(Rgb::BLACK)))
        .build();
    let mut frame = Frame::from(vga);
    // A dozen lines.
    let height = LINE * lines.len() as i32;
    let mut top = match place {
        Place::Top => MARGIN,
        Place::Bottom => Vga::HEIGHT as i32 - MARGIN - height,
    };
    for line in lines {
        // A frame takes every pixel: the error is one that cannot be made.
        let Ok(_) = Text::with_baseline(line.as_ref(), Point::new(MARGIN, top), style, Baseline::Top).draw(&mut frame);
        top += LINE;
    }
}
