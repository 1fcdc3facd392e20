//! PCX with 8 bits per pixel and the palette at its end, as paint programs of the time wrote it.

use super::indexed::{Indexed, colors};
use super::{LoadErrorKind, check_size};

/// The number of bytes of the header.
const HEADER: usize = 128;

/// The number of bytes of the palette at the end, without the marker byte before it.
const PALETTE: usize = 768;

/// Returns whether these may be the first bytes of a PCX: its number, version, run-length encoding, and bits per pixel.
pub(super) fn recognizes(head: &[u8]) -> bool {
    matches!(head, [10, 0 | 2..=5, 0 | 1, 1 | 2 | 4 | 8, ..]) && head.get(64) == Some(&0)
}

pub(super) fn decode(bytes: &[u8]) -> Result<Indexed, LoadErrorKind> {
    let broken = |what: &str| LoadErrorKind::Picture(format!("PCX: {what}"));
    let header: &[u8; HEADER] = bytes.first_chunk().ok_or_else(|| broken("the header is cut short"))?;
    let word = |at: usize| u32::from(u16::from_le_bytes([header[at], header[at + 1]]));
    if (header[3], header[65]) != (8, 1) {
        return Err(broken(&format!(
            "{} bits in {} planes; only 8 bits in one plane are supported",
            header[3], header[65]
        )));
    }
    let side =
        |first: usize, last: usize| (word(last) + 1).checked_sub(word(first)).ok_or_else(|| broken("a negative size"));
    let (width, height, pitch) = (side(4, 8)?, side(6, 10)?, word(66));
    check_size(width, height)?;
    if width == 0 || height == 0 || pitch < width {
        return Err(broken("rows are shorter than the picture is wide"));
    }
    let marked = bytes.len().checked_sub(PALETTE + 1).filter(|&at| at >= HEADER && bytes[at] == 12);
    let end = marked.ok_or_else(|| broken("there is no palette at the end"))?;
    // At most 65,535 × 4,096, and no more than 63 times the file.
    let needed = (pitch * height) as usize;
    let mut data = bytes[HEADER..end].iter();
    let mut rows: Vec<u8> = Vec::new();
    while rows.len() < needed {
        let &byte = data.next().ok_or_else(|| broken("the pixels are cut short"))?;
        if header[2] == 1 && byte >= 0xC0 {
            let &value = data.next().ok_or_else(|| broken("the pixels are cut short"))?;
            rows.resize(rows.len() + usize::from(byte & 0x3F), value);
        } else {
            rows.push(byte);
        }
    }
    // A run may extend beyond the last row.
    let rows = rows.chunks(pitch as usize).take(height as usize);
    let indices = rows.flat_map(|row| &row[..width as usize]).copied().collect();
    Ok(Indexed { width, height, indices, colors: colors(&bytes[end + 1..]), was_transparent: false })
}
