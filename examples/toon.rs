//! A toon material: three tones, lit at every pixel and rendered to `toon.png`.
//!
//!     cargo run --release --example toon

use mode13h::export;
use mode13h::light::LightResponse;
use mode13h::mesh::shapes;
use mode13h::render::Renderer;
use mode13h::scene::Scene;
use mode13h::settings::Shading;
use mode13h::vga::Vga;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut scene = Scene::new();
    let teapot = scene.show(shapes::teapot(8));
    let tones = LightResponse::new(|intensity| match intensity {
        ..0.3 => 0.25,
        0.3..0.75 => 0.6,
        _ => 1.0,
    });
    scene[teapot].materials[0].response = Some(tones);
    // Light is computed at every pixel; by default it is computed at the vertices and interpolated linearly.
    scene.settings.accuracy = Some(Shading::Phong.into());
    let mut vga = Vga::new();
    println!("toon.png: {}", Renderer::new().draw(&scene, &mut vga)?);
    Ok(export::png(&vga, "toon.png")?)
}
