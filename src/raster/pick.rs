//! Triangles to be drawn, each packed into one number, and the limits on their sizes.

use super::reference::shade::RESEED;
use crate::lanes::LANES;

/// Triangles culled at a time.
pub(crate) const CHUNK: usize = 64;
/// The greatest width of a small triangle, in pixels: a span of that length has a single start.
pub(super) const MAX_COLUMNS: i32 = 64;
/// The greatest height of a small triangle, in rows.
pub(super) const MAX_ROWS: i32 = 16;
/// The greatest width of a large triangle's box, in 1/256 pixel.
pub(super) const MAX_WIDTH: i32 = 1_024 * 256;
/// The maximum number of reseeded pieces of a row.
pub(super) const MAX_PIECES: usize = MAX_WIDTH as usize / 256 / RESEED as usize;
/// The greatest height of such a box.
pub(super) const MAX_HEIGHT: i32 = 4_096 * 256;
/// The maximum number of squares of 4 × 4 pixels in the box, sides rounded up: 2³⁴ units.
pub(super) const MAX_AREA_4X4: i32 = 1 << 14;

/// The class of a triangle, by its size and position.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum SizeClass {
    /// Lies inside the clip rectangle, and is small enough for one span per row.
    Small,
    /// Lies inside the clip rectangle, with rows of up to 1,024 pixels.
    Large,
    /// Crosses the clip rectangle's edge, and is no larger than `Large` allows.
    CrossesClip,
    /// Too large for set-up in f64.
    Unbatched,
}

/// A triangle to be drawn: its index, its visible side, and its class for one clip rectangle.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[repr(transparent)]
pub(crate) struct Pick(pub(crate) u32);

impl Pick {
    /// The maximum number of triangles in a list.
    #[cfg(feature = "alloc")]
    pub(crate) const MAX_COUNT: usize = 1 << 28;

    const INDEX: u32 = (1 << 28) - 1;
    pub(super) const LARGE: u32 = 1 << 28;
    pub(super) const CROSSES_CLIP: u32 = 2 << 28;
    pub(super) const UNBATCHED: u32 = 4 << 28;
    /// The back is visible.
    pub(super) const BACK: u32 = 1 << 31;

    /// The index of the triangle.
    #[inline(always)]
    pub(crate) const fn index(self) -> usize {
        (self.0 & Self::INDEX) as usize
    }

    /// The pick of another triangle of the same class.
    #[inline(always)]
    pub(super) const fn with_index(self, index: usize) -> Self {
        // Below `MAX_COUNT`.
        Self(self.0 & !Self::INDEX | index as u32)
    }

    /// The pick of another triangle at the same place, seen from the front.
    #[cfg(feature = "alloc")]
    #[inline(always)]
    pub(crate) const fn with_front(self, index: usize) -> Self {
        Self(self.with_index(index).0 & !Self::BACK)
    }

    /// The visible side: 0 for the front, 1 for the back.
    #[inline(always)]
    pub(crate) const fn side(self) -> usize {
        (self.0 >> 31) as usize
    }

    /// The class.
    #[inline(always)]
    pub(crate) const fn class(self) -> SizeClass {
        match self.0 & Self::CLASS {
            0 => SizeClass::Small,
            Self::LARGE => SizeClass::Large,
            Self::CROSSES_CLIP => SizeClass::CrossesClip,
            _ => SizeClass::Unbatched,
        }
    }

    const CLASS: u32 = Self::LARGE | Self::CROSSES_CLIP | Self::UNBATCHED;

    /// Counts the leading picks that are not unbatched.
    #[inline(always)]
    pub(super) fn count_batched(picks: &[u32]) -> usize {
        // Usually all, so eight at a time.
        let none = |eight: &&[u32; LANES]| eight.iter().fold(0, |any, pick| any | pick) & Self::UNBATCHED == 0;
        let first = picks.as_chunks::<LANES>().0.iter().take_while(none).count() * LANES;
        first + picks[first..].iter().take_while(|pick| **pick & Self::UNBATCHED == 0).count()
    }

    /// Returns whether all of these are small.
    #[inline(always)]
    pub(super) fn are_small(picks: &[u32]) -> bool {
        picks.iter().fold(0, |any, pick| any | pick) & Self::CLASS == 0
    }
}
