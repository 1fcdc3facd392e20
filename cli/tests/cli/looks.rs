//! Looks: what a name sets, and that what is said otherwise comes first.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use mode13h::palette::Rgb;
use mode13h_assets::look::{Look, LookColors};
use tempfile::TempDir;

/// The pixels and the palette of a picture that `render` makes with these words.
fn picture(folder: &TempDir, words: &[&str]) -> (Vec<u8>, Vec<Rgb>) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mode13h"));
    command.current_dir(folder).env_remove("MODE13H_KERNEL").args(["render", "-o", "picture.png"]).args(words);
    let output = command.output().expect("started");
    assert!(output.status.success() && output.stderr.is_empty(), "{words:?}: {output:?}");
    decoded(&folder.path().join("picture.png"))
}

fn decoded(path: &Path) -> (Vec<u8>, Vec<Rgb>) {
    let file = std::io::BufReader::new(fs::File::open(path).expect("a file"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("its size")];
    reader.next_frame(&mut pixels).expect("an image");
    let palette = reader.info().palette.as_deref().expect("a palette");
    (pixels, palette.chunks_exact(3).map(|c| Rgb::new(c[0], c[1], c[2])).collect())
}

/// The colours that a picture has.
fn colors((pixels, palette): &(Vec<u8>, Vec<Rgb>)) -> BTreeSet<Rgb> {
    pixels.iter().map(|&index| palette[usize::from(index)]).collect()
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a folder")
}

#[test]
fn looks_of_few_colours_show_no_others() {
    let folder = folder();
    for (look, least) in [(Look::GameBoy, 4), (Look::Cga, 3), (Look::Pico8, 6)] {
        let LookColors::Palette(palette) = look.colors() else { panic!("{look}") };
        let legal: BTreeSet<Rgb> = palette.on_dac().colors().iter().copied().collect();
        for scene in ["torus", "crate", "mirror", "fog", "glenz"] {
            let shown = colors(&picture(&folder, &[scene, "--look", look.name()]));
            assert!(shown.is_subset(&legal), "{look}, {scene}: {shown:?}");
            if scene == "crate" {
                assert!(shown.len() >= least, "{look}: {shown:?}");
            }
        }
    }
}

/// The colours of `ps1` are some of the 32,768 of 5 bits, as the DAC has them.
#[test]
fn the_colours_of_ps1_have_five_bits() {
    let folder = folder();
    let levels: BTreeSet<u8> = (0..32).map(|five: u8| Rgb::new(five << 3 | five >> 2, 0, 0).on_dac().r).collect();
    for scene in ["torus", "crate", "rgb"] {
        let shown = colors(&picture(&folder, &[scene, "--look", "ps1"]));
        assert!(shown.len() > 16, "{scene}: {}", shown.len());
        assert!(shown.iter().all(|c| [c.r, c.g, c.b].iter().all(|level| levels.contains(level))), "{scene}: {shown:?}");
    }
    let plain = colors(&picture(&folder, &["crate"]));
    assert!(!plain.iter().all(|color| levels.contains(&color.r)));
}

/// A look is what its options are, and each of them comes first.
#[test]
fn options_come_before_the_look() {
    let folder = folder();
    let same = |a: &[&str], b: &[&str]| assert!(picture(&folder, a) == picture(&folder, b), "{a:?} {b:?}");
    // A palette that is made for what is seen would depend on how that is drawn.
    let plain = ["crate", "--palette", "cube"];
    let look = [&plain[..], &["--look", "vga"]].concat();
    let spelt_out = [&plain[..], &["--mapping", "affine", "--no-mipmaps", "--vertex-bits", "0"]].concat();
    same(&look, &spelt_out);
    let own = ["--mapping", "perspective", "--mipmaps", "--vertex-bits", "8"];
    same(&[&look[..], &own].concat(), &[&plain[..], &own].concat());
    assert!(picture(&folder, &look) != picture(&folder, &plain));
    let grey = colors(&picture(&folder, &["crate", "--look", "gameboy", "--palette", "grey"]));
    assert!(grey.len() > 4 && grey.iter().all(|color| color.r == color.g && color.g == color.b), "{grey:?}");
    let [plain, dithered] = [&["--no-dither"][..], &[]].map(|word| {
        let words = [&["torus", "--look", "gameboy"][..], word].concat();
        let (pixels, _) = picture(&folder, &words);
        // How often a pixel differs from its left neighbour.
        pixels.chunks_exact(320).flat_map(|row| row.windows(2)).filter(|two| two[0] != two[1]).count()
    });
    assert!(dithered > 2 * plain, "{dithered} {plain}");
}

#[test]
fn a_scene_has_a_look_and_its_own_keys_come_before_it() {
    let folder = folder();
    let scene = |top: &str, render: &str| {
        let text = format!(
            "{top}\n[render]\n{render}\n[[objects]]\nshape = 'cube'\nangles = [20, 30, 0]\nmaterial.texture = 'crate'\n\
             [[lights]]\nsun = [0.4, 0.6, 1]\n"
        );
        fs::write(folder.path().join("scene.toml"), text).expect("written");
        "scene.toml"
    };
    for look in Look::ALL {
        let key = picture(&folder, &[scene(&format!("look = '{look}'"), "")]);
        assert!(key == picture(&folder, &[scene("", ""), "--look", look.name()]), "{look}");
    }
    let with_palette = picture(&folder, &[scene("look = 'cga'\npalette = 'cube'", "")]);
    assert!(colors(&with_palette).len() > 4);
    let plain = picture(&folder, &[scene("look = 'ps1'", "dither = false")]);
    assert!(plain == picture(&folder, &[scene("look = 'ps1'", ""), "--no-dither"]));
    let exact = picture(&folder, &[scene("look = 'cga'", "vertex-bits = 8\nmapping = 'perspective'")]);
    let options = ["--vertex-bits", "8", "--mapping", "perspective"];
    assert!(exact == picture(&folder, &[&[scene("look = 'cga'", "")], &options[..]].concat()));
    // An option's look comes before the scene's.
    let other = picture(&folder, &[scene("look = 'cga'", ""), "--look", "gameboy"]);
    assert!(other == picture(&folder, &[scene("look = 'gameboy'", "")]));
}

/// A body whose colour lies in its ramp alone keeps it where a palette has no ramps.
#[test]
fn the_colour_of_a_ramp_is_kept() {
    let folder = folder();
    let text =
        "palette = 'materials-4x64'\n[[objects]]\nshape = 'cube'\nmaterial.ramp = 2\n[[lights]]\nsun = [0, 0, 1]\n";
    fs::write(folder.path().join("jade.toml"), text).expect("written");
    let (pixels, palette) = picture(&folder, &["jade.toml", "--palette", "bios", "--no-dither"]);
    let Rgb { r, g, b } = palette[usize::from(pixels[100 * 320 + 160])];
    assert!(g > r && g > b && b > r, "{r} {g} {b}");
}
