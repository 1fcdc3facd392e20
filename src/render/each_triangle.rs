//! Every triangle of a frame with all that the raster would get, for the laboratory.

use super::face::Sink;
use super::pipelines::{Pipeline, Pipelines};
use super::{RenderError, Renderer, Screen, Stats, VertexPath};
use crate::palette::Ramp;
use crate::plan::FaceShading;
use crate::raster::effects::{Attributes, PixelPipeline};
use crate::raster::{DrawStats, Interpolation, Vertex};
use crate::scene::Scene;

/// A triangle that is to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct DrawnTriangle<'a> {
    /// The object's index in the scene.
    pub object: usize,
    /// The face's index in the object's mesh, or in what splitting made of it. Parts of a face that was clipped share its
    /// index. `None` on the 16.16 path, which does not tell.
    pub face: Option<usize>,
    /// The corners, projected and lit.
    pub vertices: &'a [Vertex; 3],
    /// Interpolation of its shades, where they come from its corners.
    pub interpolation: Interpolation,
    /// The palette entries of its surface's shades; `None` on the 16.16 path.
    pub ramp: Option<Ramp>,
    /// Stages that its pixels pass through, if there are any.
    pub effects: Option<DrawnEffects<'a>>,
}

/// Stages that the pixels of a triangle pass through.
#[derive(Clone, Copy, Debug)]
pub struct DrawnEffects<'a> {
    /// Attributes of the corners beside their shades.
    pub attributes: &'a [Attributes; 3],
    /// True if it shines through, and is drawn after all that does not.
    pub transparent: bool,
    /// The stages.
    pub pipeline: &'a PixelPipeline<'a>,
}

/// Hands the faces of an object to a visitor.
struct Visitor<'a, 'b> {
    pipelines: Pipelines<'a>,
    object: usize,
    triangle_surfaces: &'a [u16],
    visit: &'b mut dyn FnMut(&DrawnTriangle<'_>),
}

impl Visitor<'_, '_> {
    fn triangle<'t>(&self, face: u32, vertices: &'t [Vertex; 3], interpolation: Interpolation) -> DrawnTriangle<'t> {
        let face = face as usize;
        let surface = self.triangle_surfaces.get(face);
        let ramp = surface.and_then(|&surface| self.pipelines.ramp(self.object, surface));
        DrawnTriangle { object: self.object, face: Some(face), vertices, interpolation, ramp, effects: None }
    }
}

impl Sink for Visitor<'_, '_> {
    fn plain(&mut self, face: u32, vertices: &[Vertex; 3], interpolation: Interpolation) {
        let triangle = self.triangle(face, vertices, interpolation);
        (self.visit)(&triangle);
    }

    fn with_effects(
        &mut self,
        face: u32,
        vertices: &[Vertex; 3],
        attributes: &[Attributes; 3],
        surface: u16,
        shading: FaceShading,
    ) {
        let triangle = self.triangle(face, vertices, shading.interpolation());
        let transparent = self.pipelines.is_transparent(self.object, surface);
        self.pipelines.with(Pipeline { object: self.object, surface, shading }, |pipeline| {
            let effects = Some(DrawnEffects { attributes, transparent, pipeline });
            (self.visit)(&DrawnTriangle { effects, ..triangle });
            DrawStats::default()
        });
    }
}

impl Renderer {
    /// Hands every triangle that [`draw`](Self::draw) would draw to `visit`, in the order of
    /// [`for_each_triangle`](Self::for_each_triangle), with all that the raster would get. Nothing is drawn, and the frames
    /// that are drawn after it are those that would have been drawn without it.
    pub(crate) fn each_triangle(
        &mut self,
        scene: &Scene,
        screen: Screen,
        visit: &mut dyn FnMut(&DrawnTriangle<'_>),
    ) -> Result<Stats, RenderError> {
        let (mut stats, _) = self.prepare(scene, screen, None, true)?;
        self.last = None;
        let pipelines = Pipelines {
            scene,
            plan: &self.plan,
            states: &self.states,
            tables: &self.tables,
            kernel: self.settings.kernel,
        };
        for &object in &self.plan.order {
            let of_scene = &scene.objects()[object];
            if self.settings.vertex_path == VertexPath::Integer {
                let mut plain = |vertices: &[Vertex; 3], interpolation| {
                    visit(&DrawnTriangle { object, face: None, vertices, interpolation, ramp: None, effects: None });
                };
                self.integer.triangles(stats.shading, (object, of_scene), &mut stats, &mut plain);
            } else if let Some(faces) = self.states[object].faces(of_scene, &self.plan.objects[object]) {
                let triangle_surfaces = faces.geometry.triangle_surfaces;
                let mut visitor = Visitor { pipelines, object, triangle_surfaces, visit: &mut *visit };
                faces.draw(self.states[object].budget(), &mut stats, &mut (&mut visitor as &mut dyn Sink));
            }
        }
        Ok(stats)
    }
}
