//! Letters, and rows of text in lines that fit.

use embedded_graphics::mono_font::MonoFont;
use embedded_graphics::mono_font::iso_8859_1::{FONT_6X9, FONT_6X12, FONT_9X15};
use mode13h::palette::Rgb;

/// The minimum number of characters per line, and of lines, for a panel: smaller windows have none.
pub(super) const MIN_SIZE: (usize, usize) = (8, 2);

/// Sets of letters, each of fixed width. In each the full stop is a square dot.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Letters {
    /// 9 × 15.
    Large,
    /// 6 × 12.
    Small,
    /// 6 × 9, for windows that are smaller than the frame.
    Tiny,
}

impl Letters {
    /// Letters that suit a window.
    pub(super) fn of_window(width: usize, height: usize) -> Letters {
        match (width, height) {
            (800.., 600..) => Letters::Large,
            (320.., 240..) => Letters::Small,
            _ => Letters::Tiny,
        }
    }

    pub(super) fn font(self) -> &'static MonoFont<'static> {
        match self {
            Letters::Large => &FONT_9X15,
            Letters::Small => &FONT_6X12,
            Letters::Tiny => &FONT_6X9,
        }
    }

    /// Pixels from one letter to the next.
    pub(crate) fn width(self) -> usize {
        self.font().character_size.width as usize
    }

    /// Pixels from one line to the next, one more than a letter is high.
    pub(crate) fn line(self) -> usize {
        self.font().character_size.height as usize + 1
    }

    /// The next smaller set.
    pub(super) fn smaller(self) -> Option<Letters> {
        match self {
            Letters::Large => Some(Letters::Small),
            Letters::Small | Letters::Tiny => None,
        }
    }
}

/// A row of a panel: a head, or a block of colour, and the text beside it, which is wrapped in its own column.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Row {
    pub(super) head: Head,
    pub(super) text: String,
}

#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Head {
    None,
    Words(String),
    Color(Rgb),
}

impl Row {
    /// A head, such as a key's name, and its text.
    pub(crate) fn new(head: impl Into<String>, text: impl Into<String>) -> Row {
        Row { head: Head::Words(head.into()), text: text.into() }
    }

    /// Text over the panel's whole width.
    pub(crate) fn text(text: impl Into<String>) -> Row {
        Row { head: Head::None, text: text.into() }
    }

    /// A block of colour, as in a legend, and its text.
    pub(crate) fn color(color: Rgb, text: impl Into<String>) -> Row {
        Row { head: Head::Color(color), text: text.into() }
    }

    /// Letters that the head takes, with the space after it.
    fn head_width(&self) -> usize {
        match &self.head {
            Head::None => 0,
            Head::Words(words) => words.chars().count() + 1,
            Head::Color(_) => 3,
        }
    }
}

/// A line of a panel as it is drawn: its head, and the text from a column on.
pub(super) struct Laid {
    pub(super) head: Head,
    pub(super) column: usize,
    pub(super) text: String,
}

impl Laid {
    pub(super) fn width(&self) -> usize {
        let head = if let Head::Words(words) = &self.head { words.chars().count() } else { 0 };
        head.max(self.column + self.text.chars().count())
    }
}

/// Rows in lines of at most `columns` letters; all text beside heads begins in one column.
pub(super) fn laid(rows: &[Row], columns: usize) -> Vec<Laid> {
    let widest = rows.iter().map(Row::head_width).max().unwrap_or(0);
    // If that leaves no room for words, text goes below its head.
    let (beside, indent) = if widest + MIN_SIZE.0 <= columns { (true, widest) } else { (false, 0) };
    let mut lines = Vec::new();
    for row in rows {
        let mut head = row.head.clone();
        let column = if head == Head::None { 0 } else { indent };
        if let (Head::Words(words), false) = (&head, beside) {
            let heads = wrapped(words, columns).into_iter();
            lines.extend(heads.map(|line| Laid { head: Head::Words(line), column: 0, text: String::new() }));
            head = Head::None;
        }
        let column = if let (Head::Color(_), false) = (&head, beside) { 3.min(columns - 1) } else { column };
        for text in wrapped(&row.text, columns - column) {
            lines.push(Laid { head: std::mem::replace(&mut head, Head::None), column, text });
        }
    }
    lines
}

/// A text in lines of at most `columns` letters. Words may be cut after a hyphen; those longer than a line are cut
/// where the line ends.
pub(crate) fn wrapped(text: &str, columns: usize) -> Vec<String> {
    let options = textwrap::Options::new(columns.max(1)).word_separator(textwrap::WordSeparator::AsciiSpace);
    textwrap::wrap(text, options).into_iter().map(Into::into).collect()
}
