//! Interpolation of shades over a triangle.

use crate::fixed::IS_SMALL;

/// Interpolation of shades over the pixels of a triangle.
///
/// Interpolations between vertices are named after the [`Shading`](crate::settings::Shading) that they draw:
///
/// | interpolation | differs from exact, in shades, by less than |
/// |---|---|
/// | `GouraudVintage` | – (it starts from other vertices) |
/// | `Gouraud88` | ½ + w/256 over a row of w pixels: 1.75 over 320 |
/// | `Gouraud88Reseeded`, the default | ½ + ¼ |
/// | `Gouraud1616` | ½ + w/65,536: 0.505 over 320 |
/// | `GouraudHyperbolic` | ½, or at a tie exactly ½ |
/// | `GouraudFloat` | ½ + 1/8,192 |
///
/// The exact shade is linear on the screen, and for the last two linear on the face.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
#[non_exhaustive]
pub enum Interpolation {
    /// One byte for the whole triangle; the shades of the vertices are ignored.
    Flat(u8),
    /// Gouraud's shading as the sources print it: vertices on whole pixels, slopes and steps truncated, no half added.
    ///
    /// Its coverage is not exact. Where another method determines the pixels, it contributes only the shades.
    GouraudVintage,
    /// Linear between the vertices, each row of the triangle one span: the start is exact, with one addition per pixel
    /// from there on.
    Gouraud88,
    /// Linear between the vertices, each row of the triangle reseeded every 64 pixels.
    ///
    /// Each start is exact, with one addition per pixel from there on.
    #[default]
    Gouraud88Reseeded,
    /// Linear between the vertices in 16.16, each row of the triangle one span.
    Gouraud1616,
    /// Linear on the face in space, so perspective-correct: one quotient per pixel, the shade nearest to exact. It uses
    /// the depths of the vertices as 1/w.
    GouraudHyperbolic,
    /// Linear on the face in space, computed in f32: shade/w and 1/w are linear, with one division per pixel.
    ///
    /// It exists only with an allocator, so that the raster of a microcontroller without floating point links no
    /// routine for it.
    #[cfg(feature = "alloc")]
    GouraudFloat,
}

impl Interpolation {
    /// All interpolations between the vertices.
    pub const INTERPOLATED: &[Self] = &[
        Self::GouraudVintage,
        Self::Gouraud88,
        Self::Gouraud88Reseeded,
        Self::Gouraud1616,
        Self::GouraudHyperbolic,
        #[cfg(feature = "alloc")]
        Self::GouraudFloat,
    ];

    /// The name, for messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Flat(_) => "flat",
            Self::GouraudVintage => "gouraud-vintage",
            Self::Gouraud88 => "gouraud-8.8",
            Self::Gouraud88Reseeded => "gouraud-8.8-reseeded",
            Self::Gouraud1616 => "gouraud-16.16",
            Self::GouraudHyperbolic => "gouraud-hyperbolic",
            #[cfg(feature = "alloc")]
            Self::GouraudFloat => "gouraud-float",
        }
    }

    /// Returns whether a pixel is drawn if and only if its centre is in the triangle, and its byte lies within
    /// `[(min + 128) >> 8, (max + 128) >> 8]` of the vertices' shades.
    #[must_use]
    pub const fn has_exact_cover(self) -> bool {
        // Known to the compiler where there is no other.
        IS_SMALL || !matches!(self, Self::GouraudVintage)
    }

    /// Returns whether shades are linear on the face in space rather than on the screen.
    #[must_use]
    pub const fn is_linear_on_the_face(self) -> bool {
        match self {
            Self::GouraudHyperbolic => true,
            #[cfg(feature = "alloc")]
            Self::GouraudFloat => true,
            _ => false,
        }
    }
}
