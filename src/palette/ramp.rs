//! Shade ramps: consecutive palette entries from dark to light.

use core::ops::RangeInclusive;

/// A range of palette entries that hold one colour from dark to light.
///
/// A material names a ramp; a shade is an index into it, 0 to `entries − 1`, and can never reach an entry of a
/// neighbouring ramp.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Ramp {
    first: u8,
    // 1 to 256, and first + entries is at most 256.
    entries: u16,
}

impl Ramp {
    /// All 256 entries.
    pub const WHOLE: Self = Self { first: 0, entries: 256 };

    /// The ramp of `entries` entries starting at `first`.
    ///
    /// Returns `None` if it has no entry or would extend beyond entry 255.
    #[must_use]
    #[inline]
    pub const fn new(first: u8, entries: u16) -> Option<Self> {
        // In u32: a u16 sum could wrap.
        if entries == 0 || first as u32 + entries as u32 > 256 {
            return None;
        }
        Some(Self { first, entries })
    }

    /// A ramp of one entry, which every shade maps to.
    #[must_use]
    #[inline]
    pub const fn single(entry: u8) -> Self {
        Self { first: entry, entries: 1 }
    }

    /// The palette index of the darkest entry.
    #[must_use]
    #[inline]
    pub const fn first(self) -> u8 {
        self.first
    }

    /// The palette index of the lightest entry.
    #[must_use]
    #[inline]
    pub const fn last(self) -> u8 {
        // At most 255, as `first + entries` is at most 256.
        (self.first as u16 + self.entries - 1) as u8
    }

    /// The number of entries, 1 to 256.
    #[must_use]
    #[inline]
    pub const fn entries(self) -> u16 {
        self.entries
    }

    /// The palette index of a shade. A shade above `entries − 1` counts as `entries − 1`.
    ///
    /// ```
    /// use mode13h::palette::Ramp;
    /// let ramp = Ramp::new(64, 64).unwrap();
    /// assert_eq!((ramp.index(0), ramp.index(63), ramp.index(64)), (64, 127, 127));
    /// ```
    #[must_use]
    #[inline]
    pub const fn index(self, shade: u16) -> u8 {
        if shade < self.entries { (self.first as u16 + shade) as u8 } else { self.last() }
    }

    /// Returns whether a palette index belongs to the ramp.
    #[must_use]
    #[inline]
    pub const fn contains(self, index: u8) -> bool {
        self.first <= index && index <= self.last()
    }

    /// The palette indices, first to last, in the form that [`Vga::cycle`](crate::vga::Vga::cycle) takes.
    #[must_use]
    #[inline]
    pub const fn range(self) -> RangeInclusive<u8> {
        self.first..=self.last()
    }
}
