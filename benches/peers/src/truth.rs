//! The correct picture of a triangle: coverage and shade in exact arithmetic, pixel by pixel.

use mode13h::raster::Vertex;
use mode13h::span::Kernel;

use crate::candidate::{Candidate, Triangle};
use crate::drawing::{Drawing, Material};
use crate::field;
use crate::{HEIGHT, WIDTH};

/// How far a candidate is from the truth, over the triangles that were compared.
#[derive(Clone, Copy, Default, Debug)]
pub struct Errors {
    /// Covered pixels that were not drawn.
    pub holes: u64,
    /// Drawn pixels that are not covered.
    pub extra: u64,
    /// Largest difference between a covered pixel's byte and the exact shade.
    pub shade: f64,
}

/// Draws each triangle separately, on black and on white: a pixel was drawn if it is the same on both.
pub fn errors(
    triangles: &[Triangle],
    drawing: Drawing,
    material: &Material,
    kernels: &[Kernel],
    candidate: usize,
) -> Errors {
    let mut errors = Errors::default();
    let (mut black, mut white) = (vec![0; WIDTH * HEIGHT], vec![0; WIDTH * HEIGHT]);
    for triangle in triangles {
        let mut candidate: Box<dyn Candidate> =
            field::all(std::slice::from_ref(triangle), drawing, material, kernels).swap_remove(candidate);
        for (index, bytes) in [(0, &mut black), (255, &mut white)] {
            candidate.clear(index);
            candidate.draw();
            candidate.read(bytes);
        }
        let plane = Plane::new(&triangle.map(|corner| corner.vertex), drawing);
        for (place, (&on_black, &on_white)) in black.iter().zip(&white).enumerate() {
            let (x, y) = ((place % WIDTH) as i64, (place / WIDTH) as i64);
            let drawn = on_black == on_white;
            match (plane.as_ref().and_then(|plane| plane.shade(x, y)), drawn) {
                (Some(_), false) => errors.holes += 1,
                (None, true) => errors.extra += 1,
                (Some(exact), true) => errors.shade = errors.shade.max((f64::from(on_black) - exact).abs()),
                (None, false) => {}
            }
        }
    }
    errors
}

/// A triangle whose corners are ordered so that its area is positive.
struct Plane {
    corners: [[i64; 3]; 3],
    area: i64,
}

impl Plane {
    fn new(vertices: &[Vertex; 3], drawing: Drawing) -> Option<Self> {
        let first = i64::from(vertices[0].shade().nearest()) << 8;
        let corner = |v: &Vertex| {
            let value = if drawing == Drawing::Flat { first } else { i64::from(v.shade().to_bits()) };
            [i64::from(v.x().to_bits()), i64::from(v.y().to_bits()), value]
        };
        let mut corners = vertices.each_ref().map(corner);
        let [a, b, c] = corners;
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if area < 0 {
            corners.swap(1, 2);
        }
        (area != 0).then_some(Self { corners, area: area.abs() })
    }

    /// The exact shade at a pixel's centre, if it is inside or on a top or left edge.
    fn shade(&self, x: i64, y: i64) -> Option<f64> {
        let (px, py) = (256 * x + 128, 256 * y + 128);
        let mut sum = 0;
        for i in 0..3 {
            let (a, b) = (self.corners[i], self.corners[(i + 1) % 3]);
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            let edge = dx * (py - a[1]) - dy * (px - a[0]);
            // With positive area on a screen whose y points down, left edges run up and top edges to the right.
            let owns = dy < 0 || (dy == 0 && dx > 0);
            if edge < 0 || (edge == 0 && !owns) {
                return None;
            }
            sum += edge * self.corners[(i + 2) % 3][2];
        }
        Some(sum as f64 / self.area as f64 / 256.0)
    }
}
