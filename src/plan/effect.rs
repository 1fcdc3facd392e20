//! The effects.

use crate::names::named;

named! {
    /// A decision that the plan makes for every object.
    pub enum Effect, "effect" {
        /// Transforms and projects the object's vertices; otherwise the last frame's are reused, or the object is out
        /// of sight and needs none.
        Transform = "transform",
        /// Tests every vertex against the near plane; otherwise no vertex is tested.
        NearClipping = "near-clipping",
        /// The raster clips rows at the frame's edges; otherwise rows are drawn unclipped.
        ScreenClipping = "screen-clipping",
        /// Skips back faces; otherwise both sides are drawn.
        BackFaceCulling = "back-face-culling",
        /// Removes hidden surfaces by some method beyond back-face culling.
        HiddenSurfaces = "hidden-surfaces",
        /// Vertices are lit; otherwise the shade is constant, and normals are not read.
        Lighting = "lighting",
        /// Lamps and spot lights in range: a distance, a direction and a fall-off for every vertex; otherwise only
        /// suns.
        PositionalLights = "positional-lights",
        /// Specular highlights: a power for every vertex and light.
        Specular = "specular",
        /// Shades vary across faces; otherwise each face is a plain fill.
        Gouraud = "gouraud",
        /// Distant surfaces fade, through a lookup table.
        Fog = "fog",
        /// Per-pixel lighting.
        Phong = "phong",
        /// Faces are split along their edges.
        Tessellation = "tessellation",
        /// Texture coordinates follow the perspective; otherwise they are linear on the screen.
        Perspective = "perspective",
        /// Red, green and blue are lit separately.
        RgbChannels = "rgb-channels",
        /// An image on the surface.
        Texture = "texture",
        /// An image of the surroundings, reflected by the surface.
        EnvironmentMap = "environment-map",
        /// Distant textures are drawn from smaller copies; otherwise level 0 is used everywhere.
        Mipmaps = "mipmaps",
        /// Surfaces behind show through, blended by a lookup table.
        Transparency = "transparency",
        /// Shades between two entries become a pattern of both.
        Dither = "dither",
        /// The DAC is reloaded over time, without drawing anything.
        PaletteAnimation = "palette-animation",
    }
}

impl Effect {
    /// Returns whether the effect ensures that the raster can draw the triangles. If so, it cannot be switched off
    /// where it is called for.
    pub(super) const fn keeps_inside(self) -> bool {
        matches!(self, Self::NearClipping | Self::ScreenClipping)
    }

    /// The number of effects.
    pub const COUNT: usize = Self::ALL.len();

    /// Returns whether this build leaves the effect out: it is then off whatever a scene calls for,
    /// and the compiler drops its stages. Such builds prove that a disabled effect costs nothing
    /// (`.ci/off_is_free`); no feature of this crate enables them.
    #[inline]
    pub(crate) const fn is_left_out(self) -> bool {
        match self {
            Self::Transform => cfg!(mode13h_leave_out = "transform"),
            Self::NearClipping => cfg!(mode13h_leave_out = "near-clipping"),
            Self::ScreenClipping => cfg!(mode13h_leave_out = "screen-clipping"),
            Self::BackFaceCulling => cfg!(mode13h_leave_out = "back-face-culling"),
            Self::HiddenSurfaces => cfg!(mode13h_leave_out = "hidden-surfaces"),
            Self::Lighting => cfg!(mode13h_leave_out = "lighting"),
            Self::PositionalLights => cfg!(mode13h_leave_out = "positional-lights"),
            Self::Specular => cfg!(mode13h_leave_out = "specular"),
            Self::Gouraud => cfg!(mode13h_leave_out = "gouraud"),
            Self::Fog => cfg!(mode13h_leave_out = "fog"),
            Self::Phong => cfg!(mode13h_leave_out = "phong"),
            Self::Tessellation => cfg!(mode13h_leave_out = "tessellation"),
            Self::Perspective => cfg!(mode13h_leave_out = "perspective"),
            Self::RgbChannels => cfg!(mode13h_leave_out = "rgb-channels"),
            Self::Texture => cfg!(mode13h_leave_out = "texture"),
            Self::EnvironmentMap => cfg!(mode13h_leave_out = "environment-map"),
            Self::Mipmaps => cfg!(mode13h_leave_out = "mipmaps"),
            Self::Transparency => cfg!(mode13h_leave_out = "transparency"),
            Self::Dither => cfg!(mode13h_leave_out = "dither"),
            Self::PaletteAnimation => cfg!(mode13h_leave_out = "palette-animation"),
        }
    }
}
