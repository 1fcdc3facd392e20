//! What a laboratory needs beside the public API: what drew each pixel, one triangle at a time, and how a renderer is set.
//!
//! A game needs none of this. It may change with any version.

use crate::light::Light;
use crate::mesh::Mesh;
use crate::palette::Ramp;
pub use crate::plan::reason::name_of;
pub use crate::raster::shade_trace::{Accumulator, Progression, Ratio, ShadeTrace, row_of, rows_of};
pub use crate::render::one_pixel::Bytes;
pub use crate::render::trace::{Met, Trace};
use crate::render::{RenderError, Renderer, Screen, Shading};
pub use crate::scene::object::turn;
use crate::scene::{Object, Scene, Shared};

/// Everything about the pixel (`x`, `y`), which lies inside the screen: its triangles in the order of drawing, what became
/// of each, and the stages of those that are seen.
///
/// # Errors
/// Those of [`Renderer::draw`].
pub fn trace(renderer: &mut Renderer, scene: &Scene, screen: Screen, x: u32, y: u32) -> Result<Trace, RenderError> {
    renderer.trace(scene, screen, x, y)
}

/// Makes the plan and the vertices of a frame, and draws nothing.
///
/// # Errors
/// Those of [`Renderer::draw`].
pub fn make_vertices(renderer: &mut Renderer, scene: &Scene, screen: Screen) -> Result<(), RenderError> {
    renderer.make_vertices(scene, screen)
}

/// Rounds projected vertices once more, to so many bits after the point: 8, the default, or fewer; 0 gives whole pixels.
/// Points that clipping makes stay.
pub fn set_vertex_bits(renderer: &mut Renderer, bits: u32) {
    renderer.set_vertex_bits(bits);
}

/// Shows one channel's shades, 0 red, 1 green, 2 blue, where three would be mixed to an entry of the palette; `None`, the
/// default, mixes them.
pub fn show_channel(renderer: &mut Renderer, channel: Option<usize>) {
    renderer.show_channel(channel);
}

/// The shading that a scene is drawn with.
#[must_use]
pub fn shading_for(renderer: &Renderer, scene: &Scene) -> Shading {
    renderer.shading_for(scene)
}

/// Sets the renderer's own shading, or leaves it to the scene. Returns what was set before.
pub fn replace_shading(renderer: &mut Renderer, shading: Option<Shading>) -> Option<Shading> {
    renderer.replace_shading(shading)
}

/// Whether a shading was set on this renderer, whatever the scene asks for.
#[must_use]
pub fn has_own_shading(renderer: &Renderer) -> bool {
    renderer.has_own_shading()
}

/// Whether an object's faces were split in the last frame.
#[must_use]
pub fn is_split(renderer: &Renderer, object: usize) -> bool {
    renderer.is_split(object)
}

/// The palette entries of a surface's shades in the last frame.
#[must_use]
pub fn ramp_of(renderer: &Renderer, scene: &Scene, object: usize, surface: u16) -> Ramp {
    renderer.ramp_of(scene, object, surface)
}

/// The mesh of an object, to be kept or compared by address.
#[must_use]
pub fn shared_mesh(object: &Object) -> &Shared<Mesh> {
    object.shared_mesh()
}

/// What is wrong with a light, if anything.
///
/// # Errors
/// One line that says it.
pub fn check_light(light: &Light) -> Result<(), &'static str> {
    light.check()
}

/// What is wrong with an object, if anything.
///
/// # Errors
/// One line that says it.
pub fn check_object(object: &Object) -> Result<(), &'static str> {
    object.check()
}
