//! PNG files as their decoder reads them.

use mode13h::palette::Rgb;

/// A PNG of eight bits, decoded.
#[derive(Clone, PartialEq, Debug)]
pub struct Png {
    pub size: (u32, u32),
    pub kind: png::ColorType,
    /// Pixels per unit, across and down; the unit is unspecified.
    pub density: Option<(u32, u32)>,
    /// The bytes as the file has them.
    pub pixels: Vec<u8>,
    /// Empty if it has none.
    pub palette: Vec<Rgb>,
}

impl Png {
    #[track_caller]
    pub fn decode(png: &[u8]) -> Self {
        let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().expect("a PNG");
        let mut pixels = vec![0; reader.output_buffer_size().expect("its size")];
        assert_eq!(reader.next_frame(&mut pixels).expect("an image").bit_depth, png::BitDepth::Eight);
        reader.finish().expect("its end");
        let info = reader.info();
        assert!(info.pixel_dims.is_none_or(|dims| matches!(dims.unit, png::Unit::Unspecified)));
        let palette = info.palette.as_deref().unwrap_or_default();
        Self {
            size: (info.width, info.height),
            kind: info.color_type,
            density: info.pixel_dims.map(|dims| (dims.xppu, dims.yppu)),
            palette: palette.chunks_exact(3).map(|c| Rgb::new(c[0], c[1], c[2])).collect(),
            pixels,
        }
    }

    /// Size, colour type and density.
    pub fn shape(&self) -> ((u32, u32), png::ColorType, Option<(u32, u32)>) {
        (self.size, self.kind, self.density)
    }

    /// The colours of an indexed picture, pixel by pixel.
    pub fn colors(&self) -> Vec<Rgb> {
        self.pixels.iter().map(|&index| self.palette[usize::from(index)]).collect()
    }
}
