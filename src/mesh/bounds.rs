//! Bounds of a mesh.

use glam::Vec3;

use super::wide::{dot, sub, widen};

/// The bounding box and sphere of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Bounds {
    /// The least x, y and z.
    pub min: Vec3,
    /// The greatest x, y and z.
    pub max: Vec3,
    /// The centre of the box, and of the sphere.
    pub centre: Vec3,
    /// The distance from the centre to the farthest vertex, rounded up. Capped at `f32::MAX`, which a mesh can exceed
    /// by up to √3.
    pub radius: f32,
}

impl Bounds {
    /// The bounds of the vertices that the triangles use. There is at least one triangle; indices are in range.
    pub(super) fn of(positions: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let used = || triangles.iter().flatten().map(|&i| positions[i as usize]);
        let (min, max) = used().fold((Vec3::MAX, Vec3::MIN), |(min, max), p| (min.min(p), max.max(p)));
        // In f64: min + max may exceed f32, and so may the radius.
        let middle = |a: f32, b: f32| ((f64::from(a) + f64::from(b)) / 2.0) as f32;
        let centre = Vec3::new(middle(min.x, max.x), middle(min.y, max.y), middle(min.z, max.z));
        let squares = used().map(|p| sub(widen(p), widen(centre))).map(|away| dot(away, away));
        // The root is monotonic, so only the greatest square needs one.
        Self { min, max, centre, radius: round_up(libm::sqrt(squares.fold(0.0, f64::max))) }
    }
}

/// Rounds `value` ≥ 0 up to an f32, at most `f32::MAX`.
fn round_up(value: f64) -> f32 {
    // To the nearest, or to infinity beyond the range.
    let nearest = value as f32;
    let up = if f64::from(nearest) < value { nearest.next_up() } else { nearest };
    up.min(f32::MAX)
}
