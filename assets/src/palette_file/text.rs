//! Lines and numbers of text files, on bytes: palette files come in any encoding, and only their ASCII matters.

use mode13h::palette::Rgb;

use super::error::{Excerpt, PaletteError, PaletteErrorKind};

const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// The lines of a text with their numbers from 1, trimmed. LF, CR LF and CR end a line; a line ending at the end of the
/// text does not begin another line.
pub(super) struct Lines<'a> {
    rest: &'a [u8],
    number: usize,
}

impl<'a> Lines<'a> {
    pub(super) fn new(text: &'a [u8]) -> Self {
        Self { rest: text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text), number: 0 }
    }

    /// The number of the line after the last one returned.
    pub(super) const fn next_number(&self) -> usize {
        self.number + 1
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = (usize, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let end = self.rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
        let (line, rest) = match end {
            None => (self.rest, &self.rest[self.rest.len()..]),
            Some(end) => {
                let ending = if self.rest[end..].starts_with(b"\r\n") { 2 } else { 1 };
                (&self.rest[..end], &self.rest[end + ending..])
            }
        };
        self.rest = rest;
        self.number += 1;
        Some((self.number, line.trim_ascii()))
    }
}

/// Takes the next line, which must be `expected`.
pub(super) fn expect(lines: &mut Lines<'_>, expected: &'static str) -> Result<(), PaletteError> {
    let number = lines.next_number();
    let found = lines.next().map_or(&[][..], |(_, line)| line);
    if found == expected.as_bytes() {
        return Ok(());
    }
    Err(PaletteError::at_line(number, PaletteErrorKind::Expected { expected, found: Excerpt::of(found) }))
}

/// Returns whether a text's first line is `expected`.
pub(super) fn first_line_is(text: &[u8], expected: &str) -> bool {
    Lines::new(text).next().is_some_and(|(_, line)| line == expected.as_bytes())
}

/// Parses decimal digits without signs or spaces. `None` if the number is more than `most`.
pub(super) fn decimal(digits: &[u8], most: u32) -> Option<u32> {
    // `parse` would accept a sign.
    let digits = str::from_utf8(digits).ok().filter(|digits| digits.bytes().all(|digit| digit.is_ascii_digit()))?;
    digits.parse().ok().filter(|value| *value <= most)
}

/// The three numbers, 0 to 255, at the beginning of a line, and the words after them.
pub(super) fn three_numbers(line: &[u8]) -> Option<(Rgb, impl Iterator<Item = &[u8]>)> {
    let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    let mut channel = || words.next().and_then(|word| u8::try_from(decimal(word, 255)?).ok());
    let color = Rgb::new(channel()?, channel()?, channel()?);
    Some((color, words))
}
