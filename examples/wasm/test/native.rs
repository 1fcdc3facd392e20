//! Prints the frames that the module must draw at the times in the arguments, as bytes of red, green, blue and alpha.

use std::error::Error;
use std::io::Write;

use mode13h::mesh::shapes;
use mode13h::render::Renderer;
use mode13h::scene::Scene;
use mode13h::vga::Vga;

fn main() -> Result<(), Box<dyn Error>> {
    let mut scene = Scene::showing(shapes::teapot(8));
    let (mut vga, mut rgba) = (Vga::new(), vec![0; 4 * Vga::SHOWN]);
    for seconds in std::env::args().skip(1) {
        scene.set_time(seconds.parse()?);
        Renderer::new().draw(&scene, &mut vga)?;
        vga.scan_out_rgba(&mut rgba);
        std::io::stdout().write_all(&rgba)?;
    }
    Ok(())
}
