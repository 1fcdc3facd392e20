//! Everything about one pixel.

use super::edge::clockwise;
use super::face::FaceHere;
use super::one_pixel::{Bytes, ShadedBy};
use super::trace::{Fate, Met, trace};
use super::{ExplainError, check};
use crate::truth::{Face, Standard, Truth};
use mode13h::internals;
use mode13h::internals::raster::effects::Attributes;
use mode13h::internals::raster::reference::cover::SortedTriangle;
use mode13h::internals::{ShadeTrace, row_of};
use mode13h::palette::{Ramp, Rgb};
use mode13h::plan::{self, Effect};
use mode13h::raster::{Interpolation, Vertex};
use mode13h::render::{Renderer, Screen};
use mode13h::scene::Scene;
use mode13h::settings::{Accuracy, HiddenSurfaces, Settings, Shading, VertexPath};
use mode13h::vga::Vga;

/// The full explanation of one pixel. Displayed as text it fits 100 columns.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub struct Pixel {
    /// Its column.
    pub x: u32,
    /// Its row.
    pub y: u32,
    /// Its byte in the frame: a palette entry.
    pub byte: u8,
    /// Colour of that entry at the scene's time.
    pub color: Rgb,
    /// Byte that the frame was cleared to.
    pub background: u8,
    /// Method for hidden surfaces.
    pub hidden_surfaces: HiddenSurfaces,
    /// Reason for that method, in words; empty if there is no object.
    pub hidden_surfaces_why: String,
    /// The shading technique.
    pub shading: Shading,
    /// Reason for that technique, in words.
    pub shading_why: String,
    /// The budget, in shades, that chooses a technique for each face in place of `shading`, if there is one.
    pub max_error: Option<f32>,
    /// The arithmetic that computed the vertices.
    pub vertex_path: VertexPath,
    /// The names of the scene's objects.
    pub objects: Vec<String>,
    /// Every triangle that covers the pixel or has an edge through its centre, in drawing order; translucent ones last.
    pub faces: Vec<FaceHere>,
    /// The visible faces: the opaque one if there is one, then translucent ones, far to near. Empty where the
    /// background shows.
    pub seen: Vec<Seen>,
}

/// A visible triangle, and how it got its byte.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub struct Seen {
    /// Its index in [`Pixel::faces`].
    pub face: usize,
    /// The palette entries that its shades lie in.
    pub ramp: Ramp,
    /// The source of its shades.
    pub shaded_by: ShadedBy,
    /// True if it covers exactly the pixels whose centres are in it.
    pub exact_cover: bool,
    /// How its values reach the pixel: one trace for shades from corners, or three for red, green and blue; two for a
    /// table of normals (the normal's column and row in it); none for light at the pixel.
    pub accounts: Vec<ShadeTrace>,
    /// Its stages in order, with their results at the pixel. The last one's byte is what the face leaves in the frame.
    pub stages: Vec<PixelStage>,
    /// Errors of the shade against the standards of truth, without those where the truth has no such face here.
    pub against: Vec<Against>,
    /// Effects that are on for its object, with reasons.
    pub effects: Vec<plan::Row>,
}

/// Result of a stage at the pixel.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum PixelStage {
    /// The shade.
    Shade(u8),
    /// The shades of red, green and blue.
    Channels([u8; 3]),
    /// A threshold replaced the half that otherwise rounds a shade.
    Dither {
        /// The threshold.
        threshold: u8,
        /// Resulting byte.
        byte: u8,
    },
    /// Shade and texel were looked up in a table.
    Texture {
        /// The texel.
        texel: u8,
        /// The image level that it comes from; `None` for an image without smaller copies.
        level: Option<u8>,
        /// Resulting byte.
        byte: u8,
    },
    /// Each channel was multiplied by the texel's.
    TextureChannels {
        /// The texel.
        texel: u8,
        /// The image level that it comes from; `None` for an image without smaller copies.
        level: Option<u8>,
        /// Resulting channels.
        channels: [u8; 3],
    },
    /// The channels were mixed into a palette entry.
    Mix {
        /// The dither threshold, if dither is on.
        threshold: Option<u8>,
        /// Resulting byte.
        byte: u8,
    },
    /// The byte was looked up in the fog table at a fog level.
    Fog {
        /// Density, 0 to 255.
        level: u8,
        /// Resulting byte.
        byte: u8,
    },
    /// The byte was looked up in the blend table with the one behind it.
    Blend {
        /// Byte that the frame held.
        behind: u8,
        /// Resulting byte.
        byte: u8,
    },
}

impl PixelStage {
    /// The resulting byte; `None` for three channels.
    #[must_use]
    pub const fn byte(self) -> Option<u8> {
        match self {
            Self::Shade(byte)
            | Self::Dither { byte, .. }
            | Self::Texture { byte, .. }
            | Self::Mix { byte, .. }
            | Self::Fog { byte, .. }
            | Self::Blend { byte, .. } => Some(byte),
            Self::Channels(_) | Self::TextureChannels { .. } => None,
        }
    }
}

/// The error of the shade against one standard of truth.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Against {
    /// The standard.
    pub standard: Standard,
    /// True shades, in 1/255 of full intensity: one per channel, or the same three times.
    pub shades: [f64; 3],
    /// The shade shown minus the true one, before texture, fog and dither, in the same unit; for three channels, that
    /// of the channel that is farthest off.
    pub error: f64,
}

/// Explains the pixel in column `x` of row `y` of the frame that `renderer`, with its current settings, draws of
/// `scene`.
///
/// The renderer draws nothing, but computes its vertices as for a frame; the frames that it draws later are not
/// affected.
///
/// # Errors
/// A pixel outside the screen; a scene or a screen that cannot be drawn.
pub fn pixel(renderer: &mut Renderer, scene: &Scene, screen: Screen, x: u32, y: u32) -> Result<Pixel, ExplainError> {
    check(screen)?;
    let Screen { width, height, .. } = screen;
    if x >= width || y >= height {
        return Err(ExplainError::OutsidePixel { x, y, width, height });
    }
    let trace = trace(renderer, scene, screen, x, y).map_err(ExplainError::Scene)?;
    let truth = Truth::new(scene, screen).map_err(ExplainError::Truth)?;
    let faces: Vec<FaceHere> = trace.met.iter().map(|met| here(renderer, scene, &truth, met, x, y)).collect();
    let inputs = Inputs { scene, screen, truth: &truth, rows: &trace.rows, x, y };
    let seen = trace.met.iter().zip(&faces).enumerate();
    let seen = seen.filter_map(|(i, (met, face))| Some(inputs.seen(i, face, met, met.bytes.as_ref()?))).collect();
    let hidden = trace.rows.iter().find(|row| row.effect == Effect::HiddenSurfaces);
    Ok(Pixel {
        x,
        y,
        byte: trace.byte,
        color: color(renderer, scene, trace.byte),
        background: scene.background,
        hidden_surfaces: trace.stats.hidden_surfaces,
        hidden_surfaces_why: hidden.map(|row| row.reason.clone()).unwrap_or_default(),
        shading: trace.stats.shading,
        shading_why: shading_why(&renderer.settings, &scene.settings),
        max_error: trace.stats.max_error,
        vertex_path: trace.stats.vertex_path,
        objects: (0..scene.objects().len()).map(|object| internals::name_of(scene, object)).collect(),
        faces,
        seen,
    })
}

/// The colour of an entry on the DAC.
fn color(renderer: &Renderer, scene: &Scene, entry: u8) -> Rgb {
    let mut vga = Vga::new();
    if renderer.plan().is_on_anywhere(Effect::PaletteAnimation) || scene.objects().is_empty() {
        scene.load_palette(&mut vga);
    } else if let Some(palette) = &scene.palette {
        vga.set_palette(palette);
    }
    vga.palette().colors()[usize::from(entry)]
}

fn shading_why(of_renderer: &Settings, of_scene: &Settings) -> String {
    let settings = of_renderer.or(of_scene);
    match settings.accuracy.unwrap_or_default() {
        asked if asked == settings.drawn_accuracy() => {
            let origin = if of_renderer.accuracy.is_some() {
                "asked for"
            } else if of_scene.accuracy.is_some() {
                "the scene asks for it"
            } else {
                "the default"
            };
            origin.into()
        }
        Accuracy::Shading(shading) => format!("16.16 vertices have no {shading}"),
        Accuracy::WithinError(_) => "16.16 vertices have no budget".into(),
    }
}

/// A triangle at the pixel, and which one it is in the mesh.
fn here(renderer: &Renderer, scene: &Scene, truth: &Truth<'_>, met: &Met, x: u32, y: u32) -> FaceHere {
    let is_part = renderer.plan().objects()[met.object].is_on(Effect::Tessellation);
    let triangle = if is_part || met.face.is_none() { nearest(truth, met, x, y) } else { met.face };
    let object = &scene.objects()[met.object];
    let surface = triangle.and_then(|triangle| object.mesh().triangle_surfaces().get(triangle));
    let material = surface.and_then(|&surface| object.materials.get(usize::from(surface)));
    FaceHere {
        object: met.object,
        triangle,
        line: triangle.and_then(|triangle| object.mesh().line(triangle)),
        material: material.map(|material| material.name.clone()).filter(|name| !name.is_empty()),
        is_part,
        interpolation: met.interpolation,
        corners: clockwise(met.vertices),
        depth: met.depth,
        fate: met.fate,
    }
}

/// The triangle of the object whose true depth at the pixel is nearest to the drawn one. Used where the renderer's
/// triangles are not the mesh's own.
fn nearest(truth: &Truth<'_>, met: &Met, x: u32, y: u32) -> Option<usize> {
    let apart = |triangle: usize| {
        let face = Face { object: met.object, triangle };
        let w = truth.of_face_at(Standard::Gouraud, face, x, y)?.w;
        // d = 2³⁰·near / w.
        let depth = f64::from(1 << 30) * truth.near() / w;
        Some((triangle, (depth - f64::from(met.depth)).abs()))
    };
    let all = (0..truth.triangles(met.object)).filter_map(apart);
    all.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(triangle, _)| triangle)
}

/// The data needed to explain a visible face.
struct Inputs<'a> {
    scene: &'a Scene,
    screen: Screen,
    truth: &'a Truth<'a>,
    rows: &'a [plan::Row],
    x: u32,
    y: u32,
}

impl Inputs<'_> {
    fn seen(&self, place: usize, face: &FaceHere, met: &Met, bytes: &Bytes) -> Seen {
        let ramp = met.ramp.or_else(|| self.ramp_of_material(face)).unwrap_or(Ramp::WHOLE);
        let of_object = |row: &&plan::Row| row.on && row.index == met.object;
        Seen {
            face: place,
            ramp,
            shaded_by: bytes.shaded_by,
            exact_cover: bytes.exact_cover,
            accounts: self.accounts(met, bytes).unwrap_or_default(),
            stages: stages(bytes),
            against: face.triangle.map(|t| self.against(met, t, bytes.shades, ramp)).unwrap_or_default(),
            effects: self.rows.iter().filter(of_object).cloned().collect(),
        }
    }

    /// The palette entries of a face's material.
    fn ramp_of_material(&self, face: &FaceHere) -> Option<Ramp> {
        let object = self.scene.objects().get(face.object)?;
        let surface = face.triangle.and_then(|triangle| object.mesh().triangle_surfaces().get(triangle));
        let material = object.materials.get(usize::from(surface.copied().unwrap_or_default()))?;
        Some(material.ramp.in_palette(self.scene.palette.as_ref()))
    }

    fn accounts(&self, met: &Met, bytes: &Bytes) -> Option<Vec<ShadeTrace>> {
        let triangle = SortedTriangle::new(&met.vertices);
        let covers = (!bytes.exact_cover).then_some(met.interpolation);
        let row = row_of(&triangle, covers, self.screen.width, self.x, self.y)?;
        // A column of the frame.
        let x = self.x as i32;
        let values = |value: &dyn Fn(&Attributes) -> u16| {
            let attributes = met.attributes.as_ref()?;
            let of_corner = |corner: &Vertex| {
                let same = |v: &Vertex| v.x() == corner.x() && v.y() == corner.y();
                i64::from(value(&attributes[met.vertices.iter().position(same).unwrap_or(0)]))
            };
            Some(triangle.vertices.each_ref().map(of_corner))
        };
        let shade_trace = |values, interpolation| ShadeTrace::new(&triangle, values, interpolation, &row, x);
        Some(match bytes.shaded_by {
            ShadedBy::Light { .. } | ShadedBy::BetweenLit { .. } | ShadedBy::BetweenSix(_) => Vec::new(),
            ShadedBy::NormalTable => [0, 1]
                .iter()
                .filter_map(|&i| Some(shade_trace(values(&|a| a.slope[i].to_bits())?, Interpolation::default())))
                .collect(),
            ShadedBy::Corners if bytes.channels => [0, 1, 2]
                .iter()
                .filter_map(|&i| Some(shade_trace(values(&|a| a.channels[i].to_bits())?, met.interpolation)))
                .collect(),
            ShadedBy::Corners => [shade_trace(triangle.shades(), met.interpolation)].into(),
        })
    }

    fn against(&self, met: &Met, triangle: usize, shown: [u8; 3], ramp: Ramp) -> Vec<Against> {
        let Some(steps) = ramp.entries().checked_sub(1).filter(|steps| *steps > 0) else { return Vec::new() };
        let shown = shown.map(|byte| 255.0 * (f64::from(byte) - f64::from(ramp.first())) / f64::from(steps));
        let on_face = matches!(met.interpolation, Interpolation::GouraudHyperbolic | Interpolation::GouraudFloat);
        let standards = [Standard::Gouraud, Standard::GouraudPerspective, Standard::Lit];
        let wanted = standards.into_iter().filter(|s| *s != Standard::GouraudPerspective || on_face);
        let face = Face { object: met.object, triangle };
        let against = |standard| {
            let shades = self.truth.of_face_at(standard, face, self.x, self.y)?.intensity.map(|i| 255.0 * i);
            let off = [0, 1, 2].map(|i| shown[i] - shades[i]);
            let error = off.into_iter().fold(0.0, |most: f64, off| if off.abs() > most.abs() { off } else { most });
            Some(Against { standard, shades, error })
        };
        wanted.filter_map(against).collect()
    }
}

fn stages(bytes: &Bytes) -> Vec<PixelStage> {
    let Bytes { shades, channels, texel, level, dithered, textured, mixed, fogged, blended, .. } = *bytes;
    let texel = texel.unwrap_or_default();
    let first = if channels { PixelStage::Channels(shades) } else { PixelStage::Shade(shades[0]) };
    [
        Some(first),
        dithered.filter(|_| !channels).map(|(threshold, byte)| PixelStage::Dither { threshold, byte }),
        textured.map(|values| match channels {
            true => PixelStage::TextureChannels { texel, level, channels: values },
            false => PixelStage::Texture { texel, level, byte: values[0] },
        }),
        mixed.map(|byte| PixelStage::Mix { threshold: dithered.map(|(threshold, _)| threshold), byte }),
        fogged.map(|(level, byte)| PixelStage::Fog { level, byte }),
        blended.map(|(behind, byte)| PixelStage::Blend { behind, byte }),
    ]
    .into_iter()
    .flatten()
    .collect()
}

impl Pixel {
    /// The face in front, and its explanation.
    #[must_use]
    pub fn front(&self) -> Option<(&FaceHere, &Seen)> {
        let seen = self.seen.last()?;
        Some((self.faces.get(seen.face)?, seen))
    }

    /// Triangles that the pixel would show if they were not hidden.
    pub fn losers(&self) -> impl Iterator<Item = &FaceHere> {
        self.faces.iter().filter(|face| matches!(face.fate, Fate::Behind | Fate::PaintedOver))
    }
}
