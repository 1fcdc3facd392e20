//! True-colour PNG, for programs that know no palettes.

use std::path::Path;

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

use super::chunk::chunk;
use super::scale::Scaled;
use super::{ExportError, ExportErrorKind, Picture, PictureError, Scale, write_atomically};
use crate::vga::Vga;

/// Writes what `vga` shows as a true-colour PNG of 1600 × 1200 square pixels, every pixel of the frame 5 wide and
/// 6 high: it looks right everywhere.
///
/// # Errors
///
/// [`ExportError`] if the file cannot be written; what stood there before is then whole.
pub fn rgb_png(vga: &Vga, path: impl AsRef<Path>) -> Result<(), ExportError> {
    let palette = vga.palette();
    picture_rgb_png(&Picture::mode_13h(vga.pixels(), &palette), Scale::FiveBySix, path)
}

/// Writes any picture as a true-colour PNG, enlarged by `scale`, with the shape of its pixels in `pHYs`.
///
/// # Errors
///
/// [`ExportError`] if the picture's sizes do not fit its bytes, or if the file cannot be written.
pub fn picture_rgb_png(picture: &Picture<'_>, scale: Scale, path: impl AsRef<Path>) -> Result<(), ExportError> {
    let path = path.as_ref();
    let file =
        encode_rgb_png(picture, scale).map_err(|error| ExportError::new(path, ExportErrorKind::Picture(error)))?;
    write_atomically(path, |out| out.write_all(&file))
}

/// The bytes of the file that [`picture_rgb_png`] writes.
///
/// # Errors
///
/// [`PictureError`] if the picture's sizes do not fit its bytes, or if it does not fit in memory.
pub fn encode_rgb_png(picture: &Picture<'_>, scale: Scale) -> Result<Vec<u8>, PictureError> {
    let scaled = Scaled::new(picture, scale)?;
    let bytes = scaled.width as usize * scaled.height as usize * 3;
    let mut colors = Vec::new();
    colors.try_reserve_exact(bytes).map_err(|_| PictureError::Memory { bytes })?;
    for row in scaled.rows() {
        colors.extend(row.iter().flat_map(|&index| {
            let color = picture.palette[usize::from(index)];
            [color.r, color.g, color.b]
        }));
    }
    let mut file = Vec::new();
    PngEncoder::new(&mut file)
        .write_image(&colors, scaled.width, scaled.height, ExtendedColorType::Rgb8)
        // The sizes agree and a vector takes whatever is written to it; memory alone can run out.
        .map_err(|_| PictureError::Memory { bytes })?;
    insert_density(&mut file, scaled.density());
    Ok(file)
}

/// Puts a `pHYs` chunk behind the header of a PNG file, where it must stand before the data (PNG specification,
/// 5.6 and 11.3.4.3). `image` has no call for it.
fn insert_density(file: &mut Vec<u8>, (across, down): (u32, u32)) {
    // Signature 8 bytes, then IHDR: length 4, name 4, data 13, check 4.
    const BEHIND_HEADER: usize = 8 + 4 + 4 + 13 + 4;
    // Unit unspecified: the two numbers are a ratio.
    let chunk = chunk(*b"pHYs", &[&across.to_be_bytes(), &down.to_be_bytes(), &[0]]);
    file.splice(BEHIND_HEADER..BEHIND_HEADER, chunk);
}
