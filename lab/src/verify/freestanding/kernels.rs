//! Group S: every span kernel of this machine against the definition, and the twins of other loops.

use super::Tally;
use super::random::Random;
use super::twins::{GUARD, GUARD_BYTE, twins};
use alloc::vec::Vec;
use alloc::{format, vec};
use mode13h::span::Kernel;

/// Tries every kernel of this machine, and the loops that have twins: what the group `spans` checks.
pub(in super::super) fn kernels(seed: u64) -> Tally {
    let mut all = Tally::default();
    for kernel in Kernel::available() {
        let mut spans = Spans::new(kernel, 131_073);
        let mut random = Random::new(seed, "spans");
        let mut any = || {
            let z = random.next();
            (z as u16, (z >> 16) as u16) // two of its four words
        };
        for _ in 0..1_000 {
            let (shade, step) = any();
            spans.try_one("s1", 0, shade, step);
            spans.try_one("s2", 1, shade, step);
        }
        for shade in (0..=0xFF00).step_by(0xFF) {
            spans.try_one("s3", 2, shade, 0xFF00_u16.wrapping_sub(shade));
            spans.try_one("s3", 2, 0xFF00, shade.wrapping_sub(0xFF00));
        }
        const EDGES: [u16; 10] = [0, 1, 0xFF, 0x100, 0x7FFF, 0x8000, 0x8001, 0xFF00, 0xFF01, 0xFFFF];
        for shade in EDGES {
            for step in EDGES {
                spans.try_one("s4", 191, shade, step);
            }
        }
        for _ in 0..20_000 {
            let (shade, step) = any();
            spans.try_one("s4", 191, shade, step);
        }
        for length in (0..=320).chain([65_535, 65_536, 65_537, 131_073]) {
            for _ in 0..4 {
                let (shade, step) = any();
                spans.try_one("s5", length, shade, step);
            }
        }
        for shade in [0x0000, 0x0080, 0x7F80, 0xFEC1, 0xFF80] {
            for step in [1, u16::MAX] {
                spans.try_one("s6", 320, shade, step);
            }
        }
        all.append(spans.tally);
    }
    twins(&mut all, seed);
    all
}

/// The cases of one kernel.
struct Spans {
    kernel: Kernel,
    /// All guard bytes between cases.
    canvas: Vec<u8>,
    tally: Tally,
}

impl Spans {
    /// Room for spans of `longest` pixels.
    fn new(kernel: Kernel, longest: usize) -> Self {
        Self { kernel, canvas: vec![GUARD_BYTE; longest + 64 + 2 * GUARD], tally: Tally::default() }
    }

    fn try_one(&mut self, id: &str, length: usize, shade: u16, step: u16) {
        // 13 has no factor in common with 64, so every alignment has its turn.
        let alignment = (self.tally.cases * 13 % 64) as usize; // below 64
        let start = GUARD + alignment;
        self.kernel.fill(&mut self.canvas[start..start + length], shade, step);
        let mut sum = u32::from(shade);
        let row = &self.canvas[start..start + length];
        let wrong_pixel = row.iter().position(|&pixel| {
            let right = u32::from(pixel) == sum / 256;
            sum = (sum + u32::from(step)) % 65_536;
            !right
        });
        let beside =
            self.canvas[start - GUARD..start].iter().chain(&self.canvas[start + length..start + length + GUARD]);
        let wrong = match wrong_pixel {
            Some(k) => Some(format!("pixel {k} is {:#04x}", row[k])),
            None if beside.into_iter().any(|&byte| byte != GUARD_BYTE) => {
                Some("a byte beside the row was written".into())
            }
            None => None,
        };
        self.tally.check(wrong.is_none(), || {
            let span = format!("shade {shade:#06x} step {step:#06x} length {length} alignment {alignment}");
            format!("{id} {}: {span}: {}", self.kernel, wrong.unwrap_or_default())
        });
        self.canvas[start - GUARD..start + length + GUARD].fill(GUARD_BYTE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kernel_is_right() {
        let group = kernels(1);
        assert!(group.cases > 20_000 * Kernel::available().count() as u64);
        assert_eq!(group.failures, [""; 0]);
    }

    /// A byte that is wrong is found, and said in a line that a person can read.
    #[test]
    fn a_fault_is_told() {
        let mut spans = Spans::new(Kernel::PORTABLE, 8);
        spans.canvas[GUARD + 8] = 0;
        spans.try_one("s4", 8, 0x1000, 0x0100);
        assert_eq!(
            spans.tally.failures,
            ["s4 portable: shade 0x1000 step 0x0100 length 8 alignment 0: a byte beside the row was written"]
        );
    }
}
