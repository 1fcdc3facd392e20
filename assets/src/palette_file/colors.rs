//! The colours of a palette file, collected in order.

use mode13h::palette::Palette;
use mode13h::palette::Rgb;

use super::error::{PaletteError, PaletteErrorKind};

/// Up to 256 colours; those never pushed are black.
pub(super) struct Colors {
    entries: [Rgb; 256],
    count: usize,
}

impl Colors {
    pub(super) const fn new() -> Self {
        Self { entries: [Rgb::BLACK; 256], count: 0 }
    }

    /// Adds the colour in this line.
    pub(super) fn push(&mut self, line: usize, color: Rgb) -> Result<(), PaletteError> {
        let full = PaletteError::at_line(line, PaletteErrorKind::TooManyColors);
        *self.entries.get_mut(self.count).ok_or(full)? = color;
        self.count += 1;
        Ok(())
    }

    pub(super) const fn count(&self) -> usize {
        self.count
    }

    /// The palette of a file that ends before the line `end` and should have at least `expected` colours.
    pub(super) fn into_palette(self, end: usize, expected: usize) -> Result<Palette, PaletteError> {
        if self.count < expected {
            let kind = PaletteErrorKind::TooFewColors { found: self.count, expected };
            return Err(PaletteError::at_line(end, kind));
        }
        Ok(Palette::from_colors(self.entries))
    }
}
