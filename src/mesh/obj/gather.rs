//! From the lists of an OBJ file to a mesh: faces split, triples made vertices, normals filled in.

use std::collections::HashMap;
use std::vec::Vec;

use glam::{Vec2, Vec3};

use super::polygon::Splitter;
use super::statement::{Corner, Model};
use super::{CREASE, ObjErrorKind};
use crate::angle::Angle;
use crate::mesh::normals::Together;
use crate::mesh::shells::{self, InsideOut};
use crate::mesh::topology::Edges;
use crate::mesh::{Lines, Mesh, Surface, Weight, normals, topology, twins};

/// Counts of a model's faces that were wrong and were mended.
#[derive(Default)]
pub(super) struct Mended {
    /// The number of pairs of faces back to back that were left out.
    pub(super) pairs: usize,
    /// The number of bodies that were turned, being inside out.
    pub(super) turned: usize,
}

/// Makes the mesh. `surfaces` are those of `model.names`; those that no face uses are dropped.
///
/// # Errors
/// The error, with the line if one is at fault.
pub(super) fn mesh(
    model: Model,
    surfaces: Vec<Surface>,
    crease: Option<Angle>,
) -> Result<(Mesh, Mended), (Option<u64>, ObjErrorKind)> {
    let Split { triangles, mut triangle_surfaces, mut lines, mut groups, surfaces } = split(&model, surfaces)?;
    let Model { positions, texcoords, normals, corners, .. } = model;
    let (mut triples, mut triangles) = vertices(&corners, triangles, positions.len()).map_err(|kind| (None, kind))?;
    drop(corners);

    let place = |triple: &Corner| positions[triple.position as usize];
    let has_area = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|vertex| place(&triples[vertex as usize]));
        normals::face_normal(a, b, c).is_some()
    };
    if !triangles.iter().any(has_area) {
        return Err((None, ObjErrorKind::NoArea));
    }
    let normal = |triple: &Corner| normals.get(triple.normal as usize).copied().and_then(normals::unit);
    let mut known: Vec<Option<Vec3>> = triples.iter().map(normal).collect();
    let complete = known.iter().all(Option::is_some);

    let mut places: Vec<Vec3> = triples.iter().map(place).collect();
    let mut points = topology::weld(&places);
    let mut edges = Edges::new(&triangles, &points);
    let mut mended = Mended::default();
    if edges.balance() {
        let pairs = twins::mistaken(&edges, &triangles, &points, &triangle_surfaces);
        if !pairs.is_empty() {
            mended.pairs = pairs.len();
            let mut keep = vec![true; triangles.len()];
            pairs.as_flattened().iter().for_each(|&triangle| keep[triangle as usize] = false);
            retain(&mut triangles, &keep);
            retain(&mut triangle_surfaces, &keep);
            retain(&mut lines, &keep);
            retain(&mut groups, &keep);
            let keep = drop_unused(&mut triangles, triples.len());
            retain(&mut triples, &keep);
            retain(&mut known, &keep);
            retain(&mut places, &keep);
            points = topology::weld(&places);
            edges = Edges::new(&triangles, &points);
        }
        if let Some(inside_out) = shells::inside_out(&places, &triangles, &edges) {
            mended.turned = inside_out.count();
            let copies = turn(&inside_out, &mut triangles, &places, &mut known);
            triples.extend(copies.iter().map(|&vertex| triples[vertex as usize]).collect::<Vec<_>>());
            places.extend(copies.iter().map(|&vertex| places[vertex as usize]).collect::<Vec<_>>());
            points.extend(copies.iter().map(|&vertex| points[vertex as usize]).collect::<Vec<_>>());
            edges = Edges::new(&triangles, &points);
        }
    }

    let given = known.iter().map(|normal| normal.unwrap_or(Vec3::Z)).collect();
    let mut mesh = Mesh::assemble_welded(places, given, triangles, &points, &edges);
    // `Corner::NONE` is out of range.
    let pair = |triple: &Corner| texcoords.get(triple.texcoord as usize).copied();
    if triples.iter().any(|triple| pair(triple).is_some()) {
        mesh.texcoords = Some(triples.iter().map(|triple| pair(triple).unwrap_or(Vec2::ZERO)).collect());
    }
    mesh.surfaces = surfaces;
    mesh.triangle_surfaces = triangle_surfaces;
    mesh.lines = Lines(lines);
    if !complete {
        let together = match crease {
            Some(crease) => Together::new(crease, &[]),
            None => Together::new(CREASE, &groups).unless_scattered(edges),
        };
        mesh.average(&points, Weight::Angle, Some(together), known);
    }
    Ok((mesh.with_facts(), mended))
}

/// Removes the entries that are not to be kept from a list with one for each, or none at all.
fn retain<T>(list: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    list.retain(|_| keep.next().is_none_or(|&keep| keep));
}

/// Renumbers the vertices of triangles without those that no triangle uses. Returns for each vertex whether one uses it.
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

/// Turns faces round that are inside out, and with them their given normals, if more of these then look inward than
/// outward in a body. Returns the vertices that need a copy, for such a face beside one that keeps its normal; the
/// copies come at the end.
fn turn(
    inside_out: &InsideOut,
    triangles: &mut [[u32; 3]],
    places: &[Vec3],
    known: &mut Vec<Option<Vec3>>,
) -> Vec<u32> {
    let mut agrees = vec![0.0; inside_out.shells()];
    let mut is_shared = vec![false; known.len()];
    for (number, triangle) in triangles.iter_mut().enumerate() {
        let Some(shell) = inside_out.shell(number) else { continue };
        triangle.swap(1, 2);
        let [a, b, c] = triangle.map(|vertex| places[vertex as usize]);
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
    // For each vertex of a turned face, the vertex that has the turned normal.
    let mut turned: HashMap<u32, u32> = HashMap::new();
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

/// The triangles that the faces of a file are split into.
struct Split {
    /// The triangles: three corners each, by their numbers in the file.
    triangles: Vec<[u32; 3]>,
    triangle_surfaces: Vec<u16>,
    /// The line of each triangle's face.
    lines: Vec<u32>,
    /// The smoothing group of each triangle; empty if the file has none.
    groups: Vec<u32>,
    /// The surfaces that are used.
    surfaces: Vec<Surface>,
}

fn split(model: &Model, surfaces: Vec<Surface>) -> Result<Split, (Option<u64>, ObjErrorKind)> {
    let count = model.corners.len() - 2 * model.sizes.len();
    let mut triangles = Vec::with_capacity(count);
    let mut triangle_surfaces = Vec::with_capacity(count);
    let mut lines = Vec::with_capacity(count);
    let mut groups = Vec::with_capacity(if model.smoothing.is_empty() { 0 } else { count });
    let mut changes = model.smoothing.iter().copied().peekable();
    let mut group = Together::NO_GROUP;
    let mut surfaces: Vec<Option<Surface>> = surfaces.into_iter().map(Some).collect();
    let mut numbers: Vec<Option<u16>> = surfaces.iter().map(|_| None).collect();
    let mut used = Vec::new();
    let mut splitter = Splitter::new();
    let mut places = Vec::new();
    let mut first = 0;
    for (i, &(from, name)) in model.runs.iter().enumerate() {
        let to = model.runs.get(i + 1).map_or(model.sizes.len(), |next| next.0);
        if from == to {
            continue;
        }
        let surface = match numbers[name] {
            Some(number) => number,
            None => {
                let too_many = ObjErrorKind::TooLarge("more than 65,536 materials");
                let number = u16::try_from(used.len()).map_err(|_| (None, too_many))?;
                used.extend(surfaces[name].take());
                *numbers[name].insert(number)
            }
        };
        for (place, &size) in (from..to).zip(&model.sizes[from..to]) {
            // Fewer than 2³² corners, see `statement`.
            let start = first as u32;
            let face = &model.corners[first..first + size as usize];
            if size == 3 {
                triangles.push([start, start + 1, start + 2]);
            } else {
                places.clear();
                places.extend(face.iter().map(|corner| model.positions[corner.position as usize]));
                let line = u64::from(model.lines[place]);
                let pieces = splitter.split(&places).map_err(|kind| (Some(line), kind))?;
                triangles.extend(pieces.iter().map(|piece| piece.map(|corner| start + corner)));
            }
            triangle_surfaces.resize(triangles.len(), surface);
            lines.resize(triangles.len(), model.lines[place]);
            if !model.smoothing.is_empty() {
                while let Some((_, next)) = changes.next_if(|change| change.0 <= place) {
                    group = next;
                }
                groups.resize(triangles.len(), group);
            }
            first += size as usize;
        }
    }
    Ok(Split { triangles, triangle_surfaces, lines, groups, surfaces: used })
}

/// The different triples, in the order in which the triangles first use them, and the triangles with
/// their numbers.
fn vertices(
    corners: &[Corner],
    mut triangles: Vec<[u32; 3]>,
    positions: usize,
) -> Result<(Vec<Corner>, Vec<[u32; 3]>), ObjErrorKind> {
    let mut triples: Vec<Corner> = Vec::new();
    // Most positions have one triple, which is found without a hash.
    let mut first = vec![u32::MAX; positions];
    let mut others: HashMap<Corner, u32> = HashMap::new();
    for index in triangles.as_flattened_mut() {
        let triple = corners[*index as usize];
        // Checked below to fit.
        let new = triples.len() as u32;
        let slot = &mut first[triple.position as usize];
        let vertex = if *slot == u32::MAX {
            *slot = new;
            new
        } else if triples[*slot as usize] == triple {
            *slot
        } else {
            *others.entry(triple).or_insert(new)
        };
        if vertex == new {
            if triples.len() == Mesh::MAX_COUNT {
                return Err(ObjErrorKind::TooLarge("more than 1,431,655,765 vertices"));
            }
            triples.push(triple);
        }
        *index = vertex;
    }
    Ok((triples, triangles))
}
