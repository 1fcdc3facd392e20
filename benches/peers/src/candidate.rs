//! The candidates, each with triangles in its own format, converted before the clock starts.

use mode13h::raster::Vertex;

use crate::{HEIGHT, WIDTH};

/// A corner as the engine rounds it, which every peer's numbers represent exactly.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    pub vertex: Vertex,
    /// Distance from the eye, in units of the near plane's.
    pub w: f32,
    /// Coordinates in texels, in whole multiples of 1/65,536.
    pub texel: [f32; 2],
}

pub type Triangle = [Corner; 3];

/// Draws the given triangles into its own frame.
pub trait Candidate {
    fn name(&self) -> String;
    /// Returns whether it is ours.
    fn is_ours(&self) -> bool {
        false
    }
    fn clear(&mut self, index: u8);
    /// Clears the depth buffer, if it has one, and draws.
    fn draw(&mut self);
    fn read(&mut self, bytes: &mut [u8]);
}

/// x and y in pixels and the shade, as f32, which represents them exactly.
pub fn floats(v: &Vertex) -> [f32; 3] {
    [v.x().to_bits() as f32 / 256.0, v.y().to_bits() as f32 / 256.0, f32::from(v.shade().to_bits()) / 256.0]
}

/// Returns whether no triangle extends beyond the frame.
pub fn is_inside(triangles: &[Triangle]) -> bool {
    let within = |u: i32, most: usize| (0..=256 * most as i32).contains(&u);
    let mut corners = triangles.iter().flatten().map(|corner| &corner.vertex);
    corners.all(|v| within(v.x().to_bits(), WIDTH) && within(v.y().to_bits(), HEIGHT))
}
