//! Perspective-correct shades: linear on the face, so a hyperbola along a row (Hill).
//!
//! A value that is linear on a face in space is, on the screen, the quotient of two linear functions: the value divided
//! by w, and 1 / w. A vertex's depth is `2³⁰·near / w`, rounded. So with λ the weights of the three vertices, which are
//! areas and whole numbers,
//!
//! ```text
//! I(x, y) = Σ λᵢ·dᵢ·Iᵢ / Σ λᵢ·dᵢ
//! ```
//!
//! Numerator and denominator are exact: at most 2⁴² · 2³² · 2¹⁶. The byte is the nearest shade, `floor((I + 128) /
//! 256)`, in one quotient. It is in the range of the vertices because I is a mean of theirs with non-negative weights,
//! and the quotient is exact. It is within half a shade of the truth, plus what rounding the depths
//! adds: for w from 1 to 10⁴ within one triangle a depth is off by at most 5 parts in 10⁶, a shade
//! by 0.003.

use super::cover::SortedTriangle;
use super::shade::RESEED;
use super::weights::{Weights, exact, in_f64};
use crate::fixed::HAS_F64;
use crate::lanes::three;
use crate::simd::BASELINE;
use crate::span::hyperbolic::{fill_estimated_blocks, fill_quotients};

/// The perspective-correct shades of a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HyperbolicPlane {
    weights: Weights,
    depths: [i64; 3],
    shades: [i64; 3],
}

impl HyperbolicPlane {
    /// The plane of any three values of 0 to 0xFF00 at the corners of a triangle that is not degenerate.
    ///
    /// The values are in the order of its vertices. A depth of 0 counts as 1.
    #[must_use]
    pub(crate) fn of_values(triangle: &SortedTriangle, shades: [i64; 3]) -> Self {
        let depths = three(triangle.vertices.each_ref(), |v| i64::from(v.depth().max(1)));
        Self { weights: Weights::new(triangle), depths, shades }
    }

    /// The sums, over the corners, of weight times depth times shade (with `more` added to each shade) and of weight
    /// times depth. Depth times shade is below 2⁴⁹.
    fn sums(&self, weights: [i64; 3], more: i64) -> (i128, i128) {
        let products = three([0, 1, 2], |i| self.depths[i] * (self.shades[i] + more));
        (exact(weights, products), exact(weights, self.depths))
    }

    /// Numerator and denominator of the exact shade at pixel (`x`, `y`), in 1/256.
    #[cfg(feature = "alloc")]
    pub(in crate::raster) fn shade(&self, x: i32, y: i32) -> (i128, i128) {
        self.sums(self.weights.at(x, y), 0)
    }

    /// Numerator and denominator of the byte at pixel (`x`, `y`), whose centre lies in the triangle.
    #[must_use]
    pub(crate) fn quotient(&self, x: i32, y: i32) -> (i128, i128) {
        let (n, d) = self.sums(self.weights.at(x, y), 128);
        (n, 256 * d)
    }

    /// The changes of both from one pixel to the next.
    #[must_use]
    pub(crate) fn step(&self) -> (i128, i128) {
        let (n, d) = self.sums(self.weights.per_column, 128);
        (n, 256 * d)
    }

    /// The bytes from pixel (`x`, `y`) on, all of whose centres lie in the triangle.
    pub(in crate::raster) fn fill(&self, x: i32, y: i32, pixels: &mut [u8]) {
        // Columns of a frame.
        for (piece, x) in pixels.chunks_mut(RESEED as usize).zip((x..).step_by(RESEED as usize)) {
            let (mut bytes, length) = ([0; RESEED as usize], piece.len());
            if let Some([n, d]) = self.estimates(x, y, 128, length)
                && fill_estimated_blocks(BASELINE, (&mut bytes, length), n, d)
            {
                piece.copy_from_slice(&bytes[..length]);
            } else {
                let ((n, d), (dn, dd)) = (self.quotient(x, y), self.step());
                fill_quotients(piece, n, dn, d, dd);
            }
        }
    }

    /// Numerator and divisor in f64 at a pixel, and their changes per pixel: their quotients over a row of this many
    /// pixels are 256 times the shades in 1/256, with `more` added, off by less than ½. A shade that all corners share
    /// is half a unit greater, so that no quotient is a whole number. `None` where this accuracy is not guaranteed.
    ///
    /// The quotient t is below T = 2²⁴. Let ε = 2⁻⁵³, N(k) and D(k) the exact sums at pixel k, N and D their largest
    /// values, which are at the two ends, and R = D over the least D(k), which is at an end too:
    ///
    /// 1. Weights are exact, and so are depths times shades. There are three products and two sums of non-negative
    ///    numbers: N(0) is off by 3εN.
    /// 2. No weight is negative at either end, so k steps change a weight by at most the sum of its values at both
    ///    ends; the step is off by 3ε of the sum of its terms' magnitudes, and k of them by 3ε·(N(0) + N(last)), 6εN.
    /// 3. Their product with k adds εN, the sum another: the numerator is off by less than 12εN, and the divisor by
    ///    12εD in the same way.
    /// 4. Since N ≤ T·D, the quotient is off by less than T·ε·(25R): for R ≤ 2¹⁵ less than 2⁻⁹.
    #[inline(always)]
    pub(in crate::raster) fn estimates(&self, x: i32, y: i32, more: i64, pixels: usize) -> Option<[[f64; 2]; 2]> {
        if !HAS_F64 {
            return None;
        }
        let [a, b, c] = self.shades;
        // Exact: 32 bits, and 50 of them times a power of two.
        let doubled = 2 * more + i64::from(a == b && b == c);
        let depths = three(self.depths, |depth| depth as f64);
        let values = three([0, 1, 2], |i| (self.depths[i] * (2 * self.shades[i] + doubled)) as f64 * 128.0);
        let sums = |weights: [i64; 3]| {
            let [a, b, c] = in_f64(weights);
            [a * values[0] + b * values[1] + c * values[2], a * depths[0] + b * depths[1] + c * depths[2]]
        };
        let ([n, d], [dn, dd]) = (sums(self.weights.at(x, y)), sums(self.weights.per_column));
        const MAX_RATIO: f64 = 32_768.0;
        // At most 4,096 pixels.
        let last = d + pixels.saturating_sub(1) as f64 * dd;
        // False for NaN too.
        (d.min(last) * MAX_RATIO >= d.max(last)).then_some([[n, dn], [d, dd]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixed::{I24F8, U8F8};
    use crate::raster::frame::Rect;
    use crate::raster::vertex::Vertex;
    use proptest::prelude::*;

    fn corner() -> impl Strategy<Value = (i32, i32, u16, u32)> {
        // Shades include halves, whose quotient is a whole number all along a triangle of one shade; depths have all
        // sizes.
        let shade = prop_oneof![0_u16..=0xFF00, Just(0x4080), Just(0), Just(0xFF00), Just(0x40FF)];
        let depth = (0_u32..32, any::<u32>()).prop_map(|(bits, depth)| depth >> bits);
        (-20_000..100_000_i32, -20_000..20_000_i32, shade, depth)
    }

    /// One shade everywhere, half a shade below a step: every exact quotient is a whole number. The row's last pixel is
    /// 1 unit from the far edge, where the divisor is 2³⁰ times less than at the first and consists of little but the
    /// first's rounding error.
    #[test]
    fn where_the_divisor_falls_too_far_there_is_no_estimate() {
        for (last, height) in (200..4_000).step_by(19).zip((20_000..1 << 20).step_by(997)) {
            let right = last * 256 + 128;
            // At the centre of row 0 the edge on the right is 1/height right of the last pixel's centre.
            let corners = [(0, 127, u32::MAX), (right, 127, 1), (right + 1, 127 + height, 1)];
            let vertices = corners.map(|(x, y, depth)| {
                Vertex::new(I24F8::from_bits(x), I24F8::from_bits(y), U8F8::from_bits(0x4080), depth).expect("in range")
            });
            let triangle = SortedTriangle::new(&vertices);
            let plane = HyperbolicPlane::of_values(&triangle, triangle.shades());
            let mut bytes = [0; 4096];
            let length = last as usize + 1;
            plane.fill(0, 0, &mut bytes[..length]);
            assert!(bytes[..length].iter().all(|byte| *byte == 0x41), "{vertices:?}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3_000))]
        /// Whole rows, and parts of them.
        #[test]
        fn estimates_give_the_bytes_of_exact_quotients(corners in prop::array::uniform3(corner()), part in 0_i32..7) {
            let vertices = corners.map(|(x, y, shade, depth)| {
                Vertex::new(I24F8::from_bits(x), I24F8::from_bits(y), U8F8::from_bits(shade), depth).expect("in range")
            });
            let triangle = SortedTriangle::new(&vertices);
            prop_assume!(triangle.doubled_area != 0);
            let plane = HyperbolicPlane::of_values(&triangle, triangle.shades());
            let mut wrong = None;
            triangle.rows(320, Rect { x0: 0, y0: 0, x1: 320, y1: 60 }, |row| {
                let x = (row.x0 + part).min(row.last);
                let (mut bytes, mut exact) = ([0; 320], [0; 320]);
                let length = (row.x1 - x) as usize;
                plane.fill(x, row.y, &mut bytes[..length]);
                let ((n, d), (dn, dd)) = (plane.quotient(x, row.y), plane.step());
                fill_quotients(&mut exact[..length], n, dn, d, dd);
                if bytes != exact {
                    wrong = Some(row);
                }
            });
            prop_assert!(wrong.is_none(), "{:?} of {:?}", wrong, vertices);
        }
    }
}
