//! Thresholds of dither, by the pixel's position: the patterns.

use crate::names::named;

named! {
    /// A pattern of thresholds.
    #[derive(Default)]
    pub enum DitherPattern, "dither pattern" {
        /// Bayer's 8 × 8 matrix: a regular weave.
        #[default]
        Ordered = "ordered",
        /// A 64 × 64 void-and-cluster mask: grain without a visible pattern.
        BlueNoise = "blue-noise",
        /// The 4 × 4 matrix of the `PlayStation`: eight thresholds, each twice.
        Ps1 = "ps1",
    }
}

impl DitherPattern {
    /// The thresholds of the pattern, for loops of your own: a shade in 8.8 gives the byte `(shade + threshold) >> 8`.
    ///
    /// ```
    /// use mode13h::settings::DitherPattern;
    ///
    /// let threshold = DitherPattern::Ordered.thresholds().row(3).at(5);
    /// let byte = (0x1280 + u16::from(threshold)) >> 8;
    /// assert!(byte == 0x12 || byte == 0x13);
    /// ```
    #[must_use]
    pub const fn thresholds(self) -> Thresholds {
        match self {
            Self::Ordered => Thresholds(&BAYER),
            Self::BlueNoise => Thresholds(&BLUE_NOISE),
            Self::Ps1 => Thresholds(&PS1),
        }
    }
}

/// The number of columns after which the thresholds of a row repeat.
pub const PERIOD: usize = 64;

/// The maximum number of neighbouring thresholds that [`ThresholdRow::next`] returns.
const MAX_BLOCK: usize = 16;

/// Thresholds for a row of the frame. They repeat after 64 columns.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ThresholdRow(
    /// The first ones are repeated at the end, so that any [`MAX_BLOCK`] neighbours lie side by side.
    [u8; PERIOD + MAX_BLOCK],
);

impl ThresholdRow {
    internal! {
        /// A row that repeats `thresholds`, whose number divides 64.
        #[must_use]
        const fn new<const N: usize>(thresholds: &[u8; N]) -> Self {
            const { assert!(PERIOD.is_multiple_of(N)) }
            let mut row = [0; PERIOD + MAX_BLOCK];
            let mut x = 0;
            while x < row.len() {
                row[x] = thresholds[x % N];
                x += 1;
            }
            Self(row)
        }
    }

    /// The threshold of a column of the frame.
    #[inline]
    #[must_use]
    pub const fn at(&self, column: usize) -> u8 {
        self.0[column % PERIOD]
    }

    /// The thresholds of `N` columns, starting with `column`.
    #[cfg(any(feature = "alloc", feature = "simd"))]
    #[inline]
    pub(crate) fn next<const N: usize>(&self, column: usize) -> [u8; N] {
        const { assert!(N <= MAX_BLOCK) }
        let first = column % PERIOD;
        let mut next = [0; N];
        next.copy_from_slice(&self.0[first..first + N]);
        next
    }
}

/// Thresholds for every pixel of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Thresholds(
    /// One period of rows, whose number is a power of two.
    &'static [ThresholdRow],
);

impl Thresholds {
    /// A half everywhere: no dither.
    pub const HALVES: Self = Self(&[ThresholdRow::new(&[128])]);

    /// Zero everywhere: no dither, for shades to be truncated.
    pub const ZEROS: Self = Self(&[ThresholdRow::new(&[0])]);

    /// The thresholds of a row of the frame.
    #[inline]
    #[must_use]
    pub const fn row(self, y: usize) -> &'static ThresholdRow {
        &self.0[y & (self.0.len() - 1)]
    }
}

/// Bayer's matrix (B. E. Bayer, *An optimum method for two-level rendition of continuous-tone pictures*, 1973), its
/// ranks spread evenly over 0 to 255.
///
/// ```text
/// threshold = nearest((2·rank + 1) · 255 / 128)        rank 0 to 63
/// ```
///
/// That is the middle of the rank's 64th of 0 to 255. Ranks i and 63 − i have thresholds that add up to 255 (no product
/// is half-way between two integers), so the mean is exactly 127.5; thresholds of successive ranks are 4 apart, and 3
/// (126 and 129) in the middle.
static BAYER: [ThresholdRow; 8] = {
    let mut rows = [ThresholdRow::new(&[0]); 8];
    let mut y = 0;
    while y < 8 {
        let mut thresholds = [0; 8];
        let mut x = 0;
        while x < 8 {
            // The ranks of 2 × 2 pixels are 0 2 / 3 1: two bits, x ≠ y and y. Each halving of the square adds two bits,
            // the finest the highest.
            let (mut rank, mut bit) = (0, 0);
            while bit < 3 {
                rank = rank * 4 + 2 * (((x ^ y) >> bit) & 1) + ((y >> bit) & 1);
                bit += 1;
            }
            // At most 253.
            thresholds[x] = (((2 * rank + 1) * 255 + 64) / 128) as u8;
            x += 1;
        }
        rows[y] = ThresholdRow::new(&thresholds);
        y += 1;
    }
    rows
};

/// The dither that the `PlayStation` adds to each 8-bit channel before it cuts off the lower three
/// bits (Martin Korth, *Nocash PSX Specifications*, "24bit RGB to 15bit RGB Dithering").
///
/// ```text
/// threshold = nearest((2·(offset + 4) + 1) · 255 / 16)        offset −4 to 3
/// ```
///
/// That is the middle of the offset's eighth of 0 to 255.
static PS1: [ThresholdRow; 4] = {
    const OFFSETS: [[i32; 4]; 4] = [[-4, 0, -3, 1], [2, -2, 3, -1], [-3, 1, -4, 0], [3, -1, 2, -2]];
    let mut rows = [ThresholdRow::new(&[0]); 4];
    let mut y = 0;
    while y < 4 {
        let mut thresholds = [0; 4];
        let mut x = 0;
        while x < 4 {
            // 16 to 239.
            thresholds[x] = (((2 * (OFFSETS[y][x] + 4) + 1) * 255 + 8) / 16) as u8;
            x += 1;
        }
        rows[y] = ThresholdRow::new(&thresholds);
        y += 1;
    }
    rows
};

/// A mask by the void-and-cluster method (R. Ulichney, *The void-and-cluster method for dither array generation*,
/// 1993): the pixels below any threshold are spread evenly, but without order. `tests/span/blue_noise.rs` generates the
/// file.
///
/// ```text
/// threshold = rank >> 4        rank 0 to 4,095
/// ```
static BLUE_NOISE: [ThresholdRow; 64] = {
    let (thresholds, _) = include_bytes!("blue_noise.bin").as_chunks::<PERIOD>();
    let mut rows = [ThresholdRow::new(&[0]); 64];
    let mut y = 0;
    while y < 64 {
        rows[y] = ThresholdRow::new(&thresholds[y]);
        y += 1;
    }
    rows
};
