//! A teapot for a canvas: `draw(seconds)` returns the address of 320 × 200 pixels of red, green, blue and alpha.

use std::cell::RefCell;

use mode13h::{mesh::shapes, render::Renderer, scene::Scene, vga::Vga};

thread_local! {
    static TEAPOT: RefCell<(Scene, Renderer, Vga, Vec<u8>)> =
        RefCell::new((Scene::showing(shapes::teapot(8)), Renderer::new(), Vga::new(), vec![255; 4 * Vga::SHOWN]));
}

#[unsafe(no_mangle)]
extern "C" fn draw(seconds: f64) -> *const u8 {
    TEAPOT.with_borrow_mut(|(scene, renderer, vga, rgba)| {
        scene.set_time(seconds);
        renderer.draw(scene, vga).expect("the scene has no fault");
        let palette = vga.palette();
        for (pixel, &index) in rgba.chunks_exact_mut(4).zip(vga.pixels()) {
            let color = palette[index];
            pixel[..3].copy_from_slice(&[color.r, color.g, color.b]);
        }
        rgba.as_ptr()
    })
}
