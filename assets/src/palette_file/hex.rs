//! Lospec `.hex`: one colour per line, `rrggbb`, optionally with a `#` before it.

use mode13h::palette::{Palette, Rgb};

use super::colors::Colors;
use super::error::{Excerpt, PaletteError, PaletteErrorKind};
use super::text::Lines;

/// Returns whether this is a text whose first line is a colour. A raw palette usually has control characters; one
/// without would have to begin with six digits and a line ending to be mistaken for it.
pub(super) fn recognizes(bytes: &[u8]) -> bool {
    let is_text = |byte: &u8| !byte.is_ascii_control() || byte.is_ascii_whitespace();
    bytes.iter().all(is_text)
        && Lines::new(bytes).find(|(_, line)| !line.is_empty()).is_some_and(|(_, line)| six_digits(line).is_some())
}

pub(super) fn read(bytes: &[u8]) -> Result<Palette, PaletteError> {
    let mut colors = Colors::new();
    let mut end = 1;
    for (number, line) in Lines::new(bytes) {
        end = number + 1;
        if line.is_empty() {
            continue;
        }
        let Some(color) = six_digits(line) else {
            return Err(PaletteError::at_line(number, PaletteErrorKind::NotSixHexDigits { found: Excerpt::of(line) }));
        };
        colors.push(number, color)?;
    }
    colors.into_palette(end, 1)
}

fn six_digits(line: &[u8]) -> Option<Rgb> {
    let digits = line.strip_prefix(b"#").unwrap_or(line);
    if digits.len() != 6 {
        return None;
    }
    let value = digits.iter().try_fold(0, |value, &digit| Some(value << 4 | char::from(digit).to_digit(16)?))?;
    Some(Rgb::from(value))
}

pub(super) fn write(palette: &Palette, _name: &str, out: &mut Vec<u8>) {
    for color in palette.colors() {
        out.extend_from_slice(format!("{:06x}\n", u32::from(*color)).as_bytes());
    }
}
