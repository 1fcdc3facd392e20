//! Everything that the documents name exists: options, their values, keys of scenes and of the window, names of
//! shadings and effects, files.

use std::collections::BTreeSet;

use mode13h::plan::{Effect, FaceShading};
use mode13h::settings::DitherPattern;
use mode13h::settings::{HiddenSurfaces, Mapping, Shading, VertexPath};
use mode13h::span::Kernel;
use mode13h_assets::look::Look;
use mode13h_assets::shipped;
use mode13h_assets::terminal::Protocol;

use crate::folder::Folder;
use crate::support::tried::Tried;

/// The documents that a user reads.
const DOCUMENTS: [(&str, &str); 6] = [
    ("README.md", include_str!("../../../../README.md")),
    ("docs/program.md", PROGRAM),
    ("docs/budget.md", include_str!("../../../../docs/budget.md")),
    ("docs/measurements.md", include_str!("../../../../docs/measurements.md")),
    ("assets/scenes/README.md", SCENES),
    ("CHANGELOG.md", include_str!("../../../../CHANGELOG.md")),
];

/// The documents for contributors: only the files that they name are checked, not other names.
const MORE_DOCUMENTS: [(&str, &str); 15] = [
    ("ARCHITECTURE.md", include_str!("../../../../ARCHITECTURE.md")),
    ("CONTRIBUTING.md", include_str!("../../../../CONTRIBUTING.md")),
    ("docs/decisions.md", include_str!("../../../../docs/decisions.md")),
    ("docs/sources.md", SOURCES),
    ("docs/testing.md", include_str!("../../../../docs/testing.md")),
    ("docs/machines.md", include_str!("../../../../docs/machines.md")),
    ("docs/c.md", include_str!("../../../../docs/c.md")),
    ("python/README.md", include_str!("../../../../python/README.md")),
    ("examples/README.md", include_str!("../../../../examples/README.md")),
    ("palettes/README.md", include_str!("../../../../palettes/README.md")),
    ("tests/HARD_CASES.md", include_str!("../../../../tests/HARD_CASES.md")),
    ("web/README.md", include_str!("../../../../web/README.md")),
    ("web/text/README.md", include_str!("../../../../web/text/README.md")),
    ("lab/README.md", include_str!("../../../../lab/README.md")),
    ("cli/README.md", include_str!("../../../README.md")),
];

/// Contains the table of shadings and the keys of the window.
const PROGRAM: &str = include_str!("../../../../docs/program.md");
/// Contains a command for everything that the source texts describe.
const SOURCES: &str = include_str!("../../../../docs/sources.md");
const SCENES: &str = include_str!("../../../../assets/scenes/README.md");

/// Options of other programs: cargo, the scripts in `.ci`, the benchmark against peers.
const OTHERS: &str =
    "--bench --ignored --no-fail-fast --path --profile --rabbit --release --renew --table --test --test-threads";

fn help(command: &str) -> String {
    Folder::new().printed(&format!("{command} --help"))
}

/// The options that a text names, such as `--shading`.
fn options(text: &str) -> BTreeSet<&str> {
    let starts = text.match_indices("--").map(|(at, _)| at);
    let word = |at: usize| {
        let rest = &text[at + 2..];
        let end = rest.find(|c: char| !c.is_ascii_lowercase() && c != '-').unwrap_or(rest.len());
        rest[..end].starts_with(|c: char| c.is_ascii_lowercase()).then_some(&text[at..at + 2 + end])
    };
    // Not inside a word or a table's rule.
    starts.filter(|at| !text[..*at].ends_with(|c: char| c.is_alphanumeric() || c == '-')).filter_map(word).collect()
}

/// The program's commands, with the options that each has.
fn commands() -> Vec<(String, BTreeSet<String>)> {
    let all = help("");
    let listed = all.split("\nCommands:\n").nth(1).expect("commands").split("\n\n").next().expect("a list");
    let names = listed.lines().filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
    let names = names.filter(|name| !name.is_empty() && *name != "help");
    names
        .map(|name| {
            let help = help(name);
            (name.to_string(), options(&help).into_iter().map(String::from).collect())
        })
        .collect()
}

/// Texts between backticks, outside of blocks of code.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter(|line| !line.starts_with("    ")).flat_map(|line| line.split('`').skip(1).step_by(2))
}

#[test]
fn all_that_the_source_texts_describe_is_seen_by_a_command() {
    let mut tried = Tried::new("all_that_the_source_texts_describe_is_seen_by_a_command", 26);
    let table = SOURCES.split("| see it with").nth(1).expect("a table");
    for row in table.lines().skip(2).take_while(|line| line.starts_with('|')) {
        let command = row.split('`').nth(1).expect("a command");
        // This one takes long, and has tests of its own.
        if command != "verify" {
            Folder::new().said(command);
        }
        tried.add(1);
    }
}

#[test]
fn documents_name_options_that_the_program_has() {
    let mut tried = Tried::new("documents_name_options_that_the_program_has", 40);
    let commands = commands();
    assert!(commands.len() >= 9, "{commands:?}");
    let every: BTreeSet<&str> = commands.iter().flat_map(|(_, options)| options).map(String::as_str).collect();
    for (document, text) in DOCUMENTS {
        for option in options(text) {
            let known = every.contains(option) || OTHERS.split(' ').any(|other| other == option);
            assert!(known, "{document}: {option} is no option of the program");
            tried.add(1);
        }
        // In a command line, options must be those of its own command.
        for line in text.lines() {
            let Some((_, words)) = line.split_once("run --release -- ").or_else(|| line.split_once("mode13h ")) else {
                continue;
            };
            let words = words.split('#').next().unwrap_or_default();
            let Some((command, own)) = commands.iter().find(|(name, _)| words.split(' ').next() == Some(name)) else {
                continue;
            };
            let typed = words.split('`').next().unwrap_or_default();
            for option in options(typed) {
                assert!(own.contains(option), "{document}: {command} has no {option}: {line}");
                tried.add(1);
            }
        }
    }
}

/// In `--shading phong`, for example, the second word must be a shading.
#[test]
fn documents_give_options_values_that_they_take() {
    let mut tried = Tried::new("documents_give_options_values_that_they_take", 15);
    for (document, text) in DOCUMENTS {
        for quote in quoted(text) {
            let words: Vec<&str> = quote.split(' ').collect();
            for pair in words.windows(2) {
                // A placeholder, or more than one word.
                let value = pair[1];
                if !value.starts_with(|c: char| c.is_ascii_lowercase()) {
                    continue;
                }
                let known = match pair[0] {
                    "--shading" => mode13h_assets::scene_file::in_full(value).parse::<Shading>().is_ok(),
                    "--dither" => value.parse::<DitherPattern>().is_ok(),
                    "--hidden-surfaces" => value.parse::<HiddenSurfaces>().is_ok(),
                    "--mapping" => value.parse::<Mapping>().is_ok(),
                    "--look" => value.parse::<Look>().is_ok(),
                    "--to" => value.parse::<Protocol>().is_ok(),
                    "--arithmetic" => value.parse::<VertexPath>().is_ok(),
                    "--palette" => value == "auto" || mode13h::palette::builtin::by_name(value).is_some(),
                    _ => continue,
                };
                assert!(known, "{document}: {} takes no {value}", pair[0]);
                tried.add(1);
            }
        }
    }
}

/// The cell of a row of `assets/scenes/README.md` that says what a key takes.
fn values_of(key: &str) -> Vec<&'static str> {
    let row = SCENES.lines().find(|line| line.starts_with(&format!("| `{key}` |"))).expect(key);
    let cell = row.split('|').nth(2).expect("a value");
    cell.split('"').skip(1).step_by(2).collect()
}

#[test]
fn documents_list_every_shading_and_every_way() {
    let mut tried = Tried::new("documents_list_every_shading_and_every_way", 6);
    assert_eq!(values_of("shading"), Shading::ALL.map(Shading::name));
    assert_eq!(values_of("hidden-surfaces"), HiddenSurfaces::ALL.map(HiddenSurfaces::name));
    assert_eq!(values_of("mapping"), Mapping::ALL.map(Mapping::name));
    assert_eq!(values_of("look"), Look::ALL.map(Look::name));
    // The names in the first column of a table of docs/program.md.
    let rows = |heading: &str| -> Vec<&str> {
        let table = PROGRAM.split(heading).nth(1).expect("the table").split("\n\n").next().expect("rows");
        table.lines().filter_map(|line| line.strip_prefix("| `")?.split('`').next()).collect()
    };
    assert_eq!(rows("| look | colours |"), Look::ALL.map(Look::name));
    assert_eq!(rows("| shading | what |"), Shading::ALL.map(Shading::name));
    tried.add(6);
}

/// Hyphenated names, such as `depth-buffer` or `max-error`, must be those of shadings, effects, hidden-surface methods,
/// mappings, kernels, palettes, scenes, features, or keys of a scene.
#[test]
fn documents_name_what_there_is() {
    let mut tried = Tried::new("documents_name_what_there_is", 30);
    let mut known: BTreeSet<&str> = Shading::ALL.map(Shading::name).into();
    known.extend(Effect::ALL.map(Effect::name));
    known.extend(FaceShading::ALL.map(FaceShading::name));
    known.extend(HiddenSurfaces::ALL.map(HiddenSurfaces::name));
    known.extend(Mapping::ALL.map(Mapping::name));
    known.extend(DitherPattern::ALL.map(DitherPattern::name));
    known.extend(mode13h::palette::builtin::ALL.iter().map(|palette| palette.name));
    known.extend(shipped::ALL.iter().map(|scene| scene.name));
    known.extend(["mode13h-assets", "mode13h-capi", "mode13h-conformance", "mode13h-lab", "mode13h-cli"]);
    // Including those that this machine lacks.
    known.extend(["asm-unrolled", "simd-arrays", "simd-sse2", "simd-neon", "simd-wasm", "simd-avx2", "simd-avx512"]);
    assert!(Kernel::available().all(|kernel| known.contains(kernel.name()) || !kernel.name().contains('-')));
    let features = include_str!("../../../../Cargo.toml").split("[features]").nth(1).expect("features");
    known.extend(features.split("\n[").next().expect("features").lines().filter_map(|line| line.split(" = ").next()));
    // Another test (assets/tests/files/scene_files.rs) checks that these are the parser's keys.
    let keys: BTreeSet<&str> =
        SCENES.lines().filter_map(|line| line.strip_prefix("| `")?.split_once("` |").map(|(key, _)| key)).collect();
    known.extend(&keys);
    let is_name = |word: &&str| {
        let legal = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "-.".contains(c);
        word.contains('-') && word.starts_with(|c: char| c.is_ascii_lowercase()) && word.chars().all(legal)
    };
    for (document, text) in DOCUMENTS {
        for word in quoted(text).map(|word| word.trim_matches('"')).filter(is_name) {
            assert!(known.contains(word), "{document}: `{word}` is the name of nothing");
            tried.add(1);
        }
    }
}

/// The keys that a text names: single capital letters, except for the article A; Esc, Space, digits and signs.
fn keys_of(text: &str) -> BTreeSet<&str> {
    let is_key = |word: &&str| {
        let letter = word.len() == 1 && word.chars().all(|c| c.is_ascii_uppercase()) && *word != "A";
        letter || ["Esc", "Space", "0", "1", "9", "[", "]", "+"].contains(word)
    };
    text.split(|c: char| c.is_whitespace() || "`,;:.()".contains(c)).filter(is_key).collect()
}

#[test]
fn documents_name_the_keys_of_the_window() {
    let mut tried = Tried::new("documents_name_the_keys_of_the_window", 18);
    let section = PROGRAM.split("\n## In the window\n").nth(1).expect("keys").split("\n## ").next().expect("a section");
    // The first cell of each row.
    let cells = section.lines().filter_map(|line| line.strip_prefix("| ")?.split(" | ").next());
    let cells = cells.collect::<Vec<_>>().join("\n");
    let documented = keys_of(&cells);
    let help = help("");
    let help = help.split("Keys in the window:\n").nth(1).expect("keys");
    assert_eq!(documented, keys_of(help), "docs/program.md and --help");
    // The keys that the program queries.
    let mut asked = BTreeSet::new();
    for (_, text) in crate::support::workspace::sources("cli/src") {
        // Its tests query others.
        let text = text.split("#[cfg(test)]").next().expect("a program");
        for (at, start) in text.match_indices("Key::") {
            let name: String = text[at + start.len()..].chars().take_while(char::is_ascii_alphanumeric).collect();
            if name.len() == 1 {
                asked.insert(name);
            }
        }
    }
    let letters: BTreeSet<String> =
        documented.iter().filter(|key| key.chars().all(|c| c.is_ascii_uppercase())).map(ToString::to_string).collect();
    assert_eq!(letters, asked, "docs/program.md and the program");
    tried.add(documented.len() as u64);
}

/// Returns whether a text has a heading with this anchor: its words in lower case, joined by hyphens, without
/// punctuation.
fn has_heading(text: &str, anchor: &str) -> bool {
    let anchor_of = |heading: &str| -> String {
        let words = heading.trim_start_matches('#').trim().to_lowercase();
        let kept = words.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        kept.map(|c| if c == ' ' { '-' } else { c }).collect()
    };
    text.lines().filter(|line| line.starts_with('#')).any(|line| anchor_of(line) == anchor)
}

/// Files and environment variables that a document names exist.
#[test]
fn documents_name_files_that_are_there() {
    let mut tried = Tried::new("documents_name_files_that_are_there", 30);
    let root = crate::support::workspace::root();
    for (document, text) in DOCUMENTS.into_iter().chain(MORE_DOCUMENTS) {
        let folder = root.join(document).parent().expect("a folder").to_path_buf();
        let links = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        let pictures = text.split("src=\"").skip(1).filter_map(|rest| rest.split('"').next());
        for link in links.chain(pictures).filter(|link| !link.contains("://") && !link.starts_with('#')) {
            let (file, heading) = link.split_once('#').unwrap_or((link, ""));
            assert!(folder.join(file).exists(), "{document}: there is no {file}");
            if !heading.is_empty() {
                let text = std::fs::read_to_string(folder.join(file)).expect("text");
                assert!(has_heading(&text, heading), "{document}: {file} has no heading {heading}");
            }
            tried.add(1);
        }
        let folders =
            "assets .ci tests src asm examples benches fuzz palettes docs lab cli capi conformance machines web";
        for path in quoted(text).filter_map(|quote| quote.split(' ').next()) {
            // A line and a column may follow the path.
            let path = path.find(".rs:").map_or(path, |end| &path[..end + 3]);
            if path.contains("NAME") {
                // Stands for any.
            } else if path.split_once('/').is_some_and(|(first, _)| folders.split(' ').any(|folder| folder == first)) {
                assert!(root.join(path).exists(), "{document}: there is no {path}");
                tried.add(1);
            } else if path.ends_with(".rs") && path.contains('/') && !path.contains('*') {
                // In the sources of the engine or of another crate.
                let is_there = ["src", "assets/src", "lab/src", "cli/src"]
                    .iter()
                    .any(|sources| root.join(sources).join(path).exists());
                assert!(is_there || folder.join(path).exists(), "{document}: there is no {path}");
                tried.add(1);
            }
        }
    }
}

/// Tests the functions that find options and keys in a text.
#[test]
fn options_and_keys_are_found_in_a_text() {
    let text = "|---|---| `--shading flat`, cargo -- --max-error 2; a--b, ---, --N, --at=1 ";
    assert_eq!(options(text), BTreeSet::from(["--at", "--max-error", "--shading"]));
    let keys = "A key: Esc quits, `[` `]` step; B makes it smaller and Shift-B greater. H, A4 and `+` `-`; 1 to 9";
    assert_eq!(keys_of(keys), BTreeSet::from(["+", "1", "9", "B", "Esc", "H", "[", "]"]));
    assert!(has_heading("# One\n\n## The study's own clock\n", "the-studys-own-clock"));
    assert!(!has_heading("The study's own clock\n", "the-studys-own-clock"));
}
