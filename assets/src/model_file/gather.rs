//! Turns the lists of a file into a mesh: splits faces, turns triples into vertices, and fills in normals.

use core::iter;
use std::collections::HashMap;

use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::mesh::normals::face_normal;
use mode13h::mesh::{Mesh, Parts, Repairs, Surface};

use super::ModelFileErrorKind;
use super::lists::{Corner, Lists};
use super::polygon::Splitter;

/// Makes the mesh from the lists, with their positions in f32. Unused surfaces are dropped. With `as_given`, faults are
/// not repaired.
///
/// # Errors
/// The error, with the line if one is at fault.
pub(super) fn mesh(
    lists: Lists,
    positions: Vec<Vec3>,
    surfaces: Vec<Surface>,
    crease: Option<Angle>,
    as_given: bool,
) -> Result<(Mesh, Repairs), (Option<u64>, ModelFileErrorKind)> {
    let Split { triangles, triangle_surfaces, lines, groups, surfaces } = split(&lists, &positions, surfaces)?;
    let Lists { texcoords, normals, corners, .. } = lists;
    let (triples, triangles) = vertices(&corners, triangles, positions.len()).map_err(|kind| (None, kind))?;
    drop(corners);

    let place = |triple: &Corner| positions[triple.position as usize];
    let has_area = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|vertex| place(&triples[vertex as usize]));
        face_normal(a, b, c).is_some()
    };
    if !triangles.iter().any(has_area) {
        return Err((None, ModelFileErrorKind::NoArea));
    }
    // `Corner::NONE` is out of range.
    let pair = |triple: &Corner| texcoords.get(triple.texcoord as usize).copied();
    let has_texcoords = triples.iter().any(|triple| pair(triple).is_some());
    let parts = Parts {
        positions: triples.iter().map(place).collect(),
        normals: match normals.is_empty() {
            true => Vec::new(),
            false => triples.iter().map(|triple| normals.get(triple.normal as usize).copied()).collect(),
        },
        texcoords: match has_texcoords {
            true => triples.iter().map(|triple| pair(triple).unwrap_or_default()).collect(),
            false => Vec::new(),
        },
        triangles,
        surfaces,
        triangle_surfaces,
        lines,
        groups,
        crease,
        as_given,
    };
    drop((positions, texcoords, normals, triples));
    Mesh::from_parts(parts).map_err(|error| (None, ModelFileErrorKind::Mesh(error)))
}

/// The triangles into which the faces of a file are split.
struct Split {
    /// The triangles: the indices of their three corners in the file.
    triangles: Vec<[u32; 3]>,
    triangle_surfaces: Vec<u16>,
    /// The line of each triangle's face.
    lines: Vec<u32>,
    /// The smoothing group of each triangle; empty if the file has none.
    groups: Vec<u32>,
    /// The surfaces in use.
    surfaces: Vec<Surface>,
}

fn split(
    lists: &Lists,
    positions: &[Vec3],
    surfaces: Vec<Surface>,
) -> Result<Split, (Option<u64>, ModelFileErrorKind)> {
    let count = lists.corners.len() - 2 * lists.sizes.len();
    let mut triangles = Vec::with_capacity(count);
    let mut triangle_surfaces = Vec::with_capacity(count);
    let mut lines = Vec::with_capacity(if lists.lines.is_empty() { 0 } else { count });
    let mut groups = Vec::with_capacity(if lists.smoothing.is_empty() { 0 } else { count });
    let mut changes = lists.smoothing.iter().copied().peekable();
    let mut group = Parts::NO_GROUP;
    let mut surfaces: Vec<Option<Surface>> = surfaces.into_iter().map(Some).collect();
    let mut numbers: Vec<Option<u16>> = surfaces.iter().map(|_| None).collect();
    let mut used = Vec::new();
    let mut splitter = Splitter::default();
    let mut places = Vec::new();
    let mut first = 0;
    let runs = iter::once((0, 0)).chain(lists.runs.iter().copied());
    for (i, (from, name)) in runs.enumerate() {
        let to = lists.runs.get(i).map_or(lists.sizes.len(), |next| next.0);
        if from == to {
            continue;
        }
        let surface = match numbers[name] {
            Some(number) => number,
            None => {
                let too_many = ModelFileErrorKind::TooLarge("more than 65,536 materials");
                let number = u16::try_from(used.len()).map_err(|_| (None, too_many))?;
                used.extend(surfaces[name].take());
                *numbers[name].insert(number)
            }
        };
        for (place, &size) in (from..to).zip(&lists.sizes[from..to]) {
            // Fewer than 2³² corners, see `Lists::end_face`.
            let start = first as u32;
            let face = &lists.corners[first..first + size as usize];
            if size == 3 {
                triangles.push([start, start + 1, start + 2]);
            } else {
                places.clear();
                places.extend(face.iter().map(|corner| positions[corner.position as usize]));
                let pieces = splitter
                    .split(&places)
                    .map_err(|kind| (lists.lines.get(place).map(|&line| u64::from(line)), kind))?;
                triangles.extend(pieces.iter().map(|piece| piece.map(|corner| start + corner)));
            }
            triangle_surfaces.resize(triangles.len(), surface);
            if let Some(&line) = lists.lines.get(place) {
                lines.resize(triangles.len(), line);
            }
            if !lists.smoothing.is_empty() {
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

/// The distinct triples, in the order in which the triangles first use them, and the triangles with indices into these.
fn vertices(
    corners: &[Corner],
    mut triangles: Vec<[u32; 3]>,
    positions: usize,
) -> Result<(Vec<Corner>, Vec<[u32; 3]>), ModelFileErrorKind> {
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
                return Err(ModelFileErrorKind::TooLarge("more than 268,435,456 vertices"));
            }
            triples.push(triple);
        }
        *index = vertex;
    }
    Ok((triples, triangles))
}
