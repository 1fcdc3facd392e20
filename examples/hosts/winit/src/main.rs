//! Frames of mode13h that fill a winit window, by way of softbuffer.
use mode13h::{mesh::shapes, render::Renderer, scene::Scene, vga::Vga};
use std::{num::NonZeroU32, time::Instant};
use winit::{application::ApplicationHandler, error::EventLoopError, event::WindowEvent, event_loop::*, window::*};
type Surface = softbuffer::Surface<OwnedDisplayHandle, Window>;
struct App<Draw>(Draw, Option<Surface>);
impl<Draw: FnMut(&mut Surface)> ApplicationHandler for App<Draw> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        let attributes = Window::default_attributes().with_title("mode13h in winit");
        let window = events.create_window(attributes).expect("a window");
        let context = softbuffer::Context::new(events.owned_display_handle()).expect("a display");
        self.1 = Some(Surface::new(&context, window).expect("a surface"));
    }
    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match (event, &mut self.1) {
            (WindowEvent::RedrawRequested, Some(surface)) => (self.0)(surface),
            (WindowEvent::CloseRequested, _) => events.exit(),
            _ => {}
        }
    }
}

fn main() -> Result<(), EventLoopError> {
    let (mut scene, mut renderer, mut vga) = (Scene::showing(shapes::teapot(8)), Renderer::new(), Vga::new());
    let (began, mut colors) = (Instant::now(), vec![0; Vga::SHOWN]);
    let draw = |surface: &mut Surface| {
        scene.set_time(began.elapsed().as_secs_f64());
        renderer.draw(&scene, &mut vga).expect("a scene without a fault");
        vga.scan_out(&mut colors);
        let sides = <[u32; 2]>::from(surface.window().inner_size());
        let [width, height] = sides.map(|side| NonZeroU32::new(side).unwrap_or(NonZeroU32::MIN));
        surface.resize(width, height).expect("a window of this size");
        let mut shown = surface.buffer_mut().expect("a buffer");
        let place = |i: u32| i / width * 200 / height * 320 + i % width * 320 / width;
        shown.iter_mut().zip(0..).for_each(|(pixel, i)| *pixel = colors[place(i) as usize]);
        shown.present().expect("a window");
        surface.window().request_redraw();
    };
    EventLoop::new()?.run_app(&mut App(draw, None))
}
