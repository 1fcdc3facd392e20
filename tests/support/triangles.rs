//! Triangles for the tests of the raster: plain, thin, small, large, on the grid of centres.

use mode13h::fixed::{I24F8, U8F8};
use mode13h::raster::{Cell, DrawStats, Frame, Interpolation, Raster, Rect, Vertex};

use mode13h_conformance::Random;
use mode13h_conformance::oracle;

pub fn vertex(x: i64, y: i64, shade: i64, depth: i64) -> Vertex {
    Vertex::new(
        I24F8::from_bits(i32::try_from(x).expect("a coordinate")),
        I24F8::from_bits(i32::try_from(y).expect("a coordinate")),
        U8F8::from_bits(u16::try_from(shade).expect("a shade")),
        u32::try_from(depth).expect("a depth"),
    )
    .expect("inside the guard band")
}

/// The ends of an edge along (dx, dy), or a whole fraction of it, that passes a point as closely as an edge can: the
/// point and the two ends span twice the area `side`, in square units, 1 or −1.
pub fn edge_beside((x, y): (i64, i64), (dx, dy): (i64, i64), side: i64) -> [(i64, i64); 2] {
    let (divisor, v, u) = euclid(dx, dy);
    let (dx, dy) = (dx / divisor, dy / divisor);
    // dx·v − dy·u = `side`, also for points a whole edge further on.
    let (u, v) = (-u * side, v * side);
    let (u, v) = if v * dy.signum() < 0 { (u + dx, v + dy) } else { (u, v) };
    let a = (x - u, y - v);
    [a, (a.0 + dx, a.1 + dy)]
}

/// Euclid's algorithm: the greatest common divisor g > 0, and x and y with a·x + b·y = g.
fn euclid(a: i64, b: i64) -> (i64, i64, i64) {
    if b == 0 {
        return (a.abs(), a.signum(), 0);
    }
    let (g, x, y) = euclid(b, a % b);
    (g, y, x - a / b * y)
}

/// A random triangle near a frame of `width × height` pixels; a third of them slivers.
pub fn triangle(random: &mut Random, width: i64, height: i64) -> [Vertex; 3] {
    const BAND: i64 = Vertex::GUARD_BAND as i64;
    let kind = random.within(0, 8);
    let reach = match kind {
        0 => BAND,
        _ => (random.log_uniform(16) as i64).min(width * 512),
    };
    let (cx, cy) = (random.within(-2000, width * 256 + 2000), random.within(-2000, height * 256 + 2000));
    let mut place = || {
        let (x, y) = (cx + random.within(-reach, reach), cy + random.within(-reach, reach));
        // Every fourth kind on centres, corners and sixteenths.
        let snap = match kind {
            1 => 128,
            2 => 16,
            _ => 1,
        };
        ((x / snap * snap).clamp(-BAND, BAND), (y / snap * snap).clamp(-BAND, BAND))
    };
    let (a, mut b, mut c) = (place(), place(), place());
    if (3..6).contains(&kind) {
        // A sliver: c is within a few units of a–b.
        let t = random.unit();
        c = (a.0 + ((b.0 - a.0) as f64 * t) as i64, a.1 + ((b.1 - a.1) as f64 * t) as i64);
        c.0 = (c.0 + random.within(-3, 3)).clamp(-BAND, BAND);
        c.1 = (c.1 + random.within(-3, 3)).clamp(-BAND, BAND);
    }
    if kind == 6 {
        // An edge along a row or a column.
        if random.within(0, 1) == 0 { b.1 = a.1 } else { b.0 = a.0 }
    }
    [a, b, c].map(|(x, y)| {
        let shade = shade(random);
        let depth = random.log_uniform(30) as i64;
        vertex(x, y, shade, depth)
    })
}

/// A random shade, in one of four cases the least or the greatest.
pub fn shade(random: &mut Random) -> i64 {
    match random.within(0, 3) {
        0 => random.one_of(&[0, 0xFF00]),
        _ => random.within(0, 0xFF00),
    }
}

/// A random part of a frame of `width × height` pixels, perhaps empty.
pub fn rect(random: &mut Random, width: u32, height: u32) -> Rect {
    let mut ends = |size: u32| {
        let (a, b) = (random.within(0, size.into()) as u32, random.within(0, size.into()) as u32);
        (a.min(b), a.max(b))
    };
    let ((x0, x1), (y0, y1)) = (ends(width), ends(height));
    Rect { x0, y0, x1, y1 }
}

pub fn contains(rect: Rect, x: u32, y: u32) -> bool {
    (rect.x0..rect.x1).contains(&x) && (rect.y0..rect.y1).contains(&y)
}

/// Removes what lies outside a rectangle from the bytes of a frame.
pub fn clip_to(bytes: &mut [u8], width: u32, clip: Rect, empty: u8) {
    for (place, byte) in (0..).zip(bytes) {
        if !contains(clip, place % width, place / width) {
            *byte = empty;
        }
    }
}

/// The bytes that are drawn, found by drawing over two backgrounds: what is equal on both was drawn.
pub fn drawn(mut over: impl FnMut(u8) -> Vec<u8>) -> Vec<Option<u8>> {
    over(0).into_iter().zip(over(1)).map(|(on_0, on_1)| (on_0 == on_1).then_some(on_0)).collect()
}

/// The bytes that the oracle draws.
pub fn drawn_by_the_oracle(
    vertices: &[Vertex; 3],
    interpolation: Interpolation,
    width: u32,
    height: u32,
) -> Vec<Option<u8>> {
    let mut bytes = vec![None; (width * height) as usize];
    for pixel in oracle::pixels(vertices, interpolation, width as i32, height as i32) {
        bytes[pixel.y as usize * width as usize + pixel.x as usize] = Some(pixel.byte);
    }
    bytes
}

/// Draws triangles one by one.
pub fn one_by_one<D: Cell>(raster: &mut Raster<'_, D>, triangles: &[([Vertex; 3], Interpolation)]) -> DrawStats {
    let mut sum = DrawStats::default();
    triangles.iter().for_each(|(vertices, interpolation)| sum += raster.triangle(vertices, *interpolation));
    sum
}

/// Draws triangles together.
pub fn together<D: Cell>(raster: &mut Raster<'_, D>, triangles: &[([Vertex; 3], Interpolation)]) -> DrawStats {
    raster.triangles(triangles.iter().map(|(vertices, interpolation)| (vertices, *interpolation)))
}

/// What a triangle draws into a frame full of `empty`, without a depth buffer.
pub fn draw(
    vertices: &[Vertex; 3],
    interpolation: Interpolation,
    width: u32,
    height: u32,
    clip: Option<Rect>,
    empty: u8,
) -> Vec<u8> {
    let mut bytes = vec![empty; (width * height) as usize];
    let frame = Frame::new(&mut bytes, width, height, width as usize).expect("a legal frame");
    let mut raster = Raster::new(frame);
    if let Some(clip) = clip {
        raster = raster.with_clip(clip);
    }
    raster.triangle(vertices, interpolation);
    bytes
}
