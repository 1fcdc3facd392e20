//! A frame of mode13h as a texture of macroquad.

use macroquad::prelude::*;
use mode13h::{mesh::shapes, render::Renderer, scene::Scene, vga::Vga};

#[macroquad::main("mode13h in macroquad")]
async fn main() {
    let mut scene = Scene::showing(shapes::teapot(8));
    let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
    let mut image = Image::gen_image_color(Vga::WIDTH as u16, Vga::HEIGHT as u16, BLACK);
    let texture = Texture2D::from_image(&image);
    texture.set_filter(FilterMode::Nearest);
    while !is_key_pressed(KeyCode::Escape) {
        scene.set_time(get_time());
        renderer.draw(&scene, &mut vga).expect("the scene has no fault");
        vga.scan_out_rgba(&mut image.bytes);
        texture.update(&image);
        // The largest 4:3 rectangle that fits, as on a VGA's screen, whatever the window's shape.
        let height = screen_height().min(screen_width() * 0.75);
        let size = vec2(height / 0.75, height);
        let corner = (vec2(screen_width(), screen_height()) - size) / 2.0;
        clear_background(BLACK);
        let shown = DrawTextureParams { dest_size: Some(size), ..Default::default() };
        draw_texture_ex(&texture, corner.x, corner.y, WHITE, shown);
        next_frame().await;
    }
}
