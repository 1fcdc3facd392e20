//! The slow oracle of the raster: the definitions, pixel by pixel, in i128. It shares nothing with the
//! raster but the vertices.

use crate::raster::{Rect, Shading, Vertex};
use crate::record::Record;

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

/// Whether a pixel is drawn: its centre is inside, or on a top or a left edge.
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
    shading: Shading,
    (width, height): (u32, u32),
    mut pixel: impl FnMut(Pixel),
) {
    let triangle = points(vertices);
    let shades = vertices.each_ref().map(|v| i128::from(v.shade().to_bits()));
    // No pixel further out than the vertices' own, and none outside the frame: in range of an i32.
    let range = |of: fn(&Point) -> i128, size: u32| {
        let pixels = triangle.each_ref().map(|p| of(p).div_euclid(256));
        let [low, high] = [pixels.into_iter().min(), pixels.into_iter().max()].map(Option::unwrap_or_default);
        low.max(0) as i32..(high + 1).min(i128::from(size)).max(0) as i32
    };
    for y in range(|p| p.1, height) {
        let (mut first, mut sum) = (None, 0);
        for x in range(|p| p.0, width) {
            if !covers(triangle, centre(x, y)) {
                continue;
            }
            let byte = match shading {
                Shading::Flat(index) => index,
                Shading::Gouraud | Shading::GouraudReseeded => {
                    let f = *first.get_or_insert(x);
                    let ((here, area), (there, _)) =
                        (interpolate(triangle, shades, centre(x, y)), interpolate(triangle, shades, centre(x + 1, y)));
                    let starts = x == f || (shading == Shading::GouraudReseeded && (x - f) % 64 == 0);
                    sum = match starts {
                        // Back toward where the shades come from.
                        true if there < here => -(-here).div_euclid(area),
                        true => here.div_euclid(area),
                        false => sum + (there - here) / area,
                    };
                    // A sum out of range shows as a byte that no drawing has.
                    ((sum + 128) >> 8) as u8
                }
                Shading::GouraudHyperbolic => {
                    let depths = vertices.each_ref().map(|v| i128::from(v.depth().max(1)));
                    let products = [0, 1, 2].map(|i| depths[i] * shades[i]);
                    let ((n, _), (d, _)) =
                        (interpolate(triangle, products, centre(x, y)), interpolate(triangle, depths, centre(x, y)));
                    (n + 128 * d).div_euclid(256 * d) as u8
                }
            };
            pixel(Pixel { x: x as u32, y: y as u32, byte, depth: depth_at(vertices, x, y) });
        }
    }
}

/// The depth at a covered pixel: the definition in [`raster::depth`](crate::raster::depth).
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
    // Within the vertices' own depths.
    (sum >> 24) as u32
}

/// A frame by the oracle.
pub(super) struct Drawing {
    /// The bytes, row-major.
    pub(super) pixels: Vec<u8>,
    /// Of each pixel the triangle that it shows.
    pub(super) owners: Vec<Option<usize>>,
    /// How often each pixel is covered.
    pub(super) covered: Vec<u32>,
}

/// Whether a triangle may write a pixel that holds a depth.
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
    for (number, (vertices, shading)) in record.triangles.iter().enumerate() {
        draw(vertices, *shading, (width, height), |pixel| {
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
