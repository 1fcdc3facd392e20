//! Properties that hold for every parser, whatever its input. There is one function per parser, shared by the fuzzer
//! (`fuzz/fuzz_targets`) and the corpora (`lab/tests/lab/fuzz_corpus.rs`); each panics if its property fails.

#[path = "../../../../tests/support/film.rs"]
#[expect(dead_code, reason = "other tests use the rest")]
mod film;

use std::collections::HashMap;
use std::fmt::Write;
use std::io::{self, BufRead, BufReader};
use std::path::Path;
use std::str::FromStr;

use mode13h::export::{MAX_SIDE, Picture, PixelShape, Scale};
use mode13h::glam::{Vec2, Vec3};
use mode13h::light::Light;
use mode13h::mesh::{Mesh, shapes};
use mode13h::palette::{Palette, Rgb, builtin};
use mode13h::render::{Renderer, Screen};
use mode13h::scene::{Camera, Object, Scene};
use mode13h::settings::Shading;
use mode13h::span::Kernel;
use mode13h::texture::Texture;
use mode13h::vga::Vga;
use mode13h_assets::SceneExt;
use mode13h_assets::animation::{FrameRate, GifWriter};
use mode13h_assets::model_file::obj;
use mode13h_assets::model_file::{self, Clip, Loaded, ModelFileError, ModelFileErrorKind, Options, Pose};
use mode13h_assets::palette_file::{self, FORMATS, Format, PaletteError, Place};
use mode13h_assets::scene_file::{MAX_TRIANGLES, SceneErrorKind};
use mode13h_assets::texture;

/// A parser's property: its name, which its corpus and its fuzz target share, and the check.
pub type Property = (&'static str, fn(&[u8]));

pub const PROPERTIES: [Property; 13] = [
    ("obj", obj),
    ("mtl", mtl),
    ("stl", stl),
    ("ply", ply),
    ("gltf", gltf),
    ("palette_jasc", palette_jasc),
    ("palette_gimp", palette_gimp),
    ("palette_hex", palette_hex),
    ("palette_binary", palette_binary),
    ("scene", scene),
    ("words", words),
    ("texture", texture),
    ("gif", gif),
];

/// Separates an OBJ file from its MTL file within one input, on a line of its own.
const MATERIALS: &[u8] = b"\n---\n";

/// An OBJ file; anything after a line of `---` is the MTL file `a.mtl`. Every other MTL file is missing.
pub fn obj(bytes: &[u8]) {
    let (model, materials) = match bytes.windows(MATERIALS.len()).position(|window| window == MATERIALS) {
        Some(at) => (&bytes[..=at], Some(&bytes[at + MATERIALS.len()..])),
        None => (bytes, None),
    };
    let library = |path: &Path| match materials {
        Some(materials) if path == Path::new("a.mtl") => Ok(materials.to_vec()),
        _ => Err(io::ErrorKind::NotFound.into()),
    };
    let result = obj::parse(model, "model.obj", library);
    check_obj(&result, model, materials.unwrap_or_default());

    // However the reader delivers the bytes.
    let dribbled = obj::parse(BufReader::with_capacity(1, model), "model.obj", library);
    assert_eq!(outcome(&dribbled), outcome(&result), "read byte by byte");
    // Whatever the line endings.
    if !model.contains(&b'\r') {
        for end in ["\r\n", "\r"] {
            let ended = model.split(|&byte| byte == b'\n').collect::<Vec<_>>().join(end.as_bytes());
            let ended = obj::parse(&ended[..], "model.obj", library);
            assert_eq!(outcome(&ended), outcome(&result), "lines end with {end:?}");
        }
    }
    if let Ok(Loaded { mesh, .. }) = &result {
        check_written_again(mesh);
    }
}

/// An MTL file, for a model that uses the first materials it names.
pub fn mtl(bytes: &[u8]) {
    let mut model = String::from("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n");
    let mut names = Vec::new();
    for line in bytes.split(|byte| matches!(byte, b'\n' | b'\r')) {
        let Some(name) = line.trim_ascii().strip_prefix(b"newmtl ") else { continue };
        let Ok(name) = str::from_utf8(name.trim_ascii()) else { continue };
        // A name that ends in a backslash continues on the next line.
        if names.len() < 8 && !name.contains('\\') && !names.contains(&name) {
            names.push(name);
            writeln!(model, "usemtl {name}\nf 1 2 3").expect("a string takes all");
        }
    }
    // One that does not exist, unless the fuzzer came up with its name too.
    if !names.contains(&"none of them") {
        names.push("none of them");
        model.push_str("usemtl none of them\nf 3 2 1\n");
    }
    let library = |path: &Path| match path == Path::new("a.mtl") {
        true => Ok(bytes.to_vec()),
        false => Err(io::ErrorKind::NotFound.into()),
    };
    let result = obj::parse(model.as_bytes(), "model.obj", library);
    check_obj(&result, model.as_bytes(), bytes);
    if let Ok(Loaded { mesh, .. }) = result {
        let found: Vec<&str> = mesh.surfaces().iter().map(|surface| surface.name.as_str()).collect();
        assert_eq!(found, names);
    }
}

/// The outcome on which two ways of reading the same input must agree.
fn outcome(result: &Result<Loaded, ModelFileError>) -> Result<&Loaded, String> {
    result.as_ref().map_err(ToString::to_string)
}

fn check_obj(result: &Result<Loaded, ModelFileError>, model: &[u8], materials: &[u8]) {
    match result {
        Ok(Loaded { mesh, warnings, .. }) => {
            check_mesh(mesh);
            for warning in warnings {
                assert!(!warning.contains(['\n', '\r']), "a warning of more than one line: {warning:?}");
            }
        }
        Err(error) => {
            let text = if error.path == Path::new("model.obj") { model } else { materials };
            check_place(error, text);
            let whole_file = matches!(
                error.kind,
                ModelFileErrorKind::NoFaces
                    | ModelFileErrorKind::NoArea
                    | ModelFileErrorKind::TooLarge("more than 65,536 materials")
            );
            assert_eq!(error.place.is_none(), whole_file, "{error}");
            let said = error.to_string();
            assert!(!said.contains(char::is_control) && said.len() < 300, "{said:?}");
        }
    }
}

/// A model's error names a line or a byte of its file, or the byte after the last. An empty file has one line, too.
fn check_place(error: &ModelFileError, bytes: &[u8]) {
    match error.place {
        Some(model_file::Place::Line(line)) => {
            let lines = lines_in(bytes).max(1);
            assert!(line >= 1 && line <= lines as u64, "{error}: of {lines} lines");
        }
        Some(model_file::Place::Offset(at)) => assert!(at <= bytes.len() as u64, "{error}: of {} bytes", bytes.len()),
        None => {}
    }
}

/// An STL file, text or binary.
pub fn stl(bytes: &[u8]) {
    model(bytes, "model.stl");
}

/// A PLY file, text or binary.
pub fn ply(bytes: &[u8]) {
    model(bytes, "model.ply");
}

/// A glTF file, JSON or binary.
pub fn gltf(bytes: &[u8]) {
    model(bytes, "model.glb");
}

/// A model file with this name and no files beside it.
fn model(bytes: &[u8], name: &str) {
    let none = |_: &Path| Err(io::ErrorKind::NotFound.into());
    match model_file::parse(bytes, name, none, &Options::default()) {
        Ok(Loaded { mesh, warnings, textures, lights, camera, rig, .. }) => {
            check_mesh(&mesh);
            check_staged(&mesh, &lights, camera);
            for (clip, duration) in rig.iter().flat_map(|rig| rig.clips().iter().map(Clip::duration).enumerate()) {
                assert!(duration.is_finite());
                for seconds in [0.0, duration / 3.0, duration, -1.0, f64::NAN] {
                    let Some(Pose { mesh: posed, lights, camera, .. }) =
                        rig.as_ref().map(|rig| rig.pose(&mesh, clip, seconds))
                    else {
                        continue;
                    };
                    check_mesh(&posed);
                    assert_eq!((posed.triangles(), posed.surfaces()), (mesh.triangles(), mesh.surfaces()));
                    check_staged(&posed, &lights, camera);
                }
            }
            warnings.iter().for_each(|warning| assert_one_line(warning));
            for texture in mesh.surfaces().iter().filter_map(|surface| surface.texture.as_ref()) {
                // Others are files, whatever their names.
                let is_own = texture.starts_with(&format!("{name}#"));
                assert!(!is_own || textures.contains_key(texture), "{texture} is missing");
            }
            // A model that moves is as its file has it; an OBJ is repaired, and moved if it lies far from 0.
            if rig.is_none() {
                check_written_again(&mesh);
            }
        }
        Err(error) => {
            check_place(&error, bytes);
            let said = error.to_string();
            assert_one_line(&said);
            assert!(said.len() < 400, "{said:?}");
        }
    }
    // Whichever format its contents suggest.
    let _ = model_file::parse(bytes, "standard input", none, &Options::default());
}

/// Checks that the renderer accepts the lights and the camera of a model.
fn check_staged(mesh: &Mesh, lights: &[Light], camera: Option<Camera>) {
    let mut scene = Scene::new();
    // Whether an object can be drawn from here does not depend on them.
    scene.add(Object::new(shapes::cube()).at(mesh.bounds().centre));
    lights.iter().for_each(|light| _ = scene.add_light(*light));
    scene.camera = camera.unwrap_or(scene.camera);
    if let Err(error) = Renderer::new().make_plan(&scene, Screen::MODE_13H) {
        panic!("{error}: {lights:?} {camera:?}");
    }
}

/// LF, CR LF and CR end a line; an end of line at the end of the text begins no further line.
fn lines_in(text: &[u8]) -> usize {
    let mut lines = 0;
    let mut before = b'\n';
    for &byte in text {
        let begins = matches!(before, b'\n' | b'\r') && !(before == b'\r' && byte == b'\n');
        lines += usize::from(begins);
        before = byte;
    }
    lines
}

/// Properties of every mesh read from a file.
fn check_mesh(mesh: &Mesh) {
    let (positions, normals) = (mesh.positions(), mesh.normals());
    assert!(!mesh.triangles().is_empty());
    assert_eq!(positions.len(), normals.len());
    assert!(positions.iter().all(|p| p.is_finite()));
    for normal in normals {
        let squares = normal.to_array().map(|x| f64::from(x) * f64::from(x));
        let length = (squares[0] + squares[1] + squares[2]).sqrt();
        // Each component is rounded once, by 2⁻²⁵ for a number up to 1: √3 · 2⁻²⁵ at most.
        assert!((length - 1.0).abs() < 2f64.powi(-23), "a normal of length {length}");
    }
    let mut used = vec![false; positions.len()];
    for &index in mesh.triangles().as_flattened() {
        used[index as usize] = true;
    }
    assert!(used.iter().all(|&used| used), "a vertex that no triangle uses");
    if let Some(texcoords) = mesh.texcoords() {
        assert_eq!(texcoords.len(), positions.len());
        assert!(texcoords.iter().all(|t| t.is_finite()));
    }
    assert_eq!(mesh.triangle_surfaces().len(), mesh.triangles().len());
    assert!(mesh.triangle_surfaces().iter().all(|&surface| usize::from(surface) < mesh.surfaces().len()));
    for surface in mesh.surfaces() {
        assert!(surface.diffuse.iter().chain(&surface.specular).all(|x| x.is_finite()));
        assert!(surface.shininess.is_finite());
    }
    let bounds = mesh.bounds();
    assert!(bounds.centre.is_finite() && bounds.radius.is_finite() && bounds.radius >= 0.0);
    assert!(positions.iter().all(|p| p.cmpge(bounds.min).all() && p.cmple(bounds.max).all()));
    assert!(!mesh.is_convex() || mesh.is_closed());
}

/// A mesh written as OBJ with all its data and read again has the same corners in the same order.
fn check_written_again(mesh: &Mesh) {
    let mut text = String::new();
    for p in mesh.positions() {
        writeln!(text, "v {} {} {}", p.x, p.y, p.z).expect("a string takes all");
    }
    for n in mesh.normals() {
        writeln!(text, "vn {} {} {}", n.x, n.y, n.z).expect("a string takes all");
    }
    for t in mesh.texcoords().unwrap_or_default() {
        writeln!(text, "vt {} {}", t.x, t.y).expect("a string takes all");
    }
    for (triangle, surface) in mesh.triangles().iter().zip(mesh.triangle_surfaces()) {
        let [a, b, c] = triangle.map(|i| i + 1);
        let face = match mesh.texcoords() {
            Some(_) => format!("f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}"),
            None => format!("f {a}//{a} {b}//{b} {c}//{c}"),
        };
        writeln!(text, "usemtl {surface}\n{face}").expect("a string takes all");
    }
    let none = |_: &Path| Err(io::ErrorKind::NotFound.into());
    let again = obj::parse(text.as_bytes(), "again.obj", none).expect("what was written is well formed").mesh;
    check_mesh(&again);
    assert_eq!(again.triangles().len(), mesh.triangles().len());
    let bits = |p: Vec3| p.to_array().map(f32::to_bits);
    let texcoord = |mesh: &Mesh, i: u32| mesh.texcoords().map(|t: &[Vec2]| t[i as usize].to_array().map(f32::to_bits));
    let mut names = HashMap::new();
    for (t, (&old, &new)) in mesh.triangles().iter().zip(again.triangles()).enumerate() {
        for (old, new) in old.into_iter().zip(new) {
            assert_eq!(bits(mesh.positions()[old as usize]), bits(again.positions()[new as usize]));
            assert_eq!(texcoord(mesh, old), texcoord(&again, new));
            let (old, new) = (mesh.normals()[old as usize], again.normals()[new as usize]);
            // Each was normalized once more: a length off by 2⁻²⁴, and a rounding of 2⁻²⁵, in each component.
            assert!((old - new).abs().max_element() <= 2f32.powi(-23), "{old} {new}");
        }
        let surface = again.triangle_surfaces()[t];
        assert_eq!(*names.entry(mesh.triangle_surfaces()[t]).or_insert(surface), surface);
    }
    assert_eq!((again.is_closed(), again.is_convex()), (mesh.is_closed(), mesh.is_convex()));
}

pub fn palette_jasc(bytes: &[u8]) {
    palette(bytes, &["jasc"], &["a.pal", "A.PAL"]);
}

pub fn palette_gimp(bytes: &[u8]) {
    palette(bytes, &["gimp"], &["a.gpl"]);
}

pub fn palette_hex(bytes: &[u8]) {
    palette(bytes, &["hex"], &["a.hex"]);
}

pub fn palette_binary(bytes: &[u8]) {
    palette(bytes, &["vga", "act", "act-772"], &["a.vga", "a.raw", "a.col", "a.lmp", "a.act", "a.pal"]);
}

/// A palette file, read as these formats, under these names, and without a name.
fn palette(bytes: &[u8], formats: &[&str], names: &[&str]) {
    let mut results: Vec<Result<Palette, PaletteError>> = Vec::new();
    for name in formats {
        results.push(Format::by_name(name).expect("a format").read(bytes));
    }
    for name in names {
        results.push(palette_file::parse_named(name, bytes));
    }
    results.push(palette_file::parse_named("a", bytes));
    results.push(palette_file::parse(bytes));
    assert_eq!(results[results.len() - 1], results[results.len() - 2], "an extension that is missing says nothing");
    for (i, result) in results.iter().enumerate() {
        match result {
            // Most outcomes are equal.
            Ok(_) if results[..i].contains(result) => {}
            Ok(palette) => check_palette(palette),
            Err(error) => check_palette_error(error, bytes),
        }
    }
}

/// Written in any format and read again, a palette is the same.
fn check_palette(palette: &Palette) {
    for format in &FORMATS {
        let written = format.write(palette, "a name\nof two lines");
        let expected = as_written(format, palette);
        let read = format.read(&written).expect("what was written is well formed");
        assert_eq!(read.colors(), expected.colors(), "{}", format.name);
        assert_eq!(read, expected, "{}", format.name);
        assert_eq!(format.write(&read, "a name\nof two lines"), written, "{}", format.name);
        let recognized = Format::of_bytes(&written).map(|format| format.name);
        match format.name {
            // The bytes do not identify the format, and the colours of a binary file may look like text.
            "act" => {}
            "vga" | "act-772" if matches!(recognized, Some("jasc" | "gimp" | "hex")) => {}
            name => {
                assert_eq!(recognized, Some(name));
                assert_eq!(palette_file::parse(&written).expect("recognised"), expected, "{name}");
            }
        }
        let name = format!("a.{}", format.extensions[0]);
        assert_eq!(palette_file::parse_named(&name, &written).expect("read by name"), expected, "{}", format.name);
    }
}

/// Colours below 64 in a raw file that the DAC does not have are rounded down to six bits; nothing else is.
fn as_written(format: &Format, palette: &Palette) -> Palette {
    let dark = palette.colors().iter().all(|c| c.r.max(c.g).max(c.b) < 64);
    // A file says nothing about ramps: they are detected when it is read.
    Palette::from_colors(if format.name == "vga" && dark { *palette.on_dac().colors() } else { *palette.colors() })
}

fn check_palette_error(error: &PaletteError, bytes: &[u8]) {
    match error.place {
        Place::Line(line) => {
            let lines = lines_in(bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes));
            // One more if a line is missing.
            assert!((1..=lines + 1).contains(&line), "{error}: of {lines} lines");
        }
        Place::Offset(offset) => assert!(offset <= bytes.len(), "{error}: of {} bytes", bytes.len()),
    }
    let said = error.to_string();
    assert!(said.is_ascii() && !said.contains(char::is_control) && said.len() < 150, "{said:?}");
}

/// A scene file, with a model, a palette and a texture beside it.
pub fn scene(bytes: &[u8]) {
    // A PNG texture of one black texel.
    const TEXEL: &[u8] = &[
        0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
        0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00, 0x00, 0x3a, 0x7e, 0x9b, 0x55, 0x00, 0x00, 0x00,
        0x0a, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0x60, 0x00, 0x00, 0x00, 0x02, 0x00, 0x01, 0xe5, 0x27, 0xde,
        0xfc, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82,
    ];
    let open = |path: &Path| -> io::Result<Box<dyn BufRead>> {
        let file: &[u8] = match path.to_str() {
            Some("a.obj") => {
                b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl tin\nf 1/1 2/2 3/3\nusemtl oak\nf 3 2 1\n"
            }
            Some("a.hex") => b"000000\nff8000\nffffff\n",
            Some("a.png") => TEXEL,
            _ => return Err(io::ErrorKind::NotFound.into()),
        };
        Ok(Box::new(file))
    };
    match Scene::from_toml_bytes(bytes, "scene.toml", open) {
        Ok(loaded) => {
            loaded.warnings.iter().for_each(|warning| assert_one_line(warning));
            check_scene(loaded.scene);
        }
        Err(error) => {
            let said = error.to_string();
            assert!(said.starts_with("scene.toml:") && said.len() < 10_000, "{said:?}");
            assert_one_line(&said);
            if let Some(place) = error.place {
                let text = String::from_utf8_lossy(bytes);
                let line = text.split('\n').nth(place.line - 1).expect("a line of the file");
                // One more than there are, for the end of the line.
                assert!((1..=line.chars().count() + 1).contains(&place.column), "{said}");
            }
            if matches!(*error.kind, SceneErrorKind::UnknownKey { .. } | SceneErrorKind::MissingKey) {
                assert!(error.key.is_some(), "{said}");
            }
        }
    }
}

/// Every scene read from a file has valid numbers at any time, so it can be drawn.
fn check_scene(mut scene: Scene) {
    assert!(!scene.objects().is_empty() && scene.duration > 0.0 && scene.duration <= 3600.0);
    let triangles: usize = scene.objects().iter().map(|object| object.mesh().triangles().len()).sum();
    assert!(triangles as u64 <= MAX_TRIANGLES + 2 * scene.objects().len() as u64);
    for seconds in [0.0, 0.3 * scene.duration, 1e9, -1.0] {
        scene.set_time(seconds);
        // What is still too large for f32, a camera that reaches its target, or a sun that becomes zero, is rejected
        // when drawn. Large scenes take long.
        if triangles < 500 && scene.objects().len() < 20 && scene.settings.tessellation.is_none() {
            let _ = Renderer::new().draw(&scene, &mut Vga::new());
        }
    }
}

/// Command-line arguments that the library parses.
pub fn words(bytes: &[u8]) {
    let words = String::from_utf8_lossy(bytes);
    match Scale::from_str(&words) {
        Ok(scale) => {
            let (width, height) = scale.size(320, 200);
            let sides = 1..=usize::from(MAX_SIDE);
            assert!(sides.contains(&width) && sides.contains(&height), "{scale}");
            assert_eq!(scale.to_string().parse(), Ok(scale));
        }
        Err(error) => assert_one_line(&error.to_string()),
    }
    match Shading::from_str(&words) {
        Ok(shading) => assert_eq!(shading.name(), words),
        Err(error) => assert_one_line(&error.to_string()),
    }
    match words.parse::<Kernel>() {
        Ok(kernel) => assert_eq!(kernel.name(), words),
        Err(error) => assert_one_line(&error.to_string()),
    }
    assert_eq!(shapes::by_name(&words).is_some(), shapes::NAMES.contains(&&*words));
    assert_eq!(
        builtin::by_name(&words).map(|builtin| builtin.name),
        builtin::ALL.iter().map(|b| b.name).find(|n| *n == words)
    );
    if let Some(format) = Format::of_file_name(&words) {
        let extension = words.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
        assert!(format.extensions.contains(&extension.as_str()), "{words}");
    }
}

/// A picture for a texture.
pub fn texture(bytes: &[u8]) {
    match texture::decode(io::Cursor::new(bytes)) {
        Ok(texture) => {
            let is_side = |side: u32| side.is_power_of_two() && side <= Texture::MAX_SIDE;
            assert!(is_side(texture.width()) && is_side(texture.height()));
            assert_eq!(texture.texels().len() as u32, texture.width() * texture.height());
            assert_eq!(texture.histogram().iter().sum::<u32>(), texture.width() * texture.height());
        }
        Err(error) => assert_one_line(&error.to_string()),
    }
}

/// An animation made from the bytes: its size, its rate, and for each frame one of four palettes and the pixels.
/// Decoded, it shows the given colours, each for as long as the rate says.
pub fn gif(bytes: &[u8]) {
    let [width, height, rate, pixels @ ..] = bytes else { return };
    let [width, height] = [width, height].map(|side| 1 + usize::from(*side) % 12);
    let rate = FrameRate::try_from(1.0 + f64::from(*rate) % 50.0).expect("1 to 50 a second");
    let colors = |number: u8| -> [Rgb; 256] {
        core::array::from_fn(|i| {
            let i = i as u8;
            // In two of them neighbouring entries have the same colour.
            let i = if number.is_multiple_of(2) { i } else { i & !1 };
            Rgb::new(i.wrapping_mul(number | 1), i.rotate_left(u32::from(number)), i)
        })
    };
    let palettes = [0, 1, 2, 3].map(colors);
    let frames: Vec<(&[Rgb; 256], &[u8])> = pixels
        .chunks_exact(1 + width * height)
        .take(40)
        .filter_map(|frame| frame.split_first().map(|(palette, pixels)| (&palettes[usize::from(palette % 4)], pixels)))
        .collect();
    if frames.is_empty() {
        return;
    }
    let mut film = GifWriter::new(Vec::new(), Scale::One, rate);
    for (palette, pixels) in &frames {
        let picture = Picture { pixels, width, height, pitch: width, palette, shape: PixelShape::default() };
        film.add(&picture).expect("a legal picture");
    }
    let (file, _) = film.finish().expect("a vector takes all");
    // What is visible, and until when, in hundredths of a second; unchanged pictures are merged.
    let mut expected: Vec<(Vec<Rgb>, u64)> = Vec::new();
    for (number, (palette, pixels)) in frames.iter().enumerate() {
        let ends = (100.0 * (number + 1) as f64 / rate.frames_per_second()).ceil() as u64;
        let shown = pixels.iter().map(|pixel| palette[usize::from(*pixel)]).collect();
        put(&mut expected, shown, ends);
    }
    let (mut shown, mut ends) = (Vec::new(), 0);
    for image in film::decode(&file).images {
        ends += image.delay;
        put(&mut shown, image.shown, ends);
    }
    assert!(shown == expected, "{width} × {height}, {} frames a second", rate.frames_per_second());
}

fn put(list: &mut Vec<(Vec<Rgb>, u64)>, shown: Vec<Rgb>, until: u64) {
    match list.last_mut() {
        Some((last, ends)) if *last == shown => *ends = until,
        _ => list.push((shown, until)),
    }
}

fn assert_one_line(said: &str) {
    assert!(!said.is_empty() && !said.contains(char::is_control), "{said:?}");
}
