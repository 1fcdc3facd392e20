//! Vectors of three integers: length, direction, rotation.

use super::angle::{BinaryAngle, SINE_BITS};
use crate::fixed::I16F16;

/// A point, or a direction, in 16.16.
pub type Vector = [I16F16; 3];

pub(super) type Wide = [i64; 3];
/// Rows of directions with [`SINE_BITS`] fractional bits.
pub(super) type Matrix = [Wide; 3];

pub(super) fn widen(v: Vector) -> Wide {
    v.map(|c| i64::from(c.to_bits()))
}

#[inline]
pub(super) fn dot(a: Wide, b: Wide) -> i64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Wide, b: Wide) -> [i128; 3] {
    let [a, b] = [a, b].map(|v| v.map(i128::from));
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Shifts right, rounding to the nearest.
#[inline]
pub(super) fn round_shift(n: i64, bits: u32) -> i64 {
    (n + (1 << (bits - 1))) >> bits
}

/// The vector of length 2^`bits`, `bits` at most 30, in the direction of `v`; `None` for the zero vector. Components
/// must be below 2¹²⁶.
///
/// Negating `v` negates the result, bit for bit, so that opposite directions cancel.
///
/// Accuracy: the components are first brought to 30 bits, the greatest to 2²⁹ or more, so that truncating them and
/// taking the root of the sum of their squares changes the direction by less than 2⁻²⁸; then each is rounded to the
/// nearest. At `bits` = 16 a component is within 0.501 units, and the length within √3 · 0.501 < 0.87 units: 2⁻¹⁶ of 1.
/// (The limit is 2⁻¹⁴.)
pub(super) fn unit(v: [i128; 3], bits: u32) -> Option<Wide> {
    let greatest = v.iter().fold(0, |greatest, c| c.unsigned_abs().max(greatest));
    if greatest == 0 {
        return None;
    }
    let length_in_bits = 128 - greatest.leading_zeros();
    let thirty_bits = |c: i128| {
        let c = c.unsigned_abs();
        // Below 2³⁰ in magnitude.
        (if length_in_bits > 30 { c >> (length_in_bits - 30) } else { c << (30 - length_in_bits) }) as u64
    };
    let [x, y, z] = v.map(thirty_bits);
    // Below 4 · 3 · 2⁶⁰ < 2⁶⁴. The root of four times the square is twice the length, 2³⁰ or more.
    let doubled_length = ((x * x + y * y + z * z) << 2).isqrt() as i64;
    let component = |c: u64, sign: i128| {
        // nearest(c · 2^bits / length): below 2³⁰⁺³⁰⁺².
        let magnitude = (((c as i64) << (bits + 2)) + doubled_length) / (2 * doubled_length);
        // −1, 0 or 1.
        magnitude * sign.signum() as i64
    };
    Some([component(x, v[0]), component(y, v[1]), component(z, v[2])])
}

/// The unit vector, length 65,536, in the direction of `v`; `None` for the zero vector. Its length is within 2⁻¹⁶ of 1.
///
/// ```
/// use mode13h::fixed::I16F16;
/// use mode13h::integer::unit_vector;
/// let unit = unit_vector([3, 0, -4].map(I16F16::from_int)).map(|v| v.map(I16F16::to_bits));
/// assert_eq!(unit, Some([39_322, 0, -52_429])); // 0.6, 0, −0.8
/// ```
#[must_use]
pub fn unit_vector(v: Vector) -> Option<Vector> {
    narrow_unit(widen(v).map(i128::from))
}

/// The unit vector, length 65,536, of wide components below 2¹²⁶; see [`unit_vector`].
pub(super) fn narrow_unit(v: [i128; 3]) -> Option<Vector> {
    // Within ±65,536.
    unit(v, 16).map(|v| v.map(|c| I16F16::from_bits(c as i32)))
}

/// An object's rotation matrix, from its angles about x, y and z: z first, then y, then x. It transforms directions of
/// the object to directions of the scene.
///
/// It is computed directly from the angles, never as a product of small steps: the same angles always give the same
/// matrix. Every entry is within 0.501 of 1/65,536, so the rows have length 1 and are orthogonal to within √3 · 2 ·
/// 0.501 / 65,536 < 2⁻¹⁵. (The limit is 2⁻¹³.)
#[must_use]
pub fn turn(angles: [BinaryAngle; 3]) -> [Vector; 3] {
    // Within ±65,536: the unrounded entry is at most 2³⁰ and a few units.
    wide_turn(angles).map(|row| row.map(|c| I16F16::from_bits(round_shift(c, SINE_BITS - 16) as i32)))
}

/// The matrix of [`turn`] with [`SINE_BITS`] fractional bits, within 8 units.
pub(super) fn wide_turn(angles: [BinaryAngle; 3]) -> Matrix {
    let [(sx, cx), (sy, cy), (sz, cz)] = angles.map(BinaryAngle::sin_cos);
    let narrow = |n: i64| round_shift(n, SINE_BITS);
    // Sines are at most 2³⁰, products 2⁶⁰, sums of two 2⁶¹.
    let (sx_sy, cx_sy) = (narrow(sx * sy), narrow(cx * sy));
    [
        [cy * cz, -cy * sz, sy << SINE_BITS],
        [cx * sz + sx_sy * cz, cx * cz - sx_sy * sz, -sx * cy],
        [sx * sz - cx_sy * cz, sx * cz + cx_sy * sz, cx * cy],
    ]
    .map(|row| row.map(narrow))
}

/// `a · b` with [`SINE_BITS`] fractional bits.
pub(super) fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let column = |j: usize| [b[0][j], b[1][j], b[2][j]];
    // Sums of three products of at most 2³⁰ and a few units each: below 2⁶².
    a.map(|row| [0, 1, 2].map(|j| round_shift(dot(row, column(j)), SINE_BITS)))
}
