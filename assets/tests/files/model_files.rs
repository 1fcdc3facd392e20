//! STL and PLY: each encoding of a mesh gives the mesh that OBJ gives, errors have a position, and the format is
//! detected by content.

use std::fmt::Write;
use std::io;
use std::path::Path;

use mode13h::glam::Vec2;
use mode13h::mesh::{Mesh, shapes};
use mode13h::palette::Rgb;
use mode13h::scene::UpAxis;
use mode13h_assets::model_file::{self, Format, Loaded, ModelFileError, Options};

fn parse(bytes: impl AsRef<[u8]>, name: &str) -> Result<Loaded, ModelFileError> {
    let none = |_: &Path| Err(io::ErrorKind::NotFound.into());
    model_file::parse(bytes.as_ref(), name, none, &Options::default())
}

pub(crate) fn loaded(bytes: impl AsRef<[u8]>, name: &str) -> Loaded {
    parse(bytes, name).unwrap_or_else(|error| panic!("{error}"))
}

pub(crate) fn refused(bytes: impl AsRef<[u8]>, name: &str) -> String {
    match parse(bytes, name) {
        Ok(_) => "read".to_owned(),
        Err(error) => error.to_string(),
    }
}

/// A model to write: positions, and faces of any size.
pub(crate) struct Faces {
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) faces: Vec<Vec<u32>>,
}

impl Faces {
    /// The points of a shape, each once, in the order its triangles use them.
    pub(crate) fn of_shape(mesh: &Mesh) -> Self {
        let mut positions: Vec<[f32; 3]> = Vec::new();
        let mut index = |vertex: u32| {
            let place = mesh.positions()[vertex as usize].to_array();
            positions.iter().position(|known| *known == place).unwrap_or_else(|| {
                positions.push(place);
                positions.len() - 1
            }) as u32
        };
        let faces = mesh.triangles().iter().map(|triangle| triangle.map(&mut index).to_vec()).collect();
        Self { positions, faces }
    }

    /// A box of six squares, and a concave face beside it.
    fn box_and_arrow() -> Self {
        let mut positions: Vec<[f32; 3]> = (0..8).map(|i| [0, 1, 2].map(|axis| (i >> axis & 1) as f32)).collect();
        positions.extend([[3.0, 0.0, 0.0], [5.0, 2.0, 0.0], [3.0, 1.0, 0.0], [1.5, 2.5, 0.0]]);
        let squares = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let mut faces: Vec<Vec<u32>> = squares.iter().map(|face| face.to_vec()).collect();
        faces.push([8, 9, 10, 11].to_vec());
        Self { positions, faces }
    }

    pub(crate) fn obj(&self) -> String {
        let mut text = String::new();
        for [x, y, z] in &self.positions {
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
        for face in &self.faces {
            let corners: Vec<String> = face.iter().map(|corner| (corner + 1).to_string()).collect();
            writeln!(text, "f {}", corners.join(" ")).unwrap();
        }
        text
    }

    fn stl_text(&self) -> String {
        let mut text = "solid facet of a name\n".to_owned();
        for face in &self.faces {
            text += "facet normal 0 nan 0\n  outer loop\n";
            for &corner in face {
                let [x, y, z] = self.positions[corner as usize];
                writeln!(text, "    vertex {x:e} {y:e} {z:e}").unwrap();
            }
            text += "  endloop\nendfacet\n";
        }
        text + "endsolid facet of a name\n"
    }

    /// Triangles only.
    fn stl_binary(&self, head: &[u8]) -> Vec<u8> {
        let mut bytes = head.to_vec();
        bytes.resize(80, b' ');
        bytes.extend((self.faces.len() as u32).to_le_bytes());
        for face in &self.faces {
            bytes.extend([0; 12]);
            bytes.extend(face.iter().flat_map(|&corner| self.positions[corner as usize]).flat_map(f32::to_le_bytes));
            bytes.extend([0; 2]);
        }
        bytes
    }

    /// PLY as `ascii`, `binary_little_endian` or `binary_big_endian`, with an extra element and extra properties.
    fn ply(&self, encoding: &str) -> Vec<u8> {
        let mut bytes = format!(
            "ply\nformat {encoding} 1.0\ncomment of no use\nobj_info either\nelement noise 2\nproperty list uint short a\n\
             property char b\nelement vertex {}\nproperty uchar id\nproperty float x\nproperty double y\nproperty \
             float32 z\nelement face {}\nproperty list uint8 float weights\nproperty list ushort int32 vertex_indices\n\
             end_header\n",
            self.positions.len(),
            self.faces.len()
        )
        .into_bytes();
        let text = encoding == "ascii";
        let mut put = |little: &[u8], shown: String| {
            if text {
                bytes.extend(shown.bytes().chain([b' ']));
            } else if encoding == "binary_little_endian" {
                bytes.extend(little);
            } else {
                bytes.extend(little.iter().rev());
            }
        };
        for rows in [3_u32, 0] {
            put(&rows.to_le_bytes(), rows.to_string());
            for item in 0..rows as i16 {
                put(&(-item).to_le_bytes(), (-item).to_string());
            }
            put(&[251], "-5".into());
        }
        for (i, [x, y, z]) in self.positions.iter().enumerate() {
            put(&[i as u8], (i as u8).to_string());
            put(&x.to_le_bytes(), x.to_string());
            put(&f64::from(*y).to_le_bytes(), y.to_string());
            put(&z.to_le_bytes(), z.to_string());
        }
        for face in &self.faces {
            put(&[1], "1".into());
            put(&0.5_f32.to_le_bytes(), "0.5".into());
            put(&(face.len() as u16).to_le_bytes(), face.len().to_string());
            for corner in face {
                put(&corner.to_le_bytes(), corner.to_string());
            }
        }
        bytes
    }
}

/// Everything in a mesh except its faces' line numbers, which depend on the file.
pub(crate) fn contents(mesh: &Mesh) -> impl PartialEq + core::fmt::Debug + '_ {
    (
        (mesh.positions(), mesh.normals(), mesh.texcoords(), mesh.triangles()),
        (mesh.surfaces(), mesh.triangle_surfaces(), mesh.is_closed(), mesh.is_convex()),
    )
}

#[test]
fn every_encoding_gives_the_mesh_that_obj_gives() {
    for shape in [shapes::cube(), shapes::torus(24, 12), shapes::sphere(16, 8)] {
        let faces = Faces::of_shape(&shape);
        let expected = loaded(faces.obj(), "a.obj").mesh;
        for (name, bytes) in [
            ("a.stl", faces.stl_text().into_bytes()),
            ("b.stl", faces.stl_binary(b"made by hand")),
            ("c.STL", faces.stl_binary(b"solid ")),
            ("a.ply", faces.ply("ascii")),
            ("b.ply", faces.ply("binary_little_endian")),
            ("c.ply", faces.ply("binary_big_endian")),
        ] {
            let model = loaded(&bytes, name);
            assert_eq!(contents(&model.mesh), contents(&expected), "{name}");
            assert_eq!(model.warnings, [""; 0], "{name}");
            assert_eq!(model.up, name.to_lowercase().ends_with(".stl").then_some(UpAxis::Z));
            // Without an extension the contents decide.
            assert_eq!(contents(&loaded(&bytes, "standard input").mesh), contents(&expected), "{name} by its contents");
        }
    }
}

#[test]
fn faces_of_any_size_are_split_as_in_obj() {
    let faces = Faces::box_and_arrow();
    let expected = loaded(faces.obj(), "a.obj").mesh;
    assert_eq!(expected.triangles().len(), 14);
    assert_eq!(contents(&loaded(faces.stl_text(), "a.stl").mesh), contents(&expected));
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        assert_eq!(contents(&loaded(faces.ply(encoding), "a.ply").mesh), contents(&expected), "{encoding}");
    }
}

/// The model's lines, where faces know their line.
#[test]
fn faces_of_texts_have_their_lines() {
    let faces = Faces::box_and_arrow();
    for (bytes, name, first, step) in
        [(faces.stl_text().into_bytes(), "a.stl", 2, 8), (faces.obj().into_bytes(), "a.obj", 13, 1)]
    {
        let mesh = loaded(bytes, name).mesh;
        let lines: Vec<u32> = (0..14).map(|i| mesh.line(i).unwrap()).collect();
        let expected: Vec<u32> = (0..14).map(|i| first + step * (i / 2)).collect();
        assert_eq!(lines, expected, "{name}");
    }
    assert_eq!(loaded(Faces::of_shape(&shapes::cube()).stl_binary(b""), "a.stl").mesh.line(0), None);
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                element face 2\nproperty list char int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n\n3 0 1 2\n3\n2 1 0\n";
    let mesh = loaded(text, "a.ply").mesh;
    assert_eq!((mesh.line(0), mesh.line(1)), (Some(14), Some(15)));
    // A byte order mark is not part of the first line.
    for name in ["a.ply", "a"] {
        let mesh = loaded(format!("\u{FEFF}{text}"), name).mesh;
        assert_eq!((mesh.line(0), mesh.line(1)), (Some(14), Some(15)), "{name}");
    }
}

#[test]
fn corners_in_one_place_are_one_vertex_exactly() {
    let near = f32::from_bits(1.0_f32.to_bits() + 1);
    let text = format!(
        "solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\n\
         facet\nvertex -0 1 0\nvertex 1 -0.0 0\nvertex {near} 1 0\nendfacet\n"
    );
    let mesh = loaded(text, "a.stl").mesh;
    assert_eq!(mesh.triangles(), [[0, 1, 2], [2, 1, 3]]);
}

/// Line ends are blanks, except that a name ends with its line, or where a facet begins.
#[test]
fn text_may_be_on_any_number_of_lines() {
    let cube = Faces::of_shape(&shapes::cube());
    let usual = cube.stl_text();
    let expected = loaded(&usual, "a.stl");
    for text in [
        usual.replace("endfacet\n", "endfacet ").replace("facet of a name", "of a name"),
        usual.replace("  outer loop\n", " outer loop").replace("    vertex", " vertex"),
        usual.replace("facet of a name", "of a name").replace('\n', " "),
        usual.replace("facet of a name\n", "\n").replace('\n', "\t"),
        usual.replace("facet of a name\n", "\n").split_whitespace().map(|word| format!("{word}\n")).collect(),
        usual.replace("solid facet of a name\n", "solid facet\r"),
    ] {
        assert_eq!(contents(&loaded(&text, "a.stl").mesh), contents(&expected.mesh), "{text}");
        assert_eq!(Format::of_bytes(text.as_bytes()), Some(Format::Stl), "{text}");
    }
    let two = "solid a facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet endsolid a \
               solid b facet normal 0 0 1 outer loop vertex 0 0 2 vertex 1 0 2 vertex 0 1 2 endloop endfacet endsolid b";
    assert_eq!(loaded(two, "a.stl").mesh.triangles().len(), 2);
}

/// Zeros after a gzipped file pad a tape block, as in `gzip`; anything else is an error.
#[test]
fn packed_files_may_end_in_zeros() {
    let pack = |text: &str| {
        let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        std::io::Write::write_all(&mut packed, text.as_bytes()).expect("packed");
        packed.finish().expect("packed")
    };
    let [first, second] = ["v 0 0 0\nv 1 0 0\n", "v 0 1 0\nf 1 2 3\n"].map(pack);
    let whole = [&first[..], &second].concat();
    for zeros in [0, 1, 10, 512, 70_000] {
        let bytes = [&whole[..], &vec![0; zeros]].concat();
        assert_eq!(loaded(bytes, "a.obj.gz").mesh.triangles(), [[0, 1, 2]], "{zeros}");
    }
    for garbage in [&b"\x1f"[..], b"garbage that is longer than a header", &second[..second.len() - 1]] {
        let error = refused([&whole[..], garbage].concat(), "a.obj.gz");
        assert!(error.starts_with("a.obj.gz: ") && error != "read", "{error}");
    }
}

#[test]
fn errors_say_line_or_byte() {
    let solid = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n";
    let cube = Faces::of_shape(&shapes::cube()).stl_binary(b"");
    let mut not_finite = cube.clone();
    not_finite[84 + 50 + 12 + 16..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    for (bytes, said) in [
        (format!("{solid}vertex 0 x 0\n").into_bytes(), "a.stl:6: `x` is not a number"),
        (format!("{solid}vertex 0 1e99 0\n").into_bytes(), "a.stl:6: `1e99` is not a finite number"),
        (format!("{solid}vertex 0 0").into_bytes(), "a.stl:6: the file ends where a vertex (3 numbers) is expected"),
        (solid.into(), "a.stl:5: the file ends where endfacet is expected"),
        (format!("{solid}facet\n").into_bytes(), "a.stl:6: expected vertex, endloop or endfacet, found `facet`"),
        ("solid\n\n\rvertex 0 0 0\n".into(), "a.stl:4: expected facet or endsolid, found `vertex`"),
        ("solid\nendsolid\n".into(), "a.stl: no faces"),
        (b"what".into(), "a.stl: byte 4: the file ends where the header of a binary STL is expected"),
        (cube[..cube.len() - 1].into(), "a.stl: byte 683: the file ends in triangle 12 of 12"),
        (not_finite, "a.stl: byte 162: `NaN` is not a finite number"),
    ] {
        assert_eq!(refused(bytes, "a.stl"), said);
    }
    let header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                  element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let binary = header.replace("ascii", "binary_big_endian");
    let rows = "0 0 0\n1 0 0\n0 1 0\n";
    for (text, said) in [
        ("plx\n".to_owned(), "a.ply:1: expected ply, found `plx`"),
        (
            "ply\nformat ebcdic 1.0\n".into(),
            "a.ply:2: expected ascii, binary_little_endian or binary_big_endian, found `ebcdic`",
        ),
        ("ply\nproperty float x\n".into(), "a.ply:2: a property before any element"),
        ("ply\nelement vertex -1\n".into(), "a.ply:2: expected a row count, found `-1`"),
        ("ply\nelement vertex 1\nproperty half x\n".into(), "a.ply:3: expected a number type, found `half`"),
        ("ply\nend_header\n".into(), "a.ply:2: the file ends where a line `format` is expected"),
        ("ply\nformat ascii 1.0\n".into(), "a.ply:2: the file ends where end_header is expected"),
        ("ply\nformat ascii 1.0\nend_header\n".into(), "a.ply: no positions: an element `vertex` needs x, y and z"),
        (format!("{header}{rows}3 0 1 3\n"), "a.ply:13: there is no vertex 3, only 3"),
        (format!("{header}{rows}3 0 1 -1\n"), "a.ply:13: there is no vertex -1, only 3"),
        (format!("{header}{rows}3 0 1 0.5\n"), "a.ply:13: `0.5` is not a vertex index"),
        (format!("{header}{rows}-1\n"), "a.ply:13: expected the length of a list, found `-1`"),
        (format!("{header}{rows}3 0 1\n"), "a.ply:13: the file ends where a number is expected"),
        (format!("{header}0 0 0\n1 inf 0\n"), "a.ply:11: `inf` is not a finite number"),
        (format!("{header}0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"), "a.ply:11: `NaN` is not a finite number"),
        (format!("{header}0 0 0\n1 a 0\n"), "a.ply:11: `a` is not a number"),
        (format!("{header}{rows}2 0 1\n"), "a.ply: no faces"),
        (header.replace("face 1", "face 0") + rows, "a.ply: no faces"),
        (
            binary.clone() + "0123",
            &format!("a.ply: byte {}: the file ends where a number is expected", binary.len() + 4),
        ),
    ] {
        assert_eq!(refused(text, "a.ply"), said);
    }
    assert_eq!(
        loaded(format!("{}{rows}1 0\n3 0 1 2\n", header.replace("face 1", "face 2")), "a.ply").warnings,
        ["a.ply:13: left out a face of fewer than 3 corners"]
    );
}

/// Scanners write NaN for points that they have not measured. They are ignored, unless a face uses one, in any order.
#[test]
fn points_that_were_not_measured_are_left_out() {
    let vertices =
        |count: u32| format!("element vertex {count}\nproperty float x\nproperty float y\nproperty float z\n");
    let faces = "element face 1\nproperty list uchar int vertex_indices\n";
    let text = |header: &str, rows: &str| format!("ply\nformat ascii 1.0\n{header}end_header\n{rows}");
    let whole = text(&(vertices(3) + faces), "500000 0 0\n500001 0 0\n500000 1 0\n3 0 1 2\n");
    let (points, face) = ("500000 0 0\nnan nan nan\n500001 0 0\n500000 1 0\nNaN 1 0\n", "3 0 2 3\n");
    for (header, rows) in [
        (vertices(5) + faces, format!("{points}{face}")),
        (format!("{faces}{}", vertices(5)), format!("{face}{points}")),
    ] {
        assert_eq!(loaded(text(&header, &rows), "a.ply"), loaded(&*whole, "a.ply"));
        let wrong = rows.replace("3 0 2 3", "3 0 2 4");
        let line = 1 + text(&header, &wrong).lines().position(|line| line == "NaN 1 0").unwrap();
        assert_eq!(refused(text(&header, &wrong), "a.ply"), format!("a.ply:{line}: `NaN` is not a finite number"));
    }
}

/// A face gets the mean of its corners' colours, or its own, in any number type.
#[test]
fn colors_of_scans_are_texels() {
    let ply = |of_vertex: &str, of_face: &str, rows: &str| {
        let channels = |kind: &str| match kind {
            "" => String::new(),
            kind => ["red", "green", "blue"].map(|name| format!("property {kind} {name}\n")).concat(),
        };
        let text = format!(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty int x\nproperty int y\nproperty int z\n{}element face 2\n{}\
             property list uchar int vertex_indices\nend_header\n{rows}",
            channels(of_vertex),
            channels(of_face)
        );
        loaded(text, "a.ply")
    };
    let color = |model: &Loaded, triangle: usize| -> Rgb {
        let mesh = &model.mesh;
        let name = mesh.surfaces()[usize::from(mesh.triangle_surfaces()[triangle])].texture.as_ref().unwrap();
        let (texture, texcoords) = (&model.textures[name], mesh.texcoords().unwrap());
        let texels = mesh.triangles()[triangle].map(|vertex| {
            let place = texcoords[vertex as usize] * Vec2::new(texture.width() as f32, texture.height() as f32);
            // In the middle of a texel.
            assert_eq!(place.fract(), Vec2::splat(0.5));
            (place.x as u32, place.y as u32)
        });
        assert!(texels.iter().all(|texel| *texel == texels[0]));
        texture[texels[0]]
    };
    let of_vertices = ply("uchar", "", "0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n1 1 0 0 0 0\n3 0 1 2\n3 2 1 3\n");
    assert_eq!([0, 1].map(|i| color(&of_vertices, i)), [Rgb::new(85, 85, 85), Rgb::new(0, 85, 85)]);
    assert_eq!(of_vertices.warnings, [""; 0]);
    let places = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
    let of_faces = ply("", "float", &format!("{places}1 0.5 0 3 0 1 2\nnan -1 7 3 2 1 3\n"));
    assert_eq!([0, 1].map(|i| color(&of_faces, i)), [Rgb::new(255, 128, 0), Rgb::new(0, 0, 255)]);
    let wide = ply("", "ushort", &format!("{places}65535 0 32768 3 0 1 2\n0 0 0 3 2 1 3\n"));
    assert_eq!(color(&wide, 0), Rgb::new(255, 0, 128));
}

/// Strips flip every second triangle; a negative index ends one.
#[test]
fn strips_are_triangles() {
    let text = "ply\nformat ascii 1.0\nelement vertex 5\nproperty int x\nproperty int y\nproperty int z\n\
                element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
                0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 4 -1 4 2 3\n";
    let mesh = loaded(text, "a.ply").mesh;
    let places =
        |t: &[u32; 3]| t.map(|v| mesh.positions()[v as usize].to_array().map(|c| c as i32)).map(|[x, y, _]| (x, y));
    let triangles: Vec<_> = mesh.triangles().iter().map(places).collect();
    let expected =
        [[(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 0), (1, 1)], [(0, 1), (1, 1), (0, 2)], [(0, 2), (0, 1), (1, 1)]];
    assert_eq!(triangles, expected);
}

#[test]
fn textures_go_before_colors() {
    let text = "ply\nformat ascii 1.0\ncomment TextureFile a b.png\nelement vertex 3\nproperty float x\nproperty float y\n\
                property float z\nproperty float s\nproperty float t\nproperty uchar red\nproperty uchar green\n\
                property uchar blue\nelement face 1\nproperty list uchar int vertex_indices\n\
                property list uchar float texcoord\nend_header\n\
                0 0 0 0 0 9 9 9\n1 0 0 1 0 9 9 9\n0 1 0 0 0.5 9 9 9\n3 0 1 2 ";
    let model = loaded(format!("{text}0\n"), "folder/a.ply");
    assert_eq!(model.mesh.surfaces()[0].texture.as_deref().map(Path::new), Some(Path::new("folder/a b.png")));
    assert_eq!(model.mesh.texcoords().unwrap(), [Vec2::ZERO, Vec2::X, Vec2::new(0.0, 0.5)]);
    assert!(model.textures.is_empty());
    // A corner's own values take precedence over its vertex's.
    let model = loaded(format!("{text}6 1 0 1 1 0 1\n"), "a.ply");
    assert_eq!(model.mesh.texcoords().unwrap(), [Vec2::X, Vec2::ONE, Vec2::Y]);
}

/// Three triangles with the numbers of their textures, as MeshLab writes them, unless these are empty.
fn with_textures(comments: &str, numbers: [&str; 3]) -> Loaded {
    let property = if numbers[0].is_empty() { "" } else { "property int texnumber\n" };
    let faces: String = numbers.iter().map(|number| format!("3 0 1 2 6 0 0 1 0 0 1 {number}\n")).collect();
    let text = format!(
        "ply\nformat ascii 1.0\n{comments}element vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
         element face 3\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n{property}\
         end_header\n0 0 0\n1 0 0\n0 1 0\n{faces}"
    );
    loaded(text, "a.ply")
}

#[test]
fn faces_have_the_texture_of_their_number() {
    let two = "comment TextureFile a.png\ncomment TextureFile b c.png\n";
    let textures = |model: &Loaded| -> Vec<Option<String>> {
        let surfaces = model.mesh.surfaces();
        let of = |&surface: &u16| surfaces.get(usize::from(surface)).and_then(|surface| surface.texture.clone());
        model.mesh.triangle_surfaces().iter().map(of).collect()
    };
    let name = |name: &str| Some(name.to_owned());
    let model = with_textures(two, ["1", "0", "1"]);
    assert_eq!(textures(&model), [name("b c.png"), name("a.png"), name("b c.png")]);
    assert_eq!(model.warnings, [""; 0]);
    let names: Vec<&str> = model.mesh.surfaces().iter().map(|surface| &*surface.name).collect();
    assert_eq!(names, ["b c.png", "a.png"]);
    // A number without a texture, as for faces that have none.
    for number in ["-1", "2", "0.5", "nan", "1e99"] {
        assert_eq!(
            textures(&with_textures(two, ["0", number, "1"])),
            [name("a.png"), None, name("b c.png")],
            "{number}"
        );
    }
    // With one texture there is nothing to choose.
    let model = with_textures("comment TextureFile a.png\n", ["3", "0", "-1"]);
    assert!(model.mesh.surfaces().len() == 1 && model.warnings.is_empty());
    let model = with_textures(two, [""; 3]);
    assert_eq!(textures(&model), [name("a.png"), name("a.png"), name("a.png")]);
    assert_eq!(model.warnings, ["a.ply:3: faces have no texnumber; drawn with the first of 2 textures"]);
}

#[test]
pub(crate) fn contents_say_the_format() {
    let cube = Faces::of_shape(&shapes::cube());
    for (bytes, format) in [
        (cube.stl_binary(b"ply\n"), Some(Format::Ply)),
        (cube.stl_binary(b"# solid"), Some(Format::Stl)),
        (cube.stl_text().into_bytes(), Some(Format::Stl)),
        (cube.ply("ascii"), Some(Format::Ply)),
        (cube.obj().into_bytes(), Some(Format::Obj)),
        (b"\n# solid\n\n  mtllib a\n".to_vec(), Some(Format::Obj)),
        (b"solid ground\n".to_vec(), None),
        (b"[[objects]]\n".to_vec(), None),
        (b"".to_vec(), None),
    ] {
        assert_eq!(Format::of_bytes(&bytes), format, "{:?}", String::from_utf8_lossy(&bytes));
    }
    for (name, format) in [
        ("a.obj", Some(Format::Obj)),
        ("a.b.STL", Some(Format::Stl)),
        ("a.ply.gz", Some(Format::Ply)),
        ("a.gz", None),
        ("ply", None),
        (".ply", None),
    ] {
        assert_eq!(Format::of_path(Path::new(name)), format, "{name}");
    }
    assert_eq!(Format::extensions(), ".obj, .stl, .ply, .gltf and .glb");
}
