//! Single triangles against the oracle: cover, range, shades, clip rectangles, bands, depth.

use crate::support::triangles::{
    clip_to, draw, drawn, drawn_by_the_oracle, edge_beside, one_by_one, rect, together, triangle, vertex,
};
use crate::support::tried::Tried;
use mode13h::fixed::{I24F8, U8F8};
use mode13h::internals::raster::reference::cover::SortedTriangle;
use mode13h::internals::raster::reference::depth::DepthPlane;
use mode13h::raster::{DepthBuffer, DrawStats, Frame, Interpolation, Raster, RasterError, Rect, Vertex};
use mode13h::span::Kernel;
use mode13h_conformance::Random;
use mode13h_conformance::oracle;

const WIDTH: u32 = 96;
const HEIGHT: u32 = 24;

/// The shadings with exact cover, and the report's name for the largest error of their bytes.
const EXACT: &[(Interpolation, &str)] = &[
    (Interpolation::Gouraud88, "shades off in gouraud-8.8"),
    (Interpolation::Gouraud88Reseeded, "in gouraud-8.8-reseeded"),
    (Interpolation::Gouraud1616, "in gouraud-16.16"),
    (Interpolation::GouraudHyperbolic, "in gouraud-hyperbolic"),
    #[cfg(feature = "alloc")]
    (Interpolation::GouraudFloat, "in float"),
];

/// All shadings.
fn interpolations() -> impl Iterator<Item = Interpolation> {
    Interpolation::INTERPOLATED.iter().copied().chain([Interpolation::Flat(9)])
}

#[test]
fn every_shading_with_exact_cover_is_looked_at() {
    let exact: Vec<Interpolation> =
        Interpolation::INTERPOLATED.iter().copied().filter(|interpolation| interpolation.has_exact_cover()).collect();
    assert_eq!(EXACT.iter().map(|(interpolation, _)| *interpolation).collect::<Vec<_>>(), exact);
    let mut names: Vec<&str> = interpolations().map(Interpolation::name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), Interpolation::INTERPOLATED.len() + 1, "each has a name of its own");
}

/// Checks the cover, bytes, range and error of one triangle. Returns the number of pixels it covers.
fn check(vertices: &[Vertex; 3]) -> u32 {
    measure(vertices, WIDTH, HEIGHT).covered
}

/// Measurements of one triangle.
#[derive(Default)]
struct Measured {
    covered: u32,
    /// Bytes that differ from the definition, or are not drawn where it draws.
    differ: u32,
    /// Largest difference from the exact shade, for each of `EXACT`.
    off: Vec<f64>,
}

impl Measured {
    fn report(&self, tried: &mut Tried) {
        tried.worst("bytes that differ", f64::from(self.differ));
        for ((_, measure), off) in EXACT.iter().zip(&self.off) {
            tried.worst(measure, *off);
        }
    }
}

/// Measures cover, bytes, range and error of one triangle with all shadings with exact cover, and flat.
fn measure(vertices: &[Vertex; 3], width: u32, height: u32) -> Measured {
    let shades = vertices.each_ref().map(|v| i128::from(v.shade().to_bits()));
    let (low, high) = (*shades.iter().min().expect("three"), *shades.iter().max().expect("three"));
    let mut measured = Measured { off: vec![0.0; EXACT.len()], ..Measured::default() };
    for ((interpolation, _), worst) in EXACT.iter().copied().zip(&mut measured.off) {
        let expected = drawn_by_the_oracle(vertices, interpolation, width, height);
        let (bound_n, bound_d) = oracle::bound(interpolation, width.into()).expect("a bound");
        let drawn = drawn(|empty| draw(vertices, interpolation, width, height, None, empty));
        measured.covered = 0;
        for y in 0..height as usize {
            for x in 0..width as usize {
                let place = y * width as usize + x;
                measured.differ += u32::from(drawn[place] != expected[place]);
                assert_eq!(drawn[place], expected[place], "{interpolation:?} at ({x}, {y}) of {vertices:?}");
                let Some(byte) = drawn[place].map(i128::from) else { continue };
                measured.covered += 1;
                assert!((low + 128) >> 8 <= byte && byte <= (high + 128) >> 8, "range at ({x}, {y}) of {vertices:?}");
                let exact = oracle::exact_shade(vertices, interpolation, oracle::centre(x as i32, y as i32));
                assert!(
                    exact.is_within(byte * 256, bound_n, bound_d),
                    "{interpolation:?}, error at ({x}, {y}) of {vertices:?}"
                );
                // Rounded only in the quotient.
                *worst = worst.max((exact.n - byte * 256 * exact.d).abs() as f64 / exact.d as f64 / 256.0);
            }
        }
    }
    let flat = draw(vertices, Interpolation::Flat(7), width, height, None, 0);
    assert_eq!(flat.iter().filter(|&&byte| byte == 7).count() as u32, measured.covered, "flat covers the same");
    measured
}

#[test]
fn r1_zero_area_draws_nothing() {
    let mut tried = Tried::new("r1_zero_area_draws_nothing", 2000);
    let mut random = Random::named("r1");
    while tried.more() {
        let (x, y) = (random.within(-500, 30_000), random.within(-500, 8_000));
        let (dx, dy) = (random.within(-40, 40), random.within(-40, 40));
        let at = |k: i64| vertex(x + k * dx, y + k * dy, 0x8000, 5);
        let k = random.within(-100, 100);
        for vertices in [[at(0), at(1), at(k)], [at(k), at(0), at(0)], [at(0), at(0), at(0)]] {
            assert_eq!(check(&vertices), 0, "{vertices:?}");
        }
    }
}

/// A sliver a hundred pixels long and at most 1/256 pixel wide that covers this pixel, and the change of its shades
/// from one pixel to the next.
fn sliver_through(random: &mut Random, (x, y): (i64, i64)) -> Option<([Vertex; 3], oracle::Ratio)> {
    let turn = random.unit() * std::f64::consts::TAU;
    let along = ((turn.cos() * 25_600.0) as i64, (turn.sin() * 25_600.0) as i64);
    let centre = (x * 256 + 128, y * 256 + 128);
    let side = random.one_of(&[-1, 1]);
    let [a, b] = edge_beside(centre, along, side);
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    if dx.pow(2) + dy.pow(2) < 25_000_i64.pow(2) {
        return None;
    }
    // The third corner is up to this many times as far from the edge as the centre; 25,600 times is one unit.
    let times = random.log_uniform(14) as i64 + 1;
    // And it lies between the edge's ends.
    let part = -(times * ((centre.0 - a.0) * dx + (centre.1 - a.1) * dy)).div_euclid(dx.pow(2) + dy.pow(2));
    let c = (a.0 + (centre.0 - a.0) * times + part * dx, a.1 + (centre.1 - a.1) * times + part * dy);
    let shades = random.one_of(&[[0, 0, 0xFF00], [0xFF00, 0xFF00, 0], [0, 0xFF00, 0x1234], [0x00FF, 0, 0xFF00]]);
    let depths = [random.log_uniform(30) as i64, 2, 3];
    let vertices = [0, 1, 2].map(|i| vertex([a, b, c][i].0, [a, b, c][i].1, shades[i], depths[i]));
    let points = vertices.each_ref().map(oracle::point);
    oracle::covers(points, oracle::centre(x as i32, y as i32))
        .then(|| (vertices, oracle::per_pixel(points, shades.map(i128::from))))
}

#[test]
fn r2_slivers() {
    let mut tried = Tried::new("r2_slivers", 1_000);
    let mut random = Random::named("r2");
    let (mut beyond, mut most) = (0, 0);
    while tried.stated() > beyond {
        let pixel = (random.within(0, i64::from(WIDTH) - 1), random.within(0, i64::from(HEIGHT) - 1));
        let Some((vertices, slope)) = sliver_through(&mut random, pixel) else { continue };
        let covered = check(&vertices);
        // So thin a sliver covers the one pixel, and rarely others.
        assert!(covered >= 1, "{pixel:?} of {vertices:?}");
        most = most.max(covered);
        // A change in 16.16, whose integer part has 16 bits including the sign: 2¹⁵ shades, 2²³ of their 256ths.
        let is_beyond = slope.n.abs() >= slope.d << 23;
        beyond += u64::from(is_beyond);
        tried.add(u64::from(is_beyond));
        tried.worst("shades a pixel", slope.n.abs() as f64 / slope.d as f64 / 256.0);
    }
    tried.worst("pixels of a sliver", most.into());
    assert!(most > 1, "{most} pixels of a sliver at most");
}

#[test]
fn r3_smaller_than_a_pixel() {
    let mut tried = Tried::new("r3_smaller_than_a_pixel", 3000);
    let mut random = Random::named("r3");
    let mut drawn = 0;
    while tried.more() {
        let (x, y) = (random.within(0, 20_000), random.within(0, 5_000));
        let mut corner = || vertex(x + random.within(0, 255), y + random.within(0, 255), random.within(0, 0xFF00), 9);
        let vertices = [corner(), corner(), corner()];
        let pixels = check(&vertices);
        assert!(pixels <= 1, "{vertices:?}");
        drawn += pixels;
    }
    assert!(drawn > 100, "some held a centre: {drawn}");
}

#[test]
fn r4_every_sixteenth_of_a_pixel() {
    let mut tried = Tried::new("r4_every_sixteenth_of_a_pixel", 256 * 12);
    let mut random = Random::named("r4");
    for place in 0..256 {
        for corner in 0..3 {
            for _ in 0..4 {
                // The other corners are on centres, so that edges pass through centres too.
                let mut corners =
                    [(0, 0); 3].map(|_| (random.within(0, 40) * 256 + 128, random.within(0, 20) * 256 + 128));
                let (x, y) = (random.within(0, 40) * 256, random.within(0, 20) * 256);
                corners[corner] = (x + place % 16 * 16, y + place / 16 * 16);
                check(&corners.map(|(x, y)| vertex(x, y, (x * 7 + y) % 0xFF01, 1)));
                tried.add(1);
            }
        }
    }
}

#[test]
fn r6_order_and_winding_make_no_difference() {
    let mut tried = Tried::new("r6_order_and_winding_make_no_difference", 1500);
    let mut random = Random::named("r6");
    while tried.more() {
        let [a, b, c] = triangle(&mut random, i64::from(WIDTH), i64::from(HEIGHT));
        for interpolation in interpolations() {
            let first = draw(&[a, b, c], interpolation, WIDTH, HEIGHT, None, 0);
            let deep = draw_with_depth(&[a, b, c], interpolation);
            for order in [[a, c, b], [b, a, c], [b, c, a], [c, a, b], [c, b, a]] {
                assert_eq!(draw(&order, interpolation, WIDTH, HEIGHT, None, 0), first, "{order:?}");
                assert!(draw_with_depth(&order, interpolation) == deep, "with depths, {interpolation:?} of {order:?}");
            }
        }
    }
}

/// Bytes and 32-bit and 16-bit depths of a triangle drawn over a half that is near and one that is far.
fn draw_with_depth(vertices: &[Vertex; 3], interpolation: Interpolation) -> (Vec<u8>, Vec<u32>, Vec<u16>) {
    const SIZE: usize = (WIDTH * HEIGHT) as usize;
    let (mut bytes, mut wide) = (vec![0; 2 * SIZE], vec![1_u32; SIZE]);
    let mut narrow = vec![1_u16; SIZE];
    wide[SIZE / 2..].fill(1 << 20);
    narrow[SIZE / 2..].fill(1 << 6);
    let (first, second) = bytes.split_at_mut(SIZE);
    let mut like = vec![0; SIZE];
    let like = Frame::new(&mut like, WIDTH, HEIGHT, WIDTH as usize).expect("legal");
    let on = |bytes| Raster::new(Frame::new(bytes, WIDTH, HEIGHT, WIDTH as usize).expect("legal"));
    on(first).with_depth(DepthBuffer::new(&mut wide, &like).expect("enough")).triangle(vertices, interpolation);
    on(second).with_depth(DepthBuffer::new(&mut narrow, &like).expect("enough")).triangle(vertices, interpolation);
    (bytes, wide, narrow)
}

/// Whatever numbers an empty rectangle has.
#[test]
fn an_empty_clip_rectangle_shows_nothing() {
    let at = |x, y| Vertex::new(I24F8::from(x), I24F8::from(y), U8F8::MAX_VERTEX, 9).expect("in range");
    let vertices = [at(-50, -50), at(300, 0), at(0, 200)];
    let rect = |x0, y0, x1, y1| Rect { x0, y0, x1, y1 };
    for clip in [
        rect(u32::MAX, 0, u32::MAX, 200),
        rect(u32::MAX - 4, 0, 40, 200),
        rect(0, u32::MAX, 320, u32::MAX),
        rect(0, 1 << 31, 320, 20),
        rect(7, 7, 7, 9),
    ] {
        let mut bytes = [3; 100 * 60];
        let mut raster = Raster::new(Frame::new(&mut bytes, 100, 60, 100).expect("legal")).with_clip(clip);
        let mut drawn = raster.triangle(&vertices, Interpolation::Gouraud88);
        drawn += raster.triangles([(&vertices, Interpolation::Gouraud88Reseeded); 9]);
        assert!((drawn.covered, drawn.pixels) == (0, 0) && bytes == [3; 100 * 60], "{clip:?}: {drawn:?}");
    }
}

#[test]
fn r8_a_clip_rectangle_changes_no_byte_inside_it() {
    let mut tried = Tried::new("r8_a_clip_rectangle_changes_no_byte_inside_it", 1500);
    let mut random = Random::named("r8");
    // Wide enough for a third reseeding.
    const WIDE: u32 = 200;
    while tried.more() {
        let vertices = triangle(&mut random, i64::from(WIDE), i64::from(HEIGHT));
        let clip = rect(&mut random, WIDE, HEIGHT);
        for interpolation in interpolations() {
            let mut expected = draw(&vertices, interpolation, WIDE, HEIGHT, None, 0);
            clip_to(&mut expected, WIDE, clip, 0);
            assert_eq!(draw(&vertices, interpolation, WIDE, HEIGHT, Some(clip), 0), expected, "{clip:?} {vertices:?}");
        }
    }
}

#[test]
fn r8_bands_give_the_bytes_of_the_whole() {
    let mut tried = Tried::new("r8_bands_give_the_bytes_of_the_whole", 60);
    let mut random = Random::named("r8 bands");
    let (size, pitch) = ((WIDTH * HEIGHT) as usize, WIDTH as usize + 5);
    while tried.more() {
        let triangles: Vec<_> = (0..20).map(|_| triangle(&mut random, i64::from(WIDTH), i64::from(HEIGHT))).collect();
        let rows_each = random.within(1, i64::from(HEIGHT)) as u32;
        for (with_depth, only) in
            [false, true].into_iter().flat_map(|with| interpolations().map(move |only| (with, only)))
        {
            let mut paint = |frame: Frame<'_>| {
                let mut depths = vec![0; size];
                let depth = DepthBuffer::new(&mut depths, &frame).expect("long enough");
                let mut raster = Raster::new(frame);
                if with_depth {
                    raster = raster.with_depth(depth);
                }
                for vertices in &triangles {
                    raster.triangle(vertices, only);
                }
            };
            let (mut whole, mut bands) = (vec![3; pitch * HEIGHT as usize], vec![3; pitch * HEIGHT as usize]);
            paint(Frame::new(&mut whole, WIDTH, HEIGHT, pitch).expect("legal"));
            Frame::new(&mut bands, WIDTH, HEIGHT, pitch).expect("legal").bands(rows_each).for_each(&mut paint);
            assert_eq!(whole, bands, "{only:?} in bands of {rows_each}, depth {with_depth}");
            assert!(whole.chunks(pitch).all(|row| row[WIDTH as usize..] == [3; 5]), "bytes between rows stay");
        }
    }
}

#[test]
fn r11_moved_by_whole_pixels() {
    let mut tried = Tried::new("r11_moved_by_whole_pixels", 1500);
    let mut random = Random::named("r11");
    let (width, height) = (i64::from(WIDTH), i64::from(HEIGHT));
    while tried.more() {
        let mut corner = || (random.within(0, 40 * 256), random.within(0, 12 * 256), random.within(0, 0xFF00));
        let corners = [corner(), corner(), corner()];
        let at = |dx: i64, dy: i64| corners.map(|(x, y, shade)| vertex(x + dx * 256, y + dy * 256, shade, 1));
        let (dx, dy) = (random.within(0, width - 41), random.within(0, height - 13));
        for interpolation in interpolations() {
            let still = draw(&at(0, 0), interpolation, WIDTH, HEIGHT, None, 0);
            let mut moved = draw(&at(dx, dy), interpolation, WIDTH, HEIGHT, None, 0);
            moved.rotate_left((dy * width + dx) as usize);
            assert_eq!(still, moved, "{interpolation:?} moved by ({dx}, {dy}): {corners:?}");
        }
    }
}

#[test]
fn r14_shades_at_both_ends() {
    let mut tried = Tried::new("r14_shades_at_both_ends", 800);
    let mut random = Random::named("r14");
    while tried.more() {
        let vertices = triangle(&mut random, i64::from(WIDTH), i64::from(HEIGHT));
        let ends = vertices.map(|v| {
            let shade = random.one_of(&[0, 0, 1, 0x7F, 0x80, 0xFE80, 0xFEFF, 0xFF00, 0xFF00]);
            vertex(v.x().to_bits().into(), v.y().to_bits().into(), shade, 1)
        });
        check(&ends);
    }
    for above in 0xFF01..=0xFFFF {
        let shade = U8F8::from_bits(above);
        let refused = Vertex::new(I24F8::from(1), I24F8::from(1), shade, 0);
        assert_eq!(refused, Err(RasterError::ShadeAbove255 { shade }));
    }
}

#[test]
fn r7_outside_the_guard_band_is_refused() {
    let mut tried = Tried::new("r7_outside_the_guard_band_is_refused", 12);
    // 4,096 pixels, the stated limit, up to which all of the raster's sums are proved to fit.
    let (zero, edge) = (I24F8::from_bits(0), 4096 * 256);
    assert_eq!(Vertex::GUARD_BAND, edge);
    for (bits, legal) in
        [(edge, true), (-edge, true), (edge + 1, false), (-edge - 1, false), (i32::MAX, false), (i32::MIN, false)]
    {
        let far = I24F8::from_bits(bits);
        for (x, y) in [(far, zero), (zero, far)] {
            let made = Vertex::new(x, y, U8F8::from_bits(0), 0);
            let expected = if legal { Ok((x, y)) } else { Err(RasterError::OutsideGuardBand { x, y }) };
            assert_eq!(made.map(|v| (v.x(), v.y())), expected);
            tried.add(1);
        }
    }
}

#[test]
fn a_refusal_says_what_was_refused() {
    let (x, y) = (I24F8::from_bits(-1_048_577), I24F8::from_bits(3));
    let outside = Vertex::new(x, y, U8F8::from_bits(0), 0).expect_err("outside").to_string();
    assert_eq!(outside, "vertex at (-1048577, 3) / 256 pixels lies outside the guard band of 4,096 pixels");
    let above = Vertex::new(y, y, U8F8::from_bits(0xFF01), 0).expect_err("too bright").to_string();
    assert_eq!(above, "vertex shade 0xff01 is above 0xff00 (255.0)");
}

#[test]
fn r4_random_triangles_against_the_oracle() {
    against_the_oracle(Tried::new("r4_random_triangles_against_the_oracle", 3000));
}

#[test]
#[ignore = "the long run: a million triangles, pixel by pixel"]
fn r4_long_random_triangles_against_the_oracle() {
    against_the_oracle(Tried::new("r4_long_random_triangles_against_the_oracle", 1_000_000));
}

fn against_the_oracle(mut tried: Tried) {
    let mut random = Random::named("r*");
    while tried.more() {
        measure(&triangle(&mut random, i64::from(WIDTH), i64::from(HEIGHT)), WIDTH, HEIGHT).report(&mut tried);
    }
}

/// Rows from end to end, in mode 13h and in the widest frame: where sums drift the most, and near and far are the
/// furthest apart.
#[test]
fn whole_rows_keep_to_the_bounds() {
    let mut tried = Tried::new("whole_rows_keep_to_the_bounds", 60);
    let mut random = Random::named("whole rows");
    while tried.more() {
        let (width, height) = random.one_of(&[(320, 3), (320, 3), (320, 3), (4096, 1)]);
        let mut corner = |x: i64| {
            // Shades of any size, including steps of less than 1/256.
            let shade = (random.log_uniform(16) as i64 - 1).min(0xFF00);
            let shade = if random.within(0, 1) == 0 { shade } else { 0xFF00 - shade };
            vertex(x * 256, random.within(-40 * 256, 40 * 256), shade, random.log_uniform(32) as i64)
        };
        let (left, right) = (corner(-100), corner(i64::from(width).min(4_000) + 90));
        // Beyond the upper or the lower edge, so that usually all rows are covered.
        let third = corner(i64::from(width) / 2);
        let y = if random.within(0, 1) == 0 { -3_000 } else { 3_000 };
        let third = vertex(third.x().to_bits().into(), y * 256, third.shade().to_bits().into(), third.depth().into());
        measure(&[left, right, third], width, height).report(&mut tried);
    }
}

#[test]
fn d3_depth_is_as_defined_and_the_first_of_equals_stays() {
    let mut tried = Tried::new("d3_depth_is_as_defined_and_the_first_of_equals_stays", 400);
    let mut random = Random::named("d*");
    let mut replaced = 0;
    while tried.more() {
        let interpolation = random.one_of(&[
            Interpolation::Gouraud88Reseeded,
            Interpolation::Gouraud88,
            Interpolation::GouraudHyperbolic,
            Interpolation::Flat(7),
        ]);
        let triangles: Vec<_> = (0..6).map(|_| triangle(&mut random, WIDTH.into(), HEIGHT.into())).collect();
        // The last repeats the first with other shades: with equal depths the first submitted wins.
        let twin = triangles[0].map(|v| vertex(v.x().to_bits().into(), v.y().to_bits().into(), 0, v.depth().into()));
        let all: Vec<_> = triangles.iter().copied().chain([twin]).collect();
        let (mut expected, mut nearest) = (vec![0; (WIDTH * HEIGHT) as usize], vec![0; (WIDTH * HEIGHT) as usize]);
        let (mut covered, mut written) = (0, 0);
        for vertices in &all {
            for oracle::Pixel { x, y, byte } in oracle::pixels(vertices, interpolation, WIDTH as i32, HEIGHT as i32) {
                let depth = oracle::depth_at(vertices, x, y);
                assert_eq!(
                    DepthPlane::new(&SortedTriangle::new(vertices)).at(x, y),
                    depth,
                    "({x}, {y}) of {vertices:?}"
                );
                let (low, high) =
                    vertices.iter().fold((u32::MAX, 0), |(low, high), v| (low.min(v.depth()), high.max(v.depth())));
                assert!((low..=high).contains(&depth), "depth within the vertices' at ({x}, {y}) of {vertices:?}");
                let place = y as usize * WIDTH as usize + x as usize;
                covered += 1;
                if depth > nearest[place] {
                    written += 1;
                    replaced += u32::from(nearest[place] != 0);
                    (nearest[place], expected[place]) = (depth, byte);
                }
            }
        }
        let (mut bytes, mut depths) = (vec![0; (WIDTH * HEIGHT) as usize], vec![0; (WIDTH * HEIGHT) as usize]);
        let frame = Frame::new(&mut bytes, WIDTH, HEIGHT, WIDTH as usize).expect("legal");
        let depth = DepthBuffer::new(&mut depths, &frame).expect("long enough");
        let mut raster = Raster::new(frame).with_depth(depth);
        let mut counts = DrawStats::default();
        for vertices in &all {
            counts += raster.triangle(vertices, interpolation);
        }
        assert_eq!((counts.covered, counts.pixels), (covered, written), "{all:?}");
        assert_eq!(bytes, expected, "{all:?}");
        assert_eq!(depths, nearest, "{all:?}");
    }
    assert!(replaced > 1000, "triangles hid each other: {replaced}");
}

#[test]
fn depth_buffers_hold_what_their_frame_holds() {
    let mut bytes = [0; 8 * 6];
    let mut frame = Frame::new(&mut bytes, 8, 6, 8).expect("legal");
    let band = frame.bands(2).nth(1).expect("three bands");
    let error = DepthBuffer::new(&mut [0_u32; 15], &band).map(|_| ()).expect_err("two rows of eight");
    assert_eq!(error.to_string(), "15 depths given for a frame that needs 16");
    let mut depths = [7_u32; 17];
    let mut depth = DepthBuffer::new(&mut depths, &band).expect("enough");
    for (y, there) in [(0, false), (1, false), (2, true), (3, true), (4, false), (u32::MAX, false)] {
        assert_eq!(depth.row_mut(y).map(|row| row.to_vec()), there.then(|| vec![7; 8]), "row {y}");
    }
    depth.row_mut(3).expect("its last row").fill(9);
    assert_eq!(depths[8..], [9, 9, 9, 9, 9, 9, 9, 9, 7]);
    DepthBuffer::new(&mut depths, &band).expect("enough").clear();
    assert_eq!(depths, [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 7]);
}

/// Shadings linear on the face, and their error beyond the byte's half.
const ON_THE_FACE: &[(Interpolation, f64)] = &[
    (Interpolation::GouraudHyperbolic, 0.0),
    #[cfg(feature = "alloc")]
    (Interpolation::GouraudFloat, 1.0 / 8192.0),
];

/// C5: w from 1 to 10⁴ within one triangle. The truth is the shade that is linear on the face, at the rounded vertices,
/// from unrounded w.
fn perspective_correct_shades(mut tried: Tried) {
    let mut random = Random::named("c5");
    let mut pixels = 0_u64;
    while tried.more() {
        let corners = triangle(&mut random, WIDTH.into(), HEIGHT.into());
        // The first vertex is on the near plane, so that the depths span the full range.
        let w = [1.0, f64::powf(10.0, random.unit() * 4.0), f64::powf(10.0, random.unit() * 4.0)];
        let vertices = [0, 1, 2].map(|i| {
            let depth = (f64::powi(2.0, 30) / w[i]).round() as i64;
            let v = corners[i];
            vertex(v.x().to_bits().into(), v.y().to_bits().into(), v.shade().to_bits().into(), depth)
        });
        let points = vertices.each_ref().map(oracle::point);
        let (low, high) = vertices
            .iter()
            .fold((u16::MAX, 0), |(low, high), v| (low.min(v.shade().to_bits()), high.max(v.shade().to_bits())));
        // The shadings that are linear on the face, in turn.
        let (interpolation, more) = random.one_of(ON_THE_FACE);
        let bytes = drawn(|empty| draw(&vertices, interpolation, WIDTH, HEIGHT, None, empty));
        for (place, byte) in bytes.into_iter().enumerate() {
            let Some(byte) = byte else { continue };
            assert!((u32::from(low) + 128) >> 8 <= byte.into() && u32::from(byte) <= (u32::from(high) + 128) >> 8);
            let p = oracle::centre(place as i32 % WIDTH as i32, place as i32 / WIDTH as i32);
            let [a, b, c] = points;
            // Areas within the triangle, all of one sign: exact in f64 up to 2⁵³, and their sums lose nothing.
            let weights = [oracle::edge(b, c, p), oracle::edge(c, a, p), oracle::edge(a, b, p)];
            let weighted = [0, 1, 2].map(|i| weights[i] as f64 / w[i]);
            let shade = [0, 1, 2].map(|i| weighted[i] * f64::from(vertices[i].shade().to_bits()) / 256.0);
            let truth = (shade[0] + shade[1] + shade[2]) / (weighted[0] + weighted[1] + weighted[2]);
            // A depth is off by ½ of at least 2³⁰/10⁴, which is 4.7 parts in 10⁶; the mean of shades
            // by at most twice that of 255: 0.0024. The byte is the nearest, in f32 to 1/8,192.
            let off = (f64::from(byte) - truth).abs();
            tried.worst("shades off", off);
            assert!(off <= 0.5 + 0.0024 + more, "{interpolation:?}: {off} shades at {p:?} of {vertices:?}, w {w:?}");
            pixels += 1;
        }
    }
    assert!(pixels > 30 * tried.stated(), "{pixels} pixels");
}

#[test]
fn c5_perspective_correct_shades() {
    perspective_correct_shades(Tried::new("c5_perspective_correct_shades", 3000));
}

#[test]
#[ignore = "the long run: 300,000 triangles"]
fn c5_long_perspective_correct_shades() {
    perspective_correct_shades(Tried::new("c5_long_perspective_correct_shades", 300_000));
}

/// With and without a depth test, which are different loops, every kernel gives the same bytes: of rows just short enough
/// not to be reseeded, and just too long, in part outside the clip rectangle.
#[test]
fn a_depth_buffer_changes_no_byte_of_one_triangle() {
    let (width, height) = (96_u32, 24_u32);
    let mut tried = Tried::new("a_depth_buffer_changes_no_byte_of_one_triangle", 30_000);
    let mut random = Random::named("with and without depth");
    let mut reseeded = 0;
    for number in 0..30_000 {
        let (left, breadth) = (random.within(-2_000, 9_000), random.one_of(&[700, 16_100, 16_384, 16_385, 16_600]));
        // A trapezoid's half: its longest row is as long as it is wide.
        let tall = random.one_of(&[300, 2_000, 6_000]);
        let top = random.within(-1_000, 5_000);
        let mut corner = |x: i64, y: i64| vertex(left + x, top + y, random.within(0, 0xFF00), 1);
        let vertices = [corner(0, 0), corner(breadth, 0), corner(breadth / 2, tall)];
        let [x0, y0] = [random.within(0, 40) as u32, random.within(0, 4) as u32];
        let clip = Rect { x0, y0, x1: width - random.within(0, 30) as u32, y1: height };
        let interpolation =
            random.one_of(&[Interpolation::Gouraud88, Interpolation::Gouraud88Reseeded, Interpolation::Flat(7)]);
        let kernels: Vec<Kernel> = Kernel::available().collect();
        let kernel = kernels[number % kernels.len()];
        let draw = |depths: Option<&mut [u32]>| {
            let mut bytes = vec![0; (width * height) as usize];
            let frame = Frame::new(&mut bytes, width, height, width as usize).expect("legal");
            let drawn = match depths {
                None => Raster::new(frame).with_clip(clip).with_kernel(kernel).triangle(&vertices, interpolation),
                Some(depths) => {
                    let depth = DepthBuffer::new(depths, &frame).expect("long enough");
                    let raster = Raster::new(frame).with_clip(clip).with_kernel(kernel);
                    raster.with_depth(depth).triangle(&vertices, interpolation)
                }
            };
            (bytes, [drawn.spans, drawn.covered, drawn.pixels])
        };
        let (plain, tested) = (draw(None), draw(Some(&mut vec![0; (width * height) as usize])));
        assert!(plain == tested, "{kernel}, {interpolation:?}: {vertices:?} in {clip:?}");
        tried.add(1);
        if breadth < 16_000 || interpolation != Interpolation::Gouraud88Reseeded {
            continue;
        }
        // By the definition, some rows are reseeded and others are not.
        let expected = drawn_by_the_oracle(&vertices, interpolation, width, height);
        let mut expected: Vec<u8> = expected.into_iter().map(Option::unwrap_or_default).collect();
        clip_to(&mut expected, width, clip, 0);
        assert!(plain.0 == expected, "{kernel}, {interpolation:?}: {vertices:?} in {clip:?}");
        reseeded += u32::from(breadth > 16_384);
    }
    assert!(reseeded > 1_000, "{reseeded}");
}

/// Lists of all lengths around a batch's, with shadings that a batch takes and others.
#[test]
fn a_list_is_drawn_as_triangle_by_triangle() {
    let (width, height) = (96_u32, 64_u32);
    let size = (width * height) as usize;
    let mut tried = Tried::new("a_list_is_drawn_as_triangle_by_triangle", 200);
    let mut random = Random::named("lists of triangles");
    let mut all = Interpolation::INTERPOLATED.to_vec();
    all.push(Interpolation::Flat(77));
    let mut pixels = 0;
    for _ in 0..200 {
        let length = random.one_of(&[0, 1, 127, 128, 129, 300]) as usize;
        // One in five does not fit into a batch.
        let pick = |random: &mut Random| {
            if random.within(0, 4) == 0 { random.one_of(&all) } else { Interpolation::Gouraud88Reseeded }
        };
        let list: Vec<_> =
            (0..length).map(|_| (triangle(&mut random, width.into(), height.into()), pick(&mut random))).collect();
        let drawn = |draw: &dyn Fn(&mut Raster<'_>) -> DrawStats| {
            let (mut bytes, mut depths) = (vec![0; size], vec![0_u32; size]);
            let frame = Frame::new(&mut bytes, width, height, width as usize).expect("legal");
            let depth = DepthBuffer::new(&mut depths, &frame).expect("long enough");
            let stats = draw(&mut Raster::new(frame).with_depth(depth));
            (bytes, depths, stats)
        };
        let at_once = drawn(&|raster| together(raster, &list));
        let apart = drawn(&|raster| one_by_one(raster, &list));
        assert!(at_once == apart, "{length} triangles: {} and {}", at_once.2.pixels, apart.2.pixels);
        pixels += u64::from(apart.2.pixels);
        tried.add(1);
    }
    assert!(pixels > 100_000, "{pixels}");
}

/// The last rows of the largest frame agree with a band that holds only them. A frame has 16 MB and its depths 64,
/// which are offsets that a 32-bit `usize` can hold.
#[test]
fn the_last_rows_of_the_largest_frame_are_drawn() {
    const SIDE: u32 = Frame::MAX_SIDE;
    const FIRST: u32 = SIDE - 40;
    assert!(u64::from(SIDE).pow(2) * size_of::<u32>() as u64 <= i32::MAX as u64);
    let (side, kept) = (SIDE as usize, (FIRST * SIDE) as usize);
    let mut random = Random::named("the_last_rows_of_the_largest_frame_are_drawn");
    // Each has one corner at the frame's lower edge.
    let corner = |random: &mut Random, highest: i64| {
        let (x, y) = (random.within(0, 1 << 20), random.within(highest, 1 << 20));
        vertex(x, y, random.within(0, 0xFF00), random.within(1, u32::MAX.into()))
    };
    let tops = [FIRST - 8, FIRST - 8, SIDE].map(|row| i64::from(row) << 8);
    let (mut all, mut all_depths) = (vec![0; side * side], vec![0_u32; side * side]);
    let (mut band, mut band_depths) = (vec![0; side * side - kept], vec![0_u32; side * side - kept]);
    for interpolation in interpolations() {
        for _ in 0..4 {
            let vertices = tops.map(|top| corner(&mut random, top));
            let frame = Frame::new(&mut all, SIDE, SIDE, side).unwrap();
            let depth = DepthBuffer::new(&mut all_depths, &frame).unwrap();
            Raster::new(frame).with_depth(depth).triangle(&vertices, interpolation);
            let frame = Frame::band(&mut band, SIDE, SIDE, side, FIRST..SIDE).unwrap();
            let depth = DepthBuffer::new(&mut band_depths, &frame).unwrap();
            Raster::new(frame).with_depth(depth).triangle(&vertices, interpolation);
        }
    }
    assert!(all[kept..] == band && all_depths[kept..] == band_depths);
    assert!(band[side * 39..].iter().any(|&byte| byte != 0), "nothing is in the last row");
}

/// S6: bytes of shades s and of shades 255 − s at the same corners add up to 255, or to 256 where both are halfway between
/// two bytes.
#[test]
fn s6_complement_of_triangles() {
    let mut tried = Tried::new("s6_complement_of_triangles", 100_000);
    let mut random = Random::named("s6");
    let (width, height, mut halves) = (320_u32, 16_u32, [0_u32; 2]);
    while tried.more() {
        let corners = [0, 1, 2].map(|_| (random.within(-99, 320 * 256), random.within(-99, 16 * 256)));
        // Whole, or with few fractions, so that some sums are halfway.
        let (grain, alone) = (random.one_of(&[1, 128, 256]), random.within(0, 1) == 0);
        let shades = [0, 1, 2].map(|_| random.within(0, 0xFF00) / grain * grain);
        for interpolation in [Interpolation::Gouraud88, Interpolation::Gouraud88Reseeded] {
            let bytes = |complement: bool| {
                let shade = |i: usize| if complement { 0xFF00 - shades[i] } else { shades[i] };
                let vertices = [0, 1, 2].map(|i| vertex(corners[i].0, corners[i].1, shade(i), 0));
                drawn(|background| {
                    let mut pixels = vec![background; (width * height) as usize];
                    let frame = Frame::new(&mut pixels, width, height, width as usize).expect("a frame");
                    let mut raster = Raster::new(frame);
                    match alone {
                        true => raster.triangle(&vertices, interpolation),
                        false => raster.triangles([(&vertices, interpolation)]),
                    };
                    pixels
                })
            };
            for (byte, other) in bytes(false).into_iter().zip(bytes(true)) {
                assert_eq!(byte.is_some(), other.is_some(), "{corners:?}");
                let (Some(byte), Some(other)) = (byte, other) else { continue };
                let sum = u32::from(byte) + u32::from(other);
                assert!((255..=256).contains(&sum), "{byte} and {other}: {corners:?}, {shades:?}, {interpolation:?}");
                halves[usize::from(alone)] += sum - 255;
                tried.add(1);
            }
        }
    }
    assert!(halves.iter().all(|halves| *halves > 100), "{halves:?} are halfway");
}
