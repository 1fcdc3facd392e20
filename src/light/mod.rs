//! Lights, materials, and the intensity at a vertex or a pixel.
//!
//! The model is that of the Russian article, for each channel:
//!
//! ```text
//! I = ka·Ia + Σ over lights of (kd·max(0, n·l) + ks·max(0, r·v)^s) · Id · fall-off
//! ```
//!
//! A lamp falls off with the distance, a spot light also towards the edge of its [`Cone`].
//!
//! n is the unit normal, l points to the light, v to the eye, and r = 2·(n·l)·n − l is l mirrored about the normal. A
//! light behind a face adds nothing, never a negative amount. The sum is clamped once, after all lights, as in the
//! Russian article: several lights together may reach full intensity where one alone would not. Intensities are DAC
//! values without gamma correction, as was usual then.

// | file | what |
// |---|---|
// | `source` | `Light`: suns, lamps with a position and a fall-off (the Russian textbook), and spot lights |
// | `material` | `Material`: how a surface responds to light |
// | `intensity` | the sum |
// | `lanes` | the same at eight points at a time |
// | `power` | how narrow a highlight is |

mod intensity;
mod lanes;
mod material;
mod power;
mod response;
mod source;

pub(crate) use intensity::{ConeBeam, LampBeam, Lights, Reflectance, SunBeam, both_sides, lamp_reaches};
pub use material::{Blend, Material, RampChoice};
pub use response::LightResponse;
pub use source::{Cone, Light};
