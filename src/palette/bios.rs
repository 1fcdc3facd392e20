//! The 256 colours that the VGA BIOS loads for mode 13h.
//!
//! They are computed by a rule, which says more than a list of 768 numbers (the BIOS does not store
//! one either): the 16 colours of the text modes, 16 greys, then nine hue circles of 24 (three
//! brightnesses of three saturations), then 8 black entries. Checked against the tables in DOSBox
//! (`vga_palette` of `int10_modes.cpp`) and in KOS (`vp_gfx_256`), which agree.

use super::Palette;

/// The colours of mode 13h as the BIOS sets them. Every channel is an expanded 6-bit value. The palette has no ramps.
pub const BIOS: Palette = Palette::from_dac(&entries());

/// Entries 16 to 31, the same value for red, green and blue.
const GREYS: [u8; 16] = [0, 5, 8, 11, 14, 17, 20, 24, 28, 32, 36, 40, 45, 50, 56, 63];

/// The five channel levels of each hue circle, from least to greatest.
const CIRCLES: [[u8; 5]; 9] = [
    [0, 16, 31, 47, 63],
    [31, 39, 47, 55, 63],
    [45, 49, 54, 58, 63],
    [0, 7, 14, 21, 28],
    [14, 17, 21, 24, 28],
    [20, 22, 24, 26, 28],
    [0, 4, 8, 12, 16],
    [8, 10, 12, 14, 16],
    [11, 12, 13, 15, 16],
];

const fn entries() -> [[u8; 3]; 256] {
    let mut table = [[0; 3]; 256];
    let mut i = 0;
    while i < 16 {
        // Bits of a text colour: blue 1, green 2, red 4, bright 8. A colour bit adds two thirds of full intensity and
        // the bright bit one third, except for dark yellow, whose green is halved to make it brown.
        let bright = if i & 8 != 0 { 21 } else { 0 };
        let (r, g, b) = (i >> 2 & 1, i >> 1 & 1, i & 1);
        table[i] = [r as u8 * 42 + bright, g as u8 * 42 + bright, b as u8 * 42 + bright];
        table[16 + i] = [GREYS[i]; 3];
        i += 1;
    }
    table[6][1] = 21;
    let mut circle = 0;
    while circle < 9 {
        let mut hue = 0;
        while hue < 24 {
            table[32 + 24 * circle + hue] = color_of(&CIRCLES[circle], hue);
            hue += 1;
        }
        circle += 1;
    }
    table
}

/// A colour of a hue circle: from blue through magenta, red, yellow, green and cyan back towards blue, four steps each.
/// One channel moves while the other two stay at the extremes.
const fn color_of(levels: &[u8; 5], hue: usize) -> [u8; 3] {
    let (low, high) = (levels[0], levels[4]);
    let (rising, falling) = (levels[hue % 4], levels[4 - hue % 4]);
    match hue / 4 {
        0 => [rising, low, high],
        1 => [high, low, falling],
        2 => [high, rising, low],
        3 => [falling, high, low],
        4 => [low, high, rising],
        _ => [low, falling, high],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::Rgb;

    /// Spot checks against the published table, one of each kind.
    #[test]
    fn entries_are_those_of_the_published_table() {
        for (index, six) in [
            (0, [0x00, 0x00, 0x00]),
            (1, [0x00, 0x00, 0x2a]),
            (6, [0x2a, 0x15, 0x00]),
            (7, [0x2a, 0x2a, 0x2a]),
            (8, [0x15, 0x15, 0x15]),
            (14, [0x3f, 0x3f, 0x15]),
            (15, [0x3f, 0x3f, 0x3f]),
            (16, [0x00, 0x00, 0x00]),
            (17, [0x05, 0x05, 0x05]),
            (30, [0x38, 0x38, 0x38]),
            (31, [0x3f, 0x3f, 0x3f]),
            (32, [0x00, 0x00, 0x3f]),
            (33, [0x10, 0x00, 0x3f]),
            (36, [0x3f, 0x00, 0x3f]),
            (39, [0x3f, 0x00, 0x10]),
            (40, [0x3f, 0x00, 0x00]),
            (43, [0x3f, 0x2f, 0x00]),
            (47, [0x10, 0x3f, 0x00]),
            (51, [0x00, 0x3f, 0x2f]),
            (55, [0x00, 0x10, 0x3f]),
            (56, [0x1f, 0x1f, 0x3f]),
            (81, [0x31, 0x2d, 0x3f]),
            (104, [0x00, 0x00, 0x1c]),
            (105, [0x07, 0x00, 0x1c]),
            (130, [0x15, 0x0e, 0x1c]),
            (176, [0x00, 0x00, 0x10]),
            (201, [0x0a, 0x08, 0x10]),
            (227, [0x0f, 0x0b, 0x10]),
            (247, [0x0b, 0x0c, 0x10]),
            (248, [0x00, 0x00, 0x00]),
            (255, [0x00, 0x00, 0x00]),
        ] {
            assert_eq!(BIOS[index], Rgb::from_dac(six), "entry {index}");
        }
    }

    /// FNV-1a, 32 bits, over the 768 bytes of the published table.
    #[test]
    fn the_whole_table_has_the_published_tables_hash() {
        let hash = entries()
            .as_flattened()
            .iter()
            .fold(0x811c_9dc5_u32, |hash, &byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193));
        assert_eq!(hash, 0x3cd2_8647);
    }
}
