//! Vertices of the raster: projected ones inside the guard band.

use super::error::RasterError;
use super::fill_rule::first_centre;
use crate::fixed::{I24F8, U8F8};

/// A projected vertex: position in 1/256 pixel, shade, depth. Every vertex is valid, so the raster
/// itself has nothing to reject.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct Vertex {
    x: i32,
    y: i32,
    shade: u16,
    depth: u32,
}

/// The nearest 1/256, halves upward; saturates at the ends of i32, and NaN counts as 0.
#[inline]
fn nearest(x: f32) -> i32 {
    let most = if x < 0.0 { i32::MIN } else { i32::MAX };
    if x.is_nan() { 0 } else { I24F8::round_from_f32(x).map_or(most, I24F8::to_bits) }
}

impl Vertex {
    /// The guard band: |x| and |y| at most 2²⁰ units of 1/256 pixel, 4,096 pixels.
    ///
    /// With it twice a triangle's area is at most 2⁴² and a shade's numerator at most 2⁵⁸: all of
    /// the raster's arithmetic fits in i64.
    pub const GUARD_BAND: i32 = 1 << 20;

    /// The vertex in the corner of the frame, black and far away.
    pub(crate) const ORIGIN: Self = Self { x: 0, y: 0, shade: 0, depth: 0 };

    /// A vertex at (`x`, `y`), x to the right and y down, with its shade and its depth
    /// (greater is nearer; `round(2³⁰·near / w)` in the engine, any u32 here).
    ///
    /// # Errors
    /// A coordinate outside the guard band, or a shade above 255.0.
    #[inline]
    pub const fn new(x: I24F8, y: I24F8, shade: U8F8, depth: u32) -> Result<Self, RasterError> {
        let (h, v) = (x.to_bits(), y.to_bits());
        if h < -Self::GUARD_BAND || h > Self::GUARD_BAND || v < -Self::GUARD_BAND || v > Self::GUARD_BAND {
            return Err(RasterError::OutsideGuardBand { x, y });
        }
        if shade.to_bits() > U8F8::MAX_VERTEX.to_bits() {
            return Err(RasterError::ShadeAbove255 { shade });
        }
        Ok(Self { x: h, y: v, shade: shade.to_bits(), depth })
    }

    /// A vertex at (`x`, `y`) in pixels, x to the right and y down, with a shade of 0 to 255; its depth is 0. Pixel
    /// centres lie at halves. Each value is rounded to the nearest 1/256 and clamped to the guard band or the range of
    /// shades; NaN counts as 0.
    ///
    /// ```
    /// use mode13h::raster::{Frame, Interpolation, Raster, Vertex};
    ///
    /// let mut bytes = [0; 4 * 2];
    /// let mut raster = Raster::new(Frame::new(&mut bytes, 4, 2, 4)?);
    /// let [a, b, c] = [Vertex::at(0.0, 0.0, 10.0), Vertex::at(8.0, 0.0, 170.0), Vertex::at(0.0, 8.0, 10.0)];
    /// raster.triangle(&[a, b, c], Interpolation::default());
    /// assert_eq!(bytes, [20, 40, 60, 80, 20, 40, 60, 80]);
    /// # Ok::<(), mode13h::raster::RasterError>(())
    /// ```
    // Compiled where it is called, so that programs for a microcontroller without floating point contain no float code.
    #[must_use]
    #[inline]
    pub fn at(x: f32, y: f32, shade: f32) -> Self {
        // 255.0 in 1/256.
        let most = i32::from(U8F8::MAX_VERTEX.to_bits());
        let [x, y] = [x, y].map(|c| nearest(c).clamp(-Self::GUARD_BAND, Self::GUARD_BAND));
        Self { x, y, shade: nearest(shade).clamp(0, most) as u16, depth: 0 }
    }

    /// The vertex at another depth; greater is nearer.
    #[must_use]
    #[inline]
    pub const fn with_depth(self, depth: u32) -> Self {
        Self { depth, ..self }
    }

    /// A vertex known to be valid: it was made from a valid one, or is valid by construction.
    #[inline]
    pub(crate) fn of_projected(x: I24F8, y: I24F8, shade: U8F8, depth: u32) -> Self {
        debug_assert!(Self::new(x, y, shade, depth).is_ok(), "({x:?}, {y:?}), {shade:?}");
        Self { x: x.to_bits(), y: y.to_bits(), shade: shade.to_bits(), depth }
    }

    /// Gives the vertex another shade; one above 255.0 counts as 255.0.
    #[must_use]
    #[inline]
    pub const fn with_shade(self, shade: U8F8) -> Self {
        let (bits, most) = (shade.to_bits(), U8F8::MAX_VERTEX.to_bits());
        Self { shade: if bits > most { most } else { bits }, ..self }
    }

    /// x, to the right.
    #[must_use]
    #[inline]
    pub const fn x(&self) -> I24F8 {
        I24F8::from_bits(self.x)
    }

    /// y, down.
    #[must_use]
    #[inline]
    pub const fn y(&self) -> I24F8 {
        I24F8::from_bits(self.y)
    }

    /// The shade, at most 255.0.
    #[must_use]
    #[inline]
    pub const fn shade(&self) -> U8F8 {
        U8F8::from_bits(self.shade)
    }

    /// The depth; greater is nearer.
    #[must_use]
    #[inline]
    pub const fn depth(&self) -> u32 {
        self.depth
    }
}

/// Returns whether the box of these corners, its left and top sides included and the others
/// excluded, contains no pixel centre: a triangle with exact coverage then draws nothing.
#[inline]
pub(super) fn misses_centres(corners: &[Vertex; 3]) -> bool {
    let [a, b, c] = corners;
    let no_centre = |[a, b, c]: [I24F8; 3]| first_centre(a.min(b).min(c)) == first_centre(a.max(b).max(c));
    // Both are computed without a branch in between: a branch for each would be mispredicted twice as often.
    no_centre([a.x(), b.x(), c.x()]) | no_centre([a.y(), b.y(), c.y()])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vertex_for_people_is_rounded_and_cut_off() {
        let bits = |vertex: Vertex| (vertex.x().to_bits(), vertex.y().to_bits(), vertex.shade().to_bits());
        for (x, y, shade, expected) in [
            (0.5, -1.25, 128.0, (128, -320, 0x8000)),
            // Halves upward.
            (1.0 / 512.0, -1.0 / 512.0, 0.0, (1, 0, 0)),
            (4_096.0, -4_097.0, 256.0, (1 << 20, -(1 << 20), 0xFF00)),
            (f32::INFINITY, f32::NEG_INFINITY, -1.0, (1 << 20, -(1 << 20), 0)),
            (f32::NAN, 1e30, f32::NAN, (0, 1 << 20, 0)),
            (-1e30, f32::MIN_POSITIVE, 1e30, (-(1 << 20), 0, 0xFF00)),
        ] {
            let vertex = Vertex::at(x, y, shade);
            assert_eq!(bits(vertex), expected, "{x}, {y}, {shade}");
            // `new` accepts it too.
            assert_eq!(Vertex::new(vertex.x(), vertex.y(), vertex.shade(), 0), Ok(vertex));
            assert_eq!(vertex.with_depth(7).depth(), 7);
        }
    }
}
