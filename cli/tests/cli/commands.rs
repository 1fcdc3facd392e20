//! The program as its user meets it: what it writes, what it says, and how it ends.

mod documents;

use std::ffi::OsStr;
use std::fs;
use std::io::Cursor;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use mode13h::palette::{Rgb, builtin};
use mode13h::plan::Effect;
use mode13h::render::Renderer;
use mode13h::span::Kernel;
use mode13h::vga::Vga;
use mode13h_assets::palette_file;
use mode13h_assets::shipped;
use serde_json::Value;
use tempfile::TempDir;

use crate::support::film::{Decoded, decode};
use crate::support::tried::Tried;

/// The program in a directory, with no display and no preferences from the environment.
fn program(directory: &TempDir) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mode13h"));
    command.current_dir(directory).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("MODE13H_KERNEL");
    command
}

fn run<Word: AsRef<OsStr>>(directory: &TempDir, words: &[Word]) -> Output {
    program(directory).args(words).output().expect("started")
}

/// As [`run`], for what has to succeed in silence.
#[track_caller]
fn succeed(directory: &TempDir, words: &[&str]) {
    let output = run(directory, words);
    assert!(output.status.success() && output.stderr.is_empty() && output.stdout.is_empty(), "{words:?}: {output:?}");
}

/// That it failed with this status, said one line that holds `says`, and wrote nothing.
#[track_caller]
fn assert_fails(output: &Output, status: i32, says: &str) {
    let line = String::from_utf8(output.stderr.clone()).expect("text");
    assert_eq!(output.status.code(), Some(status), "{line}");
    assert!(line.starts_with("mode13h: ") && line.contains(says), "{line}\nhas not: {says}");
    assert_eq!(line.find('\n'), Some(line.len() - 1), "more than one line: {line}");
    assert!(output.stdout.is_empty(), "{output:?}");
}

fn directory() -> TempDir {
    tempfile::tempdir().expect("a directory")
}

fn names_in(directory: &Path) -> Vec<String> {
    let entries = fs::read_dir(directory).expect("a directory");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

fn read(directory: &TempDir, name: &str) -> Vec<u8> {
    fs::read(directory.path().join(name)).expect(name)
}

/// Size, colour type and pixel density of a PNG.
fn png_header(bytes: &[u8]) -> ((u32, u32), png::ColorType, Option<(u32, u32)>) {
    let reader = png::Decoder::new(Cursor::new(bytes)).read_info().expect("a PNG");
    let info = reader.info();
    ((info.width, info.height), info.color_type, info.pixel_dims.map(|dims| (dims.xppu, dims.yppu)))
}

#[test]
fn f1_broken_input_is_one_line_with_file_and_place() {
    let mut tried = Tried::new("f1_broken_input_is_one_line_with_file_and_place", 22);
    let directory = directory();
    let put = |name: &str, text: &[u8]| fs::write(directory.path().join(name), text).expect("written");
    put("empty.obj", b"");
    put("vertices.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    put("nan.obj", b"v 0 0 0\nv 1 NaN 0\nv 0 1 0\nf 1 2 3\n");
    put("index.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1 2 4\n");
    put("zero.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n");
    put("binary.obj", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x01");
    put("model.3ds", b"solid\n");
    put("broken.pal", b"JASC-PAL\r\n0100\r\n2\r\n0 0 0\r\nred 0 0\r\n");
    put("short.vga", &[0; 767]);
    put("empty.gpl", b"");
    fs::create_dir(directory.path().join("directory.obj")).expect("made");
    let before = names_in(directory.path());

    let model = |input| vec!["render", input, "-o", "x.png"];
    let palette = |palette| vec!["render", "cube", "-o", "x.png", "--palette", palette];
    for (words, status, says) in [
        (model("none.obj"), 3, "none.obj: No such file"),
        (model("directory.obj"), 3, "directory.obj: is a directory"),
        (model("."), 3, ".: is a directory"),
        (model("empty.obj"), 2, "empty.obj: no faces"),
        (model("vertices.obj"), 2, "vertices.obj: no faces"),
        (model("nan.obj"), 2, "nan.obj:2: `NaN`"),
        (model("index.obj"), 2, "index.obj:5: there is no vertex 4"),
        (model("zero.obj"), 2, "zero.obj:4: index 0"),
        (model("binary.obj"), 2, "binary.obj"),
        (
            model("model.3ds"),
            2,
            "model.3ds: unknown kind of file: models are .obj, .stl, .ply, .gltf and .glb files, scenes .toml",
        ),
        (model("toroid"), 2, "toroid: no such file, scene or shape (mode13h list scenes shows the names)"),
        (model(""), 2, "mode13h: '': empty value (mode13h render --help"),
        (palette(""), 2, "mode13h: --palette '': empty value"),
        (vec![""], 2, "mode13h: '': empty value"),
        (vec!["scenes", "copy", ""], 2, "mode13h: '': empty value"),
        (vec!["render", "torus", "--palette="], 2, "mode13h: --palette=: empty value"),
        (palette("broken.pal"), 2, "broken.pal: line 5"),
        (palette("short.vga"), 2, "short.vga: "),
        (palette("empty.gpl"), 2, "empty.gpl: "),
        (palette("none.pal"), 3, "none.pal: no such file or built-in palette; built-in palettes are grey"),
        (palette("."), 3, ".: is a directory"),
        (vec!["palette", "broken.pal"], 2, "broken.pal: line 5"),
        (vec!["palette", "mauve"], 2, "mauve: no such file or built-in palette; built-in palettes are grey"),
        (vec!["palette", "auto"], 2, "auto is a palette made for a model; mode13h palette --from MODEL"),
        (vec!["generate"], 2, "mode13h generate completions SHELL prints completions"),
        (vec!["scenes", "copy"], 2, "(mode13h scenes copy --help shows the options)"),
        (vec!["generate", "man", "-o", "nan.obj"], 3, "nan.obj: is not a directory"),
        (palette("coper"), 2, "coper: no such file or built-in palette; did you mean copper?"),
        (vec!["demo", "nan.obj"], 2, "nan.obj:2: "),
        (vec!["nan.obj"], 2, "nan.obj:2: "),
        (vec!["none.obj"], 3, "none.obj: No such file"),
        (vec!["plan", "nan.obj"], 2, "nan.obj:2: "),
    ] {
        assert_fails(&run(&directory, &words), status, says);
        tried.add(1);
    }
    assert_eq!(names_in(directory.path()), before);
    tried.add(1);
}

#[test]
fn wrong_words_end_with_2() {
    let directory = directory();
    for (words, says) in [
        (vec!["render"], "<INPUT>"),
        (vec!["render", "torus", "-o", "x.png", "--kernel", "mmx"], "no such kernel; this machine has portable"),
        (vec!["--kernel", "mmx"], "no such kernel; this machine has portable"),
        (
            vec!["render", "torus", "-o", "x.png", "--shading", "mirror"],
            "[possible values: flat, gouraud-vintage, gouraud-8.8, ",
        ),
        (vec!["render", "torus", "-o", "x.tif"], "x.tif: not a format that can be written"),
        (vec!["render", "torus", "-o", "x"], "x: "),
        (
            vec!["render", "torus", "-o", "a.mp4"],
            "a.mp4: animations are .gif or .apng; for others pipe the frames: `-o - | ffmpeg -i - -pix_fmt yuv420p a.mp4`",
        ),
        (vec!["render", "torus", "-o", "a.mp4", "--fps", "30"], "`-o - | ffmpeg -i - -pix_fmt yuv420p a.mp4`"),
        (vec!["render", "torus", "-o", "x.png", "--frames", "2"], "x.png: a series of pictures needs"),
        (vec!["render", "torus", "-o", "x%d.png", "--frames", "0"], "--frames"),
        (vec!["render", "torus", "-o", "x%d.png", "--threads", "0"], "--threads"),
        (vec!["render", "torus", "-o", "x.png", "--scale", "3"], "a scale is 1, 2, 5x6"),
        (vec!["render", "torus", "-o", "x.png", "--scale", "16385x1"], "a scale is 1, 2, 5x6"),
        (vec!["render", "torus", "-o", "x.png", "--turn", "NaN"], "--turn"),
        (vec!["render", "torus", "-o", "x.png", "--time", "inf"], "--time"),
        (vec!["render", "torus", "-o", "x.png", "--time", "soon"], "--time"),
        (vec!["render", "torus", "-o", "x.png", "--zoom", "0"], "not a number from 0.001 to 1000"),
        (vec!["render", "torus", "-o", "x.png", "--zoom", "nan"], "not a number from 0.001 to 1000"),
        (vec!["render", "torus", "-o", "x.png", "--zoom", "-1"], "'-1' for '--zoom <FACTOR>': not a number from"),
        (vec!["render", "torus", "-o", "x.png", "--max-error", "-1"], "'-1' for '--max-error <E>': not a"),
        (
            vec!["render", "torus", "-o", "x.png", "--frames", "-1"],
            "'-1' for '--frames <N>': not a whole number from 1 to 1000000 (mode13h render --help",
        ),
        (vec!["render", "torus", "--frames", "two"], "'two' for '--frames <N>': not a whole number (mode13h"),
        (vec!["explain", "torus", "--row", "-1"], "'-1' for '--row <Y>': not a whole number from 0 to 4294967295"),
        (vec!["verify", "--seed", "-1"], "'-1' for '--seed <N>': not a whole number of at least 0"),
        (vec!["render", "torus", "--zoom", "1", "--zoom", "2"], "'--zoom <FACTOR>' is given twice (mode13h render"),
        (vec!["explain", "torus", "--pixel", "-1,2"], "'-1,2' for '--pixel <X,Y>': not two whole numbers"),
        (vec!["render", "torus", "-o", "x.png", "--background", "#fff"], "#fff: a colour has six digits: '#ffffff'"),
        (vec!["render", "torus", "-o", "x.png", "--background", "#a0G"], "neither a colour such as '#203040'"),
        (vec!["render", "torus", "-o", "x.png", "--camera", "1,2"], "\"1,2\" is not a point: three numbers"),
        (vec!["render", "torus", "-o", "x.png", "--camera", "1,2,3:inf,0,0"], "\"inf,0,0\" is not a point"),
        (vec!["render", "torus", "-o", "x.png", "--camera", "-1,2,3:-1,2,3"], "EYE and TARGET are the same point"),
        (
            vec!["render", "torus", "-o", "x.png", "--background", "256"],
            "neither a colour such as '#203040' nor an entry",
        ),
        (vec!["render", "torus", "-o", "x.png", "--background", "#12345"], "neither a colour"),
        (vec!["render", "torus", "-o", "x.png", "--dither", "maybe"], "[possible values: ordered, blue-noise, ps1]"),
        (vec!["render", "-o", "x.png", "--dither", "torus"], "[possible values: ordered, blue-noise, ps1]"),
        (vec!["render", "torus", "--dither", "ordered", "--no-dither"], "cannot be used with"),
        (vec!["render", "torus", "--mipmaps", "--no-mipmaps"], "cannot be used with"),
        (vec!["render", "torus", "--size", "640"], "not a size such as 640x400, with sides from 1 to 4096"),
        (vec!["render", "torus", "--size", "0x9"], "not a size such as 640x400"),
        (vec!["render", "torus", "--size", "4097x9"], "not a size such as 640x400"),
        (vec!["render", "torus", "--size", "64x64", "--max-time", "9"], "cannot be used with"),
        (vec!["cost", "torus", "--open", "--json"], "cannot be used with"),
        (vec!["cost", "torus", "--quiet", "--json"], "cannot be used with"),
        (vec!["list"], "<WHAT>"),
        (vec!["list", "colours"], "[possible values: shadings, palettes, kernels, scenes]"),
        (vec!["palette"], "`mode13h list palettes` shows the built-in ones"),
        (vec!["scenes"], "`mode13h list scenes` lists the scenes"),
        (vec!["render", "torus", "-o", "x.png", "--fps", "0"], "--fps"),
        (vec!["render", "torus", "-o", "x.png", "--turn", "9", "--fps", "9"], "x.png: both --turn and --fps"),
        (vec!["render", "torus", "-o", "x.png", "--up", "x"], "--up"),
        (vec!["render", "torus", "-o", "x.gif", "--rgb"], "x.gif: --rgb is for .png"),
        (vec!["render", "torus", "-o", "x%04d.gif"], "x%04d.gif: an animation is one file"),
        (
            vec!["render", "torus", "-o", "x.gif", "--fps", "60"],
            "x.gif: an animation shows 0.1 to 50 frames a second, not 60",
        ),
        (
            vec!["render", "torus", "-o", "x.gif", "--fps", "0.05"],
            "x.gif: an animation shows 0.1 to 50 frames a second",
        ),
        (vec!["render", "torus", "-o", "x.gif", "--frames", "0"], "--frames"),
        (vec!["render", "torus", "-o", "x%d-%04d.png"], "x%d-%04d.png: a name can hold one number"),
        (vec!["render", "torus", "-o", "x%d%d.png", "--frames", "2"], "x%d%d.png: a name can hold one number"),
        (vec!["render", "torus", "-o", "x.apng", "--rgb"], "x.apng: --rgb is for .png"),
        (vec!["render", "torus", "-o", "x%d.apng"], "x%d.apng: an animation is one file"),
        (vec!["render", "torus", "-o", "-", "--fps", "60"], "-: an animation shows 0.1 to 50 frames a second, not 60"),
        (vec!["palette", "grey", "-o", "x.txt"], "x.txt: "),
        (vec!["render", "torus", "-o", "x.png", "--up", "z"], "--up is for models"),
        (vec!["render", "torus", "-o", "x.png", "--crease", "30"], "--crease is for models"),
        (vec!["plan", "sphere", "--crease", "181"], "--crease"),
        (vec!["cost", "sphere", "--crease", "NaN"], "--crease"),
        (vec!["explain", "sphere", "--row", "9", "--crease", "-1"], "--crease"),
        (
            vec!["render", "torus", "-o", "x.png", "--mapping", "best"],
            "[possible values: affine, every-16, perspective]",
        ),
        (vec!["render", "torus", "-o", "x.png", "--arithmetic", "best"], "[possible values: float, fixed]"),
        (vec!["demo", "torus", "--hidden-surfaces", "best"], "[possible values: back-faces, painter, "),
        (vec!["scenes", "copy", "-o", "x.toml"], "<NAME>"),
        (vec!["verify", "--xml"], "(mode13h verify --help shows"),
        (vec!["render", "--xml"], "(mode13h render --help shows"),
        (vec!["--xml"], "(mode13h --help shows"),
        (vec!["torus", "--xml"], "(mode13h --help shows"),
        (vec!["torus", "verify"], "verify is a command and goes before INPUT"),
        (vec!["plan"], "<INPUT>"),
        (vec!["plan", "torus", "--time", "inf"], "--time takes a number of SECONDS; --measure"),
        (vec!["plan", "torus", "--time"], "--time takes a number of SECONDS; --measure"),
        (vec!["demo", "torus", "--time", "soon"], "--time"),
        (vec!["plan", "torus", "--shading", "mirror"], "[possible values: flat, gouraud-vintage, gouraud-8.8, "),
    ] {
        assert_fails(&run(&directory, &words), 2, says);
    }
    let output = program(&directory)
        .args(["render", "torus", "-o", "x.png"])
        .env("MODE13H_KERNEL", "mmx")
        .output()
        .expect("started");
    assert_fails(&output, 2, "MODE13H_KERNEL=mmx: no such kernel; this machine has portable");
    assert!(names_in(directory.path()).is_empty());
}

#[test]
fn f4_what_cannot_be_written_is_one_line_and_leaves_nothing_behind() {
    let mut tried = Tried::new("f4_what_cannot_be_written_is_one_line_and_leaves_nothing_behind", 8);
    let directory = directory();
    fs::create_dir(directory.path().join("x.png")).expect("made");
    for (out, says) in [
        ("none/x.png", "none/x.png: the directory none does not exist"),
        ("none/%04d.png", "none/0000.png: the directory none does not exist"),
        ("x.png", "x.png: is a directory"),
    ] {
        assert_fails(&run(&directory, &["render", "torus", "-o", out]), 3, says);
        tried.add(1);
    }
    assert_fails(
        &run(&directory, &["render", "torus", "-o", "none/%d.png", "--frames", "9"]),
        3,
        "none does not exist",
    );
    tried.add(1);
    assert_fails(
        &run(&directory, &["render", "torus", "-o", "none/x.gif"]),
        3,
        "none/x.gif: the directory none does not",
    );
    tried.add(1);
    assert_fails(&run(&directory, &["palette", "grey", "-o", "none/x.pal"]), 3, "none does not exist");
    tried.add(1);
    assert_eq!(names_in(directory.path()), ["x.png"]);
    tried.add(1);
    assert!(names_in(&directory.path().join("x.png")).is_empty());
    tried.add(1);
}

#[cfg(target_os = "linux")]
#[test]
fn f4_a_picture_that_no_longer_fits_leaves_the_old_one_whole() {
    let mut tried = Tried::new("f4_a_picture_that_no_longer_fits_leaves_the_old_one_whole", 3);
    let directory = directory();
    fs::write(directory.path().join("x.png"), "what stood there").expect("written");
    // Files may grow to one block, which the picture does not fit in.
    let output = Command::new("sh")
        .args(["-c", r#"ulimit -f 1; trap "" XFSZ; exec "$0" render torus -o x.png"#, env!("CARGO_BIN_EXE_mode13h")])
        .current_dir(&directory)
        .output()
        .expect("started");
    assert_fails(&output, 3, "x.png: ");
    tried.add(1);
    assert_eq!(read(&directory, "x.png"), b"what stood there");
    tried.add(1);
    assert_eq!(names_in(directory.path()), ["x.png"]);
    tried.add(1);
}

#[cfg(unix)]
#[test]
fn f4_an_interrupted_row_is_made_of_whole_pictures() {
    let mut tried = Tried::new("f4_an_interrupted_row_is_made_of_whole_pictures", 20);
    let directory = directory();
    let mut child = program(&directory)
        .args(["render", "torus", "-o", "%06d.png", "--frames", "100000", "--scale", "2"])
        .stderr(Stdio::piped())
        .spawn()
        .expect("started");
    while names_in(directory.path()).iter().filter(|name| !name.starts_with('.')).count() < 20 {
        assert!(child.try_wait().expect("waited").is_none(), "ended by itself");
        tried.add(1);
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("started");
    assert!(killed.success());
    tried.add(1);
    let output = child.wait_with_output().expect("waited");
    assert_fails(&output, 130, "interrupted");
    tried.add(1);
    for name in names_in(directory.path()) {
        assert!(name.ends_with(".png") && !name.starts_with('.'), "{name} is left");
        tried.add(1);
        let bytes = read(&directory, &name);
        assert_eq!(&bytes[bytes.len() - 8..][..4], b"IEND", "{name} is not whole");
        tried.add(1);
    }
}

#[test]
fn a_picture_is_indexed_320_by_200_with_the_shape_of_its_pixels() {
    let directory = directory();
    succeed(&directory, &["render", "torus", "-o", "x.png", "--palette", "copper"]);
    assert_eq!(names_in(directory.path()), ["x.png"]);
    let bytes = read(&directory, "x.png");
    assert_eq!(png_header(&bytes), ((320, 200), png::ColorType::Indexed, Some((6, 5))));

    let mut reader = png::Decoder::new(Cursor::new(&bytes)).read_info().expect("a PNG");
    let copper = builtin::by_name("copper").expect("a built-in").palette.on_dac();
    let expected: Vec<u8> = copper.colors().iter().flat_map(|c| [c.r, c.g, c.b]).collect();
    assert_eq!(reader.info().palette.as_deref(), Some(&expected[..]));
    let mut pixels = vec![0; 64_000];
    reader.next_frame(&mut pixels).expect("its pixels");
    let mut used = [false; 256];
    pixels.iter().for_each(|&index| used[usize::from(index)] = true);
    assert!(used.iter().filter(|&&used| used).count() > 60, "a smooth picture has many shades");
}

#[test]
fn pictures_are_enlarged_and_in_true_color_when_asked_for() {
    let directory = directory();
    let indexed = png::ColorType::Indexed;
    let rgb = png::ColorType::Rgb;
    for (words, expected) in [
        (vec!["--scale", "1"], ((320, 200), indexed, Some((6, 5)))),
        (vec!["--scale", "2"], ((640, 400), indexed, Some((6, 5)))),
        (vec!["--scale", "5x6"], ((1600, 1200), indexed, Some((1, 1)))),
        (vec!["--scale", "640x480"], ((640, 480), indexed, Some((1, 1)))),
        (vec!["--rgb"], ((1600, 1200), rgb, Some((1, 1)))),
        (vec!["--rgb", "--scale", "1"], ((320, 200), rgb, Some((6, 5)))),
    ] {
        succeed(&directory, &[&["render", "cube", "-o", "x.png"], &words[..]].concat());
        assert_eq!(png_header(&read(&directory, "x.png")), expected, "{words:?}");
    }
}

#[test]
fn every_kernel_gives_the_same_bytes_and_is_named() {
    let directory = directory();
    succeed(&directory, &["render", "torus", "-o", "default.png"]);
    let expected = read(&directory, "default.png");
    let mut tried = 0;
    for kernel in Kernel::available() {
        for by_environment in [false, true] {
            let mut command = program(&directory);
            command.args(["render", "torus", "-o", "x.png", "--stats"]);
            if by_environment {
                command.env("MODE13H_KERNEL", kernel.name());
            } else {
                // The option has the last word.
                command.args(["--kernel", kernel.name()]).env("MODE13H_KERNEL", "mmx");
            }
            let output = command.output().expect("started");
            assert!(output.status.success(), "{output:?}");
            let said = String::from_utf8(output.stderr).expect("text");
            assert!(said.contains(&format!("kernel {},", kernel.name())) && said.lines().count() == 1, "{said}");
            assert!(read(&directory, "x.png") == expected, "{} draws other bytes", kernel.name());
            tried += 1;
        }
    }
    assert!(tried >= 2);
}

#[test]
fn a_row_is_the_same_whatever_the_number_of_threads() {
    let names: Vec<String> = (0..8).map(|number| format!("x{number:04}.png")).collect();
    let rows: Vec<Vec<Vec<u8>>> = ["1", "2", "7"]
        .map(|threads| {
            let directory = directory();
            let words = ["render", "torus", "-o", "x%04d.png", "--frames", "8", "--turn", "360", "--threads", threads];
            succeed(&directory, &words);
            assert_eq!(names_in(directory.path()), names);
            names.iter().map(|name| read(&directory, name)).collect()
        })
        .into();
    assert!(rows.iter().all(|row| *row == rows[0]));
    for (i, frame) in rows[0].iter().enumerate() {
        assert!(rows[0][..i].iter().all(|earlier| earlier != frame), "frame {i} repeats an earlier one");
    }
}

#[test]
fn t1_a_frame_of_a_row_is_the_frame_drawn_alone() {
    let mut tried = Tried::new("t1_a_frame_of_a_row_is_the_frame_drawn_alone", 3);
    let directory = directory();
    succeed(&directory, &["render", "teapot", "-o", "turn%d.png", "--frames", "4", "--turn", "360"]);
    succeed(&directory, &["render", "teapot", "-o", "alone.png", "--turn", "90"]);
    assert_eq!(read(&directory, "turn1.png"), read(&directory, "alone.png"));
    tried.add(1);

    succeed(&directory, &["render", "teapot", "-o", "time%d.png", "--frames", "3", "--fps", "2", "--time", "7"]);
    succeed(&directory, &["render", "teapot", "-o", "alone.png", "--time", "8"]);
    assert_eq!(read(&directory, "time2.png"), read(&directory, "alone.png"));
    tried.add(1);
    assert_ne!(read(&directory, "time0.png"), read(&directory, "alone.png"));
    tried.add(1);
}

/// As [`succeed`], for a film: the line that was printed, and the film.
#[track_caller]
fn film(directory: &TempDir, words: &[&str]) -> (String, Decoded) {
    let output = run(directory, &[&["render"], words].concat());
    assert!(output.status.success() && output.stderr.is_empty(), "{words:?}: {output:?}");
    let line = String::from_utf8(output.stdout).expect("text");
    assert_eq!(line.find('\n'), Some(line.len() - 1), "more than one line: {line}");
    (line, decode(&read(directory, "x.gif")))
}

#[test]
fn a_film_is_one_turn_of_four_seconds_in_the_shape_of_the_screen() {
    let directory = directory();
    let (line, film) = film(&directory, &["cube", "-o", "x.gif"]);
    assert_eq!(names_in(directory.path()), ["x.gif"]);
    let bytes = read(&directory, "x.gif").len();
    let figures = "640 x 480 pixels, 140 frames, 4.00 s, delays 120 x 30 ms + 20 x 20 ms";
    assert_eq!(line, format!("x.gif: {figures}, {bytes} bytes\n"));
    assert_eq!((film.width, film.height, film.images.len()), (640, 480, 140));
    for (i, image) in film.images.iter().enumerate() {
        assert_eq!(image.delay, if i % 7 == 6 { 2 } else { 3 }, "image {i}");
    }
}

#[test]
fn a_film_is_as_long_fast_large_and_colorful_as_asked_for() {
    let directory = directory();
    for (words, size, frames, hundredths) in [
        (vec!["--fps", "10"], (640, 480), 40, 400),
        (vec!["--fps", "50", "--frames", "4"], (640, 480), 4, 8),
        (vec!["--frames", "3", "--scale", "1"], (320, 200), 3, 9),
        (vec!["--frames", "1", "--scale", "5x6"], (1600, 1200), 1, 3),
        (vec!["--frames", "5", "--scale", "33x44", "--palette", "copper"], (33, 44), 5, 15),
    ] {
        let (line, film) = film(&directory, &[&["sphere", "-o", "x.gif"], &words[..]].concat());
        assert_eq!((film.width, film.height, film.images.len()), (size.0, size.1, frames), "{words:?}");
        assert_eq!(film.images.iter().map(|image| image.delay).sum::<u64>(), hundredths, "{words:?}");
        // A shape without colours of its own is grey.
        let palette = if words.contains(&"copper") { "copper" } else { "grey" };
        let palette = builtin::by_name(palette).expect("a built-in").palette.on_dac();
        // Each colour once, and black where the length of the table, a power of two, leaves room.
        let all = palette.colors();
        let different: Vec<Rgb> = (0..256).filter(|&i| !all[..i].contains(&all[i])).map(|i| all[i]).collect();
        let (colors, rest) = film.palette.split_at(different.len());
        assert!(colors == different && rest.iter().all(|color| *color == Rgb::BLACK));
        let said = format!(": {} x {} pixels, {frames} frame", size.0, size.1);
        assert!(line.contains(&said), "{line}");
    }
    let (line, film) = film(&directory, &["teapot", "-o", "x.gif", "--turn", "0", "--fps", "20"]);
    assert!(line.contains("80 frames in 1 image, 4.00 s, delays 1 x 4000 ms,"), "{line}");
    assert_eq!((film.images.len(), film.images[0].delay), (1, 400));
}

#[test]
fn a_film_shows_the_frames_of_the_row_of_pictures() {
    let directory = directory();
    let colors = |name: &str| -> Vec<Rgb> {
        let mut reader = png::Decoder::new(Cursor::new(read(&directory, name))).read_info().expect("a PNG");
        let palette = reader.info().palette.as_deref().expect("a palette").to_vec();
        let mut pixels = vec![0; 333 * 222];
        reader.next_frame(&mut pixels).expect("its pixels");
        let color = |&index: &u8| {
            Rgb::new(
                palette[usize::from(index) * 3],
                palette[usize::from(index) * 3 + 1],
                palette[usize::from(index) * 3 + 2],
            )
        };
        pixels.iter().map(color).collect()
    };
    let look = ["--scale", "333x222", "--palette", "copper", "--frames", "9"];
    for (of_film, of_row) in [
        (vec![], vec!["--turn", "360"]),
        (vec!["--turn", "-40", "--time", "0.7"], vec!["--turn", "-40", "--time", "0.7"]),
        (vec!["--fps", "12"], vec!["--turn", "360"]),
    ] {
        succeed(&directory, &[&["render", "torus", "-o", "x%d.png"], &look[..], &of_row[..]].concat());
        let (_, film) = film(&directory, &[&["torus", "-o", "x.gif"], &look[..], &of_film[..]].concat());
        assert_eq!(film.images.len(), 9);
        for (i, image) in film.images.iter().enumerate() {
            assert!(image.shown == colors(&format!("x{i}.png")), "frame {i} of {of_film:?}");
        }
    }
}

/// Films of every shipped scene, with a budget besides, drawn by 1, 2, 3 and 7 threads: the same bytes. Among them are fog,
/// textures, and palettes that fade: what one thread has of a frame is in no other's.
#[test]
fn films_are_the_same_whatever_the_number_of_threads() {
    const FRAMES: &str = "9";
    let looks: Vec<(&str, &[&str])> = shipped::ALL
        .iter()
        .map(|scene| (scene.name, &[][..]))
        .chain(["torus", "fog", "rgb"].map(|name| (name, &["--max-error", "4"][..])))
        .collect();
    let mut tried = Tried::new("films_are_the_same_whatever_the_number_of_threads", 3 * looks.len() as u64);
    let (mut fades, mut textures, mut fogs) = (0, 0, 0);
    for (name, look) in looks {
        let directory = directory();
        let [one, more @ ..] = ["1", "2", "3", "7"].map(|threads| {
            let words =
                [&[name, "-o", "x.gif", "--frames", FRAMES, "--scale", "1", "--threads", threads], look].concat();
            let (_, film) = film(&directory, &words);
            (film, read(&directory, "x.gif"))
        });
        for (threads, (_, bytes)) in ["2", "3", "7"].into_iter().zip(more) {
            assert!(bytes == one.1, "{name} {look:?}: {threads} threads draw another film than one");
            tried.add(1);
        }
        let scene = name.parse::<shipped::Shipped>().expect("shipped").load().expect("a scene").scene;
        fades += u32::from(scene.palette_animation.is_some() && one.0.images.iter().any(|image| image.has_palette));
        fogs += u32::from(scene.fog.is_some());
        let textured = |object: &mode13h::scene::Object| object.materials.iter().any(|m| m.texture.is_some());
        textures += u32::from(scene.objects().iter().any(textured));
    }
    assert!(fades >= 1 && fogs >= 2 && textures >= 1, "{fades} fade, {textures} have textures, {fogs} fog");
}

/// One film long enough that each thread draws many frames.
#[test]
fn a_film_of_many_frames_is_the_same_whatever_the_number_of_threads() {
    let directory = directory();
    let films = ["1", "7"].map(|threads| {
        let words = ["fade", "-o", "x.gif", "--frames", "61", "--scale", "1", "--threads", threads];
        film(&directory, &words);
        read(&directory, "x.gif")
    });
    assert!(films[0] == films[1]);
}

/// The most memory, in KiB, that the program has held while it wrote a film.
#[cfg(target_os = "linux")]
fn peak_of_a_film(frames: u32) -> u64 {
    let directory = directory();
    // Round it the camera goes: a small picture that changes.
    let words = ["render", "cube", "-o", "x.gif", "--scale", "1", "--threads", "2", "--frames", &frames.to_string()];
    let mut child = program(&directory).args(words).stdout(Stdio::null()).spawn().expect("started");
    let status = format!("/proc/{}/status", child.id());
    let mut peak = 0;
    while child.try_wait().expect("a child").is_none() {
        // Of one that has just ended there is none. It never falls, so the last one read is that of the whole film, but for
        // the last moments.
        let status = fs::read_to_string(&status).unwrap_or_default();
        let most = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().split(' ').next()?.parse().ok());
        peak = most.unwrap_or(0).max(peak);
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert!(child.wait().expect("a child").success());
    // At 35 a second: what follows itself without a change is one image, and stays as long.
    assert_eq!(hundredths_of(&read(&directory, "x.gif")), (100 * u64::from(frames)).div_ceil(35), "the film's length");
    peak
}

/// How long a film is, in 1/100 s, read image by image.
#[cfg(target_os = "linux")]
fn hundredths_of(file: &[u8]) -> u64 {
    let mut options = gif::DecodeOptions::new();
    options.skip_frame_decoding(true);
    let mut decoder = options.read_info(Cursor::new(file)).expect("a GIF");
    let mut sum = 0;
    while let Some(image) = decoder.next_frame_info().expect("an image") {
        sum += u64::from(image.delay);
    }
    sum
}

/// A film of any length takes as much memory as a short one: 32 frames a thread wait, each of 64,000 bytes and as much again
/// while it is made. Keeping the additional frames compared here would take ten times that.
#[cfg(target_os = "linux")]
fn films_of(tried: &mut Tried, frames: u32) {
    const MIB: u64 = 1024;
    let (short, long) = (peak_of_a_film(200), peak_of_a_film(frames));
    tried.worst("MiB for the short film", short as f64 / 1024.0);
    tried.worst("MiB for the long film", long as f64 / 1024.0);
    assert!(short > MIB, "{short} KiB were read");
    // How full the two lists of 64 frames are at once, and what the allocator keeps of what was given back, is chance: both
    // lists are 8 MiB. A film of 2,000 frames that is kept whole takes 122.
    assert!(long <= short + 8 * MIB, "{short} KiB for 200 frames, {long} KiB for {frames}");
    tried.add(frames.into());
}

#[cfg(target_os = "linux")]
#[test]
fn a_film_of_any_length_takes_as_much_memory() {
    let mut tried = Tried::new("a_film_of_any_length_takes_as_much_memory", 2_000);
    films_of(&mut tried, 2_000);
}

#[cfg(target_os = "linux")]
#[test]
#[ignore = "the long run: 100,000 frames"]
fn film_long_of_a_hundred_thousand_frames() {
    let mut tried = Tried::new("film_long_of_a_hundred_thousand_frames", 100_000);
    films_of(&mut tried, 100_000);
}

/// The frames of an animated PNG as they are shown, in colours.
fn shown(bytes: &[u8]) -> Vec<Vec<Rgb>> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().expect("a PNG");
    let (width, height) = (reader.info().width, reader.info().height);
    let frames = reader.info().animation_control.expect("an animation").num_frames;
    let channels = reader.output_color_type().0.samples();
    let mut canvas = vec![Rgb::BLACK; (width * height) as usize];
    let mut buffer = vec![0; canvas.len() * 4];
    let mut all = Vec::new();
    for _ in 0..frames {
        reader.next_frame(&mut buffer).expect("a frame");
        let part = *reader.info().frame_control().expect("its control");
        assert_eq!((part.delay_num, part.delay_den), (1, 35));
        for (i, pixel) in (0..part.width * part.height).zip(buffer.chunks(channels)) {
            let at = (part.y_offset + i / part.width) * width + part.x_offset + i % part.width;
            if pixel.get(3) != Some(&0) {
                canvas[at as usize] = Rgb::new(pixel[0], pixel[1], pixel[2]);
            }
        }
        all.push(canvas.clone());
    }
    all
}

/// The three kinds of film of a scene, one that moves and one whose palette fades, show the same.
#[test]
fn films_of_all_kinds_show_the_same() {
    let directory = directory();
    for (scene, colors) in [("cube", "indexed"), ("fade", "true colour, as the palette changes")] {
        let words = |out| ["render", scene, "-o", out, "--frames", "6", "--scale", "64x48"];
        assert!(run(&directory, &words("x.gif")).status.success());
        let line = printed(&directory, &words("x.apng"));
        let apng = read(&directory, "x.apng");
        let bytes = apng.len();
        assert_eq!(line, format!("x.apng: 64 x 48 pixels, 6 frames, 0.17 s, {colors}, {bytes} bytes\n"));
        let of_gif: Vec<Vec<Rgb>> =
            decode(&read(&directory, "x.gif")).images.into_iter().map(|image| image.shown).collect();
        assert!(of_gif.len() == 6 && shown(&apng) == of_gif, "{scene}");

        let stream = run(&directory, &words("-"));
        assert!(stream.status.success() && stream.stderr.is_empty(), "{stream:?}");
        let frames = stream.stdout.strip_prefix(b"YUV4MPEG2 W64 H48 F35:1 Ip A1:1 C444\n").expect("a heading");
        let frames: Vec<&[u8]> = frames.chunks(6 + 3 * 64 * 48).collect();
        assert_eq!(frames.len(), 6);
        for (frame, colors) in frames.into_iter().zip(&of_gif) {
            let planes = frame.strip_prefix(b"FRAME\n").expect("a frame");
            for (i, color) in colors.iter().enumerate() {
                let (r, g, b) = (f64::from(color.r), f64::from(color.g), f64::from(color.b));
                // The luma of ITU-R BT.601; the rest is tested where it is made.
                let y = 16.0 + 219.0 * (0.299 * r + 0.587 * g + 0.114 * b) / 255.0;
                assert!((f64::from(planes[i]) - y).abs() <= 0.5 + 0.0015, "{color:?}: {}", planes[i]);
            }
        }
    }
}

/// A model with all that it may name, and a scene with all that it may; each by every command that writes, under its own
/// name, by links of both kinds, and as one of a row.
#[cfg(unix)]
#[test]
fn f4_what_was_read_is_never_overwritten() {
    let mut tried = Tried::new("f4_what_was_read_is_never_overwritten", 29);
    let directory = directory();
    let path = |name: &str| directory.path().join(name);
    let put = |name: &str, text: &str| fs::write(path(name), text).expect("written");
    for name in ["box.png", "row3.png", "around.png"] {
        succeed(&directory, &["render", "cube", "-o", name]);
    }
    put("box.mtl", "newmtl tin\nmap_Kd box.png\nnewmtl wood\nmap_Kd row3.png\n");
    let face = "f 1/1 2/1 3/1\n";
    let faces = format!("usemtl tin\n{face}usemtl wood\n{face}");
    put("box.obj", &format!("mtllib box.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n{faces}"));
    // Without texture coordinates no texture is looked at, and is the model's all the same.
    put("bare.obj", "mtllib box.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl tin\nf 1 2 3\n");
    succeed(&directory, &["palette", "grey", "-o", "own.gpl"]);
    succeed(&directory, &["palette", "copper", "-o", "faded.pal"]);
    put(
        "scene.toml",
        "palette = 'own.gpl'\nanimation = { fade = 'faded.pal' }\n\
         objects = [{ model = 'box.obj' }, { shape = 'wall', material.environment = 'around.png' }]\n",
    );
    for (name, target) in [("link.png", "box.png"), ("link.gif", "row3.png"), ("link.apng", "box.png")] {
        std::os::unix::fs::symlink(target, path(name)).expect("a link");
    }
    std::os::unix::fs::symlink("own.gpl", path("link.svg")).expect("a link");
    fs::hard_link(path("box.png"), path("hard.png")).expect("a link");
    fs::create_dir(path("study")).expect("made");
    fs::hard_link(path("scene.toml"), path("study/report.html")).expect("a link");
    fs::create_dir(path("of-model")).expect("made");
    std::os::unix::fs::symlink("../box.mtl", path("of-model/cost.json")).expect("a link");

    let absolute = path("box.png").to_string_lossy().into_owned();
    let mut all: Vec<Vec<&str>> = Vec::new();
    for input in ["box.obj", "scene.toml"] {
        for out in ["box.png", "./box.png", "study/../box.png", &absolute, "link.png", "hard.png", "row3.png"] {
            all.push(vec!["render", input, "-o", out]);
        }
        for out in ["link.gif", "link.apng"] {
            all.push(vec!["render", input, "-o", out, "--frames", "2"]);
        }
        all.push(vec!["render", input, "-o", "row%d.png", "--frames", "5"]);
    }
    all.push(vec!["render", "scene.toml", "-o", "around.png"]);
    all.push(vec!["render", "bare.obj", "-o", "box.png"]);
    all.push(vec!["palette", "own.gpl", "-o", "own.gpl"]);
    all.push(vec!["palette", "--from", "box.obj", "-o", "box.png"]);
    all.push(vec!["explain", "scene.toml", "--row", "5", "-o", "link.svg"]);
    all.push(vec!["cost", "scene.toml", "-o", "study"]);
    all.push(vec!["cost", "box.obj", "-o", "of-model"]);
    for (name, target) in [("link.exe", "box.obj"), ("link.img", "scene.toml")] {
        std::os::unix::fs::symlink(target, path(name)).expect("a link");
        all.push(vec!["dos", target, "-o", name, "--frames", "1"]);
    }
    let names = names_in(directory.path());
    let before: Vec<Option<Vec<u8>>> = names.iter().map(|name| fs::read(path(name)).ok()).collect();
    for words in all {
        assert_fails(&run(&directory, &words), 2, "will not be overwritten");
        tried.add(1);
    }
    assert_eq!(names_in(directory.path()), names);
    for (name, before) in names.iter().zip(before) {
        assert!(fs::read(path(name)).ok() == before, "{name}");
    }
    // What was not read may be, as ever.
    succeed(&directory, &["render", "cube", "-o", "box.png"]);
}

/// What a command writes is of its own kind, and no second file of the same command.
#[test]
fn f4_what_is_of_another_kind_is_not_overwritten() {
    let mut tried = Tried::new("f4_what_is_of_another_kind_is_not_overwritten", 5);
    let directory = directory();
    for name in ["house.obj", "house.mtl", "report.html", "Cargo.toml"] {
        fs::write(directory.path().join(name), "what stood there").expect("written");
    }
    // Integers know no budget, so the status does not hang on the clock.
    let cost = ["cost", "cube", "--frames", "1", "--seconds", "0", "--arithmetic", "fixed", "-o"];
    for (words, status, line) in [
        (
            vec!["dos", "cube", "-o", "house.obj"],
            2,
            "house.obj: the name of a DOS program must end in .exe, that of a floppy in .img",
        ),
        (vec!["dos", "cube", "-o", "house"], 2, "must end in .exe"),
        (
            vec!["scenes", "copy", "torus", "-o", "house.obj"],
            2,
            "house.obj: the name of a scene file must end in .toml",
        ),
        ([&cost[..], &["."]].concat(), 3, "report.html: already exists and is not part of a study"),
    ] {
        assert_fails(&run(&directory, &words), status, line);
        tried.add(1);
    }
    for name in ["house.obj", "house.mtl", "report.html", "Cargo.toml"] {
        assert_eq!(read(&directory, name), b"what stood there", "{name}");
    }
    // A study replaces an earlier one.
    for _ in 0..2 {
        let output = run(&directory, &[&cost[..], &["study"]].concat());
        assert!(output.status.success(), "{output:?}");
    }
    tried.add(1);
}

/// A row of pictures that is broken off says which of them there are.
#[test]
fn a_row_that_fails_says_what_was_written() {
    let directory = directory();
    fs::create_dir(directory.path().join("a3.png")).expect("made");
    let words = ["render", "cube", "-o", "a%d.png", "--frames", "5", "--threads", "1"];
    assert_fails(&run(&directory, &words), 3, "; written before that: a0.png to a2.png");
}

/// A model or scene read from a pipe, or gzipped, gives the same picture. Files it names are found beside it, or here.
#[test]
fn input_comes_by_a_pipe_or_packed() {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::GzEncoder;

    let directory = directory();
    let put = |name: &str, bytes: &[u8]| fs::write(directory.path().join(name), bytes).expect("written");
    let model = "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let scene = "palette = 'copper'\n[[objects]]\nmodel = 'a.obj'\n[[lights]]\nsun = [0, 0, 1]\n";
    put("a.mtl", b"newmtl a\nKd 0.9 0.2 0.1\n");
    let pack = |bytes: &[u8]| {
        let mut packed = GzEncoder::new(Vec::new(), Compression::default());
        packed.write_all(bytes).expect("packed");
        packed.finish().expect("packed")
    };
    for (name, text) in [("a.obj", model), ("s.toml", scene)] {
        put(name, text.as_bytes());
        let packed = pack(text.as_bytes());
        put(&format!("{name}.gz"), &packed);
        succeed(&directory, &["render", name, "-o", "plain.png"]);
        succeed(&directory, &["render", &format!("{name}.gz"), "-o", "packed.png"]);
        assert!(read(&directory, "packed.png") == read(&directory, "plain.png"), "{name}.gz");
        for (words, bytes) in [("-", text.as_bytes()), ("/dev/stdin", text.as_bytes()), ("-", &packed)] {
            let mut child = program(&directory)
                .args(["render", words, "-o", "piped.png"])
                .stdin(std::process::Stdio::piped())
                .spawn()
                .expect("started");
            child.stdin.take().expect("a pipe").write_all(bytes).expect("read");
            assert!(child.wait().expect("ended").success(), "{name} by {words}");
            assert!(read(&directory, "piped.png") == read(&directory, "plain.png"), "{name} by {words}");
        }
    }
    put("broken.obj.gz", b"\x1f\x8b\x08 no");
    assert_fails(&run(&directory, &["render", "broken.obj.gz", "-o", "x.png"]), 3, "broken.obj.gz: ");
    put("empty.obj.gz", &pack(b"v 0 0 0\n"));
    assert_fails(&run(&directory, &["render", "empty.obj.gz", "-o", "x.png"]), 2, "empty.obj.gz: no faces");
    assert_fails(&run(&directory, &["render", "none.obj.gz", "-o", "x.png"]), 3, "none.obj.gz: No such file");
}

/// Input from a pipe is kept until the program ends: the window shows it again after another input, and when a file that it
/// names has changed.
#[test]
fn standard_input_is_read_once_and_shown_as_often_as_asked_for() {
    use std::io::Write;

    let directory = directory();
    let mut child = program(&directory)
        .args(["-", "torus", "/dev/stdin"])
        .stdin(std::process::Stdio::piped())
        .stderr(std::process::Stdio::null())
        .spawn()
        .expect("started");
    child.stdin.take().expect("a pipe").write_all(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("read");
    assert!(child.wait().expect("ended").success());
    assert!(read(&directory, "mode13h-0001.png") == read(&directory, "mode13h-0003.png"));
}

/// A model and a scene with it play an animation of one second: a moment of it is told by `--time`, and a film is one round.
#[test]
fn an_animation_is_played() {
    let directory = directory();
    let bar = include_bytes!("../../../tests/corpus/gltf/skinned");
    std::fs::write(directory.path().join("bar.glb"), bar).expect("written");
    let scene = "duration = 1\n[[objects]]\nmodel = \"bar.glb\"\n[camera]\neye = [0, 1, 5]\ntarget = [0, 1, 0]\n";
    std::fs::write(directory.path().join("bar.toml"), scene).expect("written");
    for input in ["bar.glb", "bar.toml"] {
        let at = |seconds: &str| {
            succeed(&directory, &["render", input, "-o", "x.png", "--camera", "0,1,5:0,1,0", "--time", seconds]);
            read(&directory, "x.png")
        };
        let [start, middle, end, again] = ["0", "0.5", "1", "-0.5"].map(at);
        assert!(start == end && middle == again && start != middle, "{input}");
        let (line, film) = film(&directory, &[input, "-o", "x.gif", "--fps", "10"]);
        assert!(line.contains("10 frames"), "{line}");
        assert!(film.images.len() > 1, "{input}");
    }
}

/// A triangle that goes aside in its first animation, and up in its second.
const TWO_CLIPS: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
        {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
        {"bufferView": 0, "byteOffset": 44, "componentType": 5126, "count": 2, "type": "VEC3"},
        {"bufferView": 0, "byteOffset": 68, "componentType": 5126, "count": 2, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 92}],
    "buffers": [{"byteLength": 92, "uri": "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAACAPwAAAAA="}],
    "animations": [
        {"name": "Aside", "samplers": [{"input": 1, "output": 2}], "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]},
        {"name": "Up", "samplers": [{"input": 1, "output": 3}], "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]}"#;

/// `--clip` chooses an animation by its name or number; an unknown one lists those of the model.
#[test]
fn an_animation_is_chosen() {
    let directory = directory();
    std::fs::write(directory.path().join("a.gltf"), TWO_CLIPS).expect("written");
    std::fs::write(directory.path().join("a.toml"), "[[objects]]\nmodel = \"a.gltf\"\n").expect("written");
    let picture = |words: &[&str]| {
        let view = ["render", "a.gltf", "-o", "x.png", "--camera", "0,0,5", "--time", "0.5"];
        succeed(&directory, &[&view, words].concat());
        read(&directory, "x.png")
    };
    let [usual, aside, up] = [&[][..], &["--clip", "Aside"], &["--clip", "Up"]].map(picture);
    assert!(usual == aside && aside != up);
    assert!(aside == picture(&["--clip", "0"]) && up == picture(&["--clip", "1"]));
    for (input, clip, says) in [
        ("a.gltf", "Down", "--clip: a: no animation Down; the model has 0: Aside, 1: Up"),
        ("a.gltf", "2", "--clip: a: no animation 2; the model has 0: Aside, 1: Up"),
        ("torus.obj", "0", "--clip: torus: it has no animation"),
        ("a.toml", "0", "--clip is for models; in a scene, each model has a key for it"),
    ] {
        std::fs::write(directory.path().join("torus.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
        assert_fails(&run(&directory, &["render", input, "-o", "y.png", "--clip", clip]), 2, says);
    }
    assert!(!directory.path().join("y.png").exists());
}

/// A model's own lights and camera are taken, unless the command line has a view of its own.
#[test]
fn a_model_brings_lights_and_a_camera() {
    let directory = directory();
    let lit = include_bytes!("../../../tests/corpus/gltf/lights_camera");
    std::fs::write(directory.path().join("lit.glb"), lit).expect("written");
    let picture = |words: &[&str]| {
        let output = run(&directory, &[&["render", "lit.glb", "-o", "x.png"], words].concat());
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && said == "mode13h: lit.glb: left out: orthographic cameras\n", "{said}");
        read(&directory, "x.png")
    };
    let own = picture(&[]);
    // The file's stands at (0, 1, 5) and looks along −z; its angle is of its own.
    let same_view = picture(&["--camera", "0,1,5:0,1,0"]);
    let studio = picture(&["--up", "y"]);
    assert!(own != same_view && own != studio && same_view != studio);
}

/// A program for DOS says what a scene loses in it.
#[test]
fn dos_says_what_is_left_out() {
    let directory = directory();
    let said = |scene: &str| {
        let output = run(&directory, &["dos", scene, "-o", "a.exe", "--frames", "1"]);
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stderr).expect("text")
    };
    assert_eq!(said("torus"), "");
    assert_eq!(
        said("crate"),
        "mode13h: left out, because the program computes in 16.16: perspective, texture, mipmaps\n"
    );
    let words = ["dos", "torus", "-o", "a.exe", "--frames", "1", "--kernel", "portable", "--mapping", "affine"];
    let output = run(&directory, &words);
    assert_eq!(
        String::from_utf8_lossy(&output.stderr),
        "mode13h: ignored, because the program computes in 16.16: --mapping, --kernel\n"
    );
}

#[test]
fn a_film_has_its_figures() {
    let directory = directory();
    let words = ["render", "cube", "-o", "x.gif", "--frames", "3", "--stats"];
    let output = run(&directory, &words);
    assert!(output.status.success(), "{output:?}");
    assert_eq!(String::from_utf8(output.stderr).expect("text").lines().count(), 3);
    assert_eq!(names_in(directory.path()), ["x.gif"]);
}

#[cfg(unix)]
#[test]
fn f4_an_interrupted_film_leaves_nothing_behind() {
    let mut tried = Tried::new("f4_an_interrupted_film_leaves_nothing_behind", 6);
    for (before, signal) in [(None, "-INT"), (Some("what stood there"), "-TERM")] {
        let directory = directory();
        if let Some(before) = before {
            fs::write(directory.path().join("x.gif"), before).expect("written");
        }
        let names = names_in(directory.path());
        let mut child = program(&directory)
            .args(["render", "torus", "-o", "x.gif", "--frames", "100000"])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("started");
        // Until some of it is there, beside its name.
        let is_begun = |name: &str| {
            let length = fs::metadata(directory.path().join(name)).map_or(0, |metadata| metadata.len());
            name.starts_with('.') && length > 100_000
        };
        while !names_in(directory.path()).iter().any(|name| is_begun(name)) {
            assert!(child.try_wait().expect("waited").is_none(), "ended by itself");
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        let killed = Command::new("kill").args([signal, &child.id().to_string()]).status().expect("started");
        assert!(killed.success());
        let output = child.wait_with_output().expect("waited");
        assert_fails(&output, 130, "interrupted");
        tried.add(1);
        assert_eq!(names_in(directory.path()), names);
        tried.add(1);
        assert_eq!(fs::read_to_string(directory.path().join("x.gif")).ok().as_deref(), before);
        tried.add(1);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn f4_a_film_that_no_longer_fits_leaves_the_old_one_whole() {
    let mut tried = Tried::new("f4_a_film_that_no_longer_fits_leaves_the_old_one_whole", 3);
    let directory = directory();
    fs::write(directory.path().join("x.gif"), "what stood there").expect("written");
    // Files may grow to 200 blocks of 512 or 1,024 bytes, which the first frames fit in and the film does not.
    let output = Command::new("sh")
        .args(["-c", r#"ulimit -f 200; trap "" XFSZ; exec "$0" render torus -o x.gif"#, env!("CARGO_BIN_EXE_mode13h")])
        .current_dir(&directory)
        .output()
        .expect("started");
    assert_fails(&output, 3, "x.gif: ");
    tried.add(1);
    assert_eq!(read(&directory, "x.gif"), b"what stood there");
    tried.add(1);
    assert_eq!(names_in(directory.path()), ["x.gif"]);
    tried.add(1);
}

/// What the program prints, in success and without a word on standard error.
#[track_caller]
fn printed<Word: AsRef<OsStr> + std::fmt::Debug>(directory: &TempDir, words: &[Word]) -> String {
    let output = run(directory, words);
    assert!(output.status.success() && output.stderr.is_empty(), "{words:?}: {output:?}");
    String::from_utf8(output.stdout).expect("text")
}

/// The near distance that the plan names, as it is printed, is enough.
#[test]
fn the_near_distance_that_a_plan_names_is_enough() {
    let directory = directory();
    for distance in [2.0, 3.1, 5.7, 9.0, 47.0, 1234.5] {
        let plan = |near: &str| {
            let scene = format!(
                "camera = {{ eye = [0, 0, {distance}], target = [0, 0, 0], near = {near} }}\n[[objects]]\nshape = 'torus'\n"
            );
            fs::write(directory.path().join("near.toml"), scene).expect("written");
            let text = printed(&directory, &["plan", "near.toml"]);
            let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
            let (_, after) = text.split_once("set it to at least ")?;
            Some(after.split(' ').next().expect("a number").to_string())
        };
        let needed = plan("1e-12").expect("it is told");
        assert_eq!(plan(&needed), None, "from {distance}: {needed} is enough");
    }
}

#[test]
fn a_plan_is_a_table_of_a_hundred_columns() {
    let directory = directory();
    for scene in shipped::ALL.iter().map(|shipped| shipped.name).chain(["sphere"]) {
        let text = printed(&directory, &["plan", scene]);
        // The moment of its picture.
        let at =
            scene.parse::<shipped::Shipped>().map_or(0.0, |shipped| shipped.load().expect("a scene").scene.picture);
        assert!(text.starts_with(&format!("{scene} at {at} s, 1/35 s after the frame before it: ")), "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= 100 && line.trim_end() == line), "{text}");
        assert!(text.contains("making the plan takes "), "{text}");
        for effect in Effect::ALL {
            assert!(text.lines().any(|line| line.starts_with(&format!("  {effect} "))), "{scene}, {effect}: {text}");
        }
    }
    let text = printed(&directory, &["plan", "torus"]);
    let row = |effect: &str| -> Vec<&str> {
        let line = text.lines().find(|line| line.split_whitespace().next() == Some(effect)).expect(effect);
        line.split_whitespace().collect()
    };
    assert_eq!(row("hidden-surfaces")[1..], ["on", "depth-buffer", "torus", "is", "not", "convex"]);
    assert_eq!(row("fog")[1..], ["off", "the", "scene", "has", "none"]);
    // Everything but where the columns stand is the same for all, and is said once.
    let text = printed(&directory, &["plan", "fog"]);
    assert_eq!(text.matches("\n  lighting ").count(), 1, "{text}");
    assert_eq!(text.matches("\n  near-clipping ").count(), 13, "{text}");
}

#[test]
fn a_plan_for_programs_is_that_of_the_second_of_two_frames_and_the_same_on_every_run() {
    let directory = directory();
    for shipped in &shipped::ALL {
        for at in [0.0, 1.25] {
            let text = printed(&directory, &["plan", shipped.name, "--json", "--time", &at.to_string()]);
            let other = printed(
                &directory,
                &["plan", shipped.name, "--json", "--time", &at.to_string(), "--kernel", "portable"],
            );
            assert!(text == other, "{}: another plan with another kernel", shipped.name);

            let mut scene = shipped.load().expect("it is shipped").scene;
            let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
            for seconds in [at - 1.0 / 35.0, at] {
                scene.set_time(seconds);
                renderer.draw(&scene, &mut vga).expect("a legal scene");
            }
            let mut rows = renderer.rows(&scene).into_iter();
            let json: Value = serde_json::from_str(&text).expect("JSON");
            assert_eq!((&json["schema"], &json["input"]), (&Value::from(1), &Value::from(shipped.name)));
            let objects = json["objects"].as_array().expect("a list");
            assert_eq!(objects.len(), scene.objects().len());
            for object in objects {
                let effects = object["effects"].as_array().expect("a list");
                assert_eq!(effects.len(), Effect::COUNT);
                for effect in effects {
                    let row = rows.next().expect("a row");
                    assert_eq!(object["object"], row.object.as_str());
                    let keys: Vec<&String> = effect.as_object().expect("an object").keys().collect();
                    assert_eq!(keys, ["choice", "effect", "on", "reason"]);
                    assert_eq!(effect["effect"], row.effect.name());
                    assert_eq!(effect["on"], row.on);
                    assert_eq!(effect["choice"], row.choice);
                    assert_eq!(effect["reason"], row.reason.as_str());
                }
            }
        }
    }
    let still = printed(&directory, &["plan", "still", "--json"]);
    assert!(still.contains("nothing it depends on changed since the last frame"), "{still}");
}

#[test]
fn a_plan_with_times_has_a_price_for_each_effect() {
    let directory = directory();
    let json: Value =
        serde_json::from_str(&printed(&directory, &["plan", "torus", "--json", "--measure"])).expect("JSON");
    let effects = json["objects"][0]["effects"].as_array().expect("a list");
    // How large they are depends on the machine's rest: what is noise and what is not has a test beside the code.
    assert!(effects.iter().all(|effect| effect["ns_per_frame"].is_u64()), "{effects:#?}");

    // The integer path has no fog: it has no price.
    let words = ["plan", "torus", "--json", "--measure", "--arithmetic", "fixed"];
    let json: Value = serde_json::from_str(&printed(&directory, &words)).expect("JSON");
    let effects = json["objects"][0]["effects"].as_array().expect("a list");
    let fog = effects.iter().find(|effect| effect["effect"] == "fog").expect("listed");
    assert!(fog["ns_per_frame"].is_null() && fog["on"] == false, "{fog}");

    let text = printed(&directory, &["plan", "cube", "--measure"]);
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
    assert!(text.contains("drawing the frame takes "), "{text}");
}

#[test]
fn with_no_display_one_frame_is_saved() {
    let directory = directory();
    for (number, words) in [(1, vec![]), (2, vec!["cube"]), (3, vec!["demo", "cube"])] {
        let output = run(&directory, &words);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let said = String::from_utf8(output.stderr).expect("text");
        let name = format!("mode13h-{number:04}.png");
        assert!(said.starts_with("mode13h: no display") && said.contains(&name), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
        assert_eq!(png_header(&read(&directory, &name)), ((320, 200), png::ColorType::Indexed, Some((6, 5))));
        // Nothing is overwritten.
        assert_eq!(names_in(directory.path()).len(), number);
    }
    assert_eq!(read(&directory, "mode13h-0002.png"), read(&directory, "mode13h-0003.png"));
    // Of a scene that begins in the dark, the moment that it names for a picture.
    assert!(run(&directory, &["flash"]).status.success());
    let (palette, pixels) = indexed(&read(&directory, "mode13h-0004.png"));
    let bright = pixels.iter().filter(|pixel| palette[usize::from(**pixel)].brightness() > 60_000).count();
    // At time 0 there are none.
    assert!(bright > 64_000 / 4, "{bright} pixels");
}

#[test]
fn palettes_are_converted_from_each_format_to_each() {
    let directory = directory();
    // Its colours are the DAC's own, so that no format rounds them.
    let colors = *builtin::by_name("bios").expect("a built-in").palette.colors();
    let extensions: Vec<&str> = palette_file::FORMATS.iter().flat_map(|format| format.extensions).copied().collect();
    for from in &extensions {
        let first = format!("first.{from}");
        succeed(&directory, &["palette", "bios", "-o", &first]);
        for to in &extensions {
            let second = format!("second.{to}");
            succeed(&directory, &["palette", &first, "-o", &second]);
            let palette = palette_file::parse_named(&second, &read(&directory, &second)).expect("a palette");
            assert!(palette.colors() == &colors, "{from} to {to}");
        }
    }
    assert!(extensions.len() >= 5);
}

/// `--palette` and the key of a scene take the palette of the same pictures, and `palette` converts it.
#[test]
fn a_picture_lends_its_palette() {
    let directory = directory();
    let put = |name: &str, bytes: &[u8]| fs::write(directory.path().join(name), bytes).expect("written");
    succeed(&directory, &["render", "crate", "-o", "a.png", "--palette", "copper"]);
    put("a.gif", include_bytes!("../../../tests/corpus/texture/gif"));
    put("a.pcx", include_bytes!("../../../tests/corpus/texture/pcx"));
    put("a.aseprite", include_bytes!("../../../tests/corpus/texture/aseprite"));
    put("plain.toml", b"[[objects]]\nshape = \"cube\"\n");
    for picture in ["a.png", "a.gif", "a.pcx", "a.aseprite"] {
        put("asking.toml", format!("palette = \"{picture}\"\n[[objects]]\nshape = \"cube\"\n").as_bytes());
        succeed(&directory, &["render", "asking.toml", "-o", "due.png"]);
        succeed(&directory, &["render", "plain.toml", "-o", "x.png", "--palette", picture]);
        assert!(read(&directory, "x.png") == read(&directory, "due.png"), "{picture}");
        succeed(&directory, &["palette", picture, "-o", "x.gpl"]);
        succeed(&directory, &["render", "plain.toml", "-o", "x.png", "--palette", "x.gpl"]);
        assert!(read(&directory, "x.png") == read(&directory, "due.png"), "{picture}");
    }
    succeed(&directory, &["palette", "a.png", "-o", "x.gpl"]);
    let copper = &builtin::by_name("copper").expect("built in").palette;
    let palette = palette_file::load(directory.path().join("x.gpl")).expect("a palette");
    assert!(palette.colors() == copper.on_dac().colors());
    succeed(&directory, &["render", "cube", "-o", "rgb.png", "--rgb"]);
    put("cut.png", &read(&directory, "a.png")[..60]);
    for picture in ["rgb.png", "cut.png"] {
        for words in [&["render", "cube", "-o", "y.png", "--palette", picture][..], &["palette", picture]] {
            assert_fails(&run(&directory, words), 2, &format!("{picture}: not a picture that can be read: "));
        }
    }
}

#[test]
fn palettes_are_looked_at() {
    let directory = directory();
    for builtin in &builtin::ALL {
        let output = run(&directory, &["palette", builtin.name]);
        assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
        let text = String::from_utf8(output.stdout).expect("text");
        assert!(text.starts_with(&format!("{}: ", builtin.name)), "{text}");
        let shown: Vec<String> =
            text.lines().skip(1).flat_map(|line| line.split_whitespace().skip(1)).map(String::from).collect();
        let colors: Vec<String> = builtin.palette.colors().iter().map(|color| format!("{:06x}", color)).collect();
        assert_eq!(shown, colors, "{}", builtin.name);
    }
    succeed(&directory, &["palette", "cube", "-o", "chart.png"]);
    assert_eq!(png_header(&read(&directory, "chart.png")), ((256, 256), png::ColorType::Indexed, Some((1, 1))));
}

#[test]
fn palettes_are_made_for_models() {
    let directory = directory();
    let data = |name: &str| crate::support::workspace::root().join("tests/data").join(name).display().to_string();
    let house = data("house.obj");
    succeed(&directory, &["palette", "--from", &house, "-o", "house.gpl"]);
    succeed(&directory, &["palette", "--from", &house, "--up", "z", "-o", "lying.gpl"]);
    succeed(&directory, &["palette", "--from", "torus", "-o", "chart.png"]);
    let [upright, lying] = ["house.gpl", "lying.gpl"].map(|name| {
        let palette = palette_file::parse_named(name, &read(&directory, name)).expect("a palette");
        assert_eq!((palette[0], palette[255]), (Rgb::BLACK, Rgb::WHITE));
        palette
    });
    assert_ne!(upright.colors(), lying.colors(), "other sides are seen");

    let output = run(&directory, &["palette", "--from", &house]);
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    let text = String::from_utf8(output.stdout).expect("text");
    assert!(text.starts_with("house: no ramps"), "{text}");
    let surfaces: Vec<&str> =
        text.lines().skip(33).map(|line| line.split(", entries").next().expect("a line")).collect();
    assert_eq!(surfaces, ["grass: a ramp", "bricks: colours of textures", "tiles: a ramp"]);

    // A texture that cannot be read is a warning; the surface has a ramp then.
    let output = run(&directory, &["palette", "--from", &data("chest.obj")]);
    assert!(output.status.success(), "{output:?}");
    let warnings = String::from_utf8(output.stderr).expect("text");
    assert_eq!(warnings.lines().count(), 2, "{warnings}");
    assert!(warnings.contains("chest planks.ppm: not a picture that can be read: "), "{warnings}");
    assert!(String::from_utf8(output.stdout).expect("text").contains("wood: a ramp, entries 1 to "));

    assert_fails(&run(&directory, &["palette", "-o", "x.pal"]), 2, "no palette: give FILE|NAME or --from MODEL");
    assert_fails(&run(&directory, &["palette", "grey", "--from", "torus"]), 2, "--from");
    assert_fails(&run(&directory, &["palette", "grey", "--up", "z"]), 2, "--up");
    assert_fails(&run(&directory, &["palette", "grey", "--crease", "9"]), 2, "--crease");
    assert_fails(&run(&directory, &["palette", "--from", "sphere", "--crease", "999"]), 2, "--crease");
    assert_fails(&run(&directory, &["palette", "--from", "none.obj"]), 3, "none.obj: No such file");
    assert_fails(&run(&directory, &["palette", "--from", "torus", "-o", "x.txt"]), 2, "x.txt: ");
}

/// The palette of an indexed PNG, and its pixels.
fn indexed(bytes: &[u8]) -> (Vec<Rgb>, Vec<u8>) {
    let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().expect("a PNG");
    let palette = reader.info().palette.as_deref().expect("a palette").to_vec();
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    reader.next_frame(&mut pixels).expect("its pixels");
    (palette.chunks_exact(3).map(|c| Rgb::new(c[0], c[1], c[2])).collect(), pixels)
}

/// The share of the covered pixels that are more green than red and blue. The background is in the corner.
fn green(bytes: &[u8]) -> f64 {
    let (palette, pixels) = indexed(bytes);
    let covered: Vec<Rgb> = pixels.iter().filter(|&&i| i != pixels[0]).map(|&i| palette[usize::from(i)]).collect();
    let is_green =
        |color: &&Rgb| u16::from(color.g) > u16::from(color.r) + 20 && u16::from(color.g) > u16::from(color.b) + 20;
    covered.iter().filter(is_green).count() as f64 / covered.len() as f64
}

#[test]
fn a_model_with_colours_is_shown_in_them() {
    let directory = directory();
    let data = |name: &str| crate::support::workspace::root().join("tests/data").join(name).display().to_string();
    let house = data("house.obj");
    succeed(&directory, &["render", &house, "-o", "default.png"]);
    succeed(&directory, &["render", &house, "-o", "auto.png", "--palette", "auto"]);
    assert_eq!(read(&directory, "default.png"), read(&directory, "auto.png"));
    assert!(green(&read(&directory, "auto.png")) > 0.05, "grass");
    // It is the palette that `palette --from` writes, whatever moment is drawn.
    succeed(&directory, &["palette", "--from", &house, "-o", "house.gpl"]);
    succeed(&directory, &["render", &house, "-o", "later.png", "--time", "1.5"]);
    let written = palette_file::parse_named("house.gpl", &read(&directory, "house.gpl")).expect("a palette");
    for name in ["auto.png", "later.png"] {
        assert_eq!(indexed(&read(&directory, name)).0, written.colors(), "{name}");
    }
    assert_ne!(read(&directory, "later.png"), read(&directory, "auto.png"));
    // In palettes without ramps the nearest that they have: of that one most of the same.
    for palette in ["cube", "bios", "house.gpl"] {
        succeed(&directory, &["render", &house, "-o", "x.png", "--palette", palette]);
        assert!(green(&read(&directory, "x.png")) > 0.05, "{palette}");
    }
    // In ramps one each; the bricks' texture is there, too.
    succeed(&directory, &["render", &house, "-o", "ramps.png", "--palette", "materials-8x32"]);
    let (palette, pixels) = indexed(&read(&directory, "ramps.png"));
    assert!(palette == builtin::MATERIALS_8X32.on_dac().colors());
    let ramps: Vec<bool> = (0..8).map(|ramp| pixels.iter().any(|&pixel| pixel > 0 && pixel / 32 == ramp)).collect();
    assert!(ramps[0] && ramps[2], "grass in the first ramp, tiles in the third");
    assert_eq!(green(&read(&directory, "ramps.png")), 0.0);
    // The 16.16 path has no textures: there the walls have a ramp of their own.
    succeed(&directory, &["render", &house, "-o", "fixed.png", "--arithmetic", "fixed"]);
    assert!(green(&read(&directory, "fixed.png")) > 0.05);
    // In the window, too: with no display, what it shows first, framed for the whole turn as in a row.
    let output = run(&directory, &[&house]);
    assert!(output.status.success(), "{output:?}");
    succeed(&directory, &["render", &house, "-o", "row%d.png", "--frames", "2", "--turn", "360"]);
    assert_eq!(indexed(&read(&directory, "mode13h-0001.png")), indexed(&read(&directory, "row0.png")));

    // Shapes have no colours of their own: they are grey as ever, unless asked for.
    succeed(&directory, &["render", "cylinder", "-o", "default.png"]);
    succeed(&directory, &["render", "cylinder", "-o", "grey.png", "--palette", "grey"]);
    assert_eq!(read(&directory, "default.png"), read(&directory, "grey.png"));
    succeed(&directory, &["render", "cylinder", "-o", "auto.png", "--palette", "auto"]);
    let (palette, pixels) = indexed(&read(&directory, "auto.png"));
    assert!(pixels.iter().all(|&i| palette[usize::from(i)].r == palette[usize::from(i)].b));

    // Of colours and a texture that cannot be read, the colours are left, and one line says so.
    let output = run(&directory, &["render", &data("chest.obj"), "-o", "chest.png"]);
    assert!(output.status.success(), "{output:?}");
    // And one that its place is left out.
    assert_eq!(String::from_utf8(output.stderr).expect("text").lines().count(), 2);
    let (palette, pixels) = indexed(&read(&directory, "chest.png"));
    assert!(pixels.iter().any(|&i| palette[usize::from(i)].r > palette[usize::from(i)].b + 40), "wood");
}

/// A single picture of a model file fills nine tenths of its width or height and is centred, within a pixel, from whatever
/// side; the frames of a row share one camera. Options override what is chosen.
#[test]
fn a_single_picture_of_a_model_is_framed_as_it_stands() {
    let mut tried = Tried::new("a_single_picture_of_a_model_is_framed_as_it_stands", 12);
    let directory = directory();
    // A low wedge, open below.
    let low = "v -3 0 -2\nv 3 0 -2\nv 3 0 2\nv -3 0 2\nv -3 0.4 0\nv 3 0.4 0\n\
               f 4 3 6 5\nf 2 1 5 6\nf 1 4 5\nf 3 2 6\n";
    fs::write(directory.path().join("low.obj"), low).expect("written");
    let edges = |name: &str| {
        let (_, pixels) = indexed(&read(&directory, name));
        let covered = || (0..pixels.len()).filter(|&i| pixels[i] != pixels[0]);
        let [columns, rows]: [Vec<usize>; 2] =
            [covered().map(|i| i % 320).collect(), covered().map(|i| i / 320).collect()];
        [columns.iter().min(), columns.iter().max(), rows.iter().min(), rows.iter().max()]
            .map(|edge| *edge.expect("some"))
    };
    for degrees in 0..12 {
        let turn = (30 * degrees).to_string();
        succeed(&directory, &["render", "low.obj", "-o", "low.png", "--turn", &turn]);
        let [left, right, top, bottom] = edges("low.png");
        assert!(left.abs_diff(319 - right) <= 1 && top.abs_diff(199 - bottom) <= 1, "{turn}");
        assert!(left.abs_diff(16) <= 1 || top.abs_diff(10) <= 1, "{turn}: {left}, {top}");
        tried.add(1);
    }
    let explained = printed(&directory, &["explain", "low.obj", "--pixel", "160,100", "--json"]);
    succeed(&directory, &["render", "low.obj", "-o", "low.png"]);
    let byte = indexed(&read(&directory, "low.png")).1[100 * 320 + 160];
    assert!(explained.contains(&format!("\"byte\": {byte}")), "{byte}: {explained}");

    succeed(&directory, &["render", "low.obj", "-o", "asked.png", "--background", "#ffffff", "--up", "z"]);
    let (palette, pixels) = indexed(&read(&directory, "asked.png"));
    assert_eq!(palette[usize::from(pixels[0])], Rgb::WHITE);
    assert_ne!(edges("asked.png"), edges("low.png"));
    for (name, zoom) in [("far.png", "0.5"), ("near.png", "1")] {
        succeed(&directory, &["render", "low.obj", "-o", name, "--zoom", zoom]);
    }
    assert!(edges("far.png")[0] > edges("near.png")[0] + 60);
    succeed(&directory, &["render", "low.obj", "-o", "from.png", "--camera", "0,0,99"]);
    assert!(edges("from.png")[0] > 140);
}

#[test]
fn a_scene_may_ask_for_a_palette_made_for_it() {
    let directory = directory();
    let house = crate::support::workspace::root().join("tests/data/house.obj");
    let text = |palette: &str| {
        format!(
            "palette = '{palette}'\nbackground = '#203060'\nlights = [{{ sun = [1, 2, 3] }}]\n\
             objects = [{{ model = '{}', spin = 1, angles = [20, 0, 0] }}, \
             {{ shape = 'sphere', position = [2, 0, 0], material.color = [0.9, 0.1, 0.6] }}]\n",
            house.display()
        )
    };
    fs::write(directory.path().join("auto.toml"), text("auto")).expect("written");
    fs::write(directory.path().join("cube.toml"), text("cube")).expect("written");
    succeed(&directory, &["render", "auto.toml", "-o", "auto.png"]);
    succeed(&directory, &["render", "cube.toml", "-o", "asked.png", "--palette", "auto"]);
    assert_eq!(read(&directory, "auto.png"), read(&directory, "asked.png"));
    succeed(&directory, &["render", "auto.toml", "-o", "cube.png", "--palette", "cube"]);
    succeed(&directory, &["render", "cube.toml", "-o", "asked.png"]);
    assert_eq!(read(&directory, "cube.png"), read(&directory, "asked.png"));
    let (palette, pixels) = indexed(&read(&directory, "auto.png"));
    let background = palette[usize::from(pixels[0])];
    // A step of the card, at most.
    assert!(background.distance_squared(Rgb::new(0x20, 0x30, 0x60)) <= 3 * 4 * 4, "{background:?}");
    assert!(green(&read(&directory, "auto.png")) > 0.005, "grass");
    let magenta = |color: Rgb| color.r > 100 && color.b > 60 && color.g < 30;
    assert!(pixels.iter().filter(|&&i| magenta(palette[usize::from(i)])).count() > 500, "the sphere");
}

#[test]
fn help_and_version_succeed() {
    let directory = directory();
    for words in [vec!["--help"], vec!["-h"], vec!["--version"], vec!["help", "render"], vec!["palette", "--help"]] {
        let output = run(&directory, &words);
        assert!(output.status.success() && output.stderr.is_empty() && !output.stdout.is_empty(), "{words:?}");
    }
}

#[test]
fn nobody_reading_on_is_no_failure() {
    let directory = directory();
    let mut command = program(&directory);
    command.args(["palette", "grey"]).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("started");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("waited");
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
}

#[cfg(unix)]
#[test]
fn names_need_not_be_text() {
    use std::os::unix::ffi::OsStrExt;
    let directory = directory();
    let name = OsStr::from_bytes(b"a\xFF\n.png");
    let output = run(&directory, &[OsStr::new("render"), OsStr::new("cube"), OsStr::new("-o"), name]);
    assert!(output.status.success(), "{output:?}");
    assert!(directory.path().join(name).is_file());
    let missing = OsStr::from_bytes(b"line\nend\x1B[2J\xFF.obj");
    let output = run(&directory, &[OsStr::new("render"), missing, OsStr::new("-o"), OsStr::new("x.png")]);
    assert_fails(&output, 3, "line end [2J");
}

#[test]
fn f3_broken_scenes_are_one_line_with_their_place() {
    let mut tried = Tried::new("f3_broken_scenes_are_one_line_with_their_place", 12);
    let directory = directory();
    let put = |name: &str, text: &[u8]| fs::write(directory.path().join(name), text).expect("written");
    put("key.toml", b"[[objects]]\nshape = 'cube'\nmaterial = { shyness = 3 }\n");
    put("type.toml", b"objects = [{ shape = 'cube', scale = 'large' }]\n");
    put("missing.toml", b"[[objects]]\nshape = 'wall'\nmaterial.texture = 'none.png'\n");
    put("model.toml", b"[[objects]]\nmodel = 'nan.obj'\n");
    put("nan.obj", b"v 0 0 0\nv 1 NaN 0\nv 0 1 0\nf 1 2 3\n");
    put("no.toml", b"name = 'nothing'\n");
    put("syntax.toml", b"name = \n");
    put("binary.toml", b"\x89PNG\r\n\x1a\n\0");
    put("control.toml", b"objects = [{ shape = \"\x5cu001b[2J\" }]\n");
    fs::create_dir(directory.path().join("directory.toml")).expect("made");
    let before = names_in(directory.path());
    for (input, status, says) in [
        ("key.toml", 2, "key.toml:3:14: key `objects[0].material.shyness`: unknown key; known are ambient, "),
        (
            "type.toml",
            2,
            "type.toml:1:38: key `objects[0].scale`: expected a number above 0, or three in a list, found string",
        ),
        ("missing.toml", 3, "missing.toml:3:20: key `objects[0].material.texture`: none.png: No such file"),
        ("model.toml", 2, "model.toml:2:9: key `objects[0].model`: nan.obj:2: `NaN`"),
        ("no.toml", 2, "no.toml: no object: a scene needs at least one"),
        ("syntax.toml", 2, "syntax.toml:1:8: not TOML: "),
        ("binary.toml", 2, "binary.toml:1:1: not text in UTF-8"),
        ("control.toml", 2, "control.toml:1:22: key `objects[0].shape`: "),
        ("directory.toml", 3, "directory.toml: is a directory"),
        ("none.toml", 3, "none.toml: No such file"),
    ] {
        assert_fails(&run(&directory, &["render", input, "-o", "x.png"]), status, says);
        tried.add(1);
    }
    assert_fails(&run(&directory, &["key.toml"]), 2, "key.toml:3:14: ");
    tried.add(1);
    assert_eq!(names_in(directory.path()), before);
    tried.add(1);
}

#[test]
fn scenes_are_listed_and_copied_and_nothing_is_overwritten() {
    let directory = directory();
    let output = run(&directory, &["list", "scenes"]);
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    let list = String::from_utf8(output.stdout).expect("text");
    let shapes = list.lines().skip(shipped::ALL.len()).collect::<Vec<_>>().join(" ");
    assert_eq!(shapes, format!(" shapes: {}", mode13h::mesh::shapes::NAMES.join(", ")));
    for (line, scene) in list.lines().zip(&shipped::ALL) {
        let (name, shows) = line.split_once(' ').expect("two columns");
        assert_eq!((name, shows.trim_start()), (scene.name, scene.shows()));
    }
    succeed(&directory, &["scenes", "copy", "fog"]);
    succeed(&directory, &["scenes", "copy", "fog", "-o", "other.toml"]);
    assert_eq!(names_in(directory.path()), ["fog.toml", "other.toml"]);
    let text = "fog".parse::<shipped::Shipped>().expect("a scene").text;
    assert!(read(&directory, "fog.toml") == text.as_bytes() && read(&directory, "other.toml") == text.as_bytes());
    fs::write(directory.path().join("fog.toml"), "what stood there").expect("written");
    assert_fails(&run(&directory, &["scenes", "copy", "fog"]), 3, "fog.toml: already exists; --force");
    assert_eq!(read(&directory, "fog.toml"), b"what stood there");
    assert_fails(&run(&directory, &["scenes", "copy", "frog"]), 2, "frog: no such scene; did you mean fog?");
    assert_fails(&run(&directory, &["scenes", "copy", "fog", "-o", "none/x.toml"]), 3, "none does not exist");
    // A copy is the scene.
    succeed(&directory, &["render", "other.toml", "-o", "copy.png", "--time", "1"]);
    succeed(&directory, &["render", "fog", "-o", "fog.png", "--time", "1"]);
    assert!(read(&directory, "copy.png") == read(&directory, "fog.png"));
}

#[test]
fn every_shipped_scene_is_drawn_and_a_scene_comes_before_a_shape() {
    let directory = directory();
    for scene in &shipped::ALL {
        succeed(&directory, &["render", scene.name, "-o", "x.png", "--time", "1.5"]);
        assert_eq!(png_header(&read(&directory, "x.png")).0, (320, 200), "{}", scene.name);
    }
    // The teapot of the scene has its palette, not that of a shape.
    succeed(&directory, &["render", "teapot", "-o", "x.png"]);
    let png = read(&directory, "x.png");
    let reader = png::Decoder::new(Cursor::new(&png)).read_info().expect("a PNG");
    let Rgb { r, g, b } = builtin::COPPER.on_dac()[200];
    assert_eq!(reader.info().palette.as_deref().map(|palette| palette[3 * 200..3 * 201].to_vec()), Some(vec![r, g, b]));
}

/// Options of the command line override the scene.
#[test]
fn words_have_the_last_word_over_a_scene() {
    let directory = directory();
    let stats = |words: &[&str]| {
        let output = run(&directory, &[&["render"], words, &["-o", "x.png", "--stats"]].concat());
        assert!(output.status.success(), "{words:?}: {output:?}");
        (String::from_utf8(output.stderr).expect("text"), read(&directory, "x.png"))
    };
    let (said, own) = stats(&["phong"]);
    assert!(said.contains(": phong, float vertices,"), "{said}");
    let (said, _) = stats(&["phong", "--shading", "flat", "--hidden-surfaces", "scan-line", "--arithmetic", "fixed"]);
    assert!(said.contains(": flat, fixed vertices,") && said.contains(" scan-line: "), "{said}");
    // Within an error the shadings that faces got are counted, and no other is named.
    let (said, _) = stats(&["phong", "--max-error", "4"]);
    assert!(said.contains(": within 4 shades (") && said.contains(" gouraud-8.8-reseeded"), "{said}");
    assert!(said.contains("), float vertices,"), "{said}");
    let (_, grey) = stats(&["phong", "--palette", "grey"]);
    assert!(grey != own);
    let (_, perspective) = stats(&["crate", "--time", "0.3"]);
    for mapping in ["affine", "every-16"] {
        assert!(stats(&["crate", "--time", "0.3", "--mapping", mapping]).1 != perspective, "{mapping}");
    }
    assert!(stats(&["crate", "--time", "0.3", "--mapping", "perspective"]).1 == perspective);
}

/// Enlarged, from another place, before another colour, with dither: what is asked for is seen.
#[test]
fn the_view_is_as_asked_for() {
    let directory = directory();
    let picture = |words: &[&str]| {
        succeed(&directory, &[&["render"], words, &["-o", "x.png"]].concat());
        indexed(&read(&directory, "x.png"))
    };
    let own = picture(&["sphere"]);
    let covered = |(_, pixels): &(Vec<Rgb>, Vec<u8>)| pixels.iter().filter(|pixel| **pixel != pixels[0]).count();
    assert!(picture(&["sphere", "--zoom", "1"]) == own);
    // A view twice as narrow, or from twice as far away: four times the area, and a quarter but for perspective.
    let (larger, smaller) = (picture(&["sphere", "--zoom", "1.05"]), picture(&["sphere", "--zoom", "0.5"]));
    let part = |of| covered(of) as f64 / covered(&own) as f64;
    assert!((part(&larger) - 1.05 * 1.05).abs() < 0.01, "{}", part(&larger));
    assert!((0.2..0.25).contains(&part(&smaller)), "{}", part(&smaller));
    // From the other side a torus under a sun before it is dark; beyond it there is nothing to be seen.
    assert!(picture(&["torus", "--camera", "0,0,-3"]) != picture(&["torus", "--camera", "0,0,3"]));
    assert!(picture(&["torus", "--camera", "0,0,3:0,0,0"]) == picture(&["torus", "--camera", "0,0,3"]));
    assert_eq!(covered(&picture(&["torus", "--camera", "0,0,3:0,0,9"])), 0);
    // A scene's own camera that moves stands still then.
    let still = |time: &'static str| picture(&["interlock", "--camera", "0,0,4", "--time", time]);
    assert!(still("0") == still("1"));
    for (word, color) in [("#ff0000", Rgb::new(255, 0, 0)), ("00ff00", Rgb::new(0, 255, 0))] {
        let (palette, pixels) = picture(&["cube", "--palette", "bios", "--background", word]);
        assert!(palette[usize::from(pixels[0])].distance_squared(color) < 100, "{word}");
    }
    assert_eq!(picture(&["cube", "--background", "7"]).1[0], 7);
    let [with, without] =
        [&["--dither", "ordered"][..], &["--no-dither"]].map(|words| picture(&[&["still"], words].concat()));
    assert!(with == picture(&["still"]) && with != without && without != picture(&["still", "--dither", "blue-noise"]));
    // With nothing said a picture is of the moment that the scene names; a film and a turn begin at 0.
    assert!(picture(&["flash"]) == picture(&["flash", "--time", "1.11"]));
    assert!(picture(&["flash", "--turn", "0"]) == picture(&["flash", "--time", "0"]));
}

/// What a scene shows in the ramps of its palette keeps its colours in one that is made for it.
#[test]
fn a_palette_made_for_a_scene_keeps_the_colors_of_its_ramps() {
    let directory = directory();
    let colors = |words: &[&str]| {
        succeed(&directory, &[&["render"], words, &["-o", "x.png", "--no-dither"]].concat());
        let (palette, pixels) = indexed(&read(&directory, "x.png"));
        pixels.into_iter().map(move |pixel| palette[usize::from(pixel)]).collect::<Vec<Rgb>>()
    };
    for scene in ["still", "interlock", "teapot", "phong"] {
        let (own, made) = (colors(&[scene]), colors(&[scene, "--palette", "auto"]));
        let far = own.iter().zip(&made).map(|(a, b)| f64::from(a.distance_squared(*b)).sqrt());
        let mean = far.sum::<f64>() / own.len() as f64;
        // Of three steps of a channel on the card one in each channel. In greys they would be 30 and more apart.
        assert!(mean < 4.0 * 3_f64.sqrt(), "{scene}: {mean}");
    }
}

/// A scene has a time; `--turn` takes one that moves further in its round, and leads the camera round another.
#[test]
fn scenes_are_drawn_at_their_time() {
    let directory = directory();
    let picture = |words: &[&str]| {
        succeed(&directory, &[&["render"], words, &["-o", "x.png"]].concat());
        read(&directory, "x.png")
    };
    assert!(picture(&["rgb", "--time", "1"]) == picture(&["rgb", "--turn", "90"]));
    assert!(picture(&["rgb", "--time", "1"]) == picture(&["rgb", "--time", "5"]));
    assert!(picture(&["rgb", "--time", "1"]) != picture(&["rgb"]));
    assert!(picture(&["still", "--time", "1"]) == picture(&["still"]));
    assert!(picture(&["still", "--turn", "90"]) != picture(&["still"]));
    // The scene lasts three seconds, not four.
    assert!(picture(&["flash", "--turn", "120"]) == picture(&["flash", "--time", "1"]));
    let (line, _) = film(&directory, &["flash", "-o", "x.gif", "--fps", "10", "--scale", "1"]);
    assert!(line.contains(" 30 frames ") && line.contains(", 3.00 s, "), "{line}");
}

/// One pixel in words and as JSON, which say the same as the picture.
#[test]
fn explain_says_why_a_pixel_has_its_byte() {
    let directory = directory();
    let mut scene = "cone".parse::<shipped::Shipped>().expect("a scene").load().expect("a scene that loads").scene;
    scene.set_time(0.0);
    let mut vga = Vga::new();
    Renderer::new().draw(&scene, &mut vga).expect("a legal scene");
    for (x, y) in [(150, 100), (0, 0), (167, 120)] {
        let place = format!("{x},{y}");
        let output = run(&directory, &["explain", "cone", "--pixel", &place]);
        assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
        let text = String::from_utf8(output.stdout).expect("text");
        let byte = vga.pixels()[y * 320 + x];
        assert!(text.starts_with(&format!("cone at 0 s, pixel ({x}, {y}): byte {byte} (")), "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
        let output = run(&directory, &["explain", "cone", "--pixel", &place, "--json"]);
        let json: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!((&json["schema"], &json["byte"]), (&Value::from(1), &Value::from(byte)));
        let Some(seen) = json["seen"].get(0) else {
            assert_eq!((json["byte"].clone(), text.contains("the background")), (Value::from(0), true));
            continue;
        };
        let shade_trace = &seen["traces"][0];
        let sums = shade_trace["sums"].as_array().expect("sums");
        let last = sums.last().and_then(Value::as_u64).expect("a sum");
        assert_eq!((last >> 8, sums.len() as u64 - 1), (byte.into(), shade_trace["steps"].as_u64().expect("steps")));
        assert!(text.contains(&format!("{last:04x}")), "{text}");
        let face = &json["faces"][seen["face"].as_u64().expect("a place") as usize];
        assert!(text.contains(&format!("cone, triangle {}", face["triangle"])), "{text}");
        assert!(face["edges"].as_array().expect("edges").iter().all(|edge| edge["value"].as_i64() >= Some(0)));
    }
}

/// `explain` names a face as the model's author knows it: by object, material and line.
#[test]
fn explain_names_material_and_line() {
    let directory = directory();
    let model = "mtllib m.mtl\nusemtl wall\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n# a square\nf 1 2 3 4\n";
    fs::write(directory.path().join("m.obj"), model).expect("written");
    fs::write(directory.path().join("m.mtl"), "newmtl wall\nKd 1 0 0\n").expect("written");
    let output = run(&directory, &["explain", "m.obj", "--pixel", "150,90"]);
    let text = String::from_utf8(output.stdout).expect("text");
    assert!(text.contains("m, triangle 0 (line 8 of the model), material wall"), "{text}");
    let output = run(&directory, &["explain", "m.obj", "--pixel", "150,90", "--json"]);
    let json: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let face = &json["faces"][0];
    assert_eq!((&face["object"], &face["line"], &face["material"]), (&"m".into(), &8.into(), &"wall".into()));
    // A shape has neither.
    let output = run(&directory, &["explain", "cone", "--pixel", "150,100", "--json"]);
    let json: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((&json["faces"][0]["line"], &json["faces"][0]["material"]), (&Value::Null, &Value::Null));
}

/// A row in characters, as JSON and as a chart.
#[test]
fn explain_draws_a_row() {
    let directory = directory();
    let output = run(&directory, &["explain", "cone", "--row", "120"]);
    let text = String::from_utf8(output.stdout).expect("text");
    assert!(text.starts_with("cone at 0 s, row 120, gouraud-8.8-reseeded\n"), "{text}");
    assert!(text.contains("Mach bands") && text.lines().all(|line| line.chars().count() <= 100), "{text}");
    let output = run(&directory, &["explain", "cone", "--row", "120", "--max-error", "4"]);
    let text = String::from_utf8(output.stdout).expect("text");
    assert!(text.starts_with("cone at 0 s, row 120, within 4 shades\n"), "{text}");
    let output = run(&directory, &["explain", "cone", "--row", "0"]);
    assert!(String::from_utf8(output.stdout).expect("text").contains("nothing but background"));

    let output = run(&directory, &["explain", "cone", "--row", "120", "--json"]);
    let json: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((&json["schema"], &json["row"]), (&Value::from(1), &Value::from(120)));
    let columns = json["columns"].as_array().expect("columns");
    assert_eq!((columns.len(), json["slope"]["lit"].as_array().map(Vec::len)), (320, Some(320)));
    let faces = columns.iter().filter(|column| !column["face"].is_null()).count();

    succeed(&directory, &["explain", "cone", "--row", "120", "-o", "row.svg"]);
    let svg = String::from_utf8(read(&directory, "row.svg")).expect("text");
    assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"));
    // A dot for each pixel with a face, and one in the legend.
    assert_eq!(svg.matches("<circle").count(), faces + 1);
    assert_eq!(names_in(directory.path()), ["row.svg"]);
}

#[test]
fn explain_refuses_what_is_not_there() {
    let directory = directory();
    for (words, status, says) in [
        (vec!["explain", "cone"], 2, "--pixel <X,Y>|--row <Y>"),
        (vec!["explain", "cone", "--pixel", "320,0"], 2, "no pixel (320, 0) in a frame of 320 x 200"),
        (vec!["explain", "cone", "--pixel", "0,200"], 2, "no pixel (0, 200)"),
        (vec!["explain", "cone", "--pixel", "160"], 2, "such as 160,100"),
        (vec!["explain", "cone", "--pixel", "1.5,2"], 2, "such as 160,100"),
        (vec!["explain", "cone", "--pixel", "1,2", "--row", "3"], 2, "cannot be used with"),
        (vec!["explain", "cone", "--pixel", "1,2", "-o", "x.svg"], 2, "--out is only for the chart of a --row"),
        (vec!["explain", "cone", "--row", "200"], 2, "no row 200 in a frame of 200 rows"),
        (vec!["explain", "cone", "--row", "2", "-o", "x.png"], 2, "x.png: the name of a chart must end in .svg"),
        (vec!["explain", "none.obj", "--pixel", "1,2"], 3, "none.obj: No such file"),
        (vec!["explain", "cone", "--row", "2", "-o", "none/x.svg"], 3, "none"),
    ] {
        assert_fails(&run(&directory, &words), status, says);
    }
    assert!(names_in(directory.path()).is_empty());
}

/// Two squares that meet at 90°: with an edge between them, as flat ones have, or without.
#[test]
fn a_crease_angle_is_for_models() {
    let directory = tempfile::tempdir().expect("a directory");
    let bent = "v 0 0 0\nv 0 0 2\nv 2 0 0\nv 2 0 2\nv 2 2 0\nv 2 2 2\nf 1 2 4 3\nf 3 4 6 5\n";
    fs::write(directory.path().join("bent.obj"), bent).expect("written");
    let picture = |name: &str, crease: &[&str]| {
        succeed(&directory, &[&["render", "bent.obj", "-o", name], crease].concat());
        fs::read(directory.path().join(name)).expect("a picture")
    };
    let usual = picture("usual.png", &[]);
    assert!(usual == picture("40.png", &["--crease", "40"]) && usual == picture("0.png", &["--crease", "0"]));
    assert!(usual != picture("180.png", &["--crease", "180"]));
}
