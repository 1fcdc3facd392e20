//! From the lists of an OBJ file to a mesh: faces split, triples made vertices, normals filled in.

use std::collections::HashMap;
use std::vec::Vec;

use glam::{Vec2, Vec3};

use super::ObjErrorKind;
use super::polygon::Splitter;
use super::statement::{Corner, Model};
use crate::mesh::{Mesh, Surface, Weight, normals, topology};

/// The mesh. `surfaces` are those of `model.names`; those that no face uses are dropped.
///
/// # Errors
/// What is wrong, and in which line if one is at fault.
pub(super) fn mesh(model: Model, surfaces: Vec<Surface>) -> Result<Mesh, (Option<u64>, ObjErrorKind)> {
    let (triangles, triangle_surfaces, surfaces) = split(&model, surfaces)?;
    let Model { positions, texcoords, normals, corners, .. } = model;
    let (triples, triangles) = vertices(&corners, triangles, positions.len()).map_err(|kind| (None, kind))?;
    drop(corners);

    let place = |triple: &Corner| positions[triple.position as usize];
    // `Corner::NONE` is out of range of both.
    let pair = |triple: &Corner| texcoords.get(triple.texcoord as usize).copied();
    let normal = |triple: &Corner| normals.get(triple.normal as usize).copied().and_then(normals::unit);
    let known: Vec<Option<Vec3>> = triples.iter().map(normal).collect();
    let complete = known.iter().all(Option::is_some);

    let given = known.iter().map(|normal| normal.unwrap_or(Vec3::Z)).collect();
    let positions: Vec<Vec3> = triples.iter().map(place).collect();
    let points = topology::weld(&positions);
    let mut mesh = Mesh::assemble_welded(positions, given, triangles, &points);
    if triples.iter().any(|triple| pair(triple).is_some()) {
        mesh.texcoords = Some(triples.iter().map(|triple| pair(triple).unwrap_or(Vec2::ZERO)).collect());
    }
    mesh.surfaces = surfaces;
    mesh.triangle_surfaces = triangle_surfaces;
    if !complete {
        mesh.average(&points, Weight::Angle, None, known);
    }
    Ok(mesh)
}

/// Triangles as numbers of corners, their surfaces, and the surfaces that are used.
type Split = (Vec<[u32; 3]>, Vec<u16>, Vec<Surface>);

fn split(model: &Model, surfaces: Vec<Surface>) -> Result<Split, (Option<u64>, ObjErrorKind)> {
    let count = model.corners.len() - 2 * model.sizes.len();
    let mut triangles = Vec::with_capacity(count);
    let mut triangle_surfaces = Vec::with_capacity(count);
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
                let line = || model.large.iter().find(|large| large.0 == place).map(|large| large.1);
                let pieces = splitter.split(&places).map_err(|kind| (line(), kind))?;
                triangles.extend(pieces.iter().map(|piece| piece.map(|corner| start + corner)));
            }
            triangle_surfaces.resize(triangles.len(), surface);
            first += size as usize;
        }
    }
    Ok((triangles, triangle_surfaces, used))
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
            if triples.len() == Mesh::MOST {
                return Err(ObjErrorKind::TooLarge("more than 1,431,655,765 vertices"));
            }
            triples.push(triple);
        }
        *index = vertex;
    }
    Ok((triples, triangles))
}
