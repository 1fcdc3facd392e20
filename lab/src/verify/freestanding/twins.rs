//! Group S, the loops beside the span: every faster twin against its portable specification.

use super::Tally;
use super::random::Random;
use alloc::string::String;
use alloc::vec::Vec;
use alloc::{format, vec};
use mode13h::span::channels::{mix_cube, mix_cube_portable};
use mode13h::span::dither::{BAYER, fill_dithered, fill_dithered_portable};
use mode13h::span::texture::{Texels, fill_perspective, fill_perspective_portable};

/// Bytes before and behind a row that have to stay as they were.
pub(super) const GUARD: usize = 64;
pub(super) const GUARD_BYTE: u8 = 0xA5;

/// The longest row.
const LONGEST: usize = 320;
/// Rows of each length.
const ROWS: usize = 8;

type FillDithered = fn(&mut [u8], u16, u16, &[u8; 8], usize);
type FillPerspective = fn(&mut [u8], Texels<'_>, [i128; 2], [i128; 2], i128, i128);
type MixCube = fn(&mut [u8], &[u8], &[u8], &[u8], &[u8; 8], usize);

/// The loops that have twins, in the form that this machine draws with.
struct Twins {
    fill_dithered: FillDithered,
    fill_perspective: FillPerspective,
    mix_cube: MixCube,
}

/// Adds their cases: every length to 320, at changing alignments.
pub(super) fn twins(all: &mut Tally, seed: u64) {
    Twins { fill_dithered, fill_perspective, mix_cube }.check(all, seed);
}

impl Twins {
    fn check(&self, all: &mut Tally, seed: u64) {
        for one in [Self::dithered, Self::perspective, Self::mixed] {
            // A tally for each: one fault does not hide another.
            let mut own = Tally::default();
            let mut random = Random::new(seed, "twins");
            let mut canvas = vec![GUARD_BYTE; LONGEST + 64 + 2 * GUARD];
            for case in 0..(LONGEST + 1) * ROWS {
                // 13 has no factor in common with 64, so every alignment has its turn.
                let row = GUARD + case * 13 % 64..GUARD + case * 13 % 64 + case / ROWS;
                let mut right = vec![0; row.len()];
                let text = one(self, &mut random, &mut right, &mut canvas[row.clone()]);
                let wrong = wrong(&canvas, row.start, &right);
                own.check(wrong.is_none(), || format!("{text} length {}: {}", row.len(), wrong.unwrap_or_default()));
                canvas.fill(GUARD_BYTE);
            }
            all.append(own);
        }
    }

    // Each draws a row twice, by the specification and by the twin, and says which.

    fn dithered(&self, random: &mut Random, right: &mut [u8], row: &mut [u8]) -> String {
        let [shade, step] = [0, 16].map(|bits| (random.next() >> bits) as u16); // two of four words
        let (thresholds, x) = (random.one_of(&BAYER), random.below(4_096) as usize);
        fill_dithered_portable(right, shade, step, &thresholds, x);
        (self.fill_dithered)(row, shade, step, &thresholds, x);
        format!("dither: shade {shade:#06x} step {step:#06x} column {x}")
    }

    /// Quotients anywhere, and every other time on texels' bounds or one part of the divisor beside them.
    fn perspective(&self, random: &mut Random, right: &mut [u8], row: &mut [u8]) -> String {
        // No two neighbouring texels are the same.
        let texture: [u8; 256] = core::array::from_fn(|i| i as u8); // below 256
        let Ok(texels) = Texels::new(&texture, 4, 4) else { return String::new() };
        let gaps = right.len().max(2) as i128 - 1;
        let [d, last] = [(); 2].map(|()| i128::from(random.log_uniform(63)) << random.below(20));
        let dd = (last - d) / gaps;
        let on_bounds = random.below(2) == 0;
        // From ±2³⁰, changing by less than 2³⁰ · 2 over the row.
        let mut numerator = || {
            let mut quotient = || i128::from(random.within(-(1 << 30), 1 << 30));
            let (first, last) = (quotient(), quotient());
            if on_bounds {
                let bound = first >> 16 << 16;
                [bound * d + i128::from(random.within(-1, 1)), bound * dd]
            } else {
                [first * d, (last * (d + gaps * dd) - first * d) / gaps]
            }
        };
        let ([u, du], [v, dv]) = (numerator(), numerator());
        fill_perspective_portable(right, texels, [u, v], [du, dv], d, dd);
        (self.fill_perspective)(row, texels, [u, v], [du, dv], d, dd);
        format!("perspective: ({u} by {du}, {v} by {dv}) / ({d} by {dd})")
    }

    fn mixed(&self, random: &mut Random, right: &mut [u8], row: &mut [u8]) -> String {
        let mut channel = || -> Vec<u8> { (0..right.len()).map(|_| random.next() as u8).collect() }; // its low byte
        let (red, green, blue) = (channel(), channel(), channel());
        let (thresholds, x) = (random.one_of(&BAYER), random.below(4_096) as usize);
        mix_cube_portable(right, &red, &green, &blue, &thresholds, x);
        (self.mix_cube)(row, &red, &green, &blue, &thresholds, x);
        format!("cube: column {x} red {red:02x?} green {green:02x?} blue {blue:02x?}")
    }
}

/// Fault of a row in a canvas of guard bytes, if it has any.
fn wrong(canvas: &[u8], start: usize, right: &[u8]) -> Option<String> {
    let end = start + right.len();
    let row = &canvas[start..end];
    if let Some(k) = row.iter().zip(right).position(|(is, right)| is != right) {
        return Some(format!("pixel {k} is {:#04x}, not {:#04x}", row[k], right[k]));
    }
    let mut beside = canvas[..start].iter().chain(&canvas[end..]);
    beside.any(|&byte| byte != GUARD_BYTE).then(|| "a byte beside the row was written".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    const RIGHT: Twins = Twins { fill_dithered, fill_perspective, mix_cube };

    fn check(twins: &Twins) -> Tally {
        let mut all = Tally::default();
        twins.check(&mut all, 1);
        assert_eq!(all.cases, 3 * 321 * ROWS as u64);
        all
    }

    #[test]
    fn every_twin_is_right() {
        assert_eq!(check(&RIGHT).failures, [""; 0]);
    }

    /// A twin that is wrong is found, whichever it is.
    #[test]
    fn a_fault_is_told() {
        let fill_dithered: FillDithered =
            |row, shade, step, thresholds, x| fill_dithered_portable(row, shade, step, thresholds, x & !1);
        let fill_perspective: FillPerspective = |row, texels, [u, v], [du, dv], d, dd| {
            for (k, pixel) in (0..).zip(row) {
                let estimate = |n: i128, dn: i128| (n + k * dn) as f64 / (d + k * dd) as f64;
                *pixel = texels.at(estimate(u, du).floor() as i64 as u32, estimate(v, dv).floor() as i64 as u32);
            }
        };
        let mix_cube: MixCube = |row, red, green, blue, _, x| mix_cube_portable(row, red, green, blue, &[128; 8], x);
        let wrong = [
            (Twins { fill_dithered, ..RIGHT }, "dither: shade 0x"),
            (Twins { fill_perspective, ..RIGHT }, "perspective: ("),
            (Twins { mix_cube, ..RIGHT }, "cube: column "),
        ];
        for (twins, text) in wrong {
            let failures = check(&twins).failures;
            assert_eq!(failures.len(), super::super::FAILURES, "{text}");
            for failure in failures {
                assert!(failure.starts_with(text) && failure.contains(": pixel "), "{failure}");
            }
        }
        let mut canvas = vec![GUARD_BYTE; 200];
        assert_eq!(wrong_row(&mut canvas), None);
        canvas[GUARD + 8] = 0;
        assert_eq!(wrong_row(&mut canvas).as_deref(), Some("a byte beside the row was written"));
    }

    fn wrong_row(canvas: &mut [u8]) -> Option<String> {
        canvas[GUARD..GUARD + 8].fill(1);
        wrong(canvas, GUARD, &[1; 8])
    }
}
