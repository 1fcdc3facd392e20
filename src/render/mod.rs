//! Rendering: from a scene to bytes, frame by frame.
//!
//! The [`plan`] says which stages an object goes through: its vertices are transformed, lit and rounded, each once, or
//! are reused from the last frame; its faces are culled, clipped where necessary, and get their shading; the
//! [`raster`](crate::raster) draws the rest.

// | file | what |
// |---|---|
// | `object` | the cached state of an object: its vertices, and their inputs |
// | `vertex`, `vertex_columns` | vertex stages (projection, light, effects); their results in columns |
// | `tessellate`, `edge_map` | faces split along their edges; a map from edges to numbers |
// | `faces` | the input for an object's faces |
// | `picker` | which faces are drawn, and how; `clip` clips at the near plane and the guard band |
// | `budget` | the error budget: the shading for each triangle |
// | `hidden_surfaces` | hidden-surface methods: faces in scene order, with depths or without, far to near, or by rows |
// | `surface_material`, `pixel_light`, `tables`, `pipelines` | the input for pixels |
// | `to_integers`, `integer_frame` | a scene in 16.16, and its frames |
// | `pace` | the least error that fits in a time, independent of the renderer |
// | `stats` | counts of a frame |
// | `each_triangle` | every triangle of a frame with everything the raster would get, for the laboratory |

mod budget;
mod clip;
pub(crate) mod each_triangle;
mod edge_map;
mod error;
mod faces;
mod geometry;
mod hidden_surfaces;
pub(crate) mod integer_frame;
mod object;
mod pace;
mod picker;
mod pipelines;
mod pixel_light;
mod stats;
mod surface_material;
mod tables;
mod tessellate;
mod to_integers;
mod vertex;
mod vertex_columns;

use alloc::vec::Vec;

use self::each_triangle::each_triangle;
use self::hidden_surfaces::Scratch;
use self::object::ObjectState;
use self::tables::Tables;
use self::to_integers::IntegerPath;
use crate::palette::{BIOS, Palette};
use crate::plan::{
    self, Change, Effect, FaceCounts, FaceShading, Findings, Inputs, ObjectPlan, Overrides, Plan, decide,
};
use crate::raster::{Frame, Interpolation, Vertex};
use crate::scene::{ObjectId, Scene};
use crate::settings::{HiddenSurfaces, Settings, VertexPath};
use crate::span::Kernel;
use crate::vga::Vga;
pub use crate::view::Screen;
use crate::view::{ObjectView, View};
pub use error::RenderError;
use error::check;
pub use pace::Pace;
pub use stats::{Shares, Stats};

/// Inputs of the last frame drawn, besides its objects.
#[derive(Debug, Default)]
struct Drawing {
    /// With the entry of the background; `None` before the first frame.
    made_for: Option<(Screen, u8, HiddenSurfaces, Settings)>,
    order: Vec<usize>,
    /// The palette: tables are computed from it, and ramps are ranges of it.
    palette: Option<Palette>,
}

/// What is cached from frame to frame: the plan, vertices, tables, and their inputs.
#[derive(Debug, Default)]
struct Cache {
    views: Vec<ObjectView>,
    change: Vec<Change>,
    states: Vec<ObjectState>,
    tables: Tables,
    plan: Plan,
    integer: IntegerPath,
    drawing: Drawing,
}

impl Cache {
    /// The number of faces of the objects that `counts` selects, seen in this frame or not: room
    /// for that many suffices unless a plane cuts some into parts.
    fn most_faces(&self, scene: &Scene, counts: impl Fn(&ObjectPlan) -> bool) -> usize {
        let objects = scene.objects().iter().zip(&self.states).zip(self.plan.objects());
        let counted = objects.filter(|(_, plan)| counts(plan));
        counted.map(|((object, state), _)| state.geometry(object).triangles.len()).sum()
    }
}

/// Draws scenes. Its memory and the vertices of unchanged objects are reused from frame to frame;
/// the bytes are the same as from a new renderer.
///
/// ```
/// use mode13h::render::Renderer;
/// use mode13h::settings::{Accuracy, Mapping};
///
/// let mut renderer = Renderer::new();
/// renderer.settings.mapping = Some(Mapping::Perspective);
/// renderer.settings.accuracy = Some(Accuracy::WithinError(2.0));
/// ```
#[derive(Debug, Default)]
pub struct Renderer {
    /// How to draw; the scene's own settings apply where this is `None`.
    pub settings: Settings,
    /// Kernel that fills spans; the fastest by default. All draw the same bytes.
    pub kernel: Kernel,
    /// Effects that are forced on or off.
    overrides: Overrides,
    cache: Cache,
    scratch: Scratch,
    /// The machine's stamp after the last frame, and that frame's counts.
    last: Option<(u64, Stats)>,
}

impl Renderer {
    /// A renderer with the default shading and the fastest kernel.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// A new renderer with the same settings, which draws the same bytes, for another thread.
    #[must_use]
    pub fn with_same_settings(&self) -> Self {
        Self { settings: self.settings, kernel: self.kernel, overrides: self.overrides.clone(), ..Self::new() }
    }

    /// Forces an effect on or off for every object, or leaves it to the plan, as a new renderer does.
    ///
    /// Effects that save work give the same bytes on or off, with these exceptions. Back-face culling, forced on, also
    /// hides the backs of open meshes (a room seen from inside has none to hide, and is drawn faster); forced off, it
    /// shows the backs of convex objects, which nothing else hides without a depth buffer. With the transform forced off
    /// the vertices of an object stay as they were last computed, as long as the rest of its plan does; culling, clipping
    /// and light at pixels are those of its new pose. The method for hidden surfaces is set by
    /// [`Settings::hidden_surfaces`]. If an effect that changes the image is forced on but has nothing to show, it runs
    /// on neutral input (no amplitude, an image that changes nothing). Clipping stays on where the plan requires it.
    pub fn force(&mut self, effect: Effect, on: Option<bool>) {
        self.overrides.set(None, effect, on);
    }

    /// Forces an effect on or off for one object of the scene that is drawn, overriding the setting for all objects.
    /// `None` removes the override. Palette animation is on if it is on for any object. Otherwise like
    /// [`force`](Self::force).
    pub fn force_for(&mut self, object: ObjectId, effect: Effect, on: Option<bool>) {
        self.overrides.set(Some(object), effect, on);
    }

    /// The latest plan: that of the last frame drawn, or the one from [`make_plan`](Self::make_plan).
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.cache.plan
    }

    /// The plan of the last frame drawn, as text: [`Plan::rows`] of `scene`, which must be the scene that was drawn.
    /// Where neither per-pixel lighting nor splitting is on, it also says how far the image may be off; this is
    /// computed face by face, and only in this call. For an object drawn within an error budget, it says how many of
    /// its triangles got each shading.
    #[must_use]
    pub fn rows(&self, scene: &Scene) -> Vec<plan::Row> {
        self.cache.plan.rows_with(scene, |object| Findings {
            face_counts: self.face_counts(scene, object),
            linear_error: self.linear_error(scene, object),
        })
    }

    /// The faces of an object by the shading that a budget gave them in the last frame; `None` without a budget.
    fn face_counts(&self, scene: &Scene, object: usize) -> Option<FaceCounts> {
        self.cache.plan.objects().get(object)?.max_error()?;
        let drawn: Vec<(FaceShading, u64)> = self.scratch.counts.get(object)?.into_iter().collect();
        let geometry = self.cache.states.get(object)?.geometry(scene.objects().get(object)?);
        // Below 2³².
        let faces = geometry.triangles.len() as u64;
        let not_drawn = faces.saturating_sub(drawn.iter().map(|(_, count)| count).sum());
        Some(FaceCounts { drawn, not_drawn })
    }

    /// Bounds the error of an object's linear shades against light at every pixel, in the last frame drawn, from
    /// normals, lights and vertices. It is in shades of 1/255 of full intensity, without rounding. `object` is the
    /// object's index. `None` if the object is flat-shaded, lit at every pixel, split, out of sight, on the 16.16 path, or does
    /// not exist; if a material has a custom response; or if the object or its plan has changed since its vertices were
    /// computed.
    #[must_use]
    pub fn linear_error(&self, scene: &Scene, object: usize) -> Option<f64> {
        let plan = self.cache.plan.objects().get(object)?;
        let stages = plan.stages();
        if stages.lights_pixels() || stages.tessellates() || (stages.is_lit() && !stages.interpolates()) {
            return None;
        }
        let object_in_scene = scene.objects().get(object).filter(|object| !plan::has_custom_response(object))?;
        let state = self.cache.states.get(object).filter(|state| state.is_made_by(plan))?;
        let faces = state.faces(object_in_scene, plan, self.kernel)?;
        Some(faces.linear_error())
    }

    /// Makes the plan of the frame that [`draw`](Self::draw) would draw next. Draws nothing, and
    /// does not affect later frames.
    ///
    /// ```
    /// use mode13h::mesh::shapes;
    /// use mode13h::plan::Effect;
    /// use mode13h::render::{Renderer, Screen};
    /// use mode13h::scene::Scene;
    ///
    /// let scene = Scene::showing(shapes::torus(48, 24));
    /// let mut renderer = Renderer::new();
    /// let plan = renderer.make_plan(&scene, Screen::MODE_13H)?;
    /// assert!(plan.objects()[0][Effect::HiddenSurfaces].on && !plan.is_on_anywhere(Effect::Fog));
    /// # Ok::<(), mode13h::render::RenderError>(())
    /// ```
    ///
    /// # Errors
    /// See [`draw`](Self::draw). Numbers that 16.16 cannot hold are found only on drawing.
    pub fn make_plan(&mut self, scene: &Scene, screen: Screen) -> Result<&Plan, RenderError> {
        let view = self.checked(scene, screen)?;
        self.decide(scene, &view, true);
        Ok(&self.cache.plan)
    }

    /// Draws `scene` on the machine: sets its DAC to the scene's palette, if it has one, clears its pixels and draws.
    ///
    /// If nothing has changed since this renderer's last frame, and nobody has modified the machine's memory, that
    /// frame is left as it is, except on the integer path.
    ///
    /// # Errors
    /// The scene has a fault ([`RenderError`]): a number that is not finite or out of range, too few materials, parents in
    /// a cycle, a camera without a direction; on the integer path also any parent, and numbers that do not fit in 16.16
    /// together. The machine is then left unchanged.
    pub fn draw(&mut self, scene: &Scene, vga: &mut Vga) -> Result<Stats, RenderError> {
        let shown = if scene.palette.is_none() { Some(vga.palette()) } else { None };
        let (mut stats, changed) = self.prepare(scene, Screen::MODE_13H, shown.as_ref(), true)?;
        // Nothing was decided for a scene without visible objects.
        let is_empty = !(0..scene.objects().len()).any(|object| scene.is_visible(object));
        let effect = Effect::PaletteAnimation;
        let is_off = effect.is_left_out() || self.overrides.get(None, effect) == Some(false);
        if is_empty && !is_off || self.cache.plan.is_on_anywhere(effect) {
            scene.load_palette(vga);
        } else if let Some(palette) = &scene.palette {
            vga.set_palette(palette);
        }
        if let Some((stamp, last)) = self.last
            && !changed
            && stamp == vga.stamp()
            && self.keeps_frames()
        {
            stats.redrawn = false;
            stats.hidden_surfaces = last.hidden_surfaces;
            return Ok(stats);
        }
        let mut frame = Frame::from(&mut *vga);
        frame.clear(scene.background);
        self.fill(scene, &mut stats, frame);
        self.last = Some((vga.stamp(), stats));
        Ok(stats)
    }

    /// Draws `scene` into any frame, or into a band of one, with this ratio of pixel width to height.
    ///
    /// No palette is loaded, since a frame has none. [`Scene::load_palette`] loads the scene's current one, animated or
    /// not, into a machine, whose [`palette`](Vga::palette) has the colours.
    ///
    /// # Errors
    /// See [`draw`](Self::draw). On error the frame is left unchanged.
    pub fn draw_frame(
        &mut self,
        scene: &Scene,
        frame: Frame<'_>,
        pixel_aspect: (u32, u32),
    ) -> Result<Stats, RenderError> {
        self.draw_into(scene, frame, pixel_aspect, true)
    }

    /// Draws `scene` over the contents of the frame, such as a sky or stars: like [`draw_frame`](Self::draw_frame), but
    /// without clearing. Glass and fog mix with the entries there, as if they were the background. No palette is
    /// loaded.
    ///
    /// ```
    /// use mode13h::mesh::shapes;
    /// use mode13h::raster::Frame;
    /// use mode13h::render::Renderer;
    /// use mode13h::scene::Scene;
    ///
    /// let mut bytes = [7; 64 * 48];
    /// let frame = Frame::new(&mut bytes, 64, 48, 64)?;
    /// Renderer::new().draw_over(&Scene::showing(shapes::cube()), frame, (1, 1))?;
    /// assert!(bytes[0] == 7 && bytes[24 * 64 + 32] != 7);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// See [`draw`](Self::draw). On error the frame is left unchanged.
    pub fn draw_over(
        &mut self,
        scene: &Scene,
        frame: Frame<'_>,
        pixel_aspect: (u32, u32),
    ) -> Result<Stats, RenderError> {
        self.draw_into(scene, frame, pixel_aspect, false)
    }

    fn draw_into(
        &mut self,
        scene: &Scene,
        mut frame: Frame<'_>,
        pixel_aspect: (u32, u32),
        clears: bool,
    ) -> Result<Stats, RenderError> {
        let screen = Screen { width: frame.width(), height: frame.height(), pixel_aspect };
        let rows = frame.rows();
        let (mut stats, _) = self.prepare(scene, screen, None, rows.end - rows.start == frame.height())?;
        self.last = None;
        if clears {
            frame.clear(scene.background);
        }
        self.fill(scene, &mut stats, frame);
        Ok(stats)
    }

    /// Calls `triangle` for every triangle to be drawn, as the raster would receive it: object by object, far to near
    /// if the scene requires it, each in the order of its faces; a forced painter's order does not sort them here.
    /// Attributes for effects are left out. Returns the counts of the work, without the raster's.
    ///
    /// # Errors
    /// See [`draw`](Self::draw). No triangle is passed before an error.
    pub fn for_each_triangle(
        &mut self,
        scene: &Scene,
        screen: Screen,
        mut triangle: impl FnMut(&[Vertex; 3], Interpolation),
    ) -> Result<Stats, RenderError> {
        each_triangle(self, scene, screen, &mut |drawn| {
            triangle(
                drawn.vertices,
                if drawn.effects.is_some() { Interpolation::default() } else { drawn.interpolation },
            );
        })
    }

    /// Checks the scene, makes the plan, and computes the vertices that it requires. Returns
    /// whether anything that the image depends on has changed.
    fn prepare(
        &mut self,
        scene: &Scene,
        screen: Screen,
        shown: Option<&Palette>,
        whole: bool,
    ) -> Result<(Stats, bool), RenderError> {
        let view = self.checked(scene, screen)?;
        if self.settings.or(&scene.settings).is_integer() {
            self.cache.integer.prepare(scene, screen)?;
        }
        let settings = self.decide(scene, &view, whole);

        let made_for = Some((screen, scene.background, self.cache.plan.hidden_surfaces(), settings));
        let palette = scene.palette.as_ref().or(shown);
        let (last, order) = (&mut self.cache.drawing, &self.cache.plan.order);
        let mut changed = last.made_for != made_for || last.order != *order || last.palette.as_ref() != palette;
        if changed {
            (last.made_for, last.palette) = (made_for, palette.cloned());
            // The existing list is reused.
            last.order.clone_from(order);
        }

        let mut stats = Stats::new(&settings, self.kernel, self.cache.plan.hidden_surfaces());
        for (i, (object, state)) in scene.objects().iter().zip(&mut self.cache.states).enumerate() {
            let plan = &self.cache.plan.objects[i];
            if !scene.is_visible(i) {
                state.made_by = None;
                continue;
            }
            if plan.stages().is_out_of_sight && self.cache.change[i] != Change::New {
                continue;
            }
            if self.cache.plan.is_integer {
                changed = true;
                state.made_by = None;
                continue;
            }
            if state.vertices(scene, object, &view, plan, self.kernel, &mut stats) {
                changed = true;
            } else {
                stats.kept += 1;
            }
        }
        pipelines::ensure_tables(&mut self.cache, scene, palette.unwrap_or(&BIOS));
        Ok((stats, changed))
    }

    /// The view of a valid scene.
    fn checked(&self, scene: &Scene, screen: Screen) -> Result<View, RenderError> {
        check(scene)?;
        screen.check().map_err(RenderError::Screen)?;
        if screen.width.max(screen.height) > Frame::MAX_SIDE {
            return Err(RenderError::Screen("its width and height must be at most 4,096"));
        }
        self.settings.or(&scene.settings).check().map_err(RenderError::Settings)?;
        View::new(&scene.camera, screen).map_err(RenderError::Camera)
    }

    /// Makes the plan of a scene that has been checked. Returns the settings it is drawn with.
    fn decide(&mut self, scene: &Scene, view: &View, whole: bool) -> Settings {
        self.cache.views.clear();
        let placed = |(i, object)| ObjectView::placed(view, object, &scene.placement(i));
        self.cache.views.extend(scene.objects().iter().enumerate().map(placed));
        let settings = self.settings.or(&scene.settings);
        self.cache.states.resize_with(scene.objects().len(), ObjectState::default);
        self.cache.change.clear();
        for ((object, view), state) in scene.objects().iter().zip(&self.cache.views).zip(&mut self.cache.states) {
            self.cache.change.push(state.renew(scene, object, view, &settings));
        }
        let inputs = Inputs {
            scene,
            views: &self.cache.views,
            change: &self.cache.change,
            forced: &self.overrides,
            settings: &settings,
            whole,
            keeps: self.keeps_frames() && !settings.is_integer(),
        };
        let states = &self.cache.states;
        decide(&inputs, |object| states.get(object).map_or(&[], ObjectState::all_lamps), &mut self.cache.plan);
        settings
    }

    /// Returns whether the last frame may be left as it is if nothing has changed.
    fn keeps_frames(&self) -> bool {
        self.overrides.get(None, Effect::Transform) != Some(true)
    }
}
