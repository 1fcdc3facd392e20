//! The right side of a picture: the engine's own calls and nothing else.

use super::face::{Corner, Face, Segment};
use super::panel::Panel;
use crate::museum::polygon::{self, TableRow};
use mode13h::raster::{Frame, Interpolation, Raster, Vertex};
use mode13h::render::{Renderer, Screen};
use mode13h::scene::Scene;

/// A triangle as the raster takes it.
pub type Triangle = ([Vertex; 3], Interpolation);

/// Bytes that drawing starts from. Two of them, so that what was drawn can be distinguished from what was there before.
const EMPTY: [u8; 2] = [0x00, 0xFF];

/// Adds what `draw` draws to a panel. It is called twice, with frames of different bytes: a pixel was drawn if it comes
/// out the same. Frames are a few dozen pixels a side, so none is rejected.
fn add(panel: &mut Panel, mut draw: impl FnMut(Frame<'_>, u8)) {
    let (width, height) = (panel.width(), panel.height());
    let [a, b] = EMPTY.map(|empty| {
        let mut bytes = vec![empty; width * height];
        if let Ok(frame) = Frame::new(&mut bytes, width as u32, height as u32, width) {
            draw(frame, empty);
        }
        bytes
    });
    for (at, (byte, other)) in a.iter().zip(&b).enumerate() {
        if byte == other {
            panel.write((at % width) as i32, (at / width) as i32, *byte);
        }
    }
}

/// Draws faces with [`Raster::triangle`], one after another, each counted separately; with a depth buffer, all into one
/// frame.
pub(super) fn draw_faces(size: (usize, usize), faces: &[Face], depth_tested: bool) -> Panel {
    let (mut panel, triangles) = (Panel::new(size), triangles(faces));
    if depth_tested {
        let mut depths: Vec<u32> = Vec::new();
        add(&mut panel, |frame, _| {
            let mut raster = Raster::new(frame).with_cleared_depth(&mut depths);
            for (vertices, interpolation) in &triangles {
                raster.triangle(vertices, *interpolation);
            }
        });
    } else {
        for (vertices, interpolation) in &triangles {
            add(&mut panel, |frame, _| {
                Raster::new(frame).triangle(vertices, *interpolation);
            });
        }
        panel.is_counted = true;
    }
    panel
}

/// Draws triangles without a depth buffer, in bands of `rows` rows, each band a frame of its own.
pub(super) fn draw_in_bands(size: (usize, usize), triangles: &[Triangle], rows: usize) -> Panel {
    let mut panel = Panel::new(size);
    add(&mut panel, |mut frame, _| {
        for band in frame.bands(rows as u32) {
            let mut raster = Raster::new(band);
            for (vertices, interpolation) in triangles {
                raster.triangle(vertices, *interpolation);
            }
        }
    });
    panel
}

/// Draws convex polygons with the Hungarian tutorial's table of rows, from the museum.
pub(super) fn draw_by_table(size: (usize, usize), polygons: &[&[Vertex]]) -> Panel {
    let mut panel = Panel::new(size);
    add(&mut panel, |mut frame, _| {
        let mut table = vec![TableRow::default(); size.1];
        for vertices in polygons {
            // All polygons are convex, and the table has a row for each of the frame's.
            let clip = frame.bounds();
            let _ = polygon::draw(&mut frame, clip, vertices, Interpolation::default(), &mut table);
        }
    });
    panel
}

/// Turns faces into triangles for the raster.
pub(super) fn triangles(faces: &[Face]) -> Vec<Triangle> {
    faces.iter().map(|face| (face.corners.map(Corner::vertex), face.interpolation)).collect()
}

/// Draws a scene with [`Renderer::draw_frame`] on square pixels; also returns the triangles that it passes to the
/// raster. Empty if the scene is refused; no case has such a scene.
pub(super) fn draw_scene(size: (usize, usize), scene: &Scene) -> (Panel, Vec<Triangle>) {
    let mut renderer = Renderer::new();
    let mut panel = Panel::new(size);
    let mut scene = scene.clone();
    add(&mut panel, |frame, empty| {
        scene.background = empty;
        let _ = renderer.draw_frame(&scene, frame, (1, 1));
    });
    let mut triangles = Vec::new();
    let screen = Screen { width: size.0 as u32, height: size.1 as u32, pixel_aspect: (1, 1) };
    let _ = renderer
        .for_each_triangle(&scene, screen, |vertices, interpolation| triangles.push((*vertices, interpolation)));
    (panel, triangles)
}

/// The edges of triangles, in pixels.
pub(super) fn outline(triangles: &[Triangle]) -> Vec<Segment> {
    let point = |v: &Vertex| (f64::from(v.x().to_bits()) / 256.0, f64::from(v.y().to_bits()) / 256.0);
    let edges = |[a, b, c]: [(f64, f64); 3]| [[a, b], [b, c], [c, a]];
    triangles.iter().flat_map(|(vertices, _)| edges(vertices.each_ref().map(point))).collect()
}

/// The edges that belong to only one triangle: the silhouette of a ball.
pub(super) fn silhouette(edges: &[Segment]) -> Vec<Segment> {
    let shared = |[a, b]: &Segment| edges.contains(&[*b, *a]);
    edges.iter().filter(|edge| !shared(edge)).copied().collect()
}
