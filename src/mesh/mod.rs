//! Triangle meshes: vertices with normals, triangles, surfaces, and properties of the mesh as a whole.
//!
//! A [`Mesh`] comes from one of the [`shapes`], from the caller's own vertices ([`Mesh::new`], [`Mesh::with_normals`]),
//! or from the contents of a model file ([`Mesh::from_parts`]). A mesh is always valid: every position and normal is
//! finite, every index is in range, and there is at least one triangle. Anything else is rejected with a [`MeshError`].
//!
//! Triangles are counter-clockwise seen from outside, in a right-handed system; y is up.

mod bounds;
mod error;
mod facts;
mod moved;
pub mod normals;
mod orientation;
mod parts;
mod sets;
pub mod shapes;
mod shells;
mod split;
mod stretch;
mod surface;
mod topology;
mod twins;
pub(crate) mod wide;
mod winding;

use alloc::vec;
use alloc::vec::Vec;

use glam::{Vec2, Vec3};

pub use bounds::Bounds;
pub use error::MeshError;
pub use normals::Weight;
pub use parts::{Parts, Repairs};
pub use surface::Surface;

/// A triangle mesh.
///
/// ```
/// use mode13h::glam::Vec3;
/// use mode13h::mesh::Mesh;
///
/// let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]])?;
/// assert_eq!(mesh.normals()[0], Vec3::Z);
/// assert!(!mesh.is_closed());
/// # Ok::<(), mode13h::mesh::MeshError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    texcoords: Option<Vec<Vec2>>,
    triangles: Vec<[u32; 3]>,
    triangle_surfaces: Vec<u16>,
    surfaces: Vec<Surface>,
    lines: Lines,
    bounds: Bounds,
    closed: bool,
    outward: bool,
    convex: bool,
    /// A bit for each triangle that has a back-to-back twin; empty if none has.
    twins: Vec<u64>,
    pub(crate) facts: facts::Facts,
}

/// The line of each triangle in the file that the mesh was read from; empty if there was no file. Ignored when meshes
/// are compared, since equal meshes may be on different lines of different files.
#[derive(Clone, Debug, Default)]
struct Lines(Vec<u32>);

impl PartialEq for Lines {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Mesh {
    /// The max number of vertices, and of triangles, in a mesh: 2²⁸, which leaves the renderer four bits beside a
    /// face's index.
    pub const MAX_COUNT: usize = 1 << 28;

    /// Makes a mesh with one plain [`Surface`] and normals averaged by angle over the triangles that share a vertex.
    /// Listing a vertex twice makes a crease.
    ///
    /// Vertices keep their indices. A vertex whose faces' normals cancel is split, and the new vertices are appended
    /// (see [`normals`]).
    ///
    /// # Errors
    /// A position is not finite, an index is out of range, there is no triangle, or there are more than
    /// [`MAX_COUNT`](Self::MAX_COUNT) vertices or triangles.
    pub fn new(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        check(&positions, &triangles)?;
        let normals = vec![Vec3::Z; positions.len()];
        let points = topology::weld(&positions);
        let edges = topology::Edges::new(&triangles, &points);
        let mut mesh = Self::assemble_welded(positions, normals, triangles, &points, &edges);
        // Vertex indices, which are below 2³¹.
        let own: Vec<u32> = (0..mesh.positions.len() as u32).collect();
        let known = vec![None; mesh.positions.len()];
        mesh.average(&own, Weight::Angle, None, known);
        Ok(mesh.with_facts())
    }

    /// Makes a mesh with one plain [`Surface`] and the caller's normals, one for each vertex, which are normalised.
    ///
    /// # Errors
    /// The errors of [`new`](Self::new); a different number of normals than of vertices; a normal
    /// that is zero or not finite.
    pub fn with_normals(
        positions: Vec<Vec3>,
        mut normals: Vec<Vec3>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, MeshError> {
        check(&positions, &triangles)?;
        count("normals", normals.len(), positions.len())?;
        for (vertex, normal) in normals.iter_mut().enumerate() {
            if !normal.is_finite() {
                return Err(MeshError::NormalNotFinite { vertex });
            }
            *normal = normals::unit(*normal).ok_or(MeshError::NormalZero { vertex })?;
        }
        Ok(Self::assemble(positions, normals, triangles))
    }

    /// Sets the texture coordinates, one pair for each vertex.
    ///
    /// # Errors
    /// A different number of pairs than of vertices; a pair that is not finite.
    pub fn with_texcoords(mut self, texcoords: Vec<Vec2>) -> Result<Self, MeshError> {
        count("texture coordinates", texcoords.len(), self.positions.len())?;
        if let Some(vertex) = texcoords.iter().position(|t| !t.is_finite()) {
            return Err(MeshError::TexcoordNotFinite { vertex });
        }
        self.texcoords = Some(texcoords);
        Ok(self.with_facts())
    }

    /// Sets the surfaces, and the index of each triangle's surface.
    ///
    /// # Errors
    /// A different number of indices than of triangles; an index that is not below the number of surfaces.
    pub fn with_surfaces(mut self, surfaces: Vec<Surface>, triangle_surfaces: Vec<u16>) -> Result<Self, MeshError> {
        count("triangle surfaces", triangle_surfaces.len(), self.triangles.len())?;
        if let Some(triangle) = triangle_surfaces.iter().position(|&s| usize::from(s) >= surfaces.len()) {
            return Err(MeshError::SurfaceOutOfRange { triangle });
        }
        self.surfaces = surfaces;
        self.triangle_surfaces = triangle_surfaces;
        Ok(self.with_facts())
    }

    /// Makes a mesh from finite positions, unit normals and indices in range: a shape, or checked input.
    pub(in crate::mesh) fn assemble(positions: Vec<Vec3>, normals: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Self {
        let points = topology::weld(&positions);
        let edges = topology::Edges::new(&triangles, &points);
        Self::assemble_welded(positions, normals, triangles, &points, &edges).with_facts()
    }

    /// Does the work of [`assemble`](Self::assemble) for callers that already know the vertices' points and the edges.
    /// The caller computes the other facts.
    fn assemble_welded(
        mut positions: Vec<Vec3>,
        mut normals: Vec<Vec3>,
        mut triangles: Vec<[u32; 3]>,
        points: &[u32],
        edges: &topology::Edges,
    ) -> Self {
        // Vectors grown by `push` may hold twice the memory they need, and meshes live long.
        positions.shrink_to_fit();
        normals.shrink_to_fit();
        triangles.shrink_to_fit();
        debug_assert!(check(&positions, &triangles).is_ok() && normals.len() == positions.len());
        let bounds = Bounds::of(&positions, &triangles);
        let closed = edges.balance();
        let convex = closed && topology::is_convex(&positions, &triangles, points, edges);
        let outward = convex || (closed && winding::is_outward(&positions, &triangles, &bounds));
        let twins = twins::mark(edges, &triangles, points);
        Self {
            positions,
            normals,
            texcoords: None,
            triangle_surfaces: vec![0; triangles.len()],
            triangles,
            surfaces: vec![Surface::default()],
            lines: Lines::default(),
            bounds,
            closed,
            outward,
            convex,
            twins,
            facts: facts::Facts::default(),
        }
    }

    /// The position of each vertex.
    #[must_use]
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// A unit normal for each vertex.
    #[must_use]
    pub fn normals(&self) -> &[Vec3] {
        &self.normals
    }

    /// A pair of texture coordinates for each vertex: u to the right, v up.
    #[must_use]
    pub fn texcoords(&self) -> Option<&[Vec2]> {
        self.texcoords.as_deref()
    }

    /// The triangles, at least one: three vertices each, counter-clockwise seen from outside.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The index of each triangle's surface.
    #[must_use]
    pub fn triangle_surfaces(&self) -> &[u16] {
        &self.triangle_surfaces
    }

    /// The surfaces that [`triangle_surfaces`](Self::triangle_surfaces) indexes.
    #[must_use]
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// The surfaces, mutably; their number is fixed.
    pub fn surfaces_mut(&mut self) -> &mut [Surface] {
        &mut self.surfaces
    }

    /// The line of a triangle's face in the model file, counted from 1; `None` if the mesh was not read from a file.
    #[must_use]
    pub fn line(&self, triangle: usize) -> Option<u32> {
        self.lines.0.get(triangle).copied()
    }

    /// The index of each vertex's point: vertices at the same position share one.
    pub(crate) fn points(&self) -> Vec<u32> {
        topology::weld(&self.positions)
    }

    /// The bounding box and sphere of all vertices used by a triangle.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Returns whether every edge is traversed equally often in both directions. Then the mesh bounds one solid, or
    /// several that may share edges and points. Vertices at the same position count as one, and triangles with two
    /// corners at one point are ignored.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Returns whether the mesh is closed and faces outward everywhere. Then none of its back faces can be seen from
    /// outside.
    ///
    /// No point of space may have a negative winding number, which is tested along 64 × 64 rays on
    /// each axis. An inverted region counts only if some ray runs through it for more than 1/32 of
    /// the longest side of the mesh's box: thinner ones are taken for folds, which are common in
    /// scans.
    #[must_use]
    pub fn is_outward(&self) -> bool {
        self.outward
    }

    /// Returns whether the mesh is certainly closed, convex and wound outward. Then its front faces never hide each
    /// other. The test is exact: if rounding dents a face even slightly, the result is `false`, which costs time but
    /// never correctness.
    #[must_use]
    pub fn is_convex(&self) -> bool {
        self.convex
    }

    /// The volume inside a closed mesh, by the divergence theorem: the sum of the tetrahedra between the box's centre
    /// and each triangle. It is negative if the triangles are wound inward, and meaningless if the mesh is not closed.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let centre = wide::widen(self.bounds.centre);
        let mut six_volumes = 0.0;
        for &triangle in &self.triangles {
            let [a, b, c] = triangle.map(|i| wide::sub(wide::widen(self.positions[i as usize]), centre));
            six_volumes += wide::dot(a, wide::cross(b, c));
        }
        six_volumes / 6.0
    }
}

/// Checks the invariants of every mesh.
fn check(positions: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), MeshError> {
    if triangles.is_empty() {
        return Err(MeshError::NoTriangles);
    }
    if positions.len() > Mesh::MAX_COUNT || triangles.len() > Mesh::MAX_COUNT {
        return Err(MeshError::TooLarge);
    }
    if let Some(vertex) = positions.iter().position(|p| !p.is_finite()) {
        return Err(MeshError::PositionNotFinite { vertex });
    }
    let out = |t: &[u32; 3]| t.iter().any(|&i| i as usize >= positions.len());
    match triangles.iter().position(out) {
        Some(triangle) => Err(MeshError::IndexOutOfRange { triangle }),
        None => Ok(()),
    }
}

/// Checks that a list has as many entries as are needed.
fn count(what: &'static str, given: usize, needed: usize) -> Result<(), MeshError> {
    if given == needed { Ok(()) } else { Err(MeshError::Count { what, given, needed }) }
}
