//! glTF: every way to write a mesh gives the mesh that OBJ gives, materials follow their rule, and errors name the
//! faulty part.

use std::collections::HashMap;
use std::io;
use std::path::{Path, PathBuf};

use mode13h::glam::{Vec2, Vec3};
use mode13h::mesh::{Mesh, Surface, shapes};
use mode13h::palette::Rgb;
use mode13h::scene::UpAxis;
use mode13h_assets::model_file::{self, Loaded, Options};

use crate::model_files::{Faces, contents, loaded, refused};

/// A glTF file under construction: the entries of its lists, and its buffer.
#[derive(Default)]
pub(crate) struct Gltf {
    pub(crate) bytes: Vec<u8>,
    pub(crate) lists: HashMap<&'static str, Vec<String>>,
    /// Further members of the root object.
    pub(crate) more: String,
}

impl Gltf {
    /// Adds an entry to a list, and returns its index.
    pub(crate) fn add(&mut self, list: &'static str, entry: impl Into<String>) -> usize {
        let list = self.lists.entry(list).or_default();
        list.push(entry.into());
        list.len() - 1
    }

    fn view(&mut self, bytes: &[u8], stride: Option<usize>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let (offset, length) = (self.bytes.len(), bytes.len());
        self.bytes.extend(bytes);
        let stride = stride.map_or(String::new(), |stride| format!(",\"byteStride\":{stride}"));
        self.add("bufferViews", format!("{{\"buffer\":0,\"byteOffset\":{offset},\"byteLength\":{length}{stride}}}"))
    }

    /// An accessor over rows that follow one another.
    pub(crate) fn accessor(&mut self, bytes: &[u8], component: u32, count: usize, kind: &str, more: &str) -> usize {
        let view = self.view(bytes, None);
        self.add(
            "accessors",
            format!(
                "{{\"bufferView\":{view},\"componentType\":{component},\"count\":{count},\"type\":\"{kind}\"{more}}}"
            ),
        )
    }

    pub(crate) fn floats<const N: usize>(&mut self, rows: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = rows.as_flattened().iter().flat_map(|c| c.to_le_bytes()).collect();
        // Accessors for positions must have bounds; nothing reads them.
        let bounds = if N == 3 { ",\"min\":[0,0,0],\"max\":[0,0,0]" } else { "" };
        self.accessor(&bytes, 5126, rows.len(), &format!("VEC{N}"), bounds)
    }

    pub(crate) fn indices(&mut self, indices: &[u32], component: u32) -> usize {
        let bytes: Vec<u8> = match component {
            5121 => indices.iter().map(|&i| i as u8).collect(),
            5123 => indices.iter().flat_map(|&i| (i as u16).to_le_bytes()).collect(),
            _ => indices.iter().flat_map(|&i| i.to_le_bytes()).collect(),
        };
        self.accessor(&bytes, component, indices.len(), "SCALAR", "")
    }

    /// A mesh of one primitive; `more` follows its attributes.
    pub(crate) fn mesh(&mut self, attributes: &str, more: &str) -> usize {
        self.add("meshes", format!("{{\"primitives\":[{{\"attributes\":{{{attributes}}}{more}}}]}}"))
    }

    /// A mesh of one primitive in a node of its own.
    pub(crate) fn shown(&mut self, attributes: &str, more: &str) {
        let mesh = self.mesh(attributes, more);
        self.add("nodes", format!("{{\"mesh\":{mesh}}}"));
    }

    /// Replaces a text in all entries of a list.
    pub(crate) fn replace(&mut self, list: &str, from: &str, to: &str) {
        self.lists.get_mut(list).expect("a list").iter_mut().for_each(|entry| *entry = entry.replace(from, to));
    }

    pub(crate) fn json(&self, buffer: &str) -> String {
        let lists: String = self.lists.iter().map(|(name, list)| format!(",\"{name}\":[{}]", list.join(","))).collect();
        let length = self.bytes.len();
        let buffers =
            if length > 0 { format!(",\"buffers\":[{{\"byteLength\":{length}{buffer}}}]") } else { String::new() };
        format!("{{\"asset\":{{\"version\":\"2.0\"}}{buffers}{lists}{}}}", self.more)
    }

    pub(crate) fn glb(&self) -> Vec<u8> {
        glb(self.json(""), &self.bytes)
    }
}

/// A file of a JSON chunk and a binary one.
fn glb(json: String, bytes: &[u8]) -> Vec<u8> {
    let (mut text, mut body) = (json.into_bytes(), bytes.to_vec());
    text.resize(text.len().next_multiple_of(4), b' ');
    body.resize(body.len().next_multiple_of(4), 0);
    let word = |length: usize| (length as u32).to_le_bytes();
    let head = [*b"glTF", word(2), word(12 + 8 + text.len() + 8 + body.len()), word(text.len()), *b"JSON"];
    [head.as_flattened(), &text, &word(body.len()), b"BIN\0", &body].concat()
}

/// Positions and triangles of a shape, each point once, in the order in which the triangles use them.
pub(crate) fn points_of(mesh: &Mesh) -> (Vec<[f32; 3]>, Vec<u32>) {
    let Faces { positions, faces } = Faces::of_shape(mesh);
    (positions, faces.concat())
}

fn obj(positions: &[[f32; 3]], indices: &[u32]) -> Mesh {
    let faces = indices.chunks(3).map(<[u32]>::to_vec).collect();
    loaded(Faces { positions: positions.to_vec(), faces }.obj(), "a.obj").mesh
}

const TRIANGLE: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// A file with a triangle in nodes[0]; `more` follows the mesh's attributes.
fn with_triangle(more: &str) -> Gltf {
    let mut file = Gltf::default();
    let positions = file.floats(&TRIANGLE);
    file.shown(&format!("\"POSITION\":{positions}"), more);
    file
}

#[test]
fn every_container_gives_the_mesh_that_obj_gives() {
    for shape in [shapes::cube(), shapes::torus(12, 6)] {
        let (positions, indices) = points_of(&shape);
        let expected = obj(&positions, &indices);
        for component in [5121, 5123, 5125] {
            let mut file = Gltf::default();
            let (position, index) = (file.floats(&positions), file.indices(&indices, component));
            file.shown(&format!("\"POSITION\":{position}"), &format!(",\"indices\":{index}"));
            let beside = file.json(",\"uri\":\"the%20bytes.bin\"");
            let bytes = |path: &Path| match path == Path::new("folder/the bytes.bin") {
                true => Ok(file.bytes.clone()),
                false => Err(io::ErrorKind::NotFound.into()),
            };
            let named = model_file::parse(beside.as_bytes(), "folder/a.gltf", bytes, &Options::default()).unwrap();
            assert_eq!(named.files, [PathBuf::from("folder/the bytes.bin")]);
            let percent: String = file.bytes.iter().map(|byte| format!("%{byte:02x}")).collect();
            let inside = file.json(&format!(",\"uri\":\"data:application/octet-stream,{percent}\""));
            for model in [
                loaded(file.glb(), "a.glb"),
                loaded(file.glb(), "standard input"),
                loaded(&inside, "a.gltf"),
                loaded(&inside, "standard input"),
                named,
            ] {
                assert_eq!(contents(&model.mesh), contents(&expected));
                assert_eq!((model.up, model.warnings.as_slice()), (Some(UpAxis::Y), &[][..]));
            }
        }
    }
}

/// Ten thousand buffers with the same megabyte need one megabyte, not ten gigabytes.
#[test]
fn buffers_share_a_file_or_a_chunk() {
    let mut file = with_triangle("");
    let expected = loaded(file.glb(), "a.glb").mesh;
    file.bytes.resize(1 << 20, 0);
    let many = |uri: &str| {
        let buffer = format!("{{\"byteLength\":{}{uri}}}", file.bytes.len());
        file.json(uri).replace(&buffer, &vec![buffer.as_str(); 10_000].join(","))
    };
    let mut reads = 0;
    let read = |_: &Path| {
        reads += 1;
        Ok(file.bytes.clone())
    };
    let json = many(",\"uri\":\"same.bin\"");
    let model = model_file::parse(json.as_bytes(), "a.gltf", read, &Options::default()).unwrap();
    assert_eq!((contents(&model.mesh), reads), (contents(&expected), 1));
    assert_eq!(contents(&loaded(glb(many(""), &file.bytes), "a.glb").mesh), contents(&expected));
}

#[test]
fn a_missing_buffer_is_named_on_one_short_line() {
    let mut file = Gltf::default();
    let position = file.floats(&TRIANGLE);
    file.shown(&format!("\"POSITION\":{position}"), "");
    let missing = |_: &Path| Err(io::ErrorKind::NotFound.into());
    let long = "A".repeat(2_000);
    let not_found = |name: &str| format!("{}: entity not found", Path::new("folder").join(name).display());
    for (uri, expected) in [
        ("gone.bin", not_found("gone.bin")),
        (&long, not_found(&format!("{}…", &long[..255]))),
        ("a%0Ab", not_found("a\u{FFFD}b")),
        // Not a file's name.
        (&format!("data:;base64{long}"), String::from("a data URI without a comma")),
    ] {
        let json = file.json(&format!(",\"uri\":\"{uri}\""));
        let error = model_file::parse(json.as_bytes(), "folder/a.gltf", missing, &Options::default()).unwrap_err();
        assert_eq!(error.to_string(), format!("folder/a.gltf: buffers[0]: {expected}"));
    }
}

#[test]
fn strips_fans_and_lists_without_indices() {
    let positions =
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.5, 2.0, 0.0], [2.0, 2.0, 1.0]];
    for (mode, triangles) in [
        (4, vec![0, 1, 2, 3, 4, 5]),
        (5, vec![0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5]),
        (6, vec![0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5]),
    ] {
        let mut file = Gltf::default();
        let position = file.floats(&positions);
        file.shown(&format!("\"POSITION\":{position}"), &format!(",\"mode\":{mode}"));
        let (found, expected) = (loaded(file.glb(), "a.glb").mesh, obj(&positions, &triangles));
        assert_eq!(contents(&found), contents(&expected), "mode {mode}");
    }
}

/// A tree of nodes: a quarter turn, a reflection and a stretch, all exact in f32.
#[test]
fn nodes_place_their_meshes() {
    let (positions, indices) = points_of(&shapes::torus(8, 4));
    let mut file = Gltf::default();
    let (position, index) = (file.floats(&positions), file.indices(&indices, 5125));
    file.mesh(&format!("\"POSITION\":{position}"), &format!(",\"indices\":{index}"));
    file.add("nodes", "{\"children\":[1,2],\"matrix\":[0,1,0,0,-1,0,0,0,0,0,1,0,8,0,0,1]}");
    file.add("nodes", "{\"mesh\":0,\"scale\":[2,1,0.5]}");
    file.add("nodes", "{\"mesh\":0,\"scale\":[-1,1,1],\"translation\":[0,0,16]}");
    file.add("nodes", "{\"mesh\":0}");
    file.add("scenes", "{\"nodes\":[3]}");
    file.add("scenes", "{\"nodes\":[0]}");
    file.more = ",\"scene\":1".into();
    let turned = |[x, y, z]: [f32; 3]| [8.0 - y, x, z];
    let mut placed: Vec<[f32; 3]> = positions.iter().map(|&[x, y, z]| turned([2.0 * x, y, 0.5 * z])).collect();
    placed.extend(positions.iter().map(|&[x, y, z]| turned([-x, y, z + 16.0])));
    let mut triangles = indices.clone();
    let count = positions.len() as u32;
    triangles.extend(indices.as_chunks::<3>().0.iter().flat_map(|&[a, b, c]| [a, c, b].map(|i| i + count)));
    let model = loaded(file.glb(), "a.glb");
    let expected = obj(&placed, &triangles);
    assert_eq!(contents(&model.mesh), contents(&expected));
    assert_eq!(model.warnings, [""; 0], "nothing is inside out");
}

/// The normal of a slanted face stays perpendicular to it when the node stretches it, also with a reflection.
#[test]
fn normals_go_with_their_faces() {
    for scale in ["[1,1,1]", "[4,1,1]", "[1,-3,1]", "[-2,-1,-5]"] {
        let mut file = Gltf::default();
        let positions = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let (position, normal) = (file.floats(&positions), file.floats(&[[2.0, 2.0, 2.0]; 3]));
        file.mesh(&format!("\"POSITION\":{position},\"NORMAL\":{normal}"), "");
        file.add("nodes", format!("{{\"mesh\":0,\"scale\":{scale}}}"));
        let mesh = loaded(file.glb(), "a.glb").mesh;
        let [a, b, c] = mesh.triangles()[0].map(|vertex| mesh.positions()[vertex as usize]);
        let expected = (b - a).cross(c - a).normalize();
        // Both are unit vectors, each with a few roundings of 2⁻²⁴.
        assert!((mesh.normals()[0] - expected).length() < 2f32.powi(-21), "{scale}: {} {expected}", mesh.normals()[0]);
    }
}

/// Positions, texture coordinates and colours as integers, with a stride, and with sparse changes.
#[test]
fn numbers_of_all_types() {
    let mut file = Gltf::default();
    let rows: [[i16; 4]; 3] = [[-32767, 0, 0, 99], [32767, 0, 0, 99], [0, 16384, 0, 99]];
    let bytes: Vec<u8> = rows.as_flattened().iter().flat_map(|c| c.to_le_bytes()).collect();
    let view = file.view(&bytes, Some(8));
    let change = [file.view(&[1, 0], None), file.view(&[0, 0, 1, 0, 0, 0], None)];
    let [at, new] = change;
    let position = file.add(
        "accessors",
        format!(
            "{{\"bufferView\":{view},\"componentType\":5122,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[0,0,0],\
             \"sparse\":{{\"count\":1,\"indices\":{{\"bufferView\":{at},\"componentType\":5123}},\
             \"values\":{{\"bufferView\":{new}}}}}}}"
        ),
    );
    let pair = file.accessor(&[0, 255, 51, 0, 255, 102], 5121, 3, "VEC2", ",\"normalized\":true");
    file.shown(&format!("\"POSITION\":{position},\"TEXCOORD_0\":{pair}"), "");
    let mesh = loaded(file.glb(), "a.glb").mesh;
    let places: Vec<[f32; 3]> = mesh.positions().iter().map(|p| p.to_array()).collect();
    assert_eq!(places, [[-32767.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 16384.0, 0.0]]);
    // v runs up.
    assert_eq!(mesh.texcoords().unwrap(), [Vec2::ZERO, Vec2::new(0.2, 1.0), Vec2::new(1.0, 0.6)]);
}

/// An accessor without a buffer view has zeros, of which sparse values may replace some.
#[test]
fn numbers_without_bytes_are_zeros() {
    let places = |count: usize| {
        let mut file = Gltf::default();
        let (at, new) = (file.view(&[1, 0, 7, 0], None), file.view(&[0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 2, 0], None));
        let sparse = format!(
            "\"sparse\":{{\"count\":2,\"indices\":{{\"bufferView\":{at},\"componentType\":5123}},\
             \"values\":{{\"bufferView\":{new}}}}}"
        );
        let bounds = "\"min\":[0,0,0],\"max\":[0,0,0]";
        let kind = format!("\"count\":{count},\"type\":\"VEC3\",\"componentType\":5122,{bounds}");
        let position = file.add("accessors", format!("{{{kind},{sparse}}}"));
        let zeros = file.add("accessors", format!("{{{kind}}}"));
        let index = file.indices(&[0, 1, 7], 5125);
        file.shown(&format!("\"POSITION\":{position}"), &format!(",\"indices\":{index}"));
        (file, zeros)
    };
    let of_mesh = |file: &Gltf| loaded(file.glb(), "a.glb").mesh.positions().to_vec();
    let expected = [Vec3::ZERO, Vec3::Y, Vec3::Z * 2.0];
    for count in [8, 70_000, 1 << 20] {
        assert_eq!(of_mesh(&places(count).0), expected, "{count}");
    }
    // A mesh all of whose vertices are at 0 has no area, but that is not an error.
    let (mut file, zeros) = places(8);
    file.shown(&format!("\"POSITION\":{zeros}"), ",\"mode\":5");
    assert_eq!(of_mesh(&file)[..3], expected);
    let what = "a.glb: meshes[0].primitives[0]: accessors[0]: more than 1,048,576 elements without a bufferView";
    assert_eq!(refused(places((1 << 20) + 1).0.glb(), "a.glb"), what);
}

/// A moving triangle whose positions are among others, at `places`.
fn triangle_among(count: usize, places: [u32; 3]) -> Gltf {
    let mut file = Gltf::default();
    let mut positions = vec![[f32::INFINITY; 3]; count];
    places.iter().zip(TRIANGLE).for_each(|(&place, position)| positions[place as usize] = position);
    let (position, index) = (file.floats(&positions), file.indices(&places, 5125));
    let (times, moves) = (file.accessor(&[0; 4], 5126, 1, "SCALAR", ""), file.floats(&[[0.0, 1.0, 0.0]]));
    file.shown(&format!("\"POSITION\":{position}"), &format!(",\"indices\":{index}"));
    let channel = "{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"translation\"}}";
    let sampler = format!("{{\"input\":{times},\"output\":{moves}}}");
    file.add("animations", format!("{{\"channels\":[{channel}],\"samplers\":[{sampler}]}}"));
    file
}

/// Many nodes may share a list of which each uses little: the rest is neither placed nor stored for motion.
#[test]
fn vertices_without_a_triangle_are_not_placed() {
    let expected = loaded(triangle_among(3, [0, 1, 2]).glb(), "a.glb");
    assert!(expected.rig.is_some());
    assert_eq!(loaded(triangle_among(99, [7, 90, 31]).glb(), "a.glb"), expected);
}

/// A picture with a red pixel, and a blue one below or beside it.
pub(crate) fn picture(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header().unwrap().write_image_data(&[255, 0, 0, 0, 0, 255]).unwrap();
    bytes
}

/// A triangle with a texture. `image` describes the image, given the view of the picture's bytes; `base` follows the
/// texture's index, and `more` the texture, in the material.
fn textured(image: impl FnOnce(usize) -> String, base: &str, more: &str) -> Gltf {
    let mut file = Gltf::default();
    let (positions, pairs) = (file.floats(&TRIANGLE), file.floats(&[[0.0, 0.0], [0.25, 0.5], [1.0, 1.0]]));
    let view = file.view(&picture(1, 2), None);
    file.add("images", image(view));
    file.add("textures", "{\"source\":0}");
    let texture = format!("\"baseColorTexture\":{{\"index\":0{base}}}");
    file.add("materials", format!("{{\"pbrMetallicRoughness\":{{{texture}{more}}}}}"));
    file.shown(&format!("\"POSITION\":{positions},\"TEXCOORD_0\":{pairs}"), ",\"material\":0");
    file
}

#[test]
fn textures_lie_as_the_file_says() {
    for (transform, expected) in [
        ("", [[0.0, 0.0], [0.25, 0.5], [1.0, 1.0]]),
        ("\"offset\":[0.5,0.25],\"scale\":[2,0.5]", [[0.5, 0.25], [1.0, 0.5], [2.5, 0.75]]),
        // Counter-clockwise as seen with v pointing down: u increases, so v decreases.
        ("\"rotation\":1.5707963267948966", [[0.0, 0.0], [0.5, -0.25], [1.0, -1.0]]),
    ] {
        let extension = format!(",\"extensions\":{{\"KHR_texture_transform\":{{{transform}}}}}");
        let image = |view| format!("{{\"bufferView\":{view},\"mimeType\":\"image/png\"}}");
        let base = if transform.is_empty() { "" } else { &extension };
        let file = textured(image, base, ",\"metallicFactor\":0");
        let Loaded { mesh, textures, files, .. } = loaded(file.glb(), "a.glb");
        for (pair, [u, v]) in mesh.texcoords().unwrap().iter().zip(expected) {
            // The angle is a quarter turn up to the rounding of f32.
            assert!((*pair - Vec2::new(u, 1.0 - v)).length() < 1e-6, "{transform}: {pair} {u} {v}");
        }
        let name = mesh.surfaces()[0].texture.as_ref().unwrap();
        // The upper row has the higher v.
        assert_eq!([0, 1].map(|y| textures[name][(0, y)]), [Rgb::new(0, 0, 255), Rgb::new(255, 0, 0)]);
        assert!(files.is_empty());
    }
}

/// Textures repeat here. Any other wrapping mode gives a warning; clamping does so only where coordinates leave the
/// texture.
#[test]
fn textures_that_clamp_are_a_warning() {
    let image = |view| format!("{{\"bufferView\":{view}}}");
    let moved = |offset: &str| {
        format!(",\"extensions\":{{\"KHR_texture_transform\":{{\"offset\":{offset},\"scale\":[0.5,0.5]}}}}")
    };
    let (inside, right) = (moved("[0.5,0.5]"), moved("[0.75,0]"));
    let (rounded, above) = (moved("[0.5000005,-0.0000005]"), moved("[0,-0.01]"));
    let of = |modes: &str, base: &str| {
        let mut file = textured(image, base, "");
        file.replace("textures", "}", ",\"sampler\":0}");
        file.add("samplers", format!("{{{modes}}}"));
        loaded(file.glb(), "a.glb").warnings
    };
    let (both, only_u, only_v) = ("\"wrapS\":33071,\"wrapT\":33071", "\"wrapS\":33071", "\"wrapT\":33071");
    let clamped = ["a.glb: left out: clamped textures"];
    for (modes, base, expected) in [
        ("", right.as_str(), &[][..]),
        (both, "", &[]),
        (both, &inside, &[]),
        (both, &rounded, &[]),
        (both, &right, &clamped),
        (only_u, &right, &clamped),
        (only_v, &right, &[]),
        (both, &above, &clamped),
        (only_u, &above, &[]),
        ("\"wrapS\":33648", "", &["a.glb: left out: mirrored textures"]),
    ] {
        assert_eq!(of(modes, base), expected, "{modes} {base}");
    }
}

/// An image without a stated type is recognized by its bytes; one without bytes is rejected, with its position.
#[test]
fn images_need_bytes_and_no_type() {
    let file = textured(|view| format!("{{\"bufferView\":{view}}}"), "", "");
    let Loaded { mesh, textures, .. } = loaded(file.glb(), "a.glb");
    let name = mesh.surfaces()[0].texture.as_ref().unwrap();
    assert_eq!(textures[name][(0, 0)], Rgb::new(0, 0, 255));
    let error = refused(textured(|_| "{\"name\":\"nothing\"}".into(), "", "").glb(), "a.glb");
    assert!(error.ends_with("images[0]: has neither a uri nor a bufferView"), "{error}");
}

/// The material rule, implemented a second time.
#[test]
fn materials_follow_the_rule() {
    let srgb = |linear: f64| if linear <= 0.0031308 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    for (base, metal, rough) in [(0.5, 0.0, 0.5), (0.25, 1.0, 0.25), (1.0, 0.5, 1.0), (0.001, 0.75, 0.0)] {
        let mut file = with_triangle(",\"material\":0");
        file.add(
            "materials",
            format!(
                "{{\"name\":\"tin\",\"alphaMode\":\"BLEND\",\"emissiveFactor\":[0,1,0],\"pbrMetallicRoughness\":\
                 {{\"baseColorFactor\":[{base},{base},0,0.25],\"metallicFactor\":{metal},\"roughnessFactor\":{rough}}}}}"
            ),
        );
        let mesh = loaded(file.glb(), "a.glb").mesh;
        let [surface] = mesh.surfaces() else { panic!("{:?}", mesh.surfaces()) };
        let b = srgb(base);
        let diffuse = [b * (1.0 - metal * (1.0 - rough) / 2.0), 1.0, 0.0];
        let specular = [b, b, 0.0].map(|b| (1.0 - rough) * ((1.0 - metal) * srgb(0.04) + metal * b));
        let shininess = (2.0 / f64::powi(rough, 4) - 2.0).min(1000.0);
        assert_eq!((surface.name.as_str(), surface.opacity), ("tin", 0.25));
        for (found, expected) in surface.diffuse.iter().chain(&surface.specular).zip(diffuse.iter().chain(&specular)) {
            // One rounding to f32 of a number up to 1, and factors that are read as f32.
            assert!((f64::from(*found) - expected).abs() < 1e-6, "{surface:?}: {expected}");
        }
        assert!((f64::from(surface.shininess) - shininess).abs() <= 1e-6 * shininess, "{surface:?}: {shininess}");
    }
}

/// The warning is that of MTL files with `d 0`, and is given only where the mode uses alpha.
#[test]
fn fully_transparent_materials_are_opaque_with_a_warning() {
    let warning = "a.glb: a fully transparent material is drawn opaque; its alpha is left out";
    for (mode, alpha, opacity, expected) in [
        ("BLEND", "0", 1.0, &[warning][..]),
        ("BLEND", "-1", 1.0, &[warning]),
        ("BLEND", "0.25", 0.25, &[]),
        ("MASK", "0", 1.0, &[]),
        ("OPAQUE", "0", 1.0, &[]),
    ] {
        let mut file = with_triangle(",\"material\":0");
        let base = format!("\"pbrMetallicRoughness\":{{\"baseColorFactor\":[1,1,1,{alpha}]}}");
        file.add("materials", format!("{{\"alphaMode\":\"{mode}\",{base}}}"));
        let Loaded { mesh, warnings, .. } = loaded(file.glb(), "a.glb");
        assert_eq!(mesh.surfaces()[0].opacity, opacity, "{mode} {alpha}");
        assert_eq!(warnings, expected, "{mode} {alpha}");
    }
}

/// The means of a metallic-roughness texture count, wherever its picture is; without them there is a warning.
#[test]
fn metallic_roughness_is_read_from_a_file_too() {
    let read = |image: fn(usize) -> String, picture: Option<Vec<u8>>| {
        let mut file = textured(image, "", "");
        file.replace("materials", "baseColorTexture", "metallicRoughnessTexture");
        let beside = |_: &Path| picture.clone().ok_or_else(|| io::ErrorKind::NotFound.into());
        model_file::parse(&file.glb()[..], "folder/a.glb", beside, &Options::default()).unwrap()
    };
    let inside = read(|view| format!("{{\"bufferView\":{view}}}"), None);
    let outside = |picture| read(|_| "{\"uri\":\"a%20b.png\"}".into(), picture);
    let found = outside(Some(picture(1, 2)));
    assert_eq!(found.mesh.surfaces(), inside.mesh.surfaces());
    assert_eq!((found.warnings.len(), found.files), (0, vec![Path::new("folder").join("a b.png")]));
    // A mean of 0 for roughness and half of full light for metal.
    assert_eq!(found.mesh.surfaces()[0].diffuse, [0.75; 3]);
    for picture in [None, Some(b"no picture".to_vec())] {
        let warnings = outside(picture).warnings;
        assert_eq!(warnings, ["folder/a.glb: left out: metallic-roughness textures that cannot be read"]);
    }
}

/// Faces with coloured vertices get the mean, in sRGB.
#[test]
fn colors_of_vertices_are_texels() {
    let mut file = Gltf::default();
    let positions = file.floats(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]);
    let colors = file.accessor(
        &[255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 0, 0, 0, 255],
        5121,
        4,
        "VEC4",
        ",\"normalized\":true",
    );
    file.mesh(&format!("\"POSITION\":{positions}"), ",\"mode\":5");
    file.mesh(&format!("\"POSITION\":{positions},\"COLOR_0\":{colors}"), ",\"mode\":5");
    file.add("nodes", "{\"mesh\":0,\"translation\":[0,0,1]}");
    file.add("nodes", "{\"mesh\":1}");
    let Loaded { mesh, textures, .. } = loaded(file.glb(), "a.glb");
    assert_eq!(mesh.surfaces().iter().map(|surface| surface.texture.is_some()).collect::<Vec<_>>(), [false, true]);
    let texture = &textures[mesh.surfaces()[1].texture.as_ref().unwrap()];
    let color = |triangle: usize| {
        let pair = mesh.texcoords().unwrap()[mesh.triangles()[triangle][0] as usize] * 16.0;
        texture[(pair.x as u32, pair.y as u32)]
    };
    // A third of full light is 0.6124 in sRGB, 156.2 of 255.
    assert_eq!([2, 3].map(color), [Rgb::new(156, 156, 156), Rgb::new(0, 156, 156)]);
}

/// Vertex colours multiply the base colour, and the material itself stays unchanged: there are two of them, painted and
/// plain.
#[test]
fn colors_of_vertices_leave_the_material() {
    let mut file = Gltf::default();
    let positions = file.floats(&TRIANGLE);
    let colors = file.floats(&[[0.0, 0.5, 1.0]; 3]);
    let own = "\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0.5,0.25,0.5],\"metallicFactor\":0.5,\"roughnessFactor\":0.25}";
    file.add(
        "materials",
        format!("{{\"name\":\"glass\",\"alphaMode\":\"BLEND\",\"emissiveFactor\":[0,0.02,0],{own}}}"),
    );
    let unlit = "\"extensions\":{\"KHR_materials_unlit\":{}}";
    file.add("materials", format!("{{\"emissiveFactor\":[1,0,0],{own},{unlit}}}"));
    for material in [0, 1] {
        file.shown(&format!("\"POSITION\":{positions}"), &format!(",\"material\":{material}"));
        let painted = format!("\"POSITION\":{positions},\"COLOR_0\":{colors}");
        file.shown(&painted, &format!(",\"material\":{material}"));
    }
    let Loaded { mesh, textures, .. } = loaded(file.glb(), "a.glb");
    let [plain, painted, unlit, unlit_painted] = mesh.surfaces() else { panic!("{:?}", mesh.surfaces()) };
    let texture = painted.texture.clone();
    let expected = Surface { diffuse: [1.0; 3], texture: texture.clone(), ..plain.clone() };
    assert_eq!((painted, painted.opacity, painted.shininess > 0.0), (&expected, 0.5, true));
    let expected = Surface { diffuse: [1.0; 3], texture: texture.clone(), name: "colours".into(), ..unlit.clone() };
    assert_eq!(unlit_painted, &expected);
    let texture = &textures[&texture.unwrap()];
    let color = |triangle: usize| {
        let pair = mesh.texcoords().unwrap()[mesh.triangles()[triangle][0] as usize] * 16.0;
        texture[(pair.x as u32, pair.y as u32)]
    };
    let srgb = |linear: f64| if linear <= 0.0031308 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    let rounded = |channels: [f64; 3]| Rgb::from_intensities(channels.map(|c| c as f32));
    // A metallic factor of 0.5 and a roughness of 0.25 leave 1 - 0.5 * 0.75 / 2 of the colour.
    let left = 0.8125;
    assert_eq!(color(1), rounded([0.0, left * srgb(0.25) + srgb(0.02), left * srgb(0.25)]));
    assert_eq!(color(3), rounded([1.0, srgb(0.25), srgb(0.25)]));
}

/// White changes nothing.
#[test]
fn colors_of_vertices_with_a_texture_are_a_warning() {
    for (color, expected) in [(1.0, &[][..]), (0.5, &["a.glb: left out: colours of vertices with a texture"])] {
        let mut file = textured(|view| format!("{{\"bufferView\":{view}}}"), "", "");
        let colors = file.floats(&[[1.0, color, 1.0]; 3]);
        file.replace("meshes", "\"POSITION\"", &format!("\"COLOR_0\":{colors},\"POSITION\""));
        assert_eq!(loaded(file.glb(), "a.glb").warnings, expected);
    }
    // Nobody needs them, so they may be faulty.
    let mut file = textured(|view| format!("{{\"bufferView\":{view}}}"), "", "");
    let colors = file.floats(&[[1.0, 0.5]; 3]);
    file.replace("meshes", "\"POSITION\"", &format!("\"COLOR_0\":{colors},\"POSITION\""));
    assert_eq!(loaded(file.glb(), "a.glb").warnings, [""; 0]);
}

/// Primitives that share a list of vertices read only those that they use, so a small file is read in a short time:
/// 20,000 triangles from among a million vertices take 0.15 s; reading all vertices for each takes minutes.
#[test]
fn primitives_share_vertices() {
    let mut file = Gltf::default();
    let positions = file.floats(&[&TRIANGLE[..], &vec![[0.0; 3]; 1 << 20]].concat());
    let indices = file.indices(&[0, 1, 2], 5123);
    let primitive = format!("{{\"attributes\":{{\"POSITION\":{positions}}},\"indices\":{indices}}}");
    file.add("meshes", format!("{{\"primitives\":[{}]}}", vec![primitive; 20_000].join(",")));
    file.add("nodes", "{\"mesh\":0}");
    assert_eq!(loaded(file.glb(), "a.glb").mesh.triangles().len(), 20_000);
}

#[test]
fn errors_say_part_or_place() {
    type Edit = fn(&mut Gltf);
    let edits: [(&str, Edit); 7] = [
        ("read", |_| {}),
        ("a.glb: meshes[0].primitives[0]: there is no vertex 3, only 3", |file| {
            let indices = file.indices(&[0, 1, 3], 5123);
            file.lists.remove("meshes");
            file.mesh("\"POSITION\":0", &format!(",\"indices\":{indices}"));
        }),
        ("a.glb: meshes[0].primitives[0]: accessors[0] ends beyond bufferViews[0]", |file| {
            file.replace("accessors", "\"count\":3", "\"count\":4");
        }),
        ("a.glb: meshes[0].primitives[0]: accessors[0] ends beyond bufferViews[0]", |file| {
            let indices = file.indices(&[0, 1, 2], 5123);
            file.replace("accessors", "\"count\":3,\"type\":\"VEC3\"", "\"count\":4000000000000,\"type\":\"VEC3\"");
            file.lists.remove("meshes");
            file.mesh("\"POSITION\":0", &format!(",\"indices\":{indices}"));
        }),
        ("a.glb: no faces", |file| file.replace("nodes", "}", ",\"children\":[0]}")),
        ("a.glb: nodes[0] is in the scene twice", |file| {
            file.replace("nodes", "}", ",\"children\":[0]}");
            file.add("scenes", "{\"nodes\":[0]}");
        }),
        ("a.glb: needs KHR_draco_mesh_compression, which is not supported", |file| {
            file.more = ",\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]".into();
        }),
    ];
    for (said, edit) in edits {
        let mut file = with_triangle("");
        edit(&mut file);
        assert_eq!(refused(file.glb(), "a.glb"), said);
    }
    let mut nowhere = with_triangle("");
    nowhere.replace("nodes", "0", "7");
    assert!(refused(nowhere.glb(), "a.glb").starts_with("a.glb: nodes[0].mesh: "));
    let refused = |bytes: &[u8]| refused(bytes, "a.glb");
    let mut whole = Gltf::default();
    whole.floats(&TRIANGLE);
    let whole = whole.glb();
    let cut = whole.len() - 1;
    assert_eq!(refused(&whole[..cut]), format!("a.glb: byte {cut}: the file ends where a binary chunk is expected"));
    assert_eq!(refused(&whole[..9]), "a.glb: byte 9: the file ends where a JSON chunk is expected");
    assert_eq!(refused(b"glTF\x01\0\0\0"), "a.glb: byte 4: only glTF 2 is supported, this is 1");
    for (version, is_read) in [("2", true), ("2.9", true), ("1.0", false), ("20", false), ("", false)] {
        let text = with_triangle("").json("").replace("\"version\":\"2.0\"", &format!("\"version\":\"{version}\""));
        let says = refused(text.as_bytes());
        assert_eq!(!says.ends_with("only glTF 2 is supported"), is_read, "{version}: {says}");
    }
    assert!(refused(b"{\n\"asset\": 7\n}").starts_with("a.glb:2: not glTF: invalid type: integer `7`"));
    let missing = "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":3,\"uri\":\"no.bin\"}]}";
    assert_eq!(refused(missing.as_bytes()), "a.glb: buffers[0]: no.bin: entity not found");
}

/// Exporters make faults where nothing is read, and leave out what may be left out.
#[test]
fn faults_of_what_is_not_read_are_no_errors() {
    type Edit = fn(&mut Gltf);
    let edits: [Edit; 7] = [
        |file| file.replace("accessors", ",\"min\":[0,0,0],\"max\":[0,0,0]", ""),
        |file| file.replace("accessors", "\"min\":[0,0,0]", "\"min\":[null,null,0]"),
        |file| {
            file.add("scenes", "{\"nodes\":[0]}");
            file.add("scenes", "{\"name\":\"notes\"}");
        },
        |file| file.replace("meshes", "\"POSITION\":0", "\"POSITION\":0,\"BATCHID\":0"),
        |file| file.replace("bufferViews", "}", ",\"target\":7}"),
        |file| {
            file.add("samplers", "{\"magFilter\":9987,\"minFilter\":1,\"wrapS\":33069}");
        },
        |file| file.more = ",\"extensionsRequired\":[\"KHR_mesh_quantization\"]".into(),
    ];
    for (number, edit) in edits.into_iter().enumerate() {
        let mut file = with_triangle("");
        edit(&mut file);
        let loaded = loaded(file.glb(), "a.glb");
        assert_eq!((loaded.mesh.triangles().len(), loaded.warnings), (1, Vec::<String>::new()), "edit {number}");
    }
    let file = with_triangle("");
    // Bytes after the container.
    assert_eq!(loaded([&file.glb()[..], b"\n"].concat(), "a.glb").mesh.triangles().len(), 1);
    // Base64 with escapes.
    let data = "data:application/octet-stream;base64,";
    let uri = |body: &str| format!(",\"uri\":\"{data}{body}\"");
    let body = base64::Engine::encode(&base64::engine::general_purpose::STANDARD, [&file.bytes[..], &[0]].concat());
    for body in [body.replace('=', "%3D"), body.trim_end_matches('=').replace("AA", "A%41") + "%3D%3D"] {
        assert_eq!(loaded(file.json(&uri(&body)), "a.gltf").mesh.triangles().len(), 1, "{body}");
    }
    // What changes the model is named.
    for (list, name) in [("Required", "VENDOR_hidden"), ("Used", "EXT_mesh_gpu_instancing")] {
        let mut file = with_triangle("");
        file.more = format!(",\"extensions{list}\":[\"{name}\"]");
        assert_eq!(loaded(file.glb(), "a.glb").warnings, [format!("a.glb: ignored what {name} would change")]);
    }
}

/// Programs and extensions may add to a file.
#[test]
fn additions_are_read_over() {
    let mut file = Gltf::default();
    let positions = file.floats(&TRIANGLE);
    file.shown(&format!("\"POSITION\":{positions},\"_FEATURE_ID_0\":{positions}"), ",\"extras\":\"text\"");
    file.shown(&format!("\"NORMAL\":{positions}"), "");
    let key = file.floats(&[[0.0]; 1]);
    file.replace("accessors", "VEC1", "SCALAR");
    file.add(
        "animations",
        format!(
            "{{\"samplers\":[{{\"input\":{key},\"output\":{positions}}}],\"channels\":[{{\"sampler\":0,\"target\":\
             {{\"path\":\"pointer\"}}}},{{\"sampler\":0,\"target\":{{\"node\":0,\"path\":\"translation\"}}}}]}}"
        ),
    );
    file.more = ",\"extras\":[1]".into();
    let loaded = loaded(file.glb(), "a.glb");
    assert_eq!(loaded.mesh.triangles().len(), 1);
    assert_eq!(loaded.warnings, ["a.glb: left out: meshes without positions"]);
}

/// Samplers that share accessors cannot ask for more memory than the file has reason to.
#[test]
fn keys_of_animations_have_a_limit() {
    let mut file = with_triangle("");
    let zeros = |kind: &str| format!("{{\"componentType\":5126,\"count\":1048576,\"type\":\"{kind}\"}}");
    let (times, values) = (file.add("accessors", zeros("SCALAR")), file.add("accessors", zeros("VEC3")));
    let list = |entry: &dyn Fn(usize) -> String| (0..9).map(entry).collect::<Vec<_>>().join(",");
    let samplers = list(&|_| format!("{{\"input\":{times},\"output\":{values}}}"));
    let channels = list(&|i| format!("{{\"sampler\":{i},\"target\":{{\"node\":0,\"path\":\"translation\"}}}}"));
    file.add("animations", format!("{{\"samplers\":[{samplers}],\"channels\":[{channels}]}}"));
    assert_eq!(refused(file.glb(), "a.glb"), "a.glb: animations[0].samplers[8]: more than 16777216 keys");
}

#[test]
fn what_is_left_out_is_one_warning() {
    let mut file = Gltf::default();
    let positions = file.floats(&TRIANGLE);
    file.add("materials", "{\"normalTexture\":{\"index\":0},\"extensions\":{\"KHR_materials_unlit\":{}}}");
    file.add("textures", "{}");
    let targets = format!(",\"material\":0,\"targets\":[{{\"POSITION\":{positions}}}]");
    file.shown(&format!("\"POSITION\":{positions}"), &targets);
    file.shown(&format!("\"POSITION\":{positions}"), ",\"mode\":1");
    file.more = ",\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}}],\
                 \"extensionsUsed\":[\"KHR_materials_unlit\"]"
        .into();
    assert_eq!(
        loaded(file.glb(), "a.glb").warnings,
        ["a.glb: left out: morph targets, normal maps, points and lines, unlit shading"]
    );
}
