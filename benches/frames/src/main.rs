//! Draws frames of a shipped scene at 35 per second, and prints a hash of them all and the effects
//! that were on for any object in any frame. `sphere` is a turning sphere of 79,600 faces; `level` is a room with 100
//! objects, seen from inside; `mipmaps` is a turning torus with an image finer than the screen, in perspective,
//! `textured` the same without mipmaps; `list` is a list of small triangles for the rasterizer, without a scene. A
//! fourth argument is an error budget in shades, or a shading. A fifth one replaces the 35 frames per second; the camera
//! then orbits a scene that does not move by itself.
//!
//!     cargo run --release -p frames -- fog 35 portable
//!
//! `.ci/off_is_free` counts the instructions of [`next_frame`] in builds with and without the effects that are off, and
//! `.ci/instructions` compares them with recorded counts.

use std::collections::BTreeSet;
use std::error::Error;

use mode13h::Angle;
use mode13h::glam::{Quat, Vec2, Vec3};
use mode13h::light::Light;
use mode13h::mesh::shapes;
use mode13h::palette::Rgb;
use mode13h::plan::Effect;
use mode13h::raster::{Frame, Interpolation, Raster, RasterError, Vertex};
use mode13h::render::{RenderError, Renderer};
use mode13h::scene::{Motion, Object, Scene, Shared};
use mode13h::settings::{Accuracy, Mapping, Shading};
use mode13h::span::Kernel;
use mode13h::texture::Texture;
use mode13h::vga::Vga;
use mode13h_assets::shipped;
use mode13h_conformance::Random;
use mode13h_conformance::hash::{START, fnv_1a};

/// The first frame, in a function of its own so that a profiler can separate it from the rest: one-off work happens
/// here.
#[inline(never)]
fn first_frame(renderer: &mut Renderer, scene: &Scene, vga: &mut Vga) -> Result<(), RenderError> {
    // If the code were that of `next_frame`, the compiler would merge the two.
    std::hint::black_box(renderer.draw(scene, vga).map(|_| ()))
}

/// Each of the other frames.
#[inline(never)]
fn next_frame(renderer: &mut Renderer, scene: &Scene, vga: &mut Vga) -> Result<(), RenderError> {
    renderer.draw(scene, vga).map(|_| ())
}

/// Each frame of a list of triangles.
#[inline(never)]
fn next_frame_of_list(triangles: &[[Vertex; 3]], vga: &mut Vga, kernel: Kernel) -> Result<(), RasterError> {
    let frame = Frame::new(vga.pixels_mut(), Vga::WIDTH as u32, Vga::HEIGHT as u32, Vga::WIDTH)?;
    let all = triangles.iter().map(|corners| (corners, Interpolation::Gouraud88));
    Raster::new(frame).with_kernel(kernel).triangles(all);
    Ok(())
}

/// Small triangles of up to 12 pixels a side, a third of them specks.
fn list() -> Vec<[Vertex; 3]> {
    let mut random = Random::named("a list of triangles");
    let mut triangle = |i: u32| {
        let most = if i.is_multiple_of(3) { 1.0 } else { 12.0 };
        let (x, y) = (308.0 * random.unit(), 188.0 * random.unit());
        [0; 3].map(|_| {
            let (dx, dy) = (most * random.unit(), most * random.unit());
            Vertex::at((x + dx) as f32, (y + dy) as f32, (255.0 * random.unit()) as f32)
        })
    };
    (0..4_000).map(&mut triangle).collect()
}

/// A sphere half of whose faces cover no pixel, as in a scanned model.
fn sphere() -> Scene {
    let mut scene = Scene::new();
    let object = scene.add(Object::new(shapes::sphere(200, 200)));
    scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    scene.motions.push(Motion::Spin {
        object,
        start: [0.4, 0.0, 0.1].map(Angle::from_radians),
        turns: [0.0, 0.1, 0.0],
    });
    scene
}

/// A torus with an image finer than the screen, in perspective.
fn textured(mipmaps: bool) -> Result<Scene, Box<dyn Error>> {
    let mut scene = Scene::new();
    (scene.settings.mapping, scene.settings.mipmaps) = (Some(Mapping::Perspective), Some(mipmaps));
    let pixels: Vec<Rgb> = (0..=255_u8)
        .flat_map(|y| (0..=255_u8).map(move |x| Rgb::new((x ^ y).wrapping_mul(3), x | 15, y | 15)))
        .collect();
    let torus = shapes::torus(48, 24);
    let places = torus.positions().iter().map(|at| Vec2::new(at.x + 0.3 * at.z, at.y)).collect();
    let mut torus = Object::new(torus.with_texcoords(places)?);
    torus.materials[0].texture = Some(Texture::from_rgb(256, 256, &pixels)?.into());
    let object = scene.add(torus);
    scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    let start = [1.0, 0.0, 0.1].map(Angle::from_radians);
    scene.motions.push(Motion::Spin { object, start, turns: [0.0, 0.1, 0.0] });
    Ok(scene)
}

/// A room with textured walls and floors, and small objects all around the eye, most of them out of sight.
fn level() -> Result<Scene, Box<dyn Error>> {
    let mut scene = Scene::new();
    scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    (scene.camera.eye, scene.camera.near) = (Vec3::ZERO, 0.1);
    scene.camera.field_of_view = Angle::from_degrees(70.0);
    let bricks: Shared<Texture> = "bricks".parse::<Texture>()?.into();
    let (wall, torus) = (Shared::new(shapes::wall(8, 8)), Shared::new(shapes::torus(24, 12)));
    let turns = [[0.0, 0.0], [0.0, 90.0], [0.0, 180.0], [0.0, 270.0], [90.0, 0.0], [-90.0, 0.0]];
    for [x, y] in turns.map(|turn| turn.map(Angle::from_degrees)) {
        let turn = Quat::from_rotation_y(y.to_radians() as f32) * Quat::from_rotation_x(x.to_radians() as f32);
        // A wall faces the eye from 4 units away, and is a little larger than the room.
        let id = scene.add(Object::new(Shared::clone(&wall)).at(turn * Vec3::new(0.0, 0.0, -4.0)).scaled(6.0));
        scene[id].angles = [x, y, Angle::default()];
        scene[id].materials[0].texture = Some(Shared::clone(&bricks));
    }
    for i in 0..100_u8 {
        let (around, height) = (2.4 * f32::from(i), f32::from(i % 7) - 3.0);
        let at = Quat::from_rotation_y(around) * Vec3::new(0.0, height, -1.5 - f32::from(i % 5) / 3.0);
        scene.add(Object::new(Shared::clone(&torus)).at(at).scaled(0.3));
    }
    Ok(scene)
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [name, frames, kernel, more @ ..] = words.as_slice() else {
        return Err("usage: frames SCENE FRAMES KERNEL [MAX_ERROR | SHADING [RATE]]".into());
    };
    if name == "list" {
        let (triangles, mut vga, kernel) = (list(), Vga::new(), kernel.parse()?);
        for _ in 1..frames.parse::<u32>()? {
            next_frame_of_list(&triangles, &mut vga, kernel)?;
        }
        println!("hash {:016x}", fnv_1a(START, vga.pixels()));
        return Ok(());
    }
    let (max_error, rate) = (more.first(), more.get(1).map(|rate| rate.parse::<f64>()).transpose()?);
    let mut scene = match name.parse::<shipped::Shipped>() {
        Ok(shipped) => shipped.load()?.scene,
        Err(_) if name == "sphere" => sphere(),
        Err(_) if name == "level" => level()?,
        Err(_) if name == "mipmaps" || name == "textured" => textured(name == "mipmaps")?,
        Err(_) => return Err("no such scene".into()),
    };
    let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
    renderer.kernel = kernel.parse::<Kernel>()?;
    if let Some(accuracy) = max_error {
        renderer.settings.accuracy = Some(match accuracy.parse() {
            Ok(shades) => Accuracy::WithinError(shades),
            Err(_) => accuracy.parse::<Shading>()?.into(),
        });
    }
    let (mut all, mut on) = (START, BTreeSet::new());
    for frame in 0..frames.parse::<u32>()? {
        scene.set_time(f64::from(frame) / rate.unwrap_or(35.0));
        if name == "level" {
            scene.camera.target = Quat::from_rotation_y(frame as f32) * Vec3::NEG_Z;
        }
        if rate.is_some() && scene.motions.is_empty() {
            let around = scene.camera.eye - scene.camera.target;
            scene.camera.eye = scene.camera.target + Quat::from_rotation_y(0.5).mul_vec3(around);
        }
        let draw = if frame == 0 { first_frame } else { next_frame };
        draw(&mut renderer, &scene, &mut vga)?;
        all = fnv_1a(all, vga.pixels());
        for color in vga.palette().colors() {
            all = fnv_1a(all, &[color.r, color.g, color.b]);
        }
        on.extend(Effect::ALL.into_iter().filter(|effect| renderer.plan().is_on_anywhere(*effect)));
    }
    println!("hash {all:016x}");
    on.iter().for_each(|effect| println!("on {effect}"));
    Ok(())
}
