//! A map from 15-bit colours to the nearest palette entry, and the dither amplitude that suits it.

use alloc::boxed::Box;
use core::fmt;

use super::{NearestColors, Palette, Rgb};

/// The nearest entry of a palette for every colour with 5 bits per channel.
///
/// Entry `red << 10 | green << 5 | blue` is for the colour `(v << 3) | (v >> 2)` in each channel, which maps 0 to 0 and
/// 31 to 255. Distances are to the colours that the card shows; the first of several equally near entries is used.
///
/// ```
/// use mode13h::palette::{InverseColormap, Rgb, builtin};
/// let nearest = InverseColormap::new(&builtin::GREY);
/// assert_eq!(nearest.get(Rgb::new(255, 255, 255)), 252, "the first of four that the card shows as white");
/// ```
#[derive(Clone, PartialEq, Eq)]
pub struct InverseColormap {
    entries: Box<[u8; InverseColormap::BYTES]>,
    spread: u8,
}

impl InverseColormap {
    /// The size of the map: 32 KiB.
    pub const BYTES: usize = 32_768;

    /// Makes the map of a palette.
    #[must_use]
    pub fn new(palette: &Palette) -> Self {
        let search = NearestColors::of_shown(palette);
        let mut entries = Box::new([0; Self::BYTES]);
        for (i, entry) in (0_u16..).zip(entries.iter_mut()) {
            // 5 bits each.
            let widen = |five: u16| ((five & 31) << 3 | (five & 31) >> 2) as u8;
            *entry = search.nearest(Rgb::new(widen(i >> 10), widen(i >> 5), widen(i)));
        }
        Self { entries, spread: spread(palette) }
    }

    /// All entries, with red in the highest bits of the index.
    #[must_use]
    #[inline]
    pub fn as_array(&self) -> &[u8; Self::BYTES] {
        &self.entries
    }

    /// The entry for a colour, from the upper 5 bits of each channel.
    #[must_use]
    #[inline]
    pub fn get(&self, color: Rgb) -> u8 {
        let five = |v: u8| usize::from(v >> 3);
        self.entries[five(color.r) << 10 | five(color.g) << 5 | five(color.b)]
    }

    /// The amplitude of ordered dithering for every channel, from the lowest threshold to the
    /// highest, that reaches from one palette colour to its neighbours: the median, over the
    /// distinct colours that the card shows, of the distance to the nearest other one. In 1/255 of
    /// full intensity, at most 255; 0 if there are no two distinct colours.
    ///
    /// In the colour cube this is the distance between two levels, just what ordered dithering needs there. In a
    /// palette of ramps it is a step along a ramp.
    #[must_use]
    #[inline]
    pub fn spread(&self) -> u8 {
        self.spread
    }
}

impl fmt::Debug for InverseColormap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("InverseColormap").field("spread", &self.spread).finish_non_exhaustive()
    }
}

/// See [`InverseColormap::spread`].
///
/// Measured on colours between neighbours (`tests/scene/palette_tables.rs`), the means of 8 × 8 blocks
/// are off by 7.3 without dithering and 1.9 with this spread (20) in the palette of 16 ramps, and
/// by 11.7 and 1.4 in the cube (spread 49). A larger spread reaches colours that are far from all
/// entries, at the price of noise everywhere. The mean instead of the median would give the cube
/// 41, since its greys are close together.
fn spread(palette: &Palette) -> u8 {
    let mut colors = palette.on_dac().colors().map(Rgb::to_u32);
    colors.sort_unstable();
    let colors = colors.map(Rgb::from_u32);
    let mut distances = [u32::MAX; 256];
    let mut count = 0;
    for (i, &color) in colors.iter().enumerate() {
        if i > 0 && colors[i - 1] == color {
            continue;
        }
        let others = colors.iter().filter(|&&other| other != color);
        distances[count] = others.map(|&other| color.distance_squared(other)).min().unwrap_or(0);
        count += 1;
    }
    let distances = &mut distances[..count];
    distances.sort_unstable();
    let square = distances[count / 2];
    let root = square.isqrt();
    // (r + ½)² = r² + r + ¼: anything above is nearer to r + 1.
    u8::try_from(root + u32::from(square > root * root + root)).unwrap_or(u8::MAX)
}
