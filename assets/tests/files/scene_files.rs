//! Scene files: the scene contains what they say, and errors are reported with line, column and key.

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, BufRead, Cursor};
use std::path::Path as FilePath;

use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::{Blend, Light, RampChoice};
use mode13h::palette::{Ramp, Rgb, builtin};
use mode13h::render::Renderer;
use mode13h::scene::{Motion, Moving, PaletteAnimation, Path, Scene, UpAxis};
use mode13h::settings::Accuracy;
use mode13h::settings::{DitherPattern, HiddenSurfaces, Mapping, Shading};
use mode13h::vga::Vga;
use mode13h_assets::SceneExt;
use mode13h_assets::scene_file::{self, LONGEST, Loaded, Place, SceneError, SceneErrorKind};

use crate::gltf_files::picture;
use crate::support::tried::Tried;

const TRIANGLE: &str = "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl tin\nf 1 2 3\nusemtl oak\nf 3 2 1\n";

/// The files beside the scenes of these tests, in the folder `folder`.
fn open(path: &FilePath) -> io::Result<Box<dyn BufRead>> {
    let files: BTreeMap<&str, &[u8]> = BTreeMap::from([
        ("folder/triangle.obj", TRIANGLE.as_bytes()),
        ("folder/broken.obj", &b"v 0 0 0\nf 1 2 3\n"[..]),
        ("folder/with_texture.obj", b"mtllib it.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl tin\nf 1/1 2/1 3/1\n"),
        ("folder/bent.obj", b"v 0 0 0\nv 0 0 2\nv 2 0 0\nv 2 0 2\nv 2 2 0\nv 2 2 2\nf 1 2 4 3\nf 3 4 6 5\n"),
        ("folder/far_west.obj", b"v 4500000.125 7 0\nv 4500001.125 7 0\nv 4500000.125 8 0\nf 1 2 3\n"),
        ("folder/far_east.obj", b"v 4500003.375 7 0\nv 4500005.375 7 0\nv 4500003.375 9 0\nf 1 2 3\n"),
        ("folder/dull.obj", b"mtllib dull.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl dull\nf 1 2 3\n"),
        ("folder/dull.mtl", b"newmtl dull\nKs 1 1 1\n"),
        ("folder/two.mtl", b"newmtl tin\nnewmtl oak\n"),
        ("folder/it.mtl", b"newmtl tin\nmap_Kd none.png\n"),
        ("folder/broken.pal", b"JASC-PAL\r\n0100\r\n2\r\n0 0 0\r\nred 0 0\r\n"),
        ("folder/two.hex", b"102030\nffffff\n"),
        ("folder/broken.png", b"\x89PNG"),
        ("folder/scene.toml", b"objects = [{ model = 'scene.toml' }]"),
    ]);
    match files.get(path.to_str().expect("text")) {
        Some(bytes) => Ok(Box::new(Cursor::new(bytes.to_vec()))),
        None => Err(io::ErrorKind::NotFound.into()),
    }
}

fn loaded(text: &str) -> Result<Loaded, SceneError> {
    Scene::from_toml(text, "folder/scene.toml", open)
}

#[track_caller]
fn scene(text: &str) -> Scene {
    match loaded(text) {
        Ok(Loaded { scene, warnings, .. }) => {
            assert!(warnings.is_empty(), "{warnings:?}");
            scene
        }
        Err(error) => panic!("{error}"),
    }
}

/// A cube, for scenes whose objects do not matter, on one line.
const CUBE: &str = "objects = [{ shape = 'cube' }]\n";

/// Two models of one map, each read relative to its own centre: with a common pivot they stand as on the map.
#[test]
fn a_pivot_is_a_point_of_the_file_even_far_from_0() {
    for (scale, factors) in [("1", Vec3::ONE), ("[1, 2, 3]", Vec3::new(1.0, 2.0, 3.0))] {
        let text: String = ["west", "east"]
            .map(|name| format!("[[objects]]\nmodel = 'far_{name}.obj'\npivot = [4500000, 7, 0]\nscale = {scale}\n"))
            .concat();
        let Loaded { scene, warnings, .. } = loaded(&text).expect("a scene");
        assert_eq!(warnings.len(), 2, "{warnings:?}");
        let corners = scene.objects().iter().map(|object| object.mesh().positions()[0] - object.pivot);
        let right = [Vec3::new(0.125, 0.0, 0.0), Vec3::new(3.375, 0.0, 0.0)].map(|corner| corner * factors);
        assert_eq!(corners.collect::<Vec<_>>(), right);
    }
}

#[test]
fn f3_broken_scenes_are_one_line_with_line_column_and_key() {
    let mut tried = Tried::new("f3_broken_scenes_are_one_line_with_line_column_and_key", 90);
    // Each with the part of the scene that it is about: the keys in the messages below begin there.
    let list = |text: &str| (text.to_string(), "");
    let cube = |text: &str| (format!("{CUBE}{text}"), "");
    let object = |text: &str| (format!("[[objects]]\nshape = 'cube'\n{text}"), "objects[0]");
    let inline = |text: &str| (format!("objects = [{{ {text} }}]"), "objects[0]");
    let model = |text: &str| (format!("[[objects]]\nmodel = {text}"), "objects[0]");
    let material = |text: &str| (format!("[[objects]]\nshape = 'cube'\nmaterial.{text}"), "objects[0].material");
    let render = |text: &str| (format!("{CUBE}render.{text}"), "render");
    let cone = |text: &str| (format!("{CUBE}[[lights]]\nlamp = [1, 1, 1]\nrange = 5\n{text}"), "lights[0]");
    let light = |text: &str| (format!("{CUBE}[[lights]]\n{text}"), "lights[0]");
    let path = |text: &str| (format!("[[objects]]\nshape = 'cube'\npath = {text}"), "objects[0].path");
    let mut wrong = String::new();
    for ((text, part), says) in [
        // Unknown keys, in every table.
        (cube("fogg = 1"), "2:1: `fogg`: unknown key; known are name, duration, ambient, background, palette, "),
        (cube("[camera]\neyes = [0, 0, 1]"), "3:1: `camera.eyes`: unknown key; known are eye, target, from, up, "),
        (object("colour = 1"), "3:1: `.colour`: unknown key; known are name, shape, subdivisions, "),
        (
            object("material = { ramp = 0, shyness = 3 }"),
            "3:24: `.material.shyness`: unknown key; known are ambient, diffuse, specular, shininess, ",
        ),
        (
            list("[[objects]]\nshape = 'cube'\n\n[[objects]]\nshape = 'cone'\n[objects.material]\nshyness = 3"),
            "7:1: `objects[1].material.shyness`: unknown key",
        ),
        (material("ramp.last = 3"), "3:15: `.ramp.last`: unknown key; known are first, "),
        (light("lamb = [0, 0, 1]"), "3:1: `.lamb`: unknown key; known are sun, lamp, range, "),
        (path("{ lines = 1 }"), "3:10: `.lines`: unknown key; known are line, back, circle, rounds"),
        (path("{ circle = { middle = 1 } }"), "`.circle.middle`: unknown key; known are centre, "),
        (cube("fog.begin = 1"), "2:5: `fog.begin`: unknown key; known are color, start, end"),
        (cube("animation = { to = 1 }"), "2:15: `animation.to`: unknown key; known are fade, cycle, rounds"),
        (render("hidden_surfaces = 1"), "2:8: `.hidden_surfaces`: unknown key; known are shading, hidden-"),
        (cube("\"`, expected one of `a`\" = 1"), "2:1: ``, expected one of `a``: unknown key; known are name, "),
        // Wrong types.
        (list("name = 7"), "1:8: `name`: expected a string, found integer `7`"),
        (list("objects = 7"), "1:11: `objects`: expected a sequence, found integer `7`"),
        (list("objects = [7]"), "1:12: `objects[0]`: expected a table, found integer `7`"),
        (list("objects = ['cube']"), "1:12: `objects[0]`: expected a table, found string \"cube\""),
        (cube("camera = []"), "2:10: `camera`: "),
        (cube("fog = true"), "2:7: `fog`: expected a table, found boolean `true`"),
        (object("position = 'here'"), "3:12: `.position`: expected a list of 3 numbers, found string \"here\""),
        (object("position = [1, 2]"), "3:12: `.position`: expected a list of 3 numbers, found 2"),
        (object("position = [1, 2, 3, 4]"), "3:12: `.position`: expected a list of 3 numbers, found 4"),
        (object("position = [1, '2', 3]"), "3:16: `.position[1]`: expected a finite number, found string \"2\""),
        (object("scale = true"), "3:9: `.scale`: expected a number above 0, or three in a list, found boolean `true`"),
        (
            object("subdivisions = 1.5"),
            "3:16: `.subdivisions`: expected a whole number, or two in a list, found floati",
        ),
        (object("material = 'copper'"), "3:12: `.material`: expected a table, found string \"copper\""),
        (material("color = 7"), "3:18: `.color`: expected a colour: \"#rrggbb\", or red, green and blue f"),
        (material("blend = []"), "3:18: `.blend`: expected \"opaque\", \"add\", or how opaque it is, a numb"),
        (
            cube("duration = 99999999999999999999"),
            "2:12: `duration`: expected a number of seconds above 0, at most 3600, found 99999999999999999999",
        ),
        (
            cube("duration = 1979-05-27"),
            "2:12: `duration`: expected a number of seconds above 0, at most 3600, found map",
        ),
        (cube("render = { shading = 3 }"), "2:22: `render.shading`: expected a name in quotes, found integer `3`"),
        (
            render("dither = 'yes'"),
            "2:17: `.dither`: \"yes\": unknown dither pattern; there are ordered, blue-noise, ps1",
        ),
        (render("dither = 1"), "2:17: `.dither`: expected true, false, or a name in quotes, found integer `1`"),
        (cube("look = 'nes'"), "2:8: `look`: \"nes\": unknown look; there are ps1, vga, gameboy, cga, pico8"),
        (
            render("vertex-bits = 9"),
            "2:22: `.vertex-bits`: expected a number of bits, a whole number from 0 to 8, found 9",
        ),
        // Spot lights.
        (cone("direction = [0, -1, 0]"), "`.direction`: a cone needs an `outer` angle"),
        (cone("outer = 20"), "`.outer`: a cone needs a `direction`"),
        (cone("inner = 20"), "`.inner`: a cone needs a `direction`"),
        (cone("direction = [0, 0, 0]\nouter = 20"), "`.direction`: a direction must not be zero"),
        (cone("direction = [0, 1, 0]\nouter = 0"), "`.outer`: a cone's outer angle must be above 0"),
        (cone("direction = [0, 1, 0]\nouter = 91"), "`.outer`: expected a number of degrees from 0 to 90"),
        (
            cone("direction = [0, 1, 0]\nouter = 20\ninner = 30"),
            "`.inner`: a cone's inner angle must be at most its outer one",
        ),
        (cube("[[lights]]\nsun = [0, 1, 0]\ndirection = [0, 1, 0]"), "`lights[0].direction`: only a lamp has a cone"),
        (cube("[[lights]]\nsun = [0, 1, 0]\nouter = 20"), "`lights[0].outer`: only a lamp has a cone"),
        // Out of range.
        (cube("duration = 0"), "2:12: `duration`: expected a number of seconds above 0, at most 3600, found 0"),
        (cube("duration = nan"), "2:12: `duration`: expected a number of seconds above 0, at most 3600, found NaN"),
        (cube("ambient = -0.5"), "2:11: `ambient`: expected a number of at least 0, found -0.5"),
        (cube("ambient = 1e39"), "2:11: `ambient`: expected a number of at least 0, found 1e39"),
        (cube("ambient = 1e999"), "2:11: `ambient`: "),
        (
            cube("background = 256"),
            "2:14: `background`: expected a palette entry, a whole number from 0 to 255, found 256",
        ),
        (
            cube("background = '#12345'"),
            "2:14: `background`: expected a colour: \"#rrggbb\", or red, green and blue from 0 to 1 in a",
        ),
        (
            cube("background = '#+12345'"),
            "2:14: `background`: expected a colour: \"#rrggbb\", or red, green and blue from 0 to 1 in a",
        ),
        (cube("background = [0, 2, 0]"), "2:18: `background[1]`: expected a number from 0 to 1, found 2"),
        (object("scale = 0"), "3:9: `.scale`: expected a number above 0, found 0"),
        (object("scale = [1, 1e-50, 1]"), "3:13: `.scale[1]`: expected a number above 0, found 1e-50"),
        (object("position = [0, inf, 0]"), "3:16: `.position[1]`: expected a finite number, found inf"),
        (material("diffuse = 1.1"), "3:20: `.diffuse`: expected a number from 0 to 1, found 1.1"),
        (material("shininess = -1"), "3:22: `.shininess`: expected a number from 0 to 1000, found -1"),
        (material("ramp = -1"), "3:17: `.ramp`: expected the number of a ramp, 0 to 255, or { first = "),
        (
            material("ramp = { first = 1.5, entries = 2 }"),
            "3:27: `.ramp.first`: expected a palette entry, a whole number from 0 ",
        ),
        (
            material("ramp = { first = 200, entries = 57 }"),
            "3:17: `.ramp`: 57 entries starting at 200 run past entry 255",
        ),
        (material("ramp = { first = 200 }"), "3:17: `.ramp.entries`: missing"),
        (material("blend = 2"), "3:18: `.blend`: expected \"opaque\", \"add\", or how opaque it is, a numb"),
        (object("subdivisions = 4"), "3:16: `.subdivisions`: a cube has no subdivisions"),
        (
            inline("shape = 'torus', subdivisions = 4"),
            "1:46: `.subdivisions`: a torus has 2 subdivisions: around the axis, around the tube",
        ),
        (
            inline("shape = 'torus', subdivisions = [48, 2]"),
            "1:46: `.subdivisions`: 2 around the tube; a torus can have 3 to 4096",
        ),
        (
            inline("shape = 'wall', subdivisions = [5000, 1]"),
            "1:45: `.subdivisions`: 5000 columns; a wall can have 1 to 4096",
        ),
        (
            inline("shape = 'teapot', subdivisions = 9223372036854775807"),
            "`.subdivisions`: 9223372036854775807 segments; a teapot can have 2 to 512",
        ),
        (
            inline("shape = 'torus', subdivisions = [4096, 4096]"),
            "1:46: `.subdivisions`: more than 65536 triangles in the shapes of a scene",
        ),
        (
            list(&format!("objects = [{{ shape = 'teapot', positions = [{}] }}]", "[0, 0, 0],".repeat(17))),
            "1:12: `objects[0]`: more than 65536 triangles in the shapes of a scene",
        ),
        (
            cube("camera.field-of-view = 180"),
            "2:24: `camera.field-of-view`: expected a number of degrees from 1 to 179, found 180",
        ),
        (cube("camera.near = 0"), "2:15: `camera.near`: expected a number above 0, found 0"),
        (light("lamp = [0, 0, 1]\nrange = 0"), "4:9: `.range`: expected a number above 0, found 0"),
        (light("sun = [0, 0, 0.0]"), "3:7: `.sun`: a direction must not be zero"),
        (
            path("{ line = [[0, 0, 0], [1, 0, 0]], rounds = 0 }"),
            "3:50: `.rounds`: expected a number other than 0, from -1000 to 1000, found 0",
        ),
        (path("{ line = [[0, 0, 0]] }"), "3:17: `.line`: expected a list of 2 points, found 1"),
        (cube("fog = { start = 2, end = 2 }"), "2:26: `fog.end`: the fog must end farther away than it starts"),
        (cube("animation.cycle = [9, 8]"), "2:19: `animation.cycle`: the first entry is after the last"),
        (render("max-error = 0"), "2:20: `.max-error`: expected a number above 0, found 0"),
        // Unknown names.
        (inline("shape = 'toroid'"), "1:22: `.shape`: \"toroid\": unknown shape; there are "),
        (object("crease = 9"), "3:10: `.crease`: only a model has a crease angle"),
        (model("'bent.obj'\ncrease = 181"), "3:10: `.crease`: expected a number of degrees from 0 to 180, found 181"),
        (object("up-axis = 'x'"), "3:11: `.up-axis`: \"x\": unknown axis; there are y, z"),
        (material("blend = 'glass'"), "3:18: `.blend`: expected \"opaque\", \"add\", or how opaque it is, a numb"),
        (
            render("shading = 'best'"),
            "2:18: `.shading`: \"best\": unknown shading; there are flat, gouraud-vintage, gouraud-8.8, ",
        ),
        (render("mapping = 'best'"), "2:18: `.mapping`: \"best\": unknown mapping; there are affine, "),
        (render("hidden-surfaces = ''"), "`.hidden-surfaces`: \"\": unknown hidden-surface method; the"),
        (path("{ circle = { radius = 1, axis = 'w' } }"), "`.circle.axis`: \"w\": unknown axis; the"),
        (
            model("'triangle.obj'\nmaterials.iron.ramp = 1"),
            "3:11: `.materials.iron`: the object has no such material; it has tin, oak",
        ),
        (object("materials.iron.ramp = 1"), "3:11: `.materials.iron`: the object's only material has no "),
        // Missing or broken files.
        (model("'none.obj'"), "2:9: `.model`: folder/none.obj: entity not found"),
        (model("'broken.obj'"), "2:9: `.model`: folder/broken.obj:2: there is no vertex 2, only 1"),
        (model("'scene.toml'"), "2:9: `.model`: not a model that can be read: models are"),
        (model("''"), "2:9: `.model`: expected a name of 1 to 1000 characters, found string \"\""),
        (model("\"a\\nb\""), "2:9: `.model`: expected a name of 1 to 1000 characters, found string \"a\\nb\""),
        (cube("palette = 'none.pal'"), "2:11: `palette`: folder/none.pal: entity not found"),
        (cube("palette = 'broken.pal'"), "2:11: `palette`: folder/broken.pal: line 5: expected three numbers 0 to 25"),
        (cube("animation.fade = 'mauve'"), "2:18: `animation.fade`: folder/mauve: entity not found"),
        (material("environment = 'none.png'"), "`.environment`: folder/none.png: entity n"),
        (material("environment = 'broken.png'"), "`.environment`: folder/broken.png: "),
        (
            model("'triangle.obj'\nmaterial.texture = 'none.png'"),
            "3:20: `.material.texture`: the object has no texture coordinates",
        ),
        // Contradictory or missing keys.
        (list(""), "no object: a scene needs at least one [[objects]]"),
        (list("objects = []"), "no object: a scene needs at least one [[objects]]"),
        (list("[[objects]]\nname = 'none'"), "1:1: `objects[0]`: an object needs a `shape` or a `model`"),
        (object("model = 'triangle.obj'"), "3:9: `.model`: not allowed with a `shape`"),
        (object("position = [0, 0, 0]\npositions = [[0, 0, 0]]"), "4:13: `.positions`: not allowed with a `positi"),
        (
            object("position = [1, 0, 0]\npath = { line = [[0, 0, 0], [1, 0, 0]] }"),
            "3:12: `.position`: not allowed with a `path`, which says where the object is",
        ),
        (object("positions = []"), "3:13: `.positions`: at least one is needed"),
        (model("'triangle.obj'\nsubdivisions = 3"), "3:16: `.subdivisions`: only a s"),
        (light("intensity = 1"), "2:1: ``: a light is either a `sun` or a `lamp`"),
        (light("sun = [0, 0, 1]\nlamp = [0, 0, 1]"), "2:1: ``: a light is either a `sun` or a `lamp`"),
        (light("sun = [0, 0, 1]\nrange = 3"), "4:9: `.range`: only a lamp has a range"),
        (light("lamp = [0, 0, 1]"), "2:1: ``: a lamp needs a `range`: how far it reaches"),
        (path("{ rounds = 2 }"), "3:8: ``: a path is either a `line` or a `circle`"),
        (path("{ circle = { radius = 1 }, back = true }"), "3:42: `.back`: only a line can go back"),
        (path("{ circle = { radius = 1, from = [0, 0, 1] } }"), "3:19: `.circle`: a circle has eith"),
        (cube("fog.start = 2"), "2:1: `fog.end`: missing"),
        (cube("[fog]\nstart = 2"), "2:1: `fog.end`: missing"),
        (cube("animation.rounds = 2"), "2:1: `animation`: an animation is either a `fade` or a `cycle`"),
        (
            cube("camera = { eye = [0, 0, 1], from = [0, 0, 1] }"),
            "2:36: `camera.from`: not allowed with an `eye`, which says",
        ),
        (cube("camera = { eye = [0, 0, 0] }"), "2:10: `camera`: the camera looks at its own position"),
        (cube("camera = { up = [0, 0, 0] }"), "2:17: `camera.up`: a direction must not be zero"),
        (cube("camera = { from = [0, 0, 0] }"), "2:19: `camera.from`: a direction must not be zero"),
        (object("position = [3e38, 0, 0]\nscale = 3e38"), "the objects reach too far to be framed; give the camera"),
        // Not TOML.
        (list("name = \n"), "1:8: not TOML: "),
        (list("a = 1\nb = 2\na = 3\n"), "3:1: `a`: not TOML: duplicate key"),
        (list("[[objects]\nshape = 'cube'"), "1:11: not TOML: "),
        (list("name = \"\u{1F9CA}\" x"), "1:12: not TOML: "),
        (list(&"[".repeat(100_000)), "not TOML: "),
        (list("\u{0}"), "1:2: not TOML: key with no value"),
    ] {
        let Err(error) = loaded(&text) else { panic!("{text} is a scene") };
        let said = error.to_string();
        assert!(!said.contains(char::is_control), "{said:?}");
        // After "12:9: ", or anywhere if the position does not matter.
        let said = said.strip_prefix("folder/scene.toml:").expect("the file's name");
        let says = &says.replacen('`', &format!("key `{part}"), 1);
        let placed = says.starts_with(|c: char| c.is_ascii_digit());
        if !(if placed { said.starts_with(says) } else { said.contains(says) }) {
            wrong += &format!("{text:.100}\n    says: {said}\n    not:  {says}\n");
        }
        tried.add(1);
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn f3_what_is_no_text_or_too_long_is_refused() {
    let mut tried = Tried::new("f3_what_is_no_text_or_too_long_is_refused", 8);
    let of = |bytes: &[u8]| Scene::from_toml_bytes(bytes, "a.toml", open).expect_err("no scene");
    let error = of(b"name = '\xC3\xA9'\nname = '\xFF'");
    assert!(matches!(*error.kind, SceneErrorKind::NotText));
    assert_eq!(error.to_string(), "a.toml:2:9: not UTF-8 text");
    tried.add(1);
    assert_eq!(of(b"\xFF").place, Some(Place { line: 1, column: 1 }));
    tried.add(1);

    let longest = CUBE.to_owned() + &"#".repeat(LONGEST - CUBE.len());
    assert!(loaded(&longest).is_ok());
    tried.add(1);
    // A byte order mark is in no column.
    assert_eq!(of("\u{FEFF}objects = [{ shap = 'torus' }]".as_bytes()).place, Some(Place { line: 1, column: 14 }));
    tried.add(1);
    // A character that the limit cuts.
    let cut = [longest.as_bytes(), &[0xC3]].concat();
    assert!(matches!(*of(&cut).kind, SceneErrorKind::TooLong));
    tried.add(1);
    let error = loaded(&(longest.clone() + "#")).expect_err("too long");
    assert_eq!(error.to_string(), "folder/scene.toml: too long: a scene file may be at most 1 MiB");
    tried.add(1);

    // The same for files.
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("long.toml");
    fs::write(&path, &longest).expect("written");
    assert!(scene_file::load(&path).is_ok());
    tried.add(1);
    fs::write(&path, longest + "#").expect("written");
    assert!(matches!(*scene_file::load(&path).expect_err("too long").kind, SceneErrorKind::TooLong));
    tried.add(1);
}

#[test]
fn f3_files_that_are_missing_or_no_files() {
    let mut tried = Tried::new("f3_files_that_are_missing_or_no_files", 7);
    let directory = tempfile::tempdir().expect("a directory");
    let folder = directory.path();
    let said = |path: &FilePath| scene_file::load(path).expect_err("no scene").to_string();
    let none = folder.join("none.toml");
    assert!(said(&none).starts_with(&format!("{}: No such file", none.display())), "{}", said(&none));
    tried.add(1);
    assert_eq!(said(folder), format!("{}: is a directory", folder.display()));
    tried.add(1);

    // Files that a scene names are relative to it, wherever the program runs.
    let path = folder.join("scene.toml");
    fs::write(folder.join("triangle.obj"), TRIANGLE).expect("written");
    fs::write(&path, "[[objects]]\nmodel = 'triangle.obj'").expect("written");
    assert_eq!(scene_file::load(&path).expect("a scene").scene.objects()[0].mesh().triangles().len(), 2);
    tried.add(1);
    fs::create_dir(folder.join("directory.obj")).expect("made");
    for (text, says) in [
        ("[[objects]]\nmodel = 'none.obj'", "2:9: key `objects[0].model`: F/none.obj: No such file"),
        ("[[objects]]\nmodel = 'directory.obj'", "2:9: key `objects[0].model`: F/directory.obj: not a file"),
        ("palette = 'none.pal'\nobjects = [{ shape = 'cube' }]", "1:11: key `palette`: F/none.pal: No such file"),
        ("palette = '/dev/zero'\nobjects = [{ shape = 'cube' }]", "1:11: key `palette`: /dev/zero: not a file"),
    ] {
        if cfg!(not(unix)) && text.contains("/dev/zero") {
            continue;
        }
        fs::write(&path, text).expect("written");
        let expected = format!("{}:{}", path.display(), says.replace('F', &folder.display().to_string()));
        assert!(said(&path).starts_with(&expected), "{}\nnot {expected}", said(&path));
        tried.add(1);
    }
}

/// A scene with every key.
const EVERYTHING: &str = r##"
name = "everything"
duration = 8
picture = -2.5
ambient = 0.25
background = "#102030"
palette = "two.hex"
animation = { fade = "copper", rounds = 2 }
fog = { color = [0.2, 0.4, 0.6], start = 2, end = 9.5 }

[camera]
eye = [0, 1, 9]
target = [0, 1, 0]
up = [0, 0.5, 0]
field-of-view = 90
near = 0.5
eye-path = { line = [[0, 1, 9], [0, 1, 5]], back = true, rounds = 2 }
target-path = { circle = { centre = [0, 1, 0], from = [1, 0, 0], towards = [0, 2, 0] } }

[render]
shading = "phong"
hidden-surfaces = "scan-line"
mapping = "every-16"
tessellation = 1.5
dither = true
max-error = 2

[[objects]]
name = "bar"
shape = "wall"
subdivisions = [4, 2]
scale = [4, 2, 1]
angles = [90, 0, -45]
up-axis = "z"
pivot = [0.25, 0, 0]
spin = [1, 0, -2]
path = { line = [[1, 2, 3], [4, 5, 6]], rounds = -1 }
material = { ambient = 0.1, diffuse = 0.2, specular = 0.3, shininess = 40, ramp = { first = 64, entries = 32 }, color = "#ff8000", blend = 0.5 }

[[objects]]
model = "triangle.obj"
positions = [[1, 0, 0], [0, 1, 0]]
scale = 3
spin = 2
material = { ramp = 5 }
materials = { oak = { ramp = 7, blend = "add" } }

[[lights]]
sun = [0, 1, 0]
intensity = 2
color = "#00ff00"

[[lights]]
lamp = [1, 1, 1]
range = 5
path = { circle = { centre = [0, 1, 0], radius = 2, axis = "z", start = 90 }, rounds = -4 }
"##;

/// An error takes precedence over a shading.
#[test]
fn accuracy_is_one_choice() {
    let of = |render: &str| scene(&format!("objects = [{{ shape = 'cube' }}]\n[render]\n{render}")).settings.accuracy;
    assert_eq!(of(""), None);
    assert_eq!(of("shading = 'flat'"), Some(Shading::Flat.into()));
    assert_eq!(of("shading = 'flat'\nmax-error = 2"), Some(Accuracy::WithinError(2.0)));
}

#[test]
fn what_a_file_says_is_what_is_in_the_scene() {
    let scene = scene(EVERYTHING);
    assert_eq!((scene.name.as_str(), scene.duration, scene.ambient), ("everything", 8.0, 0.25));
    assert_eq!(scene.picture, -2.5);
    let palette = scene.palette.as_ref().expect("a palette");
    assert_eq!(palette[0], Rgb::new(0x10, 0x20, 0x30));
    assert_eq!((scene.background, scene.background_color), (0, Some(Rgb::new(0x10, 0x20, 0x30))));
    let copper = builtin::COPPER.clone();
    assert_eq!(scene.palette_animation, Some(PaletteAnimation::Fade { to: copper, period: 4.0 }));
    let fog = scene.fog.expect("fog");
    assert_eq!((fog.color, fog.start, fog.end), (Rgb::new(51, 102, 153), 2.0, 9.5));

    let camera = &scene.camera;
    assert_eq!((camera.eye, camera.target), (Vec3::new(0.0, 1.0, 9.0), Vec3::new(1.0, 1.0, 0.0)));
    assert_eq!((camera.up, camera.near), (Vec3::new(0.0, 0.5, 0.0), 0.5));
    assert_eq!(camera.field_of_view.to_radians() as f32, std::f32::consts::FRAC_PI_2);

    // An error takes precedence over a shading.
    assert_eq!(scene.settings.accuracy, Some(Accuracy::WithinError(2.0)));
    assert_eq!(scene.settings.hidden_surfaces, Some(HiddenSurfaces::ScanLine));
    assert_eq!(scene.settings.mapping, Some(Mapping::Every16));
    assert_eq!(scene.settings.tessellation, Some(1.5));
    assert!(scene.settings.dither == Some(DitherPattern::Ordered) && !scene.auto_palette);

    let [bar, first, second] = scene.objects() else { panic!("{} objects", scene.objects().len()) };
    assert_eq!((bar.name.as_str(), bar.mesh().triangles().len()), ("bar", 16));
    // A wall's edges are √2 long.
    let bounds = bar.mesh().bounds();
    assert!((bounds.max - Vec3::new(4.0, 2.0, 0.0) * 0.5_f32.sqrt()).length() < 1e-6, "{bounds:?}");
    assert_eq!((bar.position, bar.scale, bar.up_axis), (Vec3::new(4.0, 5.0, 6.0), 1.0, UpAxis::Z));
    assert_eq!(bar.pivot, Vec3::new(1.0, 0.0, 0.0));
    assert_eq!(bar.angles, [90.0, 0.0, -45.0].map(Angle::from_degrees));
    let material = &bar.materials[0];
    assert_eq!((material.ambient, material.diffuse, material.specular), (0.1, 0.2, 0.3));
    assert_eq!((material.shininess, material.blend), (40.0, Blend::Mix(128)));
    assert_eq!(material.ramp, RampChoice::Entries(Ramp::new(64, 32).expect("legal")));
    assert_eq!(material.color, [1.0, 128.0 / 255.0, 0.0]);

    assert_eq!((first.position, second.position), (Vec3::X, Vec3::Y));
    assert!(std::ptr::eq(first.mesh(), second.mesh()), "the mesh is there twice");
    for object in [first, second] {
        assert_eq!((object.name.as_str(), object.scale), ("triangle", 3.0));
        assert_eq!(object.pivot, object.mesh().bounds().centre);
        assert_eq!(object.materials[0].ramp, RampChoice::Number(5));
        assert_eq!((object.materials[1].ramp, object.materials[1].blend), (RampChoice::Number(7), Blend::Add));
    }

    assert_eq!(scene.lights()[0], Light::sun([0.0, 1.0, 0.0]).with_intensity(2.0).with_color([0.0, 1.0, 0.0]));
    let Light::Lamp { range, .. } = scene.lights()[1] else { panic!("a lamp") };
    assert_eq!(range, 5.0);
}

/// A highlight that only the file asks for has an exponent of 20. One that the file or the model disables stays off.
#[test]
fn a_shininess_of_0_stays() {
    let of = |object: &str| {
        let loaded = loaded(&format!("[[objects]]\n{object}")).expect("a legal scene");
        let material = &loaded.scene.objects()[0].materials[0];
        (material.specular, material.shininess)
    };
    assert_eq!(of("shape = 'cube'\nmaterial.specular = 0.5"), (0.5, 20.0));
    assert_eq!(of("shape = 'cube'\nmaterial.specular = 0.5\nmaterial.shininess = 0"), (0.5, 0.0));
    assert_eq!(of("shape = 'cube'\nmaterial.specular = 0.5\nmaterial.shininess = 1e-30"), (0.5, 1e-30));
    // Ks without Ns.
    assert_eq!(of("model = 'dull.obj'\nmaterial.diffuse = 0.5"), (1.0, 0.0));
    assert_eq!(of("model = 'dull.obj'\nmaterial.specular = 0.5"), (0.5, 20.0));
}

#[test]
fn things_move_as_a_file_says() {
    let mut scene = scene(EVERYTHING);
    let near = |a: Vec3, b: Vec3| assert!((a - b).length() < 1e-5, "{a} is not {b}");
    // A quarter of the eight-second duration.
    scene.set_time(2.0);
    // The eye goes back and forth in half the duration: there it is at the far end.
    near(scene.camera.eye, Vec3::new(0.0, 1.0, 5.0));
    near(scene.camera.target, Vec3::new(0.0, 3.0, 0.0));
    // Backwards from (4, 5, 6) to (1, 2, 3).
    near(scene.objects()[0].position, Vec3::new(3.25, 4.25, 5.25));
    let [x, y, z] = scene.objects()[0].angles.map(Angle::to_radians);
    assert!(
        (x - 180_f64.to_radians()).abs() < 1e-9
            && y == 0.0
            && (z + 225_f64.to_radians()).rem_euclid(360_f64.to_radians()) < 1e-9,
        "{x} {y} {z}"
    );
    assert!((scene.objects()[1].angles[1].to_degrees() - 180.0).abs() < 1e-9);
    // Four rounds clockwise: after a quarter of the time it is back at the start, at the top.
    let lamp = |scene: &Scene| match scene.lights()[1] {
        Light::Lamp { position, .. } => position,
        _ => panic!("a lamp"),
    };
    near(lamp(&scene), Vec3::new(0.0, 3.0, 0.0));
    scene.set_time(0.5);
    near(lamp(&scene), Vec3::new(2.0, 1.0, 0.0));
    // One round later everything is as it was.
    let (eye, angles) = (scene.camera.eye, scene.objects()[0].angles);
    scene.set_time(8.5);
    near(scene.camera.eye, eye);
    for (a, b) in scene.objects()[0].angles.into_iter().zip(angles) {
        assert!((a - b).to_degrees().abs() < 1e-9);
    }
    assert_eq!(scene.motions.len(), 7);
    assert!(matches!(scene.motions[6], Motion::Path { what: Moving::Target, path: Path::Circle { .. } }));
}

#[test]
fn what_is_left_out_has_a_default() {
    let scene = scene("objects = [{ shape = 'torus' }]");
    let showing = Scene::new();
    assert_eq!((scene.duration, scene.ambient, scene.background), (4.0, 1.0, 0));
    assert_eq!(scene.palette, showing.palette);
    assert_eq!((scene.fog, scene.settings), (None, showing.settings));
    assert!(scene.lights().is_empty() && scene.motions.is_empty() && scene.palette_animation.is_none());
    let torus = &scene.objects()[0];
    assert_eq!((torus.name.as_str(), torus.scale, torus.position), ("torus", 1.0, Vec3::ZERO));
    assert_eq!(scene.picture, 0.0);
    // It fills nine tenths of the picture's height, measured at the highest visible point of its front, at the depth z.
    let reach =
        |p: &Vec3| p.y / ((scene.camera.eye.z - p.z) * (scene.camera.field_of_view.to_radians() as f32 / 2.0).tan());
    let highest = torus.mesh().positions().iter().map(reach).fold(0.0, f32::max);
    assert!((highest - 0.9).abs() < 1e-5, "{highest}");
}

#[test]
fn a_camera_very_far_away_can_be_drawn() {
    for eye in ["[0, 0, 1e19]", "[1e38, 0, 5]", "[-3e38, 3e38, 3e38]"] {
        let scene = scene(&format!("objects = [{{ shape = 'cube' }}]\ncamera.eye = {eye}"));
        assert!(Renderer::new().draw(&scene, &mut Vga::new()).is_ok(), "{eye}");
    }
}

#[test]
fn a_camera_without_a_place_sees_everything() {
    let text = "objects = [{ shape = 'sphere', positions = [[3, 0, 0], [-1, 0, 0]], scale = 0.5 }]\n";
    let Scene { camera, .. } = scene(text);
    // Two spheres of radius 1/2 side by side fill the width: an edge of the view touches the sphere at (3, 0, 0) where
    // its slope is k, 9/10 of 4/3 of the tangent of 20°, so k · z = 2 + √(1 + k²)/2, apart from the mesh's facets.
    let k = 1.2 * 20_f32.to_radians().tan();
    let expected = Vec3::new(1.0, 0.0, (2.0 + (1.0 + k * k).sqrt() / 2.0) / k);
    assert!((camera.eye - expected).length() < 2e-2, "{} {expected}", camera.eye);
    assert_eq!((camera.target.x, camera.target.y), (camera.eye.x, camera.eye.y));
    // One behind the other, so the nearer one fills the height.
    let from = scene(&format!("{text}camera.from = [2, 0, 0]")).camera;
    let half = (0.9 * 20_f32.to_radians().tan()).atan();
    let expected = Vec3::new(3.0 + 0.5 / half.sin(), 0.0, 0.0);
    assert!((from.eye - expected).length() < 2e-2, "{} {expected}", from.eye);
    // A wider view, from closer.
    let wide = scene(&format!("{text}camera.field-of-view = 90")).camera;
    assert!(wide.eye.z > 0.5 && wide.eye.z < camera.eye.z);
    // Moving objects stay in the picture.
    let moving = "objects = [{ shape = 'sphere', path = { line = [[3, 0, 0], [-1, 0, 0]] }, scale = 0.5 }]";
    assert_eq!(scene(moving).camera, camera);
}

#[test]
fn fog_and_background_are_one_color_unless_both_are_given() {
    let fog = |text: &str| {
        let scene = scene(&format!("{CUBE}{text}"));
        (scene.background, scene.fog.expect("fog").color)
    };
    assert_eq!(fog("fog = { end = 9, color = '#808080' }"), (128, Rgb::new(128, 128, 128)));
    assert_eq!(fog("background = 7\nfog.end = 9"), (7, Rgb::new(7, 7, 7)));
    assert_eq!(fog("background = '#0a0b0a'\nfog.end = 9"), (10, Rgb::new(10, 11, 10)));
    assert_eq!(fog("background = 7\nfog = { end = 9, color = '#808080' }"), (7, Rgb::new(128, 128, 128)));
}

#[test]
fn a_palette_is_a_name_a_file_or_left_to_the_program() {
    let palette = |text: &str| scene(&format!("{CUBE}palette = {text}"));
    assert_eq!(palette("'copper'").palette, Some(builtin::COPPER.clone()));
    assert_eq!(palette("'two.hex'").palette.map(|palette| palette[1]), Some(Rgb::WHITE));
    assert!(palette("'auto'").auto_palette);
}

#[test]
fn a_texture_of_a_model_that_is_missing_is_a_warning() {
    let Loaded { scene, warnings, .. } = loaded("objects = [{ model = 'with_texture.obj' }]").expect("a scene");
    assert_eq!(warnings, ["folder/none.png: entity not found; material tin is drawn without it"]);
    assert!(scene.objects()[0].materials[0].texture.is_none());
}

#[test]
fn objects_of_one_shape_share_its_mesh() {
    let scene =
        scene("objects = [{ shape = 'cone' }, { shape = 'cone', scale = 3 }, { shape = 'cone', scale = [1, 2, 1] }]");
    let [a, b, c] = scene.objects() else { panic!() };
    assert!(std::ptr::eq(a.mesh(), b.mesh()) && !std::ptr::eq(a.mesh(), c.mesh()));
}

#[test]
fn f3_scenes_cut_at_every_byte_are_a_scene_or_one_line() {
    let mut tried = Tried::new("f3_scenes_cut_at_every_byte_are_a_scene_or_one_line", 1_200);
    for (at, _) in EVERYTHING.char_indices() {
        check(&loaded(&EVERYTHING[..at]), at);
        tried.add(1);
    }
}

#[test]
fn f3_scenes_with_one_byte_changed_are_a_scene_or_one_line() {
    let mut tried = Tried::new("f3_scenes_with_one_byte_changed_are_a_scene_or_one_line", 6_000);
    let mut kinds = [0; 2];
    for at in 0..EVERYTHING.len() {
        for byte in *b"0]\"\n=" {
            let mut bytes = EVERYTHING.as_bytes().to_vec();
            bytes[at] = byte;
            let result = Scene::from_toml_bytes(&bytes, "folder/scene.toml", open);
            check(&result, at);
            kinds[usize::from(result.is_ok())] += 1;
            tried.add(1);
        }
    }
    // Comments and names may contain anything.
    assert!(kinds[0] > 1_000 && kinds[1] > 100, "{kinds:?}");
}

/// Checks what holds for every outcome: an error is one line that begins with the file's name.
#[track_caller]
fn check(result: &Result<Loaded, SceneError>, at: usize) {
    if let Err(error) = result {
        let said = error.to_string();
        assert!(said.starts_with("folder/scene.toml:") && !said.contains(char::is_control), "{at}: {said:?}");
        assert!(said.len() < 1_000, "{at}: {said}");
    }
}

/// The scenes' README.md from here on: its table for a part of a scene names every key that the part has.
#[test]
fn every_key_is_documented() {
    let readme = include_str!("../../scenes/README.md");
    let mut tried = 0;
    for (section, text) in [
        ("A scene", "x = 1"),
        ("camera", "camera.x = 1"),
        ("objects", "objects = [{ x = 1 }]"),
        ("material", "objects = [{ material.x = 1 }]"),
        ("lights", "lights = [{ x = 1 }]"),
        ("path", "objects = [{ path.x = 1 }]"),
        ("circle", "objects = [{ path.circle.x = 1 }]"),
        ("fog", "fog.x = 1"),
        ("animation", "animation.x = 1"),
        ("render", "render.x = 1"),
    ] {
        let error = loaded(text).expect_err("no such key");
        let SceneErrorKind::UnknownKey { known } = &*error.kind else { panic!("{error}") };
        let heading = format!("\n### {section}\n");
        let (_, rest) = readme.split_once(&heading).unwrap_or_else(|| panic!("no section {section}"));
        let table = rest.split("\n#").next().expect("the section");
        let rows: Vec<&str> = table.lines().filter_map(|line| line.strip_prefix("| `")?.split('`').next()).collect();
        assert_eq!(rows, known.split(", ").collect::<Vec<_>>(), "{section}");
        tried += rows.len();
    }
    assert!(tried > 50, "{tried} keys");
}

/// Every line of a scene shown in the documents, in a sentence or in a block, is valid.
#[test]
fn keys_in_documents_are_keys_of_scenes() {
    let scenes = include_str!("../../scenes/README.md");
    // Its tables are those of the parser (see above).
    let known: Vec<&str> = scenes.lines().filter_map(|line| line.strip_prefix("| `")?.split('`').next()).collect();
    let mut tried = 0;
    for document in [include_str!("../../../README.md"), scenes] {
        let mut language = "";
        for line in document.lines() {
            if let Some(opened) = line.trim_start().strip_prefix("```") {
                language = opened;
                continue;
            }
            // In a block of a scene, each line; elsewhere, what is between backquotes.
            let quoted: Vec<&str> = match language {
                "toml" => vec![line],
                "" => line.split('`').skip(1).step_by(2).collect(),
                _ => continue,
            };
            let assigned = quoted.into_iter().filter_map(|code| code.split_once(" = "));
            let is_key = |key: &str| key.chars().all(|c| c.is_ascii_alphabetic() || "-_.".contains(c));
            // `features` is Cargo's.
            for (key, _) in assigned.filter(|(key, _)| is_key(key) && *key != "features") {
                assert!(key.split('.').all(|key| known.contains(&key)), "{key} in: {line}");
                tried += 1;
            }
        }
    }
    assert!(tried >= 5, "{tried} keys");
}

/// The document lists exactly the existing shadings.
#[test]
fn every_shading_is_documented() {
    let row =
        include_str!("../../scenes/README.md").lines().find(|line| line.starts_with("| `shading` |")).expect("a row");
    let named = row.split('|').nth(2).expect("the values");
    let all = mode13h::settings::Shading::ALL.map(|shading| format!("`\"{shading}\"`"));
    assert_eq!(named.trim(), all.join(", "));
}

#[test]
fn a_texture_is_a_png_beside_the_scene() {
    let directory = tempfile::tempdir().expect("a directory");
    fs::write(directory.path().join("flag.png"), picture(2, 1)).expect("written");
    // The model names it in its material; the wall's scene does so itself.
    fs::write(directory.path().join("it.mtl"), "newmtl tin\nmap_Kd flag.png\n").expect("written");
    let model = "mtllib it.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl tin\nf 1/1 2/1 3/1\n";
    fs::write(directory.path().join("it.obj"), model).expect("written");
    let path = directory.path().join("scene.toml");
    let text = "objects = [{ shape = 'wall', material.texture = 'flag.png' }, { model = 'it.obj' }]";
    fs::write(&path, text).expect("written");
    let Loaded { scene, warnings, .. } = scene_file::load(&path).expect("a scene");
    assert_eq!(warnings, [""; 0]);
    for object in scene.objects() {
        let texture = object.materials[0].texture.as_ref().expect("a texture");
        assert_eq!((texture.width(), texture.height()), (2, 1));
        assert_eq!((texture[(0, 0)], texture[(1, 0)]), (Rgb::new(255, 0, 0), Rgb::new(0, 0, 255)));
    }
}

#[test]
fn textures_repeat_as_often_as_a_scene_says() {
    let scene = scene("objects = [{ shape = 'wall', subdivisions = [1, 1], repeat = [3, 0.5] }]");
    let texcoords = scene.objects()[0].mesh().texcoords().expect("a wall has them");
    assert_eq!(texcoords[3], mode13h::glam::Vec2::new(3.0, 0.5));
}

/// Each crease angle gives a separate mesh of a model; equal angles share one.
#[test]
fn models_have_the_crease_angle_that_is_asked_for() {
    let text = "objects = [{ model = 'bent.obj' }, { model = 'bent.obj', crease = 90 }, { model = 'bent.obj', crease = 89.9 }, \
                { model = 'bent.obj', crease = 90 }]";
    let scene = scene(text);
    let vertices: Vec<usize> = scene.objects().iter().map(|object| object.mesh().positions().len()).collect();
    assert_eq!(vertices, [8, 6, 8, 6]);
    assert!(std::ptr::eq(scene.objects()[1].mesh(), scene.objects()[3].mesh()));
}
