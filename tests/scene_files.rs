//! Scene files: what they say is what is in the scene, and what is wrong in them is said with its line, column and key.
#![cfg(feature = "scene-files")]

mod support;

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, BufRead, Cursor};
use std::path::Path as FilePath;

use mode13h::glam::Vec3;
use mode13h::light::{Blend, Light, RampChoice};
use mode13h::palette::{Ramp, Rgb, builtin};
use mode13h::scene::file::{self, LONGEST, Loaded, MOST_TRIANGLES, Place, SceneError, SceneErrorKind};
use mode13h::scene::{HiddenSurfaces, Mapping, Motion, Moving, PaletteAnimation, Path, Rung, Scene, UpAxis};
use support::tried::Tried;

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl tin\nf 1 2 3\nusemtl oak\nf 3 2 1\n";

/// The files that there are beside the scenes of these tests, in the folder `folder`.
fn open(path: &FilePath) -> io::Result<Box<dyn BufRead>> {
    let files: BTreeMap<&str, &[u8]> = BTreeMap::from([
        ("folder/triangle.obj", TRIANGLE.as_bytes()),
        ("folder/broken.obj", &b"v 0 0 0\nf 1 2 3\n"[..]),
        ("folder/with_texture.obj", b"mtllib it.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl tin\nf 1/1 2/1 3/1\n"),
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
        Ok(Loaded { scene, warnings }) => {
            assert!(warnings.is_empty(), "{warnings:?}");
            scene
        }
        Err(error) => panic!("{error}"),
    }
}

/// A cube, for scenes whose objects are of no interest, in one line.
const CUBE: &str = "objects = [{ shape = 'cube' }]\n";

#[test]
fn f3_broken_scenes_are_one_line_with_line_column_and_key() {
    let mut tried = Tried::new("f3_broken_scenes_are_one_line_with_line_column_and_key", 90);
    let cube = |text: &str| format!("{CUBE}{text}");
    let object = |text: &str| format!("[[objects]]\nshape = 'cube'\n{text}");
    let light = |text: &str| format!("{CUBE}[[lights]]\n{text}");
    let path = |text: &str| format!("[[objects]]\nshape = 'cube'\npath = {text}");
    let list = |text: &str| text.to_string();
    let deep = "[".repeat(100_000);
    let mut wrong = String::new();
    for (text, says) in [
        // Unknown keys, in every table.
        (cube("fogg = 1"), "2:1: key `fogg`: unknown key; known are name, duration, ambient, background, palette, "),
        (cube("[camera]\neyes = [0, 0, 1]"), "3:1: key `camera.eyes`: unknown key; known are eye, target, from, up, "),
        (object("colour = 1"), "3:1: key `objects[0].colour`: unknown key; known are name, shape, subdivisions, "),
        (
            object("material = { ramp = 0, shyness = 3 }"),
            "3:24: key `objects[0].material.shyness`: unknown key; known are ambient, diffuse, specular, shininess, ",
        ),
        (
            list("[[objects]]\nshape = 'cube'\n\n[[objects]]\nshape = 'cone'\n[objects.material]\nshyness = 3"),
            "7:1: key `objects[1].material.shyness`: unknown key",
        ),
        (object("material.ramp.last = 3"), "3:15: key `objects[0].material.ramp.last`: unknown key; known are first, "),
        (light("lamb = [0, 0, 1]"), "3:1: key `lights[0].lamb`: unknown key; known are sun, lamp, range, "),
        (path("{ lines = 1 }"), "3:10: key `objects[0].path.lines`: unknown key; known are line, back, circle, rounds"),
        (path("{ circle = { middle = 1 } }"), "key `objects[0].path.circle.middle`: unknown key; known are centre, "),
        (cube("fog.begin = 1"), "2:5: key `fog.begin`: unknown key; known are color, start, end"),
        (cube("animation = { to = 1 }"), "2:15: key `animation.to`: unknown key; known are fade, cycle, rounds"),
        (cube("wishes.hidden_surfaces = 1"), "2:8: key `wishes.hidden_surfaces`: unknown key; known are rung, hidden-"),
        (cube("\"`, expected one of `a`\" = 1"), "2:1: key ``, expected one of `a``: unknown key; known are name, "),
        // Wrong types.
        (list("name = 7"), "1:8: key `name`: expected a string, found integer `7`"),
        (list("objects = 7"), "1:11: key `objects`: expected a sequence, found integer `7`"),
        (list("objects = [7]"), "1:12: key `objects[0]`: expected a table, found integer `7`"),
        (list("objects = ['cube']"), "1:12: key `objects[0]`: expected a table, found string \"cube\""),
        (cube("camera = []"), "2:10: key `camera`: "),
        (cube("fog = true"), "2:7: key `fog`: expected a table, found boolean `true`"),
        (object("position = 'here'"), "3:12: key `objects[0].position`: expected a list of 3, found string \"here\""),
        (object("position = [1, 2]"), "3:12: key `objects[0].position`: expected a list of 3, found 2"),
        (object("position = [1, 2, 3, 4]"), "3:12: key `objects[0].position`: expected a list of 3, found 4"),
        (
            object("position = [1, '2', 3]"),
            "3:16: key `objects[0].position[1]`: expected a finite number, found string \"2\"",
        ),
        (
            object("scale = true"),
            "3:9: key `objects[0].scale`: expected a number above 0, or three in a list, found boolean `true`",
        ),
        (
            object("subdivisions = 1.5"),
            "3:16: key `objects[0].subdivisions`: expected a whole number, or two in a list, found floati",
        ),
        (object("material = 'copper'"), "3:12: key `objects[0].material`: expected a table, found string \"copper\""),
        (
            object("material.color = 7"),
            "3:18: key `objects[0].material.color`: expected a color: \"#rrggbb\", or red, green and blue f",
        ),
        (
            object("material.blend = []"),
            "3:18: key `objects[0].material.blend`: expected \"opaque\", \"add\", or how opaque it is, a numb",
        ),
        (
            cube("duration = 1979-05-27"),
            "2:12: key `duration`: expected a number of seconds above 0, at most 3600, found map",
        ),
        (cube("wishes = { rung = 3 }"), "2:19: key `wishes.rung`: expected a name in quotes, found integer `3`"),
        (cube("wishes.dither = 'yes'"), "2:17: key `wishes.dither`: expected a boolean, found string \"yes\""),
        // Out of range.
        (cube("duration = 0"), "2:12: key `duration`: expected a number of seconds above 0, at most 3600, found 0"),
        (cube("duration = nan"), "2:12: key `duration`: expected a number of seconds above 0, at most 3600, found NaN"),
        (cube("ambient = -0.5"), "2:11: key `ambient`: expected a number of at least 0, found -0.5"),
        (cube("ambient = 1e39"), "2:11: key `ambient`: expected a number of at least 0, found 1e39"),
        (cube("ambient = 1e999"), "2:11: key `ambient`: "),
        (
            cube("background = 256"),
            "2:14: key `background`: expected a palette entry, a whole number from 0 to 255, found 256",
        ),
        (
            cube("background = '#12345'"),
            "2:14: key `background`: expected a color: \"#rrggbb\", or red, green and blue from 0 to 1 in a",
        ),
        (
            cube("background = '#+12345'"),
            "2:14: key `background`: expected a color: \"#rrggbb\", or red, green and blue from 0 to 1 in a",
        ),
        (cube("background = [0, 2, 0]"), "2:18: key `background[1]`: expected a number from 0 to 1, found 2"),
        (object("scale = 0"), "3:9: key `objects[0].scale`: expected a number above 0, found 0"),
        (object("scale = [1, 1e-50, 1]"), "3:13: key `objects[0].scale[1]`: expected a number above 0, found 1e-50"),
        (object("position = [0, inf, 0]"), "3:16: key `objects[0].position[1]`: expected a finite number, found inf"),
        (
            object("material.diffuse = 1.1"),
            "3:20: key `objects[0].material.diffuse`: expected a number from 0 to 1, found 1.1",
        ),
        (
            object("material.shininess = 0"),
            "3:22: key `objects[0].material.shininess`: expected a number above 0, at most 1000, found 0",
        ),
        (
            object("material.ramp = -1"),
            "3:17: key `objects[0].material.ramp`: expected the number of a ramp, 0 to 255, or { first = ",
        ),
        (
            object("material.ramp = { first = 1.5, entries = 2 }"),
            "3:27: key `objects[0].material.ramp.first`: expected a palette entry, a whole number from 0 ",
        ),
        (
            object("material.ramp = { first = 200, entries = 57 }"),
            "3:17: key `objects[0].material.ramp`: 57 entries from 200 on run beyond entry 255",
        ),
        (object("material.ramp = { first = 200 }"), "3:17: key `objects[0].material.ramp.entries`: missing"),
        (
            object("material.blend = 2"),
            "3:18: key `objects[0].material.blend`: expected \"opaque\", \"add\", or how opaque it is, a numb",
        ),
        (object("subdivisions = 4"), "3:16: key `objects[0].subdivisions`: a cube has no subdivisions"),
        (
            list("objects = [{ shape = 'torus', subdivisions = 4 }]"),
            "1:46: key `objects[0].subdivisions`: a torus has 2 subdivisions: around the axis, around the tube",
        ),
        (
            list("objects = [{ shape = 'torus', subdivisions = [48, 2] }]"),
            "1:46: key `objects[0].subdivisions`: 2 around the tube; a torus has from 3 to 4096",
        ),
        (
            list("objects = [{ shape = 'wall', subdivisions = [5000, 1] }]"),
            "1:45: key `objects[0].subdivisions`: 5000 columns; a wall has from 1 to 4096",
        ),
        (
            list("objects = [{ shape = 'teapot', subdivisions = 9223372036854775807 }]"),
            "key `objects[0].subdivisions`: 9223372036854775807 segments; a teapot has from 2 to 512",
        ),
        (
            list("objects = [{ shape = 'torus', subdivisions = [4096, 4096] }]"),
            "1:46: key `objects[0].subdivisions`: more than 262144 triangles in the shapes of a scene",
        ),
        (
            format!("objects = [{{ shape = 'teapot', positions = [{}] }}]", "[0, 0, 0],".repeat(65)),
            "1:12: key `objects[0]`: more than 262144 triangles in the shapes of a scene",
        ),
        (
            cube("camera.field-of-view = 180"),
            "2:24: key `camera.field-of-view`: expected a number of degrees from 1 to 179, found 180",
        ),
        (cube("camera.near = 0"), "2:15: key `camera.near`: expected a number above 0, found 0"),
        (light("lamp = [0, 0, 1]\nrange = 0"), "4:9: key `lights[0].range`: expected a number above 0, found 0"),
        (light("sun = [0, 0, 0.0]"), "3:7: key `lights[0].sun`: a direction must not be zero"),
        (
            path("{ line = [[0, 0, 0], [1, 0, 0]], rounds = 0 }"),
            "3:50: key `objects[0].path.rounds`: expected a number other than 0, from -1000 to 1000, found 0",
        ),
        (path("{ line = [[0, 0, 0]] }"), "3:17: key `objects[0].path.line`: expected a list of 2, found 1"),
        (cube("fog = { start = 2, end = 2 }"), "2:26: key `fog.end`: the fog ends no farther than it starts"),
        (cube("animation.cycle = [9, 8]"), "2:19: key `animation.cycle`: the first entry lies behind the last"),
        (cube("wishes.max-error = 0"), "2:20: key `wishes.max-error`: expected a number above 0, found 0"),
        // Names of nothing.
        (
            list("objects = [{ shape = 'toroid' }]"),
            "1:22: key `objects[0].shape`: \"toroid\": unknown shape; there are ",
        ),
        (object("up-axis = 'x'"), "3:11: key `objects[0].up-axis`: \"x\": unknown axis; there are y, z"),
        (
            object("material.blend = 'glass'"),
            "3:18: key `objects[0].material.blend`: expected \"opaque\", \"add\", or how opaque it is, a numb",
        ),
        (
            cube("wishes.rung = 'best'"),
            "2:15: key `wishes.rung`: \"best\": unknown rung; there are flat, gouraud-8.8, ",
        ),
        (cube("wishes.mapping = 'best'"), "2:18: key `wishes.mapping`: \"best\": unknown mapping; there are affine, "),
        (
            cube("wishes.hidden-surfaces = ''"),
            "key `wishes.hidden-surfaces`: \"\": unknown way to hidden surfaces; the",
        ),
        (
            path("{ circle = { radius = 1, axis = 'w' } }"),
            "key `objects[0].path.circle.axis`: \"w\": unknown axis; the",
        ),
        (
            list("[[objects]]\nmodel = 'triangle.obj'\nmaterials.iron.ramp = 1"),
            "3:11: key `objects[0].materials.iron`: no material of the object; it has tin, oak",
        ),
        (
            object("materials.iron.ramp = 1"),
            "3:11: key `objects[0].materials.iron`: the object's only material has no ",
        ),
        // Files that are missing or broken.
        (list("[[objects]]\nmodel = 'none.obj'"), "2:9: key `objects[0].model`: folder/none.obj: entity not found"),
        (
            list("[[objects]]\nmodel = 'broken.obj'"),
            "2:9: key `objects[0].model`: folder/broken.obj:2: there is no vertex 2, only 1",
        ),
        (
            list("[[objects]]\nmodel = 'scene.toml'"),
            "2:9: key `objects[0].model`: no model that can be read: models are",
        ),
        (
            list("[[objects]]\nmodel = ''"),
            "2:9: key `objects[0].model`: expected a name of 1 to 1000 characters, found string \"\"",
        ),
        (
            list("[[objects]]\nmodel = \"a\\nb\""),
            "2:9: key `objects[0].model`: expected a name of 1 to 1000 characters, found string \"a\\nb\"",
        ),
        (cube("palette = 'none.pal'"), "2:11: key `palette`: folder/none.pal: entity not found"),
        (
            cube("palette = 'broken.pal'"),
            "2:11: key `palette`: folder/broken.pal: line 5: expected three numbers 0 to 25",
        ),
        (cube("animation.fade = 'mauve'"), "2:18: key `animation.fade`: folder/mauve: entity not found"),
        (
            object("material.environment = 'none.png'"),
            "key `objects[0].material.environment`: folder/none.png: entity n",
        ),
        (object("material.environment = 'broken.png'"), "key `objects[0].material.environment`: folder/broken.png: "),
        (
            list("[[objects]]\nmodel = 'triangle.obj'\nmaterial.texture = 'none.png'"),
            "3:20: key `objects[0].material.texture`: the object has no texture coordinates",
        ),
        // What does not go together, or is missing.
        (list(""), "no object: a scene needs at least one [[objects]]"),
        (list("objects = []"), "no object: a scene needs at least one [[objects]]"),
        (list("[[objects]]\nname = 'none'"), "1:1: key `objects[0]`: an object needs a `shape` or a `model`"),
        (object("model = 'triangle.obj'"), "3:9: key `objects[0].model`: beside a `shape`"),
        (object("position = [0, 0, 0]\npositions = [[0, 0, 0]]"), "4:13: key `objects[0].positions`: beside a `positi"),
        (object("positions = []"), "3:13: key `objects[0].positions`: at least one is needed"),
        (
            list("[[objects]]\nmodel = 'triangle.obj'\nsubdivisions = 3"),
            "3:16: key `objects[0].subdivisions`: only a s",
        ),
        (light("intensity = 1"), "2:1: key `lights[0]`: a light is either a `sun` or a `lamp`"),
        (light("sun = [0, 0, 1]\nlamp = [0, 0, 1]"), "2:1: key `lights[0]`: a light is either a `sun` or a `lamp`"),
        (light("sun = [0, 0, 1]\nrange = 3"), "4:9: key `lights[0].range`: only a lamp has a range"),
        (light("lamp = [0, 0, 1]"), "2:1: key `lights[0]`: a lamp needs a `range`: how far it reaches"),
        (path("{ rounds = 2 }"), "3:8: key `objects[0].path`: a path is either a `line` or a `circle`"),
        (
            path("{ circle = { radius = 1 }, back = true }"),
            "3:42: key `objects[0].path.back`: only a line has a way ba",
        ),
        (
            path("{ circle = { radius = 1, from = [0, 0, 1] } }"),
            "3:19: key `objects[0].path.circle`: a circle has eith",
        ),
        (cube("fog.start = 2"), "2:1: key `fog.end`: missing"),
        (cube("[fog]\nstart = 2"), "2:1: key `fog.end`: missing"),
        (cube("animation.rounds = 2"), "2:1: key `animation`: an animation is either a `fade` or a `cycle`"),
        (
            cube("camera = { eye = [0, 0, 1], from = [0, 0, 1] }"),
            "2:36: key `camera.from`: beside an `eye`, which says",
        ),
        (cube("camera = { eye = [0, 0, 0] }"), "2:10: key `camera`: the camera looks at the point where it is"),
        (object("position = [3e38, 0, 0]\nscale = 3e38"), "the objects reach too far to be framed; give the camera"),
        // Not TOML.
        (list("name = \n"), "1:8: not TOML: "),
        (list("a = 1\nb = 2\na = 3\n"), "3:1: key `a`: not TOML: duplicate key"),
        (list("[[objects]\nshape = 'cube'"), "1:11: not TOML: "),
        (list("name = \"\u{1F9CA}\" x"), "1:12: not TOML: "),
        (deep, "not TOML: "),
        (list("\u{0}"), "1:2: not TOML: key with no value"),
    ] {
        let Err(error) = loaded(&text) else { panic!("{text} is a scene") };
        let said = error.to_string();
        assert!(!said.contains(char::is_control), "{said:?}");
        // Behind "12:9: ", or anywhere where the place is of no interest.
        let said = said.strip_prefix("folder/scene.toml:").expect("the file's name");
        let placed = says.starts_with(|c: char| c.is_ascii_digit());
        if !(if placed { said.starts_with(says) } else { said.contains(says) }) {
            wrong += &format!("{text:.100}\n    says: {said}\n    not:  {says}\n");
        }
        tried.add(1);
    }
    assert!(wrong.is_empty(), "{wrong}");
}
