//! A whole game: turn the ship with the arrow keys, shoot the rocks with the space bar. Esc quits.
//!
//!     cargo run --release --features window,embedded-graphics --example game

use std::error::Error;

use mode13h::Angle;
use mode13h::embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_6X10};
use mode13h::embedded_graphics::{Drawable, geometry::Point, text::Text};
use mode13h::glam::Vec3;
use mode13h::light::Light;
use mode13h::mesh::shapes;
use mode13h::raster::{Frame, Index};
use mode13h::render::Renderer;
use mode13h::scene::{Camera, Object, ObjectId, Scene};
use mode13h::window::{self, Flow, Key};

fn main() -> Result<(), Box<dyn Error>> {
    let mut scene = Scene::new();
    scene.camera = Camera::framing(Vec3::ZERO, 4.0);
    scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    let ship = scene.add(Object::new(shapes::cone(16, 4)).scaled(0.5));
    let angles = (0..8).map(|i| f32::from(i as u8) * 0.785);
    let places = angles.map(|a| Vec3::new(3.2 * a.cos(), 3.2 * a.sin(), 0.0));
    let mut rocks: Vec<ObjectId> =
        places.map(|at| scene.add(Object::new(shapes::sphere(8, 6)).at(at).scaled(0.4))).collect();
    let mut shots: Vec<(ObjectId, Vec3)> = Vec::new();
    let mut renderer = Renderer::new();
    window::run("mode13h game", |vga, input, _| -> Result<Flow, Box<dyn Error>> {
        let step = input.elapsed.min(0.1);
        let turns = f64::from(input.held(Key::Left)) - f64::from(input.held(Key::Right));
        scene[ship].rotate_z(Angle::from_degrees(180.0) * step * turns);
        if input.pressed(Key::Space) {
            let towards = scene[ship].rotation() * Vec3::Y;
            shots.push((scene.add(Object::new(shapes::cube()).scaled(0.1)), towards * 6.0));
        }
        shots.retain(|&(shot, speed)| {
            scene[shot].position += speed * step as f32;
            let at = scene[shot].position;
            let hit = rocks.iter().position(|&rock| scene[rock].position.distance(at) < 0.5);
            hit.into_iter().for_each(|i| drop(scene.remove(rocks.swap_remove(i))));
            let flies = hit.is_none() && at.length() < 6.0;
            flies || scene.remove(shot).is_none()
        });
        renderer.draw(&scene, vga)?;
        let text = if rocks.is_empty() { "well done".to_string() } else { format!("rocks {}", rocks.len()) };
        let style = MonoTextStyle::new(&FONT_6X10, Index(255));
        let Ok(_) = Text::new(&text, Point::new(8, 16), style).draw(&mut Frame::from(vga));
        Ok(if input.pressed(Key::Escape) { Flow::Close } else { Flow::Continue })
    })
}
