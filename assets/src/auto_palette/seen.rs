//! Area and brightness of each material of a scene, as far as it is visible.
//!
//! Each moment is drawn once with intensities as shades, and once with the materials' numbers in place of shades, one
//! byte of the number at a time, so visibility is the renderer's own. Adding up projected areas would be cheaper, but
//! would include hidden areas. Materials behind transparent surfaces are visible, too: the scene is drawn again without
//! those surfaces.

use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;

use mode13h::light::{Blend, Material, RampChoice};
use mode13h::palette::Ramp;
use mode13h::render::{RenderError, Renderer};
use mode13h::scene::{Motion, Path, Scene};
use mode13h::settings::Settings;
use mode13h::vga::Vga;

/// The number of pictures per loop, unless too many of them would show the same pose.
const POSES: u32 = 16;

/// The maximum number of pictures per loop.
const MAX_POSES: u32 = 64;

/// Area and brightness of a material, as visible over one loop of the scene.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Seen {
    /// The share of its pixels among all covered pixels, 0 to 1.
    pub area: f32,
    /// The least intensity of ambient and diffuse light that it shows there, 0 to 1, with 1 for full light; 0 if it is
    /// never visible.
    pub darkest: f32,
    /// The greatest such intensity.
    pub brightest: f32,
}

/// Measures each material of each object in pictures of 320 × 200: at 16 moments of a loop of the scene, or at one if
/// nothing moves. There are more moments if a motion repeats a multiple of 8 times per loop.
///
/// # Errors
/// Those of [`Renderer::draw`].
pub fn seen(scene: &Scene) -> Result<Vec<Vec<Seen>>, RenderError> {
    seen_in(scene, &Round::of(scene))
}

/// Measures each material of each object at the moments of a loop.
pub(super) fn seen_in(scene: &Scene, round: &Round<'_>) -> Result<Vec<Vec<Seen>>, RenderError> {
    let materials = || scene.objects().iter().flat_map(|object| &object.materials);
    let mut tallies = vec![Tally::default(); materials().count()];
    let shines: Vec<bool> = materials().map(|material| material.blend != Blend::Opaque).collect();
    let mut front = Layer::new(scene, false);
    let mut behind = shines.contains(&true).then(|| Layer::new(scene, true));
    for moment in round.moments() {
        front.add(moment, &mut tallies, |number| behind.is_none() || shines[number])?;
        if let Some(behind) = &mut behind {
            behind.add(moment, &mut tallies, |number| !shines[number])?;
        }
    }
    let all: u32 = tallies.iter().map(|tally| tally.pixels).sum();
    let mut each = tallies.iter().map(|tally| tally.of(all));
    Ok(scene.objects().iter().map(|object| each.by_ref().take(object.materials.len()).collect()).collect())
}

/// One loop of a scene: the moments that are drawn, and what moves in addition to the scene's motions.
pub(super) struct Round<'p> {
    poses: u32,
    /// The time of the first moment, and the length of the loop, in seconds.
    from: f64,
    duration: f64,
    pose: &'p dyn Fn(&mut Scene, f64),
}

/// A moment of a [`Round`].
#[derive(Clone, Copy)]
pub(super) struct Moment<'p> {
    seconds: f64,
    pose: &'p dyn Fn(&mut Scene, f64),
}

impl Round<'_> {
    /// The loop of a scene in which only its motions move anything.
    pub(super) fn of(scene: &Scene) -> Self {
        Self::moved(scene, &[], &|_, _| {})
    }

    pub(super) fn moments(&self) -> impl Iterator<Item = Moment<'_>> {
        let seconds = |pose| self.from + self.duration * f64::from(pose) / f64::from(self.poses);
        (0..self.poses).map(move |pose| Moment { seconds: seconds(pose), pose: self.pose })
    }
}

impl<'p> Round<'p> {
    /// The loop of a scene in which `pose` moves more, which repeats after each of these times, in seconds.
    pub(super) fn moved(scene: &Scene, periods: &[f64], pose: &'p dyn Fn(&mut Scene, f64)) -> Self {
        let (poses, from) = match scene.motions.is_empty() && periods.is_empty() {
            true => (1, scene.time()),
            false => (poses(&rounds(scene, periods)), 0.0),
        };
        Self { poses, from, duration: scene.duration, pose }
    }
}

/// How often each motion repeats in a loop, to the nearest whole number above 0.
fn rounds(scene: &Scene, periods: &[f64]) -> Vec<u32> {
    let of_motion = |motion: &Motion| match motion {
        Motion::Spin { turns, .. } => turns.map(|turns| turns * scene.duration),
        Motion::Path { path: Path::Line { period, .. } | Path::Circle { period, .. }, .. } => {
            [scene.duration / period, 0.0, 0.0]
        }
        _ => [0.0; 3],
    };
    let all = scene.motions.iter().flat_map(of_motion).chain(periods.iter().map(|period| scene.duration / period));
    all.map(|rounds| libm::round(libm::fabs(rounds)) as u32).filter(|rounds| *rounds > 0).collect()
}

/// The number of moments in a loop that show each motion in at least four poses.
///
/// If a motion repeats r times, n / gcd(n, r) of n moments are different: of 16 moments only two for r = 8, and one for
/// r = 16. The number is 16 unless some r is a multiple of 8.
fn poses(rounds: &[u32]) -> u32 {
    let shows_all = |poses: &u32| rounds.iter().all(|rounds| poses / common_divisor(*poses, *rounds) >= 4);
    (POSES..=MAX_POSES).find(shows_all).unwrap_or(POSES)
}

/// The greatest common divisor.
fn common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

impl Moment<'_> {
    /// Moves everything in the scene, or in a copy of it, to where it is at this moment.
    pub(super) fn show(self, scene: &mut Scene) {
        scene.set_time(self.seconds);
        (self.pose)(scene, self.seconds);
    }
}

/// A scene prepared for measuring, and the renderer that draws it.
pub(super) struct Picture {
    scene: Scene,
    renderer: Renderer,
    vga: Box<Vga>,
}

impl Picture {
    /// A picture of `scene` on one channel, without effects on its pixels. `change` modifies the materials, given their
    /// numbers from 0.
    pub(super) fn new(scene: &Scene, mut change: impl FnMut(usize, &mut Material)) -> Self {
        let mut scene = scene.clone();
        scene.palette = None;
        scene.palette_animation = None;
        scene.fog = None;
        scene.background = 0;
        scene.background_color = None;
        scene.settings = Settings { dither: None, channels: None, ..scene.settings };
        let materials = scene.objects_mut().iter_mut().flat_map(|object| &mut object.materials);
        for (number, material) in materials.enumerate() {
            (material.color, material.highlight) = ([1.0; 3], [1.0; 3]);
            material.ramp = RampChoice::Entries(Ramp::WHOLE);
            change(number, material);
        }
        Self { scene, renderer: Renderer::new(), vga: Box::new(Vga::new()) }
    }

    pub(super) fn scene_mut(&mut self) -> &mut Scene {
        &mut self.scene
    }

    /// Draws the scene at a moment, and returns its pixels.
    pub(super) fn at(&mut self, moment: Moment<'_>) -> Result<&[u8], RenderError> {
        moment.show(&mut self.scene);
        self.renderer.draw(&self.scene, &mut self.vga)?;
        Ok(self.vga.pixels())
    }
}

/// Intensities and material numbers, with transparent surfaces either opaque or left out.
struct Layer {
    intensities: Picture,
    numbers: Numbers,
}

impl Layer {
    fn new(scene: &Scene, through: bool) -> Self {
        let ambient = scene.ambient;
        let mut intensities = Picture::new(scene, |_, material| {
            let full = full_light(material, ambient);
            (material.ambient, material.diffuse) = (material.ambient / full, material.diffuse / full);
            material.specular = 0.0;
            become_plain(material, through);
        });
        for light in intensities.scene_mut().lights_mut() {
            *light = light.with_intensity(light.brightness()).with_color([1.0; 3]);
        }
        Self { intensities, numbers: Numbers::new(scene, through) }
    }

    /// Counts the pixels of the materials for which `counts` is true.
    fn add(
        &mut self,
        moment: Moment<'_>,
        tallies: &mut [Tally],
        counts: impl Fn(usize) -> bool,
    ) -> Result<(), RenderError> {
        let intensities = self.intensities.at(moment)?;
        for (number, &intensity) in self.numbers.at(moment)?.iter().zip(intensities) {
            if let Some(number) = number.filter(|number| counts(*number)) {
                tallies[number].add(intensity);
            }
        }
        Ok(())
    }
}

/// Removes the images and makes the material opaque, or, if it is transparent and `through`, invisible.
fn become_plain(material: &mut Material, through: bool) {
    (material.texture, material.environment) = (None, None);
    let is_left_out = through && material.blend != Blend::Opaque;
    material.blend = if is_left_out { Blend::Mix(0) } else { Blend::Opaque };
}

/// The number of the material at every pixel.
pub(super) struct Numbers {
    /// One picture for each byte of the number. Numbers are counted from 1 there, since the background is 0.
    bytes: Vec<Picture>,
    found: Vec<Option<usize>>,
}

impl Numbers {
    pub(super) fn new(scene: &Scene, through: bool) -> Self {
        let count: usize = scene.objects().iter().map(|object| object.materials.len()).sum();
        let places = (0..usize::BITS).step_by(8).take_while(|&place| count >> place > 0);
        let picture = |place: u32| {
            let mut picture = Picture::new(scene, |number, material| {
                // The lowest byte after the shift. On a ramp of one entry, every shade is that entry.
                let byte = ((number + 1) >> place) as u8;
                material.ramp = RampChoice::Entries(Ramp::single(byte));
                become_plain(material, through);
            });
            // Unlit, with the cheapest shading.
            let scene = picture.scene_mut();
            scene.lights_mut().iter_mut().for_each(|light| *light = light.with_intensity(0.0));
            scene.settings = Settings { hidden_surfaces: scene.settings.hidden_surfaces, ..Settings::default() };
            picture
        };
        Self { bytes: places.map(picture).collect(), found: vec![None; Vga::SHOWN] }
    }

    /// The number of each pixel's material, from 0, through all objects in order.
    pub(super) fn at(&mut self, moment: Moment<'_>) -> Result<&[Option<usize>], RenderError> {
        let mut numbers = vec![0; Vga::SHOWN];
        for (place, picture) in (0..).step_by(8).zip(&mut self.bytes) {
            for (number, &byte) in numbers.iter_mut().zip(picture.at(moment)?) {
                *number |= usize::from(byte) << place;
            }
        }
        for (found, number) in self.found.iter_mut().zip(numbers) {
            *found = number.checked_sub(1);
        }
        Ok(&self.found)
    }
}

/// The pixels of a material so far.
#[derive(Clone, Copy, Default)]
struct Tally {
    pixels: u32,
    darkest: u8,
    brightest: u8,
}

impl Tally {
    fn add(&mut self, intensity: u8) {
        self.darkest = if self.pixels == 0 { intensity } else { self.darkest.min(intensity) };
        self.brightest = self.brightest.max(intensity);
        self.pixels += 1;
    }

    /// The result, relative to `all` pixels, which are at most those of 128 full pictures: 8,192,000.
    fn of(self, all: u32) -> Seen {
        Seen {
            area: self.pixels as f32 / all.max(1) as f32,
            darkest: f32::from(self.darkest) / 255.0,
            brightest: f32::from(self.brightest) / 255.0,
        }
    }
}

/// The share of full light that a material reflects, ambient and diffuse together. It is at most 1, since no more can
/// be shown, and 1 for a material that reflects nothing.
pub(super) fn full_light(material: &Material, ambient: f32) -> f32 {
    let full = material.ambient * ambient + material.diffuse;
    if full > 0.0 { full.min(1.0) } else { 1.0 }
}
