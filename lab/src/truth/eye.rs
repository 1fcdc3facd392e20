//! The camera: from the world to the picture.

use mode13h::Angle;
use mode13h::glam::Vec3;

use super::vector::{Vector, cross, dot, sub, unit, wide};
use mode13h::render::Screen;
use mode13h::scene::Camera;

/// The eye, its three axes, and the scale of the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Eye {
    pub(super) at: Vector,
    right: Vector,
    up: Vector,
    forward: Vector,
    /// fx and fy, in pixels.
    focal: [f64; 2],
    /// Centre of the picture, in pixels from its upper left corner.
    pub(super) centre: [f64; 2],
    pub(super) near: f64,
}

impl Eye {
    /// Builds the eye, or says what is wrong with the camera.
    pub(super) fn new(camera: &Camera, screen: Screen) -> Result<Self, &'static str> {
        let Camera { eye, target, up, field_of_view, near } = *camera;
        if ![eye, target, up].iter().all(|v: &Vec3| v.is_finite()) {
            return Err("its positions must be finite");
        }
        // Written so that NaN fails them.
        if !(near > 0.0 && near.is_finite()) {
            return Err("its near distance must be above 0 and finite");
        }
        if !(field_of_view > Angle::default() && field_of_view < Angle::from_degrees(180.0)) {
            return Err("its field of view must be above 0 and below 180°");
        }
        let (at, up) = (wide(eye), wide(up));
        let forward = unit(sub(wide(target), at)).ok_or("it looks at its own position")?;
        // If up points along the view, to 10⁻⁶, the axis farthest from the view is used instead.
        let right = match unit(up).map(|up| cross(forward, up)) {
            Some(right) if dot(right, right) > 1e-12 => right,
            _ => cross(forward, farthest_axis(forward)),
        };
        let right = unit(right).ok_or("it has no right-hand side")?;
        let [width, height] = [screen.width, screen.height].map(f64::from);
        let fy = height / 2.0 / libm::tan(field_of_view.to_radians() / 2.0);
        let (pixel_width, pixel_height) = screen.pixel_aspect;
        let fx = fy * f64::from(pixel_height) / f64::from(pixel_width);
        Ok(Self {
            at,
            right,
            up: cross(right, forward),
            forward,
            focal: [fx, fy],
            centre: [width / 2.0, height / 2.0],
            near: f64::from(near),
        })
    }

    /// A world point before its division by w, the distance along the view: x·w and y·w, in pixels to the right of and
    /// below the centre of the picture, and w.
    pub(super) fn see(&self, point: Vector) -> Vector {
        let d = sub(point, self.at);
        [self.focal[0] * dot(self.right, d), -self.focal[1] * dot(self.up, d), dot(self.forward, d)]
    }

    /// Projects such a point to the picture, in pixels from its upper left corner.
    pub(super) fn project(&self, [x, y, w]: Vector) -> [f64; 2] {
        [self.centre[0] + x / w, self.centre[1] + y / w]
    }
}

/// The axis along which a direction has its smallest component.
fn farthest_axis(direction: Vector) -> Vector {
    let [x, y, z] = direction.map(f64::abs);
    if x <= y && x <= z {
        [1.0, 0.0, 0.0]
    } else if y <= z {
        [0.0, 1.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    }
}
