//! A material in its scene, with everything that its shades are computed from.

use crate::fixed::U8F8;
use crate::lanes::each;
use crate::light::{Blend, LightResponse, Material, Reflectance};
use crate::palette::{Palette, Ramp};
use crate::plan::stages::{Dither, LitAt, Stages};
use crate::texture::Texture;

/// A material in its scene.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct SurfaceMaterial {
    pub(super) reflectance: Reflectance,
    /// Range of its shades: the material's entries; all 256 for an image, or for a channel.
    pub(super) ramp: Ramp,
    /// The image's width and height, if it is on.
    pub(super) texture_size: Option<[u32; 2]>,
    pub(super) environment_size: Option<[u32; 2]>,
    pub(super) blend: Blend,
    /// True if its pixels pass through stages.
    pub(super) has_effects: bool,
    pub(super) response: Option<LightResponse>,
}

impl SurfaceMaterial {
    pub(super) fn new(material: &Material, ambient: f32, palette: Option<&Palette>, stages: &Stages) -> Self {
        let size = |texture: &Texture| [1_u32 << texture.width_bits(), 1 << texture.height_bits()];
        let texture_size = material.texture.as_deref().filter(|_| stages.has_texture()).map(size);
        let environment_size =
            material.environment.as_deref().filter(|_| stages.has_environment() && texture_size.is_none()).map(size);
        let blend = if stages.is_transparent() { material.blend } else { Blend::Opaque };
        let channels = stages.has_channels();
        let has_highlight = stages.has_highlights() && material.is_specular();
        let image = texture_size.is_some() || environment_size.is_some();
        let everywhere =
            stages.has_fog() || channels || stages.dither != Dither::None || stages.lit_at == LitAt::Pixels;
        // Forced on, an effect runs on every surface, with neutral input where it has none.
        let forced = stages.neutral_image || stages.neutral_blend;
        Self {
            reflectance: Reflectance {
                ambient: f64::from(material.ambient) * f64::from(ambient),
                diffuse: f64::from(material.diffuse),
                specular: f64::from(if has_highlight { material.specular } else { 0.0 }),
                // Unit vectors are rounded, and for a greater exponent the power of a cosine just above 1 may be infinite.
                shininess: f64::from(material.shininess).min(1e9),
                color: material.color.map(f64::from),
                highlight: material.highlight.map(f64::from),
            },
            ramp: if image || channels { Ramp::WHOLE } else { material.ramp.in_palette(palette) },
            texture_size,
            environment_size,
            blend,
            has_effects: everywhere || image || forced || blend != Blend::Opaque,
            response: material.response.clone(),
        }
    }

    /// A shade, or a channel, after the material's own response to light.
    #[inline]
    pub(super) fn respond(&self, shade: U8F8) -> U8F8 {
        self.response.as_ref().map_or(shade, |response| apply_response(response, shade, self.ramp))
    }

    /// The shade, or the channel, of an intensity. This is the only clamp; beyond f32 an intensity becomes infinite,
    /// which clamps to 1 too.
    #[inline]
    pub(super) fn shade(&self, intensity: f64) -> U8F8 {
        U8F8::from_intensity(intensity as f32, self.ramp.first(), self.ramp.entries())
    }

    /// The shades of eight intensities on a ramp, which may be known at compile time.
    #[inline(always)]
    pub(super) fn shade_of_eight(ramp: Ramp, intensities: &[f64; 8]) -> [U8F8; 8] {
        U8F8::from_eight_intensities(&each!(lane => intensities[lane] as f32), ramp.first(), ramp.entries())
    }

    /// The shade in ambient light only.
    pub(super) fn constant(&self) -> U8F8 {
        self.shade(self.reflectance.ambient)
    }
}

/// A response applied to a shade of a ramp.
#[cold]
fn apply_response(response: &LightResponse, shade: U8F8, ramp: Ramp) -> U8F8 {
    // A ramp of one entry has one shade.
    let full = f32::from(ramp.entries() - 1).max(1.0) * 256.0;
    let intensity = (f32::from(shade.to_bits()) - f32::from(ramp.first()) * 256.0) / full;
    U8F8::from_intensity(response.apply(intensity), ramp.first(), ramp.entries())
}
