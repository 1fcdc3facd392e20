//! How a surface answers light.

use alloc::string::String;

use super::source::is_colored;
use crate::mesh::Surface;
use crate::palette::{Palette, Ramp};
use crate::scene::Shared;
use crate::texture::Texture;

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
    /// ks: the share of a light that it mirrors; with 0 there is no highlight.
    pub specular: f32,
    /// s: how narrow the highlight is, above 0; 1 is broad, 100 a point.
    pub shininess: f32,
    /// Its entries of the palette, of a material that is lit on one channel and has no texture.
    pub ramp: RampChoice,
    /// Its own red, green and blue. Where the three differ it is lit on three channels, each of them
    /// multiplied with its own, and drawn in the palette's nearest colours.
    pub color: [f32; 3],
    /// An image on it, by the mesh's texture coordinates; its shades are those of the image.
    pub texture: Option<Shared<Texture>>,
    /// An image of what is around it: where its normal points, as the eye sees it, that is mirrored.
    /// Only where it has no texture.
    pub environment: Option<Shared<Texture>>,
    /// How it lies over what is behind it.
    pub blend: Blend,
}

/// How a body lies over what is behind it, by a table of 256 × 256 colours.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
#[non_exhaustive]
pub enum Blend {
    /// It hides it.
    #[default]
    Opaque,
    /// So many 255ths of its own colour, the rest of what is behind.
    Mix(u8),
    /// Its colour is added to what is behind: the glenz of the demos.
    Add,
}

impl Material {
    /// Of white light, how much a white surface gives back as ambient light; the rest is diffuse.
    const AMBIENT_SHARE: f32 = 0.15;

    /// A material that gives back all light, matt, in the palette's first ramp.
    #[must_use]
    pub fn white() -> Self {
        Self::from_surface(&Surface::default(), 0)
    }

    /// What an MTL file says, on one channel: Kd's and Ks's luminance after ITU-R BT.601, the weights
    /// of a television of the time; a seventh of Kd's ambient. `number` chooses the ramp. The texture
    /// is left to the caller, who can read files.
    #[must_use]
    pub fn from_surface(surface: &Surface, number: u16) -> Self {
        let luminance = |[red, green, blue]: [f32; 3]| 0.299 * red + 0.587 * green + 0.114 * blue;
        let diffuse = luminance(surface.diffuse);
        Self {
            name: surface.name.clone(),
            ambient: Self::AMBIENT_SHARE * diffuse,
            diffuse: (1.0 - Self::AMBIENT_SHARE) * diffuse,
            specular: luminance(surface.specular),
            shininess: surface.shininess,
            ramp: RampChoice::Number(number),
            color: [1.0; 3],
            texture: None,
            environment: None,
            blend: Blend::Opaque,
        }
    }

    /// Whether its three channels differ.
    #[must_use]
    pub fn is_colored(&self) -> bool {
        is_colored(self.color)
    }

    /// Whether it has a highlight.
    #[must_use]
    pub fn is_specular(&self) -> bool {
        self.specular != 0.0
    }

    pub(crate) fn is_finite(&self) -> bool {
        let Self { ambient, diffuse, specular, shininess, color: [red, green, blue], .. } = *self;
        [ambient, diffuse, specular, shininess, red, green, blue].iter().all(|number| number.is_finite())
    }
}

impl Default for Material {
    fn default() -> Self {
        Self::white()
    }
}
