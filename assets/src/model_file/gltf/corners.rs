//! The triangles of a primitive, and the vertices at their corners.

use ::gltf::mesh::Mode;

use crate::model_file::ModelFileErrorKind;

/// The triangles of a primitive with `count` vertices, as indices of these.
///
/// # Errors
/// More than `most` triangles, or a vertex that does not exist.
pub(super) fn triangles(
    mode: Mode,
    indices: Option<&[u32]>,
    count: usize,
    most: usize,
) -> Result<Vec<[u32; 3]>, ModelFileErrorKind> {
    let length = indices.map_or(count, <[u32]>::len);
    let triangles = if mode == Mode::Triangles { length / 3 } else { length.saturating_sub(2) };
    if triangles > most {
        return Err(ModelFileErrorKind::TooLarge("more than 67,108,864 triangles, counted in each node"));
    }
    // Without indices there are about as many vertices as corners, far fewer than 2³².
    let vertex = |i: usize| indices.map_or(i as u32, |indices| indices[i]);
    let corners = |i: usize| match mode {
        Mode::Triangles => [3 * i, 3 * i + 1, 3 * i + 2],
        Mode::TriangleFan => [0, i + 1, i + 2],
        _ if i.is_multiple_of(2) => [i, i + 1, i + 2],
        _ => [i + 1, i, i + 2],
    };
    let triangle = |i: usize| {
        let corners = corners(i).map(vertex);
        match corners.iter().find(|corner| **corner as usize >= count) {
            Some(beyond) => Err(ModelFileErrorKind::Fault(format!("there is no vertex {beyond}, only {count}"))),
            None => Ok(corners),
        }
    };
    (0..triangles).map(triangle).collect()
}

/// Renumbers the vertices of triangles in the order of their first use, and returns the old number of each.
///
/// Many primitives and nodes may share a list of vertices of which each uses few. So `numbers` serves them all, and is
/// cleared only where it was used.
pub(super) fn used(triangles: &mut [[u32; 3]], numbers: &mut Vec<u32>, count: usize) -> Vec<u32> {
    numbers.resize(numbers.len().max(count), u32::MAX);
    let mut used = Vec::new();
    for corner in triangles.as_flattened_mut() {
        let number = &mut numbers[*corner as usize];
        if *number == u32::MAX {
            // At most the number of corners, which is below 2³².
            *number = used.len() as u32;
            used.push(*corner);
        }
        *corner = *number;
    }
    used.iter().for_each(|&corner| numbers[corner as usize] = u32::MAX);
    used
}
