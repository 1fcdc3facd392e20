//! Materials: how surfaces respond to light.

use alloc::string::String;

use super::LightResponse;
use super::source::{is_colored, luminance};
use crate::mesh::Surface;
use crate::palette::{Palette, Ramp, Rgb};
use crate::shared::Shared;
use crate::texture::Texture;

/// The palette entries that hold a material's shades.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum RampChoice {
    /// The palette's ramp with this index, modulo the number of ramps; in a palette of one ramp it is always that one.
    /// If the palette has no ramps, this acts as [`Nearest`](Self::Nearest); a white material is then drawn in the
    /// colours of the mesh's surface, and dithered.
    Number(u16),
    /// These entries, whatever the palette.
    Entries(Ramp),
    /// No ramp: with any palette, the material is lit on three channels in its own colour, grey or not, and drawn in
    /// the nearest entries.
    Nearest,
}

impl RampChoice {
    /// The entries in `palette`. A missing palette, or one without ramps, counts as one ramp of 256, and so does any
    /// palette for a material that needs no ramp.
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

/// A material: how a surface responds to light.
#[derive(Clone, PartialEq, Debug)]
pub struct Material {
    /// The display name.
    pub name: String,
    /// ka: the share of the scene's ambient light that it reflects.
    pub ambient: f32,
    /// kd: the share of a light that it reflects in all directions.
    pub diffuse: f32,
    /// ks: the share of a light that it reflects specularly. 0 means no highlight.
    pub specular: f32,
    /// s: the shininess, the exponent of the highlight: 1 gives a broad one, 100 a point. 0 means no highlight,
    /// whatever `specular` is, as in modelling programs. Above 10⁹ it counts as 10⁹, and a negative number is an error
    /// when a scene is drawn.
    pub shininess: f32,
    /// The palette entries, for a material that is lit on one channel and has no texture.
    pub ramp: RampChoice,
    /// Red, green and blue of the material. If the three differ, it is lit on three channels: its ambient and diffuse
    /// light are multiplied by them, and it is drawn in the palette's nearest colours.
    pub color: [f32; 3],
    /// Red, green and blue of its highlight, on three channels: usually white, so that it has the light's colour.
    pub highlight: [f32; 3],
    /// An image mapped by the mesh's texture coordinates; the surface is shaded in the image's colours.
    pub texture: Option<Shared<Texture>>,
    /// An environment map: an image of the surroundings, looked up by the normal as seen from the eye. Ignored if there
    /// is a texture.
    pub environment: Option<Shared<Texture>>,
    /// How it covers what is behind it.
    pub blend: Blend,
    /// The material's own response to light, applied to the lighting model's intensity. The 16.16 path ignores it.
    pub response: Option<LightResponse>,
}

/// How a surface covers what is behind it, by a table of 256 × 256 colours.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
#[non_exhaustive]
pub enum Blend {
    /// The surface hides what is behind it.
    #[default]
    Opaque,
    /// The opacity in 1/255: this share of its own colour, and the rest of the colour behind it.
    Mix(u8),
    /// Its colour is added to the one behind it: the glenz of the demos.
    Add,
}

/// A matt white material in the palette's first ramp: it reflects 15 % of ambient and 85 % of other light.
impl Default for Material {
    fn default() -> Self {
        Self::from_surface(&Surface::default(), 0)
    }
}

impl Material {
    /// The share of white light that a white surface reflects as ambient light; the rest is diffuse.
    const AMBIENT_SHARE: f32 = 0.15;

    /// Converts a surface of an MTL file to a material on one channel: the luminance of Kd and Ks, and a share of Kd as
    /// ambient. `number` chooses the ramp. The texture is left to callers that can read files:
    /// [`with_map`](Self::with_map).
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
            // 1 to 254 of 255: the cast truncates after 0.5 is added.
            blend: match surface.opacity {
                opacity if opacity > 0.0 && opacity < 1.0 => {
                    Blend::Mix((opacity * 255.0 + 0.5).clamp(1.0, 254.0) as u8)
                }
                _ => Blend::Opaque,
            },
            response: None,
        }
    }

    /// Applies the picture that an MTL file's `map_Kd` names. Kd tints the picture: a coloured Kd is multiplied into a
    /// copy of it, a grey one leaves it unchanged and shared.
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
    /// the surface that it was made from: Kd and Ks divided by their luminance, which the material's `diffuse` and
    /// `specular` already contain. A texture has its own colours.
    #[must_use]
    pub fn own_colors(&self, surface: &Surface) -> ([f32; 3], [f32; 3]) {
        let or_else = |own: [f32; 3], of: [f32; 3]| if own == [1.0; 3] { hue(of) } else { own };
        let color = if self.texture.is_some() { self.color } else { or_else(self.color, surface.diffuse) };
        (color, or_else(self.highlight, surface.specular))
    }

    /// Copies the material, in its [own colours](Self::own_colors) if it has a ramp by number only. This is for a
    /// palette that has no ramps.
    #[must_use]
    pub fn in_own_colors(&self, surface: &Surface) -> Self {
        if !matches!(self.ramp, RampChoice::Number(_)) {
            return self.clone();
        }
        let (color, highlight) = self.own_colors(surface);
        Self { ramp: RampChoice::Nearest, color, highlight, ..self.clone() }
    }

    /// Returns whether the material is coloured: its red, green and blue differ.
    #[must_use]
    pub fn is_colored(&self) -> bool {
        is_colored(self.color) || (self.is_specular() && is_colored(self.highlight))
    }

    /// Returns whether lighting it takes three channels: it is coloured, or drawn in the nearest entries. An image
    /// alone needs only one.
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

/// A colour divided by its luminance; white for a grey, for a colour without luminance, and beyond f32.
fn hue(color: [f32; 3]) -> [f32; 3] {
    let hue = color.map(|channel| channel / luminance(color));
    if is_colored(color) && luminance(color) > 0.0 && hue.iter().all(|channel| channel.is_finite()) {
        hue
    } else {
        [1.0; 3]
    }
}
