//! A model that plays one of its animations.

use mode13h::glam::Vec3;
use mode13h::light::Light;
use mode13h::mesh::Mesh;
use mode13h::scene::framing::{Swept, Turning, Viewpoint};
use mode13h::scene::{Camera, Object, ObjectId, Scene, Shared};

use crate::model_file::{Clip, Pose, Rig};

/// The number of poses in a loop that a picture is framed for.
const POSES: u32 = 16;

/// A model in a scene that plays one of its animations, again and again.
#[derive(Clone, Debug)]
pub struct Playback {
    rig: Shared<Rig>,
    /// The mesh at rest.
    mesh: Shared<Mesh>,
    clip: usize,
    object: ObjectId,
    /// The factors by which the object's mesh was stretched.
    stretch: Vec3,
    /// True if the scene's lights come from the file, and if its camera does.
    moves_lights: bool,
    moves_camera: bool,
    /// The time that was shown last, the mesh of the object, and the camera then.
    shown: Option<(f64, Shared<Mesh>, Option<Camera>)>,
}

impl Playback {
    /// Makes an object play a clip, by its index; if there is no such clip, the first. The object's mesh must be the
    /// one that was read with the rig.
    #[must_use]
    pub fn new(rig: impl Into<Shared<Rig>>, clip: usize, scene: &Scene, object: ObjectId) -> Option<Self> {
        let (rig, mesh) = (rig.into(), Shared::new(scene.get(object)?.mesh().clone()));
        let clip = if clip < rig.clips().len() { clip } else { 0 };
        Some(Self {
            rig,
            mesh,
            clip,
            object,
            stretch: Vec3::ONE,
            moves_lights: false,
            moves_camera: false,
            shown: None,
        })
    }

    /// Also moves the scene's lights and its camera, which must be those of the model's file.
    #[must_use]
    pub fn with_lights_and_camera(mut self, lights: bool, camera: bool) -> Self {
        (self.moves_lights, self.moves_camera, self.shown) = (lights, camera, None);
        self
    }

    /// Stretches each pose, as the object's mesh was [stretched](Mesh::stretched) at rest.
    #[must_use]
    pub fn stretched(mut self, factors: Vec3) -> Self {
        (self.stretch, self.shown) = (factors, None);
        self
    }

    /// Leaves the camera alone from now on.
    pub fn release_camera(&mut self) {
        self.moves_camera = false;
    }

    /// The clip.
    #[must_use]
    pub fn clip(&self) -> &Clip {
        &self.rig.clips()[self.clip]
    }

    /// Moves the model to where it is at a time, in seconds. If the scene already shows that time, the mesh does not
    /// change, so that the renderer's caches stay valid.
    pub fn show(&mut self, scene: &mut Scene, seconds: f64) {
        let has = |mesh: &Mesh| scene.get(self.object).is_none_or(|object| core::ptr::eq(object.mesh(), mesh));
        let camera = match &self.shown {
            Some((shown, mesh, camera)) if *shown == seconds && has(mesh) => *camera,
            _ => {
                let Pose { mesh, lights, camera } = self.pose(seconds);
                let mesh = Shared::new(mesh);
                if let Some(object) = scene.get_mut(self.object) {
                    object.set_mesh(Shared::clone(&mesh));
                }
                if self.moves_lights {
                    scene.lights_mut().iter_mut().zip(&lights).for_each(|(light, place)| stand_as(light, place));
                }
                self.shown = Some((seconds, mesh, camera));
                camera
            }
        };
        if let (true, Some(camera)) = (self.moves_camera, camera) {
            scene.camera = camera;
        }
    }

    /// Moves the model in a copy of its scene, whatever is shown there or in the scene itself.
    pub fn show_in(&self, copy: &mut Scene, seconds: f64) {
        Self { shown: None, ..self.clone() }.show(copy, seconds);
    }

    fn pose(&self, seconds: f64) -> Pose {
        let mut pose = self.rig.pose(&self.mesh, self.clip, seconds);
        if self.stretch != Vec3::ONE {
            // If a position is beyond f32, it stays at rest.
            pose.mesh = pose.mesh.stretched(self.stretch).unwrap_or_else(|_| Mesh::clone(&self.mesh));
        }
        pose
    }

    /// An object in some poses of the clip, for bounds that must contain all of them.
    pub(crate) fn poses(&self, object: &Object) -> impl Iterator<Item = Object> {
        (0..POSES).map(|pose| {
            let mut object = object.clone();
            object.set_mesh(self.pose(self.clip().duration() * f64::from(pose) / f64::from(POSES)).mesh);
            object
        })
    }

    /// The camera that [frames a turn](Camera::framing_turn) of an object in all poses of the clip.
    #[must_use]
    pub fn framing(&self, object: &Object) -> Camera {
        let poses: Vec<Swept> = self.poses(object).map(|object| Swept::new(&object, Turning::Upright, None)).collect();
        let from = Viewpoint { direction: Vec3::Z, up: Vec3::Y, field_of_view: Camera::FIELD_OF_VIEW, target: None };
        from.camera(&poses).unwrap_or_else(|| Camera::framing_turn(object))
    }
}

/// Moves a light to where another one is.
fn stand_as(light: &mut Light, place: &Light) {
    match (light, place) {
        (Light::Sun { direction, .. }, Light::Sun { direction: place, .. }) => *direction = *place,
        (Light::Lamp { position, cone, .. }, Light::Lamp { position: place, cone: of_place, .. }) => {
            *position = *place;
            if let (Some(cone), Some(of_place)) = (cone, of_place) {
                cone.direction = of_place.direction;
            }
        }
        _ => {}
    }
}
