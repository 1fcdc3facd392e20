//! What several test files share.
#![expect(dead_code, unreachable_pub, reason = "each test program uses its part")]

/// The names in a folder, sorted.
pub fn names_in(folder: &std::path::Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("a name")).collect();
    names.sort();
    names
}

#[path = "../../../tests/support/film.rs"]
pub mod film;
#[path = "../../../tests/support/property.rs"]
pub mod property;
#[path = "../../../tests/support/scenes.rs"]
pub mod scenes;
#[path = "../../../tests/support/shipped.rs"]
pub mod shipped;
#[path = "../../../tests/support/tried.rs"]
pub mod tried;
#[path = "../../../tests/support/workspace.rs"]
pub mod workspace;
