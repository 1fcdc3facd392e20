//! The machine: a VGA card in mode 13h, with 320 × 200 pixels of one byte.
//!
//! | item | what |
//! |---|---|
//! | [`Vga`] | 64 KiB of memory, the ports, the plain calls; bytes to RGB |
//! | [`Dac`] | 256 colours of 3 × 6 bits |
//! | [`timing`] | the beam, and the clock that the caller advances |

mod dac;
mod scan_out;
mod stamp;
pub mod timing;

use core::ops::RangeBounds;

pub use dac::Dac;
pub use timing::Beam;

use crate::palette::{BIOS, Palette, Rgb};
use stamp::Stamp;

/// A VGA card in mode 13h.
///
/// It contains its 64 KiB of memory: if the stack is small, put it into a `static` or a box.
///
/// ```
/// use mode13h::palette::Rgb;
/// use mode13h::vga::Vga;
///
/// let mut vga = Vga::new();
/// vga.poke(320 * 100 + 160, 40);
/// // 1994: entry 40 becomes pure green.
/// for (port, value) in [(0x3C8, 40), (0x3C9, 0), (0x3C9, 63), (0x3C9, 0)] {
///     vga.write_port(port, value);
/// }
/// assert_eq!(vga.palette()[40], Rgb::new(0, 255, 0));
/// ```
#[derive(Clone, Debug)]
pub struct Vga {
    memory: [u8; Self::MEMORY],
    stamp: Stamp,
    dac: Dac,
    /// The ramps of the palette that was set last.
    ramps: u16,
    beam: Beam,
}

impl Vga {
    /// The number of pixels in a row.
    pub const WIDTH: usize = 320;
    /// The number of rows.
    pub const HEIGHT: usize = 200;
    /// The number of bytes from a pixel to the one below it.
    pub const PITCH: usize = 320;
    /// The number of bytes displayed: 64,000.
    pub const SHOWN: usize = Self::PITCH * Self::HEIGHT;
    /// The number of bytes of memory: 65,536.
    pub const MEMORY: usize = 65_536;
    /// The ratio of a pixel's width to its height: 320 × 200 of them fill a 4:3 screen.
    pub const PIXEL_ASPECT: (u32, u32) = (5, 6);

    /// The card as the BIOS leaves it: memory clear, the BIOS's colours, pixel mask 0xFF, the beam at the first pixel.
    #[must_use]
    pub const fn new() -> Self {
        Self { memory: [0; Self::MEMORY], stamp: Stamp::new(), dac: Dac::new(), ramps: 0, beam: Beam::new() }
    }

    /// All 65,536 bytes; the first 64,000 are displayed.
    #[must_use]
    #[inline]
    pub const fn memory(&self) -> &[u8; Self::MEMORY] {
        &self.memory
    }

    /// All 65,536 bytes, mutably. Counts as an access for [`stamp`](Self::stamp).
    #[must_use]
    #[inline]
    pub fn memory_mut(&mut self) -> &mut [u8; Self::MEMORY] {
        self.stamp.renew();
        &mut self.memory
    }

    /// The byte at an offset. Offsets wrap at 65,536, as DI does.
    #[must_use]
    #[inline]
    pub const fn peek(&self, offset: u32) -> u8 {
        self.memory[wrapped(offset)]
    }

    /// Stores a byte. Offsets wrap at 65,536; from 64,000 on, the byte is stored but not displayed.
    #[inline]
    pub fn poke(&mut self, offset: u32, byte: u8) {
        self.stamp.renew();
        self.memory[wrapped(offset)] = byte;
    }

    /// The 64,000 bytes that are displayed: 320 × 200, row-major.
    #[must_use]
    #[inline]
    pub const fn pixels(&self) -> &[u8] {
        self.memory.split_at(Self::SHOWN).0
    }

    /// The 64,000 bytes that are displayed, mutably. Counts as an access for [`stamp`](Self::stamp).
    #[must_use]
    #[inline]
    pub fn pixels_mut(&mut self) -> &mut [u8] {
        self.stamp.renew();
        self.memory.split_at_mut(Self::SHOWN).0
    }

    /// A number that changes with every mutable access to the memory, whether or not a byte changed.
    ///
    /// Two cards with equal stamps hold equal bytes. (On processors without atomic additions that holds for one card at two
    /// times only.) The value has no other meaning, and may differ from run to run.
    #[must_use]
    #[inline]
    pub const fn stamp(&self) -> u64 {
        self.stamp.value
    }

    /// `out port, value`. Ports 3C6h to 3C9h reach the [`Dac`]; a write to any other is ignored.
    pub fn write_port(&mut self, port: u16, value: u8) {
        match port {
            Dac::PIXEL_MASK => self.dac.mask = value,
            Dac::READ_INDEX => self.dac.begin(value.wrapping_add(1), true),
            Dac::WRITE_INDEX => self.dac.begin(value, false),
            Dac::DATA => self.dac.write_data(value),
            _ => {}
        }
    }

    /// `in port`. Ports 3C6h to 3C9h read the [`Dac`], 3DAh the [`Beam`]'s status; any other reads
    /// 0xFF, as an empty bus does.
    ///
    /// A loop that waits for the retrace must [`advance`](Self::advance) the clock in its body.
    pub fn read_port(&mut self, port: u16) -> u8 {
        match port {
            Dac::PIXEL_MASK => self.dac.mask,
            Dac::READ_INDEX => 3 * u8::from(self.dac.reading),
            Dac::WRITE_INDEX => self.dac.address,
            Dac::DATA => self.dac.read_data(),
            Self::INPUT_STATUS => self.beam.status(),
            _ => 0xFF,
        }
    }

    /// Input status: bit 3 vertical retrace, bit 0 not displaying.
    const INPUT_STATUS: u16 = 0x3DA;

    /// Advances the clock behind port 3DAh. Nothing is rounded: any number of calls has the same
    /// effect as a single call with the sum of their times.
    pub const fn advance(&mut self, nanoseconds: u64) {
        self.beam.advance(nanoseconds);
    }

    /// The position of the beam.
    #[must_use]
    pub const fn beam(&self) -> Beam {
        self.beam
    }

    /// The DAC's registers.
    #[must_use]
    pub const fn dac(&self) -> &Dac {
        &self.dac
    }

    /// Loads all 256 entries, rounded down to 6 bits. The memory and the ports' index and counter are unchanged; this
    /// also holds for [`fade`](Self::fade) and [`cycle`](Self::cycle).
    pub fn set_palette(&mut self, palette: &Palette) {
        self.fade(palette, palette, 0);
    }

    /// The palette as it is displayed: entry `i` is the colour of a pixel whose byte is `i`, through the pixel mask,
    /// with 6 bits expanded to 8. [`dac`](Self::dac) has the entries as they are stored.
    ///
    /// Its ramps are those of the palette that was last set.
    #[must_use]
    pub fn palette(&self) -> Palette {
        // Below 256.
        Palette::from_parts(core::array::from_fn(|pixel| self.dac.color_of(pixel as u8)), self.ramps)
    }

    /// Loads the palette `t`/256 of the way from `from` to `to`: channel by channel `(from·(256 − t) + to·t) >> 8` in 8
    /// bits, then reduced to 6. `t` above 256 counts as 256. At 0 and 256 the colours are those of `from` and `to`. The ramps are always those of `to`.
    pub fn fade(&mut self, from: &Palette, to: &Palette, t: u16) {
        let t = u32::from(t.min(256));
        // At most 255·256, so the shifted sum is a byte. Rounded down, as the DAC rounds.
        let mix = |a: u8, b: u8| ((u32::from(a) * (256 - t) + u32::from(b) * t) >> 8) as u8;
        for index in 0..=255 {
            let (a, b) = (from[index], to[index]);
            self.dac.set(index, Rgb::new(mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)));
        }
        // At most 256.
        self.ramps = to.ramps() as u16;
    }

    /// Rotates a range of entries upward by `steps`: entries pushed out at the top come back in at the bottom. Negative
    /// steps rotate downward. A reversed range is empty.
    ///
    /// ```
    /// # use mode13h::vga::Vga;
    /// let mut vga = Vga::new();
    /// let before = vga.palette();
    /// vga.cycle(32..56, 1);
    /// assert_eq!(vga.palette()[33], before[32]);
    /// assert_eq!(vga.palette()[32], before[55]);
    /// assert_eq!(vga.palette()[56], before[56]);
    /// ```
    pub fn cycle(&mut self, range: impl RangeBounds<u8>, steps: i32) {
        let range = (range.start_bound().map(|&i| usize::from(i)), range.end_bound().map(|&i| usize::from(i)));
        // `None` where the range runs backwards.
        if let Some(entries) = self.dac.shown.get_mut(range)
            && !entries.is_empty()
        {
            // There are at most 256 entries, so the remainder is 0 to 255.
            entries.rotate_right(steps.rem_euclid(entries.len() as i32) as usize);
        }
    }
}

impl Default for Vga {
    fn default() -> Self {
        Self::new()
    }
}

const fn wrapped(offset: u32) -> usize {
    // Below 65,536.
    (offset & 0xFFFF) as usize
}

const _: () = assert!(BIOS.ramps() == 0, "Vga::new says that the default palette has no ramps");
