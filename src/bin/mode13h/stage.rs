//! The scene that a model is shown in: the model about the origin, a lamp, and a camera that frames it.

use std::f64::consts::TAU;

use mode13h::glam::Vec3;
use mode13h::light::Light;
use mode13h::mesh::Mesh;
use mode13h::palette::Palette;
use mode13h::scene::{Camera, Object, ObjectId, Scene, UpAxis};

/// How fast a model turns when nothing is said: once in four seconds, in radians a second.
pub(crate) const SPEED: f64 = TAU / 4.0;

/// How a model stands and how near it is.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Pose {
    /// About its own upward axis, counter-clockwise seen from above, in radians.
    pub(crate) turn: f64,
    /// Its upper end towards the camera, in radians.
    pub(crate) tilt: f64,
    /// How many times as large as when the frame just holds it.
    pub(crate) zoom: f64,
}

impl Pose {
    /// As every picture begins: seen a little from above, so that a flat model is not a line.
    pub(crate) const FIRST: Pose = Pose { turn: 0.0, tilt: 0.35, zoom: 1.0 };
}

/// A scene with one model.
#[derive(Clone)]
pub(crate) struct Stage {
    pub(crate) scene: Scene,
    object: ObjectId,
    radius: f32,
}

impl Stage {
    pub(crate) fn new(mesh: Mesh, up: UpAxis, palette: Palette) -> Stage {
        let radius = mesh.bounds().radius;
        let mut scene = Scene::new();
        let mut object = Object::new(mesh).centred();
        object.up_axis = up;
        let object = scene.add(object);
        scene.add_light(Light::sun([0.4, 0.6, 1.0]));
        scene.palette = Some(palette);
        let mut stage = Stage { scene, object, radius };
        stage.pose(Pose::FIRST);
        stage
    }

    /// Puts the model as `pose` says. To enlarge it the camera's view is narrowed, as going nearer would end inside
    /// the model; to make it smaller the camera goes farther away, as a wider view would bend it.
    pub(crate) fn pose(&mut self, Pose { turn, tilt, zoom }: Pose) {
        self.scene[self.object].set_angles([tilt, turn, 0.0]);
        let mut camera = Camera::framing(Vec3::ZERO, self.radius / zoom.min(1.0) as f32);
        let half = f64::from(camera.field_of_view) / 2.0;
        camera.field_of_view = (2.0 * libm::atan(libm::tan(half) / zoom.max(1.0))) as f32;
        self.scene.camera = camera;
    }
}
