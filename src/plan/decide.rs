//! The rules: for each effect, a function that decides whether an object calls for it, with the reason.

use super::hidden;
use super::reason::Reason;
use super::stages::{Choice, Dither, Lamps, Lighting, LitAt, Stages, Switches, VertexStage};
use super::{Decision, Effect, ObjectPlan, Overrides, Plan};
use crate::light::{LampBeam, Light, Material, lamp_reaches};
use crate::raster::Rect;
use crate::scene::{Object, Scene};
use crate::settings::{DitherPattern, HiddenSurfaces, Mapping, Settings, Shading};
use crate::view::{ObjectView, ScreenBounds};

/// The largest error of affine mapping that is tolerated, in texels.
const AFFINE_TOLERANCE: f64 = 0.5;

/// An object with more texels per pixel than this, seen head on, gets mipmaps. Level 0 is used up to √2
/// texels per pixel, and this is half of that, because a face tilted by 60° has twice as many.
const MIN_TEXELS: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// The inputs to the decisions.
pub(crate) struct Inputs<'a> {
    pub(crate) scene: &'a Scene,
    /// One view for each object.
    pub(crate) views: &'a [ObjectView],
    /// For each object, how it changed since the last frame.
    pub(crate) change: &'a [Change],
    pub(crate) forced: &'a Overrides,
    /// The merged settings of the renderer and the scene.
    pub(crate) settings: &'a Settings,
    /// Whether the frame covers the whole screen.
    pub(crate) whole: bool,
    /// Whether objects may cache their vertices.
    pub(crate) keeps: bool,
}

/// How an object changed since the last frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Change {
    New,
    Changed,
    Unchanged,
}

/// The least near / w at which a 30-bit depth still has ten significant bits.
const LEAST_DEPTH: f64 = 1.0 / 1_048_576.0;

/// Plans a frame, in place.
#[inline(never)]
pub(crate) fn decide<'a>(inputs: &Inputs<'_>, lamps: impl Fn(usize) -> &'a [LampBeam], plan: &mut Plan) {
    let accuracy = inputs.settings.drawn_accuracy();
    let (shading, max_error) = (accuracy.shading(), accuracy.max_error());
    let is_integer = inputs.settings.is_integer();
    let asked = (inputs.settings.hidden_surfaces, is_integer);
    let (way, reason) = hidden::choose(inputs.scene, inputs.views, asked, &mut plan.order);
    plan.is_integer = is_integer;
    plan.hidden_surfaces = way;
    plan.chosen = reason != Reason::Asked;
    plan.objects.clear();
    plan.seen = Rect::NOWHERE;
    let mut farthest = 0.0_f64;
    for (index, object) in inputs.scene.objects().iter().enumerate() {
        if !inputs.scene.is_visible(index) {
            plan.objects.push(ObjectPlan::new(shading));
            continue;
        }
        let view = &inputs.views[index];
        let is_unbounded = max_error.is_some() && has_custom_response(object);
        let reach = view.reach(object.mesh().bounds());
        let rules = Rules {
            inputs,
            scene: inputs.scene,
            index,
            object,
            view,
            reach,
            // The vintage method draws beyond a triangle's edges, and 16.16 clips differently.
            is_out_of_sight: !is_integer && shading != Shading::GouraudVintage && reach.is_out_of_sight(view.near),
            change: inputs.change.get(index).copied().unwrap_or(Change::New),
            lamps_in_range: lamps(index).iter().filter(|lamp| lamp_reaches(lamp, object.mesh().bounds())).count(),
            is_integer,
            max_error: max_error.filter(|_| !is_unbounded),
            shading: if is_unbounded { Shading::Phong } else { shading },
            why: if is_unbounded { Reason::OwnResponse } else { Reason::Asked },
            way: (way, reason),
        };
        farthest = farthest.max(rules.reach.farthest);
        // Built in place, because it is large.
        plan.objects.push(ObjectPlan::new(rules.shading));
        if let Some(object) = plan.objects.last_mut() {
            rules.all(object);
            if !object.stages.is_out_of_sight {
                // Vertices kept by force may be anywhere.
                let is_elsewhere = rules.change == Change::Changed && object.stages.vertices == VertexStage::Keep;
                plan.seen = plan.seen.hull(if is_elsewhere { Rect::EVERYWHERE } else { rules.reach.seen });
            }
        }
    }
    let Plan { order, objects, .. } = plan;
    order.retain(|index| !objects[*index].stages.is_out_of_sight);
    // Below infinity, where no near distance would do.
    let needed = ((farthest * LEAST_DEPTH) as f32).min(f32::MAX);
    plan.near_needed = (inputs.scene.camera.near < needed).then_some(needed);
    if shading == Shading::GouraudVintage || is_integer {
        plan.seen = Rect::EVERYWHERE;
    }
}

/// The light's intensity, or that of its strongest channel.
fn strength(light: &Light) -> f32 {
    let color = light.color().into_iter().map(f32::abs).fold(1.0, f32::max);
    light.intensity().abs() * color
}

/// Returns whether any of its materials has a custom response to light, whose error has no known
/// bound.
pub(crate) fn has_custom_response(object: &Object) -> bool {
    object.materials.iter().any(|material| material.response.is_some())
}

/// Returns whether the 16.16 path supports this effect.
const fn in_integers(effect: Effect) -> bool {
    matches!(
        effect,
        Effect::Transform
            | Effect::NearClipping
            | Effect::ScreenClipping
            | Effect::BackFaceCulling
            | Effect::HiddenSurfaces
            | Effect::Lighting
            | Effect::Gouraud
            | Effect::PaletteAnimation
    )
}

/// One object, and the facts that the rules use.
struct Rules<'a> {
    inputs: &'a Inputs<'a>,
    scene: &'a Scene,
    index: usize,
    object: &'a Object,
    view: &'a ObjectView,
    reach: ScreenBounds,
    is_out_of_sight: bool,
    change: Change,
    lamps_in_range: usize,
    /// Whether vertices are transformed in 16.16.
    is_integer: bool,
    /// The error budget, if there is one for the object.
    max_error: Option<f32>,
    /// The shading to draw with: the requested one, or on the 16.16 path one that it supports, or
    /// with a budget the default. An object without an error bound gets per-pixel lighting instead
    /// of a budget.
    shading: Shading,
    /// The reason for a shading that lights pixels.
    why: Reason,
    way: (HiddenSurfaces, Reason),
}

impl Rules<'_> {
    /// Decides on all effects of a new plan.
    fn all(&self, plan: &mut ObjectPlan) {
        let mut overridden = [false; Effect::COUNT];
        for effect in Effect::ALL {
            let mut decision = self.decision(effect, plan);
            if effect.is_left_out() {
                decision = Decision::off(Reason::LeftOut);
            } else if self.is_integer && !in_integers(effect) {
                decision = Decision::off(Reason::NotInIntegers);
            } else if let Some(on) = self.inputs.forced.get(Some(self.scene.object_ids()[self.index]), effect)
                && on != decision.on
                && !(decision.on && effect.keeps_inside())
            {
                decision = Decision { on, reason: Reason::Overrides, choice: forced_choice(on, decision.choice) };
                overridden[effect as usize] = true;
            }
            plan.decisions[effect as usize] = decision;
        }
        if let Some(max_error) = self.max_error {
            self.keep_within(max_error, plan);
        }
        plan.stages = self.stages(plan, |effect| plan.is_on(effect) && overridden[effect as usize]);
    }

    /// The stages of the object, from its decisions. `forced`: whether an effect is on only because
    /// it was overridden.
    fn stages(&self, plan: &ObjectPlan, forced: impl Fn(Effect) -> bool) -> Stages {
        let is_on = |effect| plan.is_on(effect);
        let channels = is_on(Effect::RgbChannels);
        Stages {
            switches: Switches::of(is_on),
            is_out_of_sight: self.is_out_of_sight && !forced(Effect::Transform),
            vertices: match is_on(Effect::Transform) {
                false => VertexStage::Keep,
                true if forced(Effect::Transform) || !self.inputs.keeps => VertexStage::RecomputeAll,
                true => VertexStage::Make,
            },
            lighting: match is_on(Effect::Lighting) {
                _ if channels => Lighting::Channels,
                false => Lighting::None,
                true if is_on(Effect::PositionalLights) || is_on(Effect::Specular) => Lighting::All,
                true => Lighting::Suns,
            },
            lit_at: if plan.shading == Shading::Flat && is_on(Effect::Lighting) {
                LitAt::Faces
            } else if is_on(Effect::Phong) && plan.max_error.is_none() {
                LitAt::Pixels
            } else {
                LitAt::Vertices
            },
            lamps: match is_on(Effect::PositionalLights) {
                false => Lamps::None,
                true if forced(Effect::PositionalLights) => Lamps::All,
                true => Lamps::InRange,
            },
            mapping: mapping(plan),
            dither: match plan[Effect::Dither] {
                Decision { on: false, .. } => Dither::None,
                Decision { choice: Choice::Dither(pattern), .. } => Dither::By(pattern),
                _ => Dither::Neutral,
            },
            neutral_image: forced(Effect::Texture) || forced(Effect::EnvironmentMap),
            neutral_blend: forced(Effect::Transparency),
        }
    }

    /// Leaves the shading of faces to a budget, unless one shading is known to suffice for all of them.
    fn keep_within(&self, max_error: f32, plan: &mut ObjectPlan) {
        if !plan.is_on(Effect::Lighting) {
            return;
        }
        if self.is_lit_by_face(plan) {
            plan.shading = Shading::Flat;
        } else {
            plan.max_error = Some(max_error);
        }
    }

    /// Returns whether per-pixel lighting would give each face a single shade, that of its own
    /// normal.
    fn is_lit_by_face(&self, before: &ObjectPlan) -> bool {
        // Shades of normals 10⁻⁵ apart then differ by at most a hundredth.
        let strength = self.scene.lights().iter().map(strength).sum::<f32>();
        let reflects = |material: &Material| (material.diffuse * strength).abs() <= 4.0;
        self.object.mesh().facts.is_faceted
            && self.object.materials.iter().all(reflects)
            && !before.is_on(Effect::PositionalLights)
            && !before.is_on(Effect::Specular)
    }

    /// Decides on an effect. `before`: the decisions so far, in the order of [`Effect::ALL`].
    fn decision(&self, effect: Effect, before: &ObjectPlan) -> Decision {
        match effect {
            Effect::Transform => self.transform(),
            Effect::NearClipping => self.near_clipping(),
            Effect::ScreenClipping => self.screen_clipping(before),
            Effect::BackFaceCulling => self.back_face_culling(),
            Effect::HiddenSurfaces => self.hidden_surfaces(),
            Effect::Lighting => self.lighting(),
            Effect::PositionalLights => self.positional_lights(before),
            Effect::Specular => self.specular(before),
            Effect::Gouraud => self.gouraud(before),
            Effect::Fog => self.fog(),
            Effect::Phong => self.phong(before),
            Effect::Tessellation => self.tessellation(before),
            Effect::RgbChannels => self.rgb_channels(),
            Effect::Texture => self.material_has(|material| material.texture.is_some()),
            Effect::EnvironmentMap => {
                self.material_has(|material| material.environment.is_some() && material.texture.is_none())
            }
            Effect::Perspective => self.perspective(),
            Effect::Mipmaps => self.mipmaps(before),
            Effect::Transparency => self.material_has(|material| material.blend != crate::light::Blend::Opaque),
            Effect::Dither => self.dither(before),
            Effect::PaletteAnimation => match self.scene.palette_animation {
                Some(_) => Decision::on(Reason::Asked),
                None => Decision::off(Reason::SceneHasNone),
            },
        }
    }

    fn transform(&self) -> Decision {
        match self.change {
            _ if self.is_integer => Decision::on(Reason::NotKept),
            // Wherever it is, so that no later frame allocates memory for it.
            Change::New => Decision::on(Reason::FirstFrame),
            _ if self.is_out_of_sight => Decision::off(Reason::OutOfSight),
            Change::Changed => Decision::on(Reason::Changed),
            Change::Unchanged if self.inputs.keeps => Decision::off(Reason::Unchanged),
            Change::Unchanged => Decision::on(Reason::NotKept),
        }
    }

    fn near_clipping(&self) -> Decision {
        let reason = Reason::Nearest { nearest: self.reach.nearest, near: f64::from(self.view.near) };
        if self.reach.crosses_near { Decision::on(reason) } else { Decision::off(reason) }
    }

    fn screen_clipping(&self, before: &ObjectPlan) -> Decision {
        if before.is_on(Effect::NearClipping) {
            Decision::on(Reason::CrossesNear)
        } else if self.reach.leaves_screen {
            Decision::on(Reason::LeavesScreen)
        } else if !self.inputs.whole {
            Decision::on(Reason::Band)
        } else {
            Decision::off(Reason::OnScreen)
        }
    }

    fn back_face_culling(&self) -> Decision {
        if hidden::is_transparent(self.object, self.is_integer) {
            Decision::off(Reason::SeenThrough)
        } else if self.object.mesh().is_outward() {
            Decision::on(Reason::Closed)
        } else if self.object.mesh().is_closed() {
            Decision::off(Reason::InsideOut)
        } else {
            Decision::off(Reason::Open)
        }
    }

    fn hidden_surfaces(&self) -> Decision {
        let (way, reason) = self.way;
        Decision { on: way != HiddenSurfaces::BackFaces, choice: Choice::HiddenSurfaces(way), reason }
    }

    fn lighting(&self) -> Decision {
        let bright = || self.scene.lights().iter().filter(|light| light.intensity() != 0.0);
        let count = bright().count();
        if count == 0 {
            Decision::off(Reason::NoLight)
        } else if self.object.materials.iter().all(|m| m.diffuse == 0.0 && !m.is_specular()) {
            Decision::off(Reason::NoResponse)
        } else if self.lamps_in_range == 0 && bright().all(|light| matches!(light, Light::Lamp { .. })) {
            Decision::off(Reason::LampsOutOfRange { count })
        } else {
            Decision::on(Reason::Lights { count })
        }
    }

    fn positional_lights(&self, before: &ObjectPlan) -> Decision {
        let count = self.scene.lights().iter().filter(|light| matches!(light, Light::Lamp { .. })).count();
        match (count, self.lamps_in_range) {
            (0, _) => Decision::off(Reason::NoLamp),
            (_, 0) => Decision::off(Reason::LampsOutOfRange { count }),
            _ if !before.is_on(Effect::Lighting) => Decision::off(before[Effect::Lighting].reason),
            (_, count) => Decision::on(Reason::LampsInRange { count }),
        }
    }

    fn specular(&self, before: &ObjectPlan) -> Decision {
        let decision = self.material_has(Material::is_specular);
        match self.object.materials.iter().position(|material| material.specular != 0.0) {
            _ if decision.on && !before.is_on(Effect::Lighting) => Decision::off(before[Effect::Lighting].reason),
            Some(material) if !decision.on => Decision::off(Reason::NoShininess { material }),
            _ => decision,
        }
    }

    fn gouraud(&self, before: &ObjectPlan) -> Decision {
        match (self.max_error, self.shading) {
            _ if !before.is_on(Effect::Lighting) => Decision::off(Reason::OneShade),
            (Some(_), _) if self.is_lit_by_face(before) => Decision::off(Reason::Faceted),
            (Some(max_error), _) => Decision::on(Reason::Budget { max_error }).choosing(Choice::Budget),
            (None, Shading::Flat) => Decision::off(Reason::FlatAsked),
            (None, shading) if shading.lights_pixels() => Decision::off(self.why).choosing(Choice::Shading(shading)),
            (None, shading) => Decision::on(Reason::ShadesDiffer).choosing(Choice::Shading(shading)),
        }
    }

    fn fog(&self) -> Decision {
        let Some(fog) = &self.scene.fog else { return Decision::off(Reason::SceneHasNone) };
        let (farthest, start) = (self.reach.farthest, f64::from(fog.start));
        if farthest > start {
            Decision::on(Reason::ReachesInto { farthest, start })
        } else {
            Decision::off(Reason::NearerThan { farthest, start })
        }
    }

    fn phong(&self, before: &ObjectPlan) -> Decision {
        match self.max_error {
            None if self.shading.lights_pixels() => Decision::on(self.why).choosing(Choice::Shading(self.shading)),
            None => Decision::off(Reason::NotAsked),
            _ if !before.is_on(Effect::Lighting) => Decision::off(before[Effect::Lighting].reason),
            _ if self.is_lit_by_face(before) => Decision::off(Reason::Faceted),
            Some(max_error) => Decision::on(Reason::Budget { max_error }).choosing(Choice::Shading(Shading::Phong)),
        }
    }

    fn tessellation(&self, before: &ObjectPlan) -> Decision {
        // Faces are only split to improve their shades.
        match self.max_error {
            _ if !before.is_on(Effect::Lighting) => Decision::off(before[Effect::Lighting].reason),
            Some(_) => Decision::off(Reason::LeftToBudget),
            None if self.inputs.settings.tessellates() => Decision::on(Reason::Asked),
            None => Decision::off(Reason::NotAsked),
        }
    }

    fn perspective(&self) -> Decision {
        if !self.object.materials.iter().any(|material| material.texture.is_some()) {
            return Decision::off(Reason::NoTexture);
        }
        let texels = self.affine_error();
        match self.inputs.settings.mapping {
            Some(Mapping::Affine) => Decision::off(Reason::Asked).choosing(Choice::Mapping(Mapping::Affine)),
            Some(mapping) => Decision::on(Reason::Asked).choosing(Choice::Mapping(mapping)),
            // Not a number if the edge is infinite.
            None if texels > AFFINE_TOLERANCE || texels.is_nan() => {
                Decision::on(Reason::AffineError { texels }).choosing(Choice::Mapping(Mapping::Perspective))
            }
            None => Decision::off(Reason::AffineError { texels }).choosing(Choice::Mapping(Mapping::Affine)),
        }
    }

    /// A bound on the error, in texels, of affine mapping over any triangle.
    ///
    /// Affine and perspective mapping weight the three corners differently: one by a, the other by
    /// a/w, normalised to a sum of 1. The weight given to the wrong corners is at most (√ρ − 1) /
    /// (√ρ + 1), where ρ is the greatest ratio of two w. (With weight m at the nearer end it is
    /// mρ/(mρ + 1 − m) − m, which is greatest at m = 1/(1 + √ρ).) No two corners' texels are
    /// farther apart than the longest edge in the texture, and between two vertices of a triangle w
    /// differs by at most the longest edge of the mesh.
    fn affine_error(&self) -> f64 {
        let nearest = self.reach.nearest.max(f64::from(self.view.near));
        let (edge, texture_edge) = self.object.mesh().facts.longest_edges;
        let size = self
            .object
            .materials
            .iter()
            .filter_map(|material| material.texture.as_ref())
            .fold(0, |size, t| size.max(1_u32 << t.width_bits()).max(1 << t.height_bits()));
        let ratio = 1.0 + f64::from(edge) * self.view.scale / nearest;
        let root = libm::sqrt(ratio);
        (root - 1.0) / (root + 1.0) * f64::from(texture_edge) * f64::from(size)
    }

    fn mipmaps(&self, before: &ObjectPlan) -> Decision {
        if !before.is_on(Effect::Texture) {
            return Decision::off(before[Effect::Texture].reason);
        }
        if !self.object.materials.iter().any(|material| material.texture.is_some()) {
            return Decision::off(Reason::NoImage);
        }
        let texels = texels_to_pixel(self.object, self.view, self.reach.farthest);
        let (on, reason) = match self.inputs.settings.mipmaps {
            Some(asked) => (asked, Reason::Asked),
            None => (texels > MIN_TEXELS, Reason::TexelsToPixel { texels }),
        };
        match (on, mapping(before)) {
            (true, Mapping::Affine) => Decision::on(reason).choosing(Choice::LevelPerFace),
            (true, _) => Decision::on(reason).choosing(Choice::LevelPer16Pixels),
            (false, _) => Decision::off(reason),
        }
    }

    fn rgb_channels(&self) -> Decision {
        if let Some(light) = self.scene.lights().iter().position(|light| light.is_colored() && light.intensity() != 0.0)
        {
            return Decision::on(Reason::ColoredLight { light });
        }
        if let Some(material) = self.object.materials.iter().position(Material::takes_channels) {
            return Decision::on(Reason::ColoredMaterial { material });
        }
        if self.inputs.settings.channels == Some(true) {
            return Decision::on(Reason::Asked);
        }
        if self.misses_ramp() { Decision::on(Reason::NoRamps) } else { Decision::off(Reason::NoColor) }
    }

    /// Returns whether a material without an image and without its own colour names a ramp, but the scene's palette has
    /// none.
    fn misses_ramp(&self) -> bool {
        let has_image = |material: &Material| material.texture.is_some() || material.environment.is_some();
        let is_plain = |material: &Material| !material.takes_channels() && !has_image(material);
        let palette = self.scene.palette.as_ref();
        self.object.materials.iter().any(|material| material.misses_ramp(palette) && is_plain(material))
    }

    fn dither(&self, before: &ObjectPlan) -> Decision {
        let Some(pattern) = self.inputs.settings.dither else {
            // Palettes without ramps rarely have many shades of one colour.
            if before.is_on(Effect::RgbChannels) && self.misses_ramp() {
                return Decision::on(Reason::NoRamps).choosing(Choice::Dither(DitherPattern::default()));
            }
            return Decision::off(Reason::NotAsked);
        };
        if before.is_on(Effect::Phong) && self.shading == Shading::PhongTable && !before.is_on(Effect::RgbChannels) {
            Decision::off(Reason::WholeShades)
        } else {
            Decision::on(Reason::Asked).choosing(Choice::Dither(pattern))
        }
    }

    fn material_has(&self, has: impl Fn(&Material) -> bool) -> Decision {
        match self.object.materials.iter().position(has) {
            Some(material) => Decision::on(Reason::MaterialHas { material }),
            None => Decision::off(Reason::NoMaterialHas),
        }
    }
}

/// The choice for an overridden effect. Where the plan would map textures affinely, forcing
/// perspective makes the mapping exact at every pixel.
fn forced_choice(on: bool, planned: Choice) -> Choice {
    match planned {
        _ if !on => Choice::Only,
        Choice::Mapping(Mapping::Affine) => Choice::Mapping(Mapping::Perspective),
        planned => planned,
    }
}

/// The mapping of texture coordinates.
fn mapping(plan: &ObjectPlan) -> Mapping {
    match plan[Effect::Perspective].choice {
        _ if !plan.is_on(Effect::Perspective) => Mapping::Affine,
        Choice::Mapping(mapping) => mapping,
        _ => Mapping::Perspective,
    }
}

/// The largest number of texels along a pixel's side, over all textures of an object, on a face parallel to the screen
/// and at most `farthest` away along the view: the texels of a texture's longer side, times the change in texture
/// coordinates per unit, times a pixel's longer side.
fn texels_to_pixel(object: &Object, view: &ObjectView, farthest: f64) -> f64 {
    let images = object.materials.iter().zip(&object.mesh().facts.steepest_texcoords);
    let steepest = images.filter_map(|(material, change)| {
        let texture = material.texture.as_ref()?;
        Some(change * f64::from(texture.width().max(texture.height())))
    });
    steepest.fold(0.0, f64::max) * view.longest_pixel(farthest.max(0.0))
}
