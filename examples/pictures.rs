//! Pictures without a window: a turn of the teapot as 36 indexed PNGs, 640 × 400, and as an animation, in a folder.
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
use mode13h_assets::animation::{FrameRate, GifFile};

const PICTURES: usize = 36;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".to_string()));
    let mut scene = Scene::new();
    let teapot = scene.show(shapes::teapot(6));
    scene[teapot].materials[0].specular = 0.5;
    scene[teapot].materials[0].shininess = 20.0;
    scene.palette = Some(builtin::COPPER.clone());
    scene.settings.accuracy = Some(Shading::Phong.into());

    let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
    let rate = FrameRate::try_from(PICTURES as f64 / scene.duration)?;
    let mut animation = GifFile::create(folder.join("turn.gif"), Scale::Double, rate)?;
    for i in 0..PICTURES {
        scene.set_time(scene.duration * i as f64 / PICTURES as f64);
        renderer.draw(&scene, &mut vga)?;
        let palette = vga.palette();
        let picture = Picture::mode_13h(vga.pixels(), &palette);
        Png { scale: Scale::Double, rgb: false }.save(&picture, folder.join(format!("{i:02}.png")))?;
        animation.add(&picture)?;
    }
    println!("{PICTURES} pictures and turn.gif, {} bytes, in {}", animation.finish()?.bytes, folder.display());
    Ok(())
}
