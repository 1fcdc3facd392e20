//! From a scene to bytes, frame by frame.
//!
//! | file | what |
//! |---|---|
//! | `view` | camera and object to one matrix; projection; the one rounding |
//! | `stage` | an object's vertices, lit and projected, then its faces |
//! | `clip` | near plane and guard band |
//! | `rung` | the techniques of shading |
//! | `stats` | what a frame came to |
//!
//! A frame goes through three stages for every object: its vertices are transformed, lit and
//! rounded, each once; its faces pick theirs, are clipped where they must be and left out where
//! they are turned away; the [`raster`](crate::raster) draws what is left.

mod clip;
mod rung;
mod stage;
mod stats;
mod view;

use alloc::vec::Vec;
use core::fmt;

pub use rung::{Rung, UnknownRung};
pub use stats::Stats;
pub use view::Screen;

use self::stage::{LitVertex, Paint, Stage};
use self::view::{ObjectView, View};
use crate::light::Beam;
use crate::raster::{Drawn, Frame, Raster, Shading, Vertex};
use crate::scene::Scene;
use crate::span::Kernel;
use crate::vga::Vga;

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

/// How hidden surfaces are left out.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum HiddenSurfaces {
    /// Faces turned away are not drawn; that is enough for one convex object.
    BackFaces,
    /// A depth for every pixel.
    DepthBuffer,
}

impl fmt::Display for HiddenSurfaces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::BackFaces => "back faces only",
            Self::DepthBuffer => "depth buffer",
        })
    }
}

/// Draws scenes. It keeps nothing of a frame but the memory that the next one will need too.
#[derive(Debug)]
pub struct Renderer {
    rung: Rung,
    kernel: Kernel,
    views: Vec<ObjectView>,
    beams: Vec<Beam>,
    paints: Vec<Paint>,
    lit: Vec<LitVertex>,
    depths: Vec<u32>,
}

impl Renderer {
    /// A renderer with the default rung and the fastest kernel.
    #[must_use]
    pub fn new() -> Self {
        Self {
            rung: Rung::default(),
            kernel: Kernel::fastest(),
            views: Vec::new(),
            beams: Vec::new(),
            paints: Vec::new(),
            lit: Vec::new(),
            depths: Vec::new(),
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

    /// Chooses the span kernel. All give the same bytes.
    pub fn set_kernel(&mut self, kernel: Kernel) {
        self.kernel = kernel;
    }

    /// The span kernel.
    #[must_use]
    pub fn kernel(&self) -> Kernel {
        self.kernel
    }

    /// Draws `scene` on the machine: sets its DAC to the scene's palette, if it has one, clears its
    /// pixels and draws.
    ///
    /// # Errors
    /// A number in the scene that is not finite or not in its range. The machine is then left as it
    /// was.
    pub fn draw(&mut self, scene: &Scene, vga: &mut Vga) -> Result<Stats, RenderError> {
        self.prepare(scene, Screen::MODE_13H)?;
        if let Some(palette) = &scene.palette {
            vga.set_palette(palette);
        }
        Ok(self.fill(scene, Frame::from(vga)))
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
        self.prepare(scene, Screen { width: frame.width(), height: frame.height(), pixel_aspect })?;
        Ok(self.fill(scene, frame))
    }

    /// Hands every triangle that is to be drawn to `triangle`, as the raster would get it: object by
    /// object, in the order of their faces. The counts of the work are returned, without the
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
        self.prepare(scene, screen)?;
        Ok(self.triangles(scene, triangle))
    }

    /// Checks the scene, and makes the way to the screen for every object.
    fn prepare(&mut self, scene: &Scene, screen: Screen) -> Result<(), RenderError> {
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
        Ok(())
    }

    fn fill(&mut self, scene: &Scene, mut frame: Frame<'_>) -> Stats {
        frame.clear(scene.background);
        let mut depths = core::mem::take(&mut self.depths);
        let raster = Raster::new(frame).with_kernel(self.kernel);
        let mut raster = match hidden_surfaces(scene) {
            HiddenSurfaces::BackFaces => raster,
            HiddenSurfaces::DepthBuffer => raster.with_cleared_depth(&mut depths),
        };
        let mut drawn = Drawn::default();
        let mut stats = self.triangles(scene, |vertices, shading| drawn += raster.triangle(vertices, shading));
        self.depths = depths;
        stats.raster = drawn;
        stats
    }

    fn triangles(&mut self, scene: &Scene, mut triangle: impl FnMut(&[Vertex; 3], Shading)) -> Stats {
        let mut stats = Stats::new(self.rung, self.kernel, hidden_surfaces(scene));
        for (object, view) in scene.objects().iter().zip(&self.views) {
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

/// One convex object hides nothing but its own back faces. All else needs a depth for every pixel.
fn hidden_surfaces(scene: &Scene) -> HiddenSurfaces {
    match scene.objects() {
        [] => HiddenSurfaces::BackFaces,
        [object] if object.mesh().is_convex() => HiddenSurfaces::BackFaces,
        _ => HiddenSurfaces::DepthBuffer,
    }
}
