//! One pixel of a frame: which triangles cover it, which of them is visible, and what each stage makes of its byte.

use mode13h::internals::raster::effects::Attributes;
use mode13h::internals::raster::reference::cover::SortedTriangle;
use mode13h::internals::raster::reference::depth::DepthPlane;
use mode13h::internals::{self, DrawnTriangle};
use mode13h::palette::Ramp;
use mode13h::plan;
use mode13h::raster::{Interpolation, Vertex};
use mode13h::render::{RenderError, Renderer, Screen, Stats};
use mode13h::scene::Scene;
use mode13h::settings::HiddenSurfaces;

use super::edge::has_edge_at;
use super::one_pixel::{Bytes, OnePixel};

/// A triangle that covers the pixel, or has an edge through its centre.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met {
    /// Number of the frame's triangles before it.
    number: usize,
    pub(super) object: usize,
    /// Its index in the mesh, or in the mesh that splitting made; `None` if unknown.
    pub(super) face: Option<usize>,
    pub(super) vertices: [Vertex; 3],
    pub(super) interpolation: Interpolation,
    /// Palette entries of its surface's shades, if known.
    pub(super) ramp: Option<Ramp>,
    /// Attributes at the vertices; `None` for a face without effects.
    pub(super) attributes: Option<[Attributes; 3]>,
    pub(super) depth: u32,
    pub(super) fate: Fate,
    /// Output of the face's stages at the pixel; `None` if the face is not visible.
    pub(super) bytes: Option<Bytes>,
}

/// Fate of a triangle at a pixel.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Fate {
    /// The triangle is visible.
    Seen,
    /// The triangle is translucent and visible, in front of others.
    SeenThrough,
    /// The triangle is farther away than the visible one, or equally far and drawn later.
    Behind,
    /// The visible triangle was painted over it.
    PaintedOver,
    /// An edge runs through the pixel's centre, but it is neither a top nor a left edge, so the pixel belongs to the
    /// neighbour.
    NotItsEdge,
}

/// Everything about a pixel.
#[derive(Debug)]
pub(super) struct Trace {
    pub(super) stats: Stats,
    /// Triangles in drawing order; translucent ones last.
    pub(super) met: Vec<Met>,
    pub(super) byte: u8,
    /// The plan in words.
    pub(super) rows: Vec<plan::Row>,
}

/// Everything about the pixel (`x`, `y`), which lies inside the screen: its triangles in drawing order, the fate of
/// each, and the stages of the visible ones.
///
/// # Errors
/// See [`Renderer::draw`].
pub(super) fn trace(
    renderer: &mut Renderer,
    scene: &Scene,
    screen: Screen,
    x: u32,
    y: u32,
) -> Result<Trace, RenderError> {
    let plan = renderer.make_plan(scene, screen)?;
    let (hidden_surfaces, chosen) = (plan.hidden_surfaces(), plan.is_chosen());
    // With the scan-line method every shading has exact cover.
    let exact = hidden_surfaces == HiddenSurfaces::ScanLine;
    let mut pixel = OnePixel { screen, x, y, kernel: renderer.kernel, row: vec![0; screen.width as usize] };
    let (mut met, mut number) = (Vec::new(), 0);
    let stats = internals::each_triangle(renderer, scene, screen, &mut |triangle| {
        met.extend(meet(triangle, number, &mut pixel, exact));
        number += 1;
    })?;
    let rows = renderer.plan().rows(scene);
    decide_fates(&mut met, hidden_surfaces, chosen);
    let mut byte = scene.background;
    // The opaque one comes first; translucent ones follow, far to near.
    debug_assert!(met.iter().filter(|met| met.fate == Fate::Seen).count() <= 1);
    for fate in [Fate::Seen, Fate::SeenThrough] {
        for met in met.iter_mut().filter(|met| met.fate == fate) {
            // Its stages are known only while the triangle is visited.
            let mut number = 0;
            internals::each_triangle(renderer, scene, screen, &mut |triangle| {
                if number == met.number {
                    met.bytes = Some(pixel.bytes(triangle, byte, exact));
                }
                number += 1;
            })?;
            byte = met.bytes.map_or(byte, |bytes| bytes.byte);
        }
    }
    Ok(Trace { stats, met, byte, rows })
}

/// The triangle's record if it covers or touches the pixel.
fn meet(triangle: &DrawnTriangle<'_>, number: usize, pixel: &mut OnePixel, exact: bool) -> Option<Met> {
    let DrawnTriangle { object, face, vertices, interpolation, ramp, effects } = *triangle;
    let by = if exact || effects.is_some() { Interpolation::Flat(0) } else { interpolation };
    let covers = pixel.draw(0, |raster| raster.triangle(vertices, by)).is_some();
    if !covers && (!by.has_exact_cover() || !has_edge_at(vertices, pixel.x, pixel.y)) {
        return None;
    }
    // Column and row of a frame.
    let depth = DepthPlane::new(&SortedTriangle::new(vertices)).at(pixel.x as i32, pixel.y as i32);
    let fate = match effects {
        _ if !covers => Fate::NotItsEdge,
        Some(effects) if effects.transparent => Fate::SeenThrough,
        _ => Fate::Seen,
    };
    let attributes = effects.map(|effects| *effects.attributes);
    Some(Met { number, object, face, vertices: *vertices, interpolation, ramp, attributes, depth, fate, bytes: None })
}

/// Sum of the depths of a face's corners.
fn depth_of(vertices: &[Vertex; 3]) -> u64 {
    vertices.iter().map(|v| u64::from(v.depth())).sum()
}

/// Decides for each face that covers the pixel whether it is visible under the given hidden-surface method, and moves
/// translucent ones to the end, far to near.
fn decide_fates(met: &mut [Met], way: HiddenSurfaces, chosen: bool) {
    let tests_depth = matches!(way, HiddenSurfaces::DepthBuffer | HiddenSurfaces::ScanLine);
    let opaque = || (0..met.len()).filter(|&i| met[i].fate == Fate::Seen);
    let seen = match way {
        // The first of those with equal depths.
        _ if tests_depth => opaque().filter(|&i| met[i].depth > 0).rev().max_by_key(|&i| met[i].depth),
        // The last one painted: of equal ones, the last.
        HiddenSurfaces::PainterOrder if !chosen => opaque().max_by_key(|&i| depth_of(&met[i].vertices)),
        _ => opaque().next_back(),
    };
    let wall = seen.map_or(0, |i| met[i].depth);
    for (i, met) in met.iter_mut().enumerate() {
        met.fate = match met.fate {
            Fate::Seen if Some(i) == seen => Fate::Seen,
            Fate::Seen if tests_depth => Fate::Behind,
            Fate::Seen => Fate::PaintedOver,
            Fate::SeenThrough if tests_depth && met.depth <= wall => Fate::Behind,
            other => other,
        };
    }
    // Far to near, which is the renderer's drawing order.
    met.sort_by_key(|met| (met.fate == Fate::SeenThrough).then(|| depth_of(&met.vertices)));
}
