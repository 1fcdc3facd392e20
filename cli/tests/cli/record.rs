//! `mode13h record`.

use std::path::Path;
use std::process::{Command, Output};

use mode13h::palette::builtin;
use mode13h::settings::HiddenSurfaces;
use mode13h_lab::record::{Record, Run};

use crate::support::tried::Tried;

const SMALL: &str = "mode13h record 1\nframe 8 4\nclip 1 0 8 4\nbackground 9\nhidden-surfaces painter\ntriangles\n\
                     flat 7  0 0 0 1  2048 0 0 1  0 1024 65280 4294967295\nend\n";

fn run(directory: &Path, words: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mode13h"));
    command.current_dir(directory).args(words.split(' ')).output().expect("started")
}

#[track_caller]
fn assert_fails(output: &Output, status: i32, says: &str) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{said}");
    assert!(said.starts_with("mode13h: ") && said.contains(says) && said.lines().count() == 1, "{said}");
}

#[test]
fn a_frame_is_recorded_and_replayed() {
    let directory = tempfile::tempdir().expect("a directory");
    let output = run(directory.path(), "render torus -o x.png --record x.rec --turn 20 --hidden-surfaces scan-line");
    assert!(output.status.success() && output.stdout.is_empty() && output.stderr.is_empty(), "{output:?}");
    let record = Record::load(directory.path().join("x.rec")).expect("a record");
    assert_eq!(record.hidden_surfaces, HiddenSurfaces::ScanLine);
    assert_eq!(record.palette.as_ref(), builtin::by_name("grey").map(|grey| grey.palette));

    let output = run(directory.path(), "verify --replay x.rec");
    let text = String::from_utf8(output.stdout).expect("text");
    assert!(output.status.success() && output.stderr.is_empty(), "{text}");
    let triangles = record.triangles.len();
    let first = format!("frame of 320 x 200 pixels, {triangles} triangles, recorded with scan-line; ");
    assert!(text.starts_with(&first), "{text}");
    assert!(text.contains("\nscan-line: the depth buffer's frame\n"), "{text}");
    assert!(text.ends_with("the depth buffer's frame is the definition's\n"), "{text}");

    let output = run(directory.path(), "verify --replay x.rec --json");
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((&json["schema"], &json["passed"], &json["smallest"]), (&1.into(), &true.into(), &().into()));
    assert_eq!(json["triangles"], triangles);
    assert_eq!(json["comparisons"].as_array().map(Vec::len), Some(3));
}

#[test]
fn a_row_of_frames_is_a_row_of_records() {
    let directory = tempfile::tempdir().expect("a directory");
    let row = "render cube -o %d.png --frames 3 --turn 90 --record";
    assert_fails(&run(directory.path(), &format!("{row} x.rec")), 2, "x.rec: a row of records needs a place");
    assert_eq!(std::fs::read_dir(directory.path()).expect("a directory").count(), 0);
    assert!(run(directory.path(), &format!("{row} x%04d.rec")).status.success());
    for number in 0..3 {
        let record = Record::load(directory.path().join(format!("x{number:04}.rec"))).expect("a record");
        assert!(record.triangles.len() >= 2, "a front face at least");
    }
    assert!(run(directory.path(), "render cube -o x.png --turn 30 --record alone.rec").status.success());
    let read = |name: &str| std::fs::read(directory.path().join(name)).expect(name);
    assert_eq!(read("alone.rec"), read("x0001.rec"), "frame 1 of 3 is turned by 30 degrees");
}

/// The errors that a time has chosen are kept, and give equal bytes without a clock.
#[test]
fn errors_are_recorded_and_replayed() {
    let directory = tempfile::tempdir().expect("a directory");
    let pictures = |words: &str| -> Vec<Vec<u8>> {
        let output = run(directory.path(), &format!("render torus -o %d.png --frames 4 --turn 40 {words}"));
        assert!(output.status.success(), "{output:?}");
        (0..4).map(|i| std::fs::read(directory.path().join(format!("{i}.png"))).expect("a picture")).collect()
    };
    let timed = pictures("--max-time 2 --record-errors a.run");
    let recorded = Run::load(directory.path().join("a.run")).expect("a run");
    assert_eq!(recorded.errors.len(), 4);
    assert!(pictures("--replay-errors a.run") == timed);
    // Errors that differ from frame to frame.
    let errors = [16.0, 0.5, 4.0, 0.5];
    Run { errors: errors.to_vec() }.save(directory.path().join("b.run")).expect("written");
    let replayed = pictures("--replay-errors b.run --threads 3");
    for (i, error) in errors.iter().enumerate() {
        assert!(pictures(&format!("--max-error {error}"))[i] == replayed[i], "frame {i}");
    }
    std::fs::write(directory.path().join("c.run"), "mode13h run 1\n4\nfour\nend\n").expect("written");
    let row = "render torus -o %d.png --frames 5";
    for (words, status, says) in [
        (format!("{row} --replay-errors b.run"), 2, "b.run: 4 errors for 5 frames"),
        (format!("{row} --replay-errors c.run"), 2, "c.run: line 3: expected an error in shades above 0"),
        (format!("{row} --replay-errors none.run"), 3, "none.run: No such file"),
        (format!("{row} --record-errors d.run"), 2, "d.run: no --max-time chooses errors"),
        (format!("{row} --max-time 2 --record-errors none/d.run"), 3, "none/d.run: "),
    ] {
        assert_fails(&run(directory.path(), &words), status, says);
    }
    let both = run(directory.path(), &format!("{row} --replay-errors b.run --max-time 2"));
    assert_eq!(both.status.code(), Some(2));
}

#[test]
fn f4_what_cannot_be_recorded_or_replayed_is_one_line() {
    let mut tried = Tried::new("f4_what_cannot_be_recorded_or_replayed_is_one_line", 6);
    let directory = tempfile::tempdir().expect("a directory");
    std::fs::write(directory.path().join("broken.rec"), SMALL.replace("end", "flat 1")).expect("written");
    for (words, status, says) in [
        ("verify --replay none.rec", 3, "none.rec: No such file"),
        ("verify --replay broken.rec", 2, "broken.rec: line 8: expected an x in 1/256 pixel, found \"\""),
        ("verify --replay .", 3, ".: "),
        ("verify --replay broken.rec --seed 1", 2, "--seed"),
        ("render cube -o x.png --record none/x.rec", 3, "none/x.rec: the directory none does not exist"),
        ("render cube -o x.png --record x.png", 2, "x.png: one name for two files to write"),
    ] {
        assert_fails(&run(directory.path(), words), status, says);
        tried.add(1);
    }
    assert_eq!(std::fs::read_dir(directory.path()).expect("a directory").count(), 1);
}
