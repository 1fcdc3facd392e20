//! A shaded torus in `torus.png`: scene, renderer, machine, picture.
//!
//!     cargo run --release --example torus_png

use std::error::Error;

use mode13h::export;
use mode13h::light::Light;
use mode13h::mesh::shapes;
use mode13h::render::Renderer;
use mode13h::scene::{Object, Scene};
use mode13h::vga::Vga;

fn main() -> Result<(), Box<dyn Error>> {
    let mut scene = Scene::new();
    let ship = scene.add(Object::new(shapes::torus(48, 24)));
    scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    let mut renderer = Renderer::new();
    let mut vga = Vga::new();
    scene[ship].rotate_y(0.5);
    let stats = renderer.draw(&scene, &mut vga)?;
    export::png(&vga, "torus.png")?;
    println!("torus.png: {stats}");
    Ok(())
}
