//! Effects that a key switches off and on, on the window's own copy of the scene.

use mode13h::glam::Vec3;
use mode13h::light::Light;
use mode13h::palette::{Palette, Rgb};
use mode13h::plan::{Choice, Decision, Effect, Plan};
use mode13h::render::{RenderError, Renderer};
use mode13h::scene::{Fog, Object, Scene};
use mode13h::settings::DitherPattern;
use mode13h::window::Key;

use crate::turntable::Turntable;

/// The state of an effect that is not drawn.
const OFF: &str = "off";

/// Switches of the keys.
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

    /// The maximum number of states of a switch: dither is off, or in one of the patterns.
    pub(crate) const MAX_STATES: usize = 1 + DitherPattern::ALL.len();

    fn effects(self) -> &'static [Effect] {
        match self {
            Switch::Lights => &[Effect::Lighting],
            Switch::Fog => &[Effect::Fog],
            Switch::Texture => &[Effect::Texture, Effect::EnvironmentMap],
            Switch::Dither => &[Effect::Dither],
        }
    }

    /// State in the last frame: "off", "on", or for dither the pattern's name.
    pub(crate) fn state(self, renderer: &Renderer) -> &'static str {
        let plan = renderer.plan();
        let pattern = (self == Switch::Dither).then(|| dither(plan)).flatten();
        match (pattern, self.effects().iter().any(|effect| plan.is_on_anywhere(*effect))) {
            (_, false) => OFF,
            (Some(pattern), true) => pattern.name(),
            (None, true) => "on",
        }
    }

    /// Outcome of switching it, in words.
    pub(crate) fn outcome(self, was: &str, is: &str) -> String {
        let name = match self {
            Switch::Lights => "lights",
            Switch::Fog => "fog",
            Switch::Texture => "texture",
            Switch::Dither => "dither",
        };
        if (was, is) == (OFF, OFF) { format!("no {name} here") } else { format!("{name} {is}") }
    }

    /// Switches an effect off if it was on in the last frame: images by removing them, the rest by force. Otherwise
    /// makes the scene need it, so that the plan switches it on. Dither goes through its patterns before it is off.
    pub(crate) fn turn(self, stage: &mut Turntable, renderer: &mut Renderer) -> Result<(), RenderError> {
        let was_on = self.state(renderer) != OFF;
        if self == Switch::Dither {
            let shown = dither(renderer.plan());
            let next = DitherPattern::ALL.into_iter().find(|pattern| shown.is_none_or(|shown| *pattern > shown));
            (stage.scene.settings.dither, stage.dither) = (next, Some(next));
            renderer.force(Effect::Dither, next.is_none().then_some(false));
            return Ok(());
        }
        if self == Switch::Texture {
            return stage.set_images(!was_on);
        }
        for effect in self.effects() {
            renderer.force(*effect, was_on.then_some(false));
        }
        match self {
            Switch::Lights if !was_on => light(&mut stage.scene),
            Switch::Fog if !was_on => fog(&mut stage.scene),
            _ => {}
        }
        Ok(())
    }
}

/// The pattern in which a frame is dithered.
fn dither(plan: &Plan) -> Option<DitherPattern> {
    plan.objects().iter().find_map(|object| match object[Effect::Dither] {
        Decision { on: true, choice: Choice::Dither(pattern), .. } => Some(pattern),
        _ => None,
    })
}

/// Gives a scene in the dark a sun.
fn light(scene: &mut Scene) {
    if scene.lights().iter().all(|light| light.intensity() == 0.0) {
        scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    }
}

/// Gives fog to a scene that has none, or none that anything reaches into. It has the colour of the background, and
/// extends from where the nearest object begins to a little beyond where the farthest ends.
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

/// Depths at which an object's bounding sphere begins and ends along the view, in the scene's units. Nothing nearer
/// than the near plane is seen.
fn depths(scene: &Scene, object: &Object) -> (f32, f32) {
    let bounds = object.mesh().bounds();
    let centre: Vec3 = object.position + object.rotation() * (bounds.centre - object.pivot) * object.scale;
    let camera = &scene.camera;
    let along = (camera.target - camera.eye).normalize_or_zero();
    let (middle, radius) = ((centre - camera.eye).dot(along), bounds.radius * object.scale);
    ((middle - radius).max(camera.near), middle + radius)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::turntable::Colors;
    use crate::turntable::Pose;
    use mode13h::mesh::shapes;
    use mode13h::palette::builtin;
    use mode13h::render::Screen;
    use mode13h::texture::Texture;
    use mode13h::vga::Vga;
    use mode13h_assets::model::with_textures;
    use mode13h_assets::shipped;

    fn all_scenes() -> Vec<(&'static str, Scene)> {
        let shipped = shipped::ALL.iter().map(|shipped| (shipped.name, shipped.load().expect("it is shipped").scene));
        let mut dark = Scene::showing(shapes::torus(24, 12));
        dark.clear_lights();
        let mut far_fog = Scene::showing(shapes::cube());
        far_fog.fog = Some(Fog { color: Rgb::WHITE, start: 100.0, end: 200.0 });
        shipped.chain([("dark", dark), ("far fog", far_fog)]).collect()
    }

    /// Each switch turns its effect off or on and back again in every scene; where it has an effect, the picture
    /// changes.
    #[test]
    fn every_switch_turns_its_effect_and_back_in_every_scene() {
        let mut failures = Vec::new();
        for (name, scene) in all_scenes() {
            for (_, switch) in Switch::KEYS {
                let mut stage = Turntable::of_scene(scene.clone());
                // A moment at which the lamp of `flash` passes.
                stage.show(0.3 * scene.duration, Pose::FIRST);
                let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
                let mut draw = |scene: &Scene, renderer: &mut Renderer| {
                    renderer.draw(scene, &mut vga).expect("a legal scene");
                    (switch.state(renderer), vga.pixels().to_vec())
                };
                let (at_first, picture) = draw(&stage.scene, &mut renderer);
                let mut was = (at_first, picture.clone());
                // Through all states twice.
                for turn in 0..2 * if switch == Switch::Dither { Switch::MAX_STATES } else { 2 } {
                    switch.turn(&mut stage, &mut renderer).expect("a legal scene");
                    let is = draw(&stage.scene, &mut renderer);
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

    /// Other keys leave dither as it was chosen.
    #[test]
    fn dither_outlasts_a_change_of_palette_and_of_images() {
        let mut stage = Turntable::of_scene(Scene::showing(shapes::torus(24, 12)));
        let mut renderer = Renderer::new();
        for turn in 0..2 * Switch::MAX_STATES {
            Switch::Dither.turn(&mut stage, &mut renderer).expect("a legal scene");
            let mut state = |stage: &Turntable| {
                renderer.make_plan(&stage.scene, Screen::MODE_13H).expect("a legal scene");
                Switch::Dither.state(&renderer)
            };
            let chosen = state(&stage);
            stage.set_colors(&builtin::GREY.clone().into()).expect("a legal scene");
            stage.set_images(turn % 2 == 0).expect("a legal scene");
            assert_eq!(state(&stage), chosen);
        }
    }

    /// Tests that a model whose image T has removed shows shades in order, not the palette's entries one after the
    /// other, in a palette made for what is seen and in one without ramps.
    #[test]
    fn a_model_without_its_image_is_shaded_in_order() {
        let texture = "crate".parse::<Texture>().ok().map(mode13h::scene::Shared::new);
        let cube = builtin::by_name("cube").expect("built in").palette.clone();
        for colors in [Colors::Auto, cube.into()] {
            let mut stage =
                Turntable::of_model(with_textures(shapes::cube().into(), std::slice::from_ref(&texture)), None, None)
                    .expect("a model");
            stage.set_colors(&colors).expect("a legal scene");
            stage.scene.settings.dither = None;
            let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
            let mut draw = |stage: &Turntable, renderer: &mut Renderer| {
                renderer.draw(&stage.scene, &mut vga).expect("a legal scene");
                let palette = vga.palette();
                vga.pixels().iter().map(|&pixel| palette[pixel]).collect::<Vec<Rgb>>()
            };
            let with = draw(&stage, &mut renderer);
            Switch::Texture.turn(&mut stage, &mut renderer).expect("a legal scene");
            stage.scene.settings.dither = None;
            let without = draw(&stage, &mut renderer);
            // White in white light: greys, or the entries nearest to them.
            let is_grey = |color: Rgb| color.r.abs_diff(color.g).max(color.g.abs_diff(color.b)) < 24;
            assert!(without.iter().all(|color| is_grey(*color)), "{colors:?}");
            assert!(without != with && without.iter().any(|color| color.brightness() > 100_000), "{colors:?}");
            Switch::Texture.turn(&mut stage, &mut renderer).expect("a legal scene");
            stage.scene.settings.dither = None;
            assert!(draw(&stage, &mut renderer) == with, "{colors:?}: the image comes back");
        }
    }
}
