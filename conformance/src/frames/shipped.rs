//! The shipped scenes as values, so that chips without files can draw them too.
//!
//! A test compares each with its file in `assets/scenes/`. Cameras that a file leaves to automatic framing are given
//! here as the result.

use alloc::string::String;
use alloc::vec::Vec;

use mode13h::Angle;
use mode13h::glam::{Vec2, Vec3, vec3};
use mode13h::light::{Blend, Light, Material, RampChoice};
use mode13h::mesh::{Mesh, shapes};
use mode13h::palette::{Palette, Ramp, Rgb, builtin};
use mode13h::scene::{Camera, Fog, Motion, Moving, Object, ObjectId, PaletteAnimation, Path, Scene, Shared};
use mode13h::settings::DitherPattern;
use mode13h::settings::{Mapping, Shading};
use mode13h::texture::Texture;
use mode13h_assets::auto_palette;

/// A scene and its name.
type Named = (&'static str, fn() -> Scene);

/// The scenes, in the order of `mode13h list scenes`.
pub const ALL: [Named; 18] = [
    ("torus", torus),
    ("cube", cube),
    ("teapot", teapot),
    ("cone", cone),
    ("phong", || highlight("phong", Shading::Phong)),
    ("phong-table", || highlight("phong-table", Shading::PhongTable)),
    ("flash", || flash("flash")),
    ("flash-tessellated", flash_tessellated),
    ("two-lights", two_lights),
    ("fog", fog),
    ("rgb", rgb),
    ("crate", wooden_crate),
    ("mirror", mirror),
    ("interlock", interlock),
    ("glenz", glenz),
    ("fade", fade),
    ("cycle", cycle),
    ("still", still),
];

/// A scene ready to draw at a time in seconds, with its automatic palette if it asks for one.
#[must_use]
pub fn at(mut scene: Scene, seconds: f64) -> Scene {
    if scene.auto_palette
        && let Ok(automatic) = auto_palette::of_scene(&scene)
    {
        automatic.apply(&mut scene);
    }
    scene.set_time(seconds);
    scene
}

fn scene(name: &str, palette: Option<&Palette>, picture: f64) -> Scene {
    let mut scene = Scene::new();
    scene.name = name.into();
    if let Some(palette) = palette {
        scene.palette = Some(palette.clone());
    }
    scene.picture = picture;
    scene
}

fn camera(eye: Vec3, target: Vec3, near: f32) -> Camera {
    Camera { eye, target, near, ..Camera::default() }
}

/// A field of view as a file gives it: degrees in f32.
fn degrees(degrees: f32) -> Angle {
    Angle::from_radians(f64::from(degrees.to_radians()))
}

fn object(name: &str, mesh: impl Into<Shared<Mesh>>) -> Object {
    Object::new(mesh).centred().named(name)
}

fn turned(mut object: Object, degrees: [f64; 3]) -> Object {
    object.angles = degrees.map(Angle::from_degrees);
    object
}

fn placed(mut object: Object, position: Vec3, scale: f32) -> Object {
    (object.position, object.scale) = (position, scale);
    object
}

fn of_material(mut object: Object, change: impl FnOnce(&mut Material)) -> Object {
    change(&mut object.materials[0]);
    object
}

fn matt(ambient: f32, diffuse: f32) -> impl Fn(&mut Material) {
    move |material| (material.ambient, material.diffuse) = (ambient, diffuse)
}

fn shiny(ambient: f32, diffuse: f32, specular: f32, shininess: f32) -> impl Fn(&mut Material) {
    move |material| {
        (material.ambient, material.diffuse) = (ambient, diffuse);
        (material.specular, material.shininess) = (specular, shininess);
    }
}

fn stretched(mesh: &Mesh, factors: Vec3) -> Mesh {
    mesh.stretched(factors).unwrap_or_else(|_| mesh.clone())
}

pub(super) fn texture(name: &str) -> Option<Shared<Texture>> {
    name.parse::<Texture>().ok().map(Shared::new)
}

/// Adds an object that turns this many times about each axis in one round.
fn spin(scene: &mut Scene, object: Object, turns: [f64; 3]) -> ObjectId {
    let start = object.angles;
    let object = scene.add(object);
    let turns = turns.map(|turns| turns / scene.duration);
    scene.motions.push(Motion::Spin { object, start, turns });
    object
}

fn torus() -> Scene {
    let mut scene = scene("torus", None, 0.0);
    spin(&mut scene, turned(object("torus", shapes::torus(48, 24)), [20.05352282957881, 0.0, 0.0]), [0.0, 1.0, 0.0]);
    scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    let y = -0.00025590762;
    scene.camera = camera(vec3(0.0, y, 3.2113514), vec3(0.0, y, 0.0), 0.025088683);
    scene
}

fn cube() -> Scene {
    let mut scene = scene("cube", Some(&builtin::MATERIALS_4X64), 1.48);
    let cube = turned(object("cube", shapes::cube()), [30.0, 0.0, 0.0]);
    let cube = of_material(of_material(cube, matt(0.2, 0.8)), |material| material.ramp = RampChoice::Number(3));
    spin(&mut scene, cube, [1.0, 1.0, 0.0]);
    scene.add_light(Light::sun([-0.5, 0.7, 1.0]));
    scene.camera = camera(vec3(0.0, 0.0, 3.2123663), Vec3::ZERO, 0.025096612);
    scene
}

fn teapot() -> Scene {
    let mut scene = scene("teapot", Some(&builtin::COPPER), 0.0);
    let teapot = of_material(object("teapot", shapes::teapot(16)), shiny(0.1, 0.5, 0.5, 24.0));
    spin(&mut scene, teapot, [0.0, 1.0, 0.0]);
    scene.add_light(Light::sun([-0.7, 0.45, 1.0]));
    scene.camera = camera(vec3(0.0, 1.0125998, 2.2731767), vec3(0.0, -0.05476175, 0.094887815), 0.018951075);
    scene
}

fn cone() -> Scene {
    let mut scene = scene("cone", Some(&builtin::SILVER), 0.0);
    spin(&mut scene, turned(object("cone", shapes::cone(9, 1)), [25.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
    scene.add_light(Light::sun([-1.0, 0.5, 0.8]));
    let y = -0.21491621;
    scene.camera = camera(vec3(0.0, y, 3.058121), vec3(0.0, y, -0.3169637), 0.026367849);
    scene
}

fn highlight(name: &str, shading: Shading) -> Scene {
    let mut scene = scene(name, Some(&builtin::COPPER), 1.48);
    scene.settings.accuracy = Some(shading.into());
    let torus = turned(object("torus", shapes::torus(16, 8)), [30.0, 0.0, 0.0]);
    spin(&mut scene, of_material(torus, shiny(0.08, 0.45, 0.5, 30.0)), [0.0, 1.0, 0.0]);
    scene.add_light(Light::sun([-0.5, 0.7, 1.0]));
    let y = -0.008253141;
    scene.camera = camera(vec3(0.0, y, 3.1823566), vec3(0.0, y, 0.0), 0.02486216);
    scene
}

fn flash(name: &str) -> Scene {
    let mut scene = scene(name, Some(&builtin::COPPER), 1.11);
    scene.duration = 3.0;
    let long = vec3(11.3137, 2.1213, 1.0);
    let flat = vec3(2.8284, 11.3137, 1.0);
    let end = vec3(2.8284, 2.1213, 1.0);
    let side = Shared::new(stretched(&shapes::wall(4, 1), long));
    let level = Shared::new(stretched(&shapes::wall(1, 4), flat));
    let far = Shared::new(stretched(&shapes::wall(1, 1), end));
    for (name, mesh, position, angles, light) in [
        ("left wall", &side, vec3(-2.0, 0.0, 0.0), [0.0, 90.0, 0.0], (0.12, 0.88)),
        ("right wall", &side, vec3(2.0, 0.0, 0.0), [0.0, -90.0, 0.0], (0.12, 0.88)),
        ("floor", &level, vec3(0.0, -1.5, 0.0), [-90.0, 0.0, 0.0], (0.07, 0.6)),
        ("ceiling", &level, vec3(0.0, 1.5, 0.0), [90.0, 0.0, 0.0], (0.05, 0.45)),
        ("far wall", &far, vec3(0.0, 0.0, -8.0), [0.0; 3], (0.1, 0.8)),
    ] {
        let wall = placed(turned(object(name, mesh.clone()), angles), position, 1.0);
        scene.add(of_material(wall, matt(light.0, light.1)));
    }
    let lamp = scene.add_light(Light::lamp([0.6, -0.2, 14.0], 5.0).with_intensity(1.2));
    let path = Path::Line { from: vec3(0.6, -0.2, 14.0), to: vec3(0.6, -0.2, -14.0), period: 3.0, back: false };
    scene.motions.push(Motion::Path { what: Moving::Light(lamp), path });
    scene.camera = Camera { field_of_view: degrees(62.0), ..camera(vec3(0.0, 0.1, 7.6), vec3(0.0, -0.1, -8.0), 0.1) };
    scene
}

fn flash_tessellated() -> Scene {
    let mut scene = flash("flash-tessellated");
    scene.settings.tessellation = Some(1.0);
    scene
}

fn two_lights() -> Scene {
    let mut scene = scene("two-lights", Some(&builtin::SILVER), 1.48);
    let factors = vec3(5.6569, 1.5556, 1.0);
    for (name, mesh, y) in [("one face", shapes::wall(1, 1), 1.5), ("cut up", shapes::wall(64, 16), -1.5)] {
        let wall = object(name, stretched(&mesh, factors));
        scene.add(of_material(placed(wall, vec3(0.0, y, 0.0), 1.0), matt(0.1, 0.9)));
    }
    for [x, y] in [[-3.8, 1.5], [3.8, 1.5], [-3.8, -1.5], [3.8, -1.5]] {
        let lamp = scene.add_light(Light::lamp([x, y, 1.0], 3.2));
        let path = Path::Line { from: vec3(x, y, 0.5), to: vec3(x, y, 2.0), period: 4.0, back: true };
        scene.motions.push(Motion::Path { what: Moving::Light(lamp), path });
    }
    scene.camera = Camera { field_of_view: degrees(40.0), ..camera(vec3(0.0, 0.0, 9.0), Vec3::ZERO, 9.0 / 128.0) };
    scene
}

fn fog() -> Scene {
    let mut scene = scene("fog", Some(&builtin::SILVER), 1.48);
    let color = Rgb::new(0x8A, 0x8D, 0x90);
    scene.background_color = Some(color);
    scene.background = builtin::SILVER.nearest(color);
    scene.fog = Some(Fog { color, start: 2.0, end: 17.0 });
    let column = Shared::new(stretched(&shapes::cylinder(20, 1), vec3(0.4, 3.0, 0.4)));
    for x in [-1.8, 1.8] {
        for z in [0.0, -4.0, -8.0, -12.0, -16.0, -20.0] {
            let column = placed(object("column", column.clone()), vec3(x, 1.5, z), 1.0);
            scene.add(of_material(column, matt(0.1, 0.9)));
        }
    }
    let floor = object("floor", stretched(&shapes::wall(1, 12), vec3(40.0, 16.9706, 1.0)));
    let floor = placed(turned(floor, [-90.0, 0.0, 0.0]), vec3(0.0, -0.62, -10.0), 1.0);
    scene.add(of_material(floor, matt(0.1, 0.35)));
    scene.add_light(Light::sun([-0.8, 0.6, 0.5]));
    scene.camera = Camera { field_of_view: degrees(55.0), ..camera(vec3(0.5, 1.4, 0.0), vec3(0.0, 1.1, -10.0), 0.2) };
    for (what, from) in [(Moving::Eye, scene.camera.eye), (Moving::Target, scene.camera.target)] {
        let path = Path::Line { from, to: from - vec3(0.0, 0.0, 4.0), period: 4.0, back: false };
        scene.motions.push(Motion::Path { what, path });
    }
    scene
}

fn rgb() -> Scene {
    let mut scene = scene("rgb", None, 1.48);
    scene.auto_palette = true;
    scene.settings.dither = Some(DitherPattern::Ordered);
    let sphere = placed(object("sphere", shapes::sphere(40, 20)), vec3(0.0, 0.1, 0.0), 1.0);
    scene.add(of_material(sphere, matt(0.15, 0.85)));
    let floor = placed(turned(object("floor", shapes::wall(24, 24)), [-90.0, 0.0, 0.0]), vec3(0.0, -1.0, 0.0), 5.0);
    scene.add(of_material(floor, matt(0.15, 0.85)));
    let third = 1.7320508;
    for (color, from, towards) in [
        ([1.0, 0.0, 0.0], vec3(0.0, 0.0, 2.0), vec3(2.0, 0.0, 0.0)),
        ([0.0, 1.0, 0.0], vec3(third, 0.0, -1.0), vec3(-1.0, -0.0, -third)),
        ([0.0, 0.0, 1.0], vec3(-third, -0.0, -1.0), vec3(-1.0, 0.0, third)),
    ] {
        let lamp = scene.add_light(Light::lamp([0.0; 3], 7.0).with_intensity(1.2).with_color(color));
        let path = Path::Circle { centre: vec3(0.0, 1.3, 0.4), from, towards, period: 4.0 };
        scene.motions.push(Motion::Path { what: Moving::Light(lamp), path });
    }
    scene.camera = camera(vec3(0.0, 0.8, 3.7), Vec3::ZERO, 0.02957421);
    scene
}

fn wooden_crate() -> Scene {
    let mut scene = scene("crate", None, 1.48);
    scene.auto_palette = true;
    scene.settings.mapping = Some(Mapping::Perspective);
    let cube = of_material(object("cube", shapes::cube()), matt(0.25, 0.75));
    spin(&mut scene, of_material(cube, |material| material.texture = texture("crate")), [0.0, 1.0, 0.0]);
    scene.add_light(Light::sun([-0.5, 0.8, 1.0]));
    let place = camera(vec3(0.0, 0.7344584, 1.6805772), vec3(0.0, -0.17979376, 0.10428038), 0.014236271);
    scene.camera = Camera { field_of_view: degrees(58.0), ..place };
    scene
}

fn mirror() -> Scene {
    let mut scene = scene("mirror", None, 0.0);
    scene.auto_palette = true;
    let teapot = of_material(object("teapot", shapes::teapot(12)), matt(0.4, 0.6));
    spin(&mut scene, of_material(teapot, |material| material.environment = texture("sky")), [0.0, 1.0, 0.0]);
    scene.add_light(Light::sun([0.3, 0.8, 1.0]));
    scene.camera = camera(vec3(0.0, 0.69536954, 2.3730276), vec3(0.0, -0.0645407, 0.070269406), 0.018944561);
    scene
}

fn interlock() -> Scene {
    let mut scene = scene("interlock", Some(&builtin::MATERIALS_4X64), 1.48);
    let bar = Shared::new(stretched(&shapes::cube(), vec3(2.0, 0.3, 0.3)));
    for (number, name, position, angles) in [
        (0, "copper bar", vec3(-0.109, 0.406, 0.0), [0.0, -16.534, 14.406]),
        (1, "steel bar", vec3(-0.297, -0.297, 0.0), [0.0, -157.927, 42.821]),
        (2, "jade bar", vec3(0.406, -0.109, 0.0), [0.0, -132.07, -68.203]),
    ] {
        let bar = placed(turned(object(name, bar.clone()), angles), position, 1.0);
        scene.add(of_material(bar, |material| material.ramp = RampChoice::Number(number)));
    }
    scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    let path = Path::Circle {
        centre: vec3(0.0, 0.0, 3.8),
        from: vec3(1.3, 0.0, 0.0),
        towards: vec3(0.0, 0.9, 0.0),
        period: 4.0,
    };
    scene.motions.push(Motion::Path { what: Moving::Eye, path });
    scene.camera = camera(vec3(1.3, 0.0, 3.8), vec3(-0.10048759, -0.16647924, 0.0), 0.028193863);
    scene
}

fn glenz() -> Scene {
    let mut scene = scene("glenz", Some(&builtin::PHOSPHOR), 1.48);
    scene.settings.accuracy = Some(Shading::Flat.into());
    let wall = stretched(&shapes::wall(1, 1), vec3(3.4, 2.6, 1.0));
    let repeated: Vec<Vec2> =
        wall.texcoords().unwrap_or_default().iter().map(|t| *t * Vec2::new(1.3077, 1.0)).collect();
    let wall = wall.clone().with_texcoords(repeated).unwrap_or(wall);
    let wall = placed(object("wall behind", wall), vec3(0.0, 0.0, -1.3), 1.0);
    let wall = of_material(wall, matt(0.1, 0.1));
    scene.add(of_material(wall, |material| material.texture = texture("checker")));
    let glass = of_material(object("glass", shapes::sphere(8, 4)), matt(0.02, 0.42));
    spin(&mut scene, of_material(glass, |material| material.blend = Blend::Add), [1.0, 1.0, 0.0]);
    scene.add_light(Light::sun([0.5, 0.6, 1.0]));
    scene.camera = camera(vec3(0.0, 0.0, 3.1), Vec3::ZERO, 3.1 / 128.0);
    scene
}

fn fade() -> Scene {
    let mut scene = scene("fade", Some(&builtin::COPPER), 1.48);
    scene.palette_animation = Some(PaletteAnimation::Fade { to: builtin::PHOSPHOR.clone(), period: 4.0 });
    let shiny = shiny(0.1, 0.6, 0.4, 20.0);
    scene.add(of_material(turned(object("ring", shapes::torus(72, 36)), [80.0, 0.0, 0.0]), &shiny));
    scene.add(of_material(placed(object("sphere", shapes::sphere(48, 24)), vec3(0.0, 0.12, 0.0), 0.38), &shiny));
    scene.add_light(Light::sun([-0.6, 0.8, 0.7]));
    scene.camera = camera(vec3(0.0, 1.4, 1.95), Vec3::ZERO, 0.018754069);
    scene
}

fn cycle() -> Scene {
    let mut scene = scene("cycle", builtin::by_name("bios").map(|builtin| builtin.palette), 1.48);
    scene.palette_animation = Some(PaletteAnimation::Cycle { range: 32..=55, period: 1.0 });
    let teapot = turned(object("teapot", shapes::teapot(12)), [0.0, 30.0, 0.0]);
    scene.add(of_material(teapot, |material| {
        material.ramp = Ramp::new(32, 24).map_or(RampChoice::Nearest, RampChoice::Entries);
    }));
    scene.add_light(Light::sun([-0.5, 0.9, 0.8]));
    let x = -0.16502409;
    scene.camera = camera(vec3(x, 0.79727757, 1.8397809), vec3(x, -0.10048176, 0.007619088), 0.015939776);
    scene
}

fn still() -> Scene {
    let mut scene = scene("still", Some(&builtin::MATERIALS_8X32), 0.0);
    scene.settings.dither = Some(DitherPattern::Ordered);
    for (name, mesh, position, scale, angles, ramp, light) in [
        ("table", shapes::wall(16, 16), vec3(0.0, -0.7, 0.0), 4.2, [-90.0, 0.0, 0.0], 0, None),
        ("teapot", shapes::teapot(8), vec3(-0.2, -0.18, -0.3), 1.1, [0.0, 25.0, 0.0], 5, Some([0.1, 0.6, 0.4, 30.0])),
        ("apple", shapes::sphere(48, 24), vec3(1.1, -0.38, 0.6), 0.32, [0.0; 3], 2, Some([0.1, 0.7, 0.3, 20.0])),
        ("ring", shapes::torus(48, 24), vec3(-1.2, -0.59, 0.9), 0.36, [90.0, 0.0, 0.0], 1, Some([0.1, 0.6, 0.4, 16.0])),
        ("cube", shapes::cube(), vec3(1.3, -0.35, -0.7), 0.6, [0.0, 35.0, 0.0], 3, None),
    ] {
        let thing = placed(turned(object(name, mesh), angles), position, scale);
        scene.add(of_material(thing, |material| {
            material.ramp = RampChoice::Number(ramp);
            if let Some([ambient, diffuse, specular, shininess]) = light {
                shiny(ambient, diffuse, specular, shininess)(material);
            }
            if name == "table" {
                material.diffuse = 0.75;
            }
        }));
    }
    scene.add_light(Light::lamp([-1.6, 2.2, 1.8], 6.0).with_intensity(1.25));
    scene.camera = camera(vec3(0.2, 1.25, 4.0), vec3(0.0, -0.1, 0.0), 0.03301879);
    scene
}

/// The name of every scene.
pub fn names() -> impl Iterator<Item = String> {
    ALL.iter().map(|(name, _)| String::from(*name))
}
