//! The engine's internals, for the lab, the conformance crate, tests and benchmarks: what drew each
//! pixel, one triangle at a time; renderer settings that no game needs; the span loops, and the
//! stages of the raster.
//!
//! They may change in any version.

/// Makes modules that re-export the public items of those with the same names.
macro_rules! modules {
    ($room:ident: $($(#[$meta:meta])* $module:ident)*) => {
        $($(#[$meta])* pub mod $module { pub use crate::$room::$module::*; })*
    };
    ($room:ident::$part:ident: $($(#[$meta:meta])* $module:ident)*) => {
        $($(#[$meta])* pub mod $module { pub use crate::$room::$part::$module::*; })*
    };
}

/// Whether the target has IEEE double precision in hardware.
pub const HAS_F64: bool = crate::fixed::HAS_F64;

/// Eight values at a time.
pub mod lanes {
    pub use crate::lanes::*;
}

/// The span loops and their specifications.
pub mod span {
    pub use crate::span::lookup::lookup;

    modules! { span:
        /// Conversion of red, green and blue to a palette index.
        channels
        /// Quadratic shades.
        curve
        /// Depth-tested spans.
        depth
        /// Ordered dithering.
        dither
        /// Spans in 16.16.
        fixed16
        /// Perspective-correct shades in f32.
        float
        /// Perspective-correct shades in integers.
        hyperbolic
        /// A list of spans.
        listed
        /// Normals and positions for Phong shading.
        lit
        /// Rows of texels.
        texture
        /// The raw entry points of the assembly.
        #[cfg(any(asm_x86_64, asm_i686))]
        entry
    }
}

/// The stages of the raster.
pub mod raster {

    modules! { raster:
        /// Clipping of triangles.
        clip
        /// Which pixels belong to a triangle.
        fill_rule
        /// Stages over spans: texture, fog, channels, blending, dithering, per-pixel light.
        effects
        /// The scan-line method.
        scan_line
    }

    /// One triangle in integers.
    pub mod reference {
        modules! { raster::reference:
            /// The pixels of a triangle.
            cover
            /// The depth at a pixel.
            depth
            /// The shade at a pixel.
            shade
            /// Exact floor division with one reciprocal per divisor.
            quotient
        }
    }
}

use crate::light::Light;
use crate::mesh::Mesh;
pub use crate::plan::reason::name_of;
pub use crate::raster::shade_trace::{Accumulator, Progression, Ratio, ShadeTrace, row_of};
pub use crate::render::each_triangle::{DrawnEffects, DrawnTriangle, each_triangle, make_vertices, show_channel};
pub use crate::render::integer_frame::{IntegerFrame, integer_frame};
pub use crate::scene::object::{turn, with_mesh};
use crate::scene::{Object, Scene, Shared};

/// The mesh of an object, to be stored or compared by address.
#[must_use]
pub fn shared_mesh(object: &Object) -> &Shared<Mesh> {
    object.shared_mesh()
}

/// Checks a light.
///
/// # Errors
/// A one-line message that says what is wrong.
pub fn check_light(light: &Light) -> Result<(), &'static str> {
    light.check()
}

/// Checks an object, by its index.
///
/// # Errors
/// A one-line message that says what is wrong.
pub fn check_object(scene: &Scene, index: usize) -> Result<(), &'static str> {
    scene.objects().get(index).map_or(Ok(()), Object::check)?;
    scene.check_parents(index)
}
