//! Turntable: a model in a scene made for it, or a scene from a file.

use core::f64::consts::TAU;

use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::{Blend, Light, Material, RampChoice};
use mode13h::mesh::Mesh;
use mode13h::palette::{Palette, Rgb};
use mode13h::render::RenderError;
use mode13h::scene::{Camera, Motion, Moving, Object, Scene, Shared, UpAxis};
use mode13h::settings::DitherPattern;
use mode13h::texture::Texture;
use mode13h_assets::auto_palette::{self, AutomaticPalette};
use mode13h_assets::look::Look;
use mode13h_assets::model::{Playback, composed, studio};
use mode13h_assets::model_file::Rig;

/// Colours of the frame's bytes.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum Colors {
    /// The colours of a palette.
    Palette(Box<Palette>),
    /// Colours made for what is visible.
    Auto,
}

impl From<Palette> for Colors {
    fn from(palette: Palette) -> Colors {
        Colors::Palette(Box::new(palette))
    }
}

/// How the user has turned and enlarged the picture, in addition to the motion by the clock.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Pose {
    /// The rotation of what is shown about its upward axis, counter-clockwise as seen from above, in radians.
    pub(crate) turn: f64,
    /// The tilt of its upper end towards the camera, in radians.
    pub(crate) tilt: f64,
    /// Its size relative to the initial one.
    pub(crate) zoom: f64,
}

impl Pose {
    /// The pose in which every picture starts.
    pub(crate) const FIRST: Pose = Pose { turn: 0.0, tilt: 0.0, zoom: 1.0 };
}

/// Background that a frame is cleared to.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Background {
    /// An entry of the palette.
    Entry(u8),
    /// The entry that is nearest to a colour.
    Color(Rgb),
}

/// A scene, and what moves in it.
#[derive(Clone)]
pub(crate) struct Turntable {
    pub(crate) scene: Scene,
    shown: Shown,
    /// True if the camera frames each pose of the model by itself, for single pictures, not the whole turn.
    pub(crate) frames_still: bool,
    /// True if it may be turned, so that an automatic palette is for all of its sides.
    pub(crate) turns: bool,
    /// True if it is drawn by the 16.16 path, so that an automatic palette is for what that draws.
    pub(crate) in_integers: bool,
    /// The camera, without the effect of the user's pose.
    camera: Camera,
    /// Enlargement, independent of the pose.
    pub(crate) zoom: f64,
    /// The objects' materials, whatever the palette.
    materials: Vec<Vec<Material>>,
    /// True if their images are shown.
    has_images: bool,
    /// The palette whose ramps the materials name.
    palette: Option<Palette>,
    /// Dither that the scene asks for, whatever the palette.
    own_dither: Option<DitherPattern>,
    /// The models in the scene that move by themselves.
    playbacks: Vec<Playback>,
    /// The dither, or none, that the user asked for, if any; it overrides scene and palette from the next
    /// [`set_colors`](Self::set_colors) on.
    pub(crate) dither: Option<Option<DitherPattern>>,
    /// The look whose colours an automatic palette gets.
    look: Option<Look>,
    /// The automatic palette, made when first asked for.
    automatic: Option<AutomaticPalette>,
    /// The colours chosen last.
    pub(crate) colors: Option<Colors>,
}

#[derive(Clone, Copy)]
enum Shown {
    /// One model, which turns under a fixed light, as if held in a hand.
    Model,
    /// A scene with its own motion, which the camera circles.
    Scene,
}

/// The longest loop, in seconds, as in a scene file: an animation has frames for all of it.
const MAX_DURATION: f64 = 3600.0;

impl Turntable {
    /// A shape as [`Scene::showing`] shows it, in greys.
    pub(crate) fn of_shape(mesh: Mesh, up: Option<UpAxis>) -> Turntable {
        let mut object = Object::new(mesh);
        object.up_axis = up.unwrap_or(UpAxis::Y);
        Turntable::new(Scene::showing(object), Shown::Model)
    }

    /// A model in the [`studio`], in greys. One that moves by itself does not turn as well.
    pub(crate) fn of_model(
        object: Object,
        up: Option<UpAxis>,
        moving: Option<(Rig, usize)>,
    ) -> Result<Turntable, RenderError> {
        let mut stage = Turntable::new(studio(object, up)?, Shown::Model);
        if let Some(playback) = stage.play(moving, false, false) {
            // Even so, its angles are set from the time.
            for motion in &mut stage.scene.motions {
                if let Motion::Spin { turns, .. } = motion {
                    *turns = [0.0; 3];
                }
            }
            stage.camera = playback.framing(&stage.scene.objects()[0]);
            stage.playbacks.push(playback);
        }
        Ok(stage)
    }

    /// A model with lights or a camera of its own, in greys.
    pub(crate) fn of_composed(
        object: Object,
        lights: &[Light],
        camera: Option<Camera>,
        moving: Option<(Rig, usize)>,
    ) -> Result<Turntable, RenderError> {
        let mut stage = Turntable::new(composed(object, lights, camera)?, Shown::Scene);
        if let Some(playback) = stage.play(moving, !lights.is_empty(), camera.is_some()) {
            if camera.is_none() {
                stage.camera = playback.framing(&stage.scene.objects()[0]);
            }
            stage.playbacks.push(playback);
        }
        Ok(stage)
    }

    /// Makes the only object play a clip of a rig; a loop takes as long as the clip.
    fn play(&mut self, moving: Option<(Rig, usize)>, lights: bool, camera: bool) -> Option<Playback> {
        let (rig, clip) = moving?;
        let playback = Playback::new(rig, clip, &self.scene, *self.scene.object_ids().first()?)?;
        let duration = playback.clip().duration();
        if duration > 0.0 {
            self.scene.duration = duration.min(MAX_DURATION);
        }
        Some(playback.with_lights_and_camera(lights, camera))
    }

    pub(crate) fn of_scene(scene: Scene) -> Turntable {
        Turntable::new(scene, Shown::Scene)
    }

    /// A scene with models in it that move by themselves.
    pub(crate) fn of_moving_scene(scene: Scene, playbacks: Vec<Playback>) -> Turntable {
        Turntable { playbacks, ..Turntable::of_scene(scene) }
    }

    fn new(scene: Scene, shown: Shown) -> Turntable {
        let materials = scene.objects().iter().map(|object| object.materials.clone()).collect();
        let (camera, palette, own_dither) = (scene.camera, scene.palette.clone(), scene.settings.dither);
        Turntable {
            scene,
            shown,
            frames_still: false,
            turns: true,
            in_integers: false,
            camera,
            zoom: 1.0,
            materials,
            has_images: true,
            palette,
            own_dither,
            playbacks: Vec::new(),
            dither: None,
            look: None,
            automatic: None,
            colors: None,
        }
    }

    /// Returns whether any of its objects has colours of its own: a texture, or a surface that is not grey.
    pub(crate) fn has_colors(&self) -> bool {
        let mut surfaces = self.scene.objects().iter().flat_map(|object| object.mesh().surfaces());
        self.scene.lights().iter().any(|light| is_colored(light.color()))
            || surfaces.any(|surface| is_colored(surface.diffuse))
            || self.materials.iter().flatten().any(|material| material.texture.is_some())
    }

    /// Time and pose for `--turn`. A model is turned. In a scene or a model that moves by itself, time passes instead,
    /// with 360 degrees for one loop; around a scene that does not move, the camera circles.
    pub(crate) fn turned(&self, seconds: f64, degrees: f64) -> (f64, Pose) {
        match self.shown {
            Shown::Model if self.playbacks.is_empty() => {}
            Shown::Scene if !self.moves() => {}
            _ => return (seconds + degrees / 360.0 * self.scene.duration, Pose::FIRST),
        }
        (seconds, Pose { turn: degrees.to_radians(), ..Pose::FIRST })
    }

    /// Returns whether time changes the picture.
    fn moves(&self) -> bool {
        let Scene { motions, palette_animation, .. } = &self.scene;
        !(self.playbacks.is_empty() && motions.is_empty() && palette_animation.is_none())
    }

    /// Moves everything to where it is at a time, in seconds, seen in a pose.
    pub(crate) fn show(&mut self, seconds: f64, pose: Pose) {
        let Pose { turn, tilt, zoom } = pose;
        self.scene.camera = self.camera;
        self.scene.set_time(seconds);
        for playback in &mut self.playbacks {
            playback.show(&mut self.scene, seconds);
        }
        let is_turned = turn != 0.0 || tilt != 0.0;
        match self.shown {
            Shown::Model => {
                for object in self.scene.objects_mut() {
                    let [x, y, z] = object.angles;
                    object.angles = [x + Angle::from_radians(tilt), y + Angle::from_radians(turn), z];
                }
                if self.frames_still {
                    self.scene.camera = Camera::framing_still(&self.scene.objects()[0]);
                }
            }
            Shown::Scene if is_turned => self.scene.camera = circled(self.scene.camera, turn, tilt),
            Shown::Scene => {}
        }
        let zoom = self.zoom * zoom;
        if zoom != 1.0 {
            self.scene.camera = zoomed(self.scene.camera, zoom);
        }
    }

    /// Looks from a fixed point at a fixed point.
    pub(crate) fn set_camera(&mut self, eye: Vec3, target: Vec3) {
        let near = self.camera.near.min(Camera::near_for(eye.distance(target)));
        self.camera = Camera { eye, target, near, ..self.camera };
        let moves_eye = |motion: &Motion| matches!(motion, Motion::Path { what: Moving::Eye | Moving::Target, .. });
        self.scene.motions.retain(|motion| !moves_eye(motion));
        self.playbacks.iter_mut().for_each(Playback::release_camera);
    }

    /// Sets the background that a frame is cleared to, from the next [`set_colors`](Self::set_colors) on.
    pub(crate) fn set_background(&mut self, background: Background) {
        (self.scene.background, self.scene.background_color) = match background {
            Background::Entry(entry) => (entry, None),
            Background::Color(color) => (Palette::default().nearest(color), Some(color)),
        };
    }

    /// Sets the look that automatic palettes are rounded for.
    pub(crate) fn set_look(&mut self, look: Look) {
        (self.look, self.automatic) = (Some(look), None);
    }

    /// Takes the settings of a look, from the next [`set_colors`](Self::set_colors) on, in place of the scene's own.
    pub(crate) fn take_settings(&mut self, look: Look) {
        self.scene.settings = look.settings().or(&self.scene.settings);
        self.own_dither = self.scene.settings.dither;
    }

    /// Switches images on or off. If there are none, each surface gets a chequered one: by the mesh's texture
    /// coordinates, or else as its environment map. An automatic palette is made again.
    pub(crate) fn set_images(&mut self, on: bool) -> Result<(), RenderError> {
        self.has_images = on;
        self.automatic = None;
        let is_plain = |material: &Material| material.texture.is_none() && material.environment.is_none();
        if on
            && self.materials.iter().flatten().all(is_plain)
            && let Some(checker) = "checker".parse::<Texture>().ok().map(Shared::new)
        {
            for (object, materials) in self.scene.objects().iter().zip(&mut self.materials) {
                let has_coordinates = object.mesh().texcoords().is_some();
                for material in materials {
                    let place = if has_coordinates { &mut material.texture } else { &mut material.environment };
                    *place = Some(Shared::clone(&checker));
                }
            }
        }
        match self.colors.clone() {
            Some(colors) => self.set_colors(&colors),
            None => {
                let materials = self.materials_shown();
                self.scene.objects_mut().iter_mut().zip(materials).for_each(|(object, own)| object.materials = own);
                Ok(())
            }
        }
    }

    /// The objects' materials, without images if these are off.
    fn materials_shown(&self) -> Vec<Vec<Material>> {
        let mut materials = self.materials.clone();
        if !self.has_images {
            for material in materials.iter_mut().flatten() {
                (material.texture, material.environment) = (None, None);
            }
        }
        materials
    }

    /// Changes the colours. The background keeps its chosen colour. If a palette has no ramps, objects are drawn in the
    /// entries nearest to their own colours, or to those of the ramps that they had, with dither, because a
    /// general-purpose palette has few shades of any one colour.
    pub(crate) fn set_colors(&mut self, colors: &Colors) -> Result<(), RenderError> {
        let mut dither = self.own_dither;
        let shown = self.materials_shown();
        let has_no_ramps = matches!(colors, Colors::Palette(palette) if palette.ramps() == 0);
        for (object, shown) in self.scene.objects_mut().iter_mut().zip(shown) {
            object.materials = shown;
            if has_no_ramps {
                let named = |material: &Material| matches!(material.ramp, RampChoice::Number(_));
                if object.materials.iter().any(named) {
                    dither.get_or_insert_default();
                }
                object.materials = auto_palette::without_ramps(object, self.palette.as_ref());
            }
        }
        self.scene.settings.dither = self.dither.unwrap_or(dither);
        self.scene.auto_palette = false;
        match colors {
            Colors::Palette(palette) => {
                self.scene.set_palette(Palette::clone(palette));
            }
            Colors::Auto => self.automatic()?.apply(&mut self.scene),
        }
        self.colors = Some(colors.clone());
        Ok(())
    }

    /// The palette made for what is visible over a loop, computed once.
    pub(crate) fn automatic(&mut self) -> Result<AutomaticPalette, RenderError> {
        if let Some(made) = &self.automatic {
            return Ok(made.clone());
        }
        let mut made = self.made()?;
        if let Some(look) = self.look {
            made.palette = look.rounded(&made.palette);
        }
        Ok(self.automatic.insert(made).clone())
    }

    /// Makes a palette for what is visible over a loop.
    fn made(&self) -> Result<AutomaticPalette, RenderError> {
        let mut scene = self.at_first();
        let camera = scene.camera;
        let is_circled = self.turns && matches!(self.shown, Shown::Scene) && !self.moves();
        if self.playbacks.is_empty() && !is_circled {
            return auto_palette::of_scene(&scene);
        }
        let duration = scene.duration;
        let is_model = matches!(self.shown, Shown::Model);
        if is_model {
            // In a second loop the scene also turns, because the user may turn it.
            scene.duration *= 2.0;
        }
        let periods = self.playbacks.iter().map(|playback| playback.clip().duration());
        let periods: Vec<f64> = periods.chain(is_circled.then_some(duration)).collect();
        auto_palette::of_moving_scene(&scene, &periods, |scene, seconds| {
            if is_circled {
                scene.camera = circled(camera, TAU * seconds / duration, 0.0);
            }
            self.playbacks.iter().for_each(|playback| playback.show_in(scene, seconds));
            if is_model && seconds > duration {
                let turn = Angle::from_radians(TAU * (seconds / duration - 1.0));
                scene.objects_mut().iter_mut().for_each(|object| object.angles[1] += turn);
            }
        })
    }

    /// The scene at the beginning of a loop, in its own palette.
    fn at_first(&self) -> Scene {
        let mut stage = Turntable { frames_still: false, ..self.clone() };
        stage.show(0.0, Pose::FIRST);
        let mut scene = stage.scene;
        scene.palette.clone_from(&self.palette);
        scene.objects_mut().iter_mut().zip(self.materials_shown()).for_each(|(object, own)| object.materials = own);
        if self.in_integers {
            only_what_integers_draw(&mut scene);
        }
        scene
    }

    /// Lets the 16.16 path draw it: an automatic palette is made again.
    pub(crate) fn draw_in_integers(&mut self) -> Result<(), RenderError> {
        (self.in_integers, self.automatic) = (true, None);
        if self.colors == Some(Colors::Auto) { self.set_colors(&Colors::Auto) } else { Ok(()) }
    }
}

/// Removes effects that the 16.16 path does not draw.
fn only_what_integers_draw(scene: &mut Scene) {
    (scene.fog, scene.settings.channels) = (None, None);
    for light in scene.lights_mut() {
        *light = light.with_intensity(light.brightness()).with_color([1.0; 3]);
    }
    for material in scene.objects_mut().iter_mut().flat_map(|object| &mut object.materials) {
        (material.texture, material.environment, material.blend) = (None, None, Blend::Opaque);
    }
}

fn is_colored([red, green, blue]: [f32; 3]) -> bool {
    red != green || green != blue
}

/// Scales a camera's picture. To enlarge it, the view is narrowed, because going nearer would end inside the model; to
/// shrink it, the camera goes farther away, because a wider view would distort it.
fn zoomed(mut camera: Camera, zoom: f64) -> Camera {
    let half = camera.field_of_view.to_radians() / 2.0;
    // Rounded to f32, so that pictures stay as they were.
    let narrowed = (2.0 * libm::atan(libm::tan(half) / zoom.max(1.0))) as f32;
    camera.field_of_view = Angle::from_radians(narrowed.into());
    if zoom < 1.0 {
        camera.eye = camera.target + (camera.eye - camera.target) / zoom as f32;
    }
    camera
}

/// A camera that has moved around its target: the scene seems to have turned by `turn` about the camera's upward axis,
/// and its upper end to have come nearer by `tilt`.
fn circled(mut camera: Camera, turn: f64, tilt: f64) -> Camera {
    let up = camera.up.normalize_or(Vec3::Y);
    let out = camera.eye - camera.target;
    // If it looks along its upward axis, any axis perpendicular to that will do.
    let right = up.cross(out).normalize_or(up.any_orthonormal_vector());
    let turned = |v: Vec3| about(up, -turn, about(right, -tilt, v));
    camera.eye = camera.target + turned(out);
    camera.up = turned(up);
    camera
}

/// Rotates `v` about a unit axis, counter-clockwise as seen from its end (Rodrigues' formula).
fn about(axis: Vec3, angle: f64, v: Vec3) -> Vec3 {
    let (sine, cosine) = libm::sincos(angle);
    let (sine, cosine) = (sine as f32, cosine as f32);
    v * cosine + axis.cross(v) * sine + axis * (axis.dot(v) * (1.0 - cosine))
}

#[cfg(test)]
mod tests {
    use super::*;
    use mode13h_assets::shipped;

    fn near(a: Vec3, b: Vec3) -> bool {
        (a - b).length() < 1e-5
    }

    #[test]
    fn a_camera_circles_so_that_its_target_seems_to_turn() {
        let camera = Camera { target: Vec3::new(1.0, 2.0, 3.0), ..Camera::framing(Vec3::ZERO, 1.0) };
        let camera = Camera { eye: camera.target + Vec3::Z * 4.0, ..camera };
        // A quarter turn counter-clockwise seen from above brings what was at the left to the front.
        let left = circled(camera, TAU / 4.0, 0.0);
        assert!(near(left.eye, camera.target - Vec3::X * 4.0), "{}", left.eye);
        assert!(near(left.up, Vec3::Y));
        // A quarter turn of the upper end towards the camera shows it from above.
        let above = circled(camera, 0.0, TAU / 4.0);
        assert!(near(above.eye, camera.target + Vec3::Y * 4.0), "{}", above.eye);
        assert!(near(above.up, Vec3::NEG_Z), "{}", above.up);
        assert!(near(circled(camera, TAU, TAU).eye, camera.eye));
    }

    /// The torus scene looks the same as the torus model.
    #[test]
    fn the_scene_of_the_torus_is_the_model_on_its_stage() {
        let mesh = mode13h::mesh::shapes::by_name("torus").expect("a shape");
        let mut model = Turntable::of_shape(mesh, None);
        let scene = "torus".parse::<shipped::Shipped>().expect("a scene").load().expect("a scene that loads").scene;
        let mut scene = Turntable::of_scene(scene);
        let mut renderer = mode13h::render::Renderer::new();
        let mut frame = |stage: &Turntable| {
            let mut vga = mode13h::vga::Vga::new();
            renderer.draw(&stage.scene, &mut vga).expect("a legal scene");
            (vga.pixels().to_vec(), vga.palette())
        };
        for (at, degrees) in [(0.0, 0.0), (0.0, 45.0), (1.0, 0.0), (2.5, 0.0), (7.0, 90.0), (-0.5, 360.0 / 7.0)] {
            for stage in [&mut model, &mut scene] {
                let (seconds, pose) = stage.turned(at, degrees);
                stage.show(seconds, pose);
            }
            assert!(frame(&model) == frame(&scene), "{degrees} degrees at {at} s");
        }
    }

    #[test]
    fn a_scene_that_moves_goes_on_and_another_is_circled() {
        let torus = "torus".parse::<shipped::Shipped>().expect("a scene").load().expect("a scene that loads").scene;
        assert_eq!(Turntable::of_scene(torus.clone()).turned(1.0, 90.0), (2.0, Pose::FIRST));
        let mut still = torus;
        still.motions.clear();
        let stage = Turntable::of_scene(still);
        assert_eq!(stage.turned(1.0, 90.0), (1.0, Pose { turn: TAU / 4.0, ..Pose::FIRST }));
    }
}
