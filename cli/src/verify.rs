//! `mode13h verify`: what the library checks on this machine.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use mode13h::span::Kernel;
use mode13h_lab::record::{Record, RecordErrorKind};
use mode13h_lab::verify::{self, Frames, Group, Replay};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::output;

#[derive(Args)]
pub(crate) struct Options {
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
    /// The number that the random cases are made from
    ///
    /// The same number makes the same cases.
    #[arg(long, value_name = "N", default_value_t = 13)]
    seed: u64,
    /// Check a frame that `render --record` kept, instead of the cases
    ///
    /// It is drawn by every kernel, with hidden surfaces left out in every way, and by the slow oracle. The frames are
    /// compared.
    #[arg(long, value_name = "FILE", conflicts_with = "seed")]
    replay: Option<PathBuf>,
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    match &options.replay {
        Some(path) => replay(path, options.json),
        None => check(options),
    }
}

fn kernels() -> Vec<&'static str> {
    Kernel::available().map(Kernel::name).collect()
}

fn check(options: &Options) -> Result<(), Failure> {
    let groups = verify::GROUPS.map(|group| group(options.seed));
    let frames: Vec<(Kernel, Frames)> = Kernel::available().map(|kernel| (kernel, verify::frames(kernel))).collect();
    let mut failed = groups.iter().filter(|group| !group.passed()).count();
    failed += usize::from(frames.iter().any(|(_, frames)| !frames.passed()));
    output::print(&if options.json {
        as_json(&groups, &frames, options.seed, failed == 0)
    } else {
        as_text(&groups, &frames, options.seed)
    })?;
    verdict(failed, groups.len() + 1)
}

fn verdict(failed: usize, groups: usize) -> Result<(), Failure> {
    match failed {
        0 => Ok(()),
        _ => Err(Failure::found(format!("{failed} of {groups} groups failed"))),
    }
}

fn as_text(groups: &[Group], frames: &[(Kernel, Frames)], seed: u64) -> String {
    let mut text = format!("kernels {}; seed {seed}\n", kernels().join(", "));
    for group in groups {
        let verdict = match group.failures.len() {
            // A group that tried nothing has shown nothing.
            0 if group.cases == 0 => "FAILED, nothing was tried".to_string(),
            0 => "ok".to_string(),
            failures => format!("FAILED, {failures} of them"),
        };
        text += &format!("{}: {} cases, {verdict}\n", group.name, group.cases);
        text += &failures(&group.failures, group.record.as_ref());
    }
    text + &frames_as_text(frames)
}

fn frames_as_text(frames: &[(Kernel, Frames)]) -> String {
    let Frames { count, hash, .. } = Frames::EXPECTED;
    let wrong: Vec<&(Kernel, Frames)> = frames.iter().filter(|(_, frames)| !frames.passed()).collect();
    let cases: u64 = frames.iter().map(|(_, frames)| frames.count).sum();
    let mut text = match wrong.len() {
        0 => format!("frames: {cases} cases, ok\nhash {hash:016x}, as on every machine\n"),
        _ => format!("frames: {cases} cases, FAILED, {} of them\n", wrong.len()),
    };
    for (kernel, frames) in wrong {
        let Frames { count: drawn, hash: is, .. } = frames;
        // Writing to a string cannot fail.
        let _ = writeln!(text, "    {kernel}: hash {is:016x} of {drawn} frames, not {hash:016x} of {count}");
    }
    text
}

/// The lines of failures, and below them what can be replayed.
fn failures(lines: &[String], record: Option<&Record>) -> String {
    let mut text: String = lines.iter().map(|line| format!("    {line}\n")).collect();
    if let Some(record) = record {
        text += "    to see it again, put the lines below into a file and verify --replay it:\n";
        text.extend(record.to_string().lines().map(|line| format!("        {line}\n")));
    }
    text
}

fn as_json(groups: &[Group], frames: &[(Kernel, Frames)], seed: u64, passed: bool) -> String {
    let groups: Vec<Value> = groups
        .iter()
        .map(|group| {
            let record = group.record.as_ref().map(Record::to_string);
            json!({ "name": group.name, "cases": group.cases, "failures": group.failures, "record": record })
        })
        .collect();
    let hex = |hash: u64| format!("{hash:016x}");
    let by_kernel: Vec<Value> = frames
        .iter()
        .map(|(kernel, frames)| json!({ "kernel": kernel.name(), "frames": frames.count, "hash": hex(frames.hash) }))
        .collect();
    let frames = json!({ "hash": hex(Frames::EXPECTED.hash), "by_kernel": by_kernel });
    let all = json!({
        "schema": 1, "passed": passed, "seed": seed, "kernels": kernels(), "groups": groups, "frames": frames,
    });
    format!("{all:#}\n")
}

fn replay(path: &Path, as_json: bool) -> Result<(), Failure> {
    let record = Record::load(path).map_err(|error| {
        let line = format!("{}: {error}", path.display());
        if matches!(error.kind, RecordErrorKind::Read(_)) { Failure::file(line) } else { Failure::words(line) }
    })?;
    let replay = verify::replay(&record);
    output::print(&if as_json { replay_as_json(&record, &replay) } else { replay_as_text(&record, &replay) })?;
    match replay.failures.as_slice() {
        [] => Ok(()),
        [first, ..] => Err(Failure::found(format!("{}: {first}", path.display()))),
    }
}

fn replay_as_text(record: &Record, replay: &Replay) -> String {
    let mut text = format!(
        "frame of {} x {} pixels, {} triangles, recorded with {}; {} pixels covered, {} more than once\nkernels {}\n",
        record.width(),
        record.height(),
        record.triangles.len(),
        record.hidden_surfaces,
        replay.covered,
        replay.overlaid,
        kernels().join(", ")
    );
    for comparison in &replay.comparisons {
        let verdict = match (comparison.pixels, comparison.must_agree) {
            (0, _) => "the depth buffer's frame".to_string(),
            (pixels, true) => format!("FAILED, {pixels} pixels are not the depth buffer's"),
            (pixels, false) => format!("{pixels} pixels are not the depth buffer's, which is no failure"),
        };
        text += &format!("{}: {verdict}\n", comparison.hidden_surfaces);
    }
    text += match replay.failures.len() {
        0 => "every kernel the same bytes, whole and in bands; the depth buffer's frame is the definition's\n",
        _ => "FAILED\n",
    };
    text + &failures(&replay.failures, replay.smallest.as_ref())
}

fn replay_as_json(record: &Record, replay: &Replay) -> String {
    let comparisons: Vec<Value> = replay
        .comparisons
        .iter()
        .map(|comparison| {
            json!({
                "hidden_surfaces": comparison.hidden_surfaces.name(),
                "pixels": comparison.pixels,
                "must_agree": comparison.must_agree,
            })
        })
        .collect();
    let all = json!({
        "schema": 1,
        "passed": replay.failures.is_empty(),
        "kernels": kernels(),
        "width": record.width(),
        "height": record.height(),
        "triangles": record.triangles.len(),
        "hidden_surfaces": record.hidden_surfaces.name(),
        "covered": replay.covered,
        "overlaid": replay.overlaid,
        "comparisons": comparisons,
        "failures": replay.failures,
        "smallest": replay.smallest.as_ref().map(Record::to_string),
    });
    format!("{all:#}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_group_that_failed_is_a_finding() {
        assert_eq!(verdict(0, 9), Ok(()));
        let failure = verdict(2, 9).expect_err("two failed");
        assert_eq!((failure.status(), failure.to_string().as_str()), (1, "2 of 9 groups failed"));
    }
}
