//! A mesh with moved vertices: stretched, or in the next pose of an animation.

use alloc::vec::Vec;

use glam::Vec3;

use super::{Mesh, MeshError, count};

impl Mesh {
    /// Copies the mesh with new positions and normals, one of each per vertex. The normals are normalised; triangles,
    /// surfaces and texture coordinates are kept. To have normals computed, pass the old ones, and call
    /// [`smooth`](Self::smooth) or [`flat`](Self::flat) on the copy.
    ///
    /// Whether the copy is closed, faces outward and is convex is tested again, since a bend may change any of these.
    /// The tests take most of the time.
    ///
    /// ```
    /// use mode13h::glam::Vec3;
    /// use mode13h::mesh::shapes;
    /// let cube = shapes::cube();
    /// // Turned inside out.
    /// let positions = cube.positions().iter().map(|p| Vec3::new(-p.x, p.y, p.z)).collect();
    /// let normals = cube.normals().iter().map(|n| Vec3::new(n.x, -n.y, -n.z)).collect();
    /// let mirrored = cube.with_vertices(positions, normals)?;
    /// assert!(mirrored.is_closed() && !mirrored.is_outward() && !mirrored.is_convex());
    /// # Ok::<(), mode13h::mesh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// The errors of [`with_normals`](Self::with_normals); a different number of positions than of vertices.
    pub fn with_vertices(&self, positions: Vec<Vec3>, normals: Vec<Vec3>) -> Result<Self, MeshError> {
        count("positions", positions.len(), self.positions.len())?;
        let mut mesh = Self::with_normals(positions, normals, self.triangles.clone())?;
        mesh.texcoords.clone_from(&self.texcoords);
        mesh.surfaces.clone_from(&self.surfaces);
        mesh.triangle_surfaces.clone_from(&self.triangle_surfaces);
        mesh.lines.clone_from(&self.lines);
        Ok(mesh.with_facts())
    }
}
