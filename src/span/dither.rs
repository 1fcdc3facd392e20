//! The span with ordered dither: at each pixel another threshold takes the place of the half.
//!
//! ```text
//! row[k] = ((shade + k·step + thresholds[(x + k) mod 8]) mod 65,536) >> 8
//! ```
//!
//! A shade that is rounded to the nearest has a half (128) added to it; here the number added is 0 to
//! 255 by the pixel's place, so that of many pixels of a shade between two bytes as many take the upper
//! one as it is near to it.

/// Thresholds by row and column, `BAYER[y % 8][x % 8]`: Bayer's matrix (B. E. Bayer, *An optimum method
/// for two-level rendition of continuous-tone pictures*, 1973), its ranks spread evenly over 0 to 255.
///
/// ```text
/// threshold = nearest((2·rank + 1) · 255 / 128)        rank 0 to 63
/// ```
///
/// That is the middle of the rank's 64th of 0 to 255. Ranks i and 63 − i have thresholds that add up to
/// 255 (no product is half-way between two numbers), so the mean is exactly 127.5; thresholds of ranks
/// that follow each other are 4 apart, and 3 (126 and 129) in the middle.
pub const BAYER: [[u8; 8]; 8] = bayer();

const fn bayer() -> [[u8; 8]; 8] {
    let mut thresholds = [[0; 8]; 8];
    let mut place = 0;
    while place < 64 {
        let (x, y) = (place % 8, place / 8);
        // The ranks of 2 × 2 pixels are 0 2 / 3 1: two bits, x ≠ y and y. Each halving of the square makes
        // two bits more, the finest the highest.
        let (mut rank, mut bit) = (0, 0);
        while bit < 3 {
            rank = rank * 4 + 2 * (((x ^ y) >> bit) & 1) + ((y >> bit) & 1);
            bit += 1;
        }
        // At most 253.
        thresholds[y][x] = (((2 * rank + 1) * 255 + 64) / 128) as u8;
        place += 1;
    }
    thresholds
}

/// Fills `row` with the shades of a linear ramp, dithered, with the fastest loop of this build.
///
/// `shade` and `step` are 8.8, without the half; the sum wraps. `thresholds` are those of the frame's
/// row, a row of [`BAYER`] for one; `x` is the frame's column of `row[0]`, of which only the lower three
/// bits count.
///
/// ```
/// use mode13h::span::dither::{BAYER, fill_dithered};
///
/// let mut row = [0; 8];
/// fill_dithered(&mut row, 0x1080, 0, &BAYER[0], 0); // 16.5: half of them 16, half 17
/// assert_eq!(row, [16, 17, 16, 17, 16, 17, 16, 17]);
/// ```
#[inline(never)]
pub fn fill_dithered(row: &mut [u8], shade: u16, step: u16, thresholds: &[u8; 8], x: usize) {
    #[cfg(all(feature = "simd", target_arch = "x86_64"))]
    if row.len() >= 16 {
        return super::simd::sse2::fill_dithered(row, shade, step, thresholds, x);
    }
    fill_dithered_portable(row, shade, step, thresholds, x);
}

/// The specification of [`fill_dithered`].
pub fn fill_dithered_portable(row: &mut [u8], shade: u16, step: u16, thresholds: &[u8; 8], x: usize) {
    let mut ax = shade;
    for (k, pixel) in row.iter_mut().enumerate() {
        let threshold = thresholds[x.wrapping_add(k) % 8];
        let [ah, _al] = ax.wrapping_add(u16::from(threshold)).to_be_bytes();
        *pixel = ah;
        ax = ax.wrapping_add(step);
    }
}
