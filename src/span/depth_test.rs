//! The depth test of a span, before anything is computed for its pixels.
//!
//! Each block of eight pixels gets a mask: a byte for each pixel, the first lowest, 0 if it is nearer than its cell,
//! otherwise 255. The loops that show texels or copy bytes write under these masks, so a hidden
//! block costs no more than its test.

use crate::lanes::LANES;
use crate::simd::{Lanes8, Portable, copy_block};

/// The masks of a span of up to 64 pixels.
pub(crate) type Masks = [u64; 64 / LANES];

/// Half of eight pixels.
const FOUR: usize = LANES / 2;

/// Tests a span of this length, and stores a mask for each block. Depths have the integer part in the upper half. If
/// `keeps`, nearer depths are stored in the cells. Returns the number of nearer pixels.
#[inline(always)]
pub(crate) fn test_span<S: Lanes8>(
    s: S,
    (cells, length): (&mut [u32], usize),
    [z, dz]: [i64; 2],
    keeps: bool,
    masks: &mut [u64],
) -> u32 {
    // Most spans.
    if length <= FOUR
        && let (Some(four), Some(mask)) = (cells.first_chunk_mut(), masks.first_mut())
    {
        let stays = s.test_four(four, [z, dz], length, keeps);
        *mask = u64::from(u32::MAX) << 32 | u64::from(stays);
        return stays.count_zeros() / 8;
    }
    test_blocks(s, (cells, length), [z, dz], keeps, masks)
}

/// Tests like [`test_span`], eight pixels at a time, out of line: compiled once for each level, not in each loop
/// over texels.
#[inline(always)]
pub(crate) fn test_blocks<S: Lanes8>(
    s: S,
    (cells, length): (&mut [u32], usize),
    depths: [i64; 2],
    keeps: bool,
    masks: &mut [u64],
) -> u32 {
    s.apart(
        #[inline(always)]
        move || test_blocks_by(s, (cells, length), depths, keeps, masks),
    )
}

#[inline(always)]
fn test_blocks_by<S: Lanes8>(
    s: S,
    (cells, length): (&mut [u32], usize),
    [z, dz]: [i64; 2],
    keeps: bool,
    masks: &mut [u64],
) -> u32 {
    let (mut cells, mut z, mut left, mut nearer) = (cells, z, length, 0);
    for mask in masks {
        let stays = if cells.len() < LANES {
            test_last(core::mem::take(&mut cells), [z, dz], left, keeps)
        } else {
            let Some((eight, rest)) = cells.split_first_chunk_mut() else { break };
            cells = rest;
            s.test_eight(eight, [z, dz], left, keeps)
        };
        z = z.wrapping_add(dz.wrapping_mul(LANES as i64));
        left = left.saturating_sub(LANES);
        nearer += stays.count_zeros() / 8;
        *mask = stays;
    }
    nearer
}

/// The test of the last pixels of the buffer, fewer than eight.
#[cold]
#[inline(never)]
fn test_last(cells: &mut [u32], depths: [i64; 2], left: usize, keeps: bool) -> u64 {
    let mut eight = [0; LANES];
    let count = cells.len().min(LANES);
    eight[..count].copy_from_slice(&cells[..count]);
    let stays = Portable.test_eight(&mut eight, depths, left.min(count), keeps);
    cells[..count].copy_from_slice(&eight[..count]);
    stays
}

/// Copies bytes to a row under the masks of their blocks. Masked pixels and those after the last
/// block do not change.
#[inline(always)]
fn copy_masked(row: &mut [u8], bytes: &[u8], masks: &[u64]) {
    let (mut row, mut bytes) = (row, bytes);
    for &stays in masks {
        if row.len().min(bytes.len()) < LANES {
            // At the end of the row or of the bytes.
            for ((pixel, byte), stay) in row.iter_mut().zip(bytes).zip(stays.to_le_bytes()) {
                *pixel = if stay == 0 { *byte } else { *pixel };
            }
            break;
        }
        let Some((eight, rest)) = row.split_first_chunk_mut::<LANES>() else { break };
        let Some((new, behind)) = bytes.split_first_chunk::<LANES>() else { break };
        copy_block(eight, *new, stays);
        (row, bytes) = (rest, behind);
    }
}

/// Copies the bytes of a span of up to 64 pixels where they are nearer, with depths as in [`test_span`]. The row and
/// the cells have that many pixels, or none at all. Returns the number of nearer pixels.
#[inline(always)]
pub(crate) fn copy_span<S: Lanes8>(
    s: S,
    (row, cells): (&mut [u8], &mut [u32]),
    (bytes, length): (&[u8], usize),
    keeps: bool,
    depths: [i64; 2],
) -> u32 {
    let mut masks = Masks::default();
    let Some(masks) = masks.get_mut(..length.div_ceil(LANES)) else { return 0 };
    let nearer = test_span(s, (cells, length), depths, keeps, masks);
    if nearer > 0 {
        copy_masked(row, bytes, masks);
    }
    nearer
}
