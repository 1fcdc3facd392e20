//! What each shading of the ladder takes for a frame, vertices and all, and for a pixel that it writes.
//!
//! ```text
//! cargo bench --bench shadings
//! MODE13H_SCENES=torus,phong cargo bench --bench shadings
//! ```
//!
//! Eight moments of a scene's round are drawn one after the other, so that every frame is a new one. Each round times
//! every shading once, in a new order, and the figure is the median over the rounds.

use std::hint::black_box;
use std::time::Instant;

use mode13h::render::Renderer;
use mode13h::scene::Scene;
use mode13h::settings::Shading;
use mode13h::vga::Vga;
use mode13h_assets::shipped;

const SCENES: &str = "torus,teapot,flash,fog";
const MOMENTS: usize = 8;

/// Draws the frames; how many pixels were written.
fn draw(renderer: &mut Renderer, frames: &[Scene], vga: &mut Vga) -> u64 {
    frames.iter().map(|scene| u64::from(renderer.draw(scene, vga).expect("a shipped scene").raster.pixels)).sum()
}

fn main() {
    let is_bench = std::env::args().any(|argument| argument == "--bench");
    // Under `cargo test` it only has to run.
    let rounds = if is_bench { 41 } else { 1 };
    let names = std::env::var("MODE13H_SCENES").unwrap_or_else(|_| SCENES.to_string());
    println!("median of {rounds} rounds of {MOMENTS} frames");
    println!("{:>10} {:>24} {:>12} {:>10} {:>10}", "scene", "shading", "ns/frame", "pixels", "ns/pixel");
    let mut vga = Vga::new();
    for name in names.split(',') {
        let scene = name.parse::<shipped::Shipped>().expect("a shipped scene").load().expect("it loads").scene;
        let frames: Vec<Scene> = (0..MOMENTS)
            .map(|i| {
                let mut scene = scene.clone();
                scene.set_time(i as f64 / MOMENTS as f64 * scene.duration);
                scene
            })
            .collect();
        let mut renderers: Vec<Renderer> = Shading::ALL
            .iter()
            .map(|&shading| {
                let mut renderer = Renderer::new();
                renderer.settings.accuracy = Some(shading.into());
                renderer
            })
            .collect();
        let pixels: Vec<u64> = renderers.iter_mut().map(|renderer| draw(renderer, &frames, &mut vga)).collect();
        let mut times = vec![Vec::new(); renderers.len()];
        for round in 0..rounds {
            for i in 0..renderers.len() {
                // 7 and the number of shadings have no common factor.
                let which = (i * 7 + round) % renderers.len();
                let started = Instant::now();
                black_box(draw(&mut renderers[which], &frames, &mut vga));
                times[which].push(started.elapsed().as_secs_f64() * 1e9);
            }
        }
        for ((shading, times), pixels) in Shading::ALL.iter().zip(&mut times).zip(pixels) {
            times.sort_by(f64::total_cmp);
            let time = times[times.len() / 2];
            println!(
                "{name:>10} {:>24} {:>12.0} {:>10} {:>10.3}",
                shading.name(),
                time / MOMENTS as f64,
                pixels / MOMENTS as u64,
                time / pixels as f64
            );
        }
    }
}
