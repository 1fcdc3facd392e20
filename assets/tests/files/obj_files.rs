//! OBJ and MTL: what is read, what is refused and where, and agreement with `tobj` where that can read the file.

use std::collections::HashMap;
use std::fmt::Write;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use mode13h::Angle;
use mode13h::glam::{Vec2, Vec3};
use mode13h::light::{Blend, Material};
use mode13h::mesh::{Mesh, shapes};
use mode13h::scene::Object;
use mode13h::texture::Texture;
use mode13h_assets::model_file::obj;
use mode13h_assets::model_file::{self, Loaded, ModelFileError, ModelFileErrorKind, Options};
use proptest::prelude::*;

use crate::model_files::loaded;
use crate::support::property::property;
use crate::support::tried::Tried;
use crate::support::workspace;

pub(crate) fn no_library(_: &Path) -> io::Result<Vec<u8>> {
    Err(io::ErrorKind::NotFound.into())
}

pub(crate) fn parse(text: impl AsRef<[u8]>) -> Result<Loaded, ModelFileError> {
    obj::parse(text.as_ref(), "model.obj", no_library)
}

pub(crate) fn with_mtl(text: &str, mtl: &str) -> Result<Loaded, ModelFileError> {
    obj::parse(text.as_bytes(), "model.obj", |_: &Path| Ok(mtl.into()))
}

pub(crate) fn mesh(text: impl AsRef<[u8]>) -> Mesh {
    parse(text).unwrap_or_else(|error| panic!("{error}")).mesh
}

pub(crate) fn refused(text: impl AsRef<[u8]>) -> String {
    match parse(text) {
        Ok(_) => "read".to_owned(),
        Err(error) => error.to_string(),
    }
}

pub(crate) fn data(name: &str) -> PathBuf {
    workspace::root().join("tests/data").join(name)
}

pub(crate) const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

#[test]
fn a_file_with_materials() {
    let Loaded { mesh, warnings, .. } = model_file::load(data("chest.obj")).unwrap();
    let place = data("chest.mtl");
    assert_eq!(warnings, [format!("{}:6: options of map_Kd (-s, -o, -clamp) left out", place.display())]);
    assert_eq!(mesh.triangles().len(), 12);
    assert!(mesh.is_closed() && mesh.is_convex());
    assert_eq!(mesh.volume(), 4.0);
    let [wood, brass] = mesh.surfaces() else { panic!("{:?}", mesh.surfaces()) };
    assert_eq!((wood.name.as_str(), wood.diffuse, wood.specular), ("wood", [0.6, 0.4, 0.2], [0.0; 3]));
    assert_eq!(wood.texture.as_deref().map(Path::new), Some(data("chest planks.ppm").as_path()));
    assert_eq!((brass.diffuse, brass.specular, brass.shininess), ([0.75; 3], [1.0, 0.9, 0.5], 96.0));
    assert_eq!(brass.texture, None);
    assert_eq!(mesh.triangle_surfaces(), [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1]);
    let texcoords = mesh.texcoords().unwrap();
    for (triangle, surface) in mesh.triangles().iter().zip(mesh.triangle_surfaces()) {
        for &i in triangle {
            let (p, n) = (mesh.positions()[i as usize], mesh.normals()[i as usize]);
            // The lid has explicit normals; the sides meet at more than the crease angle.
            if *surface == 1 {
                assert_eq!((n, texcoords[i as usize]), (Vec3::Y, Vec2::ZERO));
            } else {
                let [a, b, c] = triangle.map(|i| mesh.positions()[i as usize]);
                assert_eq!(n, (b - a).cross(c - a).normalize(), "{p}");
            }
        }
    }
}

#[test]
fn faces_of_two_corners_are_left_out_with_one_note() {
    let read = |lines: &str| parse(format!("{TRIANGLE}{lines}f 1 2 3\n")).unwrap();
    let loaded = read("f 1 2\n");
    assert_eq!(loaded.mesh.triangles(), [[0, 1, 2]]);
    assert_eq!(loaded.warnings, ["model.obj:4: left out a face of fewer than 3 corners"]);
    let loaded = read("f 1 2\nf 1\nf 2/1 3/1\nf\nvt 0 0\n");
    assert_eq!(loaded.mesh.triangles(), [[0, 1, 2]]);
    assert_eq!(loaded.warnings, ["model.obj:4: left out 4 faces of fewer than 3 corners, the first here"]);
    assert_eq!(refused(format!("{TRIANGLE}f 1 2\n")), "model.obj: no faces");
}

/// A sphere at map coordinates, and the same one around 0, where its coordinates are exact.
#[test]
fn a_model_far_from_0_keeps_its_shape() {
    let sphere = shapes::sphere(12, 6);
    let text = |middle: [f64; 3]| {
        let at = |p: &Vec3| [0, 1, 2].map(|axis| f64::from((p[axis] * 1024.0).round() / 1024.0) + middle[axis]);
        let line = |p: &Vec3| at(p).map(|c| format!(" {c}")).concat();
        let vertices: String = sphere.positions().iter().map(|p| format!("v{}\n", line(p))).collect();
        let faces = sphere.triangles().iter().map(|t| format!("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1));
        // No face uses the last one.
        vertices + "v 0 0 0\n" + &faces.collect::<String>()
    };
    let near = parse(text([0.0; 3])).unwrap();
    assert_eq!(near.warnings, [""; 0]);
    let far = parse(text([4_500_000.25, -610_000.5, 240.0])).unwrap();
    assert_eq!(
        far.warnings,
        ["model.obj: lies far from the origin; its centre, 4500000.25 -610000.5 240, was moved there"]
    );
    assert_eq!(far.mesh, near.mesh);
}

/// Rounded to f32, a ring of this many corners has dents; it is cut from side to side, in any plane.
#[test]
fn large_faces_that_are_monotone_are_split() {
    let corners = 30_000;
    let ring = |plane: fn(f64, f64) -> [f64; 3]| -> Vec<Vec3> {
        let corner = |i: i32| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / f64::from(corners)).sin_cos();
            Vec3::from_array(plane(cos, sin).map(|c| c as f32))
        };
        (0..corners).map(corner).collect()
    };
    let planes: [fn(f64, f64) -> [f64; 3]; 3] =
        [|x, y| [x, y, 0.0], |x, y| [0.3 * y, x, y], |x, y| [x * 0.6 + 7.0, -y, x * 0.8]];
    for (i, plane) in planes.into_iter().enumerate() {
        let mut face = ring(plane);
        for start in [0, 1, 9_999] {
            face.rotate_left(start);
            let mesh = mesh(face_text(&face));
            assert_eq!(mesh.triangles().len(), 29_998);
            // In the others rounding moves corners off the plane.
            if i == 0 {
                check_split(&mesh, &face);
            }
            // Together as large as the face; overlapping triangles would be larger.
            let whole: f32 =
                (1..face.len() - 1).map(|i| (face[i] - face[0]).cross(face[i + 1] - face[0]).length()).sum();
            let place = |i: u32| mesh.positions()[i as usize];
            let parts = mesh.triangles().iter().map(|t| t.map(place));
            let sum: f32 = parts.map(|[a, b, c]| (b - a).cross(c - a).length()).sum();
            assert!((sum / whole - 1.0).abs() < 1e-3, "{sum} {whole}");
        }
    }
    // Concave, and monotone along x or along y.
    let wave = |i: i32| f64::from(i % 7) + 0.001 * f64::from(i % 11);
    let forth = (0..corners / 2).map(|i| [f64::from(i), wave(i)]);
    let back = (0..corners / 2).rev().map(|i| [f64::from(i), 20.0 + wave(i)]);
    let outline: Vec<[f64; 2]> = forth.chain(back).collect();
    for flip in [false, true] {
        let corner = |&[x, y]: &[f64; 2]| if flip { [-y, x] } else { [x, y] }.map(|c| c as f32);
        let face: Vec<Vec3> = outline.iter().map(corner).map(|[x, y]| Vec3::new(x, y, 0.0)).collect();
        check_split(&mesh(face_text(&face)), &face);
    }
    // A spiral is not monotone along either.
    let spiral = |i: i32, radius: f64| {
        let angle = f64::from(i) / 2_000.0;
        let (sin, cos) = angle.sin_cos();
        Vec3::new(((radius + angle) * cos) as f32, ((radius + angle) * sin) as f32, 0.0)
    };
    let out = (0..corners).map(|i| spiral(i, 10.0));
    let face: Vec<Vec3> = out.chain((0..corners).rev().map(|i| spiral(i, 11.0))).collect();
    assert_eq!(
        refused(face_text(&face)),
        format!("model.obj:{}: a concave face of more than 20,000 corners", 2 * corners + 1)
    );
}

#[test]
fn lines_of_all_kinds() {
    let plain = mesh(format!("{TRIANGLE}f 1 2 3\n"));
    for text in [
        format!("{TRIANGLE}f 1 2 3"),
        format!("\u{FEFF}{TRIANGLE}f 1 2 3\n"),
        format!("{TRIANGLE}f 1 2 3\n").replace('\n', "\r\n"),
        format!("{TRIANGLE}\t f\t1  2 \\\n 3 # and no more\n"),
        format!("{TRIANGLE}f 1 2 \\ \t\n3\n"),
        format!("{TRIANGLE}f 1 2 3 \\"),
        format!("# C:\\models\\\n{TRIANGLE}f 1 2 3\n"),
        format!("{TRIANGLE}l 1 2 3\np 1\ns off\no x\ng\nvp 1 1\nf 1 2 3\n"),
        "v 0 0 0 1\nv 1 0 0 0.5\nv 0 1 0 2\nf +1 +2 +3".to_owned(),
        format!("{TRIANGLE}v 9 9 9\nf 1 2 3\n"),
    ] {
        assert_eq!(mesh(&text), plain, "{text}");
    }
    let mut latin1 = b"# Z\xFCrich\n".to_vec();
    latin1.extend_from_slice(format!("{TRIANGLE}o caf\u{e9}\nf 1 2 3\n").as_bytes());
    assert_eq!(mesh(latin1), plain);
}

#[test]
fn normals_that_are_missing_are_filled_in() {
    // Two faces of one group that share an edge; the first has normals, one of them zero.
    let text =
        "s 1\n".to_owned() + "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 -1\nvn 0 0 5\nvn 0 0 0\nf 1//1 2//1 3//2\nf 1 3 4\n";
    let mesh = mesh(&text);
    let [first, second] = mesh.triangles() else { panic!() };
    let normal = |i: u32| mesh.normals()[i as usize];
    assert_eq!((normal(first[0]), normal(first[1])), (Vec3::Z, Vec3::Z));
    // By angle at (0, 1, 0): 45° of +z and 45° of −x.
    let mean = Vec3::new(-1.0, 0.0, 1.0) / 2f32.sqrt();
    assert!(normal(first[2]).abs_diff_eq(mean, 1e-6));
    assert!(normal(second[0]).abs_diff_eq(mean, 1e-6) && normal(second[1]).abs_diff_eq(mean, 1e-6));
    assert_eq!(normal(second[2]), Vec3::NEG_X);
}

/// Without normals, positions that are listed twice are one.
#[test]
fn normals_are_averaged_by_place() {
    let twice = mesh("s 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv 0 1 -0\nv 0 0 -1\nf 1 2 3\nf 4 5 6\n");
    let mean = Vec3::new(-1.0, 0.0, 1.0) / 2f32.sqrt();
    assert_eq!(twice.positions().len(), 6);
    assert!([0, 2].iter().all(|&i: &usize| twice.normals()[i].abs_diff_eq(mean, 1e-6)));
    assert!((3..5).all(|i| twice.normals()[i].abs_diff_eq(mean, 1e-6)));
}

fn parse_with_crease(text: &str, crease: Option<f32>) -> Result<Loaded, ModelFileError> {
    let options = Options { crease: crease.map(|degrees| Angle::from_degrees(degrees.into())) };
    obj::parse_with(text.as_bytes(), "model.obj", no_library, &options)
}

fn with_crease(text: &str, crease: Option<f32>) -> Mesh {
    parse_with_crease(text, crease).expect("a model").mesh
}

/// Strips of squares along z, each at this many degrees to the last, after the given statements.
fn bent(strips: &[(f32, &str)]) -> String {
    let (mut text, mut faces, mut angle, mut at) = (String::new(), String::new(), 0.0_f32, (0.0, 0.0));
    for (i, (bend, statement)) in strips.iter().enumerate() {
        angle += bend.to_radians();
        let to = (at.0 + angle.cos(), at.1 + angle.sin());
        for ((x, y), z) in [(at, 0.0), (to, 0.0), (to, -1.0), (at, -1.0)] {
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
        let first = 4 * i + 1;
        writeln!(faces, "{statement}f {first} {} {} {}", first + 1, first + 2, first + 3).unwrap();
        at = to;
    }
    text + &faces
}

/// Returns for each strip but the first whether there is an edge before it, that is, whether the normals on its two
/// sides differ.
fn edges(text: &str, crease: Option<f32>, strips: usize) -> Vec<bool> {
    let mesh = with_crease(text, crease);
    let normals = |strip: usize| {
        let of = |t: &[u32; 3]| t.map(|i| (mesh.positions()[i as usize], mesh.normals()[i as usize]));
        mesh.triangles()[2 * strip..2 * strip + 2].iter().flat_map(of).collect::<Vec<_>>()
    };
    let edge = |strip: usize| {
        let (left, right) = (normals(strip - 1), normals(strip));
        left.iter().any(|(p, n)| right.iter().any(|(q, m)| p.abs_diff_eq(*q, 1e-6) && !n.abs_diff_eq(*m, 1e-6)))
    };
    (1..strips).map(edge).collect()
}

/// Strips bent at several angles, with separate corners for each strip, are welded by position.
#[test]
fn edges_are_shown_beyond_the_crease_angle() {
    // The positions of two strips must be equal, not just near: computed from integers.
    let text = "v 0 0 0\nv 0 0 -4\nv 4 0 0\nv 4 0 -4\nv 7 3 0\nv 7 3 -4\nv 7 7 0\nv 7 7 -4\nv 6 12 0\nv 6 12 -4\n\
                f 1 3 4 2\nf 3 5 6 4\nf 5 7 8 6\nf 7 9 10 8\n";
    // Bent by 45°, 45° and 11.3°.
    for (crease, due) in [
        (None, [true, true, false]),
        (Some(46.0), [false; 3]),
        (Some(44.0), [true, true, false]),
        (Some(11.0), [true; 3]),
        (Some(0.0), [true; 3]),
        (Some(180.0), [false; 3]),
        (Some(999.0), [false; 3]),
        (Some(f32::NAN), [true; 3]),
    ] {
        assert_eq!(edges(text, crease, 4), due, "{crease:?}");
    }
    // 40° by default, tested a degree to either side.
    assert_eq!(edges(&bent(&[(0.0, ""), (39.0, "")]), None, 2), [false]);
    assert_eq!(edges(&bent(&[(0.0, ""), (41.0, "")]), None, 2), [true]);
}

/// `s` says which faces are smooth together, at any angle; an explicit angle overrides it, and explicit normals
/// override both.
#[test]
fn smoothing_groups_are_honoured() {
    let groups = |statements: [&str; 5]| {
        let bends = [0.0, 60.0, 5.0, 60.0, 5.0];
        let strips: Vec<(f32, &str)> = bends.into_iter().zip(statements).collect();
        bent(&strips)
    };
    for (statements, due) in [
        (["s 1\n", "", "s 2\n", "", ""], [false, true, false, false]),
        (["s 7\n", "", "", "", ""], [false; 4]),
        (["s 1\n", "", "s 4294967295\n", "", ""], [false, true, false, false]),
        (["s off\n", "", "", "", ""], [true; 4]),
        (["s 0\n", "", "s 3\n", "", "s off\n"], [true, true, false, true]),
        // Before the first the angle decides; what is in no group is left alone.
        (["", "", "", "s 1\n", "s what\n"], [true, false, true, false]),
        (["s 1\n", "s 1\n", "s 2\n", "s 1\n", "s on\n"], [false, true, true, false]),
    ] {
        let text = groups(statements);
        assert_eq!(edges(&text, None, 5), due, "{statements:?}");
        assert_eq!(edges(&text, Some(40.0), 5), [true, false, true, false], "{statements:?}");
    }
    // Also between groups that meet only at a point.
    let given =
        "vn 0 1 0\n".to_owned() + &groups(["s off\n", "", "", "", ""]).replace("f 1 2 3 4", "f 1//1 2//1 3//1 4//1");
    let mesh = with_crease(&given, Some(180.0));
    assert!(mesh.triangles()[..2].iter().flatten().all(|&i| mesh.normals()[i as usize] == Vec3::Y));
}

/// By definition: two faces at a position count together if a chain of faces within the angle of each other links them.
#[test]
fn creases_are_what_the_naive_oracle_says() {
    let tried = Tried::new("creases_are_what_the_naive_oracle_says", 100);
    let corner = prop::array::uniform3(-2i8..=2);
    let faces = prop::collection::vec(prop::array::uniform3(0usize..8), 1..24);
    property(tried, (prop::collection::vec(corner, 8), faces, 0.0f32..180.0), |(corners, faces, crease)| {
        let mut text = String::new();
        corners.iter().for_each(|[x, y, z]| writeln!(text, "v {x} {y} {z}").unwrap());
        faces.iter().for_each(|[a, b, c]| writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).unwrap());
        let Ok(Loaded { mesh, warnings, .. }) = parse_with_crease(&text, Some(crease)) else { return Ok(()) };
        if !warnings.is_empty() {
            // Faces were repaired, so there are others.
            return Ok(());
        }
        let place = |i: u32| mesh.positions()[i as usize];
        let normal = |t: &[u32; 3]| {
            let [a, b, c] = t.map(place);
            (b - a).cross(c - a).normalize_or_zero()
        };
        let normals: Vec<_> = mesh.triangles().iter().map(normal).collect();
        for (t, triangle) in mesh.triangles().iter().enumerate().filter(|(t, _)| normals[*t].length() > 0.5) {
            for &corner in triangle {
                let here: Vec<usize> = (0..normals.len())
                    .filter(|&o| {
                        normals[o].length() > 0.5 && mesh.triangles()[o].iter().any(|&i| place(i) == place(corner))
                    })
                    .collect();
                let mut linked = vec![t];
                let mut next = 0;
                while next < linked.len() {
                    let near = |o: usize| normals[linked[next]].dot(normals[o]) >= crease.to_radians().cos() - 1e-6;
                    let more: Vec<usize> = here.iter().copied().filter(|&o| !linked.contains(&o) && near(o)).collect();
                    linked.extend(more);
                    next += 1;
                }
                let angle = |o: usize| {
                    let at = mesh.triangles()[o].iter().position(|&i| place(i) == place(corner)).unwrap();
                    let p = [0, 1, 2].map(|k| place(mesh.triangles()[o][(at + k) % 3]));
                    (p[1] - p[0]).cross(p[2] - p[0]).length().atan2((p[1] - p[0]).dot(p[2] - p[0]))
                };
                let sum = linked.iter().fold(Vec3::ZERO, |sum, &o| sum + normals[o] * angle(o));
                if sum.length() > 1e-2 {
                    let found = mesh.normals()[corner as usize];
                    prop_assert!((sum.normalize() - found).length() < 1e-3, "{found} {sum} {linked:?}");
                }
            }
        }
        Ok(())
    });
}

/// A grid of this many squares a side with random heights, up to this share of a square's side.
fn rough(side: u64, height: f64, corners: &str) -> String {
    let (mut text, mut random) = (String::new(), 1_u64);
    let next = |random: &mut u64| {
        // Knuth's MMIX generator, of which the upper bits are used.
        *random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*random >> 40) as f64 / 16_777_216.0
    };
    for i in 0..(side + 1) * (side + 1) {
        writeln!(text, "v {} {} {}", i % (side + 1), i / (side + 1), height * next(&mut random)).unwrap();
    }
    text += corners;
    for i in (0..(side + 1) * side).filter(|i| i % (side + 1) < side) {
        let [a, b, c, d] = [i + 1, i + 2, i + side + 3, i + side + 2];
        writeln!(text, "f {a} {b} {c}\nf {a} {c} {d}").unwrap();
    }
    text
}

/// Noise bends faces by more than the crease angle here and there, which makes no edge; an explicit angle does count.
#[test]
fn scans_are_smooth() {
    let split = |text: &str, crease| with_crease(text, crease).positions().len();
    let text = rough(40, 0.8, "");
    assert_eq!(split(&text, None), 41 * 41);
    assert!(split(&text, Some(40.0)) > 41 * 41 + 100, "{}", split(&text, Some(40.0)));
    // Nor do groups keep other faces from being smooth, or get smoothed by them.
    let half = rough(40, 0.8, "").replace("f 821 822 863\n", "s off\nf 821 822 863\n");
    assert!(half.contains("s off") && split(&half, None) > 41 * 41 + 1_000);
    // A box of 20 squares a side, made of six grids, keeps its edges.
    let grid = rough(20, 0.0, "");
    let mut cube = String::new();
    let planes: [fn([i32; 2]) -> [i32; 3]; 6] = [
        |[x, y]| [x, y, 20],
        |[x, y]| [y, x, 0],
        |[x, y]| [20, x, y],
        |[x, y]| [0, y, x],
        |[x, y]| [y, 20, x],
        |[x, y]| [x, 0, y],
    ];
    for (side, plane) in planes.into_iter().enumerate() {
        for line in grid.lines() {
            let numbers: Vec<i32> = line.split(' ').skip(1).map(|word| word.parse().unwrap()).collect();
            match line.as_bytes()[0] {
                b'v' => {
                    let [x, y, z] = plane([numbers[0], numbers[1]]);
                    writeln!(cube, "v {x} {y} {z}").unwrap();
                }
                _ => {
                    let [a, b, c] = [0, 1, 2].map(|i| numbers[i] + 441 * side as i32);
                    writeln!(cube, "f {a} {b} {c}").unwrap();
                }
            }
        }
    }
    let cube = mesh(&cube);
    assert!(cube.is_closed() && cube.volume() == 8_000.0);
    assert!(cube.normals().iter().all(|n| n.abs().max_element() == 1.0));
}

#[test]
fn a_model_of_which_nothing_can_be_drawn_says_so() {
    for faces in ["f 1 1 1\n", "f 1 2 1\nf 3 3 2\n", "v 2 0 0\nf 1 2 4\n"] {
        let message = "model.obj: no face has an area, so nothing can be drawn";
        assert_eq!(refused(format!("{TRIANGLE}{faces}")), message, "{faces}");
    }
}

/// Pairs back to back are removed if an object continues around them; leaves with a rim of their own, or of two
/// materials, stay.
#[test]
fn only_mistaken_twins_are_left_out() {
    const BODY: &str = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    for (more, triangles, pairs) in [
        ("", 4, 0),
        ("f 2 3 4\nf 2 4 3\n", 4, 1),
        ("f 2 3 4\nf 2 4 3\nf 1 2 3\nf 2 1 3\n", 4, 2),
        // A fin on an edge, of two triangles; a separate leaf; an object beside it whose faces all exist in both
        // directions.
        ("v 5 5 0\nv 6 5 0\nf 2 3 5\nf 3 2 5\nf 2 5 6\nf 5 2 6\n", 8, 0),
        ("v 5 5 0\nv 6 5 0\nv 7 7 0\nf 5 6 7\nf 7 6 5\n", 6, 0),
        (
            "v 9 0 0\nv 9 1 0\nv 9 0 1\nv 8 0 0\nf 5 6 7\nf 5 7 6\nf 5 6 8\nf 5 8 6\nf 6 7 8\nf 6 8 7\nf 5 7 8\nf 5 8 7\n",
            12,
            0,
        ),
        // A roof over one face: no rim, and the object continues around it.
        ("v 3 3 3\nf 2 3 5\nf 3 2 5\nf 3 4 5\nf 4 3 5\nf 4 2 5\nf 2 4 5\n", 4, 3),
        ("usemtl a\nf 2 3 4\nusemtl b\nf 2 4 3\n", 6, 0),
    ] {
        let Loaded { mesh, warnings, .. } = parse(BODY.to_owned() + more).unwrap();
        assert_eq!(mesh.triangles().len(), triangles, "{more}");
        assert!(mesh.is_closed() && mesh.is_outward(), "{more}");
        let due = match pairs {
            0 => None,
            1 => Some("model.obj: left out two faces back to back".to_owned()),
            pairs => Some(format!("model.obj: left out {pairs} pairs of faces back to back")),
        };
        let warnings: Vec<_> = warnings.into_iter().filter(|warning| !warning.contains("material")).collect();
        assert_eq!(warnings, Vec::from_iter(due), "{more}");
    }
    // An open one keeps all of them, and records them.
    let Loaded { mesh, warnings, .. } = parse(BODY.to_owned() + "f 2 3 4\nf 2 4 3\nv 9 9 9\nf 1 2 5\n").unwrap();
    assert!(warnings.is_empty() && !mesh.is_closed());
    let twins: Vec<usize> = (0..mesh.triangles().len()).filter(|&t| mesh.has_twin(t)).collect();
    assert_eq!(twins, [3, 4, 5]);
}

/// Flipped, along with any normals, if the normals point inward.
#[test]
fn bodies_inside_out_are_turned_round() {
    const CORNERS: &str =
        "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nv 1 1 1\nv 2 1 1\nv 1 2 1\nv 1 1 2\nvn -1 -1 -1\nvn 1 1 1\n";
    let body = |corners: [usize; 4], normal: usize, turned: bool| {
        let mut text = String::new();
        for face in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
            let [a, b, c] = if turned { [face[0], face[2], face[1]] } else { face }.map(|i| corners[i]);
            match normal {
                0 => writeln!(text, "f {a} {b} {c}").unwrap(),
                n => writeln!(text, "f {a}//{n} {b}//{n} {c}//{n}").unwrap(),
            }
        }
        text
    };
    let one = "model.obj: flipped a solid that was inside out";
    for (text, due) in [
        (body([1, 2, 3, 4], 0, false), None),
        (body([1, 2, 3, 4], 0, true), Some(one)),
        // A cavity; an object inside another; both wrong: the outer one is flipped, and then the inner one is no
        // cavity.
        (body([1, 2, 3, 4], 0, false) + &body([5, 6, 7, 8], 0, true), None),
        (body([5, 6, 7, 8], 0, false) + &body([1, 2, 3, 4], 0, false), None),
        (body([5, 6, 7, 8], 0, true) + &body([1, 2, 3, 4], 0, true), Some(one)),
    ] {
        let Loaded { mesh, warnings, .. } = parse(CORNERS.to_owned() + &text).unwrap();
        assert_eq!(warnings, Vec::from_iter(due.map(str::to_owned)), "{text}");
        assert!(mesh.is_outward() && mesh.volume() > 0.0, "{text}");
    }
    // Decided by whichever of the two faces agrees most with both given normals.
    for (normal, turned) in [(1, true), (2, true)] {
        let loaded = parse(CORNERS.to_owned() + &body([1, 2, 3, 4], normal, turned)).unwrap();
        let slanted = loaded.mesh.triangles().iter().map(|t| {
            let [a, b, c] = t.map(|i| loaded.mesh.positions()[i as usize]);
            let face = (b - a).cross(c - a).normalize();
            t.iter().map(|&i| loaded.mesh.normals()[i as usize].dot(face)).sum::<f32>()
        });
        assert!(slanted.sum::<f32>() >= 0.0, "normals look outward as the faces do");
    }
}

#[test]
fn faces_without_area_are_kept() {
    let mesh = mesh(format!("{TRIANGLE}f 1 1 1\nf 1 2 2\nf 1 2 3\nf 1 2 1 2\n"));
    assert_eq!(mesh.triangles().len(), 5);
    assert!(mesh.normals().iter().all(|&n| n == Vec3::Z));
}

#[test]
fn missing_files_are_one_warning() {
    let Loaded { mesh, warnings, .. } = model_file::load(data("missing_library.obj")).unwrap();
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].contains("missing_library.obj:1: cannot read nowhere.mtl"), "{warnings:?}");
    assert_eq!((mesh.surfaces()[0].name.as_str(), mesh.surfaces()[0].diffuse), ("gold", [1.0; 3]));

    let Loaded { mesh, warnings, .. } = model_file::load(data("missing_texture.obj")).unwrap();
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].contains("nowhere.png: no such texture"), "{warnings:?}");
    assert_eq!(mesh.surfaces()[0].texture, None);

    let Loaded { warnings, .. } = parse(format!("{TRIANGLE}usemtl x\nf 1 2 3\nusemtl x\nf 1 2 3\n")).unwrap();
    assert_eq!(warnings, ["model.obj:4: there is no material x; it is white and matt"]);

    // Long names are shortened.
    let long = "A".repeat(100_000);
    let shown = &long[..255];
    let Loaded { warnings, .. } = parse(format!("{TRIANGLE}usemtl {long}\nf 1 2 3\n")).unwrap();
    assert_eq!(warnings, [format!("model.obj:4: there is no material {shown}…; it is white and matt")]);
    let Loaded { warnings, .. } = parse(format!("mtllib {long}\n{TRIANGLE}f 1 2 3\n")).unwrap();
    assert!(warnings[0].starts_with(&format!("model.obj:1: cannot read {shown}… (")), "{warnings:?}");
}

/// `Ns` 0, or none, means no highlight; a note says so once if there is a `Ks`.
#[test]
fn without_an_exponent_there_is_no_highlight() {
    let text = format!("mtllib a.mtl\n{TRIANGLE}usemtl a\nf 1 2 3\nusemtl b\nf 1 3 2\n");
    let load = |mtl: &str| with_mtl(&text, mtl).unwrap();
    let shiny =
        |loaded: Loaded| Object::new(loaded.mesh).materials.iter().map(Material::is_specular).collect::<Vec<_>>();
    let none = load("newmtl a\nKs 0.5 0.5 0.5\nnewmtl b\nKs 1 1 1\nNs 0\n");
    let note = "model.obj: material a and one other: Ks without an Ns above 0 gives no highlight";
    assert_eq!((none.warnings.as_slice(), shiny(none.clone())), ([note.to_owned()].as_slice(), vec![false, false]));
    let one = load("newmtl a\nKs 0.5 0.5 0.5\nNs 20\nnewmtl b\nKs 0 0 0\n");
    assert_eq!((one.warnings.len(), shiny(one)), (0, vec![true, false]));
}

/// Glass by `d` or `Tr`; each statement that is not read gives one warning.
#[test]
fn what_an_mtl_file_says_of_glass_and_what_is_left_out() {
    let load = |obj: &str, mtl: &str| with_mtl(&format!("mtllib a.mtl\n{obj}usemtl a\nf 1 2 3\n"), mtl).unwrap();
    for (mtl, blend) in [
        ("d 0.5", Blend::Mix(128)),
        ("d 1", Blend::Opaque),
        ("d -halo 0.25", Blend::Mix(64)),
        ("Tr 0.75", Blend::Mix(64)),
        ("d 1\nTr 1", Blend::Opaque),
        ("Tr 1\nd 1", Blend::Opaque),
        ("d 0.001", Blend::Mix(1)),
        ("d 7", Blend::Opaque),
    ] {
        let loaded = load(TRIANGLE, &format!("newmtl a\n{mtl}\n"));
        assert_eq!(Object::new(loaded.mesh).materials[0].blend, blend, "{mtl}");
    }
    let unseen = load(TRIANGLE, "newmtl a\nd 0\n");
    assert_eq!(unseen.mesh.surfaces()[0].opacity, 1.0);
    assert_eq!(unseen.warnings, ["a.mtl:2: a fully transparent material is drawn opaque; its d or Tr is left out"]);
    let colored = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0\n";
    let mtl = "newmtl a\nmap_d a.png\nmap_Kd -s 2 2 -clamp on a.png\nnewmtl b\nmap_d a.png\n";
    assert_eq!(
        load(colored, mtl).warnings,
        [
            "a.mtl:2: map_d left out, 2 times",
            "a.mtl:3: options of map_Kd (-s, -o, -clamp) left out",
            "model.obj:2: vertex colours left out"
        ]
    );
}

/// The same colours in PLY, which has them as bytes, and in OBJ, where some programs write 0 to 1 and others 0 to 255.
#[test]
fn vertices_have_colours_as_in_ply() {
    const POINTS: [[u8; 3]; 4] = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
    const COLORS: [[u8; 3]; 4] = [[255, 0, 0], [0, 255, 0], [51, 102, 204], [7, 8, 9]];
    let shown = |numbers: [u8; 3]| format!("{} {} {}", numbers[0], numbers[1], numbers[2]);
    let lines = |color: &dyn Fn([u8; 3]) -> String, before: &str| -> String {
        POINTS.iter().zip(COLORS).map(|(&point, own)| format!("{before}{} {}\n", shown(point), color(own))).collect()
    };
    let mut header = String::from("ply\nformat ascii 1.0\nelement vertex 4\n");
    for name in ["float x", "float y", "float z", "uchar red", "uchar green", "uchar blue"] {
        header += &format!("property {name}\n");
    }
    header += "element face 3\nproperty list uchar int vertex_index\nend_header\n";
    let read = |text: &str, path: &str| {
        let loaded = loaded(text, path);
        assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
        let texture = loaded.mesh.surfaces()[0].texture.clone().expect("a texture");
        (loaded.mesh.texcoords().expect("coordinates").to_vec(), Texture::clone(&loaded.textures[&texture]))
    };
    let due = read(&format!("{header}{}3 0 2 1\n3 0 1 3\n3 0 3 2\n", lines(&shown, "")), "a.ply");
    let faces = "f 1 3 2\nf 1 2 4\nf 1 4 3\n";
    let shares = |color: [u8; 3]| {
        let [r, g, b] = color.map(|channel| f32::from(channel) / 255.0);
        format!("{r} {g} {b}")
    };
    assert_eq!(read(&format!("{}{faces}", lines(&shown, "v ")), "a.obj"), due);
    assert_eq!(read(&format!("{}{faces}", lines(&shares, "v ")), "a.obj"), due);
    // A little brighter than white.
    let bright = |color: [u8; 3]| shares(color).replace("1 ", "1.000001 ");
    assert_eq!(read(&format!("{}{faces}", lines(&bright, "v ")), "a.obj"), due);
    // With an alpha after it.
    assert_eq!(read(&format!("{}{faces}", lines(&|color| shares(color) + " 1", "v ")), "a.obj"), due);

    let mtl =
        "newmtl red\nKd 1 0 0\nnewmtl grey\nKd 0.6 0.6 0.6\nnewmtl shiny\nKd 0.7 0.7 0.7\nKs 0.5 0.5 0.5\nNs 30\n";
    let parse = |text: &str| with_mtl(text, mtl).expect("a model");
    let first = lines(&shares, "v ");
    for text in [
        // One vertex without.
        format!("{first}v 2 2 2\n{faces}"),
        format!("v 2 2 2\n{first}f 2 4 3\n"),
        // A material has a colour of its own, or another material has one.
        format!("mtllib a.mtl\n{first}usemtl red\n{faces}"),
        format!("mtllib a.mtl\n{first}usemtl grey\n{faces}usemtl shiny\n{faces}"),
    ] {
        let loaded = parse(&text);
        assert!(loaded.warnings.len() == 1 && loaded.textures.is_empty(), "{:?}", loaded.warnings);
        assert!(loaded.warnings[0].ends_with(": vertex colours left out"), "{:?}", loaded.warnings);
    }
    // A grey only scales their light, as with a texture, and a highlight stays.
    let shiny = parse(&format!("mtllib a.mtl\n{first}usemtl red\nusemtl shiny\n{faces}"));
    let surface = &shiny.mesh.surfaces()[0];
    assert_eq!((surface.name.as_str(), surface.specular, surface.shininess), ("shiny", [0.5; 3], 30.0));
    assert_eq!(*shiny.textures[surface.texture.as_ref().expect("a texture")], due.1);
    // A weight is not a colour, and neither are words.
    let weights = parse(&format!("v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nv 0 0 1 1\n{faces}"));
    assert!(weights.warnings.is_empty() && weights.textures.is_empty());
    let words = parse(&format!("v 0 0 0 a b c\nv 1 0 0 a b c\nv 0 1 0 a b c\nv 0 0 1 a b c\n{faces}"));
    assert!(words.warnings.is_empty() && words.textures.is_empty());
}

#[test]
fn surfaces_are_those_in_use_in_order() {
    let mtl = "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\nnewmtl a\nKd 0 0 1\n";
    let text = format!("mtllib one.mtl\n{TRIANGLE}usemtl c\nusemtl b\nf 1 2 3\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n");
    let library = |path: &Path| {
        assert_eq!(path, Path::new("models/one.mtl"));
        Ok(mtl.into())
    };
    let loaded = obj::parse(text.as_bytes(), "models/model.obj", library).unwrap();
    let names: Vec<_> = loaded.mesh.surfaces().iter().map(|s| (s.name.as_str(), s.diffuse)).collect();
    assert_eq!(names, [("b", [0.0, 1.0, 0.0]), ("a", [0.0, 0.0, 1.0])]);
    assert_eq!(loaded.mesh.triangle_surfaces(), [0, 1, 0]);
}

#[test]
fn library_names() {
    let read = |line: &str, files: &[&str]| {
        let text = format!("{line}\n{TRIANGLE}usemtl a\nf 1 2 3\n");
        let library = |path: &Path| match files.iter().any(|file| Path::new(file) == path) {
            true => Ok(b"newmtl a\nmap_Kd -o 0 -bm 0.5 -mm 0 1 textures/a b.png\n".to_vec()),
            false => Err(io::ErrorKind::NotFound.into()),
        };
        let loaded = obj::parse(text.as_bytes(), "model.obj", library).unwrap();
        (loaded.warnings.len(), loaded.mesh.surfaces()[0].texture.clone())
    };
    let found = |folder: &str| (0, Some(Path::new(folder).join("textures/a b.png").to_string_lossy().into_owned()));
    assert_eq!(read("mtllib one two.mtl", &["one two.mtl"]), found(""));
    assert_eq!(read("mtllib one.mtl two.mtl", &["one.mtl", "two.mtl"]), found(""));
    assert_eq!(read("mtllib parts\\one.mtl", &["parts/one.mtl"]), found("parts"));
    assert_eq!(read("mtllib a\\one.mtl a\\two.mtl", &["a/one.mtl", "a/two.mtl"]), found("a"));
    assert_eq!(read("mtllib one.mtl two.mtl", &["one.mtl"]), (1, None));
}

/// Textures are found although their names have Windows' separators, or a comment follows; a file of exactly the name given
/// is preferred.
#[test]
fn texture_names() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::create_dir(path("tex")).unwrap();
    ["tex/a b.png", "c #1.png", "c"].iter().for_each(|name| std::fs::write(path(name), "").unwrap());
    let ply = |name: &str| {
        let vertex = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float s\nproperty float t\n";
        let face = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
        let rows = "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n";
        format!("ply\nformat ascii 1.0\ncomment TextureFile {name}\n{vertex}{face}{rows}")
    };
    for (name, expected) in [
        ("tex\\a b.png", "tex/a b.png"),
        ("tex/a b.png # note", "tex/a b.png"),
        ("c #1.png", "c #1.png"),
        ("c # 1", "c"),
    ] {
        std::fs::write(path("a.obj"), format!("mtllib a.mtl\n{TRIANGLE}usemtl a\nf 1 2 3\n")).unwrap();
        std::fs::write(path("a.mtl"), format!("newmtl a\nmap_Kd {name}\n")).unwrap();
        std::fs::write(path("a.ply"), ply(name)).unwrap();
        for model in ["a.obj", "a.ply"] {
            let mesh = model_file::load(path(model)).unwrap().mesh;
            let texture = mesh.surfaces()[0].texture.as_deref().map(Path::new);
            assert_eq!(texture, Some(path(expected).as_path()), "{name} in {model}");
        }
    }
}

/// A mesh of one face in the plane z = 0, compared with that face: n − 2 triangles, none flipped, whose areas add up,
/// and each edge of the face in exactly one of them.
pub(crate) fn check_split(mesh: &Mesh, face: &[Vec3]) {
    assert_eq!(mesh.triangles().len(), face.len() - 2);
    let double_area = |a: Vec3, b: Vec3, c: Vec3| {
        let d = |p: Vec3| (f64::from(p.x) - f64::from(a.x), f64::from(p.y) - f64::from(a.y));
        d(b).0 * d(c).1 - d(b).1 * d(c).0
    };
    let bits = |p: Vec3| p.to_array().map(f32::to_bits);
    let mut edges: HashMap<_, i32> = HashMap::new();
    let mut sum = 0.0;
    for triangle in mesh.triangles() {
        let p = triangle.map(|i| mesh.positions()[i as usize]);
        let area = double_area(p[0], p[1], p[2]);
        assert!(area >= 0.0, "{p:?}");
        sum += area;
        for i in 0..3 {
            *edges.entry((bits(p[i]), bits(p[(i + 1) % 3]))).or_default() += 1;
        }
    }
    let whole: f64 = (1..face.len() - 1).map(|i| double_area(face[0], face[i], face[i + 1])).sum();
    assert!((sum - whole).abs() <= 1e-9 * whole.abs(), "{sum} {whole}");
    for i in 0..face.len() {
        let (from, to) = (bits(face[i]), bits(face[(i + 1) % face.len()]));
        if from == to {
            continue;
        }
        let net = edges.get(&(from, to)).unwrap_or(&0) - edges.get(&(to, from)).unwrap_or(&0);
        assert_eq!(net, 1, "edge {i}");
    }
}

pub(crate) fn face_text(face: &[Vec3]) -> String {
    let mut text: String = face.iter().map(|p| format!("v {} {} {}\n", p.x, p.y, p.z)).collect();
    text.push('f');
    (1..=face.len()).for_each(|i| write!(text, " {i}").unwrap());
    text
}

#[test]
fn concave_faces_in_any_plane() {
    // An L.
    let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
    let planes: [fn((f32, f32)) -> Vec3; 6] = [
        |(a, b)| Vec3::new(a, b, 7.0),
        |(a, b)| Vec3::new(7.0, a, b),
        |(a, b)| Vec3::new(b, 7.0, a),
        |(a, b)| Vec3::new(b, a, 7.0),
        |(a, b)| Vec3::new(7.0, b, a),
        |(a, b)| Vec3::new(a, 7.0, b),
    ];
    for (i, plane) in planes.into_iter().enumerate() {
        for start in 0..6 {
            let mut face = corners.map(plane);
            face.rotate_left(start);
            let mesh = mesh(face_text(&face));
            assert_eq!(mesh.triangles().len(), 4);
            let normal = if i < 3 { plane((0.0, 0.0)) / 7.0 } else { plane((0.0, 0.0)) / -7.0 };
            let mut area = 0.0;
            for t in mesh.triangles() {
                let [a, b, c] = t.map(|i| mesh.positions()[i as usize]);
                let double = (b - a).cross(c - a).dot(normal);
                assert!(double >= 0.0, "plane {i}, start {start}");
                area += double / 2.0;
            }
            assert_eq!(area, 3.0);
            assert!(mesh.normals().iter().all(|&n| n == normal));
        }
    }
}

/// Corners in the middle of a straight edge are kept, or there would be a gap to the neighbour.
#[test]
fn corners_on_straight_edges_are_kept() {
    let outline = [(0, 0), (1, 0), (2, 0), (4, 0), (4, 2), (3, 2), (2, 2), (2, 3), (2, 4), (1, 4), (0, 4), (0, 1)];
    for start in 0..outline.len() {
        let mut face: Vec<Vec3> = outline.iter().map(|&(x, y)| Vec3::new(x as f32, y as f32, 0.0)).collect();
        face.rotate_left(start);
        check_split(&mesh(face_text(&face)), &face);
    }
}

/// Ear clipping drops the second of two corners at the same position.
#[test]
fn concave_faces_with_a_corner_twice() {
    let outline = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
    for start in 0..6 {
        for twice in 0..6 {
            let mut face = outline.map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec();
            face.rotate_left(start);
            face.insert(twice, face[twice]);
            check_split(&mesh(face_text(&face)), &face);
            face.rotate_left(twice + 1);
            check_split(&mesh(face_text(&face)), &face);
        }
    }
}

/// Any face, even a tangled one or one in a single point, gives n − 2 triangles.
#[test]
fn strange_faces_have_their_count() {
    for face in ["1 2 3 1 2 3", "1 1 1 1", "1 2 1 2 1 2", "1 2 3 3 3 2", "1 2 4 3", "1 4 2 3 1 4"] {
        let mesh = mesh(format!("{TRIANGLE}v 1 1 0\nf {face}\nf 1 2 3\n"));
        assert_eq!(mesh.triangles().len(), face.split(' ').count() - 1);
    }
}

/// `tobj`'s corners: position, texture coordinates, normal.
fn by_tobj(text: &str) -> Vec<[f32; 8]> {
    let options = tobj::LoadOptions { single_index: true, triangulate: true, ..Default::default() };
    let (models, _) =
        tobj::load_obj_buf(&mut text.as_bytes(), &options, |_| Err(tobj::LoadError::OpenFileFailed)).unwrap();
    let corners = models.iter().flat_map(|model| {
        let m = &model.mesh;
        m.indices.iter().map(|&i| {
            let i = i as usize;
            let (p, t, n) = (&m.positions[3 * i..], &m.texcoords[2 * i..], &m.normals[3 * i..]);
            [p[0], p[1], p[2], t[0], t[1], n[0], n[1], n[2]]
        })
    });
    corners.collect()
}

proptest! {
    /// Triangles and convex quads with all three indices, positive or negative: what tobj can read.
    #[test]
    fn the_same_as_tobj(
        numbers in prop::collection::vec(prop::array::uniform3(any::<f32>().prop_filter("finite", |x| x.is_finite())), 4..30),
        faces in prop::collection::vec((prop::collection::vec(any::<prop::sample::Index>(), 3), any::<bool>()), 1..30),
    ) {
        let axes = ["1 0 0", "0 1 0", "0 0 1", "-1 0 0"];
        let count = numbers.len();
        let mut text = String::new();
        for (i, [x, y, z]) in numbers.iter().enumerate() {
            writeln!(text, "v {x} {y:e} {z}\nvt {y} {x:e}\nvn {}", axes[i % 4]).unwrap();
        }
        for (i, (corners, negative)) in faces.iter().enumerate() {
            if i % 7 == 3 {
                writeln!(text, "g part {i}").unwrap();
            }
            text.push('f');
            for (k, corner) in corners.iter().enumerate() {
                let index = |shift: usize| {
                    let index = (corner.index(count) + shift * k) % count;
                    if *negative { index as i64 - count as i64 } else { index as i64 + 1 }
                };
                write!(text, " {}/{}/{}", index(0), index(1), index(2)).unwrap();
            }
            text.push('\n');
        }
        let (ours, warnings) = match parse(&text) {
            Ok(Loaded { mesh, warnings, .. }) => (mesh, warnings),
            Err(ModelFileError { kind: ModelFileErrorKind::NoArea, .. }) => return Ok(()),
            Err(error) => return Err(TestCaseError::fail(error.to_string())),
        };
        // Only what tobj reads without repairs.
        prop_assume!(warnings.is_empty());
        let texcoords = ours.texcoords().unwrap();
        let corners: Vec<[f32; 8]> = ours.triangles().iter().flatten().map(|&i| {
            let (p, t, n) = (ours.positions()[i as usize], texcoords[i as usize], ours.normals()[i as usize]);
            [p.x, p.y, p.z, t.x, t.y, n.x, n.y, n.z]
        }).collect();
        prop_assert_eq!(corners, by_tobj(&text));
    }

    /// Star-shaped, so usually concave faces, with some corners on straight edges.
    #[test]
    fn concave_faces_are_split(radii in prop::collection::vec(1u8..=8, 5..60), middle in any::<bool>()) {
        let n = radii.len();
        let outer: Vec<Vec3> = radii.iter().enumerate().map(|(i, &r)| {
            let angle = 2.0 * std::f32::consts::PI * i as f32 / n as f32;
            // On a grid, so that the middle of an edge is exactly on it.
            (Vec3::new(angle.cos(), angle.sin(), 0.0) * f32::from(r) * 512.0).round() * 2.0
        }).collect();
        let mut face = Vec::new();
        for i in 0..n {
            face.push(outer[i]);
            if middle {
                face.push((outer[i] + outer[(i + 1) % n]) / 2.0);
            }
        }
        check_split(&mesh(face_text(&face)), &face);
    }

    /// Skylines with a corner at every unit, so that most lie on straight edges and no ear is sharp.
    #[test]
    fn skylines_are_split(heights in prop::collection::vec(1u8..=6, 1..20), start in any::<prop::sample::Index>()) {
        let mut face = Vec::new();
        let columns = heights.len() as i32;
        let mut at = (0, 0);
        let mut to = |x: i32, y: i32| {
            while at != (x, y) {
                face.push(Vec3::new(at.0 as f32, at.1 as f32, 0.0));
                at = (at.0 + (x - at.0).signum(), at.1 + (y - at.1).signum());
            }
        };
        to(columns, 0);
        for (x, &height) in heights.iter().enumerate().rev() {
            to(x as i32 + 1, i32::from(height));
            to(x as i32, i32::from(height));
        }
        to(0, 0);
        let middle = start.index(face.len());
        face.rotate_left(middle);
        check_split(&mesh(face_text(&face)), &face);
    }
}

/// Whatever the file contains: a valid mesh, or an error on one line.
#[test]
fn f1_no_file_breaks_the_parser() {
    let tried = Tried::new("f1_no_file_breaks_the_parser", 256);
    property(tried, prop::collection::vec(token(), 0..200), |text| {
        let text: String = text.concat();
        let library = |path: &Path| {
            if path == Path::new("a") { Ok(text.clone().into_bytes()) } else { no_library(path) }
        };
        match obj::parse(text.as_bytes(), "model.obj", library) {
            Ok(Loaded { mesh, .. }) => {
                prop_assert!(!mesh.triangles().is_empty());
                prop_assert!(mesh.positions().iter().all(|p| p.is_finite()));
                prop_assert!(mesh.normals().iter().all(|n| n.is_normalized()));
                prop_assert!(mesh.triangles().iter().flatten().all(|&i| (i as usize) < mesh.positions().len()));
                prop_assert_eq!(mesh.triangles().len(), mesh.triangle_surfaces().len());
            }
            Err(error) => prop_assert_eq!(error.to_string().lines().count(), 1),
        }
        Ok(())
    });
}

#[test]
fn f1_no_bytes_break_the_parser() {
    let tried = Tried::new("f1_no_bytes_break_the_parser", 256);
    property(tried, prop::collection::vec(any::<u8>(), 0..500), |bytes| {
        if let Err(error) = parse(&bytes) {
            prop_assert_eq!(error.to_string().lines().count(), 1);
        }
        Ok(())
    });
}

/// Pieces of OBJ and MTL text; faces mostly with valid indices.
fn token() -> impl Strategy<Value = String> {
    let lines = "v 0 0 0|v 1 0 0|v 1 1 0|v 0 1 0|v 3e38 -3e38 0|v 1e-45 0 0|vt 0 1|vn 0 0 1|vn 0 0 0|f 1 2 3|f 1 2 3 4|\
                 f -1 -2 -3|f 1/1/1 2/1/1 3/1/1|f 4 3 2 1 2 3 4|usemtl a|mtllib a|mtllib b|newmtl a|Kd 1 0 0|Ns 5|g x|\
                 l 1 2 3";
    let begun = ["\nv ", "\nf ", "\nKd ", "\nmap_Kd ", "-s ", "-o 1 1 1 "];
    let words = ["\n", "\n", "\r\n", " ", "\t", "\\\n", "#", "/", "//"];
    let values = ["nan", "inf", "1e99", "0", "-0", "é", "\u{FEFF}", "\0"];
    let pieces = [&begun[..], &words, &values].concat().into_iter().map(str::to_owned);
    let fixed: Vec<String> = lines.split('|').map(|line| format!("\n{line}\n")).chain(pieces).collect();
    prop_oneof![
        6 => prop::sample::select(fixed),
        3 => (-6i64..8).prop_map(|i| format!(" {i}")),
        1 => any::<i64>().prop_map(|i| format!(" {i}")),
        1 => any::<f32>().prop_map(|x| format!(" {x}")),
        1 => "\\PC{0,6}",
    ]
}

/// Each triangle knows the line of its face, even if faces were split, left out or flipped.
#[test]
fn every_triangle_knows_its_line() {
    let mut tried = Tried::new("every_triangle_knows_its_line", 56);
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
    // A cube that is inside out, and two faces back to back in it, which are left out.
    let inside_out = format!(
        "{cube}f 1 2 3 4\n# the top\nf 8 7 6 5\nv 9 0 0\nv 9 1 0\nv 9 0 1\nf 9 10 11\nf 9 11 10\nf 5 6 2 1\n\
         f 6 7 \\\n3 2\nf 7 8 4 3\nf 8 5 1 4\n"
    );
    let [house, chest] = ["house.obj", "chest.obj"].map(|name| fs::read_to_string(data(name)).expect("text"));
    for text in [&inside_out, &house, &chest] {
        let loaded = obj::parse(text.as_bytes(), "model.obj", no_library).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        let points: Vec<Vec3> = lines
            .iter()
            .filter_map(|line| line.strip_prefix("v "))
            .map(|line| {
                let numbers: Vec<f32> = line.split_whitespace().map(|word| word.parse().unwrap()).collect();
                Vec3::from_slice(&numbers)
            })
            .collect();
        let mesh = &loaded.mesh;
        for (i, triangle) in mesh.triangles().iter().enumerate() {
            let first = mesh.line(i).expect("a line") as usize - 1;
            // A continued line counts by its start.
            let mut face = lines[first].strip_prefix("f ").expect("a face").to_string();
            if let Some(begun) = face.clone().strip_suffix('\\') {
                face = format!("{begun} {}", lines[first + 1]);
            }
            let corners: Vec<Vec3> = face
                .split_whitespace()
                .map(|word| match word.split('/').next().unwrap().parse::<isize>().unwrap() {
                    index @ 1.. => points[index as usize - 1],
                    // Counted back from the last point above the face.
                    index => {
                        let above = lines[..first].iter().filter(|line| line.starts_with("v ")).count();
                        points[above.checked_add_signed(index).unwrap()]
                    }
                })
                .collect();
            for &corner in triangle {
                assert!(corners.contains(&mesh.positions()[corner as usize]), "triangle {i}: {face}");
            }
            tried.add(1);
        }
        assert_eq!(mesh.line(mesh.triangles().len()), None);
    }
    assert_eq!(shapes::cube().line(0), None);
}
