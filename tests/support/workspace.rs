//! Where the project's files are.

use std::fs;
use std::path::Path;

/// The folder of the workspace.
pub fn root() -> &'static Path {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    if package.join("lab").is_dir() { package } else { package.parent().expect("a package in the workspace") }
}

/// The names in a folder, sorted.
pub fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// The Rust files below a folder of the workspace: their paths, which begin with `folder`, and their contents.
pub fn sources(folder: &str) -> Vec<(String, String)> {
    let below = |name: String| {
        let path = format!("{folder}/{name}");
        let absolute = root().join(&path);
        match absolute.is_dir() {
            true => sources(&path),
            false if path.ends_with(".rs") => vec![(path, fs::read_to_string(absolute).expect("text"))],
            false => Vec::new(),
        }
    };
    names_in(&root().join(folder)).into_iter().flat_map(below).collect()
}
