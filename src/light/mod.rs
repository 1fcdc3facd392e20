//! Lights, materials, and the intensity at a vertex or a pixel.
//!
//! From the Russian article, for each channel:
//!
//! ```text
//! I = ka·Ia + Σ over lights of (kd·max(0, n·l) + ks·max(0, r·v)^s) · Id · fall-off
//! ```
//!
//! A lamp falls off with the distance, a spot light also towards the edge of its [`Cone`].
//!
//! n is the unit normal, l points to the light, v to the eye, r = 2·(n·l)·n − l is l mirrored at the
//! surface. A light behind a face adds nothing, never a negative amount. The sum is clamped once, at
//! its end: the Russian article clamps each component after summing, and so several lights together may fill what one
//! alone would not. Intensities are values of the DAC, with no gamma, as they were then.
//!
//! | file | what |
//! |---|---|
//! | `source` | [`Light`]: suns, lamps with a position and a fall-off (the Russian textbook), and spot lights |
//! | `material` | [`Material`]: what a surface answers |
//! | `intensity` | the sum |
//! | `lanes` | the same at eight points at a time |
//! | `power` | how narrow a highlight is |

mod intensity;
mod lanes;
mod material;
mod power;
mod response;
mod source;

pub(crate) use intensity::{Beam, ConeBeam, LampBeam, Lights, Reflectance, both_sides, lamp_reaches, widen};
pub use material::{Blend, Material, RampChoice};
pub use response::LightResponse;
pub use source::{Cone, Light};
