//! `mode13h verify`.

use std::process::Output;
use std::sync::OnceLock;

use mode13h::span::Kernel;
use mode13h_conformance::frames;
use mode13h_conformance::hash::START;

use crate::folder::{Folder, printed};
use crate::support::tried::Tried;

/// Output of `mode13h verify --json --seed 7`. It takes seconds, so one run serves all tests.
pub(crate) fn verified_as_json() -> &'static Output {
    static OUTPUT: OnceLock<Output> = OnceLock::new();
    OUTPUT.get_or_init(|| Folder::new().run("verify --json --seed 7"))
}

/// The hash that all machines must give.
fn hash() -> String {
    let combine = |hash, frame: &frames::Frame| frames::combined_hash(hash, frame.expected().expect("it has one"));
    format!("{:016x}", frames::all().iter().fold(START, combine))
}

#[test]
fn frames_by_each_kernel() {
    let text = Folder::new().printed("verify --frame canvas");
    let kernels: Vec<&str> = Kernel::available().map(Kernel::name).collect();
    let count = frames::all().iter().filter(|frame| frame.name.starts_with("canvas/")).count();
    let frames = format!("frames: {count} with each kernel, {} in all, ok", count * kernels.len());
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[..2], [format!("kernels {}; seed 13", kernels.join(", ")), frames]);
    assert!(lines.len() == 3 && lines[2].starts_with("hash ") && lines[2].ends_with(", as on every machine"), "{text}");
}

#[test]
fn the_same_for_programs() {
    let mut tried = Tried::new("the_same_for_programs", 17);
    let json: serde_json::Value = serde_json::from_str(&printed(verified_as_json().clone())).expect("JSON");
    let hash = hash();
    assert_eq!((&json["schema"], &json["seed"], &json["passed"]), (&1.into(), &7.into(), &true.into()));
    assert_eq!(json["frames"]["hash"], hash.as_str());
    let by_kernel = json["frames"]["by_kernel"].as_array().expect("a list");
    assert_eq!(by_kernel.len(), Kernel::available().count());
    for kernel in by_kernel {
        assert_eq!((&kernel["hash"], &kernel["wrong"]), (&hash.as_str().into(), &serde_json::json!([])), "{kernel}");
    }
    for outcome in json["loops"].as_array().expect("a list") {
        assert!(outcome["cases"].as_u64() > Some(0) && outcome["wrong"].is_null(), "{outcome}");
        tried.add(1);
    }
}

/// Frames can be drawn by name and listed, and a misspelled name gets a suggestion.
#[test]
fn one_frame_is_drawn() {
    let folder = Folder::new();
    let text = folder.printed("verify --frame canvas/bands/plain -o bands.PNG");
    assert!(text.contains("frames: 1 with each kernel") && text.contains("picture: bands.PNG\n"), "{text}");
    assert_eq!(folder.png("bands.PNG").size, (320, 200));
    assert_eq!(folder.printed("verify --list").lines().count(), frames::all().len());
    // What was found is printed even if the picture cannot be written.
    let unwritten = folder.run("verify --frame canvas/bands/plain -o none/x.png");
    assert_eq!(unwritten.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&unwritten.stdout).contains("frames: 1 with each kernel"));
    assert!(String::from_utf8_lossy(&unwritten.stderr).contains("none/x.png: the directory none does not exist"));
    for (words, says) in [
        ("verify --frame canvas/bands/plian", "did you mean canvas/bands/plain?"),
        ("verify --frame nothing-like-it", "--list shows them"),
        ("verify --frame canvas -o a.gif", "a.gif: the name of a picture must end in .png"),
    ] {
        folder.fails(words, 2, &format!("{says}\n"));
    }
}
