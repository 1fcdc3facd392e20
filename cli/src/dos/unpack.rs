//! Unpacks films: their length, a word, then a deflate stream. The program for DOS includes this file.

use alloc::vec::Vec;

use miniz_oxide::inflate::TINFLStatus;
use miniz_oxide::inflate::core::inflate_flags::TINFL_FLAG_USING_NON_WRAPPING_OUTPUT_BUF;
use miniz_oxide::inflate::core::{DecompressorOxide, decompress};

/// Unpacks bytes; `None` if they are cut short or longer than packed, or if there is no room.
pub(crate) fn unpack(bytes: &[u8]) -> Option<Vec<u8>> {
    let (count, rest) = bytes.split_first_chunk()?;
    let count = usize::try_from(u32::from_le_bytes(*count)).ok()?;
    let mut out = Vec::new();
    out.try_reserve_exact(count).ok()?;
    out.resize(count, 0);
    let mut state = DecompressorOxide::default();
    let flags = TINFL_FLAG_USING_NON_WRAPPING_OUTPUT_BUF;
    let (status, read, written) = decompress(&mut state, rest, &mut out, 0, flags);
    (status == TINFLStatus::Done && read == rest.len() && written == count).then_some(out)
}
