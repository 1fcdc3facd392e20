//! Vectors in f64, for values computed once for a mesh, an object or a light.
//!
//! For a mesh f32 would overflow: the difference of two positions may be twice `f32::MAX`, and a normal's squared
//! length is a fourth power of a length. f64 can neither overflow nor underflow here: the fourth power of 2¹²⁹ is 2⁵¹⁶,
//! that of 2⁻¹⁴⁹ (the smallest f32) 2⁻⁵⁹⁶. So nothing needs scaling.

use glam::Vec3;

/// x, y, z.
pub(crate) type Wide = [f64; 3];

pub(crate) fn widen(v: Vec3) -> Wide {
    [f64::from(v.x), f64::from(v.y), f64::from(v.z)]
}

/// Rounds each component to the nearest f32, and turns −0 into 0, so that equal vectors have equal bits.
pub(crate) fn narrow(v: Wide) -> Vec3 {
    Vec3::new(v[0] as f32, v[1] as f32, v[2] as f32) + Vec3::ZERO
}

pub(crate) fn sub(a: Wide, b: Wide) -> Wide {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn add(a: Wide, b: Wide) -> Wide {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn scale(v: Wide, factor: f64) -> Wide {
    [v[0] * factor, v[1] * factor, v[2] * factor]
}

pub(crate) fn dot(a: Wide, b: Wide) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Wide, b: Wide) -> Wide {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn length(v: Wide) -> f64 {
    libm::sqrt(dot(v, v))
}
