//! What becomes of a triangle that has a pixel centre in its box, by its size and place.

use super::triangles::{Batch, LANES};

/// What the stages behind make of a triangle that has a pixel centre in its box.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum SizeClass {
    /// Lies inside the clip rectangle, and is small enough for a span of each row.
    Small,
    /// Lies inside the clip rectangle. Its rows are of up to 1,024 pixels.
    Large,
    /// Reaches over the clip rectangle's edge, and is no larger than `Large` allows.
    CrossesClip,
    /// Too large for set-up in f64.
    Unbatched,
}

/// Index of a triangle in its batch (bits 0 to 7), and its class (from bit 8 on).
#[derive(Clone, Copy, Debug)]
pub(super) struct ClassedIndex(pub(super) u32);

impl ClassedIndex {
    pub(super) const SMALL: i32 = 0;
    pub(super) const LARGE: i32 = 1;
    pub(super) const CROSSES_CLIP: i32 = 2;
    pub(super) const UNBATCHED: i32 = 4;

    /// Below `Batch::CAPACITY`.
    #[inline(always)]
    pub(super) fn index(self) -> usize {
        self.0 as usize % Batch::CAPACITY
    }

    #[inline(always)]
    pub(super) fn class(self) -> SizeClass {
        match (self.0 >> 8).cast_signed() {
            Self::SMALL => SizeClass::Small,
            Self::LARGE => SizeClass::Large,
            Self::CROSSES_CLIP => SizeClass::CrossesClip,
            _ => SizeClass::Unbatched,
        }
    }

    /// Counts those, from the first on, that are not unbatched.
    #[inline(always)]
    pub(super) fn count_batched(kept: &[u32]) -> usize {
        let is_unbatched = |chosen: &u32| chosen >> 8 & Self::UNBATCHED as u32;
        // Mostly all, so eight at a time.
        let none = |eight: &&[u32; LANES]| eight.iter().fold(0, |any, chosen| any | is_unbatched(chosen)) == 0;
        let first = kept.as_chunks::<LANES>().0.iter().take_while(none).count() * LANES;
        first + kept[first..].iter().take_while(|chosen| is_unbatched(chosen) == 0).count()
    }

    /// Returns whether all of these are small.
    #[inline(always)]
    pub(super) fn are_small(kept: &[u32]) -> bool {
        kept.iter().fold(0, |any, chosen| any | chosen) >> 8 == 0
    }
}
