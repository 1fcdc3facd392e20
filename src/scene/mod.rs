//! Scenes: objects, camera, lights, fog, palette, motions, and settings.
//!
//! A scene is plain data. Nothing in it is borrowed between frames: change it, draw it, change it again. Errors in it
//! (a position that is not finite, a camera without a direction) are reported when it is drawn.
//!
//! | item | what |
//! |---|---|
//! | [`Object`] | a mesh, its position and rotation, its materials |
//! | [`Camera`], [`framing`] | the camera; cameras that fit everything into the picture |
//! | [`Fog`] | what distant surfaces fade into |
//! | [`Motion`] | positions and angles from absolute time |
//! | [`PaletteAnimation`] | colours that change while the picture stays |

mod animation;
mod camera;
mod fog;
pub mod framing;
mod motion;
pub(crate) mod object;

use alloc::string::String;
use alloc::vec::Vec;
use core::ops::{Index, IndexMut};

use glam::Vec3;

use crate::angle::Angle;
use crate::light::Light;
use crate::palette::{BIOS, Palette, Rgb, builtin};
use crate::settings::Settings;
pub use crate::shared::Shared;
use crate::vga::Vga;
pub use animation::PaletteAnimation;
pub use camera::Camera;
pub use fog::Fog;
pub use motion::{Motion, Moving, Path};
pub(crate) use object::matrix_product;
pub use object::{Object, UpAxis};

/// An object in a scene, as returned by [`Scene::add`]. Valid until the object is removed.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct ObjectId(u32);

/// A light in a scene, as returned by [`Scene::add_light`]. Valid until the light is removed.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct LightId(u32);

/// A scene: everything that is drawn.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The display name.
    pub name: String,
    /// The camera.
    pub camera: Camera,
    /// Ia: the intensity of ambient light.
    pub ambient: f32,
    /// The palette index that the frame is cleared to.
    pub background: u8,
    /// The colour that [`background`](Self::background) was chosen for, if any: for
    /// [`set_palette`](Self::set_palette), which looks for its nearest entry. Drawing ignores it.
    pub background_color: Option<Rgb>,
    /// The palette loaded into the DAC when the scene is drawn; with `None` the DAC is left alone. If the palette has
    /// no ramps, materials that name one are drawn with the nearest entries, dithered.
    ///
    /// With textures, fog or transparency a new palette costs milliseconds, since their tables are recomputed. Fade
    /// with [`palette_animation`](Self::palette_animation), or with [`Vga::fade`](crate::vga::Vga::fade) after drawing.
    pub palette: Option<Palette>,
    /// The change of the palette over time.
    pub palette_animation: Option<PaletteAnimation>,
    /// The fog between the eye and distant surfaces.
    pub fog: Option<Fog>,
    /// How to draw the scene, where the renderer's own settings leave it open.
    pub settings: Settings,
    /// Asks for a palette made from the scene's materials. Drawing ignores this: whoever loads the scene calls
    /// `mode13h_assets::auto_palette`.
    pub auto_palette: bool,
    /// The motions; [`set_time`](Self::set_time) moves objects, lights and camera accordingly.
    pub motions: Vec<Motion>,
    /// The duration of one loop, in seconds; above 0. An animation of that length repeats seamlessly if every motion's
    /// period divides it.
    pub duration: f64,
    /// The time of a still picture, in seconds: the moment that shows the scene's subject best.
    pub picture: f64,
    time: f64,
    objects: Vec<Object>,
    /// The ids, one for each object, ascending.
    object_ids: Vec<ObjectId>,
    lights: Vec<Light>,
    /// The ids, one for each light, ascending.
    light_ids: Vec<LightId>,
    /// The next id to hand out.
    next_id: u32,
}

impl Scene {
    /// The angle by which the top of a [shown](Self::showing) object is tilted towards the eye.
    pub const TILT: Angle = Angle::from_radians(0.35);

    /// Makes an empty scene: ambient light of intensity 1 and no other, a grey palette, entry 0 as background, a loop
    /// of four seconds, and a camera that looks along −z at the unit sphere around the origin.
    #[must_use]
    pub fn new() -> Self {
        Self {
            name: String::new(),
            camera: Camera::default(),
            ambient: 1.0,
            background: 0,
            background_color: None,
            palette: Some(builtin::GREY.clone()),
            palette_animation: None,
            fog: None,
            settings: Settings::default(),
            auto_palette: false,
            motions: Vec::new(),
            duration: 4.0,
            picture: 0.0,
            time: 0.0,
            objects: Vec::new(),
            object_ids: Vec::new(),
            lights: Vec::new(),
            light_ids: Vec::new(),
            next_id: 0,
        }
    }

    /// Makes a scene that [shows](Self::show) a mesh or an object.
    #[must_use]
    pub fn showing(object: impl Into<Object>) -> Self {
        let mut scene = Self::new();
        scene.show(object);
        scene
    }

    /// Adds a mesh, or an object with its own materials and up axis, and shows it: centred, filling the picture,
    /// turning about its centre, lit by one sun from the upper right behind the eye.
    ///
    /// The object is tilted a little towards the eye, so that a flat one is not a line, and turns once per
    /// [loop](Self::duration), driven by [`set_time`](Self::set_time). Over the whole turn it fills nine tenths of the
    /// picture's width or height ([`Camera::framing_turn`]).
    ///
    /// ```
    /// use mode13h::mesh::shapes;
    /// use mode13h::scene::Scene;
    /// let mut scene = Scene::new();
    /// let teapot = scene.show(shapes::teapot(8));
    /// scene[teapot].materials[0].specular = 0.5;
    /// scene.set_time(scene.duration / 4.0);
    /// assert_eq!(scene[teapot].angles[1].to_degrees(), 90.0);
    /// ```
    pub fn show(&mut self, object: impl Into<Object>) -> ObjectId {
        self.show_turned(object.into(), |_| [Self::TILT, Angle::default()])
    }

    /// [Shows](Self::show) an object with other initial angles about x and y. `angles` is called with the object once
    /// it is centred.
    pub fn show_turned(&mut self, object: Object, angles: impl FnOnce(&Object) -> [Angle; 2]) -> ObjectId {
        let mut object = object.centred();
        object.position = Vec3::ZERO;
        let [tilt, turn] = angles(&object);
        object.angles = [tilt, turn, Angle::default()];
        self.camera = Camera::framing_turn(&object);
        let start = object.angles;
        let object = self.add(object);
        self.motions.push(Motion::Spin { object, start, turns: [0.0, 1.0 / self.duration, 0.0] });
        self.add_light(Light::sun([0.4, 0.6, 1.0]));
        object
    }

    /// Sets the colour behind all objects: its nearest entry in the scene's palette, or without one in the card's own.
    pub fn set_background(&mut self, color: Rgb) {
        self.background = self.palette.as_ref().unwrap_or(&BIOS).nearest(color);
        self.background_color = Some(color);
    }

    /// Sets the palette, and the background to the nearest entry of the colour that it was
    /// [chosen](Self::set_background) for, if any.
    ///
    /// ```
    /// use mode13h::palette::{Palette, Rgb};
    /// use mode13h::scene::Scene;
    ///
    /// let mut scene = Scene::new();
    /// scene.set_background(Rgb::new(0, 0, 170));
    /// scene.set_palette(Palette::default());
    /// assert_eq!(scene.background, 1);
    /// ```
    pub fn set_palette(&mut self, palette: Palette) {
        if let Some(color) = self.background_color {
            self.background = palette.nearest(color);
        }
        self.palette = Some(palette);
    }

    /// Appends an object.
    pub fn add(&mut self, object: Object) -> ObjectId {
        let id = ObjectId(self.new_id());
        self.objects.push(object);
        self.object_ids.push(id);
        id
    }

    /// Removes an object and returns it; `None` if it was removed before. The objects after it move down by one index.
    /// Motions that name it have no effect, and its children are placed as if they had no parent.
    ///
    /// ```
    /// use mode13h::mesh::shapes;
    /// use mode13h::scene::{Object, Scene};
    /// let mut scene = Scene::new();
    /// let shot = scene.add(Object::new(shapes::cube()));
    /// let ship = scene.add(Object::new(shapes::torus(12, 8)).named("ship"));
    /// assert!(scene.remove(shot).is_some() && scene.remove(shot).is_none());
    /// assert_eq!(scene[ship].name, "ship");
    /// ```
    pub fn remove(&mut self, id: ObjectId) -> Option<Object> {
        let index = self.index_of(id)?;
        self.object_ids.remove(index);
        Some(self.objects.remove(index))
    }

    /// The index of an object in [`objects`](Self::objects); `None` if it was removed.
    #[must_use]
    pub fn index_of(&self, id: ObjectId) -> Option<usize> {
        self.object_ids.binary_search(&id).ok()
    }

    /// An object; `None` if it was removed.
    #[must_use]
    pub fn get(&self, id: ObjectId) -> Option<&Object> {
        self.objects.get(self.index_of(id)?)
    }

    /// An object, mutably; `None` if it was removed.
    pub fn get_mut(&mut self, id: ObjectId) -> Option<&mut Object> {
        let index = self.index_of(id)?;
        self.objects.get_mut(index)
    }

    /// The ids of [`objects`](Self::objects), in the same order.
    #[must_use]
    pub fn object_ids(&self) -> &[ObjectId] {
        &self.object_ids
    }

    /// The ids of [`lights`](Self::lights), in the same order.
    #[must_use]
    pub fn light_ids(&self) -> &[LightId] {
        &self.light_ids
    }

    /// Appends a light.
    pub fn add_light(&mut self, light: Light) -> LightId {
        let id = LightId(self.new_id());
        self.lights.push(light);
        self.light_ids.push(id);
        id
    }

    /// Removes a light and returns it; `None` if it was removed before.
    pub fn remove_light(&mut self, id: LightId) -> Option<Light> {
        let index = self.light_ids.binary_search(&id).ok()?;
        self.light_ids.remove(index);
        Some(self.lights.remove(index))
    }

    /// Removes all lights.
    pub fn clear_lights(&mut self) {
        self.lights.clear();
        self.light_ids.clear();
    }

    /// A light, mutably; `None` if it was removed.
    fn light_mut(&mut self, id: LightId) -> Option<&mut Light> {
        let index = self.light_ids.binary_search(&id).ok()?;
        self.lights.get_mut(index)
    }

    /// Makes an id. Ids ascend, and only repeat after 2³².
    fn new_id(&mut self) -> u32 {
        let id = self.next_id;
        self.next_id = self.next_id.wrapping_add(1);
        id
    }

    /// The objects, in the order in which they were added.
    #[must_use]
    pub fn objects(&self) -> &[Object] {
        &self.objects
    }

    /// The objects, mutably.
    pub fn objects_mut(&mut self) -> &mut [Object] {
        &mut self.objects
    }

    /// The lights, in the order in which they were added and are summed.
    #[must_use]
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// The lights, mutably.
    pub fn lights_mut(&mut self) -> &mut [Light] {
        &mut self.lights
    }

    /// Moves everything to its state at a time, in seconds. Motions that name a missing object or light have no effect.
    pub fn set_time(&mut self, seconds: f64) {
        self.time = seconds;
        for i in 0..self.motions.len() {
            match self.motions[i] {
                Motion::Spin { object, start, turns } => {
                    if let Some(object) = self.get_mut(object) {
                        object.angles = motion::spun(start, turns, seconds);
                    }
                }
                Motion::Path { what, path } => {
                    let moved = match what {
                        Moving::Object(object) => self.get_mut(object).map(|object| &mut object.position),
                        Moving::Light(light) => self.light_mut(light).map(|light| match light {
                            Light::Sun { direction: vector, .. } | Light::Lamp { position: vector, .. } => vector,
                        }),
                        Moving::Eye => Some(&mut self.camera.eye),
                        Moving::Target => Some(&mut self.camera.target),
                    };
                    if let Some(vector) = moved {
                        *vector = path.at(seconds);
                    }
                }
            }
        }
    }

    /// The time it was last [set](Self::set_time) to, in seconds; initially 0.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Loads the DAC with the scene's palette, if it has one, as it is at the scene's time.
    pub fn load_palette(&self, vga: &mut Vga) {
        match (&self.palette, &self.palette_animation) {
            (Some(palette), Some(animation)) => animation.load(palette, self.time, vga),
            (Some(palette), None) => vga.set_palette(palette),
            (None, _) => {}
        }
    }
}

impl Default for Scene {
    fn default() -> Self {
        Self::new()
    }
}

/// Panics with the location of the code that indexed the scene.
#[cold]
#[track_caller]
fn not_there(what: &str) -> ! {
    panic!("this {what} was removed from the scene, or its id is from another scene")
}

impl Index<ObjectId> for Scene {
    type Output = Object;

    /// # Panics
    /// If the object was removed. An id from another scene may name any object, or none. [`get`](Scene::get) does not
    /// panic.
    #[track_caller]
    fn index(&self, id: ObjectId) -> &Object {
        self.get(id).unwrap_or_else(|| not_there("object"))
    }
}

impl Index<LightId> for Scene {
    type Output = Light;

    /// # Panics
    /// If the light was removed. An id from another scene may name any light, or none.
    #[track_caller]
    fn index(&self, id: LightId) -> &Light {
        let index = self.light_ids.binary_search(&id);
        &self.lights[index.unwrap_or_else(|_| not_there("light"))]
    }
}

impl IndexMut<LightId> for Scene {
    /// # Panics
    /// If the light was removed. An id from another scene may name any light, or none.
    #[track_caller]
    fn index_mut(&mut self, id: LightId) -> &mut Light {
        self.light_mut(id).unwrap_or_else(|| not_there("light"))
    }
}

impl IndexMut<ObjectId> for Scene {
    /// # Panics
    /// If the object was removed. An id from another scene may name any object, or none. [`get_mut`](Scene::get_mut)
    /// does not panic.
    #[track_caller]
    fn index_mut(&mut self, id: ObjectId) -> &mut Object {
        self.get_mut(id).unwrap_or_else(|| not_there("object"))
    }
}
