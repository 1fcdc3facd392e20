//! The first image of a GIF.

use std::io::Read;

use ::gif::{ColorOutput, DecodeOptions, MemoryLimit};

use super::indexed::{Indexed, colors};
use super::{LoadErrorKind, MAX_BYTES, check_size};
use crate::errors::clause;

pub(super) fn recognizes(head: &[u8]) -> bool {
    head.starts_with(b"GIF87a") || head.starts_with(b"GIF89a")
}

pub(super) fn decode(file: impl Read) -> Result<Indexed, LoadErrorKind> {
    let broken = |error: ::gif::DecodingError| LoadErrorKind::Picture(clause(&format!("GIF: {error}")));
    let mut options = DecodeOptions::new();
    options.set_color_output(ColorOutput::Indexed);
    options.set_memory_limit(MemoryLimit::Bytes(
        core::num::NonZeroU64::new(MAX_BYTES as u64).unwrap_or(core::num::NonZeroU64::MIN),
    ));
    let mut decoder = options.read_info(file).map_err(broken)?;
    let (width, height) = (u32::from(decoder.width()), u32::from(decoder.height()));
    check_size(width, height)?;
    let of_file = decoder.global_palette().map(colors);
    let frame = decoder.read_next_frame().map_err(broken)?;
    let Some(frame) = frame else { return Err(LoadErrorKind::Picture("GIF: there is no image".into())) };
    let own = frame.palette.as_deref().map(colors).or(of_file);
    let colors = own.ok_or_else(|| LoadErrorKind::Picture("GIF: there are no colours".into()))?;
    let (left, top, columns) = (u32::from(frame.left), u32::from(frame.top), usize::from(frame.width));
    // At most 2²⁴. Anything that the image does not cover is transparent.
    let mut indices = vec![frame.transparent.unwrap_or(0); (width * height) as usize];
    for (row, y) in frame.buffer.chunks_exact(columns.max(1)).zip(top..height) {
        for (&index, x) in row.iter().zip(left..width) {
            indices[(y * width + x) as usize] = index;
        }
    }
    let covers = left == 0 && top == 0 && u32::from(frame.width) >= width && u32::from(frame.height) >= height;
    let was_transparent = !covers || frame.transparent.is_some_and(|transparent| indices.contains(&transparent));
    Ok(Indexed { width, height, indices, colors, was_transparent })
}
