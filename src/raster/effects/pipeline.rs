//! The pixel pipeline of a triangle: the source of its shades, and the stages they pass through.

use crate::fixed::U8F8;
use crate::lanes::{Lanes, Points};
use crate::mapping::Mapping;
use crate::palette::Lut64K;
use crate::raster::interpolation::Interpolation;
use crate::span::dither::Thresholds;
use crate::span::texture::{Levels, Texels};
use crate::texture::Texture;

/// Per-pixel lighting.
pub trait PixelLighting: core::fmt::Debug {
    /// The shade in 8.8, 0 to 0xFF00, at each point (normal and position, perspective-correct, the normal of any
    /// length). Points beyond the end of a row may be anything; their results are not used.
    fn shades(&self, points: &Points) -> Lanes<u16>;

    /// Red, green and blue at each point, under the conditions of [`shades`](Self::shades).
    fn channels(&self, points: &Points) -> [Lanes<u16>; 3];
}

/// The source of a pixel's shade.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum ShadeSource<'a> {
    /// The corners' shades, or each of their channels, interpolated by this shading.
    ///
    /// [`GouraudVintage`](Interpolation::GouraudVintage) contributes only the shades; coverage stays exact, because the
    /// values of all stages are in range only inside the triangle.
    Shaded(Interpolation),
    /// [`Attributes::slope`](super::Attributes::slope), linear on the screen: column and row of the shade in the
    /// table. With channels the table is ignored, and the corners' channels are interpolated.
    NormalTable(&'a [u8; 65_536]),
    /// [`Attributes::lit`](super::Attributes::lit), linear on the face, lit at every pixel.
    Lit(&'a dyn PixelLighting),
    /// [`Attributes::lit`](super::Attributes::lit), linear on the face, lit at some pixels of a
    /// row; shades are linear in between.
    ///
    /// The lit pixels are the row's first inside the frame, its last, and those at equal distances
    /// in between.
    LitEvery(SampleSpacing, &'a dyn PixelLighting),
    /// Quadratic on the screen, through the six shades of [`Attributes::lit`](super::Attributes::lit): at the corners
    /// and at the midpoints of the edges. Shades are clamped to these limits, one pair for each channel; a single shade
    /// uses the first.
    Curved([Limits; 3]),
}

/// The minimum and maximum of a shade.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Limits {
    /// The least.
    pub least: U8F8,
    /// The greatest; if it is below the least, the greatest applies.
    pub most: U8F8,
}

/// The distance between two lit pixels of a row.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum SampleSpacing {
    /// 4 pixels.
    Four,
    /// 8 pixels.
    Eight,
    /// 16 pixels.
    Sixteen,
}

impl SampleSpacing {
    /// All spacings, the closest first.
    pub const ALL: [Self; 3] = [Self::Four, Self::Eight, Self::Sixteen];

    /// The distance in pixels.
    #[must_use]
    pub const fn pixels(self) -> usize {
        match self {
            Self::Four => 4,
            Self::Eight => 8,
            Self::Sixteen => 16,
        }
    }
}

/// How red, green and blue become a palette index.
#[derive(Clone, Copy, Debug)]
pub enum Mix<'a> {
    /// The 6 × 6 × 6 colours of [`palette::cube`](crate::palette::cube).
    Cube,
    /// The palette entry given by a table of 32 × 32 × 32.
    Nearest {
        /// Indices by red, green and blue, five bits each.
        map: &'a [u8; 32_768],
        /// The range over which dither moves a channel, from end to end.
        spread: u8,
    },
    /// No mixing: one channel's shades as they are, 0 red, 1 green, 2 blue, for measurements.
    Only(usize),
}

/// An image on a triangle.
#[derive(Clone, Copy, Debug)]
pub struct TextureStage<'a> {
    /// The image.
    pub texels: Texels<'a>,
    /// Its smaller copies, one of which is used where a pixel spans more than √2 texels; `None` to use the image alone.
    pub levels: Option<Levels<'a>>,
    /// How its coordinates are interpolated.
    pub mapping: Mapping,
    /// The byte for a shade (row) and a texel (column); with channels, one table each.
    pub tables: [&'a [u8; 65_536]; 3],
}

impl<'a> TextureStage<'a> {
    /// The texture without smaller copies, shaded by a table that [`Lut64K::shades`] made from its colours.
    #[must_use]
    pub fn new(texture: &'a Texture, shades: &'a Lut64K, mapping: Mapping) -> Self {
        // Every texture has legal sides.
        let texels = Texels::new(texture.texels(), texture.width_bits(), texture.height_bits()).unwrap_or(Texels::ONE);
        Self { texels, levels: None, mapping, tables: [shades.as_array(); 3] }
    }
}

/// An image, with its levels if one of them is to be chosen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Image<'a> {
    pub(super) texels: Texels<'a>,
    pub(super) levels: Option<Levels<'a>>,
}

impl<'a> Image<'a> {
    pub(super) fn new(stage: &TextureStage<'a>) -> Self {
        // A build that leaves out mipmaps (`plan::Effect::is_left_out`) has none.
        Self { texels: stage.texels, levels: stage.levels.filter(|_| !cfg!(mode13h_leave_out = "mipmaps")) }
    }

    /// The index of the last level.
    pub(super) fn last(self) -> u32 {
        self.levels.map_or(0, Levels::last)
    }

    /// The texels of every level; entries beyond the last are not used.
    #[inline]
    pub(super) fn all(self) -> [Texels<'a>; LEVELS] {
        let mut all = [self.texels; LEVELS];
        if let Some(levels) = self.levels {
            for (level, texels) in all[1..].iter_mut().zip(levels.iter()) {
                *level = texels;
            }
        }
        all
    }
}

/// An upper bound on an image's levels, level 0 included; a power of two, so that a mask keeps indices in range.
pub(super) const LEVELS: usize = 16;
const _: () = assert!((Texels::MAX_BITS as usize) < LEVELS);

/// The stages that the pixels of a triangle pass through: shade, texture, fog, blend.
///
/// Tables have 256 rows of 256 palette indices, row by row. [`Lut64K`] makes each kind, and its
/// [`as_array`](Lut64K::as_array) returns the bytes.
#[derive(Clone, Copy, Debug)]
pub struct PixelPipeline<'a> {
    /// The source of the shades.
    pub source: ShadeSource<'a>,
    /// Red, green and blue instead of one shade, and how they are mixed.
    pub channels: Option<Mix<'a>>,
    /// Dither: thresholds of a [`DitherPattern`](crate::settings::DitherPattern) in place of the half that is added to
    /// each shade.
    pub dither: Option<Thresholds>,
    /// An image.
    pub texture: Option<TextureStage<'a>>,
    /// Fog: the index for a level of fog (row) and the index without fog (column), made by [`Lut64K::fog`].
    pub fog: Option<&'a [u8; 65_536]>,
    /// Glass: the index for the triangle's own (row) and the one in the frame (column), made by [`Lut64K::blend`] or
    /// [`Lut64K::add`].
    pub blend: Option<&'a [u8; 65_536]>,
    /// True if the depth buffer keeps the triangle's depth, so that it hides what is drawn behind it later. Glass does
    /// not.
    pub keeps_depth: bool,
}

// The stages. A stage that a build leaves out (`plan::Effect::is_left_out`) is `None`, which the compiler knows.
impl<'a> PixelPipeline<'a> {
    /// The shade source; never per-pixel lighting in a build that leaves that out.
    #[inline]
    pub(super) fn source(&self) -> ShadeSource<'a> {
        match self.source {
            ShadeSource::Lit(_) | ShadeSource::LitEvery(..) | ShadeSource::Curved(_)
                if cfg!(mode13h_leave_out = "phong") =>
            {
                ShadeSource::Shaded(Interpolation::Gouraud88Reseeded)
            }
            source => source,
        }
    }

    #[inline]
    pub(super) fn channels(&self) -> Option<Mix<'a>> {
        self.channels.filter(|_| !cfg!(mode13h_leave_out = "rgb-channels"))
    }

    #[inline]
    pub(super) fn dither(&self) -> Option<Thresholds> {
        self.dither.filter(|_| !cfg!(mode13h_leave_out = "dither"))
    }

    #[inline]
    pub(super) fn texture(&self) -> Option<&TextureStage<'a>> {
        self.texture
            .as_ref()
            .filter(|_| !cfg!(all(mode13h_leave_out = "texture", mode13h_leave_out = "environment-map")))
    }

    /// The levels of its image.
    #[inline]
    pub(super) fn levels(&self) -> Option<Levels<'a>> {
        self.texture()?.levels.filter(|_| !cfg!(mode13h_leave_out = "mipmaps"))
    }

    #[inline]
    pub(super) fn fog(&self) -> Option<&'a [u8; 65_536]> {
        self.fog.filter(|_| !cfg!(mode13h_leave_out = "fog"))
    }

    #[inline]
    pub(super) fn blend(&self) -> Option<&'a [u8; 65_536]> {
        self.blend.filter(|_| !cfg!(mode13h_leave_out = "transparency"))
    }
}

impl PixelPipeline<'_> {
    /// Linear shades and nothing else.
    pub const PLAIN: Self = Self {
        source: ShadeSource::Shaded(Interpolation::Gouraud88Reseeded),
        channels: None,
        dither: None,
        texture: None,
        fog: None,
        blend: None,
        keeps_depth: true,
    };
}
