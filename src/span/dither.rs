//! Dither: at each pixel a threshold replaces the half that is usually added to a shade.
//!
//! ```text
//! row[k] = ((shade + k·step + thresholds.at(x + k)) mod 65,536) >> 8
//! ```
//!
//! Rounding to nearest adds a half (128); dither adds 0 to 255, depending on the pixel's position. So the share of
//! pixels that take the upper of two bytes is the shade's fraction.

pub use super::thresholds::{DitherPattern, PERIOD, ThresholdRow, Thresholds};

/// Fills `row` with the shades of a linear ramp, dithered, with the fastest loop of this build.
///
/// `shade` and `step` are 8.8, without the half; the sum wraps. `thresholds` are those of the frame's
/// row; `x` is the frame's column of `row[0]`.
///
/// ```
/// use mode13h::internals::span::dither::{DitherPattern, fill_dithered};
///
/// let mut row = [0; 8];
/// // 16.5: half of them 16, half 17
/// fill_dithered(&mut row, 0x1080, 0, DitherPattern::Ordered.thresholds().row(0), 0);
/// assert_eq!(row, [16, 17, 16, 17, 16, 17, 16, 17]);
/// ```
#[inline(never)]
pub fn fill_dithered(row: &mut [u8], shade: u16, step: u16, thresholds: &ThresholdRow, x: usize) {
    #[cfg(simd_x86_64)]
    if row.len() >= 16 {
        return super::simd::sse2::fill_dithered(row, shade, step, thresholds, x);
    }
    fill_dithered_portable(row, shade, step, thresholds, x);
}

/// The specification of [`fill_dithered`].
pub fn fill_dithered_portable(row: &mut [u8], shade: u16, step: u16, thresholds: &ThresholdRow, x: usize) {
    let mut ax = shade;
    for (k, pixel) in row.iter_mut().enumerate() {
        let [ah, _al] = ax.wrapping_add(u16::from(thresholds.at(x.wrapping_add(k)))).to_be_bytes();
        *pixel = ah;
        ax = ax.wrapping_add(step);
    }
}
