//! The naive oracles of the raster: what DESIGN says, in i128, with no thought for speed. They share
//! nothing with the raster but the vertices.

use mode13h::raster::{Shading, Vertex};

/// Vertex position in 1/256 pixel.
pub type Point = (i128, i128);

pub fn point(v: &Vertex) -> Point {
    (i128::from(v.x().to_bits()), i128::from(v.y().to_bits()))
}

/// Twice the signed area of a → b → p; positive when p lies to the right of a → b on a screen
/// whose y runs down.
pub fn edge(a: Point, b: Point, p: Point) -> i128 {
    (b.0 - a.0) * (p.1 - a.1) - (b.1 - a.1) * (p.0 - a.0)
}

/// The centre of a pixel in 1/256 pixel.
pub fn centre(x: i32, y: i32) -> Point {
    (i128::from(x) * 256 + 128, i128::from(y) * 256 + 128)
}

/// Whether the pixel is drawn: its centre is inside, or on a top or a left edge.
pub fn covers(triangle: [Point; 3], p: Point) -> bool {
    let [a, mut b, mut c] = triangle;
    let area = edge(a, b, c);
    if area == 0 {
        return false;
    }
    if area < 0 {
        std::mem::swap(&mut b, &mut c);
    }
    [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| {
        // Clockwise on the screen: a left edge runs up, a top edge runs right.
        let top_or_left = to.1 < from.1 || (to.1 == from.1 && to.0 > from.0);
        let side = edge(from, to, p);
        side > 0 || (side == 0 && top_or_left)
    })
}

/// Whether a centre lies inside a polygon, or on one of its top or left edges: crossings to the
/// left of it, counted in rows that include their upper end.
pub fn polygon_covers(polygon: &[Point], p: Point) -> bool {
    let mut inside = false;
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (upper, lower) = if a.1 < b.1 { (a, b) } else { (b, a) };
        // On the edge or to the right of it on the screen: not to the right of the way down.
        if upper.1 <= p.1 && p.1 < lower.1 && edge(upper, lower, p) <= 0 {
            inside = !inside;
        }
    }
    inside
}

/// An exact value n / d, d positive.
#[derive(Clone, Copy, Debug)]
pub struct Ratio {
    pub n: i128,
    pub d: i128,
}

impl Ratio {
    pub fn floor(self) -> i128 {
        self.n.div_euclid(self.d)
    }
    pub fn ceil(self) -> i128 {
        -(-self.n).div_euclid(self.d)
    }
    pub fn truncate(self) -> i128 {
        self.n / self.d
    }
    /// |self − whole| · d ≤ bound · d, with bound = bound_n / bound_d.
    pub fn is_within(self, whole: i128, bound_n: i128, bound_d: i128) -> bool {
        (self.n - whole * self.d).abs() * bound_d <= bound_n * self.d
    }
}

/// A vertex attribute, exactly, at a point: the weights are the areas opposite to the vertices.
pub fn interpolate(triangle: [Point; 3], values: [i128; 3], p: Point) -> Ratio {
    let [a, b, c] = triangle;
    let area = edge(a, b, c);
    let n = values[0] * edge(b, c, p) + values[1] * edge(c, a, p) + values[2] * edge(a, b, p);
    Ratio { n: n * area.signum(), d: area.abs() }
}

/// The attribute's change per pixel along the row, exactly.
pub fn per_pixel(triangle: [Point; 3], values: [i128; 3]) -> Ratio {
    let at = |x| interpolate(triangle, values, centre(x, 0));
    Ratio { n: at(1).n - at(0).n, d: at(0).d }
}

/// A pixel that a triangle draws.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Pixel {
    pub x: i32,
    pub y: i32,
    pub byte: u8,
}

/// The exact shade of a covered pixel in 1/256: what `shading` interpolates, without its rounding.
pub fn exact_shade(vertices: &[Vertex; 3], shading: Shading, p: Point) -> Ratio {
    let triangle = vertices.each_ref().map(point);
    let shades = vertices.each_ref().map(|v| i128::from(v.shade().to_bits()));
    if shading != Shading::GouraudHyperbolic {
        return interpolate(triangle, shades, p);
    }
    // Weighted by the depths, which are 1/w.
    let depths = vertices.each_ref().map(|v| i128::from(v.depth().max(1)));
    let products = [0, 1, 2].map(|i| depths[i] * shades[i]);
    Ratio { n: interpolate(triangle, products, p).n, d: interpolate(triangle, depths, p).n }
}

/// The pixels of a triangle in a frame of `width × height`, by the letter of each shading's definition,
/// row by row.
pub fn pixels(vertices: &[Vertex; 3], shading: Shading, width: i32, height: i32) -> Vec<Pixel> {
    let triangle = vertices.each_ref().map(point);
    let shades = vertices.each_ref().map(|v| i128::from(v.shade().to_bits()));
    // No pixel further out than the vertices' own.
    let between = |coordinate: fn(&Point) -> i128, size: i32| {
        let (mut low, mut high) = (i128::from(size), -1);
        for p in &triangle {
            low = low.min(coordinate(p).div_euclid(256));
            high = high.max(coordinate(p).div_euclid(256));
        }
        low.max(0) as i32..(high + 1).min(i128::from(size)) as i32
    };
    let mut drawn = Vec::new();
    for y in between(|p| p.1, height) {
        let mut first = None;
        let mut sum = 0;
        for x in between(|p| p.0, width) {
            if !covers(triangle, centre(x, y)) {
                continue;
            }
            let f = *first.get_or_insert(x);
            let exact = exact_shade(vertices, shading, centre(x, y));
            let byte = match shading {
                Shading::Flat(byte) => byte.into(),
                Shading::GouraudHyperbolic => Ratio { n: exact.n + 128 * exact.d, d: 256 * exact.d }.floor(),
                _ => {
                    let slope = per_pixel(triangle, shades);
                    if x == f || (shading == Shading::GouraudReseeded && (x - f) % 64 == 0) {
                        sum = if slope.n < 0 { exact.ceil() } else { exact.floor() };
                    } else {
                        sum += slope.truncate();
                    }
                    (sum + 128) >> 8
                }
            };
            let byte = u8::try_from(byte).expect("a shade in range is a byte");
            drawn.push(Pixel { x, y, byte });
        }
    }
    drawn
}

/// The depth at a covered pixel, by the letter of the definition in `raster::depth`.
pub fn depth_at(vertices: &[Vertex; 3], x: i32, y: i32) -> u32 {
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
    let c = centre(x, y);
    let sum = (d0 << 24) + gx * (c.0 - p0.0) + gy * (c.1 - p0.1) + (1 << 23);
    u32::try_from(sum >> 24).expect("a depth within its vertices'")
}
