//! One shaded triangle by the rasterizer alone, printed as text: no scene, no VGA, no allocator.
//!
//!     cargo run --example triangle --no-default-features

use std::error::Error;

use mode13h::fixed::{I24F8, U8F8};
use mode13h::raster::{Frame, Interpolation, Raster, Vertex};

const WIDTH: u32 = 64;
const HEIGHT: u32 = 24;

fn main() -> Result<(), Box<dyn Error>> {
    let mut bytes = [0; (WIDTH * HEIGHT) as usize];
    // Whole pixels here; a coordinate has 8 bits of fraction. Depth does not matter for one triangle.
    let at = |x, y, shade| Vertex::new(I24F8::from(x), I24F8::from(y), U8F8::from(shade), 0);
    let triangle = [at(4, 2, 255)?, at(60, 8, 32)?, at(20, 22, 96)?];
    let frame = Frame::new(&mut bytes, WIDTH, HEIGHT, WIDTH as usize)?;
    let drawn = Raster::new(frame).triangle(&triangle, Interpolation::default());
    for row in bytes.chunks(WIDTH as usize) {
        let text: String = row.iter().map(|&shade| char::from(b" .:-=+*%@"[usize::from(shade).div_ceil(32)])).collect();
        println!("{text}");
    }
    println!("{} pixels", drawn.pixels);
    Ok(())
}
