//! Meshes with one surface per vertex. A vertex is lit once, with one material, so where two
//! surfaces meet, each needs its own vertex.

use alloc::collections::BTreeMap;
use alloc::vec;

use super::Mesh;

/// No surface so far.
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
        let mut owners = vec![NONE; mesh.positions.len()];
        // The copies of vertices for further surfaces.
        let mut copies = BTreeMap::new();
        for (triangle, &surface) in mesh.triangles.iter_mut().zip(&mesh.triangle_surfaces) {
            for index in triangle {
                let at = *index as usize;
                let owner = &mut owners[at];
                if *owner == NONE || *owner == u32::from(surface) {
                    *owner = u32::from(surface);
                } else if let Some(copy) = copies.get(&(*index, surface)) {
                    *index = *copy;
                } else if let Ok(new) = u32::try_from(mesh.positions.len()) {
                    // With at most three vertices per triangle the count stays below 2³³. In a mesh so large that the
                    // index does not fit, the triangle keeps another surface's vertex.
                    copies.insert((*index, surface), new);
                    mesh.positions.push(mesh.positions[at]);
                    mesh.normals.push(mesh.normals[at]);
                    if let Some(texcoords) = &mut mesh.texcoords {
                        texcoords.push(texcoords[at]);
                    }
                    *index = new;
                }
            }
        }
        mesh.with_facts()
    }
}
