//! The scene that a model is shown in: the model about the origin, a lamp, and a camera that frames it.

use std::f64::consts::TAU;

use mode13h::glam::Vec3;
use mode13h::light::Light;
use mode13h::mesh::Mesh;
use mode13h::palette::Palette;
use mode13h::scene::{Camera, Object, ObjectId, Scene};

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
    /// `mesh` has its middle in the origin.
    pub(crate) fn new(mesh: Mesh, palette: Palette) -> Stage {
        let radius = mesh.bounds().radius;
        let mut scene = Scene::new();
        let object = scene.add(Object::new(mesh));
        // From the upper left, in front.
        scene.add_light(Light::sun([-0.4, 0.6, 1.0]));
        scene.palette = Some(palette);
        let mut stage = Stage { scene, object, radius };
        stage.pose(Pose::FIRST);
        stage
    }

    /// Puts the model as `pose` says.
    pub(crate) fn pose(&mut self, pose: Pose) {
        // A whole number of turns is taken off first: a day of turning is then as smooth as the first second.
        let turn = pose.turn.rem_euclid(TAU) as f32;
        let tilt = pose.tilt.rem_euclid(TAU) as f32;
        self.scene[self.object].set_angles([tilt, turn, 0.0]);
        self.scene.camera = Camera::framing(Vec3::ZERO, self.radius / pose.zoom as f32);
    }
}
