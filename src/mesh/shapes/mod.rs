//! Built-in shapes, each fitting into the unit sphere about the origin.
//!
//! Normals are analytic (the Polish lecture), except for the cube, which has face normals. Numbers
//! of slices, stacks and segments are clamped to at least what the shape needs and at most 4,096.
//! Cube and wall have texture coordinates.
//!
//! | shape | closed | convex | axis |
//! |---|---|---|---|
//! | [`cube`] | yes | yes | |
//! | [`sphere`] | yes | yes | y |
//! | [`torus`] | yes | no | z: seen through the hole from the front |
//! | [`cone`] | yes | up to 754 slices | y, apex up |
//! | [`cylinder`] | yes | yes | y |
//! | [`wall`] | no | no | faces +z |
//! | [`teapot`] | no | no | y up, spout to +x |
//!
//! Coordinates are rounded toward zero, so that nothing sticks out of the unit sphere. A quad whose four corners are
//! not coplanar after rounding is split along the diagonal that makes the shape convex, so [`Mesh::is_convex`], which
//! is exact, holds.

mod cube;
mod revolution;
mod teapot;
mod wall;

use core::cmp::Ordering;

use glam::Vec3;

use super::Mesh;
use super::orientation::side;

pub use cube::cube;
pub use revolution::{cone, cylinder, sphere, torus};
pub use teapot::teapot;
pub use wall::wall;

/// The max number of slices, stacks or segments.
const MAX_PARTS: u32 = 4096;

/// A name, and the shape at its usual subdivision.
type Row = (&'static str, fn() -> Mesh);

const TABLE: [Row; 7] = [
    ("cube", cube),
    ("sphere", || sphere(48, 24)),
    ("torus", || torus(48, 24)),
    ("cone", || cone(48, 8)),
    ("cylinder", || cylinder(48, 8)),
    ("wall", || wall(16, 16)),
    ("teapot", || teapot(8)),
];

/// The names that [`by_name`] knows.
pub const NAMES: [&str; 7] = {
    let mut names = [""; 7];
    let mut i = 0;
    while i < names.len() {
        names[i] = TABLE[i].0;
        i += 1;
    }
    names
};

/// A shape at its usual subdivision, at most 4,032 triangles; `None` if the name is not in
/// [`NAMES`].
///
/// ```
/// use mode13h::mesh::shapes;
/// let torus = shapes::by_name("torus").expect("it is in NAMES");
/// assert_eq!(torus.triangles().len(), 2 * 48 * 24);
/// ```
#[must_use]
pub fn by_name(name: &str) -> Option<Mesh> {
    TABLE.iter().find(|row| row.0 == name).map(|row| row.1())
}

/// Rounds to f32, toward zero.
fn toward_zero(value: f64) -> f32 {
    // Rounds to the nearest.
    let nearest = value as f32;
    if libm::fabs(f64::from(nearest)) <= libm::fabs(value) {
        nearest
    } else {
        // The magnitude is in the lower 31 bits, and is not 0.
        f32::from_bits(nearest.to_bits() - 1)
    }
}

/// Splits the counter-clockwise quad `a`, `b`, `c`, `d` into two triangles: along a–c, unless only b–d makes it convex.
fn quad(positions: &[Vec3], [a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    let [pa, pb, pc, pd] = [a, b, c, d].map(|i| positions[i as usize]);
    if side(pa, pb, pc, pd) == Ordering::Greater { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] }
}

/// The triangles of a grid of quads, row by row, whose vertices are numbered row by row from `first` on.
fn grid(columns: u32, rows: u32, first: u32) -> impl Iterator<Item = [u32; 3]> {
    (0..rows).flat_map(move |row| (0..columns).map(move |column| (row, column))).flat_map(move |(row, column)| {
        let a = first + row * (columns + 1) + column;
        let d = a + columns + 1;
        [[a, a + 1, d + 1], [a, d + 1, d]]
    })
}
