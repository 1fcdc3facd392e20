//! Images on surfaces (to be replaced at the next merge).

use alloc::vec::Vec;

use crate::palette::Rgb;

/// An 8-bit image.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    width_bits: u32,
    height_bits: u32,
    texels: Vec<u8>,
    colors: [Rgb; 256],
}

impl Texture {
    /// By name.
    #[must_use]
    pub fn by_name(_name: &str) -> Option<Self> {
        None
    }
    /// Row-major.
    #[must_use]
    pub fn texels(&self) -> &[u8] {
        &self.texels
    }
    /// log2.
    #[must_use]
    pub fn width_bits(&self) -> u32 {
        self.width_bits
    }
    /// log2.
    #[must_use]
    pub fn height_bits(&self) -> u32 {
        self.height_bits
    }
    /// Colours.
    #[must_use]
    pub fn colors(&self) -> &[Rgb; 256] {
        &self.colors
    }
}
