//! Meshes in a scene, with position, rotation and materials.

use alloc::string::String;
use alloc::vec::Vec;

use glam::{Mat3, Vec3};

use super::{ObjectId, Scene, Shared};
use crate::angle::Angle;
use crate::light::Material;
use crate::mesh::Mesh;
use crate::mesh::wide::{dot, sub, widen};

/// The axis of a mesh that points up.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum UpAxis {
    /// y, as in the scene.
    #[default]
    Y,
    /// z: the mesh is first rotated back by a quarter turn about x, exactly.
    Z,
}

/// A mesh in a scene, with position, rotation and materials.
#[derive(Clone, Debug)]
pub struct Object {
    /// The display name.
    pub name: String,
    mesh: Shared<Mesh>,
    /// The materials, one for each surface of the mesh.
    pub materials: Vec<Material>,
    /// The point that it rotates about, in the mesh's coordinates.
    pub pivot: Vec3,
    /// The position of the pivot in the scene, or in the parent's coordinates.
    pub position: Vec3,
    /// The scale factor of the mesh; not negative.
    pub scale: f32,
    /// The axis of the mesh that points up.
    pub up_axis: UpAxis,
    /// Whether the object is drawn. The children of an invisible object are not drawn either.
    pub visible: bool,
    /// The object that it moves, rotates and scales with; its position is then in the coordinates of the parent's mesh.
    /// A parent that was removed counts as none.
    pub parent: Option<ObjectId>,
    /// The angles about x, y and z. The rotation about z is applied first, then y, then x: y spins the object like a
    /// turntable, x tilts the table.
    ///
    /// The matrix is computed from the angles in every frame, never as a product of small steps, so it always stays a
    /// rotation. If the angles are set from the time, frame n does not depend on whether earlier frames were drawn.
    pub angles: [Angle; 3],
}

impl Object {
    /// Returns whether any of its surfaces is coloured: it has a texture, or a diffuse colour that is not grey.
    #[must_use]
    pub fn has_colors(&self) -> bool {
        let is_colored = |[red, green, blue]: [f32; 3]| red != green || green != blue;
        self.mesh().surfaces().iter().any(|surface| is_colored(surface.diffuse))
            || self.materials.iter().any(|material| material.texture.is_some())
    }

    /// Makes an object of the mesh at the origin, unrotated, with materials made from its surfaces: the first uses the
    /// palette's first ramp, the second its second, and so on, wrapping around.
    ///
    /// A material takes the brightness of its surface's `diffuse`, 15 % of it as ambient light and the rest as diffuse
    /// light, but not its hue: colours come from the ramp. To see the hue, set [`Material::color`], or make a palette
    /// with `mode13h_assets::auto_palette`.
    ///
    /// If surfaces of the mesh share vertices, the mesh is copied, with one copy of such a vertex for each surface. To
    /// share one mesh between objects even so, call [`Mesh::with_one_surface_a_vertex`] first.
    #[must_use]
    pub fn new(mesh: impl Into<Shared<Mesh>>) -> Self {
        let mesh = in_parts(mesh.into());
        Self {
            name: String::new(),
            materials: materials_of(&mesh).collect(),
            mesh,
            pivot: Vec3::ZERO,
            position: Vec3::ZERO,
            scale: 1.0,
            up_axis: UpAxis::Y,
            visible: true,
            parent: None,
            angles: [Angle::default(); 3],
        }
    }

    /// Sets the display name.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// Sets the position, in the scene or in the parent's coordinates.
    ///
    /// ```
    /// use mode13h::glam::Vec3;
    /// use mode13h::mesh::shapes;
    /// use mode13h::scene::{Object, Scene};
    ///
    /// let mut scene = Scene::new();
    /// scene.add(Object::new(shapes::cube()).named("crate").at(Vec3::new(0.0, 1.0, -4.0)).scaled(0.5));
    /// assert_eq!(scene.objects()[0].position.z, -4.0);
    /// ```
    #[must_use]
    pub fn at(mut self, position: impl Into<Vec3>) -> Self {
        self.position = position.into();
        self
    }

    /// Sets the scale factor.
    #[must_use]
    pub fn scaled(mut self, scale: f32) -> Self {
        self.scale = scale;
        self
    }

    /// Sets the angles about x, y and z, as in [`angles`](Self::angles).
    #[must_use]
    pub fn turned(mut self, angles: [Angle; 3]) -> Self {
        self.angles = angles;
        self
    }

    /// Moves the pivot to the centre of the mesh, which then lies at `position`.
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

    /// Replaces the mesh and keeps everything else, as for the next pose of an animation. If the mesh has more surfaces
    /// than there are materials, the others get new ones, as in [`new`](Self::new), and shared vertices are split as
    /// there. The renderer then recomputes everything it caches for the object, even if the new mesh is equal, so call
    /// this only when something moves.
    pub fn set_mesh(&mut self, mesh: impl Into<Shared<Mesh>>) {
        self.mesh = in_parts(mesh.into());
        let first = self.materials.len();
        self.materials.extend(materials_of(&self.mesh).skip(first));
    }

    /// The mesh, for callers that store it.
    pub(crate) fn shared_mesh(&self) -> &Shared<Mesh> {
        &self.mesh
    }

    /// Checks the object; the error says what is wrong.
    pub(crate) fn check(&self) -> Result<(), &'static str> {
        if !(self.position.is_finite() && self.pivot.is_finite() && self.scale.is_finite()) {
            return Err("its position, pivot and scale must be finite");
        }
        if self.scale < 0.0 {
            return Err("its scale must not be negative");
        }
        if !self.angles.iter().all(|angle| angle.to_radians().is_finite()) {
            return Err("its angles must be finite");
        }
        if self.materials.len() < self.mesh.surfaces().len() {
            return Err("it must have a material for every surface of its mesh");
        }
        if !self.materials.iter().all(Material::is_finite) {
            return Err("the numbers of its materials must be finite");
        }
        if !self.mesh.surfaces().iter().all(|surface| surface.opacity.is_finite()) {
            return Err("the opacities of its mesh's surfaces must be finite");
        }
        if self.materials.iter().any(|material| material.shininess < 0.0) {
            return Err("the shininess of its materials must not be negative");
        }
        Ok(())
    }

    /// Rotates the object further about the x axis.
    pub fn rotate_x(&mut self, angle: Angle) {
        self.angles[0] += angle;
    }

    /// Rotates the object further about the y axis.
    pub fn rotate_y(&mut self, angle: Angle) {
        self.angles[1] += angle;
    }

    /// Rotates the object further about the z axis.
    pub fn rotate_z(&mut self, angle: Angle) {
        self.angles[2] += angle;
    }

    /// Sets the angles from a rotation matrix, for instance `Mat3::from_quat`: afterwards [`rotation`](Self::rotation)
    /// is that matrix, within 2 · 10⁻⁶ in each element, applied after the up axis, like the angles.
    ///
    /// The columns should be orthonormal and right-handed; any other matrix gives some rotation. Numbers that are not
    /// finite are an error when the object is drawn.
    ///
    /// ```
    /// use mode13h::glam::{Mat3, Quat, Vec3};
    /// use mode13h::mesh::shapes;
    /// use mode13h::scene::Object;
    ///
    /// let mut object = Object::new(shapes::cube());
    /// let turn = Mat3::from_quat(Quat::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), 2.0));
    /// object.set_rotation(turn);
    /// assert!(object.rotation().abs_diff_eq(turn, 2e-6));
    /// ```
    pub fn set_rotation(&mut self, rotation: Mat3) {
        let at = |row: usize, column: usize| f64::from(rotation.col(column)[row]);
        // The first row of x·y·z is (cy·cz, −cy·sz, sy).
        let cy = libm::hypot(at(0, 0), at(0, 1));
        let y = libm::atan2(at(0, 2), cy);
        // At y = ±90° (gimbal lock), rotations about x and z coincide: the whole rotation goes to
        // x.
        let z = if cy > 1e-6 { libm::atan2(-at(0, 1), at(0, 0)) } else { 0.0 };
        // The rotation that takes (sz, cz, 0) to (0, cx, sx): even close to gimbal lock, x makes up for the error of z.
        let (sz, cz) = libm::sincos(z);
        let x = libm::atan2(at(2, 0) * sz + at(2, 1) * cz, at(1, 0) * sz + at(1, 1) * cz);
        self.angles = [x, y, z].map(Angle::from_radians);
    }

    /// The matrix from the mesh's directions to the scene's: its up axis, then its angles. Orthonormal within 10⁻⁶.
    #[must_use]
    pub fn rotation(&self) -> Mat3 {
        // By rows, each number rounded to the nearest f32.
        Mat3::from_cols_array_2d(&self.turn().map(|row| row.map(|c| c as f32))).transpose()
    }

    /// The matrix of [`rotation`](Self::rotation) in f64, by rows.
    pub(crate) fn turn(&self) -> [[f64; 3]; 3] {
        self.turned_by(self.angles)
    }

    /// The matrix of [`turn`](Self::turn) with other angles.
    pub(super) fn turned_by(&self, angles: [Angle; 3]) -> [[f64; 3]; 3] {
        match self.up_axis {
            UpAxis::Y => turn(angles),
            // (x, y, z) becomes (x, z, −y).
            UpAxis::Z => turn(angles).map(|[x, y, z]| [x, -z, y]),
        }
    }
}

/// An object's transform to the world, its parents included: world = position + scale · turn · (point − pivot).
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Placement {
    /// The rotation matrix, by rows.
    pub(crate) turn: [[f64; 3]; 3],
    pub(crate) scale: f64,
    /// The position of its pivot.
    pub(crate) position: [f64; 3],
}

impl Placement {
    /// The transform of an object without regard to its parent.
    pub(crate) fn of(object: &Object) -> Self {
        Self { turn: object.turn(), scale: f64::from(object.scale), position: widen(object.position) }
    }

    /// The transform applied within the coordinates of `parent`.
    fn within(self, parent: &Object) -> Self {
        let above = Self::of(parent);
        let position = above.point(parent.pivot, self.position);
        Self { turn: matrix_product(&above.turn, &self.turn), scale: above.scale * self.scale, position }
    }

    /// The world position of a point of the mesh.
    fn point(&self, pivot: Vec3, point: [f64; 3]) -> [f64; 3] {
        let from_pivot = sub(point, widen(pivot));
        core::array::from_fn(|i| self.position[i] + self.scale * dot(self.turn[i], from_pivot))
    }

    fn is_finite(&self) -> bool {
        self.turn.iter().flatten().chain(&self.position).chain([&self.scale]).all(|number| number.is_finite())
    }
}

impl Scene {
    /// An object's parent, the parent's parent, and so on; at most as many as there are objects.
    fn ancestors(&self, index: usize) -> impl Iterator<Item = &Object> {
        let parent = |object: &Object| object.parent.and_then(|id| self.get(id));
        let first = self.objects().get(index).and_then(parent);
        core::iter::successors(first, move |object| parent(object)).take(self.objects().len())
    }

    /// The transform of the object with this index.
    pub(crate) fn placement(&self, index: usize) -> Placement {
        self.ancestors(index).fold(Placement::of(&self.objects()[index]), Placement::within)
    }

    /// The position in the scene of a point of an object's mesh, which is scaled, turned and moved with the object and
    /// its parents. `None` if the object was removed.
    ///
    /// ```
    /// use mode13h::mesh::shapes;
    /// use mode13h::scene::{Object, Scene};
    ///
    /// let mut scene = Scene::new();
    /// let ship = scene.add(Object::new(shapes::cube()).at([5.0, 0.0, 0.0]).scaled(2.0));
    /// let gun = scene.add(Object::new(shapes::cube()).at([0.0, 1.0, 0.0]));
    /// scene[gun].parent = Some(ship);
    /// assert_eq!(scene.to_world(gun, [0.0, 0.0, 0.5]), Some([5.0, 2.0, 1.0].into()));
    /// ```
    #[must_use]
    pub fn to_world(&self, id: ObjectId, point: impl Into<Vec3>) -> Option<Vec3> {
        let index = self.index_of(id)?;
        let point = point.into().to_array().map(f64::from);
        Some(Vec3::from_array(self.placement(index).point(self.objects()[index].pivot, point).map(|c| c as f32)))
    }

    /// Returns whether the object with this index is drawn: it and all its ancestors are visible.
    #[must_use]
    pub fn is_visible(&self, index: usize) -> bool {
        self.objects().get(index).is_some_and(|object| object.visible)
            && self.ancestors(index).all(|above| above.visible)
    }

    /// Checks an object's parents; the error says what is wrong.
    pub(crate) fn check_parents(&self, index: usize) -> Result<(), &'static str> {
        if self.objects()[index].parent.is_none() {
            return Ok(());
        }
        if self.ancestors(index).count() == self.objects().len() {
            return Err("its parents form a cycle");
        }
        if !self.placement(index).is_finite() {
            return Err("its position under its parents must be finite");
        }
        Ok(())
    }
}

/// A material for each surface of a mesh.
fn materials_of(mesh: &Mesh) -> impl Iterator<Item = Material> {
    // A palette has at most 256 ramps, a power of two, and their numbers wrap around.
    let numbers = (0..=u16::MAX).cycle();
    numbers.zip(mesh.surfaces()).map(|(i, surface)| Material::from_surface(surface, i))
}

/// The mesh, with vertices split so that each belongs to one surface.
fn in_parts(mesh: Shared<Mesh>) -> Shared<Mesh> {
    if mesh.has_one_surface_a_vertex() { mesh } else { Shared::new(mesh.with_one_surface_a_vertex()) }
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

/// Copies an object with another mesh and a material for each of its surfaces. No vertex of the mesh may be shared by two
/// surfaces.
#[must_use]
pub fn with_mesh(object: &Object, mesh: Shared<Mesh>, materials: Vec<Material>) -> Object {
    Object { mesh, materials, ..object.clone() }
}

/// The rotation matrix of angles about x, y and z, by rows: z is applied first, then y, then x.
#[must_use]
pub fn turn(angles: [Angle; 3]) -> [[f64; 3]; 3] {
    let [(sx, cx), (sy, cy), (sz, cz)] = angles.map(|angle| libm::sincos(angle.to_radians()));
    let about_x = [[1.0, 0.0, 0.0], [0.0, cx, -sx], [0.0, sx, cx]];
    let about_y = [[cy, 0.0, sy], [0.0, 1.0, 0.0], [-sy, 0.0, cy]];
    let about_z = [[cz, -sz, 0.0], [sz, cz, 0.0], [0.0, 0.0, 1.0]];
    matrix_product(&about_x, &matrix_product(&about_y, &about_z))
}

/// The product of two matrices by rows, each sum in the order of its terms.
///
/// (Indexed, because nested array `map`s compile to calls, which take a twelfth of the time of drawing 500 small
/// objects.)
pub(crate) fn matrix_product(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let mut product = [[0.0; 3]; 3];
    for (to, [x, y, z]) in product.iter_mut().zip(a) {
        for (j, to) in to.iter_mut().enumerate() {
            *to = x * b[0][j] + y * b[1][j] + z * b[2][j];
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use glam::{EulerRot, Quat};
    use proptest::prelude::*;

    use super::*;
    use crate::mesh::shapes;

    fn is_set(turn: Mat3) -> bool {
        let mut object = Object::new(shapes::cube());
        object.set_rotation(turn);
        object.rotation().abs_diff_eq(turn, 2e-6)
    }

    proptest! {
        /// Any rotation is recovered, even close to gimbal lock.
        #[test]
        fn a_rotation_that_is_set_is_the_objects(
            (x, y, z) in (-4.0_f32..4.0, -4.0_f32..4.0, -4.0_f32..4.0),
            beside in prop::option::of((any::<bool>(), 1e-9_f32..1e-2)),
        ) {
            let y = match beside {
                Some((up, by)) => if up { core::f32::consts::FRAC_PI_2 - by } else { by - core::f32::consts::FRAC_PI_2 },
                None => y,
            };
            let turn = Mat3::from_quat(Quat::from_euler(EulerRot::XYZ, x, y, z).normalize());
            prop_assert!(is_set(turn), "{turn}");
        }
    }

    #[test]
    fn turns_by_right_angles_are_set() {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(0.6, 0.8, 0.0)] {
            for quarters in 0..4_u8 {
                let turn = Mat3::from_axis_angle(axis, f32::from(quarters) * core::f32::consts::FRAC_PI_2);
                assert!(is_set(turn), "{axis}, {quarters}");
            }
        }
    }
}
