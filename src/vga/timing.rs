//! The position of the beam over time: the clock behind port 3DAh.
//!
//! Mode 13h has the timing of the 400-line text mode, with each row scanned twice. Its CRTC registers, as every VGA
//! BIOS loads them (5F 4F 50 82 54 80 BF 1F 00 41 … 9C 8E 8F 28 40 96 B9 A3), say:
//!
//! | what | register | value |
//! |---|---|---|
//! | clocks a line | 00h = 5Fh, + 5, × 8 | 800 |
//! | of these shown | 01h = 4Fh, + 1, × 8 | 640 |
//! | lines a frame | 06h = BFh with bit 8 in 07h, + 2 | 449 |
//! | of these shown | 12h = 8Fh with bit 8 in 07h, + 1 | 400 |
//! | retrace starts | 10h = 9Ch with bit 8 in 07h | line 412 |
//! | retrace ends | 11h = 8Eh: its low 4 bits are those of the line | line 414 |
//!
//! At 25.175 MHz that is 31.469 kHz and 70.086 Hz. The retrace lasts two lines, 63.6 µs: a program that polls bit 3
//! less often misses it.

/// The number of dot clocks in a scan line, displayed or not.
pub const DOTS_PER_LINE: u32 = 800;
/// The number of dot clocks in a line that display pixels, two for each of the 320.
pub const DOTS_SHOWN: u32 = 640;
/// The number of scan lines in a frame, displayed or not.
pub const LINES_PER_FRAME: u32 = 449;
/// The number of scan lines displayed, two for each of the 200 rows.
pub const LINES_SHOWN: u32 = 400;
/// The first scan line of the vertical retrace.
pub const RETRACE_START: u32 = 412;
/// The first scan line after the vertical retrace.
pub const RETRACE_END: u32 = 414;
/// The dot clock in Hz.
pub const DOT_CLOCK: u32 = 25_175_000;

/// Port 3DAh, bit 0: the beam is in blanking, horizontal or vertical.
pub const NOT_DISPLAYING: u8 = 1;
/// Port 3DAh, bit 3: vertical retrace.
pub const VERTICAL_RETRACE: u8 = 8;

/// 25,175,000 dots in 10⁹ nanoseconds, in lowest terms: 1,007 dots in 40,000 ns. Time is counted in 1/40,000 dot, of
/// which a nanosecond has exactly 1,007: nothing is rounded, so nothing drifts.
const UNITS_PER_NANOSECOND: u64 = 1_007;
const UNITS_PER_DOT: u64 = 40_000;
const UNITS_PER_LINE: u64 = UNITS_PER_DOT * DOTS_PER_LINE as u64;
const UNITS_PER_FRAME: u64 = UNITS_PER_LINE * LINES_PER_FRAME as u64;
const RETRACE_STARTS_AT: u64 = UNITS_PER_LINE * RETRACE_START as u64;

const _: () = assert!(DOT_CLOCK as u64 * UNITS_PER_DOT == UNITS_PER_NANOSECOND * 1_000_000_000);

/// The position of the beam. It starts at the first dot of the first line and only moves when time is advanced.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Beam {
    /// The time since the frame began, below `UNITS_PER_FRAME`.
    units: u64,
}

impl Beam {
    pub(super) const fn new() -> Self {
        Self { units: 0 }
    }

    pub(super) const fn advance(&mut self, nanoseconds: u64) {
        // The remainder comes first: 1.4·10¹⁰ · 1,007 fits in 64 bits, u64::MAX · 1,007 does not.
        let moved = nanoseconds % UNITS_PER_FRAME * UNITS_PER_NANOSECOND % UNITS_PER_FRAME;
        self.units = (self.units + moved) % UNITS_PER_FRAME;
    }

    /// The scan line, 0 to 448; lines 0 to 399 show row `line / 2`.
    #[must_use]
    pub const fn line(self) -> u32 {
        // Below 449.
        (self.units / UNITS_PER_LINE) as u32
    }

    /// The dot in its line, 0 to 799; dots 0 to 639 show column `dot / 2`.
    #[must_use]
    pub const fn dot(self) -> u32 {
        // Below 800.
        (self.units % UNITS_PER_LINE / UNITS_PER_DOT) as u32
    }

    /// Returns whether a pixel is being shown.
    #[must_use]
    pub const fn is_displaying(self) -> bool {
        self.line() < LINES_SHOWN && self.dot() < DOTS_SHOWN
    }

    /// Returns whether the beam is in vertical retrace.
    #[must_use]
    pub const fn is_in_retrace(self) -> bool {
        RETRACE_START <= self.line() && self.line() < RETRACE_END
    }

    /// The value that port 3DAh reads: [`NOT_DISPLAYING`] and [`VERTICAL_RETRACE`], all other bits 0.
    #[must_use]
    pub const fn status(self) -> u8 {
        let blank = if self.is_displaying() { 0 } else { NOT_DISPLAYING };
        let retrace = if self.is_in_retrace() { VERTICAL_RETRACE } else { 0 };
        blank | retrace
    }

    /// The number of nanoseconds until the next vertical retrace begins, rounded up; 1 to 14,268,124. During a retrace,
    /// the following one counts.
    #[must_use]
    pub const fn nanoseconds_to_retrace(self) -> u64 {
        let ahead = (RETRACE_STARTS_AT + UNITS_PER_FRAME - self.units - 1) % UNITS_PER_FRAME + 1;
        ahead.div_ceil(UNITS_PER_NANOSECOND)
    }
}
