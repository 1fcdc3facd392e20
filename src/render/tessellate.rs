//! Splits faces along their edges until shades that are linear between the vertices fit the light.
//!
//! As the Russian textbook says, Gouraud shading cannot show a highlight inside a face, nor a lamp near the middle of a
//! large one; many small faces can. A split is decided for each **edge**, from its two ends alone, and every face with
//! that edge is split there. No corner of one face lies on an edge of another, so there is no crack. The new vertex is
//! the midpoint; it is created once, and projected and rounded once.
//!
//! Over an edge of length L a function whose second derivative is at most c differs from a linear one by at most
//! L²·c/8. Three things bend light along an edge:
//!
//! - a lamp at the distance h from it: n·l is h/√(h² + x²), which bends by at most 1/h², and the fall-off within a
//!   range R by at most 4/R² more;
//! - a highlight at the distance h from what it mirrors: cos^s, which bends by at most s/h²;
//! - normals that turn along the edge, as on a round object: found by lighting the middle.

use alloc::borrow::ToOwned;
use alloc::vec::Vec;
use core::mem;

use glam::{Vec2, Vec3};

use super::edge_map::EdgeMap;
use super::geometry::Geometry;
use super::surface_material::SurfaceMaterial;
use crate::light::Lights;
use crate::mesh::normals::unit;
use crate::mesh::wide::{dot, sub, widen};

/// How often an edge may be halved: into 64 pieces at most.
const DEPTH: usize = 6;

/// Splitting ends at this number of triangles.
const MAX_TRIANGLES: usize = 1 << 18;

/// A split mesh.
#[derive(Debug, Default)]
pub(super) struct Tessellated {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    texcoords: Vec<Vec2>,
    vertex_surfaces: Vec<u16>,
    triangles: Vec<[u32; 3]>,
    triangle_surfaces: Vec<u16>,
    /// The index of each vertex's point: vertices at the same position share it.
    points: Vec<u32>,
    /// A bit for each triangle whose original triangle lies back to back with another; empty if there is none. Parts of
    /// two such triangles may be split differently, but lie in one plane, and show their backs together.
    twins: Vec<u64>,
    /// True for each triangle whose edges have been examined and found straight enough.
    straight: Vec<bool>,
    /// Intensities of front and back at the vertices, computed once for each.
    light: Vec<(f64, f64)>,
    /// At each vertex, the angle between the eye and the mirrored light for each sun and each lamp, if any surface has
    /// a highlight.
    angles: Vec<f64>,
    /// The edges to be split, by their points, with the index of the new point.
    halved: EdgeMap,
    /// Midpoint vertices by their two end vertices: at a crease each side has its own.
    middles: EdgeMap,
}

impl Tessellated {
    /// Splits `geometry` until no edge [bends](Bend::is_too_great) by more than `tolerance` shades, of which 255 are full
    /// intensity.
    /// `points` are the indices of the vertices' points.
    #[inline(never)]
    pub(super) fn split(
        &mut self,
        geometry: &Geometry<'_>,
        points: &[u32],
        lights: &Lights<'_>,
        materials: &[SurfaceMaterial],
        tolerance: f32,
    ) {
        geometry.positions.clone_into(&mut self.positions);
        geometry.normals.clone_into(&mut self.normals);
        geometry.texcoords.unwrap_or(&[]).clone_into(&mut self.texcoords);
        geometry.vertex_surfaces.clone_into(&mut self.vertex_surfaces);
        geometry.triangles.clone_into(&mut self.triangles);
        geometry.triangle_surfaces.clone_into(&mut self.triangle_surfaces);
        points.clone_into(&mut self.points);
        geometry.twins.clone_into(&mut self.twins);
        self.straight.clear();
        self.straight.resize(self.triangles.len(), false);
        self.light.clear();
        self.angles.clear();
        let has_highlights = materials.iter().any(|material| material.reflectance.specular != 0.0);
        let bend = Bend { lights, materials, tolerance: f64::from(tolerance) / 255.0, has_highlights };
        for _ in 0..DEPTH {
            if self.triangles.len() >= MAX_TRIANGLES || !self.halve(&bend) {
                return;
            }
        }
    }

    /// The mesh in its current state.
    pub(super) fn geometry(&self) -> Geometry<'_> {
        Geometry {
            positions: &self.positions,
            normals: &self.normals,
            texcoords: (!self.texcoords.is_empty()).then_some(self.texcoords.as_slice()),
            vertex_surfaces: &self.vertex_surfaces,
            triangles: &self.triangles,
            triangle_surfaces: &self.triangle_surfaces,
            twins: &self.twins,
        }
    }

    /// The edge between two vertices, regardless of its direction and of which vertices at its two points are given.
    fn edge(&self, a: u32, b: u32) -> (u32, u32) {
        let (a, b) = (self.points[a as usize], self.points[b as usize]);
        if a < b { (a, b) } else { (b, a) }
    }

    /// Halves every edge that bends, once. Returns whether there was one.
    fn halve(&mut self, bend: &Bend<'_>) -> bool {
        self.light(bend);
        let mut halved = mem::take(&mut self.halved);
        halved.clear();
        // Below 2³¹, like a mesh's vertices, and splitting ends before there are twice as many.
        let mut points = self.points.iter().max().map_or(0, |last| last + 1);
        for (&[a, b, c], straight) in self.triangles.iter().zip(&self.straight) {
            // Edges that did not bend before do not bend now.
            if *straight {
                continue;
            }
            for (a, b) in [(a, b), (b, c), (c, a)] {
                let edge = self.edge(a, b);
                // Two faces that meet at a crease have normals of their own there: it is enough that one of them needs
                // the split.
                if edge.0 != edge.1 && halved.get(edge).is_none() && bend.is_too_great(self, a, b) {
                    halved.insert(edge, points);
                    points += 1;
                }
            }
        }
        let any = !halved.is_empty();
        if any {
            self.split_at(&halved);
        }
        self.halved = halved;
        any
    }

    /// Splits every triangle at the edges of `halved`.
    fn split_at(&mut self, halved: &EdgeMap) {
        let mut middles = mem::take(&mut self.middles);
        middles.clear();
        for i in 0..self.triangles.len() {
            let [a, b, c] = self.triangles[i];
            let surface = self.triangle_surfaces[i];
            let mut middle = |a: u32, b: u32| {
                let point = halved.get(self.edge(a, b))?;
                let (low, high) = if a < b { (a, b) } else { (b, a) };
                Some(middles.get((low, high)).unwrap_or_else(|| {
                    let middle = self.add_middle(low, high, point);
                    middles.insert((low, high), middle);
                    middle
                }))
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            let parts: &[[u32; 3]] = match (ab, bc, ca) {
                (None, None, None) => {
                    self.straight[i] = true;
                    continue;
                }
                (Some(ab), Some(bc), Some(ca)) => &[[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]],
                (Some(m), None, None) => &one(a, b, c, m),
                (None, Some(m), None) => &one(b, c, a, m),
                (None, None, Some(m)) => &one(c, a, b, m),
                (Some(ab), Some(bc), None) => &two(a, b, c, ab, bc),
                (None, Some(bc), Some(ca)) => &two(b, c, a, bc, ca),
                (Some(ab), None, Some(ca)) => &two(c, a, b, ca, ab),
            };
            (self.triangles[i], self.straight[i]) = (parts[0], false);
            for &part in &parts[1..] {
                if !self.twins.is_empty() {
                    let new = self.triangles.len();
                    self.twins.resize((new + 1).div_ceil(64), 0);
                    self.twins[new / 64] |= (self.twins[i / 64] >> (i % 64) & 1) << (new % 64);
                }
                self.triangles.push(part);
                self.straight.push(false);
                self.triangle_surfaces.push(surface);
            }
        }
        self.middles = middles;
    }

    /// Lights the new vertices.
    fn light(&mut self, bend: &Bend<'_>) {
        for vertex in self.light.len()..self.positions.len() {
            let (position, normal) = (self.positions[vertex], self.normals[vertex]);
            let material = &bend.materials[usize::from(self.vertex_surfaces[vertex])];
            self.light.push(bend.lights.one_channel(&material.reflectance, position, normal));
            if bend.has_highlights {
                self.angles.extend(bend.angles(position, normal));
            }
        }
    }

    fn add_middle(&mut self, a: u32, b: u32, point: u32) -> u32 {
        let (a, b) = (a as usize, b as usize);
        // Half of each, since their sum might overflow. The order of the two ends does not matter.
        self.positions.push(self.positions[a] * 0.5 + self.positions[b] * 0.5);
        let sum = self.normals[a] + self.normals[b];
        self.normals.push(unit(sum).unwrap_or(self.normals[a]));
        if !self.texcoords.is_empty() {
            self.texcoords.push(self.texcoords[a] * 0.5 + self.texcoords[b] * 0.5);
        }
        self.vertex_surfaces.push(self.vertex_surfaces[a]);
        self.points.push(point);
        // Fewer than 2³², see `MAX_TRIANGLES`.
        (self.positions.len() - 1) as u32
    }
}

/// The triangle a, b, c with a vertex m on the edge a–b.
fn one(a: u32, b: u32, c: u32, m: u32) -> [[u32; 3]; 2] {
    [[a, m, c], [m, b, c]]
}

/// The triangle a, b, c with vertices on the edges a–b and b–c.
fn two(a: u32, b: u32, c: u32, ab: u32, bc: u32) -> [[u32; 3]; 3] {
    [[a, ab, c], [ab, b, bc], [ab, bc, c]]
}

/// Decides how much light bends along an edge.
struct Bend<'a> {
    lights: &'a Lights<'a>,
    materials: &'a [SurfaceMaterial],
    /// The greatest allowed error, as a fraction of full intensity.
    tolerance: f64,
    /// True if any surface has a highlight.
    has_highlights: bool,
}

impl Bend<'_> {
    /// Returns whether linear shades between the vertices `a` and `b` are off by more than the tolerance: at the middle,
    /// or by the bounds of the module's documentation.
    fn is_too_great(&self, mesh: &Tessellated, a: u32, b: u32) -> bool {
        let (a, b) = (a as usize, b as usize);
        let (pa, pb) = (mesh.positions[a], mesh.positions[b]);
        let (na, nb) = (mesh.normals[a], mesh.normals[b]);
        let material = &self.materials[usize::from(mesh.vertex_surfaces[a])];
        let ends = [widen(pa), widen(pb)];
        let square = distance_squared(ends[0], ends[1]);
        if square <= 0.0 {
            return false;
        }
        let eight = 8.0 * self.tolerance;
        // A lamp.
        for lamp in self.lights.lamps {
            let h = to_segment(lamp.position, ends);
            if h * lamp.inverse_square < 1.0 {
                let strength = f64::from(lamp.intensity.abs()) * material.reflectance.diffuse.abs();
                if square * strength > eight * h || square * strength * 4.0 * lamp.inverse_square > eight {
                    return true;
                }
            }
        }
        // A highlight that the eye may see here.
        if material.reflectance.specular != 0.0 && self.mirrors(mesh, [a, b], material, square, eight) {
            return true;
        }
        // Normals that turn.
        let middle = unit(na + nb).unwrap_or(na);
        let ((fa, ba), (fb, bb)) = (mesh.light[a], mesh.light[b]);
        let (fm, bm) = self.lights.one_channel(&material.reflectance, pa * 0.5 + pb * 0.5, middle);
        let off = |a: f64, b: f64, m: f64| {
            let shown = |i: f64| i.clamp(0.0, 1.0);
            ((shown(a) + shown(b)) / 2.0 - shown(m)).abs()
        };
        off(fa, fb, fm) > self.tolerance || off(ba, bb, bm) > self.tolerance
    }

    /// Angles at a point between the eye and each mirrored light, suns first.
    fn angles(&self, position: Vec3, normal: Vec3) -> impl Iterator<Item = f64> {
        let (at, n) = (widen(position), widen(normal));
        let v = unit3(sub(self.lights.eye, at));
        let angle = move |light: [f64; 3]| {
            let l = unit3(light);
            let along = 2.0 * dot(n, l) * dot(n, v) - dot(l, v);
            libm::acos(along.clamp(-1.0, 1.0))
        };
        let suns = self.lights.suns.iter().map(|sun| widen(sun.towards));
        suns.chain(self.lights.lamps.iter().map(move |lamp| sub(lamp.position, at))).map(angle)
    }

    /// Returns whether a highlight near the edge bends too much along it.
    fn mirrors(
        &self,
        mesh: &Tessellated,
        edge: [usize; 2],
        material: &SurfaceMaterial,
        square: f64,
        eight: f64,
    ) -> bool {
        let ends = edge.map(|vertex| widen(mesh.positions[vertex]));
        let normals = edge.map(|vertex| mesh.normals[vertex]);
        let count = self.lights.suns.len() + self.lights.lamps.len();
        let angles = |light: usize| edge.map(|vertex| mesh.angles[vertex * count + light]);
        let eye = to_segment(self.lights.eye, ends);
        let shininess = material.reflectance.shininess.max(1.0);
        // Twice the turn of its normals.
        let turned = 2.0 * libm::acos(f64::from(normals[0].dot(normals[1])).clamp(-1.0, 1.0));
        let strong = |nearest: f64, angles: [f64; 2], intensity: f64| {
            let strength = material.reflectance.specular.abs() * intensity;
            let bends = square * shininess * strength > eight * nearest;
            if !bends {
                return false;
            }
            // Along the edge the mirrored direction turns by at most the angle that the edge subtends at the eye and at
            // the lamp, plus twice the turn of its normals.
            let turn = libm::sqrt(square / nearest.max(f64::MIN_POSITIVE)) + turned;
            let angle = (angles[0].min(angles[1]) - turn).max(0.0);
            let most = if angle < core::f64::consts::FRAC_PI_2 { libm::pow(libm::cos(angle), shininess) } else { 0.0 };
            most * strength > self.tolerance
        };
        let suns = self.lights.suns.iter().map(|sun| (eye, sun.intensity));
        let lamps = self.lights.lamps.iter().map(|lamp| (eye.min(to_segment(lamp.position, ends)), lamp.intensity));
        let mut lights = suns.chain(lamps).enumerate();
        lights.any(|(i, (nearest, intensity))| strong(nearest, angles(i), f64::from(intensity.abs())))
    }
}

fn unit3(v: [f64; 3]) -> [f64; 3] {
    let length = libm::sqrt(dot(v, v));
    if length > 0.0 { v.map(|c| c / length) } else { v }
}

fn distance_squared(a: [f64; 3], b: [f64; 3]) -> f64 {
    dot(sub(a, b), sub(a, b))
}

/// The square of the distance from a point to the nearest point of a segment.
fn to_segment(point: [f64; 3], [a, b]: [[f64; 3]; 2]) -> f64 {
    let (along, from) = (sub(b, a), sub(point, a));
    let part = (dot(from, along) / dot(along, along)).clamp(0.0, 1.0);
    let nearest = [0, 1, 2].map(|i| a[i] + along[i] * part);
    distance_squared(point, nearest)
}
