//! Batches of triangles: each kernel against the oracle, and against the same triangles drawn one by one.

mod against_the_oracle;
mod shapes;

use std::fmt::Display;

use crate::support::triangles::{drawn, drawn_by_the_oracle, one_by_one, rect, together, triangle, vertex};
use crate::support::tried::Tried;
use against_the_oracle::{batches_against_the_oracle, orders_and_windings};
use mode13h::internals::raster::effects::{Attributes, EffectBatch, EffectFace, PixelPipeline, ShadeSource};
use mode13h::raster::{DepthBuffer, DrawStats, Frame, Interpolation, Raster, Rect, Vertex};
use mode13h::span::Kernel;
use mode13h_conformance::Random;
use mode13h_conformance::oracle;

/// An interpolation with exact cover.
fn interpolation(random: &mut Random) -> Interpolation {
    let interpolated = random.one_of(Interpolation::INTERPOLATED);
    if random.within(0, 3) == 0 || !interpolated.has_exact_cover() {
        return Interpolation::Flat(random.within(0, 255) as u8);
    }
    interpolated
}

/// An interpolation for each triangle, or one for all.
fn interpolations(random: &mut Random) -> impl FnMut(&mut Random) -> Interpolation + use<> {
    let all = (random.within(0, 1) == 0).then(|| interpolation(random));
    move |random| all.unwrap_or_else(|| interpolation(random))
}

/// A triangle of at most `reach` units somewhere in or near the frame; one in four on whole or half pixels.
fn small(random: &mut Random, width: i64, height: i64, reach: i64) -> [Vertex; 3] {
    let (cx, cy) = (random.within(-300, width * 256 + 300), random.within(-300, height * 256 + 300));
    let snap = random.one_of(&[1, 1, 1, 128]);
    // With equal depths the first must stay.
    let level = random.one_of(&[None, None, Some(9), Some(10)]);
    let mut place = || {
        let shade = random.one_of(&[0, 0xFF00, -1, -1, -1]);
        let shade = if shade < 0 { random.within(0, 0xFF00) } else { shade };
        let (x, y) = (cx + random.within(-reach, reach), cy + random.within(-reach, reach));
        vertex(x / snap * snap, y / snap * snap, shade, level.unwrap_or(random.log_uniform(30) as i64))
    };
    [place(), place(), place()]
}

/// From smaller than a pixel to larger than what batches draw themselves, plus the triangles of `support`.
fn any(random: &mut Random, width: i64, height: i64) -> [Vertex; 3] {
    match random.within(0, 9) {
        0 => triangle(random, width, height),
        _ => {
            let reach = random.log_uniform(16) as i64;
            small(random, width, height, reach)
        }
    }
}

/// The result and counts that `on` returns for the portable kernel, one triangle at a time. Every kernel must give the
/// same for all triangles together.
fn drawn_alike<T: PartialEq>(
    triangles: &[([Vertex; 3], Interpolation)],
    about: impl Display,
    on: impl Fn(Kernel, &dyn Fn(&mut Raster<'_>) -> DrawStats) -> (T, DrawStats),
) -> (T, DrawStats) {
    let expected = on(Kernel::PORTABLE, &|raster| one_by_one(raster, triangles));
    for kernel in Kernel::available() {
        let batched = on(kernel, &|raster| together(raster, triangles));
        assert!(batched == expected, "{kernel}, {about}: {:?} and {:?}", batched.1, expected.1);
    }
    expected
}

/// The most triangles in a list, so that some are drawn in two parts.
const MOST: usize = 150;

/// The number of triangles for each kernel, out of `triangles`.
fn per_kernel(triangles: u64) -> u64 {
    triangles * Kernel::available().count() as u64
}

#[test]
fn r4_batches_against_the_oracle() {
    batches_against_the_oracle(Tried::new("r4_batches_against_the_oracle", per_kernel(200_000)));
}

#[test]
fn r6_order_and_winding_make_no_difference_in_batches() {
    orders_and_windings(Tried::new("r6_order_and_winding_make_no_difference_in_batches", 300));
}

#[test]
#[ignore = "the long run: ten million triangles by each kernel"]
fn r4_long_batches_against_the_oracle() {
    batches_against_the_oracle(Tried::new("r4_long_batches_against_the_oracle", per_kernel(10_000_000)));
}

#[test]
fn small_triangles_are_the_oracles_with_every_kernel() {
    const SIDE: u32 = 24;
    let mut random = Random::named("batches against the oracle");
    let mut pixels = 0;
    for _ in 0..20_000 {
        let reach = random.one_of(&[100, 300, 900, 2_000]);
        let vertices = small(&mut random, SIDE.into(), SIDE.into(), reach);
        let interpolation = interpolation(&mut random);
        let expected = drawn_by_the_oracle(&vertices, interpolation, SIDE, SIDE);
        pixels += expected.iter().flatten().count();
        for kernel in Kernel::available() {
            let drawn = drawn(|empty| {
                let mut bytes = vec![empty; (SIDE * SIDE) as usize];
                let frame = Frame::new(&mut bytes, SIDE, SIDE, SIDE as usize).expect("legal");
                together(&mut Raster::new(frame).with_kernel(kernel), &[(vertices, interpolation)]);
                bytes
            });
            assert_eq!(drawn, expected, "{kernel}, {interpolation:?}, {vertices:?}");
        }
    }
    assert!(pixels > 50_000, "{pixels}");
}

/// Two far corners, whose edge goes through pixel centres, and a near one beside it. On the edge the shade is halfway
/// between two bytes, as the quotient of small differences: the planes' terms are up to 2³² times as large.
#[test]
fn perspective_correct_shades_on_far_edges_are_exact() {
    const SIDE: i32 = 200;
    let mut random = Random::named("far edges through pixel centres");
    let mut pixels = 0;
    for _ in 0..4_000 {
        // To either side: the box's first pixel is at a far corner, or away from both.
        let (dx, dy) = (random.within(-7, 7), random.within(1, 7));
        let steps = random.within(1, 25);
        let (x, y) = (128 + 256 * random.within(40, 150), 128 + 256 * random.within(0, 10));
        let along = random.within(0, 256 * steps);
        let beside = random.log_uniform(12) as i64;
        let far = random.log_uniform(4) as i64;
        let shade = 256 * random.within(0, 0xFE) + 128;
        let near = random.one_of(&[0, 0xFF00, shade]);
        let vertices = [
            vertex(x, y, shade, far),
            vertex(x + 256 * dx * steps, y + 256 * dy * steps, shade, far),
            vertex(
                x + dx * along + beside,
                y + dy * along,
                near,
                random.one_of(&[1 << 30, u32::MAX.into()]) - random.log_uniform(20) as i64,
            ),
        ];
        let expected = oracle::pixels(&vertices, Interpolation::GouraudHyperbolic, SIDE, SIDE);
        pixels += expected.len();
        for kernel in Kernel::available() {
            let mut bytes = vec![0; (SIDE * SIDE) as usize];
            let frame = Frame::new(&mut bytes, SIDE as u32, SIDE as u32, SIDE as usize).expect("legal");
            let mut raster = Raster::new(frame).with_kernel(kernel);
            together(&mut raster, &[(vertices, Interpolation::GouraudHyperbolic)]);
            for pixel in &expected {
                assert_eq!(bytes[(pixel.y * SIDE + pixel.x) as usize], pixel.byte, "{kernel}, {pixel:?}, {vertices:?}");
            }
        }
    }
    assert!(pixels > 100_000, "{pixels}");
}

/// Where a test draws.
struct Place {
    width: u32,
    height: u32,
    pitch: usize,
    clip: Option<Rect>,
    band: std::ops::Range<u32>,
    depth: bool,
}

impl Place {
    /// A whole frame without a depth buffer, with `beside` bytes after each row.
    fn whole(width: i64, height: i64, beside: usize) -> Self {
        let (width, height, pitch) = (width as u32, height as u32, width as usize + beside);
        Self { width, height, pitch, clip: None, band: 0..height, depth: false }
    }

    /// Bytes, depths and counts after drawing with `draw`.
    fn drawn(&self, kernel: Kernel, draw: &dyn Fn(&mut Raster<'_>) -> DrawStats) -> ((Vec<u8>, Vec<u32>), DrawStats) {
        let mut bytes = vec![99; self.pitch * (self.band.end - self.band.start) as usize];
        let mut depths = Vec::new();
        let frame = Frame::band(&mut bytes, self.width, self.height, self.pitch, self.band.clone()).expect("legal");
        let mut raster = Raster::new(frame).with_kernel(kernel);
        if let Some(clip) = self.clip {
            raster = raster.with_clip(clip);
        }
        let drawn = draw(&mut if self.depth { raster.with_cleared_depth(&mut depths) } else { raster });
        ((bytes, depths), drawn)
    }

    /// Compares triangles drawn together with the same drawn one by one, and returns the bytes and the counts.
    fn drawn_alike(&self, triangles: &[([Vertex; 3], Interpolation)], about: impl Display) -> (Vec<u8>, DrawStats) {
        let ((bytes, _), drawn) = drawn_alike(triangles, about, |kernel, draw| self.drawn(kernel, draw));
        (bytes, drawn)
    }
}

#[test]
fn batches_draw_what_single_triangles_do() {
    let mut random = Random::named("batches against single triangles");
    let mut total = DrawStats::default();
    for round in 0..600 {
        let (width, height) = random.one_of(&[(320, 200), (97, 40), (9, 300), (1, 1), (700, 3)]);
        let clip = rect(&mut random, width as u32, height as u32);
        let band = rect(&mut random, 1, height as u32 - 1);
        let place = Place {
            clip: (round % 3 == 0).then_some(clip),
            band: if round % 4 == 0 { band.y0..band.y1 + 1 } else { 0..height as u32 },
            depth: round % 2 == 0,
            ..Place::whole(width, height, random.one_of(&[0, 0, 3]))
        };
        let count = random.within(0, MOST as i64);
        let mut interpolation = interpolations(&mut random);
        let triangles: Vec<([Vertex; 3], Interpolation)> =
            (0..count).map(|_| (any(&mut random, width, height), interpolation(&mut random))).collect();
        total += place.drawn_alike(&triangles, format_args!("round {round}")).1;
    }
    assert!(total.pixels > 100_000, "{total:?}");
}

/// Triangles of similar size come in groups with the same orientation: of one row each, of two, of four, of eight and
/// of more. Many overlap, and many lie at the frame's edges, where no pixel follows the last.
#[test]
fn triangles_of_one_size_are_drawn_as_one_by_one() {
    let mut random = Random::named("batches of small triangles of one size");
    let mut total = DrawStats::default();
    for round in 0..600 {
        let (width, height) = random.one_of(&[(40, 30), (17, 9), (9, 40), (64, 64), (130, 5)]);
        let place = Place { depth: round % 3 > 0, ..Place::whole(width, height, random.one_of(&[0, 0, 7])) };
        // Units across and down.
        let (across, down) =
            random.one_of(&[(200, 200), (300, 200), (700, 260), (700, 700), (1_500, 1_500), (3_000, 3_500)]);
        let (across, down) = (across.min(width * 256), down.min(height * 256));
        let level = random.one_of(&[None, None, Some(9)]);
        let some = random.within(1, MOST as i64);
        let count = random.one_of(&[MOST as i64, some]);
        let mut triangles = Vec::new();
        for _ in 0..count {
            let corner = |most: i64, random: &mut Random| {
                let at = random.within(0, most);
                random.one_of(&[at, at, at, 0, most])
            };
            let (left, top) = (corner(width * 256 - across, &mut random), corner(height * 256 - down, &mut random));
            let vertices = [0; 3].map(|_| {
                let (x, y) = (left + random.within(0, across), top + random.within(0, down));
                vertex(x, y, random.within(0, 0xFF00), level.unwrap_or(random.log_uniform(30) as i64))
            });
            let interpolation = interpolation(&mut random);
            triangles.push((vertices, interpolation));
        }
        total += place.drawn_alike(&triangles, format_args!("round {round}")).1;
    }
    assert!(total.tested > 50_000 && total.pixels > 50_000, "{total:?}");
}

/// A corner anywhere in a frame, one coordinate in three at an end, with a depth if there is one.
fn corner(random: &mut Random, width: i64, height: i64, level: Option<i64>) -> Vertex {
    let mut along = |side: i64| {
        let at = random.within(0, side * 256);
        random.one_of(&[at, at, at, at, 0, side * 256])
    };
    let (x, y) = (along(width), along(height));
    let shade = random.within(0, 0xFF00);
    vertex(x, y, random.one_of(&[0, 0xFF00, shade, shade]), level.unwrap_or(random.log_uniform(30) as i64))
}

#[test]
fn triangles_as_large_as_the_frame_are_drawn_as_one_by_one() {
    let mut random = Random::named("batches of large triangles");
    // The largest that batches draw themselves, and slightly larger, in each direction.
    let frames = [(320, 200), (640, 400), (512, 512), (520, 515), (1_024, 256), (1_030, 200), (63, 4_096), (65, 4_096)];
    let mut total = DrawStats::default();
    for round in 0..160 {
        let (width, height) = frames[round % frames.len()];
        let depth = round / frames.len() % 2 == 0;
        let place = Place { depth, ..Place::whole(width, height, random.one_of(&[0, 5])) };
        let mut triangles = Vec::new();
        for _ in 0..random.within(1, 12) {
            let level = random.one_of(&[None, None, Some(9), Some(10)]);
            let vertices = [0; 3].map(|_| corner(&mut random, width, height, level));
            let interpolation = interpolation(&mut random);
            triangles.push((vertices, interpolation));
        }
        total += place.drawn_alike(&triangles, format_args!("round {round}")).1;
    }
    assert!(total.pixels > 10_000_000 && total.tested > 10_000_000, "{total:?}");
}

/// Where f64 set-up runs out of digits: larger triangles are drawn singly.
#[test]
fn r4_large_triangles_of_batches_start_exactly() {
    let mut tried = Tried::new("r4_large_triangles_of_batches_start_exactly", per_kernel(320));
    let mut random = Random::named("exact starts");
    let place = Place::whole(shapes::SIDE, shapes::SIDE, 0);
    // By the number of squares that a batch divides them into.
    let (mut larger, mut smaller) = (0, 0);
    for _ in 0..320 {
        let interpolation = random.one_of(&[Interpolation::Gouraud88, Interpolation::Gouraud88Reseeded]);
        let triangle = (shapes::with_exact_starts(&mut random), interpolation);
        let [columns, rows] = [Vertex::x, Vertex::y].map(|of| {
            let along = triangle.0.each_ref().map(|v| of(v).to_bits());
            (along.iter().max().expect("three") - along.iter().min().expect("three")) / 256
        });
        *if columns * rows > 1 << 18 { &mut larger } else { &mut smaller } += 1;
        let (bytes, _) = place.drawn_alike(&[triangle], format_args!("{triangle:?}"));
        tried.add(per_kernel(1));
        // The bytes of the first pixels of rows, from the oracle.
        let points = triangle.0.each_ref().map(oracle::point);
        let shades = oracle::Shades::of_vertices(&triangle.0, interpolation);
        for y in (0..shapes::SIDE as i32).step_by(61) {
            let covers = |x: &i32| oracle::covers(points, oracle::centre(*x, y));
            if let Some(x) = (0..shapes::SIDE as i32).find(covers) {
                let byte = bytes[(y * shapes::SIDE as i32 + x) as usize];
                assert_eq!(byte, shades.byte((x, x), x, y, None), "({x}, {y}) of {triangle:?}");
            }
        }
    }
    assert!(larger > 60 && smaller > 20, "{larger} are larger than what a batch draws, {smaller} are not");
}

/// A depth buffer for rows other than the frame's: rows that it lacks are not drawn, just as one by one.
#[test]
fn a_batch_keeps_to_the_rows_of_its_depth_buffer() {
    const WIDTH: u32 = 32;
    let mut random = Random::named("batches and other rows' depths");
    let (mut missed, mut written) = (0, 0);
    for (rows, held) in [(0..8, 8..16), (8..16, 0..8), (0..8, 3..11), (3..11, 0..8), (0..8, 0..5), (0..5, 0..8)] {
        for _ in 0..50 {
            let triangles = [(); 50].map(|()| (small(&mut random, WIDTH.into(), 16, 900), interpolation(&mut random)));
            let on = |kernel: Kernel, draw: &dyn Fn(&mut Raster<'_>) -> DrawStats| {
                let (mut bytes, mut depths) = ([99; 8 * WIDTH as usize], [5; 8 * WIDTH as usize]);
                let mut other = bytes;
                let other = Frame::band(&mut other, WIDTH, 16, WIDTH as usize, held.clone()).expect("legal");
                let frame = Frame::band(&mut bytes, WIDTH, 16, WIDTH as usize, rows.clone()).expect("legal");
                let depth = DepthBuffer::new(&mut depths, &other).expect("long enough");
                let drawn = draw(&mut Raster::new(frame).with_kernel(kernel).with_depth(depth));
                ((bytes, depths), drawn)
            };
            let (_, drawn) = drawn_alike(&triangles, format_args!("{rows:?} and {held:?}"), on);
            missed += drawn.covered - drawn.tested;
            written += drawn.pixels;
        }
    }
    assert!(missed > 5_000 && written > 5_000, "{missed} pixels missed, {written} written");
}

/// Lists of which most triangles miss all pixel centres, and then few, and then most again: what is left out early
/// changes nothing, with effects or without.
#[test]
fn tiny_triangles_together_are_those_one_by_one() {
    let mut random = Random::named("tiny triangles");
    let mut covered = 0;
    for reach in [20, 60] {
        let triangles: Vec<_> = (0..3_000)
            .map(|i| {
                let reach = if (1_000..1_300).contains(&i) { 900 } else { reach };
                (small(&mut random, 64, 32, reach), Interpolation::Gouraud88)
            })
            .collect();
        let faces: Vec<EffectFace> =
            triangles.iter().map(|(vertices, _)| (*vertices, [Attributes::default(); 3])).collect();
        let on = |kernel: Kernel, draw: &dyn Fn(&mut Raster<'_>) -> DrawStats| {
            let mut bytes = [0; 64 * 32];
            let frame = Frame::new(&mut bytes, 64, 32, 64).expect("legal");
            let drawn = draw(&mut Raster::new(frame).with_kernel(kernel));
            (bytes, drawn)
        };
        let plain = PixelPipeline { source: ShadeSource::Shaded(Interpolation::Gouraud88), ..PixelPipeline::PLAIN };
        let expected = drawn_alike(&triangles, format_args!("reach {reach}"), on);
        covered += expected.1.covered;
        for kernel in Kernel::available() {
            let effects = |raster: &mut Raster<'_>| raster.faces_with_effects(&faces, &plain, &mut EffectBatch::new());
            assert!(on(kernel, &effects) == expected, "{kernel}, with effects");
            // A batch that is refilled leaves out specks when they are added.
            let refilled = |raster: &mut Raster<'_>| {
                let (mut drawn, mut batch) = (DrawStats::default(), EffectBatch::new());
                for (vertices, attributes) in &faces {
                    if batch.is_full() {
                        drawn += raster.batch_with_effects(&mut batch, &plain);
                    }
                    assert!(batch.push(vertices, attributes));
                }
                drawn += raster.batch_with_effects(&mut batch, &plain);
                drawn
            };
            assert!(on(kernel, &refilled) == expected, "{kernel}, a batch refilled");
        }
    }
    assert!(covered > 1_000, "{covered}");
}
