//! A mesh in a scene: where it is, how it is turned, what it is made of.

use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use glam::{Mat3, Vec3};

use super::{ObjectId, Scene, Shared};
use crate::light::Material;
use crate::mesh::Mesh;
use crate::mesh::normals::face_normal;

/// Which axis of a mesh points up.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum UpAxis {
    /// y, as in the scene.
    #[default]
    Y,
    /// z: the mesh is laid back a quarter turn about x, exactly.
    Z,
}

/// A mesh in the scene: where it is, how it is turned, what it is made of.
#[derive(Clone, Debug)]
pub struct Object {
    /// A name for people.
    pub name: String,
    mesh: Shared<Mesh>,
    /// Of each vertex, its surface.
    vertex_surfaces: Vec<u16>,
    longest_edges: (f32, f32),
    steepest_texcoords: Vec<f64>,
    faceted: bool,
    /// One for each surface of the mesh.
    pub materials: Vec<Material>,
    /// The point of the mesh, in its own coordinates, that it turns about.
    pub pivot: Vec3,
    /// Where the pivot is in the scene, or in the parent's own coordinates.
    pub position: Vec3,
    /// How many times as large as the mesh it is; not negative.
    pub scale: f32,
    /// Which axis of the mesh points up.
    pub up_axis: UpAxis,
    /// Whether it is drawn. The children of an object that is not are not drawn either.
    pub visible: bool,
    /// The object that it moves, turns and grows with; its position is then in that object's own coordinates, those of
    /// its mesh. A parent that was removed counts as none.
    pub parent: Option<ObjectId>,
    angles: [f64; 3],
}

impl Object {
    /// The mesh at the origin, not turned, in materials made from its surfaces: the first in the
    /// palette's first ramp, the second in its second, and so on round.
    #[must_use]
    pub fn new(mesh: impl Into<Shared<Mesh>>) -> Self {
        let mesh = mesh.into();
        let mesh = if mesh.has_one_surface_a_vertex() { mesh } else { Shared::new(mesh.with_one_surface_a_vertex()) };
        // A palette has at most 256 ramps, a power of two, and they are counted round.
        let numbers = (0..=u16::MAX).cycle();
        let materials = numbers.zip(mesh.surfaces()).map(|(i, s)| Material::from_surface(s, i)).collect();
        Self {
            name: String::new(),
            vertex_surfaces: mesh.vertex_surfaces(),
            longest_edges: longest_edges(&mesh),
            steepest_texcoords: steepest_texcoords(&mesh),
            faceted: is_faceted(&mesh),
            mesh,
            materials,
            pivot: Vec3::ZERO,
            position: Vec3::ZERO,
            scale: 1.0,
            up_axis: UpAxis::Y,
            visible: true,
            parent: None,
            angles: [0.0; 3],
        }
    }

    /// The same object under a name for people.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// The same object turning about the middle of its mesh, which lies at `position`.
    #[must_use]
    pub fn centred(mut self) -> Self {
        self.pivot = self.mesh.bounds().centre;
        self
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The mesh, to be kept.
    pub(crate) fn shared_mesh(&self) -> &Shared<Mesh> {
        &self.mesh
    }

    /// Of each vertex of the mesh, the number of its surface.
    #[must_use]
    pub fn vertex_surfaces(&self) -> &[u16] {
        &self.vertex_surfaces
    }

    /// The longest edge of the mesh, in its own units, and the longest in its texture coordinates.
    pub(crate) fn longest_edges(&self) -> (f32, f32) {
        self.longest_edges
    }

    /// Of each surface of the mesh by how much its texture coordinates change at most over a unit of the mesh.
    pub(crate) fn steepest_texcoords(&self) -> &[f64] {
        &self.steepest_texcoords
    }

    /// Whether the normals of every face of the mesh are its own: what is far away lights each of its points alike.
    pub(crate) fn is_faceted(&self) -> bool {
        self.faceted
    }

    /// What is wrong with it, if anything.
    pub(crate) fn check(&self) -> Result<(), &'static str> {
        if !(self.position.is_finite() && self.pivot.is_finite() && self.scale.is_finite()) {
            return Err("its position, pivot and scale must be finite");
        }
        if self.scale < 0.0 {
            return Err("its scale must not be negative");
        }
        if !self.angles.iter().all(|angle| angle.is_finite()) {
            return Err("its angles must be finite");
        }
        if self.materials.len() < self.mesh.surfaces().len() {
            return Err("it must have a material for every surface of its mesh");
        }
        if !self.materials.iter().all(Material::is_finite) {
            return Err("the numbers of its materials must be finite");
        }
        Ok(())
    }

    /// Turns it further about the x axis, by radians.
    pub fn rotate_x(&mut self, angle: f64) {
        self.angles[0] += angle;
    }

    /// Turns it further about the y axis, by radians.
    pub fn rotate_y(&mut self, angle: f64) {
        self.angles[1] += angle;
    }

    /// Turns it further about the z axis, by radians.
    pub fn rotate_z(&mut self, angle: f64) {
        self.angles[2] += angle;
    }

    /// Its angles about x, y and z in radians. The turn about z comes first, then y, then x: y
    /// spins it like a turntable, x tilts the table.
    #[must_use]
    pub fn angles(&self) -> [f64; 3] {
        self.angles
    }

    /// Sets its angles about x, y and z, in radians. Set from the time, frame n is the same
    /// whether or not the frames before it were drawn.
    ///
    /// The matrix is made anew from the angles for every frame, never from a product of small
    /// steps, so it stays a rotation for ever.
    pub fn set_angles(&mut self, angles: [f64; 3]) {
        self.angles = angles;
    }

    /// The matrix that turns the mesh's directions into the scene's: its up axis, then its angles.
    /// Orthonormal within 10⁻⁶.
    #[must_use]
    pub fn rotation(&self) -> Mat3 {
        // Rows, each rounded to the nearest f32.
        Mat3::from_cols_array_2d(&self.turn().map(|row| row.map(|c| c as f32))).transpose()
    }

    /// The same in f64, by rows.
    pub(crate) fn turn(&self) -> [[f64; 3]; 3] {
        self.turned_by(self.angles)
    }

    /// What [`turn`](Self::turn) would be with other angles.
    pub(super) fn turned_by(&self, angles: [f64; 3]) -> [[f64; 3]; 3] {
        match self.up_axis {
            UpAxis::Y => turn(angles),
            // (x, y, z) stands up as (x, z, −y).
            UpAxis::Z => turn(angles).map(|[x, y, z]| [x, -z, y]),
        }
    }
}

/// Where an object stands in the world, its parents included: world = position + scale · turn · (point − pivot).
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Placement {
    /// By rows.
    pub(crate) turn: [[f64; 3]; 3],
    pub(crate) scale: f64,
    /// Of its pivot.
    pub(crate) position: [f64; 3],
}

impl Placement {
    /// An object without a parent.
    pub(crate) fn of(object: &Object) -> Self {
        let position = object.position.to_array().map(f64::from);
        Self { turn: object.turn(), scale: f64::from(object.scale), position }
    }

    /// Stands in the coordinates of `parent`.
    fn within(self, parent: &Object) -> Self {
        let above = Self::of(parent);
        let pivot = parent.pivot.to_array().map(f64::from);
        let from_pivot: [f64; 3] = core::array::from_fn(|i| self.position[i] - pivot[i]);
        let position = core::array::from_fn(|i| {
            let turned: f64 = above.turn[i].iter().zip(from_pivot).map(|(a, b)| a * b).sum();
            above.position[i] + above.scale * turned
        });
        Self { turn: matrix_product(&above.turn, &self.turn), scale: above.scale * self.scale, position }
    }

    fn is_finite(&self) -> bool {
        self.turn.iter().flatten().chain(&self.position).chain([&self.scale]).all(|number| number.is_finite())
    }
}

impl Scene {
    /// The objects that an object hangs from, the nearest first; at most as many as there are objects.
    fn ancestors(&self, index: usize) -> impl Iterator<Item = &Object> {
        let parent = |object: &Object| object.parent.and_then(|id| self.get(id));
        let first = self.objects().get(index).and_then(parent);
        core::iter::successors(first, move |object| parent(object)).take(self.objects().len())
    }

    /// Where an object stands, by its index.
    pub(crate) fn placement(&self, index: usize) -> Placement {
        self.ancestors(index).fold(Placement::of(&self.objects()[index]), Placement::within)
    }

    /// Whether an object is drawn, by its index: whether it and all that it hangs from are visible.
    #[must_use]
    pub fn is_visible(&self, index: usize) -> bool {
        self.objects().get(index).is_some_and(|object| object.visible)
            && self.ancestors(index).all(|above| above.visible)
    }

    /// What is wrong with an object's parents, if anything.
    pub(crate) fn check_parents(&self, index: usize) -> Result<(), &'static str> {
        if self.objects()[index].parent.is_none() {
            return Ok(());
        }
        if self.ancestors(index).count() == self.objects().len() {
            return Err("its parents go round in a circle");
        }
        if !self.placement(index).is_finite() {
            return Err("its place among its parents must be finite");
        }
        Ok(())
    }
}

impl From<Mesh> for Object {
    fn from(mesh: Mesh) -> Self {
        Self::new(mesh)
    }
}

impl From<Shared<Mesh>> for Object {
    fn from(mesh: Shared<Mesh>) -> Self {
        Self::new(mesh)
    }
}

/// The longest edge in space and in texture coordinates. Rounded; infinite beyond f32.
fn longest_edges(mesh: &Mesh) -> (f32, f32) {
    let (mut edge, mut texture_edge) = (0.0_f32, 0.0_f32);
    for &[a, b, c] in mesh.triangles() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            // In range, as every mesh is.
            let (from, to) = (from as usize, to as usize);
            edge = edge.max(mesh.positions()[from].distance_squared(mesh.positions()[to]));
            if let Some(texcoords) = mesh.texcoords() {
                texture_edge = texture_edge.max(texcoords[from].distance_squared(texcoords[to]));
            }
        }
    }
    // Of the greatest square alone: a root keeps the order.
    (libm::sqrtf(edge), libm::sqrtf(texture_edge))
}

/// Of each surface by how much texture coordinates change at most over a unit of its faces, those without area aside.
///
/// On a face with the edges e and f, a change g of a coordinate along e and h along f, and g' and h' of another,
/// ∇·∇' = (gg'·f·f − (gh' + g'h)·e·f + hh'·e·e) / (e·e f·f − (e·f)²). A step of one unit changes both coordinates
/// together by no more than the root of the greater eigenvalue of these products.
fn steepest_texcoords(mesh: &Mesh) -> Vec<f64> {
    let mut steepest = vec![0.0_f64; mesh.surfaces().len()];
    let Some(texcoords) = mesh.texcoords() else { return steepest };
    for (&corners, &surface) in mesh.triangles().iter().zip(mesh.triangle_surfaces()) {
        // In range, as every mesh is.
        let [p, q, r] = corners.map(|i| mesh.positions()[i as usize].to_array().map(f64::from));
        let [s, t, w] = corners.map(|i| texcoords[i as usize].to_array().map(f64::from));
        let (e, f) = ([0, 1, 2].map(|i| q[i] - p[i]), [0, 1, 2].map(|i| r[i] - p[i]));
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let (ee, ef, ff) = (dot(e, e), dot(e, f), dot(f, f));
        let area = ee * ff - ef * ef;
        if area <= 0.0 {
            continue;
        }
        let (g, h) = ([t[0] - s[0], t[1] - s[1]], [w[0] - s[0], w[1] - s[1]]);
        let product =
            |i: usize, j: usize| (g[i] * g[j] * ff - (g[i] * h[j] + g[j] * h[i]) * ef + h[i] * h[j] * ee) / area;
        let (uu, uv, vv) = (product(0, 0), product(0, 1), product(1, 1));
        let greater = (uu + vv + libm::hypot(uu - vv, 2.0 * uv)) / 2.0;
        let most = &mut steepest[usize::from(surface)];
        *most = most.max(libm::sqrt(greater));
    }
    steepest
}

/// Whether the three normals of every face are that of its plane, to some 10⁻⁵ of an angle: a 400th of a shade.
fn is_faceted(mesh: &Mesh) -> bool {
    mesh.triangles().iter().all(|corners| {
        let [a, b, c] = corners.map(|i| mesh.positions()[i as usize]);
        // What has no area shows no shade.
        let Some(normal) = face_normal(a, b, c) else { return true };
        corners.iter().all(|&i| mesh.normals()[i as usize].distance_squared(normal) < 1e-10)
    })
}

/// The turn of angles about x, y and z, by rows: z first, then y, then x.
#[must_use]
pub fn turn(angles: [f64; 3]) -> [[f64; 3]; 3] {
    let [(sx, cx), (sy, cy), (sz, cz)] = angles.map(libm::sincos);
    let about_x = [[1.0, 0.0, 0.0], [0.0, cx, -sx], [0.0, sx, cx]];
    let about_y = [[cy, 0.0, sy], [0.0, 1.0, 0.0], [-sy, 0.0, cy]];
    let about_z = [[cz, -sz, 0.0], [sz, cz, 0.0], [0.0, 0.0, 1.0]];
    matrix_product(&about_x, &matrix_product(&about_y, &about_z))
}

/// The product of two matrices by rows, each sum in the order of its terms.
pub(crate) fn matrix_product(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    a.map(|[x, y, z]| [0, 1, 2].map(|j| x * b[0][j] + y * b[1][j] + z * b[2][j]))
}
