//! The light of suns at eight vertices of a matt surface, in plain arrays that the compiler vectorises.

use glam::Vec3;

use super::Beam;
use crate::lanes::{LANES, Lanes};

/// [`both_sides`](super::both_sides) of eight normals, or of the front alone, and anything of the back. The operations
/// and their order are the same. A light without effect adds zero, which changes no sum: none is −0, as each begins at
/// +0.
#[inline(always)]
pub(crate) fn both_sides_of_eight<const BOTH: bool>(
    ambient: f64,
    diffuse: f64,
    suns: &[Beam],
    normals: &[Vec3; LANES],
) -> [Lanes<f64>; 2] {
    let (mut front, mut back) = ([0.0; LANES], [0.0; LANES]);
    let [mut x, mut y, mut z] = [[0.0; LANES]; 3];
    for (lane, normal) in normals.iter().enumerate() {
        (x[lane], y[lane], z[lane]) = (normal.x, normal.y, normal.z);
    }
    for sun in suns {
        for lane in 0..LANES {
            // As glam has it.
            let cosine = (x[lane] * sun.towards.x + y[lane] * sun.towards.y) + z[lane] * sun.towards.z;
            let light = f64::from(sun.intensity) * f64::from(cosine);
            front[lane] += only(cosine > 0.0, light);
            if BOTH {
                back[lane] -= only(cosine < 0.0, light);
            }
        }
    }
    [front, back].map(|side| side.map(|light| ambient + diffuse * light))
}

/// The light, or else zero. By a mask: of a choice the compiler makes a branch, and then no vectors.
#[inline(always)]
fn only(is_lit: bool, light: f64) -> f64 {
    f64::from_bits(light.to_bits() & u64::from(is_lit).wrapping_neg())
}
