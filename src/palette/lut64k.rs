//! Lookup tables of 64 KiB, from two bytes to a third, for the pixel effects.
//!
//! A row holds 256 bytes; `high` selects the row, `low` the column, and the byte is at `high << 8 | low`. Every colour
//! in a table made from a palette is the nearest entry to an exact mixture rounded once, by the colours that the card
//! shows ([`Palette::on_dac`]), so it is nearest on the screen; the first of equally near entries is used, except where a
//! function says that a byte stays as it is.

use alloc::boxed::Box;
use core::fmt;

use super::{NearestColors, Palette, Rgb};

/// A table of 256 × 256 bytes.
///
/// ```
/// use mode13h::palette::{Rgb, Lut64K, builtin};
/// let fog = Lut64K::fog(&builtin::GREY, Rgb::new(128, 128, 128));
/// assert_eq!(fog.get(0, 77), 77);
/// assert_eq!(fog.get(255, 77), fog.get(255, 200));
/// assert_eq!(fog.as_array()[255 << 8 | 77], fog.get(255, 77));
/// ```
#[derive(Clone, PartialEq, Eq)]
pub struct Lut64K(Box<[u8; Lut64K::BYTES]>);

impl Lut64K {
    /// 64 KiB.
    pub(crate) const BYTES: usize = 65_536;

    /// Makes a table with `byte(high, low)` at every row and column, such as the shade table of
    /// Phong shading.
    #[must_use]
    pub fn from_fn(mut byte: impl FnMut(u8, u8) -> u8) -> Self {
        let mut table = Self(Box::new([0; Self::BYTES]));
        // At most 248 + 7.
        table.fill_by_eights(|high, low| core::array::from_fn(|i| byte(high, low + i as u8)));
        table
    }

    /// Refills this table, eight bytes of a row at a time: `bytes` receives their row and the first of their columns.
    pub(crate) fn fill_by_eights(&mut self, mut bytes: impl FnMut(u8, u8) -> [u8; 8]) {
        for (high, row) in (0..=255).zip(self.0.chunks_exact_mut(256)) {
            for (low, eight) in (0..=255).step_by(8).zip(row.as_chunks_mut::<8>().0) {
                *eight = bytes(high, low);
            }
        }
    }

    /// A table of shaded texels. Row: a shade, with 255 for full light; column: a texel. The entry is the nearest to
    /// `colors[texel]·shade/255`; in full light it is the texel itself if the palette has the texel's colour at that
    /// index.
    #[must_use]
    pub fn shades(palette: &Palette, colors: &[Rgb; 256]) -> Self {
        let search = NearestColors::of_shown(palette);
        Self::from_fn(|shade, texel| match colors[usize::from(texel)] {
            color if shade == 255 && color == palette[texel] => texel,
            color => search.nearest(Rgb::BLACK.mix(color, shade)),
        })
    }

    /// A table of fog. Row: the amount of fog, from 0 (none) to 255 (nothing but fog); column: the
    /// byte without fog. The entry is the nearest to the mixture of that byte's colour with `fog`.
    /// Row 0 leaves every byte unchanged.
    #[must_use]
    pub fn fog(palette: &Palette, fog: Rgb) -> Self {
        let shown = palette.on_dac();
        let search = NearestColors::of_shown(palette);
        Self::from_fn(|level, byte| match level {
            0 => byte,
            _ => search.nearest(shown[byte].mix(fog, level)),
        })
    }

    /// A table of glass. Row: the new byte; column: the old byte. The entry is the nearest to the
    /// mixture in which the new one has the share `opacity`, 0 to 255: at 255 it is the new byte
    /// itself, at 0 the old one. A byte blended over itself is unchanged.
    #[must_use]
    pub fn blend(palette: &Palette, opacity: u8) -> Self {
        let shown = palette.on_dac();
        let search = NearestColors::of_shown(palette);
        Self::from_fn(|new, old| match opacity {
            255 => new,
            0 => old,
            _ if new == old => new,
            _ => search.nearest(shown[old].mix(shown[new], opacity)),
        })
    }

    /// A table of glenz, or additive transparency: the entry nearest to the sum of both colours, each channel at most
    /// 255. Row and column are as in [`blend`](Self::blend), but swapping them does not change the picture. A byte that
    /// shows black adds nothing: the result is the other byte, or the old one if both are black.
    #[must_use]
    pub fn add(palette: &Palette) -> Self {
        let shown = palette.on_dac();
        let search = NearestColors::of_shown(palette);
        Self::from_fn(|new, old| match (shown[new], shown[old]) {
            (Rgb::BLACK, _) => old,
            (_, Rgb::BLACK) => new,
            (new, old) => search.nearest(new.saturating_add(old)),
        })
    }

    /// All bytes of the table, with row `high` and column `low` at `high << 8 | low`.
    #[must_use]
    #[inline]
    pub fn as_array(&self) -> &[u8; Self::BYTES] {
        &self.0
    }

    /// The byte of a row and a column.
    #[must_use]
    #[inline]
    pub fn get(&self, high: u8, low: u8) -> u8 {
        self.0[usize::from(high) << 8 | usize::from(low)]
    }
}

impl fmt::Debug for Lut64K {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Lut64K").finish_non_exhaustive()
    }
}
