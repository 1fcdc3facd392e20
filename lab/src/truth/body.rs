//! An object of the scene in world space.

use super::eye::Eye;
use super::vector::{Vector, add, sub, times, unit, wide};
use mode13h::light::{Light, Material};
use mode13h::scene::{Object, Scene, UpAxis};

/// A vertex in the world, and as the eye sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) world: Vector,
    /// Unit length.
    pub(super) normal: Vector,
    /// Position before the perspective division: see [`Eye::see`].
    pub(super) seen: Vector,
}

/// An object in the world.
#[derive(Clone, Debug)]
pub(super) struct Body<'a> {
    pub(super) object: &'a Object,
    /// One for each vertex of its mesh.
    pub(super) corners: Vec<Corner>,
    /// True if back faces are visible too, except those back to back with a front face.
    pub(super) two_sided: bool,
    /// True if red, green and blue are lit separately.
    pub(super) in_color: bool,
}

impl<'a> Body<'a> {
    /// The object with an index. It has no corners if it is not visible.
    pub(super) fn new(scene: &'a Scene, index: usize, eye: &Eye) -> Self {
        let object = &scene.objects()[index];
        // The object, then its ancestors, nearest first.
        let above = |below: &&'a Object| below.parent.and_then(|id| scene.get(id));
        let chain: Vec<(&Object, Turn)> =
            core::iter::successors(Some(object), above).map(|object| (object, Turn::new(object))).collect();
        let is_visible = chain.iter().all(|(object, _)| object.visible);
        let mesh = object.mesh();
        let corner = |(&point, &normal)| {
            let (mut world, mut normal) = (wide(point), wide(normal));
            for (object, turn) in &chain {
                let from_pivot = times(sub(world, wide(object.pivot)), f64::from(object.scale));
                world = add(wide(object.position), turn.apply(from_pivot));
                normal = turn.apply(normal);
            }
            Corner { world, normal: unit(normal).unwrap_or(normal), seen: eye.see(world) }
        };
        let shines_in_color = |light: &Light| light.is_colored() && light.intensity() != 0.0;
        Self {
            object,
            corners: mesh.positions().iter().zip(mesh.normals()).filter(|_| is_visible).map(corner).collect(),
            two_sided: !mesh.is_outward(),
            in_color: scene.lights().iter().any(shines_in_color) || object.materials.iter().any(Material::is_colored),
        }
    }

    /// Returns whether a triangle is shown, given whether it is `turned` away.
    pub(super) fn shows(&self, triangle: usize, turned: bool) -> bool {
        !turned || (self.two_sided && !self.object.mesh().has_twin(triangle))
    }

    /// The corners of one of its triangles.
    pub(super) fn triangle(&self, triangle: usize) -> Option<[Corner; 3]> {
        let [a, b, c] = self.object.mesh().triangles().get(triangle)?.map(|i| self.corners.get(i as usize).copied());
        Some([a?, b?, c?])
    }

    /// The material of one of its triangles.
    pub(super) fn material(&self, triangle: usize) -> Option<&'a Material> {
        let surface = *self.object.mesh().triangle_surfaces().get(triangle)?;
        self.object.materials.get(usize::from(surface))
    }
}

/// Rotation of an object: its up axis, then about z, then y, then x.
struct Turn {
    up_axis: UpAxis,
    /// Sine and cosine of the angles about x, y and z.
    angles: [(f64, f64); 3],
}

impl Turn {
    fn new(object: &Object) -> Self {
        Self { up_axis: object.up_axis, angles: object.angles.map(|angle| libm::sincos(angle.to_radians())) }
    }

    fn apply(&self, [x, y, z]: Vector) -> Vector {
        let [(sin_x, cos_x), (sin_y, cos_y), (sin_z, cos_z)] = self.angles;
        let [x, y, z] = match self.up_axis {
            UpAxis::Y => [x, y, z],
            // Laid back a quarter turn about x.
            UpAxis::Z => [x, z, -y],
        };
        let [x, y, z] = [x * cos_z - y * sin_z, x * sin_z + y * cos_z, z];
        let [x, y, z] = [x * cos_y + z * sin_y, y, z * cos_y - x * sin_y];
        [x, y * cos_x - z * sin_x, y * sin_x + z * cos_x]
    }
}
