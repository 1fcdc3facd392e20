//! Meshes from model files: corners that may lack a normal, smoothing groups, and the defects of scans.

use alloc::collections::BTreeMap;
use alloc::vec;
use alloc::vec::Vec;

use glam::{Vec2, Vec3};

use super::normals::SmoothingRule;
use super::shells::{self, InsideOut};
use super::topology::Edges;
use super::{Lines, Mesh, MeshError, Surface, Weight, check, normals, topology, twins};
use crate::angle::Angle;

/// The crease angle if neither the model nor the caller gives one.
const CREASE: Angle = Angle::from_degrees(40.0);

/// The contents of a model file, for [`Mesh::from_parts`]. Empty lists count as absent.
///
/// ```
/// use mode13h::glam::Vec3;
/// use mode13h::mesh::{Mesh, Parts};
///
/// let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
/// let (mesh, repairs) = Mesh::from_parts(Parts { positions, triangles: vec![[0, 1, 2]], ..Parts::default() })?;
/// assert_eq!((mesh.normals()[0], repairs.turned), (Vec3::Z, 0));
/// # Ok::<(), mode13h::mesh::MeshError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Parts {
    /// The position of each vertex.
    pub positions: Vec<Vec3>,
    /// A normal for each vertex, of any length. Where it is `None` or zero, it is computed from the faces around the
    /// vertex.
    pub normals: Vec<Option<Vec3>>,
    /// A pair of texture coordinates for each vertex: u to the right, v up.
    pub texcoords: Vec<Vec2>,
    /// Three vertex indices each, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The surfaces.
    pub surfaces: Vec<Surface>,
    /// The index of each triangle's surface.
    pub triangle_surfaces: Vec<u16>,
    /// The line of each triangle's face in the file, counted from 1.
    pub lines: Vec<u32>,
    /// The smoothing group of each triangle, [`FLAT`](Self::FLAT) or [`NO_GROUP`](Self::NO_GROUP). Normals are averaged
    /// within a group.
    pub groups: Vec<u32>,
    /// The crease angle: two faces that differ by more have a sharp edge between them. It replaces the groups. With
    /// `None` the groups decide; without groups the angle is 40°, except that a scan, recognised by sharp edges that
    /// end at random places, is smooth everywhere.
    pub crease: Option<Angle>,
    /// Disables repairs: triangles keep their number, order and corners, which callers that move
    /// the vertices rely on ([`Mesh::with_vertices`]).
    pub as_given: bool,
}

impl Parts {
    /// The group of a flat-shaded triangle.
    pub const FLAT: u32 = SmoothingRule::FLAT;
    /// The group of a triangle in no group.
    pub const NO_GROUP: u32 = SmoothingRule::NO_GROUP;
}

/// Counts of the defects repaired in a closed mesh.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[non_exhaustive]
pub struct Repairs {
    /// The number of pairs of back-to-back faces that were removed.
    pub pairs: usize,
    /// The number of solids that were inside out and were flipped.
    pub turned: usize,
}

impl Mesh {
    /// Makes a mesh from the contents of a model file. If the mesh is closed, two defects of scans
    /// are repaired: pairs of back-to-back triangles, with the same three points, are removed where
    /// other faces continue at their edges; and solids that are inside out are flipped, unless they
    /// are cavities in others. Vertices that become unused are dropped.
    ///
    /// # Errors
    /// The errors of [`Mesh::new`]; a list that is neither empty nor has one entry for each vertex or triangle; a pair
    /// of texture coordinates that is not finite; a surface that does not exist.
    pub fn from_parts(parts: Parts) -> Result<(Self, Repairs), MeshError> {
        let Parts {
            mut positions,
            normals,
            mut texcoords,
            mut triangles,
            surfaces,
            mut triangle_surfaces,
            mut lines,
            mut groups,
            crease,
            as_given,
        } = parts;
        check(&positions, &triangles)?;
        let of_vertices = [("normals", normals.len()), ("texture coordinates", texcoords.len())];
        let of_triangles =
            [("triangle surfaces", triangle_surfaces.len()), ("lines", lines.len()), ("groups", groups.len())];
        for (lists, needed) in [(&of_vertices[..], positions.len()), (&of_triangles, triangles.len())] {
            if let Some(&(what, given)) = lists.iter().find(|(_, given)| ![0, needed].contains(given)) {
                return Err(MeshError::Count { what, given, needed });
            }
        }
        if let Some(vertex) = texcoords.iter().position(|pair| !pair.is_finite()) {
            return Err(MeshError::TexcoordNotFinite { vertex });
        }
        let surfaces = if surfaces.is_empty() { vec![Surface::default()] } else { surfaces };
        triangle_surfaces.resize(triangles.len(), 0);
        if let Some(triangle) = triangle_surfaces.iter().position(|&surface| usize::from(surface) >= surfaces.len()) {
            return Err(MeshError::SurfaceOutOfRange { triangle });
        }
        let mut known: Vec<Option<Vec3>> = normals.into_iter().map(|normal| normal.and_then(normals::unit)).collect();
        known.resize(positions.len(), None);
        let complete = known.iter().all(Option::is_some);

        let mut points = topology::weld(&positions);
        let mut edges = Edges::new(&triangles, &points);
        let mut repairs = Repairs::default();
        if !as_given && edges.balance() {
            let pairs = twins::mistaken(&edges, &triangles, &points, &triangle_surfaces);
            // A mesh that consists only of such pairs is left unchanged.
            if !pairs.is_empty() && 2 * pairs.len() < triangles.len() {
                repairs.pairs = pairs.len();
                let mut keep = vec![true; triangles.len()];
                pairs.as_flattened().iter().for_each(|&triangle| keep[triangle as usize] = false);
                retain(&mut triangles, &keep);
                retain(&mut triangle_surfaces, &keep);
                retain(&mut lines, &keep);
                retain(&mut groups, &keep);
                let keep = drop_unused(&mut triangles, positions.len());
                retain(&mut texcoords, &keep);
                retain(&mut known, &keep);
                retain(&mut positions, &keep);
                points = topology::weld(&positions);
                edges = Edges::new(&triangles, &points);
            }
            if let Some(inside_out) = shells::inside_out(&positions, &triangles, &edges) {
                repairs.turned = inside_out.count();
                let copies = turn(&inside_out, &mut triangles, &positions, &mut known);
                copy(&mut positions, &copies);
                copy(&mut points, &copies);
                copy(&mut texcoords, &copies);
                edges = Edges::new(&triangles, &points);
            }
        }

        let given = known.iter().map(|normal| normal.unwrap_or(Vec3::Z)).collect();
        let mut mesh = Self::assemble_welded(positions, given, triangles, &points, &edges);
        mesh.texcoords = (!texcoords.is_empty()).then_some(texcoords);
        mesh.surfaces = surfaces;
        mesh.triangle_surfaces = triangle_surfaces;
        mesh.lines = Lines(lines);
        if !complete {
            let rule = match crease {
                Some(crease) => SmoothingRule::new(crease, &[]),
                None => SmoothingRule { edges: Some(edges), ..SmoothingRule::new(CREASE, &groups) },
            };
            mesh.average(&points, Weight::Angle, Some(rule), known);
        }
        Ok((mesh.with_facts(), repairs))
    }
}

/// Appends copies of the given entries to a list that has one entry per vertex, or none at all.
fn copy<T: Copy>(list: &mut Vec<T>, copies: &[u32]) {
    if !list.is_empty() {
        list.extend(copies.iter().map(|&vertex| list[vertex as usize]).collect::<Vec<_>>());
    }
}

/// Removes the entries not marked in `keep` from a list of the same length, or an empty one.
fn retain<T>(list: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    list.retain(|_| keep.next().is_none_or(|&keep| keep));
}

/// Renumbers the triangles' vertices to skip unused ones. Returns whether each vertex is used.
fn drop_unused(triangles: &mut [[u32; 3]], vertices: usize) -> Vec<bool> {
    let mut used = vec![false; vertices];
    triangles.as_flattened().iter().for_each(|&vertex| used[vertex as usize] = true);
    let mut before = 0;
    let number = |&used| {
        before += u32::from(used);
        before.saturating_sub(1)
    };
    let numbers: Vec<u32> = used.iter().map(number).collect();
    triangles.as_flattened_mut().iter_mut().for_each(|vertex| *vertex = numbers[*vertex as usize]);
    used
}

/// Flips the faces that are inside out, and negates a solid's given normals if most of them then
/// point inward. Returns the vertices that need a copy because a face with negated normals shares
/// them with one that keeps its own; the copies come at the end.
fn turn(
    inside_out: &InsideOut,
    triangles: &mut [[u32; 3]],
    positions: &[Vec3],
    known: &mut Vec<Option<Vec3>>,
) -> Vec<u32> {
    let mut agrees = vec![0.0; inside_out.shells()];
    let mut is_shared = vec![false; known.len()];
    for (number, triangle) in triangles.iter_mut().enumerate() {
        let Some(shell) = inside_out.shell(number) else { continue };
        triangle.swap(1, 2);
        let [a, b, c] = triangle.map(|vertex| positions[vertex as usize]);
        let face = normals::face_normal(a, b, c).unwrap_or(Vec3::ZERO);
        let given = triangle.iter().filter_map(|&vertex| known[vertex as usize]);
        agrees[shell] += given.map(|normal| f64::from(normal.dot(face))).sum::<f64>();
    }
    let turns = |number: usize| inside_out.shell(number).is_some_and(|shell| agrees[shell] < 0.0);
    for (number, triangle) in triangles.iter().enumerate() {
        if !turns(number) {
            triangle.iter().for_each(|&vertex| is_shared[vertex as usize] = true);
        }
    }
    // For each vertex of a flipped face, the vertex with the negated normal.
    let mut turned: BTreeMap<u32, u32> = BTreeMap::new();
    let mut copies = Vec::new();
    for (number, triangle) in triangles.iter_mut().enumerate() {
        if !turns(number) {
            continue;
        }
        for vertex in triangle {
            let Some(normal) = known[*vertex as usize] else { continue };
            *vertex = *turned.entry(*vertex).or_insert_with_key(|&vertex| {
                if !is_shared[vertex as usize] {
                    known[vertex as usize] = Some(-normal);
                    return vertex;
                }
                copies.push(vertex);
                known.push(Some(-normal));
                // At most three for each triangle.
                known.len() as u32 - 1
            });
        }
    }
    copies
}
