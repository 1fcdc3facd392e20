//! Normals of faces and of vertices.
//!
//! A face's normal is n = (p1 − p2) × (p1 − p3) (S0, S4): outward for counter-clockwise corners. A
//! vertex's is the **normalised**, weighted sum of the normals of the faces around it (S0, S1, S2).
//! S4 divides by their number instead and leaves it at that, which darkens a vertex the more the
//! rounder the corner is: at a cube's corner the mean of three unit normals is 0.58 long.
//!
//! All is computed in f64 and rounded once, so a normal's length is 1 within 2⁻²³ for any finite
//! positions, denormals and `f32::MAX` among them. Sums run in the order of the triangles.
//!
//! | case | normal |
//! |---|---|
//! | a face of no area | none; it has no weight in any vertex |
//! | face normals that cancel, as on a folded sheet | the vertex is split, each face keeps its own |
//! | faces that meet at more than the crease angle | the vertex is split, each side has its own |
//! | a vertex that no face with an area uses | +z |

use alloc::vec;
use alloc::vec::Vec;

use glam::Vec3;

use super::wide::{Wide, add, cross, dot, length, narrow, scale, sub, widen};
use super::{Mesh, topology};

/// How much each face counts in the normal of a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Weight {
    /// All alike, as in the source texts. The normal depends on how the faces are cut into triangles.
    Count,
    /// By area.
    Area,
    /// By the angle of the face at the vertex. Does not depend on how the faces are cut.
    #[default]
    Angle,
}

/// The unit normal of a face, outward if its corners are counter-clockwise seen from outside.
///
/// Returns `None` if the face has no area: two corners in one point, or all three on a line (the sine
/// of its largest angle is below 2⁻⁴⁸).
///
/// ```
/// use mode13h::glam::Vec3;
/// use mode13h::mesh::normals::face_normal;
/// assert_eq!(face_normal(Vec3::ZERO, Vec3::X, Vec3::Y), Some(Vec3::Z));
/// assert_eq!(face_normal(Vec3::ZERO, Vec3::X, Vec3::X * 2.0), None);
/// ```
#[must_use]
pub fn face_normal(p1: Vec3, p2: Vec3, p3: Vec3) -> Option<Vec3> {
    let face = Face::new([p1, p2, p3]);
    (face.double_area > 0.0).then(|| narrow(face.normal))
}

/// Any finite vector but zero, made unit; `None` for others.
pub(crate) fn unit(v: Vec3) -> Option<Vec3> {
    let wide = widen(v);
    let length = length(wide);
    (length > 0.0 && length.is_finite()).then(|| narrow(scale(wide, 1.0 / length)))
}

struct Face {
    /// Unit, or zero if the face has no area.
    normal: Wide,
    double_area: f64,
}

impl Face {
    fn new(corners: [Vec3; 3]) -> Self {
        let p = corners.map(widen);
        // The formula holds for the corners in any cyclic order. With p1 opposite the longest edge
        // the product is that of the two shorter ones and the sine of the largest angle, which is
        // small only if the face really is a line, however far away one corner may be.
        let opposite = [sub(p[1], p[2]), sub(p[2], p[0]), sub(p[0], p[1])].map(|edge| dot(edge, edge));
        let first = (0..3).fold(0, |best, i| if opposite[i] > opposite[best] { i } else { best });
        let (p1, p2, p3) = (p[first], p[(first + 1) % 3], p[(first + 2) % 3]);
        let (e2, e3) = (sub(p1, p2), sub(p1, p3));
        let n = cross(e2, e3);
        let double_area = length(n);
        // Rounding makes less than 2⁻⁵⁰ of the edges' product.
        if double_area > length(e2) * length(e3) * (1.0 / 281_474_976_710_656.0) {
            Self { normal: scale(n, 1.0 / double_area), double_area }
        } else {
            Self { normal: [0.0; 3], double_area: 0.0 }
        }
    }

    fn has_area(&self) -> bool {
        self.double_area > 0.0
    }
}

/// The angle at each corner, in radians.
fn angles(corners: [Vec3; 3]) -> [f64; 3] {
    let p = corners.map(widen);
    [0, 1, 2].map(|i| {
        let (left, right) = (sub(p[(i + 1) % 3], p[i]), sub(p[(i + 2) % 3], p[i]));
        libm::atan2(length(cross(left, right)), dot(left, right))
    })
}

impl Mesh {
    /// Gives every vertex the weighted mean of the normals of the faces around its position; vertices
    /// at the same position count as one. With a crease angle (radians) a face counts only with those
    /// that it meets, over edges at this position, at that angle or less; vertices are split where
    /// they must be. An angle is 0 where two faces lie in one plane.
    ///
    /// Vertices keep their numbers; new ones come at the end.
    pub fn smooth(&mut self, weight: Weight, crease: Option<f32>) {
        let points = topology::weld(&self.positions);
        let known = vec![None; self.positions.len()];
        self.average(&points, weight, crease, known);
    }

    /// Gives every face its own normal at all its corners. Vertices are split where they must be.
    pub fn flat(&mut self) {
        let faces = self.faces();
        let normal = |corner: usize, _| {
            let face = &faces[corner / 3];
            face.has_area().then(|| narrow(face.normal))
        };
        self.give(normal, vec![None; self.positions.len()]);
    }

    fn faces(&self) -> Vec<Face> {
        self.triangles.iter().map(|&t| Face::new(self.corners(t))).collect()
    }

    fn corners(&self, triangle: [u32; 3]) -> [Vec3; 3] {
        triangle.map(|vertex| self.positions[vertex as usize])
    }

    /// As [`smooth`](Self::smooth), where `points` says which vertices count as one (points are
    /// numbered below the number of vertices), and `known` which of them keep the normal that it gives.
    pub(super) fn average(&mut self, points: &[u32], weight: Weight, crease: Option<f32>, known: Vec<Option<Vec3>>) {
        let faces = self.faces();
        // One for each class, which is a point or, with a crease, a corner. (One for each corner always would be 48
        // bytes a corner: of ten million faces over a gigabyte.)
        let classes = crease.map(|angle| self.classes(points, &faces, angle));
        let class = |corner: usize, vertex: u32| match &classes {
            None => points[vertex as usize] as usize,
            Some(classes) => classes[corner] as usize,
        };
        let greatest = classes.as_deref().unwrap_or(points).iter().max();
        let count = greatest.map_or(0, |&greatest| greatest as usize + 1);
        let mut sums = vec![([0.0; 3], 0.0); count];
        for (t, face) in faces.iter().enumerate().filter(|(_, face)| face.has_area()) {
            let weights = match weight {
                Weight::Count => [1.0; 3],
                Weight::Area => [face.double_area; 3],
                Weight::Angle => angles(self.corners(self.triangles[t])),
            };
            for (corner, weight) in weights.into_iter().enumerate() {
                let (sum, total) = &mut sums[class(3 * t + corner, self.triangles[t][corner])];
                *sum = add(*sum, scale(face.normal, weight));
                *total += weight;
            }
        }
        // A sum a millionth of its weights or shorter is what opposite faces leave over, not a
        // direction. Rounding is 2⁻⁵⁰ of the weights, so what is longer is exact to 2⁻³⁰.
        let mean = |(sum, total): &(Wide, f64)| {
            let long = length(*sum);
            (long > total * (1.0 / 1_048_576.0)).then(|| narrow(scale(*sum, 1.0 / long)))
        };
        let means: Vec<Option<Vec3>> = sums.iter().map(mean).collect();
        drop(sums);
        // What is known was given; all that is found here for such a vertex is dropped.
        let is_known: Vec<bool> = known.iter().map(Option::is_some).collect();
        let normal = |corner: usize, vertex: u32| {
            let face = &faces[corner / 3];
            (face.has_area() && !is_known[vertex as usize])
                .then(|| means[class(corner, vertex)].unwrap_or_else(|| narrow(face.normal)))
        };
        self.give(normal, known);
    }

    /// For each corner the corner that stands for all that share a normal with it: two faces at a
    /// point do if they meet over an edge at no more than the crease angle, or if others link them.
    fn classes(&self, points: &[u32], faces: &[Face], crease: f32) -> Vec<u32> {
        // 2⁻⁴⁰ for rounding: faces at exactly the crease angle are smooth.
        let least = libm::cos(f64::from(crease).clamp(0.0, core::f64::consts::PI)) - 1.0 / 1_099_511_627_776.0;
        // The edges at each point: (this point, the other one), corner.
        let mut edges: Vec<(u64, u32)> = Vec::with_capacity(faces.len() * 6);
        for (t, triangle) in self.triangles.iter().enumerate() {
            if !faces[t].has_area() {
                continue;
            }
            for i in 0..3 {
                let at = |corner: usize| u64::from(points[triangle[corner % 3] as usize]);
                // Fits, see `Mesh::MOST`.
                let corner = (3 * t + i) as u32;
                edges.push((at(i) << 32 | at(i + 1), corner));
                edges.push((at(i) << 32 | at(i + 2), corner));
            }
        }
        edges.sort_unstable();
        let mut parent: Vec<u32> = (0..self.triangles.len() as u32 * 3).collect();
        for run in edges.chunk_by(|a, b| a.0 == b.0) {
            for (i, &(_, corner)) in run.iter().enumerate() {
                // More than two faces over one edge are rare; more than nine are not all compared.
                for &(_, earlier) in &run[i.saturating_sub(8)..i] {
                    let (a, b) = (&faces[corner as usize / 3].normal, &faces[earlier as usize / 3].normal);
                    if dot(*a, *b) >= least {
                        let (a, b) = (root(&mut parent, corner), root(&mut parent, earlier));
                        parent[a.max(b) as usize] = a.min(b);
                    }
                }
            }
        }
        (0..parent.len() as u32).map(|corner| root(&mut parent, corner)).collect()
    }

    /// A normal for each corner of a vertex; `None`: any will do. Splits the vertices whose corners want more
    /// than one. `given`: what vertices have already.
    fn give(&mut self, normal: impl Fn(usize, u32) -> Option<Vec3>, mut given: Vec<Option<Vec3>>) {
        let bits = |n: Vec3| [n.x, n.y, n.z].map(f32::to_bits);
        let mut splits: Vec<(u32, [u32; 3], u32)> = Vec::new();
        for (corner, &vertex) in self.triangles.as_flattened().iter().enumerate() {
            let Some(normal) = normal(corner, vertex) else { continue };
            match given[vertex as usize] {
                None => given[vertex as usize] = Some(normal),
                Some(first) if bits(first) == bits(normal) => {}
                Some(_) => splits.push((vertex, bits(normal), corner as u32)),
            }
        }
        self.normals.clear();
        self.normals.extend(given.into_iter().map(|normal| normal.unwrap_or(Vec3::Z)));
        splits.sort_unstable();
        for same in splits.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let (vertex, normal, _) = same[0];
            let new = self.positions.len() as u32;
            self.positions.push(self.positions[vertex as usize]);
            self.normals.push(Vec3::from_array(normal.map(f32::from_bits)));
            if let Some(texcoords) = &mut self.texcoords {
                texcoords.push(texcoords[vertex as usize]);
            }
            for &(_, _, corner) in same {
                self.triangles.as_flattened_mut()[corner as usize] = new;
            }
        }
    }
}

/// The corner that stands for `corner`; shortens the way there.
fn root(parent: &mut [u32], mut corner: u32) -> u32 {
    while parent[corner as usize] != corner {
        parent[corner as usize] = parent[parent[corner as usize] as usize];
        corner = parent[corner as usize];
    }
    corner
}
