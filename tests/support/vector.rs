//! Vectors in f64: glam is built without them.

use mode13h::glam::Vec3;

pub type Vector = [f64; 3];

pub fn wide(v: Vec3) -> Vector {
    v.to_array().map(f64::from)
}

pub fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn length(v: Vector) -> f64 {
    dot(v, v).sqrt()
}

/// The unit vector; `None` for the zero vector.
pub fn unit(v: Vector) -> Option<Vector> {
    let length = length(v);
    (length > 0.0).then(|| v.map(|c| c / length))
}
