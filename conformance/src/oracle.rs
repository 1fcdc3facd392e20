//! The rasterizer's definitions, pixel by pixel in 128-bit integers, without regard to speed. They share nothing with
//! the rasterizer except the vertices.

use alloc::vec::Vec;

use mode13h::raster::{Interpolation, Vertex};

/// Vertex position in 1/256 pixel.
pub type Point = (i128, i128);

/// The position of a vertex.
pub fn point(v: &Vertex) -> Point {
    (i128::from(v.x().to_bits()), i128::from(v.y().to_bits()))
}

/// Twice the signed area of a → b → p; positive if p lies to the right of a → b on a screen whose y points down.
pub fn edge(a: Point, b: Point, p: Point) -> i128 {
    (b.0 - a.0) * (p.1 - a.1) - (b.1 - a.1) * (p.0 - a.0)
}

/// The centre of a pixel in 1/256 pixel.
pub fn centre(x: i32, y: i32) -> Point {
    (i128::from(x) * 256 + 128, i128::from(y) * 256 + 128)
}

/// Returns whether the pixel is drawn: its centre is inside, or on a top or left edge.
pub fn covers(triangle: [Point; 3], p: Point) -> bool {
    let [a, mut b, mut c] = triangle;
    let area = edge(a, b, c);
    if area == 0 {
        return false;
    }
    if area < 0 {
        core::mem::swap(&mut b, &mut c);
    }
    [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| {
        // Clockwise on the screen: a left edge runs up, a top edge runs right.
        let top_or_left = to.1 < from.1 || (to.1 == from.1 && to.0 > from.0);
        let side = edge(from, to, p);
        side > 0 || (side == 0 && top_or_left)
    })
}

/// Returns whether a centre lies inside a polygon, or on one of its top or left edges. Counts the crossings to the left
/// of it, in rows that include their upper end.
pub fn polygon_covers(polygon: &[Point], p: Point) -> bool {
    let mut inside = false;
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (upper, lower) = if a.1 < b.1 { (a, b) } else { (b, a) };
        // On the edge or to the right of it on the screen, which is to the left when walking down.
        if upper.1 <= p.1 && p.1 < lower.1 && edge(upper, lower, p) <= 0 {
            inside = !inside;
        }
    }
    inside
}

/// An exact value n / d with positive d.
#[derive(Clone, Copy, Debug)]
pub struct Ratio {
    /// The dividend.
    pub n: i128,
    /// The divisor.
    pub d: i128,
}

impl Ratio {
    /// The greatest integer not above it.
    pub fn floor(self) -> i128 {
        self.n.div_euclid(self.d)
    }

    /// The smallest integer not below it.
    pub fn ceil(self) -> i128 {
        -(-self.n).div_euclid(self.d)
    }

    /// Its integer part, rounded toward zero.
    pub fn truncate(self) -> i128 {
        self.n / self.d
    }

    /// Returns whether |self − whole| · d ≤ bound · d, with bound = bound_n / bound_d.
    pub fn is_within(self, whole: i128, bound_n: i128, bound_d: i128) -> bool {
        (self.n - whole * self.d).abs() * bound_d <= bound_n * self.d
    }
}

/// The exact value of a vertex attribute at a point, weighted by the areas opposite the vertices.
pub fn interpolate(triangle: [Point; 3], values: [i128; 3], p: Point) -> Ratio {
    let [a, b, c] = triangle;
    let area = edge(a, b, c);
    let n = values[0] * edge(b, c, p) + values[1] * edge(c, a, p) + values[2] * edge(a, b, p);
    Ratio { n: n * area.signum(), d: area.abs() }
}

/// The attribute's exact change per pixel along the row.
pub fn per_pixel(triangle: [Point; 3], values: [i128; 3]) -> Ratio {
    let at = |x| interpolate(triangle, values, centre(x, 0));
    Ratio { n: at(1).n - at(0).n, d: at(0).d }
}

/// A pixel that a triangle draws.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Pixel {
    /// The column.
    pub x: i32,
    /// The row.
    pub y: i32,
    /// The byte drawn there.
    pub byte: u8,
}

/// Returns whether this is `Interpolation::GouraudFloat`, which exists only with `alloc`.
fn is_float(interpolation: Interpolation) -> bool {
    interpolation.name() == "gouraud-float"
}

/// How far a shading's byte may be from the exact shade in a frame of `width` columns, in 1/256 shade, as n / d; `None`
/// where nothing is promised.
pub fn bound(interpolation: Interpolation, width: i128) -> Option<(i128, i128)> {
    match interpolation {
        // A half from rounding to a byte, and less than 1/256 for the start and for each step.
        Interpolation::Gouraud88 => Some((128 + width, 1)),
        Interpolation::Gouraud88Reseeded => Some((128 + 64, 1)),
        // The same, with 1/65,536.
        Interpolation::Gouraud1616 => Some((128 * 256 + width, 256)),
        Interpolation::GouraudHyperbolic => Some((128, 1)),
        // Less than 1/8,192 on top of the half.
        _ if is_float(interpolation) => Some((128 * 32 + 1, 32)),
        _ => None,
    }
}

/// The exact shade of a covered pixel in 1/256: the value that `interpolation` interpolates, without its rounding.
pub fn exact_shade(vertices: &[Vertex; 3], interpolation: Interpolation, p: Point) -> Ratio {
    Shades::of_vertices(vertices, interpolation).exact(p)
}

/// A row of a triangle on whole pixels: Ax, Bx, As and Bs.
type VintageRow = [i64; 4];

/// A value over a triangle, following each shading's definition to the letter.
pub struct Shades {
    interpolation: Interpolation,
    /// The vertices and their values, from top to bottom; those at the same height from left to right.
    triangle: [Point; 3],
    values: [i128; 3],
    /// The value's change per pixel along a row.
    slope: Ratio,
    /// The first row and all rows, for `GouraudVintage`.
    top: i64,
    rows: Vec<VintageRow>,
    depths: [i128; 3],
}

impl Shades {
    /// The shades of these vertices.
    pub fn of_vertices(vertices: &[Vertex; 3], interpolation: Interpolation) -> Self {
        Self::new(vertices, vertices.each_ref().map(|v| v.shade().to_bits()), interpolation)
    }

    /// These values at the vertices.
    pub fn new(vertices: &[Vertex; 3], values: [u16; 3], interpolation: Interpolation) -> Self {
        let mut order = [0, 1, 2];
        order.sort_by_key(|&i| (vertices[i].y(), vertices[i].x()));
        let triangle = order.map(|i| point(&vertices[i]));
        let values = order.map(|i| i128::from(values[i]));
        let (top, rows) = if interpolation == Interpolation::GouraudVintage {
            vintage_rows(triangle, values)
        } else {
            (0, Vec::new())
        };
        let depths = order.map(|i| i128::from(vertices[i].depth().max(1)));
        Self { interpolation, triangle, values, slope: per_pixel(triangle, values), top, rows, depths }
    }

    /// The exact value.
    pub fn exact(&self, p: Point) -> Ratio {
        match self.interpolation {
            // Weighted by the depths, which are proportional to 1/w.
            Interpolation::GouraudHyperbolic => self.on_face(p),
            _ if is_float(self.interpolation) => self.on_face(p),
            _ => interpolate(self.triangle, self.values, p),
        }
    }

    fn on_face(&self, p: Point) -> Ratio {
        let products = [0, 1, 2].map(|i| self.depths[i] * self.values[i]);
        Ratio { n: interpolate(self.triangle, products, p).n, d: interpolate(self.triangle, self.depths, p).n }
    }

    /// The byte of a covered pixel in a row whose first and last covered pixels in the frame are `first` and `last`;
    /// with dither, at this threshold.
    pub fn byte(&self, (first, last): (i32, i32), x: i32, y: i32, threshold: Option<u8>) -> u8 {
        let half = i128::from(threshold.unwrap_or(128));
        let byte = match self.interpolation {
            Interpolation::Flat(byte) => byte.into(),
            Interpolation::GouraudVintage => (self.vintage(x, y) + i128::from(threshold.unwrap_or(0))) >> 8,
            Interpolation::GouraudHyperbolic => {
                let exact = self.exact(centre(x, y));
                Ratio { n: exact.n + half * exact.d, d: 256 * exact.d }.floor()
            }
            _ if is_float(self.interpolation) => {
                let shade = self.float(first, last, x, y);
                match threshold {
                    // Added in f32, then truncated.
                    None => i128::from((shade + 256.5) as u16) - 256,
                    Some(threshold) => ((shade * 256.0) as i128 + i128::from(threshold)) >> 8,
                }
            }
            _ => {
                // In 1/256 shade or in 1/65,536.
                let finer = if self.interpolation == Interpolation::Gouraud1616 { 256 } else { 1 };
                let seed = match self.interpolation {
                    Interpolation::Gouraud88Reseeded => first + (x - first) / 64 * 64,
                    _ => first,
                };
                let finer_of = |exact: Ratio| Ratio { n: exact.n * finer, d: exact.d };
                let (start, slope) = (finer_of(self.exact(centre(seed, y))), finer_of(self.slope));
                let start = if slope.n < 0 { start.ceil() } else { start.floor() };
                (start + slope.truncate() * i128::from(x - seed) + half * finer).div_euclid(256 * finer)
            }
        };
        u8::try_from(byte).expect("a shade in range is a byte")
    }

    /// shade/w over 1/w in f32, from the far end of the row.
    fn float(&self, first: i32, last: i32, x: i32, y: i32) -> f32 {
        let one = |i: usize| [0, 1, 2].map(|k| i128::from(k == i));
        let at = |values: [i128; 3], x: i32| interpolate(self.triangle, values, centre(x, y)).n;
        let step = |values: [i128; 3]| at(values, x + 1) - at(values, x);
        let start = if step(self.depths) < 0 { last } else { first };
        // Summed in f64 over the vertices from top to bottom; areas and products are exact in it.
        let sum = |values: [i128; 3]| {
            let [a, b, c] = [0, 1, 2].map(|i| at(one(i), start) as f64 * values[i] as f64);
            (a + b + c) as f32
        };
        let products = [0, 1, 2].map(|i| self.depths[i] * self.values[i]);
        let k = (x - start) as f32;
        let n = sum(products) + k * (step(products) as f32);
        let d = sum(self.depths) + k * (step(self.depths) as f32);
        let shades = self.values.map(|value| value as f32 / 256.0);
        let (low, high) = shades.iter().fold((f32::MAX, 0.0_f32), |(low, high), s| (low.min(*s), high.max(*s)));
        // A power of two does not affect rounding.
        (n / d / 256.0).clamp(low, high)
    }

    /// The shade in 1/256 at the nearest pixel of the nearest row.
    fn vintage(&self, x: i32, y: i32) -> i128 {
        let Some(last) = self.rows.len().checked_sub(1) else { return self.values[0] };
        let [ax, bx, a_shade, b_shade] = self.rows[(i64::from(y) - self.top).clamp(0, last as i64) as usize];
        if bx <= ax {
            return a_shade.into();
        }
        let k = i64::from(x).clamp(ax, bx - 1) - ax;
        (a_shade + k * ((b_shade - a_shade) / (bx - ax))).into()
    }
}

/// The rows of a triangle per the sources, with the number of the first one: edge by edge, with one addition per row.
fn vintage_rows(triangle: [Point; 3], values: [i128; 3]) -> (i64, Vec<VintageRow>) {
    let whole = |c: i128| (c + 128).div_euclid(256) as i64;
    let corners = [0, 1, 2].map(|i| (whole(triangle[i].0), whole(triangle[i].1), values[i] as i64));
    let [a, b, c] = corners.map(|(x, y, _)| (i128::from(x), i128::from(y)));
    let side = edge(a, c, b);
    if side == 0 || edge(triangle[0], triangle[1], triangle[2]) == 0 {
        return (0, Vec::new());
    }
    let walk = |(x0, y0, s0): (i64, i64, i64), (x1, y1, s1): (i64, i64, i64)| {
        let (mut x, mut shade, mut rows) = (x0 * 65_536, s0, Vec::new());
        for _ in y0..y1 {
            rows.push((x.div_euclid(65_536), shade));
            // Toward zero.
            x += (x1 - x0) * 65_536 / (y1 - y0);
            shade += (s1 - s0) / (y1 - y0);
        }
        rows
    };
    let [top, middle, bottom] = corners;
    let long = walk(top, bottom);
    let short: Vec<_> = walk(top, middle).into_iter().chain(walk(middle, bottom)).collect();
    // To the right when walking down is on the left of the screen.
    let (left, right) = if side > 0 { (short, long) } else { (long, short) };
    (top.1, left.into_iter().zip(right).map(|((ax, a), (bx, b))| [ax, bx, a, b]).collect())
}

/// The pixels of a triangle in a frame of `width × height`, row by row, following each shading's definition to the
/// letter.
pub fn pixels(vertices: &[Vertex; 3], interpolation: Interpolation, width: i32, height: i32) -> Vec<Pixel> {
    let triangle = vertices.each_ref().map(point);
    let shades = Shades::of_vertices(vertices, interpolation);
    let mut drawn = Vec::new();
    if interpolation == Interpolation::GouraudVintage {
        for (y, [ax, bx, ..]) in (shades.top..).zip(&shades.rows).filter(|(y, _)| (0..height.into()).contains(y)) {
            for x in (*ax).max(0) as i32..(*bx).min(width.into()) as i32 {
                let y = y as i32;
                drawn.push(Pixel { x, y, byte: u8::try_from(shades.vintage(x, y) >> 8).expect("a byte") });
            }
        }
        return drawn;
    }
    // No pixel lies beyond the vertices.
    let between = |coordinate: fn(&Point) -> i128, size: i32| {
        let (mut low, mut high) = (i128::from(size), -1);
        for p in &triangle {
            low = low.min(coordinate(p).div_euclid(256));
            high = high.max(coordinate(p).div_euclid(256));
        }
        low.max(0) as i32..(high + 1).min(i128::from(size)) as i32
    };
    for y in between(|p| p.1, height) {
        let row: Vec<i32> = between(|p| p.0, width).filter(|&x| covers(triangle, centre(x, y))).collect();
        let (Some(&first), Some(&last)) = (row.first(), row.last()) else { continue };
        drawn.extend(row.into_iter().map(|x| Pixel { x, y, byte: shades.byte((first, last), x, y, None) }));
    }
    drawn
}

/// The depth at a covered pixel, following the definition in `raster::reference::depth` to the letter.
pub fn depth_at(vertices: &[Vertex; 3], x: i32, y: i32) -> u32 {
    Depths::of_vertices(vertices).at(x, y)
}

/// The depth of the triangle's plane at any pixel, modulo 2³².
pub fn depth_beyond(vertices: &[Vertex; 3], x: i32, y: i32) -> u32 {
    Depths::of_vertices(vertices).sum(x, y) as u32
}

/// Depth over a triangle with an area.
pub struct Depths {
    /// The first vertex in (y, x) order, its depth, and the gradients with 24 fraction bits.
    first: Point,
    depth: i128,
    gradients: (i128, i128),
}

impl Depths {
    /// The depths of these vertices.
    pub fn of_vertices(vertices: &[Vertex; 3]) -> Self {
        let mut order = *vertices;
        order.sort_by_key(|v| (v.y(), v.x()));
        let [p0, p1, p2] = order.each_ref().map(point);
        let [d0, d1, d2] = order.each_ref().map(|v| i128::from(v.depth()));
        let area = edge(p0, p1, p2);
        let nearest = |n: i128| {
            let (n, d) = (n * area.signum(), area.abs());
            ((n << 24) + d / 2).div_euclid(d)
        };
        let gx = nearest((d1 - d0) * (p2.1 - p0.1) - (d2 - d0) * (p1.1 - p0.1));
        let gy = nearest((d2 - d0) * (p1.0 - p0.0) - (d1 - d0) * (p2.0 - p0.0));
        Self { first: p0, depth: d0, gradients: (gx, gy) }
    }

    /// The depth at a covered pixel.
    pub fn at(&self, x: i32, y: i32) -> u32 {
        u32::try_from(self.sum(x, y)).expect("a depth within its vertices'")
    }

    fn sum(&self, x: i32, y: i32) -> i128 {
        let (c, (gx, gy)) = (centre(x, y), self.gradients);
        let sum = (self.depth << 24) + gx * (c.0 - self.first.0) + gy * (c.1 - self.first.1) + (1 << 23);
        sum >> 24
    }
}

/// A depth in a 16-bit depth buffer: in units of 2¹⁴, rounded up, so that only 0 becomes 0.
pub fn narrow_depth(depth: u32) -> u16 {
    u64::from(depth).div_ceil(1 << 14).min(0xFFFF) as u16
}
