//! Looks: the settings that a name stands for, and that explicit settings take precedence.

use std::collections::BTreeSet;

use mode13h::palette::Rgb;
use mode13h_assets::look::{Look, LookColors};

use crate::folder::{Folder, Png};

/// The picture that `render` makes with these arguments.
fn picture(folder: &Folder, words: &str) -> Png {
    Png::decode(&folder.picture(words))
}

/// The colours of a picture.
fn colors(png: &Png) -> BTreeSet<Rgb> {
    png.colors().into_iter().collect()
}

#[test]
fn looks_of_few_colours_show_no_others() {
    let folder = Folder::new();
    for (look, least) in [(Look::GameBoy, 4), (Look::Cga, 3), (Look::Pico8, 6)] {
        let LookColors::Palette(palette) = look.colors() else { panic!("{look}") };
        let legal: BTreeSet<Rgb> = palette.on_dac().colors().iter().copied().collect();
        for scene in ["torus", "crate", "mirror", "fog", "glenz"] {
            let shown = colors(&picture(&folder, &format!("{scene} --look {look}")));
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
    let folder = Folder::new();
    let levels: BTreeSet<u8> = (0..32).map(|five: u8| Rgb::new(five << 3 | five >> 2, 0, 0).on_dac().r).collect();
    for scene in ["torus", "crate", "rgb"] {
        let shown = colors(&picture(&folder, &format!("{scene} --look ps1")));
        assert!(shown.len() > 16, "{scene}: {}", shown.len());
        assert!(shown.iter().all(|c| [c.r, c.g, c.b].iter().all(|level| levels.contains(level))), "{scene}: {shown:?}");
    }
    let plain = colors(&picture(&folder, "crate"));
    assert!(!plain.iter().all(|color| levels.contains(&color.r)));
}

/// A look equals the options that it stands for, and each of these options overrides it.
#[test]
fn options_come_before_the_look() {
    let folder = Folder::new();
    let same = |a: &str, b: &str| assert!(picture(&folder, a) == picture(&folder, b), "{a:?} {b:?}");
    // An automatic palette would depend on how the scene is drawn.
    let plain = "crate --palette cube";
    let look = format!("{plain} --look vga");
    same(&look, &format!("{plain} --mapping affine --no-mipmaps --vertex-bits 0"));
    let own = "--mapping perspective --mipmaps --vertex-bits 8";
    same(&format!("{look} {own}"), &format!("{plain} {own}"));
    assert!(picture(&folder, &look) != picture(&folder, plain));
    let grey = colors(&picture(&folder, "crate --look gameboy --palette grey"));
    assert!(grey.len() > 4 && grey.iter().all(|color| color.r == color.g && color.g == color.b), "{grey:?}");
    let [plain, dithered] = ["--no-dither", ""].map(|word| {
        let pixels = picture(&folder, &format!("torus --look gameboy {word}")).pixels;
        // How often a pixel differs from its left neighbour.
        pixels.chunks_exact(320).flat_map(|row| row.windows(2)).filter(|two| two[0] != two[1]).count()
    });
    assert!(dithered > 2 * plain, "{dithered} {plain}");
}

#[test]
fn a_scene_has_a_look_and_its_own_keys_come_before_it() {
    let folder = Folder::new();
    // The picture of a scene with these keys, drawn with these arguments.
    let scene = |top: &str, render: &str, words: &str| {
        let text = format!(
            "{top}\n[render]\n{render}\n[[objects]]\nshape = 'cube'\nangles = [20, 30, 0]\nmaterial.texture = 'crate'\n\
             [[lights]]\nsun = [0.4, 0.6, 1]\n"
        );
        folder.put("scene.toml", text);
        picture(&folder, &format!("scene.toml {words}"))
    };
    for look in Look::ALL {
        assert!(scene(&format!("look = '{look}'"), "", "") == scene("", "", &format!("--look {look}")), "{look}");
    }
    assert!(colors(&scene("look = 'cga'\npalette = 'cube'", "", "")).len() > 4);
    assert!(scene("look = 'ps1'", "dither = false", "") == scene("look = 'ps1'", "", "--no-dither"));
    let exact = scene("look = 'cga'", "vertex-bits = 8\nmapping = 'perspective'", "");
    assert!(exact == scene("look = 'cga'", "", "--vertex-bits 8 --mapping perspective"));
    // A look on the command line replaces the scene's.
    for look in Look::ALL {
        assert!(scene("look = 'cga'", "", &format!("--look {look}")) == scene(&format!("look = '{look}'"), "", ""));
    }
}

/// An automatic palette has colours for all sides of a scene that the camera circles, and for nothing else if it does not.
#[test]
fn a_palette_has_colours_for_all_sides() {
    let folder = Folder::new();
    let sphere = |side: f32, color| {
        format!("[[objects]]\nshape = 'sphere'\nposition = [0, 0, {side}]\nscale = 2\nmaterial.color = '{color}'\n")
    };
    let light = "palette = 'auto'\ncamera = { eye = [0, 0, 8] }\nlights = [{ sun = [0, 1, 0.2], color = '#ffffe0' }]\n";
    folder.put("sides.toml", [light, &sphere(1.0, "#ff0000"), &sphere(-3.0, "#00ff00")].concat());
    let is_green = |color: &Rgb| color.g > color.r;
    let sides = |words: &str| picture(&folder, &format!("sides.toml {words}"));
    assert!(sides("--turn 180").colors().iter().filter(|color| is_green(color)).count() > 10_000);
    assert!(sides("--turn 0").palette.iter().any(is_green) && !sides("").palette.iter().any(is_green));
}

/// An object whose colour comes only from its ramp keeps it in a palette without ramps.
#[test]
fn the_colour_of_a_ramp_is_kept() {
    let folder = Folder::new();
    let text =
        "palette = 'materials-4x64'\n[[objects]]\nshape = 'cube'\nmaterial.ramp = 2\n[[lights]]\nsun = [0, 0, 1]\n";
    folder.put("jade.toml", text);
    let Rgb { r, g, b } = picture(&folder, "jade.toml --palette bios --no-dither").colors()[100 * 320 + 160];
    assert!(g > r && g > b && b > r, "{r} {g} {b}");
}
