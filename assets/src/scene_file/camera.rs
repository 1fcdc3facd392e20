//! The camera, with an explicit position or framing everything.

use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::scene::Camera;
use mode13h::scene::framing::{Swept, Viewpoint};
use toml::Spanned;

use super::error::Fault;
use super::layout::CameraLayout;

/// Makes the camera from its layout; `everything` is the space that the scene's objects cover as they move.
pub(super) fn camera(layout: Option<&Spanned<CameraLayout>>, everything: &[Swept]) -> Result<Camera, Fault> {
    let span = layout.map_or(0..0, Spanned::span);
    let own = layout.map(Spanned::get_ref);
    let degrees = own.and_then(|own| own.field_of_view.as_ref());
    let field_of_view =
        degrees.map_or(Camera::FIELD_OF_VIEW, |degrees| Angle::from_radians(f64::from(degrees.0.to_radians())));
    let up = own.and_then(|own| own.up.as_ref());
    let from = own.and_then(|own| own.from.as_ref());
    if let Some(zero) = [up, from].into_iter().flatten().find(|direction| direction.get_ref().vec3() == Vec3::ZERO) {
        return Err(Fault::value(zero.span(), "a direction must not be zero"));
    }
    let up = up.map_or(Vec3::Y, |up| up.get_ref().vec3());
    let target = own.and_then(|own| own.target.as_ref()).map(|target| target.vec3());
    let eye = own.and_then(|own| own.eye.as_ref());
    let mut camera = match (eye, from) {
        (Some(_), Some(from)) => {
            return Err(Fault::value(from.span(), "not allowed with an `eye`, which says where the camera is"));
        }
        (Some(eye), None) => {
            let (eye, target) = (eye.vec3(), target.unwrap_or(Vec3::ZERO));
            // The square of a distance of 10²⁰ is beyond f32.
            let distance = eye.distance(target).min(f32::MAX);
            Camera { eye, target, up, field_of_view, near: Camera::near_for(distance) }
        }
        (None, from) => {
            let direction = from.map_or(Vec3::Z, |from| from.get_ref().vec3());
            let too_far = "the objects reach too far to be framed; give the camera an `eye`";
            let from = Viewpoint { direction, up, field_of_view, target };
            from.camera(everything).ok_or_else(|| Fault::value(span, too_far))?
        }
    };
    camera.near = own.and_then(|own| own.near.as_ref()).map_or(camera.near, |near| near.0);
    Ok(camera)
}
