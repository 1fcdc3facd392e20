//! Overlay on the picture, at the window's own resolution: panels of text, blocks, lines and small pictures.
//!
//! A [`Sheet`] is a list of things to draw, laid out for a window of one size. Equal sheets look the same, so comparing
//! them tells whether a still picture has to be shown again. Nothing is drawn before [`Sheet::draw`].

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

use text::{Head, Laid, MIN_SIZE, laid};
pub(crate) use text::{Letters, Row, wrapped};

/// Colour of ordinary text.
pub(crate) const TEXT: Rgb = Rgb::new(0xF0, 0xF0, 0xF0);
/// Colour of a row's head: the label of the text next to it.
pub(crate) const HEAD: Rgb = Rgb::new(0xFF, 0xD0, 0x60);
/// Colour of a fault.
pub(crate) const WRONG: Rgb = Rgb::new(0xFF, 0x90, 0x80);
/// Background colour of panels and its opacity, of 255: the picture shows through.
const PANEL: (Rgb, u8) = (Rgb::new(0x08, 0x08, 0x10), 176);
/// Pixels between a panel's edge and its text, and between a panel and the window's edge.
const PADDING: usize = 4;
/// The side of the window that a panel is on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Side {
    Left,
    Right,
}

/// An item on a sheet.
#[derive(Clone, PartialEq, Debug)]
enum Thing {
    /// A rectangle with an opacity of `share` in 255.
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

/// Items to be laid over the picture in a window of one size.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Sheet {
    width: usize,
    height: usize,
    picture: Area,
    letters: Letters,
    things: Vec<Thing>,
    /// Rows that are free for panels, on the left and on the right.
    free: [(usize, usize); 2],
}

impl Sheet {
    /// An empty sheet.
    pub(crate) fn new((width, height): (usize, usize)) -> Sheet {
        let (picture, letters) = (Area::within(width, height), Letters::of_window(width, height));
        let free = [(PADDING, height.saturating_sub(PADDING)); 2];
        Sheet { width, height, picture, letters, things: Vec::new(), free }
    }

    /// Area of the picture in the window. [`Area::from_frame`] finds a pixel of the frame there.
    pub(crate) fn picture_area(&self) -> Area {
        self.picture
    }

    /// The first row at the lower edge that is taken by messages.
    pub(crate) fn free_bottom(&self) -> usize {
        self.free[0].1.min(self.free[1].1)
    }

    /// Fills a rectangle with a colour, whose opacity is `share` in 255.
    pub(crate) fn block(&mut self, area: Area, color: Rgb, share: u8) {
        self.things.push(Thing::Block { area, color, share });
    }

    /// A picture of `columns` pixels a row, stretched over a rectangle.
    pub(crate) fn picture(&mut self, area: Area, colors: Vec<Rgb>, columns: usize) {
        self.things.push(Thing::Picture { area, colors, columns });
    }

    /// A line between two points of the window. It is clipped to the window.
    pub(crate) fn line(&mut self, from: (i32, i32), to: (i32, i32), color: Rgb, thickness: u32) {
        self.things.push(Thing::Line { from, to, color, thickness });
    }

    /// A line of text with this upper left corner, without a background. The caller must make sure that it fits.
    pub(crate) fn text(&mut self, at: (usize, usize), letters: Letters, color: Rgb, text: impl Into<String>) {
        let text = text.into();
        if !text.is_empty() {
            self.things.push(Thing::Text { at, letters, color, text });
        }
    }

    /// A message at the lower edge, in the middle, above those already there. Panels that are laid later keep clear of
    /// it.
    pub(crate) fn message(&mut self, color: Rgb, text: &str) {
        let letters = self.letters;
        let columns = self.width.saturating_sub(4 * PADDING) / letters.width();
        let bottom = self.free_bottom();
        let lines = wrapped(text, columns);
        let height = lines.len() * letters.line() + 2 * PADDING;
        if columns < MIN_SIZE.0 || height + PADDING > bottom {
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

    /// A translucent panel at a side, below those already there: no wider than half the window, or than the whole
    /// window if it `is_alone`, and in smaller letters if it has to be. Text that still does not fit goes on further
    /// pages, which `key` turns. Returns the number of pages; 0 if there is no room for any.
    pub(crate) fn panel(&mut self, side: Side, rows: &[Row], is_alone: bool, page: usize, key: &str) -> usize {
        let (top, bottom) = self.free[side as usize];
        let room = (bottom.saturating_sub(top)).saturating_sub(2 * PADDING);
        let inner = |width: usize| width.saturating_sub(4 * PADDING);
        let widths = [inner(self.width * 2 / 5), inner(self.width / 2), inner(self.width)];
        let widths = if is_alone { &widths[..] } else { &widths[..2] };
        let sets = || [Some(self.letters), self.letters.smaller()].into_iter().flatten();
        let fits = |letters: Letters, width: usize| {
            let columns = width / letters.width();
            (columns >= MIN_SIZE.0).then(|| laid(rows, columns)).filter(|lines| lines.len() * letters.line() <= room)
        };
        // In large letters it may be half as wide as the window; smaller letters are tried before it gets wider.
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
        if columns < MIN_SIZE.0 || per_page + 1 < MIN_SIZE.1 {
            return 0;
        }
        let lines = laid(rows, columns);
        let pages = lines.len().div_ceil(per_page);
        let page = page.min(pages - 1);
        let mut lines: Vec<Laid> = lines.into_iter().skip(page * per_page).take(per_page).collect();
        let (number, long) = (page + 1, format!("page {} of {pages}, {key} for the next", page + 1));
        let said = if long.len() <= columns { long } else { format!("{number}/{pages} {key}") };
        lines.push(Laid { head: Head::Words(said), column: 0, text: String::new() });
        self.lay(side, letters, &lines);
        pages
    }

    /// Lays out a panel of lines that fit.
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

    /// Draws the whole sheet.
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
    // A canvas takes every pixel, so drawing cannot fail.
    let _ = Text::with_baseline(text, Point::new(x as i32, y as i32), style, Baseline::Top).draw(target);
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// The windows that text has to fit.
    pub(crate) const WINDOWS: [(usize, usize); 5] = [(960, 720), (640, 480), (333, 251), (320, 240), (1920, 1080)];

    impl Sheet {
        /// Every word on it.
        pub(crate) fn words(&self) -> Vec<String> {
            let texts = self.things.iter().filter_map(|thing| match thing {
                Thing::Text { text, .. } => Some(text.as_str()),
                _ => None,
            });
            texts.flat_map(str::split_whitespace).map(str::to_string).collect()
        }

        /// Faults of its text: letters that reach beyond the window, that the font lacks, or that overlap those of
        /// another line.
        pub(crate) fn faults(&self) -> Vec<String> {
            let boxes = self.things.iter().filter_map(|thing| match thing {
                Thing::Text { at: (x, y), letters, text, .. } if !text.is_empty() => {
                    let size = letters.font().character_size;
                    let right = x + text.chars().count() * size.width as usize;
                    Some((*letters, text, [*x, *y, right, y + size.height as usize]))
                }
                _ => None,
            });
            let boxes: Vec<_> = boxes.collect();
            let mut faults = Vec::new();
            for (i, (letters, text, [left, top, right, bottom])) in boxes.iter().enumerate() {
                if *right > self.width || *bottom > self.height {
                    faults.push(format!("cut: {text}"));
                }
                let mapping = letters.font().glyph_mapping;
                let lacks = |letter: char| letter != '?' && mapping.index(letter) == mapping.index('?');
                if text.chars().any(lacks) {
                    faults.push(format!("no such letter: {text}"));
                }
                for (_, other, [l, t, r, b]) in &boxes[..i] {
                    if left < r && l < right && top < b && t < bottom {
                        faults.push(format!("{text} over {other}"));
                    }
                }
            }
            faults
        }
    }

    fn rows(count: usize) -> Vec<Row> {
        let word =
            |i: usize| "gouraud-8.8-reseeded 1.25 µs × ½ and_a_word_that_is_longer_than_any_line_".repeat(1 + i % 3);
        (0..count)
            .map(|i| match i % 4 {
                0 => Row::text(word(i)),
                1 => Row::color(HEAD, word(i)),
                _ => Row::new(format!("head{i}"), word(i)),
            })
            .collect()
    }

    #[test]
    fn panels_and_messages_fit_every_window_and_lose_no_letter() {
        let sizes = WINDOWS.into_iter().chain([(200, 150), (101, 99), (64, 300), (640, 48)]);
        for size in sizes {
            for count in [1, 4, 9, 40] {
                for is_alone in [true, false] {
                    let rows = rows(count);
                    let lay = |page: usize| {
                        let mut sheet = Sheet::new(size);
                        sheet.message(TEXT, "palette copper");
                        let before = sheet.things.len();
                        let pages = sheet.panel(Side::Left, &rows, is_alone, page, "I");
                        let mut panel = Sheet::new(size);
                        panel.things = sheet.things[before..].to_vec();
                        if !is_alone {
                            sheet.panel(Side::Right, &rows, is_alone, page, "H");
                        }
                        assert_eq!(sheet.faults(), [""; 0], "{count} rows in {size:?}, page {page}");
                        (pages, panel)
                    };
                    let (pages, _) = lay(0);
                    assert!(pages > 0 || size.0 < 200 || size.1 < 150, "no room in {size:?}");
                    // Together the pages have all the text, and each says which one it is.
                    let mut said = String::new();
                    for page in 0..pages {
                        let (_, mut panel) = lay(page);
                        if pages > 1 {
                            let number = panel.things.pop().map(|thing| Sheet { things: vec![thing], ..panel.clone() });
                            let number = number.map(|footer| footer.words().concat()).unwrap_or_default();
                            assert!(number.trim_start_matches("page").starts_with(&(page + 1).to_string()), "{number}");
                        }
                        said += &panel.words().concat();
                    }
                    let all = rows.iter().map(|row| match &row.head {
                        Head::Words(head) => format!("{head}{}", row.text),
                        _ => row.text.clone(),
                    });
                    let all = all.collect::<String>().replace(' ', "");
                    assert!(pages == 0 || said == all, "{count} rows in {size:?}: {said}");
                }
            }
        }
    }

    #[test]
    fn windows_without_room_for_a_word_show_none() {
        for size in [(0, 0), (1, 1), (3, 500), (40, 20), (500, 5)] {
            let mut sheet = Sheet::new(size);
            sheet.message(TEXT, "palette copper");
            assert_eq!(sheet.panel(Side::Right, &rows(9), true, 0, "H"), 0, "{size:?}");
            assert_eq!(sheet.faults(), [""; 0], "{size:?}");
        }
    }

    /// Tests that in each set of letters the full stop is a rectangle, not a small cross.
    #[test]
    fn a_full_stop_is_a_full_stop() {
        for letters in [Letters::Large, Letters::Small, Letters::Tiny] {
            let mut pixels = vec![0; 16 * 16];
            let mut canvas = Canvas::new(&mut pixels, 16, 16).expect("its size");
            write(&mut canvas, (0, 0), letters, Rgb::WHITE, ".");
            let dots: Vec<(usize, usize)> = (0..256).filter(|&i| pixels[i] != 0).map(|i| (i % 16, i / 16)).collect();
            let (&(left, top), &(right, bottom)) = (dots.first().expect("a dot"), dots.last().expect("a dot"));
            let all: Vec<_> = (top..=bottom).flat_map(|y| (left..=right).map(move |x| (x, y))).collect();
            assert_eq!(dots, all, "{letters:?}");
            assert!(bottom >= letters.line() / 2, "{letters:?}: it stands on the line");
        }
    }

    #[test]
    fn words_are_wrapped_and_long_ones_cut_behind_a_hyphen() {
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
        assert_eq!(wrapped("gouraud-8.8-reseeded 12", 16), ["gouraud-8.8-", "reseeded 12"]);
        assert_eq!(wrapped("abcdefgh", 3), ["abc", "def", "gh"]);
        assert_eq!(wrapped("", 3), [""]);
        assert_eq!(wrapped("ab", 0), ["a", "b"]);
    }

    #[test]
    fn what_is_drawn_is_what_was_laid() {
        let mut sheet = Sheet::new((40, 30));
        let area = Area { left: 5, top: 6, width: 4, height: 2 };
        sheet.picture(area, vec![Rgb::WHITE, HEAD], 2);
        sheet.block(Area { left: 0, top: 0, width: 2, height: 2 }, WRONG, 255);
        sheet.line((10, 10), (10, 12), TEXT, 1);
        let mut pixels = vec![0; 40 * 30];
        sheet.draw(&mut Canvas::new(&mut pixels, 40, 30).expect("its size"));
        let at = |x: usize, y: usize| Rgb::from(pixels[y * 40 + x]);
        assert_eq!([at(5, 6), at(6, 7), at(7, 6), at(8, 7)], [Rgb::WHITE, Rgb::WHITE, HEAD, HEAD]);
        assert_eq!([at(1, 1), at(10, 11), at(9, 6), at(2, 0)], [WRONG, TEXT, Rgb::BLACK, Rgb::BLACK]);
    }
}
