//! One hash over a fixed set of frames, the same on every machine.

use super::fingerprint::{START, fnv_1a};
use alloc::boxed::Box;
use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::{Light, RampChoice};
use mode13h::mesh::{Mesh, shapes};
use mode13h::palette::{Ramp, builtin};
use mode13h::render::{HiddenSurfaces, Renderer, Shading, VertexPath};
use mode13h::scene::{Camera, Object, Scene, Shared};
use mode13h::span::Kernel;
use mode13h::vga::Vga;

/// The frames and what came of them.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct Frames {
    /// Number of frames.
    pub count: u64,
    /// FNV-1a, 64 bits, over the 64,000 bytes of each and the 256 colours that the machine shows.
    pub hash: u64,
}

impl Frames {
    /// Count and hash that [`frames`] gives on every machine. They change with the golden frames, and then stand in
    /// CHANGELOG.md.
    pub const EXPECTED: Self = Self { count: 880, hash: 0x6F06_1FAC_3D2B_F1DD };

    /// Returns whether they are the frames of every other machine.
    #[must_use]
    pub fn passed(self) -> bool {
        self == Self::EXPECTED
    }
}

/// Draws every shape on every shading by both vertex paths at four angles, then two tori that pass through
/// each other and reach behind the eye by every hidden-surface method, with `kernel`.
///
/// ```
/// use mode13h::span::Kernel;
/// use mode13h_lab::verify::{Frames, frames};
/// assert_eq!(frames(Kernel::default()), Frames::EXPECTED);
/// ```
#[must_use]
pub fn frames(kernel: Kernel) -> Frames {
    frames_in_steps(kernel, 1)
}

/// Draws every `step`-th of the frames of [`frames`], the first among them: a part for slow machines, to be compared with
/// that part elsewhere. 0 counts as 1.
#[must_use]
pub fn frames_in_steps(kernel: Kernel, step: u64) -> Frames {
    let mut drawing = Drawing::new(step);
    drawing.renderer.settings.kernel = kernel;
    let ways = VertexPath::ALL.into_iter().flat_map(|path| Shading::ALL.map(|shading| (path, shading)));
    for (shape, name) in shapes::NAMES.iter().enumerate() {
        let Some(mesh) = shapes::by_name(name).map(Shared::new) else { continue };
        for (number, (path, shading)) in ways.clone().enumerate() {
            drawing.shade(path, shading);
            for step in 0..4_u8 {
                let mut scene = framed(mesh.clone());
                scene.palette = Some(builtin::ALL[(shape + number) % builtin::ALL.len()].palette.clone());
                // All entries, also of a palette without ramps.
                let whole = scene.palette.as_ref().is_some_and(|palette| palette.ramps() == 0);
                if whole {
                    scene.objects_mut()[0].materials[0].ramp = RampChoice::Entries(Ramp::WHOLE);
                }
                scene.background = step;
                scene.objects_mut()[0].angles = [0.4, f64::from(step) * 1.7, 0.1].map(Angle::from_radians);
                drawing.draw(&scene);
            }
        }
    }
    let torus = Shared::new(shapes::torus(24, 12));
    for way in HiddenSurfaces::ALL {
        drawing.renderer.settings.hidden_surfaces = Some(way);
        for (path, shading) in ways.clone() {
            drawing.shade(path, shading);
            for step in 0..4_u8 {
                drawing.draw(&close_up(&torus, f64::from(step)));
            }
        }
    }
    drawing.frames
}

/// The machine that is drawn on, and what came of the frames so far.
struct Drawing {
    renderer: Renderer,
    vga: Box<Vga>,
    frames: Frames,
    /// Every how many frames one is drawn.
    step: u64,
    /// Index of the next frame.
    index: u64,
}

impl Drawing {
    fn new(step: u64) -> Self {
        let frames = Frames { count: 0, hash: START };
        Self { renderer: Renderer::new(), vga: Box::default(), frames, step: step.max(1), index: 0 }
    }

    fn shade(&mut self, path: VertexPath, shading: Shading) {
        self.renderer.settings.vertex_path = path;
        self.renderer.settings.accuracy = Some(shading.into());
    }

    fn draw(&mut self, scene: &Scene) {
        let is_drawn = self.index.is_multiple_of(self.step);
        self.index += 1;
        if !is_drawn {
            return;
        }
        let frames = &mut self.frames;
        if self.renderer.draw(scene, &mut self.vga).is_ok() {
            frames.count += 1;
        }
        frames.hash = fnv_1a(frames.hash, self.vga.pixels());
        for color in self.vga.palette().colors() {
            frames.hash = fnv_1a(frames.hash, &[color.r, color.g, color.b]);
        }
    }
}

/// A mesh in the middle, seen straight on by a camera that frames its sphere, under one sun: however it is turned it is in
/// the picture.
pub(in super::super) fn framed(mesh: impl Into<Shared<Mesh>>) -> Scene {
    let object = Object::new(mesh).centred();
    let mut scene = Scene::new();
    scene.camera = Camera::framing(Vec3::ZERO, object.mesh().bounds().radius);
    scene.add(object);
    scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    scene
}

/// Two tori, one through the other, that reach beyond the near plane and the guard band.
fn close_up(torus: &Shared<Mesh>, turn: f64) -> Scene {
    let mut scene = framed(torus.clone());
    scene.palette = Some(builtin::COPPER.clone());
    let mut second = Object::new(torus.clone());
    second.position = Vec3::new(0.5, 0.0, 0.0);
    second.angles = [1.5, turn, 0.0].map(Angle::from_radians);
    scene.add(second);
    scene.objects_mut()[0].angles = [0.2, 0.1, turn].map(Angle::from_radians);
    scene.camera.near = 0.3;
    scene.camera.eye.z = 1.1;
    scene.add_light(Light::sun([-1.0, 0.2, 0.3]).with_intensity(0.4));
    scene
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Another kernel gives the same; a change of one pixel or one colour does not.
    #[test]
    fn a_wrong_frame_changes_the_hash() {
        let hash_of = |change: &dyn Fn(&mut Scene)| {
            let mut scene = framed(shapes::cube());
            change(&mut scene);
            let mut drawing = Drawing::new(1);
            drawing.draw(&scene);
            drawing.frames.hash
        };
        let plain = hash_of(&|_| {});
        assert_eq!(hash_of(&|_| {}), plain);
        assert_ne!(hash_of(&|scene| scene.background = 1), plain);
        assert_ne!(hash_of(&|scene| scene.palette = Some(builtin::COPPER.clone())), plain);
        assert!(!Frames { hash: plain, ..Frames::EXPECTED }.passed());
    }

    /// A part is some of the frames, in their order.
    #[test]
    fn a_part_has_its_share() {
        let part = frames_in_steps(Kernel::PORTABLE, 111);
        assert_eq!(part.count, 8, "0, 111, … 777");
        assert_ne!(part.hash, frames_in_steps(Kernel::PORTABLE, 112).hash);
    }
}
