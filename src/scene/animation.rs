//! Palette animation: colours change while the picture stays, because only the DAC is reloaded.

use core::ops::RangeInclusive;

use super::motion::part;
use crate::palette::Palette;
use crate::vga::Vga;

/// A change of the palette over time.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
#[expect(clippy::large_enum_variant, reason = "a scene has one at most")]
pub enum PaletteAnimation {
    /// A fade to another palette and back.
    Fade {
        /// The other palette.
        to: Palette,
        /// The time there and back again, in seconds; above 0.
        period: f64,
    },
    /// A range of entries rotates upward.
    Cycle {
        /// The range.
        range: RangeInclusive<u8>,
        /// The time of one rotation, in seconds; above 0.
        period: f64,
    },
}

impl PaletteAnimation {
    /// Loads the DAC with the colours that `palette` has at this time.
    pub(crate) fn load(&self, palette: &Palette, seconds: f64, vga: &mut Vga) {
        match self {
            Self::Fade { to, period } => {
                let part = part(seconds, *period);
                let there = if part > 0.5 { 2.0 - 2.0 * part } else { 2.0 * part };
                // 0 to 256; the cast truncates after 0.5 is added.
                vga.fade(palette, to, (there * 256.0 + 0.5) as u16);
            }
            Self::Cycle { range, period } => {
                vga.set_palette(palette);
                let entries = i32::from(*range.end()) - i32::from(*range.start()) + 1;
                // Below the number of entries.
                vga.cycle(range.clone(), (part(seconds, *period) * f64::from(entries.max(0))) as i32);
            }
        }
    }

    /// Checks the animation; the error says what is wrong.
    pub(crate) fn check(&self) -> Result<(), &'static str> {
        match self {
            Self::Fade { period, .. } | Self::Cycle { period, .. } if !(*period > 0.0 && period.is_finite()) => {
                Err("its period must be above 0 and finite")
            }
            Self::Cycle { range, .. } if range.is_empty() => Err("its range of entries is empty"),
            _ => Ok(()),
        }
    }
}
