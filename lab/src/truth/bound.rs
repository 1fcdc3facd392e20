//! Bounds on a shading's error.

use super::Standard;
use mode13h::settings::Shading;

/// Bound on a shading's error against a standard.
///
/// | shading | standard | largest error, in shades | sources beyond the byte's ½ and the vertices' 1/512 |
/// |---|---|---|---|
/// | `flat` | – | – | has one shade of its own: see below |
/// | `gouraud-vintage` | – | – | different vertices, different coverage |
/// | `gouraud-8.8` | `gouraud` | ½ + 1/512 + w/256 in a frame of w columns: 1.75 for 320 | start and steps, each less than 1/256 |
/// | `gouraud-8.8-reseeded` | `gouraud` | ½ + 1/512 + ¼ | the same over 64 pixels |
/// | `gouraud-16.16` | `gouraud` | ½ + 1/512 + w/65,536 | start and steps, each less than 1/65,536 |
/// | `gouraud-hyperbolic` | `gouraud-perspective` | ½ + 1/512 + 1/256 | depths rounded to 2⁻³⁰ of the nearest |
/// | `gouraud-tessellated` | – | – | edges are split by an estimate, at most six times; nothing estimates the inside of a face |
/// | `phong-table` | – | – | normals linear on the screen and in 256 steps, lamps as suns, the eye far away |
/// | `phong` | `lit` | ½ + 1/512 + 1/100 | normals and positions in f32 |
/// | `gouraud-float` | `gouraud-perspective` | ½ + 1/512 + 1/256 + 1/8,192 | the same, and f32 |
///
/// A vertex's shade is rounded to 1/256, so it is off by 1/512; a shade interpolated from vertices is a weighted mean
/// of three, and no farther off. The rasterizer adds the rest ([`Interpolation`](mode13h::raster::Interpolation)). A
/// depth is rounded to half a unit of 2⁻³⁰·near/w: for w up to 4,096 times the near distance that is a relative error
/// of 2⁻¹⁹, and a quotient of sums with that error is off by 2⁻¹⁸ of 255 shades: 1/1,000, and less than 1/256 up to
/// 10,000 times the near distance.
///
/// This holds for the truth's vertices. The engine's vertices come from f32, so one coordinate in a hundred is rounded
/// to the 1/256 pixel next to the right one, and where a face is clipped the new corners are rounded. A pixel of such a
/// face may be off by as much more as the face's shades change over 1/256 pixel.
///
/// A flat face has the model's shade at its middle, with its own normal, to within ½ + 1/512 + 1/100. It may differ
/// from its corners' shades by any amount. Other shadings without a bound are measured.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Bound {
    /// Standard that the shading should meet.
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
            Shading::GouraudFloat => (Standard::GouraudPerspective, DEPTHS + 1.0 / 8_192.0),
            Shading::Phong => (Standard::Lit, 0.01),
            // The others claim none.
            _ => return None,
        };
        Some(Self { standard, shades: ROUNDING + more })
    }
}
