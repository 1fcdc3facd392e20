//! Colours, and the conversion between their 8 bits and the DAC's 6.

use core::fmt;

/// A colour with 8 bits per channel.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub struct Rgb {
    /// Red, 0 to 255.
    pub r: u8,
    /// Green, 0 to 255.
    pub g: u8,
    /// Blue, 0 to 255.
    pub b: u8,
}

/// Expands 6 bits to 8: `(v << 2) | (v >> 4)`, so that 0 stays 0 and 63 becomes 255. Bits above the sixth are dropped,
/// as in the DAC.
#[must_use]
#[inline]
pub const fn dac6_to_8(six: u8) -> u8 {
    let v = six & 63;
    (v << 2) | (v >> 4)
}

/// Reduces 8 bits to 6: `v >> 2`, rounded down. It inverts [`dac6_to_8`] for every value that `dac6_to_8` produces.
#[must_use]
#[inline]
pub const fn to_dac6(eight: u8) -> u8 {
    eight >> 2
}

/// The 6 bits whose [`dac6_to_8`] is nearest. `dac6_to_8` differs from `255·six/63` by at most a half, so that is the
/// nearest to `63·v/255`; `p1_every_colour_has_a_nearest_one_on_the_dac` tests all values.
const fn nearest_six(v: u8) -> u8 {
    // At most 63.
    ((v as u16 * 63 + 127) / 255) as u8
}

/// The result is between `a` and `b`, so it fits in 8 bits; the sums stay below 2¹⁷.
const fn mix(a: u8, b: u8, share: u8) -> u8 {
    ((a as u32 * (255 - share as u32) + b as u32 * share as u32 + 127) / 255) as u8
}

/// Unpacks `0x00RRGGBB`; the top byte is dropped.
impl From<u32> for Rgb {
    #[inline]
    fn from(rgb: u32) -> Self {
        Self::from_u32(rgb)
    }
}

/// Writes six digits with `{:06x}`.
impl fmt::LowerHex for Rgb {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::LowerHex::fmt(&self.to_u32(), f)
    }
}

/// Packs the colour as `0x00RRGGBB`.
impl From<Rgb> for u32 {
    #[inline]
    fn from(color: Rgb) -> Self {
        color.to_u32()
    }
}

impl Rgb {
    /// 0, 0, 0.
    pub const BLACK: Self = Self::new(0, 0, 0);
    /// 255, 255, 255.
    pub const WHITE: Self = Self::new(255, 255, 255);

    /// Makes a colour from red, green and blue, 0 to 255 each.
    #[must_use]
    #[inline]
    pub const fn new(r: u8, g: u8, b: u8) -> Self {
        Self { r, g, b }
    }

    /// Makes a colour from intensities, usually 0 to 1: each channel rounded to the nearest of 0 to 255. Values below 0
    /// and NaN count as 0, values above 1 as 1.
    #[must_use]
    pub const fn from_intensities(intensities: [f32; 3]) -> Self {
        let [r, g, b] = intensities;
        // `as` truncates, saturates to 0 to 255, and gives 0 for NaN.
        Self::new((r * 255.0 + 0.5) as u8, (g * 255.0 + 0.5) as u8, (b * 255.0 + 0.5) as u8)
    }

    /// Makes a colour from the DAC's red, green and blue, 0 to 63 each; higher bits are dropped.
    #[must_use]
    #[inline]
    pub const fn from_dac(six: [u8; 3]) -> Self {
        Self::new(dac6_to_8(six[0]), dac6_to_8(six[1]), dac6_to_8(six[2]))
    }

    /// The DAC's red, green and blue, 0 to 63 each, rounded down.
    #[must_use]
    #[inline]
    pub const fn to_dac(self) -> [u8; 3] {
        [to_dac6(self.r), to_dac6(self.g), to_dac6(self.b)]
    }

    /// The colour that the card shows for this one: reduced to 6 bits and expanded again.
    ///
    /// ```
    /// use mode13h::palette::Rgb;
    /// assert_eq!(Rgb::new(200, 101, 255).on_dac(), Rgb::new(203, 101, 255));
    /// ```
    #[must_use]
    #[inline]
    pub const fn on_dac(self) -> Self {
        Self::from_dac(self.to_dac())
    }

    /// The colour nearest to this one that the card can show. Given this one itself, the card shows
    /// [`on_dac`](Self::on_dac), which may be a step darker.
    ///
    /// ```
    /// use mode13h::palette::Rgb;
    /// let color = Rgb::new(3, 254, 100);
    /// assert_eq!(color.nearest_on_dac(), Rgb::new(4, 255, 101));
    /// assert_eq!(color.on_dac(), Rgb::new(0, 255, 101));
    /// ```
    #[must_use]
    pub const fn nearest_on_dac(self) -> Self {
        Self::from_dac([nearest_six(self.r), nearest_six(self.g), nearest_six(self.b)])
    }

    /// Interpolates towards `other`: 0 is this colour, 255 the other. Each channel is `(a·(255 − share) + b·share) /
    /// 255`, rounded to the nearest; ties cannot occur.
    ///
    /// ```
    /// use mode13h::palette::Rgb;
    /// assert_eq!(Rgb::new(0, 100, 255).mix(Rgb::new(255, 0, 255), 51), Rgb::new(51, 80, 255));
    /// ```
    #[must_use]
    #[inline]
    pub const fn mix(self, other: Self, share: u8) -> Self {
        Self::new(mix(self.r, other.r, share), mix(self.g, other.g, share), mix(self.b, other.b, share))
    }

    /// This colour in light, or on a surface, of the other colour: `a·b/255` per channel, rounded to the nearest.
    #[must_use]
    #[inline]
    pub const fn modulate(self, other: Self) -> Self {
        Self::new(mix(0, self.r, other.r), mix(0, self.g, other.g), mix(0, self.b, other.b))
    }

    /// The sum of two colours, each channel at most 255.
    #[must_use]
    #[inline]
    pub const fn saturating_add(self, other: Self) -> Self {
        Self::new(self.r.saturating_add(other.r), self.g.saturating_add(other.g), self.b.saturating_add(other.b))
    }

    /// Makes a colour from `0x00RRGGBB`; the top byte is dropped.
    #[must_use]
    #[inline]
    pub(crate) const fn from_u32(rgb: u32) -> Self {
        let [_, r, g, b] = rgb.to_be_bytes();
        Self::new(r, g, b)
    }

    /// Packs the colour as `0x00RRGGBB`.
    #[must_use]
    #[inline]
    pub(crate) const fn to_u32(self) -> u32 {
        u32::from_be_bytes([0, self.r, self.g, self.b])
    }

    /// Packs the colour into 16 bits: 5 of red, 6 of green, 5 of blue, red on top.
    ///
    /// Most small displays use this format. Each channel is rounded down.
    #[must_use]
    #[inline]
    pub const fn to_rgb565(self) -> u16 {
        ((self.r as u16 >> 3) << 11) | ((self.g as u16 >> 2) << 5) | (self.b as u16 >> 3)
    }

    /// Brightness, 0 to 255,000: 299 red + 587 green + 114 blue, the weights of ITU-R BT.601 in thousandths. Exact, for
    /// sorting colours.
    #[must_use]
    #[inline]
    pub const fn brightness(self) -> u32 {
        299 * self.r as u32 + 587 * self.g as u32 + 114 * self.b as u32
    }

    /// The squared distance to `other` in the RGB cube, 0 to 195,075.
    #[must_use]
    #[inline]
    pub const fn distance_squared(self, other: Self) -> u32 {
        let r = self.r.abs_diff(other.r) as u32;
        let g = self.g.abs_diff(other.g) as u32;
        let b = self.b.abs_diff(other.b) as u32;
        r * r + g * g + b * b
    }
}

/// Red, green and blue of a light or a surface, 0 to 1: each channel divided by 255.
///
/// ```
/// use mode13h::palette::Rgb;
/// assert_eq!(<[f32; 3]>::from(Rgb::new(255, 51, 0)), [1.0, 0.2, 0.0]);
/// ```
impl From<Rgb> for [f32; 3] {
    // Inlined, so that on a processor without floating point only callers pay for it.
    #[inline]
    fn from(Rgb { r, g, b }: Rgb) -> Self {
        [r, g, b].map(|channel| f32::from(channel) / 255.0)
    }
}
