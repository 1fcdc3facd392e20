//! A frame of the 16.16 path as numbers, for programs that draw it on another machine.

use alloc::vec::Vec;

use super::{RenderError, Renderer, Screen, VertexPath};
use crate::fixed::I16F16;
use crate::integer::{Camera, Object, Sun};
use crate::scene::Scene;
use crate::settings::HiddenSurfaces;
use crate::settings::Shading;

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

impl Renderer {
    /// Prepares a frame with the 16.16 path and returns its numbers, without drawing.
    pub(crate) fn integer_frame<'a>(
        &'a mut self,
        scene: &'a Scene,
        screen: Screen,
    ) -> Result<IntegerFrame<'a>, RenderError> {
        self.settings.vertex_path = Some(VertexPath::Integer);
        let (stats, _) = self.prepare(scene, screen, None, true)?;
        self.last = None;
        let Some((camera, focal, suns)) = self.cache.integer.frame() else {
            return Err(RenderError::Camera("there is none"));
        };
        let order = self.cache.plan.order.iter();
        let method = self.cache.plan.hidden_surfaces();
        Ok(IntegerFrame {
            shading: stats.shading,
            is_depth_tested: !matches!(method, HiddenSurfaces::BackFaces | HiddenSurfaces::PainterOrder),
            background: scene.background,
            camera,
            focal,
            suns,
            objects: order.filter_map(|&i| Some((i, self.cache.integer.object(i, &scene.objects()[i])?))).collect(),
        })
    }
}
