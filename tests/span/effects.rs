//! The loops beside the span: dither, texels, look-ups, channels, depth, light. Every form of each against a
//! naive oracle: at every length of a screen row and every alignment, with guard bytes; and for each loop
//! wrong ones, made on purpose, which the same check has to find out.

use crate::support::random::Random;
use crate::support::tried::Tried;
use mode13h::lanes::{LANES, Points};
use mode13h::palette::Rgb;
use mode13h::palette::cube;
use mode13h::span::channels::{mix_cube, mix_cube_portable, mix_nearest};
use mode13h::span::curve::curve;
use mode13h::span::depth::{Cell, copy_before, copy_nearer};
use mode13h::span::dither::{BAYER, fill_dithered, fill_dithered_portable};
use mode13h::span::fixed16::fill_16_16;
use mode13h::span::float::fill_float;
use mode13h::span::lit::interpolate;
use mode13h::span::texture::{Texels, TexelsError, fill_affine, fill_perspective, fill_perspective_portable};
use mode13h::span::{Kernel, lookup};
use std::fmt::Debug;

/// Bytes before and behind the row that have to stay as they were.
const GUARD: usize = 64;

/// Where a row lies: `alignment` bytes beyond a multiple of 64.
#[derive(Clone, Copy, Debug)]
struct Shape {
    length: usize,
    alignment: usize,
}

/// Every length to 320 at every alignment, and 2,000 longer ones.
const SHAPES: u64 = 321 * 64 + 2_000;

fn shapes() -> impl Iterator<Item = Shape> {
    let mut random = Random::named("shapes");
    let screen = (0..=320).flat_map(|length| (0..64).map(move |alignment| Shape { length, alignment }));
    let longer = (0..2_000).map(move |i| Shape { length: random.log_uniform(12), alignment: i % 64 });
    screen.chain(longer)
}

/// Memory to draw in, reused from case to case.
struct Canvas {
    bytes: Vec<u8>,
}

/// No constant, so that bytes moved or copied show too.
fn guard_byte(i: usize) -> u8 {
    0xA5 ^ (i as u8)
}

impl Canvas {
    fn new() -> Self {
        Self { bytes: (0..4_096 + 64 + 63 + 2 * GUARD).map(guard_byte).collect() }
    }

    /// Lets `draw` at a row that holds `before`, and compares with `after`: the row's bytes are these, and no
    /// other byte has changed.
    fn check(
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

/// The cases of one loop: `one` draws a case of each shape, and says what was wrong. How many there were.
fn on_every_shape(
    stream: &str,
    mut one: impl FnMut(&mut Random, &mut Canvas, Shape) -> Result<(), String>,
) -> Result<u64, String> {
    let (mut random, mut canvas, mut cases) = (Random::named(stream), Canvas::new(), 0);
    for shape in shapes() {
        one(&mut random, &mut canvas, shape).map_err(|wrong| format!("{stream}: {shape:?}: {wrong}"))?;
        cases += 1;
    }
    Ok(cases)
}

/// A loop in this form is right, in as many cases as stated.
#[track_caller]
fn assert_right(form: &str, stated: u64, result: Result<u64, String>) {
    let mut tried = Tried::new(form, stated);
    match result {
        Ok(cases) => tried.add(cases),
        Err(wrong) => panic!("{form}: {wrong}"),
    }
    tried.done();
}

/// A loop that is wrong is found out, by a line that names a pixel or a byte.
#[track_caller]
fn assert_caught(fault: &str, result: Result<u64, String>) {
    match result {
        Ok(cases) => panic!("{fault}: not found in {cases} cases"),
        Err(wrong) => println!("{fault}: {wrong}"),
    }
}

fn bytes(random: &mut Random, count: usize) -> Vec<u8> {
    (0..count).map(|_| random.next_u64() as u8).collect()
}

/// Numbers at which something changes its sign, carries or is as large as can be.
const EDGES: [u16; 14] = [0, 1, 0x7F, 0x80, 0xFF, 0x100, 0x101, 0x7FFF, 0x8000, 0x8001, 0xFEFF, 0xFF00, 0xFF01, 0xFFFF];

fn any_u16(random: &mut Random) -> u16 {
    if random.next_u64().is_multiple_of(4) { random.one_of(&EDGES) } else { random.next_u64() as u16 }
}

/// Thresholds: of Bayer's matrix, all the same, or any.
fn any_thresholds(random: &mut Random) -> [u8; 8] {
    match random.within(0, 5) {
        0 => [0; 8],
        1 => [255; 8],
        2 => [128; 8],
        3 => random.next_u64().to_le_bytes(),
        _ => random.one_of(&BAYER),
    }
}

fn any_column(random: &mut Random) -> usize {
    if random.next_u64().is_multiple_of(8) {
        usize::MAX - random.within(0, 20) as usize
    } else {
        random.within(0, 4_095) as usize
    }
}

mod dithered {
    use super::*;

    type Fill = fn(&mut [u8], u16, u16, &[u8; 8], usize);

    fn naive(length: usize, shade: u16, step: u16, thresholds: &[u8; 8], x: usize) -> Vec<u8> {
        let pixel = |k: usize| {
            let threshold = thresholds[((x as u128 + k as u128) % 8) as usize];
            let sum = i64::from(shade) + k as i64 * i64::from(step) + i64::from(threshold);
            (sum % 65_536 / 256) as u8
        };
        (0..length).map(pixel).collect()
    }

    fn check(fill: Fill) -> Result<u64, String> {
        on_every_shape("dithered", |random, canvas, shape| {
            let (shade, step) = (any_u16(random), any_u16(random));
            let (thresholds, x) = (any_thresholds(random), any_column(random));
            let after = naive(shape.length, shade, step, &thresholds, x);
            let draw = |row: &mut [u8]| fill(row, shade, step, &thresholds, x);
            canvas
                .check(shape.alignment, &vec![0x77; shape.length], &after, draw)
                .map_err(|wrong| format!("shade {shade:#06x} step {step:#06x} {thresholds:?} x {x}: {wrong}"))
        })
    }

    #[test]
    fn dithered_spans_are_the_definition() {
        assert_right("dithered portable", SHAPES, check(fill_dithered_portable));
        assert_right("dithered fastest", SHAPES, check(fill_dithered));
    }

    #[test]
    fn wrong_dithered_spans_are_caught() {
        assert_caught("the column is forgotten", check(|row, s, d, t, _| fill_dithered(row, s, d, t, 0)));
        assert_caught(
            "the half is added, too",
            check(|row, s, d, t, x| fill_dithered(row, s + 128 * u16::from(s < 99), d, t, x)),
        );
        let last = |row: &mut [u8], shade: u16, step: u16, thresholds: &[u8; 8], x: usize| {
            fill_dithered(row, shade, step, thresholds, x);
            // The last eight, as if a block began there.
            if let Some(from) = row.len().checked_sub(8).filter(|from| *from >= 300) {
                let start = shade.wrapping_add(step.wrapping_mul(from as u16));
                fill_dithered(&mut row[from..], start, step, thresholds, x);
            }
        };
        assert_caught("the last block has the first one's thresholds", check(last));
    }

    #[test]
    fn the_matrix_is_bayers() {
        // Each matrix is made of the next smaller: four times its ranks, and 0, 2, 3, 1 more.
        let mut ranks = vec![vec![0_u32]];
        while ranks.len() < 8 {
            let half = ranks.len();
            let place = |y: usize, x: usize| 4 * ranks[y % half][x % half] + [[0, 2], [3, 1]][y / half][x / half];
            ranks = (0..2 * half).map(|y| (0..2 * half).map(|x| place(y, x)).collect()).collect();
        }
        for (row, ranks) in BAYER.iter().zip(&ranks) {
            for (threshold, rank) in row.iter().zip(ranks) {
                let exact = f64::from(2 * rank + 1) * 255.0 / 128.0;
                assert!((f64::from(*threshold) - exact).abs() < 0.5, "rank {rank}: {threshold}, not {exact}");
            }
        }
    }

    #[test]
    fn the_thresholds_are_spread_evenly() {
        let mut thresholds = BAYER.concat();
        assert_eq!(thresholds.iter().map(|t| 2 * u32::from(*t)).sum::<u32>(), 64 * 255, "the mean is 127.5");
        thresholds.sort_unstable();
        for (low, high) in thresholds.iter().zip(thresholds.iter().rev()) {
            assert_eq!(u32::from(*low) + u32::from(*high), 255);
        }
        let steps: Vec<_> = thresholds.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert_eq!((steps.iter().filter(|step| **step == 4).count(), steps[31]), (62, 3));
        // Of 8 × 8 pixels as many take the upper byte as the fraction says. The thresholds lie at the middles of
        // 64 equal parts, or within half a unit, so the share is off by half a part of 4 units at most.
        for fraction in 0..256_u16 {
            let mut upper = 0;
            for thresholds in &BAYER {
                let mut row = [0; 8];
                fill_dithered(&mut row, 0x4000 + fraction, 0, thresholds, 0);
                assert!(row.iter().all(|byte| [0x40, 0x41].contains(byte)));
                upper += row.iter().filter(|byte| **byte == 0x41).count();
            }
            assert!((4 * upper).abs_diff(usize::from(fraction)) <= 2, "{fraction} / 256: {upper} of 64");
        }
    }
}

mod fixed16 {
    use super::*;

    type Fill = fn(&mut [u8], u32, u32);

    fn any_u32(random: &mut Random) -> u32 {
        u32::from(any_u16(random)) << 16 | u32::from(any_u16(random))
    }

    fn check(fill: Fill) -> Result<u64, String> {
        on_every_shape("wide", |random, canvas, shape| {
            let (shade, step) = (any_u32(random), any_u32(random));
            let pixel = |k: usize| ((i128::from(shade) + k as i128 * i128::from(step)) / 65_536 % 256) as u8;
            let after: Vec<u8> = (0..shape.length).map(pixel).collect();
            canvas
                .check(shape.alignment, &vec![0x77; shape.length], &after, |row| fill(row, shade, step))
                .map_err(|wrong| format!("shade {shade:#010x} step {step:#010x}: {wrong}"))
        })
    }

    #[test]
    fn spans_in_16_16_are_the_definition() {
        assert_right("spans in 16.16", SHAPES, check(fill_16_16));
    }

    #[test]
    fn wrong_spans_in_16_16_are_caught() {
        assert_caught("a step's last bit is lost", check(|row, shade, step| fill_16_16(row, shade, step & !1)));
        assert_caught("a half is added", check(|row, shade, step| fill_16_16(row, shade.wrapping_add(0x8000), step)));
        let last: Fill = |row, shade, step| {
            fill_16_16(row, shade, step);
            if let Some(last) = row.last_mut().filter(|last| **last == 255) {
                *last = 0;
            }
        };
        assert_caught("the last byte of 255", check(last));
    }
}

mod float {
    use super::*;

    type Fill = fn(&mut [u8], i32, [f32; 2], [f32; 2], [f32; 2]);

    /// Numbers as triangles have them: from any pixel on, quotients of 0 to 255 at both ends or near to that; and
    /// what no triangle has.
    fn any_row(random: &mut Random, length: usize) -> (i32, [f32; 2], [f32; 2], [f32; 2]) {
        let first = random.within(-4_096, 4_096) as i32;
        let gaps = (length.max(2) - 1) as f32;
        let mut divisor = || (2.0_f64.powf(random.unit() * 60.0)) as f32;
        let (d0, d1) = (divisor(), divisor());
        let mut shade = || (random.within(-20, 65_300) as f32 / 256.0).max(0.0);
        let (s0, s1, a, b) = (shade(), shade(), shade(), shade());
        let step = |from: f32, to: f32| (to - from) / gaps;
        let (dn, dd) = (step(s0 * d0, s1 * d1), step(d0, d1));
        let at_zero = |value: f32, step: f32| value - first as f32 * step;
        let range =
            if random.within(0, 1) == 0 { [0.0, 255.0] } else { [a.min(b).floor(), a.max(b).min(255.0).ceil()] };
        match random.within(0, 30) {
            0 => (first, [f32::NAN, 1.0], [1.0, 0.0], range),
            1 => (first, [f32::INFINITY, dn], [1.0, f32::INFINITY], range),
            2 => (first, [0.0, 0.0], [0.0, 0.0], range),
            _ => (first, [at_zero(s0 * d0, dn), dn], [at_zero(d0, dd), dd], range),
        }
    }

    fn naive(length: usize, first: i32, n: [f32; 2], d: [f32; 2], [low, high]: [f32; 2]) -> Vec<u8> {
        let pixel = |i: usize| {
            let k = (i64::from(first) + i as i64) as f32;
            let (above, below) = (n[0] + k * n[1], d[0] + k * d[1]);
            let shade = above / below;
            let shade = if shade.is_nan() { low } else { shade.clamp(low, high) };
            // To 15 bits behind the point, halves to even, then cut.
            (f64::from(shade + 256.5).floor() - 256.0) as u8
        };
        (0..length).map(pixel).collect()
    }

    fn check(fill: Fill) -> Result<u64, String> {
        on_every_shape("float", |random, canvas, shape| {
            let (first, n, d, range) = any_row(random, shape.length);
            let after = naive(shape.length, first, n, d, range);
            canvas
                .check(shape.alignment, &vec![0x77; shape.length], &after, |row| fill(row, first, n, d, range))
                .map_err(|wrong| format!("from {first}: {n:?} / {d:?} in {range:?}: {wrong}"))
        })
    }

    #[test]
    fn spans_in_f32_are_the_definition() {
        assert_right("spans in f32", SHAPES, check(fill_float));
    }

    #[test]
    fn wrong_spans_in_f32_are_caught() {
        assert_caught("the first pixel is always 0", check(|row, _, n, d, range| fill_float(row, 0, n, d, range)));
        assert_caught("no clamp", check(|row, first, n, d, _| fill_float(row, first, n, d, [0.0, 255.0])));
        let added: Fill = |row, first, n, d, [low, high]| {
            let (mut n0, mut d0) = (n[0] + first as f32 * n[1], d[0] + first as f32 * d[1]);
            for pixel in row {
                let shade = n0 / d0;
                let shade = if shade.is_nan() { low } else { shade.clamp(low, high) };
                *pixel = (shade + 0.5) as u8;
                (n0, d0) = (n0 + n[1], d0 + d[1]);
            }
        };
        assert_caught("sums that drift", check(added));
    }
}

/// Textures of every shape, cut from the same bytes.
fn any_texture(random: &mut Random, bytes: &[u8]) -> (u32, u32, Vec<u8>) {
    let (ubits, vbits) = (random.within(0, 8) as u32, random.within(0, 8) as u32);
    (ubits, vbits, bytes[..1 << (ubits + vbits)].to_vec())
}

/// The texel at whole coordinates, any number of texels away.
fn naive_texel(bytes: &[u8], ubits: u32, vbits: u32, u: i128, v: i128) -> u8 {
    let (width, height) = (2_i128.pow(ubits), 2_i128.pow(vbits));
    bytes[(v.rem_euclid(height) * width + u.rem_euclid(width)) as usize]
}

mod affine {
    use super::*;

    type Fill = fn(&mut [u8], Texels<'_>, u32, u32, u32, u32);

    fn check(fill: Fill) -> Result<u64, String> {
        let texture = bytes(&mut Random::named("texture"), 65_536);
        on_every_shape("affine", |random, canvas, shape| {
            let (ubits, vbits, bytes) = any_texture(random, &texture);
            let texels = Texels::new(&bytes, ubits, vbits).expect("a texture");
            let (a, b) = (random.next_u64(), random.next_u64() >> random.within(0, 32));
            let [u, v] = [a as u32, (a >> 32) as u32];
            let [du, dv] = [b as u32, 0_u32.wrapping_sub((b >> 32) as u32)];
            let texel = |k: usize| {
                let at = |start: u32, step: u32| (i128::from(start) + k as i128 * i128::from(step)) >> 16;
                naive_texel(&bytes, ubits, vbits, at(u, du), at(v, dv))
            };
            let after: Vec<u8> = (0..shape.length).map(texel).collect();
            canvas
                .check(shape.alignment, &vec![0x77; shape.length], &after, |row| fill(row, texels, u, v, du, dv))
                .map_err(|wrong| format!("2^{ubits} × 2^{vbits}, from {u:#x} {v:#x} by {du:#x} {dv:#x}: {wrong}"))
        })
    }

    #[test]
    fn affine_texels_are_the_definition() {
        assert_right("affine", SHAPES, check(fill_affine));
    }

    #[test]
    fn wrong_affine_texels_are_caught() {
        let turned: Fill = |row, texels, u, v, du, dv| {
            let (ubits, vbits) = (texels.width().ilog2(), texels.height().ilog2());
            let bytes: Vec<u8> = (0..1 << (ubits + vbits)).map(|i| texels.at(i << 16, (i >> ubits) << 16)).collect();
            fill_affine(row, Texels::new(&bytes, vbits, ubits).expect("a texture"), u, v, du, dv);
        };
        assert_caught("width for height", check(turned));
        let coarse: Fill = |row, texels, u, v, du, dv| fill_affine(row, texels, u, v, du & !1, dv);
        assert_caught("a step's last bit is lost", check(coarse));
    }

    #[test]
    fn only_textures_are_taken() {
        for ubits in 0..=8 {
            for vbits in 0..=8 {
                let should = 1 << (ubits + vbits);
                let texels = Texels::new(&vec![0; should], ubits, vbits).map(|t| (t.width(), t.height()));
                assert_eq!(texels, Ok((1 << ubits, 1 << vbits)));
                for is in [should - 1, should + 1, 0] {
                    let error = Texels::new(&vec![0; is], ubits, vbits).expect_err("no texture");
                    assert_eq!(error, TexelsError::Length { is, should });
                }
            }
        }
        for (ubits, vbits) in [(9, 0), (0, 9), (32, 32), (u32::MAX, 1)] {
            let error = Texels::new(&[0; 512], ubits, vbits).expect_err("too large");
            assert_eq!(error, TexelsError::Bits { ubits, vbits });
        }
        let said = Texels::new(&[0; 5], 1, 1).expect_err("no texture").to_string();
        assert_eq!(said, "a texture of 4 texels with 5 bytes");
        let said = Texels::new(&[], 9, 1).expect_err("no texture").to_string();
        assert_eq!(said, "a texture of 2^9 × 2^1 texels; at most 256 × 256 are possible");
    }
}

mod perspective {
    use super::*;

    type Fill = fn(&mut [u8], Texels<'_>, [i128; 2], [i128; 2], i128, i128);

    /// Numerator and divisor of the first pixel and their steps, for a row of `length` pixels.
    struct Row {
        numerators: [i128; 2],
        steps: [i128; 2],
        d: i128,
        dd: i128,
    }

    /// −2^`bits` to 2^`bits`, each power of two as likely as any other.
    fn signed(random: &mut Random, bits: u32) -> i128 {
        let magnitude = random.log_uniform(bits) as i128 - 1;
        if random.next_u64().is_multiple_of(2) { magnitude } else { -magnitude }
    }

    /// 1 to 2⁹³.
    fn divisor(random: &mut Random) -> i128 {
        let wide = i128::from(random.next_u64()) << 64 | i128::from(random.next_u64());
        (wide & ((1 << random.within(1, 93)) - 1)).max(1)
    }

    impl Row {
        /// Quotients anywhere, divisors too, from one end of the row to the other.
        fn anywhere(random: &mut Random, length: usize) -> Self {
            let gaps = length.max(2) as i128 - 1;
            let ends = [divisor(random), divisor(random)];
            let dd = (ends[1] - ends[0]) / gaps;
            let last_d = ends[0] + gaps * dd;
            let mut numerators = [0; 2];
            let mut steps = [0; 2];
            for i in 0..2 {
                // Within ±2³²; the rounded step moves the last by less than 2¹² · 2.
                let [first, last] =
                    [ends[0], last_d].map(|d| signed(random, 31) * d + i128::from(random.next_u64()) % d);
                numerators[i] = first;
                steps[i] = (last - first) / gaps;
            }
            Self { numerators, steps, d: ends[0], dd }
        }

        /// Quotients that are a whole texel, or one part of the divisor beside it, all along the row.
        fn between_texels(random: &mut Random, length: usize) -> Self {
            let gaps = length.max(2) as i128 - 1;
            let ends = [divisor(random), divisor(random)];
            let dd = if random.next_u64().is_multiple_of(2) { 0 } else { (ends[1] - ends[0]) / gaps };
            let mut numerators = [0; 2];
            let mut steps = [0; 2];
            for i in 0..2 {
                let whole = signed(random, 14) * 65_536;
                let beside = i128::from(random.within(-1, 1));
                // With the same divisor everywhere the texel may change from pixel to pixel.
                let change = if dd == 0 { signed(random, 3) * 65_536 } else { 0 };
                numerators[i] = whole * ends[0] + beside;
                steps[i] = whole * dd + change * ends[0];
            }
            Self { numerators, steps, d: ends[0], dd }
        }

        /// What the definition says of pixel k.
        fn coordinates(&self, k: usize) -> [i128; 2] {
            let k = k as i128;
            let d = self.d + k * self.dd;
            assert!(0 < d && d < 1 << 126, "divisor {d}");
            [0, 1].map(|i| {
                let n = self.numerators[i] + k * self.steps[i];
                let q = n.div_euclid(d);
                assert!(q * d <= n && n < (q + 1) * d, "{n} / {d}: {q}");
                assert!(q.abs() < 1 << 32, "quotient {q}");
                q
            })
        }
    }

    fn check(fill: Fill) -> Result<u64, String> {
        let texture = bytes(&mut Random::named("texture"), 65_536);
        let mut cases = 0;
        for kind in [Row::anywhere, Row::between_texels] {
            cases += on_every_shape("perspective", |random, canvas, shape| {
                let (ubits, vbits, bytes) = any_texture(random, &texture);
                let texels = Texels::new(&bytes, ubits, vbits).expect("a texture");
                let row = kind(random, shape.length);
                let texel = |k: usize| {
                    let [u, v] = row.coordinates(k);
                    naive_texel(&bytes, ubits, vbits, u >> 16, v >> 16)
                };
                let after: Vec<u8> = (0..shape.length).map(texel).collect();
                let Row { numerators, steps, d, dd } = row;
                let draw = |row: &mut [u8]| fill(row, texels, numerators, steps, d, dd);
                canvas.check(shape.alignment, &vec![0x77; shape.length], &after, draw).map_err(|wrong| {
                    format!("2^{ubits} × 2^{vbits}, ({numerators:?} by {steps:?}) / ({d} by {dd}): {wrong}")
                })
            })?;
        }
        Ok(cases)
    }

    #[test]
    fn perspective_texels_are_the_definition() {
        assert_right("perspective portable", 2 * SHAPES, check(fill_perspective_portable));
        assert_right("perspective fastest", 2 * SHAPES, check(fill_perspective));
    }

    /// Draws with coordinates made by `quotient`.
    fn fill_by(
        quotient: impl Fn(i128, i128) -> i128,
        row: &mut [u8],
        texels: Texels<'_>,
        [u, v]: [i128; 2],
        [du, dv]: [i128; 2],
        d: i128,
        dd: i128,
    ) {
        for (k, pixel) in (0..).zip(row) {
            let d = d + k * dd;
            *pixel = texels.at(quotient(u + k * du, d) as u32, quotient(v + k * dv, d) as u32);
        }
    }

    #[test]
    fn wrong_perspective_texels_are_caught() {
        let truncated: Fill = |row, t, n, dn, d, dd| fill_by(|n, d| n / d, row, t, n, dn, d, dd);
        assert_caught("quotients toward zero", check(truncated));
        let estimated: Fill = |row, t, n, dn, d, dd| {
            fill_by(|n, d| (n as f64 / d as f64).floor() as i128, row, t, n, dn, d, dd);
        };
        assert_caught("floors of estimates", check(estimated));
        // What is right for quotients that are not negative: toward zero, then one correction.
        let corrected: Fill = |row, t, n, dn, d, dd| {
            let floor = |n: i128, d: i128| {
                let near = (n as f64 / d as f64) as i128;
                let rest = n - near * d;
                near + i128::from(rest >= d) - i128::from(rest < 0)
            };
            fill_by(floor, row, t, n, dn, d, dd);
        };
        assert_caught("one correction of an estimate toward zero", check(corrected));
        let affine: Fill = |row, t, n, dn, d, _| fill_perspective_portable(row, t, n, dn, d, 0);
        assert_caught("the divisor does not change", check(affine));
    }
}

mod look_up {
    use super::*;

    type Lookup = fn(&mut [u8], &[u8], &[u8; 65_536]);

    fn check(lookup: Lookup) -> Result<u64, String> {
        let table = bytes(&mut Random::named("table"), 65_536);
        let table: &[u8; 65_536] = table.as_slice().try_into().expect("as long");
        on_every_shape("lookup", |random, canvas, shape| {
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

    #[test]
    fn look_ups_are_the_definition() {
        assert_right("lookup", SHAPES, check(lookup));
    }

    #[test]
    fn wrong_look_ups_are_caught() {
        let swapped: Lookup = |row, high, table| {
            for (pixel, high) in row.iter_mut().zip(high) {
                *pixel = table[usize::from(*pixel) << 8 | usize::from(*high)];
            }
        };
        assert_caught("the bytes change places", check(swapped));
        let padded: Lookup = |row, high, table| {
            let mut high = high.to_vec();
            high.resize(row.len(), 0);
            lookup(row, &high, table);
        };
        assert_caught("pixels beyond the shorter row are drawn", check(padded));
    }
}

/// A row beside another one: as long, or in one of four cases a bit shorter or longer.
fn other_row(random: &mut Random, length: usize) -> Vec<u8> {
    let length = match random.within(0, 7) {
        0 => length.saturating_sub(random.within(1, 20) as usize),
        1 => length + random.within(1, 20) as usize,
        _ => length,
    };
    bytes(random, length)
}

mod mixed {
    use super::*;

    type MixCube = fn(&mut [u8], &[u8], &[u8], &[u8], &[u8; 8], usize);
    type MixNearest = fn(&mut [u8], &[u8], &[u8], &[u8], &[u8; 8], usize, u8, &[u8; 32_768]);

    /// The rule of the cube, for one channel.
    fn naive_level(value: u8, threshold: u8) -> u8 {
        let levels = [0, 52, 101, 154, 203, 255_i64];
        let (c, t) = (i64::from(value), i64::from(threshold));
        let below = (0..6).rev().find(|i| levels[*i] <= c).expect("0 is a level");
        let Some(b) = levels.get(below + 1) else { return 5 };
        below as u8 + u8::from(256 * (c - levels[below]) > t * (b - levels[below]))
    }

    /// Draws three rows, and compares with what `naive` makes of a colour at a threshold.
    fn check_rows(
        random: &mut Random,
        canvas: &mut Canvas,
        shape: Shape,
        naive: impl Fn([u8; 3], u8) -> u8,
        draw: impl FnOnce(&mut [u8], [&[u8]; 3], &[u8; 8], usize),
    ) -> Result<(), String> {
        let channels: [_; 3] = std::array::from_fn(|_| other_row(random, shape.length));
        let (thresholds, x) = (any_thresholds(random), any_column(random));
        let before = bytes(random, shape.length);
        let pixel = |(k, before): (usize, &u8)| {
            let threshold = thresholds[((x as u128 + k as u128) % 8) as usize];
            let [Some(r), Some(g), Some(b)] = channels.each_ref().map(|channel| channel.get(k)) else { return *before };
            naive([*r, *g, *b], threshold)
        };
        let after: Vec<u8> = before.iter().enumerate().map(pixel).collect();
        let rows = channels.each_ref().map(Vec::as_slice);
        canvas
            .check(shape.alignment, &before, &after, |row| draw(row, rows, &thresholds, x))
            .map_err(|wrong| format!("{:?} values, {thresholds:?} x {x}: {wrong}", rows.map(<[u8]>::len)))
    }

    fn check_cube(mix: MixCube) -> Result<u64, String> {
        on_every_shape("cube", |random, canvas, shape| {
            let naive = |color: [u8; 3], threshold| {
                let [r, g, b] = color.map(|value| naive_level(value, threshold));
                36 * r + 6 * g + b
            };
            check_rows(random, canvas, shape, naive, |row, [r, g, b], thresholds, x| mix(row, r, g, b, thresholds, x))
        })
    }

    fn check_nearest(mix: MixNearest) -> Result<u64, String> {
        let map = bytes(&mut Random::named("map"), 32_768);
        let map: &[u8; 32_768] = map.as_slice().try_into().expect("as long");
        on_every_shape("nearest", |random, canvas, shape| {
            let spread = random.one_of(&[0, 1, 2, 3, 8, 31, 32, 51, 64, 127, 128, 200, 254, 255]);
            let naive = |color: [u8; 3], threshold: u8| {
                let [r, g, b] = color.map(|value| {
                    let moved =
                        i64::from(value) + i64::from(threshold) * i64::from(spread) / 256 - i64::from(spread) / 2;
                    moved.clamp(0, 255) / 8
                });
                map[(1_024 * r + 32 * g + b) as usize]
            };
            let draw = |row: &mut [u8], [r, g, b]: [&[u8]; 3], thresholds: &[u8; 8], x| {
                mix(row, r, g, b, thresholds, x, spread, map);
            };
            check_rows(random, canvas, shape, naive, draw).map_err(|wrong| format!("spread {spread}: {wrong}"))
        })
    }

    #[test]
    fn mixtures_are_the_definition() {
        assert_right("mix_cube portable", SHAPES, check_cube(mix_cube_portable));
        assert_right("mix_cube fastest", SHAPES, check_cube(mix_cube));
        assert_right("mix_nearest", SHAPES, check_nearest(mix_nearest));
    }

    #[test]
    fn wrong_mixtures_are_caught() {
        let lower: MixCube = |row, r, g, b, t, x| mix_cube(row, r, g, b, &t.map(|t| t.saturating_sub(1)), x);
        assert_caught("a threshold that is reached counts as passed", check_cube(lower));
        let places: MixCube = |row, r, g, b, t, x| mix_cube(row, g, r, b, t, x);
        assert_caught("red and green change places", check_cube(places));
        let up: MixNearest = |row, r, g, b, t, x, spread, map| {
            mix_nearest(row, r, g, b, t, x, spread, map);
            if spread % 2 == 1 {
                // Half the spread, rounded up.
                let lower = |channel: &[u8]| channel.iter().map(|c| c.saturating_sub(1)).collect::<Vec<_>>();
                mix_nearest(row, &lower(r), &lower(g), &lower(b), t, x, spread, map);
            }
        };
        assert_caught("half the spread is rounded up", check_nearest(up));
    }

    /// Every value of a channel at every threshold, beside two others that do not move.
    #[test]
    fn every_value_at_every_threshold() {
        let mut tried = Tried::new("every_value_at_every_threshold", 2 * 65_536 * 3);
        let values: Vec<u8> = (0..=255).collect();
        for mix in [mix_cube_portable, mix_cube] {
            for threshold in 0..=255 {
                for (channel, weight) in [36, 6, 1].into_iter().enumerate() {
                    let mut rows = [[0; 256].as_slice(), &[52; 256], &[255; 256]];
                    let others =
                        [0, 6, 5].iter().enumerate().filter(|(i, _)| *i != channel).map(|(_, base)| base).sum::<u8>();
                    rows[channel] = &values;
                    let mut row = [0; 256];
                    mix(&mut row, rows[0], rows[1], rows[2], &[threshold; 8], 0);
                    for (value, entry) in values.iter().zip(row) {
                        let level = naive_level(*value, threshold);
                        assert_eq!(entry, weight * level + others, "{value} at {threshold}, channel {channel}");
                        if let Some(own) = [0, 52, 101, 154, 203, 255].iter().position(|level| level == value) {
                            assert_eq!(usize::from(level), own, "a level moved at threshold {threshold}");
                        }
                        tried.add(1);
                    }
                }
            }
        }
        tried.done();
    }

    /// At 128 the nearest mixture; at 127 too, but a value half-way between two levels goes up.
    #[test]
    fn in_the_middle_it_is_the_nearest_level() {
        let values: Vec<u8> = (0..=255).collect();
        let mut half_way = Vec::new();
        for value in 0..=255_u8 {
            let mut row = [0; 2];
            let grey = [value; 1];
            mix_cube(&mut row[..1], &grey, &grey, &grey, &[128; 8], 0);
            mix_cube(&mut row[1..], &grey, &grey, &grey, &[127; 8], 0);
            let nearest = cube::nearest_mixture(Rgb::new(value, value, value));
            assert_eq!(row[0], nearest, "{value}");
            if row[1] != nearest {
                assert_eq!(row[1], nearest + 43, "{value}");
                half_way.push(value);
            }
        }
        assert_eq!(half_way, [26, 229]); // of 0 and 52, of 203 and 255
        // And all mixtures, a few million of them in the colours of one plane at a time.
        let mut tried = Tried::new("in_the_middle_it_is_the_nearest_level", 256 * 256);
        for red in 0..=255 {
            let mut row = [0; 256];
            let green: Vec<u8> = values.iter().map(|v| v.wrapping_mul(7).wrapping_add(red)).collect();
            mix_cube(&mut row, &[red; 256], &green, &values, &[128; 8], 0);
            for (k, entry) in row.iter().enumerate() {
                assert_eq!(*entry, cube::nearest_mixture(Rgb::new(red, green[k], values[k])));
                tried.add(1);
            }
        }
        tried.done();
    }
}

mod depth_tested {
    use super::*;

    type Copy<D> = dyn Fn(&mut [u8], &mut [D], &[u8], i64, i64) -> u32;

    /// What a cell holds of a depth, as `Cell` documents it.
    trait Naive: Cell + Debug {
        fn naive(depth: u32) -> Self;
        fn any(random: &mut Random) -> Self;
    }

    impl Naive for u32 {
        fn naive(depth: u32) -> Self {
            depth
        }
        fn any(random: &mut Random) -> Self {
            random.next_u64() as u32 >> random.within(0, 8)
        }
    }

    impl Naive for u16 {
        fn naive(depth: u32) -> Self {
            u16::try_from((u64::from(depth)).div_ceil(1 << 14)).unwrap_or(u16::MAX)
        }
        fn any(random: &mut Random) -> Self {
            random.next_u64() as u16
        }
    }

    fn check<D: Naive>(copy: &Copy<D>, keeps: bool) -> Result<u64, String> {
        on_every_shape("depth", |random, canvas, shape| {
            let before = bytes(random, shape.length);
            let drawn = other_row(random, shape.length);
            let z = random.within(0, 1 << 56);
            let dz = random.within(-(1 << 50), 1 << 50) >> random.within(0, 50);
            let at = |k: usize| D::naive(((i128::from(z) + k as i128 * i128::from(dz)) >> 24) as u32);
            // As long as the row, or not; in one of eight cases the depth that is drawn is there already.
            let cells = other_row(random, shape.length).len();
            let held = |k| if random.next_u64().is_multiple_of(8) { at(k) } else { D::any(random) };
            let depth: Vec<D> = (0..cells).map(held).collect();
            let (mut after, mut after_depth, mut written) = (before.clone(), depth.clone(), 0);
            for k in 0..before.len().min(drawn.len()).min(cells) {
                if at(k) > depth[k] {
                    after[k] = drawn[k];
                    written += 1;
                    if !keeps {
                        after_depth[k] = at(k);
                    }
                }
            }
            let mut is_depth = depth.clone();
            let mut is_written = 0;
            canvas
                .check(shape.alignment, &before, &after, |row| is_written = copy(row, &mut is_depth, &drawn, z, dz))
                .and_then(|()| {
                    if is_written == written { Ok(()) } else { Err(format!("{is_written} written, not {written}")) }
                })
                .and_then(|()| if is_depth == after_depth { Ok(()) } else { Err("other depths".into()) })
                .map_err(|wrong| format!("z {z:#x} dz {dz:#x}, {cells} cells, {} bytes: {wrong}", drawn.len()))
        })
    }

    #[test]
    fn copies_with_a_depth_test_are_the_definition() {
        assert_right("copy_nearer u32", SHAPES, check::<u32>(&copy_nearer, false));
        assert_right("copy_nearer u16", SHAPES, check::<u16>(&copy_nearer, false));
        assert_right("copy_before u32", SHAPES, check::<u32>(&|r, d, b, z, dz| copy_before(r, d, b, z, dz), true));
        assert_right("copy_before u16", SHAPES, check::<u16>(&|r, d, b, z, dz| copy_before(r, d, b, z, dz), true));
    }

    /// A copy by a kernel of as many pixels as there are, with cells and bytes behind them, which have to stay.
    fn by<D: Naive, const KEEPS: bool>(kernel: Kernel) -> impl Fn(&mut [u8], &mut [D], &[u8], i64, i64) -> u32 {
        move |row, depth, bytes, z, dz| {
            let length = row.len().min(depth.len()).min(bytes.len());
            let (mut cells, mut bytes) = (depth.to_vec(), bytes.to_vec());
            // As many as a turn takes, or fewer. Whatever is drawn is nearer than these cells.
            cells.extend((0..length % 10).map(|_| D::default()));
            bytes.extend((0..length / 10 % 10).map(|_| 0xEE));
            let behind = cells[length..].to_vec();
            let written = kernel.copy_where_nearer::<D, KEEPS>(length, row, &mut cells, &bytes, z, dz);
            assert!(cells[length..] == behind, "cells behind {length} have changed");
            let kept = depth.len();
            depth.copy_from_slice(&cells[..kept]);
            written
        }
    }

    #[test]
    fn copies_by_every_kernel_are_the_definition() {
        for kernel in Kernel::available() {
            assert_right(&format!("{kernel}, nearer, u32"), SHAPES, check::<u32>(&by::<_, true>(kernel), false));
            assert_right(&format!("{kernel}, before, u32"), SHAPES, check::<u32>(&by::<_, false>(kernel), true));
            assert_right(&format!("{kernel}, nearer, u16"), SHAPES, check::<u16>(&by::<_, true>(kernel), false));
        }
    }

    #[test]
    fn wrong_copies_are_caught() {
        assert_caught("the depths are not kept", check::<u32>(&copy_nearer, true));
        assert_caught("the depths are kept", check::<u16>(&|r, d, b, z, dz| copy_before(r, d, b, z, dz), false));
        let equal = |row: &mut [u8], depth: &mut [u32], bytes: &[u8], z, dz| {
            let lower: Vec<u32> = depth.iter().map(|d| d.saturating_sub(1)).collect();
            copy_before(row, &lower, bytes, z, dz)
        };
        assert_caught("an equal depth counts as nearer", check(&equal, true));
        let one_more = |row: &mut [u8], depth: &mut [u32], bytes: &[u8], z, dz| {
            let length = (row.len().min(depth.len()).min(bytes.len()) + 1).min(row.len());
            Kernel::PORTABLE.copy_where_nearer::<_, true>(length, row, depth, &[bytes, &[0xEE]].concat(), z, dz)
        };
        assert_caught("a pixel behind the last", check(&one_more, false));
    }
}

mod lit {
    use super::*;

    type Interpolate = fn(u16, &[f64; 6], &[f64; 6], f64, f64) -> Points;

    fn check(interpolate: Interpolate) -> Result<u64, String> {
        let mut random = Random::named("lit");
        let mut cases = 0;
        for first in (0..=320).chain([1_000, 4_088, 65_535]) {
            for case in 0..8 {
                let mut any = |most: f64| (random.unit() * 2.0 - 1.0) * most;
                let a = std::array::from_fn(|_| any(50.0));
                // Half of them pass through zero among the points, where the least rounding shows.
                let zero = f64::from(first) + 3.0;
                let da = if case % 2 == 0 { a.map(|a: f64| -a / zero) } else { std::array::from_fn(|_| any(0.5)) };
                let (d, dd) = (0.001 + any(1.0).abs(), any(1.0).abs() * 0.01);
                let points = interpolate(first, &a, &da, d, dd);
                for (i, values) in points.iter().enumerate() {
                    for (lane, value) in values.iter().enumerate() {
                        let k = f64::from(u32::from(first) + lane as u32);
                        let reciprocal: f64 = 1.0 / (d + k * dd);
                        let should = ((a[i] + k * da[i]) * reciprocal) as f32;
                        if value.to_bits() != should.to_bits() {
                            return Err(format!(
                                "from {first}, {a:?} by {da:?} over {d} by {dd}: point {lane} [{i}] is {value}, not {should}"
                            ));
                        }
                    }
                }
                cases += 1;
            }
        }
        Ok(cases)
    }

    #[test]
    fn points_are_the_definition() {
        assert_right("lit", 324 * 8, check(interpolate));
    }

    #[test]
    fn wrong_points_are_caught() {
        let accumulated: Interpolate = |first, a, da, d, dd| {
            let (from, mut points) = (f64::from(first), interpolate(first, a, da, d, dd));
            for (i, values) in points.iter_mut().enumerate() {
                for (steps, value) in (0..).map(f64::from).zip(values).skip(1) {
                    let divisor = (d + from * dd) + steps * dd;
                    *value = (((a[i] + from * da[i]) + steps * da[i]) * (1.0 / divisor)) as f32;
                }
            }
            points
        };
        assert_caught("sums that run on", check(accumulated));
        let reciprocal: Interpolate = |first, a, da, d, dd| {
            let mut points = [[0.0; LANES]; 6];
            for (i, values) in points.iter_mut().enumerate() {
                for (k, value) in (u32::from(first)..).map(f64::from).zip(values) {
                    *value = (a[i] + k * da[i]) as f32 * (1.0 / (d + k * dd)) as f32;
                }
            }
            points
        };
        assert_caught("products with an f32 reciprocal", check(reciprocal));
        let last: Interpolate = |first, a, da, d, dd| {
            let mut points = interpolate(first, a, da, d, dd);
            points[5][LANES - 1] = 0.0;
            points
        };
        assert_caught("the last point", check(last));
    }
}

/// Shades on a parabola: a pass that writes none.
mod curved {
    use super::*;

    type Curve = fn(&mut [u16], [f32; 3], u16, u16);

    /// The definition, of one shade.
    fn shade(k: u16, [a, b, c]: [f32; 3], least: u16, most: u16) -> u16 {
        let k = f32::from(k);
        let product = k * c;
        let sum = b + product;
        let product = k * sum;
        let value = a + product;
        let held = if value.is_nan() { f32::from(least) } else { value.max(f32::from(least)) };
        // Below 2^16.
        f64::from(held.min(f32::from(most))).round_ties_even() as u16
    }

    fn check(curve: Curve) -> Result<u64, String> {
        let mut random = Random::named("curves");
        let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, -0.0, 1e-40, 0.5, 1.5, 65_280.0];
        let mut cases = 0;
        for length in (0..=100).chain([128, 320, 321, 4_096]) {
            for case in 0..60 {
                let mut any = |most: f64| ((random.unit() * 2.0 - 1.0) * most) as f32;
                // From a shade in range to another, whole and half ones among them, and now and then what is none.
                let span = f64::from(length.max(2));
                let mut parabola = [any(70_000.0), any(200_000.0 / span), any(200_000.0 / span / span)];
                match case % 6 {
                    0 => parabola = parabola.map(|value| (value * 2.0).round() / 2.0),
                    1 => parabola = [parabola[0].round() + 0.5, 0.0, 0.0],
                    2 => parabola[random.within(0, 2) as usize] = random.one_of(&odd),
                    _ => {}
                }
                let mut ends = [0, 1].map(|_| random.within(0, 0xFF00) as u16);
                if case % 10 != 0 {
                    ends.sort_unstable();
                }
                let [least, most] = ends;
                let mut shades = vec![0xABCD_u16; usize::from(length) + 8];
                curve(&mut shades[..usize::from(length)], parabola, least, most);
                for (k, is) in (0..length).zip(&shades) {
                    let should = shade(k, parabola, least, most);
                    if *is != should {
                        return Err(format!("{parabola:?} from {least} to {most}: shade {k} is {is}, not {should}"));
                    }
                }
                if shades[usize::from(length)..].iter().any(|beyond| *beyond != 0xABCD) {
                    return Err(format!("{length} shades: something was written beyond"));
                }
                cases += 1;
            }
        }
        Ok(cases)
    }

    #[test]
    fn curves_are_the_definition() {
        assert_right("curves", 105 * 60, check(curve));
        for kernel in Kernel::available() {
            // One after the other, as a function has no kernel of its own.
            let mut random = Random::named("curves by kernels");
            for case in 0..4_000 {
                let length = random.log_uniform(9);
                let mut any = |most: f64| ((random.unit() * 2.0 - 1.0) * most) as f32;
                let parabola = [any(80_000.0), any(4_000.0), any(60.0)];
                let (mut expected, mut shades) = (vec![1; length], vec![2; length]);
                curve(&mut expected, parabola, 0x0123, 0xFE00);
                kernel.curve(&mut shades, parabola, 0x0123, 0xFE00);
                assert_eq!(shades, expected, "{kernel}, case {case}: {parabola:?}");
            }
        }
    }

    #[test]
    fn wrong_curves_are_caught() {
        let accumulated: Curve = |shades, [a, b, c], least, most| {
            let (mut at, mut step) = (a, b + c);
            for shade in shades {
                *shade = at.max(f32::from(least)).min(f32::from(most)).round_ties_even() as u16;
                at += step;
                step += 2.0 * c;
            }
        };
        assert_caught("sums that run on", check(accumulated));
        let truncated: Curve = |shades, [a, b, c], least, most| {
            for (k, shade) in (0_u16..).map(f32::from).zip(shades) {
                *shade = (a + k * (b + k * c)).max(f32::from(least)).min(f32::from(most)) as u16;
            }
        };
        assert_caught("shades that are cut off", check(truncated));
        let unheld: Curve = |shades, parabola, _, most| curve(shades, parabola, 0, most);
        assert_caught("no least", check(unheld));
        let fused: Curve = |shades, [a, b, c], least, most| {
            for (k, shade) in (0_u16..).map(f32::from).zip(shades) {
                let value = k.mul_add(k.mul_add(c, b), a);
                *shade = value.max(f32::from(least)).min(f32::from(most)).round_ties_even() as u16;
            }
        };
        assert_caught("products that are not rounded", check(fused));
    }
}
