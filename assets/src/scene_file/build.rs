//! Builds a scene from a file's layout.

use std::path::Path as FilePath;

use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::{Cone, Light};
use mode13h::scene::framing::{Swept, Turning};
use mode13h::scene::{Fog, Motion, Moving, Object, PaletteAnimation, Scene, Shared};
use mode13h::settings::Accuracy;
use mode13h::settings::Settings;
use toml::Spanned;

use super::camera::camera;
use super::error::Fault;
use super::layout::{AnimationLayout, FogLayout, LightLayout, RenderLayout, SceneLayout};
use super::named::{Named, Open};
use super::object::Objects;
use super::value::{Background, FileName, List, OffOr, OneOrThree, VertexBits};
use super::{Loaded, SceneErrorKind, motion};
use crate::model::Playback;

/// Builds one scene.
pub(super) struct Builder<'a> {
    named: Named<'a>,
    scene: Scene,
    /// The space that the objects cover as they move, if the camera has no explicit position.
    swept: Vec<Swept>,
    playbacks: Vec<Playback>,
}

impl<'a> Builder<'a> {
    pub(super) fn new(path: &'a FilePath, open: &'a mut Open<'a>) -> Self {
        Self { named: Named::new(path, open), scene: Scene::new(), swept: Vec::new(), playbacks: Vec::new() }
    }

    /// Builds the scene. The caller knows the files.
    pub(super) fn scene(mut self, layout: &SceneLayout) -> Result<Loaded, Fault> {
        if layout.objects.is_empty() {
            return Err(Fault { span: None, kind: SceneErrorKind::NoObject });
        }
        self.scene.name = layout.name.clone().unwrap_or_default();
        self.scene.duration = layout.duration.map_or(self.scene.duration, |seconds| seconds.0);
        self.scene.picture = layout.picture.map_or(self.scene.picture, |seconds| seconds.0);
        self.scene.ambient = layout.ambient.map_or(self.scene.ambient, |intensity| intensity.0);
        if let Some(render) = &layout.render {
            self.scene.settings = settings(render);
        }
        if let Some(name) = &layout.palette {
            self.palette(name)?;
        }
        let (settings, palette, auto) = (self.scene.settings, self.scene.palette.clone(), self.scene.auto_palette);
        let look = layout.look.as_ref().map(|look| look.0);
        if let Some(look) = look {
            look.lend(&mut self.scene, layout.palette.is_some());
            // Having none is a choice, too.
            if let Some(RenderLayout { dither: Some(OffOr(None)), .. }) = layout.render {
                self.scene.settings.dither = None;
            }
        }
        if let Some(animation) = &layout.animation {
            self.scene.palette_animation = Some(self.animation(animation)?);
        }
        background_and_fog(&mut self.scene, layout)?;
        self.objects(layout)?;
        for light in &layout.lights {
            self.light(light)?;
        }
        self.camera(layout)?;
        self.scene.set_time(0.0);
        let without_look = look.map(|_| {
            let mut scene = self.scene.clone();
            (scene.settings, scene.palette, scene.auto_palette) = (settings, palette, auto);
            background_and_fog(&mut scene, layout).map(|()| scene)
        });
        let without_look = without_look.transpose()?;
        Ok(Loaded {
            scene: self.scene,
            look,
            without_look,
            warnings: self.named.warnings,
            files: Vec::new(),
            playbacks: self.playbacks,
        })
    }

    fn palette(&mut self, name: &Spanned<FileName>) -> Result<(), Fault> {
        if name.get_ref().0 == "auto" {
            self.scene.auto_palette = true;
        } else {
            self.scene.palette = Some(self.named.palette(name)?);
        }
        Ok(())
    }

    fn animation(&mut self, layout: &Spanned<AnimationLayout>) -> Result<PaletteAnimation, Fault> {
        let AnimationLayout { fade, cycle, rounds } = layout.get_ref();
        let period = self.scene.duration / rounds.map_or(1.0, |rounds| rounds.0);
        match (fade, cycle) {
            (Some(name), None) => Ok(PaletteAnimation::Fade { to: self.named.palette(name)?, period }),
            (None, Some(cycle)) => {
                let List([first, last]) = cycle.get_ref();
                let (first, last) = (first.index(), last.index());
                if first > last {
                    return Err(Fault::value(cycle.span(), "the first entry is after the last"));
                }
                Ok(PaletteAnimation::Cycle { range: first..=last, period })
            }
            _ => Err(Fault::value(layout.span(), "an animation is either a `fade` or a `cycle`")),
        }
    }

    fn objects(&mut self, layout: &SceneLayout) -> Result<(), Fault> {
        let is_framed = layout.camera.as_ref().is_none_or(|camera| camera.get_ref().eye.is_none());
        let mut objects = Objects::default();
        for layout in &layout.objects {
            let own = layout.get_ref();
            let path = own.path.as_ref().map(|path| motion::path(path, self.scene.duration)).transpose()?;
            let turns = match own.spin {
                Some(OneOrThree::One(about_y)) => [0.0, about_y.0, 0.0],
                Some(OneOrThree::Three(turns)) => turns.map(|turns| turns.0),
                None => [0.0; 3],
            };
            let turning = match turns {
                [0.0, 0.0, 0.0] => Turning::Still,
                [0.0, _, 0.0] => Turning::Upright,
                _ => Turning::Free,
            };
            let (own, moving) = objects.object(layout, &mut self.named)?;
            for object in own {
                let start = object.angles;
                let id = self.scene.add(object);
                let object = &self.scene[id];
                let playback = moving.as_ref().and_then(|moving| {
                    let playback = Playback::new(Shared::clone(&moving.rig), moving.clip, &self.scene, id);
                    playback.map(|playback| playback.stretched(moving.stretch))
                });
                if is_framed {
                    let swept = |object: &Object| Swept::new(object, turning, path.as_ref());
                    match &playback {
                        Some(playback) => self.swept.extend(playback.poses(object).map(|object| swept(&object))),
                        None => self.swept.push(swept(object)),
                    }
                }
                self.playbacks.extend(playback);
                if turns != [0.0; 3] {
                    // One loop takes the duration.
                    let turns = turns.map(|turns| turns / self.scene.duration);
                    self.scene.motions.push(Motion::Spin { object: id, start, turns });
                }
                if let Some(path) = path {
                    self.scene.motions.push(Motion::Path { what: Moving::Object(id), path });
                }
            }
        }
        Ok(())
    }

    fn light(&mut self, layout: &Spanned<LightLayout>) -> Result<(), Fault> {
        let LightLayout { sun, lamp, range, direction, intensity, color, path, outer, inner } = layout.get_ref();
        let path = path.as_ref().map(|path| motion::path(path, self.scene.duration)).transpose()?;
        let angle = outer.as_ref().or(inner.as_ref()).map(Spanned::span);
        if let (Some(_), Some(span)) = (sun, direction.as_ref().map(Spanned::span).or(angle)) {
            return Err(Fault::value(span, "only a lamp has a cone"));
        }
        let light = match (sun, lamp, range) {
            (Some(direction), None, None) => {
                let towards = direction.get_ref().vec3();
                if towards == Vec3::ZERO {
                    return Err(Fault::value(direction.span(), "a direction must not be zero"));
                }
                Light::sun(towards)
            }
            (Some(_), None, Some(range)) => return Err(Fault::value(range.span(), "only a lamp has a range")),
            (None, Some(position), Some(range)) => {
                let (position, range) = (position.get_ref().vec3(), range.get_ref().0);
                match cone(layout.get_ref())? {
                    Some(cone) => Light::spot(position, range, cone),
                    None => Light::lamp(position, range),
                }
            }
            (None, Some(_), None) => {
                return Err(Fault::value(layout.span(), "a lamp needs a `range`: how far it reaches"));
            }
            _ => return Err(Fault::value(layout.span(), "a light is either a `sun` or a `lamp`")),
        };
        let light = light.with_intensity(intensity.map_or(1.0, |intensity| intensity.0));
        let light = self.scene.add_light(light.with_color(color.map_or([1.0; 3], |color| color.0)));
        if let Some(path) = path {
            let what = Moving::Light(light);
            self.scene.motions.push(Motion::Path { what, path });
        }
        Ok(())
    }

    fn camera(&mut self, layout: &SceneLayout) -> Result<(), Fault> {
        self.scene.camera = camera(layout.camera.as_ref(), &self.swept)?;
        let Some(own) = &layout.camera else { return Ok(()) };
        for (path, what) in [(&own.get_ref().eye_path, Moving::Eye), (&own.get_ref().target_path, Moving::Target)] {
            if let Some(path) = path {
                let path = motion::path(path, self.scene.duration)?;
                self.scene.motions.push(Motion::Path { what, path });
            }
        }
        self.scene.set_time(0.0);
        if self.scene.camera.eye == self.scene.camera.target {
            return Err(Fault::value(own.span(), "the camera looks at its own position"));
        }
        Ok(())
    }
}

/// Sets the background and the fog. Fog hides distant surfaces only if it ends in the background's colour, so each
/// defaults to the other.
fn background_and_fog(scene: &mut Scene, layout: &SceneLayout) -> Result<(), Fault> {
    let fog = layout.fog.as_ref();
    let palette = scene.palette.clone().unwrap_or_default();
    let fog_color = fog.and_then(|fog| fog.get_ref().color);
    match (layout.background, fog_color) {
        (Some(Background::Entry(entry)), _) => scene.background = entry,
        (Some(Background::Color(color)), _) | (None, Some(color)) => {
            scene.set_background(color.rgb());
        }
        (None, None) => {}
    }
    let Some(fog) = fog else { return Ok(()) };
    let FogLayout { start, end, .. } = fog.get_ref();
    let color = match (fog_color, scene.background_color) {
        (Some(color), _) => color.rgb(),
        (None, Some(color)) => color,
        (None, None) => palette[scene.background],
    };
    let fog = Fog { color, start: start.map_or(0.0, |start| start.0), end: end.get_ref().0 };
    if fog.end <= fog.start {
        return Err(Fault::value(end.span(), "the fog must end farther away than it starts"));
    }
    scene.fog = Some(fog);
    Ok(())
}

/// The cone of a spot light: a direction with an outer angle.
fn cone(layout: &LightLayout) -> Result<Option<Cone>, Fault> {
    let inner = layout.inner.as_ref();
    let (direction, outer) = match (&layout.direction, &layout.outer) {
        (Some(direction), Some(outer)) => (direction, outer),
        (Some(direction), None) => return Err(Fault::value(direction.span(), "a cone needs an `outer` angle")),
        (None, outer) => match outer.as_ref().or(inner) {
            Some(angle) => return Err(Fault::value(angle.span(), "a cone needs a `direction`")),
            None => return Ok(None),
        },
    };
    if direction.get_ref().vec3() == Vec3::ZERO {
        return Err(Fault::value(direction.span(), "a direction must not be zero"));
    }
    if outer.get_ref().0 == 0.0 {
        return Err(Fault::value(outer.span(), "a cone's outer angle must be above 0"));
    }
    let degrees = inner.map_or(0.0, |angle| angle.get_ref().0);
    if let Some(inner) = inner.filter(|_| degrees > outer.get_ref().0) {
        return Err(Fault::value(inner.span(), "a cone's inner angle must be at most its outer one"));
    }
    let [inner, outer] = [degrees, outer.get_ref().0].map(|degrees| Angle::from_degrees(degrees.into()));
    Ok(Some(Cone { direction: direction.get_ref().vec3(), inner, outer }))
}

/// The render settings of a scene. An error budget takes precedence over a shading.
fn settings(layout: &RenderLayout) -> Settings {
    let shading = layout.shading.as_ref().map(|name| Accuracy::Shading(name.0));
    Settings {
        accuracy: layout.max_error.map(|shades| Accuracy::WithinError(shades.0)).or(shading),
        hidden_surfaces: layout.hidden_surfaces.as_ref().map(|name| name.0),
        mapping: layout.mapping.as_ref().map(|name| name.0),
        mipmaps: layout.mipmaps,
        tessellation: layout.tessellation.map(|shades| shades.0),
        dither: layout.dither.as_ref().and_then(|dither| dither.0),
        vertex_path: None,
        vertex_bits: layout.vertex_bits.map(VertexBits::bits),
        channels: None,
    }
}
