//! Probes a renderer pixel by pixel: which face is shown, and its shade before texture, fog, dither and blending.

use crate::truth::{Face, Shown};
use mode13h::internals;
use mode13h::light::{Blend, Material, RampChoice};
use mode13h::mesh::{Mesh, Surface};
use mode13h::palette::Ramp;
use mode13h::plan::Effect;
use mode13h::raster::{Frame, RasterError};
use mode13h::render::{RenderError, Renderer, Screen};
use mode13h::scene::{Object, Scene, Shared};
use mode13h::settings::DitherPattern;
use mode13h::settings::{Accuracy, Shading};

/// Finds out what a renderer shows, just by having it draw.
///
/// The **shades** are the bytes of the scene on a ramp of all 256 entries, without texture, mirror, fog or dither and
/// with translucent objects made opaque: the result of shading before any of these apply. If light or material is
/// coloured, each channel is drawn separately.
///
/// The **faces** are found by drawing, too: every triangle is numbered, and the scene is drawn once for each digit of
/// the numbers, with every triangle showing its digit in place of a shade. Coverage, clipping, splitting and visibility
/// are thus the renderer's own, and nothing in it knows that it is being watched.
///
/// ```
/// use mode13h_lab::cost::Probe;
/// use mode13h::render::{Renderer, Screen};
/// use mode13h::mesh::shapes;
/// use mode13h::scene::Scene;
/// use mode13h_lab::truth::{ErrorMap, Standard, Truth};
///
/// let scene = Scene::showing(shapes::torus(48, 24));
/// let shown = Probe::new(Renderer::new()).look(&scene, Screen::MODE_13H)?;
/// let truth = Truth::new(&scene, Screen::MODE_13H)?.draw(Standard::Gouraud);
/// let errors = ErrorMap::new(&truth, &shown).expect("of one size");
/// assert!(errors.figures().max < 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Probe {
    renderer: Renderer,
    numbered: Numbered,
    /// Dither or none, if it is judged: shades are then shown on a ramp of 32 entries, 8.2 shades apart; with `None`,
    /// on one of 256.
    pub(super) dither: Option<Option<DitherPattern>>,
}

/// Entries of the ramp that dither is judged on.
const COARSE: u16 = 32;

impl Probe {
    /// Probes this renderer with its current settings: shading, kernel, vertex path and all.
    #[must_use]
    pub fn new(renderer: Renderer) -> Self {
        Self { renderer, numbered: Numbered::default(), dither: None }
    }

    /// The renderer, to change its settings.
    pub fn renderer(&mut self) -> &mut Renderer {
        &mut self.renderer
    }

    /// Finds out which pixels the renderer shows of a scene.
    ///
    /// # Errors
    /// A scene that cannot be drawn; a screen size that no [`Frame`] can have; an object with more than 32,768
    /// surfaces, whose triangles cannot be numbered.
    pub fn look(&mut self, scene: &Scene, screen: Screen) -> Result<Shown, ProbeError> {
        let mut scene = scene.clone();
        scene.fog = None;
        scene.settings.dither = self.dither.flatten();
        let ramp = if self.dither.is_some() { Ramp::new(0, COARSE).unwrap_or(Ramp::WHOLE) } else { Ramp::WHOLE };
        for material in scene.objects_mut().iter_mut().flat_map(|object| &mut object.materials) {
            let ramp = RampChoice::Entries(ramp);
            *material = Material { ramp, texture: None, environment: None, blend: Blend::Opaque, ..material.clone() };
        }
        let mut shades = self.shades(&scene, screen)?;
        if self.dither.is_some() && !self.renderer.plan().is_on_anywhere(Effect::RgbChannels) {
            let step = 255.0 / f64::from(ramp.entries() - 1);
            shades.iter_mut().for_each(|shades| *shades = shades.map(|entry| entry * step));
        }
        scene.settings.dither = None;
        let faces = self.faces(scene, screen)?;
        Ok(Shown { width: screen.width, height: screen.height, faces, shades })
    }

    /// The shades at each pixel.
    fn shades(&mut self, scene: &Scene, screen: Screen) -> Result<Vec<[f64; 3]>, ProbeError> {
        let red = self.channel(0, scene, screen)?;
        if !self.renderer.plan().is_on_anywhere(Effect::RgbChannels) {
            return Ok(red.into_iter().map(|shade| [f64::from(shade); 3]).collect());
        }
        let (green, blue) = (self.channel(1, scene, screen)?, self.channel(2, scene, screen)?);
        Ok(red.into_iter().zip(green).zip(blue).map(|((r, g), b)| [r, g, b].map(f64::from)).collect())
    }

    fn channel(&mut self, channel: usize, scene: &Scene, screen: Screen) -> Result<Vec<u8>, ProbeError> {
        internals::show_channel(&mut self.renderer, Some(channel));
        let bytes = self.draw(scene, screen);
        internals::show_channel(&mut self.renderer, None);
        bytes
    }

    /// The face at each pixel.
    fn faces(&mut self, mut scene: Scene, screen: Screen) -> Result<Vec<Option<Face>>, ProbeError> {
        self.numbered.renew(&scene)?;
        scene.background = 0;
        // Channels are mixed, and the mixture has no ramp. White light of the same brightness splits faces just as
        // coloured light does.
        for light in scene.lights_mut() {
            *light = light.with_color([1.0; 3]).with_intensity(light.brightness());
        }
        // Making a normal table for every digit would take long.
        let accuracy = self.renderer.settings.or(&scene.settings).accuracy.unwrap_or_default();
        let needs_tables = accuracy == Accuracy::Shading(Shading::PhongTable);
        let replaced = needs_tables.then(|| self.renderer.settings.accuracy.replace(Shading::Phong.into()));
        let numbers = self.numbers(scene, screen);
        if let Some(accuracy) = replaced {
            self.renderer.settings.accuracy = accuracy;
        }
        Ok(numbers?.into_iter().map(|number| self.numbered.face(number)).collect())
    }

    /// The number of the face at each pixel, drawn digit by digit.
    fn numbers(&mut self, mut scene: Scene, screen: Screen) -> Result<Vec<usize>, ProbeError> {
        let mut numbers = vec![0; screen.width as usize * screen.height as usize];
        let mut unit = 1;
        let own = scene.objects().to_vec();
        for digit in 0..self.numbered.digits.len() {
            let meshes = &self.numbered.digits[digit];
            for ((object, own), mesh) in scene.objects_mut().iter_mut().zip(&own).zip(meshes) {
                *object = self.numbered.object(own, mesh);
            }
            for (number, byte) in numbers.iter_mut().zip(self.draw(&scene, screen)?) {
                *number += unit * usize::from(byte);
            }
            unit *= self.numbered.base;
        }
        Ok(numbers)
    }

    fn draw(&mut self, scene: &Scene, screen: Screen) -> Result<Vec<u8>, ProbeError> {
        let Screen { width, height, pixel_aspect } = screen;
        if width.max(height) > Frame::MAX_SIDE {
            return Err(ProbeError::Screen(RasterError::Size { width, height }));
        }
        let mut bytes = vec![0; width as usize * height as usize];
        let frame = Frame::new(&mut bytes, width, height, width as usize).map_err(ProbeError::Screen)?;
        self.renderer.draw_frame(scene, frame, pixel_aspect).map_err(ProbeError::Scene)?;
        Ok(bytes)
    }
}

/// Error of a probe.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProbeError {
    /// The scene cannot be drawn.
    #[error(transparent)]
    Scene(RenderError),
    /// The screen size is not a legal frame size.
    #[error(transparent)]
    Screen(RasterError),
    /// An object has too many surfaces for its triangles to be numbered.
    #[error("triangles of {0} surfaces cannot be numbered")]
    Surfaces(usize),
}

/// A scene's meshes with their triangles numbered from 1 through all objects; 0 is the background. Cached while the
/// meshes stay the same.
#[derive(Debug, Default)]
struct Numbered {
    meshes: Vec<Shared<Mesh>>,
    /// Number of values that a digit has.
    base: usize,
    /// Meshes for each digit, lowest first. Each mesh has one surface for every pair of its own surfaces and a value of
    /// the digit: its own still count, because a face's splitting depends on its material.
    digits: Vec<Vec<Shared<Mesh>>>,
}

impl Numbered {
    /// Renumbers if the scene's meshes have changed.
    fn renew(&mut self, scene: &Scene) -> Result<(), ProbeError> {
        let objects = scene.objects();
        let same = |(mesh, object): (&Shared<Mesh>, &Object)| Shared::ptr_eq(mesh, internals::shared_mesh(object));
        if self.meshes.len() == objects.len() && self.meshes.iter().zip(objects).all(same) {
            return Ok(());
        }
        let surfaces = objects.iter().map(|object| object.mesh().surfaces().len()).max().unwrap_or(1);
        // Surfaces are counted in 16 bits.
        let base = (65_536 / surfaces.max(1)).min(256);
        if base < 2 {
            return Err(ProbeError::Surfaces(surfaces));
        }
        let triangles: usize = objects.iter().map(|object| object.mesh().triangles().len()).sum();
        let mut digits = Vec::new();
        let mut unit = 1;
        while unit <= triangles {
            let mut first = 1;
            let mut meshes = Vec::new();
            for object in objects {
                let mesh = object.mesh();
                let place = |(number, &surface): (usize, &u16)| {
                    // Below 2¹⁶.
                    (usize::from(surface) * base + number / unit % base) as u16
                };
                let places = (first..).zip(mesh.triangle_surfaces()).map(place).collect();
                let surfaces = vec![Surface::default(); mesh.surfaces().len() * base];
                let numbered = mesh.clone().with_surfaces(surfaces, places);
                let numbered = numbered.map_err(|_| ProbeError::Surfaces(mesh.surfaces().len()))?;
                meshes.push(Shared::new(numbered.with_one_surface_a_vertex()));
                first += mesh.triangles().len();
            }
            digits.push(meshes);
            unit *= base;
        }
        let meshes = objects.iter().map(|object| Shared::clone(internals::shared_mesh(object))).collect();
        *self = Self { meshes, base, digits };
        Ok(())
    }

    /// An object with another mesh. Copies each material once per digit; each copy shows its digit under any light.
    fn object(&self, like: &Object, mesh: &Shared<Mesh>) -> Object {
        let digits = |material: &Material| {
            let mut digits = vec![material.clone(); self.base];
            for (digit, material) in digits.iter_mut().enumerate() {
                // The base is at most 256.
                material.ramp = RampChoice::Entries(Ramp::single(digit as u8));
                // A coloured highlight takes three channels, too.
                (material.color, material.highlight) = ([1.0; 3], [1.0; 3]);
            }
            digits
        };
        let surfaces = mesh.surfaces().len() / self.base;
        let materials = like.materials.iter().take(surfaces).flat_map(digits).collect();
        internals::with_mesh(like, Shared::clone(mesh), materials)
    }

    /// The triangle with a number.
    fn face(&self, number: usize) -> Option<Face> {
        let mut triangle = number.checked_sub(1)?;
        for (object, mesh) in self.meshes.iter().enumerate() {
            let triangles = mesh.triangles().len();
            if triangle < triangles {
                return Some(Face { object, triangle });
            }
            triangle -= triangles;
        }
        None
    }
}
