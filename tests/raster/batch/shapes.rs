//! Shapes of triangles that are hard for a batch, in three classes.

use std::f64::consts::{FRAC_PI_2, TAU};

use mode13h::raster::Vertex;

use crate::support::triangles::{edge_beside, vertex};
use mode13h_conformance::Random;

const BAND: i64 = Vertex::GUARD_BAND as i64;

/// Class of a triangle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Class {
    /// At most a few units wide.
    Sliver,
    /// With a corner on or next to the guard band's edge.
    Far,
    /// Part of a fan or a strip, whose neighbours share its edges.
    Shared,
}

pub(crate) const CLASSES: [Class; 3] = [Class::Sliver, Class::Far, Class::Shared];

type Point = (i64, i64);

/// One triangle, or the triangles of a fan or a strip, in or near a frame of `width × height` pixels.
pub(crate) fn shape(random: &mut Random, class: Class, (width, height): (i64, i64)) -> Vec<[Vertex; 3]> {
    let is_beside = random.within(0, 2) == 0;
    let points = match class {
        Class::Sliver if is_beside => {
            let [a, b] = beside_a_centre(random, (width, height));
            vec![[a, b, (b.0 + random.within(-2, 2), b.1 + random.within(-2, 2))]]
        }
        Class::Sliver => vec![sliver(random, (width, height))],
        Class::Far => vec![far(random, (width, height))],
        Class::Shared if is_beside => {
            let [a, b] = beside_a_centre(random, (width, height));
            let [c, d] = [0; 2].map(|_| (a.0 + reach(random) * random.one_of(&[-1, 1]), a.1 + reach(random)));
            vec![[a, b, c], [b, a, d]]
        }
        Class::Shared => shared(random, (width, height)),
    };
    // Anywhere, on sixteenths, on pixel centres, or one unit beside them: edges through centres are what the fill rule
    // decides.
    let (snap, beside) = if is_beside { (1, 0) } else { random.one_of(&[(1, 0), (1, 0), (16, 0), (256, 0), (256, 1)]) };
    let snapped = |c: i64, random: &mut Random| {
        let c = if snap == 256 { (c & !255) + 128 + random.within(-beside, beside) } else { c / snap * snap };
        c.clamp(-BAND, BAND)
    };
    let depths = depths(random);
    // One in three has a single shade, on the border between two bytes.
    let level = random.one_of(&[None, None, Some(())]).map(|()| border(random));
    let corner = |(x, y): Point, random: &mut Random| {
        let shade = level.unwrap_or_else(|| shade(random));
        vertex(snapped(x, random), snapped(y, random), shade, depths(random))
    };
    points.into_iter().map(|three| three.map(|point| corner(point, random))).collect()
}

/// A depth for each corner: equal or not, some next to multiples of 2¹⁴, where 16-bit depths change.
fn depths(random: &mut Random) -> impl Fn(&mut Random) -> i64 + use<> {
    let level = (random.within(0, 3) << 14) + random.within(-1, 1);
    let level = random.one_of(&[None, None, Some(9), Some(level.max(0))]);
    let bits = random.one_of(&[15, 30, 32]);
    move |random| level.unwrap_or_else(|| random.log_uniform(bits) as i64)
}

/// A shade: 0, 255, on the border between two bytes, or random.
fn shade(random: &mut Random) -> i64 {
    let any = random.within(0, 0xFF00);
    let border = border(random);
    random.one_of(&[0, 0xFF00, border, any, any, any])
}

/// A shade next to the border between two bytes.
fn border(random: &mut Random) -> i64 {
    (random.within(0, 0xFE) << 8) + random.within(127, 128)
}

/// A length in units: from a quarter of a pixel to 256 pixels, mostly a few pixels.
fn reach(random: &mut Random) -> i64 {
    let octaves = random.one_of(&[6, 6, 10]);
    (random.log_uniform(octaves) << 6) as i64 + random.within(0, 63)
}

/// A point in the frame or a few pixels outside it.
fn near(random: &mut Random, (width, height): Point) -> Point {
    (random.within(-600, width * 256 + 600), random.within(-600, height * 256 + 600))
}

/// A triangle through a pixel's centre, at most two units across.
fn sliver(random: &mut Random, (width, height): Point) -> [Point; 3] {
    let (x, y) = (random.within(0, width - 1) * 256 + 128, random.within(0, height - 1) * 256 + 128);
    let length = reach(random) as f64;
    let turn = random.unit() * TAU;
    // One in four horizontal or vertical.
    let turn = random.one_of(&[turn, turn, turn, (turn * 4.0 / TAU).floor() * FRAC_PI_2]);
    let along = |t: f64| (x + (turn.cos() * length * t).round() as i64, y + (turn.sin() * length * t).round() as i64);
    let back = random.unit();
    let (a, b, middle) = (along(-back), along(1.0 - back), along(random.unit() - back));
    [a, (middle.0 + random.within(-2, 2), middle.1 + random.within(-2, 2)), b]
}

/// An edge that passes a pixel's centre as closely as an edge can without touching it.
fn beside_a_centre(random: &mut Random, (width, height): Point) -> [Point; 2] {
    let centre = (random.within(0, width - 1) * 256 + 128, random.within(0, height - 1) * 256 + 128);
    let along = (reach(random) * random.one_of(&[-1, 1]), reach(random));
    let side = random.one_of(&[-1, 1]);
    edge_beside(centre, along, side)
}

/// A triangle with a corner on the guard band's edge or just inside it.
fn far(random: &mut Random, frame: Point) -> [Point; 3] {
    let away = |random: &mut Random| {
        let less = random.log_uniform(12) as i64 - 1;
        let (edge, along) = (random.one_of(&[-1, 1]) * (BAND - less), random.within(-BAND, BAND));
        // One in four close to the frame's own rows or columns, so that long ones are also thin.
        let close = random.within(-2_000, 20_000);
        let along = random.one_of(&[along, along, along, close]);
        if random.within(0, 1) == 0 { (edge, along) } else { (along, edge) }
    };
    let [b, c] = [0; 2].map(|_| if random.within(0, 2) == 0 { away(random) } else { near(random, frame) });
    [away(random), b, c]
}

/// A fan around a point, or a strip.
fn shared(random: &mut Random, (width, height): Point) -> Vec<[Point; 3]> {
    let centre = near(random, (width, height));
    let count = random.within(2, 12);
    let reach = reach(random).min(width.max(height) * 256) as f64;
    let about = |turn: f64, random: &mut Random| {
        let reach = reach * (0.3 + 0.7 * random.unit());
        (centre.0 + (turn.cos() * reach) as i64, centre.1 + (turn.sin() * reach) as i64)
    };
    if random.within(0, 1) == 0 {
        let rim: Vec<Point> = (0..count).map(|i| about(i as f64 / count as f64 * TAU, random)).collect();
        return (0..rim.len()).map(|i| [centre, rim[i], rim[(i + 1) % rim.len()]]).collect();
    }
    let (across, down) = (random.within(-1, 1) as f64, random.within(-1, 1) as f64);
    let step = reach / 3.0;
    let zigzag: Vec<Point> = (0..count + 2)
        .map(|i| {
            let (side, i) = ((i % 2) as f64 - 0.5, i as f64);
            let (x, y) = (i * across * step + side * down * reach, i * down * step - side * across * reach);
            (centre.0 + x as i64, centre.1 + y as i64)
        })
        .collect();
    zigzag.windows(3).map(|three| [three[0], three[1], three[2]]).collect()
}

/// A triangle as large as a batch draws, and up to twice as wide and as high, whose rows begin at pixel centres with
/// shades that are whole numbers on the border between two bytes, so that the slightest error in a start shows. It lies
/// in the frame's first `SIDE` columns and rows.
pub(crate) fn with_exact_starts(random: &mut Random) -> [Vertex; 3] {
    let rows = random.within(SIDE * 3 / 8, SIDE - 2);
    // Shades change by whole units per row, by so much that some lie on the border.
    let per_row = random.one_of(&[1, 2, 4, 8, 16, 32, 48, 64, 85, 128]).min(0xFE00 / rows);
    let high = border(random).max(per_row * rows + 1);
    let low = high - per_row * rows;
    let (upper, lower) = if random.within(0, 1) == 0 { (high, low) } else { (low, high) };
    let any = shade(random);
    let third = random.one_of(&[0, 0, any]);
    let right = (random.within(SIDE / 2, SIDE - 1)) * 256;
    let at = |(x, y): Point, shade: i64, random: &mut Random| vertex(x, y, shade, random.log_uniform(30) as i64);
    let (top, bottom) = (128, 128 + rows * 256);
    if random.within(0, 1) == 0 {
        // A vertical edge on the left.
        let across = random.within(128, bottom);
        return [at((128, top), upper, random), at((128, bottom), lower, random), at((right, across), third, random)];
    }
    // A diagonal, above and left of which the plane extends to twice the range of shades.
    [at((bottom, top), upper, random), at((128, bottom), lower, random), at((bottom, bottom), third, random)]
}

/// Side of the largest square of `with_exact_starts`, in pixels.
pub(crate) const SIDE: i64 = 1_024;
