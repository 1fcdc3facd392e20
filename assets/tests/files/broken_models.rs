//! Hard case F1: broken models are rejected with a position, and large but well-formed ones load.

use std::fs;
use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use mode13h::glam::Vec3;
use mode13h_assets::model_file::{self, ModelFileError, ModelFileErrorKind, obj};

use crate::obj_files::{TRIANGLE, check_split, data, face_text, mesh, no_library, parse, refused, with_mtl};
use crate::support::tried::Tried;

#[test]
fn f1_broken_files() {
    let mut tried = Tried::new("f1_broken_files", 7);
    let message = |name: &str| model_file::load(data(name)).unwrap_err().to_string();
    for (name, end) in [
        ("broken_nan.obj", "broken_nan.obj:4: `nan` is not a finite number"),
        ("broken_empty.obj", "broken_empty.obj: no faces"),
        ("broken_binary.obj", "broken_binary.obj:1: not a text file"),
        ("broken_library.obj", "broken_library.mtl:2: too few numbers for a colour (1 or 3)"),
    ] {
        let message = message(name);
        assert!(message.ends_with(end) && message.lines().count() == 1, "{message}");
        tried.add(1);
    }
    assert!(matches!(
        model_file::load(data("nowhere.obj")).unwrap_err(),
        ModelFileError { place: None, kind: ModelFileErrorKind::Read(error), .. } if error.kind() == io::ErrorKind::NotFound
    ));
    tried.add(1);
    assert!(message("nowhere.obj").contains("nowhere.obj: "));
    tried.add(1);
    let folder = model_file::load(data("")).unwrap_err();
    assert!(matches!(folder.kind, ModelFileErrorKind::Directory), "{folder}");
    tried.add(1);
}

/// The fault follows five correct lines, with any kind of line ending.
#[test]
fn f1_broken_lines() {
    let mut tried = Tried::new("f1_broken_lines", 3 * 40);
    let not_a_corner = "is not a face corner (v, v/vt, v//vn or v/vt/vn)";
    for (lines, message) in [
        ("f 0 1 2", "6: index 0: indices count from 1"),
        ("f 1 2 3\nf 1 0 2", "7: index 0: indices count from 1"),
        ("f 1 2 4", "6: there is no vertex 4, only 3"),
        ("f 1 2 -4", "6: there is no vertex -4, only 3"),
        ("f 1/1 2/2 3/1", "6: there is no texture coordinate 2, only 1"),
        ("# a comment\n\nf 1//1 2//1 3//-2", "8: there is no normal -2, only 1"),
        ("f 1//1 2//2 3", "6: there is no normal 2, only 1"),
        ("f 1/0 2/1 3/1", "6: index 0: indices count from 1"),
        ("f 1 2 2147483648", "6: there is no vertex 2147483648, only 3"),
        ("f 1 2 4294967297", "6: there is no vertex 4294967297, only 3"),
        ("f 1 2 99999999999", "6: there is no vertex 99999999999, only 3"),
        ("f 1 2 99999999999999999999", &format!("6: `99999999999999999999` {not_a_corner}")),
        ("f 1 2 -9223372036854775807", "6: there is no vertex -9223372036854775807, only 3"),
        ("f 1 2 x", &format!("6: `x` {not_a_corner}")),
        ("f 1 2 3.0", &format!("6: `3.0` {not_a_corner}")),
        ("f 1/1/1/1 2 3", &format!("6: `1/1/1/1` {not_a_corner}")),
        ("f /1 2 3", &format!("6: `/1` {not_a_corner}")),
        ("f 1 4", "6: there is no vertex 4, only 3"),
        ("v 1 2", "6: too few numbers for a position (3)"),
        ("v 1 2 three", "6: `three` is not a number"),
        ("v 1 2 inf", "6: `inf` is not a finite number"),
        ("v nan -inf 0", "6: `nan` is not a finite number"),
        ("v 0 -inf 0", "6: `-inf` is not a finite number"),
        ("v 1e39 0 1e999", "6: `1e39` is not a finite number"),
        ("v 0 0 1e999", "6: `1e999` is not a finite number"),
        ("v 1 2 3 nan 0 1", "6: `nan` is not a finite number"),
        ("vn 0 NaN 1", "6: `NaN` is not a finite number"),
        ("vn 1", "6: too few numbers for a normal (3)"),
        ("vt", "6: too few numbers for texture coordinates (2)"),
        ("vt inf", "6: `inf` is not a finite number"),
        ("v 1 2 \u{1}\u{2}", "6: `\u{FFFD}\u{FFFD}` is not a number"),
        ("v 0 0 0\0", "6: `0\u{FFFD}` is not a number"),
        ("\u{0}\u{1}", "6: not a text file"),
        ("f 1 2 \\\n\\\n9\nf 1 2 3", "6: there is no vertex 9, only 3"),
        ("f 1 \\\n4", "6: there is no vertex 4, only 3"),
        (&format!("v {} 0 0", "9".repeat(1 << 20)), &format!("6: `{}…` is not a finite number", "9".repeat(40))),
        (&format!("v {} 0 0", "9x".repeat(1000)), &format!("6: `{}…` is not a number", "9x".repeat(20))),
        (&format!("f 1 2 {}", "3".repeat(1 << 20)), &format!("6: `{}…` {not_a_corner}", "3".repeat(40))),
        (&format!("f {}4", "1 ".repeat(1 << 19)), "6: there is no vertex 4, only 3"),
        (&format!("{}f 1 2 4", "\\\n".repeat(1000)), "6: there is no vertex 4, only 3"),
    ] {
        let text = format!("{TRIANGLE}vt 0 0\nvn 0 0 1\n{lines}\nf 1 2 3\n");
        for line_end in ["\n", "\r\n", "\r"] {
            assert_eq!(refused(text.replace('\n', line_end)), format!("model.obj:{message}"), "{lines:.99}");
            tried.add(1);
        }
    }
}

/// Other kinds of files, given by mistake.
#[test]
fn f1_what_is_no_model_at_all_is_refused() {
    let mut tried = Tried::new("f1_what_is_no_model_at_all_is_refused", 14);
    let text = format!("{TRIANGLE}f 1 2 3\n");
    let utf16 =
        |bytes: fn(u16) -> [u8; 2]| -> Vec<u8> { format!("\u{FEFF}{text}").encode_utf16().flat_map(bytes).collect() };
    // The same model, gzipped: header, one stored block, checksum and length left at 0.
    let mut gzip = b"\x1F\x8B\x08\0\0\0\0\0\0\x03\x01".to_vec();
    gzip.extend((text.len() as u16).to_le_bytes());
    gzip.extend((!(text.len() as u16)).to_le_bytes());
    gzip.extend(text.bytes());
    gzip.extend([0; 8]);
    let this_program = fs::read(std::env::current_exe().expect("a path")).expect("a program");
    for (bytes, message) in [
        (&b""[..], ": no faces"),
        (b"\n", ": no faces"),
        (b"v 0 0 0\n", ": no faces"),
        (TRIANGLE.as_bytes(), ": no faces"),
        (b"v 0 0 0\nl 1 2 3\np 1\n", ": no faces"),
        (b"Dear reader,\nthis is no model.\n", ": no faces"),
        ("\u{FEFF}".as_bytes(), ": no faces"),
        (&gzip, ":1: not a text file"),
        (&utf16(u16::to_le_bytes), ":1: not a text file"),
        (&utf16(u16::to_be_bytes), ":1: not a text file"),
        (b"\x89PNG\r\n\x1A\n\0\0\0\rIHDR", ":3: not a text file"),
        (&[0; 1 << 20], ":1: not a text file"),
        (&this_program[..65_536], "not a text file"),
    ] {
        let error = refused(bytes);
        assert!(error.starts_with("model.obj") && error.ends_with(message), "{error}, not {message}");
        tried.add(1);
    }
    // A device, or a small packed file, may have no line ending at all.
    let endless = obj::parse(io::BufReader::new(io::repeat(b'#')), "model.obj", no_library);
    assert_eq!(endless.map(|_| ()).unwrap_err().to_string(), "model.obj: a line of more than 64 MiB");
    tried.add(1);
}

/// An index may refer to a later vertex; the first that never comes is the error.
#[test]
fn f1_indices_that_look_ahead() {
    let mut tried = Tried::new("f1_indices_that_look_ahead", 3);
    assert_eq!(mesh(format!("f 1 2 3\n{TRIANGLE}")).triangles(), [[0, 1, 2]]);
    tried.add(1);
    let late = refused(format!("f 1 2 3\nf 1 2 5\nf 1 4 2\nf 1 2 9\n{TRIANGLE}"));
    assert_eq!(late, "model.obj:2: there is no vertex 5, only 3");
    tried.add(1);
    let normal = refused(format!("f 1//2 2//2 3//2\nf 1 2 9\nvn 0 0 1\n{TRIANGLE}"));
    assert_eq!(normal, "model.obj:1: there is no normal 2, only 1");
    tried.add(1);
}

#[test]
fn f1_broken_libraries() {
    let mut tried = Tried::new("f1_broken_libraries", 5);
    for (mtl, message) in [
        ("Kd", "2: too few numbers for a colour (1 or 3)"),
        ("Kd 1 1", "2: too few numbers for a colour (1 or 3)"),
        ("\nKs red", "3: `red` is not a number"),
        ("Ns nan", "2: `nan` is not a finite number"),
        ("Ns", "2: too few numbers for an exponent (1)"),
    ] {
        let text = format!("mtllib a.mtl\n{TRIANGLE}f 1 2 3\n");
        let error = with_mtl(&text, &format!("newmtl a\n{mtl}\n")).unwrap_err();
        assert_eq!(error.to_string(), format!("a.mtl:{message}"));
        tried.add(1);
    }
}

/// Files that name something that is not a regular file: folders, devices that never end; or the model itself.
#[test]
fn f1_libraries_that_are_no_libraries_are_a_warning() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("model.obj");
    fs::create_dir(folder.path().join("folder.mtl")).expect("made");
    let mut tried = Tried::new("f1_libraries_that_are_no_libraries_are_a_warning", 6);
    for (library, warnings) in [
        ("folder.mtl", 1),
        ("", 1),
        ("..", 1),
        ("none.mtl", 1),
        ("/dev/zero", 1),
        // No material in it, so that the one in use is missing.
        ("model.obj", 1),
    ] {
        fs::write(&path, format!("mtllib {library}\n{TRIANGLE}usemtl m\nf 1 2 3\n")).expect("written");
        let loaded = model_file::load(&path).expect("a model");
        assert_eq!(loaded.warnings.len(), warnings, "{library}: {:?}", loaded.warnings);
        assert_eq!(loaded.mesh.surfaces()[0].name, "m");
        tried.add(1);
    }
}

/// Warnings are limited, however many lines cause one.
#[test]
fn f1_warnings_are_counted_and_not_piled_up() {
    let mut tried = Tried::new("f1_warnings_are_counted_and_not_piled_up", 4);
    for (materials, lines, last) in [
        (99, 99, "there is no material m98; it is white and matt"),
        (100, 100, "there is no material m99; it is white and matt"),
        (101, 101, "one more warning like these"),
        (65_536, 101, "65436 more warnings like these"),
    ] {
        let faces: String = (0..materials).fold(TRIANGLE.into(), |text, i| text + &format!("usemtl m{i}\nf 1 2 3\n"));
        let loaded = parse(faces).expect("a model");
        assert_eq!((loaded.warnings.len(), loaded.mesh.surfaces().len()), (lines, materials));
        let said = loaded.warnings.last().expect("one");
        assert!(said.ends_with(last), "{said}");
        tried.add(1);
    }
}

/// Large but well-formed files load, up to documented limits.
#[test]
fn f1_what_is_large_but_well_formed_loads() {
    let mut tried = Tried::new("f1_what_is_large_but_well_formed_loads", 12);
    let mut loads = |text: &str, triangles: usize| {
        assert_eq!(mesh(text).triangles().len(), triangles);
        tried.add(1);
    };
    let plain = format!("{TRIANGLE}f 1 2 3\n");
    let megabyte = 1 << 20;
    loads(&format!("# {}\n{plain}", "x".repeat(megabyte)), 1);
    loads(&format!("{TRIANGLE}f{}1 2 3\n", " ".repeat(megabyte)), 1);
    loads(&format!("{TRIANGLE}f 1 2 3{}", " ".repeat(megabyte)), 1);
    loads(&format!("{TRIANGLE}f 1 2 \\\n{} 3\n", "\\\n".repeat(megabyte)), 1);
    loads(&format!("o {}\n{plain}", "name".repeat(megabyte / 4)), 1);
    loads(&format!("{TRIANGLE}usemtl {}\nf 1 2 3\n", "m".repeat(megabyte)), 1);
    // Convex: any number of corners, even if rounding has dented them.
    let circle = |corners: usize, inner: f64| -> Vec<Vec3> {
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / corners as f64;
        let radius = |i: usize| if i.is_multiple_of(2) { 1.0 } else { inner };
        let corner =
            |i: usize| Vec3::new((angle(i).cos() * radius(i)) as f32, (angle(i).sin() * radius(i)) as f32, 0.0);
        (0..corners).map(corner).collect()
    };
    loads(&face_text(&circle(100_000, 1.0)), 99_998);
    let side = 25_000_i16;
    let mut square: Vec<(i16, i16)> = (0..side).map(|i| (i, 0)).collect();
    square.extend((0..side).map(|i| (side, i)));
    square.extend((1..=side).rev().map(|i| (i, side)));
    square.extend((1..=side).rev().map(|i| (0, i)));
    let square: Vec<Vec3> = square.into_iter().map(|(x, y)| Vec3::new(x.into(), y.into(), 0.0)).collect();
    loads(&face_text(&square), 99_998);
    // All corners in one point, or all on a line.
    loads(&format!("{plain}f{}", " 1".repeat(1_000_000)), 999_999);
    // Concave: up to 20,000.
    loads(&face_text(&circle(10_000, 0.5)), 9_998);
    loads(&face_text(&circle(20_000, 0.5)), 19_998);
    let error = refused(face_text(&circle(20_001, 0.5)));
    assert_eq!(error, "model.obj:20002: a concave face of more than 20,000 corners");
    // A saw with 5,000 teeth.
    let teeth = (0..10_000).map(|i| (i as f32, (i % 2) as f32));
    let outline = [(9999.0, -1.0), (0.0, -1.0)].into_iter().chain(teeth);
    let face: Vec<Vec3> = outline.rev().map(|(x, y)| Vec3::new(x, y, 0.0)).collect();
    check_split(&mesh(face_text(&face)), &face);
    tried.add(1);
}

/// The time that this thread has worked: on Linux its processor time, to which other programs do not add, counted in
/// ticks of some milliseconds.
fn time_at_work(epoch: Instant) -> Duration {
    let schedule = fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = schedule.and_then(|text| text.split(' ').next()?.parse().ok());
    nanoseconds.filter(|&time| time > 0).map_or_else(|| epoch.elapsed(), Duration::from_nanos)
}

/// The mean time, in seconds, of as many runs as take fifty milliseconds.
fn time_to_parse(text: &str, library: &str) -> f64 {
    let epoch = Instant::now();
    let begun = time_at_work(epoch);
    let mut runs = 0;
    loop {
        let _ = obj::parse(text.as_bytes(), "model.obj", |_: &Path| Ok(library.into()));
        runs += 1;
        let taken = time_at_work(epoch).saturating_sub(begun);
        if taken >= Duration::from_millis(50) {
            return taken.as_secs_f64() / f64::from(runs);
        }
    }
}

/// A file eight times as long takes about eight times as long to read, and at most twelve times, except where the
/// reason is known. There are three attempts, as the machine may be busy.
#[test]
#[ignore = "the long run: it measures time"]
fn f1_long_time_grows_as_the_file_does() {
    type Make = fn(usize) -> (String, String);
    let cases: [(&str, Make); 20] = [
        ("backslashes", |n| ("\\\n".repeat(n), String::new())),
        ("blank lines joined", |n| (" \t\\\r\n".repeat(n), String::new())),
        ("carriage returns", |n| ("\r".repeat(n) + TRIANGLE, String::new())),
        ("joined lines of a face", |n| (format!("{TRIANGLE}f{}", " 1 2 3 \\\n".repeat(n)), String::new())),
        ("a triangle gone round many times", |n| {
            // Limited to the most corners that a concave face may have, so only four times as many.
            (format!("{TRIANGLE}f{}", " 1 2 3".repeat(n.min(19_998) / 3)), String::new())
        }),
        ("comments", |n| ("# \\\n".repeat(n), String::new())),
        ("names of materials", |n| {
            let n = n.min(60_000);
            ((0..n).fold(TRIANGLE.into(), |t, i| t + &format!("usemtl m{i}\nf 1 2 3\n")), String::new())
        }),
        ("materials by turns", |n| {
            (format!("{TRIANGLE}{}", "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n".repeat(n / 2)), String::new())
        }),
        ("one library again and again", |n| {
            (format!("{}{TRIANGLE}f 1 2 3\n", "mtllib a\n".repeat(n / 4)), "newmtl a\nKd 1\n".repeat(n / 4))
        }),
        ("one library many times in a line", |n| {
            (format!("mtllib{}\n{TRIANGLE}f 1 2 3\n", " a".repeat(n / 4)), "newmtl a\nKd 1\n".repeat(n / 4))
        }),
        ("many libraries", |n| {
            ((0..n / 4).fold(TRIANGLE.to_string(), |t, i| t + &format!("mtllib {i}\n")) + "f 1 2 3\n", String::new())
        }),
        ("spectral colours", |n| {
            (format!("mtllib a\n{TRIANGLE}f 1 2 3\n"), "newmtl a\n".to_string() + &"Kd xyz 1\n".repeat(n))
        }),
        ("options of a texture", |n| {
            (format!("mtllib a\n{TRIANGLE}f 1 2 3\n"), "newmtl a\nmap_Kd".to_string() + &" -s 1 1 1".repeat(n))
        }),
        ("the same face", |n| (format!("{TRIANGLE}{}", "f 1 2 3\n".repeat(n)), String::new())),
        ("a sheet folded many times", |n| (format!("{TRIANGLE}{}", "f 1 2 3\nf 3 2 1\n".repeat(n / 2)), String::new())),
        ("a face in one point", |n| (format!("{TRIANGLE}f{}", " 1".repeat(n)), String::new())),
        ("faces that look ahead", |n| {
            (
                (0..n).fold(String::new(), |t, i| t + &format!("f {} {} {}\n", 3 * i + 1, 3 * i + 2, 3 * i + 3)),
                String::new(),
            )
        }),
        ("small concave faces", |n| {
            (
                "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n".to_string() + &"f 1 2 3 4 5 6\n".repeat(n / 4),
                String::new(),
            )
        }),
        ("faces around an edge", |n| {
            let points = (0..n).fold(String::from("v 0 0 0\nv 1 0 0\n"), |t, i| t + &format!("v 0 {i} 1\n"));
            ((0..n).fold(points, |t, i| t + &format!("f 1 2 {}\n", i + 3)), String::new())
        }),
        ("corners of many triples", |n| {
            let list = (1..=n / 2).fold(TRIANGLE.to_string(), |t, i| t + &format!("vt {i} 0\nvn 0 {i} 1\n"));
            ((1..=n / 2).fold(list, |t, i| t + &format!("f 1/{i}/{i} 2/{i}/{i} 3/{i}/{i}\n")), String::new())
        }),
    ];
    let mut tried = Tried::new("f1_long_time_grows_as_the_file_does", 20);
    for (what, make) in cases {
        let [(short, short_library), (long, long_library)] = [make(5_000), make(40_000)];
        let ratio = || time_to_parse(&long, &long_library) / time_to_parse(&short, &short_library);
        // A name is hashed, stored twice and copied into a surface of its own. For 5,000 names all of that fits into
        // the caches, for 40,000 it does not. The time per name grows by a tenth for each doubling, from 2,500 to
        // 60,000 names.
        let (limit, measure) = match what {
            "names of materials" => (24.0, "of materials that all have names of their own"),
            _ => (12.0, "times as long for eight times the file"),
        };
        let least =
            (0..3).map(|_| ratio()).inspect(|ratio| println!("{what}: {ratio:.1}")).find(|ratio| *ratio <= limit);
        tried.worst(measure, least.unwrap_or(f64::INFINITY));
        assert!(least.is_some(), "{what}: a file eight times as long takes more than {limit} times as long");
        tried.add(1);
    }
}
