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

fn frame(name: &str, rung: Rung, kernel: Kernel) -> Indexed {
    let mut scene = Scene::showing(shapes::by_name(name).expect("listed"));
    scene.palette = Some(builtin::COPPER.clone());
    scene.objects_mut()[0].set_angles([0.5, 0.7, 0.1]);
    let mut renderer = Renderer::new();
    renderer.set_rung(rung);
    renderer.set_kernel(kernel);
    let mut vga = Vga::new();
    renderer.draw(&scene, &mut vga).expect("a legal scene");
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

#[test]
fn golden_frames() {
    let mut tried = Tried::new("golden_frames", 9);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    let mut all: Vec<(&str, Rung)> = shapes::NAMES.iter().map(|&name| (name, Rung::default())).collect();
    all.extend([("torus", Rung::Flat), ("torus", Rung::Gouraud88)]);
    let mut wrong: Vec<PathBuf> = Vec::new();
    for (name, rung) in all {
        let path = folder.join(format!("{name}-{rung}.png"));
        if std::env::var_os("MODE13H_WRITE_GOLDEN").is_some() {
            let Indexed { pixels, colors } = frame(name, rung, Kernel::PORTABLE);
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
            let actual = frame(name, rung, kernel);
            if actual != expected {
                let shown = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{rung}-{}.png", kernel.name()));
                side_by_side(&shown, &expected, &actual);
                wrong.push(shown);
            }
            tried.add(1);
        }
    }
    assert!(wrong.is_empty(), "frames that differ from their golden ones, or were written anew: {wrong:#?}");
}
