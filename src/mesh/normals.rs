//! Normals of faces and of vertices.
//!
//! A face's normal is n = (p1 − p2) × (p1 − p3) (the Russian textbook, the Hungarian tutorial):
//! outward for counter-clockwise corners. A vertex's is the **normalised**, weighted sum of the
//! normals of the faces around it (the Russian textbook, the Russian article, the Polish lecture).
//! The Hungarian tutorial only divides by their number, which darkens vertices, sharp corners most:
//! at a cube's corner the mean of three unit normals is 0.58 long.
//!
//! Everything is computed in f64 and rounded once, so a normal's length is 1 within 2⁻²³ for any finite positions,
//! including denormals and `f32::MAX`. Sums are in triangle order.
//!
//! | case | normal |
//! |---|---|
//! | a face without area | none; it has no weight at any vertex |
//! | face normals that cancel, as on a folded sheet | the vertex is split, each face keeps its own |
//! | faces whose normals differ by more than the crease angle | the vertex is split, each side has its own |
//! | a vertex that no face with an area uses | +z |

use alloc::vec;
use alloc::vec::Vec;

use glam::Vec3;

use super::sets::Sets;
use super::wide::{Wide, add, cross, dot, length, narrow, scale, sub, widen};
use super::{Mesh, topology};
use crate::angle::Angle;
use crate::lanes::three;

/// The weight of each face in the normal of a vertex.
#[derive(Clone, Copy, Hash, Debug, PartialEq, Eq, Default)]
pub enum Weight {
    /// Equal weights, as in the source texts. The normal depends on the triangulation.
    Count,
    /// Weights by area.
    Area,
    /// Weights by the angle of the face at the vertex. The normal does not depend on the triangulation.
    #[default]
    Angle,
}

/// The unit normal of a face, outward if its corners are counter-clockwise seen from outside.
///
/// Returns `None` if the face has no area: two corners coincide, or all three are collinear (the sine of the largest
/// angle is below 2⁻⁴⁸).
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

/// Normalises any finite vector except zero; `None` for others.
pub(crate) fn unit(v: Vec3) -> Option<Vec3> {
    let wide = widen(v);
    let length = length(wide);
    (length > 0.0 && length.is_finite()).then(|| narrow(scale(wide, 1.0 / length)))
}

struct Face {
    /// The unit normal, or zero if the face has no area.
    normal: Wide,
    double_area: f64,
}

impl Face {
    fn new(corners: [Vec3; 3]) -> Self {
        let p = three(corners, widen);
        // The formula holds for the corners in any cyclic order. With p1 opposite the longest edge, the product is that
        // of the two shorter edges and the sine of the largest angle, which is small only if the face really is a line,
        // however distant one corner may be.
        let opposite = three([sub(p[1], p[2]), sub(p[2], p[0]), sub(p[0], p[1])], |edge| dot(edge, edge));
        let first = (0..3).fold(0, |best, i| if opposite[i] > opposite[best] { i } else { best });
        let (p1, p2, p3) = (p[first], p[(first + 1) % 3], p[(first + 2) % 3]);
        let (e2, e3) = (sub(p1, p2), sub(p1, p3));
        let n = cross(e2, e3);
        let double_area = length(n);
        // The rounding error is below 2⁻⁵⁰ of the product of the edges.
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

/// Decides which faces at a position are averaged together.
pub(super) struct SmoothingRule<'a> {
    /// The cosine of the greatest angle between two ungrouped faces that are averaged together.
    pub(super) least: f64,
    /// The index of each triangle's smoothing group, [`FLAT`](Self::FLAT) or [`NO_GROUP`](Self::NO_GROUP). Empty if
    /// there are no groups.
    pub(super) groups: &'a [u32],
    /// The edges of the mesh if it may be a scan; otherwise `None`. If its sharp edges are
    /// [scattered](Self::is_scattered), it is smooth everywhere.
    pub(super) edges: Option<topology::Edges>,
}

impl<'a> SmoothingRule<'a> {
    /// The group of faces that are not averaged with any other.
    pub(super) const FLAT: u32 = 0;
    /// The group of faces whose group is unknown: the angle decides.
    pub(super) const NO_GROUP: u32 = u32::MAX;

    /// Makes a rule from the angle between faces, and from groups if there are any.
    pub(super) fn new(crease: Angle, groups: &'a [u32]) -> Self {
        // 2⁻⁴⁰ covers rounding: faces at exactly the crease angle are smooth. NaN leaves all faces flat.
        let least = libm::cos(crease.to_radians().clamp(0.0, core::f64::consts::PI)) - 1.0 / 1_099_511_627_776.0;
        Self { least, groups, edges: None }
    }

    /// Returns whether sharp edges end at random places, as they do when they come from noise. On a designed model they
    /// continue until they meet others or the mesh's rim: nearly all points on a sharp edge are on two. On scans a
    /// third or more of these points are ends; above an eighth, edges count as scattered.
    fn is_scattered(&self, edges: &topology::Edges, faces: &[Face], count: usize) -> bool {
        const RIM: u8 = u8::MAX;
        let mut sharp = vec![0_u8; count];
        for ((a, b), here) in edges.each() {
            let triangle = |side: usize| here[side].1 as usize / 3;
            let is_inner = here.len() == 2 && [0, 1].iter().all(|&side| faces[triangle(side)].has_area());
            for point in [a as usize, b as usize] {
                if !is_inner {
                    sharp[point] = RIM;
                } else if sharp[point] < 2 && !self.is_smooth(faces, triangle(0), triangle(1)) {
                    sharp[point] += 1;
                }
            }
        }
        let ends = sharp.iter().filter(|&&sharp| sharp == 1).count();
        let others = sharp.iter().filter(|&&sharp| sharp == 2).count();
        8 * ends > ends + others
    }

    fn group(&self, triangle: usize) -> u32 {
        self.groups.get(triangle).copied().unwrap_or(Self::NO_GROUP)
    }

    fn is_smooth(&self, faces: &[Face], a: usize, b: usize) -> bool {
        match (self.group(a), self.group(b)) {
            (Self::NO_GROUP, Self::NO_GROUP) => dot(faces[a].normal, faces[b].normal) >= self.least,
            (a, b) => a == b && a != Self::FLAT,
        }
    }
}

impl Mesh {
    /// Gives every vertex the weighted mean of the normals of the faces around its position;
    /// vertices at the same position count as one. With a crease angle, two faces are averaged
    /// together if the angle between their normals is at most that, directly or through other faces
    /// at this position. The angle is 0 if two faces lie in one plane. Vertices are split where
    /// necessary.
    ///
    /// Vertices keep their indices; new ones come at the end. If more than 64 faces share a position, not all pairs are
    /// compared.
    pub fn smooth(&mut self, weight: Weight, crease: Option<Angle>) {
        let points = topology::weld(&self.positions);
        let known = vec![None; self.positions.len()];
        let rule = crease.map(|crease| SmoothingRule::new(crease, &[]));
        self.average(&points, weight, rule, known);
        self.find_facts();
    }

    /// Gives every face its own normal at all its corners. Vertices are split where necessary.
    ///
    /// This gives facets under any shading; [`Shading::Flat`](crate::settings::Shading::Flat) gives them without
    /// splitting vertices.
    pub fn flat(&mut self) {
        let faces = self.faces();
        let normal = |corner: usize, _| {
            let face = &faces[corner / 3];
            face.has_area().then(|| narrow(face.normal))
        };
        self.give(normal, vec![None; self.positions.len()]);
        self.find_facts();
    }

    fn faces(&self) -> Vec<Face> {
        self.triangles.iter().map(|&t| Face::new(self.corners(t))).collect()
    }

    fn corners(&self, triangle: [u32; 3]) -> [Vec3; 3] {
        triangle.map(|vertex| self.positions[vertex as usize])
    }

    /// Sets normals like [`smooth`](Self::smooth). `points` says which vertices count as one (points are numbered below
    /// the number of vertices); vertices with a normal in `known` keep it. Without a `rule`, all faces at a position
    /// are averaged.
    pub(super) fn average(
        &mut self,
        points: &[u32],
        weight: Weight,
        mut rule: Option<SmoothingRule<'_>>,
        known: Vec<Option<Vec3>>,
    ) {
        let faces = self.faces();
        // One sum for each class: a point, or some of the faces there. (A sum for each corner would take 48 bytes per
        // corner: over a gigabyte for ten million faces.)
        let classes = rule.as_ref().and_then(|rule| {
            let classes = self.classes(points, &faces, rule)?;
            match &rule.edges {
                Some(edges) if rule.is_scattered(edges, &faces, points.len()) => {
                    let smooth = SmoothingRule::new(Angle::TURN / 2.0, rule.groups);
                    self.classes(points, &faces, &smooth)
                }
                _ => Some(classes),
            }
        });
        // Freed before the allocations that follow.
        if let Some(rule) = &mut rule {
            rule.edges = None;
        }
        let is_flat = |triangle: usize| rule.as_ref().is_some_and(|rule| rule.group(triangle) == SmoothingRule::FLAT);
        let class = |corner: usize, vertex: u32| match &classes {
            None => points[vertex as usize] as usize,
            Some(classes) => classes[corner] as usize,
        };
        let greatest = points.iter().chain(classes.iter().flatten()).max();
        let count = greatest.map_or(0, |&greatest| greatest as usize + 1);
        let mut sums = vec![([0.0; 3], 0.0); count];
        for (t, face) in faces.iter().enumerate().filter(|(t, face)| face.has_area() && !is_flat(*t)) {
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
        // A sum of at most a millionth of its weights is the remainder of opposite faces that cancel, not a direction.
        // The rounding error is 2⁻⁵⁰ of the weights, so anything longer is accurate to 2⁻³⁰.
        let mean = |(sum, total): &(Wide, f64)| {
            let long = length(*sum);
            (long > total * (1.0 / 1_048_576.0)).then(|| narrow(scale(*sum, 1.0 / long)))
        };
        let means: Vec<Option<Vec3>> = sums.iter().map(mean).collect();
        drop(sums);
        // Known normals were given; those computed here for such vertices are discarded.
        let is_known: Vec<bool> = known.iter().map(Option::is_some).collect();
        let normal = |corner: usize, vertex: u32| {
            let face = &faces[corner / 3];
            let mean = || if is_flat(corner / 3) { None } else { means[class(corner, vertex)] };
            (face.has_area() && !is_known[vertex as usize]).then(|| mean().unwrap_or_else(|| narrow(face.normal)))
        };
        self.give(normal, known);
    }

    /// The class of faces that share a normal, for each corner: the index of its point, or, if the faces at a point are
    /// not all averaged together, a number beyond all points. `None` if the faces at every point are averaged together.
    fn classes(&self, points: &[u32], faces: &[Face], rule: &SmoothingRule<'_>) -> Option<Vec<u32>> {
        const NONE: u32 = u32::MAX;
        let count = points.iter().max().map_or(0, |&greatest| greatest as usize + 1);
        let takes_part = |t: usize| faces[t].has_area() && rule.group(t) != SmoothingRule::FLAT;
        // If every face at a point matches the first one, no more comparisons are needed there. On a scan, this holds
        // nearly everywhere.
        let mut first = vec![NONE; count];
        let mut is_divided = vec![false; count];
        let mut any = false;
        for (t, triangle) in self.triangles.iter().enumerate().filter(|(t, _)| takes_part(*t)) {
            for &vertex in triangle {
                let point = points[vertex as usize] as usize;
                if first[point] == NONE {
                    first[point] = t as u32;
                } else if !is_divided[point] && !rule.is_smooth(faces, first[point] as usize, t) {
                    (is_divided[point], any) = (true, true);
                }
            }
        }
        drop(first);
        if !any {
            return None;
        }
        let mut classes: Vec<u32> = self.triangles.as_flattened().iter().map(|&i| points[i as usize]).collect();
        // Points and corners, of which there are fewer than 2³²: see `Mesh::MAX_COUNT`.
        let corners = (0..).zip(&classes).filter(|&(corner, point)| {
            is_divided[*point as usize] && takes_part(corner as usize / 3) //
        });
        let mut corners: Vec<(u32, u32)> = corners.map(|(corner, point)| (*point, corner)).collect();
        corners.sort_unstable();
        let mut next = count as u32;
        let mut parts = Parts::default();
        for here in corners.chunk_by(|a, b| a.0 == b.0) {
            let face = |index: u32| here[index as usize].1 as usize / 3;
            parts.find(here.len() as u32, |a, b| rule.is_smooth(faces, face(a), face(b)));
            for (index, &(_, corner)) in (0..).zip(here) {
                // The first face of a part comes before the others and represents it.
                let stands = parts.sets.of(index);
                classes[corner as usize] = if stands == index {
                    next += 1;
                    next - 1
                } else {
                    classes[here[stands as usize].1 as usize]
                };
            }
        }
        Some(classes)
    }

    /// Sets the normals of each vertex's corners, where `None` accepts any, and splits the vertices whose corners need
    /// more than one. `given` holds the normals that vertices already have.
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

/// The faces at one point, in connected groups.
#[derive(Default)]
struct Parts {
    sets: Sets,
    compared: Vec<u32>,
}

impl Parts {
    /// The number of faces at a point that are all compared with each other. Any further face is compared with these,
    /// with the last eight, and with those that matched none of these, so the time per point is not quadratic.
    const COMPARED: usize = 64;

    fn find(&mut self, count: u32, linked: impl Fn(u32, u32) -> bool) {
        self.sets.renew(count);
        self.compared.clear();
        for index in 0..count {
            for other in self.compared.iter().copied().chain(index.saturating_sub(8)..index) {
                if self.sets.of(other) != self.sets.of(index) && linked(other, index) {
                    self.sets.join(other, index);
                }
            }
            let is_alone = self.sets.of(index) == index && self.compared.len() < 4 * Self::COMPARED;
            if is_alone || self.compared.len() < Self::COMPARED {
                self.compared.push(index);
            }
        }
    }
}
