//! 640 × 480 square pixels in a palette of its own: fire on a toon teapot. It opens a window if it is built with the
//! feature `window` and there is a display; otherwise it writes `vesa.png`.
//!
//!     cargo run --release --example vesa [--features window]

use mode13h::export::{Picture, Png};
use mode13h::light::LightResponse;
use mode13h::mesh::shapes;
use mode13h::palette::{Palette, Rgb};
use mode13h::raster::Frame;
use mode13h::render::Renderer;
use mode13h::scene::Scene;
use mode13h::settings::Shading;
#[cfg(feature = "window")]
use mode13h::window::{Flow, Key, Window};

const WIDTH: u32 = 640;
const HEIGHT: u32 = 480;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let fire = std::array::from_fn(|i| Rgb::from_intensities([i as f32 / 128.0, i as f32 / 255.0, 0.1]));
    let fire = Palette::from_colors(fire);
    let mut scene = Scene::new();
    let teapot = scene.show(shapes::teapot(8));
    scene.palette = Some(fire.clone());
    // Five tones, at every pixel; by default light is computed at the vertices and interpolated linearly.
    scene[teapot].materials[0].response = Some(LightResponse::new(|intensity| (intensity * 5.0).ceil() / 5.0));
    scene.settings.accuracy = Some(Shading::Phong.into());

    let mut renderer = Renderer::new();
    let mut pixels = vec![0; (WIDTH * HEIGHT) as usize];
    let mut draw = |scene: &Scene, pixels: &mut [u8]| -> Result<(), Box<dyn std::error::Error>> {
        renderer.draw_frame(scene, Frame::new(pixels, WIDTH, HEIGHT, WIDTH as usize)?, (1, 1))?;
        Ok(())
    };
    #[cfg(feature = "window")]
    match Window::open_of_size("mode13h vesa", WIDTH as usize, HEIGHT as usize) {
        Ok(mut window) => loop {
            scene.set_time(window.seconds());
            draw(&scene, &mut pixels)?;
            let flow = window.show_picture(&Picture::of(&pixels, WIDTH as usize, &fire))?;
            if flow == Flow::Close || window.input().pressed(Key::Escape) {
                return Ok(());
            }
        },
        Err(error) => eprintln!("{error}"),
    }
    draw(&scene, &mut pixels)?;
    Ok(Png::default().save(&Picture::of(&pixels, WIDTH as usize, &fire), "vesa.png")?)
}
