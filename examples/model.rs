//! A model from an OBJ file, with its materials and textures, turning in a window. Esc quits.
//!
//!     cargo run --release --features window --example model -- tests/data/house.obj

use std::error::Error;

use mode13h::render::Renderer;
use mode13h::scene::Scene;
use mode13h::window::{self, Flow, Key};
use mode13h_assets::SceneExt;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("which model? (a path to an .obj file)")?;
    let (mut scene, warnings) = Scene::from_model(&path)?;
    warnings.iter().for_each(|warning| eprintln!("{warning}"));
    let mut renderer = Renderer::new();
    window::run(&path, |vga, input, seconds| -> Result<Flow, Box<dyn Error>> {
        scene.set_time(seconds);
        renderer.draw(&scene, vga)?;
        Ok(if input.pressed(Key::Escape) { Flow::Close } else { Flow::Continue })
    })
}
