//! Two panels side by side as a picture: enlarged pixels, their centres, the true edges, marks and captions.

use embedded_graphics::Drawable;
use embedded_graphics::geometry::{Point, Size};
use embedded_graphics::mono_font::iso_8859_1::{FONT_9X15, FONT_9X15_BOLD};
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::prelude::Primitive;
use embedded_graphics::primitives::{PrimitiveStyle, Rectangle};
use embedded_graphics::text::{Baseline, Text};

use super::enlarged::Enlarged;
use super::face::Segment;
use super::panel::{Mark, Panel};
use super::{Case, Comparison};
use crate::lines::lines;
use mode13h::export::{Picture, PictureError, PixelShape, Png};
use mode13h::palette::Rgb;
use mode13h::raster::{Frame, Index};

/// Pixels per enlarged pixel.
const ZOOM: i32 = Enlarged::ZOOM;
const MARGIN: i32 = 16;
/// Space between the panels.
const GAP: i32 = 24;
/// Height of a line of text.
const LINE: i32 = 20;
/// Width of a letter.
const LETTER: i32 = 9;

/// Colours other than the frame's, at the end of the picture's palette.
#[derive(Clone, Copy)]
#[repr(u8)]
enum Ink {
    Paper,
    Words,
    Right,
    Wrong,
    /// A pixel that was not drawn.
    Empty,
    Grid,
    Edge,
    CentreOnDark,
    CentreOnLight,
    LeftOut,
    Twice,
    Outside,
    Shade,
    Face,
}

impl Ink {
    const COLORS: [u32; 14] = [
        0xFBFAF5, 0x202028, 0x0A6B2D, 0xB01020, 0x1B2547, 0x2B3863, 0x28C8F0, 0xA8B4D8, 0x283048, 0xFF4040, 0xFF9A1F,
        0xFF3FC8, 0xFFE81F, 0xFFE81F,
    ];
    /// The first index of these colours.
    const FIRST: u8 = (256 - Self::COLORS.len()) as u8;

    fn index(self) -> Index {
        // FIRST + 13 is 255.
        Index(Self::FIRST + self as u8)
    }

    fn of(mark: Mark) -> Self {
        match mark {
            Mark::LeftOut => Self::LeftOut,
            Mark::Twice => Self::Twice,
            Mark::Outside => Self::Outside,
            Mark::Shade => Self::Shade,
            Mark::Face => Self::Face,
        }
    }
}

/// The picture's palette, and the indices in it of both panels' bytes.
struct Inks {
    of_byte: [u8; 256],
    light: [bool; 256],
    colors: [Rgb; 256],
}

impl Inks {
    fn new(comparison: &Comparison) -> Self {
        let mut used = [false; 256];
        for panel in [&comparison.fault, &comparison.right] {
            for (byte, writes) in panel.pixels().iter().zip(panel.writes()) {
                used[usize::from(*byte)] |= *writes > 0;
            }
        }
        // The colours that the DAC shows; it has only 64 greys for 256. Bytes with the same colour share an index.
        let palette = comparison.palette.on_dac();
        let mut inks = Self { of_byte: [0; 256], light: [false; 256], colors: [Rgb::BLACK; 256] };
        let mut known: Vec<Rgb> = Vec::new();
        for byte in (0..=255_u8).filter(|byte| used[usize::from(*byte)]) {
            let color = palette[byte];
            let place = known.iter().position(|there| *there == color).unwrap_or(known.len());
            // There is room for 242; if a case ever has more, the rest share the last.
            let index = place.min(usize::from(Ink::FIRST) - 1);
            if place == known.len() {
                known.push(color);
            }
            inks.of_byte[usize::from(byte)] = index as u8;
            inks.colors[index] = color;
            inks.light[usize::from(byte)] = color.brightness() > Rgb::new(110, 110, 110).brightness();
        }
        for (entry, color) in inks.colors[usize::from(Ink::FIRST)..].iter_mut().zip(Ink::COLORS) {
            *entry = Rgb::from(color);
        }
        inks
    }
}

/// The picture as the bytes of a PNG.
pub(super) fn png(case: &Case, comparison: &Comparison) -> Result<Vec<u8>, PictureError> {
    let inks = Inks::new(comparison);
    let (columns, rows) = (comparison.right.width() as i32, comparison.right.height() as i32);
    let (panel_width, panel_height) = (columns * ZOOM, rows * ZOOM);
    let width = 2 * MARGIN + 2 * panel_width + GAP;
    // Positive.
    let in_all = ((width - 2 * MARGIN) / LETTER) as usize;
    let in_panel = (panel_width / LETTER) as usize;
    let head = lines(case.sentence, in_all);
    let captions =
        [("WRONG", case.wrong), ("RIGHT", case.right)].map(|(side, is)| lines(&format!("{side}: {is}"), in_panel));
    let caption_lines = captions[0].len().max(captions[1].len()) as i32;
    let panels_top = MARGIN + LINE * (1 + head.len() as i32 + caption_lines) + 16;
    let marks: Vec<Mark> = Mark::ALL.into_iter().filter(|mark| comparison.fault.count(*mark) > 0).collect();
    let below = panels_top + panel_height + 10;
    let height = below + LINE * (marks.len().max(1) as i32 + 1) + 6 + MARGIN;

    let (w, h) = (width as usize, height as usize);
    let mut pixels = vec![Ink::Paper.index().0; w * h];
    // A picture of about 1,100 × 700; if a case ever exceeds a frame, the sheet stays empty.
    if let Ok(mut frame) = Frame::new(&mut pixels, width as u32, height as u32, w) {
        let title = format!("{}  {}", case.id, case.title);
        words(&mut frame, MARGIN, MARGIN, &title, Ink::Words, &FONT_9X15_BOLD);
        for (i, line) in (1..).zip(&head) {
            words(&mut frame, MARGIN, MARGIN + LINE * i, line, Ink::Words, &FONT_9X15);
        }
        let lefts = [MARGIN, MARGIN + panel_width + GAP];
        let panels = [&comparison.fault, &comparison.right];
        for ((left, lines), ink) in lefts.into_iter().zip(&captions).zip([Ink::Wrong, Ink::Right]) {
            let top = MARGIN + LINE * (1 + head.len() as i32) + 8;
            for (i, line) in (0..).zip(lines) {
                words(&mut frame, left, top + LINE * i, line, ink, &FONT_9X15_BOLD);
            }
        }
        for (left, panel) in lefts.into_iter().zip(panels) {
            enlarge(&mut frame, Point::new(left, panels_top), panel, &comparison.outline, &inks);
        }
        for (i, mark) in (0..).zip(&marks) {
            let top = below + LINE * i;
            let cell = Point::new(MARGIN, top);
            rectangle(&mut frame, cell, (ZOOM, ZOOM), Ink::Empty.index());
            draw_mark(&mut frame, cell, *mark, Sides::ALL);
            let text = format!("{}: {}", mark.words(), pixels_in_words(comparison.fault.count(*mark)));
            words(&mut frame, MARGIN + 24, top, &text, Ink::Words, &FONT_9X15);
        }
        words(&mut frame, lefts[1], below, &about_right(&comparison.right), Ink::Words, &FONT_9X15);
        let legend = "dots: pixel centres; blue lines: the true edges; dark blue: not drawn; one pixel is 16 x 16";
        words(&mut frame, MARGIN, height - MARGIN - 15, legend, Ink::Words, &FONT_9X15);
    }
    let shape = PixelShape::default();
    Png::default().encode(&Picture { pixels: &pixels, width: w, height: h, pitch: w, palette: &inks.colors, shape })
}

fn pixels_in_words(count: usize) -> String {
    if count == 1 { "1 pixel".to_string() } else { format!("{count} pixels") }
}

/// Caption for the engine's own side.
fn about_right(panel: &Panel) -> String {
    let drawn = panel.writes().iter().filter(|writes| **writes > 0).count();
    match (drawn, panel.writes().iter().max()) {
        (0, _) => "the engine: nothing drawn".to_string(),
        (_, Some(1)) if panel.is_counted => format!("the engine: {}, each drawn once", pixels_in_words(drawn)),
        _ => format!("the engine: {}", pixels_in_words(drawn)),
    }
}

fn words(frame: &mut Frame<'_>, x: i32, y: i32, text: &str, ink: Ink, font: &MonoFont<'_>) {
    let style = MonoTextStyle::new(font, ink.index());
    // Drawing on a frame cannot fail.
    let Ok(_) = Text::with_baseline(text, Point::new(x, y), style, Baseline::Top).draw(frame);
}

fn rectangle(frame: &mut Frame<'_>, at: Point, size: (i32, i32), index: Index) {
    let area = Rectangle::new(at, Size::new(size.0 as u32, size.1 as u32));
    let Ok(()) = area.into_styled(PrimitiveStyle::with_fill(index)).draw(frame);
}

fn enlarge(frame: &mut Frame<'_>, at: Point, panel: &Panel, outline: &[Segment], inks: &Inks) {
    // A few dozen pixels a side.
    let enlarged = Enlarged { at: (at.x, at.y), columns: panel.width() as u16, rows: panel.height() as u16 };
    let pixels = || (0..enlarged.rows).flat_map(|y| (0..enlarged.columns).map(move |x| (x, y)));
    let byte = |x: u16, y: u16| panel.get(usize::from(x), usize::from(y));
    for (x, y) in pixels() {
        match byte(x, y) {
            Some(byte) => enlarged.cell(frame, x, y, Index(inks.of_byte[usize::from(byte)])),
            None => enlarged.empty_cell(frame, x, y, Ink::Empty.index(), Ink::Grid.index()),
        }
    }
    for y in 0..panel.height() {
        for x in 0..panel.width() {
            if let Some(mark) = panel.marks()[y * panel.width() + x] {
                draw_mark(frame, at + Point::new(x as i32 * ZOOM, y as i32 * ZOOM), mark, Sides::of(panel, x, y));
            }
        }
    }
    enlarged.edges(frame, outline, Ink::Edge.index());
    for (x, y) in pixels() {
        let light = byte(x, y).is_some_and(|byte| inks.light[usize::from(byte)]);
        enlarged.centre(frame, x, y, if light { Ink::CentreOnLight.index() } else { Ink::CentreOnDark.index() });
    }
}

/// A mark in a pixel's cell. Each has its own shape, so that colour is not the only cue. The rim is drawn only on sides
/// where the next pixel has another mark, so neighbours with the same mark share one rim.
fn draw_mark(frame: &mut Frame<'_>, cell: Point, mark: Mark, open: Sides) {
    let index = Ink::of(mark).index();
    match mark {
        Mark::LeftOut => {
            for k in 3..ZOOM - 4 {
                rectangle(frame, cell + Point::new(k, k), (2, 1), index);
                rectangle(frame, cell + Point::new(ZOOM - 2 - k, k), (2, 1), index);
            }
        }
        Mark::Twice => {
            rim(frame, cell, 2, open, index);
            rim(frame, cell + Point::new(5, 5), 1, Sides { side: ZOOM - 10, ..Sides::ALL }, index);
        }
        Mark::Outside => rim(frame, cell, 3, open, index),
        Mark::Shade | Mark::Face => rim(frame, cell, 2, open, index),
    }
}

/// Sides of a square that have a rim.
#[derive(Clone, Copy)]
struct Sides {
    left: bool,
    right: bool,
    top: bool,
    bottom: bool,
    /// Its side.
    side: i32,
}

impl Sides {
    const ALL: Self = Self { left: true, right: true, top: true, bottom: true, side: ZOOM };

    /// The sides on which pixel (`x`, `y`) has a neighbour with another mark.
    fn of(panel: &Panel, x: usize, y: usize) -> Self {
        let mark = |x: usize, y: usize| {
            let inside = x < panel.width() && y < panel.height();
            panel.marks().get(y * panel.width() + x).filter(|_| inside).copied().flatten()
        };
        let here = mark(x, y);
        let other = |x: usize, y: usize| mark(x, y) != here;
        Self {
            left: x == 0 || other(x - 1, y),
            right: other(x + 1, y),
            top: y == 0 || other(x, y - 1),
            bottom: other(x, y + 1),
            side: ZOOM,
        }
    }
}

fn rim(frame: &mut Frame<'_>, at: Point, thick: i32, sides: Sides, index: Index) {
    let side = sides.side;
    let far = side - thick;
    for (there, corner, size) in [
        (sides.left, Point::zero(), (thick, side)),
        (sides.right, Point::new(far, 0), (thick, side)),
        (sides.top, Point::zero(), (side, thick)),
        (sides.bottom, Point::new(0, far), (side, thick)),
    ] {
        if there {
            rectangle(frame, at + corner, size, index);
        }
    }
}
