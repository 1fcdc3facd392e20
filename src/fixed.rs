//! The number types: screen coordinates, shades and 16.16 values, with every rounding named.
//!
//! | type | holds | bits | unit |
//! |---|---|---|---|
//! | [`I24F8`] | a screen coordinate | 24 integer and sign, 8 fraction | 1/256 pixel |
//! | [`U8F8`] | a shade | 8 integer, 8 fraction | 1/256 shade |
//! | [`I16F16`] | a coordinate or factor of the integer vertex path | 16 integer and sign, 16 fraction | 1/65,536 |
//!
//! The Hungarian tutorial warns that a right shift of a negative number needs `sar`, not `shr`. But
//! `sar` rounds toward minus infinity and a division toward zero, so narrowing has to specify
//! which. Here the name of each narrowing conversion says how it rounds.

/// Whether the target has IEEE double precision in hardware. If not, branches that use floats are
/// compiled out. (x87 is excluded: its intermediate results have 64-bit mantissas.)
pub(crate) const HAS_F64: bool = cfg!(any(
    target_arch = "x86_64",
    target_arch = "aarch64",
    target_arch = "wasm32",
    all(target_arch = "x86", target_feature = "sse2")
));

/// 1.5 · 2⁵²: adding it to a value within ±2⁵¹ leaves the nearest integer, ties to even, in the low
/// bits of the mantissa. The low 32 bits of the constant are 0, so the low 32 bits of the sum are
/// that integer modulo 2³².
pub(crate) const ROUND_MAGIC: f64 = 6_755_399_441_055_744.0;
const _: () = assert!(ROUND_MAGIC.to_bits() as u32 == 0);

/// Whether this is a size-optimised build (`capi/build`), for machines with little memory: it draws the same bytes with
/// fewer loops, and long functions are not inlined. It lacks the shadings
/// [`GouraudVintage`](crate::raster::Interpolation::GouraudVintage) and
/// [`GouraudFloat`](crate::raster::Interpolation::GouraudFloat),
/// which draw as `Gouraud88` does.
pub(crate) const IS_SMALL: bool = cfg!(mode13h_small);

/// Whether code size matters: in a size-optimised build, and in WebAssembly, which is loaded over a network. Loops that
/// would save only a few per cent of the time are then left out.
pub(crate) const IS_COMPACT: bool = IS_SMALL || cfg!(target_family = "wasm");

internal! {
/// The floor of n / d for a positive d, modulo 2⁶⁴.
#[must_use]
#[cfg_attr(mode13h_small, inline(never))]
#[cfg_attr(not(mode13h_small), inline(always))]
fn floor_of_wide(n: i128, d: i128) -> i64 {
    n.div_euclid(d) as i64
}
}

/// The integer nearest to a value within ±2⁵¹, with ties to even; for other values the result is arbitrary.
///
/// Use only where [`HAS_F64`]. SSE2 has no rounding instruction, and a cast to i64 would saturate, at the cost of two
/// comparisons.
#[inline]
pub(crate) fn nearest_whole(x: f64) -> i64 {
    (x + ROUND_MAGIC).to_bits().wrapping_sub(ROUND_MAGIC.to_bits()) as i64
}

/// The integer part of a value in [0, 2³¹); for other values the result is arbitrary. A cast would saturate, which
/// keeps the compiler from vectorising it.
#[cfg(feature = "alloc")]
#[inline(always)]
pub(crate) fn whole_part(x: f64) -> i32 {
    // As in `nearest_whole`; if that rounded up, the result is one too large.
    let sum = x + ROUND_MAGIC;
    // The low 32 bits.
    let nearest = sum.to_bits() as i32;
    nearest.wrapping_sub(i32::from(sum - ROUND_MAGIC > x))
}

/// A screen coordinate in 1/256 pixel: 24 integer bits, 8 fractional bits.
///
/// The centre of pixel `p` is at `256·p + 128` units.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub struct I24F8(i32);

/// Converts from whole pixels.
impl From<i16> for I24F8 {
    #[inline]
    fn from(pixels: i16) -> Self {
        Self(i32::from(pixels) * Self::ONE)
    }
}

impl I24F8 {
    /// The number of units in a pixel.
    pub(crate) const ONE: i32 = 256;
    /// The distance from the pixel's left edge to its centre, in units.
    pub const HALF: i32 = 128;

    /// Makes a coordinate from units of 1/256 pixel.
    #[must_use]
    pub const fn from_bits(units: i32) -> Self {
        Self(units)
    }

    /// Returns the coordinate in units of 1/256 pixel.
    #[must_use]
    pub const fn to_bits(self) -> i32 {
        self.0
    }

    /// `floor(256·pixels + ½)`, exactly: the only rounding that a projected coordinate undergoes.
    ///
    /// Returns `None` if `pixels` is not finite or the result does not fit in 32 bits.
    ///
    /// Adding the half in f64 first would be wrong: `0.49999999999999994 + 0.5` is 1. So the fraction is compared with
    /// a half instead. 256·x is exact (multiplying by a power of two loses nothing, even for a denormal), and so is
    /// `scaled − floor(scaled)` wherever it matters: for a negative number closer to 0 than 2⁻⁵³ it is rounded to 1,
    /// which is still not less than ½.
    ///
    /// ```
    /// use mode13h::fixed::I24F8;
    /// assert_eq!(I24F8::round_from_f64(1.5), Some(I24F8::from_bits(384)));
    /// assert_eq!(I24F8::round_from_f64(-1.0 / 512.0), Some(I24F8::from_bits(0)));
    /// assert_eq!(I24F8::round_from_f64(f64::NAN), None);
    /// ```
    #[must_use]
    #[inline]
    pub fn round_from_f64(pixels: f64) -> Option<Self> {
        let scaled = pixels * 256.0;
        // NaN fails these comparisons.
        let fits = [scaled >= -2_147_483_648.5, scaled < 2_147_483_647.5];
        if fits != [true; 2] {
            return None;
        }
        // Truncates toward zero; what is below the least integer becomes that.
        let whole = scaled as i32;
        let fraction = scaled - f64::from(whole);
        // In range as checked above.
        Some(Self(whole + i32::from(fraction >= 0.5) - i32::from(fraction < -0.5)))
    }

    /// `floor(256·pixels + ½)` of an f32, exactly, like [`round_from_f64`](Self::round_from_f64).
    ///
    /// The conversion to f64 is exact.
    #[must_use]
    #[inline]
    pub fn round_from_f32(pixels: f32) -> Option<Self> {
        Self::round_from_f64(f64::from(pixels))
    }

    /// Rounds a 16.16 coordinate in pixels: `floor(256·x + ½)`, exactly. The sum is taken in 64
    /// bits.
    #[must_use]
    #[inline]
    pub const fn round_from_i16f16(pixels: I16F16) -> Self {
        Self(((pixels.0 as i64 + 128) >> 8) as i32)
    }
}

/// A shade, 0 to 255 + 255/256, in 1/256 shade: 8 integer bits, 8 fractional bits. In the 1994 loop
/// this is AX: AH is the byte that is written, AL the fraction.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
#[repr(transparent)]
pub struct U8F8(u16);

/// Converts from a whole shade, 0 to 255.
impl From<u8> for U8F8 {
    #[inline]
    fn from(shade: u8) -> Self {
        Self(u16::from(shade) << 8)
    }
}

impl U8F8 {
    /// The greatest shade that a vertex may have: 255.0.
    pub const MAX_VERTEX: Self = Self(0xFF00);

    /// Makes a shade from units of 1/256 shade.
    #[must_use]
    pub const fn from_bits(units: u16) -> Self {
        Self(units)
    }

    /// Returns the shade in units of 1/256 shade.
    #[must_use]
    pub const fn to_bits(self) -> u16 {
        self.0
    }

    /// The nearest whole shade, ties upward: `(u + 128) >> 8`. 255.5 and above stay at 255.
    #[must_use]
    pub const fn nearest(self) -> u8 {
        (self.0.saturating_add(128) >> 8) as u8
    }

    /// The shade of an intensity on a ramp: `first + intensity·(entries − 1)`, rounded to the nearest 1/256, ties
    /// upward. NaN and everything below 0 count as 0, everything above 1 as 1.
    ///
    /// `entries` is 1 to 256 and `first + entries` at most 256 (a [`Ramp`](crate::palette::Ramp) ensures both); larger
    /// results saturate at 255.0.
    #[must_use]
    #[inline]
    pub fn from_intensity(intensity: f32, first: u8, entries: u16) -> Self {
        let units = f64::from(entries.saturating_sub(1)) * 256.0;
        // For NaN `max` returns the other operand, which `clamp` would not. The product of 24 and 16 bits is exact in
        // f64, and so is the sum with a half, unless the product is below 2⁻¹³, where the integer part is 0 either way.
        // `as` truncates.
        #[expect(clippy::manual_clamp, reason = "clamp keeps NaN")]
        let above = (f64::from(intensity.max(0.0).min(1.0)) * units + 0.5) as u32;
        let shade = u32::from(first) * 256 + above;
        Self(if shade > 0xFF00 { 0xFF00 } else { shade as u16 })
    }

    /// The shades of eight intensities on a ramp, each as computed by [`from_intensity`](Self::from_intensity). The
    /// compiler vectorises this form.
    #[cfg(feature = "alloc")]
    #[inline(always)]
    pub(crate) fn from_eight_intensities(intensities: &[f32; 8], first: u8, entries: u16) -> [Self; 8] {
        let units = f64::from(entries.saturating_sub(1)) * 256.0;
        let mut shades = [Self(0); 8];
        for (lane, shade) in shades.iter_mut().enumerate() {
            #[expect(clippy::manual_clamp, reason = "clamp keeps NaN")]
            let clamped = intensities[lane].max(0.0).min(1.0);
            let sum = i32::from(first) * 256 + whole_part(f64::from(clamped) * units + 0.5);
            // Both terms are at most 2¹⁶.
            *shade = Self(if sum > 0xFF00 { 0xFF00 } else { sum as u16 });
        }
        shades
    }
}

/// A 16.16 number, as in the Hungarian tutorial's integer vertex path, where unit vectors have
/// length 65,536.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub struct I16F16(i32);

impl I16F16 {
    /// 1.0.
    pub const ONE: Self = Self(65_536);

    /// Makes a number from units of 1/65,536.
    #[must_use]
    pub const fn from_bits(units: i32) -> Self {
        Self(units)
    }

    /// Returns the number in units of 1/65,536.
    #[must_use]
    pub const fn to_bits(self) -> i32 {
        self.0
    }

    /// Makes a number from an integer, −32,768 to 32,767.
    #[must_use]
    pub const fn from_int(whole: i16) -> Self {
        Self((whole as i32) << 16)
    }

    /// `floor(65,536·x + ½)`, or `None` if `x` is not finite or the result does not fit. The renderer calls it when it
    /// converts a mesh, and a few times per frame for the camera and the lights, never per vertex.
    #[must_use]
    pub fn round_from_f64(x: f64) -> Option<Self> {
        // Rounding 256·x to 1/256 rounds x to 1/65,536; the product is exact.
        I24F8::round_from_f64(x * 256.0).map(|units| Self(units.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_classical_half_below_is_not_rounded_up() {
        let just_below_half = 0.499_999_999_999_999_94_f64;
        assert_eq!((just_below_half + 0.5).floor(), 1.0, "what adding the half first would give");
        assert_eq!(I24F8::round_from_f64(just_below_half / 256.0), Some(I24F8(0)));
    }

    #[test]
    fn halves_go_up_on_both_sides_of_zero() {
        for (pixels, units) in [(0.5, 1), (-0.5, 0), (1.5, 2), (-1.5, -1), (-0.500_000_1, -1)] {
            assert_eq!(I24F8::round_from_f64(pixels / 256.0), Some(I24F8(units)), "{pixels}");
        }
        for tiny in [f64::MIN_POSITIVE, -f64::MIN_POSITIVE, 5e-324, -5e-324, -0.0, -1e-20] {
            assert_eq!(I24F8::round_from_f64(tiny), Some(I24F8(0)), "{tiny:e}");
        }
    }

    #[cfg(feature = "alloc")]
    #[test]
    fn the_whole_part_is_what_a_cast_truncates_to() {
        let mut tried = 0;
        let halves = (0..=4096_u32).map(|n| f64::from(n) / 2.0);
        let powers = (0..31).flat_map(|n| [f64::from(1_u32 << n), f64::from(1_u32 << n) + 0.5]);
        for x in halves.chain(powers).chain([f64::from(i32::MAX)]) {
            for x in [x.next_down(), x, x.next_up()] {
                if (0.0..2_147_483_648.0).contains(&x) {
                    assert_eq!(whole_part(x), x as i32, "{x:e}");
                    tried += 1;
                }
            }
        }
        assert!(tried > 12_000, "{tried}");
    }

    #[cfg(feature = "alloc")]
    #[test]
    fn eight_intensities_at_once_are_eight_intensities() {
        let all: alloc::vec::Vec<f32> = (0..=4096_u16)
            .map(|n| f32::from(n) / 4096.0)
            .flat_map(|x| [x.next_down(), x, x.next_up()])
            .chain([f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN_POSITIVE, -0.0, -1.0])
            .collect();
        // The last two do not fit, and saturate.
        for (first, entries) in [(0, 256), (0, 1), (16, 64), (255, 1), (192, 63), (1, 256), (255, 256)] {
            for eight in all.windows(8) {
                let eight: &[f32; 8] = eight.try_into().expect("eight");
                let expected = eight.map(|intensity| U8F8::from_intensity(intensity, first, entries));
                assert_eq!(U8F8::from_eight_intensities(eight, first, entries), expected, "{eight:?}");
            }
        }
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let (least, greatest) = (-8_388_608.0, 8_388_607.996_093_75);
        for (x, units) in [(least, i32::MIN), (least - 1.0 / 512.0, i32::MIN), (greatest, i32::MAX)] {
            assert_eq!(I24F8::round_from_f64(x), Some(I24F8(units)), "{x}");
            assert_eq!(I16F16::round_from_f64(x / 256.0), Some(I16F16(units)), "{x}");
        }
        for bad in [least - 1.0 / 256.0, greatest + 1.0 / 512.0] {
            assert_eq!(I24F8::round_from_f64(bad), None, "{bad}");
        }
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, 8_388_608.0, -8_388_609.0] {
            assert_eq!(I24F8::round_from_f64(bad), None, "{bad}");
        }
    }

    #[test]
    fn intensity_covers_the_ramp_and_never_leaves_it() {
        for entries in 1..=256_u16 {
            let first = (256 - entries).min(255) as u8;
            assert_eq!(U8F8::from_intensity(0.0, first, entries).to_bits(), u16::from(first) << 8);
            for odd in [1.0, 2.0, f32::INFINITY, f32::MAX] {
                assert_eq!(U8F8::from_intensity(odd, first, entries).nearest(), 255);
            }
            for odd in [f32::NAN, -1.0, f32::NEG_INFINITY] {
                assert_eq!(U8F8::from_intensity(odd, first, entries).nearest(), first);
            }
        }
    }
}
