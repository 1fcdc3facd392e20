//! A frame of the 16.16 path as numbers, for programs that draw it on another machine.

use alloc::vec::Vec;

use super::{RenderError, Renderer, Screen, VertexPath};
use crate::fixed::I16F16;
use crate::integer::{Camera, Object, Sun};
use crate::scene::Scene;
use crate::settings::{HiddenSurfaces, Shading};

/// A frame of the 16.16 path before its vertices are computed.
#[derive(Clone, Debug)]
pub struct IntegerFrame<'a> {
    /// The shading, one that this path supports.
    pub shading: Shading,
    /// True if depths are needed because the order of the objects does not suffice.
    pub is_depth_tested: bool,
    /// The entry that the frame is cleared to.
    pub background: u8,
    /// The camera, in a scene scaled into range with the eye as its origin.
    pub camera: Camera,
    /// The focal lengths in pixels, across and down.
    pub focal: [I16F16; 2],
    /// The suns.
    pub suns: &'a [Sun],
    /// The objects in drawing order, each with its index in the scene.
    pub objects: Vec<(usize, Object<'a, u32>)>,
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
    renderer.settings.vertex_path = Some(VertexPath::Integer);
    let (stats, _) = renderer.prepare(scene, screen, None, true)?;
    renderer.last = None;
    let Some((camera, focal, suns)) = renderer.cache.integer.frame() else {
        return Err(RenderError::Camera("there is none"));
    };
    let order = renderer.cache.plan.order.iter();
    let method = renderer.cache.plan.hidden_surfaces();
    Ok(IntegerFrame {
        shading: stats.shading,
        is_depth_tested: !matches!(method, HiddenSurfaces::BackFaces | HiddenSurfaces::PainterOrder),
        background: scene.background,
        camera,
        focal,
        suns,
        objects: order.filter_map(|&i| Some((i, renderer.cache.integer.object(i, &scene.objects()[i])?))).collect(),
    })
}
