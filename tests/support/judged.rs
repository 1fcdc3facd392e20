//! A frame whose every byte is compared with the oracle's.

use mode13h::raster::{Frame, Interpolation, Vertex};
use mode13h::render::{Renderer, Screen, Stats};
use mode13h::scene::Scene;
use mode13h::settings::HiddenSurfaces;

use mode13h_conformance::oracle;

/// A frame, the triangles that the raster got for it, and how often they cover each pixel.
pub struct Judged {
    pub triangles: Vec<([Vertex; 3], Interpolation)>,
    pub counts: Vec<u32>,
    pub stats: Stats,
}

/// Draws a scene, and compares its bytes with the oracle's for the triangles that the raster got.
pub fn judged(renderer: &mut Renderer, scene: &Scene, screen: Screen) -> Judged {
    let mut triangles = Vec::new();
    let stats = renderer
        .for_each_triangle(scene, screen, |vertices, interpolation| triangles.push((*vertices, interpolation)))
        .expect("a legal scene");
    let compares = stats.hidden_surfaces == HiddenSurfaces::DepthBuffer;
    let size = (screen.width * screen.height) as usize;
    let (mut expected, mut nearest, mut counts) = (vec![scene.background; size], vec![0; size], vec![0; size]);
    for (vertices, interpolation) in &triangles {
        let pixels = oracle::pixels(vertices, *interpolation, screen.width as i32, screen.height as i32);
        let depths = (!pixels.is_empty()).then(|| oracle::Depths::of_vertices(vertices));
        for (pixel, depths) in pixels.into_iter().filter_map(|pixel| Some((pixel, depths.as_ref()?))) {
            let place = (pixel.y * screen.width as i32 + pixel.x) as usize;
            counts[place] += 1;
            let depth = depths.at(pixel.x, pixel.y);
            if !compares || depth > nearest[place] {
                (nearest[place], expected[place]) = (depth, pixel.byte);
            }
        }
    }
    let mut bytes = vec![0; size];
    let frame = Frame::new(&mut bytes, screen.width, screen.height, screen.width as usize).expect("legal");
    let stats = renderer.draw_frame(scene, frame, screen.pixel_aspect).expect("legal");
    let differs = bytes.iter().zip(&expected).position(|(is, should)| is != should);
    assert_eq!(differs, None, "{:?} instead of {:?} of {triangles:?}", bytes, expected);
    Judged { triangles, counts, stats }
}
