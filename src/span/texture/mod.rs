//! Rows of texels: a texture's bytes along a row of the screen.
//!
//! ```text
//! row[k] = texels[(v_k >> 16 & vmask) << ubits | (u_k >> 16 & umask)]
//! ```
//!
//! u and v are 16.16 texel coordinates, u along the texture's rows. A texture is a power of two wide and
//! high, so a mask wraps it, and its last texel meets its first.
//!
//! | loop | u and v |
//! |---|---|
//! | [`fill_affine`] | change by the same amount from each pixel to the next |
//! | `fill_perspective` | the floor of a quotient at every pixel: exact |

#[cfg(feature = "alloc")]
mod along;
#[cfg(feature = "alloc")]
mod perspective;
#[cfg(feature = "alloc")]
mod tint;

use core::fmt;

#[cfg(feature = "alloc")]
pub(crate) use self::along::{
    AffineAlong, FOUR, FirstOffset, LevelTexels, OffsetLanes, OffsetsAlong, StoredAlong, StoredOffsets, affine_pair,
    show_along, show_block, show_masked, show_pair,
};
#[cfg(feature = "internals")]
pub use self::perspective::fill_perspective;
#[cfg(feature = "alloc")]
pub(crate) use self::perspective::{PerspectiveSums, perspective_along, singles_along, singles_margin, singles_pair};
#[cfg(feature = "alloc")]
pub(crate) use self::tint::{Blended, Fogged, FoggedShades, Painted, PairValues, SpanValues, Tint};

/// A texture's bytes, row by row, with its size.
#[derive(Clone, Copy, Debug)]
pub struct Texels<'a> {
    /// 2^(ubits + vbits), so at least one and at most 65,536.
    bytes: &'a [u8],
    ubits: u32,
    vbits: u32,
}

impl<'a> Texels<'a> {
    /// The maximum number of bits of u or v: 256 texels.
    pub const MAX_BITS: u32 = 8;

    /// A single texel.
    #[cfg(feature = "alloc")]
    pub(crate) const ONE: Self = Self { bytes: &[0], ubits: 0, vbits: 0 };

    /// A texture 2^`ubits` wide and 2^`vbits` high, row-major.
    ///
    /// # Errors
    /// [`TexelsError`] if it is wider or higher than 256, or if `bytes` has another length.
    ///
    /// ```
    /// use mode13h::raster::effects::{Texels, TexelsError};
    ///
    /// assert!(Texels::new(&[0; 64], 4, 2).is_ok()); // 16 × 4
    /// assert_eq!(Texels::new(&[0; 60], 4, 2).unwrap_err(), TexelsError::Length { is: 60, should: 64 });
    /// ```
    pub const fn new(bytes: &'a [u8], ubits: u32, vbits: u32) -> Result<Self, TexelsError> {
        if ubits > Self::MAX_BITS || vbits > Self::MAX_BITS {
            return Err(TexelsError::Bits { ubits, vbits });
        }
        let should = 1 << (ubits + vbits);
        if bytes.len() != should {
            return Err(TexelsError::Length { is: bytes.len(), should });
        }
        Ok(Self { bytes, ubits, vbits })
    }

    /// The number of texels in a row, 1 to 256.
    #[must_use]
    pub const fn width(self) -> usize {
        1 << self.ubits
    }

    /// The number of rows, 1 to 256.
    #[must_use]
    pub const fn height(self) -> usize {
        1 << self.vbits
    }

    /// The texel at (`u`, `v`), both 16.16; wraps.
    #[must_use]
    #[inline]
    pub fn at(self, u: u32, v: u32) -> u8 {
        self.bytes[self.offset(u, v)]
    }

    /// The offset of the texel, below the length. If the compiler knows that the bytes are not empty, it sees this bound
    /// from the last mask, and omits the bounds check (with everything in usize; with a u32 it does not).
    #[inline]
    pub(crate) fn offset(self, u: u32, v: u32) -> usize {
        let last = self.bytes.len() - 1;
        let columns = (1 << self.ubits) - 1;
        // The masks clear whatever a narrow usize cuts off.
        let column = (u >> 16) as usize & columns;
        // Shifted once, rather than down and up again.
        let row = (v >> (16 - self.ubits)) as usize & (last & !columns);
        (row | column) & last
    }
}

/// The smaller copies of a texture: the levels of a mipmap from 1 on. Each has half the columns and half the rows of
/// the level before it, but at least one of each; the last is a single texel. Level 0 is the texture itself.
#[derive(Clone, Copy, Debug)]
pub struct Levels<'a> {
    /// The bytes of one level after another.
    bytes: &'a [u8],
    ubits: u32,
    vbits: u32,
}

impl<'a> Levels<'a> {
    /// The smaller copies of a texture 2^`ubits` wide and 2^`vbits` high: level 1 row by row, then level 2, and so on.
    ///
    /// # Errors
    /// [`TexelsError`] if the texture is wider or higher than 256, or if `bytes` does not have [`length`](Self::length)
    /// bytes.
    pub const fn new(bytes: &'a [u8], ubits: u32, vbits: u32) -> Result<Self, TexelsError> {
        if ubits > Texels::MAX_BITS || vbits > Texels::MAX_BITS {
            return Err(TexelsError::Bits { ubits, vbits });
        }
        let should = Self::length(ubits, vbits);
        if bytes.len() != should {
            return Err(TexelsError::Length { is: bytes.len(), should });
        }
        Ok(Self { bytes, ubits, vbits })
    }

    /// The index of the last level: 0 for a texture of one texel, at most 8.
    #[must_use]
    pub const fn deepest(ubits: u32, vbits: u32) -> u32 {
        if ubits > vbits { ubits } else { vbits }
    }

    /// The number of texels of all levels from 1 on: for a square texture a third of its own, rounded down. More bits
    /// than [`Texels::MAX_BITS`] count as [`Texels::MAX_BITS`].
    #[must_use]
    pub const fn length(ubits: u32, vbits: u32) -> usize {
        let most = Texels::MAX_BITS;
        let (ubits, vbits) = (if ubits < most { ubits } else { most }, if vbits < most { vbits } else { most });
        let (mut length, mut level) = (0, 1);
        while level <= Self::deepest(ubits, vbits) {
            length += 1 << (ubits.saturating_sub(level) + vbits.saturating_sub(level));
            level += 1;
        }
        length
    }

    /// The index of the last level.
    #[must_use]
    pub const fn last(self) -> u32 {
        Self::deepest(self.ubits, self.vbits)
    }

    /// The texels of a level from 1 to the last. For a higher level it returns the last one, for level 0, and if the image
    /// has no levels, `None`.
    #[must_use]
    pub fn get(self, level: u32) -> Option<Texels<'a>> {
        // At most 7.
        self.iter().nth(level.min(self.last()).checked_sub(1)? as usize)
    }

    /// The texels of all levels from 1 on.
    pub(crate) fn iter(self) -> impl Iterator<Item = Texels<'a>> {
        let mut rest = self.bytes;
        (1..=self.last()).map_while(move |level| {
            let (ubits, vbits) = (self.ubits.saturating_sub(level), self.vbits.saturating_sub(level));
            let (bytes, behind) = rest.split_at_checked(1 << (ubits + vbits))?;
            rest = behind;
            Some(Texels { bytes, ubits, vbits })
        })
    }
}

/// Bytes that are not a texture.
#[derive(Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum TexelsError {
    /// The texture is wider or higher than 256 texels.
    Bits {
        /// The logarithm of the width, as given.
        ubits: u32,
        /// The logarithm of the height, as given.
        vbits: u32,
    },
    /// The bytes are too few or too many.
    Length {
        /// The number of bytes given.
        is: usize,
        /// The number of texels of the texture.
        should: usize,
    },
}

impl fmt::Display for TexelsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bits { ubits, vbits } => {
                write!(f, "a texture of 2^{ubits} × 2^{vbits} texels; at most 256 × 256 are possible")
            }
            Self::Length { is, should } => write!(f, "a texture of {should} texels with {is} bytes"),
        }
    }
}

crate::errors::error_type!(TexelsError);

/// Fills `row` with the texels along a straight line through the texture.
///
/// `u` and `v` are the first pixel's coordinates, `du` and `dv` the change per pixel; the sums wrap, so a negative
/// number is given in two's complement (`as u32`).
///
/// At 64 pixels this takes 45 ns. Two faster versions are not used: `pext` (BMI2), 37 ns, is said to be slow on the
/// first two generations of Zen; eight gathered loads per iteration (AVX2), 26 ns, are said to be much slower on
/// processors patched against gather data sampling.
pub fn fill_affine(row: &mut [u8], texels: Texels<'_>, mut u: u32, mut v: u32, du: u32, dv: u32) {
    for pixel in row {
        *pixel = texels.at(u, v);
        u = u.wrapping_add(du);
        v = v.wrapping_add(dv);
    }
}
