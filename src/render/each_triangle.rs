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

impl Renderer {
    /// Calls `visit` for every triangle that [`draw`](Self::draw) would draw, in the order of
    /// [`for_each_triangle`](Self::for_each_triangle), with everything that the raster would receive. Draws nothing,
    /// and does not affect later frames.
    pub(crate) fn each_triangle(
        &mut self,
        scene: &Scene,
        screen: Screen,
        visit: &mut dyn FnMut(&DrawnTriangle<'_>),
    ) -> Result<Stats, RenderError> {
        let (mut stats, _) = self.prepare(scene, screen, None, true)?;
        self.last = None;
        let Self { cache, scratch, kernel, .. } = self;
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
}
