//! Transforms of nodes.

use crate::wide::{Wide, cross, dot};

/// A transform: the images of x, y and z, and of the origin.
#[derive(Clone, Copy)]
pub(super) struct Placement([Wide; 4]);

impl Placement {
    pub(super) const NONE: Self = Self([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]]);

    /// Converts a matrix by columns, whose last row is 0, 0, 0, 1 by definition.
    pub(super) fn of_matrix(columns: [[f32; 4]; 4]) -> Self {
        Self(columns.map(|[x, y, z, _]| [x, y, z].map(f64::from)))
    }

    /// Composes two transforms: `inner` is applied first.
    pub(super) fn after(self, inner: Self) -> Self {
        let [x, y, z, origin] = inner.0;
        Self([self.direction(x), self.direction(y), self.direction(z), self.point(origin)])
    }

    pub(super) fn point(self, p: Wide) -> Wide {
        let moved = self.direction(p);
        [0, 1, 2].map(|axis| moved[axis] + self.0[3][axis])
    }

    fn direction(self, d: Wide) -> Wide {
        let [x, y, z, _] = self.0;
        [0, 1, 2].map(|axis| x[axis] * d[0] + y[axis] * d[1] + z[axis] * d[2])
    }

    /// Returns whether it mirrors, which reverses the winding of faces.
    pub(super) fn mirrors(self) -> bool {
        let [x, y, z, _] = self.0;
        dot(x, cross(y, z)) < 0.0
    }

    /// The normal of a transformed surface, of any length: by the inverse transpose, times the determinant's magnitude.
    pub(super) fn normal(self, normal: Wide) -> Wide {
        let [x, y, z, _] = self.0;
        let sign = if self.mirrors() { -1.0 } else { 1.0 };
        let [a, b, c] = [cross(y, z), cross(z, x), cross(x, y)];
        [0, 1, 2].map(|axis| sign * (a[axis] * normal[0] + b[axis] * normal[1] + c[axis] * normal[2]))
    }
}
