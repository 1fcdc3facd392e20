//! Effects that a key switches off and on, on the window's own copy of the scene.

use mode13h::glam::Vec3;
use mode13h::light::Light;
use mode13h::palette::{Palette, Rgb};
use mode13h::plan::Effect;
use mode13h::render::Renderer;
use mode13h::scene::{Fog, Object, Scene, Shared};
use mode13h::texture::Texture;
use mode13h::window::Key;

/// What a key switches.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Switch {
    Lights,
    Fog,
    Texture,
    Dither,
}

impl Switch {
    pub(crate) const KEYS: [(Key, Switch); 4] =
        [(Key::L, Switch::Lights), (Key::O, Switch::Fog), (Key::T, Switch::Texture), (Key::D, Switch::Dither)];

    fn effects(self) -> &'static [Effect] {
        match self {
            Switch::Lights => &[Effect::Lighting],
            Switch::Fog => &[Effect::Fog],
            Switch::Texture => &[Effect::Texture, Effect::EnvironmentMap],
            Switch::Dither => &[Effect::Dither],
        }
    }

    /// Whether the last frame had it anywhere.
    pub(crate) fn is_on(self, renderer: &Renderer) -> bool {
        self.effects().iter().any(|effect| renderer.plan().is_on_anywhere(*effect))
    }

    /// What became of it, in words.
    pub(crate) fn outcome(self, was_on: bool, is_on: bool) -> String {
        let name = match self {
            Switch::Lights => "lights",
            Switch::Fog => "fog",
            Switch::Texture => "texture",
            Switch::Dither => "dither",
        };
        match (was_on, is_on) {
            (false, false) => format!("no {name} here"),
            (_, true) => format!("{name} on"),
            (true, false) => format!("{name} off"),
        }
    }

    /// Switches by force off what was on in the frame before; else leaves it to the plan, which has it on if the scene
    /// calls for it, and sees to it that the scene does.
    pub(crate) fn turn(self, scene: &mut Scene, renderer: &mut Renderer) {
        let was_on = self.is_on(renderer);
        for effect in self.effects() {
            renderer.force(*effect, was_on.then_some(false));
        }
        if !was_on {
            match self {
                Switch::Lights => light(scene),
                Switch::Fog => fog(scene),
                Switch::Texture => texture(scene),
                Switch::Dither => {}
            }
        }
        if self == Switch::Dither {
            scene.wishes.dither = !was_on;
        }
    }
}

/// A scene in the dark gets a sun.
fn light(scene: &mut Scene) {
    if scene.lights().iter().all(|light| light.intensity() == 0.0) {
        scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    }
}

/// A scene with no fog, or none that anything reaches into, gets some, in the colour of its background: from where the
/// nearest object begins to a little beyond where the farthest ends.
fn fog(scene: &mut Scene) {
    let ends = scene.objects().iter().map(|object| depths(scene, object));
    let (nearest, farthest) = ends.fold((f32::MAX, 0.0_f32), |(near, far), (a, b)| (near.min(a), far.max(b)));
    let is_reached = scene.fog.is_some_and(|fog| fog.start < farthest);
    if is_reached || nearest >= farthest {
        return;
    }
    let color = |palette: &Palette| palette.colors()[usize::from(scene.background)];
    let color = scene.background_color.or(scene.palette.as_ref().map(color)).unwrap_or(Rgb::BLACK);
    scene.fog = Some(Fog { color, start: nearest, end: farthest + 0.2 * (farthest - nearest) });
}

/// Where an object begins and ends along the view, in the scene's units: the ball about it. Nothing is seen behind the
/// near plane.
fn depths(scene: &Scene, object: &Object) -> (f32, f32) {
    let bounds = object.mesh().bounds();
    let centre: Vec3 = object.position + object.rotation() * (bounds.centre - object.pivot) * object.scale;
    let camera = &scene.camera;
    let along = (camera.target - camera.eye).normalize_or_zero();
    let (middle, radius) = ((centre - camera.eye).dot(along), bounds.radius * object.scale);
    ((middle - radius).max(camera.near), middle + radius)
}

/// A scene without images gets a chequered one on every surface: by the mesh's texture coordinates, or else as what the
/// surface mirrors.
fn texture(scene: &mut Scene) {
    let mut materials = scene.objects().iter().flat_map(|object| &object.materials);
    if materials.any(|material| material.texture.is_some() || material.environment.is_some()) {
        return;
    }
    let Some(checker) = Texture::by_name("checker").map(Shared::new) else { return };
    for object in scene.objects_mut() {
        let has_coordinates = object.mesh().texcoords().is_some();
        for material in &mut object.materials {
            let place = if has_coordinates { &mut material.texture } else { &mut material.environment };
            *place = Some(Shared::clone(&checker));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mode13h::mesh::shapes;
    use mode13h::scene::shipped;
    use mode13h::vga::Vga;

    fn all_scenes() -> Vec<(&'static str, Scene)> {
        let shipped = shipped::ALL.iter().map(|shipped| (shipped.name, shipped.load().expect("it is shipped").scene));
        let mut dark = Scene::showing(shapes::torus(24, 12));
        dark.lights_mut().clear();
        let mut far_fog = Scene::showing(shapes::cube());
        far_fog.fog = Some(Fog { color: Rgb::WHITE, start: 100.0, end: 200.0 });
        shipped.chain([("dark", dark), ("far fog", far_fog)]).collect()
    }

    /// Each switch turns its effect on or off in every scene, and back; and where it does, the picture changes.
    #[test]
    fn every_switch_turns_its_effect_and_back_in_every_scene() {
        let mut failures = Vec::new();
        for (name, scene) in all_scenes() {
            for (_, switch) in Switch::KEYS {
                let mut scene = scene.clone();
                // The flash's lamp comes by.
                scene.set_time(0.3 * scene.duration);
                let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
                let mut draw = |scene: &Scene, renderer: &mut Renderer| {
                    renderer.draw(scene, &mut vga).expect("a legal scene");
                    let on = switch.effects().iter().any(|effect| renderer.plan().is_on_anywhere(*effect));
                    (on, vga.pixels().to_vec())
                };
                let (at_first, picture) = draw(&scene, &mut renderer);
                let mut was = (at_first, picture.clone());
                for turn in 0..4 {
                    switch.turn(&mut scene, &mut renderer);
                    let is = draw(&scene, &mut renderer);
                    if (name, switch) == ("phong-table", Switch::Dither) {
                        // A table of whole shades: there is nothing to dither.
                        assert!(is == was);
                        continue;
                    }
                    if is.0 == was.0 || is.1 == was.1 {
                        failures.push(format!("{name}: {switch:?}, turned {} times, is still {}", turn + 1, is.0));
                    }
                    was = is;
                }
                if was != (at_first, picture) {
                    failures.push(format!("{name}: {switch:?} does not lead back"));
                }
            }
        }
        assert!(failures.is_empty(), "{failures:#?}");
    }
}
