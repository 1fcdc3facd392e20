//! Small scenes, each of which calls for some effect.

use std::sync::LazyLock;

use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::{Blend, Light, Material};
use mode13h::mesh::{Mesh, shapes};
use mode13h::palette::{Rgb, builtin};
use mode13h::raster::Vertex;
use mode13h::render::{Renderer, Screen, Stats};
use mode13h::scene::{Camera, Fog, Object, PaletteAnimation, Scene, Shared};
use mode13h::settings::{DitherPattern, Settings, Shading, VertexPath};
use mode13h::texture::Texture;
use mode13h::vga::Vga;

use mode13h_conformance::Random;

/// A renderer that draws with this shading.
pub fn shaded(shading: Shading) -> Renderer {
    let mut renderer = Renderer::new();
    renderer.settings.accuracy = Some(shading.into());
    renderer
}

/// A renderer with this vertex path.
pub fn by_path(path: VertexPath) -> Renderer {
    let mut renderer = Renderer::new();
    renderer.settings.vertex_path = Some(path);
    renderer
}

/// The frame that a renderer draws, and its counts.
pub fn frame_by(renderer: &mut Renderer, scene: &Scene) -> (Vec<u8>, Stats) {
    let mut vga = Vga::new();
    let stats = renderer.draw(scene, &mut vga).expect("a legal scene");
    (vga.pixels().to_vec(), stats)
}

/// The triangles that the raster gets of a scene.
pub fn triangles_by(renderer: &mut Renderer, scene: &Scene) -> Vec<[Vertex; 3]> {
    let mut triangles = Vec::new();
    let each = |vertices: &[Vertex; 3], _| triangles.push(*vertices);
    renderer.for_each_triangle(scene, Screen::MODE_13H, each).expect("a legal scene");
    triangles
}

/// The frame of a new renderer.
pub fn frame(scene: &Scene) -> Vec<u8> {
    frame_by(&mut Renderer::new(), scene).0
}

/// A still mesh in the centre, seen straight on by a camera that frames its bounding sphere, under one sun: it is in
/// the picture however it is rotated.
pub fn framed(mesh: impl Into<Shared<Mesh>>) -> Scene {
    let object = Object::new(mesh).centred();
    let mut scene = Scene::new();
    scene.camera = Camera::framing(Vec3::ZERO, object.mesh().bounds().radius);
    scene.add(object);
    scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    scene
}

/// A scene with one shape, rotated a little.
pub fn showing(shape: &str) -> Scene {
    let mut scene = framed(shapes::by_name(shape).expect("listed"));
    scene.name = shape.to_string();
    scene.objects_mut()[0].name = shape.to_string();
    scene.objects_mut()[0].angles = [0.5, 0.7, 0.1].map(Angle::from_radians);
    scene
}

fn texture(name: &str) -> Option<Shared<Texture>> {
    Some(Shared::new(name.parse::<Texture>().expect("compiled in")))
}

fn material(scene: &mut Scene, object: usize) -> &mut Material {
    &mut scene.objects_mut()[object].materials[0]
}

/// A floor that extends far away, with an image repeated this many times each way.
pub fn floor(image: &str, times: f32) -> Scene {
    let wall = shapes::wall(12, 12);
    let repeated = wall.texcoords().expect("a wall has some").iter().map(|uv| *uv * times).collect();
    let mut scene = Scene::showing(wall.with_texcoords(repeated).expect("as many"));
    let object = &mut scene.objects_mut()[0];
    object.angles = [-core::f64::consts::FRAC_PI_2, 0.3, 0.0].map(Angle::from_radians);
    object.position = Vec3::new(0.0, -0.5, -5.0);
    object.scale = 12.0;
    (object.materials[0].ambient, object.materials[0].diffuse) = (1.0, 0.0);
    object.materials[0].texture = texture(image);
    scene.camera = Camera { eye: Vec3::new(0.0, 0.4, 1.0), target: Vec3::new(0.0, -0.1, -4.0), ..scene.camera };
    scene
}

/// A wall close to the eye with a lamp in front of it.
fn lamp_on_wall(slices: u32) -> Scene {
    let mut scene = Scene::new();
    scene.add(Object::new(shapes::wall(slices, slices)).named("wall"));
    scene.add_light(Light::lamp([0.1, 0.2, 0.25], 2.0));
    scene.camera.near = 0.1;
    scene
}

/// A scene of a few objects, some of which may extend behind the eye, under both kinds of lights.
pub fn random(random: &mut Random) -> Scene {
    let mut scene = Scene::new();
    let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
    scene.camera.near = between(0.05, 0.3) as f32;
    scene.camera.field_of_view = Angle::from_radians((between(0.4, 1.8) as f32).into());
    for _ in 0..between(1.0, 4.0) as u32 {
        let mesh = shapes::by_name(shapes::NAMES[between(0.0, 6.999) as usize]).expect("listed");
        let mut object = Object::new(mesh);
        object.position = [0.0; 3].map(|_| between(-1.5, 1.5) as f32).into();
        object.scale = between(0.3, 2.5) as f32;
        object.angles = [0.0; 3].map(|_| between(0.0, 7.0)).map(Angle::from_radians);
        let material = &mut object.materials[0];
        material.diffuse = between(0.3, 1.0) as f32;
        if between(0.0, 1.0) < 0.5 {
            material.specular = between(0.1, 0.6) as f32;
            material.shininess = between(1.0, 40.0) as f32;
        }
        scene.add(object);
    }
    for _ in 0..between(1.0, 4.0) as u32 {
        let place = [0.0; 3].map(|_| between(-2.0, 2.0) as f32);
        scene.add_light(match between(0.0, 1.0) < 0.5 {
            true => Light::sun(place).with_intensity(0.7),
            false => Light::lamp(place, between(1.0, 5.0) as f32),
        });
    }
    scene
}

/// Objects with parents; a child of an object that was removed; and hidden ones before the rest, one by itself and one
/// through its parent. Not in [`all`], as 16.16 does not support parents.
pub fn parents() -> Scene {
    let mut scene = showing("torus");
    let torus = scene.object_ids()[0];
    let mut add = |mesh: Mesh, position: [f32; 3], scale: f32, parent| {
        let mut object = Object::new(mesh);
        (object.position, object.scale, object.parent) = (position.into(), scale, parent);
        object.angles = [0.4, -0.6, 0.2].map(Angle::from_radians);
        scene.add(object)
    };
    let cube = add(shapes::cube(), [0.9, 0.5, 0.3], 0.5, Some(torus));
    add(shapes::sphere(16, 8), [0.0, 1.3, 0.0], 0.6, Some(cube));
    let removed = add(shapes::cube(), [5.0, 0.0, 0.0], 2.0, None);
    add(shapes::cone(12, 2), [-0.5, -0.5, 0.5], 0.4, Some(removed));
    let hidden = add(shapes::cube(), [0.0, 0.2, 1.0], 0.5, None);
    add(shapes::sphere(12, 6), [0.0, -1.0, 0.0], 1.0, Some(hidden));
    scene.remove(removed);
    scene[hidden].visible = false;
    scene
}

/// Every scene with its name, including the shipped ones; together they call for every effect. They are loaded once.
pub fn all() -> Vec<(String, Scene)> {
    static ALL: LazyLock<Vec<(String, Scene)>> = LazyLock::new(|| {
        small().into_iter().map(|(name, scene)| (name.to_string(), scene)).chain(super::shipped::scenes()).collect()
    });
    ALL.clone()
}

fn small() -> Vec<(&'static str, Scene)> {
    let mut scenes: Vec<(&'static str, Scene)> =
        ["cube", "torus", "cone", "teapot", "wall"].map(|name| (name, showing(name))).into();

    let mut dark = showing("torus");
    dark.clear_lights();
    scenes.push(("dark", dark));

    let mut shiny = showing("sphere");
    let white = material(&mut shiny, 0);
    (white.specular, white.shininess, white.diffuse) = (0.6, 20.0, 0.5);
    scenes.push(("shiny", shiny));

    scenes.push(("lamp", lamp_on_wall(6)));
    let mut far_lamp = showing("torus");
    far_lamp.add_light(Light::lamp([50.0, 0.0, 0.0], 3.0));
    scenes.push(("far lamp", far_lamp));

    let mut split = lamp_on_wall(2);
    split.settings.tessellation = Some(1.0);
    scenes.push(("tessellated", split));

    let mut columns = Scene::new();
    for i in 0..5_u8 {
        let mut column = Object::new(shapes::cylinder(12, 2)).named(format!("column {i}"));
        column.position = Vec3::new(f32::from(i % 2) * 2.0 - 1.0, 0.0, -2.0 * f32::from(i));
        columns.add(column);
    }
    columns.add_light(Light::sun([0.4, 0.6, 1.0]));
    columns.fog = Some(Fog { color: Rgb::new(128, 128, 128), start: 3.0, end: 10.0 });
    scenes.push(("fog", columns));

    let mut near = showing("torus");
    near.camera.eye *= 0.6;
    scenes.push(("beyond the edges", near));

    let mut crates = framed(shapes::wall(1, 1));
    material(&mut crates, 0).texture = texture("crate");
    crates.objects_mut()[0].angles = [0.0, 1.1, 0.0].map(Angle::from_radians);
    scenes.push(("texture", crates.clone()));
    crates.palette = Some(builtin::by_name("cube").expect("built in").palette.clone());
    crates.add_light(Light::sun([-1.0, 0.0, 0.5]).with_color([1.0, 0.3, 0.1]));
    scenes.push(("texture and colour", crates));

    scenes.push(("floor", floor("checker", 24.0)));

    let mut mirror = showing("torus");
    material(&mut mirror, 0).environment = texture("sky");
    scenes.push(("mirror", mirror));

    let mut colors = showing("sphere");
    colors.palette = Some(builtin::by_name("cube").expect("built in").palette.clone());
    colors.settings.dither = Some(DitherPattern::Ordered);
    colors.clear_lights();
    colors.add_light(Light::sun([1.0, 0.0, 0.5]).with_color([1.0, 0.0, 0.0]));
    colors.add_light(Light::sun([-1.0, 0.5, 0.5]).with_color([0.0, 1.0, 0.2]));
    scenes.push(("rgb", colors));

    let mut glass = showing("torus");
    let mut cube = Object::new(shapes::cube()).named("glass");
    cube.materials[0].blend = Blend::Mix(120);
    cube.angles = [0.3, 0.4, 0.0].map(Angle::from_radians);
    glass.add(cube);
    scenes.push(("glass", glass));
    let mut glenz = showing("cube");
    material(&mut glenz, 0).blend = Blend::Add;
    material(&mut glenz, 0).diffuse = 0.4;
    scenes.push(("glenz", glenz));

    let mut dithered = showing("sphere");
    dithered.palette = Some(builtin::by_name("materials-16x16").expect("built in").palette.clone());
    dithered.settings.dither = Some(DitherPattern::Ordered);
    scenes.push(("dither", dithered));

    for shading in [Shading::PhongTable, Shading::Phong, Shading::Flat, Shading::GouraudHyperbolic] {
        let mut phong = showing("cone");
        phong.settings = Settings { accuracy: Some(shading.into()), ..Settings::default() };
        let white = material(&mut phong, 0);
        (white.specular, white.shininess, white.diffuse) = (0.5, 10.0, 0.5);
        scenes.push((shading.name(), phong));
    }

    let mut cycle = showing("torus");
    cycle.palette_animation = Some(PaletteAnimation::Cycle { range: 1..=255, period: 2.0 });
    scenes.push(("cycle", cycle));

    let mut close = showing("torus");
    close.camera = Camera { eye: Vec3::new(0.0, 0.7, 1.0), near: 0.3, ..close.camera };
    close.fog = Some(Fog { color: Rgb::new(200, 200, 200), start: 0.2, end: 2.0 });
    material(&mut close, 0).texture = texture("bricks");
    scenes.push(("close", close));
    scenes
}
