//! Objects: meshes with their placement and materials.

use core::ops::Range;
use std::collections::BTreeMap;

use mode13h::Angle;
use mode13h::glam::{Vec2, Vec3};
use mode13h::mesh::Mesh;
use mode13h::scene::{Object, Shared};
use toml::Spanned;

use super::error::Fault;
use super::layout::{ClipLayout, ObjectLayout};
use super::named::{Named, NamedModel};
use super::shape::Shape;
use super::value::{List, OneOrThree};
use super::{MAX_TRIANGLES, material};
use crate::model_file::Rig;

/// The changes to a mesh before it is used.
#[derive(Clone, Copy, PartialEq)]
struct Change {
    /// The scale factors along x, y and z.
    stretch: Vec3,
    /// How often textures repeat over it, along u and v.
    repeat: Vec2,
}

impl Change {
    const NONE: Self = Self { stretch: Vec3::ONE, repeat: Vec2::ONE };

    /// The bits that distinguish one change from another.
    fn bits(self) -> [u32; 5] {
        let ([x, y, z], [u, v]) = (self.stretch.to_array(), self.repeat.to_array());
        [x, y, z, u, v].map(f32::to_bits)
    }
}

/// How the mesh of an object moves.
pub(super) struct Moving {
    pub(super) rig: Shared<Rig>,
    /// The clip that it plays.
    pub(super) clip: usize,
    /// The factors of the mesh's length along x, y and z.
    pub(super) stretch: Vec3,
}

/// A shape by its name, its subdivisions and its change.
type ShapeKey = (&'static str, Vec<u32>, [u32; 5]);

/// Makes objects. Objects with the same shape share its mesh.
#[derive(Default)]
pub(super) struct Objects {
    shapes: BTreeMap<ShapeKey, Shared<Mesh>>,
    /// The number of triangles in all shapes so far.
    triangles: u64,
}

impl Objects {
    /// Makes the objects of a layout, one for each of its positions, without their motion; and returns how their mesh
    /// moves.
    pub(super) fn object(
        &mut self,
        layout: &Spanned<ObjectLayout>,
        named: &mut Named<'_>,
    ) -> Result<(Vec<Object>, Option<Moving>), Fault> {
        let span = layout.span();
        let layout = layout.get_ref();
        let (scale, stretch) = match layout.scale.as_ref().map(Spanned::get_ref) {
            None => (1.0, Vec3::ONE),
            Some(OneOrThree::One(scale)) => (scale.0, Vec3::ONE),
            Some(OneOrThree::Three(factors)) => (1.0, Vec3::from_array(factors.map(|factor| factor.0))),
        };
        let given = layout.position.as_ref().map(Spanned::span).or(layout.positions.as_ref().map(Spanned::span));
        if let (Some(span), true) = (given, layout.path.is_some()) {
            return Err(Fault::value(span, "not allowed with a `path`, which says where the object is"));
        }
        let positions: Vec<Vec3> = match (&layout.position, &layout.positions) {
            (Some(_), Some(positions)) => return Err(Fault::value(positions.span(), "not allowed with a `position`")),
            (None, Some(positions)) if positions.get_ref().is_empty() => {
                return Err(Fault::value(positions.span(), "at least one is needed"));
            }
            (None, Some(positions)) => positions.get_ref().iter().map(List::vec3).collect(),
            (position, None) => [position.as_ref().map_or(Vec3::ZERO, |position| position.get_ref().vec3())].into(),
        };
        let repeat = layout.repeat.as_ref().map_or(Vec2::ONE, |repeat| {
            let List([u, v]) = *repeat.get_ref();
            Vec2::new(u.0, v.0)
        });
        let change = Change { stretch, repeat };
        if let (None, Some(crease)) = (&layout.model, &layout.crease) {
            return Err(Fault::value(crease.span(), "only a model has a crease angle"));
        }
        if let (None, Some(clip)) = (&layout.model, &layout.clip) {
            return Err(Fault::value(clip.span(), "only a model has animations"));
        }
        let (mesh, origin, up, rig) = match (&layout.shape, &layout.model) {
            (Some(shape), None) => (self.shape(shape.0, layout, &span, change, positions.len())?, [0.0; 3], None, None),
            (None, Some(model)) => {
                if let Some(subdivisions) = &layout.subdivisions {
                    return Err(Fault::value(subdivisions.span(), "only a shape has subdivisions"));
                }
                let NamedModel { mesh, origin, up, rig } = named.model(
                    model,
                    layout.crease.as_ref().map(|crease| Angle::from_degrees(crease.get_ref().0.into())),
                )?;
                let mesh =
                    if change == Change::NONE { mesh } else { Shared::new(changed(&mesh, change, layout, &span)?) };
                (mesh, origin, up, rig)
            }
            (Some(_), Some(model)) => {
                return Err(Fault::value(model.span(), "not allowed with a `shape`: an object is one or the other"));
            }
            (None, None) => return Err(Fault::value(span, "an object needs a `shape` or a `model`")),
        };

        let clip = layout.clip.as_ref().map_or(Ok(0), |word| clip(word, rig.as_deref()))?;

        let mut object = Object::new(mesh).centred();
        object.name = match (&layout.name, &layout.shape, &layout.model) {
            (Some(name), _, _) => name.clone(),
            (None, Some(shape), _) => shape.0.name.into(),
            (None, None, Some(model)) => stem(&model.get_ref().0),
            (None, None, None) => String::new(),
        };
        object.scale = scale;
        if let Some(pivot) = layout.pivot {
            // A point in the model's file, which may be far from 0.
            let [x, y, z] = [0, 1, 2].map(|axis| (f64::from(pivot.vec3()[axis]) - origin[axis]) as f32);
            object.pivot = Vec3::new(x, y, z) * stretch;
        }
        object.up_axis = layout.up_axis.as_ref().map(|up| up.0.0).or(up).unwrap_or_default();
        if let Some(List(degrees)) = layout.angles {
            object.angles = degrees.map(|degrees| Angle::from_degrees(degrees.0));
        }
        self.materials(layout, &mut object, named)?;
        let objects = positions.into_iter().map(|position| {
            let mut object = object.clone();
            object.position = position;
            object
        });
        Ok((objects.collect(), rig.map(|rig| Moving { rig, clip, stretch })))
    }

    fn shape(
        &mut self,
        shape: Shape,
        layout: &ObjectLayout,
        span: &Range<usize>,
        change: Change,
        count: usize,
    ) -> Result<Shared<Mesh>, Fault> {
        let subdivisions = match &layout.subdivisions {
            Some(given) => shape.subdivided(&given.get_ref().0).map_err(|what| Fault::value(given.span(), what))?,
            None => shape.usual(),
        };
        // Neither is more than 2²⁶.
        self.triangles = self.triangles.saturating_add(shape.triangles(&subdivisions).saturating_mul(count as u64));
        if self.triangles > MAX_TRIANGLES {
            let span = layout.subdivisions.as_ref().map_or(span.clone(), Spanned::span);
            return Err(Fault::value(span, format!("more than {MAX_TRIANGLES} triangles in the shapes of a scene")));
        }
        let key = (shape.name, subdivisions, change.bits());
        if let Some(known) = self.shapes.get(&key) {
            return Ok(known.clone());
        }
        let mesh = shape.mesh(&key.1);
        let mesh = if change == Change::NONE { mesh } else { changed(&mesh, change, layout, span)? };
        let mesh = Shared::new(mesh);
        self.shapes.insert(key, mesh.clone());
        Ok(mesh)
    }

    fn materials(&self, layout: &ObjectLayout, object: &mut Object, named: &mut Named<'_>) -> Result<(), Fault> {
        let has_texcoords = object.mesh().texcoords().is_some();
        for i in 0..object.materials.len() {
            // One for each surface.
            let Some(texture) = object.mesh().surfaces().get(i).and_then(|surface| surface.texture.clone()) else {
                continue;
            };
            if !has_texcoords {
                continue;
            }
            if let Some(texture) = named.texture_of_model(&texture, &object.materials[i].name) {
                object.materials[i] = object.materials[i].clone().with_map(&object.mesh().surfaces()[i], &texture);
            }
        }
        if let Some(all) = &layout.material {
            for material in &mut object.materials {
                material::apply(all, material, has_texcoords, named)?;
            }
        }
        for (name, own) in layout.materials.iter().flatten() {
            let mut found = false;
            for material in object.materials.iter_mut().filter(|material| material.name == *name.get_ref()) {
                material::apply(own, material, has_texcoords, named)?;
                found = true;
            }
            if !found {
                let names: Vec<&str> = object.materials.iter().map(|material| material.name.as_str()).collect();
                let what = match names.as_slice() {
                    [""] => String::from("the object's only material has no name; write `material`"),
                    names => format!("the object has no such material; it has {}", names.join(", ")),
                };
                return Err(Fault::value(name.span(), what));
            }
        }
        Ok(())
    }
}

fn changed(mesh: &Mesh, change: Change, layout: &ObjectLayout, span: &Range<usize>) -> Result<Mesh, Fault> {
    let mut mesh = mesh.stretched(change.stretch).map_err(|error| {
        let span = layout.scale.as_ref().map_or(span.clone(), Spanned::span);
        Fault::value(span, error)
    })?;
    if let Some(repeat) = &layout.repeat {
        let Some(texcoords) = mesh.texcoords() else {
            return Err(Fault::value(repeat.span(), "the object has no texture coordinates"));
        };
        let texcoords = texcoords.iter().map(|t| *t * change.repeat).collect();
        mesh = mesh.with_texcoords(texcoords).map_err(|error| Fault::value(repeat.span(), error))?;
    }
    Ok(mesh)
}

/// The index of the clip that a model plays.
fn clip(clip: &Spanned<ClipLayout>, rig: Option<&Rig>) -> Result<usize, Fault> {
    let Some(rig) = rig else { return Err(Fault::value(clip.span(), "the model has no animation")) };
    let found = match clip.get_ref() {
        ClipLayout::Name(name) => rig.find_clip(name),
        ClipLayout::Index(index) => rig.numbered(Some(*index), &index.to_string()),
    };
    found.map_err(|unknown| Fault::value(clip.span(), unknown))
}

/// A file's name without its folder and its extension.
fn stem(name: &str) -> String {
    let path = std::path::Path::new(name);
    path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
