//! Golden frames: indexed PNGs, compared by index and by palette.
//!
//! Integer results are the same bits on every machine, and the floats before them keep to rules that
//! make them so (ARCHITECTURE.md): a frame that differs is a change of the engine's bytes, which
//! belongs into CHANGELOG.md. With `MODE13H_WRITE_GOLDEN=1` they are regenerated, drawn by the portable
//! kernel, and the test fails.

use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use mode13h::palette::Rgb;
use mode13h::span::Kernel;
use mode13h::vga::Vga;

use super::picture::Png;
use super::tried::Tried;

/// What a golden frame holds.
#[derive(PartialEq, Eq)]
pub struct Indexed {
    pub pixels: Vec<u8>,
    pub colors: Vec<Rgb>,
}

impl Indexed {
    /// What a machine shows.
    pub fn of(vga: &Vga) -> Self {
        Self { pixels: vga.pixels().to_vec(), colors: vga.palette().colors().to_vec() }
    }
}

/// Compares the frame that each kernel draws with the golden one, `tests/golden/<name>.png`. Returns the pictures to
/// look at, of frames that differ or were regenerated.
pub fn check(name: &str, tried: &mut Tried, mut frame: impl FnMut(Kernel) -> Indexed) -> Vec<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(format!("{name}.png"));
    if std::env::var_os("MODE13H_WRITE_GOLDEN").is_some() {
        let Indexed { pixels, colors } = frame(Kernel::PORTABLE);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        let mut encoder = png::Encoder::new(BufWriter::new(File::create(&path).expect("a file")), 320, 200);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(colors.iter().flat_map(|c| [c.r, c.g, c.b]).collect::<Vec<u8>>());
        encoder.write_header().expect("a header").write_image_data(&pixels).expect("a picture");
        tried.add(1);
        return vec![path];
    }
    let expected = read(&path);
    let mut wrong = Vec::new();
    for kernel in Kernel::available() {
        let actual = frame(kernel);
        if actual != expected {
            let shown = format!("{}-{}.png", name.replace('/', "-"), kernel.name());
            let shown = Path::new(env!("CARGO_TARGET_TMPDIR")).join(shown);
            side_by_side(&shown, &expected, &actual);
            wrong.push(shown);
        }
        tried.add(1);
    }
    wrong
}

/// Reads a picture that holds a frame.
pub fn read(path: &Path) -> Indexed {
    let Png { size, kind, pixels, palette: colors, .. } =
        Png::decode(&fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())));
    assert_eq!((kind, size), (png::ColorType::Indexed, (320, 200)));
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
