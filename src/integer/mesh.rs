//! Meshes in 16.16: slices owned by the caller, checked once.

use super::IntegerError;
use super::vector::{Vector, cross, narrow_unit, widen};
use crate::fixed::I16F16;

mod sealed {
    pub trait Sealed {}
    impl Sealed for u16 {}
    impl Sealed for u32 {}
}

/// The index of a vertex: `u16`, or `u32` for more than 65,536 vertices.
pub trait VertexIndex: Copy + sealed::Sealed {
    /// The index as a `usize`, for the slices.
    fn place(self) -> usize;
}

impl VertexIndex for u16 {
    #[inline]
    fn place(self) -> usize {
        usize::from(self)
    }
}

impl VertexIndex for u32 {
    #[inline]
    fn place(self) -> usize {
        // Lossless on every target that the raster supports: a frame may have 2²⁴ pixels.
        self as usize
    }
}

/// A mesh in 16.16, borrowed and checked, so always valid.
#[derive(Clone, Copy, Debug)]
pub struct FixedMesh<'a, I: VertexIndex = u16> {
    pub(crate) parts: FixedMeshParts<'a, I>,
    /// The greatest distance of a vertex from the origin, in 1/65,536 of the mesh's own unit.
    pub(crate) radius: u64,
    /// The number of surfaces that the parts refer to.
    pub(crate) surfaces: usize,
}

/// The slices and values that a [`FixedMesh`] consists of.
#[derive(Clone, Copy, Debug)]
pub struct FixedMeshParts<'a, I: VertexIndex> {
    /// The positions of its vertices.
    pub positions: &'a [Vector],
    /// Their unit normals.
    pub normals: &'a [Vector],
    /// The vertices of its triangles.
    pub triangles: &'a [[I; 3]],
    /// Whether it is closed and faces outward.
    pub closed: bool,
    /// A bit for each triangle, 64 per word, set if it lies back to back with another; empty if there is none.
    pub twins: &'a [u64],
    /// The binary logarithm of its unit, in units of the scene.
    pub exponent: i32,
    /// The surface of each vertex; empty if there is only one.
    pub vertex_surfaces: &'a [u16],
    /// The surface of each triangle; empty if there is only one.
    pub triangle_surfaces: &'a [u16],
}

impl<'a, I: VertexIndex> FixedMesh<'a, I> {
    /// The largest absolute coordinate.
    pub(crate) const REACH: I16F16 = I16F16::from_int(i16::MAX);

    /// Makes a mesh from triangles and from vertices with positions and unit normals. Triangles are counter-clockwise
    /// seen from outside, in a right-handed system with y up. `closed` promises that they enclose a solid without a
    /// gap, so that back faces need not be drawn.
    ///
    /// # Errors
    /// A different number of normals than of positions; a coordinate outside ±32,767; a normal whose length is not
    /// within 2⁻¹⁴ of 1; an index out of range.
    pub fn new(
        positions: &'a [Vector],
        normals: &'a [Vector],
        triangles: &'a [[I; 3]],
        closed: bool,
    ) -> Result<Self, IntegerError> {
        count("normals", normals.len(), positions.len())?;
        let mut most = 0;
        for (vertex, position) in positions.iter().enumerate() {
            if position.iter().any(|c| c.to_bits().unsigned_abs() > Self::REACH.to_bits().unsigned_abs()) {
                return Err(IntegerError::Position { vertex });
            }
            most = most.max(square(*position));
        }
        for (vertex, normal) in normals.iter().enumerate() {
            let long = normal.iter().any(|c| c.to_bits().unsigned_abs() > 2 * 65_536);
            // 2⁻¹⁴ is 4 units.
            if long || !(65_532 * 65_532..=65_540 * 65_540).contains(&square(*normal)) {
                return Err(IntegerError::NormalNotUnit { vertex });
            }
        }
        check_indices(triangles, positions.len())?;
        let parts = FixedMeshParts {
            positions,
            normals,
            triangles,
            closed,
            twins: &[],
            exponent: 0,
            vertex_surfaces: &[],
            triangle_surfaces: &[],
        };
        Ok(Self { parts, radius: most.isqrt() + 1, surfaces: 1 })
    }

    /// Scales the mesh by 2^`exponent`.
    ///
    /// Its unit is then 2^`exponent` units of the scene, so a mesh of any size can use all of its 32 bits. Where the
    /// exponent and the binary logarithm of an object's scale add up to more than 16, drawing returns
    /// [`IntegerError::TooFar`](super::IntegerError::TooFar), as for a mesh that uses them.
    #[must_use]
    pub fn with_exponent(mut self, exponent: i8) -> Self {
        self.parts.exponent = i32::from(exponent);
        self
    }

    /// Sets the surface of each vertex and each triangle.
    ///
    /// A surface's number is the index of its [`Material`](super::Material).
    ///
    /// # Errors
    /// A number of entries that differs from the number of vertices or triangles.
    pub fn with_surfaces(
        mut self,
        vertex_surfaces: &'a [u16],
        triangle_surfaces: &'a [u16],
    ) -> Result<Self, IntegerError> {
        count("surfaces of vertices", vertex_surfaces.len(), self.parts.positions.len())?;
        count("surfaces of triangles", triangle_surfaces.len(), self.parts.triangles.len())?;
        let most = vertex_surfaces.iter().chain(triangle_surfaces).max();
        self.surfaces = most.map_or(1, |&most| usize::from(most) + 1);
        (self.parts.vertex_surfaces, self.parts.triangle_surfaces) = (vertex_surfaces, triangle_surfaces);
        Ok(self)
    }

    /// Marks the triangles that lie back to back with another: a bit for each triangle, 64 per word. Marked triangles
    /// are culled when they face away.
    #[must_use]
    pub fn with_twins(mut self, twins: &'a [u64]) -> Self {
        self.parts.twins = twins;
        self
    }

    /// Returns the slices and values that the mesh consists of.
    #[must_use]
    pub fn parts(&self) -> FixedMeshParts<'a, I> {
        self.parts
    }

    /// Counts the vertices, as many as a stage needs storage for.
    pub(crate) fn vertices(&self) -> usize {
        self.parts.positions.len()
    }

    /// Returns whether a triangle is culled when it faces away: in a closed mesh, and in a back-to-back pair.
    #[inline]
    pub(super) fn hides_back(&self, triangle: usize) -> bool {
        self.parts.closed || self.parts.twins.get(triangle / 64).is_some_and(|bits| bits >> (triangle % 64) & 1 == 1)
    }

    #[inline]
    pub(super) fn vertex_surface(&self, vertex: usize) -> usize {
        self.parts.vertex_surfaces.get(vertex).copied().unwrap_or(0).into()
    }

    #[inline]
    pub(super) fn triangle_surface(&self, triangle: usize) -> usize {
        self.parts.triangle_surfaces.get(triangle).copied().unwrap_or(0).into()
    }
}

fn count(what: &'static str, given: usize, needed: usize) -> Result<(), IntegerError> {
    if given == needed { Ok(()) } else { Err(IntegerError::Count { what, given, needed }) }
}

fn check_indices<I: VertexIndex>(triangles: &[[I; 3]], vertices: usize) -> Result<(), IntegerError> {
    match triangles.iter().position(|t| t.iter().any(|i| i.place() >= vertices)) {
        Some(triangle) => Err(IntegerError::IndexOutOfRange { triangle }),
        None => Ok(()),
    }
}

/// |v|², of components of at most 32,767: at most 3 · 2⁶² < 2⁶⁴.
pub(super) fn square(v: Vector) -> u64 {
    v.iter().map(|c| u64::from(c.to_bits().unsigned_abs()).pow(2)).sum()
}

/// The unit normal of a face, on the side where its corners are counter-clockwise; `None` if they are collinear. Exact
/// except for the final rounding.
#[must_use]
pub fn face_normal(a: Vector, b: Vector, c: Vector) -> Option<Vector> {
    let [a, b, c] = [a, b, c].map(widen);
    let from_a = |p: [i64; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
    // Differences of 33 bits, products of 66.
    narrow_unit(cross(from_a(b), from_a(c)))
}

/// Averages the unit normals of the faces around each vertex, and normalises the sum. Without that, vertices would be
/// darkened, sharp corners most (the Hungarian tutorial's slip). A normal's length is within 2⁻¹⁶ of 1.
///
/// A vertex whose faces' normals cancel gets that of its first face; one that no face with an area
/// uses gets +z. Faces beyond the 32,767th around one vertex may be ignored.
///
/// # Errors
/// Another number of normals than of positions; an index out of range.
pub fn average_normals<I: VertexIndex>(
    positions: &[Vector],
    triangles: &[[I; 3]],
    normals: &mut [Vector],
) -> Result<(), IntegerError> {
    count("normals", normals.len(), positions.len())?;
    check_indices(triangles, positions.len())?;
    const NONE: Vector = [I16F16::from_bits(0); 3];
    let faces = || {
        triangles.iter().filter_map(|t| {
            let corners = t.map(VertexIndex::place);
            let [a, b, c] = corners.map(|i| positions[i]);
            Some((corners, face_normal(a, b, c)?))
        })
    };
    normals.fill(NONE);
    for (corners, normal) in faces() {
        for i in corners {
            for (sum, c) in normals[i].iter_mut().zip(normal) {
                *sum = I16F16::from_bits(sum.to_bits().saturating_add(c.to_bits()));
            }
        }
    }
    for normal in normals.iter_mut() {
        *normal = narrow_unit(widen(*normal).map(i128::from)).unwrap_or(NONE);
    }
    for (corners, normal) in faces() {
        for i in corners {
            if normals[i] == NONE {
                normals[i] = normal;
            }
        }
    }
    for normal in normals.iter_mut().filter(|normal| **normal == NONE) {
        *normal = [I16F16::from_bits(0), I16F16::from_bits(0), I16F16::ONE];
    }
    Ok(())
}
