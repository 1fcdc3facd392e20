//! Meshes with one surface per vertex. A vertex is lit once, with one material, so where two
//! surfaces meet, each needs its own vertex.

use alloc::vec;
use alloc::vec::Vec;

use super::Mesh;

/// No surface, or no next vertex, so far.
const NONE: u32 = u32::MAX;

impl Mesh {
    /// Returns whether each vertex is used by triangles of one surface only.
    #[must_use]
    pub fn has_one_surface_a_vertex(&self) -> bool {
        // A vertex of several surfaces has one of them here, and differs from a triangle of another.
        let of_vertices = self.vertex_surfaces();
        let mut triangles = self.triangles.iter().zip(&self.triangle_surfaces);
        self.surfaces.len() == 1
            || triangles.all(|(triangle, surface)| triangle.iter().all(|&i| of_vertices[i as usize] == *surface))
    }

    /// Copies the mesh, splitting every vertex shared by several surfaces into one for each. New vertices come at the
    /// end.
    #[must_use]
    pub fn with_one_surface_a_vertex(&self) -> Self {
        let mut mesh = self.clone();
        // For each vertex, its surface and the next vertex split off from the same original.
        let mut links: Vec<(u32, u32)> = vec![(NONE, NONE); mesh.positions.len()];
        for (triangle, &surface) in mesh.triangles.iter_mut().zip(&mesh.triangle_surfaces) {
            for index in triangle {
                let (mut at, is_open) = (*index, |owner: u32| owner == NONE || owner == u32::from(surface));
                while !is_open(links[at as usize].0) && links[at as usize].1 != NONE {
                    at = links[at as usize].1;
                }
                if is_open(links[at as usize].0) {
                    links[at as usize].0 = u32::from(surface);
                } else if let Ok(new) = u32::try_from(mesh.positions.len()) {
                    // With at most three vertices per triangle the count stays below 2³³. In a mesh so large that the
                    // index does not fit, the triangle keeps another surface's vertex.
                    links[at as usize].1 = new;
                    links.push((u32::from(surface), NONE));
                    mesh.positions.push(mesh.positions[at as usize]);
                    mesh.normals.push(mesh.normals[at as usize]);
                    if let Some(texcoords) = &mut mesh.texcoords {
                        texcoords.push(texcoords[at as usize]);
                    }
                    at = new;
                }
                *index = at;
            }
        }
        mesh.with_facts()
    }
}
