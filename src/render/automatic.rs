//! A palette for a model: what is seen of each of its surfaces over a turn, and from that the entries.

use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;

use super::{RenderError, Renderer};
use crate::light::{Material, RampChoice};
use crate::mesh::Mesh;
use crate::palette::auto::{Automatic, Use, share};
use crate::palette::{Ramp, Rgb};
use crate::scene::{Scene, Shared, UpAxis};
use crate::texture::Texture;
use crate::vga::Vga;

/// Pictures over one turn.
const POSES: u32 = 16;

/// How far the model's upper end leans towards the eye, in radians, so that level faces are seen.
const TILT: f64 = 0.35;

/// What is seen of a surface over a turn.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Seen {
    /// Its pixels among all that are covered, 0 to 1.
    pub area: f32,
    /// The least intensity that a matt white material shows there, 0 to 1; 0 if the surface is never in
    /// sight.
    pub darkest: f32,
    /// The greatest.
    pub brightest: f32,
}

/// A palette for a model by [`share`], and for each of its surfaces what its material names there.
///
/// `textures` holds for each surface its texture, if it has one. Area and brightness are those of
/// [`seen`], colours those of [`Surface::color`](crate::mesh::Surface::color) and
/// [`Surface::highlight`](crate::mesh::Surface::highlight). A texture's colours are
/// [tinted](Texture::tinted) by the former, for this and for the table of its shades.
///
/// ```
/// use mode13h::mesh::shapes;
/// use mode13h::palette::auto::Entries;
/// use mode13h::render::automatic;
/// use mode13h::scene::UpAxis;
///
/// let made = automatic(shapes::torus(48, 24), UpAxis::Y, &[])?;
/// assert!(matches!(made.entries[..], [Entries::Ramp { full_light: 1.0, .. }]));
/// # Ok::<(), mode13h::render::RenderError>(())
/// ```
///
/// # Errors
/// As [`Renderer::draw`].
pub fn automatic(
    mesh: impl Into<Shared<Mesh>>,
    up_axis: UpAxis,
    textures: &[Option<&Texture>],
) -> Result<Automatic, RenderError> {
    let mesh: Shared<Mesh> = mesh.into();
    let seen = seen(mesh.clone(), up_axis)?;
    let texels: Vec<Option<Vec<(Rgb, u32)>>> = (0_usize..)
        .zip(mesh.surfaces())
        .map(|(i, surface)| {
            let texture = textures.get(i).copied().flatten()?;
            Some(texture.tinted(surface.color()).into_iter().zip(texture.histogram()).collect())
        })
        .collect();
    let uses: Vec<Use<'_>> = mesh
        .surfaces()
        .iter()
        .zip(seen)
        .zip(&texels)
        .map(|((surface, Seen { area, darkest, brightest }), texels)| Use {
            color: surface.color(),
            highlight: surface.highlight(),
            area,
            darkest,
            brightest,
            texels: texels.as_deref(),
        })
        .collect();
    Ok(share(&uses))
}

/// What is seen of each surface of a model: in 16 pictures of 320 × 200 over a turn about its upward
/// axis, drawn as [`Scene::showing`] shows it but leaning 0.35 rad towards the eye.
///
/// Each pose is drawn once in white for the intensities, and once (with more than 255 surfaces twice
/// or three times) with the surfaces' numbers in place of shades: so visibility is the renderer's own.
/// Adding up projected areas would be cheaper and count what other faces hide.
///
/// # Errors
/// As [`Renderer::draw`].
pub fn seen(mesh: impl Into<Shared<Mesh>>, up_axis: UpAxis) -> Result<Vec<Seen>, RenderError> {
    let mut scene = Scene::showing(mesh);
    scene.palette = None;
    scene.objects_mut().iter_mut().for_each(|object| object.up_axis = up_axis);
    let surfaces = scene.objects().first().map_or(0, |object| object.materials.len());
    let mut tallies = vec![Tally::default(); surfaces];

    let (mut renderer, mut vga) = (Renderer::new(), Box::new(Vga::new()));
    let mut intensities = vec![0; Vga::SHOWN];
    let mut numbers = vec![0_u32; Vga::SHOWN];
    for pose in 0..POSES {
        let turn = core::f64::consts::TAU * f64::from(pose) / f64::from(POSES);
        let white = Material { ramp: RampChoice::Entries(Ramp::WHOLE), ..Material::white() };
        for object in scene.objects_mut() {
            object.set_angles([TILT, turn, 0.0]);
            object.materials.fill(white.clone());
        }
        renderer.draw(&scene, &mut vga)?;
        intensities.copy_from_slice(vga.pixels());

        // Surfaces are numbered from 1, as the background is 0, and drawn one byte of the number after
        // the other: on a ramp of one entry every shade is that entry.
        numbers.fill(0);
        let mut place = 0;
        while surfaces >> place > 0 {
            for object in scene.objects_mut() {
                for (number, material) in (1_usize..).zip(&mut object.materials) {
                    // The lowest byte of what is left.
                    material.ramp = RampChoice::Entries(Ramp::single((number >> place) as u8));
                }
            }
            renderer.draw(&scene, &mut vga)?;
            for (number, &byte) in numbers.iter_mut().zip(vga.pixels()) {
                *number |= u32::from(byte) << place;
            }
            place += 8;
        }
        for (&number, &intensity) in numbers.iter().zip(&intensities) {
            // The background has none.
            if let Some(tally) = (number as usize).checked_sub(1).and_then(|surface| tallies.get_mut(surface)) {
                tally.add(intensity);
            }
        }
    }
    let all: u32 = tallies.iter().map(|tally| tally.pixels).sum();
    Ok(tallies.iter().map(|tally| tally.of(all)).collect())
}

/// The pixels of a surface so far.
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

    /// Among `all` pixels, which are at most 16 pictures full: 1,024,000.
    fn of(self, all: u32) -> Seen {
        Seen {
            area: self.pixels as f32 / all.max(1) as f32,
            darkest: f32::from(self.darkest) / 255.0,
            brightest: f32::from(self.brightest) / 255.0,
        }
    }
}
