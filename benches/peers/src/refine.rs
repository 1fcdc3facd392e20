//! Refines a mesh: splits edges in the middle and pushes the new vertices off the surface, since scans are rough.

use std::collections::HashMap;

use mode13h::glam::Vec3;
use mode13h::mesh::Mesh;

/// Maximum displacement of a new vertex, as a fraction of its edge's length.
const ROUGHNESS: f32 = 0.08;

/// A mesh of about this many faces, made from one that has fewer.
pub fn refined(mesh: &Mesh, faces: usize) -> Mesh {
    let (mut positions, mut triangles) = (mesh.positions().to_vec(), mesh.triangles().to_vec());
    let mut random = 0x2545_F491_u32;
    while triangles.len() < faces {
        split(&mut positions, &mut triangles, faces, &mut random);
    }
    Mesh::new(positions, triangles).expect("a legal mesh, made finer")
}

/// Splits every edge or, if that is too many, the longest ones.
fn split(positions: &mut Vec<Vec3>, triangles: &mut Vec<[u32; 3]>, faces: usize, random: &mut u32) {
    let edge = |a: u32, b: u32| (a.min(b), a.max(b));
    let length = |(a, b): (u32, u32), positions: &[Vec3]| positions[a as usize].distance(positions[b as usize]);
    // For each edge, the sum of its faces' normals, along which to displace.
    let mut edges: HashMap<(u32, u32), Vec3> = HashMap::new();
    for &[a, b, c] in triangles.iter() {
        let [p, q, r] = [a, b, c].map(|i| positions[i as usize]);
        let normal = (q - p).cross(r - p).normalize_or_zero();
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry(edge(from, to)).or_default() += normal;
        }
    }
    // By length, then by index, so that the map's order does not matter.
    let mut chosen: Vec<(u32, u32)> = edges.keys().copied().collect();
    chosen.sort_by(|&e, &f| length(f, positions).total_cmp(&length(e, positions)).then(e.cmp(&f)));
    // Every split of an edge between two faces adds two faces.
    chosen.truncate((faces - triangles.len()).div_ceil(2));
    let mut middle = HashMap::new();
    for e in chosen {
        *random ^= *random << 13;
        *random ^= *random >> 17;
        *random ^= *random << 5;
        let push = (*random as f32 / u32::MAX as f32 * 2.0 - 1.0) * ROUGHNESS * length(e, positions);
        middle.insert(e, positions.len() as u32);
        positions
            .push((positions[e.0 as usize] + positions[e.1 as usize]) / 2.0 + edges[&e].normalize_or_zero() * push);
    }
    let mut finer = Vec::with_capacity(faces + 2);
    for &[a, b, c] in triangles.iter() {
        // Rotated so that split edges come first.
        let at = |from, to| middle.get(&edge(from, to)).copied();
        let turns = [[a, b, c], [b, c, a], [c, a, b]];
        let [a, b, c] = *turns
            .iter()
            .max_by_key(|[a, b, c]| {
                (u8::from(at(*a, *b).is_some()) << 2)
                    | (u8::from(at(*b, *c).is_some()) << 1)
                    | u8::from(at(*c, *a).is_some())
            })
            .expect("three");
        match (at(a, b), at(b, c), at(c, a)) {
            (Some(ab), Some(bc), Some(ca)) => finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]),
            (Some(ab), Some(bc), None) => finer.extend([[a, ab, c], [ab, b, bc], [ab, bc, c]]),
            (Some(ab), None, Some(ca)) => finer.extend([[a, ab, ca], [ab, b, c], [ca, ab, c]]),
            (Some(ab), None, None) => finer.extend([[a, ab, c], [ab, b, c]]),
            _ => finer.push([a, b, c]),
        }
    }
    *triangles = finer;
}
