//! A record drawn by the exact oracle, pixel by pixel.

use mode13h::raster::Rect;
use mode13h_conformance::oracle;

use crate::record::Record;

/// A frame by the oracle.
pub(super) struct Drawing {
    /// The bytes, row-major.
    pub(super) pixels: Vec<u8>,
    /// The triangle that each pixel shows.
    pub(super) owners: Vec<Option<usize>>,
    /// Number of times each pixel is covered.
    pub(super) covered: Vec<u32>,
}

/// Depth test: whether a triangle may write a pixel that holds a depth.
pub(super) type Test = fn(new: u32, old: u32) -> bool;

/// The nearest wins, of equal ones the first; 0 is nothing.
pub(super) const NEAREST: Test = |new, old| new > old;
/// The last wins.
pub(super) const LAST: Test = |_, _| true;

/// A record's frame.
pub(super) fn frame(record: &Record, test: Test) -> Drawing {
    let (width, height) = (record.width(), record.height());
    let clip = record.clip().unwrap_or(Rect { x0: 0, y0: 0, x1: width, y1: height });
    let count = width as usize * height as usize;
    let mut depths = vec![0; count];
    let mut drawing =
        Drawing { pixels: vec![record.background; count], owners: vec![None; count], covered: vec![0; count] };
    for (number, (vertices, interpolation)) in record.triangles.iter().enumerate() {
        // Sides are at most 4,096.
        for pixel in oracle::pixels(vertices, *interpolation, width as i32, height as i32) {
            let (x, y) = (pixel.x as u32, pixel.y as u32);
            if !(clip.x0..clip.x1).contains(&x) || !(clip.y0..clip.y1).contains(&y) {
                continue;
            }
            let place = y as usize * width as usize + x as usize;
            let depth = oracle::depth_beyond(vertices, pixel.x, pixel.y);
            drawing.covered[place] = drawing.covered[place].saturating_add(1);
            if test(depth, depths[place]) {
                depths[place] = depth;
                drawing.pixels[place] = pixel.byte;
                drawing.owners[place] = Some(number);
            }
        }
    }
    drawing
}
