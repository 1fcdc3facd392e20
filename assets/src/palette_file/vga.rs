//! Raw VGA: 256 times red, green, blue, ready for a single `rep outsb` to port 3C9h.

use mode13h::palette::{Palette, Rgb};

use super::error::{PaletteError, PaletteErrorKind};

const LENGTH: usize = 768;

pub(super) fn recognizes(bytes: &[u8]) -> bool {
    bytes.len() == LENGTH
}

pub(super) fn read(bytes: &[u8]) -> Result<Palette, PaletteError> {
    if bytes.len() != LENGTH {
        let kind = PaletteErrorKind::Length { expected: "768", found: bytes.len() };
        return Err(PaletteError::at_offset(bytes.len().min(LENGTH), kind));
    }
    let has_8_bits = bytes.iter().any(|&value| value > 63);
    let mut colors = [Rgb::BLACK; 256];
    for (color, value) in colors.iter_mut().zip(bytes.as_chunks::<3>().0) {
        let [r, g, b] = *value;
        *color = if has_8_bits { Rgb::new(r, g, b) } else { Rgb::from_dac(*value) };
    }
    Ok(Palette::from_colors(colors))
}

pub(super) fn write(palette: &Palette, _name: &str, out: &mut Vec<u8>) {
    let colors = palette.colors();
    let six_bits_keep_all = colors.iter().all(|color| color.on_dac() == *color);
    let reads_as_8_bits = colors.iter().any(|color| color.r.max(color.g).max(color.b) > 63);
    for color in colors {
        if six_bits_keep_all || !reads_as_8_bits {
            out.extend_from_slice(&color.to_dac());
        } else {
            out.extend_from_slice(&[color.r, color.g, color.b]);
        }
    }
}
