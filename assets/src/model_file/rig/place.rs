//! Transforms of points, directions and normals.

use crate::wide::{Wide, cross, dot};

/// A transform: the images of x, y and z, and that of the origin.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Placement([Wide; 4]);

impl Placement {
    pub(crate) const NONE: Self = Self([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]]);

    /// The transform given by a column-major matrix, whose last row is 0, 0, 0, 1 by definition.
    pub(crate) fn of_matrix(columns: [[f32; 4]; 4]) -> Self {
        Self(columns.map(|[x, y, z, _]| [x, y, z].map(f64::from)))
    }

    /// The transform given by a column-major matrix in f64.
    pub(crate) fn of_columns(columns: [[f64; 4]; 4]) -> Self {
        Self(columns.map(|[x, y, z, _]| [x, y, z]))
    }

    /// A scale, then a rotation by the quaternion x, y, z, w of any length but zero, then a translation.
    pub(crate) fn of_parts(translation: Wide, [x, y, z, w]: [f64; 4], scale: Wide) -> Self {
        let square = x * x + y * y + z * z + w * w;
        let two = if square > 0.0 { 2.0 / square } else { 0.0 };
        let columns = [
            [1.0 - two * (y * y + z * z), two * (x * y + z * w), two * (x * z - y * w)],
            [two * (x * y - z * w), 1.0 - two * (x * x + z * z), two * (y * z + x * w)],
            [two * (x * z + y * w), two * (y * z - x * w), 1.0 - two * (x * x + y * y)],
        ];
        let [x, y, z] = [0, 1, 2].map(|axis| columns[axis].map(|c| c * scale[axis]));
        Self([x, y, z, translation])
    }

    /// The sum of transforms, each times its weight.
    pub(crate) fn blend(parts: impl Iterator<Item = (Self, f64)>) -> Self {
        let mut sum = Self([[0.0; 3]; 4]);
        for (part, weight) in parts {
            for (to, from) in sum.0.as_flattened_mut().iter_mut().zip(part.0.as_flattened()) {
                *to += weight * from;
            }
        }
        sum
    }

    /// The image of the origin.
    pub(crate) fn origin(self) -> Wide {
        self.0[3]
    }

    /// The image of an axis, normalised; `None` if it has no direction.
    pub(crate) fn axis(self, axis: usize) -> Option<Wide> {
        let length = libm::sqrt(dot(self.0[axis], self.0[axis]));
        (length > 0.0 && length.is_finite()).then(|| self.0[axis].map(|c| c / length))
    }

    /// This one applied after `inner`.
    pub(crate) fn after(self, inner: Self) -> Self {
        let [x, y, z, origin] = inner.0;
        Self([self.direction(x), self.direction(y), self.direction(z), self.point(origin)])
    }

    pub(crate) fn point(self, p: Wide) -> Wide {
        let moved = self.direction(p);
        [0, 1, 2].map(|axis| moved[axis] + self.0[3][axis])
    }

    fn direction(self, d: Wide) -> Wide {
        let [x, y, z, _] = self.0;
        [0, 1, 2].map(|axis| x[axis] * d[0] + y[axis] * d[1] + z[axis] * d[2])
    }

    /// Returns whether it mirrors, so that faces are wound the other way.
    pub(crate) fn mirrors(self) -> bool {
        let [x, y, z, _] = self.0;
        dot(x, cross(y, z)) < 0.0
    }

    /// The normal of a placed surface, of any length: by the inverse transpose, times the determinant's absolute value.
    pub(crate) fn normal(self, normal: Wide) -> Wide {
        let sign = if self.mirrors() { -1.0 } else { 1.0 };
        self.area(normal).map(|c| sign * c)
    }

    /// The area vector of a placed face: by the inverse transpose, times the determinant. It follows the order of the
    /// face's corners, so it points inward if the transform mirrors.
    pub(crate) fn area(self, area: Wide) -> Wide {
        let [x, y, z, _] = self.0;
        let [a, b, c] = [cross(y, z), cross(z, x), cross(x, y)];
        [0, 1, 2].map(|axis| a[axis] * area[0] + b[axis] * area[1] + c[axis] * area[2])
    }

    /// The normal that [`normal`](Self::normal) turns into a placed one, of any length: by the transpose.
    pub(crate) fn normal_before(self, normal: Wide) -> Wide {
        let [x, y, z, _] = self.0;
        [x, y, z].map(|column| dot(column, normal))
    }
}
