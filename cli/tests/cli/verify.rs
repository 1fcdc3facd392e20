//! `mode13h verify`.

use std::process::{Command, Output};
use std::sync::OnceLock;

use mode13h::span::Kernel;
use mode13h_conformance::frames;
use mode13h_conformance::hash::START;
use tempfile::TempDir;

use crate::support::tried::Tried;

fn run(words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mode13h")).args(words).output().expect("started")
}

/// Output of `mode13h verify --json --seed 7`. It takes seconds, so one run serves all tests.
pub(crate) fn verified_as_json() -> &'static Output {
    static OUTPUT: OnceLock<Output> = OnceLock::new();
    OUTPUT.get_or_init(|| run(&["verify", "--json", "--seed", "7"]))
}

fn text_and_status(output: &Output) -> (&str, Option<i32>) {
    assert!(output.status.code() != Some(0) || output.stderr.is_empty(), "{output:?}");
    (str::from_utf8(&output.stdout).expect("text"), output.status.code())
}

/// The hash of all machines.
fn hash() -> String {
    let combine = |hash, frame: &frames::Frame| frames::combined_hash(hash, frame.expected().expect("it has one"));
    format!("{:016x}", frames::all().iter().fold(START, combine))
}

#[test]
fn frames_by_each_kernel() {
    let output = run(&["verify", "--frame", "canvas"]);
    let (text, status) = text_and_status(&output);
    assert_eq!(status, Some(0), "{text}");
    let kernels: Vec<&str> = Kernel::available().map(Kernel::name).collect();
    let count = frames::all().iter().filter(|frame| frame.name.starts_with("canvas/")).count();
    let frames = format!("frames: {count} by each kernel, {} in all, ok", count * kernels.len());
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[..2], [format!("kernels {}; seed 13", kernels.join(", ")), frames]);
    assert!(lines.len() == 3 && lines[2].starts_with("hash ") && lines[2].ends_with(", as on every machine"), "{text}");
}

#[test]
fn the_same_for_programs() {
    let mut tried = Tried::new("the_same_for_programs", 17);
    let (text, status) = text_and_status(verified_as_json());
    assert_eq!(status, Some(0), "{text}");
    let json: serde_json::Value = serde_json::from_str(text).expect("JSON");
    assert_eq!((&json["schema"], &json["seed"], &json["passed"]), (&1.into(), &7.into(), &true.into()));
    assert_eq!(json["frames"]["hash"], hash());
    let by_kernel = json["frames"]["by_kernel"].as_array().expect("a list");
    assert_eq!(by_kernel.len(), Kernel::available().count());
    for kernel in by_kernel {
        assert_eq!((&kernel["hash"], &kernel["wrong"]), (&hash().into(), &serde_json::json!([])), "{kernel}");
    }
    for outcome in json["loops"].as_array().expect("a list") {
        assert!(outcome["cases"].as_u64() > Some(0) && outcome["wrong"].is_null(), "{outcome}");
        tried.add(1);
    }
}

/// One frame by its name, as a picture; the names are listed; a name that is nearly right is answered.
#[test]
fn one_frame_is_drawn() {
    let directory = TempDir::new().expect("a directory");
    let run = |words: &str| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_mode13h"));
        program.current_dir(&directory).args(words.split(' ')).output().expect("started")
    };
    let output = run("verify --frame canvas/bands/plain -o bands.png");
    let (text, status) = text_and_status(&output);
    assert_eq!(status, Some(0), "{text}");
    assert!(text.contains("frames: 1 by each kernel") && text.contains("picture: bands.png\n"), "{text}");
    let file = std::fs::File::open(directory.path().join("bands.png")).expect("written");
    let picture = png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("a PNG");
    assert_eq!((picture.info().width, picture.info().height), (320, 200));
    let list = run("verify --list");
    assert_eq!(text_and_status(&list).0.lines().count(), frames::all().len());
    for (words, says) in [
        ("verify --frame canvas/bands/plian", "did you mean canvas/bands/plain?"),
        ("verify --frame nothing-like-it", "--list shows them"),
        ("verify --frame canvas -o a.gif", "a.gif: the name of a picture must end in .png"),
    ] {
        let output = run(words);
        let line = String::from_utf8(output.stderr).expect("text");
        assert!(output.status.code() == Some(2) && line.trim_end().ends_with(says), "{line}");
    }
}
