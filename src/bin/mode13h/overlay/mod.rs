//! What is laid over the picture, at the window's own resolution: panels of text, blocks, lines and small pictures.
//!
//! A [`Sheet`] is a list of things to draw, laid out for a window of one size. Equal sheets look the same, which tells
//! whether a picture that stands still has to be shown again. Nothing is drawn before [`Sheet::draw`].

mod text;

use embedded_graphics::Drawable;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::Point;
use embedded_graphics::mono_font::MonoTextStyle;
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::primitives::{Line, Primitive, PrimitiveStyle};
use embedded_graphics::text::{Baseline, Text};
use mode13h::palette::Rgb;
use mode13h::window::{Area, Canvas};

use text::{Head, LEAST, Laid, laid};
pub(crate) use text::{Letters, Row, wrapped};

/// Text of its own weight.
pub(crate) const TEXT: Rgb = Rgb::new(0xF0, 0xF0, 0xF0);
/// What names the text beside it.
pub(crate) const HEAD: Rgb = Rgb::new(0xFF, 0xD0, 0x60);
/// What went wrong.
pub(crate) const WRONG: Rgb = Rgb::new(0xFF, 0x90, 0x80);
/// What panels lay under their text, and how much of 255 of it is seen: the picture shines through.
const PANEL: (Rgb, u8) = (Rgb::new(0x08, 0x08, 0x10), 176);
/// Pixels between a panel's edge and its text, and between a panel and the window's edge.
const PADDING: usize = 4;
/// Where a panel stands.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Side {
    Left,
    Right,
}

/// A thing on a sheet.
#[derive(Clone, PartialEq, Debug)]
enum Thing {
    /// A rectangle; `share` of 255 of it is seen.
    Block {
        area: Area,
        color: Rgb,
        share: u8,
    },
    /// A picture, stretched over a rectangle.
    Picture {
        area: Area,
        colors: Vec<Rgb>,
        columns: usize,
    },
    Line {
        from: (i32, i32),
        to: (i32, i32),
        color: Rgb,
        thickness: u32,
    },
    Text {
        at: (usize, usize),
        letters: Letters,
        color: Rgb,
        text: String,
    },
}

/// What is laid over the picture in a window of one size.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Sheet {
    width: usize,
    height: usize,
    picture: Area,
    letters: Letters,
    things: Vec<Thing>,
    /// Rows that are free for panels, at the left and at the right.
    free: [(usize, usize); 2],
}

impl Sheet {
    /// An empty one.
    pub(crate) fn new((width, height): (usize, usize)) -> Sheet {
        let (picture, letters) = (Area::within(width, height), Letters::of_window(width, height));
        let free = [(PADDING, height.saturating_sub(PADDING)); 2];
        Sheet { width, height, picture, letters, things: Vec::new(), free }
    }

    /// The window's columns and rows.
    pub(crate) fn size(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    /// Where the picture stands in the window. [`Area::from_frame`] finds a pixel of the frame there.
    pub(crate) fn picture_area(&self) -> Area {
        self.picture
    }

    /// The letters that suit the window.
    pub(crate) fn letters(&self) -> Letters {
        self.letters
    }

    /// Fills a rectangle; `share` of 255 of the colour is seen, the rest is what is below.
    pub(crate) fn block(&mut self, area: Area, color: Rgb, share: u8) {
        self.things.push(Thing::Block { area, color, share });
    }

    /// A picture of `columns` pixels a row, stretched over a rectangle.
    pub(crate) fn picture(&mut self, area: Area, colors: Vec<Rgb>, columns: usize) {
        self.things.push(Thing::Picture { area, colors, columns });
    }

    /// A line between two points of the window. What lies beyond it is left out.
    pub(crate) fn line(&mut self, from: (i32, i32), to: (i32, i32), color: Rgb, thickness: u32) {
        self.things.push(Thing::Line { from, to, color, thickness });
    }

    /// A line of text whose upper left corner is given, on nothing: it is for the caller to see that it fits.
    pub(crate) fn text(&mut self, at: (usize, usize), letters: Letters, color: Rgb, text: impl Into<String>) {
        self.things.push(Thing::Text { at, letters, color, text: text.into() });
    }

    /// A message at the lower edge, in the middle, above those that stand there. Panels that are laid later keep clear of
    /// it.
    pub(crate) fn message(&mut self, color: Rgb, text: &str) {
        let letters = self.letters;
        let columns = self.width.saturating_sub(4 * PADDING) / letters.width();
        let bottom = self.free[0].1.min(self.free[1].1);
        let lines = wrapped(text, columns);
        let height = lines.len() * letters.line() + 2 * PADDING;
        if columns < LEAST.0 || height + PADDING > bottom {
            return;
        }
        let widest = lines.iter().map(|line| line.chars().count()).max().unwrap_or(0);
        let width = widest * letters.width() + 2 * PADDING;
        let (left, mut top) = ((self.width - width) / 2, bottom - height);
        self.block(Area { left, top, width, height }, PANEL.0, PANEL.1);
        self.free.iter_mut().for_each(|(_, bottom)| *bottom = top.saturating_sub(PADDING));
        top += PADDING;
        for line in lines {
            let indent = (widest - line.chars().count()) * letters.width() / 2;
            self.text((left + PADDING + indent, top), letters, color, line);
            top += letters.line();
        }
    }

    /// A translucent panel at a side, below those that stand there: no wider than half the window, or, if it `is_alone`,
    /// than the whole, and in smaller letters where it has to be. What still does not fit stands on further pages, which
    /// `more` says how to reach. Returns the number of pages; without room for any, 0.
    pub(crate) fn panel(&mut self, side: Side, rows: &[Row], is_alone: bool, page: usize, more: &str) -> usize {
        let (top, bottom) = self.free[side as usize];
        let room = (bottom.saturating_sub(top)).saturating_sub(2 * PADDING);
        let inner = |width: usize| width.saturating_sub(4 * PADDING);
        let widths = [inner(self.width * 2 / 5), inner(self.width / 2), inner(self.width)];
        let widths = if is_alone { &widths[..] } else { &widths[..2] };
        let sets = || [Some(self.letters), self.letters.smaller()].into_iter().flatten();
        let fits = |letters: Letters, width: usize| {
            let columns = width / letters.width();
            (columns >= LEAST.0).then(|| laid(rows, columns)).filter(|lines| lines.len() * letters.line() <= room)
        };
        // In large letters it may be half as wide as the window; before it is wider, letters are smaller.
        let ways = sets().flat_map(|letters| widths[..2].iter().map(move |&width| (letters, width)));
        let smallest = sets().last().unwrap_or(self.letters);
        let ways = ways.chain(widths[2..].iter().map(|&width| (smallest, width)));
        let found = ways.filter_map(|(letters, width)| Some((letters, fits(letters, width)?))).next();
        if let Some((letters, lines)) = found {
            self.lay(side, letters, &lines);
            return 1;
        }
        let letters = smallest;
        let columns = widths.last().map_or(0, |width| width / letters.width());
        // The last line says what page it is.
        let per_page = (room / letters.line()).saturating_sub(1);
        if columns < LEAST.0 || per_page + 1 < LEAST.1 {
            return 0;
        }
        let lines = laid(rows, columns);
        let pages = lines.len().div_ceil(per_page);
        let page = page.min(pages - 1);
        let mut lines: Vec<Laid> = lines.into_iter().skip(page * per_page).take(per_page).collect();
        let said = format!("{} of {pages}, {more}", page + 1);
        let said = wrapped(&said, columns).into_iter().next().unwrap_or_default();
        lines.push(Laid { head: Head::Words(said), column: 0, text: String::new() });
        self.lay(side, letters, &lines);
        pages
    }

    /// Lays lines that fit.
    fn lay(&mut self, side: Side, letters: Letters, lines: &[Laid]) {
        let widest = lines.iter().map(Laid::width).max().unwrap_or(0);
        let (width, height) = (widest * letters.width() + 2 * PADDING, lines.len() * letters.line() + 2 * PADDING);
        let top = self.free[side as usize].0;
        let left = match side {
            Side::Left => PADDING,
            Side::Right => self.width - PADDING - width,
        };
        self.block(Area { left, top, width, height }, PANEL.0, PANEL.1);
        self.free[side as usize].0 = top + height + PADDING;
        let (left, mut top) = (left + PADDING, top + PADDING);
        for Laid { head, column, text } in lines {
            match head {
                Head::None => {}
                Head::Words(words) => self.text((left, top), letters, HEAD, words),
                Head::Color(color) => {
                    let area = Area { left, top, width: 2 * letters.width(), height: letters.line() };
                    self.block(area, *color, 255);
                }
            }
            self.text((left + column * letters.width(), top), letters, TEXT, text);
            top += letters.line();
        }
    }

    /// Draws it all.
    pub(crate) fn draw(&self, canvas: &mut Canvas<'_>) {
        for thing in &self.things {
            match thing {
                Thing::Block { area, color, share: 255 } => canvas.fill(*area, *color),
                Thing::Block { area, color, share } => canvas.blend(*area, *color, *share),
                Thing::Picture { area, colors, columns } => canvas.stretch(*area, colors, *columns),
                Thing::Line { from, to, color, thickness } => {
                    let line = Line::new(Point::new(from.0, from.1), Point::new(to.0, to.1));
                    let Ok(()) = line.into_styled(PrimitiveStyle::with_stroke(rgb888(*color), *thickness)).draw(canvas);
                }
                Thing::Text { at, letters, color, text } => write(canvas, *at, *letters, *color, text),
            }
        }
    }
}

fn rgb888(color: Rgb) -> Rgb888 {
    Rgb888::new(color.r, color.g, color.b)
}

/// Letters that the font lacks are question marks.
fn write<Target: DrawTarget<Color = Rgb888>>(
    target: &mut Target,
    (x, y): (usize, usize),
    letters: Letters,
    color: Rgb,
    text: &str,
) {
    let style = MonoTextStyle::new(letters.font(), rgb888(color));
    // A canvas takes every pixel: there is no error to make.
    let _ = Text::with_baseline(text, Point::new(x as i32, y as i32), style, Baseline::Top).draw(target);
}
