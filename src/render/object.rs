//! Objects as a renderer caches them from frame to frame: vertices, lit and projected, and their inputs. The vertices
//! stay valid as long as the inputs do not change.

use alloc::vec::Vec;

use glam::Vec3;

use super::Stats;
use super::budget::Budget;
use super::columns::VertexColumns;
use super::faces::{FacePoints, Faces, face_points};
use super::geometry::Geometry;
use super::paint::SurfaceMaterial;
use super::pixel_light::{PixelLight, fill_normal_table};
use super::stats::Shares;
use super::tessellate::Tessellated;
use super::vertex;
use crate::fixed::U8F8;
use crate::light::{ConeBeam, LampBeam, Light, Lights, Material, SunBeam};
use crate::mesh::Mesh;
use crate::mesh::wide::widen;
use crate::palette::{Lut64K, Palette};
use crate::plan::stages::{Lamps, Lighting, LitAt, Stages, VertexStage};
use crate::plan::{Change, FaceCounts, FaceShading, ObjectPlan};
use crate::raster::columns::Triangles;
use crate::scene::{Fog, Object, Scene, Shared};
use crate::settings::{Accuracy, Settings};
use crate::settings::{Mapping, Shading};
use crate::span::Kernel;
use crate::view::{ObjectView, View};

/// Inputs of an object's vertices, besides the plan.
#[derive(Clone, PartialEq, Debug)]
struct VertexInputs {
    mesh: Shared<Mesh>,
    view: ObjectView,
    suns: Vec<SunBeam>,
    lamps: Vec<LampBeam>,
    materials: Vec<Material>,
    ambient: f32,
    /// The version of the palette's ramps, on which the materials' ramps depend.
    ramps: usize,
    fog: Option<Fog>,
    accuracy: Accuracy,
    tolerance: f32,
    /// Fraction bits to which the vertices are rounded once more.
    bits: Option<u8>,
}

impl VertexInputs {
    /// Updates to the object's current state. Returns whether it has changed. Nothing is allocated unless there are
    /// more lights or materials than before.
    fn renew(&mut self, scene: &Scene, object: &Object, view: &ObjectView, settings: &Settings) -> bool {
        let mut changed = false;
        if !Shared::ptr_eq(&self.mesh, object.shared_mesh()) {
            self.mesh = Shared::clone(object.shared_mesh());
            changed = true;
        }
        changed |= replace(&mut self.view, *view);
        changed |= replace_all(&mut self.suns, scene.lights().iter().filter_map(|light| sun(light, view)));
        changed |= replace_all(&mut self.lamps, scene.lights().iter().filter_map(|light| lamp(light, view)));
        if self.materials != object.materials {
            self.materials.clone_from(&object.materials);
            changed = true;
        }
        changed |= replace(&mut self.ambient, scene.ambient);
        changed |= replace(&mut self.ramps, scene.palette.as_ref().map_or(0, Palette::ramps));
        changed |= replace(&mut self.fog, scene.fog);
        changed |= replace(&mut self.accuracy, settings.drawn_accuracy());
        changed |= replace(&mut self.bits, settings.vertex_bits);
        changed | replace(&mut self.tolerance, settings.tolerance())
    }

    /// The light on the object according to its plan, with only these lamps.
    fn lights<'a>(&'a self, lamps: &'a [LampBeam], plan: &ObjectPlan) -> Lights<'a> {
        let suns = if plan.stages().is_lit() { self.suns.as_slice() } else { &[] };
        Lights { suns, lamps, eye: self.view.eye() }
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
    let towards = view.direction_in_object(direction)?;
    Some(SunBeam { towards, intensity: light.brightness(), channels: color.map(|c| c * intensity) })
}

/// A lamp in the object space of `view`.
pub(super) fn lamp(light: &Light, view: &ObjectView) -> Option<LampBeam> {
    let Light::Lamp { position, intensity, range, color, cone } = *light else { return None };
    // In the object's units.
    let part = view.scale() / f64::from(range);
    let cone = match cone {
        Some(cone) => Some(ConeBeam::new(&cone, view.wide_direction_in_object(cone.direction)?)?),
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

/// Inputs for computing an object's vertices.
struct Made<'a> {
    scene: &'a Scene,
    object: &'a Object,
    view: &'a View,
    plan: &'a ObjectPlan,
    kernel: Kernel,
}

/// One object of a renderer's scene.
#[derive(Debug, Default)]
pub(super) struct ObjectState {
    source: Option<VertexInputs>,
    /// True if the source has changed since the vertices were computed.
    stale: bool,
    /// The plan that the vertices were computed by, without its reasons.
    made_by: Option<Stages>,
    paints: Vec<SurfaceMaterial>,
    /// The source's lamps that are in range.
    lamps: Vec<LampBeam>,
    columns: VertexColumns,
    /// True if a vertex may have a shade other than 0.
    has_shades: bool,
    tessellated: Tessellated,
    /// True if the tessellated mesh is drawn. Otherwise it is cached for later.
    is_tessellated: bool,
    /// The mesh whose texture coordinates the columns hold, and the sizes of its surfaces' images.
    texels_of: Option<Shared<Mesh>>,
    texture_sizes: Vec<Option<[u32; 2]>>,
    /// The mesh and the index of each vertex's point, for tessellation.
    points: Option<(Shared<Mesh>, Vec<u32>)>,
    /// Where each face is lit, if faces are lit, and the mesh of these faces; `None` for parts of split faces.
    face_points: Option<(Option<Shared<Mesh>>, FacePoints)>,
    /// One for each surface, with its inputs.
    normal_tables: Vec<(Vec<SunBeam>, SurfaceMaterial, Lut64K)>,
    /// Lights that the vertices would be computed from now.
    beams: Vec<SunBeam>,
    /// Data for a budget's decisions, and the faces that got each shading when the object was last drawn.
    budget: Budget,
    has_budget: bool,
}

impl ObjectState {
    /// Updates to the object's current state and settings. Returns how it has changed since its vertices were computed.
    pub(super) fn renew(&mut self, scene: &Scene, object: &Object, view: &ObjectView, settings: &Settings) -> Change {
        match &mut self.source {
            Some(source) => self.stale |= source.renew(scene, object, view, settings),
            None => {
                let mut source = VertexInputs {
                    mesh: Shared::clone(object.shared_mesh()),
                    view: *view,
                    suns: Vec::new(),
                    lamps: Vec::new(),
                    materials: Vec::new(),
                    ambient: scene.ambient,
                    ramps: 0,
                    fog: None,
                    accuracy: settings.drawn_accuracy(),
                    tolerance: settings.tolerance(),
                    bits: settings.vertex_bits,
                };
                source.renew(scene, object, view, settings);
                self.source = Some(source);
            }
        }
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

    /// Invalidates the cached vertices.
    pub(super) fn invalidate(&mut self) {
        self.made_by = None;
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
        let mut stages = *plan.stages();
        // These do not affect the vertices.
        (stages.vertices, stages.nearest, stages.is_out_of_sight) = (VertexStage::Make, 0.0, false);
        if plan.stages().vertices == VertexStage::Keep && self.made_by == Some(stages) {
            return false;
        }
        (self.made_by, self.stale) = (Some(stages), false);
        if self.source.is_none() {
            return false;
        }
        let made = Made { scene, object, view, plan, kernel };
        self.take_materials_and_lamps(&made);
        self.split_faces(&made);
        self.project(&made, stats);
        self.light_vertices(&made, stats);
        self.add_attributes(&made);
        self.keep_face_points(&made);
        self.bound_errors(&made);
        self.prepare_pixels(&made);
        true
    }

    /// The scene's current materials, and the lamps that light the object.
    fn take_materials_and_lamps(&mut self, &Made { scene, object, plan, .. }: &Made<'_>) {
        let Some(source) = &self.source else { return };
        self.paints.clear();
        let palette = scene.palette.as_ref();
        let surfaces = object.materials.iter().zip(object.mesh().surfaces());
        self.paints.extend(surfaces.map(|(material, surface)| match material.misses_ramp(palette) {
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
        self.lamps.extend(source.lamps.iter().filter(falls_on_it).copied());
    }

    /// Splits the faces, if that is on.
    fn split_faces(&mut self, &Made { object, plan, .. }: &Made<'_>) {
        self.is_tessellated = plan.stages().tessellates();
        let Some(source) = self.source.as_ref().filter(|_| self.is_tessellated) else { return };
        let points = match &mut self.points {
            Some((mesh, points)) if Shared::ptr_eq(mesh, object.shared_mesh()) => &*points,
            other => &other.insert((Shared::clone(object.shared_mesh()), object.mesh().points())).1,
        };
        let (twins, lights) = (object.mesh().twins(), source.lights(&self.lamps, plan));
        self.tessellated.split(&mesh_geometry(object), (points, twins), &lights, &self.paints, source.tolerance);
    }

    /// Projects the vertices to the screen.
    fn project(&mut self, &Made { object, plan, kernel, .. }: &Made<'_>, stats: &mut Stats) {
        self.forget_texels(object, plan);
        let Some(source) = &self.source else { return };
        let geometry = drawn_geometry(self.is_tessellated, &self.tessellated, object);
        let count = geometry.positions.len();
        stats.vertices += count as u64;
        self.columns.begin(count);
        if plan.stages().clips() {
            vertex::project_tested(&source.view, geometry.positions, kernel, &mut self.columns);
        } else {
            vertex::project_inside(&source.view, geometry.positions, kernel, &mut self.columns);
        }
        if !self.has_effects() {
            return;
        }
        // Those that the plan asks for, even where an effect is forced to run on neutral input.
        let VertexColumns { texture, fog, channels, .. } = &mut self.columns;
        let image = plan.stages().has_texture() || plan.stages().has_environment();
        if image || plan.stages().neutral_image {
            texture.resize(count, [0; 2]);
        }
        if plan.stages().has_fog() {
            fog.resize(count, U8F8::default());
        }
        if plan.stages().has_channels() {
            channels.resize(count, [[U8F8::default(); 3]; 2]);
        }
    }

    /// Clears the texture coordinates, unless those of the last frame are still right.
    fn forget_texels(&mut self, object: &Object, plan: &ObjectPlan) {
        let stages = plan.stages();
        let stay = self.texels_of.as_ref().is_some_and(|mesh| Shared::ptr_eq(mesh, object.shared_mesh()))
            && stages.vertices != VertexStage::MakeAnew
            && stages.has_texture()
            && !stages.has_environment()
            && !self.is_tessellated
            && self.paints.iter().map(|paint| paint.texture_size).eq(self.texture_sizes.iter().copied());
        if !stay {
            self.columns.texture.clear();
            self.texels_of = None;
        }
    }

    /// Computes the vertices' shades, or their channels, if vertices are lit.
    fn light_vertices(&mut self, &Made { object, plan, kernel, .. }: &Made<'_>, stats: &mut Stats) {
        let Some(source) = &self.source else { return };
        let geometry = drawn_geometry(self.is_tessellated, &self.tessellated, object);
        let (lights, stages) = (source.lights(&self.lamps, plan), plan.stages());
        // Nobody sees the back of a closed object.
        let both = !plan.stages().culls();
        if stages.lighting != Lighting::None && stages.lit_at == LitAt::Vertices {
            stats.lit += geometry.positions.len() as u64;
        }
        let has_response = self.paints.iter().any(|paint| paint.response.is_some());
        let leaves = stages.lighting != Lighting::None
            && (stages.lit_at != LitAt::Vertices || stages.lighting == Lighting::Channels);
        if leaves && self.has_shades {
            self.columns.leave_without_light();
        }
        self.has_shades = !leaves || has_response;
        match (stages.lighting, stages.lit_at) {
            (Lighting::None, _) => vertex::light_none(&geometry, &self.paints, &mut self.columns),
            (_, LitAt::Faces | LitAt::Pixels) => {}
            (Lighting::Suns, _) => {
                vertex::light_suns(&geometry, &self.paints, &lights, (both, kernel), &mut self.columns);
            }
            (Lighting::All, _) => {
                vertex::light_all(&geometry, &self.paints, &lights, (both, kernel), &mut self.columns)
            }
            (Lighting::Channels, _) => {
                let channels = &mut self.columns.channels;
                vertex::light_channels(&geometry, &self.paints, &lights, (both, kernel), channels);
            }
        }
        if has_response {
            vertex::respond(&geometry, &self.paints, &mut self.columns);
        }
    }

    /// Adds the vertices' attributes for images and fog.
    fn add_attributes(&mut self, &Made { scene, object, plan, .. }: &Made<'_>) {
        let Some(source) = &self.source else { return };
        let geometry = drawn_geometry(self.is_tessellated, &self.tessellated, object);
        if plan.stages().has_texture() && self.texels_of.is_none() {
            vertex::texture_coordinates(&geometry, &self.paints, &mut self.columns.texture);
            let stay = !self.is_tessellated && !plan.stages().has_environment();
            self.texels_of = stay.then(|| Shared::clone(object.shared_mesh()));
            self.texture_sizes.clear();
            self.texture_sizes.extend(self.paints.iter().map(|paint| paint.texture_size));
        }
        if plan.stages().has_environment() {
            vertex::environment_coordinates(&geometry, &source.view, &self.paints, &mut self.columns.texture);
        }
        if plan.stages().has_fog()
            && let Some(fog) = &scene.fog
        {
            vertex::fog_levels(&geometry, &source.view, fog, &mut self.columns.fog);
        }
    }

    /// Computes the points at which faces are lit, if they are and the mesh has changed.
    fn keep_face_points(&mut self, &Made { object, plan, .. }: &Made<'_>) {
        let is_known = matches!(&self.face_points, Some((Some(mesh), _)) if Shared::ptr_eq(mesh, object.shared_mesh()));
        if plan.stages().lit_at != LitAt::Faces || (is_known && !self.is_tessellated) {
            return;
        }
        let (_, mut points) = self.face_points.take().unzip();
        let points = points.get_or_insert_default();
        face_points(&drawn_geometry(self.is_tessellated, &self.tessellated, object), points);
        let mesh = (!self.is_tessellated).then(|| Shared::clone(object.shared_mesh()));
        self.face_points = Some((mesh, core::mem::take(points)));
    }

    /// Prepares a budget's decisions on faces, if there is one.
    fn bound_errors(&mut self, &Made { object, plan, kernel, .. }: &Made<'_>) {
        let Some(source) = &self.source else { return };
        self.has_budget = plan.max_error().is_some();
        let Some(max_error) = plan.max_error() else { return };
        let geometry = drawn_geometry(self.is_tessellated, &self.tessellated, object);
        let mesh = (!self.is_tessellated).then(|| object.shared_mesh());
        let lights = (&source.lights(&self.lamps, plan), self.paints.as_slice());
        self.budget.renew((max_error, kernel), &geometry, mesh, lights);
    }

    /// Prepares per-pixel lighting, if all pixels are lit.
    fn prepare_pixels(&mut self, &Made { scene, object, view, plan, kernel }: &Made<'_>) {
        let Some(source) = &self.source else { return };
        if plan.stages().lit_at != LitAt::Pixels {
            self.normal_tables = Vec::new();
            return;
        }
        let geometry = drawn_geometry(self.is_tessellated, &self.tessellated, object);
        if source.accuracy.shading() == Shading::PhongTable && plan.stages().lighting != Lighting::Channels {
            self.columns.slope.resize(geometry.normals.len(), [U8F8::default(); 2]);
            vertex::slopes(&geometry, &source.view, &mut self.columns.slope);
            let at = source.view.position();
            self.tables_of_normals(scene, at, view, kernel);
        }
    }

    /// Updates the tables of shades by normal in eye space; they stay valid as the object turns.
    fn tables_of_normals(&mut self, scene: &Scene, at: Vec3, view: &View, kernel: Kernel) {
        self.beams.clear();
        self.beams.extend(scene.lights().iter().filter_map(|light| {
            // A lamp counts as a sun at the object's position, since a table knows no positions.
            let (towards, share) = match *light {
                Light::Sun { direction, .. } => (direction, 1.0),
                Light::Lamp { position, range, cone, .. } => {
                    let away = position - at;
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
        }));
        self.normal_tables.truncate(self.paints.len());
        for (i, paint) in self.paints.iter().enumerate() {
            let lights = Lights { suns: &self.beams, lamps: &[], eye: [0.0, 0.0, 1.0] };
            match self.normal_tables.get_mut(i) {
                Some((of, by, _)) if *of == self.beams && by == paint => {}
                Some((of, by, table)) => {
                    of.clone_from(&self.beams);
                    by.clone_from(paint);
                    fill_normal_table(table, &PixelLight { lights, paint, kernel });
                }
                None => {
                    let mut table = Lut64K::from_fn(|_, _| 0);
                    fill_normal_table(&mut table, &PixelLight { lights, paint, kernel });
                    self.normal_tables.push((self.beams.clone(), paint.clone(), table));
                }
            }
        }
    }

    /// Rounds its vertices once more.
    pub(super) fn round_vertices(&mut self, bits: u8) {
        vertex::requantize(bits, &mut self.columns);
    }

    /// The table of a surface's shades by normal.
    pub(super) fn normal_table(&self, surface: u16) -> Option<&[u8; 65_536]> {
        self.normal_tables.get(usize::from(surface)).map(|(_, _, table)| table.as_array())
    }

    pub(super) fn paints(&self) -> &[SurfaceMaterial] {
        &self.paints
    }

    /// The light on the object according to its plan.
    pub(super) fn lights(&self, plan: &ObjectPlan) -> Lights<'_> {
        let none = Lights { suns: &[], lamps: &self.lamps, eye: [0.0; 3] };
        self.source.as_ref().map_or(none, |source| source.lights(&self.lamps, plan))
    }

    /// Its triangles, if their vertices were computed.
    pub(super) fn triangles<'a>(&'a self, object: &'a Object) -> Option<Triangles<'a>> {
        self.made_by?;
        Some(self.columns.triangles(&drawn_geometry(self.is_tessellated, &self.tessellated, object)))
    }

    /// The surface of each of its faces.
    pub(super) fn triangle_surfaces<'a>(&'a self, object: &'a Object) -> &'a [u16] {
        drawn_geometry(self.is_tessellated, &self.tessellated, object).triangle_surfaces
    }

    /// Its faces, ready to be drawn.
    pub(super) fn faces<'a>(&'a self, object: &'a Object, plan: &ObjectPlan) -> Option<Faces<'a>> {
        let stages = plan.stages();
        // Without computed vertices there are none.
        self.made_by.filter(|_| !stages.is_out_of_sight)?;
        let source = self.source.as_ref()?;
        Some(Faces {
            shading: plan.shading(),
            geometry: drawn_geometry(self.is_tessellated, &self.tessellated, object),
            view: &source.view,
            lights: self.lights(plan),
            paints: &self.paints,
            columns: &self.columns,
            face_points: self.face_points.as_ref().map(|(_, points)| points),
            culls: plan.stages().culls(),
            twins: if self.is_tessellated { self.tessellated.twins() } else { object.mesh().twins() },
            runs: stages.interpolates(),
            full: stages.lighting == Lighting::All,
            lit_by_face: stages.lit_at == LitAt::Faces,
            channels: stages.lighting == Lighting::Channels,
            affine: stages.mapping == Mapping::Affine,
            lights_pixels: stages.lights_pixels(),
            kernel: self.budget().and_then(|budget| budget.kernel).unwrap_or(Kernel::PORTABLE),
        })
    }

    /// The budget that decides on its faces one by one, if there is one.
    pub(super) fn budget(&self) -> Option<&Budget> {
        self.has_budget.then_some(&self.budget)
    }

    /// The number of its faces, visible or not.
    pub(super) fn most_faces(&self, object: &Object) -> usize {
        drawn_geometry(self.is_tessellated, &self.tessellated, object).triangles.len()
    }

    /// Returns whether pixels of some surface pass through stages.
    fn has_effects(&self) -> bool {
        self.paints.iter().any(|paint| paint.has_effects)
    }

    /// Counts the faces by the shading that a budget chose.
    pub(super) fn face_counts(&self, object: &Object, counts: &Shares) -> FaceCounts {
        let drawn: Vec<(FaceShading, u64)> = (*counts).into_iter().collect();
        // Below 2³².
        let faces = self.most_faces(object) as u64;
        let not_drawn = faces.saturating_sub(drawn.iter().map(|(_, count)| count).sum());
        FaceCounts { drawn, not_drawn }
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
        vertex_surfaces: object.vertex_surfaces(),
        triangles: mesh.triangles(),
        triangle_surfaces: mesh.triangle_surfaces(),
    }
}
