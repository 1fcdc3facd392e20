//! Objects as a renderer caches them from frame to frame: vertices, lit and projected, and their inputs. The vertices
//! stay valid as long as the inputs do not change.

use alloc::vec::Vec;

use glam::Vec3;

use super::Stats;
use super::budget::Budget;
use super::faces::{FacePoints, Faces, face_points};
use super::geometry::Geometry;
use super::pixel_light::{PixelLight, fill_normal_table};
use super::surface_material::SurfaceMaterial;
use super::tessellate::Tessellated;
use super::vertex;
use super::vertex_columns::VertexColumns;
use crate::fixed::U8F8;
use crate::light::{ConeBeam, LampBeam, Light, Lights, Material, SunBeam};
use crate::mesh::Mesh;
use crate::mesh::wide::widen;
use crate::palette::{Lut64K, Palette};
use crate::plan::stages::{Lamps, Lighting, LitAt, Stages, VertexStage};
use crate::plan::{Change, ObjectPlan};
use crate::raster::columns::Triangles;
use crate::scene::{Fog, Object, Scene, Shared};
use crate::settings::Shading;
use crate::settings::{Accuracy, Settings};
use crate::span::Kernel;
use crate::view::{ObjectView, View};

/// Inputs of an object's vertices that are compared as a whole.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Parameters {
    view: ObjectView,
    ambient: f32,
    /// How many ramps the palette has, since the materials' ramps depend on that.
    ramps: Option<usize>,
    fog: Option<Fog>,
    accuracy: Accuracy,
    tolerance: f32,
    /// Fraction bits to which the vertices are rounded once more.
    bits: Option<u8>,
}

/// Inputs of an object's vertices, besides the plan.
#[derive(Debug)]
struct VertexInputs {
    mesh: Shared<Mesh>,
    suns: Vec<SunBeam>,
    lamps: Vec<LampBeam>,
    materials: Vec<Material>,
    parameters: Parameters,
}

impl VertexInputs {
    /// Updates all but the mesh to the object's current state. Returns whether any of it has changed. Nothing is
    /// allocated unless there are more lights or materials than before.
    fn renew(&mut self, scene: &Scene, object: &Object, parameters: Parameters) -> bool {
        let view = &parameters.view;
        let mut changed = replace_all(&mut self.suns, scene.lights().iter().filter_map(|light| sun(light, view)));
        changed |= replace_all(&mut self.lamps, scene.lights().iter().filter_map(|light| lamp(light, view)));
        if self.materials != object.materials {
            self.materials.clone_from(&object.materials);
            changed = true;
        }
        changed | replace(&mut self.parameters, parameters)
    }

    /// The light on the object according to its plan, with only these lamps.
    fn lights<'a>(&'a self, lamps: &'a [LampBeam], plan: &ObjectPlan) -> Lights<'a> {
        let suns = if plan.stages().is_lit() { self.suns.as_slice() } else { &[] };
        Lights { suns, lamps, eye: self.parameters.view.eye }
    }
}

fn replace<T: PartialEq>(place: &mut T, new: T) -> bool {
    let changed = *place != new;
    *place = new;
    changed
}

fn replace_all<T: PartialEq>(list: &mut Vec<T>, new: impl Iterator<Item = T>) -> bool {
    let mut changed = false;
    let mut count = 0;
    for item in new {
        match list.get_mut(count) {
            Some(place) => changed |= replace(place, item),
            None => {
                list.push(item);
                changed = true;
            }
        }
        count += 1;
    }
    changed |= list.len() != count;
    list.truncate(count);
    changed
}

/// A sun in the object space of `view`.
fn sun(light: &Light, view: &ObjectView) -> Option<SunBeam> {
    let Light::Sun { direction, intensity, color } = *light else { return None };
    let towards = Vec3::from_array(view.direction_in_object(direction)?.map(|c| c as f32));
    Some(SunBeam { towards, intensity: light.brightness(), channels: color.map(|c| c * intensity) })
}

/// A lamp in the object space of `view`.
pub(super) fn lamp(light: &Light, view: &ObjectView) -> Option<LampBeam> {
    let Light::Lamp { position, intensity, range, color, cone } = *light else { return None };
    // In the object's units.
    let part = view.scale / f64::from(range);
    let cone = match cone {
        Some(cone) => Some(ConeBeam::new(&cone, view.direction_in_object(cone.direction)?)?),
        None => None,
    };
    Some(LampBeam {
        position: view.point_in_object(position.to_array().map(f64::from)),
        cone,
        intensity: light.brightness(),
        channels: color.map(|c| c * intensity),
        inverse_square: part * part,
    })
}

/// Inputs from which an object's vertices are computed.
struct Inputs<'a> {
    scene: &'a Scene,
    view: &'a View,
    source: &'a VertexInputs,
    geometry: Geometry<'a>,
    /// True if the geometry is the object's mesh, unsplit.
    is_mesh: bool,
    lights: Lights<'a>,
    materials: &'a [SurfaceMaterial],
    plan: &'a ObjectPlan,
    kernel: Kernel,
}

/// The parts of an object's [`Outputs`] that stay valid until it gets another mesh.
#[derive(Debug, Default)]
struct OfMesh {
    has_vertices: bool,
    /// The sizes of the surfaces' images, if the columns hold the mesh's texture coordinates for them.
    texture_sizes: Vec<Option<[u32; 2]>>,
    has_face_points: bool,
    has_clusters: bool,
}

/// An object's vertices, and everything computed with them.
#[derive(Debug, Default)]
struct Outputs {
    columns: VertexColumns,
    /// True if a vertex may have a shade other than 0.
    has_shades: bool,
    of_mesh: OfMesh,
    /// Where each face is lit, if faces are lit.
    face_points: FacePoints,
    /// The suns of the tables, and a table for each surface.
    table_suns: Vec<SunBeam>,
    normal_tables: Vec<(SurfaceMaterial, Lut64K)>,
    /// Data for a budget's decisions.
    budget: Budget,
}

/// The parts of a plan that vertices depend on: stages, shading and budget.
type Recipe = (Stages, Shading, Option<f32>);

fn recipe(plan: &ObjectPlan) -> Recipe {
    // Neither how vertices are made nor whether they are seen.
    let stages = Stages { vertices: VertexStage::Make, is_out_of_sight: false, ..*plan.stages() };
    (stages, plan.shading(), plan.max_error())
}

/// One object of a renderer's scene.
#[derive(Debug, Default)]
pub(super) struct ObjectState {
    source: Option<VertexInputs>,
    /// True if the source has changed since the vertices were computed.
    pub(super) stale: bool,
    /// The plan that the vertices were computed by; `None` if they are not valid.
    pub(super) made_by: Option<Recipe>,
    pub(super) materials: Vec<SurfaceMaterial>,
    /// The source's lamps that are in range.
    lamps: Vec<LampBeam>,
    /// For each vertex of the mesh, the index of its point, for tessellation.
    points: Option<Vec<u32>>,
    tessellated: Tessellated,
    /// True if the tessellated mesh is drawn. Otherwise it is cached for later.
    is_tessellated: bool,
    outputs: Outputs,
}

impl ObjectState {
    /// Brings the state up to date with the object and the settings. Returns how the object has changed since its
    /// vertices were computed.
    pub(super) fn renew(&mut self, scene: &Scene, object: &Object, view: &ObjectView, settings: &Settings) -> Change {
        let mesh = object.shared_mesh();
        let parameters = Parameters {
            view: *view,
            ambient: scene.ambient,
            ramps: scene.palette.as_ref().map(Palette::ramps),
            fog: scene.fog,
            accuracy: settings.drawn_accuracy(),
            tolerance: settings.tolerance(),
            bits: settings.vertex_bits,
        };
        let source = self.source.get_or_insert_with(|| VertexInputs {
            mesh: Shared::clone(mesh),
            suns: Vec::new(),
            lamps: Vec::new(),
            materials: Vec::new(),
            parameters,
        });
        if !Shared::ptr_eq(&source.mesh, mesh) {
            source.mesh = Shared::clone(mesh);
            (self.stale, self.points, self.outputs.of_mesh) = (true, None, OfMesh::default());
        }
        self.stale |= source.renew(scene, object, parameters);
        match self.made_by {
            None => Change::New,
            Some(_) if self.stale => Change::Changed,
            Some(_) => Change::Unchanged,
        }
    }

    /// Its lamps, in range or not.
    pub(super) fn all_lamps(&self) -> &[LampBeam] {
        self.source.as_ref().map_or(&[], |source| &source.lamps)
    }

    /// Returns whether the vertices were computed by a plan like this, for the state's inputs.
    pub(super) fn is_made_by(&self, plan: &ObjectPlan) -> bool {
        !self.stale && self.made_by == Some(recipe(plan))
    }

    /// Computes the vertices, unless last frame's are valid. Returns whether it did.
    pub(super) fn vertices(
        &mut self,
        scene: &Scene,
        object: &Object,
        view: &View,
        plan: &ObjectPlan,
        kernel: Kernel,
        stats: &mut Stats,
    ) -> bool {
        let has_vertices = core::mem::replace(&mut self.outputs.of_mesh.has_vertices, true);
        let made_by = Some(recipe(plan));
        if plan.stages().vertices == VertexStage::Keep && self.made_by == made_by && has_vertices {
            return false;
        }
        (self.made_by, self.stale) = (made_by, false);
        self.take_materials_and_lamps(scene, object, plan);
        self.split_faces(object, plan);
        let Self { source: Some(source), materials, lamps, tessellated, outputs, .. } = self else { return false };
        let is_mesh = !self.is_tessellated;
        let geometry = drawn_geometry(self.is_tessellated, tessellated, object);
        let lights = source.lights(lamps, plan);
        let inputs = Inputs { scene, view, source, geometry, is_mesh, lights, materials, plan, kernel };
        outputs.project(&inputs, stats);
        outputs.light_vertices(&inputs, stats);
        outputs.add_attributes(&inputs);
        outputs.keep_face_points(&inputs);
        outputs.bound_errors(&inputs);
        outputs.prepare_pixels(&inputs);
        true
    }

    /// The scene's current materials, and the lamps that light the object.
    fn take_materials_and_lamps(&mut self, scene: &Scene, object: &Object, plan: &ObjectPlan) {
        self.materials.clear();
        let palette = scene.palette.as_ref();
        let surfaces = object.materials.iter().zip(object.mesh().surfaces());
        self.materials.extend(surfaces.map(|(material, surface)| match material.misses_ramp(palette) {
            true => SurfaceMaterial::new(&material.in_own_colors(surface), scene.ambient, palette, plan.stages()),
            false => SurfaceMaterial::new(material, scene.ambient, palette, plan.stages()),
        }));
        self.lamps.clear();
        let bounds = object.mesh().bounds();
        let falls_on_it = |lamp: &&LampBeam| match plan.stages().lamps {
            Lamps::None => false,
            // A lamp out of range adds nothing to any vertex, but it would widen a budget's bounds.
            Lamps::All if plan.max_error().is_none() => true,
            Lamps::InRange | Lamps::All => crate::light::lamp_reaches(lamp, bounds),
        };
        self.lamps.extend(self.source.iter().flat_map(|source| &source.lamps).filter(falls_on_it).copied());
    }

    /// Splits the faces, if that is on.
    fn split_faces(&mut self, object: &Object, plan: &ObjectPlan) {
        self.is_tessellated = plan.stages().tessellates();
        let Some(source) = self.source.as_ref().filter(|_| self.is_tessellated) else { return };
        let points = self.points.get_or_insert_with(|| object.mesh().points());
        let (lights, tolerance) = (source.lights(&self.lamps, plan), source.parameters.tolerance);
        self.tessellated.split(&mesh_geometry(object), points, &lights, &self.materials, tolerance);
    }

    /// The table of a surface's shades by normal.
    pub(super) fn normal_table(&self, surface: u16) -> Option<&[u8; 65_536]> {
        self.outputs.normal_tables.get(usize::from(surface)).map(|(_, table)| table.as_array())
    }

    /// The light on the object according to its plan.
    pub(super) fn lights(&self, plan: &ObjectPlan) -> Lights<'_> {
        let none = Lights { suns: &[], lamps: &self.lamps, eye: [0.0; 3] };
        self.source.as_ref().map_or(none, |source| source.lights(&self.lamps, plan))
    }

    /// The geometry that is drawn for the object.
    pub(super) fn geometry<'a>(&'a self, object: &'a Object) -> Geometry<'a> {
        drawn_geometry(self.is_tessellated, &self.tessellated, object)
    }

    /// Its triangles, whose vertices must have been computed.
    pub(super) fn triangles<'a>(&'a self, object: &'a Object) -> Triangles<'a> {
        self.outputs.columns.triangles(&self.geometry(object))
    }

    /// Its faces, ready to be drawn; `None` without vertices of its mesh.
    pub(super) fn faces<'a>(&'a self, object: &'a Object, plan: &'a ObjectPlan, kernel: Kernel) -> Option<Faces<'a>> {
        self.made_by.filter(|_| !plan.stages().is_out_of_sight && self.outputs.of_mesh.has_vertices)?;
        let source = self.source.as_ref().filter(|source| Shared::ptr_eq(&source.mesh, object.shared_mesh()))?;
        Some(Faces {
            shading: plan.shading(),
            stages: plan.stages(),
            geometry: self.geometry(object),
            view: &source.parameters.view,
            lights: self.lights(plan),
            materials: &self.materials,
            columns: &self.outputs.columns,
            points: &self.outputs.face_points,
            kernel,
        })
    }

    /// The budget that decides on its faces one by one, if there is one.
    pub(super) fn budget(&self, plan: &ObjectPlan) -> Option<&Budget> {
        plan.max_error().map(|_| &self.outputs.budget)
    }
}

impl Outputs {
    /// Projects the vertices to the screen.
    fn project(&mut self, inputs: &Inputs<'_>, stats: &mut Stats) {
        self.forget_texels(inputs);
        let &Inputs { source, geometry, materials, plan, kernel, .. } = inputs;
        let (stages, Parameters { view, bits, .. }) = (plan.stages(), &source.parameters);
        let count = geometry.positions.len();
        stats.vertices += count as u64;
        self.columns.begin(count);
        if stages.clips() {
            vertex::project_tested(view, geometry.positions, kernel, &mut self.columns);
        } else {
            vertex::project_inside(view, geometry.positions, kernel, &mut self.columns);
        }
        if let Some(bits) = bits {
            vertex::requantize(*bits, &mut self.columns);
        }
        if materials.iter().all(|material| !material.has_effects) {
            return;
        }
        // Those that the plan asks for, even where an effect is forced to run on neutral input.
        let VertexColumns { texture, fog, channels, .. } = &mut self.columns;
        if stages.has_texture() || stages.has_environment() || stages.neutral_image {
            texture.resize(count, [0; 2]);
        }
        if stages.has_fog() {
            fog.resize(count, U8F8::default());
        }
        if stages.has_channels() {
            channels.resize(count, [[U8F8::default(); 3]; 2]);
        }
    }

    /// Clears the texture coordinates, unless those of the last frame are still valid.
    fn forget_texels(&mut self, inputs: &Inputs<'_>) {
        let stages = inputs.plan.stages();
        let stay = stages.vertices != VertexStage::RecomputeAll
            && stages.has_texture()
            && !stages.has_environment()
            && inputs.is_mesh
            && inputs.materials.iter().map(|material| material.texture_size).eq(self
                .of_mesh
                .texture_sizes
                .iter()
                .copied());
        if !stay {
            self.columns.texture.clear();
            self.of_mesh.texture_sizes.clear();
        }
    }

    /// Computes the vertices' shades, or their channels, if vertices are lit.
    fn light_vertices(&mut self, inputs: &Inputs<'_>, stats: &mut Stats) {
        let Inputs { geometry, lights, materials, plan, kernel, .. } = inputs;
        let (columns, stages) = (&mut self.columns, plan.stages());
        // The back of a closed object is never visible.
        let sides = (!stages.culls(), *kernel);
        if stages.lighting != Lighting::None && stages.lit_at == LitAt::Vertices {
            stats.lit += geometry.positions.len() as u64;
        }
        let has_response = materials.iter().any(|material| material.response.is_some());
        let leaves = stages.lighting != Lighting::None
            && (stages.lit_at != LitAt::Vertices || stages.lighting == Lighting::Channels);
        if leaves && self.has_shades {
            columns.shade.fill([U8F8::default(); 2]);
        }
        self.has_shades = !leaves || has_response;
        match (stages.lighting, stages.lit_at) {
            (Lighting::None, _) => vertex::light_none(geometry, materials, columns),
            (_, LitAt::Faces | LitAt::Pixels) => {}
            (Lighting::Suns, _) => vertex::light_suns(geometry, materials, lights, sides, columns),
            (Lighting::All, _) => vertex::light_all(geometry, materials, lights, sides, columns),
            (Lighting::Channels, _) => vertex::light_channels(geometry, materials, lights, sides, columns),
        }
        if has_response {
            vertex::respond(geometry, materials, columns);
        }
    }

    /// Adds the vertices' attributes for images and fog.
    fn add_attributes(&mut self, inputs: &Inputs<'_>) {
        let Inputs { scene, source, geometry, materials, plan, .. } = inputs;
        let (stages, view) = (plan.stages(), &source.parameters.view);
        if stages.has_texture() && self.of_mesh.texture_sizes.is_empty() {
            vertex::texture_coordinates(geometry, materials, &mut self.columns.texture);
            if inputs.is_mesh && !stages.has_environment() {
                self.of_mesh.texture_sizes.extend(materials.iter().map(|material| material.texture_size));
            }
        }
        if stages.has_environment() {
            vertex::environment_coordinates(geometry, view, materials, &mut self.columns.texture);
        }
        if let Some(fog) = scene.fog.as_ref().filter(|_| stages.has_fog()) {
            vertex::fog_levels(geometry, view, fog, &mut self.columns.fog);
        }
    }

    /// Computes the points at which faces are lit, if they are and the geometry has changed.
    fn keep_face_points(&mut self, inputs: &Inputs<'_>) {
        let is_known = self.of_mesh.has_face_points && inputs.is_mesh;
        if inputs.plan.stages().lit_at == LitAt::Faces && !is_known {
            face_points(&inputs.geometry, &mut self.face_points);
            self.of_mesh.has_face_points = inputs.is_mesh;
        }
    }

    /// Prepares a budget's per-face decisions, if there is one.
    fn bound_errors(&mut self, inputs: &Inputs<'_>) {
        let Some(max_error) = inputs.plan.max_error() else { return };
        let is_known = self.of_mesh.has_clusters && inputs.is_mesh;
        let geometry = Some(&inputs.geometry).filter(|_| !is_known);
        self.budget.renew(max_error, geometry, &inputs.lights, inputs.materials);
        self.of_mesh.has_clusters = inputs.is_mesh;
    }

    /// Prepares per-pixel lighting, if all pixels are lit.
    fn prepare_pixels(&mut self, inputs: &Inputs<'_>) {
        let (stages, Parameters { view, accuracy, .. }) = (inputs.plan.stages(), &inputs.source.parameters);
        if stages.lit_at != LitAt::Pixels {
            self.normal_tables = Vec::new();
        } else if accuracy.shading() == Shading::PhongTable && stages.lighting != Lighting::Channels {
            self.columns.slope.resize(inputs.geometry.normals.len(), [U8F8::default(); 2]);
            vertex::slopes(&inputs.geometry, view, &mut self.columns.slope);
            self.tables_of_normals(inputs);
        }
    }

    /// Updates the tables of shades by normal in eye space; they stay valid as the object turns.
    fn tables_of_normals(&mut self, inputs: &Inputs<'_>) {
        let &Inputs { scene, view, source, materials, kernel, .. } = inputs;
        let suns = scene.lights().iter().filter_map(|light| {
            // A lamp counts as a sun at the object's position, since a table knows no positions.
            let (towards, share) = match *light {
                Light::Sun { direction, .. } => (direction, 1.0),
                Light::Lamp { position, range, cone, .. } => {
                    let away = position - source.parameters.view.position();
                    let part = away.length_squared() / (range * range);
                    if part >= 1.0 || part.is_nan() {
                        return None;
                    }
                    let mut share = (1.0 - part) * (1.0 - part);
                    if let Some(cone) = cone {
                        let beam = ConeBeam::new(&cone, widen(cone.direction))?;
                        share *= beam.share(widen(away.normalize_or_zero())) as f32;
                    }
                    (away, share)
                }
            };
            let towards = view.direction_to_eye(towards)?;
            Some(SunBeam { towards, intensity: light.brightness() * share, channels: [0.0; 3] })
        });
        let is_relit = replace_all(&mut self.table_suns, suns);
        self.normal_tables.truncate(materials.len());
        let lights = Lights { suns: &self.table_suns, lamps: &[], eye: [0.0, 0.0, 1.0] };
        for (i, material) in materials.iter().enumerate() {
            if !is_relit && self.normal_tables.get(i).is_some_and(|(of, _)| of == material) {
                continue;
            }
            if i == self.normal_tables.len() {
                self.normal_tables.push((material.clone(), Lut64K::from_fn(|_, _| 0)));
            }
            let (of, table) = &mut self.normal_tables[i];
            of.clone_from(material);
            fill_normal_table(table, &PixelLight { lights, material, kernel });
        }
    }
}

/// Geometry that is drawn for an object: its mesh, or the result of splitting it.
fn drawn_geometry<'a>(is_tessellated: bool, tessellated: &'a Tessellated, object: &'a Object) -> Geometry<'a> {
    if is_tessellated { tessellated.geometry() } else { mesh_geometry(object) }
}

fn mesh_geometry(object: &Object) -> Geometry<'_> {
    let mesh = object.mesh();
    Geometry {
        positions: mesh.positions(),
        normals: mesh.normals(),
        texcoords: mesh.texcoords(),
        vertex_surfaces: mesh.vertex_surfaces(),
        triangles: mesh.triangles(),
        triangle_surfaces: mesh.triangle_surfaces(),
        twins: mesh.twins(),
    }
}
