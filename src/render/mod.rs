//! From a scene to bytes, frame by frame.
//!
//! | file | what |
//! |---|---|
//! | `view` | camera and object to one matrix; projection; the one rounding |
//! | `stage` | an object's vertices, lit and projected, then its faces |
//! | `clip` | near plane and guard band |
//! | `vertex_path`, `integer` | the choice between f32 and 16.16; a scene for the latter |
//! | `rung` | the techniques of shading |
//! | `hidden`, `painter` | the ways to leave out hidden surfaces |
//! | `stats` | what a frame came to |
//! | `automatic` | a palette for a model, from what is seen of it over a turn |
//!
//! A frame goes through three stages for every object: its vertices are transformed, lit and
//! rounded, each once; its faces pick theirs, are clipped where they must be and left out where
//! they are turned away; the [`raster`](crate::raster) draws what is left.

mod automatic;
mod clip;
mod hidden;
mod integer;
mod painter;
mod rung;
mod stage;
mod stats;
mod vertex_path;
mod view;

use alloc::vec::Vec;
use core::fmt;

use self::integer::IntegerPath;
use self::stage::{LitVertex, Paint, Stage};
use self::view::{ObjectView, View};
use crate::light::Beam;
use crate::raster::scan_line::Lists;
use crate::raster::{Drawn, Frame, Raster, Shading, Vertex};
use crate::scene::Scene;
use crate::span::Kernel;
use crate::vga::Vga;
pub use automatic::{Seen, automatic, seen};
pub use hidden::{HiddenSurfaces, UnknownHiddenSurfaces};
pub use rung::{Rung, UnknownRung};
pub use stats::Stats;
pub use vertex_path::{UnknownVertexPath, VertexPath};
pub use view::Screen;

/// Why a scene could not be drawn.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum RenderError {
    /// The camera.
    Camera(&'static str),
    /// An object, by its place in the scene.
    Object {
        /// Its place, from 0.
        index: usize,
        /// What is wrong.
        what: &'static str,
    },
    /// A light, by its place in the scene.
    Light {
        /// Its place, from 0.
        index: usize,
        /// What is wrong.
        what: &'static str,
    },
    /// The scene's ambient light is not finite.
    Ambient,
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Camera(what) => write!(f, "camera: {what}"),
            Self::Object { index, what } => write!(f, "object {index}: {what}"),
            Self::Light { index, what } => write!(f, "light {index}: {what}"),
            Self::Ambient => f.write_str("the ambient light must be finite"),
        }
    }
}

impl core::error::Error for RenderError {}

/// Draws scenes. It keeps nothing of a frame but the memory that the next one will need too.
#[derive(Debug)]
pub struct Renderer {
    rung: Rung,
    vertex_path: VertexPath,
    kernel: Kernel,
    forced: Option<HiddenSurfaces>,
    views: Vec<ObjectView>,
    integer: IntegerPath,
    /// The objects as they are drawn.
    order: Vec<usize>,
    beams: Vec<Beam>,
    paints: Vec<Paint>,
    lit: Vec<LitVertex>,
    depths: Vec<u32>,
    /// Of a frame that must be known whole before it is drawn.
    triangles: Vec<([Vertex; 3], Shading)>,
    lists: Lists,
}

impl Renderer {
    /// A renderer with the default rung and the fastest kernel.
    #[must_use]
    pub fn new() -> Self {
        Self {
            rung: Rung::default(),
            vertex_path: VertexPath::default(),
            kernel: Kernel::fastest(),
            forced: None,
            views: Vec::new(),
            integer: IntegerPath::default(),
            order: Vec::new(),
            beams: Vec::new(),
            paints: Vec::new(),
            lit: Vec::new(),
            depths: Vec::new(),
            triangles: Vec::new(),
            lists: Lists::default(),
        }
    }

    /// Chooses the technique of shading.
    pub fn set_rung(&mut self, rung: Rung) {
        self.rung = rung;
    }

    /// The technique of shading.
    #[must_use]
    pub fn rung(&self) -> Rung {
        self.rung
    }

    /// Chooses the way from mesh to vertices.
    pub fn set_vertex_path(&mut self, vertex_path: VertexPath) {
        self.vertex_path = vertex_path;
    }

    /// The way from mesh to vertices.
    #[must_use]
    pub fn vertex_path(&self) -> VertexPath {
        self.vertex_path
    }

    /// Chooses the span kernel. All give the same bytes.
    pub fn set_kernel(&mut self, kernel: Kernel) {
        self.kernel = kernel;
    }

    /// The span kernel.
    #[must_use]
    pub fn kernel(&self) -> Kernel {
        self.kernel
    }

    /// Forces a way to leave out hidden surfaces, right or wrong; with `None`, as a new renderer has it,
    /// the cheapest that is right for the scene is taken.
    pub fn set_hidden_surfaces(&mut self, way: Option<HiddenSurfaces>) {
        self.forced = way;
    }

    /// The way that is forced, if one is.
    #[must_use]
    pub fn hidden_surfaces(&self) -> Option<HiddenSurfaces> {
        self.forced
    }

    /// Draws `scene` on the machine: sets its DAC to the scene's palette, if it has one, clears its
    /// pixels and draws.
    ///
    /// # Errors
    /// A number in the scene that is not finite or not in its range; on the integer path one that 16.16
    /// can't hold beside the others. The machine is then left as it was.
    pub fn draw(&mut self, scene: &Scene, vga: &mut Vga) -> Result<Stats, RenderError> {
        let way = self.prepare(scene, Screen::MODE_13H)?;
        if let Some(palette) = &scene.palette {
            vga.set_palette(palette);
        }
        Ok(self.fill(scene, way, Frame::from(vga)))
    }

    /// Draws `scene` into any frame, or into a band of one, whose pixels have this width to height.
    ///
    /// # Errors
    /// As [`draw`](Self::draw). The frame is then left as it was.
    pub fn draw_frame(
        &mut self,
        scene: &Scene,
        frame: Frame<'_>,
        pixel_aspect: (u32, u32),
    ) -> Result<Stats, RenderError> {
        let way = self.prepare(scene, Screen { width: frame.width(), height: frame.height(), pixel_aspect })?;
        Ok(self.fill(scene, way, frame))
    }

    /// Hands every triangle that is to be drawn to `triangle`, as the raster would get it: object by
    /// object, far to near where the scene calls for that, each in the order of its faces; a forced
    /// painter's order does not sort them here. The counts of the work are returned, without the
    /// raster's.
    ///
    /// # Errors
    /// As [`draw`](Self::draw), before the first triangle.
    pub fn for_each_triangle(
        &mut self,
        scene: &Scene,
        screen: Screen,
        triangle: impl FnMut(&[Vertex; 3], Shading),
    ) -> Result<Stats, RenderError> {
        let way = self.prepare(scene, screen)?;
        Ok(self.triangles(scene, way, triangle))
    }

    /// Checks the scene, makes the way to the screen for every object, and chooses how hidden surfaces
    /// are left out.
    fn prepare(&mut self, scene: &Scene, screen: Screen) -> Result<HiddenSurfaces, RenderError> {
        if !scene.ambient.is_finite() {
            return Err(RenderError::Ambient);
        }
        for (index, light) in scene.lights().iter().enumerate() {
            light.check().map_err(|what| RenderError::Light { index, what })?;
        }
        for (index, object) in scene.objects().iter().enumerate() {
            object.check().map_err(|what| RenderError::Object { index, what })?;
        }
        let view = View::new(&scene.camera, screen).map_err(RenderError::Camera)?;
        self.views.clear();
        self.views.extend(scene.objects().iter().map(|object| ObjectView::new(&view, object)));
        if self.vertex_path == VertexPath::Integer {
            self.integer.prepare(scene, screen)?;
        }
        if let Some(forced) = self.forced {
            self.order.clear();
            self.order.extend(0..scene.objects().len());
            return Ok(forced);
        }
        Ok(HiddenSurfaces::called_for(scene, &self.views, &mut self.order))
    }

    fn fill(&mut self, scene: &Scene, way: HiddenSurfaces, mut frame: Frame<'_>) -> Stats {
        frame.clear(scene.background);
        let mut raster = Raster::new(frame).with_kernel(self.kernel);
        match way {
            HiddenSurfaces::BackFaces => self.one_by_one(scene, way, raster),
            // Chosen, the objects lie far to near, and in a convex one no face hides another.
            HiddenSurfaces::PainterOrder if self.forced.is_none() => self.one_by_one(scene, way, raster),
            HiddenSurfaces::DepthBuffer => {
                let mut depths = core::mem::take(&mut self.depths);
                let stats = self.one_by_one(scene, way, raster.with_cleared_depth(&mut depths));
                self.depths = depths;
                stats
            }
            HiddenSurfaces::PainterOrder => self.all_at_once(scene, way, |triangles, _| {
                painter::sort(triangles);
                let mut drawn = Drawn::default();
                for (vertices, shading) in triangles {
                    drawn += raster.triangle(vertices, *shading);
                }
                drawn
            }),
            HiddenSurfaces::ScanLine => self.all_at_once(scene, way, |triangles, lists| {
                let scratch = lists.scratch(triangles.len());
                // There is room for all.
                raster.scan_line(triangles, scratch).unwrap_or_default()
            }),
        }
    }

    /// Draws each triangle as it comes.
    fn one_by_one(&mut self, scene: &Scene, way: HiddenSurfaces, mut raster: Raster<'_>) -> Stats {
        let mut drawn = Drawn::default();
        let mut stats = self.triangles(scene, way, |vertices, shading| drawn += raster.triangle(vertices, shading));
        stats.raster = drawn;
        stats
    }

    /// Draws when all triangles are known.
    fn all_at_once(
        &mut self,
        scene: &Scene,
        way: HiddenSurfaces,
        draw: impl FnOnce(&mut [([Vertex; 3], Shading)], &mut Lists) -> Drawn,
    ) -> Stats {
        let mut triangles = core::mem::take(&mut self.triangles);
        triangles.clear();
        let mut stats = self.triangles(scene, way, |vertices, shading| triangles.push((*vertices, shading)));
        stats.raster = draw(&mut triangles, &mut self.lists);
        self.triangles = triangles;
        stats
    }

    fn triangles(
        &mut self,
        scene: &Scene,
        way: HiddenSurfaces,
        mut triangle: impl FnMut(&[Vertex; 3], Shading),
    ) -> Stats {
        let mut stats = Stats::new(self.rung, self.vertex_path, self.kernel, way);
        for &index in &self.order {
            // One for each object, by `prepare`.
            let (object, view) = (&scene.objects()[index], &self.views[index]);
            if self.vertex_path == VertexPath::Integer {
                self.integer.triangles(self.rung, (index, object), &mut stats, &mut triangle);
                continue;
            }
            self.beams.clear();
            self.beams.extend(scene.lights().iter().filter_map(|light| light.beam(view)));
            self.paints.clear();
            self.paints.extend(object.materials.iter().map(|material| Paint::new(material, scene)));
            let stage = Stage { rung: self.rung, object, view, beams: &self.beams, paints: &self.paints };
            stage.vertices(&mut self.lit, &mut stats);
            stage.faces(&self.lit, &mut stats, &mut triangle);
        }
        stats
    }
}

impl Default for Renderer {
    fn default() -> Self {
        Self::new()
    }
}
