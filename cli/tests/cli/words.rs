//! The command line: help, completions, typos, old names, exit statuses, JSON, and which files are overwritten.

use std::collections::BTreeSet;
use std::fs;
use std::process::{Command, Output};
use std::sync::OnceLock;

use mode13h::palette::builtin;
use mode13h::raster::Frame;
use mode13h::render::Renderer;
use mode13h::settings::Shading;
use mode13h::span::Kernel;
use mode13h_assets::shipped;
use serde_json::Value;

use crate::folder::{Folder, Png, failed, printed};
use crate::support::tried::{Tried, is_here};
use crate::verify::verified_as_json;

const COMMANDS: [&str; 12] =
    ["demo", "render", "list", "scenes", "plan", "explain", "cost", "palette", "cases", "dos", "verify", "generate"];

/// The commands that draw a scene.
const DRAWING: [&str; 5] = ["demo", "render", "plan", "explain", "cost"];

/// A study that takes two seconds and writes no file. The integer path has no budgets, so no verdict depends on the
/// clock.
const COST: &str = "cost cube --frames 1 --seconds 0 --shadings flat --json --arithmetic fixed";

/// Output of [`COST`], from one run for all tests.
fn cost() -> &'static Output {
    static OUTPUT: OnceLock<Output> = OnceLock::new();
    OUTPUT.get_or_init(|| Folder::new().run(COST))
}

/// The help of a command, or of the program if `command` is empty.
fn help(command: &str, option: &str, columns: &str) -> String {
    let folder = Folder::new();
    printed(folder.program(command).arg(option).env("COLUMNS", columns).output().expect("started"))
}

/// The options that a help text lists, such as `--shading`. Their descriptions are farther to the right.
fn options(help: &str) -> BTreeSet<String> {
    let lines = help.lines().filter(|line| line.starts_with("  -") || line.starts_with("      --"));
    let starts = lines.map(str::trim_start);
    let words = starts.flat_map(|line| line.split_whitespace().take(2).map(|word| word.trim_end_matches(',')));
    let is_option = |word: &&str| word.starts_with("--") && word.chars().all(|c| c.is_ascii_lowercase() || c == '-');
    words.filter(is_option).map(String::from).collect()
}

#[test]
fn help_is_short_or_long_and_no_wider_than_the_terminal() {
    let mut tried = Tried::new("help_is_short_or_long_and_no_wider_than_the_terminal", 70);
    let nested = ["", "generate completions", "generate man", "scenes copy"];
    for command in COMMANDS.into_iter().chain(nested) {
        for (columns, widest) in [("80", 80), ("100", 100), ("300", 100)] {
            let [short, long] = ["-h", "--help"].map(|option| help(command, option, columns));
            for line in short.lines().chain(long.lines()) {
                assert!(line.chars().count() <= widest, "{command}: {line}");
            }
            assert!(short.lines().count() < long.lines().count(), "{command}");
            // The short help fits one screen.
            assert!(short.lines().count() <= 42 || columns != "80", "{command}: {short}");
            // The short help omits options that few need.
            assert!(options(&short).is_subset(&options(&long)), "{command}");
            tried.add(2);
        }
        // Only `scenes` lists the names of scenes.
        let long = help(command, "--help", "100");
        for scene in ["two-lights", "flash-tessellated", "interlock", "glenz"] {
            assert!(scene.parse::<shipped::Shipped>().is_ok() && !long.contains(scene), "{command}: {long}");
        }
    }
    // In a wider terminal, lines are wrapped differently.
    assert_ne!(help("render", "--help", "80"), help("render", "--help", "100"));
}

/// The program's own help has the options of `demo` that no other command has, but not those for drawing.
#[test]
fn the_help_of_the_program_is_that_of_demo_without_the_drawing() {
    for option in ["-h", "--help"] {
        let [program, demo] = ["", "demo"].map(|command| help(command, option, "100"));
        let (own, drawing) = demo.split_once("\n\nScene:\n").expect("a heading");
        let mut expected = options(own);
        expected.insert("--version".into());
        assert_eq!(options(&program), expected, "{option}");
        assert!(drawing.contains("--zoom") && !program.contains("Scene:"), "{program}");
    }
    assert!(help("", "--help", "100").contains("`mode13h demo --help` explains"));
}

/// Options that a DOS program ignores are accepted with a note, but not offered.
#[test]
fn the_help_of_dos_leaves_out_what_it_ignores() {
    let ignored =
        ["--hidden-surfaces", "--mapping", "--mipmaps", "--no-mipmaps", "--arithmetic", "--kernel", "--vertex-bits"];
    let ignored = BTreeSet::from(ignored.map(String::from));
    for option in ["-h", "--help"] {
        let [dos, render] = ["dos", "render"].map(|command| options(&help(command, option, "100")));
        assert!(dos.is_disjoint(&ignored) && dos.contains("--dither"), "{option}: {dos:?}");
        assert!(option == "-h" || render.is_superset(&ignored), "{render:?}");
    }
}

/// A time in which every frame fits selects the smallest error, one in which none fits the greatest, which
/// `--max-error` limits.
#[test]
fn a_time_chooses_an_error_and_says_so() {
    let folder = Folder::new();
    let picture = |words: &str| {
        let said = folder.said(&format!("render {words} -o x.png"));
        (folder.read("x.png"), said)
    };
    let scene = "objects = [{ shape = 'torus' }]\nlights = [{ sun = [0, 0, 1] }]\n";
    folder.put("plain.toml", scene);
    let of_error = |error: &str| picture(&format!("plain.toml --max-error {error}")).0;
    assert!(of_error("0.5") != of_error("16"));
    for (time, error, says) in [
        ("100000", "0.5", ""),
        ("0.0000001", "16", "mode13h: the frame takes longer than 0.0000001 ms even at the largest error allowed\n"),
    ] {
        let (bytes, said) = picture(&format!("plain.toml --max-time {time}"));
        assert!(bytes == of_error(error) && said == says, "{time}: {said}");
    }
    // `--max-error` limits the error.
    assert!(picture("plain.toml --max-time 0.0000001 --max-error 3").0 == of_error("3"));
    let json = folder.json("render plain.toml -o x.png --max-time 100000 --stats --json");
    let frame = &json["frames"][0];
    assert_eq!((&frame["max_error"], &frame["max_time"], &frame["fits"]), (&0.5.into(), &1e5.into(), &true.into()));
    assert!(frame["milliseconds"].as_f64().is_some_and(|time| time > 0.0), "{frame}");
    for (words, says) in [
        (
            "explain plain.toml --row 9 --max-time 100000",
            "mode13h: within 0.5 shades, the smallest error that fits in 100000 ms",
        ),
        ("plan plain.toml --max-time 0.0000001", "mode13h: within 16 shades, which takes more than 0.0000001 ms"),
    ] {
        let said = folder.said(words);
        assert!(said.contains(says), "{said}");
    }
    for (words, says) in [
        ("render cube -o x.png --max-time 2 --shading phong", "cannot be used with"),
        ("render cube -o x.png --max-time 0", "not a number of milliseconds above 0"),
        ("render cube -o x.png --max-time NaN", "not a number of milliseconds above 0"),
        ("render cube -o x.png --max-time 1e30", "not a number of milliseconds above 0"),
    ] {
        folder.fails(words, 2, says);
    }
}

#[test]
fn whatever_draws_has_the_words_of_a_scene_file() {
    let keys: Vec<&str> = include_str!("../../../assets/scenes/README.md")
        .split("\n### render\n")
        .nth(1)
        .expect("the table of [render]")
        .split("\n#")
        .next()
        .expect("the section")
        .lines()
        .filter_map(|line| line.strip_prefix("| `")?.split('`').next())
        .collect();
    assert!(keys.len() >= 6, "{keys:?}");
    for command in DRAWING {
        let known = options(&help(command, "--help", "100"));
        for key in keys.iter().chain(&["palette", "background", "arithmetic", "kernel", "zoom", "camera"]) {
            // `cost` compares shadings and budgets itself, and accepts a list of shadings.
            let is_compared = command == "cost" && ["shading", "max-error"].contains(key);
            assert_eq!(known.contains(&format!("--{key}")), !is_compared, "{command} --{key}");
        }
        let long = help(command, "--help", "100");
        for heading in ["\nScene:\n", "\nRendering:\n"] {
            assert!(long.contains(heading), "{command}: no {heading}");
        }
    }
}

/// An option does what the same key of a scene file does.
#[test]
fn an_option_does_what_its_key_does() {
    let mut tried = Tried::new("an_option_does_what_its_key_does", 9);
    let folder = Folder::new();
    let picture = |words: &str| folder.picture(words);
    let lit = "objects = [{ shape = 'wall', subdivisions = [2, 2], material.texture = 'crate', angles = [60, 20, 0] }]\n\
               lights = [{ lamp = [0, 0, 1], range = 3 }]\nambient = 0.2\npalette = 'materials-8x32'\n";
    folder.put("plain.toml", lit);
    for (key, value) in [
        ("shading", "phong"),
        ("shading", "gouraud-vintage"),
        ("max-error", "2"),
        ("hidden-surfaces", "painter"),
        ("mapping", "affine"),
        ("mipmaps", "on"),
        ("mipmaps", "off"),
        ("tessellation", "0.5"),
        ("dither", "ordered"),
    ] {
        let in_file = match value {
            "on" => "true".to_string(),
            "off" => "false".to_string(),
            _ if value.parse::<f64>().is_ok() => value.to_string(),
            _ => format!("'{value}'"),
        };
        folder.put("asks.toml", format!("{lit}render.{key} = {in_file}\n"));
        let by_option = picture(&match value {
            "on" => format!("plain.toml --{key}"),
            "off" => format!("plain.toml --no-{key}"),
            _ => format!("plain.toml --{key} {value}"),
        });
        assert!(by_option == picture("asks.toml"), "--{key} {value}");
        if ["phong", "affine", "0.5", "ordered"].contains(&value) && key != "mipmaps" {
            assert!(by_option != picture("plain.toml"), "--{key} {value} changes nothing");
        }
        tried.add(1);
    }
}

/// Each list has the library's names, and marks the default.
#[test]
fn lists_have_the_names_that_options_take() {
    let folder = Folder::new();
    let list = |what: &str| folder.printed(&format!("list {what}"));
    let names = |text: &str| -> Vec<String> {
        let of_line = |line: &str| line.split_whitespace().next().map(String::from);
        text.lines().take_while(|line| !line.is_empty()).filter_map(of_line).collect()
    };
    let shadings = list("shadings");
    assert_eq!(names(&shadings), Shading::ALL.map(Shading::name));
    let marked: Vec<&str> = shadings.lines().filter(|line| line.contains("the default, `gouraud` for short")).collect();
    assert!(marked.len() == 1 && marked[0].starts_with(Shading::default().name()), "{shadings}");
    let palettes = list("palettes");
    assert_eq!(names(&palettes), builtin::ALL.iter().map(|palette| palette.name).collect::<Vec<_>>());
    let kernels = list("kernels");
    assert_eq!(names(&kernels), Kernel::available().map(Kernel::name).collect::<Vec<_>>());
    let marked: Vec<&str> = kernels.lines().filter(|line| line.contains("the default")).collect();
    assert!(marked.len() == 1 && marked[0].starts_with(Kernel::default().name()), "{kernels}");
    assert_eq!(names(&list("scenes")), shipped::ALL.iter().map(|scene| scene.name).collect::<Vec<_>>());
    for line in [shadings, palettes, kernels].iter().flat_map(|text| text.lines()) {
        assert_eq!(line, line.trim_end());
    }
}

/// Wherever a shading is named, `gouraud` is the default one.
#[test]
fn gouraud_is_short_for_the_default_shading() {
    let folder = Folder::new();
    let picture = |words: &str| folder.picture(words);
    // A scene that asks for another.
    let scene = "objects = [{ shape = 'torus' }]\nlights = [{ sun = [0, 0, 1] }]\nrender.shading = ";
    let put = |name: &str, shading: &str| folder.put(name, format!("{scene}'{shading}'\n"));
    put("flat.toml", "flat");
    put("short.toml", "gouraud");
    put("full.toml", Shading::default().name());
    let default = picture(&format!("flat.toml --shading {}", Shading::default()));
    assert!(picture("flat.toml --shading gouraud") == default && picture("flat.toml") != default);
    assert!(picture("short.toml") == default && picture("full.toml") == default);
    let json = folder.json("render flat.toml -o x.png --shading gouraud --stats --json");
    assert_eq!(json["frames"][0]["shading"], Shading::default().name());
    let json = folder.json("cost cube --frames 1 --seconds 0 --shadings flat,gouraud --json --arithmetic fixed");
    assert_eq!(json["shadings"][1]["shading"], Shading::default().name());
    let program = |shading: &str| {
        folder.printed(&format!("dos cube --frames 2 -o CUBE.EXE --shading {shading}"));
        folder.read("CUBE.EXE")
    };
    assert!(program("gouraud") == program(Shading::default().name()) && program("gouraud") != program("flat"));
    // It is not a name of anything else, such as a mapping.
    folder.fails("render cube -o x.png --mapping gouraud", 2, "invalid value 'gouraud'");
    folder.put("wrong.toml", "objects = [{ shape = 'cube' }]\nrender.mapping = 'gouraud'\n");
    folder.fails("render wrong.toml -o x.png", 2, "\"gouraud\": unknown");
}

/// Frames of square pixels in any size are the library's.
#[test]
fn a_frame_has_the_size_that_was_asked_for() {
    let folder = Folder::new();
    let picture = |words: &str| Png::decode(&folder.picture(words));
    let mut scene = "torus".parse::<shipped::Shipped>().expect("a scene").load().expect("it loads").scene;
    scene.set_time(0.5);
    for (width, height) in [(640, 400), (97, 33), (1, 1), (1021, 7)] {
        let png = picture(&format!("torus --time 0.5 --size {width}x{height}"));
        let mut expected = vec![0; (width * height) as usize];
        let frame = Frame::new(&mut expected, width, height, width as usize).expect("a frame");
        Renderer::new().draw_frame(&scene, frame, (1, 1)).expect("a legal scene");
        assert!(png.size == (width, height) && png.pixels == expected, "{width} x {height}");
        assert!(png.density.is_none_or(|(x, y)| x == y), "{width} x {height}: {:?}", png.density);
    }
    // Frames are enlarged afterwards; true colour alone does not enlarge them.
    assert_eq!(picture("torus --size 64x48 --scale 2").size, (128, 96));
    assert_eq!(picture("torus --size 64x48 --rgb").size, (64, 48));
    for animation in ["gif", "apng"] {
        let json = folder.json(&format!("render torus --size 64x48 --frames 2 -o x.{animation} --json"));
        assert_eq!((&json["animation"]["width"], &json["animation"]["height"]), (&64.into(), &48.into()));
    }
    // An animated palette has the state of the frame's time.
    let colors = |words: &str| picture(&format!("fade {words}")).palette;
    assert!(colors("--time 1") == colors("--time 1 --size 64x48") && colors("--time 1") != colors("--time 0"));
}

/// A file without an extension is what its contents are, and its palette is its own whatever its name.
#[test]
fn files_are_what_they_contain() {
    let folder = Folder::new();
    folder.succeed("scenes copy crate -o crate.toml");
    folder.succeed("render crate.toml -o scene.png");
    fs::copy(folder.path("crate.toml"), folder.path("plain")).expect("copied");
    folder.succeed("render ./plain -o plain.png");
    assert!(
        fs::read(folder.path("plain.png")).expect("written") == fs::read(folder.path("scene.png")).expect("written")
    );
    assert!(folder.printed("palette cube").contains("Generated by this program"));
    assert!(!folder.printed("palette --from cube").contains("Generated by this program"));
}

/// With `--quiet` a command only writes its files.
#[test]
fn quiet_commands_say_nothing() {
    let folder = Folder::new();
    for words in [
        "render cube -q",
        "render cube --frames 2 --quiet",
        "render cube --frames 2 -o x.gif -q",
        "cases R5 -q",
        "dos cube --frames 2 -q",
        "verify --frame canvas/bands/plain -q",
        "cost cube --frames 1 --seconds 0 --shadings flat --arithmetic fixed -q",
    ] {
        assert!(folder.printed(words).is_empty(), "{words}");
    }
    for file in ["cube.png", "cube-0001.png", "x.gif", "R5.png", "CUBE.EXE", "cost-cube/report.html"] {
        assert!(folder.path(file).is_file(), "{file}");
    }
    // Errors are still reported.
    folder.fails("render cube -q", 1, "");
}

/// Even with `--quiet` a command prints its result, as text or JSON.
#[test]
fn quiet_commands_print_what_was_asked_for() {
    let folder = Folder::new();
    for words in [
        "list palettes",
        "plan cube --json",
        "explain cube --pixel 160,100",
        "explain cube --row 100 --json",
        "palette copper",
        "cases",
        "cases R5 --force --json",
        "render cube --force --json",
        "verify --frame canvas/bands/plain --json",
        "verify --frame canvas/bands/plain --list",
        "generate man",
        "generate completions bash",
    ] {
        let loud = folder.printed(words);
        for quiet in [format!("{words} -q"), format!("-q {words}"), format!("--quiet {words}")] {
            assert!(!loud.is_empty() && folder.printed(&quiet) == loud, "{quiet}");
        }
    }
    let quiet = folder.run(&format!("{COST} --quiet"));
    assert_eq!((String::from_utf8_lossy(&quiet.stderr), &quiet.stdout[..1]), ("".into(), &b"{"[..]));
    let timed = "plan cube --max-time 100000";
    assert!(folder.said(timed).contains("the smallest error"));
    assert_eq!(folder.said(&format!("{timed} -q")), "");
    for command in COMMANDS.into_iter().chain(["", "scenes copy", "generate man"]) {
        assert!(options(&help(command, "-h", "100")).contains("--quiet"), "{command}");
    }
    // The window, without a display.
    folder.said("demo cube -q");
    folder.said("cube -q");
}

/// `--time` sets a scene's moment in the window, too: without a display a frame of that moment is saved.
#[test]
fn time_is_the_same_for_all_that_draw() {
    let folder = Folder::new();
    let read = |name: &str| folder.read(name);
    let [at, usual] = ["flash --time 0.25", "flash"].map(|words| folder.picture(words));
    assert!(folder.run("flash --time 0.25").status.success());
    assert!(folder.run("demo flash").status.success());
    assert!(read("mode13h-0001.png") == at && read("mode13h-0002.png") == usual);
    assert!(at != usual);
    assert!(folder.printed("plan flash --time 0.25").starts_with("flash at 0.25 s, "));
    assert!(folder.printed("explain flash --row 9 --time 0.25").starts_with("flash at 0.25 s, "));
}

/// The browser is a script here, which records its arguments.
#[cfg(target_os = "linux")]
#[test]
fn a_report_is_opened_in_the_browser() {
    use std::os::unix::fs::PermissionsExt;
    use std::time::{Duration, Instant};

    let folder = Folder::new();
    let browsers = folder.path("bin");
    fs::create_dir(&browsers).expect("made");
    let browser = browsers.join("xdg-open");
    fs::write(&browser, "#!/bin/sh\necho \"$1\" > opened\n").expect("written");
    fs::set_permissions(&browser, fs::Permissions::from_mode(0o755)).expect("allowed");
    let words = "cost cube --frames 1 --seconds 0 --shadings flat --arithmetic fixed -q -o study --open";
    let run = |path: &std::path::Path| folder.program(words).env("PATH", path).output();
    assert!(printed(run(&browsers).expect("started")).is_empty());
    let (opened, begun) = (folder.path("opened"), Instant::now());
    let said = loop {
        match fs::read_to_string(&opened) {
            Ok(said) if said.ends_with('\n') => break said,
            _ => assert!(begun.elapsed() < Duration::from_secs(30), "nothing was opened"),
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    assert_eq!(said, "study/report.html\n");
    // Without any browser the report is still written.
    let output = run(std::path::Path::new("/nowhere")).expect("started");
    failed(&output, 1, "study/report.html: cannot be opened in a browser");
}

#[test]
fn typos_are_answered_with_the_nearest_word() {
    let folder = Folder::new();
    for (words, says) in [
        ("rendr torus -o x.png", "rendr: no such command, file, scene or shape; did you mean render?"),
        ("rendr torus", "did you mean render?"),
        ("rendr", "did you mean render?"),
        ("scnees copy fog", "did you mean scenes?"),
        ("verfiy", "did you mean verify?"),        // typo
        ("genrate man", "did you mean generate?"), // typo
        ("palete grey", "did you mean palette?"),  // typo
        ("torsu", "torsu: no such file, scene or shape; did you mean torus?"),
        ("render spere", "did you mean sphere?"), // typo
        ("demo rendr", "did you mean the command render?"),
        ("scenes copy frog", "frog: no such scene; did you mean fog?"),
        ("render torus --shadng flat", "did you mean --shading?"),
        ("render torus --shading phongs", "did you mean phong?"),
        ("generate completion bash", "did you mean completions?"),
    ] {
        folder.fails(words, 2, says);
    }
    // A word that resembles no name gets no suggestion.
    let line = folder.fails("xyzzyx", 2, "");
    assert!(!line.contains("did you mean"), "{line}");
    assert!(folder.names().is_empty());
    // A file with that name is an INPUT, whatever it resembles.
    folder.put("rendr", "no model");
    folder.fails("rendr", 2, "rendr: unknown kind of file");
}

/// Each command ends with each exit status that it can have.
#[test]
fn every_command_ends_with_the_status_that_help_names() {
    let mut tried = Tried::new("every_command_ends_with_the_status_that_help_names", 40);
    let folder = Folder::new();
    folder.put("broken.obj", "v 0 0 0\nf 1 2 3\n");
    folder.put("broken.toml", "objects = 3\n");
    folder.put("missing.toml", "objects = [{ model = 'none.obj' }]\n");
    folder.put("broken.pal", "JASC-PAL\r\n0100\r\n2\r\n0 0 0\r\nred 0 0\r\n");
    let runs = [
        ("demo cube", 0),
        ("demo --xml", 2),
        ("demo broken.toml", 2),
        ("demo none.toml", 1),
        ("demo cube none.toml", 1),
        ("demo cube broken.obj", 2),
        ("render cube -o x.png", 0),
        ("render cube -o x.tif", 2),
        ("render broken.obj -o x.png", 2),
        ("render missing.toml -o x.png", 1),
        ("render cube -o none/x.png", 1),
        ("render cube -o none/x.gif", 1),
        ("render cube -o x.png --palette broken.pal", 2),
        ("render cube -o x.png --palette none.pal", 1),
        ("list scenes", 0),
        ("list", 2),
        ("list bogus", 2),
        ("scenes copy fog -o y.toml", 0),
        ("scenes", 2),
        ("scenes copy bogus", 2),
        ("scenes copy --force", 2),
        ("scenes copy fog -o none/y.toml", 1),
        ("plan cube", 0),
        ("plan", 2),
        ("plan broken.toml", 2),
        ("plan none.obj", 1),
        ("explain cube --row 9", 0),
        ("explain cube --row 900", 2),
        ("explain none.toml --row 9", 1),
        ("explain cube --row 9 -o none/x.svg", 1),
        // A unit test covers the status 1 of a broken promise.
        (COST, 0),
        ("cost cube --frames 0", 2),
        ("cost broken.obj", 2),
        ("cost none.toml", 1),
        ("cost cube -o x.png", 1),
        ("palette", 2),
        ("palette grey", 0),
        ("palette bogus", 2),
        ("palette broken.pal", 2),
        ("palette none.pal", 1),
        ("palette grey -o none/x.pal", 1),
        ("cases", 0),
        ("cases R5 -o x.png", 0),
        ("cases BOGUS", 2),
        ("cases R5 -o none/x.png", 1),
        ("dos cube --frames 2 -o CUBE.EXE", 0),
        ("dos cube --frames 2 --shading flat -o FLAT.EXE", 0),
        ("dos cube --shading phong -o PHONG.EXE", 2),
        ("dos cube --frames 0", 2),
        ("dos bogus", 2),
        ("dos broken.toml", 2),
        ("dos none.obj", 1),
        ("dos cube --frames 2 -o none/x.exe", 1),
        // A unit test covers the status 1 of a failed check; here none may fail.
        ("verify", 0),
        ("verify --seed x", 2),
        ("verify --frame canvas -o none/x.png", 1),
        ("generate man", 0),
        ("generate completions zsh", 0),
        ("generate completions bogus", 2),
        ("generate man -o x.png", 1),
    ];
    let command_of = |words: &str| words.split(' ').next().map(String::from);
    let runs: Vec<&[(&str, i32)]> = runs.chunk_by(|a, b| command_of(a.0) == command_of(b.0)).collect();
    assert!(runs.iter().filter_map(|runs| command_of(runs[0].0)).eq(COMMANDS));
    for (command, runs) in COMMANDS.into_iter().zip(runs) {
        let said = help(command, "--help", "100");
        let said = said.split("\nExit status:\n").nth(1).unwrap_or_else(|| panic!("{command}: {said}"));
        let known: Vec<i32> = said.lines().filter_map(|line| line.split_whitespace().next()?.parse().ok()).collect();
        assert_eq!(known, [0, 1, 2, 130], "{command}: {said}");
        for (words, status) in runs {
            let output = match *words {
                "verify" => verified_as_json(),
                COST => cost(),
                words => &folder.run(words),
            };
            assert_eq!(output.status.code(), Some(*status), "{words}: {}", String::from_utf8_lossy(&output.stderr));
            tried.add(1);
        }
    }
}

/// Output for programs is one JSON document and nothing else.
#[test]
fn lists_and_figures_are_json_for_programs() {
    let folder = Folder::new();
    let value = |words: &str, output: &Output| -> Value {
        assert!(output.status.success(), "{words}: {output:?}");
        serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{words}: {error}: {output:?}"))
    };
    let json = |words: &str| value(words, &folder.run(words));
    let length = |value: &Value| value.as_array().expect("a list").len();

    let scenes = json("list scenes --json");
    assert_eq!((length(&scenes["scenes"]), &scenes["schema"]), (shipped::ALL.len(), &1.into()));
    assert_eq!(scenes["scenes"][0]["name"], "torus");
    assert!(scenes["shapes"].as_array().expect("a list").contains(&"cylinder".into()));

    let shadings = json("list shadings --json");
    assert_eq!((length(&shadings["shadings"]), &shadings["shadings"][3]["default"]), (10, &true.into()));
    let kernels = json("list kernels --json");
    assert_eq!((&kernels["schema"], &kernels["kernels"][0]["name"]), (&1.into(), &"portable".into()));
    let palettes = json("list palettes --json");
    assert_eq!((length(&palettes["palettes"]), &palettes["palettes"][0]["name"]), (9, &"grey".into()));
    let copper = json("palette copper --json");
    assert_eq!(
        (length(&copper["colors"]), &copper["ramps"], &copper["colors"][0]),
        (256, &1.into(), &"#050102".into())
    );
    let made = json("palette --from torus --json");
    assert_eq!((length(&made["materials"]), &made["materials"][0]["what"]), (1, &"a ramp".into()));

    let cases = json("cases --json");
    assert!(length(&cases["cases"]) >= 20 && cases["cases"][0]["id"] == "R1", "{cases}");
    assert_eq!(json("cases R5 --json -o r.png")["file"], "r.png");

    let pictures = json("render torus -o x%d.png --frames 3 --stats --json");
    assert_eq!(pictures["files"], serde_json::json!(["x0.png", "x1.png", "x2.png"]));
    for (number, frame) in pictures["frames"].as_array().expect("a list").iter().enumerate() {
        assert_eq!((&frame["frame"], &frame["shading"]), (&number.into(), &"gouraud-8.8-reseeded".into()));
        let triangles = frame["triangles"].as_u64().expect("a count");
        assert_eq!(frame["triangles_by_shading"], serde_json::json!({ "gouraud-8.8-reseeded": triangles }));
        assert!(frame["raster"]["pixels"].as_u64() > Some(1_000), "{frame}");
    }
    let budget = json("render torus -o x.png --stats --json --max-error 4 --arithmetic float");
    assert_eq!((&budget["frames"][0]["max_error"], &budget["frames"][0]["arithmetic"]), (&4.0.into(), &"float".into()));
    let film = json("render cube -o x.gif --frames 2 --json");
    assert_eq!(
        (&film["animation"]["frames"], &film["animation"]["width"], &film["frames"]),
        (&2.into(), &640.into(), &Value::Null)
    );
    assert_eq!(json("render cube -o x.apng --frames 2 --scale 1 --json")["animation"]["width"], 320);
    folder.fails("render cube -o - --json", 2, "standard output");

    assert_eq!(json("plan torus --json")["schema"], 1);
    let pixel = json("explain torus --pixel 160,60 --json --shading phong");
    assert_eq!((&pixel["shading"], &pixel["arithmetic"]), (&"phong".into(), &"float".into()));
    assert!(pixel["shading_reason"].is_string() && pixel["faces"][0]["interpolation"].is_string(), "{pixel}");
    assert_eq!(length(&json("explain torus --row 60 --json")["columns"]), 320);
    assert_eq!(value("verify --json", verified_as_json())["passed"], true);
    let cost = value(COST, cost());
    assert_eq!((&cost["schema"], &cost["shadings"][0]["shading"]), (&1.into(), &"flat".into()));
    for text in [pixel, cost] {
        let text = text.to_string();
        for old in ["rung", "why", "vertex_path", "gouraud-period", "integer"] {
            assert!(!text.contains(&format!("\"{old}")), "{old}: {text}");
        }
    }
}

/// Files with default names are overwritten only with `--force`; those named by `-o` always.
#[test]
fn only_files_that_were_named_are_overwritten() {
    let mut tried = Tried::new("only_files_that_were_named_are_overwritten", 5);
    let folder = Folder::new();
    // Integers know no budget, so the status does not hang on the clock.
    let cost = "cost cube --frames 1 --seconds 0 --shadings flat --arithmetic fixed";
    for (words, out, files) in [
        ("render cube", "-o cube.png", &["cube.png"][..]),
        ("render cube --frames 2 --turn 90", "-o cube-%04d.png", &["cube-0000.png", "cube-0001.png"]),
        ("scenes copy fog", "-o fog.toml", &["fog.toml"]),
        ("cases R5", "-o R5.png", &["R5.png"]),
        (
            cost,
            "-o cost-cube",
            &["cost-cube/chart.svg", "cost-cube/cost.json", "cost-cube/report.html", "cost-cube/samples.csv"],
        ),
    ] {
        folder.said(words);
        let remove = |file: &&str| fs::remove_file(folder.path(file)).expect("removed");
        // A single existing file is enough to refuse.
        files[1..].iter().for_each(remove);
        let file = files[0];
        folder.put(file, "mine");
        folder.fails(words, 1, &format!("{file}: already exists; --force overwrites it"));
        assert_eq!(folder.read(file), b"mine", "{words}");
        for more in ["--force", out] {
            // With -o a study replaces only an earlier study.
            if words != cost || more != out {
                folder.put(file, "mine");
            }
            folder.said(&format!("{words} {more}"));
            assert_ne!(folder.read(file), b"mine", "{words} {more}");
        }
        files.iter().for_each(remove);
        tried.add(1);
    }
    // Default names are printed.
    assert_eq!(folder.printed("render cube"), "cube.png\n");
    assert_eq!(folder.printed("render cube --frames 2"), "cube-0000.png\ncube-0001.png\n");
    assert_eq!(folder.printed("render cube -o cube.png"), "");
}

#[test]
fn completions_know_the_commands_and_the_options() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let script = folder.printed(&format!("generate completions {shell}"));
        for command in COMMANDS {
            assert!(script.contains(command), "{shell}: {command}");
        }
        // Fish names options without their dashes.
        for word in ["hidden-surfaces", "tessellation", "arithmetic"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
        for value in ["gouraud-vintage", "depth-buffer", "every-16"] {
            // The PowerShell generator does not list values.
            assert!(script.contains(value) || shell == "powershell", "{shell}: {value}");
        }
        assert!(!script.contains("vertex-path") && !script.contains("rung"), "{shell}");
    }
    if !is_here("bash", Command::new("bash").arg("--version").output().is_ok()) {
        return;
    }
    // What bash suggests for the last word.
    let script = folder.printed("generate completions bash");
    folder.put("mode13h.bash", script);
    for (line, offered) in [
        ("mode13h ren", "render"),
        ("mode13h render --tess", "--tessellation"),
        ("mode13h render --shading gouraud-v", "gouraud-vintage"),
        ("mode13h cost --shadings phong-", "phong-table"),
        ("mode13h generate completions fi", "fish"),
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        let complete = format!(
            "source mode13h.bash; COMP_WORDS=({line}); COMP_CWORD={}; _mode13h mode13h {} {}; echo ${{COMPREPLY[@]}}",
            words.len() - 1,
            words[words.len() - 1],
            words[words.len() - 2],
        );
        let output = Command::new("bash").args(["-c", &complete]).current_dir(&folder).output().expect("started");
        assert_eq!(printed(output).trim_end(), offered, "{line}");
    }
}

#[test]
fn man_pages_are_written_for_each_command() {
    let folder = Folder::new();
    let page = folder.printed("generate man");
    assert!(
        page.contains(".TH mode13h 1") && page.contains(".SH EXIT STATUS") && page.contains(r"hidden\-surfaces"),
        "{page}"
    );
    assert!(folder.printed("generate man -o pages").is_empty());
    let pages = |name: &str| fs::read_to_string(folder.path("pages").join(name)).expect(name);
    assert_eq!(pages("mode13h.1"), page);
    for command in COMMANDS {
        let page = pages(&format!("mode13h-{command}.1"));
        assert!(page.contains(&format!(".TH mode13h-{command} 1")), "{page}");
        for option in options(&help(command, "--help", "100")) {
            assert!(page.contains(&option.replace('-', r"\-")), "{command}: {option}: {page}");
        }
    }
    let nested = ["mode13h-generate-completions.1", "mode13h-generate-man.1", "mode13h-scenes-copy.1"];
    assert!(nested.iter().all(|name| pages(name).contains(".TH ")));
}
