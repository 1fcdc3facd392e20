//! 256 colours, and the shade ramps among them.
//!
//! | item | what |
//! |---|---|
//! | [`Rgb`] | one colour; 8 bits per channel, and the DAC's 6 |
//! | [`Ramp`] | consecutive entries from dark to light, which shades cannot leave |
//! | [`Palette`] | 256 colours, with the ramps that they hold |
//! | [`gradient`] | ramps from key colours |
//! | [`cube`] | the 6 × 6 × 6 colour cube with greys, and its nearest entry without a search |
//! | [`BIOS`] | the initial colours of mode 13h |
//! | [`builtin`] | the built-in palettes, by name |
//! | [`NearestColors`], [`InverseColormap`] | the nearest entry of any palette: exactly, and by a table of 5 bits per channel (`alloc`) |
//! | [`Lut64K`] | 64 KiB tables from two bytes to a third: shaded texels, fog, glass (`alloc`) |
//!
//! A palette has 8 bits per channel, the card 6. A palette stores the 8 bits it was given, so a file is written as it
//! was read. [`Vga::set_palette`](crate::vga::Vga::set_palette) rounds down to 6, and the scan-out expands to 8 again.
//! [`Palette::on_dac`] gives the result.

mod bios;
pub mod builtin;
pub mod cube;
pub mod gradient;
#[cfg(feature = "alloc")]
mod inverse_colormap;
#[cfg(feature = "alloc")]
mod lut64k;
#[cfg(feature = "alloc")]
mod median_cut;
#[cfg(feature = "alloc")]
mod nearest_colors;
mod ramp;
mod rgb;

use core::ops::Index;

pub use bios::BIOS;
#[cfg(feature = "alloc")]
pub use inverse_colormap::InverseColormap;
#[cfg(feature = "alloc")]
pub use lut64k::Lut64K;
#[cfg(feature = "alloc")]
pub use median_cut::MedianCut;
#[cfg(feature = "alloc")]
pub use nearest_colors::NearestColors;
pub use ramp::Ramp;
pub use rgb::{Rgb, dac6_to_8, to_dac6};

/// 256 colours, and the number of equal shade ramps that they form.
///
/// ```
/// use mode13h::palette::{Palette, Rgb, builtin};
/// let materials = &builtin::MATERIALS_4X64;
/// assert_eq!(materials.ramps(), 4);
/// assert_eq!(materials.ramp(1).map(|ramp| (ramp.first(), ramp.last())), Some((64, 127)));
///
/// let grey = Palette::from_colors(core::array::from_fn(|i| Rgb::new(i as u8, i as u8, i as u8)));
/// assert_eq!(grey.ramps(), 1);
/// assert_eq!(grey.nearest(Rgb::new(99, 100, 101)), 100);
/// ```
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Palette {
    colors: [Rgb; 256],
    // 0, or a power of two up to 256.
    ramps: u16,
}

/// The colour of an entry.
impl Index<u8> for Palette {
    type Output = Rgb;

    #[inline]
    fn index(&self, entry: u8) -> &Rgb {
        &self.colors[usize::from(entry)]
    }
}

impl Palette {
    /// The max number of ramps that [`from_colors`](Self::from_colors) looks for; each would have 8 entries.
    const MAX_RAMPS_FOUND: u16 = 32;

    /// Makes a palette of 256 colours, and finds its ramps: the smallest number, out of 1, 2, 4, 8,
    /// 16 and 32, of equal ramps such that within each ramp no entry is darker than the one before
    /// it, and the last is brighter than the first ([`Rgb::brightness`]); 0 if none of these fits.
    /// [`with_ramps`](Self::with_ramps) overrides it.
    #[must_use]
    pub const fn from_colors(colors: [Rgb; 256]) -> Self {
        let mut ramps = 1;
        while ramps <= Self::MAX_RAMPS_FOUND {
            if all_ramps_rise(&colors, ramps) {
                return Self { colors, ramps };
            }
            ramps *= 2;
        }
        Self { colors, ramps: 0 }
    }

    /// Makes a palette of 256 DAC colours, 0 to 63 per channel.
    #[must_use]
    pub const fn from_dac(six: &[[u8; 3]; 256]) -> Self {
        let mut colors = [Rgb::BLACK; 256];
        let mut i = 0;
        while i < 256 {
            colors[i] = Rgb::from_dac(six[i]);
            i += 1;
        }
        Self::from_colors(colors)
    }

    /// Declares that the colours form `ramps` equal ramps: 0 for none, or 1, 2, 4 … 256.
    ///
    /// Returns `None` for any other number.
    #[must_use]
    pub const fn with_ramps(mut self, ramps: u16) -> Option<Self> {
        if ramps != 0 && (!ramps.is_power_of_two() || ramps > 256) {
            return None;
        }
        self.ramps = ramps;
        Some(self)
    }

    /// The colours.
    #[must_use]
    #[inline]
    pub const fn colors(&self) -> &[Rgb; 256] {
        &self.colors
    }

    /// The number of equal ramps that the entries form; 0 if there are no ramps.
    #[must_use]
    #[inline]
    pub const fn ramps(&self) -> usize {
        self.ramps as usize
    }

    /// Ramp `i`, counted from 0. Returns `None` if `i` is not below [`ramps`](Self::ramps).
    #[must_use]
    #[inline]
    pub const fn ramp(&self, i: usize) -> Option<Ramp> {
        if i >= self.ramps() {
            return None;
        }
        let entries = 256 / self.ramps;
        // i is below 256 / entries, so the product is below 256.
        Ramp::new((i as u16 * entries) as u8, entries)
    }

    /// The entry nearest to a colour, by squared distance in the RGB cube; the first if several are equally near.
    /// Searches all 256; for the cube palette there is [`cube::nearest`].
    #[must_use]
    pub const fn nearest(&self, color: Rgb) -> u8 {
        let (mut best, mut best_distance, mut i) = (0, u32::MAX, 0);
        while i < 256 {
            let distance = self.colors[i].distance_squared(color);
            if distance < best_distance {
                (best, best_distance) = (i as u8, distance);
            }
            i += 1;
        }
        best
    }

    /// The palette as the card shows it: each colour reduced to 6 bits and expanded again. The
    /// ramps are unchanged.
    #[must_use]
    pub const fn on_dac(&self) -> Self {
        let mut colors = self.colors;
        let mut i = 0;
        while i < 256 {
            colors[i] = colors[i].on_dac();
            i += 1;
        }
        Self { colors, ramps: self.ramps }
    }

    pub(crate) const fn from_parts(colors: [Rgb; 256], ramps: u16) -> Self {
        Self { colors, ramps }
    }
}

impl Default for Palette {
    /// The initial colours of mode 13h.
    fn default() -> Self {
        BIOS
    }
}

const fn all_ramps_rise(colors: &[Rgb; 256], ramps: u16) -> bool {
    let entries = 256 / ramps as usize;
    let mut first = 0;
    while first < 256 {
        if colors[first].brightness() >= colors[first + entries - 1].brightness() {
            return false;
        }
        let mut i = first + 1;
        while i < first + entries {
            if colors[i].brightness() < colors[i - 1].brightness() {
                return false;
            }
            i += 1;
        }
        first += entries;
    }
    true
}
