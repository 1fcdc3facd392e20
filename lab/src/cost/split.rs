//! Splits a frame's time into parts.
//!
//! | part | how |
//! |---|---|
//! | plan | [`Renderer::make_plan`] alone |
//! | vertices | plan and vertices without any face, minus the plan |
//! | spans | what grows with the number of pixels: a frame twice as wide, minus the frame |
//! | set-up | the frame, minus all of the above |
//! | scan-out | [`Vga::scan_out`] alone |
//!
//! A frame of 640 × 200 pixels that are half as wide shows the same scene: it has the same vertices, triangles and
//! triangle rows, each row twice as long. The extra time is therefore what 320 × 200 pixels take in whatever loops draw
//! them, and no loop has to be changed or run in isolation. A loop's time before its first pixel and after its last
//! counts as set-up. Rows so short that they cover no pixel in one of the frames blur the line between the two parts;
//! the smaller the faces, the more.

use core::hint::black_box;
use std::time::Instant;

use super::Split;
use super::clock::Clock;
use super::configuration::Configuration;
use super::interleaved::{Spent, always_drawing};
use super::statistics::median;
use mode13h::internals;
use mode13h::raster::Frame;
use mode13h::render::{RenderError, Renderer, Screen};
use mode13h::scene::Scene;
use mode13h::vga::Vga;
use mode13h_conformance::Random;

/// [`Screen::MODE_13H`] with every pixel cut in two.
const WIDE: Screen = Screen { width: 640, height: 200, pixel_aspect: (5, 12) };

/// The minimum and maximum number of rounds.
const ROUNDS: (usize, usize) = (3, 301);

/// The maximum number of the given frames that are drawn.
const FRAMES: usize = 4;

/// Measured parts of a frame.
#[derive(Clone, Copy)]
enum Part {
    Plan,
    Vertices,
    Frame,
    WideFrame,
}

const PARTS: [Part; 4] = [Part::Plan, Part::Vertices, Part::Frame, Part::WideFrame];

impl Part {
    fn of(self, renderer: &mut Renderer, scene: &Scene, bytes: &mut [u8]) -> Result<(), RenderError> {
        match self {
            Self::Plan => renderer.make_plan(scene, Screen::MODE_13H).map(|plan| {
                black_box(plan);
            }),
            Self::Vertices => internals::make_vertices(renderer, scene, Screen::MODE_13H),
            Self::Frame => draw_into(renderer, scene, Screen::MODE_13H, bytes),
            Self::WideFrame => draw_into(renderer, scene, WIDE, bytes),
        }
    }
}

/// Splits the time of each configuration's frames, for about as long as `spent` says. Rounds are shuffled, as in an
/// [interleaved benchmark](super::interleaved), and each part's median counts.
pub(super) fn split(
    ways: &[&Configuration<'_>],
    frames: &[Scene],
    base: &dyn Fn() -> Renderer,
    spent: &Spent,
    progress: &dyn Fn(f64),
) -> Result<Vec<Split>, RenderError> {
    let mut chance = Random::again(spent.seed);
    let frames: Vec<&Scene> = frames.iter().step_by(frames.len().div_ceil(FRAMES)).collect();
    let mut renderers: Vec<[Renderer; 4]> =
        ways.iter().map(|way| PARTS.map(|_| always_drawing(way.apply(base())))).collect();
    let mut bytes = vec![0; (WIDE.width * WIDE.height) as usize];
    let mut order: Vec<(usize, usize)> =
        (0..ways.len()).flat_map(|way| (0..PARTS.len()).map(move |part| (way, part))).collect();
    let mut times: Vec<[Vec<f64>; 4]> = vec![Default::default(); ways.len()];
    let mut draw = |renderer: &mut Renderer, part: Part| -> Result<f64, RenderError> {
        let (time, result) =
            spent.clock.time(|| frames.iter().try_for_each(|scene| part.of(renderer, scene, &mut bytes)));
        result.map(|()| time / frames.len().max(1) as f64)
    };
    // Warm up.
    for &(way, part) in &order {
        draw(&mut renderers[way][part], PARTS[part])?;
    }
    let start = Instant::now();
    for round in 0..ROUNDS.1 {
        let elapsed = start.elapsed().as_secs_f64();
        progress((elapsed / spent.seconds).min(1.0));
        if round >= ROUNDS.0 && elapsed >= spent.seconds {
            break;
        }
        chance.shuffle(&mut order);
        for &(way, part) in &order {
            let time = draw(&mut renderers[way][part], PARTS[part])?;
            times[way][part].push(time);
        }
    }
    let scan_out = scan_out(spent.clock);
    Ok(times
        .iter()
        .map(|times| {
            let [plan, vertices, frame, wide] = [0, 1, 2, 3].map(|part: usize| median(&times[part]));
            let spans = (wide - frame).clamp(0.0, (frame - vertices).max(0.0));
            Split {
                plan,
                vertices: (vertices - plan).max(0.0),
                setup: (frame - vertices - spans).max(0.0),
                spans,
                scan_out,
            }
        })
        .collect())
}

fn draw_into(renderer: &mut Renderer, scene: &Scene, screen: Screen, bytes: &mut [u8]) -> Result<(), RenderError> {
    // No side exceeds 4,096, and there are as many bytes as the wider frame needs.
    if let Ok(frame) = Frame::new(bytes, screen.width, screen.height, screen.width as usize) {
        black_box(renderer.draw_frame(scene, frame, screen.pixel_aspect)?);
    }
    Ok(())
}

/// The time of a scan-out: the median of 51.
fn scan_out(clock: Clock) -> f64 {
    let (vga, mut colors) = (Vga::new(), vec![0; Vga::SHOWN]);
    let times: Vec<f64> = (0..51).map(|_| clock.time(|| vga.scan_out(black_box(&mut colors))).0).collect();
    median(&times)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mode13h::mesh::shapes;
    use mode13h::settings::Shading;

    #[test]
    fn the_parts_are_those_of_the_frame() {
        let frames = [Scene::showing(shapes::sphere(24, 12))];
        let ways = [Configuration::shading(Shading::Gouraud88), Configuration::shading(Shading::Phong)];
        let ways: Vec<&Configuration<'_>> = ways.iter().collect();
        let spent = Spent { clock: Clock::WALL, seconds: 0.3, at_most: false, seed: 1 };
        let split = split(&ways, &frames, &Renderer::new, &spent, &|_| {}).expect("a scene that can be drawn");
        assert_eq!(split.len(), 2);
        for Split { plan, vertices, spans, setup, scan_out } in &split {
            assert!([plan, vertices, scan_out].iter().all(|time| **time > 0.0), "{split:?}");
            assert!(setup + spans > 0.0, "{split:?}");
        }
        // Lighting every pixel of a sphere as large as the screen is hundreds of times the work of an addition.
        assert!(split[1].spans > 2.0 * split[0].spans, "{split:?}");
    }

    #[test]
    fn the_wide_frame_shows_the_same() {
        let scene = Scene::showing(shapes::torus(48, 24));
        let pixels = |screen: Screen| {
            let mut bytes = vec![0; (screen.width * screen.height) as usize];
            draw_into(&mut Renderer::new(), &scene, screen, &mut bytes).expect("a legal scene");
            bytes
        };
        let (narrow, wide) = (pixels(Screen::MODE_13H), pixels(WIDE));
        let covered = |bytes: &[u8]| bytes.iter().filter(|byte| **byte > 0).count() as f64;
        // Twice as many, except at the silhouette: each row has at most four ends.
        assert!((covered(&wide) - 2.0 * covered(&narrow)).abs() < 4.0 * 200.0);
    }
}
