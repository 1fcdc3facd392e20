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

use alloc::vec::Vec;

use crate::light::{Light, Material};
use crate::mesh::Mesh;
pub use crate::plan::reason::name_of;
pub use crate::raster::shade_trace::{Accumulator, Progression, Ratio, ShadeTrace, row_of};
pub use crate::render::each_triangle::{DrawnEffects, DrawnTriangle};
pub use crate::render::integer_frame::IntegerFrame;
use crate::render::{RenderError, Renderer, Screen, Stats};
pub use crate::scene::object::turn;
use crate::scene::{Object, Scene, Shared};

/// Calls `visit` for every triangle that [`Renderer::draw`] would draw, in the order of
/// [`Renderer::for_each_triangle`], with everything that the raster would receive. Returns the work counts, except
/// those of the raster. Nothing is drawn, and later frames are unaffected.
///
/// # Errors
/// The errors of [`Renderer::draw`], before the first triangle.
pub fn each_triangle(
    renderer: &mut Renderer,
    scene: &Scene,
    screen: Screen,
    visit: &mut dyn FnMut(&DrawnTriangle<'_>),
) -> Result<Stats, RenderError> {
    renderer.each_triangle(scene, screen, visit)
}

/// Computes the plan and the vertices of a frame without drawing it.
///
/// # Errors
/// The errors of [`Renderer::draw`].
pub fn make_vertices(renderer: &mut Renderer, scene: &Scene, screen: Screen) -> Result<(), RenderError> {
    renderer.make_vertices(scene, screen)
}

/// Prepares a frame for the 16.16 path without drawing it, stores it in the renderer and returns its numbers.
///
/// # Errors
/// The errors of [`Renderer::draw`].
pub fn integer_frame<'a>(
    renderer: &'a mut Renderer,
    scene: &'a Scene,
    screen: Screen,
) -> Result<IntegerFrame<'a>, RenderError> {
    renderer.integer_frame(scene, screen)
}

/// Shows the shades of one channel (0 red, 1 green, 2 blue) instead of combining all three into a
/// palette entry; `None`, the default, combines them.
pub fn show_channel(renderer: &mut Renderer, channel: Option<usize>) {
    renderer.show_channel(channel);
}

/// The mesh of an object, to be stored or compared by address.
#[must_use]
pub fn shared_mesh(object: &Object) -> &Shared<Mesh> {
    object.shared_mesh()
}

/// Copies an object with another mesh and a material for each of its surfaces. No vertex of the
/// mesh may be shared by two surfaces.
#[must_use]
pub fn with_mesh(object: &Object, mesh: Shared<Mesh>, materials: Vec<Material>) -> Object {
    object.with_mesh(mesh, materials)
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
