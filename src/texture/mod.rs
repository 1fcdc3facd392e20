//! Textures: 8-bit texels with their own colours, as in 1994.
//!
//! | item | what |
//! |---|---|
//! | [`Texture`] | texels with power-of-two sides, and up to 256 colours of their own |
//! | [`Texture::from_rgb`] | from a picture of any size: resampled, its colours reduced |
//! | `name.parse::<Texture>()` | the built-in ones: crate, checker, bricks, sky |
//! | [`Mipmap`] | a texture's smaller copies, for distant surfaces |
//! | `mode13h_assets::texture` | from picture files |
//!
//! A texel is shaded by a table that [`Lut64K::shades`](crate::palette::Lut64K::shades) makes from a palette and the
//! texture's colours, so a texture does not depend on any palette.

mod builtin;
mod mipmap;
mod resample;

use alloc::vec;
use alloc::vec::Vec;
use core::fmt;
use core::ops::Index;

use crate::palette::MedianCut;
use crate::palette::{NearestColors, Rgb};
pub use mipmap::Mipmap;

/// The reason why texels or pixels cannot be made into a texture.
#[derive(Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum TextureError {
    /// A side of an indexed texture is not a power of two up to 256.
    Side {
        /// The number of texels in a row.
        width: u32,
        /// The number of rows.
        height: u32,
    },
    /// A side of a picture is 0 or above 4,096.
    Size {
        /// The number of pixels in a row.
        width: u32,
        /// The number of rows.
        height: u32,
    },
    /// The number of texels or pixels is not width times height.
    Count {
        /// The number given.
        given: usize,
        /// The number needed.
        needed: usize,
    },
}

impl fmt::Display for TextureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Side { width, height } => {
                let most = Texture::MAX_SIDE;
                write!(f, "a texture of {width} × {height} texels: each side must be a power of two up to {most}")
            }
            Self::Size { width, height } => {
                let most = Texture::MAX_PICTURE_SIDE;
                write!(f, "a picture of {width} × {height} pixels: each side must be 1 to {most}")
            }
            Self::Count { given, needed } => write!(f, "{given} texels given, {needed} needed"),
        }
    }
}

crate::errors::error_type!(TextureError);

/// A rectangle of texels, each an index into the texture's own colours.
///
/// Width and height are powers of two from 1 to 256, so wrapping is masking: texel (x, y) is at `(y mod height) <<
/// width_bits | (x mod width)`. Row 0 is at v = 0 and v points up, as in OBJ files: row 0 is a picture's *bottom* row.
/// Texel (x, y) covers u from x/width up to (x + 1)/width, v from y/height up to (y + 1)/height.
///
/// ```
/// use mode13h::palette::Rgb;
/// use mode13h::texture::Texture;
/// let (sky, grass) = (Rgb::new(90, 150, 255), Rgb::new(40, 160, 30));
/// let texture = Texture::from_rgb(2, 2, &[sky, sky, grass, grass])?;
/// assert_eq!((texture.width(), texture.height()), (2, 2));
/// assert_eq!((texture[(0, 0)], texture[(0, 1)]), (grass, sky));
/// # Ok::<(), mode13h::texture::TextureError>(())
/// ```
#[derive(Clone, PartialEq, Eq)]
pub struct Texture {
    texels: Vec<u8>,
    colors: [Rgb; 256],
    width_bits: u32,
    height_bits: u32,
}

/// The colour of texel (x, y); beyond the sides the texture repeats.
impl Index<(u32, u32)> for Texture {
    type Output = Rgb;

    fn index(&self, (x, y): (u32, u32)) -> &Rgb {
        let (x, y) = (x & (self.width() - 1), y & (self.height() - 1));
        &self.colors[usize::from(self.texels[(y << self.width_bits | x) as usize])]
    }
}

impl Texture {
    /// The max number of texels in a row, and of rows.
    pub const MAX_SIDE: u32 = 256;

    /// The max number of pixels in a row, and of rows, of a picture made into a texture.
    pub const MAX_PICTURE_SIDE: u32 = 4096;

    /// Makes a texture from texels, row by row from v = 0 up, and their colours.
    ///
    /// # Errors
    /// A side that is not a power of two from 1 to 256; a number of texels other than `width·height`.
    pub fn new(width: u32, height: u32, texels: Vec<u8>, colors: [Rgb; 256]) -> Result<Self, TextureError> {
        let is_side = |side: u32| side.is_power_of_two() && side <= Self::MAX_SIDE;
        if !is_side(width) || !is_side(height) {
            return Err(TextureError::Side { width, height });
        }
        // At most 65,536.
        let (given, needed) = (texels.len(), (width * height) as usize);
        if given != needed {
            return Err(TextureError::Count { given, needed });
        }
        Ok(Self { texels, colors, width_bits: width.ilog2(), height_bits: height.ilog2() })
    }

    /// Makes a texture of a single texel: a surface with it looks as plain as one without a texture.
    #[must_use]
    pub fn plain(color: Rgb) -> Self {
        Self { texels: vec![0], colors: [color; 256], width_bits: 0, height_bits: 0 }
    }

    /// Makes a texture from a picture's pixels, row by row from its top row down.
    ///
    /// Each side is resampled to the power of two up to 256 whose ratio to it is nearest to 1, by
    /// averaging over the area that a texel covers, in exact fractions rounded once. (DAC values
    /// are averaged without gamma, as was usual then.) More than 256 colours are reduced by median
    /// cut, and each pixel gets the nearest remaining one; up to 256 stay unchanged.
    ///
    /// # Errors
    /// A side of 0 or above 4,096; a number of pixels other than `width·height`.
    pub fn from_rgb(width: u32, height: u32, pixels: &[Rgb]) -> Result<Self, TextureError> {
        let is_side = |side: u32| (1..=Self::MAX_PICTURE_SIDE).contains(&side);
        if !is_side(width) || !is_side(height) {
            return Err(TextureError::Size { width, height });
        }
        // At most 2²⁴.
        let (given, needed) = (pixels.len(), (width * height) as usize);
        if given != needed {
            return Err(TextureError::Count { given, needed });
        }
        let (width_bits, height_bits) = (resample::nearest_power_of_two(width), resample::nearest_power_of_two(height));
        // Sides are at most 4,096.
        let mut pixels = resample::by_area(pixels, width as usize, 1 << width_bits, 1 << height_bits);
        // Bottom row first.
        let half = pixels.len() >> (width_bits + 1) << width_bits;
        let (top, bottom) = pixels.split_at_mut(half);
        let rows = top.chunks_exact_mut(1 << width_bits).zip(bottom.rchunks_exact_mut(1 << width_bits));
        rows.for_each(|(row, other)| row.swap_with_slice(other));
        let (texels, colors) = reduced(&pixels, 256);
        Ok(Self { texels, colors, width_bits, height_bits })
    }

    /// Reduces the texture to at most `most` colours, 1 to 256, by median cut.
    #[must_use]
    pub fn with_colors(&self, most: u16) -> Self {
        let pixels: Vec<Rgb> = self.texels.iter().map(|&texel| self.colors[usize::from(texel)]).collect();
        let (texels, colors) = reduced(&pixels, most.clamp(1, 256));
        Self { texels, colors, ..*self }
    }

    /// The texels, row by row from v = 0 up.
    #[must_use]
    #[inline]
    pub fn texels(&self) -> &[u8] {
        &self.texels
    }

    /// The colours of the texels. Unused entries may be anything.
    #[must_use]
    #[inline]
    pub fn colors(&self) -> &[Rgb; 256] {
        &self.colors
    }

    /// The texture's colours on a coloured surface, by [`Rgb::modulate`] with `tint`, an MTL file's `Kd`. White leaves
    /// them unchanged.
    #[must_use]
    pub fn tinted(&self, tint: Rgb) -> [Rgb; 256] {
        self.colors.map(|color| color.modulate(tint))
    }

    /// The texture in its [tinted](Self::tinted) colours.
    #[must_use]
    pub fn modulated(&self, tint: Rgb) -> Self {
        self.recolored(self.tinted(tint))
    }

    /// The texture with other colours for its texels.
    #[must_use]
    pub fn recolored(&self, colors: [Rgb; 256]) -> Self {
        Self { texels: self.texels.clone(), colors, ..*self }
    }

    /// The binary logarithm of the width: 0 to 8.
    #[must_use]
    #[inline]
    pub fn width_bits(&self) -> u32 {
        self.width_bits
    }

    /// The binary logarithm of the height: 0 to 8.
    #[must_use]
    #[inline]
    pub fn height_bits(&self) -> u32 {
        self.height_bits
    }

    /// The number of texels in a row: a power of two up to 256.
    #[must_use]
    #[inline]
    pub fn width(&self) -> u32 {
        1 << self.width_bits
    }

    /// The number of rows: a power of two up to 256.
    #[must_use]
    #[inline]
    pub fn height(&self) -> u32 {
        1 << self.height_bits
    }

    /// Counts the texels of each colour.
    #[must_use]
    pub fn histogram(&self) -> [u32; 256] {
        let mut histogram = [0; 256];
        for &texel in &self.texels {
            histogram[usize::from(texel)] += 1;
        }
        histogram
    }
}

impl fmt::Debug for Texture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (width, height) = (self.width(), self.height());
        f.debug_struct("Texture").field("width", &width).field("height", &height).finish_non_exhaustive()
    }
}

/// Reduces the pixels to at most `most` colours, darkest first. Returns the index of the nearest colour for each pixel,
/// and the colours.
fn reduced(pixels: &[Rgb], most: u16) -> (Vec<u8>, [Rgb; 256]) {
    let mut sorted: Vec<u32> = pixels.iter().map(|pixel| pixel.to_u32()).collect();
    sorted.sort_unstable();
    // At most 65,536 pixels.
    let counted = sorted.chunk_by(|a, b| a == b).map(|same| (Rgb::from_u32(same[0]), same.len() as u32)).collect();
    let mut cut = MedianCut::new(counted);
    cut.cut_to(usize::from(most));
    let key = |color: Rgb| u64::from(color.brightness()) << 32 | u64::from(color.to_u32());
    let mut keys: Vec<u64> = cut.means().map(key).collect();
    keys.sort_unstable();
    // The lower half.
    let means: Vec<Rgb> = keys.into_iter().map(|key| Rgb::from_u32(key as u32)).collect();
    let search = NearestColors::new(&means);
    let texels = pixels.iter().map(|&pixel| search.nearest(pixel)).collect();
    let mut colors = [Rgb::BLACK; 256];
    colors.iter_mut().zip(means).for_each(|(color, mean)| *color = mean);
    (texels, colors)
}
