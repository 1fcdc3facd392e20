//! The slow oracle of the raster: the definitions, pixel by pixel, in i128. It shares nothing with the
//! raster but the vertices.

use crate::record::Record;
use mode13h::raster::{Interpolation, Rect, Vertex};

type Point = (i128, i128);

/// Twice the signed area of a → b → p; positive when p lies to the right of a → b on a screen whose y
/// runs down.
fn edge(a: Point, b: Point, p: Point) -> i128 {
    (b.0 - a.0) * (p.1 - a.1) - (b.1 - a.1) * (p.0 - a.0)
}

/// The centre of a pixel in 1/256 pixel.
fn centre(x: i32, y: i32) -> Point {
    (i128::from(x) * 256 + 128, i128::from(y) * 256 + 128)
}

fn points(vertices: &[Vertex; 3]) -> [Point; 3] {
    vertices.each_ref().map(|v| (i128::from(v.x().to_bits()), i128::from(v.y().to_bits())))
}

/// Returns whether a pixel is drawn: its centre is inside, or on a top or a left edge.
fn covers(triangle: [Point; 3], p: Point) -> bool {
    let [a, mut b, mut c] = triangle;
    let area = edge(a, b, c);
    if area < 0 {
        std::mem::swap(&mut b, &mut c);
    }
    area != 0
        && [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| {
            // Clockwise on the screen: a left edge runs up, a top edge runs right.
            let top_or_left = to.1 < from.1 || (to.1 == from.1 && to.0 > from.0);
            let side = edge(from, to, p);
            side > 0 || (side == 0 && top_or_left)
        })
}

/// A pixel that a triangle draws.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pixel {
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) byte: u8,
    pub(super) depth: u32,
}

/// A value over a triangle, `n / d` exactly, at a point: the weights are the areas opposite to the
/// vertices.
fn interpolate(triangle: [Point; 3], values: [i128; 3], p: Point) -> (i128, i128) {
    let [a, b, c] = triangle;
    let area = edge(a, b, c);
    let n = values[0] * edge(b, c, p) + values[1] * edge(c, a, p) + values[2] * edge(a, b, p);
    (n * area.signum(), area.abs())
}

/// Calls `pixel` for all pixels that a triangle draws in a frame of `width × height`, row by row.
pub(super) fn draw(
    vertices: &[Vertex; 3],
    interpolation: Interpolation,
    (width, height): (u32, u32),
    mut pixel: impl FnMut(Pixel),
) {
    let mut pixel = |x: i32, y: i32, byte: u8| {
        pixel(Pixel { x: x as u32, y: y as u32, byte, depth: depth_at(vertices, x, y) });
    };
    if interpolation == Interpolation::GouraudVintage {
        return vintage(vertices, (width as i32, height as i32), pixel);
    }
    let triangle = points(vertices);
    let shades = vertices.each_ref().map(|v| i128::from(v.shade().to_bits()));
    // Weighted by the depths, which stand for 1/w.
    let depths = vertices.each_ref().map(|v| i128::from(v.depth().max(1)));
    let products = [0, 1, 2].map(|i| depths[i] * shades[i]);
    // No pixel further out than the vertices' own, and none outside the frame: in range of an i32.
    let range = |of: fn(&Point) -> i128, size: u32| {
        let pixels = triangle.each_ref().map(|p| of(p).div_euclid(256));
        let [low, high] = [pixels.into_iter().min(), pixels.into_iter().max()].map(Option::unwrap_or_default);
        low.max(0) as i32..(high + 1).min(i128::from(size)).max(0) as i32
    };
    for y in range(|p| p.1, height) {
        let covered: Vec<i32> = range(|p| p.0, width).filter(|&x| covers(triangle, centre(x, y))).collect();
        let (Some(&first), Some(&last)) = (covered.first(), covered.last()) else { continue };
        let mut sum = 0;
        for x in covered {
            // A sum out of range shows as a byte that no drawing has.
            let byte = match interpolation {
                Interpolation::Flat(index) => index,
                Interpolation::GouraudHyperbolic => {
                    let ((n, _), (d, _)) =
                        (interpolate(triangle, products, centre(x, y)), interpolate(triangle, depths, centre(x, y)));
                    (n + 128 * d).div_euclid(256 * d) as u8
                }
                Interpolation::Float => float(vertices, first, last, x, y),
                _ => {
                    // In units of 1/256 shade, or of 1/65,536.
                    let bits = if interpolation == Interpolation::Gouraud1616 { 16 } else { 8 };
                    let values = shades.map(|shade| shade << (bits - 8));
                    let ((here, area), (there, _)) =
                        (interpolate(triangle, values, centre(x, y)), interpolate(triangle, values, centre(x + 1, y)));
                    let starts =
                        x == first || (interpolation == Interpolation::GouraudReseeded && (x - first) % 64 == 0);
                    sum = match starts {
                        // Back toward where the shades come from.
                        true if there < here => -(-here).div_euclid(area),
                        true => here.div_euclid(area),
                        false => sum + (there - here) / area,
                    };
                    ((sum + (1 << (bits - 1))) >> bits) as u8
                }
            };
            pixel(x, y, byte);
        }
    }
}

/// The byte of [`raster::float`](mode13h::raster::float), of a row that covers the columns `first` to `last`.
fn float(vertices: &[Vertex; 3], first: i32, last: i32, x: i32, y: i32) -> u8 {
    let mut order = *vertices;
    order.sort_by_key(|v| (v.y(), v.x()));
    let triangle = points(&order);
    let depths = order.each_ref().map(|v| i128::from(v.depth().max(1)));
    let shades = order.each_ref().map(|v| i128::from(v.shade().to_bits()));
    let products = [0, 1, 2].map(|i| depths[i] * shades[i]);
    // A sum over the corners, each weighted by the part of the triangle that lies opposite.
    let one = |i: usize| [0, 1, 2].map(|k| i128::from(i == k));
    let at = |values: [i128; 3], x: i32| interpolate(triangle, values, centre(x, y)).0;
    let step = |values: [i128; 3]| (at(values, x + 1) - at(values, x)) as f32;
    let start = if step(depths) < 0.0 { last } else { first };
    let sum = |values: [i128; 3]| {
        let [a, b, c] = [0, 1, 2].map(|i| at(one(i), start) as f64 * values[i] as f64);
        (a + b + c) as f32
    };
    let k = (x - start) as f32;
    // n in 1/256 shade: a power of two changes no rounding.
    let quotient = (sum(products) + k * step(products)) / (sum(depths) + k * step(depths)) / 256.0;
    let range = shades.map(|shade| shade as f32 / 256.0);
    let shade = quotient.max(range[0].min(range[1]).min(range[2])).min(range[0].max(range[1]).max(range[2]));
    // Rounded to 15 bits behind the point, and cut.
    (shade + 256.5) as u16 as u8
}

/// The pixels of [`raster::vintage`](mode13h::raster::vintage), row by row with one addition for each edge.
fn vintage(vertices: &[Vertex; 3], (width, height): (i32, i32), mut pixel: impl FnMut(i32, i32, u8)) {
    let triangle = points(vertices);
    let mut order = *vertices;
    order.sort_by_key(|v| (v.y(), v.x()));
    let corners = order.each_ref().map(|v| {
        let whole = |units: i32| (units + 128).div_euclid(256);
        (whole(v.x().to_bits()), whole(v.y().to_bits()), i32::from(v.shade().to_bits()))
    });
    let [a, b, c] = corners.map(|(x, y, _)| (i128::from(x), i128::from(y)));
    let turn = edge(a, c, b);
    if edge(triangle[0], triangle[1], triangle[2]) == 0 || turn == 0 {
        return;
    }
    let rows = |from: (i32, i32, i32), to: (i32, i32, i32)| {
        let count = to.1 - from.1;
        let (mut x, mut shade) = (from.0 * 65_536, from.2);
        let mut rows = Vec::new();
        for _ in 0..count {
            rows.push((x.div_euclid(65_536), shade));
            x += (to.0 - from.0) * 65_536 / count;
            shade += (to.2 - from.2) / count;
        }
        rows
    };
    let [top, middle, bottom] = corners;
    let long = rows(top, bottom);
    let mut short = rows(top, middle);
    short.extend(rows(middle, bottom));
    for (y, (long, short)) in (top.1..).zip(long.into_iter().zip(short)) {
        // The middle corner lies to the left of a way down on the screen, or to the right.
        let ((ax, a_shade), (bx, b_shade)) = if turn > 0 { (short, long) } else { (long, short) };
        for x in ax..bx {
            if (0..width).contains(&x) && (0..height).contains(&y) {
                pixel(x, y, ((a_shade + (x - ax) * ((b_shade - a_shade) / (bx - ax))) / 256) as u8);
            }
        }
    }
}

/// The depth at a pixel: the definition in [`raster::depth`](mode13h::raster::depth).
fn depth_at(vertices: &[Vertex; 3], x: i32, y: i32) -> u32 {
    let mut order = *vertices;
    order.sort_by_key(|v| (v.y(), v.x()));
    let [p0, p1, p2] = points(&order);
    let [d0, d1, d2] = order.each_ref().map(|v| i128::from(v.depth()));
    let area = edge(p0, p1, p2);
    let nearest = |n: i128| (((n * area.signum()) << 24) + area.abs() / 2).div_euclid(area.abs());
    let gx = nearest((d1 - d0) * (p2.1 - p0.1) - (d2 - d0) * (p1.1 - p0.1));
    let gy = nearest((d2 - d0) * (p1.0 - p0.0) - (d1 - d0) * (p2.0 - p0.0));
    let c = centre(x, y);
    let sum = (d0 << 24) + gx * (c.0 - p0.0) + gy * (c.1 - p0.1) + (1 << 23);
    // Within the vertices' own depths at a centre that is covered; elsewhere it wraps.
    (sum >> 24) as u32
}

/// A frame by the oracle.
pub(super) struct Drawing {
    /// The bytes, row-major.
    pub(super) pixels: Vec<u8>,
    /// The triangle that each pixel shows.
    pub(super) owners: Vec<Option<usize>>,
    /// Number of times each pixel is covered.
    pub(super) covered: Vec<u32>,
}

/// Depth test: whether a triangle may write a pixel that holds a depth.
pub(super) type Test = fn(new: u32, old: u32) -> bool;

/// The nearest wins, of equal ones the first; 0 is nothing.
pub(super) const NEAREST: Test = |new, old| new > old;
/// The last wins.
pub(super) const LAST: Test = |_, _| true;

/// A record's frame.
pub(super) fn frame(record: &Record, test: Test) -> Drawing {
    let (width, height) = (record.width(), record.height());
    let clip = record.clip().unwrap_or(Rect { x0: 0, y0: 0, x1: width, y1: height });
    let count = width as usize * height as usize;
    let mut depths = vec![0; count];
    let mut drawing =
        Drawing { pixels: vec![record.background; count], owners: vec![None; count], covered: vec![0; count] };
    for (number, (vertices, interpolation)) in record.triangles.iter().enumerate() {
        draw(vertices, *interpolation, (width, height), |pixel| {
            let Pixel { x, y, byte, depth } = pixel;
            if !(clip.x0..clip.x1).contains(&x) || !(clip.y0..clip.y1).contains(&y) {
                return;
            }
            let place = y as usize * width as usize + x as usize;
            drawing.covered[place] = drawing.covered[place].saturating_add(1);
            if test(depth, depths[place]) {
                depths[place] = depth;
                drawing.pixels[place] = byte;
                drawing.owners[place] = Some(number);
            }
        });
    }
    drawing
}
