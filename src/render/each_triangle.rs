//! Every triangle of a frame with everything that the raster would receive, for the laboratory.

use super::hidden_surfaces::each_run;
use super::pipelines::Pipelines;
use super::{RenderError, Renderer, Screen, Stats};
use crate::palette::Ramp;
use crate::raster::effects::{Attributes, PixelPipeline};
use crate::raster::{Interpolation, Vertex};
use crate::scene::Scene;

/// A triangle to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct DrawnTriangle<'a> {
    /// The object's index in the scene.
    pub object: usize,
    /// The face's index in the object's mesh, or in the mesh that splitting made of it. Parts of a clipped face share
    /// its index. `None` on the 16.16 path, which does not report it.
    pub face: Option<usize>,
    /// The corners, projected and lit.
    pub vertices: &'a [Vertex; 3],
    /// Interpolation of its shades, if they come from its corners.
    pub interpolation: Interpolation,
    /// The palette entries of its surface's shades; `None` on the 16.16 path.
    pub ramp: Option<Ramp>,
    /// Stages that its pixels pass through, if there are any.
    pub effects: Option<DrawnEffects<'a>>,
}

/// Stages that the pixels of a triangle pass through.
#[derive(Clone, Copy, Debug)]
pub struct DrawnEffects<'a> {
    /// Attributes of the corners besides their shades.
    pub attributes: &'a [Attributes; 3],
    /// True if it is transparent, and drawn after everything opaque.
    pub transparent: bool,
    /// The stages.
    pub pipeline: &'a PixelPipeline<'a>,
}

/// Calls `visit` for every triangle that [`Renderer::draw`] would draw, in the order of
/// [`Renderer::for_each_triangle`], with everything that the raster would receive. Returns the work counts, except
/// those of the raster. Nothing is drawn, and later frames are unaffected.
///
/// # Errors
/// The errors of [`Renderer::draw`], before the first triangle.
pub fn each_triangle(
    renderer: &mut Renderer,
    scene: &Scene,
    screen: Screen,
    visit: &mut dyn FnMut(&DrawnTriangle<'_>),
) -> Result<Stats, RenderError> {
    let (mut stats, _) = renderer.prepare(scene, screen, None, true)?;
    renderer.last = None;
    let Renderer { cache, scratch, kernel, .. } = renderer;
    let pipelines = Pipelines { scene, cache, kernel: *kernel };
    let memory = (&mut scratch.integer, &mut scratch.pick, &mut scratch.counts);
    each_run(scene, cache, (*kernel, None), false, memory, &mut stats, &mut |object, run| {
        let state = &cache.states[object];
        let surfaces = state.geometry(&scene.objects()[object]).triangle_surfaces;
        for k in 0..run.picks.picks.len() {
            let (vertices, interpolation) = run.vertices(k);
            let face = (!cache.plan.is_integer).then(|| run.face(k));
            let ramp = face.map(|face| state.materials[usize::from(surfaces[face])].ramp);
            let plain = DrawnTriangle { object, face, vertices: &vertices, interpolation, ramp, effects: None };
            if !run.look.effects {
                visit(&plain);
                continue;
            }
            let (attributes, transparent) = (&run.attributes(k), run.look.transparent);
            pipelines.with(object, run.look, |pipeline| {
                let effects = Some(DrawnEffects { attributes, transparent, pipeline });
                visit(&DrawnTriangle { effects, ..plain });
            });
        }
    });
    Ok(stats)
}

/// Computes the plan and the vertices of a frame without drawing it, to measure their cost.
///
/// # Errors
/// The errors of [`Renderer::draw`].
pub fn make_vertices(renderer: &mut Renderer, scene: &Scene, screen: Screen) -> Result<(), RenderError> {
    renderer.prepare(scene, screen, None, true)?;
    renderer.last = None;
    Ok(())
}

/// Shows the shades of one channel (0 red, 1 green, 2 blue) instead of combining all three into a palette entry; `None`,
/// the default, combines them.
pub fn show_channel(renderer: &mut Renderer, channel: Option<usize>) {
    renderer.cache.tables.only_channel = channel;
    // The machine holds another image.
    renderer.last = None;
}
