//! Vertices on fewer bits than 8 after the point.

use mode13h::mesh::shapes;
use mode13h::raster::Frame;
use mode13h::render::{Renderer, Screen};
use mode13h::scene::Scene;
use mode13h::settings::Settings;
use mode13h::span::Kernel;

const SCREEN: Screen = Screen::MODE_13H;

/// The corners of a scene's triangles, in 1/256 pixel.
fn corners(bits: Option<u8>, kernel: Kernel) -> Vec<[i32; 2]> {
    let mut renderer = Renderer::new();
    renderer.kernel = kernel;
    renderer.settings = Settings { vertex_bits: bits, ..Settings::default() };
    let mut corners = Vec::new();
    // Both sides of a face that rounding turns over are there.
    let mut scene = Scene::showing(shapes::torus(12, 8));
    scene.objects_mut()[0].angles[1] = mode13h::Angle::from_degrees(17.0);
    let triangle = |vertices: &[mode13h::raster::Vertex; 3], _| {
        corners.extend(vertices.iter().map(|v| [v.x().to_bits(), v.y().to_bits()]));
    };
    renderer.for_each_triangle(&scene, SCREEN, triangle).expect("a legal scene");
    corners
}

/// Every coordinate is the one with 8 bits, rounded half up, and every kernel has it.
#[test]
fn vertices_are_rounded_to_as_many_bits_as_asked() {
    for bits in 0..=8 {
        let unit = 1 << (8 - bits);
        for kernel in Kernel::available() {
            let rounded = corners(Some(bits), kernel);
            assert!(rounded.len() > 100);
            assert!(rounded.iter().flatten().all(|c| c.rem_euclid(unit) == 0), "{bits} bits, {kernel}");
            let exact = corners(None, kernel);
            let half_up = |c: i32| (f64::from(c) / f64::from(unit) + 0.5).floor() as i32 * unit;
            // Rounding may turn a face over or make it vanish, so that another number of them is drawn.
            assert!(rounded.iter().all(|corner| exact.iter().any(|of| of.map(half_up) == *corner)), "{bits}, {kernel}");
        }
    }
}

/// A renderer that has vertices rounds them again when it is told to, and takes them back.
#[test]
fn rounding_is_a_setting_like_any_other() {
    let scene = Scene::showing(shapes::torus(24, 12));
    let mut kept = Renderer::new();
    let drawn = |bits: Option<u8>, renderer: &mut Renderer| {
        let mut pixels = vec![0; 64_000];
        renderer.settings.vertex_bits = bits;
        let frame = Frame::new(&mut pixels, 320, 200, 320).expect("a frame");
        renderer.draw_frame(&scene, frame, SCREEN.pixel_aspect).expect("a legal scene");
        pixels
    };
    let plain = drawn(None, &mut Renderer::new());
    let whole = drawn(Some(0), &mut Renderer::new());
    assert!(plain != whole);
    for (bits, wanted) in [(None, &plain), (Some(0), &whole), (Some(0), &whole), (Some(8), &plain), (None, &plain)] {
        assert!(drawn(bits, &mut kept) == *wanted, "{bits:?}");
    }
}
