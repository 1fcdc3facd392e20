//! Models from glTF 2.0 files, `.gltf` and `.glb`.
//!
//! | read | as |
//! |---|---|
//! | the default scene, or the first, or all nodes | one mesh: each node's mesh with its transforms, once for each node |
//! | triangles, strips and fans, with indices or without | faces; points and lines are ignored |
//! | `POSITION`, `NORMAL`, `TEXCOORD_n`, `COLOR_0` in any type of number, sparse or not | positions, normals, texture coordinates; a colour for each face without a texture, up to 256 in all |
//! | materials | surfaces, by the rules below |
//! | images in the file, as data URIs and in separate files | textures, placed by `KHR_texture_transform` |
//! | skins: joints, inverse bind matrices, `JOINTS_n` and `WEIGHTS_n` | the mesh at rest, as posed by the joints, and a [`Rig`](rig::Rig) |
//! | animations of translation, rotation and scale | clips of the rig |
//! | `KHR_lights_punctual` | suns, lamps and spot lights, by the rule in `rig/stage.rs` |
//! | the first camera in perspective | a camera |
//!
//! Both sides of a face are drawn unless the mesh is closed, so `doubleSided` needs no handling. A single warning lists
//! everything ignored, such as morph targets: the mesh is read without them.
//!
//! **Materials.** With base colour b (in sRGB, like all factors here), metallic factor m and roughness r:
//!
//! | property of the surface | value |
//! |---|---|
//! | diffuse | b · (1 − m·(1 − r)/2): a smooth metal is darker, as it does not mirror its surroundings here; a rough one keeps b |
//! | specular | (1 − r) · ((1 − m)·0.22 + m·b); 0.22 is 4 % in sRGB |
//! | shininess | 2/r⁴ − 2, at most 1000: Blinn's exponent for that roughness |
//! | opacity | alpha of the base colour in the mode `BLEND`, or 1 for an alpha of 0, with a warning; textures' alpha is ignored, and so is the mode `MASK` |
//! | texture | that of the base colour |
//!
//! A metallic-roughness texture is replaced by its means. Emission is added to the diffuse colour; an emissive texture
//! is shown where the base colour is black and has no texture. Unlit materials are matt. Vertex colours multiply the
//! diffuse part of the base colour, and leave the rest of the material unchanged. Textures repeat: a clamping sampler
//! causes a warning if coordinates leave the texture.

mod accessor;
mod container;
mod corners;
mod material;
mod motion;
mod nodes;
mod skin;

use std::collections::BTreeSet;
use std::io;
use std::path::Path;

use ::gltf::mesh::Mode;
use ::gltf::{Primitive, Semantic};
use mode13h::glam::{Vec2, Vec3};
use mode13h::palette::Rgb;
use mode13h::scene::UpAxis;

use crate::model_file::lists::{Corner, Wide, push};
use crate::model_file::rig::place::Placement;
use crate::model_file::rig::{self, Matrix, Vertices};
use crate::model_file::{Draft, ModelFileError, ModelFileErrorKind, Place, paint};
use crate::wide::dot;
use accessor::Buffers;
pub(crate) use container::recognizes;
use material::Materials;
use skin::Skins;

/// The maximum number of triangles of all nodes: many nodes may use a mesh, so a small file may be a large model.
const MAX_TRIANGLES: usize = 1 << 26;

/// Reads a file, the buffers that it names, and the pictures whose means are needed.
pub(crate) fn draft(
    bytes: &[u8],
    path: &Path,
    mut file: impl FnMut(&Path) -> io::Result<Vec<u8>>,
) -> Result<Draft, ModelFileError> {
    let (document, binary, ignored) = container::open(bytes, path)?;
    let fault = |what: String| ModelFileError::of_file(path, ModelFileErrorKind::Fault(what));
    let buffers = Buffers::read(&document, binary, path, &mut file).map_err(fault)?;
    let mut draft = Draft { up: Some(UpAxis::Y), ..Draft::default() };
    let mut left_out = LeftOut::default();
    let (mut skeleton, scene) = nodes::read(&document).map_err(fault)?;
    let clips = motion::read(&document, &buffers, &skeleton, &mut left_out).map_err(fault)?;
    let lights = nodes::lights(&scene, &mut left_out);
    let camera = nodes::camera(&document, &scene, &mut left_out);
    // The transforms that the vertices of each mesh are bound to: its node's, or those of a skin's joints.
    let mut skins = Skins::default();
    let mut bindings = Vec::new();
    for node in &scene {
        let Some(mesh) = node.mesh() else { continue };
        let of_node = skeleton.add(Matrix { node: node.index(), before: None });
        let joints = node.skin().map(|skin| skins.of(&skin, &mut skeleton, &buffers)).transpose().map_err(fault)?;
        bindings.push((mesh, Binding { of_node, joints }));
    }
    let mut reading = Reading {
        materials: Materials::new(path, &buffers, &mut file),
        buffers: &buffers,
        left_out,
        numbers: Vec::new(),
        colors: Vec::new(),
        transforms: skeleton.transforms(&skeleton.places(|_| None)),
        moving: (!clips.is_empty()).then(Vertices::default),
    };
    for (mesh, binding) in bindings {
        for primitive in mesh.primitives() {
            let part = format!("meshes[{}].primitives[{}]", mesh.index(), primitive.index());
            reading.primitive(&primitive, binding, &mut draft).map_err(|kind| {
                let kind = match kind {
                    ModelFileErrorKind::Fault(what) => ModelFileErrorKind::Fault(format!("{part}: {what}")),
                    kind => kind,
                };
                ModelFileError::of_file(path, kind)
            })?;
        }
    }
    let Reading { mut materials, mut left_out, colors, moving, .. } = reading;
    draft.nodes = rig::Nodes { skeleton, clips, vertices: moving.unwrap_or_default(), lights, camera };
    draft.surfaces = core::mem::take(&mut materials.surfaces);
    draft.textures = core::mem::take(&mut materials.textures);
    if !colors.is_empty() {
        let painted = paint(&mut draft, &colors, format!("{}#colours", path.display()));
        for surface in materials.painted.values() {
            let own = &mut draft.surfaces[*surface];
            own.texture.clone_from(&painted.texture);
            if own.name.is_empty() {
                own.name.clone_from(&painted.name);
            }
        }
    }
    if materials.has_unseen {
        let what = "a fully transparent material is drawn opaque; its alpha is left out";
        draft.warnings.push(|| format!("{}: {what}", path.display()));
    }
    if !ignored.is_empty() {
        let all: Vec<&str> = ignored.iter().map(String::as_str).collect();
        let all = all.join(", ");
        draft.warnings.push(|| format!("{}: ignored what {all} would change", path.display()));
    }
    left_out.append(&mut materials.left_out);
    if !left_out.is_empty() {
        let all: Vec<&str> = left_out.into_iter().collect();
        draft.warnings.push(|| format!("{}: left out: {}", path.display(), all.join(", ")));
    }
    Ok(draft)
}

/// The transforms that the vertices of a mesh in a node are bound to.
#[derive(Clone, Copy)]
struct Binding {
    /// The index of the node's own transform in the skeleton.
    of_node: u32,
    /// The index of the first joint's transform, and the number of joints, if it has a skin.
    joints: Option<(u32, usize)>,
}

struct Reading<'a> {
    buffers: &'a Buffers,
    materials: Materials<'a>,
    left_out: LeftOut,
    /// For [`corners::used`].
    numbers: Vec<u32>,
    /// Faces with a colour of their own.
    colors: Vec<(usize, Rgb)>,
    /// The transforms that vertices are bound to, at rest.
    transforms: Vec<Placement>,
    /// The vertices before their transforms, one for each position, if anything moves.
    moving: Option<Vertices>,
}

impl Reading<'_> {
    fn primitive(
        &mut self,
        primitive: &Primitive<'_>,
        binding: Binding,
        draft: &mut Draft,
    ) -> Result<(), ModelFileErrorKind> {
        if matches!(primitive.mode(), Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
            self.left_out.insert("points and lines");
            return Ok(());
        }
        self.left_out.extend(primitive.morph_targets().next().map(|_| "morph targets"));
        let fault = ModelFileErrorKind::Fault;
        let Some(positions) = primitive.get(&Semantic::Positions) else {
            self.left_out.insert("meshes without positions");
            return Ok(());
        };
        let (surface, mapping, shade) = self.materials.surface(&primitive.material());
        // An error if there are fewer than the file says.
        self.buffers.rows_at::<3>(&positions, &[]).map_err(fault)?;
        let count = positions.count();
        let indices = primitive.indices().map(|a| self.buffers.read_indices(&a)).transpose().map_err(fault)?;
        let room = MAX_TRIANGLES.saturating_sub(draft.lists.sizes.len());
        let mut triangles = corners::triangles(primitive.mode(), indices.as_deref(), count, room)?;
        let used = corners::used(&mut triangles, &mut self.numbers, count);
        let positions = self.buffers.rows_at::<3>(&positions, &used).map_err(fault)?;
        let attribute = |semantic: &Semantic| {
            // An attribute with too few entries for the vertices is ignored.
            primitive.get(semantic).filter(|accessor| accessor.count() >= count)
        };
        let normals = attribute(&Semantic::Normals).map(|a| self.buffers.rows_at::<3>(&a, &used));
        let normals = normals.transpose().map_err(fault)?;
        let pairs = attribute(&Semantic::TexCoords(mapping.set)).map(|a| self.buffers.rows_at::<2>(&a, &used));
        let pairs = pairs.transpose().map_err(fault)?;
        let is_textured = self.materials.surfaces[surface].texture.is_some();
        let colors = attribute(&Semantic::Colors(0)).map(|a| self.buffers.rows_at::<3>(&a, &used));
        let colors = match colors {
            Some(colors) if is_textured => {
                // Nobody needs them, so they may be faulty.
                let are_seen = colors.is_ok_and(|colors| colors.as_flattened().iter().any(|c| *c < 1.0));
                self.left_out.extend(are_seen.then_some("colours of vertices with a texture"));
                None
            }
            colors => colors.transpose().map_err(fault)?,
        };
        // By the specification a skinned mesh is not where its node is, but where its joints are.
        let skinned = match binding.joints {
            Some(joints) => skin::influences(primitive, count, &used, joints, self.buffers).map_err(fault)?,
            None => None,
        };
        let own = self.transforms[binding.of_node as usize];
        let transforms = &self.transforms;
        let place = |vertex: usize| skinned.as_ref().map_or(own, |skinned| skinned.blended(vertex, transforms));

        if let Some(moving) = &mut self.moving {
            for vertex in 0..used.len() {
                moving.positions.push(positions[vertex].map(|c| c as f32));
                moving.normals.push(normals.as_ref().map_or([0.0; 3], |normals| normals[vertex].map(|c| c as f32)));
                match &skinned {
                    Some(skinned) => moving.influences.push(skinned.of(vertex).iter().copied()),
                    None => moving.influences.push([(binding.of_node, 1.0)]),
                }
            }
        }
        let lists = &mut draft.lists;
        let first = [lists.positions.len(), lists.texcoords.len(), lists.normals.len()];
        for (vertex, position) in positions.into_iter().enumerate() {
            let position = place(vertex).point(position);
            if let Some(c) = position.iter().find(|c| !(**c as f32).is_finite()) {
                return Err(ModelFileErrorKind::Fault(format!("a position of {c} is not finite")));
            }
            push(&mut lists.positions, Wide::new(position))?;
        }
        for (vertex, normal) in normals.iter().flatten().enumerate() {
            let normal = place(vertex).normal(*normal);
            let length = libm::sqrt(dot(normal, normal));
            let normal = Vec3::from_array(normal.map(|c| (c / length) as f32));
            push(&mut lists.normals, if normal.is_finite() { normal } else { Vec3::ZERO })?;
        }
        for &[u, v] in pairs.iter().flatten() {
            let pair = mapping.apply([u, v]);
            if is_textured && mapping.is_clamped(pair) {
                self.left_out.insert("clamped textures");
            }
            // v points down in the file.
            let pair = Vec2::new(pair[0] as f32, (1.0 - pair[1]) as f32);
            push(&mut lists.texcoords, if pair.is_finite() { pair } else { Vec2::ZERO })?;
        }
        let run = if colors.is_some() { self.materials.painted(surface) } else { surface };
        draft.lists.runs.push((draft.lists.sizes.len(), run));

        for triangle in triangles {
            let mut corners = triangle.map(|vertex| vertex as usize);
            if place(corners[0]).mirrors() {
                corners.swap(1, 2);
            }
            let lists = &mut draft.lists;
            let start = lists.corners.len();
            // Fewer than 2³² of each, see `push`.
            let index = |first: usize, is_there: bool, corner: usize| {
                if is_there { (first + corner) as u32 } else { Corner::NONE }
            };
            lists.corners.extend(corners.map(|corner| Corner {
                position: index(first[0], true, corner),
                texcoord: index(first[1], pairs.is_some(), corner),
                normal: index(first[2], normals.is_some(), corner),
            }));
            if let Some(colors) = &colors {
                let mean = [0, 1, 2].map(|channel| {
                    let sum: f64 = corners.iter().map(|&corner| colors[corner][channel]).sum();
                    sum / 3.0
                });
                self.colors.push((lists.sizes.len(), Rgb::from_intensities(shade.diffuse(mean))));
            }
            // The position only matters for faces that are dropped, and none is.
            lists.end_face(start, Place::Offset(0))?;
        }
        Ok(())
    }
}

/// The features of a file that a mesh cannot represent, for the warning.
type LeftOut = BTreeSet<&'static str>;
