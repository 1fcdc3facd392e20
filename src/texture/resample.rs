//! Resampling by area from pictures of any size to power-of-two sides.

use alloc::vec;
use alloc::vec::Vec;

use super::Texture;
use crate::palette::Rgb;

/// The binary logarithm of the power of two up to 256 whose ratio to `side` is nearest to 1. A tie, which no integer
/// can produce, would give the larger.
pub(super) fn nearest_power_of_two(side: u32) -> u32 {
    let lower = side.ilog2();
    // 2ˡ and 2ˡ⁺¹ are equally near at their geometric mean, whose square is 2²ˡ⁺¹; all of these are at most 2²⁴.
    let bits = if side * side > 1 << (2 * lower + 1) { lower + 1 } else { lower };
    bits.min(Texture::MAX_SIDE.ilog2())
}

/// The pixels of a row that overlap texel `i` of `to`, each with the length of its overlap. A pixel
/// is `to` and a texel `from` units long, so both rows are `from·to` long.
fn parts(i: usize, from: usize, to: usize) -> impl Iterator<Item = (usize, u32)> {
    let (start, end) = (i * from, (i + 1) * from);
    (start / to..end.div_ceil(to)).map(move |pixel| {
        let (left, right) = (start.max(pixel * to), end.min((pixel + 1) * to));
        // At most a side.
        (pixel, (right - left) as u32)
    })
}

/// Averages rows of `width` pixels over the areas of `to_width` × `to_height` texels. The weights of a texel's pixels
/// add up to width × height, which is at most 2²⁴: the sums stay below 2³².
pub(super) fn by_area(pixels: &[Rgb], width: usize, to_width: usize, to_height: usize) -> Vec<Rgb> {
    let height = pixels.len() / width;
    let whole = (width * height) as u32;
    let mut averaged = Vec::with_capacity(to_width * to_height);
    let mut sums = vec![[0_u32; 3]; to_width];
    for y in 0..to_height {
        sums.fill([0; 3]);
        for (row, rows) in parts(y, height, to_height) {
            let row = &pixels[row * width..][..width];
            for (x, sums) in sums.iter_mut().enumerate() {
                for (pixel, columns) in parts(x, width, to_width) {
                    let Rgb { r, g, b } = row[pixel];
                    for (sum, v) in sums.iter_mut().zip([r, g, b]) {
                        *sum += rows * columns * u32::from(v);
                    }
                }
            }
        }
        // A mean of bytes is a byte.
        averaged.extend(sums.iter().map(|sums| {
            let [r, g, b] = sums.map(|sum| ((sum + whole / 2) / whole) as u8);
            Rgb::new(r, g, b)
        }));
    }
    averaged
}
