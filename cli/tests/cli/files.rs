//! Files that are broken, huge, or cannot be written: hard cases F2, F4, and P5 through the program.
#![cfg_attr(not(target_os = "linux"), expect(dead_code, unused_imports, reason = "much is tried on Linux alone"))]

use std::fs::{self, File};
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use mode13h_assets::model_file::{self, Options};
use mode13h_assets::palette_file::FORMATS;

use crate::folder::{Folder, failed, names_in};
use crate::support::tried::Tried;

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

/// The peak memory of this process so far, in bytes.
#[cfg(target_os = "linux")]
fn peak_memory() -> u64 {
    let status = fs::read_to_string("/proc/self/status").expect("Linux has it");
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).expect("a line");
    line.trim().strip_suffix(" kB").expect("in kB").parse::<u64>().expect("a number") * 1024
}

/// Passes the file's name to a child of this test program, which loads it and reports the memory that this took.
const CHILD: &str = "MODE13H_F2_FILE";

/// The most bytes per face that loading a large model may take, with all vertices and lists included. A grid has half
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
    // Loads a small model first, so that the loading code is already in memory.
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

/// A progress bar is shown in a terminal, and nothing elsewhere. The terminal is made by `script`, of util-linux.
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
    // Making the mesh takes longer than reading the file.
    assert!(said.contains("making the mesh"), "{said:?}");
    tried.add(1);
}

// F4

const OLD: &[u8] = b"what stood there before";

/// The commands that write one file, with its name.
const WRITERS: [(&str, &str); 6] = [
    ("render torus -o x.png", "x.png"),
    ("render cube -o x.png --rgb --scale 1", "x.png"),
    ("render torus -o x.gif --frames 9", "x.gif"),
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
        // Every block of a short file; some blocks of a long one, and the last ones.
        let step = blocks / 12 + 1;
        for limit in (0..=blocks).filter(|limit| limit % step == 0 || limit + 2 > blocks) {
            fs::write(&path, OLD).expect("written");
            let output = folder.run_with_room(limit, words);
            let stands = fs::read(&path).expect("something stands there");
            if limit < blocks {
                failed(&output, 1, name);
                assert!(stands == OLD, "{words:?}, {limit} of {blocks} blocks");
            } else {
                assert!(output.status.success() && stands == new, "{words:?}, {limit} of {blocks} blocks: {output:?}");
            }
            assert_eq!(folder.names(), [name], "nothing is left beside it");
            tried.add(1);
        }
    }
}

/// The name is a link to a device that is always full.
#[cfg(target_os = "linux")]
#[test]
fn f4_a_full_device() {
    let mut tried = Tried::new("f4_a_full_device", 5);
    for (words, name) in WRITERS {
        let folder = Folder::new();
        let path = folder.path(name);
        std::os::unix::fs::symlink("/dev/full", &path).expect("linked");
        folder.fails(words, 1, &format!("{name}: the disk is full\n"));
        assert_eq!(fs::read_link(&path).expect("a link still"), Path::new("/dev/full"));
        tried.add(1);
    }
}

/// No permission to write: a folder that only its owner may write to, and a file in it that everyone may read. Tests
/// that run as root, whom permissions do not stop, run the program as nobody (65534).
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
            // The user nobody must be able to reach and run it. Another program makes the copy: if it were open for
            // writing here while another test starts a process, it could not be run as long as that process keeps it
            // open.
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
            failed(&command.output().expect("started"), 1, &format!("{name}: no permission to write there\n"));
            // Restored so that the folder can be removed.
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
            folder.fails(&words, 1, &format!("{path}: {says}\n"));
            assert_eq!(folder.names(), ["file"]);
            assert_eq!(folder.read("file"), OLD);
            tried.add(1);
        }
    }
}

/// Killed without a chance to clean up while a file is being written: the previous file stays whole. (The unfinished
/// file is left beside it, under a name that begins with `.mode13h-`.)
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

/// A series of pictures that no longer fits ends with an error; every picture under its final name is whole.
#[cfg(target_os = "linux")]
#[test]
fn f4_a_row_of_pictures_that_cannot_be_written() {
    let mut tried = Tried::new("f4_a_row_of_pictures_that_cannot_be_written", 2);
    for (threads, written) in [("1", "x0.png to x3.png\n"), ("4", "x0.png")] {
        let folder = Folder::new();
        // The fifth name is taken by a folder.
        fs::create_dir(folder.path("x4.png")).expect("made");
        let says = format!("x4.png: is a directory; written before that: {written}");
        folder.fails(&format!("render torus -o x%d.png --frames 9 --threads {threads}"), 1, &says);
        for name in folder.names().into_iter().filter(|name| name != "x4.png") {
            let bytes = folder.read(&name);
            assert_eq!(&bytes[bytes.len() - 8..][..4], b"IEND", "{name} is not whole");
        }
        tried.add(1);
    }
}

// P5

/// Nothing is half-loaded: a palette file truncated anywhere is either still a palette file, or gives an error with the
/// file and the position, and no file is written.
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
            // A GIMP or Lospec file may have any number of colours, and a truncated number in it may still be a number;
            // the name of a colour may be anything.
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
