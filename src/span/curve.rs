//! Shades that are quadratic along a row. This pass writes no pixel.

use super::Kernel;
use crate::simd::compiled_for_each_level;

compiled_for_each_level! {
    /// Shades in 8.8 on a parabola, clamped between two limits of at most 0xFF00:
    ///
    /// ```text
    /// shades[k] = nearest(min(max(a + k·(b + k·c), least), most))
    /// ```
    ///
    /// in f32, with products and sums each rounded once and in this order; ties go to even, and NaN becomes `least`. k
    /// is at most 4,095.
    ///
    /// A quadratic function over a triangle has this form along a row. (G. Bishop and D. Weimer, *Fast Phong shading*,
    /// 1986, use two additions per pixel for it; here every pixel is computed from its own k, so each is as accurate as
    /// the first.)
    #[inline]
    pub fn curve[][](kernel: Kernel, shades: &mut [u16], parabola: [f32; 3], least: u16, most: u16) {
        curve_inlined(shades, parabola, least, most)
    }
}

#[inline(always)]
fn curve_inlined(shades: &mut [u16], [a, b, c]: [f32; 3], least: u16, most: u16) {
    // When 2²³ is added, the last bit of an f32 is worth 1, so the sum is rounded to the nearest integer.
    const WHOLE: f32 = 8_388_608.0;
    let (least, most) = (f32::from(least), f32::from(most));
    // An index loop, as in `light::lanes`.
    let mut pixel = 0;
    while pixel < shades.len() {
        let k = pixel as i32 as f32;
        let value = a + k * (b + k * c);
        // In this form NaN becomes `least`, and each is one instruction.
        let value = if value > least { value } else { least };
        let value = if value < most { value } else { most };
        // The lower half of the bits is the number itself.
        shades[pixel] = (value + WHOLE).to_bits() as u16;
        pixel += 1;
    }
}
