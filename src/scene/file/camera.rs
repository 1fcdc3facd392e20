//! The camera: placed, or so that everything is in the picture.

use std::vec::Vec;

use glam::Vec3;
use toml::Spanned;

use super::error::Fault;
use super::layout::CameraLayout;
use crate::scene::{Camera, Object, Path};

/// Spheres that hold everything that is drawn, wherever it moves.
#[derive(Default)]
pub(super) struct Extent(Vec<(Vec3, f32)>);

impl Extent {
    /// Adds what an object sweeps over as it turns about its pivot, and, if it has one, goes along its path.
    pub(super) fn add(&mut self, object: &Object, path: Option<&Path>) {
        let bounds = object.mesh().bounds();
        let radius = (bounds.centre.distance(object.pivot) + bounds.radius) * object.scale;
        let mut at = |centre| self.0.push((centre, radius));
        match path {
            None => at(object.position),
            Some(Path::Line { from, to, .. }) => [*from, *to].into_iter().for_each(at),
            Some(Path::Circle { centre, from, towards, .. }) => {
                [*from, -*from, *towards, -*towards].into_iter().for_each(|radius| at(*centre + radius));
            }
        }
    }

    /// The middle of the box around all, and the radius of the sphere about it that holds all.
    fn sphere(&self) -> (Vec3, f32) {
        let (mut min, mut max) = (Vec3::MAX, Vec3::MIN);
        for &(centre, radius) in &self.0 {
            min = min.min(centre - Vec3::splat(radius));
            max = max.max(centre + Vec3::splat(radius));
        }
        let middle = (min + max) / 2.0;
        // One sphere is held by itself, without a rounding.
        let radius = self.0.iter().map(|&(centre, radius)| middle.distance(centre) + radius).fold(0.0, f32::max);
        (middle, radius)
    }
}

/// The camera that is asked for.
pub(super) fn camera(layout: Option<&Spanned<CameraLayout>>, extent: &Extent) -> Result<Camera, Fault> {
    let (centre, radius) = extent.sphere();
    if !(centre.is_finite() && radius.is_finite()) {
        let span = layout.map_or(0..0, Spanned::span);
        return Err(Fault::value(span, "the objects reach too far to be framed; give the camera an `eye`"));
    }
    let Some(layout) = layout.map(Spanned::get_ref) else { return Ok(Camera::framing(centre, radius)) };
    let field_of_view = layout.field_of_view.map_or(Camera::FIELD_OF_VIEW, |degrees| degrees.0.to_radians());
    let mut camera = match (layout.eye, &layout.from) {
        (Some(_), Some(from)) => {
            return Err(Fault::value(from.span(), "beside an `eye`, which says where the camera is"));
        }
        (Some(eye), None) => {
            let (eye, target) = (eye.vec3(), layout.target.map_or(Vec3::ZERO, |target| target.vec3()));
            Camera { eye, target, up: Vec3::Y, field_of_view, near: Camera::near_for(eye.distance(target)) }
        }
        (None, from) => {
            let direction = from.as_ref().map_or(Vec3::Z, |from| from.get_ref().vec3());
            let target = layout.target.map_or(centre, |target| target.vec3());
            Camera::framing_from(target, radius + target.distance(centre), direction, field_of_view)
        }
    };
    camera.up = layout.up.map_or(Vec3::Y, |up| up.vec3());
    camera.near = layout.near.map_or(camera.near, |near| near.0);
    Ok(camera)
}
