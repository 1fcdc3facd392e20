//! Scaling of meshes by axis.

use glam::Vec3;

use super::wide::{narrow, widen};
use super::{Mesh, MeshError, normals};

impl Mesh {
    /// Copies the mesh with every x, y and z multiplied by its factor, each finite and above 0. Normals are divided by
    /// the factors and normalised, so they stay perpendicular to their faces. If the factors are powers of two, the
    /// copy is exact, and a [convex](Self::is_convex) mesh stays convex.
    ///
    /// # Errors
    /// A factor that is not finite or not above 0; a scaled position beyond the range of f32.
    pub fn stretched(&self, factors: Vec3) -> Result<Self, MeshError> {
        if !(factors.is_finite() && factors.min_element() > 0.0) {
            return Err(MeshError::Factors);
        }
        let positions = self.positions.iter().map(|p| *p * factors).collect();
        let [fx, fy, fz] = widen(factors);
        // In f64, since factors may be arbitrarily small; only the direction matters.
        let least = fx.min(fy).min(fz);
        let normals = self.normals.iter().map(|n| {
            let [x, y, z] = widen(*n);
            // A component divided by far more than the least factor vanishes; a normal with that component alone keeps
            // its direction.
            normals::unit(narrow([x * (least / fx), y * (least / fy), z * (least / fz)])).unwrap_or(*n)
        });
        self.with_vertices(positions, normals.collect())
    }
}
