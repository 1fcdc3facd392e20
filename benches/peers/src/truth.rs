//! How far candidates are from the correct picture of a triangle: coverage and shade in exact arithmetic.

use mode13h::raster::Interpolation;
use mode13h::span::Kernel;
use mode13h_conformance::oracle;

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
        let vertices = triangle.map(|corner| corner.vertex);
        let values = match drawing {
            Drawing::Flat => [i128::from(vertices[0].shade().nearest()) << 8; 3],
            _ => vertices.map(|v| i128::from(v.shade().to_bits())),
        };
        let mut right = vec![None; WIDTH * HEIGHT];
        for pixel in oracle::pixels(&vertices, Interpolation::Flat(0), WIDTH as i32, HEIGHT as i32) {
            let (corners, centre) = (vertices.each_ref().map(oracle::point), oracle::centre(pixel.x, pixel.y));
            let exact = oracle::interpolate(corners, values, centre);
            right[pixel.y as usize * WIDTH + pixel.x as usize] = Some(exact.n as f64 / exact.d as f64 / 256.0);
        }
        for (exact, (&on_black, &on_white)) in right.into_iter().zip(black.iter().zip(&white)) {
            match (exact, on_black == on_white) {
                (Some(_), false) => errors.holes += 1,
                (None, true) => errors.extra += 1,
                (Some(exact), true) => errors.shade = errors.shade.max((f64::from(on_black) - exact).abs()),
                (None, false) => {}
            }
        }
    }
    errors
}
