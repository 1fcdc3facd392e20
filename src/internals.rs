//! The inside of the engine, for the laboratory, the conformance crate, tests and benchmarks: what drew each pixel, one
//! triangle at a time; settings of a renderer that no game needs; the loops over spans, and the stages of the raster.
//!
//! It may change with any version.

/// Makes modules that pass on what is public in those of the same names.
macro_rules! modules {
    ($room:ident: $($(#[$meta:meta])* $module:ident)*) => {
        $($(#[$meta])* pub mod $module { pub use crate::$room::$module::*; })*
    };
    ($room:ident::$part:ident: $($(#[$meta:meta])* $module:ident)*) => {
        $($(#[$meta])* pub mod $module { pub use crate::$room::$part::$module::*; })*
    };
}

/// Eight numbers at a time.
pub mod lanes {
    pub use crate::lanes::*;
}

/// The loops over spans, and their specifications.
pub mod span {
    pub use crate::span::lookup::lookup;

    modules! { span:
        /// Red, green and blue to an index.
        channels
        /// Shades on a parabola.
        curve
        /// With a depth test.
        depth
        /// With ordered dither.
        dither
        /// The span in 16.16.
        fixed16
        /// Perspective-correct shades in f32.
        float
        /// Perspective-correct shades in integers.
        hyperbolic
        /// A list of spans.
        list
        /// Normals and positions for Phong's shading.
        lit
        /// Rows of texels.
        texture
        /// The bare entries of the assembly.
        #[cfg(any(asm_x86_64, asm_i686))]
        entry
    }
}

/// The stages of the raster.
pub mod raster {
    pub use crate::raster::triangles::Batch;

    modules! { raster:
        /// Clipping of triangles.
        clip
        /// Stages over spans: texture, fog, channels, blending, dither, light at every pixel.
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
            /// Exact floors by one reciprocal for each divisor.
            quotient
        }
    }
}

use alloc::vec::Vec;

use crate::light::{Light, Material};
use crate::mesh::Mesh;
pub use crate::plan::reason::name_of;
pub use crate::raster::shade_trace::{Accumulator, Progression, Ratio, ShadeTrace, row_of, rows_of};
pub use crate::render::each_triangle::{DrawnEffects, DrawnTriangle};
pub use crate::render::integer_frame::IntegerFrame;
use crate::render::{RenderError, Renderer, Screen, Stats};
pub use crate::scene::object::turn;
use crate::scene::{Object, Scene, Shared};

/// Hands every triangle that [`Renderer::draw`] would draw to `visit`, in the order of [`Renderer::for_each_triangle`],
/// with all that the raster would get. Returns the counts of the work, without the raster's. Nothing is drawn, and
/// later frames are the same as without this call.
///
/// # Errors
/// Those of [`Renderer::draw`], before the first triangle.
pub fn each_triangle(
    renderer: &mut Renderer,
    scene: &Scene,
    screen: Screen,
    visit: &mut dyn FnMut(&DrawnTriangle<'_>),
) -> Result<Stats, RenderError> {
    renderer.each_triangle(scene, screen, visit)
}

/// Makes the plan and the vertices of a frame, and draws nothing.
///
/// # Errors
/// Those of [`Renderer::draw`].
pub fn make_vertices(renderer: &mut Renderer, scene: &Scene, screen: Screen) -> Result<(), RenderError> {
    renderer.make_vertices(scene, screen)
}

/// Prepares a frame by the 16.16 path, which the renderer then has, draws nothing, and returns its numbers.
///
/// # Errors
/// Those of [`Renderer::draw`].
pub fn integer_frame<'a>(
    renderer: &'a mut Renderer,
    scene: &'a Scene,
    screen: Screen,
) -> Result<IntegerFrame<'a>, RenderError> {
    renderer.integer_frame(scene, screen)
}

/// Shows one channel's shades, 0 red, 1 green, 2 blue, where three would be mixed to an entry of the palette; `None`, the
/// default, mixes them.
pub fn show_channel(renderer: &mut Renderer, channel: Option<usize>) {
    renderer.show_channel(channel);
}

/// The mesh of an object, to be kept or compared by address.
#[must_use]
pub fn shared_mesh(object: &Object) -> &Shared<Mesh> {
    object.shared_mesh()
}

/// A copy of an object with another mesh, whose vertices must each have one surface, and a material for each surface of it.
#[must_use]
pub fn with_mesh(object: &Object, mesh: Shared<Mesh>, materials: Vec<Material>) -> Object {
    object.with_mesh(mesh, materials)
}

/// Checks a light.
///
/// # Errors
/// One line that says what is wrong.
pub fn check_light(light: &Light) -> Result<(), &'static str> {
    light.check()
}

/// Checks an object, by its index.
///
/// # Errors
/// One line that says what is wrong.
pub fn check_object(scene: &Scene, index: usize) -> Result<(), &'static str> {
    scene.objects().get(index).map_or(Ok(()), Object::check)?;
    scene.check_parents(index)
}
