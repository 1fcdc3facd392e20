//! Converts a scene for the integer path: its floats become 16.16 here, and none remain after it.
//!
//! Powers of two bring everything into range. A mesh is scaled about its pivot until its farthest coordinate lies
//! between 16,384 and 32,767: 30 bits, whatever its size. The scene is scaled about the eye until its farthest object
//! does too.

use alloc::vec::Vec;

use glam::Vec3;

use super::stats::Stats;
use super::{RenderError, Screen};
use crate::fixed::I16F16;
use crate::integer::{
    self, BinaryAngle, Camera, FixedMesh, FixedMeshParts, IntegerError, Lens, LitVertex, Object, ObjectSun, Placement,
    Sun, Vector, VertexStage, View,
};
use crate::light::{Light, Material};
use crate::mesh::Mesh;
use crate::mesh::wide::{sub, widen};
use crate::raster::{Interpolation, Vertex};
use crate::scene::{self, Scene, Shared, UpAxis};
use crate::settings::Shading;

/// The farthest coordinate.
const REACH: f64 = 32_767.0;

/// The smallest near distance, in units of the scaled scene: there W is still accurate to one part in 8,192.
const NEAREST: f64 = 1.0 / 16.0;

/// A mesh in 16.16. It holds the mesh that it was converted from, so that no other can be at the same address.
#[derive(Debug)]
struct Converted {
    mesh: Shared<Mesh>,
    pivot: Vec3,
    up_axis: UpAxis,
    positions: Vec<Vector>,
    normals: Vec<Vector>,
    /// Its coordinates, times 2^exponent, are in the object's units.
    exponent: i32,
    /// Bound on the vertices' distance from the pivot, in 1/65,536 of the mesh's own unit.
    radius: u64,
}

impl Converted {
    fn new(object: &scene::Object) -> Self {
        let mesh = object.shared_mesh();
        let upright = |[x, y, z]: [f64; 3]| match object.up_axis {
            UpAxis::Y => [x, y, z],
            UpAxis::Z => [x, z, -y],
        };
        let from_pivot = |p: &Vec3| upright(sub(widen(*p), widen(object.pivot)));
        let farthest = mesh.positions().iter().flat_map(from_pivot).fold(0.0_f64, |far, c| far.max(libm::fabs(c)));
        let exponent = exponent_to_reach(farthest);
        let scale = libm::ldexp(1.0, exponent);
        let positions: Vec<Vector> =
            mesh.positions().iter().map(|p| from_pivot(p).map(|c| fixed(c * scale).unwrap_or_default())).collect();
        let square = |v: &Vector| v.iter().map(|c| u64::from(c.to_bits().unsigned_abs()).pow(2)).sum::<u64>();
        // At most 3 · 2⁶².
        let radius = positions.iter().map(square).max().unwrap_or(0).isqrt() + 1;
        let normal = |n: &Vec3| upright(n.to_array().map(f64::from)).map(|c| fixed(c).unwrap_or_default());
        Self {
            mesh: Shared::clone(mesh),
            pivot: object.pivot,
            up_axis: object.up_axis,
            normals: mesh.normals().iter().map(normal).collect(),
            positions,
            exponent: -exponent,
            radius,
        }
    }

    fn is_of(&self, object: &scene::Object) -> bool {
        Shared::ptr_eq(&self.mesh, object.shared_mesh()) && self.pivot == object.pivot && self.up_axis == object.up_axis
    }

    /// Bounds the distance of the object's vertices from its position, in the scene's units.
    fn reach(&self, object: &scene::Object) -> f64 {
        // The radius is below 2³³.
        f64::from(object.scale) * libm::ldexp(self.radius as f64 / 65_536.0, self.exponent)
    }
}

/// The greatest power of two that scales `farthest` to at most 32,767; 0 for 0.
fn exponent_to_reach(farthest: f64) -> i32 {
    if farthest <= 0.0 {
        return 0;
    }
    let exponent = 14 - libm::ilogb(farthest);
    if libm::ldexp(farthest, exponent) > REACH { exponent - 1 } else { exponent }
}

fn fixed(x: f64) -> Option<I16F16> {
    I16F16::round_from_f64(x)
}

/// A direction of any length, scaled to 30 bits.
fn direction(v: [f64; 3]) -> Vector {
    let greatest = v.iter().fold(0.0_f64, |greatest, c| greatest.max(libm::fabs(*c)));
    v.map(|c| if greatest > 0.0 { fixed(c / greatest * 16_384.0).unwrap_or_default() } else { I16F16::default() })
}

fn sun(light: &Light) -> Option<Sun> {
    let Light::Sun { direction: towards, .. } = *light else { return None };
    let intensity = fixed(light.brightness().into())?;
    Some(Sun { direction: direction(towards.to_array().map(f64::from)), intensity })
}

fn material_of(material: &Material, scene: &Scene) -> Option<integer::Material> {
    Some(integer::Material {
        ambient: fixed(f64::from(material.ambient) * f64::from(scene.ambient))?,
        diffuse: fixed(material.diffuse.into())?,
        ramp: material.ramp.in_palette(scene.palette.as_ref()),
    })
}

/// An object of the current scene.
#[derive(Debug)]
struct Prepared {
    converted: usize,
    exponent: i32,
    placement: Placement,
    materials: core::ops::Range<usize>,
}

/// The integer path's part of a renderer: converted meshes, and the current scene.
#[derive(Debug, Default)]
pub(super) struct IntegerPath {
    meshes: Vec<Converted>,
    /// The view, and what it was made from: the camera and the focal lengths.
    view: Option<(View, Camera, [I16F16; 2])>,
    objects: Vec<Prepared>,
    materials: Vec<integer::Material>,
    suns: Vec<Sun>,
}

/// Memory for the vertices of an object.
#[derive(Debug, Default)]
pub(super) struct IntegerScratch {
    lit: Vec<LitVertex>,
    beams: Vec<ObjectSun>,
}

impl IntegerPath {
    /// Converts a scene with finite numbers. If this succeeds, the scene can be drawn.
    pub(super) fn prepare(&mut self, scene: &Scene, screen: Screen) -> Result<(), RenderError> {
        self.suns.clear();
        // Lamps, including spot lights, are left out, as the plan reports.
        let suns = scene.lights().iter().enumerate().filter(|(_, light)| matches!(light, Light::Sun { .. }));
        for (index, light) in suns {
            let what = "its intensity is beyond ±32,767, or it is one of more than 4,096 suns: too much for 16.16";
            let sun =
                sun(light).filter(|_| self.suns.len() < Sun::MAX_COUNT).ok_or(RenderError::Light { index, what })?;
            self.suns.push(sun);
        }
        self.convert(scene.objects());

        // From here on everything is relative to the eye.
        let from_eye = |p: Vec3| sub(widen(p), widen(scene.camera.eye));
        let near = f64::from(scene.camera.near);
        let mut farthest = near;
        for (object, prepared) in scene.objects().iter().zip(&self.objects) {
            let distance = from_eye(object.position).iter().fold(0.0_f64, |far, c| far.max(libm::fabs(*c)));
            farthest = farthest.max(distance + self.meshes[prepared.converted].reach(object));
        }
        let exponent = exponent_to_reach(farthest);
        let scale = libm::ldexp(1.0, exponent);
        if near * scale < NEAREST {
            return Err(RenderError::Camera("the scene reaches too far beyond the near plane for 16.16"));
        }
        let camera = Camera {
            eye: Vector::default(),
            target: direction(from_eye(scene.camera.target)),
            up: direction(scene.camera.up.to_array().map(f64::from)),
            near: fixed(near * scale).unwrap_or(I16F16::ONE),
        };
        let of_camera = |error: IntegerError| RenderError::Camera(error.what());
        let focal = screen.focal_lengths(scene.camera.field_of_view).map(fixed);
        let [Some(fx), Some(fy)] = focal else { return Err(of_camera(IntegerError::FieldOfView)) };
        let lens = Lens::with_focal_lengths(screen.width, screen.height, [fx, fy]).map_err(of_camera)?;
        let view = View::new(&camera, lens).map_err(of_camera)?;

        self.materials.clear();
        for (index, object) in scene.objects().iter().enumerate() {
            if object.parent.is_some_and(|parent| scene.get(parent).is_some()) {
                return Err(RenderError::of_object(scene, index, "it has a parent, which 16.16 does not support"));
            }
            let first = self.materials.len();
            for material in &object.materials {
                let what = "a number of its materials, times the ambient light, is beyond ±32,767: too much for 16.16";
                self.materials
                    .push(material_of(material, scene).ok_or_else(|| RenderError::of_object(scene, index, what))?);
            }
            let scaled = f64::from(object.scale);
            let scale_exponent = if scaled > 0.0 { libm::ilogb(scaled) } else { 0 };
            let prepared = &mut self.objects[index];
            prepared.materials = first..self.materials.len();
            prepared.exponent = self.meshes[prepared.converted].exponent + scale_exponent + exponent;
            prepared.placement = Placement {
                // No farther than the farthest object, so it fits.
                position: from_eye(object.position).map(|c| fixed(c * scale).unwrap_or_default()),
                pivot: Vector::default(),
                angles: object.angles.map(BinaryAngle::from),
                // 1 to 2.
                scale: fixed(libm::ldexp(scaled, -scale_exponent)).unwrap_or_default(),
            };
            let mesh = fixed_mesh(&self.meshes, prepared, object);
            let of_object = |error: IntegerError| RenderError::of_object(scene, index, error.what());
            view.check(&self.objects[index].placement, &mesh).map_err(of_object)?;
        }
        self.view = Some((view, camera, [fx, fy]));
        Ok(())
    }

    /// Finds the objects' meshes among those converted; converts new ones, and drops those that are no longer used.
    fn convert(&mut self, objects: &[scene::Object]) {
        self.meshes.retain(|mesh| objects.iter().any(|object| mesh.is_of(object)));
        self.objects.clear();
        for object in objects {
            let converted = self.meshes.iter().position(|mesh| mesh.is_of(object)).unwrap_or_else(|| {
                self.meshes.push(Converted::new(object));
                self.meshes.len() - 1
            });
            self.objects.push(Prepared { converted, exponent: 0, placement: Placement::default(), materials: 0..0 });
        }
    }

    /// The prepared scene as numbers, without its objects: camera, focal lengths, suns.
    pub(super) fn frame(&self) -> Option<(Camera, [I16F16; 2], &[Sun])> {
        self.view.as_ref().map(|&(_, camera, focal)| (camera, focal, &*self.suns))
    }

    /// An object of the prepared scene as numbers.
    pub(super) fn object<'a>(&'a self, index: usize, object: &'a scene::Object) -> Option<Object<'a, u32>> {
        let prepared = self.objects.get(index)?;
        let mesh = fixed_mesh(&self.meshes, prepared, object);
        Some(Object { mesh, placement: prepared.placement, materials: &self.materials[prepared.materials.clone()] })
    }

    /// Calls `triangle` for each triangle of an object of the prepared scene.
    pub(super) fn triangles(
        &self,
        shading: Shading,
        (index, object): (usize, &scene::Object),
        stats: &mut Stats,
        scratch: &mut IntegerScratch,
        triangle: &mut dyn FnMut(&[Vertex; 3], Interpolation),
    ) {
        let (Some((view, ..)), Some(fixed_object)) = (&self.view, self.object(index, object)) else { return };
        let IntegerScratch { lit, beams } = scratch;
        let vertices = fixed_object.mesh.vertices();
        lit.resize(vertices.max(lit.len()), LitVertex::default());
        beams.resize(self.suns.len(), ObjectSun::default());
        // `prepare` has checked the object, and there is room for everything.
        let Ok(stage) = VertexStage::new(view, fixed_object, &self.suns, shading, lit, beams) else {
            return;
        };
        let vertices = vertices as u64;
        let faces = stage.faces(triangle);
        stats.vertices += vertices;
        stats.lit += if shading == Shading::Flat { faces.lit } else { vertices };
        stats.faces += object.mesh().triangles().len() as u64;
        stats.clipped += faces.clipped;
        stats.culled += faces.culled;
        stats.drawn += faces.drawn;
    }
}

fn fixed_mesh<'a>(meshes: &'a [Converted], prepared: &Prepared, object: &'a scene::Object) -> FixedMesh<'a, u32> {
    let converted = &meshes[prepared.converted];
    // Valid, because the mesh it was converted from is.
    let parts = FixedMeshParts {
        positions: &converted.positions,
        normals: &converted.normals,
        triangles: object.mesh().triangles(),
        closed: object.mesh().is_outward(),
        twins: object.mesh().twins(),
        exponent: prepared.exponent,
        vertex_surfaces: object.mesh().vertex_surfaces(),
        triangle_surfaces: object.mesh().triangle_surfaces(),
    };
    FixedMesh { parts, radius: converted.radius, surfaces: object.mesh().surfaces().len() }
}
