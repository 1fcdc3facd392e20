//! Chunks of PNG files.

use std::io::{self, Write};

use flate2::Crc;

/// A chunk: its length, name and contents, and their checksum.
pub(super) fn chunk(name: [u8; 4], parts: &[&[u8]]) -> Vec<u8> {
    let body: Vec<u8> = [&name[..]].iter().chain(parts).flat_map(|part| part.iter().copied()).collect();
    let mut chunk = Vec::with_capacity(body.len() + 8);
    // The name is not counted. The contents are far below 2³¹ bytes here: a picture has at most 2²⁸ pixels, and is
    // written in many chunks.
    chunk.extend((body.len() as u32 - 4).to_be_bytes());
    chunk.extend(&body);
    let mut check = Crc::new();
    check.update(&body);
    chunk.extend(check.sum().to_be_bytes());
    chunk
}

/// Writes a chunk. Returns the number of bytes.
pub(super) fn write_chunk(out: &mut impl Write, name: [u8; 4], parts: &[&[u8]]) -> io::Result<u64> {
    let chunk = chunk(name, parts);
    out.write_all(&chunk)?;
    Ok(chunk.len() as u64)
}

/// The chunks of a valid file, after the signature: name and contents.
pub(super) fn chunks(file: &[u8]) -> impl Iterator<Item = ([u8; 4], &[u8])> {
    let mut rest = file.get(8..).unwrap_or_default();
    std::iter::from_fn(move || {
        let (&length, behind) = rest.split_first_chunk::<4>()?;
        let (&name, behind) = behind.split_first_chunk::<4>()?;
        let (contents, behind) = behind.split_at_checked(u32::from_be_bytes(length) as usize)?;
        rest = behind.get(4..)?;
        Some((name, contents))
    })
}
