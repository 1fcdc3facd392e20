//! Faults of light and of projection, with a view of their own.

use crate::hard_cases::face::Corner;
use crate::truth::vector::{Vector, dot, sub};

pub(in crate::hard_cases) fn unit(v: Vector) -> Vector {
    // NaN for the zero vector, which is where the faults begin.
    v.map(|c| c / dot(v, v).sqrt())
}

/// An eye on the z axis, looking along −z, in a frame of square pixels.
#[derive(Clone, Copy)]
pub(in crate::hard_cases) struct View {
    pub(in crate::hard_cases) size: (usize, usize),
    pub(in crate::hard_cases) eye: Vector,
    /// Angle from the upper to the lower edge, in radians.
    pub(in crate::hard_cases) field_of_view: f64,
}

impl View {
    /// Projects a point to the screen **whatever the sign of w**: behind the eye both coordinates change sign.
    pub(in crate::hard_cases) fn project(&self, point: Vector, shade: f64) -> Corner {
        let [x, y, z] = sub(point, self.eye);
        let (width, height) = (self.size.0 as f64, self.size.1 as f64);
        let scale = height / 2.0 / libm::tan(self.field_of_view / 2.0);
        let w = -z;
        Corner { x: width / 2.0 + scale * x / w, y: height / 2.0 - scale * y / w, shade, depth: 1.0 / w }.rounded()
    }

    /// Distance of a point in front of the eye.
    pub(in crate::hard_cases) fn w(&self, point: Vector) -> f64 {
        self.eye[2] - point[2]
    }
}
