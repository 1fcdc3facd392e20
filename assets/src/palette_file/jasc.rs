//! JASC `.pal` of Paint Shop Pro: `JASC-PAL`, `0100`, the number of colours, then one colour per line.

use mode13h::palette::{Palette, Rgb};

use super::colors::Colors;
use super::error::{Excerpt, PaletteError, PaletteErrorKind};
use super::text::{Lines, decimal, expect, first_line_is, three_numbers};

const MAGIC: &str = "JASC-PAL";
const VERSION: &str = "0100";

pub(super) fn recognizes(bytes: &[u8]) -> bool {
    first_line_is(bytes, MAGIC)
}

pub(super) fn read(bytes: &[u8]) -> Result<Palette, PaletteError> {
    let mut lines = Lines::new(bytes);
    expect(&mut lines, MAGIC)?;
    expect(&mut lines, VERSION)?;

    let count_line = lines.next_number();
    let text = lines.next().map_or(&[][..], |(_, line)| line);
    let announced = match decimal(text, 256) {
        Some(count) if count > 0 => count as usize,
        _ => return Err(PaletteError::at_line(count_line, PaletteErrorKind::Count { found: Excerpt::of(text) })),
    };

    let mut colors = Colors::new();
    let mut end = lines.next_number();
    for (number, line) in lines {
        if line.is_empty() {
            continue;
        }
        end = number + 1;
        if colors.count() == announced {
            return Err(PaletteError::at_line(number, PaletteErrorKind::MoreThanAnnounced { announced }));
        }
        let Some(color) = color(line) else {
            return Err(PaletteError::at_line(number, PaletteErrorKind::NotThreeNumbers { found: Excerpt::of(line) }));
        };
        colors.push(number, color)?;
    }
    colors.into_palette(end, announced)
}

/// The colour of a line: three numbers, and some programs add its opacity, which is ignored.
fn color(line: &[u8]) -> Option<Rgb> {
    let (color, mut rest) = three_numbers(line)?;
    let is_opacity = |word| decimal(word, 255).is_some();
    (rest.next().is_none_or(is_opacity) && rest.next().is_none()).then_some(color)
}

pub(super) fn write(palette: &Palette, _name: &str, out: &mut Vec<u8>) {
    // It comes from Windows: lines end in CR LF.
    out.extend_from_slice(format!("{MAGIC}\r\n{VERSION}\r\n256\r\n").as_bytes());
    for color in palette.colors() {
        out.extend_from_slice(format!("{} {} {}\r\n", color.r, color.g, color.b).as_bytes());
    }
}
