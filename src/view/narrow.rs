//! An object's transform in f32, for vertices that are projected eight at a time.

use glam::{Mat3, Vec3};

use super::ObjectView;
use crate::raster::Vertex;

/// An object's transform to the screen in f32.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Narrow {
    pub(crate) matrix: Mat3,
    pub(crate) offset: Vec3,
    pub(crate) centre: (f32, f32),
    pub(crate) near: f32,
}

impl ObjectView {
    /// The transform in f32, unless f32 could overflow.
    pub(crate) fn narrow(&self) -> Option<Narrow> {
        let (matrix, offset) = self.fast?;
        Some(Narrow { matrix, offset, centre: self.centre, near: self.near })
    }
}

impl Narrow {
    /// The max coordinate, in pixels.
    pub(crate) const LIMIT: f32 = (ObjectView::LIMIT + ObjectView::ROOM) as f32;
}

const _: () = assert!(Vertex::GUARD_BAND as f32 >= Narrow::LIMIT * 256.0);
