//! One hash over a fixed set of frames, the same on every machine.

use super::fingerprint::{START, fnv_1a};
use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::Light;
use mode13h::mesh::{Mesh, shapes};
use mode13h::palette::builtin;
use mode13h::render::{HiddenSurfaces, Renderer, Shading, VertexPath};
use mode13h::scene::{Object, Scene, Shared};
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
/// assert_eq!(frames(Kernel::fastest()), Frames::EXPECTED);
/// ```
#[must_use]
pub fn frames(kernel: Kernel) -> Frames {
    let mut renderer = Renderer::new();
    renderer.settings.kernel = kernel;
    let mut frames = Frames { count: 0, hash: START };
    let mut vga = Vga::new();
    let ways = VertexPath::ALL.into_iter().flat_map(|path| Shading::ALL.map(|shading| (path, shading)));
    for (shape, name) in shapes::NAMES.iter().enumerate() {
        let Some(mesh) = shapes::by_name(name).map(Shared::new) else { continue };
        for (number, (path, shading)) in ways.clone().enumerate() {
            renderer.settings.vertex_path = path;
            renderer.settings.accuracy = Some(shading.into());
            for step in 0..4_u8 {
                let mut scene = super::framed(mesh.clone());
                scene.palette = Some(builtin::ALL[(shape + number) % builtin::ALL.len()].palette.clone());
                scene.background = step;
                scene.objects_mut()[0].angles = [0.4, f64::from(step) * 1.7, 0.1].map(Angle::from_radians);
                frames.draw(&mut renderer, &scene, &mut vga);
            }
        }
    }
    let torus = Shared::new(shapes::torus(24, 12));
    for way in HiddenSurfaces::ALL {
        renderer.settings.hidden_surfaces = Some(way);
        for (path, shading) in ways.clone() {
            renderer.settings.vertex_path = path;
            renderer.settings.accuracy = Some(shading.into());
            for step in 0..4_u8 {
                frames.draw(&mut renderer, &close_up(&torus, f64::from(step)), &mut vga);
            }
        }
    }
    frames
}

impl Frames {
    fn draw(&mut self, renderer: &mut Renderer, scene: &Scene, vga: &mut Vga) {
        if renderer.draw(scene, vga).is_ok() {
            self.count += 1;
        }
        self.hash = fnv_1a(self.hash, vga.pixels());
        for color in vga.palette().colors() {
            self.hash = fnv_1a(self.hash, &[color.r, color.g, color.b]);
        }
    }
}

/// Two tori, one through the other, that reach beyond the near plane and the guard band.
fn close_up(torus: &Shared<Mesh>, turn: f64) -> Scene {
    let mut scene = super::framed(torus.clone());
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
        let mut vga = Vga::new();
        let mut hash_of = |change: &dyn Fn(&mut Scene)| {
            let mut scene = super::super::framed(shapes::cube());
            change(&mut scene);
            let mut frames = Frames { count: 0, hash: START };
            frames.draw(&mut Renderer::new(), &scene, &mut vga);
            frames.hash
        };
        let plain = hash_of(&|_| {});
        assert_eq!(hash_of(&|_| {}), plain);
        assert_ne!(hash_of(&|scene| scene.background = 1), plain);
        assert_ne!(hash_of(&|scene| scene.palette = Some(builtin::COPPER.clone())), plain);
        assert!(!Frames { hash: plain, ..Frames::EXPECTED }.passed());
    }
}
