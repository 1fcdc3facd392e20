//! What is to be drawn: objects, a camera, lights, a palette.
//!
//! A scene is plain data. Nothing in it is borrowed between frames: change it, draw it, change it
//! again. What is wrong in it (a position that is not finite, a camera that looks nowhere) is
//! refused when it is drawn.

use alloc::vec::Vec;
use core::ops::{Index, IndexMut};

use glam::{Mat3, Vec3};

use crate::light::{Light, Material};
use crate::mesh::Mesh;
use crate::palette::{Palette, builtin};

/// A mesh that several objects, scenes and threads may share. Where the processor has no atomic
/// counter (Cortex-M0) it stays within one thread.
#[cfg(target_has_atomic = "ptr")]
pub type Shared<T> = alloc::sync::Arc<T>;
/// A mesh that several objects and scenes may share, within one thread.
#[cfg(not(target_has_atomic = "ptr"))]
pub type Shared<T> = alloc::rc::Rc<T>;

/// Which axis of a mesh points up.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
#[non_exhaustive]
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
    mesh: Shared<Mesh>,
    /// Of each vertex, its surface.
    vertex_surfaces: Vec<u16>,
    /// One for each surface of the mesh.
    pub materials: Vec<Material>,
    /// The point of the mesh, in its own coordinates, that it turns about.
    pub pivot: Vec3,
    /// Where the pivot is in the scene.
    pub position: Vec3,
    /// How many times as large as the mesh it is; not negative.
    pub scale: f32,
    /// Which axis of the mesh points up.
    pub up_axis: UpAxis,
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
            vertex_surfaces: mesh.vertex_surfaces(),
            mesh,
            materials,
            pivot: Vec3::ZERO,
            position: Vec3::ZERO,
            scale: 1.0,
            up_axis: UpAxis::Y,
            angles: [0.0; 3],
        }
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
        match self.up_axis {
            UpAxis::Y => turn(self.angles),
            // (x, y, z) stands up as (x, z, −y).
            UpAxis::Z => turn(self.angles).map(|[x, y, z]| [x, -z, y]),
        }
    }
}

/// The turn of angles about x, y and z, by rows: z first, then y, then x.
pub(crate) fn turn(angles: [f64; 3]) -> [[f64; 3]; 3] {
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

/// The eye: a perspective camera.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Camera {
    /// Where the eye is.
    pub eye: Vec3,
    /// What it looks at: the middle of the picture.
    pub target: Vec3,
    /// What is up in the picture. Where it points along the view, another axis is taken.
    pub up: Vec3,
    /// The angle between the upper and the lower edge of the picture, in radians; above 0, below π.
    pub field_of_view: f32,
    /// Nothing nearer than this is drawn; in the scene's units, above 0. It also sets the unit of
    /// depth, so it is best not much smaller than needed.
    pub near: f32,
}

impl Camera {
    /// 40°: about that of a 4:3 screen at the length of an arm and a half.
    const FIELD_OF_VIEW: f32 = 40.0 * core::f32::consts::PI / 180.0;

    /// Of the picture's height, how much a framed sphere fills.
    const FILL: f32 = 15.0 / 16.0;

    /// Looks along −z at a sphere, from where it fills fifteen sixteenths of the picture's height.
    #[must_use]
    pub fn framing(centre: Vec3, radius: f32) -> Self {
        // Half the angle under which the sphere is seen, and the distance at which its sine is that.
        // The distance is at most f32::MAX, so that a sphere of that size is still something to look
        // at.
        let half = libm::atanf(Self::FILL * libm::tanf(Self::FIELD_OF_VIEW / 2.0));
        let distance = (radius / libm::sinf(half)).clamp(f32::MIN_POSITIVE, f32::MAX);
        let eye = Vec3::new(centre.x, centre.y, (centre.z + distance).min(f32::MAX));
        Self {
            eye,
            target: centre,
            up: Vec3::Y,
            field_of_view: Self::FIELD_OF_VIEW,
            near: (distance / 128.0).max(f32::MIN_POSITIVE),
        }
    }
}

impl Default for Camera {
    /// Looks along −z at the unit sphere round the origin, in which every shape lies.
    fn default() -> Self {
        Self::framing(Vec3::ZERO, 1.0)
    }
}

/// Which object of a scene; what [`Scene::add`] gave for it.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct ObjectId(usize);

/// Everything that is drawn.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The eye.
    pub camera: Camera,
    /// Ia: how much ambient light there is.
    pub ambient: f32,
    /// The index that the frame is cleared to.
    pub background: u8,
    /// What the DAC is set to when the scene is drawn; with `None` it is left alone.
    pub palette: Option<Palette>,
    objects: Vec<Object>,
    lights: Vec<Light>,
}

impl Scene {
    /// An empty scene, dark but for ambient light, in greys, seen by the default camera.
    #[must_use]
    pub fn new() -> Self {
        Self {
            camera: Camera::default(),
            ambient: 1.0,
            background: 0,
            palette: Some(builtin::GREY.clone()),
            objects: Vec::new(),
            lights: Vec::new(),
        }
    }

    /// A mesh to look at: in the middle, filling the picture, turning about its middle, one sun
    /// from the upper right behind the eye.
    #[must_use]
    pub fn showing(mesh: impl Into<Shared<Mesh>>) -> Self {
        let mut scene = Self::new();
        let object = Object::new(mesh).centred();
        scene.camera = Camera::framing(Vec3::ZERO, object.mesh().bounds().radius);
        scene.add(object);
        scene.add_light(Light::sun([0.4, 0.6, 1.0]));
        scene
    }

    /// Puts an object into the scene.
    pub fn add(&mut self, object: Object) -> ObjectId {
        self.objects.push(object);
        ObjectId(self.objects.len() - 1)
    }

    /// Puts a light into the scene.
    pub fn add_light(&mut self, light: Light) {
        self.lights.push(light);
    }

    /// The objects, in the order in which they were put in.
    #[must_use]
    pub fn objects(&self) -> &[Object] {
        &self.objects
    }

    /// The objects, to change them.
    pub fn objects_mut(&mut self) -> &mut [Object] {
        &mut self.objects
    }

    /// The lights, in the order in which they were put in: that of their sum.
    #[must_use]
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// The lights, to change them or take them away.
    pub fn lights_mut(&mut self) -> &mut Vec<Light> {
        &mut self.lights
    }
}

impl Default for Scene {
    fn default() -> Self {
        Self::new()
    }
}

impl Index<ObjectId> for Scene {
    type Output = Object;

    /// # Panics
    /// If `id` was given by another scene that holds more objects.
    fn index(&self, id: ObjectId) -> &Object {
        &self.objects[id.0]
    }
}

impl IndexMut<ObjectId> for Scene {
    /// # Panics
    /// If `id` was given by another scene that holds more objects.
    fn index_mut(&mut self, id: ObjectId) -> &mut Object {
        &mut self.objects[id.0]
    }
}
