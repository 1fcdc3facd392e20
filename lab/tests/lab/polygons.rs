//! Convex polygons by the table of rows, against an i128 oracle of the same definition; and why faces are split into
//! triangles instead (N8).

use crate::support::triangles::{self, rect, vertex};
use crate::support::tried::Tried;
use mode13h::raster::{DrawStats, Frame, Interpolation, Raster, Rect, Vertex};
use mode13h_conformance::Random;
use mode13h_conformance::oracle::{self, Point, Ratio};
use mode13h_lab::museum::polygon::{self, PolygonError, TableRow};

const WIDTH: u32 = 150;
const HEIGHT: u32 = 30;
const BAND: i64 = Vertex::GUARD_BAND as i64;
const RESEED: i32 = 64;

struct Sheet {
    clip: Rect,
    rows_each: u32,
    empty: u8,
}

impl Sheet {
    const WHOLE: Self = Self { clip: Rect { x0: 0, y0: 0, x1: WIDTH, y1: HEIGHT }, rows_each: HEIGHT, empty: 0 };

    fn draw(&self, vertices: &[Vertex], interpolation: Interpolation) -> Result<(Vec<u8>, DrawStats), PolygonError> {
        let pitch = WIDTH as usize + 3;
        let mut bytes = vec![self.empty; pitch * HEIGHT as usize];
        // Leftovers from the previous polygon do not matter.
        let rubbish = vertex(-999_999, 999_999, 0xFF00, 0);
        let rubbish = TableRow {
            left_x: rubbish.x(),
            right_x: rubbish.y(),
            left_shade: rubbish.shade(),
            right_shade: rubbish.shade(),
        };
        let mut table = vec![rubbish; self.rows_each as usize];
        let mut drawn = DrawStats::default();
        for mut band in Frame::new(&mut bytes, WIDTH, HEIGHT, pitch).expect("legal").bands(self.rows_each) {
            drawn += polygon::draw(&mut band, self.clip, vertices, interpolation, &mut table)?;
        }
        assert!(bytes.chunks(pitch).all(|row| row[WIDTH as usize..] == [self.empty; 3]), "bytes between the rows stay");
        Ok((bytes.chunks(pitch).flat_map(|row| &row[..WIDTH as usize]).copied().collect(), drawn))
    }
}

/// A row by the Hungarian tutorial's table, in i128: the crossings, left first, as (x, shade) in 1/256.
fn crossings(vertices: &[Vertex], y: i32) -> Vec<(i128, i128)> {
    let (_, yc) = oracle::centre(0, y);
    let mut found = Vec::new();
    for (i, a) in vertices.iter().enumerate() {
        let b = &vertices[(i + 1) % vertices.len()];
        let (a, b) = if a.y() < b.y() { (a, b) } else { (b, a) };
        let ((ax, ay), (bx, by)) = (oracle::point(a), oracle::point(b));
        if !(ay <= yc && yc < by) {
            continue;
        }
        let between = |a: i128, b: i128| Ratio { n: a * (by - ay) + (b - a) * (yc - ay), d: by - ay };
        let shade = between(a.shade().to_bits().into(), b.shade().to_bits().into());
        let nearest = Ratio { n: 2 * shade.n + shade.d, d: 2 * shade.d }.floor();
        found.push((between(ax, bx), nearest));
    }
    // Sorted by exact x; where they meet there is no pixel between them.
    found.sort_by(|(a, _), (b, _)| (a.n * b.d).cmp(&(b.n * a.d)));
    found.into_iter().map(|(x, shade)| (x.ceil(), shade)).collect()
}

/// The bytes of a convex polygon; `None` where it draws nothing.
fn expected(vertices: &[Vertex], reseed: i32) -> Vec<Option<u8>> {
    let outline: Vec<Point> = vertices.iter().map(oracle::point).collect();
    let mut bytes = Vec::new();
    for y in 0..HEIGHT as i32 {
        let edges = crossings(vertices, y);
        let (mut first, mut sum) = (None, 0);
        for x in 0..WIDTH as i32 {
            let centre = oracle::centre(x, y);
            if !oracle::polygon_covers(&outline, centre) {
                bytes.push(None);
                continue;
            }
            let [(left, from), (right, to)] = edges[..] else { panic!("two crossings: {edges:?}") };
            let f = *first.get_or_insert(x);
            if (x - f) % reseed == 0 {
                let exact = Ratio { n: from * (right - left) + (to - from) * (centre.0 - left), d: right - left };
                sum = if to < from { exact.ceil() } else { exact.floor() };
            } else {
                sum += (to - from) * 256 / (right - left);
            }
            bytes.push(Some(u8::try_from((sum + 128) >> 8).expect("a byte")));
        }
    }
    bytes
}

/// Checks cover, bytes and range of a convex polygon. Returns the number of pixels covered.
fn check(vertices: &[Vertex]) -> u32 {
    let shades = || vertices.iter().map(|v| v.shade().to_bits());
    let (low, high) = (shades().min().unwrap_or(0), shades().max().unwrap_or(0));
    let range = (low + 128) >> 8..=(high + 128) >> 8;
    let mut covered = 0;
    for (interpolation, reseed) in [(Interpolation::Gouraud88Reseeded, RESEED), (Interpolation::Gouraud88, 1 << 20)] {
        let expected = expected(vertices, reseed);
        let mut counts = DrawStats::default();
        let drawn = triangles::drawn(|empty| {
            let (bytes, drawn) = Sheet { empty, ..Sheet::WHOLE }.draw(vertices, interpolation).expect("convex");
            counts = drawn;
            bytes
        });
        covered = 0;
        for (place, (is, expected)) in drawn.into_iter().zip(&expected).enumerate() {
            let (x, y) = (place % WIDTH as usize, place / WIDTH as usize);
            assert_eq!(is, *expected, "{interpolation:?} at ({x}, {y}) of {vertices:?}");
            if let Some(byte) = is {
                covered += 1;
                assert!(range.contains(&u16::from(byte)), "range at ({x}, {y}) of {vertices:?}");
            }
        }
        assert_eq!((counts.covered, counts.pixels), (covered, covered));
    }
    let (flat, _) = Sheet::WHOLE.draw(vertices, Interpolation::Flat(7)).expect("convex");
    assert_eq!(flat.iter().filter(|byte| **byte == 7).count() as u32, covered, "flat covers the same");
    covered
}

fn cross(a: (i64, i64), b: (i64, i64), c: (i64, i64)) -> i64 {
    (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)
}

/// The convex hull of random points (Andrew's monotone chain), sometimes with points left on its edges; any number of
/// corners.
fn convex(random: &mut Random) -> Vec<(i64, i64)> {
    let reach = random.one_of(&[300, 3_000, 20_000, 20_000, 100_000, BAND]);
    let snap = random.one_of(&[1, 1, 16, 128, 256]);
    let (cx, cy) = (random.within(0, i64::from(WIDTH) * 256), random.within(0, i64::from(HEIGHT) * 256));
    let thin = random.one_of(&[1, 1, 1, 40, 4000]);
    let mut points: Vec<(i64, i64)> = (0..random.log_uniform(6) + 2)
        .map(|_| {
            let (x, y) = (cx + random.within(-reach, reach), cy + random.within(-reach, reach) / thin);
            (x.clamp(-BAND, BAND) / snap * snap, y.clamp(-BAND, BAND) / snap * snap)
        })
        .collect();
    points.sort_unstable();
    points.dedup();
    let keep_collinear = random.within(0, 1) == 0;
    let chain = |points: &mut dyn Iterator<Item = (i64, i64)>| {
        let mut chain: Vec<(i64, i64)> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                let turn = cross(a, b, p);
                if turn > 0 || (turn == 0 && keep_collinear) {
                    break;
                }
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut hull = chain(&mut points.iter().copied());
    hull.extend(chain(&mut points.iter().rev().copied()));
    hull
}

fn shaded(random: &mut Random, corners: &[(i64, i64)]) -> Vec<Vertex> {
    corners.iter().map(|&(x, y)| vertex(x, y, triangles::shade(random), 0)).collect()
}

#[test]
fn the_table_is_s4s_and_cover_is_exact() {
    let mut tried = Tried::new("the_table_is_s4s_and_cover_is_exact", 600);
    let mut random = Random::named("polygon");
    let (mut pixels, mut corners) = (0, 0);
    while tried.more() {
        let hull = convex(&mut random);
        if hull.len() < 3 {
            continue;
        }
        let mut vertices = shaded(&mut random, &hull);
        pixels += check(&vertices);
        corners = corners.max(vertices.len());
        // Neither the first vertex, nor the winding, nor a repeated vertex matters.
        let first = Sheet::WHOLE.draw(&vertices, Interpolation::default());
        let turn = random.within(0, vertices.len() as i64 - 1) as usize;
        vertices.rotate_left(turn);
        vertices.insert(0, vertices[0]);
        assert_eq!(Sheet::WHOLE.draw(&vertices, Interpolation::default()), first);
        vertices.reverse();
        assert_eq!(Sheet::WHOLE.draw(&vertices, Interpolation::default()), first);
    }
    assert!(pixels > 100_000 && corners > 10, "{pixels} pixels, up to {corners} corners");
}

#[test]
fn r8_polygons_clipped_and_in_bands() {
    let mut tried = Tried::new("r8_polygons_clipped_and_in_bands", 300);
    let mut random = Random::named("polygon r8");
    while tried.more() {
        let hull = convex(&mut random);
        let vertices = shaded(&mut random, &hull);
        let clip = rect(&mut random, WIDTH, HEIGHT);
        let rows_each = random.within(1, HEIGHT.into()) as u32;
        for interpolation in [Interpolation::Gouraud88Reseeded, Interpolation::Gouraud88, Interpolation::Flat(9)] {
            let (mut whole, _) = Sheet::WHOLE.draw(&vertices, interpolation).expect("convex");
            triangles::clip_to(&mut whole, WIDTH, clip, 0);
            let sheet = Sheet { clip, rows_each, empty: 0 };
            let (part, _) = sheet.draw(&vertices, interpolation).expect("convex");
            assert_eq!(part, whole, "{clip:?}, bands of {rows_each}, {vertices:?}");
        }
    }
}

/// A convex polygon divided by chords into polygons and triangles draws each pixel inside once, and none outside.
#[test]
fn r5_polygons_that_share_edges() {
    let mut tried = Tried::new("r5_polygons_that_share_edges", 400);
    let mut random = Random::named("polygon r5");
    while tried.more() {
        let outline = convex(&mut random);
        let mut whole = vec![outline.clone()];
        let mut parts = Vec::new();
        while let Some(outline) = whole.pop() {
            let n = outline.len();
            if n < 4 || random.within(0, 3) == 0 {
                parts.push(outline);
                continue;
            }
            let a = random.within(0, n as i64 - 3) as usize;
            let b = random.within(a as i64 + 2, n as i64 - 1) as usize;
            let rest = outline[..=a].iter().chain(&outline[b..]).copied().collect();
            whole.extend([outline[a..=b].to_vec(), rest]);
        }
        let mut counts = vec![0_u32; (WIDTH * HEIGHT) as usize];
        for part in &parts {
            let vertices = shaded(&mut random, part);
            let mut bytes = vec![0; counts.len()];
            let mut frame = Frame::new(&mut bytes, WIDTH, HEIGHT, WIDTH as usize).expect("legal");
            match vertices[..] {
                [a, b, c] if random.within(0, 1) == 0 => {
                    Raster::new(frame).triangle(&[a, b, c], Interpolation::Flat(1));
                }
                _ => {
                    let (clip, mut table) = (frame.bounds(), [TableRow::default(); HEIGHT as usize]);
                    polygon::draw(&mut frame, clip, &vertices, Interpolation::Flat(1), &mut table).expect("convex");
                }
            }
            counts.iter_mut().zip(bytes).for_each(|(count, byte)| *count += u32::from(byte));
        }
        let outline: Vec<Point> = outline.iter().map(|&(x, y)| (i128::from(x), i128::from(y))).collect();
        for (place, count) in counts.iter().enumerate() {
            let centre = oracle::centre(place as i32 % WIDTH as i32, place as i32 / WIDTH as i32);
            assert_eq!(*count, u32::from(oracle::polygon_covers(&outline, centre)), "{parts:?}");
        }
    }
}

/// Any list of points is either rejected or drawn by the even-odd rule; convex ones are not rejected.
#[test]
fn r7_any_list_of_points_is_quiet() {
    let mut tried = Tried::new("r7_any_list_of_points_is_quiet", 60_000);
    let mut random = Random::named("polygon any");
    let (mut refused, mut drawn) = (0, 0);
    while tried.more() {
        let (side, unit) = random.one_of(&[(2, 700), (3, 500), (5, 128), (40, 100), (BAND, 1)]);
        let corners: Vec<(i64, i64)> = (0..random.within(0, 7))
            .map(|_| (random.within(-side / 2, side) * unit, random.within(-side / 2, side) * unit))
            .map(|(x, y)| (x.clamp(-BAND, BAND), y.clamp(-BAND, BAND)))
            .collect();
        let vertices = shaded(&mut random, &corners);
        match Sheet::WHOLE.draw(&vertices, Interpolation::Flat(1)) {
            Ok((bytes, _)) => {
                drawn += 1;
                let outline: Vec<Point> = vertices.iter().map(oracle::point).collect();
                for (place, byte) in bytes.iter().enumerate() {
                    let centre = oracle::centre(place as i32 % WIDTH as i32, place as i32 / WIDTH as i32);
                    assert_eq!(*byte, u8::from(oracle::polygon_covers(&outline, centre)), "{corners:?}");
                }
                // Gouraud must not panic either.
                Sheet::WHOLE.draw(&vertices, Interpolation::default()).expect("convex, as before");
            }
            Err(error) => {
                refused += 1;
                assert_eq!(error, PolygonError::NotConvex);
                assert!(corners.len() > 3, "a triangle is convex: {corners:?}");
                // Convex means that no corner lies to the left of an edge in one of the two windings. A list that
                // passes this and was rejected goes around twice, or back along a line.
                let n = corners.len();
                let side = |sign: i64| {
                    (0..n).all(|i| corners.iter().all(|c| sign * cross(corners[i], corners[(i + 1) % n], *c) >= 0))
                };
                let mut distinct = corners.clone();
                distinct.sort_unstable();
                distinct.dedup();
                assert!(distinct.len() < n || !(side(1) || side(-1)), "convex: {corners:?}");
            }
        }
    }
    assert!(refused > 1000 && drawn > 1000, "{refused} refused, {drawn} drawn");
}

#[test]
fn a_short_table_is_refused() {
    let corner = |x: i64, y: i64| vertex(x * 256, y * 256, 0, 0);
    let vertices = [corner(0, 0), corner(10, 0), corner(10, 10), corner(0, 10)];
    let mut bytes = [0; 20 * 20];
    let mut frame = Frame::new(&mut bytes, 20, 20, 20).expect("legal");
    let mut table = [TableRow::default(); 19];
    let clip = frame.bounds();
    let refused = polygon::draw(&mut frame, clip, &vertices, Interpolation::Flat(1), &mut table);
    assert_eq!(refused, Err(PolygonError::Table { given: 19, needed: 20 }));
    // A band needs only its own rows.
    for mut band in frame.bands(7) {
        polygon::draw(&mut band, clip, &vertices, Interpolation::Flat(1), &mut table[..7]).expect("seven rows at most");
    }
    assert_eq!(bytes.iter().map(|byte| u32::from(*byte)).sum::<u32>(), 100);
}

/// The bytes of a square frame, rotated a quarter turn clockwise.
fn turned(bytes: &[Option<u8>], side: usize) -> Vec<Option<u8>> {
    // The pixel at (x, y) moves to (side − 1 − y, x).
    (0..side * side).map(|place| bytes[(side - 1 - place % side) * side + place / side]).collect()
}

/// N8: a quad rotated on the screen. The Russian article and the Russian textbook say that Gouraud depends on
/// orientation: true for four vertices, false for three (slip 6).
#[test]
fn n8_slip_6_a_turned_quads_shade_depends_on_the_turn_unless_it_is_split() {
    const SIDE: usize = 64;
    let mut tried = Tried::new("n8_slip_6_a_turned_quads_shade_depends_on_the_turn_unless_it_is_split", 200);
    let mut random = Random::named("n8");
    let draw = |paint: &dyn Fn(Frame<'_>)| -> Vec<Option<u8>> {
        triangles::drawn(|empty| {
            let mut bytes = vec![empty; SIDE * SIDE];
            paint(Frame::new(&mut bytes, SIDE as u32, SIDE as u32, SIDE).expect("legal"));
            bytes
        })
    };
    let as_table = |vertices: &[Vertex]| {
        draw(&|mut frame| {
            let (clip, mut table) = (frame.bounds(), [TableRow::default(); SIDE]);
            polygon::draw(&mut frame, clip, vertices, Interpolation::default(), &mut table).expect("convex");
        })
    };
    let as_triangles = |v: &[Vertex]| {
        draw(&|frame| {
            let mut raster = Raster::new(frame);
            raster.triangle(&[v[0], v[1], v[2]], Interpolation::default());
            raster.triangle(&[v[0], v[2], v[3]], Interpolation::default());
        })
    };
    let quarter = |vertices: &[Vertex]| -> Vec<Vertex> {
        let side = SIDE as i64 * 256;
        vertices
            .iter()
            .map(|v| vertex(side - i64::from(v.y().to_bits()), v.x().to_bits().into(), v.shade().to_bits().into(), 0))
            .collect()
    };
    let most = |a: &[Option<u8>], b: &[Option<u8>]| {
        let both = a.iter().zip(b).filter_map(|(a, b)| Some((*a)?.abs_diff((*b)?)));
        both.max().unwrap_or(0)
    };
    let mut greatest = 0;
    while tried.more() {
        // A diamond with a corner near each side of the frame, alternately light and dark.
        let mut near = || random.within(0, 2000);
        let (far, middle) = (SIDE as i64 * 256, SIDE as i64 * 128);
        let corners = [
            (middle + near(), near()),
            (far - near(), middle + near()),
            (middle - near(), far - near()),
            (near(), middle - near()),
        ];
        let shades = [near(), 0xFF00 - near(), near(), 0xFF00 - near()];
        let quad: Vec<Vertex> = corners.iter().zip(shades).map(|(&(x, y), shade)| vertex(x, y, shade, 0)).collect();
        let quad_turned = quarter(&quad);
        // Each is within three quarters of a shade of the same exact plane, so they are within one of each other after
        // rounding.
        assert!(most(&turned(&as_triangles(&quad), SIDE), &as_triangles(&quad_turned)) <= 1, "{quad:?}");
        greatest = greatest.max(most(&turned(&as_table(&quad), SIDE), &as_table(&quad_turned)));
        // In a triangle the table's shades are those of the plane, so they rotate with it too. Its height over any side
        // is at least 16 pixels, so shades change by at most 16 per pixel, and rounding a crossing by 1/256 pixel moves
        // a shade by 1/16: with three quarters each still less than two.
        let half = &quad[..3];
        assert!(most(&turned(&as_table(half), SIDE), &as_table(&quarter(half))) <= 1, "{half:?}");
    }
    assert!(greatest > 100, "as a table the quad's shades depend on the turn, by {greatest} shades");
    println!("n8: as a table a quad's shade changes with the turn by up to {greatest} shades");
}
