//! The kernel, palette, texture mapping and effects in use, and the keys that change them.

use mode13h::palette::{Palette, builtin};
use mode13h::plan::{self, Effect};
use mode13h::render::{Renderer, Screen, Stats};
use mode13h::scene::Scene;
use mode13h::settings::Mapping;
use mode13h::span::Kernel;

use super::choice::Choice;
use super::loader::Inputs;
use super::{Failure, Input, Key, Keys, Panel, Row, Show};
use crate::input;
use crate::options::Drawing;
use crate::output::counted;
use crate::toggles::Switch;
use crate::turntable::{Colors, Turntable};

pub(super) const KEYS: Keys = &[
    ("K, P, M", "Next kernel, palette, texture mapping"),
    ("L, O, T", "Switch lights, fog, textures off and on"),
    ("D", "Dither: ordered, blue noise, ps1, off"),
];

pub(super) struct Looks {
    kernels: Choice<Kernel>,
    palettes: Choice<(String, Colors)>,
    /// True if a key chose one.
    chose_palette: bool,
    /// `None` leaves it to the scene, or else to the plan.
    mappings: Choice<Option<Mapping>>,
    /// The effects that keys switched, and to what.
    switches: Vec<(Switch, &'static str)>,
}

impl Looks {
    pub(super) fn new(Inputs { drawing, .. }: &Inputs, kernel: Kernel) -> Looks {
        Looks {
            kernels: Choice::new(Kernel::available(), kernel, |a, b| a.name() == b.name()),
            palettes: palettes(&Turntable::of_scene(Scene::new()), drawing),
            chose_palette: false,
            mappings: Choice::new([None].into_iter().chain(Mapping::ALL.map(Some)), drawing.mapping(), |a, b| a == b),
            switches: Vec::new(),
        }
    }

    fn mapping(&self, scene: &Scene) -> String {
        match (self.mappings.chosen(), scene.settings.mapping) {
            (Some(mapping), _) => mapping.to_string(),
            (None, Some(mapping)) => format!("of the scene, {mapping}"),
            (None, None) => String::from("by plan"),
        }
    }

    /// Turns effects off or on until they are in the states that keys have set.
    fn switch_again(&self, show: &mut Show) -> Result<(), Failure> {
        let (stage, renderer) = (&mut show.stage, &mut show.halves[0].renderer);
        for &(switch, wanted) in &self.switches {
            for _ in 0..Switch::MAX_STATES {
                renderer.make_plan(&stage.scene, Screen::MODE_13H)?;
                if switch.state(renderer) == wanted {
                    break;
                }
                switch.turn(stage, renderer)?;
            }
        }
        Ok(())
    }
}

impl Panel for Looks {
    fn follow(&mut self, input: &Input, show: &mut Show) -> Result<(), Failure> {
        if input.pressed(Key::K) {
            self.kernels.go_round();
            show.set_renderers(|renderer| renderer.kernel = *self.kernels.chosen());
            show.say(format!("kernel {}", self.kernels.chosen()));
        }
        if input.pressed(Key::P) {
            self.palettes.go_round();
            self.chose_palette = true;
            show.stage.set_colors(&self.palettes.chosen().1)?;
            show.say(format!("palette {}", self.palettes.chosen().0));
        }
        if input.pressed(Key::M) {
            self.mappings.go_round();
            show.set_renderers(|renderer| renderer.settings.mapping = *self.mappings.chosen());
            show.say(format!("mapping {}", self.mapping(&show.stage.scene)));
        }
        for (key, switch) in Switch::KEYS {
            if input.pressed(key) {
                let (stage, left) = (&mut show.stage, &mut show.halves[0]);
                let was = switch.state(&left.renderer);
                switch.turn(stage, &mut left.renderer)?;
                left.renderer.make_plan(&stage.scene, Screen::MODE_13H)?;
                let is = switch.state(&left.renderer);
                left.forget_times();
                self.switches.retain(|(other, _)| *other != switch);
                self.switches.push((switch, is));
                show.say(switch.outcome(was, is));
                show.renew_right();
            }
        }
        Ok(())
    }

    fn renew(&mut self, show: &mut Show, keeps: bool) -> Result<(), Failure> {
        let before = std::mem::replace(&mut self.palettes, palettes(&show.stage, &show.inputs.drawing));
        if !keeps {
            (self.chose_palette, self.switches) = (false, Vec::new());
            show.set_renderers(|renderer| renderer.settings.mapping = *self.mappings.chosen());
        } else if self.chose_palette && self.palettes.choose(|(name, _)| *name == before.chosen().0) {
            show.stage.set_colors(&self.palettes.chosen().1)?;
        }
        self.switch_again(show)
    }

    fn figures(&self, show: &Show) -> Vec<Row> {
        let left = &show.halves[0];
        let mut rows = vec![Row::new("plan", format!("{:.1} µs", left.planning.frame * 1e6))];
        if let Some(Stats { hidden_surfaces, vertices, drawn, raster, shares, .. }) = &left.stats {
            for (place, (shading, triangles)) in shares.into_iter().enumerate() {
                rows.push(Row::new(if place == 0 { "shadings" } else { "" }, format!("{shading} {triangles}")));
            }
            let vertices = counted(*vertices, "vertex").replace("vertexs", "vertices");
            rows.push(Row::new("hidden", format!("{hidden_surfaces}")));
            rows.push(Row::new(
                "drawn",
                format!("{drawn} of {}, {vertices}", counted(show.triangles() as u64, "triangle")),
            ));
            let (spans, pixels) = (counted(raster.spans.into(), "span"), counted(raster.pixels.into(), "pixel"));
            rows.push(Row::new("", format!("{spans}, {pixels}")));
        }
        rows.push(Row::new("kernel", self.kernels.chosen().to_string()));
        rows.push(Row::new("palette", &self.palettes.chosen().0));
        rows.push(Row::new("mapping", self.mapping(&show.stage.scene)));
        let on = effects_on(&left.renderer);
        rows.push(Row::new("effects", format!("{} of {} on:", on.len(), Effect::COUNT)));
        rows.push(Row::new("", on.join(", ")));
        rows
    }
}

/// The effects that are on, each with its choice unless the rows above give it, and with the number of objects if not
/// all.
fn effects_on(renderer: &Renderer) -> Vec<String> {
    let objects = renderer.plan().objects();
    let entry = |effect: Effect| {
        let on: Vec<_> = objects.iter().map(|plan| &plan[effect]).filter(|decision| decision.on).collect();
        let mut entry = effect.name().to_string();
        let is_said = matches!(effect, Effect::HiddenSurfaces | Effect::Gouraud | Effect::Phong);
        let first = on.first()?;
        if !is_said && first.choice != plan::Choice::Only {
            entry += &format!(" {}", first.choice.name());
        }
        if on.len() < objects.len() {
            entry += &format!(" {}/{}", on.len(), objects.len());
        }
        Some(entry)
    };
    Effect::ALL.into_iter().filter_map(entry).collect()
}

/// The palettes that P steps through, with the stage's chosen.
fn palettes(stage: &Turntable, drawing: &Drawing) -> Choice<(String, Colors)> {
    // A palette without ramps has no order of shades, so a stage without colours of its own is shown in one only on
    // request.
    let has_colors = stage.has_colors();
    let builtin = builtin::ALL.iter().filter(|builtin| has_colors || builtin.palette.ramps() > 0);
    let named = builtin.map(|builtin| (builtin.name.to_string(), Colors::from(builtin.palette.clone())));
    let palettes = named.chain([(input::AUTO.to_string(), Colors::Auto)]);
    // A scene without a palette leaves the DAC alone.
    let colors = stage.colors.clone().unwrap_or(Palette::default().into());
    // The palette is listed under its own name, if it has one, so that it is not listed twice.
    let usual = match &colors {
        Colors::Auto => input::AUTO,
        Colors::Palette(palette) => {
            let same = builtin::ALL.iter().find(|builtin| builtin.palette.colors() == palette.colors());
            same.map_or("the scene's", |builtin| builtin.name)
        }
    };
    let palette = (drawing.palette_name().unwrap_or(usual.to_string()), colors);
    Choice::new(palettes, palette, |(a, _), (b, _)| a == b)
}
