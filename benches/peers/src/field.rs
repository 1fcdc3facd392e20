//! The field: every candidate that supports a kind of drawing.

use mode13h::span::Kernel;

use crate::allegro::{Allegro, Fixed, Float};
use crate::candidate::{Candidate, Triangle};
use crate::drawing::{Drawing, Material};
use crate::ours::{Effects, Plain};
use crate::retrofire::Retrofire;

/// Our kernels that the machine supports; one column each.
pub fn kernels() -> Vec<Kernel> {
    let named = ["portable", "simd-sse2", "simd-avx2", "simd-avx512"].map(str::parse::<Kernel>);
    named.into_iter().flatten().collect()
}

/// Every candidate that supports this drawing, with these triangles; ours with each of `kernels`.
pub fn all<'a>(
    triangles: &'a [Triangle],
    drawing: Drawing,
    material: &'a Material,
    kernels: &[Kernel],
) -> Vec<Box<dyn Candidate + 'a>> {
    let mut all: Vec<Box<dyn Candidate + 'a>> = vec![
        Box::new(Allegro::<Float>::new(triangles, drawing, material)),
        Box::new(Allegro::<Fixed>::new(triangles, drawing, material)),
    ];
    if matches!(drawing, Drawing::Flat | Drawing::Gouraud | Drawing::GouraudDepth | Drawing::PerspectiveDepth) {
        all.push(Box::new(Retrofire::new(triangles, drawing, material)));
    }
    for &kernel in kernels {
        if drawing.has_texture() {
            all.push(Box::new(Effects::new(triangles, drawing, material, kernel)));
        } else {
            all.push(Box::new(Plain::batches(triangles, drawing, kernel)));
        }
    }
    let fastest = kernels.last().copied().unwrap_or_default();
    if drawing.is_perspective() {
        all.push(Box::new(Effects::new(triangles, drawing, material, fastest).every_16()));
    }
    // One triangle per call, with the slowest and with the fastest kernel.
    for &kernel in kernels.first().into_iter().chain(kernels.last()).filter(|_| !drawing.has_texture()) {
        all.push(Box::new(Plain::one_by_one(triangles, drawing, kernel)));
    }
    all
}
