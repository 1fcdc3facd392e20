//! The fill rule: a pixel belongs to a triangle if its centre lies inside, or on a left or a top edge.

use crate::fixed::I24F8;
use crate::simd::Lanes8;

/// The first pixel whose centre is at or to the right of (below) this coordinate: `ceil(x − ½)`.
#[must_use]
#[inline]
pub const fn first_centre(coordinate: I24F8) -> i32 {
    // ceil((u − 128) / 256) = floor((u + 127) / 256); u is at most 2²⁰ in a raster vertex.
    coordinate.to_bits().saturating_add(127) >> 8
}

/// [`first_centre`] of eight coordinates of at most 2²⁰.
#[inline(always)]
pub(super) fn first_centre_of_each<S: Lanes8>(s: S, units: S::I32) -> S::I32 {
    s.shr_i32(s.add_i32(units, s.splat_i32(127)), 8)
}

/// Triangles that cover none of four pixels: the one at the origin, its right neighbour, and the
/// two below. The result is valid only if the corners are less than 1,024 units away.
///
/// ```text
/// E(p) = (b − a) × (p − a)        of each edge; positive inside, or if counter-clockwise, negative
/// ```
///
/// A point on a left or top edge lies inside; on any other edge, subtracting 1 makes E negative.
#[inline(always)]
pub(super) fn cover_none_of_four<S: Lanes8>(
    s: S,
    a: (S::I32, S::I32),
    b: (S::I32, S::I32),
    c: (S::I32, S::I32),
) -> S::Mask {
    let (ab, bc, ca) = (cross(s, a, b), cross(s, b, c), cross(s, c, a));
    // Twice the area; −1 if it is negative.
    let turned = s.shr_i32(s.add_i32(s.add_i32(ab, bc), ca), 31);
    let ab = at_four(s, ab, a, b, turned);
    let bc = at_four(s, bc, b, c, turned);
    let ca = at_four(s, ca, c, a, turned);
    let mut none = s.splat_i32(-1);
    for pixel in 0..4 {
        none = s.and_i32(none, s.or_i32(s.or_i32(ab[pixel], bc[pixel]), ca[pixel]));
    }
    s.is_greater(s.splat_i32(0), none)
}

/// The edge function at the origin.
#[inline(always)]
fn cross<S: Lanes8>(s: S, (ax, ay): (S::I32, S::I32), (bx, by): (S::I32, S::I32)) -> S::I32 {
    s.sub_i32(s.mul_i32(ax, by), s.mul_i32(ay, bx))
}

/// The edge function at the four pixels, negative outside.
#[inline(always)]
fn at_four<S: Lanes8>(s: S, e: S::I32, from: (S::I32, S::I32), to: (S::I32, S::I32), turned: S::I32) -> [S::I32; 4] {
    let dx = turn(s, s.sub_i32(to.0, from.0), turned);
    let dy = turn(s, s.sub_i32(to.1, from.1), turned);
    // Up, or level and to the right: −1.
    let is_in = s.shr_i32(s.sub_i32(s.shl_i32(dy, 10), dx), 31);
    let first = s.sub_i32(s.sub_i32(turn(s, e, turned), s.splat_i32(1)), is_in);
    let (right, down) = (s.shl_i32(dy, 8), s.shl_i32(dx, 8));
    let below = s.add_i32(first, down);
    [first, s.sub_i32(first, right), below, s.sub_i32(below, right)]
}

/// `n`, negated where `turned` is −1.
#[inline(always)]
fn turn<S: Lanes8>(s: S, n: S::I32, turned: S::I32) -> S::I32 {
    s.sub_i32(s.xor_i32(n, turned), turned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_centre_is_the_ceiling_of_x_less_a_half() {
        for units in -2000..2000 {
            let naive = (-100..100).find(|p| p * 256 + 128 >= units);
            assert_eq!(Some(first_centre(I24F8::from_bits(units))), naive, "{units}");
        }
    }
}
