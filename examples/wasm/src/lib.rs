//! A teapot for a canvas: `draw(seconds)` returns the address of 320 × 200 pixels of red, green, blue and alpha.

use std::cell::RefCell;

use mode13h::{mesh::shapes, render::Renderer, scene::Scene, vga::Vga};

thread_local! {
    static TEAPOT: RefCell<(Scene, Renderer, Vga, Vec<u8>)> =
        RefCell::new((Scene::showing(shapes::teapot(8)), Renderer::new(), Vga::new(), vec![0; 4 * Vga::SHOWN]));
}

#[unsafe(no_mangle)]
extern "C" fn draw(seconds: f64) -> *const u8 {
    TEAPOT.with_borrow_mut(|(scene, renderer, vga, rgba)| {
        scene.set_time(seconds);
        renderer.draw(scene, vga).expect("the scene has no fault");
        vga.scan_out_rgba(rgba);
        rgba.as_ptr()
    })
}
