//! Rigs, which move a model: nodes, keyframes, and the vertices bound to them.
//!
//! A vertex is bound to one transform or to a blend of several (linear blend skinning: N. Magnenat-Thalmann, R.
//! Laperrière, D. Thalmann, "Joint-Dependent Local Deformations", 1988). Everything is computed in f64 and rounded
//! once.
#![cfg_attr(not(feature = "gltf"), expect(dead_code, unused_imports, reason = "of the formats only glTF has nodes"))]

mod clip;
pub(crate) mod place;
mod stage;

use mode13h::glam::Vec3;
use mode13h::light::Light;
use mode13h::mesh::Mesh;
use mode13h::scene::Camera;

pub(crate) use clip::{Channel, Interpolation, Property, Sampler};
pub use clip::{Clip, UnknownClip};
use place::Placement;
use stage::Stand;
pub(crate) use stage::{Eye, Kind, Source};

use crate::wide::{Wide, widen};

/// A loaded model's skeleton and animations.
///
/// ```no_run
/// use mode13h::scene::{Object, Scene};
/// use mode13h_assets::model_file;
/// let model = model_file::load("fox.glb")?;
/// let mut scene = Scene::new();
/// let fox = scene.add(Object::new(model.mesh.clone()));
/// if let Some(rig) = &model.rig {
///     let run = rig.find_clip("Run")?;
///     let half = rig.clips()[run].duration() / 2.0;
///     scene[fox].set_mesh(rig.pose(&model.mesh, run, half).mesh);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Rig {
    skeleton: Skeleton,
    clips: Vec<Clip>,
    vertices: Vertices,
    /// The index in `vertices` of each vertex of the mesh, and its normal before the transform, by the order of its
    /// triangles' corners.
    of_mesh: Vec<(u32, [f32; 3])>,
    /// The lights at rest, and the node of each.
    lights: Vec<(usize, Light)>,
    camera: Option<(usize, Camera)>,
    /// The point of the file that is 0 in the mesh.
    origin: Wide,
}

/// A model at a moment of an animation.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Pose {
    /// The mesh, with the triangles and surfaces that it has at rest.
    pub mesh: Mesh,
    /// The lights of the file, as many as there are at rest.
    pub lights: Vec<Light>,
    /// The camera of the file.
    pub camera: Option<Camera>,
}

/// The nodes, and the transforms that vertices are bound to.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Skeleton {
    /// The nodes that are in a tree, parents before children.
    pub(crate) order: Vec<usize>,
    /// All nodes.
    pub(crate) nodes: Vec<Node>,
    pub(crate) matrices: Vec<Matrix>,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Node {
    pub(crate) parent: Option<usize>,
    /// Its transform at rest, and the parts that it is made of: translation, rotation, scale.
    pub(crate) rest: Placement,
    pub(crate) parts: (Wide, [f64; 4], Wide),
}

/// A transform that vertices are bound to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Matrix {
    pub(crate) node: usize,
    /// The transform applied before it: a joint's inverse bind matrix.
    pub(crate) before: Option<Placement>,
}

impl Skeleton {
    /// Adds a transform that vertices are bound to, and returns its index.
    pub(crate) fn add(&mut self, matrix: Matrix) -> u32 {
        self.matrices.push(matrix);
        // A file has far fewer than 2³² of them.
        (self.matrices.len() - 1) as u32
    }

    /// The placement of each node in a scene, from the local ones in `local`, or else at rest. `None` for a node that
    /// is in no tree.
    pub(crate) fn places(&self, local: impl Fn(usize) -> Option<Placement>) -> Vec<Option<Placement>> {
        let mut places = vec![None; self.nodes.len()];
        for &number in &self.order {
            let node = &self.nodes[number];
            let own = local(number).unwrap_or(node.rest);
            places[number] = Some(match node.parent.and_then(|parent| places[parent]) {
                Some(parent) => Placement::after(parent, own),
                None => own,
            });
        }
        places
    }

    /// The transforms of the joints that vertices are bound to.
    pub(crate) fn transforms(&self, places: &[Option<Placement>]) -> Vec<Placement> {
        let place = |matrix: &Matrix| {
            let place = places[matrix.node].unwrap_or(Placement::NONE);
            matrix.before.map_or(place, |before| place.after(before))
        };
        self.matrices.iter().map(place).collect()
    }
}

/// Vertices before their transforms, in lists.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Vertices {
    pub(crate) positions: Vec<[f32; 3]>,
    /// Normals of any length; 0 where the file gives none.
    pub(crate) normals: Vec<[f32; 3]>,
    pub(crate) influences: Influences,
}

/// The transforms of the skeleton that each vertex is bound to, at least one, with their weights. The weights of a
/// vertex add up to 1.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Influences {
    /// The index in `all` where those of each vertex end.
    ends: Vec<usize>,
    all: Vec<(u32, f64)>,
}

impl Influences {
    /// Adds a vertex.
    pub(crate) fn push(&mut self, own: impl IntoIterator<Item = (u32, f64)>) {
        self.all.extend(own);
        self.ends.push(self.all.len());
    }

    pub(crate) fn of(&self, vertex: usize) -> &[(u32, f64)] {
        let start = vertex.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.all[start..self.ends[vertex]]
    }

    /// The transform of a vertex.
    pub(crate) fn blended(&self, vertex: usize, transforms: &[Placement]) -> Placement {
        match self.of(vertex) {
            [(only, _)] => transforms[*only as usize],
            several => Placement::blend(several.iter().map(|&(matrix, weight)| (transforms[matrix as usize], weight))),
        }
    }
}

/// The nodes of a file and what is in them, before there is a mesh.
#[derive(Default)]
pub(crate) struct Nodes {
    pub(crate) skeleton: Skeleton,
    pub(crate) clips: Vec<Clip>,
    /// One for each position; empty if nothing moves.
    pub(crate) vertices: Vertices,
    pub(crate) lights: Vec<Source>,
    pub(crate) camera: Option<Eye>,
}

/// Lights, camera and rig that go with a mesh.
#[derive(Default)]
pub(crate) struct Staged {
    pub(crate) lights: Vec<Light>,
    pub(crate) camera: Option<Camera>,
    pub(crate) rig: Option<Rig>,
}

impl Nodes {
    /// Places lights and camera around a mesh, and binds its vertices to their transforms. `corners` are the indices of
    /// the positions at the corners of its triangles, which have not been repaired.
    pub(crate) fn stage(self, mesh: &Mesh, corners: &[u32], origin: Wide) -> Staged {
        let Self { skeleton, clips, vertices, lights: sources, camera: eye } = self;
        let places = skeleton.places(|_| None);
        let stand = |node: usize| places[node].map(|place| Stand { place, origin });
        let lights = stage::lights(&sources, stand, &mesh.bounds());
        let camera = eye.and_then(|eye| Some((eye.node, stage::camera(&eye, stand(eye.node)?, &mesh.bounds())?)));
        let (lights_at_rest, camera_at_rest) =
            (lights.iter().map(|(_, light)| *light).collect(), camera.map(|(_, camera)| camera));
        let rig = (!clips.is_empty()).then(|| {
            let transforms = skeleton.transforms(&places);
            let mut of_mesh = vec![(0, [0.0; 3]); mesh.positions().len()];
            for (&vertex, &source) in mesh.triangles().as_flattened().iter().zip(corners) {
                let place = vertices.influences.blended(source as usize, &transforms);
                let mut normal = vertices.normals[source as usize];
                if normal == [0.0; 3] {
                    normal = unit(place.normal_before(widen(mesh.normals()[vertex as usize])));
                }
                // The triangles of a mirrored vertex were flipped.
                let sign = if place.mirrors() { -1.0 } else { 1.0 };
                of_mesh[vertex as usize] = (source, normal.map(|c| sign * c));
            }
            let lights = lights.iter().map(|&(source, light)| (sources[source].node, light)).collect();
            Rig { skeleton, clips, vertices, of_mesh, lights, camera, origin }
        });
        Staged { lights: lights_at_rest, camera: camera_at_rest, rig }
    }
}

/// A vector of length 1, or 0.
fn unit(v: Wide) -> [f32; 3] {
    let length = libm::sqrt(crate::wide::dot(v, v));
    if length > 0.0 && length.is_finite() { v.map(|c| (c / length) as f32) } else { [0.0; 3] }
}

impl Rig {
    /// The animations, at least one, in the order of the file.
    #[must_use]
    pub fn clips(&self) -> &[Clip] {
        &self.clips
    }

    /// The index of a clip by its name, the first if several share it, or else by its index as a number: `Run` or `2`.
    ///
    /// # Errors
    /// An [`UnknownClip`], which lists all clips.
    pub fn find_clip(&self, word: &str) -> Result<usize, UnknownClip> {
        match self.clips.iter().position(|clip| clip.name() == word) {
            Some(named) => Ok(named),
            None => self.numbered(word.parse().ok(), word),
        }
    }

    /// A clip's index, if there is such a clip; `word` is what the user wrote.
    pub(crate) fn numbered(&self, index: Option<usize>, word: &str) -> Result<usize, UnknownClip> {
        index.filter(|index| *index < self.clips.len()).ok_or_else(|| UnknownClip::new(word, &self.clips))
    }

    /// The model at a time of a clip, in seconds; a clip begins again when it ends. `mesh` is the one that was read
    /// with the rig. One with any other number of vertices does not move, and if there is no such clip, nothing does. A
    /// vertex whose position is beyond f32 stays where it is at rest.
    #[must_use]
    pub fn pose(&self, mesh: &Mesh, clip: usize, seconds: f64) -> Pose {
        let mut parts = vec![None; self.skeleton.nodes.len()];
        if let Some(clip) = self.clips.get(clip) {
            let time = if clip.duration > 0.0 { seconds.rem_euclid(clip.duration) } else { 0.0 };
            for channel in &clip.channels {
                let value @ [x, y, z, _] = clip.samplers[channel.sampler].at(time);
                let (translation, rotation, scale) =
                    parts[channel.node].get_or_insert(self.skeleton.nodes[channel.node].parts);
                match channel.property {
                    Property::Translation => *translation = [x, y, z],
                    Property::Rotation => *rotation = value,
                    Property::Scale => *scale = [x, y, z],
                }
            }
        }
        let local = |node: usize| {
            parts[node].map(|(translation, rotation, scale)| Placement::of_parts(translation, rotation, scale))
        };
        let places = self.skeleton.places(local);
        let stand = |node: usize| places[node].map(|place| Stand { place, origin: self.origin });
        Pose {
            mesh: self.moved(mesh, &self.skeleton.transforms(&places)),
            lights: self
                .lights
                .iter()
                .map(|&(node, light)| stand(node).map_or(light, |stand| stage::moved(light, stand)))
                .collect(),
            camera: self.camera.map(|(node, camera)| stand(node).map_or(camera, |stand| stage::looking(camera, stand))),
        }
    }

    fn moved(&self, mesh: &Mesh, transforms: &[Placement]) -> Mesh {
        if mesh.positions().len() != self.of_mesh.len() {
            return mesh.clone();
        }
        let at_rest = mesh.positions().iter().zip(mesh.normals());
        let vertices = at_rest.zip(&self.of_mesh).map(|((&position, &normal), &(source, own))| {
            let place = self.vertices.influences.blended(source as usize, transforms);
            let point = place.point(self.vertices.positions[source as usize].map(f64::from));
            let moved = Vec3::from_array([0, 1, 2].map(|axis| (point[axis] - self.origin[axis]) as f32));
            let turned = Vec3::from_array(unit(place.area(own.map(f64::from))));
            (if moved.is_finite() { moved } else { position }, if turned == Vec3::ZERO { normal } else { turned })
        });
        let (positions, normals): (Vec<Vec3>, Vec<Vec3>) = vertices.unzip();
        mesh.with_vertices(positions, normals).unwrap_or_else(|_| mesh.clone())
    }
}
