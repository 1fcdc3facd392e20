//! The self-checks: that they pass, that they are quick, what the program says of them; and the one hash
//! over the frames.
#![cfg(feature = "std")]

mod support;

use mode13h::span::Kernel;
use mode13h::verify::{self, Frames, Group};
use support::random::seed;
use support::tried::{Tried, is_here};

/// Every machine draws these frames. A change of the engine's bytes belongs into CHANGELOG.md; it is
/// written here and in `src/verify/frames.rs`.
const HASH: u64 = 0x6F06_1FAC_3D2B_F1DD;

#[test]
fn the_frames_are_those_of_every_machine() {
    let mut tried = Tried::new("the_frames_are_those_of_every_machine", 880);
    for kernel in Kernel::available() {
        let frames = verify::frames(kernel);
        assert_eq!(frames.hash, HASH, "{kernel}: {:#018x}", frames.hash);
        assert!(frames.passed());
        tried.add(frames.count);
    }
    assert_eq!(Frames::EXPECTED.hash, HASH);
}

#[test]
fn every_group_passes() {
    // What each tries at least, in their order.
    let stated = [190_000 / 8, 80_000, 8_000, 3_700, 40_000, 2_000, 14_000, 150, 900];
    for (group, stated) in verify::GROUPS.into_iter().zip(stated) {
        let Group { name, cases, failures, record, .. } = group(seed());
        assert!(failures.is_empty() && record.is_none(), "{name}: {failures:#?}");
        Tried::new(format!("verify_{name}"), stated).add(cases);
    }
}

#[test]
fn the_same_seed_tries_the_same_cases() {
    let mut tried = Tried::new("the_same_seed_tries_the_same_cases", 2);
    for group in [verify::triangles, verify::files] {
        assert_eq!(group(5), group(5));
        tried.add(1);
    }
}

/// Levels that this machine lacks are tried by no test; the line of `.ci/not_tried` names them.
#[cfg(all(feature = "asm", feature = "simd", target_arch = "x86_64"))]
#[test]
fn levels_that_are_missing_are_said() {
    let mut tried = Tried::new("levels_that_are_missing_are_said", 6);
    let all = ["asm", "asm-unrolled", "simd-arrays", "simd-sse2", "simd-avx2", "simd-avx512"];
    for name in all {
        is_here(name, Kernel::by_name(name).is_ok());
        tried.add(1);
    }
    let known = |kernel: &Kernel| all.contains(&kernel.name()) || ["portable", "simd"].contains(&kernel.name());
    assert!(Kernel::available().all(|kernel| known(&kernel)), "a kernel that is not in this list");
}

#[cfg(feature = "cli")]
mod program {
    use std::process::Command;

    use super::*;

    fn run(words: &[&str]) -> (String, Option<i32>) {
        let output = Command::new(env!("CARGO_BIN_EXE_mode13h")).args(words).output().expect("started");
        assert!(output.status.code() != Some(0) || output.stderr.is_empty(), "{output:?}");
        (String::from_utf8(output.stdout).expect("text"), output.status.code())
    }

    #[test]
    fn a_line_for_each_group_and_the_hash() {
        let mut tried = Tried::new("a_line_for_each_group_and_the_hash", 10);
        let (text, status) = run(&["verify"]);
        assert_eq!(status, Some(0), "{text}");
        let lines: Vec<&str> = text.lines().collect();
        let kernels: Vec<&str> = Kernel::available().map(Kernel::name).collect();
        assert_eq!(lines[0], format!("kernels {}; seed 13", kernels.join(", ")));
        assert_eq!(lines[lines.len() - 1], format!("hash {HASH:016x}, as on every machine"));
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
        let (text, status) = run(&["verify", "--json", "--seed", "7"]);
        assert_eq!(status, Some(0), "{text}");
        let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!((&json["schema"], &json["seed"], &json["passed"]), (&1.into(), &7.into(), &true.into()));
        assert_eq!(json["frames"]["hash"], format!("{HASH:016x}"));
        let by_kernel = json["frames"]["by_kernel"].as_array().expect("a list");
        assert_eq!(by_kernel.len(), Kernel::available().count());
        for group in json["groups"].as_array().expect("a list") {
            assert!(group["cases"].as_u64() > Some(0), "{group}");
            assert_eq!((&group["failures"], &group["record"]), (&serde_json::json!([]), &serde_json::Value::Null));
            tried.add(1);
        }
    }
}
