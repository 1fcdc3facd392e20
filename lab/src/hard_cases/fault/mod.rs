//! The wrong side of a picture: small, honest implementations of the faults that the engine guards against. Each gets
//! one thing wrong and the rest right. Nothing else in the crate uses them.
//!
//! They use f64: the corners of the cases are multiples of 1/256 within a few dozen pixels, so everything that should
//! be exact here is exact.

pub(super) mod cover;
pub(super) mod depth;
pub(super) mod light;
pub(super) mod shade;

use super::face::{Corner, Face};
use super::panel::Panel;
use mode13h::raster::Interpolation;

/// Twice the area of a → b → (x, y); positive if the point lies to the right of a → b on a screen whose y points down.
pub(super) fn side(a: Corner, b: Corner, (x, y): (f64, f64)) -> f64 {
    (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)
}

/// A pixel's centre.
fn centre(x: i32, y: i32) -> (f64, f64) {
    (f64::from(x) + 0.5, f64::from(y) + 0.5)
}

/// A shade as a byte: rounded to the nearest, and **wrapped** outside 0 to 255.
pub(super) fn wrapped(shade: f64) -> u8 {
    // Below 2⁶³ in every case; the last cast keeps the low byte, which is the fault.
    (shade + 0.5).floor() as i64 as u8
}

/// A pixel that a triangle owns, with the weights of the corners there, which sum to 1.
#[derive(Clone, Copy)]
struct Sample {
    x: i32,
    y: i32,
    weights: [f64; 3],
}

impl Sample {
    fn of(&self, values: [f64; 3]) -> f64 {
        let [a, b, c] = self.weights;
        a * values[0] + b * values[1] + c * values[2]
    }

    /// The byte of its face there: the face's single one, or interpolated linearly on the screen.
    fn byte(&self, face: &Face) -> u8 {
        match face.interpolation {
            Interpolation::Flat(byte) => byte,
            _ => wrapped(self.of(face.corners.map(|corner| corner.shade))),
        }
    }
}

/// The pixels that a triangle owns by the top-left rule, for faults that are not about coverage.
fn samples(size: (usize, usize), corners: &[Corner; 3]) -> Vec<Sample> {
    let [a, b, c] = *corners;
    let area = side(a, b, (c.x, c.y));
    let mut samples = Vec::new();
    if area == 0.0 || area.is_nan() {
        return samples;
    }
    let owns = |from: Corner, to: Corner, doubled: f64| {
        // Oriented so that the inside is to the right of every edge.
        let (dx, dy) = if area > 0.0 { (to.x - from.x, to.y - from.y) } else { (from.x - to.x, from.y - to.y) };
        let doubled = doubled * area.signum();
        doubled > 0.0 || (doubled == 0.0 && (dy < 0.0 || (dy == 0.0 && dx > 0.0)))
    };
    for y in 0..size.1 as i32 {
        for x in 0..size.0 as i32 {
            let p = centre(x, y);
            let doubled = [side(b, c, p), side(c, a, p), side(a, b, p)];
            if owns(b, c, doubled[0]) && owns(c, a, doubled[1]) && owns(a, b, doubled[2]) {
                samples.push(Sample { x, y, weights: doubled.map(|weight| weight / area) });
            }
        }
    }
    samples
}

/// Draws faces as they should be, in f64, one over another.
pub(super) fn paint(panel: &mut Panel, faces: &[Face]) {
    for face in faces {
        for sample in samples((panel.width(), panel.height()), &face.corners) {
            panel.write(sample.x, sample.y, sample.byte(face));
        }
    }
}
