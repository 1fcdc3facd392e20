//! Frames of mode13h as a picture among the widgets of egui.

use eframe::egui;
use mode13h::{Angle, mesh::shapes, render::Renderer, scene::Scene, vga::Vga};

struct Teapot(Scene, Renderer, Vga, Vec<u8>, f64, egui::TextureHandle);

impl eframe::App for Teapot {
    fn update(&mut self, context: &egui::Context, _: &mut eframe::Frame) {
        let Teapot(scene, renderer, vga, rgba, degrees, texture) = self;
        egui::CentralPanel::default().show(context, |ui| {
            ui.add(egui::Slider::new(degrees, 0.0..=360.0).suffix("°").text("turn"));
            scene.objects_mut()[0].angles[1] = Angle::from_degrees(*degrees);
            renderer.draw(scene, vga).expect("the scene has no fault");
            vga.scan_out_rgba(rgba);
            let image = egui::ColorImage::from_rgba_unmultiplied([Vga::WIDTH, Vga::HEIGHT], rgba);
            texture.set(image, egui::TextureOptions::NEAREST);
            // As on a VGA's screen: 320 × 200 pixels that fill 4:3.
            ui.image((texture.id(), egui::vec2(960.0, 720.0)));
        });
    }
}

fn main() -> eframe::Result {
    let open = |creation: &eframe::CreationContext| {
        let texture = creation.egui_ctx.load_texture("frame", egui::ColorImage::example(), Default::default());
        let (scene, rgba) = (Scene::showing(shapes::teapot(8)), vec![0; 4 * Vga::SHOWN]);
        Teapot(scene, Renderer::new(), Vga::new(), rgba, 30.0, texture)
    };
    let viewport = egui::ViewportBuilder::default().with_inner_size([976.0, 764.0]);
    let options = eframe::NativeOptions { viewport, ..Default::default() };
    eframe::run_native("mode13h in egui", options, Box::new(|creation| Ok(Box::new(open(creation)))))
}
