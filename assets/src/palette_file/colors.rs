//! The colours of a palette file, collected in order.

use mode13h::palette::Palette;
use mode13h::palette::Rgb;

/// Up to 256 colours; those never pushed are black.
pub(super) struct Colors {
    entries: [Rgb; 256],
    count: usize,
}

/// The error of a 257th colour.
pub(super) struct Full;

impl Colors {
    pub(super) const fn new() -> Self {
        Self { entries: [Rgb::BLACK; 256], count: 0 }
    }

    pub(super) fn push(&mut self, color: Rgb) -> Result<(), Full> {
        *self.entries.get_mut(self.count).ok_or(Full)? = color;
        self.count += 1;
        Ok(())
    }

    pub(super) const fn count(&self) -> usize {
        self.count
    }

    pub(super) const fn into_palette(self) -> Palette {
        Palette::from_colors(self.entries)
    }
}
