//! A whole game: steer the ring over the cube with the arrow keys. Esc quits.
//!
//!     cargo run --release --example game

use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_6X10};
use embedded_graphics::{Drawable, geometry::Point, text::Text};
use mode13h::glam::Vec3;
use mode13h::light::Light;
use mode13h::mesh::shapes;
use mode13h::raster::{Frame, Index};
use mode13h::render::Renderer;
use mode13h::scene::{Camera, Object, Scene};
use mode13h::window::{self, Flow, Key, WindowError};

const SPEED: f32 = 3.0;
const LIMIT: Vec3 = Vec3::new(4.0, 2.5, 0.0);

fn main() -> Result<(), WindowError> {
    let mut scene = Scene::new();
    let ring = scene.add(Object::new(shapes::torus(32, 16)));
    let cube = scene.add(Object::new(shapes::cube()));
    scene[cube].scale = 0.5;
    scene[cube].position = Vec3::new(2.0, 1.0, 0.0);
    scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    scene.camera = Camera::framing(Vec3::ZERO, 4.0);

    let mut renderer = Renderer::new();
    let (mut score, mut last) = (0_u32, 0.0);
    window::run("mode13h game", |vga, input, seconds| {
        let step = SPEED * (seconds - last).min(0.1) as f32;
        last = seconds;
        let axis = |less, more| (f32::from(input.held(more)) - f32::from(input.held(less))) * step;
        let moved = Vec3::new(axis(Key::Left, Key::Right), axis(Key::Down, Key::Up), 0.0);
        scene[ring].position = (scene[ring].position + moved).clamp(-LIMIT, LIMIT);
        scene[ring].set_angles([0.3, seconds, 0.0]);
        scene[cube].set_angles([seconds, 0.7 * seconds, 0.0]);
        if scene[ring].position.distance(scene[cube].position) < 0.4 {
            score += 1;
            // Far from the last place, and never the same two ways in a row.
            let place = score as f32 * 2.4;
            scene[cube].position = Vec3::new(3.0 * place.cos(), 1.8 * place.sin(), 0.0);
        }
        if let Err(error) = renderer.draw(&scene, vga) {
            eprintln!("game: {error}");
            return Flow::Close;
        }
        let text = format!("score {score}   time {seconds:.0}");
        // 255 is the lightest of the greys. A frame takes every pixel: there is no error to make.
        let Ok(_) =
            Text::new(&text, Point::new(8, 16), MonoTextStyle::new(&FONT_6X10, Index(255))).draw(&mut Frame::from(vga));
        if input.pressed(Key::Escape) { Flow::Close } else { Flow::Continue }
    })
}
