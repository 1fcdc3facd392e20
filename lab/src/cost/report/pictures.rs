//! Frames and error maps as PNGs inside the file.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use mode13h::export::{Picture, Png};
use mode13h::palette::{Palette, Rgb, builtin};

use crate::cost::error_levels::{ALL as LEVELS, NOT_TAKEN, index_of};

/// A frame of greys as a data URI; `None` unless it is 320 × 200.
pub(super) fn frame(greys: &[u8]) -> Option<String> {
    uri(greys, &builtin::GREY)
}

/// An error map in the colours of its levels, as a data URI.
pub(super) fn error_map(errors: &[f32]) -> Option<String> {
    let mut colors = [Rgb::from(NOT_TAKEN); 256];
    for (color, level) in colors.iter_mut().zip(LEVELS) {
        *color = Rgb::from(level.color);
    }
    let bytes: Vec<u8> = errors.iter().map(|&error| index_of(error)).collect();
    uri(&bytes, &Palette::from_colors(colors))
}

fn uri(pixels: &[u8], palette: &Palette) -> Option<String> {
    let file = Png::default().encode(&Picture::mode_13h(pixels, palette)).ok()?;
    Some(format!("data:image/png;base64,{}", STANDARD.encode(file)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_of_another_size_is_none() {
        assert_eq!(frame(&[]), None);
        assert!(frame(&[0; 64_000]).is_some_and(|uri| uri.starts_with("data:image/png;base64,iVBOR")));
    }
}
