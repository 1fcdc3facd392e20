//! Vertices of the raster: projected ones inside the guard band.

use core::fmt;

use crate::fixed::{I24F8, U8F8};

/// A projected vertex: position in 1/256 pixel, shade, depth. One that exists is legal, so the
/// raster itself has nothing to refuse.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct Vertex {
    x: i32,
    y: i32,
    shade: u16,
    depth: u32,
}

/// Error of a vertex that was refused.
#[derive(Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum VertexError {
    /// A coordinate lies outside the guard band of ±4,096 pixels.
    OutsideGuardBand {
        /// The vertex's x.
        x: I24F8,
        /// The vertex's y.
        y: I24F8,
    },
    /// The shade is above 255.0, where the rounding to the nearest byte would wrap.
    ShadeAbove255 {
        /// The shade.
        shade: U8F8,
    },
}

impl fmt::Display for VertexError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutsideGuardBand { x, y } => write!(
                f,
                "vertex at ({}, {}) / 256 pixels lies outside the guard band of 4,096 pixels",
                x.to_bits(),
                y.to_bits()
            ),
            Self::ShadeAbove255 { shade } => {
                write!(f, "vertex shade {:#06x} is above 0xff00 (255.0)", shade.to_bits())
            }
        }
    }
}

crate::errors::debug_as_display!(VertexError);

impl core::error::Error for VertexError {}

impl Vertex {
    /// The guard band: |x| and |y| at most 2²⁰ units of 1/256 pixel, 4,096 pixels.
    ///
    /// With it twice a triangle's area is at most 2⁴² and a shade's numerator at most 2⁵⁸: all of
    /// the raster's arithmetic fits in i64.
    pub const GUARD_BAND: i32 = 1 << 20;

    /// A vertex at (`x`, `y`), x to the right and y down, with its shade and its depth
    /// (greater is nearer; `round(2³⁰·near / w)` in the engine, any u32 here).
    ///
    /// # Errors
    /// A coordinate outside the guard band, or a shade above 255.0.
    #[inline]
    pub const fn new(x: I24F8, y: I24F8, shade: U8F8, depth: u32) -> Result<Self, VertexError> {
        let (h, v) = (x.to_bits(), y.to_bits());
        if h < -Self::GUARD_BAND || h > Self::GUARD_BAND || v < -Self::GUARD_BAND || v > Self::GUARD_BAND {
            return Err(VertexError::OutsideGuardBand { x, y });
        }
        if shade.to_bits() > U8F8::MAX_VERTEX.to_bits() {
            return Err(VertexError::ShadeAbove255 { shade });
        }
        Ok(Self { x: h, y: v, shade: shade.to_bits(), depth })
    }

    /// A vertex that has been one before, or is legal by the way it was made.
    #[inline]
    pub(crate) fn of_projected(x: I24F8, y: I24F8, shade: U8F8, depth: u32) -> Self {
        debug_assert!(Self::new(x, y, shade, depth).is_ok(), "({x:?}, {y:?}), {shade:?}");
        Self { x: x.to_bits(), y: y.to_bits(), shade: shade.to_bits(), depth }
    }

    /// Gives the vertex another shade; one above 255.0 counts as 255.0.
    #[must_use]
    #[inline]
    #[doc(hidden)]
    pub const fn with_shade(self, shade: U8F8) -> Self {
        let (bits, most) = (shade.to_bits(), U8F8::MAX_VERTEX.to_bits());
        Self { shade: if bits > most { most } else { bits }, ..self }
    }

    /// x, to the right.
    #[must_use]
    #[inline]
    pub const fn x(&self) -> I24F8 {
        I24F8::from_bits(self.x)
    }

    /// y, down.
    #[must_use]
    #[inline]
    pub const fn y(&self) -> I24F8 {
        I24F8::from_bits(self.y)
    }

    /// The shade, at most 255.0.
    #[must_use]
    #[inline]
    pub const fn shade(&self) -> U8F8 {
        U8F8::from_bits(self.shade)
    }

    /// The depth; greater is nearer.
    #[must_use]
    #[inline]
    pub const fn depth(&self) -> u32 {
        self.depth
    }
}
