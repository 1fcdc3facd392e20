//! The engine's parts one by one, for the figures of the text.

use mode13h::fixed::{I24F8, U8F8};
use mode13h::raster::{Frame, Interpolation, Raster, Vertex};
use mode13h::span::Kernel;
use mode13h::vga::Vga;

/// The longest span.
const MAX_COUNT: usize = 65_535;

/// The bytes of a span, drawn by the portable kernel, which is the loop's specification.
pub(crate) fn span(shade: u16, step: u16, count: usize) -> Vec<u8> {
    let mut row = vec![0; count.min(MAX_COUNT)];
    Kernel::PORTABLE.fill(&mut row, shade, step);
    row
}

/// A frame cleared to byte 0, with triangles drawn in the given order. Triangles with a corner that the raster refuses
/// are left out.
pub(crate) fn triangles(numbers: &[u8]) -> Vec<u8> {
    let numbers: Vec<f64> = numbers.as_chunks().0.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect();
    let mut bytes = vec![0; Vga::SHOWN];
    let Ok(frame) = Frame::new(&mut bytes, Vga::WIDTH as u32, Vga::HEIGHT as u32, Vga::PITCH) else { return bytes };
    let mut raster = Raster::new(frame);
    let corners: Vec<[f64; 3]> = numbers.as_chunks().0.to_vec();
    for triangle in corners.as_chunks::<3>().0 {
        if let [Some(a), Some(b), Some(c)] = triangle.map(vertex) {
            raster.triangle(&[a, b, c], Interpolation::Gouraud88);
        }
    }
    bytes
}

/// A corner: x and y in pixels, rounded once, and a shade.
fn vertex([x, y, shade]: [f64; 3]) -> Option<Vertex> {
    // The cast saturates; shades beyond the range are refused.
    let shade = U8F8::from_bits((shade * 256.0 + 0.5).floor().clamp(0.0, 65_535.0) as u16);
    Vertex::new(I24F8::round_from_f64(x)?, I24F8::round_from_f64(y)?, shade, 0).ok()
}
