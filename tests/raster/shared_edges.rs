//! R5: triangles that share edges draw each pixel inside exactly once and none outside; and their shades agree along
//! the edges (N9).

use crate::support::triangles::vertex;
use crate::support::tried::Tried;
use mode13h::internals::raster::reference::cover::SortedTriangle;
use mode13h::internals::raster::reference::shade::ShadePlane;
use mode13h::raster::{Rect, Vertex};
use mode13h_conformance::Random;
use mode13h_conformance::oracle::{self, Point};

const WIDTH: i32 = 80;
const HEIGHT: i32 = 60;

/// A polygon, and triangles that it is divided into.
struct Parted {
    outline: Vec<(i64, i64)>,
    triangles: Vec<[(i64, i64); 3]>,
}

/// Counts how often each pixel is drawn, and compares that with the outline.
fn check(parted: &Parted, tried: &mut Tried) {
    let mut counts = vec![0_u32; (WIDTH * HEIGHT) as usize];
    let clip = Rect { x0: 0, y0: 0, x1: WIDTH as u32, y1: HEIGHT as u32 };
    for corners in &parted.triangles {
        let vertices: [Vertex; 3] = corners.map(|(x, y)| vertex(x, y, 0, 0));
        SortedTriangle::new(&vertices).rows(WIDTH as u32, clip, |row| {
            assert!(row.x0 < row.x1, "a row without a pixel: {row:?} of {corners:?}");
            for x in row.x0..row.x1 {
                counts[(row.y * WIDTH + x) as usize] += 1;
            }
        });
    }
    let outline: Vec<Point> = parted.outline.iter().map(|&(x, y)| (i128::from(x), i128::from(y))).collect();
    let (mut holes, mut doubles, mut outside, mut first) = (0_u32, 0_u32, 0_u32, None);
    for y in 0..HEIGHT {
        for x in 0..WIDTH {
            let inside = oracle::polygon_covers(&outline, oracle::centre(x, y));
            let times = counts[(y * WIDTH + x) as usize];
            if times != u32::from(inside) {
                first.get_or_insert((x, y));
                holes += u32::from(inside && times == 0);
                doubles += u32::from(times > 1);
                outside += u32::from(!inside);
            }
        }
    }
    tried.worst("holes", f64::from(holes));
    tried.worst("double pixels", f64::from(doubles));
    tried.worst("pixels outside", f64::from(outside));
    assert_eq!(first, None, "a pixel that is not as it should be, triangles {:?}", parted.triangles);
}

fn place(random: &mut Random) -> (i64, i64) {
    let snap = random.one_of(&[1, 1, 16, 128, 256]);
    (random.within(-2000, 22_000) / snap * snap, random.within(-2000, 17_000) / snap * snap)
}

fn doubled_area(a: (i64, i64), b: (i64, i64), c: (i64, i64)) -> i64 {
    (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)
}

/// A star-shaped polygon, divided as a fan around its centre.
fn fan(random: &mut Random) -> Option<Parted> {
    let centre = place(random);
    let mut ring: Vec<(i64, i64)> = (0..random.within(3, 40)).map(|_| place(random)).collect();
    let angle = |p: &(i64, i64)| f64::atan2((p.1 - centre.1) as f64, (p.0 - centre.0) as f64);
    ring.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    let triangles: Vec<_> = (0..ring.len()).map(|i| [centre, ring[i], ring[(i + 1) % ring.len()]]).collect();
    // The centre must see every edge from the same side, in exact arithmetic.
    triangles.iter().all(|&[a, b, c]| doubled_area(a, b, c) > 0).then_some(Parted { outline: ring, triangles })
}

/// A strip between two chains, the upper one above the lower one everywhere.
fn strip(random: &mut Random) -> Option<Parted> {
    let columns = random.within(1, 20);
    let mut x = random.within(-3000, 5000);
    let (mut upper, mut lower) = (Vec::new(), Vec::new());
    for _ in 0..=columns {
        let y = random.within(-1000, 9000);
        upper.push((x, y));
        lower.push((x, y + random.log_uniform(13) as i64));
        x += random.log_uniform(12) as i64;
    }
    let mut triangles = Vec::new();
    for i in 0..columns as usize {
        triangles.push([upper[i], upper[i + 1], lower[i]]);
        triangles.push([upper[i + 1], lower[i + 1], lower[i]]);
    }
    // Where the chain leans so far that a triangle flips, they overlap.
    let turned = triangles.iter().any(|&[a, b, c]| doubled_area(a, b, c) <= 0);
    lower.reverse();
    upper.extend(lower);
    (!turned).then_some(Parted { outline: upper, triangles })
}

/// A grid of quads whose inner corners are displaced, each split along one diagonal.
fn grid(random: &mut Random) -> Option<Parted> {
    let (columns, rows) = (random.within(1, 12), random.within(1, 12));
    let (x0, y0) = place(random);
    let (w, h) = (random.log_uniform(12) as i64 + 3, random.log_uniform(12) as i64 + 3);
    let mut corner = vec![vec![(0, 0); columns as usize + 1]; rows as usize + 1];
    for (r, line) in corner.iter_mut().enumerate() {
        for (c, at) in line.iter_mut().enumerate() {
            let (r, c) = (r as i64, c as i64);
            let inner = r > 0 && r < rows && c > 0 && c < columns;
            let mut jitter = |size: i64| if inner { random.within(-size / 3, size / 3) } else { 0 };
            *at = (x0 + c * w + jitter(w), y0 + r * h + jitter(h));
        }
    }
    let mut triangles = Vec::new();
    for r in 0..rows as usize {
        for c in 0..columns as usize {
            let (a, b, d, e) = (corner[r][c], corner[r][c + 1], corner[r + 1][c], corner[r + 1][c + 1]);
            if random.within(0, 1) == 0 {
                triangles.extend([[a, b, d], [b, e, d]]);
            } else {
                triangles.extend([[a, b, e], [a, e, d]]);
            }
        }
    }
    let (right, below) = (x0 + columns * w, y0 + rows * h);
    let outline = vec![(x0, y0), (right, y0), (right, below), (x0, below)];
    let turned = triangles.iter().any(|&[a, b, c]| doubled_area(a, b, c) <= 0);
    (!turned).then_some(Parted { outline, triangles })
}

/// A triangle, split repeatedly at random points inside it, with some diagonals then flipped.
fn split(random: &mut Random) -> Option<Parted> {
    let outline = [place(random), place(random), place(random)];
    let [a, b, c] = outline;
    let first = if doubled_area(a, b, c) > 0 { [a, b, c] } else { [a, c, b] };
    if doubled_area(a, b, c) == 0 {
        return None;
    }
    let mut triangles = vec![first];
    for _ in 0..random.within(1, 30) {
        let chosen = random.within(0, triangles.len() as i64 - 1) as usize;
        let [a, b, c] = triangles[chosen];
        let (mut s, mut t) = (random.unit(), random.unit());
        if s + t > 1.0 {
            (s, t) = (1.0 - s, 1.0 - t);
        }
        let inner = |a: i64, b: i64, c: i64| a + ((b - a) as f64 * s) as i64 + ((c - a) as f64 * t) as i64;
        let p = (inner(a.0, b.0, c.0), inner(a.1, b.1, c.1));
        let parts = [[a, b, p], [b, c, p], [c, a, p]];
        if parts.iter().all(|&[a, b, c]| doubled_area(a, b, c) > 0) {
            triangles[chosen] = parts[0];
            triangles.extend(&parts[1..]);
        }
    }
    // Flip: two triangles a b p and b a q (sharing a–b) become p q b and q p a, if these are legal.
    for _ in 0..20 {
        let one = random.within(0, triangles.len() as i64 - 1) as usize;
        let [a, b, p] = triangles[one];
        let other = triangles.iter().position(|t| (0..3).any(|i| (t[i], t[(i + 1) % 3]) == (b, a)));
        let Some(other) = other else { continue };
        let q = triangles[other].into_iter().find(|v| *v != a && *v != b).expect("a third corner");
        if doubled_area(p, q, b) > 0 && doubled_area(q, p, a) > 0 {
            (triangles[one], triangles[other]) = ([p, q, b], [q, p, a]);
        }
    }
    Some(Parted { outline: outline.to_vec(), triangles })
}

fn shared_edges(mut tried: Tried, at_least: u64) {
    let mut random = Random::named("r5");
    let mut kinds = [0_u64; 4];
    while kinds.iter().sum::<u64>() < at_least {
        let kind = random.within(0, 3) as usize;
        let made = [fan, strip, grid, split][kind](&mut random);
        let Some(parted) = made else { continue };
        check(&parted, &mut tried);
        kinds[kind] += parted.triangles.len() as u64;
    }
    tried.add(kinds.iter().sum());
    assert!(kinds.iter().all(|&triangles| triangles > at_least / 50), "every kind was tried: {kinds:?}");
}

#[test]
fn r5_shared_edges() {
    shared_edges(Tried::new("r5_shared_edges", 20_000), 20_000);
}

#[test]
#[ignore = "the long run: 10,000,000 triangles"]
fn r5_long_shared_edges() {
    shared_edges(Tried::new("r5_long_shared_edges", 10_000_000), 10_000_000);
}

/// The Russian article says that the intensity jumps at face borders (slip 5). With shared vertices it does not: along
/// the common edge the planes of both faces agree to within the rounding of a shade.
#[test]
fn n9_slip_5_two_faces_agree_along_their_edge() {
    let mut tried = Tried::new("n9_slip_5_two_faces_agree_along_their_edge", 3000);
    let mut random = Random::named("n9");
    let mut centres = 0;
    while tried.more() {
        // An edge through pixel centres, and the centres on it from one end to the other.
        let (parts, dx, dy) = (random.within(1, 12), random.within(-12, 12), random.within(-12, 12));
        let (x, y) = (random.within(0, 200), random.within(0, 100));
        let shade = |random: &mut Random| random.within(0, 0xFF00);
        let ends =
            [0, parts].map(|k| vertex((x + k * dx) * 256 + 128, (y + k * dy) * 256 + 128, shade(&mut random), 1));
        let sides = [1, -1].map(|side| {
            // On either side of the edge, anywhere.
            let (along, off) = (random.within(-20_000, 20_000), side * random.log_uniform(14) as i64);
            let third = vertex(
                x * 256 + along * dx / 12 - off * dy,
                y * 256 + along * dy / 12 + off * dx,
                shade(&mut random),
                1,
            );
            [ends[0], ends[1], third]
        });
        let [Some(one), Some(two)] = sides.map(|vertices| {
            let ordered = SortedTriangle::new(&vertices);
            (ordered.doubled_area != 0).then(|| ShadePlane::new(&ordered))
        }) else {
            continue;
        };
        for k in 0..=parts {
            let (x, y) = ((x + k * dx) as i32, (y + k * dy) as i32);
            // In exact arithmetic the two are equal; each start is rounded by less than 1/256 shade.
            let shades = ends.map(|v| i64::from(v.shade().to_bits()));
            let exact = (shades[0] * (parts - k) + shades[1] * k) as f64 / parts as f64 + 128.0;
            for start in [one.start(x, y), two.start(x, y)] {
                assert!((f64::from(start) - exact).abs() < 1.0, "{start} for {exact} at ({x}, {y}) of {sides:?}");
            }
            centres += 1;
        }
    }
    assert!(centres > 10_000, "{centres}");
}
