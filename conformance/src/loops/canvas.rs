//! Rows in memory: their lengths, their alignments, and the bytes next to them, which must not change.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use mode13h::internals::span::dither::{DitherPattern, PERIOD, ThresholdRow};

use super::{Cases, Checked};
use crate::Random;

/// Bytes before and after the row that must not change.
const GUARD: usize = 64;

/// One more than the longest row of [`Cases::shapes`].
const LONGEST: usize = 4_096;

/// A row's length, and its alignment: it starts `alignment` bytes after a multiple of 64.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// Number of pixels.
    pub length: usize,
    /// Alignment, 0 to 63.
    pub alignment: usize,
}

impl Cases {
    /// Every length up to 320, at every alignment or, in the quick form, at six of them; and longer ones.
    pub(super) fn shapes(self) -> impl Iterator<Item = Shape> {
        let mut random = self.random("shapes");
        let alignments = self.of(6, 64);
        // 11 and 64 have no common factor, so all alignments occur in the quick form, too.
        let screen = (0..=320_usize)
            .flat_map(move |length| (0..alignments).map(move |i| Shape { length, alignment: (length + i * 11) % 64 }));
        let longer = (0..self.of(200, 2_000)).map(move |i| Shape { length: random.log_uniform(12), alignment: i % 64 });
        screen.chain(longer)
    }
}

/// Memory to draw in, reused from case to case.
#[derive(Debug)]
pub struct Canvas {
    bytes: Vec<u8>,
}

/// A byte next to the row, not a constant, so that moved or copied bytes show up too.
fn guard_byte(i: usize) -> u8 {
    // The low byte.
    0xA5 ^ (i as u8)
}

impl Canvas {
    /// Memory for rows of up to `longest` pixels.
    #[must_use]
    pub fn new(longest: usize) -> Self {
        Self { bytes: (0..longest + 64 + 63 + 2 * GUARD).map(guard_byte).collect() }
    }

    /// Runs `draw` on a row that holds `before`, and checks that the row then holds `after` and that no other byte has
    /// changed.
    ///
    /// # Errors
    /// A line naming the first byte that differs.
    pub fn check(
        &mut self,
        alignment: usize,
        before: &[u8],
        after: &[u8],
        draw: impl FnOnce(&mut [u8]),
    ) -> Result<(), String> {
        let address = self.bytes.as_ptr().addr();
        let start = address.next_multiple_of(64) - address + GUARD + alignment;
        let end = start + before.len();
        self.bytes[start..end].copy_from_slice(before);
        draw(&mut self.bytes[start..end]);
        let row = &self.bytes[start..end];
        let wrong = row.iter().zip(after).position(|(is, should)| is != should);
        let wrong = wrong.map(|k| format!("pixel {k} is {:#04x}, not {:#04x}", row[k], after[k]));
        let mut guards = (start - GUARD..start).chain(end..end + GUARD);
        let lost = guards.find(|&i| self.bytes[i] != guard_byte(i));
        let lost = lost.map(|i| format!("the byte at {} was written", i as isize - start as isize));
        for (i, byte) in self.bytes[start - GUARD..end + GUARD].iter_mut().enumerate() {
            *byte = guard_byte(start - GUARD + i);
        }
        wrong.or(lost).map_or(Ok(()), Err)
    }
}

/// Runs the cases of one loop: `one` draws a case of each shape and reports what was wrong.
pub(super) fn on_every_shape(
    cases: Cases,
    stream: &str,
    mut one: impl FnMut(&mut Random, &mut Canvas, Shape) -> Result<(), String>,
) -> Checked {
    let (mut random, mut canvas, mut count) = (cases.random(stream), Canvas::new(LONGEST), 0);
    for shape in cases.shapes() {
        one(&mut random, &mut canvas, shape).map_err(|wrong| format!("{stream}: {shape:?}: {wrong}"))?;
        count += 1;
    }
    Ok(count)
}

/// Random bytes.
pub(super) fn bytes(random: &mut Random, count: usize) -> Vec<u8> {
    (0..count).map(|_| random.next_u64() as u8).collect()
}

/// A row to go with another one: of the same length, or in two of eight cases slightly shorter or longer.
pub(super) fn other_row(random: &mut Random, length: usize) -> Vec<u8> {
    let length = match random.below(8) {
        0 => length.saturating_sub(1 + random.below(20)),
        1 => length + 1 + random.below(20),
        _ => length,
    };
    bytes(random, length)
}

/// Numbers around which a sign changes or a carry occurs, and the largest ones.
pub(super) const EDGES: [u16; 16] =
    [0, 1, 2, 0x7F, 0x80, 0xFF, 0x100, 0x101, 0x7FFF, 0x8000, 0x8001, 0xFEFF, 0xFF00, 0xFF01, 0xFFFE, 0xFFFF];

pub(super) fn any_u16(random: &mut Random) -> u16 {
    if random.below(4) == 0 { random.one_of(&EDGES) } else { random.next_u64() as u16 }
}

/// Thresholds of a row: from a pattern, all equal, or random.
pub(super) fn any_thresholds(random: &mut Random) -> ThresholdRow {
    match random.below(6) {
        0 => ThresholdRow::new(&[random.one_of(&[0, 128, 255])]),
        1 => ThresholdRow::new(&random.next_u64().to_le_bytes()),
        2 | 3 => ThresholdRow::new(&core::array::from_fn::<u8, PERIOD, _>(|_| random.next_u64() as u8)),
        _ => *random.one_of(&DitherPattern::ALL).thresholds().row(random.below(PERIOD)),
    }
}

/// A column of a frame, or one close to the largest number.
pub(super) fn any_column(random: &mut Random) -> usize {
    if random.below(8) == 0 { usize::MAX - random.below(21) } else { random.below(4_096) }
}

/// The threshold of pixel `k` in a row whose first pixel is in column `x`.
pub(super) fn threshold(thresholds: &ThresholdRow, x: usize, k: usize) -> u8 {
    // Below 64.
    thresholds.at(((x as u128 + k as u128) % PERIOD as u128) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wrong byte next to the row, and one inside it, are found and named.
    #[test]
    fn a_lost_byte_is_told() {
        let mut canvas = Canvas::new(20);
        assert_eq!(canvas.check(3, &[0; 8], &[1; 8], |row| row.fill(1)), Ok(()));
        let wrong = canvas.check(3, &[0; 8], &[1; 8], |row| row[..7].fill(1));
        assert_eq!(wrong, Err("pixel 7 is 0x00, not 0x01".into()));
        let start = canvas.bytes.as_ptr().addr().next_multiple_of(64) - canvas.bytes.as_ptr().addr() + GUARD;
        for (at, place) in [(-1, start + 2), (8, start + 11)] {
            canvas.bytes[place] ^= 1;
            assert_eq!(
                canvas.check(3, &[0; 8], &[1; 8], |row| row.fill(1)),
                Err(format!("the byte at {at} was written"))
            );
        }
        assert_eq!(canvas.check(3, &[0; 8], &[1; 8], |row| row.fill(1)), Ok(()));
    }

    /// Every alignment occurs, and every length of a screen row.
    #[test]
    fn all_lengths_and_alignments_come() {
        for (cases, count) in [(Cases::quick(1), 2_126), (Cases::full(1), 22_544)] {
            let shapes: Vec<Shape> = cases.shapes().collect();
            assert_eq!(shapes.len(), count);
            assert!((0..=320).all(|length| shapes.iter().any(|shape| shape.length == length)));
            assert!((0..64).all(|alignment| shapes.iter().any(|shape| shape.alignment == alignment)));
            assert!(shapes.iter().all(|shape| shape.length < LONGEST));
        }
    }
}
