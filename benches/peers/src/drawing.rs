//! The kinds of drawing compared, with the tables and the image that all candidates share.

/// How a triangle's pixels are drawn.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Drawing {
    /// One shade per triangle: its first vertex's.
    Flat,
    /// Shades linear on the screen.
    Gouraud,
    /// Shades linear on the screen, with a depth buffer.
    GouraudDepth,
    /// An image, linear on the screen.
    Affine,
    /// An image, linear on the screen, each texel looked up by its shade.
    AffineLit,
    /// An image, linear on the face.
    Perspective,
    /// An image, linear on the face, each texel looked up by its shade.
    PerspectiveLit,
    /// An image, linear on the face, with a depth buffer.
    PerspectiveDepth,
    /// An image, linear on the screen, blended with what is behind it.
    Translucent,
}

impl Drawing {
    pub const ALL: [Self; 9] = [
        Self::Gouraud,
        Self::Flat,
        Self::GouraudDepth,
        Self::Affine,
        Self::AffineLit,
        Self::Perspective,
        Self::PerspectiveLit,
        Self::PerspectiveDepth,
        Self::Translucent,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Gouraud => "Gouraud",
            Self::GouraudDepth => "Gouraud, depth",
            Self::Affine => "affine texture",
            Self::AffineLit => "affine texture, lit",
            Self::Perspective => "perspective texture",
            Self::PerspectiveLit => "perspective texture, lit",
            Self::PerspectiveDepth => "perspective texture, depth",
            Self::Translucent => "affine texture, translucent",
        }
    }

    pub fn has_texture(self) -> bool {
        !matches!(self, Self::Flat | Self::Gouraud | Self::GouraudDepth)
    }

    pub fn is_lit(self) -> bool {
        matches!(self, Self::Gouraud | Self::GouraudDepth | Self::AffineLit | Self::PerspectiveLit)
    }

    pub fn is_perspective(self) -> bool {
        matches!(self, Self::Perspective | Self::PerspectiveLit | Self::PerspectiveDepth)
    }

    pub fn has_depth(self) -> bool {
        matches!(self, Self::GouraudDepth | Self::PerspectiveDepth)
    }
}

/// Side of the image in texels, as a power of two.
pub const SIDE_BITS: u32 = 6;
const SIDE: usize = 1 << SIDE_BITS;

/// The image, and tables of 256 rows and columns.
pub struct Material {
    /// Row-major. Squares of 8 texels, so that a coordinate that is off by a texel rarely shows.
    pub texels: Vec<u8>,
    /// The texel, whatever the shade.
    pub plain: Box<[u8; 65_536]>,
    /// The byte for a shade (row) and a texel (column).
    pub lit: Box<[u8; 65_536]>,
    /// The byte for the triangle's own (row) and the frame's (column), half of each.
    pub mixed: Box<[u8; 65_536]>,
}

impl Material {
    pub fn new() -> Self {
        let square = |x: usize, y: usize| 64 + ((x / 8 * 5 + y / 8 * 3) % 8 * 24) as u8;
        Self {
            texels: (0..SIDE * SIDE).map(|i| square(i % SIDE, i / SIDE)).collect(),
            plain: table(|_, texel| texel),
            lit: table(|shade, texel| (shade * texel + 127) / 255),
            mixed: table(|own, there| (own + there).div_ceil(2)),
        }
    }

    /// The table through which a drawing looks up texels.
    pub fn table(&self, drawing: Drawing) -> &[u8; 65_536] {
        if drawing.is_lit() { &self.lit } else { &self.plain }
    }
}

fn table(byte: impl Fn(usize, usize) -> usize) -> Box<[u8; 65_536]> {
    let bytes: Vec<u8> = (0..65_536).map(|i| byte(i >> 8, i & 255) as u8).collect();
    bytes.into_boxed_slice().try_into().expect("256 rows of 256")
}
