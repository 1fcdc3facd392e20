//! Golden frames: indexed PNGs, compared by index and by palette.
//!
//! Integer results are the same bits on every machine, and the floats before them keep to rules that
//! make them so (ARCHITECTURE.md): a frame that differs is a change of the engine's bytes, which
//! belongs into CHANGELOG.md. `MODE13H_WRITE_GOLDEN=1 cargo test --test golden` writes the frames
//! anew, drawn by the portable kernel, and fails.
#![cfg(feature = "png")]

mod support;

use std::fs::{self, File};
use std::io::{BufReader, BufWriter};
use std::path::{Path, PathBuf};

use mode13h::mesh::shapes;
use mode13h::palette::{Rgb, builtin};
use mode13h::render::{Renderer, Rung};
use mode13h::scene::Scene;
use mode13h::span::Kernel;
use mode13h::vga::Vga;
use support::tried::Tried;

/// What a golden frame holds.
#[derive(PartialEq, Eq)]
struct Indexed {
    pixels: Vec<u8>,
    colors: Vec<Rgb>,
}

fn shape(name: &str, rung: Rung) -> Scene {
    let mut scene = Scene::showing(shapes::by_name(name).expect("listed"));
    scene.palette = Some(builtin::COPPER.clone());
    scene.objects_mut()[0].set_angles([0.5, 0.7, 0.1]);
    scene.wishes.rung = Some(rung);
    scene
}

fn frame(scene: &Scene, kernel: Kernel) -> Indexed {
    let mut renderer = Renderer::new();
    renderer.set_kernel(kernel);
    let mut vga = Vga::new();
    renderer.draw(scene, &mut vga).expect("a legal scene");
    Indexed { pixels: vga.pixels().to_vec(), colors: vga.palette().colors().to_vec() }
}

fn read(path: &Path) -> Indexed {
    let file = File::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut reader = png::Decoder::new(BufReader::new(file)).read_info().expect("a PNG");
    let info = reader.info();
    assert_eq!((info.color_type, info.width, info.height), (png::ColorType::Indexed, 320, 200));
    let colors =
        info.palette.as_ref().expect("a palette").chunks(3).map(|c| Rgb { r: c[0], g: c[1], b: c[2] }).collect();
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    reader.next_frame(&mut pixels).expect("a frame");
    Indexed { pixels, colors }
}

/// Expected, actual, and where they differ, side by side.
fn side_by_side(path: &Path, expected: &Indexed, actual: &Indexed) {
    let rgb = |image: &Indexed, place: usize| {
        let Rgb { r, g, b } = image.colors[usize::from(image.pixels[place])];
        [r, g, b]
    };
    let mut bytes = Vec::new();
    for y in 0..200 {
        bytes.extend((0..320).flat_map(|x| rgb(expected, y * 320 + x)));
        bytes.extend((0..320).flat_map(|x| rgb(actual, y * 320 + x)));
        bytes.extend((0..320).flat_map(|x| {
            let place = y * 320 + x;
            if expected.pixels[place] == actual.pixels[place] { [0; 3] } else { [255, 0, 0] }
        }));
    }
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(path).expect("a file")), 960, 200);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header().expect("a header").write_image_data(&bytes).expect("a picture");
}

/// Compares the frames of scenes with the files of their names, or writes these.
fn compare(tried: &mut Tried, scenes: &[(String, Scene)]) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    let mut wrong: Vec<PathBuf> = Vec::new();
    for (name, scene) in scenes {
        let path = folder.join(format!("{name}.png"));
        if std::env::var_os("MODE13H_WRITE_GOLDEN").is_some() {
            let Indexed { pixels, colors } = frame(scene, Kernel::PORTABLE);
            fs::create_dir_all(&folder).expect("a folder");
            let mut encoder = png::Encoder::new(BufWriter::new(File::create(&path).expect("a file")), 320, 200);
            encoder.set_color(png::ColorType::Indexed);
            encoder.set_palette(colors.iter().flat_map(|c| [c.r, c.g, c.b]).collect::<Vec<u8>>());
            encoder.write_header().expect("a header").write_image_data(&pixels).expect("a picture");
            wrong.push(path);
            continue;
        }
        let expected = read(&path);
        for kernel in Kernel::available() {
            let actual = frame(scene, kernel);
            if actual != expected {
                let shown = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{}.png", kernel.name()));
                side_by_side(&shown, &expected, &actual);
                wrong.push(shown);
            }
            tried.add(1);
        }
    }
    assert!(wrong.is_empty(), "frames that differ from their golden ones, or were written anew: {wrong:#?}");
}

#[test]
fn golden_frames() {
    let mut tried = Tried::new("golden_frames", 9);
    let mut all: Vec<(&str, Rung)> = shapes::NAMES.iter().map(|&name| (name, Rung::default())).collect();
    all.extend([("torus", Rung::Flat), ("torus", Rung::Gouraud88)]);
    let scenes: Vec<_> = all.into_iter().map(|(name, rung)| (format!("{name}-{rung}"), shape(name, rung))).collect();
    compare(&mut tried, &scenes);
}

/// Grass, bricks and glazed tiles, each in its own colours, from three sides; and once in the nearest entries of the
/// cube, and in ramps that know nothing of them.
#[cfg(all(feature = "obj", feature = "image"))]
#[test]
fn golden_frames_of_a_house() {
    use mode13h::light::Light;
    use mode13h::mesh::obj;
    use mode13h::palette::Palette;
    use mode13h::palette::cube::CUBE;
    use mode13h::render::automatic;
    use mode13h::scene::{Camera, Motion, Object, Shared};

    let mut tried = Tried::new("golden_frames_of_a_house", 5);
    let loaded = obj::load(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/house.obj")).expect("a model");
    let mut object = Object::new(loaded.mesh).centred();
    let surfaces = object.mesh().surfaces().to_vec();
    for (material, surface) in object.materials.iter_mut().zip(&surfaces) {
        if let Some(path) = &surface.texture {
            let map = Shared::new(mode13h::texture::load(path).expect("a picture"));
            *material = material.clone().with_map(surface, &map);
        }
    }
    let mut house = Scene::new();
    house.camera = Camera::framing(object.pivot * 0.0, object.mesh().bounds().radius * 0.8);
    house.add_light(Light::sun([0.4, 0.6, 1.0]));
    let id = house.add(object);
    house.motions.push(Motion::Spin { object: id, start: [0.35, 0.0, 0.0], turns: [0.0, 0.25, 0.0] });

    let mut auto = house.clone();
    automatic(&house).expect("a scene").apply(&mut auto);
    let in_palette = |palette: &Palette| {
        let mut scene = house.clone();
        scene.palette = Some(palette.clone());
        scene
    };
    let mut in_cube = in_palette(&CUBE);
    in_cube.wishes.dither = true;
    for (material, surface) in in_cube[id].materials.iter_mut().zip(&surfaces) {
        *material = material.in_own_colors(surface);
    }
    let in_ramps = in_palette(&builtin::MATERIALS_8X32);
    // A round takes four seconds.
    let at = |mut scene: Scene, degrees: f64| {
        scene.set_time(degrees / 90.0);
        scene
    };
    let scenes = [
        ("house-auto-20".to_string(), at(auto.clone(), 20.0)),
        ("house-auto-70".to_string(), at(auto.clone(), 70.0)),
        ("house-auto-200".to_string(), at(auto, 200.0)),
        ("house-cube-20".to_string(), at(in_cube, 20.0)),
        ("house-materials-8x32-20".to_string(), at(in_ramps, 20.0)),
    ];
    compare(&mut tried, &scenes);
}
