//! GIMP `.gpl`: `GIMP Palette`, headers, comments, and one colour per line, followed by a name.
//!
//! Source: `app/core/gimppalette-load.c` of GIMP, for the files that it accepts. Unlike in GIMP, which skips an
//! unreadable line with a warning, a broken line is an error.

use mode13h::palette::Palette;

use super::colors::Colors;
use super::error::{Excerpt, PaletteError, PaletteErrorKind};
use super::text::{Lines, expect, first_line_is, three_numbers};

const MAGIC: &str = "GIMP Palette";

/// The lines that may precede the first colour; the last is Aseprite's.
const HEADERS: [&[u8]; 3] = [b"Name:", b"Columns:", b"Channels:"];

pub(super) fn recognizes(bytes: &[u8]) -> bool {
    first_line_is(bytes, MAGIC)
}

pub(super) fn read(bytes: &[u8]) -> Result<Palette, PaletteError> {
    let mut lines = Lines::new(bytes);
    expect(&mut lines, MAGIC)?;
    let mut colors = Colors::new();
    let mut end = lines.next_number();
    for (number, line) in lines {
        let is_header = colors.count() == 0 && HEADERS.iter().any(|header| line.starts_with(header));
        end = number + 1;
        if line.is_empty() || line.starts_with(b"#") || is_header {
            continue;
        }
        let Some((color, _words_of_the_name)) = three_numbers(line) else {
            return Err(PaletteError::at_line(number, PaletteErrorKind::NotThreeNumbers { found: Excerpt::of(line) }));
        };
        colors.push(number, color)?;
    }
    colors.into_palette(end, 1)
}

pub(super) fn write(palette: &Palette, name: &str, out: &mut Vec<u8>) {
    out.extend_from_slice(format!("{MAGIC}\nName: ").as_bytes());
    for c in name.chars() {
        let c = if c.is_control() { ' ' } else { c };
        out.extend_from_slice(c.encode_utf8(&mut [0; 4]).as_bytes());
    }
    out.extend_from_slice(b"\nColumns: 16\n#\n");
    for (index, color) in palette.colors().iter().enumerate() {
        out.extend_from_slice(format!("{:3} {:3} {:3}\t{index}\n", color.r, color.g, color.b).as_bytes());
    }
}
