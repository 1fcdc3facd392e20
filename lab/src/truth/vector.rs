//! Points and directions in f64.

use mode13h::glam::Vec3;

/// x, y, z.
pub(crate) type Vector = [f64; 3];

pub(crate) fn wide(v: Vec3) -> Vector {
    [f64::from(v.x), f64::from(v.y), f64::from(v.z)]
}

pub(crate) fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn times(v: Vector, factor: f64) -> Vector {
    v.map(|c| c * factor)
}

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Cross product. Swapping the operands negates it exactly.
pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The unit vector in this direction; `None` for the zero vector.
pub(crate) fn unit(v: Vector) -> Option<Vector> {
    let length = libm::sqrt(dot(v, v));
    (length > 0.0).then(|| times(v, 1.0 / length))
}

/// Weighted sum of three vectors.
pub(crate) fn weighted(vectors: [Vector; 3], weights: [f64; 3]) -> Vector {
    let [a, b, c] = [0, 1, 2].map(|i| times(vectors[i], weights[i]));
    add(add(a, b), c)
}

/// The point `part` of the way from one vector to another.
pub(crate) fn between(from: Vector, to: Vector, part: f64) -> Vector {
    add(from, times(sub(to, from), part))
}
