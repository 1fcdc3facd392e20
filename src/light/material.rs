//! Materials: a surface's response to light.

use alloc::string::String;

use super::LightResponse;
use super::source::{is_colored, luminance};
use crate::mesh::Surface;
use crate::palette::{Palette, Ramp, Rgb};
use crate::shared::Shared;
use crate::texture::Texture;

/// The place of a material's shades in the palette.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum RampChoice {
    /// The palette's ramp of this number, counted round. A palette with one ramp always gives that. With a palette of no ramps
    /// it means [`Nearest`](Self::Nearest); a white material is then drawn in the colours of the mesh's surface, and dithered.
    Number(u16),
    /// These entries, whatever the palette.
    Entries(Ramp),
    /// No ramp: whatever the palette, the material is lit on three channels in its own colour, grey or not, and drawn
    /// in the nearest entries.
    Nearest,
}

impl RampChoice {
    /// The entries in `palette`. A palette without ramps, or none at all, counts as one ramp of 256, and so does a
    /// material that needs no ramp.
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

/// A material: a surface's response to light.
#[derive(Clone, PartialEq, Debug)]
pub struct Material {
    /// A name for people.
    pub name: String,
    /// ka: the share of the scene's ambient light that it gives back.
    pub ambient: f32,
    /// kd: the share of a light that it gives back in all directions.
    pub diffuse: f32,
    /// ks: the share of a light that it mirrors. 0 means no highlight.
    pub specular: f32,
    /// s: the shininess, the exponent of the highlight: 1 is a broad one, 100 a point. 0 means no highlight, whatever
    /// `specular` is, as in modelling programs. A negative number is an error when a scene is drawn.
    pub shininess: f32,
    /// The entries of the palette, for a material that is lit on one channel and has no texture.
    pub ramp: RampChoice,
    /// Red, green and blue of the material. If the three differ it is lit on three channels: its ambient and diffuse
    /// light are multiplied with them, and it is drawn in the palette's nearest colours.
    pub color: [f32; 3],
    /// Red, green and blue of its highlight, on three channels: white, as a rule, so that it has the light's colour.
    pub highlight: [f32; 3],
    /// An image on it, by the mesh's texture coordinates; its shades are those of the image.
    pub texture: Option<Shared<Texture>>,
    /// An environment map: an image of the surroundings, mirrored by the normal as the eye sees it. Used only without a
    /// texture.
    pub environment: Option<Shared<Texture>>,
    /// The way in which it covers what is behind it.
    pub blend: Blend,
    /// The material's own response to light, in place of the lighting model's intensity. The 16.16 path leaves it out.
    pub response: Option<LightResponse>,
}

/// The way in which a body covers what is behind it, by a table of 256 × 256 colours.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
#[non_exhaustive]
pub enum Blend {
    /// The body hides what is behind it.
    #[default]
    Opaque,
    /// So many 255ths of its own colour, and the rest of the colour behind it.
    Mix(u8),
    /// Its colour is added to the one behind it: the glenz of the demos.
    Add,
}

/// A material that gives back all light, matt, in the palette's first ramp.
impl Default for Material {
    fn default() -> Self {
        Self::from_surface(&Surface::default(), 0)
    }
}

impl Material {
    /// The share of white light that a white surface gives back as ambient light; the rest is diffuse.
    const AMBIENT_SHARE: f32 = 0.15;

    /// Makes a material from an MTL file's, on one channel: Kd's and Ks's luminance, and a seventh of Kd's as ambient.
    /// `number` chooses the ramp. The texture is left to the caller, who can read files: [`with_map`](Self::with_map).
    #[must_use]
    pub(crate) fn from_surface(surface: &Surface, number: u16) -> Self {
        let diffuse = luminance(surface.diffuse);
        Self {
            name: surface.name.clone(),
            ambient: Self::AMBIENT_SHARE * diffuse,
            diffuse: (1.0 - Self::AMBIENT_SHARE) * diffuse,
            specular: luminance(surface.specular),
            shininess: surface.shininess,
            ramp: RampChoice::Number(number),
            color: [1.0; 3],
            highlight: [1.0; 3],
            texture: None,
            environment: None,
            // 1 to 254 of 255: the cast truncates after the half.
            blend: match surface.opacity {
                opacity if opacity > 0.0 && opacity < 1.0 => {
                    Blend::Mix((opacity * 255.0 + 0.5).clamp(1.0, 254.0) as u8)
                }
                _ => Blend::Opaque,
            },
            response: None,
        }
    }

    /// Puts the picture that an MTL file's `map_Kd` names on the material. Kd tints the picture: a coloured Kd goes
    /// into a copy of it, a grey one leaves it as it is, to be shared.
    #[must_use]
    pub fn with_map(self, surface: &Surface, map: &Shared<Texture>) -> Self {
        let most = surface.diffuse.iter().copied().fold(0.0, f32::max);
        if !is_colored(surface.diffuse) || most == 0.0 {
            return Self { texture: Some(Shared::clone(map)), ..self };
        }
        let tinted = map.modulated(Rgb::from_intensities(surface.diffuse.map(|channel| channel / most)));
        Self {
            ambient: Self::AMBIENT_SHARE * most,
            diffuse: (1.0 - Self::AMBIENT_SHARE) * most,
            texture: Some(Shared::new(tinted)),
            ..self
        }
    }

    /// The colours of the material and of its highlight, on three channels. If the material has none, they are those of
    /// the surface that it was made from: Kd and Ks without their luminance, which the material's shares of light have.
    /// A texture has its colours itself.
    #[must_use]
    pub fn own_colors(&self, surface: &Surface) -> ([f32; 3], [f32; 3]) {
        let or_else = |own: [f32; 3], of: [f32; 3]| if own == [1.0; 3] { hue(of) } else { own };
        let color = if self.texture.is_some() { self.color } else { or_else(self.color, surface.diffuse) };
        (color, or_else(self.highlight, surface.specular))
    }

    /// A copy of the material in its [own colours](Self::own_colors) if it has a ramp by number only; otherwise a plain
    /// copy. It is for a palette that has no ramps.
    #[must_use]
    pub fn in_own_colors(&self, surface: &Surface) -> Self {
        if !matches!(self.ramp, RampChoice::Number(_)) {
            return self.clone();
        }
        let (color, highlight) = self.own_colors(surface);
        Self { ramp: RampChoice::Nearest, color, highlight, ..self.clone() }
    }

    /// Returns whether its three channels differ.
    #[must_use]
    pub fn is_colored(&self) -> bool {
        is_colored(self.color) || (self.is_specular() && is_colored(self.highlight))
    }

    /// Returns whether lighting it takes three channels: it is coloured, or drawn in the nearest entries. An image
    /// alone takes but one.
    #[must_use]
    pub fn takes_channels(&self) -> bool {
        let has_image = self.texture.is_some() || self.environment.is_some();
        self.is_colored() || (self.ramp == RampChoice::Nearest && !has_image)
    }

    /// Returns whether it names a ramp of a palette that has none.
    pub(crate) fn misses_ramp(&self, palette: Option<&Palette>) -> bool {
        matches!(self.ramp, RampChoice::Number(_)) && palette.is_some_and(|palette| palette.ramps() == 0)
    }

    /// Returns whether it has a highlight.
    #[must_use]
    pub fn is_specular(&self) -> bool {
        self.specular != 0.0 && self.shininess > 0.0
    }

    pub(crate) fn is_finite(&self) -> bool {
        let Self { ambient, diffuse, specular, shininess, color, highlight, .. } = self;
        let numbers = [ambient, diffuse, specular, shininess].into_iter().chain(color).chain(highlight);
        numbers.into_iter().all(|number| number.is_finite())
    }
}

/// A colour without its luminance; white for a grey, for a colour without luminance, and beyond f32.
fn hue(color: [f32; 3]) -> [f32; 3] {
    let hue = color.map(|channel| channel / luminance(color));
    if is_colored(color) && luminance(color) > 0.0 && hue.iter().all(|channel| channel.is_finite()) {
        hue
    } else {
        [1.0; 3]
    }
}
