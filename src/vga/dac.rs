//! The DAC: 256 entries of 3 × 6 bits behind four ports.
//!
//! | port | written | read |
//! |---|---|---|
//! | 3C6h | pixel mask | pixel mask |
//! | 3C7h | index to read from | 3 after a read index, 0 after a write index |
//! | 3C8h | index to write to | the index that the next third write would change |
//! | 3C9h | red, green, blue in turn | red, green, blue in turn |
//!
//! Reading and writing share one address register and one modulo-3 counter, as in the chip that IBM used (Inmos IMS
//! G171). Setting a read index leaves the address one higher, so 3C8h then reads one more. Sources: IBM PS/2 technical
//! reference, video subsystem; FreeVGA; DOSBox `vga_dac.cpp`, which does the same.

use crate::palette::{BIOS, Rgb};

/// The palette registers of the card.
#[derive(Clone, Debug)]
pub struct Dac {
    /// 0x00RRGGBB, each channel an expanded 6-bit value: the format that the scan-out looks up.
    pub(super) shown: [u32; 256],
    /// The pixel mask: every pixel's byte is ANDed with it on its way to the table.
    pub(super) mask: u8,
    pub(super) address: u8,
    pub(super) reading: bool,
    /// The next channel: 0 red, 1 green, 2 blue.
    channel: u8,
    /// The partly written colour, in 6 bits.
    latch: [u8; 3],
}

impl Dac {
    /// Pixel mask, read and write.
    pub const PIXEL_MASK: u16 = 0x3C6;
    /// Write: the index to read from. Read: 3 while reading, 0 while writing.
    pub const READ_INDEX: u16 = 0x3C7;
    /// The index to write to.
    pub const WRITE_INDEX: u16 = 0x3C8;
    /// Red, green, blue in turn, 6 bits each.
    pub const DATA: u16 = 0x3C9;

    pub(super) const fn new() -> Self {
        let mut shown = [0; 256];
        let mut i = 0;
        while i < 256 {
            shown[i] = BIOS.colors()[i].to_u32();
            i += 1;
        }
        Self { shown, mask: 0xFF, address: 0, reading: false, channel: 0, latch: [0; 3] }
    }

    /// An entry as it is stored, 0 to 63 per channel, regardless of the pixel mask.
    #[must_use]
    pub const fn entry(&self, index: u8) -> [u8; 3] {
        Rgb::from_u32(self.shown[index as usize]).to_dac()
    }

    /// The pixel mask, 0xFF unless changed through port 3C6h.
    #[must_use]
    pub const fn mask(&self) -> u8 {
        self.mask
    }

    /// The colour that a pixel's byte shows: looked up through the pixel mask, in 8 bits.
    #[must_use]
    pub const fn color_of(&self, pixel: u8) -> Rgb {
        Rgb::from_u32(self.shown[(pixel & self.mask) as usize])
    }

    /// Stores a colour, rounded down to 6 bits.
    pub(super) fn set(&mut self, index: u8, color: Rgb) {
        self.shown[usize::from(index)] = color.on_dac().to_u32();
    }

    /// Begins to read or to write at this address.
    pub(super) fn begin(&mut self, address: u8, reading: bool) {
        (self.address, self.reading, self.channel) = (address, reading, 0);
    }

    pub(super) fn write_data(&mut self, value: u8) {
        self.latch[usize::from(self.channel)] = value & 63;
        self.channel += 1;
        if self.channel == 3 {
            self.channel = 0;
            self.set(self.address, Rgb::from_dac(self.latch));
            self.address = self.address.wrapping_add(1);
        }
    }

    pub(super) fn read_data(&mut self) -> u8 {
        if self.channel == 0 {
            self.latch = self.entry(self.address.wrapping_sub(1));
        }
        let value = self.latch[usize::from(self.channel)];
        self.channel += 1;
        if self.channel == 3 {
            self.channel = 0;
            self.address = self.address.wrapping_add(1);
        }
        value
    }
}
