//! Frames and error maps as PNG inside the file.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use mode13h::export::{Picture, Png};
use mode13h::palette::Palette;
use mode13h::palette::Rgb;

/// Up to how many shades a colour of the error map goes, what it is called, and the colour. The first is the best that
/// rounding can do; from dark to light, even in lightness.
pub(super) const COLORS: [(f32, &str, u32); 7] = [
    (0.5, "up to ½", 0x18_0f3e),
    (1.0, "up to 1", 0x45_1077),
    (2.0, "up to 2", 0x72_1f81),
    (4.0, "up to 4", 0xb5_367a),
    (8.0, "up to 8", 0xf1_605d),
    (16.0, "up to 16", 0xfe_af77),
    (f32::INFINITY, "more", 0xfc_fdbf),
];

/// Colour where no error was taken: the background, and pixels that show another face than they should.
pub(super) const NONE: u32 = 0x8a_9099;

/// A frame of greys, as a URI; none if it is not one of 320 × 200.
pub(super) fn frame(greys: &[u8]) -> Option<String> {
    let mut grey = [Rgb::BLACK; 256];
    for (color, level) in grey.iter_mut().zip(0..=255) {
        *color = Rgb { r: level, g: level, b: level };
    }
    uri(greys, grey)
}

/// An error map in [`COLORS`], as a URI.
pub(super) fn error_map(errors: &[f32]) -> Option<String> {
    let mut colors = [rgb(NONE); 256];
    for (color, (_, _, code)) in colors.iter_mut().zip(COLORS) {
        *color = rgb(code);
    }
    let bytes: Vec<u8> = errors.iter().map(|&error| color_of(error)).collect();
    uri(&bytes, colors)
}

/// The place of an error's colour; the last one's successor where there is none.
fn color_of(error: f32) -> u8 {
    let places = COLORS.iter().zip(0..).find(|((up_to, ..), _)| error <= *up_to);
    places.map_or(COLORS.len() as u8, |(_, place)| place)
}

fn uri(pixels: &[u8], colors: [Rgb; 256]) -> Option<String> {
    let palette = Palette::from_colors(colors);
    let file = Png::default().encode(&Picture::mode_13h(pixels, &palette)).ok()?;
    Some(format!("data:image/png;base64,{}", STANDARD.encode(file)))
}

const fn rgb(code: u32) -> Rgb {
    let [_, r, g, b] = code.to_be_bytes();
    Rgb { r, g, b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_error_has_the_colour_of_its_bin() {
        let errors = [0.0, 0.5, 0.500_1, 1.0, 1.5, 3.0, 8.0, 9.0, 16.5, f32::INFINITY, f32::NAN];
        assert_eq!(errors.map(color_of), [0, 0, 1, 1, 2, 3, 4, 5, 6, 6, 7]);
    }

    #[test]
    fn a_picture_of_another_size_is_none() {
        assert_eq!(frame(&[]), None);
        assert!(frame(&[0; 64_000]).is_some_and(|uri| uri.starts_with("data:image/png;base64,iVBOR")));
    }
}
