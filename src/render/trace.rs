//! One pixel of a frame: which triangles cover it, which of them is seen, and what each stage makes of its byte.
//!
//! Nothing is worked out here that drawing works out. Each triangle is drawn by the raster itself, clipped to the one
//! pixel, and a stage's byte is what is drawn with the stages after it taken away.

use alloc::vec;
use alloc::vec::Vec;
use core::cell::Cell;
use core::mem;

use super::face::Sink;
use super::look::Looks;
use super::vertex::Geometry;
use super::{Effect, HiddenSurfaces, RenderError, Renderer, Screen, Stats, VertexPath, depth_of, sort_by_depth};
use crate::palette::{Ramp, Table};
use crate::raster::cover::Ordered;
use crate::raster::depth::DepthPlane;
use crate::raster::effects::{Attributes, Lighting, Look, Mix, Source, TextureLook};
use crate::raster::{Drawn, Frame, Raster, Rect, Shading, Vertex};
use crate::scene::Scene;
use crate::span::Kernel;

/// A triangle that covers the pixel, or whose edge runs through its centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Met {
    pub(crate) object: usize,
    /// Its place in the mesh, or in what splitting made of it; `None` where that is not known.
    pub(crate) place: Option<usize>,
    pub(crate) vertices: [Vertex; 3],
    /// Of a face with effects that of its object.
    pub(crate) shading: Shading,
    /// Of a face with effects.
    pub(crate) attributes: Option<[Attributes; 3]>,
    surface: Option<u16>,
    pub(crate) depth: u32,
    pub(crate) fate: Fate,
    /// Of what is seen, what its stages make.
    pub(crate) bytes: Option<Bytes>,
}

/// What becomes of a triangle at a pixel.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
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

/// Where the shades of a face come from.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum ShadedBy {
    /// From its corners.
    Corners,
    /// From a table of 256 × 256 normals.
    NormalTable,
    /// From the light at the pixel.
    Light {
        /// The normal there, not made unit yet, in the object's own space.
        normal: [f32; 3],
        /// The point there.
        position: [f32; 3],
        /// The shades in 8.8, of three channels or three times the same.
        shades: [u16; 3],
    },
}

/// What the stages of a face make of a pixel.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Bytes {
    pub(crate) shaded_by: ShadedBy,
    pub(crate) exact_cover: bool,
    /// One shade three times, or three channels.
    pub(crate) shades: [u8; 3],
    pub(crate) channels: bool,
    pub(crate) texel: Option<u8>,
    /// The threshold, and the byte.
    pub(crate) dithered: Option<(u8, u8)>,
    /// Of channels, each with the texel's.
    pub(crate) textured: Option<[u8; 3]>,
    pub(crate) mixed: Option<u8>,
    /// The level, and the byte.
    pub(crate) fogged: Option<(u8, u8)>,
    /// What is behind, and the byte.
    pub(crate) blended: Option<(u8, u8)>,
    pub(crate) byte: u8,
}

/// Everything about a pixel.
#[derive(Debug)]
pub(crate) struct Trace {
    pub(crate) stats: Stats,
    /// In the order of drawing; those that shine through last.
    pub(crate) met: Vec<Met>,
    pub(crate) byte: u8,
}

/// A frame of which one pixel is drawn.
struct OnePixel {
    screen: Screen,
    x: u32,
    y: u32,
    kernel: Kernel,
    row: Vec<u8>,
}

impl OnePixel {
    /// The byte that `draw` leaves where `behind` was before; `None` if it does not draw the pixel.
    fn draw(&mut self, behind: u8, draw: impl FnOnce(&mut Raster<'_>) -> Drawn) -> Option<u8> {
        let Screen { width, height, .. } = self.screen;
        let (x, y) = (self.x, self.y);
        *self.row.get_mut(x as usize)? = behind;
        let frame = Frame::band(&mut self.row, width, height, width as usize, y..y + 1).ok()?;
        let clip = Rect { x0: x, y0: y, x1: x + 1, y1: y + 1 };
        let mut raster = Raster::new(frame).with_clip(clip).with_kernel(self.kernel);
        let drawn = draw(&mut raster);
        if drawn.pixels == 0 { None } else { self.row.get(x as usize).copied() }
    }

    /// The byte of a face by a look with some stages taken away.
    fn look(&mut self, met: (&[Vertex; 3], &[Attributes; 3]), behind: u8, look: &Look<'_>) -> u8 {
        self.draw(behind, |raster| raster.triangle_with_effects(met.0, met.1, look)).unwrap_or(behind)
    }

    /// Whether an edge of a triangle that does not cover the pixel runs through its centre.
    fn is_on_edge(&self, vertices: &[Vertex; 3]) -> bool {
        // Within a frame of at most 4,096 pixels a side.
        let centre = [self.x, self.y].map(|c| i64::from(c) * 256 + 128);
        let area = crate::raster::clip::doubled_area(vertices).signum();
        let at = |i: usize| [i64::from(vertices[i].x().to_bits()), i64::from(vertices[i].y().to_bits())];
        let sides = [(0, 1), (1, 2), (2, 0)].map(|(from, to)| {
            let (a, b) = (at(from), at(to));
            area * ((b[0] - a[0]) * (centre[1] - a[1]) - (b[1] - a[1]) * (centre[0] - a[0]))
        });
        area != 0 && sides.iter().all(|side| *side >= 0) && sides.contains(&0)
    }
}

/// Keeps the faces that meet the pixel.
struct Meeting<'a> {
    pixel: &'a mut OnePixel,
    looks: Looks<'a>,
    object: usize,
    /// Whether every shading covers exactly: with the scan-line method.
    exact: bool,
    met: &'a mut Vec<Met>,
}

impl Meeting<'_> {
    fn keep(&mut self, vertices: &[Vertex; 3], shading: Shading, of_effects: Option<([Attributes; 3], u16)>) {
        let by = if self.exact || of_effects.is_some() { Shading::Flat(0) } else { shading };
        let covers = self.pixel.draw(0, |raster| raster.triangle(vertices, by)).is_some();
        if !covers && (!by.has_exact_cover() || !self.pixel.is_on_edge(vertices)) {
            return;
        }
        let triangle = Ordered::new(vertices);
        // Columns and rows of a frame.
        let depth = DepthPlane::new(&triangle).at(self.pixel.x as i32, self.pixel.y as i32);
        let fate = match of_effects {
            _ if !covers => Fate::NotItsEdge,
            Some((_, surface)) if self.looks.is_transparent(self.object, surface) => Fate::SeenThrough,
            _ => Fate::Seen,
        };
        self.met.push(Met {
            object: self.object,
            place: None,
            vertices: *vertices,
            shading,
            attributes: of_effects.map(|(attributes, _)| attributes),
            surface: of_effects.map(|(_, surface)| surface),
            depth,
            fate,
            bytes: None,
        });
    }
}

impl Sink for Meeting<'_> {
    fn plain(&mut self, vertices: &[Vertex; 3], shading: Shading) {
        self.keep(vertices, shading, None);
    }

    fn with_effects(&mut self, vertices: &[Vertex; 3], attributes: &[Attributes; 3], surface: u16) {
        let rung = self.looks.plan.objects().get(self.object).map(|plan| plan.rung()).unwrap_or_default();
        self.keep(vertices, rung.shading(), Some((*attributes, surface)));
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
    fn plain(&mut self, vertices: &[Vertex; 3], _: Shading) {
        self.look(vertices);
    }

    fn with_effects(&mut self, vertices: &[Vertex; 3], _: &[Attributes; 3], _: u16) {
        self.look(vertices);
    }
}

/// Notes what is asked of a light.
#[derive(Debug)]
struct Noted<'a> {
    light: &'a dyn Lighting,
    last: Cell<Option<([f32; 6], [u16; 3])>>,
}

impl Lighting for Noted<'_> {
    fn shades(&self, points: &[[f32; 6]], shades: &mut [u16]) {
        self.light.shades(points, shades);
        self.last.set(points.last().copied().zip(shades.last().map(|shade| [*shade; 3])));
    }

    fn channels(&self, points: &[[f32; 6]], [red, green, blue]: [&mut [u16]; 3]) {
        self.light.channels(points, [&mut *red, &mut *green, &mut *blue]);
        let [red, green, blue] = [red, green, blue].map(|channel| channel.last().copied().unwrap_or_default());
        self.last.set(points.last().map(|point| (*point, [red, green, blue])));
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
        let looks = Looks { scene, plan: &self.plan, states: &self.states, tables: &self.tables };
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
        let looks = Looks { scene, plan: &self.plan, states: &self.states, tables: &self.tables };
        let mut met = Vec::new();
        for &object in &self.plan.order {
            let mut sink = Meeting { pixel: &mut *pixel, looks, object, exact, met: &mut met };
            if self.vertex_path == VertexPath::Integer {
                let mut plain = |vertices: &[Vertex; 3], shading| sink.plain(vertices, shading);
                integer.triangles(stats.rung, (object, &scene.objects()[object]), stats, &mut plain);
            } else if let Some(faces) = self.states[object].faces(&scene.objects()[object], &self.plan.objects[object])
            {
                faces.draw(stats, &mut sink);
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
        let mut ignored = Stats::new(faces.rung, self.vertex_path, self.kernel, self.plan.hidden_surfaces());
        let Geometry { triangles, triangle_surfaces, .. } = faces.geometry;
        (0..triangles.len()).find(|&i| {
            faces.geometry.triangles = &triangles[i..=i];
            faces.geometry.triangle_surfaces = &triangle_surfaces[i..=i];
            let mut same = Same { wanted: &met.vertices, found: false };
            faces.draw(&mut ignored, &mut same);
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

    /// Whether the rung was chosen for this renderer, whatever the scene asks for.
    pub(crate) fn has_own_rung(&self) -> bool {
        self.rung.is_some()
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
    sort_by_depth(&mut through, |met| depth_of(&met.vertices));
    opaque.append(&mut through);
    *met = opaque;
}

/// What a face makes of the pixel, where `behind` is.
fn bytes(looks: &Looks<'_>, met: &Met, pixel: &mut OnePixel, behind: u8, scan_line: bool) -> Bytes {
    let plain = |shade: u8, exact_cover: bool| Bytes {
        shaded_by: ShadedBy::Corners,
        exact_cover,
        shades: [shade; 3],
        channels: false,
        texel: None,
        dithered: None,
        textured: None,
        mixed: None,
        fogged: None,
        blended: None,
        byte: shade,
    };
    let (Some(attributes), Some(surface)) = (met.attributes, met.surface) else {
        // The scan-line method finds the pixels itself, and takes a shading's shades alone.
        let look = Look { source: Source::Shaded(met.shading), ..Look::PLAIN };
        let byte = if scan_line {
            pixel.look((&met.vertices, &Default::default()), behind, &look)
        } else {
            pixel.draw(behind, |raster| raster.triangle(&met.vertices, met.shading)).unwrap_or(behind)
        };
        return plain(byte, scan_line || met.shading.has_exact_cover());
    };
    let mut made = plain(behind, true);
    looks.with(met.object, surface, |look| {
        made = stages(look, (&met.vertices, &attributes), pixel, behind, made);
        Drawn::default()
    });
    made
}

/// What each stage of a look makes of the pixel.
fn stages(
    look: &Look<'_>,
    met: (&[Vertex; 3], &[Attributes; 3]),
    pixel: &mut OnePixel,
    behind: u8,
    mut made: Bytes,
) -> Bytes {
    let bare = Look { dither: None, texture: None, fog: None, blend: None, ..*look };
    let single = Look { channels: None, ..bare };
    made.channels = look.channels.is_some();
    let mut channels =
        |look: Look<'_>| [0, 1, 2].map(|i| pixel.look(met, behind, &Look { channels: Some(Mix::Only(i)), ..look }));
    made.shades = if made.channels { channels(bare) } else { [0; 3] };
    made.textured = look.texture.filter(|_| made.channels).map(|_| channels(Look { texture: look.texture, ..bare }));
    if !made.channels {
        made.shades = [pixel.look(met, behind, &bare); 3];
    }
    match look.source {
        Source::Shaded(_) => {}
        Source::NormalTable(_) => made.shaded_by = ShadedBy::NormalTable,
        Source::Lit(light) => {
            let noted = Noted { light, last: Cell::new(None) };
            pixel.look(met, behind, &Look { source: Source::Lit(&noted), ..bare });
            if let Some(([nx, ny, nz, x, y, z], shades)) = noted.last.get() {
                made.shaded_by = ShadedBy::Light { normal: [nx, ny, nz], position: [x, y, z], shades };
            }
        }
    }
    // A row of a table is a shade, a level or the new byte; a column a texel or the byte that was there.
    let columns = Table::from_fn(|_, column| column);
    let rows = Table::from_fn(|row, _| row);
    made.texel = look.texture.map(|texture| {
        let texture = TextureLook { tables: [columns.as_array(); 3], ..texture };
        pixel.look(met, behind, &Look { texture: Some(texture), ..single })
    });
    let mut so_far = bare;
    if let Some(thresholds) = look.dither {
        so_far.dither = look.dither;
        let threshold = thresholds[(pixel.y & 7) as usize][(pixel.x & 7) as usize];
        let byte = if made.channels { 0 } else { pixel.look(met, behind, &so_far) };
        made.dithered = Some((threshold, byte));
    }
    so_far.texture = look.texture;
    if look.texture.is_some() && !made.channels {
        made.textured = Some([pixel.look(met, behind, &so_far); 3]);
    }
    if made.channels {
        made.mixed = Some(pixel.look(met, behind, &so_far));
    }
    if look.fog.is_some() {
        let level = pixel.look(met, behind, &Look { fog: Some(rows.as_array()), ..single });
        so_far.fog = look.fog;
        made.fogged = Some((level, pixel.look(met, behind, &so_far)));
    }
    made.byte = pixel.look(met, behind, look);
    if look.blend.is_some() {
        made.blended = Some((behind, made.byte));
    }
    made
}
