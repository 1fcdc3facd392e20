//! The shapes by name, with their subdivisions.

use core::str::FromStr;

use mode13h::mesh::{Mesh, shapes};

/// A shape that a scene may name.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    pub(super) name: &'static str,
    /// Its subdivisions, each with its name, minimum, maximum and default.
    subdivisions: &'static [(&'static str, u32, u32, u32)],
    triangles: fn(&[u32]) -> u64,
    make: fn(&[u32]) -> Mesh,
}

/// The shapes by name. Their functions receive a value within range for each of their subdivisions.
const SHAPES: [Shape; 7] = [
    Shape { name: "cube", subdivisions: &[], triangles: |_| 12, make: |_| shapes::cube() },
    Shape {
        name: "sphere",
        subdivisions: &[("slices", 3, MAX_PARTS, 48), ("stacks", 2, MAX_PARTS, 24)],
        triangles: |n| 2 * product(n),
        make: |n| shapes::sphere(n[0], n[1]),
    },
    Shape {
        name: "torus",
        subdivisions: &[("around the axis", 3, MAX_PARTS, 48), ("around the tube", 3, MAX_PARTS, 24)],
        triangles: |n| 2 * product(n),
        make: |n| shapes::torus(n[0], n[1]),
    },
    Shape {
        name: "cone",
        subdivisions: &[("slices", 3, MAX_PARTS, 48), ("stacks", 1, 256, 8)],
        triangles: |n| 2 * product(n),
        make: |n| shapes::cone(n[0], n[1]),
    },
    Shape {
        name: "cylinder",
        subdivisions: &[("slices", 3, MAX_PARTS, 48), ("stacks", 1, MAX_PARTS, 8)],
        triangles: |n| 2 * product(n) + 2 * u64::from(n[0]),
        make: |n| shapes::cylinder(n[0], n[1]),
    },
    Shape {
        name: "wall",
        subdivisions: &[("columns", 1, MAX_PARTS, 16), ("rows", 1, MAX_PARTS, 16)],
        triangles: |n| 2 * product(n),
        make: |n| shapes::wall(n[0], n[1]),
    },
    Shape {
        name: "teapot",
        subdivisions: &[("segments", 2, 512, 8)],
        triangles: |n| 64 * u64::from(n[0]) * u64::from(n[0]),
        make: |n| shapes::teapot(n[0]),
    },
];

/// The maximum of most subdivisions.
const MAX_PARTS: u32 = 4096;

fn product(subdivisions: &[u32]) -> u64 {
    subdivisions.iter().map(|&n| u64::from(n)).product()
}

impl Shape {
    /// Checks the subdivisions that a scene gives: as many as the shape has, each within its range.
    pub(super) fn subdivided(self, given: &[i64]) -> Result<Vec<u32>, String> {
        if given.len() != self.subdivisions.len() {
            let names: Vec<&str> = self.subdivisions.iter().map(|row| row.0).collect();
            return Err(match names.as_slice() {
                [] => format!("a {} has no subdivisions", self.name),
                names => format!("a {} has {} subdivisions: {}", self.name, names.len(), names.join(", ")),
            });
        }
        let mut numbers = Vec::new();
        for (&(name, least, most, _), &number) in self.subdivisions.iter().zip(given) {
            match u32::try_from(number) {
                Ok(number) if (least..=most).contains(&number) => numbers.push(number),
                _ => return Err(format!("{number} {name}; a {} can have {least} to {most}", self.name)),
            }
        }
        Ok(numbers)
    }

    /// The default subdivisions.
    pub(super) fn usual(self) -> Vec<u32> {
        self.subdivisions.iter().map(|row| row.3).collect()
    }

    /// An upper bound on the number of triangles with these subdivisions.
    pub(super) fn triangles(self, subdivisions: &[u32]) -> u64 {
        (self.triangles)(subdivisions)
    }

    /// The shape with these subdivisions, which come from [`subdivided`](Self::subdivided) or [`usual`](Self::usual).
    pub(super) fn mesh(self, subdivisions: &[u32]) -> Mesh {
        (self.make)(subdivisions)
    }
}

impl FromStr for Shape {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let names = shapes::NAMES.join(", ");
        SHAPES.into_iter().find(|shape| shape.name == name).ok_or(format!("unknown shape; there are {names}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shapes_are_those_of_the_library_as_it_makes_them() {
        assert_eq!(SHAPES.map(|shape| shape.name), shapes::NAMES);
        for shape in SHAPES {
            assert_eq!(Some(shape.mesh(&shape.usual())), shapes::by_name(shape.name), "{}", shape.name);
        }
    }

    #[test]
    fn no_shape_has_more_triangles_than_it_says() {
        for shape in SHAPES {
            for least in [true, false] {
                let numbers: Vec<u32> =
                    shape.subdivisions.iter().map(|row| if least { row.1 } else { row.1 + 5 }).collect();
                let (said, made) = (shape.triangles(&numbers), shape.mesh(&numbers).triangles().len() as u64);
                assert!(made <= said && said <= 2 * made, "{} {numbers:?}: {made}, {said}", shape.name);
            }
        }
    }
}
