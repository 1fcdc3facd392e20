//! What a caller may change between two frames: one list, compared with the sources.

use std::ops::Range;
use std::sync::LazyLock;

use mode13h::Angle;
use mode13h::glam::{EulerRot, Mat3, Vec3};
use mode13h::light::{Blend, Cone, Light, LightResponse, Material, RampChoice};
use mode13h::mesh::{Mesh, shapes};
use mode13h::palette::{Palette, Ramp, Rgb, builtin};
use mode13h::plan::Effect;
use mode13h::raster::{Frame, Interpolation, Vertex};
use mode13h::render::{RenderError, Renderer, Screen, Stats};
use mode13h::scene::{Fog, Motion, Moving, Object, ObjectId, PaletteAnimation, Path, Scene, Shared, UpAxis};
use mode13h::settings::DitherPattern;
use mode13h::settings::{Accuracy, HiddenSurfaces, Mapping, Settings, Shading, VertexPath};
use mode13h::span::Kernel;
use mode13h::texture::Texture;
use mode13h::vga::Vga;
use mode13h_lab::explain;

use crate::sources::{self, Item};
use mode13h_conformance::Random;

/// A scene, the renderer that is reused, and the machines that it draws on, of which the first is next.
pub(super) struct World {
    pub(super) scene: Scene,
    pub(super) settings: Settings,
    pub(super) kernel: Kernel,
    /// Effects forced for one object or for all objects, in the order they were forced.
    pub(super) forced: Vec<(Option<ObjectId>, Effect, Option<bool>)>,
    pub(super) kept: Renderer,
    pub(super) machines: [Box<Vga>; 2],
}

impl World {
    /// A fresh renderer with the settings of the reused one.
    pub(super) fn fresh(&self) -> Renderer {
        let mut renderer = Renderer::new();
        (renderer.settings, renderer.kernel) = (self.settings, self.kernel);
        for (object, effect, on) in &self.forced {
            match object {
                Some(object) => renderer.force_for(*object, *effect, *on),
                None => renderer.force(*effect, *on),
            }
        }
        renderer
    }
}

/// One thing that a caller may do between two frames.
pub(super) struct Change {
    /// The field, variant or method as [`in_the_sources`] names it, or a description of what the caller does.
    pub(super) name: &'static str,
    /// Whether some frame must show it.
    pub(super) is_seen: bool,
    pub(super) apply: fn(&mut World, &mut Random),
}

const fn seen(name: &'static str, apply: fn(&mut World, &mut Random)) -> Change {
    Change { name, is_seen: true, apply }
}

const fn unseen(name: &'static str, apply: fn(&mut World, &mut Random)) -> Change {
    Change { name, is_seen: false, apply }
}

/// Names that no frame depends on, or that are not state of a scene.
pub(super) const EXEMPT: [(&str, &str); 1] = [("Renderer.settings", "its fields are changed one by one")];

/// All changes.
pub(super) const CHANGES: &[Change] = &[
    // Scene
    unseen("Scene.name", |w, r| w.scene.name = text(r)),
    seen("Scene.camera", |w, r| w.scene.camera.eye = eye(r)),
    seen("Scene.ambient", |w, r| w.scene.ambient = between(r, 0.0, 2.0)),
    seen("Scene.background", |w, r| w.scene.background = byte(r)),
    unseen("Scene.background_color", |w, r| w.scene.background_color = sometimes(r, color)),
    seen("Scene.palette", |w, r| w.scene.palette = sometimes(r, palette)),
    seen("Scene.palette_animation", |w, r| w.scene.palette_animation = sometimes(r, |r| fade(r, palette))),
    seen("Scene.fog", |w, r| w.scene.fog = sometimes(r, fog)),
    seen("Scene.settings", |w, _| w.scene.settings = Default::default()),
    unseen("Scene.motions", |w, r| w.scene.motions.truncate(r.within(0, 1) as usize)),
    // The moment of its picture, which only the program uses.
    unseen("Scene.picture", |w, r| w.scene.picture = r.unit()),
    unseen("Scene.duration", |w, r| w.scene.duration = 1.0 + r.unit()),
    seen("Scene::set_background", |w, r| w.scene.set_background(color(r))),
    seen("Scene::set_palette", |w, r| w.scene.set_palette(palette(r))),
    seen("Scene::add", |w, r| {
        if w.scene.objects().len() < 5 {
            let object = object(r);
            w.scene.add(object);
        }
    }),
    seen("Scene::show", |w, r| {
        if w.scene.objects().len() < 5 && w.scene.lights().len() < 4 {
            let object = object(r);
            w.scene.show(object);
        }
    }),
    seen("Scene::show_turned", |w, r| {
        if w.scene.objects().len() < 5 && w.scene.lights().len() < 4 {
            let (object, angles) = (object(r), [r.unit(), r.unit()].map(Angle::from_radians));
            w.scene.show_turned(object, |_| angles);
        }
    }),
    seen("Scene::add_light", |w, r| {
        if w.scene.lights().len() < 4 {
            let light = light(r);
            w.scene.add_light(light);
        }
    }),
    seen("Scene::objects_mut", |w, r| *one_object(w, r) = object(r)),
    seen("Scene::lights_mut", |w, r| {
        let lights = w.scene.lights_mut();
        // The order in which they are summed.
        if r.within(0, 1) == 0 { lights.reverse() } else { lights.iter_mut().for_each(|at| *at = light(r)) }
    }),
    seen("Scene::clear_lights", |w, _| w.scene.clear_lights()),
    seen("Scene::remove_light", |w, r| {
        if let Some(&id) = one_of_few(w.scene.light_ids(), r) {
            w.scene.remove_light(id);
        }
    }),
    seen("a light, by its id", |w, r| {
        if let Some(&id) = one_of_few(w.scene.light_ids(), r) {
            w.scene[id] = light(r);
        }
    }),
    seen("Scene::remove", |w, r| {
        if let (true, Some(&id)) = (w.scene.objects().len() > 1, one_of_few(w.scene.object_ids(), r)) {
            w.scene.remove(id);
        }
    }),
    seen("Scene::get_mut", |w, r| {
        if let Some(&id) = one_of_few(w.scene.object_ids(), r) {
            *w.scene.get_mut(id).expect("there") = object(r);
        }
    }),
    seen("Scene::set_time", |w, r| {
        with_motion(w, r, |r| Motion::Path { what: Moving::Eye, path: line(r) });
        let seconds = r.unit() * 5.0;
        w.scene.set_time(seconds);
    }),
    // Camera
    seen("Camera.eye", |w, r| w.scene.camera.eye = eye(r)),
    seen("Camera.target", |w, r| w.scene.camera.target = place(r, 0.4)),
    seen("Camera.up", |w, r| w.scene.camera.up = place(r, 1.0)),
    seen("Camera.field_of_view", |w, r| {
        w.scene.camera.field_of_view = Angle::from_radians(between(r, 0.3, 2.0).into())
    }),
    seen("Camera.near", |w, r| w.scene.camera.near = between(r, 0.02, 2.5)),
    // Fog
    seen("Fog.color", |w, r| one_fog(w, r).color = color(r)),
    seen("Fog.start", |w, r| {
        let start = between(r, 0.0, 3.0);
        let fog = one_fog(w, r);
        (fog.start, fog.end) = (start, fog.end.max(start + 0.1));
    }),
    seen("Fog.end", |w, r| {
        let length = between(r, 0.1, 4.0);
        let fog = one_fog(w, r);
        fog.end = fog.start + length;
    }),
    // Palette animation
    seen("PaletteAnimation::Fade.to", |w, r| animate(w, r, |r| fade(r, palette))),
    seen("PaletteAnimation::Fade.period", |w, r| animate(w, r, |r| fade(r, |_| named_palette("copper")))),
    seen("PaletteAnimation::Cycle.range", |w, r| {
        animate(w, r, |r| PaletteAnimation::Cycle { range: r.within(0, 99) as u8..=255, period: 2.0 });
    }),
    seen("PaletteAnimation::Cycle.period", |w, r| {
        animate(w, r, |r| PaletteAnimation::Cycle { range: 1..=255, period: 0.5 + r.unit() });
    }),
    // The scene's settings
    seen("Scene.settings.accuracy", |w, r| {
        w.scene.settings.accuracy = match r.within(0, 2) {
            0 => None,
            1 => Some(r.one_of(&Shading::ALL).into()),
            _ => Some(Accuracy::WithinError(between(r, 0.5, 16.0))),
        };
    }),
    seen("Scene.settings.hidden_surfaces", |w, r| {
        w.scene.settings.hidden_surfaces = sometimes(r, |r| r.one_of(&HiddenSurfaces::ALL));
    }),
    seen("Scene.settings.mapping", |w, r| {
        set(w, None, |settings| &mut settings.mapping);
        let (before, after) = two_mappings(r);
        w.scene.settings.mapping = before;
        textured(w, r);
        w.scene.settings.mapping = after;
    }),
    seen("Scene.settings.mipmaps", |w, r| {
        textured(w, r);
        w.scene.settings.mipmaps = sometimes(r, |r| r.within(0, 1) == 1);
    }),
    seen("Scene.settings.tessellation", |w, r| {
        // With a lamp near a large face, which is then split differently.
        if r.within(0, 1) == 1 {
            let mut wall = Object::new(shapes::wall(1, 1));
            wall.angles = [0.0, 0.2, 0.0].map(Angle::from_radians);
            w.scene.objects_mut()[0] = wall;
            while let Some(&id) = w.scene.light_ids().get(3) {
                w.scene.remove_light(id);
            }
            w.scene.add_light(Light::lamp([0.2, 0.1, 0.3], 4.0));
            w.scene.settings.accuracy = None;
            set(w, None, |settings| &mut settings.accuracy);
            w.scene.settings.tessellation = Some(4.0);
            drawn(w);
            w.scene.settings.tessellation = Some(between(r, 0.5, 1.0));
        } else {
            w.scene.settings.tessellation = sometimes(r, |r| between(r, 0.5, 4.0));
        }
    }),
    seen("Scene.settings.dither", |w, r| {
        w.scene.settings.dither = sometimes(r, |r| r.one_of(&DitherPattern::ALL));
    }),
    seen("Scene.settings.vertex_path", |w, r| {
        w.scene.settings.vertex_path = sometimes(r, |r| r.one_of(&VertexPath::ALL))
    }),
    seen("Scene.settings.vertex_bits", |w, r| w.scene.settings.vertex_bits = sometimes(r, |r| r.within(0, 8) as u8)),
    seen("Scene.settings.channels", |w, r| w.scene.settings.channels = sometimes(r, |r| r.within(0, 1) == 1)),
    // Only the program makes such a palette, not the renderer.
    unseen("Scene.auto_palette", |w, r| w.scene.auto_palette = r.within(0, 1) == 1),
    // Motions
    seen("Motion::Spin.object", |w, r| spin(w, r, [0.0, 0.3, 0.0], [0.0, 0.2, 0.0])),
    seen("Motion::Spin.start", |w, r| {
        let start = angles(r);
        spin(w, r, start, [0.0; 3]);
    }),
    seen("Motion::Spin.turns", |w, r| {
        let turns = angles(r);
        spin(w, r, [0.0; 3], turns);
    }),
    seen("Motion::Path.what", |w, r| on_path(w, r, Moving::Target, line, 0.7)),
    seen("Motion::Path.path", |w, r| on_path(w, r, Moving::Eye, circle, 0.7)),
    seen("Moving::Object", |w, r| {
        let id = w.scene.add(object(r));
        on_path(w, r, Moving::Object(id), line, 0.6);
        fewer_objects(w);
    }),
    seen("Moving::Light", |w, r| {
        let Some(&id) = w.scene.light_ids().first() else { return };
        on_path(w, r, Moving::Light(id), circle, 0.6);
    }),
    seen("Moving::Eye", |w, r| on_path(w, r, Moving::Eye, line, 0.6)),
    seen("Moving::Target", |w, r| on_path(w, r, Moving::Target, circle, 0.6)),
    seen("Path::Line.from", |w, r| along(w, r, |r| straight(place(r, 0.5), Vec3::X * 0.3, 2.0, false))),
    seen("Path::Line.to", |w, r| along(w, r, |r| straight(Vec3::X * 0.3, place(r, 0.5), 2.0, false))),
    seen("Path::Line.period", |w, r| along(w, r, |r| straight(Vec3::X, Vec3::ZERO, 0.4 + r.unit(), false))),
    seen("Path::Line.back", |w, r| along(w, r, |r| straight(Vec3::X, Vec3::ZERO, 2.0, r.within(0, 1) == 1))),
    seen("Path::Circle.centre", |w, r| along(w, r, |r| round(place(r, 0.5), Vec3::X * 0.2, Vec3::Y * 0.2, 2.0))),
    seen("Path::Circle.from", |w, r| along(w, r, |r| round(Vec3::ZERO, place(r, 0.5), Vec3::Y * 0.2, 2.0))),
    seen("Path::Circle.towards", |w, r| along(w, r, |r| round(Vec3::ZERO, Vec3::X * 0.2, place(r, 0.5), 2.0))),
    seen("Path::Circle.period", |w, r| along(w, r, |r| round(Vec3::ZERO, Vec3::X, Vec3::Y, 0.4 + r.unit()))),
    // Object
    unseen("Object.name", |w, r| one_object(w, r).name = text(r)),
    seen("Object.materials", |w, r| {
        let material = material(r);
        one_object(w, r).materials[0] = material;
    }),
    seen("Object.pivot", |w, r| one_object(w, r).pivot = place(r, 0.5)),
    seen("Object.position", |w, r| one_object(w, r).position = place(r, 0.9)),
    seen("Object.scale", |w, r| one_object(w, r).scale = between(r, 0.2, 1.4)),
    seen("Object.up_axis", |w, r| {
        let object = one_object(w, r);
        object.up_axis = if object.up_axis == UpAxis::Y { UpAxis::Z } else { UpAxis::Y };
    }),
    seen("UpAxis::Y", |w, r| one_object(w, r).up_axis = UpAxis::Y),
    seen("UpAxis::Z", |w, r| one_object(w, r).up_axis = UpAxis::Z),
    seen("Object.visible", |w, r| one_object(w, r).visible ^= true),
    seen("Object.parent", |w, r| {
        // Only objects before it in the scene, so that there is no cycle.
        let ids = w.scene.object_ids().to_vec();
        let below = r.within(0, ids.len() as i64 - 1) as usize;
        let parent = one_of_few(&ids[..below], r).copied();
        w.scene.objects_mut()[below].parent = parent;
    }),
    seen("Object::rotate_x", |w, r| one_object(w, r).rotate_x(Angle::from_radians(r.unit()))),
    seen("Object::rotate_y", |w, r| one_object(w, r).rotate_y(Angle::from_radians(r.unit()))),
    seen("Object::rotate_z", |w, r| one_object(w, r).rotate_z(Angle::from_radians(r.unit()))),
    seen("Object::set_rotation", |w, r| {
        let [x, y, z] = angles(r).map(|angle| angle as f32);
        one_object(w, r).set_rotation(Mat3::from_euler(EulerRot::XYZ, x, y, z));
    }),
    seen("Object::set_mesh", |w, r| {
        let object = one_object(w, r);
        let (mesh, share) = (object.mesh(), between(r, 0.5, 0.9));
        let positions = mesh.positions().iter().map(|position| *position * share).collect();
        let pose = mesh.with_vertices(positions, mesh.normals().to_vec()).expect("as many vertices");
        object.set_mesh(pose);
    }),
    seen("Object.angles", |w, r| one_object(w, r).angles = angles(r).map(Angle::from_radians)),
    // Material
    unseen("Material.name", |w, r| one_material(w, r).name = text(r)),
    seen("Material.ambient", |w, r| one_material(w, r).ambient = between(r, 0.0, 0.6)),
    seen("Material.diffuse", |w, r| one_material(w, r).diffuse = between(r, 0.0, 1.0)),
    seen("Material.specular", |w, r| {
        one_material(w, r).specular = sometimes(r, |r| between(r, 0.1, 1.0)).unwrap_or(0.0)
    }),
    seen("Material.shininess", |w, r| {
        let shininess = between(r, 1.0, 30.0).round();
        shiny(w, r, |material| material.shininess = shininess);
    }),
    seen("Material.response", |w, r| {
        let tones = r.within(2, 5) as f32;
        let toon = LightResponse::new(move |intensity| (intensity * tones).floor() / tones);
        one_material(w, r).response = sometimes(r, |_| toon);
    }),
    seen("Material.ramp", |w, r| one_material(w, r).ramp = RampChoice::Number(r.within(0, 7) as u16)),
    seen("RampChoice::Number", |w, r| {
        w.scene.palette = Some(named_palette("materials-8x32"));
        drawn(w);
        one_material(w, r).ramp = RampChoice::Number(r.within(0, 7) as u16);
    }),
    seen("RampChoice::Entries", |w, r| {
        one_material(w, r).ramp = RampChoice::Entries(Ramp::new(r.within(0, 128) as u8, 64).expect("within 256"));
    }),
    seen("RampChoice::Nearest", |w, r| one_material(w, r).ramp = RampChoice::Nearest),
    seen("Material.color", |w, r| {
        let (before, after) = (channels(r), channels(r));
        let which = any_object(w, r);
        // Its colour is mixed from channels before the change, too.
        let material = &mut w.scene.objects_mut()[which].materials[0];
        (material.ramp, material.color) = (RampChoice::Nearest, before);
        drawn(w);
        w.scene.objects_mut()[which].materials[0].color = after;
    }),
    seen("Material.highlight", |w, r| {
        let color = channels(r);
        shiny(w, r, |material| material.highlight = color);
    }),
    seen("Material.texture", |w, r| {
        two_images(w, r, |material, image| (material.texture, material.environment) = (image, None));
    }),
    seen("Material.environment", |w, r| {
        two_images(w, r, |material, image| (material.texture, material.environment) = (None, image));
    }),
    seen("Material.blend", |w, r| one_material(w, r).blend = Blend::Mix(r.one_of(&[60, 190]))),
    seen("Blend::Opaque", |w, r| one_material(w, r).blend = Blend::Opaque),
    seen("Blend::Mix", |w, r| one_material(w, r).blend = Blend::Mix(r.one_of(&[60, 190]))),
    seen("Blend::Add", |w, r| one_material(w, r).blend = Blend::Add),
    // Lights
    seen("Light::Sun.direction", |w, r| sun(w, r, |r, to, _, _| *to = place(r, 1.0))),
    seen("Light::aim", |w, r| {
        sun(w, r, |_, _, _, _| {});
        let light = w.scene.lights_mut().iter_mut().find(|light| matches!(light, Light::Sun { .. }));
        light.expect("a sun").aim(place(r, 1.0));
    }),
    seen("Light::Sun.intensity", |w, r| sun(w, r, |r, _, intensity, _| *intensity = between(r, 0.2, 1.2))),
    seen("Light::Sun.color", |w, r| sun(w, r, |r, _, _, color| *color = channels(r))),
    seen("Light::Lamp.position", |w, r| lamp(w, r, |r, at, _, _, _| *at = place(r, 1.2))),
    seen("Light::Lamp.intensity", |w, r| lamp(w, r, |r, _, intensity, _, _| *intensity = between(r, 0.2, 1.5))),
    seen("Light::Lamp.range", |w, r| lamp(w, r, |r, _, _, range, _| *range = between(r, 0.5, 4.0))),
    seen("Light::Lamp.color", |w, r| lamp(w, r, |r, _, _, _, color| *color = channels(r))),
    seen("Light::Lamp.cone", |w, r| cone(w, r, |_, _| {})),
    seen("Cone.direction", |w, r| cone(w, r, |r, cone| cone.direction = place(r, 1.0))),
    seen("Cone.inner", |w, r| cone(w, r, |r, cone| cone.inner = Angle::from_degrees(between(r, 0.0, 40.0).into()))),
    seen("Cone.outer", |w, r| cone(w, r, |r, cone| cone.outer = Angle::from_degrees(between(r, 40.0, 90.0).into()))),
    // The renderer
    seen("Settings.accuracy", |w, r| {
        // Half the time two shadings with the same vertices and stages.
        let linear = [Shading::GouraudVintage, Shading::Gouraud88, Shading::Gouraud1616];
        let accuracy = match r.within(0, 2) {
            0 => {
                if r.within(0, 1) == 1 {
                    w.kept.settings.accuracy = Some(r.one_of(&linear).into());
                    drawn(w);
                }
                let shading = if r.within(0, 1) == 1 { r.one_of(&linear) } else { r.one_of(&Shading::ALL) };
                Some(Accuracy::Shading(shading))
            }
            1 => sometimes(r, |r| between(r, 0.5, 16.0)).map(Accuracy::WithinError),
            _ => Some(Accuracy::WithinError(between(r, 0.5, 16.0))),
        };
        set(w, accuracy, |settings| &mut settings.accuracy);
    }),
    seen("Settings.mapping", |w, r| {
        // For two of the mappings the plan's decision and the object's vertices are the same.
        let (before, after) = two_mappings(r);
        w.kept.settings.mapping = before;
        textured(w, r);
        set(w, after, |settings| &mut settings.mapping);
    }),
    seen("Settings.mipmaps", |w, r| {
        textured(w, r);
        set(w, sometimes(r, |r| r.within(0, 1) == 1), |s| &mut s.mipmaps);
    }),
    seen("Settings.tessellation", |w, r| set(w, sometimes(r, |r| between(r, 0.5, 4.0)), |s| &mut s.tessellation)),
    seen("Settings.dither", |w, r| set(w, sometimes(r, |r| r.one_of(&DitherPattern::ALL)), |s| &mut s.dither)),
    seen("Settings.vertex_path", |w, r| set(w, sometimes(r, |r| r.one_of(&VertexPath::ALL)), |s| &mut s.vertex_path)),
    seen("Settings.vertex_bits", |w, r| set(w, sometimes(r, |r| r.within(0, 8) as u8), |s| &mut s.vertex_bits)),
    seen("Settings.channels", |w, r| set(w, sometimes(r, |r| r.within(0, 1) == 1), |s| &mut s.channels)),
    unseen("Renderer.kernel", |w, r| {
        w.kernel = r.one_of(&Kernel::available().collect::<Vec<_>>());
        w.kept.kernel = w.kernel;
    }),
    seen("Settings.hidden_surfaces", |w, r| {
        // Two interpenetrating objects, so that each method shows them differently.
        if r.within(0, 1) == 1 {
            let mut through = Object::new(shapes::torus(9, 6));
            through.angles = angles(r).map(Angle::from_radians);
            w.scene.objects_mut()[0] = Object::new(shapes::cube());
            w.scene.add(through);
            fewer_objects(w);
            w.kept.settings.hidden_surfaces = Some(HiddenSurfaces::PainterOrder);
            drawn(w);
        }
        set(w, sometimes(r, |r| r.one_of(&HiddenSurfaces::ALL)), |settings| &mut settings.hidden_surfaces);
    }),
    seen("Renderer::force", |w, r| {
        let (effect, on) = forced(r);
        w.forced.push((None, effect, on));
        w.kept.force(effect, on);
    }),
    seen("Renderer::force_for", |w, r| {
        let (effect, on) = forced(r);
        let object = w.scene.object_ids().get(r.within(0, 2) as usize).copied();
        if let Some(object) = object {
            w.forced.push((Some(object), effect, on));
            w.kept.force_for(object, effect, on);
        }
    }),
    unseen("Renderer::make_plan", |w, r| {
        let screen = r.one_of(&[Screen::MODE_13H, Screen { width: 200, height: 320, pixel_aspect: (1, 1) }]);
        w.kept.make_plan(&w.scene, screen).expect("a legal scene");
    }),
    // Another picture on the same machine with the same renderer.
    unseen("Renderer::draw", |w, r| {
        let scene = start(r);
        w.kept.draw(&scene, &mut w.machines[0]).map(drop).unwrap_or_default();
    }),
    unseen("Renderer::draw_frame", |w, r| a_frame(w, r, Renderer::draw_frame)),
    unseen("Renderer::draw_over", |w, r| a_frame(w, r, Renderer::draw_over)),
    unseen("Renderer::for_each_triangle", |w, _| {
        let mut fresh = w.fresh();
        let [kept, fresh] = [&mut w.kept, &mut fresh].map(|renderer| {
            let mut all: Vec<([Vertex; 3], Interpolation)> = Vec::new();
            let drawn = renderer
                .for_each_triangle(&w.scene, Screen::MODE_13H, |v, interpolation| all.push((*v, interpolation)));
            (drawn.map(drop), all)
        });
        assert!(kept == fresh, "the triangles");
    }),
    // The machine
    unseen("Vga::memory_mut", |w, r| w.machines[0].memory_mut()[300..65_000].fill(byte(r))),
    unseen("Vga::poke", |w, r| w.machines[0].poke(r.within(0, 70_000) as u32, byte(r))),
    unseen("Vga::pixels_mut", |w, r| {
        let rows: Range<usize> = 320 * r.within(0, 99) as usize..320 * r.within(100, 200) as usize;
        w.machines[0].pixels_mut()[rows].fill(byte(r));
    }),
    // Without a palette in the scene the picture is made for the colours that the machine shows.
    seen("Vga::write_port", |w, r| {
        w.scene.palette = None;
        let port = r.one_of(&[0x3C6, 0x3C7, 0x3C8, 0x3C9, 0x3C9, 0x3C9]);
        w.machines[0].write_port(port, if port == 0x3C6 { r.one_of(&[0x3F, 0xFF]) } else { byte(r) });
    }),
    unseen("Vga::read_port", |w, r| {
        w.machines[0].read_port(r.one_of(&[0x3C7, 0x3C9, 0x3DA]));
    }),
    unseen("Vga::advance", |w, r| w.machines[0].advance(r.next_u64() >> 40)),
    seen("Vga::set_palette", |w, r| {
        w.scene.palette = sometimes(r, |_| w.scene.palette.clone()).flatten();
        w.machines[0].set_palette(&palette(r));
    }),
    seen("Vga::fade", |w, r| {
        w.scene.palette = None;
        w.machines[0].fade(&palette(r), &palette(r), r.within(0, 256) as u16);
    }),
    seen("Vga::cycle", |w, r| {
        w.scene.palette = None;
        w.machines[0].cycle(1..=255, r.within(1, 200) as i32);
    }),
    // Things that only the caller does
    seen("another scene", |w, r| w.scene = start(r)),
    seen("another mesh for the same object", |w, r| {
        let mesh = mesh(r);
        replace_mesh(one_object(w, r), mesh);
    }),
    unseen("an equal mesh at another address", |w, r| {
        let object = one_object(w, r);
        let mesh = object.mesh().clone();
        replace_mesh(object, mesh);
    }),
    seen("another machine", |w, _| w.machines.swap(0, 1)),
    unseen("a copy of the machine", |w, _| w.machines[1] = w.machines[0].clone()),
    unseen("a second renderer on the same machine", |w, r| {
        Renderer::new().draw(&start(r), &mut w.machines[0]).map(drop).unwrap_or_default();
    }),
    unseen("one set alike draws the same", |w, _| {
        w.kept.force(Effect::Lighting, Some(false));
        w.forced.push((None, Effect::Lighting, Some(false)));
        let [alike, fresh] = [w.kept.with_same_settings(), w.fresh()].map(|mut renderer| {
            let mut vga = w.machines[0].clone();
            vga.pixels_mut().fill(3);
            (renderer.draw(&w.scene, &mut vga).map(drop), vga.pixels().to_vec())
        });
        assert!(alike == fresh, "one set alike");
        w.kept.force(Effect::Lighting, None);
        w.forced.push((None, Effect::Lighting, None));
    }),
    unseen("nothing", |_, _| {}),
    unseen("a line within a rectangle of the frame", |w, r| {
        let mut frame = Frame::from(&mut *w.machines[0]);
        let y = r.within(0, 199) as u32;
        frame.row_mut(y).expect("a row")[40..280].fill(byte(r));
    }),
    unseen("an account of a pixel", |w, r| {
        let (x, y) = (r.within(0, 319) as u32, r.within(0, 199) as u32);
        // The 16.16 path has none.
        explain::pixel(&mut w.kept, &w.scene, Screen::MODE_13H, x, y).map(drop).unwrap_or_default();
    }),
    unseen("a scene that is refused", |w, r| {
        let legal = w.scene.clone();
        match r.within(0, 5) {
            0 => w.scene.camera.eye.x = f32::NAN,
            1 => w.scene.ambient = f32::INFINITY,
            2 => one_object(w, r).position.y = f32::NAN,
            3 => one_material(w, r).shininess = f32::NAN,
            4 => w.scene.settings.tessellation = Some(-1.0),
            _ => w.scene.fog = Some(Fog { color: Rgb::BLACK, start: 2.0, end: 1.0 }),
        }
        let fresh = w.fresh().draw(&w.scene, &mut w.machines[0].clone());
        let before = w.machines[0].pixels().to_vec();
        let kept = w.kept.draw(&w.scene, &mut w.machines[0]);
        assert_eq!(kept.map(drop), fresh.map(drop));
        assert!(w.machines[0].pixels() == before, "the machine is left as it was");
        w.scene = legal;
    }),
];

/// A scene to start from: one of each kind that the engine draws in its own way.
pub(super) fn start(random: &mut Random) -> Scene {
    let mut scene = Scene::new();
    scene.camera.eye = eye(random);
    scene.camera.near = 0.1;
    scene.add_light(Light::sun([0.4, 0.6, 1.0]).with_intensity(0.8));
    match random.within(0, 3) {
        // A matt object under one sun.
        0 => drop(scene.add(Object::new(mesh(random)))),
        // Matt objects that need a depth buffer.
        1 => {
            for _ in 0..3 {
                let mut object = Object::new(mesh(random));
                object.position = place(random, 0.6);
                object.scale = 0.6;
                object.angles = angles(random).map(Angle::from_radians);
                scene.add(object);
            }
        }
        // A little of everything.
        2 => {
            scene.add_light(Light::lamp([0.5, 0.4, 1.2], 4.0));
            scene.fog = Some(fog(random));
            for _ in 0..3 {
                scene.add(object(random));
            }
        }
        _ => {
            scene.palette = Some(named_palette("cube"));
            scene.add_light(Light::lamp([-0.5, 0.4, 1.2], 4.0).with_color([1.0, 0.4, 0.2]));
            scene.add(object(random));
            scene.add(Object::new(mesh(random)));
        }
    }
    scene
}

// Values

fn between(random: &mut Random, low: f64, high: f64) -> f32 {
    (low + (high - low) * random.unit()) as f32
}

fn byte(random: &mut Random) -> u8 {
    random.within(0, 255) as u8
}

fn text(random: &mut Random) -> String {
    random.next_u64().to_string()
}

/// Two times out of three.
fn sometimes<T>(random: &mut Random, value: impl FnOnce(&mut Random) -> T) -> Option<T> {
    (random.within(0, 2) > 0).then(|| value(random))
}

fn place(random: &mut Random, far: f64) -> Vec3 {
    Vec3::new(between(random, -far, far), between(random, -far, far), between(random, -far, far))
}

/// In front of the objects or among them.
fn eye(random: &mut Random) -> Vec3 {
    let away = random.one_of(&[0.7, 2.5, 3.0, 4.0]);
    Vec3::new(between(random, -0.5, 0.5), between(random, -0.5, 0.5), away)
}

fn angles(random: &mut Random) -> [f64; 3] {
    [(); 3].map(|()| random.unit() * 6.3)
}

fn color(random: &mut Random) -> Rgb {
    Rgb::new(byte(random), byte(random), byte(random))
}

fn channels(random: &mut Random) -> [f32; 3] {
    [(); 3].map(|()| between(random, 0.0, 1.0))
}

fn named_palette(name: &str) -> Palette {
    builtin::by_name(name).expect("built in").palette.clone()
}

fn palette(random: &mut Random) -> Palette {
    builtin::ALL[random.within(0, builtin::ALL.len() as i64 - 1) as usize].palette.clone()
}

fn fog(random: &mut Random) -> Fog {
    let start = between(random, 0.0, 2.5);
    Fog { color: color(random), start, end: start + between(random, 0.5, 4.0) }
}

fn fade(random: &mut Random, to: impl FnOnce(&mut Random) -> Palette) -> PaletteAnimation {
    PaletteAnimation::Fade { to: to(random), period: 0.5 + random.unit() }
}

fn line(random: &mut Random) -> Path {
    straight(eye(random), eye(random), 1.0 + random.unit(), random.within(0, 1) == 1)
}

fn straight(from: Vec3, to: Vec3, period: f64, back: bool) -> Path {
    Path::Line { from, to, period, back }
}

fn circle(random: &mut Random) -> Path {
    round(eye(random), place(random, 0.3), place(random, 0.3), 1.0 + random.unit())
}

fn round(centre: Vec3, from: Vec3, towards: Vec3, period: f64) -> Path {
    Path::Circle { centre, from, towards, period }
}

/// Few faces, so that a frame takes microseconds.
fn mesh(random: &mut Random) -> Mesh {
    match random.within(0, 4) {
        0 => shapes::cube(),
        1 => shapes::wall(2, 2),
        2 => shapes::sphere(8, 5),
        3 => shapes::torus(9, 6),
        _ => shapes::cone(random.within(3, 9) as u32, 2),
    }
}

fn object(random: &mut Random) -> Object {
    let mut object = Object::new(mesh(random));
    object.position = place(random, 0.7);
    object.scale = between(random, 0.4, 1.0);
    object.angles = angles(random).map(Angle::from_radians);
    object.materials[0] = material(random);
    object
}

fn material(random: &mut Random) -> Material {
    let mut material = Material { ambient: 0.2, diffuse: 0.6, shininess: 8.0, ..Material::default() };
    match random.within(0, 5) {
        0 => material.specular = 0.5,
        1 => material.texture = Some(texture(random)),
        2 => material.environment = Some(texture(random)),
        3 => material.blend = Blend::Mix(120),
        4 => material.color = channels(random),
        _ => {}
    }
    material
}

static TEXTURES: LazyLock<Vec<Shared<Texture>>> = LazyLock::new(|| {
    let small = |bits: u32| {
        let texels = (0..1 << (2 * bits)).map(|i| (i * 37 % 251) as u8).collect();
        let colors = std::array::from_fn(|i| Rgb::new(i as u8, (i * 7) as u8, 255 - i as u8));
        Texture::new(1 << bits, 1 << bits, texels, colors).expect("powers of two")
    };
    let plain = Texture::plain(Rgb::new(200, 100, 30));
    // The last is large for what it covers on the screen.
    [small(2), small(5), plain, small(8)].into_iter().map(Shared::new).collect()
});

/// One of three, or a copy of one at another address.
fn texture(random: &mut Random) -> Shared<Texture> {
    let texture = &TEXTURES[random.within(0, TEXTURES.len() as i64 - 1) as usize];
    if random.within(0, 5) == 0 { Shared::new((**texture).clone()) } else { Shared::clone(texture) }
}

fn light(random: &mut Random) -> Light {
    match random.within(0, 1) {
        0 => Light::sun(place(random, 1.0)).with_intensity(0.5),
        _ => Light::lamp(place(random, 1.0), between(random, 1.0, 4.0)),
    }
}

/// An effect switched on, off, or left to the plan; keeping vertices is never forced, as that draws outdated ones.
fn forced(random: &mut Random) -> (Effect, Option<bool>) {
    let on = random.one_of(&[None, Some(false), Some(true)]);
    match random.one_of(&Effect::ALL) {
        Effect::Transform => (Effect::Transform, on.filter(|on| *on)),
        effect => (effect, on),
    }
}

// Positions

/// A random element of a list, unless it is empty.
fn one_of_few<'a, T>(list: &'a [T], random: &mut Random) -> Option<&'a T> {
    let last = list.len().checked_sub(1)?;
    list.get(random.within(0, last as i64) as usize)
}

type DrawFrame = fn(&mut Renderer, &Scene, Frame<'_>, (u32, u32)) -> Result<Stats, RenderError>;

/// A frame of another size, or a band of one, with the reused renderer and with a new one: the same bytes.
fn a_frame(w: &mut World, r: &mut Random, draw: DrawFrame) {
    let screen = (r.within(1, 90) as u32, r.within(1, 60) as u32);
    let first = r.within(0, i64::from(screen.1) - 1) as u32;
    let rows = r.one_of(&[0, first])..screen.1;
    let mut fresh = w.fresh();
    let [kept, fresh] = [&mut w.kept, &mut fresh].map(|renderer| {
        let mut bytes = vec![7; (screen.0 * screen.1) as usize];
        let frame = Frame::band(&mut bytes, screen.0, screen.1, screen.0 as usize, rows.clone()).expect("a band");
        let drawn = draw(renderer, &w.scene, frame, (1, 1)).map(drop);
        (drawn, bytes)
    });
    assert!(kept == fresh, "a frame of {screen:?}, rows {rows:?}");
}

fn any_object(world: &World, random: &mut Random) -> usize {
    random.within(0, world.scene.objects().len() as i64 - 1) as usize
}

fn one_object<'a>(world: &'a mut World, random: &mut Random) -> &'a mut Object {
    let which = any_object(world, random);
    &mut world.scene.objects_mut()[which]
}

fn one_material<'a>(world: &'a mut World, random: &mut Random) -> &'a mut Material {
    &mut one_object(world, random).materials[0]
}

/// Changes a material that has a highlight.
fn shiny(world: &mut World, random: &mut Random, change: impl Fn(&mut Material)) {
    let which = any_object(world, random);
    let specular = &mut world.scene.objects_mut()[which].materials[0].specular;
    *specular = specular.max(0.4);
    drawn(world);
    change(&mut world.scene.objects_mut()[which].materials[0]);
}

/// Draws a frame, so that the next one differs from it only by the coming change.
fn drawn(world: &mut World) {
    world.kept.draw(&world.scene, &mut world.machines[0]).map(drop).unwrap_or_default();
}

/// Gives a material an image, draws, and gives it another one, or none.
fn two_images(world: &mut World, random: &mut Random, change: impl Fn(&mut Material, Option<Shared<Texture>>)) {
    let which = any_object(world, random);
    let object = &mut world.scene.objects_mut()[which];
    if object.mesh().texcoords().is_none() {
        replace_mesh(object, shapes::wall(1, 1));
    }
    change(&mut object.materials[0], Some(texture(random)));
    drawn(world);
    let image = sometimes(random, texture);
    change(&mut world.scene.objects_mut()[which].materials[0], image);
}

/// A mapping and another one; half the time two for which the plan's effects are the same.
fn two_mappings(random: &mut Random) -> (Option<Mapping>, Option<Mapping>) {
    let any = |random: &mut Random| sometimes(random, |random| random.one_of(&Mapping::ALL));
    match random.within(0, 3) {
        0 => (Some(Mapping::Every16), Some(Mapping::Perspective)),
        1 => (Some(Mapping::Perspective), Some(Mapping::Every16)),
        _ => (any(random), any(random)),
    }
}

/// Ensures a texture on a face that is seen at an angle.
fn textured(world: &mut World, random: &mut Random) {
    let object = one_object(world, random);
    if object.mesh().texcoords().is_none() {
        replace_mesh(object, shapes::wall(1, 1));
        object.angles = [0.2, 0.9, 0.1].map(Angle::from_radians);
        object.scale = 1.0;
    }
    if object.materials[0].texture.is_none() {
        object.materials[0].texture = Some(Shared::clone(&TEXTURES[3]));
    }
    drawn(world);
}

fn one_fog<'a>(world: &'a mut World, random: &mut Random) -> &'a mut Fog {
    if world.scene.fog.is_none() {
        world.scene.fog = Some(fog(random));
        drawn(world);
    }
    world.scene.fog.as_mut().expect("fog")
}

/// Sets a field of the settings, of the reused renderer too.
fn set<T: Copy>(world: &mut World, value: T, field: fn(&mut Settings) -> &mut T) {
    *field(&mut world.settings) = value;
    *field(&mut world.kept.settings) = value;
}

fn animate(world: &mut World, random: &mut Random, animation: impl FnOnce(&mut Random) -> PaletteAnimation) {
    world.scene.palette.get_or_insert_with(|| named_palette("grey"));
    world.scene.palette_animation = Some(animation(random));
    // Only the animation advances; motions have changes of their own.
    let motions = std::mem::take(&mut world.scene.motions);
    world.scene.set_time(0.3);
    world.scene.motions = motions;
}

fn with_motion(world: &mut World, random: &mut Random, motion: impl FnOnce(&mut Random) -> Motion) {
    if world.scene.motions.len() > 1 {
        world.scene.motions.clear();
    }
    world.scene.motions.push(motion(random));
}

fn spin(world: &mut World, random: &mut Random, start: [f64; 3], turns: [f64; 3]) {
    let id = world.scene.add(object(random));
    with_motion(world, random, |_| Motion::Spin { object: id, start: start.map(Angle::from_radians), turns });
    world.scene.set_time(0.6);
    fewer_objects(world);
}

/// Moves something along a path, as far as it gets in some seconds.
fn on_path(world: &mut World, random: &mut Random, what: Moving, path: impl FnOnce(&mut Random) -> Path, seconds: f64) {
    with_motion(world, random, |random| Motion::Path { what, path: path(random) });
    world.scene.set_time(seconds);
}

/// Moves the target along a path.
fn along(world: &mut World, random: &mut Random, path: impl FnOnce(&mut Random) -> Path) {
    on_path(world, random, Moving::Target, path, 1.3);
}

/// The object with another mesh, otherwise unchanged.
fn replace_mesh(object: &mut Object, mesh: Mesh) {
    let mut new = Object::new(mesh);
    new.angles = object.angles;
    let old = std::mem::replace(object, new);
    (object.name, object.materials, object.pivot) = (old.name, old.materials, old.pivot);
    (object.position, object.scale, object.up_axis) = (old.position, old.scale, old.up_axis);
}

/// Keeps a scene small: a large one starts again with its last three objects.
fn fewer_objects(world: &mut World) {
    let objects = world.scene.objects().to_vec();
    if objects.len() <= 5 {
        return;
    }
    let old = std::mem::take(&mut world.scene);
    let mut scene = Scene::new();
    (scene.camera, scene.ambient, scene.background) = (old.camera, old.ambient, old.background);
    (scene.palette, scene.fog, scene.settings) = (old.palette.clone(), old.fog, old.settings);
    for &light in old.lights() {
        scene.add_light(light);
    }
    for mut object in objects.into_iter().rev().take(3) {
        // Ids belong to another scene.
        object.parent = None;
        scene.add(object);
    }
    world.scene = scene;
}

/// Changes the direction, intensity and colour of one sun; adds a sun if there is none.
fn sun(world: &mut World, random: &mut Random, change: impl Fn(&mut Random, &mut Vec3, &mut f32, &mut [f32; 3])) {
    if !world.scene.lights().iter().any(|light| matches!(light, Light::Sun { .. })) {
        world.scene.add_light(Light::sun([0.1, 0.2, 1.0]));
        drawn(world);
    }
    for light in world.scene.lights_mut() {
        if let Light::Sun { direction, intensity, color } = light {
            return change(random, direction, intensity, color);
        }
    }
}

type ChangeLamp = fn(&mut Random, &mut Vec3, &mut f32, &mut f32, &mut [f32; 3]);

/// Changes a lamp: its position, intensity, range and colour.
fn lamp(world: &mut World, random: &mut Random, change: ChangeLamp) {
    if !world.scene.lights().iter().any(|light| matches!(light, Light::Lamp { .. })) {
        world.scene.add_light(Light::lamp([0.4, 0.5, 1.3], 3.0));
        drawn(world);
    }
    for light in world.scene.lights_mut() {
        if let Light::Lamp { position, intensity, range, color, .. } = light {
            return change(random, position, intensity, range, color);
        }
    }
}

/// Changes the cone of a spot light, which one of the lamps is turned into.
fn cone(world: &mut World, random: &mut Random, change: impl Fn(&mut Random, &mut Cone)) {
    lamp(world, random, |_, _, _, _, _| {});
    for light in world.scene.lights_mut() {
        if let Light::Lamp { position, cone, .. } = light {
            let [inner, outer] = [20.0, 45.0].map(Angle::from_degrees);
            return change(random, cone.get_or_insert(Cone { direction: -*position, inner, outer }));
        }
    }
}

// What the sources contain

/// Every public field of a struct (`Fog.start`), every variant of an enum with its fields (`Blend::Mix`,
/// `Light::Sun.color`) and every public method that takes `&mut self` (`Scene::add`), of the modules that hold what a
/// frame is drawn from.
pub(super) fn in_the_sources() -> Vec<String> {
    let mut paths = sources::paths(&["render/mod.rs", "vga/mod.rs"], &["scene", "light"]);
    // Framing creates cameras, which are listed.
    paths.retain(|path| !path.ends_with("framing.rs"));
    let mut names = public(sources::items_of(&paths));
    // The settings of a renderer and of a scene.
    let mut fields = public(sources::items_of(&sources::paths(&["settings/options.rs"], &[])));
    fields.retain(|name| name.starts_with("Settings."));
    names.extend(fields.iter().map(|name| format!("Scene.{}", name.replacen('S', "s", 1))));
    names.extend(fields);
    names.sort();
    names
}

/// The names of what is public.
pub(super) fn public(items: Vec<Item>) -> Vec<String> {
    items.into_iter().filter(|item| item.is_public).map(|item| item.name).collect()
}
