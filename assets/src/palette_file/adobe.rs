//! Adobe `.act`: 256 times red, green, blue in 8 bits. A longer variant has 4 more bytes: the number of colours in use,
//! and the transparent one (FFFFh for none), each 16 bits, high byte first.
//!
//! Source: Adobe Photoshop File Formats Specification, "Color Table". Unused colours are read as black; the transparent
//! one is treated like any other.

use mode13h::palette::{Palette, Rgb};

use super::error::{Excerpt, PaletteError, PaletteErrorKind};

const LENGTH: usize = 768;
const LENGTH_WITH_COUNT: usize = 772;

pub(super) fn recognizes_772(bytes: &[u8]) -> bool {
    bytes.len() == LENGTH_WITH_COUNT
}

pub(super) fn read(bytes: &[u8]) -> Result<Palette, PaletteError> {
    let (table, count) = match bytes.split_at_checked(LENGTH) {
        Some((table, [])) => (table, 256),
        Some((table, &[high, low, _, _])) => (table, count_of(u16::from_be_bytes([high, low]))?),
        _ => {
            let kind = PaletteErrorKind::Length { expected: "768 or 772", found: bytes.len() };
            let offset = bytes.len().min(LENGTH_WITH_COUNT);
            return Err(PaletteError::at_offset(offset, kind));
        }
    };
    let mut colors = [Rgb::BLACK; 256];
    for (color, &[r, g, b]) in colors.iter_mut().zip(table.as_chunks::<3>().0).take(count) {
        *color = Rgb::new(r, g, b);
    }
    Ok(Palette::from_colors(colors))
}

fn count_of(count: u16) -> Result<usize, PaletteError> {
    if (1..=256).contains(&count) {
        return Ok(usize::from(count));
    }
    // As it would be in a text file.
    let found = Excerpt::of(format!("{count}").as_bytes());
    Err(PaletteError::at_offset(LENGTH, PaletteErrorKind::Count { found }))
}

pub(super) fn write(palette: &Palette, _name: &str, out: &mut Vec<u8>) {
    for color in palette.colors() {
        out.extend_from_slice(&[color.r, color.g, color.b]);
    }
}

pub(super) fn write_772(palette: &Palette, name: &str, out: &mut Vec<u8>) {
    write(palette, name, out);
    // 256 colours, none transparent.
    out.extend_from_slice(&[1, 0, 0xFF, 0xFF]);
}
