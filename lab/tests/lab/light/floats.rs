//! R9: every float in a public structure of a scene, from one list, which is compared with the sources.

use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::{Cone, Light, Material};
use mode13h::mesh::{Mesh, Surface};
use mode13h::palette::{BIOS, Rgb};
use mode13h::render::Renderer;
use mode13h::scene::{Fog, Motion, Moving, Object, PaletteAnimation, Scene};
use mode13h::settings::Accuracy;
use mode13h::vga::Vga;

use crate::sources::{self, Item};
use crate::support::scenes::framed;
use crate::support::tried::Tried;

/// Sets a component, by its index, to a number.
type Put = fn(&mut Scene, f32, usize);

/// A field, its number of components, how to set one, and how the rejection begins, or [`BEGINS`].
type Row = (&'static str, usize, Put, &'static str);

fn lamp(scene: &mut Scene) -> (&mut Vec3, &mut f32, &mut f32, &mut [f32; 3]) {
    match &mut scene.lights_mut()[1] {
        Light::Lamp { position, intensity, range, color, .. } => (position, intensity, range, color),
        _ => panic!("a lamp"),
    }
}

/// Changes the cone of the lamp, which is turned into a spot light.
fn spot(scene: &mut Scene, change: impl FnOnce(&mut Cone)) {
    let (inner, outer) = (Angle::from_degrees(10.0), Angle::from_degrees(20.0));
    let mut new = Cone { direction: Vec3::X, inner, outer };
    change(&mut new);
    if let Light::Lamp { cone, .. } = &mut scene.lights_mut()[1] {
        *cone = Some(new);
    }
}

fn sun(scene: &mut Scene) -> (&mut Vec3, &mut f32, &mut [f32; 3]) {
    match &mut scene.lights_mut()[0] {
        Light::Sun { direction, intensity, color } => (direction, intensity, color),
        _ => panic!("a sun"),
    }
}

fn material(scene: &mut Scene) -> &mut Material {
    &mut scene.objects_mut()[0].materials[0]
}

fn moved(scene: &mut Scene, path: mode13h::scene::Path) {
    let what = Moving::Object(scene.add(Object::new(mode13h::mesh::shapes::cube())));
    scene.motions = vec![Motion::Path { what, path }];
    scene.set_time(1.0);
}

fn line(scene: &mut Scene, change: impl FnOnce((&mut Vec3, &mut Vec3, &mut f64))) {
    let (mut from, mut to, mut period) = (Vec3::ZERO, Vec3::X, 4.0);
    change((&mut from, &mut to, &mut period));
    moved(scene, mode13h::scene::Path::Line { from, to, period, back: false });
}

fn circle(scene: &mut Scene, change: impl FnOnce((&mut Vec3, &mut Vec3, &mut Vec3, &mut f64))) {
    let (mut centre, mut from, mut towards, mut period) = (Vec3::ZERO, Vec3::X, Vec3::Y, 4.0);
    change((&mut centre, &mut from, &mut towards, &mut period));
    moved(scene, mode13h::scene::Path::Circle { centre, from, towards, period });
}

fn spun(scene: &mut Scene, start: [f64; 3], turns: [f64; 3]) {
    let object = scene.add(Object::new(mode13h::mesh::shapes::cube()));
    scene.motions = vec![Motion::Spin { object, start: start.map(Angle::from_radians), turns }];
    scene.set_time(1.0);
}

fn one(bad: f32, i: usize) -> [f64; 3] {
    [0, 1, 2].map(|k| if k == i { f64::from(bad) } else { 0.5 })
}

/// Changes the surface of a scene's mesh.
fn surface(scene: &mut Scene, change: impl FnOnce(&mut Surface)) {
    let mut surface = Surface::default();
    change(&mut surface);
    let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]).expect("a mesh");
    scene.objects_mut()[0] = Object::new(mesh.with_surfaces(vec![surface], vec![0]).expect("a surface"));
}

/// The note on motions: they stay at their start, as if the number were 0.
const BEGINS: &str = "is drawn as it begins";

const FLOATS: &[Row] = &[
    ("Camera.eye", 3, |s, bad, i| s.camera.eye[i] = bad, "camera"),
    ("Camera.target", 3, |s, bad, i| s.camera.target[i] = bad, "camera"),
    ("Camera.up", 3, |s, bad, i| s.camera.up[i] = bad, "camera"),
    ("Camera.field_of_view", 1, |s, bad, _| s.camera.field_of_view = Angle::from_radians(bad.into()), "camera"),
    ("Camera.near", 1, |s, bad, _| s.camera.near = bad, "camera"),
    ("Fog.start", 1, |s, bad, _| s.fog = Some(Fog { color: Rgb::BLACK, start: bad, end: 9.0 }), "fog"),
    ("Fog.end", 1, |s, bad, _| s.fog = Some(Fog { color: Rgb::BLACK, start: 1.0, end: bad }), "fog"),
    ("Light::Sun.direction", 3, |s, bad, i| sun(s).0[i] = bad, "light 0"),
    ("Light::Sun.intensity", 1, |s, bad, _| *sun(s).1 = bad, "light 0"),
    ("Light::Sun.color", 3, |s, bad, i| sun(s).2[i] = bad, "light 0"),
    ("Light::Lamp.position", 3, |s, bad, i| lamp(s).0[i] = bad, "light 1"),
    ("Light::Lamp.intensity", 1, |s, bad, _| *lamp(s).1 = bad, "light 1"),
    ("Light::Lamp.range", 1, |s, bad, _| *lamp(s).2 = bad, "light 1"),
    ("Light::Lamp.color", 3, |s, bad, i| lamp(s).3[i] = bad, "light 1"),
    ("Cone.direction", 3, |s, bad, i| spot(s, |cone| cone.direction[i] = bad), "light 1"),
    ("Cone.inner", 1, |s, bad, _| spot(s, |cone| cone.inner = Angle::from_radians(bad.into())), "light 1"),
    ("Cone.outer", 1, |s, bad, _| spot(s, |cone| cone.outer = Angle::from_radians(bad.into())), "light 1"),
    ("Material.ambient", 1, |s, bad, _| material(s).ambient = bad, "object 0"),
    ("Material.diffuse", 1, |s, bad, _| material(s).diffuse = bad, "object 0"),
    ("Material.specular", 1, |s, bad, _| material(s).specular = bad, "object 0"),
    ("Material.shininess", 1, |s, bad, _| material(s).shininess = bad, "object 0"),
    ("Material.color", 3, |s, bad, i| material(s).color[i] = bad, "object 0"),
    ("Material.highlight", 3, |s, bad, i| material(s).highlight[i] = bad, "object 0"),
    ("Motion::Spin.start", 3, |s, bad, i| spun(s, one(bad, i), [0.0; 3]), "object 1"),
    ("Motion::Spin.turns", 3, |s, bad, i| spun(s, [0.0; 3], one(bad, i)), BEGINS),
    ("Object.pivot", 3, |s, bad, i| s.objects_mut()[0].pivot[i] = bad, "object 0"),
    ("Object.position", 3, |s, bad, i| s.objects_mut()[0].position[i] = bad, "object 0"),
    ("Object.scale", 1, |s, bad, _| s.objects_mut()[0].scale = bad, "object 0"),
    ("Object.angles", 3, |s, bad, i| s.objects_mut()[0].angles = one(bad, i).map(Angle::from_radians), "object 0"),
    (
        "PaletteAnimation::Fade.period",
        1,
        |s, bad, _| s.palette_animation = Some(PaletteAnimation::Fade { to: BIOS.clone(), period: bad.into() }),
        "palette animation",
    ),
    (
        "PaletteAnimation::Cycle.period",
        1,
        |s, bad, _| s.palette_animation = Some(PaletteAnimation::Cycle { range: 1..=9, period: bad.into() }),
        "palette animation",
    ),
    ("Path::Line.from", 3, |s, bad, i| line(s, |(from, ..)| from[i] = bad), "object 1"),
    ("Path::Line.to", 3, |s, bad, i| line(s, |(_, to, _)| to[i] = bad), "object 1"),
    ("Path::Line.period", 1, |s, bad, _| line(s, |(_, _, period)| *period = bad.into()), BEGINS),
    ("Path::Circle.centre", 3, |s, bad, i| circle(s, |(centre, ..)| centre[i] = bad), "object 1"),
    ("Path::Circle.from", 3, |s, bad, i| circle(s, |(_, from, ..)| from[i] = bad), "object 1"),
    ("Path::Circle.towards", 3, |s, bad, i| circle(s, |(_, _, towards, _)| towards[i] = bad), "object 1"),
    ("Path::Circle.period", 1, |s, bad, _| circle(s, |(_, _, _, period)| *period = bad.into()), BEGINS),
    ("Scene.ambient", 1, |s, bad, _| s.ambient = bad, "the ambient light"),
    ("Surface.diffuse", 3, |s, bad, i| surface(s, |surface| surface.diffuse[i] = bad), "object 0"),
    ("Surface.specular", 3, |s, bad, i| surface(s, |surface| surface.specular[i] = bad), "object 0"),
    ("Surface.shininess", 1, |s, bad, _| surface(s, |surface| surface.shininess = bad), "object 0"),
    ("Surface.opacity", 1, |s, bad, _| surface(s, |surface| surface.opacity = bad), "object 0"),
    ("Settings.accuracy", 1, |s, bad, _| s.settings.accuracy = Some(Accuracy::WithinError(bad)), "settings"),
    ("Settings.tessellation", 1, |s, bad, _| s.settings.tessellation = Some(bad), "settings"),
];

/// Minus zero, and f32's smallest numbers, subnormal and normal.
pub(crate) const NEXT_TO_ZERO: [f32; 5] =
    [-0.0, f32::MIN_POSITIVE, -f32::MIN_POSITIVE, f32::from_bits(1), -f32::from_bits(1)];

/// Floats that no frame depends on, and where they are tested.
const ELSEWHERE: &[(&str, &str)] = &[
    ("Bounds.centre", "worked out from positions"),
    ("Bounds.max", "worked out from positions"),
    ("Bounds.min", "worked out from positions"),
    ("Bounds.radius", "worked out from positions"),
    ("Mesh.normals", "tests/scene/mesh_normals.rs"),
    ("Mesh.positions", "tests/scene/mesh_normals.rs"),
    ("Mesh.texcoords", "tests/scene/mesh_normals.rs"),
    ("Scene.duration", "the length of a film, not a number of a frame: assets/tests/files/scene_files.rs"),
    ("Scene.picture", "a moment, which motions make nothing of if it is none"),
    ("Parts.crease", "what is no number leaves all faces flat"),
    ("Parts.normals", "those that are not finite count as missing"),
    ("Parts.positions", "Mesh::from_parts refuses it"),
    ("Parts.texcoords", "Mesh::from_parts refuses it"),
    ("Viewpoint.direction", "the camera that comes of it"),
    ("Viewpoint.field_of_view", "the camera that comes of it"),
    ("Viewpoint.target", "the camera that comes of it"),
    ("Viewpoint.up", "the camera that comes of it"),
    ("Scene.time", "in what it has moved"),
];

/// Fields of public structures and enums whose types contain floats.
///
/// Scene files and models, in subfolders, have numbers of their own, which are checked where they are read.
fn floats() -> Vec<String> {
    let items = sources::items_of(&sources::paths(&["settings/options.rs"], &["scene", "light", "mesh"]));
    let is_float = |item: &Item| {
        let mut words = item.of_type.split(|c: char| !c.is_alphanumeric());
        words.any(|word| ["Accuracy", "Angle", "f32", "f64", "Vec2", "Vec3", "Mat3"].contains(&word))
    };
    items.into_iter().filter(is_float).map(|item| item.name).collect()
}

pub(crate) fn every_float_is_refused(mut tried: Tried) {
    let mut fields = floats();
    fields.sort_unstable();
    let mut listed: Vec<&str> = FLOATS.iter().map(|row| row.0).chain(ELSEWHERE.iter().map(|row| row.0)).collect();
    listed.sort_unstable();
    assert_eq!(fields, listed, "the floats of the sources, and those of the list");

    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for (name, i, put, what) in components() {
            let mut scene = with_a_lamp();
            let mut begins = scene.clone();
            let mut vga = Vga::new();
            assert!(Renderer::new().draw(&scene, &mut vga).is_ok(), "{name} before");
            put(&mut scene, bad, i);
            vga.pixels_mut().fill(7);
            let palette = vga.palette();
            let drawn = Renderer::new().draw(&scene, &mut vga);
            if what == BEGINS {
                put(&mut begins, 0.0, i);
                let mut first = Vga::new();
                assert!(Renderer::new().draw(&begins, &mut first).is_ok() && drawn.is_ok(), "{name} [{i}] is {bad}");
                assert!(vga.pixels() == first.pixels(), "{name} [{i}] is {bad}: another picture");
            } else {
                let text = drawn.map(|_| ()).expect_err(&format!("{name} [{i}] is {bad}")).to_string();
                assert!(text.starts_with(what), "{name} [{i}] is {bad}: {text}");
                let is_left = vga.pixels().iter().all(|&byte| byte == 7) && vga.palette() == palette;
                assert!(is_left, "{name} [{i}] is {bad}: left as it was");
            }
            tried.add(1);
        }
    }
}

/// Every component of every float in the list.
fn components() -> impl Iterator<Item = (&'static str, usize, Put, &'static str)> {
    FLOATS.iter().flat_map(|(name, components, put, what)| (0..*components).map(move |i| (*name, i, *put, *what)))
}

fn with_a_lamp() -> Scene {
    let mut scene = framed(mode13h::mesh::shapes::cube());
    scene.add_light(Light::lamp([1.0, 2.0, 3.0], 9.0));
    scene
}

/// Floats for which any positive value differs from 0, and why.
const NOT_ZERO: [(&str, &str); 2] =
    [("Camera.up", "a direction of any length"), ("Surface.opacity", "without any it is opaque, as files have it")];

/// Every float treats a tiny number as 0: the same picture in the same colours. A negative one may be rejected for
/// its sign, and 0 where a number must be positive.
pub(crate) fn every_float_near_zero_is_zero(tried: &mut Tried) {
    for (name, i, put, _) in components() {
        let shown = |value: f32| {
            let (mut scene, mut vga) = (with_a_lamp(), Vga::new());
            scene.objects_mut()[0].angles = [0.5, 0.7, 0.1].map(Angle::from_radians);
            put(&mut scene, value, i);
            let drawn = Renderer::new().draw(&scene, &mut vga);
            drawn.map(|_| (vga.pixels().to_vec(), vga.palette())).map_err(|error| error.to_string())
        };
        let with_zero = shown(0.0);
        for tiny in NEXT_TO_ZERO {
            let shown = shown(tiny);
            let is_other = tiny != 0.0 && NOT_ZERO.iter().any(|(other, _)| *other == name);
            let is_right = match (&shown, &with_zero) {
                (Ok(_), Ok(_)) => shown == with_zero || is_other,
                (Err(text), Ok(_)) => {
                    tiny < 0.0 && ["must not be negative", "must be 0 <= "].iter().any(|why| text.contains(why))
                }
                (Ok(_), Err(text)) => {
                    let above = [
                        "outer above 0",
                        "must be above 0",
                        "must lie between 0",
                        "must not be zero",
                        "it looks at its own position",
                    ];
                    tiny != 0.0 && above.iter().any(|why| text.contains(why))
                }
                (Err(_), Err(_)) => shown == with_zero,
            };
            let said = |shown: &Result<_, String>| shown.as_ref().map_or_else(String::clone, |_| "a picture".into());
            assert!(is_right, "{name} [{i}] is {tiny:e}: {}; with 0: {}", said(&shown), said(&with_zero));
            tried.add(1);
        }
    }
}
