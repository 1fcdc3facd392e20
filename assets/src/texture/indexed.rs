//! Indexed pictures: the indices are preserved if the picture's size is valid for a texture.

use mode13h::palette::Rgb;
use mode13h::texture::{Texture, TextureError};

use super::{Decoded, LoadErrorKind};

/// An indexed picture.
pub(super) struct Indexed {
    pub(super) width: u32,
    pub(super) height: u32,
    /// The indices, row by row from the top down.
    pub(super) indices: Vec<u8>,
    pub(super) colors: [Rgb; 256],
    pub(super) was_transparent: bool,
}

impl Indexed {
    /// Makes a texture from the indices unchanged, if both sides are powers of two up to 256, otherwise from the
    /// colours.
    pub(super) fn into_decoded(self) -> Result<Decoded, LoadErrorKind> {
        let Self { width, height, indices, colors, was_transparent } = self;
        let is_side = |side: u32| side.is_power_of_two() && side <= Texture::MAX_SIDE;
        let texture = if is_side(width) && is_side(height) {
            // Bottom row first.
            let texels = indices.rchunks_exact(width as usize).flatten().copied().collect();
            Texture::new(width, height, texels, colors)
        } else if width == 0 || height == 0 {
            Err(TextureError::Size { width, height })
        } else {
            let pixels: Vec<Rgb> = indices.iter().map(|&index| colors[usize::from(index)]).collect();
            Texture::from_rgb(width, height, &pixels)
        };
        Ok(Decoded { texture: texture.map_err(LoadErrorKind::Texture)?, was_transparent, palette: Some(colors) })
    }
}

/// Reads 256 colours of three bytes each; missing ones are black.
pub(super) fn colors(bytes: &[u8]) -> [Rgb; 256] {
    let mut colors = [Rgb::BLACK; 256];
    let entries = bytes.as_chunks::<3>().0;
    colors.iter_mut().zip(entries).for_each(|(color, &[r, g, b])| *color = Rgb::new(r, g, b));
    colors
}
