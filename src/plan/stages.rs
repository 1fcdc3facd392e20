//! The stages that an object goes through, as values for the renderer. Words and reasons are for people alone.

use super::Effect;
use crate::settings::{DitherPattern, HiddenSurfaces, Mapping, Shading};

/// The way in which an effect is done, of several.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
#[non_exhaustive]
pub enum Choice {
    /// There is only one way.
    #[default]
    Only,
    /// Shading by this technique.
    Shading(Shading),
    /// Shading that an error budget chooses for each face.
    Budget,
    /// Hidden surfaces are left out in this way.
    HiddenSurfaces(HiddenSurfaces),
    /// Texture coordinates run in this way.
    Mapping(Mapping),
    /// Mipmaps: a level for each face.
    LevelPerFace,
    /// Mipmaps: a level for each 16 pixels of a row.
    LevelPer16Pixels,
    /// Dither by this pattern.
    Dither(DitherPattern),
}

impl Choice {
    /// The choice's name; empty if there is only one way.
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
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum VertexStage {
    /// Those of last frame are kept.
    Keep,
    /// They are made.
    Make,
    /// They are made, and with them all that is kept beside them: by force, or because nothing is kept.
    MakeAnew,
}

/// The light that is computed for shades.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Lighting {
    /// None: each surface has one shade.
    None,
    /// Suns, and no highlights.
    Suns,
    /// Suns, lamps and highlights.
    All,
    /// Suns, lamps and highlights, on each of three channels.
    Channels,
}

/// The points at which light is computed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum LitAt {
    Vertices,
    /// At the middle of each face.
    Faces,
    /// At each pixel.
    Pixels,
}

/// The lamps that fall on an object.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Lamps {
    None,
    InRange,
    /// All lamps, in range or not: by force.
    All,
}

/// The dither that replaces the half that is otherwise added to a shade.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Dither {
    None,
    By(DitherPattern),
    /// Thresholds that change nothing: by force.
    Neutral,
}

/// Stages that an object goes through or does not, by the effects that call for them. None is there in a build that leaves
/// its effect out, so the compiler leaves it out as well.
macro_rules! switches {
    ($($(#[$doc:meta])* $name:ident: $first:ident $(| $other:ident)*;)+) => {
        /// The stages that an object goes through.
        #[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
        pub(crate) struct Switches {
            $($name: bool,)+
        }

        impl Switches {
            /// The stages of an object for which these effects are on.
            pub(super) fn of(is_on: impl Fn(Effect) -> bool) -> Self {
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
    /// Returns whether vertices may lie before the near plane or outside the guard band.
    clips: NearClipping | ScreenClipping;
    /// Returns whether faces turned away are culled.
    culls: BackFaceCulling;
    /// Returns whether suns or lamps shine on it.
    is_lit: Lighting;
    /// Returns whether some material has a highlight.
    has_highlights: Specular;
    /// Returns whether a face has shades that differ.
    interpolates: Gouraud;
    /// Returns whether light is computed at pixels.
    lights_pixels: Phong;
    /// Returns whether faces are split.
    tessellates: Tessellation;
    /// Returns whether fog lies before it.
    has_fog: Fog;
    /// Returns whether there are three channels of light.
    has_channels: RgbChannels;
    /// Returns whether some surface has a texture.
    has_texture: Texture;
    /// Returns whether some surface mirrors an image.
    has_environment: EnvironmentMap;
    /// Returns whether textures have mipmaps.
    has_mipmaps: Mipmaps;
    /// Returns whether some surface is transparent.
    is_transparent: Transparency;
    /// Returns whether shades are dithered.
    has_dither: Dither;
    /// Returns whether pixels pass through tables.
    needs_tables: Fog | RgbChannels | Texture | EnvironmentMap | Transparency;
}

/// The stages of one object.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Stages {
    pub(super) switches: Switches,
    pub(crate) vertices: VertexStage,
    /// The least distance of the object's bounds, along the view.
    pub(crate) nearest: f64,
    pub(crate) lighting: Lighting,
    pub(crate) lit_at: LitAt,
    pub(crate) lamps: Lamps,
    /// The mapping of texture coordinates.
    pub(crate) mapping: Mapping,
    pub(crate) dither: Dither,
    /// Surfaces without an image get one that changes nothing: by force.
    pub(crate) neutral_image: bool,
    /// Opaque surfaces pass through a table that changes nothing: by force.
    pub(crate) neutral_blend: bool,
}
