//! A frame whose every byte is compared with the oracle's.

use mode13h::raster::{Frame, Interpolation, Vertex};
use mode13h::render::{Renderer, Screen, Stats};
use mode13h::scene::Scene;
use mode13h::settings::HiddenSurfaces;

use mode13h_conformance::oracle;

/// A frame as the oracle draws it.
pub struct Expected {
    pub triangles: Vec<([Vertex; 3], Interpolation)>,
    pub bytes: Vec<u8>,
    /// How often the triangles cover each pixel.
    pub counts: Vec<u32>,
}

/// Draws the triangles that the raster gets for a scene by the oracle. Each of its bytes must be within the bound.
pub fn by_the_oracle(renderer: &mut Renderer, scene: &Scene, screen: Screen) -> Expected {
    let mut triangles = Vec::new();
    let stats = renderer
        .for_each_triangle(scene, screen, |vertices, interpolation| triangles.push((*vertices, interpolation)))
        .expect("a legal scene");
    // Without depth comparison the last face is seen. With exact cover no two share a pixel then.
    let compares = stats.hidden_surfaces == HiddenSurfaces::DepthBuffer;
    let size = (screen.width * screen.height) as usize;
    let (mut bytes, mut nearest, mut counts) = (vec![scene.background; size], vec![0; size], vec![0; size]);
    for (vertices, interpolation) in &triangles {
        let pixels = oracle::pixels(vertices, *interpolation, screen.width as i32, screen.height as i32);
        let depths = (!pixels.is_empty()).then(|| oracle::Depths::of_vertices(vertices));
        for (oracle::Pixel { x, y, byte }, depths) in
            pixels.into_iter().filter_map(|pixel| Some((pixel, depths.as_ref()?)))
        {
            if let Some((n, d)) = oracle::bound(*interpolation, screen.width.into()) {
                let exact = oracle::exact_shade(vertices, *interpolation, oracle::centre(x, y));
                assert!(exact.is_within(i128::from(byte) * 256, n, d), "({x}, {y}) of {vertices:?}");
            }
            let place = (y * screen.width as i32 + x) as usize;
            counts[place] += 1;
            let depth = match interpolation.has_exact_cover() {
                true => depths.at(x, y),
                false => oracle::depth_beyond(vertices, x, y),
            };
            if !compares || depth > nearest[place] {
                (nearest[place], bytes[place]) = (depth, byte);
            }
        }
    }
    Expected { triangles, bytes, counts }
}

/// Draws a scene, and compares its bytes with the oracle's for the triangles that the raster got.
pub fn judged(renderer: &mut Renderer, scene: &Scene, screen: Screen) -> (Expected, Stats) {
    let expected = by_the_oracle(renderer, scene, screen);
    let mut bytes = vec![0; expected.bytes.len()];
    let frame = Frame::new(&mut bytes, screen.width, screen.height, screen.width as usize).expect("legal");
    let stats = renderer.draw_frame(scene, frame, screen.pixel_aspect).expect("legal");
    let differs = bytes.iter().zip(&expected.bytes).position(|(is, should)| is != should);
    assert_eq!(differs, None, "{bytes:?} instead of {:?} of {:?}", expected.bytes, expected.triangles);
    (expected, stats)
}
