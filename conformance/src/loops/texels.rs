//! Rows of texels, and lookups in a table of two bytes.

use alloc::string::{String, ToString};
use alloc::vec::Vec;
use alloc::{format, vec};

use mode13h::internals::span::texture::Texels;

use super::canvas::{bytes, on_every_shape, other_row};
use super::{Cases, Checked};
use crate::Random;

/// A texture of random shape made from the same bytes, and its definition.
fn any_texture<'a>(random: &mut Random, bytes: &'a [u8]) -> Result<(Texels<'a>, Naive<'a>), String> {
    let (ubits, vbits) = (random.below(9) as u32, random.below(9) as u32);
    let bytes = &bytes[..1 << (ubits + vbits)];
    let texels = Texels::new(bytes, ubits, vbits).map_err(|error| error.to_string())?;
    Ok((texels, Naive { bytes, ubits, vbits }))
}

/// A texture's definition.
struct Naive<'a> {
    bytes: &'a [u8],
    ubits: u32,
    vbits: u32,
}

impl Naive<'_> {
    /// The texel at integer coordinates, any number of texels away.
    fn at(&self, u: i128, v: i128) -> u8 {
        let (width, height) = (2_i128.pow(self.ubits), 2_i128.pow(self.vbits));
        self.bytes[(v.rem_euclid(height) * width + u.rem_euclid(width)) as usize]
    }
}

/// Checks texels along a straight line.
///
/// # Errors
/// The first wrong row.
pub fn check_affine(cases: Cases, mut fill: impl FnMut(&mut [u8], Texels<'_>, u32, u32, u32, u32)) -> Checked {
    let texture = bytes(&mut cases.random("texture"), 65_536);
    on_every_shape(cases, "affine", |random, canvas, shape| {
        let (texels, naive) = any_texture(random, &texture)?;
        let (a, b) = (random.next_u64(), random.next_u64() >> random.below(33));
        let [u, v] = [a as u32, (a >> 32) as u32];
        let [du, dv] = [b as u32, 0_u32.wrapping_sub((b >> 32) as u32)];
        let texel = |k: usize| {
            let at = |start: u32, step: u32| (i128::from(start) + k as i128 * i128::from(step)) >> 16;
            naive.at(at(u, du), at(v, dv))
        };
        let after: Vec<u8> = (0..shape.length).map(texel).collect();
        let Naive { ubits, vbits, .. } = naive;
        canvas
            .check(shape.alignment, &vec![0x77; shape.length], &after, |row| fill(row, texels, u, v, du, dv))
            .map_err(|wrong| format!("2^{ubits} × 2^{vbits}, from {u:#x} {v:#x} by {du:#x} {dv:#x}: {wrong}"))
    })
}

/// Numerators and divisor at the first pixel, and the increment of each per pixel.
struct Row {
    numerators: [i128; 2],
    steps: [i128; 2],
    d: i128,
    dd: i128,
}

/// A number from −2^`bits` to 2^`bits`, each power of two equally likely.
fn signed(random: &mut Random, bits: u32) -> i128 {
    let magnitude = random.log_uniform(bits) as i128 - 1;
    if random.below(2) == 0 { magnitude } else { -magnitude }
}

/// A number from 1 to 2⁹³.
fn divisor(random: &mut Random) -> i128 {
    let wide = i128::from(random.next_u64()) << 64 | i128::from(random.next_u64());
    (wide & ((1 << random.within(1, 93)) - 1)).max(1)
}

impl Row {
    /// Arbitrary quotients and divisors at both ends of the row.
    fn anywhere(random: &mut Random, length: usize) -> Self {
        let gaps = length.max(2) as i128 - 1;
        let ends = [divisor(random), divisor(random)];
        let dd = (ends[1] - ends[0]) / gaps;
        let last_d = ends[0] + gaps * dd;
        let mut numerators = [0; 2];
        let mut steps = [0; 2];
        for i in 0..2 {
            // Within ±2³²; rounding the step moves the last by less than 2¹² · 2.
            let [first, last] = [ends[0], last_d].map(|d| signed(random, 31) * d + i128::from(random.next_u64()) % d);
            numerators[i] = first;
            steps[i] = (last - first) / gaps;
        }
        Self { numerators, steps, d: ends[0], dd }
    }

    /// Quotients that are whole texels, or one unit of the numerator away from one, all along the row.
    fn between_texels(random: &mut Random, length: usize) -> Self {
        let gaps = length.max(2) as i128 - 1;
        let ends = [divisor(random), divisor(random)];
        let dd = if random.below(2) == 0 { 0 } else { (ends[1] - ends[0]) / gaps };
        let mut numerators = [0; 2];
        let mut steps = [0; 2];
        for i in 0..2 {
            let whole = signed(random, 14) * 65_536;
            let beside = i128::from(random.within(-1, 1));
            // If the divisor is the same everywhere, the texel may change from pixel to pixel.
            let change = if dd == 0 { signed(random, 3) * 65_536 } else { 0 };
            numerators[i] = whole * ends[0] + beside;
            steps[i] = whole * dd + change * ends[0];
        }
        Self { numerators, steps, d: ends[0], dd }
    }

    /// The coordinates of pixel k, by definition.
    fn coordinates(&self, k: usize) -> [i128; 2] {
        let k = k as i128;
        let d = self.d + k * self.dd;
        debug_assert!(0 < d && d < 1 << 126, "divisor {d}");
        [0, 1].map(|i| {
            let n = self.numerators[i] + k * self.steps[i];
            let q = n.div_euclid(d);
            debug_assert!(q * d <= n && n < (q + 1) * d, "{n} / {d}: {q}");
            debug_assert!(q.abs() < 1 << 32, "quotient {q}");
            q
        })
    }
}

/// Checks texels in exact perspective.
///
/// # Errors
/// The first wrong row.
pub fn check_perspective(
    cases: Cases,
    mut fill: impl FnMut(&mut [u8], Texels<'_>, [i128; 2], [i128; 2], i128, i128),
) -> Checked {
    let texture = bytes(&mut cases.random("texture"), 65_536);
    let mut count = 0;
    for kind in [Row::anywhere, Row::between_texels] {
        count += on_every_shape(cases, "perspective", |random, canvas, shape| {
            let (texels, naive) = any_texture(random, &texture)?;
            let row = kind(random, shape.length);
            let texel = |k: usize| {
                let [u, v] = row.coordinates(k);
                naive.at(u >> 16, v >> 16)
            };
            let after: Vec<u8> = (0..shape.length).map(texel).collect();
            let (Row { numerators, steps, d, dd }, Naive { ubits, vbits, .. }) = (row, naive);
            let draw = |row: &mut [u8]| fill(row, texels, numerators, steps, d, dd);
            canvas.check(shape.alignment, &vec![0x77; shape.length], &after, draw).map_err(|wrong| {
                format!("2^{ubits} × 2^{vbits}, ({numerators:?} by {steps:?}) / ({d} by {dd}): {wrong}")
            })
        })?;
    }
    Ok(count)
}

/// Checks lookups in a table of two bytes.
///
/// # Errors
/// The first wrong row.
pub fn check_lookup(cases: Cases, mut lookup: impl FnMut(&mut [u8], &[u8], &[u8; 65_536])) -> Checked {
    let table = bytes(&mut cases.random("table"), 65_536);
    let Some(table) = table.first_chunk() else { return Err("no table".into()) };
    on_every_shape(cases, "lookup", |random, canvas, shape| {
        let before = bytes(random, shape.length);
        let high = other_row(random, shape.length);
        let naive = |(k, low): (usize, &u8)| match high.get(k) {
            Some(high) => table[256 * usize::from(*high) + usize::from(*low)],
            None => *low,
        };
        let after: Vec<u8> = before.iter().enumerate().map(naive).collect();
        canvas
            .check(shape.alignment, &before, &after, |row| lookup(row, &high, table))
            .map_err(|wrong| format!("{} high bytes: {wrong}", high.len()))
    })
}
