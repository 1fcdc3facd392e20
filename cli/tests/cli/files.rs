//! Files that are broken, huge, or cannot be written: hard cases F1, F2, F4, and P5 through the program.
#![cfg_attr(not(target_os = "linux"), expect(dead_code, unused_imports, reason = "much is tried on Linux alone"))]

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use mode13h_assets::model_file::obj;
use mode13h_assets::model_file::{self, Loaded, ModelFileError, Options};
use mode13h_assets::palette_file::FORMATS;

use crate::folder::{Folder, failed, names_in};
use crate::support::tried::Tried;

fn no_library(_: &Path) -> io::Result<Vec<u8>> {
    Err(io::ErrorKind::NotFound.into())
}

fn parse(text: impl AsRef<[u8]>) -> Result<Loaded, ModelFileError> {
    obj::parse(text.as_ref(), "model.obj", no_library)
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

// F1

/// From a file, whatever ends its lines: the message names file, line and fault.
#[test]
fn f1_broken_models_are_refused_with_their_place() {
    let cases = [
        ("f 0 1 2\n".to_string(), ":4: index 0: indices count from 1"),
        ("f 1 2 3\nf 1 0 2\n".into(), ":5: index 0: indices count from 1"),
        ("f 1 2 4\n".into(), ":4: there is no vertex 4, only 3"),
        ("f 1 2 -4\n".into(), ":4: there is no vertex -4, only 3"),
        ("f 1 2 2147483648\n".into(), ":4: there is no vertex 2147483648, only 3"),
        ("f 1 2 4294967297\n".into(), ":4: there is no vertex 4294967297, only 3"),
        ("f 1//1 2 3\n".into(), ":4: there is no normal 1, only 0"),
        ("# a comment\n\nf 1/1 2/1 3/1\n".into(), ":6: there is no texture coordinate 1, only 0"),
        ("v nan 0 0\n".into(), ":4: `nan` is not a finite number"),
        ("v 0 -inf 0\n".into(), ":4: `-inf` is not a finite number"),
        ("v 0 0 1e999\n".into(), ":4: `1e999` is not a finite number"),
        ("vn 0 NaN 0\n".into(), ":4: `NaN` is not a finite number"),
        ("vt inf\n".into(), ":4: `inf` is not a finite number"),
        ("f 1 2 \\\n\\\n9\nf 1 2 3\n".into(), ":4: there is no vertex 9, only 3"),
        ("f 1 \\\n4\n".into(), ":4: there is no vertex 4, only 3"),
        (String::new(), ": no faces"),
        ("l 1 2 3\np 1\n".into(), ": no faces"),
        ("\0\0\0\0\n".into(), ":4: not a text file"),
        ("v 0 0 0\0\n".into(), ":4: `0\u{FFFD}` is not a number"),
        (
            format!("v {} 0 0\n", "9".repeat(1 << 20)),
            ":4: `9999999999999999999999999999999999999999…` is not a finite number",
        ),
        (
            format!("f 1 2 {}\n", "3".repeat(1 << 20)),
            ":4: `3333333333333333333333333333333333333333…` is not a face corner (v, v/vt, v//vn or v/vt/vn)",
        ),
        (format!("f {}4\n", "1 ".repeat(1 << 19)), ":4: there is no vertex 4, only 3"),
        (format!("{}f 1 2 4\n", "\\\n".repeat(1000)), ":4: there is no vertex 4, only 3"),
    ];
    let folder = Folder::new();
    let path = folder.path("model.obj");
    let mut tried = Tried::new("f1_broken_models_are_refused_with_their_place", 3 * 23);
    for (end, message) in &cases {
        for line_end in ["\n", "\r\n", "\r"] {
            fs::write(&path, format!("{TRIANGLE}{end}").replace('\n', line_end)).expect("written");
            let error = model_file::load(&path).expect_err(message);
            assert_eq!(error.to_string(), format!("{}{message}", path.display()));
            tried.add(1);
        }
    }
}

/// Other kinds of file, given by mistake.
#[test]
fn f1_what_is_no_model_at_all_is_refused() {
    let text = format!("{TRIANGLE}f 1 2 3\n");
    let utf16 =
        |bytes: fn(u16) -> [u8; 2]| -> Vec<u8> { format!("\u{FEFF}{text}").encode_utf16().flat_map(bytes).collect() };
    // The same model behind gzip: header, one stored block, checksum and length left at 0.
    let mut gzip = b"\x1F\x8B\x08\0\0\0\0\0\0\x03\x01".to_vec();
    gzip.extend((text.len() as u16).to_le_bytes());
    gzip.extend((!(text.len() as u16)).to_le_bytes());
    gzip.extend(text.bytes());
    gzip.extend([0; 8]);
    let cases: [(&str, Vec<u8>, &str); 11] = [
        ("empty", vec![], ": no faces"),
        ("one line end", b"\n".to_vec(), ": no faces"),
        ("one vertex", b"v 0 0 0\n".to_vec(), ": no faces"),
        ("a letter", b"Dear reader,\nthis is no model.\n".to_vec(), ": no faces"),
        ("a byte order mark", b"\xEF\xBB\xBF".to_vec(), ": no faces"),
        ("gzip", gzip, ":1: not a text file"),
        ("UTF-16, low byte first", utf16(u16::to_le_bytes), ":1: not a text file"),
        ("UTF-16, high byte first", utf16(u16::to_be_bytes), ":1: not a text file"),
        ("PNG", b"\x89PNG\r\n\x1A\n\0\0\0\rIHDR".to_vec(), ":3: not a text file"),
        ("a megabyte of zeros", vec![0; 1 << 20], ":1: not a text file"),
        (
            "a program",
            fs::read(env!("CARGO_BIN_EXE_mode13h")).expect("a program")[..65_536].to_vec(),
            "not a text file",
        ),
    ];
    let mut tried = Tried::new("f1_what_is_no_model_at_all_is_refused", 11);
    for (what, bytes, message) in cases {
        let error = parse(bytes).expect_err(what).to_string();
        assert!(error.starts_with("model.obj") && error.ends_with(message), "{what}: {error}");
        tried.add(1);
    }
}

/// Files that name what is no file: folders, devices that never end, the model itself.
#[test]
fn f1_libraries_that_are_no_libraries_are_a_warning() {
    let folder = Folder::new();
    let path = folder.path("model.obj");
    fs::create_dir(folder.path("folder.mtl")).expect("made");
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

/// However many lines give cause for a warning.
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

fn face_of(corners: &[(f32, f32)]) -> String {
    let mut text: String = corners.iter().fold(String::new(), |text, (x, y)| text + &format!("v {x} {y} 0\n"));
    text.push('f');
    (1..=corners.len()).for_each(|i| write!(text, " {i}").expect("a string takes all"));
    text
}

fn circle(corners: usize, radius: impl Fn(usize) -> f32) -> Vec<(f32, f32)> {
    let angle = |i: usize| std::f64::consts::TAU * i as f64 / corners as f64;
    (0..corners).map(|i| (angle(i).cos() as f32 * radius(i), angle(i).sin() as f32 * radius(i))).collect()
}

/// Large but well-formed files load, up to documented limits.
#[test]
fn f1_large_faces_and_long_lines() {
    let mut tried = Tried::new("f1_large_faces_and_long_lines", 11);
    let mut loads = |text: &str, triangles: usize| {
        assert_eq!(parse(text).unwrap_or_else(|error| panic!("{error}")).mesh.triangles().len(), triangles);
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
    // Convex: any number of corners, also where rounding has dented them.
    loads(&face_of(&circle(100_000, |_| 1.0)), 99_998);
    let side = 25_000_i16;
    let mut square: Vec<(f32, f32)> = (0..side).map(|i| (f32::from(i), 0.0)).collect();
    square.extend((0..side).map(|i| (f32::from(side), f32::from(i))));
    square.extend((1..=side).rev().map(|i| (f32::from(i), f32::from(side))));
    square.extend((1..=side).rev().map(|i| (0.0, f32::from(i))));
    loads(&face_of(&square), 99_998);
    // All in one point, or all on a line.
    loads(&format!("{plain}f{}", " 1".repeat(1_000_000)), 999_999);
    // Concave: up to 20,000.
    loads(&face_of(&circle(10_000, |i| if i % 2 == 0 { 1.0 } else { 0.5 })), 9_998);
    loads(&face_of(&circle(20_000, |i| if i % 2 == 0 { 1.0 } else { 0.5 })), 19_998);
    let text = face_of(&circle(20_001, |i| if i % 2 == 0 { 1.0 } else { 0.5 }));
    let error = parse(text).expect_err("too many").to_string();
    assert_eq!(error, "model.obj:20002: a concave face of more than 20,000 corners");
}

/// How long this thread has been at work. On Linux the processor's time, which others cannot add to; it is counted in
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

/// A file eight times as long takes about eight times as long to read, and no more than twelve times, but where the reason
/// is known; three attempts, as the machine may be busy.
#[test]
#[ignore = "the long run: it measures time"]
fn f1_long_time_grows_as_the_file_does() {
    type Make = fn(usize) -> (String, String);
    let cases: [(&str, Make); 19] = [
        ("backslashes", |n| ("\\\n".repeat(n), String::new())),
        ("blank lines joined", |n| (" \t\\\r\n".repeat(n), String::new())),
        ("carriage returns", |n| ("\r".repeat(n) + TRIANGLE, String::new())),
        ("joined lines of a face", |n| (format!("{TRIANGLE}f{}", " 1 2 3 \\\n".repeat(n)), String::new())),
        ("a triangle gone round many times", |n| {
            // Up to the most corners that a concave face may have: four times as many.
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
        ("corners of many triples", |n| {
            let list = (1..=n / 2).fold(TRIANGLE.to_string(), |t, i| t + &format!("vt {i} 0\nvn 0 {i} 1\n"));
            ((1..=n / 2).fold(list, |t, i| t + &format!("f 1/{i}/{i} 2/{i}/{i} 3/{i}/{i}\n")), String::new())
        }),
    ];
    let mut tried = Tried::new("f1_long_time_grows_as_the_file_does", 19);
    for (what, make) in cases {
        let [(short, short_library), (long, long_library)] = [make(5_000), make(40_000)];
        let ratio = || time_to_parse(&long, &long_library) / time_to_parse(&short, &short_library);
        // A name is hashed, kept twice and copied into a surface of its own: of 5,000 all that lies in the caches, of 40,000 it
        // does not. The time of a name grows by a tenth for each doubling, from 2,500 to 60,000, and not in proportion.
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

// F2

/// A grid of at least this many triangles; if `full`, with texture coordinates and normals. Returns how many.
fn write_grid(path: &Path, faces: usize, full: bool) -> io::Result<usize> {
    let side = (1..).find(|side| side * side * 2 >= faces).unwrap_or(1);
    let mut out = BufWriter::with_capacity(1 << 20, File::create(path)?);
    for y in 0..=side {
        for x in 0..=side {
            writeln!(out, "v {x} {y} {}", (x * y) % 7)?;
            if full {
                writeln!(out, "vt {x} {y}\nvn {} {} 9", x % 3, y % 5)?;
            }
        }
    }
    for y in 0..side {
        for x in 0..side {
            let a = y * (side + 1) + x + 1;
            let (b, c, d) = (a + 1, a + side + 1, a + side + 2);
            match full {
                true => writeln!(out, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}\nf {b}/{b}/{b} {d}/{d}/{d} {c}/{c}/{c}")?,
                false => writeln!(out, "f {a} {b} {c}\nf {b} {d} {c}")?,
            }
        }
    }
    out.flush()?;
    Ok(side * side * 2)
}

/// Bytes, the most that this process has had in memory so far.
#[cfg(target_os = "linux")]
fn peak_memory() -> u64 {
    let status = fs::read_to_string("/proc/self/status").expect("Linux has it");
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).expect("a line");
    line.trim().strip_suffix(" kB").expect("in kB").parse::<u64>().expect("a number") * 1024
}

/// Names the file to a child of this test program, which loads it and says what that took.
const CHILD: &str = "MODE13H_F2_FILE";

/// What a face of a large model may take while it is loaded, at most, all vertices and lists included. A grid has half
/// as many vertices as faces. At the peak, when normals are averaged, that is (bytes, times how many for each face):
/// positions, normals, places of points and normals known (12 + 12 + 4 + 16) × ½, triangle 12, surface 2, its normal
/// and area 32, the class of each corner 4 × 3, sums and means (32 + 16) × ½, the normal of each corner 16 × 3: 152.
/// Vectors that were grown hold up to as much again of the lists that come from the file, which are 12 × 3 + 4 for a
/// face, and 12 × ½ for its vertices: 46.
#[cfg(target_os = "linux")]
const BYTES_PER_FACE: u64 = 200;

/// Loads a grid in a process of its own: memory is in proportion to its faces, and progress is shown.
#[cfg(target_os = "linux")]
fn load_in_a_child(test: &str, faces: usize, full: bool) {
    if let Some(path) = std::env::var_os(CHILD) {
        return load_as_a_child(Path::new(&path));
    }
    let mut tried = Tried::new(test, faces as u64);
    let folder = Folder::new();
    let path = folder.path("grid.obj");
    let faces = write_grid(&path, faces, full).expect("written");
    let output = Command::new(std::env::current_exe().expect("this program"))
        .args([&format!("files::{test}"), "--exact", "--include-ignored", "--nocapture"])
        .env(CHILD, &path)
        .output()
        .expect("started");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    let figures = said.lines().find_map(|line| line.split_once("loaded ")).expect("what it took").1;
    let figures: Vec<u64> = figures.split(' ').map(|figure| figure.parse().expect("a number")).collect();
    assert_eq!(figures[0], faces as u64);
    let (per_face, length) = (figures[1] / figures[0], fs::metadata(&path).expect("a file").len());
    println!("{test}: {faces} faces, {length} bytes, {per_face} bytes of memory a face, {} ms", figures[2]);
    tried.worst("bytes of memory for a face", per_face as f64);
    assert!(per_face <= BYTES_PER_FACE, "{per_face} bytes a face");
    tried.add(faces as u64);
}

#[cfg(target_os = "linux")]
fn load_as_a_child(path: &Path) {
    // The code that loads is in memory from here on.
    let warm = model_file::load(crate::support::workspace::root().join("tests/data/house.obj"));
    assert!(warm.is_ok(), "{warm:?}");
    let before = peak_memory();
    let begun = Instant::now();
    let length = fs::metadata(path).expect("a file").len();
    let mut told = vec![0];
    let loaded = model_file::load_with(path, &Options::default(), |read, total| {
        assert_eq!(total, length);
        told.push(read);
    });
    let mesh = loaded.expect("a model").mesh;
    assert!(told.is_sorted(), "progress goes forward");
    assert_eq!(told.last(), Some(&length), "to the end");
    let longest = told.windows(2).map(|pair| pair[1] - pair[0]).max();
    assert!(longest <= Some(1 << 16), "in small steps: {longest:?}");
    println!("loaded {} {} {}", mesh.triangles().len(), peak_memory() - before, begun.elapsed().as_millis());
}

#[cfg(target_os = "linux")]
#[test]
fn f2_a_hundred_thousand_faces() {
    load_in_a_child("f2_a_hundred_thousand_faces", 100_000, false);
}

#[cfg(target_os = "linux")]
#[test]
fn f2_a_hundred_thousand_faces_with_everything() {
    load_in_a_child("f2_a_hundred_thousand_faces_with_everything", 100_000, true);
}

#[cfg(target_os = "linux")]
#[test]
#[ignore = "a file of 350 MB, 2 GB of memory: cargo test --release --test cli f2_long -- --ignored"]
fn f2_long_ten_million_faces() {
    load_in_a_child("f2_long_ten_million_faces", 10_000_000, false);
}

/// A bar where a person sees it, and nothing where none does. The terminal is made by `script`, of util-linux.
#[cfg(target_os = "linux")]
#[test]
#[ignore = "a file of 60 MB: cargo test --release --test cli f2_long -- --ignored"]
fn f2_long_progress_is_shown_on_a_terminal() {
    let mut tried = Tried::new("f2_long_progress_is_shown_on_a_terminal", 2);
    let folder = Folder::new();
    write_grid(&folder.path("grid.obj"), 2_000_000, false).expect("written");
    let words = "render grid.obj -o x.png";
    folder.succeed(words);
    tried.add(1);

    let line = format!("{} {}", env!("CARGO_BIN_EXE_mode13h"), words);
    let shown = Command::new("script")
        .args(["-qec", &line, "/dev/null"])
        .current_dir(&folder)
        .env("TERM", "xterm")
        .stdin(Stdio::null())
        .output()
        .expect("util-linux is there");
    let said = String::from_utf8_lossy(&shown.stdout);
    assert!(shown.status.success() && said.contains(" read") && said.contains("MiB"), "{said:?}");
    // That takes longer than the reading.
    assert!(said.contains("making the mesh"), "{said:?}");
    tried.add(1);
}

// F4

const OLD: &[u8] = b"what stood there before";

/// The commands that write one file, with its name and how many bytes it has at the least.
const WRITERS: [(&str, &str); 5] = [
    ("render torus -o x.png", "x.png"),
    ("render cube -o x.png --rgb --scale 1", "x.png"),
    ("palette bios -o x.pal", "x.pal"),
    ("palette bios -o x.act", "x.act"),
    ("palette bios -o x.png", "x.png"),
];

/// The disk is full at any block of the file: the system limits files to a number of blocks of 512 bytes.
#[cfg(target_os = "linux")]
#[test]
fn f4_no_room_at_any_block() {
    let mut tried = Tried::new("f4_no_room_at_any_block", 20);
    for (words, name) in WRITERS {
        let folder = Folder::new();
        let path = folder.path(name);
        assert!(folder.program(words).status().expect("started").success());
        let new = fs::read(&path).expect("written");
        let blocks = new.len().div_ceil(512);
        // Every block of a short file; of a long one some, and the last ones.
        let step = blocks / 12 + 1;
        for limit in (0..=blocks).filter(|limit| limit % step == 0 || limit + 2 > blocks) {
            fs::write(&path, OLD).expect("written");
            let output = folder.run_with_room(limit, words);
            let stands = fs::read(&path).expect("something stands there");
            if limit < blocks {
                failed(&output, 3, name);
                assert!(stands == OLD, "{words:?}, {limit} of {blocks} blocks");
            } else {
                assert!(output.status.success() && stands == new, "{words:?}, {limit} of {blocks} blocks: {output:?}");
            }
            assert_eq!(folder.names(), [name], "nothing is left beside it");
            tried.add(1);
        }
    }
}

/// A device that is always full, behind the name.
#[cfg(target_os = "linux")]
#[test]
fn f4_a_full_device() {
    let mut tried = Tried::new("f4_a_full_device", 5);
    for (words, name) in WRITERS {
        let folder = Folder::new();
        let path = folder.path(name);
        std::os::unix::fs::symlink("/dev/full", &path).expect("linked");
        folder.fails(words, 3, &format!("{name}: the disk is full\n"));
        assert_eq!(fs::read_link(&path).expect("a link still"), Path::new("/dev/full"));
        tried.add(1);
    }
}

/// No right to write: a folder that only its owner may write in, and a file in it that all may read. Tests that run as
/// root, whom no rights hold back, run the program as nobody (65534).
#[cfg(target_os = "linux")]
#[test]
fn f4_no_right_to_write() {
    use std::os::unix::fs::{MetadataExt, PermissionsExt};
    use std::os::unix::process::CommandExt;
    let mut tried = Tried::new("f4_no_right_to_write", 15);
    for (words, name) in WRITERS {
        for (folder_mode, file_mode, stands) in [(0o555, 0o666, true), (0o555, 0o444, true), (0o555, 0, false)] {
            let folder = Folder::new();
            let place = folder.path("place");
            fs::create_dir(&place).expect("made");
            // Nobody must be able to reach and run it. Copied by another program: a copy that was open for writing here
            // while another test started a process could not be run as long as that process holds on to it.
            let copy = folder.path("mode13h");
            let copied = Command::new("cp").arg(env!("CARGO_BIN_EXE_mode13h")).arg(&copy).status();
            assert!(copied.expect("started").success());
            let set =
                |path: &Path, mode: u32| fs::set_permissions(path, fs::Permissions::from_mode(mode)).expect("set");
            set(folder.as_ref(), 0o755);
            set(&copy, 0o755);
            if stands {
                fs::write(place.join(name), OLD).expect("written");
                set(&place.join(name), file_mode);
            }
            set(&place, folder_mode);
            let mut command = Command::new(&copy);
            command.args(words.split(' ')).current_dir(&place);
            if fs::metadata("/proc/self").expect("Linux has it").uid() == 0 {
                command.uid(65_534).gid(65_534);
            }
            failed(&command.output().expect("started"), 3, &format!("{name}: no permission to write there\n"));
            // So that it can be removed.
            set(&place, 0o755);
            match stands {
                true => assert_eq!(
                    (names_in(&place), fs::read(place.join(name)).expect("read")),
                    (vec![name.into()], OLD.into())
                ),
                false => assert!(names_in(&place).is_empty()),
            }
            tried.add(1);
        }
    }
}

#[test]
fn f4_a_folder_that_is_not_there() {
    let mut tried = Tried::new("f4_a_folder_that_is_not_there", 10);
    for (words, name) in WRITERS {
        let folder = Folder::new();
        folder.put("file", OLD);
        for (directory, says) in [("none", "the directory none does not exist"), ("file", "file is not a directory")] {
            let path = format!("{directory}/{name}");
            let words = words.replace(name, &path);
            folder.fails(&words, 3, &format!("{path}: {says}\n"));
            assert_eq!(folder.names(), ["file"]);
            assert_eq!(folder.read("file"), OLD);
            tried.add(1);
        }
    }
}

/// Killed, without a chance to put things right, while the file is being written: what stood there before is whole.
/// (The unfinished file is left beside it, under a name that begins with `.mode13h-`.)
#[cfg(target_os = "linux")]
#[test]
fn f4_killed_half_way() {
    let mut tried = Tried::new("f4_killed_half_way", 8);
    let folder = Folder::new();
    let path = folder.path("x.png");
    let unfinished = || -> Vec<PathBuf> {
        let names = folder.names().into_iter().filter(|name| name != "x.png");
        names.inspect(|name| assert!(name.starts_with(".mode13h-"), "{name}")).map(|name| folder.path(name)).collect()
    };
    for after in [0_u64, 1, 4_096, 8_192, 20_000, 40_000, 60_000, 100_000] {
        fs::write(&path, OLD).expect("written");
        // Two seconds of writing, row by row.
        let mut command = folder.program("render torus -o x.png --scale 16384x16384");
        let mut child = command.stderr(Stdio::null()).spawn().expect("started");
        let length = || unfinished().iter().filter_map(|path| fs::metadata(path).ok()).map(|file| file.len()).max();
        while length().is_none_or(|length| length < after) {
            assert!(child.try_wait().expect("waited").is_none(), "ended before {after} bytes were seen");
        }
        child.kill().expect("killed");
        child.wait().expect("waited");
        assert_eq!(fs::read(&path).expect("read"), OLD, "killed after {after} bytes");
        unfinished().iter().for_each(|path| fs::remove_file(path).expect("removed"));
        tried.add(1);
    }
}

/// A row of pictures that no longer fits ends with an error; every picture under its name is whole.
#[cfg(target_os = "linux")]
#[test]
fn f4_a_row_of_pictures_that_cannot_be_written() {
    let mut tried = Tried::new("f4_a_row_of_pictures_that_cannot_be_written", 2);
    for (threads, written) in [("1", "x0.png to x3.png\n"), ("4", "x0.png")] {
        let folder = Folder::new();
        // The fifth name is taken by a folder.
        fs::create_dir(folder.path("x4.png")).expect("made");
        let says = format!("x4.png: is a directory; written before that: {written}");
        folder.fails(&format!("render torus -o x%d.png --frames 9 --threads {threads}"), 3, &says);
        for name in folder.names().into_iter().filter(|name| name != "x4.png") {
            let bytes = folder.read(&name);
            assert_eq!(&bytes[bytes.len() - 8..][..4], b"IEND", "{name} is not whole");
        }
        tried.add(1);
    }
}

// P5

/// Nothing is half-loaded: a palette file that breaks off anywhere either is a palette file still, or an error that
/// names the file and the place, and no file is written.
#[test]
fn p5_broken_palettes_change_nothing() {
    let mut tried = Tried::new("p5_broken_palettes_change_nothing", 30);
    let folder = Folder::new();
    let picture = folder.path("x.png");
    fs::write(&picture, OLD).expect("written");
    let bios = mode13h::palette::BIOS;
    for format in &FORMATS {
        let name = format!("a.{}", format.extensions[0]);
        let whole = format.write(&bios, "bios");
        let middle = whole.len() / 2;
        let changed = |at: usize, byte: u8| {
            let mut bytes = whole.clone();
            bytes[at] = byte;
            bytes
        };
        let longer = [&whole[..], &whole[..]].concat();
        for (bytes, text_only) in [
            (whole[..0].to_vec(), false),
            (whole[..1].to_vec(), false),
            (whole[..middle - 1].to_vec(), false),
            (longer, false),
            (changed(0, b'!'), true),
            (changed(middle, b'!'), true),
        ] {
            let is_text = matches!(format.name, "jasc" | "gimp" | "hex");
            // A GIMP or Lospec file may have any number of colours, and a number in it may lose its end; in the name
            // of a colour stands what may.
            let read = mode13h_assets::palette_file::parse_named(&name, &bytes);
            assert!(read.is_err() || text_only || is_text, "{name}");
            if read.is_ok() {
                continue;
            }
            folder.put(&name, &bytes);
            for words in [format!("render cube -o x.png --palette {name}"), format!("palette {name} -o x.png")] {
                let said = folder.fails(&words, 2, "");
                let place = said.contains(&format!("{name}: line ")) || said.contains(&format!("{name}: offset "));
                assert!(place, "{said}");
                assert_eq!(fs::read(&picture).expect("read"), OLD);
                tried.add(1);
            }
            fs::remove_file(folder.path(&name)).expect("removed");
        }
    }
    assert_eq!(folder.names(), ["x.png"]);
}
