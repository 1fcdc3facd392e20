//! `mode13h verify`.

use std::process::{Command, Output};
use std::sync::OnceLock;

use mode13h::span::Kernel;
use mode13h_lab::verify::{self, Frames};

use crate::support::tried::Tried;

fn run(words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mode13h")).args(words).output().expect("started")
}

/// Output of `mode13h verify`. It takes seconds, so one run serves all tests.
pub(crate) fn verified() -> &'static Output {
    static OUTPUT: OnceLock<Output> = OnceLock::new();
    OUTPUT.get_or_init(|| run(&["verify"]))
}

/// Output of `mode13h verify --json --seed 7`, from one run as well.
pub(crate) fn verified_as_json() -> &'static Output {
    static OUTPUT: OnceLock<Output> = OnceLock::new();
    OUTPUT.get_or_init(|| run(&["verify", "--json", "--seed", "7"]))
}

fn text_and_status(output: &Output) -> (&str, Option<i32>) {
    assert!(output.status.code() != Some(0) || output.stderr.is_empty(), "{output:?}");
    (str::from_utf8(&output.stdout).expect("text"), output.status.code())
}

#[test]
fn a_line_for_each_group_and_the_hash() {
    let mut tried = Tried::new("a_line_for_each_group_and_the_hash", 10);
    let (text, status) = text_and_status(verified());
    assert_eq!(status, Some(0), "{text}");
    let lines: Vec<&str> = text.lines().collect();
    let kernels: Vec<&str> = Kernel::available().map(Kernel::name).collect();
    assert_eq!(lines[0], format!("kernels {}; seed 13", kernels.join(", ")));
    assert_eq!(lines[lines.len() - 1], format!("hash {:016x}, as on every machine", Frames::EXPECTED.hash));
    for line in &lines[1..lines.len() - 1] {
        let cases = line.split(": ").nth(1).and_then(|rest| rest.split(' ').next()).expect(line);
        assert!(cases.parse::<u64>().expect(line) > 0 && line.ends_with(" cases, ok"), "{line}");
        tried.add(1);
    }
    assert_eq!(lines.len(), 2 + verify::GROUPS.len() + 1);
}

#[test]
fn the_same_for_programs() {
    let mut tried = Tried::new("the_same_for_programs", 9);
    let (text, status) = text_and_status(verified_as_json());
    assert_eq!(status, Some(0), "{text}");
    let json: serde_json::Value = serde_json::from_str(text).expect("JSON");
    assert_eq!((&json["schema"], &json["seed"], &json["passed"]), (&1.into(), &7.into(), &true.into()));
    assert_eq!(json["frames"]["hash"], format!("{:016x}", Frames::EXPECTED.hash));
    let by_kernel = json["frames"]["by_kernel"].as_array().expect("a list");
    assert_eq!(by_kernel.len(), Kernel::available().count());
    for group in json["groups"].as_array().expect("a list") {
        assert!(group["cases"].as_u64() > Some(0), "{group}");
        assert_eq!((&group["failures"], &group["record"]), (&serde_json::json!([]), &serde_json::Value::Null));
        tried.add(1);
    }
}
