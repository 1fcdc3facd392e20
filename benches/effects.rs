//! Times the pixel loops other than spans, portable against optimized, at typical span lengths.
//!
//! ```text
//! cargo bench --bench effects
//! ```
//!
//! The first row is the span's fastest kernel, for comparison.

mod interleaved;

use mode13h::internals::lanes::{LANES, Points};
use mode13h::internals::span::channels::{mix_cube, mix_cube_portable, mix_nearest};
use mode13h::internals::span::depth::{copy_nearer, copy_nearer_keep_depth};
use mode13h::internals::span::dither::{DitherPattern, ThresholdRow, fill_dithered, fill_dithered_portable};
use mode13h::internals::span::fixed16::fill_16_16;
use mode13h::internals::span::float::fill_float;
use mode13h::internals::span::hyperbolic::fill_quotients;
use mode13h::internals::span::lit::interpolate;
use mode13h::internals::span::lookup;
use mode13h::internals::span::texture::{Texels, fill_affine, fill_perspective};
use mode13h::span::Kernel;
use mode13h_conformance::Random;
use std::hint::black_box;

const LENGTHS: [usize; 13] = [1, 2, 4, 8, 12, 16, 24, 32, 48, 64, 100, 160, 320];
/// Rows per batch: one for each offset in a cache line, as spans start anywhere.
const ROWS: usize = 64;
/// Bytes per row, with room for every start offset.
const CAPACITY: usize = 320 + 64;

/// Memory that the loops read and write. The tables exceed a first-level cache, as they do in use.
struct Memory {
    row: Vec<u8>,
    channels: [Vec<u8>; 3],
    depth: Vec<u32>,
    points: Points,
    texture: Vec<u8>,
    table: Box<[u8; 65_536]>,
    map: Box<[u8; 32_768]>,
}

type Draw = fn(&mut Memory, start: usize, length: usize);

type Fill = fn(&mut [u8], u16, u16, &ThresholdRow, usize);
type Affine = fn(&mut [u8], Texels<'_>, u32, u32, u32, u32);
type Perspective = fn(&mut [u8], Texels<'_>, [i128; 2], [i128; 2], i128, i128);
type Lookup = fn(&mut [u8], &[u8], &[u8; 65_536]);
type MixCube = fn(&mut [u8], &[u8], &[u8], &[u8], &ThresholdRow, usize);
type MixNearest = fn(&mut [u8], &[u8], &[u8], &[u8], &ThresholdRow, usize, u8, &[u8; 32_768]);
type Nearer = fn(&mut [u8], &mut [u32], &[u8], i64, i64) -> u32;
type Before = fn(&mut [u8], &[u32], &[u8], i64, i64) -> u32;
type Quotients = fn(&mut [u8], i128, i128, i128, i128);
type Interpolate = fn(u16, &[f64; 6], &[f64; 6], f64, f64) -> Points;
type Fixed16 = fn(&mut [u8], u32, u32);
type Float = fn(&mut [u8], i32, [f32; 2], [f32; 2], [f32; 2]);

/// Loops by name; a portable one comes before its optimized form. Each is called through its address, which is hidden
/// from the compiler, so that none is inlined and specialized for these arguments, and `nm -S` shows its size.
const LOOPS: [(&str, Draw); 15] = [
    ("span", |m, start, n| Kernel::default().fill(&mut m.row[start..start + n], 0x1234, 0x56)),
    ("16.16", |m, start, n| black_box(fill_16_16 as Fixed16)(&mut m.row[start..start + n], 0x12_3456, 0x5678)),
    ("dither portable", |m, start, n| dither(fill_dithered_portable, m, start, n)),
    ("dither", |m, start, n| dither(fill_dithered, m, start, n)),
    ("affine", |m, start, n| {
        let fill = black_box(fill_affine as Affine);
        fill(&mut m.row[start..start + n], texels(&m.texture), 0x12_3456, 0x34_5678, 0xC000, 0x5432);
    }),
    ("perspective", |m, start, n| perspective(fill_perspective, m, start, n)),
    ("lookup", |m, start, n| {
        black_box(lookup as Lookup)(&mut m.row[start..start + n], &m.channels[0][start..start + n], &m.table);
    }),
    ("mix_cube portable", |m, start, n| cube(mix_cube_portable, m, start, n)),
    ("mix_cube", |m, start, n| cube(mix_cube, m, start, n)),
    ("mix_nearest", |m, start, n| {
        let [r, g, b] = m.channels.each_ref().map(|channel| &channel[start..start + n]);
        black_box(mix_nearest as MixNearest)(
            &mut m.row[start..start + n],
            r,
            g,
            b,
            DitherPattern::Ordered.thresholds().row(3),
            start,
            32,
            &m.map,
        );
    }),
    ("copy_nearer", |m, start, n| {
        let (depth, bytes) = (&mut m.depth[start..start + n], &m.channels[0][start..start + n]);
        black_box(copy_nearer as Nearer)(&mut m.row[start..start + n], depth, bytes, 1 << 52, 1 << 44);
    }),
    ("copy_nearer_keep_depth", |m, start, n| {
        let (depth, bytes) = (&m.depth[start..start + n], &m.channels[0][start..start + n]);
        black_box(copy_nearer_keep_depth as Before)(&mut m.row[start..start + n], depth, bytes, 1 << 52, 1 << 44);
    }),
    ("quotients", |m, start, n| {
        black_box(fill_quotients as Quotients)(&mut m.row[start..start + n], 13 << 70, 1 << 69, 1 << 70, 1 << 62);
    }),
    ("float", |m, start, n| {
        let (n_dn, d_dd) = ([1e20, 1e17], [1e18, 1e15]);
        black_box(fill_float as Float)(&mut m.row[start..start + n], -3, n_dn, d_dd, [0.0, 255.0]);
    }),
    ("lit", |m, _, n| {
        let (a, da) = ([0.3, -0.5, 0.8, 4.0, -3.0, 9.0], [0.01, 0.02, -0.01, 0.1, 0.05, -0.02]);
        for first in (0..n).step_by(LANES) {
            m.points = black_box(interpolate as Interpolate)(first as u16, &a, &da, 0.4, 0.001);
        }
    }),
];

fn dither(fill: Fill, memory: &mut Memory, start: usize, n: usize) {
    black_box(fill)(&mut memory.row[start..start + n], 0x1234, 0x56, DitherPattern::Ordered.thresholds().row(3), start);
}

fn cube(mix: MixCube, memory: &mut Memory, start: usize, n: usize) {
    let [r, g, b] = memory.channels.each_ref().map(|channel| &channel[start..start + n]);
    black_box(mix)(&mut memory.row[start..start + n], r, g, b, DitherPattern::Ordered.thresholds().row(3), start);
}

fn texels(texture: &[u8]) -> Texels<'_> {
    Texels::new(texture, 8, 8).expect("256 × 256")
}

/// A floor under the eye: the divisor is half again as large after 320 pixels.
fn perspective(fill: Perspective, memory: &mut Memory, start: usize, n: usize) {
    let (d, dd) = (1_i128 << 70, (1_i128 << 61) + 12_345);
    let (u, v) = (0x12_3456 * d + 77, -0x23_4567 * d + 99);
    black_box(fill)(&mut memory.row[start..start + n], texels(&memory.texture), [u, v], [1 << 86, 1 << 85], d, dd);
}

fn main() {
    let mut random = Random::again(13);
    // The low byte.
    let mut bytes = |count: usize| -> Vec<u8> { (0..count).map(|_| random.next_u64() as u8).collect() };
    let mut memory = Memory {
        row: bytes(CAPACITY),
        channels: [bytes(CAPACITY), bytes(CAPACITY), bytes(CAPACITY)],
        // Randomly above and below the depths drawn, so that at first half of the pixels are nearer.
        depth: bytes(CAPACITY).into_iter().map(|byte| u32::from(byte) << 21).collect(),
        points: [[0.0; LANES]; 6],
        texture: bytes(65_536),
        table: bytes(65_536).try_into().expect("as long"),
        map: bytes(32_768).try_into().expect("as long"),
    };
    let rounds = if interleaved::is_bench() { 101 } else { 1 };
    println!("ns per row, median of {rounds} rounds, every round all loops in turn");
    print!("{:>22}", "pixels");
    for length in LENGTHS {
        print!("{length:>9}");
    }
    println!();
    let mut medians = vec![Vec::new(); LOOPS.len()];
    for length in LENGTHS {
        let turns = (400 / length.max(10)).max(2);
        let times = interleaved::times(LOOPS.len(), rounds, |which| {
            for _ in 0..turns {
                batch(LOOPS[which].1, &mut memory, black_box(length));
            }
        });
        for (medians, times) in medians.iter_mut().zip(times) {
            medians.push(interleaved::median(times) * 1e9 / (turns * ROWS) as f64);
        }
    }
    for (i, (name, _)) in LOOPS.iter().enumerate() {
        line(name, &medians[i], 1);
        if i > 0 && LOOPS[i - 1].0 == format!("{name} portable") {
            let ratios: Vec<f64> =
                medians[i - 1].iter().zip(&medians[i]).map(|(portable, vector)| portable / vector).collect();
            line("portable ÷ vector", &ratios, 2);
        }
    }
}

#[inline(never)]
fn batch(draw: Draw, memory: &mut Memory, length: usize) {
    for i in 0..ROWS {
        draw(memory, i * 13 % 64, length);
    }
}

fn line(name: &str, figures: &[f64], digits: usize) {
    print!("{name:>22}");
    for figure in figures {
        print!("{figure:>9.digits$}");
    }
    println!();
}
