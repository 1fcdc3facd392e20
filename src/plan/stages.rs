//! The stages that an object goes through, as values for the renderer, without names or reasons.

use super::Effect;
use crate::settings::{DitherPattern, HiddenSurfaces, Mapping, Shading};

/// The variant of an effect.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
#[non_exhaustive]
pub enum Choice {
    /// The only one.
    #[default]
    Only,
    /// Shading by this method.
    Shading(Shading),
    /// Shading chosen for each face by an error budget.
    Budget,
    /// This hidden-surface method.
    HiddenSurfaces(HiddenSurfaces),
    /// This mapping of texture coordinates.
    Mapping(Mapping),
    /// Mipmaps with a level for each face.
    LevelPerFace,
    /// Mipmaps with a level for every 16 pixels of a row.
    LevelPer16Pixels,
    /// Dithering with this pattern.
    Dither(DitherPattern),
}

impl Choice {
    /// The choice's name; empty if there is only one variant.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Only => "",
            Self::Shading(shading) => shading.name(),
            Self::Budget => "budget",
            Self::HiddenSurfaces(way) => way.name(),
            Self::Mapping(mapping) => mapping.name(),
            Self::LevelPerFace => "per face",
            Self::LevelPer16Pixels => "per 16 pixels",
            Self::Dither(pattern) => pattern.name(),
        }
    }
}

/// The work on an object's vertices.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) enum VertexStage {
    /// The last frame's vertices are reused.
    Keep,
    /// Vertices are computed.
    Make,
    /// Vertices and everything cached with them are recomputed, because this was forced or nothing is cached.
    #[default]
    RecomputeAll,
}

/// The light that contributes to shades.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) enum Lighting {
    /// None: each surface has one shade.
    #[default]
    None,
    /// Suns, and no highlights.
    Suns,
    /// Suns, lamps and highlights.
    All,
    /// Suns, lamps and highlights, on each of three channels.
    Channels,
}

/// The points at which light is computed.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) enum LitAt {
    #[default]
    Vertices,
    /// At the middle of each face.
    Faces,
    /// At each pixel.
    Pixels,
}

/// The lamps that fall on an object.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) enum Lamps {
    #[default]
    None,
    InRange,
    /// All lamps, in range or not, because the effect was forced.
    All,
}

/// The dithering, in place of the constant half that is usually added to a shade.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) enum Dither {
    #[default]
    None,
    By(DitherPattern),
    /// Thresholds that change nothing, because the effect was forced.
    Neutral,
}

/// The optional stages, each with the effects that call for it. In a build without those effects
/// the stage is the constant `false`, so the compiler drops it as well.
macro_rules! switches {
    ($($(#[$doc:meta])* $name:ident: $first:ident $(| $other:ident)*;)+) => {
        /// The stages that an object goes through.
        #[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
        pub(crate) struct Switches {
            $($name: bool,)+
        }

        impl Switches {
            /// The stages of an object with these effects.
            pub(crate) fn of(is_on: impl Fn(Effect) -> bool) -> Self {
                Self { $($name: is_on(Effect::$first) $(|| is_on(Effect::$other))*,)+ }
            }
        }

        impl Stages {
            $(
                $(#[$doc])*
                #[inline]
                pub(crate) const fn $name(&self) -> bool {
                    self.switches.$name && !(Effect::$first.is_left_out() $(&& Effect::$other.is_left_out())*)
                }
            )+
        }
    };
}

switches! {
    /// Returns whether vertices may be nearer than the near plane or outside the guard band.
    clips: NearClipping | ScreenClipping;
    /// Returns whether back faces are culled.
    culls: BackFaceCulling;
    /// Returns whether suns or lamps shine on it.
    is_lit: Lighting;
    /// Returns whether some material has a highlight.
    has_highlights: Specular;
    /// Returns whether the shades of a face may differ.
    interpolates: Gouraud;
    /// Returns whether light is computed at pixels.
    lights_pixels: Phong;
    /// Returns whether faces are split.
    tessellates: Tessellation;
    /// Returns whether fog affects it.
    has_fog: Fog;
    /// Returns whether there are three channels of light.
    has_channels: RgbChannels;
    /// Returns whether some surface has a texture.
    has_texture: Texture;
    /// Returns whether some surface reflects an environment map.
    has_environment: EnvironmentMap;
    /// Returns whether textures have mipmaps.
    has_mipmaps: Mipmaps;
    /// Returns whether some surface is transparent.
    is_transparent: Transparency;
    /// Returns whether pixels pass through tables.
    needs_tables: Fog | RgbChannels | Texture | EnvironmentMap | Transparency;
}

/// The stages of one object.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(crate) struct Stages {
    pub(crate) switches: Switches,
    /// Whether the object is not drawn, because it is out of sight.
    pub(crate) is_out_of_sight: bool,
    pub(crate) vertices: VertexStage,
    pub(crate) lighting: Lighting,
    pub(crate) lit_at: LitAt,
    pub(crate) lamps: Lamps,
    /// The mapping of texture coordinates.
    pub(crate) mapping: Mapping,
    pub(crate) dither: Dither,
    /// Whether surfaces without an image get one that changes nothing, because the effect was
    /// forced.
    pub(crate) neutral_image: bool,
    /// Whether opaque surfaces go through a table that changes nothing, because the effect was
    /// forced.
    pub(crate) neutral_blend: bool,
}
