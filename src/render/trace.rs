//! One pixel of a frame: which triangles cover it, which of them is seen, and what each stage makes of its byte.

use alloc::vec;
use alloc::vec::Vec;
use core::mem;

use super::budget::Decided;
use super::face::{ShadeMode, Sink};
use super::one_pixel::{Bytes, OnePixel, bytes};
use super::pipelines::Pipelines;
use super::sinks::depth_of;
use super::vertex::Geometry;
use super::{Effect, HiddenSurfaces, RenderError, Renderer, Screen, Stats, VertexPath};
use crate::palette::Ramp;
use crate::raster::cover::SortedTriangle;
use crate::raster::depth::DepthPlane;
use crate::raster::effects::Attributes;
use crate::raster::{Interpolation, Vertex};
use crate::scene::Scene;

/// A triangle that covers the pixel, or whose edge runs through its centre.
#[derive(Clone, Copy, Debug)]
pub struct Met {
    pub object: usize,
    /// Its place in the mesh, or in what splitting made of it; `None` where that is not known.
    pub place: Option<usize>,
    pub vertices: [Vertex; 3],
    pub interpolation: Interpolation,
    /// Of a face with effects.
    pub(super) manner: ShadeMode,
    /// Of a face with effects.
    pub attributes: Option<[Attributes; 3]>,
    pub(super) surface: Option<u16>,
    pub depth: u32,
    pub fate: Fate,
    /// Of what is seen, what its stages make.
    pub bytes: Option<Bytes>,
}

/// What becomes of a triangle at a pixel.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Fate {
    /// It is seen.
    Seen,
    /// It shines through, and is seen before what is behind it.
    SeenThrough,
    /// It is farther away than what is seen, or as far and drawn later.
    Behind,
    /// What is seen was painted over it.
    PaintedOver,
    /// Its edge runs through the pixel's centre, and the pixel is its neighbour's: the edge is neither a top nor a left
    /// one.
    NotItsEdge,
}

/// Everything about a pixel.
#[derive(Debug)]
pub struct Trace {
    pub stats: Stats,
    /// In the order of drawing; those that shine through last.
    pub met: Vec<Met>,
    pub byte: u8,
}

/// Keeps the faces that meet the pixel.
struct Meeting<'a> {
    pixel: &'a mut OnePixel,
    looks: Pipelines<'a>,
    object: usize,
    /// Whether every shading covers exactly: with the scan-line method.
    exact: bool,
    met: &'a mut Vec<Met>,
}

impl Meeting<'_> {
    fn keep(
        &mut self,
        vertices: &[Vertex; 3],
        interpolation: Interpolation,
        of_effects: Option<([Attributes; 3], u16, ShadeMode)>,
    ) {
        let by = if self.exact || of_effects.is_some() { Interpolation::Flat(0) } else { interpolation };
        let covers = self.pixel.draw(0, |raster| raster.triangle(vertices, by)).is_some();
        if !covers && (!by.has_exact_cover() || !self.pixel.is_on_edge(vertices)) {
            return;
        }
        let triangle = SortedTriangle::new(vertices);
        // Columns and rows of a frame.
        let depth = DepthPlane::new(&triangle).at(self.pixel.x as i32, self.pixel.y as i32);
        let fate = match of_effects {
            _ if !covers => Fate::NotItsEdge,
            Some((_, surface, _)) if self.looks.is_transparent(self.object, surface) => Fate::SeenThrough,
            _ => Fate::Seen,
        };
        self.met.push(Met {
            object: self.object,
            place: None,
            vertices: *vertices,
            interpolation,
            manner: of_effects.map_or(ShadeMode::default(), |(_, _, manner)| manner),
            attributes: of_effects.map(|(attributes, ..)| attributes),
            surface: of_effects.map(|(_, surface, _)| surface),
            depth,
            fate,
            bytes: None,
        });
    }
}

impl Sink for Meeting<'_> {
    fn plain(&mut self, vertices: &[Vertex; 3], interpolation: Interpolation) {
        self.keep(vertices, interpolation, None);
    }

    fn with_effects(&mut self, vertices: &[Vertex; 3], attributes: &[Attributes; 3], surface: u16, manner: ShadeMode) {
        self.keep(vertices, manner.shading.interpolation(), Some((*attributes, surface, manner)));
    }
}

/// Finds the face that makes given vertices.
struct Same<'a> {
    wanted: &'a [Vertex; 3],
    found: bool,
}

impl Same<'_> {
    fn look(&mut self, vertices: &[Vertex; 3]) {
        let places = |v: &[Vertex; 3]| v.map(|v| (v.x(), v.y(), v.depth()));
        self.found |= places(vertices) == places(self.wanted);
    }
}

impl Sink for Same<'_> {
    fn plain(&mut self, vertices: &[Vertex; 3], _: Interpolation) {
        self.look(vertices);
    }

    fn with_effects(&mut self, vertices: &[Vertex; 3], _: &[Attributes; 3], _: u16, _: ShadeMode) {
        self.look(vertices);
    }
}

impl Renderer {
    /// Everything about the pixel (`x`, `y`), which lies inside of the screen: its triangles in the order of drawing,
    /// what became of each, and the stages of those that are seen.
    ///
    /// # Errors
    /// As [`draw`](Self::draw).
    pub(crate) fn trace(&mut self, scene: &Scene, screen: Screen, x: u32, y: u32) -> Result<Trace, RenderError> {
        let (mut stats, _) = self.prepare(scene, screen, None, true)?;
        self.last = None;
        let mut pixel = OnePixel { screen, x, y, kernel: self.kernel, row: vec![0; screen.width as usize] };
        let mut met = self.meet(scene, &mut stats, &mut pixel);
        let hidden_surfaces = self.plan.hidden_surfaces();
        decide_fates(&mut met, hidden_surfaces, self.plan.is_chosen());
        let mut byte = scene.background;
        let looks =
            Pipelines { scene, plan: &self.plan, states: &self.states, tables: &self.tables, kernel: self.kernel };
        // The one that hides what is behind it comes first, and those that shine through follow far to near.
        let seen = met.iter_mut().filter(|met| met.fate == Fate::Seen).count();
        debug_assert!(seen <= 1);
        for fate in [Fate::Seen, Fate::SeenThrough] {
            for met in met.iter_mut().filter(|met| met.fate == fate) {
                let exact = hidden_surfaces == HiddenSurfaces::ScanLine;
                let bytes = bytes(&looks, met, &mut pixel, byte, exact);
                byte = bytes.byte;
                met.bytes = Some(bytes);
            }
        }
        for met in &mut met {
            met.place = self.place(scene, met);
        }
        Ok(Trace { stats, met, byte })
    }

    /// The faces that meet a pixel, as they are handed to the raster.
    fn meet(&mut self, scene: &Scene, stats: &mut Stats, pixel: &mut OnePixel) -> Vec<Met> {
        let exact = self.plan.hidden_surfaces() == HiddenSurfaces::ScanLine;
        let mut integer = mem::take(&mut self.integer);
        let looks =
            Pipelines { scene, plan: &self.plan, states: &self.states, tables: &self.tables, kernel: self.kernel };
        let mut met = Vec::new();
        for &object in &self.plan.order {
            let mut sink = Meeting { pixel: &mut *pixel, looks, object, exact, met: &mut met };
            if self.vertex_path == VertexPath::Integer {
                let mut plain = |vertices: &[Vertex; 3], interpolation| sink.plain(vertices, interpolation);
                integer.triangles(stats.shading, (object, &scene.objects()[object]), stats, &mut plain);
            } else if let Some(faces) = self.states[object].faces(&scene.objects()[object], &self.plan.objects[object])
            {
                let mut decided = self.states[object].decided().clone();
                faces.draw(&mut decided, stats, &mut sink);
            }
        }
        self.integer = integer;
        met
    }

    /// The place of a face in its mesh, or in what splitting made of it: the first that is drawn with these vertices.
    fn place(&self, scene: &Scene, met: &Met) -> Option<usize> {
        if self.vertex_path == VertexPath::Integer {
            return None;
        }
        let object = scene.objects().get(met.object)?;
        let mut faces = self.states.get(met.object)?.faces(object, self.plan.objects.get(met.object)?)?;
        let mut ignored = Stats::new(faces.shading, self.vertex_path, self.kernel, self.plan.hidden_surfaces());
        let Geometry { triangles, triangle_surfaces, .. } = faces.geometry;
        (0..triangles.len()).find(|&i| {
            faces.geometry.triangles = &triangles[i..=i];
            faces.geometry.triangle_surfaces = &triangle_surfaces[i..=i];
            faces.twins = &[];
            let mut same = Same { wanted: &met.vertices, found: false };
            // Which shading draws it changes no vertex's place.
            let mut undecided = Decided::default();
            undecided.nothing_of(1);
            faces.draw(&mut undecided, &mut ignored, &mut same);
            same.found
        })
    }

    /// Whether an object's faces were split.
    pub(crate) fn is_split(&self, object: usize) -> bool {
        self.vertex_path == VertexPath::Float && self.plan.is_on(object, Effect::Tessellation)
    }

    /// The palette entries of a surface's shades, as it is drawn.
    pub(crate) fn ramp_of(&self, scene: &Scene, object: usize, surface: u16) -> Ramp {
        let surface = usize::from(surface);
        let made = self.states.get(object).and_then(|state| state.paints().get(surface));
        match made.filter(|_| self.vertex_path == VertexPath::Float) {
            Some(paint) => paint.ramp,
            None => {
                let material = scene.objects().get(object).and_then(|object| object.materials.get(surface));
                material.map_or(Ramp::WHOLE, |material| material.ramp.in_palette(scene.palette.as_ref()))
            }
        }
    }

    /// Whether the shading was chosen for this renderer, whatever the scene asks for.
    pub(crate) fn has_own_shading(&self) -> bool {
        self.shading.is_some()
    }
}

/// Says of each face that covers the pixel whether it is seen, as the way to hidden surfaces has it, and puts those
/// that shine through last, far to near.
fn decide_fates(met: &mut Vec<Met>, way: HiddenSurfaces, chosen: bool) {
    let tests_depth = matches!(way, HiddenSurfaces::DepthBuffer | HiddenSurfaces::ScanLine);
    let opaque = || (0..met.len()).filter(|&i| met[i].fate == Fate::Seen);
    let seen = match way {
        // Of equal depths the first.
        _ if tests_depth => opaque().filter(|&i| met[i].depth > 0).rev().max_by_key(|&i| met[i].depth),
        // Painted last: of equal ones the last.
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
    let (mut opaque, mut through): (Vec<Met>, Vec<Met>) = met.drain(..).partition(|met| met.fate != Fate::SeenThrough);
    // Far to near, as the renderer draws them.
    through.sort_by_key(|met| depth_of(&met.vertices));
    opaque.append(&mut through);
    *met = opaque;
}
