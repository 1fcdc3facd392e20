//! Aseprite's own files of indexed sprites: the visible layers of the first frame.
//!
//! The crate `asefile` reads the whole format, but pulls in a second version of `image`.

use std::io::Read;

use flate2::read::ZlibDecoder;
use mode13h::palette::Rgb;

use super::indexed::Indexed;
use super::{LoadErrorKind, check_size};

/// Returns whether these are the first bytes of a sprite. The length of a WebP or of a part of a JPEG may lie where its
/// magic number does.
pub(super) fn recognizes(head: &[u8]) -> bool {
    matches!(head, [_, _, _, _, 0xE0, 0xA5, ..]) && !head.starts_with(b"RIFF") && !head.starts_with(&[0xFF, 0xD8, 0xFF])
}

/// Bytes to be read from the front.
#[derive(Clone, Copy)]
struct Bytes<'b>(&'b [u8]);

impl<'b> Bytes<'b> {
    fn take(&mut self, count: usize) -> Result<&'b [u8], LoadErrorKind> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or_else(|| broken("the file is cut short"))?;
        self.0 = rest;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], LoadErrorKind> {
        Ok(self.take(N)?.first_chunk().copied().unwrap_or([0; N]))
    }

    fn byte(&mut self) -> Result<u8, LoadErrorKind> {
        self.array::<1>().map(|[byte]| byte)
    }

    fn word(&mut self) -> Result<u16, LoadErrorKind> {
        self.array().map(u16::from_le_bytes)
    }

    fn double(&mut self) -> Result<usize, LoadErrorKind> {
        // 32 bits wide.
        self.array().map(|bytes| u32::from_le_bytes(bytes) as usize)
    }
}

fn broken(what: &str) -> LoadErrorKind {
    LoadErrorKind::Picture(format!("Aseprite: {what}"))
}

/// The parts of a layer that determine whether its cels are visible.
struct Layer {
    is_visible: bool,
    /// True if it is the background layer, which is below all others and has no transparent index.
    is_background: bool,
    level: u16,
}

/// The types of chunks that are read.
const OLD_PALETTE: u16 = 0x0004;
const OLDEST_PALETTE: u16 = 0x0011;
const LAYER: u16 = 0x2004;
const CEL: u16 = 0x2005;
const PALETTE: u16 = 0x2019;

pub(super) fn decode(bytes: &[u8]) -> Result<Indexed, LoadErrorKind> {
    let mut file = Bytes(bytes);
    let mut header = Bytes(file.take(128)?);
    header.take(8)?;
    let (width, height, bits) = (u32::from(header.word()?), u32::from(header.word()?), header.word()?);
    if bits != 8 {
        return Err(broken("not an indexed sprite"));
    }
    check_size(width, height)?;
    header.take(14)?;
    let transparent = header.byte()?;
    let mut frame = Bytes(file.take(16)?);
    frame.take(4)?;
    if frame.word()? != 0xF1FA {
        return Err(broken("no frame"));
    }
    let old_count = frame.word()?;
    frame.take(4)?;
    let chunks = match frame.double()? {
        0 => usize::from(old_count),
        count => count,
    };
    let mut picture = Indexed {
        width,
        height,
        // At most 2²⁴.
        indices: vec![transparent; (width * height) as usize],
        colors: [Rgb::BLACK; 256],
        was_transparent: false,
    };
    let mut layers: Vec<Layer> = Vec::new();
    // Each with its place from the lowest to the top one.
    let mut cels: Vec<(i32, i32, Bytes<'_>)> = Vec::new();
    let mut has_palette = false;
    for _ in 0..chunks {
        let size = file.double()?;
        let kind = file.word()?;
        let mut chunk = Bytes(file.take(size.checked_sub(6).ok_or_else(|| broken("an empty chunk"))?)?);
        match kind {
            LAYER => {
                let flags = chunk.word()?;
                chunk.word()?;
                // A reference layer, 64, is shown by the editor alone.
                layers.push(Layer {
                    is_visible: flags & (1 | 64) == 1,
                    is_background: flags & 8 != 0,
                    level: chunk.word()?,
                });
            }
            CEL => {
                let mut head = chunk;
                let layer = i32::from(head.word()?);
                // Position, opacity and type.
                head.take(7)?;
                let z = i32::from(head.word()? as i16);
                cels.push((layer + z, z, chunk));
            }
            PALETTE => {
                has_palette = true;
                palette(chunk, &mut picture.colors)?;
            }
            // Some programs write both; the new one wins.
            OLD_PALETTE | OLDEST_PALETTE if !has_palette => {
                old_palette(chunk, kind == OLDEST_PALETTE, &mut picture.colors)?;
            }
            _ => {}
        }
    }
    cels.sort_by_key(|&(place, z, _)| (place, z));
    for (.., chunk) in cels {
        cel(chunk, &layers, transparent, &mut picture)?;
    }
    let has_background = layers.iter().any(|layer| layer.is_background && layer.is_visible);
    picture.was_transparent = !has_background && picture.indices.contains(&transparent);
    Ok(picture)
}

fn palette(mut chunk: Bytes<'_>, colors: &mut [Rgb; 256]) -> Result<(), LoadErrorKind> {
    chunk.double()?;
    let (first, last) = (chunk.double()?, chunk.double()?);
    chunk.take(8)?;
    for color in colors.get_mut(first..=last.min(255)).unwrap_or_default() {
        let has_name = chunk.word()? & 1 != 0;
        let [r, g, b, _] = chunk.array()?;
        *color = Rgb::new(r, g, b);
        if has_name {
            let length = chunk.word()?;
            chunk.take(length.into())?;
        }
    }
    Ok(())
}

fn old_palette(mut chunk: Bytes<'_>, is_of_dac: bool, colors: &mut [Rgb; 256]) -> Result<(), LoadErrorKind> {
    let mut entry = 0_usize;
    for _ in 0..chunk.word()? {
        entry += usize::from(chunk.byte()?);
        let count = match chunk.byte()? {
            0 => 256,
            count => usize::from(count),
        };
        for _ in 0..count {
            let [r, g, b] = chunk.array()?;
            if let Some(color) = colors.get_mut(entry) {
                *color = if is_of_dac { Rgb::from_dac([r, g, b].map(|c| c & 63)) } else { Rgb::new(r, g, b) };
            }
            entry += 1;
        }
    }
    Ok(())
}

/// Draws a cel if its layer and the groups that contain it are visible.
fn cel(mut chunk: Bytes<'_>, layers: &[Layer], transparent: u8, picture: &mut Indexed) -> Result<(), LoadErrorKind> {
    let number = usize::from(chunk.word()?);
    let layer = layers.get(number).ok_or_else(|| broken("a cel of a layer that does not exist"))?;
    let (left, top) = (chunk.word()? as i16, chunk.word()? as i16);
    chunk.byte()?;
    let kind = chunk.word()?;
    chunk.take(7)?;
    let mut level = layer.level;
    let mut is_visible = layer.is_visible;
    for group in layers[..number].iter().rev() {
        if group.level < level {
            (level, is_visible) = (group.level, is_visible && group.is_visible);
        }
    }
    // The first frame has no linked cels; tilemaps are ignored.
    if !is_visible || !matches!(kind, 0 | 2) {
        return Ok(());
    }
    let (width, height) = (chunk.word()?, chunk.word()?);
    let count = usize::from(width) * usize::from(height);
    check_size(width.into(), height.into())?;
    let mut unpacked = Vec::new();
    let pixels = if kind == 0 {
        chunk.take(count)?
    } else {
        let read = ZlibDecoder::new(chunk.0).take(count as u64).read_to_end(&mut unpacked);
        read.map_err(|_| broken("a cel that cannot be unpacked"))?;
        unpacked.get(..count).ok_or_else(|| broken("a cel is cut short"))?
    };
    for (at, &index) in pixels.iter().enumerate() {
        if index == transparent && !layer.is_background {
            continue;
        }
        let x = i64::from(left) + (at % usize::from(width)) as i64;
        let y = i64::from(top) + (at / usize::from(width)) as i64;
        if (0..i64::from(picture.width)).contains(&x) && (0..i64::from(picture.height)).contains(&y) {
            // Inside the picture.
            picture.indices[(y * i64::from(picture.width) + x) as usize] = index;
        }
    }
    Ok(())
}
