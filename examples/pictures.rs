//! A batch of pictures without a window: eight shadings of a teapot as indexed PNGs, 640 × 400, in a folder.
//!
//!     cargo run --release --example pictures -- folder

use std::error::Error;
use std::path::PathBuf;

use mode13h::export::{Picture, Png, Scale};
use mode13h::mesh::shapes;
use mode13h::palette::builtin;
use mode13h::render::Renderer;
use mode13h::scene::Scene;
use mode13h::settings::Shading;
use mode13h::vga::Vga;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".to_string()));
    let mut scene = Scene::showing(shapes::teapot(6));
    scene.palette = Some(builtin::COPPER.clone());
    scene.objects_mut()[0].materials[0].specular = 0.5;
    scene.objects_mut()[0].materials[0].shininess = 20.0;
    let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
    for (i, shading) in Shading::ALL.into_iter().take(8).enumerate() {
        scene.set_time(scene.duration * i as f64 / 8.0);
        scene.settings.accuracy = Some(shading.into());
        let stats = renderer.draw(&scene, &mut vga)?;
        let path = folder.join(format!("{shading}.png"));
        let palette = vga.palette();
        Png { scale: Scale::Double, rgb: false }.save(&Picture::mode_13h(vga.pixels(), &palette), &path)?;
        println!("{}: {stats}", path.display());
    }
    Ok(())
}
