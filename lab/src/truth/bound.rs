//! Bounds of a shading's error.

use super::Standard;
use mode13h::settings::Shading;

/// Bound of a shading's error against a standard.
///
/// | shading | standard | off by at most, in shades | of which beyond the byte's ½ and the vertices' 1/512 |
/// |---|---|---|---|
/// | `flat` | – | – | one shade of its own: see below |
/// | `gouraud-vintage` | – | – | other vertices, other cover |
/// | `gouraud-8.8` | `gouraud` | ½ + 1/512 + w/256 in a frame of w columns: 1.75 of 320 | start and steps, each less than 1/256 |
/// | `gouraud-8.8-reseeded` | `gouraud` | ½ + 1/512 + ¼ | the same over 64 pixels |
/// | `gouraud-16.16` | `gouraud` | ½ + 1/512 + w/65,536 | start and steps, each less than 1/65,536 |
/// | `gouraud-hyperbolic` | `gouraud-perspective` | ½ + 1/512 + 1/256 | depths rounded to 2⁻³⁰ of the nearest |
/// | `gouraud-tessellated` | – | – | edges are split by an estimate, six times at most; faces inside by none |
/// | `phong-table` | – | – | normals linear on the screen and in 256 steps, lamps as suns, the eye far away |
/// | `phong` | `lit` | ½ + 1/512 + 1/100 | f32 of normals and positions |
/// | `gouraud-float` | `gouraud-perspective` | ½ + 1/512 + 1/256 + 1/8,192 | and f32 |
///
/// A vertex's shade is rounded to 1/256, so by 1/512; what is made from it is a mean of three, and no farther off. The
/// rest is what the raster adds ([`Interpolation`](mode13h::raster::Interpolation)). A depth is rounded to half of 2⁻³⁰·near/w's unit: of
/// w up to 4,096 times the near distance that is 2⁻¹⁹ of it, either way, and a quotient of sums that are off by so
/// much is off by 2⁻¹⁸ of 255 shades: 1/1,000, and less than 1/256 up to 10,000 times.
///
/// This holds for the vertices as the truth has them. The engine's vertices come from f32, so that one coordinate of a
/// hundred is rounded to the unit of 1/256 pixel beside the right one, and where a face is clipped new corners are
/// rounded: a pixel of such a face may be off by the change of the face's shades over 1/256 pixel more.
///
/// A flat face has the model's shade at its middle, by its own normal, to ½ + 1/512 + 1/100. It may be any shade away
/// from its corners' shades. Other shadings without a bound are measured.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Bound {
    /// Standard that it should meet.
    pub standard: Standard,
    /// Greatest error of a shade.
    pub shades: f64,
}

impl Bound {
    /// The bound of a shading in a frame of `width` columns; `None` if the shading claims none.
    ///
    /// ```
    /// use mode13h::settings::Shading;
    /// use mode13h_lab::truth::{Bound, Standard};
    ///
    /// let bound = Bound::of(Shading::Gouraud88Reseeded, 320).expect("it claims one");
    /// assert!(bound.standard == Standard::Gouraud && bound.shades < 1.0);
    /// assert_eq!(Bound::of(Shading::GouraudVintage, 320), None);
    /// ```
    #[must_use]
    pub fn of(shading: Shading, width: u32) -> Option<Self> {
        const ROUNDING: f64 = 0.5 + 1.0 / 512.0;
        const DEPTHS: f64 = 1.0 / 256.0;

        let width = f64::from(width);
        let (standard, more) = match shading {
            Shading::Gouraud88 => (Standard::Gouraud, width / 256.0),
            Shading::Gouraud88Reseeded => (Standard::Gouraud, 0.25),
            Shading::Gouraud1616 => (Standard::Gouraud, width / 65_536.0),
            Shading::GouraudHyperbolic => (Standard::GouraudPerspective, DEPTHS),
            Shading::Float => (Standard::GouraudPerspective, DEPTHS + 1.0 / 8_192.0),
            Shading::Phong => (Standard::Lit, 0.01),
            // The others claim none.
            _ => return None,
        };
        Some(Self { standard, shades: ROUNDING + more })
    }
}
