//! Hidden surfaces in the raster: depth buffer against scan-line, byte for byte, on all kinds of input; depth order
//! against exact planes. Whole scenes are in `hidden_scenes.rs`.

use crate::support::triangles::{one_by_one, rect, triangle, vertex};
use crate::support::tried::Tried;
use mode13h::fixed::U8F8;
use mode13h::internals::raster::scan_line::Lists;
use mode13h::raster::{DepthBuffer, DepthMemory, DrawStats, Frame, Interpolation, Raster, Rect, Vertex};
use mode13h::span::Kernel;
use mode13h_conformance::Random;
use mode13h_conformance::oracle;

type Face = ([Vertex; 3], Interpolation);

/// A frame drawn with one method, and what the raster counted.
#[derive(Clone, Copy)]
struct Sheet {
    width: u32,
    height: u32,
    clip: Rect,
    /// Rows per band.
    rows_each: u32,
}

impl Sheet {
    const EMPTY: u8 = 3;

    fn new(width: u32, height: u32) -> Self {
        Self { width, height, clip: Rect { x0: 0, y0: 0, x1: width, y1: height }, rows_each: height }
    }

    fn draw(self, mut paint: impl FnMut(Raster<'_>) -> DrawStats) -> (Vec<u8>, DrawStats) {
        // Padding between the rows, and bytes after them, must not change.
        let pitch = self.width as usize + 3;
        let mut bytes = vec![Self::EMPTY; pitch * self.height as usize];
        let mut drawn = DrawStats::default();
        let mut frame = Frame::new(&mut bytes, self.width, self.height, pitch).expect("legal");
        for band in frame.bands(self.rows_each) {
            drawn += paint(Raster::new(band).with_clip(self.clip));
        }
        for row in bytes.chunks(pitch) {
            assert_eq!(row[self.width as usize..], [Self::EMPTY; 3], "bytes between the rows stay");
        }
        (bytes, drawn)
    }

    fn depth_buffer(self, faces: &[Face]) -> (Vec<u8>, DrawStats) {
        let mut depths: Vec<u32> = Vec::new();
        self.draw(|raster| one_by_one(&mut raster.with_cleared_depth(&mut depths), faces))
    }

    fn scan_line(self, lists: &mut Lists, faces: &[Face]) -> (Vec<u8>, DrawStats) {
        self.draw(|mut raster| raster.scan_line(faces, lists))
    }
}

/// Checks both methods, whole, clipped and in bands.
fn check(tried: &mut Tried, random: &mut Random, lists: &mut Lists, (width, height): (u32, u32), faces: &[Face]) {
    let whole = Sheet::new(width, height);
    let clip = rect(random, width, height);
    let rows_each = random.within(1, height.into()) as u32;
    for sheet in [whole, Sheet { clip, ..whole }, Sheet { rows_each, ..whole }, Sheet { clip, rows_each, ..whole }] {
        let (by_depth, depth_drawn) = sheet.depth_buffer(faces);
        let (by_line, line_drawn) = sheet.scan_line(lists, faces);
        let differ = by_depth.iter().zip(&by_line).filter(|(one, other)| one != other).count();
        tried.worst("bytes that differ", differ as f64);
        if differ > 0 {
            let (sheet, faces) = shrink(sheet, lists, faces);
            let at =
                sheet.depth_buffer(&faces).0.iter().zip(&sheet.scan_line(lists, &faces).0).position(|(a, b)| a != b);
            panic!(
                "byte {at:?}, {} × {}, {:?}, bands of {}: {faces:?}",
                sheet.width, sheet.height, sheet.clip, sheet.rows_each
            );
        }
        assert_eq!(line_drawn.covered, depth_drawn.covered);
        // Each pixel once: those for which the depth buffer holds something.
        let mut depths: Vec<u32> = Vec::new();
        let mut shown = 0;
        sheet.draw(|raster| {
            let drawn = one_by_one(&mut raster.with_cleared_depth(&mut depths), faces);
            shown += depths.iter().filter(|depth| **depth > 0).count();
            drawn
        });
        let twice = (line_drawn.pixels as usize).abs_diff(shown);
        tried.worst("double pixels of the scan-line", twice as f64);
        assert_eq!(twice, 0, "each pixel is written once");
    }
}

/// The smallest case that still fails, found by removing one face after another.
fn shrink(sheet: Sheet, lists: &mut Lists, faces: &[Face]) -> (Sheet, Vec<Face>) {
    let mut faces = faces.to_vec();
    let mut i = 0;
    while i < faces.len() {
        let mut fewer = faces.clone();
        fewer.remove(i);
        if sheet.depth_buffer(&fewer).0 == sheet.scan_line(lists, &fewer).0 {
            i += 1;
        } else {
            faces = fewer;
        }
    }
    (sheet, faces)
}

fn with_depths(vertices: [Vertex; 3], mut depth: impl FnMut() -> i64) -> [Vertex; 3] {
    vertices.map(|v| vertex(v.x().to_bits().into(), v.y().to_bits().into(), v.shade().to_bits().into(), depth()))
}

fn soups(mut tried: Tried) {
    let mut random = Random::named("d soups");
    let mut lists = Lists::default();
    while tried.more() {
        let (width, height) = random.one_of(&[(96, 24), (200, 40), (17, 60), (320, 20), (1, 9), (70, 1)]);
        let mut faces: Vec<Face> = Vec::new();
        // Depths of all sizes; few and close together, so that many are equal; the greatest ones; one for all.
        let kind = random.within(0, 4);
        for _ in 0..random.log_uniform(7) {
            let mut vertices = triangle(&mut random, width.into(), height.into());
            match kind {
                0 => {}
                1 => vertices = with_depths(vertices, || random.within(0, 4)),
                2 => vertices = with_depths(vertices, || random.one_of(&[0, 1, 0xFFFF_FFFF, 0xFFFF_FFFE, 1 << 30])),
                3 => vertices = with_depths(vertices, || 1000 + random.log_uniform(5) as i64),
                _ => vertices = with_depths(vertices, || 7),
            }
            let flat = random.one_of(&[Interpolation::Flat(0), Interpolation::Flat(200)]);
            // The scan-line method gives every face exact cover.
            let interpolation = Some(random.one_of(Interpolation::INTERPOLATED))
                .filter(|interpolation| interpolation.has_exact_cover());
            let interpolation = if random.within(0, 2) == 0 { flat } else { interpolation.unwrap_or_default() };
            faces.push((vertices, interpolation));
            if random.within(0, 5) == 0 {
                // Again, with the opposite winding and other shades.
                let [a, b, c] = vertices.map(|v| v.with_shade(U8F8::from(77)));
                faces.push((random.one_of(&[[a, b, c], [c, b, a]]), interpolation));
            }
        }
        check(&mut tried, &mut random, &mut lists, (width, height), &faces);
    }
}

#[test]
fn d2_soups() {
    soups(Tried::new("d2_soups", 1500));
}

#[test]
#[ignore = "the long run: 300,000 soups"]
fn d2_long_soups() {
    soups(Tried::new("d2_long_soups", 300_000));
}

/// Frames that share a depth memory are those drawn with cleared depths, whatever was drawn before them, one by one and
/// as lists, from the nearest depth to the farthest, also where sizes change.
#[test]
fn a_depth_memory_is_as_good_as_cleared() {
    let mut random = Random::named("depth memory");
    for kernel in Kernel::available() {
        let mut memory = DepthMemory::new();
        let mut cleared: Vec<u32> = Vec::new();
        let mut size = (97, 60);
        for number in 0..300 {
            if random.within(0, 9) == 0 {
                size = random.one_of(&[(97, 60), (60, 97), (33, 20), (640, 480)]);
            }
            // A frame may be far behind the one before it.
            let depths = random.one_of(&[(1, 1), (1, 40), (1, 1 << 30), ((1 << 30) - 40, 1 << 30), (1 << 30, 1 << 30)]);
            let faces: Vec<[Vertex; 3]> = (0..random.within(0, 12))
                .map(|_| {
                    let vertices = triangle(&mut random, size.0.into(), size.1.into());
                    vertices.map(|vertex| vertex.with_depth(random.within(depths.0, depths.1) as u32))
                })
                .collect();
            let exact = |shading: &Interpolation| shading.has_exact_cover();
            let interpolation = Some(random.one_of(Interpolation::INTERPOLATED)).filter(exact).unwrap_or_default();
            let as_list = random.within(0, 1) == 0;
            let draw = |mut raster: Raster<'_>| {
                if as_list {
                    return raster.triangles(faces.iter().map(|face| (face, interpolation)));
                }
                one_by_one(&mut raster, &faces.iter().map(|face| (*face, interpolation)).collect::<Vec<_>>())
            };
            let sheet = Sheet::new(size.0, size.1);
            let shared = sheet.draw(|raster| draw(raster.with_kernel(kernel).with_depth_memory(&mut memory)));
            let alone = sheet.draw(|raster| draw(raster.with_kernel(kernel).with_cleared_depth(&mut cleared)));
            assert!(shared == alone, "frame {number}, {kernel}, {size:?}, {depths:?}, {interpolation:?}");
        }
    }
}

// Depth order against exact planes.

const WIDTH: u32 = 96;
const HEIGHT: u32 = 24;
const SHEET: (u32, u32) = (WIDTH, HEIGHT);

/// A corner: x and y in 1/256 pixel, and near / w in units of 10⁻⁸, from 10⁴ (far) to 10⁸ (near).
type Corner = (i64, i64, i64);
const NEAR: i64 = 100_000_000;
const FAR: i64 = 10_000;

fn face(corners: [Corner; 3], index: u8) -> Face {
    // round(2³⁰ · near / w).
    let depth = |m: i64| ((m << 31) + NEAR) / (2 * NEAR);
    (corners.map(|(x, y, m)| vertex(x, y, 0, depth(m))), Interpolation::Flat(index))
}

/// Draws the faces with indices 10, 11 … with a depth buffer and by scan-line. Where a face's plane is in front of
/// another's by more than 2⁻¹⁴ of the greater depth, the other must not be seen. Returns the number of pairs decided
/// that way, and the picture.
fn check_order(lists: &mut Lists, corners: &[[Corner; 3]]) -> (u64, Vec<u8>) {
    let faces: Vec<Face> = corners.iter().zip(10..).map(|(corners, index)| face(*corners, index)).collect();
    let sheet = Sheet::new(SHEET.0, SHEET.1);
    let (picture, _) = sheet.depth_buffer(&faces);
    assert_eq!(sheet.scan_line(lists, &faces).0, picture, "{corners:?}");
    let mut decided = 0;
    for y in 0..HEIGHT as i32 {
        for x in 0..WIDTH as i32 {
            let centre = oracle::centre(x, y);
            let depth = |corners: &[Corner; 3]| {
                let points = corners.map(|(x, y, _)| (i128::from(x), i128::from(y)));
                oracle::covers(points, centre)
                    .then(|| oracle::interpolate(points, corners.map(|(_, _, m)| i128::from(m)), centre))
            };
            let seen = picture[y as usize * (WIDTH as usize + 3) + x as usize];
            let Some(seen) = corners.get(usize::from(seen).wrapping_sub(10)) else {
                assert!(corners.iter().all(|corners| depth(corners).is_none()), "({x}, {y}) of {corners:?}");
                continue;
            };
            let front = depth(seen).expect("a face is seen where it is");
            for other in corners.iter().filter_map(depth) {
                // Over the common denominator.
                let (front, other) = (front.n * other.d, other.n * front.d);
                let apart = (front - other).abs() << 14 > front.max(other);
                assert!(!apart || front > other, "({x}, {y}) of {corners:?}");
                decided += u64::from(apart);
            }
        }
    }
    (decided, picture)
}

fn flat_place(random: &mut Random) -> (i64, i64) {
    (random.within(-2000, i64::from(WIDTH) * 256 + 2000), random.within(-2000, i64::from(HEIGHT) * 256 + 2000))
}

/// From far to near, all magnitudes equally likely.
fn inverse_w(random: &mut Random) -> i64 {
    ((FAR as f64 * (NEAR as f64 / FAR as f64).powf(random.unit())) as i64).clamp(FAR, NEAR)
}

#[test]
fn c3_near_to_far_is_1_to_10_000() {
    let mut tried = Tried::new("c3_near_to_far_is_1_to_10_000", 400);
    let mut random = Random::named("c3");
    let mut lists = Lists::default();
    let mut decided = 0;
    while tried.more() {
        let mut corners = Vec::new();
        for _ in 0..3 {
            let triangle = [(); 3].map(|()| {
                let (x, y) = flat_place(&mut random);
                (x, y, inverse_w(&mut random))
            });
            corners.push(triangle);
            // The same again, barely nearer or farther: by twice the bound, and by half of it.
            let share = random.one_of(&[1 << 10, 1 << 12, 1 << 13, 1 << 15]);
            let sign = random.one_of(&[1, -1]);
            corners.push(triangle.map(|(x, y, m)| (x, y, (m + sign * m / share).clamp(FAR / 2, NEAR))));
        }
        decided += check_order(&mut lists, &corners).0;
    }
    assert!(decided > 100_000, "{decided}");
}

/// Three long faces, each above the next at one end and below the third at the other.
fn circle(random: &mut Random) -> [[Corner; 3]; 3] {
    let (x, y) = (random.within(0, 4000), random.within(0, 300));
    let (far, near) = (random.within(FAR, 3 * FAR), random.within(40 * FAR, 300 * FAR));
    // The corners of a triangle; each face extends from beyond one to beyond the next.
    let corners = [(6_000 + x, 300 + y), (16_000 + x, 2_500 + y), (5_000 + x, 5_300 + y)];
    [0, 1, 2].map(|i| {
        let (from, to) = (corners[i], corners[(i + 1) % 3]);
        let along = (to.0 - from.0, to.1 - from.1);
        let (start, end) = ((from.0 - along.0 / 3, from.1 - along.1 / 3), (to.0 + along.0 / 3, to.1 + along.1 / 3));
        let across = (-along.1 / 5, along.0 / 5);
        [
            (start.0 - across.0, start.1 - across.1, far),
            (start.0 + across.0, start.1 + across.1, far),
            (end.0, end.1, near),
        ]
    })
}

#[test]
fn d1_three_faces_in_a_circle() {
    let mut tried = Tried::new("d1_three_faces_in_a_circle", 100);
    let mut random = Random::named("d1");
    let mut lists = Lists::default();
    let mut decided = 0;
    while tried.more() {
        let mut corners = circle(&mut random);
        if random.within(0, 1) == 0 {
            corners.reverse();
        }
        let (pairs, right) = check_order(&mut lists, &corners);
        decided += pairs;
        // No painting order is right without a depth for every pixel.
        for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let faces = order.map(|i| face(corners[i], 10 + i as u8));
            let (painted, _) = Sheet::new(SHEET.0, SHEET.1).draw(|mut raster| one_by_one(&mut raster, &faces));
            assert_ne!(painted, right, "{order:?} of {corners:?}");
        }
    }
    assert!(decided > 1000, "{decided}");
}

#[test]
fn d2_faces_that_pass_through_each_other() {
    let mut tried = Tried::new("d2_faces_that_pass_through_each_other", 300);
    let mut random = Random::named("d2");
    let mut lists = Lists::default();
    let mut both = 0;
    while tried.more() {
        let mut corners = Vec::new();
        // Two faces over nearly the same area, of which one is nearer on one side and the other on the other.
        let ground = [(); 3].map(|()| flat_place(&mut random));
        let (a, b) = (inverse_w(&mut random), inverse_w(&mut random));
        for m in [[a, b, (a + b) / 2], [b, a, (a + b) / 2]] {
            corners.push([0, 1, 2].map(|i| {
                let (x, y) = ground[i];
                (x + random.within(-300, 300), y + random.within(-300, 300), m[i])
            }));
        }
        let (_, picture) = check_order(&mut lists, &corners);
        both += u32::from([10, 11].iter().all(|index| picture.contains(index)));
    }
    assert!(both > 100, "both faces are seen in {both} of them");
}

#[test]
fn d3_the_first_submitted_of_equals_wins() {
    let mut tried = Tried::new("d3_the_first_submitted_of_equals_wins", 600);
    let mut random = Random::named("d3");
    let mut lists = Lists::default();
    let sheet = Sheet::new(SHEET.0, SHEET.1);
    let mut pixels = 0;
    while tried.more() {
        let [a, b, c] = triangle(&mut random, WIDTH.into(), HEIGHT.into());
        // The same three vertices, and triangles with a single constant depth.
        let constant = random.within(1, u32::MAX.into());
        let of_one_depth = |v: [Vertex; 3]| with_depths(v, || constant);
        let mut other = || of_one_depth(triangle(&mut random, WIDTH.into(), HEIGHT.into()));
        let constants = [other(), other(), other()];
        for triangles in [[[a, b, c], [c, a, b], [b, a, c]], constants] {
            let faces: Vec<Face> =
                triangles.iter().zip(10..).map(|(v, index)| (*v, Interpolation::Flat(index))).collect();
            // Drawn from last to first without depths, so the first is on top.
            let reversed: Vec<Face> = faces.iter().rev().copied().collect();
            let (right, _) = sheet.draw(|mut raster| one_by_one(&mut raster, &reversed));
            assert_eq!(sheet.depth_buffer(&faces).0, right, "{faces:?}");
            assert_eq!(sheet.scan_line(&mut lists, &faces).0, right, "{faces:?}");
            let (narrow, _) =
                sheet.draw(|raster| one_by_one(&mut raster.with_cleared_depth(&mut Vec::<u16>::new()), &faces));
            assert_eq!(narrow, right, "u16 cells, {faces:?}");
            pixels += right.iter().filter(|byte| **byte >= 10).count();
        }
        // Other faces in one plane: the depth is a whole number at every vertex, the same function of the position.
        // Rounding decides which wins; it is the same in both.
        let (dx, dy) = (random.within(-9, 9), random.within(-9, 9));
        let soup: Vec<Face> = (0..6)
            .map(|index| {
                let v = triangle(&mut random, WIDTH.into(), HEIGHT.into()).map(|v| {
                    let (x, y) = (i64::from(v.x().to_bits()), i64::from(v.y().to_bits()));
                    vertex(x, y, 0, (1 << 26) + dx * x + dy * y)
                });
                (v, Interpolation::Flat(10 + index))
            })
            .collect();
        assert_eq!(sheet.depth_buffer(&soup).0, sheet.scan_line(&mut lists, &soup).0, "{soup:?}");
    }
    assert!(pixels > 10_000, "{pixels}");
}

#[test]
fn d_u16_cells_hold_the_upper_bits_rounded_up() {
    let mut tried = Tried::new("d_u16_cells_hold_the_upper_bits_rounded_up", 500);
    let mut random = Random::named("d u16");
    let (width, height) = (WIDTH as i32, HEIGHT as i32);
    let mut ties = 0;
    while tried.more() {
        let near = random.one_of(&[1 << 14, 1 << 20, 1 << 30, u32::MAX.into()]);
        let faces: Vec<Face> = (0..8)
            .map(|_| {
                let vertices = triangle(&mut random, width.into(), height.into());
                (with_depths(vertices, || random.within(0, near)), Interpolation::Gouraud88Reseeded)
            })
            .collect();
        let (mut bytes, mut cells) = (vec![0; (WIDTH * HEIGHT) as usize], vec![0_u128; (WIDTH * HEIGHT) as usize]);
        for (vertices, _) in &faces {
            for oracle::Pixel { x, y, byte } in
                oracle::pixels(vertices, Interpolation::Gouraud88Reseeded, width, height)
            {
                let place = (y * width + x) as usize;
                let cell = u128::from(oracle::depth_at(vertices, x, y)).div_ceil(16_384).min(65_535);
                if cell > cells[place] {
                    (cells[place], bytes[place]) = (cell, byte);
                } else {
                    ties += u32::from(cell == cells[place] && cell > 0);
                }
            }
        }
        let (mut drawn, mut depths) = (vec![0; bytes.len()], vec![9_u16; bytes.len()]);
        let frame = Frame::new(&mut drawn, WIDTH, HEIGHT, WIDTH as usize).expect("legal");
        let mut depth = DepthBuffer::new(&mut depths, &frame).expect("long enough");
        depth.clear();
        one_by_one(&mut Raster::new(frame).with_depth(depth), &faces);
        assert_eq!(drawn, bytes, "{faces:?}");
        assert!(depths.iter().zip(&cells).all(|(is, should)| u128::from(*is) == *should), "{faces:?}");
    }
    assert!(ties > 1000, "{ties}");
}
