//! `tests/HARD_CASES.md` against the tests: every hard case has one row, every row names its tests, and every test
//! exists, is named, and reports how many cases it tested.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::support::workspace;

/// The groups of cases, and the number of cases in each.
const GROUPS: [(char, u32); 9] =
    [('S', 7), ('R', 14), ('C', 5), ('N', 9), ('T', 3), ('D', 4), ('P', 5), ('E', 1), ('F', 5)];

/// The folders of the workspace that hold tests.
const SOURCES: [&str; 7] = ["src", "tests", "assets/tests", "lab/src", "lab/tests", "cli/src", "cli/tests"];

/// What a row says instead of tests while the feature to test does not exist yet.
const PENDING: &str = "pending: feature";

fn ids() -> impl Iterator<Item = String> {
    GROUPS.into_iter().flat_map(|(group, count)| (1..=count).map(move |number| format!("{group}{number}")))
}

/// Returns whether a name is that of a test of the case: `r5_…` for R5.
fn is_named_after(name: &str, id: &str) -> bool {
    name.strip_prefix(&id.to_lowercase()).is_some_and(|rest| rest.starts_with('_'))
}

fn is_in_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

// The list

/// A row of a table whose first cell is a group's letter and a number.
struct Row<'a> {
    id: &'a str,
    /// The names in backticks that begin with the case.
    tests: Vec<&'a str>,
    is_pending: bool,
}

fn rows(list: &str) -> Vec<Row<'_>> {
    list.lines().filter_map(row).collect()
}

fn row(line: &str) -> Option<Row<'_>> {
    let first = line.trim_start().strip_prefix('|')?.split('|').next()?;
    let id = first.trim_matches(|c: char| !is_in_word(c));
    let number = id.strip_prefix(|c| GROUPS.iter().any(|group| group.0 == c))?;
    if number.is_empty() || !number.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let quoted = line.split('`').skip(1).step_by(2);
    let words = quoted.flat_map(|text| text.split(|c| !is_in_word(c)));
    Some(Row { id, tests: words.filter(|word| is_named_after(word, id)).collect(), is_pending: line.contains(PENDING) })
}

// The sources, as rustfmt formats them

struct Function {
    file: String,
    name: String,
    /// Without comments and without the space after an opening bracket.
    body: String,
    is_test: bool,
}

fn functions(file: &str, text: &str) -> Vec<Function> {
    let stamped = stamped(text);
    let lines: Vec<&str> = text.lines().collect();
    let mut functions = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        let Some(name) = function_name(line) else { continue };
        let indent = &line[..line.len() - line.trim_start().len()];
        let ends = |j: &usize| if *j == i { line.ends_with(['}', ';']) } else { lines[*j] == format!("{indent}}}") };
        let end = (i..lines.len()).find(ends).unwrap_or(lines.len() - 1);
        let mut body = String::new();
        for part in lines[i..=end].iter().map(|line| line.trim()).filter(|line| !line.starts_with("//")) {
            body += part;
            if !part.ends_with('(') {
                body.push('\n');
            }
        }
        let is_test = stamped.contains(&name) || is_marked(&lines[..i]);
        functions.push(Function { file: file.to_owned(), name: name.to_owned(), body, is_test });
    }
    functions
}

/// The name of the function that starts on a line.
fn function_name(line: &str) -> Option<&str> {
    let mut rest = line.trim_start();
    while let Some(after) = ["pub ", "pub(crate) ", "const ", "unsafe "].iter().find_map(|word| rest.strip_prefix(word))
    {
        rest = after;
    }
    let name = rest.strip_prefix("fn ")?.split(|c| !is_in_word(c)).next()?;
    (!name.is_empty()).then_some(name)
}

/// Returns whether `#[test]` is among the attributes and comments at the end of these lines.
fn is_marked(before: &[&str]) -> bool {
    let lines = before.iter().rev().map(|line| line.trim());
    lines
        .take_while(|line| line.starts_with("//") || !(line.is_empty() || line.ends_with(['{', '}', ';'])))
        .any(|line| line == "#[test]")
}

/// Functions that a macro in the file turns into tests: one that writes `#[test]` above `fn $…`, and is called with
/// their names.
fn stamped(text: &str) -> Vec<&str> {
    let mut names = Vec::new();
    for definition in text.split("macro_rules! ").skip(1) {
        let macro_name = definition.split(|c| !is_in_word(c)).next().unwrap_or_default();
        let definition = definition.split("\n}").next().unwrap_or_default();
        if definition.split("#[test]").skip(1).any(|after| after.trim_start().starts_with("fn $")) {
            let call = format!("{macro_name}!(");
            let calls = text.split(&call).skip(1);
            names.extend(calls.filter_map(|call| call.split(')').next()).flat_map(|list| list.split([',', ' ', '\n'])));
        }
    }
    names
}

/// Returns whether a test of this case reports the number of cases under its name: by itself, as `Tried::new("r5_…",
/// …)` or, once per kernel, `Tried::new(format!("s2_… {}", …)`; or through a function of its file that takes the name,
/// or the part of it after `s7_`.
fn reports(test: &Function, id: &str, functions: &[Function]) -> bool {
    let name = &test.name;
    let by_itself = [format!("Tried::new(\"{name}\","), format!("Tried::new(format!(\"{name} {{}}\",")];
    let of_the_case = format!("Tried::new(format!(\"{}_{{", id.to_lowercase());
    by_itself.iter().any(|form| test.body.contains(form))
        || functions.iter().filter(|other| other.file == test.file && !other.is_test).any(|helper| {
            let is_called = |with: &str| {
                let call = format!("{}({with}", helper.name);
                test.body.match_indices(&call).any(|(at, _)| !test.body[..at].ends_with(is_in_word))
            };
            let takes_the_name = helper.body.split("Tried::new(").skip(1).any(|argument| {
                let argument = argument.strip_prefix("format!(\"{").unwrap_or(argument);
                argument.starts_with(|c: char| c.is_ascii_lowercase()) && !argument.starts_with("format!")
            });
            takes_the_name && is_called(&format!("\"{name}\"")) || helper.body.contains(&of_the_case) && is_called("")
        })
}

// One against the other

fn faults(list: &str, functions: &[Function]) -> Vec<String> {
    let rows = rows(list);
    let mut faults = Vec::new();
    for row in rows.iter().filter(|row| ids().all(|id| id != row.id)) {
        faults.push(format!("{}: a row for a case that there is not", row.id));
    }
    for id in ids() {
        let own: Vec<_> = rows.iter().filter(|row| row.id == id).collect();
        if own.len() != 1 {
            faults.push(format!("{id}: {} rows", own.len()));
        }
        for row in &own {
            if row.tests.is_empty() && !row.is_pending {
                faults.push(format!("{id}: names no test and is not `{PENDING}`"));
            }
            for name in &row.tests {
                if !functions.iter().any(|function| function.is_test && function.name == *name) {
                    faults.push(format!("{id}: there is no test {name}"));
                }
            }
        }
        for test in functions.iter().filter(|function| function.is_test && is_named_after(&function.name, &id)) {
            let Function { file, name, .. } = test;
            if !own.iter().any(|row| row.tests.contains(&name.as_str())) {
                faults.push(format!("{id}: the row does not name {name} of {file}"));
            }
            if !reports(test, &id, functions) {
                faults.push(format!("{id}: {name} of {file} does not report its cases by Tried::new(\"{name}\", …)"));
            }
            if functions.iter().any(|other| other.is_test && other.name == *name && other.file < *file) {
                faults.push(format!(
                    "{id}: another test is called {name}, as that of {file}: one report would hide the other"
                ));
            }
        }
    }
    faults
}

/// The functions in [`SOURCES`], except those in this file, whose samples do not count.
fn all_functions() -> Vec<Function> {
    let files = SOURCES.into_iter().flat_map(workspace::sources);
    let files = files.filter(|(path, _)| path != "tests/render/hard_cases.rs");
    files.flat_map(|(path, text)| functions(&path, &text)).collect()
}

/// For every case the tests in the sources, in backticks, ready to paste into its row.
fn tests_by_case(functions: &[Function]) -> String {
    let mut text = String::new();
    for id in ids() {
        let tests = functions.iter().filter(|function| function.is_test && is_named_after(&function.name, &id));
        let names: Vec<_> = tests.map(|test| format!("`{}`", test.name)).collect();
        let _ = writeln!(text, "{id:<4} {}", names.join(", "));
    }
    text
}

/// For every case what the last runs of its tests have reported, if they have run.
fn reported_by_case() -> String {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("tried");
    let files = fs::read_dir(directory).into_iter().flatten().flatten();
    let mut reports: Vec<_> = files.filter_map(|file| fs::read_to_string(file.path()).ok()).collect();
    reports.sort();
    let mut text = String::new();
    for id in ids() {
        let own: Vec<_> = reports.iter().filter(|report| is_named_after(report, &id)).collect();
        if own.is_empty() {
            let _ = writeln!(text, "{id:<4} not run");
        }
        for report in own {
            let _ = writeln!(text, "{id:<4} {}", report.trim_end());
        }
    }
    text
}

#[test]
fn every_hard_case_has_tests_that_report() {
    let list = workspace::root().join("tests/HARD_CASES.md");
    let list = fs::read_to_string(list).expect("tests/HARD_CASES.md");
    let functions = all_functions();
    let faults = faults(&list, &functions);
    if !faults.is_empty() {
        println!("The tests that there are:\n\n{}", tests_by_case(&functions));
    }
    println!("The cases that were last tried:\n\n{}", reported_by_case());
    assert!(
        faults.is_empty(),
        "{} faults of tests/HARD_CASES.md or of the tests:\n{}",
        faults.len(),
        faults.join("\n")
    );
}

/// The table of the long run in docs/measurements.md names existing tests.
#[test]
fn every_long_test_is_in_the_measurements() {
    let document = workspace::root().join("docs/measurements.md");
    let document = fs::read_to_string(document).expect("docs/measurements.md");
    let table = document.split("<!-- tried -->").nth(1).and_then(|rest| rest.split("<!-- /tried -->").next());
    let table = table.expect("a table between two marks");
    let functions = all_functions();
    let long = functions.iter().filter(|function| function.is_test && function.name.split('_').nth(1) == Some("long"));
    let mut names: Vec<_> = long.map(|function| function.name.as_str()).collect();
    names.sort_unstable();
    let mut listed: Vec<_> = table.split('`').skip(1).step_by(2).collect();
    listed.sort_unstable();
    assert_eq!(listed, names, "run the long tests, then .ci/tried_table docs/measurements.md");
}

// The checks can fail.

/// A valid list and file.
fn sample() -> (String, String) {
    let (mut list, mut source) = (String::from("| id | case | tests |\n|---|---|---|\n"), String::new());
    for id in ids() {
        let name = format!("{}_works", id.to_lowercase());
        let _ = writeln!(list, "| {id} | a case | `{name}` |");
        let _ = writeln!(source, "#[test]\nfn {name}() {{\n    let mut tried = Tried::new(\"{name}\", 1);\n}}\n");
    }
    (list, source)
}

/// What is found after `from` is replaced by `to` in the list, or else in the file.
#[track_caller]
fn faults_after(from: &str, to: &str) -> Vec<String> {
    let (list, source) = sample();
    assert_ne!(list.contains(from), source.contains(from), "{from} is in one of the two");
    faults(&list.replacen(from, to, 1), &functions("tests/sample.rs", &source.replacen(from, to, 1)))
}

#[test]
fn lists_and_tests_in_order_pass() {
    let (list, source) = sample();
    assert_eq!(ids().count(), 53);
    assert_eq!(faults(&list, &functions("tests/sample.rs", &source)), [""; 0]);
    for (from, to) in [
        ("| `r5_works` |", "| see `tests/sample.rs::r5_works()`, `other` and `r6_works` | |"),
        ("| R5 |", "| **R5** |"),
        ("| id |", "| S0 and S4 | a row of something else |\n| `T` |"),
        ("Tried::new(\"r5_works\", 1)", "Tried::new(\n        \"r5_works\",\n        1\n    )"),
        ("Tried::new(\"s2_works\", 1)", "Tried::new(format!(\"s2_works {}\", kernel.name()), 1)"),
        ("#[test]\nfn s1_works", "/// With { braces };\n#[test]\n#[ignore = \"long\"]\nfn s1_works"),
        ("#[test]\nfn s1_works", "fn s1_helper() {}\n\n#[test]\nfn s1_works"),
        ("#[test]\nfn s1_works", "#[test]\nfn f32_is_no_case() {}\n\n#[test]\nfn s1_works"),
        (
            "#[test]\nfn s1_works()",
            "macro_rules! stamp {\n    (@each $t:ident) => {\n        #[test]\n        fn $t() {}\n    };\n}\n\
             stamp!(@each: s0,\n    s1_works);\nfn s1_works(kernel: Kernel)",
        ),
        (
            "let mut tried = Tried::new(\"s7_works\", 1);\n}",
            "rules(\"works\");\n}\nfn rules(name: &str) {\n    Tried::new(format!(\"s7_{name}\"), 1);\n}",
        ),
        (
            "let mut tried = Tried::new(\"r5_works\", 1);\n}",
            "all(\"r5_works\", 1);\n}\nfn all(test: &str) {\n    Tried::new(test, 1);\n}",
        ),
        (
            "let mut tried = Tried::new(\"r5_works\", 1);\n}",
            "all(\"r5_works\", 1);\n}\nfn all(test: &str) {\n    Tried::new(format!(\"{test} {}\", 1), 1);\n}",
        ),
    ] {
        assert_eq!(faults_after(from, to), [""; 0], "{to}");
    }
}

#[test]
fn each_fault_is_found() {
    let unreported = "R5: r5_works of tests/sample.rs does not report its cases by Tried::new(\"r5_works\", …)";
    let body = "let mut tried = Tried::new(\"r5_works\", 1);\n}";
    for (from, to, found) in [
        (
            "| R5 | a case | `r5_works` |\n",
            "",
            &["R5: 0 rows", "R5: the row does not name r5_works of tests/sample.rs"][..],
        ),
        ("| R5 |", "| R5 | `r5_works` |\n| R5 |", &["R5: 2 rows"]),
        ("| id |", "| S8 | `s8_works` |\n| id |", &["S8: a row for a case that there is not"]),
        (
            "`r5_works`",
            "r5_works",
            &[
                "R5: names no test and is not `pending: feature`",
                "R5: the row does not name r5_works of tests/sample.rs",
            ],
        ),
        ("`r5_works`", "pending: feature", &["R5: the row does not name r5_works of tests/sample.rs"]),
        ("`r5_works`", "`r5_works`, `r5_flies`", &["R5: there is no test r5_flies"]),
        ("#[test]\nfn r5_works", "fn r5_works", &["R5: there is no test r5_works"]),
        ("#[test]\nfn r5_works", "// #[test]\nfn r5_works", &["R5: there is no test r5_works"]),
        (body, "}", &[unreported]),
        (body, "// let mut tried = Tried::new(\"r5_works\", 1);\n}", &[unreported]),
        (body, "let mut tried = Tried::new(\"r5\", 1);\n}", &[unreported]),
        (body, "all(\"r5_works\");\n}\nfn all(test: &str) {\n    Tried::new(\"all\", 1);\n}", &[unreported]),
        (body, "all(1);\n}\nfn all(test: &str) {\n    Tried::new(test, 1);\n}", &[unreported]),
        (body, "small(\"r5_works\");\n}\nfn all(test: &str) {\n    Tried::new(test, 1);\n}", &[unreported]),
    ] {
        assert_eq!(faults_after(from, to), found, "{from:?} became {to:?}");
    }
    let (list, source) = sample();
    let mut twice = functions("tests/sample.rs", &source);
    twice.extend(functions("tests/twin.rs", "#[test]\nfn r5_works() {\n    Tried::new(\"r5_works\", 1);\n}\n"));
    assert_eq!(
        faults(&list, &twice),
        ["R5: another test is called r5_works, as that of tests/twin.rs: one report would hide the other"]
    );
}
