//! One colour, and the way between its 8 bits and the DAC's 6.

/// A colour of 8 bits a channel.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub struct Rgb {
    /// Red, 0 to 255.
    pub r: u8,
    /// Green, 0 to 255.
    pub g: u8,
    /// Blue, 0 to 255.
    pub b: u8,
}

/// 6 bits to 8: `(v << 2) | (v >> 4)`, so that 0 stays 0 and 63 becomes 255. Bits above the sixth
/// are dropped, as the DAC drops them.
#[must_use]
#[inline]
pub const fn expand(six: u8) -> u8 {
    let v = six & 63;
    (v << 2) | (v >> 4)
}

/// 8 bits to 6: `v >> 2`, rounded down. [`expand`] undoes it for every value that `expand` makes.
#[must_use]
#[inline]
pub const fn reduce(eight: u8) -> u8 {
    eight >> 2
}

impl Rgb {
    /// 0, 0, 0.
    pub const BLACK: Self = Self::new(0, 0, 0);
    /// 255, 255, 255.
    pub const WHITE: Self = Self::new(255, 255, 255);

    /// From red, green and blue, 0 to 255 each.
    #[must_use]
    #[inline]
    pub const fn new(r: u8, g: u8, b: u8) -> Self {
        Self { r, g, b }
    }

    /// From the DAC's red, green and blue, 0 to 63 each; higher bits are dropped.
    #[must_use]
    #[inline]
    pub const fn from_dac(six: [u8; 3]) -> Self {
        Self::new(expand(six[0]), expand(six[1]), expand(six[2]))
    }

    /// The DAC's red, green and blue, 0 to 63 each, rounded down.
    #[must_use]
    #[inline]
    pub const fn to_dac(self) -> [u8; 3] {
        [reduce(self.r), reduce(self.g), reduce(self.b)]
    }

    /// The colour that the card shows for this one: through 6 bits and back.
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

    /// From `0x00RRGGBB`; the top byte is dropped.
    #[must_use]
    #[inline]
    pub const fn from_u32(rgb: u32) -> Self {
        let [_, r, g, b] = rgb.to_be_bytes();
        Self::new(r, g, b)
    }

    /// As `0x00RRGGBB`.
    #[must_use]
    #[inline]
    pub const fn to_u32(self) -> u32 {
        u32::from_be_bytes([0, self.r, self.g, self.b])
    }

    /// As 5 bits of red, 6 of green, 5 of blue, red on top: the form of most small displays. Each
    /// channel is rounded down.
    #[must_use]
    #[inline]
    pub const fn to_rgb565(self) -> u16 {
        ((self.r as u16 >> 3) << 11) | ((self.g as u16 >> 2) << 5) | (self.b as u16 >> 3)
    }

    /// Brightness, 0 to 255,000: 299 red + 587 green + 114 blue, the weights of ITU-R BT.601 in
    /// thousandths. Exact; for putting colours in order.
    #[must_use]
    #[inline]
    pub const fn brightness(self) -> u32 {
        299 * self.r as u32 + 587 * self.g as u32 + 114 * self.b as u32
    }

    /// The square of the distance to `other` in the RGB cube, 0 to 195,075.
    #[must_use]
    #[inline]
    pub const fn distance_squared(self, other: Self) -> u32 {
        let r = self.r.abs_diff(other.r) as u32;
        let g = self.g.abs_diff(other.g) as u32;
        let b = self.b.abs_diff(other.b) as u32;
        r * r + g * g + b * b
    }
}
