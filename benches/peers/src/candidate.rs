//! Who draws: each with triangles in its own format, made before the clock starts.

use mode13h::raster::Vertex;
use mode13h::span::Kernel;

use crate::allegro::{Allegro, Fixed, Float};
use crate::drawing::{Drawing, Material};
use crate::ours::{Batches, Effects, OneByOne};
use crate::retrofire::Retrofire;
use crate::{HEIGHT, WIDTH};

/// A corner, as the engine rounds it: every peer's numbers hold these exactly.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    pub vertex: Vertex,
    /// The distance from the eye, in units of the near plane's.
    pub w: f32,
    /// Coordinates in texels, whole 1/65,536ths.
    pub texel: [f32; 2],
}

pub type Triangle = [Corner; 3];

/// Draws what it was given into its own frame.
pub trait Candidate {
    fn name(&self) -> String;
    /// Whether it is ours.
    fn is_ours(&self) -> bool {
        false
    }
    fn clear(&mut self, index: u8);
    /// Clears the depth buffer, if it has one, and draws.
    fn draw(&mut self);
    fn read(&mut self, bytes: &mut [u8]);
}

/// Our kernels, of those that the machine has: a column each.
pub fn kernels() -> Vec<Kernel> {
    let named = ["portable", "simd-sse2", "simd-avx2", "simd-avx512"].map(str::parse::<Kernel>);
    named.into_iter().flatten().collect()
}

/// Everybody that can draw so, with these triangles; ours with each of `kernels`.
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
            all.push(Box::new(Batches::new(triangles, drawing, kernel)));
        }
    }
    let fastest = kernels.last().copied().unwrap_or_default();
    if drawing.is_perspective() {
        all.push(Box::new(Effects::new(triangles, drawing, material, fastest).every_16()));
    }
    // A triangle a call, by the slowest and by the fastest.
    for &kernel in kernels.first().into_iter().chain(kernels.last()).filter(|_| !drawing.has_texture()) {
        all.push(Box::new(OneByOne::new(triangles, drawing, kernel)));
    }
    all
}

/// x, y in pixels and the shade, as f32, which holds them exactly.
pub fn floats(v: &Vertex) -> [f32; 3] {
    [v.x().to_bits() as f32 / 256.0, v.y().to_bits() as f32 / 256.0, f32::from(v.shade().to_bits()) / 256.0]
}

/// Whether no triangle reaches beyond the frame.
pub fn is_inside(triangles: &[Triangle]) -> bool {
    let within = |u: i32, most: usize| (0..=256 * most as i32).contains(&u);
    let mut corners = triangles.iter().flatten().map(|corner| &corner.vertex);
    corners.all(|v| within(v.x().to_bits(), WIDTH) && within(v.y().to_bits(), HEIGHT))
}
