//! Triangles with effects against a naive oracle, which treats every pixel on its own and every stage by the letter of
//! its definition; and things that must not matter: order, winding, clip rectangle, bands, kernel.

use crate::support::triangles;
use crate::support::tried::Tried;
use mode13h::fixed::{I24F8, U8F8};
use mode13h::internals::lanes::{Lanes, Points};
use mode13h::internals::raster::effects::{
    Attributes, EffectBatch, Limits, Mix, PixelLighting, PixelPipeline, SampleSpacing, ShadeSource, TextureStage,
};
use mode13h::internals::span::channels::{mix_cube_portable, mix_nearest};
use mode13h::internals::span::depth::Cell;
use mode13h::internals::span::dither::{DitherPattern, ThresholdRow};
use mode13h::internals::span::texture::{Levels, Texels};
use mode13h::raster::{DepthBuffer, DrawStats, Frame, Interpolation, Raster, Rect, Vertex};
use mode13h::settings::Mapping;
use mode13h::span::Kernel;
use mode13h_conformance::Random;
use mode13h_conformance::oracle::{self, Point, Ratio};
use num_bigint::BigInt;
use num_traits::Signed;
use std::ops::Range;

const WIDTH: i32 = 150;
const HEIGHT: i32 = 60;
/// What the frame holds before drawing.
const BEFORE: u8 = 77;
/// Padding bytes between its rows.
const BETWEEN: u8 = 0xA5;

/// Columns and rows of a frame, and the bytes from one row to the next.
#[derive(Clone, Copy, Debug)]
struct Size {
    width: i32,
    height: i32,
    pitch: i32,
}

/// The size used in most tests.
const SIZE: Size = Size { width: WIDTH, height: HEIGHT, pitch: WIDTH + 11 };

impl Size {
    /// The usual size or, in one of four cases, low and wide; with any pitch.
    fn any(random: &mut Random) -> Self {
        let (width, height) = random.one_of(&[(WIDTH, HEIGHT), (WIDTH, HEIGHT), (WIDTH, HEIGHT), (1_021, 9)]);
        Self { width, height, pitch: width + random.within(0, 99) as i32 }
    }

    /// Its pixels before drawing.
    fn pixels(self) -> Vec<u8> {
        vec![BEFORE; (self.width * self.height) as usize]
    }

    fn rows(self) -> Range<u32> {
        0..self.height as u32
    }

    fn rect(self) -> Rect {
        Rect { x0: 0, y0: 0, x1: self.width as u32, y1: self.height as u32 }
    }

    /// Runs `draw` on these rows of the frame in `pixels`. Padding between rows must not change.
    fn draw<T>(self, pixels: &mut [u8], rows: Range<u32>, draw: impl FnOnce(Frame<'_>) -> T) -> T {
        let (width, pitch) = (self.width as usize, self.pitch as usize);
        let pixels = &mut pixels[rows.start as usize * width..rows.end as usize * width];
        let mut bytes = vec![BETWEEN; pitch * rows.len()];
        for (row, pixels) in bytes.chunks_mut(pitch).zip(pixels.chunks(width)) {
            row[..width].copy_from_slice(pixels);
        }
        // No more bytes than a frame needs, or whole rows.
        let end = if pitch % 2 == 0 { bytes.len() } else { bytes.len() - (pitch - width) };
        let frame = Frame::band(&mut bytes[..end], self.width as u32, self.height as u32, pitch, rows);
        let drawn = draw(frame.expect("a legal frame"));
        for (row, pixels) in bytes.chunks(pitch).zip(pixels.chunks_mut(width)) {
            pixels.copy_from_slice(&row[..width]);
            assert!(row[width..].iter().all(|byte| *byte == BETWEEN), "a byte between the rows was written");
        }
        drawn
    }
}

/// Random tables and a random image.
struct Stock {
    tables: Vec<Box<[u8; 65_536]>>,
    map: Box<[u8; 32_768]>,
    texels: Vec<u8>,
    /// All levels from 1 on.
    levels: Vec<u8>,
}

impl Stock {
    fn new(random: &mut Random) -> Self {
        let mut bytes = |length: usize| (0..length).map(|_| random.within(0, 255) as u8).collect::<Vec<u8>>();
        let table = |bytes: Vec<u8>| bytes.into_boxed_slice().try_into().expect("64 KiB");
        Self {
            tables: (0..6).map(|_| table(bytes(65_536))).collect(),
            map: bytes(32_768).into_boxed_slice().try_into().expect("32 KiB"),
            texels: bytes(65_536),
            levels: bytes(21_845),
        }
    }
}

/// An image, with smaller copies if there are `levels`, of as many texels as these bits say.
fn texture<'a>(
    texels: &'a [u8],
    levels: Option<&'a [u8]>,
    (ubits, vbits): (u32, u32),
    mapping: Mapping,
    tables: [&'a [u8; 65_536]; 3],
) -> TextureStage<'a> {
    let levels = levels.map(|levels| &levels[..Levels::length(ubits, vbits)]);
    TextureStage {
        texels: Texels::new(&texels[..1 << (ubits + vbits)], ubits, vbits).expect("as many texels"),
        levels: levels.map(|levels| Levels::new(levels, ubits, vbits).expect("as many texels")),
        mapping,
        tables,
    }
}

/// The texels of all levels from 1 on, each the number of its level.
fn level_numbers(ubits: u32, vbits: u32) -> Vec<u8> {
    let texels = |level: u32| 1 << (ubits.saturating_sub(level) + vbits.saturating_sub(level));
    (1..=8_u8).flat_map(|level| vec![level; texels(level.into())]).collect()
}

/// A table that shows texels as they are.
fn texels_alone() -> Box<[u8; 65_536]> {
    (0..=255).flat_map(|_| 0..=255).collect::<Vec<u8>>().try_into().expect("64 KiB")
}

/// Light that is exact in f64: the sum of the first three values, clamped to the range.
#[derive(Debug)]
struct Sum;

impl Sum {
    fn of([a, b, c]: [f32; 3]) -> u16 {
        (a + b + c).clamp(0.0, 65_280.0) as u16
    }
}

impl PixelLighting for Sum {
    fn shades(&self, points: &Points) -> Lanes<u16> {
        core::array::from_fn(|lane| Self::of([0, 1, 2].map(|i| points[i][lane])))
    }

    fn channels(&self, points: &Points) -> [Lanes<u16>; 3] {
        let shades = self.shades(points);
        [0, 1, 2].map(|i| shades.map(|shade| shade >> i))
    }
}

/// Light beyond what a shade may be.
#[derive(Debug)]
struct TooBright;

impl PixelLighting for TooBright {
    fn shades(&self, points: &Points) -> Lanes<u16> {
        core::array::from_fn(|lane| !(points[0][lane].to_bits() as u16 & 0xFF))
    }

    fn channels(&self, points: &Points) -> [Lanes<u16>; 3] {
        [self.shades(points); 3]
    }
}

fn attributes(random: &mut Random) -> [Attributes; 3] {
    core::array::from_fn(|_| {
        let mut shade = || U8F8::from_bits(random.within(0, 0xFF00) as u16);
        let (fog, channels, slope) = (shade(), [shade(), shade(), shade()], [shade(), shade()]);
        let reach = random.log_uniform(31) as i64;
        let texture = core::array::from_fn(|_| random.within(-reach, reach) as i32);
        let lit = core::array::from_fn(|_| random.within(0, 20_000) as f32);
        Attributes { texture, fog, channels, slope, lit }
    })
}

/// Random limits, rarely with the minimum above the maximum; including shades beyond 255, which count as 255.
fn limits(random: &mut Random) -> Limits {
    let [a, b] = [0, 1].map(|_| random.within(0, 0xFFFF) as u16);
    let (least, most) = if random.within(0, 9) == 0 { (a, b) } else { (a.min(b) / 4, a.max(b)) };
    Limits { least: U8F8::from_bits(least), most: U8F8::from_bits(most) }
}

fn look<'a>(random: &mut Random, stock: &'a Stock) -> PixelPipeline<'a> {
    let mut maybe = |n: i64| random.within(0, n) == 0;
    let (channels, dither, has_texture, fog, blend) = (maybe(3), maybe(2), maybe(1), maybe(2), maybe(3));
    let (ubits, vbits) = (random.within(0, 8) as u32, random.within(0, 8) as u32);
    PixelPipeline {
        source: match random.within(0, 10) {
            10 => ShadeSource::Curved([0, 1, 2].map(|_| limits(random))),
            0 => ShadeSource::NormalTable(&stock.tables[0]),
            1 => ShadeSource::Lit(&Sum),
            2 => ShadeSource::LitEvery(random.one_of(&SampleSpacing::ALL), &Sum),
            3 => ShadeSource::Shaded(Interpolation::Flat(random.within(0, 255) as u8)),
            _ => ShadeSource::Shaded(random.one_of(Interpolation::INTERPOLATED)),
        },
        channels: channels.then(|| match random.within(0, 1) {
            0 => Mix::Cube,
            _ => Mix::Nearest { map: &stock.map, spread: random.within(0, 255) as u8 },
        }),
        dither: dither.then(|| random.one_of(&DitherPattern::ALL).thresholds()),
        texture: has_texture.then(|| {
            let levels = (random.within(0, 1) == 0).then_some(&stock.levels[..]);
            let mapping = random.one_of(&[Mapping::Affine, Mapping::Every16, Mapping::Perspective]);
            let tables = [1, 2, 3].map(|i| &*stock.tables[i]);
            texture(&stock.texels, levels, (ubits, vbits), mapping, tables)
        }),
        fog: fog.then_some(&stock.tables[4]),
        blend: blend.then_some(&stock.tables[5]),
        keeps_depth: random.within(0, 1) == 0,
    }
}

/// One triangle, by definition.
struct Naive<'a> {
    size: Size,
    corners: [Point; 3],
    vertices: &'a [Vertex; 3],
    attributes: &'a [Attributes; 3],
    look: &'a PixelPipeline<'a>,
    /// The corners' shades, or each of their channels.
    shades: Vec<oracle::Shades>,
}

impl<'a> Naive<'a> {
    fn new(
        size: Size,
        vertices: &'a [Vertex; 3],
        attributes: &'a [Attributes; 3],
        look: &'a PixelPipeline<'a>,
    ) -> Self {
        // Without shading the channels are linear.
        let interpolation =
            if let ShadeSource::Shaded(interpolation) = look.source { interpolation } else { Interpolation::default() };
        let channels = [0, 1, 2].map(|i| attributes.each_ref().map(|a| a.channels[i].to_bits()));
        let shades = match look.channels {
            Some(_) => channels.map(|values| oracle::Shades::new(vertices, values, interpolation)).into(),
            None => vec![oracle::Shades::of_vertices(vertices, interpolation)],
        };
        Self { size, corners: vertices.each_ref().map(oracle::point), vertices, attributes, look, shades }
    }

    /// A value linear on the screen, in 8.8, without the rounding half: exact at `seed`, then stepped.
    fn linear(&self, values: [u16; 3], seed: i32, x: i32, y: i32) -> i128 {
        let values = values.map(i128::from);
        let exact = oracle::interpolate(self.corners, values, oracle::centre(seed, y));
        let step = oracle::per_pixel(self.corners, values);
        let start = if step.n < 0 { exact.ceil() } else { exact.floor() };
        start + step.truncate() * i128::from(x - seed)
    }

    fn has_area(&self) -> bool {
        oracle::edge(self.corners[0], self.corners[1], self.corners[2]) != 0
    }

    fn depths(&self) -> [i128; 3] {
        self.vertices.each_ref().map(|v| i128::from(v.depth().max(1)))
    }

    /// A value linear on the face.
    fn on_face(&self, values: [i128; 3], x: i32, y: i32) -> Ratio {
        let depths = self.depths();
        let products = [0, 1, 2].map(|i| depths[i] * values[i]);
        let at = oracle::centre(x, y);
        Ratio {
            n: oracle::interpolate(self.corners, products, at).n,
            d: oracle::interpolate(self.corners, depths, at).n,
        }
    }

    /// A shade quadratic on the screen, by definition: in the basis of six functions, each 1 at one of the points and 0
    /// at the others. All are whole numbers over the square of the area.
    fn quadratic(&self, channel: usize, x: i32, y: i32) -> Ratio {
        let weight = |corner: usize| {
            let one = [0, 1, 2].map(|i| i128::from(i == corner));
            oracle::interpolate(self.corners, one, oracle::centre(x, y))
        };
        let [a, b, c] = [weight(0), weight(1), weight(2)];
        let area = a.d;
        let at = |corner: usize, value: usize| self.attributes[corner].lit[value] as i128;
        let own = |corner: usize, weight: Ratio| at(corner, channel) * weight.n * (2 * weight.n - area);
        let between = |opposite: usize, from: Ratio, to: Ratio| 4 * at(opposite, channel + 3) * from.n * to.n;
        let sum = own(0, a) + own(1, b) + own(2, c) + between(0, b, c) + between(1, c, a) + between(2, a, b);
        Ratio { n: sum, d: area * area }
    }

    /// Its byte within the limits. Halfway between two, the even one counts.
    fn quadratic_byte(&self, limits: Limits, channel: usize, (x, y): (i32, i32), threshold: u8, off: i128) -> u8 {
        let exact = self.quadratic(channel, x, y);
        let nearest = Ratio { n: 2 * exact.n + exact.d, d: 2 * exact.d }.floor() + off;
        let [least, most] = [limits.least, limits.most].map(|limit| i128::from(limit.to_bits().min(0xFF00)));
        ((nearest.max(least).min(most) + i128::from(threshold)) >> 8) as u8
    }

    /// The mipmap level at a pixel: from the coordinates' exact derivatives, with the depth in whole sixteenths.
    fn level(&self, mapping: Mapping, last: u32, x: i32, y: i32) -> u32 {
        let depths = if mapping == Mapping::Affine { [1; 3] } else { self.depths() };
        let at = |values: [i128; 3], x, y| oracle::interpolate(self.corners, values, oracle::centre(x, y)).n;
        // By the quotient rule, times the divisor squared.
        let derivative = |of: usize, dx: i32, dy: i32| {
            let products = [0, 1, 2].map(|i| depths[i] * i128::from(self.attributes[i].texture[of]));
            let (n, d) = (at(products, x, y), at(depths, x, y));
            let (dn, dd) = (at(products, x + dx, y + dy) - n, at(depths, x + dx, y + dy) - d);
            (BigInt::from(dn) * d - BigInt::from(n) * dd).abs()
        };
        let length = |dx: i32, dy: i32| -> BigInt {
            let (u, v) = (derivative(0, dx, dy), derivative(1, dx, dy));
            2 * u.clone().max(v.clone()) + u.min(v)
        };
        let doubled = length(1, 0).max(length(0, 1));
        let depth = oracle::interpolate(self.corners, depths, oracle::centre(x, y));
        let sixteenths = Ratio { n: 16 * depth.n, d: depth.d }.floor();
        let square = BigInt::from(sixteenths * depth.d).pow(2);
        // doubled / 2 / (square / 256) / 65,536 is at most 181/128 texels of the level.
        (0..last).find(|level| &doubled * 64 <= ((&square * 181) << level) * 256).unwrap_or(last)
    }

    fn texel(&self, texture: &TextureStage<'_>, seed: i32, last: i32, x: i32, y: i32) -> (u32, u8) {
        let from = seed + (x - seed) / 16 * 16;
        let middle = (from + 8).min(last).max(from);
        let level = texture.levels.map_or(0, |levels| self.level(texture.mapping, levels.last(), middle, y));
        let size = 1 << level;
        let of_level = |exact: Ratio| Ratio { d: exact.d * size, ..exact };
        let [u, v] = [0, 1].map(|i| {
            let values = self.attributes.each_ref().map(|a| i128::from(a.texture[i]));
            let on_face = |x: i32| of_level(self.on_face(values, x, y)).floor();
            match texture.mapping {
                Mapping::Affine => {
                    let exact = of_level(oracle::interpolate(self.corners, values, oracle::centre(seed, y)));
                    let step = of_level(oracle::per_pixel(self.corners, values));
                    let start = if step.n < 0 { exact.ceil() } else { exact.floor() };
                    start + step.truncate() * i128::from(x - seed)
                }
                Mapping::Perspective => on_face(x),
                // `every-16`.
                _ => {
                    let to = (from + 16).min(last).max(from);
                    let (a, b) = (on_face(from), on_face(to));
                    let step = if to == from { 0 } else { (b - a) / i128::from(to - from) };
                    a + step * i128::from(x - from)
                }
            }
        });
        let texels = match texture.levels {
            Some(levels) if level > 0 => levels.get(level).expect("a level"),
            _ => texture.texels,
        };
        let whole = |c: i128, size: usize| c.div_euclid(65_536).rem_euclid(size as i128) as u32 * 65_536;
        (level, texels.at(whole(u, texels.width()), whole(v, texels.height())))
    }

    /// The byte of a pixel in a row whose first and last covered pixels inside the frame are `first` and `last`. `off`
    /// is added, in 1/256 shade, to the lit pixels on either side of it, or to the three channels of a curve.
    fn byte(&self, (first, last): (i32, i32), x: i32, y: i32, before: u8, off: [i128; 3]) -> u8 {
        let seed = first + (x - first) / 64 * 64;
        let threshold = self.look.dither.map_or(128, |thresholds| thresholds.row(y as usize).at(x as usize));
        let lookup = |table: &[u8; 65_536], high: u8, low: u8| table[usize::from(high) << 8 | usize::from(low)];
        let byte_of = |sum: i128, threshold: u8| ((sum + i128::from(threshold)) >> 8) as u8;
        let linear = |value: fn(&Attributes) -> U8F8, threshold: u8| {
            let values = self.attributes.each_ref().map(|a| value(a).to_bits());
            byte_of(self.linear(values, seed, x, y), threshold)
        };
        let sampling = |x: i32, off: i128| {
            // Whole numbers below 2¹⁵ times depths below 2³⁰ times areas: the nearest f64 to the sum is off by a few
            // parts in 2⁵¹, the f32 by one in 2²⁴.
            let point = [0, 1, 2].map(|i| {
                let exact = self.on_face(self.attributes.each_ref().map(|a| a.lit[i] as i128), x, y);
                (exact.n as f64 / exact.d as f64) as f32
            });
            (i128::from(Sum::of(point)) + off).clamp(0, 0xFF00)
        };
        // The channel's shift is added before interpolating between the lit pixels.
        let lit = |shift: usize| match self.look.source {
            ShadeSource::LitEvery(apart, _) => {
                let apart = apart.pixels() as i32;
                let from = seed + (x - seed) / apart * apart;
                let to = (from + apart).min(last).max(from);
                let [a, b] = [(from, off[0]), (to, off[1])].map(|(x, off)| sampling(x, off) >> shift);
                let step = if to == from { 0 } else { (b - a) * 256 / i128::from(to - from) };
                a + (step * i128::from(x - from)).div_euclid(256)
            }
            _ => sampling(x, off[0]) >> shift,
        };
        let textured = self.look.texture.as_ref().map(|texture| (texture, self.texel(texture, seed, last, x, y).1));
        let mut byte = if let Some(mix) = &self.look.channels {
            let mut channels = match self.look.source {
                ShadeSource::Lit(_) | ShadeSource::LitEvery(..) => [0, 1, 2].map(|i| byte_of(lit(i), 128)),
                ShadeSource::Curved(limits) => {
                    [0, 1, 2].map(|i| self.quadratic_byte(limits[i], i, (x, y), 128, off[i]))
                }
                _ => [0, 1, 2].map(|i| self.shades[i].byte((first, last), x, y, None)),
            };
            if let Some((texture, texel)) = textured {
                channels = [0, 1, 2].map(|i| lookup(texture.tables[i], channels[i], texel));
            }
            let ([r, g, b], mut byte) = (channels, [0]);
            match mix {
                Mix::Nearest { map, spread } => {
                    mix_nearest(&mut byte, &[r], &[g], &[b], &ThresholdRow::new(&[threshold]), 0, *spread, map);
                }
                _ => mix_cube_portable(&mut byte, &[r], &[g], &[b], &ThresholdRow::new(&[threshold]), 0),
            }
            byte[0]
        } else {
            let shade = match self.look.source {
                ShadeSource::Shaded(_) => self.shades[0].byte((first, last), x, y, self.look.dither.map(|_| threshold)),
                ShadeSource::NormalTable(table) => {
                    lookup(table, linear(|a| a.slope[1], 128), linear(|a| a.slope[0], 128))
                }
                ShadeSource::Lit(_) | ShadeSource::LitEvery(..) => byte_of(lit(0), threshold),
                ShadeSource::Curved(limits) => self.quadratic_byte(limits[0], 0, (x, y), threshold, off[0]),
                _ => unreachable!("all sources are tried"),
            };
            match textured {
                Some((texture, texel)) => lookup(texture.tables[0], shade, texel),
                None => shade,
            }
        };
        if let Some(table) = self.look.fog {
            byte = lookup(table, linear(|a| a.fog, 128), byte);
        }
        if let Some(table) = self.look.blend {
            byte = lookup(table, byte, before);
        }
        byte
    }

    /// Returns whether a byte may be drawn although the exact one differs, because light is in floating point: it may
    /// if it results when the lit pixels, or the channels of a curve, are off by 1/256 shade, which they may be.
    ///
    /// With ε = 2⁻⁵³, A the triangle's area, V and D its greatest value times depth and its greatest depth:
    ///
    /// 1. A numerator is a sum over the corners of exact weights times values, at the piece's first pixel (3εAV), and k
    ///    times such a sum of the weights' changes. Weights are 0 to A at both pixels, so k times the changes are at
    ///    most 2A in all (4εAV, and εAV for the product with k). With the last sum it is off by less than 11εAV, a
    ///    divisor by 11εAD.
    /// 2. A divisor is at least A. V is at most 20,000 · 2³⁰ and D 2³⁰, so a value is off by less than 22ε · 20,000 ·
    ///    2³⁰, 0.053, and the sum of three by 0.16. In f32 that adds 0.007, and here 0.007 again: less than 1.
    /// 3. A shade on a curve is off by less than 0.1: see `quadratic_shades_are_the_definition`, for values below
    ///    20,000.
    ///
    /// Integers rounded from shades that are off by less than 1 differ by at most 1.
    fn may_be(&self, row: (i32, i32), x: i32, y: i32, byte: u8) -> bool {
        const OFF: [i128; 3] = [-1, 0, 1];
        let off = OFF.iter().flat_map(|a| OFF.iter().flat_map(move |b| OFF.map(|c| [*a, *b, c])));
        !sum_is_exact(self.look) && off.into_iter().any(|off| self.byte(row, x, y, BEFORE, off) == byte)
    }

    /// The first and last covered pixels of a row inside the frame.
    fn row(&self, y: i32) -> Option<(i32, i32)> {
        let covers = |x: &i32| oracle::covers(self.corners, oracle::centre(*x, y));
        let first = (0..self.size.width).find(covers)?;
        // Triangles are convex.
        let last = (first..self.size.width).take_while(covers).last()?;
        Some((first, last))
    }

    /// The frame's bytes, and the first and last covered pixels of each row.
    fn frame(&self) -> (Vec<u8>, Vec<Option<(i32, i32)>>) {
        let mut bytes = self.size.pixels();
        let rows: Vec<_> = (0..self.size.height).map(|y| self.row(y)).collect();
        for (y, row) in (0..).zip(&rows) {
            for x in row.map_or(0..0, |(first, last)| first..last + 1) {
                let row = row.unwrap_or_default();
                bytes[(y * self.size.width + x) as usize] = self.byte(row, x, y, BEFORE, [0; 3]);
            }
        }
        (bytes, rows)
    }
}

/// Draws with the raster.
fn draw(
    size: Size,
    vertices: &[Vertex; 3],
    attributes: &[Attributes; 3],
    look: &PixelPipeline<'_>,
    clip: Option<Rect>,
    kernel: Kernel,
) -> Vec<u8> {
    let mut pixels = size.pixels();
    size.draw(&mut pixels, size.rows(), |frame| {
        let mut raster = Raster::new(frame).with_kernel(kernel).with_clip(clip.unwrap_or(size.rect()));
        raster.triangle_with_effects(vertices, attributes, look);
    });
    pixels
}

/// Draws with the raster in two bands, of which the second begins in row `cut`.
fn draw_in_bands(
    size: Size,
    vertices: &[Vertex; 3],
    attributes: &[Attributes; 3],
    look: &PixelPipeline<'_>,
    cut: u32,
) -> Vec<u8> {
    let mut pixels = size.pixels();
    for rows in [0..cut, cut..size.height as u32] {
        size.draw(&mut pixels, rows, |frame| Raster::new(frame).triangle_with_effects(vertices, attributes, look));
    }
    pixels
}

/// Draws with any kernel and a depth buffer in columns of up to eight pixels, which begin anywhere between two pixels
/// that decide a level. `None` where the buffer hides pixels, which must not change.
fn draw_in_columns(
    random: &mut Random,
    vertices: &[Vertex; 3],
    attributes: &[Attributes; 3],
    look: &PixelPipeline<'_>,
) -> Vec<Option<u8>> {
    let kernels: Vec<Kernel> = Kernel::available().collect();
    let hidden: Vec<bool> = (0..WIDTH * HEIGHT).map(|_| random.within(0, 2) == 0).collect();
    let mut depths: Vec<u32> = hidden.iter().map(|&is_hidden| if is_hidden { u32::MAX } else { 0 }).collect();
    let (mut pixels, mut left, kernel) = (SIZE.pixels(), 0, random.one_of(&kernels));
    while left < WIDTH as u32 {
        let right = (left + random.within(1, 8) as u32).min(WIDTH as u32);
        let clip = Rect { x0: left, x1: right, ..SIZE.rect() };
        // Row by row, in bands that end where the row does.
        for y in SIZE.rows() {
            let depths = &mut depths[y as usize * WIDTH as usize..];
            SIZE.draw(&mut pixels, y..y + 1, |frame| {
                let buffer = DepthBuffer::new(depths, &frame).expect("long enough");
                let mut raster = Raster::new(frame).with_kernel(kernel).with_clip(clip).with_depth(buffer);
                raster.triangle_with_effects(vertices, attributes, look);
            });
        }
        left = right;
    }
    assert!(pixels.iter().zip(&hidden).all(|(&byte, &is_hidden)| !is_hidden || byte == BEFORE), "{vertices:?}");
    pixels.into_iter().zip(hidden).map(|(byte, is_hidden)| (!is_hidden).then_some(byte)).collect()
}

/// Draws into the whole frame with a depth buffer.
fn draw_deep<D: Cell>(
    size: Size,
    depths: &mut [D],
    draw: impl FnOnce(Raster<'_, D>) -> DrawStats,
) -> (Vec<u8>, DrawStats) {
    let mut pixels = size.pixels();
    let drawn = size.draw(&mut pixels, size.rows(), |frame| {
        let buffer = DepthBuffer::new(depths, &frame).expect("long enough");
        draw(Raster::new(frame).with_depth(buffer))
    });
    (pixels, drawn)
}

/// Draws with every kernel, all of which must agree.
fn draw_by_all(vertices: &[Vertex; 3], attributes: &[Attributes; 3], look: &PixelPipeline<'_>) -> Vec<u8> {
    let bytes = draw(SIZE, vertices, attributes, look, None, Kernel::PORTABLE);
    for kernel in Kernel::available() {
        let by_kernel = draw(SIZE, vertices, attributes, look, None, kernel);
        assert!(by_kernel == bytes, "{kernel}: {vertices:?} {attributes:?} {look:?}");
    }
    bytes
}

fn sum_is_exact(look: &PixelPipeline<'_>) -> bool {
    !matches!(look.source, ShadeSource::Lit(_) | ShadeSource::LitEvery(..) | ShadeSource::Curved(_))
}

#[test]
fn triangles_with_effects_are_the_oracles() {
    let mut tried = Tried::new("triangles_with_effects_are_the_oracles", 1500);
    let mut random = Random::named("effects");
    let stock = Stock::new(&mut random);
    let kernels: Vec<Kernel> = Kernel::available().collect();
    let mut pixels = 0_u64;
    while tried.more() {
        let size = Size::any(&mut random);
        let Size { width, height, .. } = size;
        let vertices = triangles::triangle(&mut random, width.into(), height.into());
        let attributes = attributes(&mut random);
        let look = look(&mut random, &stock);
        let naive = Naive::new(size, &vertices, &attributes, &look);
        if !naive.has_area() {
            let bytes = draw(size, &vertices, &attributes, &look, None, kernels[0]);
            assert!(bytes.iter().all(|byte| *byte == BEFORE));
            continue;
        }
        let (expected, rows) = naive.frame();
        let kernel = random.one_of(&kernels);
        let bytes = draw(size, &vertices, &attributes, &look, None, kernel);
        for (place, (is, should)) in bytes.iter().zip(&expected).enumerate() {
            let (x, y) = (place as i32 % width, place as i32 / width);
            let row = rows[y as usize].filter(|(first, last)| (*first..=*last).contains(&x));
            pixels += u64::from(row.is_some());
            assert!(
                is == should || row.is_some_and(|row| naive.may_be(row, x, y, *is)),
                "({x}, {y}) of {size:?}: {is}, not {should}, by {kernel}: {vertices:?}, {attributes:?}, {look:?}"
            );
        }
        // R6: whatever the order of the corners.
        let [a, b, c] = vertices;
        let [p, q, r] = attributes;
        for (vertices, attributes) in [([b, c, a], [q, r, p]), ([b, a, c], [q, p, r]), ([c, b, a], [r, q, p])] {
            assert_eq!(draw(size, &vertices, &attributes, &look, None, kernels[0]), bytes, "{vertices:?}");
        }
        // R8: a clip rectangle changes no byte inside it.
        let (x, y) = (random.within(0, width.into()) as u32, random.within(0, height.into()) as u32);
        let clip = Rect { x0: x / 2, y0: y / 2, x1: x, y1: y };
        let clipped = draw(size, &vertices, &attributes, &look, Some(clip), kernels[0]);
        let mut inside = bytes.clone();
        triangles::clip_to(&mut inside, width as u32, clip, BEFORE);
        assert_eq!(clipped, inside, "in {clip:?}");
        // R9: bands change nothing.
        let cut = random.within(1, i64::from(height) - 1) as u32;
        let banded = draw_in_bands(size, &vertices, &attributes, &look, cut);
        assert_eq!(banded, bytes, "bands from row {cut} of {size:?}: {vertices:?}, {attributes:?}, {look:?}");
    }
    assert!(pixels > 300_000, "{pixels} pixels were compared");
}

/// A texture whose coordinates are whole numbers of texels at every pixel, or 1/65,536 more or less: what rounding turns
/// into the neighbouring texel first, in levels of the image, too. By the loops that draw a span at once, with every kernel.
#[test]
fn texels_at_their_borders_are_the_oracles() {
    let mut tried = Tried::new("texels_at_their_borders_are_the_oracles", 400);
    let mut random = Random::named("borders");
    let stock = Stock::new(&mut random);
    let mut pixels = 0;
    while tried.more() {
        let distance = random.within(1, 1 << 30) as u32;
        let mut vertices = triangles::triangle(&mut random, WIDTH.into(), HEIGHT.into());
        if random.within(0, 2) == 0 {
            // Too large for set-up in vectors: its rows are walked.
            let band = i64::from(Vertex::GUARD_BAND);
            vertices = vertices.map(|v| {
                let [x, y] = [0; 2].map(|_| random.within(-band, band));
                triangles::vertex(x, y, v.shade().to_bits().into(), 0)
            });
        }
        let vertices = vertices.map(|v| Vertex::new(v.x(), v.y(), v.shade(), distance).expect("the same place"));
        let mut attributes = attributes(&mut random);
        for i in 0..2 {
            let [across, down] = [0, 1].map(|_| random.within(-3, 3));
            let first = random.within(-300, 300) * 65_536 + random.within(-1, 1);
            for (vertex, of) in vertices.iter().zip(&mut attributes) {
                let from_centre = |at: I24F8| i64::from(at.to_bits() - 128) * 256;
                let texture = first + across * from_centre(vertex.x()) + down * from_centre(vertex.y());
                of.texture[i] = texture.try_into().expect("within the guard band");
            }
        }
        let bits = random.within(0, 8) as u32;
        let levels = (random.within(0, 1) == 0).then_some(&stock.texels[..]);
        let mapping = random.one_of(&[Mapping::Perspective, Mapping::Perspective, Mapping::Affine]);
        let look = PixelPipeline {
            source: ShadeSource::Shaded(Interpolation::Gouraud88Reseeded),
            texture: Some(texture(&stock.texels, levels, (bits, 8), mapping, [&stock.tables[0]; 3])),
            ..PixelPipeline::PLAIN
        };
        let naive = Naive::new(SIZE, &vertices, &attributes, &look);
        if !naive.has_area() {
            continue;
        }
        let (expected, rows) = naive.frame();
        pixels += rows.iter().flatten().map(|(first, last)| last + 1 - first).sum::<i32>();
        for kernel in Kernel::available() {
            let bytes = draw(SIZE, &vertices, &attributes, &look, None, kernel);
            assert_eq!(bytes, expected, "{kernel}: {vertices:?}, {attributes:?}, {look:?}");
        }
    }
    assert!(pixels > 50_000, "{pixels} pixels were compared");
}

/// A clip rectangle of at most eight columns leaves rows of a few pixels, which are drawn two at a time and begin after
/// skipped ones: no byte inside it changes. Textures of both mappings, lit or not, in all columns, with every kernel.
#[test]
fn narrow_clip_rectangles_change_no_byte_inside() {
    let mut tried = Tried::new("narrow_clip_rectangles_change_no_byte_inside", 200);
    let mut random = Random::named("narrow");
    let stock = Stock::new(&mut random);
    let mut pixels = 0;
    while tried.more() {
        let vertices = triangles::triangle(&mut random, WIDTH.into(), HEIGHT.into());
        let distances = [0; 3].map(|_| random.within(1 << 20, 1 << 24) as u32);
        let vertices = [0, 1, 2].map(|k| {
            let v = &vertices[k];
            Vertex::new(v.x(), v.y(), v.shade(), distances[k]).expect("the same place")
        });
        let attributes = attributes(&mut random);
        let look = PixelPipeline {
            source: ShadeSource::Shaded(random.one_of(&[Interpolation::Gouraud88Reseeded, Interpolation::Flat(77)])),
            texture: Some(texture(
                &stock.texels,
                None,
                (8, 8),
                random.one_of(&[Mapping::Perspective, Mapping::Affine]),
                [&stock.tables[0]; 3],
            )),
            ..PixelPipeline::PLAIN
        };
        for kernel in Kernel::available() {
            let bytes = draw(SIZE, &vertices, &attributes, &look, None, kernel);
            let mut left = 0;
            while left < WIDTH as u32 {
                let right = (left + random.within(1, 8) as u32).min(WIDTH as u32);
                let clip = Rect { x0: left, x1: right, ..SIZE.rect() };
                let clipped = draw(SIZE, &vertices, &attributes, &look, Some(clip), kernel);
                let mut inside = bytes.clone();
                triangles::clip_to(&mut inside, WIDTH as u32, clip, BEFORE);
                assert_eq!(clipped, inside, "{kernel} in {clip:?}: {vertices:?}, {attributes:?}, {look:?}");
                pixels += clipped.iter().filter(|byte| **byte != BEFORE).count();
                left = right;
            }
        }
    }
    assert!(pixels > 100_000, "{pixels} pixels were compared");
}

/// A face without any effect has exactly the bytes of a plain triangle: whatever interpolates its shades, and its
/// channels one by one; whole or within a clip rectangle; with every kernel.
#[test]
fn without_effects_faces_are_plain_triangles() {
    let mut tried = Tried::new("without_effects_faces_are_plain_triangles", 3_000);
    let mut random = Random::named("plain");
    let kernels: Vec<Kernel> = Kernel::available().collect();
    let mut long = 0;
    while tried.more() {
        // Including reseeded spans.
        let wide = Size { width: 1_021, height: 40, pitch: 1_030 };
        let size = if random.within(0, 1) == 0 { wide } else { Size::any(&mut random) };
        let vertices = triangles::triangle(&mut random, size.width.into(), size.height.into());
        // The sources' interpolation covers other pixels.
        let exact = Interpolation::INTERPOLATED.iter().filter(|of| **of != Interpolation::GouraudVintage);
        let mut exact: Vec<Interpolation> = exact.copied().collect();
        exact.push(Interpolation::Flat(random.within(0, 255) as u8));
        let interpolation = random.one_of(&exact);
        let kernel = random.one_of(&kernels);
        let clip =
            (random.within(0, 2) == 0).then(|| triangles::rect(&mut random, size.width as u32, size.height as u32));
        let mut plain = size.pixels();
        let mut drawn = DrawStats::default();
        size.draw(&mut plain, size.rows(), |frame| {
            let mut raster = Raster::new(frame).with_kernel(kernel).with_clip(clip.unwrap_or(size.rect()));
            drawn = raster.triangle(&vertices, interpolation);
        });
        long += u32::from(drawn.pixels > 64 * drawn.spans.max(1) / 2);
        let shaded = PixelPipeline { source: ShadeSource::Shaded(interpolation), ..PixelPipeline::PLAIN };
        let attributes = vertices.map(|vertex| Attributes { channels: [vertex.shade(); 3], ..Attributes::default() });
        assert!(draw(size, &vertices, &attributes, &shaded, clip, kernel) == plain, "{kernel}: {interpolation:?}");
        if !matches!(interpolation, Interpolation::Flat(_)) {
            let channel = PixelPipeline { channels: Some(Mix::Only(random.within(0, 2) as usize)), ..shaded };
            assert!(draw(size, &vertices, &attributes, &channel, clip, kernel) == plain, "{kernel}: {interpolation:?}");
        }
        tried.add(1);
    }
    assert!(long > 50, "{long} with long spans");
}

/// In f32, faces too tall for sums of 64 bits are drawn like the others: alone, together, and through a pipeline.
#[test]
fn tall_faces_in_f32_are_those_alone() {
    let mut tried = Tried::new("tall_faces_in_f32_are_those_alone", 300);
    let mut random = Random::named("tall");
    let size = Size { width: 60, height: 4_000, pitch: 60 };
    let interpolation = Interpolation::GouraudFloat;
    let kernels: Vec<Kernel> = Kernel::available().collect();
    let pipeline = PixelPipeline { source: ShadeSource::Shaded(interpolation), ..PixelPipeline::PLAIN };
    let channel = PixelPipeline { channels: Some(Mix::Only(0)), ..pipeline };
    while tried.more() {
        let vertices = [0, 1, 2].map(|_| {
            let (x, y) = (random.within(0, 60 * 256), random.within(0, 4_000 * 256));
            triangles::vertex(x, y, random.within(0x8000, 0xFF00), random.within(1 << 29, 1 << 30))
        });
        let attributes = vertices.map(|vertex| Attributes { channels: [vertex.shade(); 3], ..Attributes::default() });
        let kernel = random.one_of(&kernels);
        let [alone, together] = [false, true].map(|together| {
            let mut pixels = size.pixels();
            size.draw(&mut pixels, size.rows(), |frame| {
                let mut raster = Raster::new(frame).with_kernel(kernel);
                match together {
                    false => raster.triangle(&vertices, interpolation),
                    true => raster.triangles([(&vertices, interpolation)]),
                }
            });
            pixels
        });
        assert!(together == alone, "{kernel}: {vertices:?}");
        for pipeline in [&pipeline, &channel] {
            assert!(draw(size, &vertices, &attributes, pipeline, None, kernel) == alone, "{kernel}: {vertices:?}");
        }
        tried.add(1);
    }
}

/// A look without what needs stages, so that one loop shows its texels.
fn fused(look: PixelPipeline<'_>) -> PixelPipeline<'_> {
    let source = match look.source {
        ShadeSource::Shaded(Interpolation::Flat(_) | Interpolation::Gouraud88) => look.source,
        _ => ShadeSource::Shaded(Interpolation::Gouraud88Reseeded),
    };
    let texture = look.texture.map(|stage| TextureStage { levels: None, ..stage });
    PixelPipeline { source, channels: None, dither: None, texture, ..look }
}

/// With a depth buffer a pixel is drawn where it is nearer, and the depth is stored if the look says so.
#[test]
fn effects_keep_to_the_depth_buffer() {
    let mut tried = Tried::new("effects_keep_to_the_depth_buffer", 400);
    let mut random = Random::named("effects, depth");
    let stock = Stock::new(&mut random);
    let kernels: Vec<Kernel> = Kernel::available().collect();
    while tried.more() {
        let vertices = triangles::triangle(&mut random, WIDTH.into(), HEIGHT.into());
        let attributes = attributes(&mut random);
        let look = match random.within(0, 1) {
            0 => look(&mut random, &stock),
            _ => fused(look(&mut random, &stock)),
        };
        let whole = draw(SIZE, &vertices, &attributes, &look, None, Kernel::PORTABLE);
        let corners = vertices.each_ref().map(oracle::point);
        let has_area = oracle::edge(corners[0], corners[1], corners[2]) != 0;
        let mut before: Vec<u32> = (0..WIDTH * HEIGHT).map(|_| random.log_uniform(30) as u32).collect();
        // Runs that hide everything, so that whole blocks of a span are skipped.
        let mut rest = &mut before[..];
        while !rest.is_empty() {
            let run = rest.len().min(random.within(1, 40) as usize);
            let (hidden, behind) = rest.split_at_mut(run);
            if random.within(0, 1) == 0 {
                hidden.fill(u32::MAX);
            }
            rest = behind;
        }
        let kernel = random.one_of(&kernels);
        let mut depths = before.clone();
        let (bytes, drawn) = draw_deep(SIZE, &mut depths, |raster| {
            raster.with_kernel(kernel).triangle_with_effects(&vertices, &attributes, &look)
        });
        let mut written = 0;
        for y in 0..HEIGHT {
            for x in 0..WIDTH {
                let place = (y * WIDTH + x) as usize;
                let covered = has_area && oracle::covers(corners, oracle::centre(x, y));
                let depth = if covered { oracle::depth_at(&vertices, x, y) } else { 0 };
                let nearer = covered && depth > before[place];
                written += u32::from(nearer);
                assert_eq!(bytes[place], if nearer { whole[place] } else { BEFORE }, "({x}, {y}) of {vertices:?}");
                let kept = if nearer && look.keeps_depth { depth } else { before[place] };
                assert_eq!(depths[place], kept, "({x}, {y}) of {vertices:?}");
            }
        }
        assert_eq!((drawn.pixels, drawn.tested), (written, drawn.covered));
    }
}

/// In any order of the corners, with either kind of depth buffer.
#[test]
fn r6_order_and_winding_make_no_difference_with_effects() {
    let mut tried = Tried::new("r6_order_and_winding_make_no_difference_with_effects", 400);
    let mut random = Random::named("r6 effects");
    let stock = Stock::new(&mut random);
    let size = (WIDTH * HEIGHT) as usize;
    let mut pixels = 0;
    while tried.more() {
        let vertices = triangles::triangle(&mut random, WIDTH.into(), HEIGHT.into());
        let attributes = attributes(&mut random);
        let look = look(&mut random, &stock);
        let before: Vec<u32> = (0..size).map(|_| random.log_uniform(30) as u32).collect();
        let on = |order: [usize; 3]| {
            let (vertices, attributes) = (order.map(|i| vertices[i]), order.map(|i| attributes[i]));
            let (mut wide, mut narrow) = (before.clone(), before.iter().map(|&d| u16::of_depth(d)).collect::<Vec<_>>());
            let on_wide =
                draw_deep(SIZE, &mut wide, |mut raster| raster.triangle_with_effects(&vertices, &attributes, &look));
            let on_narrow =
                draw_deep(SIZE, &mut narrow, |mut raster| raster.triangle_with_effects(&vertices, &attributes, &look));
            (on_wide, on_narrow, wide, narrow)
        };
        let expected = on([0, 1, 2]);
        for order in [[0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            assert!(on(order) == expected, "{order:?} of {vertices:?}, {attributes:?}, {look:?}");
        }
        pixels += expected.0.1.pixels;
    }
    assert!(pixels > 30_000, "{pixels} pixels");
}

/// Faces of one pipeline in a batch get the bytes, depths and counts of each face drawn alone, row by row. What several
/// pieces share (stages, light for pixels of several faces, the list's end in the middle of a face) changes nothing.
#[test]
fn effects_in_batches_are_those_row_by_row() {
    let mut tried = Tried::new("effects_in_batches_are_those_row_by_row", 1_500);
    let mut random = Random::named("effects, batches");
    let stock = Stock::new(&mut random);
    let kernels: Vec<Kernel> = Kernel::available().collect();
    let before: Vec<u32> = (0..WIDTH * HEIGHT).map(|_| random.log_uniform(30) as u32).collect();
    let (mut pixels, mut many) = (0, 0);
    let mut batch = EffectBatch::new();
    while tried.more() {
        // Up to 9 pixels across, some of them over the frame's edges and some with many rows; or of any size.
        let count = random.one_of(&[1, 3, 20, EffectBatch::CAPACITY]);
        let (kind, high) = (random.within(0, 2), random.one_of(&[3, 9, 40]));
        let size = Size { pitch: WIDTH + random.within(11, 12) as i32, ..SIZE };
        // All over the frame, or tiny, on the same few pixels, and of similar depths.
        let is_crowd = kind > 0 && random.within(0, 1) == 0;
        let [right, bottom, wide, high] = if is_crowd { [8, 2, 4, 2] } else { [WIDTH.into(), HEIGHT.into(), 9, high] };
        // A crowd is in the first corner of the frame or in the last.
        let is_last = is_crowd && random.within(0, 1) == 0;
        let [x0, y0] = if is_last { [WIDTH - 8, HEIGHT - 2].map(i64::from) } else { [0, 0] };
        let faces: Vec<_> = (0..count)
            .map(|_| {
                let (left, top) = (x0 + random.within(-4, right), y0 + random.within(-4, bottom));
                let small = [0; 3].map(|_| {
                    let (x, y) = (left * 256 + random.within(0, wide * 256), top * 256 + random.within(0, high * 256));
                    let shade = random.within(0, 0xFF00);
                    let depth = if is_crowd { 50_000 + random.within(0, 9_999) } else { random.log_uniform(30) as i64 };
                    triangles::vertex(x, y, shade, depth)
                });
                let vertices =
                    if kind == 0 { triangles::triangle(&mut random, WIDTH.into(), HEIGHT.into()) } else { small };
                (vertices, attributes(&mut random))
            })
            .collect();
        let look = if is_crowd {
            loop {
                let look = fused(look(&mut random, &stock));
                if look.texture.is_some() {
                    break look;
                }
            }
        } else if random.within(0, 1) == 0 {
            look(&mut random, &stock)
        } else {
            PixelPipeline { source: ShadeSource::Lit(&Sum), ..PixelPipeline::PLAIN }
        };
        let (x, y) = (random.within(0, right) as u32, random.within(0, bottom) as u32);
        let (left, top) = (x0 as u32, y0 as u32);
        let clip = random.one_of(&[SIZE.rect(), Rect { x0: left + x / 2, y0: top + y / 2, x1: left + x, y1: top + y }]);
        let (has_depth, kernel) = (random.within(0, 1) == 0, random.one_of(&kernels));
        let draw = |draw: &mut dyn FnMut(&mut Raster<'_>) -> DrawStats| {
            let (mut depths, mut bytes) = (before.clone(), size.pixels());
            let drawn = size.draw(&mut bytes, size.rows(), |frame| {
                let buffer = DepthBuffer::new(&mut depths, &frame).expect("long enough");
                let raster = Raster::new(frame).with_kernel(kernel).with_clip(clip);
                draw(&mut if has_depth { raster.with_depth(buffer) } else { raster })
            });
            (drawn, bytes, depths)
        };
        let mut room = true;
        let (drawn, bytes, depths) = draw(&mut |raster| {
            room = faces.iter().all(|(vertices, attributes)| batch.push(vertices, attributes));
            // One too many is refused, and changes nothing. Faces without a pixel centre may take no room.
            let is_full = batch.is_full();
            room &= !is_full || count == EffectBatch::CAPACITY;
            room &= !is_full || !batch.push(&faces[0].0, &faces[0].1);
            raster.batch_with_effects(&mut batch, &look)
        });
        assert!(room && !batch.is_full());
        let by_rows = draw(&mut |_| DrawStats::default());
        let (mut sum, mut expected, mut expected_depths) = by_rows;
        for (vertices, attributes) in &faces {
            for y in clip.y0..clip.y1 {
                let row = Rect { y0: y, y1: y + 1, ..clip };
                sum += size.draw(&mut expected, y..y + 1, |frame| {
                    let first = y as usize * WIDTH as usize;
                    let buffer = DepthBuffer::new(&mut expected_depths[first..], &frame).expect("long enough");
                    let raster = Raster::new(frame).with_kernel(kernel).with_clip(row);
                    let mut raster = if has_depth { raster.with_depth(buffer) } else { raster };
                    raster.triangle_with_effects(vertices, attributes, &look)
                });
            }
        }
        assert_eq!(drawn, sum, "{faces:?}, {look:?}, {clip:?}");
        assert!(bytes == expected && depths == expected_depths, "{faces:?}, {look:?}, {clip:?}, {has_depth}");
        pixels += u64::from(drawn.pixels);
        many += u64::from(drawn.spans > 64);
    }
    assert!(pixels > 200_000, "{pixels} pixels");
    assert!(many > 200, "{many} lists were full");
}

/// Shades of either sign, including ones too large to show, on triangles of every kind: each byte is that of the exact
/// number or of one within the error of f32, and all kernels agree.
#[test]
fn quadratic_shades_are_the_definition() {
    let mut tried = Tried::new("quadratic_shades_are_the_definition", 3_000);
    let mut random = Random::named("quadratic shades");
    let (mut pixels, mut held) = (0_u64, 0_u64);
    while tried.more() {
        let vertices = triangles::triangle(&mut random, WIDTH.into(), HEIGHT.into());
        let reach = 1 << random.within(4, 17);
        let mut attributes = attributes(&mut random);
        for corner in &mut attributes {
            corner.lit = core::array::from_fn(|_| random.within(-reach, reach) as f32);
        }
        let (channel, limits) = (random.within(0, 2) as usize, [0, 1, 2].map(|_| limits(&mut random)));
        let channels = (random.within(0, 1) == 0).then_some(Mix::Only(channel));
        let channel = if channels.is_some() { channel } else { 0 };
        let look = PixelPipeline { source: ShadeSource::Curved(limits), channels, ..PixelPipeline::PLAIN };
        let naive = Naive::new(SIZE, &vertices, &attributes, &look);
        let bytes = draw_by_all(&vertices, &attributes, &look);
        if !naive.has_area() {
            continue;
        }
        // Six terms of up to 8 · 5/3 of the greatest shade, each off by 2^-24 of it, and rounding to whole numbers by a
        // half, which the exact byte has, too.
        let off = (f64::from(1_i32 << 17) * 8.0 * 5.0 / 3.0 * 6.0 / f64::from(1 << 24)).max(0.01);
        let [least, most] = [limits[channel].least, limits[channel].most].map(|of| f64::from(of.to_bits().min(0xFF00)));
        for (place, byte) in bytes.iter().enumerate() {
            let (x, y) = (place as i32 % WIDTH, place as i32 / WIDTH);
            if !oracle::covers(naive.corners, oracle::centre(x, y)) {
                assert_eq!(*byte, BEFORE);
                continue;
            }
            let exact = naive.quadratic(channel, x, y);
            let exact = exact.n as f64 / exact.d as f64;
            let end = |value: f64| (((value.max(least).min(most)).round() as i64 + 128) >> 8) as u8;
            let (low, high) = (end(exact - off), end(exact + off));
            assert!(
                (low..=high).contains(byte),
                "({x}, {y}): {byte}, not {low} to {high} for {exact}: {vertices:?}, {attributes:?}, {look:?}"
            );
            pixels += 1;
            held += u64::from(exact < least || exact > most);
        }
    }
    assert!(pixels > 300_000 && held > 30_000, "{pixels} pixels, {held} held");
}

/// NaN, and values too large or too small to compute with: bytes stay within the limits, and every kernel agrees.
#[test]
fn quadratic_shades_of_any_numbers_stay_within() {
    let mut tried = Tried::new("quadratic_shades_of_any_numbers_stay_within", 1_000);
    let mut random = Random::named("quadratic shades of anything");
    let odd = [f32::MAX, f32::MIN, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, 1e-40, -0.0, 65_280.0, -1.0, 1e10];
    while tried.more() {
        let vertices = triangles::triangle(&mut random, WIDTH.into(), HEIGHT.into());
        let mut attributes = attributes(&mut random);
        attributes.iter_mut().flat_map(|corner| &mut corner.lit).for_each(|lit| {
            if random.within(0, 2) > 0 {
                *lit = random.one_of(&odd);
            }
        });
        let limits = limits(&mut random);
        let look = PixelPipeline { source: ShadeSource::Curved([limits; 3]), ..PixelPipeline::PLAIN };
        let bytes = draw_by_all(&vertices, &attributes, &look);
        let corners = vertices.each_ref().map(oracle::point);
        let [least, most] =
            [limits.least, limits.most].map(|of| ((u32::from(of.to_bits().min(0xFF00)) + 128) >> 8) as u8);
        for (place, byte) in bytes.iter().enumerate() {
            let at = oracle::centre(place as i32 % WIDTH, place as i32 / WIDTH);
            if oracle::covers(corners, at) {
                assert!(
                    (least.min(most)..=most).contains(byte),
                    "{byte} in {least} to {most}: {vertices:?}, {attributes:?}"
                );
            }
        }
    }
}

/// Corners with any numbers: those above 0xFF00 count as 0xFF00, and with whatever coordinates and points every kernel
/// draws the same.
#[test]
fn corners_of_any_numbers_draw_the_same_with_every_kernel() {
    let mut tried = Tried::new("corners_of_any_numbers_draw_the_same_with_every_kernel", 1_000);
    let mut random = Random::named("corners of anything");
    let stock = Stock::new(&mut random);
    let kernels: Vec<Kernel> = Kernel::available().collect();
    let mut beyond = 0;
    while tried.more() {
        let vertices = triangles::triangle(&mut random, WIDTH.into(), HEIGHT.into());
        let any = [(); 3].map(|()| {
            let mut bits = || if random.within(0, 3) == 0 { u64::MAX } else { random.next_u64() };
            let mut shade = || U8F8::from_bits(bits() as u16);
            let (fog, channels, slope) = (shade(), [shade(), shade(), shade()], [shade(), shade()]);
            let texture = [bits() as i32, if bits() == u64::MAX { i32::MIN } else { i32::MAX }];
            Attributes { texture, fog, channels, slope, lit: [(); 6].map(|()| f32::from_bits(bits() as u32)) }
        });
        let in_range = any.map(|corner| {
            let least = |shade: U8F8| shade.min(U8F8::from_bits(0xFF00));
            let [fog, channels, slope] =
                [[corner.fog; 3], corner.channels, [corner.slope[0], corner.slope[1], corner.fog]]
                    .map(|shades| shades.map(least));
            Attributes { fog: fog[0], channels, slope: [slope[0], slope[1]], ..corner }
        });
        beyond += usize::from(any.iter().zip(&in_range).any(|(any, in_range)| any.channels != in_range.channels));
        let mut look = look(&mut random, &stock);
        match &mut look.source {
            ShadeSource::Lit(light) | ShadeSource::LitEvery(_, light) if random.within(0, 1) == 0 => {
                *light = &TooBright
            }
            _ => {}
        }
        let expected = draw(SIZE, &vertices, &in_range, &look, None, kernels[0]);
        for kernel in &kernels {
            let bytes = draw(SIZE, &vertices, &any, &look, None, *kernel);
            assert!(bytes == expected, "{kernel}: {vertices:?}, {any:?}, {look:?}");
        }
    }
    assert!(beyond > 500, "{beyond} beyond the range");
}

/// Every level is chosen for many pixels with every mapping: texels are the numbers of their levels, and each agrees
/// with the oracle, with every kernel, whole, in bands or in columns.
#[test]
fn levels_are_the_definition() {
    let mut tried = Tried::new("levels_are_the_definition", 600);
    let mut random = Random::named("levels");
    let (ubits, vbits) = (8_u32, 7_u32);
    let zeros = vec![0; 1 << (ubits + vbits)];
    let (numbers, table) = (level_numbers(ubits, vbits), texels_alone());
    let mappings = [Mapping::Affine, Mapping::Every16, Mapping::Perspective];
    let mut pixels = [[0_u32; 9]; 3];
    while tried.more() {
        let vertices = triangles::triangle(&mut random, WIDTH.into(), HEIGHT.into());
        let reach = 1 << random.within(20, 30);
        let attributes = [0; 3].map(|_| Attributes {
            texture: [0; 2].map(|_| random.within(-reach, reach) as i32),
            ..Attributes::default()
        });
        let i = random.within(0, 2) as usize;
        let texture = texture(&zeros, Some(&numbers), (ubits, vbits), mappings[i], [&table; 3]);
        let look = PixelPipeline { texture: Some(texture), ..PixelPipeline::PLAIN };
        let naive = Naive::new(SIZE, &vertices, &attributes, &look);
        if !naive.has_area() {
            continue;
        }
        let bytes = draw_by_all(&vertices, &attributes, &look);
        let cut = random.within(1, i64::from(HEIGHT) - 1) as u32;
        let bands = draw_in_bands(SIZE, &vertices, &attributes, &look, cut);
        assert_eq!(bands, bytes, "{vertices:?}, in bands");
        let columns = draw_in_columns(&mut random, &vertices, &attributes, &look);
        assert!(
            columns.iter().zip(&bytes).all(|(shown, byte)| shown.is_none_or(|shown| shown == *byte)),
            "{vertices:?}"
        );
        for y in 0..HEIGHT {
            let Some((first, last)) = naive.row(y) else { continue };
            for x in first..=last {
                let (level, _) = naive.texel(&texture, first + (x - first) / 64 * 64, last, x, y);
                let is = bytes[(y * WIDTH + x) as usize];
                assert_eq!(u32::from(is), level, "({x}, {y}): {vertices:?}, {attributes:?}, {:?}", mappings[i]);
                pixels[i][level as usize] += 1;
            }
        }
    }
    assert!(pixels.iter().flatten().all(|&count| count > 0), "{pixels:?}");
}

/// The level serves its purpose: from the pixel it was chosen for to the next in either direction, coordinates are at
/// most √2 texels of the level apart, as an exact length, and the level before would not do, apart from the 12 % by
/// which a length may be overestimated. On triangles that face the eye, whose coordinates change uniformly.
#[test]
fn a_level_is_the_least_whose_texels_are_as_large_as_pixels() {
    let mut tried = Tried::new("a_level_is_the_least_whose_texels_are_as_large_as_pixels", 2_000);
    let mut random = Random::named("levels, lengths");
    let (zeros, numbers, table) = (vec![0; 65_536], level_numbers(8, 8), texels_alone());
    let depth = 1 << 20;
    let vertices = [(0, 0), (40 * 256, 0), (0, 40 * 256)].map(|(x, y)| triangles::vertex(x, y, 0, depth));
    while tried.more() {
        let mapping = random.one_of(&[Mapping::Affine, Mapping::Every16, Mapping::Perspective]);
        // Texels per pixel, a rotation of the image, and a shear.
        let reach = 0.05 * 2_f64.powf(13.0 * random.unit());
        let [across, down] = [0, 1].map(|_| {
            let (sin, cos) = (6.3 * random.unit()).sin_cos();
            [reach * cos, reach * random.unit() * sin]
        });
        let corner = |part: f64, step: [f64; 2]| step.map(|texels| (40.0 * part * texels * 65_536.0).round() as i32);
        let attributes = [[0; 2], corner(1.0, across), corner(1.0, down)]
            .map(|texture| Attributes { texture, ..Attributes::default() });
        let look = PixelPipeline {
            texture: Some(texture(&zeros, Some(&numbers), (8, 8), mapping, [&table; 3])),
            ..PixelPipeline::PLAIN
        };
        let level = draw(SIZE, &vertices, &attributes, &look, None, Kernel::PORTABLE)[0];
        let longest = across[0].hypot(across[1]).max(down[0].hypot(down[1]));
        // 181/128 is √2 to 1 part in 10⁴; coordinates are rounded to a part in 2²¹ of a texel per pixel.
        let (most, slack) = (std::f64::consts::SQRT_2 * f64::from(1 << level), 1.001);
        assert!(level == 8 || longest <= most * slack, "{longest} texels to a pixel, level {level}");
        assert!(level == 0 || 1.119 * longest * slack > most / 2.0, "{longest} texels to a pixel, level {level}");
    }
}
