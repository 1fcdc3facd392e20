//! `mode13h cases`.

use std::process::{Command, Output};

use mode13h_lab::hard_cases::{CASES, by_id};

fn run(directory: &tempfile::TempDir, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mode13h")).current_dir(directory).args(words).output().expect("started")
}

fn names_in(directory: &tempfile::TempDir) -> Vec<String> {
    let entries = std::fs::read_dir(directory).expect("a directory");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn cases_without_an_id_lists_the_cases_and_writes_nothing() {
    let directory = tempfile::tempdir().expect("a directory");
    let output = run(&directory, &["cases"]);
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    let list = String::from_utf8(output.stdout).expect("text");
    assert_eq!(list.lines().count(), CASES.len());
    for (line, case) in list.lines().zip(CASES) {
        assert!(line.starts_with(case.id) && line.contains(case.sentence), "{line}");
    }
    assert!(names_in(&directory).is_empty());
}

#[test]
fn cases_writes_where_it_is_told_in_silence() {
    let directory = tempfile::tempdir().expect("a directory");
    let output = run(&directory, &["cases", "d1", "-o", "circle.png"]);
    assert!(output.status.success() && output.stdout.is_empty() && output.stderr.is_empty(), "{output:?}");
    let case = by_id("D1").expect("a case");
    let written = std::fs::read(directory.path().join("circle.png")).expect("written");
    assert_eq!(written, case.png().expect("memory"));
    assert_eq!(names_in(&directory), ["circle.png"]);
}

#[test]
fn cases_without_a_name_says_where_and_overwrites_by_force_alone() {
    let directory = tempfile::tempdir().expect("a directory");
    let read = || std::fs::read(directory.path().join("R5.png")).expect("there");
    let says_where = |output: &Output| {
        assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
        assert!(String::from_utf8_lossy(&output.stdout).starts_with("R5.png: "), "{output:?}");
    };
    says_where(&run(&directory, &["cases", "r5"]));
    let picture = read();
    std::fs::write(directory.path().join("R5.png"), "mine").expect("written");
    let output = run(&directory, &["cases", "r5"]);
    let line = String::from_utf8_lossy(&output.stderr);
    assert_eq!((output.status.code(), read()), (Some(3), b"mine".to_vec()), "{line}");
    assert!(line.starts_with("mode13h: R5.png: already exists; --force ") && line.lines().count() == 1, "{line}");
    says_where(&run(&directory, &["cases", "r5", "--force"]));
    assert_eq!((read(), names_in(&directory)), (picture, vec!["R5.png".to_string()]));
}

#[test]
fn cases_of_wrong_words_is_one_line_and_status_2() {
    let directory = tempfile::tempdir().expect("a directory");
    let cases: [(&[&str], i32, &str); 5] = [
        (&["cases", "R99"], 2, "there are R1, R2"),
        (&["cases", "S4"], 2, "no case 'S4'"),
        (&["cases", "R5", "-o", "r5.gif"], 2, "r5.gif"),
        (&["cases", "-o", "r5.png"], 2, "<ID>"),
        (&["cases", "R5", "-o", "no/such/place.png"], 3, "place.png"),
    ];
    for (words, status, says) in cases {
        let output = run(&directory, words);
        let line = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{words:?}: {line}");
        assert!(line.starts_with("mode13h: ") && line.contains(says), "{words:?}: {line}");
        assert_eq!(line.lines().count(), 1, "{words:?}: {line}");
        assert!(output.stdout.is_empty() && names_in(&directory).is_empty(), "{words:?}");
    }
}
