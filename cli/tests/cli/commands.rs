//! The program from its user's point of view: the files it writes, its messages, and its exit status.

mod documents;

use std::collections::BTreeSet;
use std::fs;
use std::io::{Cursor, Write};
use std::process::{Command, ExitStatus, Stdio};

use mode13h::palette::{Rgb, builtin};
use mode13h::plan::Effect;
use mode13h::render::Renderer;
use mode13h::span::Kernel;
use mode13h::vga::Vga;
use mode13h_assets::palette_file;
use mode13h_assets::shipped;
use mode13h_conformance::hash::{START, fnv_1a};
use serde_json::Value;

#[cfg(unix)]
use crate::folder::signalled;
use crate::folder::{Folder, MODE_13H, Png, failed, names_in};
use crate::support::film::{Decoded, decode};
use crate::support::tried::Tried;

#[test]
fn f1_broken_input_is_one_line_with_file_and_place() {
    let mut tried = Tried::new("f1_broken_input_is_one_line_with_file_and_place", 22);
    let folder = Folder::new();
    folder.put("empty.obj", b"");
    folder.put("vertices.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    folder.put("nan.obj", b"v 0 0 0\nv 1 NaN 0\nv 0 1 0\nf 1 2 3\n");
    folder.put("index.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1 2 4\n");
    folder.put("zero.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n");
    folder.put("binary.obj", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x01");
    folder.put("model.3ds", b"solid\n");
    folder.put("broken.pal", b"JASC-PAL\r\n0100\r\n2\r\n0 0 0\r\nred 0 0\r\n");
    folder.put("short.vga", [0; 767]);
    folder.put("empty.gpl", b"");
    fs::create_dir(folder.path("directory.obj")).expect("made");
    let before = folder.names();

    for (words, status, says) in [
        ("render none.obj -o x.png", 1, "none.obj: No such file"),
        ("render directory.obj -o x.png", 1, "directory.obj: is a directory"),
        ("render . -o x.png", 1, ".: is a directory"),
        ("render empty.obj -o x.png", 2, "empty.obj: no faces"),
        ("render vertices.obj -o x.png", 2, "vertices.obj: no faces"),
        ("render nan.obj -o x.png", 2, "nan.obj:2: `NaN`"),
        ("render index.obj -o x.png", 2, "index.obj:5: there is no vertex 4"),
        ("render zero.obj -o x.png", 2, "zero.obj:4: index 0"),
        ("render binary.obj -o x.png", 2, "binary.obj"),
        (
            "render model.3ds -o x.png",
            2,
            "model.3ds: unknown kind of file: models are .obj, .stl, .ply, .gltf and .glb files, scenes .toml",
        ),
        ("render toroid -o x.png", 2, "toroid: no such file, scene or shape (mode13h list scenes shows the names)"),
        ("render '' -o x.png", 2, "mode13h: '': empty value (mode13h render --help"),
        ("render cube -o x.png --palette ''", 2, "mode13h: --palette '': empty value"),
        ("''", 2, "mode13h: '': empty value"),
        ("scenes copy ''", 2, "mode13h: '': empty value"),
        ("render torus --palette=", 2, "mode13h: --palette=: empty value"),
        ("render cube -o x.png --palette broken.pal", 2, "broken.pal: line 5"),
        ("render cube -o x.png --palette short.vga", 2, "short.vga: "),
        ("render cube -o x.png --palette empty.gpl", 2, "empty.gpl: "),
        (
            "render cube -o x.png --palette none.pal",
            1,
            "none.pal: no such file or built-in palette; built-in palettes are grey",
        ),
        ("render cube -o x.png --palette .", 1, ".: is a directory"),
        ("palette broken.pal", 2, "broken.pal: line 5"),
        ("palette mauve", 2, "mauve: no such file or built-in palette; built-in palettes are grey"),
        ("palette auto", 2, "auto is a palette made for a model; mode13h palette --from MODEL"),
        ("generate", 2, "mode13h generate completions SHELL prints completions"),
        ("scenes copy", 2, "(mode13h scenes copy --help shows the options)"),
        ("generate man -o nan.obj", 1, "nan.obj: is not a directory"),
        ("render cube -o x.png --palette coper", 2, "coper: no such file or built-in palette; did you mean copper?"),
        ("demo nan.obj", 2, "nan.obj:2: "),
        ("nan.obj", 2, "nan.obj:2: "),
        ("none.obj", 1, "none.obj: No such file"),
        ("plan nan.obj", 2, "nan.obj:2: "),
    ] {
        folder.fails(words, status, says);
        tried.add(1);
    }
    assert_eq!(folder.names(), before);
    tried.add(1);
}

#[test]
fn wrong_words_end_with_2() {
    let folder = Folder::new();
    for (words, says) in [
        ("render", "<INPUT>"),
        ("render torus -o x.png --kernel mmx", "no such kernel; this machine has portable"),
        ("--kernel mmx", "no such kernel; this machine has portable"),
        ("render torus -o x.png --shading mirror", "[possible values: flat, gouraud-vintage, gouraud-8.8, "),
        ("render torus -o x.tif", "x.tif: not a format that can be written"),
        ("render torus -o x", "x: "),
        (
            "render torus -o a.mp4",
            "a.mp4: animations are .gif or .apng; for others pipe the frames: `-o - | ffmpeg -i - -pix_fmt yuv420p a.mp4`",
        ),
        ("render torus -o a.mp4 --fps 30", "`-o - | ffmpeg -i - -pix_fmt yuv420p a.mp4`"),
        ("render torus -o x.png --frames 2", "x.png: a series of pictures needs"),
        ("render torus -o x%d.png --frames 0", "--frames"),
        ("render torus -o x%d.png --threads 0", "--threads"),
        ("render torus -o x.png --scale 3", "a scale is 1, 2, 5x6"),
        ("render torus -o x.png --scale 16385x1", "a scale is 1, 2, 5x6"),
        ("render torus -o x.png --turn NaN", "--turn"),
        ("render torus -o x%d.png --frames 4 --turn 1e308", "not a number from -1000000000 to 1000000000"),
        ("render torus -o x%d.png --frames 4 --fps 1e-320", "not a number from 0.001 to 1000000"),
        ("cost - --instructions", "-: --instructions reads the input a second time, so it must be a file"),
        ("render torus -o x.png --time inf", "--time"),
        ("render torus -o x.png --time soon", "--time"),
        ("render torus -o x.png --zoom 0", "not a number from 0.001 to 1000"),
        ("render torus -o x.png --zoom nan", "not a number from 0.001 to 1000"),
        ("render torus -o x.png --zoom -1", "'-1' for '--zoom <FACTOR>': not a number from"),
        ("render torus -o x.png --max-error -1", "'-1' for '--max-error <E>': not a"),
        (
            "render torus -o x.png --frames -1",
            "'-1' for '--frames <N>': not a whole number from 1 to 1000000 (mode13h render --help",
        ),
        ("render torus --frames two", "'two' for '--frames <N>': not a whole number (mode13h"),
        ("explain torus --row -1", "'-1' for '--row <Y>': not a whole number from 0 to 4294967295"),
        ("verify --seed -1", "'-1' for '--seed <N>': not a whole number of at least 0"),
        ("render torus --zoom 1 --zoom 2", "'--zoom <FACTOR>' is given twice (mode13h render"),
        ("explain torus --pixel -1,2", "'-1,2' for '--pixel <X,Y>': not two whole numbers"),
        ("render torus -o x.png --background #fff", "#fff: a colour has six digits: '#ffffff'"),
        ("render torus -o x.png --background #a0G", "neither a colour such as '#203040'"),
        ("render torus -o x.png --camera 1,2", "\"1,2\" is not a point: three numbers"),
        ("render torus -o x.png --camera 1,2,3:inf,0,0", "\"inf,0,0\" is not a point"),
        ("render torus -o x.png --camera -1,2,3:-1,2,3", "EYE and TARGET are the same point"),
        ("render torus -o x.png --background 256", "neither a colour such as '#203040' nor an entry"),
        ("render torus -o x.png --background #12345", "neither a colour"),
        ("render torus -o x.png --dither maybe", "[possible values: ordered, blue-noise, ps1]"),
        ("render -o x.png --dither torus", "[possible values: ordered, blue-noise, ps1]"),
        ("render torus --dither ordered --no-dither", "cannot be used with"),
        ("render torus --mipmaps --no-mipmaps", "cannot be used with"),
        ("render torus --size 640", "not a size such as 640x400, with sides from 1 to 4096"),
        ("render torus --size 0x9", "not a size such as 640x400"),
        ("render torus --size 4097x9", "not a size such as 640x400"),
        ("render cube --size 4096x4096 --scale 5x6 -o x.png", "x.png: "),
        ("render cube --size 4096x4096 --scale 5x6 -o x.gif", "x.gif: "),
        ("render torus --size 64x64 --max-time 9", "cannot be used with"),
        ("cost torus --open --json", "cannot be used with"),
        ("list", "<WHAT>"),
        ("list colours", "[possible values: shadings, palettes, kernels, scenes]"),
        ("palette", "`mode13h list palettes` shows the built-in ones"),
        ("scenes", "`mode13h list scenes` lists the scenes"),
        ("render torus -o x.png --fps 0", "--fps"),
        ("render torus -o x.png --turn 9 --fps 9", "x.png: both --turn and --fps"),
        ("render torus -o x.png --up x", "--up"),
        ("render torus -o x.gif --rgb", "x.gif: --rgb is for .png"),
        ("render torus -o x%04d.gif", "x%04d.gif: an animation is one file"),
        ("render torus -o x.gif --fps 60", "x.gif: an animation shows 0.1 to 50 frames a second, not 60"),
        ("render torus -o x.gif --fps 0.05", "x.gif: an animation shows 0.1 to 50 frames a second"),
        ("render torus -o x.gif --frames 0", "--frames"),
        ("render torus -o x%d-%04d.png", "x%d-%04d.png: a name can hold one number"),
        ("render torus -o x%d%d.png --frames 2", "x%d%d.png: a name can hold one number"),
        ("render torus -o x.apng --rgb", "x.apng: --rgb is for .png"),
        ("render torus -o x%d.apng", "x%d.apng: an animation is one file"),
        ("render torus -o - --fps 60", "-: an animation shows 0.1 to 50 frames a second, not 60"),
        ("palette grey -o x.txt", "x.txt: "),
        ("render torus -o x.png --up z", "--up is for models"),
        ("render torus -o x.png --crease 30", "--crease is for models"),
        ("plan sphere --crease 181", "--crease"),
        ("cost sphere --crease NaN", "--crease"),
        ("explain sphere --row 9 --crease -1", "--crease"),
        ("render torus -o x.png --mapping best", "[possible values: affine, every-16, perspective]"),
        ("render torus -o x.png --arithmetic best", "[possible values: float, fixed]"),
        ("demo torus --hidden-surfaces best", "[possible values: back-faces, painter, "),
        ("scenes copy -o x.toml", "<NAME>"),
        ("verify --xml", "(mode13h verify --help shows"),
        ("render --xml", "(mode13h render --help shows"),
        ("--xml", "(mode13h --help shows"),
        ("torus --xml", "(mode13h --help shows"),
        ("torus verify", "verify is a command and goes before INPUT"),
        ("plan", "<INPUT>"),
        ("plan torus --time inf", "invalid value 'inf' for '--time <SECONDS>': not a number (mode13h plan --help "),
        ("plan torus --time", "a value is required for '--time <SECONDS>' but none was supplied (mode13h plan --help "),
        ("demo torus --time soon", "--time"),
        ("plan torus --shading mirror", "[possible values: flat, gouraud-vintage, gouraud-8.8, "),
    ] {
        folder.fails(words, 2, says);
    }
    let output = folder.program("render torus -o x.png").env("MODE13H_KERNEL", "mmx").output().expect("started");
    failed(&output, 2, "MODE13H_KERNEL=mmx: no such kernel; this machine has portable");
    assert!(folder.names().is_empty());
}

#[test]
fn f4_what_cannot_be_written_is_one_line_and_leaves_nothing_behind() {
    let mut tried = Tried::new("f4_what_cannot_be_written_is_one_line_and_leaves_nothing_behind", 5);
    let folder = Folder::new();
    fs::create_dir(folder.path("x.png")).expect("made");
    for (words, says) in [
        ("render torus -o none/%04d.png", "none/0000.png: the directory none does not exist"),
        ("render torus -o x.png", "x.png: is a directory"),
        ("render torus -o none/%d.png --frames 9", "none does not exist"),
    ] {
        folder.fails(words, 1, says);
        tried.add(1);
    }
    assert_eq!(folder.names(), ["x.png"]);
    assert!(names_in(&folder.path("x.png")).is_empty());
    tried.add(2);
}

#[cfg(target_os = "linux")]
#[test]
fn f4_a_picture_that_no_longer_fits_leaves_the_old_one_whole() {
    let mut tried = Tried::new("f4_a_picture_that_no_longer_fits_leaves_the_old_one_whole", 3);
    // In one block the picture does not fit.
    assert_old_one_is_whole("x.png", 1);
    tried.add(3);
}

/// Where files can only grow to this many blocks, a picture or animation that needs more leaves the existing file
/// untouched, and no other file behind.
#[cfg(target_os = "linux")]
#[track_caller]
fn assert_old_one_is_whole(name: &str, blocks: usize) {
    let folder = Folder::new();
    folder.put(name, "what stood there");
    failed(&folder.run_with_room(blocks, &format!("render torus -o {name}")), 1, &format!("{name}: "));
    assert_eq!(folder.read(name), b"what stood there");
    assert_eq!(folder.names(), [name]);
}

#[cfg(target_os = "linux")]
#[test]
fn what_standard_error_does_not_take_ends_nothing() {
    let folder = Folder::new();
    for (words, code) in [("render torus -o %d.png --frames 3 --stats", 0), ("list nothing", 2)] {
        let full = fs::File::options().write(true).open("/dev/full").expect("opened");
        let status = folder.program(words).stderr(full).status().expect("started");
        assert_eq!(status.code(), Some(code), "{words}");
    }
    assert_eq!(folder.names(), ["0.png", "1.png", "2.png"]);
}

#[cfg(unix)]
#[test]
fn f4_an_interrupted_row_is_made_of_whole_pictures() {
    let mut tried = Tried::new("f4_an_interrupted_row_is_made_of_whole_pictures", 20);
    let folder = Folder::new();
    let mut child = folder
        .program("render torus -o %06d.png --frames 100000 --scale 2")
        .stderr(Stdio::piped())
        .spawn()
        .expect("started");
    while folder.names().iter().filter(|name| !name.starts_with('.')).count() < 20 {
        assert!(child.try_wait().expect("waited").is_none(), "ended by itself");
        tried.add(1);
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    failed(&signalled(child, "-INT"), 130, "interrupted");
    tried.add(2);
    for name in folder.names() {
        assert!(name.ends_with(".png") && !name.starts_with('.'), "{name} is left");
        let bytes = folder.read(&name);
        assert_eq!(&bytes[bytes.len() - 8..][..4], b"IEND", "{name} is not whole");
        tried.add(2);
    }
}

#[test]
fn a_picture_is_indexed_320_by_200_with_the_shape_of_its_pixels() {
    let folder = Folder::new();
    folder.succeed("render torus -o x.png --palette copper");
    assert_eq!(folder.names(), ["x.png"]);
    let png = folder.png("x.png");
    assert_eq!(png.shape(), MODE_13H);
    assert_eq!(png.palette, builtin::by_name("copper").expect("a built-in").palette.on_dac().colors());
    let used: BTreeSet<u8> = png.pixels.into_iter().collect();
    assert!(used.len() > 60, "a smooth picture has many shades");
}

#[test]
fn pictures_are_enlarged_and_in_true_color_when_asked_for() {
    let folder = Folder::new();
    let indexed = png::ColorType::Indexed;
    let rgb = png::ColorType::Rgb;
    for (words, expected) in [
        ("--scale 1", ((320, 200), indexed, Some((6, 5)))),
        ("--scale 2", ((640, 400), indexed, Some((6, 5)))),
        ("--scale 5x6", ((1600, 1200), indexed, Some((1, 1)))),
        ("--scale 640x480", ((640, 480), indexed, Some((1, 1)))),
        ("--rgb", ((1600, 1200), rgb, Some((1, 1)))),
        ("--rgb --scale 1", ((320, 200), rgb, Some((6, 5)))),
    ] {
        folder.succeed(&format!("render cube -o x.png {words}"));
        assert_eq!(folder.png("x.png").shape(), expected, "{words}");
    }
}

#[test]
fn every_kernel_gives_the_same_bytes_and_is_named() {
    let folder = Folder::new();
    let expected = folder.picture("torus");
    let mut tried = 0;
    for kernel in Kernel::available() {
        for by_environment in [false, true] {
            let mut command = folder.program("render torus -o x.png --stats");
            if by_environment {
                command.env("MODE13H_KERNEL", kernel.name());
            } else {
                // The option overrides the environment variable.
                command.args(["--kernel", kernel.name()]).env("MODE13H_KERNEL", "mmx");
            }
            let output = command.output().expect("started");
            assert!(output.status.success(), "{output:?}");
            let said = String::from_utf8(output.stderr).expect("text");
            assert!(said.contains(&format!("kernel {},", kernel.name())) && said.lines().count() == 1, "{said}");
            assert!(folder.read("x.png") == expected, "{} draws other bytes", kernel.name());
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
            let folder = Folder::new();
            let words = &format!("render torus -o x%04d.png --frames 8 --turn 360 --threads {threads}");
            folder.succeed(words);
            assert_eq!(folder.names(), names);
            names.iter().map(|name| folder.read(name)).collect()
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
    let folder = Folder::new();
    folder.succeed("render teapot -o turn%d.png --frames 4 --turn 360");
    assert_eq!(folder.read("turn1.png"), folder.picture("teapot --turn 90"));

    folder.succeed("render teapot -o time%d.png --frames 3 --fps 2 --time 7");
    let alone = folder.picture("teapot --time 8");
    assert!(folder.read("time2.png") == alone && folder.read("time0.png") != alone);
    tried.add(3);
}

/// Renders an animation. Returns the line that was printed, and the file.
#[track_caller]
fn film(folder: &Folder, words: &str) -> (String, Decoded) {
    let line = folder.printed(&format!("render -o x.gif {words}"));
    assert_eq!(line.find('\n'), Some(line.len() - 1), "more than one line: {line}");
    (line, decode(&folder.read("x.gif")))
}

#[test]
fn a_film_is_one_turn_of_four_seconds_in_the_shape_of_the_screen() {
    let folder = Folder::new();
    let (line, film) = film(&folder, "cube");
    assert_eq!(folder.names(), ["x.gif"]);
    let bytes = folder.read("x.gif").len();
    let figures = "640 x 480 pixels, 140 frames, 4.00 s, delays 120 x 30 ms + 20 x 20 ms";
    assert_eq!(line, format!("x.gif: {figures}, {bytes} bytes\n"));
    assert_eq!((film.width, film.height, film.images.len()), (640, 480, 140));
    for (i, image) in film.images.iter().enumerate() {
        assert_eq!(image.delay, if i % 7 == 6 { 2 } else { 3 }, "image {i}");
    }
}

#[test]
fn a_film_is_as_long_fast_large_and_colorful_as_asked_for() {
    let folder = Folder::new();
    for (words, size, frames, hundredths) in [
        ("--fps 10", (640, 480), 40, 400),
        ("--fps 50 --frames 4", (640, 480), 4, 8),
        ("--frames 3 --scale 1", (320, 200), 3, 9),
        ("--frames 1 --scale 5x6", (1600, 1200), 1, 3),
        ("--frames 5 --scale 33x44 --palette copper", (33, 44), 5, 15),
    ] {
        let (line, film) = film(&folder, &format!("sphere {words}"));
        assert_eq!((film.width, film.height, film.images.len()), (size.0, size.1, frames), "{words:?}");
        assert_eq!(film.images.iter().map(|image| image.delay).sum::<u64>(), hundredths, "{words:?}");
        // A shape without colours of its own is grey.
        let palette = if words.contains("copper") { "copper" } else { "grey" };
        let palette = builtin::by_name(palette).expect("a built-in").palette.on_dac();
        // Each colour once, filled up with black to a power of two.
        let all = palette.colors();
        let different: Vec<Rgb> = (0..256).filter(|&i| !all[..i].contains(&all[i])).map(|i| all[i]).collect();
        let (colors, rest) = film.palette.split_at(different.len());
        assert!(colors == different && rest.iter().all(|color| *color == Rgb::BLACK));
        let said = format!(": {} x {} pixels, {frames} frame", size.0, size.1);
        assert!(line.contains(&said), "{line}");
    }
    let (line, film) = film(&folder, "teapot --turn 0 --fps 20");
    assert!(line.contains("80 frames in 1 image, 4.00 s, delays 1 x 4000 ms,"), "{line}");
    assert_eq!((film.images.len(), film.images[0].delay), (1, 400));
}

#[test]
fn a_film_shows_the_frames_of_the_row_of_pictures() {
    let folder = Folder::new();
    let look = "--scale 333x222 --palette copper --frames 9";
    for (of_film, of_row) in
        [("", "--turn 360"), ("--turn -40 --time 0.7", "--turn -40 --time 0.7"), ("--fps 12", "--turn 360")]
    {
        folder.succeed(&format!("render torus -o x%d.png {look} {of_row}"));
        let (_, film) = film(&folder, &format!("torus {look} {of_film}"));
        assert_eq!(film.images.len(), 9);
        for (i, image) in film.images.iter().enumerate() {
            assert!(image.shown == folder.png(&format!("x{i}.png")).colors(), "frame {i} of {of_film:?}");
        }
    }
}

/// Animations of every shipped scene, and one with a budget, have the same bytes with 1, 2, 3 and 7 threads. Among them
/// are fog, textures and fading palettes, whose state in one thread must not depend on another's.
#[test]
fn films_are_the_same_whatever_the_number_of_threads() {
    const FRAMES: &str = "9";
    let looks: Vec<(&str, &str)> = shipped::ALL
        .iter()
        .map(|scene| (scene.name, ""))
        .chain(["torus", "fog", "rgb"].map(|name| (name, "--max-error 4")))
        .collect();
    let mut tried = Tried::new("films_are_the_same_whatever_the_number_of_threads", 3 * looks.len() as u64);
    let (mut fades, mut textures, mut fogs) = (0, 0, 0);
    for (name, look) in looks {
        let folder = Folder::new();
        let [one, more @ ..] = ["1", "2", "3", "7"].map(|threads| {
            let (_, film) = film(&folder, &format!("{name} --frames {FRAMES} --scale 1 --threads {threads} {look}"));
            (film, folder.read("x.gif"))
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

/// An animation long enough for each thread to draw many frames.
#[test]
fn a_film_of_many_frames_is_the_same_whatever_the_number_of_threads() {
    let folder = Folder::new();
    let films = ["1", "7"].map(|threads| {
        film(&folder, &format!("fade --frames 61 --scale 1 --threads {threads}"));
        folder.read("x.gif")
    });
    assert!(films[0] == films[1]);
}

/// The peak memory, in KiB, of the program while it writes an animation.
#[cfg(target_os = "linux")]
fn peak_of_a_film(frames: u32) -> u64 {
    let folder = Folder::new();
    // The camera circles the cube: a small picture that changes.
    let words = format!("render cube -o x.gif --scale 1 --threads 2 --frames {frames}");
    let mut child = folder.program(&words).stdout(Stdio::null()).spawn().expect("started");
    let status = format!("/proc/{}/status", child.id());
    let mut peak = 0;
    while child.try_wait().expect("a child").is_none() {
        // A program that has just ended has no status. The peak never falls, so the last one read is that of the whole
        // film, except for the last moments.
        let status = fs::read_to_string(&status).unwrap_or_default();
        let most = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().split(' ').next()?.parse().ok());
        peak = most.unwrap_or(0).max(peak);
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert!(child.wait().expect("a child").success());
    // At 35 frames a second; unchanged frames are merged into one image that stays as long.
    assert_eq!(hundredths_of(&folder.read("x.gif")), (100 * u64::from(frames)).div_ceil(35), "the film's length");
    peak
}

/// The duration of an animation in 1/100 s, read image by image.
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

/// An animation of any length takes as much memory as a short one: 32 frames per thread are pending, each of 64,000
/// bytes and as much again while it is made. Keeping the additional frames compared here would take ten times that.
#[cfg(target_os = "linux")]
fn films_of(tried: &mut Tried, frames: u32) {
    const MIB: u64 = 1024;
    let (short, long) = (peak_of_a_film(200), peak_of_a_film(frames));
    tried.worst("MiB for the short film", short as f64 / 1024.0);
    tried.worst("MiB for the long film", long as f64 / 1024.0);
    assert!(short > MIB, "{short} KiB were read");
    // How full the two lists of 64 frames are at the same time, and how much freed memory the allocator keeps, is
    // chance; both lists together take 8 MiB. An animation of 2,000 frames that is kept whole takes 122.
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

/// The frames of an animated PNG as displayed, in colours.
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

/// The three animation formats show the same, for a scene that moves and for one whose palette fades.
#[test]
fn films_of_all_kinds_show_the_same() {
    let folder = Folder::new();
    for (scene, colors) in [("cube", "indexed"), ("fade", "true colour, as the palette changes")] {
        let words = |out| format!("render {scene} -o {out} --frames 6 --scale 64x48");
        assert!(folder.run(&words("x.gif")).status.success());
        let line = folder.printed(&words("x.apng"));
        let apng = folder.read("x.apng");
        let bytes = apng.len();
        assert_eq!(line, format!("x.apng: 64 x 48 pixels, 6 frames, 0.17 s, {colors}, {bytes} bytes\n"));
        let of_gif: Vec<Vec<Rgb>> = decode(&folder.read("x.gif")).images.into_iter().map(|image| image.shown).collect();
        assert!(of_gif.len() == 6 && shown(&apng) == of_gif, "{scene}");

        let stream = folder.run(&words("-"));
        assert!(stream.status.success() && stream.stderr.is_empty(), "{stream:?}");
        let frames = stream.stdout.strip_prefix(b"YUV4MPEG2 W64 H48 F35:1 Ip A1:1 C444\n").expect("a heading");
        let frames: Vec<&[u8]> = frames.chunks(6 + 3 * 64 * 48).collect();
        assert_eq!(frames.len(), 6);
        for (frame, colors) in frames.into_iter().zip(&of_gif) {
            let planes = frame.strip_prefix(b"FRAME\n").expect("a frame");
            for (i, color) in colors.iter().enumerate() {
                let (r, g, b) = (f64::from(color.r), f64::from(color.g), f64::from(color.b));
                // The luma of ITU-R BT.601; unit tests cover the rest.
                let y = 16.0 + 219.0 * (0.299 * r + 0.587 * g + 0.114 * b) / 255.0;
                assert!((f64::from(planes[i]) - y).abs() <= 0.5 + 0.0015, "{color:?}: {}", planes[i]);
            }
        }
    }
}

/// A model and a scene with every kind of file that they may name. Every command that writes tries to overwrite each of
/// these, under its own name, through links of both kinds, and as one of a numbered series.
#[cfg(unix)]
#[test]
fn f4_what_was_read_is_never_overwritten() {
    let mut tried = Tried::new("f4_what_was_read_is_never_overwritten", 29);
    let folder = Folder::new();
    let path = |name: &str| folder.path(name);
    for name in ["box.png", "row3.png", "around.png"] {
        folder.succeed(&format!("render cube -o {name}"));
    }
    folder.put("box.mtl", "newmtl tin\nmap_Kd box.png\nnewmtl wood\nmap_Kd row3.png\n");
    let face = "f 1/1 2/1 3/1\n";
    let faces = format!("usemtl tin\n{face}usemtl wood\n{face}");
    folder.put("box.obj", format!("mtllib box.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n{faces}"));
    // Without texture coordinates no texture is read, but it still belongs to the model.
    folder.put("bare.obj", "mtllib box.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl tin\nf 1 2 3\n");
    folder.succeed("palette grey -o own.gpl");
    folder.succeed("palette copper -o faded.pal");
    folder.put(
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

    let absolute = path("box.png");
    let absolute = absolute.to_str().expect("text");
    let mut all: Vec<String> = Vec::new();
    for input in ["box.obj", "scene.toml"] {
        for out in ["box.png", "./box.png", "study/../box.png", absolute, "link.png", "hard.png", "row3.png"] {
            all.push(format!("render {input} -o {out}"));
        }
        for out in ["link.gif", "link.apng"] {
            all.push(format!("render {input} -o {out} --frames 2"));
        }
        all.push(format!("render {input} -o row%d.png --frames 5"));
    }
    all.extend(
        [
            "render scene.toml -o around.png",
            "render bare.obj -o box.png",
            "palette own.gpl -o own.gpl",
            "palette --from box.obj -o box.png",
            "explain scene.toml --row 5 -o link.svg",
            "cost scene.toml -o study",
            "cost box.obj -o of-model",
        ]
        .map(String::from),
    );
    for (name, target) in [("link.exe", "box.obj"), ("link.img", "scene.toml")] {
        std::os::unix::fs::symlink(target, path(name)).expect("a link");
        all.push(format!("dos {target} -o {name} --frames 1"));
    }
    let names = folder.names();
    let before: Vec<Option<Vec<u8>>> = names.iter().map(|name| fs::read(path(name)).ok()).collect();
    for words in all {
        folder.fails(&words, 2, "will not be overwritten");
        tried.add(1);
    }
    assert_eq!(folder.names(), names);
    for (name, before) in names.iter().zip(before) {
        assert!(fs::read(path(name)).ok() == before, "{name}");
    }
    // Files that were not read may be overwritten, as always.
    folder.succeed("render cube -o box.png");
}

/// Options that the 16.16 path ignores are named.
#[test]
fn options_that_16_16_ignores_are_named() {
    let folder = Folder::new();
    let render = "render torus --arithmetic fixed -q -o x.png --force";
    for (words, ignored) in [
        ("--shading phong", "--shading phong"),
        ("--max-error 1", "--max-error"),
        ("--max-error 1 --max-time 5", "--max-error, --max-time"),
        ("--shading gouraud-16.16", ""),
    ] {
        let said = folder.run(&format!("{render} {words}"));
        let line = format!("mode13h: ignored, because vertices are computed in 16.16: {ignored}\n");
        assert!(said.status.success(), "{words}");
        assert_eq!(String::from_utf8_lossy(&said.stderr), if ignored.is_empty() { "" } else { &line }, "{words}");
    }
}

/// A command writes only files of its own kind, and never overwrites another file that it has written itself.
#[test]
fn f4_what_is_of_another_kind_is_not_overwritten() {
    let mut tried = Tried::new("f4_what_is_of_another_kind_is_not_overwritten", 5);
    let folder = Folder::new();
    for name in ["house.obj", "house.mtl", "report.html", "Cargo.toml"] {
        folder.put(name, "what stood there");
    }
    // The integer path has no budgets, so the status does not depend on the clock.
    let cost = "cost cube --frames 1 --seconds 0 --arithmetic fixed -o";
    for (words, status, line) in [
        ("dos cube -o house.obj", 2, "house.obj: the name of a DOS program must end in .exe, that of a floppy in .img"),
        ("dos cube -o house", 2, "must end in .exe"),
        ("scenes copy torus -o house.obj", 2, "house.obj: the name of a scene file must end in .toml"),
        (&format!("{cost} ."), 1, "report.html: already exists and is not part of a study"),
    ] {
        folder.fails(words, status, line);
        tried.add(1);
    }
    for name in ["house.obj", "house.mtl", "report.html", "Cargo.toml"] {
        assert_eq!(folder.read(name), b"what stood there", "{name}");
    }
    // A study replaces an earlier one.
    for _ in 0..2 {
        folder.said(&format!("{cost} study"));
    }
    tried.add(1);
}

/// Runs a command with these bytes on its standard input.
fn fed(command: &mut Command, bytes: &[u8]) -> ExitStatus {
    let mut child = command.stdin(Stdio::piped()).spawn().expect("started");
    child.stdin.take().expect("a pipe").write_all(bytes).expect("read");
    child.wait().expect("ended")
}

/// A model or scene read from a pipe, or gzipped, gives the same picture. Files that it names are found beside it, or
/// in the current directory.
#[test]
fn input_comes_by_a_pipe_or_packed() {
    use flate2::Compression;
    use flate2::write::GzEncoder;

    let folder = Folder::new();
    let model = "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let scene = "palette = 'copper'\n[[objects]]\nmodel = 'a.obj'\n[[lights]]\nsun = [0, 0, 1]\n";
    folder.put("a.mtl", b"newmtl a\nKd 0.9 0.2 0.1\n");
    let pack = |bytes: &[u8]| {
        let mut packed = GzEncoder::new(Vec::new(), Compression::default());
        packed.write_all(bytes).expect("packed");
        packed.finish().expect("packed")
    };
    for (name, text) in [("a.obj", model), ("s.toml", scene)] {
        folder.put(name, text.as_bytes());
        let packed = pack(text.as_bytes());
        folder.put(&format!("{name}.gz"), &packed);
        let plain = folder.picture(name);
        assert!(folder.picture(&format!("{name}.gz")) == plain, "{name}.gz");
        for (words, bytes) in [("-", text.as_bytes()), ("/dev/stdin", text.as_bytes()), ("-", &packed)] {
            let mut command = folder.program(&format!("render {words} -o piped.png"));
            assert!(fed(&mut command, bytes).success(), "{name} by {words}");
            assert!(folder.read("piped.png") == plain, "{name} by {words}");
        }
    }
    folder.put("broken.obj.gz", b"\x1f\x8b\x08 no");
    folder.fails("render broken.obj.gz -o x.png", 1, "broken.obj.gz: ");
    folder.put("empty.obj.gz", pack(b"v 0 0 0\n"));
    folder.fails("render empty.obj.gz -o x.png", 2, "empty.obj.gz: no faces");
    folder.fails("render none.obj.gz -o x.png", 1, "none.obj.gz: No such file");
    folder.fails("palette --from s.toml.gz", 2, "s.toml.gz: a scene, where a model is needed");
    #[cfg(unix)]
    folder.fails("render /dev/null -o x.png", 2, "/dev/null: not a file; a model or scene in a pipe is read as -");
}

/// Input from a pipe is kept until the program ends: the window shows it again after another input, and when a file that it
/// names has changed.
#[test]
fn standard_input_is_read_once_and_shown_as_often_as_asked_for() {
    let folder = Folder::new();
    let mut command = folder.program("- torus /dev/stdin");
    assert!(fed(command.stderr(Stdio::null()), b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").success());
    assert!(folder.read("mode13h-0001.png") == folder.read("mode13h-0003.png"));
}

/// A model, and a scene that contains it, play an animation of one second: `--time` picks a moment, and an exported
/// animation is one loop.
#[test]
fn an_animation_is_played() {
    let folder = Folder::new();
    let bar = include_bytes!("../../../tests/corpus/gltf/skinned");
    folder.put("bar.glb", bar);
    let scene = "duration = 1\n[[objects]]\nmodel = \"bar.glb\"\n[camera]\neye = [0, 1, 5]\ntarget = [0, 1, 0]\n";
    folder.put("bar.toml", scene);
    for input in ["bar.glb", "bar.toml"] {
        let at = |seconds: &str| folder.picture(&format!("{input} --camera 0,1,5:0,1,0 --time {seconds}"));
        let [start, middle, end, again] = ["0", "0.5", "1", "-0.5"].map(at);
        assert!(start == end && middle == again && start != middle, "{input}");
        let (line, film) = film(&folder, &format!("{input} --fps 10"));
        assert!(line.contains("10 frames"), "{line}");
        assert!(film.images.len() > 1, "{input}");
    }
}

/// A red triangle, and a green one that grows from nothing in a second.
const GROWS: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
    "nodes": [{"mesh": 0, "translation": [-1, 0, 0]}, {"mesh": 1, "translation": [1, 0, 0]}],
    "materials": [
        {"name": "red", "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}},
        {"name": "green", "pbrMetallicRoughness": {"baseColorFactor": [0, 1, 0, 1]}}],
    "meshes": [
        {"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]},
        {"primitives": [{"attributes": {"POSITION": 0}, "material": 1}]}],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
        {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
        {"bufferView": 0, "byteOffset": 44, "componentType": 5126, "count": 2, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 68}],
    "buffers": [{"byteLength": 68, "uri": "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AACAPwAAgD8="}],
    "animations": [{"samplers": [{"input": 1, "output": 2}], "channels": [{"sampler": 0, "target": {"node": 1, "path": "scale"}}]}]}"#;

/// A palette made for a model, or for a scene with one, covers its whole animation, not only the beginning.
#[test]
fn a_palette_is_made_for_an_animation() {
    let folder = Folder::new();
    let growing = "gD8AAAAAAAAAAAAAAAAAAIA/AACAPwAAgD8=";
    folder.put("grows.gltf", GROWS);
    folder.put("shrinks.gltf", GROWS.replace(growing, "gD8AAIA/AACAPwAAgD8AAAAAAAAAAAAAAAA="));
    folder.put("still.gltf", GROWS.replace(growing, "gD8AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA="));
    let entries = |model: &str| -> u32 {
        let text = folder.printed(&format!("palette --from {model}.gltf"));
        let ramp = text.lines().find(|line| line.starts_with("green: a ramp")).expect("a ramp");
        let numbers: Vec<u32> = ramp.split([' ', ',']).filter_map(|word| word.parse().ok()).collect();
        numbers[1] + 1 - numbers[0]
    };
    let [grows, shrinks, still] = ["grows", "shrinks", "still"].map(entries);
    assert!(grows > still && grows.abs_diff(shrinks) < 16, "{grows} {shrinks} {still}");
    for model in ["grows", "shrinks", "still"] {
        let objects = format!("objects = [{{ model = '{model}.gltf' }}]\nlights = [{{ sun = [0, 0, 1] }}]");
        folder.put(&format!("{model}.toml"), format!("palette = 'auto'\nduration = 1\n{objects}"));
    }
    let palette = |scene: &str| Png::decode(&folder.picture(&format!("{scene}.toml"))).palette;
    assert!(palette("grows") != palette("still"));
}

/// A triangle that moves sideways in its first animation, and up in its second.
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
    let folder = Folder::new();
    folder.put("a.gltf", TWO_CLIPS);
    folder.put("a.toml", "[[objects]]\nmodel = \"a.gltf\"\n");
    let picture = |words: &str| folder.picture(&format!("a.gltf --camera 0,0,5 --time 0.5 {words}"));
    let [usual, aside, up] = ["", "--clip Aside", "--clip Up"].map(picture);
    assert!(usual == aside && aside != up);
    assert!(aside == picture("--clip 0") && up == picture("--clip 1"));
    for (input, clip, says) in [
        ("a.gltf", "Down", "--clip: a: no animation Down; the model has 0: Aside, 1: Up"),
        ("a.gltf", "2", "--clip: a: no animation 2; the model has 0: Aside, 1: Up"),
        ("torus.obj", "0", "--clip: torus: it has no animation"),
        ("a.toml", "0", "--clip is for models; in a scene, each model has a key for it"),
    ] {
        folder.put("torus.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        folder.fails(&format!("render {input} -o y.png --clip {clip}"), 2, says);
    }
    assert!(!folder.path("y.png").exists());
}

/// A model's own lights and camera are used, unless the command line sets a view.
#[test]
fn a_model_brings_lights_and_a_camera() {
    let folder = Folder::new();
    let lit = include_bytes!("../../../tests/corpus/gltf/lights_camera");
    folder.put("lit.glb", lit);
    let picture = |words: &str| {
        let said = folder.said(&format!("render lit.glb -o x.png {words}"));
        assert_eq!(said, "mode13h: lit.glb: left out: orthographic cameras\n");
        folder.read("x.png")
    };
    let own = picture("");
    // The file's camera is at (0, 1, 5) and looks along −z; it has its own angle.
    let same_view = picture("--camera 0,1,5:0,1,0");
    let studio = picture("--up y");
    assert!(own != same_view && own != studio && same_view != studio);
}

/// `dos` reports what the DOS program leaves out of a scene.
#[test]
fn dos_says_what_is_left_out() {
    let folder = Folder::new();
    let said = |words: &str| folder.said(&format!("dos {words} -o a.exe --frames 1"));
    assert_eq!(said("torus"), "");
    assert_eq!(
        said("crate"),
        "mode13h: left out, because the program computes in 16.16: perspective, texture, mipmaps\n"
    );
    assert_eq!(
        said("torus --kernel portable --mapping affine --vertex-bits 0"),
        "mode13h: ignored, because the program computes in 16.16: --mapping, --kernel, --vertex-bits\n"
    );
}

/// The DOS program shows what `render` draws in 16.16, in the same colours, automatic palettes included.
#[test]
fn dos_shows_what_render_does() {
    let folder = Folder::new();
    for input in ["torus", "crate", "rgb", "fog --palette auto", "torus --look ps1"] {
        folder.run(&format!("render {input} --arithmetic fixed --time 0 -o x.png"));
        let Png { pixels, palette, .. } = Png::decode(&folder.read("x.png"));
        let dac: Vec<u8> = palette.iter().flat_map(|color| [color.r, color.g, color.b]).map(|c| c >> 2).collect();
        let hash = fnv_1a(fnv_1a(START, &pixels), &dac);
        let said = folder.run(&format!("dos {input} -o a.exe --force --frames 1")).stdout;
        let said = String::from_utf8(said).expect("text");
        assert!(said.ends_with(&format!("1 frame, {hash:016x}\n")), "{input}: {said}");
    }
}

#[test]
fn a_film_has_its_figures() {
    let folder = Folder::new();
    assert_eq!(folder.said("render cube -o x.gif --frames 3 --stats").lines().count(), 3);
    assert_eq!(folder.names(), ["x.gif"]);
}

/// A pipe that nobody reads can be waited for without end, but not after an interruption.
#[cfg(unix)]
#[test]
fn writing_to_a_pipe_that_nobody_reads_is_interrupted() {
    for (words, pipe) in [
        ("render torus -o x.png", "x.png"),
        ("render torus --frames 9 -o x.gif", "x.gif"),
        ("palette grey -o x.gpl", "x.gpl"),
    ] {
        let folder = Folder::new();
        assert!(Command::new("mkfifo").arg(folder.path(pipe)).status().expect("started").success());
        let mut child = folder.program(words).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("started");
        std::thread::sleep(std::time::Duration::from_secs(1));
        assert!(child.try_wait().expect("waited").is_none(), "{words} did not wait");
        let output = signalled(child, "-TERM");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(130), "{words}: {said}");
        assert!(said.ends_with("mode13h: interrupted\n"), "{said}");
        assert_eq!(folder.names(), [pipe]);
    }
    // Nor does standard output keep it, if its reader stops reading.
    let folder = Folder::new();
    let mut child = folder.program("render torus -o - --frames 400");
    let mut child = child.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("started");
    std::thread::sleep(std::time::Duration::from_secs(1));
    let id = child.id().to_string();
    assert!(Command::new("kill").args(["-TERM", &id]).status().expect("started").success());
    // Before anything is read.
    std::thread::sleep(std::time::Duration::from_secs(1));
    let status = child.try_wait().expect("waited");
    let _ = child.kill();
    assert_eq!(status.and_then(|status| status.code()), Some(130), "{status:?}");
}

#[cfg(unix)]
#[test]
fn f4_an_interrupted_film_leaves_nothing_behind() {
    let mut tried = Tried::new("f4_an_interrupted_film_leaves_nothing_behind", 6);
    for (before, signal) in [(None, "-INT"), (Some("what stood there"), "-TERM")] {
        let folder = Folder::new();
        if let Some(before) = before {
            folder.put("x.gif", before);
        }
        let names = folder.names();
        let mut child = folder
            .program("render torus -o x.gif --frames 100000")
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("started");
        // Wait until part of the temporary file has been written.
        let is_begun = |name: &str| {
            let length = fs::metadata(folder.path(name)).map_or(0, |metadata| metadata.len());
            name.starts_with('.') && length > 100_000
        };
        while !folder.names().iter().any(|name| is_begun(name)) {
            assert!(child.try_wait().expect("waited").is_none(), "ended by itself");
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        failed(&signalled(child, signal), 130, "interrupted");
        assert_eq!(folder.names(), names);
        assert_eq!(fs::read_to_string(folder.path("x.gif")).ok().as_deref(), before);
        tried.add(3);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn f4_a_film_that_no_longer_fits_leaves_the_old_one_whole() {
    let mut tried = Tried::new("f4_a_film_that_no_longer_fits_leaves_the_old_one_whole", 3);
    // In 200 blocks of 512 or 1,024 bytes the first frames fit, but the whole animation does not.
    assert_old_one_is_whole("x.gif", 200);
    tried.add(3);
}

/// The near distance that the plan prints is large enough.
#[test]
fn the_near_distance_that_a_plan_names_is_enough() {
    let folder = Folder::new();
    for distance in [2.0, 3.1, 5.7, 9.0, 47.0, 1234.5] {
        let plan = |near: &str| {
            let scene = format!(
                "camera = {{ eye = [0, 0, {distance}], target = [0, 0, 0], near = {near} }}\n[[objects]]\nshape = 'torus'\n"
            );
            folder.put("near.toml", scene);
            let text = folder.printed("plan near.toml");
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
    let folder = Folder::new();
    for scene in shipped::ALL.iter().map(|shipped| shipped.name).chain(["sphere"]) {
        let text = folder.printed(&format!("plan {scene}"));
        // The scene's `picture` moment.
        let at =
            scene.parse::<shipped::Shipped>().map_or(0.0, |shipped| shipped.load().expect("a scene").scene.picture);
        assert!(text.starts_with(&format!("{scene} at {at} s, 1/35 s after the frame before it: ")), "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= 100 && line.trim_end() == line), "{text}");
        assert!(text.contains("making the plan takes "), "{text}");
        for effect in Effect::ALL {
            assert!(text.lines().any(|line| line.starts_with(&format!("  {effect} "))), "{scene}, {effect}: {text}");
        }
    }
    let text = folder.printed("plan torus");
    let row = |effect: &str| -> Vec<&str> {
        let line = text.lines().find(|line| line.split_whitespace().next() == Some(effect)).expect(effect);
        line.split_whitespace().collect()
    };
    assert_eq!(row("hidden-surfaces")[1..], ["on", "depth-buffer", "torus", "is", "not", "convex"]);
    assert_eq!(row("fog")[1..], ["off", "the", "scene", "has", "none"]);
    // Rows that are the same for all objects are printed once.
    let text = folder.printed("plan fog");
    assert_eq!(text.matches("\n  lighting ").count(), 1, "{text}");
    assert_eq!(text.matches("\n  near-clipping ").count(), 13, "{text}");
}

#[test]
fn a_plan_for_programs_is_that_of_the_second_of_two_frames_and_the_same_on_every_run() {
    let folder = Folder::new();
    for shipped in &shipped::ALL {
        for at in [0.0, 1.25] {
            let words = format!("plan {} --json --time {at}", shipped.name);
            let text = folder.printed(&words);
            assert!(
                text == folder.printed(&format!("{words} --kernel portable")),
                "{}: another plan with another kernel",
                shipped.name
            );

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
    let still = folder.printed("plan still --json");
    assert!(still.contains("nothing it depends on changed since the last frame"), "{still}");
}

#[test]
fn a_plan_with_times_has_a_price_for_each_effect() {
    let folder = Folder::new();
    let json = folder.json("plan torus --json --measure");
    let effects = json["objects"][0]["effects"].as_array().expect("a list");
    // The values depend on the load of the machine; a unit test covers what counts as noise.
    assert!(effects.iter().all(|effect| effect["ns_per_frame"].is_u64()), "{effects:#?}");

    // The integer path has no fog, so fog has no price.
    let words = "plan torus --json --measure --arithmetic fixed";
    let json = folder.json(words);
    let effects = json["objects"][0]["effects"].as_array().expect("a list");
    let fog = effects.iter().find(|effect| effect["effect"] == "fog").expect("listed");
    assert!(fog["ns_per_frame"].is_null() && fog["on"] == false, "{fog}");

    let text = folder.printed("plan cube --measure");
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
    assert!(text.contains("drawing the frame takes "), "{text}");
}

#[test]
fn with_no_display_one_frame_is_saved() {
    let folder = Folder::new();
    for (number, words) in [(1, ""), (2, "cube"), (3, "demo cube")] {
        let said = folder.said(words);
        let name = format!("mode13h-{number:04}.png");
        assert!(said.starts_with("mode13h: no display") && said.contains(&name), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
        assert_eq!(folder.png(&name).shape(), MODE_13H);
        // Nothing is overwritten.
        assert_eq!(folder.names().len(), number);
    }
    assert_eq!(folder.read("mode13h-0002.png"), folder.read("mode13h-0003.png"));
    // A scene that begins in the dark is saved at its `picture` moment.
    assert!(folder.run("flash").status.success());
    let bright =
        folder.png("mode13h-0004.png").colors().into_iter().filter(|color| color.brightness() > 60_000).count();
    // At time 0 no pixel is bright.
    assert!(bright > 64_000 / 4, "{bright} pixels");
}

#[test]
fn palettes_are_converted_from_each_format_to_each() {
    let folder = Folder::new();
    // Its colours are exact on the DAC, so that no format rounds them.
    let colors = *builtin::by_name("bios").expect("a built-in").palette.colors();
    let extensions: Vec<&str> = palette_file::FORMATS.iter().flat_map(|format| format.extensions).copied().collect();
    for from in &extensions {
        let first = format!("first.{from}");
        folder.succeed(&format!("palette bios -o {first}"));
        for to in &extensions {
            let second = format!("second.{to}");
            folder.succeed(&format!("palette {first} -o {second}"));
            let palette = palette_file::parse_named(&second, &folder.read(&second)).expect("a palette");
            assert!(palette.colors() == &colors, "{from} to {to}");
        }
    }
    assert!(extensions.len() >= 5);
}

/// `--palette` and a scene's `palette` accept the same indexed pictures, and `palette` converts their palettes.
#[test]
fn a_picture_lends_its_palette() {
    let folder = Folder::new();
    folder.succeed("render crate -o a.png --palette copper");
    folder.put("a.gif", include_bytes!("../../../tests/corpus/texture/gif"));
    folder.put("a.pcx", include_bytes!("../../../tests/corpus/texture/pcx"));
    folder.put("a.aseprite", include_bytes!("../../../tests/corpus/texture/aseprite"));
    folder.put("plain.toml", b"[[objects]]\nshape = \"cube\"\n");
    for picture in ["a.png", "a.gif", "a.pcx", "a.aseprite"] {
        folder.put("asking.toml", format!("palette = \"{picture}\"\n[[objects]]\nshape = \"cube\"\n").as_bytes());
        let due = folder.picture("asking.toml");
        assert!(folder.picture(&format!("plain.toml --palette {picture}")) == due, "{picture}");
        folder.succeed(&format!("palette {picture} -o x.gpl"));
        assert!(folder.picture("plain.toml --palette x.gpl") == due, "{picture}");
    }
    folder.succeed("palette a.png -o x.gpl");
    let copper = &builtin::by_name("copper").expect("built in").palette;
    let palette = palette_file::load(folder.path("x.gpl")).expect("a palette");
    assert!(palette.colors() == copper.on_dac().colors());
    folder.succeed("render cube -o rgb.png --rgb");
    folder.put("cut.png", &folder.read("a.png")[..60]);
    for picture in ["rgb.png", "cut.png"] {
        for words in [&format!("render cube -o y.png --palette {picture}"), &format!("palette {picture}")] {
            folder.fails(words, 2, &format!("{picture}: not a picture that can be read: "));
        }
    }
}

#[test]
fn palettes_are_looked_at() {
    let folder = Folder::new();
    for builtin in &builtin::ALL {
        let text = folder.printed(&format!("palette {}", builtin.name));
        assert!(text.starts_with(&format!("{}: ", builtin.name)), "{text}");
        let shown: Vec<String> =
            text.lines().skip(1).flat_map(|line| line.split_whitespace().skip(1)).map(String::from).collect();
        let colors: Vec<String> = builtin.palette.colors().iter().map(|color| format!("{:06x}", color)).collect();
        assert_eq!(shown, colors, "{}", builtin.name);
    }
    folder.succeed("palette cube -o chart.png");
    assert_eq!(folder.png("chart.png").shape(), ((256, 256), png::ColorType::Indexed, Some((1, 1))));
}

#[test]
fn palettes_are_made_for_models() {
    let folder = Folder::new();
    let house = "data:house.obj";
    folder.succeed(&format!("palette --from {house} -o house.gpl"));
    folder.succeed(&format!("palette --from {house} --up z -o lying.gpl"));
    folder.succeed("palette --from torus -o chart.png");
    let [upright, lying] = ["house.gpl", "lying.gpl"].map(|name| {
        let palette = palette_file::parse_named(name, &folder.read(name)).expect("a palette");
        assert_eq!((palette[0], palette[255]), (Rgb::BLACK, Rgb::WHITE));
        palette
    });
    assert_ne!(upright.colors(), lying.colors(), "other sides are seen");

    let text = folder.printed(&format!("palette --from {house}"));
    assert!(text.starts_with("house: no ramps"), "{text}");
    let surfaces: Vec<&str> =
        text.lines().skip(33).map(|line| line.split(", entries").next().expect("a line")).collect();
    assert_eq!(surfaces, ["grass: a ramp", "bricks: colours of textures", "tiles: a ramp"]);

    // A texture that cannot be read gives a warning, and the surface gets a ramp.
    let output = folder.run("palette --from data:chest.obj");
    assert!(output.status.success(), "{output:?}");
    let warnings = String::from_utf8(output.stderr).expect("text");
    assert_eq!(warnings.lines().count(), 2, "{warnings}");
    assert!(warnings.contains("chest planks.ppm: not a picture that can be read: "), "{warnings}");
    assert!(String::from_utf8(output.stdout).expect("text").contains("wood: a ramp, entries 1 to "));

    folder.fails("palette -o x.pal", 2, "no palette: give FILE|NAME or --from MODEL");
    folder.fails("palette grey --from torus", 2, "--from");
    folder.fails("palette grey --up z", 2, "--up");
    folder.fails("palette grey --crease 9", 2, "--crease");
    folder.fails("palette --from sphere --crease 999", 2, "--crease");
    folder.fails("palette --from none.obj", 1, "none.obj: No such file");
    folder.fails("palette --from torus -o x.txt", 2, "x.txt: ");
}

/// The share of the covered pixels that are more green than red and blue. The background is in the corner.
fn green(png: &Png) -> f64 {
    let covered: Vec<Rgb> =
        png.pixels.iter().zip(png.colors()).filter(|(i, _)| **i != png.pixels[0]).map(|(_, color)| color).collect();
    let is_green =
        |color: &&Rgb| u16::from(color.g) > u16::from(color.r) + 20 && u16::from(color.g) > u16::from(color.b) + 20;
    covered.iter().filter(is_green).count() as f64 / covered.len() as f64
}

#[test]
fn a_model_with_colours_is_shown_in_them() {
    let folder = Folder::new();
    let house = "data:house.obj";
    let picture = |words: &str| Png::decode(&folder.picture(&format!("{house} {words}")));
    let auto = picture("--palette auto");
    assert!(picture("") == auto);
    assert!(green(&auto) > 0.05, "grass");
    // The palette is the one that `palette --from` writes, whatever moment is drawn.
    folder.succeed(&format!("palette --from {house} -o house.gpl"));
    let later = picture("--time 1.5");
    let written = palette_file::parse_named("house.gpl", &folder.read("house.gpl")).expect("a palette");
    assert!(auto.palette == written.colors() && later.palette == written.colors());
    assert!(later != auto);
    // In palettes without ramps, the nearest entries are drawn.
    for palette in ["cube", "bios", "house.gpl"] {
        assert!(green(&picture(&format!("--palette {palette}"))) > 0.05, "{palette}");
    }
    // With ramps, each material has one; the brick texture is there, too.
    let png = picture("--palette materials-8x32");
    assert!(png.palette == builtin::MATERIALS_8X32.on_dac().colors());
    let ramps: Vec<bool> = (0..8).map(|ramp| png.pixels.iter().any(|&pixel| pixel > 0 && pixel / 32 == ramp)).collect();
    assert!(ramps[0] && ramps[2], "grass in the first ramp, tiles in the third");
    assert_eq!(green(&png), 0.0);
    // The 16.16 path has no textures, so the walls get a ramp of their own.
    assert!(green(&picture("--arithmetic fixed")) > 0.05);
    // The window uses the same palette: without a display it saves its first picture, framed for the whole turn as in a
    // series.
    folder.said(house);
    folder.succeed(&format!("render {house} -o row%d.png --frames 2 --turn 360"));
    assert_eq!(folder.png("mode13h-0001.png"), folder.png("row0.png"));

    // Shapes have no colours of their own: they stay grey unless a palette is given.
    assert!(folder.picture("cylinder") == folder.picture("cylinder --palette grey"));
    let auto = Png::decode(&folder.picture("cylinder --palette auto"));
    assert!(auto.colors().into_iter().all(|color| color.r == color.b));

    // If a texture cannot be read, the colours remain, and a warning says so.
    let said = folder.said("render data:chest.obj -o chest.png");
    // A second warning says that the texture's placement is ignored.
    assert_eq!(said.lines().count(), 2);
    assert!(folder.png("chest.png").colors().into_iter().any(|color| color.r > color.b + 40), "wood");
}

/// In a single picture, a model from a file fills nine tenths of the width or height and is centred to within a pixel,
/// from any side; the frames of a series share one camera. Options override the automatic choice.
#[test]
fn a_single_picture_of_a_model_is_framed_as_it_stands() {
    let mut tried = Tried::new("a_single_picture_of_a_model_is_framed_as_it_stands", 12);
    let folder = Folder::new();
    // A low wedge, open below.
    let low = "v -3 0 -2\nv 3 0 -2\nv 3 0 2\nv -3 0 2\nv -3 0.4 0\nv 3 0.4 0\n\
               f 4 3 6 5\nf 2 1 5 6\nf 1 4 5\nf 3 2 6\n";
    folder.put("low.obj", low);
    let picture = |words: &str| Png::decode(&folder.picture(&format!("low.obj {words}")));
    let edges = |words: &str| {
        let pixels = picture(words).pixels;
        let covered = || (0..pixels.len()).filter(|&i| pixels[i] != pixels[0]);
        let [columns, rows]: [Vec<usize>; 2] =
            [covered().map(|i| i % 320).collect(), covered().map(|i| i / 320).collect()];
        [columns.iter().min(), columns.iter().max(), rows.iter().min(), rows.iter().max()]
            .map(|edge| *edge.expect("some"))
    };
    for degrees in 0..12 {
        let turn = (30 * degrees).to_string();
        let [left, right, top, bottom] = edges(&format!("--turn {turn}"));
        assert!(left.abs_diff(319 - right) <= 1 && top.abs_diff(199 - bottom) <= 1, "{turn}");
        assert!(left.abs_diff(16) <= 1 || top.abs_diff(10) <= 1, "{turn}: {left}, {top}");
        tried.add(1);
    }
    let explained = folder.printed("explain low.obj --pixel 160,100 --json");
    let byte = picture("").pixels[100 * 320 + 160];
    assert!(explained.contains(&format!("\"byte\": {byte}")), "{byte}: {explained}");

    let asked = "--background #ffffff --up z";
    assert_eq!(picture(asked).colors()[0], Rgb::WHITE);
    assert_ne!(edges(asked), edges(""));
    assert!(edges("--zoom 0.5")[0] > edges("--zoom 1")[0] + 60);
    assert!(edges("--camera 0,0,99")[0] > 140);
}

#[test]
fn a_scene_may_ask_for_a_palette_made_for_it() {
    let folder = Folder::new();
    let house = crate::support::workspace::root().join("tests/data/house.obj");
    let text = |palette: &str| {
        format!(
            "palette = '{palette}'\nbackground = '#203060'\nlights = [{{ sun = [1, 2, 3] }}]\n\
             objects = [{{ model = '{}', spin = 1, angles = [20, 0, 0] }}, \
             {{ shape = 'sphere', position = [2, 0, 0], material.color = [0.9, 0.1, 0.6] }}]\n",
            house.display()
        )
    };
    folder.put("auto.toml", text("auto"));
    folder.put("cube.toml", text("cube"));
    let auto = folder.picture("auto.toml");
    assert!(auto == folder.picture("cube.toml --palette auto"));
    assert!(folder.picture("auto.toml --palette cube") == folder.picture("cube.toml"));
    let png = Png::decode(&auto);
    let background = png.colors()[0];
    // At most one step of the DAC.
    assert!(background.distance_squared(Rgb::new(0x20, 0x30, 0x60)) <= 3 * 4 * 4, "{background:?}");
    assert!(green(&png) > 0.005, "grass");
    let magenta = |color: Rgb| color.r > 100 && color.b > 60 && color.g < 30;
    assert!(png.colors().into_iter().filter(|color| magenta(*color)).count() > 500, "the sphere");
}

#[test]
fn help_and_version_succeed() {
    let folder = Folder::new();
    for words in ["--help", "-h", "--version", "help render", "palette --help"] {
        assert!(!folder.printed(words).is_empty(), "{words}");
    }
}

#[test]
fn nobody_reading_on_is_no_failure() {
    let folder = Folder::new();
    let mut command = folder.program("palette grey");
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("started");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("waited");
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
}

#[cfg(unix)]
#[test]
fn names_need_not_be_text() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = Folder::new();
    let name = OsStr::from_bytes(b"a\xFF\n.png");
    let output = folder.program("render cube -o").arg(name).output().expect("started");
    assert!(output.status.success(), "{output:?}");
    assert!(folder.path(name).is_file());
    let missing = OsStr::from_bytes(b"line\nend\x1B[2J\xFF.obj");
    let output = folder.program("render -o x.png").arg(missing).output().expect("started");
    failed(&output, 1, "line end [2J");
}

#[test]
fn f3_broken_scenes_are_one_line_with_their_place() {
    let mut tried = Tried::new("f3_broken_scenes_are_one_line_with_their_place", 12);
    let folder = Folder::new();
    folder.put("key.toml", b"[[objects]]\nshape = 'cube'\nmaterial = { shyness = 3 }\n");
    folder.put("type.toml", b"objects = [{ shape = 'cube', scale = 'large' }]\n");
    folder.put("missing.toml", b"[[objects]]\nshape = 'wall'\nmaterial.texture = 'none.png'\n");
    folder.put("model.toml", b"[[objects]]\nmodel = 'nan.obj'\n");
    folder.put("nan.obj", b"v 0 0 0\nv 1 NaN 0\nv 0 1 0\nf 1 2 3\n");
    folder.put("no.toml", b"name = 'nothing'\n");
    folder.put("syntax.toml", b"name = \n");
    folder.put("binary.toml", b"\x89PNG\r\n\x1a\n\0");
    folder.put("control.toml", b"objects = [{ shape = \"\x5cu001b[2J\" }]\n");
    fs::create_dir(folder.path("directory.toml")).expect("made");
    let before = folder.names();
    for (input, status, says) in [
        ("key.toml", 2, "key.toml:3:14: key `objects[0].material.shyness`: unknown key; known are ambient, "),
        (
            "type.toml",
            2,
            "type.toml:1:38: key `objects[0].scale`: expected a number above 0, or three in a list, found string",
        ),
        ("missing.toml", 1, "missing.toml:3:20: key `objects[0].material.texture`: none.png: No such file"),
        ("model.toml", 2, "model.toml:2:9: key `objects[0].model`: nan.obj:2: `NaN`"),
        ("no.toml", 2, "no.toml: no object: a scene needs at least one"),
        ("syntax.toml", 2, "syntax.toml:1:8: not TOML: "),
        ("binary.toml", 2, "binary.toml:1:1: not UTF-8 text"),
        ("control.toml", 2, "control.toml:1:22: key `objects[0].shape`: "),
        ("directory.toml", 1, "directory.toml: is a directory"),
        ("none.toml", 1, "none.toml: No such file"),
    ] {
        folder.fails(&format!("render {input} -o x.png"), status, says);
        tried.add(1);
    }
    folder.fails("key.toml", 2, "key.toml:3:14: ");
    tried.add(1);
    assert_eq!(folder.names(), before);
    tried.add(1);
}

#[test]
fn scenes_are_listed_and_copied_and_nothing_is_overwritten() {
    let folder = Folder::new();
    let list = folder.printed("list scenes");
    let shapes = list.lines().skip(shipped::ALL.len()).collect::<Vec<_>>().join(" ");
    assert_eq!(shapes, format!(" shapes: {}", mode13h::mesh::shapes::NAMES.join(", ")));
    for (line, scene) in list.lines().zip(&shipped::ALL) {
        let (name, shows) = line.split_once(' ').expect("two columns");
        assert_eq!((name, shows.trim_start()), (scene.name, scene.shows()));
    }
    folder.succeed("scenes copy fog");
    folder.succeed("scenes copy fog -o other.toml");
    assert_eq!(folder.names(), ["fog.toml", "other.toml"]);
    let text = "fog".parse::<shipped::Shipped>().expect("a scene").text;
    assert!(folder.read("fog.toml") == text.as_bytes() && folder.read("other.toml") == text.as_bytes());
    folder.put("fog.toml", "what stood there");
    folder.fails("scenes copy fog", 1, "fog.toml: already exists; --force");
    assert_eq!(folder.read("fog.toml"), b"what stood there");
    folder.fails("scenes copy fog -o none/x.toml", 1, "none does not exist");
    // A copy draws the same as the scene.
    assert!(folder.picture("other.toml --time 1") == folder.picture("fog --time 1"));
}

#[test]
fn every_shipped_scene_is_drawn_and_a_scene_comes_before_a_shape() {
    let folder = Folder::new();
    for scene in &shipped::ALL {
        let png = Png::decode(&folder.picture(&format!("{} --time 1.5", scene.name)));
        assert_eq!(png.size, (320, 200), "{}", scene.name);
    }
    // The name stands for the scene `teapot` with its own palette, not for the shape.
    assert_eq!(Png::decode(&folder.picture("teapot")).palette[200], builtin::COPPER.on_dac()[200]);
}

/// Options of the command line override the scene.
#[test]
fn words_have_the_last_word_over_a_scene() {
    let folder = Folder::new();
    let stats = |words: &str| (folder.said(&format!("render {words} -o x.png --stats")), folder.read("x.png"));
    let (said, own) = stats("phong");
    assert!(said.contains(": phong, float vertices,"), "{said}");
    let (said, _) = stats("phong --shading flat --hidden-surfaces scan-line --arithmetic fixed");
    assert!(said.contains(": flat, fixed vertices,") && said.contains(" scan-line: "), "{said}");
    // With an error budget, the shadings that faces got are counted, and no others are listed.
    let (said, _) = stats("phong --max-error 4");
    assert!(said.contains(": within 4 shades (") && said.contains(" gouraud-8.8-reseeded"), "{said}");
    assert!(said.contains("), float vertices,"), "{said}");
    let (_, grey) = stats("phong --palette grey");
    assert!(grey != own);
    let (_, perspective) = stats("crate --time 0.3");
    for mapping in ["affine", "every-16"] {
        assert!(stats(&format!("crate --time 0.3 --mapping {mapping}")).1 != perspective, "{mapping}");
    }
    assert!(stats("crate --time 0.3 --mapping perspective").1 == perspective);
}

/// The options for zoom, camera, background and dither take effect.
#[test]
fn the_view_is_as_asked_for() {
    let folder = Folder::new();
    let picture = |words: &str| Png::decode(&folder.picture(words));
    let own = picture("sphere");
    let covered = |png: &Png| png.pixels.iter().filter(|pixel| **pixel != png.pixels[0]).count();
    assert!(picture("sphere --zoom 1") == own);
    // Enlarging by 1.05 multiplies the area by 1.05²; from twice as far away it is a quarter, apart from perspective.
    let (larger, smaller) = (picture("sphere --zoom 1.05"), picture("sphere --zoom 0.5"));
    let part = |of| covered(of) as f64 / covered(&own) as f64;
    assert!((part(&larger) - 1.05 * 1.05).abs() < 0.01, "{}", part(&larger));
    assert!((0.2..0.25).contains(&part(&smaller)), "{}", part(&smaller));
    // From behind, a torus lit from the front is dark; looking away from it shows nothing.
    assert!(picture("torus --camera 0,0,-3") != picture("torus --camera 0,0,3"));
    assert!(picture("torus --camera 0,0,3:0,0,0") == picture("torus --camera 0,0,3"));
    assert_eq!(covered(&picture("torus --camera 0,0,3:0,0,9")), 0);
    // A moving camera of the scene stands still then.
    let still = |time: &'static str| picture(&format!("interlock --camera 0,0,4 --time {time}"));
    assert!(still("0") == still("1"));
    for (word, color) in [("#ff0000", Rgb::new(255, 0, 0)), ("00ff00", Rgb::new(0, 255, 0))] {
        let background = picture(&format!("cube --palette bios --background {word}")).colors()[0];
        assert!(background.distance_squared(color) < 100, "{word}");
    }
    assert_eq!(picture("cube --background 7").pixels[0], 7);
    let [with, without] = ["--dither ordered", "--no-dither"].map(|words| picture(&format!("still {words}")));
    assert!(with == picture("still") && with != without && without != picture("still --dither blue-noise"));
    // By default a picture shows the moment that the scene names; animations and turns begin at 0.
    assert!(picture("flash") == picture("flash --time 1.11"));
    assert!(picture("flash --turn 0") == picture("flash --time 0"));
}

/// Surfaces drawn in the ramps of a scene's palette keep their colours in a palette made for it.
#[test]
fn a_palette_made_for_a_scene_keeps_the_colors_of_its_ramps() {
    let folder = Folder::new();
    let colors = |words: &str| Png::decode(&folder.picture(&format!("{words} --no-dither"))).colors();
    for scene in ["still", "interlock", "teapot", "phong"] {
        let (own, made) = (colors(scene), colors(&format!("{scene} --palette auto")));
        let far = own.iter().zip(&made).map(|(a, b)| f64::from(a.distance_squared(*b)).sqrt());
        let mean = far.sum::<f64>() / own.len() as f64;
        // On average within one step of the DAC in each of the three channels. In greys they would be 30 or more apart.
        assert!(mean < 4.0 * 3_f64.sqrt(), "{scene}: {mean}");
    }
}

/// `--turn` advances a moving scene in its round, and moves the camera around any other.
#[test]
fn scenes_are_drawn_at_their_time() {
    let folder = Folder::new();
    let picture = |words: &str| folder.picture(words);
    assert!(picture("rgb --time 1") == picture("rgb --turn 90"));
    assert!(picture("rgb --time 1") == picture("rgb --time 5"));
    assert!(picture("rgb --time 1") != picture("rgb"));
    assert!(picture("still --time 1") == picture("still"));
    assert!(picture("still --turn 90") != picture("still"));
    // The scene lasts three seconds, not four.
    assert!(picture("flash --turn 120") == picture("flash --time 1"));
    let (line, _) = film(&folder, "flash --fps 10 --scale 1");
    assert!(line.contains(" 30 frames ") && line.contains(", 3.00 s, "), "{line}");
}

/// The explanation of a pixel, in words and as JSON, agrees with the picture.
#[test]
fn explain_says_why_a_pixel_has_its_byte() {
    let folder = Folder::new();
    let mut scene = "cone".parse::<shipped::Shipped>().expect("a scene").load().expect("a scene that loads").scene;
    scene.set_time(0.0);
    let mut vga = Vga::new();
    Renderer::new().draw(&scene, &mut vga).expect("a legal scene");
    for (x, y) in [(150, 100), (0, 0), (167, 120)] {
        let place = format!("{x},{y}");
        let text = folder.printed(&format!("explain cone --pixel {place}"));
        let byte = vga.pixels()[y * 320 + x];
        assert!(text.starts_with(&format!("cone at 0 s, pixel ({x}, {y}): byte {byte} (")), "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
        let json = folder.json(&format!("explain cone --pixel {place} --json"));
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
    let folder = Folder::new();
    let model = "mtllib m.mtl\nusemtl wall\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n# a square\nf 1 2 3 4\n";
    folder.put("m.obj", model);
    folder.put("m.mtl", "newmtl wall\nKd 1 0 0\n");
    let text = folder.printed("explain m.obj --pixel 150,90");
    assert!(text.contains("m, triangle 0 (line 8 of the model), material wall"), "{text}");
    let json = folder.json("explain m.obj --pixel 150,90 --json");
    let face = &json["faces"][0];
    assert_eq!((&face["object"], &face["line"], &face["material"]), (&"m".into(), &8.into(), &"wall".into()));
    // A shape has neither materials nor lines.
    let json = folder.json("explain cone --pixel 150,100 --json");
    assert_eq!((&json["faces"][0]["line"], &json["faces"][0]["material"]), (&Value::Null, &Value::Null));
}

#[test]
fn a_pixel_is_explained_alike_by_a_time_and_by_the_error_that_fits() {
    let folder = Folder::new();
    let explained = |limit: &str| folder.json(&format!("explain torus --pixel 160,60 --json {limit}"));
    // The smallest error, half a shade, fits.
    assert_eq!(explained("--max-time 100000"), explained("--max-error 0.5"));
}

/// A row is shown in characters, as JSON and as a chart.
#[test]
fn explain_draws_a_row() {
    let folder = Folder::new();
    let text = folder.printed("explain cone --row 120");
    assert!(text.starts_with("cone at 0 s, row 120, gouraud-8.8-reseeded\n"), "{text}");
    assert!(text.contains("Mach bands") && text.lines().all(|line| line.chars().count() <= 100), "{text}");
    let text = folder.printed("explain cone --row 120 --max-error 4");
    assert!(text.starts_with("cone at 0 s, row 120, within 4 shades\n"), "{text}");
    assert!(folder.printed("explain cone --row 0").contains("nothing but background"));

    let json = folder.json("explain cone --row 120 --json");
    assert_eq!((&json["schema"], &json["row"]), (&Value::from(1), &Value::from(120)));
    let columns = json["columns"].as_array().expect("columns");
    assert_eq!((columns.len(), json["slope"]["lit"].as_array().map(Vec::len)), (320, Some(320)));
    let faces = columns.iter().filter(|column| !column["face"].is_null()).count();

    folder.succeed("explain cone --row 120 -o row.svg");
    let svg = String::from_utf8(folder.read("row.svg")).expect("text");
    assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"));
    // A dot for each pixel with a face, and one in the legend.
    assert_eq!(svg.matches("<circle").count(), faces + 1);
    assert_eq!(folder.names(), ["row.svg"]);
}

#[test]
fn explain_refuses_what_is_not_there() {
    let folder = Folder::new();
    for (words, status, says) in [
        ("explain cone", 2, "--pixel <X,Y>|--row <Y>"),
        ("explain cone --pixel 320,0", 2, "no pixel (320, 0) in a frame of 320 x 200"),
        ("explain cone --pixel 0,200", 2, "no pixel (0, 200)"),
        ("explain cone --pixel 160", 2, "such as 160,100"),
        ("explain cone --pixel 1.5,2", 2, "such as 160,100"),
        ("explain cone --pixel 1,2 --row 3", 2, "cannot be used with"),
        ("explain cone --pixel 1,2 -o x.svg", 2, "--out is only for the chart of a --row"),
        ("explain cone --row 200", 2, "no row 200 in a frame of 200 rows"),
        ("explain cone --row 2 -o x.png", 2, "x.png: the name of a chart must end in .svg"),
        ("explain none.obj --pixel 1,2", 1, "none.obj: No such file"),
        ("explain cone --row 2 -o none/x.svg", 1, "none"),
    ] {
        folder.fails(words, status, says);
    }
    assert!(folder.names().is_empty());
}

/// Two squares that meet at 90°: with a sharp edge between them, as by flat shading, or without.
#[test]
fn a_crease_angle_is_for_models() {
    let folder = Folder::new();
    let bent = "v 0 0 0\nv 0 0 2\nv 2 0 0\nv 2 0 2\nv 2 2 0\nv 2 2 2\nf 1 2 4 3\nf 3 4 6 5\n";
    folder.put("bent.obj", bent);
    let picture = |crease: &str| folder.picture(&format!("bent.obj {crease}"));
    let usual = picture("");
    assert!(usual == picture("--crease 40") && usual == picture("--crease 0"));
    assert!(usual != picture("--crease 180"));
}
