//! Lights, materials, and the intensity at a vertex.
//!
//! From S1, for one channel:
//!
//! ```text
//! I = ka·Ia + Σ over lights of kd·Id·max(0, n·l)
//! ```
//!
//! A light behind a face adds nothing, never a negative amount. The sum is clamped once, at its
//! end: S1 clamps each component after summing, and so several lights together may fill what one
//! alone would not. Intensities are values of the DAC, with no gamma, as they were then.

use alloc::string::String;

use glam::Vec3;

use crate::mesh::Surface;
use crate::palette::{Palette, Ramp};

/// Where a material's shades lie in the palette.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum RampChoice {
    /// The palette's ramp of this number, counted round: of a palette with one ramp always that.
    Number(u16),
    /// These entries, whatever the palette.
    Entries(Ramp),
}

impl RampChoice {
    /// The entries in `palette`. A palette without ramps, or none at all, counts as one ramp of 256.
    #[must_use]
    pub fn in_palette(self, palette: Option<&Palette>) -> Ramp {
        match (self, palette) {
            (Self::Entries(ramp), _) => ramp,
            (Self::Number(number), Some(palette)) if palette.ramps() > 0 => {
                palette.ramp(usize::from(number) % palette.ramps()).unwrap_or(Ramp::WHOLE)
            }
            _ => Ramp::WHOLE,
        }
    }
}

/// How a surface answers light.
#[derive(Clone, PartialEq, Debug)]
pub struct Material {
    /// A name for people.
    pub name: String,
    /// ka: the share of the scene's ambient light that it gives back.
    pub ambient: f32,
    /// kd: the share of a light that it gives back in all directions.
    pub diffuse: f32,
    /// Its entries of the palette.
    pub ramp: RampChoice,
}

impl Material {
    /// Of white light, how much a white surface gives back as ambient light; the rest is diffuse.
    const AMBIENT_SHARE: f32 = 0.15;

    /// A material that gives back all light, matt, in the palette's first ramp.
    #[must_use]
    pub fn white() -> Self {
        Self::from_surface(&Surface::default(), 0)
    }

    /// What an MTL file says, on one channel: Kd's luminance after ITU-R BT.601, the weights of a
    /// television of the time; a seventh of it ambient. `number` chooses the ramp.
    #[must_use]
    pub fn from_surface(surface: &Surface, number: u16) -> Self {
        let [red, green, blue] = surface.diffuse;
        let luminance = 0.299 * red + 0.587 * green + 0.114 * blue;
        Self {
            name: surface.name.clone(),
            ambient: Self::AMBIENT_SHARE * luminance,
            diffuse: (1.0 - Self::AMBIENT_SHARE) * luminance,
            ramp: RampChoice::Number(number),
        }
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.ambient.is_finite() && self.diffuse.is_finite()
    }
}

impl Default for Material {
    fn default() -> Self {
        Self::white()
    }
}

/// A source of light.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub enum Light {
    /// So far away that it comes from one direction everywhere.
    Sun {
        /// Towards the light, in the world; any length but zero.
        direction: Vec3,
        /// Id: 1 lights a white surface that faces it fully.
        intensity: f32,
    },
}

impl Light {
    /// A sun of intensity 1 in `direction`, which points **towards** it; any length but zero.
    #[must_use]
    pub fn sun(direction: [f32; 3]) -> Self {
        Self::Sun { direction: Vec3::from_array(direction), intensity: 1.0 }
    }

    /// The same light with this intensity.
    #[must_use]
    pub fn with_intensity(self, intensity: f32) -> Self {
        match self {
            Self::Sun { direction, .. } => Self::Sun { direction, intensity },
        }
    }

    /// What is wrong with it, if anything.
    pub(crate) fn check(&self) -> Result<(), &'static str> {
        match *self {
            Self::Sun { direction, intensity } if !(direction.is_finite() && intensity.is_finite()) => {
                Err("its direction and intensity must be finite")
            }
            Self::Sun { direction, .. } if direction == Vec3::ZERO => Err("its direction must not be zero"),
            Self::Sun { .. } => Ok(()),
        }
    }
}

/// A sun as an object sees it: its direction turned into the object's own space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beam {
    /// Unit, towards the light.
    pub(crate) towards: Vec3,
    pub(crate) intensity: f32,
}

/// ka·Ia + kd·Σ Id·max(0, n·l), not yet clamped, for the side of the surface that `normal` (unit)
/// points away from it, and for the other side.
///
/// The sum is taken in f64, in the order of the lights: a thousand lights of the greatest f32 stay
/// finite there, whatever their signs.
#[inline]
pub(crate) fn both_sides(ambient: f64, diffuse: f64, beams: &[Beam], normal: Vec3) -> (f64, f64) {
    let (mut front, mut back) = (0.0, 0.0);
    for beam in beams {
        let cosine = normal.dot(beam.towards);
        // Of −0.0 and NaN neither side has any.
        if cosine > 0.0 {
            front += f64::from(beam.intensity) * f64::from(cosine);
        } else if cosine < 0.0 {
            back -= f64::from(beam.intensity) * f64::from(cosine);
        }
    }
    (ambient + diffuse * front, ambient + diffuse * back)
}
